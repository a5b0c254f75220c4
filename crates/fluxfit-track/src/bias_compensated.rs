//! Block least squares with the bias by noise in the coefficients subtracted.
//!
//! When to use it: for comparison. In blocks of 50 periods it removes the last 0.1 % of ld; it has no error covariance, and becomes
//! indefinite without excitation, where the last value is held.
//!
//! In information form: `(sum phi phi' - sigma² C) z = sum phi y`, with `C` what a noise of the currents of 1 A² adds to the squared
//! coefficients. The noise is that of the second differences of the currents.

use crate::{cholesky::solved, estimate::Estimate};
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{Period, block::Block};
use serde::{Deserialize, Serialize};

/// Weight that a block keeps when the next one comes.
const FORGETTING: f64 = 0.99;

/// Information that the start is worth, V².
const START: f64 = 0.01;

/// Part by which the noise follows per sample: a tenth of a second at 10 kHz.
const FOLLOWED: f64 = 1e-3;

/// A squared second difference this many times above its mean is a change of the current, not noise.
const CHANGE: f64 = 9.0;

/// The variance of a second difference of samples with a variance of one: 1 + 4 + 1.
const OF_SECOND_DIFFERENCE: f64 = 6.0;

/// The estimator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BiasCompensated {
    nominal: [f64; PARAMETERS],
    block: Option<Block<f64>>,
    information: [[f64; PARAMETERS]; PARAMETERS],
    right: [f64; PARAMETERS],
    by_noise: [f64; PARAMETERS],
    /// The last two currents, A.
    last: [Option<[f64; 2]>; 2],
    /// Variance of the noise, A².
    noise: Option<f64>,
    z: [f64; PARAMETERS],
}

impl BiasCompensated {
    /// Begins with these values.
    pub fn new(nominal: [f64; PARAMETERS]) -> Self {
        Self {
            nominal,
            block: None,
            information: std::array::from_fn(|i| std::array::from_fn(|j| if i == j { START } else { 0.0 })),
            right: [START; PARAMETERS],
            by_noise: [0.0; PARAMETERS],
            last: [None; 2],
            noise: None,
            z: [1.0; PARAMETERS],
        }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        self.block = Some(Block::new(50, i));
        self.last = [Some(i), None];
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, i: [f64; 2]) {
        self.note_noise(i);
        let Some(equations) = self.block.as_mut().and_then(|block| block.add(period, i, &self.nominal)) else { return };
        self.by_noise.iter_mut().zip(equations.by_noise).for_each(|(sum, own)| *sum = FORGETTING * *sum + own);
        for a in 0..PARAMETERS {
            for b in 0..PARAMETERS {
                let own: f64 = equations.rows.iter().map(|row| row.phi[a] * row.phi[b]).sum();
                self.information[a][b] = FORGETTING * self.information[a][b] + own;
            }
            self.right[a] = FORGETTING * self.right[a] + equations.rows.iter().map(|row| row.phi[a] * row.y).sum::<f64>();
        }
        let mut compensated = self.information;
        (0..PARAMETERS).for_each(|j| compensated[j][j] -= self.noise.unwrap_or(0.0) * self.by_noise[j]);
        if let Some(z) = solved(&compensated, &self.right).filter(|z| z.iter().all(|value| value.is_finite())) {
            self.z = z;
        }
    }

    fn note_noise(&mut self, i: [f64; 2]) {
        if let [Some(one), Some(two)] = self.last {
            let second: f64 = (0..2).map(|c| (i[c] - 2.0 * one[c] + two[c]).powi(2)).sum();
            let now = second / (2.0 * OF_SECOND_DIFFERENCE);
            let noise = self.noise.get_or_insert(now);
            *noise += FOLLOWED * (now.min(CHANGE * *noise) - *noise);
        }
        self.last = [Some(i), self.last[0]];
    }

    /// The values; no error covariance.
    pub fn estimate(&self) -> Estimate {
        Estimate::without_covariance(std::array::from_fn(|j| self.z[j] * self.nominal[j]))
    }
}

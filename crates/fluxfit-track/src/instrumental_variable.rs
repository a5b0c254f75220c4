//! Recursive instrumental variables on single periods.
//!
//! When to use it: for comparison, where excitation never stops. It is free of the bias that noise in the coefficients gives to least
//! squares; it has no square-root form, and diverges without excitation.
//!
//! The instruments are the coefficients as they would be with the currents of an auxiliary model, which holds no noise of the measured ones
//! (Young and Jakeman 1979, doi 10.1080/00207177908922676): `K = P zeta/(lambda + phi'P zeta)`, `P = (P - K phi'P)/lambda`. A drive's delay
//! of a period or more keeps the voltages, too, free of the noise of the same sample.

use crate::estimate::Estimate;
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{Period, block::Block, period::current_after, square_root::Row};
use serde::{Deserialize, Serialize};

/// Weight that a period keeps when the next one comes: a memory of half a second at 10 kHz.
const FORGETTING: f64 = 0.9998;

/// Variance of the scaled parameters at the start, in V² of noise.
const START: f64 = 100.0;

/// Part by which the auxiliary model follows per period.
const FOLLOWED: f64 = 0.02;

/// Limits of the auxiliary model, as parts of the nominal values.
const LIMITS: [f64; 2] = [0.1, 8.0];

/// The estimator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InstrumentalVariable {
    nominal: [f64; PARAMETERS],
    z: [f64; PARAMETERS],
    auxiliary: [f64; PARAMETERS],
    i: [f64; 2],
    /// Equations with measured and with simulated currents.
    blocks: Option<[Block<f64>; 2]>,
    p: [[f64; PARAMETERS]; PARAMETERS],
}

impl InstrumentalVariable {
    /// Begins with these values.
    pub fn new(nominal: [f64; PARAMETERS]) -> Self {
        let p = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { START } else { 0.0 }));
        Self { nominal, z: [1.0; PARAMETERS], auxiliary: [1.0; PARAMETERS], i: [0.0; 2], blocks: None, p }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        self.i = i;
        self.blocks = Some([Block::new(1, i); 2]);
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, measured: [f64; 2]) {
        let theta: [f64; PARAMETERS] = std::array::from_fn(|j| self.auxiliary[j] * self.nominal[j]);
        self.i = current_after(&theta, self.i, period);
        let Some([of_measured, of_simulated]) = &mut self.blocks else { return };
        let equations = of_measured.add(period, measured, &self.nominal).zip(of_simulated.add(period, self.i, &self.nominal));
        let Some((measured, simulated)) = equations else { return };
        for (axis, (row, instrument)) in measured.rows.iter().zip(&simulated.rows).enumerate() {
            self.take(row, &instrument.phi, if axis == 0 { FORGETTING } else { 1.0 });
        }
        for j in 0..PARAMETERS {
            self.auxiliary[j] += FOLLOWED * (self.z[j].clamp(LIMITS[0], LIMITS[1]) - self.auxiliary[j]);
        }
    }

    fn take(&mut self, row: &Row<f64>, instrument: &[f64; PARAMETERS], forgetting: f64) {
        let sum = |values: [f64; PARAMETERS], by: &[f64; PARAMETERS]| -> f64 { values.iter().zip(by).map(|(a, b)| a * b).sum() };
        let p_zeta = self.p.map(|p| sum(p, instrument));
        let phi_p: [f64; PARAMETERS] = std::array::from_fn(|j| (0..PARAMETERS).map(|i| row.phi[i] * self.p[i][j]).sum());
        let denominator = forgetting + sum(p_zeta, &row.phi);
        let error = row.y - sum(self.z, &row.phi);
        let moved = p_zeta.map(|value| value / denominator);
        // Without excitation the denominator passes zero: such a step is left out.
        if !moved.iter().all(|value| (value * error).is_finite()) {
            return;
        }
        for i in 0..PARAMETERS {
            self.z[i] += moved[i] * error;
            for j in 0..PARAMETERS {
                self.p[i][j] = (self.p[i][j] - moved[i] * phi_p[j]) / forgetting;
            }
        }
    }

    /// The values. The covariance of an instrumental variable estimate would need that of its instruments; none is stated.
    pub fn estimate(&self) -> Estimate {
        Estimate::without_covariance(std::array::from_fn(|j| self.z[j] * self.nominal[j]))
    }
}

//! Adaline: four neurons of one weight each, learned by normalised least mean squares on the steady voltage equations.
//!
//! When to use it: for comparison. It has no error covariance; each stage inherits the error of the one before (0.2 % of lq are 4 % of rs);
//! and without steps of i_d, rs and ld stay where they began.
//!
//! The stages are decoupled as in Liu et al. (2011, doi 10.1109/TIE.2010.2054055): at i_d = 0 lq and psi_f are learned, in the other mode
//! rs, psi_f and ld from the difference to what was stored at i_d = 0 (subscript 0), with `h = omega i_q / (omega_0 i_q0)`,
//! `g = omega / omega_0`:
//!
//! ```text
//! i_d = 0:    lq: X = -omega i_q, d = u_d - rs i_d              psi_f: X = omega, d = u_q - rs i_q - omega ld i_d
//! otherwise:  rs: X = i_d, d = u_d - h u_d0                     psi_f: X = omega_0, d = u_q0 - rs i_q0
//!             ld: X = omega i_d, d = u_q - g u_q0 - rs (i_q - g i_q0)
//! ```

use crate::estimate::Estimate;
use fluxfit::motor::PARAMETERS;
use fluxfit_core::Period;
use serde::{Deserialize, Serialize};

/// Step size; the rule is stable below 2. This one averages the noise over 200 samples, and a start is forgotten in a tenth of a second.
const STEP: f64 = 5e-3;

/// Part by which means follow per sample.
const FOLLOWED: f64 = 0.02;

/// Part by which what is stored at i_d = 0 follows per sample: so slowly that the first samples of a step of i_d hardly matter.
const STORED: f64 = 2e-3;

/// Largest slope of the mean current that is steady, in parts of the largest current per second: 50 A/s of 14 A.
const STEADY: f64 = 3.5;

/// Samples for which one waits before it is learned, and dropped if one of them is not steady. The mean current shows a step some samples
/// after the voltages have it: without the wait, the start of a step of i_d moved lq by 0.2 %.
const WAITING: usize = 5;

/// Part of the largest current below which i_d is zero.
const ZERO: f64 = 0.05;

/// A sample: voltages, V, currents, A, and speed at one row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Sample {
    u: [f64; 2],
    i: [f64; 2],
    omega_e: f64,
}

/// The network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Adaline {
    w: [f64; PARAMETERS],
    /// Mean squares of the inputs of the five stages.
    powers: [f64; 5],
    /// Low-passed current, A.
    mean_i: Option<[f64; 2]>,
    /// Means at i_d = 0: voltage, V, current along q, A, speed.
    stored: Option<[f64; 4]>,
    /// The period before, whose mean with this one is the voltage at the row between them.
    before: Option<[f64; 2]>,
    last_i: [f64; 2],
    largest: f64,
    /// The last samples, newest first, and how many of them are steady in a row.
    waiting: [Sample; WAITING + 1],
    steady: usize,
}

impl Adaline {
    /// Begins with these values.
    pub fn new(nominal: [f64; PARAMETERS]) -> Self {
        Self {
            w: nominal,
            powers: [0.0; 5],
            mean_i: None,
            stored: None,
            before: None,
            last_i: [0.0; 2],
            largest: 0.0,
            waiting: [Sample::default(); WAITING + 1],
            steady: 0,
        }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        (self.last_i, self.before, self.mean_i, self.steady) = (i, None, None, 0);
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, measured: [f64; 2]) {
        let i = std::mem::replace(&mut self.last_i, measured);
        self.largest = self.largest.max(i[0].hypot(i[1]));
        let Some(before) = self.before.replace(period.u) else { return };
        // Both periods seen from the rotor at the row between them: each stands half a period away from it.
        let (sin, cos) = (0.5 * period.omega_e * period.length).sin_cos();
        let ahead = [cos * period.u[0] - sin * period.u[1], sin * period.u[0] + cos * period.u[1]];
        let behind = [cos * before[0] + sin * before[1], cos * before[1] - sin * before[0]];
        let u = [0.5 * (ahead[0] + behind[0]), 0.5 * (ahead[1] + behind[1])];
        let mean = self.mean_i.unwrap_or(i);
        let moved = [0, 1].map(|c| FOLLOWED * (i[c] - mean[c]));
        self.mean_i = Some([mean[0] + moved[0], mean[1] + moved[1]]);
        self.waiting.rotate_right(1);
        self.waiting[0] = Sample { u, i, omega_e: period.omega_e };
        let is_steady = moved[0].hypot(moved[1]) / period.length < STEADY * self.largest;
        self.steady = if is_steady { self.steady.saturating_add(1) } else { 0 };
        if self.steady > WAITING {
            self.learn(self.waiting[WAITING]);
        }
    }

    fn learn(&mut self, Sample { u, i: [id, iq], omega_e: omega }: Sample) {
        let [rs, ld, ..] = self.w;
        if id.abs() < ZERO * self.largest {
            let now = [u[0], u[1], iq, omega];
            let stored = self.stored.get_or_insert(now);
            stored.iter_mut().zip(now).for_each(|(mean, value)| *mean += STORED * (value - *mean));
            self.adjust(0, 2, -omega * iq, u[0] - rs * id);
            self.adjust(1, 3, omega, u[1] - rs * iq - omega * ld * id);
        } else if let Some([ud0, uq0, iq0, omega0]) = self.stored.filter(|[_, _, iq0, omega0]| iq0 * omega0 != 0.0) {
            let (h, g) = (omega * iq / (omega0 * iq0), omega / omega0);
            self.adjust(2, 0, id, u[0] - h * ud0);
            let rs = self.w[0];
            self.adjust(3, 3, omega0, uq0 - rs * iq0);
            self.adjust(4, 1, omega * id, u[1] - g * uq0 - rs * (iq - g * iq0));
        }
    }

    /// One step of a neuron towards `weight x = d`.
    fn adjust(&mut self, stage: usize, weight: usize, x: f64, d: f64) {
        let square = x * x;
        self.powers[stage] += FOLLOWED * (square - self.powers[stage]);
        let power = self.powers[stage].max(square);
        if power > 0.0 {
            self.w[weight] += STEP * x * (d - self.w[weight] * x) / power;
        }
    }

    /// The values; no error covariance.
    pub fn estimate(&self) -> Estimate {
        Estimate::without_covariance(self.w)
    }
}

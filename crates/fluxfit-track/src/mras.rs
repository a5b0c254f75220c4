//! Model reference adaptive system: an adjustable model runs in parallel, fed with the same voltages, and an integral law turns the
//! difference of the currents into changes of its parameters.
//!
//! When to use it: for comparison. It has no error covariance, does not notice what is not identifiable, and drifts to its limits there.
//!
//! ```text
//! model:  L^ di^/dt = u + k e - rs^ i^ - omega J (L^ i^ + psi^ e_q),   e = i - i^
//! law:    d theta^_I/dt = -Gamma Phi' L0 e,   theta^ = theta^_I - Gamma_P Phi' L0 e
//! Phi =   [ i^_d  di^_d/dt  -omega i^_q  0 ;  i^_q  omega i^_d  di^_q/dt  omega ]
//! ```
//!
//! The flux error `L0 e` in place of the current error makes the linear block strictly passive for a salient motor (Popov; Landau 1976, doi
//! 10.1109/TAC.1976.1101195), so that any gain is stable in continuous time. With four parameters a scalar gain is a gradient on a valley
//! of 1 : 7000; the matrix gain `wn² (W + small)^-1`, with `W` the mean of `Phi'Phi`, makes all directions equally fast.

use crate::estimate::Estimate;
use fluxfit::motor::PARAMETERS;
use fluxfit_core::Period;
use serde::{Deserialize, Serialize};

/// Speed of the adaption, rad/s. Sampled at 10 kHz `wn Ts` must stay below 0.05.
const SPEED: f64 = 60.0;

/// Largest speed of the adaption as an angle per sample.
const LARGEST_ANGLE: f64 = 0.05;

/// Proportional gain as a part of the integral one over the speed of the adaption.
const PROPORTIONAL: f64 = 0.3;

/// Feedback of the current error, in resistances: about doubles the damping of the model.
const FEEDBACK: f64 = 2.0;

/// Memory of the mean of `Phi'Phi`, s.
const MEMORY: f64 = 1.0;

/// Added to that mean, as a part of its trace, so that it can be inverted.
const REGULAR: f64 = 1e-9;

/// Limits of the parameters, as parts of the nominal ones.
const LIMITS: [f64; 2] = [0.2, 5.0];

/// Which gain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Gain {
    /// One for each parameter.
    Scalar,
    /// A matrix.
    Matrix,
}

/// The adaptive system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mras {
    nominal: [f64; PARAMETERS],
    gain: Gain,
    /// Current of the model, A, and one period before.
    i: [f64; 2],
    before: Option<[f64; 2]>,
    /// The integral part, and all of it, as parts of the nominal values.
    integral: [f64; PARAMETERS],
    z: [f64; PARAMETERS],
    /// Mean of `Phi'Phi`, scaled.
    mean: [[f64; PARAMETERS]; PARAMETERS],
}

/// Solves `a x = b` with a positive definite matrix (Cholesky); none where it is not.
pub(crate) fn solved(a: &[[f64; PARAMETERS]; PARAMETERS], b: &[f64; PARAMETERS]) -> Option<[f64; PARAMETERS]> {
    let mut l = [[0.0; PARAMETERS]; PARAMETERS];
    for i in 0..PARAMETERS {
        for j in 0..=i {
            let rest = (0..j).fold(a[i][j], |rest, k| rest - l[i][k] * l[j][k]);
            if i == j {
                if rest.is_nan() || rest <= 0.0 {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    let mut x = *b;
    for i in 0..PARAMETERS {
        x[i] = (0..i).fold(x[i], |rest, k| rest - l[i][k] * x[k]) / l[i][i];
    }
    for i in (0..PARAMETERS).rev() {
        x[i] = (i + 1..PARAMETERS).fold(x[i], |rest, k| rest - l[k][i] * x[k]) / l[i][i];
    }
    Some(x)
}

impl Mras {
    /// Begins with these values.
    pub fn new(nominal: [f64; PARAMETERS], gain: Gain) -> Self {
        Self {
            nominal,
            gain,
            i: [0.0; 2],
            before: None,
            integral: [1.0; PARAMETERS],
            z: [1.0; PARAMETERS],
            mean: [[0.0; PARAMETERS]; PARAMETERS],
        }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        (self.i, self.before) = (i, None);
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, measured: [f64; 2]) {
        let theta: [f64; PARAMETERS] = std::array::from_fn(|j| self.z[j] * self.nominal[j]);
        let start = self.i;
        let [sin, cos] = [(0.5 * period.omega_e * period.length).sin(), (0.5 * period.omega_e * period.length).cos()];
        let _ = (sin, cos);
        // The feedback acts as a voltage with the error at the beginning.
        let feedback = FEEDBACK * self.nominal[0];
        let error = self.before.map_or([0.0; 2], |_| [0, 1].map(|c| measured[c] - start[c]));
        let _ = error;
        let fed = Period { u: [0, 1].map(|c| period.u[c] + feedback * self.last_error(c)), ..*period };
        self.i = fluxfit_core::period::current_after(&theta, start, &fed);
        self.set_last_error([0, 1].map(|c| measured[c] - self.i[c]));
        self.adapt(start, period);
    }
}

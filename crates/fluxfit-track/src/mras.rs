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
//!
//! The mean has a floor: in the first samples and at standstill, of a motor that does not turn, the gain would have no limit. Noise would
//! drive the parameters to their limits, and they would still be on their way back after a second.

use crate::{cholesky::solved, estimate::Estimate};
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{Period, period::current_after};
use serde::{Deserialize, Serialize};

/// Speed of the adaption with a matrix, rad/s: beyond it, the noise of the currents moves the parameters more than what is left of the
/// start's error after half a second.
const SPEED: f64 = 50.0;

/// Speed of the adaption with scalar gains, rad/s: they are slower along the valley than across it.
const SCALAR_SPEED: f64 = 100.0;

/// Largest speed of the adaption as an angle per sample.
const LARGEST_ANGLE: f64 = 0.05;

/// Proportional gain as a part of the integral one over the speed of the adaption.
const PROPORTIONAL: f64 = 0.3;

/// Feedback of the current error, in resistances: the damping of the model is four times that of the winding.
const FEEDBACK: f64 = 3.0;

/// Memory of the mean of `Phi'Phi`, s.
const MEMORY: f64 = 0.5;

/// The floor of that mean is the square of this part of the largest voltage so far: little more than noise makes.
const FLOOR: f64 = 1e-3;

/// The same with scalar gains. Each of these reads the voltage that the other parameters leave over as its own, which is much more.
const SCALAR_FLOOR: f64 = 3e-2;

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
    /// Current of the model, A, and what is missing of the measured one.
    i: [f64; 2],
    error: [f64; 2],
    /// The integral part, and all of it, as parts of the nominal values.
    integral: [f64; PARAMETERS],
    z: [f64; PARAMETERS],
    /// Mean of `Phi'Phi`, scaled.
    mean: [[f64; PARAMETERS]; PARAMETERS],
    /// Largest voltage so far, V.
    voltage: f64,
}

impl Mras {
    /// Begins with these values, in a drive whose largest voltage, V, was this one so far.
    pub fn new(nominal: [f64; PARAMETERS], gain: Gain, voltage: f64) -> Self {
        let mean = [[0.0; PARAMETERS]; PARAMETERS];
        Self { nominal, gain, i: [0.0; 2], error: [0.0; 2], integral: [1.0; PARAMETERS], z: [1.0; PARAMETERS], mean, voltage }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        (self.i, self.error) = (i, [0.0; 2]);
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, measured: [f64; 2]) {
        let theta: [f64; PARAMETERS] = std::array::from_fn(|j| self.z[j] * self.nominal[j]);
        let before = self.i;
        let u = [0, 1].map(|c| period.u[c] + FEEDBACK * self.nominal[0] * self.error[c]);
        self.i = current_after(&theta, before, &Period { u, ..*period });
        self.error = [0, 1].map(|c| measured[c] - self.i[c]);
        let slope = [0, 1].map(|c| (self.i[c] - before[c]) / period.length);
        let ([rs, ld, lq, psi_f], omega) = (self.nominal, period.omega_e);
        let phi = [
            [rs * self.i[0], ld * slope[0], -lq * omega * self.i[1], 0.0],
            [rs * self.i[1], ld * omega * self.i[0], lq * slope[1], psi_f * omega],
        ];
        let flux_error = [ld * self.error[0], lq * self.error[1]];
        let gradient: [f64; PARAMETERS] = std::array::from_fn(|j| phi[0][j] * flux_error[0] + phi[1][j] * flux_error[1]);
        self.voltage = self.voltage.max(period.u[0].hypot(period.u[1]));
        let part = (period.length / MEMORY).min(1.0);
        for i in 0..PARAMETERS {
            for j in 0..PARAMETERS {
                self.mean[i][j] += part * (phi[0][i] * phi[0][j] + phi[1][i] * phi[1][j] - self.mean[i][j]);
            }
        }
        let speed = match self.gain {
            Gain::Scalar => SCALAR_SPEED,
            Gain::Matrix => SPEED,
        };
        let speed = speed.min(LARGEST_ANGLE / period.length);
        let Some(direction) = self.direction(&phi, &gradient) else { return };
        for j in 0..PARAMETERS {
            let rate = speed * speed * direction[j];
            self.integral[j] = (self.integral[j] - rate * period.length).clamp(LIMITS[0], LIMITS[1]);
            self.z[j] = (self.integral[j] - PROPORTIONAL / speed * rate).clamp(LIMITS[0], LIMITS[1]);
        }
    }

    /// The gradient divided by the mean square of the coefficients.
    fn direction(&self, phi: &[[f64; PARAMETERS]; 2], gradient: &[f64; PARAMETERS]) -> Option<[f64; PARAMETERS]> {
        let mean = &self.mean;
        match self.gain {
            Gain::Scalar => Some(std::array::from_fn(|j| {
                let floor = (SCALAR_FLOOR * self.voltage).powi(2);
                let square = (phi[0][j] * phi[0][j] + phi[1][j] * phi[1][j]).max(mean[j][j]).max(floor);
                if square > 0.0 { gradient[j] / square } else { 0.0 }
            })),
            Gain::Matrix => {
                let trace: f64 = (0..PARAMETERS).map(|j| mean[j][j]).sum();
                let mut regular = *mean;
                let floor = (FLOOR * self.voltage).powi(2);
                (0..PARAMETERS).for_each(|j| regular[j][j] += REGULAR * trace + floor);
                solved(&regular, gradient)
            }
        }
    }

    /// The values; no error covariance.
    pub fn estimate(&self) -> Estimate {
        Estimate::without_covariance(std::array::from_fn(|j| self.z[j] * self.nominal[j]))
    }
}

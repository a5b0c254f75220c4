//! The inverter's held vector.
//!
//! Over a sample period the voltage stands still in the stator while the rotor turns by `omega_e T_s`; and a current sampled at a period's end is not the period's mean. With
//! `x = omega_e T_s / 2` the steady equations hold, exact to `x²`, for
//!
//! ```text
//! u sinc(x),     i_d - omega_e u_q T_s² / (12 L_d),     i_q + omega_e u_d T_s² / (12 L_q)
//! ```
//!
//! where `u` is the vector in the frame at the middle of its period. A *centred* column, the mean of the two periods around the row seen from the frame at the row, is that
//! vector times `cos x`.

use crate::frames::Dq;

/// What `ud, uq` of a row mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageTiming {
    /// The mean of the two periods around the row, in the frame at the row.
    Centered,
    /// The vector that acts over one period, in the frame at that period's middle. Its delay does not matter while the drive stands still.
    Compensated,
}

/// Beyond this angle per sample, rad, a log's period is no inverter's: such logs are decimated or filtered, and the inverter's own period is unknown.
pub const MAX_ANGLE_PER_SAMPLE: f64 = 0.25;

/// The correction for one log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldVector {
    /// What the voltage columns mean.
    pub timing: VoltageTiming,
    /// Sample period, s; zero corrects nothing.
    pub sample_period: f64,
    /// Inductances that shape the current within a period, H, d and q; infinite where they are not known, which leaves the current as it is.
    pub inductance: Dq,
}

impl HeldVector {
    /// A correction that corrects nothing.
    pub const NONE: Self =
        Self { timing: VoltageTiming::Compensated, sample_period: 0.0, inductance: Dq { d: f64::INFINITY, q: f64::INFINITY } };

    /// Voltage and current as the steady equations want them. V, A, electrical rad/s.
    pub fn correct(&self, u: Dq, i: Dq, omega_e: f64) -> (Dq, Dq) {
        let x = 0.5 * omega_e * self.sample_period;
        let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
        let factor = match self.timing {
            VoltageTiming::Centered => sinc / x.cos(),
            VoltageTiming::Compensated => sinc,
        };
        let ripple = omega_e * self.sample_period * self.sample_period / 12.0;
        let corrected = Dq { d: i.d - u.q * ripple / self.inductance.d, q: i.q + u.d * ripple / self.inductance.q };
        (Dq { d: factor * u.d, q: factor * u.q }, corrected)
    }
}

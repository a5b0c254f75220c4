//! Harmonics of the magnets' flux, which are not there in a sinusoidal machine: the 5th and the 7th of each phase.
//!
//! The magnets link the phases a, b, c with the flux
//!
//! ```text
//! psi_f (cos x + a5 cos 5x + a7 cos 7x),    x = theta_e, theta_e - 2 pi/3, theta_e + 2 pi/3
//! ```
//!
//! The 5th turns against the rotor and the 7th with it, so in the rotor frame both turn six times per electrical turn:
//!
//! ```text
//! psi_d = psi_f (1 + (a7 + a5) cos 6 theta_e),    psi_q = psi_f (a7 - a5) sin 6 theta_e
//! ```
//!
//! The voltage that the rotor's motion induces is `omega_e (-phi_q, phi_d)`, where `phi` is the flux linkage of equation (1) plus the
//! change of the magnets' flux with the angle, `phi_d = psi_d + d psi_q/d theta_e`, `phi_q = psi_q - d psi_d/d theta_e`. That adds
//!
//! ```text
//! phi_d: psi_f (7 a7 - 5 a5) cos 6 theta_e,       phi_q: psi_f (7 a7 + 5 a5) sin 6 theta_e
//! ```
//!
//! The torque is `3/2 p (phi_d i_q - phi_q i_d)`: the mechanical power is what the induced voltage takes from the currents.

use crate::{error::Error, range::setting};
use fluxfit::frames::Dq;

/// Periods of the harmonics in the rotor frame per electrical turn.
pub(crate) const PERIODS: f64 = 6.0;

/// Amplitudes as fractions of the fundamental, with their signs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Harmonics {
    /// The 5th, `a5`.
    pub fifth: f64,
    /// The 7th, `a7`.
    pub seventh: f64,
}

impl Harmonics {
    /// Refuses settings out of their ranges.
    pub(crate) fn check(self) -> Result<(), Error> {
        let key = "motor.flux_harmonics";
        let refused = |amplitude: &f64| !(-MOST..=MOST).contains(amplitude);
        [self.fifth, self.seventh]
            .iter()
            .find(|amplitude| refused(amplitude))
            .map_or(Ok(()), |amplitude| Err(setting(key, *amplitude, "between -0.2 and 0.2, a fraction of psi_f")))
    }

    /// What they add to `phi`, Wb, with the magnets' flux linkage `psi_f`, Wb, at an electrical angle, rad.
    pub(crate) fn induced(self, psi_f: f64, theta_e: f64) -> Dq {
        let (sin, cos) = (PERIODS * theta_e).sin_cos();
        let (fifth, seventh) = (5.0 * self.fifth, 7.0 * self.seventh);
        Dq { d: psi_f * (seventh - fifth) * cos, q: psi_f * (seventh + fifth) * sin }
    }
}

/// Largest fraction: the 5th harmonic of the induced voltage is then as large as the fundamental.
const MOST: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit::frames::{Abc, AlphaBeta};
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// Flux linkages of the phases, Wb, from the definition.
    fn phases(Harmonics { fifth, seventh }: Harmonics, psi_f: f64, theta_e: f64) -> AlphaBeta {
        let phase = |x: f64| psi_f * (x.cos() + fifth * (5.0 * x).cos() + seventh * (7.0 * x).cos());
        Abc { a: phase(theta_e), b: phase(theta_e - TAU / 3.0), c: phase(theta_e + TAU / 3.0) }.to_alpha_beta()
    }

    proptest! {
        /// The induced voltage at 1 rad/s is the derivative of the phases' flux linkages.
        #[test]
        fn the_induced_voltage_is_the_slope_of_the_flux(theta_e in -7.0..7.0, fifth in -0.2..0.2, seventh in -0.2..0.2) {
            let (harmonics, psi_f, h) = (Harmonics { fifth, seventh }, 0.1, 1e-5);
            let (before, after) = (phases(harmonics, psi_f, theta_e - h), phases(harmonics, psi_f, theta_e + h));
            let slope = AlphaBeta { alpha: (after.alpha - before.alpha) / (2.0 * h), beta: (after.beta - before.beta) / (2.0 * h) };
            let phi = harmonics.induced(psi_f, theta_e);
            let expected = slope.to_dq(theta_e);
            // Central differences: 7³ h²/6 of 7 psi_f a7, and rounding over h.
            prop_assert!((-phi.q - expected.d).abs() < 1e-8 && (psi_f + phi.d - expected.q).abs() < 1e-8);
        }
    }
}

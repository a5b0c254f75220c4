//! The motor: four electrical parameters and the equations they enter.
//!
//! Motor convention (current flows in), dq frame as in [`frames`](crate::frames), linear magnetics:
//!
//! ```text
//! (1)  u_d = R_s i_d + L_d di_d/dt - omega_e L_q i_q
//!      u_q = R_s i_q + L_q di_q/dt + omega_e L_d i_d + omega_e psi_f
//! (2)  the same with di/dt = 0
//!      torque = 3/2 p (psi_f i_q + (L_d - L_q) i_d i_q)
//! ```
//!
//! Equation numbers are those of Gao, Wang, Jiang and Hu, "Parameters Identification of PMSM Based on Improved Flower
//! Pollination Algorithm", 2023, the paper that this project starts from.

use crate::frames::Dq;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Number of parameters of a motor.
pub const PARAMETERS: usize = 4;

/// A parameter that is identified. The order here is the order of every parameter array in this library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Parameter {
    /// Stator resistance at the inverter: winding, cable and switches, at the temperature during the log.
    Rs,
    /// Inductance of the d axis, along the magnet.
    Ld,
    /// Inductance of the q axis, 90 electrical degrees ahead of the magnet.
    Lq,
    /// Magnet flux linkage: peak value per phase.
    PsiF,
}

impl Parameter {
    /// All of them, in order.
    pub const ALL: [Self; PARAMETERS] = [Self::Rs, Self::Ld, Self::Lq, Self::PsiF];

    /// Name in files and on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Rs => "rs",
            Self::Ld => "ld",
            Self::Lq => "lq",
            Self::PsiF => "psi_f",
        }
    }

    /// Name in prose.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Rs => "R_s",
            Self::Ld => "L_d",
            Self::Lq => "L_q",
            Self::PsiF => "psi_f",
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Rs => "ohm",
            Self::Ld | Self::Lq => "H",
            Self::PsiF => "Wb",
        }
    }
}

/// The electrical parameters of a permanent magnet synchronous motor.
///
/// The number of pole pairs is not among them: a log in electrical quantities does not depend on it. Only [`torque`](Self::torque)
/// needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Motor {
    /// Stator resistance, ohm.
    pub rs: f64,
    /// d-axis inductance, H.
    pub ld: f64,
    /// q-axis inductance, H.
    pub lq: f64,
    /// Magnet flux linkage, Wb, peak per phase.
    pub psi_f: f64,
}

impl Motor {
    /// Equation (1): the terminal voltage, V, at current `i` (A), its slope `di_dt` (A/s) and speed `omega_e` (electrical rad/s).
    pub fn voltage(&self, i: Dq, di_dt: Dq, omega_e: f64) -> Dq {
        let steady = self.steady_voltage(i, omega_e);
        Dq { d: steady.d + self.ld * di_dt.d, q: steady.q + self.lq * di_dt.q }
    }

    /// Equation (2): the terminal voltage, V, at constant currents.
    pub fn steady_voltage(&self, i: Dq, omega_e: f64) -> Dq {
        Dq { d: self.rs * i.d - omega_e * self.lq * i.q, q: self.rs * i.q + omega_e * (self.ld * i.d + self.psi_f) }
    }

    /// Electromagnetic torque, N m, of a motor with `pole_pairs` pole pairs.
    pub fn torque(&self, i: Dq, pole_pairs: u32) -> f64 {
        1.5 * f64::from(pole_pairs) * (self.psi_f + (self.ld - self.lq) * i.d) * i.q
    }

    /// The parameters in the order of [`Parameter::ALL`].
    pub fn to_array(self) -> [f64; PARAMETERS] {
        [self.rs, self.ld, self.lq, self.psi_f]
    }

    /// One parameter.
    pub fn get(&self, parameter: Parameter) -> f64 {
        self.to_array()[parameter as usize]
    }
}

impl From<[f64; PARAMETERS]> for Motor {
    fn from([rs, ld, lq, psi_f]: [f64; PARAMETERS]) -> Self {
        Self { rs, ld, lq, psi_f }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 1 of the paper.
    const PAPER: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

    #[test]
    fn torque_by_hand() {
        // 10 N m at i_d = 0 and four pole pairs: i_q = T / (3/2 p psi_f), by hand 9.122423 A.
        let torque = PAPER.torque(Dq { d: 0.0, q: 9.122_422_915_526_364 }, 4);
        assert!((torque - 10.0).abs() < 1e-12, "{torque}");
    }

    #[test]
    fn steady_voltages_by_hand() {
        // omega_e = 400: u_d = 0.958 (-2) - 400 0.012 9 = -45.116; u_q = 0.958 9 + 400 (0.00525 (-2) + 0.1827) = 77.502.
        let u = PAPER.steady_voltage(Dq { d: -2.0, q: 9.0 }, 400.0);
        assert!((u.d + 45.116).abs() < 1e-12 && (u.q - 77.502).abs() < 1e-12, "{u:?}");
    }

    proptest! {
        /// Electrical power is the sum of copper loss, change of magnetic energy and shaft power, at any speed and current slope.
        #[test]
        fn power_is_conserved(id in -20.0..20.0, iq in -20.0..20.0, slope_d in -1e4..1e4, slope_q in -1e4..1e4, omega_m in -300.0..300.0) {
            let (i, di_dt) = (Dq { d: id, q: iq }, Dq { d: slope_d, q: slope_q });
            let u = PAPER.voltage(i, di_dt, 4.0 * omega_m);
            let electrical: f64 = 1.5 * (u.d * id + u.q * iq);
            let copper = 1.5 * PAPER.rs * (id * id + iq * iq);
            let magnetic = 1.5 * (PAPER.ld * id * slope_d + PAPER.lq * iq * slope_q);
            let shaft: f64 = PAPER.torque(i, 4) * omega_m;
            prop_assert!((electrical - copper - magnetic - shaft).abs() < 1e-9 * (1.0 + electrical.abs() + shaft.abs()));
        }
    }
}

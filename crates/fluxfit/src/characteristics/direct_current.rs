//! A direct current through the winding, the rotor at rest,
//!
//! ```text
//! U = k R_s I ± U_0        k = 2 between two terminals, 1 from a terminal to the star point
//! ```
//!
//! `U_0` is what contacts or switches drop whatever the current is, with its sign; it is fitted.

use super::{machine::Machine, open_circuit::Across};

/// Voltage against current.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectCurrent {
    /// Currents in any order.
    pub rows: Vec<DirectCurrentRow>,
    /// Between which points both were measured.
    pub across: Across,
}

/// A current and its voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectCurrentRow {
    /// A, not zero.
    pub current: f64,
    /// V.
    pub voltage: f64,
}

impl Across {
    /// Phases in series.
    pub(super) fn phases(self) -> f64 {
        match self {
            Self::Lines => 2.0,
            Self::Phase => 1.0,
        }
    }
}

impl DirectCurrentRow {
    /// V, of one phase.
    pub(super) fn voltage_of(&self, machine: &Machine, drop: f64) -> f64 {
        machine.rs * self.current + drop * self.current.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 A through 0.5 ohm, and 0.1 V of a contact against it, in either direction.
    #[test]
    fn the_drop_has_the_sign_of_the_current() {
        let machine = Machine { rs: 0.5, p_ld: 0.0, p_lq: 0.0, p_psi_f: 0.0 };
        let voltage = |current| DirectCurrentRow { current, voltage: 0.0 }.voltage_of(&machine, 0.1);
        assert_eq!([voltage(2.0), voltage(-2.0)], [1.1, -1.1]);
    }
}

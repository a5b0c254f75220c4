//! Terminals open: the voltage between two of them is the magnets' alone,
//!
//! ```text
//! U = sqrt(3/2) Omega p psi_f        line to line, rms
//! ```

use super::machine::Machine;

/// A voltage between lines over that of a phase.
pub(super) const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Voltage against speed.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenCircuit {
    /// Speeds in any order.
    pub rows: Vec<OpenCircuitRow>,
    /// Between which points the voltages were measured; `None` if nothing states it.
    pub across: Option<Across>,
}

/// Between which points a voltage was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// Two terminals.
    Lines,
    /// A terminal and the star point.
    Phase,
}

impl Across {
    /// The voltage between two terminals over this one.
    pub(super) fn to_lines(self) -> f64 {
        match self {
            Self::Lines => 1.0,
            Self::Phase => SQRT_3,
        }
    }
}

/// A speed and its voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenCircuitRow {
    /// Mechanical rad/s, not zero.
    pub speed: f64,
    /// Rms, V; of three the mean.
    pub voltage: f64,
}

impl OpenCircuitRow {
    /// Line to line, rms, V.
    pub(super) fn voltage_of(&self, machine: &Machine) -> f64 {
        1.5_f64.sqrt() * self.speed.abs() * machine.p_psi_f
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A phase's amplitude is `omega_e psi_f`; line to line it is sqrt 3 times that, and rms the part 1 / sqrt 2 of it.
    #[test]
    fn voltage_is_line_to_line_rms() {
        let machine = Machine { rs: 0.0, p_ld: 0.0, p_lq: 0.0, p_psi_f: 0.2 };
        let row = OpenCircuitRow { speed: -100.0, voltage: 0.0 };
        assert!((row.voltage_of(&machine) - 20.0 * 3.0_f64.sqrt() / 2.0_f64.sqrt()).abs() < 1e-12);
    }
}

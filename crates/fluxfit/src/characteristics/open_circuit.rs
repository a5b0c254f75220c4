//! Terminals open: the voltage between two of them is the magnets' alone,
//!
//! ```text
//! U = sqrt(3/2) Omega p psi_f        line to line, rms
//! ```

use super::machine::Machine;

/// Voltage against speed.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenCircuit {
    /// Speeds in any order.
    pub rows: Vec<OpenCircuitRow>,
}

/// A speed and its voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenCircuitRow {
    /// Mechanical rad/s, not zero.
    pub speed: f64,
    /// Line to line, rms, V; of three the mean.
    pub voltage: f64,
}

impl OpenCircuitRow {
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

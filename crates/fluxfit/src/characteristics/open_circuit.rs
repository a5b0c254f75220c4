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

/// What a line misses voltages by at least, as a fraction, before a constant is preferred: within it speeds are one speed.
const LEAST_MISS: f64 = 0.005;

/// How many times as much a line misses as a constant does where the voltages do not grow with the speed.
const CONSTANT: f64 = 2.0;

/// What the best line through zero and the best constant miss the voltages by, rms, as fractions, if it is a constant that these follow: as
/// those of a supply.
pub(super) fn constant_voltage(rows: &[OpenCircuitRow]) -> Option<(f64, f64)> {
    let missed = |size: &dyn Fn(&OpenCircuitRow) -> f64| {
        let parts: Vec<f64> = rows.iter().map(|row| size(row) / row.voltage).collect();
        let factor = parts.iter().sum::<f64>() / parts.iter().map(|part| part.powi(2)).sum::<f64>();
        (parts.iter().map(|part| (1.0 - factor * part).powi(2)).sum::<f64>() / parts.len() as f64).sqrt()
    };
    let (of_line, of_constant) = (missed(&|row| row.speed.abs()), missed(&|_| 1.0));
    (of_line > LEAST_MISS.max(CONSTANT * of_constant)).then_some((of_line, of_constant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voltages_of_a_supply_are_constant() {
        let of = |rows: [(f64, f64); 3]| constant_voltage(&rows.map(|(speed, voltage)| OpenCircuitRow { speed, voltage }));
        let (of_line, of_constant) = of([(359.0, 219.8), (353.0, 219.9), (346.0, 220.0)]).unwrap();
        assert!((0.01..0.02).contains(&of_line) && of_constant < 1e-3);
        // Of open terminals, also with a reading that is 2 % off; of one speed, with the resolution of its meters.
        assert_eq!(of([(100.0, 10.2), (110.0, 11.0), (120.0, 12.0)]), None);
        assert_eq!(of([(100.1, 10.0), (100.0, 10.0), (99.9, 10.0)]), None);
    }

    /// A phase's amplitude is `omega_e psi_f`; line to line it is sqrt 3 times that, and rms the part 1 / sqrt 2 of it.
    #[test]
    fn voltage_is_line_to_line_rms() {
        let machine = Machine { rs: 0.0, p_ld: 0.0, p_lq: 0.0, p_psi_f: 0.2 };
        let row = OpenCircuitRow { speed: -100.0, voltage: 0.0 };
        assert!((row.voltage_of(&machine) - 20.0 * 3.0_f64.sqrt() / 2.0_f64.sqrt()).abs() < 1e-12);
    }
}

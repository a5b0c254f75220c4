//! A table of a test bench, of whatever kind.

use super::{
    direct_current::DirectCurrent, duty_cycle::DutyCycle, open_circuit::OpenCircuit, short_circuit::ShortCircuit,
    steady_points::SteadyPoints, torque_of_current::TorqueOfCurrent,
};

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub enum Characteristic {
    /// Terminals open.
    OpenCircuit(OpenCircuit),
    /// Terminals shorted.
    ShortCircuit(ShortCircuit),
    /// Torque of currents.
    TorqueOfCurrent(TorqueOfCurrent),
    /// Direct current at rest.
    DirectCurrent(DirectCurrent),
    /// Duty cycles in place of voltages.
    DutyCycle(DutyCycle),
    /// Voltages and currents of the dq frame.
    SteadyPoints(SteadyPoints),
}

impl Characteristic {
    /// In prose.
    pub fn label(&self) -> &'static str {
        match self {
            Self::OpenCircuit(_) => "open-circuit characteristic",
            Self::ShortCircuit(_) => "short-circuit characteristic",
            Self::TorqueOfCurrent(_) => "torque against current",
            Self::DirectCurrent(_) => "voltage against direct current",
            Self::DutyCycle(_) => "duty cycle against speed",
            Self::SteadyPoints(_) => "operating points",
        }
    }

    /// The name of the test, which stays the same from version to version.
    pub fn key(&self) -> &'static str {
        match self {
            Self::OpenCircuit(_) => "open-circuit",
            Self::ShortCircuit(_) => "short-circuit",
            Self::TorqueOfCurrent(_) => "torque-of-current",
            Self::DirectCurrent(_) => "direct-current",
            Self::DutyCycle(_) => "duty-cycle",
            Self::SteadyPoints(_) => "operating-points",
        }
    }

    /// In prose, with its rows.
    pub fn describe(&self) -> String {
        let of = match self {
            Self::OpenCircuit(_) | Self::ShortCircuit(_) => "speed",
            Self::TorqueOfCurrent(_) | Self::DirectCurrent(_) | Self::DutyCycle(_) | Self::SteadyPoints(_) => "row",
        };
        let s = if self.rows() == 1 { "" } else { "s" };
        format!("{} of {} {of}{s}", self.label(), self.rows())
    }

    /// Whether it tells no parameter without another table: a short circuit without torque gives ratios alone.
    pub fn needs_another(&self) -> bool {
        matches!(self, Self::ShortCircuit(table) if table.rows.iter().all(|row| row.torque.is_none()))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::OpenCircuit(table) => table.rows.len(),
            Self::ShortCircuit(table) => table.rows.len(),
            Self::TorqueOfCurrent(table) => table.rows.len(),
            Self::DirectCurrent(table) => table.rows.len(),
            Self::DutyCycle(table) => table.rows.len(),
            Self::SteadyPoints(table) => table.rows.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characteristics::OpenCircuitRow;

    #[test]
    fn one_row_is_one_speed() {
        let of = |count: usize| {
            let rows = vec![OpenCircuitRow { speed: 1.0, voltage: 1.0 }; count];
            Characteristic::OpenCircuit(OpenCircuit { rows, across: None }).describe()
        };
        assert_eq!([of(1), of(2)], ["open-circuit characteristic of 1 speed", "open-circuit characteristic of 2 speeds"]);
    }
}

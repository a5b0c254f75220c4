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
            Self::OpenCircuit(_) | Self::ShortCircuit(_) => "speeds",
            Self::TorqueOfCurrent(_) | Self::DirectCurrent(_) | Self::DutyCycle(_) | Self::SteadyPoints(_) => "rows",
        };
        format!("{} of {} {of}", self.label(), self.rows())
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

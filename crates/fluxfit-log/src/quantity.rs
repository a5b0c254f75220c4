//! The quantities of a table of a test bench, by the names that a user maps to its columns.

use fluxfit::characteristics::Across;

/// What a column of such a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Speed,
    Voltage,
    Current,
    Torque,
}

impl Quantity {
    pub(crate) const ALL: [Self; 4] = [Self::Speed, Self::Voltage, Self::Current, Self::Torque];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Voltage => "voltage",
            Self::Current => "current",
            Self::Torque => "torque",
        }
    }
}

/// What a user may say that a column of such a table is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TableColumn {
    /// This quantity; of a voltage its name may say between which points it was measured.
    Of(Quantity),
    /// A voltage between these points.
    Voltage(Across),
    /// A current of the rotor's frame, beside a torque.
    AxisD,
    AxisQ,
}

impl TableColumn {
    const ALL: [Self; 8] = [
        Self::Of(Quantity::Speed),
        Self::Of(Quantity::Voltage),
        Self::Voltage(Across::Lines),
        Self::Voltage(Across::Phase),
        Self::Of(Quantity::Current),
        Self::Of(Quantity::Torque),
        Self::AxisD,
        Self::AxisQ,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Of(quantity) => quantity.name(),
            Self::Voltage(Across::Lines) => "voltage_ll",
            Self::Voltage(Across::Phase) => "voltage_phase",
            Self::AxisD => "id",
            Self::AxisQ => "iq",
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|column| column.name() == name)
    }

    /// Whether it is a current of the rotor's frame, which a log has too.
    pub(crate) fn is_axis(self) -> bool {
        matches!(self, Self::AxisD | Self::AxisQ)
    }

    pub(crate) fn quantity(self) -> Quantity {
        match self {
            Self::Of(quantity) => quantity,
            Self::Voltage(_) => Quantity::Voltage,
            Self::AxisD | Self::AxisQ => Quantity::Current,
        }
    }

    /// Between which points a voltage was measured, if this says it.
    pub(crate) fn across(self) -> Option<Across> {
        match self {
            Self::Voltage(across) => Some(across),
            _ => None,
        }
    }
}

//! The quantities of a table of a test bench, by the names that a user maps to its columns.

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

    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }
}

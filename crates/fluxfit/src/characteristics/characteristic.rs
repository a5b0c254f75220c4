//! A table of a test bench, of whatever kind.

use super::{open_circuit::OpenCircuit, short_circuit::ShortCircuit};

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub enum Characteristic {
    /// Terminals open.
    OpenCircuit(OpenCircuit),
    /// Terminals shorted.
    ShortCircuit(ShortCircuit),
}

impl Characteristic {
    /// In prose.
    pub fn label(&self) -> &'static str {
        match self {
            Self::OpenCircuit(_) => "open-circuit characteristic",
            Self::ShortCircuit(_) => "short-circuit characteristic",
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::OpenCircuit(table) => table.rows.len(),
            Self::ShortCircuit(table) => table.rows.len(),
        }
    }
}

//! Characteristics: tables of steady tests on a test bench, a row per speed, from which a motor is identified without a drive's log.
//!
//! Speeds are those of the shaft, so a table tells the inductances and the flux times the pole pairs. With `Omega` the speed of the
//! shaft, rad/s, and `p` the pole pairs:
//!
//! | table | file |
//! |---|---|
//! | voltage against speed, terminals open | [`open_circuit`](OpenCircuit): `p psi_f` |
//! | current and torque against speed, terminals shorted | [`short_circuit`](ShortCircuit): all, with torque or an open-circuit table |
//!
//! Tables of one motor are fitted together.

mod characteristic;
mod fit;
mod machine;
mod open_circuit;
mod short_circuit;

pub use characteristic::Characteristic;
pub use fit::{CharacteristicEstimate, CharacteristicsAnswer, Instrument, VoltageReading, identify_characteristics};
pub use open_circuit::{Across, OpenCircuit, OpenCircuitRow};
pub use short_circuit::{ShortCircuit, ShortCircuitRow};

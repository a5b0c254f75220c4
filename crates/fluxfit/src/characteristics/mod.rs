//! Characteristics: tables of steady tests on a test bench, a row per speed or current, from which a motor is identified without a drive's
//! log.
//!
//! Speeds are those of the shaft, so a table tells the inductances and the flux times the pole pairs. With `Omega` the speed of the
//! shaft, rad/s, and `p` the pole pairs:
//!
//! | table | file |
//! |---|---|
//! | voltage against speed, terminals open | [`open_circuit`](OpenCircuit): `p psi_f` |
//! | current and torque against speed, terminals shorted | [`short_circuit`](ShortCircuit): all, with torque or an open-circuit table |
//! | torque against the current of the q axis | [`torque_of_current`](TorqueOfCurrent): `p psi_f` |
//! | voltage against direct current, rotor at rest | [`direct_current`](DirectCurrent): `R_s` |
//! | dq voltages and currents of operating points | [`steady_points`](SteadyPoints): all |
//! | duty cycle and input voltage against speed | [`duty_cycle`](DutyCycle): `p psi_f`, with current perhaps `R_s` and `p L_q` |
//!
//! Tables of one motor are fitted together: `rows.rs` has them by kind, `problem.rs` is the least squares problem, `fit.rs` judges.

mod characteristic;
mod direct_current;
mod duty_cycle;
mod fit;
mod lack;
mod machine;
mod open_circuit;
mod problem;
mod rows;
mod short_circuit;
mod steady_points;
mod torque_of_current;

pub use characteristic::Characteristic;
pub use direct_current::{DirectCurrent, DirectCurrentRow};
pub use duty_cycle::{DutyCycle, DutyCycleRow};
pub use fit::{
    CharacteristicEstimate, CharacteristicsAnswer, VoltageReading, check_characteristics, identify_characteristics,
    identify_electrical_characteristics,
};
pub use lack::Lack;
pub use open_circuit::{Across, OpenCircuit, OpenCircuitRow};
pub use rows::{Instrument, Residual};
pub use short_circuit::{ShortCircuit, ShortCircuitRow};
pub use steady_points::{SteadyPoint, SteadyPoints};
pub use torque_of_current::{TorqueOfCurrent, TorqueOfCurrentRow};

//! The files around an experiment: motors, scenarios and truths in; simulated logs and their truths out.
//!
//! | file | concept |
//! |---|---|
//! | [`motor_file`] | `MOTOR.toml` |
//! | [`given_motor`] | a motor with all four parameters known |
//! | [`scenario_file`] | `SCENARIO.toml` |
//! | `flux_map` | a flux map from a table of text |
//! | [`recording`] | a simulated log as CSV |
//! | [`truth`] | the true parameters of a simulated log |
//! | `problem` | what can be wrong with one of them |

mod flux_map;
pub mod given_motor;
pub mod motor_file;
mod problem;
pub mod recording;
pub mod scenario_file;
pub mod truth;

pub use given_motor::{GivenMotor, read_given_motor};
pub use motor_file::{MotorFile, RatedValues, SensorAccuracy, read_motor};
pub use recording::write_recording;
pub use scenario_file::{ReadScenario, paper_scenario, read_scenario};
pub use truth::{Truth, read_truth, truth_of, truth_path};

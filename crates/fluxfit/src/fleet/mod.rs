//! A fleet: what the results of many motors say together. How many are identified, how their parameters are distributed and which motors
//! stand apart, which parameters drift from window to window, and why answers are missing.
//!
//! | file | concept |
//! |---|---|
//! | `row` | a row of the results: one motor, one window |
//! | `member` | a motor with all its rows, and its rank among the worst |
//! | `distribution` | one parameter over all motors, and its outliers |
//! | `drift` | one parameter of one motor from window to window |
//! | `cause` | why answers are missing: equal reasons counted together |
//! | `overview` | all of it |

mod cause;
mod distribution;
mod drift;
mod member;
mod overview;
mod row;

pub use cause::{Cause, Missing};
pub use distribution::{Distribution, LEAST_MOTORS, Outlier, Typical};
pub use drift::{Drift, DriftPoint};
pub use member::{Member, Standing};
pub use overview::FleetOverview;
pub use row::{FleetEstimate, FleetRow, FleetValue};

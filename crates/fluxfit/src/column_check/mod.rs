//! Whether the columns of a log agree with each other, before anything is fitted: angle with speed, time with the currents, signs and
//! order of the axes and phases, voltages with the DC voltage.
//!
//! A finding is what is almost certainly wrong; a log with some noise, dead time or lag has none. Facts; the sentences are in
//! `words`.

mod finding;
mod late_columns;
mod regression;
mod speed_of_slopes;
mod turned_frame;
mod turning;
mod voltages;

use crate::log::Log;
pub use finding::{Change, ColumnFinding, Turning};
pub(crate) use regression::turn_with_speed;
pub(crate) use speed_of_slopes::speed_in_doubt;
pub use turned_frame::turned_frame;
pub use voltages::{LEAST_BUS, MOST_SHARE, NEARLY_ALL};

/// What the columns of a log contradict each other in. After the first contradiction of angle, time or axes no other of these is looked
/// for: it would follow from the first.
pub fn check_columns(log: &Log) -> Vec<ColumnFinding> {
    let of_frame = turning::angle_against_speed(log)
        .map(|finding| match finding {
            ColumnFinding::SpeedSign { .. } => ColumnFinding::SpeedSign { wrong: regression::wrong_sign(log) },
            finding => finding,
        })
        .or_else(|| turning::phase_order(log))
        .or_else(|| late_columns::late_columns(log))
        .or_else(|| regression::time_unit(log))
        .or_else(|| speed_of_slopes::speed_scale(log))
        .or_else(|| regression::axes(log));
    let of_voltages = voltages::scale(log).or_else(|| voltages::share(log)).or_else(|| voltages::digits(log));
    of_frame.into_iter().chain(of_voltages).collect()
}

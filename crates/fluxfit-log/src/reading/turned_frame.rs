//! A log in a frame that is far from the magnets': it is turned back, and a note says so.

use crate::note::Note;
use fluxfit::{ColumnFinding, TurnedFrame, check_columns, log::Log, turned_frame};

/// What other signs or another order of the axes may leave of the voltages, by what the turned frame does, to be named in its place.
const AS_GOOD: f64 = 2.0;

/// The log in the magnets' frame. `of_phases`: whether its voltages, and its currents, were computed from the phases' and the angle;
/// if one of them only, the two may be in different frames, which no common turn mends. Where columns of axes are exchanged or have
/// other signs, the check of the columns says so.
pub(super) fn undone(log: Log, of_phases: [bool; 2], notes: &mut Vec<Note>) -> Log {
    let [voltages, currents] = of_phases;
    if voltages != currents {
        return log;
    }
    let Some(TurnedFrame { angle, left: in_frame }) = turned_frame(&log) else { return log };
    let is_as_good = |finding: &ColumnFinding| matches!(finding, ColumnFinding::Axes { left, .. } if *left <= AS_GOOD * in_frame);
    let has_wrong_axes = || check_columns(&log).iter().any(is_as_good);
    if !voltages && has_wrong_axes() {
        return log;
    }
    let degrees = angle.to_degrees();
    let (what, place) =
        (if voltages { "theta_e" } else { "the frame of ud, uq, id and iq" }, if degrees > 0.0 { "ahead of" } else { "behind" });
    let size = degrees.abs();
    notes.push(format!("{what} is {size:.1} degrees {place} the magnets: voltages and currents are turned by this, so that d lies along the magnets' flux; R_s, L_d, L_q and psi_f do not depend on where an angle begins").into());
    log.in_frame_behind(angle)
}

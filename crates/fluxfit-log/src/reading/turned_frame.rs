//! A log of phase quantities whose angle begins far from the magnets' axis: it is turned back, and a note says so.

use crate::note::Note;
use fluxfit::{log::Log, turned_frame};

/// The log in the magnets' frame. `of_phases`: whether both its voltages and its currents were computed from the phases' and the angle. If
/// only one of them was, the two may be in different frames, which no common turn mends. A log in dq quantities is in the frame of its
/// drive: there, columns with other signs or in another order are more likely, and the check of the columns names them.
pub(super) fn undone(log: Log, of_phases: bool, notes: &mut Vec<Note>) -> Log {
    if !of_phases {
        return log;
    }
    let Some(angle) = turned_frame(&log) else { return log };
    let degrees = angle.to_degrees();
    let (size, place) = (degrees.abs(), if degrees > 0.0 { "ahead of" } else { "behind" });
    notes.push(format!("theta_e is {size:.1} degrees {place} the magnets: voltages and currents are turned by this, so that d lies along the magnets' flux; R_s, L_d, L_q and psi_f do not depend on where an angle begins").into());
    log.in_frame_behind(angle)
}

//! The electrical angle at the rows of one stretch, and the turns that it makes of them: computed once for every reading of the voltages.

use crate::{
    frames::{Dq, Turn},
    log::Log,
};
use std::{f64::consts::TAU, ops::Range};

/// The electrical angle at the rows of one stretch, rad, without jumps.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Angles {
    /// As the drive had it when it turned currents and voltages into its frame.
    pub(super) logged: Vec<f64>,
    /// As the rotor most likely was: without the steps of an encoder.
    pub(super) rotor: Vec<f64>,
    /// The logged speed, electrical rad/s, smoothed as that angle is.
    pub(super) speed: Vec<f64>,
    /// Whether the log has it. Without, both are the speed, integrated from the segment's first row on: still a frame that is fixed to the
    /// rotor, but at an unknown angle to the stator.
    pub(super) known: bool,
    /// The turns by them, and by the rotor's angle half way to the next row.
    pub(super) logged_turns: Vec<Turn>,
    pub(super) rotor_turns: Vec<Turn>,
    pub(super) middle_turns: Vec<Turn>,
    /// Measured currents, A, in the frame of the rotor's most likely angle.
    pub(super) measured: Vec<Dq>,
}

/// Largest difference per row, rad, between the logged angle and the one expected from the logged speed: the steps of an encoder and the
/// filter of a speed stay below; a mechanical angle, or one of the other sense, differs by more within a turn.
const ANGLE_MISFIT: f64 = 0.1;

/// Share of the rows that may differ by more, as where an index pulse corrects the angle.
const MISFITS: f64 = 0.01;

/// Fraction of the whole turn by which the integrated speed may differ from it: a filtered speed lags at both ends.
const WHOLE_MISFIT: f64 = 0.02;

/// Rows to either side over which the steps of an encoder are averaged: a tenth or less of uniform steps remains, and the speed, which
/// interpolates between them, need be right over so many rows only.
pub(super) const SMOOTHED: usize = 25;

impl Angles {
    /// The angles at these rows of one segment. A logged angle that does not turn with the speed is not used.
    pub(super) fn of(log: &Log, rows: &Range<usize>) -> Self {
        let (logged, rotor, known) = logged_and_rotor(log, rows);
        let logged_speed = &log.columns().omega_e[rows.clone()];
        let turns = |angles: &[f64]| angles.iter().map(|angle| Turn::by(*angle)).collect::<Vec<Turn>>();
        let rotor_turns = turns(&rotor);
        let columns = log.columns();
        // Out of the drive's frame, into the rotor's.
        let measured = rows.clone().zip(logged.iter().zip(&rotor));
        let measured = measured.map(|(row, (logged, rotor))| Dq { d: columns.id[row], q: columns.iq[row] }.turned(logged - rotor));
        Self {
            measured: measured.collect(),
            logged_turns: if known { turns(&logged) } else { rotor_turns.clone() },
            middle_turns: rotor.windows(2).map(|pair| Turn::by(0.5 * (pair[0] + pair[1]))).collect(),
            rotor_turns,
            speed: if known { moving_mean(&moving_mean(logged_speed)) } else { logged_speed.to_vec() },
            logged,
            rotor,
            known,
        }
    }
}

/// The logged angle, that of the rotor, and whether the log has it.
fn logged_and_rotor(log: &Log, rows: &Range<usize>) -> (Vec<f64>, Vec<f64>, bool) {
    let columns = log.columns();
    let turn = |row: usize| 0.5 * (columns.omega_e[row - 1] + columns.omega_e[row]) * (columns.t[row] - columns.t[row - 1]);
    let later = rows.start + 1..rows.end;
    let turns = later.clone().scan(0.0, |theta, row| {
        *theta += turn(row);
        Some(*theta)
    });
    // From the first row of the log's segment on, so that all its stretches have one stator.
    let segment = log.segment_of(rows.start).map_or(rows.start, |segment| segment.rows.start);
    let before: f64 = (segment + 1..=rows.start).map(turn).sum();
    let summed: Vec<f64> = std::iter::once(before).chain(turns.map(|later| before + later)).collect();
    if let Some(logged) = &columns.theta_e {
        let mut angles = vec![logged[rows.start]];
        let mut misfits = 0;
        for row in later {
            let expected = angles[angles.len() - 1] + turn(row);
            let angle = logged[row] + TAU * ((expected - logged[row]) / TAU).round();
            misfits += usize::from((angle - expected).abs() > ANGLE_MISFIT);
            angles.push(angle);
        }
        // A mechanical angle turns too little on the whole, and one of the other sense turns backward.
        let (whole, expected) = (angles[angles.len() - 1] - angles[0], summed[summed.len() - 1] - before);
        let turns = (whole - expected).abs() <= WHOLE_MISFIT * expected.abs() + TAU;
        if turns && misfits as f64 <= MISFITS * rows.len() as f64 {
            let rotor = smoothed(&angles, &summed);
            return (angles, rotor, true);
        }
    }
    (summed.clone(), summed, false)
}

/// The integrated speed, corrected by the mean difference of the logged angle around each row; averaged twice, so that the slope is
/// smooth too.
fn smoothed(logged: &[f64], summed: &[f64]) -> Vec<f64> {
    let differences: Vec<f64> = logged.iter().zip(summed).map(|(one, other)| one - other).collect();
    let smooth = moving_mean(&moving_mean(&differences));
    summed.iter().zip(smooth).map(|(summed, difference)| summed + difference).collect()
}

/// Mean of as many rows on one side as on the other, so that a trend is not shifted: fewer near the ends.
fn moving_mean(series: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    sums.extend(series.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    }));
    let mean = |row: usize| {
        let reach = SMOOTHED.min(row).min(series.len() - 1 - row);
        (sums[row + reach + 1] - sums[row - reach]) / (2 * reach + 1) as f64
    };
    (0..series.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// A rotor at 400 rad/s, whose angle in the log turns so many times as fast.
    fn log(angle_per_turn: f64) -> Log {
        const PERIOD: f64 = 1e-4;
        let t: Vec<f64> = (0..2000).map(|k| f64::from(k) * PERIOD).collect();
        let theta_e = t.iter().map(|t| (angle_per_turn * 400.0 * t).rem_euclid(TAU)).collect();
        let any = || t.iter().map(|t| 1.0 + (300.0 * t).sin()).collect();
        let omega_e = vec![400.0; t.len()];
        Log::new(Columns { ud: any(), uq: any(), id: any(), iq: any(), omega_e, theta_e: Some(theta_e), t, ..Columns::default() }).unwrap()
    }

    /// What the rotor turned before them is nothing to rows in the middle of a log.
    #[test]
    fn an_angle_that_turns_with_the_speed_is_known_in_all_parts_of_a_log() {
        for rows in [0..2000, 0..300, 700..1000, 1700..2000] {
            assert!(Angles::of(&log(1.0), &rows).known, "{rows:?}");
            assert!(!Angles::of(&log(-1.0), &rows).known, "{rows:?}");
        }
        assert!(!Angles::of(&log(0.25), &(0..2000)).known);
    }
}

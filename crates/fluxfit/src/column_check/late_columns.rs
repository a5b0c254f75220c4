//! Voltages or currents that are logged some rows late: a bus or a recorder that takes them from different instants.
//!
//! Where a current jumps, the voltage that moved it stands beside it, or up to two rows before or after: those are readings of a drive's
//! voltages. The [regression](super::regression) of single rows around jumps, with the currents of other rows, tells where it stands.

use super::{
    finding::ColumnFinding,
    regression::{Frame, Mean, normal, solved},
};
use crate::{frames::Dq, log::Log};
use nalgebra::DMatrix;
use std::ops::RangeInclusive;

/// Rows by which the currents are moved against the voltages.
const SHIFTS: RangeInclusive<isize> = -12..=12;

/// Those of readings: from means of the rows around to a command that acts two rows later.
const READINGS: RangeInclusive<isize> = -1..=2;

/// The shift of a drive whose command acts one row later, as most do.
const USUAL: isize = 1;

/// A current jumps if it changes by so many times the usual change from row to row.
const JUMP: f64 = 8.0;

/// Fewest jumps. Each is one piece of evidence, whatever else happens around it.
const LEAST_JUMPS: usize = 20;

/// Most jumps that are looked at: more tell the same.
const MOST_JUMPS: usize = 60;

/// What readings leave of the voltages around jumps, as a fraction, of a log in which nothing is late: filters of the currents leave 0.11,
/// dead time 0.07. Voltages five rows late, or currents three, leave 0.22.
const OF_READINGS: f64 = 0.13;

/// What another shift leaves beside that. Of 440 logs of drives with filters, dead time, lags and decimation none had less than 0.36, of
/// voltages or currents that are late 0.18.
const MUCH_LESS: f64 = 0.3;

/// By how many rows the voltages are late (or the currents, then it is negative), if they are.
pub(super) fn late_columns(log: &Log) -> Option<ColumnFinding> {
    let rows = around_jumps(log)?;
    let left = |shift: isize| solved(&shifted(log, &rows, shift)).map_or(f64::INFINITY, |fit| fit.left);
    let least = |shifts: RangeInclusive<isize>| shifts.map(|shift| (shift, left(shift))).min_by(|one, other| one.1.total_cmp(&other.1));
    let (_, of_readings) = least(READINGS)?;
    // So it is in most logs, and the others need not be tried.
    if of_readings < OF_READINGS {
        return None;
    }
    let (shift, of_other) = least(SHIFTS)?;
    (of_other < MUCH_LESS * of_readings).then_some(ColumnFinding::LateColumns { rows: USUAL - shift })
}

/// The rows around jumps of the currents, each once, with all their shifts in the same segment.
fn around_jumps(log: &Log) -> Option<Vec<usize>> {
    let columns = log.columns();
    let change = |row: usize| (columns.id[row + 1] - columns.id[row]).hypot(columns.iq[row + 1] - columns.iq[row]);
    let reach = SHIFTS.end().unsigned_abs();
    let of_segment = |rows: &std::ops::Range<usize>| rows.start..rows.end.saturating_sub(1).max(rows.start);
    let mut changes: Vec<f64> = log.segments().iter().flat_map(|segment| of_segment(&segment.rows)).map(change).collect();
    if changes.len() < 2 * LEAST_JUMPS {
        return None;
    }
    let middle = changes.len() / 2;
    let usual = *changes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let inner = |rows: &std::ops::Range<usize>| rows.start + 2 * reach..rows.end.saturating_sub(2 * reach + 1);
    let jumps: Vec<usize> =
        log.segments().iter().flat_map(|segment| inner(&segment.rows)).filter(|row| change(*row) > JUMP * usual).collect();
    if jumps.len() < LEAST_JUMPS {
        return None;
    }
    let share = jumps.len().div_ceil(MOST_JUMPS);
    let mut rows: Vec<usize> = jumps.iter().step_by(share).flat_map(|row| row - reach..=row + reach).collect();
    rows.sort_unstable();
    rows.dedup();
    Some(rows)
}

/// The normal equations of these rows' voltages, explained by the currents so many rows later.
fn shifted(log: &Log, rows: &[usize], shift: isize) -> DMatrix<f64> {
    let columns = log.columns();
    let mean = |row: &usize| {
        let at = row.saturating_add_signed(shift);
        let current = |row: usize| Dq { d: columns.id[row], q: columns.iq[row] };
        let (before, after, length) = (current(at), current(at + 1), columns.t[at + 1] - columns.t[at]);
        let i = Dq { d: 0.5 * (before.d + after.d), q: 0.5 * (before.q + after.q) };
        let slope = Dq { d: (after.d - before.d) / length, q: (after.q - before.q) / length };
        Mean::of_row(Dq { d: columns.ud[*row], q: columns.uq[*row] }, i, slope, columns.omega_e[at])
    };
    normal(&rows.iter().map(mean).collect::<Vec<_>>(), &Frame::AS_IT_IS, true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// A motor of 0.9 ohm, 4.1 and 6.2 mH, 0.117 Wb at 250 rad/s whose controller steps its current every 50 rows; voltages act one row
    /// after their command, and stand so many rows late in the log.
    fn log(late: usize) -> Log {
        const PERIOD: f64 = 1e-4;
        let (rs, ld, lq, psi_f, omega_e) = (0.9, 4.1e-3, 6.2e-3, 0.117, 250.0);
        let (mut i, mut acts, mut voltages) = (Dq::default(), Dq::default(), Vec::new());
        let mut columns = Columns::default();
        for row in 0..2000_usize {
            let level = [2.0, 6.0, 4.0, 8.0, 1.0][row / 50 % 5];
            let asked = Dq { d: -0.3 * level, q: level };
            let command = Dq {
                d: rs * i.d - omega_e * lq * i.q + 0.2 * ld / PERIOD * (asked.d - i.d),
                q: rs * i.q + omega_e * (ld * i.d + psi_f) + 0.2 * lq / PERIOD * (asked.q - i.q),
            };
            columns.t.push(PERIOD * row as f64);
            columns.id.push(i.d);
            columns.iq.push(i.q);
            columns.omega_e.push(omega_e);
            voltages.push(command);
            i.d += PERIOD / ld * (acts.d - rs * i.d + omega_e * lq * i.q);
            i.q += PERIOD / lq * (acts.q - rs * i.q - omega_e * (ld * i.d + psi_f));
            acts = command;
        }
        let logged = |row: usize| voltages[row.saturating_sub(late)];
        columns.ud = (0..2000).map(|row| logged(row).d).collect();
        columns.uq = (0..2000).map(|row| logged(row).q).collect();
        Log::new(columns).unwrap()
    }

    #[test]
    fn voltages_that_stand_some_rows_late_are_told() {
        for late in [0, 1] {
            assert_eq!(late_columns(&log(late)), None, "{late}");
        }
        for late in [4, 5, 9] {
            assert_eq!(late_columns(&log(late)), Some(ColumnFinding::LateColumns { rows: late as isize }), "{late}");
        }
        // The other way round: the currents stand late.
        let Columns { t, ud, uq, id, iq, omega_e, .. } = log(0).columns().clone();
        let shifted = |values: &[f64]| (0..values.len()).map(|row: usize| values[row.saturating_sub(3)]).collect();
        let currents = Columns { t, ud, uq, id: shifted(&id), iq: shifted(&iq), omega_e, ..Columns::default() };
        assert_eq!(late_columns(&Log::new(currents).unwrap()), Some(ColumnFinding::LateColumns { rows: -3 }));
    }
}

//! The voltages against the DC voltage: whether the inverter can have made them.

use super::finding::ColumnFinding;
use crate::{log::Log, steady::windows};

/// Share of the rows with current that must be above the limit: a drive at its limit is there for a part of its log.
const NEARLY_ALL: f64 = 0.9;

/// Six-step operation makes 2 sqrt 3 / pi of the limit; more there is not.
const SIX_STEP: f64 = 1.15;

/// Less than this, V, is no DC voltage of a drive: a duty cycle, or a column that is not used.
const LEAST_VOLTAGE: f64 = 2.0;

/// Fewest rows with current.
const LEAST_ROWS: usize = 10;

/// Whether nearly all rows have more voltage than there is.
pub(super) fn scale(log: &Log) -> Option<ColumnFinding> {
    let columns = log.columns();
    let u_dc = columns.u_dc.as_ref()?;
    let least = windows::least_current(log);
    let ratio = |row: usize| {
        let (u, i) = (columns.ud[row].hypot(columns.uq[row]), columns.id[row].hypot(columns.iq[row]));
        (i >= least && u_dc[row] >= LEAST_VOLTAGE).then(|| u * 3.0_f64.sqrt() / u_dc[row])
    };
    let mut ratios: Vec<f64> = (0..log.rows()).filter_map(ratio).collect();
    if ratios.len() < LEAST_ROWS {
        return None;
    }
    let above = ratios.iter().filter(|ratio| **ratio > SIX_STEP).count() as f64;
    let middle = ratios.len() / 2;
    let is_above = above >= NEARLY_ALL * ratios.len() as f64;
    let ratio = *ratios.select_nth_unstable_by(middle, f64::total_cmp).1;
    is_above.then_some(ColumnFinding::VoltageScale { ratio })
}

//! The rows of a log that an answer does not rest on, and why.
//!
//! Rows that are [spikes](crate::log::Spikes) are no rows of the log any more and are not among these.

use super::super::{
    fit::{output::OutputFit, steady::SteadyFit},
    prepare::stretches,
    request::Request,
};
use crate::log::Log;
use std::ops::Range;

/// Consecutive rows that an answer does not rest on.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct LeftOut {
    /// The rows, counted from 0 over the log.
    pub rows: Range<usize>,
    /// Why.
    pub reason: LeftOutReason,
}

/// Why rows are left out. It prints as a few words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LeftOutReason {
    /// They lie outside of the windows that were named.
    OutsideWindows,
    /// Currents or speed are not constant there, which the steady model needs.
    NotSteady,
    /// Of a long log, only the pieces that differ most are simulated.
    LikeOthers,
    /// There are too few rows without a gap to simulate them.
    TooShort,
}

/// Longest gap between two simulated stretches, rows, that is no rows left out: the start of a simulation takes a row.
const START: usize = 2;

/// All of them, in the order of rows.
pub(crate) fn all(log: &Log, request: &Request, steady: Option<&SteadyFit>, output: Option<&OutputFit>) -> Vec<LeftOut> {
    // Windows that are not in the log were refused before.
    let named = if request.windows.is_empty() { Vec::new() } else { stretches::all(log, &request.windows).unwrap_or_default() };
    let offered: usize = if named.is_empty() { log.rows() } else { named.iter().map(ExactSizeIterator::len).sum() };
    let (mut used, other): (Vec<Range<usize>>, LeftOutReason) = match (output, steady) {
        (Some(fit), _) => {
            let is_long = offered > stretches::FIT_ROWS;
            (fit.stretches.clone(), if is_long { LeftOutReason::LikeOthers } else { LeftOutReason::TooShort })
        }
        (None, Some(fit)) => (fit.operating_points.iter().map(|point| point.rows.clone()).collect(), LeftOutReason::NotSteady),
        (None, None) => return Vec::new(),
    };
    used.sort_by_key(|rows| rows.start);
    let least = if output.is_some() { START } else { 0 };
    let mut found = Vec::new();
    for segment in log.segments() {
        let mut next = segment.rows.start;
        let within = used.iter().filter(|rows| rows.start < segment.rows.end && rows.end > segment.rows.start);
        for rows in within.cloned().chain(std::iter::once(segment.rows.end..segment.rows.end)) {
            if rows.start > next + least {
                let is_named = named.is_empty() || named.iter().any(|window| window.start < rows.start && window.end > next);
                let reason = if is_named { other } else { LeftOutReason::OutsideWindows };
                found.push(LeftOut { rows: next..rows.start, reason });
            }
            next = next.max(rows.end);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{identification::request::Request, identify, log::Columns, paper, steady::windows::TimeWindow};

    /// The paper's motor at two operating points of 200 rows, with a ramp of 100 rows between them.
    fn log() -> Log {
        let mut columns = Columns::default();
        for k in 0..500 {
            let course = f64::from((k - 200).clamp(0, 100)) / 100.0;
            let i = crate::frames::Dq { d: -3.0 * course, q: 9.0 - 4.0 * course };
            let u = paper::MOTOR.steady_voltage(i, 400.0);
            let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
            [t, ud, uq, id, iq, omega_e].into_iter().zip([f64::from(k) * 1e-3, u.d, u.q, i.d, i.q, 400.0]).for_each(|(c, v)| c.push(v));
        }
        Log::new(columns).unwrap()
    }

    fn left_out(request: &Request) -> Vec<LeftOut> {
        identify(&log(), request).unwrap().identification.left_out
    }

    #[test]
    fn the_steady_model_leaves_out_the_ramp_between_its_points() {
        let request = Request { model: Some(crate::Model::Steady), ..Request::default() };
        let found = left_out(&request);
        let ramp = found.iter().find(|left| left.rows.contains(&250)).unwrap();
        assert_eq!(ramp.reason, LeftOutReason::NotSteady);
        assert!(found.iter().all(|left| !left.rows.contains(&100) && !left.rows.contains(&400)), "{found:?}");
    }

    #[test]
    fn rows_outside_of_named_windows_are_left_out_as_such() {
        let windows = vec![TimeWindow { from: 0.0, to: 0.15 }, TimeWindow { from: 0.35, to: 0.45 }];
        let found = left_out(&Request { model: Some(crate::Model::Steady), windows, ..Request::default() });
        assert!(found.iter().all(|left| left.reason == LeftOutReason::OutsideWindows), "{found:?}");
        assert!([250, 480].iter().all(|row| found.iter().any(|left| left.rows.contains(row))), "{found:?}");
    }
}

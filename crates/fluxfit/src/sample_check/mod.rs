//! Whether single samples of a log are measurements, before anything is fitted: outliers that no neighbour supports, and stale samples,
//! which a recorder repeats while the drive moves on.
//!
//! A finding leaves no row out: rows that are left out are [spikes](crate::log::Spikes). Facts; the sentences are in `words`.

mod finding;
mod outliers;
mod rows;
mod stale;

use crate::log::Log;
pub use finding::{SampleFault, SampleFinding};

/// Fewest rows of a log that shows what its samples usually do.
const LEAST_ROWS: usize = 200;

/// The samples of a log that are no measurements, outliers first. A log whose channels were interpolated onto common instants has no
/// samples of its own, and is not examined.
pub fn check_samples(log: &Log) -> Vec<SampleFinding> {
    if log.rows() < LEAST_ROWS || log.is_interpolated() {
        return Vec::new();
    }
    outliers::find(log).into_iter().chain(stale::find(log)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{log::Columns, optimizer::Draws};
    use std::ops::Range;

    /// A winding of 50 mOhm and 0.1 mH at 400 rad/s, 10 kHz, at voltage steps every hundred rows; with noise, or none.
    fn columns(rows: usize, noise: f64) -> Columns {
        let mut draws = Draws::seeded(3, 0);
        let mut columns = Columns::default();
        let (mut current, period) = (0.0, 1e-4);
        for k in 0..rows {
            let voltage = if (k / 100).is_multiple_of(2) { 0.5 } else { 1.0 };
            columns.t.push(k as f64 * period);
            columns.ud.push(0.01 * noise * draws.normal());
            columns.uq.push(voltage + 0.01 * noise * draws.normal());
            columns.id.push(0.05 * noise * draws.normal());
            columns.iq.push(current + 0.05 * noise * draws.normal());
            columns.omega_e.push(400.0 + noise * draws.normal());
            current += period / 1e-4 * (voltage - 0.05 * current);
        }
        columns
    }

    /// Kind, column, rows and first row of what is found after `change`.
    fn found(mut columns: Columns, change: impl Fn(&mut Columns)) -> Vec<(SampleFault, Option<&'static str>, usize, usize)> {
        change(&mut columns);
        let findings = check_samples(&Log::new(columns).unwrap());
        findings.iter().map(|finding| (finding.kind, finding.column, finding.rows, finding.first_row)).collect()
    }

    #[test]
    fn a_log_without_such_samples_has_no_finding() {
        assert_eq!(found(columns(3000, 1.0), |_| ()), []);
    }

    #[test]
    fn a_row_far_beside_its_neighbours_is_an_outlier() {
        type Change = fn(&mut Columns);
        // Far beyond the noise (0.01 V, 0.05 A, 1 rad/s), and well within the range of what is left out as a spike.
        let changes: [(&str, Change); 5] = [
            ("ud", |c| [350, 1250].iter().for_each(|k| c.ud[*k] += 0.5)),
            ("uq", |c| [350, 1250].iter().for_each(|k| c.uq[*k] -= 0.5)),
            ("id", |c| [350, 1250].iter().for_each(|k| c.id[*k] += 2.0)),
            ("iq", |c| [350, 1250].iter().for_each(|k| c.iq[*k] -= 4.0)),
            ("omega_e", |c| [350, 1250].iter().for_each(|k| c.omega_e[*k] += 60.0)),
        ];
        for (column, change) in changes {
            assert_eq!(found(columns(3000, 1.0), change), [(SampleFault::Outlier, Some(column), 2, 350)]);
        }
    }

    /// One row of 30 V, which the current answers by 30 A; and a speed that an encoder counts in one step.
    #[test]
    fn a_pulse_that_acted_is_no_outlier() {
        let pulse = |c: &mut Columns| {
            c.uq[350] += 30.0;
            (351..3000).for_each(|k| c.iq[k] += 30.0 * 0.95_f64.powi(k as i32 - 351));
        };
        assert_eq!(found(columns(3000, 1.0), pulse), []);
        let count = |c: &mut Columns| {
            c.omega_e.fill(400.0);
            c.omega_e[350] = 461.0;
        };
        assert_eq!(found(columns(3000, 1.0), count), []);
    }

    #[test]
    fn a_column_that_repeats_while_others_move_is_stale() {
        let hold = |values: &mut [f64], rows: Range<usize>| {
            let last = values[rows.start - 1];
            values[rows].fill(last);
        };
        let stale = |column| [(SampleFault::Stale, Some(column), 12, 450)];
        assert_eq!(found(columns(3000, 1.0), |c| [450, 1450].iter().for_each(|k| hold(&mut c.iq, *k..k + 6))), stale("iq"));
        assert_eq!(found(columns(3000, 1.0), |c| [450, 1450].iter().for_each(|k| hold(&mut c.ud, *k..k + 6))), stale("ud"));
        let rows = |c: &mut Columns| {
            [450, 1450].iter().for_each(|k| {
                [&mut c.ud, &mut c.uq, &mut c.id, &mut c.iq, &mut c.omega_e].into_iter().for_each(|values| hold(values, *k..k + 6));
            });
        };
        assert_eq!(found(columns(3000, 1.0), rows), [(SampleFault::Stale, None, 12, 450)]);
    }

    /// What rests is not stale: a simulation without noise that settles, to the last digit of a file; a duty that is held; a locked rotor;
    /// a converter with few digits; a current that is off.
    #[test]
    fn what_rests_is_not_stale() {
        let digits = |values: &mut [f64], step: f64| values.iter_mut().for_each(|value| *value = (*value / step).round() * step);
        assert_eq!(found(columns(3000, 0.0), |c| digits(&mut c.iq, 1e-4)), []);
        let settles = |c: &mut Columns| {
            let of = |k: usize| 10.0 - 8.0 * (-((k % 500) as f64) / 40.0).exp();
            (c.id, c.uq) = ((0..3000).map(|k| 0.1 * of(k)).collect(), (0..3000).map(|k| 0.5 * of(k + 250)).collect());
            digits(&mut c.id, 1e-4);
        };
        assert_eq!(found(columns(3000, 1.0), settles), []);
        let duty = |c: &mut Columns| {
            [450, 1450].into_iter().for_each(|k| {
                c.ud[k..k + 20].fill(0.02);
                c.uq[k..k + 20].fill(0.7);
            });
        };
        assert_eq!(found(columns(3000, 1.0), duty), []);
        let locked = |c: &mut Columns| {
            c.omega_e.fill(0.0);
            c.omega_e[0] = 1e-3;
            c.theta_e = Some(vec![0.3; 3000]);
        };
        assert_eq!(found(columns(3000, 1.0), locked), []);
        let coarse = |c: &mut Columns| {
            digits(&mut c.id, 0.1);
            digits(&mut c.iq, 0.1);
        };
        assert_eq!(found(columns(3000, 1.0), coarse), []);
        assert_eq!(found(columns(3000, 1.0), |c| [450, 1450].into_iter().for_each(|k| c.id[k..k + 20].fill(0.0))), []);
    }
}

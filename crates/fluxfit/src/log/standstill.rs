//! A rotor that stands still, in a log whose speed is zero throughout. Drives that did not log their speed have the same column, so the log
//! must show it: somewhere the current is zero, and the voltage there is nearly none, because no magnet turns; or a resistance and two
//! inductances explain the voltages, without any that turning would induce.

use super::columns::Columns;
use crate::normal_matrix::{NormalMatrix, dot};
use nalgebra::DVector;

/// A current below this part of the largest is none.
const NO_CURRENT: f64 = 0.05;

/// A voltage below this part of the largest is none.
const NO_VOLTAGE: f64 = 0.2;

/// Rows without a current, in the mean of which noise and a controller's answers to it cancel.
const LEAST_ROWS: usize = 10;

/// Rows over which voltages and currents are averaged, and slopes taken: enough to calm noise, and that a delay of a row is a small part.
const SPAN: usize = 10;

/// Part of the squares of the voltages that a resistance and inductances leave at most. Of 337 simulated motors that turn, with the speed
/// set to zero, they left 4 % and more. Of 83 simulated tests at rest they left at most 0.5 % of 74, and 1.7 % of one of means of rows;
/// the others, whose idle axis had a voltage and no current, 20 %.
const MOST_LEFT: f64 = 0.02;

/// Part of them that inductances explain at least: a load that grows with the speed makes magnets look like a resistance. Where inductances
/// explained so much of those turning motors, at least 13 % were left.
const INDUCTIVE: f64 = 0.05;

/// Whether the log is one of a rotor that stands.
pub(super) fn shows_rest(columns: &Columns) -> bool {
    has_moment_of_rest(columns) || answers_as_at_rest(columns)
}

/// Whether `u = R i + L di/dt` holds along both axes, and its second part matters.
fn answers_as_at_rest(columns: &Columns) -> bool {
    let Columns { t, ud, uq, id, iq, .. } = columns;
    let spans = || (0..t.len().saturating_sub(1) / SPAN).map(|k| k * SPAN..(k + 1) * SPAN);
    let mean = |values: &[f64]| spans().map(|rows| values[rows].iter().sum::<f64>() / SPAN as f64).collect::<Vec<f64>>();
    // A current goes on to the next row.
    let beside = |values: &[f64]| {
        let ends = spans().map(|rows| 0.5 * (values[rows.end] - values[rows.start]) / SPAN as f64);
        mean(values).into_iter().zip(ends).map(|(mean, ends)| mean + ends).collect::<Vec<f64>>()
    };
    let slope = |values: &[f64]| spans().map(|rows| (values[rows.end] - values[rows.start]) / (t[rows.end] - t[rows.start])).collect();
    let (of_d, of_q): (Vec<f64>, Vec<f64>) = (slope(id), slope(iq));
    let nothing = vec![0.0; of_d.len()];
    let u = [mean(ud), mean(uq)].concat();
    let resistive = [beside(id), beside(iq)].concat();
    let inductive = [[of_d, nothing.clone()].concat(), [nothing, of_q].concat()];
    let squares = dot(&u, &u);
    let left = |columns: &[Vec<f64>]| {
        let right = DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, &u)));
        1.0 - right.dot(&(NormalMatrix::of(columns).inverse() * &right)) / squares
    };
    let with = left(&[&[resistive.clone()][..], &inductive].concat());
    squares > 0.0 && with < MOST_LEFT && left(&[resistive]) - with > INDUCTIVE
}

/// Whether there is a moment without current and voltage.
fn has_moment_of_rest(columns: &Columns) -> bool {
    let largest = |d: &[f64], q: &[f64]| d.iter().zip(q).map(|(d, q)| d.hypot(*q)).fold(0.0, f64::max);
    let (i, u) = (largest(&columns.id, &columns.iq), largest(&columns.ud, &columns.uq));
    let rests = || (0..columns.t.len()).filter(|row| columns.id[*row].hypot(columns.iq[*row]) < NO_CURRENT * i);
    let count = rests().count();
    let (d, q) = rests().fold((0.0, 0.0), |(d, q), row| (d + columns.ud[row], q + columns.uq[row]));
    count >= LEAST_ROWS && f64::hypot(d, q) < NO_VOLTAGE * u * count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step of 10 A after 50 rows, through 0.5 ohm; the same beside 12 V of magnets that turn; and a current that is held throughout.
    #[test]
    fn a_step_from_nothing_shows_it() {
        let log = |first: f64, magnets: f64| {
            let id: Vec<f64> = (0..200).map(|k| if k < 50 { first } else { 10.0 }).collect();
            let ud = id.iter().map(|i| 0.5 * i).collect();
            let all = |value: f64| vec![value; 200];
            Columns { t: all(0.0), ud, uq: all(magnets), id, iq: all(0.0), omega_e: all(0.0), ..Columns::default() }
        };
        assert!(shows_rest(&log(0.01, 0.0)));
        assert!(!shows_rest(&log(0.01, 12.0)));
        assert!(!shows_rest(&log(10.0, 0.0)));
    }

    /// 10 V to either side in turn, through 0.5 ohm and 2 mH, for as long as the winding takes, and never without current; the same beside
    /// the 5 V of magnets, or with currents of a motor that turns by 300 rad/s; and 0.6 V an ampere of magnets that turn with their load.
    #[test]
    fn currents_that_answer_through_inductances_show_it() {
        const PERIOD: f64 = 1e-4;
        let log = |magnets: f64, omega: f64| {
            let mut columns = Columns { omega_e: vec![0.0; 2000], ..Columns::default() };
            let mut i = [5.0, 8.0];
            for row in 0..2000_u32 {
                let sign = |length: u32| if (row / length).is_multiple_of(2) { 1.0 } else { -1.0 };
                let u = [10.0 * sign(40), 6.0 * sign(60) + magnets];
                let slopes = [(u[0] - 0.5 * i[0]) / 2e-3 + omega * i[1], (u[1] - magnets - 0.5 * i[1]) / 2e-3 - omega * i[0]];
                columns.t.push(f64::from(row) * PERIOD);
                let all = [(&mut columns.ud, u[0]), (&mut columns.uq, u[1]), (&mut columns.id, i[0]), (&mut columns.iq, i[1])];
                all.into_iter().for_each(|(column, value)| column.push(value));
                i = [i[0] + PERIOD * slopes[0], i[1] + PERIOD * slopes[1]];
            }
            columns
        };
        assert!(answers_as_at_rest(&log(0.0, 0.0)));
        assert!(!answers_as_at_rest(&log(5.0, 0.0)));
        assert!(!answers_as_at_rest(&log(0.0, 300.0)));
        let mut alike = log(0.0, 0.0);
        (alike.ud, alike.uq) = (vec![0.0; 2000], alike.iq.iter().map(|i| 0.6 * i).collect());
        assert!(!answers_as_at_rest(&alike));
    }
}

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

/// Slopes of at least this part of the steepest are those of steps. Between long steps the voltages are the resistance's alone, so
/// that these rows are looked at by themselves.
const STEEP: f64 = 0.5;

/// Spans with such slopes: one or two have as many numbers as the motor.
const LEAST_STEEP: usize = 4;

/// Part of their squares that inductances explain at least. Of tests with steps of a hundred time constants to either side of zero: 75 to
/// 98 %.
const STEPPED: f64 = 0.3;

/// What lies along the d axis has less than this part of its mean square across it. The magnets of a motor that turns induce a voltage
/// across the d axis: of 585 simulated ones at least a third.
const ACROSS: f64 = 0.01;

/// Whether the log is one of a rotor that stands.
pub(super) fn shows_rest(columns: &Columns) -> bool {
    has_moment_of_rest(columns) || answers_as_at_rest(columns)
}

/// Whether `u = R i + L di/dt` holds along both axes, and either its second part matters or nothing lies across the d axis.
fn answers_as_at_rest(columns: &Columns) -> bool {
    let spans = Spans::of(columns);
    let all = spans.left();
    let steep = spans.steep();
    let is_stepped = || steep.slopes[0].len() >= LEAST_STEEP && steep.left().inductive > STEPPED;
    all.with < MOST_LEFT && (all.inductive > INDUCTIVE || is_stepped() || spans.lie_along_d())
}

/// Means and slopes over spans of rows, of each axis.
struct Spans {
    voltages: [Vec<f64>; 2],
    currents: [Vec<f64>; 2],
    slopes: [Vec<f64>; 2],
}

/// Parts of the squares of the voltages.
struct Left {
    /// What a resistance and inductances leave.
    with: f64,
    /// What the inductances explain beside the resistance.
    inductive: f64,
}

impl Spans {
    fn of(columns: &Columns) -> Self {
        let Columns { t, ud, uq, id, iq, .. } = columns;
        let spans = || (0..t.len().saturating_sub(1) / SPAN).map(|k| k * SPAN..(k + 1) * SPAN);
        let mean = |values: &[f64]| spans().map(|rows| values[rows].iter().sum::<f64>() / SPAN as f64).collect::<Vec<f64>>();
        // A current goes on to the next row.
        let beside = |values: &[f64]| {
            let ends = spans().map(|rows| 0.5 * (values[rows.end] - values[rows.start]) / SPAN as f64);
            mean(values).into_iter().zip(ends).map(|(mean, ends)| mean + ends).collect()
        };
        let slope = |values: &[f64]| spans().map(|rows| (values[rows.end] - values[rows.start]) / (t[rows.end] - t[rows.start])).collect();
        Self { voltages: [mean(ud), mean(uq)], currents: [beside(id), beside(iq)], slopes: [slope(id), slope(iq)] }
    }

    /// Those with the steepest slopes.
    fn steep(&self) -> Self {
        let slopes: Vec<f64> = self.slopes[0].iter().zip(&self.slopes[1]).map(|(d, q)| d.hypot(*q)).collect();
        let limit = STEEP * slopes.iter().copied().fold(0.0, f64::max);
        let kept = |values: &Vec<f64>| values.iter().zip(&slopes).filter(|(_, slope)| **slope >= limit).map(|(value, _)| *value).collect();
        let of_both = |axes: &[Vec<f64>; 2]| [kept(&axes[0]), kept(&axes[1])];
        Self { voltages: of_both(&self.voltages), currents: of_both(&self.currents), slopes: of_both(&self.slopes) }
    }

    fn left(&self) -> Left {
        let nothing = vec![0.0; self.slopes[0].len()];
        let (u, resistive) = (self.voltages.concat(), self.currents.concat());
        let inductive = [[&self.slopes[0][..], &nothing].concat(), [&nothing[..], &self.slopes[1]].concat()];
        let squares = dot(&u, &u);
        let left = |columns: &[Vec<f64>]| {
            let right = DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, &u)));
            1.0 - right.dot(&(NormalMatrix::of(columns).inverse() * &right)) / squares
        };
        let with = left(&[&[resistive.clone()][..], &inductive].concat());
        // Without voltages no number.
        Left { with, inductive: left(&[resistive]) - with }
    }

    fn lie_along_d(&self) -> bool {
        let along = |[d, q]: &[Vec<f64>; 2]| dot(q, q) < ACROSS * dot(d, d);
        along(&self.voltages) && along(&self.currents)
    }
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

    /// Steps of a hundred time constants through 0.5 ohm and 2 mH, begun with current. To either side of zero; to one side, which shows
    /// rest along the d axis, but is like a load that grows with the speed along the other; and the former with the voltage of magnets.
    #[test]
    fn long_steps_show_it() {
        const PERIOD: f64 = 1e-4;
        let log = |levels: [f64; 2], axis: usize, magnets: f64| {
            let mut columns = Columns { omega_e: vec![0.0; 16_000], ..Columns::default() };
            let mut i = levels[0] / 0.5;
            for row in 0..16_000_u32 {
                let u = levels[(row / 4000 % 2) as usize];
                let of = |value: f64, place: usize| if place == axis { value } else { 0.0 };
                columns.t.push(f64::from(row) * PERIOD);
                columns.ud.push(of(u, 0));
                columns.uq.push(of(u, 1) + magnets);
                columns.id.push(of(i, 0));
                columns.iq.push(of(i, 1));
                i += PERIOD * (u - 0.5 * i) / 2e-3;
            }
            columns
        };
        let (both, one) = ([5.0, -5.0], [4.0, 5.0]);
        assert!(answers_as_at_rest(&log(both, 0, 0.0)) && answers_as_at_rest(&log(both, 1, 0.0)));
        assert!(answers_as_at_rest(&log(one, 0, 0.0)) && !answers_as_at_rest(&log(one, 1, 0.0)));
        assert!(!answers_as_at_rest(&log(both, 0, 2.0)) && !answers_as_at_rest(&log(one, 0, 2.0)));
    }
}

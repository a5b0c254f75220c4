//! The logged angle against the logged speed, and the currents against the angle.

use super::finding::ColumnFinding;
use crate::{frames::Dq, log::Log};
use std::{
    f64::consts::{FRAC_PI_2, PI, TAU},
    ops::Range,
};

/// Rows in which the angle is compared with the speed at once: noise and steps of an angle average out.
const BLOCK: usize = 16;

/// Fewest rows that tell a ratio.
const LEAST_ROWS: usize = 64;

/// A ratio as near to one as this is that of a speed that lags a little, or of a coarse angle.
const TOLERANCE: f64 = 0.03;

/// A speed lags if its own slope explains what the angle turns beyond it, and a ratio leaves so many times as much.
const TIMES_WORSE: f64 = 2.0;

/// Powers of 1000 are recognized this well: both columns were converted from the same numbers.
const OF_POWER: f64 = 0.05;

/// Least squared correlation of angle and speed for a ratio to mean something.
const CORRELATION: f64 = 0.98;

/// Turns of more than this between rows, rad, cannot be told from turns the other way.
const MOST_TURN: f64 = 2.5;

/// Share of rows that may turn more: the end of a mechanical turn, a lost row.
const FEW: f64 = 0.02;

/// Where whole turns lie between rows, the angle goes on by what the speed says but for whole turns: within this on average, rad. An
/// angle that is not the speed's is a quarter of a turn away on average.
const OF_SPEED: f64 = 0.5;

/// Where the turns between rows, as vectors of length one, have a mean longer than this, they are nearly the same in all rows: then an
/// angle may fit them by chance.
const ALL_ALIKE: f64 = 0.7;

/// Most pole pairs by which a speed is taken to be wrong.
const MOST_PAIRS: f64 = 64.0;

/// A log that turns less than this in all, rad, tells no ratio.
const LEAST_TURN: f64 = PI;

/// The range of an angle in degrees within one turn: not counted over many turns, and not in radians.
const DEGREES: Range<f64> = 300.0..360.5;

/// The angle's rate over the speed, if it is not one.
pub(super) fn angle_against_speed(log: &Log) -> Option<ColumnFinding> {
    let theta = log.columns().theta_e.as_ref()?;
    let (low, high) = theta.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), angle| (low.min(*angle), high.max(*angle)));
    if DEGREES.contains(&(high - low)) && is_in_degrees(log, theta) {
        return Some(ColumnFinding::AngleInDegrees);
    }
    let ratio = ratio(log, theta, TAU)?;
    if (ratio - 1.0).abs() <= TOLERANCE {
        return None;
    }
    let power = 1e3_f64.powi((ratio.abs().log10() / 3.0).round() as i32);
    if power != 1.0 && (ratio / power - 1.0).abs() <= OF_POWER {
        return Some(ColumnFinding::TimeUnit { factor: power });
    }
    if (ratio + 1.0).abs() <= TOLERANCE {
        return Some(ColumnFinding::SpeedSign { wrong: None });
    }
    Some(ColumnFinding::SpeedUnit { ratio })
}

/// Whether an angle turns with the speed if it is taken to be in degrees, and not if in radians.
fn is_in_degrees(log: &Log, theta: &[f64]) -> bool {
    let as_radians = ratio(log, theta, TAU).is_some_and(|ratio| (ratio - 1.0).abs() <= TOLERANCE);
    let as_degrees = ratio(log, theta, 360.0).is_some_and(|ratio| (ratio.to_radians() - 1.0).abs() <= TOLERANCE);
    as_degrees && !as_radians
}

/// The rate of an angle with this period over the speed; one where the speed is that of a filter of first order, or of a delay, which
/// `identify` finds and undoes; `None` where the log does not tell it.
fn ratio(log: &Log, theta: &[f64], period: f64) -> Option<f64> {
    let columns = log.columns();
    // Over blocks of rows: by how much the angle turns, by how much it should by the speed, and by how much that changes.
    let mut blocks: Vec<[f64; 3]> = Vec::new();
    let (mut rows, mut far) = (0, 0);
    // Rows between which the rotor turns by more than half a turn, by the speed, and what the angle turns beyond that, but for whole turns.
    let (mut apart, mut beside, mut mean) = (0, 0.0, Dq { d: 0.0, q: 0.0 });
    for segment in log.segments() {
        let mut block = [0.0; 3];
        for (count, row) in (segment.rows.start + 1..segment.rows.end).enumerate() {
            let step = theta[row] - theta[row - 1];
            let step = step - period * (step / period).round();
            let by_speed = 0.5 * (columns.omega_e[row] + columns.omega_e[row - 1]) * (columns.t[row] - columns.t[row - 1]);
            rows += 1;
            far += usize::from(step.abs() > MOST_TURN / TAU * period);
            if by_speed.abs() > PI {
                let turns = step / period - by_speed / TAU;
                apart += 1;
                beside += TAU * (turns - turns.round()).abs();
                mean = Dq { d: mean.d + by_speed.cos(), q: mean.q + by_speed.sin() };
            }
            block = [block[0] + step, block[1] + by_speed, block[2] + columns.omega_e[row] - columns.omega_e[row - 1]];
            if (count + 1) % BLOCK == 0 {
                blocks.push(std::mem::take(&mut block));
            }
        }
    }
    let is_in_step = 2 * apart > rows && beside < OF_SPEED * apart as f64;
    let are_all_alike = mean.magnitude() > ALL_ALIKE * apart as f64;
    // By the angle or by the speed: an angle in turns turns less than it says.
    let turned: f64 = blocks.iter().map(|[angle, speed, _]| (angle.abs() * TAU / period).max(speed.abs())).sum();
    let of = |one: &dyn Fn(&[f64; 3]) -> f64, other: &dyn Fn(&[f64; 3]) -> f64| -> f64 { blocks.iter().map(|k| one(k) * other(k)).sum() };
    let (angle, speed, change) = (|k: &[f64; 3]| k[0], |k: &[f64; 3]| k[1], |k: &[f64; 3]| k[2]);
    let beyond = |k: &[f64; 3]| k[0] - k[1];
    let (of_angle, of_speed, of_both) = (of(&angle, &angle), of(&speed, &speed), of(&angle, &speed));
    let is_told = rows >= LEAST_ROWS && far as f64 <= FEW * rows as f64 && turned >= LEAST_TURN && of_angle > 0.0 && of_speed > 0.0;
    if !is_told || of_both * of_both < CORRELATION * of_angle * of_speed {
        return None;
    }
    // Behind a filter of first order the angle turns by the speed and by the lag times its slope; a lag lets it turn further as the speed
    // grows.
    let (of_change, lagging) = (of(&change, &change), of(&beyond, &change));
    let left_by_lag = of(&beyond, &beyond) - if of_change > 0.0 { lagging * lagging / of_change } else { 0.0 };
    let left_by_ratio = of_angle - of_both * of_both / of_speed;
    let is_lag = lagging > 0.0 && TIMES_WORSE * left_by_lag < left_by_ratio;
    let ratio = if is_lag { 1.0 } else { of_both / of_speed };
    // Whole turns lie between the rows, unless pole pairs or a unit explain the angle as well: then it turns forward.
    let is_aliased = is_in_step && !is_of_pairs(ratio) && (ratio < 0.0 || !are_all_alike);
    (!is_aliased).then_some(ratio)
}

/// Whether a ratio is that of a speed or an angle of the shaft.
fn is_of_pairs(ratio: f64) -> bool {
    let is_whole = |number: f64| (1.0 - TOLERANCE..=MOST_PAIRS).contains(&number) && (number / number.round() - 1.0).abs() <= TOLERANCE;
    is_whole(ratio) || is_whole(1.0 / ratio)
}

/// Rows with less current than this share of the largest are not counted.
const LEAST_CURRENT: f64 = 0.2;

/// The current turns in its own frame if its correlation with itself a quarter turn later is below this.
const TURNS: f64 = 0.0;

/// It stands still in a frame that turns back twice as fast if that correlation is above this there.
const STANDS: f64 = 0.8;

/// Whether the current turns backward in the frame of the angle, twice as fast: phases b and c, or two others, have changed places.
pub(super) fn phase_order(log: &Log) -> Option<ColumnFinding> {
    let columns = log.columns();
    let theta = columns.theta_e.as_ref()?;
    let current = |row: usize| Dq { d: columns.id[row], q: columns.iq[row] };
    let least = LEAST_CURRENT * log.peak_current();
    let (mut own, mut backward, mut length, mut pairs) = (0.0, 0.0, 0.0, 0);
    for segment in log.segments() {
        for row in segment.rows.clone() {
            let turn = |later: usize| {
                let step = theta[later] - theta[row];
                step - TAU * (step / TAU).round()
            };
            // The first row a quarter of a turn later, by the speed; slow rows have none.
            let speed = columns.omega_e[row].abs();
            let quarter = columns.t[row] + FRAC_PI_2 / speed;
            let later = row + columns.t[row..segment.rows.end].partition_point(|t| *t < quarter);
            if later >= segment.rows.end || speed * (columns.t[later] - columns.t[row]) > PI {
                continue;
            }
            let (before, after) = (current(row), current(later));
            if before.magnitude() < least || after.magnitude() < least {
                continue;
            }
            let back = after.turned(2.0 * turn(later));
            own += before.d * after.d + before.q * after.q;
            backward += before.d * back.d + before.q * back.q;
            length += before.magnitude() * after.magnitude();
            pairs += 1;
        }
    }
    (pairs >= LEAST_ROWS && own < TURNS * length && backward > STANDS * length).then_some(ColumnFinding::PhaseOrder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// Rows so many seconds apart, at so many electrical Hz for a third each, with a speed that is so many times as large in the log.
    fn log(period: f64, hertz: [f64; 3], factor: f64) -> Log {
        let (mut columns, mut theta, mut angles) = (Columns::default(), 0.0, Vec::new());
        for row in 0..600 {
            let omega_e = TAU * hertz[row / 200] * (1.0 + 1e-3 * (0.7 * row as f64).sin());
            theta += omega_e * period;
            angles.push(theta.rem_euclid(TAU));
            columns.t.push(period * row as f64);
            columns.omega_e.push(factor * omega_e);
            let channels = [&mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq];
            channels.into_iter().for_each(|channel| channel.push(1.0 + (0.3 * row as f64).sin()));
        }
        Log::new(Columns { theta_e: Some(angles), ..columns }).unwrap()
    }

    /// A recorder of 83 Hz at three speeds of 81 to 390 Hz: one to four turns lie between two rows, and the angle goes on by what is left,
    /// here a few hundredths of a turn.
    #[test]
    fn an_angle_between_whose_rows_lie_whole_turns_is_that_of_the_speed() {
        for hertz in [[81.0, 207.0, 390.0], [80.0, 240.0, 400.0]] {
            assert_eq!(angle_against_speed(&log(0.012, hertz, 1.0)), None, "{hertz:?}");
        }
    }

    /// A quarter of a turn between rows, and a speed with five pole pairs too many: exactly a turn more, or one to three.
    #[test]
    fn a_speed_that_is_whole_turns_too_large_is_told() {
        for hertz in [[50.0; 3], [16.0, 32.0, 48.0]] {
            let found = angle_against_speed(&log(0.005, hertz, 5.0));
            assert!(matches!(found, Some(ColumnFinding::SpeedUnit { ratio }) if (ratio - 0.2).abs() < 0.01), "{hertz:?} {found:?}");
        }
    }
}

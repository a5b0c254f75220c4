//! A time that was written with too few digits: groups of rows have the same one, 0, 0, 0, 0.001, 0.001, 0.001.

use super::{channels::Channels, chosen::ChosenColumn};
use crate::{channel::Channel, problem::Problem};
use fluxfit_files::FileError;
use fluxfit_units::significant;

/// Fewest groups of rows with the same time by which it is called rounded.
const FEWEST_GROUPS: usize = 5;

/// Fewest rows of a group in the mean: a file of which some rows were written twice has fewer.
const FEWEST_ROWS: f64 = 1.5;

/// Rows by which the first and the last group together may differ from the others.
const ENDS: f64 = 2.0;

/// Most digits of the period that is proposed.
const MOST_DIGITS: i32 = 5;

/// Share of the groups and of their distances that may differ from the others: rows that are missing, and a timer that was late.
const OTHERS: f64 = 0.1;

/// Refuses a log with such times.
pub(super) fn refuse(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let Some(problem) = problem(channels) else { return Ok(()) };
    let time = chosen.iter().find(|column| column.channel == Channel::T);
    Err(time.map_or_else(|| problem.clone().into(), |time| FileError::from(problem.clone()).in_column(&time.header)))
}

/// The problem, where most groups have as many rows as the others, within one, and are as far apart.
fn problem(channels: &Channels) -> Option<Problem> {
    let t = channels.get(Channel::T)?;
    // That of most logs differs at once.
    let starts: Vec<usize> = std::iter::once(0).chain((1..t.len()).filter(|&row| t[row] != t[row - 1])).collect();
    if starts.len() < FEWEST_GROUPS || (t.len() as f64) < FEWEST_ROWS * starts.len() as f64 {
        return None;
    }
    // The first group and the last may be cut off.
    let inner: Vec<(f64, f64)> = starts.windows(2).skip(1).map(|pair| ((pair[1] - pair[0]) as f64, t[pair[1]] - t[pair[0]])).collect();
    let rows: Vec<f64> = inner.iter().map(|(rows, _)| *rows).collect();
    let steps: Vec<f64> = inner.iter().map(|(_, step)| *step).collect();
    let (rows, step) = (median(rows), median(steps));
    let is_regular = |(of, by): &&(f64, f64)| (of - rows).abs() <= 1.0 && (by - step).abs() <= OTHERS * step;
    let regular: Vec<f64> = inner.iter().filter(is_regular).map(|(rows, _)| *rows).collect();
    let is_rounded = rows > 1.0 && step > 0.0 && regular.len() as f64 >= (1.0 - OTHERS) * inner.len() as f64;
    let mean = regular.iter().sum::<f64>() / regular.len() as f64;
    // The ends of the first group and of the last are within a row.
    let accuracy = ENDS / t.len() as f64;
    let in_ms = |seconds: f64| format!("{} ms", shortest(1e3 * seconds, accuracy));
    is_rounded.then(|| Problem::RoundedTime { rows: shortest(mean, accuracy), step: in_ms(step), period: in_ms(step / mean) })
}

/// A number with as few digits as have it within a share of it: periods of drives are round.
pub(super) fn shortest(number: f64, accuracy: f64) -> String {
    let is_near = |text: &String| text.parse::<f64>().is_ok_and(|near| (near - number).abs() <= accuracy * number);
    let mut texts = (1..MOST_DIGITS).map(|digits| significant(number, digits));
    texts.find(is_near).unwrap_or_else(|| significant(number, MOST_DIGITS))
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(t: Vec<f64>) -> Option<Problem> {
        problem(&Channels { columns: vec![(Channel::T, t)], ..Channels::default() })
    }

    #[test]
    fn a_time_that_repeats_in_regular_groups_is_rounded() {
        let rounded = |period: f64| (0..2000).map(|row| (f64::from(row) * period * 1e3).round() / 1e3).collect::<Vec<f64>>();
        let expected = |rows: &str, period: &str| Problem::RoundedTime { rows: rows.into(), step: "1 ms".into(), period: period.into() };
        assert_eq!(of(rounded(1e-4)), Some(expected("10", "0.1 ms")));
        // 16 kHz: groups of 16, 2.5 kHz: of two and of three.
        assert_eq!(of(rounded(62.5e-6)), Some(expected("16", "0.0625 ms")));
        assert_eq!(of(rounded(4e-4)), Some(expected("2.5", "0.4 ms")));
        assert_eq!(of(rounded(1e-3)), None);
        // Some rows twice, a time that stands still, and one that starts again.
        assert_eq!(of((0..200).map(|row| f64::from(row - row % 10 / 9)).collect()), None);
        assert_eq!(of(vec![1.0; 200]), None);
        assert_eq!(of((0..200).map(|row| f64::from(row % 20)).collect()), None);
    }
}

//! A rotor that stands still, in a log whose speed is zero throughout. Drives that did not log their speed have the same column, so the log
//! must show it: somewhere the current is zero, and the voltage there is nearly none, because no magnet turns.

use super::columns::Columns;

/// A current below this part of the largest is none.
const NO_CURRENT: f64 = 0.05;

/// A voltage below this part of the largest is none.
const NO_VOLTAGE: f64 = 0.2;

/// Rows without a current, in the mean of which noise and a controller's answers to it cancel.
const LEAST_ROWS: usize = 10;

/// Whether there is a moment without current and voltage.
pub(super) fn shows_rest(columns: &Columns) -> bool {
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
}

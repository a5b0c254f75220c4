//! What the first rows of a table tell about its columns: which hold instants, which hold no numbers, and which can be no measured
//! values.

use crate::instant::{Instants, counted, elapsed};
use fluxfit_files::csv::{
    header::{Header, is_number},
    record::{first_record, number},
};

/// Number of rows that are looked at for instants.
const ROWS: usize = 1000;

/// Digits before the point of the shortest number of seconds since 1970.
const EPOCH_DIGITS: usize = 9;

/// Number of rows that are looked at for numbers.
const ROWS_OF_NUMBERS: usize = 100;

/// Fewest equal numbers of which a column is called constant.
const FEWEST_EQUAL: usize = 20;

/// Larger numbers mean that there is no value, as 9.9e37 of an instrument that cannot measure.
const NO_VALUE: f64 = 1e9;

/// Times may fall once, at the end of a day or of a counter.
const MOST_FALLS: usize = 1;

/// What the cells of a column tell in the first rows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct FirstCells {
    /// They are not all texts or empty.
    pub(crate) has_numbers: bool,
    /// The one number that all of them are, if they are many.
    pub(crate) constant: Option<f64>,
    /// Some numbers are too large for a measured value.
    pub(crate) has_no_value: bool,
    /// They are only 0 and 1, and both.
    pub(crate) is_flag: bool,
    /// They fall, as a time does not.
    pub(crate) falls: bool,
    /// They rise by the same step from row to row, as the numbers of the rows do.
    pub(crate) counts: bool,
}

impl FirstCells {
    fn of(numbers: &[f64], is_instant: bool) -> Self {
        let has = |number: f64| numbers.contains(&number);
        let first = numbers.first().copied();
        Self {
            has_numbers: first.is_some() || is_instant,
            constant: first.filter(|first| numbers.len() >= FEWEST_EQUAL && numbers.iter().all(|number| number == first)),
            has_no_value: numbers.iter().any(|number| number.abs() > NO_VALUE),
            is_flag: has(0.0) && has(1.0) && numbers.iter().all(|number| [0.0, 1.0].contains(number)),
            counts: numbers.len() >= FEWEST_EQUAL && counts(numbers),
            falls: numbers.windows(2).filter(|pair| pair[1] < pair[0]).count() > MOST_FALLS,
        }
    }
}

/// Steps that differ by a smaller part are the same: the digits of a time leave more.
const SAME_STEP: f64 = 1e-6;

/// Whether numbers rise by the same step from row to row, as the numbers of the rows do.
pub(crate) fn counts(numbers: &[f64]) -> bool {
    let step = numbers.get(1).zip(numbers.first()).map_or(0.0, |(second, first)| second - first);
    step > 0.0 && numbers.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < SAME_STEP * step)
}

/// What the first rows tell of each column; nothing of a table without rows.
pub(super) fn cells(head: &str, header: &Header, is_instant: impl Fn(usize) -> bool) -> Vec<FirstCells> {
    let rows = head[header.body.min(head.len())..].split(['\r', '\n']).filter(|line| !line.trim().is_empty());
    let table: Vec<Vec<String>> = rows.take(ROWS_OF_NUMBERS).map(|line| first_record(line, header.separator).0).collect();
    if table.is_empty() {
        return Vec::new();
    }
    let mut scratch = String::new();
    let mut number = |cell: &String| number(cell.as_bytes(), b';', &mut scratch).filter(|number| !number.is_nan());
    let mut of_column = |place: usize| {
        let numbers: Vec<f64> = table.iter().filter_map(|row| row.get(place)).filter_map(&mut number).collect();
        FirstCells::of(&numbers, is_instant(place))
    };
    (0..header.names.len()).map(&mut of_column).collect()
}

/// For each column, how its cells state instants, if they do.
pub(super) fn instants(head: &str, header: &Header) -> Vec<Option<Instants>> {
    let mut rows = head[header.body.min(head.len())..].split(['\r', '\n']).filter(|line| !line.trim().is_empty());
    let cells = |line: &str| first_record(line, header.separator).0;
    let Some(first) = rows.next().map(cells) else { return Vec::new() };
    let is_likely = |cell: &String| match is_number(cell) {
        true => cell.bytes().take_while(u8::is_ascii_digit).count() >= EPOCH_DIGITS,
        false => {
            let digits = cell.bytes().filter(u8::is_ascii_digit).count();
            counted(cell).is_some() || elapsed(cell).is_some() || cell.starts_with(|c: char| c.is_ascii_alphanumeric()) && digits > 3
        }
    };
    if !first.iter().any(is_likely) {
        return Vec::new();
    }
    // The head may end within the last one.
    let mut table: Vec<Vec<String>> = vec![first];
    table.extend(rows.take(ROWS).map(cells));
    if table.len() > 2 {
        table.pop();
    }
    let of_column = |place: usize| {
        let cells: Vec<&str> = table.iter().filter_map(|row| row.get(place)).map(String::as_str).filter(|cell| !cell.is_empty()).collect();
        Instants::of(&cells)
    };
    (0..header.names.len()).map(|place| table[0].get(place).filter(|cell| is_likely(cell)).and_then(|_| of_column(place))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_tell_what_is_not_measured() {
        let of = |numbers: &[f64]| FirstCells::of(numbers, false);
        let all = FirstCells { has_numbers: true, ..FirstCells::default() };
        assert_eq!(of(&[]), FirstCells::default());
        assert_eq!(of(&[1.0, 2.0, 1.5]), all);
        // A few equal rows are a steady state.
        assert_eq!(of(&[3.0; 5]), all);
        assert_eq!(of(&[3.0; 50]), FirstCells { constant: Some(3.0), ..all });
        assert_eq!(of(&[1.0, 9.9e37, 2.0]), FirstCells { has_no_value: true, ..all });
        assert_eq!(of(&[0.0, 1.0, 1.0]), FirstCells { is_flag: true, ..all });
        // A time of the day falls at midnight.
        assert_eq!(of(&[86_399.0, 86_400.0, 1.0, 2.0]), all);
        assert_eq!(of(&[2.0, 1.0, 3.0, 2.0]), FirstCells { falls: true, ..all });
        assert!(FirstCells::of(&[], true).has_numbers);
        let numbers: Vec<f64> = (1..=50).map(f64::from).collect();
        assert_eq!(of(&numbers), FirstCells { counts: true, ..all });
        assert_eq!(of(&[&numbers[..], &[51.5]].concat()), all);
    }
}

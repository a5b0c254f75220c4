//! Samples of a log that are no measurements.

use super::digits::three_digits;
use crate::sample_check::{SampleFault, SampleFinding};
use std::fmt::{Display, Formatter, Result};

impl Display for SampleFinding {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let rows = if self.rows == 1 { "1 row".to_owned() } else { format!("{} rows", self.rows) };
        let time = if self.first_time == 0.0 { "0".to_owned() } else { three_digits(self.first_time) };
        let place = format!("the first at t = {time} s (row {})", self.first_row + 1);
        match (self.kind, self.column) {
            (SampleFault::Outlier, column) => write!(
                f,
                "{} has outliers in {rows}, {place}: far beside the rows before and after, and nothing else in the log moves with them; remove these rows",
                column.unwrap_or("the log")
            ),
            (SampleFault::Stale, Some(column)) => write!(
                f,
                "{column} repeats its value in {rows}, {place}, while other columns move: the recorder had no new sample; log all columns at one rate, or remove these rows"
            ),
            (SampleFault::Stale, None) => write!(
                f,
                "{rows} repeat the row before, {place}: the recorder writes faster than the drive reports; log at the rate of the drive, or remove these rows"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::sample_check::{SampleFault, SampleFinding};

    #[test]
    fn the_sentence_names_column_rows_place_and_what_to_do() {
        let finding = |kind, column, rows| SampleFinding { kind, column, rows, first_row: 350, first_time: 0.035 }.to_string();
        assert_eq!(
            finding(SampleFault::Outlier, Some("iq"), 1),
            "iq has outliers in 1 row, the first at t = 0.0350 s (row 351): far beside the rows before and after, and nothing else in the log moves with them; remove these rows"
        );
        assert!(
            finding(SampleFault::Stale, Some("ud"), 2).starts_with("ud repeats its value in 2 rows, the first at t = 0.0350 s (row 351), ")
        );
        assert!(finding(SampleFault::Stale, None, 7).starts_with("7 rows repeat the row before, the first at t = 0.0350 s (row 351): "));
    }
}

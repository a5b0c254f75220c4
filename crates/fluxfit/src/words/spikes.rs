//! The rows that were left out of a log as spikes.

use super::digits::three_digits;
use crate::log::Spikes;
use std::fmt::{Display, Formatter, Result};

impl Display for Spikes {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let Some(first) = self.all().first() else { return write!(f, "no row has a value that no drive had") };
        match self.rows() {
            1 => write!(f, "1 row with a value that no drive had is left out, as a gap")?,
            rows => write!(f, "{rows} rows with values that no drive had are left out, as gaps")?,
        }
        let unit = match first.column {
            "omega_e" => "rad/s",
            "id" | "iq" => "A",
            _ => "V",
        };
        // The first row has the time 0 in many logs.
        let time = if first.time == 0.0 { "0".to_owned() } else { three_digits(first.time) };
        write!(f, ": {} is {:e} {unit} at t = {time} s", first.column, first.value)?;
        match self.all().len() {
            1 => Ok(()),
            spikes => write!(f, ", and {} more", spikes - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::log::{Columns, Log};

    #[test]
    fn the_sentence_names_rows_column_value_and_time() {
        let said = |rows: &[usize]| {
            let mut omega_e = vec![400.0; 200];
            rows.iter().for_each(|row| omega_e[*row] = -1e6);
            let ones = || vec![1.0; 200];
            let t = (0..200).map(|k| f64::from(k) * 1e-3).collect();
            Log::new(Columns { t, ud: ones(), uq: ones(), id: ones(), iq: ones(), omega_e, ..Columns::default() })
                .unwrap()
                .spikes()
                .to_string()
        };
        assert_eq!(said(&[80]), "1 row with a value that no drive had is left out, as a gap: omega_e is -1e6 rad/s at t = 0.0800 s");
        let two = "2 rows with values that no drive had are left out, as gaps: omega_e is -1e6 rad/s at t = 0 s, and 1 more";
        assert_eq!(said(&[0, 90]), two);
    }
}

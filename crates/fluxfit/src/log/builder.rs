//! A log that grows row by row or block by block, checked on the way in.

use super::{
    checked::Log,
    columns::{Columns, MIN_ROWS, Row},
    segment, short_circuit,
    spikes::Spikes,
    standstill,
};
use crate::{
    error::{Error, ErrorKind},
    quantization,
};

/// Largest magnitude of any value. No drive has a gigavolt; squares and sums of such numbers stay far from overflow.
const MAX_MAGNITUDE: f64 = 1e9;

/// Largest magnitude of a winding's temperature, degC: more than insulation bears, and less than the 235 K below zero at which copper's
/// resistance would vanish.
const MAX_TEMPERATURE: f64 = 230.0;

/// Times may be this much larger: they may be seconds since 1970.
const TIME_FACTOR: f64 = 1e3;

/// Collects rows from a reader, a socket or a test bench, and checks each of them: finite and plausible values, increasing time.
///
/// A row or a block that is refused is not added, so the rows before it stay usable. The error names column and row; rows count from
/// 0 over all that was added. The first row decides which optional columns the log has: every later row must have the same ones.
///
/// ```
/// use fluxfit::log::{LogBuilder, Row};
///
/// let mut builder = LogBuilder::new();
/// for k in 0..100 {
///     let t = f64::from(k) * 1e-4;
///     builder.push(Row { t, ud: -20.0, uq: 90.0, id: -2.0, iq: 6.0, omega_e: 400.0, ..Row::default() })?;
/// }
/// let late = builder.push(Row { t: 0.0, ..Row::default() }).unwrap_err();
/// assert_eq!((late.column(), late.row()), (Some("t"), Some(100)));
///
/// let log = builder.finish()?;
/// assert_eq!(log.rows(), 100);
/// # Ok::<(), fluxfit::error::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LogBuilder {
    columns: Columns,
}

impl LogBuilder {
    /// A log without rows.
    pub fn new() -> Self {
        Self::default()
    }

    /// Rows added so far.
    pub fn rows(&self) -> usize {
        self.columns.t.len()
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If a value is not finite or implausibly large, the time is not after that of the row before, or the row lacks an optional
    /// column that the others have, or has one that they lack.
    pub fn push(&mut self, row: Row) -> Result<(), Error> {
        let Row { t, ud, uq, id, iq, omega_e, theta_e, u_dc, temperature } = row;
        if self.rows() == 0 {
            return self.take(row.into());
        }
        let at = self.rows();
        let Columns { theta_e: angles, u_dc: voltages, temperature: temperatures, .. } = &self.columns;
        for (column, held, given) in [("theta_e", angles, theta_e), ("u_dc", voltages, u_dc), ("temperature", temperatures, temperature)] {
            check_presence(column, held.is_some(), given.is_some(), at, 1)?;
        }
        let needed = [("t", t), ("ud", ud), ("uq", uq), ("id", id), ("iq", iq), ("omega_e", omega_e)];
        let optional = [("theta_e", theta_e), ("u_dc", u_dc), ("temperature", temperature)];
        let optional = optional.into_iter().filter_map(|(column, value)| Some((column, value?)));
        needed.into_iter().chain(optional).try_for_each(|(column, value)| check_value(column, at, value))?;
        check_order(self.columns.t[at - 1], t, at)?;
        let columns = &mut self.columns;
        columns.t.push(t);
        columns.ud.push(ud);
        columns.uq.push(uq);
        columns.id.push(id);
        columns.iq.push(iq);
        columns.omega_e.push(omega_e);
        let optional = [(&mut columns.theta_e, theta_e), (&mut columns.u_dc, u_dc), (&mut columns.temperature, temperature)];
        for (column, value) in optional {
            if let Some((column, value)) = column.as_mut().zip(value) {
                column.push(value);
            }
        }
        Ok(())
    }

    /// Adds the rows of a block of columns, all or none.
    ///
    /// ```
    /// use fluxfit::log::{Columns, LogBuilder};
    ///
    /// let block = |t: Vec<f64>| {
    ///     let all = |value: f64| vec![value; t.len()];
    ///     Columns { ud: all(-20.0), uq: all(90.0), id: all(-2.0), iq: all(6.0), omega_e: all(400.0), t, ..Columns::default() }
    /// };
    /// let mut builder = LogBuilder::new();
    /// builder.extend(&block(vec![0.0, 1e-4, 2e-4]))?;
    /// builder.extend(&block(vec![3e-4, 4e-4]))?;
    /// assert!(builder.extend(&block(vec![5e-4, f64::NAN])).is_err());
    /// assert_eq!(builder.finish()?.rows(), 5);
    /// # Ok::<(), fluxfit::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`push`](Self::push), or if a column of the block is shorter or longer than its `t`.
    pub fn extend(&mut self, block: &Columns) -> Result<(), Error> {
        self.take(block.clone())
    }

    /// The log, with its segments and quantization steps, and without the rows that no drive had ([`Log::spikes`]).
    ///
    /// # Errors
    /// If there are fewer than two rows, or the currents are zero throughout, or the voltages without the currents of a short circuit, or
    /// the speed of a motor that does not rest.
    pub fn finish(self) -> Result<Log, Error> {
        let mut columns = self.columns;
        if columns.t.len() < MIN_ROWS {
            return Err(ErrorKind::TooShort { rows: columns.t.len(), least: MIN_ROWS }.into());
        }
        let (spikes, starts) = take_spikes(&mut columns);
        let all_zero = |columns: [&Vec<f64>; 2]| columns.iter().all(|column| column.iter().all(|value| *value == 0.0));
        if all_zero([&columns.id, &columns.iq]) {
            return Err(ErrorKind::AllZero { what: "the currents id and iq are" }.into());
        }
        if short_circuit::voltages_are_zero(&columns) && !short_circuit::currents_brake(&columns) {
            return Err(Error::no_voltages());
        }
        if all_zero([&columns.omega_e; 2]) && !standstill::shows_rest(&columns) {
            return Err(ErrorKind::AllZero { what: "the speed omega_e is" }.into());
        }
        let steps = [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].map(|column| quantization::step(column));
        let segments = segment::split(&columns.t, steps, &starts);
        Ok(Log::checked(columns, segments, spikes))
    }

    /// Checks a block and moves its rows in.
    fn take(&mut self, block: Columns) -> Result<(), Error> {
        check_lengths(&block)?;
        let first = self.rows();
        if block.t.is_empty() {
            return Ok(());
        }
        if first > 0 {
            let optional = [
                ("theta_e", self.columns.theta_e.is_some(), block.theta_e.is_some()),
                ("u_dc", self.columns.u_dc.is_some(), block.u_dc.is_some()),
                ("temperature", self.columns.temperature.is_some(), block.temperature.is_some()),
            ];
            optional.into_iter().try_for_each(|(column, held, given)| check_presence(column, held, given, first, block.t.len()))?;
        }
        check_rows(&block, first)?;
        if let (Some(before), Some(after)) = (self.columns.t.last(), block.t.first()) {
            check_order(*before, *after, first)?;
        }
        (1..block.t.len()).try_for_each(|row| check_order(block.t[row - 1], block.t[row], first + row))?;
        if first == 0 {
            self.columns = block;
        } else {
            self.columns.append(block);
        }
        Ok(())
    }
}

impl Log {
    /// Checks columns and splits them at gaps in time. Time is in s on any origin; a gap is a step of more than 2.5 times the median one.
    /// Rows that no drive had are left out, as a gap: [`spikes`](Self::spikes).
    ///
    /// # Errors
    /// If a column is shorter or longer than `t`, a value is not finite or implausibly large, time does not increase, there are fewer
    /// than two rows, the currents or the speed are zero throughout, or the voltages are without the currents of a short circuit.
    pub fn new(columns: Columns) -> Result<Self, Error> {
        check_lengths(&columns)?;
        if columns.t.len() < MIN_ROWS {
            return Err(ErrorKind::TooShort { rows: columns.t.len(), least: MIN_ROWS }.into());
        }
        let mut builder = LogBuilder::new();
        builder.take(columns)?;
        builder.finish()
    }
}

/// Takes the spikes out of columns. Returns them, and the rows, of those that are left, before which rows are missing.
fn take_spikes(columns: &mut Columns) -> (Spikes, Vec<usize>) {
    let spikes = Spikes::find(columns, &segment::without_gaps(&columns.t), segment::median_step(&columns.t));
    if spikes.is_empty() {
        return (spikes, Vec::new());
    }
    let mut kept = vec![true; columns.t.len()];
    spikes.all().iter().for_each(|spike| kept[spike.rows.clone()].fill(false));
    columns.retain(&kept);
    let mut starts = Vec::new();
    let mut row = 0;
    for pair in kept.windows(2) {
        row += usize::from(pair[0]);
        if !pair[0] && pair[1] {
            starts.push(row);
        }
    }
    (spikes, starts)
}

/// Checks one column's values, as [`Log::new`] does; `column` is its canonical name.
///
/// # Errors
/// If a value is not finite or implausibly large.
pub fn check_values(column: &'static str, values: &[f64]) -> Result<(), Error> {
    values.iter().enumerate().try_for_each(|(row, value)| check_value(column, row, *value))
}

#[inline]
fn check_value(column: &'static str, row: usize, value: f64) -> Result<(), Error> {
    if !value.is_finite() {
        return Err(ErrorKind::NotFinite { column, row, value }.into());
    }
    let limit = match column {
        "t" => MAX_MAGNITUDE * TIME_FACTOR,
        "temperature" => MAX_TEMPERATURE,
        _ => MAX_MAGNITUDE,
    };
    if value.abs() > limit {
        return Err(ErrorKind::Implausible { column, row, value, limit }.into());
    }
    Ok(())
}

/// Row by row, so that the first row with a bad value is the one named.
fn check_rows(columns: &Columns, first: usize) -> Result<(), Error> {
    for row in 0..columns.t.len() {
        for (column, values) in columns.all() {
            check_value(column, first + row, values[row])?;
        }
    }
    Ok(())
}

fn check_lengths(columns: &Columns) -> Result<(), Error> {
    let expected = columns.t.len();
    let wrong = columns.all().find(|(_, values)| values.len() != expected);
    wrong.map_or(Ok(()), |(column, values)| Err(ErrorKind::ColumnLength { column, rows: values.len(), expected }.into()))
}

/// An optional column must be in all rows or in none.
fn check_presence(column: &'static str, held: bool, given: bool, rows: usize, more: usize) -> Result<(), Error> {
    let with = if held { rows } else { more };
    if held == given { Ok(()) } else { Err(ErrorKind::ColumnLength { column, rows: with, expected: rows + more }.into()) }
}

#[inline]
fn check_order(before: f64, after: f64, row: usize) -> Result<(), Error> {
    if after <= before { Err(ErrorKind::TimeOrder { row, before, after }.into()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(t: &[f64]) -> Columns {
        let ones = vec![1.0; t.len()];
        Columns {
            t: t.to_vec(),
            ud: ones.clone(),
            uq: ones.clone(),
            id: ones.clone(),
            iq: ones.clone(),
            omega_e: ones,
            ..Columns::default()
        }
    }

    fn row(t: f64) -> Row {
        Row { t, ud: 1.0, uq: 1.0, id: 1.0, iq: 1.0, omega_e: 1.0, theta_e: None, u_dc: None, temperature: None }
    }

    #[test]
    fn rows_blocks_and_whole_columns_give_the_same_log() {
        let t = [0.0, 0.1, 0.2, 0.9, 1.0];
        let whole = Log::new(columns(&t)).unwrap();
        let mut by_row = LogBuilder::new();
        t.iter().for_each(|t| by_row.push(row(*t)).unwrap());
        let mut by_block = LogBuilder::new();
        by_block.extend(&columns(&t[..2])).unwrap();
        by_block.extend(&Columns::default()).unwrap();
        by_block.push(row(t[2])).unwrap();
        by_block.extend(&columns(&t[3..])).unwrap();
        assert_eq!(by_row.finish().unwrap(), whole);
        assert_eq!(by_block.finish().unwrap(), whole);
    }

    #[test]
    fn refused_rows_are_named_and_not_added() {
        let mut builder = LogBuilder::new();
        builder.extend(&columns(&[0.0, 0.1])).unwrap();
        assert_eq!(builder.push(row(0.1)), Err(ErrorKind::TimeOrder { row: 2, before: 0.1, after: 0.1 }.into()));
        assert_eq!(builder.extend(&columns(&[0.05, 0.3])), Err(ErrorKind::TimeOrder { row: 2, before: 0.1, after: 0.05 }.into()));
        assert_eq!(builder.extend(&columns(&[0.2, 0.3, 0.3])), Err(ErrorKind::TimeOrder { row: 4, before: 0.3, after: 0.3 }.into()));
        let infinite = Row { iq: f64::INFINITY, ..row(0.2) };
        assert_eq!(builder.push(infinite), Err(ErrorKind::NotFinite { column: "iq", row: 2, value: f64::INFINITY }.into()));
        let mut block = columns(&[0.2, 0.3]);
        block.uq[1] = 1e300;
        assert_eq!(builder.extend(&block), Err(ErrorKind::Implausible { column: "uq", row: 3, value: 1e300, limit: MAX_MAGNITUDE }.into()));
        assert_eq!(builder.rows(), 2);
        assert_eq!(builder.finish().unwrap().columns().t, [0.0, 0.1]);
    }

    #[test]
    fn an_optional_column_is_in_every_row_or_in_none() {
        let mut builder = LogBuilder::new();
        builder.push(Row { theta_e: Some(1.0), ..row(0.0) }).unwrap();
        assert_eq!(builder.push(row(0.1)), Err(ErrorKind::ColumnLength { column: "theta_e", rows: 1, expected: 2 }.into()));
        let both = Columns { theta_e: Some(vec![1.0; 2]), u_dc: Some(vec![310.0; 2]), ..columns(&[0.1, 0.2]) };
        assert_eq!(builder.extend(&both), Err(ErrorKind::ColumnLength { column: "u_dc", rows: 2, expected: 3 }.into()));
        builder.push(Row { theta_e: Some(2.0), ..row(0.1) }).unwrap();
        assert_eq!(builder.finish().unwrap().columns().theta_e, Some(vec![1.0, 2.0]));
        let short = Columns { u_dc: Some(vec![1.0]), ..columns(&[0.0, 0.1]) };
        assert_eq!(Log::new(short), Err(ErrorKind::ColumnLength { column: "u_dc", rows: 1, expected: 2 }.into()));
    }

    #[test]
    fn what_no_drive_records_is_refused_by_name_and_row() {
        let broken = |change: fn(&mut Columns)| {
            let mut columns = columns(&[0.0, 0.1, 0.2]);
            change(&mut columns);
            Log::new(columns).unwrap_err()
        };
        assert_eq!(*broken(|c| c.uq[1] = f64::INFINITY).kind(), ErrorKind::NotFinite { column: "uq", row: 1, value: f64::INFINITY });
        assert_eq!(
            *broken(|c| c.id[2] = -1e300).kind(),
            ErrorKind::Implausible { column: "id", row: 2, value: -1e300, limit: MAX_MAGNITUDE }
        );
        assert_eq!(*broken(|c| c.t[2] = 0.1).kind(), ErrorKind::TimeOrder { row: 2, before: 0.1, after: 0.1 });
        assert_eq!(*broken(|c| c.iq.truncate(2)).kind(), ErrorKind::ColumnLength { column: "iq", rows: 2, expected: 3 });
        assert!(matches!(broken(|c| (c.id.fill(0.0), c.iq.fill(0.0)).1).kind(), ErrorKind::AllZero { .. }));
        assert!(matches!(Log::new(columns(&[0.0])).unwrap_err().kind(), ErrorKind::TooShort { rows: 1, .. }));
        assert!(matches!(LogBuilder::new().finish().unwrap_err().kind(), ErrorKind::TooShort { rows: 0, .. }));
    }
}

//! The log: what a drive recorded, in SI units, checked on the way in.
//!
//! Whoever holds a [`Log`] knows: equal columns, finite plausible numbers, increasing time, some current and voltage. Time may
//! jump: a jump ends a [segment](Log::segments), and nothing is ever computed across one. Several logs of one motor
//! [join](Log::join) into one.

use crate::{error::Error, quantization};
use std::ops::Range;

/// The columns of a log, row by row in SI units; canonical names. Voltages and currents in the dq frame of [`frames`](crate::frames).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Time, s.
    pub t: Vec<f64>,
    /// Voltage along d, V.
    pub ud: Vec<f64>,
    /// Voltage along q, V.
    pub uq: Vec<f64>,
    /// Current along d, A.
    pub id: Vec<f64>,
    /// Current along q, A.
    pub iq: Vec<f64>,
    /// Speed, electrical rad/s.
    pub omega_e: Vec<f64>,
    /// Angle, electrical rad, in any turn; not every log has it.
    pub theta_e: Option<Vec<f64>>,
    /// DC voltage, V; not every log has it.
    pub u_dc: Option<Vec<f64>>,
}

impl Columns {
    /// Canonical names and columns that every log has, `t` first.
    pub fn named(&self) -> [(&'static str, &Vec<f64>); 6] {
        [("t", &self.t), ("ud", &self.ud), ("uq", &self.uq), ("id", &self.id), ("iq", &self.iq), ("omega_e", &self.omega_e)]
    }

    /// Those that this log has besides.
    pub fn optional(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        [("theta_e", &self.theta_e), ("u_dc", &self.u_dc)].into_iter().filter_map(|(name, column)| Some((name, column.as_ref()?)))
    }

    fn all(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        self.named().into_iter().chain(self.optional())
    }

    fn of_rows(&self, rows: Range<usize>) -> Self {
        let of = |column: &Vec<f64>| column[rows.clone()].to_vec();
        Self {
            t: of(&self.t),
            ud: of(&self.ud),
            uq: of(&self.uq),
            id: of(&self.id),
            iq: of(&self.iq),
            omega_e: of(&self.omega_e),
            theta_e: self.theta_e.as_ref().map(of),
            u_dc: self.u_dc.as_ref().map(of),
        }
    }

    /// Appends the rows of another log. An optional column stays only if both have it.
    fn append(&mut self, other: Self) {
        self.t.extend(other.t);
        self.ud.extend(other.ud);
        self.uq.extend(other.uq);
        self.id.extend(other.id);
        self.iq.extend(other.iq);
        self.omega_e.extend(other.omega_e);
        for (to, from) in [(&mut self.theta_e, other.theta_e), (&mut self.u_dc, other.u_dc)] {
            *to = to.take().zip(from).map(|(mut to, from)| {
                to.extend(from);
                to
            });
        }
    }
}

/// Fewest rows of a log: two make a sample period.
const MIN_ROWS: usize = 2;

/// Largest magnitude of any value. No drive has a gigavolt; squares and sums of such numbers stay far from overflow.
const MAX_MAGNITUDE: f64 = 1e9;

/// A time step this many times the median one is a gap: one lost row (2) is not, two (3) are.
const GAP_FACTOR: f64 = 2.5;

/// A checked log.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    columns: Columns,
    segments: Vec<Segment>,
    interpolated: bool,
}

/// Rows without a gap between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its rows.
    pub rows: Range<usize>,
    /// Number of the log it came from, among those joined.
    pub log: usize,
    /// Median time step of that log, s.
    pub sample_period: f64,
    /// Steps on which the channels of that log lie, in its units: `ud, uq, id, iq, omega_e`; zero for those that are not quantized.
    pub steps: [f64; 5],
}

impl Log {
    /// Checks columns and splits them at gaps.
    ///
    /// # Errors
    /// If a column is shorter than another, a value is not finite or implausibly large, time does not increase, there are less
    /// than two rows, or the currents, the voltages or the speed are zero throughout.
    pub fn new(columns: Columns) -> Result<Self, Error> {
        let rows = columns.t.len();
        for (column, values) in columns.all() {
            if values.len() != rows {
                return Err(Error::ColumnLength { column, rows: values.len(), expected: rows });
            }
        }
        if rows < MIN_ROWS {
            return Err(Error::TooShort { rows, least: MIN_ROWS });
        }
        check_rows(&columns)?;
        check_time(&columns.t)?;
        let silent = |columns: [&Vec<f64>; 2]| columns.iter().all(|column| column.iter().all(|value| *value == 0.0));
        if silent([&columns.id, &columns.iq]) {
            return Err(Error::AllZero { what: "the currents id and iq are" });
        }
        if silent([&columns.ud, &columns.uq]) {
            return Err(Error::AllZero { what: "the voltages ud and uq are" });
        }
        if silent([&columns.omega_e; 2]) {
            return Err(Error::AllZero { what: "the speed omega_e is" });
        }
        let steps = [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].map(|column| quantization::step(column));
        let segments = split(&columns.t, steps);
        Ok(Self { columns, segments, interpolated: false })
    }

    /// Several logs of one motor as one; no segment reaches from one into the next.
    ///
    /// # Errors
    /// If there is no log.
    pub fn join(logs: impl IntoIterator<Item = Self>) -> Result<Self, Error> {
        let mut logs = logs.into_iter();
        let mut joined = logs.next().ok_or(Error::TooShort { rows: 0, least: MIN_ROWS })?;
        for (number, log) in (1..).zip(logs) {
            let offset = joined.rows();
            joined.segments.extend(log.segments.into_iter().map(|segment| Segment {
                rows: segment.rows.start + offset..segment.rows.end + offset,
                log: number,
                ..segment
            }));
            joined.interpolated |= log.interpolated;
            joined.columns.append(log.columns);
        }
        Ok(joined)
    }

    /// Parts the last of several logs, or of one log the last segment, from the rest; none where there is nothing to part.
    pub fn part_last(&self) -> Option<(Self, Self)> {
        let last = self.segments.last()?;
        let several = self.segments.iter().any(|segment| segment.log != last.log);
        let belongs = |segment: &Segment| if several { segment.log == last.log } else { segment.rows == last.rows };
        let at = self.segments.iter().position(belongs).filter(|at| *at > 0)?;
        let row = self.segments[at].rows.start;
        let (first, rest) = self.segments.split_at(at);
        let rest = rest.iter().map(|segment| Segment { rows: segment.rows.start - row..segment.rows.end - row, log: 0, ..segment.clone() });
        Some((
            Self { columns: self.columns.of_rows(0..row), segments: first.to_vec(), interpolated: self.interpolated },
            Self { columns: self.columns.of_rows(row..self.rows()), segments: rest.collect(), interpolated: self.interpolated },
        ))
    }

    /// The same log, whose channels were sampled at different instants and interpolated onto common ones: its rows never were one
    /// instant of the drive, so only its steady stretches mean anything.
    pub fn of_different_instants(self) -> Self {
        Self { interpolated: true, ..self }
    }

    /// Whether the channels were interpolated onto common instants.
    pub fn is_interpolated(&self) -> bool {
        self.interpolated
    }

    /// The columns.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.t.len()
    }

    /// Stretches without a gap, in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The segment of a row.
    pub fn segment_of(&self, row: usize) -> Option<&Segment> {
        self.segments.iter().find(|segment| segment.rows.contains(&row))
    }

    /// Time covered by the segments, s: gaps do not count, each segment's last row counts one sample period.
    pub fn duration(&self) -> f64 {
        let t = &self.columns.t;
        self.segments.iter().map(|segment| t[segment.rows.end - 1] - t[segment.rows.start] + segment.sample_period).sum()
    }

    /// Largest length of the current vector in the log, A.
    pub fn peak_current(&self) -> f64 {
        self.columns.id.iter().zip(&self.columns.iq).map(|(d, q)| d.hypot(*q)).fold(0.0, f64::max)
    }
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
        return Err(Error::NotFinite { column, row, value });
    }
    // Times may be seconds since 1970.
    if value.abs() > MAX_MAGNITUDE && column != "t" || value.abs() > MAX_MAGNITUDE * 1e3 {
        return Err(Error::Implausible { column, row, value, limit: MAX_MAGNITUDE });
    }
    Ok(())
}

/// The first row that is refused is the one that is named.
fn check_rows(columns: &Columns) -> Result<(), Error> {
    for row in 0..columns.t.len() {
        for (column, values) in columns.all() {
            check_value(column, row, values[row])?;
        }
    }
    Ok(())
}

fn check_time(t: &[f64]) -> Result<(), Error> {
    match t.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(at) => Err(Error::TimeOrder { row: at + 1, before: t[at], after: t[at + 1] }),
        None => Ok(()),
    }
}

fn split(t: &[f64], steps: [f64; 5]) -> Vec<Segment> {
    let sample_period = median_step(t);
    without_gaps(t).into_iter().map(|rows| Segment { rows, log: 0, sample_period, steps }).collect()
}

/// Rows of these times, s, parted where a step is a gap: more than 2.5 median ones.
pub fn without_gaps(t: &[f64]) -> Vec<Range<usize>> {
    let sample_period = median_step(t);
    let mut stretches = Vec::new();
    let mut start = 0;
    for end in 1..=t.len() {
        if end == t.len() || t[end] - t[end - 1] > GAP_FACTOR * sample_period {
            stretches.push(start..end);
            start = end;
        }
    }
    stretches
}

/// 0 of less than two times.
fn median_step(t: &[f64]) -> f64 {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
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

    #[test]
    fn a_jump_in_time_ends_a_segment_and_one_lost_row_does_not() {
        let log = Log::new(columns(&[0.0, 0.1, 0.3, 0.4, 1.0, 1.1])).unwrap();
        let rows: Vec<_> = log.segments().iter().map(|segment| segment.rows.clone()).collect();
        assert_eq!(rows, [0..4, 4..6]);
        assert!((log.duration() - (0.5 + 0.2)).abs() < 1e-12);
    }

    #[test]
    fn joined_logs_keep_their_segments() {
        let log = Log::join([columns(&[0.0, 0.1, 0.2]), columns(&[0.1, 0.2])].map(|c| Log::new(c).unwrap())).unwrap();
        let rows: Vec<_> = log.segments().iter().map(|segment| segment.rows.clone()).collect();
        assert_eq!(rows, [0..3, 3..5]);
        assert_eq!(log.rows(), 5);
        assert!(Log::join([]).is_err());
    }

    #[test]
    fn the_last_log_or_segment_is_parted_from_the_rest() {
        let gap = || Log::new(columns(&[0.0, 0.1, 0.2, 1.0, 1.1])).unwrap();
        let ends = |log: &Log| log.segments().iter().map(|segment| (segment.rows.start, segment.rows.end)).collect::<Vec<_>>();
        let (first, last) = gap().part_last().unwrap();
        assert_eq!((&first.columns().t[..], &last.columns().t[..]), (&[0.0, 0.1, 0.2][..], &[1.0, 1.1][..]));
        assert_eq!((ends(&first), ends(&last)), (vec![(0, 3)], vec![(0, 2)]));
        let (first, last) = Log::join([Log::new(columns(&[5.0, 5.1])).unwrap(), gap()]).unwrap().part_last().unwrap();
        assert_eq!((&first.columns().t[..], &last.columns().t[..]), (&[5.0, 5.1][..], &[0.0, 0.1, 0.2, 1.0, 1.1][..]));
        assert_eq!((ends(&first), ends(&last)), (vec![(0, 2)], vec![(0, 3), (3, 5)]));
        assert!(Log::new(columns(&[0.0, 0.1])).unwrap().part_last().is_none());
    }

    #[test]
    fn an_optional_column_stays_if_every_log_has_it() {
        let with = |theta_e| Log::new(Columns { theta_e, ..columns(&[0.0, 0.1]) }).unwrap();
        let angle = Some(vec![1.0, 2.0]);
        assert_eq!(Log::join([with(angle.clone()), with(angle.clone())]).unwrap().columns().theta_e, Some(vec![1.0, 2.0, 1.0, 2.0]));
        assert_eq!(Log::join([with(angle), with(None)]).unwrap().columns().theta_e, None);
        assert!(matches!(
            Log::new(Columns { u_dc: Some(vec![1.0]), ..columns(&[0.0, 0.1]) }),
            Err(Error::ColumnLength { column: "u_dc", .. })
        ));
    }

    #[test]
    fn what_no_drive_records_is_refused_by_name_and_row() {
        let broken = |change: fn(&mut Columns)| {
            let mut columns = columns(&[0.0, 0.1, 0.2]);
            change(&mut columns);
            Log::new(columns).unwrap_err()
        };
        assert_eq!(broken(|c| c.uq[1] = f64::INFINITY), Error::NotFinite { column: "uq", row: 1, value: f64::INFINITY });
        assert_eq!(broken(|c| c.id[2] = -1e300), Error::Implausible { column: "id", row: 2, value: -1e300, limit: MAX_MAGNITUDE });
        assert_eq!(broken(|c| c.t[2] = 0.1), Error::TimeOrder { row: 2, before: 0.1, after: 0.1 });
        assert_eq!(broken(|c| c.iq.truncate(2)), Error::ColumnLength { column: "iq", rows: 2, expected: 3 });
        assert!(matches!(broken(|c| (c.id.fill(0.0), c.iq.fill(0.0)).1), Error::AllZero { .. }));
        assert!(matches!(Log::new(columns(&[0.0])), Err(Error::TooShort { rows: 1, .. })));
    }
}

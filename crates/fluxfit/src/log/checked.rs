//! A checked log: its columns, its segments, and where it comes from.

use super::{
    columns::{Columns, MIN_ROWS},
    segment::{CONTROL_RATE, Segment},
    short_circuit,
    spikes::Spikes,
};
use crate::{
    error::{Error, ErrorKind},
    frames::Dq,
};
use std::{f64::consts::FRAC_PI_3, ops::Range, sync::Arc};

/// A checked log: [`Log::new`] makes one of [`Columns`], [`LogBuilder`](super::LogBuilder) of rows as they arrive, and [`Log::join`] of
/// several logs of one motor.
///
/// Two logs are equal if their rows and segments are, wherever they come from.
#[derive(Debug, Clone)]
pub struct Log {
    /// Shared by the log's copies: an answer has one, and a long log's rows are most of the memory.
    columns: Arc<Columns>,
    segments: Vec<Segment>,
    interpolated: bool,
    spikes: Spikes,
    source: Source,
}

/// Where a log comes from, in words: for the reader of an answer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Source {
    /// What was read as what, a line for each log: `t = 'time_s' (s), ud = ..`.
    pub columns: Vec<String>,
    /// What reading inferred or repaired.
    pub notes: Vec<String>,
}

impl PartialEq for Log {
    fn eq(&self, other: &Self) -> bool {
        self.columns == other.columns && self.segments == other.segments && self.interpolated == other.interpolated
    }
}

impl Log {
    /// A log of columns that were checked.
    pub(super) fn checked(columns: Columns, segments: Vec<Segment>, spikes: Spikes) -> Self {
        Self { columns: Arc::new(columns), segments, interpolated: false, spikes, source: Source::default() }
    }

    /// Several logs of one motor as one; no segment reaches from one into the next. Their sources are joined too.
    ///
    /// # Errors
    /// If there is no log.
    pub fn join(logs: impl IntoIterator<Item = Self>) -> Result<Self, Error> {
        let mut logs = logs.into_iter();
        let mut joined = logs.next().ok_or(ErrorKind::TooShort { rows: 0, least: MIN_ROWS })?;
        for (number, log) in (1..).zip(logs) {
            let offset = joined.rows();
            joined.segments.extend(log.segments.into_iter().map(|segment| Segment {
                rows: segment.rows.start + offset..segment.rows.end + offset,
                log: number,
                ..segment
            }));
            joined.interpolated |= log.interpolated;
            joined.spikes.append(log.spikes, number);
            joined.source.columns.extend(log.source.columns);
            joined.source.notes.extend(log.source.notes);
            Arc::make_mut(&mut joined.columns).append(Arc::unwrap_or_clone(log.columns));
        }
        Ok(joined)
    }

    /// Splits off the last of several logs, or of one log the last segment: the rest, and what was split off. None of a log with one
    /// segment.
    pub fn part_last(&self) -> Option<(Self, Self)> {
        let last = self.segments.last()?;
        let several = self.segments.iter().any(|segment| segment.log != last.log);
        let belongs = |segment: &Segment| if several { segment.log == last.log } else { segment.rows == last.rows };
        let at = self.segments.iter().position(belongs).filter(|at| *at > 0)?;
        let row = self.segments[at].rows.start;
        let (first, rest) = self.segments.split_at(at);
        let rest = rest.iter().map(|segment| Segment { rows: segment.rows.start - row..segment.rows.end - row, log: 0, ..segment.clone() });
        let of = |columns: Columns, segments: Vec<Segment>| Self { columns: Arc::new(columns), segments, ..self.without_rows() };
        Some((of(self.columns.of_rows(0..row), first.to_vec()), of(self.columns.of_rows(row..self.rows()), rest.collect())))
    }

    /// Marks a log whose channels were sampled at different instants and interpolated onto common ones: no row is one instant of the
    /// drive, so only its steady stretches can be used.
    pub fn of_different_instants(self) -> Self {
        Self { interpolated: true, ..self }
    }

    /// Whether the channels were interpolated onto common instants.
    pub fn is_interpolated(&self) -> bool {
        self.interpolated
    }

    /// The same log, with a statement of where it comes from.
    #[must_use]
    pub fn with_source(self, source: Source) -> Self {
        Self { source, ..self }
    }

    /// Where it comes from; empty unless its reader stated it.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The same log with another speed, electrical rad/s.
    pub(crate) fn with_speed(&self, omega_e: Vec<f64>) -> Self {
        Self { columns: Arc::new(Columns { omega_e, ..Columns::clone(&self.columns) }), ..self.clone() }
    }

    /// The same log, whose angle was read too large by an angle, rad, in the frame behind it by that.
    #[must_use]
    pub fn in_frame_behind(&self, angle: f64) -> Self {
        let mut columns = Columns::clone(&self.columns);
        let Columns { ud, uq, id, iq, theta_e, .. } = &mut columns;
        for (of_d, of_q) in [(ud, uq), (id, iq)] {
            for (d, q) in of_d.iter_mut().zip(of_q) {
                let turned = Dq { d: *d, q: *q }.turned(angle);
                (*d, *q) = (turned.d, turned.q);
            }
        }
        theta_e.iter_mut().flatten().for_each(|theta| *theta -= angle);
        Self { columns: Arc::new(columns), ..self.clone() }
    }

    /// The same log without its rows.
    fn without_rows(&self) -> Self {
        Self {
            columns: Arc::default(),
            segments: Vec::new(),
            interpolated: self.interpolated,
            spikes: self.spikes.clone(),
            source: self.source.clone(),
        }
    }

    /// The rows that were left out because no drive had their values. Of a [part](Self::part_last) of a log, those of the whole.
    pub fn spikes(&self) -> &Spikes {
        &self.spikes
    }

    /// Whether the voltages are zero throughout: the motor turned with shorted terminals.
    pub(crate) fn is_short_circuit(&self) -> bool {
        short_circuit::voltages_are_zero(&self.columns)
    }

    /// Whether the speed is zero throughout.
    pub(crate) fn has_no_speed(&self) -> bool {
        self.columns.omega_e.iter().all(|speed| *speed == 0.0)
    }

    /// Whether the rotor stands throughout, so that nothing tells the magnets' flux: the speed is none, or noise to either side of zero
    /// that turns it less than a sixth of a turn.
    pub(crate) fn is_at_rest(&self) -> bool {
        let Columns { t, omega_e, .. } = &*self.columns;
        let swings = || omega_e.iter().any(|speed| *speed > 0.0) && omega_e.iter().any(|speed| *speed < 0.0);
        let turned = |rows: &Range<usize>| {
            let steps = rows.clone().skip(1).map(|row| omega_e[row] * (t[row] - t[row - 1]));
            let (_, least, most) = steps.fold((0.0_f64, 0.0_f64, 0.0_f64), |(angle, least, most), step| {
                let angle = angle + step;
                (angle, least.min(angle), most.max(angle))
            });
            most - least
        };
        self.has_no_speed() || swings() && self.segments.iter().all(|segment| turned(&segment.rows) < FRAC_PI_3)
    }

    /// Refuses a log that the output error cannot tell more of than the steady model: it would look at length for a minimum that every
    /// motor with the same ratios of parameters shares.
    ///
    /// # Errors
    /// If the log is one of a short circuit.
    pub(crate) fn refuse_short_circuit(&self) -> Result<(), Error> {
        if self.is_short_circuit() { Err(ErrorKind::ShortCircuit.into()) } else { Ok(()) }
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

    /// Whether the rows come as fast as most drives control.
    pub(crate) fn is_control_rate(&self) -> bool {
        let slowest = self.slowest_period();
        slowest > 0.0 && slowest * CONTROL_RATE <= 1.0
    }

    /// The longest sample period, s.
    pub(crate) fn slowest_period(&self) -> f64 {
        self.segments().iter().map(|segment| segment.sample_period).fold(0.0, f64::max)
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
    }

    #[test]
    fn a_log_carries_its_source_and_joined_logs_all_of_them() {
        let source = |name: &str| Source { columns: vec![format!("t = '{name}' (s)")], notes: vec![format!("{name} was read")] };
        let of = |name: &str| Log::new(columns(&[0.0, 0.1])).unwrap().with_source(source(name));
        let joined = Log::join([of("a"), of("b")]).unwrap();
        assert_eq!(joined.source().notes, ["a was read", "b was read"]);
        assert_eq!(joined.source().columns, ["t = 'a' (s)", "t = 'b' (s)"]);
        assert_eq!(joined.part_last().unwrap().0.source(), joined.source());
        // The source does not make logs different.
        assert_eq!(of("a"), of("b"));
    }
}

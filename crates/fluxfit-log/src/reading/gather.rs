//! Reads the chosen columns of a table, in SI units, each row with its time.

use super::{
    align,
    channels::Channels,
    chosen::{ChosenColumn, left_out},
    clock::Clock,
    layout::Layout,
    lines::Lines,
    options::ResolvedOptions,
    own_times::OwnTimes,
    scaling::Scaling,
    selection::{Features, Selected, Selection, mean_and_deviation},
    table::Table,
};
use crate::{
    block::{Block, ColumnHead, WantedColumn},
    channel::Channel,
    note::Note,
    problem::Problem,
};
use Channel::{IA, IB, Id, Iq, OmegaE, Run, T, ThetaE};
use fluxfit::frames::Abc;
use fluxfit_files::{FileError, csv::header::UNNAMED};
use fluxfit_units::{Unit, wording::shorten};
use std::f64::consts::{PI, TAU};

/// Periods between two runs of a log without times: more than the threshold of a gap.
const BETWEEN_RUNS: f64 = 10.0;

/// The channels that were read.
pub(super) struct Gathered {
    pub(super) channels: Channels,
    pub(super) lines: Lines,
    /// Some channel was interpolated to the instants of the currents.
    pub(super) is_interpolated: bool,
    /// The rows before which others were dropped, of a log with too many.
    pub(super) dropped_before: Vec<usize>,
}

/// Reads the columns. Columns of several groups, each with its own times, are interpolated to the instants of the currents.
pub(super) fn gather(
    table: &mut Table,
    chosen: &[ChosenColumn],
    layout: Option<&'static Layout>,
    options: &ResolvedOptions,
    notes: &mut Vec<Note>,
) -> Result<Gathered, FileError> {
    let heads = table.heads().to_vec();
    let group = |column: &ChosenColumn| heads[column.index].group;
    let base_column = chosen.iter().find(|column| [Id, IA].contains(&column.channel));
    let base = base_column.or(chosen.first()).map_or(0, group);
    let mut groups: Vec<usize> = chosen.iter().filter(|column| column.channel != T).map(group).collect();
    groups.sort_by_key(|group| (*group != base, *group));
    groups.dedup();
    let period = options.sample_period.or(layout.and_then(|layout| layout.sample_period));
    let several = groups.len() > 1;
    let mut all: Option<Gathered> = None;
    for group_number in groups {
        let columns = of_group(chosen, &heads, group_number).ok_or_else(|| lengths(chosen, &heads))?;
        if period.is_none() && columns.iter().all(|column| column.channel != T) {
            return Err(lengths(chosen, &heads));
        }
        // Each group would select different rows.
        let most_rows = if several { usize::MAX } else { options.most_rows };
        let gathered = one_group(table, &columns, (period, most_rows, options), notes)?;
        all = Some(match all {
            None => gathered,
            Some(base) => join(base, gathered, notes)?,
        });
    }
    all.ok_or_else(|| Problem::NoRows.into())
}

/// The chosen columns of a group with its time; none if the group has no time.
fn of_group(chosen: &[ChosenColumn], heads: &[ColumnHead], group: usize) -> Option<Vec<ChosenColumn>> {
    let mut columns: Vec<ChosenColumn> = chosen.iter().filter(|column| heads[column.index].group == group).cloned().collect();
    let has_time = |columns: &[ChosenColumn]| columns.iter().any(|column| column.channel == T);
    if !has_time(&columns)
        && let Some(time) = chosen.iter().find(|column| column.channel == T)
    {
        let index = heads.iter().position(|head| head.group == group && head.is_time)?;
        let header = heads[index].name.clone();
        let instants = heads[index].instants.clone();
        let is_as_chosen =
            instants.is_none() && time.instants.is_none() && heads[time.index].is_time && heads[time.index].unit == heads[index].unit;
        let (unit, scale) = if is_as_chosen { (time.unit, time.scale) } else { (Unit::Second, 1.0) };
        let (is_unit_stated, is_optional) = (true, false);
        columns.push(ChosenColumn {
            channel: T,
            index,
            header,
            unit,
            pole_pairs: 1,
            scale,
            is_optional,
            is_unit_stated,
            is_unit_written: false,
            is_share: false,
            is_alias: false,
            instants,
        });
    }
    Some(columns)
}

fn lengths(chosen: &[ChosenColumn], heads: &[ColumnHead]) -> FileError {
    let length = |column: &ChosenColumn| format!("'{}' has {} rows", shorten(&column.header), heads[column.index].rows);
    Problem::Lengths { lengths: chosen.iter().map(length).collect() }.into()
}

fn one_group(
    table: &mut Table,
    columns: &[ChosenColumn],
    (period, most_rows, options): (Option<f64>, usize, &ResolvedOptions),
    notes: &mut Vec<Note>,
) -> Result<Gathered, FileError> {
    let place = |channel: Channel| columns.iter().position(|column| column.channel == channel);
    let mut own_times = OwnTimes::of(table.heads(), columns);
    let mut scaling = Scaling::of(table.heads(), columns, options);
    let of_phases = scaling.iter().flat_map(Scaling::wanted);
    let wanted: Vec<WantedColumn> = columns.iter().map(ChosenColumn::wanted).chain(own_times.wanted(columns)).chain(of_phases).collect();
    let times = columns.len() + own_times.len();
    let mut counted = period.filter(|_| place(T).is_none()).map(|period| Counted { period, t: -period, run: None });
    let mut selection = Selection::new(columns.len() + usize::from(counted.is_some()), features(&place), most_rows);
    let is_unit_stated = place(T).is_some_and(|t| columns[t].is_unit_stated);
    // Times of a group are those of a format that has them in s.
    let is_unit_written = place(T).is_some_and(|t| columns[t].is_unit_written || table.heads()[columns[t].index].is_time);
    let is_alias = place(T).is_some_and(|t| columns[t].is_alias);
    let may_count = place(T).is_some_and(|t| columns[t].header == UNNAMED);
    let mut clock = Clock::of(is_unit_stated, is_unit_written, is_alias, may_count);
    let mut refused: Vec<Option<FileError>> = vec![None; columns.len()];
    notes.extend(
        table
            .read(&wanted, &mut |block: &mut Block| {
                for (first, later) in refused.iter_mut().zip(&mut block.refused) {
                    if first.is_none() {
                        *first = later.take();
                    }
                }
                let mut phases = block.values.split_off(times);
                let others = block.values.split_off(columns.len());
                if !others.is_empty()
                    && let Some(t) = place(T)
                {
                    own_times.compare(&block.values[t], &others);
                }
                for (column, values) in columns.iter().zip(&mut block.values) {
                    column.to_si(values);
                }
                if let Some(scaling) = &mut scaling {
                    scaling.compare(&block.values, &mut phases);
                }
                if let Some(t) = place(T) {
                    clock.settle(&mut block.values[t]);
                }
                if let Some(counted) = &mut counted {
                    let t = counted.next(block.lines.len(), place(Run).map(|run| block.values[run].as_slice()));
                    block.values.push(t);
                }
                selection.push(block);
                Ok(())
            })?
            .into_iter()
            .map(Note::from),
    );
    if let Some(t) = place(T) {
        own_times.refuse(&columns[t].header)?;
    }
    scaling.as_ref().map_or(Ok(()), Scaling::refuse)?;
    notes.extend(clock.notes().into_iter().map(Note::from));
    if let Some(step) = clock.unstated_step() {
        return Err(Problem::TimeUnit { step }.into());
    }
    let Selected { values, lines, dropped_before, note } = selection.finish();
    notes.extend(note.map(Note::from));
    let lines = lines.of_container(table.line().is_none());
    let mut channels = Channels::default();
    let names = columns.iter().map(|column| column.channel).chain(counted.is_some().then_some(T));
    channels.columns = names.zip(values).filter(|(channel, _)| *channel != Run).collect();
    channels.headers = columns.iter().map(|column| (column.channel, column.header.clone())).collect();
    if let Some(counted) = counted {
        notes.push(format!("t counts the rows: one every {} s", counted.period).into());
    }
    hold_slow(&mut channels);
    drop_unreadable(&mut channels, columns, refused, &lines, notes);
    Ok(Gathered { channels, lines, is_interpolated: false, dropped_before })
}

/// The features of a stretch: means and standard deviations of the dq currents and of the speed; of phase quantities, those of the dq
/// currents and of the turns from row to row.
fn features(place: &impl Fn(Channel) -> Option<usize>) -> Features {
    let dq: Vec<usize> = [Id, Iq, OmegaE].into_iter().filter_map(place).collect();
    let (Some(a), Some(b), Some(theta)) = (place(IA), place(IB), place(ThetaE)) else {
        return Box::new(move |values| dq.iter().flat_map(|place| mean_and_deviation(&values[*place])).collect());
    };
    Box::new(move |values| {
        let current = |row: usize| {
            let (a, b) = (values[a][row], values[b][row]);
            Abc { a, b, c: -a - b }.to_alpha_beta().to_dq(values[theta][row])
        };
        let (d, q): (Vec<f64>, Vec<f64>) = (0..values[theta].len()).map(current).map(|current| (current.d, current.q)).unzip();
        let turns: Vec<f64> = values[theta].windows(2).map(|pair| (pair[1] - pair[0] + PI).rem_euclid(TAU) - PI).collect();
        [d, q, turns].iter().flat_map(|values| mean_and_deviation(values)).collect()
    })
}

/// Times of rows without a time column.
struct Counted {
    period: f64,
    t: f64,
    run: Option<f64>,
}

impl Counted {
    fn next(&mut self, rows: usize, runs: Option<&[f64]>) -> Vec<f64> {
        let time = |row: usize| {
            let run = runs.map(|runs| runs[row]);
            self.t += if self.run != run && self.run.is_some() { BETWEEN_RUNS * self.period } else { self.period };
            self.run = run;
            self.t
        };
        (0..rows).map(time).collect()
    }
}

/// Fills the missing values of channels that change slowly: a logger writes a temperature now and then.
fn hold_slow(channels: &mut Channels) {
    let Some(t) = channels.get(T).map(<[f64]>::to_vec) else { return };
    let slow: Vec<Channel> = channels.iter().map(|(channel, _)| channel).filter(|channel| channel.is_slow()).collect();
    for channel in slow {
        let values = channels.get(channel).unwrap_or_default();
        let (at, present): (Vec<f64>, Vec<f64>) = align::present(&t, values).unzip();
        if !present.is_empty() && present.len() < values.len() {
            let filled = align::held(&at, &present, &t);
            channels.set(channel, filled);
        }
    }
}

/// Leaves out optional columns that cannot be read, or that lack values where the others have them.
fn drop_unreadable(
    channels: &mut Channels,
    columns: &[ChosenColumn],
    refused: Vec<Option<FileError>>,
    lines: &Lines,
    notes: &mut Vec<Note>,
) {
    let is_optional = |channel: Channel| columns.iter().any(|column| column.channel == channel && column.is_optional);
    let has_missing = channels.iter().any(|(channel, values)| !is_optional(channel) && values.iter().any(|value| value.is_nan()));
    for (column, refused) in columns.iter().zip(refused).filter(|(column, _)| column.is_optional) {
        let Some(values) = channels.get(column.channel) else { continue };
        let missing = values.iter().position(|value| value.is_nan());
        let is_empty = values.iter().all(|value| value.is_nan());
        let missing = missing.filter(|_| !has_missing || is_empty);
        if let Some(error) = refused.or_else(|| missing.map(|row| channels.refuse_missing(column.channel, lines, row))) {
            notes.push(left_out(column.channel, &error.in_column(&column.header)).into());
            channels.take(column.channel);
        }
    }
}

/// Adds the channels of another group, at the instants of the first.
fn join(mut base: Gathered, other: Gathered, notes: &mut Vec<Note>) -> Result<Gathered, FileError> {
    let (Some(instants), Some(at)) = (base.channels.get(T).map(<[f64]>::to_vec), other.channels.get(T)) else { return Ok(base) };
    let is_same = at == instants;
    let is_moved = |channel: &Channel| *channel != T && !channel.is_slow();
    let moved: Vec<Channel> = other.channels.iter().map(|(channel, _)| channel).filter(is_moved).collect();
    for (channel, values) in other.channels.iter().filter(|(channel, _)| *channel != T) {
        let on_common = match (is_same, channel.is_slow()) {
            (true, _) => values.to_vec(),
            (false, true) => align::held(at, values, &instants),
            (false, false) => align::interpolated(at, values, &instants),
        };
        base.channels.set(channel, on_common);
    }
    base.channels.headers.extend(other.channels.headers.iter().filter(|(channel, _)| *channel != T).cloned());
    if !is_same && !moved.is_empty() {
        let kept: Vec<bool> = (0..instants.len()).map(|row| base.channels.iter().all(|(_, values)| !values[row].is_nan())).collect();
        align::refuse_turning(&mut base.channels, &moved)?;
        let currents = if base.channels.get(Iq).is_some() { Id } else { IA };
        if !kept.contains(&true) {
            return Err(Problem::NoCommonInstants { base: currents.name() }.into());
        }
        base.channels.retain(&kept);
        notes.push(align::note(&moved, currents).into());
        base.is_interpolated = true;
    }
    Ok(base)
}

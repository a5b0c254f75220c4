//! The chosen columns of a table, in SI, each row with its time.

use super::{
    Channels, Told, align,
    clock::Clock,
    columns::{Chosen, left_out},
    kept::{Features, Kept, Lines, mean_and_deviation},
    layout::Layout,
    table::Table,
};
use crate::block::{Block, Head, Wanted};
use crate::{channel::Channel, problem::Problem};
use Channel::{IA, IB, Id, Iq, OmegaE, Run, T, ThetaE};
use fluxfit::frames::Abc;
use fluxfit_files::FileError;
use fluxfit_units::unit::Unit;
use std::f64::consts::{PI, TAU};

/// Where a run of rows ends and nobody logged the time, it goes on this many periods later: more than a gap.
const BETWEEN_RUNS: f64 = 10.0;

/// What was gathered.
pub(super) struct Gathered {
    pub(super) channels: Channels,
    pub(super) lines: Lines,
    /// Some channel was interpolated onto the instants of the currents.
    pub(super) is_moved: bool,
}

/// Reads the columns. Those of several groups, each with its own times, come onto the instants of the currents.
pub(super) fn gather(
    table: &mut Table,
    chosen: &[Chosen],
    layout: Option<&'static Layout>,
    told: &Told,
    notes: &mut Vec<String>,
) -> Result<Gathered, FileError> {
    let heads = table.heads().to_vec();
    let group = |column: &Chosen| heads[column.index].group;
    let base_column = chosen.iter().find(|column| [Id, IA].contains(&column.channel));
    let base = base_column.or(chosen.first()).map_or(0, group);
    let mut groups: Vec<usize> = chosen.iter().filter(|column| column.channel != T).map(group).collect();
    groups.sort_by_key(|group| (*group != base, *group));
    groups.dedup();
    let period = told.sample_period.or(layout.and_then(|layout| layout.sample_period));
    let several = groups.len() > 1;
    let mut all: Option<Gathered> = None;
    for group_number in groups {
        let columns = of_group(chosen, &heads, group_number).ok_or_else(|| lengths(chosen, &heads))?;
        if period.is_none() && columns.iter().all(|column| column.channel != T) {
            return Err(lengths(chosen, &heads));
        }
        // Each group would keep rows of its own.
        let most_rows = if several { usize::MAX } else { told.most_rows };
        let gathered = one_group(table, &columns, period, most_rows, notes)?;
        all = Some(match all {
            None => gathered,
            Some(base) => joined(base, gathered, notes)?,
        });
    }
    all.ok_or_else(|| Problem::NoRows.into())
}

/// The chosen columns of a group with its time; none where the group has no time.
fn of_group(chosen: &[Chosen], heads: &[Head], group: usize) -> Option<Vec<Chosen>> {
    let mut columns: Vec<Chosen> = chosen.iter().filter(|column| heads[column.index].group == group).cloned().collect();
    let has_time = |columns: &[Chosen]| columns.iter().any(|column| column.channel == T);
    if !has_time(&columns) && chosen.iter().any(|column| column.channel == T) {
        let index = heads.iter().position(|head| head.group == group && head.is_time)?;
        let header = heads[index].name.clone();
        columns.push(Chosen { channel: T, index, header, unit: Unit::Second, pole_pairs: 1, scale: 1.0, dispensable: false });
    }
    Some(columns)
}

fn lengths(chosen: &[Chosen], heads: &[Head]) -> FileError {
    let length = |column: &Chosen| format!("'{}' has {} rows", fluxfit_units::wording::shorten(&column.header), heads[column.index].rows);
    Problem::Lengths { lengths: chosen.iter().map(length).collect() }.into()
}

fn one_group(
    table: &mut Table,
    columns: &[Chosen],
    period: Option<f64>,
    most_rows: usize,
    notes: &mut Vec<String>,
) -> Result<Gathered, FileError> {
    let place = |channel: Channel| columns.iter().position(|column| column.channel == channel);
    let wanted: Vec<Wanted> = columns.iter().map(Chosen::wanted).collect();
    let mut counted = period.filter(|_| place(T).is_none()).map(|period| Counted { period, t: -period, run: None });
    let mut kept = Kept::new(columns.len() + usize::from(counted.is_some()), telling(&place), most_rows);
    let mut clock = Clock::default();
    let mut refused: Vec<Option<FileError>> = vec![None; columns.len()];
    notes.extend(table.read(&wanted, &mut |mut block: Block| {
        for (first, later) in refused.iter_mut().zip(&mut block.refused) {
            if first.is_none() {
                *first = later.take();
            }
        }
        for (column, values) in columns.iter().zip(&mut block.values) {
            column.to_si(values);
        }
        if let Some(t) = place(T) {
            clock.unwrap(&mut block.values[t]);
        }
        if let Some(counted) = &mut counted {
            let t = counted.next(block.lines.len(), place(Run).map(|run| block.values[run].as_slice()));
            block.values.push(t);
        }
        kept.push(&block);
        Ok(())
    })?);
    notes.extend(clock.note());
    let (values, lines, note) = kept.finish();
    notes.extend(note);
    let lines = lines.counting_rows(table.line().is_none());
    let mut channels = Channels::default();
    let names = columns.iter().map(|column| column.channel).chain(counted.is_some().then_some(T));
    channels.columns = names.zip(values).filter(|(channel, _)| *channel != Run).collect();
    channels.headers = columns.iter().map(|column| (column.channel, column.header.clone())).collect();
    if let Some(counted) = counted {
        notes.push(format!("the rows have no time: one every {} s is taken", counted.period));
    }
    drop_unreadable(&mut channels, columns, refused, &lines, notes);
    Ok(Gathered { channels, lines, is_moved: false })
}

/// Means and spreads of the currents in dq and of the speed; of a log of phases, of what these would be.
fn telling(place: &impl Fn(Channel) -> Option<usize>) -> Features {
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

/// Times of rows that have none.
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

/// Leaves out the columns that nobody asked for and that cannot be read, or have holes where the others have none.
fn drop_unreadable(channels: &mut Channels, columns: &[Chosen], refused: Vec<Option<FileError>>, lines: &Lines, notes: &mut Vec<String>) {
    let dispensable = |channel: Channel| columns.iter().any(|column| column.channel == channel && column.dispensable);
    let has_holes = channels.iter().any(|(channel, values)| !dispensable(channel) && values.iter().any(|value| value.is_nan()));
    for (column, refused) in columns.iter().zip(refused).filter(|(column, _)| column.dispensable) {
        let Some(values) = channels.get(column.channel) else { continue };
        let hole = values.iter().position(|value| value.is_nan());
        let is_empty = values.iter().all(|value| value.is_nan());
        let hole = hole.filter(|_| !has_holes || is_empty);
        if let Some(error) = refused.or_else(|| hole.map(|row| channels.refuse(Problem::EmptyCell, column.channel, lines, row))) {
            notes.push(left_out(column.channel, &error.in_column(&column.header)));
            channels.take(column.channel);
        }
    }
}

/// Channels of another group on the instants of the first.
fn joined(mut base: Gathered, other: Gathered, notes: &mut Vec<String>) -> Result<Gathered, FileError> {
    let (Some(instants), Some(at)) = (base.channels.get(T).map(<[f64]>::to_vec), other.channels.get(T)) else { return Ok(base) };
    let is_same = at == instants;
    let moved: Vec<Channel> = other.channels.iter().map(|(channel, _)| channel).filter(|channel| *channel != T).collect();
    for (channel, values) in other.channels.iter().filter(|(channel, _)| *channel != T) {
        let on_common = if is_same { values.to_vec() } else { align::interpolated(at, values, &instants) };
        base.channels.set(channel, on_common);
    }
    base.channels.headers.extend(other.channels.headers.iter().filter(|(channel, _)| *channel != T).cloned());
    if !is_same {
        let kept: Vec<bool> = (0..instants.len()).map(|row| base.channels.iter().all(|(_, values)| !values[row].is_nan())).collect();
        align::refuse_turning(&mut base.channels, &moved)?;
        let currents = if base.channels.get(Iq).is_some() { Id } else { IA };
        if !kept.contains(&true) {
            return Err(Problem::Apart { base: currents.name() }.into());
        }
        base.channels.retain(&kept);
        notes.push(align::note(&moved, currents));
        base.is_moved = true;
    }
    Ok(base)
}

//! The currents of the rotor's frame in a table of a test bench, by the names of its columns.

use super::{
    alias,
    bench_columns::Found,
    bench_units::{StatedUnit, stated_unit},
    resemblance::{fit, has_other_unit, is_reference, words},
    rms,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    note::Note,
    quantity::{Quantity, TableColumn},
    unclear_table::AxisCurrents,
};
use fluxfit_units::{Dimension, wording};

/// Words beside a current of a table: its rows are steady, its values means or amplitudes.
const STEADY: [&str; 9] = ["ss", "steady", "mean", "avg", "average", "peak", "pk", "amplitude", "ampl"];

/// Whether a column may be a channel, also as a root mean square.
pub(super) fn is(channel: Channel, head: &ColumnHead) -> bool {
    let is_named =
        |head: &ColumnHead| alias::is_alias(channel, head) || Channel::from_name(head.name.trim()).is_ok_and(|own| own == channel);
    is_named(head) || rms::without(head).is_some_and(|head| is_named(&head))
}

/// Whether a column is a current of the rotor's frame, also as a table has it: `iq_ss`, `iq_peak_a`.
pub(super) fn is_axis(channel: Channel, head: &ColumnHead) -> bool {
    let of_current = || matches!(stated_unit(head), StatedUnit::None | StatedUnit::Of(Quantity::Current, ..));
    is(channel, head) || !is_reference(&head.name) && of_current() && is(channel, &without_steady(head))
}

/// A column, named without such words and without its unit.
fn without_steady(head: &ColumnHead) -> ColumnHead {
    let name = head.name.split(['[', '(']).next().unwrap_or(&head.name);
    let others: Vec<String> = words(name).into_iter().filter(|word| !STEADY.contains(&word.as_str())).collect();
    ColumnHead { name: others.join("_"), unit: None, ..head.clone() }
}

/// The column of i_q.
#[derive(PartialEq)]
pub(super) enum OfQ {
    Is(usize),
    /// Columns that only resemble it.
    MayBe(Vec<usize>),
    Absent,
}

/// The column of i_d.
pub(super) enum OfD {
    Is(usize),
    /// The one that is named as the mapped i_q is, but for the axis.
    NamedAlike(usize),
    /// Columns that only resemble it, by their names.
    MayBe(Vec<String>),
    Absent,
}

/// Beside columns that resemble voltages of the frame only what is surely i_q: the others may make a log, or operating points.
pub(super) fn of_q(heads: &[ColumnHead], columns: &[Found]) -> OfQ {
    let all = |is: &dyn Fn(&ColumnHead) -> bool| (0..heads.len()).filter(|index| is(&heads[*index])).collect::<Vec<_>>();
    let own = mapped(columns, TableColumn::AxisQ).or_else(|| heads.iter().position(|head| is(Channel::Iq, head)));
    let has_voltages = || heads.iter().any(|head| [Channel::Ud, Channel::Uq].into_iter().any(|channel| resembles(channel, head)));
    if own.is_some() || has_voltages() {
        return own.map_or(OfQ::Absent, OfQ::Is);
    }
    let steady = all(&|head| is_axis(Channel::Iq, head));
    let resembling = all(&|head| resembles(Channel::Iq, head) && !is_reference(&head.name));
    match (steady.as_slice(), resembling.is_empty()) {
        ([one], _) => OfQ::Is(*one),
        ([], true) => OfQ::Absent,
        ([], false) => OfQ::MayBe(resembling),
        _ => OfQ::MayBe(steady),
    }
}

/// The column of i_d beside one of i_q, if there is one.
pub(super) fn of_d(heads: &[ColumnHead], columns: &[Found], q: Option<usize>) -> OfD {
    let is_q_mapped = q.is_some() && mapped(columns, TableColumn::AxisQ) == q;
    let alike = q.and_then(|q| named_alike(heads, q));
    let named = |is: fn(Channel, &ColumnHead) -> bool| (0..heads.len()).find(|d| Some(*d) != q && is(Channel::Id, &heads[*d]));
    let resembling =
        || heads.iter().filter(|head| resembles(Channel::Id, head)).map(|head| head.name.trim().to_owned()).collect::<Vec<_>>();
    match (mapped(columns, TableColumn::AxisD).filter(|d| Some(*d) != q), alike, named(is).or_else(|| named(is_axis))) {
        (Some(d), ..) => OfD::Is(d),
        (_, Some(d), _) if is_q_mapped => OfD::NamedAlike(d),
        (_, Some(d), _) | (.., Some(d)) if q.is_some() => OfD::Is(d),
        _ => Some(resembling()).filter(|some| !some.is_empty()).map_or(OfD::Absent, OfD::MayBe),
    }
}

impl OfD {
    pub(super) fn index(&self) -> Option<usize> {
        match self {
            Self::Is(index) | Self::NamedAlike(index) => Some(*index),
            Self::MayBe(_) | Self::Absent => None,
        }
    }

    /// What is inferred of i_d.
    pub(super) fn note(&self, heads: &[ColumnHead]) -> Option<Note> {
        match self {
            Self::Is(_) => None,
            Self::NamedAlike(index) => {
                let name = wording::quote(heads[*index].name.trim());
                Some(format!("{name} is read as i_d, because its name differs from that of i_q in the axis alone").into())
            }
            Self::MayBe(headers) => {
                let which = if headers.len() == 1 { "it as id if it is" } else { "the one that is as id" };
                Some(format!("i_d is taken as zero, but by name {} may be i_d; map {which}", wording::columns(headers)).into())
            }
            Self::Absent => Some("i_d is taken as zero: no column is named as it".to_owned().into()),
        }
    }
}

/// What has to be mapped where columns only resemble i_q.
pub(super) fn to_map(heads: &[ColumnHead], of_q: &[usize], torque: &Found) -> AxisCurrents {
    let name = |index: usize| heads[index].name.trim().to_owned();
    let d = of_q.first().and_then(|q| named_alike(heads, *q)).map(name);
    AxisCurrents { q: of_q.iter().map(|index| name(*index)).collect(), d, torque: torque.header.clone() }
}

fn mapped(columns: &[Found], column: TableColumn) -> Option<usize> {
    columns.iter().find(|found| found.mapped == Some(column)).map(|found| found.index)
}

/// The column whose name differs from that of i_q in nothing but the axis.
fn named_alike(heads: &[ColumnHead], q: usize) -> Option<usize> {
    let is_d = |head: &ColumnHead| {
        alias::differ_in_axis(Dimension::Current, [head.name.trim(), heads[q].name.trim()]) && !is_reference(&head.name)
    };
    heads.iter().position(is_d)
}

fn resembles(channel: Channel, head: &ColumnHead) -> bool {
    fit(channel, &head.name).is_some() && !has_other_unit(channel, head)
}

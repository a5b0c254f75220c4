//! The column of a channel, by the names in the header.

use super::{proposal::propose, resemblance::is_reference};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header},
    problem::Problem,
};
use fluxfit_files::FileError;
use fluxfit_units::{Dimension, wording::nearest};

/// Shortest header that is proposed for a misspelt one by its letters alone: of shorter ones that differ in one letter, one may be
/// the other's opposite.
const SHORTEST_MISSPELT: usize = 5;

/// The column with the header that the user gave.
///
/// # Errors
/// If the file has no such column, or several.
pub(super) fn mapped(channel: Channel, header: &str, heads: &[ColumnHead]) -> Result<usize, FileError> {
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let names = names.as_slice();
    // As a message has it, which cuts long names at the end, or in the middle.
    let is_cut = |name: &str| {
        let parts = header.split_once('…');
        parts.is_some_and(|(start, end)| !start.is_empty() && name.starts_with(start) && name.ends_with(end))
    };
    let tiers = [
        positions(names, |name| name == header),
        positions(names, |name| name.to_lowercase() == header.to_lowercase()),
        positions(names, is_cut),
    ];
    if let Some(index) = only(channel, names, tiers)? {
        return Ok(index);
    }
    let containing = names.iter().find(|name| name.to_lowercase().contains(&header.to_lowercase()));
    let proposed = || propose(&[channel], heads, |_, _| Some(0.0)).first().map(|proposal| &names[proposal.index]);
    let likely = containing.or_else(proposed).map(String::as_str);
    let nearest = likely.or_else(|| nearest(header, names.iter().map(String::as_str).filter(|name| name.len() >= SHORTEST_MISSPELT)));
    Err(Problem::MappedHeader {
        channel: channel.name(),
        header: header.to_owned(),
        present: names.to_vec(),
        nearest: nearest.map(str::to_owned),
    }
    .into())
}

/// The column with the canonical name; else with that name in other case; else with a unit after it; else the field of that name in
/// a structure, which is no reference of a current or a speed; else, for the time, a column called `time`.
///
/// # Errors
/// If several columns fit equally well.
pub(super) fn automatic(channel: Channel, heads: &[ColumnHead]) -> Result<Option<usize>, FileError> {
    let canonical = channel.name();
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let with_unit = |name: &str| {
        let (stem, unit) = split_header(name, channel.dimension());
        matches!(unit, HeaderUnit::Known(_)) && stem.eq_ignore_ascii_case(canonical)
    };
    let has_group_times = heads.iter().any(|head| head.is_time);
    let field = |name: &str| name.rsplit_once('.').is_some_and(|(_, field)| field.eq_ignore_ascii_case(canonical));
    // Where groups have times of their own, each group takes its own.
    let is_time =
        |name: &str| channel == Channel::T && !has_group_times && split_header(name, Dimension::Time).0.eq_ignore_ascii_case("time");
    let tiers = [
        positions(&names, |name| name == canonical),
        positions(&names, |name| name.eq_ignore_ascii_case(canonical)),
        positions(&names, with_unit),
        positions(&names, |name| field(name) && !is_reference(name)),
        // References of voltages are known well enough.
        positions(&names, |name| field(name) && channel.dimension() == Dimension::Voltage),
        positions(&names, is_time),
    ];
    only(channel, &names, tiers)
}

/// The indices of the names that fit.
pub(super) fn positions(names: &[String], fits: impl Fn(&str) -> bool) -> Vec<usize> {
    names.iter().enumerate().filter(|(_, name)| fits(name)).map(|(index, _)| index).collect()
}

/// The one column of the first tier that has any.
///
/// # Errors
/// If that tier has several.
pub(super) fn only<const N: usize>(channel: Channel, names: &[String], tiers: [Vec<usize>; N]) -> Result<Option<usize>, FileError> {
    let Some(tier) = tiers.into_iter().find(|tier| !tier.is_empty()) else { return Ok(None) };
    if let [index] = tier[..] {
        return Ok(Some(index));
    }
    let headers: Vec<String> = tier.iter().map(|index| names[*index].clone()).collect();
    if headers.iter().all(|header| *header == headers[0]) {
        return Err(FileError::from(Problem::Duplicate { count: headers.len() }).in_column(&headers[0]));
    }
    Err(Problem::Ambiguous { channel: channel.name(), headers }.into())
}

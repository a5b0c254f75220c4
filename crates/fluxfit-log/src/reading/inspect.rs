//! Inspection of a file: its columns, and how they are read, whether they make a log or not.

use super::{
    characteristic::{quantity, read_characteristic},
    layout::Layout,
    options::{LogOptions, ResolvedOptions},
    read::{ReadLog, read},
    steady_test::ReadCharacteristic,
    survey::{Surveyed, survey},
    table::Table,
};
use crate::{block::WantedColumn, channel::Channel, instant::Instants, problem::Problem};
use fluxfit::characteristics::check_characteristics;
use fluxfit_files::{
    FileError, FileErrorKind,
    input::{self, Bytes},
};
use fluxfit_units::{Dimension, Unit};
use std::path::Path;

/// How a file is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspection {
    /// Its format.
    pub kind: String,
    /// The recognized layout.
    pub layout: Option<&'static Layout>,
    /// Its columns, in order.
    pub columns: Vec<InspectedColumn>,
    /// The table of a test bench, if it is one in place of a log.
    pub table: Option<ReadCharacteristic>,
    /// It is a table of a test bench, also if it cannot be read as such yet: [`log`](Self::log) says why.
    pub is_table: bool,
    /// The log, or why there is none.
    pub log: Result<ReadLog, FileError>,
}

/// A column of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedColumn {
    /// Its name in the file.
    pub header: String,
    /// Its unit, as the file spells it.
    pub unit: Option<String>,
    /// The channel that it is read as.
    pub channel: Option<&'static str>,
    /// The channel that it may be by its name, if it is not read; of a table of a test bench the quantity.
    pub resembles: Option<&'static str>,
    /// The unit in which it is read, or would be if it is stated: its short name, and its name in a sentence.
    pub read_as: Option<(&'static str, &'static str)>,
    /// Whether the file, the layout, the user or its own name states its unit; otherwise SI is assumed of what is read.
    pub is_unit_stated: bool,
    /// Whether the file, the layout of a tool or the user states it, and not its own name alone.
    pub is_unit_written: bool,
    /// Whether one of them states that it is electrical or mechanical, if it is a speed or an angle.
    pub is_rotation_stated: bool,
    /// Its smallest and largest number, as the file has them; none if it has no numbers, or if the log came through a pipe.
    pub range: Option<[f64; 2]>,
    /// The smallest and largest number of each of some hundred equal stretches of rows, in order, as the file has them; empty if it has no
    /// numbers, or if the log came through a pipe.
    pub course: Vec<[f64; 2]>,
    /// The file states that it is the time of the columns of its group.
    pub is_time: bool,
    /// Its cells are dates and times, or count from 1970.
    pub is_instant: bool,
    /// It is a share of the DC voltage of its row, and what the value 1 of the file is of it.
    pub share: Option<f64>,
}

/// Inspects a file; the path `-` is standard input.
///
/// # Errors
/// If the file is not a table. A table that is not a log gives an inspection without a log.
pub fn inspect(path: &Path, options: &LogOptions) -> Result<Inspection, FileError> {
    let name = input::name(path);
    // In the order of an identification: what is a table of a test bench is no log.
    let of_bench = read_characteristic(path, options).and_then(|read| check(read, &name));
    let is_table = !matches!(of_bench, Ok(None));
    let of_log = LogOptions { map: if is_table { Vec::new() } else { options.map.clone() }, ..options.clone() };
    let resolved = ResolvedOptions::resolve(&of_log)?;
    let table = input::open(path).and_then(|bytes| Table::open(bytes, resolved.dbc.as_deref())).map_err(|error| error.in_file(&name))?;
    let names: Vec<String> = table.heads().iter().map(|head| head.name.clone()).collect();
    let layout = Layout::recognize(&names);
    let survey = survey(&table, layout, &resolved);
    let (kind, heads) = (table.kind(), table.heads().to_vec());
    let log = read(table, &resolved).map_err(|error| error.in_file(&name));
    let survey = if log.is_ok() { survey } else { survey.without_guesses() };
    let is_of_units = log.as_ref().err().is_some_and(|error| error.kind() == FileErrorKind::Unit);
    // Numbers that may count from 1970 are shown as such only where they are read so; dates are no numbers.
    let is_read_as_instant = |index: usize| survey.taken.iter().any(|taken| taken.index == index && taken.is_instant);
    let instants = |index: usize| heads[index].instants.clone().filter(|instants| instants.is_date() || is_read_as_instant(index));
    let courses = courses(path, resolved.dbc.as_deref(), &instants);
    let columns = heads.iter().enumerate().map(|(index, head)| {
        let of = |columns: &[Surveyed]| columns.iter().find(|column| column.index == index).copied();
        let (taken, resembling) = (of(&survey.taken), of(&survey.resembling));
        let found = taken.or(resembling);
        // Of what is read, SI is assumed where nothing states a unit; of what is not, nothing is. Where the log is refused for its units, a
        // name states none either.
        let is_doubted = |found: &Surveyed| is_of_units && is_electrical(found.channel) && !found.is_unit_written;
        let is_stated = |found: &Surveyed| found.is_unit_stated && !is_doubted(found);
        let unit = found.filter(|found| is_stated(found) || log.is_ok()).and_then(|found| found.unit);
        InspectedColumn {
            header: head.name.clone(),
            unit: head.unit.clone(),
            channel: taken.map(|column| column.channel.name()),
            read_as: match taken.is_some_and(|taken| taken.is_instant) {
                true => Some((Unit::Second.name(), "s from the first row")),
                false => unit.map(|unit| (unit.name(), unit.prose())),
            },
            is_unit_stated: found.as_ref().is_some_and(is_stated),
            is_unit_written: found.is_some_and(|found| found.is_unit_written),
            is_rotation_stated: found.is_some_and(|found| found.is_rotation_stated),
            resembles: resembling.filter(|_| taken.is_none()).map(|column| column.channel.name()),
            range: courses.get(index).and_then(Course::range),
            course: courses.get(index).map(|course| course.spans.clone()).unwrap_or_default(),
            is_time: head.is_time,
            is_instant: instants(index).is_some(),
            share: survey.shares.iter().find(|(place, _)| *place == index).map(|(_, scale)| *scale),
        }
    });
    let columns: Vec<InspectedColumn> = columns.collect();
    let mut columns = columns;
    if is_table {
        // Its speeds are not those of a log: nothing of it is a channel.
        for (index, column) in columns.iter_mut().enumerate() {
            (column.channel, column.resembles, column.read_as) = (None, quantity(index, &heads[index]), None);
        }
    }
    let (table, log) = match of_bench {
        Ok(table) => (table, log),
        Err(error) => (None, Err(error)),
    };
    Ok(Inspection { kind, layout, columns, table, is_table, log })
}

/// A table that is what it is taken for, by the check of an identification.
fn check(read: Option<ReadCharacteristic>, name: &str) -> Result<Option<ReadCharacteristic>, FileError> {
    let checked = read.as_ref().map_or(Ok(()), |read| check_characteristics(std::slice::from_ref(&read.table)));
    checked.map(|()| read).map_err(|error| FileError::from(Problem::Log(error)).in_file(name))
}

/// Whether a channel is a voltage or a current.
pub(super) fn is_electrical(channel: Channel) -> bool {
    matches!(channel.dimension(), Dimension::Voltage | Dimension::Current)
}

/// Most stretches of a course; where there are more, each two become one.
const MOST_SPANS: usize = 280;

/// The course of a column whose length is not known before.
#[derive(Debug, Clone, Default)]
struct Course {
    /// Smallest and largest number of each stretch.
    spans: Vec<[f64; 2]>,
    /// Rows of a stretch, and of the last one so far.
    rows: (usize, usize),
}

impl Course {
    fn push(&mut self, value: f64) {
        let (whole, last) = self.rows;
        if self.spans.is_empty() || last == whole {
            if self.spans.len() == MOST_SPANS {
                self.spans = self.spans.chunks(2).filter_map(range).collect();
                self.rows = (2 * whole, 0);
            } else {
                self.rows = (whole.max(1), 0);
            }
            self.spans.push([value; 2]);
        }
        if let Some([low, high]) = self.spans.last_mut() {
            (*low, *high) = (low.min(value), high.max(value));
        }
        self.rows.1 += 1;
    }

    fn range(&self) -> Option<[f64; 2]> {
        range(&self.spans)
    }
}

/// The range of several; none of none.
fn range(spans: &[[f64; 2]]) -> Option<[f64; 2]> {
    spans.iter().copied().reduce(|[low, high], [least, most]| [low.min(least), high.max(most)])
}

/// The course of every column, from a second reading.
fn courses(path: &Path, dbc: Option<&str>, instants: &dyn Fn(usize) -> Option<Instants>) -> Vec<Course> {
    let Ok(mut table) = input::open(path).and_then(|bytes| match bytes {
        Bytes::File(..) => Table::open(bytes, dbc),
        // A pipe can be read only once.
        Bytes::Stream(_) => Err(Problem::NoRows.into()),
    }) else {
        return Vec::new();
    };
    let heads = table.heads().to_vec();
    let mut courses = vec![Course::default(); heads.len()];
    let mut groups: Vec<usize> = heads.iter().map(|head| head.group).collect();
    groups.sort_unstable();
    groups.dedup();
    for group in groups {
        let of_group: Vec<usize> = (0..heads.len()).filter(|index| heads[*index].group == group).collect();
        let wanted: Vec<WantedColumn> = of_group
            .iter()
            .map(|index| WantedColumn {
                index: *index,
                header: heads[*index].name.clone(),
                is_time: false,
                is_optional: true,
                instants: instants(*index),
            })
            .collect();
        // Up to the first error, if there is one.
        let _ = table.read(&wanted, &mut |block| {
            for (index, values) in of_group.iter().zip(&block.values) {
                values.iter().filter(|value| value.is_finite()).for_each(|value| courses[*index].push(*value));
            }
            Ok(())
        });
    }
    courses
}

#[cfg(test)]
mod tests {
    use super::{Course, MOST_SPANS};

    #[test]
    fn a_course_has_every_extreme_in_its_place_however_long_it_becomes() {
        let mut course = Course::default();
        (0..10_000).for_each(|row| course.push(if row == 7_000 { 99.0 } else { f64::from(row % 2) }));
        assert_eq!(course.range(), Some([0.0, 99.0]));
        assert!(course.spans.len() <= MOST_SPANS && course.spans.len() >= MOST_SPANS / 2, "{}", course.spans.len());
        let place = course.spans.iter().position(|[_, high]| *high == 99.0).unwrap() as f64 / course.spans.len() as f64;
        assert!((place - 0.7).abs() < 0.02, "{place}");
        assert_eq!(Course::default().range(), None);
    }
}

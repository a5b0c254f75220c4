//! MAT files of MATLAB, versions 4, 5 to 7 and 7.3; and HDF5 files, on which version 7.3 is based.
//!
//! The reader of each version lists the arrays of numbers, with the paths that MATLAB gives them. Here they become columns, by the same
//! rules for all versions:
//!
//! - A vector is a column. A matrix has one column per index of its shorter side: `name(:,1)`, or `name(1,:)` for a wide matrix.
//! - Columns of the same length were sampled at the same instants, unless a structure around one of them has its own time: a field
//!   `time` or `Time` of that length.
//! - Simulink's structures with time have their values in `signals(k).values` and their names in `signals(k).label`.
//! - Matrices of two columns with the same increasing first column, as Simulink's To Workspace blocks save a signal as an array with time,
//!   are a signal each, and that column is their time.
//! - Results of Modelica tools have the names of the model's variables.
//! - Scalars, texts, booleans, complex and sparse arrays, cells and arrays of three dimensions are not columns.

mod array;
mod hdf5;
mod modelica;
mod numbers;
mod v4;
mod v5;

use super::{
    fault::damaged,
    limits::{BLOCK, MOST_COLUMNS},
    random_access::RandomAccess,
};
use crate::{block::ColumnHead, problem::Problem};
use array::{Array, Contents, Line, Object};
use fluxfit_files::FileError;
use std::collections::HashMap;

/// An open file.
pub(crate) struct Mat {
    file: Version,
    format: &'static str,
    heads: Vec<ColumnHead>,
    columns: Vec<Column>,
    unreadable: Vec<String>,
    passed_over: Option<Problem>,
}

enum Version {
    /// Versions 4 and 5.
    Flat(numbers::File),
    Hdf5(hdf5::File),
}

/// A column: a line of an array.
struct Column {
    array: usize,
    line: Line,
}

/// Maximum length of the shorter side of a matrix whose lines are columns: a larger matrix is an image or a map, not a log.
const MOST_LINES: u64 = 1024;

/// Columns of a log, without its time: two voltages, two currents, the speed.
const COLUMNS_OF_A_LOG: usize = 5;

impl Mat {
    /// Opens a file; none if it is neither a MAT nor an HDF5 file.
    pub(super) fn open(start: &[u8], source: RandomAccess) -> Result<Option<Self>, FileError> {
        if let Some(at) = hdf5::signature(start) {
            let format = if at == 0 { "HDF5" } else { "MAT" };
            let (file, contents) = hdf5::File::open(source, at, format)?;
            let mat = Self::new(contents, format, |places| Version::Hdf5(file.with(places)))?;
            return Ok(Some(mat.with_times_beside()?));
        }
        let contents = if let Some(big_endian) = v5::signature(start) {
            v5::open(&source, big_endian)?
        } else if v4::signature(start, source.length()) {
            let variables = v4::open(&source)?;
            modelica::contents(&source, &variables)?.unwrap_or_else(|| v4::contents(variables))
        } else {
            return Ok(None);
        };
        let mat = Self::new(contents, "MAT", |places| Version::Flat(numbers::File::new(source, places)))?;
        Ok(Some(mat.with_times_beside()?))
    }

    /// Takes the first columns of matrices with two for the time, if they are the same.
    fn with_times_beside(mut self) -> Result<Self, FileError> {
        let is_first = |at: &usize| {
            let of_both = self.columns.get(*at..*at + 2);
            of_both.is_some_and(|both| both[0].array == both[1].array && (both[0].line, both[1].line) == (Line::Column(0), Line::Column(1)))
                && self.columns.get(at + 2).is_none_or(|next| next.array != self.columns[*at].array)
        };
        let firsts: Vec<usize> = (0..self.columns.len()).filter(is_first).collect();
        let Some((&time, others)) = firsts.split_first().filter(|(_, others)| !others.is_empty()) else { return Ok(self) };
        let (group, rows) = (self.heads[time].group, self.heads[time].rows);
        let values = self.first_values(time)?;
        let increases = values.len() > 1 && values.windows(2).all(|pair| pair[0] < pair[1]);
        if !increases || self.heads.iter().any(|head| head.group == group && head.is_time) {
            return Ok(self);
        }
        for &other in others {
            if (self.heads[other].group, self.heads[other].rows) != (group, rows) || self.first_values(other)? != values {
                return Ok(self);
            }
        }
        for &first in &firsts {
            let name = self.heads[first].name.trim_end_matches("(:,1)").to_owned();
            self.heads[first + 1].name = name;
        }
        self.heads[time] = ColumnHead { name: "time".to_owned(), is_time: true, ..self.heads[time].clone() };
        let (heads, columns) = std::mem::take(&mut self.heads)
            .into_iter()
            .zip(std::mem::take(&mut self.columns))
            .enumerate()
            .filter(|(at, _)| !others.contains(at))
            .map(|(_, column)| column)
            .unzip();
        Ok(Self { heads, columns, ..self })
    }

    /// The first values of a column.
    fn first_values(&self, at: usize) -> Result<Vec<f64>, FileError> {
        let count = self.heads[at].rows.min(BLOCK as u64) as usize;
        let column = &self.columns[at];
        match &self.file {
            Version::Flat(file) => file.line(column.array, column.line)?.next(count),
            Version::Hdf5(file) => file.line(column.array, column.line)?.next(count),
        }
    }

    fn new<Place>(contents: Contents<Place>, format: &'static str, version: impl FnOnce(Vec<Place>) -> Version) -> Result<Self, FileError> {
        let times = times(&contents.arrays);
        let mut groups = HashMap::new();
        let (mut heads, mut columns) = (Vec::new(), Vec::new());
        for (at, array) in contents.arrays.iter().enumerate() {
            let (rows, lines) = (array.rows.max(array.columns), array.rows.min(array.columns));
            let lying = array.columns > array.rows;
            if lines > MOST_LINES {
                continue;
            }
            let owner = ancestors(&array.path).find(|owner| times.contains_key(&(*owner, rows))).unwrap_or("");
            let unit = array.unit.clone().or_else(|| unit(&array.path, &contents.labels));
            let next = groups.len();
            let group = *groups.entry((owner, rows)).or_insert(next);
            let is_time = times.get(&(owner, rows)) == Some(&at);
            let name = labelled(&array.path, &contents.labels);
            for k in 0..lines {
                let line = if lying { Line::Row(k) } else { Line::Column(k) };
                let name = match line {
                    _ if lines == 1 => name.clone(),
                    Line::Column(_) => format!("{name}(:,{})", k + 1),
                    Line::Row(_) => format!("{name}({},:)", k + 1),
                };
                heads.push(ColumnHead { name, unit: unit.clone(), rows, group, is_time, instants: None });
                columns.push(Column { array: at, line });
            }
            if heads.len() > MOST_COLUMNS {
                return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
            }
        }
        // A whole workspace was saved: where the rest of it is too little for a log, the log is in the object.
        let is_log = |object: &&Object| heads.is_empty() || heads.len() < COLUMNS_OF_A_LOG && object.holds_a_table();
        let object = contents.objects.iter().find(is_log);
        let passed_over = object.map(|Object { name, class }| Problem::MatObject { name: name.clone(), class: class.clone() });
        if heads.is_empty() {
            return Err(passed_over.unwrap_or(Problem::NoNumbers { format }).into());
        }
        let mut unreadable = contents.unreadable;
        unreadable.extend(contents.objects.into_iter().map(|object| object.name));
        let file = version(contents.arrays.into_iter().map(|array| array.place).collect());
        Ok(Self { file, format, heads, columns, unreadable, passed_over })
    }

    pub(super) fn heads(&self) -> &[ColumnHead] {
        &self.heads
    }

    pub(super) fn unreadable(&self) -> &[String] {
        &self.unreadable
    }

    pub(super) fn passed_over(&self) -> Option<&Problem> {
        self.passed_over.as_ref()
    }

    pub(super) fn read(&self, wanted: &[usize], take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        match &self.file {
            Version::Flat(file) => self.blocks(wanted, take, |column| file.line(column.array, column.line), numbers::Values::next),
            Version::Hdf5(file) => self.blocks(wanted, take, |column| file.line(column.array, column.line), hdf5::Values::next),
        }
    }

    fn blocks<Values>(
        &self,
        wanted: &[usize],
        take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>,
        open: impl Fn(&Column) -> Result<Values, FileError>,
        next: impl Fn(&mut Values, usize) -> Result<Vec<f64>, FileError>,
    ) -> Result<(), FileError> {
        let mut left = wanted.first().map_or(0, |&at| self.heads[at].rows);
        let named = |error: FileError, at: usize| error.in_column(&self.heads[at].name);
        let opened: Result<Vec<Values>, FileError> =
            wanted.iter().map(|&at| open(&self.columns[at]).map_err(|error| named(error, at))).collect();
        let mut columns = opened?;
        while left > 0 {
            let count = left.min(BLOCK as u64);
            let mut block = Vec::with_capacity(columns.len());
            for (column, &at) in columns.iter_mut().zip(wanted) {
                let values = next(column, count as usize).map_err(|error| named(error, at))?;
                if values.len() as u64 != count {
                    return Err(named(damaged(self.format, "it ends too early"), at));
                }
                block.push(values);
            }
            take(block)?;
            left -= count;
        }
        Ok(())
    }
}

/// The times of structures: the index of the array, by the path of the structure and the length.
fn times<Place>(arrays: &[Array<Place>]) -> HashMap<(&str, u64), usize> {
    let mut times = HashMap::new();
    for (at, array) in arrays.iter().enumerate() {
        if let Some(owner) = timed(&array.path)
            && array.rows.min(array.columns) == 1
        {
            times.entry((owner, array.rows.max(array.columns))).or_insert(at);
        }
    }
    times
}

/// The structure whose time a path is: of a field `time` or `Time`, or `X.Data` of a recording by ControlDesk.
fn timed(path: &str) -> Option<&str> {
    let of_recording = || path.strip_suffix(".X.Data").or_else(|| path.strip_suffix(".X(1).Data"));
    of_recording().or_else(|| match path.rsplit_once('.') {
        Some((owner, "time" | "Time")) => Some(owner),
        _ => None,
    })
}

/// The structure of a signal in a recording by ControlDesk, `rec.Y(3)` of `rec.Y(3).Data`.
fn signal(path: &str) -> Option<&str> {
    let signal = path.strip_suffix(".Data")?;
    signal.rsplit_once('.').is_some_and(|(_, field)| field == "Y" || field.starts_with("Y(")).then_some(signal)
}

/// The unit of a signal in a recording by ControlDesk.
fn unit(path: &str, labels: &HashMap<String, String>) -> Option<String> {
    let unit = labels.get(&format!("{}.Unit", signal(path)?))?.trim();
    (!unit.is_empty()).then(|| unit.to_owned())
}

/// The structures that contain a path: `a.b` and `a` of `a.b.c`.
fn ancestors(path: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(path.rsplit_once('.'), |(owner, _)| owner.rsplit_once('.')).map(|(owner, _)| owner)
}

/// The name of a Simulink signal: `log.signals(2).values` with the label `i_q` is `log.i_q`. That of ControlDesk's `rec.Y(2).Data` is its
/// `rec.Y(2).Name`, a path of a model in which each part may have quotation marks.
fn labelled(path: &str, labels: &HashMap<String, String>) -> String {
    let recorded = || {
        let name = labels.get(&format!("{}.Name", signal(path)?))?.replace('"', "");
        (!name.trim().is_empty()).then(|| name.trim().to_owned())
    };
    let named = || {
        let signal = path.strip_suffix(".values")?;
        let label = labels.get(&format!("{signal}.label")).map(|label| label.trim()).filter(|label| !label.is_empty())?;
        let (owner, _) = signal.rsplit_once('.')?;
        Some(format!("{owner}.{label}"))
    };
    recorded().or_else(named).unwrap_or_else(|| path.to_owned())
}

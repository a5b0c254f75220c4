//! Parquet, row group by row group: in memory are one page of each wanted column and two stretches of rows, of which one is decoded, its
//! columns on all cores, while the other is taken.
//!
//! Numbers of every width, decimals and timestamps are read. Timestamps become seconds since the first one of the column, subtracted
//! as integers: seconds since 1970 as one `f64` would have a resolution of only 0.24 µs. Texts, booleans and repeated fields are not
//! columns of numbers.

mod keys;
mod pages;
#[cfg(test)]
mod tests;

use super::{
    fault::damaged,
    guard::guarded,
    limits::{BLOCK, MOST_COLUMNS, most_held},
    random_access::RandomAccess,
};
use crate::{block::ColumnHead, problem::Problem};
use fluxfit_files::FileError;
use pages::FORMAT;
use parquet::{
    basic::{LogicalType, TimeUnit, Type},
    column::reader::{ColumnReader, ColumnReaderImpl},
    data_type::{DataType, DoubleType, FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96Type},
    errors::ParquetError,
    file::{reader::FileReader, serialized_reader::SerializedFileReader},
    schema::types::ColumnDescriptor,
};
use std::ops::Range;

/// Rows that a file of any size may have,
const FEW_ROWS: u64 = 10_000_000;

/// and rows for each byte of a larger one: measured values take more than a bit each, and 1e8 rows of constants are no log.
const ROWS_PER_BYTE: u64 = 8;

/// Rows that are decoded at a time: so many that handing a column to a thread takes no time, so few that the values stay in the cache.
const STRETCH: usize = 16 * BLOCK;

/// Fewer values are decoded on one thread: handing them to others would take as long.
const FEWEST_VALUES: usize = 1 << 13;

pub(crate) struct Parquet {
    file: SerializedFileReader<RandomAccess>,
    source: RandomAccess,
    heads: Vec<ColumnHead>,
    columns: Vec<Column>,
    unreadable: Vec<String>,
    /// Names of columns that hold a list in each row.
    lists: Vec<String>,
    /// The rows that are read.
    rows: Range<u64>,
    /// Rows of a stretch.
    stretch: usize,
    /// Minimum number of values in a stretch that several threads decode.
    fewest: usize,
}

struct Column {
    /// Its index in the file.
    leaf: usize,
    meaning: Meaning,
    /// The definition level of a value that is present; 0 if every value is.
    present: i16,
}

/// What a stored number means.
#[derive(Clone, Copy)]
enum Meaning {
    Number,
    Unsigned,
    /// A decimal: to be divided by this power of ten.
    Decimal(f64),
    /// A decimal in big-endian bytes.
    DecimalBytes(f64),
    /// A timestamp, in this many units per second.
    Instant(i64),
}

impl Parquet {
    pub(super) fn open(source: RandomAccess) -> Result<Self, FileError> {
        let file = guarded(FORMAT, || SerializedFileReader::new(source.clone()).map_err(fault))?;
        let metadata = file.metadata();
        let groups = metadata.row_groups();
        let schema = metadata.file_metadata().schema_descr_ptr();
        if schema.num_columns() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        let rows = groups.iter().try_fold(0u64, |sum, group| sum.checked_add(u64::try_from(group.num_rows()).ok()?));
        let rows =
            rows.filter(|rows| *rows <= most_held(source.length())).ok_or_else(|| damaged(FORMAT, "its number of rows is impossible"))?;
        if rows > FEW_ROWS && rows > source.length().saturating_mul(ROWS_PER_BYTE) {
            return Err(Problem::ConstantRows { rows }.into());
        }
        if groups.iter().any(|group| group.num_columns() != schema.num_columns()) {
            return Err(damaged(FORMAT, "its row groups have different columns"));
        }
        let (mut heads, mut columns, mut unreadable, mut lists) = (Vec::new(), Vec::new(), Vec::new(), Vec::<String>::new());
        for (leaf, column) in schema.columns().iter().enumerate() {
            let parts = column.path().parts();
            let name = parts.join(".");
            if column.max_rep_level() > 0 && meaning(column).is_some() {
                // `currents.list.element`: the parts behind the name are those of the format.
                let is_of_format = |part: &String| ["list", "bag", "array"].contains(&part.as_str());
                let own = 1 + parts.iter().skip(1).take_while(|part| !is_of_format(part)).count();
                lists.push(parts[..own].join("."));
                continue;
            }
            let Some(meaning) = meaning(column) else {
                unreadable.push(name);
                continue;
            };
            let unit = matches!(meaning, Meaning::Instant(_)).then(|| "s".to_owned());
            heads.push(ColumnHead { name, unit, rows, ..ColumnHead::default() });
            columns.push(Column { leaf, meaning, present: column.max_def_level() });
        }
        if heads.is_empty() && !lists.is_empty() {
            return Err(Problem::Lists { names: lists }.into());
        }
        if heads.is_empty() {
            return Err(Problem::NoNumbers { format: FORMAT }.into());
        }
        Ok(Self { file, source, heads, columns, unreadable, lists, rows: 0..rows, stretch: STRETCH, fewest: FEWEST_VALUES })
    }

    /// The same file as if it had these rows alone, and not the column `without`, nor any that cannot be read.
    pub(super) fn part(mut self, rows: Range<u64>, without: &str) -> Self {
        let rows = rows.start.min(self.rows.end)..rows.end.min(self.rows.end);
        let kept: Vec<bool> = self.heads.iter().map(|head| head.name != without).collect();
        let mut is_kept = kept.iter();
        self.columns.retain(|_| *is_kept.next().unwrap_or(&true));
        self.heads.retain(|head| head.name != without);
        self.heads.iter_mut().for_each(|head| head.rows = rows.end.saturating_sub(rows.start));
        self.unreadable.clear();
        self.rows = rows;
        self
    }

    pub(super) fn heads(&self) -> &[ColumnHead] {
        &self.heads
    }

    pub(super) fn lists(&self) -> &[String] {
        &self.lists
    }

    pub(super) fn unreadable(&self) -> &[String] {
        &self.unreadable
    }

    pub(super) fn read(&self, wanted: &[usize], take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        let mut starts = self.starts(wanted)?;
        let mut stretch = Stretch::default();
        let groups = self.groups();
        let mut row = groups.first().map_or(0, |(_, first)| *first);
        let take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError> = &mut |block| {
            let block = within(block, &mut row, &self.rows);
            if block.first().is_some_and(Vec::is_empty) { Ok(()) } else { take(block) }
        };
        for (group, first) in groups {
            let (mut chunks, rows) = match self.group(group, wanted, &mut starts) {
                Ok(group) => group,
                Err(error) => return stretch.pass(take).and(Err(error)),
            };
            let rows = rows.min(usize::try_from(self.rows.end - first).unwrap_or(usize::MAX));
            for start in (0..rows).step_by(self.stretch) {
                let rows = self.stretch.min(rows - start);
                let is_split = rayon::current_num_threads() > 1 && rows * wanted.len() >= self.fewest;
                stretch = Stretch::decoded(&mut chunks, rows, is_split, || stretch.pass(take))?;
            }
        }
        stretch.pass(take)
    }

    /// The row groups that have some of the rows, each with the number of its first row.
    fn groups(&self) -> Vec<(usize, u64)> {
        let mut next = 0;
        let mut groups = Vec::new();
        for (group, metadata) in self.file.metadata().row_groups().iter().enumerate() {
            let first = next;
            next += u64::try_from(metadata.num_rows()).unwrap_or(0);
            if next > self.rows.start && first < self.rows.end {
                groups.push((group, first));
            }
        }
        groups
    }

    /// The first timestamps of the wanted columns in the file, where the rows begin further below: they count from it all the same.
    fn starts(&self, wanted: &[usize]) -> Result<Vec<Option<i64>>, FileError> {
        let mut starts = vec![None; wanted.len()];
        let is_instant = |at: &usize| matches!(self.columns[*at].meaning, Meaning::Instant(_));
        if self.rows.start > 0 && wanted.iter().any(is_instant) {
            let (mut chunks, rows) = self.group(0, wanted, &mut starts)?;
            for (chunk, _) in chunks.iter_mut().zip(wanted).filter(|(_, at)| is_instant(at)) {
                if let (_, Some(error)) = chunk.blocks(rows.min(BLOCK)) {
                    return Err(error);
                }
            }
        }
        Ok(starts)
    }

    /// The wanted columns in a row group, and its number of rows.
    fn group<'a>(&'a self, group: usize, wanted: &[usize], starts: &'a mut [Option<i64>]) -> Result<(Vec<Chunk<'a>>, usize), FileError> {
        let reader = guarded(FORMAT, || self.file.get_row_group(group).map_err(fault))?;
        let rows = usize::try_from(reader.metadata().num_rows()).map_err(|_| damaged(FORMAT, "its number of rows is impossible"))?;
        let mut chunks = Vec::with_capacity(wanted.len());
        for (&at, start) in wanted.iter().zip(starts) {
            let column = &self.columns[at];
            let name = &self.heads[at].name;
            pages::check(&self.source, reader.metadata().column(column.leaf)).map_err(|error| error.in_column(name))?;
            let chunk = guarded(FORMAT, || reader.get_column_reader(column.leaf).map_err(fault))?;
            chunks.push(Chunk::new(chunk, column, start, name));
        }
        Ok((chunks, rows))
    }
}

/// What of a block is within the rows; it begins at `row`, which moves on to its end.
fn within(mut block: Vec<Vec<f64>>, row: &mut u64, rows: &Range<u64>) -> Vec<Vec<f64>> {
    let count = block.first().map_or(0, Vec::len);
    let place = |of: u64| usize::try_from(of.saturating_sub(*row)).unwrap_or(usize::MAX).min(count);
    let (from, to) = (place(rows.start), place(rows.end));
    if (from, to) != (0, count) {
        for column in &mut block {
            column.truncate(to);
            column.drain(..from.min(to));
        }
    }
    *row += count as u64;
    block
}

/// Consecutive rows of a row group.
#[derive(Default)]
struct Stretch {
    /// The blocks of each column, up to its first error.
    columns: Vec<(Vec<Vec<f64>>, Option<FileError>)>,
}

impl Stretch {
    /// The next rows. If the work is split, the threads of the pool decode the columns, while this thread does something else.
    fn decoded(
        chunks: &mut [Chunk],
        rows: usize,
        is_split: bool,
        meanwhile: impl FnOnce() -> Result<(), FileError>,
    ) -> Result<Self, FileError> {
        let mut columns = vec![(Vec::new(), None); chunks.len()];
        let work = chunks.iter_mut().zip(&mut columns);
        if is_split {
            rayon::in_place_scope(|scope| {
                for (chunk, column) in work {
                    scope.spawn(move |_| *column = chunk.blocks(rows));
                }
                meanwhile()
            })?;
        } else {
            meanwhile()?;
            work.for_each(|(chunk, column)| *column = chunk.blocks(rows));
        }
        Ok(Self { columns })
    }

    /// Passes the rows on in blocks, up to the first error.
    fn pass(self, take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        let complete = self.columns.iter().map(|(blocks, _)| blocks.len()).min().unwrap_or(0);
        let mut error = None;
        let mut columns: Vec<_> = Vec::with_capacity(self.columns.len());
        for (blocks, end) in self.columns {
            error = error.or(end.filter(|_| blocks.len() == complete));
            columns.push(blocks.into_iter());
        }
        for _ in 0..complete {
            take(columns.iter_mut().filter_map(Iterator::next).collect())?;
        }
        error.map_or(Ok(()), Err)
    }
}

fn meaning(column: &ColumnDescriptor) -> Option<Meaning> {
    let logical = column.logical_type_ref();
    let instant = |unit: &TimeUnit| {
        Meaning::Instant(match unit {
            TimeUnit::MILLIS => 1_000,
            TimeUnit::MICROS => 1_000_000,
            TimeUnit::NANOS => 1_000_000_000,
        })
    };
    let power = |scale: i32| u8::try_from(scale).ok().filter(|scale| *scale <= 38).map(|scale| 10f64.powi(i32::from(scale)));
    let integer = || match logical {
        Some(LogicalType::Integer(integer)) if !integer.is_signed => Some(Meaning::Unsigned),
        Some(LogicalType::Timestamp(timestamp)) => Some(instant(&timestamp.unit)),
        Some(LogicalType::Time(time)) => Some(instant(&time.unit)),
        Some(LogicalType::Decimal(decimal)) => power(decimal.scale).map(Meaning::Decimal),
        // A date has a resolution of a day, so it is not the time of a log.
        Some(LogicalType::Date) => None,
        _ => Some(Meaning::Number),
    };
    match column.physical_type() {
        Type::DOUBLE | Type::FLOAT => Some(Meaning::Number),
        Type::INT32 | Type::INT64 => integer(),
        Type::INT96 => Some(Meaning::Instant(1_000_000_000)),
        Type::FIXED_LEN_BYTE_ARRAY if (1..=16).contains(&column.type_length()) => match logical {
            Some(LogicalType::Decimal(decimal)) => power(decimal.scale).map(Meaning::DecimalBytes),
            _ => None,
        },
        _ => None,
    }
}

/// The part of a column in one row group.
struct Chunk<'a> {
    reader: Typed,
    meaning: Meaning,
    present: i16,
    levels: Vec<i16>,
    /// The first timestamp of the column.
    start: &'a mut Option<i64>,
    name: &'a str,
}

enum Typed {
    Double(ColumnReaderImpl<DoubleType>),
    Float(ColumnReaderImpl<FloatType>, Vec<f32>),
    Int32(ColumnReaderImpl<Int32Type>, Vec<i32>),
    Int64(ColumnReaderImpl<Int64Type>, Vec<i64>),
    Int96(ColumnReaderImpl<Int96Type>, Vec<parquet::data_type::Int96>),
    Bytes(ColumnReaderImpl<FixedLenByteArrayType>, Vec<parquet::data_type::FixedLenByteArray>),
    /// A type that is not listed as a column of numbers.
    Other,
}

impl<'a> Chunk<'a> {
    fn new(reader: ColumnReader, column: &Column, start: &'a mut Option<i64>, name: &'a str) -> Self {
        let reader = match reader {
            ColumnReader::DoubleColumnReader(reader) => Typed::Double(reader),
            ColumnReader::FloatColumnReader(reader) => Typed::Float(reader, Vec::new()),
            ColumnReader::Int32ColumnReader(reader) => Typed::Int32(reader, Vec::new()),
            ColumnReader::Int64ColumnReader(reader) => Typed::Int64(reader, Vec::new()),
            ColumnReader::Int96ColumnReader(reader) => Typed::Int96(reader, Vec::new()),
            ColumnReader::FixedLenByteArrayColumnReader(reader) => Typed::Bytes(reader, Vec::new()),
            ColumnReader::BoolColumnReader(_) | ColumnReader::ByteArrayColumnReader(_) => Typed::Other,
        };
        Self { reader, meaning: column.meaning, present: column.present, levels: Vec::new(), start, name }
    }

    /// The values of the next rows in blocks, up to the first error.
    fn blocks(&mut self, rows: usize) -> (Vec<Vec<f64>>, Option<FileError>) {
        let mut blocks = Vec::with_capacity(rows.div_ceil(BLOCK));
        for start in (0..rows).step_by(BLOCK) {
            match guarded(FORMAT, || self.next(BLOCK.min(rows - start))) {
                Ok(values) => blocks.push(values),
                Err(error) => return (blocks, Some(error.in_column(self.name))),
            }
        }
        (blocks, None)
    }

    /// The values of the next `count` rows.
    fn next(&mut self, count: usize) -> Result<Vec<f64>, FileError> {
        let mut values = Vec::with_capacity(count);
        self.levels.clear();
        let (levels, meaning) = (&mut self.levels, self.meaning);
        match &mut self.reader {
            Typed::Double(reader) => records(reader, count, levels, &mut values)?,
            Typed::Float(reader, raw) => {
                records(reader, count, levels, raw)?;
                values.extend(raw.drain(..).map(f64::from));
            }
            Typed::Int32(reader, raw) => {
                records(reader, count, levels, raw)?;
                match meaning {
                    Meaning::Unsigned => values.extend(raw.iter().map(|&value| f64::from(value.cast_unsigned()))),
                    Meaning::Decimal(power) => values.extend(raw.iter().map(|&value| f64::from(value) / power)),
                    Meaning::Instant(second) => seconds(raw.iter().map(|&value| i64::from(value)), second, self.start, &mut values),
                    Meaning::Number | Meaning::DecimalBytes(_) => values.extend(raw.iter().map(|&value| f64::from(value))),
                }
                raw.clear();
            }
            Typed::Int64(reader, raw) => {
                records(reader, count, levels, raw)?;
                match meaning {
                    Meaning::Unsigned => values.extend(raw.iter().map(|&value| value.cast_unsigned() as f64)),
                    Meaning::Decimal(power) => values.extend(raw.iter().map(|&value| value as f64 / power)),
                    Meaning::Instant(second) => seconds(raw.iter().copied(), second, self.start, &mut values),
                    Meaning::Number | Meaning::DecimalBytes(_) => values.extend(raw.iter().map(|&value| value as f64)),
                }
                raw.clear();
            }
            Typed::Int96(reader, raw) => {
                records(reader, count, levels, raw)?;
                // The old timestamps of Spark: nanoseconds of a Julian day. Damaged ones may overflow, and wrap.
                let nanoseconds = raw.iter().map(parquet::data_type::Int96::to_nanos);
                seconds(nanoseconds, 1_000_000_000, self.start, &mut values);
                raw.clear();
            }
            Typed::Bytes(reader, raw) => {
                records(reader, count, levels, raw)?;
                let power = if let Meaning::DecimalBytes(power) = meaning { power } else { 1.0 };
                values.extend(raw.iter().map(|value| from_big_endian(value.data()) as f64 / power));
                raw.clear();
            }
            Typed::Other => return Err(Problem::NoNumbers { format: FORMAT }.into()),
        }
        if self.present > 0 && values.len() < self.levels.len() {
            values = spread(&values, &self.levels, self.present);
        }
        if values.len() == count { Ok(values) } else { Err(damaged(FORMAT, "it has fewer rows than it states")) }
    }
}

/// Reads exactly `count` rows: present values into `values`, definition levels into `levels` if the column has them.
fn records<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    count: usize,
    levels: &mut Vec<i16>,
    values: &mut Vec<T::T>,
) -> Result<(), FileError> {
    let mut done = 0;
    while done < count {
        let (read, _, _) = reader.read_records(count - done, Some(levels), None, values).map_err(fault)?;
        if read == 0 {
            return Err(damaged(FORMAT, "it has fewer rows than it states"));
        }
        done += read;
    }
    Ok(())
}

/// Inserts NaN for missing values.
fn spread(values: &[f64], levels: &[i16], present: i16) -> Vec<f64> {
    let mut values = values.iter();
    levels.iter().map(|&level| if level == present { values.next().copied().unwrap_or(f64::NAN) } else { f64::NAN }).collect()
}

/// Timestamps as seconds since the first one.
fn seconds(counts: impl Iterator<Item = i64>, second: i64, start: &mut Option<i64>, into: &mut Vec<f64>) {
    into.extend(counts.map(|count| {
        let since = i128::from(count) - i128::from(*start.get_or_insert(count));
        since as f64 / second as f64
    }));
}

/// A signed integer of at most 16 bytes, two's complement.
fn from_big_endian(bytes: &[u8]) -> i128 {
    let negative = bytes.first().is_some_and(|byte| *byte >= 0x80);
    bytes.iter().fold(if negative { -1 } else { 0 }, |sum: i128, &byte| (sum << 8) | i128::from(byte))
}

fn fault(error: ParquetError) -> FileError {
    let text = match error {
        ParquetError::General(text) | ParquetError::NYI(text) | ParquetError::EOF(text) => text,
        other => other.to_string(),
    };
    // The crate's own words are for those who develop it.
    let is_short = ["EOF", "eof", "end of file", "not enough bytes", "enough data", "too early"].iter().any(|word| text.contains(word));
    let is_end = text.contains("footer") || text.contains("magic");
    damaged(
        FORMAT,
        match (is_end, is_short) {
            (true, _) => "its end, which says what it holds, is missing or damaged",
            (_, true) => "it ends too early",
            _ => "its data are damaged",
        },
    )
}

//! Tables of Python's memory, as the reader of logs takes them: their values are read where they lie.

use arrow_array::{
    Array, ArrayRef, RecordBatch,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};
use arrow_cast::cast;
use arrow_schema::{DataType, TimeUnit};
use fluxfit_log::{MemoryColumn, MemoryTable, ReadRows};
use numpy::PyReadonlyArray1;
use pyo3::{prelude::*, types::PyDict};
use pyo3_arrow::PyTable;

/// A table that Python holds.
pub(crate) enum Held<'py> {
    /// What came through Arrow's C stream interface; the memory stays that of whoever made it.
    Arrow(PyTable),
    /// Names, units and contiguous arrays.
    Arrays(Vec<(String, PyReadonlyArray1<'py, f64>)>),
}

impl<'py> Held<'py> {
    /// Takes a dictionary of arrays, or anything that has Arrow's C stream interface.
    pub(crate) fn of(data: &Bound<'py, PyAny>) -> PyResult<Self> {
        let Ok(dictionary) = data.cast::<PyDict>() else { return Ok(Self::Arrow(data.extract()?)) };
        let array = |(name, values): (Bound<'py, PyAny>, Bound<'py, PyAny>)| Ok((name.extract()?, values.extract()?));
        Ok(Self::Arrays(dictionary.iter().map(array).collect::<PyResult<_>>()?))
    }

    /// The memory behind it, which other threads may read.
    pub(crate) fn values(&self) -> PyResult<Values<'_>> {
        Ok(match self {
            Self::Arrow(table) => Values::Arrow(table.batches()),
            Self::Arrays(arrays) => {
                let mut all = Vec::with_capacity(arrays.len());
                for (name, values) in arrays {
                    all.push((name.as_str(), values.as_slice()?));
                }
                Values::Arrays(all)
            }
        })
    }
}

/// Borrowed values of a table.
pub(crate) enum Values<'a> {
    Arrow(&'a [RecordBatch]),
    Arrays(Vec<(&'a str, &'a [f64])>),
}

impl Values<'_> {
    /// The table, as the reader takes it.
    pub(crate) fn table(&self) -> MemoryTable<'_> {
        match self {
            Self::Arrow(batches) => of_batches(batches),
            Self::Arrays(arrays) => {
                let mut columns = Vec::with_capacity(arrays.len());
                for &(name, values) in arrays {
                    columns.push(MemoryColumn {
                        name: name.to_owned(),
                        unit: None,
                        rows: values.len(),
                        read: Box::new(move |rows, into| into.extend_from_slice(&values[rows])),
                    });
                }
                MemoryTable { columns, unreadable: Vec::new() }
            }
        }
    }
}

/// The columns of batches, one after the other.
fn of_batches(batches: &[RecordBatch]) -> MemoryTable<'_> {
    let mut table = MemoryTable::default();
    let Some(first) = batches.first() else { return table };
    let rows = batches.iter().map(RecordBatch::num_rows).sum();
    // The first row of each batch.
    let starts: Vec<usize> = batches
        .iter()
        .scan(0, |next, batch| {
            let start = *next;
            *next += batch.num_rows();
            Some(start)
        })
        .collect();
    for (index, field) in first.schema_ref().fields().iter().enumerate() {
        let chunks: Vec<&ArrayRef> = batches.iter().map(|batch| batch.column(index)).collect();
        match reader(field.data_type(), chunks, starts.clone()) {
            Some((read, unit)) => table.columns.push(MemoryColumn { name: field.name().clone(), unit, rows, read }),
            None => table.unreadable.push(field.name().clone()),
        }
    }
    table
}

/// What reads a column of this type, and its unit if the type tells it; `None` if it holds no numbers.
fn reader<'a>(kind: &DataType, chunks: Vec<&'a ArrayRef>, starts: Vec<usize>) -> Option<(ReadRows<'a>, Option<&'static str>)> {
    let per_second = match kind {
        DataType::Timestamp(unit, _) | DataType::Duration(unit) => Some(match unit {
            TimeUnit::Second => 1.0,
            TimeUnit::Millisecond => 1e3,
            TimeUnit::Microsecond => 1e6,
            TimeUnit::Nanosecond => 1e9,
        }),
        kind if kind.is_numeric() => None,
        _ => return None,
    };
    // Subtracted as integers: seconds since 1970 as one number would have a resolution of 0.24 us only.
    let start = per_second.and_then(|_| chunks.iter().find_map(|chunk| integers(chunk)?.iter().flatten().next()));
    let read = move |rows: std::ops::Range<usize>, into: &mut Vec<f64>| {
        let mut at = rows.start;
        let mut chunk = starts.partition_point(|start| *start <= at).saturating_sub(1);
        while at < rows.end && chunk < chunks.len() {
            let offset = at - starts[chunk];
            let count = (chunks[chunk].len() - offset).min(rows.end - at);
            append(&chunks[chunk].slice(offset, count), per_second, start.unwrap_or(0), into);
            at += count;
            chunk += 1;
        }
        // A type that cannot be converted after all: missing values, which the reader refuses with their place.
        into.resize(into.len().max(rows.len()), f64::NAN);
    };
    Some((Box::new(read), per_second.map(|_| "s")))
}

/// Appends a part of a column; a missing value is NaN.
fn append(part: &ArrayRef, per_second: Option<f64>, start: i64, into: &mut Vec<f64>) {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    if let Some(per_second) = per_second {
        let since = |count: i64| (i128::from(count) - i128::from(start)) as f64 / per_second;
        into.extend(integers(part).iter().flat_map(|counts| counts.iter().map(|count| number(count.map(since))).collect::<Vec<_>>()));
        return;
    }
    // A column of numbers of 64 bits is read as it is; a block of any other is converted.
    let Ok(part) = cast(part, &DataType::Float64) else { return };
    let values = part.as_primitive::<Float64Type>();
    if values.null_count() == 0 { into.extend_from_slice(values.values()) } else { into.extend(values.iter().map(number)) }
}

/// Instants as they are counted.
fn integers(part: &ArrayRef) -> Option<arrow_array::PrimitiveArray<Int64Type>> {
    Some(cast(part, &DataType::Int64).ok()?.as_primitive::<Int64Type>().clone())
}

//! Many motors: the logs of a list, or a table with a column that names them.

use crate::{
    columns::{Held, Values},
    error::raised,
    interruptible::{Watcher, interruptible, interruptible_on_borrowed},
};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray, cast::AsArray};
use arrow_cast::cast;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use fluxfit_cli::face::{self, Fleet, HeldMotors};
use fluxfit_files::FileError;
use fluxfit_log::{no_motor_names, no_motors_column};
use pyo3::{
    exceptions::PyRuntimeError,
    prelude::*,
    types::{PyCapsule, PyDict},
};
use pyo3_arrow::PyTable;
use std::{ffi::OsString, path::PathBuf, sync::Arc};

/// A name, or none, and how many rows have it one after the other.
type Run = (Option<String>, usize);

/// Rows whose names are made texts at a time.
const ROWS: usize = 1 << 13;

/// The rows of a fleet.
#[pyclass(frozen, module = "fluxfit._fluxfit")]
pub(crate) struct FleetRows {
    fleet: Fleet,
    batch: RecordBatch,
}

#[pymethods]
impl FleetRows {
    /// Arrow's C stream interface.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(&self, py: Python<'py>, requested_schema: Option<Bound<'py, PyCapsule>>) -> PyResult<Bound<'py, PyAny>> {
        let table = PyTable::try_new(vec![self.batch.clone()], self.batch.schema())?;
        Bound::new(py, table)?.call_method1("__arrow_c_stream__", (requested_schema,))
    }

    /// The values of each column: texts, numbers, or nothing.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for (name, kind) in face::fleet_columns() {
            let values = || self.fleet.rows().iter().map(|row| &row[name]);
            match kind {
                "text" => columns.set_item(name, values().map(|value| value.as_str()).collect::<Vec<_>>())?,
                "number" => columns.set_item(name, values().map(|value| value.as_f64()).collect::<Vec<_>>())?,
                _ => columns.set_item(name, values().map(|value| value.as_u64()).collect::<Vec<_>>())?,
            }
        }
        Ok(columns)
    }

    /// How many motors have what.
    fn count(&self) -> String {
        self.fleet.count()
    }

    /// Writes the results.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.fleet.write(&path)).map_err(|refusal| raised(py, &refusal))
    }

    /// Writes the page.
    fn report(&self, py: Python<'_>, path: PathBuf, call: &str) -> PyResult<()> {
        py.detach(|| self.fleet.report(&path, call)).map_err(|refusal| raised(py, &refusal))
    }
}

/// The rows as columns of Arrow.
fn batch(fleet: &Fleet) -> Result<RecordBatch, ArrowError> {
    let (mut fields, mut columns) = (Vec::new(), Vec::<ArrayRef>::new());
    for (name, kind) in face::fleet_columns() {
        let values = || fleet.rows().iter().map(|row| &row[name]);
        columns.push(match kind {
            "text" => Arc::new(StringArray::from_iter(values().map(|value| value.as_str()))),
            "number" => Arc::new(Float64Array::from_iter(values().map(|value| value.as_f64()))),
            _ => Arc::new(Int64Array::from_iter(values().map(|value| value.as_i64()))),
        });
        let kind = columns.last().map_or(DataType::Null, |column| column.data_type().clone());
        fields.push(Field::new(name, kind, true));
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), columns)
}

/// Identifies many motors: `words` are those of `fluxfit fleet`. Of a table in memory, `by` is the column that names the motors, whose
/// values are given as `runs` where they are not in a table of Arrow.
#[pyfunction]
#[pyo3(signature = (words, data=None, by=None, runs=None, source="table", output=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "the package has them as keywords")]
pub(crate) fn fleet(
    py: Python<'_>,
    words: Vec<OsString>,
    data: Option<&Bound<'_, PyAny>>,
    by: Option<&str>,
    runs: Option<Vec<Run>>,
    source: &str,
    output: Option<PathBuf>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<FleetRows> {
    let found = match data {
        None => interruptible(py, progress, move |watcher| {
            face::fleet(&words, None, output.as_deref(), &watcher.asker(), &|done, of| watcher.motors(done, of))
        })?,
        Some(data) => {
            let held = Held::of(data)?;
            let (values, by) = (held.values()?, by.unwrap_or_default());
            let runs = match runs {
                Some(runs) => runs,
                None => py.detach(|| named_runs(&values, by)).map_err(|error| raised(py, &error.in_file(source).into()))?,
            };
            let mut table = values.table();
            table.columns.retain(|column| column.name != by);
            table.unreadable.retain(|name| name != by);
            let motors = HeldMotors { table, source, runs: &runs };
            let work = |watcher: Watcher| {
                face::fleet(&words, Some(&motors), output.as_deref(), &watcher.asker(), &|done, of| watcher.motors(done, of))
            };
            interruptible_on_borrowed(py, progress, work)?
        }
    };
    let fleet = found.map_err(|refusal| raised(py, &refusal))?;
    // Only a signal or an exception breaks it off, and that was raised above.
    let fleet = fleet.ok_or_else(|| PyRuntimeError::new_err("the fleet was broken off"))?;
    let batch = batch(&fleet).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(FleetRows { fleet, batch })
}

/// The values of the column that names the motors, as runs of equal ones.
fn named_runs(values: &Values, by: &str) -> Result<Vec<Run>, FileError> {
    let batches = match values {
        Values::Arrow(batches) => *batches,
        // The column would be no array of numbers.
        Values::Arrays(arrays) => return Err(no_motors_column(by, arrays.iter().map(|(name, _)| (*name).to_owned()).collect())),
    };
    let mut runs: Vec<Run> = Vec::new();
    for batch in batches {
        let names = || batch.schema_ref().fields().iter().map(|field| field.name().clone()).collect();
        let column = batch.column_by_name(by).ok_or_else(|| no_motors_column(by, names()))?;
        if !is_of_names(column.data_type()) {
            return Err(no_motor_names(by));
        }
        for from in (0..column.len()).step_by(ROWS) {
            let part = column.slice(from, ROWS.min(column.len() - from));
            let texts = cast(&part, &DataType::Utf8).map_err(|_| no_motor_names(by))?;
            for text in texts.as_string::<i32>() {
                match runs.last_mut() {
                    Some((last, rows)) if last.as_deref() == text => *rows += 1,
                    _ => runs.push((text.map(str::to_owned), 1)),
                }
            }
        }
    }
    Ok(runs)
}

/// Whether a column holds texts or whole numbers.
fn is_of_names(kind: &DataType) -> bool {
    match kind {
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View | DataType::Null => true,
        DataType::Dictionary(_, values) => is_of_names(values),
        kind => kind.is_integer(),
    }
}

/// The rows of a fleet for one motor: a JSON list of objects.
#[pyfunction]
pub(crate) fn fleet_rows(py: Python<'_>, words: Vec<OsString>, motor: &str, source: &str, data: &Bound<'_, PyAny>) -> PyResult<String> {
    let held = Held::of(data)?;
    let values = held.values()?;
    py.detach(|| face::fleet_rows(&words, motor, source, values.table())).map_err(|refusal| raised(py, &refusal))
}

/// The columns of these rows: each with `text`, `number` or `count`.
#[pyfunction]
pub(crate) fn fleet_columns() -> Vec<(&'static str, &'static str)> {
    face::fleet_columns()
}

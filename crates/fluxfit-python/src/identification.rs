//! An identification and its answer; a log alone.

use crate::{arrays, columns::Held, error::raised, interruptible::interruptible};
use fluxfit_cli::face::{Refusal, Task, document};
use pyo3::{prelude::*, types::PyDict};
use std::{ffi::OsString, path::PathBuf};

/// What an identification gave.
#[pyclass(frozen, module = "fluxfit._fluxfit")]
pub(crate) struct Answer {
    task: Task,
    answer: fluxfit::Answer,
}

#[pymethods]
impl Answer {
    /// The JSON document, as the command prints it.
    fn document(&self, py: Python<'_>) -> PyResult<String> {
        document(&self.answer).map_err(|refusal| raised(py, &refusal))
    }

    /// Writes the page.
    fn report(&self, py: Python<'_>, path: PathBuf, call: &str) -> PyResult<()> {
        py.detach(|| self.task.report(&self.answer, &path, call)).map_err(|refusal| raised(py, &refusal))
    }

    /// Writes the file of another tool.
    fn export(&self, py: Python<'_>, target: &str, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.task.export(&self.answer, target, &path)).map_err(|refusal| raised(py, &refusal))
    }

    /// The rows that were identified from.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        arrays::columns(py, self.answer.log.columns(), &[])
    }

    /// What was read as what, and what was inferred.
    fn notes(&self) -> Vec<String> {
        self.task.said()
    }
}

/// Reads what the words name; where there are data, the reading is over before this returns, because they are borrowed.
fn task(py: Python<'_>, words: &[OsString], data: &Bound<'_, PyAny>) -> PyResult<Result<Task, Refusal>> {
    let held = Held::of(data)?;
    let values = held.values()?;
    Ok(py.detach(|| Task::read(words, Some(values.table()))))
}

/// Identifies: `words` are those of `fluxfit identify`.
#[pyfunction]
#[pyo3(signature = (words, data=None, progress=None))]
pub(crate) fn identify(
    py: Python<'_>,
    words: Vec<OsString>,
    data: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Answer> {
    let read = data.map(|data| task(py, &words, data)).transpose()?;
    let found = interruptible(py, progress, move |watcher| {
        let task = read.unwrap_or_else(|| Task::read(&words, None))?;
        let answer = task.identify(&|step| watcher.step(step))?;
        Ok(Answer { task, answer })
    })?;
    found.map_err(|refusal: Refusal| raised(py, &refusal))
}

/// The log that the words of `fluxfit identify` name: its columns, and what was read as what.
#[pyfunction]
#[pyo3(signature = (words, data=None))]
pub(crate) fn read_log<'py>(
    py: Python<'py>,
    words: Vec<OsString>,
    data: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let read = match data {
        Some(data) => {
            let held = Held::of(data)?;
            let values = held.values()?;
            py.detach(|| Task::read_log(&words, Some(values.table())))
        }
        None => interruptible(py, None, move |_| Task::read_log(&words, None))?,
    };
    let task = read.map_err(|refusal| raised(py, &refusal))?;
    Ok((arrays::columns(py, task.log().columns(), &[])?, task.said()))
}

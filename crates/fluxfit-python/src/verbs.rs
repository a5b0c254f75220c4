//! The other verbs, and the whole command.

use crate::{arrays, columns::Held, error::raised, interruptible::interruptible};
use fluxfit_cli::face::{self, Refusal, ScenarioSource};
use pyo3::{prelude::*, types::PyDict};
use std::{ffi::OsString, path::PathBuf, process::ExitCode};

/// The version of the library.
#[pyfunction]
pub(crate) fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// The whole command; returns its exit status.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let status = py.detach(|| fluxfit_cli::run(words));
    // The standard library does not tell a status, but whether two are equal.
    (0..=u8::MAX).find(|code| ExitCode::from(*code) == status).unwrap_or(2)
}

/// The document of `fluxfit inspect`.
#[pyfunction]
pub(crate) fn inspect(py: Python<'_>, words: Vec<OsString>) -> PyResult<String> {
    interruptible(py, None, move |_| face::inspection(&words))?.map_err(|refusal| raised(py, &refusal))
}

/// The document of `fluxfit validate`; `motor` is the content of a motor file.
#[pyfunction]
#[pyo3(signature = (words, data=None, motor=None))]
pub(crate) fn validate(py: Python<'_>, words: Vec<OsString>, data: Option<&Bound<'_, PyAny>>, motor: Option<String>) -> PyResult<String> {
    let document = match data {
        Some(data) => {
            let held = Held::of(data)?;
            let values = held.values()?;
            py.detach(|| face::validation(&words, Some(values.table()), motor.as_deref().map(str::as_bytes)))
        }
        None => interruptible(py, None, move |_| face::validation(&words, None, motor.as_deref().map(str::as_bytes)))?,
    };
    document.map_err(|refusal| raised(py, &refusal))
}

/// The document of `fluxfit compare`.
#[pyfunction]
#[pyo3(signature = (words, data=None))]
pub(crate) fn compare(py: Python<'_>, words: Vec<OsString>, data: Option<&Bound<'_, PyAny>>) -> PyResult<String> {
    let document = match data {
        Some(data) => {
            let held = Held::of(data)?;
            let values = held.values()?;
            py.detach(|| face::comparison(&words, Some(values.table()), &|| std::ops::ControlFlow::Continue(())))
        }
        None => interruptible(py, None, move |watcher| face::comparison(&words, None, &watcher.asker()))?,
    };
    document.map_err(|refusal| raised(py, &refusal))
}

/// Simulates: the columns, and the document of the true parameters.
#[pyfunction]
#[pyo3(signature = (path=None, text=None, seed=None, draw=0))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    path: Option<PathBuf>,
    text: Option<String>,
    seed: Option<u32>,
    draw: u64,
) -> PyResult<(Bound<'py, PyDict>, String)> {
    let simulated = interruptible(py, None, move |_| {
        let source = match (&path, &text) {
            (Some(path), _) => ScenarioSource::File(path),
            (None, Some(text)) => ScenarioSource::Text(text),
            (None, None) => ScenarioSource::Paper,
        };
        face::simulation(source, seed, draw)
    })?;
    let (recording, truth) = simulated.map_err(|refusal: Refusal| raised(py, &refusal))?;
    let others = [("ud_ref", recording.ud_ref.as_slice()), ("uq_ref", recording.uq_ref.as_slice())];
    Ok((arrays::columns(py, &recording.columns, &others)?, truth))
}

/// The page of a code of a warning or finding.
#[pyfunction]
pub(crate) fn explain(py: Python<'_>, code: &str) -> PyResult<String> {
    face::explanation(code).map_err(|refusal| raised(py, &refusal))
}

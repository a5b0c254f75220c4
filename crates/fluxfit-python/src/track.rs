//! A running motor, followed by rows as they arrive.

use crate::error::{misuse, raised};
use fluxfit::Columns;
use fluxfit_cli::face::{Left, Tracking};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use std::{collections::BTreeMap, ffi::OsString, path::PathBuf};

/// A tracker.
#[pyclass(module = "fluxfit._fluxfit")]
pub(crate) struct Tracker(Tracking);

#[pymethods]
impl Tracker {
    /// As the words of `fluxfit track` ask for it.
    #[new]
    fn new(py: Python<'_>, words: Vec<OsString>) -> PyResult<Self> {
        Tracking::begin(&words).map(Self).map_err(|refusal| raised(py, &refusal))
    }

    /// Takes rows in columns, in SI units, and gives the documents that are due.
    fn take(&mut self, py: Python<'_>, columns: BTreeMap<String, PyReadonlyArray1<'_, f64>>) -> PyResult<Vec<String>> {
        let column = |name: &str| columns.get(name).map(|values| values.as_array().to_vec());
        let needed =
            |name: &str| column(name).ok_or_else(|| misuse(py, &format!("the rows have no {name}; give t, ud, uq, id, iq and omega_e")));
        let rows = Columns {
            t: needed("t")?,
            ud: needed("ud")?,
            uq: needed("uq")?,
            id: needed("id")?,
            iq: needed("iq")?,
            omega_e: needed("omega_e")?,
            theta_e: column("theta_e"),
            u_dc: column("u_dc"),
            temperature: column("temperature"),
        };
        let lengths = columns.iter().filter(|(_, values)| values.as_array().len() != rows.t.len());
        if let Some((name, values)) = lengths.into_iter().next() {
            let (given, wanted) = (values.as_array().len(), rows.t.len());
            return Err(misuse(py, &format!("{name} has {given} rows, and t {wanted}; give one value for each row")));
        }
        py.detach(|| self.0.take(&rows)).map_err(|refusal| raised(py, &refusal))
    }

    /// The document of what is known now.
    fn document(&mut self, py: Python<'_>) -> PyResult<String> {
        self.0.end().map_err(|refusal| raised(py, &refusal))
    }

    /// The parameters that have left their band so far: each with its time, its value, the value around which the band lies, and the
    /// sentence.
    fn alarms(&self) -> Vec<(&'static str, f64, f64, f64, String)> {
        let alarm = |left: &Left| (left.parameter.key(), left.t, left.value, left.start, left.to_string());
        self.0.alarms().iter().map(alarm).collect()
    }

    /// Saves what is known.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.0.save(&path).map_err(|refusal| raised(py, &refusal))
    }
}

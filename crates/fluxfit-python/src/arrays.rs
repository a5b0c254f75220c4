//! numpy's arrays out: the columns of a log.

use fluxfit::Columns;
use numpy::PyArray1;
use pyo3::{prelude::*, types::PyDict};

/// The columns as a dictionary of arrays, in SI units.
pub(crate) fn columns<'py>(py: Python<'py>, columns: &Columns, others: &[(&str, &[f64])]) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    let Columns { t, ud, uq, id, iq, omega_e, theta_e, u_dc, temperature } = columns;
    for (name, values) in [("t", t), ("ud", ud), ("uq", uq), ("id", id), ("iq", iq), ("omega_e", omega_e)] {
        dictionary.set_item(name, PyArray1::from_slice(py, values))?;
    }
    for (name, values) in [("theta_e", theta_e), ("u_dc", u_dc), ("temperature", temperature)] {
        if let Some(values) = values {
            dictionary.set_item(name, PyArray1::from_slice(py, values))?;
        }
    }
    for (name, values) in others {
        dictionary.set_item(*name, PyArray1::from_slice(py, values))?;
    }
    Ok(dictionary)
}

//! Refusals of the command's face as exceptions of the package, in Python's words.

use crate::wording::in_python;
use fluxfit_cli::face::{About, Refusal};
use pyo3::{prelude::*, types::PyType};

/// The exception of a refusal.
pub(crate) fn raised(py: Python<'_>, refusal: &Refusal) -> PyErr {
    let class = match refusal.about {
        About::File => "FileError",
        About::Data => "DataError",
        About::Request => "RequestError",
    };
    raise(py, class, &in_python(&refusal.sentence))
}

/// The exception of misuse.
pub(crate) fn misuse(py: Python<'_>, sentence: &str) -> PyErr {
    raise(py, "RequestError", sentence)
}

fn raise(py: Python<'_>, class: &str, sentence: &str) -> PyErr {
    let class = py.import("fluxfit._errors").and_then(|module| module.getattr(class)).and_then(|class| Ok(class.cast_into::<PyType>()?));
    class.map_or_else(|error| error, |class| PyErr::from_type(class, sentence.to_owned()))
}

//! The methods on what a log gives to minimize.

use fluxfit::{
    Model, Request,
    optimizer::Method,
    paper,
    study::comparison::{Comparison, ComparisonRequest, compare},
};
use fluxfit_log::{LogOptions, read_log};
use std::{error::Error, ops::ControlFlow, path::Path};

/// All methods on a log, in the paper's box.
///
/// # Errors
/// If the log cannot be read or has nothing to minimize.
pub fn compare_all(log: &Path, model: Model, runs: usize) -> Result<Comparison, Box<dyn Error>> {
    let log = read_log(log, &LogOptions::default())?.log;
    let request = Request { bounds: paper::SEARCH_BOX.map(|upper| Some((0.0, upper))), ..Request::default() };
    let asked = ComparisonRequest { request, model, methods: Method::all().to_vec(), runs, ..ComparisonRequest::default() };
    Ok(compare(&log, &asked, &|_| ControlFlow::Continue(()))?)
}

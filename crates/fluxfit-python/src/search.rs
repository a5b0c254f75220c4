//! The optimizers for any function of Python: run to the end, or asked and told.

use crate::error::misuse;
use fluxfit_optimize::{Bounds, METHODS, Method, Optimizer, SearchSettings, StopReason};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};

/// Keys of the methods, and what they are called.
#[pyfunction]
pub(crate) fn methods() -> Vec<(&'static str, &'static str)> {
    METHODS.iter().map(|facts| (facts.key, facts.label)).collect()
}

/// The costs of candidates by a function of Python, which takes them in rows.
fn costs<'py>(py: Python<'py>, function: &Bound<'py, PyAny>, candidates: &[f64], dimension: usize) -> PyResult<Vec<f64>> {
    let asked = candidates.len() / dimension;
    let answer = function.call1((PyArray1::from_slice(py, candidates).reshape([asked, dimension])?,))?;
    // What numpy computes of numbers of 64 bits is taken as it is, anything else converted.
    let answer: PyReadonlyArray1<'_, f64> = match answer.extract() {
        Ok(answer) => answer,
        Err(_) => py.import("numpy")?.call_method1("asarray", (answer, "float64"))?.extract()?,
    };
    if answer.len() != asked {
        let told = answer.len();
        return Err(PyValueError::new_err(format!(
            "the function returned {told} costs for {asked} candidates; it must return one for each row"
        )));
    }
    Ok(answer.as_array().to_vec())
}

fn method(py: Python<'_>, key: &str) -> PyResult<Method> {
    let keys = || METHODS.iter().map(|facts| facts.key).collect::<Vec<_>>().join(", ");
    Method::named(key).ok_or_else(|| misuse(py, &format!("there is no method {key:?}; the methods are {}", keys())))
}

fn stop_key(reason: StopReason) -> &'static str {
    match reason {
        StopReason::IterationLimit => "iteration-limit",
        StopReason::CloseToOptimum => "close-to-optimum",
        StopReason::TargetCost => "target-cost",
        StopReason::Interrupted => "interrupted",
    }
}

/// What a search has found.
fn found<'py>(py: Python<'py>, search: &Optimizer) -> PyResult<Bound<'py, PyDict>> {
    let population = search.population();
    let dictionary = PyDict::new(py);
    dictionary.set_item("x", PyArray1::from_slice(py, population.best()))?;
    dictionary.set_item("fun", population.best_cost())?;
    dictionary.set_item("nfev", population.evaluations())?;
    dictionary.set_item("nit", search.history().len().saturating_sub(1))?;
    dictionary.set_item("stop_reason", stop_key(search.stop_reason().unwrap_or(StopReason::Interrupted)))?;
    dictionary.set_item("history", PyArray1::from_iter(py, search.history().iter().map(|record| record.cost)))?;
    Ok(dictionary)
}

/// Minimizes a vectorized function. `callback` is called with the best position and its cost after each iteration; what is true stops.
#[pyfunction]
#[pyo3(signature = (function, lower, upper, key, population, iterations, seed, target=None, callback=None))]
#[expect(clippy::too_many_arguments, reason = "the package has them as keywords")]
pub(crate) fn minimize<'py>(
    py: Python<'py>,
    function: Bound<'py, PyAny>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    key: &str,
    population: usize,
    iterations: usize,
    seed: u64,
    target: Option<f64>,
    callback: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let settings = SearchSettings { population, iterations, seed, target_cost: target, ..SearchSettings::default() };
    let (mut search, dimension) = started(py, lower, upper, key, settings)?;
    loop {
        let candidates = search.ask();
        if candidates.is_empty() {
            break;
        }
        let costs = costs(py, &function, candidates, dimension)?;
        let iterations = search.history().len();
        search.tell(&costs).map_err(|error| misuse(py, &error.to_string()))?;
        py.check_signals()?;
        // The first record is that of the start.
        let is_iteration = iterations > 0 && search.history().len() > iterations;
        if let Some(callback) = callback.as_ref().filter(|_| is_iteration) {
            let best = PyArray1::from_slice(py, search.population().best());
            if callback.call1((best, search.population().best_cost()))?.is_truthy()? {
                break;
            }
        }
    }
    found(py, &search)
}

/// A search that asks, and the dimension of its box.
fn started(py: Python<'_>, lower: Vec<f64>, upper: Vec<f64>, key: &str, settings: SearchSettings) -> PyResult<(Optimizer, usize)> {
    let method = method(py, key)?;
    let bounds = Bounds::new(lower, upper).map_err(|error| misuse(py, &error.to_string()))?;
    let dimension = bounds.dimension();
    Ok((Optimizer::asking(method, settings, bounds).map_err(|error| misuse(py, &error.to_string()))?, dimension))
}

/// A search that is asked for candidates and told their costs.
#[pyclass(module = "fluxfit._fluxfit")]
pub(crate) struct AskTell {
    search: Optimizer,
    dimension: usize,
    /// Candidates were asked for, and their costs are not yet told.
    is_open: bool,
}

#[pymethods]
impl AskTell {
    #[new]
    fn new(py: Python<'_>, lower: Vec<f64>, upper: Vec<f64>, key: &str, population: usize, iterations: usize, seed: u64) -> PyResult<Self> {
        let settings = SearchSettings { population, iterations, seed, ..SearchSettings::default() };
        let (search, dimension) = started(py, lower, upper, key, settings)?;
        Ok(Self { search, dimension, is_open: false })
    }

    /// The next candidates in rows; `None` when the search is over.
    fn ask<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let candidates = self.search.ask();
        self.is_open = !candidates.is_empty();
        let rows = self.is_open.then(|| PyArray1::from_slice(py, candidates).reshape([candidates.len() / self.dimension, self.dimension]));
        rows.transpose()
    }

    /// The costs of what was asked.
    fn tell(&mut self, py: Python<'_>, costs: Vec<f64>) -> PyResult<()> {
        if !self.is_open {
            return Err(misuse(py, "nothing was asked; call ask() before tell()"));
        }
        self.search.tell(&costs).map_err(|error| misuse(py, &error.to_string()))?;
        self.is_open = false;
        Ok(())
    }

    /// What was found; `None` while the search goes on.
    fn result<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.search.stop_reason().map(|_| found(py, &self.search)).transpose()
    }
}

//! The optimizers for any function of Python: run to the end, or asked and told.

use crate::error::misuse;
use fluxfit_optimize::{Bounds, METHODS, Method, Objective, Optimizer, SearchReport, SearchSettings, StopReason};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};
use std::{
    ops::ControlFlow,
    sync::{
        Mutex, PoisonError,
        mpsc::{Receiver, Sender, channel},
    },
    thread::JoinHandle,
};

/// Keys of the methods, and what they are called.
#[pyfunction]
pub(crate) fn methods() -> Vec<(&'static str, &'static str)> {
    METHODS.iter().map(|facts| (facts.key, facts.label)).collect()
}

/// A function of Python: candidates in rows, to a cost each.
struct Function {
    dimension: usize,
    call: Py<PyAny>,
    /// What it raised first.
    raised: Mutex<Option<PyErr>>,
}

impl Function {
    fn costs(&self, py: Python<'_>, candidates: &[f64], costs: &mut [f64]) -> PyResult<()> {
        let rows = PyArray1::from_slice(py, candidates).reshape([costs.len(), self.dimension])?;
        let answer = self.call.bind(py).call1((rows,))?;
        // What numpy computes of numbers of 64 bits is taken as it is, anything else converted.
        let answer: PyReadonlyArray1<'_, f64> = match answer.extract() {
            Ok(answer) => answer,
            Err(_) => py.import("numpy")?.call_method1("asarray", (answer, "float64"))?.extract()?,
        };
        if answer.len() != costs.len() {
            let why =
                format!("the function returned {} costs for {} candidates; it must return one for each row", answer.len(), costs.len());
            return Err(PyValueError::new_err(why));
        }
        for (cost, answer) in costs.iter_mut().zip(answer.as_array()) {
            *cost = *answer;
        }
        Ok(())
    }

    fn raised(&self) -> std::sync::MutexGuard<'_, Option<PyErr>> {
        self.raised.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Objective for Function {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        costs.fill(f64::NAN);
        if self.raised().is_some() {
            return;
        }
        let outcome = Python::attach(|py| self.costs(py, candidates, costs));
        if let Err(error) = outcome {
            costs.fill(f64::NAN);
            *self.raised() = Some(error);
        }
    }
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

fn found<'py>(py: Python<'py>, report: &SearchReport) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    dictionary.set_item("x", PyArray1::from_slice(py, &report.best))?;
    dictionary.set_item("fun", report.cost)?;
    dictionary.set_item("nfev", report.evaluations)?;
    dictionary.set_item("nit", report.history.len().saturating_sub(1))?;
    dictionary.set_item("stop_reason", stop_key(report.stop_reason))?;
    dictionary.set_item("history", PyArray1::from_iter(py, report.history.iter().map(|record| record.cost)))?;
    Ok(dictionary)
}

/// Minimizes a vectorized function. `callback` is called with the best position and its cost after each iteration; what is true stops.
#[pyfunction]
#[pyo3(signature = (function, lower, upper, key, population, iterations, seed, target=None, callback=None))]
#[expect(clippy::too_many_arguments, reason = "the package has them as keywords")]
pub(crate) fn minimize<'py>(
    py: Python<'py>,
    function: Py<PyAny>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    key: &str,
    population: usize,
    iterations: usize,
    seed: u64,
    target: Option<f64>,
    callback: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let method = method(py, key)?;
    let settings = SearchSettings { population, iterations, seed, target_cost: target, ..SearchSettings::default() };
    let bounds = Bounds::new(lower, upper).map_err(|error| misuse(py, &error.to_string()))?;
    let objective = Function { dimension: bounds.dimension(), call: function, raised: Mutex::new(None) };
    let started = Optimizer::start(method, settings, bounds, &objective);
    if let Some(error) = objective.raised().take() {
        return Err(error);
    }
    let mut search = started.map_err(|error| misuse(py, &error.to_string()))?;
    let mut failed = None;
    let mut interrupted = false;
    while search.stop_reason().is_none() && !interrupted {
        search.step(&objective);
        let asked = || -> PyResult<ControlFlow<()>> {
            if let Some(error) = objective.raised().take() {
                return Err(error);
            }
            py.check_signals()?;
            let Some(callback) = &callback else { return Ok(ControlFlow::Continue(())) };
            let best = PyArray1::from_slice(py, search.population().best());
            let is_enough = callback.call1((best, search.population().best_cost()))?.is_truthy()?;
            Ok(if is_enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        };
        match asked() {
            Ok(go_on) => interrupted = go_on.is_break(),
            Err(error) => {
                failed = Some(error);
                break;
            }
        }
    }
    if let Some(error) = failed {
        return Err(error);
    }
    let report = SearchReport {
        best: search.population().best().to_vec(),
        cost: search.population().best_cost(),
        evaluations: search.population().evaluations(),
        stop_reason: search.stop_reason().unwrap_or(StopReason::Interrupted),
        history: search.history().to_vec(),
    };
    found(py, &report)
}

/// What the search's thread says.
enum Said {
    /// These candidates are to be evaluated.
    Ask(Vec<f64>),
    /// The search is over.
    Over(Result<SearchReport, String>),
}

/// An objective whose costs come from elsewhere.
struct Elsewhere {
    dimension: usize,
    ask: Mutex<Sender<Said>>,
    told: Mutex<Receiver<Vec<f64>>>,
}

impl Objective for Elsewhere {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        costs.fill(f64::NAN);
        let ask = self.ask.lock().unwrap_or_else(PoisonError::into_inner);
        if ask.send(Said::Ask(candidates.to_vec())).is_ok()
            && let Ok(told) = self.told.lock().unwrap_or_else(PoisonError::into_inner).recv()
        {
            costs.copy_from_slice(&told);
        }
    }
}

/// A search that is asked for candidates and told their costs. It runs in a thread of its own, which waits in between.
#[pyclass(module = "fluxfit._fluxfit")]
pub(crate) struct AskTell {
    dimension: usize,
    said: Mutex<Receiver<Said>>,
    tell: Option<Sender<Vec<f64>>>,
    thread: Option<JoinHandle<()>>,
    /// What was asked and not yet told.
    open: Option<Vec<f64>>,
    over: Option<Result<SearchReport, String>>,
}

#[pymethods]
impl AskTell {
    #[new]
    fn new(py: Python<'_>, lower: Vec<f64>, upper: Vec<f64>, key: &str, population: usize, iterations: usize, seed: u64) -> PyResult<Self> {
        let method = method(py, key)?;
        let settings = SearchSettings { population, iterations, seed, ..SearchSettings::default() };
        let bounds = Bounds::new(lower, upper).map_err(|error| misuse(py, &error.to_string()))?;
        let dimension = bounds.dimension();
        let (ask, said) = channel();
        let (tell, told) = channel();
        let search = move || {
            let objective = Elsewhere { dimension, ask: Mutex::new(ask.clone()), told: Mutex::new(told) };
            let report = Optimizer::start(method, settings, bounds, &objective).map(|mut search| search.run(&objective));
            // Whoever asked may be gone.
            drop(ask.send(Said::Over(report.map_err(|error| error.to_string()))));
        };
        let thread = std::thread::Builder::new().name("fluxfit-search".to_owned()).spawn(search)?;
        Ok(Self { dimension, said: Mutex::new(said), tell: Some(tell), thread: Some(thread), open: None, over: None })
    }

    /// The next candidates in rows; `None` when the search is over.
    fn ask<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        if self.open.is_none() && self.over.is_none() {
            let said = &self.said;
            match py.detach(|| said.lock().unwrap_or_else(PoisonError::into_inner).recv()) {
                Ok(Said::Ask(candidates)) => self.open = Some(candidates),
                Ok(Said::Over(report)) => self.over = Some(report),
                Err(_) => self.over = Some(Err("the search ended without a result: please report this".to_owned())),
            }
        }
        if let Some(Err(sentence)) = &self.over {
            return Err(misuse(py, sentence));
        }
        let rows =
            |candidates: &Vec<f64>| PyArray1::from_slice(py, candidates).reshape([candidates.len() / self.dimension, self.dimension]);
        self.open.as_ref().map(rows).transpose()
    }

    /// The costs of what was asked.
    fn tell(&mut self, py: Python<'_>, costs: Vec<f64>) -> PyResult<()> {
        let asked = self.open.as_ref().map(|candidates| candidates.len() / self.dimension);
        match asked {
            None => return Err(misuse(py, "nothing was asked; call ask() before tell()")),
            Some(asked) if asked != costs.len() => {
                return Err(misuse(py, &format!("{} costs were told for {asked} candidates; tell one for each row", costs.len())));
            }
            Some(_) => {}
        }
        self.open = None;
        if let Some(tell) = &self.tell {
            // The thread waits for them.
            drop(tell.send(costs));
        }
        Ok(())
    }

    /// What was found; `None` while the search goes on.
    fn result<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        match &self.over {
            Some(Ok(report)) => found(py, report).map(Some),
            _ => Ok(None),
        }
    }
}

impl Drop for AskTell {
    fn drop(&mut self) {
        // Without anybody who tells, the rest of the search costs nothing but its own steps; it is not waited for.
        self.tell = None;
        self.thread = None;
    }
}

//! The swarm's own search, beside the exact answer.

use super::super::{
    prepare::model::Model,
    progress::{Progress, Step},
    request::{Request, Swarm},
};
use crate::{
    error::Error,
    motor::Motor,
    optimizer::{Bounds, Method, Objective, Optimizer, SearchReport},
};

/// What a swarm found, unpolished.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Search {
    /// Its motor.
    pub motor: Motor,
    /// How far its cost lies above the exact minimum.
    pub cost_above_optimum: f64,
    /// Where it searched.
    pub bounds: Bounds,
    /// How the search went.
    pub report: SearchReport,
}

/// The method that searches beside this model's answer, if any.
pub(crate) fn method(request: &Request, model: Model) -> Option<Method> {
    match request.swarm {
        Swarm::Auto => (model == Model::Steady).then(Method::default),
        Swarm::Off => None,
        Swarm::Method(method) => Some(method),
    }
}

/// Runs the method.
///
/// # Errors
/// If the box or the settings do not suit it.
pub(crate) fn run(
    objective: &impl Objective,
    method: Method,
    bounds: &Bounds,
    request: &Request,
    progress: Progress,
) -> Result<SearchReport, Error> {
    let (mut iteration, limit) = (0, request.search.iterations);
    let _ = progress(Step::Search { iteration, limit });
    let mut optimizer = Optimizer::start(method, request.search, bounds.clone(), objective)?;
    Ok(optimizer.run_while(objective, || {
        iteration += 1;
        progress(Step::Search { iteration, limit })
    }))
}

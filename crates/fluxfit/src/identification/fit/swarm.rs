//! The swarm's own search, beside the exact answer.

use super::super::{
    prepare::{model::Model, search_box},
    progress::{Progress, Step},
    request::{Request, Swarm},
};
use crate::{
    error::Error,
    motor::{Motor, PARAMETERS},
    optimizer::{Method, Objective, Optimizer, Report, bounds::Bounds, tgfpa::Tgfpa},
    steady::OperatingPoint,
};

/// What a swarm found, unpolished.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Its motor.
    pub motor: Motor,
    /// How far its cost lies above the exact minimum.
    pub cost_above_optimum: f64,
    /// Where it searched.
    pub bounds: Bounds,
    /// How the search went.
    pub report: Report,
}

/// The method that searches beside this model's answer, if any.
pub(crate) fn method(request: &Request, model: Model) -> Option<Method> {
    match request.swarm {
        Swarm::Auto => (model == Model::Steady).then(|| Method::Tgfpa(Tgfpa::default())),
        Swarm::Off => None,
        Swarm::Method(method) => Some(method),
    }
}

/// The box of the search: what the request states; the rest is what the log allows, or the rating where that is larger. The log's
/// part comes from its operating points as measured at first, else from what stands for them.
///
/// # Errors
/// If a bound is beyond what an optimizer takes.
pub(crate) fn bounds(request: &Request, points: &[OperatingPoint]) -> Result<Bounds, Error> {
    let mut sides: Vec<(f64, f64)> = search_box::from_points(points)?.iter().collect();
    if let Some(rating) = request.nameplate.rating {
        let rated = search_box::from_rating(rating.voltage, rating.current, rating.omega_e)?;
        sides.iter_mut().zip(rated.iter()).for_each(|(side, rated)| side.1 = side.1.max(rated.1));
    }
    let (lower, upper) = (0..PARAMETERS).map(|p| request.bounds[p].unwrap_or(sides[p])).unzip();
    Ok(Bounds::new(lower, upper)?)
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
) -> Result<Report, Error> {
    let (mut iteration, limit) = (0, request.search.iterations);
    let _ = progress(Step::Search { iteration, limit });
    let mut optimizer = Optimizer::start(method, request.search, bounds.clone(), objective)?;
    Ok(optimizer.run_while(objective, || {
        iteration += 1;
        progress(Step::Search { iteration, limit })
    }))
}

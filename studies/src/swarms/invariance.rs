//! What changes a method's run although the problem is the same: where the box lies, the units of the coordinates, a constant added to
//! the cost, and where in the box the optimum is.

use fluxfit::optimizer::{Bounds, Draws, Error, Method, Optimizer, SearchSettings, objective_from, run_many};
use std::ops::ControlFlow;

/// Which changes of the problem change a method's run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sensitivity {
    /// Box and function moved together.
    pub shift: bool,
    /// Each coordinate in another unit.
    pub scale: bool,
    /// A constant added to the cost.
    pub offset: bool,
}

/// A run counts as changed if a candidate differs by this part of the box: rounding drifts far less in so few iterations.
const CHANGED: f64 = 1e-6;

/// Short runs, so that rounding has no time to grow.
const SHORT: SearchSettings = SearchSettings { population: 12, iterations: 8, seed: 1, run: 0, close_to_optimum: None, target_cost: None };

/// The units of the scaled problem; powers of two are exact.
const UNITS: [f64; 3] = [0.25, 1.0, 64.0];

/// Runs a method on a valley that is not separable, in a unit box beside the origin, and on the same one changed.
///
/// # Errors
/// If the method refuses the problem.
pub fn sensitivity(method: Method) -> Result<Sensitivity, Error> {
    let plain = course(method, 0.0, [1.0; 3], 0.0)?;
    let changes = |other: Vec<f64>| other.len() != plain.len() || plain.iter().zip(&other).any(|(a, b)| (a - b).abs() > CHANGED);
    Ok(Sensitivity {
        shift: changes(course(method, 4.0, [1.0; 3], 0.0)?),
        scale: changes(course(method, 0.0, UNITS, 0.0)?),
        offset: changes(course(method, 0.0, [1.0; 3], 4.0)?),
    })
}

/// The candidates at the end of a run, in the unit box.
fn course(method: Method, shift: f64, units: [f64; 3], offset: f64) -> Result<Vec<f64>, Error> {
    let lower = units.map(|unit| unit * (1.0 + shift));
    let inside = |x: &[f64]| -> Vec<f64> { x.iter().zip(&lower).zip(&units).map(|((x, lower), unit)| (x - lower) / unit).collect() };
    let objective = objective_from(units.len(), |x| {
        let z: Vec<f64> = inside(x).iter().map(|z| z - 0.3).collect();
        offset + z.iter().map(|z| z * z).sum::<f64>() + 20.0 * z.iter().sum::<f64>().powi(2)
    });
    let bounds = Bounds::new(lower.to_vec(), lower.iter().zip(&units).map(|(lower, unit)| lower + unit).collect())?;
    let mut optimizer = Optimizer::start(method, SHORT, bounds, &objective)?;
    optimizer.run(&objective);
    Ok(optimizer.population().positions().chunks_exact(units.len()).flat_map(inside).collect())
}

/// Dimensions of the sphere.
const SPHERE: usize = 10;

/// Half the width of its box; optima that are shifted lie within four fifths of it.
const HALF_BOX: f64 = 5.0;

/// Medians over the runs on a sphere: with the optimum in the origin, in the centre of a box beside the origin (0 .. 10), and anywhere.
///
/// # Errors
/// If the method refuses the problem.
pub fn on_spheres(method: Method, runs: usize) -> Result<[f64; 3], Error> {
    let mut draws = Draws::seeded(1, 0);
    let anywhere: Vec<f64> = (0..SPHERE).map(|_| 0.8 * HALF_BOX * (2.0 * draws.uniform() - 1.0)).collect();
    let median = |centre: f64, optimum: &[f64]| -> Result<f64, Error> {
        let bounds = Bounds::new(vec![centre - HALF_BOX; SPHERE], vec![centre + HALF_BOX; SPHERE])?;
        let sphere = objective_from(SPHERE, |x| x.iter().zip(optimum).map(|(x, best)| (x - best).powi(2)).sum());
        let mut costs =
            run_many(method, runs, SearchSettings::default(), &bounds, &sphere, |report| report.cost, || ControlFlow::Continue(()))?;
        costs.sort_by(f64::total_cmp);
        Ok(costs[costs.len() / 2])
    };
    Ok([median(0.0, &[0.0; SPHERE])?, median(HALF_BOX, &[HALF_BOX; SPHERE])?, median(0.0, &anywhere)?])
}

//! A cost that takes long, evaluated on all cores: as an objective that receives whole generations, and by asking and telling.
//!
//! `cargo run --release -p fluxfit-optimize --example evaluate_in_parallel`
#![allow(clippy::print_stdout)] // Printing is what an example is for.

use fluxfit_optimize::{Bounds, Method, Objective, Optimizer, SearchSettings};
use rayon::prelude::*;

/// Stands for a simulation: how far a pendulum with friction swings from where it should be, integrated in small steps.
fn slow_cost(x: &[f64]) -> f64 {
    let (friction, frequency) = (x[0], x[1]);
    let (mut angle, mut speed, mut cost) = (1.0_f64, 0.0, 0.0);
    for step in 1..=2000 {
        let (t, dt) = (f64::from(step) * 0.01, 0.01);
        speed -= dt * (friction * speed + frequency * frequency * angle);
        angle += dt * speed;
        cost += (angle - (-0.1 * t).exp() * (2.0 * t).cos()).powi(2);
    }
    cost
}

/// Receives all candidates of a generation at once.
struct OnAllCores;

impl Objective for OnAllCores {
    fn dimension(&self) -> usize {
        2
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        costs.par_iter_mut().zip(candidates.par_chunks_exact(2)).for_each(|(cost, candidate)| *cost = slow_cost(candidate));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bounds = Bounds::new(vec![0.0, 0.5], vec![1.0, 4.0])?;
    let settings = SearchSettings { population: 16, iterations: 60, ..SearchSettings::default() };
    let method = Method::named("l-shade").unwrap_or_default();
    let report = Optimizer::start(method, settings, bounds.clone(), &OnAllCores)?.run(&OnAllCores);

    // The same search, turned round: the caller has the loop, and may send the candidates wherever it likes.
    let mut search = Optimizer::asking(method, settings, bounds)?;
    loop {
        let candidates = search.ask().to_vec();
        if candidates.is_empty() {
            break;
        }
        let costs: Vec<f64> = candidates.par_chunks_exact(2).map(slow_cost).collect();
        search.tell(&costs)?;
    }
    assert_eq!(search.history(), &report.history[..]);
    println!(
        "friction {:.4}, frequency {:.4}: cost {:.1e} after {} evaluations",
        report.best[0], report.best[1], report.cost, report.evaluations
    );
    Ok(())
}

//! tGFPA on Rosenbrock's valley, saved half way and resumed.
//!
//! `cargo run --release -p fluxfit-optimize --example minimize_any_function`
#![allow(clippy::print_stdout)] // Printing is what an example is for.

use fluxfit_optimize::{Bounds, Method, Optimizer, SearchSettings, methods::tgfpa::Tgfpa, objective_from};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // H. H. Rosenbrock, The Computer Journal 3 (1960) 175: a curved valley with its floor at (1, 1).
    let rosenbrock = objective_from(2, |x| 100.0 * (x[1] - x[0] * x[0]).powi(2) + (1.0 - x[0]).powi(2));
    let bounds = Bounds::new(vec![-2.0, -1.0], vec![2.0, 3.0])?;
    let settings = SearchSettings { iterations: 400, target_cost: Some(1e-12), ..SearchSettings::default() };

    let mut search = Optimizer::start(Method::Tgfpa(Tgfpa::default()), settings, bounds, &rosenbrock)?;
    for _ in 0..100 {
        search.step(&rosenbrock);
    }
    println!("after 100 iterations: {:?} costs {:.1e}", search.population().best(), search.population().best_cost());

    // All of its state is data: a restored search goes on to the same bits.
    let saved = serde_json::to_string(&search)?;
    let mut restored: Optimizer = serde_json::from_str(&saved)?;
    let (report, other) = (search.run(&rosenbrock), restored.run(&rosenbrock));
    assert_eq!(report, other);
    println!("{:?} after {} evaluations: {:?} costs {:.1e}", report.stop_reason, report.evaluations, report.best, report.cost);
    assert!(report.best.iter().all(|x| (x - 1.0).abs() < 1e-4));
    Ok(())
}

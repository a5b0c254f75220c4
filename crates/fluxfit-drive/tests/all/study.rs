//! The comparison of swarms on the output error, on a short simulated log whose truth is known.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    Columns, Log,
    frames::Dq,
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::{VoltageFrame, VoltageTiming},
    optimizer::{Bounds, Draws, Method, Objective, SearchSettings},
    paper,
    study::{
        MethodStudy,
        fitness::{Fitness, StudyProblem},
        run_method, use_lowest_minimum,
    },
};
use fluxfit_drive::{Scenario, simulate};
use rayon::ThreadPoolBuilder;
use std::ops::ControlFlow;

/// The paper's rig with noise, cut to the rows around the step of i_d, where everything moves.
fn log() -> Log {
    let mut scenario = Scenario::paper();
    scenario.sensors.current_noise = 0.05;
    let whole = simulate(&scenario, 0, || ()).unwrap().log().unwrap();
    let step = whole.columns().id.iter().position(|id| *id < -1.0).unwrap();
    let (rows, columns) = (step - 100..step + 200, whole.columns());
    let cut = |column: &[f64]| column[rows.clone()].to_vec();
    Log::new(Columns {
        t: cut(&columns.t),
        ud: cut(&columns.ud),
        uq: cut(&columns.uq),
        id: cut(&columns.id),
        iq: cut(&columns.iq),
        omega_e: cut(&columns.omega_e),
        ..Columns::default()
    })
    .unwrap()
}

fn bounds() -> Bounds {
    Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec()).unwrap()
}

fn study(problem: &mut StudyProblem, runs: usize, iterations: usize) -> Vec<MethodStudy> {
    let settings = SearchSettings { population: 12, iterations, ..SearchSettings::default() };
    let run =
        |method: Method| run_method(method, runs, settings, &bounds(), &problem.fitness, || ControlFlow::Continue(())).unwrap().unwrap();
    let mut studies = paper::METHODS.map(run).to_vec();
    use_lowest_minimum(&mut problem.fitness, &mut studies);
    studies
}

#[test]
fn the_polish_finds_the_motor_and_the_timing_without_a_steady_window() {
    let problem = StudyProblem::output_error(&log(), None).unwrap();
    let Fitness::OutputError { reading, .. } = problem.fitness else { panic!("not the output error") };
    assert_eq!(reading, VoltageTiming::Centered);
    assert!(problem.fitness.has_converged() && problem.unexcited.is_empty());
    // 300 rows of 0.05 A noise: the Cramér-Rao bound is some percent of R_s, less of the others.
    let (motor, cost) = problem.fitness.minimum();
    for (found, truth) in motor.to_array().iter().zip(paper::MOTOR.to_array()) {
        assert!((found / truth - 1.0).abs() < 0.1, "{motor:?}");
    }
    // Two currents of 300 rows, less four parameters and four unknowns of the start, each with the variance that three sensors leave;
    // four standard deviations of that chi square.
    let freedom = 600.0 - 8.0;
    let expected = freedom * 0.05 * 0.05 * 2.0 / 3.0;
    assert!((cost / expected - 1.0).abs() < 4.0 * (2.0_f64 / freedom).sqrt(), "{cost} {expected}");
}

#[test]
fn all_methods_are_finite_above_the_minimum_and_the_same_on_any_number_of_threads() {
    let log = log();
    let on = |threads: usize| {
        ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut problem = StudyProblem::output_error(&log, Some(VoltageTiming::Centered)).unwrap();
            (study(&mut problem, 3, 15), problem)
        })
    };
    let (studies, problem) = on(1);
    for study in &studies {
        assert_eq!(study.evaluations_per_run, 12 * 16);
        assert_eq!(study.convergence.quartiles.len(), 16);
        let quartiles = study.convergence.quartiles.iter().flatten();
        assert!(study.cost_above_optimum.iter().chain(quartiles).all(|above| above.is_finite() && *above >= 0.0), "{study:?}");
        // Run by run the number is the difference of two costs.
        for (motor, above) in study.motors.iter().zip(&study.cost_above_optimum) {
            let mut cost = [0.0];
            problem.fitness.evaluate(&motor.to_array(), &mut cost);
            let (_, lowest) = problem.fitness.minimum();
            assert!((cost[0] - lowest - above).abs() <= 1e-12 * cost[0], "{} {lowest} {above}", cost[0]);
        }
    }
    assert_eq!(on(4), (studies, problem));
}

/// A polish that stopped short: the swarm's end lies below it, is polished, and everything counts from there.
#[test]
fn a_swarm_that_finds_less_than_the_polish_moves_the_minimum() {
    let mut problem = StudyProblem::output_error(&log(), Some(VoltageTiming::Centered)).unwrap();
    let (motor, lowest) = problem.fitness.minimum();
    if let Fitness::OutputError { minimum, .. } = &mut problem.fitness {
        minimum.drive.motor = Motor { rs: 3.0, ..motor };
        minimum.cost = lowest + 50.0;
    }
    let studies = study(&mut problem, 2, 150);
    let (found, cost) = problem.fitness.minimum();
    assert!((cost / lowest - 1.0).abs() < 1e-9 && (found.rs / motor.rs - 1.0).abs() < 1e-4, "{found:?} {cost} {lowest}");
    let best = studies.iter().flat_map(|study| &study.cost_above_optimum).copied().fold(f64::INFINITY, f64::min);
    assert!((0.0..50.0).contains(&best), "{best}");
}

/// The paper's box begins at no resistance, no inductance, no flux: none of its corners may stop a search or win it.
#[test]
fn no_corner_of_the_papers_box_beats_the_minimum() {
    let problem = StudyProblem::output_error(&log(), Some(VoltageTiming::Centered)).unwrap();
    let (_, lowest) = problem.fitness.minimum();
    for corner in 0..1 << PARAMETERS {
        for nearly_zero in [0.0, 5e-324, 1e-300, 1e-30, 1e-9] {
            let motor: Vec<f64> =
                paper::SEARCH_BOX.iter().enumerate().map(|(p, upper)| if corner >> p & 1 == 0 { nearly_zero } else { *upper }).collect();
            let mut cost = [0.0];
            problem.fitness.evaluate(&motor, &mut cost);
            assert!(!cost[0].is_finite() || cost[0] > lowest, "{motor:?}: {}", cost[0]);
            let no_inductance = motor[1] == 0.0 || motor[2] == 0.0;
            assert!(!(no_inductance && cost[0].is_finite()), "{motor:?}: {}", cost[0]);
        }
    }
}

/// At i_d = 0, steady, the equations hold no L_d; what its noise-free transients would tell drowns in coarse currents.
#[test]
fn a_steady_log_without_d_current_does_not_tell_ld() {
    let mut draws = Draws::seeded(1, 0);
    let mut columns = Columns::default();
    for k in 0..400_u32 {
        // Two speeds, in two segments.
        let (omega_e, gap) = if k < 200 { (400.0, 0.0) } else { (200.0, 1.0) };
        let u = paper::MOTOR.steady_voltage(Dq { d: 0.0, q: 9.0 }, omega_e);
        let row = [1e-4 * f64::from(k) + gap, u.d, u.q, 0.3 * draws.normal(), 9.0 + 0.3 * draws.normal(), omega_e];
        let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
        [t, ud, uq, id, iq, omega_e].into_iter().zip(row).for_each(|(column, value)| column.push(value));
    }
    let reading = VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Middle };
    let problem = StudyProblem::output_error(&Log::new(columns).unwrap(), Some(reading)).unwrap();
    assert_eq!(problem.rows, [200, 200]);
    assert_eq!(problem.unexcited, [Parameter::Ld], "{:?}", problem.fitness.minimum());
}

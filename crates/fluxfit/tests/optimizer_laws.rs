//! What holds for every method, seed, box and objective.
#![allow(clippy::unwrap_used)]

use fluxfit::error::Error;
use fluxfit::optimizer::bounds::Bounds;
use fluxfit::optimizer::draws::Draws;
use fluxfit::optimizer::fpa::Fpa;
use fluxfit::optimizer::tgfpa::{Start, Tgfpa};
use fluxfit::optimizer::{CloseTo, Method, Objective, Optimizer, Settings, StopReason, objective_from};
use proptest::prelude::*;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU64, Ordering};

/// A search to make: everything but the objective's values.
#[derive(Debug, Clone)]
struct Search {
    method: Method,
    settings: Settings,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Whether the objective is NaN or infinite in part of the box.
    holes: bool,
}

impl Search {
    fn bounds(&self) -> Bounds {
        Bounds::new(self.lower.clone(), self.upper.clone()).unwrap()
    }

    fn objective(&self) -> impl Objective {
        let Self { lower, upper, holes, .. } = self.clone();
        objective_from(lower.len(), move |x| {
            let z: Vec<f64> = (0..x.len()).map(|d| (x[d] - lower[d]) / (upper[d] - lower[d])).collect();
            valley(&z, holes)
        })
    }

    /// `None` where the whole start fell into holes.
    fn start(&self) -> Option<Optimizer> {
        Optimizer::start(self.method, self.settings, self.bounds(), &self.objective()).ok()
    }
}

/// Not separable, lowest near 0.3 in each coordinate of the unit box; with holes at its sides, of every kind of number that is not finite.
fn valley(z: &[f64], holes: bool) -> f64 {
    let (first, last) = (z[0], z[z.len() - 1]);
    match () {
        () if holes && first > 0.85 => f64::NAN,
        () if holes && first > 0.75 => f64::NEG_INFINITY,
        () if holes && last < 0.1 => f64::INFINITY,
        () => {
            let squares: f64 = z.iter().map(|z| (z - 0.3) * (z - 0.3)).sum();
            let sum: f64 = z.iter().map(|z| z - 0.3).sum();
            squares + 20.0 * sum * sum
        }
    }
}

/// The whole state as text. Two states with the same text have the same bits: each number is written so that it reads back exactly.
fn bits(optimizer: &Optimizer) -> String {
    serde_json::to_string(optimizer).unwrap()
}

fn steps(optimizer: &mut Optimizer, objective: &impl Objective, count: usize) {
    for _ in 0..count {
        optimizer.step(objective);
    }
}

/// Of all methods, and tGFPA with the other start, those wanted.
fn methods_that(wanted: impl Fn(&Method) -> bool) -> Vec<Method> {
    let uniform = Method::Tgfpa(Tgfpa { start: Start::Uniform, ..Tgfpa::default() });
    Method::all().into_iter().chain([uniform]).filter(wanted).collect()
}

fn settings() -> impl Strategy<Value = Settings> {
    (4usize..12, 0usize..20, any::<u64>(), any::<u64>()).prop_map(|(population, iterations, seed, run)| Settings {
        population,
        iterations,
        seed,
        run,
        ..Settings::default()
    })
}

fn searches(exponents: Range<f64>) -> impl Strategy<Value = Search> {
    searches_by(methods_that(|_| true), exponents)
}

/// Boxes of one to four dimensions whose widths are `10^exponents`, at most three widths from zero.
fn searches_by(methods: Vec<Method>, exponents: Range<f64>) -> impl Strategy<Value = Search> {
    let sides = prop::collection::vec((exponents, -3.0..3.0f64), 1..5);
    (prop::sample::select(methods), settings(), sides, any::<bool>()).prop_map(|(method, settings, sides, holes)| {
        let width = |exponent: f64| 10f64.powf(exponent);
        Search {
            method,
            settings,
            lower: sides.iter().map(|&(exponent, offset)| width(exponent) * offset).collect(),
            upper: sides.iter().map(|&(exponent, offset)| width(exponent) * (offset + 1.0)).collect(),
            holes,
        }
    })
}

proptest! {
    // Seeds of failures are printed; no file of them is kept beside the tests.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn running_is_stepping_and_may_pause_anywhere(search in searches(-6.0..6.0), pause in 0usize..20) {
        let (objective, limit) = (search.objective(), search.settings.iterations);
        let started = search.start();
        prop_assume!(started.is_some());
        let started = started.unwrap();

        let mut run = started.clone();
        let report = run.run(&objective);

        let mut stepped = started.clone();
        steps(&mut stepped, &objective, limit);
        prop_assert_eq!(bits(&stepped), bits(&run));
        prop_assert_eq!(stepped.population(), run.population());
        prop_assert_eq!(stepped.history(), &report.history[..]);

        let mut paused = started;
        steps(&mut paused, &objective, pause.min(limit));
        prop_assert_eq!(paused.run(&objective), report.clone());
        prop_assert_eq!(bits(&paused), bits(&run));

        // A search that has ended stays where it is.
        prop_assert_eq!(run.run(&objective), report);
        prop_assert_eq!(bits(&paused), bits(&run));
    }

    #[test]
    fn a_lower_limit_cuts_the_course_short(
        // Not of LPSO, whose inertia weight is laid out over the limit.
        search in searches_by(methods_that(|method| !matches!(method, Method::Lpso(_))), -6.0..6.0),
        lower in 0usize..20,
    ) {
        let lower = lower.min(search.settings.iterations);
        let shorter = Search { settings: Settings { iterations: lower, ..search.settings }, ..search.clone() };
        let (Some(mut long), Some(mut short)) = (search.start(), shorter.start()) else { return Err(TestCaseError::reject("holes")) };
        let (long, short) = (long.run(&search.objective()), short.run(&search.objective()));
        prop_assert_eq!(&short.history[..], &long.history[..=lower]);
    }

    #[test]
    fn a_restored_search_goes_on_to_the_same_bits(search in searches(-6.0..6.0), pause in 0usize..20) {
        let objective = search.objective();
        // All four on the same box, not only the one drawn.
        for method in Method::all() {
            let search = Search { method, ..search.clone() };
            let Some(mut uninterrupted) = search.start() else { continue };
            let mut saved = uninterrupted.clone();
            let limit = search.settings.iterations;
            steps(&mut uninterrupted, &objective, limit);

            steps(&mut saved, &objective, pause.min(limit));
            let text = bits(&saved);
            drop(saved);
            let mut restored: Optimizer = serde_json::from_str(&text).unwrap();
            prop_assert_eq!(bits(&restored), text);
            steps(&mut restored, &objective, limit - pause.min(limit));
            prop_assert_eq!(restored.population(), uninterrupted.population());
            prop_assert_eq!(restored.history(), uninterrupted.history());
            prop_assert_eq!(bits(&restored), bits(&uninterrupted));
        }
    }

    #[test]
    fn positions_stay_in_the_box_and_the_best_never_gets_worse(search in searches(-140.0..140.0)) {
        let (objective, bounds, size) = (search.objective(), search.bounds(), search.settings.population);
        let started = search.start();
        prop_assume!(started.is_some());
        let mut optimizer = started.unwrap();
        let mut before = f64::INFINITY;
        for iteration in 0..=search.settings.iterations {
            let population = optimizer.population();
            prop_assert_eq!(population.len(), size);
            for position in population.positions().chunks_exact(bounds.dimension()).chain([population.best()]) {
                prop_assert!(bounds.contains(position) && position.iter().all(|x| x.is_finite()), "{position:?}");
            }
            prop_assert!(population.costs().iter().all(|cost| cost.is_finite() && *cost >= population.best_cost()));
            prop_assert!(population.best_cost() <= before);
            before = population.best_cost();
            let mut best_again = [0.0];
            objective.evaluate(population.best(), &mut best_again);
            prop_assert_eq!(best_again[0], population.best_cost());
            prop_assert_eq!(population.evaluations(), (size * (1 + iteration)) as u64);

            let record = optimizer.history().last().unwrap();
            prop_assert_eq!((record.iteration, record.evaluations), (iteration, population.evaluations()));
            prop_assert_eq!((record.cost, &record.best[..]), (population.best_cost(), population.best()));
            prop_assert_eq!(optimizer.history().len(), 1 + iteration);
            optimizer.step(&objective);
        }
    }

    #[test]
    fn no_flower_gets_worse(
        search in searches_by(methods_that(|method| matches!(method, Method::Tgfpa(_) | Method::Fpa(_))), -6.0..6.0),
    ) {
        let objective = search.objective();
        let started = search.start();
        prop_assume!(started.is_some());
        let mut optimizer = started.unwrap();
        for _ in 0..search.settings.iterations {
            let before = optimizer.population().clone();
            optimizer.step(&objective);
            let after = optimizer.population();
            let d = search.lower.len();
            for i in 0..before.len() {
                prop_assert!(after.costs()[i] <= before.costs()[i]);
                // A trial that is only as good is not taken.
                let row = i * d..(i + 1) * d;
                if after.costs()[i] == before.costs()[i] {
                    prop_assert_eq!(&after.positions()[row.clone()], &before.positions()[row]);
                }
            }
        }
    }

    /// Powers of two change exponents only, so that equality is exact; a step that forgets a width, or uses another dimension's, is not.
    #[test]
    fn scaling_the_box_scales_the_course(
        search in searches(-3.0..3.0),
        exponents in prop::collection::vec(-40i32..40, 4),
    ) {
        let scales: Vec<f64> = exponents.iter().map(|&exponent| 2f64.powi(exponent)).collect();
        let scaled = |row: &[f64]| -> Vec<f64> { row.iter().zip(scales.iter().cycle()).map(|(x, scale)| x * scale).collect() };
        let d = search.lower.len();
        let stretched = Search { lower: scaled(&search.lower), upper: scaled(&search.upper), ..search.clone() };
        let (Some(mut plain), Some(mut wide)) = (search.start(), stretched.start()) else { return Err(TestCaseError::reject("holes")) };
        for _ in 0..=search.settings.iterations {
            let (a, b) = (plain.population(), wide.population());
            prop_assert_eq!(a.costs(), b.costs());
            prop_assert_eq!(a.best_cost(), b.best_cost());
            prop_assert_eq!(scaled(a.best()), b.best());
            for (a, b) in a.positions().chunks_exact(d).zip(b.positions().chunks_exact(d)) {
                prop_assert_eq!(scaled(a), b);
            }
            plain.step(&search.objective());
            wide.step(&stretched.objective());
        }
    }

    /// tGFPA asks for one number more per flower (that of m or q); with that one put in, it makes FPA's moves.
    #[test]
    fn tgfpa_without_perturbations_is_fpa(search in searches(-3.0..3.0), switch_probability in 0.2..0.9f64) {
        let (d, n, objective) = (search.lower.len(), search.settings.population, search.objective());
        let pollination = Fpa { switch_probability, ..Fpa::default() };
        let plain = Tgfpa { pollination, plain_global: 1.0, plain_local: 1.0, start: Start::Uniform };

        let mut source = Draws::seeded(search.settings.seed, search.settings.run);
        let mut for_fpa: Vec<f64> = (0..n * d).map(|_| source.uniform()).collect();
        let mut for_tgfpa = for_fpa.clone();
        for flower in 0..n * search.settings.iterations {
            let rand = source.uniform();
            let moves: Vec<f64> = if rand > switch_probability {
                (0..2 * d).map(|_| source.normal()).collect()
            } else {
                let epsilon = source.uniform();
                let [j, k] = source.partners(flower % n, n);
                vec![epsilon, j as f64, k as f64]
            };
            for_fpa.push(rand);
            for_fpa.extend(&moves);
            for_tgfpa.extend([rand, source.uniform()]);
            for_tgfpa.extend(&moves);
        }

        let start = |method, draws| Optimizer::start_from(method, search.settings, search.bounds(), Draws::replay(draws), &objective);
        let (fpa, tgfpa) = (start(Method::Fpa(pollination), for_fpa), start(Method::Tgfpa(plain), for_tgfpa));
        prop_assume!(fpa.is_ok());
        let (mut fpa, mut tgfpa) = (fpa.unwrap(), tgfpa.unwrap());
        prop_assert_eq!(fpa.run(&objective), tgfpa.run(&objective));
        prop_assert_eq!(fpa.population(), tgfpa.population());
    }
}

/// Replayed numbers cannot show which distribution was asked for: T(t) must have as many degrees of freedom as the iteration, from 1.
#[test]
fn the_t_perturbation_follows_the_iteration() {
    // Each cost lower than all before: every trial is taken, so that the positions show the moves.
    let evaluations = AtomicU64::new(0);
    let objective = objective_from(2, |_| -(evaluations.fetch_add(1, Ordering::Relaxed) as f64));
    // Only global moves, none of them along the Lévy step, all of them perturbed.
    let pollination = Fpa { switch_probability: 0.0, gamma: 0.0, ..Fpa::default() };
    let method = Method::Tgfpa(Tgfpa { pollination, plain_global: 0.0, plain_local: 0.0, start: Start::Uniform });
    let bounds = Bounds::new(vec![-1.0, 3.0], vec![1.0, 7.0]).unwrap();
    let settings = Settings { population: 5, ..Settings::default() };
    let (d, n) = (2, settings.population);

    let mut draws = Draws::seeded(settings.seed, settings.run);
    let mut optimizer = Optimizer::start(method, settings, bounds.clone(), &objective).unwrap();
    for _ in 0..n * d {
        draws.uniform();
    }
    for iteration in 1..=10 {
        let before = optimizer.population().positions().to_vec();
        optimizer.step(&objective);
        for (i, after) in optimizer.population().positions().chunks_exact(d).enumerate() {
            // rand of p, rand of m, and the Lévy step's u and v per dimension, which gamma = 0 makes idle.
            draws.uniform();
            draws.uniform();
            for _ in 0..2 * d {
                draws.normal();
            }
            let t = draws.student_t(iteration);
            let [j, k] = draws.partners(i, n);
            let mut expected: Vec<f64> = (0..d).map(|c| before[i * d + c] + t * (before[j * d + c] - before[k * d + c])).collect();
            bounds.clamp(&mut expected);
            assert_eq!(after, expected, "iteration {iteration}, flower {i}");
        }
    }
}

/// The map's peak is 1, and `lower + (upper - lower)` may be rounded to above `upper`.
#[test]
fn the_chaotic_start_stays_in_the_box_at_the_maps_peak() {
    // sin²(pi/8): the map goes on to 1/2 and 1.
    let draws = Draws::replay(vec![0.146_446_609_406_726_24]);
    let bounds = Bounds::new(vec![-0.3], vec![0.47]).unwrap();
    let settings = Settings { population: 4, ..Settings::default() };
    let objective = objective_from(1, |x| x[0]);
    let optimizer = Optimizer::start_from(Method::Tgfpa(Tgfpa::default()), settings, bounds.clone(), draws, &objective).unwrap();
    let peak = optimizer.population().positions()[2];
    assert!((peak - 0.47).abs() < 1e-12, "{peak}");
    assert!(bounds.contains(&[peak]), "{peak}");
}

fn bowl() -> impl Objective {
    objective_from(2, |x| 0.5 + x[0] * x[0] + (x[1] - 1.0) * (x[1] - 1.0))
}

fn bowl_box() -> Bounds {
    Bounds::new(vec![-2.0; 2], vec![2.0; 2]).unwrap()
}

#[test]
fn the_target_cost_stops_as_soon_as_it_is_reached() {
    for method in Method::all() {
        let target = 0.51;
        let settings = Settings { target_cost: Some(target), ..Settings::default() };
        let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
        assert_eq!(report.stop_reason, StopReason::TargetCost, "{}", method.label());
        assert!(report.cost <= target);
        let (last, before) = report.history.split_last().unwrap();
        assert!(last.iteration < settings.iterations);
        assert!(before.iter().all(|record| record.cost > target), "{}", method.label());
    }
}

#[test]
fn closeness_to_the_optimum_stops_as_soon_as_it_is_reached() {
    for method in Method::all() {
        let close = CloseTo { optimum: 0.5, tolerance: 1e-2 };
        let settings = Settings { close_to_optimum: Some(close), ..Settings::default() };
        let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
        assert_eq!(report.stop_reason, StopReason::CloseToOptimum, "{}", method.label());
        assert!(report.cost - close.optimum <= close.tolerance);
        let (last, before) = report.history.split_last().unwrap();
        assert!(last.iteration < settings.iterations);
        assert!(before.iter().all(|record| record.cost - close.optimum > close.tolerance), "{}", method.label());
    }
}

#[test]
fn what_is_interrupted_and_run_on_ends_at_the_same_bits() {
    for method in Method::all() {
        let start = || Optimizer::start(method, Settings { iterations: 20, ..Settings::default() }, bowl_box(), &bowl()).unwrap();
        let mut optimizer = start();
        let mut asked = 0;
        let cut = optimizer.run_while(&bowl(), || {
            asked += 1;
            if asked == 7 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!((cut.stop_reason, cut.history.len()), (StopReason::Interrupted, 8), "{}", method.label());
        assert_eq!(optimizer.run(&bowl()), start().run(&bowl()), "{}", method.label());
        // A criterion that holds at the same time is the reason.
        let last = Optimizer::start(method, Settings { iterations: 1, ..Settings::default() }, bowl_box(), &bowl())
            .unwrap()
            .run_while(&bowl(), || ControlFlow::Break(()));
        assert_eq!(last.stop_reason, StopReason::IterationLimit, "{}", method.label());
    }
}

#[test]
fn the_iteration_limit_stops_otherwise() {
    for method in Method::all() {
        for iterations in [0, 1, 7] {
            // Neither criterion can be met.
            let close_to_optimum = Some(CloseTo { optimum: 0.0, tolerance: 0.0 });
            let settings = Settings { iterations, target_cost: Some(0.0), close_to_optimum, ..Settings::default() };
            let report = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap().run(&bowl());
            assert_eq!(report.stop_reason, StopReason::IterationLimit, "{}", method.label());
            assert_eq!(report.history.len(), 1 + iterations);
            assert_eq!(report.evaluations, (settings.population * (1 + iterations)) as u64);
        }
    }
}

#[test]
fn a_population_too_small_for_the_method_is_an_error() {
    for (method, least) in Method::all().into_iter().zip([4, 3, 1, 1]) {
        let start = |population| {
            let settings = Settings { population, iterations: 5, ..Settings::default() };
            Optimizer::start(method, settings, bowl_box(), &bowl())
        };
        let given = least - 1;
        assert_eq!(start(given).unwrap_err(), Error::Population { method: method.label(), given, least });
        // The least works, and not only to start.
        start(least).unwrap().run(&bowl());
    }
}

#[test]
fn a_box_of_another_dimension_is_an_error() {
    for method in Method::all() {
        let bounds = Bounds::new(vec![0.0; 3], vec![1.0; 3]).unwrap();
        let error = Optimizer::start(method, Settings::default(), bounds, &bowl()).unwrap_err();
        assert_eq!(error, Error::Dimension { bounds: 3, objective: 2 });
    }
}

#[test]
fn a_box_without_intervals_is_an_error() {
    let second = |lower: f64, upper: f64| Bounds::new(vec![0.0, lower], vec![1.0, upper]).unwrap_err();
    let wrong = [
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (f64::NAN, f64::NAN),
        (f64::NEG_INFINITY, 0.0),
        (0.0, f64::INFINITY),
        (2.0, 1.0),
        (1.0, 1.0),
        // Finite bounds, but steps that would not be.
        (-f64::MAX, f64::MAX),
    ];
    for (lower, upper) in wrong {
        assert!(matches!(second(lower, upper), Error::Bounds { dimension: 1, .. }), "{lower} {upper}");
    }
    assert_eq!(second(2.0, 1.0), Error::Bounds { dimension: 1, lower: 2.0, upper: 1.0 });
    assert_eq!(Bounds::new(vec![], vec![]), Err(Error::BoundsShape { lower: 0, upper: 0 }));
    assert_eq!(Bounds::new(vec![0.0; 2], vec![1.0]), Err(Error::BoundsShape { lower: 2, upper: 1 }));
}

#[test]
fn an_objective_without_any_finite_cost_is_an_error() {
    for method in Method::all() {
        for cost in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let objective = objective_from(2, |_| cost);
            let error = Optimizer::start(method, Settings::default(), bowl_box(), &objective).unwrap_err();
            assert_eq!(error, Error::NonFiniteStart { population: 50 });
        }
    }
}

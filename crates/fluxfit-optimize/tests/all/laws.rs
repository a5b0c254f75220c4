//! What holds for every method, seed, box and objective.

use crate::golden::obeys;
use fluxfit_optimize::{
    Bounds, Method, Objective, Optimizer, SearchSettings,
    methods::tgfpa::{Start, Tgfpa},
    objective_from,
};
use proptest::prelude::*;
use std::ops::Range;

/// A search to make: everything but the objective's values.
#[derive(Debug, Clone)]
struct Search {
    method: Method,
    settings: SearchSettings,
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

fn settings() -> impl Strategy<Value = SearchSettings> {
    (5usize..14, 0usize..20, any::<u64>(), any::<u64>()).prop_map(|(population, iterations, seed, run)| SearchSettings {
        population,
        iterations,
        seed,
        run,
        ..SearchSettings::default()
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
        // Not of methods that lay something out over the limit, as LPSO its inertia weight.
        search in searches_by(methods_that(|method| obeys(method, "limit")), -6.0..6.0),
        lower in 0usize..20,
    ) {
        let lower = lower.min(search.settings.iterations);
        let shorter = Search { settings: SearchSettings { iterations: lower, ..search.settings }, ..search.clone() };
        let (Some(mut long), Some(mut short)) = (search.start(), shorter.start()) else { return Err(TestCaseError::reject("holes")) };
        let (long, short) = (long.run(&search.objective()), short.run(&search.objective()));
        prop_assert_eq!(&short.history[..], &long.history[..=lower]);
    }

    #[test]
    fn a_restored_search_goes_on_to_the_same_bits(search in searches(-6.0..6.0), pause in 0usize..20) {
        let objective = search.objective();
        // All of them on the same box, not only the one drawn.
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
            prop_assert_eq!(population.positions().len(), population.len() * bounds.dimension());
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
    fn no_candidate_of_a_greedy_method_gets_worse(
        search in searches_by(methods_that(|method| obeys(method, "greedy")), -6.0..6.0),
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
                if after.costs()[i] == before.costs()[i] && obeys(&search.method, "strict") {
                    prop_assert_eq!(&after.positions()[row.clone()], &before.positions()[row]);
                }
            }
        }
    }

    /// Powers of two change exponents only, so that equality is exact; a step that forgets a width, or uses another dimension's, is not.
    #[test]
    fn scaling_the_box_scales_the_course(
        search in searches_by(methods_that(|method| obeys(method, "scale")), -3.0..3.0),
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
}

/// How far two courses drift apart, in widths of the box: of the same method, on a valley and on one that is changed by `shift` (of box
/// and function) or `offset` (of the costs).
fn drift(method: Method, shift: f64, offset: f64) -> f64 {
    let course = |shift: f64, offset: f64, seed: u64| {
        let settings = SearchSettings { population: 12, iterations: 8, seed, ..SearchSettings::default() };
        let bounds = Bounds::new(vec![1.0 + shift; 3], vec![2.0 + shift; 3]).unwrap();
        let objective = objective_from(3, move |x| offset + valley(&x.iter().map(|x| x - 1.0 - shift).collect::<Vec<_>>(), false));
        let mut optimizer = Optimizer::start(method, settings, bounds, &objective).unwrap();
        optimizer.run(&objective);
        optimizer.population().positions().iter().map(|x| x - shift).collect::<Vec<f64>>()
    };
    let drifts = (0..5).map(|seed| {
        let (plain, changed) = (course(0.0, 0.0, seed), course(shift, offset, seed));
        if plain.len() == changed.len() { plain.iter().zip(&changed).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) } else { 1.0 }
    });
    drifts.fold(0.0, f64::max)
}

/// Rounding drifts far less than 1e-6 in eight iterations; an origin, a bound or a cost that takes part in a move, far more than 1e-3.
/// That the methods of which it is known do fail says that the test would find it out of the others.
#[test]
fn shifts_and_offsets_change_the_courses_of_those_methods_whose_formulas_say_so() {
    for method in Method::all() {
        for (law, shift, offset) in [("shift", 5.0, 0.0), ("offset", 0.0, 3.0)] {
            let drift = drift(method, shift, offset);
            let holds = obeys(&method, law);
            assert!(if holds { drift < 1e-6 } else { drift > 1e-3 }, "{} {law}: {drift}, expected to hold: {holds}", method.key());
        }
    }
}

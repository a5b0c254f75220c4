//! What is refused, and with which error.

use crate::{bowl, bowl_box};
use fluxfit_optimize::{
    Bounds, Error, Method, Optimizer, SearchSettings,
    methods::{apso::Apso, fpa::Fpa, lpso::Lpso, particles::Flight, tgfpa::Tgfpa},
    objective_from, run_many,
};

#[test]
fn a_population_too_small_for_the_method_is_an_error() {
    for method in Method::all() {
        let least = method.facts().smallest_population;
        let start = |population| {
            let settings = SearchSettings { population, iterations: 5, ..SearchSettings::default() };
            Optimizer::start(method, settings, bowl_box(), &bowl())
        };
        let given = least - 1;
        assert_eq!(start(given).unwrap_err(), Error::Population { method: method.label(), given, least });
        // The least works, and not only to start.
        start(least).unwrap().run(&bowl());
    }
}

#[test]
fn a_population_that_no_machine_holds_is_an_error() {
    for method in Method::all() {
        for population in [1_000_001, usize::MAX] {
            let settings = SearchSettings { population, ..SearchSettings::default() };
            let error = Optimizer::start(method, settings, bowl_box(), &bowl()).unwrap_err();
            assert!(matches!(error, Error::Limit { setting: "the population", .. }), "{error}");
        }
    }
}

#[test]
fn more_iterations_runs_or_evaluations_than_a_machine_has_time_for_are_an_error() {
    let start = |population, iterations| {
        let settings = SearchSettings { population, iterations, ..SearchSettings::default() };
        Optimizer::start(Method::Fpa(Fpa::DEFAULT), settings, bowl_box(), &bowl()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(start(50, 1_000_000), Ok(()));
    let sentence = "the number of iterations is 1000001; it must be at most 1000000, so that their history fits into memory";
    assert_eq!(start(50, 1_000_001), Err(sentence.to_owned()));
    assert!(start(50, usize::MAX).is_err());
    // 1e5 (1e5 + 1) evaluations are more than 1e10.
    assert_eq!(start(100_000, 99_999), Ok(()));
    assert!(start(100_000, 100_000).unwrap_err().contains("evaluations"));
    for runs in [1_000_000_000, usize::MAX] {
        let begun = || std::ops::ControlFlow::Break(());
        let error = run_many(Method::Fpa(Fpa::DEFAULT), runs, SearchSettings::default(), &bowl_box(), &bowl(), |_| (), begun).unwrap_err();
        assert!(matches!(error, Error::Limit { most: 1e10, .. }), "{error}");
    }
}

#[test]
fn a_setting_out_of_range_is_an_error() {
    let wrong: [(&str, Method); 10] = [
        ("switch_probability", Method::Fpa(Fpa { switch_probability: 1.5, ..Fpa::DEFAULT })),
        (
            "switch_probability",
            Method::Tgfpa(Tgfpa { pollination: Fpa { switch_probability: f64::NAN, ..Fpa::DEFAULT }, ..Tgfpa::DEFAULT }),
        ),
        ("gamma", Method::Fpa(Fpa { gamma: f64::INFINITY, ..Fpa::DEFAULT })),
        ("plain_global", Method::Tgfpa(Tgfpa { plain_global: -0.1, ..Tgfpa::DEFAULT })),
        ("plain_local", Method::Tgfpa(Tgfpa { plain_local: f64::NAN, ..Tgfpa::DEFAULT })),
        ("velocity_limit", Method::Lpso(Lpso { flight: Flight { velocity_limit: -0.1, ..Flight::DEFAULT }, ..Lpso::DEFAULT })),
        ("velocity_limit", Method::Apso(Apso { flight: Flight { velocity_limit: f64::NAN, ..Flight::DEFAULT }, ..Apso::DEFAULT })),
        ("cognitive", Method::Lpso(Lpso { flight: Flight { cognitive: f64::INFINITY, ..Flight::DEFAULT }, ..Lpso::DEFAULT })),
        ("inertia_end", Method::Lpso(Lpso { inertia_end: f64::NAN, ..Lpso::DEFAULT })),
        ("inertia_max", Method::Apso(Apso { inertia_max: 1e200, ..Apso::DEFAULT })),
    ];
    for (name, method) in wrong {
        let error = Optimizer::start(method, SearchSettings::default(), bowl_box(), &bowl()).unwrap_err();
        assert!(matches!(error, Error::Setting { setting, .. } if setting == name), "{name}: {error}");
    }
}

#[test]
fn a_box_of_another_dimension_is_an_error() {
    for method in Method::all() {
        let bounds = Bounds::new(vec![0.0; 3], vec![1.0; 3]).unwrap();
        let error = Optimizer::start(method, SearchSettings::default(), bounds, &bowl()).unwrap_err();
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
            let error = Optimizer::start(method, SearchSettings::default(), bowl_box(), &objective).unwrap_err();
            assert_eq!(error, Error::NonFiniteStart { population: 50 });
        }
    }
}

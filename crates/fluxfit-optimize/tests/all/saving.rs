//! A damaged save is refused; it never makes a step fail. That an undamaged one goes on to the same bits is a law.

use crate::{bowl, bowl_box};
use fluxfit_optimize::{Bounds, Method, Optimizer, SearchSettings};
use serde_json::{Value, json};

/// A search with each method, some iterations on, as it is saved.
fn saves() -> impl Iterator<Item = Value> {
    Method::all().into_iter().map(|method| {
        let mut optimizer = Optimizer::start(method, SearchSettings::default(), bowl_box(), &bowl()).unwrap();
        optimizer.step(&bowl());
        serde_json::to_value(&optimizer).unwrap()
    })
}

/// Every array of numbers in a save, by its path.
fn arrays(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Array(items) if items.first().is_some_and(Value::is_number) => found.push(path.to_owned()),
        Value::Array(items) => items.iter().enumerate().for_each(|(k, item)| arrays(&format!("{path}/{k}"), item, found)),
        Value::Object(fields) => fields.iter().for_each(|(name, field)| arrays(&format!("{path}/{name}"), field, found)),
        _ => {}
    }
}

#[test]
fn parts_of_other_sizes_are_refused() {
    for saved in saves() {
        assert!(serde_json::from_value::<Optimizer>(saved.clone()).is_ok());
        let mut paths = Vec::new();
        ["population", "state", "bounds"].iter().for_each(|part| arrays(&format!("/{part}"), &saved[part], &mut paths));
        assert!(paths.len() >= 7, "{paths:?}");
        for path in paths {
            let mut damaged = saved.clone();
            damaged.pointer_mut(&path).unwrap().as_array_mut().unwrap().pop();
            assert!(serde_json::from_value::<Optimizer>(damaged).is_err(), "{path}");
        }
        let mut damaged = saved;
        damaged["population"]["dimension"] = json!(3);
        assert!(serde_json::from_value::<Optimizer>(damaged).is_err());
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let mut refused = 0;
    for text in saves().map(|saved| saved.to_string()) {
        // A setting of the swarms, and one of the flowers.
        for (sound, wrong) in [("\"velocity_limit\":0.1", "\"velocity_limit\":-1.0"), ("\"gamma\":0.1", "\"gamma\":1e300")] {
            if text.contains(sound) {
                assert!(serde_json::from_str::<Optimizer>(&text.replace(sound, wrong)).is_err());
                refused += 1;
            }
        }
    }
    assert!(refused >= 4, "{refused}");
}

/// No method steps a population that is smaller than the one it needs.
#[test]
fn a_population_smaller_than_the_methods_is_refused() {
    for mut saved in saves() {
        let key = saved["state"].as_object().unwrap().keys().next().unwrap().clone();
        let least = Method::named(&key).unwrap().facts().smallest_population;
        for (part, numbers) in [("positions", 2 * (least - 1)), ("costs", least - 1)] {
            saved["population"][part].as_array_mut().unwrap().truncate(numbers);
        }
        assert!(serde_json::from_value::<Optimizer>(saved).is_err());
    }
}

/// A save that asks for more than any search may is refused too.
#[test]
fn settings_of_the_search_are_checked_when_they_are_read() {
    for mut saved in saves() {
        saved["settings"]["population"] = json!(1_000_001);
        assert!(serde_json::from_value::<Optimizer>(saved).is_err());
    }
}

#[test]
fn bounds_are_checked_when_they_are_read() {
    let read = |lower: Value, upper: Value| serde_json::from_value::<Bounds>(json!({ "lower": lower, "upper": upper }));
    assert_eq!(read(json!([0.0, -1.0]), json!([1.0, 1.0])).unwrap(), Bounds::new(vec![0.0, -1.0], vec![1.0, 1.0]).unwrap());
    assert!(read(json!([0.0]), json!([1.0, 1.0])).is_err());
    assert!(read(json!([0.0]), json!([0.0])).is_err());
    assert!(read(json!([]), json!([])).is_err());
}

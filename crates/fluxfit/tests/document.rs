//! The document of an identification keeps its promises: numbers where numbers are promised, nulls where nothing is known, and
//! text that reads back.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Model, Request, Swarm,
    document::IdentificationDocument,
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::Motor,
    optimizer::{self, Draws},
};
use proptest::prelude::*;
use serde_json::Value;

const KEYS: [&str; 4] = ["rs", "ld", "lq", "psi_f"];

/// What is null in a document, as paths; diagnostics are raw and not looked at.
fn nulls(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(items) => items.iter().for_each(|item| nulls(&format!("{path}[]"), item, found)),
        Value::Object(fields) => {
            for (key, field) in fields.iter().filter(|(key, _)| *key != "diagnostics") {
                nulls(&format!("{path}.{key}"), field, found);
            }
        }
        _ => {}
    }
}

/// The nulls that the verdicts ask for, no less and no more.
fn promised_nulls(document: &Value) -> Vec<String> {
    let mut promised = Vec::new();
    for key in KEYS {
        let verdict = document["parameters"][key]["verdict"].as_str().unwrap();
        assert!(["identified", "weak", "not-identifiable"].contains(&verdict), "{verdict}");
        if verdict == "not-identifiable" {
            let fields = ["value", "standard_error", "statistical", "systematic", "ci95"];
            promised.extend(fields.map(|field| format!(".parameters.{key}.{field}")));
            promised.push(format!(".least_squares.{key}"));
            if document["search"].is_object() {
                promised.push(format!(".search.{key}"));
            }
        }
        for field in ["reason", "remedy"] {
            let needed = verdict != "identified";
            let null = document["parameters"][key][field].is_null();
            assert_eq!(null, !needed, "{key} {verdict} {field}: {}", document["parameters"][key][field]);
            if null {
                promised.push(format!(".parameters.{key}.{field}"));
            }
        }
    }
    if document["search"].is_null() {
        promised.push(".search".to_owned());
    }
    if document["temperature"].is_null() {
        promised.push(".temperature".to_owned());
    }
    promised.sort();
    promised
}

/// A field that may be null is an `Option`: no other number is infinite or undefined.
fn assert_finite(document: &IdentificationDocument) {
    let text = format!("{document:?}");
    let mut words = text.split(|letter: char| !letter.is_alphanumeric());
    assert!(!words.any(|word| ["NaN", "inf"].contains(&word)), "{text}");
}

/// Checks one log's document; the verdicts it found.
fn check(log: &Log, settings: &Request) -> Option<Vec<String>> {
    let answer = identify(log, settings).ok()?;
    assert_finite(&IdentificationDocument::of(&answer));
    let text = serde_json::to_string(&answer).unwrap();
    let read: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(read, serde_json::to_value(&answer).unwrap());
    let mut found = Vec::new();
    nulls("", &read, &mut found);
    found.sort();
    assert_eq!(found, promised_nulls(&read));
    assert_eq!(read["temperature"].is_null(), log.columns().temperature.is_none());
    for key in KEYS {
        let parameter = &read["parameters"][key];
        if let Some(value) = parameter["value"].as_f64() {
            let [low, high] = [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap());
            assert!(low <= value && value <= high, "{parameter}");
            assert_eq!(read["least_squares"][key], parameter["value"], "steady least squares is the answer");
        }
    }
    Some(KEYS.map(|key| read["parameters"][key]["verdict"].as_str().unwrap().to_owned()).to_vec())
}

/// A swarm that is done before it begins: the document does not depend on what it finds.
fn quick() -> Request {
    Request {
        model: Some(Model::Steady),
        search: optimizer::SearchSettings { population: 6, iterations: 2, ..optimizer::SearchSettings::default() },
        ..Request::default()
    }
}

/// The paper's motor at (i_d, i_q), 0.5 % noise on the voltages.
fn log(modes: &[(f64, f64)]) -> Log {
    let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
    let mut draws = Draws::seeded(1, 0);
    let mut columns = Columns::default();
    for (k, &(d, q)) in modes.iter().flat_map(|mode| [mode; 200]).enumerate() {
        let u = motor.steady_voltage(Dq { d, q }, 400.0);
        columns.t.push(1e-3 * k as f64);
        columns.ud.push(u.d + 0.4 * draws.normal());
        columns.uq.push(u.q + 0.4 * draws.normal());
        columns.id.push(d);
        columns.iq.push(q);
        columns.omega_e.push(400.0);
    }
    Log::new(columns).unwrap()
}

#[test]
fn an_answered_document_has_every_number_and_one_without_a_swarm_says_so() {
    let settings = quick();
    let verdicts = check(&log(&[(0.0, 9.0), (-4.0, 8.0), (-2.0, 3.0)]), &settings).unwrap();
    assert!(verdicts.iter().all(|verdict| verdict == "identified"), "{verdicts:?}");
    assert!(check(&log(&[(0.0, 9.0), (-4.0, 8.0)]), &Request { swarm: Swarm::Off, ..settings }).is_some());
}

#[test]
fn what_the_log_does_not_tell_is_null_wherever_it_would_stand() {
    // One point at i_d = 0 tells L_q alone.
    let verdicts = check(&log(&[(0.0, 9.0)]), &quick()).unwrap();
    assert_eq!(verdicts, ["not-identifiable", "not-identifiable", "identified", "not-identifiable"]);
}

/// Columns of any kind and size that a log may have, a gap in the middle.
fn garbage() -> impl Strategy<Value = Columns> {
    (prop::array::uniform5((0..6, -9.0..9.0_f64)), -6.0..3.0_f64, any::<u64>()).prop_map(|(kinds, period, seed)| {
        let mut draws = Draws::seeded(seed, 0);
        let [ud, uq, id, iq, omega_e] = kinds.map(|(kind, exponent)| {
            let (size, level) = (10.0_f64.powf(exponent), draws.normal().clamp(-1.0, 1.0));
            let mut value = |k: usize| match kind {
                0 => 0.0,
                1 => level,
                2 => draws.normal().clamp(-1.0, 1.0),
                3 => level * f64::from(u8::from(k >= 40)),
                4 => level * (1.0 + 1e-3 * draws.normal()),
                _ => level * if k < 40 { 1.0 } else { -0.5 },
            };
            (0..80).map(|k| (size * value(k)).clamp(-1e9, 1e9)).collect()
        });
        let t = (0..80).map(|k| 10.0_f64.powf(period) * (k + if k < 40 { 0 } else { 3 }) as f64).collect();
        Columns { t, ud, uq, id, iq, omega_e, ..Columns::default() }
    })
}

proptest! {
    // Nothing is written beside the tests when one fails: its seed is in the message.
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_log_makes_a_document_break_its_promises(columns in garbage()) {
        if let Ok(log) = Log::new(columns) {
            check(&log, &quick());
        }
    }
}

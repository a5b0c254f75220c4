//! Answers as JSON documents: `fluxfit.identification/1`, `fluxfit.validation/1` and `fluxfit.study/1`.
//!
//! Others read these documents: fields are added, never renamed. Every number in them is finite; what is not known is null.

mod convention;
mod current_loop;
mod identification;
mod study;
mod validation;

pub use convention::convention;
pub use current_loop::current_loop;
pub use identification::identification;
pub use study::{StudyFacts, study};
pub use validation::validation;

use fluxfit::motor::{Motor, PARAMETERS, Parameter};
use serde_json::{Map, Value, json};

/// A document as text, with a newline at its end.
pub fn to_text(document: &Value) -> String {
    format!("{document:#}\n")
}

/// Four values under the parameters' names.
fn by_parameter<V: Into<Value>>(values: [V; PARAMETERS]) -> Map<String, Value> {
    Parameter::ALL.into_iter().zip(values).map(|(parameter, value)| (parameter.key().to_owned(), value.into())).collect()
}

/// A motor, and what it costs.
fn motor_with_cost(motor: &Motor, cost: f64) -> Value {
    let mut object = by_parameter(motor.to_array());
    object.insert("cost".to_owned(), json!(cost));
    Value::Object(object)
}

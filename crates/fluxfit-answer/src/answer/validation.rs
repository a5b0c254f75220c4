//! The document of `validate`: schema `fluxfit.validation/1`.

use super::by_parameter;
use fluxfit::{
    Validation, log::Log, validation::validate::Channel, validation::validate::Difference, validation::validate::LITTLE,
    validation::validate::SIGNIFICANCE, validation::wald::Test,
};
use serde_json::{Map, Value, json};

/// The document of a validation.
pub fn validation(log: &Log, found: &Validation) -> Value {
    let channels = found.channels.each_ref().map(|one| (one.name.to_owned(), channel(one)));
    json!({
        "schema": "fluxfit.validation/1",
        "log": {
            "rows": log.rows(),
            "duration_s": log.duration(),
            "segments": log.segments().len(),
        },
        "outcome": found.outcome.key(),
        "verdict": found.verdict(),
        "model": found.own.model.model.key(),
        "model_reason": found.own.model.reason.to_string(),
        "voltage_timing": super::identification::voltage_timing(&found.own),
        "test": test(&found.test),
        "share": found.share,
        "excess_cost": found.excess_cost,
        "limits": { "significance": SIGNIFICANCE, "share": LITTLE },
        "parameters": by_parameter(found.parameters.each_ref().map(|one| difference(one, found))),
        "channels": Value::Object(Map::from_iter(channels)),
        "warnings": found.own.warnings.iter().map(|warning| json!({ "code": warning.code(), "message": warning.to_string() })).collect::<Vec<_>>(),
    })
}

fn difference(difference: &Difference, found: &Validation) -> Value {
    let own = difference.own;
    json!({
        "unit": difference.parameter.unit(),
        "given": difference.given,
        "given_standard_error": found.given.standard_error(difference.parameter),
        "tested": own.is_some(),
        "own": own.map(|own| own.value),
        "difference": difference.difference(),
        "difference_percent": difference.percent(),
        "standard_error": own.map(|own| own.standard_error),
        "half_width95": own.map(|own| own.half_width),
        "standard_errors": difference.standard_errors(),
    })
}

fn channel(channel: &Channel) -> Value {
    json!({
        "unit": channel.unit,
        "rms": channel.rms,
        "noise": channel.noise,
        "ratio": channel.ratio(),
        "explained": channel.explained,
        "share": channel.share,
        "test": test(&channel.test),
        "outcome": channel.outcome.key(),
    })
}

/// A test that was not made is null.
fn test(test: &Test) -> Value {
    if test.tested == 0 {
        return Value::Null;
    }
    json!({
        "parameters": test.tested,
        "statistic": test.statistic,
        "degrees_of_freedom": [test.degrees_of_freedom, test.behind],
        "probability": test.probability,
    })
}

//! The document of `identify`: schema `fluxfit.identification/1`.

use super::by_parameter;
use fluxfit::{
    identify::{Identification, Provenance, verdict::Judgement},
    log::Log,
    motor::{Motor, PARAMETERS},
    steady::{OperatingPoint, held_vector::VoltageTiming},
};
use serde_json::{Value, json};

/// The document of an identification; `method` is the name of the swarm that searched, or `least-squares`.
pub fn identification(log: &Log, answer: &Identification, method: &str) -> Value {
    let found = |motor: &Motor| known_only(motor, answer);
    json!({
        "schema": "fluxfit.identification/1",
        "log": {
            "rows": log.rows(),
            "duration_s": log.duration(),
            "segments": log.segments().len(),
            "sample_period_s": log.segments().first().map(|segment| segment.sample_period),
            "operating_points": answer.operating_points.iter().map(operating_point).collect::<Vec<_>>(),
        },
        "model": "steady",
        "method": method,
        "parameters": by_parameter(answer.parameters.each_ref().map(parameter)),
        "nuisance": { "voltage_timing": voltage_timing(answer), "dead_time_voltage": { "along_current": answer.voltage_losses } },
        "least_squares": with(found(&answer.estimate.motor), json!({ "cost": answer.estimate.objective.cost(&answer.estimate.motor) })),
        "search": answer.search.as_ref().map(|search| with(found(&search.motor), json!({
            "cost": search.report.cost,
            "cost_above_optimum": search.cost_above_optimum,
            "evaluations": search.report.evaluations,
            "stop_reason": search.report.stop_reason,
        }))),
        "fit": {
            "residual_rms": residual_rms(answer),
            "redundancy": answer.estimate.redundancy,
        },
        "warnings": answer.warnings.iter().map(|warning| json!({ "code": warning.code, "message": warning.message })).collect::<Vec<_>>(),
        "diagnostics": diagnostics(answer),
    })
}

/// How the voltage columns were read.
fn voltage_timing(answer: &Identification) -> Value {
    let (timing, provenance) = answer.voltage_timing;
    let timing = match timing {
        VoltageTiming::Centered => "centered",
        VoltageTiming::Compensated => "compensated",
    };
    json!({ "value": timing, "stated": provenance == Provenance::Stated })
}

fn operating_point(point: &OperatingPoint) -> Value {
    let (u, i) = (point.voltage(), point.current());
    json!({
        "t0": point.time.0, "t1": point.time.1, "rows": point.rows.len(),
        "id": i.d, "iq": i.q, "omega_e": point.omega_e(), "ud": u.d, "uq": u.q,
    })
}

fn parameter(judgement: &Judgement) -> Value {
    let answered = judgement.value().is_some();
    let uncertainty = &judgement.uncertainty;
    json!({
        "value": judgement.value(),
        "unit": judgement.parameter.unit(),
        "standard_error": answered.then(|| uncertainty.standard_error()),
        "statistical": answered.then_some(uncertainty.statistical),
        "systematic": answered.then(|| uncertainty.systematic.total()),
        "ci95": judgement.interval(),
        "verdict": judgement.verdict.key(),
        "reason": judgement.reason,
        "remedy": judgement.remedy,
    })
}

/// A motor's parameters, null where the verdict is `not-identifiable`.
fn known_only(motor: &Motor, answer: &Identification) -> [Option<f64>; PARAMETERS] {
    let values = motor.to_array();
    std::array::from_fn(|p| answer.parameters[p].value().map(|_| values[p]))
}

/// Parameters, then further fields.
fn with(values: [Option<f64>; PARAMETERS], fields: Value) -> Value {
    let mut object = by_parameter(values);
    if let Value::Object(fields) = fields {
        object.extend(fields);
    }
    Value::Object(object)
}

/// Root mean square over the operating points of each equation's residual, V.
fn residual_rms(answer: &Identification) -> Value {
    let points = answer.estimate.residuals.len() as f64;
    let rms = |axis: usize| (answer.estimate.residuals.iter().map(|residual| residual[axis].powi(2)).sum::<f64>() / points).sqrt();
    json!({ "ud": rms(0), "uq": rms(1) })
}

/// Raw numbers, whatever the verdicts say of them.
fn diagnostics(answer: &Identification) -> Value {
    let systematic = answer.parameters.each_ref().map(|judgement| {
        let parts = &judgement.uncertainty.systematic;
        json!({
            "accuracy": parts.accuracy, "prior": parts.prior, "timing": parts.timing, "dead_time": parts.dead_time,
            "excitation": parts.excitation, "misfit": parts.misfit,
        })
    });
    json!({
        "raw": by_parameter(answer.estimate.motor.to_array()),
        "raw_standard_error": by_parameter(answer.parameters.each_ref().map(|judgement| judgement.uncertainty.standard_error())),
        "raw_search": answer.search.as_ref().map(|search| by_parameter(search.motor.to_array())),
        "systematic": by_parameter(systematic),
        "degrees_of_freedom": by_parameter(answer.parameters.each_ref().map(|judgement| judgement.uncertainty.degrees_of_freedom)),
        "correlation": answer.correlation,
        "excitation": answer.excitation.directions.iter().map(|direction| json!({
            "direction": by_parameter(direction.components),
            "signal_to_noise": direction.signal_to_noise,
            "excited": direction.excited,
        })).collect::<Vec<_>>(),
        "chi_squared": answer.estimate.chi_squared,
        "misfit": answer.misfit.map(|misfit| json!({ "ratio": misfit.ratio, "voltage_accuracy": misfit.voltage_accuracy })),
        "search_box": answer.search.as_ref().map(|search| by_parameter::<Value>(
            search.bounds.iter().map(|(lower, upper)| json!([lower, upper])).collect::<Vec<_>>().try_into().unwrap_or_default(),
        )),
    })
}

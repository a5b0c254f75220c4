//! The document of `identify`: schema `fluxfit.identification/1`.

use super::by_parameter;
use fluxfit::{
    Judgement,
    evidence::Identification,
    evidence::Nuisance,
    evidence::Outcome,
    evidence::OutputFit,
    evidence::Provenance,
    evidence::Saturation,
    evidence::SteadyFit,
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS},
    steady::{OperatingPoint, zero_order_hold::VoltageTiming},
};
use serde_json::{Map, Value, json};

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
            "operating_points": answer.operating_points().iter().map(operating_point).collect::<Vec<_>>(),
        },
        "model": answer.model.model.key(),
        "model_reason": answer.model.reason.to_string(),
        "method": method,
        "parameters": by_parameter(answer.parameters.each_ref().map(parameter)),
        "nuisance": nuisance(answer),
        "least_squares": answer.steady.as_ref().map(|fit| {
            with(found(&fit.estimate.motor), json!({ "cost": fit.estimate.objective.cost(&fit.estimate.motor) }))
        }),
        "search": answer.search.as_ref().map(|search| with(found(&search.motor), json!({
            "cost": search.report.cost,
            "cost_above_optimum": search.cost_above_optimum,
            "evaluations": search.report.evaluations,
            "stop_reason": search.report.stop_reason,
        }))),
        "fit": {
            "residual_rms": residual_rms(answer),
            "redundancy": redundancy(answer),
        },
        "warnings": answer.warnings.iter().map(|warning| json!({ "code": warning.code(), "message": warning.to_string() })).collect::<Vec<_>>(),
        "diagnostics": diagnostics(answer),
    })
}

/// What stands between the motor and the log: how the voltage columns were read, and the drive's faults.
fn nuisance(answer: &Identification) -> Value {
    let mut found = Map::new();
    found.insert("voltage_timing".to_owned(), voltage_timing(answer));
    if let Some(fit) = &answer.output {
        for Nuisance { unknown, value, standard_error } in &fit.nuisance {
            let entry = json!({ "value": value, "unit": unknown.unit(), "standard_error": standard_error });
            found.insert(unknown.key().to_owned(), entry);
        }
    } else if let Some(fit) = &answer.steady {
        found.insert("dead_time_voltage".to_owned(), json!({ "along_current": fit.voltage_losses }));
    }
    Value::Object(found)
}

/// How the voltage columns were read, and where that comes from.
pub(super) fn voltage_timing(answer: &Identification) -> Value {
    let of_currents = answer.output.as_ref().map(|fit| (fit.voltage_reading.0.key(), fit.voltage_reading.1));
    let of_points = answer.steady.as_ref().map(|fit| match fit.voltage_timing {
        (VoltageTiming::Centered, provenance) => ("centered", provenance),
        (VoltageTiming::Compensated, provenance) => ("compensated", provenance),
    });
    of_currents.or(of_points).map_or(Value::Null, |(reading, provenance)| {
        let from = match provenance {
            Provenance::Stated => "stated",
            Provenance::Found => "found",
            Provenance::Assumed => "assumed",
        };
        json!({ "value": reading, "stated": provenance == Provenance::Stated, "from": from })
    })
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
        "reason": judgement.reason.as_ref().map(ToString::to_string),
        "remedy": judgement.remedy.as_ref().map(ToString::to_string),
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

/// Root mean square of what is left: of currents, A, or of each voltage equation over the operating points, V.
fn residual_rms(answer: &Identification) -> Value {
    if let Some(fit) = &answer.output {
        let Dq { d, q } = fit.residual_rms();
        return json!({ "id": d, "iq": q });
    }
    let residuals = answer.steady.as_ref().map_or(&[][..], |fit| &fit.estimate.residuals);
    let rms = |axis: usize| (residuals.iter().map(|residual| residual[axis].powi(2)).sum::<f64>() / residuals.len() as f64).sqrt();
    json!({ "ud": rms(0), "uq": rms(1) })
}

fn redundancy(answer: &Identification) -> Option<usize> {
    let of_currents = answer.output.as_ref().map(|fit| fit.redundancy);
    of_currents.or(answer.steady.as_ref().map(|fit| fit.estimate.redundancy))
}

/// Raw numbers, whatever the verdicts say of them.
fn diagnostics(answer: &Identification) -> Value {
    let systematic = answer.parameters.each_ref().map(|judgement| {
        let parts = judgement.uncertainty.systematic.parts();
        Value::Object(parts.into_iter().map(|(value, part)| (part.key().to_owned(), json!(value))).collect())
    });
    json!({
        "raw": by_parameter(answer.parameters.each_ref().map(|judgement| judgement.raw)),
        "raw_standard_error": by_parameter(answer.parameters.each_ref().map(|judgement| judgement.uncertainty.standard_error())),
        "raw_search": answer.search.as_ref().map(|search| by_parameter(search.motor.to_array())),
        "systematic": by_parameter(systematic),
        "degrees_of_freedom": by_parameter(answer.parameters.each_ref().map(|judgement| judgement.uncertainty.degrees_of_freedom)),
        "correlation": answer.correlation,
        "search_box": answer.search.as_ref().map(|search| by_parameter::<Value>(
            search.bounds.iter().map(|(lower, upper)| json!([lower, upper])).collect::<Vec<_>>().try_into().unwrap_or_default(),
        )),
        "saturation": answer.saturation.as_ref().map(saturation),
        "steady": answer.steady.as_ref().map(steady),
        "output_error": answer.output.as_ref().map(output_error),
    })
}

/// Flux per operating point, where inductances depend on the current: Wb, H, A.
fn saturation(found: &Saturation) -> Value {
    json!({
        "rs": found.rs,
        "rs_standard_uncertainty": found.rs_uncertainty,
        "apparent_lq": found.lq.map(|ends| ends.map(|end| json!({ "iq": end.current, "value": end.inductance }))),
        "small_currents": by_parameter(found.small_currents.to_array()),
        "flux": found.fluxes.iter().map(|flux| flux.map(|flux| json!({
            "id": flux.current.d,
            "iq": flux.current.q,
            "psi_d": flux.psi.d,
            "psi_q": flux.psi.q,
            "psi_d_standard_uncertainty": flux.uncertainty.d,
            "psi_q_standard_uncertainty": flux.uncertainty.q,
            "apparent_ld": flux.apparent_ld,
            "apparent_lq": flux.apparent_lq,
        }))).collect::<Vec<_>>(),
    })
}

/// The operating points' side of it.
fn steady(fit: &SteadyFit) -> Value {
    json!({
        "raw": by_parameter(fit.estimate.motor.to_array()),
        "excitation": fit.excitation.directions.iter().map(|direction| json!({
            "direction": by_parameter(direction.components),
            "signal_to_noise": direction.signal_to_noise,
            "excited": direction.excited,
        })).collect::<Vec<_>>(),
        "chi_squared": fit.estimate.chi_squared,
        "misfit": fit.misfit.map(|misfit| json!({ "ratio": misfit.ratio, "voltage_accuracy": misfit.voltage_accuracy })),
        "voltage_losses": fit.voltage_losses,
    })
}

/// The simulated currents' side of it: everything that was tried.
fn output_error(fit: &OutputFit) -> Value {
    json!({
        "rows": fit.stretches.iter().map(|rows| json!([rows.start, rows.end])).collect::<Vec<_>>(),
        "cost": fit.cost,
        "correlation_of_neighbours": fit.correlation_of_neighbours,
        "readings": fit.readings.iter().map(|tried| json!({
            "voltage_timing": tried.reading.key(),
            "residual_rms": tried.mean_square().sqrt(),
            "raw": by_parameter(tried.polished.drive.motor.to_array()),
        })).collect::<Vec<_>>(),
        "terms": fit.terms.iter().map(|tried| json!({
            "term": tried.fault.key(),
            "gain": tried.gain,
            "taken": tried.outcome == Outcome::Taken,
            "outcome": tried.outcome.label(),
        })).collect::<Vec<_>>(),
    })
}

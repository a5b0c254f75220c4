//! The log beside the nameplate, in the diagnostics of `fluxfit.identification/1`.

use super::by_parameter;
use fluxfit::{
    evidence::{Candidate, Convention},
    motor::Parameter,
};
use serde_json::{Value, json};

/// What the check of conventions found; null where there was nothing to compare.
pub fn convention(convention: &Convention) -> Value {
    if convention.ratios.is_empty() {
        return Value::Null;
    }
    let of = |parameter| convention.ratios.iter().find(|ratio| ratio.parameter == parameter);
    json!({
        "agrees": convention.agrees(),
        "reversed": convention.reversed,
        "ratio": by_parameter(Parameter::ALL.map(|parameter| of(parameter).map(|ratio| ratio.ratio))),
        "apparent_flux": of(Parameter::PsiF).is_some_and(|ratio| ratio.apparent),
        "best": convention.best.as_ref().map(candidate),
        "alternatives": convention.alternatives.iter().map(candidate).collect::<Vec<_>>(),
    })
}

fn candidate(candidate: &Candidate) -> Value {
    let patterns = candidate.patterns.iter().map(|pattern| {
        let columns = pattern.columns.map(|[u, i, omega]| json!({ "u": u, "i": i, "omega": omega }));
        json!({ "name": pattern.name, "sentence": pattern.sentence, "columns": columns })
    });
    json!({
        "patterns": patterns.collect::<Vec<_>>(),
        "factors": by_parameter(candidate.factors),
        "explains": candidate.explained.iter().map(|parameter| parameter.key()).collect::<Vec<_>>(),
    })
}

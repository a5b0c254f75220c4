//! `current_loop` of `fluxfit.identification/1`: the current controllers' gains.

use fluxfit::{
    current_loop::{CurrentLoop, DELAY_PERIODS, Gain},
    evidence::Provenance,
};
use serde_json::{Value, json};

/// Gains of both axes; null where the parameter behind one means nothing.
pub fn current_loop(found: &CurrentLoop) -> Value {
    let axis = |kp: Option<Gain>| json!({ "kp": kp.map(|kp| gain(kp, "V/A")), "ki": found.ki.map(|ki| gain(ki, "V/(A s)")) });
    json!({
        "bandwidth_hz": found.bandwidth,
        "control_rate_hz": found.control_rate.0,
        "control_rate_stated": found.control_rate.1 == Provenance::Stated,
        "delay_periods": DELAY_PERIODS,
        "phase_margin_deg": found.phase_margin(),
        "highest_bandwidth_hz": found.highest_bandwidth(),
        "d": axis(found.kp_d),
        "q": axis(found.kp_q),
    })
}

fn gain(gain: Gain, unit: &str) -> Value {
    json!({ "value": gain.value, "unit": unit, "ci95": gain.interval, "verdict": gain.verdict.key() })
}

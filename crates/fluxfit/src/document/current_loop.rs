//! `current_loop` of an identification: the gains of the current controllers.

use crate::{
    current_loop::{CurrentLoop, DELAY_PERIODS, Gain},
    evidence::Provenance,
};
use serde::Serialize;

/// Proportional and integral gains of both current controllers for a wanted bandwidth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CurrentLoopEntry {
    /// The wanted bandwidth of the closed loop, Hz.
    pub bandwidth_hz: f64,
    /// How often the controllers run, Hz.
    pub control_rate_hz: f64,
    /// Whether that rate was stated; if not, it is the log's sampling rate.
    pub control_rate_stated: bool,
    /// Delay between a sample and the middle of the voltage that answers it, in control periods.
    pub delay_periods: f64,
    /// Phase margin with this delay, degrees; negative if the loop is unstable.
    pub phase_margin_deg: f64,
    /// The highest bandwidth with enough phase margin, Hz.
    pub highest_bandwidth_hz: f64,
    /// The controller of i_d.
    pub d: AxisGains,
    /// The controller of i_q.
    pub q: AxisGains,
}

impl CurrentLoopEntry {
    pub(super) fn of(found: &CurrentLoop) -> Self {
        let axis =
            |kp: Option<Gain>| AxisGains { kp: kp.map(|kp| GainEntry::of(kp, "V/A")), ki: found.ki.map(|ki| GainEntry::of(ki, "V/(A s)")) };
        Self {
            bandwidth_hz: found.bandwidth,
            control_rate_hz: found.control_rate.value,
            control_rate_stated: found.control_rate.provenance == Provenance::Stated,
            delay_periods: DELAY_PERIODS,
            phase_margin_deg: found.phase_margin(),
            highest_bandwidth_hz: found.highest_bandwidth(),
            d: axis(found.kp_d),
            q: axis(found.kp_q),
        }
    }
}

/// The gains of one current controller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AxisGains {
    /// Proportional gain, V/A; null if the inductance that it comes from is `not-identifiable`.
    pub kp: Option<GainEntry>,
    /// Integral gain, V/(A s); null if the resistance that it comes from is `not-identifiable`.
    pub ki: Option<GainEntry>,
}

/// One gain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GainEntry {
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// The 95 % interval: lower and upper end.
    pub ci95: [f64; 2],
    /// The verdict on the parameter that the gain comes from.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = super::keys::verdicts())))]
    pub verdict: &'static str,
}

impl GainEntry {
    fn of(gain: Gain, unit: &'static str) -> Self {
        Self { value: gain.value, unit, ci95: gain.interval, verdict: gain.verdict.key() }
    }
}

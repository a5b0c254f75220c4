//! What lies between the motor and the log: the voltage timing, and the faults of the drive that were found.

use super::{by_key::ByKey, finite::finite};
use crate::{
    evidence::{FaultEstimate, Identification, Provenance, Warming},
    steady::zero_order_hold::SteadyVoltageTiming,
};
use serde::Serialize;

/// The voltage timing and the drive's faults.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NuisanceEntries {
    /// How the voltage columns were read; null where nothing was fitted.
    pub voltage_timing: Option<VoltageTimingEntry>,
    /// Each number of the drive that was found beside the motor, under its name.
    #[serde(flatten)]
    pub found: ByKey<NuisanceEntry>,
}

impl NuisanceEntries {
    pub(super) fn of(answer: &Identification) -> Self {
        let found = if let Some(fit) = &answer.output {
            fit.fault_estimates.iter().map(|found| (found.unknown.key(), NuisanceEntry::of(found))).collect()
        } else if let Some(fit) = &answer.steady {
            let loss = ("dead_time_voltage", NuisanceEntry::AlongCurrent { along_current: fit.voltage_losses.clone() });
            let lag = fit.frame_lag.map(|lag| {
                let standard_error = finite(lag.standard_error);
                ("frame_lag", NuisanceEntry::Number { value: lag.seconds, unit: "s", standard_error })
            });
            let warming = fit.warming.filter(Warming::is_found).map(|warming| {
                let standard_error = finite(warming.standard_error);
                ("resistance_change", NuisanceEntry::Number { value: warming.change, unit: "ohm", standard_error })
            });
            [loss].into_iter().chain(lag).chain(warming).collect()
        } else {
            Vec::new()
        };
        Self { voltage_timing: VoltageTimingEntry::of(answer), found: ByKey(found) }
    }
}

/// A number of the drive beside the motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
#[non_exhaustive]
pub enum NuisanceEntry {
    /// One number, found by the output error; or the lag of a recorder's voltages and the change of R_s, found by the steady model.
    Number {
        /// SI units.
        value: f64,
        /// Its unit; `1` if it has none.
        unit: &'static str,
        /// Statistical standard error, in the same unit.
        standard_error: Option<f64>,
    },
    /// The voltage that dead time and device drops take, found by the steady model.
    AlongCurrent {
        /// Voltage along the current at each operating point, V; zero where no loss is seen.
        along_current: Vec<f64>,
    },
}

impl NuisanceEntry {
    fn of(found: &FaultEstimate) -> Self {
        Self::Number { value: found.value, unit: found.unknown.unit(), standard_error: finite(found.standard_error) }
    }
}

/// How the voltage columns were read.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VoltageTimingEntry {
    /// Output error: `centered`, or the delay in sample periods, with the frame if it is not that of the middle of the period. Steady
    /// model: `centered` or `compensated`.
    pub value: String,
    /// Whether the settings state it.
    pub stated: bool,
    /// `stated` by the settings, `found` from the log, or `assumed`, with the doubt counted as uncertainty.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["stated", "found", "assumed"])))]
    pub from: &'static str,
}

impl VoltageTimingEntry {
    pub(super) fn of(answer: &Identification) -> Option<Self> {
        let of_currents = answer.output.as_ref().map(|fit| (fit.voltage_timing.value.key(), fit.voltage_timing.provenance));
        let key = |timing| match timing {
            SteadyVoltageTiming::Centered => "centered",
            SteadyVoltageTiming::Compensated => "compensated",
        };
        let of_points = answer.steady.as_ref().map(|fit| (key(fit.voltage_timing.value), fit.voltage_timing.provenance));
        let (value, provenance) = of_currents.or(of_points)?;
        let from = match provenance {
            Provenance::Stated => "stated",
            Provenance::Found => "found",
            Provenance::Assumed => "assumed",
        };
        Some(Self { value: value.to_owned(), stated: provenance == Provenance::Stated, from })
    }
}

//! The document of `identify` where tables of a test bench are given: schema `fluxfit.characteristics/1`.

use super::by_parameter::ByParameter;
use crate::{
    characteristics::{Across, Characteristic, CharacteristicEstimate, CharacteristicsAnswer, Instrument, Lack, Residual, VoltageReading},
    identification::judge::verdict::Verdict,
    motor::Parameter,
};
use serde::Serialize;

/// The name of this document.
pub const CHARACTERISTICS: &str = "fluxfit.characteristics/1";

/// The document that `fluxfit identify --json` prints of characteristics. Fields are added in later versions, never renamed. What is not
/// known is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = CHARACTERISTICS))]
#[non_exhaustive]
pub struct CharacteristicsDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = CHARACTERISTICS)))]
    pub schema: &'static str,
    /// The tables.
    pub tables: Vec<TableEntry>,
    /// How the columns were read, a sentence each.
    pub notes: Vec<String>,
    /// How open-circuit voltages were taken: `stated` by the names of their columns, `lines-by-torque` or `phase-by-torque` by the torque
    /// of the short circuit, `ambiguous` where nothing tells, which leaves the parameters null; null without any.
    pub voltages: Option<&'static str>,
    /// Where the voltages are ambiguous: inductances and flux times the pole pairs, and the resistance, if these are line to line. Of a
    /// phase, all are sqrt 3 times as large.
    pub times_pole_pairs_if_line_to_line: ByParameter<Option<f64>>,
    /// Pole pairs; null if they are not known.
    pub pole_pairs: Option<u32>,
    /// The motor's own parameters: without pole pairs only the resistance has a value, unless the speeds are electrical.
    pub parameters: ByParameter<EstimateEntry>,
    /// What the tables tell without pole pairs: inductances and flux times these, and the resistance; where the speeds are electrical and
    /// the pole pairs are not known, the resistance alone.
    pub times_pole_pairs: ByParameter<EstimateEntry>,
    /// What is left of the voltages, as a fraction, root mean square.
    pub residual_voltage: Option<f64>,
    /// What is left of the currents, as a fraction, root mean square.
    pub residual_current: Option<f64>,
    /// What is left of the torques of the short circuit, N m, root mean square.
    pub residual_torque: Option<f64>,
    /// What is left of the torques of currents, N m, root mean square.
    pub residual_torque_of_current: Option<f64>,
    /// What is left of the voltages of direct currents, V of one phase, root mean square.
    pub residual_direct_voltage: Option<f64>,
    /// What is left of the voltages of duty cycles, V, amplitude of a phase, root mean square.
    pub residual_duty_voltage: Option<f64>,
    /// What is left of the voltages of operating points, V of either axis, root mean square.
    pub residual_point_voltage: Option<f64>,
    /// Relative change of each parameter by the error of an instrument, which the intervals do not count.
    pub unseen: Vec<InstrumentEntry>,
}

/// A table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TableEntry {
    /// Which test: `open-circuit`, `short-circuit`, `torque-of-current`, `direct-current`, `duty-cycle` or `operating-points`.
    pub kind: &'static str,
    /// Number of rows.
    pub rows: usize,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EstimateEntry {
    /// Value; null if it is not identifiable.
    pub value: Option<f64>,
    /// The unit: ohm, H or Wb.
    pub unit: &'static str,
    /// Standard error.
    pub standard_error: Option<f64>,
    /// 95 % interval.
    pub ci95: Option<[f64; 2]>,
    /// `identified`, `weak` or `not-identifiable`.
    pub verdict: &'static str,
    /// Why it has no value; null if it has one.
    pub reason: Option<String>,
    /// What to do about it; null if it has a value.
    pub remedy: Option<String>,
}

impl EstimateEntry {
    /// The estimate times a factor.
    fn of(estimate: &CharacteristicEstimate, factor: f64) -> Self {
        Self {
            value: estimate.value.map(|value| factor * value),
            unit: estimate.parameter.unit(),
            standard_error: estimate.value.map(|_| factor * estimate.uncertainty.standard_error()),
            ci95: estimate.interval().map(|interval| interval.map(|end| factor * end)),
            verdict: estimate.verdict.key(),
            reason: estimate.lack.map(|lack| lack.to_string()),
            remedy: estimate.lack.map(|lack| lack.remedy()),
        }
    }

    /// The entry of a number that is known but for the pole pairs, if it is known at all.
    fn without_pole_pairs(estimate: &CharacteristicEstimate) -> Self {
        let lack = estimate.lack.filter(|_| estimate.value.is_none()).unwrap_or(Lack::PolePairs);
        let unknown = CharacteristicEstimate { value: None, verdict: Verdict::NotIdentifiable, lack: Some(lack), ..*estimate };
        Self::of(&unknown, 1.0)
    }
}

/// The error of an instrument, and what that does to each parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct InstrumentEntry {
    /// `voltage`, `current` or `torque`, which reads 1 % too much; or `duty-scale`: a duty of 1 is `u_dc / 2`, not `u_dc / sqrt 3`.
    pub instrument: &'static str,
    /// Relative changes.
    pub changes: ByParameter<f64>,
}

impl CharacteristicsDocument {
    /// The document of an answer; `notes` say how the tables' columns were read.
    pub fn of(tables: &[Characteristic], notes: Vec<String>, answer: &CharacteristicsAnswer) -> Self {
        let pairs = answer.pole_pairs.map_or(1.0, f64::from);
        let left = |residual: Residual| answer.residual_rms[residual as usize];
        let table = |table: &Characteristic| TableEntry { kind: table.key(), rows: table.rows() };
        let instrument = |(instrument, changes): &(Instrument, [f64; 4])| InstrumentEntry {
            instrument: match instrument {
                Instrument::DutyScale => "duty-scale",
                Instrument::Voltage => "voltage",
                Instrument::Current => "current",
                Instrument::Torque => "torque",
            },
            changes: (*changes).into(),
        };
        let is_own = |parameter: Parameter| parameter == Parameter::Rs || answer.is_of_motor();
        // Of electrical speeds the pole pairs are not known, nor anything times these.
        let has_times = |parameter: Parameter| parameter == Parameter::Rs || !answer.has_electrical_speeds;
        Self {
            schema: CHARACTERISTICS,
            tables: tables.iter().map(table).collect(),
            notes,
            voltages: answer.voltages.map(|reading| match reading {
                VoltageReading::Stated => "stated",
                VoltageReading::ByTorque(Across::Lines) => "lines-by-torque",
                VoltageReading::ByTorque(Across::Phase) => "phase-by-torque",
                VoltageReading::Ambiguous => "ambiguous",
            }),
            pole_pairs: answer.pole_pairs,
            parameters: answer
                .parameters
                .each_ref()
                .map(|one| if is_own(one.parameter) { EstimateEntry::of(one, 1.0) } else { EstimateEntry::without_pole_pairs(one) })
                .into(),
            times_pole_pairs: answer
                .parameters
                .each_ref()
                .map(|one| match has_times(one.parameter) {
                    true => EstimateEntry::of(one, if one.parameter == Parameter::Rs { 1.0 } else { pairs }),
                    false => EstimateEntry::without_pole_pairs(one),
                })
                .into(),
            times_pole_pairs_if_line_to_line: std::array::from_fn(|p| {
                answer.if_line_to_line[p]
                    .filter(|_| has_times(Parameter::ALL[p]))
                    .map(|value| if p == Parameter::Rs as usize { value } else { pairs * value })
            })
            .into(),
            residual_voltage: left(Residual::OpenVoltage),
            residual_current: left(Residual::ShortCurrent),
            residual_torque: left(Residual::ShortTorque),
            residual_torque_of_current: left(Residual::Torque),
            residual_direct_voltage: left(Residual::DirectVoltage),
            residual_duty_voltage: left(Residual::DutyVoltage),
            residual_point_voltage: left(Residual::PointVoltage),
            unseen: answer.unseen.iter().map(instrument).collect(),
        }
    }
}

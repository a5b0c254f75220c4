//! Remedies: what to do about a verdict, as facts. How a face does it (an option, an argument, a button) is the face's matter.

use super::{
    super::{
        fit::{finding::Finding, incremental::Incremental, output_errors::CORRELATED, part::Part, saturation::SaturationFinding},
        judge::{
            reason::{Common, Reason},
            verdict::IDENTIFIED,
        },
    },
    measurement::Promised,
    promising::{HALF_WIDTH, STEP},
};
use crate::{
    motor::{Motor, Parameter},
    steady::recorder,
};

/// What to do for a better verdict. It prints as a sentence; who writes their own matches the variants, and prints those that they do
/// not know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Remedy {
    /// A measurement, with the interval to expect after it. What it may be: [`Measurement`](crate::Measurement).
    Measure(Promised),
    /// Add a stretch at the same speed with this i_d, A; zero: with i_d = 0.
    AddStretch {
        /// i_d, A.
        id: f64,
        /// What else would help, or is needed beside it.
        also: Option<Also>,
    },
    /// Hold each operating point longer, or follow the alternative.
    HoldLonger {
        /// How many times as long as now.
        times: f64,
        /// The parameter that it is for.
        parameter: Parameter,
        /// Half of the 95 % interval to expect, as a fraction of the value.
        half_width: f64,
        /// The alternative, itself a remedy.
        or: Box<Remedy>,
    },
    /// Make the operating points differ more, so that they tell this parameter.
    SpreadPoints {
        /// The parameter to be told.
        parameter: Parameter,
    },
    /// Log the motor where it turns, too.
    Turn,
    /// Check the unit of the speed and the number of pole pairs, or state the [model](crate::Request::model).
    CheckSpeed,
    /// Log larger steps of the current along the axis of this inductance, and more of them, as long as the rotor stands.
    StepCurrent {
        /// Which inductance.
        parameter: Parameter,
    },
    /// State the timing of the voltage columns: [`Request::voltage_timing`](crate::Request::voltage_timing).
    StateVoltageTiming,
    /// Log with the drive's dead-time compensation on.
    CompensateDeadTime {
        /// Or give R_s as measured at the terminals: [`Request::known`](crate::Request::known). Not where it is given.
        or_resistance: bool,
    },
    /// Log what tells a recorder's lag: different loads at one speed, or rows without current.
    TellFrameLag {
        /// A speed that a loaded motor holds, electrical rad/s: below the highest one of the log's operating points, which may be all that
        /// the DC voltage allows. Zero where the log has none.
        omega_e: f64,
    },
    /// Log each of the drive's periods.
    LogEachPeriod,
    /// Log without disturbances (torque ripple, supply ripple), or identify by the steady model from stretches of constant currents and
    /// speed that differ in load, i_d and speed.
    RemoveDisturbances,
    /// Calibrate the current sensors.
    CalibrateSensors,
    /// Calibrate the measurement of the DC voltage.
    CalibrateBusVoltage,
    /// The motor saturates: take its fluxes, or hold steps around the current that matters, for the incremental inductances there.
    SmallSteps,
    /// The motor saturates, and operating points tell its incremental inductances: take those, or its fluxes. The surest of each axis.
    TakeIncremental {
        /// Of d and of q.
        of_axes: [Incremental; 2],
    },
    /// Identify from three or more windows at nearly the same currents, so that saturation is alike in them.
    SimilarWindows,
    /// The recorder repeats values: hold each operating point for longer than that, or log all values of a row at one instant.
    HoldThroughRepeats,
    /// Give a sharper prior, or log another operating point.
    SharperPrior,
    /// Check the prior of this parameter, which the log contradicts, or identify without it.
    CheckPrior {
        /// Whose.
        parameter: Parameter,
    },
    /// Fix one parameter ([`Known::Fixed`](crate::Known::Fixed)), for example R_s as measured at the terminals.
    FixOne,
    /// Check that voltages and currents are of one instant and one frame: a lag explains what else looks like a wrong sign.
    CheckFrame {
        /// The lag that would, s.
        lag: f64,
    },
    /// Check signs and order of the columns: motor convention, q leading d by 90 degrees.
    CheckSigns {
        /// Whether units and pole pairs should be checked too.
        units: bool,
    },
}

/// What else helps beside a stretch with another i_d, in [`Remedy::AddStretch`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Also {
    /// Instead: a second speed or load, or R_s given.
    OrSecondPoint,
    /// The same where R_s is given already.
    OrSecondPointWithResistance,
    /// In addition: an operating point at a clearly different speed and load.
    AndSecondPoint,
}

/// Part of the highest speed of a log at which two loads are asked for: at the highest itself a drive often has no voltage left for a load.
/// A lag shows there nearly as well, as its angle is in proportion to the speed.
const LOADED_SPEED: f64 = 0.7;

/// Beyond this, longer windows are no remedy.
const MUCH_LONGER: f64 = 100.0;

/// Most of the interval of an identified parameter that may be no noise where longer windows are to help.
const MOST_REST: f64 = 0.9;

/// What is known beside a finding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside<'a> {
    /// Whether R_s is given, which then is no remedy.
    pub(super) knows_rs: bool,
    pub(super) saturation: Option<&'a SaturationFinding>,
}

/// What to do about a reason; nothing about a value that was given. `measure`: what to measure, where that is worth it.
pub(super) fn of(
    reason: &Reason,
    parameter: Parameter,
    finding: &Finding,
    beside: Beside,
    measure: impl FnOnce() -> Option<Promised>,
) -> Option<Remedy> {
    let Beside { knows_rs, saturation } = beside;
    let measure = || measure().map(Remedy::Measure);
    // At rest no operating point tells an inductance.
    if finding.bench.is_at_rest && matches!(parameter, Parameter::Ld | Parameter::Lq) && asks_for_points(reason) {
        return Some(Remedy::StepCurrent { parameter });
    }
    let or_stretch = |also: Option<Also>| Remedy::AddStretch { id: step(finding), also };
    Some(match reason {
        Reason::Given => return None,
        Reason::IdZero { .. } | Reason::IdConstant => measure().unwrap_or_else(|| or_stretch(None)),
        Reason::AtRest => Remedy::Turn,
        Reason::NoStep { parameter } => Remedy::StepCurrent { parameter: *parameter },
        Reason::OnePoint => {
            let also = if knows_rs { Also::OrSecondPointWithResistance } else { Also::OrSecondPoint };
            measure().unwrap_or_else(|| or_stretch(Some(also)))
        }
        Reason::TooSimilar { .. } => measure().unwrap_or_else(|| or_stretch(Some(Also::AndSecondPoint))),
        Reason::ShortCircuit => Remedy::FixOne,
        Reason::OtherImpossible { .. } if !is_any_negative(finding) => measure().unwrap_or_else(|| or_stretch(None)),
        Reason::Negative | Reason::OtherImpossible { .. } => match lag_instead_of_sign(finding) {
            Some(lag) => Remedy::CheckFrame { lag },
            None => Remedy::CheckSigns { units: false },
        },
        Reason::CurrentsMissed { .. } => Remedy::CheckSigns { units: true },
        Reason::SpeedInDoubt { .. } => Remedy::CheckSpeed,
        Reason::PriorContradicted { parameter } => Remedy::CheckPrior { parameter: *parameter },
        Reason::BelowRows { .. } | Reason::RunawayFault { .. } => measure().unwrap_or_else(|| or_stretch(None)),
        Reason::SharperThanNoise => measure().unwrap_or(Remedy::SpreadPoints { parameter }),
        // Beside saturation, what disturbs the motor or makes its points contradict each other is what a few terms lack of it.
        Reason::Saturates | Reason::Wide { part: Part::Saturation | Part::ProcessNoise | Part::Misfit, .. } if saturation.is_some() => {
            let incremental = || saturation.and_then(surest_of_axes).map(|of_axes| Remedy::TakeIncremental { of_axes });
            let at_once = if parameter == Parameter::Rs { measure() } else { incremental() };
            at_once.unwrap_or(Remedy::SmallSteps)
        }
        Reason::Saturates => Remedy::SmallSteps,
        Reason::Wide { part, .. } => narrower(*part, parameter, finding, knows_rs, measure),
    })
}

/// Whether more of what the operating points or the currents show would help.
fn asks_for_points(reason: &Reason) -> bool {
    match reason {
        Reason::Wide { part, .. } => matches!(part, Part::Noise | Part::Accuracy | Part::Excitation | Part::FaultsInDoubt),
        Reason::IdZero { .. } | Reason::IdConstant | Reason::OnePoint | Reason::TooSimilar { .. } | Reason::SharperThanNoise => true,
        _ => false,
    }
}

/// The surest incremental inductance of each axis; none where either axis has none.
fn surest_of_axes(saturation: &SaturationFinding) -> Option<[Incremental; 2]> {
    let found = saturation.incremental();
    let error = |one: &Incremental| one.uncertainty / one.inductance.abs();
    let surest = |axis: usize| {
        let of_axis = found.iter().filter(|one| one.axis == axis);
        of_axis.min_by(|one, other| error(one).total_cmp(&error(other))).copied()
    };
    Some([surest(0)?, surest(1)?])
}

/// What makes a wide interval narrower; `measure` is what to measure for it.
fn narrower(part: Part, parameter: Parameter, finding: &Finding, knows_rs: bool, measure: impl FnOnce() -> Option<Remedy>) -> Remedy {
    match part {
        Part::Noise => {
            let or = measure().unwrap_or(Remedy::SpreadPoints { parameter });
            match longer(parameter, finding) {
                Some((times, half_width)) => Remedy::HoldLonger { times, parameter, half_width, or: Box::new(or) },
                None => or,
            }
        }
        Part::Accuracy | Part::Excitation | Part::FaultsInDoubt => measure().unwrap_or(Remedy::SpreadPoints { parameter }),
        Part::Timing => Remedy::StateVoltageTiming,
        // Beside dead time a resistance that is given tells psi_f, and inductances hardly.
        Part::DeadTime => measure()
            .unwrap_or(Remedy::CompensateDeadTime { or_resistance: !knows_rs && matches!(parameter, Parameter::Rs | Parameter::PsiF) }),
        Part::FrameLag => Remedy::TellFrameLag { omega_e: LOADED_SPEED * Common::of(&finding.bench).speed() },
        Part::WithinRows => Remedy::LogEachPeriod,
        // Between rows that are not the drive's own periods, its voltages are what disturbs the motor.
        Part::ProcessNoise if finding.uncertainty.parameters[parameter as usize].systematic.within_rows > 0.0 => Remedy::LogEachPeriod,
        // What disturbs the motor would disturb it in a further stretch too.
        Part::ProcessNoise => Remedy::RemoveDisturbances,
        Part::Sensors | Part::CurrentGain => Remedy::CalibrateSensors,
        Part::BusVoltage => Remedy::CalibrateBusVoltage,
        Part::Saturation => Remedy::SmallSteps,
        Part::Misfit if finding.trust.repeated_values => Remedy::HoldThroughRepeats,
        Part::Misfit => Remedy::SimilarWindows,
        Part::Prior => measure().unwrap_or(Remedy::SharperPrior),
    }
}

/// How many times as long the operating points are to be held for a parameter to be identified, and the half-width then, as a fraction.
/// Noise falls with the root of the time, and the rest of the interval not at all. Nothing where residuals are not noise.
fn longer(parameter: Parameter, finding: &Finding) -> Option<(f64, f64)> {
    let uncertainty = &finding.uncertainty.parameters[parameter as usize];
    let value = finding.motor.get(parameter).abs();
    let (noise, rest) = (uncertainty.statistical, uncertainty.systematic.total());
    let allowed = IDENTIFIED * value / HALF_WIDTH;
    if finding.trust.correlation_of_neighbours > CORRELATED || rest > MOST_REST * allowed {
        return None;
    }
    // At least twice: by rounding of the allowed width it may be once.
    let times = (noise * noise / (allowed * allowed - rest * rest)).ceil().max(2.0);
    (times < MUCH_LONGER).then(|| (times, HALF_WIDTH * (noise / times.sqrt()).hypot(rest) / value))
}

fn is_any_negative(finding: &Finding) -> bool {
    finding.motor.to_array().iter().zip(finding.open).any(|(value, open)| !open && *value <= 0.0)
}

/// Longest lag, s, of voltages behind currents that is ordinary: two periods of a drive that controls at 10 kHz.
const LONGEST_LAG: f64 = 2e-4;

/// The lag of the voltages' frame, s, that makes an L_q come out as it is and a sign does not explain: L_q alone is negative, and
/// `psi_f omega_e lag` is what it seems to take of the voltage. A recorder's lag is solved for already.
fn lag_instead_of_sign(finding: &Finding) -> Option<f64> {
    let Motor { rs, ld, lq, psi_f } = finding.motor;
    let is_negative = |parameter: Parameter, value: f64| !finding.open[parameter as usize] && value < 0.0;
    let others = [(Parameter::Rs, rs), (Parameter::Ld, ld), (Parameter::PsiF, psi_f)];
    let fastest = finding.bench.held.iter().max_by(|(_, one), (_, other)| one.abs().total_cmp(&other.abs()));
    let (i, omega_e) = fastest.filter(|_| lq < 0.0 && !others.into_iter().any(|(parameter, value)| is_negative(parameter, value)))?;
    let lag = (lq * i.q / (psi_f * omega_e)).abs();
    (lag <= LONGEST_LAG && !recorder::is_period_of_recorder(finding.bench.sample_period)).then_some(lag)
}

/// The i_d, A, that the log has not: a step down from zero, or zero.
fn step(finding: &Finding) -> f64 {
    let current = finding.bench.current();
    if Common::of(&finding.bench).id_is_zero(current) { -STEP * current } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frames::Dq,
        identification::fit::{
            finding::{Bench, Trust},
            uncertainty::Uncertainty,
        },
    };

    const NOTHING: Beside = Beside { knows_rs: false, saturation: None };

    fn finding(motor: Motor, sample_period: f64) -> Finding {
        let bench = Bench {
            motor,
            covariance: nalgebra::Matrix4::zeros(),
            held: vec![(Dq { d: 0.0, q: 5.0 }, 2000.0)],
            row_variance: 0.0,
            sample_period,
            voltage: 20.0,
            voltage_accuracy: 1e-4,
            is_at_rest: false,
        };
        let uncertainty = Uncertainty { parameters: Default::default(), correlation: [[0.0; 4]; 4] };
        Finding { motor, uncertainty, open: [false, true, false, false], trust: Trust::default(), bench }
    }

    /// By hand: 100 uH at 5 A are the flux of 9 mWb turned by 0.0556 rad, 27.8 us at 2000 rad/s. A hundred times the inductance, a
    /// resistance that is negative too, and a recorder's log, whose lag is solved for, leave the signs.
    #[test]
    fn a_sign_is_not_suspected_where_a_lag_explains_it() {
        let motor = Motor { rs: 0.03, ld: 0.0, lq: -100e-6, psi_f: 9e-3 };
        let remedy = |motor, sample_period| of(&Reason::Negative, Parameter::Lq, &finding(motor, sample_period), NOTHING, || None);
        let Some(Remedy::CheckFrame { lag }) = remedy(motor, 1e-3) else { panic!("a lag explains it") };
        assert!((lag / 27.8e-6 - 1.0).abs() < 0.01, "{lag}");
        let signs = Some(Remedy::CheckSigns { units: false });
        assert_eq!(remedy(Motor { lq: -10e-3, ..motor }, 1e-3), signs);
        assert_eq!(remedy(Motor { rs: -0.03, ..motor }, 1e-3), signs);
        assert_eq!(remedy(motor, 0.1), signs);
    }

    /// What was given is not asked for again.
    #[test]
    fn a_resistance_that_is_given_is_no_remedy() {
        let finding = finding(Motor { rs: 0.03, ld: 1e-4, lq: 1e-4, psi_f: 9e-3 }, 1e-4);
        let wide = Reason::Wide { part: Part::DeadTime, beside: Vec::new(), half_width: 0.3 };
        for knows_rs in [false, true] {
            for reason in [&wide, &Reason::OnePoint] {
                let sentence = of(reason, Parameter::PsiF, &finding, Beside { knows_rs, ..NOTHING }, || None).unwrap().to_string();
                assert_eq!(sentence.contains("give R_s"), !knows_rs, "{sentence}");
            }
        }
    }

    /// A stretch at another i_d or a higher speed is none of a test at rest.
    #[test]
    fn at_rest_inductances_take_steps() {
        let mut finding = finding(Motor { rs: 0.03, ld: 1e-4, lq: 1e-4, psi_f: 9e-3 }, 1e-4);
        let noise = Reason::Wide { part: Part::Noise, beside: Vec::new(), half_width: 0.3 };
        let remedy = |reason: &Reason, finding: &Finding| of(reason, Parameter::Lq, finding, NOTHING, || None).unwrap();
        for reason in [&noise, &Reason::IdConstant, &Reason::OnePoint] {
            assert_ne!(remedy(reason, &finding), Remedy::StepCurrent { parameter: Parameter::Lq });
        }
        finding.bench.is_at_rest = true;
        for reason in [&noise, &Reason::IdConstant, &Reason::OnePoint] {
            assert_eq!(remedy(reason, &finding), Remedy::StepCurrent { parameter: Parameter::Lq });
        }
    }
}

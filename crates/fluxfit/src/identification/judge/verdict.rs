//! Verdicts: for each parameter one of three words.
//!
//! A verdict follows from the interval alone, and from what no motor has: a resistance, inductance or flux that is not positive
//! is never an answer.

use super::{
    super::{
        fit::{
            finding::{Finding, Trust},
            output_errors::CORRELATED,
            saturation::SaturationFinding,
            uncertainty::ParameterUncertainty,
        },
        request::{Known, Request},
    },
    reason::{self, Reason},
};
use crate::motor::{PARAMETERS, Parameter};

/// Largest half-width of the 95 % interval, as a fraction of the value, of a parameter that is identified.
pub const IDENTIFIED: f64 = 0.05;

/// The same of one that is weak.
pub const WEAK: f64 = 0.50;

/// How well a parameter is determined, by its 95 % interval. Its `Display` is its name; the
/// [`Reason`] beside it says why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Half the interval is at most 5 % of the value ([`IDENTIFIED`]); or the value was fixed.
    Identified,
    /// Half the interval is at most 50 % of the value ([`WEAK`]), or the model does not fit well enough for more.
    Weak,
    /// The log cannot tell: the interval is wider, the value is not positive, or the whole fit is not to be trusted.
    NotIdentifiable,
}

impl Verdict {
    /// The verdict of a name in files.
    pub fn of_key(key: &str) -> Option<Self> {
        [Self::Identified, Self::Weak, Self::NotIdentifiable].into_iter().find(|verdict| verdict.key() == key)
    }

    /// By half of the 95 % interval, as a fraction of a value that is positive.
    pub(crate) fn of_half_width(fraction: f64) -> Self {
        if fraction <= IDENTIFIED {
            Self::Identified
        } else if fraction <= WEAK {
            Self::Weak
        } else {
            Self::NotIdentifiable
        }
    }

    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::NotIdentifiable => "not-identifiable",
        }
    }
}

/// Simulated currents that miss by more than this part of the largest, and not by noise, are no motor's: voltages and currents do not
/// belong together. Dead time that takes four times what R_s does leaves 0.005.
const MISSES: f64 = 0.15;

/// The same where no parameter is told though the log excites them all: enough faults bend to anything, and miss less. Ten times what dead
/// time leaves.
const MISSES_AND_TELLS_NOTHING: f64 = 0.05;

/// One parameter with its verdict and the reason for it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judged {
    pub(crate) parameter: Parameter,
    /// The number that came out, SI.
    pub(crate) raw: f64,
    pub(crate) uncertainty: ParameterUncertainty,
    pub(crate) verdict: Verdict,
    pub(crate) reason: Option<Reason>,
}

impl Judged {
    /// Half of the 95 % interval as a fraction of the number.
    pub(crate) fn relative_half_width(&self) -> f64 {
        self.uncertainty.half_width / self.raw.abs()
    }
}

/// Judges every parameter of a finding; `is_short_circuit`: of a log without voltages.
pub(crate) fn judge(
    finding: &Finding,
    saturation: Option<&SaturationFinding>,
    request: &Request,
    is_short_circuit: bool,
) -> [Judged; PARAMETERS] {
    let uncertainty = match saturation {
        Some(saturation) => finding.uncertainty.clone().with_saturation(saturation.uncertainty(&finding.motor)),
        None => finding.uncertainty.clone(),
    };
    let mut judged = Parameter::ALL
        .map(|parameter| by_interval(parameter, finding, uncertainty.parameters[parameter as usize], request.known[parameter as usize]));
    if saturation.is_some_and(SaturationFinding::is_of_currents) {
        // No constant describes such a motor, however narrow the interval of one is; what is known beforehand stands, and so does an R_s
        // that asks for no form of the saturation.
        let is_known = |one: &Judged| request.known[one.parameter as usize] != Known::Nothing;
        let is_rs = |one: &Judged| one.parameter == Parameter::Rs && saturation.is_some_and(|saturation| saturation.tells_rs);
        let is_narrow = |one: &Judged| one.verdict == Verdict::Identified && one.reason.is_none();
        for one in judged.iter_mut().filter(|one| is_narrow(one) && !is_known(one) && !is_rs(one)) {
            (one.verdict, one.reason) = (Verdict::Weak, Some(Reason::Saturates));
        }
    }
    let Trust { correlation_of_neighbours: correlation, misses: fraction, .. } = finding.trust;
    let tells_nothing = finding.open == [false; PARAMETERS] && judged.iter().all(|one| one.verdict == Verdict::NotIdentifiable);
    let least = if tells_nothing { MISSES_AND_TELLS_NOTHING } else { MISSES };
    if correlation > CORRELATED && fraction > least {
        distrust_all(&mut judged, request, &Reason::CurrentsMissed { fraction });
    }
    if let Some(fault) = finding.trust.runaway {
        distrust_all(&mut judged, request, &Reason::RunawayFault { fault });
    }
    if let Some(too_high) = finding.trust.speed_too_high {
        distrust_all(&mut judged, request, &Reason::SpeedInDoubt { too_high });
    }
    distrust_if_impossible(&mut judged, finding.trust.least_inductance, request);
    // An inductance that is faster than the rows, beside currents that are missed, is no motor's either.
    let is_below_rows = |one: &Judged| matches!(one.reason, Some(Reason::BelowRows { .. }));
    if correlation > CORRELATED && fraction > MISSES_AND_TELLS_NOTHING && judged.iter().any(is_below_rows) {
        distrust_all(&mut judged, request, &Reason::CurrentsMissed { fraction });
    }
    // Where nothing is told anyway, the reason there says more.
    let is_told = |one: &Judged| one.verdict != Verdict::NotIdentifiable && one.reason != Some(Reason::Given);
    if finding.trust.too_sharp && judged.iter().any(is_told) {
        distrust_all(&mut judged, request, &Reason::SharperThanNoise);
    }
    // Zero times any motor fits as well, and a prior does not hold against equations without any voltage error.
    if is_short_circuit && !request.known.iter().any(|known| matches!(known, Known::Fixed(_))) {
        distrust_all(&mut judged, request, &Reason::ShortCircuit);
    }
    judged
}

fn by_interval(parameter: Parameter, finding: &Finding, uncertainty: ParameterUncertainty, known: Known) -> Judged {
    let raw = finding.motor.get(parameter);
    let verdict = match known {
        Known::Fixed(_) => Verdict::Identified,
        _ if raw <= 0.0 => Verdict::NotIdentifiable,
        _ => Verdict::of_half_width(uncertainty.half_width / raw.abs()),
    };
    let reason = match (known, verdict) {
        (Known::Fixed(_), _) => Some(Reason::Given),
        (_, Verdict::Identified) => None,
        _ => Some(reason::of(parameter, finding, &uncertainty, WEAK)),
    };
    Judged { parameter, raw, uncertainty, verdict, reason }
}

/// If one parameter came out negative, and not by noise, or as an inductance with which the current would settle within a part of a row,
/// the others come from the same wrong fit.
fn distrust_if_impossible(judged: &mut [Judged; PARAMETERS], least_inductance: f64, request: &Request) {
    let is_negative = |one: &Judged| one.raw <= 0.0 && one.uncertainty.half_width < WEAK * one.raw.abs();
    let is_below_rows = |one: &Judged| {
        let is_told = one.verdict != Verdict::NotIdentifiable && !matches!(request.known[one.parameter as usize], Known::Fixed(_));
        is_told && matches!(one.parameter, Parameter::Ld | Parameter::Lq) && one.raw < least_inductance
    };
    let negative = judged.iter().find(|one| is_negative(one)).cloned();
    let below_rows = || judged.iter().find(|one| is_below_rows(one)).cloned();
    let of_rows = |one: Judged| Judged { reason: Some(Reason::BelowRows { least: least_inductance }), ..one };
    if let Some(Judged { parameter, reason, .. }) = negative.or_else(|| below_rows().map(of_rows)) {
        distrust_all(judged, request, &Reason::OtherImpossible { parameter });
        judged[parameter as usize].reason = reason;
    }
}

/// Takes back every parameter that was not given.
fn distrust_all(judged: &mut [Judged], request: &Request, reason: &Reason) {
    for (one, known) in judged.iter_mut().zip(&request.known) {
        if !matches!(known, Known::Fixed(_)) {
            (one.verdict, one.reason) = (Verdict::NotIdentifiable, Some(reason.clone()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        faults::Fault,
        identification::fit::{
            finding::Bench,
            uncertainty::{Systematic, Uncertainty},
        },
        motor::Motor,
    };

    const MOTOR: Motor = Motor { rs: 0.5, ld: 2e-3, lq: 3e-3, psi_f: 0.05 };

    /// A motor whose numbers have half-widths of 1 %.
    fn judged(motor: Motor, trust: Trust, request: &Request) -> [Judged; PARAMETERS] {
        let parameters = motor.to_array().map(|value| ParameterUncertainty::of(0.01 * value / 1.96, 1e6, Systematic::default()));
        let bench = Bench {
            motor,
            covariance: nalgebra::Matrix4::zeros(),
            held: Vec::new(),
            row_variance: 0.0,
            sample_period: 1e-4,
            voltage: 20.0,
            voltage_accuracy: 1e-4,
            is_at_rest: false,
        };
        let uncertainty = Uncertainty { parameters, correlation: [[0.0; PARAMETERS]; PARAMETERS] };
        let finding = Finding { motor, uncertainty, open: [false; PARAMETERS], trust, bench };
        judge(&finding, None, request, false)
    }

    /// 25 uH with 0.5 ohm settle within half of 100 us: an L_q of 10 uH is none, and the rest of that fit no answer; but whoever states it
    /// knows it, and the same number of operating points, which rows do not limit, stands.
    #[test]
    fn an_inductance_that_no_row_could_show_takes_its_fit_with_it() {
        let trust = Trust { least_inductance: 25e-6, ..Trust::default() };
        let small = Motor { lq: 10e-6, ..MOTOR };
        let verdicts = |found: &[Judged; PARAMETERS]| found.each_ref().map(|one| one.verdict);
        assert_eq!(verdicts(&judged(MOTOR, trust, &Request::default())), [Verdict::Identified; PARAMETERS]);
        assert_eq!(verdicts(&judged(small, Trust::default(), &Request::default())), [Verdict::Identified; PARAMETERS]);
        let found = judged(small, trust, &Request::default());
        assert_eq!(verdicts(&found), [Verdict::NotIdentifiable; PARAMETERS]);
        assert_eq!(found[Parameter::Lq as usize].reason, Some(Reason::BelowRows { least: 25e-6 }));
        assert_eq!(found[Parameter::Rs as usize].reason, Some(Reason::OtherImpossible { parameter: Parameter::Lq }));
        let mut stated = Request::default();
        stated.known[Parameter::Lq as usize] = Known::Fixed(10e-6);
        assert_eq!(verdicts(&judged(small, trust, &stated)), [Verdict::Identified; PARAMETERS]);
    }

    /// As sharp as the others look.
    #[test]
    fn a_fault_that_no_drive_has_takes_its_fit_with_it() {
        let trust = Trust { runaway: Some(Fault::DqFilter), ..Trust::default() };
        let mut request = Request::default();
        request.known[Parameter::Lq as usize] = Known::Fixed(3e-3);
        for one in judged(MOTOR, trust, &request) {
            let expected = match one.parameter {
                Parameter::Lq => (Verdict::Identified, Reason::Given),
                _ => (Verdict::NotIdentifiable, Reason::RunawayFault { fault: Fault::DqFilter }),
            };
            assert_eq!((one.verdict, one.reason), (expected.0, Some(expected.1)));
        }
    }

    /// Its slopes mean nothing, and so do intervals from them.
    #[test]
    fn a_fit_sharper_than_its_noise_tells_nothing() {
        for one in judged(MOTOR, Trust { too_sharp: true, ..Trust::default() }, &Request::default()) {
            assert_eq!((one.verdict, one.reason), (Verdict::NotIdentifiable, Some(Reason::SharperThanNoise)));
        }
    }
}

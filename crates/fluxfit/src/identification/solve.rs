//! The path of an identification, a step a line: prepare, fit, judge, explain.

use super::{
    explain::{
        judgement::{Judgement, explained},
        left_out::{self, LeftOut},
        temperature::AtTemperature,
        trial::{Losses, Trials},
        unseen::{self, Counted, Unseen},
        warning::{self, Evidence, Warning},
    },
    fit::{
        common_gains,
        finding::Finding,
        output::OutputFit,
        output_excitation,
        saturation::SaturationFinding,
        speed_scale::SpeedScale,
        steady::SteadyFit,
        swarm::{self, Search},
    },
    judge::{
        points_tell_more::{Points, is_narrower, points_tell_more},
        priors::{self, Contradiction},
        verdict::{Judged, Verdict, judge},
    },
    prepare::{
        model::{self, Model, ModelChoice, ModelReason},
        search_box, standstill, stretches,
    },
    progress::{Progress, Step, silent},
    request::{Known, Request},
};
use crate::{
    column_check::speed_in_doubt,
    error::{Error, ErrorKind},
    faults::{Fault, Faults},
    log::Log,
    motor::{PARAMETERS, Parameter},
    optimizer::Method,
    steady::OperatingPoint,
};

/// What a log says of its motor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Identification {
    /// The four parameters, in the order of [`Parameter::ALL`].
    pub parameters: [Judgement; PARAMETERS],
    /// The model that answered, and why it did.
    pub model: ModelChoice,
    /// The fit of the steady operating points; `None` where the log has none.
    pub steady: Option<SteadyFit>,
    /// The fit of the simulated currents; `None` where the steady model answered.
    pub output: Option<OutputFit>,
    /// Flux at the operating points, where inductances depend on the current; `None` where nothing says so.
    pub saturation: Option<SaturationFinding>,
    /// Correlation of the parameters' errors, rows and columns in the order of [`Parameter::ALL`].
    pub correlation: [[f64; PARAMETERS]; PARAMETERS],
    /// The swarm that was asked to search, if any.
    pub method: Option<Method>,
    /// The swarm's own answer, for comparison; `None` if no swarm searched.
    pub search: Option<Search>,
    /// The winding's temperature, and what R_s and psi_f are at 20 degrees; `None` where the log has no temperature.
    pub temperature: Option<AtTemperature>,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
    /// Errors that no log shows and no interval counts.
    pub unseen: Vec<Unseen>,
    /// Errors that no log shows either, and that the intervals count, because their size is stated.
    pub counted: Vec<Counted>,
    /// Rows that the answer does not rest on, in the order of rows.
    pub left_out: Vec<LeftOut>,
}

impl Identification {
    /// One parameter's judgement.
    pub fn parameter(&self, parameter: Parameter) -> &Judgement {
        &self.parameters[parameter as usize]
    }

    /// The log's operating points; empty where currents and speed are never constant.
    pub fn operating_points(&self) -> &[OperatingPoint] {
        self.steady.as_ref().map_or(&[], |fit| &fit.operating_points)
    }

    /// Errors that no log shows and no interval counts, and what they do to the parameters that have a value.
    pub fn unseen_in_values(&self) -> Vec<Unseen> {
        let has_value = self.parameters.each_ref().map(|judgement| judgement.value().is_some());
        self.unseen.iter().filter_map(|unseen| unseen.of(has_value)).collect()
    }

    /// Whether the verdict on every parameter is [`Verdict::Identified`], as it is on a fixed one.
    pub fn is_complete(&self) -> bool {
        self.parameters.iter().all(|judgement| judgement.verdict == Verdict::Identified)
    }
}

/// Identifies the motor of a log.
///
/// # Errors
/// If a value of the request is out of range, or no steady operating point is found. A log that cannot tell some parameter is no error:
/// the verdicts say so.
pub(crate) fn solve(log: &Log, request: &Request, progress: Progress) -> Result<Identification, Error> {
    request.check()?;
    let Fitted { model, steady, output, outvoted, saturation, speed } = fitted(log, request, None, progress)?;
    let finding = finding(steady.as_ref(), output.as_ref())?;
    let mut judged = judge(finding, saturation.as_ref(), request, log.is_short_circuit());
    let points = steady.as_ref().map_or(&[][..], |fit| &fit.operating_points);
    let known = output.as_ref().or(outvoted.as_ref());
    let contradictions = doubt_priors(&mut judged, log, request, known);
    let half_widths = |log: &Log, request: &Request| judged_again(log, request, known).map(half_widths);
    let rs_error = finding.uncertainty.parameters[Parameter::Rs as usize].standard_error();
    let trials = Trials::new((log, request), &finding.bench, points, losses(steady.as_ref(), output.as_ref()), rs_error, &half_widths);
    let parameters = explained(judged, finding, saturation.as_ref(), request, Some(trials));
    let method = swarm::method(request, model.model);
    let search = method.map(|method| search(log, steady.as_ref(), output.as_ref(), method, request, progress)).transpose()?;
    let evidence = Evidence {
        log,
        request,
        parameters: &parameters,
        steady: steady.as_ref(),
        output: output.as_ref(),
        saturation: saturation.as_ref(),
        search: search.as_ref(),
        contradictions: &contradictions,
    };
    let warnings = warning::all(&evidence);
    let correlation = finding.uncertainty.correlation;
    let verdicts = parameters.each_ref().map(|judgement| judgement.verdict);
    let (unseen, counted) = (unseen::all(log, finding, verdicts, speed, request), unseen::counted(verdicts, request));
    let temperature = AtTemperature::of(log, &parameters, steady.as_ref(), output.as_ref(), request);
    let left_out = left_out::all(log, request, steady.as_ref(), output.as_ref());
    Ok(Identification {
        parameters,
        model,
        steady,
        output,
        saturation,
        correlation,
        method,
        search,
        temperature,
        warnings,
        unseen,
        counted,
        left_out,
    })
}

/// What the fits come to.
struct Fitted {
    model: ModelChoice,
    steady: Option<SteadyFit>,
    output: Option<OutputFit>,
    /// The simulated currents, where operating points tell more: what was found of the drive stands.
    outvoted: Option<OutputFit>,
    saturation: Option<SaturationFinding>,
    speed: SpeedScale,
}

/// Prepares and fits; what is known of the drive from another log is not looked for.
fn fitted(log: &Log, request: &Request, known: Option<&OutputFit>, progress: Progress) -> Result<Fitted, Error> {
    let _ = progress(Step::OperatingPoints);
    let steady = SteadyFit::of(log, request);
    if log.has_no_speed() && steady.as_ref().is_ok_and(|fit| !standstill::voltages_lie_along_currents(&fit.as_measured)) {
        return Err(Error::no_speed());
    }
    let model = model::choose(log, request.model);
    let points_tell_more = ModelChoice { model: Model::Steady, reason: ModelReason::PointsTellMore };
    let (model, mut steady, mut output) = match model.model {
        Model::Steady => (model, Some(steady?), None),
        Model::OutputError => {
            log.refuse_short_circuit()?;
            let steady = steady.ok();
            match OutputFit::of(log, steady.as_ref(), request, known, progress) {
                // Where no simulation stays finite, points still tell what they do, with an angle that may be off.
                Err(error) if *error.kind() == ErrorKind::NoFiniteFit && request.model.is_none() && steady.is_some() => {
                    (points_tell_more, Some(SteadyFit::with_drive_in_doubt(log, request, 0.0)?), None)
                }
                output => (model, steady, Some(output?)),
            }
        }
    };
    let is_simulated = model.model == Model::OutputError;
    let points_answer = by_excitation(log, &mut steady, output.as_mut(), request)?;
    let (model, mut output, outvoted) = if points_answer { (points_tell_more, None, output) } else { (model, output, None) };
    let saturation = saturation(log, steady.as_ref(), output.as_ref(), request);
    let finding = output.as_mut().map(|fit| &mut fit.finding).or(steady.as_mut().map(|fit| &mut fit.finding));
    if let (Some(finding), Some(found)) = (finding, saturation.as_ref().filter(|found| found.tells_rs)) {
        finding.answer_rs(found.rs, found.rs_uncertainty);
    }
    // Of a drive that is known the other log has told it.
    let simulated = output.as_ref().or(outvoted.as_ref()).filter(|_| known.is_none());
    let speed = simulated.map_or(SpeedScale::Untold, |fit| SpeedScale::of(log, fit, points_answer, request));
    let is_asked = is_simulated && request.model.is_none() && known.is_none();
    if let Some(too_high) = is_asked.then(|| speed_too_high(log, speed, output.as_ref())).flatten() {
        let finding = output.as_mut().map(|fit| &mut fit.finding).or(steady.as_mut().map(|fit| &mut fit.finding));
        finding.into_iter().for_each(|finding| finding.trust.speed_too_high = Some(too_high));
    }
    // Only now: what all sensors share decides neither the model nor the value.
    common_gains::count(log, steady.as_mut(), output.as_mut(), request)?;
    Ok(Fitted { model, steady, output, outvoted, saturation, speed })
}

/// The parameters that another log, or another request, comes to, of a drive that is `known`; nothing if there is no answer.
fn judged_again(log: &Log, request: &Request, known: Option<&OutputFit>) -> Option<[Judged; PARAMETERS]> {
    let Fitted { steady, output, saturation, .. } = fitted(log, request, known, &silent).ok()?;
    let finding = finding(steady.as_ref(), output.as_ref()).ok()?;
    Some(judge(finding, saturation.as_ref(), request, log.is_short_circuit()))
}

/// Half-widths of parameters as fractions of their values, infinite where there is no value.
fn half_widths(judged: [Judged; PARAMETERS]) -> [f64; PARAMETERS] {
    judged.map(|one| if one.verdict == Verdict::NotIdentifiable { f64::INFINITY } else { one.relative_half_width() })
}

/// The priors that the log contradicts, which take the word "identified" back from what they move.
fn doubt_priors(answers: &mut [Judged; PARAMETERS], log: &Log, request: &Request, known: Option<&OutputFit>) -> Vec<Contradiction> {
    let is_prior = |parameter: &Parameter| matches!(request.known[*parameter as usize], Known::Prior { .. });
    let found = Parameter::ALL.into_iter().filter(is_prior).filter_map(|parameter| {
        let mut without = request.clone();
        without.known[parameter as usize] = Known::Nothing;
        let alone = judged_again(log, &without, known);
        let found = priors::contradiction(&answers[parameter as usize], alone.as_ref(), request)?;
        priors::doubt(answers, &found, alone.as_ref());
        Some(found)
    });
    found.collect()
}

/// What stands between the log and its motor, by the model that answers.
fn losses(steady: Option<&SteadyFit>, output: Option<&OutputFit>) -> Losses {
    match output {
        Some(fit) => {
            let is_certain = fit.possible_timings().count() <= 1;
            Losses { faults: fit.drive.faults, along_current: 0.0, timing: is_certain.then_some(fit.voltage_timing.value) }
        }
        None => {
            let along_current = steady.and_then(|fit| fit.estimate.loss).map_or(0.0, |(volts, _)| volts);
            Losses { faults: Faults::default(), along_current, timing: None }
        }
    }
}

/// Whether the operating points answer, because they tell more and no model is stated; else what the simulated currents leave open is left
/// out of their fit. Points that answer beside currents of an unknown fault do so with an angle that may be off.
fn by_excitation(log: &Log, steady: &mut Option<SteadyFit>, output: Option<&mut OutputFit>, request: &Request) -> Result<bool, Error> {
    let Some(output) = output else { return Ok(false) };
    let of_points = steady.as_ref().map_or([false; PARAMETERS], |points| points.left_open(request));
    // Operating points that tell all parameters excite the currents as well.
    let is_doubtful = steady.is_none() || of_points.contains(&true);
    let open = if is_doubtful { output_excitation::open(log, output, &of_points, request)? } else { [false; PARAMETERS] };
    if let Some(points) = steady.as_mut().filter(|_| request.model.is_none()) {
        match points_tell_more(points, output, &open, !log.is_control_rate(), request) {
            Points::TellMore => return Ok(true),
            Points::AreNarrower => {
                let in_doubt = SteadyFit::with_drive_in_doubt(log, request, output.unexplained_loss)?;
                if is_narrower(&in_doubt, output, request) {
                    *points = in_doubt;
                    return Ok(true);
                }
            }
            Points::TellLess => {}
        }
    }
    output.finding.leave_open(&open, &output_excitation::reach(log, output, request));
    Ok(false)
}

/// By which factors the speed may be too high, the least and the largest: where the simulated currents follow with another speed alone; or
/// where the slopes of the currents ask for another one and the simulated currents do not follow without an observer, which makes them
/// follow whatever it is; or only beside saturation, which makes inductances of slopes smaller than those of the speed: such terms may
/// stand in for a speed that is too high.
fn speed_too_high(log: &Log, speed: SpeedScale, output: Option<&OutputFit>) -> Option<[f64; 2]> {
    let by_currents = if let SpeedScale::TooHigh(too_high) = speed { Some(too_high) } else { None };
    let follows = output.is_some_and(|fit| fit.is_explained() && fit.drive.faults.disturbance.is_small());
    let saturates = output.is_some_and(|fit| fit.has(Fault::Saturation));
    let by_slopes = || if log.is_control_rate() && (!follows || saturates) { speed_in_doubt(log) } else { None };
    by_currents.or_else(|| by_slopes().filter(|[least, _]| !follows || *least > 1.0))
}

/// The finding of the model that answers.
fn finding<'a>(steady: Option<&'a SteadyFit>, output: Option<&'a OutputFit>) -> Result<&'a Finding, Error> {
    output.map(|fit| &fit.finding).or(steady.map(|fit| &fit.finding)).ok_or_else(Error::no_rows)
}

/// Saturation: found by the operating points, by the terms of the simulated currents, or by both.
fn saturation(log: &Log, steady: Option<&SteadyFit>, output: Option<&OutputFit>, request: &Request) -> Option<SaturationFinding> {
    let of_points = || steady.and_then(|fit| fit.saturation(request));
    let Some(fit) = output else { return of_points() };
    if !fit.has(Fault::Saturation) {
        // The simulated currents know the drive's faults, which the points may take for saturation; where they leave noise, there is none.
        let agrees = || steady.is_some_and(|points| points.agrees_in_frame_of(log, &fit.drive, request));
        return if fit.is_explained() || !fit.leaves_something() || agrees() { None } else { of_points() };
    }
    let of_currents = (fit.drive.motor.rs, fit.finding.uncertainty.parameters[Parameter::Rs as usize].standard_error());
    // Points of one current at several speeds may tell R_s better than a few terms of saturation do.
    let in_doubt = SteadyFit::with_drive_in_doubt(log, request, fit.unexplained_loss).ok();
    let of_speeds = in_doubt.and_then(|points| points.rs_of_speeds(request)).filter(|of_speeds| of_speeds.1 < of_currents.1);
    let points = steady.map_or(&[][..], |fit| &fit.operating_points);
    let (rs, tells_rs) = (of_speeds.unwrap_or(of_currents), of_speeds.is_some());
    let mut found = SaturationFinding::of_currents(log, &fit.drive, (rs, &fit.fault_estimates), &fit.stretches, points, request);
    found.tells_rs = tells_rs;
    Some(found)
}

/// The swarm's search of the same cost that the answering model minimized.
fn search(
    log: &Log,
    steady: Option<&SteadyFit>,
    output: Option<&OutputFit>,
    method: Method,
    request: &Request,
    progress: Progress,
) -> Result<Search, Error> {
    let whole = |fit: &OutputFit| stretches::as_points(log, &fit.stretches);
    let points = steady.map(|fit| fit.as_measured.clone()).or(output.map(whole)).unwrap_or_default();
    let bounds = request.search_box(&search_box::from_points(&points)?)?;
    match (output, steady) {
        (Some(fit), _) => fit.search(log, method, bounds, request, progress),
        (None, Some(fit)) => fit.search(method, bounds, request, progress),
        (None, None) => Err(Error::no_rows()),
    }
}

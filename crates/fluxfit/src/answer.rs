//! The whole answer: one call, [`identify`], does everything that is asked of a log. Every face shows the [`Answer`] and adds nothing
//! but looks.

use crate::{
    current_loop::{CurrentLoop, control_rate},
    error::{Error, ErrorKind},
    identification::{
        explain::{
            conventions::{self, Convention},
            judgement::{Judgement, explained},
            warning::Warning,
        },
        fit::steady::SteadyFit,
        judge::verdict::judge,
        progress::{Progress, Step, silent},
        request::Request,
        solve::{Identification, solve},
    },
    log::Log,
    motor::Parameter,
    optimizer::StopReason,
    validation::{
        given::Given,
        validate::{Validation, validate_with_progress},
    },
};

/// Everything that a log and a request give.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Answer {
    /// The rows that were identified from: the log, less what was [held out](Request::hold_out).
    pub log: Log,
    /// The parameters, how they were found, and the warnings.
    pub identification: Identification,
    /// The answer compared with the [nameplate](Request::nameplate); without one, nothing is compared.
    pub convention: Convention,
    /// Gains of the current controllers, where a [bandwidth](Request::bandwidth) was asked for.
    pub current_loop: Option<CurrentLoop>,
    /// What was [held out](Request::hold_out), where that was asked for.
    pub held_out: Option<HeldOut>,
}

/// A part of the log that the answer was not found from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct HeldOut {
    /// Its rows.
    pub log: Log,
    /// How well the answer predicts it; `None` where a parameter of the answer is not identifiable.
    pub validation: Option<Validation>,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{error}")]
#[non_exhaustive]
pub struct IdentificationError {
    /// What went wrong.
    pub error: Error,
    /// What may be behind it: units of the log that do not agree with the [nameplate](Request::nameplate). `None` where they agree or
    /// cannot be compared.
    pub suspected_units: Option<Warning>,
}

impl IdentificationError {
    /// What went wrong, for programs.
    pub fn kind(&self) -> &ErrorKind {
        self.error.kind()
    }
}

impl From<IdentificationError> for Error {
    fn from(error: IdentificationError) -> Self {
        error.error
    }
}

impl Answer {
    /// One parameter. All four are in `self.identification.parameters`, in the order of [`Parameter::ALL`].
    pub fn parameter(&self, parameter: Parameter) -> &Judgement {
        self.identification.parameter(parameter)
    }

    /// All four, in the order of [`Parameter::ALL`].
    pub fn parameters(&self) -> &[Judgement] {
        &self.identification.parameters
    }

    /// Stator resistance, ohm.
    pub fn rs(&self) -> &Judgement {
        self.parameter(Parameter::Rs)
    }

    /// Inductance of the d axis, H.
    pub fn ld(&self) -> &Judgement {
        self.parameter(Parameter::Ld)
    }

    /// Inductance of the q axis, H.
    pub fn lq(&self) -> &Judgement {
        self.parameter(Parameter::Lq)
    }

    /// Flux linkage of the magnets, Wb, peak per phase.
    pub fn psi_f(&self) -> &Judgement {
        self.parameter(Parameter::PsiF)
    }

    /// What the reader should know of the log and the answer as a whole, whatever the verdicts on single parameters.
    pub fn warnings(&self) -> &[Warning] {
        &self.identification.warnings
    }

    /// Whether the verdict on every parameter is [`Verdict::Identified`](crate::Verdict::Identified), as it is on a fixed one.
    pub fn is_complete(&self) -> bool {
        self.identification.is_complete()
    }
}

/// Identifies a motor from a log.
///
/// # Errors
/// If a value of the request is out of range, or the log has no rows that the model could fit
/// ([`NoOperatingPoint`](ErrorKind::NoOperatingPoint), [`Window`](ErrorKind::Window)); [`ErrorKind`] lists every case. A log that cannot
/// tell some parameter is no error: its [`Judgement`] says so, with reason and remedy.
pub fn identify(log: &Log, request: &Request) -> Result<Answer, IdentificationError> {
    identify_with_progress(log, request, &silent)
}

/// [`identify`], with a callback that is told each step as it begins and can stop the search of a swarm.
///
/// # Errors
/// As [`identify`].
pub fn identify_with_progress(log: &Log, request: &Request, progress: Progress) -> Result<Answer, IdentificationError> {
    answer(log, request, progress).map_err(|error| IdentificationError { error, suspected_units: suspect_units(log, request) })
}

fn answer(log: &Log, request: &Request, progress: Progress) -> Result<Answer, Error> {
    let (log, held_out) = if request.hold_out {
        let (rest, last) = log.part_last().ok_or(ErrorKind::NothingToHoldOut)?;
        (rest, Some(last))
    } else {
        (log.clone(), None)
    };
    // What cannot be computed is refused before anything is.
    let control_rate = request.bandwidth.map(|bandwidth| Ok::<_, Error>((bandwidth, control_rate(&log, request)?))).transpose()?;
    let mut identification = solve(&log, request, progress)?;
    let _ = progress(Step::Nameplate);
    let convention = compare_with_nameplate(&log, &identification, request);
    if !convention.agrees() {
        identification.warnings.push(Warning::Convention(Box::new(convention.clone())));
    }
    let gains = |(bandwidth, rate)| CurrentLoop::of(&identification.parameters, bandwidth, rate);
    let current_loop = control_rate.map(gains).transpose()?;
    identification.warnings.extend(current_loop.as_ref().and_then(CurrentLoop::warning));
    identification.warnings.extend(interrupted(&identification, request));
    let held_out = held_out.map(|rows| predict(rows, &identification, request, progress)).transpose()?;
    Ok(Answer { log, identification, convention, current_loop, held_out })
}

/// A warning if a log's units look wrong beside the nameplate: the flux linkage that the rows suggest is compared with the nameplate's.
fn suspect_units(log: &Log, request: &Request) -> Option<Warning> {
    let convention = conventions::compare_with_nameplate(log, None, &request.nameplate);
    (!convention.agrees()).then(|| Warning::Convention(Box::new(convention)))
}

/// Compares the operating points' answer with the nameplate: wrong units scale that answer alone, because in simulated currents the slope
/// of a current shows the unit of time.
fn compare_with_nameplate(log: &Log, found: &Identification, request: &Request) -> Convention {
    let of_points = found.steady.as_ref().filter(|_| found.output.is_some());
    let judged = |fit: &SteadyFit| judge(&fit.finding, fit.saturation(request).as_ref(), request, log.is_short_circuit());
    let of_points = of_points.map(|fit| explained(judged(fit), &fit.finding, None, request, None));
    conventions::compare_with_nameplate(log, Some((of_points.as_ref().unwrap_or(&found.parameters), &request.known)), &request.nameplate)
}

fn interrupted(found: &Identification, request: &Request) -> Option<Warning> {
    let report = &found.search.as_ref()?.report;
    (report.stop_reason == StopReason::Interrupted)
        .then(|| Warning::Interrupted { iterations: report.history.len() - 1, limit: request.search.iterations })
}

/// Predicts what was held out; if the answer lacks a parameter, nothing is predicted.
fn predict(log: Log, found: &Identification, request: &Request, progress: Progress) -> Result<HeldOut, Error> {
    let _ = progress(Step::Validation);
    let request = Request { windows: Vec::new(), ..request.clone() };
    let validation = Given::of(found).map(|given| validate_with_progress(&log, &given, &request, &silent)).transpose()?;
    Ok(HeldOut { log, validation })
}

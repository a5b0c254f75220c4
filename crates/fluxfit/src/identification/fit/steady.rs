//! What the steady model makes of a log: equation (2) on the means of steady windows, for which weighted least squares is exact.

use super::{
    super::{
        progress::Progress,
        request::{Known, Provenance, Request, Resolved, VOLTAGE_ACCURACY},
    },
    coasting,
    estimate::Estimate,
    excitation::Excitation,
    finding::{Bench, Finding, Trust, covariance},
    frame_angle::{self, FrameAngle},
    frame_free,
    frame_lag::{self, FrameLag},
    misfit::{self, Misfit},
    open_loop,
    resistance_of_speeds::{self, Resistance},
    saturation::{SaturationFinding, in_magnets_frame},
    swarm::{self, Search},
    uncertainty::Uncertainty,
    voltage_loss::{Loss, LossPrior},
    warming::Warming,
};
use crate::{
    error::Error,
    faults::dead_time::ripple::{self, Harmonic},
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::adjustable::Adjustable,
    optimizer::{Bounds, Method},
    steady::{
        OperatingPoint, PreliminaryEstimate, recorder, windows,
        zero_order_hold::{MAX_ANGLE_PER_SAMPLE, MAX_DECAY_PER_SAMPLE, SteadyVoltageTiming, ZeroOrderHold},
    },
};
use std::ops::Range;

/// An inductance whose interval is wider than this part of it is not told.
const TOLD: f64 = 0.5;

/// The operating points, and the motor that they ask for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SteadyFit {
    /// The windows that carried it.
    pub operating_points: Vec<OperatingPoint>,
    /// Least squares, solved exactly.
    pub estimate: Estimate,
    /// What they excite.
    pub excitation: Excitation,
    /// The timing of the voltage columns, stated or assumed.
    pub voltage_timing: Resolved<SteadyVoltageTiming>,
    /// Contradiction between the operating points, if proven.
    pub misfit: Option<Misfit>,
    /// What dead time or device drops seem to take from each operating point's voltage along its current, V; zero where nothing is seen.
    pub voltage_losses: Vec<f64>,
    /// The lag of the voltages' frame behind that of the currents; none but in a recorder's log.
    pub frame_lag: Option<FrameLag>,
    /// Rows of the operating points in open-loop operation, which tell the resistance only.
    pub open_loop: Vec<Range<usize>>,
    /// The change of R_s while the log was taken, which is that in its middle; none where it was not asked for.
    pub warming: Option<Warming>,
    /// What it comes to.
    pub finding: Finding,
    /// What is known of the losses of dead time and devices before the points are solved.
    pub(crate) loss_prior: LossPrior,
    /// What dead time and devices may take, as it was fitted beside the motor.
    pub(crate) losses: Vec<Loss>,
    /// With what may be wrong beside a motor that saturates.
    possible_losses: Vec<Loss>,
    /// R_s and these, however the flux depends on the current; none where the points do not tell it, or agree on constants.
    rs_of_speeds: Option<Resistance>,
    /// Whether the points tell an angle that is off or late, where it was among the unknowns.
    pub(crate) tells_angle: Option<bool>,
    /// The operating points before any correction.
    pub(crate) as_measured: Vec<OperatingPoint>,
}

impl SteadyFit {
    /// Finds the operating points and solves them, at the angle as it is and a resistance that stays where every period of the drive is in
    /// the log: simulated currents see there what is wrong with that.
    ///
    /// # Errors
    /// If there is none.
    pub fn of(log: &Log, request: &Request) -> Result<Self, Error> {
        Self::solved(log, request, InDoubt { angle_and_winding: !log.is_control_rate(), loss: 0.0 })
    }

    /// The same of points that answer because simulated currents do not explain the log: its angle may be off, and its winding may warm, at
    /// any rate of the rows; so may what dead time takes from each point differ from its unknowns, by so many volts.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn with_drive_in_doubt(log: &Log, request: &Request, loss: f64) -> Result<Self, Error> {
        Self::solved(log, request, InDoubt { angle_and_winding: true, loss })
    }

    fn solved(log: &Log, request: &Request, in_doubt: InDoubt) -> Result<Self, Error> {
        let (as_measured, frames) = frames(log, operating_points(log, request)?, request);
        let (mut unturned, mut other_timing) = measure(log, &as_measured, request);
        if recorder::is_recorders(log) {
            for points in [Some(&mut unturned), other_timing.as_mut()].into_iter().flatten() {
                recorder::pool_noise(points, windows::least_current(log));
            }
        }
        let angle = FrameAngle::possible(log, request).filter(|_| in_doubt.angle_and_winding);
        let solved = match &frames {
            // Of a recorder's log everything is in doubt, and simulated currents tell nothing of its dead time.
            Some(frames) => solve_at_lag(log, (&unturned, other_timing.as_deref()), frames, request),
            None => solve_at_angle(log, &unturned, angle, in_doubt, request),
        };
        let Solved {
            points,
            excitation,
            harmonics,
            loss_prior,
            losses,
            possible_losses,
            estimate,
            misfit,
            lag,
            at_another_angle,
            tells_angle,
            warming,
        } = solved;
        let timing_doubt = match &other_timing {
            // Of a recorder's log it is one of the unknowns.
            Some(other) if lag.is_none() => timing_doubt(&unturned, other, request),
            _ => [0.0; PARAMETERS],
        };
        let mut uncertainty = Uncertainty::of(&points, &excitation, &estimate, misfit.as_ref(), &timing_doubt);
        if lag.is_some() {
            let psi_f = &mut uncertainty.parameters[Parameter::PsiF as usize];
            *psi_f = psi_f.with_min_half_width(frame_free::scatter(&points, &estimate.motor));
            let lq = &mut uncertainty.parameters[Parameter::Lq as usize];
            lq.systematic.frame_lag = lq.systematic.frame_lag.hypot(FrameLag::spread(&points, estimate.motor.psi_f));
            *lq = lq.anew();
        }
        if let Some(other) = at_another_angle {
            for (parameter, one) in Parameter::ALL.into_iter().zip(&mut uncertainty.parameters) {
                // Either is as likely as the other.
                let moves = other.get(parameter) - estimate.motor.get(parameter);
                *one = one.with_angle_in_doubt(moves.abs() / 2.0_f64.sqrt());
            }
        }
        let of_angle = angle.filter(|_| misfit.is_some()).map(|angle| angle.unknowns(&points, &estimate.motor));
        let possible_losses: Vec<Loss> = possible_losses.into_iter().chain(of_angle.into_iter().flatten()).collect();
        let rs_of_speeds = misfit.and_then(|_| {
            let accuracy = |point: &OperatingPoint| (request.voltage_accuracy * point.voltage().magnitude()).hypot(in_doubt.loss);
            let of =
                |points: &[OperatingPoint]| resistance_of_speeds::resistance(points, &possible_losses, &estimate.motor, accuracy, request);
            let found = of(&points)?;
            // A recorder's timing is among the unknowns of its lag.
            match other_timing.as_deref().filter(|_| lag.is_none()) {
                Some(other) => Some(found.or_as(&of(other)?)),
                None => Some(found),
            }
        });
        let finding = Finding {
            motor: estimate.motor,
            open: Parameter::ALL.map(|parameter| excitation.is_open(parameter)),
            trust: Trust { repeated_values: recorder::is_recorders(log) && recorder::repeats_values(log), ..Trust::default() },
            bench: bench(log, &points, &excitation, &estimate, &uncertainty, request),
            uncertainty,
        };
        Ok(Self {
            operating_points: points,
            estimate,
            excitation,
            voltage_timing: voltage_timing(request),
            misfit,
            voltage_losses: harmonics.iter().map(|harmonic| harmonic.filter(|one| one.stands_out).map_or(0.0, |one| one.loss)).collect(),
            loss_prior,
            losses,
            possible_losses,
            rs_of_speeds,
            frame_lag: lag,
            open_loop: frames.map_or_else(Vec::new, |frames| frames.open_loop),
            warming,
            finding,
            tells_angle,
            as_measured,
        })
    }

    /// The parameters that its points leave open to simulated currents: a current that the drive holds at zero moves in none of them, even
    /// if a frame's angle that was found here makes it another.
    pub(crate) fn left_open(&self, request: &Request) -> [bool; PARAMETERS] {
        let as_measured = self.frame_lag.map(|_| Excitation::of(&self.as_measured, &request.known));
        let is_held = |parameter| as_measured.as_ref().is_some_and(|excitation| excitation.is_open(parameter));
        Parameter::ALL.map(|parameter| self.finding.open[parameter as usize] || is_held(parameter))
    }

    /// Saturation, if it explains a contradiction between the operating points.
    pub(crate) fn saturation(&self, request: &Request) -> Option<SaturationFinding> {
        // Where a recorder's lag and the age of its speed leave no inductance, none can be seen to change.
        let is_told = |parameter| {
            let half_width = self.finding.uncertainty.parameters[parameter as usize].half_width;
            half_width < TOLD * self.estimate.motor.get(parameter)
        };
        if self.frame_lag.is_some() && !is_told(Parameter::Ld) && !is_told(Parameter::Lq) {
            return None;
        }
        self.misfit?;
        // Currents, speeds and voltages of different instants bend to anything.
        if self.finding.trust.repeated_values {
            return None;
        }
        SaturationFinding::of_points(
            &self.operating_points,
            (&self.losses, &self.possible_losses),
            &self.excitation,
            &self.estimate.motor,
            self.rs_of_speeds.as_ref(),
            request,
        )
    }

    /// Whether its points, which contradict each other, no longer do in the frame of a drive that simulated currents found: one whose angle
    /// is off or late, or whose voltages lag.
    pub(crate) fn agrees_in_frame_of(&self, log: &Log, drive: &Adjustable, request: &Request) -> bool {
        let in_doubt = InDoubt { angle_and_winding: !log.is_control_rate(), loss: 0.0 };
        let turned = in_magnets_frame(&self.operating_points, drive).filter(|_| self.misfit.is_some());
        turned.is_some_and(|points| solve_beside(log, points, &[], in_doubt, request).misfit.is_none())
    }

    /// R_s and its standard uncertainty, ohm, of a motor that saturates, where points of one current at several speeds tell it.
    pub(crate) fn rs_of_speeds(&self, request: &Request) -> Option<(f64, f64)> {
        self.saturation(request).filter(|found| found.tells_rs).map(|found| (found.rs, found.rs_uncertainty))
    }

    /// Lets the swarm minimize the same weighted equations that least squares solved.
    ///
    /// # Errors
    /// If the box or the settings do not suit it.
    pub(crate) fn search(&self, method: Method, bounds: Bounds, request: &Request, progress: Progress) -> Result<Search, Error> {
        let objective = &self.estimate.objective;
        let report = swarm::run(objective, method, &bounds, request, progress)?;
        // Where the cost is flat a swarm ends anywhere: only what the log excites is its answer.
        let mut found = self.excitation.excited_motor(&Motor::from(std::array::from_fn(|p| report.best[p]))).to_array();
        for (p, known) in request.known.iter().enumerate() {
            if let Known::Fixed(value) = known {
                found[p] = *value;
            }
        }
        let motor = Motor::from(found);
        Ok(Search { cost_above_optimum: self.estimate.cost_above_optimum(&motor), motor, bounds, report })
    }
}

/// What is in doubt of a drive.
#[derive(Debug, Clone, Copy)]
struct InDoubt {
    /// Whether its angle may be off, and its winding may warm.
    angle_and_winding: bool,
    /// By how many volts what dead time takes from a point may differ from its unknowns.
    loss: f64,
}

/// What is in doubt of the frames of a recorder's columns.
struct Frames {
    lag: FrameLag,
    /// Rows of the points in open-loop operation.
    open_loop: Vec<Range<usize>>,
    /// Those of the points without current.
    coasting: Vec<Range<usize>>,
    /// By which part the voltages without current may differ from those under load, one standard deviation.
    gain: f64,
}

impl Frames {
    /// The unknowns beside the motor at points that are turned back by a lag and an angle, whose own come last.
    fn unknowns(&self, points: &[OperatingPoint], lag: &FrameLag, angle: &FrameAngle, motor: &Motor, log: &Log) -> Vec<Loss> {
        let gain = (self.gain != 0.0).then(|| coasting::gain_unknown(points, |w| self.coasting.contains(&points[w].rows), self.gain.abs()));
        let open_loop = open_loop::unknowns(points, &self.open_loop, motor.psi_f).into_iter();
        open_loop
            .chain(gain)
            .chain(lag.unknowns(points, motor.psi_f, log))
            .chain(FrameLag::unknowns_of_angle(points, angle, motor))
            .collect()
    }
}

/// The operating points of a recorder's log with those of a coasting drive that measures its terminals, and what is known of the frames.
/// Those of another log as they are.
fn frames(log: &Log, mut points: Vec<OperatingPoint>, request: &Request) -> (Vec<OperatingPoint>, Option<Frames>) {
    let Some(lag) = FrameLag::possible(log, request) else { return (points, None) };
    // A faster log without current is one of a drive that holds its current at zero.
    if !recorder::is_recorders(log) {
        return (points, Some(Frames { lag, open_loop: Vec::new(), coasting: Vec::new(), gain: 0.0 }));
    }
    let open_loop = open_loop::find(log, &points, &lag, request);
    let in_frame: Vec<OperatingPoint> = points.iter().filter(|point| !open_loop.contains(&point.rows)).cloned().collect();
    let terminals = coasting::at_terminals(log, &in_frame, &lag, request);
    let (coasting, gain) = terminals.map_or_else(Default::default, |terminals| (terminals.points, terminals.gain));
    let coasting_rows = coasting.iter().map(|point| point.rows.len()).sum();
    let rows = coasting.iter().map(|point| point.rows.clone()).collect();
    points.extend(coasting);
    points.sort_by_key(|point| point.rows.start);
    (points, Some(Frames { lag: FrameLag { coasting_rows, ..lag }, open_loop, coasting: rows, gain }))
}

/// What solving the points gives.
struct Solved {
    /// With their voltages turned back by the lag.
    points: Vec<OperatingPoint>,
    excitation: Excitation,
    harmonics: Vec<Option<Harmonic>>,
    loss_prior: LossPrior,
    losses: Vec<Loss>,
    /// With those that constants bend to something else.
    possible_losses: Vec<Loss>,
    estimate: Estimate,
    misfit: Option<Misfit>,
    lag: Option<FrameLag>,
    /// The motor at another angle, if points that contradict each other do not contradict each other there.
    at_another_angle: Option<Motor>,
    /// Whether the points tell the angle, where it was among the unknowns.
    tells_angle: Option<bool>,
    warming: Option<Warming>,
}

/// Solves the points beside the losses and a lag; again with the voltages turned back by what was found of it.
fn solve_at_lag(
    log: &Log,
    (unturned, other): (&[OperatingPoint], Option<&[OperatingPoint]>),
    frames: &Frames,
    request: &Request,
) -> Solved {
    let (mut lag, mut angle, mut motor) = (frames.lag, FrameAngle::USUAL, only_flux(frame_lag::rough_flux(unturned)));
    let mut round = || {
        let points = lag.turned_back(unturned, &angle);
        let hold = other.map(|other| frame_lag::hold_unknown(&points, &lag.turned_back(other, &angle)));
        let unknowns: Vec<Loss> = hold.into_iter().chain(frames.unknowns(&points, &lag, &angle, &motor, log)).collect();
        let solved = solve_beside(log, points, &unknowns, InDoubt { angle_and_winding: true, loss: 0.0 }, request);
        if let Some((before, of_angle)) = solved.estimate.found.split_last_chunk::<{ FrameAngle::UNKNOWNS }>()
            && let Some((_, of_lag)) = before.split_last_chunk()
        {
            (lag, angle) = (lag.with(of_lag), angle.with_unknowns(&solved.estimate, solved.estimate.found.len() - of_angle.len()));
        }
        motor = solved.estimate.motor;
        solved
    };
    for _ in 1..frame_lag::ROUNDS {
        round();
    }
    let solved = round();
    Solved { lag: Some(lag), ..solved }
}

/// A motor of which only the flux is known, Wb.
fn only_flux(psi_f: f64) -> Motor {
    Motor { rs: 0.0, ld: 0.0, lq: 0.0, psi_f }
}

/// Solves points of a drive whose angle may be unknown; again with the points turned back by what was found of it. Points that contradict
/// each other are left so: an angle bends to anything, and what makes them contradict each other may be something else. The motor at an
/// angle at which they do not is then a possible one.
fn solve_at_angle(log: &Log, unturned: &[OperatingPoint], angle: Option<FrameAngle>, in_doubt: InDoubt, request: &Request) -> Solved {
    let at_the_angle = solve_beside(log, unturned.to_vec(), &[], in_doubt, request);
    let Some(mut angle) = angle else { return at_the_angle };
    let mut motor = only_flux(frame_lag::rough_flux(unturned));
    let mut round = |angle: &mut FrameAngle| {
        let points = angle.turned_back(unturned);
        let unknowns: Vec<Loss> = angle.unknowns(&points, &motor).into_iter().chain([angle.lag_of_voltages(&points, &motor)]).collect();
        let solved = solve_beside(log, points, &unknowns, in_doubt, request);
        let found = &solved.estimate.found;
        if let (Some((lag, _)), Some(place)) = (found.last(), found.len().checked_sub(unknowns.len())) {
            *angle = angle.with_unknowns(&solved.estimate, place).with_lag_of_voltages(*lag);
        }
        motor = solved.estimate.motor;
        solved
    };
    for _ in 1..frame_angle::ROUNDS {
        round(&mut angle);
    }
    let turned = round(&mut angle);
    match at_the_angle.misfit {
        None => Solved { tells_angle: Some(angle.is_told()), ..turned },
        Some(_) => Solved {
            at_another_angle: Some(turned.estimate.motor)
                .filter(|motor| turned.misfit.is_none() && motor.to_array().iter().all(|value| value.is_finite())),
            ..at_the_angle
        },
    }
}

/// Solves points beside the losses, these unknowns of their frames, and a resistance that changes, if that is in doubt.
fn solve_beside(log: &Log, points: Vec<OperatingPoint>, of_frames: &[Loss], in_doubt: InDoubt, request: &Request) -> Solved {
    let excitation = Excitation::of(&points, &request.known);
    let possible = LossPrior::possible(log, request);
    let harmonics = harmonics(log, &points, &excitation, &possible, request);
    let loss_prior = possible.with_harmonics(&harmonics);
    let mut losses = losses(&points, &excitation, &loss_prior, request);
    let all = |losses: &[Loss]| losses.iter().chain(of_frames).cloned().collect::<Vec<_>>();
    let admit = |all: &[Loss]| misfit::admit(&points, &excitation, request, all, in_doubt.loss);
    let (mut estimate, mut misfit) = admit(&all(&losses));
    let mut possible_losses = all(&losses);
    // A loss that leaves points which contradict each other, and takes more than the whole resistance, is no loss: it bends to
    // saturation.
    if misfit.is_some() && estimate.motor.rs < 0.0 && !losses.is_empty() {
        losses.clear();
        (estimate, misfit) = admit(&all(&losses));
    }
    let mut warming = Warming::expected(log, &points, &estimate.motor, in_doubt.angle_and_winding, request);
    if let Some(warming) = &mut warming {
        losses.push(warming.unknown(log, &points));
        possible_losses.push(warming.unknown(log, &points));
        (estimate, misfit) = admit(&all(&losses));
        (warming.change, warming.standard_error) = estimate.found[losses.len() - 1];
    }
    Solved {
        losses: all(&losses),
        possible_losses,
        excitation,
        harmonics,
        loss_prior,
        estimate,
        misfit,
        lag: None,
        at_another_angle: None,
        tells_angle: None,
        warming,
        points,
    }
}

/// The harmonics of dead time and device drops in the rows of each point, by the motor that comes out beside any loss that is possible.
fn harmonics(
    log: &Log,
    points: &[OperatingPoint],
    excitation: &Excitation,
    possible: &LossPrior,
    request: &Request,
) -> Vec<Option<Harmonic>> {
    let rough = Estimate::solve(points, excitation, request, &losses(points, excitation, possible, request)).motor;
    let Dq { d: ld, q: lq } = excitation.inductances(&rough);
    let mut harmonics = ripple::harmonics(log, points, &Motor { ld, lq, ..rough }, VOLTAGE_ACCURACY);
    for (harmonic, point) in harmonics.iter_mut().zip(points) {
        *harmonic = harmonic.filter(|one| one.stands_out || possible.would_show(point, Dq { d: ld, q: lq }));
    }
    harmonics
}

/// The unknowns of the losses: how much the near-zero currents and the instant of the decision matter follows from the loss along the
/// current, so that is solved first.
fn losses(points: &[OperatingPoint], excitation: &Excitation, prior: &LossPrior, request: &Request) -> Vec<Loss> {
    let along_current = prior.losses(points, 0.0, Dq { d: f64::INFINITY, q: f64::INFINITY });
    let rough = Estimate::solve(points, excitation, request, &along_current);
    let inductance = excitation.inductances(&rough.motor);
    // At least what the points leave open of it.
    let loss = rough.loss.map_or(0.0, |(volts, error)| volts.hypot(error));
    prior.losses(points, loss, inductance)
}

/// What is known from noise, accuracy and excitation: what more operating points would improve.
fn bench(
    log: &Log,
    points: &[OperatingPoint],
    excitation: &Excitation,
    estimate: &Estimate,
    uncertainty: &Uncertainty,
    request: &Request,
) -> Bench {
    let standard_errors = uncertainty.parameters.map(|parameter| parameter.statistical.hypot(parameter.systematic.accuracy));
    let row_variance = points.iter().map(|point| {
        let noise = point.residual_covariance(&estimate.motor);
        0.5 * (noise[0][0] + noise[1][1]) * point.rows.len() as f64
    });
    let mean_period = points.iter().map(|point| (point.time.1 - point.time.0) / (point.rows.len() - 1).max(1) as f64);
    Bench {
        motor: Bench::guess(estimate.motor, |parameter| !excitation.is_open(parameter)),
        covariance: covariance(standard_errors, &uncertainty.correlation) + excitation.unexcited_parameters(),
        held: points.iter().map(|point| (point.current(), point.omega_e())).collect(),
        row_variance: row_variance.sum::<f64>() / points.len() as f64,
        sample_period: mean_period.fold(0.0, f64::max),
        voltage: points.iter().map(|point| point.voltage().magnitude()).fold(0.0, f64::max),
        voltage_accuracy: request.voltage_accuracy,
        is_at_rest: log.is_at_rest(),
    }
}

/// Centred, unless stated otherwise: what drives that log their realized voltage mostly mean.
pub(crate) fn voltage_timing(request: &Request) -> Resolved<SteadyVoltageTiming> {
    match request.voltage_timing {
        Some(stated) => Resolved { value: stated.into(), provenance: Provenance::Stated },
        None => Resolved { value: SteadyVoltageTiming::Centered, provenance: Provenance::Assumed },
    }
}

/// The operating points in the windows named, or in those found, as the log has them: before any correction, and with a coarse covariance.
///
/// # Errors
/// If there is none.
pub fn operating_points(log: &Log, request: &Request) -> Result<Vec<OperatingPoint>, Error> {
    let mut windows = Vec::new();
    for times in &request.windows {
        windows.extend(windows::between(log, *times)?);
    }
    if windows.is_empty() {
        windows = if recorder::is_recorders(log) { recorder::loaded(log)? } else { windows::find(log)? };
    }
    Ok(windows.into_iter().map(|rows| OperatingPoint::measure(log, rows, None)).collect())
}

/// Measures the points again: now the motor is known roughly, and the corrections and the covariance that need it are possible.
/// Beside the points: the same with another timing of the voltage columns, where nobody stated it. Where the rows may be every n-th of a
/// drive's periods nothing is corrected, and the others have the correction that the drive's own period would need.
fn measure(log: &Log, rough: &[OperatingPoint], request: &Request) -> (Vec<OperatingPoint>, Option<Vec<OperatingPoint>>) {
    let with = |timing: SteadyVoltageTiming, change: &dyn Fn(ZeroOrderHold) -> ZeroOrderHold| -> Vec<OperatingPoint> {
        let preliminary = preliminary_estimates(log, rough, timing, request);
        let measured = rough.iter().zip(&preliminary).map(|(point, one)| {
            OperatingPoint::measure(log, point.rows.clone(), Some(&PreliminaryEstimate { hold: change(one.hold), ..*one }))
        });
        measured.collect()
    };
    let as_it_is = |hold: ZeroOrderHold| hold;
    if let Some(stated) = request.voltage_timing {
        return (with(stated.into(), &as_it_is), None);
    }
    let fastest = rough.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let period = log.slowest_period();
    let (points, other) = if log.is_control_rate() && fastest * period <= MAX_ANGLE_PER_SAMPLE {
        (with(SteadyVoltageTiming::Centered, &as_it_is), with(SteadyVoltageTiming::Compensated, &as_it_is))
    } else {
        let may_be_own = period * SLOWEST_PERIODS <= 1.0 && fastest * period <= MAX_ANGLE_PER_SAMPLE;
        let sample_period = if may_be_own { period } else { period.min(1.0 / USUAL_PERIODS) };
        let timing = SteadyVoltageTiming::Centered;
        (with(timing, &|_| ZeroOrderHold::NONE), with(timing, &|_| ZeroOrderHold { timing, sample_period, ..ZeroOrderHold::NONE }))
    };
    (points, Some(other))
}

/// How far the answer moves between two timings of the voltage columns.
fn timing_doubt(one: &[OperatingPoint], other: &[OperatingPoint], request: &Request) -> [f64; PARAMETERS] {
    let solve = |points: &[OperatingPoint]| Estimate::solve(points, &Excitation::of(points, &request.known), request, &[]).motor;
    let (one, other) = (solve(one).to_array(), solve(other).to_array());
    std::array::from_fn(|p| (one[p] - other[p]).abs())
}

/// Hardly a drive controls its currents more slowly than this, Hz.
const SLOWEST_PERIODS: f64 = 2e3;

/// The periods of a drive whose log has only every n-th of them, Hz.
const USUAL_PERIODS: f64 = 1e4;

/// What a first look at the operating points tells of each: the motor, and the held-vector correction of its window.
pub(crate) fn preliminary_estimates(
    log: &Log,
    rough: &[OperatingPoint],
    timing: SteadyVoltageTiming,
    request: &Request,
) -> Vec<PreliminaryEstimate> {
    let excitation = Excitation::of(rough, &request.known);
    let motor = Estimate::solve(rough, &excitation, request, &[]).motor;
    let inductance = excitation.inductances(&motor);
    let fastest = rough.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    rough
        .iter()
        .map(|point| PreliminaryEstimate { motor, hold: zero_order_hold(log, point, fastest, timing, motor.rs, inductance) })
        .collect()
}

/// The correction that fits a window: none where the log's sampling cannot be the inverter's at the fastest speed (rad/s) of all
/// windows, so that either all of them are corrected or none; none of the current where so long a period does not shape it.
fn zero_order_hold(log: &Log, point: &OperatingPoint, fastest: f64, timing: SteadyVoltageTiming, rs: f64, inductance: Dq) -> ZeroOrderHold {
    match log.segment_of(point.rows.start).map(|segment| segment.sample_period) {
        Some(sample_period) if fastest * sample_period <= MAX_ANGLE_PER_SAMPLE => {
            let shapes = |l: f64| if rs > 0.0 && rs * sample_period <= MAX_DECAY_PER_SAMPLE * l { l } else { f64::INFINITY };
            ZeroOrderHold { timing, sample_period, inductance: Dq { d: shapes(inductance.d), q: shapes(inductance.q) } }
        }
        _ => ZeroOrderHold::NONE,
    }
}

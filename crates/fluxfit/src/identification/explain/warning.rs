//! Warnings: what the reader should know of the whole, whatever the verdicts. Facts; the sentences are in
//! [`words`](crate::words).

use super::{
    super::{
        fit::{
            frame_lag::FrameLag,
            output::OutputFit,
            saturation::{Apparent, SaturationFinding},
            steady::SteadyFit,
            swarm::Search,
            warming::Warming,
        },
        judge::{priors::Contradiction, verdict::Verdict},
        request::Request,
    },
    conventions::Convention,
    judgement::Judgement,
};
use crate::{
    faults::Fault,
    log::Log,
    motor::{PARAMETERS, Parameter},
    steady::{OperatingPoint, recorder, windows, zero_order_hold::MAX_ANGLE_PER_SAMPLE},
};

/// Something that the reader should know of the log or the answer as a whole. It prints as a sentence; [`code`](Self::code) names it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// There are exactly as many equations as unknowns, so the fit is perfect whatever the data: errors would go unseen.
    NoRedundancy,
    /// The operating points contradict each other.
    Misfit {
        /// Their contradiction over what noise and accuracy explain; 1 would be none.
        ratio: f64,
        /// The fraction of the voltage to which they agree: 0.01 is 1 %.
        voltage_accuracy: f64,
    },
    /// The ripple of dead time or device drops is in the log.
    DeadTime {
        /// The voltage lost along the current, V: the largest over the operating points.
        voltage: f64,
    },
    /// Rows without current were left out.
    NoCurrent {
        /// Number of rows left out.
        rows: usize,
        /// Number of all rows.
        of: usize,
    },
    /// Windows that were named carry no current, and were used.
    NoCurrentInWindows {
        /// Number of such windows.
        windows: usize,
    },
    /// Steady stretches much shorter than the others were left out.
    ShortStretches {
        /// Start and end, s, the longest first.
        times: Vec<(f64, f64)>,
    },
    /// The rotor turns too far between rows for the held voltage vector to be corrected.
    CoarseSampling,
    /// A recorder's voltages turn with speed against the rotor's frame; that is solved for beside the motor.
    FrameLag {
        /// The time by which they lie behind it, s; negative: ahead.
        seconds: f64,
        /// Its standard error, s.
        standard_error: f64,
        /// The angle that it makes at the highest speed, electrical rad.
        angle: f64,
        /// Rows without current that show it too.
        coasting_rows: usize,
    },
    /// Windows in open-loop operation, whose columns are not in the rotor's frame: only the resistance is taken from them.
    OpenLoop {
        /// Start and end, s, in order.
        times: Vec<(f64, f64)>,
    },
    /// R_s changes while the log is taken; the answer is that in the middle of the log.
    Warming {
        /// R_s at the log's end less that at its start, ohm.
        change: f64,
        /// Its standard error, ohm.
        standard_error: f64,
        /// R_s in the middle, ohm.
        rs: f64,
    },
    /// Voltages that the log does not hold disturb the motor, and not everything is identified, or the residuals are correlated in spite of
    /// the observer that follows these voltages in the fit.
    ProcessNoise,
    /// The logged angle does not turn with the speed, so it was not used.
    Angle,
    /// The motor saturates: no constant inductances explain the log, and the intervals are widened to hold what each operating point says.
    Saturation {
        /// The apparent inductance `psi_q / i_q` at the smallest and the largest i_q at which it can be computed, where the two differ.
        lq: Option<[Apparent; 2]>,
    },
    /// Even at the highest speed the motor's own voltage is small beside what dead time and device drops take.
    LowSpeed {
        /// Highest speed, electrical rad/s.
        omega_e: f64,
        /// The motor's own voltage there, V.
        own: f64,
        /// The voltage that dead time and device drops take, V.
        lost: f64,
    },
    /// Rows have more voltage than the inverter can make of the logged DC voltage, `u_dc / sqrt 3`.
    VoltageLimit {
        /// Number of such rows.
        rows: usize,
        /// Number of all rows.
        of: usize,
    },
    /// The answer lies outside the swarm's search box, so the swarm cannot reach it. The answer itself is not affected.
    OutsideBox {
        /// The parameters in which it does.
        parameters: Vec<Parameter>,
    },
    /// The log does not agree with the nameplate.
    Convention(Box<Convention>),
    /// The wanted bandwidth of the current controllers leaves too small a phase margin.
    PhaseMargin {
        /// Wanted, Hz.
        bandwidth: f64,
        /// The margin that it leaves, degrees.
        margin: f64,
        /// How often the controllers run, Hz.
        control_rate: f64,
        /// Whether that rate was taken from the log's rows rather than stated.
        rate_assumed: bool,
        /// Largest bandwidth without this warning, Hz.
        highest: f64,
    },
    /// What the log alone tells of a parameter, or the answer with it, contradicts the prior that was given.
    PriorContradicted {
        /// Which parameter.
        parameter: Parameter,
        /// The prior and its standard error, SI.
        prior: (f64, f64),
        /// The value by the log alone, else by the answer, and its standard error, SI.
        log: (f64, f64),
    },
    /// The swarm's search was stopped before its end.
    Interrupted {
        /// Iterations done.
        iterations: usize,
        /// Iterations asked for.
        limit: usize,
    },
}

impl Warning {
    /// The codes of all warnings.
    pub const CODES: [&'static str; 19] = [
        "no-redundancy",
        "misfit",
        "dead-time",
        "no-current",
        "short-stretches",
        "coarse-sampling",
        "frame-lag",
        "open-loop",
        "warming",
        "process-noise",
        "angle",
        "saturation",
        "low-speed",
        "voltage-limit",
        "outside-box",
        "convention",
        "phase-margin",
        "prior",
        "interrupted",
    ];

    /// Name in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoRedundancy => "no-redundancy",
            Self::Misfit { .. } => "misfit",
            Self::DeadTime { .. } => "dead-time",
            Self::NoCurrent { .. } | Self::NoCurrentInWindows { .. } => "no-current",
            Self::ShortStretches { .. } => "short-stretches",
            Self::CoarseSampling => "coarse-sampling",
            Self::FrameLag { .. } => "frame-lag",
            Self::OpenLoop { .. } => "open-loop",
            Self::Warming { .. } => "warming",
            Self::ProcessNoise => "process-noise",
            Self::Angle => "angle",
            Self::Saturation { .. } => "saturation",
            Self::LowSpeed { .. } => "low-speed",
            Self::VoltageLimit { .. } => "voltage-limit",
            Self::OutsideBox { .. } => "outside-box",
            Self::Convention(_) => "convention",
            Self::PhaseMargin { .. } => "phase-margin",
            Self::PriorContradicted { .. } => "prior",
            Self::Interrupted { .. } => "interrupted",
        }
    }
}

/// What warnings are drawn from.
pub(crate) struct Evidence<'a> {
    pub(crate) log: &'a Log,
    pub(crate) request: &'a Request,
    pub(crate) parameters: &'a [Judgement; PARAMETERS],
    pub(crate) steady: Option<&'a SteadyFit>,
    /// None where the operating points answer.
    pub(crate) output: Option<&'a OutputFit>,
    pub(crate) saturation: Option<&'a SaturationFinding>,
    pub(crate) search: Option<&'a Search>,
    pub(crate) contradictions: &'a [Contradiction],
}

/// Everything there is to warn of.
pub(crate) fn all(evidence: &Evidence) -> Vec<Warning> {
    let Evidence { log, request, .. } = *evidence;
    let of_points = evidence.steady.map(|fit| {
        // What only the steady model's own answer suffers from.
        let answered = evidence.output.is_none();
        [
            no_redundancy(fit).filter(|_| answered || !evidence.has_transients()),
            misfit(fit).filter(|_| answered),
            dead_time(fit).filter(|_| answered),
            frame_lag(fit).filter(|_| answered),
            open_loop(log, fit).filter(|_| answered),
            warming(fit).filter(|_| answered),
            no_current(log, fit, request).filter(|_| answered),
            short_stretches(log, request).filter(|_| answered),
            coarse_sampling(log, fit),
        ]
    });
    let of_currents = evidence.output.map(|fit| [process_noise(fit, evidence.parameters), angle(log, fit)]);
    let of_either = [evidence.saturation.map(saturated), evidence.low_speed(), voltage_limit(log), evidence.outside_box()];
    let of_priors = evidence.contradictions.iter().map(|contradiction| {
        let Contradiction { parameter, prior, log } = *contradiction;
        Some(Warning::PriorContradicted { parameter, prior, log })
    });
    of_points.into_iter().flatten().chain(of_currents.into_iter().flatten()).chain(of_either).chain(of_priors).flatten().collect()
}

/// Part of the rows used that is worth calling a transient.
const TRANSIENT: f64 = 0.01;

/// A voltage that is not accounted for must be this part of the motor's own, or less, for psi_f to be good to five percent.
const SMALL: f64 = 0.05;

/// Least part of the DC voltage that an inverter loses unseen: half a microsecond of dead time at a carrier of 10 kHz, about what a good
/// compensation leaves.
const UNSEEN_LOSS: f64 = 5e-3;

impl Evidence<'_> {
    fn operating_points(&self) -> &[OperatingPoint] {
        self.steady.map_or(&[], |fit| &fit.operating_points)
    }

    /// Whether simulated currents were compared in rows beyond the operating points: what happens between them can contradict a motor
    /// that two of them cannot.
    fn has_transients(&self) -> bool {
        let Some(fit) = self.output else { return false };
        let rows = || fit.stretches.iter().cloned().flatten();
        let steady = |row: &usize| self.operating_points().iter().any(|point| point.rows.contains(row));
        rows().filter(|row| !steady(row)).count() as f64 > TRANSIENT * rows().count() as f64
    }

    /// The motor's own voltage at the highest speed, against what the inverter is known or sure to lose.
    fn low_speed(&self) -> Option<Warning> {
        let columns = self.log.columns();
        let within = |peak: f64, row: usize| peak.max(columns.omega_e[row].abs());
        let (omega_e, u) = match (self.output, self.operating_points()) {
            (None, points) => points.iter().fold((0.0, 0.0), |most: (f64, f64), point| {
                if point.omega_e().abs() > most.0 { (point.omega_e().abs(), point.voltage().magnitude()) } else { most }
            }),
            (Some(fit), _) => {
                let rows = || fit.stretches.iter().cloned().flatten();
                (rows().fold(0.0, within), rows().map(|row| columns.ud[row].hypot(columns.uq[row])).fold(0.0, f64::max))
            }
        };
        // A loss that was found limits nothing where the flux and the inductances are identified beside it.
        let is_found = self.output.is_some_and(|fit| fit.has(Fault::DeadTime));
        let limited = [Parameter::Ld, Parameter::Lq, Parameter::PsiF];
        let is_limited = limited.iter().any(|limited| self.parameters[*limited as usize].verdict != Verdict::Identified);
        if self.log.is_at_rest() || is_found && !is_limited {
            return None;
        }
        // A flux that is not known makes no more voltage than there is.
        let own = self.parameters[Parameter::PsiF as usize].value().map_or(u, |psi_f| omega_e * psi_f);
        let seen = self.steady.iter().flat_map(|fit| &fit.voltage_losses).copied().fold(0.0, f64::max);
        let unseen = columns.u_dc.as_ref().map_or(0.0, |u_dc| UNSEEN_LOSS * u_dc.iter().copied().fold(0.0, f64::max));
        let lost = seen.max(unseen);
        (own > 0.0 && lost > SMALL * own).then_some(Warning::LowSpeed { omega_e, own, lost })
    }

    fn outside_box(&self) -> Option<Warning> {
        let judged = self.parameters.iter().zip(self.search?.bounds.iter());
        let outside =
            judged.filter(|(judgement, (lower, upper))| judgement.value().is_some() && !(lower..=upper).contains(&&judgement.raw));
        let parameters: Vec<Parameter> = outside.map(|(judgement, _)| judgement.parameter).collect();
        (!parameters.is_empty()).then_some(Warning::OutsideBox { parameters })
    }
}

fn no_redundancy(found: &SteadyFit) -> Option<Warning> {
    (found.estimate.redundancy == 0).then_some(Warning::NoRedundancy)
}

/// What a measured DC voltage may be wrong by.
const DC_ACCURACY: f64 = 0.01;

fn voltage_limit(log: &Log) -> Option<Warning> {
    let columns = log.columns();
    let u_dc = columns.u_dc.as_ref()?;
    let least = windows::least_current(log);
    let over = |row: &usize| {
        let (u, i) = (columns.ud[*row].hypot(columns.uq[*row]), columns.id[*row].hypot(columns.iq[*row]));
        i >= least && u_dc[*row] > 0.0 && u > (1.0 + DC_ACCURACY) * u_dc[*row] / 3.0_f64.sqrt()
    };
    let (rows, of) = ((0..log.rows()).filter(over).count(), log.rows());
    (rows as f64 > MANY_ROWS * of as f64).then_some(Warning::VoltageLimit { rows, of })
}

fn misfit(found: &SteadyFit) -> Option<Warning> {
    found.misfit.map(|misfit| Warning::Misfit { ratio: misfit.ratio, voltage_accuracy: misfit.voltage_accuracy })
}

fn dead_time(found: &SteadyFit) -> Option<Warning> {
    let voltage = found.voltage_losses.iter().copied().fold(0.0, f64::max);
    (voltage > 0.0).then_some(Warning::DeadTime { voltage })
}

/// Change of an inductance that is worth two numbers.
const VISIBLE: f64 = 0.01;

fn saturated(saturation: &SaturationFinding) -> Warning {
    let half_width = |one: &Apparent| saturation.half_width_of(one).unwrap_or(0.0);
    let visible = |[least, most]: &[Apparent; 2]| {
        let change = (most.inductance - least.inductance).abs();
        change >= VISIBLE * least.inductance && change > half_width(least).hypot(half_width(most))
    };
    Warning::Saturation { lq: saturation.lq.filter(visible) }
}

/// Not where everything is identified and the observer leaves noise: then it changed nothing, and the intervals count it.
fn process_noise(found: &OutputFit, parameters: &[Judgement; PARAMETERS]) -> Option<Warning> {
    let changed_nothing = found.is_explained() && parameters.iter().all(|judgement| judgement.verdict == Verdict::Identified);
    (found.has(Fault::Disturbance) && !changed_nothing).then_some(Warning::ProcessNoise)
}

fn angle(log: &Log, found: &OutputFit) -> Option<Warning> {
    (log.columns().theta_e.is_some() && !found.angle_known).then_some(Warning::Angle)
}

/// A lag that turns by less than this at the highest speed, rad, moves nothing: a fifth of a degree.
const VISIBLE_ANGLE: f64 = 0.0035;

fn frame_lag(found: &SteadyFit) -> Option<Warning> {
    let lag = found.frame_lag.filter(FrameLag::is_found)?;
    let fastest = found.operating_points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let angle = fastest * lag.seconds;
    let FrameLag { seconds, standard_error, coasting_rows, .. } = lag;
    (angle.abs() >= VISIBLE_ANGLE).then_some(Warning::FrameLag { seconds, standard_error, angle, coasting_rows })
}

fn open_loop(log: &Log, found: &SteadyFit) -> Option<Warning> {
    let t = &log.columns().t;
    let times: Vec<(f64, f64)> = found.open_loop.iter().map(|rows| (t[rows.start], t[rows.end - 1])).collect();
    (!times.is_empty()).then_some(Warning::OpenLoop { times })
}

fn warming(found: &SteadyFit) -> Option<Warning> {
    let Warming { change, standard_error } = found.warming.filter(Warming::is_found)?;
    Some(Warning::Warming { change, standard_error, rs: found.estimate.motor.rs })
}

/// Share of rows that is worth a warning.
const MANY_ROWS: f64 = 0.01;

fn no_current(log: &Log, found: &SteadyFit, request: &Request) -> Option<Warning> {
    if found.frame_lag.is_some_and(|lag| lag.coasting_rows > 0) {
        return None;
    }
    if request.windows.is_empty() {
        let (rows, of) = (windows::rows_without_current(log), log.rows());
        return (rows as f64 > MANY_ROWS * of as f64).then_some(Warning::NoCurrent { rows, of });
    }
    let windows = found.operating_points.iter().filter(|point| point.current().magnitude() < windows::least_current(log)).count();
    (windows > 0).then_some(Warning::NoCurrentInWindows { windows })
}

fn short_stretches(log: &Log, request: &Request) -> Option<Warning> {
    let (_, mut short) = windows::find_all(log);
    short.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
    // In a recorder's log short stretches are windows.
    if short.is_empty() || !request.windows.is_empty() || recorder::is_recorders(log) {
        return None;
    }
    let t = &log.columns().t;
    Some(Warning::ShortStretches { times: short.iter().map(|rows| (t[rows.start], t[rows.end - 1])).collect() })
}

fn coarse_sampling(log: &Log, found: &SteadyFit) -> Option<Warning> {
    let fastest = found.operating_points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let coarse = found.operating_points.iter().any(|point| {
        let within = log.segment_of(point.rows.start);
        within.is_some_and(|segment| fastest * segment.sample_period > MAX_ANGLE_PER_SAMPLE)
    });
    coarse.then_some(Warning::CoarseSampling)
}

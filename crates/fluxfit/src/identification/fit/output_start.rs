//! Where the fit of simulated currents starts, and with what knowledge.

use super::{
    super::{
        prepare::stretches,
        request::{Known, Request},
    },
    excitation::{Excitation, NOTHING},
    steady::SteadyFit,
};
use crate::{
    faults::Fault,
    least_squares::{Equation, TriangularFactor},
    levenberg_marquardt::{MOTOR, PriorResidual},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    normal_matrix::dot,
    objective::adjustable::{Adjustable, Unknown},
};
use std::ops::Range;

/// A voltage along an axis below this part of the other's is none: a simulator leaves rounding there. A controller's answers to noise, of
/// some thousandths, act: without the inductance among the unknowns R_s came out 0.8 % off at 0.2 %.
const NO_VOLTAGE: f64 = 1e-9;

/// A current without voltage is noise, and none that dies out, if it is below this part of the other axis'.
const NO_CURRENT: f64 = 0.01;

/// The same of a current that does not die out: a larger one is that of a voltage that was not logged.
const NOISY_CURRENT: f64 = 0.3;

/// What dies out within the log has, in the first of so many parts of it, more than so many times that part's share of the squares.
const PARTS: usize = 10;
const MOST_IN_FIRST: f64 = 2.0;

/// Whether no row of the log depends on a parameter: at rest on the flux, nor on the inductance of an axis without voltage and current.
pub(super) fn is_absent(log: &Log, parameter: Parameter) -> bool {
    let columns = log.columns();
    // Largest values would be those of the noise.
    let is_below = |part: f64, own: &[f64], other: &[f64]| dot(own, own) <= part.powi(2) * dot(other, other);
    let dies_out = |own: &[f64]| {
        let first = &own[..own.len() / PARTS];
        PARTS as f64 * dot(first, first) > MOST_IN_FIRST * dot(own, own)
    };
    let is_idle = |u: [&[f64]; 2], [own, other]: [&[f64]; 2]| {
        is_below(NO_VOLTAGE, u[0], u[1]) && (is_below(NO_CURRENT, own, other) || is_below(NOISY_CURRENT, own, other) && !dies_out(own))
    };
    log.is_at_rest()
        && match parameter {
            Parameter::PsiF => true,
            Parameter::Ld => is_idle([&columns.ud, &columns.uq], [&columns.id, &columns.iq]),
            Parameter::Lq => is_idle([&columns.uq, &columns.ud], [&columns.iq, &columns.id]),
            Parameter::Rs => false,
        }
}

/// Parameters that are not fixed, and on which some row depends.
pub(super) fn free(log: &Log, request: &Request) -> Vec<Unknown> {
    let is_free = |(unknown, known): &(Unknown, &Known)| {
        let absent = matches!(unknown, Unknown::Motor(parameter) if is_absent(log, *parameter));
        !(matches!(known, Known::Fixed(_)) || absent)
    };
    MOTOR.into_iter().zip(&request.known).filter(is_free).map(|(unknown, _)| unknown).collect()
}

/// Standard error of what is left of a lag of the speed, s: as long as the lag of a filter at 16 Hz, so that whatever the currents tell
/// outweighs it.
const REST_OF_LAG: f64 = 0.01;

/// What is left of a lag of the speed that was undone: an unknown, unless there was none.
pub(super) fn rest_of_lag(undone: f64) -> impl Iterator<Item = Unknown> {
    Unknown::of_fault(Fault::SpeedLag).filter(move |_| undone != 0.0)
}

/// Priors as residuals, given the mean square of a current's: those of the request, and that of what is left of an undone lag. Once the
/// angle agrees with the speed again it does nothing, and without a prior it could go anywhere.
pub(super) fn priors(request: &Request, undone_lag: f64, mean_square: f64) -> Vec<PriorResidual> {
    let rest = rest_of_lag(undone_lag);
    let rest = rest.map(|unknown| PriorResidual { unknown, value: 0.0, weight: mean_square.sqrt() / REST_OF_LAG });
    let priors = MOTOR.into_iter().zip(request.known).filter_map(|(unknown, known)| match known {
        Known::Prior { value, standard_error } => Some(PriorResidual { unknown, value, weight: mean_square.sqrt() / standard_error }),
        Known::Nothing | Known::Fixed(_) => None,
    });
    priors.chain(rest).collect()
}

/// Where the polish begins.
pub(super) struct Start {
    pub(super) drive: Adjustable,
    /// Whether the operating points leave one inductance open. No fit leads from there to an angle that is off: without the angle, that
    /// inductance takes the voltage which does not belong to its axis, and grows without limit.
    pub(super) may_hide_an_angle: bool,
    /// Whether the operating points show the harmonic of dead time.
    pub(super) shows_dead_time: bool,
    /// Whether most rows belong to operating points that do not tell an angle that is off from other inductances.
    pub(super) points_tell_no_angle: bool,
}

/// Whether these points tell an angle that is off: where it was not among their unknowns, whether they have an equation left for it.
fn tell_angle(points: &SteadyFit) -> bool {
    points.tells_angle.unwrap_or(points.estimate.redundancy > 0)
}

/// Part of the rows that is most of them. Of steps from one point to the next, the others are a tenth or two, in which currents settle;
/// ramps of the speed, which tell an angle, take more.
const MOST: f64 = 0.75;

/// The part of the rows at which currents are compared that belongs to operating points.
pub(crate) fn part_of_rows(points: &SteadyFit, stretches: &[Range<usize>]) -> f64 {
    let of_points: usize = points.operating_points.iter().map(|point| point.rows.len()).sum();
    let compared: usize = stretches.iter().map(ExactSizeIterator::len).sum();
    of_points as f64 / compared as f64
}

/// A parameter is no more than so many times what the voltages and currents allow on the whole.
const FARTHEST: f64 = 100.0;

/// What voltages and currents allow of each parameter, SI: by their means, as of operating points, while the rotor turns.
pub(super) fn scale(log: &Log, stretches: &[Range<usize>], request: &Request) -> [f64; PARAMETERS] {
    if log.is_at_rest() {
        return scale_at_rest(log, stretches);
    }
    Excitation::of(&stretches::as_points(log, stretches), &request.known).scale
}

/// The same by root mean squares: tests at rest swing about zero, and their means are nothing. Inductances show in the slopes of the
/// currents alone.
fn scale_at_rest(log: &Log, stretches: &[Range<usize>]) -> [f64; PARAMETERS] {
    let columns = log.columns();
    let count = stretches.iter().map(ExactSizeIterator::len).sum::<usize>() as f64;
    let rms = |square: &dyn Fn(usize) -> f64| (stretches.iter().flat_map(Clone::clone).map(square).sum::<f64>() / count).sqrt();
    let square = |d: &[f64], q: &[f64], row: usize| d[row].powi(2) + q[row].powi(2);
    let (u, i) = (rms(&|row| square(&columns.ud, &columns.uq, row)), rms(&|row| square(&columns.id, &columns.iq, row)));
    let spans = stretches.iter().flat_map(spans);
    let slope =
        |current: &[f64], span: &Range<usize>| (current[span.end] - current[span.start]) / (columns.t[span.end] - columns.t[span.start]);
    let slopes: Vec<f64> = spans.map(|span| slope(&columns.id, &span).powi(2) + slope(&columns.iq, &span).powi(2)).collect();
    let slope = (slopes.iter().sum::<f64>() / slopes.len().max(1) as f64).sqrt().max(NOTHING);
    [u / i.max(NOTHING), u / slope, u / slope, u / NOTHING]
}

/// Where the polish begins: the operating points' motor where it is one, else that of the rows' own voltage equations. Where the
/// points leave one inductance open, it starts as large as the other: from differences of a current that is held it comes out too small by
/// their noise.
pub(super) fn start(
    log: &Log,
    stretches: &[Range<usize>],
    steady: Option<&SteadyFit>,
    request: &Request,
    scale: &[f64; PARAMETERS],
) -> Start {
    let rows = by_differences(log, stretches).to_array();
    let mut values: [f64; PARAMETERS] = std::array::from_fn(|p| {
        let parameter = Parameter::ALL[p];
        let of_points = steady.filter(|fit| !fit.excitation.is_open(parameter)).map(|fit| fit.estimate.motor.get(parameter));
        // Of a current that is zero in every row, the rows' equations say anything.
        let of_rows = Some(rows[p]).filter(|value| *value <= FARTHEST * scale[p]);
        // An arbitrary fallback start: a tenth of what the voltage allows.
        [of_points, of_rows].into_iter().flatten().find(|value| *value > 0.0 && value.is_finite()).unwrap_or(0.1 * scale[p])
    });
    let is_open = |parameter| steady.is_some_and(|fit| fit.excitation.is_open(parameter));
    let (ld, lq) = (Parameter::Ld as usize, Parameter::Lq as usize);
    match (is_open(Parameter::Ld), is_open(Parameter::Lq)) {
        (true, false) => values[ld] = values[lq],
        (false, true) => values[lq] = values[ld],
        _ => {}
    }
    if log.is_at_rest() {
        values[Parameter::PsiF as usize] = 0.0;
    }
    for (value, known) in values.iter_mut().zip(request.known) {
        match known {
            Known::Fixed(known) | Known::Prior { value: known, .. } => *value = known,
            Known::Nothing => {}
        }
    }
    Start {
        drive: Adjustable::from(Motor::from(values)),
        may_hide_an_angle: is_open(Parameter::Ld) != is_open(Parameter::Lq),
        points_tell_no_angle: steady.is_some_and(|fit| !tell_angle(fit) && part_of_rows(fit, stretches) > MOST),
        shows_dead_time: steady.is_some_and(|fit| fit.voltage_losses.iter().any(|volts| *volts > 0.0)),
    }
}

/// Rows over which a difference of currents stands for their slope: enough to calm noise, few enough to follow a transient.
const DIFFERENCE: usize = 10;

fn spans(rows: &Range<usize>) -> impl Iterator<Item = Range<usize>> {
    rows.clone().step_by(DIFFERENCE).map(|first| first..first + DIFFERENCE).filter(|span| span.end < rows.end)
}

/// The motor of equation (1), with differences of currents over some rows and means of the rest: biased by noise and delay, and
/// good enough to start from.
fn by_differences(log: &Log, stretches: &[Range<usize>]) -> Motor {
    let columns = log.columns();
    let mut equations = Vec::new();
    for rows in stretches {
        for span in spans(rows) {
            let mean = |value: &dyn Fn(usize) -> f64| span.clone().map(value).sum::<f64>() / DIFFERENCE as f64;
            let slope = |current: &[f64]| (current[span.end] - current[span.start]) / (columns.t[span.end] - columns.t[span.start]);
            let omega_i = |current: &[f64]| mean(&|row| columns.omega_e[row] * current[row]);
            let (id, iq) = (mean(&|row| columns.id[row]), mean(&|row| columns.iq[row]));
            let d = [id, slope(&columns.id), -omega_i(&columns.iq), 0.0];
            let q = [iq, omega_i(&columns.id), slope(&columns.iq), mean(&|row| columns.omega_e[row])];
            equations.push(Equation { coefficients: d, value: mean(&|row| columns.ud[row]) });
            equations.push(Equation { coefficients: q, value: mean(&|row| columns.uq[row]) });
        }
    }
    equations.into_iter().collect::<TriangularFactor>().solve().motor
}

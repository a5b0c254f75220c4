//! Where the fit of simulated currents starts, and with what knowledge.

use super::{
    super::request::{Known, Request},
    steady::SteadyFit,
};
use crate::{
    faults::Fault,
    least_squares::{Equation, TriangularFactor},
    levenberg_marquardt::{MOTOR, PriorResidual},
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::adjustable::{Adjustable, Unknown},
};
use std::ops::Range;

/// Parameters that are not fixed; at rest the flux is none, because no current depends on it.
pub(super) fn free(log: &Log, request: &Request) -> Vec<Unknown> {
    let at_rest = log.is_at_rest();
    let is_free = |(unknown, known): &(Unknown, &Known)| {
        !(matches!(known, Known::Fixed(_)) || at_rest && *unknown == Unknown::Motor(Parameter::PsiF))
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
        // An arbitrary fallback start: a tenth of what the voltage allows.
        [of_points, Some(rows[p])].into_iter().flatten().find(|value| *value > 0.0 && value.is_finite()).unwrap_or(0.1 * scale[p])
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

/// The motor of equation (1), with differences of currents over some rows and means of the rest: biased by noise and delay, and
/// good enough to start from.
fn by_differences(log: &Log, stretches: &[Range<usize>]) -> Motor {
    let columns = log.columns();
    let mut equations = Vec::new();
    for rows in stretches {
        for first in rows.clone().step_by(DIFFERENCE).filter(|first| first + DIFFERENCE < rows.end) {
            let span = first..first + DIFFERENCE;
            let mean = |value: &dyn Fn(usize) -> f64| span.clone().map(value).sum::<f64>() / DIFFERENCE as f64;
            let slope = |current: &[f64]| (current[span.end] - current[first]) / (columns.t[span.end] - columns.t[first]);
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

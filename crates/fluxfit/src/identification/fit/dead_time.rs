//! Dead time and device drops, seen by the ripple that they leave.
//!
//! Both take a voltage of constant size from each phase, against its current: a square wave, whose fundamental of amplitude `V_1`
//! looks like resistance and whose fifth and seventh harmonics, `V_1 / 5` and `V_1 / 7`, turn in the rotor's frame at six times its
//! speed, backward and forward. A steady model cannot tell the fundamental from resistance; the harmonics it can see. So `V_1` is
//! estimated from the backward one and counted as doubt, in the direction of the current.
//!
//! What is left of the voltage columns after equation (1) is searched for that harmonic; neighbours between the harmonics tell the noise.
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, has the loss of the fundamental and the low harmonics.

use super::{estimate::Estimate, excitation::Excitation};
use crate::{
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS},
    steady::OperatingPoint,
};

/// The harmonic in the rotor's frame, as a multiple of its speed; the fifth of the stator.
const HARMONIC: f64 = -6.0;

/// The stator harmonic's part of the fundamental.
const PART: f64 = 1.0 / 5.0;

/// Multiples of the speed at which no drive has a harmonic: what is there is noise.
const BETWEEN: [f64; 6] = [-7.4, -6.6, -5.4, -4.6, 4.6, 5.4];

/// The harmonic's power over the noise's at which it counts. Of white noise against six neighbours, F with 2 and 12 degrees of
/// freedom, `(1 + 20 / 6)^-6`: one window in 6600; such an alarm only widens intervals, by an amplitude of noise.
const STANDS_OUT: f64 = 20.0;

/// Least electrical turns of a window, so that harmonics and what lies between them are apart.
const MIN_TURNS: f64 = 5.0;

/// Most rad per row at the harmonic: beyond, a difference of neighbours is no slope.
const MAX_ANGLE: f64 = 1.0;

/// The voltage, V, that each operating point seems to lose along its current; zero where nothing stands out.
pub(crate) fn losses(log: &Log, points: &[OperatingPoint], excitation: &Excitation, estimate: &Estimate) -> Vec<f64> {
    let found = excitation.inductances(&estimate.motor);
    let motor = Motor { ld: found.d, lq: found.q, ..estimate.motor };
    points.iter().map(|point| loss(log, point, &motor).unwrap_or(0.0)).collect()
}

/// How far such losses move each parameter: along the current, and across it by the turn of a row, because it is not known at which instant
/// of its period a current decides.
pub(crate) fn doubt(log: &Log, points: &[OperatingPoint], estimate: &Estimate, losses: &[f64]) -> [f64; PARAMETERS] {
    std::array::from_fn(|p| {
        let (mut along, mut across) = (0.0, 0.0);
        for ((point, gain), loss) in points.iter().zip(&estimate.gains).zip(losses) {
            let (i, gain) = (point.current(), gain[p]);
            let turn = log.segment_of(point.rows.start).map_or(0.0, |segment| point.omega_e() * segment.sample_period);
            let volts_per_ampere = loss / i.magnitude().max(f64::MIN_POSITIVE);
            along += volts_per_ampere * (gain[0] * i.d + gain[1] * i.q);
            across += volts_per_ampere * turn * (gain[1] * i.d - gain[0] * i.q);
        }
        along.hypot(across)
    })
}

fn loss(log: &Log, point: &OperatingPoint, motor: &Motor) -> Option<f64> {
    let columns = log.columns();
    let rows = point.rows.start + 1..point.rows.end.saturating_sub(1);
    let turn = |row: usize| 0.5 * (columns.omega_e[row] + columns.omega_e[row - 1]) * (columns.t[row] - columns.t[row - 1]);
    let turns = rows.clone().map(turn).sum::<f64>().abs() / std::f64::consts::TAU;
    let per_row = turns * std::f64::consts::TAU / rows.len().max(1) as f64;
    if !(turns >= MIN_TURNS && per_row * HARMONIC.abs() <= MAX_ANGLE && motor.ld.is_finite() && motor.lq.is_finite()) {
        return None;
    }
    // What the voltage columns hold beyond equation (1).
    let left = |row: usize| {
        let (i, span) = (Dq { d: columns.id[row], q: columns.iq[row] }, columns.t[row + 1] - columns.t[row - 1]);
        let di_dt = Dq { d: (columns.id[row + 1] - columns.id[row - 1]) / span, q: (columns.iq[row + 1] - columns.iq[row - 1]) / span };
        let u = motor.voltage(i, di_dt, columns.omega_e[row]);
        Dq { d: columns.ud[row] - u.d, q: columns.uq[row] - u.q }
    };
    let multiples = [&[HARMONIC][..], &BETWEEN].concat();
    let mut sums = vec![Dq::default(); multiples.len()];
    let mut theta = 0.0;
    let mean = rows.clone().map(left).fold(Dq::default(), |sum, e| Dq { d: sum.d + e.d, q: sum.q + e.q });
    let count = rows.len() as f64;
    for row in rows {
        theta += turn(row);
        let e = left(row);
        let e = Dq { d: e.d - mean.d / count, q: e.q - mean.q / count };
        for (sum, multiple) in sums.iter_mut().zip(&multiples) {
            // Seen from a frame that turns with the harmonic, it stands still.
            let (sin, cos) = (multiple * theta).sin_cos();
            sum.d += (cos * e.d + sin * e.q) / count;
            sum.q += (cos * e.q - sin * e.d) / count;
        }
    }
    let power = |sum: &Dq| sum.d * sum.d + sum.q * sum.q;
    let noise = sums[1..].iter().map(power).sum::<f64>() / BETWEEN.len() as f64;
    let found = power(&sums[0]);
    // Below the voltages' own accuracy nothing is seen either.
    (found > STANDS_OUT * noise && found.sqrt() > crate::identification::request::VOLTAGE_ACCURACY * point.voltage().magnitude())
        .then(|| found.sqrt() / PART)
}

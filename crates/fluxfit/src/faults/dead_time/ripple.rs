//! The ripple that dead time and device drops leave in steady windows.
//!
//! Both take a voltage of constant size from each phase, against its current: a square wave, whose fundamental of amplitude `V_1`
//! looks like resistance and whose fifth and seventh harmonics, `V_1 / 5` and `V_1 / 7`, turn in the rotor's frame at six times its
//! speed, backward and forward. The means of a window do not distinguish the fundamental from resistance, but its rows show the
//! harmonics. So `V_1` is estimated from the backward one.
//!
//! The backward harmonic is looked for in the residual of equation (1) at every row; the power at frequencies between the harmonics is
//! the noise that it is compared with.
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903, has the loss of the fundamental and the low harmonics.

use crate::{frames::Dq, log::Log, motor::Motor, steady::OperatingPoint};

/// The harmonic in the rotor's frame, as a multiple of its speed; the fifth of the stator.
const HARMONIC: f64 = -6.0;

/// The stator harmonic's part of the fundamental.
const PART: f64 = 1.0 / 5.0;

/// Multiples of the speed at which no drive has a harmonic: the power there is the noise's.
const BETWEEN: [f64; 6] = [-7.4, -6.6, -5.4, -4.6, 4.6, 5.4];

/// The harmonic's power over the noise's at which it counts. Of white noise against six neighbours, F with 2 and 12 degrees of
/// freedom, `(1 + 20 / 6)^-6`: one window in 6600; such an alarm only widens intervals, by an amplitude of noise.
const STANDS_OUT: f64 = 20.0;

/// Least electrical turns of a window: with fewer, the harmonic leaks into the frequencies between the harmonics.
const MIN_TURNS: f64 = 5.0;

/// Most rad per row at the harmonic: beyond, the difference of neighbouring rows is no derivative.
const MAX_ANGLE: f64 = 1.0;

/// What the rows of a window say of the voltage that is lost along its current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Harmonic {
    /// The voltage lost, V, if all of the harmonic's amplitude comes from it.
    pub(crate) loss: f64,
    /// The same of the noise beside the harmonic, V.
    pub(crate) noise: f64,
    /// Whether the harmonic stands out of the noise, and of `voltage_accuracy`, a fraction of the voltage.
    pub(crate) stands_out: bool,
}

/// The harmonic of each operating point; none where the rows cannot show it. Equation (1) takes the parameters of `motor`; an inductance
/// that the points do not determine may be a guess, or infinite: then nothing is seen.
pub(crate) fn harmonics(log: &Log, points: &[OperatingPoint], motor: &Motor, voltage_accuracy: f64) -> Vec<Option<Harmonic>> {
    points.iter().map(|point| harmonic(log, point, motor, voltage_accuracy)).collect()
}

fn harmonic(log: &Log, point: &OperatingPoint, motor: &Motor, voltage_accuracy: f64) -> Option<Harmonic> {
    let columns = log.columns();
    let rows = point.rows.start + 1..point.rows.end.saturating_sub(1);
    let turn = |row: usize| 0.5 * (columns.omega_e[row] + columns.omega_e[row - 1]) * (columns.t[row] - columns.t[row - 1]);
    let turns = rows.clone().map(turn).sum::<f64>().abs() / std::f64::consts::TAU;
    let per_row = turns * std::f64::consts::TAU / rows.len().max(1) as f64;
    if !(turns >= MIN_TURNS && per_row * HARMONIC.abs() <= MAX_ANGLE && motor.ld.is_finite() && motor.lq.is_finite()) {
        return None;
    }
    // The residual of equation (1).
    let residual = |row: usize| {
        let (i, span) = (Dq { d: columns.id[row], q: columns.iq[row] }, columns.t[row + 1] - columns.t[row - 1]);
        let di_dt = Dq { d: (columns.id[row + 1] - columns.id[row - 1]) / span, q: (columns.iq[row + 1] - columns.iq[row - 1]) / span };
        let u = motor.voltage(i, di_dt, columns.omega_e[row]);
        Dq { d: columns.ud[row] - u.d, q: columns.uq[row] - u.q }
    };
    let multiples = [&[HARMONIC][..], &BETWEEN].concat();
    let mut sums = vec![Dq::default(); multiples.len()];
    let mut theta = 0.0;
    let mean = rows.clone().map(residual).fold(Dq::default(), |sum, e| Dq { d: sum.d + e.d, q: sum.q + e.q });
    let count = rows.len() as f64;
    for row in rows {
        theta += turn(row);
        let e = residual(row);
        let e = Dq { d: e.d - mean.d / count, q: e.q - mean.q / count };
        for (sum, multiple) in sums.iter_mut().zip(&multiples) {
            // In a frame that turns with the harmonic, it is a constant.
            let (sin, cos) = (multiple * theta).sin_cos();
            sum.d += (cos * e.d + sin * e.q) / count;
            sum.q += (cos * e.q - sin * e.d) / count;
        }
    }
    let power = |sum: &Dq| sum.d * sum.d + sum.q * sum.q;
    let noise = sums[1..].iter().map(power).sum::<f64>() / BETWEEN.len() as f64;
    let found = power(&sums[0]);
    let stands_out = found > STANDS_OUT * noise && found.sqrt() > voltage_accuracy * point.voltage().magnitude();
    Some(Harmonic { loss: found.sqrt() / PART, noise: noise.sqrt() / PART, stands_out })
}

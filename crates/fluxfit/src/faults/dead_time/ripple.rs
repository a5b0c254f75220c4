//! The ripple that dead time and device drops leave in steady windows.
//!
//! Both take a voltage of constant size from each phase, against its current: a square wave, whose fundamental of amplitude `V_1`
//! looks like resistance and whose fifth and seventh harmonics, `V_1 / 5` and `V_1 / 7`, turn in the rotor's frame at six times its
//! speed, backward and forward. The means of a window do not distinguish the fundamental from resistance, but its rows show the
//! harmonics. So `V_1` is estimated from the backward one.
//!
//! The backward harmonic is looked for in the residual of equation (1): in the parts of voltages and currents at that frequency, for which
//! the derivative of a current is a product, however far apart the rows are. The power at frequencies between the harmonics is the noise
//! that it is compared with.
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903, has the loss of the fundamental and the low harmonics.

use crate::{log::Log, motor::Motor, steady::OperatingPoint};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// The harmonic in the rotor's frame, as a multiple of its speed; the fifth of the stator.
const HARMONIC: f64 = -6.0;

/// The stator harmonic's part of the fundamental.
const PART: f64 = 1.0 / 5.0;

/// Distances from the harmonic and from its mirror image, as multiples of the speed, at which no drive has one: the power is the noise's.
const BESIDE: [f64; 4] = [-1.4, -0.6, 0.6, 1.4];

/// The harmonic's power over the noise's at which it counts. Of white noise against six neighbours, F with 2 and 12 degrees of
/// freedom, `(1 + 20 / 6)^-6`: one window in 6600; such an alarm only widens intervals, by an amplitude of noise.
const STANDS_OUT: f64 = 20.0;

/// Electrical turns of a window over which its ends fade; of one that is no longer, 0.6 times the speed lies at the end of the harmonic's
/// main lobe. In shorter windows the noise is looked for farther away.
const TURNS: f64 = 3.0;

/// Least electrical turns of a window, nine periods of the harmonic.
const MIN_TURNS: f64 = 1.5;

/// Most rad per row at the harmonic: at half a turn per row it and the forward one are the same in the rows.
const MAX_ANGLE: f64 = 2.4;

/// The same two limits where rows may be filtered.
const IF_FILTERED: (f64, f64) = (5.0, 1.0);

/// Least step of a current, as a part of the largest: the difference of its means over some rows before and after.
const STEP: f64 = 0.2;

/// Rows of each of these means.
const STEP_ROWS: usize = 5;

/// A current that makes this part of a step from one row to the next was not filtered much below the rate of the rows.
const AT_ONCE: f64 = 0.7;

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
    let limits = if shows_steps(log) { (MIN_TURNS, MAX_ANGLE) } else { IF_FILTERED };
    points.iter().map(|point| harmonic(log, point, motor, voltage_accuracy, limits)).collect()
}

/// Whether a current somewhere changes at once. Behind a filter of the columns, which hides the harmonic too, none does; nor does one of a
/// slow controller, whose log may or may not be filtered.
fn shows_steps(log: &Log) -> bool {
    let (id, iq) = (&log.columns().id, &log.columns().iq);
    let change = |of: &dyn Fn(&[f64]) -> f64| of(id).hypot(of(iq));
    let mean = |rows: &[f64]| rows.iter().sum::<f64>() / rows.len() as f64;
    let least = STEP * log.peak_current();
    log.segments().iter().any(|segment| {
        let mut rows = segment.rows.start + STEP_ROWS..segment.rows.end.saturating_sub(STEP_ROWS);
        rows.any(|row| {
            let step = change(&|i| mean(&i[row..row + STEP_ROWS]) - mean(&i[row - STEP_ROWS..row]));
            // Noise makes a difference of two rows, but hardly one of means.
            step > least && change(&|i| i[row] - i[row - 1]) > AT_ONCE * step
        })
    })
}

fn harmonic(
    log: &Log,
    point: &OperatingPoint,
    motor: &Motor,
    voltage_accuracy: f64,
    (min_turns, max_angle): (f64, f64),
) -> Option<Harmonic> {
    let columns = log.columns();
    let rows = point.rows.clone();
    let turn = |row: usize| 0.5 * (columns.omega_e[row] + columns.omega_e[row - 1]) * (columns.t[row] - columns.t[row - 1]);
    let theta: Vec<f64> = std::iter::once(0.0)
        .chain(rows.clone().skip(1).scan(0.0, |theta, row| {
            *theta += turn(row);
            Some(*theta)
        }))
        .collect();
    let turned = theta.last()?.abs();
    let turns = turned / TAU;
    let per_row = turned / (rows.len() - 1).max(1) as f64;
    if !(turns >= min_turns && per_row * HARMONIC.abs() <= max_angle && motor.ld.is_finite() && motor.lq.is_finite()) {
        return None;
    }
    let channels = [&columns.ud, &columns.uq, &columns.id, &columns.iq].map(|column| &column[rows.clone()]);
    let means = channels.map(|values| values.iter().sum::<f64>() / rows.len() as f64);
    // The window's ends fade, so that neither a drift nor the rest of a transient leaks into the harmonic.
    let fading = 0.5 * (TURNS / turns).min(1.0) * rows.len() as f64;
    let fade = |row: usize| {
        let from_end = row.min(rows.len() - 1 - row) as f64 + 0.5;
        0.5 - 0.5 * (PI * (from_end / fading).min(1.0)).cos()
    };
    let weights: Vec<f64> = (0..rows.len()).map(fade).collect();
    let whole: f64 = weights.iter().sum();
    // The amplitude of the residual at a multiple of the speed.
    let amplitude = |multiple: f64| {
        let mut parts = [Complex::<f64>::ZERO; 4];
        for (k, (theta, weight)) in theta.iter().zip(&weights).enumerate() {
            let turned_back = Complex::from_polar(weight / whole, -multiple * theta);
            for ((part, values), mean) in parts.iter_mut().zip(channels).zip(means) {
                *part += turned_back * (values[k] - mean);
            }
        }
        let [ud, uq, id, iq] = parts;
        let omega_e = point.omega_e();
        let Motor { rs, ld, lq, .. } = *motor;
        let derivative = Complex::new(0.0, multiple * omega_e);
        let residual_d = ud - id * rs - derivative * id * ld + iq * (omega_e * lq);
        let residual_q = uq - iq * rs - derivative * iq * lq - id * (omega_e * ld);
        (residual_d + residual_q * Complex::I).norm()
    };
    let stretch = (TURNS / turns).max(1.0);
    let around = BESIDE.map(|distance| HARMONIC + stretch * distance);
    let mirrored = BESIDE.iter().filter(|distance| **distance < 0.0).map(|distance| stretch * distance - HARMONIC);
    let beside: Vec<f64> = around.into_iter().chain(mirrored).collect();
    let noise = beside.iter().map(|multiple| amplitude(*multiple).powi(2)).sum::<f64>() / beside.len() as f64;
    let found = amplitude(HARMONIC);
    let stands_out = found.powi(2) > STANDS_OUT * noise && found > voltage_accuracy * point.voltage().magnitude();
    Some(Harmonic { loss: found / PART, noise: noise.sqrt() / PART, stands_out })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;
    use std::ops::Range;

    const MOTOR: Motor = Motor { rs: 0.05, ld: 100e-6, lq: 100e-6, psi_f: 0.01 };
    const OMEGA_E: f64 = 1000.0;

    /// Voltages held constant while the loss, a square wave of fundamental `loss` in each phase, makes its fifth and seventh harmonic: in
    /// the rotor's frame `V_m = V_1 / (m + 1)` at `m` times the speed, driven through `R + j (m + 1) omega L` of a motor with equal
    /// inductances. Rows at this angle, rad, over so many turns; then it goes to half the
    /// current, at once or in twenty rows.
    fn log(loss: f64, per_row: f64, turns: f64, at_once: bool) -> Log {
        let window = window(per_row, turns).len();
        let rows = window + 40;
        let held = Complex::new(-10.0, 40.0);
        let along = held / held.norm();
        let current = |theta: f64| {
            let harmonics = [-6.0, 6.0].map(|m: f64| {
                let voltage = along.powi(m as i32 + 1) * (-loss / (m + 1.0));
                voltage / Complex::new(MOTOR.rs, (m + 1.0) * OMEGA_E * MOTOR.ld) * Complex::from_polar(1.0, m * theta)
            });
            held + harmonics[0] + harmonics[1]
        };
        let after = |row: usize| if at_once { 0.5 } else { 1.0 - 0.5 * ((row - window) as f64 / 20.0).min(1.0) };
        let part = |row: usize| if row < window { 1.0 } else { after(row) };
        let i: Vec<Complex<f64>> = (0..rows).map(|row| current(per_row * row as f64) * part(row)).collect();
        let each = |value: f64| vec![value; rows];
        Log::new(Columns {
            t: (0..rows).map(|row| per_row / OMEGA_E * row as f64).collect(),
            ud: each(MOTOR.rs * held.re - OMEGA_E * MOTOR.lq * held.im + loss * along.re),
            uq: each(MOTOR.rs * held.im + OMEGA_E * (MOTOR.ld * held.re + MOTOR.psi_f) + loss * along.im),
            id: i.iter().map(|i| i.re).collect(),
            iq: i.iter().map(|i| i.im).collect(),
            omega_e: each(OMEGA_E),
            ..Columns::default()
        })
        .unwrap()
    }

    fn window(per_row: f64, turns: f64) -> Range<usize> {
        0..(turns * TAU / per_row).ceil() as usize + 1
    }

    fn said(log: &Log, rows: Range<usize>, motor: &Motor) -> Option<Harmonic> {
        let held = OperatingPoint::measure(log, rows, None);
        harmonics(log, &[held], motor, 0.0)[0]
    }

    #[test]
    fn the_harmonic_says_the_loss_however_far_apart_rows_are() {
        for (per_row, turns) in [(0.02, 8.0), (0.1, 20.0), (0.25, 20.0), (0.39, 40.0), (0.1, 1.7), (0.3, 2.4)] {
            let harmonic = said(&log(2.0, per_row, turns, true), window(per_row, turns), &MOTOR).unwrap();
            assert!((harmonic.loss / 2.0 - 1.0).abs() < 0.02 && harmonic.stands_out, "{per_row} rad, {turns} turns: {harmonic:?}");
        }
    }

    #[test]
    fn rows_that_cannot_show_it_say_nothing() {
        for (per_row, turns) in [(0.1, 1.4), (0.41, 20.0), (PI / 6.0, 20.0)] {
            assert_eq!(said(&log(2.0, per_row, turns, true), window(per_row, turns), &MOTOR), None, "{per_row} rad, {turns} turns");
        }
        assert_eq!(said(&log(2.0, 0.1, 20.0, true), window(0.1, 20.0), &Motor { lq: f64::INFINITY, ..MOTOR }), None);
        // Currents that change slowly may be filtered: rows are to be closer, and windows longer.
        for (per_row, turns, tells) in [(0.2, 20.0, false), (0.1, 4.0, false), (0.1, 20.0, true)] {
            let harmonic = said(&log(2.0, per_row, turns, false), window(per_row, turns), &MOTOR);
            assert_eq!(harmonic.is_some(), tells, "{per_row} rad, {turns} turns");
        }
    }

    fn with_noise(log: &Log, noise: f64) -> Log {
        let mut draws = crate::optimizer::Draws::seeded(7, 0);
        let mut columns = log.columns().clone();
        columns.id.iter_mut().chain(&mut columns.iq).for_each(|i| *i += noise * draws.normal());
        Log::new(columns).unwrap()
    }

    /// Noise of 2 A of 41 A, which comes in after a filter, makes no step.
    #[test]
    fn noise_is_no_step() {
        assert!(shows_steps(&with_noise(&log(2.0, 0.2, 20.0, true), 2.0)));
        assert!(!shows_steps(&with_noise(&log(2.0, 0.2, 20.0, false), 2.0)));
    }

    /// Noise of 0.1 A is no harmonic, and bounds the loss by about what it makes of one: its part at one frequency through 0.5 ohm, times
    /// five.
    #[test]
    fn noise_bounds_the_loss() {
        let (quiet, rows) = (log(0.0, 0.2, 40.0, true), window(0.2, 40.0));
        let harmonic = said(&with_noise(&quiet, 0.1), rows.clone(), &MOTOR).unwrap();
        // Both axes.
        let expected = 5.0 * 5.0 * OMEGA_E * MOTOR.ld * 0.1 * (2.0 / rows.len() as f64).sqrt();
        assert!(!harmonic.stands_out && harmonic.noise > 0.5 * expected && harmonic.noise < 2.0 * expected, "{harmonic:?} {expected}");
        assert!(harmonic.loss < 3.0 * expected, "{harmonic:?} {expected}");
    }
}

//! dq quantities and speed from phase quantities and an angle.

use super::channels::Channels;
use crate::channel::Channel;
use fluxfit::{
    frames::{Abc, AlphaBeta},
    log,
};
use fluxfit_units::significant;
use std::f64::consts::{PI, TAU};

/// Minimum number of rows on either side for a slope: fewer give noise.
const FEWEST_ROWS: usize = 4;

/// Maximum number of rows on either side, where the rotor hardly turns.
const MOST_ROWS: usize = 1000;

/// Relative error that is allowed for a speed from an angle in steps.
const SPEED_ERROR: f64 = 1e-3;

/// A step of the angle of at least this size, rad, is an encoder's resolution; smaller ones are rounding.
const COARSE: f64 = TAU / 5000.0;

/// Replaces quantities of the stator's frame by those of the phases, which all further steps know.
pub(super) fn of_stator_frame(channels: &mut Channels) {
    let sets = [
        ([Channel::UAlpha, Channel::UBeta], [Channel::UA, Channel::UB, Channel::UC]),
        ([Channel::IAlpha, Channel::IBeta], [Channel::IA, Channel::IB, Channel::IC]),
    ];
    for ([alpha, beta], phases) in sets {
        let (Some(alpha), Some(beta)) = (channels.take(alpha), channels.take(beta)) else { continue };
        let mut values: [Vec<f64>; 3] = Default::default();
        for (alpha, beta) in alpha.into_iter().zip(beta) {
            let Abc { a, b, c } = AlphaBeta { alpha, beta }.to_abc();
            values.iter_mut().zip([a, b, c]).for_each(|(values, value)| values.push(value));
        }
        phases.into_iter().zip(values).for_each(|(phase, values)| channels.set(phase, values));
    }
}

/// Whether [`transform`] will compute both voltages and currents of the axes.
pub(super) fn give_all_axes(channels: &Channels) -> bool {
    [(Channel::Ud, Channel::UA), (Channel::Id, Channel::IA)].iter().all(|(d, a)| channels.get(*d).is_none() && channels.get(*a).is_some())
}

/// Applies the Clarke and Park transforms where only phase quantities are logged, and computes the speed from the angle where no
/// speed is. Returns notes.
pub(super) fn transform(channels: &mut Channels) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(theta) = angle_between(channels) {
        channels.set(Channel::ThetaE, theta);
        notes.push("theta_e is computed from the currents in phase and in dq quantities".to_owned());
    }
    let Some((t, theta)) = channels.get(Channel::T).zip(channels.get(Channel::ThetaE)) else { return notes };
    let is_needed = channels.get(Channel::OmegaE).is_none() || channels.get(Channel::Ud).is_none() || channels.get(Channel::Id).is_none();
    if !is_needed {
        return notes;
    }
    let (step, smooth, speed) = smoothed(t, theta);
    let theta = if step > 0.0 { smooth } else { theta.to_vec() };
    if step > 0.0 {
        notes.push(format!("theta_e has steps of {} degrees and was smoothed; the remaining error, some tenths of a percent of the parameters, is not part of any interval", significant(step.to_degrees(), 3)));
        channels.set(Channel::ThetaE, theta.clone());
    }
    let sets = [
        ([Channel::UA, Channel::UB, Channel::UC], [Channel::Ud, Channel::Uq]),
        ([Channel::IA, Channel::IB, Channel::IC], [Channel::Id, Channel::Iq]),
    ];
    for ([a, b, c], [d, q]) in sets {
        if channels.get(d).is_some() && channels.get(q).is_some() {
            continue;
        }
        let (Some(of_a), Some(of_b)) = (channels.get(a), channels.get(b)) else { continue };
        let of_c = channels.get(c);
        let vector = |row: usize| {
            let (a, b) = (of_a[row], of_b[row]);
            Abc { a, b, c: of_c.map_or(-a - b, |c| c[row]) }.to_alpha_beta().to_dq(theta[row])
        };
        let (on_d, on_q) = (0..theta.len()).map(vector).map(|dq| (dq.d, dq.q)).unzip();
        let third = if of_c.is_none() { format!(", with {} = -{} - {}", c.name(), a.name(), b.name()) } else { String::new() };
        notes.push(format!("{} and {} are computed from the phase quantities and the angle{third}", d.name(), q.name()));
        channels.set(d, on_d);
        channels.set(q, on_q);
    }
    if channels.get(Channel::OmegaE).is_none() {
        channels.set(Channel::OmegaE, speed);
        notes.push("omega_e is computed as the slope of theta_e".to_owned());
    }
    notes
}

/// The angle of a log with phase voltages, no angle, and currents both in phase and in dq quantities: the angle between the two
/// current vectors.
fn angle_between(channels: &Channels) -> Option<Vec<f64>> {
    let is_missing = channels.get(Channel::ThetaE).is_none() && channels.get(Channel::UA).is_some();
    let (id, iq) = (channels.get(Channel::Id)?, channels.get(Channel::Iq)?);
    let (ia, ib) = (channels.get(Channel::IA)?, channels.get(Channel::IB)?);
    let ic = channels.get(Channel::IC);
    let angle = |row: usize| {
        let (a, b) = (ia[row], ib[row]);
        let phases = Abc { a, b, c: ic.map_or(-a - b, |c| c[row]) }.to_alpha_beta();
        (phases.beta.atan2(phases.alpha) - iq[row].atan2(id[row])).rem_euclid(TAU)
    };
    is_missing.then(|| (0..id.len()).map(angle).collect())
}

/// The step of an angle, 0 if it has none; the angle without steps, and its slope, rad/s, at each row. Both come from a least-squares
/// parabola around the row, over as many rows as the step requires, never across a gap. Over N rows that each turn by `w`, steps of
/// `q` give `w` a relative error of about `(q/w) N^(-3/2)`.
fn smoothed(t: &[f64], theta: &[f64]) -> (f64, Vec<f64>, Vec<f64>) {
    let step = coarse_step(theta);
    let (mut angles, mut slopes) = (Vec::new(), Vec::new());
    for rows in log::without_gaps(t) {
        let (t, turned) = (&t[rows.clone()], unwrapped(&theta[rows]));
        let last = turned.len() - 1;
        let reach = |row: usize| {
            // Mean turn of the rotor from row to row around this row.
            let (from, to) = (row.saturating_sub(MOST_ROWS / 8), (row + MOST_ROWS / 8).min(last));
            let turn = (turned[to] - turned[from]).abs() / (to - from).max(1) as f64;
            let needed = if step > 0.0 && turn > 0.0 { (step / (SPEED_ERROR * turn)).powf(2.0 / 3.0) / 2.0 } else { 0.0 };
            if step > 0.0 && turn == 0.0 { MOST_ROWS } else { (needed as usize).clamp(FEWEST_ROWS, MOST_ROWS) }
        };
        for row in 0..=last {
            let reach = reach(row);
            let around = row.saturating_sub(reach)..(row + reach + 1).min(last + 1);
            let (angle, slope) = tangent(&t[around.clone()], &turned[around], t[row]);
            angles.push(angle);
            slopes.push(slope);
        }
    }
    (step, angles, slopes)
}

/// The step of an angle with coarse steps, rad; 0 if the angle has none.
fn coarse_step(theta: &[f64]) -> f64 {
    let smallest = theta.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|change| *change > 1e-9).fold(f64::INFINITY, f64::min);
    let on_grid = |angle: &&f64| ((**angle / smallest) - (**angle / smallest).round()).abs() < 0.01;
    let is_grid = smallest.is_finite() && smallest >= COARSE && theta.iter().filter(on_grid).count() * 10 >= theta.len() * 9;
    if is_grid { smallest } else { 0.0 }
}

/// Value and slope at `at` of the least-squares parabola.
fn tangent(t: &[f64], y: &[f64], at: f64) -> (f64, f64) {
    let span = (t[t.len() - 1] - t[0]).max(f64::MIN_POSITIVE);
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    // Normal equations for three unknowns; time is relative to the row and divided by the span, so they are well scaled.
    let (mut s, mut r) = ([0.0; 5], [0.0; 3]);
    for (t, y) in t.iter().zip(y) {
        let x = (t - at) / span;
        let mut power = 1.0;
        for k in 0..5 {
            s[k] += power;
            if k < 3 {
                r[k] += power * (y - mean);
            }
            power *= x;
        }
    }
    let determinant = |c: [[f64; 3]; 3]| {
        c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0])
            + c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0])
    };
    let whole = determinant([[s[0], s[1], s[2]], [s[1], s[2], s[3]], [s[2], s[3], s[4]]]);
    let slope = determinant([[s[0], r[0], s[2]], [s[1], r[1], s[3]], [s[2], r[2], s[4]]]);
    let value = determinant([[r[0], s[1], s[2]], [r[1], s[2], s[3]], [r[2], s[3], s[4]]]);
    if whole.abs() > f64::MIN_POSITIVE { (mean + value / whole, slope / whole / span) } else { (mean, 0.0) }
}

/// The angle without jumps at the end of each turn.
fn unwrapped(theta: &[f64]) -> Vec<f64> {
    let mut turns = 0.0;
    let mut last = theta.first().copied().unwrap_or(0.0);
    let continued = |angle: &f64| {
        let step = angle - last;
        if step.abs() > PI {
            turns -= (step / TAU).round() * TAU;
        }
        last = *angle;
        angle + turns
    };
    theta.iter().map(continued).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Phase quantities of a dq vector: the d axis is on phase a at angle 0, q leads by a quarter turn.
    fn phases(d: f64, q: f64, theta: f64) -> [f64; 3] {
        [0.0, 1.0, 2.0].map(|k| d * (theta - k * TAU / 3.0).cos() - q * (theta - k * TAU / 3.0).sin())
    }

    #[test]
    fn phase_quantities_are_transformed_to_dq() {
        let t: Vec<f64> = (0..400).map(|row| f64::from(row) * 1e-4).collect();
        let theta: Vec<f64> = t.iter().map(|t| (300.0 * t + 1.0) % TAU).collect();
        let mut channels = Channels::default();
        let of = |d: f64, q: f64, k: usize| theta.iter().map(|theta| phases(d, q, *theta)[k]).collect::<Vec<_>>();
        channels.set(Channel::UA, of(-40.0, 90.0, 0));
        channels.set(Channel::UB, of(-40.0, 90.0, 1));
        channels.set(Channel::UC, of(-40.0, 90.0, 2));
        channels.set(Channel::IA, of(-2.0, 9.0, 0));
        channels.set(Channel::IB, of(-2.0, 9.0, 1));
        channels.set(Channel::ThetaE, theta.clone());
        channels.set(Channel::T, t);
        let notes = transform(&mut channels);
        assert_eq!(notes.len(), 3, "{notes:?}");
        for (channel, expected) in
            [(Channel::Ud, -40.0), (Channel::Uq, 90.0), (Channel::Id, -2.0), (Channel::Iq, 9.0), (Channel::OmegaE, 300.0)]
        {
            let found = channels.get(channel).unwrap();
            assert!(found.iter().all(|value| (value - expected).abs() < 1e-9 * expected.abs()), "{}: {:?}", channel.name(), &found[..3]);
        }
    }

    #[test]
    fn steps_of_the_angle_do_not_appear_in_the_speed() {
        // 250 steps a turn, 20 kHz, 100 Hz.
        let t: Vec<f64> = (0..2000).map(|row| f64::from(row) * 5e-5).collect();
        let theta: Vec<f64> = t.iter().map(|t| (t * 100.0 % 1.0 * 250.0).floor() / 250.0 * TAU).collect();
        let (_, _, omega) = smoothed(&t, &theta);
        let error = omega[500..1500].iter().map(|omega| (omega / (100.0 * TAU) - 1.0).abs()).fold(0.0, f64::max);
        assert!(error < 3.0 * SPEED_ERROR, "{error}");
        // Nor in the angle: apart from half a step, by which truncation is late, it is right within a sixth of a step.
        let (step, angle, _) = smoothed(&t, &theta);
        let late = |row: usize| (t[row] * 100.0 * TAU - angle[row] - step / 2.0 + PI).rem_euclid(TAU) - PI;
        let error = (500..1500).map(|row| late(row).abs()).fold(0.0, f64::max);
        assert!(error < step / 6.0, "{error} {step}");
    }
}

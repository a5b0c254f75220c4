//! dq quantities and speed of a log that holds those of the phases and an angle.

use super::Channels;
use crate::channel::Channel;
use fluxfit::{frames::Abc, log};
use fluxfit_units::number::significant;
use std::f64::consts::{PI, TAU};

/// Fewest rows on either side of a slope: less is noise.
const FEWEST_ROWS: usize = 4;

/// Most of them, where the rotor hardly turns.
const MOST_ROWS: usize = 1000;

/// Relative error of a speed that comes from an angle in steps.
const SPEED_ERROR: f64 = 1e-3;

/// A step of an angle that most rows repeat, or that is this part of a turn or more, is a converter's.
const COARSE: f64 = TAU / 5000.0;

/// Clarke and Park transforms where only phase quantities are there; the angle's slope where no speed is. What was done.
pub(super) fn transform(channels: &mut Channels) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(theta) = angle_between(channels) {
        channels.set(Channel::ThetaE, theta);
        notes.push("theta_e is the angle between the current's vector in the phases and in dq".to_owned());
    }
    let Some((t, theta)) = channels.get(Channel::T).zip(channels.get(Channel::ThetaE)) else { return notes };
    let is_needed = channels.get(Channel::OmegaE).is_none() || channels.get(Channel::Ud).is_none() || channels.get(Channel::Id).is_none();
    if !is_needed {
        return notes;
    }
    let (step, smooth, speed) = smoothed(t, theta);
    let theta = if step > 0.0 { smooth } else { theta.to_vec() };
    if step > 0.0 {
        notes.push(format!("theta_e comes in steps of {} degrees and was smoothed; what is left of them, tenths of a percent of the answer, is in no interval", significant(step.to_degrees(), 3)));
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
        let third = if of_c.is_none() { format!(", {} being what makes the sum zero", c.name()) } else { String::new() };
        notes.push(format!("{} and {} are made of the phases and the angle{third}", d.name(), q.name()));
        channels.set(d, on_d);
        channels.set(q, on_q);
    }
    if channels.get(Channel::OmegaE).is_none() {
        channels.set(Channel::OmegaE, speed);
        notes.push("omega_e is the slope of theta_e".to_owned());
    }
    notes
}

/// The angle of a log that has the voltages of the phases, no angle, and the currents in both frames: theirs is the angle between.
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

/// The step of an angle, 0 if it has none; the angle without it, and its slope, rad/s, at each row: by the parabola of least squares
/// around it, over as many rows as the steps need, never across a gap. N rows that each turn by `w` and are uniformly within a step
/// `q` give `w` a relative error of about `(q/w) N^(-3/2)`.
fn smoothed(t: &[f64], theta: &[f64]) -> (f64, Vec<f64>, Vec<f64>) {
    let step = coarse_step(theta);
    let (mut angles, mut slopes) = (Vec::new(), Vec::new());
    for rows in log::without_gaps(t) {
        let (t, turned) = (&t[rows.clone()], unwrapped(&theta[rows]));
        let last = turned.len() - 1;
        let reach = |row: usize| {
            // How far the rotor turns from row to row hereabouts.
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

/// The step of an angle that comes in coarse ones, rad; 0 of one that does not.
fn coarse_step(theta: &[f64]) -> f64 {
    let smallest = theta.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|change| *change > 1e-9).fold(f64::INFINITY, f64::min);
    let on_grid = |angle: &&f64| ((**angle / smallest) - (**angle / smallest).round()).abs() < 0.01;
    let is_grid = smallest.is_finite() && smallest >= COARSE && theta.iter().filter(on_grid).count() * 10 >= theta.len() * 9;
    if is_grid { smallest } else { 0.0 }
}

/// Value and slope at `at` of the parabola of least squares.
fn tangent(t: &[f64], y: &[f64], at: f64) -> (f64, f64) {
    let span = (t[t.len() - 1] - t[0]).max(f64::MIN_POSITIVE);
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    // Normal equations in time over the span, around the row: well scaled, three unknowns.
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

/// The angle without its jumps from turn to turn.
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

    /// d axis on phase a at angle 0, q ahead by a quarter turn: the phases of a vector, by the book.
    fn phases(d: f64, q: f64, theta: f64) -> [f64; 3] {
        [0.0, 1.0, 2.0].map(|k| d * (theta - k * TAU / 3.0).cos() - q * (theta - k * TAU / 3.0).sin())
    }

    #[test]
    fn phases_become_dq() {
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
    fn steps_of_the_angle_do_not_become_speed() {
        // 250 steps a turn, 20 kHz, 100 Hz.
        let t: Vec<f64> = (0..2000).map(|row| f64::from(row) * 5e-5).collect();
        let theta: Vec<f64> = t.iter().map(|t| (t * 100.0 % 1.0 * 250.0).floor() / 250.0 * TAU).collect();
        let (_, _, omega) = smoothed(&t, &theta);
        let error = omega[500..1500].iter().map(|omega| (omega / (100.0 * TAU) - 1.0).abs()).fold(0.0, f64::max);
        assert!(error < 3.0 * SPEED_ERROR, "{error}");
        // Nor errors of the frame: but for half a step, by which rounding down is late, the angle is a sixth of a step right.
        let (step, angle, _) = smoothed(&t, &theta);
        let late = |row: usize| (t[row] * 100.0 * TAU - angle[row] - step / 2.0 + PI).rem_euclid(TAU) - PI;
        let error = (500..1500).map(|row| late(row).abs()).fold(0.0, f64::max);
        assert!(error < step / 6.0, "{error} {step}");
    }
}

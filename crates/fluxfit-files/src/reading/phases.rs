//! dq quantities and speed of a log that holds those of the phases and an angle.

use super::Channels;
use crate::channel::Channel;
use fluxfit::frames::Abc;
use std::f64::consts::{PI, TAU};

/// Electrical turn over which the speed is the slope of the angle: an angle in 250 steps a turn is known to 1/900 of it, a third of a
/// step's deviation; less, and the steps become speed.
const TURN_OF_SPEED: f64 = 2.0 * TAU;

/// Fewest rows of such a slope, on either side.
const FEWEST_ROWS: usize = 8;

/// Most of them, where the rotor stands.
const MOST_ROWS: usize = 1000;

/// Clarke and Park transforms where only phase quantities are there; the angle's slope where no speed is. What was done.
pub(super) fn transform(channels: &mut Channels) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(theta) = angle_between(channels) {
        channels.set(Channel::ThetaE, theta);
        notes.push("theta_e is the angle between the current's vector in the phases and in dq".to_owned());
    }
    let Some(theta) = channels.get(Channel::ThetaE).map(<[f64]>::to_vec) else { return notes };
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
    if channels.get(Channel::OmegaE).is_none()
        && let Some(t) = channels.get(Channel::T)
    {
        let speed = slope(t, &theta);
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

/// Slope of an angle, rad/s, over [`TURN_OF_SPEED`] around each row, by the straight line of least squares.
fn slope(t: &[f64], theta: &[f64]) -> Vec<f64> {
    let turned = unwrapped(theta);
    let rows = turned.len();
    let (mut from, mut to) = (0, 0);
    (0..rows)
        .map(|row| {
            let reach = |other: usize| (turned[other] - turned[row]).abs() > TURN_OF_SPEED / 2.0;
            while from < row && (row - from > MOST_ROWS || (reach(from) && row - from > FEWEST_ROWS)) {
                from += 1;
            }
            to = to.max(row);
            while to + 1 < rows && to - row < MOST_ROWS && (!reach(to) || to - row < FEWEST_ROWS) {
                to += 1;
            }
            line(&t[from..=to], &turned[from..=to])
        })
        .collect()
}

/// Slope of the straight line of least squares; 0 of a point.
fn line(t: &[f64], y: &[f64]) -> f64 {
    let count = t.len() as f64;
    let (mean_t, mean_y) = (t.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
    let (mut cross, mut square) = (0.0, 0.0);
    for (t, y) in t.iter().zip(y) {
        cross += (t - mean_t) * (y - mean_y);
        square += (t - mean_t).powi(2);
    }
    if square > 0.0 { cross / square } else { 0.0 }
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
        let omega = slope(&t, &theta);
        let error = omega[500..1500].iter().map(|omega| (omega / (100.0 * TAU) - 1.0).abs()).fold(0.0, f64::max);
        assert!(error < 1e-3, "{error}");
    }
}

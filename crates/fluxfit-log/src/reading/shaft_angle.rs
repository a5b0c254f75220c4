//! An angle of the shaft where that of the rotor's field is needed: the currents of the phases turn with the field, as many times as fast
//! as the shaft as there are pole pairs.

use super::channels::Channels;
use crate::channel::Channel;
use fluxfit::frames::Abc;
use std::f64::consts::{PI, TAU};

/// Currents below this part of the largest are mostly noise, and so is their direction.
const LARGE: f64 = 0.3;

/// The currents turn at most this far from row to row, rad, or it is not known how often they turned.
const MOST_TURN: f64 = 2.0;

/// The angle turns at least this far in the rows that count, rad: a change of the currents in the rotor's frame, of less than half a turn,
/// then moves the ratio by less than a sixth.
const LEAST_TURN: f64 = 3.0 * TAU;

/// Largest distance of the ratio from a whole number.
const WHOLE: f64 = 0.2;

/// More pole pairs than motors have.
const MOST_POLE_PAIRS: f64 = 60.0;

/// Of more rows than one in so many the angle would turn by more than half a turn: then its unit is another one.
const FEWEST_ROWS_TO_A_TURN: usize = 4;

/// The number of pole pairs and what a value of the angle is, in rad, if in one of these units of rad the currents of the phases turn so
/// many times as fast; nothing if they turn as fast as the angle in one of them.
pub(super) fn pole_pairs(channels: &Channels, units: &[f64]) -> Option<(u32, f64)> {
    let ratios: Vec<(f64, f64)> = units.iter().filter_map(|unit| Some((ratio(channels, *unit)?, *unit))).collect();
    let is_near = |ratio: f64, whole: f64| (ratio - whole).abs() < WHOLE;
    if ratios.iter().any(|(ratio, _)| is_near(ratio.abs(), 1.0)) {
        return None;
    }
    let (ratio, unit) =
        ratios.into_iter().find(|(ratio, _)| is_near(*ratio, ratio.round()) && (2.0..=MOST_POLE_PAIRS).contains(&ratio.round()))?;
    Some((ratio.round() as u32, unit))
}

/// Whether the currents of the phases turn as fast as the angle in a unit of so many rad.
pub(super) fn is_electrical(channels: &Channels, unit: f64) -> bool {
    ratio(channels, unit).is_some_and(|ratio| (ratio - 1.0).abs() < WHOLE)
}

/// How many times as fast as the angle, in a `unit` of rad, the currents of the phases turn, in either direction.
fn ratio(channels: &Channels, unit: f64) -> Option<f64> {
    let [theta, a, b] = [Channel::ThetaE, Channel::IA, Channel::IB].map(|channel| channels.get(channel));
    let (theta, a, b) = (theta?, a?, b?);
    let c = channels.get(Channel::IC);
    let steps = || theta.windows(2).map(|pair| (pair[1] - pair[0]) * unit);
    if steps().filter(|step| step.abs() > PI).count() * FEWEST_ROWS_TO_A_TURN > theta.len() {
        return None;
    }
    let vectors: Vec<(f64, f64)> = (0..theta.len())
        .map(|row| {
            let vector = Abc { a: a[row], b: b[row], c: c.map_or(-a[row] - b[row], |c| c[row]) }.to_alpha_beta();
            (vector.alpha.hypot(vector.beta), vector.beta.atan2(vector.alpha))
        })
        .collect();
    let largest = vectors.iter().fold(0.0, |most: f64, (length, _)| most.max(*length));
    let within = |turn: f64| (turn + PI).rem_euclid(TAU) - PI;
    let (mut of_currents, mut of_angle) = (0.0, 0.0);
    // An angle in digits stands still in some rows while the rotor turns.
    let mut direction = 1.0_f64;
    for (row, step) in steps().enumerate() {
        let [before, now] = [vectors[row], vectors[row + 1]];
        let turn = within(now.1 - before.1);
        if before.0.min(now.0) > LARGE * largest && turn.abs() < MOST_TURN {
            let step = within(step);
            direction = if step == 0.0 { direction } else { step.signum() };
            of_currents += turn * direction;
            of_angle += step.abs();
        }
    }
    (of_angle > LEAST_TURN).then(|| of_currents / of_angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pole pairs that phase currents tell of an angle of the shaft that is `scale` times rad and begins again at `wraps_at`.
    fn told(pairs: f64, scale: f64, wraps_at: Option<f64>) -> Option<u32> {
        let mut channels = Channels::default();
        let rows = || (0..4000).map(|row| f64::from(row) * 1e-3);
        // The shaft turns at 30 rad/s; i_q changes its sign, i_d is there for a while.
        let current = |t: f64, phase: f64| {
            let [d, q] = [if t > 2.0 { -2.0 } else { 0.0 }, if t > 1.0 { 5.0 } else { -5.0 }];
            let angle = pairs * 30.0 * t - phase * TAU / 3.0;
            d * angle.cos() - q * angle.sin()
        };
        channels.set(Channel::IA, rows().map(|t| current(t, 0.0)).collect());
        channels.set(Channel::IB, rows().map(|t| current(t, 1.0)).collect());
        let angle = |t: f64| scale * wraps_at.map_or(30.0 * t, |end| (30.0 * t).rem_euclid(end));
        channels.set(Channel::ThetaE, rows().map(angle).collect());
        pole_pairs(&channels, &[1.0, 1.0_f64.to_radians()]).map(|(pairs, unit)| {
            assert!((unit * scale - 1.0).abs() < 1e-12, "{unit} {scale}");
            pairs
        })
    }

    #[test]
    fn phase_currents_turn_with_the_field() {
        assert_eq!(told(4.0, 1.0, Some(TAU)), Some(4));
        assert_eq!(told(7.0, 1.0, None), Some(7));
        assert_eq!(told(4.0, 1.0_f64.to_degrees(), Some(TAU)), Some(4));
        // The angle of the field, in rad and in degrees; digits of an encoder; one that runs backwards; ratios that no motor has.
        for wraps_at in [None, Some(TAU)] {
            assert_eq!(told(1.0, 1.0, wraps_at), None);
            assert_eq!(told(1.0, 1.0_f64.to_degrees(), wraps_at), None);
        }
        assert_eq!(told(4.0, 4096.0 / TAU, Some(TAU)), None);
        assert_eq!(told(4.0, -1.0, None), None);
        assert_eq!(told(2.5, 1.0, None), None);
    }
}

//! A column with a usual name of an angle is the angle if it turns as fast as the speed says: `theta` may also be that of a controller, a
//! temperature or a position.

use super::{channels::Channels, chosen::ChosenColumn};
use crate::{channel::Channel, note::Note, problem::Problem};
use Channel::{OmegaE, T, ThetaE};
use fluxfit_files::{Advice, FileError};
use fluxfit_units::{Unit, wording::shorten};
use std::f64::consts::{PI, TAU};

/// Between two rows an angle that is compared turns at least this, rad, or noise decides; and at most this, or it is not known how often
/// it turned.
const TURN: std::ops::Range<f64> = 1e-3..2.5;

/// Smallest number of pairs of rows.
const FEWEST: usize = 20;

/// Largest median difference between the turns of the angle and those by the speed, as a share of these.
const DIFFERENCE: f64 = 0.1;

/// Keeps such an angle if it turns with the speed, in rad or in degrees where no unit is stated. Another one is left out, or refused if the
/// log cannot be read without it.
pub(super) fn settle(channels: &mut Channels, chosen: &[ChosenColumn], notes: &mut Vec<Note>) -> Result<(), FileError> {
    let Some(column) = chosen.iter().find(|column| column.channel == ThetaE && column.is_alias) else { return Ok(()) };
    let Some(theta) = channels.get(ThetaE) else { return Ok(()) };
    let header = shorten(&column.header);
    let units: &[Unit] = if column.is_unit_stated { &[column.unit] } else { &[Unit::Radian, Unit::Degree] };
    // Values were converted already where the unit is stated.
    let size = |unit: &Unit| if column.is_unit_stated { 1.0 } else { unit.in_si() };
    let fitting = units.iter().find(|unit| match channels.get(OmegaE) {
        Some(omega) => turns_with(theta, omega, channels.get(T).unwrap_or_default(), size(unit)),
        None => winds(theta, size(unit)),
    });
    if let Some(unit) = fitting {
        let factor = size(unit);
        notes.push(format!("theta_e: column '{header}' read as {}, as it turns", unit.prose()).into());
        if factor != 1.0 {
            let scaled = theta.iter().map(|angle| angle * factor).collect();
            channels.set(ThetaE, scaled);
        }
        return Ok(());
    }
    if channels.get(OmegaE).is_none() || channels.get(Channel::IA).is_some() || channels.get(Channel::UA).is_some() {
        return Err(FileError::from(Problem::NoAngle).in_column(&column.header));
    }
    let sentence =
        format!("theta_e is left out: column '{header}' does not turn as fast as omega_e says; map theta_e to it if it is the angle");
    notes.push(Note::with_advice(sentence, Advice::MapColumns(vec![(ThetaE.name(), Some(column.header.clone()))])));
    channels.take(ThetaE);
    Ok(())
}

/// Whether an angle of this unit, in rad, turns from row to row as the speed says.
fn turns_with(theta: &[f64], omega: &[f64], t: &[f64], unit: f64) -> bool {
    let pairs = (1..t.len()).filter_map(|row| {
        let turn = 0.5 * (omega[row] + omega[row - 1]) * (t[row] - t[row - 1]);
        let found = (theta[row] - theta[row - 1]) * unit;
        let difference = (found - turn + PI).rem_euclid(TAU) - PI;
        TURN.contains(&turn.abs()).then_some((difference / turn).abs())
    });
    let mut differences: Vec<f64> = pairs.filter(|difference| difference.is_finite()).collect();
    if differences.len() < FEWEST {
        return false;
    }
    let middle = differences.len() / 2;
    *differences.select_nth_unstable_by(middle, f64::total_cmp).1 < DIFFERENCE
}

/// Whether values of this unit, in rad, are those of an angle that winds around at the end of a turn, several times.
fn winds(theta: &[f64], unit: f64) -> bool {
    let low = theta.iter().copied().fold(f64::INFINITY, f64::min) * unit;
    let high = theta.iter().copied().fold(f64::NEG_INFINITY, f64::max) * unit;
    let jumps = theta.windows(2).filter(|pair| ((pair[1] - pair[0]) * unit).abs() > PI).count();
    (0.8 * TAU..1.01 * TAU).contains(&(high - low)) && jumps > 1 && 4 * jumps < theta.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(theta: impl Fn(f64) -> f64, with_speed: bool) -> (Option<Vec<f64>>, usize) {
        let t: Vec<f64> = (0..200).map(|row| f64::from(row) * 1e-3).collect();
        let mut channels = Channels::default();
        channels.set(ThetaE, t.iter().map(|t| theta(*t)).collect());
        if with_speed {
            channels.set(OmegaE, vec![300.0; t.len()]);
        }
        channels.set(T, t);
        let column = ChosenColumn {
            channel: ThetaE,
            index: 0,
            header: "theta".to_owned(),
            unit: Unit::Radian,
            pole_pairs: 1,
            scale: 1.0,
            is_optional: with_speed,
            is_unit_stated: false,
            is_alias: true,
            instants: None,
        };
        let mut notes = Vec::new();
        let settled = settle(&mut channels, &[column], &mut notes);
        assert_eq!(settled.is_ok(), with_speed || channels.get(ThetaE).is_some_and(|theta| winds(theta, 1.0)));
        (channels.take(ThetaE), notes.len())
    }

    #[test]
    fn an_angle_turns_with_the_speed() {
        let turning = |t: f64| (300.0 * t).rem_euclid(TAU);
        let (theta, notes) = settled(turning, true);
        assert_eq!((theta.map(|theta| theta[1]), notes), (Some(0.3), 1));
        // In degrees.
        let (theta, _) = settled(|t| turning(t).to_degrees(), true);
        assert!((theta.unwrap_or_default()[1] - 0.3).abs() < 1e-12);
        // Of the shaft, backwards, or another quantity.
        for other in [(|t: f64| 75.0 * t) as fn(f64) -> f64, |t| -300.0 * t, |t| 20.0 + t, |_| 0.0] {
            assert_eq!(settled(other, true), (None, 1));
        }
    }

    #[test]
    fn without_a_speed_it_winds_around() {
        assert_eq!(settled(|t| (300.0 * t).rem_euclid(TAU), false).1, 1);
        assert_eq!(settled(|t| 20.0 + t, false).1, 0);
    }
}

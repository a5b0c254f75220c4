//! A column with a usual name of an angle is the angle if it turns as fast as the speed says: `theta` may also be that of a controller, a
//! temperature or a position.

use super::{
    channels::Channels,
    chosen::{ChosenColumn, left_out},
    shaft_angle,
};
use crate::{channel::Channel, header_unit::states_electrical, note::Note, problem::Problem};
use Channel::{OmegaE, T, ThetaE};
use fluxfit_files::{Advice, FileError};
use fluxfit_units::{Unit, significant, wording::shorten};
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
    let Some(column) = chosen.iter().find(|column| column.channel == ThetaE) else { return Ok(()) };
    let Some(theta) = channels.get(ThetaE) else { return Ok(()) };
    let header = shorten(&column.header);
    // Values were converted already where the unit is written.
    let other_turn_than_known = turn(theta).filter(|turn| !column.is_unit_written && !is_in_rad(*turn) && !DEGREES.contains(turn));
    let of_round_turn = other_turn_than_known.and_then(round_turn).map(|turn| (turn, TAU / turn));
    let possible: Vec<f64> = match (column.is_unit_written, other_turn_than_known) {
        (true, _) => vec![1.0],
        (_, None) => vec![1.0, Unit::Degree.in_si()],
        (_, Some(_)) => of_round_turn.iter().map(|(_, unit)| *unit).collect(),
    };
    let is_open = !column.unit.is_mechanical() && !states_electrical(&column.header);
    if let Some((pole_pairs, unit)) = shaft_angle::pole_pairs(channels, &possible).filter(|_| is_open) {
        let is_stated = column.pole_pairs > 1 && column.pole_pairs != pole_pairs;
        let stated = if is_stated { format!(", where you state {}", column.pole_pairs) } else { String::new() };
        let sentence = format!(
            "theta_e: column '{header}' read as the angle of the shaft, with {pole_pairs} pole pairs{stated}: the phase currents turn {pole_pairs} times as fast; its zero must lie on the d axis"
        );
        notes.push(sentence.into());
        let electrical = theta.iter().map(|angle| angle * unit * f64::from(pole_pairs)).collect();
        channels.set(ThetaE, electrical);
        return Ok(());
    }
    if let Some((turn, unit)) = of_round_turn.filter(|(_, unit)| shaft_angle::is_electrical(channels, *unit)) {
        let sentence = format!("theta_e: column '{header}' read as an angle whose turn is {turn}: so the phase currents turn");
        notes.push(sentence.into());
        let scaled = theta.iter().map(|angle| angle * unit).collect();
        channels.set(ThetaE, scaled);
        return Ok(());
    }
    if !column.is_alias {
        return match turn(theta).filter(|turn| !column.is_unit_written && !is_in_rad(*turn)) {
            // With a speed, degrees are found where the columns are compared.
            Some(turn) if DEGREES.contains(&turn) && channels.get(OmegaE).is_none() => {
                notes.push(format!("theta_e: column '{header}' read as {}, as it turns", Unit::Degree.prose()).into());
                let scaled = theta.iter().map(|angle| angle * Unit::Degree.in_si()).collect();
                channels.set(ThetaE, scaled);
                Ok(())
            }
            Some(turn) if !DEGREES.contains(&turn) => leave_out(channels, column, turn, notes),
            _ => Ok(()),
        };
    }
    let units: &[Unit] = if column.is_unit_stated { &[column.unit] } else { &[Unit::Radian, Unit::Degree] };
    // Values were converted already where the unit is stated.
    let size = |unit: &Unit| if column.is_unit_stated { 1.0 } else { unit.in_si() };
    // An angle of the shaft may wind around after a turn of the shaft.
    let of_shaft = if column.unit.is_mechanical() { f64::from(column.pole_pairs) } else { 1.0 };
    // Where the speed tells that it is that of the shaft.
    let of_stated_pairs = f64::from(column.pole_pairs);
    let turns_with_shaft = |unit: &&Unit| {
        let turns = |omega: &[f64]| turns_with(theta, omega, channels.get(T).unwrap_or_default(), size(unit) * of_stated_pairs);
        is_open && column.pole_pairs > 1 && channels.get(OmegaE).is_some_and(turns)
    };
    let fitting = units.iter().find(|unit| match channels.get(OmegaE) {
        Some(omega) => turns_with(theta, omega, channels.get(T).unwrap_or_default(), size(unit)),
        None => winds(theta, size(unit)) || winds(theta, size(unit) / of_shaft),
    });
    if fitting.is_none()
        && let Some(unit) = units.iter().find(turns_with_shaft)
    {
        let pole_pairs = column.pole_pairs;
        notes.push(
            format!("theta_e: column '{header}' read as the angle of the shaft, with {pole_pairs} pole pairs, as it turns; its zero must lie on the d axis").into(),
        );
        let electrical = theta.iter().map(|angle| angle * size(unit) * of_stated_pairs).collect();
        channels.set(ThetaE, electrical);
        return Ok(());
    }
    if let Some(unit) = fitting {
        // The speed is computed from it, and neither the phases nor the name tell whose angle it is.
        let is_of_either = channels.get(OmegaE).is_none()
            && [Channel::IA, Channel::IAlpha, Channel::UA].iter().all(|phase| channels.get(*phase).is_none());
        if is_of_either && is_open {
            return Err(FileError::from(Problem::AngleRotation).in_column(&column.header));
        }
        let factor = size(unit);
        let own = if column.unit.is_mechanical() && !unit.is_mechanical() { unit.of_shaft() } else { *unit };
        notes.push(format!("theta_e: column '{header}' read as {}, as it turns", own.prose()).into());
        if factor != 1.0 {
            let scaled = theta.iter().map(|angle| angle * factor).collect();
            channels.set(ThetaE, scaled);
        }
        return Ok(());
    }
    if channels.get(OmegaE).is_none() || channels.get(Channel::IA).is_some() || channels.get(Channel::UA).is_some() {
        // It may be called the angle and wind around like one, in turns or digits of an encoder.
        let span = turn(theta).filter(|span| !column.is_unit_written && round_turn(*span).is_some());
        return Err(FileError::from(span.map_or(Problem::NoAngle, |span| other_turn(column, span))).in_column(&column.header));
    }
    let sentence = format!(
        "theta_e is left out: column '{header}' does not turn as fast as omega_e says; if it is the angle of the shaft, state the number of pole pairs; map theta_e to it if it is that of the field"
    );
    notes.push(Note::with_advice(sentence, Advice::MapColumns(vec![(ThetaE.name(), Some(column.header.clone()))])));
    channels.take(ThetaE);
    Ok(())
}

/// Turns of an angle in rad and in degrees, as they are found: within a row's turn.
const TURNS: std::ops::Range<f64> = 0.8 * TAU..1.01 * TAU;
const DEGREES: std::ops::Range<f64> = 288.0..363.0;

/// Leaves out an angle that winds around at neither, or refuses it if the log cannot be read without it.
fn leave_out(channels: &mut Channels, column: &ChosenColumn, turn: f64, notes: &mut Vec<Note>) -> Result<(), FileError> {
    let problem = FileError::from(other_turn(column, turn));
    let is_needed = [OmegaE, Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].iter().any(|channel| channels.get(*channel).is_none());
    if is_needed || !column.is_optional {
        return Err(problem.in_column(&column.header));
    }
    notes.push(left_out(ThetaE, &problem.in_column(&column.header)).into());
    channels.take(ThetaE);
    Ok(())
}

/// The problem of an angle that spans this from the start of a turn to its end.
fn other_turn(column: &ChosenColumn, span: f64) -> Problem {
    let round = round_turn(span);
    let scale = significant(TAU / round.unwrap_or(span), if round.is_some() { 6 } else { 3 });
    let is_exact = round.is_some();
    let turn = round.map_or_else(|| format!("about {}", significant(span, 3)), |turn| turn.to_string());
    Problem::AngleTurn { header: column.header.clone(), turn, scale, is_exact }
}

/// Digits of a turn that encoders have besides powers of two, and the turn itself, as 1 or from -1 to 1.
const TURN_DIGITS: [f64; 13] = [1.0, 2.0, 100.0, 360.0, 400.0, 1000.0, 2000.0, 3600.0, 4000.0, 5000.0, 8000.0, 10_000.0, 36_000.0];

/// A turn of fewer is none of digits.
const FEWEST_DIGITS: f64 = 10.0;

/// By this share a turn may be larger than what the rows span: they miss its end.
const MISSED: f64 = 0.03;

/// The one round number at which an angle that spans this winds around.
fn round_turn(span: f64) -> Option<f64> {
    let powers = (4..=24).map(|power| f64::from(1_u32 << power));
    // Of digits, the last one is missing.
    if let Some(of_digits) = TURN_DIGITS.into_iter().chain(powers.clone()).find(|turn| *turn >= FEWEST_DIGITS && *turn == span + 1.0) {
        return Some(of_digits);
    }
    let most = |turn: f64| span * (1.0 + MISSED) + if turn < FEWEST_DIGITS { 0.0 } else { 1.0 };
    let mut near = TURN_DIGITS.into_iter().chain(powers).filter(|turn| (span..=most(*turn)).contains(turn));
    near.next().filter(|_| near.next().is_none())
}

/// Whether an angle that winds around there is in rad: after one electrical turn, or after one of the shaft.
fn is_in_rad(turn: f64) -> bool {
    let turns = turn / TAU;
    TURNS.contains(&turn) || turns < MOST_TURNS && (turns.round() - SHORT..turns.round() + 0.01).contains(&turns)
}

/// More pole pairs than motors have; 360 would be 57.3 turns in rad.
const MOST_TURNS: f64 = 40.5;

/// By this share of an electrical turn the rows may miss its end.
const SHORT: f64 = 0.1;

/// The value at which an angle winds around, several times, in the units of the file; none of one that does not.
fn turn(theta: &[f64]) -> Option<f64> {
    let low = theta.iter().copied().fold(f64::INFINITY, f64::min);
    let high = theta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let steps = || theta.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let jumps = steps().filter(|step| *step > 0.5 * (high - low)).count();
    // Every jump is one of nearly the whole turn, and between two of them the angle passes through all of it.
    let is_whole = steps().filter(|step| *step > 0.5 * (high - low)).all(|step| step > NEARLY * (high - low));
    (jumps > 1 && is_whole && FEW_JUMPS * jumps < theta.len()).then_some(high - low)
}

/// A jump at the end of a turn is at least this share of what the angle spans,
const NEARLY: f64 = 0.75;

/// and there are at least so many rows to a turn.
const FEW_JUMPS: usize = 8;

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
            header: if with_speed { "theta" } else { "theta_el" }.to_owned(),
            unit: Unit::Radian,
            pole_pairs: 1,
            scale: 1.0,
            is_optional: with_speed,
            is_unit_stated: false,
            is_unit_written: false,
            is_share: false,
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

    /// An encoder of 4096 steps, turns, degrees; and radians over the turn of a shaft with four pole pairs, and over many turns.
    #[test]
    fn an_angle_in_digits_is_not_in_rad() {
        let angle = |full: f64| (0..1000).map(|row| (f64::from(row) * 0.0123 * full).rem_euclid(full)).collect::<Vec<_>>();
        for (full, is_known) in [(4096.0, false), (1.0, false), (360.0, false), (TAU, true), (4.0 * TAU, true)] {
            let found = turn(&angle(full)).unwrap();
            assert!((found / full - 1.0).abs() < 0.02 && is_in_rad(found) == is_known, "{full} {found}");
        }
        let turns = [4074.0, 0.993, 1.0, 1.99, 1.5, 65_535.0, 777.0, 999.0, 1023.0].map(round_turn);
        let expected = [Some(4096.0), Some(1.0), Some(1.0), Some(2.0), None, Some(65_536.0), None, Some(1000.0), Some(1024.0)];
        assert_eq!(turns, expected);
        assert_eq!(turn(&(0..1000).map(f64::from).collect::<Vec<_>>()), None);
    }

    #[test]
    fn without_a_speed_it_winds_around() {
        assert_eq!(settled(|t| (300.0 * t).rem_euclid(TAU), false).1, 1);
        assert_eq!(settled(|t| 20.0 + t, false).1, 0);
    }
}

//! A frame that is not the magnets': the zero of an angle that nobody aligned, an angle counted from the q axis or from another phase.
//!
//! A small offset of the angle is found with the motor. From a large one no fit leads there; but the [regression](super::regression) of
//! the voltages is cheap enough to be tried in frames all around, beside voltages that turn with the speed because they act late. The
//! flux of the magnets, which is positive along the d axis, tells one frame from its opposite.

use super::regression::{Frame, Mean, UNEXPLAINED, fit, means};
use crate::log::Log;
use std::{cmp::Ordering, f64::consts::PI};

/// Smallest offset, rad, that is looked for: the fit of currents finds those of 45 degrees in most logs, of 30 degrees in all that were
/// tried.
const LEAST_OFFSET: f64 = 30.0 * DEGREE;

/// Step of the offsets that are tried first, rad. One that misses by half of it leaves 13 % of the voltages.
const STEP: f64 = 15.0 * DEGREE;

/// Times that the steps are halved around the best: down to a quarter of a degree.
const HALVINGS: u32 = 6;

/// Most moves with steps of one size: each goes to a better neighbour.
const MOVES: usize = 10;

/// Step of the angles, rad, by which voltages that act late are turned at the largest speed; and the largest of them, to either side.
const LATE: f64 = 0.24;
const MOST_LATE: f64 = 0.5;

/// An angle that is read too large by this, rad, is usual.
const USUAL: f64 = 15.0 * DEGREE;

/// The same in other frames that are to be ruled out: three rows at 14 rows a turn.
const MOST_LATE_OF_OTHERS: f64 = 1.44;

/// What a frame leaves of the voltages, as a fraction, beside what the usual ones do, because filters and lags are found with the motor
/// too; and beside what the magnets alone do, without any current.
const MUCH_LESS: f64 = 0.4;

/// Most that the best frame leaves of the voltages, as a fraction. Filters of the currents left 0.09.
const MOST_LEFT: f64 = 0.1;

/// A frame that leaves at most this many times what the best does is as good.
const AS_GOOD: f64 = 1.5;

/// No frame this far from the best, rad, or further, may be as good: so well the angle of a drive is known otherwise, within two of the
/// standard errors that operating points take it with.
const NEXT: f64 = 6.0 * DEGREE;

/// Means that are enough: a long log has many that say the same.
const ENOUGH: usize = 300;

const DEGREE: f64 = PI / 180.0;

/// By how much the angle is read too large, rad, from -pi to pi, where it is by 30 degrees or more and the log tells.
pub fn turned_frame(log: &Log) -> Option<f64> {
    let all = means(log);
    let means: Vec<Mean> = all.iter().step_by(all.len().div_ceil(ENOUGH).max(1)).copied().collect();
    let as_it_is = fit(&means, &Frame::AS_IT_IS, true)?.left;
    if as_it_is < UNEXPLAINED {
        return None;
    }
    let fastest = means.iter().fold(0.0_f64, |most, mean| most.max(mean.speed().abs()));
    let turned = |offset: f64, late: f64| -> Vec<Mean> {
        means.iter().map(|mean| mean.in_frame_behind(offset, late * mean.speed() / fastest)).collect()
    };
    // Without an inductance it is the voltage of the magnets alone, with the currents anywhere: then only the voltages are turned.
    let explained = |offset: f64, late: f64| {
        let fit = fit(&turned(offset, late), &Frame::AS_IT_IS, true).filter(|fit| fit.lq() > 0.0);
        fit.map_or(f64::INFINITY, |fit| fit.left)
    };
    let left = |offset: f64, late: f64| if late.abs() <= MOST_LATE { explained(offset, late) } else { f64::INFINITY };
    let steps = (PI / STEP) as i32;
    let lates = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| k * LATE);
    let frames = (1 - steps..=steps).flat_map(|k| lates.map(|late| (f64::from(k) * STEP, late)));
    let tried: Vec<Tried> = frames.map(|(offset, late)| Tried { left: left(offset, late), offset, late }).collect();
    if tried.iter().copied().min_by(by_left)?.offset.abs() < LEAST_OFFSET {
        return None;
    }
    let best = finest(&tried, &left, [STEP, LATE])?;
    if best.left > MOST_LEFT || best.offset.abs() < LEAST_OFFSET {
        return None;
    }
    // Any voltages may act late: at one speed those of an isotropic motor are like another offset, and at i_d = 0 an offset is like another
    // inductance.
    let most = (MOST_LATE_OF_OTHERS / LATE) as i32;
    let any = |offset: f64, late: f64| if late.abs() <= MOST_LATE_OF_OTHERS { explained(offset, late) } else { f64::INFINITY };
    let at =
        |offset: f64| (-most..=most).map(move |k| f64::from(k) * LATE).map(move |late| Tried { left: any(offset, late), offset, late });
    let least = |offset: f64| finest(&at(offset).collect::<Vec<_>>(), &any, [0.0, LATE]).map_or(f64::INFINITY, |tried| tried.left);
    let mut around = (1..).map(|k| f64::from(k) * NEXT).take_while(|distance| *distance <= PI);
    let is_as_good = |distance: f64| [-distance, distance].into_iter().any(|by| least(best.offset + by) <= AS_GOOD * best.left);
    if around.any(is_as_good) {
        return None;
    }
    let by_magnets: Vec<Mean> = turned(best.offset, best.late).iter().map(Mean::without_current).collect();
    let by_magnets = fit(&by_magnets, &Frame::AS_IT_IS, true).map_or(1.0, |fit| fit.left);
    let beside = [-USUAL, 0.0, USUAL].into_iter().map(least).fold(by_magnets, f64::min);
    (best.left <= MUCH_LESS * beside).then(|| (best.offset + PI).rem_euclid(2.0 * PI) - PI)
}

/// A frame, and what it leaves of the voltages, as a fraction.
#[derive(Clone, Copy)]
struct Tried {
    left: f64,
    /// By how much the angle is read too large, rad.
    offset: f64,
    /// By how much the voltages are turned at the largest speed, rad.
    late: f64,
}

/// The best of them, and around it with smaller and smaller steps, from these of the offset and of the lag.
fn finest(tried: &[Tried], left: &impl Fn(f64, f64) -> f64, [step, late_step]: [f64; 2]) -> Option<Tried> {
    let mut best = tried.iter().copied().min_by(by_left)?;
    for halvings in 1..=HALVINGS {
        let part = 0.5_f64.powi(halvings as i32);
        for _ in 0..MOVES {
            let Tried { left: before, offset, late } = best;
            let beside = |k: i32| (offset + f64::from(k / 3 - 1) * part * step, late + f64::from(k % 3 - 1) * part * late_step);
            let is_other = |k: &i32| (step > 0.0 || k / 3 == 1) && *k != 4;
            let tried = (0..9).filter(is_other).map(beside).map(|(offset, late)| Tried { left: left(offset, late), offset, late });
            best = tried.chain([best]).min_by(by_left)?;
            if best.left >= before {
                break;
            }
        }
    }
    Some(best)
}

fn by_left(one: &Tried, other: &Tried) -> Ordering {
    one.left.total_cmp(&other.left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frames::Dq, log::Columns, motor::Motor};

    const MOTOR: Motor = Motor { rs: 0.5, ld: 2e-3, lq: 3e-3, psi_f: 0.05 };

    /// Points at two values of each current and of the speed, 100 rows each; the angle is read too large by so many degrees, and the
    /// voltages are turned by so many rad at the largest speed. Of the currents' voltages too if they are in the magnets' frame.
    fn log(degrees: f64, late: f64, are_currents_turned: bool) -> Log {
        let mut columns = Columns::default();
        for row in 0..800 {
            let point = row / 100;
            let side = |bit: i32| f64::from(point >> bit & 1);
            let (i, omega_e) = (Dq { d: -4.0 * side(0), q: 3.0 + 5.0 * side(1) }, 300.0 + 300.0 * side(2));
            let u = MOTOR.steady_voltage(i, omega_e).turned(-degrees.to_radians() - late * omega_e / 600.0);
            let i = if are_currents_turned { i.turned(-degrees.to_radians()) } else { i };
            columns.t.push(f64::from(row) * 1e-3);
            columns.ud.push(u.d);
            columns.uq.push(u.q);
            columns.id.push(i.d);
            columns.iq.push(i.q);
            columns.omega_e.push(omega_e);
        }
        Log::new(columns).unwrap()
    }

    #[test]
    fn a_large_offset_is_found_in_any_direction() {
        for degrees in (-170..180).step_by(25).map(f64::from).filter(|degrees| degrees.abs() > 35.0) {
            for late in [0.0, 0.15] {
                let found = turned_frame(&log(degrees, late, true)).map_or(0.0, f64::to_degrees);
                let miss = (found - degrees + 180.0).rem_euclid(360.0) - 180.0;
                assert!(miss.abs() < 0.5, "{degrees} {late}: {found}");
            }
        }
    }

    /// A small one, a lag of the voltages, and voltages whose phases are in another order than the currents'.
    #[test]
    fn nothing_else_is_an_offset() {
        for (degrees, late, are_currents_turned) in [(0.0, 0.0, true), (20.0, 0.1, true), (0.0, 0.45, true), (120.0, 0.0, false)] {
            assert_eq!(turned_frame(&log(degrees, late, are_currents_turned)), None, "{degrees} {late}");
        }
    }

    /// At one speed late voltages turn an isotropic motor's impedance, as another frame does: neither is told.
    #[test]
    fn late_voltages_at_one_speed_are_no_offset() {
        for late in [-1.0, -0.6, 0.6, 1.0] {
            let all = log(0.0, late, true);
            let half = |column: &Vec<f64>| column[400..].to_vec();
            let Columns { t, ud, uq, id, iq, omega_e, .. } = all.columns();
            let columns = Columns {
                t: half(t),
                ud: half(ud),
                uq: half(uq),
                id: half(id),
                iq: half(iq),
                omega_e: half(omega_e),
                ..Columns::default()
            };
            assert_eq!(turned_frame(&Log::new(columns).unwrap()), None, "{late}");
        }
    }

    /// One operating point does not tell: many frames explain it.
    #[test]
    fn one_operating_point_tells_no_offset() {
        let all = log(120.0, 0.0, true);
        let one = |column: &Vec<f64>| column[..100].to_vec();
        let Columns { t, ud, uq, id, iq, omega_e, .. } = all.columns();
        let columns =
            Columns { t: one(t), ud: one(ud), uq: one(uq), id: one(id), iq: one(iq), omega_e: one(omega_e), ..Columns::default() };
        assert_eq!(turned_frame(&Log::new(columns).unwrap()), None);
    }
}

//! A log whose speed is zero in every row: of a rotor that stands, or of a drive that did not log its speed.
//!
//! At rest a held current needs the voltage `R_s i` along it, and what dead time and devices take, which is at most a twelfth of a turn
//! off: the phases lose it by the signs of their currents. The voltage of magnets that turn and of inductances is in no such direction.

use crate::{frames::Dq, steady::OperatingPoint};
use std::f64::consts::FRAC_PI_4;

/// The angle between voltage and current, rad, that no rotor at rest exceeds: a twelfth of a turn, and as much again by half for errors of
/// the sensors.
const LARGEST_ANGLE: f64 = FRAC_PI_4;

/// Whether the held currents of a log are those of a rotor at rest.
pub(crate) fn is_possible(points: &[OperatingPoint]) -> bool {
    let angle = |u: Dq, i: Dq| (u.d * i.q - u.q * i.d).atan2(u.d * i.d + u.q * i.q).abs();
    let largest = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    // Of a current that is nearly zero the direction is noise.
    let carry_current = points.iter().filter(|point| point.current().magnitude() > LEAST_CURRENT * largest);
    carry_current.map(|point| angle(point.voltage(), point.current())).all(|angle| angle < LARGEST_ANGLE)
}

/// Part of the largest current.
const LEAST_CURRENT: f64 = 0.2;

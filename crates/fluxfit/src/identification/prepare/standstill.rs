//! A log whose speed is zero in every row: of a rotor that stands, or of a drive that did not log its speed.
//!
//! At rest a held current needs the voltage `R_s i` along it, and what dead time and devices take, which is at most a twelfth of a turn
//! off: the phases lose it by the signs of their currents. The voltage of magnets that turn and of inductances is in no such direction.

use crate::{frames::Dq, steady::OperatingPoint};
use std::f64::consts::FRAC_PI_4;

/// Largest angle between voltage and current of a rotor at rest, rad: a twelfth of a turn, and 15 degrees for errors of the sensors.
const LARGEST_ANGLE: f64 = FRAC_PI_4;

/// Currents below this part of the largest are left out: their direction is noise.
const LEAST_CURRENT: f64 = 0.2;

/// Whether the voltage of every held current lies along it, as at rest.
pub(crate) fn voltages_lie_along_currents(points: &[OperatingPoint]) -> bool {
    let angle = |u: Dq, i: Dq| (u.d * i.q - u.q * i.d).atan2(u.d * i.d + u.q * i.q).abs();
    let largest = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    let carry_current = points.iter().filter(|point| point.current().magnitude() > LEAST_CURRENT * largest);
    carry_current.map(|point| angle(point.voltage(), point.current())).all(|angle| angle < LARGEST_ANGLE)
}

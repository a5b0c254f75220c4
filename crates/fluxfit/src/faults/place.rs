//! Where in the log and in the stator a period lies: what faults depend on besides voltages and currents, the same for all drives.

use crate::frames::Turn;

/// A period of the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// Plus one or minus one from row to row of the log: the carrier's half, where each half is a row.
    pub(crate) half: f64,
    /// Where the drive samples in the middle of its own periods: by how much the voltage changes half-way, V, `d, q` in the frame of the
    /// rotor's most likely angle. All legs of the inverter are high at the start then, else low.
    pub(crate) changes: Option<[f64; 2]>,
    /// The rotor at its start, middle and end.
    pub(crate) start: Turn,
    pub(crate) middle: Turn,
    pub(crate) end: Turn,
    /// Its length, s.
    pub(crate) length: f64,
    /// Speed, electrical rad/s.
    pub(crate) omega_e: f64,
    /// What the speed gains in a second, electrical rad/s²; zero where it is from the angle.
    pub(crate) acceleration: f64,
    /// Speed by which an angle that is read late is too small, electrical rad/s.
    pub(crate) late_by: f64,
    /// The same of the angle by which the rotor lies here: zero where that is the integral of the speed, which is not late.
    pub(crate) rotor_late_by: f64,
    /// What that speed gains in a second where the rotor's speed is from the angle, electrical rad/s²; else zero.
    pub(crate) angle_acceleration: f64,
    /// By which the voltage would be turned further if the speed that advanced its angle lagged by a second, rad.
    pub(crate) advance_per_lag: f64,
    /// One over the DC voltage, 1/V.
    pub(crate) per_bus: f64,
    /// Its time within the log: from minus one half at the first row to plus one half at the last.
    pub(crate) time: f64,
}

impl Place {
    /// A period of a second at standstill.
    #[cfg(test)]
    pub(crate) fn still(rotor: Turn) -> Self {
        Self {
            half: 1.0,
            changes: None,
            start: rotor,
            middle: rotor,
            end: rotor,
            length: 1.0,
            omega_e: 0.0,
            acceleration: 0.0,
            late_by: 0.0,
            rotor_late_by: 0.0,
            angle_acceleration: 0.0,
            advance_per_lag: 0.0,
            per_bus: 0.0,
            time: 0.0,
        }
    }
}

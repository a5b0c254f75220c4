//! What the faults of a drive do to the currents and voltages of each row: their effects in the order in which they apply, with sines and
//! cosines of fitted angles computed once, for many drives side by side.

use super::{
    Faults,
    current_gains::balanced,
    current_offset::removed,
    dead_time::{PeriodTurns, reduced},
    disturbance::{corrected, remaining},
    saturation::extra_flux,
};
use crate::{
    frames::{Dq, Turn, turned},
    lanes::Number,
};

/// The faults of one drive, or of one drive per lane, ready to act.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acting<V> {
    /// Voltage, width, ripple.
    dead_time: [V; 3],
    /// Alpha, beta.
    current_offset: [V; 2],
    imbalance: [V; 2],
    /// Cosine and sine of the turn from the measured currents' frame to the magnet's: the angle's offset less the turn of two sensors.
    current_turn: [V; 2],
    /// Cosine and sine of the turn from the frame of the logged angle to the magnet's.
    angle: [V; 2],
    /// `s_d`, `s_q`, `c`.
    saturation: [V; 3],
    /// `d, q`.
    observer_gain: [V; 2],
    /// Which kinds of faults any of them has.
    pub(crate) kinds: FaultKinds,
}

/// Kinds of faults, by what they take part in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct FaultKinds {
    pub(crate) sensors: bool,
    pub(crate) voltages: bool,
    pub(crate) flux: bool,
    pub(crate) observer: bool,
}

impl FaultKinds {
    pub(crate) fn of(faults: &Faults) -> Self {
        let none = Faults::default();
        let turns = faults.angle_offset != none.angle_offset;
        Self {
            sensors: turns || faults.current_offset != none.current_offset || faults.current_gains != none.current_gains,
            voltages: turns || faults.dead_time != none.dead_time,
            flux: faults.saturation != none.saturation,
            observer: faults.disturbance != none.disturbance,
        }
    }

    /// Those that either has.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            sensors: self.sensors || other.sensors,
            voltages: self.voltages || other.voltages,
            flux: self.flux || other.flux,
            observer: self.observer || other.observer,
        }
    }

    pub(crate) fn any(self) -> bool {
        self != Self::default()
    }
}

impl<V> Acting<V> {
    /// The numbers of all drives, `lanes` having been given how to find one.
    #[inline(always)]
    pub(crate) fn of(kinds: FaultKinds, lanes: impl Fn(fn(&Faults) -> f64) -> V) -> Self {
        Self {
            dead_time: [lanes(|f| f.dead_time.voltage), lanes(|f| f.dead_time.width), lanes(|f| f.dead_time.ripple)],
            current_offset: [lanes(|f| f.current_offset.current.alpha), lanes(|f| f.current_offset.current.beta)],
            imbalance: [lanes(|f| f.current_gains.imbalance.alpha), lanes(|f| f.current_gains.imbalance.beta)],
            current_turn: [
                lanes(|f| (f.angle_offset.angle - f.current_gains.turn).cos()),
                lanes(|f| (f.angle_offset.angle - f.current_gains.turn).sin()),
            ],
            angle: [lanes(|f| f.angle_offset.angle.cos()), lanes(|f| f.angle_offset.angle.sin())],
            saturation: [lanes(|f| f.saturation.d), lanes(|f| f.saturation.q), lanes(|f| f.saturation.cross)],
            observer_gain: [lanes(|f| f.disturbance.gain.d), lanes(|f| f.disturbance.gain.q)],
            kinds,
        }
    }
}

impl Acting<f64> {
    /// The faults of one drive.
    pub(crate) fn of_one(faults: &Faults) -> Self {
        Self::of(FaultKinds::of(faults), |number| number(faults))
    }

    /// The current in the motor, A, where `logged` was measured with the rotor there.
    pub(crate) fn current(&self, logged: Dq, rotor: Turn) -> Dq {
        let [d, q] = self.motor_current([logged.d, logged.q], rotor);
        Dq { d, q }
    }
}

impl<V: Number> Acting<V> {
    /// The current in the motor, A, in the frame of its magnet, where `logged` was measured with the rotor there: the faults of the
    /// sensors are undone.
    #[inline(always)]
    pub(crate) fn motor_current(&self, logged: [V; 2], rotor: Turn) -> [V; 2] {
        if !self.kinds.sensors {
            return logged;
        }
        let balanced = balanced(self.imbalance, removed(self.current_offset, logged, rotor), rotor);
        let [cos, sin] = self.current_turn;
        turned(balanced, cos, sin)
    }

    /// The voltage that acts on the motor over a period, V, in the frame of its magnet, where `logged` was commanded, given the current
    /// `i`, A, in the motor at its start.
    #[inline(always)]
    pub(crate) fn motor_voltage(&self, logged: [V; 2], i: [V; 2], turns: &PeriodTurns) -> [V; 2] {
        if !self.kinds.voltages {
            return logged;
        }
        let [cos, sin] = self.angle;
        turned(reduced(self.dead_time, logged, turned(i, cos, -sin), turns), cos, sin)
    }

    /// Flux, Wb, beyond `L i + psi_f` at current `i`, A.
    #[inline(always)]
    pub(crate) fn extra_flux(&self, i: [V; 2]) -> [V; 2] {
        extra_flux(self.saturation, i)
    }

    /// The simulated current `i`, corrected by the observer of a disturbed motor.
    #[inline(always)]
    pub(crate) fn corrected(&self, i: [V; 2], error: [V; 2]) -> [V; 2] {
        if self.kinds.observer { corrected(self.observer_gain, i, error) } else { i }
    }

    /// What that correction leaves of a difference between two simulations.
    #[inline(always)]
    pub(crate) fn remaining(&self, difference: [V; 2]) -> [V; 2] {
        if self.kinds.observer { remaining(self.observer_gain, difference) } else { difference }
    }
}

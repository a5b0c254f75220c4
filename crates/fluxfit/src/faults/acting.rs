//! What the faults of a drive do to the currents and voltages of each row: their effects in the order in which they apply, with sines and
//! cosines of fitted angles computed once, for many drives side by side.

use super::{
    Faults, Place, angle_delay,
    current_gains::balanced,
    current_offset::removed,
    dead_time::switched_period::{LossKinds, SwitchedLoss, Winding},
    disturbance::{corrected, remaining},
    filter::{filtered, unfiltered},
    flux_harmonics, resistance_drift,
    saturation::extra_flux,
    speed_lag,
};
use crate::{
    frames::{Dq, Turn, turned},
    lanes::{Number, both},
};

/// The faults of one drive, or of one drive per lane, ready to act.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acting<V> {
    dead_time: SwitchedLoss<V>,
    /// Cosine and sine of the angle of phase a where the log does not have it.
    phase: [V; 2],
    /// Alpha, beta.
    current_offset: [V; 2],
    imbalance: [V; 2],
    /// Cosine and sine of the turn from the measured currents' frame to the magnet's: the angle's offset less the turn of two sensors.
    current_turn: [V; 2],
    /// Cosine and sine of the turn from the frame of the logged angle to the magnet's.
    angle: [V; 2],
    /// By which the angle is late, s.
    angle_delay: V,
    /// By which the commanded voltages are late, s: by the angle and by themselves.
    voltage_delay: V,
    /// Weights over a period.
    current_filter: [V; 4],
    /// What of a change of the current within a period the filter passes on, inverted.
    before_filter: V,
    noise_before_filter: V,
    /// By how many periods the logged voltages are moved ahead in time: what their filter holds back, less what they act later.
    voltage_advance: V,
    speed_lag: V,
    /// `d cos, d sin, q cos, q sin`.
    flux_harmonics: [V; 4],
    resistance_change: V,
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
    /// What the sensors of current do.
    pub(crate) sensors: bool,
    /// A frame that is turned, by a constant angle or with the speed.
    pub(crate) turns: bool,
    /// A frame whose turn depends on the speed.
    pub(crate) delay: bool,
    /// A filter of the currents.
    pub(crate) filter: bool,
    /// A filter of the voltages, or a frame that is turned.
    pub(crate) voltages: bool,
    /// What dead time and devices take.
    pub(crate) loss: LossKinds,
    /// Dead time without an angle.
    pub(crate) phase: bool,
    /// Voltages beside those of the equation (1).
    pub(crate) beside: bool,
    pub(crate) flux: bool,
    pub(crate) observer: bool,
}

impl FaultKinds {
    /// All kinds at once.
    #[cfg(test)]
    pub(crate) const ALL: Self = Self {
        sensors: true,
        turns: true,
        delay: true,
        filter: true,
        voltages: true,
        loss: LossKinds { edges: true, lasting: true },
        phase: true,
        beside: true,
        flux: true,
        observer: true,
    };

    pub(crate) fn of(faults: &Faults) -> Self {
        let none = Faults::default();
        let late = faults.angle_delay != none.angle_delay;
        let turns = faults.angle_offset != none.angle_offset || late;
        let lags = faults.voltage_lag != none.voltage_lag;
        Self {
            sensors: turns || faults.current_offset != none.current_offset || faults.current_gains != none.current_gains,
            turns,
            delay: late || lags,
            filter: faults.filter.phases != 0.0 || faults.filter.currents != 0.0,
            voltages: turns || lags || faults.speed_lag != none.speed_lag || faults.filter.voltages != 0.0,
            loss: LossKinds::of(&faults.dead_time),
            phase: faults.dead_time.phase != 0.0,
            beside: late
                || faults.speed_lag != none.speed_lag
                || faults.flux_harmonics != none.flux_harmonics
                || faults.resistance_drift != none.resistance_drift,
            flux: faults.saturation != none.saturation,
            observer: faults.disturbance != none.disturbance,
        }
    }

    /// Those that either has.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            sensors: self.sensors || other.sensors,
            turns: self.turns || other.turns,
            delay: self.delay || other.delay,
            filter: self.filter || other.filter,
            voltages: self.voltages || other.voltages,
            loss: self.loss.or(other.loss),
            phase: self.phase || other.phase,
            beside: self.beside || other.beside,
            flux: self.flux || other.flux,
            observer: self.observer || other.observer,
        }
    }

    pub(crate) fn any(self) -> bool {
        self != Self::default()
    }
}

impl<V> Acting<V> {
    /// The numbers of all drives, `lanes` having been given how to find one; `period` is the usual length of a period, s.
    #[inline(always)]
    pub(crate) fn of(kinds: FaultKinds, period: f64, lanes: impl Fn(&dyn Fn(&Faults) -> f64) -> V) -> Self {
        Self {
            dead_time: SwitchedLoss::of(|number| lanes(&|f| number(&f.dead_time))),
            phase: [lanes(&|f| f.dead_time.phase.cos()), lanes(&|f| f.dead_time.phase.sin())],
            current_offset: [lanes(&|f| f.current_offset.current.alpha), lanes(&|f| f.current_offset.current.beta)],
            imbalance: [lanes(&|f| f.current_gains.imbalance.alpha), lanes(&|f| f.current_gains.imbalance.beta)],
            current_turn: [
                lanes(&|f| (f.angle_offset.angle - f.current_gains.turn).cos()),
                lanes(&|f| (f.angle_offset.angle - f.current_gains.turn).sin()),
            ],
            angle: [lanes(&|f| f.angle_offset.angle.cos()), lanes(&|f| f.angle_offset.angle.sin())],
            angle_delay: lanes(&|f| f.angle_delay.time),
            voltage_delay: lanes(&|f| f.angle_delay.time + f.voltage_lag.time),
            current_filter: [
                lanes(&|f| f.filter.weights(period)[0]),
                lanes(&|f| f.filter.weights(period)[1]),
                lanes(&|f| f.filter.weights(period)[2]),
                lanes(&|f| f.filter.weights(period)[3]),
            ],
            noise_before_filter: lanes(&|f| f.filter.noise_before),
            before_filter: lanes(&|f| 1.0 / (1.0 - f.filter.weights(period)[1])),
            voltage_advance: lanes(&|f| f.filter.advance(period) - f.voltage_lag.time / period),
            speed_lag: lanes(&|f| f.speed_lag.time),
            flux_harmonics: [
                lanes(&|f| f.flux_harmonics.d[0]),
                lanes(&|f| f.flux_harmonics.d[1]),
                lanes(&|f| f.flux_harmonics.q[0]),
                lanes(&|f| f.flux_harmonics.q[1]),
            ],
            resistance_change: lanes(&|f| f.resistance_drift.change),
            saturation: [lanes(&|f| f.saturation.d), lanes(&|f| f.saturation.q), lanes(&|f| f.saturation.cross)],
            observer_gain: [lanes(&|f| f.disturbance.gain.d), lanes(&|f| f.disturbance.gain.q)],
            kinds,
        }
    }
}

impl Acting<f64> {
    /// The faults of one drive.
    pub(crate) fn of_one(faults: &Faults, period: f64) -> Self {
        Self::of(FaultKinds::of(faults), period, |number| number(faults))
    }

    /// The current, A, that a perfect sensor would have logged for `logged`, measured with the rotor there, at the speed by
    /// which a late angle is too small.
    pub(crate) fn current(&self, logged: Dq, rotor: Turn, late_by: f64) -> Dq {
        let [d, q] = self.motor_current([logged.d, logged.q], rotor, late_by);
        Dq { d, q }
    }
}

impl<V: Number> Acting<V> {
    /// The current, A, in the frame of the magnet, where `logged` was measured with the rotor there, at the speed by which a late
    /// angle is too small: the faults of the sensors are undone, but for their filter.
    #[inline(always)]
    pub(crate) fn motor_current(&self, logged: [V; 2], rotor: Turn, late_by: f64) -> [V; 2] {
        if !self.kinds.sensors {
            return logged;
        }
        let balanced = balanced(self.imbalance, removed(self.current_offset, logged, rotor), rotor);
        let [cos, sin] = self.current_turn;
        self.undelayed(turned(balanced, cos, sin), self.angle_delay, late_by)
    }

    /// From a frame that is late by a delay, s, into the magnet's, which has turned further at this speed.
    #[inline(always)]
    fn undelayed(&self, vector: [V; 2], delay: V, omega_e: f64) -> [V; 2] {
        if !self.kinds.delay {
            return vector;
        }
        let [cos, sin] = angle_delay::turn(delay, omega_e);
        turned(vector, cos, sin)
    }

    /// What a filter makes of the motor's current at a period's end: given its output at the start, `y`, the currents at both, A, and by
    /// how much the current half-way is beside their mean, times four.
    #[inline(always)]
    pub(crate) fn filtered(&self, y: [V; 2], i: [[V; 2]; 2], bend: [V; 2], place: &Place) -> [V; 2] {
        if self.kinds.filter { filtered(self.current_filter, y, i, bend, place) } else { i[1] }
    }

    /// One where there is no filter of the currents, else zero.
    #[inline(always)]
    pub(crate) fn unfiltered_part(&self) -> V {
        let [kept, ..] = self.current_filter;
        let (zero, one) = (kept.constant(0.0), kept.constant(1.0));
        zero.if_less(kept, zero, one)
    }

    /// The voltage that the drive means to act on the motor over a period, V, in the frame of its magnet, where `logged` was logged, and
    /// `before` for the period before.
    #[inline(always)]
    pub(crate) fn commanded_voltage(&self, logged: [V; 2], before: [V; 2], place: &Place) -> [V; 2] {
        if !self.kinds.voltages {
            return logged;
        }
        let logged = speed_lag::advanced(self.speed_lag, unfiltered(self.voltage_advance, logged, before), place);
        let [cos, sin] = self.angle;
        self.undelayed(turned(logged, cos, sin), self.voltage_delay, place.late_by)
    }

    /// What the inverter loses of a commanded voltage, V, given the currents in the motor at the start of the period, and at its end if
    /// nothing were lost, A; all in the frame of its magnet.
    #[inline(always)]
    pub(crate) fn lost(&self, commanded: [V; 2], [start, end]: [[V; 2]; 2], winding: &Winding<V>, place: &Place) -> [V; 2] {
        let late_by = place.rotor_late_by;
        let u = self.in_rotors_frame(commanded, late_by);
        let (start, end) = (self.in_rotors_frame(start, late_by), self.in_rotors_frame(end, late_by));
        let phase = if self.kinds.phase { Some(self.phase) } else { None };
        let lost = self.dead_time.over(self.kinds.loss, u, [start, end], winding, phase, place);
        self.in_magnets_frame(lost, late_by)
    }

    /// A vector of the frame of an angle that is late by the speed times the delay, in the magnet's.
    #[inline(always)]
    fn in_magnets_frame(&self, vector: [V; 2], late_by: f64) -> [V; 2] {
        if !self.kinds.turns {
            return vector;
        }
        let [cos, sin] = self.angle;
        self.undelayed(turned(vector, cos, sin), self.angle_delay, late_by)
    }

    /// A vector of the magnet's frame, in that of an angle that is late.
    #[inline(always)]
    fn in_rotors_frame(&self, vector: [V; 2], late_by: f64) -> [V; 2] {
        if !self.kinds.turns {
            return vector;
        }
        let [cos, sin] = self.angle;
        self.undelayed(turned(vector, cos, -sin), self.angle_delay, -late_by)
    }

    /// The voltage `u`, V, less what a motor at current `i`, A, takes or induces beside its equation; `linear_flux` is `L i + psi_f`, Wb.
    #[inline(always)]
    pub(crate) fn beside(&self, u: [V; 2], i: [V; 2], linear_flux: [V; 2], place: &Place) -> [V; 2] {
        if !self.kinds.beside {
            return u;
        }
        let harmonics = flux_harmonics::induced(self.harmonics_of_rotor(place.rotor_late_by), place);
        let warmer = resistance_drift::taken(self.resistance_change, i, place);
        let lagging = speed_lag::induced(self.speed_lag, linear_flux, place);
        let late = angle_delay::induced(self.angle_delay, linear_flux, place);
        both!(axis => u[axis] - harmonics[axis] - warmer[axis] - lagging[axis] - late[axis])
    }

    /// The amplitudes of the flux harmonics, which turn with the magnet, against an angle that is late: the sixth is so by six times the
    /// angle.
    #[inline(always)]
    fn harmonics_of_rotor(&self, late_by: f64) -> [V; 4] {
        if !self.kinds.delay {
            return self.flux_harmonics;
        }
        let [d_cos, d_sin, q_cos, q_sin] = self.flux_harmonics;
        let [cos, sin] = angle_delay::turn(self.angle_delay.constant(6.0) * self.angle_delay, late_by);
        let ([d_cos, d_sin], [q_cos, q_sin]) = (turned([d_cos, d_sin], cos, sin), turned([q_cos, q_sin], cos, sin));
        [d_cos, d_sin, q_cos, q_sin]
    }

    /// Flux, Wb, beyond `L i + psi_f` at current `i`, A.
    #[inline(always)]
    pub(crate) fn extra_flux(&self, i: [V; 2]) -> [V; 2] {
        extra_flux(self.saturation, i)
    }

    /// The current in the motor, `i`, and what its filter makes of it, `y`, corrected for the error of `y` by the observer of a disturbed
    /// motor. A filter passes on a part of a change of the current within a period: the current is corrected by that much more. And it
    /// holds noise that came before it.
    #[inline(always)]
    pub(crate) fn corrected(&self, i: [V; 2], y: [V; 2], error: [V; 2]) -> [[V; 2]; 2] {
        if !self.kinds.observer && !self.kinds.filter {
            return [i, y];
        }
        let [of_motor, of_filter] = self.gains();
        [corrected(of_motor, i, error), corrected(of_filter, y, error)]
    }

    /// What that correction leaves of a difference between two simulations.
    #[inline(always)]
    pub(crate) fn remaining(&self, i: [V; 2], y: [V; 2]) -> [[V; 2]; 2] {
        if !self.kinds.observer && !self.kinds.filter {
            return [i, y];
        }
        let [of_motor, of_filter] = self.gains();
        [remaining(of_motor, i, y), remaining(of_filter, y, y)]
    }

    /// By which part of an error the motor's current is corrected, and by which the filter's.
    #[inline(always)]
    fn gains(&self) -> [[V; 2]; 2] {
        let [d, q] = self.observer_gain;
        let (more, noise) = (self.before_filter, self.noise_before_filter);
        let left = noise.constant(1.0) - noise;
        [[more * d, more * q], [left.mul_add(d, noise), left.mul_add(q, noise)]]
    }
}

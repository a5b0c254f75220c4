//! Field-oriented control: a current loop, a speed loop around it, and field weakening at the voltage limit.
//!
//! Current loop: a complex-vector PI controller with two degrees of freedom on the flux error. With `psi(i)` the flux linkage at a
//! current, saturation included, `alpha` the bandwidth in rad/s, and complex numbers for dq vectors
//!
//! ```text
//! v = w - alpha psi,     u = alpha (psi* - psi) + v,     dw/dt = (alpha + j omega_e)(u_limited - v)
//! ```
//!
//! `j omega_e` in the integrator decouples the axes. Integrating the limited voltage `u_limited` instead of `u` is the anti-windup.
//! Briz, Degner and Lorenz, "Analysis and design of current regulators using complex vectors", 2000, doi 10.1109/28.845057. The speed
//! loop is the same controller with real numbers, the inertia in place of the inductance, and the torque in place of the voltage.
//!
//! A command that is computed at a sample acts over the period after the next sample: its vector is rotated by `1.5 omega_e T_s`.

use crate::{
    direction::Direction,
    inverter::duties,
    scenario::{Axis, Control, Injection, Mechanics, Scenario, SimulatedMotor, Waveform},
    sensors::Sample,
};
use fluxfit::{
    frames::{Abc, AlphaBeta, Dq},
    motor::Motor,
};
use std::f64::consts::TAU;

/// Bandwidth of the field-weakening controller, rad/s: below that of any current loop, equal to that of the usual speed loop.
const WEAKENING_BANDWIDTH: f64 = TAU * 20.0;

/// Fraction of the voltage limit above which the field is weakened: the rest is reserved for the current loop.
const WEAKENING_THRESHOLD: f64 = 0.95;

/// Smallest torque per ampere with which i_q is computed, as a fraction of the magnet's alone.
const MIN_TORQUE_PER_AMPERE: f64 = 0.05;

/// A voltage command within the inverter's limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoltageCommand {
    /// The voltage, V, in the frame at the middle of the period in which it acts.
    pub u: Dq,
    /// The same in the stator frame, V.
    pub u_stator: AlphaBeta,
    /// Duty ratios of the legs.
    pub duties: [f64; 3],
}

/// References of the controller at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct References {
    /// i_d, A.
    pub id: f64,
    /// i_q, A; used on a dynamometer.
    pub iq: f64,
    /// Speed, mechanical rad/s; used with a free rotor.
    pub speed: f64,
}

/// The controller with its state.
#[derive(Debug, Clone)]
pub struct Controller<'a> {
    settings: Control,
    /// The controller's model of the motor: the true one.
    model: &'a SimulatedMotor,
    /// The same without saturation.
    unsaturated: Motor,
    pole_pairs: f64,
    inertia: Option<f64>,
    injection: Option<&'a Injection>,
    sample_period: f64,
    /// `e^(-alpha T_s)` of the current loop.
    decay: f64,
    /// Integrator state `w` of the current loop, V.
    integral: Dq,
    /// Integrator state of the speed loop, N m.
    speed_integral: f64,
    /// Field-weakening current, added to the reference of i_d, A; at most zero.
    weakening_current: f64,
}

impl<'a> Controller<'a> {
    /// A controller with zero state.
    pub fn new(scenario: &'a Scenario) -> Self {
        Self {
            settings: scenario.control,
            model: &scenario.motor,
            unsaturated: scenario.motor.unsaturated(),
            pole_pairs: f64::from(scenario.motor.pole_pairs),
            inertia: match scenario.mechanics {
                Mechanics::Free { inertia, .. } => Some(inertia),
                Mechanics::Dyno => None,
            },
            injection: scenario.schedule.injection.as_ref(),
            sample_period: scenario.inverter.sample_period(),
            decay: (-TAU * scenario.control.current_bandwidth * scenario.inverter.sample_period()).exp(),
            integral: Dq::default(),
            speed_integral: 0.0,
            weakening_current: 0.0,
        }
    }

    /// The command computed from a sample at time `t`, s.
    pub fn command(&mut self, measured: &Sample, references: &References, t: f64) -> VoltageCommand {
        let i = measured.direction.to_rotor(measured.i);
        let reference = self.current_reference(measured, references, i);
        let alpha = TAU * self.settings.current_bandwidth;
        let (psi, reference_psi) = (self.current_flux(i), self.current_flux(reference));
        let v = Dq { d: self.integral.d - alpha * psi.d, q: self.integral.q - alpha * psi.q };
        let test = self.injection.map_or(Dq::default(), |injection| injection.at(t));
        let unlimited = Dq { d: alpha * (reference_psi.d - psi.d) + v.d + test.d, q: alpha * (reference_psi.q - psi.q) + v.q + test.q };
        let limit = measured.u_dc / 3.0_f64.sqrt();
        // Not `hypot`: its care for numbers beyond 1e154 takes a library call in every sample.
        let magnitude = (unlimited.d * unlimited.d + unlimited.q * unlimited.q).sqrt();
        let scale = (limit / magnitude).min(1.0);
        let u = Dq { d: scale * unlimited.d, q: scale * unlimited.q };
        self.weaken_field(magnitude, limit, measured.omega_e);
        let half_turn = Direction::of(0.5 * self.sample_period * measured.omega_e);
        let turn = half_turn.turned(half_turn);
        self.integrate(Dq { d: u.d - test.d - v.d, q: u.q - test.q - v.q }, turn);

        // To the middle of the period in which the command acts.
        let u_stator = measured.direction.turned(turn).turned(half_turn).to_stator(u);
        let duties = duties(u_stator, measured.u_dc);
        let [a, b, c] = duties.map(|duty| duty * measured.u_dc);
        VoltageCommand { u, u_stator: Abc { a, b, c }.to_alpha_beta(), duties }
    }

    /// Flux linkage at a current less that of the magnet, Wb, from the controller's model.
    fn current_flux(&self, i: Dq) -> Dq {
        // Noise may move a measured current beyond the edge of the map.
        let psi = self.model.flux(self.model.within_map(i)).map_or(Dq::default(), |flux| flux.psi);
        Dq { d: psi.d - self.unsaturated.psi_f, q: psi.q }
    }

    /// `w ← w + (1 - e^(-(alpha + j omega_e) T_s)) (u - v)`: the exact integral over a period, stable at any speed. `turn` is that of
    /// the rotor in the period.
    fn integrate(&mut self, difference: Dq, turn: Direction) {
        let (decay, Direction { cos, sin }) = (self.decay, turn);
        self.integral.d += (1.0 - decay * cos) * difference.d - decay * sin * difference.q;
        self.integral.q += (1.0 - decay * cos) * difference.q + decay * sin * difference.d;
    }

    /// References of the currents within the current limit, where `i_d` has priority. With field weakening, i_q also stays within the
    /// voltage limit; `i` is the present current.
    fn current_reference(&mut self, measured: &Sample, references: &References, i: Dq) -> Dq {
        let most = self.settings.max_current;
        let d = (references.id + self.weakening_current).clamp(-most, most);
        let mut most_q = (most * most - d * d).sqrt();
        if self.settings.field_weakening && measured.omega_e != 0.0 {
            let psi = WEAKENING_THRESHOLD * measured.u_dc / 3.0_f64.sqrt() / measured.omega_e.abs();
            let psi_d = self.unsaturated.psi_f + self.unsaturated.ld * i.d;
            most_q = most_q.min((psi * psi - psi_d * psi_d).max(0.0).sqrt() / self.unsaturated.lq);
        }
        let q = match self.inertia {
            None => references.iq,
            Some(inertia) => {
                let per_ampere = 1.5 * self.pole_pairs * self.unsaturated.psi_f;
                let per_ampere = (per_ampere + 1.5 * self.pole_pairs * (self.unsaturated.ld - self.unsaturated.lq) * d)
                    .max(MIN_TORQUE_PER_AMPERE * per_ampere);
                self.torque_reference(measured.omega_e / self.pole_pairs, references.speed, inertia, per_ampere * most_q) / per_ampere
            }
        };
        Dq { d, q: if q.is_finite() { q.clamp(-most_q, most_q) } else { 0.0 } }
    }

    /// The speed loop: the torque reference, N m, limited to `most`.
    fn torque_reference(&mut self, speed: f64, reference: f64, inertia: f64, most: f64) -> f64 {
        let alpha = TAU * self.settings.speed_bandwidth;
        let v = self.speed_integral - alpha * inertia * speed;
        let torque = (alpha * inertia * (reference - speed) + v).clamp(-most, most);
        self.speed_integral += self.sample_period * alpha * (torque - v);
        torque
    }

    /// Field weakening: lowers `i_d` while the unlimited voltage command exceeds the threshold, and raises it again below.
    fn weaken_field(&mut self, unlimited: f64, limit: f64, omega_e: f64) {
        if !self.settings.field_weakening {
            return;
        }
        // Change of voltage per ampere of i_d, bounded below: at low speed the voltage limit is not reached.
        let slope = self.unsaturated.ld * omega_e.abs().max(WEAKENING_BANDWIDTH);
        let change = self.sample_period * WEAKENING_BANDWIDTH * (WEAKENING_THRESHOLD * limit - unlimited) / slope;
        // Beyond the current that cancels the magnet's flux, the voltage rises again.
        let most = self.settings.max_current.min(self.unsaturated.psi_f / self.unsaturated.ld);
        self.weakening_current = (self.weakening_current + change).clamp(-most, 0.0);
    }
}

impl Injection {
    /// The test voltage at time `t`, s.
    fn at(&self, t: f64) -> Dq {
        // A sample at an edge of the square wave belongs to the half period that begins there.
        const ROUNDING: f64 = 1e-9;
        let cycle = (self.frequency * t + ROUNDING).rem_euclid(1.0);
        let shape = match self.waveform {
            Waveform::Sine => (TAU * cycle).sin(),
            Waveform::Square if cycle < 0.5 => 1.0,
            Waveform::Square => -1.0,
        };
        let u = shape * self.voltage.at(t);
        match self.axis {
            Axis::D => Dq { d: u, q: 0.0 },
            Axis::Q => Dq { d: 0.0, q: u },
        }
    }
}

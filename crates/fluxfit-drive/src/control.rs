//! Field-oriented control: a current loop, a speed loop around it, and where the voltage runs out, a weaker field.
//!
//! Current loop: a complex-vector PI controller with two degrees of freedom on the flux error. With `psi(i)` the flux that current
//! makes, saturation included, `alpha` its bandwidth in rad/s, and complex numbers for dq vectors
//!
//! ```text
//! v = w - alpha psi,     u = alpha (psi* - psi) + v,     dw/dt = (alpha + j omega_e)(u_limited - v)
//! ```
//!
//! `j omega_e` in the integrator cancels the rotation's coupling of the axes: the decoupling. Integrating what was possible
//! (`u_limited`) and not what was wanted is the anti-windup. Briz, Degner and Lorenz, "Analysis and design of current regulators
//! using complex vectors", 2000, doi 10.1109/28.845057. The speed loop is the same controller with real numbers, the inertia in
//! place of the inductance and the torque in place of the voltage.
//!
//! A command that is computed at a sample acts over the period after the next sample: its vector is turned by `1.5 omega_e T_s`.

use crate::{
    inverter::duties,
    scenario::{Axis, Control, Injection, Mechanics, Scenario, SimulatedMotor, Waveform},
    sensors::Measured,
};
use fluxfit::{
    frames::{Abc, AlphaBeta, Dq},
    motor::Motor,
};
use std::f64::consts::TAU;

/// Periods from the sample to the middle of the period in which its command acts.
const DELAY: f64 = 1.5;

/// Bandwidth of field weakening, rad/s: slower than any current loop, as fast as the usual speed loop.
const WEAKENING: f64 = TAU * 20.0;

/// Fraction of the voltage limit from which the field is weakened: the rest is left to the current loop.
const WEAKENING_FROM: f64 = 0.95;

/// Least torque per ampere for which i_q is computed, as a fraction of what the magnet alone makes.
const LEAST_TORQUE: f64 = 0.05;

/// What the controller asks for, and what it will get.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// The voltage that will act, V, in the frame at the middle of its period.
    pub u: Dq,
    /// The same in the stator.
    pub u_stator: AlphaBeta,
    /// Duties of the legs.
    pub duties: [f64; 3],
}

/// What is asked of the controller at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// A.
    pub id: f64,
    /// A; used on a dynamometer.
    pub iq: f64,
    /// Mechanical rad/s.
    pub speed: f64,
}

/// The controller at work.
#[derive(Debug, Clone)]
pub struct Controller<'a> {
    settings: Control,
    /// The motor it believes in: the true one.
    believed: &'a SimulatedMotor,
    /// The same without saturation.
    motor: Motor,
    pole_pairs: f64,
    inertia: Option<f64>,
    injection: Option<&'a Injection>,
    sample_period: f64,
    /// `w` of the current loop, V.
    integral: Dq,
    /// The same of the speed loop, N m.
    speed_integral: f64,
    /// Current by which the field is weakened, A, at most zero.
    weakening: f64,
}

impl<'a> Controller<'a> {
    /// A controller at rest.
    pub fn new(scenario: &'a Scenario) -> Self {
        Self {
            settings: scenario.control,
            believed: &scenario.motor,
            motor: scenario.motor.unsaturated(),
            pole_pairs: f64::from(scenario.motor.pole_pairs),
            inertia: match scenario.mechanics {
                Mechanics::Free { inertia, .. } => Some(inertia),
                Mechanics::Dyno => None,
            },
            injection: scenario.schedule.injection.as_ref(),
            sample_period: scenario.inverter.sample_period(),
            integral: Dq::default(),
            speed_integral: 0.0,
            weakening: 0.0,
        }
    }

    /// The command that follows from a sample at time `t`, s.
    pub fn command(&mut self, measured: &Measured, asked: &Asked, t: f64) -> Command {
        let i = measured.i.to_dq(measured.theta_e);
        let reference = self.current_reference(measured, asked, i);
        let alpha = TAU * self.settings.current_bandwidth;
        let (psi, wanted_psi) = (self.flux(i), self.flux(reference));
        let v = Dq { d: self.integral.d - alpha * psi.d, q: self.integral.q - alpha * psi.q };
        let test = self.injection.map_or(Dq::default(), |injection| injection.at(t));
        let wanted = Dq { d: alpha * (wanted_psi.d - psi.d) + v.d + test.d, q: alpha * (wanted_psi.q - psi.q) + v.q + test.q };
        let limit = measured.u_dc / 3.0_f64.sqrt();
        let shortened = (limit / wanted.magnitude()).min(1.0);
        let u = Dq { d: shortened * wanted.d, q: shortened * wanted.q };
        self.weaken(wanted.magnitude(), limit, measured.omega_e);
        self.integrate(Dq { d: u.d - test.d - v.d, q: u.q - test.q - v.q }, alpha, measured.omega_e);

        let u_stator = u.to_alpha_beta(measured.theta_e + DELAY * self.sample_period * measured.omega_e);
        let duties = duties(u_stator, measured.u_dc);
        let [a, b, c] = duties.map(|duty| duty * measured.u_dc);
        Command { u, u_stator: Abc { a, b, c }.to_alpha_beta(), duties }
    }

    /// What current makes of flux, as the controller believes, beyond the magnet's.
    fn flux(&self, i: Dq) -> Dq {
        // A measured current may lie beyond the map's edge by its noise.
        let psi = self.believed.flux(self.believed.within_map(i)).map_or(Dq::default(), |flux| flux.psi);
        Dq { d: psi.d - self.motor.psi_f, q: psi.q }
    }

    /// `w ← w + (1 - e^(-(alpha + j omega_e) T_s)) (u - v)`: the integral over a period, exact, so that it settles however fast the
    /// rotor turns.
    fn integrate(&mut self, missed: Dq, alpha: f64, omega_e: f64) {
        let decay = (-alpha * self.sample_period).exp();
        let (sin, cos) = (omega_e * self.sample_period).sin_cos();
        self.integral.d += (1.0 - decay * cos) * missed.d - decay * sin * missed.q;
        self.integral.q += (1.0 - decay * cos) * missed.q + decay * sin * missed.d;
    }

    /// Currents within the limit; `i_d` first. Where the field is weakened, i_q within what the voltage leaves, `i` being the current now.
    fn current_reference(&mut self, measured: &Measured, asked: &Asked, i: Dq) -> Dq {
        let most = self.settings.max_current;
        let d = (asked.id + self.weakening).clamp(-most, most);
        let mut most_q = (most * most - d * d).sqrt();
        if self.settings.field_weakening && measured.omega_e != 0.0 {
            let psi = WEAKENING_FROM * measured.u_dc / 3.0_f64.sqrt() / measured.omega_e.abs();
            let along = self.motor.psi_f + self.motor.ld * i.d;
            most_q = most_q.min((psi * psi - along * along).max(0.0).sqrt() / self.motor.lq);
        }
        let q = match self.inertia {
            None => asked.iq,
            Some(inertia) => {
                let per_ampere = 1.5 * self.pole_pairs * self.motor.psi_f;
                let per_ampere = (per_ampere + 1.5 * self.pole_pairs * (self.motor.ld - self.motor.lq) * d).max(LEAST_TORQUE * per_ampere);
                self.torque(measured.omega_e / self.pole_pairs, asked.speed, inertia, per_ampere * most_q) / per_ampere
            }
        };
        Dq { d, q: if q.is_finite() { q.clamp(-most_q, most_q) } else { 0.0 } }
    }

    /// The speed loop: a torque, N m, of at most `most`.
    fn torque(&mut self, speed: f64, asked: f64, inertia: f64, most: f64) -> f64 {
        let alpha = TAU * self.settings.speed_bandwidth;
        let v = self.speed_integral - alpha * inertia * speed;
        let torque = (alpha * inertia * (asked - speed) + v).clamp(-most, most);
        self.speed_integral += self.sample_period * alpha * (torque - v);
        torque
    }

    /// Lowers `i_d` while more voltage is wanted than there is, and lets it return.
    fn weaken(&mut self, wanted: f64, limit: f64, omega_e: f64) {
        if !self.settings.field_weakening {
            return;
        }
        // Volts per ampere of i_d. At low speed no voltage runs out.
        let slope = self.motor.ld * omega_e.abs().max(WEAKENING);
        let change = self.sample_period * WEAKENING * (WEAKENING_FROM * limit - wanted) / slope;
        // Beyond the current that cancels the magnet, more of it costs voltage.
        let most = self.settings.max_current.min(self.motor.psi_f / self.motor.ld);
        self.weakening = (self.weakening + change).clamp(-most, 0.0);
    }
}

impl Injection {
    /// The test voltage at time `t`, s.
    fn at(&self, t: f64) -> Dq {
        // A sample at a wave's edge belongs to the half that begins there.
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

//! The plant: motor and mechanics in continuous time, integrated between switching instants.
//!
//! State: currents in the rotor frame, mechanical speed, electrical angle; and the energies, for an energy balance.
//!
//! ```text
//! d psi_d/dt = u_d - R_s i_d + omega_e psi_q,    d psi_q/dt = u_q - R_s i_q - omega_e psi_d        (1)
//! di/dt = (incremental inductances)⁻¹ d psi/dt
//! J d omega_m/dt = T - T_load - B omega_m,       d theta_e/dt = p omega_m
//! ```
//!
//! The integrator is the classical fourth-order Runge-Kutta method. Its step is at most [`MAX_STEP`] divided by the fastest rate of the
//! state: the decay of the winding, the rotation and the oscillation of the rotor.

use crate::machine::{Mechanics, SimulatedMotor};
use fluxfit::frames::{AlphaBeta, Dq};

/// Longest step, in radians or time constants of the fastest rate. The fourth-order error of the energies is then about
/// 0.017⁴ / 120 = 7e-10 of the energy exchanged in a step.
pub const MAX_STEP: f64 = 0.017;

/// Number of states.
const STATES: usize = 7;

/// Motor and mechanics.
#[derive(Debug, Clone)]
pub struct Plant<'a> {
    motor: &'a SimulatedMotor,
    mechanics: Mechanics,
    /// Number of pole pairs.
    pole_pairs: f64,
    state: [f64; STATES],
    /// Cosine and sine of the electrical angle, updated by rotation: computing them anew in each step would take a sixth of the time.
    direction: (f64, f64),
    /// The fastest rate of the state at the start of the period, 1/s.
    rate: f64,
    /// Load torque, N m.
    pub load: f64,
    /// Slope of a dynamometer's speed, rad/s².
    pub acceleration: f64,
}

/// Energies since the start, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// Electrical energy at the terminals.
    pub electrical: f64,
    /// Copper loss.
    pub copper: f64,
    /// Mechanical energy: integral of torque times speed.
    pub mechanical: f64,
}

impl<'a> Plant<'a> {
    /// A motor without current at the angle zero, at a mechanical speed, rad/s.
    pub fn new(motor: &'a SimulatedMotor, mechanics: Mechanics, speed: f64) -> Self {
        let pole_pairs = f64::from(motor.pole_pairs);
        let state = [0.0, 0.0, speed, 0.0, 0.0, 0.0, 0.0];
        Self { motor, mechanics, pole_pairs, state, direction: (1.0, 0.0), rate: 0.0, load: 0.0, acceleration: 0.0 }
    }

    /// Current, A.
    pub fn current(&self) -> Dq {
        Dq { d: self.state[0], q: self.state[1] }
    }

    /// Electrical angle, rad, not wrapped.
    pub fn theta_e(&self) -> f64 {
        self.state[3]
    }

    /// Speed, electrical rad/s.
    pub fn omega_e(&self) -> f64 {
        self.pole_pairs * self.state[2]
    }

    /// Speed, mechanical rad/s.
    pub fn omega_m(&self) -> f64 {
        self.state[2]
    }

    /// Sets the speed, mechanical rad/s: that of a dynamometer, so that rounding errors do not accumulate.
    pub fn set_omega_m(&mut self, speed: f64) {
        self.state[2] = speed;
    }

    /// Energies since the start.
    pub fn energies(&self) -> Energies {
        let [.., electrical, copper, mechanical] = self.state;
        Energies { electrical, copper, mechanical }
    }

    /// Must be called at the start of a sample period: determines the step length, and removes the accumulated rounding error of the
    /// rotor's direction.
    pub fn begin_period(&mut self) {
        let (sin, cos) = self.theta_e().sin_cos();
        (self.direction, self.rate) = ((cos, sin), self.fastest_rate());
    }

    /// Number of integration steps for an interval of the period, s.
    pub fn steps(&self, interval: f64) -> usize {
        // Bounds the time for an unstable plant, which the overcurrent protection stops at the next sample.
        const MOST: f64 = 1e4;
        (interval * self.rate / MAX_STEP).ceil().clamp(1.0, MOST) as usize
    }

    /// The fastest rate of the state, 1/s: decay of winding and friction, rotation, and the oscillation of a light rotor,
    /// `p psi sqrt(3/2 / (J L))`.
    fn fastest_rate(&self) -> f64 {
        let Some(flux) = self.motor.flux(self.current()) else { return f64::INFINITY };
        let inductance = flux.inductance[0][0].min(flux.inductance[1][1]);
        let (oscillation, friction) = match self.mechanics {
            Mechanics::Free { inertia, friction } => {
                (self.pole_pairs * flux.psi.magnitude() * (1.5 / (inertia * inductance)).sqrt(), friction / inertia)
            }
            Mechanics::Dyno => (0.0, 0.0),
        };
        self.motor.rs / inductance + friction + self.omega_e().hypot(oscillation)
    }

    /// One integration step of `h` seconds with a voltage, V, that is constant in the stator frame. False, without a step, if the current
    /// leaves the flux map.
    #[must_use]
    pub fn step(&mut self, u: AlphaBeta, h: f64) -> bool {
        let Some(next) = self.runge_kutta(u, h) else { return false };
        let ((cos, sin), (turn_cos, turn_sin)) = (self.direction, cos_sin_of_small(next[3] - self.state[3]));
        self.direction = (cos * turn_cos - sin * turn_sin, sin * turn_cos + cos * turn_sin);
        self.state = next;
        true
    }

    fn runge_kutta(&self, u: AlphaBeta, h: f64) -> Option<[f64; STATES]> {
        let (cos, sin) = self.direction;
        let u = Dq { d: cos * u.alpha + sin * u.beta, q: cos * u.beta - sin * u.alpha };
        let moved = |slope: &[f64; STATES], by: f64| std::array::from_fn(|s| self.state[s] + by * slope[s]);
        let k1 = self.slope(&self.state, u)?;
        let k2 = self.slope(&moved(&k1, 0.5 * h), u)?;
        let k3 = self.slope(&moved(&k2, 0.5 * h), u)?;
        let k4 = self.slope(&moved(&k3, h), u)?;
        Some(std::array::from_fn(|s| self.state[s] + h / 6.0 * (k1[s] + 2.0 * (k2[s] + k3[s]) + k4[s])))
    }

    #[inline(always)]
    fn slope(&self, state: &[f64; STATES], u_at_start: Dq) -> Option<[f64; STATES]> {
        let [d, q, omega_m, theta_e, ..] = *state;
        let i = Dq { d, q };
        let omega_e = self.pole_pairs * omega_m;
        let u = rotated_back(u_at_start, theta_e - self.theta_e());
        let flux = self.motor.flux(i)?;
        let rs = self.motor.rs;
        let (rise_d, rise_q) = (u.d - rs * d + omega_e * flux.psi.q, u.q - rs * q - omega_e * flux.psi.d);
        let [[dd, dq], [qd, qq]] = flux.inductance;
        let inverse = 1.0 / (dd * qq - dq * qd);
        let torque = self.motor.torque(flux.psi, i);
        let acceleration = match self.mechanics {
            Mechanics::Free { inertia, friction } => (torque - self.load - friction * omega_m) / inertia,
            Mechanics::Dyno => self.acceleration,
        };
        Some([
            (qq * rise_d - dq * rise_q) * inverse,
            (dd * rise_q - qd * rise_d) * inverse,
            acceleration,
            omega_e,
            1.5 * (u.d * d + u.q * q),
            1.5 * rs * (d * d + q * q),
            torque * omega_m,
        ])
    }
}

/// Below this angle, rad, the truncated series of [`cos_sin_of_small`] is exact to rounding: 0.05⁸/8! is 1e-15, [`MAX_STEP`]⁸/8! is
/// below 1e-18.
const SMALL_ANGLE: f64 = 0.05;

/// Cosine and sine of a small angle, rad.
#[inline]
fn cos_sin_of_small(angle: f64) -> (f64, f64) {
    let a2 = angle * angle;
    if angle.abs() < SMALL_ANGLE {
        let cos = 1.0 - a2 * 0.5 * (1.0 - a2 * (1.0 / 12.0) * (1.0 - a2 * (1.0 / 30.0)));
        (cos, angle * (1.0 - a2 * (1.0 / 6.0) * (1.0 - a2 * (1.0 / 20.0) * (1.0 - a2 * (1.0 / 42.0)))))
    } else {
        let (sin, cos) = angle.sin_cos();
        (cos, sin)
    }
}

/// A vector in a frame that is rotated by a small angle, rad.
#[inline]
fn rotated_back(u: Dq, angle: f64) -> Dq {
    let (cos, sin) = cos_sin_of_small(angle);
    Dq { d: cos * u.d + sin * u.q, q: cos * u.q - sin * u.d }
}

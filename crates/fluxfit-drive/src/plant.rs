//! The plant: motor and mechanics in continuous time, integrated between switching instants.
//!
//! State: currents in the rotor's frame, mechanical speed, electrical angle; and a ledger of energies, integrated along with them.
//!
//! ```text
//! d psi_d/dt = u_d - R_s i_d + omega_e psi_q,    d psi_q/dt = u_q - R_s i_q - omega_e psi_d        (1)
//! di/dt = (incremental inductances)⁻¹ d psi/dt
//! J d omega_m/dt = T - T_load - B omega_m,       d theta_e/dt = p omega_m
//! ```
//!
//! The method is the classical one of Runge and Kutta, of fourth order, in steps within which nothing moves by more than
//! [`MAX_STEP`] of itself: not the winding's decay, the rotor's turn, nor its swing.

use crate::scenario::{Mechanics, SimulatedMotor};
use fluxfit::frames::{AlphaBeta, Dq};

/// Longest step, in radians and time constants of the fastest movement. The fourth-order error of energies is then about
/// 0.017⁴ / 120 = 7e-10 of what flows in a step.
pub const MAX_STEP: f64 = 0.017;

/// Number of states.
const STATES: usize = 7;

/// Motor and mechanics.
#[derive(Debug, Clone)]
pub struct Plant<'a> {
    motor: &'a SimulatedMotor,
    mechanics: Mechanics,
    /// Pole pairs, as a factor.
    pole_pairs: f64,
    state: [f64; STATES],
    /// Cosine and sine of the electrical angle, turned along with it: a sine a step would take a sixth of the time.
    direction: (f64, f64),
    /// The fastest rate at which the state moved when the period began, 1/s.
    rate: f64,
    /// Load torque, N m.
    pub load: f64,
    /// Slope of a dynamometer's speed, rad/s².
    pub acceleration: f64,
}

/// Energies since the start, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// Into the terminals.
    pub electrical: f64,
    /// Lost in the winding.
    pub copper: f64,
    /// Torque times speed.
    pub mechanical: f64,
}

impl<'a> Plant<'a> {
    /// A motor without current, at the angle zero.
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

    /// Puts the rotor to a speed, mechanical rad/s: a dynamometer's rounding must not add up.
    pub fn set_omega_m(&mut self, speed: f64) {
        self.state[2] = speed;
    }

    /// Energies since the start.
    pub fn energies(&self) -> Energies {
        let [.., electrical, copper, mechanical] = self.state;
        Energies { electrical, copper, mechanical }
    }

    /// To be called where a sample period begins: how finely to step, and where the rotor points, without what rounding gathered.
    pub fn begin_period(&mut self) {
        let (sin, cos) = self.theta_e().sin_cos();
        (self.direction, self.rate) = ((cos, sin), self.fastest_rate());
    }

    /// Number of steps in which an interval, s, of the period is integrated.
    pub fn steps(&self, interval: f64) -> usize {
        // A plant that has gone wild is stopped by the drive's trip, not by endless steps.
        const MOST: f64 = 1e4;
        (interval * self.rate / MAX_STEP).ceil().clamp(1.0, MOST) as usize
    }

    /// The fastest rate at which the state moves, 1/s: the winding's decay and the friction's, the rotor's turn, and the swing of a
    /// light rotor in its field, `p psi sqrt(3/2 / (J L))`.
    fn fastest_rate(&self) -> f64 {
        let Some(flux) = self.motor.flux(self.current()) else { return f64::INFINITY };
        let inductance = flux.inductance[0][0].min(flux.inductance[1][1]);
        let (swing, friction) = match self.mechanics {
            Mechanics::Free { inertia, friction } => {
                (self.pole_pairs * flux.psi.magnitude() * (1.5 / (inertia * inductance)).sqrt(), friction / inertia)
            }
            Mechanics::Dyno => (0.0, 0.0),
        };
        self.motor.rs / inductance + friction + self.omega_e().hypot(swing)
    }

    /// One step of `h` seconds under a voltage, V, that stands still in the stator. False, and nothing done, where the current
    /// leaves the flux map.
    #[must_use]
    pub fn step(&mut self, u: AlphaBeta, h: f64) -> bool {
        let Some(next) = self.runge_kutta(u, h) else { return false };
        let ((cos, sin), (turn_cos, turn_sin)) = (self.direction, small_turn(next[3] - self.state[3]));
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
        let u = turned_back(u_at_start, theta_e - self.theta_e());
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

/// Below this angle, rad, a turn's series ends in rounding: 0.05⁸/8! is 1e-15 of a vector, [`MAX_STEP`]⁸/8! below 1e-18.
const SMALL_TURN: f64 = 0.05;

/// Cosine and sine of a small angle, rad.
#[inline]
fn small_turn(angle: f64) -> (f64, f64) {
    let a2 = angle * angle;
    if angle.abs() < SMALL_TURN {
        let cos = 1.0 - a2 * 0.5 * (1.0 - a2 * (1.0 / 12.0) * (1.0 - a2 * (1.0 / 30.0)));
        (cos, angle * (1.0 - a2 * (1.0 / 6.0) * (1.0 - a2 * (1.0 / 20.0) * (1.0 - a2 * (1.0 / 42.0)))))
    } else {
        let (sin, cos) = angle.sin_cos();
        (cos, sin)
    }
}

/// A vector as a rotor sees it that has turned by a small angle, rad.
#[inline]
fn turned_back(u: Dq, angle: f64) -> Dq {
    let (cos, sin) = small_turn(angle);
    Dq { d: cos * u.d + sin * u.q, q: cos * u.q - sin * u.d }
}

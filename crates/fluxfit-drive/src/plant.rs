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
//! Harmonics of the magnets' flux add to the flux linkages in (1) and in the torque what [`harmonics`](crate::harmonics) says.
//!
//! The integrator is the classical fourth-order Runge-Kutta method. Its step is at most [`MAX_STEP`] divided by the fastest rate of the
//! state: the decay of the winding, the rotation and the oscillation of the rotor.

use crate::{
    direction::Direction,
    flux_map::FluxMap,
    harmonics::{Harmonics, PERIODS},
    machine::{Magnetics, Mechanics, SimulatedMotor},
};
use fluxfit::frames::{AlphaBeta, Dq};

/// Longest step, in radians or time constants of the fastest rate. The fourth-order error of the energies is then about
/// 0.017⁴ / 120 = 7e-10 of the energy exchanged in a step.
pub const MAX_STEP: f64 = 0.017;

/// Motor and mechanics.
#[derive(Debug, Clone)]
pub struct Plant<'a> {
    motor: &'a SimulatedMotor,
    field: Field<'a>,
    /// Harmonics of the magnets' flux and the flux linkage of their fundamental, Wb, if there are any.
    harmonics: Option<(Harmonics, f64)>,
    /// Stator resistance, ohm.
    rs: f64,
    /// The inverse of the inertia, and friction over inertia; zero for a dynamometer, whose speed no torque changes.
    per_inertia: f64,
    friction_rate: f64,
    /// Number of pole pairs.
    pole_pairs: f64,
    i: Dq,
    omega_m: f64,
    theta_e: f64,
    energies: Energies,
    /// Of the electrical angle, updated by rotation: computing it anew in each step would take a sixth of the time.
    direction: Direction,
    /// The fastest rate of the state at the start of the period, divided by [`MAX_STEP`], 1/s.
    steps_per_second: f64,
    /// Load torque, N m.
    pub load: f64,
    /// Slope of a dynamometer's speed, rad/s²; zero with a free rotor.
    pub acceleration: f64,
}

/// The magnetics, as the equations need them.
#[derive(Debug, Clone, Copy)]
enum Field<'a> {
    /// Constant inductances, H, their inverses, and the flux linkage of the magnet, Wb.
    Constant {
        inductance: Dq,
        inverse: Dq,
        psi_f: f64,
    },
    Map(&'a FluxMap),
}

impl Field<'_> {
    fn constant(ld: f64, lq: f64, psi_f: f64) -> Self {
        Self::Constant { inductance: Dq { d: ld, q: lq }, inverse: Dq { d: 1.0 / ld, q: 1.0 / lq }, psi_f }
    }
}

/// Slopes of currents, speed and mechanical angle; powers.
#[derive(Debug, Clone, Copy)]
struct Slope {
    i: Dq,
    omega_m: f64,
    theta_m: f64,
    /// Electrical power over 3/2; copper loss over `3/2 R_s`; mechanical power over `3/2 p`.
    electrical: f64,
    copper: f64,
    mechanical: f64,
}

/// Energies since the start, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
        let (per_inertia, friction_rate) = match mechanics {
            Mechanics::Free { inertia, friction } => (1.0 / inertia, friction / inertia),
            Mechanics::Dyno => (0.0, 0.0),
        };
        let field = match &motor.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => Field::constant(*ld, *lq, *psi_f),
            Magnetics::Map(map) => Field::Map(map),
        };
        Self {
            motor,
            field,
            harmonics: (motor.harmonics != Harmonics::default()).then(|| (motor.harmonics, motor.unsaturated().psi_f)),
            rs: motor.rs,
            per_inertia,
            friction_rate,
            pole_pairs: f64::from(motor.pole_pairs),
            i: Dq::default(),
            omega_m: speed,
            theta_e: 0.0,
            energies: Energies::default(),
            direction: Direction::ZERO,
            steps_per_second: 0.0,
            load: 0.0,
            acceleration: 0.0,
        }
    }

    /// Sets the parameters to those of a time, s, which is a part, 0 to 1, of the simulated one.
    pub(crate) fn change(&mut self, t: f64, part: f64) {
        self.rs = self.motor.rs_at(t, part);
        if let Some([ld, lq, psi_f]) = self.motor.constants_at(t) {
            self.field = Field::constant(ld, lq, psi_f);
            if let Some((_, of_harmonics)) = &mut self.harmonics {
                *of_harmonics = psi_f;
            }
        }
    }

    /// Current, A.
    pub fn current(&self) -> Dq {
        self.i
    }

    /// The same in the stator frame, A.
    pub(crate) fn stator_current(&self) -> AlphaBeta {
        self.direction.to_stator(self.i)
    }

    /// Electrical angle, rad, not wrapped.
    pub fn theta_e(&self) -> f64 {
        self.theta_e
    }

    /// Speed, electrical rad/s.
    pub fn omega_e(&self) -> f64 {
        self.pole_pairs * self.omega_m
    }

    /// Speed, mechanical rad/s.
    pub fn omega_m(&self) -> f64 {
        self.omega_m
    }

    /// Sets the speed, mechanical rad/s: that of a dynamometer, so that rounding errors do not accumulate.
    pub fn set_omega_m(&mut self, speed: f64) {
        self.omega_m = speed;
    }

    /// Energies since the start.
    pub fn energies(&self) -> Energies {
        self.energies
    }

    /// Must be called at the start of a sample period: determines the step length, and removes the accumulated rounding error of the
    /// rotor's direction.
    pub fn begin_period(&mut self) {
        (self.direction, self.steps_per_second) = (Direction::of(self.theta_e), self.fastest_rate() / MAX_STEP);
    }

    /// Number of integration steps for an interval of the period, s.
    pub fn steps(&self, interval: f64) -> usize {
        // Bounds the time for an unstable plant, which the overcurrent protection stops at the next sample.
        const MOST: f64 = 1e4;
        let exact = (interval * self.steps_per_second).clamp(1.0, MOST);
        // Rounded up without a call of the mathematical library.
        let whole = exact as u32;
        whole as usize + usize::from(f64::from(whole) < exact)
    }

    /// The fastest rate of the state, 1/s: decay of winding and friction, rotation, and the oscillation of a light rotor,
    /// `p psi sqrt(3/2 / (J L))`.
    fn fastest_rate(&self) -> f64 {
        let (inductance, psi) = match self.field {
            Field::Constant { inductance, psi_f, .. } => {
                (inductance.d.min(inductance.q), Dq { d: inductance.d * self.i.d + psi_f, q: inductance.q * self.i.q })
            }
            Field::Map(map) => {
                let Some(flux) = map.at(self.i) else { return f64::INFINITY };
                (flux.inductance[0][0].min(flux.inductance[1][1]), flux.psi)
            }
        };
        let omega_e = self.omega_e();
        let psi_squared = psi.d * psi.d + psi.q * psi.q;
        let oscillation_squared = self.pole_pairs * self.pole_pairs * psi_squared * 1.5 * self.per_inertia / inductance;
        let periods = if self.harmonics.is_some() { PERIODS } else { 1.0 };
        let rotation = periods * omega_e;
        self.rs / inductance + self.friction_rate + (rotation * rotation + oscillation_squared).sqrt()
    }

    /// One integration step of `h` seconds with a voltage, V, that is constant in the stator frame. False, without a step, if the current
    /// leaves the flux map.
    #[must_use]
    pub fn step(&mut self, u: AlphaBeta, h: f64) -> bool {
        match self.harmonics {
            None => self.step_with(u, h, |psi, _| psi),
            Some((harmonics, psi_f)) => {
                let theta_e = self.theta_e;
                self.step_with(u, h, |psi, turn| {
                    let induced = harmonics.induced(psi_f, theta_e + turn);
                    Dq { d: psi.d + induced.d, q: psi.q + induced.q }
                })
            }
        }
    }

    /// `with_harmonics` adds those of the magnets' flux to a flux linkage, Wb, when the rotor has turned by an electrical angle, rad, since
    /// the start of the step.
    #[inline(always)]
    fn step_with(&mut self, u: AlphaBeta, h: f64, with_harmonics: impl Fn(Dq, f64) -> Dq) -> bool {
        let rs = self.rs;
        // Equation (1).
        let rise = |i: Dq, psi: Dq, u: Dq, omega_e: f64| Dq { d: u.d - rs * i.d + omega_e * psi.q, q: u.q - rs * i.q - omega_e * psi.d };
        let stepped = match self.field {
            // Without the general inverse, for whose division every stage would wait.
            Field::Constant { inductance, inverse, psi_f } => self.runge_kutta(u, h, |i, u, omega_e, turn| {
                let psi = with_harmonics(Dq { d: inductance.d * i.d + psi_f, q: inductance.q * i.q }, turn);
                let rise = rise(i, psi, u, omega_e);
                Some((psi, Dq { d: rise.d * inverse.d, q: rise.q * inverse.q }))
            }),
            Field::Map(map) => self.runge_kutta(u, h, |i, u, omega_e, turn| {
                let flux = map.at(i)?;
                let psi = with_harmonics(flux.psi, turn);
                let rise = rise(i, psi, u, omega_e);
                let [[dd, dq], [qd, qq]] = flux.inductance;
                let inverse = 1.0 / (dd * qq - dq * qd);
                Some((psi, Dq { d: (qq * rise.d - dq * rise.q) * inverse, q: (dd * rise.q - qd * rise.d) * inverse }))
            }),
        };
        stepped.is_some()
    }

    /// `electrical` gives flux linkage and slope of the current from current, voltage, electrical speed and the electrical angle since
    /// the start of the step; `None` outside of the map.
    #[inline(always)]
    fn runge_kutta(&mut self, u: AlphaBeta, h: f64, electrical: impl Fn(Dq, Dq, f64, f64) -> Option<(Dq, Dq)>) -> Option<()> {
        let u = self.direction.to_rotor(u);
        let k1 = self.slope(self.i, self.omega_m, 0.0, u, &electrical)?;
        let k2 = self.slope_after(0.5 * h, &k1, u, &electrical)?;
        let k3 = self.slope_after(0.5 * h, &k2, u, &electrical)?;
        let k4 = self.slope_after(h, &k3, u, &electrical)?;

        let sixth = h * (1.0 / 6.0);
        let change = Slope::combined([k1, k2, k3, k4], |[k1, k2, k3, k4]| sixth * (k1 + 2.0 * (k2 + k3) + k4));
        self.i = Dq { d: self.i.d + change.i.d, q: self.i.q + change.i.q };
        self.omega_m += change.omega_m;
        let turn = self.pole_pairs * change.theta_m;
        self.theta_e += turn;
        self.direction = self.direction.turned(Direction::of_small(turn));
        self.energies.electrical += 1.5 * change.electrical;
        self.energies.copper += 1.5 * self.rs * change.copper;
        self.energies.mechanical += 1.5 * self.pole_pairs * change.mechanical;
        Some(())
    }

    /// The slope at a state, with the voltage `u` in its rotor frame; the rotor has turned by `turn`, electrical rad, since the start of
    /// the step.
    #[inline(always)]
    fn slope(&self, i: Dq, omega_m: f64, turn: f64, u: Dq, electrical: &impl Fn(Dq, Dq, f64, f64) -> Option<(Dq, Dq)>) -> Option<Slope> {
        let (psi, slope) = electrical(i, u, self.pole_pairs * omega_m, turn)?;
        let product = psi.d * i.q - psi.q * i.d;
        let drag = self.friction_rate * omega_m + (self.load * self.per_inertia - self.acceleration);
        Some(Slope {
            i: slope,
            omega_m: product * (1.5 * self.pole_pairs * self.per_inertia) - drag,
            theta_m: omega_m,
            electrical: u.d * i.d + u.q * i.q,
            copper: i.d * i.d + i.q * i.q,
            mechanical: product * omega_m,
        })
    }

    /// The slope at the state which is `by` seconds along slope `k`. The rotor has turned on by then, so in its frame the voltage `u` of
    /// the present one has turned back.
    #[inline(always)]
    fn slope_after(&self, by: f64, k: &Slope, u: Dq, electrical: &impl Fn(Dq, Dq, f64, f64) -> Option<(Dq, Dq)>) -> Option<Slope> {
        let i = Dq { d: self.i.d + by * k.i.d, q: self.i.q + by * k.i.q };
        let turn = by * self.pole_pairs * k.theta_m;
        let u = Direction::of_small(turn).to_rotor(AlphaBeta { alpha: u.d, beta: u.q });
        self.slope(i, self.omega_m + by * k.omega_m, turn, u, electrical)
    }
}

impl Slope {
    #[inline(always)]
    fn combined([a, b, c, d]: [Self; 4], of: impl Fn([f64; 4]) -> f64) -> Self {
        Self {
            i: Dq { d: of([a.i.d, b.i.d, c.i.d, d.i.d]), q: of([a.i.q, b.i.q, c.i.q, d.i.q]) },
            omega_m: of([a.omega_m, b.omega_m, c.omega_m, d.omega_m]),
            theta_m: of([a.theta_m, b.theta_m, c.theta_m, d.theta_m]),
            electrical: of([a.electrical, b.electrical, c.electrical, d.electrical]),
            copper: of([a.copper, b.copper, c.copper, d.copper]),
            mechanical: of([a.mechanical, b.mechanical, c.mechanical, d.mechanical]),
        }
    }
}

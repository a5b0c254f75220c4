//! Settings of the simulated machine: motor and mechanics. `plant` has its equations.

use crate::{
    flux_map::{FluxLinkage, FluxMap},
    harmonics::Harmonics,
    schedule::Profile,
};
use fluxfit::{
    frames::Dq,
    motor::{Motor, PARAMETERS},
};

/// The simulated motor, whose parameters are the log's true ones.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedMotor {
    /// Stator resistance, ohm.
    pub rs: f64,
    /// By which fraction the resistance has grown at the end of the simulated time; it grows linearly.
    pub rs_drift: f64,
    /// By which fractions rs, ld, lq and psi_f have changed over time; of a flux map only the first counts. The current does not jump
    /// where an inductance or the flux does, and the voltage that their change would induce is left out.
    pub changes: [Profile; PARAMETERS],
    /// Flux linkage as a function of current.
    pub magnetics: Magnetics,
    /// Harmonics of the magnets' flux; those of a motor without magnets have no effect.
    pub harmonics: Harmonics,
    /// Pole pairs.
    pub pole_pairs: u32,
}

/// Flux linkage as a function of current.
#[derive(Debug, Clone, PartialEq)]
pub enum Magnetics {
    /// `psi_d = L_d i_d + psi_f`, `psi_q = L_q i_q`.
    Constant {
        /// d-axis inductance, H.
        ld: f64,
        /// q-axis inductance, H.
        lq: f64,
        /// Magnet flux linkage, Wb, peak per phase.
        psi_f: f64,
    },
    /// A measured flux map.
    Map(FluxMap),
}

/// The mechanics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mechanics {
    /// A free rotor with a load; the drive controls the speed.
    Free {
        /// Inertia of rotor and load, kg m².
        inertia: f64,
        /// Viscous friction, N m s.
        friction: f64,
    },
    /// A dynamometer, which imposes the scheduled speed; the drive controls the currents.
    Dyno,
}

impl SimulatedMotor {
    /// A motor with a constant resistance, ohm, and a sinusoidal flux of the magnets.
    pub fn new(rs: f64, magnetics: Magnetics, pole_pairs: u32) -> Self {
        Self { rs, rs_drift: 0.0, changes: Default::default(), magnetics, harmonics: Harmonics::default(), pole_pairs }
    }

    /// Stator resistance, ohm, at a time, s, which is a part, 0 to 1, of the simulated one.
    pub(crate) fn rs_at(&self, t: f64, part: f64) -> f64 {
        self.rs * (1.0 + self.rs_drift * part) * (1.0 + self.changes[0].at(t))
    }

    /// Constant inductances, H, and flux linkage of the magnet, Wb, at a time, s; `None` of a flux map.
    pub(crate) fn constants_at(&self, t: f64) -> Option<[f64; 3]> {
        let Magnetics::Constant { ld, lq, psi_f } = &self.magnetics else { return None };
        let [_, by_ld, by_lq, by_psi_f] = self.changes.each_ref().map(|change| 1.0 + change.at(t));
        Some([ld * by_ld, lq * by_lq, psi_f * by_psi_f])
    }

    /// The flux linkage at a current, A, and a time, s; `None` outside of a flux map.
    pub(crate) fn flux_at(&self, i: Dq, t: f64) -> Option<FluxLinkage> {
        self.constants_at(t).map_or_else(|| self.flux(i), |[ld, lq, psi_f]| Some(linear_flux(i, ld, lq, psi_f)))
    }

    /// The flux linkage at a current, A, before any change; `None` outside of a flux map.
    #[inline]
    pub(crate) fn flux(&self, i: Dq) -> Option<FluxLinkage> {
        match &self.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => Some(linear_flux(i, *ld, *lq, *psi_f)),
            Magnetics::Map(map) => map.at(i),
        }
    }

    /// The motor with the constant parameters of zero current, which a flux map must contain.
    pub fn unsaturated(&self) -> Motor {
        match &self.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => Motor { rs: self.rs, ld: *ld, lq: *lq, psi_f: *psi_f },
            Magnetics::Map(_) => {
                let (ld, lq, psi_f) = self.flux(Dq::default()).map_or((f64::NAN, f64::NAN, f64::NAN), |flux| {
                    let [[ld, _], [_, lq]] = flux.inductance;
                    (ld, lq, flux.psi.d)
                });
                Motor { rs: self.rs, ld, lq, psi_f }
            }
        }
    }

    /// The current clamped to the range of a flux map.
    pub(crate) fn within_map(&self, i: Dq) -> Dq {
        match &self.magnetics {
            Magnetics::Constant { .. } => i,
            Magnetics::Map(map) => {
                let within = |[low, high]: [f64; 2], current: f64| current.clamp(low, high);
                Dq { d: within(map.id_range(), i.d), q: within(map.iq_range(), i.q) }
            }
        }
    }

    /// The true parameters at a time, s, of `duration`; `None` of a flux map.
    pub fn parameters_at(&self, t: f64, duration: f64) -> Option<Motor> {
        self.constants_at(t).map(|[ld, lq, psi_f]| Motor { rs: self.rs_at(t, t / duration), ld, lq, psi_f })
    }

    /// The true parameters before any change, if they do not depend on the current.
    pub fn constant_parameters(&self) -> Option<Motor> {
        matches!(self.magnetics, Magnetics::Constant { .. }).then(|| self.unsaturated())
    }

    /// Torque, N m, from flux linkage and current.
    pub(crate) fn torque(&self, psi: Dq, i: Dq) -> f64 {
        1.5 * f64::from(self.pole_pairs) * (psi.d * i.q - psi.q * i.d)
    }
}

fn linear_flux(i: Dq, ld: f64, lq: f64, psi_f: f64) -> FluxLinkage {
    FluxLinkage { psi: Dq { d: ld * i.d + psi_f, q: lq * i.q }, inductance: [[ld, 0.0], [0.0, lq]] }
}

impl From<Motor> for Magnetics {
    fn from(motor: Motor) -> Self {
        Self::Constant { ld: motor.ld, lq: motor.lq, psi_f: motor.psi_f }
    }
}

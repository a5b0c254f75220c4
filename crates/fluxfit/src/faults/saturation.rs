//! Saturation: flux that does not grow in proportion to the current.
//!
//! ```text
//! psi_d = L_d i_d + psi_f + s_d i_d |i_d| + c i_q²,     psi_q = L_q i_q + s_q i_q |i_q| + 2 c i_d i_q
//! ```
//!
//! The simplest flux beyond the linear one that is odd along its own axis, and whose cross term belongs to one magnetic energy:
//! `d psi_d / d i_q = d psi_q / d i_d = 2 c i_q`. No fault of the drive but of the model of its motor; it is found like one.

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, present_state};
use crate::{frames::Dq, lanes::Number, motor::PARAMETERS};

/// Coefficients of saturation, H/A. Iron that saturates makes them negative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Saturation {
    /// `s_d`.
    pub d: f64,
    /// `s_q`.
    pub q: f64,
    /// `c`, cross saturation.
    pub cross: f64,
}

/// Least extra flux, as a fraction of that of an inductance at the largest current, that is worth calling saturation.
const LEAST: f64 = 0.02;

/// Most extra flux, likewise. At half of the inductance the flux no longer grows at the largest current; the rest is allowed because the
/// formula only approximates iron.
const MOST: f64 = 0.8;

pub(super) static FAULT: Description<Saturation> = Description {
    key: "saturation",
    label: "saturation",
    family: "saturation",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[
        NumberDescription {
            names: Names { key: "saturation_d", label: "saturation of L_d per ampere of i_d", unit: "H/A" },
            get: |state| state.d,
            set: |state, value| state.d = value,
            usual_size: |motor, peak| motor.ld.abs() / peak,
        },
        NumberDescription {
            names: Names { key: "saturation_q", label: "saturation of L_q per ampere of i_q", unit: "H/A" },
            get: |state| state.q,
            set: |state, value| state.q = value,
            usual_size: |motor, peak| motor.lq.abs() / peak,
        },
        NumberDescription {
            names: Names { key: "cross_saturation", label: "cross saturation", unit: "H/A" },
            get: |state| state.cross,
            set: |state, value| state.cross = value,
            usual_size: |motor, peak| motor.lq.abs() / peak,
        },
    ],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, motor, peak| {
        let (d, q, cross) = (state.d * peak / motor.ld, state.q * peak / motor.lq, state.cross * peak / motor.lq);
        // Iron takes flux away, it takes enough to be seen, and more current never makes less flux.
        let most = d.abs().max(q.abs()).max(cross.abs());
        d.max(q) < LEAST && most > LEAST && most < MOST
    },
};

/// Flux, Wb, `d, q`, beyond `L i + psi_f` at current `i`, A, given `s_d`, `s_q` and `c`.
#[inline(always)]
pub(super) fn extra_flux<V: Number>([s_d, s_q, cross]: [V; 3], i: [V; 2]) -> [V; 2] {
    let [d, q] = i;
    [s_d * d * d.abs() + cross * q * q, s_q * q * q.abs() + d.constant(2.0) * cross * d * q]
}

impl Saturation {
    /// Flux, Wb, beyond `L i + psi_f`.
    pub fn extra_flux(&self, i: Dq) -> Dq {
        let [d, q] = extra_flux([self.d, self.q, self.cross], [i.d, i.q]);
        Dq { d, q }
    }

    /// Voltage, V, that the extra flux takes at steady current `i`, A, and speed `omega_e`, electrical rad/s: what is to be added to
    /// equation (2).
    pub fn steady_voltage(&self, i: Dq, omega_e: f64) -> Dq {
        let times = |factor: f64| Self { d: factor * self.d, q: factor * self.q, cross: factor * self.cross };
        Dq { d: times(-omega_e).extra_flux(i).q, q: times(omega_e).extra_flux(i).d }
    }

    /// The extra flux at current `i`, A, as a change of each parameter of the motor, SI.
    pub fn apparent_change(&self, i: Dq) -> [f64; PARAMETERS] {
        [0.0, self.d * i.d.abs(), self.q * i.q.abs() + 2.0 * self.cross * i.d, self.cross * i.q * i.q]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    const IRON: Saturation = Saturation { d: -1e-4, q: -3e-4, cross: -2e-5 };

    /// Equation (2) with the flux written out.
    #[test]
    fn the_steady_voltage_is_speed_times_flux() {
        let motor = Motor { rs: 0.5, ld: 5e-3, lq: 12e-3, psi_f: 0.1 };
        for (i, omega_e) in [(Dq { d: -3.0, q: 8.0 }, 400.0), (Dq { d: 2.0, q: -5.0 }, -150.0)] {
            let linear = motor.steady_voltage(i, omega_e);
            let psi_d = motor.ld * i.d + motor.psi_f + IRON.d * i.d * i.d.abs() + IRON.cross * i.q * i.q;
            let psi_q = motor.lq * i.q + IRON.q * i.q * i.q.abs() + 2.0 * IRON.cross * i.d * i.q;
            let extra = IRON.steady_voltage(i, omega_e);
            assert!((linear.d + extra.d - (motor.rs * i.d - omega_e * psi_q)).abs() < 1e-12);
            assert!((linear.q + extra.q - (motor.rs * i.q + omega_e * psi_d)).abs() < 1e-12);
        }
    }

    /// Both slopes across the axes are one derivative of the magnetic energy.
    #[test]
    fn the_cross_terms_are_reciprocal() {
        let (i, step) = (Dq { d: -3.0, q: 8.0 }, 1e-5);
        let by_q = (IRON.extra_flux(Dq { q: i.q + step, ..i }).d - IRON.extra_flux(Dq { q: i.q - step, ..i }).d) / (2.0 * step);
        let by_d = (IRON.extra_flux(Dq { d: i.d + step, ..i }).q - IRON.extra_flux(Dq { d: i.d - step, ..i }).q) / (2.0 * step);
        assert!((by_q - by_d).abs() < 1e-9 * by_q.abs() && (by_q - 2.0 * IRON.cross * i.q).abs() < 1e-9 * by_q.abs());
    }

    #[test]
    fn the_apparent_change_is_the_extra_flux() {
        let i = Dq { d: -3.0, q: 8.0 };
        let ([rs, ld, lq, psi_f], flux) = (IRON.apparent_change(i), IRON.extra_flux(i));
        assert_eq!(rs, 0.0);
        assert!((ld * i.d + psi_f - flux.d).abs() < 1e-15 && (lq * i.q - flux.q).abs() < 1e-15);
    }

    #[test]
    fn iron_takes_flux_away_but_not_all_of_it() {
        let motor = Motor { rs: 0.5, ld: 5e-3, lq: 12e-3, psi_f: 0.1 };
        let is_physical = |q: f64| (FAULT.is_physical)(&Saturation { q, ..Saturation::default() }, &motor, 10.0);
        // Fractions of L_q at 10 A: -25 %, +25 %, -1 %, -90 %.
        assert_eq!([-3e-4, 3e-4, -1.2e-5, -1.08e-3].map(is_physical), [true, false, false, false]);
    }
}

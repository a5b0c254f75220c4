//! The angle of a drive where operating points answer: it may be off, and late.
//!
//! Where simulated currents explain a log, they tell both by how they move. In steady points an angle that is read too large by
//! `a + omega_e T` is like other inductances, unless loads or speeds differ: so the offset `a` and the delay `T` are unknowns beside the
//! motor, with priors of the sizes that drives have. With all points turned back by what is known of the two, a further `da` adds
//!
//! ```text
//! omega_e (psi_f - (L_q - L_d) i_d) da     to u_d
//! omega_e (L_q - L_d) i_q da               to u_q
//! ```
//!
//! and of an angle that stays unknown the cosine takes a part of the flux.

use super::{super::request::Request, estimate::TOLD, part::Part, voltage_loss::Loss};
use crate::{frames::Dq, log::Log, motor::Motor, steady::OperatingPoint};

/// Standard error of the angle, rad: 95 % of the drives within 6 degrees, as an alignment by current leaves it against friction and
/// cogging; a resolver or an encoder that was measured in is better.
const USUAL_OFFSET: f64 = 0.05;

/// Standard error of what the angle is late by, s: a period of a drive that controls at 20 kHz.
const USUAL_DELAY: f64 = 50e-6;

/// Rounds of turning the voltages.
pub(super) const ROUNDS: usize = 3;

/// What the voltages are turned back by, and how well that is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FrameAngle {
    /// rad.
    offset: f64,
    /// s.
    delay: f64,
    /// Standard errors of the two.
    errors: [f64; 2],
}

impl FrameAngle {
    /// How many [unknowns](Self::unknowns) there are.
    pub(super) const UNKNOWNS: usize = 3;

    /// Of a drive of which nothing else is known.
    pub(super) const USUAL: Self = Self { offset: 0.0, delay: 0.0, errors: [USUAL_OFFSET, USUAL_DELAY] };

    /// Where it may be unknown; not where voltages are exact, and not for whoever states the steady model: that states its equations, the
    /// angle with them.
    pub(super) fn possible(log: &Log, request: &Request) -> Option<Self> {
        let are_exact = request.voltage_accuracy == 0.0 || log.is_short_circuit();
        (!are_exact && request.model.is_none()).then_some(Self::USUAL)
    }

    /// Whether the points tell the offset or, at one speed, the delay that does the same, rather than their priors.
    pub(super) fn is_told(&self) -> bool {
        let [offset, delay] = self.errors;
        offset < TOLD * USUAL_OFFSET || delay < TOLD * USUAL_DELAY
    }

    /// By how much it is late, s.
    pub(super) fn delay(&self) -> f64 {
        self.delay
    }

    pub(super) fn turned_back(&self, points: &[OperatingPoint]) -> Vec<OperatingPoint> {
        points.iter().map(|point| point.in_frame_behind(self.offset + point.omega_e() * self.delay)).collect()
    }

    /// What is still unknown at points that are turned back by it, given the motor: the cosine, the offset, the delay.
    pub(super) fn unknowns(&self, points: &[OperatingPoint], motor: &Motor) -> [Loss; Self::UNKNOWNS] {
        let part = Part::FrameLag;
        let saliency = motor.lq - motor.ld;
        let off = |point: &OperatingPoint| {
            let Dq { d, q } = point.current();
            [motor.psi_f - saliency * d, saliency * q].map(|part| part * point.omega_e())
        };
        let late = |point: &OperatingPoint| off(point).map(|part| part * point.omega_e());
        let flux = |point: &OperatingPoint| [0.0, motor.psi_f * point.omega_e()];
        let fastest = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
        let [offset_error, delay_error] = self.errors;
        let angle = offset_error.hypot(delay_error * fastest).min(1.0);
        [
            Loss { voltages: points.iter().map(flux).collect(), expected: 0.0, standard_error: 0.5 * angle * angle, part },
            Loss { voltages: points.iter().map(off).collect(), expected: -self.offset, standard_error: USUAL_OFFSET, part },
            Loss { voltages: points.iter().map(late).collect(), expected: -self.delay, standard_error: USUAL_DELAY, part },
        ]
    }

    /// The same with what an estimate found of the [unknowns](Self::unknowns).
    pub(super) fn with(&self, found: &[(f64, f64); Self::UNKNOWNS]) -> Self {
        let [_, (offset, offset_error), (delay, delay_error)] = *found;
        Self { offset: self.offset + offset, delay: self.delay + delay, errors: [offset_error, delay_error] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    const MOTOR: Motor = Motor { rs: 0.03, ld: 20e-6, lq: 30e-6, psi_f: 9e-3 };

    /// Points of ten rows at (i_d, i_q, omega_e), whose angle is read too large, rad.
    fn points(angle: f64) -> Vec<OperatingPoint> {
        let mut columns = Columns::default();
        let modes = [(0.0, 5.0, 2000.0), (-8.0, 12.0, 2500.0), (3.0, 8.0, -1500.0)];
        for (k, &(d, q, omega_e)) in modes.iter().flat_map(|mode| [mode; 10]).enumerate() {
            let u = MOTOR.steady_voltage(Dq { d, q }, omega_e);
            let (sin, cos) = angle.sin_cos();
            columns.t.push(k as f64 * 1e-3);
            columns.ud.push(cos * u.d + sin * u.q);
            columns.uq.push(cos * u.q - sin * u.d);
            columns.id.push(cos * d + sin * q);
            columns.iq.push(cos * q - sin * d);
            columns.omega_e.push(omega_e);
        }
        let log = Log::new(columns).unwrap();
        (0..modes.len()).map(|w| OperatingPoint::measure(&log, 10 * w..10 * (w + 1), None)).collect()
    }

    fn residuals(points: &[OperatingPoint]) -> Vec<f64> {
        points.iter().flat_map(|point| point.equations().map(|equation| equation.residual(&MOTOR.to_array()))).collect()
    }

    #[test]
    fn points_turned_back_obey_the_steady_equations() {
        let known = FrameAngle { offset: 0.05, delay: 0.0, errors: [0.0; 2] };
        let left = residuals(&known.turned_back(&points(0.05)));
        assert!(left.iter().all(|left| left.abs() < 1e-12), "{left:?}");
    }

    /// A milliradian against the voltage that it leaves in the equations; its square is the tolerance.
    #[test]
    fn the_unknown_is_the_derivative_of_what_an_offset_leaves() {
        const ANGLE: f64 = 1e-3;
        let exact = points(0.0);
        let [_, off, _] = FrameAngle::default().unknowns(&exact, &MOTOR);
        let left = residuals(&points(ANGLE));
        for (left, volts) in left.iter().zip(off.voltages.iter().flatten()) {
            // The sign of a residual does not matter here.
            assert!((left.abs() - ANGLE * volts.abs()).abs() < 2.0 * ANGLE * ANGLE * 25.0, "{left} {volts}");
        }
    }
}

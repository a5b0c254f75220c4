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
//!
//! A drive that does not turn its voltages on to the instant at which they act turns them alone. To the magnet's voltage that is the same;
//! to those of the currents it is not: at one speed, voltages that are turned by `a` alone are those of the resistance
//! `R_s cos a - omega_e L sin a`. So the angle that is found, or that the points leave open, may be the voltages' own to any part: the time
//! by which they lag alone is one more unknown.

use super::{
    super::request::Request,
    estimate::{Estimate, TOLD},
    part::Part,
    voltage_loss::Loss,
};
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
    /// Covariance of the two.
    covariance: [[f64; 2]; 2],
    /// The part of both that turns the voltages alone, s.
    lag: f64,
}

impl FrameAngle {
    /// How many [unknowns](Self::unknowns) there are.
    pub(super) const UNKNOWNS: usize = 3;

    /// Of a drive of which nothing else is known.
    pub(super) const USUAL: Self =
        Self { offset: 0.0, delay: 0.0, covariance: [[USUAL_OFFSET * USUAL_OFFSET, 0.0], [0.0, USUAL_DELAY * USUAL_DELAY]], lag: 0.0 };

    /// Where it may be unknown; not where voltages are exact, and not for whoever states the steady model: that states its equations, the
    /// angle with them.
    pub(super) fn possible(log: &Log, request: &Request) -> Option<Self> {
        let are_exact = request.voltage_accuracy == 0.0 || log.is_short_circuit();
        (!are_exact && request.model.is_none()).then_some(Self::USUAL)
    }

    /// Whether the points tell the offset or, at one speed, the delay that does the same, rather than their priors.
    pub(super) fn is_told(&self) -> bool {
        let [offset, delay] = self.errors();
        offset < TOLD * USUAL_OFFSET || delay < TOLD * USUAL_DELAY
    }

    /// By how much it is late, s.
    pub(super) fn delay(&self) -> f64 {
        self.delay
    }

    pub(super) fn turned_back(&self, points: &[OperatingPoint]) -> Vec<OperatingPoint> {
        let turned = |point: &OperatingPoint| {
            let alone = point.omega_e() * self.lag;
            point.in_frame_behind(self.angle_at(point.omega_e()) - alone).turned(alone)
        };
        points.iter().map(turned).collect()
    }

    /// By how much the angle is read too large at a speed, rad.
    fn angle_at(&self, omega_e: f64) -> f64 {
        self.offset + omega_e * self.delay
    }

    /// Standard error of that, rad.
    fn error_at(&self, omega_e: f64) -> f64 {
        let [[offset, both], [_, delay]] = self.covariance;
        (offset + 2.0 * omega_e * both + omega_e * omega_e * delay).max(0.0).sqrt()
    }

    /// Standard errors of offset and delay.
    fn errors(&self) -> [f64; 2] {
        let [[offset, _], [_, delay]] = self.covariance;
        [offset.sqrt(), delay.sqrt()]
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
        let [offset_error, delay_error] = self.errors();
        let angle = offset_error.hypot(delay_error * fastest(points)).min(1.0);
        [
            Loss { voltages: points.iter().map(flux).collect(), expected: 0.0, standard_error: 0.5 * angle * angle, part },
            Loss { voltages: points.iter().map(off).collect(), expected: -self.offset, standard_error: USUAL_OFFSET, part },
            Loss { voltages: points.iter().map(late).collect(), expected: -self.delay, standard_error: USUAL_DELAY, part },
        ]
    }

    /// What is unknown of the time by which the voltages lag alone, at points that are turned back by it, given the motor. Before they are
    /// heard, a lag is as likely as long as it makes no more than the angle, with its error, at the fastest of them.
    pub(super) fn lag_of_voltages(&self, points: &[OperatingPoint], motor: &Motor) -> Loss {
        let [_, _, late] = self.unknowns(points, motor);
        let alone = points.iter().zip(late.voltages).map(|(point, late)| {
            let voltages = turned(point).map(|part| part * point.omega_e());
            std::array::from_fn(|axis| voltages[axis] - late[axis])
        });
        let fastest = fastest(points);
        let angle = self.angle_at(fastest).hypot(self.error_at(fastest));
        let standard_error = if fastest == 0.0 { USUAL_DELAY } else { angle / fastest.abs() };
        Loss { voltages: alone.collect(), expected: -self.lag, standard_error, part: Part::FrameLag }
    }

    /// The same with what an estimate found of that.
    pub(super) fn with_lag_of_voltages(self, missing: f64) -> Self {
        Self { lag: self.lag + missing, ..self }
    }

    /// The same with what an estimate found of the [unknowns](Self::unknowns), the first of them in this place.
    pub(super) fn with_unknowns(&self, found: &Estimate, place: usize) -> Self {
        let [offset, delay] = [place + 1, place + 2];
        let covariance = [offset, delay].map(|one| [offset, delay].map(|other| found.found_covariance[one][other]));
        Self { offset: self.offset + found.found[offset].0, delay: self.delay + found.found[delay].0, covariance, ..*self }
    }
}

/// Speed of the fastest point with its sign, rad/s.
fn fastest(points: &[OperatingPoint]) -> f64 {
    let speeds = points.iter().map(OperatingPoint::omega_e);
    speeds.fold(0.0, |most: f64, omega_e| if omega_e.abs() > most.abs() { omega_e } else { most })
}

/// The voltage of a point, turned backwards by a right angle: what a small angle adds to it.
pub(super) fn turned(point: &OperatingPoint) -> [f64; 2] {
    [point.voltage().q, -point.voltage().d]
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
        let known = FrameAngle { offset: 0.05, ..FrameAngle::default() };
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

    /// A lag of the voltages alone turns them and not the currents: points that lag so obey the equations when they are turned back, and
    /// where the angle, of which it is a part, is zero, the unknown is the difference that a microsecond makes.
    #[test]
    fn a_lag_of_the_voltages_leaves_the_currents() {
        const LAG: f64 = 1e-6;
        let exact = points(0.0);
        let lagging: Vec<OperatingPoint> = exact.iter().map(|point| point.turned(-point.omega_e() * LAG)).collect();
        let both = FrameAngle { delay: LAG, lag: LAG, ..FrameAngle::default() };
        let left = residuals(&both.turned_back(&lagging));
        assert!(left.iter().all(|left| left.abs() < 1e-9), "{left:?}");
        // An angle that is early by what the voltages lag: their sum turns nothing but the currents.
        let early = |point: &OperatingPoint| {
            let angle = point.omega_e() * LAG;
            point.in_frame_behind(angle).turned(-angle)
        };
        let without: Vec<OperatingPoint> = exact.iter().map(early).collect();
        let alone = FrameAngle::USUAL.lag_of_voltages(&exact, &MOTOR);
        let voltages: Vec<f64> = exact.iter().map(|point| point.voltage().magnitude()).collect();
        for ((left, alone), volts) in residuals(&without).chunks_exact(2).zip(&alone.voltages).zip(voltages) {
            for axis in 0..2 {
                assert!((left[axis].abs() - LAG * alone[axis].abs()).abs() < 1e-5 * volts, "{left:?} {alone:?}");
            }
        }
    }

    /// Of an angle that is told, the lag can be no larger than it; of one that is open, no larger than it may be.
    #[test]
    fn a_lag_is_as_large_as_the_angle_may_be() {
        let exact = points(0.0);
        let expected = |angle: FrameAngle| angle.lag_of_voltages(&exact, &MOTOR).standard_error * 2500.0;
        assert!((expected(FrameAngle { offset: 0.1, ..FrameAngle::default() }) - 0.1).abs() < 1e-12);
        let open = USUAL_OFFSET.hypot(USUAL_DELAY * 2500.0);
        assert!((expected(FrameAngle::USUAL) - open).abs() < 1e-12);
        // An offset and a delay of which only what they make at the fastest point is known, whichever way it turns.
        for speed in [2500.0, -2500.0] {
            let both = -1e-2 / speed;
            let angle = FrameAngle { covariance: [[1e-2, both], [both, 1e-2 / (speed * speed)]], ..FrameAngle::default() };
            let mut turning = exact.clone();
            turning.iter_mut().for_each(|point| point.means[6] *= speed / 2500.0);
            assert!(angle.lag_of_voltages(&turning, &MOTOR).standard_error * speed.abs() < 1e-6);
        }
    }
}

//! The lags of a recorder: its voltages may turn with speed against its currents, and its speed may be of another instant than its means.
//!
//! A recorder's rows hold what the drive computed or measured at different instants of its period: the voltages' frame is that of an angle
//! that is late by a time `T`, a filter's or a period's. With it the voltages are `u exp(-j omega_e T)`, of which the magnet makes
//! `u_d = psi_f omega_e² T`: like `-omega_e L_q i_q` wherever the current follows the speed. So `T` is an unknown beside the motor, with a
//! prior of the size that drives have. Different loads at one speed tell it, and so do rows [without current](super::coasting), where the
//! terminals are measured; where nothing does, its doubt is `psi_f omega_e T / i_q` of `L_q`.
//!
//! ```text
//! u exp(j omega_e T) = (steady equations) - j omega_e dT u + j psi_f (domega_e/dt) tau
//! ```
//!
//! `T` is what the voltages are turned back by already, `dT` what is still missing, `tau` the time by which the speed column is old. The
//! means of a row are of the middle of its period, but many recorders write the speed of its end. The angle that voltages and currents
//! share may be off and late beside it: [`FrameAngle`](super::frame_angle::FrameAngle). What the magnet shows is `T` and the lateness of
//! the angle together, so `T` here is their sum, and of the angle's only that it turns the currents too is a further unknown.

use super::{
    super::request::Request,
    frame_angle::{FrameAngle, turned},
    part::Part,
    voltage_loss::Loss,
};
use crate::{
    column_check::turn_with_speed,
    log::Log,
    motor::Motor,
    steady::{OperatingPoint, recorder, windows},
};

/// Standard error of what is known of the lag beforehand, s: one and a half periods of a drive that controls at 15 kHz, from the sampling
/// of the current to the middle of the period in which the voltage acts. Measured: 43 us in the log of a VESC.
const USUAL_LAG: f64 = 100e-6;

/// Standard error of the difference between the lags of rows with and without current, s: the drive measures the ones through the filters
/// of its dividers, and computes the others.
const OTHER_LAG: f64 = 5e-6;

/// Standard error of an angle, rad, by which the voltages seem to be turned at any speed before a motor is known: a degree, what an
/// observer or a calibrated encoder is off by.
const USUAL_OFFSET: f64 = 0.017;

/// What the lag of one row differs from that of another, s, one standard deviation: in the log of a VESC it is 43 us at one speed and 46 us
/// at another. A part of it that follows the load acts like `L_q`.
const SPREAD: f64 = 2e-6;

/// Rounds of turning the voltages: the second leaves the square of what the first did not know, a millionth.
pub(super) const ROUNDS: usize = 4;

/// A lag is found if it is this many standard errors.
const FOUND: f64 = 3.0;

/// The time by which the voltages lie behind the rotor's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FrameLag {
    /// s; positive: the voltages lie behind the rotor's frame at positive speed.
    pub seconds: f64,
    /// s.
    pub standard_error: f64,
    /// Rows without current that helped to tell it; zero where the drive does not measure its terminals, or never coasts.
    pub coasting_rows: usize,
}

impl FrameLag {
    /// The place of the other lag, that without current, among the [rough unknowns](Self::rough_unknowns).
    pub(super) const OTHER: usize = 1;

    /// How many [unknowns](Self::unknowns) there are.
    pub(super) const UNKNOWNS: usize = 3;

    /// What is known of it beforehand; none where voltages are exact, nor of a log that is no recorder's, unless its voltages make sense
    /// only if they are turned with the speed. Which period of the drive the voltages are of, if that is stated, says nothing of the frame
    /// of a recorder's means.
    pub(super) fn possible(log: &Log, request: &Request) -> Option<Self> {
        let are_exact = request.voltage_accuracy == 0.0 || log.is_short_circuit();
        let usual = Self { seconds: 0.0, standard_error: USUAL_LAG, coasting_rows: 0 };
        (!are_exact && (recorder::is_recorders(log) || turn_with_speed(log))).then_some(usual)
    }

    /// Points whose voltages are turned back by it, and whose voltages and currents are by an angle that accounts for a part of it.
    pub(super) fn turned_back(&self, points: &[OperatingPoint], angle: &FrameAngle) -> Vec<OperatingPoint> {
        let of_voltages = self.seconds - angle.delay();
        let turned: Vec<OperatingPoint> = points.iter().map(|point| point.turned(point.omega_e() * of_voltages)).collect();
        angle.turned_back(&turned)
    }

    /// What is still unknown at points that are turned back by it, given the flux, Wb: how much more the lag is without current, what is
    /// missing of it, and the age of the speed, s.
    pub(super) fn unknowns(&self, points: &[OperatingPoint], psi_f: f64, log: &Log) -> [Loss; Self::UNKNOWNS] {
        let part = Part::FrameLag;
        let missing = |point: &OperatingPoint| turned(point).map(|part| part * point.omega_e());
        let least_current = windows::least_current(log);
        let other = points.iter().map(|point| if point.current().magnitude() < least_current { missing(point) } else { [0.0; 2] });
        let old = points.iter().map(|point| [0.0, psi_f * point.acceleration]);
        [
            Loss { voltages: other.collect(), expected: 0.0, standard_error: OTHER_LAG, part },
            Loss { voltages: points.iter().map(missing).collect(), expected: -self.seconds, standard_error: USUAL_LAG, part },
            Loss { voltages: old.collect(), expected: 0.0, standard_error: log.slowest_period(), part },
        ]
    }

    /// The unknowns of an angle at points that are turned back by both, given the motor: its delay turns only the currents, because what it
    /// does to the voltages is in the lag.
    pub(super) fn unknowns_of_angle(points: &[OperatingPoint], angle: &FrameAngle, motor: &Motor) -> [Loss; FrameAngle::UNKNOWNS] {
        let [flux, off, mut late] = angle.unknowns(points, motor);
        for (volts, point) in late.voltages.iter_mut().zip(points) {
            let of_voltages = turned(point).map(|part| part * point.omega_e());
            *volts = std::array::from_fn(|axis| volts[axis] - of_voltages[axis]);
        }
        [flux, off, late]
    }

    /// The same before any motor is known: the flux of the fastest point will do, and of an angle that is off, that it turns the voltages.
    pub(super) fn rough_unknowns(&self, points: &[OperatingPoint], log: &Log) -> [Loss; 1 + Self::UNKNOWNS] {
        let angle = points.iter().map(turned).collect();
        let angle = Loss { voltages: angle, expected: 0.0, standard_error: USUAL_OFFSET, part: Part::FrameLag };
        let [other, missing, old] = self.unknowns(points, rough_flux(points), log);
        [angle, other, missing, old]
    }

    /// The same with what an estimate found of the [unknowns](Self::unknowns).
    pub(super) fn with(&self, found: &[(f64, f64); Self::UNKNOWNS]) -> Self {
        let [_, (missing, standard_error), _] = *found;
        Self { seconds: self.seconds + missing, standard_error, ..*self }
    }

    /// Standard uncertainty of `L_q`, H, by a lag that is not the same at all loads.
    pub(super) fn spread(points: &[OperatingPoint], psi_f: f64) -> f64 {
        let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|point| of(point.omega_e(), point.current().q)).sum::<f64>();
        let squares = sum(&|omega_e, iq| (omega_e * iq).powi(2));
        if squares > 0.0 { SPREAD * psi_f.abs() * sum(&|omega_e, iq| omega_e.abs().powi(3) * iq.abs()) / squares } else { 0.0 }
    }

    /// Whether there is one, beyond doubt.
    pub fn is_found(&self) -> bool {
        self.seconds.abs() > FOUND * self.standard_error
    }
}

/// The unknown part, in the `other` reading of the voltages by a drive that controls at a usual rate, of what it changes: none where the
/// voltages are means already, all at that rate, less at a faster one.
pub(super) fn hold_unknown(points: &[OperatingPoint], other: &[OperatingPoint]) -> Loss {
    let change = |(one, other): (&OperatingPoint, &OperatingPoint)| {
        let (one, other) = (one.voltage(), other.voltage());
        [one.d - other.d, one.q - other.q]
    };
    Loss { voltages: points.iter().zip(other).map(change).collect(), expected: 0.0, standard_error: 1.0, part: Part::Timing }
}

/// The flux, Wb, as the fastest point's voltage over its speed.
pub(super) fn rough_flux(points: &[OperatingPoint]) -> f64 {
    let fastest = points.iter().max_by(|one, other| one.omega_e().abs().total_cmp(&other.omega_e().abs()));
    fastest.filter(|point| point.omega_e() != 0.0).map_or(0.0, |point| point.voltage().q / point.omega_e())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frames::Dq, identification::fit::frame_free, log::Columns, motor::Motor};

    const MOTOR: Motor = Motor { rs: 0.03, ld: 20e-6, lq: 30e-6, psi_f: 9e-3 };

    /// Points of ten rows at (i_d, i_q, omega_e), ten rows a second, in a frame that is late by a time, s.
    fn points(modes: &[(f64, f64, f64)], lag: f64) -> (Log, Vec<OperatingPoint>) {
        let mut columns = Columns::default();
        for (k, &(d, q, omega_e)) in modes.iter().flat_map(|mode| [mode; 10]).enumerate() {
            let u = MOTOR.steady_voltage(Dq { d, q }, omega_e);
            let (sin, cos) = (omega_e * lag).sin_cos();
            columns.t.push(k as f64 * 0.1);
            columns.ud.push(cos * u.d + sin * u.q);
            columns.uq.push(cos * u.q - sin * u.d);
            columns.id.push(d);
            columns.iq.push(q);
            columns.omega_e.push(omega_e);
        }
        let log = Log::new(columns).unwrap();
        let points = (0..modes.len()).map(|w| OperatingPoint::measure(&log, 10 * w..10 * (w + 1), None)).collect();
        (log, points)
    }

    const MODES: [(f64, f64, f64); 3] = [(0.0, 5.0, 2000.0), (-2.0, 12.0, 2500.0), (0.0, 8.0, -1500.0)];

    #[test]
    fn points_turned_back_obey_the_steady_equations() {
        let (_, late) = points(&MODES, 50e-6);
        let lag = FrameLag { seconds: 50e-6, standard_error: 0.0, coasting_rows: 0 };
        for point in lag.turned_back(&late, &FrameAngle::USUAL) {
            let [d, q] = point.equations().map(|equation| equation.residual(&MOTOR.to_array()));
            assert!(d.abs().max(q.abs()) < 1e-12 * point.voltage().magnitude(), "{d} {q}");
        }
    }

    /// A microsecond of what is missing, and a milliradian, against the difference that they make.
    #[test]
    fn the_unknowns_are_the_derivatives_of_the_voltage() {
        let (log, exact) = points(&MODES, 0.0);
        let lag = FrameLag { seconds: 0.0, standard_error: USUAL_LAG, coasting_rows: 0 };
        let [angle, _, missing, _] = lag.rough_unknowns(&exact, &log);
        let (_, late) = points(&MODES, 1e-6);
        for (w, (one, other)) in exact.iter().zip(&late).enumerate() {
            let change = [other.voltage().d - one.voltage().d, other.voltage().q - one.voltage().q];
            let turned = one.turned(-1e-3);
            let by_angle = [turned.voltage().d - one.voltage().d, turned.voltage().q - one.voltage().q];
            for axis in 0..2 {
                let most = one.voltage().magnitude();
                assert!((change[axis] - 1e-6 * missing.voltages[w][axis]).abs() < 1e-5 * most);
                assert!((by_angle[axis] - 1e-3 * angle.voltages[w][axis]).abs() < 1e-6 * most);
            }
        }
    }

    /// By hand: one point of voltage psi_f omega T at 5 A per 2000 rad/s is `psi_f omega T / i_q`, 9 mWb 2000 rad/s 2 us / 5 A.
    #[test]
    fn a_lag_that_follows_the_load_is_an_inductance() {
        let (_, one) = points(&MODES[..1], 0.0);
        assert!((FrameLag::spread(&one, MOTOR.psi_f) / 7.2e-6 - 1.0).abs() < 1e-9);
    }

    /// The length of the magnet's voltage is the same in any frame; a hundredth more at one of two points is sqrt 1/2 of that as scatter.
    #[test]
    fn the_flux_without_a_frame_scatters_by_what_the_voltages_differ() {
        // A log without any current is none.
        let coasting = [(0.0, 1e-9, 2000.0), (0.0, 1e-9, 1000.0)];
        for lag in [0.0, 80e-6] {
            let (_, mut points) = points(&coasting, lag);
            assert!(frame_free::scatter(&points, &MOTOR) < 1e-9 * MOTOR.psi_f);
            points[0].means[0] *= 1.01;
            points[0].means[1] *= 1.01;
            assert!((frame_free::scatter(&points, &MOTOR) / (0.01 * 0.5_f64.sqrt() * MOTOR.psi_f) - 1.0).abs() < 1e-6);
        }
    }
}

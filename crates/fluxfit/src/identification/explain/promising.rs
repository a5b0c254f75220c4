//! What could be measured next, and what it would bring by noise and accuracy alone: what is worth a [trial](super::trial).
//!
//! A stretch held at some currents and speed adds two steady equations, each with the noise of so many rows and the accuracy of the
//! voltages there; a multimeter adds one for R_s. Each shrinks the covariance of what is known by
//!
//! ```text
//! C - C a a' C / (a' C a + variance)
//! ```
//!
//! (R. E. Kalman, "A new approach to linear filtering and prediction problems", J. Basic Eng. 82 (1960) 35, doi:10.1115/1.3662552).
//! Gains common to all sensors stay: whatever is measured with them has them too. R_s of a multimeter has them only in part, and counts
//! like the others. The misfit, terms and doubts of the log are not in this estimate.

use super::{
    super::{
        fit::finding::Bench,
        judge::{reason::SAME, verdict::IDENTIFIED},
    },
    measurement::{Measurement, Place, Promised},
};
use crate::{frames::Dq, motor::Parameter};
use nalgebra::{Matrix4, Vector4};

/// Share of the current that a step of i_d should have: the paper's -2 A of 10 A.
pub(super) const STEP: f64 = 0.2;

/// Lengths of a stretch, s.
const LENGTHS: [f64; 9] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0];

/// From this length on a stretch is quickly measured, s: a shorter one only where a longer one does not fit the log's own points.
const QUICKLY: f64 = 0.2;

/// Fewest rows of a stretch that is to be found as one.
const MIN_ROWS: f64 = 50.0;

/// By which all points may be faster: twice the speed doubles what inductances and flux take of the voltage.
const FASTER: f64 = 2.0;

/// What a good multimeter and a warm winding leave of R_s.
const MULTIMETER: f64 = 0.01;

/// Half a 95 % interval in standard deviations.
pub(super) const HALF_WIDTH: f64 = 1.96;

/// A measurement that is considered, with the currents (A) and speed (electrical rad/s) of a stretch.
enum Proposal {
    Hold {
        i: Dq,
        omega_e: f64,
        place: Place,
    },
    /// All that were held, faster.
    AllPoints,
    Multimeter,
}

/// What could be measured, with stretches from so long to so long, s, and what noise and accuracy alone would leave after it: first what
/// would make the parameter identified, the easiest first; then the rest, the best first.
pub(super) fn promising(bench: &Bench, lengths: (f64, f64), of_gains: f64, parameter: Parameter) -> Vec<Promised> {
    let width = |covariance: &Matrix4<f64>| width(bench, covariance, of_gains, parameter);
    let best_of = |proposal: &Proposal| {
        let outcomes = outcomes(bench, proposal, lengths, parameter, &width);
        let suffices = outcomes.iter().position(|promised| promised.half_width <= IDENTIFIED);
        outcomes.get(suffices.unwrap_or(outcomes.len().saturating_sub(1))).copied()
    };
    let of_all: Vec<Promised> = proposals(bench, parameter).iter().filter_map(best_of).filter(|one| one.half_width.is_finite()).collect();
    let (mut promising, mut rest): (Vec<_>, Vec<_>) = of_all.into_iter().partition(|one| one.half_width <= IDENTIFIED);
    rest.sort_by(|one, other| one.half_width.total_cmp(&other.half_width));
    promising.append(&mut rest);
    promising
}

/// Relative half-width of a parameter's interval.
fn width(bench: &Bench, covariance: &Matrix4<f64>, of_gains: f64, parameter: Parameter) -> f64 {
    let p = parameter as usize;
    HALF_WIDTH * covariance[(p, p)].max(0.0).sqrt().hypot(of_gains) / bench.motor.get(parameter).abs()
}

/// What a proposal makes of a parameter's interval, longer and longer.
fn outcomes(
    bench: &Bench,
    proposal: &Proposal,
    lengths: (f64, f64),
    parameter: Parameter,
    width: &impl Fn(&Matrix4<f64>) -> f64,
) -> Vec<Promised> {
    match proposal {
        Proposal::Multimeter => {
            let equation = Vector4::new(1.0, 0.0, 0.0, 0.0);
            let rs = if bench.motor.rs.is_nan() { bench.voltage / bench.current() } else { bench.motor.rs };
            let after = shrunk(bench.covariance, &equation, (MULTIMETER * rs).powi(2));
            let measurement = Measurement::Resistance { accuracy: MULTIMETER };
            vec![Promised { measurement, parameter, half_width: width(&after) }]
        }
        Proposal::AllPoints => {
            // Each as long as the shortest that stretches may be.
            let all =
                bench.held.iter().fold(bench.covariance, |after, (i, omega_e)| after_hold(bench, after, *i, FASTER * omega_e, lengths.0));
            vec![Promised { measurement: Measurement::AllPoints { times: FASTER }, parameter, half_width: width(&all) }]
        }
        Proposal::Hold { i, omega_e, place } => {
            let fits = |length: &f64| (lengths.0..=lengths.1).contains(length) && length / bench.sample_period >= MIN_ROWS;
            let mut fitting: Vec<f64> = LENGTHS.into_iter().filter(fits).collect();
            let short = fitting.iter().take_while(|length| **length < QUICKLY).count();
            fitting.drain(..short.min(fitting.len().saturating_sub(1)));
            let is_other = |speed: f64| (speed - omega_e).abs() > SAME * omega_e.abs();
            let is_named = *place != Place::HalfSpeed && bench.held.iter().any(|(_, speed)| is_other(*speed));
            let named = is_named.then_some(*omega_e);
            let promised = fitting.into_iter().map(|seconds| Promised {
                measurement: Measurement::Stretch { seconds, place: *place, omega_e: named },
                parameter,
                half_width: width(&after_hold(bench, bench.covariance, *i, *omega_e, seconds)),
            });
            promised.collect()
        }
    }
}

/// A covariance after a stretch at some currents and speed.
fn after_hold(bench: &Bench, covariance: Matrix4<f64>, i: Dq, omega_e: f64, length: f64) -> Matrix4<f64> {
    let accuracy = bench.voltage_accuracy * bench.voltage;
    let variance = bench.row_variance * bench.sample_period / length + accuracy * accuracy;
    let d = Vector4::new(i.d, 0.0, -omega_e * i.q, 0.0);
    let q = Vector4::new(i.q, omega_e * i.d, 0.0, omega_e);
    shrunk(shrunk(covariance, &d, variance), &q, variance)
}

/// What could be measured, the easiest first.
fn proposals(bench: &Bench, parameter: Parameter) -> Vec<Proposal> {
    let current = bench.current();
    let Some((at, omega_e)) = bench.held.iter().copied().max_by(|(one, _), (other, _)| one.magnitude().total_cmp(&other.magnitude()))
    else {
        return Vec::new();
    };
    let unused = |id: f64| bench.held.iter().all(|(i, _)| (i.d - id).abs() > SAME * current);
    let steps = [-STEP * current, 0.0, -2.0 * STEP * current].into_iter().filter(|id| unused(*id));
    let mut proposals: Vec<Proposal> = steps.map(|id| Proposal::Hold { i: Dq { d: id, q: at.q }, omega_e, place: Place::Id(id) }).collect();
    let half = Dq { d: at.d, q: 0.5 * at.q };
    proposals.push(Proposal::Hold { i: half, omega_e, place: Place::HalfLoad { iq: half.q } });
    proposals.push(Proposal::Hold { i: at, omega_e: 0.5 * omega_e, place: Place::HalfSpeed });
    proposals.push(Proposal::AllPoints);
    // The last resort for R_s itself; for what hides behind it the easiest way.
    if parameter == Parameter::Rs {
        proposals.push(Proposal::Multimeter);
    } else {
        proposals.insert(0, Proposal::Multimeter);
    }
    proposals
}

/// A covariance after one more equation with this variance.
fn shrunk(covariance: Matrix4<f64>, equation: &Vector4<f64>, variance: f64) -> Matrix4<f64> {
    let gain = covariance * equation;
    let total = equation.dot(&gain) + variance;
    if total > 0.0 { covariance - gain * gain.transpose() / total } else { covariance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::Motor;

    const MOTOR: Motor = Motor { rs: 1.0, ld: 5e-3, lq: 10e-3, psi_f: 0.2 };

    fn bench(covariance: Matrix4<f64>, iq: f64, row_variance: f64, voltage_accuracy: f64) -> Bench {
        let held = vec![(Dq { d: 0.0, q: iq }, 400.0)];
        Bench { motor: MOTOR, covariance, held, row_variance, sample_period: 1e-4, voltage: 80.0, voltage_accuracy, is_at_rest: false }
    }

    /// L_d wholly unknown, the rest exact: one stretch at i_d = -2 A tells it by u_q = .. + omega L_d i_d, so its error is that of u_q
    /// over omega i_d. By hand: 0.01 s are 100 rows of 1 V²: 0.1 V; over 400 rad/s times 2 A: 125 uH; 1.96 times that of 5 mH: 4.9 %. A
    /// multimeter leaves it as unknown as it is.
    #[test]
    fn the_estimate_is_what_the_equations_say() {
        let bench = bench(Matrix4::from_diagonal(&Vector4::new(0.0, 1.0, 0.0, 0.0)), 10.0, 1.0, 0.0);
        let promising = promising(&bench, (0.0, 0.01), 0.0, Parameter::Ld);
        assert_eq!(promising[0].measurement, Measurement::Stretch { seconds: 0.01, place: Place::Id(-2.0), omega_e: None });
        assert!((promising[0].half_width - 0.049).abs() < 0.0005, "{promising:?}");
        assert_eq!(promising[0].to_string(), "add 0.01 s at i_d = -2 A, same speed: L_d to about ±4.9 %");
        let multimeter = promising.iter().find(|one| matches!(one.measurement, Measurement::Resistance { .. })).unwrap();
        assert!(multimeter.half_width > 1.0, "{promising:?}");
        // A stretch must not be so long that it makes the log's own operating points look like pauses.
        let lasts = |one: &Promised| matches!(one.measurement, Measurement::Stretch { seconds, .. } if seconds > 0.01);
        assert!(!promising.iter().any(lasts), "{promising:?}");
    }

    #[test]
    fn a_multimeter_tells_the_flux_that_hides_behind_the_resistance() {
        // One point at i_d = 0: R_s 8 A + 400 rad/s psi_f is known, neither of them is.
        let direction = Vector4::new(1.0, 0.0, 0.0, -8.0 / 400.0);
        let bench = bench(direction * direction.transpose(), 8.0, 1e-6, 1e-6);
        let first = promising(&bench, (0.0, 1.0), 0.0, Parameter::PsiF)[0];
        assert_eq!(first.measurement, Measurement::Resistance { accuracy: 0.01 });
        // 1 % of 1 ohm moves psi_f by 8/400 of 10 mohm, 0.2 mWb of 200: 0.1 %, and 1.96 times that.
        assert!((first.half_width - 0.00196).abs() < 1e-5, "{first:?}");
    }
}

//! What to measure next, and what it would bring: computed, not a phrase.
//!
//! A stretch held at some currents and speed adds two steady equations, each with the noise of so many rows and the accuracy of the
//! voltages there; a multimeter adds one for R_s. Each shrinks the covariance of what is known by
//!
//! ```text
//! C - C a a' C / (a' C a + variance)
//! ```
//!
//! (R. E. Kalman, "A new approach to linear filtering and prediction problems", J. Basic Eng. 82 (1960) 35, doi:10.1115/1.3662552).
//! The first proposal, in the order of how easy they are at the bench, that would make the parameter identified is the advice; else
//! the best.

use super::verdict::{IDENTIFIED, WEAK};
use crate::{
    frames::Dq,
    motor::{Motor, PARAMETERS, Parameter},
};
use nalgebra::{Matrix4, Vector4};

/// What is known, and where the bench stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Advice {
    /// The motor; what is not known is NaN, and nothing is promised of it.
    pub(super) motor: Motor,
    /// Covariance of its parameters, SI: noise, the voltages' accuracy, and what is not excited.
    pub(super) covariance: Matrix4<f64>,
    /// Currents, A, and speed, electrical rad/s, at which the log was held.
    pub(super) held: Vec<(Dq, f64)>,
    /// Variance that the mean of a stretch's voltage would have if it were one row long, V², noise of the currents included.
    pub(super) row_variance: f64,
    /// s.
    pub(super) sample_period: f64,
    /// Largest voltage of the log, V.
    pub(super) voltage: f64,
    /// Systematic uncertainty of the voltages, as a fraction.
    pub(super) voltage_accuracy: f64,
}

/// Share of the current that a step of i_d should have: the paper's -2 A of 10 A.
const STEP: f64 = 0.2;

/// Lengths that a bench holds without anybody waiting, s.
const LENGTHS: [f64; 5] = [0.2, 0.5, 1.0, 2.0, 5.0];

/// Fewest rows of a stretch that is to be found as one.
const MIN_ROWS: f64 = 50.0;

/// What a good multimeter and a warm winding leave of R_s.
const MULTIMETER: f64 = 0.01;

/// Half a 95 % interval in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Currents or speeds closer than this fraction of the largest are the same.
const SAME: f64 = 0.05;

/// Something to measure.
enum Proposal {
    /// Hold these currents at this speed.
    Hold { i: Dq, omega_e: f64, words: String },
    /// Measure R_s at the terminals.
    Multimeter,
}

impl Advice {
    /// The motor, with a guess for what is not known: the other inductance, which no motor has more than a few times as large.
    pub(super) fn guessed(motor: Motor, is_known: impl Fn(Parameter) -> bool) -> Motor {
        let value = |parameter| Some(motor.get(parameter)).filter(|value| *value > 0.0 && is_known(parameter));
        let (ld, lq) = (value(Parameter::Ld), value(Parameter::Lq));
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        Motor { rs: or_nan(value(Parameter::Rs)), ld: or_nan(ld.or(lq)), lq: or_nan(lq.or(ld)), psi_f: or_nan(value(Parameter::PsiF)) }
    }

    /// What to do for a parameter, and what it would bring; nothing, where nothing proposed would help.
    pub(super) fn remedy(&self, parameter: Parameter) -> Option<String> {
        let best = self
            .proposals(parameter)
            .iter()
            .flat_map(|proposal| self.outcomes(proposal, parameter))
            .filter(|(width, _)| width.is_finite())
            .fold(None, |best: Option<(f64, String)>, one| match best {
                // An easier one that suffices stands; of those that do not, the better.
                Some(best) if best.0 <= IDENTIFIED || best.0 <= one.0 => Some(best),
                _ => Some(one),
            });
        let (width, words) = best?;
        // What leaves more than half of what there is now, or no value at all, is no advice.
        (width < (0.5 * self.width(&self.covariance, parameter)).min(WEAK))
            .then(|| format!("{words}: {} to about ±{}", parameter.symbol(), percent(width)))
    }

    /// Largest current held, A.
    fn current(&self) -> f64 {
        self.held.iter().map(|(i, _)| i.magnitude()).fold(0.0, f64::max)
    }

    /// Relative half-width of a parameter's interval.
    fn width(&self, covariance: &Matrix4<f64>, parameter: Parameter) -> f64 {
        let p = parameter as usize;
        HALF_WIDTH * covariance[(p, p)].max(0.0).sqrt() / self.motor.get(parameter).abs()
    }

    /// What a proposal makes of a parameter's interval, longer and longer, with the words for it.
    fn outcomes(&self, proposal: &Proposal, parameter: Parameter) -> Vec<(f64, String)> {
        match proposal {
            Proposal::Multimeter => {
                let equation = Vector4::new(1.0, 0.0, 0.0, 0.0);
                let after = shrunk(
                    self.covariance,
                    &equation,
                    (MULTIMETER * if self.motor.rs.is_nan() { self.voltage / self.current() } else { self.motor.rs }).powi(2),
                );
                vec![(self.width(&after, parameter), "measure R_s at the terminals to 1 % and give it with --prior rs=VALUE±1%".to_owned())]
            }
            Proposal::Hold { i, omega_e, words } => {
                let lengths = LENGTHS.into_iter().filter(|length| length / self.sample_period >= MIN_ROWS);
                lengths
                    .map(|length| (self.width(&self.after_hold(*i, *omega_e, length), parameter), format!("add {length} s {words}")))
                    .collect()
            }
        }
    }

    fn after_hold(&self, i: Dq, omega_e: f64, length: f64) -> Matrix4<f64> {
        let accuracy = self.voltage_accuracy * self.voltage;
        let variance = self.row_variance * self.sample_period / length + accuracy * accuracy;
        let d = Vector4::new(i.d, 0.0, -omega_e * i.q, 0.0);
        let q = Vector4::new(i.q, omega_e * i.d, 0.0, omega_e);
        shrunk(shrunk(self.covariance, &d, variance), &q, variance)
    }

    /// What could be measured, the easiest first.
    fn proposals(&self, parameter: Parameter) -> Vec<Proposal> {
        let current = self.current();
        let Some((at, omega_e)) = self.held.iter().copied().max_by(|(one, _), (other, _)| one.magnitude().total_cmp(&other.magnitude()))
        else {
            return Vec::new();
        };
        let unused = |id: f64| self.held.iter().all(|(i, _)| (i.d - id).abs() > SAME * current);
        let hold = |i: Dq, omega_e: f64, words: String| Proposal::Hold { i, omega_e, words };
        let mut proposals = Vec::new();
        for id in [-STEP * current, 0.0, -2.0 * STEP * current] {
            if unused(id) {
                let i = Dq { d: id, q: at.q };
                let words =
                    if id == 0.0 { "at i_d = 0, same speed".to_owned() } else { format!("at i_d = {} A, same speed", one_digit(id)) };
                proposals.push(hold(i, omega_e, words));
            }
        }
        let half = Dq { d: at.d, q: 0.5 * at.q };
        proposals.push(hold(half, omega_e, format!("at half the load (i_q = {} A), same speed", one_digit(half.q))));
        proposals.push(hold(at, 0.5 * omega_e, "at the same currents and half the speed".to_owned()));
        // The last resort for R_s itself; for what hides behind it the easiest way.
        if parameter == Parameter::Rs {
            proposals.push(Proposal::Multimeter)
        } else {
            proposals.insert(0, Proposal::Multimeter)
        }
        proposals
    }
}

/// A covariance after one more equation with this variance.
fn shrunk(covariance: Matrix4<f64>, equation: &Vector4<f64>, variance: f64) -> Matrix4<f64> {
    let gain = covariance * equation;
    let total = equation.dot(&gain) + variance;
    if total > 0.0 { covariance - gain * gain.transpose() / total } else { covariance }
}

/// The covariance of standard errors and correlations.
pub(super) fn covariance(standard_errors: [f64; PARAMETERS], correlation: &[[f64; PARAMETERS]; PARAMETERS]) -> Matrix4<f64> {
    Matrix4::from_fn(|p, q| if p == q { standard_errors[p].powi(2) } else { correlation[p][q] * standard_errors[p] * standard_errors[q] })
}

/// A number with one significant digit, and no exponent.
pub(super) fn one_digit(x: f64) -> String {
    let exponent = if x == 0.0 || !x.is_finite() { 0 } else { x.abs().log10().floor() as i32 };
    let unit = 10.0_f64.powi(exponent);
    format!("{:.*}", exponent.saturating_neg().clamp(0, 12) as usize, (x / unit).round() * unit)
}

/// A fraction in percent, with two digits.
fn percent(fraction: f64) -> String {
    let value = 100.0 * fraction;
    // From 0.1 to 50 in practice; a number beyond that has no digits worth showing.
    let decimals = if value > 0.0 { (1.0 - value.log10().floor()).clamp(0.0, 4.0) as usize } else { 0 };
    format!("{value:.decimals$} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Motor = Motor { rs: 1.0, ld: 5e-3, lq: 10e-3, psi_f: 0.2 };

    /// L_d wholly unknown, the rest exact: one stretch at i_d = -2 A tells it by u_q = .. + omega L_d i_d, so its error is that of u_q
    /// over omega i_d. By hand: 0.2 s are 2000 rows of 1 V²: 22.4 mV; over 400 rad/s times 2 A: 28 uH; twice that of 5 mH: 1.1 %.
    #[test]
    fn the_promise_is_what_the_equations_say() {
        let covariance = Matrix4::from_diagonal(&Vector4::new(0.0, 1.0, 0.0, 0.0));
        let held = vec![(Dq { d: 0.0, q: 10.0 }, 400.0)];
        let advice =
            Advice { motor: MOTOR, covariance, held, row_variance: 1.0, sample_period: 1e-4, voltage: 80.0, voltage_accuracy: 0.0 };
        assert_eq!(advice.remedy(Parameter::Ld).unwrap(), "add 0.2 s at i_d = -2 A, same speed: L_d to about ±1.1 %");
        // Nothing is to be gained for what is known.
        assert_eq!(advice.remedy(Parameter::Lq), None);
    }

    #[test]
    fn a_multimeter_tells_the_flux_that_hides_behind_the_resistance() {
        // One point at i_d = 0: R_s 8 A + 400 rad/s psi_f is known, neither of them is.
        let direction = Vector4::new(1.0, 0.0, 0.0, -8.0 / 400.0);
        let held = vec![(Dq { d: 0.0, q: 8.0 }, 400.0)];
        let covariance = direction * direction.transpose();
        let advice =
            Advice { motor: MOTOR, covariance, held, row_variance: 1e-6, sample_period: 1e-4, voltage: 80.0, voltage_accuracy: 1e-6 };
        // 1 % of 1 ohm moves psi_f by 8/400 of 10 mohm, 0.2 mWb of 200: 0.1 %, and 1.96 times that.
        assert_eq!(
            advice.remedy(Parameter::PsiF).unwrap(),
            "measure R_s at the terminals to 1 % and give it with --prior rs=VALUE±1%: psi_f to about ±0.20 %"
        );
    }

    #[test]
    fn one_digit_is_enough_for_advice() {
        assert_eq!(one_digit(-1.9774), "-2");
        assert_eq!(one_digit(-29.9), "-30");
        assert_eq!(one_digit(0.000_87), "0.0009");
        assert_eq!(one_digit(0.0), "0");
    }
}

//! A finding: what a fit found, whichever model made it, as judgement and explanation need it.

use super::uncertainty::{NORMAL, ParameterUncertainty, Systematic, Uncertainty};
use crate::{
    faults::Fault,
    frames::Dq,
    motor::{Motor, PARAMETERS, Parameter},
};
use nalgebra::Matrix4;

/// The motor of a fit, its uncertainty, and what else bears on its verdicts.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// The motor found.
    pub motor: Motor,
    /// Its uncertainty, as if inductances and flux did not depend on the current.
    pub uncertainty: Uncertainty,
    /// Per parameter, whether the operating points leave it open.
    pub open: [bool; PARAMETERS],
    /// What speaks against the fit as a whole.
    pub trust: Trust,
    /// What is known, and at which currents and speeds.
    pub(crate) bench: Bench,
}

impl Finding {
    /// Marks what the fit leaves open: such a parameter lies anywhere within its reach, SI.
    pub(crate) fn leave_open(&mut self, open: &[bool; PARAMETERS], reach: &[f64; PARAMETERS]) {
        for p in (0..PARAMETERS).filter(|p| open[*p]) {
            self.open[p] = true;
            let uncertainty = &mut self.uncertainty.parameters[p];
            uncertainty.systematic.excitation = uncertainty.systematic.excitation.max(reach[p] / 3.0_f64.sqrt());
            *uncertainty = uncertainty.anew();
        }
    }

    /// Makes this R_s, ohm, the answer, with its standard uncertainty.
    pub(crate) fn answer_rs(&mut self, rs: f64, standard_error: f64) {
        self.motor.rs = rs;
        self.open[Parameter::Rs as usize] = false;
        self.uncertainty.parameters[Parameter::Rs as usize] = ParameterUncertainty::of(standard_error, NORMAL, Systematic::default());
    }
}

/// What speaks against a fit, whatever its intervals say: of simulated currents all but the last, of operating points the last alone, whose
/// contradictions are part of the uncertainty. The default is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Trust {
    /// Correlation of neighbouring residuals; zero where the residuals are too small to mean anything.
    pub correlation_of_neighbours: f64,
    /// Whether the intervals are sharper than noise allows: then the slopes behind them mean nothing.
    pub too_sharp: bool,
    /// Root mean square of what a simulation without any correction misses, as a fraction of the largest current.
    pub misses: f64,
    /// A fault of the drive that was found with values that no drive has: it took the place of something else, with the motor beside it.
    pub runaway: Option<Fault>,
    /// By which factors the speed may be too high, the least and the largest, where simulated currents do not follow the measured ones and
    /// the slopes of the currents ask for another speed.
    pub speed_too_high: Option<[f64; 2]>,
    /// An inductance below this, H, does nothing from row to row that a simulation could follow.
    pub least_inductance: f64,
    /// Whether a recorder repeats values: those of one row are of different instants, which alone makes operating points contradict each
    /// other.
    pub repeated_values: bool,
}

impl Trust {
    /// Whether nothing of the fit is an answer.
    pub(crate) fn is_none(&self) -> bool {
        self.too_sharp || self.runaway.is_some() || self.speed_too_high.is_some()
    }
}

/// What is known from noise, accuracy and excitation, and where the motor was held: what a further measurement would add to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bench {
    /// The motor; what is not known is NaN, and nothing is promised of it.
    pub(crate) motor: Motor,
    /// Covariance of its parameters, SI: noise, the voltages' accuracy, and what is not excited.
    pub(crate) covariance: Matrix4<f64>,
    /// Currents, A, and speed, electrical rad/s, at which the log was held.
    pub(crate) held: Vec<(Dq, f64)>,
    /// Variance that the mean of a stretch's voltage would have if it were one row long, V², noise of the currents included.
    pub(crate) row_variance: f64,
    /// s.
    pub(crate) sample_period: f64,
    /// Largest voltage of the log, V.
    pub(crate) voltage: f64,
    /// Systematic uncertainty of the voltages, as a fraction.
    pub(crate) voltage_accuracy: f64,
    /// Whether the rotor stands throughout.
    pub(crate) is_at_rest: bool,
}

impl Bench {
    /// The motor, with the other inductance for one that is not known: they seldom differ by more than a few times.
    pub(crate) fn guess(motor: Motor, is_known: impl Fn(Parameter) -> bool) -> Motor {
        let value = |parameter| Some(motor.get(parameter)).filter(|value| *value > 0.0 && is_known(parameter));
        let (ld, lq) = (value(Parameter::Ld), value(Parameter::Lq));
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        Motor { rs: or_nan(value(Parameter::Rs)), ld: or_nan(ld.or(lq)), lq: or_nan(lq.or(ld)), psi_f: or_nan(value(Parameter::PsiF)) }
    }

    /// Largest current held, A.
    pub(crate) fn current(&self) -> f64 {
        self.held.iter().map(|(i, _)| i.magnitude()).fold(0.0, f64::max)
    }
}

/// The covariance of standard errors and correlations.
pub(crate) fn covariance(standard_errors: [f64; PARAMETERS], correlation: &[[f64; PARAMETERS]; PARAMETERS]) -> Matrix4<f64> {
    Matrix4::from_fn(|p, q| if p == q { standard_errors[p].powi(2) } else { correlation[p][q] * standard_errors[p] * standard_errors[q] })
}

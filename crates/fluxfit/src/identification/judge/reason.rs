//! Reasons: why a parameter is not identified, as facts. A parameter that the log leaves open gets the reason why it is open; any
//! other the largest part of its interval.

use super::super::fit::{
    finding::{Bench, Finding},
    part::Part,
    uncertainty::ParameterUncertainty,
};
use crate::{
    faults::Fault,
    frames::Dq,
    motor::{PARAMETERS, Parameter},
};

/// Why a verdict is not better, or that the value was given. It prints as a sentence; as `{:#}` without the width of an interval, which
/// parameters that share a reason need not share.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The value was given, not identified.
    Given,
    /// The current i_d stays at zero, so L_d is absent from the equations.
    IdZero {
        /// Largest magnitude of i_d, A.
        largest: f64,
    },
    /// The rotor stands throughout, where psi_f induces nothing.
    AtRest,
    /// The rotor stands throughout, where an inductance shows in changes of its current alone, and there are none to speak of.
    NoStep {
        /// Which inductance.
        parameter: Parameter,
    },
    /// There is one speed and one load at i_d = 0, where R_s i_q and omega_e psi_f act alike.
    OnePoint,
    /// The current i_d is the same at every operating point, where L_d i_d and psi_f act alike.
    IdConstant,
    /// The operating points are too similar for their noise: only combinations of these parameters show in them.
    TooSimilar {
        /// The parameters that are open.
        open: Vec<Parameter>,
    },
    /// The voltages are zero throughout, and no parameter is fixed: a short circuit shows only the ratios of the parameters.
    ShortCircuit,
    /// The value came out negative, by more than its uncertainty: signs or order of the columns are probably wrong.
    Negative,
    /// Another parameter of the same fit came out as no motor has it: negative by more than its uncertainty, or below what rows can tell.
    OtherImpossible {
        /// Which.
        parameter: Parameter,
    },
    /// The 95 % interval is wide.
    Wide {
        /// The largest contribution to it.
        part: Part,
        /// What is most of it together with the largest; nothing where that is most of it alone.
        beside: Vec<Part>,
        /// Half the interval as a fraction of the value: 0.2 is ±20 %; it may exceed 1 or be infinite.
        half_width: f64,
    },
    /// An inductance came out so small that nothing of it could be seen from row to row.
    BelowRows {
        /// The least that rows so far apart could tell, H.
        least: f64,
    },
    /// The fit looks sharper than the noise of the currents allows.
    SharperThanNoise,
    /// A fault of the drive came out as no drive has it, so the motor beside it is no answer either.
    RunawayFault {
        /// Which.
        fault: Fault,
    },
    /// The simulated currents do not follow the measured ones, and the slopes of the currents ask for another speed: the unit of the speed
    /// or the number of pole pairs is wrong.
    SpeedInDoubt {
        /// By which factors the speed may be too high, the least and the largest.
        too_high: [f64; 2],
    },
    /// The interval is narrow, but it follows a prior that the log contradicts.
    PriorContradicted {
        /// Whose prior.
        parameter: Parameter,
    },
    /// The interval is narrow, but the motor saturates, and a fit describes that by a few terms.
    Saturates,
    /// The simulated currents differ from the measured ones by far more than noise: voltages and currents do not belong together.
    CurrentsMissed {
        /// Root mean square of the difference, as a fraction of the largest current.
        fraction: f64,
    },
}

impl Reason {
    /// Whether parameters with these reasons can be told in one sentence, as `{:#}`: their intervals are wide by the same cause.
    pub fn is_told_with(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Wide { part, beside, .. }, Self::Wide { part: other, beside: others, .. }) => part == other && beside == others,
            _ => self == other,
        }
    }
}

/// Means closer than this, as a fraction of the largest current or speed, are the same for a reason.
pub(crate) const SAME: f64 = 0.05;

/// Why a number that did not come out as identified is no better.
pub(super) fn of(parameter: Parameter, finding: &Finding, uncertainty: &ParameterUncertainty, weak: f64) -> Reason {
    let raw = finding.motor.get(parameter);
    let half_width = if raw == 0.0 { f64::INFINITY } else { uncertainty.half_width / raw.abs() };
    if parameter == Parameter::PsiF && finding.bench.is_at_rest {
        Reason::AtRest
    } else if finding.open[parameter as usize] {
        open(parameter, &finding.bench, &finding.open)
    } else if raw <= 0.0 && half_width < weak {
        Reason::Negative
    } else {
        let part = uncertainty.largest_part();
        let beside = uncertainty.main_parts().into_iter().filter(|other| *other != part).collect();
        Reason::Wide { part, beside, half_width }
    }
}

/// Why the log leaves a parameter open: what its operating points have in common.
fn open(parameter: Parameter, bench: &Bench, open: &[bool; PARAMETERS]) -> Reason {
    let (current, held) = (bench.current(), Common::of(bench));
    match parameter {
        Parameter::Ld | Parameter::Lq if bench.is_at_rest => Reason::NoStep { parameter },
        Parameter::Ld if held.id_is_zero(current) => Reason::IdZero { largest: held.id_most },
        Parameter::Rs | Parameter::PsiF if held.id_is_zero(current) && held.is_one_point(current) => Reason::OnePoint,
        Parameter::Ld | Parameter::PsiF if held.id_is_constant(current) && !open[Parameter::Rs as usize] => Reason::IdConstant,
        _ => Reason::TooSimilar { open: Parameter::ALL.into_iter().filter(|other| open[*other as usize]).collect() },
    }
}

/// What operating points have in common.
pub(crate) struct Common {
    /// Largest magnitude of i_d, A.
    id_most: f64,
    /// Range of each current, A, and of the speed, rad/s.
    id_range: f64,
    iq_range: f64,
    omega_range: f64,
    /// Largest speed, rad/s.
    speed: f64,
}

impl Common {
    pub(crate) fn of(bench: &Bench) -> Self {
        let range = |value: fn(&(Dq, f64)) -> f64| {
            let values = || bench.held.iter().map(value);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        Self {
            id_most: bench.held.iter().map(|(i, _)| i.d.abs()).fold(0.0, f64::max),
            id_range: range(|(i, _)| i.d),
            iq_range: range(|(i, _)| i.q),
            omega_range: range(|(_, omega_e)| *omega_e),
            speed: bench.held.iter().map(|(_, omega_e)| omega_e.abs()).fold(0.0, f64::max),
        }
    }

    /// The highest speed, rad/s.
    pub(crate) fn speed(&self) -> f64 {
        self.speed
    }

    /// Whether i_d is zero everywhere, given the largest current, A.
    pub(crate) fn id_is_zero(&self, current: f64) -> bool {
        self.id_most <= SAME * current
    }

    fn id_is_constant(&self, current: f64) -> bool {
        self.id_range <= SAME * current
    }

    fn is_one_point(&self, current: f64) -> bool {
        self.id_is_constant(current) && self.iq_range <= SAME * current && self.omega_range <= SAME * self.speed
    }
}

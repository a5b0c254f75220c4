//! Why tables do not tell a number of the motor, or only roughly.

use super::rows::{Residual, Rows};
use crate::motor::Parameter;

/// Why a number has no value, or a weak one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Lack {
    /// No table depends on it.
    Absent {
        /// Which number.
        parameter: Parameter,
    },
    /// It is told times the pole pairs alone, or the other way round, and these are not known.
    PolePairs,
    /// Nothing tells between which points the open-circuit voltages were measured.
    Voltages,
    /// All direct currents are of this size, A: the resistance and what contacts drop whatever the current is act alike.
    OneDirectCurrent {
        /// Their mean.
        current: f64,
    },
    /// All i_q of the torques are of this size, A: the flux and what the bench takes whatever the current is act alike.
    OneTorqueCurrent {
        /// Their mean.
        current: f64,
    },
    /// The rows scatter around the model, and that leaves a wide interval.
    Scatter {
        /// Half of the interval over the value.
        half_width: f64,
        /// What scatters.
        test: Residual,
        /// Whether there is no open-circuit table, which would tell the flux and with it the rest.
        without_open: bool,
    },
    /// It hangs on a few rows: without them it is another number.
    FewRows {
        /// Half of the interval over the value.
        half_width: f64,
        /// What these rows hold.
        test: Residual,
        /// Whether there is no open-circuit table.
        without_open: bool,
    },
    /// A motor with another value, or another drag of the bench, fits about as well.
    Alternatives {
        /// Half of the interval over the value.
        half_width: f64,
    },
}

/// Currents that differ by less than this part of the largest are one: a supply does not hold its current better.
const ONE_CURRENT: f64 = 0.1;

/// The parts of an interval, as standard errors.
pub(super) struct Parts {
    /// By the covariance, of what is left in the rows.
    pub(super) scatter: f64,
    /// By the jackknife.
    pub(super) few_rows: f64,
    /// By other fits that are about as good.
    pub(super) alternatives: f64,
}

impl Lack {
    /// Of a number that tables of one current alone would tell: what a meter's noise makes of such rows is no value, however well it fits.
    pub(super) fn of_one_current(parameter: Parameter, rows: &Rows) -> Option<Self> {
        // Other tables tell it too.
        let sizes = || rows.points.iter().map(|point| point.current.magnitude());
        let by_points = !rows.points.is_empty() && (parameter == Parameter::PsiF || one_size(sizes()).is_none());
        if !rows.shorted.is_empty() || !rows.duty.is_empty() || by_points || parameter == Parameter::PsiF && !rows.open.is_empty() {
            return None;
        }
        match parameter {
            Parameter::Rs => one_size(rows.direct.iter().map(|row| row.current)).map(|current| Self::OneDirectCurrent { current }),
            Parameter::PsiF => one_size(rows.torque.iter().map(|row| row.current.q)).map(|current| Self::OneTorqueCurrent { current }),
            Parameter::Ld | Parameter::Lq => None,
        }
    }

    /// Of a number that the tables depend on and whose interval is too wide.
    pub(super) fn of_wide(parameter: Parameter, rows: &Rows, half_width: f64, parts: &Parts) -> Self {
        let (test, without_open) = (telling(parameter, rows), rows.open.is_empty());
        if parts.alternatives > parts.scatter.max(parts.few_rows) {
            Self::Alternatives { half_width }
        } else if parts.few_rows > parts.scatter {
            Self::FewRows { half_width, test, without_open }
        } else {
            Self::Scatter { half_width, test, without_open }
        }
    }
}

/// What tells a number most directly.
fn telling(parameter: Parameter, rows: &Rows) -> Residual {
    match parameter {
        Parameter::Rs if !rows.direct.is_empty() => Residual::DirectVoltage,
        Parameter::PsiF if !rows.open.is_empty() => Residual::OpenVoltage,
        _ if !rows.shorted.is_empty() => Residual::ShortCurrent,
        _ if !rows.points.is_empty() => Residual::PointVoltage,
        Parameter::PsiF if !rows.torque.is_empty() => Residual::Torque,
        _ => Residual::DutyVoltage,
    }
}

/// The mean size of some currents that are all of one size.
fn one_size(currents: impl Iterator<Item = f64>) -> Option<f64> {
    let sizes: Vec<f64> = currents.map(f64::abs).collect();
    let (least, most) = sizes.iter().fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), size| (least.min(*size), most.max(*size)));
    (!sizes.is_empty() && most - least < ONE_CURRENT * most).then(|| sizes.iter().sum::<f64>() / sizes.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Also where one direction and the other are of one size: what contacts drop turns with the current.
    #[test]
    fn one_current_is_one_size_of_it() {
        assert_eq!(one_size([10.0, -10.0, 10.1].into_iter()).map(f64::round), Some(10.0));
        assert_eq!(one_size([5.0, 10.0].into_iter()), None);
    }
}

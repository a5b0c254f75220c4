//! Why tables of a test bench do not tell a number, and what would.

use super::digits::{percent, three_digits};
use crate::{
    characteristics::{Lack, Residual},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

impl Display for Lack {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Absent { .. } => write!(f, "absent from the equations of these tables"),
            Self::PolePairs => write!(f, "the pole pairs are not known"),
            Self::Voltages => write!(f, "nothing tells whether the voltages are line to line or of a phase"),
            Self::OneDirectCurrent { current } => write!(
                f,
                "all currents are about {} A, where the resistance and a constant voltage (contacts, the zero of the meter) act alike",
                three_digits(*current)
            ),
            Self::OneTorqueCurrent { current } => write!(
                f,
                "all i_q are about {} A, where the flux and a constant torque (drag, the zero of the sensor) act alike",
                three_digits(*current)
            ),
            Self::Scatter { half_width, test, .. } => {
                write!(f, "the {} scatter around those of any motor, which leaves {}", test.label(), width(*half_width))
            }
            Self::FewRows { half_width, test, .. } => {
                write!(f, "it hangs on a few rows of the {}: what it is without them leaves {}", test.label(), width(*half_width))
            }
            Self::Alternatives { half_width } => {
                write!(f, "motors with other values of it, or other drag, fit about as well, which leaves {}", width(*half_width))
            }
        }
    }
}

impl Lack {
    /// What to do, without a capital and a full stop.
    pub fn remedy(&self) -> String {
        match self {
            Self::Absent { parameter: Parameter::Rs } => {
                "add a table of voltage against direct current, or a short-circuit table, of the same motor".to_owned()
            }
            Self::Absent { parameter: Parameter::PsiF } => {
                "add an open-circuit table, or a short-circuit table, of the same motor".to_owned()
            }
            Self::Absent { .. } => "add a short-circuit table of the same motor, or operating points with i_d".to_owned(),
            Self::PolePairs => "state the pole pairs".to_owned(),
            Self::Voltages => "put 'll' or 'phase' into the name of the voltage's column".to_owned(),
            Self::OneDirectCurrent { current } => format!("measure at a second current too, such as {} A", three_digits(current / 2.0)),
            Self::OneTorqueCurrent { current } => format!("measure at a second i_q too, such as {} A", three_digits(current / 2.0)),
            Self::Scatter { test: Residual::ShortCurrent, without_open: true, .. }
            | Self::FewRows { test: Residual::ShortCurrent, without_open: true, .. } => {
                format!("add the open-circuit table of the same motor, or {}", more(Residual::ShortCurrent))
            }
            Self::Scatter { test, .. } | Self::FewRows { test, .. } => more(*test).to_owned(),
            Self::Alternatives { .. } => more(Residual::ShortCurrent).to_owned(),
        }
    }
}

/// What to measure where these rows do not tell enough.
fn more(test: Residual) -> &'static str {
    match test {
        Residual::OpenVoltage => "measure at more speeds, and at faster ones",
        Residual::ShortCurrent | Residual::ShortTorque => "measure at more speeds, from slow to fast",
        Residual::Torque | Residual::DirectVoltage => {
            "measure at more currents and at larger ones, and take the mean of several readings at each"
        }
        Residual::DutyVoltage => "log more speeds and loads, with the current of the motor",
        Residual::PointVoltage => "measure at more speeds and at currents of other sizes, with i_d and without",
    }
}

fn width(half_width: f64) -> String {
    if half_width < 10.0 { format!("±{}", percent(half_width)) } else { "more than the value itself".to_owned() }
}

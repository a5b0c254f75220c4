//! Why a parameter is not identified.

use super::digits::{list, one_digit, percent, three_digits};
use crate::{
    column_check::ColumnFinding,
    identification::{fit::part::Part, judge::reason::Reason},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

impl Display for Reason {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Given => write!(f, "given, not identified"),
            Self::IdZero { largest } => write!(
                f,
                "i_d stays at zero (at most {} A, no more than its noise and accuracy), so L_d is absent from the equations",
                one_digit(*largest)
            ),
            Self::AtRest => write!(f, "the rotor stands throughout, and psi_f shows only where it turns"),
            Self::NoStep { parameter } => {
                let axis = if *parameter == Parameter::Ld { 'd' } else { 'q' };
                write!(f, "at rest it shows only in changes of i_{axis}, and there are none to speak of")
            }
            Self::OnePoint => write!(f, "there is one speed and one load, where R_s i_q and omega_e psi_f act alike"),
            Self::IdConstant => write!(f, "i_d is the same at every operating point, where L_d i_d and psi_f act alike"),
            Self::TooSimilar { open } => {
                let open: Vec<&str> = open.iter().copied().map(Parameter::symbol).collect();
                let open = open.join(", ");
                write!(f, "the operating points are too similar for their noise: only combinations of {open} show in them")
            }
            Self::ShortCircuit => {
                write!(f, "the voltages are zero in every row, and the currents of a short circuit show only ratios of the parameters")
            }
            Self::Negative => write!(f, "the value came out negative, which no motor has, and not by noise"),
            Self::OtherImpossible { parameter } => {
                write!(f, "{} came out as no motor has it, so nothing else of this fit is to be trusted", parameter.symbol())
            }
            Self::Wide { part, beside, half_width } => wide(*part, beside, *half_width, f),
            Self::BelowRows { least } => write!(
                f,
                "it came out below {} uH, with which the current would settle within half a row: something else, such as a filter or \
                 the angle, has taken its place in the fit",
                three_digits(1e6 * least)
            ),
            Self::SharperThanNoise => write!(
                f,
                "the simulated currents jump at the least change of what was fitted, as those of a phase that switches around zero do, so the \
                 fit looks sharper than its noise allows, and nothing of it is to be trusted"
            ),
            Self::PriorContradicted { parameter } => {
                let symbol = parameter.symbol();
                write!(f, "the log contradicts the prior of {symbol}: the number is a compromise between the two, or follows from one")
            }
            Self::Saturates => {
                write!(f, "the motor saturates, and the fitted saturation is only approximate: take the number as an estimate")
            }
            Self::RunawayFault { fault } => write!(
                f,
                "the fault that was found beside the motor, {}, came out with values that no drive has: it took the place of something else, \
                 and nothing of this fit is to be trusted",
                fault.label()
            ),
            Self::SpeedInDoubt { too_high: [low, high] } => write!(
                f,
                "{}, and the simulated currents do not follow the measured ones: its unit or the number of pole pairs seems to be wrong, and \
                 inductances and flux are wrong by the same factor",
                ColumnFinding::SpeedScale { low: *low, high: *high, angle: false }
            ),
            Self::CurrentsMissed { fraction } => write!(
                f,
                "the simulated currents miss the measured ones by {:.0} % of the largest current, and not by noise: no motor makes \
                 these currents of these voltages",
                100.0 * fraction
            ),
        }
    }
}

/// The largest part of an interval, what else is most of it, and how wide it is; in the alternate form (`{:#}`) without that number, for
/// several parameters at once.
fn wide(part: Part, beside: &[Part], half_width: f64, f: &mut Formatter) -> Result {
    let leaves = match half_width {
        _ if f.alternate() => "leaves wide intervals".to_owned(),
        half_width if half_width < 10.0 => format!("leaves ±{}", percent(half_width)),
        _ => "leaves more than the value itself".to_owned(),
    };
    let beside: Vec<&str> = beside.iter().map(|part| part.label()).collect();
    let leaves = if beside.is_empty() { leaves } else { format!("{leaves} together with {}", list(&beside)) };
    match part {
        Part::Noise => write!(f, "noise {leaves}"),
        Part::Accuracy => {
            write!(f, "the voltages' accuracy {leaves}: the operating points are too similar for this parameter")
        }
        Part::Timing => write!(f, "the timing of the voltage columns is not known, which {leaves}"),
        Part::DeadTime => write!(f, "how much voltage dead time and device drops take is not known well enough, which {leaves}"),
        Part::FrameLag => write!(
            f,
            "how far the angle is off, and how far apart the instants of voltages and currents are, is not known well enough; either acts \
             like a change of the parameters, which {leaves}"
        ),
        Part::WithinRows => {
            write!(f, "each row spans several of the drive's periods, and what the voltages do between them is not logged, which {leaves}")
        }
        Part::ProcessNoise => {
            write!(
                f,
                "voltages that are not logged disturb the motor, and the fits with and without a model of them differ, which {leaves}"
            )
        }
        Part::FaultsInDoubt => {
            write!(f, "faults of the drive that the log neither proves nor rules out may be there, which {leaves}")
        }
        Part::Sensors => write!(f, "the current sensors differ, and it is not known which of them is right, which {leaves}"),
        Part::CurrentGain => write!(f, "the stated accuracy of the current sensors {leaves}"),
        Part::BusVoltage => write!(f, "the stated accuracy of the DC voltage {leaves}"),
        Part::Saturation => write!(f, "the inductances depend on the current, and one number for all currents of the log {leaves}"),
        Part::Misfit => write!(
            f,
            "the operating points contradict each other beyond their noise, which {leaves}: no motor with constant parameters explains them"
        ),
        Part::Prior => write!(f, "the prior that was given {leaves}"),
        Part::Excitation => write!(f, "what the log does not excite could move it, which {leaves}"),
    }
}

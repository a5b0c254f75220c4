//! What to do about a verdict.

use super::digits::{one_digit, percent, prefix, three_digits};
use crate::{
    frames::Dq,
    identification::{
        explain::{
            measurement::{Measurement, Place, Promised},
            remedy::{Also, Remedy},
        },
        fit::incremental::Incremental,
    },
    motor::Parameter,
};
use std::{
    f64::consts::PI,
    fmt::{Display, Formatter, Result},
};

/// In the alternate form (`{:#}`) without the alternative of holding operating points longer.
impl Display for Remedy {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Measure(promised) => write!(f, "{promised}"),
            Self::AddStretch { id, also } => {
                if *id == 0.0 {
                    write!(f, "add a stretch at the same speed with i_d = 0")?;
                } else {
                    write!(f, "add a stretch at the same speed with i_d near {} A", one_digit(*id))?;
                }
                match also {
                    None => Ok(()),
                    Some(Also::OrSecondPoint) => write!(f, ", or a second speed or load, or give R_s"),
                    Some(Also::OrSecondPointWithResistance) => write!(f, ", or a second speed or load"),
                    Some(Also::AndSecondPoint) => write!(f, ", and one at a clearly different speed and load"),
                }
            }
            Self::HoldLonger { times, parameter, half_width, or } => {
                let (symbol, width) = (parameter.symbol(), percent(*half_width));
                write!(f, "{}: {symbol} to about ±{width}", hold_longer(*times))?;
                if f.alternate() { Ok(()) } else { write!(f, "; or {or}") }
            }
            Self::SpreadPoints { parameter } => write!(f, "{}", spread(*parameter)),
            Self::Turn => write!(f, "log the motor where it turns, too"),
            Self::CheckSpeed => {
                write!(
                    f,
                    "check the unit of the speed and the number of pole pairs; if both are right, state the model, and identify again"
                )
            }
            Self::CheckPrior { parameter } => write!(
                f,
                "check the prior of {} (temperature, cable, line to line or per phase) and the columns, or identify without it",
                parameter.symbol()
            ),
            Self::StepCurrent { parameter: Parameter::Ld } => write!(f, "log larger steps of i_d, and more of them"),
            Self::StepCurrent { .. } => write!(f, "log larger steps of i_q, and more of them"),
            Self::StateVoltageTiming => write!(f, "state the timing of the voltage columns"),
            Self::CompensateDeadTime { or_resistance } => {
                write!(f, "log with the drive's dead-time compensation on")?;
                if *or_resistance {
                    write!(f, ", or give R_s as measured at the terminals (half of what a meter shows between two)")
                } else {
                    Ok(())
                }
            }
            Self::TellFrameLag { omega_e } => write!(
                f,
                "hold two clearly different loads at {}; coasting down from there helps too, if the drive measures its terminal voltages",
                loaded_speed(*omega_e)
            ),
            Self::LogEachPeriod => write!(f, "log each control period of the drive, not every n-th one or means"),
            Self::RemoveDisturbances => write!(
                f,
                "log without torque ripple and supply ripple, or add stretches of constant currents and speed, at two loads, two values of i_d \
                 and two speeds, and identify with the steady model"
            ),
            Self::CalibrateSensors => write!(f, "calibrate the current sensors"),
            Self::CalibrateBusVoltage => write!(f, "calibrate the measurement of the DC voltage"),
            Self::SmallSteps => write!(
                f,
                "take the flux at your currents from the table of fluxes; or, for what a current controller needs, the incremental L_d and \
                 L_q at one current: step i_d, then i_q, by a tenth of the current, hold each step, at two speeds, and identify with the \
                 steady model"
            ),
            Self::TakeIncremental { of_axes } => {
                write!(f, "for a current controller take {}; for the flux at other currents, the table of fluxes", incremental(of_axes))
            }
            Self::SimilarWindows => write!(
                f,
                "identify from three or more windows in time at nearly the same currents, so that the motor saturates alike in them and a \
                 contradiction would still show, and only where the drive switches"
            ),
            Self::HoldThroughRepeats => write!(
                f,
                "hold each operating point for many times as long as the recorder repeats a value, because its rows hold values of different \
                 instants; or log voltages, currents and speed of one instant"
            ),
            Self::SharperPrior => write!(f, "give a sharper prior, or log another operating point"),
            Self::FixOne => write!(
                f,
                "if the terminals were shorted, give one parameter exactly, for example R_s as measured there; else log the voltages"
            ),
            Self::CheckFrame { lag } => write!(
                f,
                "check that voltages and currents are of one instant and one frame: voltages whose frame is late by {} us explain it, and a \
                 wrong sign does not",
                three_digits(1e6 * lag)
            ),
            Self::CheckSigns { units } => write!(
                f,
                "check signs and order of the columns: motor convention (are the currents reversed?), q 90 degrees ahead of d, one sign of \
                 speed and of u_q{}",
                if *units { "; units and pole pairs too" } else { "" }
            ),
        }
    }
}

/// Incremental inductances of both axes: `the incremental L_d = 17.4 ± 0.63 mH at i_d = -9.0 A, i_q = 14 A, and L_q = ..`.
fn incremental(of_axes: &[Incremental; 2]) -> String {
    let one = |one: &Incremental| {
        let (scale, prefix) = prefix(one.inductance);
        let half_width = scale * 2.0 * one.uncertainty;
        let decimals = (1.0 - half_width.log10().floor()).clamp(0.0, 9.0) as usize;
        let Dq { d, q } = one.current;
        format!("{:.decimals$} ± {half_width:.decimals$} {prefix}H at i_d = {d:.1} A, i_q = {q:.1} A", scale * one.inductance)
    };
    let [d, q] = of_axes.each_ref().map(one);
    format!("the incremental L_d = {d}, and L_q = {q}")
}

/// How to make operating points tell several parameters.
pub(super) const SPREAD: &str = "add operating points that lie further apart in current and speed, each held steady";

/// How to make operating points tell a parameter.
fn spread(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Rs => {
            "add operating points with more current at low speed, or a larger step of i_d, or give R_s as measured at the terminals (half of \
             what a meter shows between two) to 1 % as a prior"
        }
        Parameter::Ld => "make the step of i_d larger, or log it at a higher speed",
        Parameter::Lq => "add operating points with more i_q, or at a higher speed",
        Parameter::PsiF => "add operating points at speeds that lie further apart, each held steady",
    }
}

/// So many times as long.
pub(super) fn hold_longer(times: f64) -> String {
    format!("hold each operating point about {times:.0} times as long")
}

/// The speed at which a lag shows, in both units that drives show, if the log has one to go by.
fn loaded_speed(omega_e: f64) -> String {
    if omega_e > 0.0 { format!("one speed near {}", in_both_units(omega_e)) } else { "one high speed".to_owned() }
}

/// The speed of the log, or which of them.
fn same_speed(omega_e: Option<f64>) -> String {
    omega_e.map_or_else(|| "same speed".to_owned(), |omega_e| format!("at {}", in_both_units(omega_e)))
}

fn in_both_units(omega_e: f64) -> String {
    format!("{} rad/s ({} r/min, both electrical)", three_digits(omega_e), three_digits(omega_e * 30.0 / PI))
}

/// So many times the speed.
pub(super) fn of_speed(times: f64) -> String {
    if times == 2.0 { "twice the speed".to_owned() } else { format!("{times} times the speed") }
}

impl Display for Promised {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{}: {} to about ±{}", self.measurement, self.parameter.symbol(), percent(self.half_width))
    }
}

impl Display for Measurement {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::AllPoints { times } => write!(f, "add the same operating points at {}", of_speed(*times)),
            Self::Resistance { accuracy } => {
                write!(
                    f,
                    "measure R_s at the terminals (half of what a meter shows between two) to {:.0} % and give it as a prior",
                    100.0 * accuracy
                )
            }
            Self::Stretch { seconds, place, omega_e } => match place {
                Place::Id(0.0) => write!(f, "add {seconds} s at i_d = 0, {}", same_speed(*omega_e)),
                Place::Id(id) => write!(f, "add {seconds} s at i_d = {} A, {}", one_digit(*id), same_speed(*omega_e)),
                Place::HalfLoad { iq } => {
                    write!(f, "add {seconds} s at half the load (i_q = {} A), {}", one_digit(*iq), same_speed(*omega_e))
                }
                Place::HalfSpeed => write!(f, "add {seconds} s at the same currents and half the speed"),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_is_told_in_both_units() {
        assert_eq!(loaded_speed(2000.0), "one speed near 2000 rad/s (19100 r/min, both electrical)");
        assert_eq!(loaded_speed(0.0), "one high speed");
        // A log of one speed has no other.
        let stretch = |omega_e| Measurement::Stretch { seconds: 0.2, place: Place::Id(-5.0), omega_e }.to_string();
        assert_eq!(stretch(None), "add 0.2 s at i_d = -5 A, same speed");
        assert_eq!(stretch(Some(613.0)), "add 0.2 s at i_d = -5 A, at 613 rad/s (5850 r/min, both electrical)");
    }

    #[test]
    fn the_alternative_to_holding_points_longer_can_be_left_out() {
        let or = Box::new(Remedy::SpreadPoints { parameter: Parameter::Ld });
        let remedy = Remedy::HoldLonger { times: 5.0, parameter: Parameter::Ld, half_width: 0.05, or };
        let longer = "hold each operating point about 5 times as long: L_d to about ±5.0 %";
        assert_eq!(format!("{remedy:#}"), longer);
        assert_eq!(remedy.to_string(), format!("{longer}; or make the step of i_d larger, or log it at a higher speed"));
    }
}

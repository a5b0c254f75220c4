//! An answer in one or two sentences: `3 of 4 identified. L_d needs 0.2 s at i_d = -2 A: then about ±0.29 %.`

use super::{
    digits::{list, one_digit, percent, three_digits},
    remedy::incremental,
};
use crate::{
    identification::explain::{
        measurement::{Measurement, Place, Promised},
        remedy::Remedy,
        summary::{NextStep, Summary},
    },
    motor::{PARAMETERS, Parameter},
};
use std::fmt::{Display, Formatter, Result};

fn symbols(parameters: &[Parameter]) -> String {
    list(&parameters.iter().copied().map(Parameter::symbol).collect::<Vec<_>>())
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let asked = PARAMETERS - self.given.len();
        match (self.identified.len(), asked) {
            (count, asked) if count == asked && asked > 1 => write!(f, "All {asked} identified")?,
            (0, asked) => write!(f, "None of {asked} identified")?,
            (count, asked) => write!(f, "{count} of {asked} identified")?,
        }
        if !self.given.is_empty() {
            write!(f, ", {} given", symbols(&self.given))?;
        }
        if !self.estimated.is_empty() {
            write!(f, ", {} estimated to ±{}", symbols(&self.estimated), percent(self.estimated_to))?;
        }
        match self.weak.len() {
            0 => {}
            count if count == asked && asked > 1 => write!(f, ", all weak")?,
            _ => write!(f, ", {} weak", symbols(&self.weak))?,
        }
        write!(f, ".")?;
        self.next.as_ref().map_or(Ok(()), |next| write!(f, " {next}"))
    }
}

impl Display for NextStep {
    fn fmt(&self, f: &mut Formatter) -> Result {
        if let Remedy::TakeIncremental { of_axes } = &self.remedy {
            return write!(f, "The motor saturates: a current controller takes {}.", incremental(of_axes));
        }
        let verb = if self.parameters.len() == 1 { "needs" } else { "need" };
        let need = match &self.remedy {
            Remedy::Measure(Promised { measurement: Measurement::Resistance { accuracy }, .. }) if self.parameters == [Parameter::Rs] => {
                format!("a measurement at the terminals to {:.0} %", 100.0 * accuracy)
            }
            remedy => need(remedy),
        };
        write!(f, "{} {verb} {need}", symbols(&self.parameters))?;
        match self.half_width {
            Some(width) => write!(f, ": then about ±{}.", percent(width)),
            None => write!(f, "."),
        }
    }
}

/// What the log lacks, in a few words.
fn need(remedy: &Remedy) -> String {
    match remedy {
        Remedy::Measure(promised) => match promised.measurement {
            Measurement::Resistance { accuracy } => format!("R_s measured at the terminals to {:.0} %", 100.0 * accuracy),
            Measurement::Stretch { seconds, place } => match place {
                Place::Id(id) => format!("{seconds} s at i_d = {} A", one_digit(id)),
                Place::HalfLoad { iq } => format!("{seconds} s at half the load (i_q = {} A)", one_digit(iq)),
                Place::HalfSpeed => format!("{seconds} s at half the speed"),
            },
        },
        Remedy::AddStretch { id, .. } => format!("a stretch at i_d = {} A", one_digit(*id)),
        Remedy::HoldLonger { times, .. } => format!("operating points held {times:.0} times as long"),
        Remedy::SpreadPoints { parameter: Parameter::Rs } => "more current at low speed, or R_s given".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::Ld } => "a larger step of i_d, or more speed".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::Lq } => "operating points with more i_q, or more speed".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::PsiF } => "a second, higher speed".to_owned(),
        Remedy::StateVoltageTiming => "the timing of the voltage columns stated".to_owned(),
        Remedy::CompensateDeadTime { or_resistance: true } => "dead time compensated, or R_s given".to_owned(),
        Remedy::CompensateDeadTime { or_resistance: false } => "dead time compensated".to_owned(),
        Remedy::TellFrameLag => "two loads at one high speed".to_owned(),
        Remedy::LogEachPeriod => "a log of each control period".to_owned(),
        Remedy::RemoveDisturbances => "a log without torque or supply ripple".to_owned(),
        Remedy::CalibrateSensors => "calibrated current sensors".to_owned(),
        Remedy::CalibrateBusVoltage => "a calibrated DC voltage".to_owned(),
        Remedy::SmallSteps => "steps held around one current at two speeds, or the table of fluxes".to_owned(),
        Remedy::TakeIncremental { of_axes } => incremental(of_axes),
        Remedy::SimilarWindows => "three windows at nearly the same currents".to_owned(),
        Remedy::SharperPrior => "a sharper prior, or another operating point".to_owned(),
        Remedy::FixOne => "one parameter given".to_owned(),
        Remedy::CheckFrame { lag } => format!("voltages of the currents' instant (now {} us late)", three_digits(1e6 * lag)),
        Remedy::CheckSigns { .. } => "signs and order of the columns checked".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_that_are_all_weak_are_not_listed() {
        let of_weak = |weak: &[Parameter]| {
            let given = Vec::new();
            Summary { identified: Vec::new(), given, estimated: Vec::new(), estimated_to: 0.0, weak: weak.to_vec(), next: None }.to_string()
        };
        assert_eq!(of_weak(&Parameter::ALL), "None of 4 identified, all weak.");
        assert_eq!(of_weak(&[Parameter::Ld, Parameter::Lq]), "None of 4 identified, L_d and L_q weak.");
    }
}

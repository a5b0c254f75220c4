//! An answer in one or two sentences: `3 of 4 identified. L_d needs 0.2 s at i_d = -2 A: then about ±0.29 %.`

use super::{
    digits::{from_to, list, one_digit, percent, three_digits},
    remedy::{SPREAD, hold_longer, of_speed},
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

/// Whether a remedy is to take what describes a motor that saturates.
fn is_of_saturation(remedy: &Remedy) -> bool {
    matches!(remedy, Remedy::SmallSteps | Remedy::TakeIncremental { .. })
}

/// That the motor saturates, with its apparent L_q, H, if that is known, and what to take of it.
fn saturates(apparent_lq: Option<[f64; 2]>, remedy: &Remedy) -> String {
    let apparent = apparent_lq.map_or_else(String::new, |ends| format!(", apparent L_q {}", from_to(ends)));
    format!("The motor saturates{apparent}: take {}.", need(remedy))
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let asked = PARAMETERS - self.given.len() - self.as_prior.len();
        match (self.identified.len(), asked) {
            (count, asked) if count == asked && asked > 1 => write!(f, "All {asked} identified")?,
            (0, asked) => write!(f, "None of {asked} identified")?,
            (count, asked) => write!(f, "{count} of {asked} identified")?,
        }
        // An estimate is weak too, as in the table.
        let is_weak = |parameter: &Parameter| self.weak.contains(parameter) || self.estimated.contains(parameter);
        let weak: Vec<Parameter> = Parameter::ALL.into_iter().filter(is_weak).collect();
        match weak.len() {
            0 => {}
            count if count == asked && asked > 1 => write!(f, ", all weak")?,
            _ => write!(f, ", {} weak", symbols(&weak))?,
        }
        if !self.estimated.is_empty() {
            write!(f, " ({} to ±{})", symbols(&self.estimated), percent(self.estimated_to))?;
        }
        let mut beside = if weak.is_empty() { "," } else { ";" };
        for (parameters, how) in [(&self.given, "given"), (&self.as_prior, "as its prior")] {
            if !parameters.is_empty() {
                write!(f, "{beside} {} {how}", symbols(parameters))?;
                beside = ",";
            }
        }
        write!(f, ".")?;
        match &self.next {
            None => Ok(()),
            // All that was asked for has one step.
            Some(NextStep { remedy: Remedy::Measure(promised), parameters, half_width: Some(width) })
                if parameters.len() == asked && asked > 1 =>
            {
                write!(f, " One step does all: {}, then about ±{} or less.", promised.measurement, percent(*width))
            }
            Some(next) if is_of_saturation(&next.remedy) => write!(f, " {}", saturates(self.apparent_lq, &next.remedy)),
            Some(next) => write!(f, " {next}"),
        }?;
        if let Some(further) = &self.further {
            write!(f, " {further}")?;
        }
        let rest = self.rest();
        if self.next.is_some() && !rest.is_empty() { write!(f, " For {} see below.", symbols(&rest)) } else { Ok(()) }
    }
}

impl Summary {
    /// What has no answer, and none of the steps that are told.
    fn rest(&self) -> Vec<Parameter> {
        let is_done = |parameter: &Parameter| [&self.identified, &self.given, &self.as_prior].iter().any(|done| done.contains(parameter));
        let has_step = |parameter: &Parameter| self.next.iter().chain(&self.further).any(|step| step.parameters.contains(parameter));
        Parameter::ALL.into_iter().filter(|parameter| !is_done(parameter) && !has_step(parameter)).collect()
    }
}

impl NextStep {
    /// What to do, with the interval to expect for all parameters that it helps: an instruction without a capital and a full stop.
    pub fn instruction(&self) -> String {
        match (&self.remedy, self.half_width) {
            (Remedy::Measure(promised), Some(width)) if self.parameters.len() > 1 => {
                format!("{}: {} to about ±{} or less", promised.measurement, symbols(&self.parameters), percent(width))
            }
            (Remedy::HoldLonger { times, .. }, Some(width)) if self.parameters.len() > 1 => {
                format!("{}: {} to about ±{} or less", hold_longer(*times), symbols(&self.parameters), percent(width))
            }
            (Remedy::SpreadPoints { .. }, _) if self.parameters.len() > 1 => SPREAD.to_owned(),
            (remedy, _) => remedy.to_string(),
        }
    }
}

impl Display for NextStep {
    fn fmt(&self, f: &mut Formatter) -> Result {
        if is_of_saturation(&self.remedy) {
            return f.write_str(&saturates(None, &self.remedy));
        }
        if matches!(self.remedy, Remedy::CheckSpeed | Remedy::CheckPrior { .. }) {
            return write!(f, "Check {}.", need(&self.remedy));
        }
        let verb = if self.parameters.len() == 1 { "needs" } else { "need" };
        let need = match &self.remedy {
            Remedy::Measure(Promised { measurement: Measurement::Resistance { accuracy }, .. }) if self.parameters == [Parameter::Rs] => {
                format!("a measurement at the terminals to {:.0} %", 100.0 * accuracy)
            }
            Remedy::SpreadPoints { .. } if self.parameters.len() > 1 => "steady points further apart in current and speed".to_owned(),
            remedy => need(remedy),
        };
        write!(f, "{} {verb} {need}", symbols(&self.parameters))?;
        match self.half_width {
            Some(width) => write!(f, ": then about ±{}{}.", percent(width), if self.parameters.len() > 1 { " or less" } else { "" }),
            None => write!(f, "."),
        }
    }
}

/// Which of its speeds, where a log has several.
fn at_speed(omega_e: Option<f64>) -> String {
    omega_e.map_or_else(String::new, |omega_e| format!(", {} rad/s", three_digits(omega_e)))
}

/// What the log lacks, in a few words; of a motor that saturates, what to take of it; of a speed in doubt, what to check.
fn need(remedy: &Remedy) -> String {
    match remedy {
        Remedy::Measure(promised) => match promised.measurement {
            Measurement::AllPoints { times } => format!("the same operating points at {}", of_speed(times)),
            Measurement::Resistance { accuracy } => format!("R_s measured at the terminals to {:.0} %", 100.0 * accuracy),
            Measurement::Stretch { seconds, place, omega_e } => match place {
                Place::Id(id) => format!("{seconds} s at i_d = {} A{}", one_digit(id), at_speed(omega_e)),
                Place::HalfLoad { iq } => format!("{seconds} s at half the load (i_q = {} A{})", one_digit(iq), at_speed(omega_e)),
                Place::HalfSpeed => format!("{seconds} s at half the speed"),
            },
        },
        Remedy::AddStretch { id, .. } => format!("a stretch at i_d = {} A", one_digit(*id)),
        Remedy::HoldLonger { times, .. } => format!("operating points held {times:.0} times as long"),
        Remedy::SpreadPoints { parameter: Parameter::Rs } => "more current at low speed, or R_s given".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::Ld } => "a larger step of i_d, or more speed".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::Lq } => "operating points with more i_q, or more speed".to_owned(),
        Remedy::SpreadPoints { parameter: Parameter::PsiF } => "speeds that lie further apart".to_owned(),
        Remedy::Turn => "a motor that turns".to_owned(),
        Remedy::CheckSpeed => "the unit of the speed and the number of pole pairs".to_owned(),
        Remedy::CheckPrior { parameter } => format!("the prior of {}", parameter.symbol()),
        Remedy::StepCurrent { parameter: Parameter::Ld } => "steps of i_d".to_owned(),
        Remedy::StepCurrent { .. } => "steps of i_q".to_owned(),
        Remedy::StateVoltageTiming => "the timing of the voltage columns stated".to_owned(),
        Remedy::CompensateDeadTime { or_resistance: true } => "dead time compensated, or R_s given".to_owned(),
        Remedy::CompensateDeadTime { or_resistance: false } => "dead time compensated".to_owned(),
        Remedy::TellFrameLag { omega_e } if *omega_e > 0.0 => {
            format!("two loads at one speed near {} electrical rad/s", three_digits(*omega_e))
        }
        Remedy::TellFrameLag { .. } => "two loads at one high speed".to_owned(),
        Remedy::LogEachPeriod => "a log of each control period".to_owned(),
        Remedy::RemoveDisturbances => "a log without torque or supply ripple".to_owned(),
        Remedy::CalibrateSensors => "calibrated current sensors".to_owned(),
        Remedy::CalibrateBusVoltage => "a calibrated DC voltage".to_owned(),
        Remedy::SmallSteps => "its fluxes at your currents".to_owned(),
        Remedy::TakeIncremental { .. } => "its incremental inductances".to_owned(),
        Remedy::SimilarWindows => "three windows at nearly the same currents".to_owned(),
        Remedy::HoldThroughRepeats => "points held for longer than the recorder repeats values".to_owned(),
        Remedy::SharperPrior => "a sharper prior, or another operating point".to_owned(),
        Remedy::FixOne => "one parameter given".to_owned(),
        Remedy::CheckFrame { lag } => format!("voltages of the currents' instant (now {} us late)", three_digits(1e6 * lag)),
        Remedy::CheckSigns { .. } => "signs and order of the columns checked".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: Summary = Summary {
        identified: Vec::new(),
        given: Vec::new(),
        as_prior: Vec::new(),
        estimated: Vec::new(),
        estimated_to: 0.0,
        weak: Vec::new(),
        apparent_lq: None,
        next: None,
        further: None,
    };

    #[test]
    fn parameters_that_are_all_weak_are_not_listed() {
        let of_weak =
            |weak: &[Parameter], given: &[Parameter]| Summary { weak: weak.to_vec(), given: given.to_vec(), ..NOTHING }.to_string();
        let [rs, ld, lq, psi_f] = Parameter::ALL;
        assert_eq!(of_weak(&Parameter::ALL, &[]), "None of 4 identified, all weak.");
        assert_eq!(of_weak(&[ld, lq], &[]), "None of 4 identified, L_d and L_q weak.");
        // What is weak is what was asked for, not what was given.
        assert_eq!(of_weak(&[ld, lq, psi_f], &[rs]), "None of 3 identified, all weak; R_s given.");
    }

    #[test]
    fn one_step_for_several_parameters_names_them_all() {
        let [rs, ld, lq, psi_f] = Parameter::ALL;
        let measurement = Measurement::Stretch { seconds: 0.5, place: Place::Id(-3.0), omega_e: None };
        let remedy = Remedy::Measure(Promised { measurement, parameter: rs, half_width: 0.01 });
        let next = |parameters: &[Parameter]| NextStep { remedy: remedy.clone(), parameters: parameters.to_vec(), half_width: Some(0.02) };
        assert_eq!(next(&[rs, ld]).instruction(), "add 0.5 s at i_d = -3 A, same speed: R_s and L_d to about ±2.0 % or less");
        assert_eq!(next(&[rs, ld]).to_string(), "R_s and L_d need 0.5 s at i_d = -3 A: then about ±2.0 % or less.");
        let all = Summary { next: Some(next(&[rs, ld, lq, psi_f])), ..NOTHING }.to_string();
        assert_eq!(all, "None of 4 identified. One step does all: add 0.5 s at i_d = -3 A, same speed, then about ±2.0 % or less.");
    }

    #[test]
    fn a_motor_that_saturates_is_told_in_few_words() {
        let [rs, ld, lq, psi_f] = Parameter::ALL;
        let next = NextStep { remedy: Remedy::SmallSteps, parameters: vec![ld, lq, psi_f], half_width: None };
        let weak = Summary { weak: Parameter::ALL.to_vec(), next: Some(next), ..NOTHING };
        let (told, rest) = ("The motor saturates: take its fluxes at your currents.", "For R_s see below.");
        assert_eq!(weak.to_string(), format!("None of 4 identified, all weak. {told} {rest}"));
        let estimated = Summary { estimated: vec![psi_f], estimated_to: 0.014, weak: vec![rs, ld, lq], ..weak };
        assert_eq!(estimated.to_string(), format!("None of 4 identified, all weak (psi_f to ±1.4 %). {told} {rest}"));
        let with_ends = Summary { apparent_lq: Some([1.187e-4, 1.043e-4]), ..estimated };
        assert!(with_ends.to_string().contains("The motor saturates, apparent L_q from 119 to 104 uH: take its fluxes"), "{with_ends}");
    }

    /// Such a value is not the log's.
    #[test]
    fn what_only_its_prior_tells_is_not_counted_as_identified() {
        let [rs, ld, lq, psi_f] = Parameter::ALL;
        let with = |identified: &[Parameter], weak: &[Parameter]| {
            Summary { identified: identified.to_vec(), as_prior: vec![rs], weak: weak.to_vec(), ..NOTHING }.to_string()
        };
        assert_eq!(with(&[lq, psi_f], &[ld]), "2 of 3 identified, L_d weak; R_s as its prior.");
        assert_eq!(with(&[ld, lq, psi_f], &[]), "All 3 identified, R_s as its prior.");
    }
}

//! A fleet in a few sentences: how many motors are identified, which stand apart, which drift.

use super::digits::list;
use crate::fleet::{FleetOverview, Member, Missing, Standing};
use crate::{Verdict, motor::PARAMETERS};
use std::fmt::{Display, Formatter, Result};

/// How many motors a sentence names.
const NAMED: usize = 3;

impl Display for FleetOverview {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let motors = self.motors.len();
        let [failed, refused, weak, whole] = Standing::ALL.map(|standing| self.count(standing));
        let fewer = refused + weak;
        match (motors, whole, fewer, failed) {
            (0, ..) => write!(f, "There are no motors.")?,
            (1, 1, ..) => write!(f, "1 motor, all {PARAMETERS} parameters identified.")?,
            (1, _, 1, _) => write!(f, "1 motor, fewer than {PARAMETERS} parameters identified.")?,
            (1, ..) => write!(f, "1 motor, without an answer.")?,
            (_, all, ..) if all == motors => write!(f, "{motors} motors, each with all {PARAMETERS} parameters identified.")?,
            (_, _, _, all) if all == motors => write!(f, "{motors} motors, none with an answer.")?,
            _ => write!(
                f,
                "{motors} motors: {whole} with all {PARAMETERS} parameters identified, {fewer} with fewer, {failed} without an answer."
            )?,
        }
        let apart = self.apart();
        if !apart.is_empty() {
            let verb = if apart.len() == 1 { "stands" } else { "stand" };
            write!(f, " {} {verb} apart from the others: {}.", apart.len(), names(&apart))?;
        }
        let drifting = self.drifting();
        if !drifting.is_empty() {
            let verb = if drifting.len() == 1 { "drifts" } else { "drift" };
            write!(f, " {} {verb}: {}.", drifting.len(), names(&drifting))?;
        }
        Ok(())
    }
}

/// The names of the first motors, and how many more there are.
fn names(motors: &[&Member]) -> String {
    let mut named: Vec<String> = motors.iter().take(NAMED).map(|motor| motor.best.motor.to_string()).collect();
    let more = motors.len() - named.len();
    if more > 0 {
        named.push(format!("{more} more"));
    }
    list(&named)
}

impl Display for Missing {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Answer => write!(f, "no answer"),
            Self::Parameter(parameter, Verdict::Weak) => write!(f, "{} is weak", parameter.symbol()),
            Self::Parameter(parameter, _) => write!(f, "{} has no value", parameter.symbol()),
        }
    }
}

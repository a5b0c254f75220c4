//! A log that does not agree with the nameplate.

use super::digits::{list, three_digits};
use crate::{
    identification::explain::conventions::{Candidate, Convention, Ratio},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

/// Alternatives that are named.
const NAMED: usize = 2;

/// A factor that changes nothing worth mentioning.
const NO_CHANGE: f64 = 0.01;

impl Display for Convention {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let mut parts = Vec::new();
        if self.reversed {
            parts.push(
                "u_q and the speed have opposite signs, so that psi_f is negative: negative speed is valid data, but u_q is negative with \
                 it; check the sign of the speed, the order of the phases and the direction of q"
                    .to_owned(),
            );
        }
        let off: Vec<&Ratio> = self.deviating().collect();
        if !off.is_empty() {
            let who = if off.iter().all(|ratio| ratio.apparent) { "the log's rows have" } else { "the log has" };
            parts.push(format!("{who} {} the nameplate's", times(off.iter().copied(), |ratio| ratio.ratio)));
            parts.push(suspicion(self));
            if off.iter().all(|ratio| ratio.parameter == Parameter::Rs && ratio.ratio > 1.0) {
                parts.push("dead time, device drops, cables and heat also add to R_s".to_owned());
            }
        }
        write!(f, "{}", parts.join("; "))
    }
}

/// The best candidate, as what it is.
fn suspicion(convention: &Convention) -> String {
    const CHECK: &str = "check units and mapping of the columns, and the motor file";
    let Some(best) = &convention.best else {
        return if convention.may_be_saturation() {
            format!("inductances change as much with current (saturation), so no convention is suspected; but {CHECK}")
        } else {
            format!("no usual confusion of units or conventions explains that; {CHECK}")
        };
    };
    let mut text = format!("best candidate: {}", effect(best, &convention.ratios));
    let left = convention.ratios.iter().filter(|ratio| !best.explained.contains(&ratio.parameter));
    let left: Vec<&str> = left.map(|ratio| ratio.parameter.symbol()).collect();
    if !left.is_empty() {
        text += &format!("; it does not explain {}", left.join(", "));
    }
    let others: Vec<String> = convention.alternatives.iter().take(NAMED).map(|other| format!("; or else {}", patterns(other))).collect();
    text += &others.concat();
    text + "; this is unproven, and nothing was changed: check how the drive and the data sheet define these quantities"
}

/// What would have happened.
fn patterns(candidate: &Candidate) -> String {
    let happened: Vec<String> = candidate.patterns.iter().map(|pattern| format!("{} ({})", pattern.sentence, pattern.number)).collect();
    happened.join(", and ")
}

/// What would have happened, and what it does to the parameters that it explains.
fn effect(candidate: &Candidate, ratios: &[Ratio]) -> String {
    let factor = |ratio: &Ratio| candidate.factors[ratio.parameter as usize];
    let moved = ratios.iter().filter(|ratio| candidate.explained.contains(&ratio.parameter) && (factor(ratio) - 1.0).abs() > NO_CHANGE);
    format!("{}, which makes {}", patterns(candidate), times(moved, factor))
}

/// "R_s 1.73, L_q 1.73 and psi_f 1.73 times".
fn times<'a>(ratios: impl Iterator<Item = &'a Ratio>, number: impl Fn(&Ratio) -> f64) -> String {
    let each: Vec<String> = ratios.map(|ratio| format!("{} {}", ratio.parameter.symbol(), three_digits(number(ratio)))).collect();
    if each.is_empty() { String::new() } else { format!("{} times", list(&each)) }
}

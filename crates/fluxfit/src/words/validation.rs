//! The verdict of a validation in sentences: what it is, by how much, which parameters the log would have otherwise.

use super::digits::{digits, list};
use crate::validation::validate::{Channel, Difference, Outcome, Validation};

impl Validation {
    /// The verdict in one or two sentences.
    pub fn verdict(&self) -> String {
        let vector = if self.own.output.is_some() { "current" } else { "voltage" };
        let share = digits(100.0 * self.share, 2);
        let probability = self.test.probability;
        let verdict = match self.outcome {
            Outcome::Agrees => {
                format!(
                    "Agrees within the noise: a log of exactly this motor would differ as much or more with probability {}.",
                    digits(probability, 2)
                )
            }
            Outcome::DiffersLittle => format!("Differs, but by little: by {share} % of the {vector}. {}", self.asked_for()),
            Outcome::Contradicts => format!("Contradicts: the prediction is off by {share} % of the {vector}. {}", self.asked_for()),
            Outcome::CannotTell => return "Cannot tell: this log tells none of the four parameters.".to_owned(),
        };
        let verdict = verdict + &self.within_intervals_alone();
        let untested: Vec<&str> = self.untested().map(|difference| difference.parameter.symbol()).collect();
        if untested.is_empty() {
            return verdict;
        }
        let are = if untested.len() == 1 { "it is" } else { "they are" };
        format!("{verdict} This log cannot tell {}: {are} taken as given.", list(&untested))
    }

    /// What agrees although far more than noise is missed, as a sentence after the verdict; nothing where that is not so.
    fn within_intervals_alone(&self) -> String {
        let missed: Vec<&Channel> = self.channels.iter().filter(|channel| channel.is_within_intervals_alone()).collect();
        if missed.is_empty() {
            return String::new();
        }
        let one = |channel: &&Channel| {
            let times = digits(channel.ratio()?, 2);
            Some(format!("{} is missed by {} {}, {times} times its noise", channel.name, digits(channel.rms, 2), channel.unit))
        };
        let how_much: Vec<String> = missed.iter().filter_map(one).collect();
        format!(" {}: only the intervals of the parameters allow as much.", list(&how_much))
    }

    /// What the log would have instead: the parameters that differ, or the one that differs most.
    fn asked_for(&self) -> String {
        let mut differing: Vec<(&Difference, f64)> =
            self.parameters.iter().filter_map(|difference| Some((difference, difference.standard_errors()?))).collect();
        differing.sort_by(|one, other| other.1.abs().total_cmp(&one.1.abs()));
        let named = differing.iter().filter(|(difference, _)| difference.is_different()).count().max(1);
        let asked: Vec<String> = differing.iter().take(named).map(|(difference, errors)| asked(difference, *errors)).collect();
        format!("The log asks for {}.", asked.join("; "))
    }
}

impl Channel {
    /// The verdict in a few words: where only the intervals of the parameters allow what is missed, it is that, and not agreement.
    pub fn verdict(&self) -> &'static str {
        if self.is_within_intervals_alone() { "within intervals" } else { self.outcome.label() }
    }
}

impl Difference {
    /// What to check where the given value is off by a power of ten, as half a sentence.
    pub fn unit_hint(&self) -> Option<String> {
        let (power, symbol) = (self.power_of_ten()?, self.parameter.symbol());
        let factor = format!("1{}", "0".repeat(power.unsigned_abs() as usize));
        let times = if power < 0 { format!("{factor} times") } else { format!("1/{factor} of") };
        Some(format!("the given {symbol} is about {times} that of this log"))
    }
}

fn asked(difference: &Difference, errors: f64) -> String {
    let (symbol, errors) = (difference.parameter.symbol(), digits(errors.abs(), 2));
    let (Some(percent), Some(own)) = (difference.percent(), difference.own) else {
        return format!("another {symbol}, {errors} standard errors away");
    };
    let half_width = 100.0 * own.half_width / difference.given;
    let direction = if percent < 0.0 { "lower" } else { "higher" };
    let decimals = decimals(half_width);
    format!("{symbol} {:.decimals$} ± {half_width:.decimals$} % {direction}, {errors} standard errors", percent.abs())
}

/// Decimals that show two digits of an uncertainty, no more than four of them.
fn decimals(uncertainty: f64) -> usize {
    if uncertainty > 0.0 && uncertainty.is_finite() { (1.0 - uncertainty.log10().floor()).clamp(0.0, 4.0) as usize } else { 2 }
}

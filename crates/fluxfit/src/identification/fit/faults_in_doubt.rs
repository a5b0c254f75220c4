//! What faults of the drive that may be there, but were not taken, could do to the parameters.
//!
//! The answer is that of the drive without them. One for which there is strong evidence has a probability by Schwarz's criterion,
//! `1 / (1 + exp(-gain / 2))`, with which the parameters are those beside it, so that their mean square distance from the answer grows by
//! that part of the square of the move. Of faults that explain the same, the one that matters most counts.
//!
//! R. E. Kass and A. E. Raftery, "Bayes factors", Journal of the American Statistical Association 90 (1995) 773,
//! doi:10.1080/01621459.1995.10476572; J. A. Hoeting et al., "Bayesian model averaging: a tutorial", Statistical Science 14 (1999) 382,
//! doi:10.1214/ss/1009212519.

use super::{
    fault_trial::{FaultOutcome, FaultTrial},
    readings::VERY_STRONG,
};
use crate::{faults::Fault, motor::PARAMETERS};
use std::collections::BTreeMap;

/// The gain from which evidence is strong (Kass and Raftery, section 3.2): what is very strong was taken.
const STRONG: f64 = 6.0;

/// How far each parameter could be moved by them, SI, as a standard deviation.
pub(super) fn doubt(trials: &[FaultTrial]) -> [f64; PARAMETERS] {
    let mut families: BTreeMap<&str, [f64; PARAMETERS]> = BTreeMap::new();
    // What fits without a physical meaning says nothing of where the parameters are, and inductances beside saturation are those at no
    // current: other numbers.
    let counts = |trial: &&FaultTrial| {
        let may_be_there = match trial.outcome {
            FaultOutcome::NotNeeded | FaultOutcome::NoMatter => trial.gain > STRONG,
            // In the place of the one that was taken.
            FaultOutcome::Covered => trial.gain > -VERY_STRONG,
            FaultOutcome::NeedsMorePoints => true,
            _ => false,
        };
        may_be_there && trial.fault != Fault::Saturation
    };
    for trial in trials.iter().filter(counts) {
        // Evidence that is worth nothing leaves it as likely as not.
        let gain = if trial.outcome == FaultOutcome::NeedsMorePoints { 0.0 } else { trial.gain };
        let probability = 1.0 / (1.0 + (-0.5 * gain).exp());
        let family = families.entry(trial.fault.family()).or_default();
        *family = std::array::from_fn(|p| family[p].max(probability * trial.moves[p].powi(2)));
    }
    // An empty `sum` would be minus zero.
    std::array::from_fn(|p| families.values().fold(0.0, |sum: f64, family| sum + family[p]).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gain of 2 ln 24 makes a fault 24 times as likely as not.
    #[test]
    fn a_fault_counts_by_its_probability() {
        let gain = 2.0 * 24.0_f64.ln();
        let trial = |fault, gain, outcome, move_of_rs| FaultTrial { fault, gain, outcome, moves: [move_of_rs, 0.0, 0.0, 0.0] };
        let angle = trial(Fault::AngleDelay, gain, FaultOutcome::NotNeeded, 2.0);
        assert!((doubt(std::slice::from_ref(&angle))[0] - (0.96_f64 * 4.0).sqrt()).abs() < 1e-12);
        let drift = trial(Fault::ResistanceDrift, gain, FaultOutcome::NoMatter, -4.0);
        assert!((doubt(&[angle.clone(), drift])[0] - (0.96_f64 * 20.0).sqrt()).abs() < 1e-12);
        let nothing = [
            trial(Fault::ResistanceDrift, f64::NEG_INFINITY, FaultOutcome::NotNeeded, 1.0),
            trial(Fault::ResistanceDrift, 5.9, FaultOutcome::NotNeeded, 1.0),
            trial(Fault::ResistanceDrift, 100.0, FaultOutcome::NotPhysical, 1.0),
            trial(Fault::ResistanceDrift, 100.0, FaultOutcome::Taken, 1.0),
            trial(Fault::Saturation, 100.0, FaultOutcome::NotNeeded, 1.0),
        ];
        assert_eq!(doubt(&nothing), [0.0; PARAMETERS]);
        // In the place of another that is 2 ln 24 better: its probability is 1 in 25.
        let other = trial(Fault::VoltageLag, -gain, FaultOutcome::Covered, 2.0);
        assert!((doubt(std::slice::from_ref(&other))[0] - 0.4).abs() < 1e-12);
        assert_eq!(doubt(&[trial(Fault::VoltageLag, -20.0, FaultOutcome::Covered, 2.0)]), [0.0; PARAMETERS]);
        // Evidence that is worth nothing: as likely as not.
        let untold = trial(Fault::AngleOffset, 1000.0, FaultOutcome::NeedsMorePoints, 2.0);
        assert!((doubt(&[untold])[0] - 2.0_f64.sqrt()).abs() < 1e-12);
        // Both filters say the same.
        let filters = [Fault::CurrentFilter, Fault::DqCurrentFilter].map(|filter| trial(filter, gain, FaultOutcome::NotNeeded, 2.0));
        assert_eq!(doubt(&filters), doubt(&[angle]));
    }
}

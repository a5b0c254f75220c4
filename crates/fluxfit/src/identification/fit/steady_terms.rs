//! What the fitted voltages of operating points contain beside the four parameters.

use super::{part::Part, steady::SteadyFit};

impl SteadyFit {
    /// The terms that were fitted beside the motor, by the doubt that each stands for: without them the parameters alone give other
    /// voltages than the fitted ones.
    pub fn terms(&self) -> Vec<Part> {
        let mut terms = Vec::new();
        for (loss, (value, _)) in self.losses.iter().zip(&self.estimate.found) {
            // Noise stands for the drift of R_s, which the answer tells by itself.
            if *value != 0.0 && loss.part != Part::Noise && !terms.contains(&loss.part) {
                terms.push(loss.part);
            }
        }
        terms
    }
}

//! For which currents or which time a number holds, where what it measures changes within the log: `at small currents`.

use crate::{faults::Fault, identification::solve::Identification, motor::Parameter};

impl Identification {
    /// For which currents or which time the parameter's value holds; none where it holds for the whole log.
    pub fn valid_at(&self, parameter: Parameter) -> Option<&'static str> {
        let judgement = self.parameter(parameter);
        let is_found = judgement.value().is_some() && judgement.uncertainty.standard_error() > 0.0;
        let fit = self.output.as_ref().filter(|_| is_found)?;
        match parameter {
            // A drift is linear about the log's middle.
            Parameter::Rs => fit.has(Fault::ResistanceDrift).then_some("in the middle of the log"),
            Parameter::Ld | Parameter::Lq => {
                let small = self.saturation.as_ref()?.small_currents.get(parameter);
                (judgement.raw == small).then_some("at small currents")
            }
            Parameter::PsiF => None,
        }
    }
}

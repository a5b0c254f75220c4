//! The names of parameters, verdicts and models, as sentences and tables have them. Files have their keys.

use crate::{
    identification::{judge::verdict::Verdict, prepare::model::Model},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

impl Display for Parameter {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(self.symbol())
    }
}

impl Display for Verdict {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::NotIdentifiable => "not identifiable",
        })
    }
}

impl Display for Model {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(self.label())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_padded_as_other_texts() {
        assert_eq!(format!("{:6}{:>5}|{}", Parameter::Rs, Verdict::Weak, Verdict::NotIdentifiable), "R_s    weak|not identifiable");
    }
}

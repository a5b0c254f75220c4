//! Why rows are left out, in a few words.

use crate::identification::explain::left_out::LeftOutReason;
use std::fmt::{Display, Formatter, Result};

impl Display for LeftOutReason {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(match self {
            Self::OutsideWindows => "outside of the windows that were named",
            Self::NotSteady => "currents or speed not constant",
            Self::LikeOthers => "like other rows of this long log",
            Self::TooShort => "too few rows without a gap",
        })
    }
}

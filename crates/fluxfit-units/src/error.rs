//! Why a text could not be read as a value: one sentence on one line, with what to write instead.

use crate::wording::{did_you_mean, list, one_line, quote};
use std::fmt;

/// Why a text could not be read as a value. Its `Display` is one line.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueError(Problem);

impl From<Problem> for ValueError {
    fn from(problem: Problem) -> Self {
        Self(problem)
    }
}

impl fmt::Display for ValueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&one_line(&self.0.to_string()))
    }
}

impl std::error::Error for ValueError {}

/// The sentences. What the user wrote is quoted and shortened here and nowhere else.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    #[error("{} is not understood; write {form}, as in {example}", quote(.text))]
    Form { text: String, form: &'static str, example: &'static str },
    #[error("{} is not a parameter; the parameters are {}{}", quote(.name), list(.known), did_you_mean(*.nearest))]
    Parameter { name: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is not {noun}; write a number, in {si} or with its unit, as in {example}", quote(.text))]
    Quantity { text: String, noun: &'static str, si: &'static str, example: &'static str },
    #[error("{} is not a ratio; write a number without a unit, as in {example}", quote(.text))]
    Ratio { text: String, example: &'static str },
    #[error("{} is not a fraction; write a number or a percentage, as in 0.01 or 1%", quote(.text))]
    Fraction { text: String },
    #[error("{} is out of range; it must be {range}", quote(.text))]
    Range { text: String, range: &'static str },
    #[error("{} has a unit on one number only; write it on both", quote(.text))]
    OneSidedUnit { text: String },
    #[error("{} is not an interval; write the lower end first", quote(.text))]
    Interval { text: String },
}

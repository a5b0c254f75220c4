//! What the methods of a study have in common.

use super::{MethodStudy, fitness::Problem};
use crate::{
    motor::Motor,
    optimizer::{Settings, bounds::Bounds},
};

/// What the methods of a study have in common.
#[derive(Debug, Clone, Copy)]
pub struct StudyFacts<'a> {
    /// Settings of every run.
    pub settings: &'a Settings,
    /// Runs of each method.
    pub runs: usize,
    /// Where they searched.
    pub bounds: &'a Bounds,
    /// What they minimized.
    pub problem: &'a Problem,
    /// The true motor, if known.
    pub truth: Option<&'a Motor>,
}

impl StudyFacts<'_> {
    /// Whether this many methods have finished all their runs, none of them interrupted.
    pub fn is_whole(&self, methods: &[(MethodStudy, f64)], asked: usize) -> bool {
        methods.len() == asked && methods.iter().all(|(study, _)| study.motors.len() == self.runs)
    }
}

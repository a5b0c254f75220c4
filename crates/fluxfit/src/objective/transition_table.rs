//! Transitions at any speed, interpolated between those at even steps of speed: a matrix exponential per step instead of one per row.

use super::{acting_voltage::Period, transition::Transition};
use crate::motor::Motor;

/// Turn, rad, from one tabulated transition to the next: a cubic between four of them is right to 0.005⁴ · 3/128 = 1e-11.
const STEP: f64 = 0.005;

/// Transitions of one motor over periods of one length, at even steps of speed.
pub(super) struct TransitionTable {
    /// Speed of the first, electrical rad/s.
    first: f64,
    /// From one to the next, electrical rad/s.
    step: f64,
    nodes: Vec<Transition>,
}

impl TransitionTable {
    /// For all speeds of these periods, each `length` seconds long.
    pub(super) fn new(motor: &Motor, periods: &[Period], length: f64) -> Self {
        let speeds = || periods.iter().map(|period| period.omega_e);
        let (low, high) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(f64::NEG_INFINITY, f64::max));
        let step = STEP / length;
        let first = low - step;
        // One node before the first speed and two behind the last.
        let nodes = ((high - low) / step).ceil() as usize + 4;
        Self { first, step, nodes: (0..nodes).map(|node| Transition::of(motor, first + node as f64 * step, length)).collect() }
    }

    /// The cubic through the four nodes around a speed.
    #[inline]
    pub(super) fn at(&self, omega_e: f64) -> Transition {
        let place = (omega_e - self.first) / self.step;
        let node = (place as usize).clamp(1, self.nodes.len() - 3);
        let x = place - node as f64;
        let weights = [
            -x * (x - 1.0) * (x - 2.0) / 6.0,
            (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
            -(x + 1.0) * x * (x - 2.0) / 2.0,
            (x + 1.0) * x * (x - 1.0) / 6.0,
        ];
        Transition::blend(&self.nodes[node - 1..node + 3], &weights)
    }
}

//! What is known before the first sample.

use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// What is known of a motor before its stream begins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Values to begin with, SI. Without them the first samples give them.
    pub values: [Option<f64>; PARAMETERS],
    /// Standard errors of these values, SI, where they are measurements that count: zero for exact ones. None: they are only a start.
    pub standard_errors: [Option<f64>; PARAMETERS],
    /// Rated current, A, and speed, electrical rad/s.
    pub rating: Option<[f64; 2]>,
}

/// Parts of the largest voltage that resistance and inductance take in a usual motor at the largest current: a place to begin at where
/// nothing is known.
const USUAL_DROP: [f64; 2] = [0.03, 0.3];

/// Values to begin with where nothing is known: `largest` has current, A, voltage, V, and speed.
pub(crate) fn guessed(largest: [f64; 3]) -> [f64; PARAMETERS] {
    // A stream at rest has none of them; one of each unit then stands for it.
    let [current, voltage, speed] = largest.map(|value| if value > 0.0 { value } else { 1.0 });
    let inductance = USUAL_DROP[1] * voltage / (current * speed);
    [USUAL_DROP[0] * voltage / current, inductance, inductance, voltage / speed]
}

impl Start {
    /// The known standard errors as parts of the values, for those that count.
    pub(crate) fn known(&self, nominal: &[f64; PARAMETERS]) -> [Option<f64>; PARAMETERS] {
        std::array::from_fn(|j| self.values[j].and(self.standard_errors[j]).map(|error| error / nominal[j]))
    }
}

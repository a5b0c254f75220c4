//! The winding's temperature, and what that makes of R_s and psi_f.

use super::digits::{percent, three_digits};
use crate::identification::explain::temperature::{AtTemperature, REFERENCE_TEMPERATURE, Referred};
use std::fmt::{Display, Formatter, Result};

/// A range of temperatures, K, that is named: less is the noise of a sensor.
const NAMED_RANGE: f64 = 1.0;

impl Display for AtTemperature {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "the winding was at {:.0} degC in the rows used", self.mean)?;
        if self.highest - self.lowest >= NAMED_RANGE {
            let gain = percent(self.copper_gain);
            write!(f, ", from {:.0} to {:.0} degC, where copper's resistance grows by {gain}", self.lowest, self.highest)?;
        }
        let referred = |value: Option<Referred>, symbol, unit| {
            value.map(|value| format!("{symbol} = {} {unit} {}", three_digits(value.value), width(&value)))
        };
        let values: Vec<String> = [referred(self.rs, "R_s", "ohm"), referred(self.psi_f, "psi_f", "Wb")].into_iter().flatten().collect();
        if values.is_empty() { Ok(()) } else { write!(f, "; at {REFERENCE_TEMPERATURE:.0} degC {}", values.join(" and ")) }
    }
}

/// Half of the interval.
fn width(referred: &Referred) -> String {
    let [low, high] = referred.interval;
    format!("±{}", percent(0.5 * (high - low) / referred.value))
}

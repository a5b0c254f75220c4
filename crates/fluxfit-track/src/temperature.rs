//! Temperatures from what is followed: of the winding from R_s, of the magnets from psi_f.
//!
//! Copper's resistance grows by 0.393 % of that at 20 degC per kelvin (IEC 60028), the flux of magnets changes by a coefficient that their
//! maker states. Either needs a value at a known temperature: from a nameplate, or the mean over the first minute.

use crate::verdict::{Tracked, Verdict};
use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// Temperature at which copper would have no resistance if it stayed linear, degC: `20 - 1/0.00393`.
const COPPER_ZERO: f64 = 20.0 - 1.0 / 0.00393;

/// Time over which a reference is taken where none is given, s.
const FIRST: f64 = 60.0;

/// Places of R_s and psi_f among the parameters.
const SOURCES: [usize; 2] = [0, 3];

/// What temperatures are told from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Thermometer {
    /// Temperature, degC, at which R_s and psi_f have their reference values.
    reference: f64,
    /// By which part of itself at the reference the flux changes per kelvin.
    magnet_coefficient: Option<f64>,
    /// Reference values, SI: given, or the mean so far.
    values: [f64; 2],
    /// Of each, how many values it is the mean of; none of a given one.
    counts: [Option<u64>; 2],
    began: Option<f64>,
}

/// Temperatures, degC, each with the half-width of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperatures {
    /// Of the winding.
    pub winding: Option<(f64, f64)>,
    /// Of the magnets.
    pub magnets: Option<(f64, f64)>,
}

impl Thermometer {
    /// A thermometer whose references are R_s and psi_f at a temperature, degC; those that are not given are the means of the first
    /// minute.
    pub fn new(reference: f64, rs: Option<f64>, psi_f: Option<f64>, magnet_coefficient: Option<f64>) -> Self {
        let given = [rs, psi_f];
        Self {
            reference,
            magnet_coefficient,
            values: given.map(Option::unwrap_or_default),
            counts: given.map(|value| if value.is_some() { None } else { Some(0) }),
            began: None,
        }
    }

    /// Takes what is known at a time, s.
    pub fn note(&mut self, t: f64, parameters: &[Tracked; PARAMETERS]) {
        let began = *self.began.get_or_insert(t);
        if t - began > FIRST {
            return;
        }
        for ((mean, count), source) in self.values.iter_mut().zip(&mut self.counts).zip(SOURCES) {
            if let (Some(count), Verdict::Identified, Some(value)) = (count, parameters[source].verdict, parameters[source].value) {
                *count += 1;
                *mean += (value - *mean) / *count as f64;
            }
        }
    }

    /// The temperatures now.
    pub fn read(&self, parameters: &[Tracked; PARAMETERS]) -> Temperatures {
        let ratio = |place: usize| {
            let (reference, now) = (self.values[place], &parameters[SOURCES[place]]);
            (reference > 0.0).then_some((now.value? / reference, now.half_width()? / reference))
        };
        let winding = ratio(0).map(|(ratio, margin)| {
            let span = self.reference - COPPER_ZERO;
            (COPPER_ZERO + ratio * span, margin * span)
        });
        let coefficient = self.magnet_coefficient.filter(|coefficient| *coefficient != 0.0);
        let magnets = coefficient
            .zip(ratio(1))
            .map(|(coefficient, (ratio, margin))| (self.reference + (ratio - 1.0) / coefficient, margin / coefficient.abs()));
        Temperatures { winding, magnets }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(rs: f64, psi_f: f64) -> [Tracked; 4] {
        [rs, 5e-3, 12e-3, psi_f].map(|value| Tracked {
            value: Some(value),
            standard_error: Some(0.01 * value),
            verdict: Verdict::Identified,
        })
    }

    #[test]
    fn temperatures_follow_from_resistance_and_flux() {
        // 1 ohm at 20 degC grows by 0.00393 ohm a kelvin; a flux of 0.2 Wb falls by 0.12 % a kelvin.
        let thermometer = Thermometer::new(20.0, Some(1.0), Some(0.2), Some(-0.0012));
        let told = thermometer.read(&parameters(1.0 + 80.0 * 0.00393, 0.2 * (1.0 - 50.0 * 0.0012)));
        let (winding, margin) = told.winding.unwrap();
        assert!((winding - 100.0).abs() < 1e-9 && (margin - 1.959964 * 0.01 * 1.3144 / 0.00393).abs() < 1e-9);
        assert!((told.magnets.unwrap().0 - 70.0).abs() < 1e-9);
        assert_eq!(Thermometer::new(20.0, Some(1.0), Some(0.2), None).read(&parameters(1.0, 0.2)).magnets, None);
    }

    #[test]
    fn the_first_minute_is_the_reference() {
        let mut thermometer = Thermometer::new(25.0, None, None, None);
        assert_eq!(thermometer.read(&parameters(1.0, 0.2)).winding, None);
        (0..60).for_each(|t| thermometer.note(f64::from(t), &parameters(if t % 2 == 0 { 0.99 } else { 1.01 }, 0.2)));
        thermometer.note(100.0, &parameters(5.0, 0.2));
        assert!((thermometer.read(&parameters(1.0, 0.2)).winding.unwrap().0 - 25.0).abs() < 1e-9);
    }
}

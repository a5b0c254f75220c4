//! The adjustable drive: the motor, and the faults that stand between it and the log. [`Unknown`] names every number of it that a fit
//! may move.

use crate::{
    faults::{Fault, FaultNumber, Faults, disturbance::Disturbance},
    motor::{Motor, Parameter},
};

/// A motor in an imperfect drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjustable {
    /// The motor.
    pub motor: Motor,
    /// The drive's faults.
    pub faults: Faults,
}

/// A number of an [`Adjustable`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// One of the four parameters.
    Motor(Parameter),
    /// A number of a fault.
    Fault(FaultNumber),
}

impl Unknown {
    /// The unknowns of a fault.
    pub fn of_fault(fault: Fault) -> impl Iterator<Item = Self> {
        fault.numbers().map(Self::Fault)
    }

    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.key(),
            Self::Fault(number) => number.key(),
        }
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.symbol(),
            Self::Fault(number) => number.label(),
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.unit(),
            Self::Fault(number) => number.unit(),
        }
    }

    /// The values that are possible, SI.
    pub fn possible(self) -> [f64; 2] {
        match self {
            Self::Motor(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Fault(number) => number.possible(),
        }
    }

    /// The fault that it belongs to; none for a parameter of the motor.
    pub fn fault(self) -> Option<Fault> {
        match self {
            Self::Motor(_) => None,
            Self::Fault(number) => Some(number.fault()),
        }
    }

    /// Whether it is a gain of the observer of a disturbed motor.
    pub fn is_observer_gain(self) -> bool {
        self.fault() == Some(Fault::Disturbance)
    }
}

impl From<Motor> for Adjustable {
    fn from(motor: Motor) -> Self {
        Self { motor, faults: Faults::default() }
    }
}

/// Largest gain of an observer that a fit starts with: above one it runs ahead of what a filter or a delay holds back, and leads away from
/// them.
const LARGEST_GAIN: f64 = 0.9;

impl Adjustable {
    /// One number.
    pub fn get(&self, unknown: Unknown) -> f64 {
        match unknown {
            Unknown::Motor(parameter) => self.motor.get(parameter),
            Unknown::Fault(number) => self.faults.get(number),
        }
    }

    /// The same with one number changed.
    pub fn with(mut self, unknown: Unknown, value: f64) -> Self {
        match unknown {
            Unknown::Motor(parameter) => {
                let mut values = self.motor.to_array();
                values[parameter as usize] = value;
                self.motor = Motor::from(values);
            }
            Unknown::Fault(number) => self.faults.set(number, value),
        }
        self
    }

    /// The drive with an observer that a fit can start with.
    pub(crate) fn calmed(mut self) -> Self {
        let gain = &mut self.faults.disturbance.gain;
        (gain.d, gain.q) = (gain.d.min(LARGEST_GAIN), gain.q.min(LARGEST_GAIN));
        self
    }

    /// The same without the observer of a disturbed motor.
    pub fn without_observer(self) -> Self {
        Self { faults: Faults { disturbance: Disturbance::default(), ..self.faults }, ..self }
    }

    /// The size of an unknown by which the steps of a fit are counted, SI, given the largest measured current, A: a parameter's own size,
    /// a fault's usual one; one where that is zero.
    pub(crate) fn step_unit(&self, unknown: Unknown, peak_current: f64) -> f64 {
        let size = match unknown {
            Unknown::Motor(parameter) => self.motor.get(parameter).abs(),
            Unknown::Fault(number) => number.usual_size(&self.motor, peak_current.max(f64::MIN_POSITIVE)),
        };
        if size > 0.0 { size } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_set_is_got() {
        let motor = Parameter::ALL.map(Unknown::Motor);
        for unknown in motor.into_iter().chain(Fault::ALL.into_iter().flat_map(Unknown::of_fault)) {
            let found = Adjustable::from(Motor::from([1.0; 4])).with(unknown, 0.25).get(unknown);
            assert!((found - 0.25).abs() < 1e-15, "{unknown:?}");
        }
    }
}

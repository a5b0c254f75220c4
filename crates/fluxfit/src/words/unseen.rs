//! What no log shows, as half a sentence: the error, and what it does.

use super::digits::{list, percent};
use crate::{
    characteristics::Instrument,
    identification::explain::unseen::{Counted, Unseen, UnseenError},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

impl Display for UnseenError {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(match self {
            Self::CurrentGain => "all currents read 1 % too large",
            Self::BusVoltage => "the DC voltage read 1 % too large",
            Self::SpeedScale => "the speed read 1 % too large, with no angle to confirm it",
            Self::AngleWithLoad => "an angle 1 degree too large at full load, in proportion to it",
            Self::Temperature => "a winding 10 K warmer in the log than in use",
        })
    }
}

impl Display for Instrument {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.pad(match self {
            Self::DutyScale => "a duty of 1 that is u_dc / 2, not u_dc / sqrt 3",
            Self::Voltage => "all voltages read 1 % too large",
            Self::Current => "all currents read 1 % too large",
            Self::Torque => "all torques read 1 % too large",
        })
    }
}

impl Display for Unseen {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let mut moved: Vec<(f64, Vec<&str>)> = Vec::new();
        for (parameter, fraction) in Parameter::ALL.into_iter().zip(self.moves).filter(|(_, fraction)| *fraction != 0.0) {
            match moved.iter_mut().find(|(other, _)| *other == fraction) {
                Some((_, symbols)) => symbols.push(parameter.symbol()),
                None => moved.push((fraction, vec![parameter.symbol()])),
            }
        }
        let effects: Vec<String> = moved
            .iter()
            .map(|(fraction, symbols)| format!("{} {}{}", list(symbols), if *fraction < 0.0 { "-" } else { "+" }, percent(fraction.abs())))
            .collect();
        write!(f, "{}: {}", self.error, effects.join(", "))
    }
}

impl Display for Counted {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let accuracy = percent(self.accuracy);
        match self.error {
            UnseenError::CurrentGain => write!(f, "all currents read up to {accuracy} too large or too small"),
            UnseenError::BusVoltage => write!(f, "the DC voltage read up to {accuracy} too large or too small"),
            UnseenError::SpeedScale | UnseenError::AngleWithLoad | UnseenError::Temperature => write!(f, "{}", self.error),
        }
    }
}

//! `--alarm rs=+20%`: a parameter that leaves a band around its start.

use fluxfit::{Parameter, motor::PARAMETERS};
use fluxfit_track::{Tracked, Verdict};
use fluxfit_units::{key_value, significant};
use std::fmt;

/// A band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Alarm {
    parameter: Parameter,
    /// Largest fall and rise, as parts of the start.
    fall: Option<f64>,
    rise: Option<f64>,
}

/// `rs=+20%`, `psi_f=-5%`, or `lq=10%` for both directions.
pub(crate) fn parse(text: &str) -> Result<Alarm, String> {
    let (key, change) = key_value(text, "PARAMETER=CHANGE", "rs=+20%").map_err(|error| error.to_string())?;
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.key().eq_ignore_ascii_case(key));
    let known = || format!("\"{key}\" is not a parameter; the parameters are rs, ld, lq and psi_f");
    let parameter = parameter.ok_or_else(known)?;
    let is_of_both = change.starts_with("+-") || change.starts_with("+/-");
    let is_signed = |sign: char| change.starts_with(sign) && !is_of_both;
    let size = if is_signed('+') || is_signed('-') { &change[1..] } else { change };
    let part = fluxfit_units::parse_fraction(size).map_err(|error| error.to_string())?;
    if part >= 1.0 && !size.contains('%') {
        return Err(format!(
            "a change of {size} is {} % of the start; write \"{key}={change}%\" for percent",
            significant(100.0 * part, 3)
        ));
    }
    Ok(Alarm { parameter, fall: (!is_signed('+')).then_some(part), rise: (!is_signed('-')).then_some(part) })
}

/// A parameter that has left its band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// The parameter.
    pub parameter: Parameter,
    /// When, s.
    pub t: f64,
    /// Its value then, SI.
    pub value: f64,
    /// The value around which the band lies.
    pub start: f64,
}

impl fmt::Display for Left {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { parameter, t, value, start } = self;
        let change = 100.0 * (value / start - 1.0);
        let (symbol, unit) = (parameter.symbol(), parameter.unit());
        let [value, start] = [value, start].map(|value| significant(*value, 4));
        write!(f, "{symbol} is {value} {unit}, {change:+.1} % from {start}, at t = {t:.3} s")
    }
}

/// All bands, and whether one was left.
#[derive(Debug)]
pub(crate) struct Watch {
    alarms: Vec<(Alarm, bool)>,
    /// The values around which the bands lie.
    starts: [Option<f64>; PARAMETERS],
}

impl Watch {
    pub(crate) fn new(alarms: &[Alarm], starts: &[Option<f64>; PARAMETERS]) -> Self {
        Self { alarms: alarms.iter().map(|alarm| (*alarm, false)).collect(), starts: *starts }
    }

    /// The parameters that have left their band since the last look, once for each band. One whose interval reaches into it has not.
    pub(crate) fn look(&mut self, t: f64, parameters: &[Tracked; PARAMETERS]) -> Vec<Left> {
        let mut left = Vec::new();
        for (alarm, has_rung) in self.alarms.iter_mut().filter(|(_, has_rung)| !has_rung) {
            let now = &parameters[alarm.parameter as usize];
            let Some(value) = now.value else { continue };
            let start = match self.starts[alarm.parameter as usize] {
                Some(start) => start,
                None if now.verdict == Verdict::Identified => *self.starts[alarm.parameter as usize].insert(value),
                None => continue,
            };
            let margin = now.half_width().unwrap_or(0.0);
            let is_above = alarm.rise.is_some_and(|rise| value - margin > start * (1.0 + rise));
            let is_below = alarm.fall.is_some_and(|fall| value + margin < start * (1.0 - fall));
            if is_above || is_below {
                *has_rung = true;
                left.push(Left { parameter: alarm.parameter, t, value, start });
            }
        }
        left
    }

    pub(crate) fn has_rung(&self) -> bool {
        self.alarms.iter().any(|(_, has_rung)| *has_rung)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rung(alarm: &str, value: f64, error: f64) -> bool {
        let mut watch = Watch::new(&[parse(alarm).unwrap()], &[Some(1.0), None, None, None]);
        let tracked = Tracked { value: Some(value), standard_error: Some(error), verdict: Verdict::Identified };
        watch.look(1.0, &[tracked; 4]);
        watch.has_rung()
    }

    #[test]
    fn a_band_is_left_when_the_whole_interval_has() {
        assert!(rung("rs=+20%", 1.25, 0.01) && !rung("rs=+20%", 1.21, 0.01) && !rung("rs=+20%", 0.5, 0.01));
        assert!(rung("rs=-5%", 0.9, 0.01) && !rung("rs=-5%", 1.5, 0.01));
        assert!(rung("rs=10%", 0.8, 0.01) && rung("rs=±10%", 1.2, 0.01) && rung("rs=+-10%", 0.8, 0.01) && !rung("rs=10%", 1.05, 0.01));
        assert!(parse("x=1%").is_err() && parse("rs=").is_err() && parse("rs=+x").is_err() && parse("rs=--5%").is_err());
        // 20 is meant as percent; a part of the value, or more than all of it in percent, is as it stands.
        assert!(parse("rs=20").unwrap_err().contains("\"rs=20%\"") && parse("rs=0.2").is_ok() && parse("rs=+150%").is_ok());
    }
}

//! Formatting of numbers for a terminal or a page: with the SI prefix that fits, and no more digits than are known. Parsing is in
//! [`quantity`](crate::quantity).

use fluxfit::{faults::Fault, motor::Parameter, objective::adjustable::Unknown};

/// Prefixes by power of ten.
const PREFIXES: [(i32, &str); 5] = [(3, "k"), (0, ""), (-3, "m"), (-6, "u"), (-9, "n")];

/// A unit with its prefix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    factor: f64,
    prefix: &'static str,
}

impl Scale {
    /// The prefix that leaves `value` one to three digits before the decimal point. Resistances and flux linkages keep no prefix down
    /// to a tenth, as data sheets print them.
    pub fn for_value(parameter: Parameter, value: f64) -> Self {
        let smallest = match parameter {
            Parameter::Rs | Parameter::PsiF => 0.1,
            Parameter::Ld | Parameter::Lq => 1.0,
        };
        let fits = |power: i32| value.abs() >= 10.0_f64.powi(power) * if power == 0 { smallest } else { 1.0 };
        let (power, prefix) = PREFIXES.into_iter().find(|(power, _)| fits(*power)).unwrap_or((0, ""));
        Self { factor: 10.0_f64.powi(power), prefix }
    }

    /// The unit with its prefix.
    pub fn unit(&self, unit: &str) -> String {
        format!("{}{unit}", self.prefix)
    }

    /// A value with the digits up to the second significant one of its standard error; with four significant digits where that is zero.
    pub fn format(&self, value: f64, standard_error: f64) -> String {
        let known = if standard_error > 0.0 { standard_error / self.factor } else { value.abs() / self.factor * 1e-2 };
        // Two digits of the error; no more than twelve, whatever the error is.
        let decimals = if known > 0.0 { (1 - known.log10().floor() as i32).clamp(0, 12) } else { 0 };
        format!("{:.*}", decimals as usize, value / self.factor)
    }
}

/// A fitted quantity of the drive (dead time, angle offset, ..) with its margin: value, margin and unit as texts. Angles are in degrees,
/// ratios in percent, everything else has the prefix that fits. Of an interval that reaches beyond what is possible, the possible part.
pub fn format_unknown(unknown: Unknown, value: f64, margin: f64) -> [String; 3] {
    let (value, margin) = within(unknown.possible(), value, margin);
    let (factor, unit) = match (unknown.fault(), unknown.unit()) {
        (Some(Fault::Disturbance), _) => (1.0, String::new()),
        (_, "rad") => (1.0_f64.to_radians(), "deg".to_owned()),
        (_, "1") => (1e-2, "%".to_owned()),
        (_, unit) => {
            let largest = value.abs().max(margin);
            let (power, prefix) = PREFIXES.into_iter().find(|(power, _)| largest >= 10.0_f64.powi(*power)).unwrap_or((0, ""));
            (10.0_f64.powi(power), format!("{prefix}{unit}"))
        }
    };
    let (value, margin) = (value / factor, margin / factor);
    // Two digits of the margin; four of the value where there is none.
    let digit = if margin > 0.0 && margin.is_finite() { margin } else { value.abs() * 1e-2 };
    let decimals = if digit > 0.0 { (1 - digit.log10().floor() as i32).clamp(0, 12) as usize } else { 0 };
    [format!("{value:.decimals$}"), format!("{margin:.decimals$}"), unit]
}

/// The part of an interval that lies within limits, as its middle and half its width.
fn within([least, most]: [f64; 2], value: f64, margin: f64) -> (f64, f64) {
    let (low, high) = (value - margin, value + margin);
    let (low_possible, high_possible) = (low.clamp(least, most), high.clamp(least, most));
    if (low, high) == (low_possible, high_possible) || !margin.is_finite() {
        return (value, margin);
    }
    (0.5 * (low_possible + high_possible), 0.5 * (high_possible - low_possible))
}

/// A number in three digits, or as 1.2e-8 where it is smaller than 0.01 or larger than 10 000.
pub fn small(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        v if (1e-2..1e4).contains(&v.abs()) => significant(v, 3),
        v => format!("{v:.1e}"),
    }
}

/// A number with `digits` significant digits, without an exponent.
pub fn significant(value: f64, digits: i32) -> String {
    let decimals = if value == 0.0 { 0 } else { (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 12) };
    format!("{value:.*}", decimals as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_get_their_prefix_and_their_digits() {
        let show = |parameter: Parameter, value: f64, error: f64| {
            let scale = Scale::for_value(parameter, value);
            format!("{} {}", scale.format(value, error), scale.unit(parameter.unit()))
        };
        assert_eq!(show(Parameter::Rs, 0.96097, 0.0031), "0.9610 ohm");
        assert_eq!(show(Parameter::Rs, 0.01823, 0.0011), "18.2 mohm");
        assert_eq!(show(Parameter::Ld, 5.2458e-3, 1.8e-5), "5.246 mH");
        assert_eq!(show(Parameter::Lq, 2.41e-4, 1.1e-6), "241.0 uH");
        assert_eq!(show(Parameter::PsiF, 0.18262, 0.00017), "0.18262 Wb");
        assert_eq!(show(Parameter::PsiF, 0.00344, 0.0), "3.440 mWb");
        assert_eq!(show(Parameter::Rs, 0.0, 0.0), "0 ohm");
    }

    #[test]
    fn fitted_quantities_of_the_drive_have_customary_units() {
        let unknown = |key: &str| Fault::ALL.into_iter().flat_map(Unknown::of_fault).find(|unknown| unknown.key() == key).unwrap();
        let show = |key: &str, value, margin| format_unknown(unknown(key), value, margin).join(" ");
        // 2 us of 100 us at 310 V are 6.2 V; 3 degrees are 0.05236 rad.
        assert_eq!(show("dead_time_voltage", 6.2, 0.012), "6.200 0.012 V");
        assert_eq!(show("angle_offset", 0.052_36, 1.746e-4), "3.000 0.010 deg");
        assert_eq!(show("current_offset_alpha", -0.0213, 0.0011), "-21.3 1.1 mA");
        assert_eq!(show("current_imbalance_beta", 0.0123, 0.0002), "1.230 0.020 %");
        assert_eq!(show("saturation_d", -2.5e-5, 4e-6), "-25.0 4.0 uH/A");
        assert_eq!(show("observer_gain_q", 0.25, 0.013), "0.250 0.013 ");
        assert_eq!(show("dead_time_voltage", 0.0, 0.0), "0 0 V");
        // Of 42 to 180 % only 42 to 100 % are possible of a part.
        assert_eq!(show("noise_before_filter", 1.11, 0.69), "71 29 %");
        assert_eq!(show("noise_before_filter", 0.5, 0.1), "50 10 %");
    }

    #[test]
    fn small_numbers() {
        assert_eq!(small(1.234e-8), "1.2e-8");
        assert_eq!(small(0.5), "0.500");
        assert_eq!(small(1817.63), "1818");
        assert_eq!(small(0.0), "0");
    }
}

//! Arguments of the form `key=value`: `rs=0.96±1%`, `ld=0:50mH`; and the time window `0.48:0.595`.

use crate::{
    error::{Problem, ValueError},
    quantity::{Dimension, parse_pair, parse_quantity, split},
    wording::nearest,
};
use fluxfit::{TimeWindow, motor::Parameter};

/// `rs=0.96`: a parameter with a known value, in SI units.
///
/// # Errors
/// If the key is not a parameter, or the value is negative or not a finite number of its dimension.
pub fn parse_fix(text: &str) -> Result<(Parameter, f64), ValueError> {
    let (parameter, value) = parameter_and_value(text, "PARAMETER=VALUE", "rs=0.96")?;
    let number = parse_quantity(value, Dimension::of(parameter))?;
    if number < 0.0 { Err(out_of_range(value, "zero or more")) } else { Ok((parameter, number)) }
}

/// `rs=0.96±1%` or `rs=0.96±0.01`, with `±`, `+-` or `+/-`: a parameter, its value, and **one standard error** (k = 1: 68 % of a
/// normal distribution), both in SI units.
///
/// # Errors
/// As [`parse_fix`], or if there is no `±`, the uncertainty is not above zero, or only one of the two numbers has a unit.
pub fn parse_prior(text: &str) -> Result<(Parameter, f64, f64), ValueError> {
    const FORM: (&str, &str) = ("PARAMETER=VALUE±UNCERTAINTY", "rs=0.96±1%");
    let (parameter, value) = parameter_and_value(text, FORM.0, FORM.1)?;
    let sides = PLUS_MINUS.into_iter().find_map(|sign| value.split_once(sign));
    let (left, right) = sides.ok_or_else(|| form(text, FORM.0, FORM.1))?;
    let dimension = Dimension::of(parameter);
    let (number, standard_error) = match right.trim().strip_suffix('%') {
        Some(percent) => {
            let number = parse_quantity(left, dimension)?;
            let percent = plain(percent).ok_or_else(|| dimension.refusal(right))?;
            // The sign stays with the percentage: a negative one is refused below.
            (number, number.abs() * percent / 100.0)
        }
        None => parse_pair(value, left, right, dimension)?,
    };
    if number < 0.0 {
        return Err(out_of_range(left, "zero or more"));
    }
    if standard_error > 0.0 && standard_error.is_finite() {
        Ok((parameter, number, standard_error))
    } else {
        Err(out_of_range(value, "a value with an uncertainty above zero"))
    }
}

/// How an uncertainty to either side begins.
const PLUS_MINUS: [&str; 3] = ["±", "+/-", "+-"];

/// A number without a unit.
fn plain(text: &str) -> Option<f64> {
    split(text).filter(|(_, rest)| rest.is_empty()).map(|(number, _)| number)
}

/// `1%`, `±1 %` or `0.01`: a fraction, zero or more.
///
/// # Errors
/// If the text is not a fraction, or it is negative.
pub fn parse_fraction(text: &str) -> Result<f64, ValueError> {
    let size = PLUS_MINUS.into_iter().find_map(|sign| text.trim().strip_prefix(sign)).unwrap_or(text).trim();
    let number = match size.strip_suffix('%') {
        Some(percent) => plain(percent).map(|percent| percent / 100.0),
        None => plain(size),
    };
    let number = number.ok_or_else(|| Problem::Fraction { text: text.trim().to_owned() })?;
    if number < 0.0 { Err(out_of_range(text, "zero or more")) } else { Ok(number) }
}

/// `-0.12%/K` or `-0.0012`: by which part of itself something changes per kelvin.
///
/// # Errors
/// If the text is not such a number.
pub fn parse_coefficient(text: &str) -> Result<f64, ValueError> {
    let trimmed = text.trim();
    let size = trimmed.strip_suffix('K').and_then(|rest| rest.trim().strip_suffix('/')).unwrap_or(trimmed).trim();
    let number = match size.strip_suffix('%') {
        Some(percent) => plain(percent).map(|percent| percent / 100.0),
        None => plain(size),
    };
    number.ok_or_else(|| form(trimmed, "a part per kelvin", "-0.12%/K"))
}

/// `ld=0:50mH`: a parameter, and its lower and upper bound in the search, in SI units.
///
/// # Errors
/// If the key is not a parameter, a bound is not a finite number of its dimension, only one bound has a unit (a zero needs none), or
/// the lower bound is not below the upper one.
pub fn parse_bounds(text: &str) -> Result<(Parameter, f64, f64), ValueError> {
    const FORM: (&str, &str) = ("PARAMETER=LOWER:UPPER", "ld=0:50mH");
    let (parameter, value) = parameter_and_value(text, FORM.0, FORM.1)?;
    let (lower, upper) = value.split_once(':').ok_or_else(|| form(text, FORM.0, FORM.1))?;
    let (lower, upper) = interval(value, lower, upper, Dimension::of(parameter))?;
    Ok((parameter, lower, upper))
}

/// `0.48:0.595`: start and end of a window, s.
///
/// # Errors
/// If an end is not a finite time, only one end has a unit (a zero needs none), or the start is not before the end.
pub fn parse_window(text: &str) -> Result<TimeWindow, ValueError> {
    let (start, end) = text.split_once(':').ok_or_else(|| form(text, "START:END in s", "0.48:0.595"))?;
    interval(text, start, end, Dimension::Time).map(|(from, to)| TimeWindow { from, to })
}

fn interval(text: &str, lower: &str, upper: &str, dimension: Dimension) -> Result<(f64, f64), ValueError> {
    let (low, high) = parse_pair(text, lower, upper, dimension)?;
    if low < high { Ok((low, high)) } else { Err(Problem::Interval { text: text.trim().to_owned() }.into()) }
}

/// The parameter, and the text of its value. Case does not matter in the key: simulators write `Rs`.
fn parameter_and_value<'a>(text: &'a str, shape: &'static str, example: &'static str) -> Result<(Parameter, &'a str), ValueError> {
    let (key, value) = key_value(text, shape, example)?;
    let known = Parameter::ALL.map(Parameter::key);
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.key().eq_ignore_ascii_case(key));
    match parameter {
        Some(parameter) => Ok((parameter, value)),
        None => Err(Problem::Parameter { name: key.to_owned(), known: known.to_vec(), nearest: nearest(key, known) }.into()),
    }
}

/// `500Hz` or `1 kHz`: a frequency above zero, in Hz.
///
/// # Errors
/// If the text is not a frequency above zero.
pub fn parse_frequency(text: &str) -> Result<f64, ValueError> {
    let hertz = parse_quantity(text, Dimension::Frequency)?;
    if hertz > 0.0 { Ok(hertz) } else { Err(out_of_range(text, "above zero")) }
}

/// Both sides of `key=value`, without spaces around them. `shape` and `example` say what is expected.
///
/// # Errors
/// If there is no `=` with text on both sides.
pub fn key_value<'a>(text: &'a str, shape: &'static str, example: &'static str) -> Result<(&'a str, &'a str), ValueError> {
    let pair = text.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
    pair.filter(|(key, value)| !key.is_empty() && !value.is_empty()).ok_or_else(|| form(text, shape, example))
}

fn form(text: &str, form: &'static str, example: &'static str) -> ValueError {
    Problem::Form { text: text.to_owned(), form, example }.into()
}

fn out_of_range(text: &str, range: &'static str) -> ValueError {
    Problem::Range { text: text.trim().to_owned(), range }.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_values() {
        assert_eq!(parse_fix("rs=0.96"), Ok((Parameter::Rs, 0.96)));
        assert_eq!(parse_fix("Ld = 5.25 mH"), Ok((Parameter::Ld, 5.25e-3)));
        assert_eq!(parse_fix("psi_f=0"), Ok((Parameter::PsiF, 0.0)));
        let refusal = |text| parse_fix(text).unwrap_err().to_string();
        assert_eq!(refusal("psi=1"), "\"psi\" is not a parameter; the parameters are rs, ld, lq and psi_f; did you mean psi_f?");
        assert_eq!(refusal("rs=-1"), "\"-1\" is out of range; it must be zero or more");
        assert_eq!(refusal("rs=nan"), "\"nan\" is not a resistance; write a number, in ohm or with its unit, as in \"0.958 ohm\"");
    }

    #[test]
    fn priors_carry_one_standard_error() {
        let close = |text: &str, value: f64, error: f64| {
            let (_, v, e) = parse_prior(text).unwrap();
            assert!((v - value).abs() < 1e-15 && (e - error).abs() < 1e-15, "{text}: {v} {e}");
        };
        close("rs=0.96±1%", 0.96, 0.0096);
        close("rs=0.96 +- 1 %", 0.96, 0.0096);
        close("rs=0.96+/-0.01", 0.96, 0.01);
        close("ld=5.25mH±50uH", 5.25e-3, 50e-6);
        close("ld=5.25mH±2%", 5.25e-3, 0.105e-3);
        let refusal = |text| parse_prior(text).unwrap_err().to_string();
        assert_eq!(refusal("rs=0.96"), "\"rs=0.96\" is not understood; write PARAMETER=VALUE±UNCERTAINTY, as in rs=0.96±1%");
        assert_eq!(refusal("ld=5.25±0.05mH"), "\"5.25±0.05mH\" has a unit on one number only; write it on both");
        for text in ["rs=0.96±0", "rs=0.96±-1%", "rs=0±1%", "rs=0.96±-0.01"] {
            let value = &text[3..];
            assert_eq!(refusal(text), format!("\"{value}\" is out of range; it must be a value with an uncertainty above zero"));
        }
        for text in ["rs=0.96±nan", "rs=0.96±inf", "rs=0.96±", "rs=±1%", "rs=0.96±1x%"] {
            assert!(refusal(text).contains("is not a resistance"), "{}", refusal(text));
        }
    }

    #[test]
    fn fractions_may_be_percentages() {
        for text in ["1%", "1 %", "±1%", "± 1 %", "+-1%", "+/-1%", "0.01", "±0.01", " 1e-2 "] {
            assert_eq!(parse_fraction(text), Ok(0.01), "{text}");
        }
        assert_eq!(parse_fraction("0"), Ok(0.0));
        let refusal = |text| parse_fraction(text).unwrap_err().to_string();
        for text in ["", "%", "one", "1 A", "1%%", "nan", "inf", "±"] {
            assert_eq!(refusal(text), format!("\"{text}\" is not a fraction; write a number or a percentage, as in 0.01 or 1%"), "{text}");
        }
        for text in ["-1", "±-1%"] {
            assert_eq!(refusal(text), format!("\"{text}\" is out of range; it must be zero or more"));
        }
    }

    #[test]
    fn a_coefficient_is_a_part_per_kelvin() {
        for text in ["-0.12%/K", "-0.12 %/K", "-0.12 % / K", "-0.12%", "-0.0012", "-1.2e-3/K"] {
            assert_eq!(parse_coefficient(text), Ok(-0.0012), "{text}");
        }
        assert_eq!(parse_coefficient("+0.4%/K"), Ok(0.004));
        for text in ["", "K", "-0.12%/C", "nan", "-0.12%/K/K"] {
            let sentence = format!("\"{text}\" is not understood; write a part per kelvin, as in -0.12%/K");
            assert_eq!(parse_coefficient(text).unwrap_err().to_string(), sentence);
        }
    }

    #[test]
    fn intervals_need_a_lower_and_an_upper_end() {
        assert_eq!(parse_bounds("ld=0:50mH"), Ok((Parameter::Ld, 0.0, 50e-3)));
        assert_eq!(parse_bounds("psi_f=-0.1:1"), Ok((Parameter::PsiF, -0.1, 1.0)));
        assert_eq!(parse_window("0.48:0.595"), Ok(TimeWindow { from: 0.48, to: 0.595 }));
        assert_eq!(parse_window("480 ms : 595 ms"), Ok(TimeWindow { from: 0.48, to: 0.595 }));
        assert_eq!(parse_bounds("ld=50mH:0H").unwrap_err().to_string(), "\"50mH:0H\" is not an interval; write the lower end first");
        assert_eq!(parse_bounds("ld=5:50mH").unwrap_err().to_string(), "\"5:50mH\" has a unit on one number only; write it on both");
        assert_eq!(parse_window("1:1").unwrap_err().to_string(), "\"1:1\" is not an interval; write the lower end first");
        assert_eq!(parse_window("1").unwrap_err().to_string(), "\"1\" is not understood; write START:END in s, as in 0.48:0.595");
        assert!(parse_window("0:inf").unwrap_err().to_string().contains("\"inf\" is not a time"));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*|(rs|ld|omega|t)=[0-9e.+\\-/±%:muH ]{0,14}") {
            let sentences = [
                parse_fix(&text).err(), parse_prior(&text).err(), parse_bounds(&text).err(), parse_window(&text).err(),
                parse_fraction(&text).err(), parse_coefficient(&text).err(),
            ];
            for sentence in sentences.into_iter().flatten() {
                prop_assert_eq!(sentence.to_string().lines().count(), 1);
            }
        }
    }
}

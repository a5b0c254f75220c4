//! Parsing of numbers with units: `5.25 mH`, `0.958 ohm`, `3000 rpm`, `12e-3`.
//!
//! A bare number is SI. The prefixes are u (µ), m and k, for frequencies M as well; upper and lower case matter in a prefix and
//! nowhere else.

use crate::error::{Problem, ValueError};
use fluxfit::motor::Parameter;
use std::f64::consts::{PI, TAU};

/// What a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// s.
    Time,
    /// V.
    Voltage,
    /// A.
    Current,
    /// rad/s: electrical in a log, mechanical in a rating.
    Speed,
    /// rad.
    Angle,
    /// ohm.
    Resistance,
    /// H.
    Inductance,
    /// Wb.
    FluxLinkage,
    /// Hz.
    Frequency,
    /// N m.
    Torque,
    /// kg m².
    Inertia,
    /// N m s.
    Friction,
    /// degC.
    Temperature,
    /// Without a unit.
    Ratio,
}

/// A spelling of a unit, its size in SI units, and whether it takes a prefix.
struct Spelling {
    text: &'static str,
    factor: f64,
    prefixed: bool,
}

const fn si(text: &'static str) -> Spelling {
    Spelling { text, factor: 1.0, prefixed: true }
}

const fn scaled(text: &'static str, factor: f64) -> Spelling {
    Spelling { text, factor, prefixed: false }
}

impl Dimension {
    /// The dimension of a parameter.
    pub fn of(parameter: Parameter) -> Self {
        match parameter {
            Parameter::Rs => Self::Resistance,
            Parameter::Ld | Parameter::Lq => Self::Inductance,
            Parameter::PsiF => Self::FluxLinkage,
        }
    }

    /// SI unit; of temperatures degC.
    pub fn si(self) -> &'static str {
        self.words().1
    }

    /// An example of a quantity, as it is written in TOML.
    pub fn example(self) -> &'static str {
        self.words().2
    }

    /// What a text should be, the SI unit, and an example.
    fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Time => ("a time", "s", "\"0.5 s\""),
            Self::Voltage => ("a voltage", "V", "\"180 V\""),
            Self::Current => ("a current", "A", "\"20 A\""),
            Self::Speed => ("a speed", "rad/s", "\"3000 rpm\""),
            Self::Angle => ("an angle", "rad", "\"90 deg\""),
            Self::Resistance => ("a resistance", "ohm", "\"0.958 ohm\""),
            Self::Inductance => ("an inductance", "H", "\"5.25 mH\""),
            Self::FluxLinkage => ("a flux linkage", "Wb", "\"0.1827 Wb\""),
            Self::Frequency => ("a frequency", "Hz", "\"5 kHz\""),
            Self::Torque => ("a torque", "N m", "\"10 N m\""),
            Self::Inertia => ("an inertia", "kg m2", "\"0.003 kg m2\""),
            Self::Friction => ("a friction", "N m s", "\"0.008 N m s\""),
            Self::Temperature => ("a temperature", "degC", "\"60 degC\""),
            Self::Ratio => ("a ratio", "1", "1.02"),
        }
    }

    fn spellings(self) -> &'static [Spelling] {
        match self {
            Self::Time => const { &[si("s")] },
            Self::Voltage => const { &[si("V")] },
            Self::Current => const { &[si("A")] },
            Self::Speed => const { &[scaled("rad/s", 1.0), scaled("rpm", TAU / 60.0), scaled("r/min", TAU / 60.0)] },
            Self::Angle => const { &[scaled("rad", 1.0), scaled("deg", PI / 180.0)] },
            // The letter omega and the ohm sign are two characters that look alike.
            Self::Resistance => const { &[si("ohm"), si("Ω"), si("\u{2126}")] },
            Self::Inductance => const { &[si("H")] },
            Self::FluxLinkage => const { &[si("Wb"), si("Vs"), si("V s")] },
            Self::Frequency => const { &[si("Hz")] },
            Self::Torque => const { &[si("N m"), si("Nm")] },
            Self::Inertia => {
                const {
                    &[
                        scaled("kg m2", 1.0),
                        scaled("kg m^2", 1.0),
                        scaled("kg m²", 1.0),
                        scaled("kg cm2", 1e-4),
                        scaled("kg cm^2", 1e-4),
                        scaled("kg cm²", 1e-4),
                        scaled("g cm2", 1e-7),
                        scaled("g cm^2", 1e-7),
                        scaled("g cm²", 1e-7),
                    ]
                }
            }
            Self::Friction => const { &[si("N m s"), si("Nm s"), si("Nms")] },
            Self::Temperature => const { &[scaled("degC", 1.0), scaled("°C", 1.0)] },
            Self::Ratio => &[],
        }
    }

    /// SI units in one `unit`.
    fn factor(self, unit: &str) -> Option<f64> {
        let spelled = |unit: &str, prefixed: bool| {
            let same = |spelling: &&Spelling| spelling.text.eq_ignore_ascii_case(unit) && (spelling.prefixed || !prefixed);
            self.spellings().iter().find(same).map(|spelling| spelling.factor)
        };
        spelled(unit, false).or_else(|| {
            let prefix = unit.chars().next()?;
            let factor = match prefix {
                'u' | 'µ' | 'μ' => 1e-6,
                'm' => 1e-3,
                'k' => 1e3,
                // Frequencies only: elsewhere M is a typing error for m.
                'M' if self == Self::Frequency => 1e6,
                _ => return None,
            };
            spelled(&unit[prefix.len_utf8()..], true).map(|_| factor)
        })
    }

    pub(crate) fn refusal(self, text: &str) -> ValueError {
        let (noun, si, example) = self.words();
        if self == Self::Ratio {
            return Problem::Ratio { text: text.trim().to_owned(), example }.into();
        }
        Problem::Quantity { text: text.trim().to_owned(), noun, si, example }.into()
    }
}

/// A number with or without a unit, in SI.
///
/// # Errors
/// If `text` is not a finite number, or its unit is not one of `dimension`.
pub fn parse_quantity(text: &str, dimension: Dimension) -> Result<f64, ValueError> {
    let (value, unit) = split(text).ok_or_else(|| dimension.refusal(text))?;
    in_si(value, unit, dimension).ok_or_else(|| dimension.refusal(text))
}

/// Two numbers of one dimension: the ends of an interval, or a value and its uncertainty. Either both have a unit or neither, unless
/// the first is zero: in `5:50mH` the unit of the 5 is unclear.
pub(crate) fn parse_pair(text: &str, first: &str, second: &str, dimension: Dimension) -> Result<(f64, f64), ValueError> {
    let ends = [first, second].map(|end| split(end).ok_or_else(|| dimension.refusal(end)));
    let [(a, unit_a), (b, unit_b)] = match ends {
        [Ok(a), Ok(b)] => [a, b],
        [Err(error), _] | [_, Err(error)] => return Err(error),
    };
    if unit_a.is_empty() != unit_b.is_empty() && !(a == 0.0 && unit_a.is_empty()) {
        return Err(Problem::OneSidedUnit { text: text.trim().to_owned() }.into());
    }
    let a = in_si(a, unit_a, dimension).ok_or_else(|| dimension.refusal(first))?;
    let b = in_si(b, unit_b, dimension).ok_or_else(|| dimension.refusal(second))?;
    Ok((a, b))
}

/// A finite number and the text behind it. `nan` and `inf` are not accepted.
pub(crate) fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let mut end = digits(sign(0));
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = sign(end + 1);
        if digits(exponent) > exponent {
            end = digits(exponent);
        }
    }
    let value: f64 = text[..end].parse().ok()?;
    value.is_finite().then_some((value, text[end..].trim()))
}

fn in_si(value: f64, unit: &str, dimension: Dimension) -> Option<f64> {
    let factor = if unit.is_empty() { 1.0 } else { dimension.factor(unit)? };
    // Dividing by a thousand is exact where multiplying by 0.001 is not: 12 mH is 0.012.
    let decimal = [1e-3, 1e-4, 1e-6, 1e-7].contains(&factor);
    let value = if decimal { value / factor.recip().round() } else { value * factor };
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn units_and_prefixes() {
        use Dimension::*;
        let cases = [
            ("5.25 mH", Inductance, 5.25e-3),
            ("5.25mH", Inductance, 5.25e-3),
            ("175 uH", Inductance, 175e-6),
            ("175 µH", Inductance, 175e-6),
            ("175 \u{3bc}H", Inductance, 175e-6),
            ("12e-3", Inductance, 12e-3),
            ("0.958 ohm", Resistance, 0.958),
            ("18 mΩ", Resistance, 18e-3),
            ("1.2 k\u{2126}", Resistance, 1200.0),
            (" .5 Ohm ", Resistance, 0.5),
            ("0.1827 Wb", FluxLinkage, 0.1827),
            ("55.15 mWb", FluxLinkage, 55.15e-3),
            ("55 mV s", FluxLinkage, 55e-3),
            ("20 A", Current, 20.0),
            ("-1.5e1kA", Current, -15e3),
            ("60 rpm", Speed, TAU),
            ("60 r/min", Speed, TAU),
            ("314 rad/s", Speed, 314.0),
            ("100 us", Time, 1e-4),
            ("180 deg", Angle, PI),
            ("5 kHz", Frequency, 5e3),
            ("1.5 MHz", Frequency, 1.5e6),
            ("20 mHz", Frequency, 0.02),
            ("10 Nm", Torque, 10.0),
            ("83 mN m", Torque, 0.083),
            ("0.003 kg m2", Inertia, 0.003),
            ("30 kg cm^2", Inertia, 0.003),
            ("213 g cm²", Inertia, 213e-7),
            ("8 mN m s", Friction, 0.008),
        ];
        for (text, dimension, value) in cases {
            assert_eq!(parse_quantity(text, dimension), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_refused_text_is_quoted_with_what_was_expected() {
        let sentence = |text| parse_quantity(text, Dimension::Inductance).unwrap_err().to_string();
        let expected = |text| format!("\"{text}\" is not an inductance; write a number, in H or with its unit, as in \"5.25 mH\"");
        for text in ["5 ohm", "5 MH", "mH", "", "nan", "inf", "-inf H", "1e999", "5,25 mH", "5 m", "5.25.1 H", "1 e", "0x10", "1e308 k"] {
            assert_eq!(sentence(text), expected(text));
        }
        assert!(parse_quantity("1 krpm", Dimension::Speed).is_err());
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*|[0-9eE.+\\-muµkHVs ]{0,12}") {
            for dimension in [Dimension::Inductance, Dimension::FluxLinkage, Dimension::Speed] {
                if let Ok(value) = parse_quantity(&text, dimension) {
                    prop_assert!(value.is_finite());
                }
            }
        }
    }
}

//! An answer where it is needed: as the file that another tool takes, in that tool's own names, units and conventions.
//!
//! A tool takes a number for known. So only identified parameters are exported; of a weak one, or where the pole pairs are missing,
//! there is a [`Refusal`] and no file. Each file begins with comments that give every value's 95 % interval, what it means there, and
//! which source says so. A new tool: a file here, and an arm in each match on [`Target`].

mod matlab;
mod mcsdk;
mod moteus;
mod vesc;

use fluxfit::{
    Verdict,
    current_loop::{CurrentLoop, Gain},
    evidence::Identification,
    motor::Parameter,
};
use fluxfit_units::{
    number::significant,
    wording::{list, one_line},
};
use std::f64::consts::TAU;

/// A tool that takes parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// VESC Tool: a motor configuration, XML.
    Vesc,
    /// moteus: commands that set its configuration.
    Moteus,
    /// ST's Motor Control SDK: lines of `pmsm_motor_parameters.h`.
    Mcsdk,
    /// Motor Control Blockset and Simscape: a script for MATLAB.
    Matlab,
}

/// What an export is made of.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// Names of the logs.
    pub logs: &'a [String],
    /// What they told.
    pub identification: &'a Identification,
    /// Pole pairs, if given.
    pub pole_pairs: Option<u32>,
    /// Gains of the current controllers, if asked for.
    pub current_loop: Option<&'a CurrentLoop>,
}

/// Why there is no file: one sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// A parameter that the tool would take for known is not.
    #[error(
        "{} {} not identified, and {} would take any number for known; {remedy}",
        list(.symbols), if .symbols.len() == 1 { "is" } else { "are" }, .target.tool()
    )]
    NotIdentified {
        /// For whom.
        target: Target,
        /// Which.
        symbols: Vec<&'static str>,
        /// What to do about the first one.
        remedy: String,
    },
    /// The tool's unit needs the pole pairs.
    #[error("{} needs the pole pairs for {what}; give --pole-pairs N, or --motor with pole_pairs", .target.tool())]
    PolePairs {
        /// For whom.
        target: Target,
        /// For what.
        what: &'static str,
    },
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Vesc, Self::Moteus, Self::Mcsdk, Self::Matlab];

    /// Name on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Vesc => "vesc",
            Self::Moteus => "moteus",
            Self::Mcsdk => "mcsdk",
            Self::Matlab => "matlab",
        }
    }

    /// Name in prose.
    pub fn tool(self) -> &'static str {
        match self {
            Self::Vesc => "VESC Tool",
            Self::Moteus => "moteus",
            Self::Mcsdk => "ST's Motor Control SDK",
            Self::Matlab => "MATLAB",
        }
    }

    /// The target of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.key() == name)
    }

    /// Parameters that the file has.
    pub fn parameters(self) -> &'static [Parameter] {
        match self {
            Self::Vesc | Self::Moteus | Self::Matlab => &Parameter::ALL,
            // Its header has no L_d.
            Self::Mcsdk => &[Parameter::Rs, Parameter::Lq, Parameter::PsiF],
        }
    }

    /// What needs the pole pairs; nothing, if all is electrical.
    fn of_pole_pairs(self) -> Option<&'static str> {
        match self {
            Self::Vesc => None,
            Self::Moteus => Some("Kv"),
            Self::Mcsdk => Some("the voltage constant"),
            Self::Matlab => Some("pmsm.p and the back-EMF constant"),
        }
    }

    /// Tells before anything is computed whether the pole pairs are missing.
    ///
    /// # Errors
    /// If they are.
    pub fn check_pole_pairs(self, pole_pairs: Option<u32>) -> Result<(), Refusal> {
        match self.of_pole_pairs() {
            Some(what) if pole_pairs.is_none() => Err(Refusal::PolePairs { target: self, what }),
            _ => Ok(()),
        }
    }
}

/// The file for a tool.
///
/// # Errors
/// If a parameter that it needs is not identified, or the pole pairs are missing.
pub fn export(target: Target, answer: &Answer) -> Result<String, Refusal> {
    let motor = Exported::of(target, answer)?;
    let file = match target {
        Target::Vesc => vesc::file(&motor),
        Target::Moteus => moteus::file(&motor),
        Target::Mcsdk => mcsdk::file(&motor),
        Target::Matlab => matlab::file(&motor),
    };
    let comments = comments(target, answer, &file);
    Ok(match target {
        Target::Vesc => vesc::text(&comments, &file.entries),
        Target::Moteus => moteus::text(&comments, &file.entries),
        Target::Mcsdk => mcsdk::text(&comments, &file.entries),
        Target::Matlab => matlab::text(&comments, &file.entries),
    })
}

/// A motor that may be exported. What a target does not need is whatever the log made of it.
struct Exported<'a> {
    rs: Quantity,
    ld: Quantity,
    lq: Quantity,
    psi_f: Quantity,
    /// Correlation of the errors of L_d and L_q.
    correlation: f64,
    /// Zero where the target does without.
    pole_pairs: u32,
    current_loop: Option<&'a CurrentLoop>,
}

/// A number and its 95 % interval.
#[derive(Debug, Clone, Copy)]
struct Quantity {
    value: f64,
    interval: [f64; 2],
}

/// What a file holds: values under the tool's names, and what to say beside them.
struct File {
    entries: Vec<Entry>,
    remarks: Vec<String>,
}

/// One value.
struct Entry {
    /// The tool's name for it.
    key: &'static str,
    value: Value,
    unit: &'static str,
    /// What it is there.
    meaning: &'static str,
    /// Which file says so.
    source: &'static str,
}

/// A number that the log told, or one that was given.
enum Value {
    Measured(Quantity),
    Given(f64),
    Count(u32),
}

impl<'a> Exported<'a> {
    fn of(target: Target, answer: &Answer<'a>) -> Result<Self, Refusal> {
        let found = answer.identification;
        let judgements = target.parameters().iter().map(|parameter| found.parameter(*parameter));
        let lacking: Vec<_> = judgements.filter(|judgement| judgement.verdict != Verdict::Identified).collect();
        if let Some(first) = lacking.first() {
            let remedy = first.remedy.as_ref().map_or_else(|| "give its value".to_owned(), ToString::to_string);
            return Err(Refusal::NotIdentified {
                target,
                symbols: lacking.iter().map(|judgement| judgement.parameter.symbol()).collect(),
                remedy,
            });
        }
        target.check_pole_pairs(answer.pole_pairs)?;
        let quantity = |parameter| {
            let judgement = found.parameter(parameter);
            Quantity { value: judgement.raw, interval: judgement.interval().unwrap_or([judgement.raw; 2]) }
        };
        Ok(Self {
            rs: quantity(Parameter::Rs),
            ld: quantity(Parameter::Ld),
            lq: quantity(Parameter::Lq),
            psi_f: quantity(Parameter::PsiF),
            correlation: found.correlation[Parameter::Ld as usize][Parameter::Lq as usize],
            pole_pairs: answer.pole_pairs.unwrap_or(0),
            current_loop: answer.current_loop,
        })
    }

    /// Peak voltage between two terminals, V, that the magnet induces at one mechanical turn in a second.
    fn line_to_line_peak_per_hz(&self) -> Quantity {
        self.psi_f.map(|psi_f| 3.0_f64.sqrt() * TAU * f64::from(self.pole_pairs) * psi_f)
    }
}

impl Quantity {
    /// A monotonic function of it.
    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let [a, b] = self.interval.map(&of);
        Self { value: of(self.value), interval: [a.min(b), a.max(b)] }
    }

    /// `a x + b y`, where the errors of `x` and `y` are correlated.
    fn combined([a, x]: [f64; 2], half_x: f64, [b, y]: [f64; 2], half_y: f64, correlation: f64) -> Self {
        let (of_x, of_y) = (a * half_x, b * half_y);
        // Rounding may leave a trace below zero where the errors cancel.
        let half = (of_x * of_x + of_y * of_y + 2.0 * correlation * of_x * of_y).max(0.0).sqrt();
        let value = a * x + b * y;
        Self { value, interval: [value - half, value + half] }
    }

    fn half_width(self) -> f64 {
        (self.interval[1] - self.interval[0]) / 2.0
    }

    /// `a self + b other`.
    fn plus(self, a: f64, b: f64, other: Self, correlation: f64) -> Self {
        Self::combined([a, self.value], self.half_width(), [b, other.value], other.half_width(), correlation)
    }
}

impl From<Gain> for Quantity {
    fn from(gain: Gain) -> Self {
        Self { value: gain.value, interval: gain.interval }
    }
}

impl Value {
    /// As all four tools read it.
    fn text(&self) -> String {
        match self {
            Self::Measured(Quantity { value, .. }) | Self::Given(value) => number(*value),
            Self::Count(count) => count.to_string(),
        }
    }
}

/// Significant digits after the first one: what a single-precision number needs to come back, as most of these tools store one.
const DIGITS: usize = 8;

/// A number as C, XML, MATLAB and moteus read it, with a decimal point or an exponent.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.DIGITS$e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}

/// Lines of the comment that a file begins with.
fn comments(target: Target, answer: &Answer, file: &File) -> Vec<String> {
    let found = answer.identification;
    let mut lines = vec![
        format!(
            "Parameters of a permanent magnet synchronous motor for {}, identified by fluxfit {}.",
            target.tool(),
            env!("CARGO_PKG_VERSION")
        ),
        format!("From {}; {}.", list(answer.logs), found.model.model.label()),
        "Resistance and inductances per phase of a star, at the temperature of the log; flux and voltages as each line says.".to_owned(),
    ];
    if !found.warnings.is_empty() {
        let codes: Vec<&str> = found.warnings.iter().map(|warning| warning.code()).collect();
        lines.push(format!("Warnings of the identification: {}.", list(&codes)));
    }
    lines.extend(file.remarks.iter().cloned());
    for Entry { key, value, unit, meaning, source } in &file.entries {
        lines.push(String::new());
        let (text, space) = (value.text(), if unit.is_empty() { "" } else { " " });
        lines.push(match value {
            Value::Measured(quantity) => format!("{key} = {text}{space}{unit}, {}", interval(quantity, unit)),
            Value::Given(_) | Value::Count(_) => format!("{key} = {text}{space}{unit}, given"),
        });
        lines.push(format!("  {meaning}"));
        lines.push(format!("  {source}"));
    }
    lines.iter().map(|line| one_line(line)).collect()
}

/// `95 % within 0.9546 .. 0.9599 ohm`; digits by the interval's width.
fn interval(quantity: &Quantity, unit: &str) -> String {
    let half = quantity.half_width();
    if half == 0.0 {
        return "given, not identified".to_owned();
    }
    // Three digits of the half-width.
    let digits = 3 + (quantity.value.abs() / half).log10().floor().max(0.0) as i32;
    let [low, high] = quantity.interval.map(|end| short(end, digits));
    format!("95 % within {low} .. {high} {unit}").trim_end().to_owned()
}

/// So many significant digits; with an exponent where that is shorter to read.
fn short(value: f64, digits: i32) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:.*e}", (digits - 1).max(0) as usize) } else { significant(value, digits) }
}

/// What is said of gains, where they are exported.
fn of_gains(current_loop: &CurrentLoop) -> String {
    format!(
        "Current controllers for a bandwidth of {} Hz, by pole cancellation: phase margin {:.0} degrees with 1.5 periods of delay at {} Hz.",
        significant(current_loop.bandwidth, 4),
        current_loop.phase_margin(),
        significant(current_loop.control_rate.0, 5),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_have_a_point_or_an_exponent_and_nine_digits() {
        let cases =
            [(3.0, "3.0"), (0.00525, "0.00525"), (2.35e-5, "2.35e-5"), (1.0 / 3.0, "0.333333333"), (-0.012, "-0.012"), (0.0, "0.0")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn intervals_show_the_digits_that_they_tell_apart() {
        let shown = |value: f64, half: f64| interval(&Quantity { value, interval: [value - half, value + half] }, "ohm");
        assert_eq!(shown(0.957_31, 0.0026), "95 % within 0.95471 .. 0.95991 ohm");
        assert_eq!(shown(1.2e-5, 1e-7), "95 % within 1.1900e-5 .. 1.2100e-5 ohm");
        assert_eq!(shown(0.96, 0.0), "given, not identified");
    }

    #[test]
    fn errors_that_are_one_cancel_in_a_difference_and_add_in_a_mean() {
        let at = |value: f64, half: f64| Quantity { value, interval: [value - half, value + half] };
        let (ld, lq) = (at(5.0, 0.3), at(12.0, 0.3));
        let difference = lq.plus(1.0, -1.0, ld, 1.0);
        assert!((difference.value - 7.0).abs() < 1e-12 && difference.half_width() < 1e-7, "{difference:?}");
        assert!((ld.plus(0.5, 0.5, lq, 1.0).half_width() - 0.3).abs() < 1e-12);
        // Independent: 0.5 hypot(0.3, 0.3).
        assert!((ld.plus(0.5, 0.5, lq, 0.0).half_width() - 0.212_132_034_355_964).abs() < 1e-12);
    }

    proptest! {
        /// Nine digits are a single-precision number's own: it comes back.
        #[test]
        fn what_is_written_is_the_same_single_precision_number(value in -1e6_f32..1e6) {
            prop_assert_eq!(number(f64::from(value)).parse::<f32>().unwrap(), value);
        }
    }
}

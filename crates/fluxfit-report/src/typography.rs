//! Typography of symbols, units and numbers: subscripts, Greek letters, minus signs.

use fluxfit::{evidence::FaultEstimate, motor::Parameter};
use fluxfit_units::{Scale, format_unknown, significant, small};
use maud::{Markup, PreEscaped, html};

/// Half-width of a 95 % interval in standard errors.
const HALF_WIDTH: f64 = 1.959_964;

/// Symbols: the plain text, its letter, its subscript.
const SYMBOLS: [(&str, &str, &str); 13] = [
    ("omega_e", "ω", "e"),
    ("psi_f", "ψ", "f"),
    ("psi_d", "ψ", "d"),
    ("psi_q", "ψ", "q"),
    ("R_s", "R", "s"),
    ("L_d", "L", "d"),
    ("L_q", "L", "q"),
    ("i_d", "i", "d"),
    ("i_q", "i", "q"),
    ("u_d", "u", "d"),
    ("u_q", "u", "q"),
    ("F_LS", "F", "LS"),
    ("F_LM", "F", "LM"),
];

/// A parameter's symbol.
pub(crate) fn symbol(parameter: Parameter) -> Markup {
    prose(parameter.symbol())
}

/// Units in sentences, without their prefix.
const UNITS: [&str; 9] = ["%", "A", "V", "s", "H", "Wb", "ohm", "Hz", "K"];

/// A sentence with typographic symbols, units and minus signs, and command-line options as code. Everything else is escaped.
pub(crate) fn prose(text: &str) -> Markup {
    let words: Vec<&str> = text.split(' ').collect();
    html! {
        @for (k, word) in words.iter().enumerate() {
            @let number = k.checked_sub(1).and_then(|before| words.get(before)).filter(|before| before.ends_with(|c: char| c.is_ascii_digit()));
            // A line does not break between a number and its unit, nor within `i_q = 15 A` and `2 ± 1`.
            @if let Some(unit) = number.and_then(|_| set_unit(word)) { (NO_BREAK) (unit) } @else {
                @if k > 0 { (space(words[k - 1], word)) }
                (set_word(word))
            }
        }
    }
}

/// The space between two words: signs stay on the line of both their neighbours.
fn space(before: &str, after: &str) -> &'static str {
    if [before, after].iter().any(|word| matches!(*word, "=" | "±")) { NO_BREAK } else { " " }
}

/// A space at which no line breaks.
pub(crate) const NO_BREAK: &str = "\u{a0}";

/// A unit with what follows it; none if the word is no unit.
fn set_unit(word: &str) -> Option<String> {
    let core = word.trim_end_matches(['.', ',', ';', ':', ')']);
    let bare = core.strip_prefix(['n', 'u', 'm', 'k']).filter(|bare| *bare != "%").unwrap_or(core);
    (UNITS.contains(&core) || UNITS.contains(&bare)).then(|| greek(core) + word.strip_prefix(core).unwrap_or_default())
}

/// A unit with Greek letters.
fn greek(unit: &str) -> String {
    let unit = unit.replace("ohm", "Ω");
    unit.strip_prefix('u').map(|rest| format!("µ{rest}")).unwrap_or(unit)
}

fn set_word(word: &str) -> Markup {
    const PUNCTUATION: [char; 6] = ['.', ',', ';', ':', ')', '('];
    // A word in quotes is the name of a column: it stays as it is.
    let core = word.trim_matches(PUNCTUATION);
    let (before, after) = word.split_once(core).unwrap_or((word, ""));
    let known = SYMBOLS.iter().find(|(name, ..)| *name == core && !core.is_empty());
    let negative = core.strip_prefix('-').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    html! {
        @if let Some((_, letter, index)) = known { (before) i { (letter) } sub { (index) } (after) }
        @else if core.starts_with("--") { (before) code { (core) } (after) }
        @else if let Some(number) = negative { (before) "\u{2212}" (number) (after) }
        @else { (word) }
    }
}

/// A name of a file, whose line breaks after a separator and not within a word or its ending.
pub(crate) fn breakable(name: &str) -> Markup {
    html! { @for part in name.split_inclusive(['_', '/', '-']) { (part) wbr; } }
}

/// Subscripts in SVG text, as shifted spans; a zero-width space returns to the baseline.
pub(crate) fn svg_subscripts(svg: &str) -> String {
    SYMBOLS.iter().fold(svg.to_owned(), |svg, (name, letter, index)| {
        let set = format!("{letter}<tspan dy=\"0.28em\" font-size=\"75%\">{index}</tspan><tspan dy=\"-0.21em\">\u{200b}</tspan>");
        svg.replace(name, &set)
    })
}

/// The unit of a parameter with a scale, with Greek letters.
pub(crate) fn unit(parameter: Parameter, scale: &Scale) -> String {
    greek(&scale.unit(parameter.unit()))
}

/// A number with a minus sign (not a hyphen), and without one before zero.
pub(crate) fn minus(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// A number, or a dash if it is not finite.
pub(crate) fn number(value: f64, show: impl FnOnce(f64) -> String) -> String {
    if value.is_finite() { minus(show(value)) } else { DASH.to_owned() }
}

/// Shown where there is no number.
pub(crate) const DASH: &str = "\u{2013}";

/// A small positive number, as 1.2·10⁻⁸ or in plain notation, whichever is easier to read.
pub(crate) fn power(value: f64) -> Markup {
    let text = number(value, small);
    match text.split_once('e') {
        Some((mantissa, exponent)) => html! { (mantissa) "·10" sup { (minus(exponent.to_owned())) } },
        None => PreEscaped(text),
    }
}

/// Decimals for two significant digits of an uncertainty; `least` without one.
pub(crate) fn decimals(uncertainty: f64, least: usize) -> usize {
    if uncertainty > 0.0 && uncertainty.is_finite() { (1.0 - uncertainty.log10().floor()).clamp(0.0, 9.0) as usize } else { least }
}

/// Decimals that resolve a hundredth of a time span, s.
pub(crate) fn decimals_of_span(span: f64) -> usize {
    (2.0 - span.log10().floor()).clamp(0.0, 9.0) as usize
}

/// A fraction in percent, two significant digits, without the sign.
pub(crate) fn percent(fraction: f64) -> String {
    number(100.0 * fraction, |percent| significant(percent, 2))
}

/// A current with the unit that suits it.
pub(crate) fn amperes(current: f64) -> String {
    let (factor, unit) = match current {
        c if c >= 1.0 => (1.0, "A"),
        c if c >= 1e-3 => (1e3, "mA"),
        _ => (1e6, "µA"),
    };
    format!("{}{NO_BREAK}{unit}", number(current, |current| significant(factor * current, 2)))
}

/// The value of a fault of the drive with its 95 % interval and unit.
pub(crate) fn fault(nuisance: &FaultEstimate) -> Markup {
    let [value, half_width, unit] = format_unknown(nuisance.unknown, nuisance.value, HALF_WIDTH * nuisance.standard_error);
    let unit = greek(&unit.replace("deg", "°"));
    html! { (minus(value)) (NO_BREAK) "±" (NO_BREAK) (half_width) @if !unit.is_empty() { (NO_BREAK) (unit) } }
}

/// A count, up to nine in words.
pub(crate) fn in_words(n: usize) -> String {
    const WORDS: [&str; 10] = ["none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"];
    WORDS.get(n).map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

/// A count with its noun.
pub(crate) fn count(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", if n == 0 { "no".to_owned() } else { in_words(n) }, if n == 1 { "" } else { "s" })
}

/// Text with a capital first letter.
pub(crate) fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The text as a sentence: with a capital letter, unless it begins with a symbol, and a full stop.
pub(crate) fn sentence(text: &str) -> String {
    let symbol = text.split(' ').next().is_some_and(|word| word.contains('_'));
    format!("{}.", if symbol { text.to_owned() } else { capitalized(text) })
}

/// A count with grouped thousands.
pub(crate) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        // Numbers of four digits are not grouped.
        if k > 0 && digits.len() > 4 && (digits.len() - k).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A list: `a, b and c`.
pub(crate) fn list(items: &[Markup]) -> Markup {
    html! {
        @for (k, item) in items.iter().enumerate() {
            @if k > 0 { @if k + 1 == items.len() { " and " } @else { ", " } }
            (item)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_get_typographic_symbols() {
        assert_eq!(
            prose("R_s, near -2 A (see --fix <b>)").into_string(),
            "<i>R</i><sub>s</sub>, near \u{2212}2\u{a0}A (see <code>--fix</code> &lt;b&gt;)"
        );
        assert_eq!(
            prose("falls from 221 to 126 uH, by 45 %: it is late by 45.6 us (tell us).").into_string(),
            "falls from 221 to 126\u{a0}µH, by 45\u{a0}%: it is late by 45.6\u{a0}µs (tell us)."
        );
        assert_eq!(
            prose("between i_q = 15 and 45 A, 2 ± 1 V").into_string(),
            "between <i>i</i><sub>q</sub>\u{a0}=\u{a0}15 and 45\u{a0}A, 2\u{a0}±\u{a0}1\u{a0}V"
        );
        assert_eq!(prose("").into_string(), "");
        assert_eq!(prose("...").into_string(), "...");
    }

    #[test]
    fn currents_have_a_suitable_unit() {
        assert_eq!([2.5, 0.0404, 1.9e-5].map(amperes), ["2.5\u{a0}A", "40\u{a0}mA", "19\u{a0}µA"]);
    }

    #[test]
    fn numbers_are_formatted() {
        assert_eq!((grouped(1234), grouped(1_234_567)), ("1234".to_owned(), "1\u{202f}234\u{202f}567".to_owned()));
        assert_eq!(minus("-0.00".to_owned()), "0.00");
        assert_eq!(number(f64::NAN, |v| v.to_string()), DASH);
        assert_eq!(power(1.2e-8).into_string(), "1.2·10<sup>\u{2212}8</sup>");
        assert_eq!((decimals(0.0041, 3), decimals(0.0, 3), decimals(f64::INFINITY, 3)), (4, 3, 3));
        assert_eq!(unit(Parameter::Ld, &Scale::for_value(Parameter::Ld, 2e-4)), "µH");
        assert_eq!(unit(Parameter::Rs, &Scale::for_value(Parameter::Rs, 0.01)), "mΩ");
    }
}

//! The command's options in Python's words: sentences are written once, for the command, and name its options.

/// Options whose argument is kept as it is, and their keyword.
const PLAIN: [(&str, &str); 12] = [
    ("--voltage-timing", "voltage_timing"),
    ("--voltage-accuracy", "voltage_accuracy"),
    ("--current-accuracy", "current_accuracy"),
    ("--bus-accuracy", "bus_accuracy"),
    ("--control-rate", "control_rate"),
    ("--bandwidth", "bandwidth"),
    ("--pole-pairs", "pole_pairs"),
    ("--mapping", "mapping"),
    ("--motor", "motor"),
    ("--model", "model"),
    ("--method", "method"),
    ("--dbc", "dbc"),
];

/// Options that become a dictionary.
const DICTIONARIES: [(&str, &str); 5] =
    [("--prior", "prior"), ("--fix", "fix"), ("--map", "mapping"), ("--unit", "unit"), ("--bounds", "bounds")];

/// A sentence in which each option is a keyword: `(--prior rs=VALUE±1%)` becomes `(prior={"rs": (VALUE, "1%")})`.
pub(crate) fn in_python(sentence: &str) -> String {
    let mut text = sentence.to_owned();
    for (option, keyword) in DICTIONARIES {
        text = replaced(&text, option, |argument| match argument {
            Some(pairs) => format!("{keyword}={{{}}}", pairs.split(',').map(pair).collect::<Vec<_>>().join(", ")),
            None => keyword.to_owned(),
        });
    }
    text = replaced(&text, "--window", |argument| match argument.and_then(|argument| argument.split_once(':')) {
        Some((from, to)) => format!("window=({from}, {to})"),
        None => "window".to_owned(),
    });
    for (option, keyword) in PLAIN {
        text = replaced(&text, option, |argument| match argument {
            Some(value) => format!("{keyword}={}", literal(value)),
            None => keyword.to_owned(),
        });
    }
    let shown = explained(&text);
    // Whatever is left has no keyword: its bare name.
    shown.replace("--", "")
}

/// `fluxfit --explain CODE` as a call.
fn explained(text: &str) -> String {
    let Some((before, after)) = text.split_once("fluxfit --explain ") else { return text.to_owned() };
    let end = after.find(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).unwrap_or(after.len());
    format!("{before}fluxfit.explain(\"{}\"){}", &after[..end], &after[end..])
}

/// Replaces an option and its argument, if one follows that is no word of the sentence.
fn replaced(text: &str, option: &str, write: impl Fn(Option<&str>) -> String) -> String {
    let mut result = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(option) {
        let after = &rest[at + option.len()..];
        // `--map` is not `--mapping`.
        if after.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '-') {
            result.push_str(&rest[..at + option.len()]);
            rest = after;
            continue;
        }
        result.push_str(&rest[..at]);
        let argument = after.strip_prefix([' ', '=']).map(|after| (&after[..end(after)], &after[end(after)..]));
        let argument = argument.filter(|(argument, _)| is_argument(argument));
        result.push_str(&write(argument.map(|(argument, _)| argument)));
        rest = argument.map_or(after, |(_, after)| after);
    }
    result + rest
}

/// Where an argument ends.
fn end(text: &str) -> usize {
    text.find([' ', ')', ';', '\'', '\n']).unwrap_or(text.len()).min(text.find(", ").unwrap_or(text.len()))
}

/// Whether a word is the argument of an option: a pair, a placeholder or a key of an option, not a word of the sentence.
fn is_argument(word: &str) -> bool {
    let is_placeholder = !word.is_empty() && word.chars().all(|c| c.is_ascii_uppercase() || "_.:0123456789".contains(c));
    is_placeholder || word.contains('=') || ["steady", "output-error", "auto"].contains(&word)
}

/// `rs=VALUE±1%` as an entry of a dictionary.
fn pair(text: &str) -> String {
    let Some((name, value)) = text.split_once('=') else { return literal(text) };
    match value.split_once('±') {
        Some((value, error)) => format!("\"{name}\": ({}, {})", literal(value), literal(error)),
        None => format!("\"{name}\": {}", literal(value)),
    }
}

/// A number or a placeholder as it is, anything else in quotes.
fn literal(text: &str) -> String {
    let is_bare = text.parse::<f64>().is_ok() || (!text.is_empty() && text.chars().all(|c| c.is_ascii_uppercase() || c == '_'));
    if is_bare { text.to_owned() } else { format!("\"{text}\"") }
}

//! Quotations and lists inside a sentence: short and on one line, whatever a file holds.

/// Longest quotation, in characters.
const QUOTATION: usize = 40;

/// Most column names of a file that a sentence lists.
const LISTED: usize = 20;

/// Smallest similarity, 0 to 1, at which a name is proposed for another: `psi_f` is for `psi` (0.6), `ud` is not for `speed` (0.2).
const SIMILAR: f64 = 0.5;

/// `text` in double quotes, shortened.
pub fn quote(text: &str) -> String {
    format!("\"{}\"", shorten(text))
}

/// The first characters of `text`, on one line.
pub fn shorten(text: &str) -> String {
    cut(text, QUOTATION)
}

fn cut(text: &str, most: usize) -> String {
    let mut short: String = text.chars().take(most).collect();
    if text.chars().nth(most).is_some() {
        short.push('…');
    }
    one_line(&short)
}

/// `text` with control characters, line breaks and marks of the writing direction escaped: what a file says can neither steer a terminal
/// nor turn a sentence around.
pub fn one_line(text: &str) -> String {
    let steers = |c: char| {
        c.is_control()
            || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}' | '\u{e0000}'..='\u{e007f}')
    };
    text.chars().flat_map(|c| if steers(c) { c.escape_default().collect() } else { vec![c] }).collect()
}

/// Characters of a name of a column in a list of them, which is there to be copied: paths of signals and names with numbers of parameters.
const NAME: usize = 80;

/// `a, b and c`.
pub fn list<S: AsRef<str>>(items: &[S]) -> String {
    join(items, "and")
}

/// `a, b or c`.
pub fn choice<S: AsRef<str>>(items: &[S]) -> String {
    join(items, "or")
}

fn join<S: AsRef<str>>(items: &[S], conjunction: &str) -> String {
    let items: Vec<&str> = items.iter().map(AsRef::as_ref).collect();
    match items.as_slice() {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [rest @ .., last] => format!("{} {conjunction} {last}", rest.join(", ")),
    }
}

/// Names of columns, each in single quotes; of a wide file the first ones only.
pub fn columns(names: &[String]) -> String {
    let named = names.iter().filter(|name| !name.is_empty());
    let mut shown: Vec<String> = named.clone().take(LISTED).map(|name| format!("'{}'", cut(name, NAME))).collect();
    let more = named.count().saturating_sub(LISTED);
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    list(&shown)
}

/// The candidate most similar to `wanted`, if any is similar enough.
pub fn nearest<'a>(wanted: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Longer names are compared by their beginning.
    let start = |name: &str| name.chars().take(QUOTATION).collect::<String>().to_lowercase();
    let wanted = start(wanted);
    let scored = candidates.into_iter().map(|candidate| (strsim::normalized_damerau_levenshtein(&wanted, &start(candidate)), candidate));
    scored.filter(|(score, _)| *score >= SIMILAR).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, candidate)| candidate)
}

/// `; did you mean x?`, or nothing.
pub fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean {}?", shorten(name))).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotation_stays_short_and_on_one_line() {
        assert_eq!(quote("a\nb\u{2028}"), "\"a\\nb\\u{2028}\"");
        assert_eq!(quote(&"ü".repeat(41)), format!("\"{}…\"", "ü".repeat(40)));
        assert_eq!(quote("a\u{202e}b\u{1b}[2J"), "\"a\\u{202e}b\\u{1b}[2J\"");
        assert_eq!(quote(&"x".repeat(40)), format!("\"{}\"", "x".repeat(40)));
    }

    #[test]
    fn lists_have_commas_and_a_conjunction() {
        assert_eq!(list::<&str>(&[]), "");
        assert_eq!(list(&["a"]), "a");
        assert_eq!(choice(&["a", "b", "c"]), "a, b or c");
        let names: Vec<String> = (0..23).map(|i| format!("c{i}")).collect();
        assert!(columns(&names).ends_with("'c18', 'c19' and 3 more"));
        // Names are there to be copied.
        let long = "SERVO_02.r1732[0] Spannungssollwert direkt [Veff]".to_owned();
        assert_eq!(columns(&[long.clone(), "ü".repeat(81)]), format!("'{long}' and '{}…'", "ü".repeat(80)));
    }

    #[test]
    fn the_most_similar_name_is_found() {
        assert_eq!(nearest("psi", ["rs", "psi_f"]), Some("psi_f"));
        assert_eq!(nearest("L_d", ["rs", "ld", "lq"]), Some("ld"));
        assert_eq!(nearest("temperature", ["rs", "ld"]), None);
    }
}

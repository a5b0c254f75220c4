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

/// Names of columns, each in single quotes; of a wide file the first ones only, and of the columns of a matrix the first and the last.
pub fn columns(names: &[String]) -> String {
    let named: Vec<&str> = names.iter().map(String::as_str).filter(|name| !name.is_empty()).collect();
    let quoted = |name: &str| format!("'{}'", cut(name, NAME));
    let entries: Vec<&[&str]> = named.chunk_by(|name, next| matrix(name).is_some_and(|of| matrix(next) == Some(of))).collect();
    let entries: Vec<&[&str]> =
        entries.into_iter().flat_map(|of| if of.len() < COLUMNS { of.chunks(1) } else { of.chunks(of.len()) }).collect();
    let show = |entry: &&[&str]| match entry {
        [first, .., last] => format!("{} to {}", quoted(first), quoted(last)),
        entry => entry.iter().map(|name| quoted(name)).collect(),
    };
    let mut shown: Vec<String> = entries.iter().take(LISTED).map(show).collect();
    let more: usize = entries.iter().skip(LISTED).map(|entry| entry.len()).sum();
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    list(&shown)
}

/// Fewest columns of one matrix that are listed as one entry.
const COLUMNS: usize = 3;

/// The matrix of which a name is a column: `psi` of `psi(:,3)`.
fn matrix(name: &str) -> Option<&str> {
    let (stem, index) = name.strip_suffix([')', ']'])?.rsplit_once(['(', '['])?;
    (!stem.is_empty() && index.contains(|c: char| c.is_ascii_digit()) && index.chars().all(|c| c.is_ascii_digit() || ":, ".contains(c)))
        .then_some(stem)
}

/// A name of a column, on one line and short: the middle is left out of a long one, for paths begin and units of signals end alike.
pub fn shorten_name(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= QUOTATION {
        return one_line(name);
    }
    let (first, last) = (QUOTATION / 2 - 1, letters.len() - QUOTATION / 2);
    one_line(&letters[..first].iter().chain(['…'].iter()).chain(&letters[last..]).collect::<String>())
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
    fn the_columns_of_a_matrix_are_one_entry() {
        let names = |all: &[&str]| all.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let wide = names(&["t", "psi(:,1)", "psi(:,2)", "psi(:,3)", "psi(:,4)", "v[0]", "v[1]", "x"]);
        assert_eq!(columns(&wide), "'t', 'psi(:,1)' to 'psi(:,4)', 'v[0]', 'v[1]' and 'x'");
        assert_eq!(columns(&names(&["I(A)", "I(B)", "I(C)"])), "'I(A)', 'I(B)' and 'I(C)'");
        assert_eq!(columns(&names(&["a(1)", "a(2)", "a(3)"])), "'a(1)' to 'a(3)'");
    }

    #[test]
    fn a_long_name_loses_its_middle() {
        let [d, q] = ["d", "q"].map(|axis| format!("axis0.motor.foc.v_current_control_integral_{axis}"));
        assert_eq!(shorten_name(&d), "axis0.motor.foc.v_c…t_control_integral_d");
        assert_ne!(shorten_name(&d), shorten_name(&q));
        assert_eq!(shorten_name(&d).chars().count(), QUOTATION);
        assert_eq!(shorten_name("a\u{202e}b"), "a\\u{202e}b");
    }

    #[test]
    fn the_most_similar_name_is_found() {
        assert_eq!(nearest("psi", ["rs", "psi_f"]), Some("psi_f"));
        assert_eq!(nearest("L_d", ["rs", "ld", "lq"]), Some("ld"));
        assert_eq!(nearest("temperature", ["rs", "ld"]), None);
    }
}

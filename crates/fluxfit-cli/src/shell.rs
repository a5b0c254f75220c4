//! Words as a shell takes them: for commands that a reader may copy.

use std::ffi::OsStr;

/// A word, in single quotes where it has to be.
pub(crate) fn word(word: &OsStr) -> String {
    const PLAIN: &str = "-_./,:=+@%±";
    let text = word.to_string_lossy();
    if !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || PLAIN.contains(c)) {
        return text.into_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// The words of a line whose words are written by [`word`].
pub(crate) fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted) = (Vec::new(), None::<String>, false);
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '\'' => {
                is_quoted = !is_quoted;
                word.get_or_insert_default();
            }
            '\\' if !is_quoted => word.get_or_insert_default().extend(letters.next()),
            ' ' if !is_quoted => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::{word, words};

    #[test]
    fn arguments_are_quoted_where_a_shell_would_break_them() {
        for (argument, expected) in
            [("rs=0.96±1%", "rs=0.96±1%"), ("my log.csv", "'my log.csv'"), ("it's", r"'it'\''s'"), ("$(rm -rf)", "'$(rm -rf)'"), ("", "''")]
        {
            assert_eq!(word(argument.as_ref()), expected);
            assert_eq!(words(&format!("a {expected}  b")), ["a", argument, "b"]);
        }
    }
}

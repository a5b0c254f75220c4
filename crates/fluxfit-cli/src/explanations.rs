//! `fluxfit --explain CODE`: a page for every code of a warning or finding, the same as in docs/codes.md.

use crate::{
    commands::Status,
    error::CommandError,
    terminal::{self, HEADING, wrapped},
};
use fluxfit_units::wording::{did_you_mean, list, nearest, quote};

/// The pages. A copy is docs/codes.md; a test holds them together.
const PAGES: &str = include_str!("explanations/codes.md");

/// What begins a page, before its code.
const TITLE: &str = "\n## ";

/// Code and text of each page.
fn pages() -> impl Iterator<Item = (&'static str, &'static str)> {
    PAGES.split(TITLE).skip(1).filter_map(|page| page.split_once('\n')).map(|(code, text)| (code.trim(), text.trim()))
}

/// The page of a code.
///
/// # Errors
/// If there is no such code.
pub(crate) fn text_of(code: &str) -> Result<&'static str, CommandError> {
    pages().find(|(other, _)| *other == code).map(|(_, text)| text).ok_or_else(|| {
        let codes: Vec<&str> = pages().map(|(code, _)| code).collect();
        let alike = did_you_mean(nearest(code, codes.iter().copied()));
        CommandError::Usage(format!("there is no code {}{alike}; the codes are {}", quote(code), list(&codes)))
    })
}

/// Prints the page of a code.
pub(crate) fn show(code: &str) -> Result<Status, CommandError> {
    let text = text_of(code)?;
    let paragraphs: Vec<String> = text.split("\n\n").map(paragraph).collect();
    terminal::print(&format!("{HEADING}{code}{HEADING:#}\n\n{}", paragraphs.join("\n")))?;
    Ok(Status::Complete)
}

/// A paragraph in lines of the terminal; examples, which are indented, as they are.
fn paragraph(text: &str) -> String {
    if text.starts_with("    ") {
        return format!("{text}\n");
    }
    // Later lines are not further in: these are no items.
    wrapped("", text).replace("\n  ", "\n")
}

#[cfg(test)]
mod tests {
    use super::pages;
    use fluxfit::{ColumnFinding, SampleFinding, Warning};

    #[test]
    fn every_code_has_a_page_and_every_page_a_code() {
        let codes: Vec<&str> = pages().map(|(code, _)| code).collect();
        assert_eq!(codes, [&ColumnFinding::CODES[..], &SampleFinding::CODES, &Warning::CODES].concat());
        assert!(pages().all(|(_, text)| text.len() > 100 && text.contains("What to do:")));
    }
}

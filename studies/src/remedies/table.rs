//! Promises kept, by kind of remedy, in Markdown.

use super::{Carried, FACTOR};
use fluxfit::Verdict;
use std::fmt::Write;

/// Counts of remedies that were carried out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Kept {
    /// Remedies.
    pub all: usize,
    /// Of them, those with a promised width.
    pub promised: usize,
    /// Of these, those whose width came out no wider than the factor allows.
    pub kept: usize,
    /// Of the promised ones, those whose width came out narrower by more than the factor.
    pub surpassed: usize,
    /// Of all, those after which the parameter is identified.
    pub identified: usize,
    /// Of all, those whose new interval holds the truth.
    pub held: usize,
}

impl Kept {
    /// Counts.
    pub fn of<'a>(carried: impl IntoIterator<Item = &'a Carried>) -> Self {
        let mut kept = Self::default();
        for one in carried {
            kept.all += 1;
            if let Some(ratio) = one.ratio() {
                kept.promised += 1;
                kept.kept += usize::from(ratio <= FACTOR);
                kept.surpassed += usize::from(ratio < 1.0 / FACTOR);
            }
            kept.identified += usize::from(one.after.as_ref().is_ok_and(|after| after.verdict == Verdict::Identified));
            kept.held += usize::from(one.holds());
        }
        kept
    }
}

/// A line for each kind, and one for all.
pub fn table(carried: &[Carried]) -> String {
    let mut kinds: Vec<&str> = carried.iter().map(|one| one.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut text = "| remedy | carried out | promised | kept | narrower | identified | holds |\n|---|--:|--:|--:|--:|--:|--:|\n".to_owned();
    let mut line = |name: &str, Kept { all, promised, kept, surpassed, identified, held }: Kept| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {name} | {all} | {promised} | {kept} | {surpassed} | {identified} | {held} |");
    };
    for kind in kinds {
        line(kind, Kept::of(carried.iter().filter(|one| one.kind == kind)));
    }
    line("all", Kept::of(carried));
    text
}

/// A line for each remedy: log, parameter, half-width before, promised, reached, error, remedy, why no better.
pub fn list(carried: &[Carried]) -> String {
    let mut text =
        "| log | | before, ±% | promised | reached | error | remedy | why no better |\n|---|---|--:|--:|--:|--:|---|---|\n".to_owned();
    for Carried { name, parameter, sentence, promised, before, after, .. } in carried {
        let percent = |value: f64| format!("{:.2}", 100.0 * value);
        let (reached, error, why) = match after {
            Ok(after) => (percent(after.half_width), percent(after.error), after.why.as_str()),
            Err(why) => ("-".to_owned(), "-".to_owned(), why.as_str()),
        };
        let (before, promised) = (percent(*before), promised.map_or("-".to_owned(), percent));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {name} | {} | {before} | {promised} | {reached} | {error} | {sentence} | {why} |", parameter.symbol());
    }
    text
}

//! What is said of a file that lacks columns of a log: what may be they, and what is said of others.

use fluxfit_units::Unit;
use fluxfit_units::wording::{columns, list, shorten};
use std::fmt;

/// Columns of line-to-line voltages in a file that lacks those of the phases.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LineToLine {
    /// Channels, and the columns that would be these but for the word.
    pub(crate) scaled: Vec<(&'static str, String)>,
    /// Voltages between two phases.
    pub(crate) pairs: Vec<String>,
}

/// Scale of a line-to-line voltage to that of a phase, 1 over sqrt 3.
const PHASE_OF_LINE: &str = "0.57735";

impl fmt::Display for LineToLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.scaled.is_empty() {
            let headers: Vec<String> = self.scaled.iter().map(|(_, header)| header.clone()).collect();
            let entry = |(channel, header): &(&str, String)| format!("{channel} = {{ column = {header:?}, scale = {PHASE_OF_LINE} }}");
            let entries: Vec<String> = self.scaled.iter().map(entry).collect();
            let (are, they) = if headers.len() == 1 {
                ("is a line-to-line voltage by its name", "it is")
            } else {
                ("are line-to-line voltages by their names", "they are")
            };
            write!(
                f,
                "; {} {are}: if {they} sqrt 3 times as large as of a phase, write into a mapping file {}",
                columns(&headers),
                list(&entries)
            )?;
        }
        if !self.pairs.is_empty() {
            write!(
                f,
                "; {} are line-to-line voltages by their names, and those of the phases are needed: compute ua = (2 uab + ubc) / 3, ub = (ubc - uab) / 3",
                columns(&self.pairs)
            )?;
        }
        Ok(())
    }
}

/// Channels that every log has.
const NEEDED: usize = 6;

/// Whether a file has fewer columns than it lacks, or none beside those that were found, and none that resembles one of the missing.
pub(crate) fn are_not_in_it(missing: &[&str], present: &[String], proposals: &[(&str, String)]) -> bool {
    let found = NEEDED.saturating_sub(missing.len());
    (present.len() < missing.len() || present.len() <= found) && proposals.is_empty()
}

/// Whether a file has the d axis and nothing of q, as a test at standstill.
pub(crate) fn has_d_alone(missing: &[&str]) -> bool {
    ["uq", "iq"].iter().all(|channel| missing.contains(channel)) && !["ud", "id"].iter().any(|channel| missing.contains(channel))
}

/// Columns of a table of a test bench: there are at least two, and not many.
const COLUMNS_OF_TABLE: std::ops::RangeInclusive<usize> = 2..=4;

/// Whether a file is so small that it may be a table of a test bench, whose rows have no time.
pub(crate) fn may_be_table(missing: &[&str], present: &[String]) -> bool {
    missing.contains(&"t") && COLUMNS_OF_TABLE.contains(&present.len())
}

/// What is said of such a file.
const OF_TABLE: &str = "; if it is a table of a test bench to identify from, map what it has: speed and voltage (open terminals), speed and current (shorted terminals), voltage and current (a direct one, at rest), or torque and current";

pub(crate) fn missing_columns(missing: &[&str], present: &[String], proposals: &[(&str, String)], equal: &[(&str, Vec<String>)]) -> String {
    let (noun, are, they_have, names) =
        if missing.len() == 1 { ("column", "is", "it has", "another name") } else { ("columns", "are", "they have", "other names") };
    let what = format!("the {noun} {} {are} missing; the file has {}", list(missing), columns(present));
    if has_d_alone(missing) && are_not_in_it(missing, present, proposals) {
        return format!(
            "{what}; of a rotor at rest with current along d alone they are zero: add them as columns of zeros; else log them too"
        );
    }
    let it = if missing.len() == 1 { "it" } else { "them" };
    if are_not_in_it(missing, present, proposals) {
        let of_table = if may_be_table(missing, present) { OF_TABLE } else { "" };
        return format!("{what}, too few other columns for {it} to be in it; log {it} too{of_table}");
    }
    if proposals.is_empty() {
        return format!("{what}; map {it} if {they_have} {names}, else log {it} too");
    }
    let pairs: Vec<String> = proposals.iter().map(|(channel, header)| format!("'{}' may be {channel}", shorten(header))).collect();
    let is_open = |channel: &&str| proposals.iter().all(|(of, _)| of != channel) && equal.iter().all(|(of, _)| of != channel);
    let rest: Vec<&str> = missing.iter().copied().filter(is_open).collect();
    let lacking = if rest.is_empty() { String::new() } else { format!("; no column resembles {}", list(&rest)) };
    let (by, if_so) = if pairs.len() == 1 { ("its name", "map it if it is") } else { ("their names", "map them if they are") };
    format!("{what}; by {by}, {}: {if_so}{lacking}", list(&pairs))
}

/// What is to be said of channels that the columns of several axes could be.
pub(crate) fn equal_axes(equal: &[(&str, Vec<String>)]) -> String {
    let say =
        |(channel, headers): &(&str, Vec<String>)| format!("; {} could each be {channel}: map the one of the motor", columns(headers));
    equal.iter().map(say).collect()
}

/// What a modulation of 1 is of the DC voltage at ODrive.
pub(crate) const MODULATION: &str = "0.66667";

/// What is to be said of columns that are the missing voltages, times the DC voltage.
pub(crate) fn shares(modulations: &[(&str, String)]) -> String {
    let entry =
        |(channel, header): &(&str, String)| format!("{channel} = {{ column = {header:?}, scale = {MODULATION}, times = \"u_dc\" }}");
    let entries: Vec<String> = modulations.iter().map(entry).collect();
    let headers: Vec<String> = modulations.iter().map(|(_, header)| header.clone()).collect();
    if entries.is_empty() {
        return String::new();
    }
    format!(
        "; {} are shares of the DC voltage by their names: write into a mapping file {}, with the scale 2/3 of ODrive, else 1/2 if 1 is half of u_dc, 0.57735 if u_dc / sqrt 3",
        columns(&headers),
        list(&entries)
    )
}

/// Of the columns that a log lacks beside the time at most so many may be open where the time between its rows would make it one.
const OPEN_BESIDE_TIME: usize = 1;

/// What to do where a log has no column of times.
pub(crate) fn without_time(missing: &[&str], proposals: &[(&str, String)]) -> String {
    let is_proposed = |channel: &str| proposals.iter().any(|(proposed, _)| *proposed == channel);
    let open = missing.iter().filter(|channel| !is_proposed(channel)).count();
    if !missing.contains(&"t") || is_proposed("t") || open > 1 + OPEN_BESIDE_TIME {
        return String::new();
    }
    "; if no column is the time and all rows are equally far apart, write the time between them into a mapping file, as in sample_period = \"0.1 ms\""
        .to_owned()
}

/// What is to be said of a proposed speed whose name says its unit.
pub(crate) fn speed_by_name(unit: Option<Unit>) -> String {
    unit.map_or_else(String::new, |unit| format!("; a speed of this name is usually in {}: state its unit", unit.prose()))
}

/// What is to be said of proposed columns that hold root mean squares.
pub(crate) fn proposed_rms(proposals: &[(&str, String)], rms: &[(&str, &str)]) -> String {
    let is_rms = |channel: &str| rms.iter().any(|(of, _)| *of == channel);
    let headers: Vec<&str> = proposals.iter().filter(|(channel, _)| is_rms(channel)).map(|(_, header)| header.as_str()).collect();
    if headers.is_empty() {
        return String::new();
    }
    format!("; {}, so state their units too, and check whether the others are rms values", are_rms(&headers))
}

pub(crate) fn are_rms(headers: &[&str]) -> String {
    let quoted: Vec<String> = headers.iter().map(|header| format!("'{}'", shorten(header))).collect();
    let are = if headers.len() == 1 { "is an rms value" } else { "are rms values" };
    format!("{} {are} by name, where dq values are peak values, sqrt 2 times as large", list(&quoted))
}

pub(crate) fn not_measured(references: &[String], unreadable: &[String], lists: &[String]) -> String {
    let of_references = match references {
        [] => String::new(),
        [one] => format!("; '{}' is a reference, not a measured current", shorten(one)),
        several => format!("; {} are references, not measured currents", columns(several)),
    };
    let of_others = match unreadable {
        [] => String::new(),
        [one] => format!("; '{}' holds no numbers", shorten(one)),
        several => format!("; {} hold no numbers", columns(several)),
    };
    let of_lists = match lists {
        [] => String::new(),
        _ => format!("; {}, where a log has one number for each instant", are_lists(lists)),
    };
    of_references + &of_others + &of_lists
}

pub(crate) fn are_lists(names: &[String]) -> String {
    let hold = if names.len() == 1 { "holds" } else { "hold" };
    format!("{} {hold} a list in each row", columns(names))
}

/// What to do with currents (`i`) or voltages (`u`) that are given by these columns of lengths and angles.
pub(crate) fn polar(vectors: &[(&str, [String; 2])]) -> String {
    let of_one = |(symbol, [length, angle]): &(&str, [String; 2])| {
        let (length, angle) = (shorten(length), shorten(angle));
        format!(
            "{symbol}d = -'{length}' sin '{angle}' and {symbol}q = '{length}' cos '{angle}' if it counts from the q axis (an advance angle), {symbol}d = '{length}' cos '{angle}' and {symbol}q = '{length}' sin '{angle}' if from the d axis"
        )
    };
    let all: Vec<String> = vectors.iter().flat_map(|(_, names)| names.clone()).collect();
    let formulas: Vec<String> = vectors.iter().map(of_one).collect();
    format!(
        "{} are lengths and angles of vectors by their names, and the values of the axes are needed, as columns of peak values: {}; rms values times sqrt 2",
        columns(&all),
        formulas.join("; ")
    )
}

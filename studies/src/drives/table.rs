//! Tables of many logs, in Markdown: by verdict, fault, number of faults, course and kind of log; then the worst numbers.

use super::{
    Drawn, Found, MOST_FAULTS,
    course::Course,
    fault::Fault,
    log_kind::LogKind,
    tally::{Number, Tally, binomial_limits},
};
use fluxfit::{Verdict, motor::Parameter};
use std::fmt::Write;

/// How many of the worst numbers are listed.
const WORST: usize = 20;

/// An identified number that is farther off than this is listed where a term was taken for a fault that is not there.
const FAR: f64 = 0.01;

/// Everything as Markdown.
pub fn tables(found: &[Found]) -> String {
    let faults = |count: usize| move |drawn: &Drawn| drawn.faults.len() == count;
    let mut text = head("all logs");
    text += &row("all", found, |_| true, |_| true);
    for (label, verdict) in [("identified", Verdict::Identified), ("weak", Verdict::Weak)] {
        text += &row(label, found, |_| true, |number| number.verdict == verdict);
    }
    text += &row("identified, without a fault", found, faults(0), |number| number.verdict == Verdict::Identified);
    for parameter in Parameter::ALL {
        text += &row(parameter.symbol(), found, |_| true, |number| number.parameter == parameter);
    }
    text += &head("by number of faults");
    for count in 0..=MOST_FAULTS as usize {
        text += &row(&count.to_string(), found, faults(count), |_| true);
    }
    text += &head("by fault, alone");
    for fault in Fault::ALL {
        text += &row(fault.label(), found, |drawn| drawn.faults == [fault], |_| true);
    }
    text += &head("by fault, alone or with others");
    for fault in Fault::ALL {
        text += &row(fault.label(), found, |drawn| drawn.faults.contains(&fault), |_| true);
    }
    text += &head("by course");
    for course in Course::ALL {
        text += &row(course.label(), found, |drawn| drawn.course == course, |_| true);
    }
    text += &head("by kind of log");
    for label in LogKind::LABELS {
        text += &row(label, found, |drawn| drawn.kind.label() == label, |_| true);
    }
    text += &worst("farthest off", found, |_| true);
    text + &worst("the same without a fault", found, faults(0)) + &false_terms(found) + &refused(found)
}

/// A line for each log: what was drawn, what was found, and error and half-width of each parameter in %.
pub fn list(found: &[Found]) -> String {
    let mut text =
        "| log | motor | course | kind | faults | terms | R_s, % | L_d | L_q | psi_f |\n|--:|--:|---|---|---|---|--:|--:|--:|--:|\n"
            .to_owned();
    for Found { drawn, numbers, terms, .. } in found {
        let number = |number: &Number| match number.verdict {
            Verdict::NotIdentifiable => "-".to_owned(),
            verdict => format!("{:+.2} ± {:.2} {}", 100.0 * number.error, 100.0 * number.half_width, verdict.key()),
        };
        let numbers = numbers.each_ref().map(number).join(" | ");
        let Drawn { index, rated, course, kind, .. } = drawn;
        let (faults, terms) = (faults_of(drawn), terms.join(", "));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {index} | {} | {} | {} | {faults} | {terms} | {numbers} |", rated.row, course.label(), kind.label());
    }
    text
}

/// The faults of a drive, in prose.
fn faults_of(drawn: &Drawn) -> String {
    if drawn.faults.is_empty() { "none".to_owned() } else { drawn.faults.iter().map(|fault| fault.label()).collect::<Vec<_>>().join(", ") }
}

fn head(title: &str) -> String {
    format!(
        "\n| {title} | logs | printed | of | wrong | wrong, % | intervals that hold, % | 95 % limits | half-width R_s, % | L_d | L_q | psi_f |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    )
}

/// A row of the logs and numbers that are asked for.
fn row(label: &str, found: &[Found], logs: impl Fn(&Drawn) -> bool, numbers: impl Fn(&Number) -> bool) -> String {
    let mut tally = Tally::default();
    let mut count = 0;
    for log in found.iter().filter(|log| logs(&log.drawn)) {
        count += 1;
        log.numbers.iter().filter(|number| numbers(number)).for_each(|number| tally.add(number));
    }
    let Tally { asked, printed, wrong, held, .. } = tally;
    let percent = |part: usize| if printed == 0 { "-".to_owned() } else { format!("{:.1}", 100.0 * part as f64 / printed as f64) };
    let [low, high] = binomial_limits(held, printed).map(|limit| 100.0 * limit);
    let limits = if printed == 0 { "-".to_owned() } else { format!("{low:.1} .. {high:.1}") };
    let width = |parameter| tally.median_half_width(parameter).map_or("-".to_owned(), |width| format!("{:.3}", 100.0 * width));
    let widths = Parameter::ALL.map(width).join(" | ");
    format!("| {label} | {count} | {printed} | {asked} | {wrong} | {} | {} | {limits} | {widths} |\n", percent(wrong), percent(held))
}

/// The wrong numbers that are farthest off, by the half-widths of their intervals.
fn worst(title: &str, found: &[Found], logs: impl Fn(&Drawn) -> bool) -> String {
    let all = found.iter().filter(|log| logs(&log.drawn)).flat_map(|log| log.numbers.iter().map(move |number| (log, number)));
    let mut wrong: Vec<(&Found, &Number)> = all.filter(|(_, number)| number.is_wrong()).collect();
    let excess = |number: &Number| number.error.abs() / number.half_width;
    wrong.sort_by(|(_, a), (_, b)| excess(b).total_cmp(&excess(a)));
    let mut text = format!(
        "\n| {title}: log | motor | course | kind | faults | | error, % | half-width, % | verdict |\n|--:|--:|---|---|---|---|--:|--:|---|\n"
    );
    for (log, number) in wrong.into_iter().take(WORST) {
        let Drawn { index, rated, course, kind, .. } = &log.drawn;
        let faults = faults_of(&log.drawn);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| {index} | {} | {} | {} | {faults} | {} | {:+.3} | {:.3} | {} |",
            rated.row,
            course.label(),
            kind.label(),
            number.parameter.symbol(),
            100.0 * number.error,
            100.0 * number.half_width,
            number.verdict.key(),
        );
    }
    text
}

/// How many logs without a fault have a term for one, and those of them where an identified number is far off.
fn false_terms(found: &[Found]) -> String {
    let perfect: Vec<&Found> = found.iter().filter(|log| log.drawn.faults.is_empty()).collect();
    let with_term: Vec<&Found> = perfect.iter().copied().filter(|log| !log.terms.is_empty()).collect();
    let farthest = |log: &Found| {
        let identified = log.numbers.iter().filter(|number| number.verdict == Verdict::Identified);
        identified.map(|number| number.error.abs()).fold(0.0, f64::max)
    };
    let far: Vec<String> = with_term
        .iter()
        .filter(|log| farthest(log) > FAR)
        .map(|log| {
            let Drawn { index, kind, .. } = &log.drawn;
            format!("- log {index} ({}): {}, {:.2} %\n", kind.label(), log.terms.join(", "), 100.0 * farthest(log))
        })
        .collect();
    format!(
        "\nOf {} logs without a fault {} have a term for one; in {} of these an identified number is more than {} % off.\n\n{}",
        perfect.len(),
        with_term.len(),
        far.len(),
        100.0 * FAR,
        far.concat()
    )
}

/// Logs without any answer, with the reason.
fn refused(found: &[Found]) -> String {
    let line =
        |log: &Found| log.refusal.as_ref().map(|error| format!("- log {}, motor {}: {error}\n", log.drawn.index, log.drawn.rated.row));
    let lines: String = found.iter().filter_map(line).collect();
    if lines.is_empty() { "\nEvery log has an answer.\n".to_owned() } else { format!("\nWithout an answer:\n\n{lines}") }
}

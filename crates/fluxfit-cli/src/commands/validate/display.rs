//! A validation, to be read at a glance: the verdict, what the log asks for instead, and how well each channel is predicted.

use crate::terminal::{self, BAD, DIM, GOOD, WARNING, table};
use anstyle::Style;
use fluxfit::{Validation, log::Log, validation::validate::Channel, validation::validate::Difference, validation::validate::Outcome};
use fluxfit_units::{Scale, significant, small};

/// Shows a validation; warnings go to standard error.
pub(crate) fn show(name: &str, motor: &str, log: &Log, found: &Validation) -> std::io::Result<()> {
    let style = style(found.outcome);
    let verdict = terminal::wrapped("", &found.verdict().to_string());
    let read = terminal::wrapped("", &format!("{motor} on {name}: {}", read(log, found)));
    terminal::print(&format!("{style}{}{style:#}\n{DIM}{}{DIM:#}\n", verdict.trim_end(), read.trim_end()))?;
    found.own.warnings.iter().for_each(terminal::warn);
    terminal::point_to_explanations(&found.own.warnings);
    let mut text = format!("\n{}", parameters(found));
    text += "\n";
    text += &channels(found);
    terminal::print(&text)
}

fn style(outcome: Outcome) -> Style {
    match outcome {
        Outcome::Agrees => GOOD,
        Outcome::DiffersLittle | Outcome::CannotTell => WARNING,
        Outcome::Contradicts => BAD,
    }
}

/// What was read and what is predicted, in one line.
fn read(log: &Log, found: &Validation) -> String {
    let seconds = significant(log.duration(), 3);
    let what = if found.own.output.is_some() { "currents simulated row by row" } else { "voltages of steady operating points" };
    format!("{} rows, {seconds} s; {what}", log.rows())
}

fn parameters(found: &Validation) -> String {
    let rows = found.parameters.iter().map(|difference| {
        let Difference { parameter, given, own, .. } = *difference;
        let scale = Scale::for_value(parameter, given);
        let mut row = vec![parameter.symbol().to_owned()];
        let Some(own) = own else {
            row.extend([scale.format(given, 0.0), "-".to_owned(), scale.unit(parameter.unit())]);
            row.extend([String::new(), String::new(), String::new(), "cannot tell".to_owned()]);
            return row;
        };
        row.extend([scale.format(given, own.standard_error), scale.format(own.value, own.standard_error), scale.unit(parameter.unit())]);
        let percent = |value: f64| format!("{} %", significant(100.0 * value / given, 2));
        let difference_percent =
            difference.percent().map_or(String::new(), |value| format!("{value:+.*} %", decimals(own.half_width / given)));
        row.extend([difference_percent, format!("±{}", percent(own.half_width))]);
        row.extend([difference.standard_errors().map_or(String::new(), |errors| format!("{errors:+.1}")), String::new()]);
        row
    });
    table(&["", "given", "the log", "", "difference", "95 %", "in standard\nerrors", ""], 1, rows)
}

/// Decimals of a percentage that show two digits of its uncertainty.
fn decimals(fraction: f64) -> usize {
    let percent = 100.0 * fraction.abs();
    if percent > 0.0 && percent.is_finite() { (1.0 - percent.log10().floor()).clamp(0.0, 6.0) as usize } else { 2 }
}

fn channels(found: &Validation) -> String {
    let rows = found.channels.iter().map(|channel| {
        let Channel { name, unit, rms, noise, explained, share, .. } = *channel;
        vec![
            name.to_owned(),
            format!("{} {unit}", small(rms)),
            format!("{} {unit}", small(noise)),
            channel.ratio().map_or("-".to_owned(), |ratio| significant(ratio, 3)),
            explained.map_or("-".to_owned(), |explained| format!("{} %", explained_percent(explained))),
            format!("{} %", small(100.0 * share)),
            channel.verdict().to_owned(),
        ]
    });
    table(&["", "missed by", "noise", "ratio", "explained", "differs by", ""], 1, rows)
}

/// As many nines as there are.
fn explained_percent(explained: f64) -> String {
    let decimals = decimals(1.0 - explained);
    format!("{:.decimals$}", 100.0 * explained)
}

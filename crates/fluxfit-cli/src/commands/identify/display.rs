//! An identification, to be read at a glance: what was read, the four parameters with their verdicts, why and what to do, and
//! what the swarm made of it.

use crate::terminal::{self, BAD, DIM, GOOD, HEADING, WARNING, frequency, options, table};
use fluxfit::{
    Answer, HeldOut, Judgement, Log, Parameter, Reason, Verdict,
    evidence::{FaultOutcome, Flux, Identification, ModelChoice, OutputFit, Provenance, SaturationFinding, SteadyFit},
    optimizer::Method,
};
use fluxfit_units::{Scale, format_unknown, significant, small};

/// Shows an identification; warnings go to standard error.
pub(crate) fn show(name: &str, answer: &Answer) -> std::io::Result<()> {
    let found = &answer.identification;
    let mut text = format!("{HEADING}{name}{HEADING:#}\n{}\n\n", read(&answer.log, found));
    text += &parameters(found);
    text += &explanations(found);
    text += &found.temperature.map(|temperature| format!("\n{}", wrapped("", &sentence(&temperature.to_string())))).unwrap_or_default();
    text += &unseen(found);
    text += &format!("\n{}\n", model(found));
    if let Some(fit) = &found.steady {
        let what = if found.output.is_some() {
            "Operating points (means), as a check: the residual is that of their own fit"
        } else {
            "Operating points (means)"
        };
        text += &format!("\n{DIM}{what}{DIM:#}\n{}", operating_points(fit));
    }
    if let Some(saturation) = &found.saturation {
        text += &fluxes(saturation);
    }
    let answered = found.parameters.iter().any(|judgement| judgement.value().is_some());
    if let Some(method) = found.method.as_ref().filter(|_| answered) {
        text += &format!("\n{}\n", search(found, method));
    }
    terminal::print(&text)?;
    found.warnings.iter().for_each(terminal::warn);
    answer.current_loop.as_ref().map(super::current_loop::show).transpose()?;
    match &answer.held_out {
        Some(HeldOut { log, validation: Some(validation), .. }) => {
            terminal::print("\n")?;
            crate::commands::validate::display::show("what was held out", "This answer", log, validation)
        }
        Some(HeldOut { validation: None, .. }) => {
            terminal::note("what was held out is not predicted: that takes all four parameters");
            Ok(())
        }
        None => {
            if answer.log.segments().len() > 1 {
                terminal::note(
                    "to test this answer on a part of the log that it was not found from: --hold-out; on another log: fluxfit validate",
                );
            }
            Ok(())
        }
    }
}

/// What was read, in one line.
fn read(log: &Log, found: &Identification) -> String {
    let periods: Vec<f64> = log.segments().iter().map(|segment| segment.sample_period).collect();
    let period = periods.first().copied().unwrap_or(f64::NAN);
    let rate =
        if periods.iter().any(|other| (other / period - 1.0).abs() > 0.01) { "mixed rates".to_owned() } else { frequency(1.0 / period) };
    let points = count(found.operating_points().len(), "operating point");
    let used = match &found.output {
        Some(fit) => format!("{} rows simulated, {points}", fit.residuals.len() / 2),
        None => format!("{points} with {} rows used", found.operating_points().iter().map(|point| point.rows.len()).sum::<usize>()),
    };
    format!("{} rows at {rate}, {} s in {}; {used}", log.rows(), significant(log.duration(), 3), count(log.segments().len(), "segment"),)
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn parameters(found: &Identification) -> String {
    let rows = found.parameters.iter().map(|judgement| {
        let (parameter, word) = (judgement.parameter, verdict(judgement.verdict));
        let symbol = parameter.symbol().to_owned();
        let (Some(value), Some([low, high])) = (judgement.value(), judgement.interval()) else {
            return vec![symbol, "-".to_owned(), String::new(), String::new(), String::new(), String::new(), word];
        };
        let (scale, error) = (Scale::for_value(parameter, value), judgement.uncertainty.standard_error());
        vec![
            symbol,
            scale.format(value, error),
            scale.unit(parameter.unit()),
            format!("±{} %", significant(100.0 * judgement.uncertainty.half_width / value.abs(), 2)),
            format!("{} .. {}", scale.format(low, error), scale.format(high, error)),
            if judgement.uncertainty.standard_error() > 0.0 { judgement.uncertainty.largest_part().label() } else { "given" }.to_owned(),
            word,
        ]
    });
    let plain = table(&["", "value", "", "95 %", "interval", "mostly from", "verdict"], 1, rows);
    // Colour after layout: escape codes have no width.
    plain
        .replace(verdict(Verdict::NotIdentifiable).as_str(), &format!("{BAD}not identifiable{BAD:#}"))
        .replace(" weak", &format!(" {WARNING}weak{WARNING:#}"))
        .replace(" identified", &format!(" {GOOD}identified{GOOD:#}"))
}

fn verdict(verdict: Verdict) -> String {
    verdict.key().replace('-', " ")
}

/// Reasons and remedies; parameters that share both share the lines.
fn explanations(found: &Identification) -> String {
    let mut shared: Vec<(Vec<&str>, &Judgement)> = Vec::new();
    for judgement in found.parameters.iter().filter(|judgement| judgement.reason.is_some()) {
        match shared.iter_mut().find(|(_, other)| other.reason == judgement.reason && other.remedy == judgement.remedy) {
            Some((symbols, _)) => symbols.push(judgement.parameter.symbol()),
            None => shared.push((vec![judgement.parameter.symbol()], judgement)),
        }
    }
    let mut text = String::new();
    for (symbols, judgement) in shared {
        let (symbols, reason) = (symbols.join(", "), judgement.reason.as_ref().map(Reason::to_string).unwrap_or_default());
        let lines = wrapped("", &format!("{symbols}: {reason}."));
        text += &format!("\n{HEADING}{symbols}{HEADING:#}{}", lines.strip_prefix(&symbols).unwrap_or(&lines));
        if let Some(remedy) = &judgement.remedy {
            text += &wrapped("  ", &format!("To do: {}.", options::with_option(&remedy.to_string(), options::of_remedy(remedy))));
        }
    }
    text
}

/// What no log shows: what the intervals count of it as stated, and what they do not.
fn unseen(found: &Identification) -> String {
    let line = |what: &str, errors: Vec<String>| {
        if errors.is_empty() { String::new() } else { wrapped("", &format!("{what}: {}.", errors.join("; "))) }
    };
    let counted = line("In the intervals, as stated", found.counted.iter().map(ToString::to_string).collect());
    let unseen = line("Not in the intervals, because no log shows it", found.unseen.iter().map(ToString::to_string).collect());
    if counted.is_empty() && unseen.is_empty() { String::new() } else { format!("\n{counted}{unseen}") }
}

/// Half a sentence as a whole one.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// Columns that a line of words may have.
const WIDTH: usize = 100;

/// Words in lines. The first line begins with `indent`, the others are two letters further in.
fn wrapped(indent: &str, text: &str) -> String {
    let mut lines = String::new();
    let mut line = indent.to_owned();
    for word in text.split(' ') {
        let starts = line.trim().is_empty();
        if !starts && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines += &format!("{line}\n");
            line = format!("{indent}  {word}");
        } else {
            line += &format!("{}{word}", if starts { "" } else { " " });
        }
    }
    format!("{lines}{line}\n")
}

/// The model that answered, and what it found beside the motor.
fn model(found: &Identification) -> String {
    let ModelChoice { model, reason, .. } = &found.model;
    let text = format!("{HEADING}Model{HEADING:#}: {}\n  {DIM}{reason}{DIM:#}", model.label());
    let Some(fit) = &found.output else { return text };
    let rms = fit.residual_rms();
    let how = if fit.voltage_timing.provenance == Provenance::Stated { "as stated" } else { "found" };
    let mut text = format!(
        "{text}\nCurrents of {} rows simulated; they miss the measured ones by {} (d) and {} (q) rms.\nVoltages read as {} ({how}).",
        fit.residuals.len() / 2,
        amperes(rms.d),
        amperes(rms.q),
        fit.voltage_timing.value.label(),
    );
    if !fit.fault_estimates.is_empty() {
        text += &format!("\n\n{HEADING}Found beside the motor{HEADING:#} (± 95 %)\n{}", beside(fit).trim_end());
    }
    for (outcome, lines) in [("Not taken", not_taken(fit, false)), ("Not tried without theta_e", not_taken(fit, true))] {
        if !lines.is_empty() {
            text += &format!("\n{DIM}{outcome}: {}.{DIM:#}", lines.join(", "));
        }
    }
    text
}

fn amperes(current: f64) -> String {
    let (factor, unit) = if current >= 1.0 {
        (1.0, "A")
    } else if current >= 1e-3 {
        (1e3, "mA")
    } else {
        (1e6, "uA")
    };
    format!("{} {unit}", significant(factor * current, 2))
}

/// Standard errors in half of a 95 % interval.
const INTERVAL: f64 = 1.959_964;

fn beside(fit: &OutputFit) -> String {
    let rows = fit.fault_estimates.iter().map(|nuisance| {
        let [value, margin, unit] = format_unknown(nuisance.unknown, nuisance.value, INTERVAL * nuisance.standard_error);
        // Units stand at the left of their column.
        (nuisance.unknown.label(), value, margin, unit)
    });
    let rows: Vec<_> = rows.collect();
    let width = |of: fn(&(&str, String, String, String)) -> usize| rows.iter().map(of).max().unwrap_or(0);
    let (label, value, margin) = (width(|row| row.0.len()), width(|row| row.1.len()), width(|row| row.2.len()));
    rows.iter()
        .map(|row| format!("  {:label$}  {:>value$} ± {:>margin$} {}", row.0, row.1, row.2, row.3).trim_end().to_owned() + "\n")
        .collect()
}

/// Faults that the answer does without, in few words: for want of the electrical angle, or for any other reason.
fn not_taken(fit: &OutputFit, needs_angle: bool) -> Vec<&'static str> {
    let mut words = Vec::new();
    for tried in &fit.fault_trials {
        let left_out = if needs_angle {
            tried.outcome == FaultOutcome::NeedsAngle
        } else {
            !matches!(tried.outcome, FaultOutcome::NeedsAngle | FaultOutcome::Taken | FaultOutcome::Covered)
        };
        let word = tried.fault.family();
        if left_out && !words.contains(&word) {
            words.push(word);
        }
    }
    words
}

fn operating_points(found: &SteadyFit) -> String {
    let rows = found.operating_points.iter().zip(&found.estimate.residuals).map(|(point, residual)| {
        let (u, i) = (point.voltage(), point.current());
        let mut row = vec![times(point.time), point.rows.len().to_string()];
        row.extend([i.d, i.q, point.omega_e(), u.d, u.q].map(|value| format!("{value:.3}")));
        row.extend(residual.map(millivolts));
        row
    });
    table(&["t s", "rows", "i_d A", "i_q A", "omega_e rad/s", "u_d V", "u_q V", "residual d mV", "q mV"], 0, rows)
}

/// Flux per operating point, where inductances depend on the current.
fn fluxes(found: &SaturationFinding) -> String {
    let given = if found.rs_uncertainty > 0.0 { format!(" ± {}", significant(2.0 * found.rs_uncertainty, 2)) } else { String::new() };
    // The same digits down a column: two of its best error.
    let decimals = |error: fn(&Flux) -> f64| {
        let least = found.fluxes.iter().flatten().map(error).fold(f64::INFINITY, f64::min);
        (1 - (2e3 * least).log10().floor() as i32).clamp(0, 6) as usize
    };
    let (of_d, of_q) = (decimals(|flux| flux.uncertainty.d), decimals(|flux| flux.uncertainty.q));
    let rows = found.fluxes.iter().flatten().map(|flux| {
        let millis = |value: f64, decimals: usize| format!("{:.decimals$}", 1e3 * value);
        let apparent = |henries: Option<f64>| henries.map_or("-".to_owned(), |henries| significant(1e3 * henries, 4));
        vec![
            format!("{:.3}", flux.current.d),
            format!("{:.3}", flux.current.q),
            millis(flux.psi.d, of_d),
            millis(2.0 * flux.uncertainty.d, of_d),
            millis(flux.psi.q, of_q),
            millis(2.0 * flux.uncertainty.q, of_q),
            apparent(flux.apparent_ld),
            apparent(flux.apparent_lq),
        ]
    });
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return String::new();
    }
    format!(
        "\n{DIM}Flux from voltage, with R_s = {}{given} ohm{DIM:#}\n{}",
        significant(found.rs, 4),
        table(&["i_d A", "i_q A", "psi_d mWb", "±", "psi_q mWb", "±", "apparent L_d mH", "L_q mH"], 0, rows)
    )
}

/// Start and end, with digits that tell the window's length to a hundredth of it.
fn times((start, end): (f64, f64)) -> String {
    let decimals = (2 - (end - start).log10().floor() as i32).clamp(0, 9) as usize;
    format!("{start:.decimals$} .. {end:.decimals$}")
}

/// Without the sign of a zero.
fn millivolts(volts: f64) -> String {
    let text = format!("{:.1}", 1e3 * volts);
    if text == "-0.0" { "0.0".to_owned() } else { text }
}

/// What the swarm alone reached.
fn search(found: &Identification, method: &Method) -> String {
    let Some(search) = &found.search else { return String::new() };
    let known = |parameter: &Parameter| found.parameter(*parameter).value().is_some();
    let values: Vec<String> = Parameter::ALL
        .into_iter()
        .filter(known)
        .map(|parameter| {
            let value = search.motor.get(parameter);
            let scale = Scale::for_value(parameter, value);
            format!("{} {} {}", parameter.symbol(), scale.format(value, value.abs() * 1e-4), scale.unit(parameter.unit()))
        })
        .collect();
    format!(
        "{HEADING}{}{HEADING:#} alone, after {} evaluations, is {}{} above the {} minimum:\n  {}",
        method.label(),
        search.report.evaluations,
        small(search.cost_above_optimum),
        if found.output.is_some() { " A²" } else { "" },
        if found.output.is_some() { "least-squares" } else { "exact least-squares" },
        values.join(", "),
    )
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, wrapped};

    #[test]
    fn words_are_wrapped_and_none_is_lost() {
        assert_eq!(wrapped("  ", "To do: nothing."), "  To do: nothing.\n");
        let text = vec!["letters"; 40].join(" ");
        let lines = wrapped("", &text);
        assert!(lines.lines().count() == 4 && lines.lines().all(|line| line.len() <= WIDTH), "{lines}");
        assert_eq!(lines.split_whitespace().count(), 40);
        assert!(lines.lines().skip(1).all(|line| line.starts_with("  letters")));
    }
}

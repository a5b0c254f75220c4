//! An identification, to be read at a glance: the answer in a sentence, what to know of it, the four parameters with their verdicts,
//! and why. What it rests on is among the [details].

use super::details;
use crate::terminal::{self, BAD, DIM, GOOD, HEADING, WARNING, frequency, options, table, wrapped};
use fluxfit::{
    Answer, HeldOut, Judgement, Log, Parameter, Reason, Remedy, Request, Summary, Verdict,
    evidence::{FaultEstimate, Flux, Identification, OutputFit, Provenance, SaturationFinding},
    faults::Fault,
    identify,
    steady::OperatingPoint,
};
use fluxfit_units::{Scale, format_unknown, significant};

/// Shows an identification, the answer in a sentence first; warnings and notes go to standard error.
pub(crate) fn show(name: &str, answer: &Answer) -> std::io::Result<()> {
    let found = &answer.identification;
    let read = terminal::wrapped("", &format!("{name}: {}", read(&answer.log, found)));
    let above = status(found).lines().count() + read.lines().count() + found.warnings.len();
    terminal::print(&format!("{}{DIM}{}{DIM:#}\n", status(found), read.trim_end()))?;
    found.warnings.iter().for_each(terminal::warn);
    terminal::point_to_explanations(&found.warnings);
    let mut text = format!("\n{}{}", parameters(found), validity(found));
    text += &explanations(found);
    text += &found.temperature.map(|temperature| format!("\n{}", wrapped("", &sentence(&temperature.to_string())))).unwrap_or_default();
    if let Some(saturation) = &found.saturation {
        text += &fluxes(saturation, found.operating_points());
    }
    text += &format!("\n{}", model(found, answer.log.rows()));
    text += &unseen(found);
    if terminal::is_verbose() {
        text += &details::text(found);
    }
    terminal::print(&text)?;
    let is_scrolled = terminal::height().is_some_and(|height| above + text.lines().count() >= height);
    answer.current_loop.as_ref().map(super::current_loop::show).transpose()?;
    match &answer.held_out {
        Some(HeldOut { log, validation: Some(validation), .. }) => {
            terminal::print("\n")?;
            crate::commands::validate::display::show("what was held out", "This answer", log, validation)?;
        }
        Some(HeldOut { validation: None, .. }) => {
            terminal::note("what was held out is not predicted: that takes all four parameters");
        }
        None if answer.log.segments().len() > 1 => {
            terminal::note(
                "to test this answer on a part of the log that it was not found from: --hold-out; on another log: fluxfit validate",
            );
        }
        None => {}
    }
    terminal::release_notes();
    // What stands at the top of a long answer is out of sight.
    if is_scrolled { terminal::print(&format!("\n{}{}", status(found), values(found))) } else { Ok(()) }
}

/// Shows what the operating points alone say, where a signal has ended the identification before its answer: values, but no verdicts.
pub(crate) fn show_roughly(name: &str, log: &Log, request: &Request) {
    let text = match identify(log, request) {
        Ok(answer) => {
            let found = &answer.identification;
            let what = "Rough answer: that of the operating points alone, before anything was checked. Do not use it for a drive.";
            let rows = found.parameters.iter().map(|judgement| {
                let cells = value_cells(judgement).unwrap_or(["-", "", "", ""].map(str::to_owned));
                [vec![judgement.parameter.symbol().to_owned()], cells[..3].to_vec()].concat()
            });
            format!(
                "{WARNING}{}{WARNING:#}\n{DIM}{name}{DIM:#}\n\n{}",
                wrapped("", what).trim_end(),
                table(&["", "value", "", "95 %"], 1, rows)
            )
        }
        Err(error) => wrapped("", &format!("There is no answer yet, not even a rough one: {error}")),
    };
    // Nobody who reads it is no reason to stay.
    let _ = terminal::print(&text);
    terminal::release_notes();
}

/// How many parameters are identified, and the one thing to do next.
fn status(found: &Identification) -> String {
    let style = if found.is_complete() {
        GOOD
    } else if found.parameters.iter().any(|judgement| judgement.value().is_some()) {
        WARNING
    } else {
        BAD
    };
    let style = style.bold();
    format!("{style}{}{style:#}\n", wrapped("", &Summary::of(&found.parameters, &found.warnings).to_string()).trim_end())
}

/// The values with their intervals in one line, as far as there are any.
fn values(found: &Identification) -> String {
    let values = found.parameters.iter().filter_map(|judgement| {
        let [value, unit, half_width, _] = value_cells(judgement)?;
        let half_width = if judgement.uncertainty.standard_error() == 0.0 { String::new() } else { format!(" {half_width}") };
        Some(format!("{} {value} {unit}{half_width}", judgement.parameter.symbol()))
    });
    let values: Vec<String> = values.collect();
    if values.is_empty() { String::new() } else { wrapped("", &values.join(", ")) }
}

/// What was read, in one line.
fn read(log: &Log, found: &Identification) -> String {
    let periods: Vec<f64> = log.segments().iter().map(|segment| segment.sample_period).collect();
    let period = periods.first().copied().unwrap_or(f64::NAN);
    let rate =
        if periods.iter().any(|other| (other / period - 1.0).abs() > 0.01) { "mixed rates".to_owned() } else { frequency(1.0 / period) };
    let segments = log.segments().len();
    let parts = if segments > 1 { format!(" in {segments} segments") } else { String::new() };
    let points = match found.operating_points().len() {
        // Where currents are simulated, none is needed.
        0 if found.output.is_some() => String::new(),
        points => format!(", {}", terminal::count(points, "operating point")),
    };
    format!("{} rows at {rate}, {} s{parts}{points}", log.rows(), significant(log.duration(), 3))
}

/// The four parameters. What their intervals mostly come from, where there is room for it.
fn parameters(found: &Identification) -> String {
    let rows = found.parameters.iter().map(|judgement| {
        let (symbol, word) = (judgement.parameter.symbol().to_owned(), verdict(judgement.verdict));
        let Some([value, unit, half_width, interval]) = value_cells(judgement) else {
            return [symbol, "-".to_owned(), String::new(), String::new(), String::new(), word, String::new()];
        };
        if judgement.uncertainty.standard_error() == 0.0 {
            // A number that was given has no interval, and no verdict of its own.
            return [symbol, value, unit, String::new(), String::new(), "given".to_owned(), String::new()];
        }
        let word = if judgement.is_as_prior() { "as its prior".to_owned() } else { word };
        [symbol, value, unit, half_width, interval, word, judgement.uncertainty.largest_part().label().to_owned()]
    });
    let rows: Vec<[String; 7]> = rows.collect();
    let heading = ["", "value", "", "95 %", "interval", "verdict", "main source"];
    let of_columns = |count: usize| table(&heading[..count], 1, rows.iter().map(|row| row[..count].to_vec()));
    let whole = of_columns(heading.len());
    let fits = whole.lines().all(|line| terminal::columns(line) <= terminal::width());
    let plain = if fits { whole } else { of_columns(heading.len() - 1) };
    // Colour after layout: escape codes have no width.
    plain
        .replace(verdict(Verdict::NotIdentifiable).as_str(), &format!("{BAD}not identifiable{BAD:#}"))
        .replace(" weak", &format!(" {WARNING}weak{WARNING:#}"))
        .replace(" identified", &format!(" {GOOD}identified{GOOD:#}"))
}

/// For which currents or which time the values hold; nothing where they hold for the whole log.
fn validity(found: &Identification) -> String {
    let mut shared: Vec<(&str, Vec<&str>)> = Vec::new();
    for parameter in Parameter::ALL {
        let Some(when) = found.valid_at(parameter) else { continue };
        match shared.iter_mut().find(|(other, _)| *other == when) {
            Some((_, symbols)) => symbols.push(parameter.symbol()),
            None => shared.push((when, vec![parameter.symbol()])),
        }
    }
    let parts: Vec<String> = shared.iter().map(|(when, symbols)| format!("{} {when}", symbols.join(", "))).collect();
    if parts.is_empty() { String::new() } else { format!("{DIM}{}{DIM:#}\n", wrapped("  ", &parts.join("; ")).trim_end()) }
}

/// Value, unit, relative half-width and interval of a parameter; none where it has no value.
fn value_cells(judgement: &Judgement) -> Option<[String; 4]> {
    let (value, [low, high]) = judgement.value().zip(judgement.interval())?;
    let (scale, error) = (Scale::for_value(judgement.parameter, value), judgement.uncertainty.standard_error());
    Some([
        scale.format(value, error),
        scale.unit(judgement.parameter.unit()),
        format!("±{} %", significant(100.0 * judgement.uncertainty.half_width / value.abs(), 2)),
        format!("{} .. {}", scale.format(low, error), scale.format(high, error)),
    ])
}

fn verdict(verdict: Verdict) -> String {
    verdict.key().replace('-', " ")
}

/// Reasons, those that parameters share only once; and the one thing to do that helps most.
fn explanations(found: &Identification) -> String {
    let mut shared: Vec<(Vec<&str>, &Reason)> = Vec::new();
    for judgement in &found.parameters {
        let Some(reason) = &judgement.reason else { continue };
        match shared.iter_mut().find(|(_, other)| other.is_told_with(reason)) {
            Some((symbols, _)) => symbols.push(judgement.parameter.symbol()),
            None => shared.push((vec![judgement.parameter.symbol()], reason)),
        }
    }
    let mut text = String::new();
    for (symbols, reason) in &shared {
        let reason = if symbols.len() > 1 { format!("{reason:#}") } else { reason.to_string() };
        let symbols = symbols.join(", ");
        let lines = wrapped("", &format!("{symbols}: {reason}."));
        text += &format!("{HEADING}{symbols}{HEADING:#}{}", lines.strip_prefix(&symbols).unwrap_or(&lines));
    }
    text += &steps(found);
    if text.is_empty() { text } else { format!("\n{text}") }
}

/// The step that helps most, and what else helps the parameters that it leaves as they are; everything that helps, where all is to be told.
fn steps(found: &Identification) -> String {
    let Some(next) = Summary::of(&found.parameters, &found.warnings).next else { return String::new() };
    let mut text = to_do("To do", &next.instruction(), &next.remedy);
    // Columns in doubt may be behind everything else: they come first, alone.
    let is_of_columns = matches!(next.remedy, Remedy::CheckSigns { .. } | Remedy::CheckFrame { .. });
    let mut others: Vec<(&Remedy, Vec<Parameter>)> = Vec::new();
    for judgement in &found.parameters {
        let Some(remedy) = judgement.remedy.as_ref().filter(|remedy| !next.is_same(remedy)) else { continue };
        match others.iter_mut().find(|(other, _)| *other == remedy) {
            Some((_, parameters)) => parameters.push(judgement.parameter),
            None => others.push((remedy, vec![judgement.parameter])),
        }
    }
    for (remedy, parameters) in others {
        let is_instead = parameters.iter().all(|parameter| next.parameters.contains(parameter));
        let symbols: Vec<&str> = parameters.iter().copied().map(Parameter::symbol).collect();
        if is_instead && terminal::is_verbose() {
            let instruction = match remedy {
                // Its alternative stands above.
                Remedy::HoldLonger { or, .. } if next.is_same(or) => format!("{remedy:#}"),
                remedy => remedy.to_string(),
            };
            text += &to_do(&format!("Or for {}", symbols.join(", ")), &instruction, remedy);
        } else if !is_of_columns && !parameters.iter().any(|parameter| next.parameters.contains(parameter)) {
            text += &to_do(&format!("To do for {}", symbols.join(", ")), &remedy.to_string(), remedy);
        }
    }
    text
}

fn to_do(what: &str, instruction: &str, remedy: &Remedy) -> String {
    let lines = wrapped("", &format!("{what}: {}.", options::with_option(instruction, options::of_remedy(remedy))));
    format!("{HEADING}{what}{HEADING:#}{}", lines.strip_prefix(what).unwrap_or(&lines))
}

/// What no log shows: what the intervals count of it as stated, and what they do not.
fn unseen(found: &Identification) -> String {
    let list = |what: &str, errors: Vec<String>| {
        if errors.is_empty() { String::new() } else { errors.iter().fold(format!("{what}:\n"), |text, error| text + &wrapped("  ", error)) }
    };
    let counted = list("In the intervals, as stated", found.counted.iter().map(ToString::to_string).collect());
    let unseen = list("Not in the intervals, because no log shows it", found.unseen_in_values().iter().map(ToString::to_string).collect());
    if counted.is_empty() && unseen.is_empty() {
        String::new()
    } else {
        format!("\n{DIM}{}{DIM:#}\n", format!("{counted}{unseen}").trim_end())
    }
}

/// Half a sentence as a whole one.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// The model that answered, and what it found beside the motor.
fn model(found: &Identification, of_rows: usize) -> String {
    let label = found.model.model.label();
    let of_model = |text: &str| format!("{HEADING}Model{HEADING:#}{}", wrapped("", &format!("Model: {text}")).trim_start_matches("Model"));
    let Some(fit) = &found.output else {
        let rows = found.operating_points().iter().map(|point| point.rows.len()).sum::<usize>();
        return of_model(&format!("{label}, {rows} rows."));
    };
    let rms = fit.residual_rms();
    let how = if fit.voltage_timing.provenance == Provenance::Stated { "as stated" } else { "found" };
    let misses = if rms.d.max(rms.q) < RUNAWAY {
        format!("miss the measured ones by {} (d) and {} (q) rms", amperes(rms.d), amperes(rms.q))
    } else {
        "run away from the measured ones".to_owned()
    };
    let (rows, timing) = (fit.residuals.len() / 2, fit.voltage_timing.value.label());
    // The few that begin a stretch or were left out are not worth a number.
    let of = if (rows as f64) < NEARLY_ALL * of_rows as f64 { format!(" of {of_rows}") } else { String::new() };
    let mut text =
        of_model(&format!("{label}: the currents of {rows}{of} rows are simulated and {misses}; voltages read as {timing} ({how})."));
    let answered = found.parameters.iter().any(|judgement| judgement.value().is_some());
    if answered {
        text += &beside_motor(fit);
    }
    text
}

/// Simulated rows are told beside all rows of the log where they are less than this part of them.
const NEARLY_ALL: f64 = 0.9;

/// Longer lists are shown with `-v` alone; without it their faults are named.
const SHORT: usize = 4;

/// The table of fluxes, which is the answer of a motor that saturates, has at most this many points without `-v`.
const MOST_POINTS: usize = 12;

/// What was found beside the motor.
fn beside_motor(fit: &OutputFit) -> String {
    let (lines, what) = (beside(fit), "Found beside the motor");
    let faults = || Fault::ALL.into_iter().filter(|fault| told_beside(fit).any(|found| found.unknown.fault() == Some(*fault)));
    if lines.lines().count() > SHORT && !terminal::is_verbose() {
        let labels: Vec<&str> = faults().map(Fault::label).collect();
        let named = wrapped("", &format!("{what} (values: -v): {}.", labels.join(", ")));
        return format!("\n{HEADING}{what}{HEADING:#}{}", named.trim_start_matches(what));
    }
    let meanings: String =
        faults().filter_map(Fault::meaning).map(|meaning| format!("{DIM}{}{DIM:#}\n", wrapped("  ", meaning).trim_end())).collect();
    if lines.is_empty() { lines } else { format!("\n{HEADING}{what}{HEADING:#} (± 95 %)\n{lines}{meanings}") }
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

/// Simulated currents that miss by as much as this, A, grow without limit.
const RUNAWAY: f64 = 1e6;

/// Standard errors in half of a 95 % interval.
const INTERVAL: f64 = 1.959_964;

/// Numbers that may as well be zero say nothing.
fn told_beside(fit: &OutputFit) -> impl Iterator<Item = &FaultEstimate> {
    fit.fault_estimates.iter().filter(|nuisance| nuisance.value.abs() > INTERVAL * nuisance.standard_error)
}

/// A line for each of the others.
fn beside(fit: &OutputFit) -> String {
    let rows = told_beside(fit).map(|nuisance| {
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

/// Currents closer than this part of the largest are those of one point, held at several speeds perhaps.
const SAME: f64 = 0.05;

/// Whether some points have one current and several speeds.
fn have_several_speeds(points: &[OperatingPoint]) -> bool {
    let differ = |one: f64, other: f64, largest: f64| (one - other).abs() > SAME * largest;
    let largest = |value: fn(&OperatingPoint) -> f64| points.iter().map(value).fold(0.0, f64::max);
    let (current, speed) = (largest(|point| point.current().magnitude()), largest(|point| point.omega_e().abs()));
    let is_repeated = |one: &OperatingPoint, other: &OperatingPoint| {
        let (i, j) = (one.current(), other.current());
        !differ(i.d, j.d, current) && !differ(i.q, j.q, current) && differ(one.omega_e(), other.omega_e(), speed)
    };
    points.iter().enumerate().any(|(k, one)| points[k + 1..].iter().any(|other| is_repeated(one, other)))
}

/// Flux per operating point, where inductances depend on the current; with the speed, where that alone tells points apart.
fn fluxes(found: &SaturationFinding, points: &[OperatingPoint]) -> String {
    let has_speed = found.fluxes.len() == points.len() && have_several_speeds(points);
    // The same digits down a column: two of its best error.
    let decimals = |error: fn(&Flux) -> f64| {
        let least = found.fluxes.iter().flatten().map(error).fold(f64::INFINITY, f64::min);
        (1 - (2e3 * least).log10().floor() as i32).clamp(0, 6) as usize
    };
    let (of_d, of_q) = (decimals(|flux| flux.uncertainty.d), decimals(|flux| flux.uncertainty.q));
    let fluxes = || found.fluxes.iter().flatten();
    let inductances = fluxes().flat_map(|flux| [flux.apparent_ld, flux.apparent_lq]).flatten();
    let inductance = Scale::for_value(Parameter::Lq, inductances.map(f64::abs).fold(0.0, f64::max));
    let has_ld = fluxes().any(|flux| flux.apparent_ld.is_some());
    let half_width_of_ld = |flux: &Flux| 2.0 * (flux.uncertainty.d / flux.current.d).abs();
    let half_width_of_lq = |flux: &Flux| 2.0 * (flux.uncertainty.q / flux.current.q).abs();
    let least_of_ld = fluxes().filter(|flux| flux.apparent_ld.is_some()).map(half_width_of_ld).fold(f64::INFINITY, f64::min);
    let least_of_lq = fluxes().filter(|flux| flux.apparent_lq.is_some()).map(half_width_of_lq).fold(f64::INFINITY, f64::min);
    let of_points = found.fluxes.iter().enumerate().filter_map(|(k, flux)| Some((points.get(k), flux.as_ref()?)));
    let rows = of_points.map(|(point, flux)| {
        let millis = |value: f64, decimals: usize| format!("{:.decimals$}", 1e3 * value);
        let apparent = |henries: Option<f64>, half_width: f64, least: f64| match henries {
            Some(henries) => [henries, half_width].map(|value| inductance.format(value, least)),
            None => ["-".to_owned(), String::new()],
        };
        let speed = point.filter(|_| has_speed).map(|point| format!("{:.1}", point.omega_e()));
        let mut row = vec![format!("{:.3}", flux.current.d), format!("{:.3}", flux.current.q)];
        row.extend(speed);
        row.extend([
            millis(flux.psi.d, of_d),
            millis(2.0 * flux.uncertainty.d, of_d),
            millis(flux.psi.q, of_q),
            millis(2.0 * flux.uncertainty.q, of_q),
        ]);
        if has_ld {
            row.extend(apparent(flux.apparent_ld, half_width_of_ld(flux), least_of_ld));
        }
        row.extend(apparent(flux.apparent_lq, half_width_of_lq(flux), least_of_lq));
        row
    });
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return String::new();
    }
    let unit = inductance.unit(Parameter::Lq.unit());
    let [of_ld, of_lq] = ["L_d", "L_q"].map(|symbol| format!("apparent\n{symbol} {unit}"));
    let mut heading = vec!["i_d\nA", "i_q\nA"];
    heading.extend(has_speed.then_some("omega_e\nrad/s"));
    heading.extend(["psi_d\nmWb", "\n±", "psi_q\nmWb", "\n±"]);
    if has_ld {
        heading.extend([of_ld.as_str(), "\n±"]);
    }
    heading.extend([of_lq.as_str(), "\n±"]);
    let with = format!("with R_s = {}", resistance(found));
    let table = if terminal::is_verbose() || rows.len() <= MOST_POINTS {
        format!("{DIM}Fluxes at the currents of the log, from voltage {with}{DIM:#}\n{}", table(&heading, 0, rows))
    } else {
        let points = terminal::count(rows.len(), "operating point");
        format!("{DIM}{}{DIM:#}\n", wrapped("", &format!("Table of fluxes at {points}, {with}: -v")).trim_end())
    };
    format!("\n{table}{}", incremental(found))
}

/// The slopes of the flux between neighbouring points; nothing without such points.
fn incremental(found: &SaturationFinding) -> String {
    let lines = found.incremental().into_iter().map(|one| {
        let (scale, half_width) = (Scale::for_value(Parameter::Lq, one.inductance.abs()), 2.0 * one.uncertainty);
        let [value, margin] = [one.inductance, half_width].map(|henries| scale.format(henries, half_width));
        let (axis, unit) = (["d", "q"][one.axis], scale.unit(Parameter::Lq.unit()));
        format!("  {value} ± {margin} {unit} along {axis} at i_d = {:.2} A, i_q = {:.2} A\n", one.current.d, one.current.q)
    });
    let lines: String = lines.collect();
    if lines.is_empty() { lines } else { format!("\n{DIM}Incremental inductances, for a current controller (± 95 %){DIM:#}\n{lines}") }
}

/// The resistance that the fluxes were computed with, and its 95 % half-width where it was not given.
fn resistance(found: &SaturationFinding) -> String {
    let (scale, half_width) = (Scale::for_value(Parameter::Rs, found.rs), 2.0 * found.rs_uncertainty);
    let margin = if half_width > 0.0 { format!(" ± {}", scale.format(half_width, half_width)) } else { String::new() };
    format!("{}{margin} {}", scale.format(found.rs, half_width), scale.unit(Parameter::Rs.unit()))
}

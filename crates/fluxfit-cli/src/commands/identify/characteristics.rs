//! Tables of a test bench in place of logs: read, identified together, shown.

use crate::{
    arguments::LogArguments,
    commands::{input, not_a_log, status::Status},
    error::CommandError,
    json, shell,
    terminal::{self, BAD, DIM, GOOD, WARNING, table, wrapped},
};
use fluxfit::{
    Verdict,
    characteristics::{
        Across, Characteristic, CharacteristicEstimate, CharacteristicsAnswer, Lack, Residual, VoltageReading, identify_characteristics,
        identify_electrical_characteristics,
    },
    document::CharacteristicsDocument,
    motor::Parameter,
};
use fluxfit_log::{LogOptions, ReadCharacteristic, read_characteristic_among};
use fluxfit_units::{Scale, significant, wording::one_line};

/// Identifies from tables, if tables are what is given; `None` of logs. `stated` are options that were given and are for logs alone.
pub(super) fn run(arguments: &LogArguments, stated: &[&str], options: &LogOptions) -> Result<Option<Status>, CommandError> {
    let (logs, pole_pairs) = (&arguments.logs, options.pole_pairs);
    let mut read = Vec::new();
    for path in logs {
        let table = not_a_log::or_what_it_is(read_characteristic_among(path, logs, options), path)?;
        read.extend(table.map(|read| (input::name(path), read)));
    }
    if read.is_empty() {
        return Ok(None);
    }
    if read.len() < logs.len() {
        let (name, kind) = (&read[0].0, read[0].1.table.label());
        return Err(CommandError::Usage(format!(
            "{name} is a table ({kind}), and another file a log: identify the tables alone, then the log with their values (--prior psi_f=VALUE±ERROR)"
        )));
    }
    let of_log = [("--report", arguments.report.is_some()), ("--figures", arguments.figures.is_some())];
    let of_log = of_log.iter().filter(|(_, is_stated)| *is_stated).map(|(option, _)| option);
    if let Some(option) = of_log.chain(stated).next() {
        return Err(CommandError::Usage(format!("{option} is for logs of a drive, not for tables of a test bench; leave it out")));
    }
    let notes: Vec<String> =
        read.iter().flat_map(|(name, one)| one.notes.iter().map(move |note| format!("{name}: {}", note.sentence))).collect();
    notes.iter().for_each(|note| terminal::note(note));
    let tables: Vec<Characteristic> = read.iter().map(|(_, read)| read.table.clone()).collect();
    let names: Vec<String> = read.iter().map(|(name, read)| format!("{name}: {}", read.table.describe())).collect();
    let files = read.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    let is_electrical = pole_pairs.is_none() && read.iter().any(|(_, read)| read.has_electrical_speed);
    if let Some((name, _)) = read.iter().find(|(_, read)| is_electrical && !read.has_electrical_speed && needs_pole_pairs(&read.table)) {
        return Err(CommandError::Usage(format!(
            "{name} has the speed or the torque of the shaft, and another table the electrical speed: state the pole pairs (--pole-pairs N)"
        )));
    }
    let identified =
        if is_electrical { identify_electrical_characteristics(&tables) } else { identify_characteristics(&tables, pole_pairs) };
    let answer = identified.map_err(|error| CommandError::Log { log: files, error })?;
    if arguments.json {
        terminal::print(&json::text(&CharacteristicsDocument::of(&tables, notes, &answer))?)?;
    } else {
        show(&names, &unclear_voltages(&read), &answer)?;
    }
    Ok(Some(if answer.is_complete() { Status::Complete } else { Status::Incomplete }))
}

/// Whether a table beside those of electrical speeds needs the pole pairs: a direct current has neither speed nor torque.
fn needs_pole_pairs(table: &Characteristic) -> bool {
    !matches!(table, Characteristic::DirectCurrent(_))
}

/// The symbol of what the tables tell: without pole pairs, inductances and flux times these.
fn symbol(parameter: Parameter, answer: &CharacteristicsAnswer) -> String {
    match parameter == Parameter::Rs || answer.is_of_motor() {
        true => parameter.symbol().to_owned(),
        false => format!("p {}", parameter.symbol()),
    }
}

/// What is said of the numbers without a value or with a weak one, each sentence once with the symbols that it is about. Voltages that are
/// line to line or of a phase have a sentence of their own.
fn lacking(answer: &CharacteristicsAnswer, say: impl Fn(&Lack) -> String) -> Vec<(String, String)> {
    let mut said: Vec<(String, String)> = Vec::new();
    for estimate in &answer.parameters {
        let Some(lack) = estimate.lack.filter(|lack| *lack != Lack::Voltages) else { continue };
        let (symbol, sentence) = (symbol(estimate.parameter, answer), say(&lack));
        match said.iter_mut().find(|(_, other)| *other == sentence) {
            Some((symbols, _)) => *symbols += &format!(", {symbol}"),
            None => said.push((symbol, sentence)),
        }
    }
    said
}

/// Of each table whose voltages do not say between which points they were measured the first column of them.
fn unclear_voltages(read: &[(String, ReadCharacteristic)]) -> Vec<&str> {
    let is_unclear = |read: &ReadCharacteristic| matches!(&read.table, Characteristic::OpenCircuit(table) if table.across.is_none());
    let of_unclear = read.iter().filter(|(_, read)| is_unclear(read));
    let mut columns: Vec<&str> = of_unclear
        .filter_map(|(_, read)| read.columns.iter().find(|(quantity, _)| *quantity == "voltage").map(|(_, header)| header.as_str()))
        // What would not print as it is cannot be pasted.
        .filter(|header| one_line(header) == *header)
        .collect();
    columns.dedup();
    columns
}

fn show(names: &[String], unclear_voltages: &[&str], answer: &CharacteristicsAnswer) -> std::io::Result<()> {
    let of = |verdict: Verdict| answer.parameters.iter().filter(move |estimate| estimate.verdict == verdict);
    let identified = of(Verdict::Identified).count();
    let style = match identified {
        4 => GOOD,
        0 => BAD,
        _ => WARNING,
    }
    .bold();
    let symbols = |verdict: Verdict| of(verdict).map(|estimate| symbol(estimate.parameter, answer)).collect::<Vec<_>>().join(", ");
    let mut status = if identified == 4 { "All 4 identified.".to_owned() } else { format!("{identified} of 4 identified.") };
    if of(Verdict::Weak).count() > 0 {
        status += &format!(" {} weak.", symbols(Verdict::Weak));
    }
    if answer.voltages == Some(VoltageReading::Ambiguous) {
        status = "0 of 4 identified: are the voltages line to line or of a phase?".to_owned();
    } else {
        lacking(answer, |lack| lack.remedy()).iter().for_each(|(symbols, remedy)| status += &format!(" For {symbols}: {remedy}."));
    }
    if !answer.is_of_motor() {
        status += " p are the pole pairs: with --pole-pairs N the values are the motor's own.";
    }
    let mut text = format!("{style}{}{style:#}\n", wrapped("", &status).trim_end());
    names.iter().for_each(|name| text += &format!("{DIM}{}{DIM:#}\n", wrapped("", name).trim_end()));
    match answer.voltages {
        Some(VoltageReading::Ambiguous) => {
            let value = |parameter: Parameter, factor: f64| {
                let value = factor * answer.if_line_to_line[parameter as usize]?;
                let scale = Scale::for_value(parameter, value);
                Some(format!("{} {} {}", symbol(parameter, answer), scale.format(value, 1e-4 * value), scale.unit(parameter.unit())))
            };
            let values = |factor: f64| Parameter::ALL.iter().filter_map(|one| value(*one, factor)).collect::<Vec<_>>().join(", ");
            let or = if answer.residual_rms[Residual::ShortTorque as usize].is_none() {
                ", or add a short-circuit table with torque"
            } else {
                ""
            };
            let sentence = format!(
                "Line to line: {}. Of a phase: {}. The columns' names do not say which; say it by one of the options below, put 'll' or 'phase' into them{or}.",
                values(1.0),
                values(3.0_f64.sqrt())
            );
            text += &format!("\n{WARNING}{}{WARNING:#}\n", wrapped("", &sentence).trim_end());
            // Each on a line of its own, so that it can be pasted.
            for name in ["voltage_ll", "voltage_phase"].iter().filter(|_| !unclear_voltages.is_empty()) {
                let pairs: Vec<String> = unclear_voltages.iter().map(|header| format!("{name}={header}")).collect();
                text += &format!("    --map {}\n", shell::word(pairs.join(",").as_ref()));
            }
        }
        Some(VoltageReading::ByTorque(across)) => {
            let across = if across == Across::Lines { "line to line" } else { "of a phase" };
            text += &format!("{DIM}{}{DIM:#}\n", wrapped("", &format!("Voltages: {across}, as the other tables tell.")).trim_end());
        }
        Some(VoltageReading::Stated) | None => {}
    }
    let rows = answer.parameters.iter().map(|estimate| cells(estimate, answer));
    text += &format!("\n{}", table(&["", "value", "", "95 %", "interval", "verdict"], 1, rows));
    text += &format!("\n{DIM}{}{DIM:#}\n", unseen(answer).trim_end());
    let reasons = lacking(answer, ToString::to_string);
    if !reasons.is_empty() {
        let lines = reasons.iter().map(|(symbols, reason)| wrapped("", &format!("{symbols}: {reason}.")).trim_end().to_owned() + "\n");
        text += &format!("\n{}", lines.collect::<String>());
    }
    let left = Residual::ALL.iter().zip(answer.residual_rms).filter_map(|(residual, rms)| {
        let (factor, unit) = match residual {
            Residual::ShortTorque | Residual::Torque => (1.0, "N m"),
            Residual::DirectVoltage | Residual::DutyVoltage | Residual::PointVoltage => (1.0, "V"),
            Residual::OpenVoltage | Residual::ShortCurrent => (100.0, "%"),
        };
        Some(format!("{} by {} {unit}", residual.label(), significant(factor * rms?, 2)))
    });
    text += &format!("\n{}", wrapped("", &format!("Model: steady tests; misses {} rms.", left.collect::<Vec<_>>().join(", "))));
    terminal::print(&text)?;
    terminal::release_notes();
    Ok(())
}

/// What the intervals above do not count, because no table shows it.
fn unseen(answer: &CharacteristicsAnswer) -> String {
    let errors = answer.unseen.iter().filter_map(|(instrument, changes)| {
        let moved = Parameter::ALL.iter().zip(changes).filter(|(_, change)| change.abs() >= LEAST_CHANGE);
        let moved: Vec<String> =
            moved.map(|(parameter, change)| format!("{} {:+.1} %", symbol(*parameter, answer), 100.0 * change)).collect();
        (!moved.is_empty()).then(|| format!("{instrument}: {}", moved.join(", ")))
    });
    let temperature = "the temperature: R_s +0.4 %, flux about -0.1 % for each K".to_owned();
    let mut text = "Not in the intervals, because no table shows it:\n".to_owned();
    errors.chain([temperature]).for_each(|error| text += &wrapped("  ", &error));
    if answer.residual_rms[Residual::ShortCurrent as usize].is_some() {
        text += &wrapped("", "Inductances are those at the currents of the short circuit.");
    }
    text
}

/// Changes below this part are not worth a word.
const LEAST_CHANGE: f64 = 5e-4;

fn cells(estimate: &CharacteristicEstimate, answer: &CharacteristicsAnswer) -> Vec<String> {
    let (symbol, verdict) = (symbol(estimate.parameter, answer), estimate.verdict.key().replace('-', " "));
    let Some((value, [low, high])) = estimate.value.zip(estimate.interval()) else {
        return vec![symbol, "-".to_owned(), String::new(), String::new(), String::new(), verdict];
    };
    let (scale, error) = (Scale::for_value(estimate.parameter, value), estimate.uncertainty.standard_error());
    vec![
        symbol,
        scale.format(value, error),
        scale.unit(estimate.parameter.unit()),
        format!("±{} %", significant(100.0 * estimate.uncertainty.half_width / value, 2)),
        format!("{} .. {}", scale.format(low, error), scale.format(high, error)),
        verdict,
    ]
}

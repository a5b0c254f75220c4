//! Export of an answer as the file that another tool takes, with the names, units and conventions of that tool.
//!
//! A tool uses every number as known. So only identified parameters are exported; if one is weak, or the number of pole pairs is
//! missing, there is a [`Refusal`] and no file. Each file begins with comments that state, for every value, its 95 % interval, what it
//! means for the tool, and the source of that meaning. A new tool is a file with its `TOOL` here, and a variant of [`Target`].

mod entry;
mod matlab;
mod mcsdk;
mod moteus;
mod quantity;
mod target;
mod tool;
mod vesc;

pub use target::{Refusal, Target};

use entry::{Entry, File, Value};
use fluxfit::{Verdict, current_loop::CurrentLoop, evidence::Identification, motor::Parameter};
use fluxfit_units::wording::{list, one_line};
use quantity::{Quantity, interval};
use tool::ExportedMotor;

/// What is exported.
#[derive(Debug, Clone, Copy)]
pub struct Export<'a> {
    /// Names of the logs.
    pub logs: &'a [String],
    /// What was identified from them.
    pub identification: &'a Identification,
    /// Number of pole pairs, if given.
    pub pole_pairs: Option<u32>,
    /// Gains of the current controllers, if requested.
    pub current_loop: Option<&'a CurrentLoop>,
}

/// The file for a tool.
///
/// # Errors
/// If a parameter that it needs is not identified, or the number of pole pairs is missing.
pub fn export(target: Target, export: &Export<'_>) -> Result<String, Refusal> {
    let tool = target.facts();
    let file = (tool.file)(&motor(target, export)?);
    Ok((tool.text)(&comments(target, export, &file), &file.entries))
}

/// The motor, if it may be exported.
fn motor<'a>(target: Target, export: &Export<'a>) -> Result<ExportedMotor<'a>, Refusal> {
    let found = export.identification;
    let judgements = target.parameters().iter().map(|parameter| found.parameter(*parameter));
    let lacking: Vec<_> = judgements.filter(|judgement| judgement.verdict != Verdict::Identified).collect();
    if let Some(first) = lacking.first() {
        let remedy = first.remedy.as_ref().map_or_else(|| "give its value as known".to_owned(), ToString::to_string);
        let symbols = lacking.iter().map(|judgement| judgement.parameter.symbol()).collect();
        return Err(Refusal::NotIdentified { target, symbols, remedy });
    }
    target.check_pole_pairs(export.pole_pairs)?;
    let quantity = |parameter| {
        let judgement = found.parameter(parameter);
        Quantity { value: judgement.raw, interval: judgement.interval().unwrap_or([judgement.raw; 2]) }
    };
    Ok(ExportedMotor {
        rs: quantity(Parameter::Rs),
        ld: quantity(Parameter::Ld),
        lq: quantity(Parameter::Lq),
        psi_f: quantity(Parameter::PsiF),
        correlation: found.correlation[Parameter::Ld as usize][Parameter::Lq as usize],
        pole_pairs: export.pole_pairs.unwrap_or(0),
        current_loop: export.current_loop,
    })
}

/// The comment at the beginning of a file, in lines.
fn comments(target: Target, export: &Export, file: &File) -> Vec<String> {
    let found = export.identification;
    let mut lines = vec![
        format!(
            "Parameters of a permanent magnet synchronous motor for {}, identified by fluxfit {}.",
            target.tool(),
            env!("CARGO_PKG_VERSION")
        ),
        format!("From {}; {}.", list(export.logs), found.model.model.label()),
        "Resistance and inductances per phase of a star, at the temperature of the log; flux and voltages as stated for each value."
            .to_owned(),
    ];
    if !found.warnings.is_empty() {
        let codes: Vec<&str> = found.warnings.iter().map(|warning| warning.code()).collect();
        lines.push(format!("Warnings of the identification: {}.", list(&codes)));
    }
    lines.extend(file.remarks.iter().cloned());
    for Entry { key, value, unit, meaning, source } in &file.entries {
        lines.push(String::new());
        let (text, space) = (value.text(), if unit.is_empty() { "" } else { " " });
        lines.push(match value {
            Value::Measured(quantity) => format!("{key} = {text}{space}{unit}, {}", interval(quantity, unit)),
            Value::Given(_) | Value::Count(_) => format!("{key} = {text}{space}{unit}, given"),
        });
        lines.push(format!("  {meaning}"));
        lines.push(format!("  {source}"));
    }
    lines.iter().map(|line| one_line(line)).collect()
}

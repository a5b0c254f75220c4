//! Logs of simulated drives whose truth stands beside them: a folder of `NAME.csv` or `NAME.csv.gz`, each with a `NAME.json`.
//!
//! ```json
//! {"truth": {"Rs": 0.045, "Ld": 9e-05, "Lq": 0.00012, "psi_f": 0.011},
//!  "rs_at_end": 0.054, "unseen": true, "drive": {"sat": [0.1, 0.2, 0.1]}}
//! ```
//!
//! `rs_at_end`: R_s is right anywhere between its start and its end. `unseen`: something is wrong that no log shows, a gain common to all
//! sensors say; its numbers are not counted. `drive.sat`: the motor saturates, and no constant is right. A log whose name ends in `prior`
//! is identified with a prior on R_s, the truth with 10 %.

use crate::drives::tally::{Number, Tally};
use fluxfit::{
    Known, Request, Verdict, identify,
    motor::{Motor, Parameter},
};
use fluxfit_log::{LogOptions, read_log};
use serde_json::Value;
use std::{
    error::Error,
    fmt::Write,
    path::{Path, PathBuf},
    time::Instant,
};

/// Standard error of a prior, as a fraction of its value: 10 % are the command line's limit of one standard error.
const PRIOR: f64 = 0.1;

/// What may be asked of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Every number counts.
    Judged,
    /// Something is wrong that no log shows: the answer has to name it.
    Unseen,
    /// No constant is right: none may be identified.
    Saturated,
}

/// A log and its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownLog {
    /// Of the file, without its ending.
    pub name: String,
    path: PathBuf,
    truth: Motor,
    rs_at_end: f64,
    /// What may be asked of it.
    pub kind: Kind,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Of which log.
    pub log: KnownLog,
    /// In the order of the parameters.
    pub numbers: Vec<Number>,
    /// How many errors that no log shows the answer names.
    pub unseen: usize,
    /// Time on the clock, s.
    pub seconds: f64,
}

/// The logs of a folder, by name.
///
/// # Errors
/// If it cannot be read, or a truth is not what it should be.
pub fn read(folder: &Path) -> Result<Vec<KnownLog>, Box<dyn Error>> {
    let mut names: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>()?;
    names.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    names.sort();
    names.iter().map(|path| known(path)).collect()
}

fn known(path: &Path) -> Result<KnownLog, Box<dyn Error>> {
    let document: Value = serde_json::from_slice(&std::fs::read(path)?)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let number = |value: &Value, key: &str| value[key].as_f64().ok_or_else(|| format!("{}: {key} is no number", path.display()));
    let truth = &document["truth"];
    let truth = Motor { rs: number(truth, "Rs")?, ld: number(truth, "Ld")?, lq: number(truth, "Lq")?, psi_f: number(truth, "psi_f")? };
    let saturates = document["drive"]["sat"].is_array();
    let kind = if document["unseen"] == true {
        Kind::Unseen
    } else if saturates {
        Kind::Saturated
    } else {
        Kind::Judged
    };
    let compressed = path.with_extension("csv.gz");
    let path = if compressed.exists() { compressed } else { path.with_extension("csv") };
    Ok(KnownLog { name, path, truth, rs_at_end: document["rs_at_end"].as_f64().unwrap_or(truth.rs), kind })
}

impl KnownLog {
    /// Identifies it with the default request, or with the prior that its name asks for.
    ///
    /// # Errors
    /// If it cannot be read, or has no answer.
    pub fn identified(self) -> Result<Outcome, Box<dyn Error>> {
        let log = read_log(&self.path, &LogOptions::default())?.log;
        let mut request = Request::default();
        if self.name.ends_with("prior") {
            request.known[Parameter::Rs as usize] = Known::Prior { value: self.truth.rs, standard_error: PRIOR * self.truth.rs };
        }
        let began = Instant::now();
        let answer = identify(&log, &request)?;
        let seconds = began.elapsed().as_secs_f64();
        let number = |parameter: Parameter| {
            let (judgement, truth) = (answer.parameter(parameter), self.truth.get(parameter));
            let end = if parameter == Parameter::Rs { self.rs_at_end } else { truth };
            judgement.value().map_or(Number::none(parameter), |value| Number {
                parameter,
                verdict: judgement.verdict,
                error: (value - value.clamp(truth.min(end), truth.max(end))) / truth,
                half_width: judgement.uncertainty.half_width / truth,
            })
        };
        let numbers = Parameter::ALL.map(number).to_vec();
        Ok(Outcome { numbers, unseen: answer.identification.unseen.len(), seconds, log: self })
    }
}

impl Outcome {
    /// Its numbers that are identified.
    pub fn identified(&self) -> impl Iterator<Item = &Number> {
        self.numbers.iter().filter(|number| number.verdict == Verdict::Identified)
    }
}

/// All judged numbers of these logs.
pub fn judged(outcomes: &[Outcome]) -> impl Iterator<Item = &Number> {
    outcomes.iter().filter(|outcome| outcome.log.kind == Kind::Judged).flat_map(|outcome| &outcome.numbers)
}

/// A line for each log, and what they come to, in Markdown.
pub fn table(outcomes: &[Outcome]) -> String {
    let mut text = "| log | R_s, error ± half-width, % | L_d | L_q | psi_f | s |\n|---|--:|--:|--:|--:|--:|\n".to_owned();
    for Outcome { log, numbers, seconds, .. } in outcomes {
        let cell = |number: &Number| {
            let mark = if number.is_wrong() && log.kind == Kind::Judged { " wrong" } else { "" };
            let weak = if number.verdict == Verdict::Weak { " weak" } else { "" };
            match number.is_printed() {
                true => format!("{:+.2} ± {:.2}{weak}{mark}", 100.0 * number.error, 100.0 * number.half_width),
                false => "-".to_owned(),
            }
        };
        let cells = numbers.iter().map(cell).collect::<Vec<_>>().join(" | ");
        let kind = match log.kind {
            Kind::Judged => "",
            Kind::Unseen => " (not seen)",
            Kind::Saturated => " (saturated)",
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {}{kind} | {cells} | {seconds:.1} |", log.name);
    }
    let mut tally = Tally::default();
    judged(outcomes).for_each(|number| tally.add(number));
    let identified = judged(outcomes).filter(|number| number.verdict == Verdict::Identified).count();
    let Tally { asked, printed, wrong, .. } = tally;
    let _ = writeln!(text, "\nJudged: {asked} numbers, {printed} printed, {identified} identified, {wrong} wrong.");
    text
}

//! What a page is made from.

use fluxfit::{
    Remedy, Validation, Warning,
    evidence::Identification,
    fleet::FleetOverview,
    log::Log,
    optimizer::Method,
    steady::OperatingPoint,
    study::{MethodStudy, comparison::Comparison},
};
use fluxfit_track::comparison::OnlineComparison;

/// An identification, a study or both. What is `None` has no section.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Heading of the page, such as the log's name.
    pub title: &'a str,
    /// The log.
    pub log: &'a Log,
    /// Notes on how the log was read or simulated, a sentence each.
    pub notes: &'a [String],
    /// The operating points of the identification, or those over which the study's fitness sums.
    pub operating_points: &'a [OperatingPoint],
    /// The identification, and the method of its swarm.
    pub identification: Option<(&'a Identification, Option<Method>)>,
    /// The rows that were held out of the identification, and their prediction from its answer; `None` there if the answer lacks a
    /// parameter.
    pub held_out: Option<(&'a Log, Option<&'a Validation>)>,
    /// The study's settings, and each method with the seconds per run.
    pub study: Option<(&'a Comparison, &'a [(MethodStudy, f64)])>,
    /// The estimators of a stream on this log.
    pub online: Option<&'a OnlineComparison>,
    /// The JSON document of the result, which a button of the page saves.
    pub json: Option<&'a str>,
    /// What the program that writes the page adds to remedies and warnings.
    pub options: Options,
    /// How to reproduce the page.
    pub origin: &'a Origin,
}

/// How the program that writes a page carries out remedies, and answers warnings: the options of its command.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The option that carries out a remedy.
    pub of_remedy: fn(&Remedy) -> Option<&'static str>,
    /// The option that answers a warning.
    pub of_warning: fn(&Warning) -> Option<&'static str>,
}

impl Default for Options {
    /// No options, as of a program without a command line.
    fn default() -> Self {
        Self { of_remedy: |_| None, of_warning: |_| None }
    }
}

/// How to reproduce a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The command line.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// A validation of given parameters on a log.
#[derive(Debug, Clone, Copy)]
pub struct ValidationReport<'a> {
    /// Name of the log, for the heading of the page.
    pub title: &'a str,
    /// Name of the motor that is validated.
    pub motor: &'a str,
    /// The log.
    pub log: &'a Log,
    /// Notes on how the log was read, a sentence each.
    pub notes: &'a [String],
    /// The result.
    pub found: &'a Validation,
    /// The JSON document of the result, which a button of the page saves.
    pub json: Option<&'a str>,
    /// How to reproduce the page.
    pub origin: &'a Origin,
}

/// The results of a fleet.
#[derive(Debug, Clone, Copy)]
pub struct FleetReport<'a> {
    /// Heading of the page, such as the name of the results.
    pub title: &'a str,
    /// What the results say.
    pub fleet: &'a FleetOverview,
    /// How to reproduce the page.
    pub origin: &'a Origin,
}

//! The verbs: one file each, with its arguments, what it does and what it prints; a long display is a file in the verb's folder.

pub(crate) mod compare;
mod demo;
pub(crate) mod fleet;
mod formats;
pub(crate) mod identify;
pub(crate) mod input;
pub(crate) mod inspect;
mod manual;
pub(crate) mod not_a_log;
pub(crate) mod report;
mod simulate;
mod status;
pub(crate) mod track;
pub(crate) mod validate;

pub(crate) use status::Status;

use crate::error::CommandError;
use clap::Subcommand;

/// The verbs as the first help shows them; a verb that no group names comes last.
pub(crate) const GROUPS: [(&str, &[&str]); 3] = [
    ("Motors", &["identify", "track", "fleet", "validate", "compare"]),
    ("Logs", &["inspect", "formats", "simulate"]),
    ("Program", &["demo", "completions", "man", "help"]),
];

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Show how a log is read: columns, units, ranges, repairs
    ///
    /// Also writes a mapping file to start from, with -o.
    Inspect(inspect::Inspect),
    /// List the known layouts of logs
    Formats,
    /// Run everything on the paper's rig, and write a report
    ///
    /// Simulates the paper's motor in its drive, identifies it, compares four optimizers, and writes a report.
    Demo(demo::Demo),
    /// Identify the parameters, with intervals and verdicts
    Identify(identify::Identify),
    /// Identify many motors: one row each, as a table
    ///
    /// Many logs, or tables of many motors, on all cores. What fails is a row with its reason. A run that was killed goes on where it was,
    /// if it is started again.
    Fleet(Box<fleet::Fleet>),
    /// Follow the parameters of a running motor
    ///
    /// Reads a log, or rows as they arrive, and tells each parameter over time with its interval. Exit status 3: an alarm.
    Track(track::Track),
    /// Compare swarm optimizers: many runs of each, against the minimum
    ///
    /// They minimize the paper's fitness (11), or the output error. After Ctrl-C, the finished runs are shown.
    Compare(compare::Compare),
    /// Simulate a motor in a drive; write its log and true parameters
    Simulate(simulate::Simulate),
    /// Validate given parameters on another log
    ///
    /// Predicts the log with the given parameters and tests the prediction.
    Validate(validate::Validate),
    /// Print the completions for a shell
    ///
    /// bash: fluxfit completions bash > ~/.local/share/bash-completion/completions/fluxfit. zsh: write to a file _fluxfit in a directory of
    /// fpath. fish: fluxfit completions fish > ~/.config/fish/completions/fluxfit.fish. PowerShell: append to the file $PROFILE.
    Completions(manual::Completions),
    /// Write the manual pages, one for each verb
    Man(manual::Man),
}

impl Verb {
    /// Runs the verb. `command` makes the whole command line, for completions and manual pages.
    pub(crate) fn run(&self, command: fn() -> clap::Command) -> Result<Status, CommandError> {
        match self {
            Self::Inspect(arguments) => inspect::run(arguments),
            Self::Formats => formats::run(),
            Self::Demo(arguments) => demo::run(arguments),
            Self::Identify(arguments) => identify::run(arguments),
            Self::Fleet(arguments) => fleet::run(arguments),
            Self::Track(arguments) => track::run(arguments),
            Self::Compare(arguments) => compare::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Validate(arguments) => validate::run(arguments),
            Self::Completions(arguments) => manual::completions(arguments, command()),
            Self::Man(arguments) => manual::pages(arguments, command()),
        }
    }
}

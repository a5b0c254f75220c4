//! The command line of the whole program: its verbs in groups, and the options that all verbs have.

use crate::commands::{GROUPS, Verb};
use anstyle::Style;
use clap::{Args, CommandFactory, Parser};

/// Identifies a permanent magnet synchronous motor from a log of its drive
#[derive(Debug, Parser)]
#[command(name = "fluxfit", version, max_term_width = 110, subcommand_value_name = "VERB", after_help = EXIT_STATUS, arg_required_else_help = true)]
pub(crate) struct Command {
    #[command(subcommand)]
    pub(crate) verb: Option<Verb>,
    /// Explain a warning or finding by its code, e.g. misfit
    #[arg(long, value_name = "CODE", exclusive = true)]
    pub(crate) explain: Option<String>,
    #[command(flatten)]
    pub(crate) telling: Telling,
}

/// How much is told on standard error.
#[derive(Debug, Args)]
pub(crate) struct Telling {
    /// Suppress notes and progress; warnings and errors remain
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Print each decision and its time on standard error
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

const EXIT_STATUS: &str = "Exit status: 0 complete, agrees; 1 not all, differs; 2 error; 3 alarm; 130 ^C";

/// The command with its verbs in groups.
pub(crate) fn command() -> clap::Command {
    let command = Command::command();
    let verbs: Vec<(String, String)> = command
        .get_subcommands()
        .map(|verb| (verb.get_name().to_owned(), verb.get_about().map(ToString::to_string).unwrap_or_default()))
        .chain([("help".to_owned(), "Print the help of a verb".to_owned())])
        .collect();
    let width = verbs.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let is_in = |names: &[&str], name: &str| names.contains(&name);
    let rest: Vec<&str> =
        verbs.iter().map(|(name, _)| name.as_str()).filter(|name| !GROUPS.iter().any(|(_, names)| is_in(names, name))).collect();
    let mut text = String::new();
    for (title, names) in GROUPS.into_iter().chain([("Others", rest.as_slice())]) {
        let lines: String = names
            .iter()
            .filter_map(|name| verbs.iter().find(|(verb, _)| verb == name))
            .map(|(name, about)| format!("  {HEAD}{name:width$}{HEAD:#}  {about}\n"))
            .collect();
        if !lines.is_empty() {
            text += &format!("{TITLE}{title}:{TITLE:#}\n{lines}");
        }
    }
    command.help_template(format!("{{about}}\n{{usage-heading}} {{usage}}\n{text}{TITLE}Options:{TITLE:#}\n{{options}}\n{EXIT_STATUS}"))
}

/// Styles of clap's own headings and names.
const TITLE: Style = Style::new().bold().underline();
const HEAD: Style = Style::new().bold();

//! The command `fluxfit`: arguments become settings, a verb becomes a file under `commands`.
//!
//! Answers go to standard output, everything else to standard error. Exit status: 0 everything asked for was identified, or the
//! log agrees; 1 the log was read but cannot carry some parameter, or differs; 2 misuse or unreadable input; 130 interrupted.

mod arguments;
mod commands;
mod error;
mod interrupt;
mod json;
mod shell;
mod terminal;

use clap::FromArgMatches;
use error::CommandError;
use std::process::ExitCode;
use terminal::Detail;

fn main() -> ExitCode {
    let matches = arguments::command().get_matches();
    let command = match arguments::Command::from_arg_matches(&matches) {
        Ok(command) => command,
        Err(error) => error.format(&mut arguments::command()).exit(),
    };
    terminal::tell(detail(&command.telling), !command.verb.is_json());
    if let Err(error) = interrupt::listen() {
        terminal::note(&format!("Ctrl-C will end this without the best so far: {error}"));
    }
    let outcome = match &command.verb {
        arguments::Verb::Demo(arguments) => commands::demo::run(arguments),
        arguments::Verb::Inspect(arguments) => commands::inspect::run(arguments),
        arguments::Verb::Formats => commands::formats::run(),
        arguments::Verb::Identify(arguments) => commands::identify::run(arguments),
        arguments::Verb::Compare(arguments) => commands::compare::run(arguments),
        arguments::Verb::Simulate(arguments) => commands::simulate::run(arguments),
        arguments::Verb::Validate(arguments) => commands::validate::run(arguments),
        arguments::Verb::Completions(arguments) => commands::manual::completions(arguments),
        arguments::Verb::Man(arguments) => commands::manual::pages(arguments),
    };
    match outcome {
        Ok(status) => interrupt::exit_status().map_or_else(|| status.into(), ExitCode::from),
        // Whoever closed the pipe has seen enough.
        Err(CommandError::Output(error)) if error.kind() == std::io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            terminal::complain(&error, error.in_file());
            ExitCode::from(2)
        }
    }
}

fn detail(telling: &arguments::Telling) -> Detail {
    match (telling.quiet, telling.verbose) {
        (true, _) => Detail::Quiet,
        (false, true) => Detail::Everything,
        (false, false) => Detail::Notes,
    }
}

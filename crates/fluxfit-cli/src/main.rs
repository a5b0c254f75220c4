//! The command `fluxfit`: arguments become settings, a verb becomes a file under `commands`.
//!
//! Answers go to standard output, everything else to standard error. Exit status: 0 everything asked for was identified, or the
//! log agrees; 1 the log was read but cannot carry some parameter, or differs; 2 misuse or unreadable input.

mod arguments;
mod commands;
mod error;
mod shell;
mod terminal;

use clap::Parser;
use error::CommandError;
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = arguments::Command::parse();
    let outcome = match &command.verb {
        arguments::Verb::Demo(arguments) => commands::demo::run(arguments),
        arguments::Verb::Inspect(arguments) => commands::inspect::run(arguments),
        arguments::Verb::Formats => commands::formats::run(),
        arguments::Verb::Identify(arguments) => commands::identify::run(arguments),
        arguments::Verb::Compare(arguments) => commands::compare::run(arguments),
        arguments::Verb::Simulate(arguments) => commands::simulate::run(arguments),
        arguments::Verb::Validate(arguments) => commands::validate::run(arguments),
    };
    match outcome {
        Ok(status) => status.into(),
        // Whoever closed the pipe has seen enough.
        Err(CommandError::Output(error)) if error.kind() == std::io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            terminal::complain(&error);
            ExitCode::from(2)
        }
    }
}

//! The command `fluxfit` as a library: its [`run`] is the whole program, for whoever carries it inside another one; [`face`] is for other
//! faces, which want its arguments and its answers, and nothing printed. Arguments become settings, a verb becomes a file under `commands`.
//!
//! Answers go to standard output, everything else to standard error. Exit status: 0 everything asked for was identified, or the
//! log agrees; 1 the log was read but cannot carry some parameter, or differs; 2 misuse or unreadable input; 130 interrupted.

mod arguments;
mod command_line;
mod commands;
mod error;
mod explanations;
pub mod face;
mod interrupt;
mod invocation;
mod json;
mod shell;
mod terminal;

use clap::{
    FromArgMatches,
    error::{ContextKind, ContextValue, ErrorKind},
};
use error::CommandError;
use fluxfit_units::wording::one_line;
use std::{ffi::OsString, path::Path, process::ExitCode};
use terminal::Detail;

/// Runs the command; the first word is the program's name. Where clap answers (help, version, misuse), the process ends.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = words.into_iter().collect();
    let matches = command_line::command().try_get_matches_from(&words);
    invocation::remember(words);
    let matches = match matches {
        Ok(matches) => matches,
        Err(error) => {
            let words = invocation::words();
            if let Some(hint) = log_in_place_of_verb(&error).or_else(|| output_in_place_of_report(&error, words)) {
                terminal::print_error(&CommandError::Usage(hint));
                return ExitCode::from(2);
            }
            error.exit()
        }
    };
    let command = match command_line::Command::from_arg_matches(&matches) {
        Ok(command) => command,
        Err(error) => error.format(&mut command_line::command()).exit(),
    };
    // Standard output is for a program: no progress.
    let is_json = matches.subcommand().is_some_and(|(_, verb)| matches!(verb.try_get_one("json"), Ok(Some(true))));
    terminal::tell(detail(&command.telling), !is_json);
    if let Err(error) = interrupt::listen() {
        terminal::note(&format!("Ctrl-C will end this without the best so far: {error}"));
    }
    let outcome = match (&command.verb, &command.explain) {
        (Some(verb), _) => verb.run(command_line::command),
        (None, Some(code)) => explanations::show(code),
        (None, None) => {
            let missing = clap::error::ErrorKind::MissingSubcommand;
            command_line::command().error(missing, "a verb is missing, such as identify; see fluxfit --help").exit()
        }
    };
    match outcome {
        Ok(_) if terminal::is_unread() => {
            terminal::unwritten().into_iter().for_each(|error| terminal::print_error(&error.into()));
            ExitCode::from(2)
        }
        Ok(status) => interrupt::exit_status().map_or_else(|| status.into(), ExitCode::from),
        // Whoever closed the pipe of a stream has seen enough.
        Err(CommandError::Output(error)) if error.kind() == std::io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            terminal::print_error(&error);
            ExitCode::from(2)
        }
    }
}

/// What to say to somebody who names a file where a verb belongs.
fn log_in_place_of_verb(error: &clap::Error) -> Option<String> {
    let word = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(word)) if error.kind() == ErrorKind::InvalidSubcommand => word,
        _ => return None,
    };
    let path = Path::new(word);
    let looks_like_file = path.is_file() || path.extension().is_some() || word.contains('/');
    looks_like_file.then(|| {
        let argument = shell::word(path.as_os_str());
        format!("{} is no command; to identify a motor from this log: fluxfit identify {}", one_line(word), one_line(&argument))
    })
}

/// What to say to somebody who names a page with `-o` to a verb that has no such option.
fn output_in_place_of_report(error: &clap::Error, words: &[OsString]) -> Option<String> {
    let option = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(option)) if error.kind() == ErrorKind::UnknownArgument => option,
        _ => return None,
    };
    let after = words.iter().skip_while(|word| *word != option.as_str()).nth(1);
    let page = after.map(Path::new).filter(|path| path.extension().is_some_and(|extension| extension == "html"))?;
    let is_output = matches!(option.as_str(), "-o" | "--output" | "--out");
    is_output.then(|| format!("{option} is no option of this verb; to write a page: --report {}", one_line(&shell::word(page.as_os_str()))))
}

fn detail(telling: &command_line::Telling) -> Detail {
    match (telling.quiet, telling.verbose) {
        (true, _) => Detail::Quiet,
        (false, true) => Detail::Everything,
        (false, false) => Detail::Notes,
    }
}

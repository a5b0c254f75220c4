//! `fluxfit completions` and `fluxfit man`: what a packager installs beside the program, made from the arguments themselves.

use super::Status;
use crate::{error::CommandError, terminal};
use clap::Args;
use fluxfit_files::write_atomically;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// Directory for the pages, for example ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    directory: PathBuf,
}

/// Prints the completions of a shell.
pub(crate) fn completions(arguments: &Completions, mut command: clap::Command) -> Result<Status, CommandError> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "fluxfit", &mut text);
    terminal::stream(|out| out.write_all(&text))?;
    Ok(Status::Complete)
}

/// Writes a page for the command and one for each verb.
pub(crate) fn pages(arguments: &Man, command: clap::Command) -> Result<Status, CommandError> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let verbs = command.get_subcommands().cloned().collect::<Vec<_>>();
    for page in [command].into_iter().chain(verbs) {
        let page = clap_mangen::Man::new(page).manual("fluxfit").source(concat!("fluxfit ", env!("CARGO_PKG_VERSION")));
        let mut text = Vec::new();
        page.render(&mut text)?;
        let path = arguments.directory.join(page.get_filename());
        write_atomically(&path, &text)?;
        terminal::detail(|| path.display().to_string());
    }
    Ok(Status::Complete)
}

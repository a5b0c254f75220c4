//! The command `fluxfit`.

use std::process::ExitCode;

fn main() -> ExitCode {
    fluxfit_cli::run(std::env::args_os())
}

//! `fluxfit formats`: the layouts of logs that are known.

use super::Status;
use crate::{error::CommandError, terminal};

/// Runs the verb.
pub(crate) fn run() -> Result<Status, CommandError> {
    terminal::formats::show()?;
    Ok(Status::Complete)
}

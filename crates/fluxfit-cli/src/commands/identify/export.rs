//! `--export TARGET=FILE`: refused before anything is computed where it cannot be written, and after the answer is printed where
//! the answer does not carry it.

use crate::{
    arguments::LogArguments,
    commands::{Status, input::Input},
    error::CommandError,
    terminal,
};
use fluxfit::Answer;
use fluxfit_answer::export::{Export, Refusal, Target, export};
use fluxfit_files::{check_writable, write_atomically};
use fluxfit_units::{
    key_value,
    wording::{did_you_mean, list, nearest, quote},
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// A target and its file.
type Wanted = (Target, PathBuf);

/// The help of the option.
pub(super) fn help() -> String {
    format!("Write the result as a file for another tool: {}; repeatable", Target::ALL.map(Target::key).join(", "))
}

/// `vesc=motor.xml`: a tool, and the file that is written for it.
pub(crate) fn parse(text: &str) -> Result<(Target, PathBuf), String> {
    let (name, file) = key_value(text, "TARGET=FILE", "vesc=motor.xml").map_err(|error| error.to_string())?;
    let keys = Target::ALL.map(Target::key);
    let unknown = || format!("{} is no target of --export; there are {}{}", quote(name), list(&keys), did_you_mean(nearest(name, keys)));
    Ok((Target::named(name).ok_or_else(unknown)?, PathBuf::from(file)))
}

/// Refuses files that would mix with the answer, take the place of what is read or of each other, or cannot be written.
pub(super) fn check(log: &LogArguments, exports: &[Wanted]) -> Result<(), CommandError> {
    let refuse = |path: &Path, why: &str| Err(CommandError::Usage(format!("--export {}: {why}; name another one", path.display())));
    let read = log.logs.iter().chain(&log.motor).filter_map(|path| fs::canonicalize(path).ok());
    let mut taken: Vec<PathBuf> = read.collect();
    let inputs = taken.len();
    taken.extend(log.report.as_deref().map(place));
    for (_, path) in exports {
        if path.as_os_str() == "-" {
            return Err(CommandError::Usage("--export needs the name of a file: standard output is for the answer".to_owned()));
        }
        let own = place(path);
        match taken.iter().position(|other| *other == own) {
            Some(k) if k < inputs => return refuse(path, "this file is read"),
            Some(_) if fluxfit_files::is_replaceable(path) => return refuse(path, "this file is written already"),
            _ => {}
        }
        check_writable(path)?;
        taken.push(own);
    }
    Ok(())
}

/// Refuses targets that need pole pairs that nobody gave.
pub(super) fn check_pole_pairs(exports: &[Wanted], pole_pairs: Option<u32>) -> Result<(), CommandError> {
    let mut targets = exports.iter().map(|(target, _)| target);
    targets.try_for_each(|target| target.check_pole_pairs(pole_pairs)).map_err(|refusal| CommandError::Usage(with_option(&refusal)))
}

/// Writes what the answer carries; what it does not is said, and costs the status.
pub(super) fn write(log: &LogArguments, exports: &[Wanted], input: &Input, answer: &Answer) -> Result<Status, CommandError> {
    let logs: Vec<String> = log.logs.iter().map(|path| file_name(path)).collect();
    let pole_pairs = input.pole_pairs;
    let exported = Export { logs: &logs, identification: &answer.identification, pole_pairs, current_loop: answer.current_loop.as_ref() };
    let mut status = Status::Complete;
    for (target, path) in exports {
        match export(*target, &exported) {
            Ok(text) => {
                write_atomically(path, text.as_bytes())?;
                terminal::wrote("export", path);
            }
            Err(refusal) => {
                terminal::refuse_export(path, &with_option(&refusal));
                status = Status::Incomplete;
            }
        }
    }
    Ok(status)
}

/// The reason for no file, with the option that resolves it.
pub(crate) fn with_option(refusal: &Refusal) -> String {
    match refusal {
        Refusal::PolePairs { .. } => format!("{refusal} (--pole-pairs N, or --motor FILE with pole_pairs)"),
        Refusal::NotIdentified { .. } => refusal.to_string(),
    }
}

/// Where a file lies or would lie.
fn place(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| {
        let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::canonicalize(directory).unwrap_or_else(|_| directory.to_owned()).join(path.file_name().unwrap_or_default())
    })
}

/// Without its directories: an export is passed on, and where a log lay is nobody's business there.
pub(crate) fn file_name(path: &Path) -> String {
    match path.file_name() {
        Some(_) if path.as_os_str() == "-" => "standard input".to_owned(),
        Some(name) => name.to_string_lossy().into_owned(),
        None => path.display().to_string(),
    }
}

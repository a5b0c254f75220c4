//! Atomic writing: a file is replaced as a whole or left as it was.

use crate::{
    error::FileError,
    input::{io_problem, is_standard, name},
    problem::Problem,
};
use std::{
    fs,
    io::{self, BufWriter, Stdout, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
    time::Duration,
};
use tempfile::NamedTempFile;

/// Names of temporary files.
const PREFIX: &str = ".fluxfit-";
const SUFFIX: &str = ".tmp";

/// A file is locked this soon after it is made.
const BEFORE_LOCK: Duration = Duration::from_millis(100);

/// Links that may lead to a file one after the other.
const MOST_LINKS: usize = 40;

/// Bytes that are written at once.
const BUFFER: usize = 1 << 16;

/// Writes a file atomically: into a new file in the same directory, which is then renamed. A file that is replaced keeps its
/// permissions; a link still points to the same target. The path `-` is standard output; standard output and devices are written
/// directly.
///
/// # Errors
/// If the directory does not exist or the file cannot be written there.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let mut output = Output::open(path)?;
    output.fill(|writer| writer.write_all(bytes))?;
    output.commit()
}

/// A file that is being written under a temporary name; several can be written before the first is committed. Dropping it without
/// [`commit`](Self::commit) removes it.
#[derive(Debug)]
pub struct Output {
    name: String,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Standard(Stdout),
    /// A device or a pipe: renaming over it would replace it.
    Device(fs::File),
    File {
        file: NamedTempFile,
        listed: Listed,
        target: PathBuf,
        permissions: Option<fs::Permissions>,
    },
}

impl Output {
    /// Creates the temporary file.
    ///
    /// # Errors
    /// If the directory does not exist or no file can be made there.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let name = if is_standard(path) { "standard output".to_owned() } else { name(path) };
        let sink = if is_standard(path) { Ok(Sink::Standard(io::stdout())) } else { open(path) };
        sink.map_err(|error| error.in_file(&name)).map(|sink| Self { name, sink })
    }

    /// Writes into the file, through a buffer.
    ///
    /// # Errors
    /// If writing fails.
    pub fn fill(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        let sink: &mut dyn Write = match &mut self.sink {
            Sink::Standard(output) => output,
            Sink::Device(file) => file,
            Sink::File { file, .. } => file,
        };
        let mut buffer = BufWriter::with_capacity(BUFFER, sink);
        write(&mut buffer).and_then(|()| buffer.flush()).map_err(|error| FileError::from(problem(&error)).in_file(&self.name))
    }

    /// Renames the file to its final name.
    ///
    /// # Errors
    /// If writing to the disk or renaming fails.
    pub fn commit(self) -> Result<(), FileError> {
        let Sink::File { file, listed: _listed, target, permissions } = self.sink else { return Ok(()) };
        let replace = || {
            if let Some(permissions) = permissions {
                file.as_file().set_permissions(permissions)?;
            }
            // Without it a crash may keep the name and lose the content.
            file.as_file().sync_all()?;
            file.persist(&target).map(|_| ()).map_err(|error| error.error)
        };
        replace().map_err(|error: io::Error| FileError::from(problem(&error)).in_file(&self.name))
    }
}

/// Temporary files that are not committed. A process that ends on a signal runs no destructors, so it needs this list to remove them.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is valid even if a thread panicked while holding the lock.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An entry of [`UNFINISHED`] that is removed on drop.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

/// Removes the temporary files of every [`Output`] that is not committed. For a process that is about to end: afterwards no output
/// can be opened or committed.
pub fn discard_unfinished() {
    let unfinished = unfinished();
    unfinished.iter().for_each(|path| drop(fs::remove_file(path)));
    // The lock is never released, so no thread can start another file before the process ends.
    std::mem::forget(unfinished);
}

/// Whether a file with this path can be replaced: it is not standard output, a device or a pipe.
pub fn is_replaceable(path: &Path) -> bool {
    !is_standard(path) && fs::metadata(path).map_or(true, |metadata| metadata.is_file() || metadata.is_dir())
}

/// Checks whether [`Output::open`] would succeed, without changing anything.
///
/// # Errors
/// As [`Output::open`].
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    // Opening and closing a pipe would end it for its reader.
    if is_replaceable(path) { Output::open(path).map(drop) } else { Ok(()) }
}

fn open(path: &Path) -> Result<Sink, FileError> {
    let existing = fs::metadata(path).ok();
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) || path.file_name().is_none() {
        return Err(Problem::Directory.into());
    }
    if existing.is_some() && !is_replaceable(path) {
        let device = fs::OpenOptions::new().write(true).open(path);
        return device.map(Sink::Device).map_err(|error| problem(&error).into());
    }
    let target = fs::canonicalize(path).unwrap_or_else(|_| target_of_link(path));
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !directory.is_dir() {
        return Err(Problem::NoDirectory { directory: directory.display().to_string() }.into());
    }
    let (file, listed) = temporary(directory).map_err(|error| problem(&error))?;
    let permissions = existing.map(|metadata| metadata.permissions());
    Ok(Sink::File { file, listed, target, permissions })
}

/// Where a link leads whose target does not exist yet; the path itself, if it is no link.
fn target_of_link(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&target) else { break };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    target
}

/// Removes the temporary files of programs that were killed: nobody holds their locks.
fn remove_abandoned(directory: &Path) {
    let is_temporary = |name: &str| name.starts_with(PREFIX) && name.ends_with(SUFFIX);
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let age = |entry: &fs::DirEntry| entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        let is_old = || age(&entry).is_some_and(|age| age > BEFORE_LOCK);
        if entry.file_name().to_str().is_some_and(is_temporary)
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && is_old()
            && fs::File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
        {
            // Another run may have done so.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A temporary file with the permissions that the user's mask allows, instead of those of the user alone.
fn temporary(directory: &Path) -> io::Result<(NamedTempFile, Listed)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    remove_abandoned(directory);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut unfinished = unfinished();
    let file = builder.tempfile_in(directory)?;
    // Where a file system has no locks, nothing is removed.
    let _ = file.as_file().try_lock();
    unfinished.push(file.path().to_owned());
    let listed = Listed(file.path().to_owned());
    Ok((file, listed))
}

fn problem(error: &io::Error) -> Problem {
    io_problem("writing", error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_created_and_replaced_and_no_temporary_file_remains() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("answer.json");
        for text in ["first", "second, longer", "3"] {
            write_atomically(&path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_links_and_devices_are_kept() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let (path, link) = (directory.path().join("a"), directory.path().join("link"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        let null = Path::new("/dev/null");
        write_atomically(null, b"gone").unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
    }

    #[test]
    fn an_output_that_is_not_committed_leaves_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("log.csv");
        check_writable(&path).unwrap();
        let mut output = Output::open(&path).unwrap();
        output.fill(|writer| writer.write_all(b"half")).unwrap();
        assert!(is_replaceable(&path) && !path.exists());
        drop(output);
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_a_killed_run_left_is_removed_and_what_another_one_writes_is_kept() {
        let directory = tempfile::tempdir().unwrap();
        let (left, own) = (directory.path().join(".fluxfit-abc.tmp"), directory.path().join(".fluxfit.tmp"));
        fs::write(&left, "half").unwrap();
        fs::write(&own, "of the user").unwrap();
        std::thread::sleep(2 * BEFORE_LOCK);
        let path = directory.path().join("log.csv");
        let writing = Output::open(&path).unwrap();
        assert!(!left.exists() && own.exists());
        std::thread::sleep(2 * BEFORE_LOCK);
        drop(Output::open(&path).unwrap());
        writing.commit().unwrap();
        assert!(path.exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_file_that_does_not_exist_yet_is_kept() {
        let directory = tempfile::tempdir().unwrap();
        let link = directory.path().join("link");
        std::os::unix::fs::symlink("target", &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(directory.path().join("target")).unwrap(), "new");
    }

    #[test]
    fn refusals_name_the_file_and_what_is_wrong() {
        let directory = tempfile::tempdir().unwrap();
        let shown = directory.path().display().to_string();
        let refusal = |path: &Path| write_atomically(path, b"").unwrap_err().to_string();
        assert_eq!(refusal(directory.path()), format!("{shown}: this is a directory; name a file in it"));
        let missing = directory.path().join("no").join("a.json");
        let sentence = refusal(&missing);
        assert!(sentence.starts_with(&missing.display().to_string()) && sentence.contains("does not exist; create it"), "{sentence}");
    }
}

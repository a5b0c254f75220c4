//! Writing: the whole file, or the file as it was.

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
};
use tempfile::NamedTempFile;

/// Bytes that are written at once.
const BUFFER: usize = 1 << 16;

/// Writes a file so that nobody ever sees half of it: into a new file beside it, which then takes its name. What was there keeps
/// its permissions; a link keeps pointing to where it did. The path `-` is standard output; that and devices are written
/// directly.
///
/// # Errors
/// If the directory does not exist or the file cannot be written there.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let mut output = Output::open(path)?;
    output.fill(|writer| writer.write_all(bytes))?;
    output.commit()
}

/// A file that is being written and has not taken its name yet: several can be filled before the first one does. Dropped, it was
/// never there.
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
    /// Opens a file for [`write_atomically`] by parts.
    ///
    /// # Errors
    /// If the directory does not exist or no file can be made there.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let name = if is_standard(path) { "standard output".to_owned() } else { name(path) };
        let sink = if is_standard(path) { Ok(Sink::Standard(io::stdout())) } else { open(path) };
        sink.map_err(|error| error.in_file(&name)).map(|sink| Self { name, sink })
    }

    /// Writes into it, through a buffer.
    ///
    /// # Errors
    /// Those of writing.
    pub fn fill(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        let sink: &mut dyn Write = match &mut self.sink {
            Sink::Standard(output) => output,
            Sink::Device(file) => file,
            Sink::File { file, .. } => file,
        };
        let mut buffer = BufWriter::with_capacity(BUFFER, sink);
        write(&mut buffer).and_then(|()| buffer.flush()).map_err(|error| FileError::from(problem(&error)).in_file(&self.name))
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// Those of writing to the disk and of renaming.
    pub fn commit(self) -> Result<(), FileError> {
        let Sink::File { file, listed: _listed, target, permissions } = self.sink else { return Ok(()) };
        let replace = || {
            if let Some(permissions) = permissions {
                file.as_file().set_permissions(permissions)?;
            }
            // Else a crash may keep the name and lose the bytes.
            file.as_file().sync_all()?;
            file.persist(&target).map(|_| ()).map_err(|error| error.error)
        };
        replace().map_err(|error: io::Error| FileError::from(problem(&error)).in_file(&self.name))
    }
}

/// Files that have no name of their own yet. A process that a signal ends drops nothing, so it must know them.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of names is whole at any time.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A name in [`UNFINISHED`], as long as this lives.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

/// Removes every file of an [`Output`] that has not taken its name yet. For a process that ends at once: no other one can be begun
/// afterwards, and none of these committed.
pub fn discard_unfinished() {
    let unfinished = unfinished();
    unfinished.iter().for_each(|path| drop(fs::remove_file(path)));
    // Locked for good: who waits for it ends with the process.
    std::mem::forget(unfinished);
}

/// Whether something can be put in place of this path: it is neither standard output nor a device or a pipe.
pub fn is_replaceable(path: &Path) -> bool {
    !is_standard(path) && fs::metadata(path).map_or(true, |metadata| metadata.is_file() || metadata.is_dir())
}

/// Tells beforehand what [`Output::open`] would, and leaves everything as it is.
///
/// # Errors
/// As [`Output::open`].
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    // Whoever reads a pipe takes its closing for the end.
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
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !directory.is_dir() {
        return Err(Problem::NoDirectory { directory: directory.display().to_string() }.into());
    }
    let (file, listed) = beside(directory).map_err(|error| problem(&error))?;
    let permissions = existing.map(|metadata| metadata.permissions());
    Ok(Sink::File { file, listed, target, permissions })
}

/// A new file, readable by whom the user's mask allows rather than by the user alone.
fn beside(directory: &Path) -> io::Result<(NamedTempFile, Listed)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".fluxfit-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut unfinished = unfinished();
    let file = builder.tempfile_in(directory)?;
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
    fn a_file_is_made_and_replaced_and_nothing_is_left_beside_it() {
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
    fn permissions_links_and_devices_survive() {
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
    fn what_is_not_committed_was_never_there() {
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

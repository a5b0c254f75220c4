//! Writing: the whole file, or the file as it was.

use crate::{
    error::{FileError, Problem},
    input::{io_problem, is_standard, name},
};
use std::{
    fs,
    io::{self, Write},
    path::Path,
};
use tempfile::NamedTempFile;

/// Writes a file so that nobody ever sees half of it: into a new file beside it, which then takes its name. What was there keeps
/// its permissions; a link keeps pointing to where it did. The path `-` is standard output; that and devices are written
/// directly.
///
/// # Errors
/// If the directory does not exist or the file cannot be written there.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let written = if is_standard(path) {
        let mut output = io::stdout().lock();
        output.write_all(bytes).and_then(|()| output.flush()).map_err(|error| problem(&error).into())
    } else {
        write(path, bytes)
    };
    let name = if is_standard(path) { "standard output".to_owned() } else { name(path) };
    written.map_err(|error: FileError| error.in_file(&name))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let existing = fs::metadata(path).ok();
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) || path.file_name().is_none() {
        return Err(Problem::Directory.into());
    }
    if existing.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        // Renaming over a device or a pipe would replace it.
        return fs::OpenOptions::new()
            .write(true)
            .open(path)
            .and_then(|mut file| file.write_all(bytes))
            .map_err(|error| problem(&error).into());
    }
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !directory.is_dir() {
        return Err(Problem::NoDirectory { directory: directory.display().to_string() }.into());
    }
    let replace = || {
        let mut file = beside(directory)?;
        file.write_all(bytes)?;
        if let Some(metadata) = existing {
            file.as_file().set_permissions(metadata.permissions())?;
        }
        // Else a crash may keep the name and lose the bytes.
        file.as_file().sync_all()?;
        file.persist(&target).map(|_| ()).map_err(|error| error.error)
    };
    replace().map_err(|error: io::Error| problem(&error).into())
}

/// A new file, readable by whom the user's mask allows rather than by the user alone.
fn beside(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".fluxfit-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
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

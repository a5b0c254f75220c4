//! Bytes and text of a file, or of standard input, whose path is `-`.

use crate::{error::FileError, problem::Problem};
use fluxfit_units::wording::{nearest, one_line};
use std::{
    fs,
    io::{self, Read},
    path::Path,
};

/// Whether a path means standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// The name of a file in messages.
pub fn name(path: &Path) -> String {
    if is_standard(path) { "standard input".to_owned() } else { one_line(&path.display().to_string()) }
}

/// Where the bytes of a file come from.
pub enum Bytes {
    /// A file, which can be read at any offset. Where it is read from its beginning to its end, the function is called with the
    /// number of bytes of each read.
    File(fs::File, Box<dyn Fn(u64)>),
    /// Standard input, a pipe, or bytes in memory.
    Stream(Box<dyn Read>),
}

impl Bytes {
    /// The same bytes; of a file, `progress` is called with the number of bytes of each read.
    #[must_use]
    pub fn with_progress(self, progress: impl Fn(u64) + 'static) -> Self {
        match self {
            Self::File(file, _) => Self::File(file, Box::new(progress)),
            stream @ Self::Stream(_) => stream,
        }
    }
}

/// A file that reports how much of it was read.
pub struct Reporting {
    /// The file.
    pub file: fs::File,
    /// Called with the number of bytes of each read.
    pub progress: Box<dyn Fn(u64)>,
}

impl Read for Reporting {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        (self.progress)(count as u64);
        Ok(count)
    }
}

/// Opens a file, or standard input.
///
/// # Errors
/// If it cannot be opened, or is a directory.
pub fn open(path: &Path) -> Result<Bytes, FileError> {
    if is_standard(path) {
        return Ok(Bytes::Stream(Box::new(io::stdin())));
    }
    let file = fs::File::open(path).and_then(|file| {
        let metadata = file.metadata()?;
        // Opening a directory succeeds on some systems.
        if metadata.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok((file, metadata.is_file())) }
    });
    match file {
        Ok((file, true)) => Ok(Bytes::File(file, Box::new(|_| ()))),
        Ok((pipe, false)) => Ok(Bytes::Stream(Box::new(pipe))),
        Err(error) => Err(FileError::from(opening_problem(path, &error)).in_file(&name(path))),
    }
}

/// Reads a whole file, or standard input.
///
/// # Errors
/// If it cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    let bytes = if is_standard(path) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    bytes.map_err(|error| FileError::from(opening_problem(path, &error)).in_file(&name(path)))
}

/// The whole text, without a byte order mark. `wanted` names the expected format in the message.
///
/// # Errors
/// If the bytes are not UTF-8, contain a zero, or are blank.
pub fn text<'a>(bytes: &'a [u8], wanted: &'static str) -> Result<&'a str, FileError> {
    let refuse = |at: usize| FileError::from(Problem::NotText { wanted }).at_line(line_at(bytes, at));
    let text = str::from_utf8(bytes).map_err(|error| refuse(error.valid_up_to()))?;
    if bytes.contains(&0) {
        return Err(refuse(bytes.iter().position(|byte| *byte == 0).unwrap_or(0)));
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() { Err(Problem::Empty.into()) } else { Ok(text) }
}

/// The line, from 1, of the byte at `offset`. Lines end with `\n`, `\r\n` or `\r`.
pub fn line_at(bytes: &[u8], offset: usize) -> u64 {
    let offset = offset.min(bytes.len());
    let ends = (0..offset).filter(|&at| match bytes[at] {
        b'\n' => true,
        b'\r' => bytes.get(at + 1) != Some(&b'\n'),
        _ => false,
    });
    1 + ends.count() as u64
}

/// The problem of a file that could not be opened: where there is none, with a file of the same folder whose name is nearly that.
fn opening_problem(path: &Path, error: &io::Error) -> Problem {
    match io_problem("reading", error) {
        Problem::NotFound { .. } => Problem::NotFound { nearest: neighbour(path) },
        problem => problem,
    }
}

/// Most names of a folder that are compared.
const MOST_NAMES: usize = 10_000;

/// A file of the folder with a similar name, as a path that can be pasted. Names are compared without their extensions, which are alike.
fn neighbour(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?.take(MOST_NAMES).flatten();
    let files = entries.filter(|entry| entry.file_type().is_ok_and(|kind| !kind.is_dir())).map(|entry| entry.file_name());
    let mut names: Vec<String> = files.filter_map(|name| name.into_string().ok()).collect();
    // Folders list their files in any order.
    names.sort_unstable();
    let stem = |name: &str| Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or(name).to_owned();
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let found = nearest(path.file_stem()?.to_str()?, stems.iter().map(String::as_str))?;
    let extension = path.extension().and_then(|extension| extension.to_str());
    let has_stem = || names.iter().zip(&stems).filter(|(_, stem)| *stem == found).map(|(name, _)| name);
    let name = has_stem().find(|name| Path::new(name.as_str()).extension().and_then(|other| other.to_str()) == extension);
    let name = name.or_else(|| has_stem().next())?;
    Some(folder.map_or_else(|| name.clone(), |folder| folder.join(name).display().to_string()))
}

/// The problem behind an error of the operating system.
pub fn io_problem(action: &'static str, error: &io::Error) -> Problem {
    match error.kind() {
        io::ErrorKind::NotFound => Problem::NotFound { nearest: None },
        io::ErrorKind::PermissionDenied => Problem::NotPermitted,
        io::ErrorKind::IsADirectory => Problem::Directory,
        _ => Problem::Io { action, reason: error.to_string() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_counted_as_an_editor_does() {
        let bytes = b"a\nb\r\nc\rd\n\ne";
        let lines: Vec<u64> = b"abcde".iter().map(|c| line_at(bytes, bytes.iter().position(|b| b == c).unwrap())).collect();
        assert_eq!(lines, [1, 2, 3, 4, 6]);
        assert_eq!(line_at(bytes, 999), 6);
    }

    #[test]
    fn reasons_why_a_file_cannot_be_read_are_distinguished() {
        let refusal = |path: &str| read(Path::new(path)).unwrap_err().to_string();
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().to_str().unwrap();
        assert_eq!(refusal(path), format!("{path}: this is a directory; name a file in it"));
        assert_eq!(name(Path::new("-")), "standard input");
        assert_eq!(refusal(&format!("{path}/x.csv")), format!("{path}/x.csv: there is no such file; check the path"));
        // Of files with a similar name, that with the same extension.
        for name in ["x_1.csv", "x_1.json", "other.csv"] {
            fs::write(directory.path().join(name), "").unwrap();
        }
        assert_eq!(refusal(&format!("{path}/x1.csv")), format!("{path}/x1.csv: there is no such file; did you mean {path}/x_1.csv?"));
        let problem = |kind: io::ErrorKind| io_problem("reading", &kind.into()).to_string();
        assert_eq!(problem(io::ErrorKind::PermissionDenied), "permission is denied; change the permissions, or name another file");
        assert_eq!(problem(io::ErrorKind::TimedOut), "reading failed: timed out; try again, or name another file");
    }

    #[test]
    fn only_text_is_accepted() {
        assert_eq!(text("\u{feff}a".as_bytes(), "CSV"), Ok("a"));
        assert_eq!(text(b" \n", "CSV").unwrap_err().to_string(), "the file is empty; export it again");
        let refusal = "line 2: this is not text in UTF-8; export it as CSV in UTF-8";
        for bytes in [b"a\n\xe9\n".as_slice(), b"a\n\0"] {
            assert_eq!(text(bytes, "CSV").unwrap_err().to_string(), refusal);
        }
    }
}

//! Containers of columns of numbers that are not text: Parquet, MATLAB's MAT, HDF5 and ASAM MDF 4.
//!
//! A container says which columns it has, and gives the wanted ones block by block. What a column means is not known here.
//! A damaged file gives a sentence. No length that a file states is believed before it is checked against what is left of it,
//! so that a small file cannot claim much memory.

mod guard;
mod mat;
#[cfg(feature = "mdf4")]
mod mdf4;
mod number;
mod parquet;
mod source;
#[cfg(test)]
mod tests;

pub(crate) use source::Source;

use crate::block::Head;
use crate::problem::Problem;
use fluxfit_files::FileError;
use std::io;

/// Rows of a block at most. Ten columns of them are 160 KiB, which stay in the cache beside the pages that they come from: with 64 Ki rows,
/// Snappy's pages were read at half the rate.
pub(crate) const BLOCK: usize = 1 << 11;

/// Columns of a file at most. A log has some hundred at most; a flux map of 256 x 256 points has some thousand.
const MOST_COLUMNS: usize = 20_000;

/// Whether the start of a file says that it is one of these containers; MAT 4 says nothing that a text might not say.
pub(crate) fn is_told_by(start: &[u8]) -> bool {
    const STARTS: [&[u8]; 6] = [b"PAR1", b"PARE", b"MDF     ", b"UnFinMF ", b"MATLAB ", b"\x89HDF\r\n\x1a\n"];
    STARTS.iter().any(|known| start.starts_with(known))
}

/// A container that was opened.
pub(crate) enum Binary {
    Parquet(Box<parquet::Parquet>),
    Mat(Box<mat::Mat>),
    #[cfg(feature = "mdf4")]
    Mdf4(Box<mdf4::Mdf4>),
}

impl Binary {
    /// None if the begin of the file says that it is none of these containers.
    ///
    /// # Errors
    /// If the file is damaged, or a container that cannot be read, or has no column of numbers.
    pub(crate) fn open(file: Source) -> Result<Option<Self>, FileError> {
        let mut start = [0; 1024];
        let count = file.read_at(0, &mut start).map_err(|error| FileError::from(fluxfit_files::input::io_problem("reading", &error)))?;
        let start = &start[..count];
        if start.starts_with(b"PAR1") {
            return Ok(Some(Self::Parquet(Box::new(parquet::Parquet::open(file)?))));
        }
        if start.starts_with(b"PARE") {
            return Err(Problem::Container { format: "Parquet", fault: "it is encrypted; export it without encryption".to_owned() }.into());
        }
        if start.starts_with(b"MDF     ") || start.starts_with(b"UnFinMF ") {
            return mdf(start, file).map(Some);
        }
        Ok(mat::Mat::open(start, file)?.map(|mat| Self::Mat(Box::new(mat))))
    }

    /// What it is, in a word.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Parquet(_) => "Parquet",
            Self::Mat(_) => "MATLAB or HDF5",
            #[cfg(feature = "mdf4")]
            Self::Mdf4(_) => "MDF 4",
        }
    }

    pub(crate) fn heads(&self) -> &[Head] {
        match self {
            Self::Parquet(parquet) => parquet.heads(),
            Self::Mat(mat) => mat.heads(),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.heads(),
        }
    }

    /// Columns that hold no numbers, such as texts, and are therefore no heads.
    pub(crate) fn unreadable(&self) -> &[String] {
        match self {
            Self::Parquet(parquet) => parquet.unreadable(),
            Self::Mat(mat) => mat.unreadable(),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.unreadable(),
        }
    }

    /// Gives blocks of at most [`BLOCK`] rows in their order, one vector for each of the `wanted` heads, all of equal length.
    /// Missing values are NaN. The wanted heads share a group.
    ///
    /// # Errors
    /// If the file is damaged, or the heads do not share a group, or `take` fails.
    pub(crate) fn read(&self, wanted: &[usize], take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        let heads = self.heads();
        let chosen: Option<Vec<&Head>> = wanted.iter().map(|&at| heads.get(at)).collect();
        let Some([first, rest @ ..]) = chosen.as_deref() else { return Ok(()) };
        if rest.iter().any(|head| head.group != first.group) {
            return Err(Problem::TwoGroups.into());
        }
        match self {
            Self::Parquet(parquet) => parquet.read(wanted, take),
            Self::Mat(mat) => mat.read(wanted, take),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.read(wanted, take),
        }
    }
}

/// `MDF     4.10    `: the version is text.
fn mdf(start: &[u8], file: Source) -> Result<Binary, FileError> {
    if start.get(8).is_some_and(|major| *major != b'4') {
        return Err(Problem::OldMdf.into());
    }
    #[cfg(feature = "mdf4")]
    return Ok(Binary::Mdf4(Box::new(mdf4::Mdf4::open(file)?)));
    #[cfg(not(feature = "mdf4"))]
    {
        drop(file);
        Err(Problem::NoMdf.into())
    }
}

/// Bytes, or rows, that a file of this length can hold at most. Deflate packs 1032 bytes into one at best, and what repeats one value
/// or none without end is no log; without this bound a small file could make a reader run for days.
fn most_held(length: u64) -> u64 {
    length.saturating_mul(1032).saturating_add(1 << 20)
}

/// The sentence for a container that is not what it should be.
fn damaged(format: &'static str, fault: impl ToString) -> FileError {
    Problem::Container { format, fault: format!("{}; export it again", fault.to_string().trim_end_matches(['.', ';', '\n'])) }.into()
}

/// The sentence for a container that cannot be read to its end.
fn unread(format: &'static str, error: &io::Error) -> FileError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged(format, "it ends too early"),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => damaged(format, "its compressed data are damaged"),
        _ => fluxfit_files::input::io_problem("reading", error).into(),
    }
}

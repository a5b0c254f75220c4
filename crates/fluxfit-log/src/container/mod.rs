//! Tables in formats other than text: Parquet, MATLAB's MAT, HDF5 and ASAM MDF 4.
//!
//! A container lists its columns and reads the wanted ones block by block. A damaged file gives an error. Every length that a file
//! states is checked against the size of the file before memory is allocated, so that a small file cannot claim much memory.

mod fault;
mod guard;
mod limits;
mod mat;
#[cfg(feature = "mdf4")]
mod mdf4;
mod number;
mod parquet;
mod random_access;
#[cfg(test)]
mod tests;

pub(crate) use random_access::RandomAccess;

use crate::{block::ColumnHead, problem::Problem};
use fluxfit_files::{FileError, input::io_problem};

/// Whether the start of a file has the signature of one of these formats. MAT 4 has no signature.
pub(crate) fn is_container(start: &[u8]) -> bool {
    const STARTS: [&[u8]; 6] = [b"PAR1", b"PARE", b"MDF     ", b"UnFinMF ", b"MATLAB ", b"\x89HDF\r\n\x1a\n"];
    STARTS.iter().any(|known| start.starts_with(known))
}

/// An open container.
pub(crate) enum Binary {
    Parquet(Box<parquet::Parquet>),
    Mat(Box<mat::Mat>),
    #[cfg(feature = "mdf4")]
    Mdf4(Box<mdf4::Mdf4>),
}

impl Binary {
    /// Opens a container; none if the start of the file does not belong to one of these formats.
    ///
    /// # Errors
    /// If the file is damaged or not supported, or has no column of numbers.
    pub(crate) fn open(file: RandomAccess) -> Result<Option<Self>, FileError> {
        let mut start = [0; 1024];
        let count = file.read_at(0, &mut start).map_err(|error| FileError::from(io_problem("reading", &error)))?;
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

    /// The name of the format.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Parquet(_) => "Parquet",
            Self::Mat(_) => "MATLAB or HDF5",
            #[cfg(feature = "mdf4")]
            Self::Mdf4(_) => "MDF 4",
        }
    }

    /// The columns of numbers.
    pub(crate) fn heads(&self) -> &[ColumnHead] {
        match self {
            Self::Parquet(parquet) => parquet.heads(),
            Self::Mat(mat) => mat.heads(),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.heads(),
        }
    }

    /// Names of columns that hold no numbers, such as texts.
    pub(crate) fn unreadable(&self) -> &[String] {
        match self {
            Self::Parquet(parquet) => parquet.unreadable(),
            Self::Mat(mat) => mat.unreadable(),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.unreadable(),
        }
    }

    /// Passes blocks of at most [`BLOCK`](limits::BLOCK) rows to `take`, in order: one vector for each wanted column, of equal lengths.
    /// Missing values are NaN. The wanted columns must be of one group.
    ///
    /// # Errors
    /// If the file is damaged, the columns are not of one group, or `take` fails.
    pub(crate) fn read(&self, wanted: &[usize], take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        let heads = self.heads();
        let chosen: Option<Vec<&ColumnHead>> = wanted.iter().map(|&at| heads.get(at)).collect();
        let Some([first, rest @ ..]) = chosen.as_deref() else { return Ok(()) };
        if rest.iter().any(|head| head.group != first.group) {
            return Err(Problem::SeveralGroups.into());
        }
        match self {
            Self::Parquet(parquet) => parquet.read(wanted, take),
            Self::Mat(mat) => mat.read(wanted, take),
            #[cfg(feature = "mdf4")]
            Self::Mdf4(mdf4) => mdf4.read(wanted, take),
        }
    }
}

/// Opens an MDF file. Its start is `MDF     4.10    `, with the version as text.
fn mdf(start: &[u8], file: RandomAccess) -> Result<Binary, FileError> {
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

//! Tables in formats other than text: Parquet, MATLAB's MAT, HDF5 and ASAM MDF 4.
//!
//! [`CONTAINERS`] lists the formats. A container lists its columns and reads the wanted ones block by block. A damaged file gives an error.
//! Every length that a file states is checked against the size of the file before memory is allocated, so that a small file cannot claim
//! much memory.

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

pub use guard::guarded;
pub(crate) use limits::MOST_COLUMNS;
pub(crate) use random_access::RandomAccess;

use crate::{block::ColumnHead, problem::Problem};
use fluxfit_files::{FileError, input::io_problem};
use std::ops::Range;

/// A container format.
#[derive(Debug)]
pub struct Container {
    /// Its name, and those of formats that are read as the same.
    pub names: &'static [&'static str],
    /// Whether this build reads it.
    pub is_built: bool,
    /// What its files begin with.
    signatures: &'static [&'static [u8]],
    open: fn(&[u8], RandomAccess) -> Result<Option<Binary>, FileError>,
}

/// The formats that are read. A file without any of their signatures is given to the last one, because MAT 4 has none.
pub const CONTAINERS: &[Container] = &[
    Container { names: &["Parquet"], is_built: true, signatures: &[b"PAR1", ENCRYPTED_PARQUET], open: open_parquet },
    Container { names: &["MDF 4"], is_built: cfg!(feature = "mdf4"), signatures: &[b"MDF     ", b"UnFinMF "], open: open_mdf },
    MAT,
];

const MAT: Container =
    Container { names: &["MATLAB", "HDF5"], is_built: true, signatures: &[b"MATLAB ", b"\x89HDF\r\n\x1a\n"], open: open_mat };

const ENCRYPTED_PARQUET: &[u8] = b"PARE";

impl Container {
    fn has_signature(&self, start: &[u8]) -> bool {
        self.signatures.iter().any(|signature| start.starts_with(signature))
    }
}

/// Whether the start of a file has the signature of one of these formats. MAT 4 has no signature.
pub(crate) fn is_container(start: &[u8]) -> bool {
    CONTAINERS.iter().any(|container| container.has_signature(start))
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
        let container = CONTAINERS.iter().find(|container| container.has_signature(start)).unwrap_or(&MAT);
        (container.open)(start, file)
    }

    /// Some rows of a Parquet file, without one of its columns.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub(crate) fn part_of_parquet(file: RandomAccess, rows: Range<u64>, without: &str) -> Result<Self, FileError> {
        Ok(Self::Parquet(Box::new(parquet::Parquet::open(file)?.part(rows, without))))
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

    /// Why the log itself cannot be read, if it seems to be in a part of the file that cannot.
    pub(crate) fn lists(&self) -> &[String] {
        match self {
            Self::Parquet(parquet) => parquet.lists(),
            _ => &[],
        }
    }

    pub(crate) fn passed_over(&self) -> Option<&Problem> {
        match self {
            Self::Mat(mat) => mat.passed_over(),
            _ => None,
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

fn open_parquet(start: &[u8], file: RandomAccess) -> Result<Option<Binary>, FileError> {
    if start.starts_with(ENCRYPTED_PARQUET) {
        return Err(Problem::Container { format: "Parquet", fault: "it is encrypted; export it without encryption".to_owned() }.into());
    }
    Ok(Some(Binary::Parquet(Box::new(parquet::Parquet::open(file)?))))
}

fn open_mat(start: &[u8], file: RandomAccess) -> Result<Option<Binary>, FileError> {
    Ok(mat::Mat::open(start, file)?.map(|mat| Binary::Mat(Box::new(mat))))
}

/// Opens an MDF file. Its start is `MDF     4.10    `, with the version as text.
fn open_mdf(start: &[u8], file: RandomAccess) -> Result<Option<Binary>, FileError> {
    if start.get(8).is_some_and(|major| *major != b'4') {
        return Err(Problem::OldMdf.into());
    }
    #[cfg(feature = "mdf4")]
    return Ok(Some(Binary::Mdf4(Box::new(mdf4::Mdf4::open(file)?))));
    #[cfg(not(feature = "mdf4"))]
    {
        drop(file);
        Err(Problem::NoMdf.into())
    }
}

//! Some consecutive rows of a table in a file: they are read from there, block by block, and take no memory before.

use crate::container::RandomAccess;
use std::{fmt, ops::Range};

/// Some consecutive rows of a table of text or Parquet, which stays open.
pub struct FilePart {
    pub(crate) file: RandomAccess,
    pub(crate) rows: PartRows,
}

/// Where they are.
pub(crate) enum PartRows {
    /// Lines of a text, as bytes of the file, and the line of the names, which stands above them.
    Text { header: Vec<u8>, bytes: Range<u64> },
    /// Rows of a Parquet file, without one of its columns.
    Parquet { rows: Range<u64>, without: String },
}

impl fmt::Debug for FilePart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.rows {
            PartRows::Text { bytes, .. } => f.debug_tuple("FilePart").field(bytes).finish(),
            PartRows::Parquet { rows, .. } => f.debug_tuple("FilePart").field(rows).finish(),
        }
    }
}

//! The page: text written by people, with tables written by this program between marks.
//!
//! ```text
//! <!-- table: ranking -->
//! ...
//! <!-- end -->
//! ```

use fluxfit_files::write_atomically;
use std::{
    error::Error,
    fs,
    path::{Path, PathBuf},
};

/// A page under way.
pub(crate) struct Page {
    path: PathBuf,
    text: String,
    /// Only compare, write nothing.
    check: bool,
}

impl Page {
    pub(crate) fn read(path: &Path, check: bool) -> Result<Self, Box<dyn Error>> {
        Ok(Self { path: path.to_owned(), text: fs::read_to_string(path)?, check })
    }

    /// Puts a table between its marks.
    pub(crate) fn put(&mut self, name: &str, table: &str) -> Result<(), Box<dyn Error>> {
        let missing = || format!("{} has no mark <!-- table: {name} --> with its end", self.path.display());
        let mark = format!("<!-- table: {name} -->\n");
        let start = self.text.find(&mark).ok_or_else(missing)? + mark.len();
        let end = start + self.text[start..].find("<!-- end -->").ok_or_else(missing)?;
        let table = format!("\n{table}\n");
        if self.check && self.text[start..end] != table {
            return Err(format!("{}: table {name} is not what comes out now; run the command without --check", self.path.display()).into());
        }
        self.text.replace_range(start..end, &table);
        Ok(())
    }

    pub(crate) fn finish(self) -> Result<(), Box<dyn Error>> {
        if !self.check {
            write_atomically(&self.path, self.text.as_bytes())?;
        }
        Ok(())
    }
}

/// Writes a figure, or compares it.
pub(crate) fn figure(path: &Path, svg: &str, check: bool) -> Result<(), Box<dyn Error>> {
    if !check {
        return Ok(write_atomically(path, svg.as_bytes())?);
    }
    if fs::read_to_string(path)? == svg { Ok(()) } else { Err(format!("{} is not what comes out now", path.display()).into()) }
}

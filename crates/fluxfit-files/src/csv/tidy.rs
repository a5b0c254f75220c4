//! Rows that are written in another way than records: with a mark at the end of each, or aligned with spaces. They are changed into
//! records while they are read, so that the reader of records stays as fast as it is.

use std::{
    borrow::Cow,
    io::{self, Read},
};

/// How the rows of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowStyle {
    /// As records.
    Plain,
    /// As records that end with a semicolon, which separates nothing.
    Terminated,
    /// With spaces between the cells, as many as align them. Tidied, there is one tab.
    Aligned,
}

impl RowStyle {
    /// The text with the rows after `body` as records; lines stay lines.
    pub fn tidied(self, text: &str, body: usize) -> Cow<'_, str> {
        if self == Self::Plain {
            return Cow::Borrowed(text);
        }
        let (above, rows) = text.split_at(body.min(text.len()));
        let mut tidied = above.as_bytes().to_vec();
        Tidied::new(rows.as_bytes(), self).take_all(&mut tidied);
        Cow::Owned(String::from_utf8_lossy(&tidied).into_owned())
    }
}

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Rows as records.
pub struct Tidied<R> {
    rows: R,
    style: RowStyle,
    piece: Vec<u8>,
    tidy: Vec<u8>,
    /// Bytes of `tidy` that were passed on.
    passed: usize,
    /// Semicolons or spaces whose meaning depends on the byte after them.
    is_open: bool,
    /// Nothing of the line was passed on.
    is_start: bool,
}

impl<R: Read> Tidied<R> {
    /// The rows of a table, from the beginning of a line on.
    pub fn new(rows: R, style: RowStyle) -> Self {
        Self { rows, style, piece: vec![0; PIECE], tidy: Vec::new(), passed: 0, is_open: false, is_start: true }
    }

    fn take_all(&mut self, into: &mut Vec<u8>) {
        // Bytes in memory can be read.
        let _ = self.read_to_end(into);
    }

    /// Tidies bytes in `piece`.
    fn tidy(&mut self, count: usize) {
        for byte in &self.piece[..count] {
            let is_end = matches!(byte, b'\r' | b'\n');
            let is_mark = match self.style {
                RowStyle::Plain => false,
                RowStyle::Terminated => *byte == b';',
                RowStyle::Aligned => matches!(byte, b' ' | b'\t'),
            };
            if is_mark && self.style == RowStyle::Aligned {
                self.is_open = !self.is_start;
                continue;
            }
            if self.is_open && !is_end {
                self.tidy.push(if self.style == RowStyle::Aligned { b'\t' } else { b';' });
            }
            self.is_open = is_mark;
            self.is_start = is_end;
            if !is_mark {
                self.tidy.push(*byte);
            }
        }
    }
}

impl<R: Read> Read for Tidied<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.passed == self.tidy.len() {
            self.tidy.clear();
            self.passed = 0;
            let count = self.rows.read(&mut self.piece)?;
            if count == 0 {
                return Ok(0);
            }
            self.tidy(count);
        }
        let count = buffer.len().min(self.tidy.len() - self.passed);
        buffer[..count].copy_from_slice(&self.tidy[self.passed..self.passed + count]);
        self.passed += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One byte at a time.
    struct Slowly<'a>(&'a [u8]);

    impl Read for Slowly<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = self.0.len().min(buffer.len()).min(1);
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn rows_become_records() {
        let cases = [
            (RowStyle::Terminated, "1,2;\r\n3,4;\n5;6,7;", "1,2\r\n3,4\n5;6,7"),
            (RowStyle::Aligned, "  1   2.5\n\n3 \t-4  \r\n 5", "1\t2.5\n\n3\t-4\r\n5"),
            (RowStyle::Plain, " 1;\n", " 1;\n"),
        ];
        for (style, rows, expected) in cases {
            assert_eq!(style.tidied(rows, 0), expected);
            let mut slow = String::new();
            Tidied::new(Slowly(rows.as_bytes()), style).read_to_string(&mut slow).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(slow, expected);
        }
        assert_eq!(RowStyle::Aligned.tidied("a  b\n1  2", 5), "a  b\n1\t2");
    }
}

//! Numbers of the arrays in MAT files of versions 4 to 7.

use super::array::Line;
use crate::container::{
    fault::unread,
    number::Number,
    random_access::{RandomAccess, Range},
};
use flate2::read::ZlibDecoder;
use fluxfit_files::FileError;
use std::io::{self, BufRead, BufReader, Read};

/// Name of the format in messages.
const FORMAT: &str = "MAT";

/// Bytes that are decoded at once.
const PIECE: usize = 1 << 16;

/// Where the numbers of an array are, column by column.
pub(crate) struct Place {
    /// Start and end of the top-level element that holds them.
    pub(super) element: (u64, u64),
    pub(super) compressed: bool,
    /// Offset of the first number in the decompressed element.
    pub(super) offset: u64,
    pub(super) number: Number,
    pub(super) rows: u64,
}

impl Place {
    /// Uncompressed numbers between two offsets of the file.
    pub(super) fn plain(from: u64, to: u64, number: Number, rows: u64) -> Self {
        Self { element: (from, to), compressed: false, offset: 0, number, rows }
    }
}

/// The arrays of a file, to be read.
pub(crate) struct File {
    source: RandomAccess,
    places: Vec<Place>,
}

impl File {
    /// A file with arrays at these places.
    pub(super) fn new(source: RandomAccess, places: Vec<Place>) -> Self {
        Self { source, places }
    }

    /// The elements of a line of an array.
    pub(super) fn line(&self, array: usize, line: Line) -> Result<Values, FileError> {
        let place = &self.places[array];
        let width = place.number.width() as u64;
        // None of these products overflow: the array was checked to fit into its element.
        let (first, stride) = match line {
            Line::Column(k) => (k * place.rows, 1),
            Line::Row(k) => (k, place.rows),
        };
        let mut stream = Stream::new(&self.source, place.element, place.compressed);
        stream.skip(place.offset + first * width).map_err(|error| unread(FORMAT, &error))?;
        let between = (stride - 1) * width;
        Ok(Values { stream, number: place.number, between, started: false })
    }
}

/// The elements of one line, in order.
pub(crate) struct Values {
    stream: Stream,
    number: Number,
    /// Bytes between an element and the next one.
    between: u64,
    started: bool,
}

impl Values {
    /// The next `count` elements, fewer at the end.
    pub(super) fn next(&mut self, count: usize) -> Result<Vec<f64>, FileError> {
        let mut values = Vec::with_capacity(count);
        self.fill(&mut values, count).map_err(|error| unread(FORMAT, &error))?;
        Ok(values)
    }

    fn fill(&mut self, values: &mut Vec<f64>, count: usize) -> io::Result<()> {
        let width = self.number.width();
        if self.between == 0 {
            let mut bytes = vec![0; PIECE.min(count * width)];
            let mut left = count * width;
            while left > 0 {
                let piece = left.min(PIECE);
                self.stream.read_exact(&mut bytes[..piece])?;
                self.number.decode(&bytes[..piece], values);
                left -= piece;
            }
            return Ok(());
        }
        let mut bytes = [0; 8];
        for _ in 0..count {
            if std::mem::replace(&mut self.started, true) {
                self.stream.skip(self.between)?;
            }
            self.stream.read_exact(&mut bytes[..width])?;
            self.number.decode(&bytes[..width], values);
        }
        Ok(())
    }
}

/// A top-level element, decompressed.
pub(super) struct Stream {
    bytes: Bytes,
    /// Bytes that were read or skipped.
    pub(super) at: u64,
}

enum Bytes {
    Plain(BufReader<Range>),
    Compressed(Box<ZlibDecoder<BufReader<Range>>>),
}

impl Stream {
    /// The element between two offsets of the file.
    pub(super) fn new(source: &RandomAccess, (from, to): (u64, u64), compressed: bool) -> Self {
        let range = BufReader::new(source.range(from, to));
        let bytes = if compressed { Bytes::Compressed(Box::new(ZlibDecoder::new(range))) } else { Bytes::Plain(range) };
        Self { bytes, at: 0 }
    }

    /// Fills the buffer.
    ///
    /// # Errors
    /// If there are fewer bytes.
    pub(super) fn read_exact(&mut self, buffer: &mut [u8]) -> io::Result<()> {
        match &mut self.bytes {
            Bytes::Plain(bytes) => bytes.read_exact(buffer)?,
            Bytes::Compressed(bytes) => bytes.read_exact(buffer)?,
        }
        self.at += buffer.len() as u64;
        Ok(())
    }

    /// Skips bytes.
    ///
    /// # Errors
    /// If there are fewer bytes.
    pub(super) fn skip(&mut self, count: u64) -> io::Result<()> {
        let skipped = match &mut self.bytes {
            Bytes::Plain(bytes) => {
                let buffered = count.min(bytes.buffer().len() as u64);
                bytes.consume(buffered as usize);
                let rest = count - buffered;
                let there = rest.min(bytes.get_ref().left());
                if rest > 0 {
                    bytes.get_mut().skip(there);
                }
                buffered + there
            }
            Bytes::Compressed(bytes) => io::copy(&mut bytes.by_ref().take(count), &mut io::sink())?,
        };
        self.at = self.at.saturating_add(skipped);
        if skipped == count { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }
}

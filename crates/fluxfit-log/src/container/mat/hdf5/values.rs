//! The numbers of an array: contiguous, or in chunks that may be compressed.

use super::{
    filters::{Filter, Stored, decode, in_message},
    object::{Object, message},
    reader::{Cursor, NOWHERE, Reader},
};
use crate::{
    container::{fault::unread, limits::most_held, mat::array::Line, number::Number, random_access::RandomAccess},
    problem::Problem,
};
use fluxfit_files::FileError;
use std::collections::HashMap;

/// Maximum size of a decompressed chunk, bytes. Writers aim at 16 KiB to 1 MiB.
const LARGEST_CHUNK: u64 = 32 << 20;

/// Bytes of a contiguous array that are read at once.
const PIECE: u64 = 1 << 18;

/// Where the numbers of an array are. A one-dimensional array has a second dimension of 1.
pub(crate) struct Place {
    number: Number,
    dimensions: [u64; 2],
    /// The dimensions in the file are columns and rows, as MATLAB writes them, instead of rows and columns.
    reversed: bool,
    layout: Layout,
}

enum Layout {
    Here(RandomAccess),
    /// Contiguous from this address; none if nothing was written.
    Piece(Option<u64>, f64),
    Chunks(Chunks),
}

struct Chunks {
    /// The root of the B-tree of chunks; none if nothing was written.
    tree: Option<u64>,
    dimensions: [u64; 2],
    /// Dimensions of the array: one or two.
    rank: usize,
    filters: Vec<Filter>,
    fill: f64,
}

impl Place {
    pub(super) fn new(reader: &Reader, object: &Object, number: Number, dimensions: [u64; 2], reversed: bool) -> Result<Self, FileError> {
        let wrong = || reader.damaged("an array in it has no place");
        let width = number.width() as u64;
        let length = dimensions[0].checked_mul(dimensions[1]).and_then(|count| count.checked_mul(width)).ok_or_else(wrong)?;
        if length > most_held(reader.source.length()) {
            return Err(reader.damaged("an array in it is larger than the file allows"));
        }
        if object.message(message::EXTERNAL).is_some() {
            return Err(Problem::ExternalHdf5.into());
        }
        let fill = object.message(message::FILL_VALUE).and_then(|bytes| fill_value(bytes, number)).unwrap_or(0.0);
        let mut cursor = Cursor(object.message(message::LAYOUT).ok_or_else(wrong)?);
        let (version, class) = cursor.u8().zip(cursor.u8()).ok_or_else(wrong)?;
        let layout = match (version, class) {
            (3 | 4, 0) => {
                let stored = cursor.u16().ok_or_else(wrong)?;
                let bytes = cursor.take(stored.into()).filter(|bytes| bytes.len() as u64 >= length).ok_or_else(wrong)?;
                Layout::Here(RandomAccess::memory(bytes.to_vec()))
            }
            (3 | 4, 1) => {
                let (address, stored) = cursor.u64().zip(cursor.u64()).ok_or_else(wrong)?;
                if stored < length {
                    return Err(wrong());
                }
                Layout::Piece((address != NOWHERE).then_some(address), fill)
            }
            (3, 2) => Layout::Chunks(Chunks::parse(reader, object, cursor, number, fill)?),
            (4, 2) => return Err(reader.newer("an index of chunks")),
            _ => return Err(reader.newer("this layout of an array")),
        };
        Ok(Self { number, dimensions, reversed, layout })
    }
}

impl Chunks {
    fn parse(reader: &Reader, object: &Object, mut cursor: Cursor<'_>, number: Number, fill: f64) -> Result<Self, FileError> {
        let wrong = || reader.damaged("the chunks of an array are impossible");
        // The last dimension is the size of an element.
        let rank = usize::from(cursor.u8().ok_or_else(wrong)?).checked_sub(1).filter(|rank| (1..=2).contains(rank)).ok_or_else(wrong)?;
        let tree = cursor.u64().ok_or_else(wrong)?;
        let mut dimensions = [1; 2];
        for dimension in &mut dimensions[..rank] {
            *dimension = cursor.u32().map(u64::from).filter(|dimension| *dimension > 0).ok_or_else(wrong)?;
        }
        let width = number.width() as u64;
        if cursor.u32().map(u64::from) != Some(width) {
            return Err(wrong());
        }
        // The product of two numbers below 2^32 and a small one may overflow.
        if dimensions[0].saturating_mul(dimensions[1]).saturating_mul(width) > LARGEST_CHUNK {
            return Err(Problem::LargeChunks { most: LARGEST_CHUNK >> 20 }.into());
        }
        let filters = object.message(message::FILTERS).map_or(Ok(Vec::new()), |bytes| in_message(reader, bytes))?;
        Ok(Self { tree: (tree != NOWHERE).then_some(tree), dimensions, rank, filters, fill })
    }
}

/// The value in a fill value message, if it has one.
fn fill_value(bytes: &[u8], number: Number) -> Option<f64> {
    let mut cursor = Cursor(bytes);
    match cursor.u8()? {
        1 => drop(cursor.take(3)?),
        2 => {
            cursor.take(2)?;
            (cursor.u8()? == 1).then_some(())?;
        }
        _ => (cursor.u8()? & 0x20 != 0).then_some(())?,
    }
    let length = cursor.u32()? as usize;
    let mut values = Vec::new();
    number.decode(cursor.take(length).filter(|bytes| bytes.len() == number.width())?, &mut values);
    values.first().copied()
}

/// The elements of one line, in order.
pub(crate) struct Values {
    number: Number,
    format: &'static str,
    from: From,
    /// The index of the next element, and the number of elements.
    at: u64,
    end: u64,
}

enum From {
    Piece {
        source: RandomAccess,
        /// Bytes.
        first: u64,
        /// Elements.
        stride: u64,
    },
    Nothing(f64),
    Chunks {
        source: RandomAccess,
        /// Chunks by their position along the line.
        stored: HashMap<u64, Stored>,
        /// Elements of a chunk along the line.
        along: u64,
        /// Elements in a chunk before the line, and from an element of the line to the next.
        first: u64,
        stride: u64,
        /// Size of a decompressed chunk, bytes.
        length: u64,
        filters: Vec<Filter>,
        fill: f64,
        /// The decompressed chunk of the element before.
        current: Option<(u64, Vec<u8>)>,
    },
}

impl Values {
    pub(super) fn open(reader: &Reader, place: &Place, line: Line) -> Result<Self, FileError> {
        let (axis, fixed) = match (line, place.reversed) {
            (Line::Column(k), true) | (Line::Row(k), false) => (1, k),
            (Line::Column(k), false) | (Line::Row(k), true) => (0, k),
        };
        let width = place.number.width() as u64;
        let line_of = |dimensions: [u64; 2], fixed: u64| if axis == 1 { (fixed * dimensions[1], 1) } else { (fixed, dimensions[1]) };
        let from = match &place.layout {
            // The products do not overflow: they are within an array whose size in bytes was checked.
            Layout::Here(source) => {
                let (first, stride) = line_of(place.dimensions, fixed);
                From::Piece { source: source.clone(), first: first * width, stride }
            }
            Layout::Piece(Some(address), _) => {
                let (first, stride) = line_of(place.dimensions, fixed);
                let first = reader.base.checked_add(*address).and_then(|begin| begin.checked_add(first * width));
                let first = first.ok_or_else(|| reader.damaged("an array in it has no place"))?;
                From::Piece { source: reader.source.clone(), first, stride }
            }
            Layout::Piece(None, fill) => From::Nothing(*fill),
            Layout::Chunks(chunks) => {
                let across = chunks.dimensions[1 - axis];
                let (first, stride) = line_of(chunks.dimensions, fixed % across);
                let mut stored = HashMap::new();
                if let Some(tree) = chunks.tree {
                    let mut wanted = Wanted { reader, chunks, axis, across: fixed - fixed % across, stored: &mut stored };
                    wanted.node(tree, None)?;
                }
                From::Chunks {
                    source: reader.source.clone(),
                    stored,
                    along: chunks.dimensions[axis],
                    first,
                    stride,
                    length: chunks.dimensions[0] * chunks.dimensions[1] * width,
                    filters: chunks.filters.clone(),
                    fill: chunks.fill,
                    current: None,
                }
            }
        };
        Ok(Self { number: place.number, format: reader.format, from, at: 0, end: place.dimensions[axis] })
    }

    /// The next `count` elements, fewer at the end.
    pub(crate) fn next(&mut self, count: usize) -> Result<Vec<f64>, FileError> {
        let end = self.end.min(self.at + count as u64);
        let mut values = Vec::with_capacity((end - self.at) as usize);
        let width = self.number.width() as u64;
        while self.at < end {
            let left = end - self.at;
            let taken = match &mut self.from {
                From::Nothing(fill) => {
                    values.extend(std::iter::repeat_n(*fill, left as usize));
                    left
                }
                From::Piece { source, first, stride } => {
                    let taken = left.min((PIECE / (*stride * width)).max(1));
                    let at = *first + self.at * *stride * width;
                    let bytes = source.bytes_at(at, ((taken - 1) * *stride + 1) * width).map_err(|error| unread(self.format, &error))?;
                    strided(self.number, &bytes, *stride, taken, &mut values);
                    taken
                }
                From::Chunks { source, stored, along, first, stride, length, filters, fill, current } => {
                    let (chunk, within) = (self.at / *along, self.at % *along);
                    let taken = left.min(*along - within);
                    match stored.get(&chunk) {
                        None => values.extend(std::iter::repeat_n(*fill, taken as usize)),
                        Some(place) => {
                            if current.as_ref().is_none_or(|(loaded, _)| *loaded != chunk) {
                                // The old chunk is freed before the new one is allocated.
                                *current = None;
                                *current = Some((chunk, decode(source, place, filters, *length, width as usize, self.format)?));
                            }
                            let bytes = current.as_ref().map_or(&[][..], |(_, bytes)| bytes);
                            let begin = (*first + within * *stride) * width;
                            strided(self.number, bytes.get(begin as usize..).unwrap_or_default(), *stride, taken, &mut values);
                        }
                    }
                    taken
                }
            };
            self.at += taken;
        }
        Ok(values)
    }
}

/// Appends every `stride`th number, beginning with the first.
fn strided(number: Number, bytes: &[u8], stride: u64, count: u64, into: &mut Vec<f64>) {
    let width = number.width();
    if stride == 1 {
        let length = bytes.len().min(count as usize * width);
        return number.decode(&bytes[..length], into);
    }
    for piece in bytes.chunks(stride as usize * width).take(count as usize) {
        number.decode(piece.get(..width).unwrap_or_default(), into);
    }
}

/// Finds the chunks that a line crosses.
struct Wanted<'a> {
    reader: &'a Reader,
    chunks: &'a Chunks,
    axis: usize,
    /// Their position across the line.
    across: u64,
    stored: &'a mut HashMap<u64, Stored>,
}

impl Wanted<'_> {
    fn node(&mut self, address: u64, level: Option<u8>) -> Result<(), FileError> {
        let reader = self.reader;
        let wrong = || reader.damaged("the chunks of an array are damaged");
        let bytes = reader.bytes(address, 24)?;
        let mut cursor = Cursor(&bytes);
        let mut head = || {
            (cursor.take(4)? == b"TREE" && cursor.u8()? == 1).then_some(())?;
            Some((cursor.u8()?, cursor.u16()?))
        };
        let (found, entries) = head().ok_or_else(wrong)?;
        // Levels decrease to 0, so no node is its own descendant.
        if level.is_some_and(|level| level != found) {
            return Err(wrong());
        }
        // A key: length, mask, a position for each dimension and one more. Then the address of the child to its right.
        let entry = 8 + 8 * (self.chunks.rank as u64 + 1) + 8;
        let bytes = reader.bytes(address.saturating_add(24), u64::from(entries) * entry)?;
        for entry in bytes.chunks_exact(entry as usize) {
            let mut cursor = Cursor(entry);
            let mut parse = || {
                let (length, unfiltered) = (cursor.u32()?, cursor.u32()?);
                let mut place = [0; 2];
                for at in &mut place[..self.chunks.rank] {
                    *at = cursor.u64()?;
                }
                cursor.u64()?;
                Some((u64::from(length), unfiltered, place, cursor.u64()?))
            };
            let (length, unfiltered, place, child) = parse().ok_or_else(wrong)?;
            match found.checked_sub(1) {
                Some(below) => self.node(child, Some(below))?,
                None if place[1 - self.axis] == self.across => {
                    let at = reader.base.checked_add(child).ok_or_else(wrong)?;
                    self.stored.insert(place[self.axis] / self.chunks.dimensions[self.axis], Stored { at, length, unfiltered });
                }
                None => {}
            }
        }
        Ok(())
    }
}

//! MAT files of versions 5 to 7: elements with a tag; those at the top level may be compressed by deflate.
//!
//! A compressed array is decompressed while it is read, from its start, and never stored. The format: MathWorks, MAT-File Format,
//! chapter 1.

use super::{
    array::{Array, Contents, Object, is_column, is_label, join},
    numbers::{Place, Stream},
};
use crate::{
    container::{
        fault::{damaged, unread},
        limits::MOST_COLUMNS,
        number::{Kind, Number},
        random_access::RandomAccess,
    },
    problem::Problem,
};
use fluxfit_files::FileError;
use std::io;

const FORMAT: &str = "MAT";
const HEADER: u64 = 128;

/// Maximum nesting of structures.
const DEEPEST: usize = 16;

/// Dimensions that are looked at; arrays of more than three are no columns.
const MOST_DIMENSIONS: u64 = 4;

/// Maximum length of a name, label or class, bytes; longer ones are cut.
const LONGEST_TEXT: u64 = 256;

/// Whether the integers are big-endian, if this is a file of these versions.
pub(super) fn signature(start: &[u8]) -> Option<bool> {
    match start.get(124..128)? {
        [0, 1, b'I', b'M'] => Some(false),
        [1, 0, b'M', b'I'] => Some(true),
        _ => None,
    }
}

pub(super) fn open(source: &RandomAccess, big_endian: bool) -> Result<Contents<Place>, FileError> {
    let mut contents = Contents::default();
    let mut at = HEADER;
    while at < source.length() {
        let mut stream = Stream::new(source, (at, at.saturating_add(8)), false);
        let element = Element::read(&mut stream, big_endian).map_err(|error| unread(FORMAT, &error))?;
        let data = at + 8;
        let end = data.checked_add(element.length).filter(|end| *end <= source.length());
        let end = end.ok_or_else(|| damaged(FORMAT, "it ends too early"))?;
        let compressed = element.kind == kind::COMPRESSED;
        if compressed || element.kind == kind::MATRIX {
            let place = if compressed { (data, end) } else { (at, end) };
            let stream = Stream::new(source, place, compressed);
            Walk { stream, big_endian, element: place, compressed, contents: &mut contents }.matrix("", DEEPEST)?;
        }
        at = end;
    }
    Ok(contents)
}

/// Types of elements.
mod kind {
    pub(super) const MATRIX: u32 = 14;
    pub(super) const COMPRESSED: u32 = 15;
}

/// Classes of arrays.
mod class {
    pub(super) const STRUCT: u32 = 2;
    pub(super) const TEXT: u32 = 4;
    pub(super) const DOUBLE: u32 = 6;
    pub(super) const UINT64: u32 = 15;
    pub(super) const OPAQUE: u32 = 17;
}

/// The tag of an element.
struct Element {
    kind: u32,
    length: u64,
    /// The data are inside the tag.
    small: Option<[u8; 4]>,
}

impl Element {
    fn read(stream: &mut Stream, big_endian: bool) -> io::Result<Self> {
        let (first, data) = (word(stream, big_endian)?, four(stream)?);
        if first >> 16 != 0 {
            return Ok(Self { kind: first & 0xffff, length: u64::from(first >> 16).min(4), small: Some(data) });
        }
        Ok(Self { kind: first, length: integer(data, big_endian).into(), small: None })
    }

    /// Bytes from the end of the tag to the next element, except at the top level.
    fn padded(&self) -> u64 {
        if self.small.is_some() { 0 } else { self.length.next_multiple_of(8) }
    }

    fn number(&self, big_endian: bool) -> Option<Number> {
        let kind = match self.kind {
            1 => Kind::I8,
            2 => Kind::U8,
            3 => Kind::I16,
            4 => Kind::U16,
            5 => Kind::I32,
            6 => Kind::U32,
            7 => Kind::F32,
            9 => Kind::F64,
            12 => Kind::I64,
            13 => Kind::U64,
            _ => return None,
        };
        Some(Number { kind, big_endian })
    }
}

fn four(stream: &mut Stream) -> io::Result<[u8; 4]> {
    let mut bytes = [0; 4];
    stream.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn integer(bytes: [u8; 4], big_endian: bool) -> u32 {
    if big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
}

fn word(stream: &mut Stream, big_endian: bool) -> io::Result<u32> {
    four(stream).map(|bytes| integer(bytes, big_endian))
}

/// Reads one variable from its beginning to its end.
struct Walk<'a> {
    stream: Stream,
    big_endian: bool,
    element: (u64, u64),
    compressed: bool,
    contents: &'a mut Contents<Place>,
}

impl Walk<'_> {
    /// Reads an array from its tag. `path` is used as its name if it has none; at the top level it has one.
    fn matrix(&mut self, path: &str, depth: usize) -> Result<(), FileError> {
        let element = self.tag()?;
        if element.kind != kind::MATRIX || element.small.is_some() {
            return Err(damaged(FORMAT, "an array is missing"));
        }
        if element.length == 0 {
            return Ok(());
        }
        let end = self.stream.at.saturating_add(element.length);
        let Some(depth) = depth.checked_sub(1) else { return self.skip_to(end) };
        let flags = self.bytes(8)?;
        let flags = flags.first_chunk().map_or(0, |bytes| integer(*bytes, self.big_endian));
        let (class, complex, logical) = (flags & 0xff, flags & 0x800 != 0, flags & 0x200 != 0);
        if class == class::OPAQUE {
            self.opaque(end)?;
            return self.skip_to(end);
        }
        let dimensions = self.bytes(MOST_DIMENSIONS * 4)?;
        let dimensions: Vec<u64> = dimensions.as_chunks().0.iter().map(|bytes| integer(*bytes, self.big_endian).into()).collect();
        let (rows, columns, flat) = match dimensions[..] {
            [rows, columns] => (rows, columns, true),
            // `1 x 1 x N`, as Simulink stores the samples of a matrix of one element.
            [1, 1, samples] => (samples, 1, true),
            _ => (0, 0, false),
        };
        let name = self.bytes(LONGEST_TEXT)?;
        let name = String::from_utf8_lossy(&name).into_owned();
        let at_top = path.is_empty();
        let path = if at_top { name.as_str() } else { path };
        // A top-level variable without a name is internal data of MATLAB objects.
        if path.is_empty() {
            return Ok(());
        }
        match class {
            class::STRUCT if flat => self.structure(path, rows, columns, depth)?,
            class::TEXT if is_label(path) => self.label(path)?,
            class::DOUBLE..=class::UINT64 if flat && !complex && !logical => self.numbers(path, rows, columns)?,
            _ => self.contents.unreadable.extend(at_top.then(|| path.to_owned())),
        }
        self.count()?;
        // At the top level nothing follows, so the numbers need not be decompressed now.
        if at_top { Ok(()) } else { self.skip_to(end) }
    }

    fn numbers(&mut self, path: &str, rows: u64, columns: u64) -> Result<(), FileError> {
        let element = self.tag()?;
        let number = element.number(self.big_endian).ok_or_else(|| damaged(FORMAT, "an array has no type").in_column(path))?;
        if !is_column(rows, columns) {
            return Ok(());
        }
        let length = rows.checked_mul(columns).and_then(|count| count.checked_mul(number.width() as u64));
        if length != Some(element.length) {
            return Err(damaged(FORMAT, "an array has another length than it states").in_column(path));
        }
        let offset = if element.small.is_some() { self.stream.at - 4 } else { self.stream.at };
        let place = Place { element: self.element, compressed: self.compressed, offset, number, rows };
        self.contents.arrays.push(Array { path: path.to_owned(), unit: None, rows, columns, place });
        Ok(())
    }

    fn structure(&mut self, path: &str, rows: u64, columns: u64, depth: usize) -> Result<(), FileError> {
        let length = self.bytes(4)?;
        let length = length.first_chunk().map_or(0, |bytes| u64::from(integer(*bytes, self.big_endian)));
        let element = self.tag()?;
        if length == 0 || element.length % length != 0 || element.length / length > MOST_COLUMNS as u64 || length > LONGEST_TEXT {
            return Err(damaged(FORMAT, "the names of a structure's fields are impossible").in_column(path));
        }
        let names = self.data(&element, element.length)?;
        let names: Vec<String> = names
            .chunks(length as usize)
            .map(|name| String::from_utf8_lossy(name.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned())
            .collect();
        if names.is_empty() {
            return Ok(());
        }
        let several = rows.saturating_mul(columns);
        for at in 0..several {
            let path = if several == 1 { path.to_owned() } else { format!("{path}({})", at + 1) };
            for name in &names {
                self.matrix(&join(&path, name), depth)?;
                self.count()?;
            }
        }
        Ok(())
    }

    /// Reads a label of the structure.
    fn label(&mut self, path: &str) -> Result<(), FileError> {
        let element = self.tag()?;
        let kind = element.kind;
        let bytes = self.data(&element, LONGEST_TEXT)?;
        let text = match kind {
            // UTF-16, or the older encoding with two bytes per letter.
            4 | 17 => {
                let units = bytes
                    .as_chunks()
                    .0
                    .iter()
                    .map(|&unit| if self.big_endian { u16::from_be_bytes(unit) } else { u16::from_le_bytes(unit) });
                char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
            }
            _ => String::from_utf8_lossy(&bytes).into_owned(),
        };
        self.contents.labels.insert(path.to_owned(), text);
        Ok(())
    }

    /// Reads the name of an object, `MCOS`, and its class.
    fn opaque(&mut self, end: u64) -> Result<(), FileError> {
        let mut texts = Vec::new();
        while texts.len() < 3 && self.stream.at < end {
            texts.push(String::from_utf8_lossy(&self.bytes(LONGEST_TEXT)?).into_owned());
        }
        if let Ok([name, _, class]) = <[String; 3]>::try_from(texts)
            && !name.is_empty()
        {
            self.contents.objects.push(Object { name, class });
            self.count()?;
        }
        Ok(())
    }

    /// Limits the number of variables.
    fn count(&self) -> Result<(), FileError> {
        let Contents { arrays, labels, objects, unreadable } = &*self.contents;
        if arrays.len() + labels.len() + objects.len() + unreadable.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        Ok(())
    }

    fn tag(&mut self) -> Result<Element, FileError> {
        Element::read(&mut self.stream, self.big_endian).map_err(|error| unread(FORMAT, &error))
    }

    /// The data of the next element, cut to `most` bytes.
    fn bytes(&mut self, most: u64) -> Result<Vec<u8>, FileError> {
        let element = self.tag()?;
        self.data(&element, most)
    }

    fn data(&mut self, element: &Element, most: u64) -> Result<Vec<u8>, FileError> {
        let length = element.length.min(most);
        if let Some(small) = element.small {
            return Ok(small[..length as usize].to_vec());
        }
        let mut bytes = Vec::new();
        let mut piece = [0; 256];
        let mut read = || {
            while (bytes.len() as u64) < length {
                let count = (length - bytes.len() as u64).min(piece.len() as u64) as usize;
                self.stream.read_exact(&mut piece[..count])?;
                bytes.extend_from_slice(&piece[..count]);
            }
            self.stream.skip(element.padded() - length)
        };
        read().map_err(|error| unread(FORMAT, &error))?;
        Ok(bytes)
    }

    fn skip_to(&mut self, end: u64) -> Result<(), FileError> {
        let Some(count) = end.checked_sub(self.stream.at) else { return Err(damaged(FORMAT, "an array is longer than it states")) };
        self.stream.skip(count).map_err(|error| unread(FORMAT, &error))
    }
}

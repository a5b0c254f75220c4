//! Object headers: the messages that describe a group or an array.

use super::reader::{Cursor, LONGEST_TEXT, NOWHERE, Reader};
use crate::container::number::{Kind, Number};
use fluxfit_files::FileError;

/// Maximum number of blocks of an object header.
const MOST_BLOCKS: usize = 64;

/// Types of messages.
pub(super) mod message {
    pub(crate) const DATASPACE: u16 = 0x01;
    pub(crate) const LINK_INFO: u16 = 0x02;
    pub(crate) const DATATYPE: u16 = 0x03;
    pub(crate) const FILL_VALUE: u16 = 0x05;
    pub(crate) const LINK: u16 = 0x06;
    pub(crate) const EXTERNAL: u16 = 0x07;
    pub(crate) const LAYOUT: u16 = 0x08;
    pub(crate) const FILTERS: u16 = 0x0b;
    pub(crate) const ATTRIBUTE: u16 = 0x0c;
    pub(crate) const CONTINUATION: u16 = 0x10;
    pub(crate) const SYMBOL_TABLE: u16 = 0x11;
}

/// The messages of an object.
pub(super) struct Object {
    messages: Vec<(u16, Vec<u8>)>,
}

/// The type of the elements of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Number(Number),
    /// References: addresses of objects.
    Reference(Number),
    /// A text of this many bytes.
    Text(usize),
    /// A text in a heap: its length and address.
    LongText,
    Other,
}

impl Object {
    pub(super) fn read(reader: &Reader, address: u64) -> Result<Self, FileError> {
        let wrong = || reader.damaged("an object in it has no header");
        let start = reader.bytes_up_to(address, 48)?;
        let second = start.starts_with(b"OHDR");
        let parse_start = || {
            let mut cursor = Cursor(&start);
            if !second {
                let version = cursor.u8()?;
                cursor.take(7)?;
                let length = cursor.u32()?;
                return (version == 1).then_some((address.checked_add(16)?, u64::from(length), false));
            }
            cursor.take(4)?;
            let (version, flags) = (cursor.u8()?, cursor.u8()?);
            cursor.take(if flags & 0x20 != 0 { 16 } else { 0 })?;
            cursor.take(if flags & 0x10 != 0 { 4 } else { 0 })?;
            let length = match flags & 3 {
                0 => cursor.u8()?.into(),
                1 => cursor.u16()?.into(),
                2 => cursor.u32()?.into(),
                _ => cursor.u64()?,
            };
            let begin = address.checked_add((start.len() - cursor.0.len()) as u64)?;
            (version == 2).then_some((begin, length, flags & 4 != 0))
        };
        let (begin, length, ordered) = parse_start().ok_or_else(wrong)?;
        let mut object = Self { messages: Vec::new() };
        let mut blocks = vec![(begin, length)];
        let mut next = 0;
        while let Some(&(begin, length)) = blocks.get(next) {
            let bytes = reader.bytes(begin, length)?;
            let body = match (second, next) {
                (false, _) | (true, 0) => &bytes[..],
                // Later blocks are enclosed by a signature and a checksum.
                _ => bytes.strip_prefix(b"OCHK").and_then(|rest| rest.get(..rest.len().checked_sub(4)?)).ok_or_else(wrong)?,
            };
            object.block(body, second, ordered, &mut blocks);
            next += 1;
            if blocks.len() > MOST_BLOCKS {
                return Err(wrong());
            }
        }
        Ok(object)
    }

    /// Stores the messages that are needed, and the addresses of further blocks.
    fn block(&mut self, bytes: &[u8], second: bool, ordered: bool, blocks: &mut Vec<(u64, u64)>) {
        let mut cursor = Cursor(bytes);
        let mut one = || {
            let (kind, length, flags) = if second {
                let head = (u16::from(cursor.u8()?), cursor.u16()?, cursor.u8()?);
                cursor.take(if ordered { 2 } else { 0 })?;
                head
            } else {
                let head = (cursor.u16()?, cursor.u16()?, cursor.u8()?);
                cursor.take(3)?;
                head
            };
            let body = cursor.take(length.into())?;
            // The content of a shared message is stored elsewhere and not read.
            Some(if flags & 2 != 0 { (0, body) } else { (kind, body) })
        };
        while let Some((kind, body)) = one() {
            match kind {
                message::CONTINUATION => {
                    let mut cursor = Cursor(body);
                    blocks.extend(cursor.u64().zip(cursor.u64()));
                }
                message::DATASPACE
                | message::LINK_INFO
                | message::DATATYPE
                | message::FILL_VALUE
                | message::LINK
                | message::EXTERNAL
                | message::LAYOUT
                | message::FILTERS
                | message::ATTRIBUTE
                | message::SYMBOL_TABLE => self.messages.push((kind, body.to_vec())),
                _ => {}
            }
        }
    }

    pub(super) fn message(&self, kind: u16) -> Option<&[u8]> {
        self.messages(kind).next()
    }

    pub(super) fn messages(&self, kind: u16) -> impl Iterator<Item = &[u8]> {
        self.messages.iter().filter(move |message| message.0 == kind).map(|message| &message.1[..])
    }

    pub(super) fn kind(&self) -> Option<Type> {
        kind(self.message(message::DATATYPE)?)
    }

    pub(super) fn dimensions(&self) -> Option<Vec<u64>> {
        dimensions(self.message(message::DATASPACE)?)
    }

    pub(super) fn has_attribute(&self, name: &str) -> bool {
        self.attribute(name).is_some()
    }

    /// The value of an attribute, if there is one with this name and it is a text.
    pub(super) fn text(&self, reader: &Reader, name: &str) -> Result<Option<String>, FileError> {
        let Some(Attribute { kind, data, .. }) = self.attribute(name) else { return Ok(None) };
        let text = match kind {
            Type::Text(length) => data.get(..length.min(LONGEST_TEXT)).unwrap_or(data).to_vec(),
            Type::LongText => match heap_text(reader, data)? {
                Some(text) => text,
                None => return Ok(None),
            },
            _ => return Ok(None),
        };
        let text = text.split(|byte| *byte == 0).next().unwrap_or_default();
        Ok(Some(String::from_utf8_lossy(text).trim().to_owned()))
    }

    fn attribute(&self, name: &str) -> Option<Attribute<'_>> {
        self.messages(message::ATTRIBUTE).filter_map(Attribute::parse).find(|attribute| attribute.name == name.as_bytes())
    }
}

struct Attribute<'a> {
    name: &'a [u8],
    kind: Type,
    data: &'a [u8],
}

impl<'a> Attribute<'a> {
    fn parse(bytes: &'a [u8]) -> Option<Self> {
        let mut cursor = Cursor(bytes);
        let version = cursor.u8()?;
        cursor.u8()?;
        let lengths = [cursor.u16()?, cursor.u16()?, cursor.u16()?].map(usize::from);
        cursor.take(if version == 3 { 1 } else { 0 })?;
        // Only version 1 has padding.
        let padded = |length: usize| if version == 1 { length.next_multiple_of(8) } else { length };
        let name = cursor.take(padded(lengths[0]))?;
        let kind = kind(cursor.take(padded(lengths[1]))?)?;
        cursor.take(padded(lengths[2]))?;
        Some(Self { name: name.split(|byte| *byte == 0).next()?, kind, data: cursor.0 })
    }
}

/// The type in a datatype message.
fn kind(bytes: &[u8]) -> Option<Type> {
    let mut cursor = Cursor(bytes);
    let (class, bits, size) = (cursor.u8()? & 0x0f, cursor.array::<3>()?, cursor.u32()?);
    let big_endian = bits[0] & 1 != 0;
    let number = |kind| Type::Number(Number { kind, big_endian });
    Some(match class {
        // Only integers and floating-point numbers that use all of their bits.
        0 => {
            let (offset, precision) = (cursor.u16()?, cursor.u16()?);
            if offset != 0 || u32::from(precision) != size.checked_mul(8)? {
                return Some(Type::Other);
            }
            match (size, bits[0] & 8 != 0) {
                (1, true) => number(Kind::I8),
                (1, false) => number(Kind::U8),
                (2, true) => number(Kind::I16),
                (2, false) => number(Kind::U16),
                (4, true) => number(Kind::I32),
                (4, false) => number(Kind::U32),
                (8, true) => number(Kind::I64),
                (8, false) => number(Kind::U64),
                _ => Type::Other,
            }
        }
        1 => {
            let (offset, precision) = (cursor.u16()?, cursor.u16()?);
            let fields = cursor.array::<4>()?;
            match (size, offset, precision, fields, bits[0] & 0x40) {
                (4, 0, 32, [23, 8, 0, 23], 0) => number(Kind::F32),
                (8, 0, 64, [52, 11, 0, 52], 0) => number(Kind::F64),
                _ => Type::Other,
            }
        }
        3 => Type::Text(size as usize),
        7 if size == 8 => Type::Reference(Number { kind: Kind::U64, big_endian: false }),
        9 if bits[0] & 0x0f == 1 => Type::LongText,
        _ => Type::Other,
    })
}

/// The dimensions in a dataspace message.
fn dimensions(bytes: &[u8]) -> Option<Vec<u64>> {
    let mut cursor = Cursor(bytes);
    let (version, rank) = (cursor.u8()?, cursor.u8()?);
    cursor.take(if version == 1 { 6 } else { 2 })?;
    (0..rank).map(|_| cursor.u64()).collect()
}

/// A text in the global heap, from its length, the address of its collection and its index there.
fn heap_text(reader: &Reader, data: &[u8]) -> Result<Option<Vec<u8>>, FileError> {
    let mut cursor = Cursor(data);
    let Some((length, address, wanted)) = (|| Some((cursor.u32()?, cursor.u64()?, cursor.u32()?)))() else { return Ok(None) };
    if address == NOWHERE || address == 0 {
        return Ok(None);
    }
    // The HDF5 library makes collections of 4 KiB unless a text is longer.
    let bytes = reader.bytes_up_to(address, 1 << 16)?;
    let mut cursor = Cursor(&bytes);
    let mut find = || {
        (cursor.take(4)? == b"GCOL").then_some(())?;
        cursor.take(12)?;
        loop {
            let index = cursor.u16()?;
            cursor.take(6)?;
            let size = usize::try_from(cursor.u64()?).ok()?;
            if u32::from(index) == wanted && index != 0 {
                let text = cursor.take(size)?;
                return Some(text[..text.len().min(length as usize).min(LONGEST_TEXT)].to_vec());
            }
            cursor.take(size.checked_next_multiple_of(8)?)?;
        }
    };
    Ok(find())
}

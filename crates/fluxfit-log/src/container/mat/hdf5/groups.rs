//! The links of a group: names and addresses of objects.

use super::{
    object::{Object, message},
    reader::{Cursor, NOWHERE, Reader},
};
use crate::{container::limits::MOST_COLUMNS, problem::Problem};
use fluxfit_files::FileError;

/// Maximum length of a name, bytes.
const LONGEST_NAME: u64 = 256;

type Links = Vec<(String, u64)>;

/// The links; none if the object is not a group.
pub(super) fn links(reader: &Reader, object: &Object) -> Result<Option<Links>, FileError> {
    if let Some(table) = object.message(message::SYMBOL_TABLE) {
        let mut cursor = Cursor(table);
        let (tree, heap) = cursor.u64().zip(cursor.u64()).ok_or_else(|| reader.damaged("a group in it is cut off"))?;
        let names = heap_data(reader, heap)?;
        let mut links = Vec::new();
        node(reader, tree, None, names, &mut links)?;
        return Ok(Some(links));
    }
    let Some(info) = object.message(message::LINK_INFO) else {
        let links: Links = object.messages(message::LINK).filter_map(link).collect();
        return Ok((!links.is_empty()).then_some(links));
    };
    if is_dense(info) {
        return Err(reader.newer("a group with its links in a heap"));
    }
    Ok(Some(object.messages(message::LINK).filter_map(link).collect()))
}

/// Whether the links are in a fractal heap instead of messages.
fn is_dense(info: &[u8]) -> bool {
    let mut cursor = Cursor(info);
    let mut heap = || {
        cursor.u8()?;
        let flags = cursor.u8()?;
        cursor.take(if flags & 1 != 0 { 8 } else { 0 })?;
        cursor.u64()
    };
    heap().is_some_and(|heap| heap != NOWHERE)
}

/// The link in a link message; none of a soft or external link.
fn link(bytes: &[u8]) -> Option<(String, u64)> {
    let mut cursor = Cursor(bytes);
    let (_version, flags) = (cursor.u8()?, cursor.u8()?);
    let kind = if flags & 8 != 0 { cursor.u8()? } else { 0 };
    cursor.take(if flags & 4 != 0 { 8 } else { 0 })?;
    cursor.take(if flags & 0x10 != 0 { 1 } else { 0 })?;
    let length = match flags & 3 {
        0 => cursor.u8()?.into(),
        1 => cursor.u16()?.into(),
        2 => cursor.u32()? as usize,
        _ => usize::try_from(cursor.u64()?).ok()?,
    };
    let name = String::from_utf8_lossy(cursor.take(length)?).into_owned();
    (kind == 0).then_some((name, cursor.u64()?))
}

/// The address and length of the names in a local heap.
fn heap_data(reader: &Reader, heap: u64) -> Result<(u64, u64), FileError> {
    let bytes = reader.bytes(heap, 32)?;
    let mut cursor = Cursor(&bytes);
    let mut parse = || {
        (cursor.take(4)? == b"HEAP").then_some(())?;
        cursor.take(4)?;
        let length = cursor.u64()?;
        cursor.u64()?;
        Some((cursor.u64()?, length))
    };
    parse().ok_or_else(|| reader.damaged("a group in it has no names"))
}

/// A node of the tree of a group: its leaves are the symbols, in the order of their names.
fn node(reader: &Reader, address: u64, level: Option<u8>, names: (u64, u64), links: &mut Links) -> Result<(), FileError> {
    let wrong = || reader.damaged("a group in it is damaged");
    let bytes = reader.bytes(address, 24)?;
    let mut cursor = Cursor(&bytes);
    let mut head = || {
        (cursor.take(4)? == b"TREE" && cursor.u8()? == 0).then_some(())?;
        Some((cursor.u8()?, cursor.u16()?))
    };
    let (found, entries) = head().ok_or_else(wrong)?;
    // Levels decrease to 0, so no node is its own descendant.
    if level.is_some_and(|level| level != found) {
        return Err(wrong());
    }
    let entries = u64::from(entries);
    let bytes = reader.bytes(address.saturating_add(24), entries * 16)?;
    for entry in bytes.as_chunks::<16>().0 {
        // A key, and the address of the child to its right.
        let child = Cursor(&entry[8..]).u64().ok_or_else(wrong)?;
        match found.checked_sub(1) {
            Some(below) => node(reader, child, Some(below), names, links)?,
            None => symbols(reader, child, names, links)?,
        }
    }
    Ok(())
}

fn symbols(reader: &Reader, address: u64, (names, length): (u64, u64), links: &mut Links) -> Result<(), FileError> {
    let wrong = || reader.damaged("a group in it is damaged");
    let head = reader.bytes(address, 8)?;
    let mut cursor = Cursor(&head);
    let mut count = || {
        (cursor.take(4)? == b"SNOD").then_some(())?;
        cursor.u16()?;
        cursor.u16()
    };
    let count = count().ok_or_else(wrong)?;
    let bytes = reader.bytes(address.saturating_add(8), u64::from(count) * 40)?;
    for entry in bytes.as_chunks::<40>().0 {
        let mut cursor = Cursor(entry);
        let (name, object) = cursor.u64().zip(cursor.u64()).ok_or_else(wrong)?;
        let left = length.checked_sub(name).ok_or_else(wrong)?;
        let text = reader.bytes_up_to(names.saturating_add(name), left.min(LONGEST_NAME))?;
        let text = text.split(|byte| *byte == 0).next().unwrap_or_default();
        if object != NOWHERE {
            links.push((String::from_utf8_lossy(text).into_owned(), object));
        }
        if links.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
    }
    Ok(())
}

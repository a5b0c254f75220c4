//! HDF5 files, as MATLAB 7.3, h5py and PyTables write them by default: the format's older structures, versions 0 to 2 of the
//! superblock, groups with symbol tables or compact links, contiguous or chunked data with deflate and shuffle.
//!
//! The subset is small enough to check every length in it; files that need more are refused with the way to write what is read here.
//! The format: <https://support.hdfgroup.org/documentation/hdf5/latest/_f_m_t3.html>; what MATLAB adds: the attributes
//! `MATLAB_class` and `MATLAB_object_decode`, and arrays with their dimensions in reverse order.

mod groups;
mod object;
mod values;

pub(crate) use values::{Place, Values};

use super::{Array, Contents, Line, Object as Opaque, Source, join, worthwhile};
use crate::{
    container::{MOST_COLUMNS, damaged, unread},
    problem::Problem,
};
use fluxfit_files::FileError;
use object::{Object, Type};
use std::{cell::Cell, collections::HashSet};

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// An address that is none.
const NOWHERE: u64 = u64::MAX;

/// Groups inside of groups at most.
const DEEPEST: usize = 16;

/// Letters of a label or unit at most.
const LONGEST_TEXT: usize = 256;

/// Where the file starts: after MATLAB's own header, or at once.
pub(super) fn signature(start: &[u8]) -> Option<u64> {
    [0, 512].into_iter().find(|&at| start.get(at..).is_some_and(|rest| rest.starts_with(SIGNATURE))).map(|at| at as u64)
}

/// The file's structures, by address.
pub(crate) struct Reader {
    source: Source,
    base: u64,
    format: &'static str,
    /// Bytes that may still be read of structures: what is shared or circular cannot make the reading long.
    budget: Cell<u64>,
}

impl Reader {
    fn bytes(&self, at: u64, length: u64) -> Result<Vec<u8>, FileError> {
        let left = self.budget.get().checked_sub(length).ok_or_else(|| self.damaged("its structure runs in circles"))?;
        self.budget.set(left);
        let at = self.base.checked_add(at).ok_or_else(|| self.damaged("an address in it is impossible"))?;
        self.source.bytes_at(at, length).map_err(|error| unread(self.format, &error))
    }

    /// As many of the bytes as there are.
    fn bytes_up_to(&self, at: u64, length: u64) -> Result<Vec<u8>, FileError> {
        let left = self.source.length().saturating_sub(self.base).saturating_sub(at);
        self.bytes(at, length.min(left))
    }

    fn damaged(&self, fault: &'static str) -> FileError {
        damaged(self.format, fault)
    }

    fn newer(&self, what: &'static str) -> FileError {
        Problem::NewerHdf5 { what }.into()
    }
}

/// The arrays of a file, to be read.
pub(crate) struct File {
    reader: Reader,
    places: Vec<Place>,
}

impl File {
    pub(super) fn open(source: Source, base: u64, format: &'static str) -> Result<(Self, Contents<Place>), FileError> {
        // Structures are read once or twice; the least is for small files that share them.
        let budget = Cell::new(source.length().saturating_mul(4).saturating_add(1 << 16));
        let reader = Reader { source, base, format, budget };
        let root = superblock(&reader)?;
        let mut contents = Contents::default();
        Walk { reader: &reader, contents: &mut contents, groups: HashSet::new() }.object(root, "", DEEPEST)?;
        Ok((Self { reader, places: Vec::new() }, contents))
    }

    pub(super) fn with(self, places: Vec<Place>) -> Self {
        Self { places, ..self }
    }

    pub(super) fn line(&self, array: usize, line: Line) -> Result<Values, FileError> {
        self.reader.budget.set(self.reader.source.length().saturating_mul(4).saturating_add(1 << 16));
        Values::open(&self.reader, &self.places[array], line)
    }
}

/// The address of the root group's object header.
fn superblock(reader: &Reader) -> Result<u64, FileError> {
    let bytes = reader.bytes_up_to(0, 128)?;
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(0);
    // The root's address is, in versions 0 and 1, in the entry that ends the block.
    let (sizes, root) = match byte(8) {
        0 => (13, 64),
        1 => (13, 68),
        2 | 3 => (9, 36),
        _ => return Err(reader.newer("this version of the superblock")),
    };
    if (byte(sizes), byte(sizes + 1)) != (8, 8) {
        return Err(reader.newer("addresses that do not have 8 bytes"));
    }
    Cursor(bytes.get(root..).unwrap_or_default()).u64().ok_or_else(|| reader.damaged("it ends too early"))
}

struct Walk<'a> {
    reader: &'a Reader,
    contents: &'a mut Contents<Place>,
    /// The addresses of those that were entered: links may lead back to them.
    groups: HashSet<u64>,
}

impl Walk<'_> {
    /// A group or an array.
    fn object(&mut self, address: u64, path: &str, depth: usize) -> Result<(), FileError> {
        let Some(depth) = depth.checked_sub(1) else { return Ok(()) };
        let object = Object::read(self.reader, address)?;
        let class = object.text(self.reader, "MATLAB_class")?;
        let found = &*self.contents;
        if found.arrays.len() + found.labels.len() + found.objects.len() + found.unreadable.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        if let (Some(class), true) = (&class, object.has_attribute("MATLAB_object_decode")) {
            // The texts and functions of MATLAB are objects too, and no logs.
            if class == "string" || class == "function_handle" {
                self.contents.unreadable.push(path.to_owned());
            } else {
                self.contents.objects.push(Opaque { name: path.to_owned(), class: class.clone() });
            }
            return Ok(());
        }
        if object.has_attribute("MATLAB_sparse") {
            self.contents.unreadable.push(path.to_owned());
            return Ok(());
        }
        if let Some(links) = groups::links(self.reader, &object)? {
            if !self.groups.insert(address) {
                return Ok(());
            }
            // What starts so is MATLAB's own.
            for (name, address) in links.into_iter().filter(|(name, _)| !name.starts_with('#')) {
                self.object(address, &join(path, &name), depth)?;
            }
            return Ok(());
        }
        self.array(&object, path, class.as_deref(), depth)
    }

    fn array(&mut self, object: &Object, path: &str, class: Option<&str>, depth: usize) -> Result<(), FileError> {
        let Some((kind, dimensions)) = object.kind().zip(object.dimensions()) else { return Ok(()) };
        let (first, second) = match dimensions[..] {
            [first] => (first, 1),
            [first, second] => (first, second),
            // A scalar is no column and not worth a word.
            [] => return Ok(()),
            _ => return self.no_numbers(path),
        };
        if object.has_attribute("MATLAB_empty") || first == 0 || second == 0 {
            return Ok(());
        }
        let reversed = class.is_some() && dimensions.len() == 2;
        let place = |number| Place::new(self.reader, object, number, [first, second], reversed);
        match (kind, class) {
            (Type::Number(_), Some("logical" | "cell")) => self.no_numbers(path),
            // What netCDF packs so is not what it means.
            (Type::Number(_), _) if object.has_attribute("scale_factor") || object.has_attribute("add_offset") => self.no_numbers(path),
            (Type::Number(number), Some("char")) => {
                if let Some(owner) = path.strip_suffix(".label") {
                    let letters = Values::open(self.reader, &place(number)?, longest(first, second, reversed))?
                        .next(LONGEST_TEXT.min(first.max(second) as usize))?;
                    let text = letters.iter().map(|&letter| char::from_u32(letter as u32).unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
                    self.contents.labels.insert(owner.to_owned(), text);
                }
                Ok(())
            }
            (Type::Number(number), _) => {
                let (rows, columns) = if reversed { (second, first) } else { (first, second) };
                if worthwhile(rows, columns) {
                    let unit = match object.text(self.reader, "unit")? {
                        Some(unit) => Some(unit),
                        None => object.text(self.reader, "units")?,
                    };
                    let place = place(number).map_err(|error| error.in_column(path))?;
                    self.contents.arrays.push(Array { path: path.to_owned(), unit, rows, columns, place });
                }
                Ok(())
            }
            // A field of an array of structures: where the field of each is.
            (Type::Reference(number), None) => {
                let Some((owner, field)) = path.rsplit_once('.') else { return Ok(()) };
                let count = first.saturating_mul(second).min(MOST_COLUMNS as u64) as usize;
                if first.min(second) > 1 {
                    return self.no_numbers(path);
                }
                let reversed = dimensions.len() == 2;
                let place = Place::new(self.reader, object, number, [first, second], reversed)?;
                let addresses = Values::open(self.reader, &place, longest(first, second, reversed))?.next(count)?;
                for (at, address) in addresses.into_iter().enumerate() {
                    self.object(address as u64, &join(&format!("{owner}({})", at + 1), field), depth)?;
                }
                Ok(())
            }
            _ => self.no_numbers(path),
        }
    }

    fn no_numbers(&mut self, path: &str) -> Result<(), FileError> {
        self.contents.unreadable.push(path.to_owned());
        Ok(())
    }
}

/// The line of a vector.
fn longest(first: u64, second: u64, reversed: bool) -> Line {
    if (first >= second) == reversed { Line::Row(0) } else { Line::Column(0) }
}

/// Little-endian integers, as the structures of the format are.
struct Cursor<'a>(&'a [u8]);

impl<'a> Cursor<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.first_chunk().copied()
    }

    fn u8(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }
}

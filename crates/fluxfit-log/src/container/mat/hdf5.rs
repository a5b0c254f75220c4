//! HDF5 files as MATLAB 7.3, h5py and PyTables write them by default: the older structures of the format, versions 0 to 2 of the
//! superblock, groups with symbol tables or compact links, contiguous or chunked data with deflate and shuffle.
//!
//! This subset is small enough to check every length in it. Other files are refused, and the message states how to write a supported
//! one. The format: <https://support.hdfgroup.org/documentation/hdf5/latest/_f_m_t3.html>. MATLAB adds the attributes `MATLAB_class`
//! and `MATLAB_object_decode`, and stores dimensions in reverse order.

mod filters;
mod groups;
mod object;
mod reader;
mod values;

pub(crate) use values::{Place, Values};

use super::array::{Array, Contents, Line, Object as Opaque, is_column, is_label, join};
use crate::{
    container::{limits::MOST_COLUMNS, random_access::RandomAccess},
    problem::Problem,
};
use fluxfit_files::FileError;
use object::{Object, Type};
use reader::{Cursor, LONGEST_TEXT, Reader};
use std::{
    cell::Cell,
    collections::{HashMap, HashSet},
};

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Maximum number of names of one array; further ones are not read: nobody names a channel so often, and each would take time.
const MOST_LINKS: usize = 16;

/// Maximum nesting of groups.
const DEEPEST: usize = 16;

/// The offset of the HDF5 content: after a header of MATLAB, or 0.
pub(super) fn signature(start: &[u8]) -> Option<u64> {
    [0, 512].into_iter().find(|&at| start.get(at..).is_some_and(|rest| rest.starts_with(SIGNATURE))).map(|at| at as u64)
}

/// The arrays of a file, to be read.
pub(crate) struct File {
    reader: Reader,
    places: Vec<Place>,
}

impl File {
    pub(super) fn open(source: RandomAccess, base: u64, format: &'static str) -> Result<(Self, Contents<Place>), FileError> {
        // Structures are read once or twice; the constant is for small files with shared structures.
        let budget = Cell::new(source.length().saturating_mul(4).saturating_add(1 << 16));
        let reader = Reader { source, base, format, budget };
        let root = superblock(&reader)?;
        let mut contents = Contents::default();
        Walk { reader: &reader, contents: &mut contents, groups: HashSet::new(), arrays: HashMap::new() }.object(root, "", DEEPEST)?;
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
    // In versions 0 and 1 the address of the root is in the last entry of the block.
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
    /// The addresses of groups that were visited: links may lead back to them.
    groups: HashSet<u64>,
    /// How many links lead to each array.
    arrays: HashMap<u64, usize>,
}

impl Walk<'_> {
    /// Visits a group or an array.
    fn object(&mut self, address: u64, path: &str, depth: usize) -> Result<(), FileError> {
        let Some(depth) = depth.checked_sub(1) else { return Ok(()) };
        let object = Object::read(self.reader, address)?;
        let class = object.text(self.reader, "MATLAB_class")?;
        let found = &*self.contents;
        if found.arrays.len() + found.labels.len() + found.objects.len() + found.unreadable.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        if let (Some(class), true) = (&class, object.has_attribute("MATLAB_object_decode")) {
            // Strings and function handles of MATLAB are objects too.
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
            // Names that start with # are internal to MATLAB.
            for (name, address) in links.into_iter().filter(|(name, _)| !name.starts_with('#')) {
                self.object(address, &join(path, &name), depth)?;
            }
            return Ok(());
        }
        let links = self.arrays.entry(address).or_default();
        *links += 1;
        if *links > MOST_LINKS {
            return self.no_numbers(path);
        }
        self.array(&object, path, class.as_deref(), depth)
    }

    fn array(&mut self, object: &Object, path: &str, class: Option<&str>, depth: usize) -> Result<(), FileError> {
        let Some((kind, dimensions)) = object.kind().zip(object.dimensions()) else { return Ok(()) };
        let (first, second) = match dimensions[..] {
            [first] => (first, 1),
            [first, second] => (first, second),
            // A scalar is not a column, and not reported.
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
            // netCDF stores scaled numbers here, which are not the values.
            (Type::Number(_), _) if object.has_attribute("scale_factor") || object.has_attribute("add_offset") => self.no_numbers(path),
            (Type::Number(number), Some("char")) => {
                if is_label(path) {
                    let letters = Values::open(self.reader, &place(number)?, longest(first, second, reversed))?
                        .next(LONGEST_TEXT.min(first.max(second) as usize))?;
                    let text = letters.iter().map(|&letter| char::from_u32(letter as u32).unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
                    self.contents.labels.insert(path.to_owned(), text);
                }
                Ok(())
            }
            (Type::Number(number), _) => {
                let (rows, columns) = if reversed { (second, first) } else { (first, second) };
                if is_column(rows, columns) {
                    let unit = match object.text(self.reader, "unit")? {
                        Some(unit) => Some(unit),
                        None => object.text(self.reader, "units")?,
                    };
                    let place = place(number).map_err(|error| error.in_column(path))?;
                    self.contents.arrays.push(Array { path: path.to_owned(), unit, rows, columns, place });
                }
                Ok(())
            }
            // A field of an array of structures: references to the field of each.
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

/// The longer line of an array with one row or column.
fn longest(first: u64, second: u64, reversed: bool) -> Line {
    if (first >= second) == reversed { Line::Row(0) } else { Line::Column(0) }
}

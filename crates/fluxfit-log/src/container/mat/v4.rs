//! MAT files of version 4: a sequence of variables, each with a header of five integers, its name, and its numbers column by column.
//!
//! The format: MathWorks, MAT-File Format, chapter 2.

use super::{
    array::{Array, Contents, is_column},
    numbers::Place,
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

const HEADER: u64 = 20;

/// Maximum length of the name of a variable, bytes, with its terminating zero: the limit of MATLAB is 63 letters.
const LONGEST_NAME: u64 = 64;

/// A variable.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) number: Number,
    /// It holds real numbers, no text, and no zero is left out.
    pub(super) is_matrix: bool,
    pub(super) rows: u64,
    pub(super) columns: u64,
    /// Offsets of its numbers, and of their end.
    pub(super) from: u64,
    pub(super) to: u64,
}

struct Header {
    number: Number,
    /// 0: full matrix, 1: text, 2: sparse matrix.
    matrix: u32,
    rows: u64,
    columns: u64,
    complex: bool,
    name_length: u64,
}

impl Header {
    /// None if this is not the header of a variable.
    fn parse(header: &[u8]) -> Option<Self> {
        let words: &[[u8; 4]; 5] = header.as_chunks().0.first_chunk()?;
        // The type is a number with the decimal digits MOPT, less than 5000, which shows the byte order of all five integers.
        let big_endian = u32::from_le_bytes(words[0]) >= 5000;
        let word = |at: usize| if big_endian { u32::from_be_bytes(words[at]) } else { u32::from_le_bytes(words[at]) };
        let (machine, zero, precision, matrix) = (word(0) / 1000, word(0) / 100 % 10, word(0) / 10 % 10, word(0) % 10);
        let kind = match precision {
            0 => Kind::F64,
            1 => Kind::F32,
            2 => Kind::I32,
            3 => Kind::I16,
            4 => Kind::U16,
            5 => Kind::U8,
            _ => return None,
        };
        let known = machine == u32::from(big_endian) && zero == 0 && matrix <= 2 && word(3) <= 1;
        let name_length = u64::from(word(4));
        (known && (2..=LONGEST_NAME).contains(&name_length)).then(|| Self {
            number: Number { kind, big_endian },
            matrix,
            rows: word(1).into(),
            columns: word(2).into(),
            complex: word(3) == 1,
            name_length,
        })
    }

    /// Bytes of the numbers.
    fn length(&self) -> u64 {
        // The product of factors below 2^32, 2^32 and 2^5 may overflow.
        let parts = if self.complex { 2 } else { 1 };
        self.rows.saturating_mul(self.columns).saturating_mul(parts * self.number.width() as u64)
    }
}

/// Whether this is a version 4 file. It has no signature, but starts with a variable that has a valid name and fits into the file.
pub(super) fn signature(start: &[u8], length: u64) -> bool {
    let Some(variable) = Header::parse(start) else { return false };
    let name = start.get(HEADER as usize..(HEADER + variable.name_length) as usize);
    let named = name.is_some_and(|name| name.split_last().is_some_and(|(zero, letters)| *zero == 0 && is_identifier(letters)));
    named && HEADER.saturating_add(variable.name_length).saturating_add(variable.length()) <= length
}

fn is_identifier(letters: &[u8]) -> bool {
    letters.first().is_some_and(u8::is_ascii_alphabetic) && letters.iter().all(|letter| letter.is_ascii_alphanumeric() || *letter == b'_')
}

/// The variables of a file.
pub(super) fn open(source: &RandomAccess) -> Result<Vec<Variable>, FileError> {
    let mut variables = Vec::new();
    let mut at = 0;
    while at < source.length() {
        let header = source.bytes_at(at, HEADER).map_err(|error| unread("MAT", &error))?;
        let header = Header::parse(&header).ok_or_else(|| damaged("MAT", "a variable has no type"))?;
        let name = source.bytes_at(at + HEADER, header.name_length).map_err(|error| unread("MAT", &error))?;
        let name: String = String::from_utf8_lossy(&name).trim_end_matches('\0').to_owned();
        let from = at + HEADER + header.name_length;
        let to = from.saturating_add(header.length());
        if to > source.length() {
            return Err(damaged("MAT", "it ends too early").in_column(&name));
        }
        let Header { number, rows, columns, .. } = header;
        variables.push(Variable { name, number, is_matrix: header.matrix == 0 && !header.complex, rows, columns, from, to });
        if variables.len() > MOST_COLUMNS {
            return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
        }
        at = to;
    }
    Ok(variables)
}

/// The arrays of numbers among variables.
pub(super) fn contents(variables: Vec<Variable>) -> Contents<Place> {
    let mut contents = Contents::default();
    for Variable { name, number, is_matrix, rows, columns, from, to } in variables {
        if !is_matrix {
            contents.unreadable.push(name);
        } else if is_column(rows, columns) {
            let place = Place::plain(from, to, number, rows);
            contents.arrays.push(Array { path: name, unit: None, rows, columns, place });
        }
    }
    contents
}

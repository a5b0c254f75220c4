//! What the first rows of a table tell about its columns: which hold instants, and which hold no numbers.

use crate::instant::{Instants, counted};
use fluxfit_files::csv::{
    header::{Header, is_number},
    record::first_record,
};

/// Number of rows that are looked at for instants.
const ROWS: usize = 1000;

/// Digits before the point of the shortest number of seconds since 1970.
const EPOCH_DIGITS: usize = 9;

/// Number of rows of which one has to hold a number of a column.
const ROWS_WITHOUT: usize = 100;

/// The columns whose cells in the first rows are texts, or all empty.
pub(super) fn without_numbers(head: &str, header: &Header) -> Vec<usize> {
    let rows = head[header.body.min(head.len())..].split(['\r', '\n']).filter(|line| !line.trim().is_empty());
    let table: Vec<Vec<String>> = rows.take(ROWS_WITHOUT).map(|line| first_record(line, header.separator).0).collect();
    let has_number = |place: usize| table.iter().filter_map(|row| row.get(place)).any(|cell| is_number(cell));
    (0..header.names.len()).filter(|place| !table.is_empty() && !has_number(*place)).collect()
}

/// For each column, how its cells state instants, if they do.
pub(super) fn instants(head: &str, header: &Header) -> Vec<Option<Instants>> {
    let mut rows = head[header.body.min(head.len())..].split(['\r', '\n']).filter(|line| !line.trim().is_empty());
    let cells = |line: &str| first_record(line, header.separator).0;
    let Some(first) = rows.next().map(cells) else { return Vec::new() };
    let is_likely = |cell: &String| match is_number(cell) {
        true => cell.bytes().take_while(u8::is_ascii_digit).count() >= EPOCH_DIGITS,
        false => {
            let digits = cell.bytes().filter(u8::is_ascii_digit).count();
            counted(cell).is_some() || cell.starts_with(|c: char| c.is_ascii_alphanumeric()) && digits > 3
        }
    };
    if !first.iter().any(is_likely) {
        return Vec::new();
    }
    // The head may end within the last one.
    let mut table: Vec<Vec<String>> = vec![first];
    table.extend(rows.take(ROWS).map(cells));
    if table.len() > 2 {
        table.pop();
    }
    let of_column = |place: usize| {
        let cells: Vec<&str> = table.iter().filter_map(|row| row.get(place)).map(String::as_str).filter(|cell| !cell.is_empty()).collect();
        Instants::of(&cells)
    };
    (0..header.names.len()).map(|place| table[0].get(place).filter(|cell| is_likely(cell)).and_then(|_| of_column(place))).collect()
}

//! A flux map from a table of text: one row per current, in any order; other columns are ignored.
//!
//! Columns: `id`, `iq` in A, `psi_d`, `psi_q` in Wb, also with their unit in the name (`id_A`, `psi_d_Wb`).

use crate::problem::Problem;
use ::csv::ByteRecord;
use fluxfit::frames::Dq;
use fluxfit_drive::{Error, FluxMap};
use fluxfit_files::{
    FileError, Problem as FileProblem,
    csv::{header, record},
    input,
};
use std::path::Path;

/// Names of the columns, and with their units.
const COLUMNS: [(&str, &str); 4] = [("id", "id_A"), ("iq", "iq_A"), ("psi_d", "psi_d_Wb"), ("psi_q", "psi_q_Wb")];

/// Reads a flux map.
///
/// # Errors
/// If the file cannot be read, is not a table with these columns, or [`FluxMap::new`] refuses its points.
pub(crate) fn read_flux_map(path: &Path) -> Result<FluxMap, FileError> {
    let parse = |bytes: Vec<u8>| input::text(&bytes, "CSV text").and_then(parse);
    input::read(path).and_then(parse).map_err(|error| error.in_file(&input::name(path)))
}

fn parse(text: &str) -> Result<FluxMap, FileError> {
    let header = header::find(text, &mut Vec::new())?;
    let text = &*header.rows.tidied(text, header.body);
    let (mut points, mut starts) = (Vec::new(), Vec::new());
    let columns = columns(&header)?;
    let mut reader = record::reader(&text.as_bytes()[header.body..], header.separator);
    let mut cells = ByteRecord::new();
    while record::next(&mut reader, &mut cells)? {
        let start = header.body + record::offset(&cells);
        if cells.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
        points.push(point(&cells, &header, columns).map_err(|error| error.at_line(record::line_of(text, start)))?);
        starts.push(start);
    }
    FluxMap::new(&points).map_err(|error| {
        let at = match error {
            Error::MapInductance { id, iq } => points.iter().position(|(i, _)| i.d == id && i.q == iq),
            _ => None,
        };
        let refused = FileError::from(Problem::Drive(error));
        match at {
            Some(row) => refused.at_line(record::line_of(text, starts[row])),
            None => refused,
        }
    })
}

fn columns(header: &header::Header) -> Result<[usize; 4], FileError> {
    let place = |(plain, with_unit): (&str, &str)| {
        header.names.iter().position(|name| name.eq_ignore_ascii_case(plain) || name.eq_ignore_ascii_case(with_unit))
    };
    let found = COLUMNS.map(place);
    let [Some(id), Some(iq), Some(psi_d), Some(psi_q)] = found else {
        let missing = COLUMNS.iter().zip(found).filter(|(_, place)| place.is_none()).map(|((name, _), _)| *name).collect();
        return Err(FileError::from(Problem::MapColumns { missing, present: header.names.clone() }).at_line(header.line));
    };
    Ok([id, iq, psi_d, psi_q])
}

fn point(cells: &ByteRecord, header: &header::Header, columns: [usize; 4]) -> Result<(Dq, Dq), FileError> {
    let (found, expected) = (cells.len(), header.names.len());
    if found < expected {
        return Err(FileProblem::RowLength { found, expected, multiline: cells.as_slice().contains(&b'\n') }.into());
    }
    let mut values = [0.0; 4];
    for (value, column) in values.iter_mut().zip(columns) {
        let cell = cells.get(column).unwrap_or_default();
        let number = record::number(cell, header.separator, &mut String::new()).filter(|number| number.is_finite());
        let refusal = || FileError::from(FileProblem::NotANumber { text: String::from_utf8_lossy(cell).trim().to_owned() });
        *value = number.ok_or_else(|| refusal().in_column(&header.names[column]))?;
    }
    let [d, q, psi_d, psi_q] = values;
    Ok((Dq { d, q }, Dq { d: psi_d, q: psi_q }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `psi_d = 0.1 + 0.01 i_d`, `psi_q = 0.02 i_q` on a grid of 3 by 3.
    fn table(header: &str, change: impl Fn(usize, String) -> String) -> String {
        let point = |k: usize| {
            let (d, q) = ((k / 3) as f64 - 2.0, (k % 3) as f64);
            change(k, format!("{d},{q},{},{}", 0.1 + 0.01 * d, 0.02 * q))
        };
        format!("{header}\n{}\n", (0..9).map(point).collect::<Vec<_>>().join("\n"))
    }

    #[test]
    fn both_headers_are_read() {
        let map = parse(&table("id_A,iq_A,psi_d_Wb,psi_q_Wb", |_, row| row)).unwrap();
        assert_eq!((map.id_range(), map.iq_range()), ([-2.0, 0.0], [0.0, 2.0]));
        assert_eq!(parse(&table("id,iq,psi_d,psi_q", |_, row| row)).unwrap(), map);
        assert_eq!(parse(&table("note;id;iq;psi_d;psi_q", |_, row| format!("a;{}", row.replace(',', ";")))).unwrap(), map);
    }

    #[test]
    fn errors_name_line_and_column() {
        let names = "id,iq,psi_d,psi_q";
        let at = |k: usize, other: &'static str| table(names, move |row, text| if row == k { other.to_owned() } else { text });
        let cases = [
            (
                table("id,iq,psi_d,flux", |_, row| row),
                "line 1: the column psi_q is missing; the file has 'id', 'iq', 'psi_d' and 'flux', and a flux map needs id, iq in A, psi_d, psi_q in Wb",
            ),
            (at(3, "-1,0,x,0"), "line 5, column 'psi_d': \"x\" is not a number; correct it or remove the row"),
            (at(3, "-1,0,nan,0"), "line 5, column 'psi_d': \"nan\" is not a number; correct it or remove the row"),
            (at(3, "-1,0,0.1"), "line 5: the row has 3 cells where the header has 4; complete the row or remove it"),
            (
                at(3, "-1.5,0,0.1,0"),
                "the flux map has no point at i_d = -1.5 A, i_q = 1 A, although it has both currents in other points; add it, so that the grid is complete",
            ),
            (
                at(4, "-1,1,0.09,-0.02"),
                "line 5: around i_d = -1 A, i_q = 0 A the flux of the map falls while the current rises, which is not physical; \
                 check for swapped axes or signs, or smooth the map",
            ),
        ];
        for (text, sentence) in cases {
            assert_eq!(parse(&text).unwrap_err().to_string(), sentence);
        }
    }
}

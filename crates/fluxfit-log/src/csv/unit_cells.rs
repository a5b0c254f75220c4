//! Cells with a unit behind each number, as dashboards export them: `0.0244 A`, and in the next row `24.4 mA`. They become numbers of one
//! unit while they are read, and the column has that unit.

use super::text::Text;
use fluxfit_files::csv::{header::Header, record::first_record};
use std::io::{self, Read};

/// So many rows are looked at.
const ROWS: usize = 100;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Units that have prefixes; those of times are told by themselves where all cells have the same.
const PREFIXED: [&str; 5] = ["V", "A", "W", "Hz", SECOND];
const SECOND: &str = "s";

/// Prefixes, as powers of ten.
const PREFIXES: [(&str, i32); 8] = [("", 0), ("n", -9), ("µ", -6), ("μ", -6), ("u", -6), ("m", -3), ("k", 3), ("M", 6)];

/// Other units.
const OTHERS: [&str; 14] = ["rpm", "RPM", "r/min", "1/min", "min-1", "rad/s", "rad", "deg", "°", "deg/s", "°/s", "°C", "Nm", "%"];

/// The unit of a column, and that of a cell in powers of ten.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellUnit {
    of_column: &'static str,
    power: i32,
}

/// The text with numbers in the place of such cells, if all cells of some columns are such; their units are those of the columns.
pub(super) fn without_units(text: Text, header: &mut Header) -> Text {
    let rows = || text.head[header.body.min(text.head.len())..].lines().filter(|line| !line.trim().is_empty()).take(ROWS);
    // Most logs are of numbers alone, and their rows are passed over at once.
    if !rows().any(has_unit) {
        return text;
    }
    let mut table: Vec<Vec<String>> = rows().map(|line| first_record(line, header.separator).0).collect();
    // The head may end within the last one.
    if table.len() > 2 {
        table.pop();
    }
    let of_column = |place: usize| {
        let cells = table.iter().filter_map(|row| row.get(place)).filter(|cell| !cell.is_empty());
        let units: Option<Vec<CellUnit>> = cells.map(|cell| split(cell).map(|(.., unit)| unit)).collect();
        let units = units.filter(|units| !units.is_empty())?;
        let is_one = units.iter().all(|unit| unit.of_column == units[0].of_column);
        let is_of_times = units[0].of_column == SECOND && units.iter().all(|unit| unit == &units[0]);
        // What the name states is in the way of another unit.
        let name = header.names.get(place).map(String::as_str).unwrap_or_default();
        let is_free = name.split_once(['[', '(', '@']).is_none_or(|(_, stated)| stated.trim_end_matches([']', ')']) == units[0].of_column);
        (is_one && !is_of_times && is_free).then_some(units[0].of_column)
    };
    let units: Vec<Option<&'static str>> = (0..header.names.len()).map(of_column).collect();
    if units.iter().all(Option::is_none) {
        return text;
    }
    header.units.resize(header.names.len(), String::new());
    for (stated, unit) in header.units.iter_mut().zip(&units) {
        if let Some(unit) = unit {
            (*unit).clone_into(stated);
        }
    }
    let separator = header.separator;
    let mut text =
        text.changed(header.body, |rows| Box::new(Numbers { rows, separator, units, line: Vec::new(), changed: Vec::new(), passed: 0 }));
    text.notes.push("cells have their units beside the numbers, and are read in these".to_owned());
    text
}

/// Whether anything in a line may be a unit: a letter other than that of an exponent, or a sign.
fn has_unit(line: &str) -> bool {
    line.bytes().any(|byte| byte == b'%' || !byte.is_ascii() || byte.is_ascii_alphabetic() && !b"eE".contains(&byte))
}

/// The digits and the exponent of the number at the beginning of a cell, and the unit behind it.
fn split(cell: &str) -> Option<(&str, i32, CellUnit)> {
    let length = |text: &str, marks: &str| text.find(|c: char| !(c.is_ascii_digit() || marks.contains(c))).unwrap_or(text.len());
    let (digits, rest) = cell.split_at(length(cell, "+-., "));
    let (exponent, unit) = match rest.strip_prefix(['e', 'E']).map(|behind| behind.split_at(length(behind, "+-"))) {
        Some((exponent, unit)) if !exponent.is_empty() => (exponent.parse().ok()?, unit),
        _ => (0, rest),
    };
    let (digits, unit) = (digits.trim_end(), unit.trim());
    let is_number = digits.contains(|c: char| c.is_ascii_digit()) && !digits.contains(' ');
    let prefixed = || {
        PREFIXED.into_iter().find_map(|base| {
            let prefix = unit.strip_suffix(base)?;
            let (_, power) = PREFIXES.iter().find(|(name, _)| *name == prefix)?;
            Some(CellUnit { of_column: base, power: *power })
        })
    };
    let other = || OTHERS.into_iter().find(|other| *other == unit).map(|of_column| CellUnit { of_column, power: 0 });
    let unit = prefixed().or_else(other).filter(|_| is_number)?;
    Some((digits, exponent, unit))
}

/// Rows in which numbers stand in the place of such cells.
struct Numbers<R> {
    rows: R,
    separator: u8,
    /// Of each column.
    units: Vec<Option<&'static str>>,
    /// The beginning of a line whose end was not read.
    line: Vec<u8>,
    changed: Vec<u8>,
    /// Bytes of `changed` that were passed on.
    passed: usize,
}

impl<R: Read> Numbers<R> {
    /// Appends a line with its end.
    fn change(&mut self, line: &[u8]) {
        let (mut start, mut column, mut is_quoted) = (0, 0, false);
        for place in 0..=line.len() {
            let byte = line.get(place).copied();
            is_quoted ^= byte == Some(b'"');
            let is_end = match byte {
                None => true,
                Some(byte) => !is_quoted && (byte == self.separator || byte == b'\r' || byte == b'\n'),
            };
            if is_end {
                self.cell(&line[start..place], column);
                self.changed.extend(byte);
                (start, column) = (place + 1, column + 1);
            }
        }
    }

    fn cell(&mut self, cell: &[u8], column: usize) {
        let wanted = self.units.get(column).copied().flatten();
        let text = wanted.and_then(|_| str::from_utf8(cell).ok());
        let bare = text.map(|text| text.trim().trim_matches('"').trim());
        match bare.and_then(split).filter(|(.., unit)| Some(unit.of_column) == wanted) {
            // Another unit stays, and is refused as no number.
            None => self.changed.extend_from_slice(cell),
            Some((digits, exponent, unit)) => {
                let mark = if digits.as_bytes().contains(&self.separator) { "\"" } else { "" };
                // With the power as exponent, the number is the one that the decimals say.
                let power = match exponent.saturating_add(unit.power) {
                    0 => String::new(),
                    power => format!("e{power}"),
                };
                [mark, digits, &power, mark].iter().for_each(|part| self.changed.extend_from_slice(part.as_bytes()));
            }
        }
    }
}

impl<R: Read> Read for Numbers<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.passed == self.changed.len() {
            self.changed.clear();
            self.passed = 0;
            let mut piece = vec![0; PIECE];
            let count = self.rows.read(&mut piece)?;
            self.line.extend_from_slice(&piece[..count]);
            let whole = if count == 0 { self.line.len() } else { memchr::memrchr(b'\n', &self.line).map_or(0, |at| at + 1) };
            if count == 0 && whole == 0 {
                return Ok(0);
            }
            let rest = self.line.split_off(whole);
            let lines = std::mem::replace(&mut self.line, rest);
            lines.split_inclusive(|byte| *byte == b'\n').for_each(|line| self.change(line));
        }
        let count = buffer.len().min(self.changed.len() - self.passed);
        buffer[..count].copy_from_slice(&self.changed[self.passed..self.passed + count]);
        self.passed += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_files::csv::header;

    fn read(text: &str) -> (String, Vec<String>) {
        let mut header = header::find(text, &mut Vec::new()).unwrap();
        let mut text = without_units(Text::of(text.to_owned()), &mut header);
        let mut rows = text.head.split_off(header.body);
        text.rest.read_to_string(&mut rows).unwrap();
        (rows, header.units)
    }

    #[test]
    fn units_of_cells_become_those_of_their_columns() {
        let text = "t,iq,ud,n,state\n0 ms,0.0244 A,1.2 V,1500 rpm,on\n900 µs,24.4 mA,-120mV,1.5e3 rpm,on\n2 ms,,\"3 V\",2 rpm,off\n";
        let rows = "0e-3,0.0244,1.2,1500,on\n900e-6,24.4e-3,-120e-3,1.5e3,on\n2e-3,,3,2,off\n";
        assert_eq!(read(text), (rows.to_owned(), ["s", "A", "V", "rpm", ""].map(str::to_owned).to_vec()));
        assert_eq!(read("x,iq\n1,0.5 A\n2,5e-02 mA\n").0, "1,0.5\n2,5e-5\n");
        let comma = "x;iq\n1;0,5 A\n2;500 mA\n";
        assert_eq!(read(comma).0, "1;0,5\n2;500e-3\n");
        assert_eq!(read("x,iq\n1,\"0,5 A\"\n2,\"0,7 A\"\n").0, "1,\"0,5\"\n2,\"0,7\"\n");
    }

    #[test]
    fn other_cells_are_left_alone() {
        for text in [
            "t,iq\n0,1\n1,2\n",
            // Times in one unit, two quantities, a unit that the name contradicts, texts.
            "t,iq\n0 ms,1\n1 ms,2\n",
            "t,x\n0,1 A\n1,2 V\n",
            "t,iq [mA]\n0,1 A\n1,2 A\n",
            "t,x\n0,12 apples\n1,A\n",
        ] {
            let body = text.split_once('\n').unwrap().1;
            assert_eq!(read(text).0, body, "{text}");
        }
    }
}

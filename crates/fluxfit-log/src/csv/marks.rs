//! Decimal marks: a table has either decimal points or decimal commas. Otherwise the 1,234 of a file with decimal points would be read
//! as 1.234.

/// The first lines with a decimal point and with a decimal comma; and whether a comma was one for certain.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Marks {
    pub(super) point: Option<u64>,
    pub(super) comma: Option<u64>,
    /// Some number with a comma is none with a thousands separator.
    is_decimal: bool,
}

impl Marks {
    /// Records the decimal mark of a cell, and returns the line of a row with the other mark, if there is one.
    #[inline]
    pub(super) fn conflicting(&mut self, cell: &[u8], line: u64) -> Option<u64> {
        // After the first point only commas matter, and vice versa.
        let has_comma = cell.contains(&b',');
        if has_comma {
            self.comma.get_or_insert(line);
            self.is_decimal = self.is_decimal || !may_be_grouped(cell);
        } else if self.point.is_none() && cell.contains(&b'.') {
            self.point = Some(line);
        }
        let (point, comma) = (self.point?, self.comma?);
        Some(if has_comma { point } else { comma })
    }

    /// Both marks occur.
    pub(super) fn is_mixed(&self) -> bool {
        self.point.is_some() && self.comma.is_some()
    }

    /// The marks of this part of a table and of a later one.
    pub(super) fn and_later(&self, later: &Self) -> Self {
        let is_decimal = self.is_decimal || later.is_decimal;
        Self { point: self.point.or(later.point), comma: self.comma.or(later.comma), is_decimal }
    }

    /// The first line with a comma, if every one may be a thousands separator.
    pub(super) fn unclear_comma(&self) -> Option<u64> {
        self.comma.filter(|_| !self.is_decimal)
    }
}

/// Whether the comma of a number may separate thousands, as in 1,234 or 12,345: three digits after it, and one to three before it that do
/// not begin with 0.
fn may_be_grouped(cell: &[u8]) -> bool {
    let cell = cell.strip_prefix(b"-").unwrap_or(cell);
    let Some(comma) = cell.iter().position(|byte| *byte == b',') else { return false };
    let (whole, thousands) = (&cell[..comma], &cell[comma + 1..]);
    let are_digits = |part: &[u8]| part.iter().all(u8::is_ascii_digit);
    (1..=3).contains(&whole.len()) && whole[0] != b'0' && thousands.len() == 3 && are_digits(whole) && are_digits(thousands)
}

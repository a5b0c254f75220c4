//! Decimal marks: a table has either decimal points or decimal commas. Otherwise the 1,234 of a file with decimal points would be read
//! as 1.234.

/// The first lines with a decimal point and with a decimal comma.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Marks {
    pub(super) point: Option<u64>,
    pub(super) comma: Option<u64>,
}

impl Marks {
    /// Records the decimal mark of a cell, and returns the line of a row with the other mark, if there is one.
    #[inline]
    pub(super) fn conflicting(&mut self, cell: &[u8], line: u64) -> Option<u64> {
        // After the first point only commas matter, and vice versa.
        let has_comma = cell.contains(&b',');
        if has_comma {
            self.comma.get_or_insert(line);
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
        Self { point: self.point.or(later.point), comma: self.comma.or(later.comma) }
    }
}

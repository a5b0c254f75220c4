//! The content of an exported file.

use super::quantity::Quantity;

/// The content of a file: values under the names of the tool, and remarks.
pub(super) struct File {
    pub(super) entries: Vec<Entry>,
    pub(super) remarks: Vec<String>,
}

/// One value of a file.
pub(super) struct Entry {
    /// The name that the tool gives it.
    pub(super) key: &'static str,
    pub(super) value: Value,
    pub(super) unit: &'static str,
    /// What the tool means by it.
    pub(super) meaning: &'static str,
    /// The source for this meaning.
    pub(super) source: &'static str,
}

/// An identified number, or one that was given.
pub(super) enum Value {
    Measured(Quantity),
    Given(f64),
    Count(u32),
}

impl Value {
    /// The number as all tools read it.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Measured(Quantity { value, .. }) | Self::Given(value) => number(*value),
            Self::Count(count) => count.to_string(),
        }
    }
}

/// Significant digits after the first one: enough to identify a single-precision number, which most of these tools store.
const DIGITS: usize = 8;

/// A number as C, XML, MATLAB and moteus read it: with a decimal point or an exponent.
pub(super) fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.DIGITS$e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_have_a_point_or_an_exponent_and_nine_digits() {
        let cases =
            [(3.0, "3.0"), (0.00525, "0.00525"), (2.35e-5, "2.35e-5"), (1.0 / 3.0, "0.333333333"), (-0.012, "-0.012"), (0.0, "0.0")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    proptest! {
        /// Nine digits identify a single-precision number.
        #[test]
        fn a_written_single_precision_number_reads_back_the_same(value in -1e6_f32..1e6) {
            prop_assert_eq!(number(f64::from(value)).parse::<f32>().unwrap(), value);
        }
    }
}

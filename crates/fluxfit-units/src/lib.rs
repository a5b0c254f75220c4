//! Numbers with units: parsing and formatting.
//!
//! ```
//! use fluxfit_units::{Dimension, parse_quantity, significant};
//!
//! assert_eq!(parse_quantity("5.25 mH", Dimension::Inductance)?, 5.25e-3);
//! assert_eq!(significant(0.182713, 3), "0.183");
//! # Ok::<(), fluxfit_units::ValueError>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | [`quantity`] | parsing of numbers with units |
//! | [`mod@unit`] | units that a column of a log may have |
//! | [`argument`] | arguments of the form `key=value` |
//! | [`number`] | formatting of numbers |
//! | [`wording`] | quotations and lists inside a sentence |
//! | [`error`] | why a text could not be read as a value |

pub mod argument;
pub mod error;
pub mod number;
pub mod quantity;
pub mod unit;
pub mod wording;

pub use argument::{key_value, parse_bounds, parse_coefficient, parse_fix, parse_fraction, parse_frequency, parse_prior, parse_window};
pub use error::ValueError;
pub use number::{Scale, format_unknown, significant, small};
pub use quantity::{Dimension, parse_quantity};
pub use unit::Unit;

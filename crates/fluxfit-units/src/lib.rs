//! Numbers with units: as people write them, and as engineers read them.
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
//! | [`quantity`] | numbers with units, as people write them |
//! | [`mod@unit`] | units of a log's columns: given, or named by the header |
//! | [`argument`] | `key=value` arguments |
//! | [`number`] | numbers with units, as people read them |
//! | [`wording`] | quotations and lists inside a sentence |
//! | [`error`] | why a text is no value |

pub mod argument;
pub mod error;
pub mod number;
pub mod quantity;
pub mod unit;
pub mod wording;

pub use argument::{key_value, parse_bounds, parse_fix, parse_frequency, parse_prior, parse_window};
pub use error::ValueError;
pub use number::{Scale, beside_the_motor, significant, small};
pub use quantity::{Dimension, parse_quantity};
pub use unit::Unit;

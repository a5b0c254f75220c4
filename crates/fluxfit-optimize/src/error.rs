//! The only error of this crate: misuse, or a saved search that cannot be read.
//!
//! Each variant carries the values; the sentence is written once, here, and says what to do.

/// What went wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Bounds of different lengths, or none.
    #[error("the search box has {lower} lower and {upper} upper bounds; give as many of each, at least one")]
    BoundsShape {
        /// Lower bounds given.
        lower: usize,
        /// Upper bounds given.
        upper: usize,
    },
    /// Bounds that are not an interval.
    #[error(
        "the search box of dimension {dimension} runs from {lower} to {upper}; both must be finite numbers up to 1e150, the lower below the upper"
    )]
    Bounds {
        /// Dimension, from 0.
        dimension: usize,
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
    /// Box and objective do not match.
    #[error("the search box has {bounds} dimensions, the objective {objective}; give a box of the objective's dimension")]
    Dimension {
        /// Of the box.
        bounds: usize,
        /// Of the objective.
        objective: usize,
    },
    /// Too few candidates for the method's moves.
    #[error("a population of {given} is too small for {method}, which needs at least {least}")]
    Population {
        /// The method.
        method: &'static str,
        /// Candidates asked for.
        given: usize,
        /// Candidates needed.
        least: usize,
    },
    /// A start without any finite cost.
    #[error("none of the {population} candidates of the start has a finite cost; check the objective or narrow the search box")]
    NonFiniteStart {
        /// Candidates tried.
        population: usize,
    },
    /// Another number of costs than candidates that were asked for.
    #[error("{told} costs were told for {asked} candidates; tell one for each, in their order")]
    Told {
        /// Costs told.
        told: usize,
        /// Candidates asked for.
        asked: usize,
    },
    /// A setting outside its range.
    #[error("{setting} is {value}; it must be {range}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Value given.
        value: f64,
        /// Values allowed.
        range: &'static str,
    },
    /// A setting that asks for more memory or time than a machine has.
    #[error("{setting} is {}; it must be at most {}, {reason}", count(*.value), count(*.most))]
    Limit {
        /// Name of the setting, or of a product of settings.
        setting: &'static str,
        /// Value given.
        value: f64,
        /// Largest value allowed.
        most: f64,
        /// What limits it.
        reason: &'static str,
    },
    /// A saved search whose parts do not belong together.
    #[error("the saved search is damaged: the sizes of its parts do not agree; start a new search")]
    SavedSearch,
}

/// A number of things: whole, and large ones with an exponent.
fn count(value: f64) -> String {
    const LONG: f64 = 1e9;
    if value < LONG { format!("{value}") } else { format!("{value:.2e}") }
}

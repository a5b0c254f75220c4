//! Units by which a row of them is told from names.

/// What a row above the names that holds their units has in most of its cells.
pub(super) const UNITS: [&str; 22] = [
    "second", "volt", "ampere", "s", "ms", "us", "v", "mv", "kv", "a", "ma", "ka", "rpm", "krpm", "1/min", "min^-1", "rad/s", "rad", "deg",
    "°", "nm", "hz",
];

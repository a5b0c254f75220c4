//! The figures of a fleet.

mod distributions;
mod drifts;

pub(crate) use distributions::figure as distributions;
pub(crate) use drifts::figure as drifts;

/// Characters of a name beside a point.
const NAME: usize = 14;

/// A motor's name, of a long one the end: files of one directory differ there.
fn short(name: &str) -> String {
    let letters = name.chars().count();
    if letters <= NAME { name.to_owned() } else { format!("…{}", name.chars().skip(letters + 1 - NAME).collect::<String>()) }
}

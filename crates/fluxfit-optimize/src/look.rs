//! How a method's curve looks, the same in every figure and on every terminal.

/// Letter, colours and dashes of a method's curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Draws the curve where there are only characters; no two methods share one.
    pub letter: char,
    /// Number of the terminal's colour, which the user's theme defines: 1 red, 2 green, 3 yellow, 4 blue, 5 magenta, 6 cyan; up to 255.
    pub terminal: u8,
    /// Red, green and blue of sRGB on a white ground.
    pub light: [u8; 3],
    /// Red, green and blue of sRGB on a dark ground.
    pub dark: [u8; 3],
    /// Lengths of dashes and gaps in turn, tenths of a pixel; none: a solid line.
    pub dashes: &'static [u16],
}

//! Colours, and what they stand for.
//!
//! A drawing holds the colours for white paper, as plain attributes that every renderer understands. On a dark screen a rule of
//! CSS per colour gives its counterpart: see [`dark_rules`]. The methods' colours keep apart for all common kinds of colour
//! blindness, and each method has its own dashes as well. Contrast on its ground is at least 4.5 for all but the grid.

use fluxfit::{identify::verdict::Verdict, optimizer::Method};
use plotters::style::RGBColor;

/// What is drawn with a colour of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ink {
    /// Words and markers.
    Text,
    /// Axes and their numbers.
    Axis,
    /// Lines of the grid.
    Grid,
    /// The true value.
    Truth,
    /// The equation along d.
    D,
    /// The equation along q.
    Q,
    /// tGFPA.
    Tgfpa,
    /// FPA.
    Fpa,
    /// LPSO.
    Lpso,
    /// APSO.
    Apso,
    /// Good to 5 %.
    Identified,
    /// Good to 50 %.
    Weak,
    /// Worse.
    NotIdentifiable,
}

impl Ink {
    const ALL: [Self; 13] = [
        Self::Text,
        Self::Axis,
        Self::Grid,
        Self::Truth,
        Self::D,
        Self::Q,
        Self::Tgfpa,
        Self::Fpa,
        Self::Lpso,
        Self::Apso,
        Self::Identified,
        Self::Weak,
        Self::NotIdentifiable,
    ];

    /// The ink of a method's curve.
    pub(crate) fn of_method(method: &Method) -> Self {
        match method {
            Method::Tgfpa(_) => Self::Tgfpa,
            Method::Fpa(_) => Self::Fpa,
            Method::Lpso(_) => Self::Lpso,
            Method::Apso(_) => Self::Apso,
        }
    }

    /// The ink of a verdict.
    pub(crate) fn of_verdict(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Identified => Self::Identified,
            Verdict::Weak => Self::Weak,
            Verdict::NotIdentifiable => Self::NotIdentifiable,
        }
    }

    /// On white, and on dark; no two inks share a colour on white, by which the rules of CSS tell them apart.
    fn colors(self) -> ([u8; 3], [u8; 3]) {
        match self {
            Self::Text => ([0x1b, 0x20, 0x26], [0xe6, 0xe9, 0xec]),
            Self::Axis => ([0x56, 0x5f, 0x69], [0xa6, 0xaf, 0xb9]),
            Self::Grid => ([0xdf, 0xe3, 0xe7], [0x33, 0x3a, 0x42]),
            Self::Truth => ([0x6b, 0x52, 0x1d], [0xe3, 0xc9, 0x7f]),
            Self::D => ([0x00, 0x5a, 0x9c], [0x7c, 0xbd, 0xff]),
            Self::Q => ([0xa8, 0x3c, 0x10], [0xff, 0xa0, 0x7a]),
            Self::Tgfpa => ([0x00, 0x60, 0xa8], [0x6c, 0xb6, 0xff]),
            Self::Fpa => ([0xa8, 0x54, 0x00], [0xff, 0xa6, 0x57]),
            Self::Lpso => ([0x00, 0x6b, 0x4a], [0x4a, 0xd6, 0xa2]),
            Self::Apso => ([0x8a, 0x33, 0x83], [0xe7, 0xa0, 0xde]),
            Self::Identified => ([0x17, 0x6f, 0x38], [0x5f, 0xd0, 0x83]),
            Self::Weak => ([0x8a, 0x5a, 0x00], [0xe8, 0xb8, 0x4a]),
            Self::NotIdentifiable => ([0xb3, 0x26, 0x1e], [0xff, 0x8f, 0x85]),
        }
    }

    /// The colour to draw with.
    pub(super) fn color(self) -> RGBColor {
        let ([r, g, b], _) = self.colors();
        RGBColor(r, g, b)
    }

    /// Dashes and gaps, in tenths of a pixel; none: a solid line.
    fn dashes(self) -> Option<&'static str> {
        match self {
            Self::Fpa => Some("75 40"),
            Self::Lpso => Some("20 30"),
            Self::Apso => Some("100 35 20 35"),
            Self::Truth => Some("40 30"),
            _ => None,
        }
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Rules that give every colour its counterpart on a dark ground. They outrank the attributes that they select.
pub(crate) fn dark_rules() -> String {
    let rules = Ink::ALL.map(|ink| {
        let (light, dark) = ink.colors();
        let (light, dark) = (hex(light), hex(dark));
        format!("svg [fill=\"{light}\"]{{fill:{dark}}}svg [stroke=\"{light}\"]{{stroke:{dark}}}\n")
    });
    rules.concat()
}

/// Gives the strokes of a drawing their dashes; the drawing library has none.
pub(super) fn dashed(mut svg: String) -> String {
    for ink in Ink::ALL {
        if let Some(dashes) = ink.dashes() {
            let stroke = format!("stroke=\"{}\"", hex(ink.colors().0));
            svg = svg.replace(&stroke, &format!("{stroke} stroke-dasharray=\"{dashes}\""));
        }
    }
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance and contrast of WCAG 2.2.
    fn contrast(one: [u8; 3], other: [u8; 3]) -> f64 {
        let luminance = |color: [u8; 3]| {
            let [r, g, b] = color.map(|channel| {
                let c = f64::from(channel) / 255.0;
                if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
            });
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn every_ink_but_the_grid_can_be_read_on_both_grounds() {
        for ink in Ink::ALL.into_iter().filter(|ink| *ink != Ink::Grid) {
            let (light, dark) = ink.colors();
            // The page's grounds, and what GitHub puts behind a picture.
            for ground in [[0xff, 0xff, 0xff], [0xf6, 0xf8, 0xfa]] {
                assert!(contrast(light, ground) >= 4.5, "{ink:?} on {ground:?}: {}", contrast(light, ground));
            }
            for ground in [[0x14, 0x18, 0x1d], [0x0d, 0x11, 0x17], [0x1d, 0x23, 0x2a]] {
                assert!(contrast(dark, ground) >= 4.5, "{ink:?} on {ground:?}: {}", contrast(dark, ground));
            }
        }
    }

    #[test]
    fn no_two_inks_share_a_colour() {
        for (k, one) in Ink::ALL.iter().enumerate() {
            assert!(Ink::ALL[..k].iter().all(|other| other.colors().0 != one.colors().0), "{one:?}");
        }
    }
}

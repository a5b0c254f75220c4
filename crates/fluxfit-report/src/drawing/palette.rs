//! The colours and their meaning.
//!
//! A drawing has the colours for white paper as plain attributes, which every renderer supports. On a dark screen a CSS rule per colour
//! replaces it: see [`dark_rules`]. The colours of the paper's four methods can be distinguished with all common kinds of colour
//! blindness, and every method has dashes of its own (tested): no eye tells twenty-two colours apart. The contrast with the background
//! is at least 4.5 for all but the grid (tested).

use fluxfit::{
    Verdict,
    optimizer::{Look, METHODS, Method},
};
use plotters::style::RGBColor;

/// What has a colour of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ink {
    /// Text and markers.
    Text,
    /// Axes and their numbers.
    Axis,
    /// Lines of the grid.
    Grid,
    /// The true value.
    Truth,
    /// The d axis.
    D,
    /// The q axis.
    Q,
    /// The curve of a method, with the colours of the table of methods.
    Curve(Look),
    /// Verdict: identified.
    Identified,
    /// Verdict: weak.
    Weak,
    /// Verdict: not identifiable.
    NotIdentifiable,
}

impl Ink {
    /// All inks, including those of all methods.
    fn all() -> impl Iterator<Item = Self> {
        let drawing = [Self::Text, Self::Axis, Self::Grid, Self::Truth, Self::D, Self::Q];
        let verdicts = [Self::Identified, Self::Weak, Self::NotIdentifiable];
        drawing.into_iter().chain(Self::curves()).chain(verdicts)
    }

    /// The inks of the methods' curves.
    fn curves() -> impl Iterator<Item = Self> {
        METHODS.iter().map(|facts| Self::Curve(facts.look))
    }

    /// The ink of a method's curve.
    pub(crate) fn of_method(method: &Method) -> Self {
        Self::Curve(method.facts().look)
    }

    /// The ink of a verdict.
    pub(crate) fn of_verdict(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Identified => Self::Identified,
            Verdict::Weak => Self::Weak,
            Verdict::NotIdentifiable => Self::NotIdentifiable,
        }
    }

    /// Colours on white and on dark backgrounds. No two inks have the same colour on white, because the CSS rules select by it.
    fn colors(self) -> ([u8; 3], [u8; 3]) {
        match self {
            Self::Text => ([0x1b, 0x20, 0x26], [0xe6, 0xe9, 0xec]),
            Self::Axis => ([0x56, 0x5f, 0x69], [0xa6, 0xaf, 0xb9]),
            Self::Grid => ([0xdf, 0xe3, 0xe7], [0x33, 0x3a, 0x42]),
            Self::Truth => ([0x6b, 0x52, 0x1d], [0xe3, 0xc9, 0x7f]),
            Self::D => ([0x00, 0x5a, 0x9c], [0x7c, 0xbd, 0xff]),
            Self::Q => ([0xa8, 0x3c, 0x10], [0xff, 0xa0, 0x7a]),
            Self::Curve(look) => (look.light, look.dark),
            Self::Identified => ([0x17, 0x6f, 0x38], [0x5f, 0xd0, 0x83]),
            Self::Weak => ([0x8a, 0x5a, 0x00], [0xe8, 0xb8, 0x4a]),
            Self::NotIdentifiable => ([0xb3, 0x26, 0x1e], [0xff, 0x8f, 0x85]),
        }
    }

    /// The colour on white.
    pub(crate) fn color(self) -> RGBColor {
        let ([r, g, b], _) = self.colors();
        RGBColor(r, g, b)
    }

    /// The colours on white and on dark backgrounds, for CSS.
    pub(crate) fn css_colors(self) -> [String; 2] {
        let (light, dark) = self.colors();
        [hex(light), hex(dark)]
    }

    /// Lengths of dashes and gaps, pixels; empty for a solid line.
    pub(crate) fn dashes_in_pixels(self) -> Vec<f64> {
        self.dashes().iter().map(|tenths| f64::from(*tenths) / 10.0).collect()
    }

    /// Lengths of dashes and gaps, tenths of a pixel; empty for a solid line.
    fn dashes(self) -> &'static [u16] {
        match self {
            Self::Curve(look) => look.dashes,
            Self::Truth => &[40, 30],
            _ => &[],
        }
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// CSS rules that replace every colour on a dark background. They have precedence over the attributes that they select.
pub(crate) fn dark_rules() -> String {
    let rule = |ink: Ink| {
        let [light, dark] = ink.css_colors();
        format!("svg [fill=\"{light}\"]{{fill:{dark}}}svg [stroke=\"{light}\"]{{stroke:{dark}}}\n")
    };
    Ink::all().map(rule).collect()
}

/// Adds dashes to the strokes of a drawing; the drawing library has none.
pub(crate) fn dashed(mut svg: String) -> String {
    for ink in Ink::all() {
        let dashes: Vec<String> = ink.dashes().iter().map(u16::to_string).collect();
        if !dashes.is_empty() {
            let stroke = format!("stroke=\"{}\"", hex(ink.colors().0));
            svg = svg.replace(&stroke, &format!("{stroke} stroke-dasharray=\"{}\"", dashes.join(" ")));
        }
    }
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear intensity of an sRGB channel, 0 to 1.
    fn linear(channel: u8) -> f64 {
        let c = f64::from(channel) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }

    /// Relative luminance and contrast of WCAG 2.2.
    fn contrast(one: [u8; 3], other: [u8; 3]) -> f64 {
        let luminance = |color: [u8; 3]| {
            let [r, g, b] = color.map(linear);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn every_ink_but_the_grid_has_enough_contrast() {
        for ink in Ink::all().filter(|ink| *ink != Ink::Grid) {
            let (light, dark) = ink.colors();
            // The backgrounds of the page and of GitHub.
            for ground in [[0xff, 0xff, 0xff], [0xf6, 0xf8, 0xfa]] {
                assert!(contrast(light, ground) >= 4.5, "{ink:?} on {ground:?}: {}", contrast(light, ground));
            }
            for ground in [[0x14, 0x18, 0x1d], [0x0d, 0x11, 0x17], [0x1d, 0x23, 0x2a]] {
                assert!(contrast(dark, ground) >= 4.5, "{ink:?} on {ground:?}: {}", contrast(dark, ground));
            }
        }
    }

    /// Linear red, green and blue as seen without one kind of cone: none, red, green, blue missing. G. M. Machado, M. M.
    /// Oliveira and L. A. F. Fernandes, "A physiologically-based model for simulation of color vision deficiency", 2009.
    const EYES: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    /// CIELAB, white D65.
    fn lab(color: [u8; 3], eye: &[[f64; 3]; 3]) -> [f64; 3] {
        let rgb = color.map(linear);
        let [r, g, b] = eye.map(|row| row.iter().zip(rgb).map(|(weight, c)| weight * c).sum::<f64>().clamp(0.0, 1.0));
        let f = |t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
        let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
        let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn the_colours_of_the_papers_methods_differ_for_every_eye_and_the_dashes_of_all() {
        let all: Vec<Ink> = Ink::curves().collect();
        for (k, one) in all.iter().enumerate() {
            assert!(all[..k].iter().all(|other| other.dashes() != one.dashes()), "{one:?}");
        }
        let methods = fluxfit::paper::METHODS.map(|method| Ink::of_method(&method));
        for (eye, (k, one)) in EYES.iter().flat_map(|eye| methods.iter().enumerate().map(move |one| (eye, one))) {
            for other in &methods[..k] {
                for ground in [|ink: &Ink| ink.colors().0, |ink: &Ink| ink.colors().1] {
                    let (a, b) = (lab(ground(one), eye), lab(ground(other), eye));
                    let distance = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                    assert!(distance > 20.0, "{one:?} and {other:?} are {distance} apart");
                }
            }
        }
    }

    #[test]
    fn all_inks_have_different_colours() {
        let inks: Vec<Ink> = Ink::all().collect();
        for (k, one) in inks.iter().enumerate() {
            assert!(inks[..k].iter().all(|other| other.colors().0 != one.colors().0), "{one:?}");
        }
    }
}

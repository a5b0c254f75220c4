//! A figure of a page: its drawing, the data of its interactive plot, its caption and its place.

use crate::{
    drawing::{canvas::Drawing, size::Size},
    interactive::PlotData,
};
use maud::{Markup, html};

/// A figure.
pub(crate) struct Figure<'a> {
    /// Name of its files without extension; always the same for the same figure.
    pub(crate) name: &'static str,
    /// Anchor of the section that it follows.
    pub(crate) section: &'static str,
    /// Draws it in one size.
    pub(crate) draw: Box<dyn Fn(Size) -> Drawing + 'a>,
    /// Computes the data of its interactive plot; `None` if it has none.
    pub(crate) data: Option<Box<dyn Fn() -> PlotData + 'a>>,
    pub(crate) caption: Markup,
}

impl Figure<'_> {
    /// The figure in both sizes, of which the style sheet shows one, with its data and caption.
    pub(crate) fn element(&self) -> Markup {
        html! {
            figure {
                ((self.draw)(Size::Wide).inline("wide"))
                ((self.draw)(Size::Narrow).inline("narrow"))
                @if let Some(data) = &self.data { (data().element()) }
                figcaption { (self.caption) }
            }
        }
    }
}

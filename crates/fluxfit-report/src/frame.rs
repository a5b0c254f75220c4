//! What stands around figures and tables: a caption and two sizes; a box that scrolls where the page must not.

use crate::figure::{Size, canvas::Drawing};
use maud::{Markup, html};

/// A figure in both sizes, of which the style shows one, with its caption.
pub(crate) fn figure(draw: impl Fn(Size) -> Drawing, caption: &Markup) -> Markup {
    html! {
        figure {
            (draw(Size::Wide).inline("wide"))
            (draw(Size::Narrow).inline("narrow"))
            figcaption { (caption) }
        }
    }
}

/// A table in its box, which the keyboard reaches; `name` is read out.
pub(crate) fn scrolling(name: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(name) tabindex="0" { (table) } }
}

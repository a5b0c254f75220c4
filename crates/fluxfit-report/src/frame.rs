//! What stands around figures and tables: a caption and two sizes; a box that scrolls where the page must not.

use crate::{
    figure::{Size, canvas::Drawing},
    interactive::Live,
};
use maud::{Markup, html};

/// A figure in both sizes, of which the style shows one, with its caption.
pub(crate) fn figure(draw: impl Fn(Size) -> Drawing, caption: &Markup) -> Markup {
    with_data(draw, caption, None)
}

/// The same with its numbers, for the pointer.
pub(crate) fn live_figure(draw: impl Fn(Size) -> Drawing, live: &Live, caption: &Markup) -> Markup {
    with_data(draw, caption, Some(live))
}

fn with_data(draw: impl Fn(Size) -> Drawing, caption: &Markup, live: Option<&Live>) -> Markup {
    html! {
        figure {
            (draw(Size::Wide).inline("wide"))
            (draw(Size::Narrow).inline("narrow"))
            @if let Some(live) = live { (live.data()) }
            figcaption { (caption) }
        }
    }
}

/// A table in its box, which the keyboard reaches; `name` is read out.
pub(crate) fn scrolling(name: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(name) tabindex="0" { (table) } }
}

//! The frame of a table.

use crate::typography::prose;
use maud::{Markup, html};

/// A table in a box that scrolls horizontally and can be reached with the keyboard; `name` is its accessible name.
pub(crate) fn scrolling(name: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(name) tabindex="0" { (table) } }
}

/// What a value is, for a narrow screen, where the rows of a table of the class `stacked` have no columns.
pub(crate) fn key(text: &str) -> Markup {
    html! { span.key { (text) } }
}

/// The same of a symbol.
pub(crate) fn named(symbol: &str) -> Markup {
    html! { span.key { (prose(symbol)) " " } }
}

//! The frame of a table.

use maud::{Markup, html};

/// A table in a box that scrolls horizontally and can be reached with the keyboard; `name` is its accessible name.
pub(crate) fn scrolling(name: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(name) tabindex="0" { (table) } }
}

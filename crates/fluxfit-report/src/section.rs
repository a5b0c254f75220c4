//! A section of a page.

use maud::Markup;

/// A section; figures that name its anchor follow its content.
pub(crate) struct Section {
    /// Identifier of the section in the page.
    pub(crate) anchor: &'static str,
    pub(crate) heading: &'static str,
    pub(crate) content: Markup,
}

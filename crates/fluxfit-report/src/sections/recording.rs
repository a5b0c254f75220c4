//! The log as it was recorded: the place of its figure.

use crate::{report::Report, section::Section};
use maud::html;

/// The section.
pub(crate) fn section(_: &Report) -> Option<Section> {
    Some(Section { anchor: "recording", heading: "The log, and what was used of it", content: html! {} })
}

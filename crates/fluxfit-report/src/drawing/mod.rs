//! What all figures are drawn with: axes, plots, colours, and the conversion to SVG.

pub(crate) mod axis;
pub(crate) mod canvas;
pub(crate) mod decimation;
pub(crate) mod labels;
pub(crate) mod palette;
pub(crate) mod plot;
pub(crate) mod size;

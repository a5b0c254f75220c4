//! The two widths for which every figure is drawn.

/// Width for which a figure is drawn. Text has the same size in both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// A page or a wide screen: 720 pixels.
    Wide,
    /// A telephone: 320 pixels.
    Narrow,
}

impl Size {
    /// Width, pixels.
    pub(crate) fn width(self) -> u32 {
        self.pick(720, 320)
    }

    /// One of two values: that of the wide or that of the narrow drawing.
    pub(crate) fn pick<T>(self, wide: T, narrow: T) -> T {
        match self {
            Self::Wide => wide,
            Self::Narrow => narrow,
        }
    }
}

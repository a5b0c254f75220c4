//! The motor as a test bench sees it.

/// A motor as its shaft turns it: inductances and flux times the pole pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Machine {
    /// ohm.
    pub(super) rs: f64,
    /// H.
    pub(super) p_ld: f64,
    /// H.
    pub(super) p_lq: f64,
    /// Wb.
    pub(super) p_psi_f: f64,
}

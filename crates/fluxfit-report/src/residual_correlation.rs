//! Autocorrelation of the residuals, for the test whether they are white noise.

use fluxfit::evidence::OutputFit;

/// Largest lag, rows.
const MAX_LAG: usize = 50;

/// Fewest rows per lag.
const ROWS_PER_LAG: usize = 4;

/// Half-width of the 95 % band of white noise, in standard errors of a correlation.
const HALF_WIDTH: f64 = 2.0;

/// Autocorrelation of the residuals.
pub(crate) struct ResidualCorrelation {
    /// Of the d and the q axis, from lag one on.
    pub(crate) axes: [Vec<f64>; 2],
    /// Half-width of the band in which 95 % of the correlations of white noise lie.
    pub(crate) band: f64,
}

impl ResidualCorrelation {
    pub(crate) fn of(fit: &OutputFit) -> Self {
        let rows = fit.residuals.len() / 2;
        let lags = MAX_LAG.min(rows / ROWS_PER_LAG).max(1);
        Self { axes: fit.autocorrelation(lags), band: HALF_WIDTH / (rows.max(1) as f64).sqrt() }
    }

    /// Number of lags.
    pub(crate) fn lags(&self) -> usize {
        self.axes[0].len()
    }
}

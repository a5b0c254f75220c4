//! Blocks: short pieces of a log whose means decide what is steady, and the tolerances within which means agree.

use crate::log::Log;
use std::ops::Range;

/// Rows per block: a five-hundredth of the log within these limits. Short against a steady stretch, long against the noise's correlation.
pub(super) const BLOCK_ROWS: (usize, usize) = (10, 500);

/// Means agree within this fraction of the log's largest value. The equations of the means hold while currents drift; this excludes
/// transients, which sampling and filters distort.
pub(super) const TOLERANCE: f64 = 0.01;

/// The currents of a window's halves agree within this fraction: half of what its blocks may differ.
pub(super) const HALVES_TOLERANCE: f64 = 0.005;

/// Means agree within this many standard deviations of their difference.
pub(super) const NOISE_FACTOR: f64 = 4.0;

/// Currents below this fraction of the log's largest carry no information, and may belong to a drive that is not switching.
pub(super) const MIN_CURRENT: f64 = 0.01;

/// The log's largest current (A) and speed (rad/s): i_d, i_q, omega_e.
pub(super) struct Scale(pub(super) [f64; 3]);

impl Scale {
    pub(super) fn of(log: &Log) -> Self {
        let speed = log.columns().omega_e.iter().fold(0.0_f64, |most, omega| most.max(omega.abs()));
        Self([log.peak_current(), log.peak_current(), speed])
    }

    /// Whether two triples of means agree, given the variance of their differences. Speed may always move by [`TOLERANCE`]: its
    /// slope is not in the equations.
    pub(super) fn agree(&self, current_tolerance: f64, one: &[f64; 3], other: &[f64; 3], variance: &[f64; 3]) -> bool {
        let tolerances = [current_tolerance, current_tolerance, TOLERANCE];
        (0..3).all(|c| (one[c] - other[c]).abs() <= tolerances[c] * self.0[c] + NOISE_FACTOR * variance[c].sqrt())
    }
}

/// Means over consecutive rows.
pub(super) struct Block {
    pub(super) rows: Range<usize>,
    /// Means of i_d, i_q, omega_e.
    pub(super) means: [f64; 3],
    /// Variances of those means, if their noise is white.
    pub(super) variances: [f64; 3],
}

impl Block {
    pub(super) fn of(log: &Log, rows: Range<usize>) -> Self {
        let columns = log.columns();
        let n = rows.len() as f64;
        let channels = [&columns.id, &columns.iq, &columns.omega_e].map(|column| &column[rows.clone()]);
        let means = channels.map(|values| values.iter().sum::<f64>() / n);
        // From differences of neighbours: a slope in the block does not count as noise.
        let variances =
            channels.map(|values| values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / (2.0 * (n - 1.0)) / n);
        Self { rows, means, variances }
    }

    /// The block, if it is steady and carries current.
    pub(super) fn steady(log: &Log, rows: Range<usize>, scale: &Scale) -> Option<Self> {
        let block = Self::of(log, rows);
        let middle = block.rows.start.midpoint(block.rows.end);
        let (first, second) = (Self::of(log, block.rows.start..middle), Self::of(log, middle..block.rows.end));
        let variance: [f64; 3] = std::array::from_fn(|c| first.variances[c] + second.variances[c]);
        let carries_current = block.means[0].hypot(block.means[1]) >= MIN_CURRENT * scale.0[0];
        (carries_current && scale.agree(TOLERANCE, &first.means, &second.means, &variance)).then_some(block)
    }
}

/// Mean of the blocks' means.
pub(super) fn mean_of(blocks: &[Block]) -> [f64; 3] {
    std::array::from_fn(|c| blocks.iter().map(|block| block.means[c]).sum::<f64>() / blocks.len() as f64)
}

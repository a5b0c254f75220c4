//! The covariance of a sum of correlated vectors: what a least-squares answer's scores add up to.
//!
//! ```text
//! S = sum over lags k of w_k (Gamma_k + Gamma_k'),   w_k = 1 - k / (M + 1),   Gamma_k = sum over rows of s_row s_(row-k)'
//! ```
//!
//! with Bartlett's weights and the lag `M` that minimizes the error if the scores were autoregressive of first order. W. K. Newey and
//! K. D. West, Econometrica 55 (1987) 703, doi:10.2307/1913610; D. W. K. Andrews, Econometrica 59 (1991) 817, doi:10.2307/2938229,
//! equations (5.1), (6.2) and (6.4). No lag reaches across a gap.

use crate::{motor::PARAMETERS, normal_matrix::dot};
use nalgebra::DMatrix;

/// Beyond this correlation of neighbours the series is a trend, and no lag is long enough.
const MOST_CORRELATED: f64 = 0.99;

/// Constant of Bartlett's optimal lag, Andrews (6.2).
const BARTLETT: f64 = 1.1447;

/// Degrees of freedom of Bartlett's estimate are 3 n / M. M. B. Priestley, Spectral Analysis and Time Series, 1981, table 6.2.
const DEGREES: f64 = 3.0;

/// A covariance, and how well it is known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LongRun {
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) degrees_of_freedom: f64,
}

/// The covariance of the sum of these scores: a column per component, `lengths` of the stretches one after the other.
pub(crate) fn covariance(scores: &[Vec<f64>], lengths: &[usize]) -> LongRun {
    let (n, size) = (scores.first().map_or(0, Vec::len), scores.len());
    let lag = bandwidth(scores, lengths).min(n.saturating_sub(1) as f64);
    let mut covariance = DMatrix::zeros(size, size);
    for shift in 0..=lag as usize {
        let weight = 1.0 - shift as f64 / (lag + 1.0);
        for p in 0..size {
            for q in 0..=p {
                let pair = if shift == 0 {
                    products(&scores[p], &scores[q], 0, lengths)
                } else {
                    products(&scores[p], &scores[q], shift, lengths) + products(&scores[q], &scores[p], shift, lengths)
                };
                covariance[(p, q)] += weight * pair;
            }
        }
    }
    covariance.fill_upper_triangle_with_lower_triangle();
    LongRun { covariance, degrees_of_freedom: DEGREES * n as f64 / (lag + 1.0) }
}

/// Blocks of rows for residuals that are not noise: long enough that a block sees one part of the bench's work, and enough of them to
/// estimate a variance (`t` of 15 degrees of freedom is 2.13).
const BLOCKS: usize = 16;

/// The same of scores whose residuals are not noise but what the model lacks: how much consecutive blocks of the log pull in different
/// directions, whatever the correlation within them. R. Ibragimov and U. K. Müller, "t-statistic based correlation and heterogeneity robust
/// inference", Journal of Business & Economic Statistics 28 (2010) 453, doi:10.1198/jbes.2009.08046, on why few blocks will do.
pub(crate) fn covariance_of_blocks(scores: &[Vec<f64>]) -> LongRun {
    let (n, size) = (scores.first().map_or(0, Vec::len), scores.len());
    let blocks = BLOCKS.min(n).max(2);
    let sums: Vec<Vec<f64>> = scores
        .iter()
        .map(|score| (0..blocks).map(|block| score[block * n / blocks..(block + 1) * n / blocks].iter().sum()).collect())
        .collect();
    let free = (blocks - 1) as f64;
    let covariance =
        DMatrix::from_fn(size, size, |p, q| sums[p].iter().zip(&sums[q]).map(|(a, b)| a * b).sum::<f64>() * blocks as f64 / free);
    LongRun { covariance, degrees_of_freedom: free }
}

fn products(one: &[f64], other: &[f64], shift: usize, lengths: &[usize]) -> f64 {
    let mut start = 0;
    let mut sum = 0.0;
    for length in lengths {
        let rows = start..start + length;
        if *length > shift {
            sum += dot(&one[rows.start + shift..rows.end], &other[rows.start..rows.end - shift]);
        }
        start += length;
    }
    sum
}

/// Andrews' plug-in lag; each component counts with the inverse of its variance.
fn bandwidth(scores: &[Vec<f64>], lengths: &[usize]) -> f64 {
    let n = scores.first().map_or(0, Vec::len) as f64;
    let (mut above, mut below) = (0.0, 0.0);
    for score in scores {
        let rho = first_correlation(score, lengths);
        above += 4.0 * rho * rho / ((1.0 - rho).powi(6) * (1.0 + rho).powi(2)) * (1.0 - rho * rho).powi(2);
        below += (1.0 - rho * rho).powi(2) / (1.0 - rho).powi(4);
    }
    if below > 0.0 { BARTLETT * (above / below * n).cbrt() } else { 0.0 }
}

/// Correlation of neighbours.
pub(crate) fn first_correlation(series: &[f64], lengths: &[usize]) -> f64 {
    correlation(series, 1, lengths).clamp(-MOST_CORRELATED, MOST_CORRELATED)
}

/// Correlation, about zero, of values this many rows apart; zero of a series that is nothing but zeros.
pub(crate) fn correlation(series: &[f64], shift: usize, lengths: &[usize]) -> f64 {
    let own = products(series, series, 0, lengths);
    if own > 0.0 { products(series, series, shift, lengths) / own } else { 0.0 }
}

/// How many independent numbers the residuals of both axes are worth, `d, q` of each row in turn: fewer, the more neighbouring rows are
/// correlated. Of an autoregressive series of first order it is `n (1 - rho) / (1 + rho)`.
pub(crate) fn effective_sample_size(residuals: &[f64]) -> f64 {
    let (rows, _) = residuals.as_chunks::<2>();
    let axis = |axis: usize| {
        let series: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
        let rho = first_correlation(&series, &[series.len()]).max(0.0);
        series.len() as f64 * (1.0 - rho) / (1.0 + rho)
    };
    (axis(0) + axis(1)).max(2.0 * PARAMETERS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::Draws;

    /// AR(1) with unit innovations: the variance of the sum goes to n / (1 - rho)².
    #[test]
    fn the_covariance_is_that_of_the_process() {
        const RUNS: u32 = 200;
        const ROWS: usize = 4000;
        for (rho, low) in [(0.0, 0.97), (0.5, 0.93), (0.9, 0.88)] {
            let mut draws = Draws::seeded(5, 0);
            let mut sum = 0.0;
            for _ in 0..RUNS {
                let mut x = 0.0;
                let mut next = || {
                    x = rho * x + draws.normal();
                    x
                };
                let series: Vec<f64> = (0..ROWS).map(|_| next()).collect();
                sum += covariance(&[series], &[ROWS]).covariance[(0, 0)] / f64::from(RUNS);
            }
            let expected = ROWS as f64 / (1.0_f64 - rho).powi(2);
            // Bartlett's weights leave out a part of the correlation, the more of it there is; the mean of the runs is sharp to 2 %.
            assert!((low..1.03).contains(&(sum / expected)), "rho {rho}: {}", sum / expected);
        }
    }

    #[test]
    fn no_lag_reaches_across_a_gap() {
        let ones = [1.0; 4];
        assert_eq!(products(&ones, &ones, 1, &[4]), 3.0);
        assert_eq!(products(&ones, &ones, 1, &[2, 2]), 2.0);
        assert_eq!(products(&ones, &ones, 2, &[2, 2]), 0.0);
    }

    #[test]
    fn nothing_has_no_variance() {
        let none = covariance(&[vec![0.0; 20]], &[20]);
        assert!(none.covariance[(0, 0)] == 0.0 && none.degrees_of_freedom.is_finite());
    }
}

//! Variance of the mean of autocorrelated samples.
//!
//! `var(mean) = S(0) / n` with `S(0)` the series' spectral density at zero frequency (the long-run variance), which differs from the
//! plain variance by a factor of hundreds on a real log. Here `S(0)` is the average of the squared projections on the first `B`
//! cosines that fit the window (equal-weighted cosine transform). It is positive semidefinite for any number of series at once, linear
//! in them, and its distribution is known: `mean / sqrt(S/n)` is Student's t with `B` degrees of freedom. E. Lazarus, D. J. Lewis,
//! J. H. Stock and M. W. Watson, "HAR inference: recommendations for practice", Journal of Business & Economic Statistics 36 (2018)
//! 541, doi:10.1080/07350015.2018.1506926.
//!
//! `B` follows from the lag-one autocorrelation `rho`. The spectrum of a first-order autoregressive series falls with frequency;
//! averaged over the first `B` cosines it is too small by `(pi B / (n (1 - rho)))² rho / 3`. `B` is the largest number that keeps this
//! under 5 %, but at least 3; the remaining bias of a window of few correlation times is divided out with the formula of that spectrum.

/// Largest accepted relative bias of the variance from the fall of the spectrum: 5 % of the variance are 2.5 % of the standard error.
const MAX_BIAS: f64 = 0.05;

/// Most cosines. More would narrow the intervals by 5 % at best, and include frequencies at which the current controller shapes the noise.
const MAX_COSINES: usize = 12;

/// Fewest cosines: with three degrees of freedom an interval is 1.5 times as wide as with twelve, and still has its coverage.
pub const MIN_COSINES: usize = 3;

/// Number of cosines for a lag-one autocorrelation.
pub(super) fn cosines_for(rho: f64, rows: usize) -> usize {
    if rho <= 0.0 {
        return MAX_COSINES;
    }
    let most = rows as f64 * (1.0 - rho) / std::f64::consts::PI * (3.0 * MAX_BIAS / rho).sqrt();
    // The conversion saturates.
    (most as usize).clamp(MIN_COSINES, MAX_COSINES)
}

/// Lag-one autocorrelation, with the first-order correction of its bias, `(1 + 3 rho)/n`: M. G. Kendall, Biometrika 41 (1954) 403,
/// doi:10.1093/biomet/41.3-4.403. At most `1 - 1/n`: the longest correlation time that can be seen in a window is its length.
pub(super) fn lag_one_autocorrelation(series: &[f64]) -> f64 {
    let n = series.len() as f64;
    let mean = series.iter().sum::<f64>() / n;
    let power: f64 = series.iter().map(|x| (x - mean).powi(2)).sum();
    if power <= 0.0 {
        return 0.0;
    }
    let lagged: f64 = series.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    let rho = lagged / power;
    (rho + (1.0 + 3.0 * rho) / n).min(1.0 - 1.0 / n)
}

/// Spectrum of a first-order autoregressive series, averaged over the first cosines of a window, as a fraction of that at zero frequency.
fn spectrum_fraction(rho: f64, rows: usize, cosines: usize) -> f64 {
    if rho <= 0.0 {
        return 1.0;
    }
    let at = |j: usize| {
        let cos = (j as f64 * std::f64::consts::PI / rows as f64).cos();
        (1.0 - rho).powi(2) / (1.0 - 2.0 * rho * cos + rho * rho)
    };
    (1..=cosines).map(at).sum::<f64>() / cosines as f64
}

/// Variance of the mean of a few consecutive samples of a long series: `sigma²/m (1 + 2 sum over k of (1 - k/m) rho^k)`.
pub(super) fn variance_of_short_mean(series: &[f64], rows: usize) -> f64 {
    let n = series.len() as f64;
    let mean = series.iter().sum::<f64>() / n;
    let variance = series.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    let rho = lag_one_autocorrelation(series).max(0.0);
    let m = rows as f64;
    let neighbours: f64 = (1..rows).map(|k| (1.0 - k as f64 / m) * rho.powi(k as i32)).sum();
    variance / m * (1.0 + 2.0 * neighbours)
}

/// Projections of `C` series, given row by row, on the first cosines of their length.
pub(super) struct CosineTransform<const C: usize> {
    rows: usize,
    /// For each cosine `j`: cos(j pi (k + 1/2) / n) of this row and the one before, and 2 cos(j pi / n), the factor of the recurrence.
    waves: Vec<[f64; 3]>,
    sums: Vec<[f64; C]>,
}

impl<const C: usize> CosineTransform<C> {
    pub(super) fn new(rows: usize, cosines: usize) -> Self {
        let waves = (1..=cosines).map(|j| {
            let step = j as f64 * std::f64::consts::PI / rows as f64;
            // The row before the first is half a step on the other side of zero, where the cosine is the same.
            [(0.5 * step).cos(), (0.5 * step).cos(), 2.0 * step.cos()]
        });
        Self { rows, waves: waves.collect(), sums: vec![[0.0; C]; cosines] }
    }

    /// Adds the next row, its means subtracted.
    pub(super) fn push(&mut self, row: &[f64; C]) {
        for ([now, before, step], sums) in self.waves.iter_mut().zip(&mut self.sums) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += *now * value;
            }
            (*now, *before) = (*step * *now - *before, *now);
        }
    }

    /// Covariance of the `C` means, if the noise has this lag-one autocorrelation.
    pub(super) fn covariance_of_mean(&self, rho: f64) -> [[f64; C]; C] {
        let n = self.rows as f64;
        // sqrt(2/n) normalizes each cosine; a second 1/n turns the long-run variance into that of the mean.
        let scale = 2.0 / n / n / self.sums.len() as f64 / spectrum_fraction(rho, self.rows, self.sums.len());
        let mut covariance = [[0.0; C]; C];
        for sums in &self.sums {
            for (row, one) in covariance.iter_mut().zip(sums) {
                for (entry, other) in row.iter_mut().zip(sums) {
                    *entry += scale * one * other;
                }
            }
        }
        covariance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::Draws;

    fn ar1(rho: f64, n: usize, draws: &mut Draws) -> Vec<f64> {
        let mut x = draws.normal() / (1.0 - rho * rho).sqrt();
        let mut next = || {
            x = rho * x + draws.normal();
            x
        };
        (0..n).map(|_| next()).collect()
    }

    fn variance_of_mean(series: &[f64]) -> f64 {
        let rho = lag_one_autocorrelation(series);
        let cosines = cosines_for(rho, series.len());
        let mean = series.iter().sum::<f64>() / series.len() as f64;
        let mut transform = CosineTransform::<1>::new(series.len(), cosines);
        series.iter().for_each(|x| transform.push(&[x - mean]));
        transform.covariance_of_mean(rho)[0][0]
    }

    #[test]
    fn the_variance_matches_the_process() {
        // AR(1) with unit innovations: n var(mean) -> 1/(1-rho)², so 1, 4 and 400.
        for (rho, tolerance) in [(0.0, 0.05), (0.5, 0.06), (0.95, 0.11)] {
            let mut draws = Draws::seeded(11, 0);
            let runs = 2000;
            let n = 1151;
            let mut total = 0.0;
            for _ in 0..runs {
                let series = ar1(rho, n, &mut draws);
                total += variance_of_mean(&series) * n as f64 / f64::from(runs);
            }
            let expected = 1.0 / (1.0 - rho).powi(2);
            // The bias is up to 5 % by design, and for 0.95 a second one of the same size comes from the ends of the window; the standard
            // error of the mean over 2000 runs is 1 %.
            assert!((total / expected - 1.0).abs() < tolerance, "rho {rho}: {total} against {expected}");
        }
    }

    #[test]
    fn the_recurrence_matches_the_cosine() {
        let n = 100_000;
        let mut transform = CosineTransform::<1>::new(n, 12);
        for _ in 0..n - 1 {
            transform.push(&[0.0]);
        }
        let [now, ..] = transform.waves[11];
        let direct = (12.0 * std::f64::consts::PI * (n as f64 - 0.5) / n as f64).cos();
        assert!((now - direct).abs() < 1e-6, "{now} {direct}");
    }

    #[test]
    fn constant_series_have_no_variance() {
        assert_eq!(cosines_for(lag_one_autocorrelation(&[3.0; 50]), 50), MAX_COSINES);
        assert_eq!(variance_of_mean(&[3.0; 50]), 0.0);
    }
}

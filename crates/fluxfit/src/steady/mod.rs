//! Operating points: means over the windows of a log in which currents and speed are constant, with a covariance that accounts for
//! autocorrelation.
//!
//! Equation (1) holds exactly for the means over a window, because it is linear in these seven channels and the currents' drift:
//!
//! ```text
//! mean(u_d) = R_s mean(i_d) + L_d drift_d - L_q mean(omega_e i_q)
//! mean(u_q) = R_s mean(i_q) + L_q drift_q + L_d mean(omega_e i_d) + psi_f mean(omega_e)
//! ```
//!
//! Means are used, and not samples, because feedback correlates the voltage with the current noise: a regression on samples has a
//! bias of several percent in R_s, the means have none.

pub mod autocorrelation;
mod block;
pub(crate) mod recorder;
mod ripple;
mod stale;
pub mod windows;
pub mod zero_order_hold;

use crate::{
    frames::Dq,
    least_squares::Equation,
    log::{Columns, Log},
    motor::Motor,
    quantization,
};
use autocorrelation::{CosineTransform, MIN_COSINES, cosines_for, lag_one_autocorrelation, variance_of_short_mean};
use std::{
    f64::consts::{PI, TAU},
    ops::Range,
};
use zero_order_hold::ZeroOrderHold;

/// Channels whose means enter the steady equations: u_d, u_q, i_d, i_q, omega_e i_d, omega_e i_q, omega_e.
pub const CHANNELS: usize = 7;

/// The drift of a current is the difference of its means over this many rows at either end of a window: few enough to be close to
/// the ends, enough to average noise.
const DRIFT_ROWS: usize = 8;

/// A speed column may come late by this, s, one standard deviation: a filter of some 30 Hz on a speed from an encoder or an observer. While
/// the speed changes, it is wrong by its slope times that.
const SPEED_LAG: f64 = 5e-3;

/// An angle column whose slope differs from the speed by more than this part of it is not the electrical angle, or turns too far from row
/// to row: it says nothing of the speed.
const SPEED_OF_ANGLE: f64 = 0.05;

/// Means of one steady window.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OperatingPoint {
    /// Rows in the log.
    pub rows: Range<usize>,
    /// Time of its first and last row, s.
    pub time: (f64, f64),
    /// Means of the [`CHANNELS`], SI units, after the zero-order-hold correction.
    pub means: [f64; CHANNELS],
    /// Slope of the currents, A/s.
    pub drift: Dq,
    /// Variance of those slopes, (A/s)².
    pub drift_variance: Dq,
    /// Slope of the speed, electrical rad/s².
    pub acceleration: f64,
    /// Covariance of the means.
    pub covariance: [[f64; CHANNELS]; CHANNELS],
    /// Degrees of freedom of the covariance.
    pub degrees_of_freedom: usize,
}

/// The preliminary estimate with which windows are measured a second time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreliminaryEstimate {
    /// The motor, whose residuals are the noise of the voltage equations.
    pub motor: Motor,
    /// The zero-order-hold correction of the window.
    pub hold: ZeroOrderHold,
}

impl OperatingPoint {
    /// Measures a window. Without a preliminary estimate nothing is corrected, and the covariance is a coarse one.
    pub fn measure(log: &Log, rows: Range<usize>, preliminary: Option<&PreliminaryEstimate>) -> Self {
        let columns = log.columns();
        let n = rows.len();
        let row = |k: usize| {
            let (u, i) = (Dq { d: columns.ud[k], q: columns.uq[k] }, Dq { d: columns.id[k], q: columns.iq[k] });
            let omega_e = columns.omega_e[k];
            // The resistive drop is that of the current's mean over a period, the fluxes are those of the sampled current.
            let (u, mean) = match preliminary {
                Some(preliminary) => preliminary.hold.correct(u, i, omega_e),
                None => (u, i),
            };
            [u.d, u.q, mean.d, mean.q, omega_e * i.d, omega_e * i.q, omega_e]
        };
        let mut means = [0.0; CHANNELS];
        for k in rows.clone() {
            for (mean, value) in means.iter_mut().zip(row(k)) {
                *mean += value / n as f64;
            }
        }
        let (mut covariance, degrees_of_freedom) = match preliminary {
            _ if n < windows::MIN_ROWS => {
                let values: Vec<[f64; CHANNELS]> = rows.clone().map(row).collect();
                scatter_about_lines(&values)
            }
            None => long_run(rows.clone().map(row), n, &means, None),
            Some(preliminary) => {
                // The larger autocorrelation of the two residuals is used for both.
                let residuals =
                    residual_weights(&preliminary.motor).map(|weights| rows.clone().map(|k| dot(&weights, &row(k))).collect::<Vec<_>>());
                let rho = residuals.iter().map(|residual| lag_one_autocorrelation(residual)).fold(0.0, f64::max);
                long_run(rows.clone().map(row), n, &means, Some(rho))
            }
        };
        let time = (columns.t[rows.start], columns.t[rows.end - 1]);
        let late = speed_error(columns, &rows, means[6]);
        add_error(&mut covariance, &[0.0, 0.0, 0.0, 0.0, late * means[2], late * means[3], late]);
        add_quantization(&mut covariance, log, &rows, means[6]);
        let [(drift_d, variance_d), (drift_q, variance_q)] = [&columns.id, &columns.iq].map(|current| drift(&current[rows.clone()], time));
        Self {
            rows: rows.clone(),
            time,
            means,
            drift: Dq { d: drift_d, q: drift_q },
            drift_variance: Dq { d: variance_d, q: variance_q },
            acceleration: drift(&columns.omega_e[rows], time).0,
            covariance,
            degrees_of_freedom,
        }
    }

    /// Mean voltage, V.
    pub fn voltage(&self) -> Dq {
        Dq { d: self.means[0], q: self.means[1] }
    }

    /// The point with its voltage turned forward by an angle, rad: seen in a frame that lags by it.
    pub(crate) fn turned(&self, angle: f64) -> Self {
        self.with_turned(0, angle)
    }

    /// The same with its current too: the whole point in a frame that lags by the angle, rad.
    pub(crate) fn in_frame_behind(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let Dq { d, q } = self.drift;
        let drift = Dq { d: cos * d - sin * q, q: sin * d + cos * q };
        Self { drift, ..self.with_turned(0, angle).with_turned(2, angle).with_turned(4, angle) }
    }

    /// With the vector of channels `d` and `d + 1` turned forward.
    fn with_turned(&self, d: usize, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let turn = |(d, q): (f64, f64)| (cos * d - sin * q, sin * d + cos * q);
        let mut turned = self.clone();
        (turned.means[d], turned.means[d + 1]) = turn((turned.means[d], turned.means[d + 1]));
        for row in &mut turned.covariance {
            (row[d], row[d + 1]) = turn((row[d], row[d + 1]));
        }
        for channel in 0..CHANNELS {
            let column = turn((turned.covariance[d][channel], turned.covariance[d + 1][channel]));
            (turned.covariance[d][channel], turned.covariance[d + 1][channel]) = column;
        }
        turned
    }

    /// Mean current, A.
    pub fn current(&self) -> Dq {
        Dq { d: self.means[2], q: self.means[3] }
    }

    /// Mean speed, electrical rad/s.
    pub fn omega_e(&self) -> f64 {
        self.means[6]
    }

    /// The two equations of the means: `[d, q]`, V.
    pub fn equations(&self) -> [Equation; 2] {
        let [ud, uq, id, iq, omega_id, omega_iq, omega_e] = self.means;
        [
            Equation { coefficients: [id, self.drift.d, -omega_iq, 0.0], value: ud },
            Equation { coefficients: [iq, omega_id, self.drift.q, omega_e], value: uq },
        ]
    }

    /// Covariance, V², of the two equations' residuals for a motor: the noise of voltages, currents and speed together.
    pub fn residual_covariance(&self, motor: &Motor) -> [[f64; 2]; 2] {
        let weights = residual_weights(motor);
        let between = self.covariance_between(&weights[0], &weights[1]);
        let [d, q] = weights.map(|weights| self.variance(&weights));
        [[d + motor.ld.powi(2) * self.drift_variance.d, between], [between, q + motor.lq.powi(2) * self.drift_variance.q]]
    }

    /// Variance of each equation's `coefficients . direction` caused by the noise of currents and speed: `[d, q]`.
    pub fn coefficient_variance(&self, direction: &[f64; 4]) -> [f64; 2] {
        let [rs, ld, lq, psi_f] = *direction;
        let weights = [[0.0, 0.0, rs, 0.0, 0.0, -lq, 0.0], [0.0, 0.0, 0.0, rs, ld, 0.0, psi_f]];
        let [d, q] = weights.map(|weights| self.variance(&weights));
        [d + ld.powi(2) * self.drift_variance.d, q + lq.powi(2) * self.drift_variance.q]
    }

    /// Variance of a weighted sum of the channels: at least the rounding error of its terms. Where the noise of two channels cancels,
    /// the sum alone could come out negative, and no weight would follow from it.
    fn variance(&self, weights: &[f64; CHANNELS]) -> f64 {
        let magnitudes = weights
            .iter()
            .zip(&self.covariance)
            .map(|(weight, row)| weight.abs() * weights.iter().zip(row).map(|(other, covariance)| (other * covariance).abs()).sum::<f64>());
        let rounding = f64::EPSILON * magnitudes.sum::<f64>();
        self.covariance_between(weights, weights).max(rounding)
    }

    fn covariance_between(&self, one: &[f64; CHANNELS], other: &[f64; CHANNELS]) -> f64 {
        one.iter().zip(&self.covariance).map(|(weight, row)| weight * dot(row, other)).sum()
    }
}

/// Weights of the channels in the residuals of equations (2), d and q.
fn residual_weights(motor: &Motor) -> [[f64; CHANNELS]; 2] {
    let Motor { rs, ld, lq, psi_f } = *motor;
    [[1.0, 0.0, -rs, 0.0, 0.0, lq, 0.0], [0.0, 1.0, 0.0, -rs, -ld, 0.0, -psi_f]]
}

/// Covariance of the means of so many rows by cosines, and its degrees of freedom; for a residual's lag-one autocorrelation, if it is
/// known.
fn long_run(
    rows: impl Iterator<Item = [f64; CHANNELS]>,
    n: usize,
    means: &[f64; CHANNELS],
    rho: Option<f64>,
) -> ([[f64; CHANNELS]; CHANNELS], usize) {
    let cosines = rho.map_or(MIN_COSINES, |rho| cosines_for(rho, n));
    let mut transform = CosineTransform::<CHANNELS>::new(n, cosines);
    for mut deviation in rows {
        deviation.iter_mut().zip(means).for_each(|(value, mean)| *value -= mean);
        transform.push(&deviation);
    }
    (transform.covariance_of_mean(rho.unwrap_or(0.0)), cosines)
}

/// Covariance of the means of a few rows, and its degrees of freedom: of the deviations from the straight lines through each channel, for
/// a drift of the speed is no noise of its mean.
fn scatter_about_lines(rows: &[[f64; CHANNELS]]) -> ([[f64; CHANNELS]; CHANNELS], usize) {
    let n = rows.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let spread: f64 = (0..rows.len()).map(|k| (k as f64 - middle).powi(2)).sum();
    let lines: [[f64; 2]; CHANNELS] = std::array::from_fn(|c| {
        let mean = rows.iter().map(|row| row[c]).sum::<f64>() / n;
        let slope = rows.iter().enumerate().map(|(k, row)| (k as f64 - middle) * row[c]).sum::<f64>() / spread.max(f64::MIN_POSITIVE);
        [mean, slope]
    });
    let degrees_of_freedom = rows.len().saturating_sub(2).max(1);
    let mut covariance = [[0.0; CHANNELS]; CHANNELS];
    for (k, row) in rows.iter().enumerate() {
        let deviation: [f64; CHANNELS] = std::array::from_fn(|c| row[c] - lines[c][0] - lines[c][1] * (k as f64 - middle));
        for (entries, one) in covariance.iter_mut().zip(deviation) {
            entries.iter_mut().zip(deviation).for_each(|(entry, other)| *entry += one * other / (degrees_of_freedom as f64 * n));
        }
    }
    (covariance, degrees_of_freedom)
}

fn dot(one: &[f64; CHANNELS], other: &[f64; CHANNELS]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// What the mean of the speed column may be wrong by, rad/s: its difference to the slope of the angle, where that is logged; else what a
/// usual lag makes of a change of the speed.
fn speed_error(columns: &Columns, rows: &Range<usize>, mean: f64) -> f64 {
    let (first, last) = (rows.start, rows.end - 1);
    let by_angle = columns.theta_e.as_ref().map(|theta| {
        let turn: f64 = theta[rows.clone()].windows(2).map(|pair| (pair[1] - pair[0] + PI).rem_euclid(TAU) - PI).sum();
        (turn / (columns.t[last] - columns.t[first]) - mean).abs()
    });
    let by_lag = || SPEED_LAG * drift(&columns.omega_e[rows.clone()], (columns.t[first], columns.t[last])).0;
    by_angle.filter(|error| *error <= SPEED_OF_ANGLE * mean.abs()).unwrap_or_else(by_lag)
}

/// Adds the uncertainty from quantization: a channel has the same error in every product that it enters.
fn add_quantization(covariance: &mut [[f64; CHANNELS]; CHANNELS], log: &Log, rows: &Range<usize>, omega_e: f64) {
    let Some(segment) = log.segment_of(rows.start) else { return };
    let columns = log.columns();
    let channels = [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e];
    let errors: [f64; 5] = std::array::from_fn(|c| {
        let values = &channels[c][rows.clone()];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        quantization::standard_uncertainty(segment.steps[c], variance.sqrt())
    });
    let [ud, uq, id, iq, omega] = errors;
    for error in [
        [ud, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, uq, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, id, 0.0, omega_e * id, 0.0, 0.0],
        [0.0, 0.0, 0.0, iq, 0.0, omega_e * iq, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, omega],
    ] {
        add_error(covariance, &error);
    }
}

/// Adds the covariance of an error that several channels have in common.
fn add_error(covariance: &mut [[f64; CHANNELS]; CHANNELS], error: &[f64; CHANNELS]) {
    for (row, one) in covariance.iter_mut().zip(error) {
        row.iter_mut().zip(error).for_each(|(entry, other)| *entry += one * other);
    }
}

/// Slope of a current (or of the speed) over its window, per second, and its variance, from the deviations from the straight line and
/// their autocorrelation.
fn drift(current: &[f64], (start, end): (f64, f64)) -> (f64, f64) {
    let n = current.len();
    let rows = DRIFT_ROWS.min(n / 4).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    // The two means lie n - rows of n - 1 steps apart.
    let steps = (n - rows) as f64;
    let span = (end - start) * steps / (n - 1).max(1) as f64;
    let change = mean(&current[n - rows..]) - mean(&current[..rows]);
    let deviations: Vec<f64> = current.iter().enumerate().map(|(k, i)| i - change * k as f64 / steps).collect();
    (change / span, 2.0 * variance_of_short_mean(&deviations, rows) / span.powi(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::Draws;

    /// All channels move together, as on a ramp without noise: exactly, every residual of a motor that follows the ramp has the variance
    /// zero. Half of the sums come out negative by rounding.
    #[test]
    fn noise_that_cancels_never_has_a_negative_variance() {
        let mut draws = Draws::seeded(1, 0);
        for _ in 0..200 {
            let moves: [f64; CHANNELS] = std::array::from_fn(|_| draws.normal() * 10.0_f64.powf(6.0 * draws.normal()));
            // R_s and psi_f that cancel what u_q, i_q and omega_e do together.
            let (rs, psi_f) = (0.5 * moves[1] / moves[3], 0.5 * moves[1] / moves[6]);
            let motor = Motor { rs, ld: 0.0, lq: (rs * moves[2] - moves[0]) / moves[5], psi_f };
            let point = OperatingPoint {
                rows: 0..30,
                time: (0.0, 1.0),
                means: [1.0; CHANNELS],
                drift: Dq::default(),
                drift_variance: Dq::default(),
                acceleration: 0.0,
                covariance: moves.map(|one| moves.map(|other| one * other)),
                degrees_of_freedom: 3,
            };
            let covariance = point.residual_covariance(&motor);
            assert!(covariance[0][0] >= 0.0 && covariance[1][1] >= 0.0, "{covariance:?}");
            let [d, q] = point.coefficient_variance(&motor.to_array());
            assert!(d >= 0.0 && q >= 0.0, "{d} {q}");
        }
    }
}

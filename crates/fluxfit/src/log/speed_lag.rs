//! A speed that is logged late: how much by the logged angle, and brought to its rows by the inverse of a filter of first order.

use super::{Log, Segment};
use crate::normal_matrix::dot;
use std::f64::consts::TAU;

/// Rows to either side over which a slope of the speed is taken, as a part of the lag: short beside what the filter smooths, long beside
/// the noise that it let pass.
const PART: f64 = 0.1;

/// Most such rows.
const MOST_ROWS: f64 = 100.0;

/// Least angle, rad, by which the rotor is ahead of a lagging speed's integral when the speed has changed most, for the angle to tell the
/// lag. A drive that logs an angle turned ahead by its delay, 1.5 periods, is ahead too, by some tenths.
const LEAST_AHEAD: f64 = 0.5;

/// For the same reason, least rows of a lag.
const LEAST_ROWS: f64 = 8.0;

/// Most of what the angle turns beyond the speed's integral, as a part of its variance, that a lag leaves open.
const MOST_LEFT: f64 = 0.01;

/// A lag of the speed that the angle tells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LagByAngle {
    /// The lag, s.
    pub(crate) time: f64,
    /// Variance of the angle beyond the speed's integral, rad².
    pub(crate) variance: f64,
    /// What the lag leaves of that angle, rad: the rows of all segments.
    pub(crate) left: Vec<f64>,
}

impl Log {
    /// The lag of the speed behind the logged angle. Behind a filter of first order the rotor turns by the integral of the logged speed and
    /// by `lag omega_e`. `None` where there is no angle, where it turns by the speed, or differs in another way.
    pub(crate) fn speed_lag_by_angle(&self) -> Option<LagByAngle> {
        let columns = self.columns();
        let theta_e = columns.theta_e.as_ref()?;
        // Of each segment, about their means: the angle beyond the speed's integral, and the speed.
        let (mut ahead, mut speed) = (Vec::with_capacity(self.rows()), Vec::with_capacity(self.rows()));
        for Segment { rows, .. } in self.segments() {
            let first = ahead.len();
            let mut beyond = 0.0;
            for row in rows.clone() {
                if row > rows.start {
                    let by_speed = 0.5 * (columns.omega_e[row - 1] + columns.omega_e[row]) * (columns.t[row] - columns.t[row - 1]);
                    let step = theta_e[row] - theta_e[row - 1] - by_speed;
                    beyond += step - TAU * (step / TAU).round();
                }
                ahead.push(beyond);
                speed.push(columns.omega_e[row]);
            }
            about_mean(&mut ahead[first..]);
            about_mean(&mut speed[first..]);
        }
        let (of_speed, of_both, of_ahead) = (dot(&speed, &speed), dot(&speed, &ahead), dot(&ahead, &ahead));
        let time = of_both / of_speed;
        let range = speed.iter().fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
        let is_there = time >= LEAST_ROWS * self.slowest_period() && time * (range.1 - range.0) >= LEAST_AHEAD;
        let left: Vec<f64> = ahead.iter().zip(&speed).map(|(ahead, speed)| ahead - time * speed).collect();
        let is_lag = is_there && dot(&left, &left) <= MOST_LEFT * of_ahead;
        is_lag.then_some(LagByAngle { time, variance: of_ahead / ahead.len() as f64, left })
    }

    /// The same log with the speed that is reached `lag` seconds later if it goes on as it does: `omega_e + lag d omega_e / dt`.
    #[must_use]
    pub(crate) fn without_speed_lag(&self, lag: f64) -> Self {
        let (t, omega_e) = (&self.columns().t, &self.columns().omega_e);
        let mut advanced = omega_e.clone();
        for Segment { rows, sample_period, .. } in self.segments() {
            let reach = (PART * lag / sample_period).clamp(1.0, MOST_ROWS) as usize;
            for row in rows.clone() {
                let (before, after) = (row.saturating_sub(reach).max(rows.start), (row + reach).min(rows.end - 1));
                if after > before {
                    advanced[row] += lag * (omega_e[after] - omega_e[before]) / (t[after] - t[before]);
                }
            }
        }
        self.with_speed(advanced)
    }
}

fn about_mean(values: &mut [f64]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|value| *value -= mean);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// A speed that swings about 800 rad/s, behind a filter of this lag, s, beside the rotor's own angle; of first order, at one frequency,
    /// it is smaller and later.
    fn swinging(lag: f64) -> Columns {
        let t: Vec<f64> = (0..4000).map(|row| f64::from(row) * 1e-4).collect();
        let (swing, rate) = (400.0, 15.0);
        let theta_e = t.iter().map(|t| (800.0 * t - swing / rate * (rate * t).cos()).rem_euclid(TAU)).collect();
        let (size, late) = (swing / (rate * lag).hypot(1.0), (rate * lag).atan());
        let omega_e = t.iter().map(|t| 800.0 + size * (rate * t - late).sin()).collect();
        let any = || t.iter().map(|t| 1.0 + (300.0 * t).sin()).collect();
        Columns { ud: any(), uq: any(), id: any(), iq: any(), omega_e, theta_e: Some(theta_e), t, ..Columns::default() }
    }

    #[test]
    fn the_angle_tells_by_how_much_the_speed_lags() {
        const LAG: f64 = 8e-3;
        let found = Log::new(swinging(LAG)).unwrap().speed_lag_by_angle().unwrap();
        assert!((found.time - LAG).abs() < 1e-3 * LAG, "{}", found.time);
        // Neither a speed in time, nor an angle that turns at another rate, nor one turned ahead by 1.5 periods is a lag.
        let angle = |change: &dyn Fn(f64, f64) -> f64| {
            let mut columns = swinging(0.0);
            let omega_e = columns.omega_e.clone();
            columns.theta_e.as_mut().unwrap().iter_mut().zip(omega_e).for_each(|(angle, omega)| *angle = change(*angle, omega));
            Log::new(columns).unwrap().speed_lag_by_angle()
        };
        assert_eq!(angle(&|angle, _| angle), None);
        assert_eq!(angle(&|angle, _| 2.0 * angle), None);
        assert_eq!(angle(&|angle, omega| angle + 1.5e-4 * omega), None);
    }

    /// A ramp after a filter of 8 ms: `omega = a (t - tau + tau exp(-t / tau))`.
    #[test]
    fn a_filtered_ramp_becomes_the_ramp() {
        const LAG: f64 = 8e-3;
        let t: Vec<f64> = (0..2000).map(|row| f64::from(row) * 1e-4).collect();
        let omega_e = t.iter().map(|t| 5000.0 * (t - LAG + LAG * (-t / LAG).exp())).collect();
        let zero = vec![0.0; t.len()];
        let current = t.iter().map(|t| t.sin()).collect();
        let columns =
            Columns { t: t.clone(), ud: zero.clone(), uq: vec![1.0; t.len()], id: zero, iq: current, omega_e, ..Columns::default() };
        let log = Log::new(columns).unwrap().without_speed_lag(LAG);
        for (row, t) in t.iter().enumerate().skip(20).take(1900) {
            assert!((log.columns().omega_e[row] - 5000.0 * t).abs() < 0.1, "{row}");
        }
    }
}

//! A speed that is logged late, brought to its rows: the inverse of a filter of first order.

use super::{Log, Segment};

/// Rows to either side over which a slope of the speed is taken, as a part of the lag: short beside what the filter smooths, long beside
/// the noise that it let pass.
const PART: f64 = 0.1;

/// Most such rows.
const MOST_ROWS: f64 = 100.0;

impl Log {
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

#[cfg(test)]
mod tests {
    use crate::log::{Columns, Log};

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

//! Whether the speed suits the slopes of the currents: the inductances that the voltages beside them tell are those that the voltages of a
//! turning current tell, or the speed is wrong by their ratio.

use super::{
    finding::ColumnFinding,
    regression::{BLOCK, BOUNDED, ENOUGH, Frame, LEAST, Mean, means, normal, solved},
};
use crate::log::Log;
use nalgebra::DMatrix;

/// Factors of the speed that are tried lie between this and its inverse, in steps of
const MOST_SCALE: f64 = 20.0;

/// this.
const SCALE_STEP: f64 = 1.05;

/// What is left of the voltage, as a fraction, where the speed is judged.
const WELL_EXPLAINED: f64 = 0.03;

/// A factor that leaves at most this many times what the best one leaves is possible.
const POSSIBLE: f64 = 1.15;

/// Factors nearer to one than this are not looked for: saturation, noise, and voltages that act later than their row change the
/// inductances of the slopes by less. In every fourth row of two drives the speed seemed 1.1 to 1.6 times too high.
const LEAST_SCALE: f64 = 1.5;

/// The same where rows lie further apart than a drive's periods and currents jump between them, at least: where a row has the voltage of
/// the first period of a jump, it stands for all of them, and the inductance of the slope comes out too large.
const LEAST_SCALE_OF_JUMPS: f64 = 4.0;

/// Largest bandwidth of a current controller, rad/s: a tenth of 20 kHz. It begins a jump with the bandwidth times the inductance times the
/// jump; a row of T that has this voltage makes the inductance bandwidth times T times too large.
const FASTEST_CONTROLLER: f64 = 12_500.0;

/// The speed as it is must leave this many times as much as the best higher factor. 37 drives with faults of every kind, and 40 with
/// filters and means, leave at most 1.4 times as much; with a speed four times too high, mostly 2 to 4 times.
const TOO_HIGH: f64 = 1.65;

/// The same of a speed that is too low, as which noise and saturation look: right speeds leave up to 2.7 times as much, those a quarter as
/// high 4 to 11 times.
const TOO_LOW: f64 = 4.0;

/// The same where the first rows count: where a log begins with the drive's start, filters hold nothing yet of what they will, and right
/// speeds seemed 1.6 to 2.2 times too high.
const LEAST_SCALE_OF_START: f64 = 2.5;

/// By which factor the speed is too high, or too low, for inductances that are those of the slopes of the currents, for certain.
pub(super) fn speed_scale(log: &Log) -> Option<ColumnFinding> {
    let [low, high] = speed_of_slopes(log).filter(SpeedOfSlopes::is_certain)?.too_high;
    Some(ColumnFinding::SpeedScale { low, high, angle: log.columns().theta_e.is_some() })
}

/// Factors by which the speed may be too high for inductances that are those of the slopes of the currents, the least and the largest,
/// where they are far from one. By themselves they prove nothing: noise and saturation change the inductances of the slopes.
/// A speed that an angle confirms is in doubt only where they are certain: then both are wrong.
pub(crate) fn speed_in_doubt(log: &Log) -> Option<[f64; 2]> {
    let slopes = speed_of_slopes(log)?;
    let [low, high] = slopes.too_high;
    let is_far = low > LEAST_SCALE || high < 1.0 / LEAST_SCALE;
    let is_in_doubt = if log.columns().theta_e.is_some() { slopes.is_certain() } else { is_far };
    is_in_doubt.then_some([low, high])
}

/// Which speed suits the slopes of the currents.
struct SpeedOfSlopes {
    /// By which factors the speed may be too high, the least and the largest.
    too_high: [f64; 2],
    /// What the speed as it is leaves of the voltages, over what the best of these leaves.
    excess: f64,
    /// Smaller factors may be of a speed that is right.
    least_scale: f64,
}

impl SpeedOfSlopes {
    /// Whether no log of the right speed looks like this.
    fn is_certain(&self) -> bool {
        let [low, high] = self.too_high;
        low > self.least_scale && self.excess > TOO_HIGH || high < 1.0 / LEAST_SCALE && self.excess > TOO_LOW
    }
}

/// Nothing where the slopes do not tell.
fn speed_of_slopes(log: &Log) -> Option<SpeedOfSlopes> {
    if log.is_interpolated() {
        return None;
    }
    let means: Vec<Mean> = means(log).into_iter().map(Mean::without_noise).collect();
    if log.is_control_rate() {
        let later: Vec<Mean> = means.iter().copied().filter(|mean| !mean.begins).collect();
        let with_start = || of_slopes(log, &means, LEAST_SCALE_OF_START);
        return of_slopes(log, &later, LEAST_SCALE).filter(SpeedOfSlopes::is_certain).or_else(with_start);
    }
    let calm: Vec<Mean> = means.iter().copied().filter(|mean| !mean.jumps).collect();
    let least_of_jumps = LEAST_SCALE_OF_JUMPS.max(FASTEST_CONTROLLER * log.slowest_period());
    // An angle that agrees with the speed is rarely wrong with it: there, more is asked.
    let of_jumps = || if log.columns().theta_e.is_none() { of_slopes(log, &means, least_of_jumps) } else { None };
    of_slopes(log, &calm, LEAST_SCALE).filter(SpeedOfSlopes::is_certain).or_else(of_jumps)
}

/// The same of these means.
fn of_slopes(log: &Log, means: &[Mean], least_scale: f64) -> Option<SpeedOfSlopes> {
    if means.len() < LEAST {
        return None;
    }
    let normal = normal(means, &Frame::AS_IT_IS, true);
    let steps = (MOST_SCALE.ln() / SCALE_STEP.ln()) as i32;
    let tried: Vec<(f64, f64)> = (-steps..=steps).map(|step| SCALE_STEP.powi(step)).map(|scale| (scale, left(&normal, scale))).collect();
    let best = tried.iter().fold(f64::INFINITY, |best, (_, left)| best.min(*left));
    let mut possible = tried.iter().filter(|(_, left)| *left <= POSSIBLE * best).map(|(scale, _)| *scale);
    let low = possible.next()?;
    let high = possible.next_back().unwrap_or(low);
    // At the end of the range the slopes tell nothing: they are those of a log without transients.
    if low <= tried[0].0 || high >= tried[tried.len() - 1].0 {
        return None;
    }
    // The currents have to be seen while they change, in less than the time constant of the winding.
    let [resistance, ld, lq, ..] = solved(&tied(&normal, (low * high).sqrt()))?.unknowns;
    let inductance = ld.min(lq) * (low * high).sqrt();
    let block = BLOCK.min(log.rows() / ENOUGH).max(1) as f64;
    let is_seen = log.segments().iter().all(|segment| block * segment.sample_period * resistance < inductance);
    let excess = left(&normal, 1.0) / best;
    (is_seen && best < WELL_EXPLAINED).then_some(SpeedOfSlopes { too_high: [low, high], excess, least_scale })
}

/// What is left of the voltages, as a fraction, where the inductances of the slopes are those of the speed, times a factor.
fn left(normal: &DMatrix<f64>, scale: f64) -> f64 {
    solved(&tied(normal, scale)).map_or(f64::INFINITY, |fit| fit.left)
}

/// The equations in which the inductances of the slopes are those of the speed, times a factor.
fn tied(normal: &DMatrix<f64>, scale: f64) -> DMatrix<f64> {
    let mut tied = normal.clone();
    for (of_speed, of_slope) in [(1, BOUNDED), (2, BOUNDED + 1)] {
        let column = tied.column(of_slope) * scale;
        tied.column_mut(of_speed).zip_apply(&column, |sum, more| *sum += more);
        let row = tied.row(of_slope) * scale;
        tied.row_mut(of_speed).zip_apply(&row, |sum, more| *sum += more);
        tied.column_mut(of_slope).fill(0.0);
        tied.row_mut(of_slope).fill(0.0);
    }
    tied
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frames::Dq, log::Columns};

    /// Rows of a time, s, that are every n-th of a drive's periods, of a motor of 6 ohm, 60 mH and 0.3 Wb at 360 rad/s: i_q jumps by 1 A
    /// and i_d by -1 A, or a part of that. The drive made each change in the first part of the row, with so many times the voltage of a
    /// row's change, and slopes ask for so many times the inductance.
    fn jumps_between_rows(times: f64, has_angle: bool, (period, part): (f64, f64)) -> Log {
        let (rs, l, psi_f, omega_e, rows) = (6.0, 0.06, 0.3, 360.0, 900);
        let current = |row: usize| Dq {
            d: if (row / 40).is_multiple_of(2) { 0.0 } else { -part },
            q: if (row / 20).is_multiple_of(2) { 1.0 } else { 1.0 + part },
        };
        let voltage = |row: usize| {
            let (i, next) = (current(row), current(row + 1));
            let kick = |from: f64, to: f64| times * l * (to - from) / period;
            Dq { d: rs * i.d - omega_e * l * i.q + kick(i.d, next.d), q: rs * i.q + omega_e * (l * i.d + psi_f) + kick(i.q, next.q) }
        };
        let each = |value: &dyn Fn(usize) -> f64| (0..rows).map(value).collect::<Vec<f64>>();
        Log::new(Columns {
            t: each(&|row| period * row as f64),
            ud: each(&|row| voltage(row).d),
            uq: each(&|row| voltage(row).q),
            id: each(&|row| current(row).d),
            iq: each(&|row| current(row).q),
            omega_e: each(&|_| omega_e),
            theta_e: has_angle.then(|| each(&|row| (omega_e * period * row as f64).rem_euclid(std::f64::consts::TAU))),
            ..Columns::default()
        })
        .unwrap()
    }

    /// A speed alone may be the shaft's, if the factor is larger than a fast controller makes it; one that an angle follows is believed
    /// before a voltage that acted for a part of its row.
    #[test]
    fn currents_that_jump_between_rows_contradict_a_speed_alone_by_large_factors() {
        let (close, far) = ((3e-4, 1.0), (1e-3, 1.0));
        assert_eq!(speed_scale(&jumps_between_rows(10.0, true, close)), None);
        assert_eq!(speed_scale(&jumps_between_rows(3.0, false, close)), None);
        assert_eq!(speed_scale(&jumps_between_rows(10.0, false, far)), None);
        let alone = speed_scale(&jumps_between_rows(10.0, false, close));
        assert!(matches!(alone, Some(ColumnFinding::SpeedScale { low, high, .. }) if low > 5.0 && high < 20.0), "{alone:?}");
    }

    /// A jump of a thirtieth of the current is one, too.
    #[test]
    fn small_jumps_say_as_little() {
        assert_eq!(speed_scale(&jumps_between_rows(10.0, true, (1e-3, 0.03))), None);
    }

    /// Rows of a period of 70 us, of a motor of 40 mohm, 70 uH and 10 mWb at 500 rad/s. The drive starts with the log: i_q rises by 26 A in
    /// a few rows, later i_d by -20 A. Voltages and currents passed filters that began with the first row's values.
    fn start_behind_filters(speed_is: f64) -> Log {
        let (rs, l, psi_f, omega_e, period, rows) = (0.04, 70e-6, 0.01, 500.0, 70e-6, 3000);
        let risen = |row: i32, at: i32| if row < at { 0.0 } else { 1.0 - (-0.5 * f64::from(row - at)).exp() };
        let current = |row: i32| Dq { d: -20.0 * risen(row, 1500), q: 26.0 * risen(row, 0) };
        // A command acts one period later.
        let voltage = |row: i32| {
            let (i, next) = (current(row + 1), current(row + 2));
            let rises = |from: f64, to: f64| l * (to - from) / period;
            Dq { d: rs * i.d - omega_e * l * i.q + rises(i.d, next.d), q: rs * i.q + omega_e * (l * i.d + psi_f) + rises(i.q, next.q) }
        };
        let filtered = |value: &dyn Fn(i32) -> Dq| {
            let (kept, mut held) = ((-0.2_f64).exp(), value(0));
            let next = |row| {
                let new = value(row);
                held = Dq { d: kept * held.d + (1.0 - kept) * new.d, q: kept * held.q + (1.0 - kept) * new.q };
                held
            };
            (0..rows).map(next).collect::<Vec<Dq>>()
        };
        let (u, i) = (filtered(&voltage), filtered(&current));
        Log::new(Columns {
            t: (0..rows).map(|row| period * f64::from(row)).collect(),
            ud: u.iter().map(|u| u.d).collect(),
            uq: u.iter().map(|u| u.q).collect(),
            id: i.iter().map(|i| i.d).collect(),
            iq: i.iter().map(|i| i.q).collect(),
            omega_e: vec![speed_is * omega_e; u.len()],
            ..Columns::default()
        })
        .unwrap()
    }

    /// A right speed seemed 1.6 times too high there; one that is four times too high is seen all the same.
    #[test]
    fn filters_at_the_start_of_a_log_do_not_contradict_the_speed() {
        assert_eq!(speed_scale(&start_behind_filters(1.0)), None);
        let four_times = speed_scale(&start_behind_filters(4.0));
        assert!(matches!(four_times, Some(ColumnFinding::SpeedScale { low, high, .. }) if low > 2.5 && high < 8.0), "{four_times:?}");
    }
}

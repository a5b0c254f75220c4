//! The voltages explained by currents, speed and the slopes of the currents, by least squares over means of a few rows:
//!
//! ```text
//! u_d = R i_d - L_q omega i_q       + V i_d/|i| + l_d di_d/dt
//! u_q = R i_q + L_d omega i_d + psi omega + V i_q/|i| + l_q di_q/dt
//! ```
//!
//! with R, L_d, L_q, psi and the voltage V that dead time takes not negative. Changed signs, or another order of the axes, are tried on the
//! same means. It is no identification: it only tells which of a few explanations leaves far less of the voltage than another.

use super::finding::{Change, ColumnFinding, Turning};
use crate::{frames::Dq, log::Log};
use nalgebra::{DMatrix, DVector};

/// Most rows of a mean.
pub(super) const BLOCK: usize = 10;

/// Means that are enough: a short log has fewer rows in each.
pub(super) const ENOUGH: usize = 300;

/// Fewest means.
pub(super) const LEAST: usize = 30;

/// Rows with less current or speed than this share of the largest tell little.
const SMALL: f64 = 0.05;

/// What no motor explains of the voltage as it is, as a fraction, before a change is looked for.
pub(super) const UNEXPLAINED: f64 = 0.03;

/// What is left of the voltage, as a fraction, where the time is judged.
const EXPLAINED: f64 = 0.15;

/// A change must leave less than this part of that.
const MUCH_LESS: f64 = 0.25;

/// Changes that leave at most this many times what the best leaves are equally good.
const AS_GOOD: f64 = 1.5;

/// By this factor the slopes of the currents must reduce what is left of the voltage's square, where the time is judged by them.
const BY_SLOPES: f64 = 4.0;

/// A current jumps if so much of its change over a mean and the rows beside it is that of one row. Where rows are every n-th of a drive's
/// periods, the voltage of such a row acted for a part of the time only, and the inductance of the slope comes out too large.
const JUMP_OF_CHANGE: f64 = 0.4;

/// A current changes if it does by more than so many standard deviations of its noise.
const CHANGE: f64 = 6.0;

/// Rows beside a jump that do not count either.
const BESIDE_A_JUMP: usize = 2;

/// Rows after which a filter has forgotten what it held at the start of a log: four time constants of eight rows.
const FIRST_ROWS: usize = 30;

/// The unknowns: R, L_d, L_q, psi, V; and the two inductances of the slopes, which may have any sign.
const UNKNOWNS: usize = 7;

/// Unknowns that are not negative.
pub(super) const BOUNDED: usize = 5;

/// A mean of rows: voltage, current, the current's direction, its slope, omega i and omega.
#[derive(Clone, Copy, Default)]
pub(super) struct Mean {
    /// Whether the current jumps from a row to the next.
    pub(super) jumps: bool,
    /// Whether it has some of the first rows of the log, or after a gap.
    pub(super) begins: bool,
    /// Whether the currents of d and q change by more than noise.
    changes: [bool; 2],
    u: Dq,
    i: Dq,
    direction: Dq,
    slope: Dq,
    omega_i: Dq,
    omega: f64,
}

impl Mean {
    /// A single row.
    pub(super) fn of_row(u: Dq, i: Dq, slope: Dq, omega: f64) -> Self {
        let length = i.magnitude();
        let direction = if length > 0.0 { Dq { d: i.d / length, q: i.q / length } } else { i };
        Self { u, i, direction, slope, omega_i: Dq { d: omega * i.d, q: omega * i.q }, omega, ..Self::default() }
    }

    /// Without the slopes of noise: what a controller makes of it is no voltage of theirs, and grows with the time between rows.
    pub(super) fn without_noise(self) -> Self {
        let [d, q] = self.changes;
        Self { slope: Dq { d: if d { self.slope.d } else { 0.0 }, q: if q { self.slope.q } else { 0.0 } }, ..self }
    }

    /// Its speed, rad/s.
    pub(super) fn speed(&self) -> f64 {
        self.omega
    }

    /// With its voltage and speed alone.
    pub(super) fn without_current(&self) -> Self {
        Self { u: self.u, omega: self.omega, ..Self::default() }
    }

    /// In a frame that an angle, rad, is behind this one, with the voltage turned further.
    pub(super) fn in_frame_behind(&self, angle: f64, of_voltage: f64) -> Self {
        Self {
            u: self.u.turned(angle + of_voltage),
            i: self.i.turned(angle),
            direction: self.direction.turned(angle),
            slope: self.slope.turned(angle),
            omega_i: self.omega_i.turned(angle),
            ..*self
        }
    }

    /// Of neighbours that have as many rows each.
    fn of(means: &[Self]) -> Self {
        let over = |value: &dyn Fn(&Self) -> f64| means.iter().map(value).sum::<f64>() / means.len() as f64;
        let of = |value: &dyn Fn(&Self) -> Dq| Dq { d: over(&|mean| value(mean).d), q: over(&|mean| value(mean).q) };
        Self {
            jumps: means.iter().any(|mean| mean.jumps),
            begins: means.iter().any(|mean| mean.begins),
            changes: [0, 1].map(|axis| means.iter().any(|mean| mean.changes[axis])),
            u: of(&|mean| mean.u),
            i: of(&|mean| mean.i),
            direction: of(&|mean| mean.direction),
            slope: of(&|mean| mean.slope),
            omega_i: of(&|mean| mean.omega_i),
            omega: over(&|mean| mean.omega),
        }
    }
}

/// The signs and the order that the columns are given.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    swap_u: bool,
    swap_i: bool,
    u: [f64; 2],
    i: [f64; 2],
    omega: f64,
}

impl Frame {
    pub(super) const AS_IT_IS: Self = Self { swap_u: false, swap_i: false, u: [1.0; 2], i: [1.0; 2], omega: 1.0 };

    fn with(mut self, change: Change) -> Self {
        match change {
            Change::SwapAxes => (self.swap_u, self.swap_i) = (!self.swap_u, !self.swap_i),
            Change::SwapVoltages => self.swap_u = !self.swap_u,
            Change::SwapCurrents => self.swap_i = !self.swap_i,
            Change::ReverseCurrents => self.i = self.i.map(|sign| -sign),
            Change::ReverseVoltages => self.u = self.u.map(|sign| -sign),
            Change::ReverseAxes => (self.u, self.i) = (self.u.map(|sign| -sign), self.i.map(|sign| -sign)),
            Change::ReverseSpeed => self.omega = -self.omega,
            Change::ReverseUd => self.u[0] = -self.u[0],
            Change::ReverseUq => self.u[1] = -self.u[1],
            Change::ReverseId => self.i[0] = -self.i[0],
            Change::ReverseIq => self.i[1] = -self.i[1],
        }
        self
    }

    /// Signs apply to what stands in the place of d and q after the exchange.
    fn of(&self, mean: &Mean) -> Mean {
        let turned = |value: Dq, swap: bool, [d, q]: [f64; 2]| {
            let value = if swap { Dq { d: value.q, q: value.d } } else { value };
            Dq { d: d * value.d, q: q * value.q }
        };
        let of_current = |value: Dq| turned(value, self.swap_i, self.i);
        let omega_i = of_current(mean.omega_i);
        Mean {
            jumps: mean.jumps,
            begins: mean.begins,
            changes: mean.changes,
            u: turned(mean.u, self.swap_u, self.u),
            i: of_current(mean.i),
            direction: of_current(mean.direction),
            slope: of_current(mean.slope),
            omega_i: Dq { d: self.omega * omega_i.d, q: self.omega * omega_i.q },
            omega: self.omega * mean.omega,
        }
    }
}

/// What a fit leaves, as a fraction of the voltage's root mean square, and its unknowns.
pub(super) struct Fit {
    pub(super) left: f64,
    pub(super) unknowns: [f64; UNKNOWNS],
}

impl Fit {
    /// The inductance of the q axis, H, as the speed shows it.
    pub(super) fn lq(&self) -> f64 {
        self.unknowns[2]
    }
}

/// A smallest step that is larger than this part of the largest value is no digit of a converter but a jump.
const COARSE: f64 = 0.01;

/// Noise of a channel, by the median of its second differences, which have `sqrt 6` times its standard deviation and a median size of
/// 0.6745 of theirs; what changes steadily has none, but for its digits.
fn noise(values: &[f64]) -> f64 {
    let mut bends: Vec<f64> = values.windows(3).map(|row| (row[0] - 2.0 * row[1] + row[2]).abs()).collect();
    if bends.is_empty() {
        return 0.0;
    }
    let middle = bends.len() / 2;
    let by_bends = *bends.select_nth_unstable_by(middle, f64::total_cmp).1 / (0.6745 * 6.0_f64.sqrt());
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let digit = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    by_bends.max(digit.min(COARSE * largest) / 12.0_f64.sqrt())
}

/// Means of consecutive rows that carry current at speed.
pub(super) fn means(log: &Log) -> Vec<Mean> {
    let columns = log.columns();
    let fastest = columns.omega_e.iter().fold(0.0_f64, |most, omega| most.max(omega.abs()));
    let peak = log.peak_current();
    let noise = Dq { d: noise(&columns.id), q: noise(&columns.iq) };
    let rows = (log.rows() / ENOUGH).clamp(1, BLOCK);
    let mut means = Vec::new();
    for segment in log.segments() {
        let mut start = segment.rows.start;
        while start + rows < segment.rows.end {
            let block = start..start + rows;
            let mut mean = Mean { begins: start < segment.rows.start + FIRST_ROWS, ..Mean::default() };
            for row in block.clone() {
                let i = Dq { d: columns.id[row], q: columns.iq[row] };
                let length = i.magnitude();
                let omega = columns.omega_e[row];
                let direction = if length > 0.0 { Dq { d: i.d / length, q: i.q / length } } else { i };
                let add = |sum: Dq, d: f64, q: f64| Dq { d: sum.d + d / rows as f64, q: sum.q + q / rows as f64 };
                mean.u = add(mean.u, columns.ud[row], columns.uq[row]);
                mean.i = add(mean.i, i.d, i.q);
                mean.direction = add(mean.direction, direction.d, direction.q);
                mean.omega_i = add(mean.omega_i, omega * i.d, omega * i.q);
                mean.omega += omega / rows as f64;
            }
            let change = |from: usize, to: usize| (columns.id[to] - columns.id[from]).hypot(columns.iq[to] - columns.iq[from]);
            let (end, span) = (start + rows, columns.t[start + rows] - columns.t[start]);
            // A row that ends while a current jumps has a part of its change, or all the voltage that makes it.
            let around = start.saturating_sub(BESIDE_A_JUMP).max(segment.rows.start)..(end + BESIDE_A_JUMP).min(segment.rows.end - 1);
            let largest = around.clone().map(|row| change(row, row + 1)).fold(0.0, f64::max);
            mean.jumps = largest > (CHANGE * noise.magnitude()).max(JUMP_OF_CHANGE * change(around.start, around.end));
            mean.slope = Dq { d: (columns.id[end] - columns.id[start]) / span, q: (columns.iq[end] - columns.iq[start]) / span };
            mean.changes = [(mean.slope.d, noise.d), (mean.slope.q, noise.q)].map(|(slope, noise)| slope.abs() * span > CHANGE * noise);
            start = end;
            if mean.i.magnitude() >= SMALL * peak && mean.omega.abs() >= SMALL * fastest {
                means.push(mean);
            }
        }
    }
    means
}

/// Fits the unknowns to the voltages of a frame.
pub(super) fn fit(means: &[Mean], frame: &Frame, has_slopes: bool) -> Option<Fit> {
    if means.len() < LEAST { None } else { solved(&normal(means, frame, has_slopes)) }
}

/// The normal equations of the unknowns, with the voltage behind them.
pub(super) fn normal(means: &[Mean], frame: &Frame, has_slopes: bool) -> DMatrix<f64> {
    let mut normal = DMatrix::<f64>::zeros(UNKNOWNS + 1, UNKNOWNS + 1);
    for mean in means {
        let m = frame.of(mean);
        let slope = if has_slopes { m.slope } else { Dq::default() };
        let d = [m.i.d, 0.0, -m.omega_i.q, 0.0, m.direction.d, slope.d, 0.0, m.u.d];
        let q = [m.i.q, m.omega_i.d, 0.0, m.omega, m.direction.q, 0.0, slope.q, m.u.q];
        for row in [d, q] {
            let row = DVector::from_column_slice(&row);
            normal.ger(1.0, &row, &row, 1.0);
        }
    }
    normal
}

/// The unknowns with which these equations leave least. With few unknowns every set of bounds that hold is tried.
pub(super) fn solved(normal: &DMatrix<f64>) -> Option<Fit> {
    let whole = normal[(UNKNOWNS, UNKNOWNS)];
    if whole <= 0.0 {
        return None;
    }
    let mut best: Option<Fit> = None;
    for free in 0..1_u32 << BOUNDED {
        let used: Vec<usize> = (0..UNKNOWNS).filter(|k| (*k >= BOUNDED || free >> k & 1 == 1) && normal[(*k, *k)] > 0.0).collect();
        // Columns of length one: currents, fluxes and slopes differ by powers of ten.
        let scale: Vec<f64> = used.iter().map(|k| normal[(*k, *k)].sqrt()).collect();
        let size = used.len();
        let matrix =
            DMatrix::from_fn(size, size, |a, b| normal[(used[a], used[b])] / (scale[a] * scale[b]) + if a == b { RIDGE } else { 0.0 });
        let right = DVector::from_fn(size, |a, _| normal[(used[a], UNKNOWNS)] / scale[a]);
        let Some(solution) = matrix.cholesky().map(|factor| factor.solve(&right)) else { continue };
        let left = ((whole - solution.dot(&right)) / whole).max(0.0).sqrt();
        let mut unknowns = [0.0; UNKNOWNS];
        used.iter().enumerate().for_each(|(a, k)| unknowns[*k] = solution[a] / scale[a]);
        let is_allowed = unknowns[..BOUNDED].iter().all(|unknown| *unknown >= 0.0);
        if is_allowed && best.as_ref().is_none_or(|best| left < best.left) {
            best = Some(Fit { left, unknowns });
        }
    }
    best
}

/// Makes collinear columns solvable: at one operating point R and V are one.
const RIDGE: f64 = 1e-9;

/// Whether angle or speed has the wrong sign, where they differ: the sign of speed with which a motor explains the voltages.
pub(super) fn wrong_sign(log: &Log) -> Option<Turning> {
    let means = means(log);
    let now = fit(&means, &Frame::AS_IT_IS, true)?.left;
    let reversed = fit(&means, &Frame::AS_IT_IS.with(Change::ReverseSpeed), true)?.left;
    if now < MUCH_LESS * reversed {
        Some(Turning::Angle)
    } else if reversed < MUCH_LESS * now {
        Some(Turning::Speed)
    } else {
        None
    }
}

/// Whether the inductances of the slopes are a power of 1000 times those of the speed.
pub(super) fn time_unit(log: &Log) -> Option<ColumnFinding> {
    let means = means(log);
    let with = fit(&means, &Frame::AS_IT_IS, true)?;
    let without = fit(&means, &Frame::AS_IT_IS, false)?;
    if with.left > EXPLAINED || without.left * without.left < BY_SLOPES * with.left * with.left {
        return None;
    }
    let [_, ld, lq, _, _, of_slope_d, of_slope_q] = with.unknowns;
    // The axis whose current moves the voltage more is the better measured.
    let moved = |slope: &dyn Fn(&Mean) -> f64, inductance: f64| means.iter().map(|mean| (inductance * slope(mean)).powi(2)).sum::<f64>();
    let by_d = moved(&|mean| mean.slope.d, of_slope_d);
    let by_q = moved(&|mean| mean.slope.q, of_slope_q);
    let ratio = if by_d > by_q && ld > 0.0 { of_slope_d / ld } else { of_slope_q / lq };
    let power = (ratio.log10() / 3.0).round();
    let is_power = ratio > 0.0 && ratio.is_finite() && power != 0.0 && (ratio.log10() - 3.0 * power).abs() < HALF_A_DECADE;
    is_power.then(|| ColumnFinding::TimeUnit { factor: 1e3_f64.powi(-power as i32) })
}

/// Noise of the slopes makes their inductance smaller, but not three times.
const HALF_A_DECADE: f64 = 0.5;

/// The changes of signs and order that are looked for, the usual ones first.
const CHANGES: [Change; 11] = [
    Change::ReverseCurrents,
    Change::SwapAxes,
    Change::ReverseSpeed,
    Change::ReverseAxes,
    Change::SwapCurrents,
    Change::SwapVoltages,
    Change::ReverseUd,
    Change::ReverseUq,
    Change::ReverseId,
    Change::ReverseIq,
    Change::ReverseVoltages,
];

/// Whether nothing but noise moves the currents. Then a controller's answer to it is all that there is in the voltages, and with exchanged
/// columns that passes for a motor's; it is gone from means of many rows, while what wrong columns do is not.
fn stands_still(means: &[Mean], peak: f64) -> bool {
    let axes: [fn(&Mean) -> f64; 2] = [|mean| mean.i.d, |mean| mean.i.q];
    axes.iter().all(|i| {
        let middle = means.iter().map(i).sum::<f64>() / means.len() as f64;
        let spread = means.iter().map(|mean| (i(mean) - middle).powi(2)).sum::<f64>();
        let changes = means.windows(2).map(|pair| (i(&pair[1]) - i(&pair[0])).powi(2)).sum::<f64>();
        // Of white noise they are twice as much (J. von Neumann, Ann. Math. Stat. 12 (1941) 367, doi:10.1214/aoms/1177731677).
        changes > spread && spread < (SMALL * peak).powi(2) * means.len() as f64
    })
}

/// Whether a motor explains the voltages only with other signs, or another order of the axes.
pub(super) fn axes(log: &Log) -> Option<ColumnFinding> {
    let mut means = means(log);
    if stands_still(&means, log.peak_current()) {
        means = means.chunks((means.len() / LEAST).max(1)).map(Mean::of).collect();
    }
    let now = fit(&means, &Frame::AS_IT_IS, true)?.left;
    if now < UNEXPLAINED {
        return None;
    }
    let left = |changes: &[Change]| {
        let frame = changes.iter().fold(Frame::AS_IT_IS, |frame, change| frame.with(*change));
        fit(&means, &frame, true).map(|fit| fit.left)
    };
    let singles = CHANGES.iter().map(|change| vec![*change]);
    let pairs = || CHANGES.iter().enumerate().flat_map(|(k, one)| CHANGES[k + 1..].iter().map(|other| vec![*one, *other]));
    let (changes, left) = best_of(singles, &left, now).or_else(|| best_of(pairs(), &left, now))?;
    // Voltages that act later than the instant of their row look like wrong columns, and are more usual.
    (left_if_turned(&means) > (AS_GOOD * left).max(TURN)).then_some(ColumnFinding::Axes { changes, left, left_now: now })
}

/// What no motor explains of the voltages as they are, as a fraction; nothing where the log has too few rows with current at speed.
pub(super) fn left_of_voltages(log: &Log) -> Option<f64> {
    fit(&means(log), &Frame::AS_IT_IS, true).map(|fit| fit.left)
}

/// Whether the voltages are explained far better turned with the speed, as those are that act later than the instant of their row.
pub(crate) fn turn_with_speed(log: &Log) -> bool {
    let means = means(log);
    let now = fit(&means, &Frame::AS_IT_IS, true).map(|fit| fit.left).filter(|left| *left >= UNEXPLAINED);
    now.is_some_and(|now| left_if_turned(&means) <= MUCH_LESS * now)
}

/// Largest angle, rad, by which voltages that lag are turned at the largest speed. Drives without compensation turn them by 0.1 to 0.25;
/// beyond 0.4, exchanged axes look like a turn.
const MOST_TURNED: f64 = 0.4;

/// Step of the angles that are tried, rad. A turn that misses by an angle leaves at most that fraction of the voltages.
const TURN: f64 = 0.01;

/// What the best turn with the speed leaves of the voltages, as a fraction.
fn left_if_turned(means: &[Mean]) -> f64 {
    let fastest = means.iter().fold(0.0_f64, |most, mean| most.max(mean.omega.abs()));
    let turned = |turn: i32| -> Vec<Mean> {
        let per_speed = TURN * f64::from(turn) / fastest;
        means.iter().map(|mean| Mean { u: mean.u.turned(per_speed * mean.omega), ..*mean }).collect()
    };
    let most = (MOST_TURNED / TURN) as i32;
    let fits = (-most..=most).filter_map(|turn| fit(&turned(turn), &Frame::AS_IT_IS, true));
    fits.fold(f64::INFINITY, |least, fit| least.min(fit.left))
}

/// The best of these changes, and those as good, with what the best leaves, if that is much less than `now`.
fn best_of(
    changes: impl Iterator<Item = Vec<Change>>,
    left: &impl Fn(&[Change]) -> Option<f64>,
    now: f64,
) -> Option<(Vec<Vec<Change>>, f64)> {
    let mut tried: Vec<(Vec<Change>, f64)> = changes.filter_map(|changes| left(&changes).map(|left| (changes, left))).collect();
    // Stable: of those that are equal the more usual is named first.
    tried.sort_by(|one, other| one.1.total_cmp(&other.1));
    let best = tried.first()?.1;
    if best > MUCH_LESS * now {
        return None;
    }
    let as_good = |(_, left): &(Vec<Change>, f64)| *left <= AS_GOOD * best;
    let changes: Vec<Vec<Change>> = tried.into_iter().take_while(as_good).map(|(changes, _)| changes).collect();
    Some((changes, best))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Columns;

    /// 1200 rows at 10 kHz of a motor of 12 ohm, 65 and 150 mH and 0.45 Wb that is held at one point: all that moves is noise of its
    /// sensors, some percents of 1.25 A, and what a controller of 2600 rad/s makes of it.
    #[test]
    fn a_controllers_answer_to_noise_is_no_sign_of_wrong_columns() {
        let (rs, ld, lq, psi_f, omega_e, iq, bandwidth, rows) = (12.0, 0.065, 0.15, 0.45, 114.0, 1.25, 2600.0, 1200);
        // Digits far behind the point are as good as noise.
        let digits = |number: usize| (1e4 * (number as f64).sin()).fract();
        let noise: Vec<[f64; 2]> = (0..rows).map(|row| [digits(2 * row), digits(2 * row + 1)].map(|digits| 0.05 * digits)).collect();
        let each = |value: &dyn Fn(usize) -> f64| (0..rows).map(value).collect::<Vec<f64>>();
        let log = Log::new(Columns {
            t: each(&|row| 1e-4 * row as f64),
            ud: each(&|row| -omega_e * lq * iq - bandwidth * ld * noise[row][0]),
            uq: each(&|row| rs * iq + omega_e * psi_f - bandwidth * lq * noise[row][1]),
            id: each(&|row| noise[row][0]),
            iq: each(&|row| iq + noise[row][1]),
            omega_e: each(&|_| omega_e),
            ..Columns::default()
        })
        .unwrap();
        assert!(left_of_voltages(&log).is_some_and(|left| left > UNEXPLAINED));
        assert_eq!(axes(&log), None);
    }
}

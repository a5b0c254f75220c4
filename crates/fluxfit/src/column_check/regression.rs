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
const BLOCK: usize = 10;

/// Means that are enough: a short log has fewer rows in each.
const ENOUGH: usize = 300;

/// Fewest means.
const LEAST: usize = 30;

/// Rows with less current or speed than this share of the largest tell little.
const SMALL: f64 = 0.05;

/// What no motor explains of the voltage as it is, as a fraction, before a change is looked for.
const UNEXPLAINED: f64 = 0.03;

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

/// The unknowns: R, L_d, L_q, psi, V; and the two inductances of the slopes, which may have any sign.
const UNKNOWNS: usize = 7;

/// Unknowns that are not negative.
const BOUNDED: usize = 5;

/// A mean of rows: voltage, current, the current's direction, its slope, omega i and omega.
#[derive(Clone, Copy, Default)]
struct Mean {
    /// Whether the current jumps from a row to the next.
    jumps: bool,
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
    /// Without the slopes of noise: what a controller makes of it is no voltage of theirs, and grows with the time between rows.
    fn without_noise(self) -> Self {
        let [d, q] = self.changes;
        Self { slope: Dq { d: if d { self.slope.d } else { 0.0 }, q: if q { self.slope.q } else { 0.0 } }, ..self }
    }

    /// Of neighbours that have as many rows each.
    fn of(means: &[Self]) -> Self {
        let over = |value: &dyn Fn(&Self) -> f64| means.iter().map(value).sum::<f64>() / means.len() as f64;
        let of = |value: &dyn Fn(&Self) -> Dq| Dq { d: over(&|mean| value(mean).d), q: over(&|mean| value(mean).q) };
        Self {
            jumps: means.iter().any(|mean| mean.jumps),
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
struct Frame {
    swap_u: bool,
    swap_i: bool,
    u: [f64; 2],
    i: [f64; 2],
    omega: f64,
}

impl Frame {
    const AS_IT_IS: Self = Self { swap_u: false, swap_i: false, u: [1.0; 2], i: [1.0; 2], omega: 1.0 };

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
struct Fit {
    left: f64,
    unknowns: [f64; UNKNOWNS],
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
fn means(log: &Log) -> Vec<Mean> {
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
            let mut mean = Mean::default();
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
fn fit(means: &[Mean], frame: &Frame, has_slopes: bool) -> Option<Fit> {
    if means.len() < LEAST { None } else { solved(&normal(means, frame, has_slopes)) }
}

/// The normal equations of the unknowns, with the voltage behind them.
fn normal(means: &[Mean], frame: &Frame, has_slopes: bool) -> DMatrix<f64> {
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
fn solved(normal: &DMatrix<f64>) -> Option<Fit> {
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
        return of_slopes(log, &means, LEAST_SCALE);
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

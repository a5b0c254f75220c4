//! Transitions at every speed of a log, without a matrix exponential per row: each number of the [transition](super::transition) is a
//! polynomial of the squared turn per period.
//!
//! Turning the other way round is the same as reversing the q axis, so `F_dd, F_qq, G_dd, G_qq, h_d` are even functions of the turn
//! `w = omega_e T` and `F_dq, F_qd, G_dq, G_qd, h_q` are odd ones. Both are entire: a polynomial in `w²` through Chebyshev nodes is right
//! to rounding with four to eleven coefficients, from standstill up to half a turn per period. `F` is a sum of the identity and of the
//! rates `M` (Cayley and Hamilton), which gives two of its numbers from the other two.

use super::{
    acting_voltage::{Held, Period},
    transition_lanes::{MotorLanes, TransitionLanes},
};
use crate::lanes::Number;

/// Periods whose lengths agree within this fraction are of one length: what the digits of a time column leave.
const EVEN: f64 = 1e-3;

/// Most different lengths of periods with polynomials of their own; of more, each period is computed exactly. Clocks of recorders jitter by
/// a few percent, which is so many lengths.
const MOST_LENGTHS: usize = 128;

/// So many lengths have polynomials in any log, however short.
const FEW_LENGTHS: usize = 16;

/// Periods that a further length must have on average: the nodes of its polynomials are as many exact transitions.
const LEAST_PERIODS: usize = 30;

/// Numbers of coefficients for which the simulation is compiled.
pub(super) const COEFFICIENTS: [usize; 4] = [4, 5, 7, 11];

/// Largest error of a polynomial, relative to the largest value of its function. Over the thousand rows that a large machine's currents
/// remember it comes to 2e-12 of the current.
const EXACT: f64 = 2e-15;

/// The periods of one length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PeriodClass {
    /// The first of them, s.
    first: f64,
    /// Their mean, s.
    pub(super) length: f64,
    /// Middle and half the range of the squared turns.
    middle: f64,
    reach: f64,
}

impl PeriodClass {
    /// Where a squared turn lies in their range, from -1 to 1.
    fn place(&self, turn: f64) -> f64 {
        if self.reach > 0.0 { (turn * turn - self.middle) / self.reach } else { 0.0 }
    }
}

/// How the transitions of a log are computed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TransitionPlan {
    /// The lengths of its periods; empty if each period is computed exactly.
    pub(super) classes: Vec<PeriodClass>,
    /// Coefficients of each polynomial, one of [`COEFFICIENTS`].
    pub(super) coefficients: usize,
    /// Where the voltage stands still over a period.
    pub(super) held: Held,
}

impl TransitionPlan {
    /// For all periods of a log.
    pub(super) fn of<'a>(periods: impl Iterator<Item = &'a Period> + Clone, held: Held) -> Self {
        let exact = Self { classes: Vec::new(), coefficients: COEFFICIENTS[0], held };
        let mut gathered: Vec<Gathered> = Vec::new();
        for period in periods {
            let square = period.omega_e * period.omega_e;
            if let Some(class) = gathered.iter_mut().find(|class| class.has(period.length)) {
                (class.least, class.most) = (class.least.min(square), class.most.max(square));
                class.total += period.length;
                class.periods += 1.0;
            } else if gathered.len() < MOST_LENGTHS {
                gathered.push(Gathered { first: period.length, total: period.length, periods: 1.0, least: square, most: square });
            } else {
                return exact;
            }
        }
        let total: f64 = gathered.iter().map(|class| class.periods).sum();
        if gathered.len() > FEW_LENGTHS && total < (LEAST_PERIODS * gathered.len()) as f64 {
            return exact;
        }
        let classes: Vec<PeriodClass> = gathered.iter().map(Gathered::class).collect();
        let needed = classes.iter().map(|class| needed(class.middle - class.reach, class.middle + class.reach)).max().unwrap_or(0);
        match COEFFICIENTS.into_iter().find(|coefficients| *coefficients >= needed) {
            Some(coefficients) => Self { classes, coefficients, held },
            None => exact,
        }
    }

    /// Of a period: its class, its place there, and its turn, rad; its own turn where each is computed exactly.
    pub(super) fn place(&self, period: &Period) -> (usize, f64, f64) {
        match self.classes.iter().enumerate().find(|(_, class)| (period.length / class.first - 1.0).abs() < EVEN) {
            Some((number, class)) => {
                let turn = period.omega_e * class.length;
                (number, class.place(turn), turn)
            }
            None => (0, 0.0, period.omega_e * period.length),
        }
    }
}

/// A class while its periods are gathered: their lengths, s, and the squares of their speeds.
struct Gathered {
    first: f64,
    total: f64,
    periods: f64,
    least: f64,
    most: f64,
}

impl Gathered {
    fn has(&self, length: f64) -> bool {
        (length / self.first - 1.0).abs() < EVEN
    }

    fn class(&self) -> PeriodClass {
        let length = self.total / self.periods;
        let (least, most) = (self.least * length * length, self.most * length * length);
        PeriodClass { first: self.first, length, middle: 0.5 * (least + most), reach: 0.5 * (most - least) }
    }
}

/// Coefficients that suit squared turns of this range: the error of a Chebyshev interpolation of `cos w` with `n` of them is
/// `2 (range / 4)ⁿ / (2n)!` at most, that of `sin w`, with one less, `2 w (range / 4)ⁿ⁻¹ / (2n - 1)!`. `F` varies as they do; `G` and `h`
/// up to 1.5 times as fast, because the voltage turns too, but what they add to the current in a period is a small part of it.
fn needed(least: f64, most: f64) -> usize {
    let quarter = (most - least) / 4.0;
    let (mut n, mut even, mut odd) = (1, 2.0 * quarter / 2.0, 2.0 * most.sqrt());
    while even.max(odd) > EXACT || !even.is_finite() {
        n += 1;
        odd = odd * quarter / ((2 * n - 2) * (2 * n - 1)) as f64;
        even = even * quarter / ((2 * n - 1) * (2 * n)) as f64;
        if n > COEFFICIENTS[COEFFICIENTS.len() - 1] {
            break;
        }
    }
    n
}

/// From values at the Chebyshev nodes to coefficients of powers: `C` nodes, for polynomials of as many coefficients, and of one less.
struct Interpolation<const C: usize> {
    nodes: [f64; C],
    even: [[f64; C]; C],
    odd: [[f64; C]; C],
}

impl<const C: usize> Interpolation<C> {
    fn new() -> Self {
        let nodes: [f64; C] = std::array::from_fn(|j| (std::f64::consts::PI * (j as f64 + 0.5) / C as f64).cos());
        let mut interpolation = Self { nodes, even: [[0.0; C]; C], odd: [[0.0; C]; C] };
        // Powers of Chebyshev's polynomials: T_(m+1) = 2 t T_m - T_(m-1).
        let (mut last, mut present) = ([0.0; C], [0.0; C]);
        present[0] = 1.0;
        for m in 0..C {
            for (j, node) in nodes.iter().enumerate() {
                let value = (0..C).rev().fold(0.0, |value, k| value * node + present[k]);
                let weight = value * if m == 0 { 1.0 } else { 2.0 } / C as f64;
                for (k, power) in present.iter().enumerate() {
                    interpolation.even[k][j] += weight * power;
                    if m + 1 < C {
                        interpolation.odd[k][j] += weight * power;
                    }
                }
            }
            let shifted: [f64; C] = std::array::from_fn(|k| if k > 0 { present[k - 1] } else { 0.0 });
            let factor = if m == 0 { 1.0 } else { 2.0 };
            (last, present) = (present, std::array::from_fn(|k| factor * shifted[k] - last[k]));
        }
        interpolation
    }
}

/// The transitions of motors over periods of one length: `C` coefficients of each number, of the odd ones one less and divided by the turn.
#[derive(Clone, Copy)]
pub(super) struct TransitionPolynomials<V, const C: usize> {
    fdd: [V; C],
    fdq: [V; C],
    gdd: [V; C],
    gdq: [V; C],
    gqd: [V; C],
    gqq: [V; C],
    hd: [V; C],
    hq: [V; C],
    /// `(F_qq - F_dd) / (F_dq / w)` and `F_qd / F_dq`.
    qq: V,
    qd: V,
}

/// The turn at a node of a log that stands still, rad: the odd numbers are divided by it.
const LEAST_TURN: f64 = 1e-9;

/// The polynomial with this many coefficients, by Horner's rule.
#[inline(always)]
fn horner<V: Number, const C: usize>(of: &[V; C], coefficients: usize, place: V) -> V {
    let mut value = of[coefficients - 1];
    for k in (0..coefficients - 1).rev() {
        value = value.mul_add(place, of[k]);
    }
    value
}

impl<V: Number, const C: usize> TransitionPolynomials<V, C> {
    #[inline(always)]
    pub(super) fn of(motors: &MotorLanes<V>, class: &PeriodClass, held: Held) -> Self {
        let interpolation = Interpolation::<C>::new();
        let zero = motors.rs.constant(0.0);
        let ratio = motors.ld / motors.lq;
        let length = zero.constant(class.length);
        let [fdd, fdq, gdd, gdq, gqd, gqq, hd, hq] = [[zero; C]; 8];
        let qq = ratio * motors.rs * (length / motors.ld - length / motors.lq);
        let mut whole = Self { fdd, fdq, gdd, gdq, gqd, gqq, hd, hq, qq, qd: -(ratio * ratio) };
        for (j, node) in interpolation.nodes.iter().enumerate() {
            let turn = (class.middle + node * class.reach).max(LEAST_TURN * LEAST_TURN).sqrt();
            let at = TransitionLanes::exact(motors, turn, class.length, held);
            for k in 0..C {
                let (even, odd) = (zero.constant(interpolation.even[k][j]), zero.constant(interpolation.odd[k][j] / turn));
                whole.fdd[k] = even.mul_add(at.fdd, whole.fdd[k]);
                whole.gdd[k] = even.mul_add(at.gdd, whole.gdd[k]);
                whole.gqq[k] = even.mul_add(at.gqq, whole.gqq[k]);
                whole.hd[k] = even.mul_add(at.hd, whole.hd[k]);
                whole.fdq[k] = odd.mul_add(at.fdq, whole.fdq[k]);
                whole.gdq[k] = odd.mul_add(at.gdq, whole.gdq[k]);
                whole.gqd[k] = odd.mul_add(at.gqd, whole.gqd[k]);
                whole.hq[k] = odd.mul_add(at.hq, whole.hq[k]);
            }
        }
        whole
    }

    /// The transitions over a period with this turn, at this place in its class.
    #[inline(always)]
    pub(super) fn at(&self, turn: f64, place: f64) -> TransitionLanes<V> {
        let (turn, place) = (self.qq.constant(turn), self.qq.constant(place));
        let (fdd, slope) = (horner(&self.fdd, C, place), horner(&self.fdq, C - 1, place));
        let fdq = slope * turn;
        TransitionLanes {
            fdd,
            fdq,
            fqd: self.qd * fdq,
            fqq: self.qq.mul_add(slope, fdd),
            gdd: horner(&self.gdd, C, place),
            gdq: horner(&self.gdq, C - 1, place) * turn,
            gqd: horner(&self.gqd, C - 1, place) * turn,
            gqq: horner(&self.gqq, C, place),
            hd: horner(&self.hd, C, place),
            hq: horner(&self.hq, C - 1, place) * turn,
        }
    }
}

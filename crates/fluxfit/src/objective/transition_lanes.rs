//! What one period does to the currents of many motors side by side: the same [transition](super::transition) as the matrix exponential,
//! `i' = F i + G u + h`, by its power series in time.
//!
//! The series is summed over a part of the period in which no motor moves by more than [`PART`], and the part is doubled until it is the
//! whole: C. Moler and C. Van Loan, "Nineteen dubious ways to compute the exponential of a matrix, twenty-five years later", SIAM Review 45
//! (2003) 3, doi:10.1137/S00361445024180, method 3. What is doubled is `F - I`, so that a part much shorter than a time constant keeps
//! its digits.

use super::acting_voltage::Held;
use crate::{lanes::Number, motor::Motor};
use pulp::NullaryFnOnce;

/// Motors, one per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct MotorLanes<V> {
    pub(super) rs: V,
    pub(super) ld: V,
    pub(super) lq: V,
    pub(super) psi_f: V,
}

impl<V> MotorLanes<V> {
    /// Each parameter of all motors, `lanes` having been given how to find it.
    #[inline(always)]
    pub(super) fn of(lanes: impl Fn(fn(&Motor) -> f64) -> V) -> Self {
        Self { rs: lanes(|motor| motor.rs), ld: lanes(|motor| motor.ld), lq: lanes(|motor| motor.lq), psi_f: lanes(|motor| motor.psi_f) }
    }
}

/// One period: `F = [dd dq; qd qq]`, `G` likewise, `h`. The voltage `u` is in the frame at the middle of the period, or stands still in
/// the rotor's.
#[derive(Debug, Clone, Copy)]
pub(super) struct TransitionLanes<V> {
    pub(super) fdd: V,
    pub(super) fdq: V,
    pub(super) fqd: V,
    pub(super) fqq: V,
    pub(super) gdd: V,
    pub(super) gdq: V,
    pub(super) gqd: V,
    pub(super) gqq: V,
    pub(super) hd: V,
    pub(super) hq: V,
}

impl<V: Number> TransitionLanes<V> {
    /// Of no motor.
    #[inline(always)]
    pub(super) fn none(zero: V) -> Self {
        let (fdd, fdq, fqd, fqq) = (zero, zero, zero, zero);
        Self { fdd, fdq, fqd, fqq, gdd: zero, gdq: zero, gqd: zero, gqq: zero, hd: zero, hq: zero }
    }

    /// The current after a period: `F i + G u + h`.
    #[inline(always)]
    pub(super) fn after(&self, i: [V; 2], u: [V; 2]) -> [V; 2] {
        let d = self.gdd.mul_add(u[0], self.gdq.mul_add(u[1], self.hd));
        let q = self.gqq.mul_add(u[1], self.gqd.mul_add(u[0], self.hq));
        [self.fdd.mul_add(i[0], self.fdq.mul_add(i[1], d)), self.fqq.mul_add(i[1], self.fqd.mul_add(i[0], q))]
    }

    /// The same for a difference of two simulations of the same voltage: `F i`.
    #[inline(always)]
    pub(super) fn response(&self, i: [V; 2]) -> [V; 2] {
        [self.fdd.mul_add(i[0], self.fdq * i[1]), self.fqq.mul_add(i[1], self.fqd * i[0])]
    }

    /// The same where the voltages differ: `F i + G u`.
    #[inline(always)]
    pub(super) fn driven_response(&self, i: [V; 2], u: [V; 2]) -> [V; 2] {
        let (d, q) = (self.gdd.mul_add(u[0], self.gdq * u[1]), self.gqq.mul_add(u[1], self.gqd * u[0]));
        [self.fdd.mul_add(i[0], self.fdq.mul_add(i[1], d)), self.fqq.mul_add(i[1], self.fqd.mul_add(i[0], q))]
    }

    /// A period of `length` seconds in which the rotor turns by `turn` electrical radians. Not finite where a motor has no inductance.
    #[inline(always)]
    pub(super) fn exact(motors: &MotorLanes<V>, turn: f64, length: f64, held: Held) -> Self {
        motors.rs.call(Exact { motors, turn, length, held })
    }
}

impl<V: Number> TransitionLanes<V> {
    /// By Euler's rule: the first term of the series alone.
    #[inline(always)]
    fn of_slope(motors: &MotorLanes<V>, turn: f64, length: f64) -> Self {
        let MotorLanes { rs, ld, lq, psi_f } = *motors;
        let (zero, one, turn, length) = (rs.constant(0.0), rs.constant(1.0), rs.constant(turn), rs.constant(length));
        let (gdd, gqq) = (length / ld, length / lq);
        let (fdq, fqd) = (turn * (lq / ld), -(turn * (ld / lq)));
        let (fdd, fqq) = (one - rs * gdd, one - rs * gqq);
        Self { fdd, fdq, fqd, fqq, gdd, gdq: zero, gqd: zero, gqq, hd: zero, hq: -(turn * psi_f / lq) }
    }
}

/// An exact transition.
struct Exact<'a, V> {
    motors: &'a MotorLanes<V>,
    turn: f64,
    length: f64,
    held: Held,
}

impl<V: Number> NullaryFnOnce for Exact<'_, V> {
    type Output = TransitionLanes<V>;

    #[inline(always)]
    fn call(self) -> TransitionLanes<V> {
        // How far the voltage turns backward against the rotor.
        let turn = match self.held {
            Held::InStator => self.turn,
            Held::InRotor => 0.0,
            Held::WithSlope => return TransitionLanes::of_slope(self.motors, self.turn, self.length),
        };
        let (mut series, most) = Series::of(self.motors, self.turn, turn, self.length);
        for doubled in 0..most {
            series.double(doubled);
        }
        // The voltage at the period's start is the middle's, half a turn ahead.
        let (sin, cos) = (0.5 * turn).sin_cos();
        series.turned_to_middle(sin, cos)
    }
}

/// Largest norm of the rates times the part of the period that is summed as a series.
const PART: f64 = 0.25;

/// Terms of the series: the next one is 0.25¹⁴ / 14! = 4e-20 of the sum.
const TERMS: u32 = 13;

/// Most doublings, of rates up to four million times the period: rows a second apart at 10000 rad/s need 16. Beyond, the current follows
/// the voltage at once, which is no winding's, and the transition is no number: a log without sense must not take longer than another.
const MOST_DOUBLINGS: u32 = 24;

/// The transitions over a part of a period, the voltage in the frame at its start.
struct Series<V> {
    /// `F - I`, row by row.
    e: [V; 4],
    /// `G`, row by row.
    g: [V; 4],
    h: [V; 2],
    /// How the voltage turns against the rotor over the part.
    cos: V,
    sin: V,
    /// How often the part is to be doubled.
    doublings: V,
}

#[inline(always)]
fn larger<V: Number>(one: V, other: V) -> V {
    one.if_less(other, other, one)
}

/// Product of two matrices, row by row.
#[inline(always)]
fn product<V: Number>(a: [V; 4], b: [V; 4]) -> [V; 4] {
    [a[0].mul_add(b[0], a[1] * b[2]), a[0].mul_add(b[1], a[1] * b[3]), a[2].mul_add(b[0], a[3] * b[2]), a[2].mul_add(b[1], a[3] * b[3])]
}

impl<V: Number> Series<V> {
    /// Over a part of the period, and the most doublings of any lane.
    #[inline(always)]
    fn of(motors: &MotorLanes<V>, turn: f64, voltage_turn: f64, length: f64) -> (Self, u32) {
        let MotorLanes { rs, ld, lq, psi_f } = *motors;
        let (zero, one) = (rs.constant(0.0), rs.constant(1.0));
        let (turn, voltage_turn, length) = (rs.constant(turn), rs.constant(voltage_turn), rs.constant(length));
        // Rates times the period: of the currents, row by row; of a volt along either axis; of the magnet.
        let (volt_d, volt_q, ratio) = (length / ld, length / lq, ld / lq);
        let rates = [-(rs * volt_d), turn * (lq / ld), -(turn * ratio), -(rs * volt_q)];
        let norm = larger(larger(rates[0].abs() + rates[1].abs(), rates[2].abs() + rates[3].abs()), turn.abs());
        // Halved until the norm is small enough.
        let (mut part, mut doublings, mut most) = (one, zero, 0);
        let limit = one.constant(PART);
        while most < MOST_DOUBLINGS && limit.any_less(norm * part) {
            let rest = norm * part;
            part = limit.if_less(rest, part * one.constant(0.5), part);
            doublings = limit.if_less(rest, doublings + one, doublings);
            most += 1;
        }
        part = limit.if_less(norm * part, one.constant(f64::NAN), part);
        let m = [rates[0] * part, rates[1] * part, rates[2] * part, rates[3] * part];
        let (volt_d, volt_q, w, backward) = (volt_d * part, volt_q * part, turn * part, voltage_turn * part);
        // The present terms: of the current after a unit current along d and q, after a unit voltage along d and q, after the magnet; and
        // the voltage's own vector along d. Along q it is the same, a right angle ahead.
        let (mut f, mut g, mut h, mut u) = ([one, zero, zero, one], [zero; 4], [zero; 2], [one, zero]);
        let mut sum = Self { e: [zero; 4], g: [zero; 4], h: [zero; 2], cos: one, sin: zero, doublings };
        for term in 1..=TERMS {
            let by = one.constant(1.0 / f64::from(term));
            let driven = [volt_d * u[0], -(volt_d * u[1]), volt_q * u[1], volt_q * u[0]];
            let (grown, moved) = (product(m, f), product(m, g));
            let magnet = if term == 1 { -(w * psi_f / lq) } else { zero };
            h = [by * m[0].mul_add(h[0], m[1] * h[1]), by.mul_add(m[2].mul_add(h[0], m[3] * h[1]), magnet)];
            u = [by * backward * u[1], -(by * backward * u[0])];
            for k in 0..4 {
                f[k] = by * grown[k];
                g[k] = by * (moved[k] + driven[k]);
                sum.e[k] = sum.e[k] + f[k];
                sum.g[k] = sum.g[k] + g[k];
            }
            sum.h = [sum.h[0] + h[0], sum.h[1] + h[1]];
            (sum.cos, sum.sin) = (sum.cos + u[0], sum.sin - u[1]);
        }
        (sum, most)
    }

    /// Twice the part, for those that are not yet the whole period.
    #[inline(always)]
    fn double(&mut self, doubled: u32) {
        let Self { e, g, h, cos, sin, doublings } = *self;
        let (doubled, two) = (cos.constant(f64::from(doubled)), cos.constant(2.0));
        let (ee, eg, turned) = (product(e, e), product(e, g), product(g, [cos, sin, -sin, cos]));
        for k in 0..4 {
            self.e[k] = doubled.if_less(doublings, two.mul_add(e[k], ee[k]), e[k]);
            self.g[k] = doubled.if_less(doublings, g[k] + eg[k] + turned[k], g[k]);
        }
        self.h[0] = doubled.if_less(doublings, two.mul_add(h[0], e[0].mul_add(h[0], e[1] * h[1])), h[0]);
        self.h[1] = doubled.if_less(doublings, two.mul_add(h[1], e[2].mul_add(h[0], e[3] * h[1])), h[1]);
        self.cos = doubled.if_less(doublings, cos.mul_add(cos, -(sin * sin)), cos);
        self.sin = doubled.if_less(doublings, two * sin * cos, sin);
    }

    /// With the voltage in the frame at the middle of the period, half a turn (sine, cosine) later.
    #[inline(always)]
    fn turned_to_middle(&self, sin: f64, cos: f64) -> TransitionLanes<V> {
        let Self { e, g, h, .. } = *self;
        let (sin, cos, one) = (h[0].constant(sin), h[0].constant(cos), h[0].constant(1.0));
        TransitionLanes {
            fdd: one + e[0],
            fdq: e[1],
            fqd: e[2],
            fqq: one + e[3],
            gdd: cos.mul_add(g[0], sin * g[1]),
            gdq: cos.mul_add(g[1], -(sin * g[0])),
            gqd: cos.mul_add(g[2], sin * g[3]),
            gqq: cos.mul_add(g[3], -(sin * g[2])),
            hd: h[0],
            hq: h[1],
        }
    }
}

//! What dead time and device drops take from a switching period, given the current at the instants at which each phase switches.
//!
//! A triangular carrier makes each phase high in the middle part `d` of its period `T`, `d = 1/2 + v/U_dc` for the phase voltage `v` of
//! space vector modulation. The phase goes up at `low/2` and down at `1 - low/2` of the period, with `low = 1 - d`. Samples are taken at
//! the carrier's extremes, where the ripple is zero. At the edges it is not: until phase `x` goes up, phase `y` has been driven by
//!
//! ```text
//! T (max(0, v_y - v_x) - v_y/2 + v_x v_y / U_dc) / 2        V s more than by its mean, less what is common to all phases,
//! ```
//!
//! by as much less until `x` goes down, and the inductances make a current of that. Dead time delays an edge up while current flows out of
//! the phase, an edge down while it flows in: the current at the edge decides, and for a period
//!
//! ```text
//! loss = V (sign i(up) + sign i(down)) / 2,    V = U_dc (dead time) / T.
//! ```
//!
//! What the other phases have lost until then, and not in equal parts, moves that current too. Device drops take their voltage all the
//! time: `V` times the mean of the sign along the way from sample to edge to sample. Where a row is half a carrier period, each phase has
//! one edge in it, up in one row and down in the next.

use super::super::Place;
use crate::{
    frames::{clarke, inverse_clarke},
    lanes::Number,
};

/// What a period loses, a drive per lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SwitchedLoss<V> {
    /// Voltage that each phase loses against its current, V.
    pub(crate) voltage: V,
    /// The part of it that is lost all the time, by devices; the rest is lost at the edges.
    pub(crate) lasting: V,
    /// Phase current, A, from which on all of it is lost.
    pub(crate) width: V,
    /// The ripple over what it is if a row is a carrier period, or half of one.
    pub(crate) ripple: V,
    /// Zero if a row is a whole carrier period; plus one if it is half of one, and even rows have the edges up; minus one if odd rows do.
    pub(crate) halves: V,
}

/// Which losses any of several drives has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct LossKinds {
    /// At the edges.
    pub(crate) edges: bool,
    /// All the time.
    pub(crate) lasting: bool,
}

impl LossKinds {
    pub(crate) fn any(self) -> bool {
        self.edges || self.lasting
    }
}

impl<V: Number> SwitchedLoss<V> {
    /// The voltage, V, that is lost over a period, in the frame of the logged angle, given the commanded voltage `u`, V, the currents at
    /// its start and at its end if nothing were lost, A, all `d, q` in that frame, and the inverse inductances of both axes, 1/H.
    #[inline(always)]
    pub(crate) fn over(&self, kinds: LossKinds, u: [V; 2], [start, end]: [[V; 2]; 2], per_henry: [V; 2], place: &Place) -> [V; 2] {
        let (zero, half, one) = (self.voltage.constant(0.0), self.voltage.constant(0.5), self.voltage.constant(1.0));
        // The rotor turns under a voltage that stands still: the way from sample to sample is bent.
        let turn = zero.constant(place.omega_e * place.length);
        let pushed = half * turn * zero.constant(place.length);
        let bend = [
            half * turn * turn * start[0] - pushed * per_henry[0] * u[1],
            half * turn * turn * start[1] + pushed * per_henry[1] * u[0],
        ];
        let bend = inverse_clarke(place.middle.forward(bend));
        let (start, end) = (inverse_clarke(place.start.forward(start)), inverse_clarke(place.end.forward(end)));
        let v = modulated(inverse_clarke(place.middle.forward(u)));
        let per_bus = zero.constant(place.per_bus);
        let (mut low, mut out) = ([zero; 3], [zero; 3]);
        for x in 0..3 {
            low[x] = half - v[x] * per_bus;
            out[x] = half * (one + ramp(half * (start[x] + end[x]), self.width));
        }
        // The carrier's period over the row's.
        let carrier = one + self.halves.abs();
        let rising = half * (one + self.halves * zero.constant(place.half));
        let whole = one - self.halves.abs();
        let seconds = self.ripple * carrier * zero.constant(place.length);
        let amperes = [seconds * per_henry[0], seconds * per_henry[1]];
        let mut loss = [zero; 3];
        for x in 0..3 {
            let (mut until_up, mut until_down) = ([zero; 3], [zero; 3]);
            for y in 0..3 {
                let ahead = v[y] - v[x];
                let commanded = half * (zero.if_less(ahead, ahead, zero) - half * v[y] + v[x] * v[y] * per_bus);
                let (before, after) = (zero.if_less(ahead, one, zero), ahead.if_less(zero, one, zero));
                let lost = self.voltage * (one - self.lasting);
                until_up[y] = commanded - lost * out[y] * before;
                until_down[y] = lost * ((one - out[y]) * after - whole * out[y]) - commanded;
            }
            let (when, way) = (half * carrier * low[x], end[x] - start[x]);
            let bent = when * (one - when) * bend[x];
            let up = when.mul_add(way, start[x]) + bent + driven(until_up, amperes, place)[x];
            let down = (one - when).mul_add(way, start[x]) + bent + driven(until_down, amperes, place)[x];
            if kinds.edges {
                let at_edges = rising * ramp(up, self.width) + (one - rising) * ramp(down, self.width);
                loss[x] = (one - self.lasting) * at_edges;
            }
            if kinds.lasting {
                let half_way = half * carrier * way;
                let (top, bottom) = (start[x] + half_way, end[x] - half_way);
                let of_up = low[x] * mean_of_ramp(start[x], up, self.width) + (one - low[x]) * mean_of_ramp(up, top, self.width);
                let of_down = (one - low[x]) * mean_of_ramp(bottom, down, self.width) + low[x] * mean_of_ramp(down, end[x], self.width);
                loss[x] = loss[x] + self.lasting * (rising * of_up + (one - rising) * of_down);
            }
        }
        let [d, q] = place.middle.backward(clarke(loss));
        [self.voltage * d, self.voltage * q]
    }
}

/// Phase voltages as space vector modulation makes them: all shifted alike, so that the highest is as far from its limit as the lowest.
#[inline(always)]
fn modulated<V: Number>(u: [V; 3]) -> [V; 3] {
    let middle = u[0].constant(0.5) * (lower(u[0], lower(u[1], u[2])) - lower(-u[0], lower(-u[1], -u[2])));
    [u[0] - middle, u[1] - middle, u[2] - middle]
}

/// The lower of two numbers.
#[inline(always)]
fn lower<V: Number>(a: V, b: V) -> V {
    a.if_less(b, a, b)
}

/// Phase currents, A, of flux linkages of the phases that differ, each `linked` times what makes `amperes` of a volt along d and q.
#[inline(always)]
fn driven<V: Number>(linked: [V; 3], amperes: [V; 2], place: &Place) -> [V; 3] {
    let [d, q] = place.middle.backward(clarke(linked));
    inverse_clarke(place.middle.forward([amperes[0] * d, amperes[1] * q]))
}

/// `i / width`, but at most one and at least minus one.
#[inline(always)]
fn ramp<V: Number>(i: V, width: V) -> V {
    let (zero, one) = (i.constant(0.0), i.constant(1.0));
    let sign = zero.if_less(i, one, i.if_less(zero, -one, zero));
    i.abs().if_less(width, i / width, sign)
}

/// A way this short, as a fraction of its ends, leaves no digits in a difference of integrals.
const SHORT: f64 = 1e-6;

/// Mean of the ramp while its argument goes from one value to another.
#[inline(always)]
fn mean_of_ramp<V: Number>(from: V, to: V, width: V) -> V {
    // Over a short way the ramp is straight, or about to be.
    let straight = ramp(from.constant(0.5) * (from + to), width);
    let way = to - from;
    let long = from.constant(SHORT) * (from.abs() + to.abs());
    long.if_less(way.abs(), (integral_of_ramp(to, width) - integral_of_ramp(from, width)) / way, straight)
}

/// The ramp's integral: a parabola up to the width, straight from there on.
#[inline(always)]
fn integral_of_ramp<V: Number>(i: V, width: V) -> V {
    let (zero, half) = (i.constant(0.0), i.constant(0.5));
    let beyond = zero.if_less(width, half * width, zero);
    i.abs().if_less(width, half * i * i / width, i.abs() - beyond)
}

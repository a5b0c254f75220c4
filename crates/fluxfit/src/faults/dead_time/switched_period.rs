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
//!
//! One late edge of two makes the pulse late, too, by half the dead time: the mean current of the period lies below the way from sample to
//! sample by `u (dead time) / (2 L)`, and the resistance takes so much less. It looks like less flux.

use super::{super::Place, DeadTime};
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
    pub(crate) fn of(dead_time: &DeadTime) -> Self {
        let loses = dead_time.voltage != 0.0;
        Self { edges: loses && dead_time.lasting != 1.0, lasting: loses && dead_time.lasting != 0.0 }
    }

    /// Those that either has.
    pub(crate) fn or(self, other: Self) -> Self {
        Self { edges: self.edges || other.edges, lasting: self.lasting || other.lasting }
    }

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
        let turn = place.omega_e * place.length;
        let (pulled, pushed) = (zero.constant(0.5 * turn * turn), zero.constant(0.5 * turn * place.length));
        let bend = [pulled.mul_add(start[0], -(pushed * per_henry[0] * u[1])), pulled.mul_add(start[1], pushed * per_henry[1] * u[0])];
        let bend = inverse_clarke(place.middle.forward(bend));
        let (start, end) = (inverse_clarke(place.start.forward(start)), inverse_clarke(place.end.forward(end)));
        let v = modulated(inverse_clarke(place.middle.forward(u)));
        let per_bus = zero.constant(place.per_bus);
        // The carrier's period over the row's.
        let carrier = one + self.halves.abs();
        let rising = half * (one + self.halves * zero.constant(place.half));
        let amperes = by_volt_seconds(self.ripple * carrier * zero.constant(place.length), per_henry, place);
        // By how much each phase is later than each other one, V: by that over the DC voltage, and half a period, it switches after it.
        let mut later = [[zero; 3]; 3];
        for x in 0..3 {
            for y in [(x + 1) % 3, (x + 2) % 3] {
                later[x][y] = zero.higher(v[y] - v[x]);
            }
        }
        // The currents at the edges, but for what the others lose before.
        let (mut low, mut up, mut down) = ([zero; 3], [zero; 3], [zero; 3]);
        for x in 0..3 {
            low[x] = (-v[x]).mul_add(per_bus, half);
            let mut together = amperes[x][x] * v[x];
            let mut ahead = zero;
            for y in [(x + 1) % 3, (x + 2) % 3] {
                together = amperes[x][y].mul_add(v[y], together);
                ahead = amperes[x][y].mul_add(later[x][y], ahead);
            }
            // What all phases have been driven by beyond their mean until `x` goes up, as a current in `x`.
            let commanded = half * (-low[x]).mul_add(together, ahead);
            let (when, way) = (half * carrier * low[x], end[x] - start[x]);
            let bent = when * (one - when) * bend[x];
            up[x] = when.mul_add(way, start[x]) + bent + commanded;
            down[x] = (one - when).mul_add(way, start[x]) + bent - commanded;
        }
        // Edge by edge: what the phases that switch before have lost, as far as their dead time is over. What is up later is down earlier.
        let ramp = Ramp::of(self.width);
        let lost = self.voltage * (one - self.lasting);
        let (mut before_up, mut before_down) = ([[zero; 3]; 3], [[zero; 3]; 3]);
        for x in 0..3 {
            // A phase does not wait for itself.
            for y in [(x + 1) % 3, (x + 2) % 3] {
                let until = (half * later[x][y]).lower(lost);
                before_up[x][y] = amperes[x][y] * until;
                before_down[y][x] = amperes[y][x] * until;
            }
        }
        let up = after_others(up, before_up, ramp);
        let out = ramp.out(up);
        let risen = lost * (one - self.halves.abs());
        let mut mirrored = [zero; 3];
        for x in 0..3 {
            mirrored[x] = -down[x];
            for y in 0..3 {
                mirrored[x] = (amperes[x][y] * risen).mul_add(out[y], mirrored[x]);
            }
        }
        // An edge down gives where an edge up takes.
        let mirrored = after_others(mirrored, before_down, ramp);
        let mut loss = [zero; 3];
        for x in 0..3 {
            let (up, down) = (up[x], -mirrored[x]);
            if kinds.edges {
                let (at_up, at_down) = (ramp.at(up), ramp.at(down));
                let at_edges = rising.mul_add(at_up - at_down, at_down);
                loss[x] = (one - self.lasting) * at_edges;
            }
            if kinds.lasting {
                let half_way = half * carrier * (end[x] - start[x]);
                let (top, bottom) = (start[x] + half_way, end[x] - half_way);
                let of_up = ramp.means([start[x], up, top], [low[x], one - low[x]]);
                let of_down = ramp.means([bottom, down, end[x]], [one - low[x], low[x]]);
                loss[x] = loss[x] + self.lasting * of_up.times(rising).plus(of_down.times(one - rising)).value();
            }
        }
        let [d, q] = place.middle.backward(clarke(loss));
        [self.voltage * d, self.voltage * q]
    }

    /// The voltage, V, that the resistance, ohm, takes less in a period with the voltage `u`, V, because pulses come late. Of a
    /// row that is half a carrier period nothing is said.
    #[inline(always)]
    pub(crate) fn spared(&self, u: [V; 2], rs: V, per_henry: [V; 2], place: &Place) -> [V; 2] {
        let one = self.voltage.constant(1.0);
        let at_edges = self.voltage * (one - self.lasting) * (one - self.halves.abs());
        let late = at_edges * self.voltage.constant(0.5 * place.length * place.per_bus);
        [0, 1].map(|axis| late * rs * per_henry[axis] * u[axis])
    }
}

/// Currents at edges, given what they would be if no phase lost anything in this half of the carrier, and the current, A, that each phase
/// `x` misses at its edge for a phase `y` out of which current flows at its own, at `[x][y]`.
#[inline(always)]
fn after_others<V: Number>(alone: [V; 3], missed: [[V; 3]; 3], ramp: Ramp<V>) -> [V; 3] {
    let mut i = alone;
    // The second phase waits for the first, the third for both.
    for _ in 0..2 {
        let out = ramp.out(i);
        i = alone;
        for x in 0..3 {
            for y in [(x + 1) % 3, (x + 2) % 3] {
                i[x] = (-missed[x][y]).mul_add(out[y], i[x]);
            }
        }
    }
    i
}

/// Phase voltages as space vector modulation makes them: all shifted alike, so that the highest is as far from its limit as the lowest.
#[inline(always)]
fn modulated<V: Number>(u: [V; 3]) -> [V; 3] {
    let middle = u[0].constant(0.5) * (u[0].lower(u[1].lower(u[2])) + u[0].higher(u[1].higher(u[2])));
    [u[0] - middle, u[1] - middle, u[2] - middle]
}

/// Phase currents, A, that a volt over so many seconds on each phase makes: those of phase `x` by phase `y` at `[x][y]`.
#[inline(always)]
fn by_volt_seconds<V: Number>(seconds: V, [per_ld, per_lq]: [V; 2], place: &Place) -> [[V; 3]; 3] {
    let third = seconds.constant(1.0 / 3.0) * seconds;
    let twice = place.middle.twice();
    let (mean, difference) = (third * (per_ld + per_lq), third * (per_ld - per_lq));
    let (cos, sin) = (difference * seconds.constant(twice.cos), difference * seconds.constant(twice.sin));
    // The stator's matrix of inverse inductances, two thirds of it.
    let (alpha, beta, both) = (mean + cos, mean - cos, seconds.constant(0.5 * 3.0_f64.sqrt()) * sin);
    let (half, quarter, three_quarters) = (seconds.constant(0.5), seconds.constant(0.25), seconds.constant(0.75));
    let ab = both - half * alpha;
    let ac = -both - half * alpha;
    let bc = quarter * alpha - three_quarters * beta;
    let bb = quarter * alpha + three_quarters * beta - both;
    let cc = quarter * alpha + three_quarters * beta + both;
    [[alpha, ab, ac], [ab, bb, bc], [ac, bc, cc]]
}

/// `i / width`, but at most one and at least minus one.
#[derive(Clone, Copy)]
struct Ramp<V> {
    width: V,
    per_width: V,
}

/// Width, A, of a ramp that has none: one over it is a number, and so is zero times that.
const NARROWEST: f64 = 1e-100;

/// A way this short, as a fraction of its ends, leaves no digits in a difference of integrals.
const SHORT: f64 = 1e-6;

/// The same, A: shorter than any current, and the product of four such ways is still a number.
const SHORTEST: f64 = 1e-60;

/// A quotient that is not yet divided: a division takes as long as many products, and a sum of quotients needs only one.
#[derive(Clone, Copy)]
struct Fraction<V> {
    above: V,
    below: V,
}

impl<V: Number> Fraction<V> {
    #[inline(always)]
    fn times(self, factor: V) -> Self {
        Self { above: self.above * factor, ..self }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { above: self.above.mul_add(other.below, other.above * self.below), below: self.below * other.below }
    }

    #[inline(always)]
    fn value(self) -> V {
        self.above / self.below
    }
}

impl<V: Number> Ramp<V> {
    #[inline(always)]
    fn of(width: V) -> Self {
        let width = width.higher(width.constant(NARROWEST));
        Self { width, per_width: width.constant(1.0) / width }
    }

    #[inline(always)]
    fn at(self, i: V) -> V {
        let one = i.constant(1.0);
        (i * self.per_width).lower(one).higher(-one)
    }

    /// One where a current flows out of its leg, zero where it flows in.
    #[inline(always)]
    fn out(self, i: [V; 3]) -> [V; 3] {
        let (zero, half, one) = (self.width.constant(0.0), self.width.constant(0.5), self.width.constant(1.0));
        let slope = half * self.per_width;
        let mut out = i;
        for one_out in &mut out {
            *one_out = slope.mul_add(*one_out, half).lower(one).higher(zero);
        }
        out
    }

    /// Its mean while its argument goes from one value to the next and on to the last, each way with a weight of its own.
    #[inline(always)]
    fn means(self, [from, between, to]: [V; 3], weights: [V; 2]) -> Fraction<V> {
        self.mean(from, between).times(weights[0]).plus(self.mean(between, to).times(weights[1]))
    }

    /// Its mean while its argument goes from one value to another.
    #[inline(always)]
    fn mean(self, from: V, to: V) -> Fraction<V> {
        // Over a short way the ramp is straight, or about to be.
        let straight = self.at(from.constant(0.5) * (from + to));
        let way = to - from;
        let long = from.constant(SHORT).mul_add(from.abs() + to.abs(), from.constant(SHORTEST));
        let integrals = self.integral(to) - self.integral(from);
        Fraction { above: long.if_less(way.abs(), integrals, straight), below: long.if_less(way.abs(), way, way.constant(1.0)) }
    }

    /// Its integral: a parabola up to the width, straight from there on.
    #[inline(always)]
    fn integral(self, i: V) -> V {
        // Half the square of the part that lies within the width, over the width, and all that lies beyond.
        let (half, way) = (i.constant(0.5), i.abs());
        let within = way.lower(self.width);
        (half * self.per_width * within).mul_add(within, way - within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Abc, AlphaBeta, Turn};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(from in -3.0..3.0f64, to in -3.0..3.0f64, width in 0.01..2.0f64) {
            const POINTS: u32 = 20_000;
            let point = |k: u32| ((from + (to - from) * (f64::from(k) + 0.5) / f64::from(POINTS)) / width).clamp(-1.0, 1.0);
            let expected = (0..POINTS).map(point).sum::<f64>() / f64::from(POINTS);
            prop_assert!((Ramp::of(width).mean(from, to).value() - expected).abs() < 1e-4);
        }
    }

    /// An inverter of three ideal legs whose edges up come late while current flows out, and edges down while it flows in, and a motor at
    /// rest that is nothing but inductance, H. Time runs in fine steps.
    struct Switched {
        bus: f64,
        dead_time: f64,
        inductance: f64,
        /// Duty ratios of the legs.
        duty: [f64; 3],
    }

    const STEPS: u32 = 50_000;

    impl Switched {
        /// Volt-seconds that each leg loses against its command over a carrier period of one second, from these currents on; in its first
        /// half and in its second.
        fn loses(&self, i: [f64; 3]) -> [[f64; 3]; 2] {
            self.run(i).0
        }

        /// By how much the mean currents lie below the straight way from those at the period's start to those at its end, A.
        fn below_way(&self, i: [f64; 3]) -> [f64; 3] {
            self.run(i).1
        }

        fn run(&self, mut i: [f64; 3]) -> ([[f64; 3]; 2], [f64; 3]) {
            let Self { bus, dead_time, inductance, duty } = *self;
            let (start, mut mean) = (i, [0.0; 3]);
            let (mut lost, mut high, mut late) = ([[0.0; 3]; 2], [false; 3], [0.0; 3]);
            let h = 1.0 / f64::from(STEPS);
            for step in 0..STEPS {
                let t = (f64::from(step) + 0.5) * h;
                let mut volts = [0.0; 3];
                for leg in 0..3 {
                    let commanded = (t - 0.5).abs() < 0.5 * duty[leg];
                    if commanded != high[leg] {
                        // Both switches open, and a diode holds what the current's direction asks for.
                        let waits = commanded == (i[leg] > 0.0);
                        (high[leg], late[leg]) = (commanded, if waits { t + dead_time } else { 0.0 });
                    }
                    let output = if t < late[leg] { !commanded } else { commanded };
                    lost[usize::from(t > 0.5)][leg] += bus * h * (f64::from(u8::from(commanded)) - f64::from(u8::from(output)));
                    // In the rotor's frame, the motor's voltage is what holds the current where it is, in the mean of the command.
                    volts[leg] = bus * (f64::from(u8::from(output)) - duty[leg]);
                }
                let star = volts.iter().sum::<f64>() / 3.0;
                for leg in 0..3 {
                    let grown = (volts[leg] - star) * h / inductance;
                    mean[leg] += (i[leg] + 0.5 * grown) * h;
                    i[leg] += grown;
                }
            }
            (lost, std::array::from_fn(|leg| 0.5 * (start[leg] + i[leg]) - mean[leg]))
        }
    }

    /// The mean current of a period lies below the way from sample to sample by what late pulses make of it.
    #[test]
    fn the_resistance_takes_less_where_pulses_are_late() {
        let (bus, dead_time, inductance, rs) = (2.0, 0.02, 1.0, 0.3);
        let v = modulated([0.7, -0.2, -0.5]);
        let below = |dead_time: f64| {
            let switched = Switched { bus, dead_time, inductance, duty: v.map(|v| 0.5 + v / bus) };
            alpha_beta(switched.below_way([5.0, -2.0, -3.0]))
        };
        let (with, without) = (below(dead_time), below(0.0));
        let loss = SwitchedLoss { voltage: bus * dead_time, lasting: 0.0, width: 1e-9, ripple: 1.0, halves: 0.0 };
        let place = Place { per_bus: 1.0 / bus, ..Place::still(Turn::by(0.0)) };
        // Each leg loses the dead time's voltage against its current.
        let left = alpha_beta([v[0] - bus * dead_time, v[1] + bus * dead_time, v[2] + bus * dead_time]);
        let spared = loss.spared(left, rs, [1.0 / inductance; 2], &place);
        for axis in 0..2 {
            let expected = rs * (with[axis] - without[axis]);
            assert!((spared[axis] - expected).abs() < 0.02 * (spared[0].hypot(spared[1])), "{axis}: {spared:?}, not {expected}");
        }
    }

    fn alpha_beta([a, b, c]: [f64; 3]) -> [f64; 2] {
        let AlphaBeta { alpha, beta } = Abc { a, b, c }.to_alpha_beta();
        [alpha, beta]
    }

    /// The period loses what the switched inverter loses, whatever the voltage and the currents, ripple and edges that move each other
    /// included: both with a row per period and with a row per half of it.
    #[test]
    fn a_period_loses_what_a_switched_inverter_loses() {
        let mut differ = 0;
        for (angle, modulation, current, at, dead_time) in [
            (0.1, 0.8, 1.0, 1.5, 0.01),
            (0.1, 0.8, 0.3, 1.6, 0.01),
            (0.9, 0.5, 0.2, 0.5, 0.02),
            (2.0, 0.6, 0.15, 3.1, 0.03),
            (3.3, 0.3, 0.1, 4.6, 0.03),
            (4.0, 0.05, 0.1, 5.2, 0.03),
            (5.5, 0.7, 0.4, 0.52, 0.02),
            (0.5, 0.9, 0.05, 2.2, 0.01),
        ] {
            let (bus, inductance) = (2.0, 1.0);
            let vector = |length: f64, angle: f64| {
                let Abc { a, b, c } = AlphaBeta { alpha: length * f64::cos(angle), beta: length * f64::sin(angle) }.to_abc();
                [a, b, c]
            };
            let v = modulated(vector(modulation * bus / 3.0_f64.sqrt(), angle));
            let i = vector(current, at);
            let lost = Switched { bus, dead_time, inductance, duty: v.map(|v| 0.5 + v / bus) }.loses(i);
            for (halves, length) in [(0.0, 1.0), (1.0, 0.5)] {
                let loss = SwitchedLoss { voltage: bus * dead_time, lasting: 0.0, width: 1e-9, ripple: 1.0, halves };
                for (half, in_half) in [1.0, -1.0].into_iter().zip(lost) {
                    let place = Place { half, length, per_bus: 1.0 / bus, ..Place::still(Turn::by(0.0)) };
                    let kinds = LossKinds { edges: true, lasting: false };
                    let found = loss.over(kinds, alpha_beta(v), [alpha_beta(i); 2], [1.0 / inductance; 2], &place);
                    let expected = if halves == 0.0 { std::array::from_fn(|leg| lost[0][leg] + lost[1][leg]) } else { in_half };
                    let expected = alpha_beta(expected).map(|volt_seconds| volt_seconds / length);
                    let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
                    assert!(off < 0.02 * bus * dead_time, "{angle} {halves} {half}: {found:?}, not {expected:?}");
                    // Without the ripple it would be another loss, here and there.
                    let plain = SwitchedLoss { ripple: 0.0, ..loss };
                    let plain = plain.over(kinds, alpha_beta(v), [alpha_beta(i); 2], [1.0 / inductance; 2], &place);
                    differ += usize::from((plain[0] - expected[0]).hypot(plain[1] - expected[1]) > 0.1 * bus * dead_time);
                }
            }
        }
        assert!(differ > 5, "{differ}");
    }

    /// A square wave's fundamental is 4/pi; along the current. Lost at edges and all the time it is the same, without ripple.
    #[test]
    fn the_fundamental_is_four_over_pi() {
        const STEPS: u32 = 6000;
        let vector = |k: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(STEPS)).sin_cos();
            [5.0 * cos, 5.0 * sin]
        };
        for (lasting, kinds) in [(0.0, LossKinds { edges: true, lasting: false }), (1.0, LossKinds { edges: false, lasting: true })] {
            let loss = SwitchedLoss { voltage: 1.0, lasting, width: 0.0, ripple: 0.0, halves: 0.0 };
            let along = |k: u32| {
                let (start, end) = (vector(k), vector(k + 1));
                let lost = loss.over(kinds, [0.0; 2], [start, end], [1.0; 2], &Place::still(Turn::by(0.0)));
                (lost[0] * (start[0] + end[0]) + lost[1] * (start[1] + end[1])) / 10.0
            };
            let mean = (0..STEPS).map(along).sum::<f64>() / f64::from(STEPS);
            assert!((mean - 4.0 / std::f64::consts::PI).abs() < 1e-3, "{mean}");
        }
    }
}

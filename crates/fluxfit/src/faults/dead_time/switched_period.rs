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
//! A current that reaches zero within the dead time stays there until it is over, and the leg, which nothing drives, has the voltage that
//! holds it: of the edge's loss a part is left, the smaller the earlier that is. From the current at which an edge loses nothing to that
//! at which it loses all it goes in proportion, over
//!
//! ```text
//! V A_xx,                        A_xy: amperes in phase x per volt on phase y over the period,
//! ```
//!
//! and the middle of that way lies not at zero but at `-V (A_xx + 2 sum A_xy s_y - 2 sum A_xy v_y / U_dc) / 2`, with the part `s_y` of the
//! dead time in which the other legs are up.
//!
//! A drive that samples in the middle of its period has its rows begin where all legs are high. With all signs turned over, of voltages,
//! currents and loss, such a row is a period that begins where they are low. The edges of its first half are those of one command, the
//! edges of the second half those of the next: between them the voltage changes by `change`, and at the part `s` of the period the
//! current lies by `change T min(s, 1 - s) / (2 L)` below the straight way.
//!
//! One late edge of two makes the pulse late, too, by half the dead time: the mean current of the period lies below the way from sample to
//! sample, and the resistance takes so much less. Of phase `x` these are
//!
//! ```text
//! R sum A_xy late_y (U_dc/2 + v_y) (dead time) / (2 T)    V,
//! ```
//!
//! with `late_y` one where a phase's current does not change its direction between its edges, zero where it is in at the edge up and out at
//! the edge down. Where all phases are late it looks like less flux.

use super::{
    super::Place,
    DeadTime,
    half::{Half, modulated},
    ramp::{NARROWEST, Ramp},
};
use crate::{
    frames::{clarke, inverse_clarke, turned},
    lanes::{Number, both},
};

/// What a period loses, a drive per lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SwitchedLoss<V> {
    /// Voltage that each phase loses against its current, V.
    pub(crate) voltage: V,
    /// The part of it that is lost all the time, by devices; the rest is lost at the edges.
    pub(crate) lasting: V,
    /// From which phase current on how much of it is lost.
    ramp: Ramp<V>,
    /// The ripple over what it is if a row is a carrier period, or half of one.
    pub(crate) ripple: V,
    /// Zero if a row is a whole carrier period; plus one if it is half of one, and even rows have the edges up; minus one if odd rows do.
    pub(crate) halves: V,
    /// What the DC voltage is taken for over what it is.
    pub(crate) bus: V,
    /// By how much a phase must be higher than another one to be ahead of it by the dead time: one over that, 1/V.
    pub(crate) per_lead: V,
    /// One if a current that reaches zero within the dead time stays there, else zero.
    pub(crate) clamps: V,
}

/// What a loss depends on of the motor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Winding<V> {
    /// Resistance, ohm.
    pub(crate) rs: V,
    /// Inverse inductances of both axes, 1/H.
    pub(crate) per_henry: [V; 2],
}

impl<V: Number> Winding<V> {
    /// Of the resistance, ohm, and the inductances, H.
    #[inline(always)]
    pub(crate) fn of(rs: V, [ld, lq]: [V; 2]) -> Self {
        let one = rs.constant(1.0);
        Self { rs, per_henry: [one / ld, one / lq] }
    }
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

impl<V> SwitchedLoss<V> {
    /// The loss of a drive per lane.
    #[inline(always)]
    pub(crate) fn of(lanes: impl Fn(&dyn Fn(&DeadTime) -> f64) -> V) -> Self {
        Self {
            voltage: lanes(&|f| f.voltage),
            lasting: lanes(&|f| f.lasting),
            ramp: Ramp::of(|of_width| lanes(&|f| of_width(f.width.hypot(f.least_width)))),
            clamps: lanes(&|f| f.clamps),
            ripple: lanes(&|f| f.ripple),
            halves: lanes(&|f| f.halves),
            bus: lanes(&|f| 1.0 / (1.0 + f.bus)),
            per_lead: lanes(&|f| 0.5 / (f.voltage * (1.0 - f.lasting)).max(NARROWEST)),
        }
    }
}

impl<V: Number> SwitchedLoss<V> {
    /// The voltage, V, that is lost over a period, in the frame of the logged angle, given the commanded voltage `u`, V, the currents at
    /// its start and at its end if nothing were lost, A, all `d, q` in that frame, and the winding. Where phase a is not at the angle's
    /// zero, `phase` is the cosine and sine of its angle.
    #[inline(always)]
    pub(crate) fn over(
        &self,
        kinds: LossKinds,
        u: [V; 2],
        currents: [[V; 2]; 2],
        winding: &Winding<V>,
        phase: Option<[V; 2]>,
        place: &Place,
    ) -> [V; 2] {
        let sign = self.voltage.constant(if place.changes.is_some() { -1.0 } else { 1.0 });
        let u = both!(axis => sign * u[axis]);
        let currents = both!(end => both!(axis => sign * currents[end][axis]));
        // Compiled twice, because one way for both takes a third longer.
        let lost = match place.changes {
            None => self.beginning_low::<false>(kinds, (u, [sign; 2]), currents, winding, phase, place),
            Some(change) => {
                let change = both!(axis => sign * sign.constant(change[axis]));
                self.beginning_low::<true>(kinds, (u, change), currents, winding, phase, place)
            }
        };
        both!(axis => sign * lost[axis])
    }

    /// The same of a period that begins where all legs are low, and of a voltage that changes so much half-way, V, if it does.
    #[inline(always)]
    fn beginning_low<const CHANGES: bool>(
        &self,
        kinds: LossKinds,
        (u, change): ([V; 2], [V; 2]),
        [start, end]: [[V; 2]; 2],
        winding: &Winding<V>,
        phase: Option<[V; 2]>,
        place: &Place,
    ) -> [V; 2] {
        let Winding { rs, per_henry } = *winding;
        let (zero, half, one) = (self.voltage.constant(0.0), self.voltage.constant(0.5), self.voltage.constant(1.0));
        // The rotor turns under a voltage that stands still: the way from sample to sample is bent.
        let turn = place.omega_e * place.length;
        let (pulled, pushed) = (zero.constant(0.5 * turn * turn), zero.constant(0.5 * turn * place.length));
        let bend = [pulled.mul_add(start[0], -(pushed * per_henry[0] * u[1])), pulled.mul_add(start[1], pushed * per_henry[1] * u[0])];
        let bend = inverse_clarke(place.middle.forward(by_phase(bend, phase)));
        let start = inverse_clarke(place.start.forward(by_phase(start, phase)));
        let end = inverse_clarke(place.end.forward(by_phase(end, phase)));
        let v = modulated(inverse_clarke(place.middle.forward(by_phase(u, phase))));
        let per_bus = self.bus * zero.constant(place.per_bus);
        // The carrier's period over the row's.
        let carrier = one + self.halves.abs();
        let rising = half * (one + self.halves * zero.constant(place.half));
        let amperes = by_volt_seconds(self.ripple * carrier * zero.constant(place.length), per_henry, phase, place);
        // The currents at the edges, but for what the others lose before.
        let (mut up, mut down) = ([zero; 3], [zero; 3]);
        let mut first = Half::of(v, per_bus, &amperes);
        let (mut second, mut kink) = (first, [zero; 3]);
        if CHANGES {
            let (before, pull) = ([u[0] - half * change[0], u[1] - half * change[1]], -half * zero.constant(place.length));
            let bent = [pull * per_henry[0] * change[0], pull * per_henry[1] * change[1]];
            let [of_first, of_second] = [before, [before[0] + change[0], before[1] + change[1]]];
            first = Half::of(modulated(inverse_clarke(place.middle.forward(by_phase(of_first, phase)))), per_bus, &amperes);
            second = Half::of(modulated(inverse_clarke(place.middle.forward(by_phase(of_second, phase)))), per_bus, &amperes);
            kink = inverse_clarke(place.middle.forward(by_phase(bent, phase)));
        }
        for x in 0..3 {
            let way = end[x] - start[x];
            let (to_up, from_down) = (half * carrier * first.low[x], half * carrier * second.low[x]);
            let (mut at_up, mut at_down) = (to_up * (one - to_up) * bend[x], from_down * (one - from_down) * bend[x]);
            if CHANGES {
                (at_up, at_down) = (to_up.mul_add(kink[x], at_up), from_down.mul_add(kink[x], at_down));
            }
            up[x] = to_up.mul_add(way, start[x]) + at_up + first.commanded[x];
            down[x] = (one - from_down).mul_add(way, start[x]) + at_down - second.commanded[x];
        }
        let (ramp, mut clamped) = (self.ramp, [zero; 3]);
        if kinds.edges {
            let [a, b, c] = first.together;
            clamped = self.clamped(ramp.out(up), [v, [a * per_bus, b * per_bus, c * per_bus]], &amperes);
            [up, down] = self.edge_by_edge([up, down], clamped, [&first, &second], &amperes);
        }
        let (mut loss, mut late) = ([zero; 3], [zero; 3]);
        for x in 0..3 {
            let (up, down) = (up[x], down[x]);
            if kinds.edges {
                let (at_up, at_down) = (ramp.at(up), ramp.at(down));
                let at_edges = rising.mul_add(at_up - at_down, at_down);
                loss[x] = (one - self.lasting) * at_edges;
                late[x] = half.mul_add(at_up - at_down, one);
            }
            if kinds.lasting {
                let (up, down) = (up - clamped[x], down - clamped[x]);
                let half_way = half * carrier * (end[x] - start[x]);
                let (top, bottom) = (start[x] + half_way, end[x] - half_way);
                let of_up = ramp.means([start[x], up, top], [first.low[x], one - first.low[x]]);
                let of_down = ramp.means([bottom, down, end[x]], [one - second.low[x], second.low[x]]);
                loss[x] = loss[x] + self.lasting * of_up.times(rising).plus(of_down.times(one - rising)).value();
            }
        }
        let spared = if kinds.edges { self.spared(v, loss, late, place) } else { [zero; 2] };
        let spared = back_by_phase(place.middle.backward(spared), phase);
        let [d, q] = back_by_phase(place.middle.backward(clarke(loss)), phase);
        [self.voltage * d - rs * per_henry[0] * spared[0], self.voltage * q - rs * per_henry[1] * spared[1]]
    }

    /// The currents at the edges: what the phases that switch before have lost, as far as their dead time is over. What is up later is down
    /// earlier.
    #[inline(always)]
    fn edge_by_edge(
        &self,
        [mut up, mut down]: [[V; 3]; 2],
        clamped: [V; 3],
        [first, second]: [&Half<V>; 2],
        amperes: &[[V; 3]; 3],
    ) -> [[V; 3]; 2] {
        let (zero, half, one) = (self.voltage.constant(0.0), self.voltage.constant(0.5), self.voltage.constant(1.0));
        let (ramp, lost) = (self.ramp, self.voltage * (one - self.lasting));
        for x in 0..3 {
            (up[x], down[x]) = (up[x] + clamped[x], down[x] + clamped[x]);
        }
        let (mut before_up, mut before_down) = ([[zero; 3]; 3], [[zero; 3]; 3]);
        for x in 0..3 {
            // A phase does not wait for itself.
            for y in [(x + 1) % 3, (x + 2) % 3] {
                before_up[x][y] = amperes[x][y] * (half * first.later[x][y]).lower(lost);
                before_down[y][x] = amperes[y][x] * (half * second.later[x][y]).lower(lost);
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
        let [a, b, c] = after_others(mirrored, before_down, ramp);
        [up, [-a, -b, -c]]
    }

    /// How far the middle of each edge's way from no loss to all of it lies below zero, A, given out of which legs current flows, and the
    /// phase voltages, V, and what they make together as a part of the DC voltage, A/V.
    #[inline(always)]
    fn clamped(&self, out: [V; 3], [v, together]: [[V; 3]; 2], amperes: &[[V; 3]; 3]) -> [V; 3] {
        let (zero, half, one) = (self.voltage.constant(0.0), self.voltage.constant(0.5), self.voltage.constant(1.0));
        let volts = self.clamps * self.voltage * (one - self.lasting);
        let mut shift = [zero; 3];
        for x in 0..3 {
            let mut sum = half * amperes[x][x] - together[x];
            for y in [(x + 1) % 3, (x + 2) % 3] {
                let is_up = (v[y] - v[x]).mul_add(self.per_lead, one - out[y]).lower(one).higher(zero);
                sum = amperes[x][y].mul_add(is_up, sum);
            }
            shift[x] = volts * sum;
        }
        shift
    }

    /// What pulses that come late take from the mean current times the inductance, V s in the stator, given the phase voltages, V, what
    /// each phase loses, as a part of the voltage that is lost, and how late its pulse is. Of a row that is half a carrier period nothing
    /// is said.
    #[inline(always)]
    fn spared(&self, v: [V; 3], loss: [V; 3], late: [V; 3], place: &Place) -> [V; 2] {
        let (one, quarter) = (self.voltage.constant(1.0), self.voltage.constant(0.25 * place.length));
        let at_edges = self.voltage * (one - self.lasting) * (one - self.halves.abs());
        let twice_per_bus = self.bus * self.voltage.constant(2.0 * place.per_bus);
        let mut seconds = late;
        for x in 0..3 {
            let left = (-self.voltage).mul_add(loss[x], v[x]);
            seconds[x] = quarter * at_edges * late[x] * left.mul_add(twice_per_bus, one);
        }
        clarke(seconds)
    }
}

/// A vector of the rotor's frame, turned by the angle of phase a.
#[inline(always)]
fn by_phase<V: Number>(vector: [V; 2], phase: Option<[V; 2]>) -> [V; 2] {
    match phase {
        Some([cos, sin]) => turned(vector, cos, sin),
        None => vector,
    }
}

/// The same vector, turned back.
#[inline(always)]
fn back_by_phase<V: Number>(vector: [V; 2], phase: Option<[V; 2]>) -> [V; 2] {
    match phase {
        Some([cos, sin]) => turned(vector, cos, -sin),
        None => vector,
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

/// Phase currents, A, that a volt over so many seconds on each phase makes: those of phase `x` by phase `y` at `[x][y]`.
#[inline(always)]
fn by_volt_seconds<V: Number>(seconds: V, [per_ld, per_lq]: [V; 2], phase: Option<[V; 2]>, place: &Place) -> [[V; 3]; 3] {
    let third = seconds.constant(1.0 / 3.0) * seconds;
    let twice = place.middle.twice();
    let (mean, difference) = (third * (per_ld + per_lq), third * (per_ld - per_lq));
    // The axes turn with the vectors, and twice the angle by twice as much.
    let axes = by_phase(by_phase([seconds.constant(twice.cos), seconds.constant(twice.sin)], phase), phase);
    let (cos, sin) = (difference * axes[0], difference * axes[1]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Abc, AlphaBeta, Turn};

    /// An inverter of three ideal legs whose edges up come late while current flows out, and edges down while it flows in, and a motor at
    /// rest that is nothing but inductance, H. Time runs in fine steps.
    #[derive(Clone, Copy)]
    struct Switched {
        bus: f64,
        dead_time: f64,
        inductance: f64,
        /// Duty ratios of the legs.
        duty: [f64; 3],
        /// Whether a current that reaches zero within the dead time stays there, as it does; else the sign at the edge decides.
        clamps: bool,
        /// Those of the second half, where all legs are high at the start.
        second: Option<[f64; 3]>,
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
            let Self { bus, dead_time, inductance, duty, clamps, second } = *self;
            let starts_high = second.is_some();
            let duties = [duty, second.unwrap_or(duty)];
            let (start, mut mean) = (i, [0.0; 3]);
            let (mut lost, mut high, mut late, mut dead) = ([[0.0; 3]; 2], [starts_high; 3], [0.0; 3], [0.0; 3]);
            let h = 1.0 / f64::from(STEPS);
            for step in 0..STEPS {
                let t = (f64::from(step) + 0.5) * h;
                let mut volts = [0.0; 3];
                for leg in 0..3 {
                    let duty = duties[usize::from(t > 0.5)][leg];
                    let mean = 0.5 * (duties[0][leg] + duties[1][leg]);
                    let inner = if starts_high { 1.0 - duty } else { duty };
                    let commanded = ((t - 0.5).abs() < 0.5 * inner) != starts_high;
                    if commanded != high[leg] {
                        // Both switches open, and a diode holds what the current's direction asks for.
                        let waits = commanded == (i[leg] > 0.0);
                        (high[leg], late[leg], dead[leg]) = (commanded, if waits { t + dead_time } else { 0.0 }, t + dead_time);
                    }
                    // Near zero the diodes take turns, which holds the current there.
                    let of_diode = i[leg] < 0.0;
                    let output = if clamps && t < dead[leg] { of_diode } else { commanded != (t < late[leg]) };
                    lost[usize::from(t > 0.5)][leg] += bus * h * (f64::from(u8::from(commanded)) - f64::from(u8::from(output)));
                    // In the rotor's frame, the motor's voltage is what holds the current where it is, in the mean of the command.
                    volts[leg] = bus * (f64::from(u8::from(output)) - mean);
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

    /// The mean current of a period lies below the way from sample to sample by what late pulses make of it: of all phases, or with one
    /// whose current changes its direction between its edges, and whose pulse is in time.
    #[test]
    fn the_resistance_takes_less_where_pulses_are_late() {
        let (bus, dead_time, inductance, rs) = (2.0, 0.02, 1.0, 0.3);
        let v = modulated([0.5, -0.2, -0.3]);
        for i in [[5.0, -2.0, -3.0], [0.5, -5.0, 4.5], [4.0, 0.0, -4.0], [0.01, 3.0, -3.01]] {
            let below = |dead_time: f64| {
                let switched = Switched { bus, dead_time, inductance, duty: v.map(|v| 0.5 + v / bus), clamps: false, second: None };
                alpha_beta(switched.below_way(i))
            };
            let (with, without) = (below(dead_time), below(0.0));
            let loss = loss_of(bus * dead_time, 0.0, 1e-9, 1.0, 0.0, 0.0);
            let place = Place { per_bus: 1.0 / bus, ..Place::still(Turn::by(0.0)) };
            let kinds = LossKinds { edges: true, lasting: false };
            let over = |rs: f64| loss.over(kinds, alpha_beta(v), [alpha_beta(i); 2], &Winding::of(rs, [inductance; 2]), None, &place);
            let (lost, resisted) = (over(0.0), over(rs));
            let size = rs * bus * dead_time / (4.0 * inductance);
            for axis in 0..2 {
                let (expected, found) = (rs * (with[axis] - without[axis]), lost[axis] - resisted[axis]);
                assert!((found - expected).abs() < 0.02 * size, "{i:?} {axis}: {found}, not {expected}");
            }
        }
    }

    fn loss_of(voltage: f64, lasting: f64, width: f64, ripple: f64, halves: f64, clamps: f64) -> SwitchedLoss<f64> {
        let state = DeadTime { voltage, lasting, width, ripple, halves, clamps, ..DeadTime::default() };
        SwitchedLoss::of(|number| number(&state))
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
            let switched = Switched { bus, dead_time, inductance, duty: v.map(|v| 0.5 + v / bus), clamps: false, second: None };
            for (halves, length, turn) in [(0.0, 1.0, None), (0.0, 1.0, Some(0.0)), (0.0, 1.0, Some(0.25)), (1.0, 0.5, None)] {
                let later = turn.map(|turn| modulated(vector(modulation * bus / 3.0_f64.sqrt(), angle + turn)));
                let lost = Switched { second: later.map(|v| v.map(|v| 0.5 + v / bus)), ..switched }.loses(i);
                let [first, second] = [v, later.unwrap_or(v)].map(alpha_beta);
                let mean = [0, 1].map(|axis| 0.5 * (first[axis] + second[axis]));
                let changes = turn.map(|_| [0, 1].map(|axis| second[axis] - first[axis]));
                let loss = loss_of(bus * dead_time, 0.0, 1e-9, 1.0, halves, 0.0);
                for (half, in_half) in [1.0, -1.0].into_iter().zip(lost) {
                    let place = Place { half, length, changes, per_bus: 1.0 / bus, ..Place::still(Turn::by(0.0)) };
                    let kinds = LossKinds { edges: true, lasting: false };
                    let found = loss.over(kinds, mean, [alpha_beta(i); 2], &Winding::of(0.0, [inductance; 2]), None, &place);
                    let expected = if halves == 0.0 { std::array::from_fn(|leg| lost[0][leg] + lost[1][leg]) } else { in_half };
                    let expected = alpha_beta(expected).map(|volt_seconds| volt_seconds / length);
                    let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
                    assert!(off < 0.02 * bus * dead_time, "{angle} {halves} {half}: {found:?}, not {expected:?}");
                    // Without the ripple it would be another loss, here and there.
                    let plain = loss_of(bus * dead_time, 0.0, 1e-9, 0.0, halves, 0.0);
                    let plain = plain.over(kinds, mean, [alpha_beta(i); 2], &Winding::of(0.0, [inductance; 2]), None, &place);
                    differ += usize::from((plain[0] - expected[0]).hypot(plain[1] - expected[1]) > 0.1 * bus * dead_time);
                }
            }
        }
        assert!(differ > 5, "{differ}");
    }

    /// Currents of phase a through zero, at its edges too, with every order of the legs: the loss is that of an inverter whose currents
    /// stay at zero within the dead time, and a ramp about zero would often be off.
    #[test]
    fn a_current_that_reaches_zero_in_the_dead_time_stays_there() {
        let (bus, dead_time, inductance) = (2.0, 0.02, 1.0);
        // Half of what the dead time can change a current by.
        let width = bus * dead_time * (2.0 / 3.0) / inductance / 2.0;
        let (mut squares, mut about_zero, mut count) = (0.0, 0.0, 0.0);
        for order in [[0.5, -0.1, -0.4], [0.02, 0.3, -0.32], [-0.5, 0.3, 0.2], [0.03, 0.02, -0.05], [0.4, -0.21, -0.19]] {
            let v = modulated(order);
            let duty = v.map(|v| 0.5 + v / bus);
            let switched = Switched { bus, dead_time, inductance, duty, clamps: true, second: None };
            for step in -30..=30 {
                let a = 0.004 * f64::from(step);
                let i = [a, 1.0 - 0.5 * a, -1.0 - 0.5 * a];
                let [first, second] = switched.loses(i);
                let expected = alpha_beta(std::array::from_fn(|leg| first[leg] + second[leg]));
                let place = Place { per_bus: 1.0 / bus, ..Place::still(Turn::by(0.0)) };
                let off = |width: f64, clamps: f64| {
                    let loss = loss_of(bus * dead_time, 0.0, width, 1.0, 0.0, clamps);
                    let kinds = LossKinds { edges: true, lasting: false };
                    let found = loss.over(kinds, alpha_beta(v), [alpha_beta(i); 2], &Winding::of(0.0, [inductance; 2]), None, &place);
                    (found[0] - expected[0]).hypot(found[1] - expected[1]) / (bus * dead_time)
                };
                squares += off(width, 1.0).powi(2);
                about_zero += off(1e-9, 0.0).powi(2);
                count += 1.0;
            }
        }
        let (off, about_zero) = ((squares / count).sqrt(), (about_zero / count).sqrt());
        assert!(off < 0.05 && about_zero > 3.0 * off, "{off} {about_zero}");
    }

    /// A rotor seen from an angle's zero that is not at phase a: the same vectors and axes, of a motor with unequal axes, lose the same.
    #[test]
    fn where_phase_a_is_does_not_matter() {
        let loss = loss_of(0.04, 0.3, 0.02, 1.0, 0.0, 1.0);
        let kinds = LossKinds { edges: true, lasting: true };
        for angle in [0.3, 1.1, 2.9, 4.0] {
            let over = |phase: f64| {
                let place = Place { per_bus: 0.5, omega_e: 0.1, ..Place::still(Turn::by(angle - phase)) };
                let turn = (phase != 0.0).then(|| [phase.cos(), phase.sin()]);
                loss.over(kinds, [0.1, 0.5], [[-0.2, 0.1], [-0.1, 0.2]], &Winding::of(0.3, [1.0, 3.0]), turn, &place)
            };
            let (expected, found) = (over(0.0), over(0.7));
            assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-12, "{angle}: {found:?}, not {expected:?}");
        }
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
            let loss = loss_of(1.0, lasting, 0.0, 0.0, 0.0, 0.0);
            let along = |k: u32| {
                let (start, end) = (vector(k), vector(k + 1));
                let lost = loss.over(kinds, [0.0; 2], [start, end], &Winding::of(0.0, [1.0; 2]), None, &Place::still(Turn::by(0.0)));
                (lost[0] * (start[0] + end[0]) + lost[1] * (start[1] + end[1])) / 10.0
            };
            let mean = (0..STEPS).map(along).sum::<f64>() / f64::from(STEPS);
            assert!((mean - 4.0 / std::f64::consts::PI).abs() < 1e-3, "{mean}");
        }
    }
}

//! Half a carrier's period: when its command lets each phase switch, and what the phases drive until then.

use crate::lanes::Number;

/// What the command of either half of a carrier's period says of its edges.
#[derive(Clone, Copy)]
pub(super) struct Half<V> {
    /// The part of the period in which each phase is low.
    pub(super) low: [V; 3],
    /// By how much each phase is later than each other one, V: by that over the DC voltage, and half a period, it switches after it.
    pub(super) later: [[V; 3]; 3],
    /// Current of each phase, A, that all of them drive together by their voltages over the period.
    pub(super) together: [V; 3],
    /// What all phases have been driven by beyond their mean until one goes up, as a current in it, A; less until it goes down.
    pub(super) commanded: [V; 3],
}

impl<V: Number> Half<V> {
    /// Of phase voltages, V, one over the DC voltage, and the amperes per volt.
    #[inline(always)]
    pub(super) fn of(v: [V; 3], per_bus: V, amperes: &[[V; 3]; 3]) -> Self {
        let (zero, half) = (per_bus.constant(0.0), per_bus.constant(0.5));
        let mut it = Self { low: [zero; 3], later: [[zero; 3]; 3], together: [zero; 3], commanded: [zero; 3] };
        for x in 0..3 {
            it.low[x] = (-v[x]).mul_add(per_bus, half);
            it.together[x] = amperes[x][x] * v[x];
            let mut ahead = zero;
            for y in [(x + 1) % 3, (x + 2) % 3] {
                it.later[x][y] = zero.higher(v[y] - v[x]);
                it.together[x] = amperes[x][y].mul_add(v[y], it.together[x]);
                ahead = amperes[x][y].mul_add(it.later[x][y], ahead);
            }
            it.commanded[x] = half * (-it.low[x]).mul_add(it.together[x], ahead);
        }
        it
    }
}

/// Phase voltages as space vector modulation makes them: all shifted alike, so that the highest is as far from its limit as the lowest.
#[inline(always)]
pub(super) fn modulated<V: Number>(u: [V; 3]) -> [V; 3] {
    let middle = u[0].constant(0.5) * (u[0].lower(u[1].lower(u[2])) + u[0].higher(u[1].higher(u[2])));
    [u[0] - middle, u[1] - middle, u[2] - middle]
}

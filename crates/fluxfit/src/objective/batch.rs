//! Batches: any number of adjustable drives on the same rows, in groups of as many lanes as suit the processor, groups on all cores.
//!
//! The instructions are chosen when the program runs; the bits are the same with all of them, because every one of them rounds each
//! operation alike, the fused multiplication and addition too. A processor without that operation computes it by a slow function.

use super::{
    adjustable::Adjustable,
    simulated_segment::{LINEAR_UNKNOWNS, SimulatedSegment},
    simulation::{Drives, Sums},
    transition_lanes::MotorLanes,
    transition_polynomials::TransitionPlan,
};
use crate::{
    faults::{Acting, FaultKinds},
    frames::Dq,
    lanes::Lanes,
    parallel,
};
use nalgebra::{SMatrix, SVector};
use pulp::{NullaryFnOnce, Scalar, Simd};

/// If less than this part of the cost is left by the linear unknowns, too few digits are left too, and residuals are squared one by one:
/// an unstable motor's currents, wrong by far, are much like the response to a wrong start, and their cost must not come out negative.
const CANCELLED: f64 = 1e-8;

/// What is simulated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rows {
    pub(super) segments: Vec<SimulatedSegment>,
    pub(super) plan: TransitionPlan,
}

/// What came of one drive.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Simulated {
    /// Sum of the squared residuals, A².
    pub(super) cost: f64,
    /// Measured less simulated current, A: `d, q` of each row in turn, segment after segment; empty if they were not asked for.
    pub(super) residuals: Vec<f64>,
}

impl Rows {
    pub(super) fn of(mut segments: Vec<SimulatedSegment>) -> Self {
        let plan = TransitionPlan::of(segments.iter().flat_map(|segment| &segment.periods));
        segments.iter_mut().for_each(|segment| segment.plan(&plan));
        Self { segments, plan }
    }

    /// The costs of these drives, A².
    pub(super) fn costs(&self, drives: &[Adjustable]) -> Vec<f64> {
        self.simulate(drives, false).into_iter().map(|simulated| simulated.cost).collect()
    }

    /// Costs and residuals of these drives.
    pub(super) fn residuals(&self, drives: &[Adjustable]) -> Vec<Simulated> {
        self.simulate(drives, true)
    }

    /// What a volt on each axis over each period does to linear functions of the simulated currents; `d, q` of each row are the weights of
    /// one function. One entry per period, segment after segment.
    pub(super) fn by_voltage(&self, drive: &Adjustable, weights: &[Vec<f64>]) -> Vec<Vec<Dq>> {
        InstructionSet::of_this_machine().by_voltage(self, drive, weights)
    }

    fn simulate(&self, drives: &[Adjustable], residuals: bool) -> Vec<Simulated> {
        InstructionSet::of_this_machine().simulate(self, drives, residuals)
    }
}

/// The instructions of a processor.
#[derive(Debug, Clone, Copy)]
enum InstructionSet {
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    Portable,
}

impl InstructionSet {
    fn of_this_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = pulp::x86::V4::try_new() {
            return Self::Avx512(set);
        } else if let Some(set) = pulp::x86::V3::try_new() {
            return Self::Avx2(set);
        }
        Self::Portable
    }

    /// Every one that this machine has.
    #[cfg(test)]
    fn all() -> Vec<Self> {
        let mut all = vec![Self::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            all.extend(pulp::x86::V3::try_new().map(Self::Avx2));
            all.extend(pulp::x86::V4::try_new().map(Self::Avx512));
        }
        all
    }

    fn simulate(self, rows: &Rows, drives: &[Adjustable], residuals: bool) -> Vec<Simulated> {
        // How many vectors side by side: measured. With more, AVX-512 runs out of registers, with fewer AVX2 waits for results.
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(set) => in_groups::<_, 1>(set, rows, drives, residuals),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(set) => in_groups::<_, 2>(set, rows, drives, residuals),
            Self::Portable => in_groups::<_, 1>(Scalar::new(), rows, drives, residuals),
        }
    }

    fn by_voltage(self, rows: &Rows, drive: &Adjustable, weights: &[Vec<f64>]) -> Vec<Vec<Dq>> {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(set) => adjoints::<_, 1>(set, rows, drive, weights),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(set) => adjoints::<_, 1>(set, rows, drive, weights),
            Self::Portable => adjoints::<_, 1>(Scalar::new(), rows, drive, weights),
        }
    }
}

/// Simulates drives in groups of `K` vectors.
fn in_groups<S: Simd, const K: usize>(set: S, rows: &Rows, drives: &[Adjustable], residuals: bool) -> Vec<Simulated> {
    // Drives without faults, which are simulated by a shorter path, apart from the others: the path must not depend on neighbours.
    let (perfect, faulty): (Vec<usize>, Vec<usize>) = (0..drives.len()).partition(|place| !FaultKinds::of(&drives[*place].faults).any());
    let lanes = Lanes::<S, K>::COUNT;
    let groups: Vec<&[usize]> = perfect.chunks(lanes).chain(faulty.chunks(lanes)).collect();
    let simulated = parallel::map(&groups, |places| {
        let group: Vec<&Adjustable> = places.iter().map(|place| &drives[*place]).collect();
        match rows.plan.coefficients {
            4 => set.vectorize(Group::<S, K, 4> { set, rows, drives: &group, residuals }),
            5 => set.vectorize(Group::<S, K, 5> { set, rows, drives: &group, residuals }),
            7 => set.vectorize(Group::<S, K, 7> { set, rows, drives: &group, residuals }),
            _ => set.vectorize(Group::<S, K, 11> { set, rows, drives: &group, residuals }),
        }
    });
    let mut results = vec![Simulated::default(); drives.len()];
    for (places, simulated) in groups.iter().zip(simulated) {
        for (place, simulated) in places.iter().zip(simulated) {
            results[*place] = simulated;
        }
    }
    results
}

/// The effects of voltages on linear functions, in groups of `K` vectors.
fn adjoints<S: Simd, const K: usize>(set: S, rows: &Rows, drive: &Adjustable, weights: &[Vec<f64>]) -> Vec<Vec<Dq>> {
    let groups: Vec<&[Vec<f64>]> = weights.chunks(Lanes::<S, K>::COUNT).collect();
    let effects = parallel::map(&groups, |weights| match rows.plan.coefficients {
        4 => set.vectorize(Adjoint::<S, K, 4> { set, rows, drive, weights }),
        5 => set.vectorize(Adjoint::<S, K, 5> { set, rows, drive, weights }),
        7 => set.vectorize(Adjoint::<S, K, 7> { set, rows, drive, weights }),
        _ => set.vectorize(Adjoint::<S, K, 11> { set, rows, drive, weights }),
    });
    effects.into_iter().flatten().collect()
}

/// The drives of one group, at most one per lane; their transitions have `C` coefficients.
struct Group<'a, S, const K: usize, const C: usize> {
    set: S,
    rows: &'a Rows,
    drives: &'a [&'a Adjustable],
    residuals: bool,
}

impl<S: Simd, const K: usize, const C: usize> NullaryFnOnce for Group<'_, S, K, C> {
    type Output = Vec<Simulated>;

    #[inline(always)]
    fn call(self) -> Vec<Simulated> {
        let Self { set, rows, drives, residuals } = self;
        let kinds = drives.iter().map(|drive| FaultKinds::of(&drive.faults)).fold(FaultKinds::default(), FaultKinds::or);
        let group: Drives<Lanes<S, K>, C> = lanes(set, rows, kinds, |lane| drives[lane.min(drives.len() - 1)]);
        let mut results = vec![Simulated::default(); drives.len()];
        for segment in &rows.segments {
            let sums = group.sums(segment);
            let (totals, solved) =
                (sums.total, drives.iter().enumerate().map(|(lane, _)| linear_unknowns(&sums, lane, segment.alternates)));
            let solved: Vec<_> = solved.collect();
            // What is left may be no number where the total is one.
            let cancelled = |lane: usize| totals.lane(lane).is_finite() && !(solved[lane].1 > CANCELLED * totals.lane(lane));
            let any_cancelled = (0..drives.len()).any(cancelled);
            for (lane, result) in results.iter_mut().enumerate().filter(|(lane, _)| !cancelled(*lane)) {
                result.cost += solved[lane].1;
            }
            if !residuals && !any_cancelled {
                continue;
            }
            let linear = std::array::from_fn(|k| Lanes::of(set, |lane| solved.get(lane).map_or(0.0, |(best, _)| best[k])));
            let errors = group.errors(segment, &linear);
            let mut rest: Vec<Vec<f64>> = drives.iter().map(|_| Vec::with_capacity(2 * errors.len())).collect();
            let mut numbers = vec![0.0; 2 * Lanes::<S, K>::COUNT];
            for [d, q] in errors {
                let (of_d, of_q) = numbers.split_at_mut(Lanes::<S, K>::COUNT);
                d.store(of_d);
                q.store(of_q);
                for (lane, rest) in rest.iter_mut().enumerate() {
                    rest.extend([of_d[lane], of_q[lane]]);
                }
            }
            for (lane, (result, own)) in results.iter_mut().zip(rest).enumerate() {
                if cancelled(lane) {
                    result.cost += own.iter().map(|error| error * error).sum::<f64>();
                }
                if residuals {
                    result.residuals.extend(own);
                }
            }
        }
        results
    }
}

/// Linear functions of one drive's simulated currents, at most one per lane.
struct Adjoint<'a, S, const K: usize, const C: usize> {
    set: S,
    rows: &'a Rows,
    drive: &'a Adjustable,
    weights: &'a [Vec<f64>],
}

impl<S: Simd, const K: usize, const C: usize> NullaryFnOnce for Adjoint<'_, S, K, C> {
    type Output = Vec<Vec<Dq>>;

    #[inline(always)]
    fn call(self) -> Vec<Vec<Dq>> {
        let Self { set, rows, drive, weights } = self;
        let group: Drives<Lanes<S, K>, C> = lanes(set, rows, FaultKinds::of(&drive.faults), |_| drive);
        let mut effects = vec![Vec::new(); weights.len()];
        let mut first = 0;
        for segment in &rows.segments {
            let weight = |row: usize, axis: usize| Lanes::of(set, |lane| weights.get(lane).map_or(0.0, |own| own[first + 2 * row + axis]));
            let backward = group.by_voltage(segment, |row| [weight(row, 0), weight(row, 1)]);
            for (lane, effects) in effects.iter_mut().enumerate() {
                effects.extend(backward.iter().rev().map(|[d, q]| Dq { d: d.lane(lane), q: q.lane(lane) }));
            }
            first += 2 * segment.measured.len();
        }
        effects
    }
}

/// A drive per lane.
#[inline(always)]
fn lanes<'a, S: Simd, const K: usize, const C: usize>(
    set: S,
    rows: &Rows,
    kinds: FaultKinds,
    drive: impl Fn(usize) -> &'a Adjustable,
) -> Drives<Lanes<S, K>, C> {
    let motors = MotorLanes::of(|number| Lanes::of(set, |lane| number(&drive(lane).motor)));
    let faults = Acting::of(kinds, |number| Lanes::of(set, |lane| number(&drive(lane).faults)));
    Drives::of(motors, faults, &rows.plan)
}

/// The linear unknowns of a lane that fit best, and the part of the cost that is left.
fn linear_unknowns<S: Simd, const K: usize>(sums: &Sums<Lanes<S, K>>, lane: usize, alternates: bool) -> ([f64; LINEAR_UNKNOWNS], f64) {
    let unknowns = if alternates { LINEAR_UNKNOWNS } else { LINEAR_UNKNOWNS / 2 };
    // Unknowns that there are not are held at zero by the identity.
    let normal = SMatrix::<f64, LINEAR_UNKNOWNS, LINEAR_UNKNOWNS>::from_fn(|row, column| match row.max(column) < unknowns {
        true => sums.normal(row, column).lane(lane),
        false => f64::from(u8::from(row == column)),
    });
    let right = |row: usize| if row < unknowns { sums.right[row].lane(lane) } else { 0.0 };
    let right = SVector::<f64, LINEAR_UNKNOWNS>::from_fn(|row, _| right(row));
    let total = sums.total.lane(lane);
    match normal.cholesky() {
        Some(factor) => {
            let best = factor.solve(&right);
            (best.into(), total - right.dot(&best))
        }
        None => ([0.0; LINEAR_UNKNOWNS], total),
    }
}

//! Batches: any number of adjustable drives on the same rows, in groups of as many lanes as suit the processor, groups on all cores.
//!
//! The instructions are chosen when the program runs; the bits are the same with all of them, because every one of them rounds each
//! operation alike, the fused multiplication and addition too. A processor without that operation computes it by a slow function.

use super::{
    acting_voltage::Held,
    adjustable::Adjustable,
    simulated_segment::{LINEAR_UNKNOWNS, SimulatedSegment},
    simulation::{Drives, Sums, Trace},
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
use std::cell::RefCell;

/// If less than this part of the cost is left by the linear unknowns, too few digits are left too, and residuals are squared one by one:
/// an unstable motor's currents, wrong by far, are much like the response to a wrong start, and their cost must not come out negative.
const CANCELLED: f64 = 1e-8;

/// What is simulated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rows {
    pub(super) segments: Vec<SimulatedSegment>,
    pub(super) plan: TransitionPlan,
    /// The usual length of a period: their mean, s.
    pub(super) period: f64,
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
    pub(super) fn of(mut segments: Vec<SimulatedSegment>, held: Held) -> Self {
        let plan = TransitionPlan::of(segments.iter().flat_map(|segment| &segment.periods), held);
        segments.iter_mut().for_each(|segment| segment.plan(&plan));
        let lengths = segments.iter().flat_map(|segment| &segment.periods).map(|period| period.length);
        let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
        let period = if count > 0.0 { sum / count } else { 1.0 };
        Self { segments, plan, period }
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
        if !cfg!(feature = "avx2-only")
            && let Some(set) = pulp::x86::V4::try_new()
        {
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

std::thread_local! {
    /// Memory of the simulation before, for the next one.
    static TRACE: RefCell<Trace> = RefCell::default();
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
        let count = if residuals { 2 * rows.segments.iter().map(|segment| segment.measured.len()).sum::<usize>() } else { 0 };
        let mut results: Vec<Simulated> = drives.iter().map(|_| Simulated { cost: 0.0, residuals: Vec::with_capacity(count) }).collect();
        for segment in &rows.segments {
            let lanes = Lanes::<S, K>::COUNT;
            let mut trace = residuals.then(|| TRACE.take().again(segment, lanes));
            let sums = group.sums(segment, trace.as_mut());
            let (totals, solved) =
                (sums.total, drives.iter().enumerate().map(|(lane, _)| linear_unknowns(&sums, lane, segment.alternates)));
            let solved: Vec<_> = solved.collect();
            // What is left may be no number where the total is one.
            let cancelled =
                |lane: usize| totals.lane(lane).is_finite() && (solved[lane].1.is_nan() || solved[lane].1 <= CANCELLED * totals.lane(lane));
            let any_cancelled = (0..drives.len()).any(cancelled);
            for (lane, result) in results.iter_mut().enumerate().filter(|(lane, _)| !cancelled(*lane)) {
                result.cost += solved[lane].1;
            }
            if !residuals && !any_cancelled {
                continue;
            }
            let linear = std::array::from_fn(|k| Lanes::of(set, |lane| solved.get(lane).map_or(0.0, |(best, _)| best[k])));
            // No closure: it would not be compiled for these instructions.
            let mut trace = match trace {
                Some(trace) => trace,
                None => {
                    let mut trace = TRACE.take().again(segment, lanes);
                    group.sums(segment, Some(&mut trace));
                    trace
                }
            };
            group.errors(segment, &linear, &mut trace);
            let errors = &trace.errors;
            for (lane, result) in results.iter_mut().enumerate() {
                if cancelled(lane) {
                    result.cost += squares_of_lane(errors, lane, lanes);
                }
            }
            if residuals {
                append(errors, lanes, &mut results);
            }
            TRACE.set(trace.kept());
        }
        results
    }
}

/// Sum of the squares of one lane.
fn squares_of_lane(errors: &[f64], lane: usize, lanes: usize) -> f64 {
    errors.chunks_exact(2 * lanes).map(|row| row[lane].powi(2) + row[lane + lanes].powi(2)).sum()
}

/// Rows whose errors fit into the nearest memory, so that each lane may be read from there.
const NEAR: usize = 128;

/// Appends each lane's errors to its drive's residuals: `d, q` of each row in turn.
fn append(errors: &[f64], lanes: usize, results: &mut [Simulated]) {
    for rows in errors.chunks(NEAR * 2 * lanes) {
        for (lane, result) in results.iter_mut().enumerate() {
            let pairs = rows.chunks_exact(2 * lanes).map(|row| [row[lane], row[lane + lanes]]);
            result.residuals.extend(pairs.flatten());
        }
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
        let (mut effects, mut numbers) = (vec![Vec::new(); weights.len()], Vec::new());
        let mut first = 0;
        for segment in &rows.segments {
            let weight = |row: usize, axis: usize| Lanes::of(set, |lane| weights.get(lane).map_or(0.0, |own| own[first + 2 * row + axis]));
            let lanes = Lanes::<S, K>::COUNT;
            numbers.resize(2 * lanes * segment.periods.len(), 0.0);
            group.by_voltage(segment, |row| [weight(row, 0), weight(row, 1)], lanes, &mut numbers);
            for (lane, effects) in effects.iter_mut().enumerate() {
                effects.extend(numbers.chunks_exact(2 * lanes).map(|row| Dq { d: row[lane], q: row[lane + lanes] }));
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
    let faults = Acting::of(kinds, rows.period, |number| Lanes::of(set, |lane| number(&drive(lane).faults)));
    Drives::of(motors, faults, &rows.plan)
}

/// The linear unknowns of a lane that fit best, and the part of the cost that is left.
fn linear_unknowns<S: Simd, const K: usize>(sums: &Sums<Lanes<S, K>>, lane: usize, alternates: bool) -> ([f64; LINEAR_UNKNOWNS], f64) {
    let unknowns = if alternates { LINEAR_UNKNOWNS } else { LINEAR_UNKNOWNS / 2 };
    // Unknowns that there are not, or that no row shows, are held at zero by the identity.
    let is_shown = |unknown: usize| unknown < unknowns && sums.normal(unknown, unknown).lane(lane) != 0.0;
    let normal = SMatrix::<f64, LINEAR_UNKNOWNS, LINEAR_UNKNOWNS>::from_fn(|row, column| match is_shown(row) && is_shown(column) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        faults::{
            Faults, angle_delay::AngleDelay, angle_offset::AngleOffset, current_gains::CurrentGains, current_offset::CurrentOffset,
            dead_time::DeadTime, disturbance::Disturbance, filter::Filter, flux_harmonics::FluxHarmonics,
            resistance_drift::ResistanceDrift, saturation::Saturation, speed_lag::SpeedLag, voltage_lag::VoltageLag,
        },
        frames::AlphaBeta,
        log::{Columns, Log},
        motor::Motor,
        objective::{
            acting_voltage::{MeansOf, VoltageFrame, VoltageTiming},
            angles::Angles,
            output_error::OutputError,
            transition::Transition,
        },
        optimizer::Draws,
    };

    const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

    /// A motor that speeds up from standstill to this turn per row, rad, and noise on everything; periods of these lengths in turn, s.
    fn log(rows: usize, turn: f64, lengths: &[f64]) -> Log {
        let mut draws = Draws::seeded(3, 0);
        let mut columns = Columns::default();
        let (mut t, mut theta_e) = (0.0, 0.0);
        for row in 0..rows {
            let length = lengths[row % lengths.len()];
            let omega_e = turn / lengths[0] * row as f64 / rows as f64;
            columns.t.push(t);
            columns.ud.push(-20.0 + 5.0 * draws.normal());
            columns.uq.push(0.2 * omega_e + 10.0 + 5.0 * draws.normal());
            columns.id.push(-1.0 + draws.normal());
            columns.iq.push(8.0 + draws.normal());
            columns.omega_e.push(omega_e);
            columns.theta_e.get_or_insert_default().push(theta_e % std::f64::consts::TAU);
            t += length;
            theta_e += omega_e * length;
        }
        Log::new(columns).unwrap()
    }

    fn rows(log: &Log, timing: VoltageTiming) -> Rows {
        let rows = 0..log.rows();
        Rows::of(vec![SimulatedSegment::of(log, &rows, &Angles::of(log, &rows), timing)], timing.held())
    }

    fn motors(count: usize) -> Vec<Adjustable> {
        let by = |k: usize, p: usize| 1.0 + 0.3 * ((k * 7 + p * 3) % 11) as f64 / 11.0;
        let values = MOTOR.to_array();
        (0..count).map(|k| Adjustable::from(Motor::from(std::array::from_fn(|p| values[p] * by(k, p))))).collect()
    }

    /// Drives with every fault, one more than the other.
    fn faulty(count: usize) -> Vec<Adjustable> {
        let faults = |x: f64| Faults {
            dead_time: DeadTime {
                voltage: 2.0 * x,
                width: 0.5,
                ripple: x,
                phase: 0.1,
                lasting: 0.3 * x,
                halves: 1.0,
                clamps: 1.0,
                bus: 0.2 * x,
                least_width: 0.02,
            },
            angle_offset: AngleOffset { angle: 0.05 * x },
            current_offset: CurrentOffset { current: AlphaBeta { alpha: 0.1 * x, beta: -0.05 } },
            current_gains: CurrentGains { imbalance: AlphaBeta { alpha: 0.01, beta: 0.02 * x }, turn: 0.01 },
            angle_delay: AngleDelay { time: 1e-4 * x },
            voltage_lag: VoltageLag { time: 5e-5 * x },
            filter: Filter { currents: 2e-4 * x, voltages: 1e-4, noise_before: 0.3 * x, ..Filter::default() },
            speed_lag: SpeedLag { time: 1e-3 * x },
            flux_harmonics: FluxHarmonics { d: [0.001, 0.002 * x], q: [0.003 * x, -0.001] },
            resistance_drift: ResistanceDrift { change: 0.1 * x },
            saturation: Saturation { d: -1e-5 * x, q: -1e-4 * x, cross: -1e-5 },
            disturbance: Disturbance { gain: Dq { d: 0.1 * x, q: 0.2 } },
        };
        motors(count).into_iter().enumerate().map(|(k, drive)| Adjustable { faults: faults(0.5 + k as f64 / 20.0), ..drive }).collect()
    }

    /// The definition: a matrix exponential per row. With the linear unknowns at these values.
    fn exact_errors(rows: &Rows, motor: &Motor, linear: &[f64; LINEAR_UNKNOWNS]) -> Vec<f64> {
        let segment = &rows.segments[0];
        let mut i = Dq { d: segment.measured[0].d + linear[0], q: segment.measured[0].q + linear[1] };
        let mut errors = vec![-linear[0], -linear[1]];
        for ((period, row), measured) in segment.periods.iter().zip(&segment.rows_of_periods).zip(&segment.measured[1..]) {
            let [d, q] = row.alternating;
            let u = Dq { d: period.u.d + linear[2] * d - linear[3] * q, q: period.u.q + linear[2] * q + linear[3] * d };
            i = Transition::of(motor, period.omega_e, period.length).after(i, u);
            errors.extend([measured.d - i.d, measured.q - i.q]);
        }
        errors
    }

    /// Voltages that stand still in the rotor's frame and hold a current there: it stays, whatever the rows' lengths.
    #[test]
    fn a_motor_in_its_steady_state_stays_there() {
        let many: Vec<f64> = (0..300).map(|k| 1e-4 * (1.0 + 0.003 * f64::from(k))).collect();
        let (i, omega_e) = (Dq { d: -3.0, q: 8.0 }, 4000.0);
        let u = MOTOR.steady_voltage(i, omega_e);
        for lengths in [vec![1e-4], many] {
            let mut columns = log(300, 0.1, &lengths).columns().clone();
            for (column, value) in [
                (&mut columns.ud, u.d),
                (&mut columns.uq, u.q),
                (&mut columns.id, i.d),
                (&mut columns.iq, i.q),
                (&mut columns.omega_e, omega_e),
            ] {
                column.fill(value);
            }
            columns.theta_e = None;
            let log = Log::new(columns).unwrap();
            let frame = VoltageFrame::Rotor;
            for timing in [
                VoltageTiming::Delayed { delay: 0, frame },
                VoltageTiming::Delayed { delay: 1, frame },
                VoltageTiming::Averaged { of: MeansOf::Voltages },
            ] {
                let cost = rows(&log, timing).costs(&[Adjustable::from(MOTOR)])[0];
                assert!(cost < 1e-18, "{timing:?}: {cost}");
            }
        }
    }

    /// Over a whole log, from standstill to a sixth of a turn per row, with one length of a period, three, and three hundred.
    #[test]
    fn simulated_currents_are_those_of_a_matrix_exponential_per_row() {
        let many: Vec<f64> = (0..300).map(|k| 1e-4 * (1.0 + 0.003 * f64::from(k))).collect();
        for (turn, lengths) in [
            (0.04, vec![1e-4]),
            (0.15, vec![1e-4]),
            (0.5, vec![1e-4]),
            (1.0, vec![1e-4]),
            (0.04, vec![0.99e-4, 1e-4, 1.01e-4]),
            (0.1, many),
        ] {
            let log = log(3000, turn, &lengths);
            for timing in [VoltageTiming::ALL[0], VoltageTiming::ALL[2]] {
                let rows = rows(&log, timing);
                for drive in motors(4) {
                    let found = &rows.residuals(&[drive])[0];
                    // The linear unknowns are what makes the first rows alike.
                    let solved = solved(&rows, &drive);
                    let expected = exact_errors(&rows, &drive.motor, &solved);
                    let worst = found.residuals.iter().zip(&expected).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
                    let peak = expected.iter().map(|error| error.abs()).fold(0.0, f64::max);
                    assert!(worst < 1e-11 * peak, "{turn} {} {timing:?}: {worst} of {peak}", lengths.len());
                    let cost = expected.iter().map(|error| error * error).sum::<f64>();
                    assert!((found.cost / cost - 1.0).abs() < 1e-11, "{turn} {}: {} {cost}", lengths.len(), found.cost);
                }
            }
        }
    }

    /// The linear unknowns by their definition: least squares on responses from matrix exponentials.
    fn solved(rows: &Rows, drive: &Adjustable) -> [f64; LINEAR_UNKNOWNS] {
        let unknowns = if rows.segments[0].alternates { LINEAR_UNKNOWNS } else { 2 };
        let base = exact_errors(rows, &drive.motor, &[0.0; LINEAR_UNKNOWNS]);
        let columns: Vec<Vec<f64>> = (0..unknowns)
            .map(|k| {
                let unit = std::array::from_fn(|other| f64::from(u8::from(k == other)));
                exact_errors(rows, &drive.motor, &unit).iter().zip(&base).map(|(one, base)| base - one).collect()
            })
            .collect();
        let matrix = nalgebra::DMatrix::from_fn(base.len(), unknowns, |row, k| columns[k][row]);
        let best = matrix.qr();
        let right = best.q().transpose() * nalgebra::DVector::from_vec(base);
        let best = best.r().solve_upper_triangular(&right).unwrap();
        std::array::from_fn(|k| if k < unknowns { best[k] } else { 0.0 })
    }

    /// A candidate has the same bits alone and among others, with every set of instructions that this machine has.
    #[test]
    fn bits_depend_on_nothing_beside() {
        let lengths: Vec<f64> = (0..100).map(|k| 1e-4 * (1.0 + 0.003 * f64::from(k))).collect();
        let (log, uneven) = (self::log(700, 0.1, &[1e-4]), self::log(700, 0.1, &lengths));
        for (log, timing) in [(&log, VoltageTiming::ALL[0]), (&log, VoltageTiming::ALL[2]), (&uneven, VoltageTiming::ALL[0])] {
            let rows = rows(log, timing);
            let drives: Vec<Adjustable> = motors(37).into_iter().chain(faulty(27)).chain(motors(3)).collect();
            let bits =
                |simulated: &Simulated| (simulated.cost.to_bits(), simulated.residuals.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
            let expected: Vec<_> = drives.iter().map(|drive| bits(&InstructionSet::Portable.simulate(&rows, &[*drive], true)[0])).collect();
            for set in InstructionSet::all() {
                let found: Vec<_> = set.simulate(&rows, &drives, true).iter().map(bits).collect();
                assert!(found == expected, "{set:?}");
            }
        }
    }

    /// The effect of a volt by the adjoint equations is that of a simulation with a volt more.
    #[test]
    fn effects_of_voltages_are_differences_of_simulations() {
        let log = log(60, 0.1, &[1e-4]);
        let timing = VoltageTiming::ALL[2];
        let weights: Vec<f64> = (0..2 * 59).map(|k| (k as f64).sin()).collect();
        let drive = motors(1)[0];
        let before = rows(&log, timing);
        let effects = &before.by_voltage(&drive, std::slice::from_ref(&weights))[0];
        let sum = |rows: &Rows| {
            exact_errors(rows, &drive.motor, &[0.0; LINEAR_UNKNOWNS])
                .iter()
                .zip(&weights)
                .map(|(error, weight)| -error * weight)
                .sum::<f64>()
        };
        let base = sum(&before);
        for k in [0, 17, 40] {
            let mut changed = before.clone();
            changed.segments[0].periods[k].u.d += 1.0;
            assert!((sum(&changed) - base - effects[k].d).abs() < 1e-9, "{k}: {} {}", sum(&changed) - base, effects[k].d);
        }
    }

    /// A motor without inductance has no finite cost, and its neighbours are what they are.
    #[test]
    fn what_cannot_be_simulated_stays_in_its_lane() {
        let log = log(700, 0.1, &[1e-4]);
        let objective = OutputError::of(&log, VoltageTiming::ALL[2]).unwrap();
        let mut drives = motors(8);
        let alone = objective.cost_of(&drives[5]);
        drives[4].motor.ld = 0.0;
        let costs = rows(&log, VoltageTiming::ALL[2]).costs(&drives);
        assert!(!costs[4].is_finite() && costs[5].to_bits() == alone.to_bits());
    }
}

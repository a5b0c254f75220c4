//! Many adjustable drives on the same rows, side by side: the walk from row to row that every evaluation of the output error is.
//!
//! A lane is a candidate. Each period costs some forty multiplications and additions a lane: the transition at its speed
//! ([polynomials](super::transition_polynomials)), the step of the simulated current, the sums of squares; more where a drive has faults.
//! The response to what the log does not hold, the first current, dies out with the windings' time constants and is then left alone.
//!
//! Every operation is done on each lane alone and in the same order, whatever the number of lanes and the processor's instructions: the
//! bits of a candidate depend on nothing beside it.

use super::{
    acting_voltage::Held,
    simulated_segment::{LINEAR_UNKNOWNS, PeriodRow, SimulatedSegment},
    transition_lanes::{MotorLanes, TransitionLanes},
    transition_polynomials::{TransitionPlan, TransitionPolynomials},
};
use crate::{
    faults::{Acting, Place, Winding},
    frames::{Turn, turned},
    lanes::{Number, both},
};
use pulp::NullaryFnOnce;
use std::ops::Range;

/// Rows between two looks at what has died out.
const BLOCK: usize = 64;

/// The mean of a kink is a half of what it is half-way, that of a bend two thirds: the bend with a kink's mean is so much of it.
const KINK: f64 = 0.75;

/// A response to a first current of one ampere that is smaller than this, A, has died out: what it adds to a sum of squares is below
/// rounding.
const DIED_OUT: f64 = 1e-12;

/// Linear unknowns of which the first current makes two; the others are those of the first vector.
const FIRST_CURRENT: usize = 2;

/// Products of two linear unknowns, each pair once.
const PAIRS: usize = LINEAR_UNKNOWNS * (LINEAR_UNKNOWNS + 1) / 2;

/// A pair's place among the products.
const fn pair(one: usize, other: usize) -> usize {
    one * (one + 1) / 2 + other
}

/// Sums over the rows of a segment, a lane per candidate.
#[derive(Clone, Copy)]
pub(super) struct Sums<V> {
    /// Of squared errors, A².
    pub(super) total: V,
    /// Of errors times responses.
    pub(super) right: [V; LINEAR_UNKNOWNS],
    /// Of products of responses.
    normal: [V; PAIRS],
}

impl<V: Copy> Sums<V> {
    /// The product of two responses.
    pub(super) fn normal(&self, row: usize, column: usize) -> V {
        self.normal[pair(row.max(column), row.min(column))]
    }
}

/// Where the simulation stands.
#[derive(Clone, Copy)]
struct State<V> {
    /// Simulated current.
    i: [V; 2],
    /// Measured less simulated current.
    error: [V; 2],
    /// Its response to each linear unknown.
    response: [[V; 2]; LINEAR_UNKNOWNS],
    /// Where a filter lies between the motor and the log: its output; of the response above, which is the filter's, the motor's part. Else
    /// the latter is zero.
    filtered: [V; 2],
    motor_response: [[V; 2]; LINEAR_UNKNOWNS],
}

/// Writes the lanes of d, then those of q.
#[inline(always)]
fn store<V: Number>([d, q]: [V; 2], numbers: &mut [f64]) {
    let (of_d, of_q) = numbers.split_at_mut(numbers.len() / 2);
    d.store(of_d);
    q.store(of_q);
}

/// Reads them again.
#[inline(always)]
fn load<V: Number>(kind: V, numbers: &[f64]) -> [V; 2] {
    let (of_d, of_q) = numbers.split_at(numbers.len() / 2);
    [kind.load(of_d), kind.load(of_q)]
}

/// Drives side by side, ready to be simulated.
pub(super) struct Drives<V, const C: usize> {
    motors: MotorLanes<V>,
    faults: Acting<V>,
    /// Per length of a period; none if each period is computed exactly.
    polynomials: Vec<TransitionPolynomials<V, C>>,
    /// Where the voltage stands still over a period.
    held: Held,
}

impl<V: Number, const C: usize> Drives<V, C> {
    #[inline(always)]
    pub(super) fn of(motors: MotorLanes<V>, faults: Acting<V>, plan: &TransitionPlan) -> Self {
        let mut polynomials = Vec::with_capacity(plan.classes.len());
        for class in &plan.classes {
            polynomials.push(TransitionPolynomials::of(&motors, class, plan.held));
        }
        Self { motors, faults, polynomials, held: plan.held }
    }

    /// Simulates a segment and sums its squares and products; what [`errors`](Self::errors) will need of it goes into a trace.
    #[inline(always)]
    pub(super) fn sums(&self, segment: &SimulatedSegment, trace: Option<&mut Trace>) -> Sums<V> {
        let zero = self.motors.rs.constant(0.0);
        let mut sums = Sums { total: zero, right: [zero; LINEAR_UNKNOWNS], normal: [zero; PAIRS] };
        let mut state = self.start(segment);
        // The first row's error is zero by definition; a first current changes it one for one, except behind a filter.
        for k in 0..FIRST_CURRENT {
            sums.normal[pair(k, k)] = state.response[k][k] * state.response[k][k];
        }
        if !self.take_the_short_path() {
            self.faulty_rows(segment, &mut state, &mut sums, trace);
            return sums;
        }
        let polynomials = &self.polynomials[..];
        for rows in segment.rows_of_periods.chunks(BLOCK) {
            // Whether the first current still matters, and whether there is a first vector, is known to the compiler.
            match (state.forget(), segment.alternates) {
                (false, false) => perfect_rows::<V, C, false, false>(rows, polynomials, &mut state, &mut sums),
                (false, true) => perfect_rows::<V, C, false, true>(rows, polynomials, &mut state, &mut sums),
                (true, false) => perfect_rows::<V, C, true, false>(rows, polynomials, &mut state, &mut sums),
                (true, true) => perfect_rows::<V, C, true, true>(rows, polynomials, &mut state, &mut sums),
            }
        }
        sums
    }

    /// Measured less simulated currents of every row with these values of the linear unknowns, into the trace of its sums.
    #[inline(always)]
    pub(super) fn errors(&self, segment: &SimulatedSegment, linear: &[V; LINEAR_UNKNOWNS], trace: &mut Trace) {
        let lanes = trace.lanes;
        let (first, errors) = trace.errors.split_at_mut(2 * lanes);
        let start = self.start(segment);
        store([-(linear[0] * start.response[0][0]), -(linear[1] * start.response[1][1])], first);
        let errors = errors.chunks_exact_mut(2 * lanes);
        if self.take_the_short_path() {
            let i = [start.i[0] + linear[0], start.i[1] + linear[1]];
            perfect_errors(&segment.rows_of_periods, &self.polynomials, linear, i, errors);
            return;
        }
        for (errors, responses) in errors.zip(trace.responses[..trace.alive].chunks_exact(2 * lanes * LINEAR_UNKNOWNS)) {
            let zero = linear[0].constant(0.0);
            let mut left = load(zero, errors);
            for (value, response) in linear.iter().zip(responses.chunks_exact(2 * lanes)) {
                let [d, q] = load(zero, response);
                left = [left[0] - *value * d, left[1] - *value * q];
            }
            store(left, errors);
        }
    }

    /// Whether there is no fault and no period of a length of its own.
    fn take_the_short_path(&self) -> bool {
        !self.faults.kinds.any() && !self.polynomials.is_empty()
    }

    /// The measured first current, and unit responses.
    #[inline(always)]
    fn start(&self, segment: &SimulatedSegment) -> State<V> {
        let (zero, one) = (self.motors.rs.constant(0.0), self.motors.rs.constant(1.0));
        let measured = segment.measured[0];
        let late_by = segment.periods.first().map_or(0.0, |period| period.late_by);
        let i = self.faults.motor_current([zero.constant(measured.d), zero.constant(measured.q)], segment.turns[0], late_by);
        let unit = |one: V| [[one, zero], [zero, one], [zero; 2], [zero; 2]];
        // A filter's output is what was logged, whatever the current behind it: it need not have settled, as where a log begins with a
        // drive that starts.
        let (response, motor_response) = match self.faults.kinds.filter {
            true => (unit(self.faults.unfiltered_part()), unit(one)),
            false => (unit(one), [[zero; 2]; LINEAR_UNKNOWNS]),
        };
        State { i, error: [zero; 2], response, filtered: i, motor_response }
    }

    /// All rows of drives with faults, or with periods of lengths of their own: block by block, the transitions first.
    #[inline(always)]
    fn faulty_rows(&self, segment: &SimulatedSegment, state: &mut State<V>, sums: &mut Sums<V>, mut trace: Option<&mut Trace>) {
        let mut transitions = Vec::with_capacity(BLOCK);
        for first in (0..segment.periods.len()).step_by(BLOCK) {
            self.transitions(segment, first, &mut transitions);
            state.i[0].call(FaultyBlock {
                motors: &self.motors,
                faults: &self.faults,
                segment,
                first,
                transitions: &transitions,
                held: self.held,
                winding: Winding::of(self.motors.rs, [self.motors.ld, self.motors.lq]),
                state,
                sums,
                trace: trace.as_deref_mut(),
            });
        }
    }

    /// The transitions over the periods of a block.
    #[inline(always)]
    fn transitions(&self, segment: &SimulatedSegment, first: usize, transitions: &mut Vec<TransitionLanes<V>>) {
        let last = (first + BLOCK).min(segment.periods.len());
        let rows = &segment.rows_of_periods[first..last];
        if self.polynomials.is_empty() {
            transitions.clear();
            for (row, period) in rows.iter().zip(&segment.periods[first..last]) {
                transitions.push(TransitionLanes::exact(&self.motors, row.turn, period.length, self.held));
            }
            return;
        }
        // Written in place, because a push copies each of them once more.
        transitions.resize(rows.len(), TransitionLanes::none(self.motors.rs.constant(0.0)));
        for (transition, row) in transitions.iter_mut().zip(rows) {
            *transition = self.polynomials[row.class].at(row.turn, row.place);
        }
    }

    /// What a volt over each period does to linear functions of the simulated currents, one function a lane, of which `weights` gives the
    /// `d, q` of a row. From the last period to the first, by the adjoint equations; into `effects`, of each period the lanes of d, then
    /// those of q.
    #[inline(always)]
    pub(super) fn by_voltage(&self, segment: &SimulatedSegment, weights: impl Fn(usize) -> [V; 2], lanes: usize, effects: &mut [f64]) {
        let mut behind = [self.motors.rs.constant(0.0); 2];
        let mut transitions = Vec::with_capacity(BLOCK);
        for first in (0..segment.periods.len()).step_by(BLOCK).rev() {
            self.transitions(segment, first, &mut transitions);
            for (k, transition) in transitions.iter().enumerate().rev() {
                let row = first + k;
                let TransitionLanes { fdd, fdq, fqd, fqq, gdd, gdq, gqd, gqq, .. } = *transition;
                let own = weights(row + 1);
                let (d, q) = (behind[0] + own[0], behind[1] + own[1]);
                let before = [d * fdd + q * fqd, d * fdq + q * fqq];
                [behind, _] = self.faults.remaining(before, before);
                store([d * gdd + q * gqd, d * gdq + q * gqq], &mut effects[2 * lanes * row..2 * lanes * (row + 1)]);
            }
        }
    }
}

/// Rows of perfect drives.
#[inline(always)]
fn perfect_rows<V: Number, const C: usize, const FIRST: bool, const ALTERNATES: bool>(
    rows: &[PeriodRow],
    polynomials: &[TransitionPolynomials<V, C>],
    state: &mut State<V>,
    sums: &mut Sums<V>,
) {
    let zero = sums.total.constant(0.0);
    for row in rows {
        let transitions = polynomials[row.class].at(row.turn, row.place);
        let i = transitions.after(state.i, zero.constants(row.u));
        state.i = i;
        let measured = zero.constants(row.measured);
        state.error = [measured[0] - i[0], measured[1] - i[1]];
        let [first_d, first_q, alpha, beta] = state.response;
        if FIRST {
            state.response[0] = transitions.response(first_d);
            state.response[1] = transitions.response(first_q);
        }
        if ALTERNATES {
            let [alpha_d, alpha_q] = zero.constants(row.alternating);
            state.response[2] = transitions.driven_response(alpha, [alpha_d, alpha_q]);
            state.response[3] = transitions.driven_response(beta, [-alpha_q, alpha_d]);
        }
        state.add::<FIRST, ALTERNATES>(sums);
    }
}

/// The same from the right start, with the right first vector.
#[inline(always)]
fn perfect_errors<'a, V: Number, const C: usize>(
    rows: &[PeriodRow],
    polynomials: &[TransitionPolynomials<V, C>],
    [_, _, alpha, beta]: &[V; LINEAR_UNKNOWNS],
    mut i: [V; 2],
    errors: impl Iterator<Item = &'a mut [f64]>,
) {
    let zero = alpha.constant(0.0);
    for (row, errors) in rows.iter().zip(errors) {
        let ([u_d, u_q], [alpha_d, alpha_q]) = (zero.constants(row.u), zero.constants(row.alternating));
        let u = [alpha.mul_add(alpha_d, beta.mul_add(-alpha_q, u_d)), alpha.mul_add(alpha_q, beta.mul_add(alpha_d, u_q))];
        i = polynomials[row.class].at(row.turn, row.place).after(i, u);
        let measured = zero.constants(row.measured);
        store([measured[0] - i[0], measured[1] - i[1]], errors);
    }
}

/// Rows of drives with faults as they were simulated, before the linear unknowns are known: of each row the lanes of d, then those of q.
#[derive(Default)]
pub(super) struct Trace {
    lanes: usize,
    /// Measured less simulated current, A.
    pub(super) errors: Vec<f64>,
    /// Responses to each linear unknown, from the second row on, as long as any is left: so many numbers of them. What lies behind is of
    /// another simulation.
    responses: Vec<f64>,
    alive: usize,
}

/// Numbers that a trace keeps for the next simulation: 8 MB a thread. Fresh memory costs a simulation as much time as its arithmetic.
const KEPT: usize = 1 << 20;

impl Trace {
    /// The same memory for another segment. What it held is still there, to be written over: every row is.
    pub(super) fn again(mut self, segment: &SimulatedSegment, lanes: usize) -> Self {
        self.errors.resize(2 * lanes * segment.measured.len(), 0.0);
        Self { lanes, alive: 0, ..self }
    }

    /// Less what would be too much to keep.
    pub(super) fn kept(mut self) -> Self {
        for numbers in [&mut self.errors, &mut self.responses] {
            if numbers.capacity() > KEPT {
                *numbers = Vec::new();
            }
        }
        self
    }

    /// Makes room for the responses of so many periods.
    fn reach(&mut self, periods: usize) {
        self.alive = 2 * self.lanes * LINEAR_UNKNOWNS * periods;
        if self.responses.len() < self.alive {
            self.responses.resize(self.alive, 0.0);
        }
    }
}

/// Rows of drives with faults.
struct FaultyBlock<'a, V> {
    motors: &'a MotorLanes<V>,
    faults: &'a Acting<V>,
    segment: &'a SimulatedSegment,
    first: usize,
    transitions: &'a [TransitionLanes<V>],
    held: Held,
    winding: Winding<V>,
    state: &'a mut State<V>,
    sums: &'a mut Sums<V>,
    trace: Option<&'a mut Trace>,
}

impl<V: Number> NullaryFnOnce for FaultyBlock<'_, V> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let (mut state, mut trace) = (*self.state, self.trace.take());
        let (first, alternates) = (state.forget(), self.segment.alternates);
        let alive = if first { 0 } else { FIRST_CURRENT }..if alternates { LINEAR_UNKNOWNS } else { FIRST_CURRENT };
        if let Some(trace) = trace.as_deref_mut()
            && (first || alternates)
        {
            trace.reach(self.first + self.transitions.len());
        }
        for (k, transitions) in self.transitions.iter().enumerate() {
            self.row(self.first + k, transitions, alive.clone(), &mut state);
            match (first, alternates) {
                (false, false) => state.add::<false, false>(self.sums),
                (false, true) => state.add::<false, true>(self.sums),
                (true, false) => state.add::<true, false>(self.sums),
                (true, true) => state.add::<true, true>(self.sums),
            }
            if let Some(trace) = trace.as_deref_mut() {
                state.write(self.first + k, first || alternates, trace);
            }
        }
        *self.state = state;
    }
}

impl<V: Number> FaultyBlock<'_, V> {
    /// One row, with those responses that are alive. Faults that depend on the current follow the simulated one: the measured one would
    /// bring its noise into the prediction.
    #[inline(always)]
    fn row(&self, row: usize, transitions: &TransitionLanes<V>, alive: Range<usize>, state: &mut State<V>) {
        let segment = self.segment;
        let period = &segment.rows_of_periods[row];
        let zero = self.motors.rs.constant(0.0);
        let [start, filtered] = self.faults.corrected(state.i, state.filtered, state.error);
        let place = segment.place(row);
        let before = segment.rows_of_periods[row.saturating_sub(1)].u;
        let motors = self.motors;
        let linear_flux = [motors.ld.mul_add(start[0], motors.psi_f), motors.lq * start[1]];
        let commanded = self.faults.commanded_voltage(zero.constants(period.u), zero.constants(before), &place);
        let (acting, beyond) = segment.acting(row, place);
        let mut u = self.faults.beside(commanded, start, linear_flux, &acting);
        if self.faults.kinds.loss.any() {
            let mut way = [start, transitions.after(start, u)];
            if beyond > 0.0 {
                let further = both!(axis => zero.constant(beyond) * (way[1][axis] - way[0][axis]));
                way = [[way[0][0] - further[0], way[0][1] - further[1]], [way[1][0] + further[0], way[1][1] + further[1]]];
            }
            let lost = self.faults.lost(commanded, way, &self.winding, &acting);
            u = [u[0] - lost[0], u[1] - lost[1]];
        }
        state.i = if self.faults.kinds.flux {
            self.saturated_step(transitions, zero.constant(place.omega_e), u, start)
        } else {
            transitions.after(start, u)
        };
        let [alpha_d, alpha_q] = zero.constants(period.alternating);
        for k in alive {
            let filter = self.faults.kinds.filter;
            let [of_motor, compared] =
                self.faults.remaining(if filter { state.motor_response[k] } else { state.response[k] }, state.response[k]);
            let after = match k {
                0 | 1 => transitions.response(of_motor),
                2 => transitions.driven_response(of_motor, [alpha_d, alpha_q]),
                _ => transitions.driven_response(of_motor, [-alpha_q, alpha_d]),
            };
            state.response[k] = self.faults.filtered(compared, [of_motor, after], [zero; 2], &place);
            if filter {
                state.motor_response[k] = after;
            }
        }
        let bend = if self.faults.kinds.filter { self.bend(start, &place) } else { [zero; 2] };
        state.filtered = self.faults.filtered(filtered, [start, state.i], bend, &place);
        let measured = self.faults.motor_current(zero.constants(period.measured), place.end, place.late_by);
        state.error = [measured[0] - state.filtered[0], measured[1] - state.filtered[1]];
    }

    /// How the current's way over a period is bent in the stator, A, `d, q`: four times what it is half-way beside the mean of its ends. A
    /// voltage that stands still there leaves the magnets' to bend it, one that turns with the rotor takes the current along an arc. One
    /// that changes half-way puts a kink there.
    #[inline(always)]
    fn bend(&self, i: [V; 2], place: &Place) -> [V; 2] {
        let square = i[0].constant(0.5 * (place.omega_e * place.length).powi(2));
        match self.held {
            Held::InStator => {
                let per_henry = self.winding.per_henry;
                let [kink_d, kink_q] = place.changes.unwrap_or_default().map(|change| -KINK * change * place.length);
                let along = (-square).mul_add(self.motors.psi_f, square.constant(kink_d)) * per_henry[0];
                let across = per_henry[1].constant(kink_q) * per_henry[1];
                let Turn { cos, sin } = place.middle.until(place.end);
                turned([along, across], along.constant(cos), along.constant(-sin))
            }
            Held::InRotor | Held::WithSlope => [square * i[0], square * i[1]],
        }
    }

    /// A step whose flux is not only `L i + psi_f`: what is beyond takes a voltage as any flux does, by its turning and by its growth.
    #[inline(always)]
    fn saturated_step(&self, transitions: &TransitionLanes<V>, omega_e: V, u: [V; 2], i: [V; 2]) -> [V; 2] {
        let flux = self.faults.extra_flux(i);
        let linear = transitions.after(i, [u[0] + omega_e * flux[1], u[1] - omega_e * flux[0]]);
        let mut end = linear;
        for _ in 0..EXTRA_FLUX_ROUNDS {
            let grown = self.faults.extra_flux(end);
            end = both!(axis => self.winding.per_henry[axis].mul_add(flux[axis] - grown[axis], linear[axis]));
        }
        end
    }
}

/// Rounds in which the flux beyond `L i` is found at a period's end: each is a fifth or less of the one before, of a change that is small.
const EXTRA_FLUX_ROUNDS: usize = 3;

impl<V: Number> State<V> {
    /// Sets responses to the first current that have died out to zero; whether any is left.
    #[inline(always)]
    fn forget(&mut self) -> bool {
        let mut left = false;
        let zero = self.error[0].constant(0.0);
        let (one, limit) = (zero.constant(1.0), zero.constant(DIED_OUT));
        for k in 0..FIRST_CURRENT {
            for axis in 0..2 {
                // What a filter holds dies out after what it filters, or before.
                let (response, of_motor) = (self.response[k][axis], self.motor_response[k][axis]);
                // What is no number is kept: it has to be seen.
                left |= zero.any_less(response.abs().if_less(limit, zero, one));
                left |= zero.any_less(of_motor.abs().if_less(limit, zero, one));
                self.response[k][axis] = response.abs().if_less(limit, zero, response);
                self.motor_response[k][axis] = of_motor.abs().if_less(limit, zero, of_motor);
            }
        }
        left
    }

    /// Adds a row to the sums.
    #[inline(always)]
    fn add<const FIRST: bool, const ALTERNATES: bool>(&self, sums: &mut Sums<V>) {
        let [d, q] = self.error;
        sums.total = d.mul_add(d, q.mul_add(q, sums.total));
        let (from, to) = (if FIRST { 0 } else { 2 }, if ALTERNATES { LINEAR_UNKNOWNS } else { 2 });
        for one in from..to {
            let [one_d, one_q] = self.response[one];
            sums.right[one] = one_d.mul_add(d, one_q.mul_add(q, sums.right[one]));
            for other in from..one + 1 {
                let [other_d, other_q] = self.response[other];
                let sum = &mut sums.normal[pair(one, other)];
                *sum = one_d.mul_add(other_d, one_q.mul_add(other_q, *sum));
            }
        }
    }

    /// Writes the error at a period's end into a trace, and the responses, if any is alive.
    #[inline(always)]
    fn write(&self, period: usize, alive: bool, trace: &mut Trace) {
        let row = 2 * trace.lanes;
        store(self.error, &mut trace.errors[row * (period + 1)..row * (period + 2)]);
        if alive {
            for (k, response) in self.response.iter().enumerate() {
                let place = LINEAR_UNKNOWNS * period + k;
                store(*response, &mut trace.responses[row * place..row * (place + 1)]);
            }
        }
    }
}

//! The extended Kalman filter of currents and parameters; without process noise the recursive prediction error method.
//!
//! When to use it: it reaches the Cramér-Rao bound and follows drifting parameters; its intervals hold where the parameters are
//! identifiable. It must start near them, and where they are not identifiable its intervals are too narrow: start and watch it with
//! [`BlockRls`](crate::BlockRls).
//!
//! The state is `(i_d, i_q, z_1..z_4)`: rs and psi_f as parts of nominal values, ld and lq as logarithms of such parts.
//!
//! ```text
//! i <- period(i, u, theta)   z <- z     P <- Phi P Phi' + Q   Phi = [F  S diag(d theta/d z); 0  I]
//! measured: i_d, then i_q, with the variance r, which adapts itself (Mehra 1970, doi 10.1109/TAC.1970.1099422)
//! ```
//!
//! In the inductance itself, the sensitivity of the current grows with 1/L²: a filter that begins with an uncertain inductance and takes
//! the first noise for a small one becomes so certain of it that it stays there. In its logarithm that does not happen.
//!
//! Innovations beyond three standard deviations count as if they were three (Huber).

use crate::{
    PARAMETERS,
    period::{Period, arrival, is_divided_alike},
    real::{Number, Real},
    step_test::{Step, StepTest},
    ud::{STATES, Ud},
    walk::Walk,
};

/// Standard error of a start value, as a part of it.
const START_ERROR: f64 = 0.5;

/// Random walk of rs, ld, lq and psi_f while they are followed, as a part per square root of a second: copper warms fastest, and the
/// inductances drift only as far as the magnets' flux saturates the iron. What changes them with the current is found as steps. A larger
/// walk of lq costs rs: its voltage is that of rs times twenty, and a drift of rs is then taken for one of lq.
const WALK: [f64; PARAMETERS] = [6e-3, 1e-3, 5e-4, 2e-3];

/// Part of the rated current that the noise is thought to be at first.
const START_NOISE: f64 = 5e-3;

/// How fast the variance of the noise adapts: over a thousand periods.
const ADAPTION: f64 = 1e-3;

/// Largest squared innovation that the adaption sees, in variances: five standard deviations.
const LARGEST_SEEN: f64 = 25.0;

/// Least part of the start's variance that the noise's may fall to: a converter's step is not much less.
const LEAST_NOISE: f64 = 1e-4;

/// Standard deviations beyond which an innovation is an outlier.
const OUTLIER: f64 = 3.0;

/// Periods with outliers in a row that are no outliers: the motor changed, and the current that the filter reckons with is wrong.
const OUTLIERS_IN_A_ROW: u32 = 8;

/// Least part of a nominal value that rs, ld and lq may fall to; ld and lq may grow to its inverse.
const LEAST_PART: f64 = 0.05;

/// Which parameters are estimated as logarithms.
const IS_LOGARITHM: [bool; PARAMETERS] = [false, true, true, false];

/// Periods over which [`Ekf::surprise`] is remembered.
pub const SURPRISE_MEMORY: u32 = 100_000;

/// Settings.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EkfSettings<T> {
    /// The values, SI, that are taken as one.
    pub nominal: [T; PARAMETERS],
    /// Standard errors of the start values, as parts of the nominal ones; zero: the parameter is exact.
    pub start_error: [T; PARAMETERS],
    /// Random walk of each parameter, as a part of its nominal value per square root of a second; zero: it is constant.
    pub walk: [T; PARAMETERS],
    /// Standard deviation of an unknown white voltage, V.
    pub unknown_voltage: T,
    /// Variance of the noise of each current at first, A².
    pub noise: T,
    /// Whether steps of a parameter are looked for.
    pub steps: bool,
}

impl<T: Real> EkfSettings<T> {
    /// For constant parameters, of a motor with this rated current, A.
    pub fn constant(nominal: [T; PARAMETERS], rated_current: T) -> Self {
        let noise = T::of(START_NOISE) * rated_current;
        Self {
            nominal,
            start_error: [T::of(START_ERROR); PARAMETERS],
            walk: [T::ZERO; PARAMETERS],
            unknown_voltage: T::ZERO,
            noise: noise * noise,
            steps: false,
        }
    }

    /// For parameters that drift and step.
    pub fn tracking(nominal: [T; PARAMETERS], rated_current: T) -> Self {
        Self { walk: WALK.map(T::of), steps: true, ..Self::constant(nominal, rated_current) }
    }
}

/// What was known when the window of the test for steps began.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Before<T> {
    z: [T; PARAMETERS],
    ud: Ud<T>,
    noise: T,
    /// Parameters of which steps were looked for.
    #[cfg_attr(feature = "serde", serde(default))]
    may_step: [bool; PARAMETERS],
}

/// The filter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ekf<T> {
    settings: EkfSettings<T>,
    is_begun: bool,
    i: [T; 2],
    /// The parameters as parts of the nominal values.
    z: [T; PARAMETERS],
    ud: Ud<T>,
    noise: T,
    test: StepTest<T>,
    before: Before<T>,
    walk: Walk<T>,
    steps: u32,
    outliers: u32,
    /// Periods with outliers in a row, until now.
    in_a_row: u32,
    /// Whether there were so many that the motor has changed.
    is_waiting: bool,
    /// Parameters of which steps are looked for.
    may_step: [bool; PARAMETERS],
    #[cfg_attr(feature = "serde", serde(default))]
    left_out: u32,
    surprise: T,
    last_surprise: T,
}

/// What a measured current told beyond what was expected of it.
struct Innovation<T> {
    /// The variance that was expected, A².
    variance: T,
    /// Its square in such variances, no more than the adaption sees.
    squared: T,
    /// One if it lay beyond three standard deviations, else zero.
    beyond: T,
}

/// Whether all is a number, and the period longer than nothing.
fn is_sound<T: Real>(period: &Period<T>, measured: [T; 2]) -> bool {
    let are_finite = [period.u[0], period.u[1], period.omega_e, measured[0], measured[1]].iter().all(|value| value.is_finite());
    are_finite && period.length > T::ZERO
}

/// What is the same for one filter and for several in the lanes of a vector.
impl<T: Number> Ekf<T> {
    /// A filter of no numbers yet, in whose lanes others are laid.
    pub(crate) fn blank() -> Self {
        let (zeros, two) = ([T::ZERO; PARAMETERS], [T::ZERO; 2]);
        let settings =
            EkfSettings { nominal: zeros, start_error: zeros, walk: zeros, unknown_voltage: T::ZERO, noise: T::ZERO, steps: false };
        let ud = Ud::new([T::ZERO; STATES]);
        Self {
            settings,
            is_begun: true,
            i: two,
            z: zeros,
            ud,
            noise: T::ZERO,
            test: StepTest::new(),
            before: Before { z: zeros, ud, noise: T::ZERO, may_step: [false; PARAMETERS] },
            walk: Walk::new(),
            steps: 0,
            outliers: 0,
            in_a_row: 0,
            is_waiting: false,
            may_step: [false; PARAMETERS],
            left_out: 0,
            surprise: T::ZERO,
            last_surprise: T::ZERO,
        }
    }

    /// Takes over whether steps are looked for and whether the samples excite the parameters.
    pub(crate) fn become_like<U: Number>(&mut self, other: &Ekf<U>) {
        self.settings.steps = other.settings.steps;
        self.walk.note(other.walk.is_excited());
    }

    /// Whether both would be made alike by [`Self::become_like`].
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.settings.steps == other.settings.steps && self.walk.is_excited() == other.walk.is_excited()
    }

    /// Whether all lanes divide the period alike.
    #[inline(always)]
    pub(crate) fn divides_alike(&self, period: &Period<T>) -> bool {
        is_divided_alike(&self.values(), period)
    }

    /// Calls `with` for each setting that [`Self::learn`] reads and that of another filter.
    #[inline(always)]
    pub(crate) fn with_settings_of<U: Number>(&mut self, other: &mut Ekf<U>, with: impl Fn(&mut T, &mut U)) {
        let (own, other) = (&mut self.settings, &mut other.settings);
        for j in 0..PARAMETERS {
            with(&mut own.nominal[j], &mut other.nominal[j]);
            with(&mut own.walk[j], &mut other.walk[j]);
        }
        with(&mut own.unknown_voltage, &mut other.unknown_voltage);
        with(&mut own.noise, &mut other.noise);
    }

    /// Calls `with` for each number that [`Self::learn`] changes and that of another filter.
    #[inline(always)]
    pub(crate) fn with_state_of<U: Number>(&mut self, other: &mut Ekf<U>, with: impl Fn(&mut T, &mut U)) {
        for c in 0..2 {
            with(&mut self.i[c], &mut other.i[c]);
        }
        for j in 0..PARAMETERS {
            with(&mut self.z[j], &mut other.z[j]);
        }
        self.ud.with(&mut other.ud, &with);
        with(&mut self.noise, &mut other.noise);
        if self.settings.steps {
            self.test.with(&mut other.test, &with);
        }
        self.walk.with(&mut other.walk, &with);
        with(&mut self.surprise, &mut other.surprise);
        with(&mut self.last_surprise, &mut other.last_surprise);
    }

    /// Goes on by a period, and learns from the current at its end; `late` as in [`StepTest::note`]. One for each current that lay beyond
    /// three standard deviations, else zero.
    #[inline(always)]
    pub(crate) fn learn(&mut self, period: &Period<T>, measured: [T; 2], late: T) -> [T; 2] {
        let (arrived, phi) = self.predicted(period);
        self.walk(&phi, &self.values(), period);
        self.i = arrived;
        if self.settings.steps {
            self.test.propagate(&phi);
        }
        let of_d = self.measure(0, measured[0], late);
        let of_q = self.measure(1, measured[1], late);
        self.last_surprise = (of_d.variance * of_q.variance).ln() + of_d.squared + of_q.squared;
        self.surprise = self.surprise * T::of(1.0 - 1.0 / f64::from(SURPRISE_MEMORY)) + self.last_surprise;
        [of_d.beyond, of_q.beyond]
    }

    /// The current after a period, and the first two rows of the transition.
    #[inline(always)]
    fn predicted(&self, period: &Period<T>) -> ([T; 2], [[T; STATES]; 2]) {
        let arrived = arrival(&self.values(), self.i, period);
        let (scale, [fd, fq]) = (self.scale(), arrived.by_current);
        let mut phi = [[T::ZERO; STATES]; 2];
        for (c, row) in phi.iter_mut().enumerate() {
            (row[0], row[1]) = (fd[c], fq[c]);
            for j in 0..PARAMETERS {
                row[j + 2] = arrived.by_parameter[j][c] * scale[j];
            }
        }
        (arrived.i, phi)
    }

    /// The covariance after a period, with the unknown voltage and the walk of the parameters.
    #[inline(always)]
    fn walk(&mut self, phi: &[[T; STATES]; 2], theta: &[T; PARAMETERS], period: &Period<T>) {
        let [kick_d, kick_q] = self.kick(theta, period);
        let q = self.settings.walk.map(|walk| walk * walk * period.length);
        let [rs, ld, lq, psi_f] = self.walk.of_all(q);
        self.ud.propagate(phi, &[kick_d, kick_q, rs, ld, lq, psi_f]);
        let (scale, [id, iq], omega) = (self.scale(), self.i, period.omega_e);
        let of_ud = [id * scale[0], T::ZERO, -(omega * iq * scale[2]), T::ZERO];
        let of_uq = [iq * scale[0], omega * id * scale[1], T::ZERO, omega * scale[3]];
        for v in self.walk.of_told(period.length, q, [of_ud, of_uq]).into_iter().flatten() {
            self.ud.add(&[T::ZERO, T::ZERO, v[0], v[1], v[2], v[3]]);
        }
    }

    /// Variance of each current that the unknown voltage makes in a period, A².
    #[inline(always)]
    fn kick(&self, theta: &[T; PARAMETERS], period: &Period<T>) -> [T; 2] {
        [theta[1], theta[2]].map(|l| {
            let kick = period.length * self.settings.unknown_voltage / l;
            kick * kick
        })
    }

    /// Learns from one current.
    #[inline(always)]
    fn measure(&mut self, state: usize, measured: T, late: T) -> Innovation<T> {
        let innovation = measured - self.i[state];
        let explained = self.ud.variance(state);
        let variance = explained + self.noise;
        let (size, deviation) = (innovation.abs(), variance.sqrt());
        let limit = T::of(OUTLIER) * deviation;
        let beyond = size.if_above(limit, T::ONE, T::ZERO);
        let noise = size.if_above(limit, size * deviation / T::of(OUTLIER) - explained, self.noise);
        let measured = self.ud.measure(state, noise);
        if self.settings.steps {
            self.test.note(state, innovation, variance, &measured, late);
        }
        let (mut change, innovation_variance) = measured;
        let step = innovation / innovation_variance;
        for change in &mut change {
            *change = *change * step;
        }
        self.shift(&change);
        let squared = innovation * innovation;
        let seen = (squared - explained).smaller(T::of(LARGEST_SEEN) * self.noise);
        let adapted = self.noise + T::of(ADAPTION) * (seen - self.noise);
        self.noise = adapted.larger(T::of(LEAST_NOISE) * self.settings.noise);
        Innovation { variance, squared: (squared / variance).smaller(T::of(LARGEST_SEEN)), beyond }
    }

    /// Changes the states.
    #[inline(always)]
    fn shift(&mut self, change: &[T; STATES]) {
        self.i[0] += change[0];
        self.i[1] += change[1];
        for j in 0..PARAMETERS {
            let change = change[j + 2];
            if IS_LOGARITHM[j] {
                // Not as a product with the exponential: in single precision that is rounded down more often than up.
                self.z[j] += self.z[j] * change.exp_m1();
                self.z[j] = self.z[j].larger(T::of(LEAST_PART)).smaller(T::of(1.0 / LEAST_PART));
            } else {
                self.z[j] += change;
            }
        }
        self.z[0] = self.z[0].larger(T::of(LEAST_PART));
    }

    /// The parameters, SI.
    #[inline(always)]
    pub fn values(&self) -> [T; PARAMETERS] {
        let (z, nominal) = (&self.z, &self.settings.nominal);
        [z[0] * nominal[0], z[1] * nominal[1], z[2] * nominal[2], z[3] * nominal[3]]
    }

    /// How much each parameter changes with its state.
    #[inline(always)]
    fn scale(&self) -> [T; PARAMETERS] {
        let values = self.values();
        [0, 1, 2, 3].map(|j| if IS_LOGARITHM[j] { values[j] } else { self.settings.nominal[j] })
    }
}

impl<T: Real> Ekf<T> {
    /// A filter at its start values, as parts of the nominal ones.
    pub fn new(settings: EkfSettings<T>, z: [T; PARAMETERS]) -> Self {
        let variance = |j: usize| settings.start_error[j] * settings.start_error[j];
        let of_current = T::of(4.0) * settings.noise;
        let ud = Ud::new([of_current, of_current, variance(0), variance(1), variance(2), variance(3)]);
        let may_step = settings.start_error.map(|error| settings.steps && error > T::ZERO);
        Self {
            settings,
            is_begun: false,
            i: [T::ZERO; 2],
            z,
            ud,
            noise: settings.noise,
            test: StepTest::new(),
            before: Before { z, ud, noise: settings.noise, may_step },
            walk: Walk::new(),
            steps: 0,
            outliers: 0,
            in_a_row: 0,
            is_waiting: false,
            may_step,
            left_out: 0,
            surprise: T::ZERO,
            last_surprise: T::ZERO,
        }
    }

    /// The filter with another covariance of its parameters, as parts of the nominal ones: `W W'` with an upper triangular `W`, as
    /// [`BlockRls::root`](crate::BlockRls::root) has it.
    #[must_use]
    pub fn with_covariance(mut self, w: &[[T; PARAMETERS]; PARAMETERS]) -> Self {
        self.ud.set_parameters(w);
        self
    }

    /// Begins at a measured current, A: at the start, and after a gap. What is known of the parameters stays.
    pub fn begin(&mut self, i: [T; 2]) {
        self.is_begun = i[0].is_finite() && i[1].is_finite();
        self.i = i;
        self.ud.forget_first(2, T::of(4.0) * self.noise);
        self.test = StepTest::new();
        (self.in_a_row, self.is_waiting) = (0, false);
    }

    /// Notes whether the last samples excite the parameters, as [`BlockRls::is_excited`](crate::BlockRls::is_excited) tells: while they do
    /// not, what the operating point does not tell is held, and becomes less certain.
    pub fn note_excitation(&mut self, is_excited: bool) {
        self.walk.note(is_excited);
    }

    /// Notes which parameters the last samples determine: of the others, no steps are looked for, and while there are others, a motor that
    /// behaves otherwise than expected is no sign of a step. At first all are thought to be determined.
    pub fn note_determined(&mut self, is_determined: [bool; PARAMETERS]) {
        let may_step = |j: usize| self.settings.steps && is_determined[j] && self.settings.start_error[j] > T::ZERO;
        self.may_step = [may_step(0), may_step(1), may_step(2), may_step(3)];
    }

    /// Goes on by a period with the current, A, measured at its end. What is no number is left out, as a gap.
    pub fn advance(&mut self, period: &Period<T>, measured: [T; 2]) {
        if !is_sound(period, measured) {
            self.left_out = self.left_out.saturating_add(1);
            self.is_begun = false;
            return;
        }
        if !self.is_begun {
            self.begin(measured);
            return;
        }
        if self.is_waiting {
            self.wait(period, measured);
            return;
        }
        self.open_window();
        let beyond = self.learn(period, measured, self.late());
        self.decide(beyond.map(|beyond| beyond > T::ZERO), measured);
    }

    /// Whether it takes this period with others that do so: nothing is special about it.
    pub(crate) fn goes_along(&self, period: &Period<T>, measured: [T; 2]) -> bool {
        is_sound(period, measured) && self.is_begun && !self.is_waiting
    }

    /// Whether its test for steps is in the last periods of a window: one, else zero.
    pub(crate) fn late(&self) -> T {
        self.test.late()
    }

    /// Keeps what is known at the beginning of a window of the test for steps.
    pub(crate) fn open_window(&mut self) {
        if self.settings.steps && self.test.is_new() {
            self.before = Before { z: self.z, ud: self.ud, noise: self.noise, may_step: self.may_step };
        }
    }

    /// After what was learned of a period: which of both currents lay beyond three standard deviations, and whether the motor changed.
    pub(crate) fn decide(&mut self, beyond: [bool; 2], measured: [T; 2]) {
        let outliers = beyond.iter().filter(|beyond| **beyond).count() as u32;
        self.outliers = self.outliers.saturating_add(outliers);
        self.in_a_row = if outliers == 0 { 0 } else { self.in_a_row + 1 };
        let all_may_step = (0..PARAMETERS).all(|j| self.may_step[j] || self.settings.start_error[j] <= T::ZERO);
        if self.settings.steps && self.in_a_row >= OUTLIERS_IN_A_ROW && all_may_step {
            (self.in_a_row, self.is_waiting, self.i) = (0, true, measured);
            self.test = StepTest::new();
            return;
        }
        if self.settings.steps
            && let Some(step) = self.end_period()
        {
            self.take_step(step, measured);
        }
    }

    /// After a change of the motor it learns nothing for a window, and compares single periods, each from the measured current to the next
    /// one: how long ago the motor changed is of no importance to them.
    fn wait(&mut self, period: &Period<T>, measured: [T; 2]) {
        let (arrived, phi) = self.predicted(period);
        let kick = self.kick(&self.values(), period);
        let late = self.late();
        self.test.forget_current();
        self.test.propagate(&phi);
        self.last_surprise = T::ZERO;
        for c in 0..2 {
            // With the noise of both currents.
            let (innovation, variance) = (measured[c] - arrived[c], self.noise + self.noise + kick[c]);
            self.test.note(c, innovation, variance, &([T::ZERO; STATES], variance), late);
            // As it is, not as it would be usual: else a filter with a wrong setting, which waits again and again, were the most likely.
            self.last_surprise += variance.ln() + (innovation * innovation / variance).smaller(T::of(LARGEST_SEEN));
        }
        self.surprise = self.surprise * T::of(1.0 - 1.0 / f64::from(SURPRISE_MEMORY)) + self.last_surprise;
        self.i = measured;
        let step = self.end_period();
        if self.test.is_new() {
            self.begin(measured);
        }
        if let Some(step) = step {
            self.take_step(step, measured);
        }
    }

    /// A parameter that the samples began to determine in this window did not step: it was not known, and what was learned of it is right.
    fn end_period(&mut self) -> Option<Step<T>> {
        let is_new = (0..PARAMETERS).any(|j| self.may_step[j] && !self.before.may_step[j]);
        self.test.end_period(if is_new { [false; PARAMETERS] } else { self.may_step })
    }

    /// What was learned in the window of a step is wrong: the filter goes on with what it knew before, from the measured current, and
    /// with an uncertainty of the parameter that is as large as the step.
    fn take_step(&mut self, step: Step<T>, measured: [T; 2]) {
        Before { z: self.z, ud: self.ud, noise: self.noise, .. } = self.before;
        let mut wrong = [T::ZERO; STATES];
        wrong[STATES - PARAMETERS + step.parameter] = step.size;
        self.ud.add(&wrong);
        self.begin(measured);
        self.steps = self.steps.saturating_add(1);
    }

    /// Their standard errors, SI.
    pub fn standard_errors(&self) -> [T; PARAMETERS] {
        let scale = self.scale();
        let owed = self.walk.owed();
        [0, 1, 2, 3].map(|j| (self.ud.variance(j + 2) + owed[j]).sqrt() * scale[j].abs())
    }

    /// A filter that knows the same and reckons with another unknown voltage, V.
    #[must_use]
    pub fn with_unknown_voltage(&self, unknown_voltage: T) -> Self {
        Self { settings: EkfSettings { unknown_voltage, ..self.settings }, ..*self }
    }

    /// The settings.
    pub fn settings(&self) -> &EkfSettings<T> {
        &self.settings
    }

    /// Variance of the noise of the currents, A².
    pub fn noise(&self) -> T {
        self.noise
    }

    /// How many steps of parameters were found.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// How many periods were left out, because something in them was no number.
    pub fn left_out(&self) -> u32 {
        self.left_out
    }

    /// How many currents lay beyond three standard deviations.
    pub fn outliers(&self) -> u32 {
        self.outliers
    }

    /// Minus twice the logarithm of the likelihood of the last periods, but for a constant: of several filters that saw the same, the one
    /// with the least value is right (Magill 1965, doi 10.1109/TAC.1965.1098191).
    pub fn surprise(&self) -> T {
        self.surprise
    }

    /// What the last period added to that.
    pub fn last_surprise(&self) -> T {
        self.last_surprise
    }
}

//! The recommended pair: a Kalman filter for values and intervals, started and watched by block least squares, which tells what is
//! identifiable.
//!
//! When to use it: always, unless a processor is too small for it. Of constant parameters it reaches the Cramér-Rao bound (figures:
//! docs/track.md). In the tracking form it follows drifts and steps.
//!
//! - A filter that starts far from the motor is overconfident. So it starts at what block least squares found in the
//!   [lead-in](crate::lead_in).
//! - A bank of filters, each with another level of unknown voltage, decides by the likelihood how much of the innovations is noise of the
//!   currents and how much is voltage that acted but is not in the log. A level that is guessed wrong makes the values biased.
//! - Where a parameter becomes identifiable later, or the filter contradicts the least squares for long, the filter starts anew.

use crate::{
    bank,
    estimate::{Estimate, IDENTIFIABLE},
    rls::{Form, Rls},
    start::Start,
};
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{Ekf, EkfSettings, Period, SURPRISE_MEMORY, bank::Together};
use serde::{Deserialize, Serialize};

/// Levels of unknown voltage, as parts of the largest voltage, a factor of 1.7 apart: 0.01 to 10 V beside 100 V. With levels a factor of
/// three apart, the nearest one makes the values biased by more than their intervals; so does a largest level below what acts.
const LEVELS: [f64; 14] = [0.0, 1e-4, 1.7e-4, 3e-4, 5.2e-4, 1e-3, 1.7e-3, 3e-3, 5.2e-3, 1e-2, 1.7e-2, 3e-2, 5.2e-2, 1e-1];

/// Periods between two choices of the level.
const CHOICE: u64 = 64;

/// Periods for which all levels run; later only the best one and its neighbours.
const ALL_LEVELS: u64 = 5_000;

/// Relative standard error with which least squares is trusted against the filter.
const TRUSTED: f64 = 0.1;

/// Standard errors between both that are a contradiction.
const CONTRADICTION: f64 = 4.0;

/// How many times larger the standard errors of least squares are taken where the filter starts with them: it sees them without their
/// correlation, and some samples twice.
const CAUTION: f64 = 2.0;

/// Part of a value by which a filter that started badly is off: overconfident, it would stay there.
const FAR: f64 = 0.2;

/// Standard errors of least squares by which chance makes the filter differ from it: those errors are about twice too large. A larger
/// difference is part of the filter's interval.
const AGREEMENT: f64 = 0.5;

/// Part of the standard errors of least squares, which are about twice too large, that those of the filter have at least where voltage
/// acts that is not logged. Beside it, noise of the currents is small, and no linear estimator is better than least squares (Gauss and
/// Markov): what a filter seems to know beyond that comes from how it began.
const NO_SURER: f64 = 0.5;

/// Minus twice the logarithm of the likelihood without unlogged voltage, over that with it, from which on there is some: one in 150.
const CERTAIN: f64 = 10.0;

/// Blocks of a contradiction after which the filter starts anew: half a second at 10 kHz.
const PATIENCE: u32 = 100;

/// Blocks after which least squares has forgotten what was before a step or a spell without excitation: 0.99 to this power is 0.05.
const MEMORY: u32 = 300;

/// Periods after which a filter has adapted its noise: it starts with that of its current's size, and forgets this by 1/e in 500 periods.
const SETTLED: u64 = 2500;

/// The pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WatchedEkf {
    rls: Rls,
    start: Start,
    is_tracking: bool,
    /// A filter for each level.
    bank: Vec<Ekf<f64>>,
    active: [bool; LEVELS.len()],
    /// Periods since each level joined.
    ages: [u64; LEVELS.len()],
    #[serde(skip)]
    together: Together,
    best: usize,
    periods: u64,
    /// Current, A, voltage, V, and noise of each current, A, with which a filter starts.
    scale: [f64; 3],
    last_i: [f64; 2],
    /// What least squares said last.
    watch: Estimate,
    was_trusted: [bool; PARAMETERS],
    /// Parameters that began with a guess, and have not become identifiable yet.
    is_guessed: [bool; PARAMETERS],
    contradictions: u32,
    /// Blocks with excitation until least squares has forgotten what no longer holds: so long it does not contradict the filter.
    #[serde(default)]
    outdated: u32,
    /// Steps that were found before it was started anew.
    #[serde(default)]
    steps_before: u32,
    /// Periods since it started, since the last gap, and since it came to know a parameter.
    undisturbed: u64,
}

impl WatchedEkf {
    /// A filter for constant parameters, or one that tracks them, at these values; `scale` has usual current, A, voltage, V, and noise, A.
    /// `is_guessed`: which values are no more than a guess.
    pub fn new(start: &Start, values: [f64; PARAMETERS], is_guessed: [bool; PARAMETERS], scale: [f64; 3], is_tracking: bool) -> Self {
        // Of constant parameters all blocks count.
        let rls = Rls::new(start, values, if is_tracking { Form::Gated } else { Form::Constant });
        let mut pair = Self {
            watch: rls.estimate(),
            rls,
            start: *start,
            is_tracking,
            bank: Vec::with_capacity(LEVELS.len()),
            active: [true; LEVELS.len()],
            ages: [0; LEVELS.len()],
            together: Together::new(),
            best: 0,
            periods: 0,
            scale,
            last_i: [0.0; 2],
            was_trusted: [false; PARAMETERS],
            is_guessed,
            contradictions: 0,
            outdated: 0,
            steps_before: 0,
            undisturbed: 0,
        };
        pair.fill(values, [None; PARAMETERS]);
        pair
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        self.last_i = i;
        self.undisturbed = 0;
        self.rls.begin(i);
        self.bank.iter_mut().for_each(|filter| filter.begin(i));
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, i: [f64; 2]) {
        self.scale = [self.scale[0].max(i[0].hypot(i[1])), self.scale[1].max(period.u[0].hypot(period.u[1])), self.scale[2]];
        self.last_i = i;
        self.undisturbed += 1;
        let steps = self.filter().steps();
        bank::advance(&mut self.together, &mut self.bank, &self.active, period, i);
        if self.filter().steps() != steps {
            self.outdated = MEMORY;
        }
        self.choose();
        if self.rls.advance(period, i) {
            self.note_excitation();
            self.watch = self.rls.estimate();
            self.look();
        }
    }

    /// After each block: whether it excites the parameters, and whether least squares remembers what no longer holds.
    fn note_excitation(&mut self) {
        let was_excited = self.watch.excited == Some(true);
        let is_excited = self.rls.is_excited();
        if was_excited && !is_excited {
            self.outdated = MEMORY;
        } else if is_excited {
            self.outdated = self.outdated.saturating_sub(1);
        }
        let is_determined = self.watch.identifiable.unwrap_or_default();
        for filter in &mut self.bank {
            filter.note_excitation(is_excited);
            filter.note_determined(is_determined);
        }
    }

    /// Whether its likelihood is that of the timing of the voltages, and not of how it started: it has adapted its noise, and the last
    /// samples excite and determine all that it knows.
    pub(crate) fn is_settled(&self) -> bool {
        let is_determined = self.watch.identifiable.unwrap_or_default();
        self.undisturbed >= SETTLED && self.watch.excited == Some(true) && (0..PARAMETERS).all(|j| is_determined[j] || !self.was_trusted[j])
    }

    /// How many parameters it has come to know.
    pub(crate) fn known(&self) -> u32 {
        self.was_trusted.iter().map(|known| u32::from(*known)).sum()
    }

    /// The level with the greatest likelihood, and which levels go on.
    fn choose(&mut self) {
        self.periods += 1;
        if !self.periods.is_multiple_of(CHOICE) {
            return;
        }
        let surprise = |level: usize| self.bank[level].surprise();
        let best = (0..LEVELS.len()).filter(|level| self.active[*level]).min_by(|a, b| surprise(*a).total_cmp(&surprise(*b)));
        self.best = best.unwrap_or(0);
        self.ages.iter_mut().for_each(|age| *age += CHOICE);
        if self.periods < ALL_LEVELS {
            return;
        }
        for level in 0..LEVELS.len() {
            let goes_on = level.abs_diff(self.best) <= 1;
            if goes_on && !self.active[level] {
                self.ages[level] = 0;
                // Joins at what the best one knows.
                self.bank[level] = self.bank[self.best].with_unknown_voltage(self.bank[level].settings().unknown_voltage);
            }
            self.active[level] = goes_on;
        }
    }

    /// After each block: whether the filter starts, or starts anew.
    fn look(&mut self) {
        let Estimate { values, standard_errors: Some(errors), .. } = self.watch else { return };
        let relative: [f64; PARAMETERS] = std::array::from_fn(|j| errors[j] / values[j].abs());
        let filter = &self.bank[self.best];
        let (own, own_errors) = (filter.values(), filter.standard_errors());
        let trusted: [bool; PARAMETERS] = std::array::from_fn(|j| relative[j] < TRUSTED && values[j] > 0.0);
        let contradicts = |j: usize, error: f64| trusted[j] && (own[j] - values[j]).abs() > CONTRADICTION * error;
        let is_off = |j: usize| (own[j] - values[j]).abs() > FAR * values[j] && contradicts(j, errors[j]);
        let is_new = (0..PARAMETERS).any(|j| trusted[j] && (self.is_guessed[j] || !self.was_trusted[j] && is_off(j)));
        let contradicts = (0..PARAMETERS).any(|j| contradicts(j, errors[j].hypot(own_errors[j])));
        self.contradictions = if contradicts && self.outdated == 0 { self.contradictions + 1 } else { 0 };
        for j in 0..PARAMETERS {
            if trusted[j] && !self.was_trusted[j] {
                self.undisturbed = 0;
            }
            self.was_trusted[j] |= trusted[j];
            self.is_guessed[j] &= !trusted[j];
        }
        if is_new || self.contradictions >= PATIENCE {
            self.contradictions = 0;
            self.steps_before += self.filter().steps();
            let values: [f64; PARAMETERS] = std::array::from_fn(|j| if trusted[j] { values[j] } else { own[j] });
            self.fill(values, std::array::from_fn(|j| trusted[j].then_some(CAUTION * relative[j])));
            if trusted == [true; PARAMETERS] && self.start.standard_errors == [None; PARAMETERS] {
                let root = self.rls.root();
                let w = std::array::from_fn(|i| root[i].map(|value| CAUTION * value / values[i]));
                self.bank.iter_mut().for_each(|filter| *filter = filter.with_covariance(&w));
            }
        }
    }

    /// Fills the bank with filters at these values, with these relative standard errors where they are known.
    fn fill(&mut self, values: [f64; PARAMETERS], errors: [Option<f64>; PARAMETERS]) {
        // What is known beforehand is taken from there.
        let known = self.start.standard_errors;
        let nominal: [f64; PARAMETERS] =
            std::array::from_fn(|j| known[j].and(self.start.values[j]).filter(|value| *value > 0.0).unwrap_or(values[j]));
        let current = self.start.rating.map_or(self.scale[0], |rating| rating[0]);
        let mut settings = if self.is_tracking { EkfSettings::tracking(nominal, current) } else { EkfSettings::constant(nominal, current) };
        // With too little noise at first, the filter would be overconfident before it knows better.
        settings.noise = settings.noise.max(self.scale[2] * self.scale[2]);
        for (j, known) in self.start.known(&nominal).into_iter().enumerate() {
            if let Some(error) = known.or(errors[j]) {
                settings.start_error[j] = error;
            }
            if known == Some(0.0) {
                settings.walk[j] = 0.0;
            }
        }
        self.bank.clear();
        self.undisturbed = 0;
        let is_determined = self.watch.identifiable.unwrap_or_default();
        for level in LEVELS {
            let mut filter = Ekf::new(EkfSettings { unknown_voltage: level * self.scale[1], ..settings }, [1.0; PARAMETERS]);
            filter.begin(self.last_i);
            filter.note_determined(is_determined);
            self.bank.push(filter);
        }
        (self.active, self.ages, self.best, self.periods) = ([true; LEVELS.len()], [0; LEVELS.len()], 0, 0);
    }

    /// Whether the last half second excited the parameters.
    pub fn is_excited(&self) -> bool {
        self.rls.is_excited()
    }

    /// The filter that is most likely.
    pub fn filter(&self) -> &Ekf<f64> {
        &self.bank[self.best]
    }

    /// Values and standard errors at the most likely level, which lies between the best one of the bank and a neighbour. Where a log
    /// excites a parameter little, its value differs by up to 15 % from level to level. The log-likelihood is a parabola through three
    /// levels, and so is each value. Errors include the curvature of the values, and the uncertainty of the level.
    fn between_levels(&self) -> ([f64; PARAMETERS], [f64; PARAMETERS]) {
        let best = self.filter();
        let (values, mut errors) = (best.values(), best.standard_errors());
        let neighbour = |level: Option<usize>| level.filter(|level| self.active.get(*level) == Some(&true)).map(|level| &self.bank[level]);
        let (Some(below), Some(above)) = (neighbour(self.best.checked_sub(1)), neighbour(Some(self.best + 1))) else {
            return (values, errors);
        };
        let [lower, higher] = [below, above].map(|other| other.surprise() - best.surprise());
        let bend = lower + higher;
        // The likelihoods of levels that joined at different times cannot be compared.
        let longest = u64::from(SURPRISE_MEMORY).min(self.periods - self.periods % CHOICE);
        let are_comparable = (self.best - 1..=self.best + 1).all(|level| self.ages[level] >= longest);
        if !are_comparable || bend <= 0.0 {
            return (values, errors);
        }
        // Both count in steps of the bank. Minus twice the log-likelihood grows by one within a standard deviation.
        let (place, deviation) = ((0.5 * (lower - higher) / bend).clamp(-0.5, 0.5), (2.0 / bend).sqrt());
        let (of_below, of_above, errors_of) = (below.values(), above.values(), if place < 0.0 { below } else { above }.standard_errors());
        let mut between = values;
        for j in 0..PARAMETERS {
            let slope = 0.5 * (of_above[j] - of_below[j]);
            let curve = 0.5 * (of_above[j] + of_below[j]) - values[j];
            between[j] += place * slope + place * place * curve;
            let own = errors[j] + place.abs() * (errors_of[j] - errors[j]);
            errors[j] = own.hypot(place * place * curve).hypot(deviation.min(0.5) * slope);
        }
        (between, errors)
    }

    /// Whether voltage acts that is not logged: the level without any is far less likely, or no longer compared.
    fn is_disturbed(&self) -> bool {
        self.best > 0 && !(self.active[0] && self.bank[0].surprise() - self.filter().surprise() < CERTAIN)
    }

    /// Standard errors with what least squares contradicts in them, and no smaller than its own allow. A filter that was far off while it
    /// began, or that did not see a step in much unknown voltage, is surer than it may be, and stays wrong for seconds.
    fn beside_least_squares(&self, values: &[f64; PARAMETERS], mut errors: [f64; PARAMETERS]) -> [f64; PARAMETERS] {
        let Some(of_watch) = self.watch.standard_errors else { return errors };
        let is_told = |j: &usize| of_watch[*j] < TRUSTED * self.watch.values[*j] && self.start.standard_errors[*j].is_none();
        for j in (0..PARAMETERS).filter(is_told) {
            let beyond = (values[j] - self.watch.values[j]).abs() - AGREEMENT * of_watch[j];
            errors[j] = errors[j].hypot(beyond.max(0.0));
            if self.is_disturbed() {
                errors[j] = errors[j].max(NO_SURER * of_watch[j]);
            }
        }
        errors
    }

    /// How many steps of parameters were found.
    pub fn steps(&self) -> u32 {
        self.steps_before + self.filter().steps()
    }

    /// Values and intervals of the filter; what is identifiable, by least squares.
    pub fn estimate(&self) -> Estimate {
        let (values, errors) = self.between_levels();
        let errors = self.beside_least_squares(&values, errors);
        let is_known = |j: usize| self.start.standard_errors[j].is_some() && errors[j] < IDENTIFIABLE * values[j].abs();
        let of_watch = self.watch.identifiable.unwrap_or_default();
        Estimate {
            values,
            standard_errors: Some(errors),
            identifiable: Some(std::array::from_fn(|j| of_watch[j] || is_known(j))),
            excited: self.watch.excited,
        }
    }
}

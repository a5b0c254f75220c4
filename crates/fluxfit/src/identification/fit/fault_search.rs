//! The search for faults: which [faults of the drive](crate::faults) explain what the simulated currents miss.
//!
//! A fault is first judged where its numbers are zero, by how much of the residual its derivatives explain beyond the other unknowns' (a
//! score test); it is fitted only if that promises enough. It becomes part of the answer if
//!
//! - Schwarz's criterion is very strong evidence for it, `N ln(cost before / cost after) > unknowns ln N + 10`, with `N` independent
//!   residuals, fewer than there are rows where they are correlated (G. Schwarz, Ann. Stat. 6 (1978) 461, doi:10.1214/aos/1176344136);
//! - its value is physical;
//! - it moves a parameter by more than its standard error, or takes away a noticeable part of the residual, so that intervals become
//!   narrower.
//!
//! The best fault is taken first; then the reading of the voltages is chosen again, because a fault can look like a delay, and the other
//! faults are judged again beside it.

use super::{
    fault_trial::{FaultOutcome, FaultTrial},
    long_run::effective_sample_size,
    output_errors::sensors,
    readings::{self, HOPELESS, HOPELESS_AFTER_A_FIT, Rules, TimingTrial, VERY_STRONG, contest, in_the_running},
    voltage_accuracy::{self, VoltageAccuracy},
};
use crate::{
    faults::{AngleNeed, Fault, Faults},
    levenberg_marquardt::{
        Linearized, Polished, PriorResidual, linearized, linearized_one, polish_to_beat, polish_to_choose, step, with_priors,
    },
    motor::{PARAMETERS, Parameter},
    normal_matrix::{NormalMatrix, dot},
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
    parallel,
};
use nalgebra::DVector;
use std::f64::consts::PI;

/// Largest angle from row to row, rad, at which harmonics of the flux are looked for: a quarter of a turn of the sixth, half of that where
/// rows need not be the drive's periods. Beyond, they take what voltages held for a row lack of that frequency.
const HARMONICS_WITHIN: f64 = PI / 12.0;

/// Least part of the residual's power that a fault must explain to be taken when no parameter moves, or beside rough saturation.
pub(super) const NOTICEABLE: f64 = 0.02;

/// The same of a filter that is faster than rows that are means, and of voltages that lag: they take some hundredths of what voltages do
/// within these rows, which is not in the log, and stand in for it in logs without either.
pub(super) const WITHIN_ROWS: f64 = 0.1;

/// Beside dead time, a filter faster than this part of a row must explain [`WITHIN_ROWS`] of the residual: its effect is as small as the
/// error of the loss model. Logs without a filter had one found, with R_s 3 to 24 % off; where the rotor turned by 0.4 rad a row, it
/// explained 7 %.
const FAST_FILTER: f64 = 0.03;

/// A fault is not fitted where the score test expects less than this part of what would matter: it is not more wrong than that.
const LEAST_EXPECTED: f64 = 0.25;

/// Residuals below this fraction of the largest current are rounding and the model's own discretization: nothing to explain.
pub(crate) const LEAST_RESIDUAL: f64 = 1e-4;

/// Residuals below this fraction of the largest current change no answer: by so much a current sampled between two pulses differs from the
/// mean of its ripple, in a log without noise. Of 300 A and 110 uH at 350 V and 10 kHz they were 1e-4, of 25 A and 18 uH at 24 V and 24 kHz
/// 6e-4.
pub(crate) const RIPPLE: f64 = 1e-3;

/// Faults that are taken at most: a drive with more is not what this log is about, and each costs as much as all before it.
const MOST_TAKEN: usize = 6;

/// The search, and where it stands.
#[derive(Clone)]
pub(crate) struct FaultSearch<'a> {
    /// The output error under each reading of the voltages.
    pub(crate) objectives: &'a [(VoltageTiming, OutputError)],
    /// The reading that fits best now, by its place among them.
    pub(crate) reading: usize,
    /// Those that are still in the running.
    pub(crate) open: Vec<usize>,
    pub(crate) priors: &'a [PriorResidual],
    pub(crate) drive: Adjustable,
    pub(crate) unknowns: Vec<Unknown>,
    /// Faults that are among the unknowns from the beginning.
    pub(crate) begun_with: Vec<FaultTrial>,
    pub(crate) cost: f64,
    pub(crate) voltage_accuracy: f64,
    /// Whether the rows may be the drive's own periods.
    pub(crate) every_period: bool,
    /// The longest time from row to row, s.
    pub(crate) row_period: f64,
    /// The largest angle from row to row, rad.
    pub(crate) row_turn: f64,
    /// Whether most rows belong to operating points that do not tell an angle that is off.
    pub(crate) points_tell_no_angle: bool,
    /// Every reading with this drive's faults, the best first; empty where they were not compared since it changed.
    pub(crate) compared: Vec<(usize, TimingTrial)>,
    /// Faults that were taken in a search before, and whose values lost their meaning beside others: their families are left out.
    pub(crate) ruled_out: Vec<Fault>,
    /// The first fault that was taken although another one, beside which it has no meaning, explains more without it.
    pub(crate) contested: Option<Fault>,
}

impl FaultSearch<'_> {
    /// The first of these faults whose values have no physical meaning any more.
    pub(crate) fn unphysical(&self, trials: &[FaultTrial]) -> Option<Fault> {
        self.unphysical_in(&self.drive, trials)
    }

    /// The filter of currents that stands in for something else, as the end of a search tells: what it passes of the noise is no part.
    pub(crate) fn stand_in(&self, trials: &[FaultTrial]) -> Option<Fault> {
        let mut taken = trials.iter().filter(|trial| trial.outcome == FaultOutcome::Taken).map(|trial| trial.fault);
        taken.find(|fault| fault.is_filter() && fault.alters_measured_current()).filter(|_| !self.drive.faults.filter.passes_a_part())
    }

    /// The same in another drive.
    fn unphysical_in(&self, drive: &Adjustable, trials: &[FaultTrial]) -> Option<Fault> {
        unphysical(trials, drive, self.objective().peak_current())
    }

    /// The output error under the reading that fits best now.
    pub(super) fn objective(&self) -> &OutputError {
        &self.objectives[self.reading].1
    }

    /// Whether another search stands where this one does.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.reading == other.reading && self.unknowns == other.unknowns && (self.cost / other.cost - 1.0).abs() < ALIKE
    }

    /// Adds the faults that the log carries; then the observer goes again, if they have made it useless. Everything that was tried is
    /// returned, faults that were taken first.
    pub(crate) fn run(&mut self, observer: Option<&FaultTrial>) -> Vec<FaultTrial> {
        // What stands in for a fault without the angle is no candidate beside it.
        let stands_in = |fault: Fault| fault.angle_need() == AngleNeed::OnlyTraced && self.objective().angle_known();
        let is_logged = |fault: Fault| fault == Fault::DcVoltage && self.objective().bus_known();
        let is_there = |fault: Fault| self.unknowns.iter().any(|unknown| unknown.fault() == Some(fault));
        let is_out = |fault: Fault| fault == Fault::Disturbance || stands_in(fault) || is_logged(fault) || is_there(fault);
        let faults: Vec<Fault> = Fault::ALL.into_iter().filter(|fault| !is_out(*fault)).collect();
        let mut taken = self.begun_with.clone();
        let mut not_taken = self.add(&faults, &mut taken);
        if self.choose_filter(&mut taken) {
            not_taken = self.add(&faults, &mut taken);
        }
        if taken.len() > 1 {
            self.choose_kinds(&taken, false);
        }
        let was_disturbed = self.is_disturbed();
        if self.every_period && was_disturbed {
            self.exchange_filter(&faults, &mut taken);
        }
        let observer = match observer {
            Some(_) => self.drop_observer(&taken),
            None => FaultTrial::not_judged(Fault::Disturbance, FaultOutcome::NotNeeded),
        };
        if was_disturbed && !self.is_disturbed() {
            // An observer follows a part of what a fault does: without it, more of the fault shows.
            not_taken = self.add(&faults, &mut taken);
        }
        let in_doubt = [self.drop_needless(&mut taken), self.exchange_winding(&taken), self.choose_delay(&mut taken)].concat();
        let in_doubt = [in_doubt, self.drop_angle_of_points(&mut taken)].concat();
        not_taken.retain(|trial| !taken.iter().chain(&in_doubt).any(|other| other.fault == trial.fault));
        let mut all: Vec<FaultTrial> = taken.into_iter().chain([observer]).chain(in_doubt).chain(not_taken).collect();
        all.sort_by_key(|trial| trial.outcome != FaultOutcome::Taken);
        all
    }

    /// Adds faults to those `taken` as long as one deserves it; returns the trials of the others.
    fn add(&mut self, faults: &[Fault], taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        while taken.len() < MOST_TAKEN {
            let trials = self.take_best(faults, taken);
            match trials.iter().find(|trial| trial.outcome == FaultOutcome::Taken) {
                Some(best) => taken.push(best.clone()),
                None => return trials,
            }
            self.choose_kinds(&taken[taken.len() - 1..], true);
            self.choose_reading();
        }
        Vec::new()
    }

    /// Whether saturation and an observer are there: saturation's terms are a few of a curve's, and what they leave passes for other
    /// faults.
    fn is_rough(&self) -> bool {
        self.is_disturbed() && self.unknowns.iter().any(|unknown| unknown.fault() == Some(Fault::Saturation))
    }

    /// Whether there is an observer.
    fn is_disturbed(&self) -> bool {
        self.unknowns.iter().any(|unknown| unknown.is_observer_gain())
    }

    /// Chooses the reading of the voltages again: with the faults found, another one may fit better.
    pub(super) fn choose_reading(&mut self) {
        let independent = effective_sample_size(&self.objective().residuals(&self.drive));
        self.compare_readings(self.mean_square() * readings::ruled_out_above(independent));
    }

    /// The same, of those that may come below a mean square, A².
    fn compare_readings(&mut self, to_beat: f64) {
        let lags = self.unknowns.iter().any(|unknown| unknown.fault() == Some(Fault::VoltageLag));
        self.open.retain(|place| !lags || self.objectives[*place].0.may_lag());
        let starts = self.open.iter().map(|place| (*place, self.drive)).collect();
        let rules = Rules { to_beat, ..Rules::all(HOPELESS_AFTER_A_FIT) };
        self.compared = contest(self.objectives, starts, &self.unknowns, self.priors, &rules);
        if let Some((place, best)) = self.compared.first() {
            (self.reading, self.drive, self.cost) = (*place, best.polished.drive, best.polished.cost);
            self.open = in_the_running(&self.compared);
        }
    }

    /// Some faults have kinds of which no fit leads from one to the other: another one may fit better, now that their numbers are known;
    /// `under_other_readings` too, where asked, because a half of the carrier passes for a delay.
    fn choose_kinds(&mut self, taken: &[FaultTrial], under_other_readings: bool) {
        let mut starts = self.kinds(taken, &self.drive);
        starts.retain(|(reading, _)| under_other_readings || *reading == self.reading);
        let now = self.present();
        let fitted = contest(self.objectives, starts, &self.unknowns, self.priors, &Rules { to_beat: now.rank(), ..KINDS });
        if let Some((reading, best)) = fitted.first().filter(|(_, best)| best.rank() < now.rank()) {
            (self.reading, self.drive, self.cost) = (*reading, best.polished.drive, best.polished.cost);
            self.compared.clear();
        }
    }

    /// The present fit.
    pub(super) fn present(&self) -> TimingTrial {
        let (timing, objective) = &self.objectives[self.reading];
        let polished = Polished { drive: self.drive, cost: self.cost, converged: false };
        TimingTrial { timing: *timing, polished, rows: objective.rows() }
    }

    /// A drive with all kinds of its faults, under every reading.
    pub(super) fn kinds(&self, taken: &[FaultTrial], drive: &Adjustable) -> Vec<(usize, Adjustable)> {
        let peak = self.objective().peak_current();
        let kinds: Vec<Faults> = taken.iter().flat_map(|trial| trial.fault.kinds(&drive.faults, peak)).collect();
        let with = |reading: usize| kinds.iter().map(move |faults| (reading, Adjustable { faults: *faults, ..*drive }));
        self.open.iter().copied().flat_map(with).collect()
    }

    /// A filter of the voltages, with a reading that suits it, may stand in for an angle that is late: the search goes back to before it,
    /// and tries another fault under another reading in its place.
    fn exchange_filter(&mut self, faults: &[Fault], taken: &mut [FaultTrial]) {
        let is_filter = |trial: &FaultTrial| [Fault::DqVoltageFilter, Fault::DqFilter].contains(&trial.fault);
        let Some(place) = taken.iter().position(is_filter) else { return };
        let filter = taken[place].fault;
        let drive = Unknown::of_fault(filter).fold(self.drive, |drive, unknown| drive.with(unknown, 0.0));
        let mut without = FaultSearch { drive, ..self.clone() };
        without.unknowns.retain(|unknown| unknown.fault() != Some(filter));
        without.compare_readings(0.0);
        let rest: Vec<FaultTrial> = taken.iter().filter(|trial| trial.fault != filter).cloned().collect();
        let candidates: Vec<Fault> = faults.iter().copied().filter(|fault| fault.family() != filter.family()).collect();
        let best = without.compared.iter().take(EXCHANGED_READINGS).filter_map(|(reading, trial)| {
            let (drive, cost) = (trial.polished.drive, trial.polished.cost);
            let mut search = FaultSearch { reading: *reading, drive, cost, compared: Vec::new(), ..without.clone() };
            let found = search.take_best(&candidates, &rest).into_iter().find(|trial| trial.outcome == FaultOutcome::Taken)?;
            Some((search, found))
        });
        let best = best.min_by(|(one, _), (other, _)| one.mean_square().total_cmp(&other.mean_square()));
        if let Some((search, found)) = best.filter(|(search, _)| search.mean_square() < self.mean_square()) {
            *self = search;
            taken[place] = found;
            self.choose_reading();
        }
    }

    /// Whether it is a filter, and faster than rows that are means.
    fn is_within_rows(&self, fault: Fault, drive: &Adjustable) -> bool {
        matches!(self.objectives[self.reading].0, VoltageTiming::Averaged { .. }) && self.is_faster(fault, drive, 1.0)
    }

    /// Whether it is a filter so fast that it may be the error of the loss model beside it.
    pub(super) fn may_be_loss(&self, fault: Fault, drive: &Adjustable) -> bool {
        let family = Fault::DeadTime.family();
        let has_loss = || self.unknowns.iter().filter_map(|unknown| unknown.fault()).any(|fault| fault.family() == family);
        self.is_faster(fault, drive, FAST_FILTER) && has_loss()
    }

    /// Whether it is a filter that is faster than this part of a row.
    fn is_faster(&self, fault: Fault, drive: &Adjustable, part: f64) -> bool {
        let time_constant = || Unknown::of_fault(fault).next().map(|time_constant| drive.get(time_constant));
        fault.is_filter() && time_constant().is_some_and(|time| time < part * self.row_period)
    }

    /// Mean square of a residual, A².
    pub(super) fn mean_square(&self) -> f64 {
        self.cost / (2 * self.objective().rows()) as f64
    }

    /// Whether a drive fits better than the present one even without a fault that the present one has.
    fn explains_more_without(&self, lost: Fault, drive: &Adjustable, unknowns: &[Unknown]) -> bool {
        let start = Unknown::of_fault(lost).fold(*drive, |drive, unknown| drive.with(unknown, 0.0));
        let unknowns: Vec<Unknown> = unknowns.iter().copied().filter(|unknown| unknown.fault() != Some(lost)).collect();
        polish_to_beat(self.cost, self.objective(), &start, &unknowns, self.priors).cost < self.cost
    }

    /// Judges faults; of those that deserve it the best is taken, and comes first.
    pub(super) fn take_best(&mut self, faults: &[Fault], taken: &[FaultTrial]) -> Vec<FaultTrial> {
        let test = ScoreTest::of(self, faults);
        let left: Vec<Fault> = faults.iter().copied().filter(|fault| !taken.iter().any(|taken| taken.fault == *fault)).collect();
        let this = &*self;
        let outcome = |fault: &Fault| {
            if taken.iter().any(|taken| taken.fault.excludes(*fault)) {
                FaultOutcome::Covered
            } else if this.ruled_out.iter().any(|ruled_out| ruled_out.family() == fault.family()) {
                FaultOutcome::NotPhysical
            } else if *fault == Fault::VoltageLag && !this.objectives[this.reading].0.may_lag() {
                FaultOutcome::Covered
            } else if !fault.angle_need().is_met(this.objective().angle_known(), this.objective().angle_traced()) {
                FaultOutcome::NeedsAngle
            } else if fault.needs_turning() && !this.objective().turns() {
                FaultOutcome::NeedsTurning
            } else if *fault == Fault::FluxHarmonics && this.row_turn > HARMONICS_WITHIN / if this.every_period { 1.0 } else { 2.0 } {
                FaultOutcome::NeedsCloserRows
            } else {
                FaultOutcome::NotNeeded
            }
        };
        let (judged, others): (Vec<Fault>, Vec<Fault>) = left.into_iter().partition(|fault| outcome(fault) == FaultOutcome::NotNeeded);
        let judged = judged.iter().zip(test.expected(self, &judged)).map(|(fault, Expected { gain, moves, starts })| {
            (FaultTrial { gain, moves, ..FaultTrial::not_judged(*fault, FaultOutcome::NotNeeded) }, starts)
        });
        let others = others.iter().map(|fault| (FaultTrial::not_judged(*fault, outcome(fault)), Vec::new()));
        let mut trials: Vec<(FaultTrial, Vec<Adjustable>)> = judged.chain(others).collect();
        trials.sort_by(|(one, _), (other, _)| other.gain.total_cmp(&one.gain));
        for place in 0..trials.len() {
            let (trial, starts) = &mut trials[place];
            if trial.gain <= VERY_STRONG {
                break;
            }
            if starts.is_empty() {
                trial.outcome = FaultOutcome::NoMatter;
                continue;
            }
            let Some(fitted) = test.fit(self, trial.fault, starts) else { continue };
            *trial = fitted.trial;
            if trial.outcome == FaultOutcome::Taken {
                let Fitted { drive, cost, unknowns, .. } = fitted;
                if let Some(lost) = self.unphysical_in(&drive, taken) {
                    trial.outcome = FaultOutcome::NotPhysical;
                    if self.contested.is_none() && self.explains_more_without(lost, &drive, &unknowns) {
                        self.contested = Some(lost);
                    }
                    continue;
                }
                (self.drive, self.cost, self.unknowns) = (drive, cost, unknowns);
                self.compared.clear();
                trials.swap(0, place);
                break;
            }
        }
        trials.into_iter().map(|(trial, _)| trial).collect()
    }
}

/// The first fault that was taken and whose values no drive has; of the observer's, nothing is asked.
pub(super) fn unphysical(trials: &[FaultTrial], drive: &Adjustable, peak: f64) -> Option<Fault> {
    let mut taken = trials.iter().filter(|trial| trial.outcome == FaultOutcome::Taken && trial.fault != Fault::Disturbance);
    taken.find(|trial| !trial.fault.is_physical(&drive.faults, &drive.motor, peak)).map(|trial| trial.fault)
}

/// Readings under which a filter is exchanged for another fault.
const EXCHANGED_READINGS: usize = 4;

/// Of the kinds of a fault: as they stand, most are far from the best.
pub(super) const KINDS: Rules = Rules { stepped: 6, fitted: 3, ..Rules::all(HOPELESS) };

/// A parameter that a fault moves by so many times its value has run away, as where columns are exchanged or turned over: no fault of a
/// drive hides a parameter to that degree.
const RUNS_AWAY: f64 = 100.0;

/// Starts of faults whose derivatives are computed side by side: they fill the lanes of both cores, and their residuals the memory.
const SIDE_BY_SIDE: usize = 8;

/// Starts of a fault that are fitted: the most promising of all.
const FITTED_STARTS: usize = 2;

/// Costs of two searches that differ by less than this part are of the same fit: fits that choose end so near to a minimum.
const ALIKE: f64 = 1e-3;

/// Cost of a start, over that without the fault, beyond which its derivatives say nothing of the fit: it is unstable.
const TOO_FAR: f64 = 1e4;

/// Schwarz's criterion for so many further unknowns, given how many independent residuals there are.
pub(super) fn schwarz(before: f64, after: f64, unknowns: usize, independent: f64) -> f64 {
    if before <= 0.0 || after >= before || after.is_nan() {
        return f64::NEG_INFINITY;
    }
    if before.is_infinite() {
        return f64::INFINITY;
    }
    // A cost of zero explains everything, once.
    let after = after.max(f64::EPSILON * before);
    independent * (before / after).ln() - unknowns as f64 * independent.ln()
}

/// What the score test expects of a fault.
struct Expected {
    /// What it gains by Schwarz's criterion.
    gain: f64,
    /// How far it moves each parameter, SI.
    moves: [f64; PARAMETERS],
    /// Where to start its fit; nowhere if it would not matter.
    starts: Vec<Adjustable>,
}

/// The same from one of its starts.
#[derive(Clone, Copy)]
struct FromStart {
    gain: f64,
    moves: [f64; PARAMETERS],
    /// Whether it may matter.
    matters: bool,
}

impl FromStart {
    /// Of a start that says nothing.
    const NOTHING: Self = Self { gain: f64::NEG_INFINITY, moves: [0.0; PARAMETERS], matters: false };
}

/// A fault that was fitted beside the others.
struct Fitted {
    trial: FaultTrial,
    drive: Adjustable,
    cost: f64,
    unknowns: Vec<Unknown>,
}

/// Residuals and derivatives without the faults that are judged.
struct ScoreTest {
    residuals: Vec<f64>,
    jacobian: Vec<Vec<f64>>,
    normal: NormalMatrix,
    /// Standard errors of the motor's unknowns, roughly.
    standard_errors: Vec<f64>,
    /// How many independent residuals there are.
    independent: f64,
    peak: f64,
}

impl ScoreTest {
    fn of(search: &FaultSearch, faults: &[Fault]) -> Self {
        let FaultSearch { drive, unknowns, cost, priors, .. } = search;
        let objective = search.objective();
        let Linearized { mut residuals, slopes } = linearized_one(objective, drive, unknowns);
        // An observer takes away the correlation of the residuals: where it is judged, every row counts.
        let independent = if faults.contains(&Fault::Disturbance) { residuals.len() as f64 } else { effective_sample_size(&residuals) };
        // What priors hold a fault does not move.
        let jacobian = with_priors(slopes, unknowns, priors);
        residuals.extend(priors.iter().map(|belief| belief.weight * (belief.value - drive.get(belief.unknown))));
        let normal = NormalMatrix::of(&jacobian);
        let inverse = normal.inverse();
        let accuracy = VoltageAccuracy { fraction: search.voltage_accuracy, ..VoltageAccuracy::default() };
        let [accuracy] = voltage_accuracy::covariances(objective, drive, &inverse, &jacobian, [accuracy]);
        let noise = inverse.diagonal() * (cost / independent);
        let standard_errors = (noise + accuracy.diagonal()).iter().map(|variance| variance.max(0.0).sqrt()).collect();
        Self { residuals, jacobian, normal, standard_errors, independent, peak: objective.peak_current() }
    }

    /// What to expect of each fault if the cost were as quadratic as it looks from its starts.
    fn expected(&self, search: &FaultSearch, faults: &[Fault]) -> Vec<Expected> {
        let nothing_left = (search.cost / self.residuals.len() as f64).sqrt() <= LEAST_RESIDUAL * self.peak;
        let starts = |fault: &Fault| if nothing_left { Vec::new() } else { fault.starts(&search.drive.faults, self.peak) };
        let starts = faults.iter().enumerate().flat_map(|(place, fault)| starts(fault).into_iter().map(move |faults| (place, faults)));
        let starts: Vec<(usize, Adjustable)> =
            starts.map(|(place, faults)| (place, Adjustable { faults, ..search.drive }.calmed())).collect();
        let mut each: Vec<Vec<(FromStart, Adjustable)>> = vec![Vec::new(); faults.len()];
        for starts in starts.chunks(SIDE_BY_SIDE) {
            let drives: Vec<(Adjustable, Vec<Unknown>)> =
                starts.iter().map(|(place, start)| (*start, Unknown::of_fault(faults[*place]).collect())).collect();
            let linearized = linearized(search.objective(), &drives).into_iter().zip(&drives);
            let linearized: Vec<Linearized> =
                linearized.map(|(start, (_, own))| Linearized { slopes: with_priors(start.slopes, own, search.priors), ..start }).collect();
            let expected = parallel::map(&linearized, |start| self.expected_from(search, start));
            starts.iter().zip(expected).for_each(|((place, start), expected)| each[*place].push((expected, *start)));
        }
        let best_first = |mut each: Vec<(FromStart, Adjustable)>| {
            each.sort_by(|(one, _), (other, _)| other.gain.total_cmp(&one.gain));
            let FromStart { gain, moves, .. } = each.first().map_or(FromStart::NOTHING, |(best, _)| *best);
            let fitted = if each.iter().any(|(expected, _)| expected.matters) { FITTED_STARTS } else { 0 };
            Expected { gain, moves, starts: each.into_iter().take(fitted).map(|(_, start)| start).collect() }
        };
        each.into_iter().map(best_first).collect()
    }

    /// The same of one start.
    fn expected_from(&self, search: &FaultSearch, start: &Linearized) -> FromStart {
        let cost = dot(&start.residuals, &start.residuals);
        if cost.is_nan() || cost > TOO_FAR * search.cost {
            return FromStart::NOTHING;
        }
        let columns = self.jacobian.iter().chain(&start.slopes);
        let right = DVector::from_iterator(columns.clone().count(), columns.map(|column| dot(column, &self.residuals)));
        // The slopes are those of measured less simulated currents.
        let shifts = self.normal.with(&self.jacobian, &start.slopes).inverse() * -&right;
        let explained = -right.dot(&shifts);
        let place = |parameter| search.unknowns.iter().position(|unknown| *unknown == Unknown::Motor(parameter));
        let is_moved = |k: usize| shifts[k].abs() > LEAST_EXPECTED * self.standard_errors[k];
        FromStart {
            gain: schwarz(search.cost, search.cost - explained.min(search.cost), start.slopes.len(), self.independent),
            moves: Parameter::ALL.map(|parameter| place(parameter).map_or(0.0, |k| shifts[k])),
            matters: Parameter::ALL.into_iter().filter_map(place).any(is_moved) && !search.is_rough()
                || explained > LEAST_EXPECTED * NOTICEABLE * search.cost,
        }
    }

    /// Fits a fault from these starts, and decides whether to take it.
    fn fit(&self, search: &FaultSearch, fault: Fault, starts: &[Adjustable]) -> Option<Fitted> {
        let own: Vec<Unknown> = Unknown::of_fault(fault).collect();
        let unknowns = [&search.unknowns[..], &own].concat();
        let stepped = parallel::map(starts, |start| step(search.objective(), start, &unknowns, search.priors));
        let best = stepped.into_iter().min_by(|one, other| one.cost.total_cmp(&other.cost))?;
        let Polished { drive, cost, .. } = polish_to_choose(search.objective(), &best.drive, &unknowns, search.priors);
        let gain = schwarz(search.cost, cost, own.len(), self.independent);
        let moves = Parameter::ALL.map(|parameter| drive.motor.get(parameter) - search.drive.motor.get(parameter));
        // Gains that differ leave open which of them is right.
        let in_doubt = sensors(&drive);
        let is_moved = search.unknowns.iter().zip(&self.standard_errors).any(|(unknown, standard_error)| match unknown {
            Unknown::Motor(parameter) => moves[*parameter as usize].abs().max(in_doubt[*parameter as usize]) > *standard_error,
            Unknown::Fault(_) => false,
        });
        // An observer need not be physical yet: it makes residuals white while faults are looked for.
        let is_physical = fault == Fault::Disturbance || fault.is_physical(&drive.faults, &drive.motor, self.peak);
        let runs_away = Parameter::ALL
            .into_iter()
            .any(|parameter| moves[parameter as usize].abs() > RUNS_AWAY * search.drive.motor.get(parameter).abs());
        let may_stand_in = fault == Fault::VoltageLag || search.is_within_rows(fault, &drive);
        let explains_little = cost > (1.0 - WITHIN_ROWS) * search.cost;
        let outcome = if gain <= VERY_STRONG {
            FaultOutcome::NotNeeded
        } else if !is_physical || runs_away {
            FaultOutcome::NotPhysical
        } else if may_stand_in && explains_little {
            FaultOutcome::WithinRows
        } else if search.may_be_loss(fault, &drive) && explains_little
            || (!is_moved || search.is_rough()) && cost > (1.0 - NOTICEABLE) * search.cost
        {
            FaultOutcome::NoMatter
        } else {
            FaultOutcome::Taken
        };
        Some(Fitted { trial: FaultTrial { fault, gain, outcome, moves }, drive, cost, unknowns })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schwarz_weighs_cost_against_unknowns() {
        // Half the cost over 100 residuals is worth 100 ln 2; two unknowns cost 2 ln 100.
        assert!((schwarz(2.0, 1.0, 2, 100.0) - (100.0 * 2.0_f64.ln() - 2.0 * 100.0_f64.ln())).abs() < 1e-12);
        assert_eq!(schwarz(1.0, 1.0, 1, 100.0), f64::NEG_INFINITY);
        assert_eq!(schwarz(1.0, f64::NAN, 1, 100.0), f64::NEG_INFINITY);
        assert_eq!(schwarz(0.0, 0.0, 1, 100.0), f64::NEG_INFINITY);
        assert_eq!(schwarz(f64::INFINITY, 1.0, 1, 100.0), f64::INFINITY);
        assert!(schwarz(1.0, 0.0, 1, 100.0).is_finite());
    }
}

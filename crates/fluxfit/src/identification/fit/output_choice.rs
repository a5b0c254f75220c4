//! The choice of the voltage timing and of the drive's faults, on a part of the rows.

use super::{
    super::{
        prepare::{model::largest_turn, stretches},
        progress::{Progress, Step},
        request::Request,
    },
    fault_search::{FaultSearch, LEAST_RESIDUAL, WITHIN_ROWS, schwarz},
    fault_trial::{FaultOutcome, FaultTrial},
    long_run,
    output_start::{self, Start, free},
    readings::{self, HOPELESS, HOPELESS_AFTER_A_FIT, Rules, TimingTrial, UNUSUAL, VERY_STRONG, contest},
};
use crate::{
    error::{Error, ErrorKind},
    faults::Fault,
    levenberg_marquardt::PriorResidual,
    log::Log,
    motor::{Motor, Parameter},
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
    parallel,
};
use std::ops::Range;

/// What is to be fitted to all rows.
#[derive(Clone)]
pub(super) struct Chosen {
    pub(super) reading: VoltageTiming,
    pub(super) drive: Adjustable,
    pub(super) unknowns: Vec<Unknown>,
    pub(super) priors: Vec<PriorResidual>,
    /// Every reading with these unknowns, the best first; empty until they are compared.
    pub(super) readings: Vec<TimingTrial>,
    pub(super) terms: Vec<FaultTrial>,
    /// Independent residuals of the rows by which it was chosen.
    pub(super) independent: f64,
    /// Logarithm of the mean square that is left, and what the unknowns cost: Schwarz's criterion per residual.
    pub(super) criterion: f64,
}

/// What a search came to.
#[derive(Clone)]
struct Searched {
    chosen: Chosen,
    /// Whether the log [is explained](is_explained).
    explained: bool,
    /// Mean square of a residual, A².
    mean_square: f64,
}

/// Where a search for faults begins.
#[derive(Clone)]
struct Begin {
    /// The reading, by its place, and what was fitted under it.
    tried: (usize, TimingTrial),
    unknowns: Vec<Unknown>,
    /// Faults among the unknowns.
    faults: Vec<FaultTrial>,
}

impl Begin {
    /// With one of these faults, if the evidence for one is very strong beside what was `tried` without.
    fn with_fault(
        faults: &[Fault],
        objectives: &[(VoltageTiming, OutputError)],
        start: &Adjustable,
        (free, priors): (&[Unknown], &[PriorResidual]),
        tried: &[(usize, TimingTrial)],
        is_possible: fn(&Motor) -> bool,
    ) -> Option<Self> {
        let (place, without) = tried.first()?;
        let turns = objectives[*place].1.turns();
        let each = faults.iter().copied().filter(|fault| turns || !fault.needs_turning()).filter_map(|fault| {
            let unknowns: Vec<Unknown> = free.iter().copied().chain(Unknown::of_fault(fault)).collect();
            let possible = (0..objectives.len()).filter(|place| fault != Fault::VoltageLag || objectives[*place].0.may_lag());
            let faults = fault.starts(&start.faults, objectives[*place].1.peak_current());
            let starts = possible.flat_map(|place| faults.iter().map(move |faults| (place, Adjustable { faults: *faults, ..*start })));
            let starts = starts.collect();
            let (place, with) = *contest(objectives, starts, &unknowns, priors, &Rules::all(HOPELESS)).first()?;
            let (objective, drive) = (&objectives[place].1, with.polished.drive);
            let independent = long_run::effective_sample_size(&objective.residuals(&drive));
            let gain = schwarz(without.mean_square(), with.mean_square(), unknowns.len() - free.len(), independent);
            let stands_in = fault == Fault::VoltageLag && with.mean_square() > (1.0 - WITHIN_ROWS) * without.mean_square();
            let is_there = gain > VERY_STRONG
                && !stands_in
                && is_possible(&drive.motor)
                && fault.is_physical(&drive.faults, &drive.motor, objective.peak_current());
            let moves = Parameter::ALL.map(|parameter| drive.motor.get(parameter) - without.polished.drive.motor.get(parameter));
            let trial = FaultTrial { fault, gain, outcome: FaultOutcome::Taken, moves };
            is_there.then(|| Self { tried: (place, with), unknowns, faults: vec![trial] })
        });
        each.min_by(|one, other| one.tried.1.mean_square().total_cmp(&other.tried.1.mean_square()))
    }
}

/// Readings from which faults are looked for, where the first one leaves something unexplained: a fault may pass for a delay. Rows far
/// apart always leave something.
const TRIED_READINGS: usize = 2;

/// Correlation of neighbours below which residuals are white enough.
const WHITE: f64 = 0.1;

/// Faults that are ruled out because their values run away beside others: each costs a search.
const MOST_RULED_OUT: usize = 2;

/// Mean square over that of another search below which it is much less: most of what the other leaves beyond noise is explained.
const MUCH_LESS: f64 = 0.8;

/// Chooses the reading of the voltages and the faults of the drive; of a log whose speed was advanced by a
/// lag, s, or by zero. The best first, then what searches from other readings came to.
pub(super) fn choose(
    log: &Log,
    stretches: &[Range<usize>],
    start: &Start,
    undone_lag: f64,
    request: &Request,
    progress: Progress,
) -> Result<Vec<Chosen>, Error> {
    let _ = progress(Step::VoltageTiming);
    let free: Vec<Unknown> = free(log, request).into_iter().chain(output_start::rest_of_lag(undone_lag)).collect();
    let under = |readings: &[_]| OutputError::under_readings(log, &stretches::spread(stretches), readings);
    let roughly = |objectives: &Objectives| readings::readings(objectives, &start.drive, &free, &[], HOPELESS);
    let mut objectives = under(&readings::asked(log, request))?;
    let mut rough = roughly(&objectives);
    let suspected = rough.first().map_or(Vec::new(), |(_, best)| readings::suspected(best.timing, &objectives, request));
    if !suspected.is_empty() {
        objectives.extend(under(&suspected)?);
        rough = roughly(&objectives);
    }
    if rough.first().is_some_and(|(_, best)| weigh_halves(&mut objectives, best.timing, &best.polished.drive.motor)) {
        rough = roughly(&objectives);
    }
    let priors = output_start::priors(request, undone_lag, rough.first().map_or(0.0, |(_, best)| best.mean_square()));
    let mut found: Vec<Searched> = Vec::new();
    let mut begun: Vec<FaultSearch> = Vec::new();
    let tried = if priors.is_empty() {
        rough
    } else {
        let ends = rough.iter().map(|(place, trial)| (*place, trial.polished.drive)).collect();
        contest(&objectives, ends, &free, &priors, &Rules::all(HOPELESS))
    };
    let every_period = log.is_control_rate();
    // Between rows that are not the drive's periods, means pass for rare readings.
    let rare: &[_] = if every_period { &VoltageTiming::RARE } else { &[] };
    let objectives_of = |readings: &[_]| match request.voltage_timing {
        None => under(readings),
        Some(_) => Ok(Vec::new()),
    };
    let (steps, mut rare) = (objectives_of(&VoltageTiming::BY_EULERS_RULE)?, objectives_of(rare)?);
    let alone = |objectives: &Objectives| Alone::of(objectives, &start.drive, (&free, &priors));
    let (as_steps, mut as_rare) = (alone(&steps), alone(&rare));
    let is_ahead = |alone: &&Alone| {
        let best = &alone.best.1;
        tried.first().is_some_and(|(_, usual)| best.rank() < usual.rank()) && !readings::is_behind_means(best, &tried)
    };
    let least = tried.first().map_or(f64::INFINITY, |(_, usual)| usual.mean_square());
    if let Some(Alone { best: (_, best), .. }) = &as_rare
        && best.mean_square() <= HOPELESS * least
        && weigh_halves(&mut rare, best.timing, &best.polished.drive.motor)
    {
        as_rare = alone(&rare);
    }
    let is_explained = |alone: &&Alone| alone.searched.explained && is_ahead(alone);
    let is_first = |steps: &&Alone| as_rare.as_ref().filter(is_explained).is_none_or(|rare| steps.best.1.rank() <= rare.best.1.rank());
    if let Some(steps) = as_steps.as_ref().filter(is_explained).filter(is_first) {
        let mut chosen = steps.searched.chosen.clone();
        chosen.readings.extend(tried.iter().map(|(_, tried)| *tried));
        return Ok(vec![chosen]);
    }
    let _ = progress(Step::Faults);
    let most = if every_period { TRIED_READINGS } else { 1 };
    let ready = |begin: Begin, objectives| {
        let Begin { tried: (place, tried), unknowns, faults } = begin;
        let (drive, cost, voltage_accuracy) = (tried.polished.drive, tried.polished.cost, request.voltage_accuracy);
        let mut search = FaultSearch {
            objectives,
            reading: place,
            open: (0..objectives.len()).collect(),
            priors: &priors,
            drive,
            unknowns,
            begun_with: faults,
            cost,
            voltage_accuracy,
            every_period,
            row_period: log.slowest_period(),
            row_turn: largest_turn(log),
            points_tell_no_angle: start.points_tell_no_angle,
            compared: Vec::new(),
            ruled_out: Vec::new(),
            contested: None,
        };
        let observer = search.observe();
        (search, observer)
    };
    let search_from = |begin: Begin, objectives, begun: &mut Vec<_>| {
        let (search, observer) = ready(begin, objectives);
        let is_new = !begun.iter().any(|other| search.is_like(other));
        is_new.then(|| {
            let found = with_faults(&search, observer.as_ref());
            begun.push(search);
            found
        })
    };
    let without = |tried| Begin { tried, unknowns: free.clone(), faults: Vec::new() };
    let is_motor = |found: &Searched| is_a_motor(&found.chosen.drive.motor);
    // A filter or a late angle in a usual log passes for a rare reading as long as it is not found. So a search that begins with a rare
    // reading counts only without a filter.
    let has_filter = |found: &Searched| found.faults().any(Fault::is_filter);
    let has_loss = |found: &Searched| found.faults().any(|fault| fault.family() == Fault::DeadTime.family());
    let with_rare = |alone: &Alone| {
        let searched = search_from(without(alone.best), &rare, &mut Vec::new());
        searched.filter(|searched| is_motor(searched) && !has_filter(searched))
    };
    let compared_with_all = |mut searched: Searched| {
        let tried: Vec<VoltageTiming> = objectives.iter().map(|(timing, _)| *timing).collect();
        let alike = under(&readings::alike(searched.chosen.reading, &tried))?;
        searched.chosen.compare(&[&alike, &rare, &objectives]);
        Ok::<Searched, Error>(searched)
    };
    let seems_rare = as_rare.as_ref().filter(is_explained);
    if let Some(alone) = seems_rare {
        // What is left may be white though dead time is there: a search counts if it finds one. Without, the motor alone is the answer.
        let with_faults = with_rare(alone).filter(|searched| searched.explained && has_loss(searched));
        return Ok(vec![compared_with_all(with_faults.unwrap_or_else(|| alone.searched.clone()))?.chosen]);
    }
    let best_timing = tried.first().map(|(_, best)| best.timing);
    let may_hide_an_angle = start.may_hide_an_angle || best_timing.is_some_and(VoltageTiming::is_in_frame_of_row);
    let of_angle = if may_hide_an_angle { &[Fault::AngleOffset, Fault::AngleDelay][..] } else { &[] };
    // Voltages that lag are of another reading than without.
    let of_voltages = best_timing.filter(|timing| !timing.tells_lag()).map(|_| Fault::VoltageLag);
    let of_frame: Vec<Fault> = of_angle.iter().copied().chain(of_voltages).collect();
    let with_frame = Begin::with_fault(&of_frame, &objectives, &start.drive, (&free, &priors), &tried, is_a_motor);
    let first_plain = usize::from(with_frame.is_some());
    let begins: Vec<Begin> = with_frame.into_iter().chain(tried.iter().copied().take(most).map(without)).collect();
    if every_period {
        for begin in begins {
            // The search from the reading before has compared all of them, and ended with this one.
            if found.iter().skip(first_plain).any(|found| found.chosen.reading == begin.tried.1.timing) {
                break;
            }
            found.extend(search_from(begin, &objectives, &mut begun));
            if found.last().is_some_and(|found| found.explained) {
                break;
            }
        }
    } else {
        // Here the first one hardly ever explains the log, so the second is begun beside it.
        let mut searches = parallel::map(&begins, |begin| ready(begin.clone(), &objectives));
        if let [(first, _), (second, _)] = &searches[..]
            && second.is_like(first)
        {
            searches.truncate(1);
        }
        found = parallel::map(&searches, |(search, observer)| with_faults(search, observer.as_ref()));
        if found.first().is_some_and(|found| found.explained) {
            found.truncate(1);
        }
    }
    // What is no motor comes last, however well it fits.
    let criterion = |found: &Searched| found.chosen.criterion;
    let sort = |found: &mut Vec<Searched>| {
        found.sort_by(|one, other| is_motor(other).cmp(&is_motor(one)).then(criterion(one).total_cmp(&criterion(other))));
    };
    sort(&mut found);
    // Something else may be taken first in the place of dead time that operating points show.
    let is_answer = |best: &Searched| best.explained && is_motor(best) || has_loss(best);
    let angle_known = objectives.iter().all(|(_, objective)| objective.angle_known());
    let loss = if angle_known { Fault::DeadTime } else { Fault::DeadTimeWithoutAngle };
    let with_loss =
        |objectives, tried: &[_], is_possible| Begin::with_fault(&[loss], objectives, &start.drive, (&free, &priors), tried, is_possible);
    // Harmonics of the flux pass for dead time: it explains much beside them, but with values that no drive has.
    let is_hidden = |best: &Searched| {
        let hides = |trial: &FaultTrial| trial.fault == loss && trial.outcome == FaultOutcome::NotPhysical && trial.gain > VERY_STRONG;
        best.has(Fault::FluxHarmonics) && !has_loss(best) && best.chosen.terms.iter().any(hides)
    };
    let may_have_loss = |best: &Searched| start.shows_dead_time && !is_answer(best) || is_hidden(best);
    if found.first().is_some_and(may_have_loss) {
        found.extend(with_loss(&objectives, &tried, is_a_motor).and_then(|begin| search_from(begin, &objectives, &mut begun)));
        sort(&mut found);
    }
    // What a filter of the phase currents does while the rotor turns passes for much else beside an observer. A lag of the speed and
    // saturation, which leave as much, have searches of their own.
    let leaves_much = |best: &Searched| {
        !best.explained && ![Fault::CurrentFilter, Fault::SpeedLag, Fault::Saturation].into_iter().any(|fault| best.has(fault))
    };
    if every_period && found.first().is_some_and(leaves_much) {
        let with_filter = Begin::with_fault(&[Fault::CurrentFilter], &objectives, &start.drive, (&free, &priors), &tried, is_a_motor);
        found.extend(with_filter.and_then(|begin| search_from(begin, &objectives, &mut begun)));
        sort(&mut found);
    }
    // A reading that is no inverter's may hide what a speed that lags does: it is looked for without them, too.
    if every_period && found.first().is_some_and(|best| best.chosen.reading.is_unusual() && !best.explained) {
        let usual = &objectives[..objectives.iter().take_while(|(reading, _)| !reading.is_unusual()).count()];
        let first = tried.iter().copied().find(|(place, _)| *place < usual.len());
        found.extend(first.and_then(|first| search_from(without(first), usual, &mut begun)));
    }
    // Where a command acts at once only beside the faults, means of commands were not suspected before.
    let is_simple = |best: &Searched| best.explained && best.chosen.unknowns == free;
    let late = found.first().filter(|best| !is_simple(best)).map(|best| best.chosen.reading);
    let late = under(&late.map_or(Vec::new(), |reading| readings::suspected(reading, &objectives, request)))?;
    let mean = readings::readings(&late, &start.drive, &free, &priors, HOPELESS).into_iter().next();
    if let (Some(mean), Some(usual)) = (mean, found.first())
        && let Some(mut searched) = search_from(without(mean), &late, &mut Vec::new())
        && is_motor(&searched)
        && searched.chosen.independent * (criterion(usual) - criterion(&searched)) > VERY_STRONG
    {
        searched.chosen.compare(&[&late, &rare, &objectives]);
        found.insert(0, searched);
    }
    // A rare reading may be ahead only beside the faults that were found.
    let is_ahead_beside = |usual: &Searched| {
        let Chosen { drive, unknowns, independent, .. } = &usual.chosen;
        let beside = readings::readings(&rare, drive, unknowns, &priors, HOPELESS_AFTER_A_FIT);
        beside.first().is_some_and(|(_, beside)| independent * (usual.mean_square / beside.mean_square()).ln() > VERY_STRONG)
    };
    // Or faults may hide it beside a reading that is half a period off, of voltages that act at once or are means.
    let may_hide_it = |usual: &Searched| {
        let is_half_off = usual.chosen.reading.acts_at_once() || matches!(usual.chosen.reading, VoltageTiming::Averaged { .. });
        usual.chosen.unknowns != free && is_half_off
    };
    // Beside means of commands a filter and a late angle pass for it.
    let leaves_much_less = |rare: &Searched, usual: &Searched| {
        let is_open = may_hide_it(usual) && !VoltageTiming::MEANS_OF_COMMANDS.contains(&usual.chosen.reading);
        is_open && rare.mean_square < MUCH_LESS * usual.mean_square
    };
    // Where neither explains the log, the rare one must leave noticeably less, and not because an observer follows the currents.
    let is_disturbed = |found: &Searched| found.chosen.unknowns.iter().any(|unknown| unknown.is_observer_gain());
    let is_better = |rare: &Searched, usual: &Searched| {
        let beside_means = matches!(usual.chosen.reading, VoltageTiming::Averaged { .. });
        rare.explained && (!beside_means || (1.0 + UNUSUAL) * rare.mean_square < usual.mean_square)
            || leaves_much_less(rare, usual)
            || !usual.explained && (is_disturbed(usual) || !is_disturbed(rare)) && (1.0 + UNUSUAL) * rare.mean_square < usual.mean_square
    };
    // Beside voltages that lag, an angle that is off and a filter pass for it: they follow the noise to which the controller answers.
    let stands_in_for_lag = |rare: &Searched, usual: &Searched| {
        let is_turned = rare.has(Fault::AngleOffset) || rare.has(Fault::AngleDelay);
        let is_mean = matches!(usual.chosen.reading, VoltageTiming::Averaged { .. });
        is_mean && usual.has(Fault::VoltageLag) && is_turned && has_filter(rare)
    };
    let finds_loss = found.iter().any(has_loss);
    // A filter counts there only beside dead time that the usual searches miss, or if much less is left; then a small resistance may come
    // out below zero, too.
    let counts = |rare: &Searched, usual: &Searched| {
        let may_be_filtered = has_loss(rare) && !finds_loss;
        is_motor(rare) && (may_be_filtered || !has_filter(rare))
            || leaves_much_less(rare, usual) && has_inductances(&rare.chosen.drive.motor)
    };
    if let (Some(alone), Some(usual)) = (&as_rare, found.first())
        && (is_ahead(&alone) || may_hide_it(usual) || usual.chosen.unknowns != free && is_ahead_beside(usual))
    {
        let first = search_from(without(alone.best), &rare, &mut Vec::new());
        // Something else may be taken first in its place.
        let may_miss_loss = |first: &&Searched| !first.explained || is_hidden(first);
        let begin = first.as_ref().filter(may_miss_loss).and_then(|_| with_loss(&rare, &[alone.best], has_inductances));
        let second = begin.and_then(|begin| search_from(begin, &rare, &mut Vec::new()));
        let is_better = |rare: &Searched| {
            let counts = counts(rare, usual) && !stands_in_for_lag(rare, usual);
            counts && is_better(rare, usual) && rare.chosen.independent * (criterion(usual) - criterion(rare)) > VERY_STRONG
        };
        let mut found_there: Vec<Searched> = first.into_iter().chain(second).collect();
        // That the reading is a rare one is told by either; then the better one is the answer, with or without a filter.
        let told: Vec<VoltageTiming> = found_there.iter().filter(|rare| is_better(rare)).map(|rare| rare.chosen.reading).collect();
        let is_possible = |rare: &Searched| is_better(rare) || told.contains(&rare.chosen.reading) && is_motor(rare);
        found_there.retain(is_possible);
        sort(&mut found_there);
        if let Some(searched) = found_there.into_iter().next() {
            found.insert(0, compared_with_all(searched)?);
        }
    }
    let mut found: Vec<Chosen> = found.into_iter().map(|found| found.chosen).collect();
    let best = found.first_mut().ok_or(ErrorKind::TooShort { rows: log.rows(), least: 2 })?;
    if best.readings.is_empty() {
        // Without a fault they were tried with these unknowns already.
        let again = || readings::readings(&objectives, &best.drive, &best.unknowns, &priors, HOPELESS_AFTER_A_FIT);
        let readings = if best.unknowns == free { tried } else { again() };
        best.readings = readings.into_iter().map(|(_, tried)| tried).collect();
    }
    if let Some(Alone { best: (_, steps), .. }) = as_steps
        && readings::is_better(&steps, &best.readings, best.independent)
    {
        best.readings.push(steps);
    }
    Ok(found)
}

/// A log under each of several readings.
type Objectives = [(VoltageTiming, OutputError)];

/// Weighs the two halves of each row by this motor, if the best reading is the one with halves; returns whether it is. Where the winding
/// is fast, halves that count alike leave more than another reading does.
fn weigh_halves(objectives: &mut Objectives, best: VoltageTiming, motor: &Motor) -> bool {
    let has_halves = best.has_halves() && is_a_motor(motor);
    let own = objectives.iter_mut().find(|(timing, _)| has_halves && *timing == best);
    own.map(|(_, objective)| *objective = objective.with_halves_weighed(motor)).is_some()
}

/// The motor without any fault of a drive, under readings that are set apart: among the usual ones they could be taken for a fault. A
/// simulator that steps by Euler's rule has none.
struct Alone {
    /// The best reading, by its place.
    best: (usize, TimingTrial),
    searched: Searched,
}

impl Alone {
    fn of(objectives: &Objectives, start: &Adjustable, (unknowns, priors): (&[Unknown], &[PriorResidual])) -> Option<Self> {
        let tried = readings::readings(objectives, start, unknowns, priors, HOPELESS);
        let (place, best) = tried.first().copied()?;
        let objective = &objectives[place].1;
        let residuals = objective.residuals(&best.polished.drive);
        let independent = long_run::effective_sample_size(&residuals);
        let chosen = Chosen {
            reading: best.timing,
            drive: best.polished.drive,
            unknowns: unknowns.to_vec(),
            priors: priors.to_vec(),
            readings: tried.into_iter().map(|(_, tried)| tried).collect(),
            terms: Vec::new(),
            independent,
            criterion: criterion(best.polished.cost, unknowns.len(), residuals.len()),
        };
        let explained = is_explained(&best.polished.drive, best.polished.cost, residuals.len(), independent, objective);
        Some(Self { best: (place, best), searched: Searched { chosen, explained, mean_square: best.mean_square() } })
    }
}

/// Whether what is left is noise, and next to no observer was needed to make it so, or rounding.
pub(super) fn is_explained(drive: &Adjustable, cost: f64, residuals: usize, independent: f64, objective: &OutputError) -> bool {
    let count = residuals as f64;
    (cost / count).sqrt() <= LEAST_RESIDUAL * objective.peak_current()
        || drive.faults.disturbance.is_small() && independent > (1.0 - WHITE) / (1.0 + WHITE) * count
}

/// Whether all parameters are positive, as a motor's are; at rest the flux is zero, because it is not fitted.
pub(super) fn is_a_motor(motor: &Motor) -> bool {
    motor.rs > 0.0 && has_inductances(motor)
}

/// Whether they are positive but for the resistance, which a log that does not tell it leaves near zero on either side.
fn has_inductances(motor: &Motor) -> bool {
    let Motor { ld, lq, psi_f, .. } = *motor;
    ld > 0.0 && lq > 0.0 && psi_f >= 0.0
}

impl Chosen {
    /// Compares all of these readings with what was chosen, which stays the first one.
    fn compare(&mut self, among: &[&Objectives]) {
        let each =
            |objectives: &&Objectives| readings::readings(objectives, &self.drive, &self.unknowns, &self.priors, HOPELESS_AFTER_A_FIT);
        let mut readings: Vec<TimingTrial> = among.iter().flat_map(each).map(|(_, tried)| tried).collect();
        readings.sort_by(|one, other| one.rank().total_cmp(&other.rank()));
        readings.sort_by_key(|trial| trial.timing != self.reading);
        self.readings = readings;
    }

    /// The same choice for a log that differs a little: its numbers are fitted again, and the reading is chosen from these.
    pub(super) fn again(self, log: &Log, stretches: &[Range<usize>], asked: &[VoltageTiming]) -> Result<Self, Error> {
        let (steps, rare, of_commands) = (VoltageTiming::BY_EULERS_RULE, VoltageTiming::RARE, VoltageTiming::MEANS_OF_COMMANDS);
        let asked = match self.reading {
            reading if steps.contains(&reading) => steps.to_vec(),
            reading if asked.contains(&reading) => asked.to_vec(),
            reading if rare.contains(&reading) => [&rare, asked, &readings::alike(reading, asked)].concat(),
            reading if of_commands.contains(&reading) => [&[reading], asked].concat(),
            _ => asked.to_vec(),
        };
        let mut objectives = OutputError::under_readings(log, &stretches::spread(stretches), &asked)?;
        weigh_halves(&mut objectives, self.reading, &self.drive.motor);
        let tried = readings::readings(&objectives, &self.drive, &self.unknowns, &self.priors, HOPELESS_AFTER_A_FIT);
        let mut readings: Vec<TimingTrial> = tried.iter().map(|(_, tried)| *tried).collect();
        let Some(first) = tried.first() else { return Ok(self) };
        // What was chosen stays if it fits best: that it is rare was weighed then.
        let is_own = |(_, own): &&(usize, TimingTrial)| own.timing == self.reading && own.mean_square() <= first.1.mean_square();
        let (place, best) = tried.iter().find(is_own).unwrap_or(first);
        readings.sort_by_key(|trial| trial.timing != best.timing);
        let drive = best.polished.drive;
        let residuals = objectives[*place].1.residuals(&drive);
        let independent = long_run::effective_sample_size(&residuals);
        let criterion = criterion(best.polished.cost, self.unknowns.len(), residuals.len());
        Ok(Self { reading: best.timing, drive, readings, independent, criterion, ..self })
    }
}

/// Schwarz's criterion per residual.
fn criterion(cost: f64, unknowns: usize, residuals: usize) -> f64 {
    let count = residuals as f64;
    (cost / count).ln() + unknowns as f64 * count.ln() / count
}

/// The faults that a log carries under a reading, and the reading that suits them. A fault whose value has no physical meaning, or would
/// lose it beside a fault that explains more, is left out in another search; of those that mean something the best is taken.
fn with_faults(start: &FaultSearch, observer: Option<&FaultTrial>) -> Searched {
    let mut ruled_out = Vec::new();
    let mut best = Attempt::of(start, &ruled_out, observer);
    let mut in_doubt = best.in_doubt;
    // What a search begins with no other search of the same beginning is without.
    let is_begun_with = |fault: Fault| start.begun_with.iter().any(|begun| begun.fault == fault);
    for _ in 0..MOST_RULED_OUT {
        let Some(fault) = in_doubt.filter(|fault| !is_begun_with(*fault)) else { break };
        ruled_out.push(fault);
        let attempt = Attempt::of(start, &ruled_out, observer);
        in_doubt = attempt.in_doubt;
        if (attempt.is_unphysical, attempt.searched.chosen.criterion) < (best.is_unphysical, best.searched.chosen.criterion) {
            best = attempt;
        }
    }
    best.searched
}

/// A search, and what speaks against it.
struct Attempt {
    searched: Searched,
    /// A fault that it took has no physical meaning.
    is_unphysical: bool,
    /// The fault to search without.
    in_doubt: Option<Fault>,
}

impl Attempt {
    fn of(start: &FaultSearch, ruled_out: &[Fault], observer: Option<&FaultTrial>) -> Self {
        let mut search = FaultSearch { ruled_out: ruled_out.to_vec(), ..start.clone() };
        let terms = search.run(observer);
        let unphysical = search.unphysical(&terms).or_else(|| search.stand_in(&terms));
        let contested = search.contested;
        let searched = Searched::of(search, terms);
        Self { searched, is_unphysical: unphysical.is_some(), in_doubt: unphysical.or(contested) }
    }
}

impl Searched {
    /// Faults among the unknowns, once for each of their unknowns.
    fn faults(&self) -> impl Iterator<Item = Fault> {
        self.chosen.unknowns.iter().filter_map(|unknown| unknown.fault())
    }

    fn has(&self, fault: Fault) -> bool {
        self.faults().any(|there| there == fault)
    }

    fn of(search: FaultSearch, terms: Vec<FaultTrial>) -> Self {
        let FaultSearch { drive, unknowns, cost, reading, compared, .. } = search;
        let (reading, objective) = &search.objectives[reading];
        let residuals = objective.residuals(&drive);
        let independent = long_run::effective_sample_size(&residuals);
        Self {
            explained: is_explained(&drive, cost, residuals.len(), independent, objective),
            mean_square: cost / residuals.len() as f64,
            chosen: Chosen {
                reading: *reading,
                readings: compared.into_iter().map(|(_, tried)| tried).collect(),
                independent,
                criterion: criterion(cost, unknowns.len(), residuals.len()),
                drive,
                unknowns,
                priors: search.priors.to_vec(),
                terms,
            },
        }
    }
}

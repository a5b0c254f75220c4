//! Voltage timing: every reading of the voltage columns is tried, and the currents decide.
//!
//! A period's delay that is wrong shows wherever the voltage moves. In a log that stands still at one speed it does not show; then the
//! readings that fit about as well as the best one tell how much it matters.

use super::super::{prepare::model::largest_turn, request::Request};
use crate::{
    levenberg_marquardt::{Polished, PriorResidual, polish_to_beat, step},
    log::Log,
    motor::PARAMETERS,
    objective::{
        acting_voltage::{MeansOf, VoltageTiming},
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
    parallel,
    steady::zero_order_hold::MAX_ANGLE_PER_SAMPLE,
};

/// Twice the logarithm of the odds against a reading from which on it is ruled out: e^-5, one in 150. R. E. Kass and A. E. Raftery, "Bayes
/// factors", J. Am. Stat. Assoc. 90 (1995) 773, call it very strong.
pub const VERY_STRONG: f64 = 10.0;

/// A trial of one timing.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TimingTrial {
    /// The timing.
    pub timing: VoltageTiming,
    /// Where its polish ended.
    pub polished: Polished,
    /// Rows that it compares: a delay loses some.
    pub rows: usize,
}

impl TimingTrial {
    /// Mean square of a residual, A²: what readings are compared by.
    pub fn mean_square(&self) -> f64 {
        self.polished.cost / (2 * self.rows) as f64
    }

    /// The mean square with a handicap for readings that are rare.
    pub(super) fn rank(&self) -> f64 {
        let handicap = match self.timing {
            VoltageTiming::Averaged { .. } => AVERAGED,
            timing if timing.is_unusual() || VoltageTiming::RARE.contains(&timing) => UNUSUAL,
            _ => 0.0,
        };
        self.mean_square() * (1.0 + handicap)
    }
}

/// By which part a reading that is rare, or no inverter's, must fit better than all others: in a log that stands still it would fit as
/// well, and may scale all voltages by what a rotor that turns through a held voltage makes of it.
pub(super) const UNUSUAL: f64 = 0.01;

/// The same of means over each row's span: voltages that move little from row to row are calmed by another mean, whatever they are.
const AVERAGED: f64 = 0.1;

/// The part by which means may fit worse than lagging voltages that act at once, and yet be what they are. In no drive a command acts at
/// once; but means hold the controller's answers to the noise of the very rows in which they are logged, which follow that noise where they
/// act at once. Of simulated drives: up to a seventh.
const AT_ONCE: f64 = 0.25;

/// Every usual reading of a drive's voltages, or the one that is stated. A row that may be one period is hardly a mean of commands.
pub(crate) fn asked(log: &Log, request: &Request) -> Vec<VoltageTiming> {
    let may_be_periods = log.is_control_rate() && largest_turn(log) <= MAX_ANGLE_PER_SAMPLE;
    let set_apart = |timing: &VoltageTiming| {
        let is_rare = VoltageTiming::BY_EULERS_RULE.contains(timing) || VoltageTiming::RARE.contains(timing);
        is_rare || VoltageTiming::MEANS_OF_COMMANDS.contains(timing) && may_be_periods
    };
    let usual = || VoltageTiming::ALL.into_iter().filter(|timing| !set_apart(timing)).collect();
    request.voltage_timing.map_or_else(usual, |stated| vec![stated])
}

/// Readings to try beside those that were asked for, given the best of them: in no drive that logs each of its periods a command acts at
/// once, so rows as close as periods may be means of commands all the same; and so they may where other means fit best.
pub(crate) fn suspected(best: VoltageTiming, tried: &[(VoltageTiming, OutputError)], request: &Request) -> Vec<VoltageTiming> {
    let may_be_means = best.acts_at_once() || matches!(best, VoltageTiming::Averaged { .. });
    let is_open = |timing: &VoltageTiming| !tried.iter().any(|(other, _)| other == timing);
    let of_commands = || VoltageTiming::MEANS_OF_COMMANDS.into_iter().filter(is_open).collect();
    if may_be_means && request.voltage_timing.is_none() { of_commands() } else { Vec::new() }
}

/// Means that pass for the rows of a reading that was found, and so must be tried beside it, unless they were.
pub(super) fn alike(found: VoltageTiming, tried: &[VoltageTiming]) -> Vec<VoltageTiming> {
    means_like(found).into_iter().filter(|means| !tried.contains(means)).collect()
}

/// Means that pass for the rows of a drive that samples in the middle of its period. Of two commands: every other row of a usual drive
/// seems to act half a period later. Or of what acts: between such rows voltages go from one mean to the next.
fn means_like(timing: VoltageTiming) -> Option<VoltageTiming> {
    match timing {
        VoltageTiming::MidPeriod { later: false } => Some(VoltageTiming::Averaged { of: MeansOf::Voltages }),
        VoltageTiming::MidPeriod { .. } => Some(VoltageTiming::Averaged { of: MeansOf::TwoCommands }),
        _ => None,
    }
}

/// Mean square after one step, over that of the best reading, beyond which a reading is not fitted to the end: another step does not make
/// up for it.
pub(crate) const HOPELESS: f64 = 10.0;

/// The same where the start is a fit of one of the readings: what others miss is the reading's own.
pub(crate) const HOPELESS_AFTER_A_FIT: f64 = 3.0;

/// Mean square over that of the best reading beyond which a reading is out of the running: no fault that is found later makes up for it,
/// because as long as it is not found all readings miss what it does.
const OUT_OF_THE_RUNNING: f64 = 100.0;

/// The places of the readings that are not out of the running, given what was tried.
pub(crate) fn in_the_running(tried: &[(usize, TimingTrial)]) -> Vec<usize> {
    let least = tried.iter().map(|(_, trial)| trial.mean_square()).fold(f64::INFINITY, f64::min);
    tried.iter().filter(|(_, trial)| trial.mean_square() <= OUT_OF_THE_RUNNING * least).map(|(place, _)| *place).collect()
}

/// Tries every reading from the same start. The best one first, with its place among the objectives.
pub(crate) fn readings(
    objectives: &[(VoltageTiming, OutputError)],
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    hopeless: f64,
) -> Vec<(usize, TimingTrial)> {
    let starts = (0..objectives.len()).map(|place| (place, *start)).collect();
    contest(objectives, starts, unknowns, priors, &Rules::all(hopeless))
}

/// How many starts of a contest come how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rules {
    /// So many, the best as they stand, take a first step.
    pub(crate) stepped: usize,
    /// So many, the best after it, are fitted to the end.
    pub(crate) fitted: usize,
    /// But none whose mean square is so many times the least one then.
    pub(crate) hopeless: f64,
    /// And none further than is needed to see that its mean square, A², does not come below this one; zero where any matters.
    pub(crate) to_beat: f64,
}

impl Rules {
    /// All of them come to the end but the hopeless ones.
    pub(crate) const fn all(hopeless: f64) -> Self {
        Self { stepped: usize::MAX, fitted: usize::MAX, hopeless, to_beat: 0.0 }
    }
}

/// Fits drives from starts under one reading or another, given by its place among the objectives. One step tells which are worth a whole
/// fit. The best one first.
pub(crate) fn contest(
    objectives: &[(VoltageTiming, OutputError)],
    mut starts: Vec<(usize, Adjustable)>,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    rules: &Rules,
) -> Vec<(usize, TimingTrial)> {
    if starts.len() > rules.stepped {
        starts = best_as_they_stand(objectives, &starts, rules.stepped);
    }
    let trial = |place: usize, polished| {
        let (timing, objective) = &objectives[place];
        (place, TimingTrial { timing: *timing, polished, rows: objective.rows() })
    };
    let mut stepped = parallel::map(&starts, |(place, start)| trial(*place, step(&objectives[*place].1, start, unknowns, priors)));
    let least = stepped.iter().map(|(_, trial)| trial.mean_square()).fold(f64::INFINITY, f64::min);
    stepped.sort_by(|(_, one), (_, other)| one.rank().total_cmp(&other.rank()));
    let is_hopeless = |trial: &TimingTrial| trial.mean_square() > rules.hopeless * least && least > 0.0;
    let ranked: Vec<(usize, &(usize, TimingTrial))> = stepped.iter().enumerate().collect();
    let mut fitted = parallel::map(&ranked, |(rank, (place, stepped))| {
        if *rank >= rules.fitted || is_hopeless(stepped) {
            return (*place, *stepped);
        }
        let objective = &objectives[*place].1;
        let to_beat = rules.to_beat * (2 * objective.rows()) as f64;
        trial(*place, polish_to_beat(to_beat, objective, &stepped.polished.drive, unknowns, priors))
    });
    fitted.sort_by(|(_, one), (_, other)| one.rank().total_cmp(&other.rank()));
    fitted
}

/// The starts of least mean square.
fn best_as_they_stand(
    objectives: &[(VoltageTiming, OutputError)],
    starts: &[(usize, Adjustable)],
    count: usize,
) -> Vec<(usize, Adjustable)> {
    // Those of one reading side by side in lanes.
    let standing = objectives.iter().enumerate().flat_map(|(place, (_, objective))| {
        let drives: Vec<Adjustable> = starts.iter().filter(|(own, _)| *own == place).map(|(_, drive)| *drive).collect();
        let costs = objective.costs_of_all(&drives).into_iter().map(|cost| cost / objective.rows() as f64);
        costs.zip(drives).map(move |(mean_square, drive)| (mean_square, place, drive)).collect::<Vec<_>>()
    });
    let mut standing: Vec<(f64, usize, Adjustable)> = standing.collect();
    standing.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
    standing.into_iter().take(count).map(|(_, place, drive)| (place, drive)).collect()
}

/// Mean square over that of a fit beyond which another reading neither takes its place nor is [possible] beside it, given how many
/// independent residuals there are.
pub(super) fn ruled_out_above(independent: f64) -> f64 {
    (1.0 + AVERAGED) * (VERY_STRONG / independent).exp()
}

/// Whether a reading is better than the best of these for certain, given how many independent residuals there are.
pub(super) fn is_better(other: &TimingTrial, tried: &[TimingTrial], independent: f64) -> bool {
    tried.first().is_some_and(|best| independent * (best.mean_square() / other.mean_square()).ln() > VERY_STRONG)
}

/// The readings that are not ruled out, given how many independent residuals there are. The best one first. Beside one of a drive that logs
/// each of its periods no other kind is possible, but the same one held in the rotor's frame, as simulators and a few drives have it: it
/// differs by a twenty-fourth of the square of a period's turn, which few logs tell. Voltages that act at once are of no such drive.
/// Steps by Euler's rule are listed among those of a drive only if they fit better for certain, though not by enough to be taken.
pub(crate) fn possible(tried: &[TimingTrial], independent: f64) -> impl Iterator<Item = &TimingTrial> {
    let least = tried.first().map_or(0.0, TimingTrial::mean_square);
    let any_kind = tried.first().is_some_and(|best| best.timing.is_unusual() || best.timing.acts_at_once());
    // Where the best is perfect, so is every other one that is possible.
    let is_possible =
        move |other: &TimingTrial| other.mean_square() <= least || independent * (other.mean_square() / least).ln() < VERY_STRONG;
    let is_steps = |other: &TimingTrial| VoltageTiming::BY_EULERS_RULE.contains(&other.timing);
    let in_rotor = tried.first().and_then(|best| best.timing.held_in_rotor());
    let is_of_kind = move |other: &TimingTrial| !other.timing.is_unusual() || in_rotor == Some(other.timing) || is_steps(other);
    tried.iter().filter(move |other| is_possible(other) && (any_kind || is_of_kind(other)))
}

/// The means that pass for the best, where they fit about as well. Neither is exact, so the evidence does not count.
fn means_in_doubt(tried: &[TimingTrial]) -> Option<&TimingTrial> {
    let best = tried.first()?;
    let lags = best.polished.drive.faults.voltage_lag.time != 0.0;
    let (means, most) = match means_like(best.timing) {
        Some(means) => (means, AVERAGED),
        None if lags && best.timing.acts_at_once() => (VoltageTiming::Averaged { of: MeansOf::Voltages }, AT_ONCE),
        None => return None,
    };
    tried.iter().find(|other| other.timing == means && other.mean_square() <= (1.0 + most) * best.mean_square())
}

/// Whether means that pass for a reading fit better than it does. The two differ by a twelfth of the square of a row's turn, and only the
/// fit may decide between them.
pub(super) fn is_behind_means(reading: &TimingTrial, tried: &[(usize, TimingTrial)]) -> bool {
    let means = means_like(reading.timing);
    tried.iter().any(|(_, other)| means == Some(other.timing) && other.mean_square() <= reading.mean_square())
}

/// How far each parameter moves between them.
pub(crate) fn doubt(tried: &[TimingTrial], independent: f64) -> [f64; PARAMETERS] {
    let Some(best) = tried.first() else { return [0.0; PARAMETERS] };
    let others = possible(tried, independent).chain(means_in_doubt(tried));
    others.fold([0.0; PARAMETERS], |most: [f64; PARAMETERS], other| {
        let (one, other) = (best.polished.drive.motor.to_array(), other.polished.drive.motor.to_array());
        std::array::from_fn(|p| most[p].max((one[p] - other[p]).abs()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{log::Columns, motor::Motor, objective::acting_voltage::VoltageFrame};

    /// A command that acts one period later is a drive's own; one that acts at once may be a mean of commands.
    #[test]
    fn means_of_commands_are_suspected_where_a_command_acts_at_once() {
        let rows = 20;
        let column = |value: f64| (0..rows).map(|row| value * f64::from(row)).collect::<Vec<f64>>();
        let columns = Columns {
            t: column(1e-4),
            ud: column(0.1),
            uq: column(0.2),
            id: column(0.1),
            iq: column(0.3),
            omega_e: column(2.0),
            ..Columns::default()
        };
        let log = Log::new(columns).unwrap();
        let (auto, once) = (Request::default(), VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Rotor });
        let usual = asked(&log, &auto);
        let tried = |readings: &[VoltageTiming]| OutputError::under_readings(&log, std::slice::from_ref(&(0..20)), readings).unwrap();
        for own in [VoltageTiming::Centered, VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle }] {
            assert_eq!(suspected(own, &tried(&usual), &auto), []);
        }
        for best in [once, VoltageTiming::Averaged { of: MeansOf::Voltages }] {
            assert_eq!(suspected(best, &tried(&usual), &auto), VoltageTiming::MEANS_OF_COMMANDS);
        }
        let with_one = [&usual[..], &VoltageTiming::MEANS_OF_COMMANDS[..1]].concat();
        assert_eq!(suspected(once, &tried(&with_one), &auto), VoltageTiming::MEANS_OF_COMMANDS[1..]);
        let stated = Request { voltage_timing: Some(once), ..Request::default() };
        assert_eq!(suspected(once, &tried(&[once]), &stated), []);
    }

    /// Beside lagging voltages means are in doubt where a quarter more is left, in others where voltages act at once not at all.
    #[test]
    fn lagging_voltages_that_act_at_once_may_be_means() {
        let rows = 5000;
        let trial = |timing, rs: f64, mean_square: f64, lag: f64| {
            let mut drive = Adjustable::from(Motor { rs, ld: 1e-3, lq: 1e-3, psi_f: 0.1 });
            drive.faults.voltage_lag.time = lag;
            let polished = Polished { drive, cost: mean_square * (2 * rows) as f64, converged: true };
            TimingTrial { timing, polished, rows }
        };
        let once = VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Middle };
        let moved = |lag, left| {
            let means = trial(VoltageTiming::Averaged { of: MeansOf::Voltages }, 1.5, left, lag);
            doubt(&[trial(once, 1.0, 1.0, lag), means], (2 * rows) as f64)[0]
        };
        assert!((moved(50e-6, 1.24) - 0.5).abs() < 1e-12);
        assert_eq!([moved(50e-6, 1.26), moved(0.0, 1.05)], [0.0; 2]);
    }

    /// Simulators hold a voltage in the rotor's frame where inverters hold it in the stator; no other reading of theirs is possible.
    #[test]
    fn where_a_voltage_is_held_is_in_doubt_unless_the_log_tells() {
        let trial = |delay, frame, mean_square| {
            let drive = Adjustable::from(Motor { rs: 1.0, ld: 1e-3, lq: 1e-3, psi_f: 0.1 });
            let polished = Polished { drive, cost: 200.0 * mean_square, converged: true };
            TimingTrial { timing: VoltageTiming::Delayed { delay, frame }, polished, rows: 100 }
        };
        let (middle, rotor) = (VoltageFrame::Middle, VoltageFrame::Rotor);
        let best = trial(1, middle, 1.0);
        let count = |other| possible(&[best, other], 200.0).count();
        assert_eq!([count(trial(1, rotor, 1.04)), count(trial(1, rotor, 1.06)), count(trial(0, rotor, 1.04))], [2, 1, 1]);
    }

    /// Its distance is doubt however strong the evidence against it is. That of other means is not, nor its own beside another reading.
    #[test]
    fn every_other_row_may_be_a_mean_of_two_commands() {
        let rows = 5000;
        let trial = |timing, rs: f64, mean_square: f64| {
            let drive = Adjustable::from(Motor { rs, ld: 1e-3, lq: 1e-3, psi_f: 0.1 });
            let polished = Polished { drive, cost: mean_square * (2 * rows) as f64, converged: true };
            TimingTrial { timing, polished, rows }
        };
        let of = |of| VoltageTiming::Averaged { of };
        let later = trial(VoltageTiming::MidPeriod { later: true }, 1.0, 1.0);
        let moved = |tried: &[TimingTrial]| doubt(tried, (2 * rows) as f64)[0];
        assert!((moved(&[later, trial(of(MeansOf::TwoCommands), 1.5, 1.09)]) - 0.5).abs() < 1e-12);
        assert_eq!(moved(&[later, trial(of(MeansOf::TwoCommands), 1.5, 1.11), trial(of(MeansOf::Commands), 1.5, 1.09)]), 0.0);
        let ended = trial(VoltageTiming::Ended, 1.0, 1.0);
        assert_eq!(moved(&[ended, trial(of(MeansOf::TwoCommands), 1.5, 1.09)]), 0.0);
    }
}

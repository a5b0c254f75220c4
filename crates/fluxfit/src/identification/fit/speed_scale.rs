//! The scale of a speed that no angle confirms: the factor with which simulated currents follow the measured ones.
//!
//! Operating points suit any speed: a motor of half the inductances and half the flux at twice the speed has the same voltages. Where
//! currents change, `L di/dt` tells the inductances without the speed. So simulated currents follow at one speed alone, if at no other
//! than that of the log its scale is wrong: its unit, or the number of pole pairs that it was converted by.

use super::{
    super::{prepare::stretches, request::Request},
    fault_search::schwarz,
    long_run,
    output::OutputFit,
    output_choice::is_explained,
    output_start,
    readings::{self, HOPELESS, Rules, VERY_STRONG, contest},
};
use crate::{
    faults::Fault,
    log::Log,
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::ops::Range;

/// Speeds this much higher and lower are looked at first: where neither is followed better, the log's is the right one.
const NEAR: f64 = 1.03;

/// From there the speed goes on by this factor as long as that is followed better,
const STEP: f64 = 1.19;

/// so many times, up to eight: a motor of eight pole pairs whose speed is the shaft's.
const STEPS: usize = 12;

/// The search for the best factor ends after so many golden sections: within 1 %, less than any two numbers of pole pairs below 50 differ.
const SECTIONS: usize = 8;

/// The smaller part of a golden section, `(3 - sqrt 5) / 2`.
const GOLDEN: f64 = 0.381_966;

/// Readings of the voltages that are fitted to the end at a speed, the best after a step: the one that was found at a wrong speed is wrong.
const FITTED: usize = 4;

/// Readings of the voltages under which the best factor is looked for, one after the other.
const MOST_READINGS: usize = 2;

/// Less than this part of the mean square that the log's own speed leaves must be left by another one, where it is not noise.
const MUCH_LESS: f64 = 0.5;

/// A factor nearer to one is no wrong unit or number of pole pairs: those of 20 and 21 differ by 5 %.
const LEAST: f64 = 1.04;

/// What the simulated currents say of the scale of a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SpeedScale {
    /// Nothing.
    Untold,
    /// It is right: a little higher or lower, the currents are followed worse.
    Right,
    /// By which factors it is too high, the least and the largest: the currents are followed with another speed, but for noise, and not
    /// with the one that the log has; or they are followed far better.
    TooHigh([f64; 2]),
}

impl SpeedScale {
    /// Of a log and what was fitted to it. Of currents that operating points outvote, only that noise alone is left with another speed
    /// counts: between points that were logged one after the other they jump, and are followed better with smaller inductances.
    pub(crate) fn of(log: &Log, fit: &OutputFit, is_outvoted: bool, request: &Request) -> Self {
        if log.columns().theta_e.is_some() {
            return Self::Right;
        }
        // Between rows further apart than the drive's periods voltages are not logged, and a wrong speed may make up for them. Some rows
        // that are as close as periods are every n-th of them all the same, or means: there a reading is found that no drive has.
        let reading = fit.voltage_timing.value;
        let is_measured_or_simulated = matches!(reading, VoltageTiming::Ended | VoltageTiming::Euler { .. });
        let may_lack_periods =
            request.voltage_timing.is_none() && !is_measured_or_simulated && (reading.acts_at_once() || reading.is_unusual());
        if !log.is_control_rate() || may_lack_periods || log.is_interpolated() || log.is_at_rest() {
            return Self::Untold;
        }
        let of_faults = fit.fault_estimates.iter().map(|estimate| estimate.unknown);
        let faults: Vec<Unknown> = of_faults.filter(|unknown| unknown.fault() != Some(Fault::Disturbance)).collect();
        let Some(with_faults) = Speeds::new(log, fit, &faults, request) else { return Self::Untold };
        // What is found of faults at a wrong speed may stand in for it, and what is there of them may hide it.
        let alone = if faults.is_empty() { None } else { Speeds::new(log, fit, &[], request) };
        let each: Vec<(Speeds, Near)> =
            alone.into_iter().chain([with_faults]).filter_map(|speeds| speeds.near().map(|near| (speeds, near))).collect();
        match too_high(&each, is_outvoted) {
            Some(too_high) => Self::TooHigh(too_high),
            None if each.iter().any(|(_, near)| near.rules_out_others(fit)) => Self::Right,
            None => Self::Untold,
        }
    }
}

fn too_high(each: &[(Speeds, Near)], is_outvoted: bool) -> Option<[f64; 2]> {
    let mut now = None;
    each.iter().find_map(|(speeds, near)| {
        let found = speeds.best(near.better()?)?;
        // Only here: of most logs no other speed is followed better.
        let now = *now.get_or_insert_with(|| {
            let own = each.iter().filter_map(|(speeds, _)| speeds.at_its_own());
            own.map(|followed| followed.mean_square).fold(f64::INFINITY, f64::min)
        });
        let is_better = schwarz(now, found.mean_square, 1, found.independent) > VERY_STRONG;
        let is_clear = is_better && (found.is_explained || !is_outvoted && found.mean_square < MUCH_LESS * now);
        let [low, high] = found.factors;
        (is_clear && (low > LEAST || high < 1.0 / LEAST)).then_some([1.0 / high, 1.0 / low])
    })
}

/// The same currents and voltages at other speeds.
struct Speeds<'a> {
    log: Log,
    stretches: Vec<Range<usize>>,
    /// The drive at the log's own speed.
    drive: Adjustable,
    unknowns: Vec<Unknown>,
    reading: VoltageTiming,
    request: &'a Request,
}

/// How far the currents are followed at a speed.
#[derive(Clone, Copy)]
struct Followed {
    /// The speed, as a factor of the log's.
    factor: f64,
    mean_square: f64,
    reading: VoltageTiming,
    drive: Adjustable,
}

/// The speed with which the currents are followed best.
struct Best {
    factors: [f64; 2],
    mean_square: f64,
    independent: f64,
    /// Whether what is left is noise.
    is_explained: bool,
}

/// How hard the best motor is looked for at a speed.
#[derive(Clone, Copy)]
enum Effort {
    /// By one step under the reading of the voltages that is known.
    Step,
    /// To the end under that reading.
    Fit,
    /// Under every reading, and to the end under the best.
    Readings,
}

impl<'a> Speeds<'a> {
    /// Of a drive with these numbers of its faults, which are found again at each speed, and no others.
    fn new(log: &Log, fit: &OutputFit, faults: &[Unknown], request: &'a Request) -> Option<Self> {
        Some(Self {
            log: if fit.undone_lag == 0.0 { log.clone() } else { log.without_speed_lag(fit.undone_lag) },
            stretches: stretches::spread(&stretches::fitted(log, &request.windows).ok()?),
            drive: if faults.is_empty() { Adjustable::from(fit.drive.motor) } else { fit.drive.without_observer() },
            unknowns: output_start::free(log, request).into_iter().chain(faults.iter().copied()).collect(),
            reading: fit.voltage_timing.value,
            request,
        })
    }

    /// At the log's own speed.
    fn at_its_own(&self) -> Option<Followed> {
        self.at(1.0, (self.reading, self.drive), Effort::Readings)
    }

    /// How far the currents are followed at so many times the speed, from a drive at that speed.
    fn at(&self, factor: f64, (reading, drive): (VoltageTiming, Adjustable), effort: Effort) -> Option<Followed> {
        let (asked, fitted) = match effort {
            Effort::Step => (vec![reading], 0),
            Effort::Fit => (vec![reading], 1),
            Effort::Readings => (readings::asked(&self.log, self.request), FITTED),
        };
        let objectives = self.objectives(factor, &asked)?;
        let starts = (0..objectives.len()).map(|place| (place, drive)).collect();
        let rules = Rules { fitted, ..Rules::all(HOPELESS) };
        let (_, best) = *contest(&objectives, starts, &self.unknowns, &[], &rules).first()?;
        Some(Followed { factor, mean_square: best.mean_square(), reading: best.timing, drive: best.polished.drive })
    }

    fn objectives(&self, factor: f64, readings: &[VoltageTiming]) -> Option<Vec<(VoltageTiming, OutputError)>> {
        let log = self.log.with_speed(self.log.columns().omega_e.iter().map(|omega_e| omega_e * factor).collect());
        OutputError::under_readings(&log, &self.stretches, readings).ok()
    }

    /// Where the currents are followed best, beginning with a speed that is followed better than the log's own.
    fn best(&self, mut best: Followed) -> Option<Best> {
        let towards = if best.factor > 1.0 { STEP } else { 1.0 / STEP };
        let mut steps = 0..STEPS;
        loop {
            // Where it goes on and on there is no such speed: currents that jump, as between points that were logged one after the other,
            // are followed the better the smaller the inductances are.
            steps.next()?;
            match self.from(&best, best.factor * towards, Effort::Readings) {
                Some(other) if other.mean_square < best.mean_square => best = other,
                _ => break,
            }
        }
        let mut factors = self.around(&best);
        for _ in 0..MOST_READINGS {
            let reading = best.reading;
            best = self.from(&best, (factors[0] * factors[1]).sqrt(), Effort::Readings)?;
            if best.reading == reading {
                break;
            }
            factors = self.around(&best);
        }
        let Followed { factor, mean_square, reading, drive } = best;
        let (_, objective) = self.objectives(factor, &[reading])?.pop()?;
        let residuals = objective.residuals(&drive);
        let (cost, independent) = (mean_square * residuals.len() as f64, long_run::effective_sample_size(&residuals));
        let is_explained = is_explained(&drive, cost, residuals.len(), independent, &objective);
        Some(Best { factors, mean_square, independent, is_explained })
    }

    /// How far the currents are followed at so many times the log's speed, from what was found at another speed.
    fn from(&self, found: &Followed, factor: f64, effort: Effort) -> Option<Followed> {
        self.at(factor, (found.reading, scaled(found.drive, factor / found.factor)), effort)
    }

    /// Between which factors near the one that was found the currents are followed best.
    fn around(&self, found: &Followed) -> [f64; 2] {
        let left = |other: f64| self.from(found, other, Effort::Fit).map_or(f64::INFINITY, |followed| followed.mean_square);
        let (mut low, mut high) = (found.factor / STEP, found.factor * STEP);
        for _ in 0..SECTIONS {
            let (lower, upper) = (low * (high / low).powf(GOLDEN), high * (low / high).powf(GOLDEN));
            if left(lower) < left(upper) { high = upper } else { low = lower }
        }
        [low, high]
    }

    /// At the log's own speed, and a little higher and lower.
    fn near(&self) -> Option<Near> {
        let at = |factor: f64| self.at(factor, (self.reading, scaled(self.drive, factor)), Effort::Step);
        Some(Near { now: at(1.0)?, nears: [at(NEAR)?, at(1.0 / NEAR)?] })
    }
}

/// How far the currents are followed at the log's own speed, and at speeds near it.
struct Near {
    now: Followed,
    nears: [Followed; 2],
}

impl Near {
    /// The nearby speed that is followed better, if one is.
    fn better(&self) -> Option<Followed> {
        let best = self.nears.iter().copied().min_by(|one, other| one.mean_square.total_cmp(&other.mean_square))?;
        (best.mean_square < self.now.mean_square).then_some(best)
    }

    /// Whether the nearby speeds are ruled out, given what was fitted to the currents.
    fn rules_out_others(&self, fit: &OutputFit) -> bool {
        let independent = long_run::effective_sample_size(&fit.residuals);
        let is_worse = |near: &Followed| schwarz(near.mean_square, self.now.mean_square, 1, independent) > VERY_STRONG;
        fit.is_explained() && fit.drive.faults.disturbance.is_small() && self.nears.iter().all(is_worse)
    }
}

/// The drive with the motor that has the same voltages at so many times the speed.
fn scaled(mut drive: Adjustable, factor: f64) -> Adjustable {
    for of_speed in [&mut drive.motor.ld, &mut drive.motor.lq, &mut drive.motor.psi_f] {
        *of_speed /= factor;
    }
    drive
}

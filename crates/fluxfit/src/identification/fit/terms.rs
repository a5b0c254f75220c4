//! Which faults of the drive a log carries: terms of the adjustable drive, each taken only if the log asks for it.
//!
//! A term is first judged where it is zero, by how much of the residual its derivatives explain beyond the other unknowns' (a score test);
//! only one that would pay is fitted. It is taken if
//!
//! - Schwarz's criterion speaks for it very strongly, `N ln(cost before / cost after) > unknowns ln N + 10`, with `N` independent
//!   residuals, fewer than there are rows where they are correlated (G. Schwarz, Ann. Stat. 6 (1978) 461, doi:10.1214/aos/1176344136);
//! - its value is physical;
//! - it moves a parameter by more than its standard error, or takes a noticeable part of the residual with it, so that intervals become
//!   sharper.
//!
//! The best term is taken first; then the voltages are read again, because a fault may have passed for a delay, and the other terms are
//! judged again beside it.

use super::{
    long_run::first_correlation,
    readings::{VERY_STRONG, readings},
    voltage_accuracy,
};
use crate::{
    frames::Dq,
    levenberg_marquardt::{Belief, jacobian, polish_unknowns},
    motor::PARAMETERS,
    objective::{
        acting_voltage::VoltageReading,
        adjustable::{Adjustable, SensorPair, Unknown},
        output_error::OutputError,
    },
    singular_values::SingularValueDecomposition,
};
use nalgebra::{DMatrix, DVector};

/// Part of the largest singular value of a normal matrix below which a direction is none: derivatives by differences are right to
/// 1e-9 or so, and the normal matrix squares that, but only where columns nearly cancel does it matter.
const RANK_TOLERANCE: f64 = 1e-13;

/// A fault of the drive, or of the model of its motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Dead time and device drops.
    DeadTime,
    /// Angle that is read too large.
    AngleOffset,
    /// What the current sensors read at zero.
    CurrentOffset,
    /// Gains of three current sensors that differ.
    Imbalance,
    /// Gains of two current sensors that differ.
    TwoSensors(SensorPair),
    /// Inductances that depend on the current.
    Saturation,
    /// Unknown voltages.
    ProcessNoise,
}

/// What came of a term.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// The term.
    pub term: Term,
    /// Schwarz's criterion: what it gains, less what its unknowns cost; positive speaks for it. As far as it was pursued.
    pub gain: f64,
    /// Taken or not, and why.
    pub outcome: Outcome,
}

/// Whether a term was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is part of the answer.
    Taken,
    /// It does not explain enough of the residual.
    NotNeeded,
    /// What fits has no physical meaning.
    NotPhysical,
    /// It explains something, but nothing that matters to a parameter.
    NoMatter,
    /// Another term explains the same.
    Covered,
    /// It needs the electrical angle, which the log does not have.
    NeedsAngle,
}

impl Outcome {
    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Taken => "taken",
            Self::NotNeeded => "explains too little of the residual",
            Self::NotPhysical => "what fits has no physical meaning",
            Self::NoMatter => "moves no parameter by more than its standard error",
            Self::Covered => "another term explains the same",
            Self::NeedsAngle => "needs the electrical angle, theta_e",
        }
    }
}

/// Widths of the dead time's ramp that are tried, as fractions of the largest current: from next to nothing to a ripple nearly as
/// large as the current.
const WIDTHS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8];

/// Least part of the residual's power that a term takes with it to be worth having when no parameter moves, or where the motor is
/// disturbed.
const NOTICEABLE: f64 = 0.02;

/// Residuals below this fraction of the largest current are rounding and the model's own last digits: nothing to explain.
pub(crate) const LEAST_RESIDUAL: f64 = 1e-4;

/// The most that a current sensor's gain or an observer's can be.
const WHOLE: f64 = 1.0;

/// Largest angle that an encoder is wrong by, rad: beyond 45 degrees d and q change places.
const MAX_ANGLE: f64 = std::f64::consts::FRAC_PI_4;

/// Least extra flux, as a fraction of an inductance over the range of its current, that is worth calling saturation.
const LEAST_SATURATION: f64 = 0.02;

/// At half of the inductance the flux no longer grows at the largest current; some more is left to a formula that is no iron.
const MOST_SATURATION: f64 = 0.8;

impl Term {
    /// Those that a drive may have, sensors first; disturbances, which would explain any fault a little, are tried on their own.
    const FAULTS: [Self; 8] = [
        Self::DeadTime,
        Self::AngleOffset,
        Self::CurrentOffset,
        Self::Imbalance,
        Self::TwoSensors(SensorPair::Ab),
        Self::TwoSensors(SensorPair::Bc),
        Self::TwoSensors(SensorPair::Ca),
        Self::Saturation,
    ];

    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::DeadTime => "dead_time",
            Self::AngleOffset => "angle_offset",
            Self::CurrentOffset => "current_offset",
            Self::Imbalance => "current_imbalance",
            Self::TwoSensors(SensorPair::Ab) => "two_sensors_ab",
            Self::TwoSensors(SensorPair::Bc) => "two_sensors_bc",
            Self::TwoSensors(SensorPair::Ca) => "two_sensors_ca",
            Self::Saturation => "saturation",
            Self::ProcessNoise => "process_noise",
        }
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::DeadTime => "dead time",
            Self::AngleOffset => "angle offset",
            Self::CurrentOffset => "current sensor offset",
            Self::Imbalance => "imbalance of three current sensors",
            Self::TwoSensors(SensorPair::Ab) => "imbalance of current sensors a and b",
            Self::TwoSensors(SensorPair::Bc) => "imbalance of current sensors b and c",
            Self::TwoSensors(SensorPair::Ca) => "imbalance of current sensors c and a",
            Self::Saturation => "saturation",
            Self::ProcessNoise => "disturbing voltages",
        }
    }

    /// Its unknowns.
    pub fn unknowns(self) -> Vec<Unknown> {
        match self {
            Self::DeadTime => vec![Unknown::DeadTime, Unknown::DeadTimeWidth, Unknown::DeadTimeRipple],
            Self::AngleOffset => vec![Unknown::AngleOffset],
            Self::CurrentOffset => vec![Unknown::OffsetAlpha, Unknown::OffsetBeta],
            Self::Imbalance => vec![Unknown::ImbalanceAlpha, Unknown::ImbalanceBeta],
            Self::TwoSensors(pair) => vec![Unknown::TwoSensors(pair)],
            Self::Saturation => vec![Unknown::SaturationD, Unknown::SaturationQ, Unknown::CrossSaturation],
            Self::ProcessNoise => vec![Unknown::GainD, Unknown::GainQ],
        }
    }

    /// Whether it happens in the stator, so that the angle must be known.
    fn needs_angle(self) -> bool {
        matches!(self, Self::DeadTime | Self::CurrentOffset | Self::Imbalance | Self::TwoSensors(_))
    }

    /// Whether a second one of the kind would be the same fault again.
    fn same_fault(self, other: Self) -> bool {
        let imbalance = |term| matches!(term, Self::Imbalance | Self::TwoSensors(_));
        self == other || imbalance(self) && imbalance(other)
    }

    /// Where it starts from: at nothing, but for a width. Several, where the cost is not smooth in one of its numbers.
    fn starts(self, drive: &Adjustable, peak: f64) -> Vec<Adjustable> {
        match self {
            Self::DeadTime => WIDTHS.iter().map(|width| drive.with(Unknown::DeadTimeWidth, width * peak)).collect(),
            _ => vec![*drive],
        }
    }

    fn is_physical(self, drive: &Adjustable, peak: f64) -> bool {
        let nuisance = &drive.nuisance;
        match self {
            Self::DeadTime => nuisance.dead_time > 0.0,
            Self::AngleOffset => nuisance.angle_offset.abs() < MAX_ANGLE,
            Self::CurrentOffset => nuisance.current_offset.alpha.hypot(nuisance.current_offset.beta) < peak,
            Self::Imbalance | Self::TwoSensors(_) => nuisance.imbalance.alpha.hypot(nuisance.imbalance.beta) < WHOLE,
            Self::Saturation => {
                let Dq { d, q } = nuisance.saturation;
                let (d, q, cross) =
                    (d * peak / drive.motor.ld, q * peak / drive.motor.lq, nuisance.cross_saturation * peak / drive.motor.lq);
                // Iron takes flux away, what it takes is seen, and more current never makes less flux.
                let most = d.abs().max(q.abs()).max(cross.abs());
                d.max(q) < LEAST_SATURATION && most > LEAST_SATURATION && most < MOST_SATURATION
            }
            Self::ProcessNoise => {
                let Dq { d, q } = nuisance.observer_gain;
                d.max(q) > 0.0 && d.abs().max(q.abs()) < WHOLE
            }
        }
    }
}

/// What is known while terms are chosen.
pub(crate) struct Candidate<'a> {
    /// The fitness under each reading of the voltages.
    pub(crate) objectives: &'a [(VoltageReading, OutputError)],
    /// The reading that fits best now.
    pub(crate) reading: usize,
    pub(crate) beliefs: &'a [Belief],
    pub(crate) drive: Adjustable,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) cost: f64,
    pub(crate) voltage_accuracy: f64,
}

impl Candidate<'_> {
    /// The fitness under the reading that fits best now.
    pub(crate) fn objective(&self) -> &OutputError {
        &self.objectives[self.reading].1
    }

    /// Adds what the log carries: first an observer, if it would help, because beside it residuals are white and faults are judged
    /// by what they are worth; then faults; then the observer goes again, if they have made it useless. All that were tried are told.
    pub(crate) fn add_terms(&mut self) -> Vec<Tried> {
        let mut taken = self.take_best(&[Term::ProcessNoise], &[]);
        let whitened = taken.pop_if(|tried| tried.outcome == Outcome::Taken);
        if whitened.is_some() {
            self.settle();
        }
        taken.clear();
        let tried = loop {
            let tried = self.take_best(&Term::FAULTS, &taken);
            match tried.iter().find(|tried| tried.outcome == Outcome::Taken) {
                Some(best) => taken.push(best.clone()),
                None => break tried,
            }
            self.settle();
        };
        let observer = match whitened {
            Some(_) => self.drop_observer(),
            None => Tried { term: Term::ProcessNoise, gain: 0.0, outcome: Outcome::NotNeeded },
        };
        let mut all: Vec<Tried> = taken.into_iter().chain([observer]).chain(tried).collect();
        all.sort_by_key(|tried| tried.outcome != Outcome::Taken);
        all
    }

    /// Reads the voltages again, now that more is known; another reading may fit better.
    fn settle(&mut self) {
        if let Some((place, best)) = readings(self.objectives, &self.drive, &self.unknowns, self.beliefs).into_iter().next() {
            (self.reading, self.drive, self.cost) = (place, best.polished.drive, best.polished.cost);
        }
    }

    /// Whether the observer is still worth its unknowns; if not, it goes.
    fn drop_observer(&mut self) -> Tried {
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| !OBSERVER.contains(unknown)).collect();
        let start = OBSERVER.into_iter().fold(self.drive, |drive, gain| drive.with(gain, 0.0));
        let Some((place, without)) = readings(self.objectives, &start, &unknowns, self.beliefs).into_iter().next() else {
            return Tried { term: Term::ProcessNoise, gain: 0.0, outcome: Outcome::Taken };
        };
        let rows = 2.0 * self.objective().rows() as f64;
        let gain = schwarz(without.polished.cost, self.cost, OBSERVER.len(), rows);
        // What it is worth beside the faults found, and a sign that observers have.
        let nothing_left = (without.polished.cost / rows).sqrt() <= LEAST_RESIDUAL * self.objective().peak_current();
        let outcome = if gain <= VERY_STRONG || nothing_left {
            Outcome::NotNeeded
        } else if Term::ProcessNoise.is_physical(&self.drive, self.objective().peak_current()) {
            return Tried { term: Term::ProcessNoise, gain, outcome: Outcome::Taken };
        } else {
            Outcome::NotPhysical
        };
        (self.reading, self.drive, self.cost, self.unknowns) = (place, without.polished.drive, without.polished.cost, unknowns);
        Tried { term: Term::ProcessNoise, gain, outcome }
    }

    /// Judges terms; of those that deserve it the best is taken, and comes first.
    fn take_best(&mut self, terms: &[Term], taken: &[Tried]) -> Vec<Tried> {
        let scene = Scene::of(self, terms);
        let mut tried: Vec<(Tried, Vec<Adjustable>)> = terms
            .iter()
            .filter(|term| !taken.iter().any(|taken| taken.term == **term))
            .map(|term| {
                let outcome = if taken.iter().any(|taken| taken.term.same_fault(*term)) {
                    Outcome::Covered
                } else if term.needs_angle() && !self.objective().angle_known() {
                    Outcome::NeedsAngle
                } else {
                    Outcome::NotNeeded
                };
                let (gain, starts) = if outcome == Outcome::NotNeeded { scene.promise(self, *term) } else { (0.0, Vec::new()) };
                (Tried { term: *term, gain, outcome }, starts)
            })
            .collect();
        tried.sort_by(|(one, _), (other, _)| other.gain.total_cmp(&one.gain));
        for place in 0..tried.len() {
            let (one, starts) = &mut tried[place];
            if one.gain <= VERY_STRONG {
                break;
            }
            let (outcome, fitted) = scene.fit(self, one.term, starts);
            one.outcome = outcome;
            if let (Outcome::Taken, Some((drive, cost, unknowns))) = (outcome, fitted) {
                (self.drive, self.cost, self.unknowns) = (drive, cost, unknowns);
                tried.swap(0, place);
                break;
            }
        }
        tried.into_iter().map(|(tried, _)| tried).collect()
    }
}

/// The observer's unknowns.
const OBSERVER: [Unknown; 2] = [Unknown::GainD, Unknown::GainQ];

/// Starts of a term that are fitted: the most promising of those that were looked at.
const FITTED_STARTS: usize = 2;

/// Schwarz's criterion for so many further unknowns, given how many independent residuals there are.
fn schwarz(before: f64, after: f64, unknowns: usize, independent: f64) -> f64 {
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

/// Residuals and derivatives where the terms are judged.
struct Scene {
    residuals: Vec<f64>,
    jacobian: Vec<Vec<f64>>,
    /// Standard errors of the motor's unknowns, roughly.
    standard_errors: Vec<f64>,
    /// How many independent residuals there are.
    independent: f64,
    peak: f64,
}

impl Scene {
    fn of(candidate: &Candidate, terms: &[Term]) -> Self {
        let Candidate { drive, unknowns, cost, .. } = candidate;
        let objective = candidate.objective();
        let residuals = objective.residuals(drive);
        let jacobian = jacobian(objective, drive, unknowns);
        // With an observer, what is left is to be white: correlation is what it takes away, and every row counts.
        let independent = if terms.contains(&Term::ProcessNoise) { residuals.len() as f64 } else { independent(&residuals) };
        let inverse = inverse_normal(&jacobian);
        let accuracy = voltage_accuracy::covariance(objective, drive, &inverse, &jacobian, candidate.voltage_accuracy);
        let noise = inverse.diagonal() * (cost / independent);
        let standard_errors = (noise + accuracy.diagonal()).iter().map(|variance| variance.max(0.0).sqrt()).collect();
        Self { residuals, jacobian, standard_errors, independent, peak: objective.peak_current() }
    }

    /// What a term would gain by Schwarz's criterion if the cost were as quadratic as it looks from here, and where to start with it.
    fn promise(&self, candidate: &Candidate, term: Term) -> (f64, Vec<Adjustable>) {
        if (candidate.cost / self.residuals.len() as f64).sqrt() <= LEAST_RESIDUAL * self.peak {
            return (0.0, Vec::new());
        }
        let unknowns = term.unknowns();
        let gain_from = |start: Adjustable| {
            let columns = jacobian(candidate.objective(), &start, &unknowns);
            let all = [self.jacobian.clone(), columns].concat();
            let right = DVector::from_iterator(all.len(), all.iter().map(|column| dot(column, &self.residuals)));
            let explained = right.dot(&(inverse_normal(&all) * &right)).min(candidate.cost);
            (schwarz(candidate.cost, candidate.cost - explained, unknowns.len(), self.independent), start)
        };
        let mut gains: Vec<(f64, Adjustable)> = term.starts(&candidate.drive, self.peak).into_iter().map(gain_from).collect();
        gains.sort_by(|one, other| other.0.total_cmp(&one.0));
        let best = gains.first().map_or(f64::NEG_INFINITY, |best| best.0);
        (best, gains.into_iter().take(FITTED_STARTS).map(|(_, start)| start).collect())
    }

    /// Fits a term and says whether it deserves to be taken.
    fn fit(&self, candidate: &Candidate, term: Term, starts: &[Adjustable]) -> (Outcome, Option<(Adjustable, f64, Vec<Unknown>)>) {
        let unknowns = [candidate.unknowns.clone(), term.unknowns()].concat();
        let polished = starts
            .iter()
            .map(|start| polish_unknowns(candidate.objective(), start, &unknowns, candidate.beliefs))
            .min_by(|one, other| one.cost.total_cmp(&other.cost));
        let Some(polished) = polished else { return (Outcome::NotNeeded, None) };
        if schwarz(candidate.cost, polished.cost, term.unknowns().len(), self.independent) <= VERY_STRONG {
            return (Outcome::NotNeeded, None);
        }
        // An observer need not be one yet: it makes residuals white while faults are looked for.
        if term != Term::ProcessNoise && !term.is_physical(&polished.drive, self.peak) {
            return (Outcome::NotPhysical, None);
        }
        let moved = candidate.unknowns.iter().zip(&self.standard_errors).any(|(unknown, standard_error)| {
            matches!(unknown, Unknown::Motor(_)) && (polished.drive.get(*unknown) - candidate.drive.get(*unknown)).abs() > *standard_error
        });
        // Beside an observer the residuals are what a simple filter leaves of disturbances that nobody knows: small gains prove little.
        let disturbed = candidate.unknowns.contains(&Unknown::GainD);
        if (!moved || disturbed) && polished.cost > (1.0 - NOTICEABLE) * candidate.cost {
            return (Outcome::NoMatter, None);
        }
        (Outcome::Taken, Some((polished.drive, polished.cost, unknowns)))
    }
}

/// How many independent numbers the residuals are worth: fewer, the more neighbours are alike.
pub(crate) fn independent(residuals: &[f64]) -> f64 {
    let (rows, _) = residuals.as_chunks::<2>();
    let axis = |axis: usize| {
        let series: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
        let rho = first_correlation(&series, &[series.len()]).max(0.0);
        series.len() as f64 * (1.0 - rho) / (1.0 + rho)
    };
    (axis(0) + axis(1)).max(2.0 * PARAMETERS as f64)
}

/// Inverse of the normal matrix of these columns, zero along directions in which they do not differ.
pub(crate) fn inverse_normal(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let size = columns.len();
    // Columns of equal length: henries and ohms differ by orders of magnitude.
    let lengths: Vec<f64> =
        columns.iter().map(|column| dot(column, column).sqrt()).map(|length| if length > 0.0 { length } else { 1.0 }).collect();
    let normal = DMatrix::from_fn(size, size, |p, q| dot(&columns[p], &columns[q]) / lengths[p] / lengths[q]);
    let decomposition = SingularValueDecomposition::of(normal);
    let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
    DMatrix::from_fn(size, size, |p, q| inverse[(p, q)] / lengths[p] / lengths[q])
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

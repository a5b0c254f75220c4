//! Which faults of the drive a log carries: terms of the adjustable drive, each taken only if the log asks for it.
//!
//! A term is first judged where it is zero, by how much of the residual its derivatives explain beyond the other unknowns' (a score test);
//! only one that would pay is fitted. It is taken if
//!
//! - Schwarz's criterion pays for its unknowns, `N ln(cost before / cost after) > unknowns ln N`, with `N` independent residuals, fewer
//!   than there are rows where they are correlated (G. Schwarz, Ann. Stat. 6 (1978) 461, doi:10.1214/aos/1176344136);
//! - its value is physical;
//! - it moves a parameter by more than its standard error, or takes a noticeable part of the residual with it, so that intervals become
//!   sharper.
//!
//! The best term is taken first, and the others are judged again beside it.

use super::{long_run::first_correlation, output_fit::accuracy};
use crate::{
    frames::Dq,
    levenberg_marquardt::{Belief, jacobian, polish_unknowns},
    motor::PARAMETERS,
    objective::{
        adjustable::{Adjustable, SensorPair, Unknown},
        output_error::OutputError,
    },
    singular_values::Decomposition,
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

/// Widths of the dead time's ramp that are tried, as fractions of the largest current: from next to nothing to a ripple nearly as large as the current.
const WIDTHS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8];

/// Least part of the residual's power that a term takes with it to be worth having when no parameter moves.
const NOTICEABLE: f64 = 0.01;

/// Residuals below this fraction of the largest current are rounding and the model's own last digits: nothing to explain.
const LEAST_RESIDUAL: f64 = 1e-4;

/// The most that a current sensor's gain or an observer's can be.
const WHOLE: f64 = 1.0;

/// Largest angle that an encoder is wrong by, rad: beyond 45 degrees d and q change places.
const MAX_ANGLE: f64 = std::f64::consts::FRAC_PI_4;

/// Least extra flux, as a fraction of an inductance over the range of its current, that is worth calling saturation.
const LEAST_SATURATION: f64 = 0.01;

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
            Self::DeadTime => vec![Unknown::DeadTime, Unknown::DeadTimeWidth],
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
                // Iron takes flux away; and what it takes is seen.
                d.abs().max(q.abs()).max(cross.abs()) > LEAST_SATURATION
            }
            Self::ProcessNoise => {
                let Dq { d, q } = nuisance.observer_gain;
                d.max(q) > 0.0 && d.min(q) > -WHOLE && d.max(q) < WHOLE + WHOLE
            }
        }
    }
}

/// What is known while terms are chosen.
pub(super) struct Candidate<'a> {
    pub(super) objective: &'a OutputError,
    pub(super) beliefs: &'a [Belief],
    pub(super) drive: Adjustable,
    pub(super) unknowns: Vec<Unknown>,
    pub(super) cost: f64,
    pub(super) voltage_accuracy: f64,
}

impl Candidate<'_> {
    /// Adds the faults that the log carries. All that were tried are told.
    pub(super) fn add_faults(&mut self) -> Vec<Tried> {
        let mut taken: Vec<Tried> = Vec::new();
        loop {
            let tried = self.judge(&Term::FAULTS, &taken);
            match tried.iter().find(|tried| tried.outcome == Outcome::Taken).cloned() {
                Some(best) => taken.push(best),
                None => return taken.into_iter().chain(tried).collect(),
            }
        }
    }

    /// Adds an observer, if unknown voltages disturb the motor.
    pub(super) fn add_process_noise(&mut self) -> Tried {
        let judged = self.judge(&[Term::ProcessNoise], &[]).into_iter().next();
        judged.unwrap_or(Tried { term: Term::ProcessNoise, gain: 0.0, outcome: Outcome::NotNeeded })
    }

    /// Judges terms; of those that deserve it the best is taken, and comes first.
    fn judge(&mut self, terms: &[Term], taken: &[Tried]) -> Vec<Tried> {
        let scene = Scene::of(self, terms);
        let mut tried: Vec<Tried> = terms
            .iter()
            .filter(|term| !taken.iter().any(|taken| taken.term == **term))
            .map(|term| {
                let outcome = if taken.iter().any(|taken| taken.term.same_fault(*term)) {
                    Outcome::Covered
                } else if term.needs_angle() && !self.objective.angle_known() {
                    Outcome::NeedsAngle
                } else {
                    Outcome::NotNeeded
                };
                Tried { term: *term, gain: if outcome == Outcome::NotNeeded { scene.promise(self, *term) } else { 0.0 }, outcome }
            })
            .collect();
        tried.sort_by(|one, other| other.gain.total_cmp(&one.gain));
        for place in 0..tried.len() {
            if tried[place].gain <= 0.0 {
                break;
            }
            let (outcome, fitted) = scene.fit(self, tried[place].term);
            tried[place].outcome = outcome;
            if let (Outcome::Taken, Some((drive, cost, unknowns))) = (outcome, fitted) {
                (self.drive, self.cost, self.unknowns) = (drive, cost, unknowns);
                // The others are as they were judged without it, if nothing more is taken.
                tried.swap(0, place);
                break;
            }
        }
        tried
    }
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
        let Candidate { objective, drive, unknowns, cost, .. } = candidate;
        let residuals = objective.residuals(drive);
        let jacobian = jacobian(objective, drive, unknowns);
        // With an observer, what is left is to be white: correlation is what it takes away, and every row counts.
        let independent = if terms.contains(&Term::ProcessNoise) { residuals.len() as f64 } else { independent(&residuals) };
        let inverse = inverse_normal(&jacobian);
        let accuracy = accuracy(objective, drive, &inverse, &jacobian, candidate.voltage_accuracy);
        let noise = inverse.diagonal() * (cost / independent);
        let standard_errors = (noise + accuracy.diagonal()).iter().map(|variance| variance.max(0.0).sqrt()).collect();
        Self { residuals, jacobian, standard_errors, independent, peak: objective.peak_current() }
    }

    /// What a term would gain by Schwarz's criterion if the cost were as quadratic as it looks from here.
    fn promise(&self, candidate: &Candidate, term: Term) -> f64 {
        let peak = self.peak;
        if (candidate.cost / self.residuals.len() as f64).sqrt() <= LEAST_RESIDUAL * peak {
            return 0.0;
        }
        let gain_from = |start: Adjustable| {
            let unknowns = term.unknowns();
            let columns = jacobian(candidate.objective, &start, &unknowns);
            let all = [self.jacobian.clone(), columns].concat();
            let right = DVector::from_iterator(all.len(), all.iter().map(|column| dot(column, &self.residuals)));
            let explained = right.dot(&(inverse_normal(&all) * &right)).min(candidate.cost * (1.0 - f64::EPSILON));
            self.gain(candidate.cost, candidate.cost - explained, unknowns.len())
        };
        term.starts(&candidate.drive, peak).into_iter().map(gain_from).fold(f64::NEG_INFINITY, f64::max)
    }

    fn gain(&self, before: f64, after: f64, unknowns: usize) -> f64 {
        if after <= 0.0 && before <= 0.0 {
            return f64::NEG_INFINITY;
        }
        self.independent * (before / after).ln() - unknowns as f64 * self.independent.ln()
    }

    /// Fits a term and says whether it deserves to be taken.
    fn fit(&self, candidate: &Candidate, term: Term) -> (Outcome, Option<(Adjustable, f64, Vec<Unknown>)>) {
        let unknowns = [candidate.unknowns.clone(), term.unknowns()].concat();
        let polished = term
            .starts(&candidate.drive, self.peak)
            .into_iter()
            .map(|start| polish_unknowns(candidate.objective, &start, &unknowns, candidate.beliefs))
            .min_by(|one, other| one.cost.total_cmp(&other.cost));
        let Some(polished) = polished else { return (Outcome::NotNeeded, None) };
        if self.gain(candidate.cost, polished.cost, term.unknowns().len()) <= 0.0 {
            return (Outcome::NotNeeded, None);
        }
        if !term.is_physical(&polished.drive, self.peak) {
            return (Outcome::NotPhysical, None);
        }
        let moved = candidate.unknowns.iter().zip(&self.standard_errors).any(|(unknown, standard_error)| {
            matches!(unknown, Unknown::Motor(_)) && (polished.drive.get(*unknown) - candidate.drive.get(*unknown)).abs() > *standard_error
        });
        if !moved && polished.cost > (1.0 - NOTICEABLE) * candidate.cost {
            return (Outcome::NoMatter, None);
        }
        (Outcome::Taken, Some((polished.drive, polished.cost, unknowns)))
    }
}

/// How many independent numbers the residuals are worth: fewer, the more neighbours are alike.
pub(super) fn independent(residuals: &[f64]) -> f64 {
    let (rows, _) = residuals.as_chunks::<2>();
    let axis = |axis: usize| {
        let series: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
        let rho = first_correlation(&series, &[series.len()]).max(0.0);
        series.len() as f64 * (1.0 - rho) / (1.0 + rho)
    };
    (axis(0) + axis(1)).max(2.0 * PARAMETERS as f64)
}

/// Inverse of the normal matrix of these columns, zero along directions in which they do not differ.
pub(super) fn inverse_normal(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let size = columns.len();
    // Columns of equal length: henries and ohms differ by orders of magnitude.
    let lengths: Vec<f64> =
        columns.iter().map(|column| dot(column, column).sqrt()).map(|length| if length > 0.0 { length } else { 1.0 }).collect();
    let normal = DMatrix::from_fn(size, size, |p, q| dot(&columns[p], &columns[q]) / lengths[p] / lengths[q]);
    let decomposition = Decomposition::of(normal);
    let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
    DMatrix::from_fn(size, size, |p, q| inverse[(p, q)] / lengths[p] / lengths[q])
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

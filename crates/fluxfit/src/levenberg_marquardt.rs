//! The polish: from near a minimum of the output error into it.
//!
//! Levenberg's and Marquardt's method on the residuals, with derivatives by central differences (fits that are only compared with each
//! other take forward ones, which cost half); J. J. Moré, "The Levenberg-Marquardt algorithm: implementation and theory", 1978,
//! doi:10.1007/BFb0067700, as the crate of that name has it. Unknowns are counted in units of their usual size, so that ohms and henries
//! weigh alike; one that enters linearly is solved in one step.

use crate::{
    motor::{Motor, Parameter},
    normal_matrix::{FewRows, NormalMatrix, dot},
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

/// Step of the differences, in the unknowns' units: the cube root of rounding, at which the errors of a central difference are least.
const STEP: f64 = 6e-6;

/// The same of a forward difference: the square root of rounding, or somewhat more, because a simulation gathers some.
const FORWARD_STEP: f64 = 1e-7;

/// Residual of a motor that cannot be simulated, A: larger than of any that can, and still finite when squared and summed.
const HOPELESS: f64 = 1e100;

/// Steps that lower the cost, or move the unknowns, by less than this fraction end the iteration: a thousandth of the relative standard
/// error that noise causes over a million rows, and above the errors of differences and rounding.
const NO_STEP: f64 = 1e-9;

/// The same for fits that are only compared with each other: of ten thousand residuals a thousandth of what noise changes in a cost.
const NO_STEP_OF_CHOICE: f64 = 1e-7;

/// What such a fit must gain to go on, by twice the logarithm of the odds: a tenth of very strong evidence.
const WORTH_GOING_ON: f64 = 1.0;

/// The same of an answer: along a way that gains so much, an unknown moves by a tenth of its standard error. Beside a loss with edges some
/// fits crept on for forty steps and more, each gaining a tenth of this or less.
const WORTH_GOING_ON_FOR_AN_ANSWER: f64 = 0.01;

/// It ends, too, where its derivatives promise less than this part of that gain, all steps to come together.
const WORTH_A_STEP: f64 = 0.1;

/// It ends after so many evaluations without that gain. Where a current's sign decides, residuals have kinks: derivatives promise what no
/// step keeps, and steps would be halved twenty times in vain. A step that is too long is shortened to a half or less at once. With
/// three, more numbers of drawn drives were wrong.
const EVALUATIONS_IN_VAIN: usize = 4;

/// The same before anything was gained: the first steps may be much too long. Of an answer twice as many.
const FIRST_EVALUATIONS_IN_VAIN: usize = 6;

/// The same for a fit that ends after its first step: any step is small beside it.
const FIRST_STEP: f64 = 1.0;

/// A fit whose derivatives promise less than this part of the cost that is left, after a step that kept what they promised, is near its
/// end: where it ends above a cost that it would have to beat, the rest changes nothing.
const NEAR_THE_END: f64 = 0.1;

/// A fit that only tells how far unknowns move is at its end when so small a part of the way is left.
const REST_OF_THE_WAY: f64 = 0.03;

/// Evaluations per unknown after which a polish gives up. From near a minimum it takes five to ten steps.
const PATIENCE: usize = 4;

/// Prior knowledge of an unknown: one more residual, `(value - x) weight`, A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorResidual {
    /// The unknown.
    pub unknown: Unknown,
    /// Its expected value, SI.
    pub value: f64,
    /// A per SI unit: the noise of a current over the standard error of the value.
    pub weight: f64,
}

/// Derivatives of the residuals by each unknown, with a residual more for each prior.
pub(crate) fn with_priors(mut slopes: Vec<Vec<f64>>, unknowns: &[Unknown], priors: &[PriorResidual]) -> Vec<Vec<f64>> {
    for (column, unknown) in slopes.iter_mut().zip(unknowns) {
        column.extend(priors.iter().map(|belief| if belief.unknown == *unknown { -belief.weight } else { 0.0 }));
    }
    slopes
}

/// Where a polish ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polished {
    /// The drive.
    pub drive: Adjustable,
    /// Its cost, A², prior residuals not counted.
    pub cost: f64,
    /// Whether this is a minimum.
    pub converged: bool,
}

/// All four parameters.
pub const MOTOR: [Unknown; 4] =
    [Unknown::Motor(Parameter::Rs), Unknown::Motor(Parameter::Ld), Unknown::Motor(Parameter::Lq), Unknown::Motor(Parameter::PsiF)];

/// Polishes a motor in a perfect drive. A start that has no finite cost is where it ends.
pub fn polish(objective: &OutputError, start: &Motor) -> Polished {
    polish_unknowns(objective, &Adjustable::from(*start), &MOTOR, &[])
}

/// Polishes these unknowns of a drive and leaves the others where they are.
pub fn polish_unknowns(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    polish_with_progress(objective, start, unknowns, priors, &|_| ())
}

/// [`polish_unknowns`] as far as a comparison of costs needs it.
pub(crate) fn polish_to_choose(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    minimize(objective, start, unknowns, priors, Purpose::Choice { to_beat: 0.0 }, &|_| ())
}

/// The same where only a cost below one, A², changes anything: it ends as soon as it will clearly not get there.
pub(crate) fn polish_to_beat(
    cost: f64,
    objective: &OutputError,
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
) -> Polished {
    minimize(objective, start, unknowns, priors, Purpose::Choice { to_beat: cost }, &|_| ())
}

/// The same to see how far the unknowns move from a start: within some hundredths of the way.
pub(crate) fn polish_for_distance(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    minimize(objective, start, unknowns, priors, Purpose::Distance, &|_| ())
}

/// The first step of a polish alone.
pub(crate) fn step(objective: &OutputError, start: &Adjustable, unknowns: &[Unknown], priors: &[PriorResidual]) -> Polished {
    minimize(objective, start, unknowns, priors, Purpose::FirstStep, &|_| ())
}

/// [`polish_unknowns`], which calls `progress` after each step with the number of simulations so far.
pub fn polish_with_progress(
    objective: &OutputError,
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    progress: &dyn Fn(usize),
) -> Polished {
    minimize(objective, start, unknowns, priors, Purpose::Answer, progress)
}

/// What a fit is for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Purpose {
    /// An answer.
    Answer,
    /// A comparison with other fits.
    Choice {
        /// The cost that it has to come below to change anything, A²; zero if any cost matters.
        to_beat: f64,
    },
    /// How far the unknowns move.
    Distance,
    /// The same, after one step.
    FirstStep,
}

impl Purpose {
    const fn no_step(self) -> f64 {
        match self {
            Self::Answer => NO_STEP,
            Self::Choice { .. } | Self::Distance => NO_STEP_OF_CHOICE,
            Self::FirstStep => FIRST_STEP,
        }
    }

    const fn worth_going_on(self) -> f64 {
        match self {
            Self::Answer => WORTH_GOING_ON_FOR_AN_ANSWER,
            Self::Choice { .. } | Self::Distance | Self::FirstStep => WORTH_GOING_ON,
        }
    }

    const fn differences(self) -> Differences {
        match self {
            Self::Answer => Differences::Central,
            Self::Choice { .. } | Self::Distance | Self::FirstStep => Differences::Forward,
        }
    }
}

fn minimize(
    objective: &OutputError,
    start: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    purpose: Purpose,
    progress: &dyn Fn(usize),
) -> Polished {
    let scale: Vec<f64> = unknowns.iter().map(|unknown| start.step_unit(*unknown, objective.peak_current())).collect();
    let units = DVector::from_fn(unknowns.len(), |k, _| start.get(unknowns[k]) / scale[k]);
    let in_vain = InVain { since: f64::INFINITY, evaluations: 0, gains: 0 };
    let mut problem = Problem {
        objective,
        start,
        unknowns,
        priors,
        scale,
        purpose,
        first_cost: f64::INFINITY,
        simulations: 0,
        progress,
        here: None,
        best: None,
        in_vain,
    };
    problem.set_params(&units);
    // Beside faults, steps are counted by usual sizes and not by the lengths of the columns: an unknown that does nothing here, as the
    // width of a loss where another limit rules, could go as far as it likes, and when its steps fail, they would hold back all others.
    let is_motor_alone = unknowns.iter().all(|unknown| matches!(unknown, Unknown::Motor(_)));
    let method = LevenbergMarquardt::new().with_ftol(purpose.no_step()).with_xtol(purpose.no_step()).with_patience(PATIENCE);
    let (problem, report) = method.with_scale_diag(is_motor_alone).minimize(problem);
    let converged = report.termination.was_successful() || problem.is_enough();
    let (drive, cost) = problem.best.map_or((*start, f64::NAN), |best| (best.drive, best.cost));
    Polished { drive, cost, converged }
}

/// How derivatives are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Differences {
    Central,
    Forward,
}

impl Differences {
    /// How far each unknown is moved, SI.
    fn steps(self, drive: &Adjustable, unknowns: &[Unknown], peak_current: f64) -> Vec<f64> {
        let step = match self {
            Self::Central => STEP,
            Self::Forward => FORWARD_STEP,
        };
        unknowns.iter().map(|unknown| step * drive.step_unit(*unknown, peak_current)).collect()
    }

    /// The drives whose residuals are compared: one or two per unknown.
    fn moved(self, drive: &Adjustable, unknowns: &[Unknown], steps: &[f64]) -> Vec<Adjustable> {
        let moved = |(unknown, step): (&Unknown, &f64)| match self {
            Self::Central => [*step, -step].map(|by| drive.with(*unknown, drive.get(*unknown) + by)).to_vec(),
            Self::Forward => vec![drive.with(*unknown, drive.get(*unknown) + step)],
        };
        unknowns.iter().zip(steps).flat_map(moved).collect()
    }

    /// The derivatives, given the residuals of those drives and those of the drive itself, which central differences do not need. They
    /// take the place of residuals.
    fn slopes(self, moved: Vec<Vec<f64>>, here: &[f64], steps: &[f64]) -> Vec<Vec<f64>> {
        let difference = |mut one: Vec<f64>, other: &[f64], step: f64| {
            one.iter_mut().zip(other).for_each(|(one, other)| *one = (*one - other) / step);
            one
        };
        let mut moved = moved.into_iter();
        let mut next = || moved.next().unwrap_or_default();
        let slope = |step: &f64| match self {
            Self::Central => {
                let (ahead, behind) = (next(), next());
                difference(ahead, &behind, 2.0 * step)
            }
            Self::Forward => difference(next(), here, *step),
        };
        steps.iter().map(slope).collect()
    }
}

/// Derivatives of the residuals by each unknown, A per SI unit: a column each.
pub fn jacobian(objective: &OutputError, drive: &Adjustable, unknowns: &[Unknown]) -> Vec<Vec<f64>> {
    let steps = Differences::Central.steps(drive, unknowns, objective.peak_current());
    let moved = objective.residuals_of_all(&Differences::Central.moved(drive, unknowns, &steps));
    Differences::Central.slopes(moved, &[], &steps)
}

/// The residuals of a drive, A, and their derivatives, A per SI unit.
#[derive(Default)]
pub(crate) struct Linearized {
    pub(crate) residuals: Vec<f64>,
    /// A column per unknown.
    pub(crate) slopes: Vec<Vec<f64>>,
}

/// Residuals and their derivatives by forward differences, for what is only compared, of many drives at once: no lane is idle.
pub(crate) fn linearized(objective: &OutputError, drives: &[(Adjustable, Vec<Unknown>)]) -> Vec<Linearized> {
    by_differences(objective, drives, Differences::Forward)
}

/// The same of one drive.
pub(crate) fn linearized_one(objective: &OutputError, drive: &Adjustable, unknowns: &[Unknown]) -> Linearized {
    linearized(objective, &[(*drive, unknowns.to_vec())]).pop().unwrap_or_default()
}

fn by_differences(objective: &OutputError, drives: &[(Adjustable, Vec<Unknown>)], differences: Differences) -> Vec<Linearized> {
    let steps: Vec<Vec<f64>> =
        drives.iter().map(|(drive, unknowns)| differences.steps(drive, unknowns, objective.peak_current())).collect();
    let with_moved = |((drive, unknowns), steps): (&(Adjustable, Vec<Unknown>), &Vec<f64>)| {
        let moved = differences.moved(drive, unknowns, steps);
        std::iter::once(*drive).chain(moved)
    };
    let all: Vec<Adjustable> = drives.iter().zip(&steps).flat_map(with_moved).collect();
    let mut residuals = objective.residuals_of_all(&all).into_iter();
    let one = |steps: &Vec<f64>| {
        let here = residuals.next().unwrap_or_default();
        let count = if differences == Differences::Central { 2 * steps.len() } else { steps.len() };
        let moved: Vec<Vec<f64>> = residuals.by_ref().take(count).collect();
        Linearized { slopes: differences.slopes(moved, &here, steps), residuals: here }
    };
    steps.iter().map(one).collect()
}

/// The problem as the minimizer sees it: as many residuals as unknowns, and one, whose squares and derivatives are those of all rows
/// together. What a point needs is computed when it is set, its derivatives too, because they share a batch with its residuals.
struct Problem<'a> {
    objective: &'a OutputError,
    start: &'a Adjustable,
    unknowns: &'a [Unknown],
    priors: &'a [PriorResidual],
    scale: Vec<f64>,
    purpose: Purpose,
    /// The cost where the fit begins, with that of priors, A².
    first_cost: f64,
    simulations: usize,
    progress: &'a dyn Fn(usize),
    here: Option<Point>,
    /// Of all that were set, that of least cost: the one that a step in vain goes back to.
    best: Option<Point>,
    in_vain: InVain,
}

/// What was tried without a gain worth going on for.
struct InVain {
    /// The cost since then with that of priors, A².
    since: f64,
    evaluations: usize,
    /// Evaluations that gained something, the first one among them.
    gains: usize,
}

/// What is known of a point.
#[derive(Clone)]
struct Point {
    units: DVector<f64>,
    drive: Adjustable,
    /// Without priors; infinite where a residual is no number, so that it loses every comparison.
    cost: f64,
    residuals: DVector<f64>,
    /// The cost, with that of priors, where derivatives see the minimum, A².
    left: f64,
    /// None if a derivative is no number, or nobody asks for it.
    jacobian: Option<DMatrix<f64>>,
}

impl Problem<'_> {
    /// Whether the fit is good enough for what it is for.
    fn is_enough(&self) -> bool {
        let limit = match self.purpose {
            _ if self.in_vain.gains > 1 => EVALUATIONS_IN_VAIN,
            Purpose::Answer => 2 * FIRST_EVALUATIONS_IN_VAIN,
            _ => FIRST_EVALUATIONS_IN_VAIN,
        };
        let is_in_vain = self.in_vain.evaluations >= limit;
        let is_there = match self.purpose {
            Purpose::FirstStep => return false,
            Purpose::Answer => return is_in_vain,
            Purpose::Choice { to_beat } => self.is_beaten(to_beat),
            Purpose::Distance => self.has_little_way_left(),
        };
        is_there || is_in_vain || self.promises_little()
    }

    /// The best point so far that has derivatives.
    fn derived(&self) -> Option<&Point> {
        self.best.as_ref().filter(|best| best.jacobian.is_some())
    }

    /// Whether the fit ends above what it would have to beat: by its derivatives, after a step at least.
    fn is_beaten(&self, to_beat: f64) -> bool {
        let Some(best) = self.derived().filter(|_| to_beat > 0.0 && self.in_vain.gains > 1) else { return false };
        best.left > (1.0 - NEAR_THE_END) * best.residuals.norm_squared() && (1.0 - NEAR_THE_END) * best.left > to_beat
    }

    /// Whether the way that is left is short beside the way that was gone: a cost grows with its square.
    fn has_little_way_left(&self) -> bool {
        let rest = |best: &Point| best.residuals.norm_squared() - best.left;
        self.derived().is_some_and(|best| rest(best) < REST_OF_THE_WAY.powi(2) * (self.first_cost - best.residuals.norm_squared()))
    }

    /// Whether the derivatives at the best point so far promise less than is worth a step.
    fn promises_little(&self) -> bool {
        let Some(best) = self.derived() else { return false };
        best.left > best.residuals.norm_squared() * self.odds(-WORTH_A_STEP * WORTH_GOING_ON)
    }

    /// The ratio of two costs whose odds have this logarithm, twice: it is the number of residuals times the logarithm of that ratio.
    fn odds(&self, twice_the_logarithm: f64) -> f64 {
        (twice_the_logarithm / (2 * self.objective.rows()) as f64).exp()
    }

    /// Whether the next point is the last one.
    fn is_at_the_end(&self) -> bool {
        self.purpose == Purpose::FirstStep && self.here.is_some()
    }

    fn point(&self, units: &DVector<f64>) -> Point {
        let values = units.iter().zip(&self.scale).map(|(units, scale)| units * scale);
        let drive = self.unknowns.iter().zip(values).fold(*self.start, |drive, (unknown, value)| drive.with(*unknown, value));
        // Where a first step ends, nobody asks for derivatives.
        let moved = if self.is_at_the_end() { Vec::new() } else { self.unknowns.to_vec() };
        let point = by_differences(self.objective, &[(drive, moved)], self.purpose.differences()).pop();
        let Linearized { mut residuals, mut slopes } = point.unwrap_or_default();
        let squares = dot(&residuals, &residuals);
        let cost = if squares.is_nan() { f64::INFINITY } else { squares };
        // A bad candidate is no failure: the next step is shorter.
        residuals.iter_mut().filter(|residual| residual.abs() > HOPELESS || residual.is_nan()).for_each(|residual| *residual = HOPELESS);
        residuals.extend(self.priors.iter().map(|prior| prior.weight * (prior.value - drive.get(prior.unknown))));
        for ((column, unknown), scale) in slopes.iter_mut().zip(self.unknowns).zip(&self.scale) {
            column.iter_mut().for_each(|slope| *slope *= scale);
            column.extend(self.priors.iter().map(|prior| if prior.unknown == *unknown { -prior.weight * scale } else { 0.0 }));
        }
        let count = self.unknowns.len();
        let right = DVector::from_iterator(slopes.len(), slopes.iter().map(|column| dot(column, &residuals)));
        let squares = dot(&residuals, &residuals);
        let normal = NormalMatrix::of(&slopes);
        let is_known = slopes.len() == count && normal.is_finite() && right.iter().all(|number| number.is_finite());
        let (jacobian, explained) = if is_known {
            let FewRows { matrix, right } = normal.few_rows(&right);
            (Some(matrix.insert_row(count, 0.0)), right)
        } else {
            (None, DVector::zeros(count))
        };
        let rest = (squares - explained.norm_squared()).max(0.0).sqrt();
        Point { units: units.clone(), drive, cost, residuals: explained.push(rest), left: rest * rest, jacobian }
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, units: &DVector<f64>) {
        if let Some(best) = self.best.as_ref().filter(|best| best.units == *units) {
            self.here = Some(best.clone());
            return;
        }
        let point = self.point(units);
        self.simulations += 1 + if self.purpose == Purpose::Answer { 2 } else { 1 } * self.unknowns.len();
        (self.progress)(self.simulations);
        let with_priors = point.residuals.norm_squared();
        if self.first_cost.is_infinite() {
            self.first_cost = with_priors;
        }
        self.in_vain = if with_priors < self.in_vain.since * self.odds(-self.purpose.worth_going_on()) {
            InVain { since: with_priors, evaluations: 0, gains: self.in_vain.gains + 1 }
        } else {
            InVain { evaluations: self.in_vain.evaluations + 1, ..self.in_vain }
        };
        if self.best.as_ref().is_none_or(|best| point.residuals.norm() < best.residuals.norm()) {
            self.best = Some(point.clone());
        }
        self.here = Some(point);
    }

    fn params(&self) -> DVector<f64> {
        self.here.as_ref().map(|here| here.units.clone()).unwrap_or_default()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        // Without residuals the minimizer ends.
        self.here.as_ref().filter(|_| !self.is_enough()).map(|here| here.residuals.clone())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        self.here.as_ref()?.jacobian.clone()
    }
}

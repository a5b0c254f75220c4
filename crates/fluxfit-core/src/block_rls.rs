//! Recursive least squares over blocks of periods, in square-root form, with gated forgetting.
//!
//! When to use it: it needs no start values to converge and no tuning, tells honestly which parameters the last samples determine, and
//! takes 25 multiplications a sample. Its standard errors are 1.3 to 2.6 times those of the best estimate.
//!
//! A block gives two equations ([`block`](crate::block)). Older ones lose weight only while the memory holds excitation
//! ([`gate`](crate::gate)).

use crate::{
    PARAMETERS,
    block::{Block, Equations},
    gate::Gate,
    period::Period,
    real::Real,
    square_root::{Row, SquareRoot},
};

/// Weight of the equations "the parameter is nominal" at the start, V: so little that they mean nothing beside a volt.
const START_WEIGHT: f64 = 1e-3;

/// Systematic standard uncertainty of a drive's voltages, as a part of the vector: that of `fluxfit identify`.
const VOLTAGE_ACCURACY: f64 = 1e-4;

/// Degrees of freedom below which a residual means too little: with 20, four standard errors are still exceeded once in a thousand times.
const FEWEST: f64 = 20.0;

/// Standard error, as a part of the nominal value, of what is not known: finite, so that it can be saved as text.
const UNKNOWN: f64 = 1e9;

/// A current so many times the rated one is a spike, as in `fluxfit-track`: least squares would remember it.
const SPIKE: f64 = 20.0;

/// How many times the noise counts against the information of a direction: one that is known has at least as much of it from signals.
const NOISE_COUNTS: f64 = 2.0;

/// Standard error of a direction that nothing determines, in nominal values: a parameter is no further off than that, and what one
/// operating point tells of L_q must not depend on an R_s of thousands of ohms.
const UNDETERMINED: f64 = 10.0;

/// Added to a variance, V², so that none is zero.
const SMALLEST: f64 = 1e-20;

/// Settings.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BlockRlsSettings<T> {
    /// The values, SI, that are taken as one: within a factor of some tens.
    pub nominal: [T; PARAMETERS],
    /// Relative standard error of a nominal value that is known beforehand; zero: it is exact.
    pub known: [Option<T>; PARAMETERS],
    /// Periods of a block.
    pub periods: u32,
    /// Weight that a block keeps when the next one comes; one for constant parameters.
    pub forgetting: T,
    /// Whether blocks keep their weight while nothing excites the parameters.
    pub gated: bool,
    /// Whether the equations have the derivative of the current; without it they hold in steady state only.
    pub has_derivative: bool,
    /// Rated current, A, and speed, electrical rad/s; without them the largest seen, and spikes are not looked for.
    pub rating: Option<[T; 2]>,
}

impl<T: Real> BlockRlsSettings<T> {
    /// Blocks of 50 periods (5 ms at 10 kHz), of which 100 are remembered while they excite the parameters.
    pub fn new(nominal: [T; PARAMETERS]) -> Self {
        Self { nominal, known: [None; PARAMETERS], periods: 50, forgetting: T::of(0.99), gated: true, has_derivative: true, rating: None }
    }
}

/// What the last samples tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<T> {
    /// Values, SI.
    pub value: [T; PARAMETERS],
    /// Standard errors, SI, with the bias by noise in the coefficients counted in.
    pub standard_error: [T; PARAMETERS],
}

/// The estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BlockRls<T> {
    settings: BlockRlsSettings<T>,
    block: Option<Block<T>>,
    root: SquareRoot<T>,
    gate: Gate<T>,
    /// Weight of all blocks.
    weight: T,
    /// Sum of squared residuals, V².
    squares: T,
    /// Degrees of freedom of that sum.
    freedom: T,
    /// Mean squared voltage, V².
    voltage: T,
    /// Weighted sum of [`Equations::by_noise`].
    by_noise: [T; PARAMETERS],
    #[cfg_attr(feature = "serde", serde(default))]
    left_out: u32,
}

impl<T: Real> BlockRls<T> {
    /// An estimator that knows nothing but the nominal values.
    pub fn new(settings: BlockRlsSettings<T>) -> Self {
        Self {
            settings,
            block: None,
            root: SquareRoot::new(T::of(START_WEIGHT)),
            gate: Gate::new(settings.rating),
            weight: T::ZERO,
            squares: T::ZERO,
            freedom: T::ZERO,
            voltage: T::ZERO,
            by_noise: [T::ZERO; PARAMETERS],
            left_out: 0,
        }
    }

    /// Begins at a measured current, A: at the start, and after a gap.
    pub fn begin(&mut self, i: [T; 2]) {
        self.block = (i[0].is_finite() && i[1].is_finite()).then(|| Block::new(self.settings.periods, i));
    }

    /// Goes on by a period with the current, A, measured at its end. True if a block is full, and the estimate has changed. What is no
    /// number, or a spike, is left out, as a gap.
    pub fn advance(&mut self, period: &Period<T>, i: [T; 2]) -> bool {
        let is_sound = [period.u[0], period.u[1], period.omega_e, i[0], i[1]].iter().all(|value| value.is_finite());
        let is_spike = self.settings.rating.is_some_and(|[rated, _]| i[0].abs() + i[1].abs() > T::of(SPIKE) * rated);
        if !(is_sound && period.length > T::ZERO) || is_spike {
            self.left_out = self.left_out.saturating_add(1);
            self.block = None;
            return false;
        }
        let Some(block) = &mut self.block else {
            self.begin(i);
            return false;
        };
        let Some(mut equations) = block.add(period, i, &self.settings.nominal) else { return false };
        if !self.settings.has_derivative {
            (equations.rows[0].phi[1], equations.rows[1].phi[2]) = (T::ZERO, T::ZERO);
        }
        self.take(&equations);
        true
    }

    fn take(&mut self, equations: &Equations<T>) {
        self.gate.note(equations.id, equations.current, equations.omega_e);
        let keeps = if self.settings.gated && !self.gate.is_open() { T::ONE } else { self.settings.forgetting };
        if keeps < T::ONE {
            self.root.weigh(keeps);
            for sum in [&mut self.weight, &mut self.squares, &mut self.freedom] {
                *sum = *sum * keeps;
            }
            self.by_noise.iter_mut().for_each(|sum| *sum = *sum * keeps);
        }
        self.weight += T::ONE;
        let part = T::ONE / self.weight;
        let z = self.scaled();
        for row in &equations.rows {
            let row = self.without_fixed(row);
            let error = (0..PARAMETERS).fold(row.y, |error, j| error - row.phi[j] * z[j]);
            // The first four equations fit anyhow: what the uncertainty of the parameters explains is no residual.
            let share = T::ONE / (T::ONE + self.root.leverage(&row.phi));
            self.squares += error * error * share;
            self.freedom += share;
            self.root.add(&row);
        }
        self.voltage += part * (equations.voltage_squared - self.voltage);
        for (sum, by_noise) in self.by_noise.iter_mut().zip(&equations.by_noise) {
            *sum += *by_noise;
        }
    }

    fn is_fixed(&self, j: usize) -> bool {
        self.settings.known[j].is_some_and(|error| error <= T::ZERO)
    }

    fn without_fixed(&self, row: &Row<T>) -> Row<T> {
        let mut free = *row;
        for j in (0..PARAMETERS).filter(|j| self.is_fixed(*j)) {
            free.y -= row.phi[j];
            free.phi[j] = T::ZERO;
        }
        free
    }

    /// Variance of an equation's right side, V²: its residual, and no less than the accuracy of the voltages.
    fn variance(&self) -> T {
        let residual = self.squares / self.freedom.larger(T::ONE);
        residual + T::of(VOLTAGE_ACCURACY * VOLTAGE_ACCURACY) * self.voltage + T::of(SMALLEST)
    }

    /// The equations with those of the priors.
    fn with_priors(&self) -> SquareRoot<T> {
        let mut root = self.root;
        for j in 0..PARAMETERS {
            if let Some(error) = self.settings.known[j].filter(|error| *error > T::ZERO) {
                let weight = self.variance().sqrt() / error;
                let mut phi = [T::ZERO; PARAMETERS];
                phi[j] = weight;
                root.add(&Row { phi, y: weight });
            }
        }
        root
    }

    /// The parameters as parts of their nominal values.
    pub fn scaled(&self) -> [T; PARAMETERS] {
        self.with_fixed(self.with_priors().solve())
    }

    fn with_fixed(&self, mut z: [T; PARAMETERS]) -> [T; PARAMETERS] {
        (0..PARAMETERS).filter(|j| self.is_fixed(*j)).for_each(|j| z[j] = T::ONE);
        z
    }

    /// How many periods were left out: what is no number, and spikes.
    pub fn left_out(&self) -> u32 {
        self.left_out
    }

    /// Whether the last blocks excite the parameters.
    pub fn is_excited(&self) -> bool {
        self.gate.is_open()
    }

    /// An upper triangular `W` whose `W W'` is the covariance of the parameters, SI, without the bias by noise.
    pub fn root(&self) -> [[T; PARAMETERS]; PARAMETERS] {
        let (mut w, deviation) = (self.with_priors().inverse(), self.variance().sqrt());
        for (row, nominal) in w.iter_mut().zip(self.settings.nominal) {
            row.iter_mut().for_each(|value| *value = *value * deviation * nominal);
        }
        w
    }

    /// Values and standard errors. An error of 1e9 times the nominal value means that nothing is known yet.
    ///
    /// A standard error has two parts. The first is the residual's, `s² (R'R - N)^-1`; it is too large, because the errors of successive
    /// blocks cancel each other. `N` is twice the part `C` of the squared coefficients that the noise of the currents explains: a direction
    /// that is excited by no more than noise is known to ten nominal values only. The second is the bias by that noise, `-(R'R)^-1 C z`.
    /// The noise is taken as large as it can be: as if all of the residual came from it.
    pub fn estimate(&self) -> Estimate<T> {
        let root = self.with_priors();
        let (z, inverse) = (self.with_fixed(root.solve()), root.inverse());
        let variance = self.variance();
        let of_residual = (0..PARAMETERS).fold(T::ZERO, |sum, j| sum + self.by_noise[j] * z[j] * z[j]);
        // Two equations a block: their residuals together are the noise times this sum.
        let noise = if of_residual > T::ZERO { T::of(2.0) * variance * self.weight / of_residual } else { T::ZERO };
        let pulled = [0, 1, 2, 3].map(|j| noise * self.by_noise[j] * z[j]);
        let mut through = [T::ZERO; PARAMETERS];
        for (column, value) in through.iter_mut().enumerate() {
            *value = (0..=column).fold(T::ZERO, |sum, j| sum + inverse[j][column] * pulled[j]);
        }
        let nominal = &self.settings.nominal;
        let mut estimate = Estimate { value: [T::ZERO; PARAMETERS], standard_error: [T::ZERO; PARAMETERS] };
        let signal = self.signal_part(&inverse, noise, variance);
        for j in 0..PARAMETERS {
            let along = solve_lower(&signal, &inverse[j]);
            let squares = along.iter().fold(T::ZERO, |sum, part| sum + *part * *part);
            let bias = (j..PARAMETERS).fold(T::ZERO, |sum, k| sum + inverse[j][k] * through[k]);
            estimate.value[j] = z[j] * nominal[j];
            let error = if self.freedom < T::of(FEWEST) && self.settings.known[j].is_none() {
                T::of(UNKNOWN)
            } else {
                (variance * squares + bias * bias).sqrt().smaller(T::of(UNKNOWN))
            };
            estimate.standard_error[j] = if self.is_fixed(j) { T::ZERO } else { error * nominal[j] };
        }
        estimate
    }

    /// The lower triangular root of the part of the equations' information that is no noise, in units of all of it: of `I - W' N W`, given
    /// `W = R^-1`. A direction without such a part has the little that is known of every motor, and tells nothing of the others.
    fn signal_part(&self, inverse: &[[T; PARAMETERS]; PARAMETERS], noise: T, variance: T) -> [[T; PARAMETERS]; PARAMETERS] {
        let mut root = [[T::ZERO; PARAMETERS]; PARAMETERS];
        let mut is_noise = [false; PARAMETERS];
        let free = |j: &usize| !self.is_fixed(*j);
        for row in 0..PARAMETERS {
            for column in 0..=row {
                let of_noise =
                    (0..PARAMETERS).filter(free).fold(T::ZERO, |sum, j| sum + self.by_noise[j] * inverse[j][row] * inverse[j][column]);
                let whole = if row == column { T::ONE } else { T::ZERO };
                let before = (0..column).fold(T::ZERO, |sum, k| sum + root[row][k] * root[column][k]);
                let left = whole - T::of(NOISE_COUNTS) * noise * of_noise - before;
                if row == column {
                    let squares = (0..PARAMETERS).filter(free).fold(T::ZERO, |sum, j| sum + inverse[j][row] * inverse[j][row]);
                    let least = (variance * squares * T::of(1.0 / (UNDETERMINED * UNDETERMINED))).smaller(T::ONE);
                    is_noise[row] = left <= least;
                    root[row][row] = left.larger(least).sqrt();
                } else if !is_noise[column] {
                    root[row][column] = left / root[column][column];
                }
            }
        }
        root
    }
}

/// `x` of `L x = y` with a lower triangular `L`.
fn solve_lower<T: Real>(root: &[[T; PARAMETERS]; PARAMETERS], y: &[T; PARAMETERS]) -> [T; PARAMETERS] {
    let mut x = *y;
    for row in 0..PARAMETERS {
        for column in 0..row {
            x[row] -= root[row][column] * x[column];
        }
        x[row] = x[row] / root[row][row];
    }
    x
}

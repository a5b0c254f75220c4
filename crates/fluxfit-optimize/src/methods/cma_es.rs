//! CMA-ES: the evolution strategy with covariance matrix adaptation.
//!
//! Idea: samples of a normal distribution; its mean moves to the weighted mean of the better half, its covariance learns from the steps
//! that led there, its size from the length of a path of such steps.
//!
//! ```text
//! sample   x = m + sigma y,  y = C^(1/2) z,  z ~ N(0, 1);  in the unit box; outside drawn again up to 100 times, then clamped
//! mean     m' = m + sigma <y>_w                      <.>_w the weighted mean of the better half
//! path     p_s = (1 - c_s) p_s + sqrt(c_s (2 - c_s) mu_w) C^(-1/2) <y>_w
//!          p_c = (1 - c_c) p_c + h sqrt(c_c (2 - c_c) mu_w) <y>_w
//!          h = 1 if |p_s| < (1.4 + 2/(D+1)) E|N| sqrt(1 - (1 - c_s)^(2 generations)), else 0
//! shape    C' = (1 - c_1 - c_mu + (1-h) c_1 c_c (2-c_c)) C + c_1 p_c p_c' + c_mu <y y'>_w
//! size     sigma' = sigma exp((c_s / d_s) (|p_s| / E|N| - 1))
//! ```
//!
//! N. Hansen, "The CMA evolution strategy: a tutorial", 2016, arXiv:1604.00772, table 1, without negative weights. The symmetric square
//! root of C takes the place of its factor B D: the distribution is the same, and no sign of an eigenvector matters. The mean starts
//! uniform in the box, sigma at 0.3 of its width; a generation has 4 + floor(3 ln D) samples. The population asked for sets the number of
//! evaluations only.
//!
//! When to use it: first, of all searches; it has no bias towards any point of the box, nor towards its axes.

use crate::{
    bounds::Bounds,
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
};
use nalgebra::{DMatrix, SymmetricEigen};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// `sigma` of the start: the distribution reaches over the box.
const FIRST_SIZE: f64 = 0.3;

/// How often a sample outside the box is drawn again.
const REDRAWS: usize = 100;

/// Smallest eigenvalue of C, as a part of the largest: below, it is rounding.
const SMALLEST_EIGENVALUE: f64 = 1e-16;

/// Steps of the eigenvalue iteration; a few per dimension are usual.
const EIGENVALUE_STEPS: usize = 10_000;

/// Settings of CMA-ES: none, all of them follow from the dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct CmaEs {}

impl CmaEs {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self {};

    /// Samples of a generation.
    pub(crate) fn samples(dimension: usize) -> usize {
        4 + (3.0 * (dimension as f64).ln()).floor() as usize
    }
}

/// The distribution, in the unit box.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Distribution {
    mean: Vec<f64>,
    pub(crate) sigma: f64,
    /// C, C^(1/2) and C^(-1/2), row after row.
    covariance: Vec<f64>,
    root: Vec<f64>,
    inverse_root: Vec<f64>,
    path_size: Vec<f64>,
    path_shape: Vec<f64>,
    pub(crate) generations: u32,
    /// The `y` of the samples.
    steps: Vec<f64>,
}

impl Distribution {
    /// Draws the mean.
    pub(crate) fn new(dimension: usize, draws: &mut Draws) -> Self {
        let identity = DMatrix::<f64>::identity(dimension, dimension).as_slice().to_vec();
        Self {
            mean: (0..dimension).map(|_| draws.uniform()).collect(),
            sigma: FIRST_SIZE,
            covariance: identity.clone(),
            root: identity.clone(),
            inverse_root: identity,
            path_size: vec![0.0; dimension],
            path_shape: vec![0.0; dimension],
            generations: 0,
            steps: Vec::new(),
        }
    }

    /// Draws samples: one after the other, one normal number per component, as often as it takes. Returns them in the unit box.
    pub(crate) fn sample(&mut self, count: usize, draws: &mut Draws) -> Vec<f64> {
        let d = self.mean.len();
        self.steps.clear();
        let mut samples = Vec::with_capacity(count * d);
        let (mut step, mut normals) = (vec![0.0; d], vec![0.0; d]);
        for _ in 0..count {
            self.draw_step(&mut step, &mut normals, draws);
            for _ in 0..REDRAWS {
                if self.is_inside(&step) {
                    break;
                }
                self.draw_step(&mut step, &mut normals, draws);
            }
            let is_inside = self.is_inside(&step);
            for (y, mean) in step.iter_mut().zip(&self.mean) {
                let x = mean + self.sigma * *y;
                if is_inside {
                    samples.push(x);
                } else {
                    samples.push(x.clamp(0.0, 1.0));
                    *y = (x.clamp(0.0, 1.0) - mean) / self.sigma;
                }
            }
            self.steps.extend(&step);
        }
        samples
    }

    fn draw_step(&self, step: &mut [f64], normals: &mut [f64], draws: &mut Draws) {
        normals.fill_with(|| draws.normal());
        for (y, row) in step.iter_mut().zip(self.root.chunks_exact(self.mean.len())) {
            *y = dot(row, normals);
        }
    }

    fn is_inside(&self, step: &[f64]) -> bool {
        step.iter().zip(&self.mean).all(|(y, mean)| (0.0..=1.0).contains(&(mean + self.sigma * y)))
    }

    /// Learns from the samples, ranked by their costs.
    pub(crate) fn learn(&mut self, ranking: &[usize]) {
        let n = self.mean.len() as f64;
        let steps: Vec<&[f64]> = ranking.iter().filter_map(|&k| self.steps.chunks_exact(self.mean.len()).nth(k)).collect();
        let half = steps.len() / 2;
        let raw: Vec<f64> = (1..=half).map(|rank| ((steps.len() as f64 + 1.0) / 2.0).ln() - (rank as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let mu = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();

        let c_s = (mu + 2.0) / (n + mu + 5.0);
        let d_s = 1.0 + 2.0 * (((mu - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_s;
        let c_c = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu);
        let c_mu = (1.0 - c_1).min(2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0) * (n + 2.0) + mu));
        let length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let mean_step: Vec<f64> = (0..self.mean.len()).map(|d| weights.iter().zip(&steps).map(|(weight, y)| weight * y[d]).sum()).collect();
        self.generations = self.generations.saturating_add(1);
        for (path, row) in self.path_size.iter_mut().zip(self.inverse_root.chunks_exact(mean_step.len())) {
            *path = (1.0 - c_s) * *path + (c_s * (2.0 - c_s) * mu).sqrt() * dot(row, &mean_step);
        }
        let norm = self.path_size.iter().map(|p| p * p).sum::<f64>().sqrt();
        let settled = (1.0 - (1.0 - c_s).powf(2.0 * f64::from(self.generations))).sqrt();
        let is_short = norm < (1.4 + 2.0 / (n + 1.0)) * length * settled;
        let h = if is_short { 1.0 } else { 0.0 };
        for (path, step) in self.path_shape.iter_mut().zip(&mean_step) {
            *path = (1.0 - c_c) * *path + h * (c_c * (2.0 - c_c) * mu).sqrt() * step;
        }
        let kept = 1.0 - c_1 - c_mu + (1.0 - h) * c_1 * c_c * (2.0 - c_c);
        let d = self.mean.len();
        for (row, column) in (0..d).flat_map(|row| (0..=row).map(move |column| (row, column))) {
            let spread: f64 = weights.iter().zip(&steps).map(|(weight, y)| weight * (y[row] * y[column])).sum();
            let shape = self.path_shape[row] * self.path_shape[column];
            let learnt = kept * self.covariance[row * d + column] + c_1 * shape + c_mu * spread;
            (self.covariance[row * d + column], self.covariance[column * d + row]) = (learnt, learnt);
        }
        for (mean, step) in self.mean.iter_mut().zip(&mean_step) {
            *mean += self.sigma * step;
        }
        self.sigma *= ((c_s / d_s) * (norm / length - 1.0)).exp();
        self.decompose();
    }

    /// The square roots of C. A distribution that has lost its shape or size is spread again about its mean.
    fn decompose(&mut self) {
        let d = self.mean.len();
        let is_sound = self.sigma.is_finite() && self.sigma > 0.0 && self.covariance.iter().all(|c| c.is_finite());
        let sound = is_sound.then(|| DMatrix::from_row_slice(d, d, &self.covariance));
        let Some(eigen) = sound.and_then(|matrix| SymmetricEigen::try_new(matrix, f64::EPSILON, EIGENVALUE_STEPS)) else {
            let mean: Vec<f64> = self.mean.iter().map(|mean| if mean.is_finite() { *mean } else { 0.5 }).collect();
            *self = Self { mean, generations: self.generations, ..Self::new(d, &mut Draws::replay(Vec::new())) };
            return;
        };
        let floor = SMALLEST_EIGENVALUE * eigen.eigenvalues.max();
        let roots: Vec<f64> = eigen.eigenvalues.iter().map(|value| value.max(floor).sqrt()).collect();
        for (row, column) in (0..d).flat_map(|row| (0..=row).map(move |column| (row, column))) {
            let (mut root, mut inverse) = (0.0, 0.0);
            for (k, value) in roots.iter().enumerate() {
                let share = eigen.eigenvectors[(row, k)] * eigen.eigenvectors[(column, k)];
                root += share * value;
                inverse += share / value;
            }
            for index in [row * d + column, column * d + row] {
                (self.root[index], self.inverse_root[index]) = (root, inverse);
            }
        }
    }

    /// Whether it is that of this population's box, with a step for each trial, or new.
    pub(crate) fn fits(&self, population: &Population) -> bool {
        let d = population.best().len();
        let vectors = [&self.mean, &self.path_size, &self.path_shape];
        let matrices = [&self.covariance, &self.root, &self.inverse_root];
        vectors.iter().all(|vector| vector.len() == d)
            && matrices.iter().all(|matrix| matrix.len() == d * d)
            && (self.steps.is_empty() || self.steps.len() == population.trial_costs().len() * d)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Positions in the box of samples in the unit box.
pub(crate) fn stretched<'a>(samples: &'a [f64], bounds: &'a Bounds) -> impl Iterator<Item = f64> + 'a {
    samples
        .chunks_exact(bounds.dimension())
        .flat_map(|row| row.iter().zip(bounds.iter()).map(|(x, (lower, upper))| lower + x * (upper - lower)))
}

impl Moves for CmaEs {
    type Memory = Distribution;

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Distribution) {
        let d = setup.bounds.dimension();
        let mut distribution = Distribution::new(d, setup.draws);
        let samples = distribution.sample(Self::samples(d), setup.draws);
        let mut positions: Vec<f64> = stretched(&samples, setup.bounds).collect();
        positions.chunks_exact_mut(d).for_each(|position| setup.bounds.clamp(position));
        (positions, distribution)
    }

    fn begin(&self, distribution: &mut Distribution, generation: &mut Generation) {
        distribution.learn(&generation.population.ranking());
    }

    fn propose(&self, distribution: &mut Distribution, generation: &mut Generation) {
        let samples = distribution.sample(Self::samples(generation.bounds.dimension()), generation.draws);
        generation.try_these(&stretched(&samples, generation.bounds).collect::<Vec<f64>>());
    }

    fn accept(&self, distribution: &mut Distribution, generation: &mut Generation) {
        generation.population.replace();
        distribution.learn(&generation.population.ranking());
    }

    fn fits(distribution: &Distribution, population: &Population) -> bool {
        distribution.fits(population)
    }
}

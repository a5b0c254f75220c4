//! The 24 noiseless functions of BBOB, the usual benchmark of searches without derivatives, from their public definitions: N. Hansen,
//! S. Finck, R. Ros and A. Auger, "Real-parameter black-box optimization benchmarking 2009: noiseless functions definitions", INRIA
//! RR-6829. `oracles/bbob.py` writes the values of the COCO platform that the test holds them against.
//!
//! Symbols as there: `z` the transformed place, `R` and `Q` rotations, `Lambda` a diagonal matrix, `f_pen` the squared excess over the box.

mod function;
mod gallagher;
mod random;
mod shape;

use fluxfit::optimizer::{Bounds, Error, Objective};
use gallagher::Peaks;
use nalgebra::DMatrix;
use shape::{HALF_BOX, stretched_rows};

/// Number of functions.
pub const FUNCTIONS: u64 = 24;

/// Seeds of an instance's numbers are its function's number and this many times its own.
const PER_INSTANCE: u64 = 10_000;

/// Seeds of the rotation R are those of Q and this.
const OTHER_ROTATION: u64 = 1_000_000;

/// Largest magnitude of the lowest cost.
const LARGEST_COST: f64 = 1000.0;

/// A function of one dimension and instance.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// 1 to 24.
    pub function: u64,
    /// Which of the function's instances.
    pub instance: u64,
    /// Where the cost is lowest.
    pub optimum: Vec<f64>,
    /// The lowest cost.
    pub lowest: f64,
    /// What turns a place first, and then.
    first: DMatrix<f64>,
    second: DMatrix<f64>,
    /// Of Gallagher's functions, else none.
    peaks: Peaks,
}

/// Two functions take the random numbers of the ones that they are variants of.
fn seed(function: u64, instance: u64) -> u64 {
    let relative = match function {
        4 => 3,
        18 => 17,
        own => own,
    };
    relative + PER_INSTANCE * instance
}

impl Problem {
    /// The function of this number, from 1 to [`FUNCTIONS`]; another number gives the first. At least two dimensions.
    pub fn new(function: u64, dimension: usize, instance: u64) -> Self {
        let seed = seed(function, instance);
        let (r, q) = (random::rotation(dimension, seed + OTHER_ROTATION), random::rotation(dimension, seed));
        let product = |condition: f64| &r * stretched_rows(condition, &q);
        let none = DMatrix::zeros(0, 0);
        let (first, second) = match function {
            6 | 13 => (product(10.0), none),
            7 => (stretched_rows(10.0, &q), r),
            9 | 19 => (q * function::valley_scale(dimension), none),
            10 | 11 | 14 => (r, none),
            12 => (r.clone(), r),
            15 => (r.clone(), product(10.0)),
            16 => (r.clone(), product(0.01)),
            17 => (r, stretched_rows(10.0, &q)),
            18 => (r, stretched_rows(1000.0, &q)),
            23 | 24 => (product(100.0), none),
            21 | 22 => (q, none),
            _ => (none.clone(), none),
        };
        let peaks = match function {
            21 => Peaks::many(&first, seed),
            22 => Peaks::few(&first, seed),
            _ => Peaks::default(),
        };
        let mut problem = Self { function, instance, optimum: Vec::new(), lowest: lowest_cost(seed), first, second, peaks };
        problem.optimum = problem.place_of_optimum(dimension, seed);
        problem
    }

    fn place_of_optimum(&self, dimension: usize, seed: u64) -> Vec<f64> {
        // In -4..4, of four digits, never zero.
        let drawn = |seed: u64| -> Vec<f64> {
            let places = random::uniform(dimension, seed).into_iter().map(|r| 8.0 * (1e4 * r).floor() / 1e4 - 4.0);
            places.map(|x| if x == 0.0 { -1e-5 } else { x }).collect()
        };
        let mut place = drawn(seed);
        match self.function {
            4 => place.iter_mut().step_by(2).for_each(|x| *x = x.abs()),
            5 => place.iter_mut().for_each(|x| *x = HALF_BOX.copysign(*x)),
            8 => place.iter_mut().for_each(|x| *x *= 0.75),
            // R (x + 1/2) is one in every coordinate.
            9 | 19 => {
                let scale = function::valley_scale(dimension);
                place = self.first.tr_mul(&nalgebra::DVector::from_element(dimension, 0.5 / (scale * scale))).as_slice().to_vec();
            }
            12 => place = drawn(seed + OTHER_ROTATION),
            20 => {
                let signs = random::uniform(dimension, seed).into_iter().map(|r| if r < 0.5 { -1.0 } else { 1.0 });
                place = signs.map(|sign: f64| sign * function::SCHWEFEL_OPTIMUM / 2.0).collect();
            }
            21 | 22 => place = self.peaks.optimum.clone(),
            24 => {
                let signs = random::normal(dimension, seed).into_iter().map(f64::signum);
                place = signs.map(|sign| sign * function::LUNACEK_FUNNEL / 2.0).collect();
            }
            _ => {}
        }
        place
    }

    /// The box that searches begin in.
    ///
    /// # Errors
    /// None: the box is sound.
    pub fn bounds(&self) -> Result<Bounds, Error> {
        Bounds::new(vec![-HALF_BOX; self.dimension()], vec![HALF_BOX; self.dimension()])
    }

    /// The cost.
    pub fn cost(&self, x: &[f64]) -> f64 {
        self.above_lowest(x) + self.lowest
    }
}

/// A Cauchy number of two digits.
fn lowest_cost(seed: u64) -> f64 {
    let [numerator, denominator] = [seed, seed + 1].map(|seed| random::normal(1, seed)[0]);
    ((100.0 * (100.0 * numerator / denominator) + 0.5).floor() / 100.0).clamp(-LARGEST_COST, LARGEST_COST)
}

/// The cost above the lowest one: errors far below the rounding of the cost remain visible.
impl Objective for Problem {
    fn dimension(&self) -> usize {
        self.optimum.len()
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        for (candidate, cost) in candidates.chunks_exact(self.dimension()).zip(costs) {
            *cost = self.above_lowest(candidate);
        }
    }
}

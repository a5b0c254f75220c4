//! The random numbers that make an instance of a BBOB function: they are part of its definition, so that everyone has the same instances.
//!
//! Uniform numbers: S. K. Park and K. W. Miller's minimal standard generator (Communications of the ACM 31 (1988) 1192, its products by L.
//! Schrage's method) behind the shuffling table of C. Bays and S. D. Durham (ACM Transactions on Mathematical Software 2 (1976) 59).

use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// Modulus, multiplier, and the quotient and remainder of the former by the latter: Park and Miller.
const MODULUS: i64 = 2_147_483_647;
const MULTIPLIER: i64 = 16_807;
const QUOTIENT: i64 = 127_773;
const REMAINDER: i64 = 2_836;

/// Rows of the shuffling table.
const TABLE: usize = 32;

/// Numbers thrown away before the table is filled.
const THROWN_AWAY: usize = 8;

/// A number of the generator divided by this is a place of the table.
const PER_PLACE: i64 = 1 + MODULUS / TABLE as i64;

/// What stands in place of a zero, whose logarithm is infinite.
const TINY: f64 = 1e-99;

fn next(state: i64) -> i64 {
    let high = state / QUOTIENT;
    let next = MULTIPLIER * (state - high * QUOTIENT) - REMAINDER * high;
    if next < 0 { next + MODULUS } else { next }
}

/// Numbers between 0 and 1.
pub(super) fn uniform(count: usize, seed: u64) -> Vec<f64> {
    // Seeds are a function's number and 10 000 times an instance's: far below the largest integer.
    let mut state = (seed as i64).max(1);
    let mut draw = || {
        state = next(state);
        state
    };
    for _ in 0..THROWN_AWAY {
        draw();
    }
    // The table is filled from its end.
    let mut table = [0; TABLE];
    table.iter_mut().rev().for_each(|place| *place = draw());
    let mut shown = table[0];
    let numbers = (0..count).map(|_| {
        let place = &mut table[(shown / PER_PLACE) as usize];
        shown = std::mem::replace(place, draw());
        (shown as f64 / MODULUS as f64).max(TINY)
    });
    numbers.collect()
}

/// Normal numbers, by Box and Muller's formula.
pub(super) fn normal(count: usize, seed: u64) -> Vec<f64> {
    let numbers = uniform(2 * count, seed);
    let of = |k: usize| (-2.0 * numbers[k].ln()).sqrt() * (TAU * numbers[count + k]).cos();
    (0..count).map(|k| if of(k) == 0.0 { TINY } else { of(k) }).collect()
}

/// A rotation: normal numbers whose columns are made orthonormal, one after the other.
pub(super) fn rotation(dimension: usize, seed: u64) -> DMatrix<f64> {
    let mut matrix = DMatrix::from_vec(dimension, dimension, normal(dimension * dimension, seed));
    for column in 0..dimension {
        for before in 0..column {
            let other = matrix.column(before).clone_owned();
            let along = matrix.column(column).dot(&other);
            matrix.column_mut(column).axpy(-along, &other, 1.0);
        }
        let length = matrix.column(column).norm();
        matrix.column_mut(column).unscale_mut(length);
    }
    matrix
}

/// The places of ascending numbers.
pub(super) fn ascending(numbers: &[f64]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..numbers.len()).collect();
    places.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
    places
}

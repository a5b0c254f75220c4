//! The formulas.

use super::{
    Problem,
    shape::{all_oscillated, asymmetric, ellipsoid, lambda, oscillated, outside, part, rastrigin, stretched, turned, valley},
};
use std::f64::consts::{PI, TAU};

/// Twice the magnitude of the optimum's coordinates in Schwefel's function: the highest of `x sin(sqrt(100 x))`.
pub(super) const SCHWEFEL_OPTIMUM: f64 = 4.2096874637;

/// The optimum's height in Schwefel's function.
const SCHWEFEL_HEIGHT: f64 = 4.189828872724339;

/// Centre of the funnel that holds the optimum of Lunacek's function.
pub(super) const LUNACEK_FUNNEL: f64 = 2.5;

/// Terms of the sums in Weierstrass's and Katsuura's functions.
const WEIERSTRASS_TERMS: i32 = 12;
const KATSUURA_TERMS: i32 = 32;

/// Scale of Rosenbrock's valley.
pub(super) fn valley_scale(dimension: usize) -> f64 {
    ((dimension as f64).sqrt() / 8.0).max(1.0)
}

impl Problem {
    /// The cost above the lowest one.
    pub(super) fn above_lowest(&self, x: &[f64]) -> f64 {
        let from_optimum: Vec<f64> = x.iter().zip(&self.optimum).map(|(x, best)| x - best).collect();
        let (d, n) = (x.len(), x.len() as f64);
        let (first, second) = (&self.first, &self.second);
        match self.function {
            // Separable.
            2 => ellipsoid(&all_oscillated(&from_optimum), 1e6),
            3 => rastrigin(&stretched(&asymmetric(&all_oscillated(&from_optimum), 0.2), 10.0)),
            4 => rastrigin(&buche(&from_optimum)) + 100.0 * outside(x),
            5 => self.slope(x),
            // Of low or moderate condition.
            6 => self.sector(&turned(first, &from_optimum)),
            7 => self.steps(&from_optimum) + outside(x),
            8 => {
                let scale = valley_scale(d);
                valley(&from_optimum.iter().map(|z| scale * z + 1.0).collect::<Vec<_>>()).sum()
            }
            9 => valley(&self.turned_valley(x)).sum(),
            // Of high condition, with one minimum.
            10 => ellipsoid(&all_oscillated(&turned(first, &from_optimum)), 1e6),
            11 => {
                let z = all_oscillated(&turned(first, &from_optimum));
                1e6 * z[0] * z[0] + squares(&z[1..])
            }
            12 => {
                let z = turned(second, &asymmetric(&turned(first, &from_optimum), 0.5));
                z[0] * z[0] + 1e6 * squares(&z[1..])
            }
            13 => {
                let z = turned(first, &from_optimum);
                z[0] * z[0] + 100.0 * squares(&z[1..]).sqrt()
            }
            14 => {
                let z = turned(first, &from_optimum);
                z.iter().enumerate().map(|(k, z)| z.abs().powf(2.0 + 4.0 * part(k, d))).sum::<f64>().sqrt()
            }
            // With many minima and a global structure.
            15 => rastrigin(&turned(second, &asymmetric(&all_oscillated(&turned(first, &from_optimum)), 0.2))),
            16 => weierstrass(&turned(second, &all_oscillated(&turned(first, &from_optimum)))) + 10.0 / n * outside(x),
            17 | 18 => schaffers(&turned(second, &asymmetric(&turned(first, &from_optimum), 0.5))) + 10.0 * outside(x),
            19 => {
                let z = self.turned_valley(x);
                let terms = valley(&z).map(|s| s / 4000.0 - s.cos());
                10.0 / (n - 1.0) * terms.sum::<f64>() + 10.0
            }
            // With many minima and a weak structure.
            20 => self.schwefel(x),
            21 | 22 => {
                let height = oscillated(10.0 - self.peaks.highest(&turned(first, x)));
                height * height + outside(x)
            }
            23 => katsuura(&turned(first, &from_optimum)) + outside(x),
            24 => self.lunacek(x),
            _ => squares(&from_optimum),
        }
    }

    /// A plane that falls to a corner of the box.
    fn slope(&self, x: &[f64]) -> f64 {
        let terms = x.iter().zip(&self.optimum).enumerate().map(|(k, (x, best))| {
            let steepness = lambda(k, self.optimum.len(), 100.0);
            let towards = if x * best < best * best { x * best.signum() } else { best.abs() };
            steepness * (best.abs() - towards)
        });
        terms.sum()
    }

    /// One orthant is a hundred times flatter than the others.
    fn sector(&self, z: &[f64]) -> f64 {
        let steep = |(z, best): (&f64, &f64)| if z * best > 0.0 { 1e4 * z * z } else { z * z };
        oscillated(z.iter().zip(&self.optimum).map(steep).sum()).powf(0.9)
    }

    /// An ellipsoid of plateaus.
    fn steps(&self, from_optimum: &[f64]) -> f64 {
        let place = turned(&self.first, from_optimum);
        let step = |z: &f64| if z.abs() > 0.5 { (z + 0.5).floor() } else { (10.0 * z + 0.5).floor() / 10.0 };
        let z = turned(&self.second, &place.iter().map(step).collect::<Vec<_>>());
        0.1 * ellipsoid(&z, 100.0).max(place[0].abs() / 1e4)
    }

    fn turned_valley(&self, x: &[f64]) -> Vec<f64> {
        turned(&self.first, x).into_iter().map(|z| z + 0.5).collect()
    }

    /// Deep minima far from each other.
    fn schwefel(&self, x: &[f64]) -> f64 {
        let magnitude = SCHWEFEL_OPTIMUM;
        let doubled: Vec<f64> = x.iter().zip(&self.optimum).map(|(x, best)| 2.0 * best.signum() * x).collect();
        let before = |k: usize| if k == 0 { 0.0 } else { 0.25 * (doubled[k - 1] - magnitude) };
        let hats: Vec<f64> = doubled.iter().enumerate().map(|(k, hat)| hat + before(k) - magnitude).collect();
        let z: Vec<f64> = stretched(&hats, 10.0).into_iter().map(|z| 100.0 * (z + magnitude)).collect();
        let wave: f64 = z.iter().map(|z| z * z.abs().sqrt().sin()).sum();
        let hundredth: Vec<f64> = z.iter().map(|z| z / 100.0).collect();
        SCHWEFEL_HEIGHT - wave / (100.0 * x.len() as f64) + 100.0 * outside(&hundredth)
    }

    /// Two funnels, and Rastrigin's cosines upon them.
    fn lunacek(&self, x: &[f64]) -> f64 {
        let n = x.len() as f64;
        let s = 1.0 - 1.0 / (2.0 * (n + 20.0).sqrt() - 8.2);
        let other = -((LUNACEK_FUNNEL * LUNACEK_FUNNEL - 1.0) / s).sqrt();
        let hats: Vec<f64> = x.iter().zip(&self.optimum).map(|(x, best)| 2.0 * best.signum() * x).collect();
        let from = |centre: f64| hats.iter().map(|hat| hat - centre).collect::<Vec<f64>>();
        let inside = from(LUNACEK_FUNNEL);
        let funnels = squares(&inside).min(n + s * squares(&from(other)));
        let cosines: f64 = turned(&self.first, &inside).iter().map(|z| 10.0 * (1.0 - (TAU * z).cos())).sum();
        funnels + cosines + 1e4 * outside(x)
    }
}

fn squares(z: &[f64]) -> f64 {
    z.iter().map(|z| z * z).sum()
}

/// Büche's transformation: every other coordinate is ten times steeper on its positive side.
fn buche(from_optimum: &[f64]) -> Vec<f64> {
    let steeper = |(k, z): (usize, &f64)| if k % 2 == 0 && *z > 0.0 { 10.0 * z } else { *z };
    stretched(&all_oscillated(from_optimum).iter().enumerate().map(steeper).collect::<Vec<_>>(), 10.0)
}

fn weierstrass(z: &[f64]) -> f64 {
    let sum = |z: f64| -> f64 { (0..WEIERSTRASS_TERMS).map(|k| 0.5_f64.powi(k) * (TAU * 3_f64.powi(k) * (z + 0.5)).cos()).sum() };
    let least: f64 = (0..WEIERSTRASS_TERMS).map(|k| 0.5_f64.powi(k) * (PI * 3_f64.powi(k)).cos()).sum();
    10.0 * (z.iter().map(|z| sum(*z)).sum::<f64>() / z.len() as f64 - least).powi(3)
}

fn schaffers(z: &[f64]) -> f64 {
    let waves = z.windows(2).map(|pair| {
        let s = pair[0].hypot(pair[1]);
        s.sqrt() * (1.0 + (50.0 * s.powf(0.2)).sin().powi(2))
    });
    (waves.sum::<f64>() / (z.len() as f64 - 1.0)).powi(2)
}

fn katsuura(z: &[f64]) -> f64 {
    let n = z.len() as f64;
    let rough = |z: f64| -> f64 {
        let terms = (1..=KATSUURA_TERMS).map(|j| {
            let fine = 2_f64.powi(j);
            (fine * z - (fine * z).round()).abs() / fine
        });
        terms.sum()
    };
    let product: f64 = z.iter().enumerate().map(|(k, z)| (1.0 + (k as f64 + 1.0) * rough(*z)).powf(10.0 / n.powf(1.2))).product();
    10.0 / (n * n) * (product - 1.0)
}

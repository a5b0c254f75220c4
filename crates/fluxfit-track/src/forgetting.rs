//! Block least squares with the kinds of forgetting of the literature.
//!
//! When to use it: for comparison. Exponential forgetting runs away without excitation; the others lag a slow drift.
//!
//! - Fortescue, Kershenbaum and Ydstie (1981, doi 10.1016/0005-1098(81)90070-4): `lambda = 1 - e²/((1 + q) s² N0)`.
//! - Fuzzy, after the idea of the paper's reference 8: four rules on `|e|/s` and its change, as a Sugeno mean.
//! - Directional (Kulhavy 1987, doi 10.1016/0005-1098(87)90054-9): only in the direction of the row.

use crate::estimate::Estimate;
use fluxfit::motor::PARAMETERS;
use fluxfit_core::{
    Period,
    block::Block,
    square_root::{Row, SquareRoot},
};
use serde::{Deserialize, Serialize};

/// Periods of a block.
const PERIODS: u32 = 50;

/// Variance of the scaled parameters at the start, in V² of noise.
const START: f64 = 100.0;

/// Memory of Fortescue's kind, in rows: 100 blocks.
const MEMORY: f64 = 200.0;

/// Least weight that Fortescue's kind leaves.
const LEAST: f64 = 0.9;

/// Part by which the mean squared residual follows per row.
const FOLLOWED: f64 = 5e-3;

/// Weights that the fuzzy rules leave, for a small or large residual (first) and a small or large change of it (second).
const RULES: [[f64; 2]; 2] = [[0.9998, 0.998], [0.99, 0.97]];

/// Weight that the directional kind leaves.
const DIRECTIONAL: f64 = 0.99;

/// The kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// By the information in the residual.
    Fortescue,
    /// By fuzzy rules.
    Fuzzy,
    /// Only in the direction of the row.
    Directional,
}

/// The estimator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forgetting {
    kind: Kind,
    nominal: [f64; PARAMETERS],
    block: Option<Block<f64>>,
    /// Of the kinds that weigh all rows.
    root: SquareRoot<f64>,
    /// Of the directional kind.
    p: [[f64; PARAMETERS]; PARAMETERS],
    z: [f64; PARAMETERS],
    /// Mean squared residual, V², and the last residual in its root.
    residual: f64,
    last: f64,
    rows: u32,
}

impl Forgetting {
    /// Begins with these values.
    pub fn new(kind: Kind, nominal: [f64; PARAMETERS]) -> Self {
        let p = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { START } else { 0.0 }));
        let root = SquareRoot::new(START.sqrt().recip());
        Self { kind, nominal, block: None, root, p, z: [1.0; PARAMETERS], residual: 0.0, last: 0.0, rows: 0 }
    }

    /// Begins at a current, A.
    pub fn begin(&mut self, i: [f64; 2]) {
        self.block = Some(Block::new(PERIODS, i));
    }

    /// Goes on by a period to a current, A.
    pub fn advance(&mut self, period: &Period<f64>, i: [f64; 2]) {
        let Some(equations) = self.block.as_mut().and_then(|block| block.add(period, i, &self.nominal)) else { return };
        for (axis, row) in equations.rows.iter().enumerate() {
            self.take(row, axis == 0);
        }
    }

    fn take(&mut self, row: &Row<f64>, forgets: bool) {
        let error = row.y - self.z.iter().zip(&row.phi).map(|(z, phi)| z * phi).sum::<f64>();
        let leverage = match self.kind {
            Kind::Directional => self.p_phi(row).iter().zip(&row.phi).map(|(a, b)| a * b).sum(),
            Kind::Fortescue | Kind::Fuzzy => self.root.leverage(&row.phi),
        };
        // The first rows fit anyhow.
        let share = 1.0 / (1.0 + leverage);
        self.rows = self.rows.saturating_add(1);
        let part = (1.0 / f64::from(self.rows)).max(FOLLOWED);
        self.residual += part * (error * error * share - self.residual);
        let deviation = self.residual.sqrt().max(f64::MIN_POSITIVE);
        let size = error.abs() / deviation;
        let change = (size - self.last).abs();
        self.last = size;
        match self.kind {
            Kind::Directional => self.take_directional(row, error, leverage),
            Kind::Fortescue | Kind::Fuzzy => {
                if forgets {
                    self.root.weigh(self.keeps(size, change, share));
                }
                self.root.add(row);
                self.z = self.root.solve();
            }
        }
    }

    fn keeps(&self, size: f64, change: f64, share: f64) -> f64 {
        match self.kind {
            Kind::Fortescue => (1.0 - size * size * share / MEMORY).clamp(LEAST, 1.0),
            Kind::Fuzzy | Kind::Directional => {
                let large = |value: f64| ((value - 1.0) / 3.0).clamp(0.0, 1.0);
                let (a, b) = (large(size), large(change));
                (1.0 - a) * ((1.0 - b) * RULES[0][0] + b * RULES[0][1]) + a * ((1.0 - b) * RULES[1][0] + b * RULES[1][1])
            }
        }
    }

    fn p_phi(&self, row: &Row<f64>) -> [f64; PARAMETERS] {
        self.p.map(|p| p.iter().zip(&row.phi).map(|(p, phi)| p * phi).sum())
    }

    fn take_directional(&mut self, row: &Row<f64>, error: f64, leverage: f64) {
        if leverage <= 0.0 {
            return;
        }
        let p_phi = self.p_phi(row);
        let beta = DIRECTIONAL - (1.0 - DIRECTIONAL) / leverage;
        let denominator = 1.0 / beta + leverage;
        for i in 0..PARAMETERS {
            self.z[i] += p_phi[i] * error / (1.0 + leverage);
        }
        for i in 0..PARAMETERS {
            for j in i..PARAMETERS {
                let value = self.p[i][j] - p_phi[i] * p_phi[j] / denominator;
                (self.p[i][j], self.p[j][i]) = (value, value);
            }
        }
    }

    /// The values; a covariance of these kinds would not be that of their error.
    pub fn estimate(&self) -> Estimate {
        Estimate::without_covariance(std::array::from_fn(|j| self.z[j] * self.nominal[j]))
    }
}

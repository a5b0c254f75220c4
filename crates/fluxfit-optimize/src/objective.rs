//! What is minimized.

/// A function to minimize.
pub trait Objective: Sync {
    /// Length of a candidate; at least 1.
    fn dimension(&self) -> usize;

    /// The costs of many candidates. `candidates` holds them row after row, `costs.len()` rows of [`dimension`](Self::dimension) numbers.
    /// A cost that is not finite counts as worse than any finite one.
    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]);
}

/// An objective from a function of one candidate.
pub fn objective_from<F: Fn(&[f64]) -> f64 + Sync>(dimension: usize, cost: F) -> impl Objective {
    Pointwise { dimension, cost }
}

struct Pointwise<F> {
    dimension: usize,
    cost: F,
}

impl<F: Fn(&[f64]) -> f64 + Sync> Objective for Pointwise<F> {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        // Rows of zero numbers cannot be cut; no box has that dimension.
        for (candidate, cost) in candidates.chunks_exact(self.dimension.max(1)).zip(costs) {
            *cost = (self.cost)(candidate);
        }
    }
}

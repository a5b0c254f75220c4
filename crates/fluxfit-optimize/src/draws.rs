//! Where every random number comes from.
//!
//! One named, portable generator (ChaCha with 8 rounds) with one stream per run: a run's numbers depend on its seed and its
//! stream alone, never on which thread it ran or what ran before. A recorded list can take the generator's place, so that an
//! independent program fed the same numbers can check a step.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal, StudentT};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A source of random numbers.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Draws(Source);

#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
// One Draws per optimizer: the size of the generator does not matter, an indirection at every draw would.
#[allow(clippy::large_enum_variant)]
enum Source {
    Generator(ChaCha8Rng),
    Recorded(VecDeque<f64>),
}

impl Draws {
    /// The stream number `stream` of the generator seeded with `seed`.
    pub fn seeded(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(Source::Generator(generator))
    }

    /// Numbers written down beforehand, each returned as it stands whatever distribution is asked for (a partner as its index),
    /// from the front again after the last: an independent program, fed the same numbers, can check every step.
    pub fn replay(numbers: Vec<f64>) -> Self {
        Self(Source::Recorded(numbers.into()))
    }

    /// Uniform on [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.draw(|generator| generator.random())
    }

    /// As many numbers uniform on [0, 1), one after the other: cheaper than one by one.
    pub(crate) fn uniforms<const K: usize>(&mut self) -> [f64; K] {
        match &mut self.0 {
            Source::Generator(generator) => std::array::from_fn(|_| generator.random()),
            Source::Recorded(numbers) => std::array::from_fn(|_| next(numbers)),
        }
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        self.draw(|generator| generator.sample(StandardNormal))
    }

    /// Student's t with `degrees` degrees of freedom; zero if there are none.
    pub fn student_t(&mut self, degrees: usize) -> f64 {
        self.draw(|generator| StudentT::new(degrees as f64).map_or(0.0, |t| t.sample(generator)))
    }

    /// `K` indices below `population`, different from each other and from `i`, as far as there are so many: in a population of `K` or
    /// fewer, which no method starts, some repeat.
    pub(crate) fn partners<const K: usize>(&mut self, i: usize, population: usize) -> [usize; K] {
        let mut partners = [0; K];
        for chosen in 0..K {
            let left = population.saturating_sub(1 + chosen).max(1);
            let index = match &mut self.0 {
                Source::Recorded(_) => self.uniform() as usize,
                Source::Generator(generator) => {
                    // An index among those left, moved past each taken one that lies below or at it, smallest first.
                    let mut index = generator.random_range(0..left);
                    let mut taken = [i; K];
                    taken[1..=chosen.min(K - 1)].copy_from_slice(&partners[..chosen.min(K - 1)]);
                    let taken = &mut taken[..=chosen];
                    taken.sort_unstable();
                    for other in taken.iter() {
                        index += usize::from(index >= *other);
                    }
                    index
                }
            };
            partners[chosen] = index.min(population.saturating_sub(1));
        }
        partners
    }

    /// An index below `count`, each as likely; 0 if there is none.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        let index = self.draw(|generator| generator.random_range(0..count.max(1)) as f64) as usize;
        index.min(count.saturating_sub(1))
    }

    /// The indices below `count`, in any order, each as likely.
    pub(crate) fn permutation(&mut self, count: usize) -> Vec<usize> {
        if matches!(self.0, Source::Recorded(_)) {
            return (0..count).map(|_| self.index(count)).collect();
        }
        let mut order: Vec<usize> = (0..count).collect();
        for left in (1..count).rev() {
            order.swap(left, self.index(left + 1));
        }
        order
    }

    /// -1 or 1.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.uniform() < 0.5 { 1.0 } else { -1.0 }
    }

    fn draw(&mut self, from: impl FnOnce(&mut ChaCha8Rng) -> f64) -> f64 {
        match &mut self.0 {
            Source::Generator(generator) => from(generator),
            Source::Recorded(numbers) => next(numbers),
        }
    }
}

/// The next number of a record; cold, so that a draw from the generator stays small enough to be inlined.
#[cold]
fn next(numbers: &mut VecDeque<f64>) -> f64 {
    numbers.rotate_left(usize::from(!numbers.is_empty()));
    numbers.back().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn partners_are_uniform_over_the_others() {
        let mut draws = Draws::seeded(3, 0);
        let mut counts = [[0u32; 6]; 3];
        for _ in 0..60_000 {
            for (count, j) in counts.iter_mut().zip(draws.partners::<3>(2, 6)) {
                count[j] += 1;
            }
        }
        for count in counts {
            assert_eq!(count[2], 0);
            // Each of the five others 12000 times, binomial, 5 sigma = 490.
            assert!(count.iter().enumerate().all(|(j, n)| j == 2 || n.abs_diff(12_000) < 490), "{count:?}");
        }
    }

    #[test]
    fn streams_of_one_seed_differ_and_repeat() {
        let first = |stream| Draws::seeded(1, stream).uniform();
        assert_eq!(first(0), first(0));
        assert_ne!(first(0), first(1));
    }

    #[test]
    fn partners_exist_in_a_population_that_is_too_small() {
        for population in 0..4 {
            for mut draws in [Draws::seeded(1, 0), Draws::replay(vec![7.0])] {
                assert!(draws.partners::<3>(0, population).iter().all(|j| *j < population.max(1)));
            }
        }
    }

    proptest! {
        #[test]
        fn partners_differ_from_each_other_and_from_the_flower(seed: u64, population in 4usize..60, of in 0usize..60) {
            let i = of % population;
            let [j, k, l] = Draws::seeded(seed, 0).partners::<3>(i, population);
            prop_assert!(j < population && k < population && l < population);
            prop_assert!(i != j && i != k && i != l && j != k && j != l && k != l);
        }
    }
}

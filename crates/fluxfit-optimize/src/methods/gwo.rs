//! GWO: the grey wolf optimizer.
//!
//! Idea: every wolf goes to the mean of three places, each near one of the three best wolves ever seen.
//!
//! ```text
//! a   = 2 (1 - t/T)
//! x'  = mean over alpha, beta, delta of  b - A |C b - x_i|,   A = 2 a r - a,  C = 2 r'     r, r' per dimension and leader
//! ```
//!
//! Every move is taken. S. Mirjalili, S. M. Mirjalili and A. Lewis, "Grey wolf optimizer", Advances in Engineering Software 69 (2014)
//! 46–61, doi:10.1016/j.advengsoft.2013.12.007. `t` is counted from 1.
//!
//! **Drawn to the origin**: `|C b - x|` is a distance only where `b` is zero. On a function that is shifted, box and all, the course
//! is another one, and its end 40 orders of magnitude worse.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::{Population, WORST_COST},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of GWO: none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Gwo {}

impl Gwo {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self {};
}

/// The three best wolves ever seen: alpha, beta, delta.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Leaders {
    places: [Vec<f64>; 3],
    costs: [f64; 3],
}

impl Leaders {
    /// Before any wolf is evaluated, the first one stands for all three.
    pub(crate) fn none(positions: &[f64], dimension: usize) -> Self {
        let first = positions[..dimension].to_vec();
        Self { places: [first.clone(), first.clone(), first], costs: [WORST_COST; 3] }
    }

    /// Ranks each wolf among the three; one that costs as much as a leader is that leader's double.
    pub(crate) fn follow(&mut self, wolves: &Population) {
        for (i, &cost) in wolves.costs().iter().enumerate() {
            let rank = self.costs.iter().filter(|held| cost > **held).count();
            if rank < 3 && cost != self.costs[rank] {
                self.costs[rank..].rotate_right(1);
                self.places[rank..].rotate_right(1);
                self.costs[rank] = cost;
                wolves.copy_position(i, &mut self.places[rank]);
            }
        }
    }

    /// Alpha, beta, delta.
    pub(crate) fn places(&self) -> [&[f64]; 3] {
        self.places.each_ref().map(Vec::as_slice)
    }

    /// Whether they live in the box of these wolves.
    pub(crate) fn fit(&self, wolves: &Population) -> bool {
        self.places.iter().all(|place| place.len() == wolves.best().len())
    }
}

impl Moves for Gwo {
    type Memory = Leaders;

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Leaders) {
        let positions = setup.uniform();
        let leaders = Leaders::none(&positions, setup.bounds.dimension());
        (positions, leaders)
    }

    fn begin(&self, leaders: &mut Leaders, generation: &mut Generation) {
        leaders.follow(generation.population);
    }

    /// One trial per wolf. Draws per component and leader: r of A, r' of C.
    fn propose(&self, leaders: &mut Leaders, generation: &mut Generation) {
        let a = 2.0 * (1.0 - generation.progress());
        let leaders = leaders.places();
        generation.try_each(|i, wolves, trial, draws| {
            wolves.copy_position(i, trial);
            for (d, x) in trial.iter_mut().enumerate() {
                let [r0, s0, r1, s1, r2, s2] = draws.uniforms();
                let near = |leader: &[f64], r: f64, s: f64| leader[d] - (2.0 * a * r - a) * (2.0 * s * leader[d] - *x).abs();
                let places = [near(leaders[0], r0, s0), near(leaders[1], r1, s1), near(leaders[2], r2, s2)];
                *x = (places[0] + places[1] + places[2]) / 3.0;
            }
        });
    }

    fn accept(&self, leaders: &mut Leaders, generation: &mut Generation) {
        generation.population.accept_all();
        leaders.follow(generation.population);
    }

    fn fits(leaders: &Leaders, wolves: &Population) -> bool {
        leaders.fit(wolves)
    }
}

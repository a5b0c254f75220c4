//! BFO: bacterial foraging.
//!
//! Idea: a bacterium tumbles in a random direction and swims on while that is worth it. From time to time the healthier half splits and
//! the other dies; now and then some are scattered.
//!
//! ```text
//! tumble    x' = x_i + C d/|d| (U - L),  d ~ U(-1, 1) per dimension; taken always
//! swim      the same step again, up to 4 times while J falls; taken always
//! J         f + sum_k (-0.1 exp(-0.2 |x - x_k|²) + 0.1 exp(-10 |x - x_k|²))          distances in the unit box
//! split     after 20 tumbles the half of the lower sum of J after each takes the places of the other
//! scatter   after 4 splits each bacterium is drawn anew in the box with probability 0.25
//! ```
//!
//! K. M. Passino, "Biomimicry of bacterial foraging for distributed optimization and control", IEEE Control Systems Magazine 22(3), 2002,
//! 52–67, doi:10.1109/MCS.2002.1004010. All bacteria tumble at once, so that a tumble is one batch, then those swim that go on. A tumble
//! takes one to five evaluations.
//!
//! The fixed step C limits the accuracy, and J adds a cost in its own unit to a number without one. J needs the square of the
//! population in time.
//!
//! When to use it: to compare with what others report of it.

use crate::{
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    moves::Moves,
    population::Population,
    setting::{check_count, check_fraction_of_box, check_probability},
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Most steps after a tumble.
pub(crate) const SWIMS: u32 = 4;

/// Settings of BFO.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Bfo {
    /// `C`: length of a step, as a fraction of the box's width. 0.01; the source leaves its unit open.
    pub step: f64,
    /// A bacterium is scattered with this probability. 0.25.
    pub scattered: f64,
    /// Tumbles between two splits. 20.
    pub tumbles: u32,
    /// Splits between two scatterings. 4.
    pub splits: u32,
}

impl Bfo {
    /// The settings where none are given.
    pub const DEFAULT: Self = Self { step: 0.01, scattered: 0.25, tumbles: 20, splits: 4 };
}

/// What the bacteria do, and have done.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(crate) struct Foraging {
    /// Whose trials are under way; none: a tumble is next.
    moving: Vec<bool>,
    /// Steps of the last tumble, in parts of the box's widths.
    steps: Vec<f64>,
    /// J where each one is.
    attraction: Vec<f64>,
    /// The sum of J after each tumble.
    health: Vec<f64>,
    swims: u32,
    tumbles: u32,
    splits: u32,
    scatters: bool,
}

impl Foraging {
    /// The numbers of those that move.
    fn movers(&self) -> Vec<usize> {
        (0..self.moving.len()).filter(|i| self.moving[*i]).collect()
    }
}

/// A direction of length 1. Draws one number per component.
pub(crate) fn tumble(dimension: usize, draws: &mut Draws) -> Vec<f64> {
    let direction: Vec<f64> = (0..dimension).map(|_| 2.0 * draws.uniform() - 1.0).collect();
    let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    direction.iter().map(|d| d / length).collect()
}

/// J of one bacterium.
fn attracted(i: usize, generation: &Generation) -> f64 {
    let population = &*generation.population;
    let swarm: f64 = (0..population.len())
        .map(|k| {
            let squares = population.position(i).iter().zip(population.position(k)).zip(generation.bounds.iter());
            let distance: f64 = squares.map(|((a, b), (lower, upper))| ((a - b) / (upper - lower)).powi(2)).sum();
            -0.1 * (-0.2 * distance).exp() + 0.1 * (-10.0 * distance).exp()
        })
        .sum();
    (population.costs()[i] + swarm).min(f64::MAX)
}

impl Moves for Bfo {
    type Memory = Foraging;

    fn check(&self) -> Result<(), Error> {
        check_fraction_of_box("step", self.step)?;
        check_probability("scattered", self.scattered)?;
        check_count("tumbles", self.tumbles)?;
        check_count("splits", self.splits)
    }

    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Foraging) {
        let positions = setup.uniform();
        let foraging = Foraging {
            moving: vec![false; setup.size],
            steps: vec![0.0; positions.len()],
            attraction: vec![0.0; setup.size],
            health: vec![0.0; setup.size],
            swims: 0,
            tumbles: 0,
            splits: 0,
            scatters: false,
        };
        (positions, foraging)
    }

    /// Draws of a scattering: one number per bacterium, then the places of those that go. Of a tumble: the directions.
    fn propose(&self, foraging: &mut Foraging, generation: &mut Generation) {
        let (count, bounds) = (generation.population.len(), generation.bounds);
        if foraging.scatters {
            foraging.moving = (0..count).map(|_| generation.draws.uniform() < self.scattered).collect();
            let movers = foraging.movers().len();
            if movers > 0 {
                generation.try_some(movers, |_, _, trial, draws| {
                    trial.iter_mut().zip(bounds.iter()).for_each(|(x, (lower, upper))| *x = lower + draws.uniform() * (upper - lower));
                });
                return;
            }
            foraging.scatters = false;
        }
        if !foraging.moving.contains(&true) {
            foraging.swims = 0;
            foraging.moving = vec![true; count];
            foraging.attraction = (0..count).map(|i| attracted(i, generation)).collect();
            foraging.steps = (0..count).flat_map(|_| tumble(bounds.dimension(), generation.draws)).map(|d| self.step * d).collect();
        }
        let (movers, steps) = (foraging.movers(), &foraging.steps);
        generation.try_some(movers.len(), |k, bacteria, trial, _| {
            let i = movers[k];
            bacteria.copy_position(i, trial);
            let own = &steps[i * trial.len()..(i + 1) * trial.len()];
            trial.iter_mut().zip(own).zip(bounds.iter()).for_each(|((x, step), (lower, upper))| *x += step * (upper - lower));
        });
    }

    fn accept(&self, foraging: &mut Foraging, generation: &mut Generation) {
        let movers = foraging.movers();
        for (k, i) in movers.iter().enumerate().take(generation.population.trial_costs().len()) {
            generation.population.take(*i, k);
        }
        if foraging.scatters {
            foraging.scatters = false;
            foraging.moving.fill(false);
            return;
        }
        for i in movers {
            let attraction = attracted(i, generation);
            foraging.moving[i] = attraction < foraging.attraction[i] && foraging.swims < SWIMS;
            foraging.attraction[i] = attraction;
        }
        foraging.swims = foraging.swims.saturating_add(1);
        if foraging.moving.contains(&true) {
            return;
        }
        for (health, attraction) in foraging.health.iter_mut().zip(&foraging.attraction) {
            // Sums of the cost that stands for none stay finite: files can hold them.
            *health = (*health + attraction).min(f64::MAX);
        }
        foraging.tumbles = foraging.tumbles.saturating_add(1);
        if foraging.tumbles >= self.tumbles {
            let mut order: Vec<usize> = (0..generation.population.len()).collect();
            order.sort_by(|a, b| foraging.health[*a].total_cmp(&foraging.health[*b]));
            let half = order.len() / 2;
            let (healthy, others) = order.split_at_mut(half);
            // With an odd number the one in the middle stays alone.
            let start = others.len() - half;
            others[start..].copy_from_slice(healthy);
            generation.population.keep(&order);
            foraging.health.fill(0.0);
            foraging.tumbles = 0;
            foraging.splits = foraging.splits.wrapping_add(1);
            foraging.scatters = foraging.splits.is_multiple_of(self.splits);
        }
    }

    fn fits(foraging: &Foraging, bacteria: &Population) -> bool {
        let count = bacteria.len();
        foraging.moving.len() == count
            && foraging.steps.len() == bacteria.positions().len()
            && foraging.attraction.len() == count
            && foraging.health.len() == count
    }
}

//! The methods: one file each, and the table of them.
//!
//! A new method is a file here, with its idea, equations, paper, settings, step and tests; a row of [`METHODS`]; and its line in each
//! list of this file, which the compiler asks for once [`Method`] has its variant.

pub mod apso;
pub mod fpa;
pub mod lpso;
pub mod particles;
pub mod tgfpa;

use crate::{
    error::Error,
    iteration::{Iteration, Setup},
    look::Look,
    population::Population,
};
use apso::Apso;
use fpa::Fpa;
use lpso::Lpso;
use particles::Particles;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::mem::discriminant;
use tgfpa::Tgfpa;

/// The methods, each with its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(tag = "method", content = "settings", rename_all = "kebab-case"))]
pub enum Method {
    /// Flower pollination with t and Gaussian perturbation: the paper's algorithm.
    Tgfpa(Tgfpa),
    /// Flower pollination.
    Fpa(Fpa),
    /// Particle swarm, inertia weight falling linearly.
    Lpso(Lpso),
    /// Particle swarm, inertia weight adapted to each particle's cost.
    Apso(Apso),
}

/// A row of [`METHODS`]: all that other programs need to know of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodFacts {
    /// Name in files and on the command line; serde's name of the variant too.
    pub key: &'static str,
    /// Name in prose.
    pub label: &'static str,
    /// The method with its default settings.
    pub default: Method,
    /// Smallest population that the method can work with.
    pub smallest_population: usize,
    /// How its curve looks.
    pub look: Look,
}

/// The table of methods; the paper's four come first, in the paper's order.
pub const METHODS: &[MethodFacts] = &[
    MethodFacts {
        key: "tgfpa",
        label: "tGFPA",
        default: Method::Tgfpa(Tgfpa::DEFAULT),
        smallest_population: Tgfpa::SMALLEST_POPULATION,
        look: Look { letter: 't', terminal: 2, light: [0x00, 0x5f, 0xe0], dark: [0x6d, 0x9b, 0xff], dashes: &[] },
    },
    MethodFacts {
        key: "fpa",
        label: "FPA",
        default: Method::Fpa(Fpa::DEFAULT),
        smallest_population: Fpa::SMALLEST_POPULATION,
        look: Look { letter: 'F', terminal: 3, light: [0x8f, 0x5a, 0x00], dark: [0xff, 0x9a, 0x3d], dashes: &[75, 40] },
    },
    MethodFacts {
        key: "lpso",
        label: "LPSO",
        default: Method::Lpso(Lpso::DEFAULT),
        smallest_population: 1,
        look: Look { letter: 'L', terminal: 4, light: [0x14, 0x4a, 0x38], dark: [0x4d, 0xf0, 0xbb], dashes: &[20, 30] },
    },
    MethodFacts {
        key: "apso",
        label: "APSO",
        default: Method::Apso(Apso::DEFAULT),
        smallest_population: 1,
        look: Look { letter: 'A', terminal: 5, light: [0xb5, 0x12, 0x8f], dark: [0xb7, 0x8f, 0xc0], dashes: &[100, 35, 20, 35] },
    },
];

/// tGFPA with its default settings.
impl Default for Method {
    fn default() -> Self {
        Self::Tgfpa(Tgfpa::DEFAULT)
    }
}

impl Method {
    /// All of them with their default settings, in the order of the table.
    pub fn all() -> [Self; METHODS.len()] {
        std::array::from_fn(|k| METHODS[k].default)
    }

    /// The method of a [`key`](Self::key), with its default settings.
    pub fn named(key: &str) -> Option<Self> {
        METHODS.iter().find(|facts| facts.key == key).map(|facts| facts.default)
    }

    /// Its row of the table.
    pub fn facts(&self) -> &'static MethodFacts {
        let of_this = |facts: &&MethodFacts| discriminant(&facts.default) == discriminant(self);
        // Every method has its row (tested), so the first one never stands for another.
        METHODS.iter().find(of_this).unwrap_or(&METHODS[0])
    }

    /// Name in files and on the command line.
    pub fn key(&self) -> &'static str {
        self.facts().key
    }

    /// Name in prose.
    pub fn label(&self) -> &'static str {
        self.facts().label
    }

    /// Lays out and evaluates the first population.
    pub(crate) fn start(self, setup: &mut Setup) -> Result<(Population, State), Error> {
        Ok(match self {
            Self::Tgfpa(tgfpa) => (tgfpa.start(setup)?, State::Tgfpa(tgfpa)),
            Self::Fpa(fpa) => (fpa.start(setup)?, State::Fpa(fpa)),
            Self::Lpso(lpso) => {
                let (swarm, particles) = lpso.start(setup)?;
                (swarm, State::Lpso(lpso, particles))
            }
            Self::Apso(apso) => {
                let (swarm, particles) = apso.start(setup)?;
                (swarm, State::Apso(apso, particles))
            }
        })
    }
}

/// A method under way: its settings, and what it remembers beside the [`Population`].
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
pub(crate) enum State {
    Tgfpa(Tgfpa),
    Fpa(Fpa),
    Lpso(Lpso, Particles),
    Apso(Apso, Particles),
}

impl State {
    /// One iteration: propose trials, evaluate them, accept some.
    pub(crate) fn step(&mut self, iteration: &mut Iteration) {
        match self {
            Self::Tgfpa(tgfpa) => tgfpa.step(iteration),
            Self::Fpa(fpa) => fpa.step(iteration),
            Self::Lpso(lpso, particles) => lpso.step(particles, iteration),
            Self::Apso(apso, particles) => apso.step(particles, iteration),
        }
    }

    /// Refuses what was read back and cannot be stepped: settings out of range, a memory of another size than the population's.
    #[cfg(feature = "serde")]
    pub(crate) fn check(&self, population: &Population) -> Result<(), Error> {
        match self {
            Self::Tgfpa(tgfpa) => tgfpa.check(),
            Self::Fpa(fpa) => fpa.check(),
            Self::Lpso(lpso, particles) => lpso.check().and(particles.check(population)),
            Self::Apso(apso, particles) => apso.check().and(particles.check(population)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// serde lists all variants when it is asked for one that there is not.
    #[cfg(feature = "serde")]
    #[test]
    fn every_method_has_its_row_and_serdes_name_is_its_key() {
        let refusal = serde_json::from_str::<Method>(r#"{"method":"?"}"#).unwrap_err().to_string();
        let keys: Vec<&str> = METHODS.iter().map(|facts| facts.key).collect();
        let variants: Vec<&str> = refusal.split('`').skip(3).step_by(2).collect();
        assert_eq!(variants, keys, "{refusal}");
    }

    #[test]
    fn no_two_methods_share_what_tells_them_apart() {
        for (k, one) in METHODS.iter().enumerate() {
            assert_eq!(Method::named(one.key), Some(one.default));
            assert_eq!(one.default.facts(), one);
            for other in &METHODS[..k] {
                assert!(one.key != other.key && one.label != other.label, "{}", one.key);
                assert!(one.look.letter != other.look.letter, "{}", one.key);
                assert!(one.look.light != other.look.light && one.look.dark != other.look.dark, "{}", one.key);
            }
        }
        assert_eq!(Method::named("ga"), None);
    }

    #[test]
    fn the_papers_methods_come_first() {
        let rows: Vec<(&str, usize)> = METHODS.iter().map(|facts| (facts.key, facts.smallest_population)).collect();
        assert_eq!(rows[..4], [("tgfpa", 4), ("fpa", 3), ("lpso", 1), ("apso", 1)]);
    }
}

#![doc = include_str!("../README.md")]

mod bounds;
mod draws;
mod error;
mod iteration;
mod levy;
mod logistic_map;
mod look;
pub mod methods;
mod moves;
mod objective;
mod optimizer;
mod population;
mod report;
mod runs;
mod setting;

pub use bounds::Bounds;
pub use draws::Draws;
pub use error::Error;
pub use look::Look;
pub use methods::{METHODS, Method, MethodFacts};
pub use objective::{Objective, objective_from};
pub use optimizer::Optimizer;
pub use population::{Population, WORST_COST};
pub use report::{Record, SearchReport, StopReason};
pub use runs::run_many;
pub use setting::{CloseTo, SearchSettings};

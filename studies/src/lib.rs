//! What the programs of this crate share with each other and with its tests.

pub mod bbob;
pub mod coverage;
pub mod drives;
pub mod known;
pub mod online;
pub mod rated;
pub mod remedies;
pub mod swarms;

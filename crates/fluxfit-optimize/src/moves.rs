//! What every method has to do: the grammar of the files in `methods/`.

use crate::{
    error::Error,
    iteration::{Generation, Setup},
    population::Population,
};

/// The moves of a method. A generation is proposed, evaluated, perhaps in parts, then accepted. A trait, because each method brings its
/// own memory, and most share the defaults.
pub(crate) trait Moves {
    /// What the method remembers beside the [`Population`].
    type Memory;

    /// Refuses settings out of range.
    fn check(&self) -> Result<(), Error>;

    /// Positions of the first candidates, row after row; and the memory.
    fn start(&self, setup: &mut Setup) -> (Vec<f64>, Self::Memory);

    /// Looks at the first candidates once they are evaluated.
    fn begin(&self, _memory: &mut Self::Memory, _generation: &mut Generation) {}

    /// Sets out the next trials, at least one.
    fn propose(&self, memory: &mut Self::Memory, generation: &mut Generation);

    /// Takes some of the evaluated trials; by default those that are better than their candidates.
    fn accept(&self, _memory: &mut Self::Memory, generation: &mut Generation) {
        generation.population.accept_better();
    }

    /// Whether a memory that was read back has the sizes that the population asks for.
    fn fits(_memory: &Self::Memory, _population: &Population) -> bool {
        true
    }
}

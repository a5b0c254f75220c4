//! The tools that an answer can be exported to.

use super::{matlab, mcsdk, moteus, tool::Tool, vesc};
use fluxfit::motor::Parameter;
use fluxfit_units::wording::list;

/// A tool that takes parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// VESC Tool: a motor configuration, XML.
    Vesc,
    /// moteus: commands that set its configuration.
    Moteus,
    /// ST's Motor Control SDK: lines of `pmsm_motor_parameters.h`.
    Mcsdk,
    /// Motor Control Blockset and Simscape: a script for MATLAB.
    Matlab,
}

/// Why a file is not exported: one sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// A parameter that the tool would use as known is not identified.
    #[error(
        "{} {} not identified, and {} would take any number as known; {remedy}",
        list(.symbols), if .symbols.len() == 1 { "is" } else { "are" }, .target.tool()
    )]
    NotIdentified {
        /// The tool.
        target: Target,
        /// The parameters.
        symbols: Vec<&'static str>,
        /// What to do about the first one.
        remedy: String,
    },
    /// An entry of the file needs the number of pole pairs.
    #[error("{} needs the pole pairs for {what}; state the number of pole pairs", .target.tool())]
    PolePairs {
        /// The tool.
        target: Target,
        /// The entry.
        what: &'static str,
    },
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 4] = [Self::Vesc, Self::Moteus, Self::Mcsdk, Self::Matlab];

    pub(super) fn facts(self) -> &'static Tool {
        match self {
            Self::Vesc => &vesc::TOOL,
            Self::Moteus => &moteus::TOOL,
            Self::Mcsdk => &mcsdk::TOOL,
            Self::Matlab => &matlab::TOOL,
        }
    }

    /// Short name, as in arguments.
    pub fn key(self) -> &'static str {
        self.facts().key
    }

    /// Name of the tool in a sentence.
    pub fn tool(self) -> &'static str {
        self.facts().name
    }

    /// The target with this short name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.key() == name)
    }

    /// Parameters that the file has.
    pub fn parameters(self) -> &'static [Parameter] {
        self.facts().parameters
    }

    /// Checks before anything is computed whether the number of pole pairs is missing.
    ///
    /// # Errors
    /// If it is.
    pub fn check_pole_pairs(self, pole_pairs: Option<u32>) -> Result<(), Refusal> {
        match self.facts().needs_pole_pairs {
            Some(what) if pole_pairs.is_none() => Err(Refusal::PolePairs { target: self, what }),
            _ => Ok(()),
        }
    }
}

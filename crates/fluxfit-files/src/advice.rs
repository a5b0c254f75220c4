//! What the user can state so that a file is read as meant: facts, from which each interface makes its own option or keyword.

/// A statement that resolves an error or changes what a note reports. Names of channels and parameters are the canonical ones.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Advice {
    /// Name the columns that hold these channels; where a column of the file resembles the channel, its header.
    MapColumns(Vec<(&'static str, Option<String>)>),
    /// The same, and state the units of these channels, which the headers do not.
    MapInUnits {
        /// Channels and headers.
        columns: Vec<(&'static str, Option<String>)>,
        /// Channels and units.
        units: Vec<(&'static str, &'static str)>,
    },
    /// State the unit of a channel.
    StateUnit {
        /// The channel.
        channel: &'static str,
        /// Its unit, where there is a likely one.
        unit: Option<&'static str>,
    },
    /// State whether a channel is electrical or mechanical, by its unit.
    StateRotation {
        /// The channel.
        channel: &'static str,
        /// Its unit, if it is electrical.
        electrical: &'static str,
        /// Its unit, if it is mechanical; with it, the number of pole pairs has to be stated.
        mechanical: &'static str,
        /// The number of pole pairs is stated already.
        has_pole_pairs: bool,
    },
    /// State the scale of a channel in a mapping file.
    ScaleInMapping {
        /// The channel.
        channel: &'static str,
        /// Its factor to SI units.
        scale: String,
    },
    /// All of these, not one of them.
    Together(Vec<Advice>),
    /// State the DBC that names the signals of CAN frames.
    StateDbc,
    /// State the number of pole pairs.
    StatePolePairs,
    /// Give the values of these parameters.
    FixParameters(Vec<&'static str>),
}

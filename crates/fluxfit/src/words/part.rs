//! What the parts of an uncertainty are, half a sentence each. Their names are [`Part::label`].

use crate::identification::fit::part::Part;

impl Part {
    /// What it comes from.
    pub fn cause(self) -> &'static str {
        match self {
            Self::Noise => "scatter of the measured rows",
            Self::Accuracy => "voltages that are not those at the motor, within their accuracy",
            Self::Prior => "the uncertainty of what was given beforehand",
            Self::Timing => "when in its period a logged voltage acts",
            Self::DeadTime => "voltage lost in the inverter, which looks like resistance",
            Self::FrameLag => "an angle that is off, or voltages and currents of different instants",
            Self::WithinRows => "what the drive does between two rows",
            Self::ProcessNoise => "unknown voltages that act on the motor (process noise)",
            Self::FaultsInDoubt => "faults of the drive that the log neither proves nor rules out",
            Self::Sensors => "current sensors that differ, any of which may be right",
            Self::CurrentGain => "stated accuracy of all currents together",
            Self::BusVoltage => "stated accuracy of the DC voltage",
            Self::Saturation => "inductances that depend on the current",
            Self::Excitation => "changes of the parameters that currents and speeds of this log hardly show",
            Self::Misfit => "operating points that contradict each other",
        }
    }
}

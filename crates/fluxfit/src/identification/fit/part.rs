//! The contributions to an uncertainty, by name.

/// A contribution to an uncertainty; the systematic ones are the fields of [`Systematic`](super::uncertainty::Systematic).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// Noise.
    Noise,
    /// Accuracy of the voltages.
    Accuracy,
    /// Priors.
    Prior,
    /// Timing of the voltage columns.
    Timing,
    /// Dead time or device drops.
    DeadTime,
    /// A recorder's voltages that may turn with speed against its currents, or an angle that may be off and late where rows are far apart.
    FrameLag,
    /// What goes on within rows that each span several of the drive's periods.
    WithinRows,
    /// Unknown voltages that disturb the motor.
    ProcessNoise,
    /// Faults of the drive that the log neither proves nor rules out.
    FaultsInDoubt,
    /// Current sensors whose gains differ.
    Sensors,
    /// A gain common to all current sensors.
    CurrentGain,
    /// The DC voltage's measurement.
    BusVoltage,
    /// Inductances that depend on the current.
    Saturation,
    /// Combinations of the parameters that the log does not excite.
    Excitation,
    /// Contradiction between the operating points.
    Misfit,
}

impl Part {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Noise => "noise",
            Self::Accuracy => "accuracy",
            Self::Prior => "prior",
            Self::Timing => "timing",
            Self::DeadTime => "dead_time",
            Self::FrameLag => "frame_lag",
            Self::WithinRows => "within_rows",
            Self::ProcessNoise => "process_noise",
            Self::FaultsInDoubt => "faults_in_doubt",
            Self::Sensors => "sensors",
            Self::CurrentGain => "current_gain",
            Self::BusVoltage => "bus_voltage",
            Self::Saturation => "saturation",
            Self::Excitation => "excitation",
            Self::Misfit => "misfit",
        }
    }

    /// Name in a table.
    pub fn label(self) -> &'static str {
        match self {
            Self::Noise => "noise",
            Self::Accuracy => "voltage accuracy",
            Self::Prior => "prior",
            Self::Timing => "voltage timing",
            Self::DeadTime => "dead time",
            Self::FrameLag => "frame lag",
            Self::WithinRows => "rows far apart",
            Self::ProcessNoise => "disturbances",
            Self::FaultsInDoubt => "faults in doubt",
            Self::Sensors => "current sensors",
            Self::CurrentGain => "current accuracy",
            Self::BusVoltage => "bus accuracy",
            Self::Saturation => "saturation",
            Self::Excitation => "excitation",
            Self::Misfit => "misfit",
        }
    }
}

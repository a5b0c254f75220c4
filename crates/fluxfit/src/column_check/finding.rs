//! What the columns of a log may contradict each other in: facts.

/// Something that the columns of a log contradict each other in. It prints as half a sentence; [`code`](Self::code) names it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ColumnFinding {
    /// The angle turns at another rate than the speed says.
    SpeedUnit {
        /// How many times as fast.
        ratio: f64,
    },
    /// The inductances by which the currents change are not those that the speed shows.
    SpeedScale {
        /// How many times too high the speed is, at least.
        low: f64,
        /// And at most.
        high: f64,
        /// Whether an angle turns with it, which then has the same error.
        angle: bool,
    },
    /// The angle is in degrees, not in radians.
    AngleInDegrees,
    /// The angle turns against the speed.
    SpeedSign {
        /// Which of the two has the wrong sign, where the voltages show it.
        wrong: Option<Turning>,
    },
    /// The time is in another unit.
    TimeUnit {
        /// What it has to be multiplied by, a power of 1000.
        factor: f64,
    },
    /// Signs or order of the axes: a motor explains the voltages only with them changed.
    Axes {
        /// Changes that do it, each a list; equally simple ones, the best first.
        changes: Vec<Vec<Change>>,
        /// What the best of them leaves of the voltage, as a fraction.
        left: f64,
        /// What the columns as they are leave.
        left_now: f64,
    },
    /// The current turns backward in the frame of the angle: two phases have changed places.
    PhaseOrder,
    /// Nearly all rows with current have more voltage than the inverter can make.
    VoltageScale {
        /// Median of |u| over `u_dc / sqrt 3`.
        ratio: f64,
    },
}

/// One of the two columns that tell how the rotor turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turning {
    /// The angle.
    Angle,
    /// The speed.
    Speed,
}

/// A change of signs or order that makes the columns those of a motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Change {
    /// d and q exchanged, of voltages and currents.
    SwapAxes,
    /// u_d and u_q exchanged.
    SwapVoltages,
    /// i_d and i_q exchanged.
    SwapCurrents,
    /// Both currents reversed.
    ReverseCurrents,
    /// Both voltages reversed.
    ReverseVoltages,
    /// Voltages and currents reversed: the d axis points to the south pole.
    ReverseAxes,
    /// The speed reversed; or, which no log can tell from it, the q axis of voltages and currents.
    ReverseSpeed,
    /// u_d reversed.
    ReverseUd,
    /// u_q reversed.
    ReverseUq,
    /// i_d reversed.
    ReverseId,
    /// i_q reversed.
    ReverseIq,
}

impl ColumnFinding {
    /// Name in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::SpeedUnit { .. } | Self::SpeedScale { .. } | Self::AngleInDegrees => "speed-unit",
            Self::SpeedSign { .. } => "speed-sign",
            Self::TimeUnit { .. } => "time-unit",
            Self::Axes { .. } => "column-signs",
            Self::PhaseOrder => "phase-order",
            Self::VoltageScale { .. } => "voltage-scale",
        }
    }

    /// The codes of all findings.
    pub const CODES: [&'static str; 6] = ["speed-unit", "speed-sign", "time-unit", "column-signs", "phase-order", "voltage-scale"];
}

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
    /// Nearly all rows with current have more voltage than the inverter can make; or some have, and the currents follow it.
    VoltageScale {
        /// Median of |u| over `u_dc / sqrt 3`; where not nearly all rows have more than there is, the median of those that have.
        ratio: f64,
        /// Part of the rows with current that have more than there is.
        rows: f64,
        /// The largest |u|.
        most: f64,
    },
    /// Voltages that never exceed one, beside a DC voltage: shares of it. As volts they would be those of no motor.
    VoltageShare {
        /// The largest |u|.
        most: f64,
        /// The DC voltage, V.
        u_dc: f64,
        /// Electrical speed, rad/s, at which the motor of these voltages would use up the DC voltage; none of a rotor that stands, whose
        /// voltages are smaller than a step of the inverter.
        omega_e: Option<f64>,
        /// Whether no motor comes to that speed.
        is_certain: bool,
    },
    /// Voltages and currents that do not stand in the rows in which they were.
    LateColumns {
        /// By so many rows the voltages are late; negative, the currents.
        rows: isize,
    },
    /// Voltages that are whole numbers: digits of a converter, tenths, or V that were rounded.
    VoltageDigits {
        /// The largest |u|.
        most: f64,
        /// Whether the currents are whole numbers, too.
        currents: bool,
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
            Self::LateColumns { .. } => "late-columns",
            Self::VoltageScale { .. } | Self::VoltageDigits { .. } => "voltage-scale",
            Self::VoltageShare { .. } => "voltage-share",
        }
    }

    /// Whether an answer would mean nothing. What is not certain is a warning.
    pub fn is_certain(&self) -> bool {
        !matches!(self, Self::VoltageShare { is_certain: false, .. } | Self::VoltageDigits { .. })
    }

    /// Whether it is answered where the file or the user writes the unit of the voltages: what the numbers alone say is then no evidence.
    pub fn is_of_unwritten_volts(&self) -> bool {
        matches!(self, Self::VoltageShare { .. } | Self::VoltageDigits { .. })
    }

    /// The codes of all findings.
    pub const CODES: [&'static str; 8] =
        ["speed-unit", "speed-sign", "time-unit", "column-signs", "phase-order", "late-columns", "voltage-scale", "voltage-share"];
}

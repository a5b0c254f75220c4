//! Why a scenario is refused, or its drive trips.
//!
//! Each variant carries the values; the sentence is written once, here, and says what to do. Keys are those of a scenario file.

/// What went wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range.
    #[error("{key} is {value}; it must be {range}")]
    Setting {
        /// As a scenario file names it.
        key: &'static str,
        /// The value, SI.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
    /// Settings that exclude each other.
    #[error("{key} goes with {with} only; {remedy}")]
    Together {
        /// As a scenario file names it.
        key: &'static str,
        /// What it asks for.
        with: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// More rows than a log can hold.
    #[error("{duration} s at {rate} samples a second make {rows} rows, more than {most}; shorten duration")]
    TooLong {
        /// Simulated time, s.
        duration: f64,
        /// Sample rate, Hz.
        rate: f64,
        /// Rows.
        rows: f64,
        /// Most rows.
        most: f64,
    },
    /// A sample period that no current controller survives.
    #[error(
        "a sample every {sample_period} s is slower than the winding's L/R of {time_constant:.3e} s, and no current controller is stable there; raise inverter.carrier to at least {carrier:.0} Hz"
    )]
    SlowSampling {
        /// s.
        sample_period: f64,
        /// Shortest `L/R`, s.
        time_constant: f64,
        /// Carrier frequency that is fast enough, Hz.
        carrier: f64,
    },
    /// A loop that is too fast for its samples, or for the loop inside.
    #[error("{key} is {value:.4} Hz; with {because} it must be at most {most:.4} Hz")]
    Bandwidth {
        /// As a scenario file names it.
        key: &'static str,
        /// Hz.
        value: f64,
        /// What limits it.
        because: String,
        /// Hz.
        most: f64,
    },
    /// A point of the schedule that the inverter's voltage does not reach.
    #[error(
        "at t = {t} s the schedule asks for {rpm:.0} r/min with i_d = {id:.3} A and i_q = {iq:.3} A, which takes {needed:.1} V of phase voltage; u_dc = {u_dc} V makes {available:.1} V: raise inverter.u_dc, lower the speed, or allow control.field_weakening"
    )]
    Voltage {
        /// s.
        t: f64,
        /// Mechanical speed.
        rpm: f64,
        /// A.
        id: f64,
        /// A.
        iq: f64,
        /// V.
        needed: f64,
        /// V.
        u_dc: f64,
        /// V.
        available: f64,
    },
    /// A point of the schedule that the largest current does not reach.
    #[error(
        "at t = {t} s the schedule asks for {torque:.4} N m with i_d = {id:.3} A, which takes {needed:.4} A; control.max_current is {available} A: raise it, or lower the load"
    )]
    Current {
        /// s.
        t: f64,
        /// N m.
        torque: f64,
        /// A.
        id: f64,
        /// A.
        needed: f64,
        /// A.
        available: f64,
    },
    /// A point of the schedule at which the motor has no torque.
    #[error(
        "at t = {t} s and i_d = {id:.3} A this motor makes no torque in the direction of i_q; choose another i_d, or mechanics.kind = \"dyno\""
    )]
    NoTorque {
        /// s.
        t: f64,
        /// A.
        id: f64,
    },
    /// A flux map that is no grid.
    #[error("the flux map has {points} points on {id} values of i_d and {iq} of i_q; it must hold every pair of at least 3 of each, once")]
    MapGrid {
        /// Points given.
        points: usize,
        /// Distinct `i_d`.
        id: usize,
        /// Distinct `i_q`.
        iq: usize,
    },
    /// A flux map with a hole.
    #[error("the flux map is not finite at i_d = {id} A, i_q = {iq} A; complete it, or leave that current out")]
    MapNotFinite {
        /// A.
        id: f64,
        /// A.
        iq: f64,
    },
    /// A flux map whose flux falls where the current rises.
    #[error(
        "around i_d = {id} A, i_q = {iq} A the flux of the map falls while the current rises, which no motor does; check for swapped axes or signs, or smooth the map"
    )]
    MapInductance {
        /// A.
        id: f64,
        /// A.
        iq: f64,
    },
    /// A current beyond the map.
    #[error(
        "at t = {t:.4} s the current i_d = {id:.3} A, i_q = {iq:.3} A leaves the flux map, which covers i_d {} .. {} A and i_q {} .. {} A; give a wider map, or ask for less", id_range[0], id_range[1], iq_range[0], iq_range[1]
    )]
    OutsideMap {
        /// s.
        t: f64,
        /// A.
        id: f64,
        /// A.
        iq: f64,
        /// A.
        id_range: [f64; 2],
        /// A.
        iq_range: [f64; 2],
    },
    /// The drive switched itself off.
    #[error(
        "the drive trips at t = {t:.5} s: the current vector reaches {current:.4} A, beyond control.trip_current = {limit} A ({circumstances}); ask for less, lower the bandwidths, or raise the limit"
    )]
    Trip {
        /// s.
        t: f64,
        /// A.
        current: f64,
        /// A.
        limit: f64,
        /// What the drive was at.
        circumstances: String,
    },
}

impl Error {
    /// The key of a scenario file that the error is about, if it is one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Setting { key, .. } | Self::Together { key, .. } | Self::Bandwidth { key, .. } => Some(key),
            Self::SlowSampling { .. } => Some("inverter.carrier"),
            Self::TooLong { .. } => Some("duration"),
            _ => None,
        }
    }
}

//! Errors: why a scenario is refused, or its simulation stops.
//!
//! Each variant carries the values; its sentence is written once, here, and says what to do. Keys are those of a scenario file.

/// An error of a scenario, a flux map or a simulation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is out of its range.
    #[error("{key} is {}; it must be {range}", digits(*.value))]
    Setting {
        /// Key in the scenario file.
        key: &'static str,
        /// The value, SI.
        value: f64,
        /// The allowed range.
        range: &'static str,
    },
    /// The start or duration of a ramp is negative or not finite.
    #[error("a move of {key} has the time {} s; times must be finite, and zero or more", digits(*.time))]
    RampTime {
        /// Key in the scenario file.
        key: &'static str,
        /// Start or duration, s.
        time: f64,
    },
    /// Two settings exclude each other.
    #[error("{key} is allowed only with {with}; {remedy}")]
    Incompatible {
        /// Key in the scenario file.
        key: &'static str,
        /// The setting that it requires.
        with: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// The log would have too many rows.
    #[error("{} s at {} samples a second make {rows:.1e} rows, more than {most:.0e}; shorten duration", digits(*.duration), digits(*.rate))]
    TooLong {
        /// Simulated time, s.
        duration: f64,
        /// Sample rate, Hz.
        rate: f64,
        /// Number of rows.
        rows: f64,
        /// Largest number of rows.
        most: f64,
    },
    /// The log does not fit into the memory that is free.
    #[error("a log of {rows} rows does not fit into memory; shorten duration")]
    Memory {
        /// Number of rows.
        rows: usize,
    },
    /// The sample period is too long for stable current control.
    #[error(
        "a sample every {} ms is slower than the winding's L/R of {} ms, too slow for stable current control; raise inverter.carrier to at least {} Hz",
        digits(1e3 * .sample_period), rounded(1e3 * .time_constant), digits(*.carrier)
    )]
    SlowSampling {
        /// Sample period, s.
        sample_period: f64,
        /// Smallest `L/R`, s.
        time_constant: f64,
        /// Sufficient carrier frequency, Hz.
        carrier: f64,
    },
    /// The bandwidth of a control loop is too large.
    #[error("{key} is {} Hz; with {limit} it must be at most {} Hz", digits(*.value), rounded_down(*.most))]
    Bandwidth {
        /// Key in the scenario file.
        key: &'static str,
        /// Bandwidth, Hz.
        value: f64,
        /// What limits it.
        limit: BandwidthLimit,
        /// Largest bandwidth, Hz.
        most: f64,
    },
    /// The schedule needs more voltage than the inverter has.
    #[error(
        "at t = {} s the schedule asks for {} r/min with i_d = {} A and i_q = {} A, which needs {} V of phase voltage; u_dc = {} V gives {} V: raise inverter.u_dc, lower the speed, or {remedy}",
        digits(*.t), digits(*.rpm), rounded(*.id), rounded(*.iq), rounded(*.needed), digits(*.u_dc), rounded(*.available)
    )]
    VoltageLimit {
        /// Time, s.
        t: f64,
        /// Mechanical speed, r/min.
        rpm: f64,
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
        /// Needed phase voltage, V.
        needed: f64,
        /// DC voltage, V.
        u_dc: f64,
        /// Available phase voltage, V.
        available: f64,
        /// A further remedy.
        remedy: &'static str,
    },
    /// Load and friction need a current above the largest one.
    #[error(
        "at t = {} s load and friction ask for {} N m with i_d = {} A, which needs {} A; control.max_current is {} A: raise it, or lower the load",
        digits(*.t), rounded(*.torque), digits(*.id), rounded(*.needed), digits(*.available)
    )]
    TorqueLimit {
        /// Time, s.
        t: f64,
        /// Torque of load and friction, N m.
        torque: f64,
        /// i_d, A.
        id: f64,
        /// Needed current, A.
        needed: f64,
        /// Largest current, A.
        available: f64,
    },
    /// A scheduled current is above the largest one.
    #[error(
        "at t = {} s the schedule asks for a current of {} A (i_d = {} A, i_q = {} A); control.max_current is {} A: raise it, or ask for less",
        digits(*.t), rounded(*.needed), digits(*.id), digits(*.iq), digits(*.available)
    )]
    CurrentLimit {
        /// Time, s.
        t: f64,
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
        /// Length of the scheduled current vector, A.
        needed: f64,
        /// Largest current, A.
        available: f64,
    },
    /// The rotor turns too far in one sample period.
    #[error(
        "at t = {} s and {} r/min the rotor turns by {} electrical rad from one sample to the next, too far for sampled current control; raise inverter.carrier to at least {} Hz, or lower the speed",
        digits(*.t), digits(*.rpm), digits(*.turn), digits(*.carrier)
    )]
    FastRotation {
        /// Time, s.
        t: f64,
        /// Mechanical speed, r/min.
        rpm: f64,
        /// Angle per sample period, electrical rad.
        turn: f64,
        /// Sufficient carrier frequency, Hz.
        carrier: f64,
    },
    /// The schedule needs a current beyond the range of the A/D converter.
    #[error(
        "at t = {} s the schedule needs {} A, beyond the converter's sensors.adc_range = {} A; give it a wider range, or ask for less",
        digits(*.t), digits(*.needed), digits(*.range)
    )]
    ConverterRange {
        /// Time, s.
        t: f64,
        /// Needed current, A.
        needed: f64,
        /// Range of the converter, A.
        range: f64,
    },
    /// The sample period is too long for the speed observer of the encoder.
    #[error("the observer that estimates the speed from encoder steps needs a higher sample rate; raise inverter.carrier to at least {} Hz", digits(*.carrier))]
    SlowObserver {
        /// Sufficient carrier frequency, Hz.
        carrier: f64,
    },
    /// The control is unstable: a command is not finite.
    #[error("the drive's control diverges at t = {} s; lower the bandwidths, raise inverter.carrier, or give a larger inertia", digits(*.t))]
    Diverged {
        /// Time, s.
        t: f64,
    },
    /// At this i_d the motor has no torque in the direction of i_q.
    #[error(
        "at t = {} s and i_d = {} A this motor has no torque in the direction of i_q; choose another i_d, or mechanics.kind = \"dyno\"",
        digits(*.t), digits(*.id)
    )]
    NoTorque {
        /// Time, s.
        t: f64,
        /// i_d, A.
        id: f64,
    },
    /// A flux map has too few currents.
    #[error("the flux map has {id} values of i_d and {iq} of i_q; it needs at least 3 of each, and every pair of them")]
    MapTooSmall {
        /// Number of distinct `i_d`.
        id: usize,
        /// Number of distinct `i_q`.
        iq: usize,
    },
    /// A flux map lacks a pair of its currents.
    #[error(
        "the flux map has no point at i_d = {id} A, i_q = {iq} A, although it has both currents in other points; add it, so that the grid is complete"
    )]
    MapMissingPoint {
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
    },
    /// A flux map has a pair of currents twice.
    #[error("the flux map has the point i_d = {id} A, i_q = {iq} A twice; remove one of them")]
    MapRepeated {
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
    },
    /// A flux map has a value that is not finite.
    #[error("the flux map is not finite at i_d = {id} A, i_q = {iq} A; complete it, or leave that current out")]
    MapNotFinite {
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
    },
    /// The flux of a map falls while the current rises.
    #[error(
        "around i_d = {id} A, i_q = {iq} A the flux of the map falls while the current rises, which is not physical; check for swapped axes or signs, or smooth the map"
    )]
    MapInductance {
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
    },
    /// The current leaves the flux map: the scheduled one, or the last simulated one inside the map.
    #[error(
        "at t = {} s the current leaves the flux map near i_d = {} A, i_q = {} A; the map covers i_d {} .. {} A and i_q {} .. {} A: give a wider map, or ask for less",
        digits(*.t), rounded(*.id), rounded(*.iq), digits(id_range[0]), digits(id_range[1]), digits(iq_range[0]), digits(iq_range[1])
    )]
    OutsideMap {
        /// Time, s.
        t: f64,
        /// i_d, A.
        id: f64,
        /// i_q, A.
        iq: f64,
        /// Range of i_d of the map, A.
        id_range: [f64; 2],
        /// Range of i_q of the map, A.
        iq_range: [f64; 2],
    },
    /// The overcurrent protection has tripped.
    #[error(
        "the drive trips at t = {} s: the current vector reaches {} A, beyond control.trip_current = {} A (at {rpm:.0} r/min, with {:.0} % of the voltage in use); ask for less, lower the bandwidths, or raise the limit",
        digits(*.t), rounded(*.current), digits(*.limit), 100.0 * .modulation
    )]
    Trip {
        /// Time, s.
        t: f64,
        /// Length of the current vector, A.
        current: f64,
        /// Trip level, A.
        limit: f64,
        /// Mechanical speed, r/min.
        rpm: f64,
        /// Commanded voltage as a fraction of the voltage limit.
        modulation: f64,
    },
}

/// What limits the bandwidth of a control loop.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BandwidthLimit {
    /// The sample rate, Hz, of the current loop.
    #[error("{0} samples a second")]
    SampleRate(f64),
    /// The bandwidth, Hz, of the current loop inside the speed loop.
    #[error("a current loop of {0} Hz inside")]
    CurrentLoop(f64),
    /// The bandwidth, Hz, of the observer that estimates the speed from encoder steps.
    #[error("an encoder, whose speed comes from an observer of {} Hz,", digits(*.0))]
    SpeedObserver(f64),
}

/// Kinds of [`Error`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A setting of the scenario is out of its range, or excludes another one.
    Setting,
    /// The schedule needs more current, voltage, torque or flux than there is.
    Infeasible,
    /// The flux map is not that of a motor, or not a complete grid.
    FluxMap,
    /// The simulation stopped: the drive tripped, or its control is unstable.
    Stopped,
}

/// A number as it was given: nine digits, without rounding errors.
fn digits(value: f64) -> String {
    significant(value, 9)
}

/// A computed number: four digits.
fn rounded(value: f64) -> String {
    significant(value, 4)
}

/// A limit, rounded down to three digits, so that the printed value satisfies it.
fn rounded_down(value: f64) -> String {
    let step = 10.0_f64.powf(value.abs().log10().floor() - 2.0);
    digits((value / step).floor() * step)
}

fn significant(value: f64, digits: usize) -> String {
    let value: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    if value == 0.0 || (1e-4..1e12).contains(&value.abs()) { format!("{}", value + 0.0) } else { format!("{value:e}") }
}

impl Error {
    /// The kind of the error.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Setting { .. }
            | Self::RampTime { .. }
            | Self::Incompatible { .. }
            | Self::TooLong { .. }
            | Self::Memory { .. }
            | Self::SlowSampling { .. }
            | Self::Bandwidth { .. }
            | Self::SlowObserver { .. } => ErrorKind::Setting,
            Self::VoltageLimit { .. }
            | Self::TorqueLimit { .. }
            | Self::CurrentLimit { .. }
            | Self::FastRotation { .. }
            | Self::ConverterRange { .. }
            | Self::NoTorque { .. }
            | Self::OutsideMap { .. } => ErrorKind::Infeasible,
            Self::MapTooSmall { .. }
            | Self::MapMissingPoint { .. }
            | Self::MapRepeated { .. }
            | Self::MapNotFinite { .. }
            | Self::MapInductance { .. } => ErrorKind::FluxMap,
            Self::Diverged { .. } | Self::Trip { .. } => ErrorKind::Stopped,
        }
    }

    /// The key of the scenario file that the error is about, if it is about a single key.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Setting { key, .. } | Self::RampTime { key, .. } | Self::Incompatible { key, .. } | Self::Bandwidth { key, .. } => {
                Some(key)
            }
            Self::SlowSampling { .. } | Self::SlowObserver { .. } => Some("inverter.carrier"),
            Self::TooLong { .. } | Self::Memory { .. } => Some("duration"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_without_rounding_errors() {
        assert_eq!(digits(0.1 + 0.2), "0.3");
        assert_eq!(digits(-1e-7), "-1e-7");
        assert_eq!(digits(1e9), "1000000000");
        assert_eq!(rounded(91.98851), "91.99");
        assert_eq!(rounded_down(397.887), "397");
        assert_eq!(rounded_down(66.6666), "66.6");
        assert_eq!(rounded(-0.0), "0");
        assert_eq!(rounded(f64::INFINITY), "inf");
        assert_eq!(digits(f64::NAN), "NaN");
    }
}

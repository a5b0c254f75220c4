//! Why a scenario is refused, or its drive trips.
//!
//! Each variant carries the values; the sentence is written once, here, and says what to do. Keys are those of a scenario file.

/// What went wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range.
    #[error("{key} is {}; it must be {range}", digits(*.value))]
    Setting {
        /// As a scenario file names it.
        key: &'static str,
        /// The value, SI.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
    /// A move at no time.
    #[error("a move of {key} has the time {} s; times must be finite, and zero or more", digits(*.time))]
    MoveTime {
        /// As a scenario file names it.
        key: &'static str,
        /// When it begins, or how long it takes, s.
        time: f64,
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
    #[error("{} s at {} samples a second make {rows:.1e} rows, more than {most:.0e}; shorten duration", digits(*.duration), digits(*.rate))]
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
        "a sample every {} ms is slower than the winding's L/R of {} ms, and no current controller is stable there; raise inverter.carrier to at least {} Hz",
        digits(1e3 * .sample_period), rounded(1e3 * .time_constant), digits(*.carrier)
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
    #[error("{key} is {} Hz; with {because} it must be at most {} Hz", digits(*.value), rounded_down(*.most))]
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
        "at t = {} s the schedule asks for {} r/min with i_d = {} A and i_q = {} A, which takes {} V of phase voltage; u_dc = {} V makes {} V: raise inverter.u_dc, lower the speed, or {remedy}",
        digits(*.t), digits(*.rpm), rounded(*.id), rounded(*.iq), rounded(*.needed), digits(*.u_dc), rounded(*.available)
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
        /// What else would help.
        remedy: &'static str,
    },
    /// A point of the schedule that the largest current does not reach.
    #[error(
        "at t = {} s load and friction ask for {} N m with i_d = {} A, which takes {} A; control.max_current is {} A: raise it, or lower the load",
        digits(*.t), rounded(*.torque), digits(*.id), rounded(*.needed), digits(*.available)
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
    /// A scheduled current above the largest one.
    #[error(
        "at t = {} s the schedule asks for a current of {} A (i_d = {} A, i_q = {} A); control.max_current is {} A: raise it, or ask for less",
        digits(*.t), rounded(*.needed), digits(*.id), digits(*.iq), digits(*.available)
    )]
    Reference {
        /// s.
        t: f64,
        /// A.
        id: f64,
        /// A.
        iq: f64,
        /// A.
        needed: f64,
        /// A.
        available: f64,
    },
    /// A speed at which the rotor turns too far from sample to sample.
    #[error(
        "at t = {} s and {} r/min the rotor turns by {} rad from one sample to the next, too far for a controller of sampled currents; raise inverter.carrier to at least {} Hz, or lower the speed",
        digits(*.t), digits(*.rpm), digits(*.turn), digits(*.carrier)
    )]
    FastRotation {
        /// s.
        t: f64,
        /// Mechanical speed.
        rpm: f64,
        /// Electrical rad.
        turn: f64,
        /// Carrier frequency that is fast enough, Hz.
        carrier: f64,
    },
    /// A converter that cannot read the current that is needed.
    #[error(
        "at t = {} s the schedule takes {} A, beyond the converter's sensors.adc_range = {} A; give it a wider range, or ask for less",
        digits(*.t), digits(*.needed), digits(*.range)
    )]
    ConverterRange {
        /// s.
        t: f64,
        /// A.
        needed: f64,
        /// A.
        range: f64,
    },
    /// Samples that are too slow for the encoder's observer.
    #[error("the observer that makes a speed of encoder steps needs more samples; raise inverter.carrier to at least {} Hz", digits(*.carrier))]
    SlowForEncoder {
        /// Carrier frequency that is fast enough, Hz.
        carrier: f64,
    },
    /// A command that is no number any more.
    #[error("the drive's control diverges at t = {} s; lower the bandwidths, raise inverter.carrier, or give a larger inertia", digits(*.t))]
    Diverged {
        /// s.
        t: f64,
    },
    /// A point of the schedule at which the motor has no torque.
    #[error(
        "at t = {} s and i_d = {} A this motor makes no torque in the direction of i_q; choose another i_d, or mechanics.kind = \"dyno\"",
        digits(*.t), digits(*.id)
    )]
    NoTorque {
        /// s.
        t: f64,
        /// A.
        id: f64,
    },
    /// A flux map that is no grid.
    #[error("the flux map has {id} values of i_d and {iq} of i_q; it needs at least 3 of each, and every pair of them")]
    MapGrid {
        /// Distinct `i_d`.
        id: usize,
        /// Distinct `i_q`.
        iq: usize,
    },
    /// A flux map without one of its pairs.
    #[error(
        "the flux map has no point at i_d = {id} A, i_q = {iq} A, although it has others with either; add it, so that every pair is there"
    )]
    MapHole {
        /// A.
        id: f64,
        /// A.
        iq: f64,
    },
    /// A flux map with a pair twice.
    #[error("the flux map has the point i_d = {id} A, i_q = {iq} A twice; remove one of them")]
    MapRepeated {
        /// A.
        id: f64,
        /// A.
        iq: f64,
    },
    /// A flux map with a number that is none.
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
    /// A current beyond the map: that which is asked for, or the last one that was still inside.
    #[error(
        "at t = {} s the current leaves the flux map near i_d = {} A, i_q = {} A; the map covers i_d {} .. {} A and i_q {} .. {} A: give a wider map, or ask for less",
        digits(*.t), rounded(*.id), rounded(*.iq), digits(id_range[0]), digits(id_range[1]), digits(iq_range[0]), digits(iq_range[1])
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
        "the drive trips at t = {} s: the current vector reaches {} A, beyond control.trip_current = {} A ({circumstances}); ask for less, lower the bandwidths, or raise the limit",
        digits(*.t), rounded(*.current), digits(*.limit)
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

/// A number as somebody wrote it: without the last digits, which are rounding's.
fn digits(value: f64) -> String {
    significant(value, 9)
}

/// A number that was computed: nobody needs more than four digits of it.
fn rounded(value: f64) -> String {
    significant(value, 4)
}

/// A limit that can be copied and is kept.
fn rounded_down(value: f64) -> String {
    let step = 10.0_f64.powf(value.abs().log10().floor() - 2.0);
    digits((value / step).floor() * step)
}

fn significant(value: f64, digits: usize) -> String {
    let value: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    if value == 0.0 || (1e-4..1e12).contains(&value.abs()) { format!("{}", value + 0.0) } else { format!("{value:e}") }
}

impl Error {
    /// The key of a scenario file that the error is about, if it is one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Setting { key, .. } | Self::MoveTime { key, .. } | Self::Together { key, .. } | Self::Bandwidth { key, .. } => Some(key),
            Self::SlowSampling { .. } | Self::SlowForEncoder { .. } => Some("inverter.carrier"),
            Self::TooLong { .. } => Some("duration"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_end_where_rounding_begins() {
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

//! Speed lag: the logged speed is filtered and lags behind the rotor's, which is then `omega_e + lag d omega_e / dt`.
//!
//! To first order, what the rotor turns faster induces a voltage with the flux; where the angle is in the log the speed is taken from it,
//! and nothing lags there. But the angle of a delayed voltage was advanced by a speed, which may be another one than the log's: then the
//! voltage is turned further.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, no_kinds},
};
use crate::lanes::Number;

/// A speed that lags.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedLag {
    /// By which time, s.
    pub time: f64,
}

/// Longest lag, s: of a filter at 1 Hz.
const LONGEST: f64 = 0.16;

/// Usual lag, s: of a filter at 16 Hz.
const USUAL: f64 = 0.01;

pub(super) static FAULT: Description<SpeedLag> = Description {
    key: "speed_lag",
    label: "lag of the logged speed",
    family: "speed lag",
    angle: AngleNeed::Nothing,
    alters_measured_current: false,
    numbers: &[NumberDescription {
        names: Names { key: "speed_lag", label: "time by which the logged speed lags", unit: "s" },
        get: |state| state.time,
        set: |state, value| state.time = value,
        usual_size: |_, _| USUAL,
    }],
    starts: |state, _| vec![*state],
    kinds: no_kinds,
    is_physical: |state, _, _| (0.0..LONGEST).contains(&state.time),
};

/// The voltage, V, `d, q`, that flux (Wb, `d, q`) induces because the rotor turns faster than the log says.
#[inline(always)]
pub(super) fn induced<V: Number>(lag: V, flux: [V; 2], place: &Place) -> [V; 2] {
    let faster = lag * lag.constant(place.acceleration);
    [-faster * flux[1], faster * flux[0]]
}

/// The voltage `u`, V, whose angle was advanced by the true speed, not by the one that lags.
#[inline(always)]
pub(super) fn advanced<V: Number>(lag: V, u: [V; 2], place: &Place) -> [V; 2] {
    // To first order: a fraction of a degree.
    let by = lag * lag.constant(place.advance_per_lag);
    [u[0] - by * u[1], u[1] + by * u[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Turn;

    /// 10 ms behind a speed that grows by 3000 rad/s²: the rotor turns 30 rad/s faster, and 0.2 Wb along d induce 6 V along q.
    #[test]
    fn the_flux_induces_with_the_speed_that_is_missing() {
        let place = Place { acceleration: 3000.0, advance_per_lag: 0.5, ..Place::still(Turn::by(0.0)) };
        let found = induced(0.01, [0.2, 0.0], &place);
        assert!(found[0].abs() < 1e-12 && (found[1] - 6.0).abs() < 1e-12, "{found:?}");
        // The voltage was advanced by 5 mrad more.
        let turned = advanced(0.01, [10.0, 20.0], &place);
        assert!((turned[0] - 9.9).hypot(turned[1] - 20.05) < 1e-12, "{turned:?}");
    }
}

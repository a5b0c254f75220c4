//! Flux harmonics: the magnet's flux through a phase has fifth and seventh harmonics. In the rotor's frame both turn at six times its
//! speed, one backward and one forward, and the flux of either axis is
//!
//! ```text
//! psi_d = L_d i_d + psi_f + a_d cos 6 theta + b_d sin 6 theta,     psi_q = L_q i_q + a_q cos 6 theta + b_q sin 6 theta
//! ```
//!
//! All four amplitudes are unknown, so that they are the same for any origin of the angle.

use super::{
    Place,
    description::{AngleNeed, Description, Names, NumberDescription, no_kinds, present_state},
};
use crate::{lanes::Number, motor::Motor};

/// Amplitudes of the sixth harmonic of the flux, Wb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxHarmonics {
    /// With the cosine and the sine of six times the angle, along d.
    pub d: [f64; 2],
    /// The same along q.
    pub q: [f64; 2],
}

/// Largest amplitude, as a fraction of psi_f: the harmonics of a square wave of flux are a fifth and a seventh.
const LARGEST: f64 = 0.5;

/// Usual amplitude, as a fraction of psi_f.
const USUAL: f64 = 0.01;

fn usual_size(motor: &Motor, _: f64) -> f64 {
    USUAL * motor.psi_f.abs().max(f64::MIN_POSITIVE)
}

pub(super) static FAULT: Description<FluxHarmonics> = Description {
    key: "flux_harmonics",
    label: "harmonics of the flux",
    family: "flux harmonics",
    angle: AngleNeed::Traced,
    alters_measured_current: false,
    numbers: &[
        NumberDescription {
            names: Names { key: "flux_harmonic_d_cos", label: "sixth harmonic of the d flux, cosine", unit: "Wb" },
            get: |state| state.d[0],
            set: |state, value| state.d[0] = value,
            usual_size,
        },
        NumberDescription {
            names: Names { key: "flux_harmonic_d_sin", label: "sixth harmonic of the d flux, sine", unit: "Wb" },
            get: |state| state.d[1],
            set: |state, value| state.d[1] = value,
            usual_size,
        },
        NumberDescription {
            names: Names { key: "flux_harmonic_q_cos", label: "sixth harmonic of the q flux, cosine", unit: "Wb" },
            get: |state| state.q[0],
            set: |state, value| state.q[0] = value,
            usual_size,
        },
        NumberDescription {
            names: Names { key: "flux_harmonic_q_sin", label: "sixth harmonic of the q flux, sine", unit: "Wb" },
            get: |state| state.q[1],
            set: |state, value| state.q[1] = value,
            usual_size,
        },
    ],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, motor, _| {
        let FluxHarmonics { d, q } = state;
        d[0].hypot(d[1]).max(q[0].hypot(q[1])) < LARGEST * motor.psi_f.abs()
    },
};

/// What the harmonics induce over a period, V, `d, q`: of amplitudes `d cos, d sin, q cos, q sin`, Wb.
#[inline(always)]
pub(super) fn induced<V: Number>(amplitudes: [V; 4], place: &Place) -> [V; 2] {
    let (start, middle, end) = (place.start.sixfold(), place.middle.sixfold(), place.end.sixfold());
    // The flux grows by the difference of its ends, and turns with its mean, by Simpson's rule.
    let grows = [(end.cos - start.cos) / place.length, (end.sin - start.sin) / place.length];
    let mean = [(start.cos + 4.0 * middle.cos + end.cos) / 6.0, (start.sin + 4.0 * middle.sin + end.sin) / 6.0];
    let turns = mean.map(|mean| place.omega_e * mean);
    let [d_cos, d_sin, q_cos, q_sin] = amplitudes;
    let (d, q) = ([d_cos, d_sin], [q_cos, q_sin]);
    [sum(d, grows) - sum(q, turns), sum(q, grows) + sum(d, turns)]
}

/// The amplitudes' sum with these weights.
#[inline(always)]
fn sum<V: Number>([cos, sin]: [V; 2], [by_cos, by_sin]: [f64; 2]) -> V {
    cos * cos.constant(by_cos) + sin * sin.constant(by_sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Turn;

    /// A fifth harmonic of the phase flux, `k cos 5 theta` in phase a, is `k conj(e^(j 6 theta))` in the rotor's frame; it induces five
    /// times `omega k`, turning backward.
    #[test]
    fn a_fifth_harmonic_induces_five_times_its_flux() {
        const SPEED: f64 = 300.0;
        const LENGTH: f64 = 1e-5;
        for angle in [0.0, 0.3, 1.1] {
            let turn = |part: f64| Turn::by(angle + part * SPEED * LENGTH);
            let (start, middle, end) = (turn(-0.5), turn(0.0), turn(0.5));
            let place = Place { start, middle, end, length: LENGTH, omega_e: SPEED, ..Place::still(middle) };
            let found = induced([0.02, 0.0, 0.0, -0.02], &place);
            // d/dt k e^(-j 6 theta) + j omega k e^(-j 6 theta) = -5 j omega k e^(-j 6 theta).
            let (sin, cos) = (6.0 * angle).sin_cos();
            let expected = [-5.0 * SPEED * 0.02 * sin, -5.0 * SPEED * 0.02 * cos];
            assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-3 * 30.0, "{found:?} {expected:?}");
        }
    }
}

//! Current sensor imbalance: gains of the current sensors that differ.
//!
//! A current is then read as `i + s conj(i)` in the stator, with `s = alpha + j beta`. A gain that all sensors share is no part of it: it
//! acts like a smaller impedance. Three sensors have any `s`. Where only two phases have a sensor and the third current is
//! their negative sum, one number is all that there is, the gain of one over that of the other; it turns the current too.

use super::description::{AngleNeed, Description, Names, NumberDescription, no_kinds, one, present_state};
use crate::{
    frames::{AlphaBeta, Turn},
    lanes::Number,
};

/// What unequal gains of the current sensors do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurrentGains {
    /// `s`: a current is read as `i + s conj(i)` in the stator.
    pub imbalance: AlphaBeta,
    /// Angle by which currents are read too large, rad: a part of the imbalance of two sensors.
    pub turn: f64,
}

/// The most that a sensor's gain can be wrong by, as a fraction: beyond, it has the wrong sign.
const LARGEST: f64 = 1.0;

/// The family of all faults in this file.
const FAMILY: &str = "sensor imbalance";

/// Three current sensors.
pub(super) static THREE_SENSORS: Description<CurrentGains> = Description {
    key: "current_imbalance",
    label: "imbalance of three current sensors",
    family: FAMILY,
    angle: AngleNeed::Traced,
    alters_measured_current: true,
    numbers: &[
        NumberDescription {
            names: Names { key: "current_imbalance_alpha", label: "current sensor imbalance, alpha", unit: "1" },
            get: |state| state.imbalance.alpha,
            set: |state, value| state.imbalance.alpha = value,
            usual_size: one,
        },
        NumberDescription {
            names: Names { key: "current_imbalance_beta", label: "current sensor imbalance, beta", unit: "1" },
            get: |state| state.imbalance.beta,
            set: |state, value| state.imbalance.beta = value,
            usual_size: one,
        },
    ],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.is_physical(),
};

/// Sensors in phases a and b.
pub(super) static SENSORS_A_B: Description<CurrentGains> = Description {
    key: "two_sensors_ab",
    label: "imbalance of current sensors a and b",
    family: FAMILY,
    angle: AngleNeed::Known,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "current_gain_a_over_b", label: "gain of current sensor a over that of b, less one", unit: "1" },
        get: CurrentGains::gain_difference,
        set: |state, value| *state = CurrentGains::of_two(SensorPair::Ab, value),
        usual_size: one,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.is_physical(),
};

/// Sensors in phases b and c.
pub(super) static SENSORS_B_C: Description<CurrentGains> = Description {
    key: "two_sensors_bc",
    label: "imbalance of current sensors b and c",
    family: FAMILY,
    angle: AngleNeed::Known,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "current_gain_b_over_c", label: "gain of current sensor b over that of c, less one", unit: "1" },
        get: CurrentGains::gain_difference,
        set: |state, value| *state = CurrentGains::of_two(SensorPair::Bc, value),
        usual_size: one,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.is_physical(),
};

/// Sensors in phases c and a.
pub(super) static SENSORS_C_A: Description<CurrentGains> = Description {
    key: "two_sensors_ca",
    label: "imbalance of current sensors c and a",
    family: FAMILY,
    angle: AngleNeed::Known,
    alters_measured_current: true,
    numbers: &[NumberDescription {
        names: Names { key: "current_gain_c_over_a", label: "gain of current sensor c over that of a, less one", unit: "1" },
        get: CurrentGains::gain_difference,
        set: |state, value| *state = CurrentGains::of_two(SensorPair::Ca, value),
        usual_size: one,
    }],
    starts: present_state,
    kinds: no_kinds,
    is_physical: |state, _, _| state.is_physical(),
};

/// The phases that have a current sensor, where only two have.
#[derive(Debug, Clone, Copy)]
enum SensorPair {
    Ab,
    Bc,
    Ca,
}

impl SensorPair {
    /// Imbalance per unit of the difference. With phases a and b alone, gains `1 + e/2` and `1 - e/2` make of `i_c = -i_a - i_b`
    /// a matrix whose part `s` is `e (1/2 + j / (2 sqrt 3))`; the other pairs are turned by a phase, which turns `s` twice.
    fn imbalance(self) -> AlphaBeta {
        let turns = match self {
            Self::Ab => 0.0,
            Self::Bc => 2.0,
            Self::Ca => 4.0,
        };
        let (sin, cos) = (std::f64::consts::FRAC_PI_6 + turns * std::f64::consts::TAU / 3.0).sin_cos();
        let length = 1.0 / 3.0_f64.sqrt();
        AlphaBeta { alpha: length * cos, beta: length * sin }
    }
}

/// Turn of the currents, rad, per unit of the difference between two sensors: `1 / (2 sqrt 3)`, the rotation in their matrix.
fn turn_of_two() -> f64 {
    0.5 / 3.0_f64.sqrt()
}

impl CurrentGains {
    /// What the sensor of the first of two phases reads more than that of the second, as a fraction, makes of the currents.
    fn of_two(pair: SensorPair, difference: f64) -> Self {
        let AlphaBeta { alpha, beta } = pair.imbalance();
        Self { imbalance: AlphaBeta { alpha: difference * alpha, beta: difference * beta }, turn: difference * turn_of_two() }
    }

    /// That fraction, of whichever two sensors.
    fn gain_difference(&self) -> f64 {
        self.turn / turn_of_two()
    }

    /// Size of the imbalance, as a fraction of the current.
    pub fn magnitude(&self) -> f64 {
        self.imbalance.alpha.hypot(self.imbalance.beta)
    }

    fn is_physical(&self) -> bool {
        self.magnitude() < LARGEST
    }
}

/// The current, A, without the imbalance `s` (alpha, beta), where `i` (d, q) was measured with the rotor there; still turned.
#[inline(always)]
pub(super) fn balanced<V: Number>(s: [V; 2], i: [V; 2], rotor: Turn) -> [V; 2] {
    // In the rotor's frame the imbalance turns backward twice as fast. (i + s conj i) is undone exactly.
    let [d, q] = rotor.twice().backward(s);
    let one = d.constant(1.0);
    let shrunk = one / (one - d * d - q * q);
    [shrunk * (i[0] - d * i[0] - q * i[1]), shrunk * (i[1] - q * i[0] + d * i[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Abc, Dq};

    /// What two sensors with gains `1 + e/2` and `1 - e/2` make of a current, against imbalance and turn.
    #[test]
    fn two_sensors_by_their_phases() {
        let e = 1e-3;
        let (high, low) = (1.0 + 0.5 * e, 1.0 - 0.5 * e);
        for (pair, read) in [
            (SensorPair::Ab, (|p, h, l| Abc { a: h * p.a, b: l * p.b, c: -h * p.a - l * p.b }) as fn(Abc, f64, f64) -> Abc),
            (SensorPair::Bc, |p, h, l| Abc { a: -h * p.b - l * p.c, b: h * p.b, c: l * p.c }),
            (SensorPair::Ca, |p, h, l| Abc { a: l * p.a, b: -l * p.a - h * p.c, c: h * p.c }),
        ] {
            let CurrentGains { imbalance: AlphaBeta { alpha: a, beta: b }, turn } = CurrentGains::of_two(pair, e);
            for i in [AlphaBeta { alpha: 1.0, beta: 0.0 }, AlphaBeta { alpha: 0.0, beta: 1.0 }] {
                let expected = read(i.to_abc(), high, low).to_alpha_beta();
                let alpha = i.alpha - turn * i.beta + a * i.alpha + b * i.beta;
                let beta = i.beta + turn * i.alpha + b * i.alpha - a * i.beta;
                assert!((alpha - expected.alpha).hypot(beta - expected.beta) < 1e-12, "{pair:?}");
            }
        }
    }

    /// `i + s conj(i)`, written out in the stator, is undone at any angle.
    #[test]
    fn the_imbalance_is_undone_exactly() {
        for theta_e in [0.0, 0.7, 5.0] {
            let i = Dq { d: -4.0, q: 9.0 }.to_alpha_beta(theta_e);
            let (a, b) = (0.03, -0.02);
            let read = AlphaBeta { alpha: i.alpha + a * i.alpha + b * i.beta, beta: i.beta + b * i.alpha - a * i.beta };
            let read = read.to_dq(theta_e);
            let found = balanced([a, b], [read.d, read.q], Turn::by(theta_e));
            assert!((found[0] + 4.0).hypot(found[1] - 9.0) < 1e-14, "{found:?}");
        }
    }
}

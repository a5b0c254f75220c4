//! The adjustable drive: the motor, and what stands between it and the log.
//!
//! The *nuisance* is nobody's question, but it is in the currents: dead time, an encoder's offset, faults of the current sensors,
//! saturation, disturbances. Each is zero in a perfect drive. [`Unknown`] names every number that a fit may move.

use crate::{
    frames::{AlphaBeta, Dq},
    motor::{Motor, Parameter},
};

/// A motor in an imperfect drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjustable {
    /// The motor.
    pub motor: Motor,
    /// The rest.
    pub nuisance: Nuisance,
}

/// What stands between a motor and its log. The default is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nuisance {
    /// Voltage that each phase loses against its current, V: dead time's, and the devices'.
    pub dead_time: f64,
    /// Phase current, A, from which on it loses all of that; below, in proportion.
    pub dead_time_width: f64,
    /// Ripple of a phase current between the carrier's rising and falling half, A: where each half is a row, the loss changes its sign at
    /// plus that current in one row and at minus it in the next. Its sign says which half comes first.
    pub dead_time_ripple: f64,
    /// What the logged angle is too large by, electrical rad.
    pub angle_offset: f64,
    /// What the current sensors read at zero, A.
    pub current_offset: AlphaBeta,
    /// Gains of the current sensors that differ: a current is read as `i + s conj(i)` in the stator, with `s = alpha + j beta`. A gain
    /// common to all sensors is no part of it: it cannot be told from a smaller impedance.
    pub imbalance: AlphaBeta,
    /// Angle by which the currents alone are read too large, rad: a part of the imbalance of two sensors.
    pub current_turn: f64,
    /// Saturation, H/A: `psi_d` grows by `d i_d |i_d|` beyond `L_d i_d + psi_f`, `psi_q` by `q i_q |i_q|` beyond `L_q i_q`.
    pub saturation: Dq,
    /// Cross saturation, H/A: `psi_d` grows by `c i_q²`, `psi_q` by `2 c i_d i_q`, as one magnetic energy wants it.
    pub cross_saturation: f64,
    /// How far each simulated current follows the measured one from row to row: the gain of a Kalman filter, more than zero where
    /// unknown voltages disturb the motor.
    pub observer_gain: Dq,
}

/// A number of an [`Adjustable`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// One of the four parameters.
    Motor(Parameter),
    /// [`Nuisance::dead_time`].
    DeadTime,
    /// [`Nuisance::dead_time_width`].
    DeadTimeWidth,
    /// [`Nuisance::dead_time_ripple`].
    DeadTimeRipple,
    /// [`Nuisance::angle_offset`].
    AngleOffset,
    /// Component of [`Nuisance::current_offset`].
    OffsetAlpha,
    /// Component of [`Nuisance::current_offset`].
    OffsetBeta,
    /// Component of [`Nuisance::imbalance`].
    ImbalanceAlpha,
    /// Component of [`Nuisance::imbalance`].
    ImbalanceBeta,
    /// What the sensor of the first of two phases reads more than that of the second, as a fraction: imbalance and turn together.
    TwoSensors(SensorPair),
    /// Component of [`Nuisance::saturation`].
    SaturationD,
    /// Component of [`Nuisance::saturation`].
    SaturationQ,
    /// [`Nuisance::cross_saturation`].
    CrossSaturation,
    /// Component of [`Nuisance::observer_gain`].
    GainD,
    /// Component of [`Nuisance::observer_gain`].
    GainQ,
}

impl Unknown {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.key(),
            Self::DeadTime => "dead_time_voltage",
            Self::DeadTimeWidth => "dead_time_width",
            Self::DeadTimeRipple => "dead_time_ripple",
            Self::AngleOffset => "angle_offset",
            Self::OffsetAlpha => "current_offset_alpha",
            Self::OffsetBeta => "current_offset_beta",
            Self::ImbalanceAlpha => "current_imbalance_alpha",
            Self::ImbalanceBeta => "current_imbalance_beta",
            Self::TwoSensors(SensorPair::Ab) => "current_gain_a_over_b",
            Self::TwoSensors(SensorPair::Bc) => "current_gain_b_over_c",
            Self::TwoSensors(SensorPair::Ca) => "current_gain_c_over_a",
            Self::SaturationD => "saturation_d",
            Self::SaturationQ => "saturation_q",
            Self::CrossSaturation => "cross_saturation",
            Self::GainD => "observer_gain_d",
            Self::GainQ => "observer_gain_q",
        }
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.symbol(),
            Self::DeadTime => "dead-time voltage per phase",
            Self::DeadTimeWidth => "phase current below which less is lost",
            Self::DeadTimeRipple => "phase current's ripple between the carrier's halves",
            Self::AngleOffset => "angle read too large by",
            Self::OffsetAlpha => "current sensor offset, alpha",
            Self::OffsetBeta => "current sensor offset, beta",
            Self::ImbalanceAlpha => "current sensor imbalance, alpha",
            Self::ImbalanceBeta => "current sensor imbalance, beta",
            Self::TwoSensors(SensorPair::Ab) => "gain of current sensor a over that of b, less one",
            Self::TwoSensors(SensorPair::Bc) => "gain of current sensor b over that of c, less one",
            Self::TwoSensors(SensorPair::Ca) => "gain of current sensor c over that of a, less one",
            Self::SaturationD => "saturation of L_d per ampere of i_d",
            Self::SaturationQ => "saturation of L_q per ampere of i_q",
            Self::CrossSaturation => "cross saturation",
            Self::GainD => "observer gain, d",
            Self::GainQ => "observer gain, q",
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Motor(parameter) => parameter.unit(),
            Self::DeadTime => "V",
            Self::DeadTimeWidth | Self::DeadTimeRipple | Self::OffsetAlpha | Self::OffsetBeta => "A",
            Self::AngleOffset => "rad",
            Self::SaturationD | Self::SaturationQ | Self::CrossSaturation => "H/A",
            _ => "1",
        }
    }
}

/// The phases that have a current sensor, where only two have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SensorPair {
    /// a and b.
    Ab,
    /// b and c.
    Bc,
    /// c and a.
    Ca,
}

impl SensorPair {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Ab, Self::Bc, Self::Ca];

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

    /// Turn of the currents, rad, per unit of the difference: `1 / (2 sqrt 3)`, the part of that matrix which is a rotation.
    fn turn() -> f64 {
        0.5 / 3.0_f64.sqrt()
    }
}

impl From<Motor> for Adjustable {
    fn from(motor: Motor) -> Self {
        Self { motor, nuisance: Nuisance::default() }
    }
}

impl Adjustable {
    /// One number.
    pub fn get(&self, unknown: Unknown) -> f64 {
        let nuisance = &self.nuisance;
        match unknown {
            Unknown::Motor(parameter) => self.motor.get(parameter),
            Unknown::DeadTime => nuisance.dead_time,
            Unknown::DeadTimeWidth => nuisance.dead_time_width,
            Unknown::DeadTimeRipple => nuisance.dead_time_ripple,
            Unknown::AngleOffset => nuisance.angle_offset,
            Unknown::OffsetAlpha => nuisance.current_offset.alpha,
            Unknown::OffsetBeta => nuisance.current_offset.beta,
            Unknown::ImbalanceAlpha => nuisance.imbalance.alpha,
            Unknown::ImbalanceBeta => nuisance.imbalance.beta,
            Unknown::TwoSensors(_) => nuisance.current_turn / SensorPair::turn(),
            Unknown::SaturationD => nuisance.saturation.d,
            Unknown::SaturationQ => nuisance.saturation.q,
            Unknown::CrossSaturation => nuisance.cross_saturation,
            Unknown::GainD => nuisance.observer_gain.d,
            Unknown::GainQ => nuisance.observer_gain.q,
        }
    }

    /// The same with one number changed.
    pub fn with(mut self, unknown: Unknown, value: f64) -> Self {
        let nuisance = &mut self.nuisance;
        match unknown {
            Unknown::Motor(parameter) => {
                let mut values = self.motor.to_array();
                values[parameter as usize] = value;
                self.motor = Motor::from(values);
            }
            Unknown::DeadTime => nuisance.dead_time = value,
            Unknown::DeadTimeWidth => nuisance.dead_time_width = value,
            Unknown::DeadTimeRipple => nuisance.dead_time_ripple = value,
            Unknown::AngleOffset => nuisance.angle_offset = value,
            Unknown::OffsetAlpha => nuisance.current_offset.alpha = value,
            Unknown::OffsetBeta => nuisance.current_offset.beta = value,
            Unknown::ImbalanceAlpha => nuisance.imbalance.alpha = value,
            Unknown::ImbalanceBeta => nuisance.imbalance.beta = value,
            Unknown::TwoSensors(pair) => {
                let AlphaBeta { alpha, beta } = pair.imbalance();
                nuisance.imbalance = AlphaBeta { alpha: value * alpha, beta: value * beta };
                nuisance.current_turn = value * SensorPair::turn();
            }
            Unknown::SaturationD => nuisance.saturation.d = value,
            Unknown::SaturationQ => nuisance.saturation.q = value,
            Unknown::CrossSaturation => nuisance.cross_saturation = value,
            Unknown::GainD => nuisance.observer_gain.d = value,
            Unknown::GainQ => nuisance.observer_gain.q = value,
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Abc;

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
            let found = Adjustable::from(Motor::from([0.0; 4])).with(Unknown::TwoSensors(pair), e).nuisance;
            for i in [AlphaBeta { alpha: 1.0, beta: 0.0 }, AlphaBeta { alpha: 0.0, beta: 1.0 }] {
                let expected = read(i.to_abc(), high, low).to_alpha_beta();
                let AlphaBeta { alpha: a, beta: b } = found.imbalance;
                let turn = found.current_turn;
                let alpha = i.alpha - turn * i.beta + a * i.alpha + b * i.beta;
                let beta = i.beta + turn * i.alpha + b * i.alpha - a * i.beta;
                assert!((alpha - expected.alpha).hypot(beta - expected.beta) < 1e-12, "{pair:?}");
            }
        }
    }

    #[test]
    fn what_is_set_is_got() {
        use Unknown::*;
        let all = Parameter::ALL.map(Motor);
        let rest = [DeadTime, DeadTimeWidth, DeadTimeRipple, AngleOffset, OffsetAlpha, OffsetBeta, ImbalanceAlpha, ImbalanceBeta];
        let more = [TwoSensors(SensorPair::Bc), SaturationD, SaturationQ, CrossSaturation, GainD, GainQ];
        for unknown in all.into_iter().chain(rest).chain(more) {
            let found = Adjustable::from(crate::motor::Motor::from([1.0; 4])).with(unknown, 0.25).get(unknown);
            assert!((found - 0.25).abs() < 1e-15, "{unknown:?}");
        }
    }
}

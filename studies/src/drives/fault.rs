//! Faults of the drives, with sizes as drives have them.

use super::{between, between_decades};
use fluxfit::optimizer::Draws;
use fluxfit_drive::{
    Scenario,
    scenario::{FilterFrame, Harmonics},
};

/// Dead time, s; and the largest part of a carrier period that it takes.
const DEAD_TIME: [f64; 2] = [0.3e-6, 3e-6];
const MOST_DEAD: f64 = 0.02;
/// Voltage drop of a device, V; and its largest part of the DC voltage.
const DROP: [f64; 2] = [0.3, 1.5];
const MOST_DROP: f64 = 0.02;
/// Poles of the filters of currents and voltages, Hz, and of the speed, Hz; and the largest part of the sample rate.
const FILTER: [f64; 2] = [500.0, 4000.0];
const SPEED_FILTER: [f64; 2] = [10.0, 100.0];
const MOST_FILTER: f64 = 0.25;
/// Amplitude of each harmonic of the flux, of either sign: 0.5 to 5 % of the induced voltage for the 5th, 0.7 to 7 % for the 7th.
const HARMONIC: [f64; 2] = [0.001, 0.01];
/// Angle offset, electrical rad, of either sign.
const ANGLE_OFFSET: [f64; 2] = [0.02, 0.1];
/// Time by which the angle is late, s; and the largest angle of that at full speed, rad.
const ANGLE_DELAY: [f64; 2] = [5e-6, 60e-6];
const MOST_DELAY: f64 = 0.1;
/// Offset of each current sensor as a fraction of the rated current, and imbalance of their gains, either sign.
const CURRENT_OFFSET: f64 = 0.01;
const CURRENT_GAIN: f64 = 0.02;
/// Drift of R_s until the end.
const RS_DRIFT: [f64; 2] = [0.05, 0.2];

/// What is wrong with a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// Dead time.
    DeadTime,
    /// Voltage drops of the devices.
    DeviceDrop,
    /// Filtered currents.
    CurrentFilter,
    /// Filtered voltages.
    VoltageFilter,
    /// A speed that lags.
    SpeedFilter,
    /// Harmonics of the magnets' flux.
    Harmonics,
    /// An angle that is off.
    AngleOffset,
    /// An angle that is late.
    AngleDelay,
    /// Offsets of the current sensors.
    CurrentOffset,
    /// Gains of the current sensors that differ, but are right on average.
    CurrentGain,
    /// A resistance that drifts.
    RsDrift,
}

impl Fault {
    /// All.
    pub const ALL: [Self; 11] = [
        Self::DeadTime,
        Self::DeviceDrop,
        Self::CurrentFilter,
        Self::VoltageFilter,
        Self::SpeedFilter,
        Self::Harmonics,
        Self::AngleOffset,
        Self::AngleDelay,
        Self::CurrentOffset,
        Self::CurrentGain,
        Self::RsDrift,
    ];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::DeadTime => "dead time",
            Self::DeviceDrop => "device drops",
            Self::CurrentFilter => "current filter",
            Self::VoltageFilter => "voltage filter",
            Self::SpeedFilter => "lagging speed",
            Self::Harmonics => "flux harmonics",
            Self::AngleOffset => "angle offset",
            Self::AngleDelay => "late angle",
            Self::CurrentOffset => "current offsets",
            Self::CurrentGain => "current gains",
            Self::RsDrift => "drift of R_s",
        }
    }

    /// Puts it into a drive with this rated current, A, and full speed, electrical rad/s.
    pub(super) fn put_into(self, scenario: &mut Scenario, current: f64, speed: f64, draws: &mut Draws) {
        let Scenario { inverter, sensors, logging, motor, .. } = scenario;
        let filter = |draws: &mut Draws| Some(between_decades(draws, FILTER).min(MOST_FILTER * inverter.sample_rate()));
        match self {
            Self::DeadTime => inverter.dead_time = between_decades(draws, DEAD_TIME).min(MOST_DEAD / inverter.carrier),
            Self::DeviceDrop => {
                let drop = between(draws, DROP).min(MOST_DROP * inverter.u_dc);
                (inverter.switch_drop, inverter.diode_drop) = (drop, drop);
            }
            Self::CurrentFilter => (logging.filter_frame, logging.current_filter) = (FilterFrame::Dq, filter(draws)),
            Self::VoltageFilter => (logging.filter_frame, logging.voltage_filter) = (FilterFrame::Dq, filter(draws)),
            Self::SpeedFilter => logging.speed_filter = Some(between_decades(draws, SPEED_FILTER)),
            Self::Harmonics => {
                let mut amplitude = || either_sign(draws, HARMONIC);
                motor.harmonics = Harmonics { fifth: amplitude(), seventh: amplitude() };
            }
            Self::AngleOffset => sensors.angle_offset = either_sign(draws, ANGLE_OFFSET),
            Self::AngleDelay => sensors.angle_delay = between_decades(draws, ANGLE_DELAY).min(MOST_DELAY / speed),
            Self::CurrentOffset => {
                let most = CURRENT_OFFSET * current;
                sensors.current_offset = std::array::from_fn(|_| between(draws, [-most, most]));
            }
            Self::CurrentGain => {
                let mut error = || between(draws, [-CURRENT_GAIN, CURRENT_GAIN]);
                let (a, b) = (error(), error());
                sensors.current_gain = [1.0 + a, 1.0 + b, 1.0 - a - b];
            }
            Self::RsDrift => motor.rs_drift = between(draws, RS_DRIFT),
        }
    }
}

fn either_sign(draws: &mut Draws, range: [f64; 2]) -> f64 {
    let sign = if draws.uniform() < 0.5 { -1.0 } else { 1.0 };
    sign * between(draws, range)
}

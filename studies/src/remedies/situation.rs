//! The judged situations of `known`, made with this project's simulator, for any motor.
//!
//! The judged logs come from another simulator, so a measurement cannot be added to them. Their files say what was wrong with the drive and
//! what the motor did; the sizes are those of the electric bicycle there, and for another motor the same parts of its rating. What differs:
//! rows with jitter, which this simulator has not; the ripple of the currents, for the moment of sampling is not stated.

use crate::{drives::course::Course, rated::Rated};
use fluxfit::motor::Motor;
use fluxfit_drive::{
    Scenario,
    scenario::{Adc, Control, FilterFrame, Harmonics, Inverter, LoggedRows, Logging, Mechanics, Schedule, Sensors, SimulatedMotor, Update},
    schedule::{Profile, Ramp},
};
use std::f64::consts::TAU;

/// The motor of the judged logs: 48 V, 50 A, up to 1500 rad/s.
pub const BICYCLE: Rated = Rated {
    row: 0,
    motor: Motor { rs: 0.045, ld: 90e-6, lq: 120e-6, psi_f: 11e-3 },
    pole_pairs: 10,
    u_dc: 48.0,
    current: 50.0,
    omega_e: 1500.0,
};

/// Rows of a log at full rate, and the sample rate of the bicycle's drive, Hz. Other motors turn and settle as far per row.
const ROWS: f64 = 3200.0;
const SAMPLE_RATE: f64 = 16e3;
/// Noise of each current sensor as a part of the rated current, bits of the converter, and its range in rated currents.
const NOISE: f64 = 0.005;
const BITS: u32 = 12;
const RANGE: f64 = 2.0;
/// Bandwidth of the current loop as an angle per sample, rad.
const BANDWIDTH: f64 = 0.15;
/// Dead time as a part of the carrier's period: 0.8 us at 16 kHz.
const DEAD_TIME: f64 = 0.0128;
/// Drop of a device as a part of the DC voltage: 0.7 V of 48 V.
const DROP: f64 = 0.7 / 48.0;
/// Poles of the filters of currents and voltages, and of the speed, as parts of the sample rate: 1 kHz and 20 Hz of 16 kHz.
const FILTER: f64 = 1e3 / 16e3;
const SPEED_FILTER: f64 = 20.0 / 16e3;
/// Angle by which a late angle is off at full speed, rad: 40 us at 1500 rad/s.
const LATE: f64 = 0.06;
/// Seed of the noise.
const SEED: u64 = 77;
/// The part of a one-point log that is not logged: its beginning, until the currents have settled.
const UNTIL_SETTLED: f64 = 0.125;

/// What the motor does, beyond the courses that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moves {
    /// One of them.
    Course(Course),
    /// i_d in proportion to i_q, two loads on the way to full speed, two there.
    MaximumTorque,
    /// Beyond full speed, with the i_d that needs.
    Weakening,
    /// The first of two points.
    OnePoint,
}

/// A situation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation {
    /// Name of the judged log that it stands for.
    pub name: &'static str,
    moves: Moves,
    faults: &'static [Wrong],
}

/// What is wrong with the drive, or not logged; dead time is in every drive unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wrong {
    NoDeadTime,
    NoNoise,
    NoAngle,
    CurrentFilter,
    VoltageFilter,
    SpeedFilter,
    Every(u32),
    MeanOf(u32),
    UnequalSensors,
    LateAngle,
    Drift,
    Harmonics,
    AngleOffset,
    Drops,
}

use Course::{Acceleration, IdZero, Regeneration, Slow, Staircase, TwoPoints};
use Wrong::{
    AngleOffset, CurrentFilter, Drift, Drops, Every, LateAngle, MeanOf, NoAngle, NoDeadTime, NoNoise, SpeedFilter, UnequalSensors,
    VoltageFilter,
};

const fn of(name: &'static str, course: Course, faults: &'static [Wrong]) -> Situation {
    Situation { name, moves: Moves::Course(course), faults }
}

/// The judged situations.
pub const ALL: [Situation; 30] = [
    of("00_ideal", Staircase, &[NoDeadTime, NoNoise]),
    of("01_dead", Staircase, &[]),
    of("02_dead_nt", Staircase, &[NoAngle]),
    of("03_twopoint", TwoPoints, &[]),
    of("03_twopoint_nt", TwoPoints, &[NoAngle]),
    of("04_filter", Staircase, &[CurrentFilter]),
    of("04_filter_both", Staircase, &[CurrentFilter, VoltageFilter]),
    of("04_filter_nodead", Staircase, &[CurrentFilter, NoDeadTime]),
    of("04_filter_nt", Staircase, &[CurrentFilter, NoAngle]),
    of("05_dec10_mean", Staircase, &[MeanOf(10)]),
    of("05_dec10_slow", Slow, &[Every(10)]),
    of("05_dec10_slow_nodead", Slow, &[Every(10), NoDeadTime]),
    of("05_dec4_accel", Acceleration, &[Every(4)]),
    of("06_offsets_gains", Staircase, &[UnequalSensors]),
    of("06_offsets_gains_nt", Staircase, &[UnequalSensors, NoAngle]),
    of("07_angle_delay", Staircase, &[LateAngle]),
    of("09_rs_warms", Staircase, &[Drift]),
    of("10_harmonics", Staircase, &[Wrong::Harmonics]),
    of("10_harmonics_nt", Staircase, &[Wrong::Harmonics, NoDeadTime, NoAngle]),
    of("12_speed_lags", Acceleration, &[SpeedFilter]),
    of("12_speed_lags_nt", Acceleration, &[SpeedFilter, NoAngle]),
    of("13_jitter", Staircase, &[]),
    of("14_id0", IdZero, &[]),
    Situation { name: "14_mtpa", moves: Moves::MaximumTorque, faults: &[] },
    of("15_regen", Regeneration, &[]),
    Situation { name: "16_weakening", moves: Moves::Weakening, faults: &[] },
    of("17_angle_offset", Staircase, &[AngleOffset]),
    of("18_drops", Staircase, &[Drops]),
    of("18_drops_nt", Staircase, &[Drops, NoAngle]),
    Situation { name: "20_one_point_prior", moves: Moves::OnePoint, faults: &[NoDeadTime] },
];

impl Situation {
    /// The time before the log begins, s, of a drive with this scenario.
    pub fn unlogged(&self, scenario: &Scenario) -> f64 {
        if self.moves == Moves::OnePoint { UNTIL_SETTLED * scenario.duration } else { 0.0 }
    }

    /// The drive with a motor.
    pub fn scenario(&self, rated: &Rated) -> Scenario {
        let Rated { motor, current, u_dc, .. } = *rated;
        // The bicycle's motor turns 0.094 rad a row at full speed.
        let sample_rate = rated.omega_e * SAMPLE_RATE / BICYCLE.omega_e;
        let sample_rate = sample_rate.max(SAMPLE_RATE * (motor.rs / motor.ld.min(motor.lq)) / (BICYCLE.motor.rs / BICYCLE.motor.ld));
        let every = self.faults.iter().map(|fault| if let Every(n) | MeanOf(n) = fault { *n } else { 1 }).fold(1, u32::max);
        let mut scenario = Scenario {
            duration: ROWS * f64::from(every) / sample_rate,
            seed: SEED,
            motor: SimulatedMotor::new(motor.rs, motor.into(), rated.pole_pairs),
            mechanics: Mechanics::Dyno,
            inverter: Inverter { update: Update::Single, dead_time: DEAD_TIME / sample_rate, ..Inverter::ideal(u_dc, sample_rate) },
            control: Control { trip_current: 3.0 * current, ..Control::new(BANDWIDTH * sample_rate / TAU, 0.0, 1.5 * current) },
            sensors: Sensors { current_noise: NOISE * current, adc: Some(Adc { bits: BITS, range: RANGE * current }), ..Sensors::IDEAL },
            logging: Logging { every, ..Logging::COMPLETE },
            ..Scenario::paper()
        };
        let speed = rated.omega_e;
        self.faults.iter().for_each(|fault| fault.put_into(&mut scenario, current, speed));
        scenario.schedule = self.moves.schedule(scenario.duration, current, speed / f64::from(rated.pole_pairs));
        scenario
    }
}

impl Wrong {
    fn put_into(self, scenario: &mut Scenario, current: f64, speed: f64) {
        let Scenario { inverter, sensors, logging, motor, .. } = scenario;
        let filter = |part: f64| Some(part * inverter.sample_rate());
        match self {
            NoDeadTime => inverter.dead_time = 0.0,
            NoNoise => (sensors.current_noise, sensors.adc) = (0.0, None),
            NoAngle => (logging.theta_e, logging.u_dc) = (false, false),
            CurrentFilter => (logging.filter_frame, logging.current_filter) = (FilterFrame::Dq, filter(FILTER)),
            VoltageFilter => (logging.filter_frame, logging.voltage_filter) = (FilterFrame::Dq, filter(FILTER)),
            SpeedFilter => logging.speed_filter = filter(SPEED_FILTER),
            Every(_) => {}
            MeanOf(_) => logging.rows = LoggedRows::Mean,
            UnequalSensors => {
                sensors.current_gain = [1.02, 0.99, 1.0];
                sensors.current_offset = [0.01, -0.006, 0.004].map(|part| part * current);
            }
            LateAngle => sensors.angle_delay = LATE / speed,
            Drift => motor.rs_drift = 0.2,
            // 3 and 2 % of the induced voltage.
            Self::Harmonics => motor.harmonics = Harmonics { fifth: 0.03 / 5.0, seventh: 0.02 / 7.0 },
            AngleOffset => sensors.angle_offset = 0.06,
            Drops => (inverter.switch_drop, inverter.diode_drop) = (DROP * inverter.u_dc, DROP * inverter.u_dc),
        }
    }
}

impl Moves {
    /// Over a duration, s, with the largest current, A, and the full speed, mechanical rad/s.
    fn schedule(self, duration: f64, current: f64, speed: f64) -> Schedule {
        let steps = |levels: &[(f64, f64)], scale: f64| {
            Profile::new(levels.iter().map(|(at, to)| Ramp { at: at * duration, to: to * scale, over: 0.0 }).collect())
        };
        let ramp = |at: f64, to: f64, over: f64| Ramp { at: at * duration, to, over: over * duration };
        match self {
            Self::Course(course) => course.schedule(duration, current, speed),
            Self::MaximumTorque => Schedule {
                id: steps(&[(0.0, -0.09), (0.2, -0.24), (0.4, -0.15), (0.7, -0.27)], current),
                iq: steps(&[(0.0, 0.3), (0.2, 0.8), (0.4, 0.5), (0.7, 0.9)], current),
                speed: Profile::new(vec![ramp(0.0, 0.27 * speed, 0.0), ramp(0.1, speed, 0.4)]),
                ..Schedule::default()
            },
            Self::Weakening => Schedule {
                id: Profile::new(vec![ramp(0.2, -0.75 * current, 0.3), ramp(0.5, -0.9 * current, 0.5)]),
                iq: steps(&[(0.0, 0.3), (0.6, 0.5), (0.8, 0.25)], current),
                speed: Profile::new(vec![ramp(0.0, speed, 0.0), ramp(0.2, 1.75 * speed, 0.3)]),
                ..Schedule::default()
            },
            Self::OnePoint => {
                Schedule { iq: Profile::constant(0.5 * current), speed: Profile::constant(0.6 * speed), ..Schedule::default() }
            }
        }
    }
}

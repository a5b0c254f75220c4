//! The scenario: all settings of a simulation, in SI units.
//!
//! [`Scenario::paper`] is the paper's rig. [`Scenario::check`] refuses impossible settings; its errors name the keys of a scenario file.

mod check;
mod feasibility;
pub mod reference_cases;

use crate::{
    flux_map::{FluxLinkage, FluxMap},
    schedule::{Profile, Ramp},
};
use fluxfit::{frames::Dq, motor::Motor, paper};
use std::f64::consts::TAU;

/// A motor in a drive, with its schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Simulated time, s.
    pub duration: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The motor.
    pub motor: SimulatedMotor,
    /// Rotor and load, or a dynamometer.
    pub mechanics: Mechanics,
    /// The inverter.
    pub inverter: Inverter,
    /// The controllers.
    pub control: Control,
    /// References and loads over time.
    pub schedule: Schedule,
    /// The sensors.
    pub sensors: Sensors,
}

/// The simulated motor, whose parameters are the log's true ones.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedMotor {
    /// Stator resistance, ohm.
    pub rs: f64,
    /// Flux linkage as a function of current.
    pub magnetics: Magnetics,
    /// Pole pairs.
    pub pole_pairs: u32,
}

/// Flux linkage as a function of current.
#[derive(Debug, Clone, PartialEq)]
pub enum Magnetics {
    /// `psi_d = L_d i_d + psi_f`, `psi_q = L_q i_q`.
    Constant {
        /// d-axis inductance, H.
        ld: f64,
        /// q-axis inductance, H.
        lq: f64,
        /// Magnet flux linkage, Wb, peak per phase.
        psi_f: f64,
    },
    /// A measured flux map.
    Map(FluxMap),
}

/// The mechanics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mechanics {
    /// A free rotor with a load; the drive controls the speed.
    Free {
        /// Inertia of rotor and load, kg m².
        inertia: f64,
        /// Viscous friction, N m s.
        friction: f64,
    },
    /// A dynamometer, which imposes the scheduled speed; the drive controls the currents.
    Dyno,
}

/// The two-level inverter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverter {
    /// Whether the switching is simulated.
    pub modulation: Modulation,
    /// DC voltage, V.
    pub u_dc: f64,
    /// Amplitude of the DC voltage's sinusoidal ripple, V.
    pub ripple: f64,
    /// Frequency of that ripple, Hz.
    pub ripple_frequency: f64,
    /// Frequency of the carrier, Hz.
    pub carrier: f64,
    /// How often the duty ratios are updated.
    pub update: Update,
    /// Dead time: time for which both switches of a leg are off, s.
    pub dead_time: f64,
    /// Voltage drop of a conducting switch, V, without that of its resistance, which is part of `rs`.
    pub switch_drop: f64,
    /// Voltage drop of a conducting diode, V, likewise.
    pub diode_drop: f64,
    /// Standard deviation on each axis of a white voltage disturbance, V, constant over a sample period and unknown to the drive.
    pub voltage_noise: f64,
}

/// Whether the switching is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modulation {
    /// Each period's mean vector, constant in the stator frame.
    Averaged,
    /// Every switching instant of space vector modulation.
    Switched,
}

/// How often the duty ratios are updated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Update {
    /// Once per carrier period.
    Single,
    /// Twice per carrier period, at its extremes.
    Double,
}

/// The field-oriented control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// Bandwidth of the closed current loop, Hz, if it is well above that of the winding, `R/(2 pi L)`.
    pub current_bandwidth: f64,
    /// Bandwidth of the closed speed loop, Hz; not used with a dynamometer.
    pub speed_bandwidth: f64,
    /// Largest reference of the current vector, A.
    pub max_current: f64,
    /// Trip level of the overcurrent protection, A: largest true current vector at a sample.
    pub trip_current: f64,
    /// Field weakening: whether `i_d` is lowered at the voltage limit.
    pub field_weakening: bool,
}

/// References and loads over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Schedule {
    /// Reference of `i_d`, A.
    pub id: Profile,
    /// Reference of `i_q`, A; only with a dynamometer.
    pub iq: Profile,
    /// Speed reference, or speed of the dynamometer, mechanical rad/s.
    pub speed: Profile,
    /// Load torque, N m, in the negative direction of rotation at any speed.
    pub load: Profile,
    /// A test voltage added to the command, if any.
    pub injection: Option<Injection>,
}

/// A test voltage.
#[derive(Debug, Clone, PartialEq)]
pub struct Injection {
    /// The axis on which it acts.
    pub axis: Axis,
    /// Waveform.
    pub waveform: Waveform,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Amplitude over time, V.
    pub voltage: Profile,
}

/// An axis of the rotor frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along the magnet.
    D,
    /// 90 electrical degrees ahead of it.
    Q,
}

/// Waveform of a test voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Waveform {
    /// Sine wave.
    Sine,
    /// Square wave.
    Square,
}

/// Current sensors and encoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// How many phases have a current sensor.
    pub current_sensors: CurrentSensors,
    /// White noise of each current sample, standard deviation, A.
    pub current_noise: f64,
    /// Offset of each phase's sensor, A.
    pub current_offset: [f64; 3],
    /// Gain of each phase's sensor.
    pub current_gain: [f64; 3],
    /// The A/D converter of the currents; `None` for an ideal one.
    pub adc: Option<Adc>,
    /// Error of the measured angle, electrical rad.
    pub angle_offset: f64,
    /// Steps of the encoder per mechanical revolution; the angle is read as the middle of a step. `None`: angle and speed are exact.
    pub encoder_steps: Option<u32>,
}

/// How many phases have a current sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurrentSensors {
    /// Phases a and b; the current of c is minus their sum.
    Two,
    /// All phases.
    Three,
}

/// An analog to digital converter of currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adc {
    /// Number of bits.
    pub bits: u32,
    /// Largest current, A; the smallest is its negative.
    pub range: f64,
}

impl Sensors {
    /// Sensors without a fault.
    pub const IDEAL: Self = Self {
        current_sensors: CurrentSensors::Three,
        current_noise: 0.0,
        current_offset: [0.0; 3],
        current_gain: [1.0; 3],
        adc: None,
        angle_offset: 0.0,
        encoder_steps: None,
    };
}

impl Inverter {
    /// A switched inverter with double update and without losses.
    pub fn ideal(u_dc: f64, carrier: f64) -> Self {
        Self {
            modulation: Modulation::Switched,
            u_dc,
            ripple: 0.0,
            ripple_frequency: 0.0,
            carrier,
            update: Update::Double,
            dead_time: 0.0,
            switch_drop: 0.0,
            diode_drop: 0.0,
            voltage_noise: 0.0,
        }
    }

    /// Sample rate, Hz.
    pub fn sample_rate(&self) -> f64 {
        match self.update {
            Update::Single => self.carrier,
            Update::Double => 2.0 * self.carrier,
        }
    }

    /// Sample period, s.
    pub fn sample_period(&self) -> f64 {
        1.0 / self.sample_rate()
    }

    /// Length of the longest voltage vector without overmodulation, V.
    pub fn voltage_limit(&self) -> f64 {
        self.u_dc / 3.0_f64.sqrt()
    }
}

impl Control {
    /// Control without field weakening, and with a trip level of 1.5 times the largest current.
    pub fn new(current_bandwidth: f64, speed_bandwidth: f64, max_current: f64) -> Self {
        Self { current_bandwidth, speed_bandwidth, max_current, trip_current: 1.5 * max_current, field_weakening: false }
    }
}

impl SimulatedMotor {
    /// The flux linkage at a current, A; `None` outside of a flux map.
    #[inline]
    pub(crate) fn flux(&self, i: Dq) -> Option<FluxLinkage> {
        match &self.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => {
                Some(FluxLinkage { psi: Dq { d: ld * i.d + psi_f, q: lq * i.q }, inductance: [[*ld, 0.0], [0.0, *lq]] })
            }
            Magnetics::Map(map) => map.at(i),
        }
    }

    /// The motor with the constant parameters of zero current, which a flux map must contain.
    pub fn unsaturated(&self) -> Motor {
        match &self.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => Motor { rs: self.rs, ld: *ld, lq: *lq, psi_f: *psi_f },
            Magnetics::Map(_) => {
                let (ld, lq, psi_f) = self.flux(Dq::default()).map_or((f64::NAN, f64::NAN, f64::NAN), |flux| {
                    let [[ld, _], [_, lq]] = flux.inductance;
                    (ld, lq, flux.psi.d)
                });
                Motor { rs: self.rs, ld, lq, psi_f }
            }
        }
    }

    /// The current clamped to the range of a flux map.
    pub(crate) fn within_map(&self, i: Dq) -> Dq {
        match &self.magnetics {
            Magnetics::Constant { .. } => i,
            Magnetics::Map(map) => {
                let within = |[low, high]: [f64; 2], current: f64| current.clamp(low, high);
                Dq { d: within(map.id_range(), i.d), q: within(map.iq_range(), i.q) }
            }
        }
    }

    /// The true parameters, if they are constant.
    pub fn constant_parameters(&self) -> Option<Motor> {
        matches!(self.magnetics, Magnetics::Constant { .. }).then(|| self.unsaturated())
    }

    /// Torque, N m, from flux linkage and current.
    pub(crate) fn torque(&self, psi: Dq, i: Dq) -> f64 {
        1.5 * f64::from(self.pole_pairs) * (psi.d * i.q - psi.q * i.d)
    }
}

impl From<Motor> for Magnetics {
    fn from(motor: Motor) -> Self {
        Self::Constant { ld: motor.ld, lq: motor.lq, psi_f: motor.psi_f }
    }
}

impl Scenario {
    /// The paper's rig (its section 4.1): 1000 r/min against 10 N m with i_d = 0, then with i_d = -2 A; a switched inverter.
    ///
    /// Settings that the paper does not state are those of the independent logs in `examples/logs`: 310 V, a 5 kHz carrier with double
    /// update (10 kHz samples), bandwidths of 200 Hz and 20 Hz; full speed after 0.15 s, load from 0.2 s, i_d = -2 A from 0.6 s.
    pub fn paper() -> Self {
        Self {
            duration: 0.9,
            seed: 1,
            motor: SimulatedMotor { rs: paper::MOTOR.rs, magnetics: paper::MOTOR.into(), pole_pairs: paper::POLE_PAIRS },
            mechanics: Mechanics::Free { inertia: paper::INERTIA, friction: paper::FRICTION },
            inverter: Inverter::ideal(310.0, 5e3),
            control: Control::new(200.0, 20.0, 20.0),
            schedule: Schedule {
                id: Profile::new(vec![Ramp { at: 0.6, to: paper::ID, over: 0.0 }]),
                speed: Profile::new(vec![Ramp { at: 0.0, to: paper::SPEED_RPM * (TAU / 60.0), over: 0.15 }]),
                load: Profile::new(vec![Ramp { at: 0.2, to: paper::LOAD, over: 0.0 }]),
                ..Schedule::default()
            },
            sensors: Sensors::IDEAL,
        }
    }

    /// Number of samples.
    pub fn rows(&self) -> usize {
        // The sample at the end belongs to the log, even if rounding puts it just behind the end.
        const ROUNDING: f64 = 1e-6;
        (self.duration * self.inverter.sample_rate() + ROUNDING) as usize + 1
    }
}

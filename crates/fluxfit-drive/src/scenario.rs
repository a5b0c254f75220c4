//! The scenario: everything that a simulation depends on, in SI units. The same scenario and draw give the same bits.
//!
//! [`Scenario::paper`] is the paper's rig. A number that a drive cannot have is refused by [`Scenario::check`] with the name that a
//! scenario file gives it.

mod check;
pub mod exact;
mod reach;

use crate::{
    flux_map::{Flux, FluxMap},
    schedule::{Course, Move},
};
use fluxfit::{frames::Dq, motor::Motor, paper};
use std::f64::consts::TAU;

/// A motor in a drive, and what is asked of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Simulated time, s.
    pub duration: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The motor.
    pub motor: SimulatedMotor,
    /// What turns with it.
    pub mechanics: Mechanics,
    /// What feeds it.
    pub inverter: Inverter,
    /// What steers it.
    pub control: Control,
    /// What is asked of it.
    pub schedule: Schedule,
    /// What measures it.
    pub sensors: Sensors,
}

/// The motor that is simulated: the truth of the log.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedMotor {
    /// Stator resistance, ohm.
    pub rs: f64,
    /// What current makes of flux.
    pub magnetics: Magnetics,
    /// Pole pairs.
    pub pole_pairs: u32,
}

/// Flux linkage over current.
#[derive(Debug, Clone, PartialEq)]
pub enum Magnetics {
    /// `psi_d = L_d i_d + psi_f`, `psi_q = L_q i_q`.
    Constant {
        /// H.
        ld: f64,
        /// H.
        lq: f64,
        /// Wb, peak per phase.
        psi_f: f64,
    },
    /// A measured map.
    Map(FluxMap),
}

/// What turns with the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mechanics {
    /// Its own rotor and a load; the drive controls the speed.
    Free {
        /// kg m².
        inertia: f64,
        /// Viscous friction, N m s.
        friction: f64,
    },
    /// A dynamometer, which holds the scheduled speed whatever the motor does; the drive controls the currents.
    Dyno,
}

/// The two-level inverter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverter {
    /// How closely its switching is simulated.
    pub modulation: Modulation,
    /// DC voltage, V.
    pub u_dc: f64,
    /// Amplitude of the DC voltage's sinusoidal ripple, V.
    pub ripple: f64,
    /// Its frequency, Hz.
    pub ripple_frequency: f64,
    /// Frequency of the carrier, Hz.
    pub carrier: f64,
    /// How often it gets new duties.
    pub update: Update,
    /// Time for which both switches of a leg stay off, s.
    pub dead_time: f64,
    /// Voltage across a conducting switch beyond its resistance, which belongs to `rs`, V.
    pub switch_drop: f64,
    /// The same of a diode, V.
    pub diode_drop: f64,
    /// White noise of the vector that acts, on each axis, standard deviation, V: unknown to the drive, new each sample period.
    pub voltage_noise: f64,
}

/// How closely the switching is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modulation {
    /// Each period's mean vector, held in the stator.
    Averaged,
    /// Every switching instant of space vector modulation.
    Switched,
}

/// How often the inverter gets new duties.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Update {
    /// Once a carrier period.
    Single,
    /// At both extremes of the carrier.
    Double,
}

/// The field-oriented control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// Bandwidth of the closed current loop, Hz, where it is well above the winding's own `R/(2 pi L)`.
    pub current_bandwidth: f64,
    /// Bandwidth of the closed speed loop, Hz; a dynamometer has none.
    pub speed_bandwidth: f64,
    /// Largest current vector that it asks for, A.
    pub max_current: f64,
    /// Current vector, the true one at a sample, at which the drive trips, A.
    pub trip_current: f64,
    /// Whether `i_d` is lowered where the voltage runs out.
    pub field_weakening: bool,
}

/// What is asked of the drive, over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Schedule {
    /// Reference of `i_d`, A.
    pub id: Course,
    /// Reference of `i_q`, A; on a dynamometer alone.
    pub iq: Course,
    /// Speed, mechanical rad/s.
    pub speed: Course,
    /// Load torque, N m: against positive turning, whichever way the rotor turns.
    pub load: Course,
    /// A test voltage added to the command.
    pub injection: Option<Injection>,
}

/// A test voltage.
#[derive(Debug, Clone, PartialEq)]
pub struct Injection {
    /// Where it acts.
    pub axis: Axis,
    /// Its shape.
    pub waveform: Waveform,
    /// Hz.
    pub frequency: f64,
    /// Its amplitude over time, V.
    pub voltage: Course,
}

/// An axis of the rotor's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along the magnet.
    D,
    /// Across it.
    Q,
}

/// Shape of a test voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Waveform {
    /// A sine.
    Sine,
    /// Plus and minus the amplitude.
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
    /// The converter behind the current sensors.
    pub adc: Option<Adc>,
    /// What the encoder reads too much, electrical rad.
    pub angle_offset: f64,
    /// Steps of the encoder per mechanical turn, each read as its middle; none: angle and speed are known exactly.
    pub encoder_steps: Option<u32>,
}

/// How many phases have a current sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurrentSensors {
    /// Phases a and b; c is minus their sum.
    Two,
    /// All of them.
    Three,
}

/// An analog to digital converter of currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adc {
    /// Its bits.
    pub bits: u32,
    /// It reads currents from minus to plus this, A.
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

    /// Samples per second, Hz.
    pub fn sample_rate(&self) -> f64 {
        match self.update {
            Update::Single => self.carrier,
            Update::Double => 2.0 * self.carrier,
        }
    }

    /// Time from one sample to the next, s.
    pub fn sample_period(&self) -> f64 {
        1.0 / self.sample_rate()
    }

    /// Longest voltage vector that its modulation makes without distortion, V.
    pub fn voltage_limit(&self) -> f64 {
        self.u_dc / 3.0_f64.sqrt()
    }
}

impl Control {
    /// Control without field weakening that trips half above its current.
    pub fn new(current_bandwidth: f64, speed_bandwidth: f64, max_current: f64) -> Self {
        Self { current_bandwidth, speed_bandwidth, max_current, trip_current: 1.5 * max_current, field_weakening: false }
    }
}

impl SimulatedMotor {
    /// The flux at a current, A; none outside of a map.
    #[inline]
    pub(crate) fn flux(&self, i: Dq) -> Option<Flux> {
        match &self.magnetics {
            Magnetics::Constant { ld, lq, psi_f } => {
                Some(Flux { psi: Dq { d: ld * i.d + psi_f, q: lq * i.q }, inductance: [[*ld, 0.0], [0.0, *lq]] })
            }
            Magnetics::Map(map) => map.at(i),
        }
    }

    /// The motor with constant parameters that it is at zero current, which a map must hold.
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

    /// A current, or the nearest one along each axis that a map holds.
    pub(crate) fn within_map(&self, i: Dq) -> Dq {
        match &self.magnetics {
            Magnetics::Constant { .. } => i,
            Magnetics::Map(map) => {
                let within = |[low, high]: [f64; 2], current: f64| current.clamp(low, high);
                Dq { d: within(map.id_range(), i.d), q: within(map.iq_range(), i.q) }
            }
        }
    }

    /// The motor, if its parameters are constant: what an identification should find.
    pub fn constant(&self) -> Option<Motor> {
        matches!(self.magnetics, Magnetics::Constant { .. }).then(|| self.unsaturated())
    }

    /// Torque, N m, of flux and current.
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
    /// What the paper leaves open is chosen as the independent logs in `examples/logs` have it: 310 V, a 5 kHz carrier updated at
    /// both extremes (10 kHz samples), bandwidths of 200 Hz and 20 Hz; up to speed in 0.15 s, loaded at 0.2 s, the second mode from
    /// 0.6 s.
    pub fn paper() -> Self {
        Self {
            duration: 0.9,
            seed: 1,
            motor: SimulatedMotor { rs: paper::MOTOR.rs, magnetics: paper::MOTOR.into(), pole_pairs: paper::POLE_PAIRS },
            mechanics: Mechanics::Free { inertia: paper::INERTIA, friction: paper::FRICTION },
            inverter: Inverter::ideal(310.0, 5e3),
            control: Control::new(200.0, 20.0, 20.0),
            schedule: Schedule {
                id: Course::new(vec![Move { at: 0.6, to: paper::ID, over: 0.0 }]),
                speed: Course::new(vec![Move { at: 0.0, to: paper::SPEED_RPM * (TAU / 60.0), over: 0.15 }]),
                load: Course::new(vec![Move { at: 0.2, to: paper::LOAD, over: 0.0 }]),
                ..Schedule::default()
            },
            sensors: Sensors::IDEAL,
        }
    }

    /// Number of samples.
    pub fn rows(&self) -> usize {
        // The sample at the end, which rounding may put just behind it, belongs to the log.
        const ROUNDING: f64 = 1e-6;
        (self.duration * self.inverter.sample_rate() + ROUNDING) as usize + 1
    }
}

//! Gains of the current controllers for a given bandwidth, with intervals from those of the parameters.
//!
//! With the cross coupling fed forward, the plant of each axis is `1 / (L s + R_s)`. A PI controller `K_p + K_i / s` whose zero cancels
//! this pole makes the loop an integrator, and the closed loop a first-order lag with the bandwidth `omega_b`, rad/s:
//!
//! ```text
//! K_p = omega_b L     V/A, of L_d or L_q       K_i = omega_b R_s     V/(A s), the same on both axes
//! ```
//!
//! (internal model control: Harnefors and Nee, "Model-based current control of AC machines using the internal model control
//! method", IEEE Transactions on Industry Applications 34(1), 1998, DOI 10.1109/28.658735). Each gain is
//! proportional to one parameter, and so is its 95 % interval.
//!
//! The bandwidth is limited by the delay `T_d` from a sample to the voltage that is computed from it. A loop that is an integrator with
//! the crossover frequency `omega_b` has the
//!
//! ```text
//! phase margin = pi/2 - omega_b T_d
//! ```
//!
//! (Holmes, Lipo, McGrath and Kong, "Optimized design of stationary frame three phase AC current regulators", IEEE Transactions on
//! Power Electronics 24(11), 2009, DOI 10.1109/TPEL.2009.2029548).

use crate::{
    error::{Error, ErrorKind},
    identification::{
        explain::{judgement::Judgement, warning::Warning},
        judge::verdict::Verdict,
        prepare::model::SLOWEST_CONTROL,
        request::{Provenance, Request, Resolved},
    },
    log::Log,
    motor::{PARAMETERS, Parameter},
};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Delay from a sample to the middle of the voltage that is computed from it, control periods: one for the computation, half of one
/// for the zero-order hold. Holmes et al., section II.
pub const DELAY_PERIODS: f64 = 1.5;

/// Smallest phase margin, degrees, without a warning. The step response then overshoots by 5.7 % (numerical solution of the delay
/// equation); with [`DELAY_PERIODS`] that is a bandwidth of an eighteenth of the control rate.
pub const MIN_PHASE_MARGIN: f64 = 60.0;

/// Gains of both current controllers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CurrentLoop {
    /// Bandwidth of the closed loop (-3 dB, without delay), Hz.
    pub bandwidth: f64,
    /// Control rate: how often the controllers run, Hz, and where that value comes from.
    pub control_rate: Resolved<f64>,
    /// Proportional gain of the d axis, V/A; `None` if L_d is not identifiable.
    pub kp_d: Option<Gain>,
    /// Proportional gain of the q axis, V/A; `None` if L_q is not identifiable.
    pub kp_q: Option<Gain>,
    /// Integral gain of both axes, V/(A s); `None` if R_s is not identifiable.
    pub ki: Option<Gain>,
}

/// How often the current controllers run, Hz: as stated, else as often as the log's rows come.
///
/// # Errors
/// If nothing is stated and the rows are too slow for a drive's control.
pub fn control_rate(log: &Log, request: &Request) -> Result<Resolved<f64>, Error> {
    if let Some(rate) = request.control_rate {
        return Ok(Resolved { value: rate, provenance: Provenance::Stated });
    }
    let rate = 1.0 / log.segments().iter().map(|segment| segment.sample_period).fold(f64::INFINITY, f64::min);
    if rate < SLOWEST_CONTROL {
        Err(ErrorKind::ControlRate { rate }.into())
    } else {
        Ok(Resolved { value: rate, provenance: Provenance::Assumed })
    }
}

/// One gain, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Gain {
    /// Value.
    pub value: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
    /// The verdict on the parameter that it comes from.
    pub verdict: Verdict,
}

impl CurrentLoop {
    /// Gains for an identified motor.
    ///
    /// # Errors
    /// If the bandwidth or the control rate is no positive number.
    pub fn of(parameters: &[Judgement; PARAMETERS], bandwidth: f64, control_rate: Resolved<f64>) -> Result<Self, Error> {
        for (setting, value) in [("the bandwidth", bandwidth), ("the control rate", control_rate.value)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ErrorKind::Setting { setting, value, range: "a positive number of Hz" }.into());
            }
        }
        let gain = |parameter| Gain::of(&parameters[parameter as usize], TAU * bandwidth);
        Ok(Self { bandwidth, control_rate, kp_d: gain(Parameter::Ld), kp_q: gain(Parameter::Lq), ki: gain(Parameter::Rs) })
    }

    /// Phase margin, degrees, with [`DELAY_PERIODS`]; negative if the loop is unstable.
    pub fn phase_margin(&self) -> f64 {
        (FRAC_PI_2 - TAU * self.bandwidth * DELAY_PERIODS / self.control_rate.value).to_degrees()
    }

    /// The bandwidth, Hz, at which the phase margin is [`MIN_PHASE_MARGIN`].
    pub fn highest_bandwidth(&self) -> f64 {
        (FRAC_PI_2 - MIN_PHASE_MARGIN.to_radians()) * self.control_rate.value / (TAU * DELAY_PERIODS)
    }

    /// The warning about the phase margin, if it is small.
    pub fn warning(&self) -> Option<Warning> {
        // No warning at the highest bandwidth itself, which may be exceeded by rounding.
        if self.bandwidth <= self.highest_bandwidth() * (1.0 + 1e-9) {
            return None;
        }
        Some(Warning::PhaseMargin {
            bandwidth: self.bandwidth,
            margin: self.phase_margin(),
            control_rate: self.control_rate.value,
            rate_assumed: self.control_rate.provenance != Provenance::Stated,
            highest: self.highest_bandwidth(),
        })
    }
}

impl Gain {
    /// A parameter times the bandwidth, rad/s.
    fn of(judgement: &Judgement, omega_b: f64) -> Option<Self> {
        let (value, interval) = (judgement.value()?, judgement.interval()?);
        Some(Self { value: omega_b * value, interval: interval.map(|end| omega_b * end), verdict: judgement.verdict })
    }
}

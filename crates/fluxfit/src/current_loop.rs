//! The current controllers' gains for a wanted bandwidth, as sharp as the parameters that they come from.
//!
//! Each axis, its coupling to the other fed forward, is `1 / (L s + R_s)`. A PI controller `K_p + K_i / s` whose zero cancels that
//! pole leaves an integrator in the loop, and a closed loop of first order with the wanted bandwidth `omega_b`, rad/s:
//!
//! ```text
//! K_p = omega_b L     V/A, of L_d or L_q       K_i = omega_b R_s     V/(A s), the same on both axes
//! ```
//!
//! (internal model control: Harnefors and Nee, "Model-based current control of AC machines using the internal model control
//! method", IEEE Transactions on Industry Applications 34(1), 1998, DOI 10.1109/28.658735). Gains are linear in one parameter, so
//! their 95 % intervals are that parameter's, scaled.
//!
//! What limits the bandwidth is the delay between a sample and the voltage that answers it, `T_d`. An integrator that crosses at
//! `omega_b` keeps
//!
//! ```text
//! phase margin = pi/2 - omega_b T_d
//! ```
//!
//! (Holmes, Lipo, McGrath and Kong, "Optimized design of stationary frame three phase AC current regulators", IEEE Transactions on
//! Power Electronics 24(11), 2009, DOI 10.1109/TPEL.2009.2029548).

use crate::{
    error::Error,
    identify::{
        Identification, Provenance,
        verdict::{Judgement, Verdict},
        warning::Warning,
    },
    motor::Parameter,
};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Control periods from a sample to the middle of the voltage that answers it: one to compute, half of one that the vector is held.
/// Holmes et al., section II.
pub const DELAY: f64 = 1.5;

/// Least phase margin, degrees, that needs no warning. A step then overshoots by 5.7 % (the delay
/// equation integrated); with [`DELAY`] that is a bandwidth of an eighteenth of the control rate.
pub const PHASE_MARGIN: f64 = 60.0;

/// Gains of both current controllers.
#[derive(Debug, Clone, PartialEq)]
pub struct CurrentLoop {
    /// Wanted bandwidth of the closed loop (-3 dB, without delay), Hz.
    pub bandwidth: f64,
    /// How often the controllers run, Hz, and where that comes from.
    pub control_rate: (f64, Provenance),
    /// Proportional gain of the d axis, V/A; none where L_d means nothing.
    pub kp_d: Option<Gain>,
    /// Proportional gain of the q axis, V/A; none where L_q means nothing.
    pub kp_q: Option<Gain>,
    /// Integral gain of both axes, V/(A s); none where R_s means nothing.
    pub ki: Option<Gain>,
}

/// One gain, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gain {
    /// Value.
    pub value: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
    /// The verdict on the parameter that it comes from.
    pub verdict: Verdict,
}

impl CurrentLoop {
    /// Gains for a motor that was identified.
    ///
    /// # Errors
    /// If the bandwidth or the control rate is no positive number.
    pub fn of(found: &Identification, bandwidth: f64, control_rate: (f64, Provenance)) -> Result<Self, Error> {
        for (setting, value) in [("the bandwidth", bandwidth), ("the control rate", control_rate.0)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::Setting { setting, value, range: "a positive number of Hz" });
            }
        }
        let gain = |parameter| Gain::of(found.parameter(parameter), TAU * bandwidth);
        Ok(Self { bandwidth, control_rate, kp_d: gain(Parameter::Ld), kp_q: gain(Parameter::Lq), ki: gain(Parameter::Rs) })
    }

    /// Phase margin, degrees, with [`DELAY`]; negative where the loop is unstable.
    pub fn phase_margin(&self) -> f64 {
        (FRAC_PI_2 - TAU * self.bandwidth * DELAY / self.control_rate.0).to_degrees()
    }

    /// The bandwidth, Hz, that leaves [`PHASE_MARGIN`].
    pub fn highest_bandwidth(&self) -> f64 {
        (FRAC_PI_2 - PHASE_MARGIN.to_radians()) * self.control_rate.0 / (TAU * DELAY)
    }

    /// What the reader should know of the delay.
    pub fn warning(&self) -> Option<Warning> {
        // Rounding alone is no reason to warn at the highest bandwidth itself.
        if self.bandwidth <= self.highest_bandwidth() * (1.0 + 1e-9) {
            return None;
        }
        let margin = self.phase_margin();
        let outcome = if margin > 0.0 {
            format!("leaves a phase margin of {margin:.0} degrees, less than {PHASE_MARGIN:.0}")
        } else {
            "makes the loop unstable".to_owned()
        };
        let (rate, from) = self.control_rate;
        let assumed =
            if from == Provenance::Stated { "" } else { ", taken from the log; give --control-rate if the drive controls faster" };
        let message = format!(
            "a bandwidth of {:.0} Hz {outcome}, with {DELAY} periods of delay at {rate:.0} Hz{assumed}; ask for at most {:.0} Hz",
            self.bandwidth,
            self.highest_bandwidth().floor(),
        );
        Some(Warning { code: "phase-margin", message })
    }
}

impl Gain {
    /// A parameter times the bandwidth, rad/s.
    fn of(judgement: &Judgement, omega_b: f64) -> Option<Self> {
        let (value, interval) = (judgement.value()?, judgement.interval()?);
        Some(Self { value: omega_b * value, interval: interval.map(|end| omega_b * end), verdict: judgement.verdict })
    }
}

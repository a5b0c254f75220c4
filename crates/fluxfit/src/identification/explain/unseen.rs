//! Errors that no log shows, because currents, voltages and speed stay consistent with another motor: what they would do.

use super::super::{
    fit::{
        common_gains::{BY_CURRENTS, BY_VOLTAGES},
        finding::Finding,
        speed_scale::SpeedScale,
    },
    judge::verdict::Verdict,
    request::{Known, Request},
};
use super::temperature::COPPER;
use crate::{
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
};

/// An error that no log shows, and by which fraction a unit of it moves each parameter, in the order of [`Parameter::ALL`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Unseen {
    /// The error.
    pub error: UnseenError,
    /// Fractions of the parameters.
    pub moves: [f64; PARAMETERS],
}

/// What no log shows, in units of what drives have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnseenError {
    /// A gain common to all current sensors: read 1 % too large.
    CurrentGain,
    /// The DC voltage: read 1 % too large, and with it all commanded voltages.
    BusVoltage,
    /// The speed, where neither an angle nor the simulated currents confirm it: read 1 % too large. A wrong number of pole pairs is such an
    /// error, of tens of percent.
    SpeedScale,
    /// An angle that errs in proportion to the load: one electrical degree too large at the largest i_q.
    AngleWithLoad,
    /// The winding's temperature, where the log does not hold it: 10 K warmer than it was.
    Temperature,
}

/// An error that no log shows, but whose size is stated: the intervals count it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Counted {
    /// The error.
    pub error: UnseenError,
    /// Its largest size, as a fraction, to either side.
    pub accuracy: f64,
}

/// By which power of a factor of the speed each parameter moves: at constant currents voltages of speed are `omega_e L i` and
/// `omega_e psi_f`.
const BY_SPEED: [f64; PARAMETERS] = [0.0, -1.0, -1.0, -1.0];

/// The part of a percent.
const PERCENT: f64 = 0.01;

/// Kelvin that a winding's temperature is easily wrong by.
const KELVIN: f64 = 10.0;

/// One degree, rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Those that a request states, where anything was found.
pub(crate) fn counted(verdicts: [Verdict; PARAMETERS], request: &Request) -> Vec<Counted> {
    let stated = [UnseenError::CurrentGain, UnseenError::BusVoltage].into_iter().filter_map(|error| {
        let accuracy = error.accuracy(request)?;
        Some(Counted { error, accuracy })
    });
    stated.filter(|_| !nothing_found(verdicts)).collect()
}

fn nothing_found(verdicts: [Verdict; PARAMETERS]) -> bool {
    verdicts.iter().all(|verdict| *verdict == Verdict::NotIdentifiable)
}

/// All others, for the parameters that were found.
pub(crate) fn all(log: &Log, finding: &Finding, verdicts: [Verdict; PARAMETERS], speed: SpeedScale, request: &Request) -> Vec<Unseen> {
    if nothing_found(verdicts) {
        return Vec::new();
    }
    let Motor { lq, psi_f, .. } = finding.motor;
    let iq = log.columns().iq.iter().fold(0.0, |most: f64, iq| most.max(iq.abs()));
    // Along q the flux seems smaller by what of psi_f is turned there; in proportion to the current, that is an inductance.
    let is_found = |parameter: Parameter| verdicts[parameter as usize] != Verdict::NotIdentifiable;
    let of_angle = if is_found(Parameter::Lq) && is_found(Parameter::PsiF) && iq * lq != 0.0 { -DEGREE * psi_f / (lq * iq) } else { 0.0 };
    // What was given is not of the log, and no error of the log moves it.
    let of_log = request.known.map(|known| !matches!(known, Known::Fixed(_)));
    let unseen = [
        Unseen { error: UnseenError::CurrentGain, moves: BY_CURRENTS.map(|sign| PERCENT * sign) },
        Unseen { error: UnseenError::BusVoltage, moves: BY_VOLTAGES.map(|sign| PERCENT * sign) },
        Unseen { error: UnseenError::SpeedScale, moves: BY_SPEED.map(|sign| PERCENT * sign) },
        Unseen { error: UnseenError::AngleWithLoad, moves: [0.0, 0.0, of_angle, 0.0] },
        Unseen { error: UnseenError::Temperature, moves: [KELVIN * COPPER, 0.0, 0.0, 0.0] },
    ];
    let is_seen = |error| match error {
        UnseenError::Temperature => log.columns().temperature.is_some(),
        UnseenError::SpeedScale => speed != SpeedScale::Untold || log.columns().theta_e.is_some() || log.is_at_rest(),
        UnseenError::CurrentGain | UnseenError::BusVoltage | UnseenError::AngleWithLoad => false,
    };
    let is_left = |unseen: &Unseen| unseen.error.accuracy(request).is_none() && !is_seen(unseen.error);
    unseen.into_iter().filter_map(|unseen| unseen.of(of_log)).filter(is_left).collect()
}

impl Unseen {
    /// The same for some of the parameters; `None` if it moves none of them.
    pub(crate) fn of(&self, is_meant: [bool; PARAMETERS]) -> Option<Self> {
        let moves: [f64; PARAMETERS] = std::array::from_fn(|parameter| if is_meant[parameter] { self.moves[parameter] } else { 0.0 });
        moves.iter().any(|fraction| *fraction != 0.0).then_some(Self { moves, ..*self })
    }
}

impl UnseenError {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::CurrentGain => "current-gain",
            Self::BusVoltage => "bus-voltage",
            Self::SpeedScale => "speed-scale",
            Self::AngleWithLoad => "angle-with-load",
            Self::Temperature => "temperature",
        }
    }

    /// Its largest size, as a fraction, where the request states it.
    fn accuracy(self, request: &Request) -> Option<f64> {
        match self {
            Self::CurrentGain => request.current_accuracy,
            Self::BusVoltage => request.bus_accuracy,
            Self::SpeedScale | Self::AngleWithLoad | Self::Temperature => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The logs of ebike_07_angle_load: 1.6 mrad per ampere on 11 mWb and 120 uH take 0.0016 * 0.011 / 120e-6 = 14.7 % from L_q.
    #[test]
    fn an_angle_that_errs_with_the_load_passes_for_inductance() {
        let (psi_f, lq, iq) = (0.011, 120e-6, 40.0);
        let degrees = 0.0016 * iq / DEGREE;
        let per_degree = -DEGREE * psi_f / (lq * iq);
        assert!((degrees * per_degree + 0.1467).abs() < 1e-3);
    }
}

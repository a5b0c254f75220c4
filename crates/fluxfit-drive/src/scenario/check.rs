//! The check of a scenario before it is simulated: ranges of its settings, and what they require of each other.

use super::{Injection, Magnetics, Mechanics, Scenario};
use crate::{
    error::{BandwidthLimit, Error},
    range::{finite, not_negative, positive, setting},
    schedule::Profile,
    sensors::SPEED_OBSERVER,
};
use fluxfit::frames::Dq;
use std::f64::consts::TAU;

/// Largest number of rows of a log, which is held in memory: 2.4 GB, 50 minutes at 10 kHz.
const MAX_ROWS: f64 = 3e7;

/// Largest inductance, H. The windings of inverter-fed motors have less; a larger number lacks its unit.
const MAX_INDUCTANCE: f64 = 10.0;

/// Largest bandwidth of the current loop, as an angle per sample, rad. With a gain of twice the bandwidth and a delay of one and a
/// half periods the phase margin falls from 76 degrees to zero at 0.43.
const MAX_BANDWIDTH_ANGLE: f64 = 0.25;

/// Smallest ratio of the bandwidths of the current loop and the speed loop around it.
const CASCADE_RATIO: f64 = 3.0;

/// Smallest ratio of the bandwidths of the speed observer and the speed loop around it: the paper's rig is stable at 30 Hz and
/// oscillates at 35 Hz.
const OBSERVER_RATIO: f64 = 4.0;

/// Largest bandwidth of that observer as an angle per sample, rad: its double pole at 1 less this value is then well damped.
const MAX_OBSERVER_ANGLE: f64 = 0.5;

impl Scenario {
    /// Refuses a scenario that cannot be simulated; the error names the key of the scenario file.
    ///
    /// # Errors
    /// If a number is out of its range, settings exclude each other, the control would be unstable, or the schedule needs more current,
    /// voltage or flux than there is.
    pub fn check(&self) -> Result<(), Error> {
        self.check_numbers()?;
        self.sensors.check()?;
        self.motor.harmonics.check()?;
        self.check_compatibility()?;
        self.check_sampling()?;
        self.logging.check(self.rows(), self.inverter.sample_rate())?;
        self.check_feasibility()
    }

    fn check_numbers(&self) -> Result<(), Error> {
        positive("duration", self.duration)?;
        positive("motor.rs", self.motor.rs)?;
        if !(self.motor.rs_drift > -1.0 && self.motor.rs_drift.is_finite()) {
            return Err(setting("motor.rs_drift", self.motor.rs_drift, "a finite number above -1"));
        }
        if let Magnetics::Constant { ld, lq, psi_f } = self.motor.magnetics {
            positive("motor.ld", ld)?;
            positive("motor.lq", lq)?;
            if let Some((key, value)) = [("motor.ld", ld), ("motor.lq", lq)].into_iter().find(|(_, value)| *value > MAX_INDUCTANCE) {
                return Err(setting(key, value, "in henries and below 10; write its unit, as in \"5.25 mH\""));
            }
            not_negative("motor.psi_f", psi_f)?;
        }
        positive("motor.pole_pairs", f64::from(self.motor.pole_pairs))?;
        if let Mechanics::Free { inertia, friction } = self.mechanics {
            positive("mechanics.inertia", inertia)?;
            not_negative("mechanics.friction", friction)?;
        }
        self.inverter.check()?;
        positive("control.current_bandwidth", self.control.current_bandwidth)?;
        if matches!(self.mechanics, Mechanics::Free { .. }) {
            positive("control.speed_bandwidth", self.control.speed_bandwidth)?;
        }
        positive("control.max_current", self.control.max_current)?;
        if self.control.trip_current.is_nan() || self.control.trip_current <= self.control.max_current {
            return Err(setting("control.trip_current", self.control.trip_current, "above control.max_current"));
        }
        for (key, profile) in [
            ("schedule.id", &self.schedule.id),
            ("schedule.iq", &self.schedule.iq),
            ("schedule.speed", &self.schedule.speed),
            ("schedule.load", &self.schedule.load),
        ] {
            check_ramps(key, profile)?;
        }
        self.check_changes()?;
        if let Some(Injection { frequency, voltage, .. }) = &self.schedule.injection {
            positive("injection.frequency", *frequency)?;
            if *frequency > 0.5 * self.inverter.sample_rate() {
                return Err(setting("injection.frequency", *frequency, "at most half the sample rate"));
            }
            check_ramps("injection.voltage", voltage)?;
            if let Some(most) = voltage.ramps().iter().find(|amplitude| amplitude.to.abs() > self.inverter.voltage_limit()) {
                return Err(setting("injection.voltage", most.to, "at most u_dc / sqrt(3)"));
            }
        }
        Ok(())
    }

    fn check_changes(&self) -> Result<(), Error> {
        let keys = ["changes.rs", "changes.ld", "changes.lq", "changes.psi_f"];
        let is_map = matches!(self.motor.magnetics, Magnetics::Map(_));
        for (key, profile) in keys.into_iter().zip(&self.motor.changes) {
            check_ramps(key, profile)?;
            if let Some(gone) = profile.ramps().iter().find(|ramp| ramp.to <= -1.0) {
                return Err(setting(key, gone.to, "above -1: nothing of the parameter would be left"));
            }
            if is_map && key != "changes.rs" && !profile.is_zero() {
                let remedy = "a flux map does not change: leave it out";
                return Err(Error::Incompatible { key, with: "motor.ld, motor.lq and motor.psi_f", remedy });
            }
        }
        Ok(())
    }

    fn check_compatibility(&self) -> Result<(), Error> {
        match self.mechanics {
            Mechanics::Free { .. } if !self.schedule.iq.is_zero() => Err(Error::Incompatible {
                key: "schedule.iq",
                with: "mechanics.kind = \"dyno\"",
                remedy: "with a free rotor the speed loop sets i_q: give schedule.load instead",
            }),
            Mechanics::Dyno if !self.schedule.load.is_zero() => Err(Error::Incompatible {
                key: "schedule.load",
                with: "mechanics.kind = \"free\"",
                remedy: "a dynamometer holds its speed against any torque: give schedule.iq instead",
            }),
            _ => Ok(()),
        }
    }

    fn check_sampling(&self) -> Result<(), Error> {
        let sample_period = self.inverter.sample_period();
        let rows = self.duration * self.inverter.sample_rate();
        if rows > MAX_ROWS {
            return Err(Error::TooLong { duration: self.duration, rate: self.inverter.sample_rate(), rows, most: MAX_ROWS });
        }
        if rows < 1.0 {
            return Err(setting("duration", self.duration, "at least the time from one sample to the next"));
        }
        let motor = self.motor.unsaturated();
        let time_constant = motor.ld.min(motor.lq) / motor.rs.max(self.motor.rs_at(self.duration, 1.0));
        if sample_period > time_constant {
            let carrier = self.inverter.carrier * sample_period / time_constant;
            return Err(Error::SlowSampling { sample_period, time_constant, carrier: carrier.ceil() });
        }
        let most = MAX_BANDWIDTH_ANGLE / (TAU * sample_period);
        let value = self.control.current_bandwidth;
        if value > most {
            let limit = BandwidthLimit::SampleRate(self.inverter.sample_rate());
            return Err(Error::Bandwidth { key: "control.current_bandwidth", value, limit, most });
        }
        if self.sensors.encoder_steps.is_some() && SPEED_OBSERVER * sample_period > MAX_OBSERVER_ANGLE {
            let least = SPEED_OBSERVER / MAX_OBSERVER_ANGLE * self.inverter.carrier * sample_period;
            return Err(Error::SlowObserver { carrier: least.ceil() });
        }
        self.check_speed_loop()
    }

    fn check_speed_loop(&self) -> Result<(), Error> {
        let value = self.control.speed_bandwidth;
        let refused = |limit: BandwidthLimit, most: f64| Err(Error::Bandwidth { key: "control.speed_bandwidth", value, limit, most });
        let most = self.control.current_bandwidth / CASCADE_RATIO;
        let observer = SPEED_OBSERVER / TAU;
        match (self.mechanics, self.sensors.encoder_steps) {
            (Mechanics::Dyno, _) => Ok(()),
            (Mechanics::Free { .. }, _) if value > most => refused(BandwidthLimit::CurrentLoop(self.control.current_bandwidth), most),
            (Mechanics::Free { .. }, Some(_)) if value > observer / OBSERVER_RATIO => {
                refused(BandwidthLimit::SpeedObserver(observer), observer / OBSERVER_RATIO)
            }
            _ => Ok(()),
        }
    }

    /// The error of a current outside of the flux map.
    pub(crate) fn outside_map(&self, t: f64, i: Dq) -> Error {
        let (id_range, iq_range) = match &self.motor.magnetics {
            Magnetics::Map(map) => (map.id_range(), map.iq_range()),
            Magnetics::Constant { .. } => ([f64::NEG_INFINITY, f64::INFINITY], [f64::NEG_INFINITY, f64::INFINITY]),
        };
        Error::OutsideMap { t, id: i.d, iq: i.q, id_range, iq_range }
    }
}

fn check_ramps(key: &'static str, profile: &Profile) -> Result<(), Error> {
    for ramp in profile.ramps() {
        finite(key, ramp.to)?;
        for time in [ramp.at, ramp.over] {
            if !(time >= 0.0 && time.is_finite()) {
                return Err(Error::RampTime { key, time });
            }
        }
    }
    Ok(())
}

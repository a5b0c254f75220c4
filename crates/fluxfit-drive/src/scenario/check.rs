//! What no drive has, and what no drive can do: refused before anything is simulated.

use super::{Injection, Magnetics, Mechanics, Scenario};
use crate::error::Error;
use fluxfit::frames::Dq;
use std::f64::consts::TAU;

/// Most rows of a log, which is held in memory: 2.4 GB, 50 minutes at 10 kHz.
const MAX_ROWS: f64 = 3e7;

/// Largest bandwidth of the current loop, as an angle per sample, rad. With gains of twice the bandwidth and one and a half periods
/// of delay the loop's phase margin falls from 76 degrees to zero at 0.43.
const MAX_BANDWIDTH_ANGLE: f64 = 0.25;

/// The speed loop must be this many times slower than the current loop inside it.
const CASCADE: f64 = 3.0;

/// Steps in which weakening currents are tried.
const WEAKENING_STEPS: usize = 200;

impl Scenario {
    /// Refuses what cannot be simulated, in one sentence that names the key of a scenario file.
    ///
    /// # Errors
    /// If a number is out of its range, settings exclude each other, sampling or bandwidths make no stable control, or the schedule
    /// asks for more current, voltage or flux than there is.
    pub fn check(&self) -> Result<(), Error> {
        self.check_numbers()?;
        self.check_sensors()?;
        self.check_together()?;
        self.check_sampling()?;
        let mut times: Vec<f64> = self.courses().iter().flat_map(|course| course.moves()).flat_map(|m| [m.at, m.at + m.over]).collect();
        times.push(0.0);
        times.retain(|t| (0.0..=self.duration).contains(t));
        times.sort_by(f64::total_cmp);
        times.into_iter().try_for_each(|t| self.check_reach(t))
    }

    fn courses(&self) -> [&crate::schedule::Course; 4] {
        [&self.schedule.id, &self.schedule.iq, &self.schedule.speed, &self.schedule.load]
    }

    fn check_numbers(&self) -> Result<(), Error> {
        positive("duration", self.duration)?;
        positive("motor.rs", self.motor.rs)?;
        if let Magnetics::Constant { ld, lq, psi_f } = self.motor.magnetics {
            positive("motor.ld", ld)?;
            positive("motor.lq", lq)?;
            not_negative("motor.psi_f", psi_f)?;
        }
        positive("motor.pole_pairs", f64::from(self.motor.pole_pairs))?;
        if let Mechanics::Free { inertia, friction } = self.mechanics {
            positive("mechanics.inertia", inertia)?;
            not_negative("mechanics.friction", friction)?;
        }
        let inverter = &self.inverter;
        positive("inverter.u_dc", inverter.u_dc)?;
        not_negative("inverter.ripple", inverter.ripple)?;
        not_negative("inverter.ripple_frequency", inverter.ripple_frequency)?;
        positive("inverter.carrier", inverter.carrier)?;
        not_negative("inverter.dead_time", inverter.dead_time)?;
        not_negative("inverter.switch_drop", inverter.switch_drop)?;
        not_negative("inverter.diode_drop", inverter.diode_drop)?;
        if inverter.dead_time >= 0.25 / inverter.carrier {
            return Err(setting("inverter.dead_time", inverter.dead_time, "less than a quarter of the carrier's period"));
        }
        if inverter.ripple >= inverter.u_dc {
            return Err(setting("inverter.ripple", inverter.ripple, "less than inverter.u_dc"));
        }
        positive("control.current_bandwidth", self.control.current_bandwidth)?;
        if matches!(self.mechanics, Mechanics::Free { .. }) {
            positive("control.speed_bandwidth", self.control.speed_bandwidth)?;
        }
        positive("control.max_current", self.control.max_current)?;
        if self.control.trip_current.is_nan() || self.control.trip_current <= self.control.max_current {
            return Err(setting("control.trip_current", self.control.trip_current, "above control.max_current"));
        }
        for (key, course) in [
            ("schedule.id", &self.schedule.id),
            ("schedule.iq", &self.schedule.iq),
            ("schedule.speed", &self.schedule.speed),
            ("schedule.load", &self.schedule.load),
        ] {
            check_moves(key, course)?;
        }
        if let Some(Injection { frequency, voltage, .. }) = &self.schedule.injection {
            positive("injection.frequency", *frequency)?;
            check_moves("injection.voltage", voltage)?;
        }
        Ok(())
    }

    fn check_sensors(&self) -> Result<(), Error> {
        let sensors = &self.sensors;
        not_negative("sensors.current_noise", sensors.current_noise)?;
        sensors.current_offset.iter().try_for_each(|offset| finite("sensors.current_offset", *offset))?;
        sensors.current_gain.iter().try_for_each(|gain| positive("sensors.current_gain", *gain))?;
        finite("sensors.angle_offset", sensors.angle_offset)?;
        if let Some(adc) = sensors.adc {
            positive("sensors.adc_range", adc.range)?;
            if !(2..=32).contains(&adc.bits) {
                return Err(setting("sensors.adc_bits", f64::from(adc.bits), "from 2 to 32"));
            }
        }
        match sensors.encoder_steps {
            Some(steps) if steps < 16 => Err(setting("sensors.encoder_steps", f64::from(steps), "at least 16")),
            _ => Ok(()),
        }
    }

    fn check_together(&self) -> Result<(), Error> {
        match self.mechanics {
            Mechanics::Free { .. } if !self.schedule.iq.is_zero() => Err(Error::Together {
                key: "schedule.iq",
                with: "mechanics.kind = \"dyno\"",
                remedy: "with a rotor of its own the speed loop chooses i_q: ask for schedule.load instead",
            }),
            Mechanics::Dyno if !self.schedule.load.is_zero() => Err(Error::Together {
                key: "schedule.load",
                with: "mechanics.kind = \"free\"",
                remedy: "a dynamometer holds its speed against any torque: ask for schedule.iq instead",
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
        let time_constant = motor.ld.min(motor.lq) / motor.rs;
        if sample_period > time_constant {
            let carrier = self.inverter.carrier * sample_period / time_constant;
            return Err(Error::SlowSampling { sample_period, time_constant, carrier: carrier.ceil() });
        }
        let most = MAX_BANDWIDTH_ANGLE / (TAU * sample_period);
        let value = self.control.current_bandwidth;
        if value > most {
            let because = format!("{} samples a second", self.inverter.sample_rate());
            return Err(Error::Bandwidth { key: "control.current_bandwidth", value, because, most });
        }
        let most = value / CASCADE;
        if matches!(self.mechanics, Mechanics::Free { .. }) && self.control.speed_bandwidth > most {
            let because = format!("a current loop of {value} Hz inside");
            return Err(Error::Bandwidth { key: "control.speed_bandwidth", value: self.control.speed_bandwidth, because, most });
        }
        Ok(())
    }

    /// Whether the drive can stay at what the schedule asks for at time `t`.
    fn check_reach(&self, t: f64) -> Result<(), Error> {
        let speed = self.schedule.speed.at(t);
        let (asked, iq) = (self.schedule.id.at(t), self.schedule.iq.at(t));
        let (needed, available) = (asked.hypot(iq), self.control.max_current);
        if needed > available {
            return Err(Error::Reference { t, id: asked, iq, needed, available });
        }
        let first = self.steady_current(t, asked)?;
        let Err(error) = self.check_voltage(t, first, speed) else { return Ok(()) };
        let lowest = -self.control.max_current;
        let weakened = |step: usize| asked + (lowest - asked) * step as f64 / WEAKENING_STEPS as f64;
        let reachable = |id: f64| {
            let found = self.steady_current(t, id);
            found.is_ok_and(|i| self.check_voltage(t, i, speed).is_ok())
        };
        if self.control.field_weakening && (1..=WEAKENING_STEPS).any(|step| reachable(weakened(step))) { Ok(()) } else { Err(error) }
    }

    /// The current at which the schedule's torque is reached with this `i_d`; on a dynamometer the scheduled one.
    fn steady_current(&self, t: f64, id: f64) -> Result<Dq, Error> {
        let Mechanics::Free { friction, .. } = self.mechanics else { return Ok(Dq { d: id, q: self.schedule.iq.at(t) }) };
        let torque = self.schedule.load.at(t) + friction * self.schedule.speed.at(t);
        let available = self.control.max_current;
        let most = (available * available - id * id).max(0.0).sqrt().copysign(torque);
        let torque_at = |iq: f64| -> Result<f64, Error> {
            let i = Dq { d: id, q: iq };
            self.motor.flux(i).map(|flux| self.motor.torque(flux.psi, i)).ok_or_else(|| self.outside_map(t, i))
        };
        if torque == 0.0 {
            return torque_at(0.0).map(|_| Dq { d: id, q: 0.0 });
        }
        let reached = torque_at(most)?;
        // A current a thousandth of the largest one already shows whether the torque points the right way.
        if torque_at(1e-3 * available.copysign(torque))? * torque <= 0.0 {
            return Err(Error::NoTorque { t, id });
        }
        if reached.abs() < torque.abs() {
            let needed = id.hypot(if reached == 0.0 { f64::INFINITY } else { most * torque / reached });
            return Err(Error::Current { t, torque, id, needed, available });
        }
        // Torque rises with i_q: halve until rounding ends it.
        let (mut low, mut high) = (0.0, most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if torque_at(middle)?.abs() < torque.abs() { low = middle } else { high = middle }
        }
        Ok(Dq { d: id, q: high })
    }

    fn check_voltage(&self, t: f64, i: Dq, speed: f64) -> Result<(), Error> {
        let omega_e = speed * f64::from(self.motor.pole_pairs);
        let Some(flux) = self.motor.flux(i) else { return Err(self.outside_map(t, i)) };
        let u = Dq { d: self.motor.rs * i.d - omega_e * flux.psi.q, q: self.motor.rs * i.q + omega_e * flux.psi.d };
        let available = self.inverter.voltage_limit();
        if u.magnitude() <= available {
            return Ok(());
        }
        let (rpm, u_dc) = (speed * 60.0 / TAU, self.inverter.u_dc);
        let remedy = if self.control.field_weakening {
            "allow more current for the field weakening, with control.max_current"
        } else {
            "allow control.field_weakening"
        };
        Err(Error::Voltage { t, rpm, id: i.d, iq: i.q, needed: u.magnitude(), u_dc, available, remedy })
    }

    /// The error of a current beyond the map.
    pub(crate) fn outside_map(&self, t: f64, i: Dq) -> Error {
        let (id_range, iq_range) = match &self.motor.magnetics {
            Magnetics::Map(map) => (map.id_range(), map.iq_range()),
            Magnetics::Constant { .. } => ([f64::NEG_INFINITY, f64::INFINITY], [f64::NEG_INFINITY, f64::INFINITY]),
        };
        Error::OutsideMap { t, id: i.d, iq: i.q, id_range, iq_range }
    }
}

fn setting(key: &'static str, value: f64, range: &'static str) -> Error {
    Error::Setting { key, value, range }
}

fn positive(key: &'static str, value: f64) -> Result<(), Error> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number above zero")) }
}

fn not_negative(key: &'static str, value: f64) -> Result<(), Error> {
    if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number, zero or more")) }
}

fn finite(key: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() { Ok(()) } else { Err(setting(key, value, "a finite number")) }
}

fn check_moves(key: &'static str, course: &crate::schedule::Course) -> Result<(), Error> {
    for course in course.moves() {
        finite(key, course.to)?;
        for time in [course.at, course.over] {
            if !(time >= 0.0 && time.is_finite()) {
                return Err(Error::MoveTime { key, time });
            }
        }
    }
    Ok(())
}

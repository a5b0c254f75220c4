//! Whether the drive can stay at what its schedule asks for: current, torque, voltage, flux, wherever a move begins or ends.

use super::{Mechanics, Scenario};
use crate::{error::Error, schedule::Course};
use fluxfit::frames::Dq;
use std::f64::consts::{PI, TAU};

/// Steps in which weakening currents are tried.
const WEAKENING_STEPS: usize = 200;

/// Largest turn of the rotor from one sample to the next, rad: what a controller of sampled currents still follows.
const MAX_TURN: f64 = 0.5;

/// What the schedule asks for at one time.
struct Point {
    t: f64,
    id: f64,
    iq: f64,
    /// Mechanical rad/s.
    speed: f64,
    load: f64,
}

impl Scenario {
    /// Refuses a schedule that asks for more than there is, at the first such time.
    pub(super) fn check_reach(&self) -> Result<(), Error> {
        let schedule = &self.schedule;
        let courses = [&schedule.id, &schedule.iq, &schedule.speed, &schedule.load];
        let mut times: Vec<f64> = courses.iter().flat_map(|course| course.moves()).flat_map(|m| [m.at, m.at + m.over]).collect();
        times.extend([0.0, self.duration]);
        times.retain(|t| (0.0..=self.duration).contains(t));
        times.sort_by(f64::total_cmp);
        // Just before a move begins, a ramp may be at its end.
        let values = |t: f64, at: fn(&Course, f64) -> f64| Point {
            t,
            id: at(&schedule.id, t),
            iq: at(&schedule.iq, t),
            speed: at(&schedule.speed, t),
            load: at(&schedule.load, t),
        };
        times.iter().flat_map(|t| [values(*t, Course::before), values(*t, Course::at)]).try_for_each(|point| self.check_point(&point))
    }

    fn check_point(&self, point: &Point) -> Result<(), Error> {
        let Point { t, id, iq, speed, .. } = *point;
        let (needed, available) = (id.hypot(iq), self.control.max_current);
        if needed > available {
            return Err(Error::Reference { t, id, iq, needed, available });
        }
        let turn = (speed * f64::from(self.motor.pole_pairs)).abs() * self.inverter.sample_period();
        if turn > MAX_TURN {
            return Err(Error::FastRotation { t, rpm: rpm(speed), turn, carrier: (self.inverter.carrier * turn / MAX_TURN).ceil() });
        }
        let first = self.steady_current(point, id)?;
        let Err(error) = self.check_current(point, first) else { return Ok(()) };
        let weakened = |step: usize| id + (-available - id) * step as f64 / WEAKENING_STEPS as f64;
        let reachable = |id: f64| self.steady_current(point, id).is_ok_and(|i| self.check_current(point, i).is_ok());
        if self.control.field_weakening && (1..=WEAKENING_STEPS).any(|step| reachable(weakened(step))) { Ok(()) } else { Err(error) }
    }

    /// The current at which the schedule's torque is reached with this `i_d`; on a dynamometer the scheduled one.
    fn steady_current(&self, point: &Point, id: f64) -> Result<Dq, Error> {
        let Mechanics::Free { friction, .. } = self.mechanics else { return Ok(Dq { d: id, q: point.iq }) };
        let (t, torque) = (point.t, point.load + friction * point.speed);
        if torque == 0.0 {
            return Ok(Dq { d: id, q: 0.0 });
        }
        let available = self.control.max_current;
        let allowed = (available * available - id * id).max(0.0).sqrt();
        let most = self.motor.within_map(Dq { d: id, q: allowed.copysign(torque) }).q;
        let torque_at = |iq: f64| -> Result<f64, Error> {
            let i = Dq { d: id, q: iq };
            self.motor.flux(i).map(|flux| self.motor.torque(flux.psi, i)).ok_or_else(|| self.outside_map(t, i))
        };
        // A current a thousandth of the largest one already shows whether the torque points the right way.
        if torque_at(1e-3 * most)? * torque <= 0.0 {
            return Err(Error::NoTorque { t, id });
        }
        let reached = torque_at(most)?;
        if reached.abs() < torque.abs() {
            if most.abs() < allowed {
                return Err(self.outside_map(t, Dq { d: id, q: most }));
            }
            return Err(Error::Current { t, torque, id, needed: id.hypot(most * torque / reached), available });
        }
        // Torque rises with i_q: halve until rounding ends it.
        let (mut low, mut high) = (0.0, most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if torque_at(middle)?.abs() < torque.abs() { low = middle } else { high = middle }
        }
        Ok(Dq { d: id, q: high })
    }

    /// Whether flux map, converter and voltage reach as far as a current needs.
    fn check_current(&self, point: &Point, i: Dq) -> Result<(), Error> {
        let Point { t, speed, .. } = *point;
        let omega_e = speed * f64::from(self.motor.pole_pairs);
        let Some(flux) = self.motor.flux(i) else { return Err(self.outside_map(t, i)) };
        if let Some(adc) = self.sensors.adc.filter(|adc| i.magnitude() > adc.range) {
            return Err(Error::ConverterRange { t, needed: i.magnitude(), range: adc.range });
        }
        let u = Dq { d: self.motor.rs * i.d - omega_e * flux.psi.q, q: self.motor.rs * i.q + omega_e * flux.psi.d };
        let available = self.least_voltage();
        if u.magnitude() <= available {
            return Ok(());
        }
        let remedy = if self.control.field_weakening {
            "allow more current for the field weakening, with control.max_current"
        } else {
            "allow control.field_weakening"
        };
        let u_dc = self.inverter.u_dc;
        Err(Error::Voltage { t, rpm: rpm(speed), id: i.d, iq: i.q, needed: u.magnitude(), u_dc, available, remedy })
    }

    /// What the inverter makes at the ripple's lowest, after dead time and drops, which take `4/pi` of themselves along the current.
    fn least_voltage(&self) -> f64 {
        let inverter = &self.inverter;
        let lost = inverter.u_dc * inverter.dead_time * inverter.carrier + inverter.switch_drop.max(inverter.diode_drop);
        inverter.voltage_limit() - inverter.ripple / 3.0_f64.sqrt() - 4.0 / PI * lost
    }
}

fn rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

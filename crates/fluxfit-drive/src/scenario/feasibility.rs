//! Feasibility of the schedule: current, torque, voltage, flux and speed in the steady state at the ends of all ramps.

use super::{Mechanics, Scenario};
use crate::{error::Error, schedule::Profile};
use fluxfit::frames::Dq;
use std::f64::consts::{PI, TAU};

/// Number of field-weakening currents that are tried.
const WEAKENING_STEPS: usize = 200;

/// Largest angle of the rotor per sample period, electrical rad, for sampled current control.
const MAX_TURN: f64 = 0.5;

/// The schedule at one time.
struct ScheduledPoint {
    /// Time, s.
    t: f64,
    /// A.
    id: f64,
    /// A.
    iq: f64,
    /// Mechanical rad/s.
    speed: f64,
    /// N m.
    load: f64,
}

impl Scenario {
    /// Refuses a schedule that is not feasible, with its first infeasible point.
    pub(super) fn check_feasibility(&self) -> Result<(), Error> {
        let schedule = &self.schedule;
        let profiles = [&schedule.id, &schedule.iq, &schedule.speed, &schedule.load].into_iter().chain(&self.motor.changes);
        let mut times: Vec<f64> = profiles.flat_map(|profile| profile.ramps()).flat_map(|ramp| [ramp.at, ramp.at + ramp.over]).collect();
        times.extend([0.0, self.duration]);
        times.retain(|t| (0.0..=self.duration).contains(t));
        times.sort_by(f64::total_cmp);
        // Before and after a step at the same time.
        let point = |t: f64, at: fn(&Profile, f64) -> f64| ScheduledPoint {
            t,
            id: at(&schedule.id, t),
            iq: at(&schedule.iq, t),
            speed: at(&schedule.speed, t),
            load: at(&schedule.load, t),
        };
        times.iter().flat_map(|t| [point(*t, Profile::before), point(*t, Profile::at)]).try_for_each(|point| self.check_point(&point))
    }

    fn check_point(&self, point: &ScheduledPoint) -> Result<(), Error> {
        let ScheduledPoint { t, id, iq, speed, .. } = *point;
        let (needed, available) = (id.hypot(iq), self.control.max_current);
        if needed > available {
            return Err(Error::CurrentLimit { t, id, iq, needed, available });
        }
        let turn = (speed * f64::from(self.motor.pole_pairs)).abs() * self.inverter.sample_period();
        if turn > MAX_TURN {
            return Err(Error::FastRotation { t, rpm: rpm(speed), turn, carrier: (self.inverter.carrier * turn / MAX_TURN).ceil() });
        }
        let first = self.steady_current(point, id)?;
        let Err(error) = self.check_current(point, first) else { return Ok(()) };
        let weakened = |step: usize| id + (-available - id) * step as f64 / WEAKENING_STEPS as f64;
        let is_feasible = |id: f64| self.steady_current(point, id).is_ok_and(|i| self.check_current(point, i).is_ok());
        if self.control.field_weakening && (1..=WEAKENING_STEPS).any(|step| is_feasible(weakened(step))) { Ok(()) } else { Err(error) }
    }

    /// The current that gives the torque of load and friction with this `i_d`; with a dynamometer the scheduled current.
    fn steady_current(&self, point: &ScheduledPoint, id: f64) -> Result<Dq, Error> {
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
            self.motor.flux_at(i, t).map(|flux| self.motor.torque(flux.psi, i)).ok_or_else(|| self.outside_map(t, i))
        };
        // The torque at a thousandth of the largest current shows its direction.
        if torque_at(1e-3 * most)? * torque <= 0.0 {
            return Err(Error::NoTorque { t, id });
        }
        let reached = torque_at(most)?;
        if reached.abs() < torque.abs() {
            if most.abs() < allowed {
                return Err(self.outside_map(t, Dq { d: id, q: most }));
            }
            return Err(Error::TorqueLimit { t, torque, id, needed: id.hypot(most * torque / reached), available });
        }
        // Bisection to the last bits: the torque rises with i_q.
        let (mut low, mut high) = (0.0, most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if torque_at(middle)?.abs() < torque.abs() { low = middle } else { high = middle }
        }
        Ok(Dq { d: id, q: high })
    }

    /// Whether flux map, A/D converter and voltage suffice for a current.
    fn check_current(&self, point: &ScheduledPoint, i: Dq) -> Result<(), Error> {
        let ScheduledPoint { t, speed, .. } = *point;
        let omega_e = speed * f64::from(self.motor.pole_pairs);
        let Some(flux) = self.motor.flux_at(i, t) else { return Err(self.outside_map(t, i)) };
        if let Some(adc) = self.sensors.adc.filter(|adc| i.magnitude() > adc.range) {
            return Err(Error::ConverterRange { t, needed: i.magnitude(), range: adc.range });
        }
        let rs = self.motor.rs_at(t, t / self.duration);
        let u = Dq { d: rs * i.d - omega_e * flux.psi.q, q: rs * i.q + omega_e * flux.psi.d };
        let available = self.available_voltage();
        if u.magnitude() <= available {
            return Ok(());
        }
        let remedy = if self.control.field_weakening {
            "allow more current for field weakening, with control.max_current"
        } else {
            "allow control.field_weakening"
        };
        let u_dc = self.inverter.u_dc;
        Err(Error::VoltageLimit { t, rpm: rpm(speed), id: i.d, iq: i.q, needed: u.magnitude(), u_dc, available, remedy })
    }

    /// Smallest voltage limit, V: at the minimum of the DC ripple, less dead time and voltage drops, whose fundamental along the current
    /// is `4/pi` times their value.
    fn available_voltage(&self) -> f64 {
        let inverter = &self.inverter;
        let loss = inverter.u_dc * inverter.dead_time * inverter.carrier + inverter.switch_drop.max(inverter.diode_drop);
        inverter.voltage_limit() - inverter.ripple / 3.0_f64.sqrt() - 4.0 / PI * loss
    }
}

fn rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

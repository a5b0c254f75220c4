//! The two-level inverter, its settings and its faults: duty ratios to terminal voltages, averaged or switch by switch.
//!
//! Space vector modulation against a triangular carrier: the common mode `-(max + min)/2` is added to the three phase voltages.
//! A leg with the duty ratio `d` is high in the middle `d` of a carrier period; samples are taken at the carrier's extremes.
//!
//! Dead time: at an edge, the conducting switch opens at once and the other one closes `dead_time` later. In between a diode conducts:
//! the lower one if the current flows out of the leg, the upper one if it flows in. So one of the two edges of a pulse is delayed; which
//! one depends on the current at the start of the edge. Currents that change sign within the dead time are not clamped at zero.

use crate::{
    error::Error,
    plant::Plant,
    range::{not_negative, positive, setting},
};
use fluxfit::frames::{Abc, AlphaBeta};
use std::f64::consts::TAU;

/// Largest number of edges in a sample period: two halves of the carrier, three legs, each with an edge at the start and one within.
const MAX_EDGES: usize = 12;

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

    /// Refuses settings out of their ranges.
    pub(crate) fn check(&self) -> Result<(), Error> {
        positive("inverter.u_dc", self.u_dc)?;
        not_negative("inverter.ripple", self.ripple)?;
        not_negative("inverter.ripple_frequency", self.ripple_frequency)?;
        positive("inverter.carrier", self.carrier)?;
        not_negative("inverter.dead_time", self.dead_time)?;
        not_negative("inverter.switch_drop", self.switch_drop)?;
        not_negative("inverter.diode_drop", self.diode_drop)?;
        not_negative("inverter.voltage_noise", self.voltage_noise)?;
        if self.dead_time >= 0.25 / self.carrier {
            return Err(setting("inverter.dead_time", self.dead_time, "less than a quarter of the carrier's period"));
        }
        if self.ripple_frequency > self.sample_rate() {
            return Err(setting("inverter.ripple_frequency", self.ripple_frequency, "at most the sample rate"));
        }
        if self.ripple >= self.u_dc {
            return Err(setting("inverter.ripple", self.ripple, "less than inverter.u_dc"));
        }
        Ok(())
    }
}

/// The three-phase bridge with its state.
#[derive(Debug, Clone)]
pub struct Bridge {
    settings: Inverter,
    /// Whether the voltages depend on the signs of the currents.
    signs_matter: bool,
    legs: [Leg; 3],
    /// Whether legs switch from low to high in the next half of the carrier.
    rising: bool,
}

/// One leg.
#[derive(Debug, Clone, Copy, Default)]
struct Leg {
    /// Commanded state: whether high.
    commanded: bool,
    /// Actual state of the output: whether high.
    high: bool,
    /// Time in the period, s, at which the output follows the command, if it is delayed by the dead time.
    delayed_until: Option<f64>,
}

/// A commanded edge of a leg.
#[derive(Debug, Clone, Copy, Default)]
struct Edge {
    /// Time in the period, s.
    at: f64,
    leg: usize,
    /// State after the edge.
    high: bool,
}

/// Duty ratios of the three legs, 0 to 1, for a voltage vector, V, at a DC voltage, V: space vector modulation.
pub fn duties(u: AlphaBeta, u_dc: f64) -> [f64; 3] {
    let Abc { a, b, c } = u.to_abc();
    let middle = 0.5 * (a.max(b).max(c) + a.min(b).min(c));
    [a, b, c].map(|u| ((u - middle) / u_dc + 0.5).clamp(0.0, 1.0))
}

impl Bridge {
    /// A bridge with all legs low.
    pub fn new(settings: Inverter) -> Self {
        let Inverter { dead_time, switch_drop, diode_drop, .. } = settings;
        let signs_matter = dead_time > 0.0 || switch_drop > 0.0 || diode_drop > 0.0;
        Self { settings, signs_matter, legs: [Leg::default(); 3], rising: true }
    }

    /// DC voltage, V, at a time, s.
    pub fn u_dc(&self, t: f64) -> f64 {
        let Inverter { u_dc, ripple, ripple_frequency, .. } = self.settings;
        if ripple == 0.0 { u_dc } else { u_dc + ripple * (TAU * ripple_frequency * t).sin() }
    }

    /// Supplies the plant over the sample period that starts at `start`, s. False if the current leaves the flux map.
    #[must_use]
    pub fn run(&mut self, plant: &mut Plant, duties: [f64; 3], start: f64) -> bool {
        plant.begin_period();
        match self.settings.modulation {
            Modulation::Averaged => self.run_averaged(plant, duties, start),
            Modulation::Switched => self.run_switched(plant, duties, start),
        }
    }

    fn run_averaged(&self, plant: &mut Plant, duties: [f64; 3], start: f64) -> bool {
        let u = |i: [f64; 3], u_dc: f64| std::array::from_fn(|leg| self.mean_voltage(duties[leg], i[leg], u_dc));
        self.advance(plant, start, self.settings.sample_period(), u)
    }

    /// Mean output voltage of a leg over a period, V, with the current `i` flowing out of it.
    fn mean_voltage(&self, duty: f64, i: f64, u_dc: f64) -> f64 {
        let Inverter { carrier, dead_time, switch_drop, diode_drop, .. } = self.settings;
        // The voltage loss of the dead time cannot move the mean output beyond the rails.
        let duty = if duty > 0.0 && duty < 1.0 { (duty - sign(i) * dead_time * carrier).clamp(0.0, 1.0) } else { duty };
        let (high, low) = if i > 0.0 { (switch_drop, diode_drop) } else { (diode_drop, switch_drop) };
        duty * u_dc - sign(i) * (duty * high + (1.0 - duty) * low)
    }

    fn run_switched(&mut self, plant: &mut Plant, duties: [f64; 3], start: f64) -> bool {
        let period = self.settings.sample_period();
        let mut edges = [Edge::default(); MAX_EDGES];
        let count = self.edges(duties, &mut edges);
        let mut edges = edges[..count].iter().peekable();
        let mut now = 0.0;
        loop {
            let edge = edges.peek().map_or(f64::INFINITY, |edge| edge.at);
            let delayed = if self.settings.dead_time > 0.0 { self.next_delayed() } else { f64::INFINITY };
            let next = edge.min(delayed).min(period);
            let outputs = self.legs.map(|leg| leg.high);
            if !self.advance(plant, start + now, next - now, |i, u_dc| self.outputs(outputs, i, u_dc)) {
                return false;
            }
            now = next;
            if now >= period && edge >= period && delayed >= period {
                break;
            }
            if delayed <= edge {
                let due = self.legs.iter_mut().filter(|leg| leg.delayed_until == Some(delayed));
                due.for_each(|leg| (leg.high, leg.delayed_until) = (leg.commanded, None));
            } else if let Some(edge) = edges.next() {
                self.apply(edge, plant);
            }
        }
        // A delay beyond the end of the period continues in the next one.
        self.legs.iter_mut().for_each(|leg| leg.delayed_until = leg.delayed_until.map(|time| time - period));
        true
    }

    /// The time in the period, s, at which the first of the delayed outputs follows its command.
    fn next_delayed(&self) -> f64 {
        self.legs.iter().filter_map(|leg| leg.delayed_until).fold(f64::INFINITY, f64::min)
    }

    /// Applies an edge to its leg: both switches are off for the dead time, and the diode that conducts determines whether the output
    /// changes at once or after the dead time.
    fn apply(&mut self, edge: &Edge, plant: &Plant) {
        let dead_time = self.settings.dead_time;
        let out = if dead_time > 0.0 { phase_currents(plant)[edge.leg] } else { 0.0 };
        let leg = &mut self.legs[edge.leg];
        leg.commanded = edge.high;
        // While both switches are off, the output is low if the current flows out, and high if it flows in.
        let high = if dead_time > 0.0 && out != 0.0 { out < 0.0 } else { edge.high };
        (leg.high, leg.delayed_until) = (high, (high != edge.high).then_some(edge.at + dead_time));
    }

    /// Writes the edges of a sample period, in order, and returns their number.
    fn edges(&mut self, duties: [f64; 3], edges: &mut [Edge; MAX_EDGES]) -> usize {
        let half = 0.5 / self.settings.carrier;
        let halves = match self.settings.update {
            Update::Single => 2,
            Update::Double => 1,
        };
        let mut count = 0;
        let mut commanded = self.legs.map(|leg| leg.commanded);
        for part in 0..halves {
            let start = f64::from(part) * half;
            for leg in 0..3 {
                // In this half the leg is first low and then high, or first high and then low.
                let (at, first) = if self.rising { ((1.0 - duties[leg]) * half, false) } else { (duties[leg] * half, true) };
                for (at, high) in [(0.0, first), (at, !first)] {
                    let lasts = if high == first { duties[leg] != if first { 0.0 } else { 1.0 } } else { at < half };
                    if lasts && commanded[leg] != high {
                        edges[count] = Edge { at: start + at, leg, high };
                        count += 1;
                        commanded[leg] = high;
                    }
                }
            }
            self.rising = !self.rising;
        }
        edges[..count].sort_by(|a, b| a.at.total_cmp(&b.at));
        count
    }

    /// Output voltages of the legs, V, with the voltage drops of the conducting devices.
    fn outputs(&self, high: [bool; 3], i: [f64; 3], u_dc: f64) -> [f64; 3] {
        let Inverter { switch_drop, diode_drop, .. } = self.settings;
        std::array::from_fn(|leg| {
            let drop = if high[leg] == (i[leg] > 0.0) { switch_drop } else { diode_drop };
            (if high[leg] { u_dc } else { 0.0 }) - sign(i[leg]) * drop
        })
    }

    /// Integrates the plant over an interval, s, in steps; the signs of the currents and the DC voltage are constant over each step.
    fn advance(&self, plant: &mut Plant, start: f64, interval: f64, u: impl Fn([f64; 3], f64) -> [f64; 3]) -> bool {
        if interval <= 0.0 {
            return true;
        }
        let steps = plant.steps(interval);
        let h = interval / steps as f64;
        let stator = |[a, b, c]: [f64; 3]| Abc { a, b, c }.to_alpha_beta();
        if !self.signs_matter && self.settings.ripple == 0.0 {
            let u = stator(u([0.0; 3], self.settings.u_dc));
            return (0..steps).all(|_| plant.step(u, h));
        }
        (0..steps).all(|step| {
            let i = if self.signs_matter { phase_currents(plant) } else { [0.0; 3] };
            plant.step(stator(u(i, self.u_dc(start + (step as f64 + 0.5) * h))), h)
        })
    }
}

/// Currents out of the legs, A.
fn phase_currents(plant: &Plant) -> [f64; 3] {
    let Abc { a, b, c } = plant.stator_current().to_abc();
    [a, b, c]
}

/// The sign, zero at zero.
fn sign(i: f64) -> f64 {
    if i == 0.0 { 0.0 } else { i.signum() }
}

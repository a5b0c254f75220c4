//! The two-level inverter: duties to terminal voltages, averaged or switch by switch.
//!
//! Space vector modulation against a triangular carrier: the common mode `-(max + min)/2` is added to the three phase voltages.
//! A leg whose duty is `d` is high in the middle `d` of a carrier period; samples are taken at the carrier's extremes.
//!
//! Dead time: when a leg is told to change, the switch that conducts opens at once and the other one closes `dead_time` later.
//! Between the two the current chooses a diode: flowing out of the leg, the lower one; flowing in, the upper one. So of the two
//! edges one comes late, and which one is decided by the current at the edge's start. Currents that change sign within the dead
//! time are not clamped at zero.

use crate::{
    plant::Plant,
    scenario::{Inverter, Modulation, Update},
};
use fluxfit::frames::{Abc, AlphaBeta};
use std::f64::consts::TAU;

/// Most edges of a sample period: two halves of a carrier, three legs, each with an edge at its start and one within.
const MAX_EDGES: usize = 12;

/// The inverter at work.
#[derive(Debug, Clone)]
pub struct Bridge {
    settings: Inverter,
    legs: [Leg; 3],
    /// Whether the carrier's next half lets legs rise.
    rising: bool,
}

/// One leg.
#[derive(Debug, Clone, Copy, Default)]
struct Leg {
    /// What it was told to be.
    told: bool,
    /// What its output is.
    high: bool,
    /// When the output follows, if it is late, s into the period.
    late: Option<f64>,
}

/// A leg that is told to change.
#[derive(Debug, Clone, Copy, Default)]
struct Edge {
    /// s into the period.
    at: f64,
    leg: usize,
    to: bool,
}

/// Duties of the three legs, 0 to 1, that make a voltage vector, V, of a DC voltage, V.
pub fn duties(u: AlphaBeta, u_dc: f64) -> [f64; 3] {
    let Abc { a, b, c } = u.to_abc();
    let middle = 0.5 * (a.max(b).max(c) + a.min(b).min(c));
    [a, b, c].map(|u| ((u - middle) / u_dc + 0.5).clamp(0.0, 1.0))
}

impl Bridge {
    /// An inverter whose legs are low.
    pub fn new(settings: Inverter) -> Self {
        Self { settings, legs: [Leg::default(); 3], rising: true }
    }

    /// DC voltage, V, at a time, s.
    pub fn u_dc(&self, t: f64) -> f64 {
        let Inverter { u_dc, ripple, ripple_frequency, .. } = self.settings;
        if ripple == 0.0 { u_dc } else { u_dc + ripple * (TAU * ripple_frequency * t).sin() }
    }

    /// Feeds the plant over one sample period that starts at `start`, s. False where its current leaves the flux map.
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

    /// Mean over a period of a leg's output, V, while `i` flows out of it.
    fn mean_voltage(&self, duty: f64, i: f64, u_dc: f64) -> f64 {
        let Inverter { carrier, dead_time, switch_drop, diode_drop, .. } = self.settings;
        // A leg that hardly switches loses no more than it has: the rails are the limit.
        let duty = if duty > 0.0 && duty < 1.0 { (duty - sign(i) * dead_time * carrier).clamp(0.0, 1.0) } else { duty };
        let (high, low) = if i > 0.0 { (switch_drop, diode_drop) } else { (diode_drop, switch_drop) };
        duty * u_dc - sign(i) * (duty * high + (1.0 - duty) * low)
    }

    fn run_switched(&mut self, plant: &mut Plant, duties: [f64; 3], start: f64) -> bool {
        let period = self.settings.sample_period();
        let (edges, count) = self.edges(duties);
        let mut edges = edges[..count].iter().peekable();
        let mut now = 0.0;
        loop {
            let told = edges.peek().map_or(f64::INFINITY, |edge| edge.at);
            let late = self.legs.iter().filter_map(|leg| leg.late).fold(f64::INFINITY, f64::min);
            let next = told.min(late).min(period);
            let outputs = self.legs.map(|leg| leg.high);
            if !self.advance(plant, start + now, next - now, |i, u_dc| self.outputs(outputs, i, u_dc)) {
                return false;
            }
            now = next;
            if now >= period && told >= period && late >= period {
                break;
            }
            if late <= told {
                self.legs.iter_mut().filter(|leg| leg.late == Some(late)).for_each(|leg| (leg.high, leg.late) = (leg.told, None));
            } else if let Some(edge) = edges.next() {
                self.tell(edge, plant);
            }
        }
        // What is late beyond the period is late in the next one.
        self.legs.iter_mut().for_each(|leg| leg.late = leg.late.map(|late| late - period));
        true
    }

    /// A leg gets an edge: both its switches are off for the dead time, and a diode decides whether it follows at once, or late.
    fn tell(&mut self, edge: &Edge, plant: &Plant) {
        let dead_time = self.settings.dead_time;
        let out = if dead_time > 0.0 { phase_currents(plant)[edge.leg] } else { 0.0 };
        let leg = &mut self.legs[edge.leg];
        leg.told = edge.to;
        // While both switches are off, current that flows out holds the output low, and current that flows in holds it high.
        let held = if dead_time > 0.0 && out != 0.0 { out < 0.0 } else { edge.to };
        (leg.high, leg.late) = (held, (held != edge.to).then_some(edge.at + dead_time));
    }

    /// The edges of a sample period, in order; and how many they are.
    fn edges(&mut self, duties: [f64; 3]) -> ([Edge; MAX_EDGES], usize) {
        let half = 0.5 / self.settings.carrier;
        let halves = match self.settings.update {
            Update::Single => 2,
            Update::Double => 1,
        };
        let (mut edges, mut count) = ([Edge::default(); MAX_EDGES], 0);
        let mut told = self.legs.map(|leg| leg.told);
        for part in 0..halves {
            let start = f64::from(part) * half;
            for leg in 0..3 {
                // Over this half the leg is low up to an instant and high from there on, or the other way round.
                let (at, first) = if self.rising { ((1.0 - duties[leg]) * half, false) } else { (duties[leg] * half, true) };
                for (at, to) in [(0.0, first), (at, !first)] {
                    let lasts = if to == first { duties[leg] != if first { 0.0 } else { 1.0 } } else { at < half };
                    if lasts && told[leg] != to {
                        edges[count] = Edge { at: start + at, leg, to };
                        count += 1;
                        told[leg] = to;
                    }
                }
            }
            self.rising = !self.rising;
        }
        edges[..count].sort_by(|a, b| a.at.total_cmp(&b.at));
        (edges, count)
    }

    /// Outputs of the legs, V, with the drops of whatever conducts.
    fn outputs(&self, high: [bool; 3], i: [f64; 3], u_dc: f64) -> [f64; 3] {
        let Inverter { switch_drop, diode_drop, .. } = self.settings;
        std::array::from_fn(|leg| {
            let drop = if high[leg] == (i[leg] > 0.0) { switch_drop } else { diode_drop };
            (if high[leg] { u_dc } else { 0.0 }) - sign(i[leg]) * drop
        })
    }

    /// Integrates the plant over an interval, s, in steps; currents' signs and DC voltage are held over each.
    fn advance(&self, plant: &mut Plant, start: f64, interval: f64, u: impl Fn([f64; 3], f64) -> [f64; 3]) -> bool {
        if interval <= 0.0 {
            return true;
        }
        let steps = plant.steps(interval);
        let h = interval / steps as f64;
        let signs_matter = self.settings.dead_time > 0.0 || self.settings.switch_drop > 0.0 || self.settings.diode_drop > 0.0;
        (0..steps).all(|step| {
            let i = if signs_matter { phase_currents(plant) } else { [0.0; 3] };
            let [a, b, c] = u(i, self.u_dc(start + (step as f64 + 0.5) * h));
            plant.step(Abc { a, b, c }.to_alpha_beta(), h)
        })
    }
}

/// Currents out of the legs, A.
fn phase_currents(plant: &Plant) -> [f64; 3] {
    let Abc { a, b, c } = plant.current().to_alpha_beta(plant.theta_e()).to_abc();
    [a, b, c]
}

/// The sign, zero at zero.
fn sign(i: f64) -> f64 {
    if i == 0.0 { 0.0 } else { i.signum() }
}

//! The plant and its inverter against an adaptive solver (Dormand and Prince, order 8) of the same machine written differently: flux
//! linkages in the stator's frame, the switching worked out anew.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    frames::{Abc, AlphaBeta, Dq},
    paper,
};
use fluxfit_drive::{
    inverter::{Bridge, duties},
    plant::Plant,
    scenario::{Inverter, Mechanics, Modulation, Scenario, Update},
};
use ode_solvers::{Dop853, SVector, System};

/// Flux linkages alpha and beta, speed, electrical angle.
type State = SVector<f64, 4>;

const MOTOR: fluxfit::Motor = paper::MOTOR;
const POLE_PAIRS: f64 = 4.0;
const LOAD: f64 = 3.0;

struct Machine {
    u: AlphaBeta,
}

/// Rotor currents from stator fluxes, by hand: turn back, take the magnet off, divide.
fn current(state: &State) -> Dq {
    let psi = AlphaBeta { alpha: state[0], beta: state[1] }.to_dq(state[3]);
    Dq { d: (psi.d - MOTOR.psi_f) / MOTOR.ld, q: psi.q / MOTOR.lq }
}

impl System<f64, State> for Machine {
    fn system(&self, _: f64, state: &State, slope: &mut State) {
        let i = current(state).to_alpha_beta(state[3]);
        slope[0] = self.u.alpha - MOTOR.rs * i.alpha;
        slope[1] = self.u.beta - MOTOR.rs * i.beta;
        let torque = 1.5 * POLE_PAIRS * (state[0] * i.beta - state[1] * i.alpha);
        slope[2] = (torque - LOAD - paper::FRICTION * state[2]) / paper::INERTIA;
        slope[3] = POLE_PAIRS * state[2];
    }
}

fn integrate(state: State, u: AlphaBeta, interval: f64) -> State {
    if interval < 1e-15 {
        return state;
    }
    let mut solver = Dop853::new(Machine { u }, 0.0, interval, interval, state, 1e-13, 1e-13);
    solver.integrate().unwrap();
    *solver.y_out().last().unwrap()
}

/// One leg over one period: when it changes, and what it is before and after; from the carrier's definition.
fn changes(duty: f64, rising: bool, update: Update, half: f64) -> Vec<(f64, bool)> {
    match (update, rising) {
        (Update::Double, true) => vec![(0.0, false), ((1.0 - duty) * half, true)],
        (Update::Double, false) => vec![(0.0, true), (duty * half, false)],
        (Update::Single, _) => vec![(0.0, false), ((1.0 - duty) * half, true), ((1.0 + duty) * half, false)],
    }
}

/// The same machine and inverter over one period, switch by switch. A leg whose other switch must close first changes `dead_time` later.
fn oracle(mut state: State, legs: &mut [bool; 3], duties: [f64; 3], rising: bool, inverter: &Inverter) -> State {
    let (half, period) = (0.5 / inverter.carrier, inverter.sample_period());
    let told = |leg: usize| changes(duties[leg], rising, inverter.update, half).into_iter().map(move |(at, to)| (at, leg, to));
    let mut told: Vec<(f64, usize, bool)> = (0..3).flat_map(told).collect();
    let mut late: Vec<(f64, usize, bool)> = Vec::new();
    let mut now = 0.0;
    let take_first = |events: &mut Vec<(f64, usize, bool)>, before: f64| {
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events.first().is_some_and(|event| event.0 <= before).then(|| events.remove(0))
    };
    loop {
        let first_told = told.iter().map(|event| event.0).fold(period, f64::min);
        let (event, waited) = match take_first(&mut late, first_told) {
            Some(event) => (event, true),
            None => match take_first(&mut told, period) {
                Some(event) => (event, false),
                None => break,
            },
        };
        let (at, leg, to) = event;
        state = integrate(state, terminals(legs, inverter), at - now);
        now = at;
        let Abc { a, b, c } = current(&state).to_alpha_beta(state[3]).to_abc();
        let out = [a, b, c][leg];
        let waits = inverter.dead_time > 0.0 && if to { out > 0.0 } else { out < 0.0 };
        if waits && !waited && legs[leg] != to {
            late.push((at + inverter.dead_time, leg, to));
        } else {
            legs[leg] = to;
        }
    }
    assert!(late.is_empty(), "an edge waits beyond its period");
    integrate(state, terminals(legs, inverter), period - now)
}

fn terminals(legs: &[bool; 3], inverter: &Inverter) -> AlphaBeta {
    let [a, b, c] = legs.map(|high| if high { inverter.u_dc } else { 0.0 });
    Abc { a, b, c }.to_alpha_beta()
}

/// Largest relative distance of currents, speed and angle from the oracle's over some periods that start without current at speed.
fn distance(inverter: &Inverter, periods: usize) -> [f64; 3] {
    let motor = Scenario::paper().motor;
    let mechanics = Mechanics::Free { inertia: paper::INERTIA, friction: paper::FRICTION };
    let speed = 90.0;
    let mut plant = Plant::new(&motor, mechanics, speed);
    plant.load = LOAD;
    let mut bridge = Bridge::new(*inverter);
    let mut state = State::new(MOTOR.psi_f, 0.0, speed, 0.0);
    let (mut legs, mut rising) = ([false; 3], true);
    let mut worst = [0.0_f64; 3];
    for k in 0..periods {
        // The rig's own steady voltage, in the frame where the rotor will be: the current settles at about ten amperes.
        let angle = POLE_PAIRS * speed * (k as f64 + 0.5) * inverter.sample_period();
        let duties = duties(Dq { d: -43.0, q: 76.0 }.to_alpha_beta(angle), inverter.u_dc);
        assert!(bridge.run(&mut plant, duties, 0.0));
        state = match inverter.modulation {
            Modulation::Averaged => {
                let [a, b, c] = duties.map(|duty| duty * inverter.u_dc);
                integrate(state, Abc { a, b, c }.to_alpha_beta(), inverter.sample_period())
            }
            Modulation::Switched => oracle(state, &mut legs, duties, rising, inverter),
        };
        rising = !rising;
        let (ours, theirs) = (plant.current(), current(&state));
        let scale = theirs.magnitude().max(1.0);
        let now = [(ours.d - theirs.d).hypot(ours.q - theirs.q) / scale, plant.omega_m() / state[2] - 1.0, plant.theta_e() - state[3]];
        worst = std::array::from_fn(|k| worst[k].max(now[k].abs()));
    }
    worst
}

#[test]
fn currents_and_speed_are_an_adaptive_solvers() {
    let ideal = Inverter::ideal(310.0, 5e3);
    for (name, inverter) in [
        ("averaged", Inverter { modulation: Modulation::Averaged, ..ideal }),
        ("switched, double update", ideal),
        ("switched, single update", Inverter { update: Update::Single, ..ideal }),
        ("switched, dead time", Inverter { dead_time: 2e-6, ..ideal }),
        ("switched, single update, dead time", Inverter { update: Update::Single, dead_time: 2e-6, ..ideal }),
        ("one long period", Inverter { carrier: 1e3, ..ideal }),
    ] {
        let found = distance(&inverter, 100);
        println!("{name}: current {:.1e}, speed {:.1e}, angle {:.1e} rad", found[0], found[1], found[2]);
        assert!(found.iter().all(|distance| *distance < 1e-8), "{name}: {found:?}");
    }
}

//! The plant and its inverter against an adaptive solver (Dormand and Prince, order 8) of the same machine written differently: flux
//! linkages in the stator's frame, the switching worked out anew.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    frames::{Abc, AlphaBeta, Dq},
    optimizer::Draws,
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
/// At the start, mechanical rad/s.
const SPEED: f64 = 90.0;

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

/// One leg over one period: what it is told over which stretches; from the carrier's definition.
fn stretches(duty: f64, rising: bool, update: Update, half: f64) -> Vec<(f64, f64, bool)> {
    match (update, rising) {
        (Update::Double, true) => vec![(0.0, (1.0 - duty) * half, false), ((1.0 - duty) * half, half, true)],
        (Update::Double, false) => vec![(0.0, duty * half, true), (duty * half, half, false)],
        (Update::Single, _) => vec![
            (0.0, (1.0 - duty) * half, false),
            ((1.0 - duty) * half, (1.0 + duty) * half, true),
            ((1.0 + duty) * half, 2.0 * half, false),
        ],
    }
}

/// One leg of two switches and two diodes, in absolute time: a gate turns off at once and on after the dead time.
#[derive(Clone, Copy, Default)]
struct Gates {
    told: bool,
    /// When it was told so, s.
    since: f64,
    /// Current out of the leg at that time, A: which diode conducts while both switches are off.
    out: f64,
}

impl Gates {
    /// Whether the output is high at a time just after `t`.
    fn high(&self, t: f64, dead_time: f64) -> bool {
        let both_off = t < self.since + dead_time;
        if both_off && self.out != 0.0 { self.out < 0.0 } else { self.told }
    }
}

/// The same machine and inverter over the period that begins at `start`, gate by gate. An edge may wait beyond the period's end.
fn oracle(mut state: State, legs: &mut [Gates; 3], duties: [f64; 3], start: f64, rising: bool, inverter: &Inverter) -> State {
    let (half, end) = (0.5 / inverter.carrier, start + inverter.sample_period());
    let mut told: Vec<(f64, usize, bool)> = Vec::new();
    for leg in 0..3 {
        let mut before = legs[leg].told;
        for (from, to, high) in stretches(duties[leg], rising, inverter.update, half) {
            // What lasts no time is told to nobody.
            if to > from && high != before {
                told.push((start + from, leg, high));
                before = high;
            }
        }
    }
    let waiting = legs.iter().map(|leg| leg.since + inverter.dead_time);
    let mut times: Vec<f64> = told.iter().flat_map(|event| [event.0, event.0 + inverter.dead_time]).chain(waiting).collect();
    times.retain(|t| *t > start && *t < end);
    times.push(end);
    times.sort_by(f64::total_cmp);
    let mut now = start;
    for next in times {
        let Abc { a, b, c } = current(&state).to_alpha_beta(state[3]).to_abc();
        for (at, leg, high) in told.iter().filter(|event| event.0 == now) {
            legs[*leg] = Gates { told: *high, since: *at, out: [a, b, c][*leg] };
        }
        state = integrate(state, terminals(&legs.map(|leg| leg.high(now, inverter.dead_time)), inverter), next - now);
        now = next;
    }
    state
}

fn terminals(legs: &[bool; 3], inverter: &Inverter) -> AlphaBeta {
    let [a, b, c] = legs.map(|high| if high { inverter.u_dc } else { 0.0 });
    Abc { a, b, c }.to_alpha_beta()
}

/// Largest relative distance of currents, speed and angle from the oracle's over some periods that start without current at speed, with
/// the duties of each period, by its number.
fn distance(inverter: &Inverter, periods: usize, mut duties: impl FnMut(usize) -> [f64; 3]) -> [f64; 3] {
    let motor = Scenario::paper().motor;
    let mechanics = Mechanics::Free { inertia: paper::INERTIA, friction: paper::FRICTION };
    let mut plant = Plant::new(&motor, mechanics, SPEED);
    plant.load = LOAD;
    let mut bridge = Bridge::new(*inverter);
    let mut state = State::new(MOTOR.psi_f, 0.0, SPEED, 0.0);
    // Long before the start, all legs were told to be low.
    let (mut legs, mut rising) = ([Gates { since: -1.0, ..Gates::default() }; 3], true);
    let mut worst = [0.0_f64; 3];
    for k in 0..periods {
        let (duties, start) = (duties(k), k as f64 * inverter.sample_period());
        assert!(bridge.run(&mut plant, duties, start));
        state = match inverter.modulation {
            Modulation::Averaged => {
                let [a, b, c] = duties.map(|duty| duty * inverter.u_dc);
                integrate(state, Abc { a, b, c }.to_alpha_beta(), inverter.sample_period())
            }
            Modulation::Switched => oracle(state, &mut legs, duties, start, rising, inverter),
        };
        rising = !rising;
        let (ours, theirs) = (plant.current(), current(&state));
        let scale = theirs.magnitude().max(1.0);
        let now = [(ours.d - theirs.d).hypot(ours.q - theirs.q) / scale, (plant.omega_m() - state[2]) / SPEED, plant.theta_e() - state[3]];
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
        // The rig's own steady voltage, in the frame where the rotor will be: the current settles at about ten amperes.
        let turned = |k: usize| POLE_PAIRS * SPEED * (k as f64 + 0.5) * inverter.sample_period();
        let found = distance(&inverter, 100, |k| duties(Dq { d: -43.0, q: 76.0 }.to_alpha_beta(turned(k)), inverter.u_dc));
        println!("{name}: current {:.1e}, speed {:.1e}, angle {:.1e} rad", found[0], found[1], found[2]);
        assert!(found.iter().all(|distance| *distance < 1e-8), "{name}: {found:?}");
    }
}

/// Legs that stay where they are, pulses shorter than the dead time, edges that wait beyond the period or are called back: whatever a
/// controller may ask for.
#[test]
fn any_duties_with_any_dead_time_switch_as_gates_and_diodes_do() {
    for update in [Update::Single, Update::Double] {
        for dead_time in [0.0, 2e-6, 5e-6, 20e-6] {
            let inverter = Inverter { update, dead_time, ..Inverter::ideal(310.0, 5e3) };
            let mut draws = Draws::seeded(5, (1e6 * dead_time) as u64);
            let found = distance(&inverter, 300, |_| {
                std::array::from_fn(|_| {
                    let any = draws.uniform();
                    // Half of the duties are at a rail or almost, where edges are lost.
                    [0.0, 1.0, 0.003, 0.997].get((8.0 * draws.uniform()) as usize).copied().unwrap_or(any)
                })
            });
            println!("{update:?}, {dead_time} s: current {:.1e}, speed {:.1e}, angle {:.1e} rad", found[0], found[1], found[2]);
            // A lost pulse of 0.3 us is 1e-2 A; an edge decided by the wrong sign of the current far more.
            assert!(found.iter().all(|distance| *distance < 1e-7), "{update:?}, {dead_time}: {found:?}");
        }
    }
}

//! The intervals of the steady answer hold the truth as often as they say: Monte Carlo on windows with known noise.
//!
//! The data are equation (2) at a few operating points, with noise on voltages and currents; nothing of the program makes them.
//! `cargo test -p fluxfit --test all steady_statistics -- --nocapture` prints the table.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use fluxfit::{
    Model, Request, Swarm, TimeWindow,
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::{VoltageFrame, VoltageTiming},
    optimizer::Draws,
};

/// Steady voltages do not know their delay.
const NEXT: VoltageTiming = VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle };

const TRUTH: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Operating points: i_d (A), i_q (A), omega_e (electrical rad/s). The paper's two modes; a third at half the load; and i_d = 0
/// at two speeds and loads.
const PAPER: [(f64, f64, f64); 2] = [(0.0, 9.12, 418.879), (-2.0, 8.5, 418.879)];
const THREE: [(f64, f64, f64); 3] = [PAPER[0], PAPER[1], (-1.0, 4.5, 418.879)];
const ID_ZERO: [(f64, f64, f64); 2] = [PAPER[0], (0.0, 2.74, 209.44)];

/// Rows of a window, as in the logs that come with the paper's rig.
const ROWS: usize = 1151;

/// One row per millisecond: the rotor turns too far between rows for a zero-order-hold correction, of which these data know nothing.
const SAMPLE_PERIOD: f64 = 1e-3;

/// Noise of a channel: standard deviations of voltages (V) and currents (A), 0.5 % of the vectors, and the correlation from row to row.
struct Noise {
    voltage: f64,
    current: f64,
    rho: f64,
}

fn noisy_log(modes: &[(f64, f64, f64)], noise: &Noise, draws: &mut Draws) -> (Log, Vec<TimeWindow>) {
    let mut columns = Columns::default();
    let mut windows = Vec::new();
    for (mode, &(id, iq, omega_e)) in modes.iter().enumerate() {
        let u = TRUTH.steady_voltage(Dq { d: id, q: iq }, omega_e);
        let start = mode as f64 * 2.0;
        windows.push(TimeWindow { from: start - 0.5 * SAMPLE_PERIOD, to: start + (ROWS as f64 - 0.5) * SAMPLE_PERIOD });
        columns.t.extend((0..ROWS).map(|k| start + k as f64 * SAMPLE_PERIOD));
        columns.omega_e.extend([omega_e; ROWS]);
        for (column, mean, deviation) in [
            (&mut columns.ud, u.d, noise.voltage),
            (&mut columns.uq, u.q, noise.voltage),
            (&mut columns.id, id, noise.current),
            (&mut columns.iq, iq, noise.current),
        ] {
            let mut x = draws.normal();
            for _ in 0..ROWS {
                x = noise.rho * x + (1.0 - noise.rho * noise.rho).sqrt() * draws.normal();
                column.push(mean + deviation * x);
            }
        }
    }
    (Log::new(columns).unwrap(), windows)
}

/// What came out of many draws.
struct Outcome {
    /// Intervals that held the truth, per parameter.
    held: [usize; PARAMETERS],
    /// Answers given, per parameter.
    answered: [usize; PARAMETERS],
    /// Root mean square of error over stated standard error.
    ratio: [f64; PARAMETERS],
    /// Draws in which the points were found to contradict each other.
    misfits: usize,
}

fn outcome(modes: &[(f64, f64, f64)], rho: f64, draws_count: usize, seed: u64) -> Outcome {
    let noise = Noise { voltage: 0.5, current: 0.05, rho };
    let mut outcome = Outcome { held: [0; PARAMETERS], answered: [0; PARAMETERS], ratio: [0.0; PARAMETERS], misfits: 0 };
    for draw in 0..draws_count {
        let (log, windows) = noisy_log(modes, &noise, &mut Draws::seeded(seed, draw as u64));
        // Known exactly: no systematic part, no doubt of the timing; the swarm adds nothing here.
        let settings = Request {
            model: Some(Model::Steady),
            windows,
            voltage_timing: Some(NEXT),
            voltage_accuracy: 0.0,
            swarm: Swarm::Off,
            ..Request::default()
        };
        let found = identify(&log, &settings).unwrap().identification;
        outcome.misfits += usize::from(found.steady.as_ref().unwrap().misfit.is_some());
        for parameter in Parameter::ALL {
            let (p, judgement) = (parameter as usize, found.parameter(parameter));
            let error = judgement.raw - TRUTH.get(parameter);
            outcome.held[p] += usize::from(error.abs() <= judgement.uncertainty.half_width);
            outcome.answered[p] += usize::from(judgement.value().is_some());
            outcome.ratio[p] += (error / judgement.uncertainty.standard_error()).powi(2) / draws_count as f64;
        }
    }
    outcome.ratio = outcome.ratio.map(f64::sqrt);
    outcome
}

#[test]
fn a_hundred_intervals_hold_the_truth_as_often_as_they_should() {
    for rho in [0.0, 0.95] {
        let held = outcome(&PAPER, rho, 100, 7).held;
        // Binomial(100, 0.95) lies outside 88..=100 with probability 0.001; four parameters and two noises make it one in a hundred seeds.
        assert!(held.iter().all(|held| (88..=100).contains(held)), "rho {rho}: {held:?}");
    }
}

#[test]
fn two_thousand_intervals_hold_the_truth_between_93_and_97_percent() {
    for (name, modes) in [("two modes", &PAPER[..]), ("three points", &THREE[..])] {
        for rho in [0.0, 0.95] {
            let Outcome { held, ratio, misfits, .. } = outcome(modes, rho, 2000, 1);
            println!(
                "{name}, rho {rho}: coverage % {:?}, rms error over standard error {ratio:.2?}, misfits {misfits}",
                held.map(|held| held as f64 / 20.0)
            );
            assert!(held.iter().all(|held| (1860..=1940).contains(held)), "{name}, rho {rho}: {held:?}");
            // One in a thousand by design, on an F distribution that is only near: at most one in a hundred.
            assert!(misfits <= 20, "{name}, rho {rho}: {misfits} misfits");
        }
    }
}

#[test]
fn without_d_current_there_is_no_answer_for_ld_and_good_ones_for_the_others() {
    for rho in [0.0, 0.95] {
        let Outcome { held, answered, .. } = outcome(&ID_ZERO, rho, 500, 3);
        println!("i_d = 0, rho {rho}: coverage % {:?}, answers {answered:?}", held.map(|held| held as f64 / 5.0));
        // A chance in a thousand per draw that noise looks like excitation.
        assert!(answered[Parameter::Ld as usize] <= 3, "{answered:?}");
        for parameter in [Parameter::Rs, Parameter::Lq, Parameter::PsiF] {
            // 93 % less four binomial deviations of 500 draws; what L_d could do is in the interval, which may hold more.
            assert!(held[parameter as usize] >= 445, "rho {rho}: {held:?}");
            // Now and then the window's few degrees of freedom make an interval too wide for an answer.
            assert!(answered[parameter as usize] >= 490, "rho {rho}: {answered:?}");
        }
    }
}

/// Currents written with few digits, and too quiet to move across them: where within a step they were, no length of log tells.
/// The ramp between the points shows the steps.
#[test]
fn currents_on_a_coarse_grid_widen_the_intervals() {
    const STEP: f64 = 0.05;
    const RAMP: usize = 200;
    let draws_count = 300;
    let mut held = [0; PARAMETERS];
    for draw in 0..draws_count {
        let mut draws = Draws::seeded(9, draw);
        let mut within = || STEP * (draws.uniform() - 0.5);
        let (from, to) = ((within(), 9.0 + within()), (-0.5 + within(), 8.0 + within()));
        let mut columns = Columns::default();
        for k in 0..2 * ROWS + RAMP {
            let part = ((k as f64 - ROWS as f64) / RAMP as f64).clamp(0.0, 1.0);
            let (id, iq) = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
            let u = TRUTH.steady_voltage(Dq { d: id, q: iq }, 418.879);
            columns.t.push(k as f64 * SAMPLE_PERIOD);
            columns.ud.push(u.d + 0.5 * draws.normal());
            columns.uq.push(u.q + 0.5 * draws.normal());
            columns.id.push((id / STEP).round() * STEP);
            columns.iq.push((iq / STEP).round() * STEP);
            columns.omega_e.push(418.879);
        }
        let settings = Request {
            model: Some(Model::Steady),
            voltage_timing: Some(NEXT),
            voltage_accuracy: 0.0,
            swarm: Swarm::Off,
            ..Request::default()
        };
        let found = identify(&Log::new(columns).unwrap(), &settings).unwrap().identification;
        for parameter in Parameter::ALL {
            let judgement = found.parameter(parameter);
            held[parameter as usize] += usize::from((judgement.raw - TRUTH.get(parameter)).abs() <= judgement.uncertainty.half_width);
        }
    }
    println!("grid of {STEP} A: coverage % {:?}", held.map(|held| held as f64 / 3.0));
    // 95 % less five binomial deviations; more is no fault, an error within a step is bounded and not normal.
    assert!(held.iter().all(|held| *held >= 266), "{held:?}");
}

//! The logs whose pages the tests look at.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{Columns, Log, Model, Request, evidence::Identification, frames::Dq, identify, optimizer::Draws, paper};
use fluxfit_drive::{
    Scenario,
    schedule::{Profile, Ramp},
    simulate,
};
use fluxfit_report::{Options, Origin, Report};
use std::sync::LazyLock;

/// Rows of each operating point.
pub(crate) const ROWS: usize = 200;

/// A log of the paper's motor at these currents, A, at one speed; noise on the voltages, V.
pub(crate) fn log(currents: &[(f64, f64)], noise: f64) -> Log {
    let mut draws = Draws::seeded(3, 0);
    let mut columns = Columns::default();
    for (k, &(d, q)) in currents.iter().flat_map(|current| [current; ROWS]).enumerate() {
        let u = paper::MOTOR.steady_voltage(Dq { d, q }, 400.0);
        let row = [k as f64 * 1e-3, u.d + noise * draws.normal(), u.q + noise * draws.normal(), d, q, 400.0];
        let Columns { t, ud, uq, id, iq, omega_e, .. } = &mut columns;
        [t, ud, uq, id, iq, omega_e].into_iter().zip(row).for_each(|(column, value)| column.push(value));
    }
    Log::new(columns).unwrap()
}

pub(crate) const TWO: [(f64, f64); 2] = [(0.0, 9.0), (-2.0, 8.5)];

pub(crate) fn origin() -> Origin {
    Origin { command: "fluxfit identify 'a log.csv'".to_owned(), version: "0.1.0".to_owned(), seed: 7 }
}

/// A report of an identification, without a method.
pub(crate) fn report<'a>(log: &'a Log, found: &'a Identification, origin: &'a Origin) -> Report<'a> {
    let operating_points = found.operating_points();
    Report {
        title: "x",
        log,
        notes: &[],
        operating_points,
        identification: Some((found, None)),
        held_out: None,
        study: None,
        online: None,
        json: None,
        options: Options::default(),
        origin,
    }
}

/// A log of the paper's motor as a drive records it: up to speed in 0.1 s, a step of i_d on the way; noise of 50 mA on each current.
/// After 0.08 s it is only recorded again from `resumed` s on.
pub(crate) fn recorded(resumed: f64, change: impl Fn(&mut Scenario)) -> Log {
    let mut scenario = Scenario { duration: 0.16, ..Scenario::paper() };
    let step = |at, to| Profile::new(vec![Ramp { at, to, over: 0.0 }]);
    scenario.schedule.speed = Profile::new(vec![Ramp { at: 0.0, to: 100.0, over: 0.1 }]);
    (scenario.schedule.load, scenario.schedule.id) = (step(0.05, 5.0), step(0.04, -2.0));
    scenario.sensors.current_noise = 0.05;
    change(&mut scenario);
    let all = simulate(&scenario, 0, || ()).unwrap().columns;
    let kept: Vec<usize> = (0..all.t.len()).filter(|row| !(0.08..resumed).contains(&all.t[*row])).collect();
    let of = |column: &[f64]| kept.iter().map(|row| column[*row]).collect::<Vec<f64>>();
    let [t, ud, uq, id, iq, omega_e] = [&all.t, &all.ud, &all.uq, &all.id, &all.iq, &all.omega_e].map(|column| of(column));
    Log::new(Columns { t, ud, uq, id, iq, omega_e, theta_e: all.theta_e.as_deref().map(of), ..Columns::default() }).unwrap()
}

pub(crate) fn of_currents() -> Request {
    Request { model: Some(Model::OutputError), ..Request::default() }
}

/// A log with its identification by simulated currents, which many tests look at and which takes a while in a debug build.
#[derive(Clone)]
pub(crate) struct Found {
    pub(crate) log: Log,
    pub(crate) found: Identification,
}

impl Found {
    fn of(log: Log) -> Self {
        let found = identify(&log, &of_currents()).unwrap().identification;
        Self { log, found }
    }
}

/// Without a gap.
pub(crate) static WHOLE: LazyLock<Found> = LazyLock::new(|| Found::of(recorded(0.08, |_| ())));

/// With a gap of 10 ms.
pub(crate) static INTERRUPTED: LazyLock<Found> = LazyLock::new(|| Found::of(recorded(0.09, |_| ())));

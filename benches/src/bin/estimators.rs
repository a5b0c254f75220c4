//! Nanoseconds a sample of the recursive estimators, as JSON: one Kalman filter, a bank of six one by one and in lanes, block least
//! squares, and the estimator that `fluxfit track` has by default. `estimators.py` calls it.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use fluxfit::{log::Row, paper};
use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, Period, bank::Together};
use fluxfit_drive::{Scenario, simulate};
use fluxfit_track::{Beginning, DriveFaults, Estimator, Event, Method, Start, Stream, Timing, bank};
use serde::Serialize;
use std::{error::Error, hint::black_box};

/// Repetitions, of which the fastest counts: other work on the machine only slows one.
const REPEATS: usize = 15;

/// Rated current, A.
const CURRENT: f64 = 10.0;

/// Levels of unknown voltage of the bank, V.
const LEVELS: [f64; 6] = [0.0, 0.03, 0.1, 0.3, 1.0, 3.0];

#[derive(Serialize)]
struct Times {
    kalman_filter_ns: f64,
    bank_one_by_one_ns: f64,
    bank_ns: f64,
    default_first_ns: f64,
    default_later_ns: f64,
    block_least_squares_ns: f64,
}

/// The periods of one second of the paper's rig, as a stream sees them.
fn events() -> Result<Vec<Event>, Box<dyn Error>> {
    let recording = simulate(&Scenario { duration: 1.0, ..Scenario::paper() }, 0, || ())?;
    let (columns, mut stream) = (&recording.columns, Stream::new(Timing::Delayed { delay: 1, at_row: false }, DriveFaults::default()));
    let row = |k: usize| Row {
        t: columns.t[k],
        ud: recording.ud_ref[k],
        uq: recording.uq_ref[k],
        id: columns.id[k],
        iq: columns.iq[k],
        omega_e: columns.omega_e[k],
        ..Row::default()
    };
    Ok((0..columns.t.len()).filter_map(|k| stream.push(&row(k))).collect())
}

/// CPU time per event of a pass, ns, the fastest of all; how it begins takes no part in the time.
fn nanoseconds<S>(events: &[Event], begin: impl Fn() -> S, pass: impl Fn(&mut S, &[Event])) -> f64 {
    let once = || {
        let mut state = begin();
        let start = ProcessTime::now();
        pass(&mut state, events);
        let elapsed = start.elapsed().as_secs_f64();
        black_box(state);
        elapsed
    };
    1e9 * (0..REPEATS).map(|_| once()).fold(f64::INFINITY, f64::min) / events.len() as f64
}

fn filter(unknown_voltage: f64) -> Ekf<f64> {
    let mut settings = EkfSettings::tracking(paper::MOTOR.to_array(), CURRENT);
    settings.unknown_voltage = unknown_voltage;
    Ekf::new(settings, [1.0; 4])
}

/// The filters learn from all events, with `advance` for a period.
fn learn(filters: &mut [Ekf<f64>], events: &[Event], mut advance: impl FnMut(&mut [Ekf<f64>], &Period<f64>, [f64; 2])) {
    for event in events {
        match event {
            Event::Begin(i) => filters.iter_mut().for_each(|filter| filter.begin(*i)),
            Event::Period(period, i) => advance(filters, period, *i),
        }
    }
}

fn one_by_one(filters: &mut [Ekf<f64>], events: &[Event]) {
    learn(filters, events, |filters, period, i| filters.iter_mut().for_each(|filter| filter.advance(period, i)));
}

fn in_lanes(filters: &mut [Ekf<f64>], events: &[Event]) {
    let mut together = Together::new();
    learn(filters, events, |filters, period, i| bank::advance(&mut together, filters, &[true; LEVELS.len()], period, i));
}

fn least_squares(rls: &mut BlockRls<f64>, events: &[Event]) {
    for event in events {
        match event {
            Event::Begin(i) => rls.begin(*i),
            Event::Period(period, i) => {
                rls.advance(period, *i);
            }
        }
    }
}

/// The default estimator, which takes events.
fn take(estimator: &mut Estimator, events: &[Event]) {
    events.iter().for_each(|event| estimator.take(event));
}

fn main() -> Result<(), Box<dyn Error>> {
    let events = events()?;
    let theta = paper::MOTOR.to_array();
    let beginning = Beginning {
        start: Start { values: theta.map(Some), rating: Some([CURRENT, 419.0]), ..Start::default() },
        nominal: theta,
        seed: theta,
        is_guessed: [false; 4],
        scale: [CURRENT, 100.0, 0.0],
    };
    let (first, later) = events.split_at(events.len() / 2);
    let new = || Estimator::new(Method::EkfTracking, &beginning);
    let after_first = {
        let mut estimator = new();
        take(&mut estimator, first);
        estimator
    };
    let times = Times {
        kalman_filter_ns: nanoseconds(&events, || [filter(0.3)], |filters, events| one_by_one(filters, events)),
        bank_one_by_one_ns: nanoseconds(&events, || LEVELS.map(filter), |filters, events| one_by_one(filters, events)),
        bank_ns: nanoseconds(&events, || LEVELS.map(filter), |filters, events| in_lanes(filters, events)),
        default_first_ns: nanoseconds(first, new, take),
        default_later_ns: nanoseconds(later, || after_first.clone(), take),
        block_least_squares_ns: nanoseconds(&events, || BlockRls::new(BlockRlsSettings::new(theta)), least_squares),
    };
    println!("{}", serde_json::to_string(&times)?);
    Ok(())
}

//! Nanoseconds a sample of the recursive estimators, as JSON: one Kalman filter, a bank of six, and
//! block least squares. `estimators.py` calls it.
// The JSON on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use fluxfit::{log::Row, paper};
use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings};
use fluxfit_drive::{Scenario, simulate};
use fluxfit_track::{Beginning, DriveFaults, Estimator, Event, Method, Start, Stream, Timing};
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

/// CPU time per event of the fastest repetition, ns.
fn nanoseconds(events: &[Event], mut pass: impl FnMut()) -> f64 {
    let mut once = || {
        let start = ProcessTime::now();
        pass();
        start.elapsed().as_secs_f64()
    };
    1e9 * (0..REPEATS).map(|_| once()).fold(f64::INFINITY, f64::min) / events.len() as f64
}

fn filter(unknown_voltage: f64) -> Ekf<f64> {
    let mut settings = EkfSettings::tracking(paper::MOTOR.to_array(), CURRENT);
    settings.unknown_voltage = unknown_voltage;
    Ekf::new(settings, [1.0; 4])
}

fn pass(filters: &mut [Ekf<f64>], events: &[Event]) {
    for event in events {
        match event {
            Event::Begin(i) => filters.iter_mut().for_each(|filter| filter.begin(*i)),
            Event::Period(period, i) => filters.iter_mut().for_each(|filter| filter.advance(period, *i)),
        }
    }
    black_box(filters);
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
    let times = Times {
        kalman_filter_ns: nanoseconds(&events, || pass(&mut [filter(0.3)], &events)),
        bank_one_by_one_ns: nanoseconds(&events, || pass(&mut LEVELS.map(filter), &events)),
        bank_ns: nanoseconds(&events, || {
            let mut estimator = Estimator::new(Method::EkfTracking, &beginning);
            events.iter().for_each(|event| estimator.take(event));
            black_box(estimator);
        }),
        block_least_squares_ns: nanoseconds(&events, || {
            let mut rls = BlockRls::new(BlockRlsSettings::new(theta));
            for event in &events {
                match event {
                    Event::Begin(i) => rls.begin(*i),
                    Event::Period(period, i) => {
                        rls.advance(period, *i);
                    }
                }
            }
            black_box(rls);
        }),
    };
    println!("{}", serde_json::to_string(&times)?);
    Ok(())
}

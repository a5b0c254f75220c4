//! What an identification must not depend on: units, mirrors, the clock, the order of logs; and that it gives the true motor back.
//!
//! The data are equation (2) of random motors, sampled so coarsely that no zero-order-hold correction applies.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Known, Model, Request, Swarm, TimeWindow, Verdict,
    evidence::Identification,
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::{VoltageFrame, VoltageTiming},
    optimizer::Draws,
};

use proptest::prelude::*;

/// Steady voltages do not know their delay.
const NEXT: VoltageTiming = VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle };

/// Rows of an operating point.
const ROWS: usize = 60;

/// A motor and points (i_d, i_q, omega_e) at which it runs.
#[derive(Debug, Clone)]
struct Drive {
    motor: Motor,
    points: Vec<(f64, f64, f64)>,
}

/// Motors from a drone's to a press's, at currents and speeds that make each parameter a part of the voltage.
fn drives(points: usize) -> impl Strategy<Value = Drive> {
    let exponent = |from: f64, to: f64| (from.log10()..to.log10()).prop_map(|x: f64| 10.0_f64.powf(x));
    let motor = (exponent(0.01, 5.0), exponent(20e-6, 20e-3), 1.0..2.5, exponent(2e-3, 1.0));
    // The largest current drops up to half of what the magnet induces, in the resistance or the inductance.
    let scale = (exponent(0.5, 2.0), 0.2..0.5);
    let at = prop::collection::vec((0.1..0.6, 0.3..1.0, 0.6..1.0), points);
    (motor, scale, at).prop_map(|((rs, ld, salience, psi_f), (speed, load), at)| {
        let omega = speed * 2.0 * rs / ld;
        let current = load * omega * psi_f / (rs + omega * ld);
        let points = at.into_iter().enumerate().map(|(k, (d, q, w)): (usize, (f64, f64, f64))| {
            // The first point is the paper's mode 0; the others differ by construction as well as by chance.
            let (d, q) = if k == 0 { (0.0, 1.0) } else { (-d - 0.2 * k as f64, q / k as f64) };
            (current * d, current * q, omega * w)
        });
        Drive { motor: Motor { rs, ld, lq: salience * ld, psi_f }, points: points.collect() }
    })
}

/// The drive's columns with this noise, as a fraction of the point's voltage and current; the rotor turns a radian or more per row.
fn columns(drive: &Drive, noise: f64, seed: u64) -> Columns {
    let mut draws = Draws::seeded(seed, 0);
    let mut columns = Columns::default();
    let slowest = drive.points.iter().map(|point| point.2.abs()).fold(f64::INFINITY, f64::min);
    let period = 1.0 / slowest;
    for (w, &(d, q, omega_e)) in drive.points.iter().enumerate() {
        let u = drive.motor.steady_voltage(Dq { d, q }, omega_e);
        let (du, di) = (noise * u.magnitude(), noise * d.hypot(q));
        for k in 0..ROWS {
            columns.t.push(period * (w * (ROWS + 10) + k) as f64);
            columns.ud.push(u.d + du * draws.normal());
            columns.uq.push(u.q + du * draws.normal());
            columns.id.push(d + di * draws.normal());
            columns.iq.push(q + di * draws.normal());
            columns.omega_e.push(omega_e);
        }
    }
    columns
}

/// One window per operating point, half a row beyond its ends.
fn settings(columns: &Columns) -> Request {
    let period = columns.t[1] - columns.t[0];
    let ends = columns.t.chunks(ROWS).map(|t| TimeWindow { from: t[0] - 0.5 * period, to: t[t.len() - 1] + 0.5 * period });
    Request { model: Some(Model::Steady), windows: ends.collect(), voltage_timing: Some(NEXT), swarm: Swarm::Off, ..Request::default() }
}

fn found_with(columns: Columns, settings: &Request) -> Identification {
    identify(&Log::new(columns).unwrap(), settings).unwrap().identification
}

fn found(columns: Columns) -> Identification {
    let settings = settings(&columns);
    found_with(columns, &settings)
}

fn values(found: &Identification) -> [f64; PARAMETERS] {
    Parameter::ALL.map(|parameter| found.parameter(parameter).raw)
}

fn errors(found: &Identification) -> [f64; PARAMETERS] {
    Parameter::ALL.map(|parameter| found.parameter(parameter).uncertainty.standard_error())
}

fn verdicts(found: &Identification) -> [Verdict; PARAMETERS] {
    Parameter::ALL.map(|parameter| found.parameter(parameter).verdict)
}

/// Values within a fraction of their standard errors, the errors within the same fraction of themselves, and the same verdicts.
fn same(one: &Identification, other: &Identification, scale: [f64; PARAMETERS], tolerance: f64) -> Result<(), TestCaseError> {
    for (p, scale) in scale.into_iter().enumerate() {
        let error = errors(one)[p];
        prop_assert!((values(other)[p] / scale - values(one)[p]).abs() <= tolerance * error, "{p}: {:?} {:?}", values(one), values(other));
        prop_assert!((errors(other)[p] / scale - error).abs() <= tolerance * error, "{p}: {:?} {:?}", errors(one), errors(other));
    }
    prop_assert_eq!(verdicts(one), verdicts(other));
    Ok(())
}

/// Rounding, amplified by the condition of the equations, against standard errors of 1e-4 of the value and more.
const ROUNDING: f64 = 1e-6;

const NOISE: f64 = 0.003;

const SAME_UNITS: [f64; PARAMETERS] = [1.0; PARAMETERS];

proptest! {
    // Nothing is written beside the tests when one fails: its seed is in the message.
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// R scales by k_u / k_i, L by k_u / (k_i k_omega), psi_f by k_u / k_omega. Powers of two: scaling rounds nothing. What a drive may
    /// lose depends on its dead time in seconds, so time is scaled where the voltages are those of the terminals.
    #[test]
    fn units_do_not_matter(drive in drives(3), seed: u64, u in -6..6, i in -6..6, omega in -3..3) {
        let columns = columns(&drive, NOISE, seed);
        let [ku, ki, kw] = [u, i, omega].map(|exponent: i32| 2.0_f64.powi(exponent));
        let scaled = |column: &[f64], by: f64| column.iter().map(|x| x * by).collect::<Vec<_>>();
        let other = Columns {
            // Time goes as one over the speed.
            t: scaled(&columns.t, 1.0 / kw), ud: scaled(&columns.ud, ku), uq: scaled(&columns.uq, ku),
            id: scaled(&columns.id, ki), iq: scaled(&columns.iq, ki), omega_e: scaled(&columns.omega_e, kw), ..Columns::default()
        };
        let found = |columns: Columns| {
            let voltage_accuracy = if omega == 0 { Request::default().voltage_accuracy } else { 0.0 };
            let settings = Request { voltage_accuracy, ..settings(&columns) };
            found_with(columns, &settings)
        };
        same(&found(columns), &found(other), [ku / ki, ku / ki / kw, ku / ki / kw, ku / kw], ROUNDING)?;
    }

    /// A motor seen in a mirror turns the other way: u_q, i_q and omega change sign, the motor does not.
    #[test]
    fn a_mirrored_drive_is_the_same_motor(drive in drives(3), seed: u64) {
        let columns = columns(&drive, NOISE, seed);
        let negative = |column: &[f64]| column.iter().map(|x| -x).collect::<Vec<_>>();
        let mirrored =
            Columns { uq: negative(&columns.uq), iq: negative(&columns.iq), omega_e: negative(&columns.omega_e), ..columns.clone() };
        same(&found(columns), &found(mirrored), SAME_UNITS, ROUNDING)?;
    }

    /// A shift by a power of two many times the log's length keeps ten digits of each time step.
    #[test]
    fn the_clock_does_not_matter(drive in drives(3), seed: u64) {
        let columns = columns(&drive, NOISE, seed);
        let shift = 2.0_f64.powi(columns.t[columns.t.len() - 1].log2().ceil() as i32 + 3);
        let later = Columns { t: columns.t.iter().map(|t| t + shift).collect(), ..columns.clone() };
        same(&found(columns), &found(later), SAME_UNITS, ROUNDING)?;
    }

    #[test]
    fn the_order_of_logs_and_of_windows_does_not_matter(drive in drives(3), seed: u64) {
        let columns = columns(&drive, NOISE, seed);
        let mut settings = settings(&columns);
        let one = found_with(columns.clone(), &settings);
        settings.windows.reverse();
        same(&one, &found_with(columns.clone(), &settings), SAME_UNITS, ROUNDING)?;

        let part = |w: usize| {
            let rows = w * ROWS..(w + 1) * ROWS;
            let of = |column: &[f64]| column[rows.clone()].to_vec();
            Log::new(Columns {
                t: of(&columns.t), ud: of(&columns.ud), uq: of(&columns.uq),
                id: of(&columns.id), iq: of(&columns.iq), omega_e: of(&columns.omega_e), ..Columns::default()
            }).unwrap()
        };
        for order in [[0, 1, 2], [2, 0, 1]] {
            let joined = Log::join(order.map(part)).unwrap();
            same(&one, &identify(&joined, &settings).unwrap().identification, SAME_UNITS, ROUNDING)?;
        }
    }

    /// The second copy proves nothing that the first did not.
    #[test]
    fn a_log_joined_with_itself_has_the_same_answer_and_no_more_redundancy(drive in drives(2), seed: u64) {
        let columns = columns(&drive, NOISE, seed);
        let settings = settings(&columns);
        let log = Log::new(columns).unwrap();
        let once = identify(&log, &settings).unwrap().identification;
        let twice = identify(&Log::join([log.clone(), log]).unwrap(), &settings).unwrap().identification;
        for p in 0..PARAMETERS {
            prop_assert!((values(&twice)[p] - values(&once)[p]).abs() <= ROUNDING * errors(&once)[p]);
        }
        prop_assert_eq!(twice.steady.as_ref().unwrap().estimate.redundancy, once.steady.as_ref().unwrap().estimate.redundancy);
    }

    #[test]
    fn exact_data_give_the_motor_back(two in drives(2), three in drives(3)) {
        for drive in [two, three] {
            let found = found(columns(&drive, 0.0, 0));
            for (value, truth) in values(&found).into_iter().zip(drive.motor.to_array()) {
                prop_assert!((value / truth - 1.0).abs() < 1e-6, "{:?} {:?}", values(&found), drive.motor);
            }
            prop_assert_eq!(found.steady.as_ref().unwrap().misfit, None);
        }
    }

    /// Exactly as many equations as unknowns: nothing pulls the others, whatever the weights.
    #[test]
    fn fixing_a_parameter_where_it_is_leaves_the_others(drive in drives(2), seed: u64, p in 0..PARAMETERS) {
        let columns = columns(&drive, NOISE, seed);
        let free = found(columns.clone());
        prop_assume!(free.steady.as_ref().unwrap().excitation.excited().count() == PARAMETERS);
        let mut settings = settings(&columns);
        settings.known[p] = Known::Fixed(values(&free)[p]);
        let fixed = found_with(columns, &settings);
        prop_assert_eq!(values(&fixed)[p], values(&free)[p]);
        for q in 0..PARAMETERS {
            let (one, other) = (values(&fixed)[q], values(&free)[q]);
            prop_assert!((one - other).abs() <= 1e-3 * errors(&free)[q], "{q}: {one} {other}");
        }
    }

    /// A prior a million times wider than the value says nothing; one a million times sharper than the answer is a fixed value.
    #[test]
    fn a_prior_goes_from_nothing_to_fixed(drive in drives(3), seed: u64, p in 0..PARAMETERS, off in 0.9..1.1) {
        let columns = columns(&drive, NOISE, seed);
        let free = found(columns.clone());
        prop_assume!(free.steady.as_ref().unwrap().excitation.excited().count() == PARAMETERS && free.steady.as_ref().unwrap().misfit.is_none());
        // The lag of a recorder's log bends to a value that contradicts it, the further the more it is turned back: there the law is of
        // values that do not.
        let is_recorders = free.steady.as_ref().unwrap().frame_lag.is_some();
        let value = if is_recorders { values(&free)[p] } else { off * drive.motor.to_array()[p] };
        // A small resistance may come out below zero, where no one knows it.
        prop_assume!(value > 0.0);
        let with = |known: Known| {
            let mut settings = settings(&columns);
            settings.known[p] = known;
            found_with(columns.clone(), &settings)
        };
        let weak = with(Known::Prior { value, standard_error: 1e6 * value });
        same(&free, &weak, SAME_UNITS, 1e-3)?;
        let (sharp, fixed) = (with(Known::Prior { value, standard_error: 1e-9 * value }), with(Known::Fixed(value)));
        // A contradiction between prior and log widens both answers by rules of their own; without one they are the same.
        prop_assume!(sharp.steady.as_ref().unwrap().misfit.is_none() && fixed.steady.as_ref().unwrap().misfit.is_none());
        for q in 0..PARAMETERS {
            let (one, other) = (values(&sharp)[q], values(&fixed)[q]);
            prop_assert!((one - other).abs() <= 1e-3 * errors(&free)[q], "{q}: {one} {other}");
        }
    }
}

/// What is accepted as a log, however senseless: five columns of a kind and a size each, gaps of a row, windows of thirty.
fn garbage() -> impl Strategy<Value = (Columns, bool)> {
    let kind = (0..7, -9.0..9.0_f64);
    (prop::array::uniform5(kind), prop::array::uniform3(30..50usize), -6.0..3.0_f64, any::<u64>(), any::<bool>()).prop_map(
        |(kinds, rows, period, seed, named)| {
            let mut draws = Draws::seeded(seed, 0);
            let total: usize = rows.iter().sum();
            let mut column = |(kind, exponent): (i32, f64)| -> Vec<f64> {
                let size = 10.0_f64.powf(exponent);
                let level = draws.normal().clamp(-1.0, 1.0);
                let value = |k: usize, draws: &mut Draws| match kind {
                    0 => 0.0,
                    1 => level,
                    2 => draws.normal().clamp(-1.0, 1.0),
                    3 => level * if k < rows[0] { 1.0 } else { -0.5 },
                    4 => level * (1.0 + 1e-3 * draws.normal()),
                    5 => level * f64::from(u8::from(k >= rows[0])),
                    _ => k as f64 / total as f64,
                };
                (0..total).map(|k| (size * value(k, &mut draws)).clamp(-1e9, 1e9)).collect()
            };
            let [ud, uq, id, iq, omega_e] = kinds.map(&mut column);
            let mut t = Vec::new();
            for (w, rows) in rows.into_iter().enumerate() {
                // Three rows are lost between the parts: a gap.
                t.extend((0..rows).map(|k| 10.0_f64.powf(period) * (k + t.len() + 3 * w) as f64).collect::<Vec<_>>());
            }
            (Columns { t, ud, uq, id, iq, omega_e, ..Columns::default() }, named)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// No panic, and no number that a reader could take for an answer is infinite or not a number.
    #[test]
    fn whatever_the_log_every_number_shown_is_finite((columns, named) in garbage(), timing in 0..3_usize, exact: bool) {
        let Ok(log) = Log::new(columns) else { return Ok(()) };
        let t = &log.columns().t;
        let settings = Request {
            // Thirty rows to the row.
            windows: if named { vec![TimeWindow { from: t[0], to: t[29] }, TimeWindow { from: t[t.len() - 30], to: t[t.len() - 1] }] } else { Vec::new() },
            voltage_timing: [None, Some(VoltageTiming::Centered), Some(NEXT)][timing],
            voltage_accuracy: if exact { 0.0 } else { 1e-4 },
            swarm: Swarm::Off,
            ..Request::default()
        };
        let Ok(answer) = identify(&log, &settings) else { return Ok(()) };
        let found = answer.identification;
        for judgement in &found.parameters {
            let Some(value) = judgement.value() else { continue };
            let uncertainty = judgement.uncertainty;
            let [low, high] = judgement.interval().unwrap();
            let parts = [uncertainty.standard_error(), uncertainty.statistical, uncertainty.systematic.total()];
            for number in [value, low, high, uncertainty.degrees_of_freedom].into_iter().chain(parts) {
                prop_assert!(number.is_finite(), "{judgement:?}");
            }
        }
        for point in found.operating_points() {
            prop_assert!(point.means.iter().all(|mean| mean.is_finite()), "{point:?}");
        }
        if let Some(fit) = &found.steady {
            prop_assert!(fit.estimate.residuals.iter().flatten().chain([&fit.estimate.chi_squared]).all(|x| x.is_finite()));
            prop_assert!(fit.misfit.is_none_or(|misfit| misfit.ratio.is_finite() && misfit.voltage_accuracy.is_finite()));
        }
        if let Some(fit) = &found.output {
            prop_assert!(fit.residuals.iter().chain([&fit.cost]).all(|x| x.is_finite()));
        }
    }
}

/// Exact zeros have no noise and no accuracy of their own; what they weigh must still be a number.
#[test]
fn a_window_without_voltage_or_speed_is_no_trap() {
    let halves = |first: f64, second: f64| (0..80).map(|k| if k < 40 { first } else { second }).collect::<Vec<_>>();
    let t = (0..80).map(|k| 20.0 * f64::from(k)).collect();
    let (ud, uq, id, iq) = (halves(0.0, 0.0), halves(0.0, -4.2e-8), halves(2e-2, -1e-2), halves(-4.2e-6, 2.1e-6));
    let log = Log::new(Columns { t, ud, uq, id, iq, omega_e: halves(0.0, -8.2e-5), ..Columns::default() }).unwrap();
    let found = identify(&log, &Request { model: Some(Model::Steady), swarm: Swarm::Off, ..Request::default() }).unwrap().identification;
    assert!(
        found.steady.as_ref().unwrap().estimate.motor.to_array().iter().all(|value| value.is_finite()),
        "{:?}",
        found.steady.as_ref().unwrap().estimate.motor
    );
}

/// Currents, speed and `u_d` rise together from zero, without noise: the noise of the residuals cancels exactly. Found by the property
/// above.
#[test]
fn ramps_whose_noise_cancels_are_no_trap() {
    const ROWS: usize = 104;
    let ramp = |size: f64| (0..ROWS).map(|k| k as f64 / ROWS as f64 * size).collect::<Vec<_>>();
    let t = |k: usize| 1.1629807517725456e-6 * (k + [0, 3, 6][usize::from(k >= 30) + usize::from(k >= 64)]) as f64;
    let columns = Columns {
        t: (0..ROWS).map(t).collect(),
        ud: ramp(1.0),
        uq: vec![0.8455358964454691; ROWS],
        id: ramp(218919.11016478797),
        iq: ramp(126082104.29874085),
        omega_e: ramp(1.9936738402685122e-7),
        ..Columns::default()
    };
    let windows = [(0.0, t(29)), (t(ROWS - 30), t(ROWS - 1))].map(|(from, to)| TimeWindow { from, to }).to_vec();
    let request = Request { windows, voltage_accuracy: 0.0, swarm: Swarm::Off, ..Request::default() };
    let fit = identify(&Log::new(columns).unwrap(), &request).unwrap().identification.steady.unwrap();
    assert!(fit.estimate.chi_squared.is_finite() && fit.estimate.residuals.iter().flatten().all(|x| x.is_finite()), "{:?}", fit.estimate);
}

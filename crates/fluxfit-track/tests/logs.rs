//! The estimators on logs of an independent simulator, whose truth is known, from a start at -30, +40, -25 and -12 %.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{Motor, log::Row};
use fluxfit_drive::{
    scenario::{Control, Inverter, Mechanics, Modulation, Scenario, Schedule, Sensors, SimulatedMotor, reference_cases::two_modes},
    schedule::{Profile, Ramp},
    simulate,
};
use fluxfit_track::{DriveFaults, Estimator, Method, Start, Timing, TrackSettings, Tracker, Verdict};
use std::{fs, path::Path};

const TRUTH: [f64; 4] = [0.958, 5.25e-3, 12e-3, 0.1827];
const START: [f64; 4] = [0.7, 1.4, 0.75, 0.88];

/// The commands of these drives act one period later.
const COMMANDS: Timing = Timing::Delayed { delay: 1, at_row: false };

fn rows(name: &str, voltages: [&str; 2]) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/logs").join(name);
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let [t, ud, uq, id, iq, omega_e] = ["t", voltages[0], voltages[1], "id", "iq", "omega_e"].map(place);
    lines
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            Row { t: cells[t], ud: cells[ud], uq: cells[uq], id: cells[id], iq: cells[iq], omega_e: cells[omega_e], ..Row::default() }
        })
        .collect()
}

fn commands(name: &str) -> Vec<Row> {
    rows(name, ["ud_ref", "uq_ref"])
}

fn settings(method: Method) -> TrackSettings {
    let values = [0, 1, 2, 3].map(|j| Some(START[j] * TRUTH[j]));
    let start = Start { values, rating: Some([10.0, 419.0]), ..Start::default() };
    TrackSettings { start, ..TrackSettings::new(method, Some(COMMANDS)) }
}

fn followed(settings: TrackSettings, rows: &[Row]) -> Tracker {
    let mut tracker = Tracker::new(settings);
    rows.iter().for_each(|row| tracker.push(row));
    tracker
}

fn errors(tracker: &Tracker) -> [f64; 4] {
    let values = tracker.estimator().unwrap().estimate().values;
    [0, 1, 2, 3].map(|j| 100.0 * (values[j] / TRUTH[j] - 1.0))
}

/// 1.5 times what independent prototypes reached on these logs (their table of errors at the end), or 0.05 % where that is smaller.
#[test]
fn errors_at_the_end_are_those_of_the_prototypes() {
    let (a, c, f3) = (commands("paper_rig_ideal.csv"), commands("paper_rig_pwm_noise.csv"), commands("id_zero_two_loads.csv"));
    type Table = [f64; 4];
    let cases: [(Method, Table, Table, Table); 13] = [
        (Method::Ekf, [0.0; 4], [0.08, 0.0, 0.01, 0.01], [0.01, 3.6, 0.01, 0.0]),
        (Method::EkfTracking, [0.0; 4], [0.16, 0.16, 0.03, 0.03], [0.01, 2.5, 0.07, 0.02]),
        (Method::RlsExponential, [0.0, 0.0, 0.01, 0.0], [0.07, 0.15, 0.02, 0.0], [0.18, 79.0, 0.0, 0.01]),
        (Method::RlsFortescue, [0.0, 0.0, 0.01, 0.0], [0.15, 0.15, 0.02, 0.01], [0.14, 74.0, 0.0, 0.0]),
        (Method::RlsFuzzy, [0.0, 0.0, 0.01, 0.0], [0.14, 0.15, 0.02, 0.01], [0.15, 75.0, 0.0, 0.0]),
        (Method::RlsDirectional, [0.0, 0.0, 0.01, 0.0], [0.17, 0.19, 0.02, 0.01], [0.15, 77.0, 0.0, 0.0]),
        (Method::RlsSteady, [3.6, 1.4, 0.12, 0.45], [3.4, 1.0, 0.13, 0.41], [4.7, 75.0, 0.03, 0.3]),
        (Method::InstrumentalVariable, [0.0, 0.0, 0.01, 0.0], [0.13, 1.1, 0.0, 0.06], [0.04, 5.9, 0.0, 0.01]),
        (Method::RlsSample, [0.0, 0.0, 0.01, 0.0], [14.0, 64.0, 2.6, 3.3], [0.2, 97.0, 5.6, 0.0]),
        (Method::BiasCompensated, [0.01, 0.08, 0.01, 0.0], [0.08, 0.06, 0.02, 0.0], [1.4, 1500.0, 0.04, 0.01]),
        (Method::Mras, [0.3, 1.7, 0.01, 0.06], [1.6, 1.5, 0.04, 0.09], [0.17, 19.0, 0.02, 0.0]),
        (Method::MrasScalar, [93.0, 41.0, 4.0, 13.0], [145.0, 178.0, 6.0, 6.0], [174.0, 596.0, 2.0, 13.0]),
        (Method::Adaline, [0.75, 0.08, 0.24, 0.05], [1.3, 0.08, 0.15, 0.14], [30.0, 40.0, 0.04, 2.5]),
    ];
    let mut beyond = Vec::new();
    for (method, of_a, of_c, of_f3) in cases {
        for (name, rows, table) in [("a", &a, of_a), ("c", &c, of_c), ("f3", &f3, of_f3)] {
            let found = errors(&followed(settings(method), rows));
            if !found.iter().zip(table).all(|(error, expected)| error.abs() <= (1.5 * expected).max(0.05)) {
                beyond.push(format!("{} on {name}: {found:.3?}", method.key()));
            }
        }
    }
    assert!(beyond.is_empty(), "{}", beyond.join("\n"));
}

/// Those without an error covariance say so, and the others have one.
#[test]
fn estimators_without_a_covariance_say_so() {
    let rows = commands("paper_rig_ideal.csv");
    for method in Method::ALL {
        let tracker = followed(settings(method), &rows[..4000]);
        let estimate = tracker.estimator().unwrap().estimate();
        assert_eq!(estimate.standard_errors.is_some(), method.has_covariance(), "{}", method.key());
        assert_eq!(tracker.parameters().unwrap()[2].verdict == Verdict::Unknown, !method.has_covariance(), "{}", method.key());
    }
}

/// Without a start and without a stated timing, from either pair of voltage columns.
#[test]
fn the_stream_finds_start_and_timing_itself() {
    for (voltages, timing) in [(["ud", "uq"], Timing::Centered), (["ud_ref", "uq_ref"], COMMANDS)] {
        let rows = rows("paper_rig_pwm_noise.csv", voltages);
        let tracker = followed(TrackSettings::new(Method::EkfTracking, None), &rows);
        // The only step of i_d is the one with which L_d becomes known: it does not count, so the timing is not settled.
        assert_eq!(tracker.timing(), (timing, false));
        for (j, tracked) in tracker.parameters().unwrap().iter().enumerate() {
            let [low, high] = tracked.interval().unwrap();
            assert!((low..=high).contains(&TRUTH[j]) && high - low < 0.1 * TRUTH[j], "{j}: {low} {high}");
        }
    }
}

/// L_d is in no equation where i_d is zero.
#[test]
fn what_the_samples_do_not_determine_has_no_value() {
    let parameters = followed(settings(Method::EkfTracking), &commands("id_zero_two_loads.csv")).parameters().unwrap();
    assert_eq!((parameters[1].value, parameters[1].verdict), (None, Verdict::NotIdentifiable));
    assert!([0, 2, 3].into_iter().all(|j| parameters[j].verdict == Verdict::Identified), "{parameters:?}");
}

#[test]
fn a_saved_tracker_goes_on_to_the_same_bits() {
    let rows = rows("paper_rig_pwm_noise.csv", ["ud", "uq"]);
    for (method, timing) in [(Method::EkfTracking, None), (Method::Rls, Some(Timing::Centered)), (Method::Mras, Some(Timing::Centered))] {
        let settings = TrackSettings { timing, ..settings(method) };
        let whole = followed(settings, &rows);
        // In the lead-in, while timings are in question, and after.
        for at in [700, 3001, 7777] {
            let text = serde_json::to_string(&followed(settings, &rows[..at])).unwrap();
            let mut resumed: Tracker = serde_json::from_str(&text).unwrap();
            rows[at..].iter().for_each(|row| resumed.push(row));
            assert_eq!(serde_json::to_string(&resumed).unwrap(), serde_json::to_string(&whole).unwrap(), "{} {at}", method.key());
        }
    }
}

#[test]
fn garbage_and_gaps_are_left_out_and_counted() {
    let mut rows = commands("paper_rig_pwm_noise.csv");
    let clean = errors(&followed(settings(Method::Ekf), &rows));
    for k in (3000..9000).step_by(997) {
        match k % 3 {
            0 => rows[k].id = f64::NAN,
            1 => rows[k].uq = 1e6,
            _ => rows[k].omega_e = f64::INFINITY,
        }
    }
    // 20 rows are lost.
    rows.drain(6500..6520);
    let tracker = followed(settings(Method::Ekf), &rows);
    let left_out = tracker.left_out();
    assert_eq!((left_out.not_numbers + left_out.spikes, left_out.gaps), (7, 1), "{left_out:?}");
    assert!(left_out.spikes > 0 && left_out.not_numbers > 0);
    let dirty = errors(&tracker);
    assert!(clean.iter().zip(dirty).all(|(clean, dirty)| (clean - dirty).abs() < 0.1), "{clean:?} {dirty:?}");
}

#[test]
fn fixed_and_prior_values_count() {
    let rows = commands("id_zero_two_loads.csv");
    let mut settings = settings(Method::EkfTracking);
    settings.start.values[1] = Some(TRUTH[1]);
    settings.start.standard_errors[1] = Some(0.0);
    let fixed = followed(settings, &rows).parameters().unwrap();
    assert_eq!((fixed[1].value, fixed[1].standard_error), (Some(TRUTH[1]), Some(0.0)));
    settings.start.standard_errors[1] = Some(0.01 * TRUTH[1]);
    let known = followed(settings, &rows).parameters().unwrap();
    let [low, high] = known[1].interval().unwrap();
    assert!((low..=high).contains(&TRUTH[1]) && high - low < 0.06 * TRUTH[1], "{low} {high}");
}

/// Without excitation the values are held, and since when is said.
#[test]
fn a_quiet_spell_is_said() {
    let rows = commands("paper_rig_pwm_noise.csv");
    let last = rows[8999];
    let mut tracker = followed(settings(Method::EkfTracking), &rows);
    // The drive runs on at the operating point of the last rows, of which the last 1000 are repeated.
    let period = 1e-4;
    for k in 0..30_000 {
        tracker.push(&Row { t: last.t + period * f64::from(k + 1), ..rows[8000 + (k as usize) % 1000] });
    }
    let parameters = tracker.parameters().unwrap();
    assert!(matches!(parameters[0].verdict, Verdict::Holding { since } if (1.0..2.5).contains(&since)), "{parameters:?}");
    assert!(matches!(tracker.estimator(), Some(Estimator::Ekf(_))));
}

/// Dead time, sensor offset and angle offset that are known are undone; unknown, each makes something wrong by more than 5 %.
#[test]
fn known_faults_of_the_drive_are_undone() {
    let mut scenario = two_modes();
    scenario.inverter.dead_time = 2e-6;
    scenario.sensors.current_offset = [0.3, 0.0, 0.0];
    scenario.sensors.angle_offset = 0.05;
    let recording = simulate(&scenario, 0, || ()).unwrap();
    let rows: Vec<Row> = (0..recording.columns.t.len())
        .filter_map(|k| Some(Row { ud: recording.ud_ref[k], uq: recording.uq_ref[k], ..recording.columns.row(k)? }))
        .collect();
    let faults = DriveFaults {
        // Dead time times carrier times DC voltage, and two thirds of an offset of phase a.
        dead_time_voltage: 2e-6 * 5e3 * 310.0,
        dead_time_width: 0.0,
        current_offset: [0.2, 0.0],
        angle_offset: 0.05,
    };
    let known = errors(&followed(TrackSettings { faults, ..settings(Method::Ekf) }, &rows));
    assert!(known.iter().all(|error| error.abs() < 1.0), "{known:?}");
    for left in ["dead_time_voltage", "angle_offset"] {
        let mut rest = faults;
        *rest.number(left).unwrap() = 0.0;
        let unknown = errors(&followed(TrackSettings { faults: rest, ..settings(Method::Ekf) }, &rows));
        assert!(unknown.iter().any(|error| error.abs() > 5.0), "{left}: {unknown:?}");
    }
}

/// A drive on a dynamometer. Speed, i_d and i_q change between two values each; i_d begins at zero.
struct Drive {
    motor: Motor,
    pole_pairs: u32,
    u_dc: f64,
    bandwidth: f64,
    is_switched: bool,
    /// Mechanical, rad/s.
    speed: [f64; 2],
    iq: [f64; 2],
    id: f64,
    /// Time of a ramp of the speed, s; i_d steps twice in it.
    ramp: f64,
    noise: f64,
    /// V, white on each axis: what acts and is not logged.
    unlogged: f64,
    /// Part of L_d that is lost at 2 s.
    lost: f64,
}

impl Drive {
    /// Its log from 1.1 s to 4 s, without two rows: the voltages are centred, or commands that act so many periods later.
    fn log(&self, delay: Option<usize>) -> Vec<Row> {
        let wave = |at: f64, every: f64, over: f64, [first, second]: [f64; 2]| {
            let to = |k: u32| if k.is_multiple_of(2) { second } else { first };
            let ramp = |k: u32| Ramp { at: at + every * f64::from(k), to: to(k), over };
            let mut ramps: Vec<Ramp> = (0..20).map(ramp).collect();
            ramps.push(Ramp { at: 0.0, to: first, over: 0.0 });
            Profile::new(ramps)
        };
        let Motor { rs, ld, lq, psi_f } = self.motor;
        let most = 2.0 * self.iq[0];
        let modulation = if self.is_switched { Modulation::Switched } else { Modulation::Averaged };
        let mut motor = SimulatedMotor::new(rs, Motor { rs, ld, lq, psi_f }.into(), self.pole_pairs);
        motor.changes[1] = Profile::new(vec![Ramp { at: 2.0, to: -self.lost, over: 0.0 }]);
        let scenario = Scenario {
            duration: 4.0,
            motor,
            mechanics: Mechanics::Dyno,
            inverter: Inverter { modulation, voltage_noise: self.unlogged, ..Inverter::ideal(self.u_dc, 5e3) },
            control: Control::new(self.bandwidth, 0.25 * self.bandwidth, most),
            schedule: Schedule {
                speed: wave(0.3, self.ramp, self.ramp, self.speed),
                iq: wave(0.1 + self.ramp, self.ramp, 0.0, self.iq),
                id: wave(0.5 * self.ramp, 0.5 * self.ramp, 0.0, [0.0, self.id]),
                ..Schedule::default()
            },
            sensors: Sensors { current_noise: self.noise, ..Sensors::IDEAL },
            ..two_modes()
        };
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let is_kept = |k: &usize| ![18_364, 24_808].contains(k);
        let row = |k: usize| {
            let row = recording.columns.row(k).unwrap();
            // A command acts over the period after the next row.
            let command = |delay: usize| k + delay - 1;
            delay.map_or(row, |delay| Row { ud: recording.ud_ref[command(delay)], uq: recording.uq_ref[command(delay)], ..row })
        };
        (11_000..39_000).filter(is_kept).map(row).collect()
    }
}

/// Drives of which a wrong timing looked likelier, because its filter started nearer to the motor, or found one step of a parameter after
/// the other. Each number is within 1.5 of half its interval, or 0.05 %.
#[test]
fn a_timing_is_not_chosen_by_how_its_filter_started() {
    let slow = Drive {
        motor: Motor { rs: 3.36, ld: 0.0458, lq: 0.0528, psi_f: 1.073 },
        pole_pairs: 3,
        u_dc: 572.0,
        bandwidth: 200.0,
        is_switched: false,
        speed: [10.56, 12.21],
        iq: [4.76, 2.63],
        id: -1.21,
        ramp: 0.5,
        noise: 8.3e-3,
        unlogged: 0.0,
        lost: 0.0,
    };
    let fast = Drive {
        motor: Motor { rs: 0.656, ld: 1.123e-3, lq: 1.197e-3, psi_f: 0.0232 },
        pole_pairs: 4,
        u_dc: 678.0,
        bandwidth: 100.0,
        is_switched: true,
        speed: [151.8, 163.1],
        iq: [4.02, 0.96],
        id: -3.18,
        ramp: 0.5,
        noise: 5.7e-3,
        unlogged: 0.0,
        lost: 0.0,
    };
    let rarely_excited = Drive {
        motor: Motor { rs: 1.328, ld: 6.61e-3, lq: 8.31e-3, psi_f: 0.2247 },
        pole_pairs: 3,
        u_dc: 572.0,
        bandwidth: 50.0,
        is_switched: false,
        speed: [67.9, 74.3],
        iq: [2.45, 1.58],
        id: -0.56,
        ramp: 2.0,
        noise: 6.5e-3,
        unlogged: 0.0,
        lost: 0.0,
    };
    for (drive, delay) in [(&slow, Some(2)), (&fast, Some(1)), (&fast, Some(2)), (&rarely_excited, None)] {
        let tracker = followed(TrackSettings::new(Method::EkfTracking, None), &drive.log(delay));
        let (timing, is_settled) = tracker.timing();
        let right = delay.map_or(Timing::Centered, |delay| Timing::Delayed { delay, at_row: false });
        assert!(timing == right || !is_settled, "{delay:?}: {timing:?}");
        holds(&tracker, drive);
    }
}

/// No number is off by more than 1.5 of half its interval and 0.05 %.
fn holds(tracker: &Tracker, drive: &Drive) {
    let Motor { rs, ld, lq, psi_f } = drive.motor;
    for (tracked, truth) in tracker.parameters().unwrap().iter().zip([rs, ld, lq, psi_f]) {
        let (Some(value), Some(half_width)) = (tracked.value, tracked.half_width()) else { continue };
        assert!((value - truth).abs() < 1.5 * half_width + 5e-4 * truth, "{value} for {truth}, half-width {half_width}");
    }
}

/// White voltage that acts and is not logged, from less than a thousandth of the largest voltage to more than its thirtieth: a filter whose
/// level of it is far off has intervals as narrow as its values are biased.
#[test]
fn voltage_that_is_not_logged_is_part_of_the_intervals() {
    let drive = |ramp: f64, unlogged: f64| Drive {
        motor: Motor { rs: 0.52, ld: 1.842e-3, lq: 1.674e-3, psi_f: 0.0902 },
        pole_pairs: 3,
        u_dc: 572.0,
        bandwidth: 100.0,
        is_switched: false,
        speed: [76.5, 103.3],
        iq: [4.07, 2.60],
        id: -0.75,
        ramp,
        noise: 0.0218,
        unlogged,
        lost: 0.0,
    };
    for drive in [drive(2.0, 1.39), drive(0.5, 1.39), drive(0.5, 0.2), drive(0.5, 0.06), drive(0.5, 0.02)] {
        let tracker = followed(TrackSettings::new(Method::EkfTracking, Some(COMMANDS)), &drive.log(Some(1)));
        holds(&tracker, &drive);
        let printed = tracker.parameters().unwrap().iter().filter(|tracked| tracked.value.is_some()).count();
        assert!(printed >= 2, "{printed}");
    }
}

/// White voltage of 0.3 % of the DC voltage, and L_d 17 % less from 2 s on: not found as a step. A filter
/// alone is sure of values that it leaves only after seconds; least squares has changed after one.
#[test]
fn a_step_that_is_not_found_is_in_the_intervals() {
    let mut drive = Drive {
        motor: Motor { rs: 1.4, ld: 0.016, lq: 0.016, psi_f: 0.9726 },
        pole_pairs: 2,
        u_dc: 554.3,
        bandwidth: 50.0,
        is_switched: false,
        speed: [38.0, 46.0],
        iq: [5.04, 3.90],
        id: -2.36,
        ramp: 0.5,
        noise: 0.0129,
        unlogged: 1.66,
        lost: 0.17,
    };
    let rows = drive.log(Some(1));
    drive.motor.ld *= 1.0 - drive.lost;
    let mut tracker = Tracker::new(TrackSettings::new(Method::EkfTracking, Some(COMMANDS)));
    for (k, row) in rows.iter().enumerate() {
        tracker.push(row);
        if row.t > 3.2 && k.is_multiple_of(500) {
            holds(&tracker, &drive);
        }
    }
    assert!(tracker.parameters().unwrap()[1].value.is_some());
}

/// A stream tells nothing until its estimator has caught up, 0.08 s after the first 0.15 s, and then what it tells where nobody waits, to
/// the same bits; so it does at an end before.
#[test]
fn a_stream_catches_up_with_its_beginning() {
    let rows = commands("paper_rig_pwm_noise.csv");
    let settings = settings(Method::EkfTracking);
    let in_time = |count: usize| {
        let mut tracker = Tracker::new(settings);
        rows[..count].iter().for_each(|row| tracker.push_in_time(row));
        tracker
    };
    let bits = |tracker: &Tracker| format!("{:?}", tracker.parameters().unwrap());
    for (count, is_told) in [(1600, false), (2200, false), (2400, true), (3000, true)] {
        let mut tracker = in_time(count);
        assert_eq!(tracker.parameters().is_some(), is_told, "{count}");
        tracker.catch_up();
        assert_eq!(bits(&tracker), bits(&followed(settings, &rows[..count])), "{count}");
    }
}

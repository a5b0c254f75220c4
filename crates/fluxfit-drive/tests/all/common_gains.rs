//! The stated accuracy of gains that no log shows: the intervals hold what such a gain does to the parameters. The expected values are
//! those of the same log with all its currents, or all its voltages, a little larger.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Answer, Known, Model, Parameter, Reason, Request, UnseenError, identify,
    log::{Columns, Log},
    motor::PARAMETERS,
};
use fluxfit_drive::{
    Scenario,
    schedule::{Profile, Ramp},
    simulate,
};
use std::sync::LazyLock;

/// The paper's rig with 50 mA of noise.
static COLUMNS: LazyLock<Columns> = LazyLock::new(|| {
    let mut scenario = Scenario::paper();
    scenario.sensors.current_noise = 0.05;
    simulate(&scenario, 0, || ()).unwrap().log().unwrap().columns().clone()
});

/// 1 %.
const ACCURACY: f64 = 0.01;

/// A gain error that is small enough for its square to be nothing, and large enough to stand out of what iterations leave.
const SMALL: f64 = 1e-3;

/// Half of a normal distribution's 95 % interval, in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// The log with voltages and currents so many times as large.
fn log(u: f64, i: f64) -> Log {
    let scaled = |values: &[f64], factor: f64| values.iter().map(|value| factor * value).collect();
    let Columns { ud, uq, id, iq, .. } = &*COLUMNS;
    Log::new(Columns { ud: scaled(ud, u), uq: scaled(uq, u), id: scaled(id, i), iq: scaled(iq, i), u_dc: None, ..COLUMNS.clone() }).unwrap()
}

fn found(log: &Log, model: Model, request: &Request) -> Answer {
    identify(log, &Request { model: Some(model), ..request.clone() }).unwrap()
}

fn values(answer: &Answer) -> [f64; PARAMETERS] {
    answer.identification.parameters.each_ref().map(|judgement| judgement.raw)
}

fn half_widths(answer: &Answer) -> [f64; PARAMETERS] {
    answer.identification.parameters.each_ref().map(|judgement| judgement.uncertainty.half_width)
}

/// Impedances are uncertain by the currents' accuracy beside what they were, psi_f is not; and a log whose currents are wrong by as much
/// has an interval that holds what the right one gave.
#[test]
fn currents_that_may_be_wrong_widen_impedances_by_as_much() {
    let stated = Request { current_accuracy: Some(ACCURACY), ..Request::default() };
    for model in [Model::Steady, Model::OutputError] {
        let (plain, counted) = (found(&log(1.0, 1.0), model, &Request::default()), found(&log(1.0, 1.0), model, &stated));
        assert_eq!(values(&plain), values(&counted), "the accuracy does not move the value");
        let (before, after) = (half_widths(&plain), half_widths(&counted));
        for parameter in [Parameter::Rs, Parameter::Ld, Parameter::Lq] {
            let p = parameter as usize;
            let expected = before[p].hypot(ACCURACY * values(&plain)[p]);
            assert!((after[p] / expected - 1.0).abs() < 0.02, "{model} {parameter}: {} is not {expected}", after[p]);
        }
        let psi_f = Parameter::PsiF as usize;
        assert!((after[psi_f] / before[psi_f] - 1.0).abs() < 1e-9, "{model}: psi_f has nothing to do with a gain of the currents");
        for gain in [1.0 + ACCURACY, 1.0 - ACCURACY] {
            let wrong = found(&log(1.0, gain), model, &stated);
            for (judgement, right) in wrong.parameters().iter().zip(values(&plain)) {
                let [low, high] = judgement.interval().unwrap();
                // The limit itself is of first order.
                let slack = ACCURACY * ACCURACY * right;
                assert!((low - slack..=high + slack).contains(&right), "{model} {}: {right} at a gain of {gain}", judgement.parameter);
            }
        }
    }
}

/// The accuracy of the DC voltage is that of all parameters, and what is counted is not listed as not counted.
#[test]
fn a_bus_voltage_that_may_be_wrong_widens_all_by_as_much() {
    let stated = Request { bus_accuracy: Some(ACCURACY), ..Request::default() };
    let (plain, counted) = (found(&log(1.0, 1.0), Model::Steady, &Request::default()), found(&log(1.0, 1.0), Model::Steady, &stated));
    for p in 0..PARAMETERS {
        let expected = half_widths(&plain)[p].hypot(ACCURACY * values(&plain)[p]);
        assert!((half_widths(&counted)[p] / expected - 1.0).abs() < 0.02, "{}", Parameter::ALL[p]);
    }
    let unseen = |answer: &Answer| answer.identification.unseen.iter().map(|unseen| unseen.error).collect::<Vec<_>>();
    let counted_errors: Vec<_> = counted.identification.counted.iter().map(|one| (one.error, one.accuracy)).collect();
    assert_eq!(counted_errors, [(UnseenError::BusVoltage, ACCURACY)]);
    assert!(unseen(&plain).contains(&UnseenError::BusVoltage) && plain.identification.counted.is_empty());
    assert!(!unseen(&counted).contains(&UnseenError::BusVoltage) && unseen(&counted).contains(&UnseenError::CurrentGain));
}

/// All parameters move together, so that the ratio of two is as certain as before.
#[test]
fn ratios_stay_as_sharp_as_they_were() {
    let both = Request { current_accuracy: Some(0.03), bus_accuracy: Some(0.02), ..Request::default() };
    // Variance of ln(L_d / L_q).
    let of_ratio = |answer: &Answer| {
        let found = &answer.identification;
        let relative = |p: usize| found.parameters[p].uncertainty.standard_error() / found.parameters[p].raw;
        let (d, q) = (Parameter::Ld as usize, Parameter::Lq as usize);
        relative(d).powi(2) + relative(q).powi(2) - 2.0 * found.correlation[d][q] * relative(d) * relative(q)
    };
    // Where the timing is stated all parts of the uncertainty have a correlation.
    let plain = Request { voltage_accuracy: 0.0, voltage_timing: Some(fluxfit::VoltageTiming::Centered), ..Request::default() };
    let with = |request: &Request| Request { voltage_accuracy: 0.0, voltage_timing: plain.voltage_timing, ..request.clone() };
    for model in [Model::Steady, Model::OutputError] {
        let (before, after) = (of_ratio(&found(&log(1.0, 1.0), model, &plain)), of_ratio(&found(&log(1.0, 1.0), model, &with(&both))));
        assert!((after / before - 1.0).abs() < 1e-3, "{model}: {after} is not {before}");
    }
}

/// A resistance that is known does not move with the others, and takes what it would have moved from them: what is counted is what a log
/// with larger currents, or voltages, answers.
#[test]
fn a_known_resistance_is_taken_into_account() {
    let fixed = Known::Fixed(0.958);
    let prior = Known::Prior { value: 0.958, standard_error: 1e-3 };
    let least = 2e-3 * ACCURACY;
    for (model, known) in [(Model::Steady, fixed), (Model::Steady, prior), (Model::OutputError, fixed), (Model::OutputError, prior)] {
        let request = Request { current_accuracy: Some(ACCURACY), bus_accuracy: Some(ACCURACY), ..Request::default() };
        let request = request.with_known(Parameter::Rs, known);
        let answer = found(&log(1.0, 1.0), model, &request);
        let moved = |u: f64, i: f64| {
            let (more, less) =
                (values(&found(&log(1.0 + u, 1.0 + i), model, &request)), values(&found(&log(1.0 - u, 1.0 - i), model, &request)));
            std::array::from_fn::<f64, PARAMETERS, _>(|p| (more[p] - less[p]) / (2.0 * SMALL) * ACCURACY)
        };
        let (by_u, by_i) = (moved(SMALL, 0.0), moved(0.0, SMALL));
        for (p, judgement) in answer.parameters().iter().enumerate() {
            let counted = judgement.uncertainty.systematic;
            for (what, counted, moved) in [("u", counted.bus_voltage, by_u[p]), ("i", counted.current_gain, by_i[p])] {
                let (counted, moved) = (HALF_WIDTH * counted / judgement.raw, moved.abs() / judgement.raw);
                let close = (counted - moved).abs() <= (0.02 * moved).max(least);
                assert!(close, "{model}, {known:?}, {} by {what}: {counted} counted, {moved} moved", judgement.parameter);
            }
        }
        // R_s drops a part of u_q: what it does not take, psi_f and the inductances do.
        assert!(by_i[Parameter::PsiF as usize].abs() > 5.0 * least * answer.psi_f().raw, "{model}: {by_i:?}");
    }
}

/// The same motor with i_d = 0 at two speeds and loads: at a wrong speed its operating points outvote its currents.
static OF_POINTS: LazyLock<Columns> = LazyLock::new(|| {
    let ramps = |ramps: [(f64, f64, f64); 2]| Profile::new(ramps.map(|(at, to, over)| Ramp { at, to, over }).to_vec());
    let mut scenario = Scenario { duration: 1.2, ..Scenario::paper() };
    scenario.schedule.speed = ramps([(0.0, 104.7, 0.15), (0.7, 41.9, 0.1)]);
    scenario.schedule.load = ramps([(0.2, 3.0, 0.0), (0.7, 12.0, 0.0)]);
    scenario.schedule.id = Profile::default();
    scenario.sensors.current_noise = 0.05;
    simulate(&scenario, 0, || ()).unwrap().log().unwrap().columns().clone()
});

/// A log without its angle, at so many times its speed.
fn at_speed(columns: &Columns, factor: f64) -> Log {
    let omega_e = columns.omega_e.iter().map(|omega_e| factor * omega_e).collect();
    Log::new(Columns { omega_e, theta_e: None, ..columns.clone() }).unwrap()
}

/// The paper's rig without an angle, at its own speed and at that of other pole pairs: operating points suit any speed, simulated currents
/// one. Where there are only points, the speed is told as what nothing confirms.
#[test]
fn a_speed_that_no_angle_confirms_is_confirmed_by_the_currents_or_told() {
    let is_open = |answer: &Answer| answer.identification.unseen.iter().any(|unseen| unseen.error == UnseenError::SpeedScale);
    let right = identify(&at_speed(&COLUMNS, 1.0), &Request::default()).unwrap();
    assert!(right.identification.is_complete() && !is_open(&right));
    assert!(is_open(&found(&at_speed(&COLUMNS, 1.0), Model::Steady, &Request::default())));
    assert!(!is_open(&found(&log(1.0, 1.0), Model::Steady, &Request::default())), "the angle confirms it");
    assert!(identify(&at_speed(&OF_POINTS, 1.0), &Request::default()).unwrap().parameter(Parameter::Lq).value().is_some());
    for (columns, factor) in [(&COLUMNS, 0.75), (&COLUMNS, 1.25), (&OF_POINTS, 0.75), (&OF_POINTS, 1.25)] {
        let answer = identify(&at_speed(columns, factor), &Request::default()).unwrap();
        assert!(std::ptr::eq(columns, &COLUMNS) || answer.identification.model.model == Model::Steady, "points outvote the currents");
        let told = answer.identification.parameters.iter().map(|judgement| judgement.reason.as_ref());
        let too_high = told.map(|reason| match reason {
            Some(Reason::SpeedInDoubt { too_high: [low, high] }) => (low * high).sqrt(),
            other => panic!("{factor}: {other:?}"),
        });
        too_high.for_each(|too_high| assert!((too_high / factor - 1.0).abs() < 0.02, "{factor}: {too_high}"));
    }
}

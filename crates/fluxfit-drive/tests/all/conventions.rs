//! What the check of conventions says of simulated logs in right and in wrong units, given a nameplate.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Known, Model, Nameplate, Request,
    evidence::{Convention, compare_with_nameplate},
    identify,
    log::{Columns, Log},
    motor::{PARAMETERS, Parameter},
    paper,
};
use fluxfit_drive::{Scenario, simulate};
use proptest::prelude::*;
use std::{
    f64::consts::{FRAC_1_SQRT_2, TAU},
    sync::LazyLock,
};

const NAMEPLATE: [f64; PARAMETERS] = [0.958, 5.25e-3, 12e-3, 0.1827];

/// The paper's rig with 50 mA of noise; p = 4.
static COLUMNS: LazyLock<Columns> = LazyLock::new(|| {
    let mut scenario = Scenario::paper();
    scenario.sensors.current_noise = 0.05;
    simulate(&scenario, 0, || ()).unwrap().log().unwrap().columns().clone()
});

/// The columns with voltages, currents and speeds so many times as large.
fn log([u, i, omega]: [f64; 3]) -> Log {
    let scaled = |values: &[f64], factor: f64| values.iter().map(|value| factor * value).collect();
    let columns = &*COLUMNS;
    Log::new(Columns {
        t: columns.t.clone(),
        ud: scaled(&columns.ud, u),
        uq: scaled(&columns.uq, u),
        id: scaled(&columns.id, i),
        iq: scaled(&columns.iq, i),
        omega_e: scaled(&columns.omega_e, omega),
        ..Columns::default()
    })
    .unwrap()
}

fn nameplate(factors: [f64; PARAMETERS]) -> Nameplate {
    Nameplate { values: std::array::from_fn(|p| Some(factors[p] * NAMEPLATE[p])), pole_pairs: Some(paper::POLE_PAIRS), rating: None }
}

fn checked(log: &Log, nameplate: &Nameplate) -> Convention {
    // Of this rig no voltage is lost. Where some may be, two loads tell R_s too badly to compare it.
    let settings = Request { model: Some(Model::Steady), voltage_accuracy: 0.0, ..Request::default() };
    let found = identify(log, &settings).unwrap().identification;
    compare_with_nameplate(log, Some((&found.parameters, &settings.known)), nameplate)
}

/// Names of all single patterns that explain the log, the best first.
fn named(convention: &Convention) -> Vec<&'static str> {
    let candidates = convention.best.iter().chain(&convention.alternatives);
    candidates.filter(|candidate| candidate.patterns.len() == 1).map(|candidate| candidate.patterns[0].name).collect()
}

const ONE: [f64; PARAMETERS] = [1.0; PARAMETERS];

/// Name; what the log's voltages, currents and speeds are multiplied by; what the nameplate's values are. Numbers written out:
/// sqrt 2, sqrt 3, sqrt(3/2), 2 pi, 60/2 pi, p = 4.
const CASES: [(&str, [f64; 3], [f64; PARAMETERS]); 28] = [
    ("line-to-line-voltage", [1.732_051, 1.0, 1.0], ONE),
    ("rms", [FRAC_1_SQRT_2, FRAC_1_SQRT_2, 1.0], ONE),
    ("rms-voltage", [FRAC_1_SQRT_2, 1.0, 1.0], ONE),
    ("rms-current", [1.0, FRAC_1_SQRT_2, 1.0], ONE),
    ("power-invariant-park", [1.224_745, 1.224_745, 1.0], ONE),
    ("line-to-line-rms-voltage", [1.224_745, 1.0, 1.0], ONE),
    ("rpm", [1.0, 1.0, 9.549_297], ONE),
    ("hertz", [1.0, 1.0, 0.159_154_9], ONE),
    ("millivolt", [1000.0, 1.0, 1.0], ONE),
    ("milliampere", [1.0, 1000.0, 1.0], ONE),
    ("millivolt-and-milliampere", [1000.0, 1000.0, 1.0], ONE),
    ("delta-log", [1.732_051, 0.577_350_3, 1.0], ONE),
    ("mechanical-speed", [1.0, 1.0, 0.25], ONE),
    ("mechanical-rpm", [1.0, 1.0, 2.387_324], ONE),
    ("terminal-to-terminal", [1.0; 3], [2.0, 2.0, 2.0, 1.0]),
    ("terminal-resistance", [1.0; 3], [2.0, 1.0, 1.0, 1.0]),
    ("terminal-inductance", [1.0; 3], [1.0, 2.0, 2.0, 1.0]),
    ("line-to-line-flux", [1.0; 3], [1.0, 1.0, 1.0, 1.732_051]),
    ("rms-flux", [1.0; 3], [1.0, 1.0, 1.0, FRAC_1_SQRT_2]),
    ("line-to-line-rms-flux", [1.0; 3], [1.0, 1.0, 1.0, 1.224_745]),
    ("volt-per-hertz", [1.0; 3], [1.0, 1.0, 1.0, TAU]),
    ("line-to-line-volt-per-hertz", [1.0; 3], [1.0, 1.0, 1.0, 10.882_796]),
    ("line-to-line-rms-volt-per-hertz", [1.0; 3], [1.0, 1.0, 1.0, 7.695_299]),
    ("flux-of-mechanical-speed", [1.0; 3], [1.0, 1.0, 1.0, 4.0]),
    ("volt-per-rpm", [1.0; 3], [1.0, 1.0, 1.0, 0.418_879]),
    ("milliohm", [1.0; 3], [1000.0, 1.0, 1.0, 1.0]),
    ("millihenry", [1.0; 3], [1.0, 1000.0, 1000.0, 1.0]),
    ("milliweber", [1.0; 3], [1.0, 1.0, 1.0, 1000.0]),
];

/// With the whole nameplate the effect on all four parameters is found, whatever of the same effect is named first.
#[test]
fn every_confusion_is_named_in_both_directions() {
    for (name, columns, values) in CASES {
        for power in [1, -1] {
            let (columns, values) = (columns.map(|factor| factor.powi(power)), values.map(|factor| factor.powi(power)));
            let convention = checked(&log(columns), &nameplate(values));
            let best = convention.best.as_ref().unwrap_or_else(|| panic!("{name} {power}: {convention:?}"));
            let [u, i, omega] = columns;
            let expected = [u / i / values[0], u / i / omega / values[1], u / i / omega / values[2], u / omega / values[3]];
            for (p, (factor, expected)) in best.factors.iter().zip(expected).enumerate() {
                assert!((factor / expected - 1.0).abs() < 1e-5, "{name} {power}, parameter {p}: {factor}, not {expected}: {best:?}");
                let ratio = convention.ratios[p].ratio;
                assert!((ratio / expected - 1.0).abs() < 0.05, "{name} {power}, parameter {p}: {ratio}, not {expected}");
            }
            assert_eq!(best.explained, Parameter::ALL);
            // The inverse directions have names of their own.
            assert!(power < 0 || named(&convention).contains(&name), "{name}: {:?}", named(&convention));
            assert!(!convention.agrees());
            let warning = convention.to_string();
            assert!(warning.contains(best.patterns[0].sentence) && warning.contains("unproven"), "{}", warning);
        }
    }
}

#[test]
fn swapped_axes() {
    let mut swapped = nameplate(ONE);
    swapped.values.swap(1, 2);
    assert_eq!(named(&checked(&log([1.0; 3]), &swapped))[0], "swapped-axes");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Nameplates are not exact: a motor that is a little off its own is still recognized.
    #[test]
    fn a_confusion_is_among_the_candidates_of_a_motor_that_differs_from_its_nameplate(
        case in 0..CASES.len(), rs in 0.9..1.05, l in 0.95..1.05, psi_f in 0.98..1.02,
    ) {
        let (name, columns, mut values) = CASES[case];
        values.iter_mut().zip([rs, l, l, psi_f]).for_each(|(value, factor)| *value *= factor);
        let convention = checked(&log(columns), &nameplate(values));
        prop_assert!(!convention.agrees());
        prop_assert!(named(&convention).contains(&name), "{}: {:?}", name, convention);
    }

    /// In the right units nothing is said, as long as the motor keeps to its data sheet.
    #[test]
    fn right_units_are_not_suspected(rs in 0.7..1.08, ld in 0.8..1.25, lq in 0.8..1.25, psi_f in 0.93..1.08, known in 0..16) {
        let mut nameplate = nameplate([rs, ld, lq, psi_f]);
        nameplate.values.iter_mut().enumerate().for_each(|(p, value)| *value = value.filter(|_| known & (1 << p) != 0));
        let convention = checked(&log([1.0; 3]), &nameplate);
        prop_assert_eq!(convention.ratios.len() as u32, (known as u32).count_ones());
        prop_assert!(convention.agrees() && convention.best.is_none(), "{:?}", convention);
    }
}

/// Two confusions at once need all kinds of parameters to show.
#[test]
fn two_at_once() {
    // Line to line voltages, and a speed in mechanical r/min.
    let log = log([1.732_051, 1.0, 2.387_324]);
    let convention = checked(&log, &nameplate(ONE));
    let patterns: Vec<&str> = convention.best.as_ref().unwrap().patterns.iter().map(|pattern| pattern.name).collect();
    assert_eq!(patterns, ["line-to-line-voltage", "mechanical-rpm"]);
    // R_s and psi_f alone: sqrt 3 in one, 0.73 in the other, and a pair that explains them proves nothing.
    let mut less = nameplate(ONE);
    (less.values[1], less.values[2]) = (None, None);
    let convention = checked(&log, &less);
    assert!(convention.best.iter().chain(&convention.alternatives).all(|candidate| candidate.patterns.len() == 1), "{convention:?}");
}

#[test]
fn a_factor_without_a_name_gets_none() {
    let convention = checked(&log([1.0; 3]), &nameplate([1.0, 1.0, 1.0, 1.0 / 47.0]));
    assert!(convention.best.is_none() && convention.alternatives.is_empty(), "{convention:?}");
    let message = convention.to_string();
    assert!(message.contains("psi_f 47") && message.contains("no usual confusion"), "{message}");
}

/// Inductances alone differ as much by saturation; not to both sides at once, and not beside other values that fit.
#[test]
fn saturation_is_no_convention() {
    let log = log([1.0; 3]);
    let inductances = |ld, lq| Nameplate { values: [None, Some(ld), Some(lq), None], pole_pairs: Some(4), rating: None };
    let convention = checked(&log, &inductances(5.25e-3 * 2.0, 12e-3 * 1.5));
    assert!(!convention.agrees() && convention.best.is_none(), "{convention:?}");
    let message = convention.to_string();
    assert!(message.contains("times the nameplate's; inductances change as much with current"), "{message}");
    assert_eq!(named(&checked(&log, &inductances(12e-3, 5.25e-3)))[0], "swapped-axes");
    // As likely as a log in mV that was converted twice.
    assert!(named(&checked(&log, &inductances(5.25, 12.0))).contains(&"millihenry"));
}

/// What was given is no finding, and nothing is compared with nothing.
#[test]
fn only_what_the_log_tells_is_compared() {
    let log = log([1.0; 3]);
    let mut settings = Request { model: Some(Model::Steady), ..Request::default() };
    settings.known[0] = Known::Fixed(0.958);
    let found = identify(&log, &settings).unwrap().identification;
    let compared = |nameplate: &Nameplate| compare_with_nameplate(&log, Some((&found.parameters, &settings.known)), nameplate);
    let told: Vec<Parameter> = compared(&nameplate([3.0, 1.0, 1.0, 1.0])).ratios.iter().map(|ratio| ratio.parameter).collect();
    assert_eq!(told, [Parameter::Ld, Parameter::Lq, Parameter::PsiF]);
    assert_eq!(compared(&Nameplate::default()), Convention::default());
    let absurd = Nameplate { values: [Some(f64::NAN), Some(-1.0), Some(0.0), Some(f64::INFINITY)], pole_pairs: Some(0), rating: None };
    assert_eq!(compared(&absurd), Convention::default());
}

/// A light load at speed, never steady: psi_f 2 mWb, R 10 mohm, L 20 uH, i_q sweeping 1 to 4 A at 400 rad/s, where R i and omega L i
/// take at most 5 % of 0.8 V.
fn light_load(u: f64, omega: f64) -> Log {
    let rows = || (0..40).map(|k| f64::from(k) * 0.1);
    let iq: Vec<f64> = rows().map(|t| 2.5 + 1.5 * (2.0 * t).sin()).collect();
    let each = |f: fn(f64) -> f64| iq.iter().map(|i| u * f(*i)).collect();
    Log::new(Columns {
        t: rows().collect(),
        ud: each(|i| -400.0 * 20e-6 * i),
        uq: each(|i| 0.01 * i + 400.0 * 2e-3),
        id: vec![0.0; 40],
        iq: iq.clone(),
        omega_e: vec![400.0 * omega; 40],
        ..Columns::default()
    })
    .unwrap()
}

#[test]
fn rows_tell_the_flux_where_nothing_is_steady() {
    let nameplate = Nameplate { values: [Some(0.01), Some(20e-6), None, Some(2e-3)], pole_pairs: Some(2), rating: None };
    let right = compare_with_nameplate(&light_load(1.0, 1.0), None, &nameplate);
    assert!(right.agrees() && right.ratios[0].apparent, "{right:?}");
    assert!((right.ratios[0].ratio - 1.0).abs() < 1e-9, "{right:?}");
    let line_to_line = compare_with_nameplate(&light_load(1.732_051, 1.0), None, &nameplate);
    assert_eq!(named(&line_to_line)[0], "line-to-line-voltage");
    // Without a nameplate's resistance the rows tell nothing, and neither where it takes most of the voltage.
    let less =
        |rs| compare_with_nameplate(&light_load(1.0, 1.0), None, &Nameplate { values: [rs, Some(20e-6), None, Some(2e-3)], ..nameplate });
    assert!(less(None).ratios.is_empty() && less(Some(0.1)).ratios.is_empty());
}

#[test]
fn a_negative_speed_is_valid_and_one_of_the_wrong_sign_is_not() {
    let nameplate = Nameplate { values: [Some(0.01), Some(20e-6), None, Some(2e-3)], pole_pairs: Some(2), rating: None };
    // Backwards, and braked: u_q and omega change sign together. R i is the only difference.
    let mut columns = light_load(1.0, -1.0).columns().clone();
    columns.uq.iter_mut().chain(&mut columns.iq).for_each(|value| *value = -*value);
    assert!(compare_with_nameplate(&Log::new(columns).unwrap(), None, &nameplate).agrees());
    let wrong = compare_with_nameplate(&light_load(1.0, -1.0), None, &nameplate);
    let message = wrong.to_string();
    assert!(wrong.reversed && message.starts_with("u_q and the speed have opposite signs"), "{message}");
}

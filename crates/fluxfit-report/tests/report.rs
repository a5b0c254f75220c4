//! What every page keeps: nothing is loaded or runs, the markup is sound, no number without a meaning is on it.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fluxfit::{
    Columns, Log, Motor, Verdict,
    frames::Dq,
    identify::{Identification, Known, Settings, identify, model::Model},
    motor::Parameter,
    objective::voltage_error::IdZero,
    optimizer::{Method, bounds::Bounds, draws::Draws},
    paper,
    study::{Convergence, Fitness, MethodStudy, fitness, run_method},
    validate::{Course, Outcome, Prediction, Validation, validate},
};
use fluxfit_files::answer::StudyFacts;
use fluxfit_report::{
    Origin, Report, ValidationReport,
    figure::{self, Size},
    html, validation_html,
};
use html5ever::{driver::ParseOpts, parse_document, tendril::TendrilSink, tree_builder::TreeBuilderOpts};
use markup5ever_rcdom::{Handle, NodeData, RcDom};

/// Rows of each operating point.
const ROWS: usize = 200;

/// A log of the paper's motor at these currents, A, at one speed; noise on the voltages, V.
fn log(currents: &[(f64, f64)], noise: f64) -> Log {
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

const TWO: [(f64, f64); 2] = [(0.0, 9.0), (-2.0, 8.5)];

fn origin() -> Origin {
    Origin { command: "fluxfit identify 'a log.csv'".to_owned(), version: "0.1.0".to_owned(), seed: 7 }
}

fn page(title: &str, log: &Log, found: &Identification, method: Option<Method>) -> String {
    let origin = origin();
    let notes = ["omega_e: column 'n' read as <mechanical> r/min".to_owned()];
    let points = found.operating_points();
    html(&Report {
        title,
        log,
        notes: &notes,
        operating_points: points,
        identification: Some((found, method)),
        study: None,
        origin: &origin,
    })
}

fn identified(currents: &[(f64, f64)], settings: &Settings) -> (Identification, String) {
    let log = log(currents, 0.1);
    let found = identify(&log, settings).unwrap();
    let page = page("drive.csv", &log, &found, settings.method);
    (found, page)
}

/// A study, its page checked; `change` bends what the runs left behind.
fn study_page(methods: &[Method], truth: Option<Motor>, currents: &[(f64, f64)], change: impl Fn(&mut MethodStudy)) -> String {
    let log = log(currents, 0.1);
    let Fitness { operating_points: points, rows, objective } = fitness(&log, &Settings::default(), IdZero::Measured).unwrap();
    let bounds = Bounds::new(vec![0.0; 4], vec![5.0, 0.05, 0.05, 1.0]).unwrap();
    let settings = fluxfit::optimizer::Settings { population: 20, iterations: 12, ..Default::default() };
    let run = |method: &Method| {
        let mut study = run_method(*method, 3, settings, &bounds, &objective, || ()).unwrap();
        change(&mut study);
        (study, 1e-3)
    };
    let methods: Vec<_> = methods.iter().map(run).collect();
    let facts = StudyFacts { settings: &settings, runs: 3, bounds: &bounds, objective: &objective, rows: &rows, truth: truth.as_ref() };
    let origin = origin();
    html(&Report {
        title: "drive.csv",
        log: &log,
        notes: &[],
        operating_points: &points,
        identification: None,
        study: Some((&facts, &methods)),
        origin: &origin,
    })
}

/// The text of a document, after checks that hold for every page.
fn checked(page: &str) -> String {
    let options = ParseOpts { tree_builder: TreeBuilderOpts { exact_errors: true, ..Default::default() }, ..Default::default() };
    let document = parse_document(RcDom::default(), options).one(page);
    assert_eq!(*document.errors.borrow(), Vec::<std::borrow::Cow<str>>::new());
    let (mut text, mut ids) = (String::new(), Vec::new());
    walk(&document.document, &mut text, &mut ids);
    let mut unique = ids.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "ids are not unique: {ids:?}");
    for word in page.split(|c: char| !c.is_alphanumeric()) {
        assert!(!["NaN", "nan", "inf", "Infinity", "undefined"].contains(&word), "the page holds {word}");
    }
    assert!(!page.contains("url(") && !page.contains("@import"));
    text
}

fn walk(node: &Handle, text: &mut String, ids: &mut Vec<String>) {
    match &node.data {
        NodeData::Text { contents } => text.push_str(&contents.borrow()),
        NodeData::Element { name, attrs, .. } => {
            let element = name.local.to_string();
            assert!(!["script", "link", "img", "iframe", "object", "image", "use", "base"].contains(&element.as_str()), "{element}");
            for attribute in attrs.borrow().iter() {
                let (name, value) = (attribute.name.local.to_string(), attribute.value.to_string());
                assert!(!name.starts_with("on") && name != "src", "{name}");
                assert!(name != "href" || value.starts_with('#'), "{value}");
                assert!(!value.contains("://"), "{value}");
                if name == "id" {
                    ids.push(value);
                }
            }
        }
        _ => {}
    }
    node.children.borrow().iter().for_each(|child| walk(child, text, ids));
}

#[test]
fn an_identification_has_its_values_verdicts_and_command() {
    let (found, page) = identified(&TWO, &Settings::default());
    assert!(found.is_complete());
    let text = checked(&page);
    for expected in
        ["Four of four parameters identified", "Warning: no-redundancy", "tGFPA", "'a log.csv'", "seed 7", "read as <mechanical>"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert_eq!(page.matches("class=\"badge identified\"").count(), 4 + 1, "four verdicts and the legend");
}

#[test]
fn what_is_not_identifiable_has_no_number_anywhere() {
    let (found, page) = identified(&[(0.0, 9.0), (0.0, 5.0)], &Settings::default());
    let ld = found.parameter(Parameter::Ld);
    assert_eq!(ld.verdict, Verdict::NotIdentifiable);
    let text = checked(&page);
    assert!(text.contains("Three of four parameters identified; not identifiable from this log: Ld."));
    assert!(text.contains("To do: add a stretch at the same speed with id near −2 A."), "{text}");
    // A row of the answer, and none of any other table.
    assert_eq!(page.matches("<th scope=\"row\"><i>L</i><sub>d</sub></th>").count(), 1);
    assert!(page.contains("<th scope=\"row\"><i>L</i><sub>d</sub></th><td class=\"value\">–</td>"));
}

#[test]
fn one_operating_point_answers_nothing_but_lq_and_a_given_value_has_no_verdict() {
    let (_, page) = identified(&TWO[..1], &Settings::default());
    assert!(checked(&page).contains("One of four parameters identified"));
    let known = [Known::Fixed(0.958), Known::Nothing, Known::Nothing, Known::Nothing];
    let (_, page) = identified(&TWO, &Settings { model: Some(Model::Steady), known, method: None, ..Settings::default() });
    let text = checked(&page);
    assert!(text.contains("given: Rs") && text.contains("Given, not identified.") && !text.contains("The swarm"), "{text}");
}

#[test]
fn nothing_identifiable_is_still_a_page() {
    let log = log(&TWO[..1], 0.1);
    let mut found = identify(&log, &Settings::default()).unwrap();
    found.parameters.iter_mut().for_each(|judgement| judgement.verdict = Verdict::NotIdentifiable);
    let text = checked(&page("x", &log, &found, Settings::default().method));
    assert!(text.contains("None of four parameters identified; not identifiable from this log: Rs, Ld, Lq and ψf."), "{text}");
    assert!(!text.contains("The swarm") && !text.contains("Where the uncertainty"));
}

#[test]
fn hostile_texts_are_texts() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Settings::default()).unwrap();
    let title = "</title><script>alert(1)</script>\"'&<img src=x onerror=y>";
    assert!(checked(&page(title, &log, &found, None)).contains(title));
}

#[test]
fn a_study_of_the_papers_motor_stands_beside_the_papers_table() {
    let text = checked(&study_page(&Method::all(), Some(paper::MOTOR), &TWO, |_| ()));
    for expected in ["Four methods ran 3 times each", "0.9639", "5.283", "0.01414", "0.051", "cannot be known", "Fig. 4", "Fig. 5"] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    let other = Motor { rs: 1.0, ..paper::MOTOR };
    assert!(!checked(&study_page(&Method::all(), Some(other), &TWO, |_| ())).contains("0.9639"));
}

#[test]
fn one_method_no_truth_and_what_is_not_excited() {
    let text = checked(&study_page(&Method::all()[3..], None, &[(0.0, 9.0), (0.0, 5.0)], |_| ()));
    assert!(text.contains("APSO ran 3 times;") && text.contains("This log does not excite Ld"), "{text}");
}

#[test]
fn costs_of_zero_no_iterations_and_broken_numbers() {
    let zero = |study: &mut MethodStudy| {
        study.cost_above_optimum.fill(0.0);
        study.convergence.quartiles.fill([0.0; 3]);
    };
    assert!(checked(&study_page(&Method::all(), Some(paper::MOTOR), &TWO, zero)).contains("drawn at that floor"));
    let empty = |study: &mut MethodStudy| study.convergence = Convergence::default();
    assert!(!checked(&study_page(&Method::all(), None, &TWO, empty)).contains("Fig. 4"));
    let start_only = |study: &mut MethodStudy| {
        study.convergence.quartiles.truncate(1);
        study.convergence.parameters_median.truncate(1);
    };
    checked(&study_page(&Method::all(), None, &TWO, start_only));
    let broken = |study: &mut MethodStudy| {
        study.motors.fill(Motor { rs: f64::NAN, ld: f64::INFINITY, lq: 0.0, psi_f: -0.0 });
        study.cost_above_optimum.fill(f64::INFINITY);
        study.convergence.quartiles.fill([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
        study.convergence.parameters_median.fill([f64::NAN; 4]);
    };
    checked(&study_page(&Method::all(), Some(paper::MOTOR), &TWO, broken));
}

#[test]
fn figures_stand_alone() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Settings::default()).unwrap();
    for size in [Size::Wide, Size::Narrow] {
        for svg in [
            figure::intervals(&found, size),
            figure::residuals(found.steady.as_ref().unwrap(), size),
            figure::operating_points(found.operating_points(), size),
        ] {
            assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
            assert!(svg.contains("prefers-color-scheme:dark") && svg.contains("role=\"img\" aria-label=\""));
            assert_eq!(svg.matches("://").count(), 1, "the name space alone");
            let document = parse_document(RcDom::default(), ParseOpts::default()).one(format!("<!DOCTYPE html><title>x</title>{svg}"));
            assert!(document.errors.borrow().is_empty(), "{:?}", document.errors);
        }
    }
}

#[test]
fn the_same_input_is_the_same_page() {
    let pages: [String; 2] = std::array::from_fn(|_| study_page(&Method::all(), None, &TWO, |_| ()));
    assert_eq!(pages[0], pages[1]);
}

/// A validation of a motor on the log of two operating points, changed by `change`, as a page.
fn validation_page(given: Motor, currents: &[(f64, f64)], change: impl FnOnce(&mut Validation)) -> (Validation, String) {
    let log = log(currents, 0.1);
    let mut found = validate(&log, &given.into(), &Settings::default()).unwrap();
    change(&mut found);
    let notes = ["read as <mechanical> speed".to_owned()];
    let origin = Origin { command: "fluxfit validate 'a log.csv' --motor m.toml".to_owned(), version: "0.1.0".to_owned(), seed: 7 };
    let page = validation_html(&ValidationReport {
        title: "a log.csv",
        motor: "<m>.toml",
        log: &log,
        notes: &notes,
        found: &found,
        origin: &origin,
    });
    (found, page)
}

/// Currents as they might come: two stretches, one of them a single row.
fn courses(value: f64) -> Prediction {
    let course = |rows: std::ops::Range<usize>| Course {
        measured: rows.clone().map(|row| Dq { d: (row as f64).sin(), q: 9.0 }).collect(),
        predicted: rows.clone().map(|_| Dq { d: 0.0, q: value }).collect(),
        rows,
    };
    Prediction::Currents(vec![course(0..200), course(300..301)])
}

#[test]
fn a_validation_has_its_verdict_both_motors_and_its_channels() {
    let (found, page) = validation_page(paper::MOTOR, &TWO, |_| ());
    let text = checked(&page);
    assert_eq!(found.outcome, Outcome::Agrees);
    for expected in
        ["<m>.toml on a log.csv", "Agrees within the noise", "The log’s own", "agrees", "Warning: no-redundancy", "read as <mechanical>"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    let (_, page) = validation_page(Motor { lq: 1.03 * paper::MOTOR.lq, ..paper::MOTOR }, &TWO, |_| ());
    let text = checked(&page);
    assert!(text.contains("Contradicts: ") && text.contains("The log asks for Lq 2.9") && text.contains("less than"), "{text}");
}

#[test]
fn a_validation_names_what_the_log_cannot_tell() {
    let (_, page) = validation_page(paper::MOTOR, &[(0.0, 9.0), (0.0, 5.0)], |_| ());
    let text = checked(&page);
    assert!(text.contains("This log cannot tell Ld: it is taken as given.") && text.contains("cannot tell–––"), "{text}");
}

#[test]
fn predicted_currents_are_drawn_whatever_they_are() {
    for value in [9.1, 9.0, f64::NAN, f64::INFINITY, 1e300] {
        let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = courses(value));
        assert!(checked(&page).contains("measured − predicted, A"));
    }
    let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = Prediction::Currents(Vec::new()));
    checked(&page);
    let broken = |found: &mut Validation| {
        found.channels.iter_mut().for_each(|channel| (channel.rms, channel.noise, channel.explained) = (f64::NAN, 0.0, Some(f64::NAN)));
        found.parameters.iter_mut().for_each(|difference| difference.own = None);
    };
    checked(&validation_page(paper::MOTOR, &TWO, broken).1);
}

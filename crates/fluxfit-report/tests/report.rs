//! What every page keeps: nothing is loaded, what runs asks for nothing, the markup is sound, no number without a meaning is on it.

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
    study::{ConvergenceCurves, MethodStudy, fitness::StudyProblem, run_method},
    validate::{Course as Predicted, Given, Outcome, Prediction, Validation, validate},
};
use fluxfit_drive::{
    Scenario,
    schedule::{Profile, Ramp},
    simulate,
};
use fluxfit_files::answer::StudyFacts;
use fluxfit_report::{FigureFile, Origin, Report, Size, ValidationReport, figures, html, screen_figures, validation_html};
use html5ever::{driver::ParseOpts, parse_document, tendril::TendrilSink, tree_builder::TreeBuilderOpts};
use markup5ever_rcdom::{Handle, NodeData, RcDom};
use resvg::tiny_skia::Pixmap;
use std::ops::ControlFlow;

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
    let notes = ["omega_e: column 'n' read as <mechanical> r/min".to_owned()];
    html(&Report { title, notes: &notes, identification: Some((found, method)), ..report(log, found, &origin()) })
}

fn report<'a>(log: &'a Log, found: &'a Identification, origin: &'a Origin) -> Report<'a> {
    let operating_points = found.operating_points();
    Report { title: "x", log, notes: &[], operating_points, identification: Some((found, None)), held_out: None, study: None, origin }
}

/// A figure of the page for a wide screen.
fn screen_figure(log: &Log, found: &Identification, name: &str) -> FigureFile {
    let origin = origin();
    screen_figures(&report(log, found, &origin), Size::Wide).into_iter().find(|figure| figure.name == name).unwrap()
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
    let problem = StudyProblem::steady(&log, &Settings::default(), IdZero::Measured).unwrap();
    let bounds = Bounds::new(vec![0.0; 4], vec![5.0, 0.05, 0.05, 1.0]).unwrap();
    let settings = fluxfit::optimizer::Settings { population: 20, iterations: 12, ..Default::default() };
    let run = |method: &Method| {
        let mut study = run_method(*method, 3, settings, &bounds, &problem.fitness, || ControlFlow::Continue(())).unwrap().unwrap();
        change(&mut study);
        (study, 1e-3)
    };
    let methods: Vec<_> = methods.iter().map(run).collect();
    let facts = StudyFacts { settings: &settings, runs: 3, bounds: &bounds, problem: &problem, truth: truth.as_ref() };
    let origin = origin();
    let report = Report {
        title: "drive.csv",
        log: &log,
        notes: &[],
        operating_points: &problem.operating_points,
        identification: None,
        held_out: None,
        study: Some((&facts, &methods)),
        origin: &origin,
    };
    let page = html(&report);
    assert_eq!(page.matches("<figure>").count(), figures(&report).len());
    page
}

/// The text of a document, after checks that hold for every page.
fn checked(page: &str) -> String {
    let options = ParseOpts { tree_builder: TreeBuilderOpts { exact_errors: true, ..Default::default() }, ..Default::default() };
    let document = parse_document(RcDom::default(), options).one(page);
    assert_eq!(*document.errors.borrow(), Vec::<std::borrow::Cow<str>>::new());
    let (mut text, mut ids) = (String::new(), Vec::new());
    let mut scripts = Vec::new();
    walk(&document.document, &mut text, &mut ids, &mut scripts);
    let [script] = scripts.as_slice() else { panic!("{} scripts run", scripts.len()) };
    for request in REQUESTS {
        assert!(!script.contains(request), "the script holds {request}");
    }
    assert!(!page.contains("://"), "the page holds an address");
    assert!(page.contains("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "));
    let mut unique = ids.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "ids are not unique: {ids:?}");
    for word in page.replace(script.as_str(), "").split(|c: char| !c.is_alphanumeric()) {
        assert!(!["NaN", "nan", "inf", "Infinity", "undefined"].contains(&word), "the page holds {word}");
    }
    assert!(!page.contains("url(") && !page.contains("@import"));
    text
}

/// What a script would need to ask for something, or to make text run.
const REQUESTS: [&str; 14] = [
    "fetch(",
    "XMLHttpRequest",
    "WebSocket",
    "EventSource",
    "sendBeacon",
    "import(",
    "Worker",
    "new Image",
    ".src",
    "url(",
    "eval(",
    "new Function",
    "innerHTML",
    "document.write",
];

/// Gathers the text that is read, the ids, and the scripts that run.
fn walk(node: &Handle, text: &mut String, ids: &mut Vec<String>, scripts: &mut Vec<String>) {
    if let NodeData::Element { name, attrs, .. } = &node.data
        && &*name.local == "script"
    {
        let mut content = String::new();
        node.children.borrow().iter().for_each(|child| walk(child, &mut content, ids, scripts));
        match attrs.borrow().as_slice() {
            [] => scripts.push(content),
            [data] => {
                assert_eq!((&*data.name.local, &*data.value), ("type", "application/json"));
                serde_json::from_str::<serde_json::Value>(&content).unwrap();
            }
            more => panic!("{more:?}"),
        }
        return;
    }

    match &node.data {
        NodeData::Text { contents } => text.push_str(&contents.borrow()),
        NodeData::Element { name, attrs, .. } => {
            let element = name.local.to_string();
            assert!(!["link", "img", "iframe", "object", "image", "use", "base"].contains(&element.as_str()), "{element}");
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
    node.children.borrow().iter().for_each(|child| walk(child, text, ids, scripts));
}

/// The values along a figure, and those of each panel's series.
type Numbers = (Vec<f64>, Vec<Vec<Vec<f64>>>);

/// The numbers of a page's figures, as its script reads them.
fn data(page: &str) -> Vec<Numbers> {
    let column = |column: &serde_json::Value| -> Vec<f64> {
        let scale = 10.0_f64.powi(column["exponent"].as_i64().unwrap() as i32);
        let steps = column["steps"].as_array().unwrap().iter().map(serde_json::Value::as_i64);
        let mut sum = 0;
        steps
            .map(|step| {
                step.map_or(f64::NAN, |step| {
                    sum += step;
                    sum as f64 * scale
                })
            })
            .collect()
    };
    let texts = page.split("<script type=\"application/json\">").skip(1).map(|rest| rest.split_once("</script>").unwrap().0);
    let figures = texts.map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap());
    let series = |panel: &serde_json::Value| panel["series"].as_array().unwrap().iter().map(|one| column(&one["values"])).collect();
    figures.map(|live| (column(&live["x"]["values"]), live["panels"].as_array().unwrap().iter().map(series).collect())).collect()
}

#[test]
fn the_data_of_a_figure_are_those_of_the_log() {
    let log = recorded(0.09, |_| ());
    let found = identify(&log, &of_currents()).unwrap();
    let page = page("x", &log, &found, None);
    let (t, panels) = &data(&page)[0];
    let [d, d_missed, q, q_missed] = panels.as_slice() else { panic!("{}", panels.len()) };
    // Every row, and in the gap one without values.
    assert_eq!(t.len(), log.rows() + 1);
    let gap = t.iter().position(|t| (0.0801..0.0899).contains(t)).unwrap();
    assert!([d, d_missed, q, q_missed].into_iter().flatten().all(|series| series.len() == t.len() && series[gap].is_nan()));
    let columns = log.columns();
    for row in 0..log.rows() {
        let at = if row < gap { row } else { row + 1 };
        for (shown, measured) in [(t[at], columns.t[row]), (d[0][at], columns.id[row]), (q[0][at], columns.iq[row])] {
            assert!((shown - measured).abs() < 1e-3, "row {row}: {shown} and {measured}");
        }
        // The residuals are in milliampere, and the difference of the upper panel's curves.
        for (above, missed) in [(d, d_missed), (q, q_missed)] {
            assert!((above[0][at] - above[1][at] - 1e-3 * missed[0][at]).abs() < 2e-3, "row {row}");
        }
    }
}

#[test]
fn an_identification_shows_values_verdicts_and_command() {
    let (found, page) = identified(&TWO, &Settings { model: Some(Model::Steady), method: Some(Method::all()[0]), ..Settings::default() });
    assert!(found.is_complete());
    let text = checked(&page);
    for expected in
        ["Four of four parameters identified", "Warning: no-redundancy", "tGFPA", "'a log.csv'", "seed 7", "read as <mechanical>"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert_eq!(page.matches("class=\"badge identified\"").count(), 4 + 1, "four verdicts and the legend");
}

/// Without a browser this test prints a note and checks nothing.
#[test]
fn the_script_draws_every_figure_with_data() {
    let log = recorded(0.09, |_| ());
    let found = identify(&log, &of_currents()).unwrap();
    let page = page("x", &log, &found, None);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("page.html");
    std::fs::write(&path, &page).unwrap();
    let arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"];
    let profile = format!("--user-data-dir={}", directory.path().join("profile").display());
    let run = |browser: &str| std::process::Command::new(browser).args(arguments).arg(&profile).arg(&path).output();
    let drawn = ["chromium", "google-chrome", "chromium-browser"].into_iter().find_map(|browser| run(browser).ok());
    let Some(drawn) = drawn.filter(|drawn| drawn.status.success()) else {
        println!("skipped: no chromium that runs here, so the script was not tried");
        return;
    };
    let drawn = String::from_utf8(drawn.stdout).unwrap();
    assert_eq!(drawn.matches("<figure class=\"live\">").count(), data(&page).len());
    // Four panels of currents, residuals, operating points.
    assert_eq!(drawn.matches("<canvas").count(), 6);
}

#[test]
fn a_parameter_that_is_not_identifiable_has_no_number() {
    let (found, page) = identified(&[(0.0, 9.0), (0.0, 5.0)], &Settings { model: Some(Model::Steady), ..Settings::default() });
    let ld = found.parameter(Parameter::Ld);
    assert_eq!(ld.verdict, Verdict::NotIdentifiable);
    let text = checked(&page);
    assert!(text.contains("Three of four parameters identified; not identifiable from this log: Ld."));
    assert!(text.contains("To do: add 0.2 s at id = −2 A, same speed: Ld to about ±"), "{text}");
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
    assert!(text.contains("given: Rs") && text.contains("Given, not identified.") && !text.contains("swarm"), "{text}");
}

#[test]
fn a_page_without_any_identified_parameter() {
    let log = log(&TWO[..1], 0.1);
    let mut found = identify(&log, &Settings::default()).unwrap();
    found.parameters.iter_mut().for_each(|judgement| judgement.verdict = Verdict::NotIdentifiable);
    let text = checked(&page("x", &log, &found, Settings::default().method));
    assert!(text.contains("None of four parameters identified; not identifiable from this log: Rs, Ld, Lq and ψf."), "{text}");
    assert!(!text.contains("swarm") && !text.contains("Sources of uncertainty"));
}

/// A log of the paper's motor as a drive records it: up to speed in 0.1 s, a step of i_d on the way; noise of 50 mA on each current.
/// After 0.08 s it is only recorded again from `resumed` s on.
fn recorded(resumed: f64, change: impl Fn(&mut Scenario)) -> Log {
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

fn of_currents() -> Settings {
    Settings { model: Some(Model::OutputError), ..Settings::default() }
}

#[test]
fn simulated_currents_have_their_own_sections() {
    let log = recorded(0.08, |_| ());
    let found = identify(&log, &of_currents()).unwrap();
    let text = checked(&page("x", &log, &found, None));
    // Noise of 50 mA a phase is 50 mA times the root of two thirds, 40.8 mA, along each axis; its rms of 1601 rows is right to 0.7 mA.
    let (_, missed) = text.split_once("Simulated and measured currents differ by ").unwrap();
    for mark in [" mA (d)", " mA (q)"] {
        let number = missed.split_once(mark).unwrap().0.rsplit(' ').next().unwrap();
        assert!((number.parse::<f64>().unwrap() - 40.8).abs() < 2.1, "{number}");
    }
    for expected in [
        "Model: output error (as stated)",
        "Measured against simulated",
        "White: of 50 correlations",
        "The logged voltage of a row is taken as the mean of the two periods around the row, determined from the currents. No fault of the \
         drive was found",
        "None of the faults below was found.",
        "explains too little of the residual",
        "ruled out",
        "1601, of which 1601 were simulated",
    ] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert!(!text.contains("squared standard uncertainty") && !text.contains("Gaps in the log"));
}

#[test]
fn the_table_of_correlations_has_the_numbers_of_the_answer() {
    let log = recorded(0.08, |_| ());
    let found = identify(&log, &of_currents()).unwrap();
    let page = page("x", &log, &found, None);
    let (_, table) = page.split_once("<table class=\"heat\">").unwrap();
    let (table, _) = table.split_once("</table>").unwrap();
    assert_eq!(table.matches("<td class=\"own\">1</td>").count(), 4);
    let [rs, psi_f] = [Parameter::Rs, Parameter::PsiF].map(|parameter| parameter as usize);
    let shown = format!("{:.2}", found.correlation[rs][psi_f]).replace('-', "\u{2212}");
    assert!(table.matches(&format!(">{shown}</td>")).count() >= 2, "{shown} is not twice in {table}");
    assert!(page.contains("aria-label=\"Ellipse: joint 95 % region of R_s and psi_f"));
}

#[test]
fn there_is_no_ellipse_of_a_given_or_missing_parameter() {
    let log = recorded(0.08, |_| ());
    let known = [Known::Fixed(0.958), Known::Nothing, Known::Nothing, Known::Nothing];
    let mut found = identify(&log, &Settings { known, ..of_currents() }).unwrap();
    let text = checked(&page("x", &log, &found, None));
    assert!(text.contains("There is no joint region: Rs was given."), "{text}");
    found.parameters[Parameter::PsiF as usize].verdict = Verdict::NotIdentifiable;
    let text = checked(&page("x", &log, &found, None));
    assert!(text.contains("There is no joint region: ψf cannot be identified from this log."), "{text}");
}

#[test]
fn faults_of_the_drive_are_shown_with_their_values() {
    let log = recorded(0.08, |scenario| scenario.sensors.current_offset = [0.0, 0.3, 0.0]);
    let found = identify(&log, &of_currents()).unwrap();
    let page = page("x", &log, &found, None);
    let text = checked(&page);
    // A third of the offset of phase b is common to all three and seen by nobody; Clarke makes of it -0.1 A and 0.3 / sqrt 3 = 0.173 A.
    let shown = |key: &str| {
        let (_, rest) = page.split_once(&format!("<th scope=\"row\">Current sensor offset, {key}</th><td>")).unwrap();
        let (value, rest) = rest.split_once(" ± ").unwrap();
        let (margin, _) = rest.split_once(" mA").unwrap();
        (value.replace('\u{2212}', "-").parse::<f64>().unwrap(), margin.parse::<f64>().unwrap())
    };
    for (key, expected) in [("alpha", -100.0), ("beta", 300.0 / 3.0_f64.sqrt())] {
        let (value, margin) = shown(key);
        assert!((value - expected).abs() < 2.0 * margin && margin < 0.2 * expected.abs(), "{key}: {value} ± {margin}");
    }
    assert!(text.contains("includes the identified faults of the sensors"), "{text}");
}

#[test]
fn gaps_are_not_bridged_and_missing_operating_points_are_reported() {
    let log = recorded(0.09, |_| ());
    let mut found = identify(&log, &of_currents()).unwrap();
    found.steady = None;
    let text = checked(&page("x", &log, &found, None));
    for expected in
        ["1501, of which 1501 were simulated; the log has no operating point", "Gaps in the log are not bridged", "Simulated stretches"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert!(!text.contains("Operating points, as a check") && !text.contains("Windows of the operating points"));
    // Per axis a measured and a simulated piece on either side of the gap, and a residual.
    let svg = screen_figure(&log, &found, "currents").svg;
    let long = svg.split("<polyline").skip(1).filter(|line| line.split_once('>').unwrap().0.matches(',').count() > 100);
    assert_eq!(long.count(), 2 * 3 * 2);
}

#[test]
fn a_million_rows_make_a_page_of_less_than_a_megabyte_that_shows_a_single_row() {
    let mut found = identify(&recorded(0.08, |_| ()), &of_currents()).unwrap();
    let rows = 1_000_000;
    let mut draws = Draws::seeded(5, 0);
    let mut column = |mean: f64| (0..rows).map(|_| mean + 0.1 * draws.normal()).collect::<Vec<f64>>();
    let [ud, uq, mut id, iq, omega_e] = [0.0, 50.0, -2.0, 9.0, 400.0].map(&mut column);
    id[654_321] = 37.0;
    let log = Log::new(Columns { t: (0..rows).map(|k| k as f64 * 1e-4).collect(), ud, uq, id, iq, omega_e, ..Columns::default() }).unwrap();
    let fit = found.output.as_mut().unwrap();
    fit.stretches = log.segments().iter().map(|segment| segment.rows.clone()).collect();
    fit.residuals = [column(0.0), column(0.0)].concat();
    let page = page("x", &log, &found, None);
    assert!(page.len() < 900_000, "{}", page.len());
    let (t, panels) = &data(&page)[0];
    assert!(t.len() <= 6_000 && checked(&page).contains("Of this long log, the page contains only"), "{}", t.len());
    let peak = t.iter().position(|t| (t - 65.4321).abs() < 1e-6).unwrap();
    assert_eq!(panels[0][0][peak], 37.0);
    // The axis of i_d reaches up to the row that stands out.
    let svg = screen_figure(&log, &found, "currents").svg;
    assert!(svg.lines().any(|line| line.trim() == "20") && svg.lines().any(|line| line.trim() == "0"), "no tick at 20 A");
}

#[test]
fn the_swarm_search_of_simulated_currents_is_not_called_linear() {
    let log = recorded(0.08, |_| ());
    let search = fluxfit::optimizer::Settings { population: 10, iterations: 5, ..Default::default() };
    let method = Some(Method::all()[0]);
    let found = identify(&log, &Settings { method, search, ..of_currents() }).unwrap();
    let text = checked(&page("x", &log, &found, method));
    assert!(
        text.contains("Simulated currents are not linear in the parameters") && !text.contains("exact least-squares solution"),
        "{text}"
    );
}

#[test]
fn markup_in_texts_is_escaped() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Settings::default()).unwrap();
    let title = "</title><script>alert(1)</script>\"'&<img src=x onerror=y>";
    assert!(checked(&page(title, &log, &found, None)).contains(title));
}

#[test]
fn a_study_of_the_papers_motor_shows_the_papers_table() {
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
    assert!(checked(&study_page(&Method::all(), Some(paper::MOTOR), &TWO, zero)).contains("rounding errors and drawn at that value"));
    let empty = |study: &mut MethodStudy| study.convergence = ConvergenceCurves::default();
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
fn screen_figures_are_complete_svg_files() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Settings::default()).unwrap();
    let fast = recorded(0.08, |_| ());
    let of_fast = identify(&fast, &of_currents()).unwrap();
    let origin = origin();
    for size in [Size::Wide, Size::Narrow] {
        let figures = [screen_figures(&report(&fast, &of_fast, &origin), size), screen_figures(&report(&log, &found, &origin), size)];
        for FigureFile { svg, .. } in figures.into_iter().flatten() {
            assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
            assert!(svg.contains("prefers-color-scheme:dark") && svg.contains("role=\"img\" aria-label=\""));
            assert_eq!(svg.matches("://").count(), 1, "the name space alone");
            let document = parse_document(RcDom::default(), ParseOpts::default()).one(format!("<!DOCTYPE html><title>x</title>{svg}"));
            assert!(document.errors.borrow().is_empty(), "{:?}", document.errors);
        }
    }
}

#[test]
fn held_out_data_have_a_section() {
    let (log, kept_out) = (recorded(0.08, |_| ()), recorded(0.08, |scenario| scenario.sensors.current_noise = 0.06));
    let found = identify(&log, &of_currents()).unwrap();
    let validation = validate(&kept_out, &Given::of(&found).unwrap(), &of_currents()).unwrap();
    let origin = origin();
    let shown = Report {
        title: "x",
        log: &log,
        notes: &[],
        operating_points: found.operating_points(),
        identification: Some((&found, None)),
        held_out: Some((&kept_out, Some(&validation))),
        study: None,
        origin: &origin,
    };
    let (page, files) = (html(&shown), figures(&shown));
    let text = checked(&page);
    assert!(text.contains("Held-out data") && text.contains("These 1601 rows, 0.160 s, were not used for the answer above"), "{text}");
    assert!(text.contains("Measured against predicted") && text.contains("agrees"), "{text}");
    assert!(files.iter().any(|file| file.name == "held-out") && page.matches("<figure>").count() == files.len());
    let text = checked(&html(&Report { held_out: Some((&kept_out, None)), ..shown }));
    assert!(text.contains("They are not predicted, because a prediction needs all four parameters."), "{text}");
}

#[test]
fn every_figure_of_the_page_is_a_file_for_white_paper() {
    let log = recorded(0.08, |_| ());
    let found = identify(&log, &of_currents()).unwrap();
    let origin = origin();
    let shown = Report {
        title: "x",
        log: &log,
        notes: &[],
        operating_points: found.operating_points(),
        identification: Some((&found, None)),
        held_out: None,
        study: None,
        origin: &origin,
    };
    let files = figures(&shown);
    assert_eq!(html(&shown).matches("<figure>").count(), files.len());
    assert_eq!(
        files.iter().map(|file| file.name).take(4).collect::<Vec<_>>(),
        ["intervals", "currents", "autocorrelation", "joint-region"]
    );
    for file in files {
        assert!(file.svg.contains("fill=\"#FFFFFF\"") && file.svg.contains("font-family=\"Inter, sans-serif\""), "{}", file.name);
        assert!(!file.svg.contains("prefers-color-scheme") && !file.svg.contains("font-family=\"sans-serif\""));
        let height: u32 = file.svg.split_once(" height=\"").unwrap().1.split_once('"').unwrap().0.parse().unwrap();
        let picture = Pixmap::decode_png(&file.png()).unwrap();
        assert_eq!((picture.width(), picture.height()), (1440, 2 * height));
        assert!(picture.pixels().iter().all(|pixel| pixel.alpha() == 255));
        // The names of the axes stand in a strip that nothing else reaches into.
        let name = (0..28).flat_map(|y| (0..100).map(move |x| (x, y))).filter(|(x, y)| picture.pixel(*x, *y).unwrap().red() < 100);
        assert!(file.name == "intervals" || name.count() > 20, "{} has no letters", file.name);
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
    let course = |rows: std::ops::Range<usize>| Predicted {
        measured: rows.clone().map(|row| Dq { d: (row as f64).sin(), q: 9.0 }).collect(),
        predicted: rows.clone().map(|_| Dq { d: 0.0, q: value }).collect(),
        rows,
    };
    Prediction::Currents(vec![course(0..200), course(300..301)])
}

#[test]
fn a_validation_shows_verdict_parameters_and_channels() {
    let (found, page) = validation_page(paper::MOTOR, &TWO, |_| ());
    let text = checked(&page);
    assert_eq!(found.outcome, Outcome::Agrees);
    for expected in
        ["<m>.toml on a log.csv", "Agrees within the noise", "From this log", "agrees", "Warning: no-redundancy", "read as <mechanical>"]
    {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    let (_, page) = validation_page(Motor { lq: 1.03 * paper::MOTOR.lq, ..paper::MOTOR }, &TWO, |_| ());
    let text = checked(&page);
    assert!(text.contains("Contradicts: ") && text.contains("The log asks for Lq 2.9") && text.contains("less than"), "{text}");
}

#[test]
fn a_validation_names_parameters_that_are_not_identifiable() {
    let (_, page) = validation_page(paper::MOTOR, &[(0.0, 9.0), (0.0, 5.0)], |_| ());
    let text = checked(&page);
    assert!(text.contains("This log cannot tell Ld: it is taken as given.") && text.contains("not identifiable–––"), "{text}");
}

#[test]
fn predicted_currents_are_drawn_whatever_they_are() {
    for value in [9.1, 9.0, f64::NAN, f64::INFINITY, 1e300] {
        let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = courses(value));
        assert!(checked(&page).contains("measured − predicted, "));
    }
    let (_, page) = validation_page(paper::MOTOR, &TWO, |found| found.prediction = Prediction::Currents(Vec::new()));
    checked(&page);
    let broken = |found: &mut Validation| {
        found.channels.iter_mut().for_each(|channel| (channel.rms, channel.noise, channel.explained) = (f64::NAN, 0.0, Some(f64::NAN)));
        found.parameters.iter_mut().for_each(|difference| difference.own = None);
    };
    checked(&validation_page(paper::MOTOR, &TWO, broken).1);
}

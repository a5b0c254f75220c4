//! The page of an identification, and its sections.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{
    figures::screen_figure,
    logs::{Found, INTERRUPTED, TWO, WHOLE, log, of_currents, origin, recorded, report},
    markup::checked,
};
use fluxfit::{
    Given, Known, Log, Model, Request, Swarm, Verdict, evidence::Identification, identify, motor::Parameter, optimizer::Method, validate,
};
use fluxfit_report::{Options, Report, figures, html};

pub(crate) fn page(title: &str, log: &Log, found: &Identification, method: Option<Method>) -> String {
    let notes = ["omega_e: column 'n' read as <mechanical> r/min".to_owned()];
    html(&Report { title, notes: &notes, identification: Some((found, method)), ..report(log, found, &origin()) })
}

/// Of voltages at the terminals, of which no inverter takes any.
fn identified(currents: &[(f64, f64)], settings: &Request) -> (Identification, String) {
    let log = log(currents, 0.1);
    let found = identify(&log, &Request { voltage_accuracy: 0.0, ..settings.clone() }).unwrap().identification;
    let page = page("drive.csv", &log, &found, found.method);
    (found, page)
}

#[test]
fn an_identification_shows_values_verdicts_and_command() {
    let (found, page) =
        identified(&TWO, &Request { model: Some(Model::Steady), swarm: Swarm::Method(Method::all()[0]), ..Request::default() });
    assert!(found.is_complete());
    let text = checked(&page);
    for expected in [
        "All 4 identified. Nothing more is to be done, but see the warnings.",
        "Warning: no-redundancy",
        "tGFPA",
        "'a log.csv'",
        "seed 7",
        "read as <mechanical>",
    ] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert_eq!(page.matches("class=\"badge identified\"").count(), 4 + 1, "four verdicts and the legend");
}

#[test]
fn a_parameter_that_is_not_identifiable_has_no_number() {
    let (found, page) = identified(&[(0.0, 9.0), (0.0, 5.0)], &Request { model: Some(Model::Steady), ..Request::default() });
    let ld = found.parameter(Parameter::Ld);
    assert_eq!(ld.verdict, Verdict::NotIdentifiable);
    let text = checked(&page);
    assert!(text.contains("3 of 4 identified. Ld needs 0.2\u{a0}s at id\u{a0}=\u{a0}−2\u{a0}A: then about ±"));
    assert!(text.contains("To do next: add 0.2\u{a0}s at id\u{a0}=\u{a0}−2\u{a0}A, same speed: Ld to about ±"), "{text}");
    // A row of the answer, and none of any other table.
    assert_eq!(page.matches("<th scope=\"row\"><i>L</i><sub>d</sub></th>").count(), 1);
    assert!(page.contains("<th scope=\"row\"><i>L</i><sub>d</sub></th><td class=\"value\">–</td>"));
}

#[test]
fn one_operating_point_answers_nothing_but_lq_and_a_given_value_has_no_verdict() {
    let (_, page) = identified(&TWO[..1], &Request::default());
    assert!(checked(&page).contains("1 of 4 identified"));
    let known = [Known::Fixed(0.958), Known::Nothing, Known::Nothing, Known::Nothing];
    let (_, page) = identified(&TWO, &Request { model: Some(Model::Steady), known, swarm: Swarm::Off, ..Request::default() });
    let text = checked(&page);
    assert!(text.contains("All 3 identified, Rs given.") && text.contains("Given, not identified.") && !text.contains("swarm"), "{text}");
}

#[test]
fn a_page_without_any_identified_parameter() {
    let log = log(&TWO[..1], 0.1);
    let mut found = identify(&log, &Request::default()).unwrap().identification;
    found.parameters.iter_mut().for_each(|judgement| judgement.verdict = Verdict::NotIdentifiable);
    let text = checked(&page("x", &log, &found, None));
    assert!(text.contains("None of 4 identified."), "{text}");
    assert!(!text.contains("swarm") && !text.contains("Sources of uncertainty"));
}

#[test]
fn simulated_currents_have_their_own_sections() {
    let Found { log, found } = &*WHOLE;
    let text = checked(&page("x", log, found, None));
    // Noise of 50 mA a phase is 50 mA times the root of two thirds, 40.8 mA, along each axis; its rms of 1601 rows is right to 0.7 mA.
    let (_, missed) = text.split_once("Simulated and measured currents differ by ").unwrap();
    for mark in ["\u{a0}mA (d)", "\u{a0}mA (q)"] {
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
    let Found { log, found } = &*WHOLE;
    let page = page("x", log, found, None);
    let (_, table) = page.split_once("<table class=\"heat\">").unwrap();
    let (table, _) = table.split_once("</table>").unwrap();
    assert_eq!(table.matches("<td class=\"own\">1</td>").count(), 4);
    let [rs, psi_f] = [Parameter::Rs, Parameter::PsiF].map(|parameter| parameter as usize);
    let shown = format!("{:.2}", found.correlation[rs][psi_f]).replace('-', "\u{2212}");
    assert!(table.matches(&format!(">{shown}</td>")).count() >= 2, "{shown} is not twice in {table}");
    // The ellipse is that of the largest number of the table.
    let pairs = (0..4).flat_map(|k| (0..k).map(move |j| (j, k)));
    let (one, other) = pairs.max_by(|a, b| found.correlation[a.0][a.1].abs().total_cmp(&found.correlation[b.0][b.1].abs())).unwrap();
    let [one, other] = [one, other].map(|k| Parameter::ALL[k].symbol());
    assert!(page.contains(&format!("aria-label=\"Ellipse: joint 95 % region of {one} and {other}")), "{one} {other}");
}

#[test]
fn there_is_no_ellipse_of_a_given_or_missing_parameter() {
    let log = recorded(0.08, |_| ());
    let known = [Known::Fixed(0.958), Known::Nothing, Known::Nothing, Known::Nothing];
    let mut found = identify(&log, &Request { known, ..of_currents() }).unwrap().identification;
    let ellipse = |found: &Identification| page("x", &log, found, None).split("Ellipse: joint").nth(1).map(|rest| rest[..60].to_owned());
    let first = ellipse(&found).unwrap();
    assert!(!first.contains("R_s"), "{first}");
    found.parameters[Parameter::PsiF as usize].verdict = Verdict::NotIdentifiable;
    let second = ellipse(&found).unwrap();
    assert!(second.contains("L_d and L_q"), "{second}");
    found.parameters[Parameter::Ld as usize].verdict = Verdict::NotIdentifiable;
    assert_eq!(ellipse(&found), None);
}

#[test]
fn faults_of_the_drive_are_shown_with_their_values() {
    let log = recorded(0.08, |scenario| scenario.sensors.current_offset = [0.0, 0.3, 0.0]);
    let found = identify(&log, &of_currents()).unwrap().identification;
    let page = page("x", &log, &found, None);
    let text = checked(&page);
    // A third of the offset of phase b is common to all three and seen by nobody; Clarke makes of it -0.1 A and 0.3 / sqrt 3 = 0.173 A.
    let shown = |key: &str| {
        let (_, rest) = page.split_once(&format!("<th scope=\"row\">Current sensor offset, {key}</th><td>")).unwrap();
        let (value, rest) = rest.split_once("\u{a0}±\u{a0}").unwrap();
        let (margin, _) = rest.split_once("\u{a0}mA").unwrap();
        (value.replace('\u{2212}', "-").parse::<f64>().unwrap(), margin.parse::<f64>().unwrap())
    };
    for (key, expected) in [("alpha", -100.0), ("beta", 300.0 / 3.0_f64.sqrt())] {
        let (value, margin) = shown(key);
        assert!((value - expected).abs() < 2.0 * margin && margin < 0.2 * expected.abs(), "{key}: {value} ± {margin}");
    }
    assert!(text.contains("includes the identified faults of the sensors"), "{text}");
}

#[test]
fn a_resistance_that_drifts_is_that_in_the_middle_of_the_log() {
    let drifting = recorded(0.08, |scenario| scenario.motor.rs_drift = 0.2);
    for (log, is_said) in [(&drifting, true), (&recorded(0.08, |_| ()), false)] {
        let found = identify(log, &of_currents()).unwrap().identification;
        assert_eq!(checked(&page("x", log, &found, None)).contains("in the middle of the log"), is_said);
    }
}

#[test]
fn gaps_are_not_bridged_and_missing_operating_points_are_reported() {
    let Found { log, mut found } = INTERRUPTED.clone();
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
fn the_swarm_search_of_simulated_currents_is_not_called_linear() {
    let log = recorded(0.08, |_| ());
    let search = fluxfit::optimizer::SearchSettings { population: 10, iterations: 5, ..Default::default() };
    let found = identify(&log, &Request { swarm: Swarm::Method(Method::all()[0]), search, ..of_currents() }).unwrap().identification;
    let text = checked(&page("x", &log, &found, found.method));
    assert!(
        text.contains("Simulated currents are not linear in the parameters") && !text.contains("exact least-squares solution"),
        "{text}"
    );
}

#[test]
fn markup_in_texts_is_escaped() {
    let log = log(&TWO, 0.1);
    let found = identify(&log, &Request::default()).unwrap().identification;
    let title = "</title><script>alert(1)</script>\"'&<img src=x onerror=y>";
    assert!(checked(&page(title, &log, &found, None)).contains(title));
}

#[test]
fn held_out_data_have_a_section() {
    let (log, kept_out) = (recorded(0.08, |_| ()), recorded(0.08, |scenario| scenario.sensors.current_noise = 0.06));
    let found = identify(&log, &of_currents()).unwrap().identification;
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
        online: None,
        json: None,
        options: Options::default(),
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

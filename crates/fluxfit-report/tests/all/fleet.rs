//! The page of a fleet: of any size, with bounded length, and with every name as text.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{logs::origin, markup::checked};
use fluxfit::{
    Verdict,
    fleet::{FleetEstimate, FleetOverview, FleetRow, FleetValue},
    paper,
};
use fluxfit_report::{FleetReport, fleet_figures, fleet_html};

/// The paper's motor with each parameter times a factor, known to a percent.
fn row(motor: &str, factors: [f64; 4]) -> FleetRow {
    let values = paper::MOTOR.to_array();
    let estimate = |k: usize| FleetEstimate {
        verdict: Verdict::Identified,
        value: Some(FleetValue { value: values[k] * factors[k], half_width: 0.01 * values[k] }),
        reason: None,
    };
    FleetRow {
        motor: motor.into(),
        source: "fleet.csv".into(),
        window_start: None,
        estimates: std::array::from_fn(estimate),
        warnings: vec!["coarse-sampling".into()],
        error: None,
    }
}

fn failed(motor: &str, error: &str) -> FleetRow {
    let nothing = FleetEstimate { verdict: Verdict::NotIdentifiable, value: None, reason: None };
    let estimates = std::array::from_fn(|_| nothing.clone());
    FleetRow { estimates, warnings: Vec::new(), error: Some(error.into()), ..row(motor, [1.0; 4]) }
}

/// A fleet whose motors differ by up to two percent.
fn fleet(motors: usize) -> Vec<FleetRow> {
    let factor = |k: usize, of: usize| 1.0 + 0.02 * ((k * of % 41) as f64 / 20.0 - 1.0);
    (0..motors).map(|k| row(&format!("m{k:05}"), [7, 11, 13, 17].map(|of| factor(k, of)))).collect()
}

/// The text of the page, and the page.
fn page(rows: Vec<FleetRow>) -> (String, String) {
    let (overview, origin) = (FleetOverview::of(rows), origin());
    let report = FleetReport { title: "results.parquet", fleet: &overview, origin: &origin };
    let page = fleet_html(&report);
    assert_eq!(page.matches("<figure>").count(), fleet_figures(&report).len());
    (checked(&page), page)
}

#[test]
fn a_fleet_of_any_size_has_a_page() {
    for (rows, sentence) in [
        (Vec::new(), "There are no motors."),
        (fleet(1), "1 motor, all 4 parameters identified."),
        (fleet(3), "3 motors, each with all 4 parameters identified."),
        (vec![failed("a", "the file is empty")], "1 motor, without an answer."),
        (vec![failed("a", "the file is empty"), failed("b", "there is no such file")], "2 motors, none with an answer."),
        (
            [fleet(2), vec![failed("x", "the file is empty")]].concat(),
            "2 with all 4 parameters identified, 0 with fewer, 1 without an answer.",
        ),
    ] {
        let (text, _) = page(rows);
        assert!(text.contains(sentence), "{sentence} is not in\n{text}");
    }
}

#[test]
fn a_large_fleet_has_a_short_page_that_counts_what_it_leaves_out() {
    let mut rows = fleet(10_000);
    rows.extend((0..300).map(|k| failed(&format!("f{k:03}"), &format!("motor f{k:03} of fleet.csv, row {k}: 'x' is not a number"))));
    rows.push(row("unit", [1.0, 0.42, 0.42, 0.42]));
    let (text, page) = page(rows);
    assert!(page.len() < 300_000, "{} bytes", page.len());
    for expected in [
        "10301 motors: 10001 with all 4 parameters identified, 0 with fewer, 300 without an answer.",
        "1 stands apart from the others: unit.",
        "f000, f001, f002, f003, f004 and 295 more",
        // 40 are listed: two of the 300, the motor that stands apart or not, and the rest of the list.
        "10\u{202f}261 more motors are in the results and not listed here: 298 without an answer, 9963 with all parameters identified.",
        "\u{2212}58.0\u{a0}%",
    ] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
}

#[test]
fn a_parameter_that_drifts_is_named_with_its_movement() {
    let window = |motor: &str, hour: f64, resistance: f64| {
        let mut row = row(motor, [resistance, 1.0, 1.0, 1.0]);
        row.window_start = Some(3600.0 * hour);
        row
    };
    let rows =
        (0..4).flat_map(|hour| [window("warm", f64::from(hour), 1.0 + 0.1 * f64::from(hour)), window("steady", f64::from(hour), 1.0)]);
    let (text, page) = page(rows.collect());
    for expected in ["1 drifts: warm.", "Of 2 motors that are known in two windows or more", "Rs of 1", "+26.1\u{a0}%", "4 windows"] {
        assert!(text.contains(expected), "{expected} is not in\n{text}");
    }
    assert!(page.contains("aria-label=\"Curves over time: R_s of warm\""));
}

#[test]
fn names_and_reasons_are_text_and_no_markup() {
    let mut odd = row("<b>&\"x\"", [1.0; 4]);
    odd.estimates[1] = FleetEstimate { verdict: Verdict::NotIdentifiable, value: None, reason: Some("i_d stays < 1".into()) };
    let (text, page) = page(vec![odd, failed("</script>", "<i>no</i>")]);
    assert!(text.contains("<b>&\"x\"") && text.contains("<i>no</i>") && text.contains("stays < 1"), "{text}");
    assert!(!page.contains("<b>&") && !page.contains("<i>no"));
}

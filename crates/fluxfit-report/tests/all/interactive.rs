//! The data of interactive figures, and the script that draws them.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::{
    figures::screen_figure,
    identification::page,
    logs::{Found, INTERRUPTED, WHOLE},
    markup::{checked, data},
};
use fluxfit::{Columns, Log, optimizer::Draws};

#[test]
fn the_data_of_a_figure_are_those_of_the_log() {
    let Found { log, found } = &*INTERRUPTED;
    let page = page("x", log, found, None);
    let (t, panels) = &data(&page)[1];
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
fn the_first_figure_is_the_log_with_every_row() {
    let Found { log, found } = &*INTERRUPTED;
    let (t, panels) = &data(&page("x", log, found, None))[0];
    let columns = log.columns();
    // Every row, and in the gap one without values.
    assert_eq!(t.len(), log.rows() + 1);
    let gap = t.iter().position(|t| (0.0801..0.0899).contains(t)).unwrap();
    for row in 0..log.rows() {
        let at = if row < gap { row } else { row + 1 };
        let [voltages, currents, speed] = panels.as_slice() else { panic!("{} panels", panels.len()) };
        let pairs = [
            (voltages[0][at], columns.ud[row]),
            (voltages[1][at], columns.uq[row]),
            (currents[0][at], columns.id[row]),
            (currents[1][at], columns.iq[row]),
            (speed[0][at], columns.omega_e[row]),
        ];
        for (shown, logged) in pairs {
            assert!((shown - logged).abs() < 0.01, "row {row}: {shown} and {logged}");
        }
    }
}

#[test]
fn all_of_a_hundred_thousand_rows_are_on_the_page() {
    let rows = 100_000;
    let of = |value: f64| (0..rows).map(|k| value + f64::from(k % 13)).collect::<Vec<f64>>();
    let t = (0..rows).map(|k| f64::from(k) * 1e-4).collect();
    let log =
        Log::new(Columns { t, ud: of(1.0), uq: of(50.0), id: of(-2.0), iq: of(9.0), omega_e: of(400.0), ..Columns::default() }).unwrap();
    let page = page("x", &log, &WHOLE.found, None);
    assert_eq!(data(&page)[0].0.len(), 100_000);
}

/// Without a browser this test prints a note and checks nothing.
#[test]
fn the_script_draws_every_figure_with_data() {
    let Found { log, found } = &*INTERRUPTED;
    let page = page("x", log, found, None);
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
    // Three panels of the log, four of currents, residuals, operating points.
    assert_eq!(drawn.matches("<canvas").count(), 9);
}

#[test]
fn a_million_rows_make_a_small_page_that_shows_a_single_row() {
    let mut found = WHOLE.found.clone();
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
    assert!(page.len() < 1_800_000, "{}", page.len());
    let (t, panels) = &data(&page)[1];
    assert!(t.len() <= 6_000 && checked(&page).contains("Of this long log, the page contains only"), "{}", t.len());
    let peak = t.iter().position(|t| (t - 65.4321).abs() < 1e-6).unwrap();
    assert_eq!(panels[0][0][peak], 37.0);
    // The axis of i_d reaches up to the row that stands out.
    let svg = screen_figure(&log, &found, "currents").svg;
    assert!(svg.lines().any(|line| line.trim() == "20") && svg.lines().any(|line| line.trim() == "0"), "no tick at 20 A");
}

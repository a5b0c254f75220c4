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
    // Four panels of currents, residuals, operating points.
    assert_eq!(drawn.matches("<canvas").count(), 6);
}

#[test]
fn a_million_rows_make_a_page_of_less_than_a_megabyte_that_shows_a_single_row() {
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
    assert!(page.len() < 900_000, "{}", page.len());
    let (t, panels) = &data(&page)[0];
    assert!(t.len() <= 6_000 && checked(&page).contains("Of this long log, the page contains only"), "{}", t.len());
    let peak = t.iter().position(|t| (t - 65.4321).abs() < 1e-6).unwrap();
    assert_eq!(panels[0][0][peak], 37.0);
    // The axis of i_d reaches up to the row that stands out.
    let svg = screen_figure(&log, &found, "currents").svg;
    assert!(svg.lines().any(|line| line.trim() == "20") && svg.lines().any(|line| line.trim() == "0"), "no tick at 20 A");
}

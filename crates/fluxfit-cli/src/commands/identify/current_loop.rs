//! The current controllers' gains, each with its interval.

use crate::terminal::{self, DIM, HEADING, table, wrapped};
use fluxfit::{
    current_loop::{CurrentLoop, DELAY_PERIODS, Gain},
    evidence::{Provenance, Resolved},
};
use fluxfit_units::significant;

/// Shows the gains.
pub(crate) fn show(found: &CurrentLoop) -> std::io::Result<()> {
    let Resolved { value: rate, provenance } = found.control_rate;
    let heading = format!(
        "{HEADING}Current controllers{HEADING:#} for {} Hz: phase margin {:.0} degrees with {DELAY_PERIODS} periods of delay at {} Hz{}",
        significant(found.bandwidth, 4),
        found.phase_margin(),
        significant(rate, 5),
        if provenance == Provenance::Stated { "" } else { ", the log's rate" },
    );
    let rows = [("K_p d", found.kp_d, "V/A", "L_d"), ("K_p q", found.kp_q, "V/A", "L_q"), ("K_i d, q", found.ki, "V/(A s)", "R_s")];
    let rows = rows.map(|(name, gain, unit, parameter)| {
        let cells = gain.map_or_else(|| ["-", "", "", ""].map(str::to_owned), |gain| cells(&gain, unit));
        let verdict = gain.map_or("not identifiable".to_owned(), |gain| gain.verdict.key().replace('-', " "));
        [vec![name.to_owned()], cells.to_vec(), vec![format!("{parameter} {verdict}")]].concat()
    });
    let formula = "K_p = 2 pi bandwidth L, K_i = 2 pi bandwidth R_s: u = K_p e + K_i ∫ e dt, couplings fed forward";
    let note = format!("{DIM}{}{DIM:#}\n", wrapped("", formula).trim_end());
    terminal::print(&format!("\n{}{}{note}", wrapped("", &heading), table(&["", "value", "", "95 %", "interval", "from"], 1, rows)))
}

/// Value, unit, relative half-width and interval.
fn cells(gain: &Gain, unit: &str) -> [String; 4] {
    let half = (gain.interval[1] - gain.interval[0]) / 2.0;
    // Three digits of the half-width; four of the value where that is zero.
    let digits = if half > 0.0 { 3 + (gain.value / half).log10().floor().max(0.0) as i32 } else { 4 };
    let [value, low, high] = [gain.value, gain.interval[0], gain.interval[1]].map(|number| significant(number, digits));
    [value, unit.to_owned(), format!("±{} %", significant(100.0 * half / gain.value, 2)), format!("{low} .. {high}")]
}

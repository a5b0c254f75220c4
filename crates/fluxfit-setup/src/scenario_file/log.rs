//! The table `[log]`.

use fluxfit_drive::scenario::{FilterFrame, LoggedRows, Logging};
use fluxfit_files::{FileError, toml_table::Table};
use fluxfit_units::Dimension;

/// Keys of `[log]`.
pub(super) const KEYS: &[&str] = &["filter_frame", "current_filter", "voltage_filter", "speed_filter", "every", "rows", "theta_e", "u_dc"];

pub(super) fn log(table: &Table<'_>) -> Result<Logging, FileError> {
    let complete = Logging::COMPLETE;
    let rows = [("first", LoggedRows::First), ("mean", LoggedRows::Mean)];
    let frames = [("phases", FilterFrame::Phases), ("dq", FilterFrame::Dq)];
    Ok(Logging {
        filter_frame: table.get("filter_frame").map_or(Ok(complete.filter_frame), |entry| entry.word(&frames))?,
        current_filter: table.quantity("current_filter", Dimension::Frequency)?,
        voltage_filter: table.quantity("voltage_filter", Dimension::Frequency)?,
        speed_filter: table.quantity("speed_filter", Dimension::Frequency)?,
        every: table.get("every").map_or(Ok(complete.every), |entry| entry.whole(1, "a whole number above zero"))?,
        rows: table.get("rows").map_or(Ok(complete.rows), |entry| entry.word(&rows))?,
        theta_e: table.get("theta_e").map_or(Ok(complete.theta_e), |entry| entry.boolean())?,
        u_dc: table.get("u_dc").map_or(Ok(complete.u_dc), |entry| entry.boolean())?,
    })
}

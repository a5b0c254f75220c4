//! The page of a fleet: the rows of its results as the library takes them, and what is written.

use super::row::Row;
use crate::{arguments::LogArguments, commands::report, error::CommandError};
use fluxfit::{
    Parameter, Verdict,
    fleet::{FleetEstimate, FleetOverview, FleetRow, FleetValue},
};
use fluxfit_report::{FleetReport, Origin, fleet_figures, fleet_html};
use fluxfit_units::wording::one_line;
use serde_json::Value;
use std::{collections::BTreeSet, sync::Arc};

/// What rows without a motor are called.
const NAMELESS: &str = "(no name)";

/// The rows of the results as the library takes them, which is a small part of what they take beside the names of their columns.
#[derive(Default)]
pub(crate) struct Page {
    rows: Vec<FleetRow>,
    /// Names and codes that rows have in common.
    texts: BTreeSet<Arc<str>>,
}

impl Page {
    /// Of rows that are in memory.
    pub(crate) fn of(rows: &[Row]) -> Self {
        let mut page = Self::default();
        rows.iter().for_each(|row| page.add(row));
        page
    }

    /// Takes a row.
    pub(super) fn add(&mut self, row: &Row) {
        let row = fleet_row(row, |text| shared(&mut self.texts, text));
        self.rows.push(row);
    }

    /// The page as an HTML document.
    pub(crate) fn html(self, title: &str, origin: &Origin) -> String {
        fleet_html(&FleetReport { title, fleet: &self.overview(), origin })
    }

    /// What the rows say together.
    fn overview(self) -> FleetOverview {
        drop(self.texts);
        FleetOverview::of(self.rows)
    }

    /// Writes the page and the figures, as far as they are wanted.
    ///
    /// # Errors
    /// If they cannot be written.
    pub(super) fn write(self, title: &str, log: &LogArguments) -> Result<(), CommandError> {
        let (overview, origin) = (self.overview(), report::origin(log.seed));
        let shown = FleetReport { title, fleet: &overview, origin: &origin };
        report::write(log.report.as_deref(), || fleet_html(&shown), log.figures.as_deref(), || fleet_figures(&shown))
    }
}

/// The text as those before have it, if one has.
fn shared(texts: &mut BTreeSet<Arc<str>>, text: &str) -> Arc<str> {
    if let Some(known) = texts.get(text) {
        return Arc::clone(known);
    }
    let new: Arc<str> = text.into();
    texts.insert(Arc::clone(&new));
    new
}

fn fleet_row(row: &Row, mut shared: impl FnMut(&str) -> Arc<str>) -> FleetRow {
    let text = |name: &str| row.get(name).and_then(Value::as_str);
    let number = |name: &str| row.get(name).and_then(Value::as_f64).filter(|number| number.is_finite());
    let estimate = |parameter: Parameter| {
        let of = |end: &str| format!("{}{end}", parameter.key());
        let ends = number(&of("_low")).zip(number(&of("_high")));
        let value = number(&of("")).zip(ends).map(|(value, (low, high))| FleetValue { value, half_width: 0.5 * (high - low) });
        FleetEstimate {
            verdict: text(&of("_verdict")).and_then(Verdict::of_key).unwrap_or(Verdict::NotIdentifiable),
            value,
            reason: text(&of("_reason")).map(Arc::from),
        }
    };
    let motor = text("motor").filter(|name| !name.is_empty()).map_or_else(|| NAMELESS.to_owned(), one_line);
    FleetRow {
        motor: shared(&motor),
        source: shared(text("source").unwrap_or_default()),
        window_start: number("window_start"),
        estimates: Parameter::ALL.map(estimate),
        warnings: text("warnings").unwrap_or_default().split_whitespace().map(&mut shared).collect(),
        error: text("error").map(Arc::from),
    }
}

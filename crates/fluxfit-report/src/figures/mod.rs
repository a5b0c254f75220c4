//! The figures of the pages. A new figure is a file here and a line of [`FIGURES`].

mod autocorrelation;
mod convergence;
mod currents;
mod fleet;
mod flux;
mod intervals;
mod joint_region;
mod online;
mod operating_points;
mod parameters;
mod prediction;
mod recording;
mod voltage_residuals;

use crate::{
    figure::Figure,
    report::{FleetReport, Report, ValidationReport},
};

/// Makes a figure of a report; `None` if the report lacks its data.
type MakeFigure = for<'a> fn(&Report<'a>) -> Option<Figure<'a>>;

/// All figures of a report, in the order of the page.
const FIGURES: [MakeFigure; 12] = [
    flux::figure,
    online::figure,
    recording::figure,
    intervals::figure,
    currents::figure,
    autocorrelation::figure,
    prediction::held_out,
    joint_region::figure,
    voltage_residuals::figure,
    operating_points::figure,
    convergence::figure,
    parameters::figure,
];

/// The figures of a report.
pub(crate) fn of_report<'a>(report: &Report<'a>) -> Vec<Figure<'a>> {
    FIGURES.iter().filter_map(|make| make(report)).collect()
}

/// The figures of a validation.
pub(crate) fn of_validation<'a>(report: &ValidationReport<'a>) -> Vec<Figure<'a>> {
    prediction::of_validation(report).into_iter().collect()
}

/// The figures of a fleet.
pub(crate) fn of_fleet<'a>(report: &FleetReport<'a>) -> Vec<Figure<'a>> {
    [fleet::distributions(report.fleet), fleet::drifts(report.fleet)].into_iter().flatten().collect()
}

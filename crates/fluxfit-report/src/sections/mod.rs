//! The sections of the pages. A new section is a file here and a line of [`SECTIONS`].

mod answer;
mod correlation;
mod currents;
mod estimates;
mod explanation;
mod faults;
mod fleet;
mod flux;
mod held_out;
mod log;
mod online;
mod operating_points;
mod recording;
mod reproduction;
mod residuals;
mod search;
mod study;
mod uncertainty;
mod validation;

pub(crate) use validation::badge;

use crate::{
    report::{FleetReport, Report, ValidationReport},
    section::Section,
};

/// Makes a section of a report; `None` if the report lacks its data.
type MakeSection = fn(&Report) -> Option<Section>;

/// All sections of a report, in the order of the page.
const SECTIONS: [MakeSection; 16] = [
    answer::section,
    explanation::section,
    online::section,
    recording::section,
    uncertainty::section,
    currents::section,
    residuals::section,
    held_out::section,
    correlation::section,
    faults::section,
    operating_points::section,
    search::section,
    study::section,
    estimates::section,
    log::section,
    reproduction::section,
];

/// All sections of a validation, in the order of the page.
const VALIDATION_SECTIONS: [fn(&ValidationReport) -> Section; 4] =
    [validation::parameters_section, validation::prediction_section, validation::log_section, reproduction::validation_section];

/// The sections of a report.
pub(crate) fn of_report(report: &Report) -> Vec<Section> {
    SECTIONS.iter().filter_map(|make| make(report)).collect()
}

/// The sections of a validation.
pub(crate) fn of_validation(report: &ValidationReport) -> Vec<Section> {
    VALIDATION_SECTIONS.iter().map(|make| make(report)).collect()
}

/// All sections of a fleet, in the order of the page.
const FLEET_SECTIONS: [fn(&FleetReport) -> Option<Section>; 6] = [
    fleet::parameters::section,
    fleet::apart::section,
    fleet::drift::section,
    fleet::causes::section,
    fleet::motors::section,
    reproduction::fleet_section,
];

/// The sections of a fleet.
pub(crate) fn of_fleet(report: &FleetReport) -> Vec<Section> {
    FLEET_SECTIONS.iter().filter_map(|make| make(report)).collect()
}

//! How this program does what the library proposes: the options behind remedies, warnings and errors.

use fluxfit::{Also, ErrorKind, Measurement, Remedy, Warning};

/// The option that carries out a remedy.
pub(crate) fn of_remedy(remedy: &Remedy) -> Option<&'static str> {
    match remedy {
        Remedy::Measure(promised) => matches!(promised.measurement, Measurement::Resistance { .. }).then_some("--prior rs=VALUE±1%"),
        Remedy::AddStretch { also: Some(Also::OrSecondPoint), .. } => Some("--fix rs=VALUE"),
        Remedy::HoldLonger { or, .. } => of_remedy(or),
        Remedy::SpreadPoints { parameter: fluxfit::Parameter::Rs } => Some("--prior rs=VALUE±1%"),
        Remedy::StateVoltageTiming => Some("--voltage-timing"),
        Remedy::CompensateDeadTime { or_resistance: true } | Remedy::FixOne => Some("--fix rs=VALUE"),
        Remedy::RemoveDisturbances => Some("--window T0:T1 --model steady"),
        Remedy::SmallSteps => Some("--model steady"),
        Remedy::SimilarWindows => Some("--window T0:T1"),
        Remedy::SharperPrior => Some("--prior"),
        _ => None,
    }
}

/// The option that answers a warning.
pub(crate) fn of_warning(warning: &Warning) -> Option<&'static str> {
    match warning {
        Warning::NoRedundancy => Some("--fix or --prior"),
        Warning::ShortStretches { .. } | Warning::VoltageLimit { .. } => Some("--window T0:T1"),
        Warning::PhaseMargin { rate_assumed: true, .. } => Some("--control-rate FREQUENCY"),
        _ => None,
    }
}

/// The option that avoids an error.
pub(crate) fn of_error(error: &ErrorKind) -> Option<&'static str> {
    match error {
        ErrorKind::NoOperatingPoint { .. } => Some("--window T0:T1"),
        ErrorKind::Interpolated | ErrorKind::ShortCircuit | ErrorKind::NoFiniteFit => Some("--model steady"),
        ErrorKind::ControlRate { .. } => Some("--control-rate FREQUENCY"),
        _ => None,
    }
}

/// A sentence with the option that does what it says.
pub(crate) fn with_option(sentence: &str, option: Option<&str>) -> String {
    option.map_or_else(|| sentence.to_owned(), |option| format!("{sentence} ({option})"))
}

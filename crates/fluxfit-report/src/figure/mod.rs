//! Figures as SVG. Each function returns a file of its own, which shows on white and on dark grounds; the report embeds the same
//! drawings.
//!
//! | figure | what it shows |
//! |---|---|
//! | [`intervals`] | how wide each parameter's interval is, against the limits of the verdicts |
//! | [`residuals`] | what the fitted motor leaves of the measured voltages |
//! | [`operating_points`] | where in the i_d–i_q plane the log held still |
//! | [`currents`] | measured and simulated currents over time, and what the simulation misses |
//! | [`prediction`] | the same of given parameters |
//! | [`convergence`] | Fig. 4 of the paper: cost above the minimum against iteration |
//! | [`parameter_courses`] | Fig. 5 of the paper: the parameters against iteration |

pub(crate) mod autocorrelation;
mod axis;
pub(crate) mod canvas;
pub(crate) mod convergence;
pub(crate) mod courses;
pub(crate) mod currents;
mod decimation;
pub(crate) mod ellipse;
pub(crate) mod intervals;
pub(crate) mod palette;
pub(crate) mod plane;
mod plot;
pub(crate) mod residuals;

use crate::measured::Measured;
use fluxfit::{
    evidence::Identification,
    evidence::OutputFit,
    evidence::SteadyFit,
    log::Log,
    motor::{Motor, Parameter},
    steady::OperatingPoint,
    study::{MethodStudy, fitness::Fitness},
    validation::prediction::PredictedStretch,
};

/// For which width a figure is drawn. Letters have the same size in both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// A page or a screen: 720 pixels.
    Wide,
    /// A telephone: 320 pixels.
    Narrow,
}

impl Size {
    /// Its width, pixels.
    fn width(self) -> u32 {
        match self {
            Self::Wide => 720,
            Self::Narrow => 320,
        }
    }

    /// One of two: for the wide drawing, for the narrow one.
    fn pick<T>(self, wide: T, narrow: T) -> T {
        match self {
            Self::Wide => wide,
            Self::Narrow => narrow,
        }
    }
}

/// Half-width of each parameter's 95 % interval as a fraction of its value.
pub fn intervals(found: &Identification, size: Size) -> String {
    intervals::draw(found, size).standalone()
}

/// Residuals of the two voltage equations at each operating point, with two standard uncertainties.
pub fn residuals(found: &SteadyFit, size: Size) -> String {
    residuals::draw(found, size).standalone()
}

/// Measured and simulated currents of the rows that were fitted, A, and their differences. Of a sensor's faults that were found, both
/// curves have the same.
pub fn currents(log: &Log, found: &OutputFit, size: Size) -> String {
    currents::draw(Measured::and_simulated(log, found), size).standalone()
}

/// The operating points in the plane of i_d and i_q, A.
pub fn operating_points(points: &[OperatingPoint], size: Size) -> String {
    plane::draw(points, size).standalone()
}

/// Cost above the minimum against iteration: the median of each method's runs, and the band from quartile to quartile.
pub fn convergence(fitness: &Fitness, methods: &[(MethodStudy, f64)], size: Size) -> String {
    convergence::draw(fitness, methods, size).standalone()
}

/// The median of each parameter over one method's runs against iteration, without those in `unexcited`; the truth, if known,
/// beside it.
pub fn parameter_courses(study: &MethodStudy, truth: Option<&Motor>, unexcited: &[Parameter], size: Size) -> String {
    courses::draw(study, truth, unexcited, size).standalone()
}

/// Measured and predicted currents over time, A, and the residuals below them.
pub fn prediction(log: &Log, courses: &[PredictedStretch], size: Size) -> String {
    currents::draw(Measured::and_predicted(log, courses), size).standalone()
}

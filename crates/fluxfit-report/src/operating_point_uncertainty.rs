//! Uncertainty of the voltage residuals of operating points, and the unit that both are shown in.

use fluxfit::evidence::SteadyFit;

/// Standard uncertainty, V, of both residuals of each operating point: noise of the means, and accuracy of the voltages.
pub(crate) fn residual_uncertainties(found: &SteadyFit) -> Vec<[f64; 2]> {
    let points = found.operating_points.iter().zip(&found.estimate.accuracy);
    let both = points.map(|(point, accuracy)| {
        let noise = point.residual_covariance(&found.estimate.motor);
        [0, 1].map(|axis| (noise[axis][axis].max(0.0) + accuracy.powi(2)).sqrt())
    });
    both.collect()
}

/// From here on, V, residuals and their uncertainties are in V.
const LARGE: f64 = 1.0;

/// The unit of all residuals of a fit, and how many of it a volt has: millivolt, or volt where one is as large.
pub(crate) fn residual_unit(found: &SteadyFit) -> (&'static str, f64) {
    let uncertainties = residual_uncertainties(found);
    let largest = found.estimate.residuals.iter().chain(&uncertainties).flatten().fold(0.0, |most: f64, volts| most.max(volts.abs()));
    if largest < LARGE { ("mV", 1e3) } else { ("V", 1.0) }
}

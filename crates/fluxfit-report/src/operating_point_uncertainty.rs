//! Uncertainty of the voltage residuals of operating points.

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

//! Misfit: operating points that contradict each other, and an estimate that admits it.
//!
//! Where the residuals are larger than noise and accuracy allow, one motor with constant parameters is not true: it saturates,
//! heats up, or these are not the voltages that acted. Then the voltages are trusted only as far as the points agree: to the
//! fraction at which chi squared equals its degrees of freedom, so that no point dominates for being quiet, and the interval is
//! widened to the scatter of the points instead of the error of their mean. A point may still lie outside it. R. C. Paule and J.
//! Mandel, "Consensus values and weighting factors", J. Res. Natl. Bur. Stand. 87 (1982) 377, doi:10.6028/jres.087.022.

use super::{
    super::request::{Known, Request},
    estimate::Estimate,
    excitation::Excitation,
    voltage_accuracy::VoltageAccuracy,
    voltage_loss::Loss,
};
use crate::steady::OperatingPoint;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Probability at which contradiction between points counts as proven.
pub(super) const SIGNIFICANCE: f64 = 1e-3;

/// Bisections of the logarithm of the fraction: 60 halve any range to rounding.
const BISECTIONS: usize = 60;

/// Contradiction between the points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Misfit {
    /// Root of chi squared per degree of freedom under the noise and the accuracy stated.
    pub ratio: f64,
    /// The fraction of the voltage to which the points agree.
    pub voltage_accuracy: f64,
}

/// Solves the points with voltages that may err by so many volts besides their accuracy, and looks for contradiction; if there is any,
/// again at the accuracy to which they agree. Priors have no part in it: one that the points contradict must not make the voltages look
/// worse.
pub(crate) fn admit(
    points: &[OperatingPoint],
    excitation: &Excitation,
    request: &Request,
    losses: &[Loss],
    volts: f64,
) -> (Estimate, Option<Misfit>) {
    let without = |known| if matches!(known, Known::Prior { .. }) { Known::Nothing } else { known };
    let alone = Request { known: request.known.map(without), ..request.clone() };
    let of_points = Excitation::of(points, &alone.known);
    let solve = |fraction: f64| Estimate::solve_with(points, &of_points, &alone, losses, VoltageAccuracy { fraction, volts, across: 0.0 });
    let with_priors =
        |fraction: f64| Estimate::solve_with(points, excitation, request, losses, VoltageAccuracy { fraction, volts, across: 0.0 });
    let Some(ratio) = significant_ratio(points, &solve(request.voltage_accuracy)) else {
        return (with_priors(request.voltage_accuracy), None);
    };
    // At an accuracy of the whole voltage nothing contradicts anything.
    let (mut low, mut high) = (request.voltage_accuracy.max(f64::EPSILON), 1.0_f64);
    for _ in 0..BISECTIONS {
        let middle = (low * high).sqrt();
        let tried = solve(middle);
        if tried.chi_squared > tried.degrees_of_freedom as f64 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (with_priors(high), Some(Misfit { ratio, voltage_accuracy: high }))
}

/// Root of chi squared per degree of freedom, if an F test finds it too large.
fn significant_ratio(points: &[OperatingPoint], estimate: &Estimate) -> Option<f64> {
    let degrees = Some(estimate.degrees_of_freedom).filter(|degrees| *degrees > 0)? as f64;
    let ratio = estimate.chi_squared / degrees;
    // The covariances behind chi squared are estimates themselves; their average degrees of freedom stand for all of them.
    let behind = points.iter().map(|point| point.degrees_of_freedom as f64).sum::<f64>() / points.len() as f64;
    let limit = FisherSnedecor::new(degrees, behind).ok()?.inverse_cdf(1.0 - SIGNIFICANCE);
    (ratio > limit).then(|| ratio.sqrt())
}

#[cfg(test)]
mod tests {
    use crate::{
        frames::Dq,
        identification::{
            prepare::model::Model,
            request::{Request, Swarm},
            solve::{Identification, solve},
        },
        log::{Columns, Log},
        motor::{Motor, Parameter},
        objective::acting_voltage::{VoltageFrame, VoltageTiming},
        optimizer::Draws,
    };

    const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
    const ROWS: usize = 200;

    /// Three loads, with the q inductance that the motor has at each, H; 0.2 % noise on the voltages.
    fn found(lq: [f64; 3]) -> Identification {
        let mut draws = Draws::seeded(4, 0);
        let mut columns = Columns::default();
        for (mode, (d, q)) in [(0.0, 9.0), (-2.0, 7.0), (-1.0, 5.0)].into_iter().enumerate() {
            let u = Motor { lq: lq[mode], ..MOTOR }.steady_voltage(Dq { d, q }, 400.0);
            for k in 0..ROWS {
                columns.t.push((2 * mode * ROWS + k) as f64 * 1e-3);
                columns.ud.push(u.d + 0.2 * draws.normal());
                columns.uq.push(u.q + 0.2 * draws.normal());
                columns.id.push(d);
                columns.iq.push(q);
                columns.omega_e.push(400.0);
            }
        }
        let request = Request {
            model: Some(Model::Steady),
            swarm: Swarm::Off,
            voltage_timing: Some(VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle }),
            ..Request::default()
        };
        solve(&Log::new(columns).unwrap(), &request, &crate::identification::progress::silent).unwrap()
    }

    #[test]
    fn a_saturating_motor_is_found_out_and_its_interval_holds_every_points_inductance() {
        let lq = [11e-3, 12e-3, 12.5e-3];
        let found = found(lq);
        let misfit = found.steady.as_ref().unwrap().misfit.expect("saturation of 14 % is far beyond 0.2 % noise");
        assert!(misfit.ratio > 3.0 && misfit.voltage_accuracy > 1e-3, "{misfit:?}");
        let (raw, half) = (found.parameter(Parameter::Lq).raw, found.parameter(Parameter::Lq).uncertainty.half_width);
        assert!(lq.iter().all(|lq| (lq - raw).abs() <= half), "{raw} ± {half}");
        assert!(found.warnings.iter().any(|warning| warning.code() == "misfit"));
    }

    #[test]
    fn points_of_one_motor_do_not_contradict_each_other() {
        assert_eq!(found([12e-3; 3]).steady.unwrap().misfit, None);
    }
}

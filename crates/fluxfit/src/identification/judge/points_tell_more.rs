//! Whether the operating points tell more than the simulated currents do.
//!
//! Rows that are every n-th of a drive's periods, filtered columns, or a fault that no term describes leave residuals of the simulated
//! currents that are no noise. Means over operating points suffer less: transients and harmonics are not in them. So where the residuals
//! are not explained, and operating points agree with each other although they could contradict, the model with the narrower intervals
//! answers. Where rows come slower than drives control currents, the points answer even if they cannot contradict each other: the voltage
//! between the rows is not in the log. If they leave out a parameter that the currents tell, they answer only where the currents were
//! misread and nearly all rows belong to points: the few rows after a step do not tell a parameter, a ramp of the speed does.
//!
//! Where the simulated currents leave a whole combination of parameters open, or all that they leave is rounding, their parameters were
//! fitted to what no parameter explains. Operating points leave such directions at zero, so they answer if they leave nothing else open.

use super::{
    super::{
        fit::{
            fault_search::LEAST_RESIDUAL, finding::Finding, output::OutputFit, output_errors::CORRELATED, output_start::part_of_rows,
            steady::SteadyFit,
        },
        request::{Known, Request},
    },
    verdict::{Verdict, judge},
};
use crate::{faults::Fault, motor::PARAMETERS, objective::acting_voltage::VoltageTiming};

/// What operating points have over the simulated currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Points {
    /// Nothing.
    TellLess,
    /// They leave open what they do not excite, or rows come so slowly that the currents between them are unknown.
    TellMore,
    /// Narrower intervals, where the currents' residuals have a cause that nothing describes.
    AreNarrower,
}

/// What they have; `open`: what the simulated currents leave open; `may_be_decimated`: whether rows come slower than drives control
/// currents.
pub(crate) fn points_tell_more(
    points: &SteadyFit,
    currents: &OutputFit,
    open: &[bool; PARAMETERS],
    may_be_decimated: bool,
    request: &Request,
) -> Points {
    let if_so = |tells_more| if tells_more { Points::TellMore } else { Points::TellLess };
    if points.misfit.is_some() {
        return Points::TellLess;
    }
    if currents.finding.trust.is_none() {
        return Points::AreNarrower;
    }
    let judged = judge(&currents.finding, None, request, false);
    let told: [bool; PARAMETERS] = std::array::from_fn(|p| !open[p] && judged[p].verdict != Verdict::NotIdentifiable);
    let combined = open.iter().filter(|open| **open).count() > 1;
    let is_rounding = currents.finding.trust.misses <= LEAST_RESIDUAL;
    if (combined || is_rounding) && told.contains(&false) {
        return if_so(points.finding.open.iter().zip(told).all(|(of_points, told)| !(*of_points && told)));
    }
    let is_white = currents.finding.trust.correlation_of_neighbours <= CORRELATED;
    let is_explained = is_white && !currents.has(Fault::Disturbance);
    if may_be_decimated {
        // What passes for a filter there is the voltage between the rows; of means it is only known to go about straight.
        let is_filtered = currents.is_filtered() || matches!(currents.voltage_timing.value, VoltageTiming::Averaged { .. });
        let of_points = judge(&points.finding, None, request, false).map(|one| one.verdict != Verdict::NotIdentifiable);
        let tell_all = of_points.iter().zip(told).all(|(of_points, told)| *of_points || !told);
        let is_misread = currents.is_filtered() || !is_white;
        return if_so((!is_explained || is_filtered) && (tell_all || is_misread && part_of_rows(points, &currents.stretches) > NEARLY_ALL));
    }
    let can_contradict = points.estimate.redundancy > 0;
    if !is_explained && can_contradict && is_narrower(points, currents, request) { Points::AreNarrower } else { Points::TellLess }
}

/// Part of the rows that is nearly all: transients of the windings, a few milliseconds of each mode that is held for a second, are less
/// than the rest; ramps are more.
const NEARLY_ALL: f64 = 0.9;

/// Whether the points' intervals are narrower than the currents'.
pub(crate) fn is_narrower(points: &SteadyFit, currents: &OutputFit, request: &Request) -> bool {
    width(&points.finding, request) < width(&currents.finding, request)
}

/// Sum of the logarithms of the intervals' half-widths as parts of the values, faults in doubt not counted: the points know of none.
/// What is wider than its value, or not positive, is not told: one; nor is anything of a fit that is not to be trusted.
fn width(finding: &Finding, request: &Request) -> f64 {
    if finding.trust.is_none() {
        return 0.0;
    }
    let judged = judge(finding, None, request, false);
    let told = judged.iter().filter(|one| !matches!(request.known[one.parameter as usize], Known::Fixed(_)));
    let widths = told.map(|one| if one.raw > 0.0 { (one.uncertainty.half_width_without_doubt() / one.raw).min(1.0) } else { 1.0 });
    // A width of zero would outweigh all others.
    widths.map(|width| width.max(f64::EPSILON).ln()).sum()
}

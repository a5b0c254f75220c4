//! Whether both halves of a log say the same of its motor.
//!
//! A motor does not change within a log, but for what the model has. A fit whose unknowns bend to what the model does not describe comes
//! out elsewhere in each half, by far more than its standard errors, however white its residuals are. What each half says comes from the
//! same fit over its rows. The standard errors must be larger than they are by as many of them as the halves are apart, in the root mean
//! square over the parameters: R. T. Birge, Physical Review 40, 1932, p. 207, doi:10.1103/PhysRev.40.207.

use super::output_errors::from_noise;
use crate::{
    error::Error,
    levenberg_marquardt::{MOTOR, PriorResidual, polish_to_choose},
    log::Log,
    motor::PARAMETERS,
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::ops::Range;

/// Halves of white noise are as many standard errors apart once in a million logs.
const APART: f64 = 3.0;

/// How far the halves of these stretches put each parameter in doubt, SI, as a standard deviation; zero where they agree, or where one of
/// them cannot be fitted. What is in `doubt` of each parameter anyway may part them.
pub(super) fn doubt(
    (log, stretches): (&Log, &[Range<usize>]),
    reading: VoltageTiming,
    drive: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
    doubt: &[f64; PARAMETERS],
) -> [f64; PARAMETERS] {
    let half = |stretches: &[Range<usize>]| Half::of(log, stretches, reading, drive, unknowns, priors);
    let [first, second] = halves(stretches);
    let (Ok(first), Ok(second)) = (half(&first), half(&second)) else { return [0.0; PARAMETERS] };
    let distance: [f64; PARAMETERS] = std::array::from_fn(|p| (first.motor[p] - second.motor[p]).abs());
    let error: [f64; PARAMETERS] =
        std::array::from_fn(|p| first.standard_errors[p].hypot(doubt[p]).hypot(second.standard_errors[p].hypot(doubt[p])));
    let ratios = (0..PARAMETERS).filter(|p| error[*p] > 0.0).map(|p| (distance[p] / error[p]).powi(2));
    let (count, squares) = ratios.fold((0.0, 0.0), |(count, sum), square| (count + 1.0, sum + square));
    let apart = (squares / f64::max(count, 1.0)).sqrt();
    if !apart.is_finite() || apart < APART {
        return [0.0; PARAMETERS];
    }
    // Both halves together are known half as well again as the difference between them.
    std::array::from_fn(|p| 0.5 * distance[p].max(apart * error[p]))
}

/// What one half says.
struct Half {
    motor: [f64; PARAMETERS],
    standard_errors: [f64; PARAMETERS],
}

impl Half {
    fn of(
        log: &Log,
        stretches: &[Range<usize>],
        reading: VoltageTiming,
        drive: &Adjustable,
        unknowns: &[Unknown],
        priors: &[PriorResidual],
    ) -> Result<Self, Error> {
        let objective = OutputError::of_rows(log, stretches, reading)?;
        let drive = polish_to_choose(&objective, drive, unknowns, priors).drive;
        let residuals = objective.residuals(&drive);
        let standard_errors = from_noise(&objective, &drive, unknowns, priors, &residuals);
        let of = |parameter: &Unknown| unknowns.iter().position(|unknown| unknown == parameter).map_or(0.0, |k| standard_errors[k]);
        Ok(Self { motor: drive.motor.to_array(), standard_errors: MOTOR.each_ref().map(of) })
    }
}

/// The stretches, cut where half of their rows are over.
fn halves(stretches: &[Range<usize>]) -> [Vec<Range<usize>>; 2] {
    let mut left = stretches.iter().map(ExactSizeIterator::len).sum::<usize>() / 2;
    let mut halves = [Vec::new(), Vec::new()];
    for rows in stretches {
        let middle = rows.start + left.min(rows.len());
        left -= middle - rows.start;
        for (half, part) in halves.iter_mut().zip([rows.start..middle, middle..rows.end]) {
            if !part.is_empty() {
                half.push(part);
            }
        }
    }
    halves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_cut_where_half_of_their_rows_are_over() {
        assert_eq!(halves(&[0..10, 20..30, 40..50]), [vec![0..10, 20..25], vec![25..30, 40..50]]);
        assert_eq!(halves(&[0..5, 5..10, 20..25, 25..30]), [vec![0..5, 5..10], vec![20..25, 25..30]]);
    }
}

//! What dead time and devices take: each phase loses a voltage against its current.
//!
//! Beyond some phase current the whole voltage is lost; near zero, where the current's ripple changes its sign between the
//! switching instants of a period, a part of it. A ramp of the width of that ripple describes the mean over a period:
//!
//! ```text
//! u_phase = commanded - V f(i_phase - shift),    f(i) = i / width, but at most 1 and at least -1
//! ```
//!
//! Where a row is half a carrier period, each phase switches once in it, up in one row and down in the next. A late edge up takes
//! voltage while current flows out, a late edge down gives some while it flows in: per row that is `V (f + 1)` and `V (f - 1)`, and what
//! is common to all phases does nothing. But the current at an edge up is the lowest of its ripple, at an edge down the highest: near its
//! zero the deciding sign alternates, which is the shift.
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903.

use crate::frames::{Abc, AlphaBeta};

/// Mean loss over a period, per volt, in the stator, of a current that goes straight from `start` to `end`, A.
pub(super) fn mean_loss(start: AlphaBeta, end: AlphaBeta, shift: f64, width: f64) -> AlphaBeta {
    let (start, end) = (start.to_abc(), end.to_abc());
    let phase = |from: f64, to: f64| mean_of_ramp(from - shift, to - shift, width);
    Abc { a: phase(start.a, end.a), b: phase(start.b, end.b), c: phase(start.c, end.c) }.to_alpha_beta()
}

/// Mean of the ramp while its argument goes from one value to another.
fn mean_of_ramp(from: f64, to: f64, width: f64) -> f64 {
    let ramp =
        |i: f64| if width > 0.0 { (i / width).clamp(-1.0, 1.0) } else { f64::from(u8::from(i > 0.0)) - f64::from(u8::from(i < 0.0)) };
    // Its integral: a parabola up to the width, straight from there on.
    let integral = |i: f64| if i.abs() < width { 0.5 * i * i / width } else { i.abs() - 0.5 * width.max(0.0) };
    // A difference of integrals over a short way loses its digits to rounding; there the ramp is straight or about to be.
    if (to - from).abs() > 1e-6 * (from.abs() + to.abs()) { (integral(to) - integral(from)) / (to - from) } else { ramp(0.5 * (from + to)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(from in -3.0..3.0f64, to in -3.0..3.0f64, width in 0.01..2.0f64) {
            const POINTS: u32 = 20_000;
            let point = |k: u32| ((from + (to - from) * (f64::from(k) + 0.5) / f64::from(POINTS)) / width).clamp(-1.0, 1.0);
            let expected = (0..POINTS).map(point).sum::<f64>() / f64::from(POINTS);
            prop_assert!((mean_of_ramp(from, to, width) - expected).abs() < 1e-4);
        }
    }

    /// A square wave's fundamental is 4/pi; along the current.
    #[test]
    fn the_fundamental_is_four_over_pi() {
        const STEPS: u32 = 6000;
        let vector = |k: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(STEPS)).sin_cos();
            AlphaBeta { alpha: 5.0 * cos, beta: 5.0 * sin }
        };
        let along = |k: u32| {
            let (start, end) = (vector(k), vector(k + 1));
            let loss = mean_loss(start, end, 0.0, 0.0);
            (loss.alpha * (start.alpha + end.alpha) + loss.beta * (start.beta + end.beta)) / 10.0
        };
        let mean = (0..STEPS).map(along).sum::<f64>() / f64::from(STEPS);
        assert!((mean - 4.0 / std::f64::consts::PI).abs() < 1e-5, "{mean}");
    }
}

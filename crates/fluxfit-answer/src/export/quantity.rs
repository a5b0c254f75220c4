//! Numbers with their 95 % intervals.

use fluxfit::current_loop::Gain;
use fluxfit_units::significant;

/// A number and its 95 % interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quantity {
    pub(super) value: f64,
    pub(super) interval: [f64; 2],
}

impl Quantity {
    /// A monotonic function of the quantity.
    pub(super) fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let [a, b] = self.interval.map(&of);
        Self { value: of(self.value), interval: [a.min(b), a.max(b)] }
    }

    /// `a x + b y`, where the errors of `x` and `y` are correlated.
    fn combined([a, x]: [f64; 2], half_x: f64, [b, y]: [f64; 2], half_y: f64, correlation: f64) -> Self {
        let (of_x, of_y) = (a * half_x, b * half_y);
        // Where the errors cancel, rounding may give a small negative number.
        let half = (of_x * of_x + of_y * of_y + 2.0 * correlation * of_x * of_y).max(0.0).sqrt();
        let value = a * x + b * y;
        Self { value, interval: [value - half, value + half] }
    }

    /// Half the width of the interval.
    pub(super) fn half_width(self) -> f64 {
        (self.interval[1] - self.interval[0]) / 2.0
    }

    /// `a self + b other`.
    pub(super) fn plus(self, a: f64, b: f64, other: Self, correlation: f64) -> Self {
        Self::combined([a, self.value], self.half_width(), [b, other.value], other.half_width(), correlation)
    }
}

impl From<Gain> for Quantity {
    fn from(gain: Gain) -> Self {
        Self { value: gain.value, interval: gain.interval }
    }
}

/// The interval in words, `95 % within 0.9546 .. 0.9599 ohm`, with three digits of the half-width.
pub(super) fn interval(quantity: &Quantity, unit: &str) -> String {
    let half = quantity.half_width();
    if half == 0.0 {
        return "given, not identified".to_owned();
    }
    let digits = 3 + (quantity.value.abs() / half).log10().floor().max(0.0) as i32;
    let [low, high] = quantity.interval.map(|end| short(end, digits));
    format!("95 % within {low} .. {high} {unit}").trim_end().to_owned()
}

/// A number with this many significant digits; with an exponent if it is small.
fn short(value: f64, digits: i32) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:.*e}", (digits - 1).max(0) as usize) } else { significant(value, digits) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_have_three_digits_of_their_half_width() {
        let shown = |value: f64, half: f64| interval(&Quantity { value, interval: [value - half, value + half] }, "ohm");
        assert_eq!(shown(0.957_31, 0.0026), "95 % within 0.95471 .. 0.95991 ohm");
        assert_eq!(shown(1.2e-5, 1e-7), "95 % within 1.1900e-5 .. 1.2100e-5 ohm");
        assert_eq!(shown(0.96, 0.0), "given, not identified");
    }

    #[test]
    fn fully_correlated_errors_cancel_in_a_difference_and_add_in_a_mean() {
        let at = |value: f64, half: f64| Quantity { value, interval: [value - half, value + half] };
        let (ld, lq) = (at(5.0, 0.3), at(12.0, 0.3));
        let difference = lq.plus(1.0, -1.0, ld, 1.0);
        assert!((difference.value - 7.0).abs() < 1e-12 && difference.half_width() < 1e-7, "{difference:?}");
        assert!((ld.plus(0.5, 0.5, lq, 1.0).half_width() - 0.3).abs() < 1e-12);
        // Independent: 0.5 hypot(0.3, 0.3).
        assert!((ld.plus(0.5, 0.5, lq, 0.0).half_width() - 0.212_132_034_355_964).abs() < 1e-12);
    }
}

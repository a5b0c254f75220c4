//! Axes: a range with round numbers.

/// A range with its ticks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    /// Lower end.
    pub(crate) low: f64,
    /// Upper end.
    pub(crate) high: f64,
    /// Values of the ticks.
    pub(crate) ticks: Vec<f64>,
    /// Distance between ticks.
    pub(crate) step: f64,
}

/// Margin at either end as a fraction of the range.
const MARGIN: f64 = 0.06;

/// Fraction of the values at either end that do not stretch a robust axis, and how far it reaches beyond the others, as a part of their
/// range.
const FEW: f64 = 0.01;
const STRETCH: f64 = 0.5;

/// Ticks that tell a scale.
const LEAST_TICKS: i64 = 3;

impl Axis {
    /// From the smallest to the largest value, with about `count` ticks. Values that are not finite are ignored; equal values get a
    /// margin on both sides.
    pub(crate) fn around(values: impl IntoIterator<Item = f64>, count: usize) -> Self {
        let (low, high) = extent(values).unwrap_or((0.0, 1.0));
        let span = high - low;
        let margin = if span > 0.0 { MARGIN * span } else { 0.5 * high.abs().max(1e-3) };
        Self::between(low - margin, high + margin, count)
    }

    /// As [`around`](Self::around), but a few values far from all others do not stretch it.
    pub(crate) fn robust(values: impl IntoIterator<Item = f64>, count: usize) -> Self {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let few = (FEW * values.len() as f64) as usize;
        let (low, high) = match (values.get(few), values.get(values.len().saturating_sub(few + 1))) {
            (Some(low), Some(high)) if high > low => (*low, *high),
            _ => return Self::around(values, count),
        };
        let (least, most) = (low - STRETCH * (high - low), high + STRETCH * (high - low));
        Self::around(values.into_iter().map(|value| value.clamp(least, most)), count)
    }

    /// From `low` to `high`, which is larger.
    pub(crate) fn between(low: f64, high: f64, count: usize) -> Self {
        let rough = (high - low) / count.max(1) as f64;
        let power = 10.0_f64.powf(rough.log10().floor());
        let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
        let ends = |step: f64| ((low / step).ceil() as i64, (high / step).floor() as i64);
        let is_told = |step: f64| ends(step).1 - ends(step).0 + 1 >= LEAST_TICKS.min(count as i64);
        let place = steps.iter().skip(1).position(|step| *step >= 0.999 * rough).map_or(0, |place| place + 1);
        // A finer step where the round numbers of this one leave too few ticks, such as zero alone.
        let step = steps[..=place].iter().rev().copied().find(|step| is_told(*step)).unwrap_or(rough);
        let (first, last) = ends(step);
        Self { low, high, ticks: (first..=last).map(|k| k as f64 * step).collect(), step }
    }

    /// A logarithmic axis from decadic logarithms, whose ends are powers of ten, with at most `count` ticks.
    pub(crate) fn decades(logarithms: impl IntoIterator<Item = f64>, count: usize) -> Self {
        let (low, high) = extent(logarithms).unwrap_or((0.0, 1.0));
        let (low, high) = (low.floor() as i32, (high.ceil() as i32).max(low.floor() as i32 + 1));
        let step = [1, 2, 3, 5, 10, 20, 50].into_iter().find(|step| (high - low) / step < count as i32).unwrap_or(100);
        let ticks = (low..=high).filter(|power| power.rem_euclid(step) == 0).map(f64::from).collect();
        Self { low: f64::from(low), high: f64::from(high), ticks, step: f64::from(step) }
    }

    /// The number at a tick, with the digits that the step needs.
    pub(crate) fn label(&self, tick: f64) -> String {
        let decimals = (-self.step.log10().floor()).clamp(0.0, 12.0) as usize;
        crate::typography::minus(format!("{tick:.decimals$}"))
    }
}

fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite
        .fold(None, |extent, value| extent.map_or(Some((value, value)), |(low, high): (f64, f64)| Some((low.min(value), high.max(value)))))
}

/// A power of ten with superscript digits.
pub(crate) fn power_of_ten(exponent: f64) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent = exponent.round() as i32;
    let digits = exponent.abs().to_string();
    let raised = digits.chars().filter_map(|digit| digit.to_digit(10)).filter_map(|digit| RAISED.get(digit as usize));
    let sign = if exponent < 0 { "⁻" } else { "" };
    format!("10{sign}{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::between(0.0, 300.0, 6);
        assert_eq!(axis.ticks, [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0]);
        assert_eq!(axis.label(50.0), "50");
        let axis = Axis::around([-0.13, 0.07], 5);
        assert_eq!(axis.label(axis.ticks[0]), "−0.10");
        assert!(axis.ticks.iter().all(|tick| (axis.low..=axis.high).contains(tick)));
    }

    #[test]
    fn zero_is_never_the_only_tick() {
        assert_eq!(Axis::between(-4.9, 4.9, 4).ticks, [-4.0, -2.0, 0.0, 2.0, 4.0]);
        for tenths in 1..1000 {
            let high = 0.1 * f64::from(tenths);
            assert!(Axis::between(-high, 0.7 * high, 4).ticks.len() >= 3, "{high}");
        }
    }

    #[test]
    fn one_value_far_away_does_not_stretch_a_robust_axis() {
        let noise = || (0..1000).map(|k| f64::from(k % 11) - 5.0);
        let axis = Axis::robust(noise().chain([4000.0]), 4);
        assert!(axis.low >= -11.0 && axis.high <= 11.0, "{axis:?}");
        assert_eq!(Axis::robust(noise(), 4), Axis::around(noise(), 4));
        assert_eq!(Axis::robust([0.0, 3.0], 4), Axis::around([0.0, 3.0], 4));
    }

    #[test]
    fn empty_equal_and_infinite_values_still_give_an_axis() {
        for values in [vec![], vec![5.0], vec![0.0, 0.0], vec![f64::NAN, f64::INFINITY], vec![1e-300], vec![-7.0, -7.0]] {
            let axis = Axis::around(values.iter().copied(), 5);
            assert!(axis.low < axis.high && axis.step > 0.0 && !axis.ticks.is_empty(), "{values:?}: {axis:?}");
            let axis = Axis::decades(values.iter().copied(), 5);
            assert!(axis.low < axis.high && !axis.ticks.is_empty(), "{values:?}: {axis:?}");
        }
    }

    #[test]
    fn decades_contain_all_values_and_powers_are_superscripts() {
        let axis = Axis::decades([-8.3, 4.2], 8);
        assert_eq!((axis.low, axis.high), (-9.0, 5.0));
        assert_eq!(axis.ticks, [-8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0]);
        assert_eq!(power_of_ten(-12.0), "10⁻¹²");
        assert_eq!(power_of_ten(3.0), "10³");
    }
}

//! Numbers in sentences.

/// A positive number with so many significant digits, and no exponent down to a thousandth.
pub(super) fn digits(value: f64, digits: i32) -> String {
    if value < 1e-3 {
        return if value > 0.0 { format!("{value:.0e}") } else { "0".to_owned() };
    }
    let decimals = (digits - 1 - value.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// A number with one significant digit, and no exponent.
pub(super) fn one_digit(x: f64) -> String {
    let exponent = if x == 0.0 || !x.is_finite() { 0 } else { x.abs().log10().floor() as i32 };
    let unit = 10.0_f64.powi(exponent);
    format!("{:.*}", exponent.saturating_neg().clamp(0, 12) as usize, (x / unit).round() * unit)
}

/// A number with three significant digits, and no exponent.
pub(super) fn three_digits(value: f64) -> String {
    // What rounds up to the next power of ten has its digits.
    let value = format!("{value:.2e}").parse().unwrap_or(value);
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

/// The prefix with which a value is easily read, and how many of it one has.
pub(super) fn prefix(value: f64) -> (f64, &'static str) {
    match value.abs() {
        large if large >= 1.0 => (1.0, ""),
        small if small >= 1e-3 => (1e3, "m"),
        _ => (1e6, "u"),
    }
}

/// Two inductances, H, in one unit: `from 119 to 104 uH`.
pub(super) fn from_to([one, other]: [f64; 2]) -> String {
    let (scale, prefix) = prefix(other);
    format!("from {} to {} {prefix}H", three_digits(scale * one), three_digits(scale * other))
}

/// A fraction in percent, with two digits.
pub(super) fn percent(fraction: f64) -> String {
    let value = 100.0 * fraction;
    // From 0.1 to 50 in practice; a number beyond that has no digits worth showing.
    let decimals = if value > 0.0 { (1.0 - value.log10().floor()).clamp(0.0, 4.0) as usize } else { 0 };
    format!("{value:.decimals$} %")
}

/// `a, b and c`.
pub(super) fn list<S: AsRef<str>>(items: &[S]) -> String {
    let items: Vec<&str> = items.iter().map(AsRef::as_ref).collect();
    match items.as_slice() {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_digit_has_no_exponent() {
        assert_eq!([-1.9774, -29.9, 0.000_87, 0.0].map(one_digit), ["-2", "-30", "0.0009", "0"]);
    }

    #[test]
    fn three_digits_round_up_to_the_next_power_of_ten() {
        let shown = [1.7634, 0.99996, 0.000_999_9, 1732.4, 54.96].map(three_digits);
        assert_eq!(shown, ["1.76", "1.00", "0.00100", "1730", "55.0"]);
    }
}

//! Nanoseconds a sample of each estimator, and long runs: `speed [PERIODS [f32|f64]]`. One period in ten thousand is garbage.
// Numbers on standard output are what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, Period, Real, bank::Together, period::current_after};
use std::time::Instant;

const TRUTH: [f64; 4] = [0.958, 5.25e-3, 12e-3, 0.1827];

/// Periods that are simulated once and then repeated: two changes of i_d, one of the speed.
const RECORDED: usize = 20_000;

fn recorded<T: Real>() -> Vec<(Period<T>, [T; 2])> {
    let mut i = [0.0, 9.0];
    // Twice around, so that the end leads to the beginning.
    let mut periods = Vec::new();
    let mut state = 1_u32;
    let mut noise = || {
        let uniform = |state: &mut u32| {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(*state) / f64::from(u32::MAX) - 0.5
        };
        0.04 * (0..12).map(|_| uniform(&mut state)).sum::<f64>()
    };
    for k in 0..2 * RECORDED {
        let id = if k / 2500 % 2 == 1 { -2.0 } else { 0.0 };
        let omega_e = 419.0 + 40.0 * (k as f64 * std::f64::consts::TAU / RECORDED as f64).sin();
        let u = [
            600.0 * TRUTH[1] * (id - i[0]) - omega_e * TRUTH[2] * 9.0 + TRUTH[0] * id,
            600.0 * TRUTH[2] * (9.0 - i[1]) + omega_e * (TRUTH[1] * id + TRUTH[3]) + TRUTH[0] * 9.0,
        ];
        i = current_after(&TRUTH, i, &Period { u, omega_e, length: 1e-4 });
        let period = Period { u: u.map(T::of), omega_e: T::of(omega_e), length: T::of(1e-4) };
        periods.push((period, i.map(|i| T::of(i + noise()))));
    }
    periods.split_off(RECORDED)
}

/// Periods between two that are garbage; a prime number, so that they fall everywhere.
const GARBAGE: usize = 10_007;

/// The `k`-th period: in turn a current that is no number, one that is infinite, and a spike of 10 kA are put in its place.
fn period<T: Real>(periods: &[(Period<T>, [T; 2])], k: usize) -> (Period<T>, [T; 2]) {
    let (period, i) = periods[k % RECORDED];
    if !k.is_multiple_of(GARBAGE) {
        return (period, i);
    }
    let garbage = [f64::NAN, f64::NEG_INFINITY, 1e4][k / GARBAGE % 3];
    (period, [T::of(garbage), i[1]])
}

fn measured<T: Real>(name: &str, count: usize) {
    let (periods, nominal) = (recorded::<T>(), [1.0, 5e-3, 1e-2, 0.2].map(T::of));
    let mut rls = BlockRls::new(BlockRlsSettings { rating: Some([10.0, 419.0].map(T::of)), ..BlockRlsSettings::new(nominal) });
    let mut ekf = Ekf::new(EkfSettings::tracking(nominal, T::of(10.0)), [T::ONE; 4]);
    let worst = |values: [T; 4]| values.iter().zip(TRUTH).map(|(value, truth)| (value.to_f64() / truth - 1.0).abs()).fold(0.0, f64::max);
    let begun = Instant::now();
    for k in 0..count {
        let (period, i) = period(&periods, k);
        rls.advance(&period, i);
    }
    let of_rls = begun.elapsed().as_secs_f64() / count as f64;
    let begun = Instant::now();
    let mut least = f64::INFINITY;
    for k in 0..count {
        let (period, i) = period(&periods, k);
        ekf.advance(&period, i);
        if k % 1_000_000 == 999_999 {
            least = ekf.standard_errors().iter().map(|error| error.to_f64()).fold(least, f64::min);
        }
    }
    let of_ekf = begun.elapsed().as_secs_f64() / count as f64;
    println!(
        "{name}: block least squares {:.1} ns, worst error {:.3} %, {} left out; Kalman filter {:.0} ns, worst error {:.3} %, least standard error {least:.3e}, {} left out, {} beyond three standard deviations",
        1e9 * of_rls,
        100.0 * worst(rls.estimate().value),
        rls.left_out(),
        1e9 * of_ekf,
        100.0 * worst(ekf.values()),
        ekf.left_out(),
        ekf.outliers()
    );
}

/// Nanoseconds a sample of six filters with different unknown voltages, each alone and all together.
fn bank(count: usize) {
    let periods = recorded::<f64>();
    let filter = |level| Ekf::new(EkfSettings { unknown_voltage: level, ..EkfSettings::tracking(TRUTH, 10.0) }, [1.0; 4]);
    let mut alone = [0.0, 0.03, 0.1, 0.3, 1.0, 3.0].map(filter);
    let mut bank = alone;
    let begun = Instant::now();
    for k in 0..count {
        let (period, i) = period(&periods, k);
        alone.iter_mut().for_each(|filter| filter.advance(&period, i));
    }
    let of_alone = begun.elapsed().as_secs_f64() / count as f64;
    let (mut together, begun) = (Together::new(), Instant::now());
    for k in 0..count {
        let (period, i) = period(&periods, k);
        together.advance(&mut bank, &[true; 6], &period, i);
    }
    let of_bank = begun.elapsed().as_secs_f64() / count as f64;
    println!("six filters: each alone {:.0} ns, together {:.0} ns, same bits: {}", 1e9 * of_alone, 1e9 * of_bank, alone == bank);
}

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(100_000);
    let only = std::env::args().nth(2);
    if only.as_deref() != Some("f32") {
        measured::<f64>("f64", count);
        bank(count);
    }
    if only.as_deref() != Some("f64") {
        measured::<f32>("f32", count);
    }
}

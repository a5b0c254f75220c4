//! Long runs in single precision, and the memory of an estimator.

mod rig;

use fluxfit_core::{BlockRls, BlockRlsSettings, Ekf, EkfSettings, Period, period::current_after};
use rig::{Noise, TRUTH};

/// A motor under a controller whose references step; `steps` periods go to the estimators.
fn run(steps: u32, mut estimators: impl FnMut(u32, &Period<f32>, [f32; 2])) {
    let (mut i, mut noise) = ([0.0_f64, 5.0], Noise(1));
    for k in 0..steps {
        let (id, iq) = (if k / 2500 % 2 == 1 { -2.0 } else { 0.0 }, 9.0);
        let omega = 419.0 + 40.0 * f64::from(k % 20_000) / 20_000.0;
        let measured = [0, 1].map(|c| i[c] + noise.next());
        let u = [
            600.0 * TRUTH[1] * (id - measured[0]) - omega * TRUTH[2] * iq + TRUTH[0] * id,
            600.0 * TRUTH[2] * (iq - measured[1]) + omega * (TRUTH[1] * id + TRUTH[3]) + TRUTH[0] * iq,
        ];
        let period = Period { u: u.map(|u| u as f32), omega_e: omega as f32, length: 1e-4 };
        i = current_after(&TRUTH, i, &Period { u: period.u.map(f64::from), omega_e: f64::from(period.omega_e), length: 1e-4 });
        estimators(k, &period, [0, 1].map(|c| (i[c] + noise.next()) as f32));
    }
}

fn worst(values: [f32; 4]) -> f32 {
    values.iter().zip(TRUTH).map(|(value, truth)| (value / truth as f32 - 1.0).abs()).fold(0.0, f32::max)
}

/// Three million periods, five minutes at 10 kHz.
#[test]
fn single_precision_neither_drifts_nor_loses_its_covariance() {
    let mut rls = BlockRls::<f32>::new(BlockRlsSettings::new([1.0, 5e-3, 1e-2, 0.2]));
    let mut constant = Ekf::<f32>::new(EkfSettings::constant([1.0, 5e-3, 1e-2, 0.2], 10.0), [1.0; 4]);
    let mut tracking = Ekf::<f32>::new(EkfSettings::tracking([1.0, 5e-3, 1e-2, 0.2], 10.0), [1.0; 4]);
    run(3_000_000, |k, period, i| {
        rls.advance(period, i);
        constant.advance(period, i);
        tracking.advance(period, i);
        if k % 100_000 == 99_999 {
            let errors = [constant.standard_errors(), tracking.standard_errors(), rls.estimate().standard_error];
            assert!(errors.iter().flatten().all(|error| *error > 0.0 && error.is_finite()), "{k}: {errors:?}");
            assert!(worst(rls.estimate().value) < 0.01 && worst(constant.values()) < 0.005 && worst(tracking.values()) < 0.02, "{k}");
        }
    });
}

/// Garbage is left out and counted: the next samples begin anew.
#[test]
fn what_is_no_number_is_left_out() {
    let nominal = TRUTH.map(|value| value as f32);
    let mut rls = BlockRls::<f32>::new(BlockRlsSettings { rating: Some([10.0, 419.0]), ..BlockRlsSettings::new(nominal) });
    let mut ekf = Ekf::<f32>::new(EkfSettings::constant(nominal, 10.0), [1.0; 4]);
    run(200_000, |k, period, i| {
        let garbage = match k % 1000 {
            500 => (Period { u: [f32::NAN, 0.0], ..*period }, i),
            600 => (*period, [f32::INFINITY, 0.0]),
            700 => (Period { length: 0.0, ..*period }, i),
            800 => (Period { omega_e: f32::NEG_INFINITY, ..*period }, i),
            // A spike: least squares leaves it out, and the filter limits what it does.
            900 => (*period, [1e4, 0.0]),
            _ => (*period, i),
        };
        rls.advance(&garbage.0, garbage.1);
        ekf.advance(&garbage.0, garbage.1);
    });
    assert_eq!((rls.left_out(), ekf.left_out()), (1000, 800));
    assert!(worst(rls.estimate().value) < 0.01 && worst(ekf.values()) < 0.005, "{:?} {:?}", rls.estimate(), ekf.values());
}

/// The numbers of the README.
#[test]
fn the_memory_is_what_the_readme_says() {
    let readme = include_str!("../README.md");
    for (name, bytes) in [("`BlockRls<f32>`", size_of::<BlockRls<f32>>()), ("`Ekf<f32>`", size_of::<Ekf<f32>>())] {
        assert!(readme.contains(&format!("| {name} | {bytes} |")), "{name}: {bytes}");
    }
}

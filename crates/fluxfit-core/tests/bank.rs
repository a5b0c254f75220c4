//! A bank whose filters go together has the bits of filters that go alone: through noise, garbage, spikes, a step of a parameter, a spell
//! without excitation, and with filters that are left out.

mod rig;

use fluxfit_core::{Ekf, EkfSettings, Period, bank::Together, period::current_after};
use rig::{NOISE, Noise, TRUTH};

/// More than a vector has lanes, so that they go in groups.
const LEVELS: [f64; 12] = [0.0, 0.01, 0.02, 0.03, 0.06, 0.1, 0.2, 0.3, 0.6, 1.0, 2.0, 3.0];

fn filter(level: f64, steps: bool) -> Ekf<f64> {
    let start = TRUTH.map(|value| 1.1 * value);
    let mut settings = if steps { EkfSettings::tracking(start, 10.0) } else { EkfSettings::constant(start, 10.0) };
    settings.unknown_voltage = level;
    settings.noise = NOISE * NOISE;
    Ekf::new(settings, [1.0; 4])
}

#[test]
fn filters_have_the_same_bits_together_and_alone() {
    for steps in [true, false] {
        let mut alone = LEVELS.map(|level| filter(level, steps)).to_vec();
        let mut bank = alone.clone();
        let mut together = Together::new();
        let (mut i, mut theta, mut noise) = ([0.0, 9.0], TRUTH, Noise(11));
        for k in 0..30_000_u32 {
            let omega_e = 419.0;
            let id = if k / 2500 % 2 == 1 && k < 20_000 { -2.0 } else { 0.0 };
            let [rs, ld, lq, psi_f] = TRUTH;
            let u = [
                rs * id - omega_e * lq * 9.0 + 628.0 * ld * (id - i[0]),
                rs * 9.0 + omega_e * (ld * id + psi_f) + 628.0 * lq * (9.0 - i[1]),
            ];
            if k == 17_040 {
                theta[2] *= 0.83;
            }
            let period = Period { u, omega_e, length: 1e-4 };
            i = current_after(&theta, i, &period);
            let mut measured = i.map(|i| i + noise.next());
            match k % 5003 {
                1000 => measured[0] = f64::NAN,
                2000 => measured[1] = 1e3,
                _ => {}
            }
            // Later the outermost levels stand still, then all but two.
            let active = LEVELS.map(|level| k < 24_000 || level > 0.0 && (k < 28_000 || level < 0.025));
            for (filter, is_active) in alone.iter_mut().zip(active) {
                filter.note_excitation(!(21_000..=26_000).contains(&k));
                if is_active {
                    filter.advance(&period, measured);
                }
            }
            bank.iter_mut().for_each(|filter| filter.note_excitation(!(21_000..=26_000).contains(&k)));
            together.advance(&mut bank, &active, &period, measured);
            assert!(alone == bank, "{k}");
        }
        assert_eq!(bank[1].steps() > 0, steps);
        assert!(bank.iter().all(|filter| filter.outliers() > 0 && filter.left_out() > 0));
    }
}

//! Lévy steps, equation (5), drawn by Mantegna's method.
//!
//! `step = sigma_u u / |v|^(1/lambda)` with `u, v ~ N(0, 1)` has the density's tail, `s^-(1 + lambda)`, on both sides. The
//! paper's (5) is that tail for `s > 0`; taken as the whole density it could only ever step away from the best flower.
//!
//! R. N. Mantegna, "Fast, accurate algorithm for numerical simulation of Lévy stable stochastic processes", Physical Review E
//! 49 (1994) 4677, doi:10.1103/PhysRevE.49.4677.

use crate::draws::Draws;

/// Mantegna's scale for the tail's exponent `l = lambda = 1.5`, the paper's and Yang's usual value:
/// `(Gamma(1+l) sin(pi l/2) / (Gamma((1+l)/2) l 2^((l-1)/2)))^(1/l)`.
const SIGMA_U: f64 = 0.696_574_502_557_697;

/// One step. Draws `u`, then `v`.
pub(crate) fn levy(draws: &mut Draws) -> f64 {
    let u = draws.normal();
    let v = draws.normal();
    // |v|^(1/lambda) = cbrt(v^2).
    SIGMA_U * u / (v * v).cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_mantegnas_formula() {
        use statrs::function::gamma::gamma;
        let l = 1.5;
        let sine = (std::f64::consts::FRAC_PI_2 * l).sin();
        let formula = (gamma(1.0 + l) * sine / (gamma((1.0 + l) / 2.0) * l * 2.0_f64.powf((l - 1.0) / 2.0))).powf(1.0 / l);
        assert!((SIGMA_U - formula).abs() < 1e-14, "{formula}");
    }

    #[test]
    fn steps_are_symmetric_and_their_tail_falls_with_the_power_lambda() {
        let mut draws = Draws::seeded(5, 0);
        let steps: Vec<f64> = (0..200_000).map(|_| levy(&mut draws)).collect();
        let beyond = |limit: f64| steps.iter().filter(|step| step.abs() > limit).count() as f64;
        let positive = steps.iter().filter(|step| **step > 0.0).count() as f64;
        // Binomial, 5 sigma: sqrt(200000)/2 * 5 = 1118.
        assert!((positive - 100_000.0).abs() < 1118.0, "{positive}");
        // P(|s| > x) ~ x^-1.5 far out: ten times farther is 31.6 times rarer (5 sigma of the rarer count, about 60 %, allowed).
        let ratio = beyond(5.0) / beyond(50.0);
        assert!((20.0..50.0).contains(&ratio), "{ratio}");
    }
}

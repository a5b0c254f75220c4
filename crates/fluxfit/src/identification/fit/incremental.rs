//! Incremental inductances, `d psi / d i`, of a motor that saturates: what a current controller sees, unlike the apparent `psi / i`.
//!
//! They are quotients of differences between two operating points: one current differs, the other hardly does.

use super::saturation::{Flux, SaturationFinding, TOLD};
use crate::frames::Dq;

/// An incremental inductance of one axis, between two operating points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Incremental {
    /// 0 for d, 1 for q.
    pub axis: usize,
    /// The operating points, from 0.
    pub points: [usize; 2],
    /// The currents halfway between them, A, at which a quotient of differences is closest to the derivative.
    pub current: Dq,
    /// `d psi / d i`, H.
    pub inductance: f64,
    /// Its standard uncertainty, H. What both points have in common, such as the error of R_s, is counted as if it were different.
    pub uncertainty: f64,
}

/// Points are close if the current differs by at most this part of the largest one. The quotient differs from the derivative by the
/// third derivative of the flux times a 24th of the square of that.
const CLOSE: f64 = 1.0 / 3.0;

/// They differ by a step of the current, and not by its noise or a controller's answer, if by at least this part of the largest one: what
/// voltages lose near one point and not near the other would be divided by next to nothing.
const LEAST_STEP: f64 = 0.05;

/// The other current may differ by this part of it: what cross saturation makes of that is less than other errors.
const ASIDE: f64 = 0.1;

impl SaturationFinding {
    /// The incremental inductances that points close to each other tell, each to half of its size; d first. Of pairs at the same currents
    /// the surest.
    pub fn incremental(&self) -> Vec<Incremental> {
        let told: Vec<(usize, &Flux)> = self.fluxes.iter().enumerate().filter_map(|(k, flux)| Some((k, flux.as_ref()?))).collect();
        let peak = told.iter().map(|(_, flux)| flux.current.magnitude()).fold(0.0, f64::max);
        let mut found = Vec::new();
        for axis in [0, 1] {
            let along = |dq: Dq| [dq.d, dq.q][axis];
            let aside = |dq: Dq| [dq.q, dq.d][axis];
            for (k, (first, one)) in told.iter().enumerate() {
                // The nearest one with more current, so that no pair contains another.
                let apart = |other: &Flux| along(other.current) - along(one.current);
                let is_pair = |other: &Flux| {
                    let step = apart(other);
                    let aside = (aside(other.current) - aside(one.current)).abs();
                    step >= LEAST_STEP * peak && step <= CLOSE * peak && aside <= ASIDE * step
                };
                let others = told.iter().enumerate().filter(|(other, (_, flux))| *other != k && is_pair(flux));
                let Some((_, (second, other))) = others.min_by(|(_, (_, a)), (_, (_, b))| apart(a).total_cmp(&apart(b))) else { continue };
                let inductance = (along(other.psi) - along(one.psi)) / apart(other);
                let uncertainty = along(one.uncertainty).hypot(along(other.uncertainty)) / apart(other);
                if 2.0 * uncertainty <= TOLD * inductance.abs() {
                    let current = Dq { d: 0.5 * (one.current.d + other.current.d), q: 0.5 * (one.current.q + other.current.q) };
                    found.push(Incremental { axis, points: [*first, *second], current, inductance, uncertainty });
                }
            }
        }
        let is_alike = |one: Dq, other: Dq| (one.d - other.d).hypot(one.q - other.q) < LEAST_STEP * peak;
        let is_surest = |one: &Incremental| {
            let of_load = |other: &&Incremental| other.axis == one.axis && is_alike(other.current, one.current);
            !found.iter().filter(of_load).any(|other| other.uncertainty < one.uncertainty)
        };
        found.iter().filter(|one| is_surest(one)).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper;

    /// `psi_q = a tanh(i_q / b)`, whose derivative is `a / b / cosh²(i_q / b)`; `psi_d = psi_f + L_d i_d`.
    const A: f64 = 0.12;
    const B: f64 = 12.0;

    fn finding(currents: &[(f64, f64)], uncertainty: f64) -> SaturationFinding {
        let flux = |&(d, q): &(f64, f64)| {
            Some(Flux {
                current: Dq { d, q },
                psi: Dq { d: 0.18 + 0.005 * d, q: A * (q / B).tanh() },
                uncertainty: Dq { d: uncertainty, q: uncertainty },
                is_told: true,
                apparent_lq: None,
                apparent_ld: None,
            })
        };
        SaturationFinding::with_fluxes(currents.iter().map(flux).collect(), paper::MOTOR)
    }

    #[test]
    fn points_close_to_each_other_tell_the_derivative_of_the_flux() {
        let found = finding(&[(0.0, 8.0), (0.0, 12.0), (0.0, 10.0)], 1e-4).incremental();
        let pairs: Vec<_> = found.iter().map(|one| (one.axis, one.points)).collect();
        // The point between two others belongs to both pairs, and they make none.
        assert_eq!(pairs, [(1, [0, 2]), (1, [2, 1])]);
        for one in &found {
            let derivative = A / B / (one.current.q / B).cosh().powi(2);
            assert!((one.inductance / derivative - 1.0).abs() < 0.005, "{one:?}: {derivative}");
            // Two errors of 1e-4 Wb over 2 A.
            assert!((one.uncertainty - 1e-4 * 2.0_f64.sqrt() / 2.0).abs() < 1e-9, "{one:?}");
        }
        // The apparent inductance is another number: 7.9 mH against 5.9 mH.
        assert!(found[0].inductance < 0.8 * A * (9.0 / B).tanh() / 9.0);
    }

    /// Steps from 8 to 10 A and back, three times: the pair with the smallest errors stands for all.
    #[test]
    fn of_pairs_at_the_same_currents_the_surest_stands() {
        let mut all = finding(&[(0.0, 8.0), (0.0, 10.0), (0.0, 8.01), (0.0, 10.01), (0.0, 7.99)], 1e-4);
        for (k, error) in [(1, 5e-5), (2, 4e-5)] {
            all.fluxes[k].as_mut().unwrap().uncertainty.q = error;
        }
        let found = all.incremental();
        assert_eq!(found.iter().map(|one| (one.axis, one.points)).collect::<Vec<_>>(), [(1, [2, 1])]);
    }

    #[test]
    fn the_d_axis_has_its_own() {
        let found = finding(&[(-4.0, 9.0), (-1.0, 9.2)], 1e-4).incremental();
        assert!(found.len() == 1 && found[0].axis == 0 && (found[0].inductance - 0.005).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn points_far_apart_or_aside_or_poor_tell_none() {
        assert_eq!(finding(&[(0.0, 4.0), (0.0, 12.0)], 1e-4).incremental(), []);
        assert_eq!(finding(&[(0.0, 8.0), (-1.0, 10.0)], 1e-4).incremental(), []);
        assert_eq!(finding(&[(0.0, 8.0), (0.0, 10.0)], 1e-2).incremental(), []);
    }
}

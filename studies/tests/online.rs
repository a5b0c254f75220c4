//! What a stream is told of a motor that its samples do not determine.

use fluxfit_studies::online::{Deficient, rank_deficient};

/// Of each parameter at least 95 % of the printed intervals hold the truth, and what is in no equation is never printed. What the equations
/// determine is printed in two thirds of the logs: at one operating point at i_d = 0 `u_d = -omega L_q i_q`, at several speeds also psi_f
/// from u_q (R_s is a small part of it at high speeds), at standstill all but psi_f.
#[test]
fn logs_that_do_not_determine_the_motor_get_no_wrong_intervals() {
    for kind in Deficient::ALL {
        let counts = rank_deficient(kind, 70);
        assert!(counts.iter().all(|(printed, right)| 20 * right >= 19 * printed), "{kind:?}: {counts:?}");
        let (mostly, never): (&[usize], &[usize]) = match kind {
            Deficient::OnePoint => (&[2], &[0, 1, 3]),
            Deficient::OnePointWithId => (&[], &[0, 1, 2, 3]),
            Deficient::ZeroId => (&[2, 3], &[1]),
            Deficient::Standstill => (&[0, 1, 2], &[3]),
        };
        assert!(mostly.iter().all(|j| 3 * counts[*j].0 >= 2 * 70), "{kind:?}: {counts:?}");
        assert!(never.iter().all(|j| counts[*j].0 == 0), "{kind:?}: {counts:?}");
    }
}

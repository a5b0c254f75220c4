//! Recursive estimators of R_s, L_d, L_q and psi_f of a permanent magnet synchronous motor, for firmware and for streams: no standard
//! library, no allocation, `f32` or `f64`.
//!
//! All quantities are in SI units and in the amplitude-invariant dq frame; speeds are electrical rad/s. Parameters are in the order
//! rs, ld, lq, psi_f, and are estimated as parts `z` of nominal values, so that all are near one.
//!
//! ```
//! use fluxfit_core::{BlockRls, BlockRlsSettings, Period};
//!
//! // 200 periods of 0.1 ms at standstill: a voltage step of 1 V along d into 1 ohm and 5 mH, i = 1 - exp(-t / 5 ms).
//! let mut rls = BlockRls::<f32>::new(BlockRlsSettings::new([1.2, 4e-3, 4e-3, 0.2]));
//! rls.begin([0.0, 0.0]);
//! for k in 1..=200 {
//!     let i = [1.0 - libm::expf(-0.02 * k as f32), 0.0];
//!     rls.advance(&Period { u: [1.0, 0.0], omega_e: 0.0, length: 1e-4 }, i);
//! }
//! let estimate = rls.estimate();
//! assert!((estimate.value[0] - 1.0).abs() < 0.01 && (estimate.value[1] - 5e-3).abs() < 5e-5);
//! // Nothing tells the flux at standstill.
//! assert!(estimate.standard_error[3] > 1.0);
//! ```
//!
//! | file | concept |
//! |---|---|
//! | [`real`] | the numbers: `f32` or `f64` |
//! | [`period`] | the exact current after a sample period, and its sensitivities |
//! | [`block`] | a block of periods as two linear equations |
//! | [`square_root`] | least squares in square-root (QR) form |
//! | [`gate`] | whether the last blocks excite the parameters |
//! | [`block_rls`] | recursive least squares over blocks |
//! | [`ud`] | a covariance in UD form |
//! | [`step_test`] | likelihood-ratio test for steps of a parameter |
//! | [`ekf`] | extended Kalman filter of currents and parameters |
//! | [`lanes`], [`bank`] | several filters at once, a filter in each lane of a vector |
#![no_std]
#![allow(clippy::needless_range_loop, reason = "the formulas of matrices have indices")]

pub mod bank;
pub mod block;
pub mod block_rls;
pub mod ekf;
pub mod gate;
pub mod lanes;
pub mod period;
pub mod real;
pub mod square_root;
pub mod step_test;
pub mod ud;
pub mod walk;

pub use block_rls::{BlockRls, BlockRlsSettings, Estimate};
pub use ekf::{Ekf, EkfSettings, SURPRISE_MEMORY};
pub use lanes::Lanes;
pub use period::Period;
pub use real::{Number, Real};

/// Number of parameters: rs, ld, lq, psi_f.
pub const PARAMETERS: usize = 4;

//! Data of the paper: its motor, its test rig, its results.
//!
//! Gao, Wang, Jiang and Hu, "Parameters Identification of PMSM Based on Improved Flower Pollination Algorithm", 2023. The paper
//! prints the units of L_d and psi_f swapped in its Table 2; here they are corrected. It does not state the search box, sample rate, DC
//! voltage or controller. The search box is chosen below, the others in the simulated rig (`fluxfit_drive::Scenario::paper`).

use crate::{
    motor::{Motor, PARAMETERS},
    optimizer::{
        Method,
        methods::{apso::Apso, fpa::Fpa, lpso::Lpso, tgfpa::Tgfpa},
    },
};

/// Table 1.
pub const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Table 1.
pub const POLE_PAIRS: u32 = 4;

/// Table 1, kg m².
pub const INERTIA: f64 = 0.003;

/// Table 1, N m s.
pub const FRICTION: f64 = 0.008;

/// Section 4.1, N m.
pub const LOAD: f64 = 10.0;

/// Section 4.1, mechanical r/min.
pub const SPEED_RPM: f64 = 1000.0;

/// Section 4.1: i_d of the second operating point, A. The first has i_d = 0.
pub const ID: f64 = -2.0;

/// Section 4.1: runs of each method.
pub const RUNS: usize = 50;

/// The methods that it compares, in the order of Table 2; their settings where the paper leaves them open are ours.
pub const METHODS: [Method; 4] =
    [Method::Tgfpa(Tgfpa::DEFAULT), Method::Fpa(Fpa::DEFAULT), Method::Lpso(Lpso::DEFAULT), Method::Apso(Apso::DEFAULT)];

/// Upper bounds of the search box; the lower bounds are zero. Not from the paper: four to ten times the true values.
pub const SEARCH_BOX: [f64; PARAMETERS] = [5.0, 0.05, 0.05, 1.0];

/// One column of Table 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table2Column {
    /// [`Method::key`](crate::optimizer::Method::key) of the method.
    pub method: &'static str,
    /// Mean of the estimates.
    pub mean: Motor,
    /// Error, %. It is not the error of the mean, so presumably it is the mean of the runs' errors.
    pub error_percent: [f64; PARAMETERS],
}

/// Table 2.
pub const TABLE_2: [Table2Column; 4] = [
    Table2Column {
        method: "tgfpa",
        mean: Motor { rs: 0.9639, ld: 5.283e-3, lq: 11.999e-3, psi_f: 0.18263 },
        error_percent: [0.638, 0.629, 0.01414, 0.051],
    },
    Table2Column {
        method: "fpa",
        mean: Motor { rs: 0.9623, ld: 5.273e-3, lq: 11.998e-3, psi_f: 0.18268 },
        error_percent: [1.156, 0.820, 0.04101, 0.138],
    },
    Table2Column {
        method: "lpso",
        mean: Motor { rs: 0.9703, ld: 5.287e-3, lq: 11.997e-3, psi_f: 0.18249 },
        error_percent: [1.451, 0.700, 0.02963, 0.145],
    },
    Table2Column {
        method: "apso",
        mean: Motor { rs: 0.9629, ld: 5.279e-3, lq: 11.999e-3, psi_f: 0.18265 },
        error_percent: [0.908, 0.940, 0.02442, 0.110],
    },
];

//! The random walk of the parameters while they are followed, and where it waits.
//!
//! At one operating point the voltages
//!
//! ```text
//! u_d = rs i_d - omega lq i_q      u_q = rs i_q + omega (ld i_d + psi_f)
//! ```
//!
//! tell two combinations of the parameters, and nothing but the noise of the currents tells the others apart. A filter whose parameters
//! walk in all directions makes the others out of noise: within 10 s it moved rs by 8 % that did not change. So while nothing excites the
//! parameters, they walk only as far as the operating point tells: with the walk's variance `Q` and the sensitivities `H` of the voltages,
//! by `Q H (H' Q H)^-1 H' Q`. The rest of `Q` is owed, and paid when the parameters are excited again. So nothing is forgotten that is not
//! replaced, as in directional forgetting (Kulhavy 1987, doi 10.1016/0005-1098(87)90054-9).
//!
//! What is owed after a time `t` is `Q (t + t²/s)`. A winding that warms goes on warming: nobody sees its drift, so that its standard
//! error grows with the time, not with the root of it.

use crate::{PARAMETERS, real::Number};

/// Seconds after which a drift in one direction is as large as a random walk.
const DRIFT: f64 = 1.0;

/// Largest standard error that is owed, as a part of the nominal value: two of them are 0.393 % of copper at 20 degC times 100 K.
const MOST_OWED: f64 = 0.2;

/// The walk.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Walk<T> {
    is_excited: bool,
    /// Variance that is owed to each parameter.
    owed: [T; PARAMETERS],
    /// Time without excitation, s.
    unseen: T,
}

impl<T: Number> Walk<T> {
    /// One in all directions.
    pub fn new() -> Self {
        Self { is_excited: true, owed: [T::ZERO; PARAMETERS], unseen: T::ZERO }
    }

    /// Notes whether the last samples excite the parameters.
    pub fn note(&mut self, is_excited: bool) {
        self.is_excited = is_excited;
    }

    /// Whether the last samples excite the parameters.
    pub(crate) fn is_excited(&self) -> bool {
        self.is_excited
    }

    /// Calls `with` for each number and that of another walk.
    #[inline(always)]
    pub(crate) fn with<U>(&mut self, other: &mut Walk<U>, with: impl Fn(&mut T, &mut U)) {
        for j in 0..PARAMETERS {
            with(&mut self.owed[j], &mut other.owed[j]);
        }
        with(&mut self.unseen, &mut other.unseen);
    }

    /// What a period adds to the variances of the parameters, of which `q` is the walk's over it.
    #[inline(always)]
    pub fn of_all(&mut self, q: [T; PARAMETERS]) -> [T; PARAMETERS] {
        if !self.is_excited {
            return [T::ZERO; PARAMETERS];
        }
        self.unseen = T::ZERO;
        let owed = core::mem::replace(&mut self.owed, [T::ZERO; PARAMETERS]);
        [0, 1, 2, 3].map(|j| q[j] + owed[j])
    }

    /// What a period of this length, s, adds in the directions `v` that the operating point tells, as `v v'`; nothing while the parameters
    /// are excited. `h` has the derivatives of u_d and u_q to the parameters.
    #[inline(always)]
    pub fn of_told(&mut self, length: T, q: [T; PARAMETERS], h: [[T; PARAMETERS]; 2]) -> Option<[[T; PARAMETERS]; 2]> {
        if self.is_excited {
            return None;
        }
        let product = |a: &[T; PARAMETERS], b: &[T; PARAMETERS]| (0..PARAMETERS).fold(T::ZERO, |sum, j| sum + a[j] * q[j] * b[j]);
        // Orthogonal directions, by Gram and Schmidt.
        let [mut of_d, of_q] = h;
        let squared = product(&of_q, &of_q);
        let part = squared.if_above(T::ZERO, product(&of_d, &of_q) / squared, T::ZERO);
        for j in 0..PARAMETERS {
            of_d[j] -= part * of_q[j];
        }
        let v = [of_q, of_d].map(|h| {
            let squared = product(&h, &h);
            let root = squared.if_above(T::ZERO, squared.sqrt(), T::ONE);
            [0, 1, 2, 3].map(|j| squared.if_above(T::ZERO, q[j] * h[j] / root, T::ZERO))
        });
        // The derivative of t + t²/s.
        let growth = T::ONE + T::of(2.0 / DRIFT) * self.unseen;
        self.unseen += length;
        for j in 0..PARAMETERS {
            let untold = (q[j] - v[0][j] * v[0][j] - v[1][j] * v[1][j]).larger(T::ZERO);
            self.owed[j] = (self.owed[j] + growth * untold).smaller(T::of(MOST_OWED * MOST_OWED));
        }
        Some(v)
    }

    /// Variance that is owed to each parameter.
    pub fn owed(&self) -> &[T; PARAMETERS] {
        &self.owed
    }
}

impl<T: Number> Default for Walk<T> {
    fn default() -> Self {
        Self::new()
    }
}

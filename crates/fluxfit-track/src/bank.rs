//! A bank of Kalman filters with different settings on the same samples: a filter in each lane of the vectors of a processor with AVX2,
//! else one after another. The bits are the same.

use fluxfit_core::{Ekf, Period, bank::Together};

/// The filters of the bank that are active, and what they see.
struct Advance<'a> {
    together: &'a mut Together,
    filters: &'a mut [Ekf<f64>],
    active: &'a [bool],
    period: &'a Period<f64>,
    i: [f64; 2],
}

#[cfg(target_arch = "x86_64")]
impl pulp::NullaryFnOnce for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.together.advance(self.filters, self.active, self.period, self.i);
    }
}

impl Advance<'_> {
    fn one_by_one(self) {
        for (filter, _) in self.filters.iter_mut().zip(self.active).filter(|(_, active)| **active) {
            filter.advance(self.period, self.i);
        }
    }
}

/// The active filters go on by a period to a current, A. `together` is room that is kept from one period to the next.
pub fn advance(together: &mut Together, filters: &mut [Ekf<f64>], active: &[bool], period: &Period<f64>, i: [f64; 2]) {
    let advance = Advance { together, filters, active, period, i };
    // AVX-512 was tried too: what is laid into lanes number by number and read as a whole vector at once makes it wait; it took longer.
    #[cfg(target_arch = "x86_64")]
    if let Some(set) = pulp::x86::V3::try_new() {
        pulp::Simd::vectorize(set, advance);
        return;
    }
    advance.one_by_one();
}

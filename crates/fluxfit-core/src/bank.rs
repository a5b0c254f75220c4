//! Several filters that see the same samples, as a bank with different settings does, each in a lane of a vector.
//!
//! The filters stay as they are: before a period their numbers are laid side by side, and put back after it. Each filter gets the bits
//! that it would get alone. What is rare, such as a step of a parameter, every filter decides on its own. Where one would divide the period
//! into more parts than another, each goes alone.

use crate::{
    ekf::Ekf,
    lanes::{LANES, Lanes},
    period::Period,
};

/// Fewest filters for which it is worth while.
const FEWEST: usize = 4;

/// Room for the numbers of several filters. It holds nothing from one period to the next.
#[derive(Debug, Clone)]
pub struct Together {
    filter: Ekf<Lanes>,
}

impl Together {
    /// The room.
    pub fn new() -> Self {
        Self { filter: Ekf::blank() }
    }

    /// Those filters that are active go on by a period with the current, A, measured at its end, as many side by side as there are lanes.
    /// Compiled for wide instructions where its caller is.
    #[inline(always)]
    pub fn advance(&mut self, filters: &mut [Ekf<f64>], active: &[bool], period: &Period<f64>, measured: [f64; 2]) {
        let mut places = (0..filters.len()).filter(|place| active.get(*place) == Some(&true));
        let mut along = [0; LANES];
        loop {
            let mut count = 0;
            while count < LANES
                && let Some(place) = places.next()
            {
                let is_alike = count == 0 || filters[place].is_like(&filters[along[0]]);
                if is_alike && filters[place].goes_along(period, measured) {
                    along[count] = place;
                    count += 1;
                } else {
                    filters[place].advance(period, measured);
                }
            }
            if count == 0 {
                return;
            }
            self.learn(filters, &along[..count], period, measured);
        }
    }

    /// The filters at these places learn side by side.
    #[inline(always)]
    fn learn(&mut self, filters: &mut [Ekf<f64>], along: &[usize], period: &Period<f64>, measured: [f64; 2]) {
        if along.len() < FEWEST {
            along.iter().for_each(|place| filters[*place].advance(period, measured));
            return;
        }
        let mut late = Lanes::all(0.0);
        self.filter.become_like(&filters[along[0]]);
        for lane in 0..LANES {
            // Lanes without a filter of their own repeat the first one.
            let filter = &mut filters[*along.get(lane).unwrap_or(&along[0])];
            filter.open_window();
            late.0[lane] = filter.late();
            self.filter.with_settings_of(filter, |lanes, own| lanes.0[lane] = *own);
            self.filter.with_state_of(filter, |lanes, own| lanes.0[lane] = *own);
        }
        let wide = Period { u: period.u.map(Lanes::all), omega_e: Lanes::all(period.omega_e), length: Lanes::all(period.length) };
        if !self.filter.divides_alike(&wide) {
            along.iter().for_each(|place| filters[*place].advance(period, measured));
            return;
        }
        let beyond = self.filter.learn(&wide, measured.map(Lanes::all), late);
        for (lane, place) in along.iter().enumerate() {
            let filter = &mut filters[*place];
            self.filter.with_state_of(filter, |lanes, own| *own = lanes.0[lane]);
            filter.decide([beyond[0].0[lane] > 0.0, beyond[1].0[lane] > 0.0], measured);
        }
    }
}

impl Default for Together {
    fn default() -> Self {
        Self::new()
    }
}

// It holds nothing.
impl PartialEq for Together {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

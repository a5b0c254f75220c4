//! The chaotic start, equations (7) and (8): a population laid out by the logistic map.
//!
//! `b_{i+1} = mu b_i (1 - b_i)`, `x_i = L + b_i (U - L)`, one independent chain per dimension. `mu = 4` is the fully chaotic map;
//! its density is the arcsine law, denser at the box's faces than in its middle.

use crate::{bounds::Bounds, draws::Draws};

/// The map's control parameter: fully chaotic.
const MU: f64 = 4.0;

/// Starts that end in a fixed point of the map, and are avoided: 0 and 3/4 are fixed points, the others lead there.
const TRAPS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// How far from a trap a start must be. Near 0 and 3/4 the map takes about `log2(1e-3 / distance)` steps to leave; 1e-3 keeps
/// that small beside a population of 50.
const CLEARANCE: f64 = 1e-3;

/// Positions of `population` candidates, row after row. Draws one start per dimension.
pub(crate) fn logistic_start(population: usize, bounds: &Bounds, draws: &mut Draws) -> Vec<f64> {
    let mut chain: Vec<f64> = (0..bounds.dimension()).map(|_| start(draws)).collect();
    let mut positions = Vec::with_capacity(population * chain.len());
    for _ in 0..population {
        for (b, (lower, upper)) in chain.iter_mut().zip(bounds.iter()) {
            // At the map's peak, b = 1, rounding can lead past the face.
            positions.push((lower + *b * (upper - lower)).min(upper));
            *b = MU * *b * (1.0 - *b);
        }
    }
    positions
}

fn start(draws: &mut Draws) -> f64 {
    loop {
        let b = draws.uniform();
        if TRAPS.iter().all(|trap| (b - trap).abs() > CLEARANCE) {
            return b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_by_hand() {
        let bounds = Bounds::new(vec![10.0], vec![20.0]).unwrap();
        // 0.1 -> 0.36 -> 0.9216 -> 0.28901376
        let x = logistic_start(4, &bounds, &mut Draws::replay(vec![0.1]));
        for (got, expected) in x.iter().zip([11.0, 13.6, 19.216, 12.890_137_6]) {
            assert!((got - expected).abs() < 1e-13, "{got} {expected}");
        }
    }

    /// The map's peak is 1, and `lower + (upper - lower)` may be rounded to above `upper`.
    #[test]
    fn positions_stay_in_the_box_at_the_maps_peak() {
        let bounds = Bounds::new(vec![-0.3], vec![0.47]).unwrap();
        // sin²(pi/8): the map goes on to 1/2 and 1.
        let peak = logistic_start(4, &bounds, &mut Draws::replay(vec![0.146_446_609_406_726_24]))[2];
        assert!((peak - 0.47).abs() < 1e-12, "{peak}");
        assert!(bounds.contains(&[peak]), "{peak}");
    }

    #[test]
    fn trapped_starts_are_drawn_again() {
        let bounds = Bounds::new(vec![0.0], vec![1.0]).unwrap();
        let x = logistic_start(1, &bounds, &mut Draws::replay(vec![0.5, 0.7501, 1e-9, 0.3]));
        assert_eq!(x, [0.3]);
    }
}

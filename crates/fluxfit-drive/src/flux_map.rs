//! A flux map: flux linkages measured over a grid of currents.
//!
//! Interpolation is by bicubic Hermite patches with three-point differences as slopes at the nodes, so that the fluxes and their
//! derivatives, the incremental inductances, are continuous. There is no extrapolation.

use crate::error::Error;
use fluxfit::frames::Dq;

/// Flux linkages over `i_d` and `i_q`.
#[derive(Debug, Clone, PartialEq)]
pub struct FluxMap {
    id: Vec<f64>,
    iq: Vec<f64>,
    /// One node per pair of currents, `i_q` varying fastest.
    nodes: Vec<Node>,
}

/// Flux linkage and incremental inductances at one current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxLinkage {
    /// Flux linkage, Wb.
    pub psi: Dq,
    /// Incremental inductances, H: `[[d psi_d/d i_d, d psi_d/d i_q], [d psi_q/d i_d, d psi_q/d i_q]]`.
    pub inductance: [[f64; 2]; 2],
}

/// A node, for psi_d and psi_q: value, first derivatives along `i_d` and `i_q`, mixed derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Node {
    value: [f64; 2],
    along_d: [f64; 2],
    along_q: [f64; 2],
    mixed: [f64; 2],
}

impl FluxMap {
    /// A map from its points, in any order: current and flux linkage.
    ///
    /// # Errors
    /// If the points are not a complete grid of at least 3 by 3 currents, a value is not finite, or the incremental inductances are not
    /// physical: positive along both axes and in their determinant.
    pub fn new(points: &[(Dq, Dq)]) -> Result<Self, Error> {
        if let Some((i, _)) = points.iter().find(|(i, psi)| ![i.d, i.q, psi.d, psi.q].iter().all(|value| value.is_finite())) {
            return Err(Error::MapNotFinite { id: i.d, iq: i.q });
        }
        let (id, iq) = (axis(points, |i| i.d), axis(points, |i| i.q));
        if id.len() < 3 || iq.len() < 3 {
            return Err(Error::MapTooSmall { id: id.len(), iq: iq.len() });
        }
        let mut sorted: Vec<&(Dq, Dq)> = points.iter().collect();
        sorted.sort_by(|(a, _), (b, _)| a.d.total_cmp(&b.d).then(a.q.total_cmp(&b.q)));
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(Error::MapRepeated { id: pair[0].0.d, iq: pair[0].0.q });
        }
        let mut expected = id.iter().flat_map(|d| iq.iter().map(move |q| (*d, *q)));
        let mut given = sorted.iter().map(|(i, _)| (i.d, i.q));
        if let Some((d, q)) = expected.find(|pair| given.next() != Some(*pair)) {
            return Err(Error::MapMissingPoint { id: d, iq: q });
        }
        let nodes = sorted.iter().map(|(_, psi)| Node { value: [psi.d, psi.q], ..Node::default() }).collect();
        let mut map = Self { id, iq, nodes };
        map.compute_slopes();
        map.check_inductances()?;
        Ok(map)
    }

    /// Range of `i_d`, A.
    pub fn id_range(&self) -> [f64; 2] {
        [self.id[0], self.id[self.id.len() - 1]]
    }

    /// Range of `i_q`, A.
    pub fn iq_range(&self) -> [f64; 2] {
        [self.iq[0], self.iq[self.iq.len() - 1]]
    }

    /// The points of the grid, as for [`new`](Self::new).
    pub fn points(&self) -> impl Iterator<Item = (Dq, Dq)> {
        let currents = self.id.iter().flat_map(|d| self.iq.iter().map(|q| Dq { d: *d, q: *q }));
        currents.zip(&self.nodes).map(|(i, node)| (i, Dq { d: node.value[0], q: node.value[1] }))
    }

    /// The flux linkage at a current, A; `None` outside of the grid.
    pub fn at(&self, i: Dq) -> Option<FluxLinkage> {
        let (row, u, width) = cell(&self.id, i.d)?;
        let (column, v, height) = cell(&self.iq, i.q)?;
        let ((bu, su), (bv, sv)) = (hermite(u, width), hermite(v, height));
        let mut flux = FluxLinkage { psi: Dq::default(), inductance: [[0.0; 2]; 2] };
        let mut psi = [0.0; 2];
        for corner in 0..4 {
            let (a, b) = (corner / 2, corner % 2);
            let node = &self.nodes[(row + a) * self.iq.len() + column + b];
            // Along each axis: the weights of value and slope, and their derivatives.
            let (d, dd, q, dq) = (bu[a], su[a], bv[b], sv[b]);
            for (axis, psi) in psi.iter_mut().enumerate() {
                let [value, along_d, along_q, mixed] = [node.value[axis], node.along_d[axis], node.along_q[axis], node.mixed[axis]];
                *psi += d[0] * (q[0] * value + q[1] * along_q) + d[1] * (q[0] * along_d + q[1] * mixed);
                flux.inductance[axis][0] += dd[0] * (q[0] * value + q[1] * along_q) + dd[1] * (q[0] * along_d + q[1] * mixed);
                flux.inductance[axis][1] += d[0] * (dq[0] * value + dq[1] * along_q) + d[1] * (dq[0] * along_d + dq[1] * mixed);
            }
        }
        flux.psi = Dq { d: psi[0], q: psi[1] };
        Some(flux)
    }

    fn compute_slopes(&mut self) {
        let (rows, columns) = (self.id.len(), self.iq.len());
        for axis in 0..2 {
            for row in 0..rows {
                let line: Vec<f64> = (0..columns).map(|column| self.nodes[row * columns + column].value[axis]).collect();
                for (column, slope) in slopes(&self.iq, &line).into_iter().enumerate() {
                    self.nodes[row * columns + column].along_q[axis] = slope;
                }
            }
            for column in 0..columns {
                let along = |what: fn(&Node) -> [f64; 2]| -> Vec<f64> {
                    let line: Vec<f64> = (0..rows).map(|row| what(&self.nodes[row * columns + column])[axis]).collect();
                    slopes(&self.id, &line)
                };
                let (along_d, mixed) = (along(|node| node.value), along(|node| node.along_q));
                for row in 0..rows {
                    let node = &mut self.nodes[row * columns + column];
                    (node.along_d[axis], node.mixed[axis]) = (along_d[row], mixed[row]);
                }
            }
        }
    }

    /// Checks the inductances at the nodes, then between them: a cubic through a sharp knee may fall although its nodes rise. The error
    /// names a node.
    fn check_inductances(&self) -> Result<(), Error> {
        let nodes = |part: usize| self.id.iter().flat_map(move |d| self.iq.iter().map(move |q| (*d, *q, part)));
        for (d, q, part) in nodes(1).chain(nodes(CHECKS)) {
            let within = |grid: &[f64], x: f64| -> Vec<f64> {
                let width = grid.iter().find(|node| **node > x).map_or(0.0, |next| next - x);
                (0..part).map(|k| x + width * k as f64 / part as f64).collect()
            };
            let (ids, iqs) = (within(&self.id, d), within(&self.iq, q));
            let mut points = ids.iter().flat_map(|d| iqs.iter().map(move |q| Dq { d: *d, q: *q }));
            let rises = |FluxLinkage { inductance: [[dd, dq], [qd, qq]], .. }: FluxLinkage| dd > 0.0 && qq > 0.0 && dd * qq > dq * qd;
            if !points.all(|i| self.at(i).is_some_and(rises)) {
                return Err(Error::MapInductance { id: d, iq: q });
            }
        }
        Ok(())
    }
}

/// Points per cell along each axis at which inductances are checked.
const CHECKS: usize = 4;

/// The distinct currents along one axis, ascending.
fn axis(points: &[(Dq, Dq)], of: fn(&Dq) -> f64) -> Vec<f64> {
    // Adding zero turns -0 into 0.
    let mut values: Vec<f64> = points.iter().map(|(i, _)| of(i) + 0.0).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// The cell that contains `x`: its index, the relative position in it (0 to 1), its width.
fn cell(grid: &[f64], x: f64) -> Option<(usize, f64, f64)> {
    let last = grid.len() - 1;
    if !(grid[0]..=grid[last]).contains(&x) {
        return None;
    }
    let index = grid.partition_point(|node| *node <= x).clamp(1, last) - 1;
    let width = grid[index + 1] - grid[index];
    Some((index, (x - grid[index]) / width, width))
}

/// Hermite weights of value and slope at both ends of a cell, and their derivatives: `([start, end], [start', end'])`.
fn hermite(u: f64, width: f64) -> ([[f64; 2]; 2], [[f64; 2]; 2]) {
    let (u2, u3) = (u * u, u * u * u);
    let weights = [[2.0 * u3 - 3.0 * u2 + 1.0, (u3 - 2.0 * u2 + u) * width], [3.0 * u2 - 2.0 * u3, (u3 - u2) * width]];
    let rise = 6.0 * (u2 - u) / width;
    (weights, [[rise, 3.0 * u2 - 4.0 * u + 1.0], [-rise, 3.0 * u2 - 2.0 * u]])
}

/// Slopes at the nodes of a line: those of the parabola through each node and its neighbours.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let last = x.len() - 1;
    (0..=last)
        .map(|k| {
            let middle = k.clamp(1, last - 1);
            let (before, after) = (x[middle] - x[middle - 1], x[middle + 1] - x[middle]);
            let (rise_before, rise_after) = ((y[middle] - y[middle - 1]) / before, (y[middle + 1] - y[middle]) / after);
            let bend = (rise_after - rise_before) / (before + after);
            rise_before + bend * (2.0 * x[k] - x[middle] - x[middle - 1])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A surface that is a parabola along each axis: its slopes and interpolation are exact.
    fn parabola(i: Dq) -> FluxLinkage {
        let Dq { d, q } = i;
        FluxLinkage {
            psi: Dq { d: 0.2 + 0.01 * d - 1e-4 * d * d + 1e-5 * d * q, q: 0.02 * q - 2e-4 * q * q + 1e-5 * d * q },
            inductance: [[0.01 - 2e-4 * d + 1e-5 * q, 1e-5 * d], [1e-5 * q, 0.02 - 4e-4 * q + 1e-5 * d]],
        }
    }

    fn map_of(flux: fn(Dq) -> FluxLinkage) -> Result<FluxMap, Error> {
        let grid = |values: &'static [f64]| values.iter().copied();
        let currents = grid(&[5.0, -10.0, 0.0, -3.0]).flat_map(|d| grid(&[0.0, 4.0, 9.0, -7.0]).map(move |q| Dq { d, q }));
        FluxMap::new(&currents.map(|i| (i, flux(i).psi)).collect::<Vec<_>>())
    }

    proptest! {
        #[test]
        fn parabolas_are_exact(d in -10.0..5.0, q in -7.0..9.0) {
            let (found, expected) = (map_of(parabola).unwrap().at(Dq { d, q }).unwrap(), parabola(Dq { d, q }));
            prop_assert!((found.psi.d - expected.psi.d).abs() < 1e-14 && (found.psi.q - expected.psi.q).abs() < 1e-14);
            for (found, expected) in found.inductance.iter().flatten().zip(expected.inductance.iter().flatten()) {
                prop_assert!((found - expected).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn there_is_a_value_at_the_edge_and_none_outside() {
        let map = map_of(parabola).unwrap();
        assert_eq!((map.id_range(), map.iq_range()), ([-10.0, 5.0], [-7.0, 9.0]));
        assert!(map.at(Dq { d: 5.0, q: 9.0 }).is_some() && map.at(Dq { d: -10.0, q: -7.0 }).is_some());
        assert!(map.at(Dq { d: 5.001, q: 0.0 }).is_none() && map.at(Dq { d: 0.0, q: f64::NAN }).is_none());
        assert_eq!(FluxMap::new(&map.points().collect::<Vec<_>>()), Ok(map));
    }

    #[test]
    fn invalid_maps_are_refused() {
        let points: Vec<_> = map_of(parabola).unwrap().points().collect();
        assert_eq!(FluxMap::new(&points[1..]), Err(Error::MapMissingPoint { id: -10.0, iq: -7.0 }));
        assert_eq!(FluxMap::new(&points[..15]), Err(Error::MapMissingPoint { id: 5.0, iq: 9.0 }));
        assert!(matches!(FluxMap::new(&[]), Err(Error::MapTooSmall { id: 0, iq: 0 })));
        let mut repeated = points.clone();
        repeated[1] = repeated[0];
        assert!(matches!(FluxMap::new(&repeated), Err(Error::MapRepeated { .. })));
        let mut broken = points.clone();
        broken[3].1.q = f64::NAN;
        assert!(matches!(FluxMap::new(&broken), Err(Error::MapNotFinite { .. })));
        let falling: Vec<_> = points.iter().map(|(i, psi)| (*i, Dq { d: -psi.d, q: psi.q })).collect();
        assert!(matches!(FluxMap::new(&falling), Err(Error::MapInductance { .. })));
    }
}

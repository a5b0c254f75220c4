//! One sample period: the current at its end, exactly, and its sensitivities to the current at its beginning and to the parameters.
//!
//! Within a period the voltage stands still in the stator, so that it turns backward in the rotor's frame, and the speed is constant:
//!
//! ```text
//! di/dt = A i + L^-1 (u - omega psi_f e_q)     du/dt = -omega J u     A = [-rs/ld, omega lq/ld; -omega ld/lq, -rs/lq]
//! ```
//!
//! The Taylor series in time needs neither exponentials nor complex numbers. With `i^(n)` the n-th derivative at the beginning,
//! `i^(n+1) = A i^(n) + L^-1 u^(n)`; the sensitivities follow the derivative of the same recursion. A period in which the winding or the
//! rotor changes much is divided.

use crate::{PARAMETERS, real::Number};

/// What acts over a sample period.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Period<T> {
    /// The voltage, V, constant in the stator, in the dq frame at the middle of the period.
    pub u: [T; 2],
    /// Mean speed, electrical rad/s.
    pub omega_e: T,
    /// Length, s.
    pub length: T,
}

/// The current at the end of a period and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival<T> {
    /// The current, A.
    pub i: [T; 2],
    /// Its derivatives to the current at the beginning: the columns of F.
    pub by_current: [[T; 2]; 2],
    /// Its derivatives to rs, ld, lq and psi_f: the columns of S.
    pub by_parameter: [[T; 2]; PARAMETERS],
}

/// Terms of the series. The error of the last one left out is `(|A| h)^6 / 720`: 1e-6 of the change at [`LONGEST`].
const ORDER: usize = 5;

/// Largest `(rs/min(ld, lq) + omega max(ld/lq, lq/ld)) h` of an undivided period.
const LONGEST: f64 = 0.3;

/// Most parts of a period, so that the time for one is bounded whatever the input: enough for a turn of 20 rad.
const MOST_PARTS: usize = 64;

/// The coefficients of the equations for one set of parameters and one speed.
struct Rates<T> {
    theta: [T; PARAMETERS],
    omega_e: T,
    /// 1/ld and 1/lq.
    inverse: [T; 2],
    a: [[T; 2]; 2],
}

impl<T: Number> Rates<T> {
    #[inline(always)]
    fn new(theta: &[T; PARAMETERS], omega_e: T) -> Self {
        let [rs, ld, lq, _] = *theta;
        let inverse = [T::ONE / ld, T::ONE / lq];
        let a = [[-(rs * inverse[0]), omega_e * lq * inverse[0]], [-(omega_e * ld * inverse[1]), -(rs * inverse[1])]];
        Self { theta: *theta, omega_e, inverse, a }
    }

    /// What the turn of the current in a period is of the largest one.
    #[inline(always)]
    fn wanted(&self, length: T) -> T {
        let rate = (-self.a[0][0]).abs().larger(self.a[1][1].abs()) + self.a[0][1].abs().larger(self.a[1][0].abs());
        rate * length / T::of(LONGEST)
    }

    /// How many parts, and their length.
    #[inline(always)]
    fn parts(&self, length: T) -> (usize, T) {
        let count = count_of(self.wanted(length).largest());
        (count, length / T::of(count as f64))
    }

    #[inline(always)]
    fn times(&self, x: [T; 2]) -> [T; 2] {
        [self.a[0][0] * x[0] + self.a[0][1] * x[1], self.a[1][0] * x[0] + self.a[1][1] * x[1]]
    }

    /// The first derivative of the current.
    #[inline(always)]
    fn slope(&self, i: [T; 2], u: [T; 2]) -> [T; 2] {
        let of_i = self.times(i);
        [of_i[0] + u[0] * self.inverse[0], of_i[1] + (u[1] - self.omega_e * self.theta[3]) * self.inverse[1]]
    }
}

/// The voltage at the beginning of a period, seen from the rotor, from that at its middle.
#[inline(always)]
fn at_beginning<T: Number>(period: &Period<T>) -> [T; 2] {
    let (sin, cos) = (T::of(0.5) * period.omega_e * period.length).sin_cos();
    let [d, q] = period.u;
    [cos * d - sin * q, sin * d + cos * q]
}

/// The voltage after a further time, seen from the rotor.
#[inline(always)]
fn turned_back<T: Number>(u: [T; 2], angle: T) -> [T; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * u[0] + sin * u[1], cos * u[1] - sin * u[0]]
}

/// Whether a period is divided into the same number of parts in all lanes.
#[inline(always)]
pub(crate) fn is_divided_alike<T: Number>(theta: &[T; PARAMETERS], period: &Period<T>) -> bool {
    let wanted = Rates::new(theta, period.omega_e).wanted(period.length);
    count_of(wanted.largest()) == count_of(-(-wanted).largest())
}

/// Number of parts. A number that is no number takes one part.
#[inline(always)]
fn count_of(wanted: f64) -> usize {
    if wanted > 1.0 { (wanted as usize + 1).min(MOST_PARTS) } else { 1 }
}

/// The current after a period, A, of a motor with the parameters `theta`.
pub fn current_after<T: Number>(theta: &[T; PARAMETERS], i: [T; 2], period: &Period<T>) -> [T; 2] {
    let rates = Rates::new(theta, period.omega_e);
    let (parts, h) = rates.parts(period.length);
    let (mut i, mut u_start) = (i, at_beginning(period));
    for part in 0..parts {
        if part > 0 {
            u_start = turned_back(u_start, period.omega_e * h);
        }
        let (mut u, mut term, mut weight) = (u_start, rates.slope(i, u_start), h);
        for n in 2..=ORDER {
            i = [i[0] + weight * term[0], i[1] + weight * term[1]];
            weight = weight * h / T::of(n as f64);
            u = [period.omega_e * u[1], -(period.omega_e * u[0])];
            let next = rates.times(term);
            term = [next[0] + u[0] * rates.inverse[0], next[1] + u[1] * rates.inverse[1]];
        }
        i = [i[0] + weight * term[0], i[1] + weight * term[1]];
    }
    i
}

/// The current after a period, with its derivatives.
#[inline(always)]
pub fn arrival<T: Number>(theta: &[T; PARAMETERS], i: [T; 2], period: &Period<T>) -> Arrival<T> {
    let rates = Rates::new(theta, period.omega_e);
    let (parts, h) = rates.parts(period.length);
    let mut u_start = at_beginning(period);
    let mut whole = part_of(&rates, i, u_start, h);
    for _ in 1..parts {
        u_start = turned_back(u_start, period.omega_e * h);
        let later = part_of(&rates, whole.i, u_start, h);
        whole = whole.then(&later);
    }
    whole
}

impl<T: Number> Arrival<T> {
    /// This part of a period followed by another.
    #[inline(always)]
    fn then(&self, later: &Self) -> Self {
        let f = &later.by_current;
        let through = |x: [T; 2]| [f[0][0] * x[0] + f[1][0] * x[1], f[0][1] * x[0] + f[1][1] * x[1]];
        let mut by_parameter = later.by_parameter;
        for (own, before) in by_parameter.iter_mut().zip(&self.by_parameter) {
            let carried = through(*before);
            *own = [own[0] + carried[0], own[1] + carried[1]];
        }
        Self { i: later.i, by_current: [through(self.by_current[0]), through(self.by_current[1])], by_parameter }
    }
}

/// The series over one part, with all derivatives.
#[inline(always)]
fn part_of<T: Number>(rates: &Rates<T>, i: [T; 2], u_start: [T; 2], h: T) -> Arrival<T> {
    let omega_e = rates.omega_e;
    let [inv_d, inv_q] = rates.inverse;
    let mut arrival = Arrival { i, by_current: [[T::ONE, T::ZERO], [T::ZERO, T::ONE]], by_parameter: [[T::ZERO; 2]; PARAMETERS] };
    let (mut u, mut term, mut weight) = (u_start, i, T::ONE);
    let mut by_current = arrival.by_current;
    let mut by_parameter = [[T::ZERO; 2]; PARAMETERS];
    for n in 0..ORDER {
        let next = if n == 0 {
            rates.slope(term, u)
        } else {
            let next = rates.times(term);
            [next[0] + u[0] * inv_d, next[1] + u[1] * inv_q]
        };
        // How the equations themselves change with each parameter, at this derivative.
        let by = [
            [-(term[0] * inv_d), -(term[1] * inv_q)],
            [-(next[0] * inv_d), -(omega_e * term[0] * inv_q)],
            [omega_e * term[1] * inv_d, -(next[1] * inv_q)],
            [T::ZERO, if n == 0 { -(omega_e * inv_q) } else { T::ZERO }],
        ];
        weight = weight * h / T::of((n + 1) as f64);
        for (column, by) in by_parameter.iter_mut().zip(&by) {
            let of = rates.times(*column);
            *column = [of[0] + by[0], of[1] + by[1]];
        }
        by_current = [rates.times(by_current[0]), rates.times(by_current[1])];
        for (sum, column) in arrival.by_parameter.iter_mut().zip(&by_parameter) {
            *sum = [sum[0] + weight * column[0], sum[1] + weight * column[1]];
        }
        for (sum, column) in arrival.by_current.iter_mut().zip(&by_current) {
            *sum = [sum[0] + weight * column[0], sum[1] + weight * column[1]];
        }
        arrival.i = [arrival.i[0] + weight * next[0], arrival.i[1] + weight * next[1]];
        u = [omega_e * u[1], -(omega_e * u[0])];
        term = next;
    }
    arrival
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: [f64; 4] = [0.958, 5.25e-3, 12e-3, 0.1827];

    /// The classical Runge-Kutta method in many small steps, another method than the series.
    fn stepped(theta: &[f64; 4], i: [f64; 2], period: &Period<f64>) -> [f64; 2] {
        let [rs, ld, lq, psi_f] = *theta;
        let steps = 2000;
        let h = period.length / steps as f64;
        let slope = |t: f64, i: [f64; 2]| {
            let angle = period.omega_e * (0.5 * period.length - t);
            let (sin, cos) = libm::sincos(angle);
            let u = [cos * period.u[0] - sin * period.u[1], sin * period.u[0] + cos * period.u[1]];
            [(u[0] - rs * i[0] + period.omega_e * lq * i[1]) / ld, (u[1] - rs * i[1] - period.omega_e * (ld * i[0] + psi_f)) / lq]
        };
        let along = |i: [f64; 2], by: f64, k: [f64; 2]| [i[0] + by * k[0], i[1] + by * k[1]];
        (0..steps).fold(i, |i, step| {
            let t = step as f64 * h;
            let k1 = slope(t, i);
            let k2 = slope(t + 0.5 * h, along(i, 0.5 * h, k1));
            let k3 = slope(t + 0.5 * h, along(i, 0.5 * h, k2));
            let k4 = slope(t + h, along(i, h, k3));
            [0, 1].map(|c| i[c] + h / 6.0 * (k1[c] + 2.0 * (k2[c] + k3[c]) + k4[c]))
        })
    }

    #[test]
    fn the_current_is_that_of_an_integration_in_small_steps() {
        for (omega_e, length) in [(0.0, 1e-4), (419.0, 1e-4), (-3000.0, 1e-4), (2000.0, 2e-3)] {
            let period = Period { u: [-45.0, 77.0], omega_e, length };
            let expected = stepped(&PAPER, [-2.0, 9.0], &period);
            let found = current_after(&PAPER, [-2.0, 9.0], &period);
            let change = (expected[0] + 2.0).abs() + (expected[1] - 9.0).abs();
            assert!((0..2).all(|c| (found[c] - expected[c]).abs() < 2e-6 * change), "{omega_e}: {found:?} {expected:?}");
        }
    }

    #[test]
    fn the_sensitivities_are_differences_of_currents() {
        for (omega_e, length) in [(419.0, 1e-4), (2000.0, 1e-3)] {
            let period = Period { u: [-45.0, 77.0], omega_e, length };
            let i = [-2.0, 9.0];
            let found = arrival(&PAPER, i, &period);
            assert_eq!(found.i, current_after(&PAPER, i, &period));
            for j in 0..4 {
                let moved = |by: f64| {
                    let mut theta = PAPER;
                    theta[j] *= 1.0 + by;
                    stepped(&theta, i, &period)
                };
                let (up, down) = (moved(1e-4), moved(-1e-4));
                for c in 0..2 {
                    let expected = (up[c] - down[c]) / (2e-4 * PAPER[j]);
                    let scale = (up[0] - down[0]).abs().max((up[1] - down[1]).abs()) / (2e-4 * PAPER[j]);
                    assert!((found.by_parameter[j][c] - expected).abs() < 1e-4 * scale, "{j} {c}: {found:?} {expected}");
                }
            }
            for c in 0..2 {
                let moved = |by: f64| {
                    let mut i = i;
                    i[c] += by;
                    stepped(&PAPER, i, &period)
                };
                let (up, down) = (moved(0.5), moved(-0.5));
                for r in 0..2 {
                    assert!((found.by_current[c][r] - (up[r] - down[r])).abs() < 1e-5, "{c} {r}");
                }
            }
        }
    }
}

//! Excitation: which combinations of the parameters a log can tell, noise considered, and how far the others could reach.
//!
//! The parameters are measured in fractions of what the voltage allows (`R_s` in `U/I`, `L` in `U/(omega I)`, `psi_f` in
//! `U/omega`), so that each lies between 0 and 1 and the equations' coefficients, in fractions of `U`, compare. The right
//! singular vectors of these coefficients are directions in parameter space, each with the voltage that it moves. A direction
//! counts as excited only if that voltage stands well above what the *noise of currents and speed* makes of the coefficients: at
//! `i_d = 0` the column of `L_d` is nothing but noise, whatever its condition number says.
//!
//! A direction that is not excited is left at zero, and the physical range 0 to 1 of every parameter bounds what this can do to
//! each of them.

use super::super::request::Known;
use crate::{
    frames::Dq,
    least_squares::Equation,
    motor::{Motor, PARAMETERS, Parameter},
    singular_values::SingularValueDecomposition,
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, Matrix4, Vector4};

/// An excited direction's voltage is at least this many standard deviations of its noise.
const MIN_SIGNAL_TO_NOISE: f64 = 5.0;

/// Currents and speed are known no better than this fraction of their largest value, however quiet they are.
const COEFFICIENT_ACCURACY: f64 = 1e-4;

/// Voltages, currents and speeds below this, SI, are none: a window of a standing or idle drive must not make a scale overflow.
pub(super) const NOTHING: f64 = 1e-30;

/// A parameter is open if this part of its axis, or more, lies in unexcited directions. Noise mixes directions by far less.
const OPEN_PART: f64 = 0.1;

/// What the operating points excite.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Excitation {
    /// Units of the parameters in which each lies between 0 and 1.
    pub scale: [f64; PARAMETERS],
    /// Every direction, strongest first; fixed parameters have no part in any.
    pub directions: Vec<Direction>,
    /// How far the directions that are not excited could move each parameter: SI units, half a range.
    pub unexcited_reach: [f64; PARAMETERS],
}

/// One direction in parameter space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Direction {
    /// Its components, unit length, in units of [`Excitation::scale`].
    pub components: [f64; PARAMETERS],
    /// Voltage that it moves over the noise of that voltage.
    pub signal_to_noise: f64,
    /// Whether that is enough.
    pub excited: bool,
}

impl Excitation {
    /// Judges the operating points, with what is known beforehand.
    pub fn of(points: &[OperatingPoint], known: &[Known; PARAMETERS]) -> Self {
        let most = |value: fn(&OperatingPoint) -> f64| points.iter().map(value).fold(NOTHING, f64::max);
        let (i, omega) = (most(|p| p.current().magnitude()), most(|p| p.omega_e().abs()));
        let applied = most(|p| p.voltage().magnitude());
        let u = if applied > NOTHING { applied } else { voltage_of_fixed(points, known) };
        // A standing drive's inductances show in the drift of its currents alone.
        let slope = (omega * i).max(most(|p| p.drift.magnitude()));
        let scale = [u / i, u / slope, u / slope, u / omega];
        let free: Vec<usize> = (0..PARAMETERS).filter(|p| !matches!(known[*p], Known::Fixed(_))).collect();

        let mut rows: Vec<[f64; PARAMETERS]> =
            points.iter().flat_map(OperatingPoint::equations).map(|equation| equation.coefficients).collect();
        rows.iter_mut().flatten().zip(scale.iter().cycle()).for_each(|(entry, scale)| *entry *= scale / u);
        // A prior pins its parameter as if a voltage of its full range depended on it alone.
        rows.extend(
            (0..PARAMETERS)
                .filter(|p| matches!(known[*p], Known::Prior { .. }))
                .map(|p| std::array::from_fn(|q| f64::from(u8::from(p == q)))),
        );

        let matrix = DMatrix::from_fn(rows.len(), free.len(), |row, column| rows[row][free[column]]);
        let SingularValueDecomposition { values, right, .. } = SingularValueDecomposition::of(matrix);
        let directions = values.into_iter().zip(right.column_iter()).map(|(singular, v)| {
            let mut components = [0.0; PARAMETERS];
            free.iter().zip(&v).for_each(|(p, component)| components[*p] = *component);
            let signal_to_noise = singular / coefficient_noise(points, &components, &scale, u);
            Direction { components, signal_to_noise, excited: signal_to_noise >= MIN_SIGNAL_TO_NOISE }
        });
        let directions: Vec<Direction> = directions.collect();
        let unexcited_reach = reach(&directions, &scale);
        Self { scale, directions, unexcited_reach }
    }

    /// The excited directions.
    pub fn excited(&self) -> impl Iterator<Item = &Direction> {
        self.directions.iter().filter(|direction| direction.excited)
    }

    /// An equation without its part along directions that are not excited.
    pub fn excited_equation(&self, equation: Equation) -> Equation {
        let scaled: [f64; PARAMETERS] = std::array::from_fn(|p| equation.coefficients[p] * self.scale[p]);
        let excited = self.excited_part(scaled);
        Equation { coefficients: std::array::from_fn(|p| excited[p] / self.scale[p]), ..equation }
    }

    /// A motor without its part along directions that are not excited. Fixed parameters have no part in any direction: they are zero.
    pub fn excited_motor(&self, motor: &Motor) -> Motor {
        let values = motor.to_array();
        let excited = self.excited_part(std::array::from_fn(|p| values[p] / self.scale[p]));
        Motor::from(std::array::from_fn(|p| excited[p] * self.scale[p]))
    }

    /// Covariance, V², of two equations' residuals that the unexcited directions could make: each uniform over a parameter's
    /// whole range to either side.
    pub fn unexcited_covariance(&self, equations: &[Equation; 2]) -> [[f64; 2]; 2] {
        let mut covariance = [[0.0; 2]; 2];
        for direction in self.directions.iter().filter(|direction| !direction.excited) {
            let largest = direction.components.iter().fold(0.0_f64, |most, component| most.max(component.abs()));
            let moved = equations.map(|equation| {
                (0..PARAMETERS).map(|p| equation.coefficients[p] * self.scale[p] * direction.components[p]).sum::<f64>() / largest
            });
            for (row, one) in covariance.iter_mut().zip(moved) {
                row.iter_mut().zip(moved).for_each(|(entry, other)| *entry += one * other / 3.0);
            }
        }
        covariance
    }

    /// Covariance of the parameters, SI, along the unexcited directions: each uniform over a parameter's whole range to either side.
    pub(crate) fn unexcited_parameters(&self) -> Matrix4<f64> {
        let of_direction = |direction: &Direction| {
            let largest = direction.components.iter().fold(0.0_f64, |most, component| most.max(component.abs()));
            let moved = Vector4::from_fn(|p, _| direction.components[p] * self.scale[p] / largest);
            moved * moved.transpose() / 3.0
        };
        self.directions.iter().filter(|direction| !direction.excited).map(of_direction).sum()
    }

    /// The inductances, H, for corrections that need only a rough one. What the log does not excite is taken from the other axis.
    pub(crate) fn inductances(&self, motor: &Motor) -> Dq {
        let known =
            |parameter| Some(motor.get(parameter)).filter(|value| *value > 0.0 && self.unexcited_reach[parameter as usize] < *value);
        let (ld, lq) = (known(Parameter::Ld), known(Parameter::Lq));
        Dq { d: ld.or(lq).unwrap_or(f64::INFINITY), q: lq.or(ld).unwrap_or(f64::INFINITY) }
    }

    fn excited_part(&self, vector: [f64; PARAMETERS]) -> [f64; PARAMETERS] {
        let mut part = [0.0; PARAMETERS];
        for direction in self.excited() {
            let along: f64 = direction.components.iter().zip(vector).map(|(component, value)| component * value).sum();
            part.iter_mut().zip(direction.components).for_each(|(part, component)| *part += along * component);
        }
        part
    }

    /// Whether a parameter is one of those that the log leaves open: a good part of it lies in directions that are not excited.
    pub fn is_open(&self, parameter: Parameter) -> bool {
        let part = self
            .directions
            .iter()
            .filter(|direction| !direction.excited)
            .map(|direction| direction.components[parameter as usize].powi(2))
            .sum::<f64>()
            .sqrt();
        part > OPEN_PART
    }
}

/// The largest voltage, V, that the fixed parameters take: in a short circuit it is the scale of all others.
fn voltage_of_fixed(points: &[OperatingPoint], known: &[Known; PARAMETERS]) -> f64 {
    let fixed = known.map(|known| if let Known::Fixed(value) = known { value } else { 0.0 });
    let taken = |equation: Equation| equation.coefficients.iter().zip(fixed).map(|(coefficient, value)| coefficient * value).sum::<f64>();
    points.iter().flat_map(OperatingPoint::equations).map(|equation| taken(equation).abs()).fold(NOTHING, f64::max)
}

/// Standard deviation of the voltage, in fractions of `u`, that noise in the coefficients makes along a direction.
fn coefficient_noise(points: &[OperatingPoint], components: &[f64; PARAMETERS], scale: &[f64; PARAMETERS], u: f64) -> f64 {
    let direction: [f64; PARAMETERS] = std::array::from_fn(|p| components[p] * scale[p] / u);
    let measured: f64 = points.iter().flat_map(|point| point.coefficient_variance(&direction)).sum();
    let floor = 2.0 * points.len() as f64 * COEFFICIENT_ACCURACY.powi(2);
    (measured + floor).sqrt()
}

/// Bounds on each parameter's part in the unexcited directions, given that every parameter lies within one unit of where it was left.
fn reach(directions: &[Direction], scale: &[f64; PARAMETERS]) -> [f64; PARAMETERS] {
    let unexcited: Vec<Vector4<f64>> =
        directions.iter().filter(|direction| !direction.excited).map(|direction| Vector4::from(direction.components)).collect();
    let part: [f64; PARAMETERS] = match unexcited.as_slice() {
        [] => [0.0; PARAMETERS],
        // Along a line the parameter that reaches its limit first stops all of them.
        [line] => std::array::from_fn(|p| line[p].abs() / line.amax()),
        // In a plane or more: a vector in it is no longer than the unit cube's diagonal, and a parameter sees the projection of its axis.
        several => {
            let projection: Matrix4<f64> = several.iter().map(|v| v * v.transpose()).sum();
            std::array::from_fn(|p| (projection.column(p).norm() * (PARAMETERS as f64).sqrt()).min(1.0))
        }
    };
    std::array::from_fn(|p| part[p] * scale[p])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{Columns, Log};

    const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

    /// Noise-free points of 40 rows at (i_d, i_q, omega_e).
    fn points(modes: &[(f64, f64, f64)]) -> Vec<OperatingPoint> {
        let mut columns = Columns::default();
        for (k, &(d, q, omega_e)) in modes.iter().flat_map(|mode| [mode; 40]).enumerate() {
            let u = MOTOR.steady_voltage(Dq { d, q }, omega_e);
            columns.t.push(k as f64);
            let row = [(&mut columns.ud, u.d), (&mut columns.uq, u.q), (&mut columns.id, d), (&mut columns.iq, q)];
            row.into_iter().for_each(|(column, value)| column.push(value));
            columns.omega_e.push(omega_e);
        }
        let log = Log::new(columns).unwrap();
        (0..modes.len()).map(|w| OperatingPoint::measure(&log, 40 * w..40 * (w + 1), None)).collect()
    }

    fn open(modes: &[(f64, f64, f64)], known: &[Known; PARAMETERS]) -> Vec<Parameter> {
        let excitation = Excitation::of(&points(modes), known);
        Parameter::ALL.into_iter().filter(|parameter| excitation.is_open(*parameter)).collect()
    }

    const NOTHING_KNOWN: [Known; PARAMETERS] = [Known::Nothing; PARAMETERS];

    /// By hand: which columns of the equations depend on each other.
    #[test]
    fn what_is_open_follows_from_the_equations() {
        use Parameter::{Ld, PsiF, Rs};
        // i_d = 0, two speeds: u_d gives L_q, u_q gives R_s and psi_f; L_d is absent.
        assert_eq!(open(&[(0.0, 9.0, 400.0), (0.0, 9.0, 200.0)], &NOTHING_KNOWN), [Ld]);
        // One point at i_d = 0: u_q = R_s i_q + omega psi_f is one equation for two.
        assert_eq!(open(&[(0.0, 9.0, 400.0)], &NOTHING_KNOWN), [Rs, Ld, PsiF]);
        // Constant i_d, two i_q: u_d gives R_s and L_q; of u_q only L_d i_d + psi_f is left.
        assert_eq!(open(&[(-2.0, 9.0, 400.0), (-2.0, 3.0, 400.0)], &NOTHING_KNOWN), [Ld, PsiF]);
        // The paper's two modes, four equations for four.
        assert_eq!(open(&[(0.0, 9.0, 400.0), (-2.0, 8.5, 400.0)], &NOTHING_KNOWN), []);
    }

    #[test]
    fn what_is_known_closes_what_it_hides() {
        let rs = [Known::Fixed(0.958), Known::Nothing, Known::Nothing, Known::Nothing];
        assert_eq!(open(&[(0.0, 9.0, 400.0)], &rs), [Parameter::Ld]);
        let ld = [Known::Nothing, Known::Prior { value: 5e-3, standard_error: 1e-4 }, Known::Nothing, Known::Nothing];
        assert_eq!(open(&[(-2.0, 9.0, 400.0), (-2.0, 3.0, 400.0)], &ld), []);
    }

    /// At i_d = 0 nothing but the voltage bounds L_d; at constant i_d every pair with the same L_d i_d + psi_f fits, and the
    /// reach covers the true one.
    #[test]
    fn the_reach_bounds_what_stays_open_and_nothing_else() {
        let modes = [(0.0, 9.0, 400.0), (0.0, 9.0, 200.0)];
        let (points_zero, excitation) = (points(&modes), Excitation::of(&points(&modes), &NOTHING_KNOWN));
        let most = points_zero[0].voltage().magnitude() / (400.0 * 9.0);
        let [rs, ld, lq, psi_f] = excitation.unexcited_reach;
        assert!((ld / most - 1.0).abs() < 1e-9, "{ld} {most}");
        assert!([rs / excitation.scale[0], lq / excitation.scale[2], psi_f / excitation.scale[3]].iter().all(|reach| reach.abs() < 1e-9));

        let excitation = Excitation::of(&points(&[(-2.0, 9.0, 400.0), (-2.0, 3.0, 400.0)]), &NOTHING_KNOWN);
        let found = excitation.excited_motor(&MOTOR).to_array();
        for (p, reach) in excitation.unexcited_reach.into_iter().enumerate() {
            assert!((found[p] - MOTOR.to_array()[p]).abs() <= reach + 1e-9 * found[p].abs(), "{p}: {found:?} {reach}");
        }
    }

    #[test]
    fn a_standing_drive_tells_its_resistance_alone() {
        // Row two only makes the log one.
        let standing = &points(&[(3.0, 4.0, 0.0), (0.0, 9.0, 400.0)])[..1];
        let excitation = Excitation::of(standing, &NOTHING_KNOWN);
        let open: Vec<_> = Parameter::ALL.into_iter().filter(|parameter| excitation.is_open(*parameter)).collect();
        assert_eq!(open, [Parameter::Ld, Parameter::Lq, Parameter::PsiF]);
        assert!(excitation.unexcited_reach.iter().all(|reach| reach.is_finite()));
    }
}

//! Excitation: which combinations of the parameters a log can tell, noise considered, and how far the others could reach.
//!
//! The parameters are measured in fractions of what the voltage allows (`R_s` in `U/I`, `L` in `U/(omega I)`, `psi_f` in `U/omega`), so that each lies between 0 and 1 and the equations'
//! coefficients, in fractions of `U`, compare. The right singular vectors of these coefficients are directions in parameter space, each with the voltage that it moves. A direction counts as excited only
//! if that voltage stands well above what the *noise of currents and speed* makes of the coefficients: at `i_d = 0` the column of `L_d` is nothing but noise, whatever its condition number says.
//!
//! A direction that is not excited is left at zero, and the physical range 0 to 1 of every parameter bounds what this can do to each of them.

use super::Known;
use crate::{
    least_squares::Equation,
    motor::{Motor, PARAMETERS, Parameter},
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, Matrix4, Vector4};

/// An excited direction's voltage is at least this many standard deviations of its noise.
const MIN_SIGNAL_TO_NOISE: f64 = 5.0;

/// Currents and speed are known no better than this fraction of their largest value, however quiet they are.
const COEFFICIENT_ACCURACY: f64 = 1e-4;

/// A parameter is open if this part of its axis, or more, lies in unexcited directions. Noise mixes directions by far less.
const OPEN_PART: f64 = 0.1;

/// What the operating points excite.
#[derive(Debug, Clone, PartialEq)]
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
        let most = |value: fn(&OperatingPoint) -> f64| points.iter().map(value).fold(f64::MIN_POSITIVE, f64::max);
        let (u, i, omega) = (most(|p| p.voltage().magnitude()), most(|p| p.current().magnitude()), most(|p| p.omega_e().abs()));
        let scale = [u / i, u / (omega * i), u / (omega * i), u / omega];
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
        // At least as many rows as columns, so that directions without any voltage appear as well.
        rows.resize(rows.len().max(PARAMETERS), [0.0; PARAMETERS]);

        let svd = DMatrix::from_fn(rows.len(), free.len(), |row, column| rows[row][free[column]]).svd(false, true);
        let mut directions = Vec::new();
        for (singular, v) in svd.singular_values.iter().zip(svd.v_t.iter().flat_map(|v_t| v_t.row_iter())) {
            let mut components = [0.0; PARAMETERS];
            free.iter().zip(v.iter()).for_each(|(p, component)| components[*p] = *component);
            let noise = coefficient_noise(points, &components, &scale, u);
            let signal_to_noise = singular / noise;
            directions.push(Direction { components, signal_to_noise, excited: signal_to_noise >= MIN_SIGNAL_TO_NOISE });
        }
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

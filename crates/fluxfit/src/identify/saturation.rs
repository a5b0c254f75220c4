//! Saturation: flux that does not grow in proportion to the current, so that there are no constant inductances to be found.
//!
//! At a steady operating point the voltage tells the flux, whatever it depends on:
//!
//! ```text
//! psi_d = (u_q - R_s i_q) / omega_e - L_q drift_q / omega_e
//! psi_q = (R_s i_d - u_d) / omega_e + L_d drift_d / omega_e
//! ```
//!
//! Its *apparent* inductances are `psi_q / i_q` and `(psi_d - psi_f) / i_d`; the incremental ones, `d psi / d i`, are other
//! numbers, and points that lie far apart do not tell them.
//!
//! That points contradict each other says [`misfit`](super::misfit); why, the equations themselves: constant parameters are solved
//! again beside terms of saturation, those of the [simulated currents](crate::faults::saturation),
//!
//! ```text
//! psi_d = L_d i_d + psi_f + s_d i_d |i_d| + c i_q²,     psi_q = L_q i_q + s_q i_q |i_q| + 2 c i_d i_q
//! ```
//!
//! and beside what else follows the current, a voltage of constant size along it (dead time, device drops). Saturation it is if its terms
//! explain the contradiction best by Schwarz's criterion, and iron takes flux away.

use super::{Known, Settings, excitation::Excitation, misfit::Misfit, output_fit::OutputFit, verdict::WEAK};
use crate::{
    faults::Fault,
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    singular_values::Decomposition,
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, DVector};

/// Saturation, and what the flux is instead of an inductance times the current.
#[derive(Debug, Clone, PartialEq)]
pub struct Saturation {
    /// Resistance that the fluxes were computed with, ohm.
    pub rs: f64,
    /// Its standard uncertainty, ohm; zero where it was given.
    pub rs_uncertainty: f64,
    /// Flux per operating point, in their order; none at a point that stands still.
    pub fluxes: Vec<Option<Flux>>,
    /// The apparent L_q at the smallest and the largest i_q that tell one.
    pub lq: Option<[Apparent; 2]>,
    /// The constants beside the terms of saturation: the motor at small currents.
    pub small_currents: Motor,
    /// How far the simulated currents' terms of saturation move each parameter over the rows' currents, SI; zero where they have none.
    over_rows: [f64; PARAMETERS],
}

/// The flux at an operating point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flux {
    /// Current, A.
    pub current: Dq,
    /// Flux linkage, Wb.
    pub psi: Dq,
    /// Its standard uncertainty, Wb: noise of the means, accuracy of the voltages, resistance.
    pub uncertainty: Dq,
    /// Whether the point itself tells both fluxes, R_s left aside: to half of their size, beyond which a parameter would be no answer.
    pub is_told: bool,
    /// `psi_q / i_q`, H; none where i_q is too small for it, or the flux not known to a half of it.
    pub apparent_lq: Option<f64>,
    /// `(psi_d - psi_f) / i_d`, H; none where i_d is too small for it, or psi_f is not known beforehand.
    pub apparent_ld: Option<f64>,
}

/// An apparent inductance, H, and the current, A, at which it is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apparent {
    /// Along its own axis.
    pub current: f64,
    /// `psi / i`.
    pub inductance: f64,
}

/// Currents below this fraction of the largest divide no flux: the quotient would be their own error.
const LEAST_CURRENT: f64 = 0.05;

/// Up to this fraction of the largest current a point's flux says something of the magnet.
const LIGHT: f64 = 0.5;

/// Operating points whose currents differ by less than this fraction of the largest say the same of saturation.
const DISTINCT: f64 = 0.02;

/// Least number of distinct currents: two make a straight line.
const LEAST_CURRENTS: usize = 3;

/// The normal distribution's two-sided 95 % quantile, rounded down: an interval of that many standard deviations or more covers a spread.
const QUANTILE: f64 = 1.95;

impl Saturation {
    /// Looks for it among operating points that contradict each other.
    pub(super) fn of_points(
        points: &[OperatingPoint],
        excitation: &Excitation,
        motor: &Motor,
        misfit: Option<&Misfit>,
        settings: &Settings,
    ) -> Option<Self> {
        misfit?;
        if distinct_currents(points) < LEAST_CURRENTS {
            return None;
        }
        let scene = Scene { points, excitation, motor, settings, peak: peak(points) };
        let loss = Some(scene.solve(&[Cause::Loss])).filter(|solved| solved.loses_less_than(LARGEST_LOSS * least_voltage(points)));
        let rival = scene.solve(&[]).criterion.min(loss.map_or(f64::INFINITY, |solved| solved.criterion));
        let best = SATURATIONS
            .iter()
            .map(|causes| scene.solve(causes))
            .filter(|solved| solved.takes_flux_away())
            .min_by(|one, other| one.criterion.total_cmp(&other.criterion))?;
        (best.criterion < rival).then(|| Self::at(points, best.motor, (best.motor.rs.max(0.0), best.rs_uncertainty), settings))
    }

    /// What the simulated currents say of it; `of_points` is what the operating points say.
    pub(super) fn of_currents(
        fit: &OutputFit,
        log: &Log,
        (points, of_points): (&[OperatingPoint], Option<&Self>),
        settings: &Settings,
    ) -> Option<Self> {
        if !fit.has(Fault::Saturation) {
            return of_points.cloned();
        }
        let (motor, terms) = (fit.drive.motor, fit.drive.faults.saturation);
        let rs_uncertainty = fit.uncertainty.parameters[Parameter::Rs as usize].standard_error();
        let mut found = of_points.cloned().unwrap_or_else(|| Self::at(points, motor, (motor.rs, rs_uncertainty), settings));
        let (mut least, mut most) = (Apparent { current: f64::INFINITY, inductance: 0.0 }, Apparent { current: 0.0, inductance: 0.0 });
        for row in fit.stretches.iter().cloned().flatten() {
            let i = Dq { d: log.columns().id[row], q: log.columns().iq[row] };
            let lost = terms.apparent_change(i);
            found.over_rows.iter_mut().zip(lost).for_each(|(most, lost)| *most = most.max(lost.abs()));
            let apparent = Apparent { current: i.q, inductance: motor.lq + lost[Parameter::Lq as usize] };
            if i.q.abs() < least.current.abs() {
                least = apparent;
            }
            if i.q.abs() > most.current.abs() {
                most = apparent;
            }
        }
        found.lq = found.lq.filter(|[least, most]| least.current != most.current).or(Some([least, most]));
        Some(found)
    }

    /// The fluxes at the operating points.
    fn at(points: &[OperatingPoint], small_currents: Motor, (rs, rs_uncertainty): (f64, f64), settings: &Settings) -> Self {
        let psi_f = match settings.known[Parameter::PsiF as usize] {
            Known::Fixed(value) | Known::Prior { value, .. } => Some(value),
            Known::Nothing => None,
        };
        let least = LEAST_CURRENT * peak(points);
        let flux = |point: &OperatingPoint| {
            let (omega_e, u, i) = (point.omega_e(), point.voltage(), point.current());
            let noise = point.residual_covariance(&small_currents);
            let accuracy = settings.voltage_accuracy * u.magnitude();
            let own = [0, 1].map(|axis: usize| noise[axis][axis].max(0.0).sqrt().hypot(accuracy) / omega_e.abs());
            let of_rs = |i: f64| rs_uncertainty * i / omega_e;
            let psi = Dq {
                d: (u.q - rs * i.q - small_currents.lq * point.drift.q) / omega_e,
                q: (rs * i.d + small_currents.ld * point.drift.d - u.d) / omega_e,
            };
            let own = Dq { d: own[1], q: own[0] };
            let flux = Flux {
                current: i,
                psi,
                uncertainty: Dq { d: own.d.hypot(of_rs(i.q)), q: own.q.hypot(of_rs(i.d)) },
                is_told: 2.0 * own.d <= WEAK * psi.d.abs() && 2.0 * own.q <= WEAK * psi.q.abs(),
                apparent_lq: (i.q.abs() > least && 2.0 * own.q <= WEAK * psi.q.abs()).then_some(psi.q / i.q),
                apparent_ld: psi_f.filter(|_| i.d.abs() > least).map(|psi_f| (psi.d - psi_f) / i.d),
            };
            [psi.d, psi.q, flux.uncertainty.d, flux.uncertainty.q].iter().all(|value| value.is_finite()).then_some(flux)
        };
        let fluxes: Vec<Option<Flux>> = points.iter().map(flux).collect();
        let told = || fluxes.iter().flatten().filter_map(|flux| Some(Apparent { current: flux.current.q, inductance: flux.apparent_lq? }));
        let by_current = |one: &Apparent, other: &Apparent| one.current.abs().total_cmp(&other.current.abs());
        let lq = told().min_by(by_current).zip(told().max_by(by_current)).map(|(least, most)| [least, most]);
        Self { rs, rs_uncertainty, fluxes, lq, small_currents, over_rows: [0.0; PARAMETERS] }
    }

    /// Standard uncertainty of an answer with constant parameters: so large that its 95 % intervals hold what every operating point, or
    /// row, would call the parameter.
    pub(super) fn uncertainty(&self, answer: &Motor) -> [f64; PARAMETERS] {
        let (told, small) = (answer.to_array(), self.small_currents.to_array());
        let mut spread: [f64; PARAMETERS] = std::array::from_fn(|p| self.over_rows[p].max((told[p] - small[p]).abs()));
        let mut hold = |parameter: Parameter, distance: f64, uncertainty: f64| {
            let spread = &mut spread[parameter as usize];
            *spread = spread.max(distance.abs() + 2.0 * uncertainty.abs());
        };
        hold(Parameter::Rs, answer.rs - self.rs, self.rs_uncertainty);
        let peak = self.fluxes.iter().flatten().map(|flux| flux.current.magnitude()).fold(0.0, f64::max);
        let least = LEAST_CURRENT * peak;
        for Flux { current: i, psi, uncertainty, apparent_lq, .. } in self.fluxes.iter().flatten().filter(|flux| flux.is_told) {
            if let Some(lq) = apparent_lq {
                hold(Parameter::Lq, lq - answer.lq, uncertainty.q / i.q);
            }
            if i.d.abs() > least {
                hold(Parameter::Ld, (psi.d - answer.psi_f) / i.d - answer.ld, uncertainty.d / i.d);
            }
            // The magnet's flux is what is left without current; what load takes from it by cross saturation is no other magnet.
            if i.magnitude() <= LIGHT * peak {
                hold(Parameter::PsiF, psi.d - answer.ld * i.d - answer.psi_f, uncertainty.d);
            }
        }
        spread.map(|spread| spread / QUANTILE)
    }
}

/// The largest current, A.
fn peak(points: &[OperatingPoint]) -> f64 {
    points.iter().map(|point| point.current().magnitude()).fold(f64::MIN_POSITIVE, f64::max)
}

/// Most that dead time and devices take of any point's voltage: what takes more is no loss but a formula that bends to the data.
const LARGEST_LOSS: f64 = 0.5;

/// The smallest voltage, V.
fn least_voltage(points: &[OperatingPoint]) -> f64 {
    points.iter().map(|point| point.voltage().magnitude()).fold(f64::INFINITY, f64::min)
}

/// How many operating points differ in their current.
fn distinct_currents(points: &[OperatingPoint]) -> usize {
    let apart = DISTINCT * peak(points);
    let mut distinct: Vec<Dq> = Vec::new();
    for i in points.iter().map(OperatingPoint::current) {
        if distinct.iter().all(|other| (i.d - other.d).hypot(i.q - other.q) > apart) {
            distinct.push(i);
        }
    }
    distinct.len()
}

/// What lets equations follow the current.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    /// `s_q`.
    Q,
    /// `s_d`.
    D,
    /// `c`.
    Cross,
    /// A voltage of constant size along the current.
    Loss,
}

/// Saturation, from the simplest kind on.
const SATURATIONS: [&[Cause]; 4] = [&[Cause::Q], &[Cause::Cross], &[Cause::Q, Cause::Cross], &[Cause::Q, Cause::Cross, Cause::D]];

impl Cause {
    /// What one unit of it does to both voltages, V; of saturation, a henry at the current `peak`.
    fn voltage(self, point: &OperatingPoint, peak: f64) -> [f64; 2] {
        let (i, omega_e) = (point.current(), point.omega_e());
        match self {
            Self::Q => [-omega_e * i.q * i.q.abs() / peak, 0.0],
            Self::D => [0.0, omega_e * i.d * i.d.abs() / peak],
            Self::Cross => [-omega_e * 2.0 * i.d * i.q / peak, omega_e * i.q * i.q / peak],
            Self::Loss => {
                let magnitude = i.magnitude().max(f64::MIN_POSITIVE);
                [i.d / magnitude, i.q / magnitude]
            }
        }
    }
}

/// The equations, to be solved with one cause or another.
struct Scene<'a> {
    points: &'a [OperatingPoint],
    excitation: &'a Excitation,
    /// The motor that tells what noise does to the equations.
    motor: &'a Motor,
    settings: &'a Settings,
    peak: f64,
}

/// Constants beside causes.
#[derive(Debug)]
struct Solved {
    motor: Motor,
    rs_uncertainty: f64,
    causes: Vec<(Cause, f64)>,
    /// Schwarz's, lowest is best.
    criterion: f64,
}

impl Solved {
    /// Whether the voltage lost along the current is less than so many volts.
    fn loses_less_than(&self, limit: f64) -> bool {
        self.causes.iter().all(|(_, value)| value.abs() < limit)
    }

    /// Whether it is what iron does: flux along q is lost; or the magnet's, where it is that alone.
    fn takes_flux_away(&self) -> bool {
        let of = |cause: Cause| self.causes.iter().find(|(other, _)| *other == cause).map(|(_, value)| *value);
        match (of(Cause::Q), of(Cause::Cross)) {
            (Some(q), _) => q < 0.0 && self.motor.lq > 0.0,
            (None, Some(cross)) => cross * self.motor.psi_f < 0.0,
            (None, None) => false,
        }
    }
}

/// Part of the largest singular value below which a combination of unknowns is none.
const RANK_TOLERANCE: f64 = 1e-9;

impl Scene<'_> {
    fn solve(&self, causes: &[Cause]) -> Solved {
        let Self { points, excitation, motor: noisy, settings, peak } = self;
        let directions: Vec<[f64; PARAMETERS]> =
            excitation.excited().map(|direction| std::array::from_fn(|p| direction.components[p] * excitation.scale[p])).collect();
        let fixed: [f64; PARAMETERS] = settings.known.map(|known| if let Known::Fixed(value) = known { value } else { 0.0 });
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for point in *points {
            let equations = point.equations();
            let noise = point.residual_covariance(noisy);
            let open = excitation.unexcited_covariance(&equations);
            let accuracy = settings.voltage_accuracy * point.voltage().magnitude();
            for (axis, equation) in equations.iter().enumerate() {
                let variance = noise[axis][axis].max(0.0) + open[axis][axis] + accuracy.powi(2);
                let weight = 1.0 / variance.sqrt().max(LEAST_ACCURACY * point.voltage().magnitude()).max(f64::MIN_POSITIVE);
                let known =
                    directions.iter().map(|direction| (0..PARAMETERS).map(|p| equation.coefficients[p] * direction[p]).sum::<f64>());
                let beside = causes.iter().map(|cause| cause.voltage(point, *peak)[axis]);
                rows.push(known.chain(beside).chain([equation.residual(&fixed)]).map(|entry| weight * entry).collect());
            }
        }
        for (p, known) in settings.known.iter().enumerate() {
            if let Known::Prior { value, standard_error } = known {
                let entries = directions.iter().map(|direction| direction[p]).chain(causes.iter().map(|_| 0.0)).chain([*value]);
                rows.push(entries.map(|entry| entry / standard_error).collect());
            }
        }
        let unknowns = directions.len() + causes.len();
        let mut matrix = DMatrix::from_fn(rows.len(), unknowns, |row, column| rows[row][column]);
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).map(|norm| if norm > 0.0 { norm } else { 1.0 }).collect();
        matrix.column_iter_mut().zip(&lengths).for_each(|(mut column, length)| column.unscale_mut(*length));
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| row[unknowns]));
        let decomposition = Decomposition::of(matrix.clone());
        let inverse = decomposition.pseudo_inverse(RANK_TOLERANCE * decomposition.values.first().copied().unwrap_or(0.0));
        let solution = &inverse * &values;
        let chi_squared = (values - matrix * &solution).norm_squared();
        let count = rows.len() as f64;

        let x: Vec<f64> = solution.iter().zip(&lengths).map(|(value, length)| value / length).collect();
        let of_motor = |p: usize| fixed[p] + directions.iter().zip(&x).map(|(direction, x)| direction[p] * x).sum::<f64>();
        // R_s as a combination of the unknowns, and through the pseudo-inverse of the equations; the scatter of what is left tells how far
        // to trust it.
        let rs = DVector::from_fn(unknowns, |k, _| directions.get(k).map_or(0.0, |direction| direction[0] / lengths[k]));
        let degrees = count - unknowns as f64;
        let motor = Motor::from(std::array::from_fn(of_motor));
        let noise = (inverse.transpose() * rs).norm();
        // A resistance below zero is wrong by at least that much. Where nothing is left over there is no scatter: anything that the voltage
        // allows.
        let range = excitation.scale[Parameter::Rs as usize] / 3.0_f64.sqrt();
        let rs_uncertainty = match settings.known[Parameter::Rs as usize] {
            Known::Fixed(_) => 0.0,
            _ if degrees > 0.0 => (noise * (chi_squared / degrees).max(1.0).sqrt()).hypot(motor.rs.min(0.0)).min(range),
            Known::Prior { standard_error, .. } => standard_error,
            Known::Nothing => range,
        };
        Solved {
            motor,
            rs_uncertainty,
            causes: causes.iter().copied().zip(x[directions.len()..].iter().copied()).collect(),
            // One is what noise alone leaves of each equation.
            criterion: count * (1.0 + chi_squared / count).ln() + unknowns as f64 * count.ln(),
        }
    }
}

/// Voltages are never trusted beyond this fraction, so that noise-free windows have finite weights.
const LEAST_ACCURACY: f64 = 1e-9;

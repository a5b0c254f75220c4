//! The fit: all tables of a motor at once, by weighted least squares.
//!
//! Voltages and currents are compared by their relative error, torques by their absolute one, because a bench's drag and its torque
//! sensor are as large at any speed. How large these errors are is estimated from what is left, and counted for longer where neighbouring
//! rows err alike. What brakes besides the short circuit (bearings, air, iron) is fitted as `c_0 + c_1 |Omega|`; how far the motor moves
//! without it is counted as the doubt of it.

use super::{
    characteristic::Characteristic,
    machine::Machine,
    open_circuit::{Across, OpenCircuitRow, SQRT_3},
    short_circuit::ShortCircuitRow,
};
use crate::{
    error::{Error, ErrorKind},
    identification::{
        fit::{
            long_run::effective_sample_size,
            readings::VERY_STRONG,
            uncertainty::{ParameterUncertainty, Systematic},
        },
        judge::verdict::Verdict,
    },
    motor::{PARAMETERS, Parameter},
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use std::f64::consts::SQRT_2;

/// What tables say of their motor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CharacteristicsAnswer {
    /// In the order of [`Parameter::ALL`].
    pub parameters: [CharacteristicEstimate; PARAMETERS],
    /// Pole pairs, if they are known: then the parameters are the motor's own.
    pub pole_pairs: Option<u32>,
    /// What is left of voltages and currents, as a fraction, and of torques, N m: root mean squares; `None` where there are none.
    pub residual_rms: [Option<f64>; 3],
    /// How open-circuit voltages were taken; `None` without any.
    pub voltages: Option<VoltageReading>,
    /// Where the voltages are [ambiguous](VoltageReading::Ambiguous): what the parameters would be if these are line to line. Of a phase,
    /// all would be `sqrt 3` times as large.
    pub if_line_to_line: [Option<f64>; PARAMETERS],
    /// Relative change of each parameter that has a value where an instrument reads 1 % too much, which no table shows.
    pub unseen: Vec<(Instrument, [f64; PARAMETERS])>,
}

impl CharacteristicsAnswer {
    /// Whether all four parameters are identified, and are the motor's own.
    pub fn is_complete(&self) -> bool {
        self.pole_pairs.is_some() && self.parameters.iter().all(|estimate| estimate.verdict == Verdict::Identified)
    }
}

/// One parameter: of tables without pole pairs, inductances and flux times these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CharacteristicEstimate {
    /// Which.
    pub parameter: Parameter,
    /// SI; `None` where the tables do not tell it.
    pub value: Option<f64>,
    /// Its uncertainty, SI.
    pub uncertainty: ParameterUncertainty,
    /// By the same limits as that of a log.
    pub verdict: Verdict,
}

impl CharacteristicEstimate {
    fn unknown(parameter: Parameter) -> Self {
        Self { parameter, value: None, uncertainty: ParameterUncertainty::default(), verdict: Verdict::NotIdentifiable }
    }

    /// The 95 % interval, SI.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.value.map(|value| [value - self.uncertainty.half_width, value + self.uncertainty.half_width])
    }
}

/// How open-circuit voltages were taken, which `sqrt 3` of the flux depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageReading {
    /// As the tables state.
    Stated,
    /// As the torque of the short circuit tells.
    ByTorque(Across),
    /// Line to line or of a phase, which nothing tells: then no parameter is.
    Ambiguous,
}

/// What measured a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    /// Of voltages.
    Voltage,
    /// Of currents.
    Current,
    /// Of torque.
    Torque,
}

impl Instrument {
    const ALL: [Self; 3] = [Self::Voltage, Self::Current, Self::Torque];
}

/// Identifies a motor from its characteristics.
///
/// # Errors
/// If a table is too short, or the tables together hold neither voltage nor torque.
pub fn identify_characteristics(tables: &[Characteristic], pole_pairs: Option<u32>) -> Result<CharacteristicsAnswer, Error> {
    let (rows, voltages) = Rows::of(tables)?.with_told_voltages()?;
    let fit = Fit::of(&rows, rows.has_torque())?;
    if let Some(missed) = fit.residual_rms[1].filter(|missed| *missed > LARGEST_MISS) {
        return Err(ErrorKind::NoShortCircuit { missed }.into());
    }
    let of_drag = if rows.has_torque() { fit.distance(&Fit::of(&rows, false)?) } else { [0.0; PARAMETERS] };
    let doubt: [f64; PARAMETERS] = std::array::from_fn(|p| of_drag[p].hypot(fit.doubt_of_minima[p]));
    let pairs = f64::from(pole_pairs.unwrap_or(1));
    let mut parameters = Parameter::ALL.map(|parameter| fit.estimate(parameter, doubt[parameter as usize], pairs));
    let mut if_line_to_line = [None; PARAMETERS];
    if voltages == Some(VoltageReading::Ambiguous) {
        if_line_to_line = parameters.map(|estimate| estimate.value);
        parameters = parameters.map(|estimate| CharacteristicEstimate::unknown(estimate.parameter));
    }
    let told = parameters.map(|estimate| estimate.value.is_some());
    let change = |instrument: Instrument| {
        let changes = fit.change_to(&Fit::of(&rows.read_too_large(instrument), rows.has_torque())?);
        Ok((instrument, std::array::from_fn(|p| if told[p] { changes[p] } else { 0.0 })))
    };
    let unseen = Instrument::ALL.into_iter().filter(|instrument| rows.has(*instrument)).map(change).collect::<Result<_, Error>>()?;
    Ok(CharacteristicsAnswer { parameters, pole_pairs, residual_rms: fit.residual_rms, voltages, if_line_to_line, unseen })
}

/// What a short circuit's currents are missed by at most, as a fraction: a motor that saturates by half is missed by less.
const LARGEST_MISS: f64 = 0.2;

/// Fewest rows of a short-circuit characteristic: the motor and the drag have six numbers, and a row gives one or two.
const LEAST_SHORTED: usize = 6;

/// Fewest rows of an open-circuit characteristic whose scatter means anything.
const LEAST_OPEN: usize = 3;

/// The rows of all tables, by kind.
#[derive(Clone)]
struct Rows {
    /// Voltages line to line.
    open: Vec<OpenCircuitRow>,
    shorted: Vec<ShortCircuitRow>,
    /// Whether all tables state between which points their voltages were measured.
    are_voltages_stated: bool,
}

impl Rows {
    fn of(tables: &[Characteristic]) -> Result<Self, Error> {
        let mut rows = Self { open: Vec::new(), shorted: Vec::new(), are_voltages_stated: true };
        for table in tables {
            match table {
                Characteristic::OpenCircuit(table) => {
                    let factor = table.across.unwrap_or(Across::Lines).to_lines();
                    rows.open.extend(table.rows.iter().map(|row| OpenCircuitRow { voltage: factor * row.voltage, ..*row }));
                    rows.are_voltages_stated &= table.across.is_some();
                }
                Characteristic::ShortCircuit(table) => rows.shorted.extend(&table.rows),
            }
        }
        // Neighbours in speed err alike, whatever their order in the file.
        rows.open.sort_by(|one, other| one.speed.abs().total_cmp(&other.speed.abs()));
        rows.shorted.sort_by(|one, other| one.speed.abs().total_cmp(&other.speed.abs()));
        for (count, least) in [(rows.open.len(), LEAST_OPEN), (rows.shorted.len(), LEAST_SHORTED)] {
            if (1..least).contains(&count) {
                return Err(ErrorKind::ShortCharacteristic { rows: count, least }.into());
            }
        }
        if rows.open.is_empty() && !rows.has_torque() {
            return Err(ErrorKind::NoScale.into());
        }
        Ok(rows)
    }

    /// The rows with their voltages as they were measured, by what the tables state or by the torque: the power of the shaft heats the
    /// winding, which gives the resistance whatever the voltages are.
    fn with_told_voltages(self) -> Result<(Self, Option<VoltageReading>), Error> {
        if self.open.is_empty() {
            return Ok((self, None));
        }
        if !self.has_torque() {
            let reading = if self.are_voltages_stated { VoltageReading::Stated } else { VoltageReading::Ambiguous };
            return Ok((self, Some(reading)));
        }
        let criterion = |factor: f64| Ok::<f64, Error>(Fit::of(&self.with_voltages(factor), true)?.criterion);
        let limit = criterion(1.0)? - VERY_STRONG;
        let others = VOLTAGE_MISTAKES.iter().map(|factor| Ok((*factor, criterion(*factor)?))).collect::<Result<Vec<_>, Error>>()?;
        let better = others.iter().filter(|(_, criterion)| *criterion < limit).min_by(|one, other| one.1.total_cmp(&other.1));
        // The first mistake is a phase taken for two lines.
        let phase = others[0];
        match better {
            None if self.are_voltages_stated => Ok((self, Some(VoltageReading::Stated))),
            None if phase.1 > limit + 2.0 * VERY_STRONG => Ok((self, Some(VoltageReading::ByTorque(Across::Lines)))),
            None => Ok((self, Some(VoltageReading::Ambiguous))),
            Some(best) if *best == phase && !self.are_voltages_stated => {
                Ok((self.with_voltages(phase.0), Some(VoltageReading::ByTorque(Across::Phase))))
            }
            Some((factor, _)) => Err(ErrorKind::VoltagesAgainstTorque { factor: *factor }.into()),
        }
    }

    fn with_voltages(&self, factor: f64) -> Self {
        let mut rows = self.clone();
        rows.open.iter_mut().for_each(|row| row.voltage *= factor);
        rows
    }

    fn has_torque(&self) -> bool {
        self.shorted.iter().any(|row| row.torque.is_some())
    }

    fn has(&self, instrument: Instrument) -> bool {
        match instrument {
            Instrument::Voltage => !self.open.is_empty(),
            Instrument::Current => !self.shorted.is_empty(),
            Instrument::Torque => self.has_torque(),
        }
    }

    /// The same as an instrument would have read it that reads 1 % too much.
    fn read_too_large(&self, instrument: Instrument) -> Self {
        const TOO_LARGE: f64 = 1.01;
        let mut rows = self.clone();
        match instrument {
            Instrument::Voltage => rows.open.iter_mut().for_each(|row| row.voltage *= TOO_LARGE),
            Instrument::Current => rows.shorted.iter_mut().for_each(|row| row.current *= TOO_LARGE),
            Instrument::Torque => rows.shorted.iter_mut().for_each(|row| row.torque = row.torque.map(|torque| TOO_LARGE * torque)),
        }
        rows
    }

    fn largest_torque(&self) -> f64 {
        self.shorted.iter().filter_map(|row| row.torque).fold(0.0, |largest, torque| torque.abs().max(largest))
    }

    fn largest_speed(&self) -> f64 {
        self.shorted.iter().fold(0.0, |largest, row| row.speed.abs().max(largest))
    }
}

/// What voltages are too small by where a phase is taken for two lines or the other way round, and rms for an amplitude or the other way
/// round; powers of ten are those of units.
const VOLTAGE_MISTAKES: [f64; 6] = [SQRT_3, 1.0 / SQRT_3, SQRT_2, 1.0 / SQRT_2, 1e3, 1e-3];

/// Errors of voltage, current and torque that a fit starts with: half a percent, and of the largest torque a percent.
const USUAL_ERRORS: [f64; 3] = [0.005, 0.005, 0.01];

/// Errors below this part of a value are rounding.
const LEAST_ERROR: f64 = 1e-7;

/// Ratios of L_q to L_d that fits start from.
const SALIENCIES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Rounds of fits and of errors estimated from what they leave: they settle in five to ten.
const ROUNDS: usize = 15;

/// A fit of the logarithms of the motor's numbers, so that they stay positive, and of the drag.
struct Fit {
    machine: Machine,
    /// Twice the negative logarithm of its likelihood, but for a constant.
    criterion: f64,
    /// How far other minima lie that fit about as well.
    doubt_of_minima: [f64; PARAMETERS],
    /// Whether a number was fitted.
    is_free: [bool; PARAMETERS],
    /// Of the logarithms.
    covariance: DMatrix<f64>,
    degrees_of_freedom: f64,
    residual_rms: [Option<f64>; 3],
}

impl Fit {
    /// The best of the fits from several starts: a motor with less L_q than L_d has about the same currents as one with more.
    fn of(rows: &Rows, with_drag: bool) -> Result<Self, Error> {
        let start = start(rows);
        let starts = SALIENCIES.map(|ratio| Machine { p_lq: ratio * start.p_ld, ..start });
        let mut fits: Vec<Self> = starts.iter().filter_map(|start| Self::from(start, rows, with_drag)).collect();
        fits.sort_by(|one, other| one.criterion.total_cmp(&other.criterion));
        let (Some(best), others) = (fits.first(), fits.get(1..).unwrap_or_default()) else { return Err(ErrorKind::NoFiniteFit.into()) };
        let as_good = others.iter().filter(|other| other.criterion < best.criterion + VERY_STRONG);
        let distances: Vec<[f64; PARAMETERS]> = as_good.map(|other| best.distance(other)).collect();
        let doubt_of_minima = std::array::from_fn(|p| distances.iter().fold(0.0, |most: f64, distance| most.max(distance[p])));
        fits.into_iter().next().map(|best| Self { doubt_of_minima, ..best }).ok_or_else(|| ErrorKind::NoFiniteFit.into())
    }

    /// The fit from one start; `None` if it runs away.
    fn from(start: &Machine, rows: &Rows, with_drag: bool) -> Option<Self> {
        let is_free = if rows.shorted.is_empty() { [false, false, false, true] } else { [true; PARAMETERS] };
        let mut errors = USUAL_ERRORS;
        let mut problem = Problem { rows, is_free, with_drag, errors, unknowns: DVector::zeros(0), start: *start };
        problem.unknowns = DVector::zeros(problem.count());
        for _ in 0..ROUNDS {
            problem.errors = errors;
            (problem, _) = LevenbergMarquardt::new().minimize(problem);
            errors = problem.errors_left();
        }
        // As many as are independent.
        let of_groups = problem.groups();
        let criterion: f64 = of_groups.iter().zip(errors).map(|(group, error)| 2.0 * group.len() as f64 * error.ln()).sum();
        let independent = of_groups.each_ref().map(|group| effective_sample_size(group));
        for ((error, group), independent) in problem.errors.iter_mut().zip(&of_groups).zip(independent) {
            if independent > 0.0 {
                *error *= (group.len() as f64 / independent).sqrt();
            }
        }
        let jacobian = problem.slopes();
        let covariance = (jacobian.transpose() * jacobian).try_inverse();
        let machine = problem.machine();
        let count = problem.count();
        if ![machine.rs, machine.p_ld, machine.p_lq, machine.p_psi_f, criterion].iter().all(|number| number.is_finite()) {
            return None;
        }
        let rms = |group: &Vec<f64>, error: f64| (!group.is_empty()).then_some(error);
        let units = [1.0, 1.0, rows.largest_torque()];
        Some(Self {
            machine,
            criterion,
            doubt_of_minima: [0.0; PARAMETERS],
            is_free,
            covariance: covariance.unwrap_or_else(|| DMatrix::from_element(count, count, f64::INFINITY)),
            degrees_of_freedom: (independent.iter().sum::<f64>() - count as f64).max(1.0),
            residual_rms: std::array::from_fn(|k| rms(&of_groups[k], errors[k] * units[k])),
        })
    }

    fn values(&self) -> [f64; PARAMETERS] {
        let Machine { rs, p_ld, p_lq, p_psi_f } = self.machine;
        [rs, p_ld, p_lq, p_psi_f]
    }

    fn distance(&self, other: &Self) -> [f64; PARAMETERS] {
        let (one, other) = (self.values(), other.values());
        std::array::from_fn(|p| (one[p] - other[p]).abs())
    }

    /// Relative change of each number from this fit to another.
    fn change_to(&self, other: &Self) -> [f64; PARAMETERS] {
        let (one, other) = (self.values(), other.values());
        std::array::from_fn(|p| if self.is_free[p] { other[p] / one[p] - 1.0 } else { 0.0 })
    }

    fn estimate(&self, parameter: Parameter, doubt: f64, pole_pairs: f64) -> CharacteristicEstimate {
        let p = parameter as usize;
        let pairs = if parameter == Parameter::Rs { 1.0 } else { pole_pairs };
        let place = self.is_free[..p].iter().filter(|free| **free).count();
        let raw = self.values()[p] / pairs;
        let relative = if self.is_free[p] { self.covariance[(place, place)].max(0.0).sqrt() } else { f64::INFINITY };
        // Anywhere within the doubt alike: a uniform distribution.
        let systematic = Systematic { misfit: doubt / pairs / 3.0_f64.sqrt(), ..Systematic::default() };
        let uncertainty = ParameterUncertainty::of(relative * raw, self.degrees_of_freedom, systematic);
        let verdict = Verdict::of_half_width(uncertainty.half_width / raw);
        if verdict == Verdict::NotIdentifiable {
            return CharacteristicEstimate::unknown(parameter);
        }
        CharacteristicEstimate { parameter, value: Some(raw), uncertainty, verdict }
    }
}

/// Where the fit starts: rough values from the ends of the tables.
fn start(rows: &Rows) -> Machine {
    let of_open = rows.open.last().map(|row| row.voltage / (1.5_f64.sqrt() * row.speed.abs()));
    let (Some(slowest), Some(fastest)) = (rows.shorted.first(), rows.shorted.last()) else {
        return Machine { rs: 1.0, p_ld: 1.0, p_lq: 1.0, p_psi_f: of_open.unwrap_or(1.0) };
    };
    // Power of the shaft over the heat of a winding of one ohm, at the largest torque.
    let strongest = rows.shorted.iter().max_by(|one, other| one.torque.unwrap_or(0.0).abs().total_cmp(&other.torque.unwrap_or(0.0).abs()));
    let of_torque = strongest.and_then(|row| Some(row.torque?.abs() * row.speed.abs() / (3.0 * row.current.powi(2))));
    let rs_of_flux = |p_psi_f: f64| p_psi_f * slowest.speed.abs() / (2.0_f64.sqrt() * slowest.current);
    let rs = of_torque.or(of_open.map(rs_of_flux)).unwrap_or(1.0);
    let p_psi_f = of_open.unwrap_or(rs * 2.0_f64.sqrt() * slowest.current / slowest.speed.abs());
    let p_ld = p_psi_f / (2.0_f64.sqrt() * fastest.current);
    Machine { rs, p_ld, p_lq: p_ld, p_psi_f }
}

/// Step of the differences of logarithms: the cube root of rounding.
const STEP: f64 = 6e-6;

/// The fit as the minimizer sees it. Unknowns are the logarithms of the free numbers over their start, then the drag over the largest
/// torque, at standstill and more at the largest speed.
struct Problem<'a> {
    rows: &'a Rows,
    is_free: [bool; PARAMETERS],
    with_drag: bool,
    errors: [f64; 3],
    unknowns: DVector<f64>,
    start: Machine,
}

impl Problem<'_> {
    fn count(&self) -> usize {
        self.is_free.iter().filter(|free| **free).count() + if self.with_drag { 2 } else { 0 }
    }

    fn machine(&self) -> Machine {
        let Machine { rs, p_ld, p_lq, p_psi_f } = self.start;
        let mut unknowns = self.unknowns.iter();
        let mut values = [rs, p_ld, p_lq, p_psi_f];
        for (value, _) in values.iter_mut().zip(self.is_free).filter(|(_, free)| *free) {
            *value *= unknowns.next().map_or(1.0, |logarithm| logarithm.exp());
        }
        let [rs, p_ld, p_lq, p_psi_f] = values;
        Machine { rs, p_ld, p_lq, p_psi_f }
    }

    /// N m.
    fn drag(&self, speed: f64) -> f64 {
        if !self.with_drag {
            return 0.0;
        }
        let of_drag = self.unknowns.rows_range(self.count() - 2..);
        self.rows.largest_torque() * (of_drag[0] + of_drag[1] * speed.abs() / self.rows.largest_speed())
    }

    /// What is left: of voltages and currents as fractions, of torques in N m.
    fn groups(&self) -> [Vec<f64>; 3] {
        let machine = self.machine();
        let braking = |row: &ShortCircuitRow| row.torque.map(|torque| torque.abs() - row.torque_of(&machine) - self.drag(row.speed));
        [
            self.rows.open.iter().map(|row| 1.0 - row.voltage_of(&machine) / row.voltage).collect(),
            self.rows.shorted.iter().map(|row| 1.0 - row.current_of(&machine) / row.current).collect(),
            self.rows.shorted.iter().filter_map(braking).collect(),
        ]
    }

    /// The error of each residual.
    fn errors_of_rows(&self) -> [Vec<f64>; 3] {
        let [voltage, current, torque] = self.errors;
        let unit = self.rows.largest_torque();
        [
            vec![voltage; self.rows.open.len()],
            self.rows.shorted.iter().map(|row| current.hypot(row.current_error / row.current)).collect(),
            self.rows.shorted.iter().filter(|row| row.torque.is_some()).map(|_| torque * unit).collect(),
        ]
    }

    /// The errors that what is left shows; each kind of residual has its part of the unknowns. Rows whose phases differ say little of it.
    fn errors_left(&self) -> [f64; 3] {
        let groups = self.groups();
        let of_rows = self.errors_of_rows();
        let all: usize = groups.iter().map(Vec::len).sum();
        let used = 1.0 - (self.count() as f64 / all as f64).min(0.9);
        let units = [1.0, 1.0, self.rows.largest_torque()];
        std::array::from_fn(|k| {
            let weight = |error: &f64| (self.errors[k] * units[k] / error).powi(2);
            let weights: f64 = of_rows[k].iter().map(weight).sum();
            let squares: f64 = groups[k].iter().zip(&of_rows[k]).map(|(left, error)| (left / units[k]).powi(2) * weight(error)).sum();
            if weights > 0.0 { (squares / weights / used).sqrt().max(LEAST_ERROR) } else { self.errors[k] }
        })
    }

    fn weighted(&self) -> DVector<f64> {
        let pairs = self.groups().into_iter().flatten().zip(self.errors_of_rows().into_iter().flatten());
        DVector::from_iterator(self.groups().iter().map(Vec::len).sum(), pairs.map(|(left, error)| left / error))
    }

    fn slopes(&self) -> DMatrix<f64> {
        let moved = |k: usize, by: f64| {
            let mut unknowns = self.unknowns.clone();
            unknowns[k] += by;
            Problem { unknowns, start: self.start, ..*self }.weighted()
        };
        let columns: Vec<DVector<f64>> = (0..self.count()).map(|k| (moved(k, STEP) - moved(k, -STEP)) / (2.0 * STEP)).collect();
        DMatrix::from_columns(&columns)
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, unknowns: &DVector<f64>) {
        self.unknowns.copy_from(unknowns);
    }

    fn params(&self) -> DVector<f64> {
        self.unknowns.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.weighted())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(self.slopes())
    }
}

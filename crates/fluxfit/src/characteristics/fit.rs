//! The fit: all tables of a motor at once, by weighted least squares.
//!
//! Voltages and currents are compared by their relative error, torques by their absolute one, because a bench's drag and its torque
//! sensor are as large at any speed. How large these errors are is estimated from what is left, and counted for longer where neighbouring
//! rows err alike. What brakes besides the short circuit (bearings, air, iron) is fitted as `c_0 + c_1 |Omega|`; how far the motor moves
//! without it is counted as the doubt of it. Where the motor does not follow the model, as by saturation, the
//! numbers move when rows are left out: the standard error is at least that of the jackknife.

use super::{
    characteristic::Characteristic,
    lack::{Lack, Parts},
    machine::Machine,
    open_circuit::{Across, SQRT_3, constant_voltage},
    problem::{Problem, start},
    rows::{Instrument, RESIDUALS, Residual, Rows},
    steady_points::SteadyPoint,
    torque_of_current::is_computed,
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
use levenberg_marquardt::LevenbergMarquardt;
use nalgebra::DMatrix;
use std::f64::consts::SQRT_2;

/// What tables say of their motor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CharacteristicsAnswer {
    /// In the order of [`Parameter::ALL`].
    pub parameters: [CharacteristicEstimate; PARAMETERS],
    /// Pole pairs, if they are known: then the parameters are the motor's own.
    pub pole_pairs: Option<u32>,
    /// The speeds of the tables are electrical: the parameters are the motor's own without pole pairs.
    pub has_electrical_speeds: bool,
    /// What is left, in the order of [`Residual::ALL`]: root mean squares, as a fraction or SI; `None` where there are none.
    pub residual_rms: [Option<f64>; RESIDUALS],
    /// How open-circuit voltages were taken; `None` without any.
    pub voltages: Option<VoltageReading>,
    /// Where the voltages are [ambiguous](VoltageReading::Ambiguous): what the parameters would be if these are line to line. Of a phase,
    /// all would be `sqrt 3` times as large.
    pub if_line_to_line: [Option<f64>; PARAMETERS],
    /// Relative change of each parameter that has a value by the [error](Instrument) of an instrument, which no table shows.
    pub unseen: Vec<(Instrument, [f64; PARAMETERS])>,
}

impl CharacteristicsAnswer {
    /// Whether inductances and flux are the motor's own, not these times the pole pairs.
    pub fn is_of_motor(&self) -> bool {
        self.pole_pairs.is_some() || self.has_electrical_speeds
    }

    /// Whether all four parameters are identified, and are the motor's own.
    pub fn is_complete(&self) -> bool {
        self.is_of_motor() && self.parameters.iter().all(|estimate| estimate.verdict == Verdict::Identified)
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
    /// Why it has no value, or a weak one.
    pub lack: Option<Lack>,
}

impl CharacteristicEstimate {
    fn unknown(parameter: Parameter, lack: Lack) -> Self {
        let uncertainty = ParameterUncertainty::default();
        Self { parameter, value: None, uncertainty, verdict: Verdict::NotIdentifiable, lack: Some(lack) }
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
    /// As a torque tells, or the resistance of a direct current.
    ByTorque(Across),
    /// Line to line or of a phase, which nothing tells: then no parameter is.
    Ambiguous,
}

/// Identifies a motor from its characteristics.
///
/// # Errors
/// If a table is too short, or the tables together hold neither voltage nor torque.
pub fn identify_characteristics(tables: &[Characteristic], pole_pairs: Option<u32>) -> Result<CharacteristicsAnswer, Error> {
    let Checked { rows, voltages, fit, of_loss } = Checked::of(tables)?;
    let jackknife = fit.jackknife(&rows);
    let of_drag = if rows.has_torque() { fit.distance(&Fit::of(&rows, false)?) } else { [0.0; PARAMETERS] };
    let of_tables = fit.contradiction_of_points(&rows)?;
    let doubt: [f64; PARAMETERS] = std::array::from_fn(|p| of_drag[p].hypot(fit.doubt_of_minima[p]).hypot(of_loss[p]).hypot(of_tables[p]));
    let pairs = f64::from(pole_pairs.unwrap_or(1));
    let mut parameters =
        Parameter::ALL.map(|parameter| fit.estimate(parameter, &rows, jackknife[parameter as usize], doubt[parameter as usize], pairs));
    let mut if_line_to_line = [None; PARAMETERS];
    if voltages == Some(VoltageReading::Ambiguous) {
        if_line_to_line = parameters.map(|estimate| estimate.value);
        // A direct current alone tells the resistance without them.
        let is_told = |parameter: Parameter| parameter == Parameter::Rs && rows.shorted.is_empty();
        // Voltages with a name would tell what no other table lacks.
        let is_open = |estimate: &CharacteristicEstimate| estimate.value.is_some() && !is_told(estimate.parameter);
        parameters = parameters.map(|estimate| match is_open(&estimate) {
            true => CharacteristicEstimate::unknown(estimate.parameter, Lack::Voltages),
            false => estimate,
        });
    }
    let told = parameters.map(|estimate| estimate.value.is_some());
    let change = |instrument: Instrument| {
        let changes = fit.change_to(&Fit::of(&rows.with_error_of(instrument), rows.has_torque())?);
        Ok((instrument, std::array::from_fn(|p| if told[p] { changes[p] } else { 0.0 })))
    };
    let unseen = Instrument::ALL.into_iter().filter(|instrument| rows.has(*instrument)).map(change).collect::<Result<_, Error>>()?;
    let has_electrical_speeds = false;
    Ok(CharacteristicsAnswer {
        parameters,
        pole_pairs,
        has_electrical_speeds,
        residual_rms: fit.residual_rms,
        voltages,
        if_line_to_line,
        unseen,
    })
}

/// The same of tables whose speeds are electrical. Everything is then as of a motor with one pole pair, and inductances and flux are the
/// motor's own; a torque, which is that of the shaft, would be missed by the pole pairs, so none may be among the tables.
///
/// # Errors
/// As [`identify_characteristics`].
pub fn identify_electrical_characteristics(tables: &[Characteristic]) -> Result<CharacteristicsAnswer, Error> {
    let answer = identify_characteristics(tables, Some(1))?;
    Ok(CharacteristicsAnswer { pole_pairs: None, has_electrical_speeds: true, ..answer })
}

/// Whether some tables are what they are taken for, so far as they tell it: the same check that an identification begins with. Of a table
/// that [needs another](Characteristic::needs_another), that one may be missing.
///
/// # Errors
/// As [`identify_characteristics`].
pub fn check_characteristics(tables: &[Characteristic]) -> Result<(), Error> {
    match Checked::of(tables) {
        Err(error) if *error.kind() != ErrorKind::NoScale => Err(error),
        _ => Ok(()),
    }
}

/// The fit of tables that are what they are taken for.
struct Checked {
    rows: Rows,
    voltages: Option<VoltageReading>,
    fit: Fit,
    /// How far each number moves where an inverter is kept from adding voltage.
    of_loss: [f64; PARAMETERS],
}

impl Checked {
    fn of(tables: &[Characteristic]) -> Result<Self, Error> {
        let is_computed = |table: &Characteristic| matches!(table, Characteristic::TorqueOfCurrent(table) if is_computed(&table.rows));
        if tables.iter().any(is_computed) {
            return Err(ErrorKind::ComputedTorque.into());
        }
        let (rows, voltages) = with_told_voltages(Rows::of(tables)?)?;
        let fit = Fit::of(&rows, rows.has_torque())?;
        let (rows, fit, of_loss) = without_gain(rows, fit)?;
        if let Some(missed) = fit.residual_rms[1].filter(|missed| *missed > LARGEST_MISS) {
            return Err(ErrorKind::NoShortCircuit { missed }.into());
        }
        if let Some(missed) = fit.residual_rms[0].filter(|missed| *missed > LARGEST_MISS) {
            return Err(ErrorKind::NoOpenCircuit { missed }.into());
        }
        if let Some((of_line, of_constant)) = constant_voltage(&rows.open) {
            return Err(ErrorKind::ConstantVoltage { of_line, of_constant }.into());
        }
        for residual in [Residual::Torque, Residual::DirectVoltage, Residual::DutyVoltage, Residual::PointVoltage] {
            let most = if residual == Residual::PointVoltage { LARGEST_MISS_OF_POINTS } else { LARGEST_MISS };
            if let Some(missed) = fit.residual_rms[residual as usize].map(|left| left / rows.unit(residual)).filter(|missed| *missed > most)
            {
                return Err(ErrorKind::NoSuchTable { what: residual.label(), missed }.into());
            }
        }
        match fit.torque_ratio(&rows).filter(|ratio| !TORQUE_OF_POINTS.contains(ratio)) {
            Some(ratio) => Err(ErrorKind::TorqueOfPoints { ratio }.into()),
            None => Ok(Self { rows, voltages, fit, of_loss }),
        }
    }
}

/// What a short circuit's currents, or voltages of open terminals, are missed by at most, as a fraction: a motor that saturates by half is
/// missed by less.
const LARGEST_MISS: f64 = 0.2;

/// The same of operating points: with currents or angles of the wrong sign a fifth is missed, with half the inductance lost to saturation a
/// twentieth.
const LARGEST_MISS_OF_POINTS: f64 = 0.1;

/// The torque of operating points over that of the air gap: bearings and iron take a tenth at most of large ones. Rms values in place of
/// peak values make it 2, a power-invariant transform 2/3, an electrical speed the pole pairs.
const TORQUE_OF_POINTS: std::ops::RangeInclusive<f64> = 0.8..=1.15;

/// Points that contradict other tables by more standard errors than this count: less is noise.
const CONTRADICTION: f64 = 3.0;

/// An inverter takes voltage and never adds any: where the fit has it add some, as of a winding that warms with the current, the fit
/// without is the answer, and how far it moves is doubt.
fn without_gain(rows: Rows, fit: Fit) -> Result<(Rows, Fit, [f64; PARAMETERS]), Error> {
    if fit.lost_of_points >= 0.0 {
        return Ok((rows, fit, [0.0; PARAMETERS]));
    }
    let rows = Rows { are_points_lossless: true, ..rows };
    let without = Fit::of(&rows, rows.has_torque())?;
    let distance = without.distance(&fit);
    Ok((rows, without, distance))
}

/// The rows with their voltages as they were measured, by what the tables state or by the other tables: the power of the shaft heats
/// the winding, which gives the resistance whatever the voltages are.
fn with_told_voltages(rows: Rows) -> Result<(Rows, Option<VoltageReading>), Error> {
    if rows.open.is_empty() {
        return Ok((rows, None));
    }
    if !rows.tells_flux() {
        let reading = if rows.are_voltages_stated { VoltageReading::Stated } else { VoltageReading::Ambiguous };
        return Ok((rows, Some(reading)));
    }
    let criterion = |factor: f64| Ok::<f64, Error>(Fit::of(&rows.with_voltages(factor), true)?.criterion);
    let limit = criterion(1.0)? - VERY_STRONG;
    let others = VOLTAGE_MISTAKES.iter().map(|factor| Ok((*factor, criterion(*factor)?))).collect::<Result<Vec<_>, Error>>()?;
    let better = others.iter().filter(|(_, criterion)| *criterion < limit).min_by(|one, other| one.1.total_cmp(&other.1));
    // The first mistake is a phase taken for two lines.
    let phase = others[0];
    match better {
        None if rows.are_voltages_stated => Ok((rows, Some(VoltageReading::Stated))),
        None if phase.1 > limit + 2.0 * VERY_STRONG => Ok((rows, Some(VoltageReading::ByTorque(Across::Lines)))),
        None => Ok((rows, Some(VoltageReading::Ambiguous))),
        Some(best) if *best == phase && !rows.are_voltages_stated => {
            Ok((rows.with_voltages(phase.0), Some(VoltageReading::ByTorque(Across::Phase))))
        }
        Some((factor, _)) => Err(ErrorKind::VoltagesAgainstTorque { factor: *factor }.into()),
    }
}

/// What voltages are too small by where a phase is taken for two lines or the other way round, and rms for an amplitude or the other way
/// round; powers of ten are those of units.
const VOLTAGE_MISTAKES: [f64; 6] = [SQRT_3, 1.0 / SQRT_3, SQRT_2, 1.0 / SQRT_2, 1e3, 1e-3];

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
    residual_rms: [Option<f64>; RESIDUALS],
    /// V, that an inverter takes of operating points.
    lost_of_points: f64,
}

impl Fit {
    /// The torque of operating points over what voltages, currents and speed make of it, by least squares; none where none is measured.
    fn torque_ratio(&self, rows: &Rows) -> Option<f64> {
        let of = |point: &SteadyPoint| point.torque.zip(point.torque_of(self.machine.rs, self.lost_of_points));
        let (both, square) =
            rows.points.iter().filter_map(of).fold((0.0, 0.0), |(both, square), (torque, own)| (both + torque * own, square + own * own));
        (square > 0.0).then(|| both / square)
    }

    /// How far each number lies from that of the operating points alone, where these contradict the other tables.
    fn contradiction_of_points(&self, rows: &Rows) -> Result<[f64; PARAMETERS], Error> {
        if !rows.has_points_and_others() {
            return Ok([0.0; PARAMETERS]);
        }
        let alone = Self::of(&rows.points_alone(), false)?;
        let distance = self.distance(&alone);
        let place = |p: usize| alone.is_free[..p].iter().filter(|free| **free).count();
        let error = |p: usize| alone.covariance[(place(p), place(p))].max(0.0).sqrt() * alone.values()[p];
        let is_contradicted = |p: usize| alone.is_free[p] && self.is_free[p] && distance[p] > CONTRADICTION * error(p);
        Ok(std::array::from_fn(|p| if is_contradicted(p) { distance[p] } else { 0.0 }))
    }

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
        let mut problem = Problem::new(rows, *start, with_drag);
        let mut errors = problem.errors;
        for _ in 0..ROUNDS {
            problem.errors = errors;
            (problem, _) = LevenbergMarquardt::new().minimize(problem);
            errors = problem.errors_left();
        }
        // As many as are independent.
        let of_groups = problem.groups();
        let criterion: f64 = of_groups.iter().zip(errors).map(|(group, error)| 2.0 * group.len() as f64 * error.ln()).sum();
        let is_free = problem.is_free;
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
        Some(Self {
            machine,
            criterion,
            doubt_of_minima: [0.0; PARAMETERS],
            is_free,
            covariance: covariance.unwrap_or_else(|| DMatrix::from_element(count, count, f64::INFINITY)),
            degrees_of_freedom: (independent.iter().sum::<f64>() - count as f64).max(1.0),
            lost_of_points: problem.lost_of_points(),
            residual_rms: std::array::from_fn(|k| rms(&of_groups[k], errors[k] * rows.unit(Residual::ALL[k]))),
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

    /// Standard error of each number by what the fit changes where a part of a table is left out. The covariance trusts
    /// the model; this shows a number that a few rows decide alone. See B. Efron, C. Stein, The Annals of Statistics 9 (1981) 586,
    /// DOI 10.1214/aos/1176345462; of several tables the sum.
    fn jackknife(&self, rows: &Rows) -> [f64; PARAMETERS] {
        let mut squares = [0.0; PARAMETERS];
        for parts in rows.without_parts() {
            let fits: Vec<Self> = parts.iter().filter_map(|rest| Self::from(&self.machine, rest, rest.has_torque())).collect();
            let count = fits.len() as f64;
            for (p, square) in squares.iter_mut().enumerate() {
                let mean = fits.iter().map(|fit| fit.values()[p]).sum::<f64>() / count;
                *square += fits.iter().map(|fit| (fit.values()[p] - mean).powi(2)).sum::<f64>() * (count - 1.0).max(0.0) / count.max(1.0);
            }
        }
        squares.map(f64::sqrt)
    }

    fn estimate(&self, parameter: Parameter, rows: &Rows, jackknife: f64, doubt: f64, pole_pairs: f64) -> CharacteristicEstimate {
        let p = parameter as usize;
        if !self.is_free[p] {
            return CharacteristicEstimate::unknown(parameter, Lack::Absent { parameter });
        }
        if let Some(lack) = Lack::of_one_current(parameter, rows) {
            return CharacteristicEstimate::unknown(parameter, lack);
        }
        let pairs = if parameter == Parameter::Rs { 1.0 } else { pole_pairs };
        let place = self.is_free[..p].iter().filter(|free| **free).count();
        let raw = self.values()[p] / pairs;
        let relative = self.covariance[(place, place)].max(0.0).sqrt();
        // Anywhere within the doubt alike: a uniform distribution.
        let systematic = Systematic { misfit: doubt / pairs / 3.0_f64.sqrt(), ..Systematic::default() };
        let standard_error = (relative * raw).max(jackknife / pairs);
        let uncertainty = ParameterUncertainty::of(standard_error, self.degrees_of_freedom, systematic);
        let half_width = uncertainty.half_width / raw;
        let verdict = Verdict::of_half_width(half_width);
        let parts = Parts { scatter: relative * raw, few_rows: jackknife / pairs, alternatives: systematic.misfit };
        let lack = Lack::of_wide(parameter, rows, half_width, &parts);
        match verdict {
            Verdict::NotIdentifiable => CharacteristicEstimate::unknown(parameter, lack),
            Verdict::Weak => CharacteristicEstimate { parameter, value: Some(raw), uncertainty, verdict, lack: Some(lack) },
            Verdict::Identified => CharacteristicEstimate { parameter, value: Some(raw), uncertainty, verdict, lack: None },
        }
    }
}

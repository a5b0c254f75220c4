//! The fit as the minimizer sees it. Unknowns are the logarithms of the free numbers of the motor over their start, so that they stay
//! positive, then what is fitted beside them.

use super::{
    duty_cycle::DutyCycleRow,
    machine::Machine,
    rows::{ANGLE_OF_POINTS, Extra, RESIDUALS, Residual, Rows},
    short_circuit::ShortCircuitRow,
    steady_points::{Drive, SteadyPoint},
};
use crate::{
    frames::Dq,
    motor::{PARAMETERS, Parameter},
};
use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::{DMatrix, DVector, Dyn, Owned};

/// Errors that a fit starts with: half a percent, and of a table's largest value a percent.
pub(super) const USUAL_ERRORS: [f64; RESIDUALS] = [0.005, 0.005, 0.01, 0.01, 0.01, 0.01, 0.01];

/// Errors below this part of a value are rounding.
const LEAST_ERROR: f64 = 1e-7;

/// Step of the differences of logarithms: the cube root of rounding.
const STEP: f64 = 6e-6;

/// Standard error of the logarithm of a number that duty cycles may not tell, around a rough start: a factor of 20 either way. It keeps
/// the fit from running away, and leaves a number that nothing else tells with an interval that is no answer.
const VAGUE: f64 = 3.0;

/// The problem, with the errors of its residuals.
pub(super) struct Problem<'a> {
    pub(super) rows: &'a Rows,
    pub(super) is_free: [bool; PARAMETERS],
    pub(super) extras: Vec<Extra>,
    pub(super) errors: [f64; RESIDUALS],
    pub(super) unknowns: DVector<f64>,
    pub(super) start: Machine,
}

impl<'a> Problem<'a> {
    pub(super) fn new(rows: &'a Rows, start: Machine, with_drag: bool) -> Self {
        let (is_free, extras) = (rows.free(), rows.extras(with_drag));
        let count = is_free.iter().filter(|free| **free).count() + extras.len();
        Self { rows, is_free, extras, errors: USUAL_ERRORS, unknowns: DVector::zeros(count), start }
    }

    pub(super) fn count(&self) -> usize {
        self.unknowns.len()
    }

    pub(super) fn machine(&self) -> Machine {
        let Machine { rs, p_ld, p_lq, p_psi_f } = self.start;
        let mut unknowns = self.unknowns.iter();
        let mut values = [rs, p_ld, p_lq, p_psi_f];
        for (value, _) in values.iter_mut().zip(self.is_free).filter(|(_, free)| *free) {
            *value *= unknowns.next().map_or(1.0, |logarithm| logarithm.exp());
        }
        let [rs, p_ld, p_lq, p_psi_f] = values;
        Machine { rs, p_ld, p_lq, p_psi_f }
    }

    /// What is fitted beside the motor, over the unit of its table; zero if it is not.
    fn extra(&self, extra: Extra) -> f64 {
        let place = self.extras.iter().position(|one| *one == extra);
        place.map_or(0.0, |place| self.unknowns[self.count() - self.extras.len() + place])
    }

    /// What lies between the motor and its operating points, whose largest voltage is so many V.
    fn drive_of_points(&self, unit: f64) -> Drive {
        let speed = self.rows.largest_speed_of_points();
        Drive {
            lost: unit * self.extra(Extra::LostOfPoints),
            angle: ANGLE_OF_POINTS * self.extra(Extra::AngleOfPoints),
            lag: if speed > 0.0 { ANGLE_OF_POINTS / speed * self.extra(Extra::LagOfPoints) } else { 0.0 },
        }
    }

    /// What the inverter loses of the voltages of operating points, V.
    pub(super) fn lost_of_points(&self) -> f64 {
        self.drive_of_points(self.rows.unit(Residual::PointVoltage)).lost
    }

    /// What is left, by kind.
    pub(super) fn groups(&self) -> [Vec<f64>; RESIDUALS] {
        let (machine, rows) = (self.machine(), self.rows);
        let unit = Residual::ALL.map(|residual| rows.unit(residual));
        let [.., short_torque, torque, direct, duty, points] = unit;
        let [drag, of_speed] = [Extra::Drag, Extra::DragOfSpeed].map(|extra| short_torque * self.extra(extra));
        let drag = |speed: f64| drag + if of_speed == 0.0 { 0.0 } else { of_speed * speed.abs() / rows.largest_speed() };
        let braking = |row: &ShortCircuitRow| row.torque.map(|torque| torque.abs() - row.torque_of(&machine) - drag(row.speed));
        let product = rows.largest_product();
        let saliency = if product > 0.0 { torque * self.extra(Extra::Saliency) / product } else { 0.0 };
        let offset = torque * self.extra(Extra::TorqueOffset);
        let drop = direct * self.extra(Extra::Drop);
        let lost = duty * self.extra(Extra::Lost);
        let drive = self.drive_of_points(points);
        let missed = |point: &SteadyPoint| {
            let Dq { d, q } = point.voltage_of(&machine, &drive);
            Dq { d: point.voltage.d - d, q: point.voltage.q - q }
        };
        let missed: Vec<Dq> = rows.points.iter().map(missed).collect();
        [
            rows.open.iter().map(|row| 1.0 - row.voltage_of(&machine) / row.voltage).collect(),
            rows.shorted.iter().map(|row| 1.0 - row.current_of(&machine) / row.current).collect(),
            rows.shorted.iter().filter_map(braking).collect(),
            rows.torque.iter().map(|row| row.torque - row.torque_of(&machine, saliency) - offset).collect(),
            rows.direct.iter().map(|row| row.voltage - row.voltage_of(&machine, drop)).collect(),
            rows.duty.iter().map(|row| row.voltage() - lost - row.voltage_of(&machine)).collect(),
            missed.iter().map(|u| u.d).chain(missed.iter().map(|u| u.q)).collect(),
        ]
    }

    /// The error of each residual.
    pub(super) fn errors_of_rows(&self) -> [Vec<f64>; RESIDUALS] {
        let alike = |residual: Residual, count: usize| vec![self.errors[residual as usize] * self.rows.unit(residual); count];
        let current = self.errors[Residual::ShortCurrent as usize];
        [
            alike(Residual::OpenVoltage, self.rows.open.len()),
            self.rows.shorted.iter().map(|row| current.hypot(row.current_error / row.current)).collect(),
            alike(Residual::ShortTorque, self.rows.shorted.iter().filter(|row| row.torque.is_some()).count()),
            alike(Residual::Torque, self.rows.torque.len()),
            alike(Residual::DirectVoltage, self.rows.direct.len()),
            alike(Residual::DutyVoltage, self.rows.duty.len()),
            alike(Residual::PointVoltage, 2 * self.rows.points.len()),
        ]
    }

    /// The errors that what is left shows; each kind of residual has its part of the unknowns. Rows whose phases differ say little of it.
    pub(super) fn errors_left(&self) -> [f64; RESIDUALS] {
        let groups = self.groups();
        let of_rows = self.errors_of_rows();
        let all: usize = groups.iter().map(Vec::len).sum();
        let used = 1.0 - (self.count() as f64 / all as f64).min(0.9);
        std::array::from_fn(|k| {
            let unit = self.rows.unit(Residual::ALL[k]);
            let weight = |error: &f64| (self.errors[k] * unit / error).powi(2);
            let weights: f64 = of_rows[k].iter().map(weight).sum();
            let squares: f64 = groups[k].iter().zip(&of_rows[k]).map(|(left, error)| (left / unit).powi(2) * weight(error)).sum();
            if weights > 0.0 { (squares / weights / used).sqrt().max(LEAST_ERROR) } else { self.errors[k] }
        })
    }

    /// Logarithms of the numbers that duty cycles alone depend on, over their vague errors.
    fn vague(&self) -> impl Iterator<Item = f64> {
        let is_vague = |p: Parameter| {
            self.rows.shorted.is_empty() && self.rows.points.is_empty() && (p != Parameter::Rs || self.rows.direct.is_empty())
        };
        let free = Parameter::ALL.into_iter().filter(|p| self.is_free[*p as usize]).enumerate();
        let vague = free.filter(move |(_, p)| !self.rows.duty.is_empty() && matches!(p, Parameter::Rs | Parameter::Lq) && is_vague(*p));
        vague.map(|(place, _)| self.unknowns[place] / VAGUE)
    }

    /// What is known of the drive of operating points, over its standard error. What an inverter loses is no more than the largest voltage:
    /// points of one current do not tell it from the resistance, and the fit has to end all the same.
    fn of_points(&self) -> impl Iterator<Item = f64> {
        let of_points = [Extra::LostOfPoints, Extra::AngleOfPoints, Extra::LagOfPoints];
        of_points.into_iter().filter(|extra| self.extras.contains(extra)).map(|extra| self.extra(extra))
    }

    fn weighted(&self) -> DVector<f64> {
        let pairs = self.groups().into_iter().flatten().zip(self.errors_of_rows().into_iter().flatten());
        let weighted: Vec<f64> = pairs.map(|(left, error)| left / error).chain(self.vague()).chain(self.of_points()).collect();
        DVector::from_vec(weighted)
    }

    pub(super) fn slopes(&self) -> DMatrix<f64> {
        let moved = |k: usize, by: f64| {
            let mut unknowns = self.unknowns.clone();
            unknowns[k] += by;
            Problem { unknowns, extras: self.extras.clone(), ..*self }.weighted()
        };
        let columns: Vec<DVector<f64>> = (0..self.count()).map(|k| (moved(k, STEP) - moved(k, -STEP)) / (2.0 * STEP)).collect();
        DMatrix::from_columns(&columns)
    }
}

/// Where the fit starts: rough values from the ends of the tables.
pub(super) fn start(rows: &Rows) -> Machine {
    let of_open = rows.open.last().map(|row| row.voltage / (1.5_f64.sqrt() * row.speed.abs()));
    let strongest = rows.torque.iter().max_by(|one, other| one.current.q.abs().total_cmp(&other.current.q.abs()));
    let of_torque = strongest.map(|row| (row.torque / (1.5 * row.current.q)).abs());
    let fastest = rows.duty.iter().max_by(|one, other| one.speed.total_cmp(&other.speed));
    let of_duty = fastest.map(|row| row.voltage() / row.speed);
    let flux = of_open.or(of_torque).or(of_duty);
    let of_direct = rows.direct.last().map(|row| (row.voltage / row.current).abs());
    if let (Some(slowest), Some(fastest)) = (rows.shorted.first(), rows.shorted.last()) {
        return start_of_short_circuit(rows, slowest, fastest, flux, of_direct);
    }
    if !rows.points.is_empty() {
        return start_of_points(rows);
    }
    // A tenth of the voltage across the resistance, and as much across the inductance.
    let largest = rows.duty.iter().filter_map(|row| row.current).fold(0.0, |largest: f64, current| current.abs().max(largest));
    let tenth = |row: &DutyCycleRow| 0.1 * row.voltage() / largest.max(f64::MIN_POSITIVE);
    let rs = of_direct.or(fastest.map(tenth)).unwrap_or(1.0);
    let p_lq = fastest.map_or(1.0, |row| tenth(row) / row.speed);
    Machine { rs, p_ld: p_lq, p_lq, p_psi_f: flux.unwrap_or(1.0) }
}

fn start_of_short_circuit(
    rows: &Rows,
    slowest: &ShortCircuitRow,
    fastest: &ShortCircuitRow,
    flux: Option<f64>,
    of_direct: Option<f64>,
) -> Machine {
    // Power of the shaft over the heat of a winding of one ohm, at the largest torque.
    let strongest = rows.shorted.iter().max_by(|one, other| one.torque.unwrap_or(0.0).abs().total_cmp(&other.torque.unwrap_or(0.0).abs()));
    let of_torque = strongest.and_then(|row| Some(row.torque?.abs() * row.speed.abs() / (3.0 * row.current.powi(2))));
    let rs_of_flux = |p_psi_f: f64| p_psi_f * slowest.speed.abs() / (2.0_f64.sqrt() * slowest.current);
    let rs = of_torque.or(of_direct).or(flux.map(rs_of_flux)).unwrap_or(1.0);
    let p_psi_f = flux.unwrap_or(rs * 2.0_f64.sqrt() * slowest.current / slowest.speed.abs());
    let p_ld = p_psi_f / (2.0_f64.sqrt() * fastest.current);
    Machine { rs, p_ld, p_lq: p_ld, p_psi_f }
}

/// A tenth of the largest voltage across the resistance, half of it across either inductance, the largest current and speed together.
fn start_of_points(rows: &Rows) -> Machine {
    let largest = |size: fn(&SteadyPoint) -> f64| rows.points.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let (u, i, speed) =
        (largest(|point| point.voltage.magnitude()), largest(|point| point.current.magnitude()), largest(|point| point.speed.abs()));
    let p_l = 0.5 * u / (speed * i);
    Machine { rs: 0.1 * u / i, p_ld: p_l, p_lq: p_l, p_psi_f: u / speed }
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

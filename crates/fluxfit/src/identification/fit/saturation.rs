//! Saturation: flux that does not grow in proportion to the current, so that there are no constant inductances to be found.
//!
//! At a steady operating point the voltage tells the flux, whatever it depends on:
//!
//! ```text
//! psi_d = (u_q - R_s i_q) / omega_e - L_q drift_q / omega_e
//! psi_q = (R_s i_d - u_d) / omega_e + L_d drift_d / omega_e
//! ```
//!
//! Its *apparent* inductances are `psi_q / i_q` and `(psi_d - psi_f) / i_d`; the [incremental](super::incremental) ones, `d psi / d i`,
//! are other numbers, and points that lie far apart do not tell them.
//!
//! Whether saturation is why operating points contradict each other is found by [`saturation_equations`](super::saturation_equations).

use super::{
    super::request::{Known, Request},
    excitation::Excitation,
    output_errors::FaultEstimate,
    resistance_of_speeds::Resistance,
    saturation_equations::{self, peak},
    voltage_loss::{self, Loss},
};
use crate::{
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    objective::adjustable::Adjustable,
    steady::OperatingPoint,
};
use nalgebra::{DMatrix, DVector};
use std::{iter, ops::Range};

/// Saturation, and what the flux is instead of an inductance times the current.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SaturationFinding {
    /// Resistance that the fluxes were computed with, ohm.
    pub rs: f64,
    /// Its standard uncertainty, ohm; zero where it was given.
    pub rs_uncertainty: f64,
    /// Whether points of one current at several speeds tell it, however the flux depends on the current: then it is the answer.
    pub tells_rs: bool,
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
#[non_exhaustive]
pub struct Flux {
    /// Current, A.
    pub current: Dq,
    /// Flux linkage, Wb.
    pub psi: Dq,
    /// Its standard uncertainty, Wb: noise of the means, accuracy of the voltages, resistance, what dead time takes.
    pub uncertainty: Dq,
    /// Whether the point itself tells both fluxes, R_s left aside: to half of their size, beyond which a parameter would be no answer.
    pub is_told: bool,
    /// `psi_q / i_q`, H; none where i_q is too small for it, or the flux not known to a half of it.
    pub apparent_lq: Option<f64>,
    /// `(psi_d - psi_f) / i_d`, H; none where i_d is too small for it, or psi_f is not known beforehand.
    pub apparent_ld: Option<f64>,
}

impl Flux {
    /// With its distance from another as doubt.
    fn or_as(self, other: &Self) -> Self {
        let doubt = Dq { d: self.psi.d - other.psi.d, q: self.psi.q - other.psi.q };
        let uncertainty = Dq { d: self.uncertainty.d.hypot(doubt.d), q: self.uncertainty.q.hypot(doubt.q) };
        Self { uncertainty, ..self }
    }
}

/// What R_s, an inverter and a warming winding take at an operating point, V.
#[derive(Clone, Copy, Default)]
struct Lost {
    volts: Dq,
    standard_error: Dq,
}

impl Lost {
    /// What R_s, dead time and the drift of R_s take at current `i`, A, and at a `time` between -0.5 at the log's start and 0.5 at its end,
    /// given the drive's fitted numbers with their errors. Correlations between these are not counted: the standard error is rather too
    /// large.
    fn of_drive(drive: &Adjustable, (rs_uncertainty, beside): (f64, &[FaultEstimate]), i: Dq, time: f64) -> Self {
        let lost = |drive: &Adjustable| {
            let dead_time = voltage_loss::fundamental(&drive.faults.dead_time, i);
            let rs = drive.motor.rs + drive.faults.resistance_drift.change * time;
            Dq { d: dead_time.d + rs * i.d, q: dead_time.q + rs * i.q }
        };
        let volts = lost(drive);
        let of_rs = Dq { d: rs_uncertainty * i.d, q: rs_uncertainty * i.q };
        let standard_error = beside.iter().fold(of_rs, |sum, FaultEstimate { unknown, value, standard_error }| {
            let moved = lost(&drive.with(*unknown, value + standard_error));
            Dq { d: sum.d.hypot(moved.d - volts.d), q: sum.q.hypot(moved.q - volts.q) }
        });
        Self { volts, standard_error }
    }

    /// What R_s and the unknowns of a drive take at operating point `w`.
    fn of_unknowns(told: &Resistance, unknowns: &[Loss], (w, point): (usize, &OperatingPoint)) -> Self {
        let i = point.current();
        let [d, q] = [(i.d, 0), (i.q, 1)].map(|(i, axis)| {
            let column: Vec<f64> = iter::once(i).chain(unknowns.iter().map(|unknown| unknown.voltages[w][axis])).collect();
            let column = DVector::from_vec(column);
            let volts = column.iter().zip(&told.values).map(|(column, value)| column * value).sum::<f64>();
            (volts, column.dot(&(&told.covariance * &column)).max(0.0).sqrt())
        });
        Self { volts: Dq { d: d.0, q: q.0 }, standard_error: Dq { d: d.1, q: q.1 } }
    }
}

/// Points that are turned back into the magnet's frame; none of a drive whose angle is neither off nor late, and whose voltages do not lag.
pub(super) fn in_magnets_frame(points: &[OperatingPoint], drive: &Adjustable) -> Option<Vec<OperatingPoint>> {
    let (offset, delay, lag) = (drive.faults.angle_offset.angle, drive.faults.angle_delay.time, drive.faults.voltage_lag.time);
    let in_frame = |point: &OperatingPoint| point.in_frame_behind(offset - delay * point.omega_e()).turned(-lag * point.omega_e());
    (offset != 0.0 || delay != 0.0 || lag != 0.0).then(|| points.iter().map(in_frame).collect())
}

/// An apparent inductance, H, and the current, A, at which it is one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
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

/// A flux is told where its 95 % half-width is at most this part of it, as a weak parameter is.
pub(super) const TOLD: f64 = 0.5;

/// The normal distribution's two-sided 95 % quantile, rounded down: an interval of that many standard deviations or more covers a spread.
const QUANTILE: f64 = 1.95;

/// The apparent L_q at the smallest and the largest i_q. Points whose i_q lie as near together as `alike`, A, are of one load: the surest
/// of them speaks.
fn ends_of_lq(fluxes: &[Option<Flux>], alike: f64) -> Option<[Apparent; 2]> {
    let told = || fluxes.iter().flatten().filter_map(|flux| Some((flux, flux.apparent_lq?)));
    let sizes = || told().map(|(flux, _)| flux.current.q.abs());
    let surest = |end: f64| {
        let of_end = told().filter(|(flux, _)| (flux.current.q.abs() - end).abs() <= alike);
        let error = |flux: &Flux| (flux.uncertainty.q / flux.current.q).abs();
        let surest = of_end.min_by(|(one, _), (other, _)| error(one).total_cmp(&error(other)));
        surest.map(|(flux, inductance)| Apparent { current: flux.current.q, inductance })
    };
    Some([surest(sizes().min_by(f64::total_cmp)?)?, surest(sizes().max_by(f64::total_cmp)?)?])
}

impl SaturationFinding {
    /// Two standard uncertainties of an apparent L_q, H; nothing, where no operating point tells them.
    pub fn half_width_of(&self, apparent: &Apparent) -> Option<f64> {
        let of_point = self.fluxes.iter().flatten().find(|flux| flux.current.q == apparent.current);
        of_point.map(|flux| 2.0 * (flux.uncertainty.q / flux.current.q).abs())
    }

    /// Looks for it among operating points that contradict each other, beside what constants leave of the losses and all that is
    /// `possible` of the drive; `of_speeds`: R_s and the latter, whatever the flux is.
    pub(crate) fn of_points(
        points: &[OperatingPoint],
        (losses, possible): (&[Loss], &[Loss]),
        excitation: &Excitation,
        motor: &Motor,
        of_speeds: Option<&Resistance>,
        request: &Request,
    ) -> Option<Self> {
        let best = saturation_equations::explain(points, (losses, possible), excitation, motor, request)?;
        let is_told = |told: &&Resistance| {
            let (rs, error) = told.rs();
            2.0 * error <= TOLD * rs
        };
        let of_speeds = of_speeds.filter(is_told);
        // A loss beside terms of saturation bends to what these cannot describe: no voltage is taken off the fluxes for it, but as much is
        // in doubt.
        let of_terms = || {
            let errors = iter::once(best.rs_uncertainty).chain(best.losses.iter().map(|(value, error)| value.hypot(*error)));
            let values = iter::once(best.motor.rs.max(0.0)).chain(best.losses.iter().map(|_| 0.0));
            let covariance = DMatrix::from_diagonal(&DVector::from_vec(errors.map(|error| error * error).collect()));
            Resistance { values: values.collect(), covariance }
        };
        let told = of_speeds.cloned().unwrap_or_else(of_terms);
        let lost: Vec<Lost> = points.iter().enumerate().map(|point| Lost::of_unknowns(&told, possible, point)).collect();
        Some(Self { tells_rs: of_speeds.is_some(), ..Self::at((points, &lost), best.motor, told.rs(), request) })
    }

    /// What simulated currents with terms of saturation say of it, over these rows and at these operating points, given R_s with its
    /// standard error, ohm, and the drive's other numbers that were fitted.
    pub(crate) fn of_currents(
        log: &Log,
        drive: &Adjustable,
        (rs, beside): ((f64, f64), &[FaultEstimate]),
        stretches: &[Range<usize>],
        points: &[OperatingPoint],
        request: &Request,
    ) -> Self {
        let (motor, terms) = (Motor { rs: rs.0, ..drive.motor }, drive.faults.saturation);
        let drive = &Adjustable { motor, ..*drive };
        // The fluxes are those of the resistance that is the answer, and of voltages less what dead time takes, which points know less of.
        let columns = log.columns();
        let (start, end) = (columns.t[0], columns.t[columns.t.len() - 1]);
        let fluxes_at = |points: &[OperatingPoint]| {
            let middle = |point: &OperatingPoint| (0.5 * (point.time.0 + point.time.1) - start) / (end - start) - 0.5;
            let lost: Vec<Lost> =
                points.iter().map(|point| Lost::of_drive(drive, (rs.1, beside), point.current(), middle(point))).collect();
            Self::at((points, &lost), motor, rs, request)
        };
        let mut found = fluxes_at(points);
        // The frame stays the log's: an angle beside terms of saturation may stand for what these cannot describe. What it would move is
        // doubt.
        if let Some(turned) = in_magnets_frame(points, drive) {
            for (flux, turned) in found.fluxes.iter_mut().zip(fluxes_at(&turned).fluxes) {
                *flux = flux.zip(turned).map(|(flux, turned)| flux.or_as(&turned));
            }
            found.lq = ends_of_lq(&found.fluxes, LEAST_CURRENT * peak(points));
        }
        let (mut least, mut most) = (Apparent { current: f64::INFINITY, inductance: 0.0 }, Apparent { current: 0.0, inductance: 0.0 });
        for row in stretches.iter().cloned().flatten() {
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
        found
    }

    /// Whether the simulated currents have terms for it.
    pub(crate) fn is_of_currents(&self) -> bool {
        self.over_rows != [0.0; PARAMETERS]
    }

    /// The fluxes at the operating points, of whose voltages so much is lost, V, R_s (ohm) included.
    fn at(
        (points, lost): (&[OperatingPoint], &[Lost]),
        small_currents: Motor,
        (rs, rs_uncertainty): (f64, f64),
        request: &Request,
    ) -> Self {
        let psi_f = match request.known[Parameter::PsiF as usize] {
            Known::Fixed(value) | Known::Prior { value, .. } => Some(value),
            Known::Nothing => None,
        };
        let least = LEAST_CURRENT * peak(points);
        let flux = |(point, lost): (&OperatingPoint, &Lost)| {
            let (omega_e, u, i) = (point.omega_e(), point.voltage(), point.current());
            let noise = point.residual_covariance(&small_currents);
            let accuracy = request.voltage_accuracy * u.magnitude();
            let own = [0, 1].map(|axis: usize| noise[axis][axis].max(0.0).sqrt().hypot(accuracy) / omega_e.abs());
            let psi = Dq {
                d: (u.q - lost.volts.q - small_currents.lq * point.drift.q) / omega_e,
                q: (small_currents.ld * point.drift.d - (u.d - lost.volts.d)) / omega_e,
            };
            let own = Dq { d: own[1], q: own[0] };
            let flux = Flux {
                current: i,
                psi,
                uncertainty: Dq { d: own.d.hypot(lost.standard_error.q / omega_e), q: own.q.hypot(lost.standard_error.d / omega_e) },
                is_told: 2.0 * own.d <= TOLD * psi.d.abs() && 2.0 * own.q <= TOLD * psi.q.abs(),
                apparent_lq: (i.q.abs() > least && 2.0 * own.q <= TOLD * psi.q.abs()).then_some(psi.q / i.q),
                apparent_ld: psi_f.filter(|_| i.d.abs() > least).map(|psi_f| (psi.d - psi_f) / i.d),
            };
            [psi.d, psi.q, flux.uncertainty.d, flux.uncertainty.q].iter().all(|value| value.is_finite()).then_some(flux)
        };
        let fluxes: Vec<Option<Flux>> = points.iter().zip(lost).map(flux).collect();
        let lq = ends_of_lq(&fluxes, least);
        Self { rs, rs_uncertainty, tells_rs: false, fluxes, lq, small_currents, over_rows: [0.0; PARAMETERS] }
    }

    /// A finding with these fluxes, for tests.
    #[cfg(test)]
    pub(super) fn with_fluxes(fluxes: Vec<Option<Flux>>, small_currents: Motor) -> Self {
        let rs = small_currents.rs;
        Self { rs, rs_uncertainty: 0.0, tells_rs: false, fluxes, lq: None, small_currents, over_rows: [0.0; PARAMETERS] }
    }

    /// Standard uncertainty of an answer with constant parameters: so large that its 95 % intervals hold what every operating point, or
    /// row, would call the parameter.
    pub(crate) fn uncertainty(&self, answer: &Motor) -> [f64; PARAMETERS] {
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
        if self.tells_rs {
            spread[Parameter::Rs as usize] = 0.0;
        }
        spread.map(|spread| spread / QUANTILE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{faults::Faults, log::Columns};

    const MOTOR: Motor = Motor { rs: 0.03, ld: 20e-6, lq: 30e-6, psi_f: 9e-3 };

    /// Of three points at 15 A the one with the smallest error, not the one with the smallest current; of two at 35 A either way.
    #[test]
    fn of_points_at_one_load_the_surest_is_the_end() {
        let flux = |current: f64, inductance: f64, error: f64| {
            Some(Flux {
                current: Dq { d: 0.0, q: current },
                psi: Dq { d: 9e-3, q: inductance * current },
                uncertainty: Dq { d: 0.0, q: error },
                is_told: true,
                apparent_lq: Some(inductance),
                apparent_ld: None,
            })
        };
        let fluxes = [flux(14.98, 135e-6, 2e-4), flux(-15.0, 123e-6, 6e-5), flux(15.2, 130e-6, 1e-4), flux(35.0, 120e-6, 1e-4), None];
        let found = ends_of_lq(&fluxes, 1.75).unwrap().map(|end| (end.current, end.inductance));
        assert_eq!(found, [(-15.0, 123e-6), (35.0, 120e-6)]);
        assert!(ends_of_lq(&[None], 1.0).is_none());
    }

    /// An angle late by 20 us turns 0.3 to 0.45 mWb of the magnet's flux into a psi_q of 0.15 to 0.36 mWb, and 10 mohm of warming move
    /// psi_d by 0.01 mWb at the first and the last of three points: the 95 % intervals hold the motor's fluxes where the fault is known,
    /// and not where it acts and is unknown.
    #[test]
    fn fluxes_of_a_late_angle_and_of_a_warming_winding_hold() {
        const LATE: f64 = 20e-6;
        const WARMING: f64 = 0.01;
        assert_eq!(held(LATE, 0.0, true), 3);
        assert_eq!(held(LATE, 0.0, false), 0);
        assert_eq!(held(0.0, WARMING, true), 3);
        assert_eq!(held(0.0, WARMING, false), 1);
        assert_eq!(held(LATE, WARMING, true), 3);
    }

    /// How many of three points' fluxes are held, of a log whose angle is so late, s, and whose resistance grows so much, ohm.
    fn held(delay: f64, warming: f64, is_known: bool) -> usize {
        let modes = [(0.0, 5.0, 2000.0), (-8.0, 12.0, 2500.0), (3.0, 8.0, -1500.0)];
        let rows: Vec<_> = modes.iter().flat_map(|mode| [*mode; 10]).collect();
        let mut columns = Columns::default();
        for (k, &(d, q, omega_e)) in rows.iter().enumerate() {
            let place = k as f64 / (rows.len() - 1) as f64 - 0.5;
            let motor = Motor { rs: MOTOR.rs + warming * place, ..MOTOR };
            let (u, i) = (motor.steady_voltage(Dq { d, q }, omega_e).turned(delay * omega_e), Dq { d, q }.turned(delay * omega_e));
            columns.t.push(k as f64 * 1e-3);
            columns.ud.push(u.d);
            columns.uq.push(u.q);
            columns.id.push(i.d);
            columns.iq.push(i.q);
            columns.omega_e.push(omega_e);
        }
        let log = Log::new(columns).unwrap();
        let points: Vec<_> = (0..modes.len()).map(|w| OperatingPoint::measure(&log, 10 * w..10 * (w + 1), None)).collect();
        let mut faults = Faults::default();
        if is_known {
            (faults.angle_delay.time, faults.resistance_drift.change) = (delay, warming);
        }
        // Voltages to 1e-5 of themselves, which leaves the warming in sight.
        let request = Request { voltage_accuracy: 1e-5, ..Request::default() };
        let drive = Adjustable { motor: MOTOR, faults };
        let found = SaturationFinding::of_currents(&log, &drive, ((MOTOR.rs, 1e-5), &[]), &[], &points, &request);
        let is_held = |(flux, &(d, q, _)): (&Option<Flux>, &(f64, f64, f64))| {
            let Flux { psi, uncertainty, .. } = flux.unwrap();
            let off = [psi.d - MOTOR.psi_f - MOTOR.ld * d, psi.q - MOTOR.lq * q];
            off[0].abs() < QUANTILE * uncertainty.d && off[1].abs() < QUANTILE * uncertainty.q
        };
        found.fluxes.iter().zip(&modes).filter(|pair| is_held(*pair)).count()
    }
}

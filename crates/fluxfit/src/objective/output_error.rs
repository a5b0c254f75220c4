//! Output error: the currents of the adjustable motor against the measured ones.
//!
//! ```text
//! f(x) = sum_k |i(k) - î(k; x)|²,   x = (R_s, L_d, L_q, psi_f)
//! ```
//!
//! with `î` from equation (1), driven by the voltage that [acted](super::acting_voltage) over each period and integrated
//! [exactly](super::transition). It is the paper's Fig. 1 taken literally: the output of the real motor is compared with that of the
//! adjustable one. With known voltages and white measurement noise on the currents it is maximum likelihood, in closed loop too,
//! because a voltage depends on past samples only.
//!
//! The [adjustable drive](super::adjustable) may have [faults](crate::faults): what they do to voltages and measured currents is undone
//! before the comparison. With an observer's gain the simulated current is corrected from row to row, and what is compared is the
//! prediction of one row from the row before: the maximum likelihood where unknown voltages disturb the motor.
//!
//! A segment's first current and, of centred voltages, its first vector are not in the log; they are solved for inside, so that the cost
//! is the smallest over them.

use super::{acting_voltage::VoltageTiming, adjustable::Adjustable, angles::Angles, batch::Rows, simulated_segment::SimulatedSegment};
use crate::{
    error::{Error, ErrorKind},
    faults::{Acting, Faults},
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS},
    optimizer::Objective,
};
use std::ops::Range;

/// Fewest rows that a segment must have left.
const MIN_ROWS: usize = 10;

/// A rotor turns if it gets this far, rad: a sixth of a turn, after which the phases have changed places.
const LEAST_TURN: f64 = std::f64::consts::FRAC_PI_3;

/// The squared error of the simulated currents.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputError {
    simulated: Rows,
    rows: usize,
    /// Largest measured current vector, A.
    peak_current: f64,
    /// The faults of the drive whose motor a search looks for.
    held: Box<Faults>,
}

impl OutputError {
    /// The segments of a log that are long enough.
    ///
    /// # Errors
    /// As [`of_rows`](Self::of_rows).
    pub fn of(log: &Log, timing: VoltageTiming) -> Result<Self, Error> {
        let segments: Vec<_> = log.segments().iter().map(|segment| segment.rows.clone()).collect();
        Self::of_rows(log, &segments, timing)
    }

    /// Stretches of a log, none of them across a gap; those that are long enough.
    ///
    /// # Errors
    /// If none is, or if the log's channels were sampled at different instants.
    pub fn of_rows(log: &Log, stretches: &[Range<usize>], timing: VoltageTiming) -> Result<Self, Error> {
        let mut objectives = Self::under_readings(log, stretches, &[timing])?;
        Ok(objectives.remove(0).1)
    }

    /// The same under each of several readings of the voltages.
    ///
    /// # Errors
    /// As [`of_rows`](Self::of_rows).
    pub(crate) fn under_readings(
        log: &Log,
        stretches: &[Range<usize>],
        readings: &[VoltageTiming],
    ) -> Result<Vec<(VoltageTiming, Self)>, Error> {
        if log.is_interpolated() {
            return Err(ErrorKind::Interpolated.into());
        }
        let long_enough: Vec<Range<usize>> = stretches.iter().filter(|rows| rows.len() >= MIN_ROWS).cloned().collect();
        let stretches: Vec<(Range<usize>, Angles)> = long_enough.into_iter().map(|rows| (rows.clone(), Angles::of(log, &rows))).collect();
        // One after the other: in the memory of one thread, what one fit leaves is room for the next.
        readings.iter().map(|reading| Ok((*reading, Self::under_reading(log, &stretches, *reading)?))).collect()
    }

    fn under_reading(log: &Log, stretches: &[(Range<usize>, Angles)], timing: VoltageTiming) -> Result<Self, Error> {
        let least = MIN_ROWS + timing.lost_rows();
        let long_enough = stretches.iter().filter(|(rows, _)| rows.len() >= least);
        let segments: Vec<SimulatedSegment> = long_enough.map(|(rows, angles)| SimulatedSegment::of(log, rows, angles, timing)).collect();
        let rows = segments.iter().map(|segment| segment.measured.len()).sum();
        if rows == 0 {
            return Err(ErrorKind::TooShort { rows: log.rows(), least }.into());
        }
        let peak_current = segments.iter().flat_map(|segment| &segment.measured).map(|i| i.d * i.d + i.q * i.q).fold(0.0, f64::max).sqrt();
        Ok(Self { simulated: Rows::of(segments, timing.held()), rows, peak_current, held: Box::default() })
    }

    /// The same fitness of motors in a drive with these faults.
    pub fn holding(self, held: Faults) -> Self {
        Self { held: Box::new(held), ..self }
    }

    /// The same rows, if what acts between two means is averaged twice: over a row's span, and from row to row.
    pub(crate) fn averaging_twice(&self) -> Self {
        self.altered(SimulatedSegment::spread)
    }

    /// The same rows, if the voltage of each period were so many times what it is, given how far the rotor turns in it, rad.
    pub(crate) fn with_voltages_scaled(&self, factor: impl Fn(f64) -> f64) -> Self {
        self.altered(|segment| segment.scale_voltages(&factor))
    }

    /// The same rows, with the halves of periods in which the voltage changes weighed as this motor's currents do.
    pub(crate) fn with_halves_weighed(&self, motor: &Motor) -> Self {
        self.altered(|segment| segment.weigh_halves(motor))
    }

    fn altered(&self, alter: impl Fn(&mut SimulatedSegment)) -> Self {
        let mut segments = self.simulated.segments.clone();
        segments.iter_mut().for_each(alter);
        Self { simulated: Rows::of(segments, self.simulated.plan.held), ..self.clone() }
    }

    /// Rows whose currents are compared.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The same for each stretch.
    pub fn rows_per_segment(&self) -> Vec<usize> {
        self.simulated.segments.iter().map(|segment| segment.measured.len()).collect()
    }

    /// Rows of the log whose currents are compared, stretch by stretch.
    pub fn stretches(&self) -> impl Iterator<Item = Range<usize>> {
        self.simulated.segments.iter().map(|segment| segment.rows.clone())
    }

    /// Whether every stretch has its angle from the log: only then can effects in the stator's frame be distinguished from those in
    /// the rotor's.
    pub fn angle_known(&self) -> bool {
        self.simulated.segments.iter().all(|segment| segment.angle_known)
    }

    /// Whether the DC voltage is in the log.
    pub(crate) fn bus_known(&self) -> bool {
        self.simulated.segments.iter().all(|segment| segment.bus_known)
    }

    /// Whether the angle is known up to a constant that is the same for all stretches: it is in the log, or no gap lies between them.
    pub fn angle_traced(&self) -> bool {
        let segments = &self.simulated.segments;
        self.angle_known() || segments.windows(2).all(|pair| pair[0].log_segment == pair[1].log_segment)
    }

    /// Whether the rotor turns, by the speed: far enough for the phases to change their parts.
    pub fn turns(&self) -> bool {
        let turned: f64 = self.simulated.segments.iter().map(SimulatedSegment::turned).sum();
        turned > LEAST_TURN
    }

    /// Largest measured current vector, A.
    pub fn peak_current(&self) -> f64 {
        self.peak_current
    }

    /// Cost of one motor, A².
    pub fn cost(&self, motor: &Motor) -> f64 {
        self.cost_of(&Adjustable { motor: *motor, faults: *self.held })
    }

    /// Cost of one motor in an imperfect drive, A².
    pub fn cost_of(&self, drive: &Adjustable) -> f64 {
        self.simulated.costs(std::slice::from_ref(drive)).into_iter().sum()
    }

    /// The same of many drives at once.
    pub fn costs_of_all(&self, drives: &[Adjustable]) -> Vec<f64> {
        self.simulated.costs(drives)
    }

    /// Measured less simulated current, A: `d, q` of each row in turn.
    pub fn residuals(&self, drive: &Adjustable) -> Vec<f64> {
        self.residuals_of_all(std::slice::from_ref(drive)).into_iter().flatten().collect()
    }

    /// The same of many drives at once.
    pub fn residuals_of_all(&self, drives: &[Adjustable]) -> Vec<Vec<f64>> {
        self.simulated.residuals(drives).into_iter().map(|simulated| simulated.residuals).collect()
    }

    /// Simulated currents, A, row by row: the measured ones, faults undone, less the residuals.
    pub fn simulated(&self, drive: &Adjustable) -> Vec<Dq> {
        let residuals = self.residuals(drive);
        let (residuals, _) = residuals.as_chunks::<2>();
        let acting = Acting::of_one(&drive.faults, self.simulated.period);
        let speed =
            |segment: &SimulatedSegment, row: usize| segment.periods.get(row.saturating_sub(1)).map_or(0.0, |period| period.late_by);
        let rows = self.simulated.segments.iter().flat_map(|segment| {
            let rows = segment.measured.iter().zip(&segment.turns).enumerate();
            rows.map(move |(row, (measured, turn))| (*measured, *turn, speed(segment, row)))
        });
        let simulated = rows.zip(residuals).map(|((measured, turn, late_by), [d, q])| {
            let measured = acting.current(measured, turn, late_by);
            Dq { d: measured.d - d, q: measured.q - q }
        });
        simulated.collect()
    }

    /// What a volt on each axis over each period does to linear functions of the simulated currents; `d, q` per row are the weights of one
    /// function. One entry per period, stretch after stretch.
    pub fn by_voltage(&self, drive: &Adjustable, weights: &[Vec<f64>]) -> Vec<Vec<Dq>> {
        self.simulated.by_voltage(drive, weights)
    }

    /// Voltage (V), current at its start (A), speed (electrical rad/s) of each period, stretch after stretch.
    pub fn periods(&self) -> impl Iterator<Item = (Dq, Dq, f64)> {
        let of_segment = |segment: &SimulatedSegment| -> Vec<_> {
            segment.periods.iter().zip(&segment.measured).map(|(period, i)| (period.u, *i, period.omega_e)).collect()
        };
        self.simulated.segments.iter().flat_map(of_segment)
    }
}

impl Objective for OutputError {
    fn dimension(&self) -> usize {
        PARAMETERS
    }

    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
        let (candidates, _) = candidates.as_chunks::<PARAMETERS>();
        let drives = candidates.iter().map(|candidate| Adjustable { motor: Motor::from(*candidate), faults: *self.held });
        costs.copy_from_slice(&self.costs_of_all(&drives.collect::<Vec<_>>()));
    }
}

//! The rows of all tables, by kind, and what they can tell.

use super::{
    characteristic::Characteristic,
    direct_current::DirectCurrentRow,
    duty_cycle::DutyCycleRow,
    open_circuit::{Across, OpenCircuitRow, SQRT_3},
    short_circuit::{ShortCircuitRow, too_large_power},
    steady_points::SteadyPoint,
    torque_of_current::TorqueOfCurrentRow,
};
use crate::{
    error::{Error, ErrorKind},
    frames::Dq,
    motor::PARAMETERS,
};
use std::ops::Range;

/// What measured a column, or counted it. It prints as the error that no table shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Instrument {
    /// The drive, of its duty cycle: whether 1 is the largest circle of space vector modulation, or half the DC voltage.
    DutyScale,
    /// Of voltages.
    Voltage,
    /// Of currents.
    Current,
    /// Of torque.
    Torque,
}

impl Instrument {
    pub(super) const ALL: [Self; 4] = [Self::DutyScale, Self::Voltage, Self::Current, Self::Torque];
}

/// What is compared with the model; rows of one kind err alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residual {
    /// Voltages of open terminals, by their relative error.
    OpenVoltage,
    /// Currents of shorted terminals, by their relative error.
    ShortCurrent,
    /// Torques of shorted terminals, N m.
    ShortTorque,
    /// Torques of a current, N m.
    Torque,
    /// Voltages of a direct current, V of one phase.
    DirectVoltage,
    /// Voltages of duty cycles, V, amplitude of a phase.
    DutyVoltage,
    /// Voltages of operating points, V: all of d, then all of q.
    PointVoltage,
}

impl Residual {
    /// All of them.
    pub const ALL: [Self; RESIDUALS] = [
        Self::OpenVoltage,
        Self::ShortCurrent,
        Self::ShortTorque,
        Self::Torque,
        Self::DirectVoltage,
        Self::DutyVoltage,
        Self::PointVoltage,
    ];

    /// Whether it is a fraction of each value.
    pub fn is_relative(self) -> bool {
        matches!(self, Self::OpenVoltage | Self::ShortCurrent)
    }

    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::OpenVoltage => "voltages",
            Self::ShortCurrent => "currents",
            Self::ShortTorque | Self::Torque => "torques",
            Self::DirectVoltage => "voltages at rest",
            Self::DutyVoltage => "voltages of the duty cycles",
            Self::PointVoltage => "voltages of the operating points",
        }
    }
}

/// Number of kinds of residuals.
pub(super) const RESIDUALS: usize = 7;

/// What is fitted beside the motor, as part of the largest torque or voltage of its table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extra {
    /// Drag of the short circuit at standstill.
    Drag,
    /// How much more it is at the largest speed.
    DragOfSpeed,
    /// What the bench takes of the torque of a current.
    TorqueOffset,
    /// The torque of `p L_d - p L_q` at the largest product of the currents.
    Saliency,
    /// What contacts drop of a direct current.
    Drop,
    /// What switches lose of the duty's voltage.
    Lost,
    /// What an inverter loses of the voltages of operating points, against the current.
    LostOfPoints,
    /// The angle of their frame, as part of [`ANGLE_OF_POINTS`].
    AngleOfPoints,
    /// How much further their voltages are turned at the largest speed, as part of that.
    LagOfPoints,
}

/// Standard error of the angle of a table's frame, and of what its voltages lag at the largest speed, rad: an encoder is set to 3 degrees.
pub(super) const ANGLE_OF_POINTS: f64 = 0.05;

/// Fewest rows of a short-circuit characteristic: the motor and the drag have six numbers, and a row gives one or two.
const LEAST_SHORTED: usize = 6;

/// Fewest rows of another table whose scatter means anything.
const LEAST: usize = 3;

/// Fewest rows of duty cycles: flux, resistance, inductance and what the switches lose, and one more.
const LEAST_DUTY: usize = 5;

/// Fewest operating points, of two voltages each: the motor and what is lost are five numbers.
const LEAST_POINTS: usize = 4;

/// Most parts of a table that are left out in turn: enough for a standard error to a sixth of itself.
const MOST_PARTS: usize = 20;

/// The rows of all tables, by kind.
#[derive(Clone, Default)]
pub(super) struct Rows {
    /// Voltages line to line.
    pub(super) open: Vec<OpenCircuitRow>,
    pub(super) shorted: Vec<ShortCircuitRow>,
    pub(super) torque: Vec<TorqueOfCurrentRow>,
    /// Voltages of one phase.
    pub(super) direct: Vec<DirectCurrentRow>,
    pub(super) duty: Vec<DutyCycleRow>,
    pub(super) points: Vec<SteadyPoint>,
    /// Their inverter loses nothing: what it loses would be negative.
    pub(super) are_points_lossless: bool,
    /// Whether all tables state between which points their open-circuit voltages were measured.
    pub(super) are_voltages_stated: bool,
}

impl Rows {
    pub(super) fn of(tables: &[Characteristic]) -> Result<Self, Error> {
        let mut rows = Self { are_voltages_stated: true, ..Self::default() };
        for table in tables {
            match table {
                Characteristic::OpenCircuit(table) => {
                    let factor = table.across.unwrap_or(Across::Lines).to_lines();
                    rows.open.extend(table.rows.iter().map(|row| OpenCircuitRow { voltage: factor * row.voltage, ..*row }));
                    rows.are_voltages_stated &= table.across.is_some();
                }
                Characteristic::ShortCircuit(table) => rows.shorted.extend(&table.rows),
                Characteristic::TorqueOfCurrent(table) => rows.torque.extend(&table.rows),
                Characteristic::DirectCurrent(table) => {
                    let of_phase = |row: &DirectCurrentRow| DirectCurrentRow { voltage: row.voltage / table.across.phases(), ..*row };
                    rows.direct.extend(table.rows.iter().map(of_phase));
                }
                Characteristic::DutyCycle(table) => rows.duty.extend(&table.rows),
                Characteristic::SteadyPoints(table) => rows.points.extend(&table.rows),
            }
        }
        // Neighbours in speed or current err alike, whatever their order in the file; those of duty cycles are neighbours in time.
        rows.open.sort_by(|one, other| one.speed.abs().total_cmp(&other.speed.abs()));
        rows.shorted.sort_by(|one, other| one.speed.abs().total_cmp(&other.speed.abs()));
        rows.torque.sort_by(|one, other| one.current.q.total_cmp(&other.current.q));
        rows.direct.sort_by(|one, other| one.current.total_cmp(&other.current));
        let by_current = |one: &SteadyPoint, other: &SteadyPoint| one.current.q.total_cmp(&other.current.q);
        rows.points.sort_by(|one, other| by_current(one, other).then(one.current.d.total_cmp(&other.current.d)));
        let counts = [
            (rows.open.len(), LEAST, Residual::OpenVoltage),
            (rows.shorted.len(), LEAST_SHORTED, Residual::ShortCurrent),
            (rows.torque.len(), LEAST, Residual::Torque),
            (rows.direct.len(), LEAST, Residual::DirectVoltage),
            (rows.duty.len(), LEAST_DUTY, Residual::DutyVoltage),
            (rows.points.len(), LEAST_POINTS, Residual::PointVoltage),
        ];
        for (count, least, test) in counts {
            if (1..least).contains(&count) {
                return Err(match test {
                    Residual::Torque | Residual::DirectVoltage | Residual::PointVoltage => ErrorKind::FewCurrents { rows: count, least },
                    _ => ErrorKind::ShortCharacteristic { rows: count, least },
                }
                .into());
            }
        }
        if let Some(power) = too_large_power(&rows.shorted) {
            return Err(ErrorKind::CurrentOfLoad { power }.into());
        }
        let with_scale = [rows.open.len(), rows.torque.len(), rows.direct.len(), rows.duty.len(), rows.points.len()];
        let has_scale = rows.has_torque() || with_scale.iter().any(|rows| *rows > 0);
        if has_scale { Ok(rows) } else { Err(ErrorKind::NoScale.into()) }
    }

    /// Of each table all of what remains if a part of neighbouring rows is left out. Tables that are too short for it are kept whole.
    pub(super) fn without_parts(&self) -> Vec<Vec<Self>> {
        let parts = |count: usize, least: usize, drop: &dyn Fn(&mut Self, Range<usize>)| {
            let size = count.div_ceil(MOST_PARTS).max(1);
            let starts = (0..count).step_by(size).filter(|_| count >= least + size);
            starts
                .map(|first| {
                    let mut rest = self.clone();
                    drop(&mut rest, first..(first + size).min(count));
                    rest
                })
                .collect()
        };
        vec![
            parts(self.open.len(), LEAST, &|rest, part| drop(rest.open.drain(part))),
            parts(self.shorted.len(), LEAST_SHORTED, &|rest, part| drop(rest.shorted.drain(part))),
            parts(self.torque.len(), LEAST, &|rest, part| drop(rest.torque.drain(part))),
            parts(self.direct.len(), LEAST, &|rest, part| drop(rest.direct.drain(part))),
            parts(self.duty.len(), LEAST_DUTY, &|rest, part| drop(rest.duty.drain(part))),
            parts(self.points.len(), LEAST_POINTS, &|rest, part| drop(rest.points.drain(part))),
        ]
    }

    /// Open-circuit voltages times a factor.
    pub(super) fn with_voltages(&self, factor: f64) -> Self {
        let mut rows = self.clone();
        rows.open.iter_mut().for_each(|row| row.voltage *= factor);
        rows
    }

    /// Whether a short circuit has its torque.
    pub(super) fn has_torque(&self) -> bool {
        self.shorted.iter().any(|row| row.torque.is_some())
    }

    /// Whether a torque tells the flux, or the resistance that of a short circuit, whatever the open-circuit voltages are.
    pub(super) fn tells_flux(&self) -> bool {
        let has_heat = !(self.direct.is_empty() || self.shorted.is_empty());
        self.has_torque() || !self.torque.is_empty() || !self.points.is_empty() || has_heat
    }

    /// Whether some operating point is not at rest.
    fn do_points_turn(&self) -> bool {
        self.points.iter().any(|point| point.speed != 0.0)
    }

    /// The operating points alone.
    pub(super) fn points_alone(&self) -> Self {
        Self { points: self.points.clone(), are_points_lossless: self.are_points_lossless, are_voltages_stated: true, ..Self::default() }
    }

    /// Whether there are operating points and other rows.
    pub(super) fn has_points_and_others(&self) -> bool {
        let others = [self.open.len(), self.shorted.len(), self.torque.len(), self.direct.len(), self.duty.len()];
        !self.points.is_empty() && others.iter().any(|rows| *rows > 0)
    }

    fn has_current_of_duty(&self) -> bool {
        self.duty.iter().any(|row| row.current.is_some_and(|current| current != 0.0))
    }

    pub(super) fn has(&self, instrument: Instrument) -> bool {
        match instrument {
            Instrument::DutyScale => !self.duty.is_empty(),
            Instrument::Voltage => !(self.open.is_empty() && self.direct.is_empty() && self.duty.is_empty() && self.points.is_empty()),
            Instrument::Current => {
                !(self.shorted.is_empty() && self.torque.is_empty() && self.direct.is_empty() && self.points.is_empty())
                    || self.has_current_of_duty()
            }
            Instrument::Torque => self.has_torque() || !self.torque.is_empty(),
        }
    }

    /// The same with the error of an instrument: it reads 1 % too much, or a duty of 1 is not what it was taken for.
    pub(super) fn with_error_of(&self, instrument: Instrument) -> Self {
        const TOO_LARGE: f64 = 1.01;
        /// `u_dc / 2` in place of `u_dc / sqrt 3`.
        const HALF_OF_BUS: f64 = SQRT_3 / 2.0;
        let scaled = |vector: Dq| Dq { d: TOO_LARGE * vector.d, q: TOO_LARGE * vector.q };
        let mut rows = self.clone();
        match instrument {
            Instrument::DutyScale => rows.duty.iter_mut().for_each(|row| row.duty *= HALF_OF_BUS),
            Instrument::Voltage => {
                rows.open.iter_mut().for_each(|row| row.voltage *= TOO_LARGE);
                rows.direct.iter_mut().for_each(|row| row.voltage *= TOO_LARGE);
                rows.duty.iter_mut().for_each(|row| row.input_voltage *= TOO_LARGE);
                rows.points.iter_mut().for_each(|point| point.voltage = scaled(point.voltage));
            }
            Instrument::Current => {
                rows.shorted.iter_mut().for_each(|row| row.current *= TOO_LARGE);
                rows.direct.iter_mut().for_each(|row| row.current *= TOO_LARGE);
                rows.duty.iter_mut().for_each(|row| row.current = row.current.map(|current| TOO_LARGE * current));
                rows.torque.iter_mut().for_each(|row| row.current = scaled(row.current));
                rows.points.iter_mut().for_each(|point| point.current = scaled(point.current));
            }
            Instrument::Torque => {
                rows.shorted.iter_mut().for_each(|row| row.torque = row.torque.map(|torque| TOO_LARGE * torque));
                rows.torque.iter_mut().for_each(|row| row.torque *= TOO_LARGE);
            }
        }
        rows
    }

    /// Which numbers of the motor some table depends on.
    pub(super) fn free(&self) -> [bool; PARAMETERS] {
        let (shorted, duty, points) = (!self.shorted.is_empty(), self.has_current_of_duty(), !self.points.is_empty());
        let flux = shorted || self.do_points_turn() || !(self.open.is_empty() && self.torque.is_empty() && self.duty.is_empty());
        let [on_d, on_q] = [|i: Dq| i.d, |i: Dq| i.q].map(|on| self.points.iter().any(|point| point.speed * on(point.current) != 0.0));
        [shorted || duty || points || !self.direct.is_empty(), shorted || on_d, shorted || duty || on_q, flux]
    }

    /// What is fitted beside the motor.
    pub(super) fn extras(&self, with_drag: bool) -> Vec<Extra> {
        let is_salient = self.torque.iter().any(|row| row.current.d != 0.0);
        let extras = [
            (with_drag && self.has_torque(), Extra::Drag),
            (with_drag && self.has_torque(), Extra::DragOfSpeed),
            (!self.torque.is_empty(), Extra::TorqueOffset),
            (is_salient, Extra::Saliency),
            (!self.direct.is_empty(), Extra::Drop),
            (!self.duty.is_empty(), Extra::Lost),
            (!self.points.is_empty() && !self.are_points_lossless, Extra::LostOfPoints),
            (self.do_points_turn(), Extra::AngleOfPoints),
            (self.do_points_turn(), Extra::LagOfPoints),
        ];
        extras.into_iter().filter(|(is_fitted, _)| *is_fitted).map(|(_, extra)| extra).collect()
    }

    /// The unit in which a residual's error is counted: one, or the largest value of its table.
    pub(super) fn unit(&self, residual: Residual) -> f64 {
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |largest: f64, value| value.abs().max(largest));
        match residual {
            Residual::OpenVoltage | Residual::ShortCurrent => 1.0,
            Residual::ShortTorque => largest(&mut self.shorted.iter().filter_map(|row| row.torque)),
            Residual::Torque => largest(&mut self.torque.iter().map(|row| row.torque)),
            Residual::DirectVoltage => largest(&mut self.direct.iter().map(|row| row.voltage)),
            Residual::DutyVoltage => largest(&mut self.duty.iter().map(DutyCycleRow::voltage)),
            Residual::PointVoltage => largest(&mut self.points.iter().map(|point| point.voltage.magnitude())),
        }
    }

    pub(super) fn largest_speed(&self) -> f64 {
        self.shorted.iter().fold(0.0, |largest, row| row.speed.abs().max(largest))
    }

    /// The largest speed of an operating point, rad/s.
    pub(super) fn largest_speed_of_points(&self) -> f64 {
        self.points.iter().fold(0.0, |largest, point| point.speed.abs().max(largest))
    }

    /// The largest product of the currents of a torque, A².
    pub(super) fn largest_product(&self) -> f64 {
        self.torque.iter().fold(0.0, |largest, row| (row.current.d * row.current.q).abs().max(largest))
    }
}

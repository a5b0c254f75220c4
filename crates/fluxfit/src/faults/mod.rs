//! The faults of a drive: what stands between a motor and its log. A file per fault; here are the table of them, their common state,
//! and the order in which their effects are applied.
//!
//! Each file holds what its fault is and where that comes from, its state, its unknowns with their names, what it does to voltages or
//! currents, the starts of a fit, and what is physical. A further fault is a file, a field of [`Faults`], a variant of [`Fault`], a row
//! of the table, and a call where its effect belongs.

mod acting;
pub mod angle_delay;
pub mod angle_offset;
pub mod current_gains;
pub mod current_offset;
pub mod dead_time;
mod description;
pub mod disturbance;
pub mod filter;
pub mod flux_harmonics;
mod place;
pub mod resistance_drift;
pub mod saturation;
pub mod speed_lag;
pub mod voltage_lag;

pub(crate) use acting::{Acting, FaultKinds};
pub(crate) use dead_time::{USED_PART, carrier_half, switched_period::Winding};
pub(crate) use place::Place;

use crate::motor::Motor;
use angle_delay::AngleDelay;
use angle_offset::AngleOffset;
use current_gains::CurrentGains;
use current_offset::CurrentOffset;
use dead_time::DeadTime;
pub(crate) use description::AngleNeed;
use description::Names;
use disturbance::Disturbance;
use filter::Filter;
use flux_harmonics::FluxHarmonics;
use resistance_drift::ResistanceDrift;
use saturation::Saturation;
use speed_lag::SpeedLag;
use voltage_lag::VoltageLag;

/// The state of all faults. The default is a perfect drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Faults {
    /// Dead time and device drops.
    pub dead_time: DeadTime,
    /// Angle that is read too large.
    pub angle_offset: AngleOffset,
    /// Angle that is read late.
    pub angle_delay: AngleDelay,
    /// Voltages that lag behind their frame.
    pub voltage_lag: VoltageLag,
    /// What the current sensors read at zero.
    pub current_offset: CurrentOffset,
    /// Gains of the current sensors that differ.
    pub current_gains: CurrentGains,
    /// Filters of what is logged.
    pub filter: Filter,
    /// Speed that lags.
    pub speed_lag: SpeedLag,
    /// Harmonics of the flux.
    pub flux_harmonics: FluxHarmonics,
    /// A resistance that changes.
    pub resistance_drift: ResistanceDrift,
    /// Inductances that depend on the current.
    pub saturation: Saturation,
    /// Unknown voltages.
    pub disturbance: Disturbance,
}

/// A fault of the drive, or of the model of its motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Fault {
    /// Dead time and device drops.
    DeadTime,
    /// The same where the angle is not known.
    DeadTimeWithoutAngle,
    /// Device drops beside dead time.
    DeviceDrops,
    /// A DC voltage that is not logged, beside dead time.
    DcVoltage,
    /// Angle that is read too large.
    AngleOffset,
    /// Angle that is read late.
    AngleDelay,
    /// Voltages that lag behind their frame.
    VoltageLag,
    /// What the current sensors read at zero.
    CurrentOffset,
    /// Gains of three current sensors that differ.
    ThreeSensors,
    /// Gains of two current sensors that differ, in phases a and b.
    SensorsAb,
    /// The same in phases b and c.
    SensorsBc,
    /// The same in phases c and a.
    SensorsCa,
    /// Filter of the phase currents.
    CurrentFilter,
    /// Filter of the logged d and q currents.
    DqCurrentFilter,
    /// Filter of the logged d and q voltages.
    DqVoltageFilter,
    /// The same filter of both.
    DqFilter,
    /// Speed that lags.
    SpeedLag,
    /// Harmonics of the flux.
    FluxHarmonics,
    /// A resistance that changes.
    ResistanceDrift,
    /// Inductances that depend on the current.
    Saturation,
    /// Unknown voltages.
    Disturbance,
}

/// A number of a fault, which a fit may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FaultNumber {
    fault: Fault,
    /// Its place among the fault's numbers.
    place: usize,
}

/// A fault's description, with its state found among those of all faults.
struct Row {
    key: &'static str,
    label: &'static str,
    family: &'static str,
    angle: AngleNeed,
    alters_measured_current: bool,
    numbers: usize,
    names: fn(usize) -> Names,
    usual_size: fn(usize, &Motor, f64) -> f64,
    get: fn(&Faults, usize) -> f64,
    set: fn(&mut Faults, usize, f64),
    starts: fn(&Faults, f64) -> Vec<Faults>,
    kinds: fn(&Faults, f64) -> Vec<Faults>,
    is_physical: fn(&Faults, &Motor, f64) -> bool,
}

/// The row of a description whose state is this field of [`Faults`].
macro_rules! row {
    ($description:path, $state:ident) => {
        Row {
            key: $description.key,
            label: $description.label,
            family: $description.family,
            angle: $description.angle,
            alters_measured_current: $description.alters_measured_current,
            numbers: $description.numbers.len(),
            names: |place| $description.numbers[place].names,
            usual_size: |place, motor, peak| ($description.numbers[place].usual_size)(motor, peak),
            get: |faults, place| ($description.numbers[place].get)(&faults.$state),
            set: |faults, place, value| ($description.numbers[place].set)(&mut faults.$state, value),
            starts: |faults, peak| {
                let states = ($description.starts)(&faults.$state, peak);
                states.into_iter().map(|$state| Faults { $state, ..*faults }).collect()
            },
            kinds: |faults, peak| {
                let states = ($description.kinds)(&faults.$state, peak);
                states.into_iter().map(|$state| Faults { $state, ..*faults }).collect()
            },
            is_physical: |faults, motor, peak| ($description.is_physical)(&faults.$state, motor, peak),
        }
    };
}

impl Fault {
    /// All of them, in the order in which they are tried where they promise alike.
    pub const ALL: [Self; 21] = [
        Self::DeadTime,
        Self::DeadTimeWithoutAngle,
        Self::DeviceDrops,
        Self::DcVoltage,
        Self::AngleOffset,
        Self::AngleDelay,
        Self::VoltageLag,
        Self::CurrentOffset,
        Self::ThreeSensors,
        Self::SensorsAb,
        Self::SensorsBc,
        Self::SensorsCa,
        Self::CurrentFilter,
        Self::DqCurrentFilter,
        Self::DqVoltageFilter,
        Self::DqFilter,
        Self::SpeedLag,
        Self::FluxHarmonics,
        Self::ResistanceDrift,
        Self::Saturation,
        Self::Disturbance,
    ];

    /// The table.
    fn row(self) -> Row {
        match self {
            Self::DeadTime => row!(dead_time::FAULT, dead_time),
            Self::DeadTimeWithoutAngle => row!(dead_time::WITHOUT_ANGLE, dead_time),
            Self::DeviceDrops => row!(dead_time::DEVICE_DROPS, dead_time),
            Self::DcVoltage => row!(dead_time::DC_VOLTAGE, dead_time),
            Self::AngleOffset => row!(angle_offset::FAULT, angle_offset),
            Self::AngleDelay => row!(angle_delay::FAULT, angle_delay),
            Self::VoltageLag => row!(voltage_lag::FAULT, voltage_lag),
            Self::CurrentOffset => row!(current_offset::FAULT, current_offset),
            Self::ThreeSensors => row!(current_gains::THREE_SENSORS, current_gains),
            Self::SensorsAb => row!(current_gains::SENSORS_A_B, current_gains),
            Self::SensorsBc => row!(current_gains::SENSORS_B_C, current_gains),
            Self::SensorsCa => row!(current_gains::SENSORS_C_A, current_gains),
            Self::CurrentFilter => row!(filter::OF_PHASES, filter),
            Self::DqCurrentFilter => row!(filter::OF_CURRENTS, filter),
            Self::DqVoltageFilter => row!(filter::OF_VOLTAGES, filter),
            Self::DqFilter => row!(filter::OF_BOTH, filter),
            Self::SpeedLag => row!(speed_lag::FAULT, speed_lag),
            Self::FluxHarmonics => row!(flux_harmonics::FAULT, flux_harmonics),
            Self::ResistanceDrift => row!(resistance_drift::FAULT, resistance_drift),
            Self::Saturation => row!(saturation::FAULT, saturation),
            Self::Disturbance => row!(disturbance::FAULT, disturbance),
        }
    }

    /// Name in files.
    pub fn key(self) -> &'static str {
        self.row().key
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        self.row().label
    }

    /// Short name, shared with the faults that explain the same: at most one of them is part of an answer.
    pub fn family(self) -> &'static str {
        self.row().family
    }

    /// Whether it is a filter of what is logged.
    pub(crate) fn is_filter(self) -> bool {
        matches!(self, Self::CurrentFilter | Self::DqCurrentFilter | Self::DqVoltageFilter | Self::DqFilter)
    }

    /// Whether one is not looked for beside the other: they explain the same, or both hold the logged voltages back or bring them early, as
    /// a filter of them does and a lag.
    pub(crate) fn excludes(self, other: Self) -> bool {
        let shifts_voltages = |fault: Self| matches!(fault, Self::DqFilter | Self::DqVoltageFilter | Self::VoltageLag);
        self.family() == other.family() || shifts_voltages(self) && shifts_voltages(other)
    }

    /// Whether only a rotor that turns shows it: at rest it passes for other values of the motor's parameters, or for dead time.
    pub(crate) fn needs_turning(self) -> bool {
        matches!(
            self,
            Self::AngleOffset
                | Self::AngleDelay
                | Self::VoltageLag
                | Self::CurrentOffset
                | Self::SpeedLag
                | Self::FluxHarmonics
                | Self::ThreeSensors
                | Self::SensorsAb
                | Self::SensorsBc
                | Self::SensorsCa
        )
    }

    /// What it needs of the electrical angle.
    pub(crate) fn angle_need(self) -> AngleNeed {
        self.row().angle
    }

    /// Whether the logged currents differ from the motor's by it.
    pub fn alters_measured_current(self) -> bool {
        self.row().alters_measured_current
    }

    /// Its numbers.
    pub fn numbers(self) -> impl Iterator<Item = FaultNumber> {
        (0..self.row().numbers).map(move |place| FaultNumber { fault: self, place })
    }

    /// The states from which a fit begins, given the largest measured current, A.
    pub(crate) fn starts(self, faults: &Faults, peak: f64) -> Vec<Faults> {
        (self.row().starts)(faults, peak)
    }

    /// What it is now, once as each of the kinds that it has; none if there is but one.
    pub(crate) fn kinds(self, faults: &Faults, peak: f64) -> Vec<Faults> {
        (self.row().kinds)(faults, peak)
    }

    /// Whether its values are possible in a real drive with this motor, given the largest measured current, A.
    pub(crate) fn is_physical(self, faults: &Faults, motor: &Motor, peak: f64) -> bool {
        (self.row().is_physical)(faults, motor, peak)
    }
}

impl FaultNumber {
    /// Whose it is.
    pub fn fault(self) -> Fault {
        self.fault
    }

    /// Name in files.
    pub fn key(self) -> &'static str {
        self.names().key
    }

    /// Name in prose.
    pub fn label(self) -> &'static str {
        self.names().label
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        self.names().unit
    }

    /// The values that are possible, SI: a part of something is from 0 to 1. A fit may pass these limits by its uncertainty.
    pub fn possible(self) -> [f64; 2] {
        if filter::is_part(self.key()) { [0.0, 1.0] } else { [f64::NEG_INFINITY, f64::INFINITY] }
    }

    fn names(self) -> Names {
        (self.fault.row().names)(self.place)
    }

    /// The unit in which a fit counts its steps, SI: its usual size beside this motor and the largest measured current, A.
    pub(crate) fn usual_size(self, motor: &Motor, peak: f64) -> f64 {
        (self.fault.row().usual_size)(self.place, motor, peak)
    }
}

impl Faults {
    /// The value of a number, SI.
    pub fn get(&self, number: FaultNumber) -> f64 {
        (number.fault.row().get)(self, number.place)
    }

    /// Sets the value of a number, SI.
    pub fn set(&mut self, number: FaultNumber, value: f64) {
        (number.fault.row().set)(self, number.place, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Turn;
    use std::collections::HashSet;

    #[test]
    fn a_number_that_is_set_is_got() {
        for number in Fault::ALL.into_iter().flat_map(Fault::numbers) {
            let mut faults = Faults::default();
            assert_eq!(faults.get(number), 0.0, "{}", number.key());
            faults.set(number, 0.25);
            assert!((faults.get(number) - 0.25).abs() < 1e-15, "{}", number.key());
        }
    }

    /// Files know faults and numbers by their keys.
    #[test]
    fn keys_are_unique() {
        let faults: HashSet<_> = Fault::ALL.into_iter().map(Fault::key).collect();
        assert_eq!(faults.len(), Fault::ALL.len());
        // Faults of a family may share a number: only one of them is part of an answer.
        let numbers: Vec<_> = Fault::ALL.into_iter().flat_map(Fault::numbers).collect();
        for (place, one) in numbers.iter().enumerate() {
            let other = numbers[..place].iter().find(|other| other.key() == one.key());
            assert!(
                other.is_none_or(|other| other.fault().family() == one.fault().family() && other.label() == one.label()),
                "{}",
                one.key()
            );
        }
    }

    /// An angle that is 100 us late at 2000 rad/s lies 0.2 rad behind; what the flux's harmonics induce is that of the magnet's angle.
    #[test]
    fn harmonics_lie_by_the_magnet_where_the_angle_is_late() {
        let place = |behind: f64| {
            let [start, middle, end] = [0.1, 0.2, 0.3].map(|angle| Turn::by(angle - behind));
            Place { start, middle, end, length: 1e-4, omega_e: 2000.0, rotor_late_by: 2000.0, ..Place::still(middle) }
        };
        let induced = |time: f64, behind: f64| {
            let flux_harmonics = FluxHarmonics { d: [0.01, 0.002], q: [-0.003, 0.008] };
            let acting = Acting::of_one(&Faults { flux_harmonics, angle_delay: AngleDelay { time }, ..Faults::default() }, 1e-4);
            acting.beside([0.0; 2], [1.0, 2.0], [0.1, 0.2], &place(behind))
        };
        let (found, expected) = (induced(1e-4, 0.2), induced(0.0, 0.0));
        assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-6, "{found:?} {expected:?}");
        assert!((found[0] - induced(0.0, 0.2)[0]).abs() > 1.0);
    }

    /// Faults that can be found together leave each other's numbers alone, in whichever order a fit sets them.
    #[test]
    fn faults_share_no_number_unless_they_exclude_each_other() {
        for (one, other) in Fault::ALL.into_iter().flat_map(|one| Fault::ALL.map(|other| (one, other))) {
            if one.excludes(other) {
                continue;
            }
            for (number, of_other) in one.numbers().flat_map(|number| other.numbers().map(move |of_other| (number, of_other))) {
                let mut faults = Faults::default();
                faults.set(number, 0.25);
                faults.set(of_other, 0.5);
                assert_eq!(faults.get(number), 0.25, "{} beside {}", number.key(), of_other.key());
            }
        }
        assert!(Fault::DqFilter.excludes(Fault::DqVoltageFilter) && !Fault::DqCurrentFilter.excludes(Fault::DqVoltageFilter));
    }

    /// A fit of each begins with finite steps, and a drive without a fault is changed by no fault.
    #[test]
    fn a_perfect_drive_is_left_alone() {
        let (motor, i, faults) = (Motor { rs: 1.0, ld: 5e-3, lq: 12e-3, psi_f: 0.1 }, [-2.0, 5.0], Faults::default());
        assert!(Fault::ALL.into_iter().flat_map(Fault::numbers).all(|number| number.usual_size(&motor, 10.0) > 0.0));
        let place = Place {
            half: 1.0,
            changes: None,
            start: Turn::by(0.1),
            middle: Turn::by(0.2),
            end: Turn::by(0.3),
            length: 1e-4,
            omega_e: 2000.0,
            acceleration: 100.0,
            late_by: 2000.0,
            rotor_late_by: 2000.0,
            angle_acceleration: 100.0,
            advance_per_lag: 0.1,
            per_bus: 0.01,
            time: 0.25,
        };
        // Also where other lanes have faults of every kind.
        let kinds = FaultKinds::ALL;
        for kinds in [FaultKinds::of(&faults), kinds] {
            let acting = Acting::of(kinds, 1e-4, |number| number(&faults));
            assert_eq!(acting.motor_current(i, place.start, place.late_by), i);
            assert_eq!(acting.commanded_voltage(i, i, &place), i);
            assert_eq!(acting.lost(i, [i, i], &Winding::of(1.0, i), &place), [0.0; 2]);
            assert_eq!(acting.beside([0.0; 2], i, [0.1, 0.2], &place), [0.0; 2]);
            assert_eq!(acting.filtered(i, [i, i], [0.0; 2], &Place { end: place.start, ..place }), i);
            assert_eq!(acting.extra_flux(i), [0.0; 2]);
            assert_eq!((acting.corrected(i, i, [1.0; 2]), acting.remaining(i, i)), ([i, i], [i, i]));
        }
    }
}

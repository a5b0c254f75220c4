//! Units that a column of a log may have.

use crate::quantity::Dimension;
use std::f64::consts::{PI, SQRT_2, TAU};

/// A unit that a column of a log may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// s.
    Second,
    /// ms.
    Millisecond,
    /// us.
    Microsecond,
    /// ns.
    Nanosecond,
    /// V.
    Volt,
    /// mV.
    Millivolt,
    /// kV.
    Kilovolt,
    /// A.
    Ampere,
    /// mA.
    Milliampere,
    /// kA.
    Kiloampere,
    /// Root mean square of a phase's voltage, where the voltage itself is its peak value.
    VoltRms,
    /// The same of a current.
    AmpereRms,
    /// Electrical rad/s.
    RadianPerSecond,
    /// Electrical r/min.
    RpmElectrical,
    /// Mechanical r/min.
    RpmMechanical,
    /// A thousand electrical r/min.
    KrpmElectrical,
    /// A thousand mechanical r/min.
    KrpmMechanical,
    /// Mechanical rad/s.
    RadianPerSecondMechanical,
    /// Electrical turns in a second.
    HertzElectrical,
    /// Mechanical turns in a second.
    HertzMechanical,
    /// Electrical degrees in a second.
    DegreePerSecond,
    /// Mechanical degrees in a second.
    DegreePerSecondMechanical,
    /// Electrical rad.
    Radian,
    /// Electrical degrees.
    Degree,
    /// Mechanical rad.
    RadianMechanical,
    /// Mechanical degrees.
    DegreeMechanical,
    /// degC.
    Celsius,
    /// No unit: a plain number.
    Number,
}

impl Unit {
    /// All of them; of each dimension the SI unit first.
    pub const ALL: [Self; 28] = [
        Self::Second,
        Self::Millisecond,
        Self::Microsecond,
        Self::Nanosecond,
        Self::Volt,
        Self::Millivolt,
        Self::Kilovolt,
        Self::VoltRms,
        Self::Ampere,
        Self::Milliampere,
        Self::Kiloampere,
        Self::AmpereRms,
        Self::RadianPerSecond,
        Self::RpmElectrical,
        Self::RpmMechanical,
        Self::RadianPerSecondMechanical,
        Self::HertzElectrical,
        Self::HertzMechanical,
        Self::KrpmElectrical,
        Self::KrpmMechanical,
        Self::DegreePerSecond,
        Self::DegreePerSecondMechanical,
        Self::Radian,
        Self::Degree,
        Self::RadianMechanical,
        Self::DegreeMechanical,
        Self::Celsius,
        Self::Number,
    ];

    /// Short name, name in a sentence, dimension, and size in SI units (of mechanical units: for one pole pair).
    fn properties(self) -> (&'static str, &'static str, Dimension, f64) {
        match self {
            Self::Second => ("s", "s", Dimension::Time, 1.0),
            Self::Millisecond => ("ms", "ms", Dimension::Time, 1e-3),
            Self::Microsecond => ("us", "us", Dimension::Time, 1e-6),
            Self::Nanosecond => ("ns", "ns", Dimension::Time, 1e-9),
            Self::Volt => ("V", "V", Dimension::Voltage, 1.0),
            Self::Millivolt => ("mV", "mV", Dimension::Voltage, 1e-3),
            Self::Kilovolt => ("kV", "kV", Dimension::Voltage, 1e3),
            Self::VoltRms => ("Vrms", "V rms", Dimension::Voltage, SQRT_2),
            Self::Ampere => ("A", "A", Dimension::Current, 1.0),
            Self::Milliampere => ("mA", "mA", Dimension::Current, 1e-3),
            Self::Kiloampere => ("kA", "kA", Dimension::Current, 1e3),
            Self::AmpereRms => ("Arms", "A rms", Dimension::Current, SQRT_2),
            Self::RadianPerSecond => ("rad/s", "electrical rad/s", Dimension::Speed, 1.0),
            Self::RpmElectrical => ("rpm-elec", "electrical r/min", Dimension::Speed, TAU / 60.0),
            Self::RpmMechanical => ("rpm-mech", "mechanical r/min", Dimension::Speed, TAU / 60.0),
            Self::KrpmElectrical => ("krpm-elec", "thousand electrical r/min", Dimension::Speed, 1e3 * TAU / 60.0),
            Self::KrpmMechanical => ("krpm-mech", "thousand mechanical r/min", Dimension::Speed, 1e3 * TAU / 60.0),
            Self::RadianPerSecondMechanical => ("rad/s-mech", "mechanical rad/s", Dimension::Speed, 1.0),
            Self::HertzElectrical => ("Hz-elec", "electrical Hz", Dimension::Speed, TAU),
            Self::HertzMechanical => ("Hz-mech", "mechanical Hz", Dimension::Speed, TAU),
            Self::DegreePerSecond => ("deg/s", "electrical degrees a second", Dimension::Speed, PI / 180.0),
            Self::DegreePerSecondMechanical => ("deg/s-mech", "mechanical degrees a second", Dimension::Speed, PI / 180.0),
            Self::Radian => ("rad", "electrical rad", Dimension::Angle, 1.0),
            Self::Degree => ("deg", "electrical degrees", Dimension::Angle, PI / 180.0),
            Self::RadianMechanical => ("rad-mech", "mechanical rad", Dimension::Angle, 1.0),
            Self::DegreeMechanical => ("deg-mech", "mechanical degrees", Dimension::Angle, PI / 180.0),
            Self::Celsius => ("degC", "degC", Dimension::Temperature, 1.0),
            Self::Number => ("1", "1", Dimension::Ratio, 1.0),
        }
    }

    /// Short name, as arguments and mapping files write it.
    pub fn name(self) -> &'static str {
        self.properties().0
    }

    /// Name in a sentence.
    pub fn prose(self) -> &'static str {
        self.properties().1
    }

    /// The dimension.
    pub fn dimension(self) -> Dimension {
        self.properties().2
    }

    /// Whether the number of pole pairs is needed to convert it to electrical quantities.
    pub fn is_mechanical(self) -> bool {
        self.properties().0.ends_with("-mech")
    }

    /// The electrical unit that corresponds to one of the shaft; `electrical rad/s` for all others.
    pub fn electrical(self) -> Self {
        match self {
            Self::RpmMechanical => Self::RpmElectrical,
            Self::KrpmMechanical => Self::KrpmElectrical,
            Self::HertzMechanical => Self::HertzElectrical,
            Self::DegreePerSecondMechanical => Self::DegreePerSecond,
            Self::RadianMechanical => Self::Radian,
            Self::DegreeMechanical => Self::Degree,
            _ => Self::RadianPerSecond,
        }
    }

    /// The unit of the shaft that corresponds to an electrical one; rad/s of the shaft for all others.
    pub fn of_shaft(self) -> Self {
        match self {
            Self::RpmElectrical => Self::RpmMechanical,
            Self::KrpmElectrical => Self::KrpmMechanical,
            Self::HertzElectrical => Self::HertzMechanical,
            Self::DegreePerSecond => Self::DegreePerSecondMechanical,
            Self::Radian => Self::RadianMechanical,
            Self::Degree => Self::DegreeMechanical,
            _ => Self::RadianPerSecondMechanical,
        }
    }

    /// Whether it is that of a root mean square, which only vectors of the dq frame can be in: of these a value is the peak of the phases.
    pub fn is_rms(self) -> bool {
        matches!(self, Self::VoltRms | Self::AmpereRms)
    }

    /// Its size in SI units; of mechanical units, for one pole pair.
    pub fn in_si(self) -> f64 {
        self.properties().3
    }

    /// Units of `dimension`, SI first.
    pub fn of(dimension: Dimension) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |unit| unit.dimension() == dimension)
    }

    /// The unit with this short name; `erpm` is `rpm-elec`.
    pub fn from_name(name: &str, dimension: Dimension) -> Option<Self> {
        let name = if name.eq_ignore_ascii_case("erpm") { "rpm-elec" } else { name };
        Self::of(dimension).find(|unit| unit.name().eq_ignore_ascii_case(name))
    }

    /// Converts values to SI units, in place.
    pub fn to_si(self, values: &mut [f64], pole_pairs: u32) {
        let factor = self.properties().3 * if self.is_mechanical() { f64::from(pole_pairs) } else { 1.0 };
        if [1e-3, 1e-6, 1e-9].contains(&factor) {
            // Dividing by a thousand is exact where multiplying by 0.001 is not.
            let divisor = factor.recip().round();
            values.iter_mut().for_each(|value| *value /= divisor);
        } else if factor != 1.0 {
            values.iter_mut().for_each(|value| *value *= factor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_become_si() {
        let si = |unit: Unit| {
            let mut values = [300.0];
            unit.to_si(&mut values, 4);
            values[0]
        };
        assert_eq!(si(Unit::Millisecond), 0.3);
        assert_eq!(si(Unit::Volt), 300.0);
        assert_eq!((si(Unit::Kilovolt), si(Unit::Kiloampere)), (300e3, 300e3));
        assert!((si(Unit::KrpmMechanical) - 1e3 * si(Unit::RpmMechanical)).abs() < 1e-8);
        assert_eq!(si(Unit::AmpereRms), 300.0 * SQRT_2);
        assert_eq!(si(Unit::RpmElectrical), 300.0 * (TAU / 60.0));
        assert_eq!(si(Unit::RpmMechanical), 300.0 * (TAU / 60.0 * 4.0));
        assert_eq!(si(Unit::HertzMechanical), 300.0 * (TAU * 4.0));
        assert_eq!(si(Unit::DegreeMechanical), 300.0 * (PI / 180.0 * 4.0));
        // 360 degrees a second are one turn a second.
        assert!((si(Unit::DegreePerSecond) * 360.0 - si(Unit::HertzElectrical)).abs() < 1e-8);
        assert!((si(Unit::DegreePerSecondMechanical) * 360.0 - si(Unit::HertzMechanical)).abs() < 1e-8);
    }

    #[test]
    fn every_unit_is_found_by_its_name() {
        for unit in Unit::ALL {
            assert_eq!(Unit::from_name(unit.name(), unit.dimension()), Some(unit));
        }
        assert_eq!(Unit::from_name("ERPM", Dimension::Speed), Some(Unit::RpmElectrical));
        assert_eq!(Unit::from_name("rpm", Dimension::Speed), None);
        assert_eq!(Unit::of(Dimension::Inductance).count(), 0);
    }
}

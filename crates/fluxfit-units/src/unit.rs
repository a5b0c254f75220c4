//! Units of a log's columns: given with `--unit omega=rpm-mech`, or named by the header, as in `speed_rpm` or `ud [mV]`.

use crate::quantity::Dimension;
use std::f64::consts::{PI, TAU};

/// A unit that a column of a log may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// s.
    Second,
    /// ms.
    Millisecond,
    /// us.
    Microsecond,
    /// V.
    Volt,
    /// mV.
    Millivolt,
    /// A.
    Ampere,
    /// mA.
    Milliampere,
    /// Electrical rad/s.
    RadianPerSecond,
    /// Electrical r/min.
    RpmElectrical,
    /// Mechanical r/min.
    RpmMechanical,
    /// Mechanical rad/s.
    RadianPerSecondMechanical,
    /// Electrical turns in a second.
    HertzElectrical,
    /// Mechanical turns in a second.
    HertzMechanical,
    /// Electrical rad.
    Radian,
    /// Electrical degrees.
    Degree,
    /// Mechanical rad.
    RadianMechanical,
    /// Mechanical degrees.
    DegreeMechanical,
    /// Without a unit.
    Number,
}

/// Whether a header says which speed or angle it means.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Mechanical,
    Electrical,
    Unsaid,
}

/// What a header says about its column's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Named<'a> {
    /// This unit.
    Unit(Unit),
    /// Something that stands where a unit stands, and is none of the column's dimension.
    Unknown(&'a str),
    /// Nothing.
    Nothing,
}

impl Unit {
    /// All of them; of each dimension the SI unit first.
    pub const ALL: [Self; 18] = [
        Self::Second,
        Self::Millisecond,
        Self::Microsecond,
        Self::Volt,
        Self::Millivolt,
        Self::Ampere,
        Self::Milliampere,
        Self::RadianPerSecond,
        Self::RpmElectrical,
        Self::RpmMechanical,
        Self::RadianPerSecondMechanical,
        Self::HertzElectrical,
        Self::HertzMechanical,
        Self::Radian,
        Self::Degree,
        Self::RadianMechanical,
        Self::DegreeMechanical,
        Self::Number,
    ];

    /// Name on the command line, name in prose, dimension, SI units in one (of mechanical units: for one pole pair).
    fn facts(self) -> (&'static str, &'static str, Dimension, f64) {
        match self {
            Self::Second => ("s", "s", Dimension::Time, 1.0),
            Self::Millisecond => ("ms", "ms", Dimension::Time, 1e-3),
            Self::Microsecond => ("us", "us", Dimension::Time, 1e-6),
            Self::Volt => ("V", "V", Dimension::Voltage, 1.0),
            Self::Millivolt => ("mV", "mV", Dimension::Voltage, 1e-3),
            Self::Ampere => ("A", "A", Dimension::Current, 1.0),
            Self::Milliampere => ("mA", "mA", Dimension::Current, 1e-3),
            Self::RadianPerSecond => ("rad/s", "electrical rad/s", Dimension::Speed, 1.0),
            Self::RpmElectrical => ("rpm-elec", "electrical r/min", Dimension::Speed, TAU / 60.0),
            Self::RpmMechanical => ("rpm-mech", "mechanical r/min", Dimension::Speed, TAU / 60.0),
            Self::RadianPerSecondMechanical => ("rad/s-mech", "mechanical rad/s", Dimension::Speed, 1.0),
            Self::HertzElectrical => ("Hz-elec", "electrical Hz", Dimension::Speed, TAU),
            Self::HertzMechanical => ("Hz-mech", "mechanical Hz", Dimension::Speed, TAU),
            Self::Radian => ("rad", "electrical rad", Dimension::Angle, 1.0),
            Self::Degree => ("deg", "electrical degrees", Dimension::Angle, PI / 180.0),
            Self::RadianMechanical => ("rad-mech", "mechanical rad", Dimension::Angle, 1.0),
            Self::DegreeMechanical => ("deg-mech", "mechanical degrees", Dimension::Angle, PI / 180.0),
            Self::Number => ("1", "1", Dimension::Ratio, 1.0),
        }
    }

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Name in a sentence.
    pub fn prose(self) -> &'static str {
        self.facts().1
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        self.facts().2
    }

    /// Whether pole pairs are needed to make it electrical.
    pub fn is_mechanical(self) -> bool {
        self.facts().0.ends_with("-mech")
    }

    /// Units of `dimension`, SI first.
    pub fn of(dimension: Dimension) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |unit| unit.dimension() == dimension)
    }

    /// The unit called `name` on the command line; `erpm` is `rpm-elec`.
    pub fn from_name(name: &str, dimension: Dimension) -> Option<Self> {
        let name = if name.eq_ignore_ascii_case("erpm") { "rpm-elec" } else { name };
        Self::of(dimension).find(|unit| unit.name().eq_ignore_ascii_case(name))
    }

    /// Turns values into SI units, in place.
    pub fn to_si(self, values: &mut [f64], pole_pairs: u32) {
        let factor = self.facts().3 * if self.is_mechanical() { f64::from(pole_pairs) } else { 1.0 };
        if factor == 1e-3 || factor == 1e-6 {
            // Dividing by a thousand is exact where multiplying by 0.001 is not.
            let divisor = factor.recip().round();
            values.iter_mut().for_each(|value| *value /= divisor);
        } else if factor != 1.0 {
            values.iter_mut().for_each(|value| *value *= factor);
        }
    }

    /// The unit that a piece of a header spells. Upper and lower case do not matter: `ID_MA` is not in megaamperes.
    fn spelled(text: &str, dimension: Dimension, side: Side) -> Option<Self> {
        let text = text.trim().to_lowercase();
        let either = |electrical, mechanical, unsaid| match side {
            Side::Electrical => electrical,
            Side::Mechanical => mechanical,
            Side::Unsaid => unsaid,
        };
        let unit = match text.as_str() {
            "s" | "sec" | "seconds" => Self::Second,
            // `ms_today` is the clock of a VESC's log.
            "ms" | "msec" | "ms_today" => Self::Millisecond,
            "us" | "µs" | "μs" | "usec" => Self::Microsecond,
            "v" | "volt" | "volts" => Self::Volt,
            "mv" => Self::Millivolt,
            "a" | "amp" | "amps" | "ampere" => Self::Ampere,
            "ma" => Self::Milliampere,
            "erpm" => Self::RpmElectrical,
            // Drives that mean electrical revolutions say so; shafts don't say that they are shafts.
            "rpm" | "r/min" | "1/min" | "min-1" => either(Self::RpmElectrical, Self::RpmMechanical, Self::RpmMechanical),
            "rad/s" | "rad_s" | "rad.s" | "rads" | "rad_per_s" | "radps" => {
                either(Self::RadianPerSecond, Self::RadianPerSecondMechanical, Self::RadianPerSecond)
            }
            "hz" => either(Self::HertzElectrical, Self::HertzMechanical, Self::HertzElectrical),
            "rad" => either(Self::Radian, Self::RadianMechanical, Self::Radian),
            "deg" | "degree" | "degrees" | "°" => either(Self::Degree, Self::DegreeMechanical, Self::Degree),
            _ => return Self::from_name(&text, dimension),
        };
        (unit.dimension() == dimension).then_some(unit)
    }
}

/// The name in a header without its unit, and what the header says about the unit. A unit stands in brackets or after `@` at the
/// end, or after the last `_` or space; only in the first two places is it an error that it is not known: `uq_s` may well be the
/// q voltage of the stator.
pub fn in_header(header: &str, dimension: Dimension) -> (&str, Named<'_>) {
    let header = header.trim();
    let side = side(header);
    let brackets = [('[', ']'), ('(', ')')].into_iter().find_map(|(open, close)| {
        let at = header.strip_suffix(close)?.rfind(open)?;
        Some((&header[..at], &header[at + 1..header.len() - 1]))
    });
    if let Some((name, text)) = brackets.or_else(|| header.rsplit_once('@')) {
        let unit = Unit::spelled(text, dimension, side);
        return (name.trim_end_matches([' ', '_']), unit.map_or(Named::Unknown(text), Named::Unit));
    }
    // From the left: of `speed_rad_s` the unit is `rad_s`.
    for (at, _) in header.match_indices(['_', ' ']) {
        if let Some(unit) = Unit::spelled(&header[at + 1..], dimension, side) {
            return (header[..at].trim_end_matches([' ', '_']), Named::Unit(unit));
        }
    }
    // A header that is a unit and nothing else; one letter is more likely a phase.
    match Unit::spelled(header, dimension, side) {
        Some(unit) if header.len() > 1 => ("", Named::Unit(unit)),
        _ => (header, Named::Nothing),
    }
}

/// What a unit of a row of units, or of a container, says of a column with this name.
pub fn in_units_row<'a>(text: &'a str, header: &str, dimension: Dimension) -> Named<'a> {
    let bare = text.trim().trim_matches(['[', ']', '(', ')']);
    let side = match (side(text), side(header)) {
        (Side::Unsaid, of_header) => of_header,
        (of_text, _) => of_text,
    };
    Unit::spelled(bare, dimension, side).map_or(Named::Unknown(text), Named::Unit)
}

/// Whether a header says that it is electrical rather than leaving it to custom.
pub fn says_electrical(header: &str) -> bool {
    side(header) == Side::Electrical
}

fn side(header: &str) -> Side {
    let lower = header.to_lowercase();
    let words = || lower.split(|c: char| !c.is_alphanumeric());
    let electrical = lower.contains("elec") || lower.contains("erpm") || words().any(|word| matches!(word, "e" | "el"));
    match (lower.contains("mech"), electrical) {
        (true, false) => Side::Mechanical,
        (false, true) => Side::Electrical,
        _ => Side::Unsaid,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_name_their_units() {
        use Dimension::*;
        use Named::{Nothing, Unknown};
        let cases = [
            ("time_s", Time, ("time", Named::Unit(Unit::Second))),
            ("stm32_time_ms", Time, ("stm32_time", Named::Unit(Unit::Millisecond))),
            ("time@s", Time, ("time", Named::Unit(Unit::Second))),
            ("t (µs)", Time, ("t", Named::Unit(Unit::Microsecond))),
            ("ms_today", Time, ("", Named::Unit(Unit::Millisecond))),
            ("motor_ud_v", Voltage, ("motor_ud", Named::Unit(Unit::Volt))),
            ("UD_MV", Voltage, ("UD", Named::Unit(Unit::Millivolt))),
            ("uq [pu]", Voltage, ("uq", Unknown("pu"))),
            ("uq@mA", Voltage, ("uq", Unknown("mA"))),
            ("uq_s", Voltage, ("uq_s", Nothing)),
            ("A", Current, ("A", Nothing)),
            ("id [A]", Current, ("id", Named::Unit(Unit::Ampere))),
            ("motor_velocity_rpm", Speed, ("motor_velocity", Named::Unit(Unit::RpmMechanical))),
            ("omega_e [rpm]", Speed, ("omega_e", Named::Unit(Unit::RpmElectrical))),
            ("erpm", Speed, ("", Named::Unit(Unit::RpmElectrical))),
            ("speed_elec_rpm", Speed, ("speed_elec", Named::Unit(Unit::RpmElectrical))),
            ("motor_speed_mech_rpm", Speed, ("motor_speed_mech", Named::Unit(Unit::RpmMechanical))),
            ("speed_rad_s", Speed, ("speed", Named::Unit(Unit::RadianPerSecond))),
            ("mech speed rad/s", Speed, ("mech speed", Named::Unit(Unit::RadianPerSecondMechanical))),
            ("lu_WS_RPM", Speed, ("lu_WS", Named::Unit(Unit::RpmMechanical))),
            ("f [Hz-mech]", Speed, ("f", Named::Unit(Unit::HertzMechanical))),
            ("motor_speed", Speed, ("motor_speed", Nothing)),
            ("theta_e [°]", Angle, ("theta_e", Named::Unit(Unit::Degree))),
            ("mech_angle_deg", Angle, ("mech_angle", Named::Unit(Unit::DegreeMechanical))),
            ("theta_mech (rad)", Angle, ("theta_mech", Named::Unit(Unit::RadianMechanical))),
            ("theta_e_rad", Angle, ("theta_e", Named::Unit(Unit::Radian))),
            ("speed_rad", Speed, ("speed_rad", Nothing)),
            ("ü)", Speed, ("ü)", Nothing)),
        ];
        for (header, dimension, expected) in cases {
            assert_eq!(in_header(header, dimension), expected, "{header}");
        }
    }

    #[test]
    fn values_become_si() {
        let si = |unit: Unit| {
            let mut values = [300.0];
            unit.to_si(&mut values, 4);
            values[0]
        };
        assert_eq!(si(Unit::Millisecond), 0.3);
        assert_eq!(si(Unit::Volt), 300.0);
        assert_eq!(si(Unit::RpmElectrical), 300.0 * (TAU / 60.0));
        assert_eq!(si(Unit::RpmMechanical), 300.0 * (TAU / 60.0 * 4.0));
        assert_eq!(si(Unit::HertzMechanical), 300.0 * (TAU * 4.0));
        assert_eq!(si(Unit::DegreeMechanical), 300.0 * (PI / 180.0 * 4.0));
    }

    #[test]
    fn names_lead_back_to_their_units() {
        for unit in Unit::ALL {
            assert_eq!(Unit::from_name(unit.name(), unit.dimension()), Some(unit));
        }
        assert_eq!(Unit::from_name("ERPM", Dimension::Speed), Some(Unit::RpmElectrical));
        assert_eq!(Unit::from_name("rpm", Dimension::Speed), None);
        assert_eq!(Unit::of(Dimension::Inductance).count(), 0);
    }
}

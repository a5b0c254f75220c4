//! Units in the headers of columns: `speed_rpm`, `ud [mV]`, `time@s`.

use fluxfit_units::{Dimension, Unit, wording};

/// Whether a header states an electrical or a mechanical speed or angle.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Rotation {
    Mechanical,
    Electrical,
    Unstated,
}

/// The unit that a header states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum HeaderUnit<'a> {
    /// This unit.
    Known(Unit),
    /// A text in the place of a unit that is not a unit of the column's dimension.
    Unknown(&'a str),
    /// No unit.
    None,
}

/// The unit that a part of a header spells. Case does not matter: `ID_MA` is in milliamperes.
fn spelled(text: &str, dimension: Dimension, rotation: Rotation) -> Option<Unit> {
    let text = text.trim().to_lowercase();
    let by_rotation = |electrical, mechanical, unstated| match rotation {
        Rotation::Electrical => electrical,
        Rotation::Mechanical => mechanical,
        Rotation::Unstated => unstated,
    };
    let unit = match text.as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" | "sek" | "sekunden" => Unit::Second,
        // `ms_today` is the time column of a VESC log.
        "ms" | "msec" | "ms_today" | "millis" | "millisecond" | "milliseconds" => Unit::Millisecond,
        "us" | "µs" | "μs" | "usec" | "micros" | "microsecond" | "microseconds" => Unit::Microsecond,
        "ns" | "nsec" | "nanos" | "nanosecond" | "nanoseconds" => Unit::Nanosecond,
        "v" | "volt" | "volts" => Unit::Volt,
        "mv" => Unit::Millivolt,
        "kv" => Unit::Kilovolt,
        "a" | "amp" | "amps" | "ampere" => Unit::Ampere,
        "ma" => Unit::Milliampere,
        "ka" => Unit::Kiloampere,
        "erpm" => Unit::RpmElectrical,
        // Where neither is stated, revolutions are those of the shaft: electrical ones are usually marked as such.
        "rpm" | "r/min" | "1/min" | "min-1" | "min^-1" | "u/min" | "upm" | "rev/min" | "tr/min" | "giri/min" => {
            by_rotation(Unit::RpmElectrical, Unit::RpmMechanical, Unit::RpmMechanical)
        }
        "krpm" | "1000 rpm" | "1000/min" | "10^3/min" => by_rotation(Unit::KrpmElectrical, Unit::KrpmMechanical, Unit::KrpmMechanical),
        "rad/s" | "rad_s" | "rad.s" | "rads" | "rad_per_s" | "radps" => {
            by_rotation(Unit::RadianPerSecond, Unit::RadianPerSecondMechanical, Unit::RadianPerSecond)
        }
        "deg/s" | "deg_s" | "deg_per_s" | "degree/s" | "degrees/s" | "°/s" | "dps" => {
            by_rotation(Unit::DegreePerSecond, Unit::DegreePerSecondMechanical, Unit::DegreePerSecond)
        }
        "rps" | "rev/s" | "revs/s" | "turn/s" | "turns/s" | "rev_s" | "revs_s" | "turn_s" | "turns_s" => {
            by_rotation(Unit::HertzElectrical, Unit::HertzMechanical, Unit::HertzMechanical)
        }
        "hz" => by_rotation(Unit::HertzElectrical, Unit::HertzMechanical, Unit::HertzElectrical),
        "rad" => by_rotation(Unit::Radian, Unit::RadianMechanical, Unit::Radian),
        "deg" | "degree" | "degrees" | "°" => by_rotation(Unit::Degree, Unit::DegreeMechanical, Unit::Degree),
        // Lower case: the unit may be °C or C.
        "degc" | "°c" | "c" | "celsius" => Unit::Celsius,
        _ => {
            let named = Unit::from_name(&text, dimension).or_else(|| Unit::from_name(&text.replace('_', "-"), dimension));
            // Root mean squares are read as such only where the user states it.
            return named.filter(|unit| !unit.is_rms());
        }
    };
    (unit.dimension() == dimension).then_some(unit)
}

/// The name in a header without its unit, and the unit that the header states. The unit is at the end: in brackets, after `@`, or
/// after `_` or a space. Only in brackets and after `@` is an unknown unit reported: `uq_s` may be the q voltage of the stator.
pub(crate) fn split_header(header: &str, dimension: Dimension) -> (&str, HeaderUnit<'_>) {
    // Simulink writes signals in angle brackets.
    let header = header.trim().trim_start_matches('<').trim_end_matches('>');
    if let Some(probed) = probed(header, dimension) {
        return probed;
    }
    let rotation = rotation(header);
    let brackets = [('[', ']'), ('(', ')'), ('（', '）')].into_iter().find_map(|(open, close)| {
        let at = header.strip_suffix(close)?.rfind(open)?;
        Some((&header[..at], &header[at + open.len_utf8()..header.len() - close.len_utf8()]))
    });
    // The index of an element, `Idq_in_A.value[0]`, or of a column of a matrix, `udq(:,1)`, is no unit.
    if let Some((name, index)) = brackets
        && is_index(index)
        && (index.contains(':') || !name.ends_with([' ', ']', ')']))
    {
        return split_header(name.trim_end_matches(".value"), dimension);
    }
    if let Some((name, text)) = brackets.or_else(|| header.rsplit_once('@')) {
        let unit = spelled(text, dimension, rotation);
        return (without_preposition(name), unit.map_or(HeaderUnit::Unknown(text), HeaderUnit::Known));
    }
    // Quantity over unit, as in the axes of a diagram: `t/s`, `n / min^-1`. In `rad/s` the word before is no quantity.
    if let Some((name, text)) = header.split_once('/').filter(|(name, _)| !NUMERATORS.contains(&last_word(name)))
        && let Some(unit) = spelled(text, dimension, rotation)
    {
        return (name.trim_end(), HeaderUnit::Known(unit));
    }
    // From the left: the unit of `speed_rad_s` is `rad_s`.
    for (at, _) in header.match_indices(['_', ' ']) {
        if let Some(unit) = spelled(&header[at + 1..], dimension, rotation) {
            return (without_preposition(&header[..at]), HeaderUnit::Known(unit));
        }
    }
    if let Some(unit) = header.rsplit(['_', ' ']).next().filter(|last| *last != header && NO_SI.contains(&last.to_lowercase().as_str())) {
        return (without_preposition(&header[..header.len() - unit.len()]), HeaderUnit::Unknown(unit));
    }
    // A header may be a unit and nothing else; a single letter is more likely a phase, and `Kv` a constant of the motor.
    match spelled(header, dimension, rotation) {
        Some(unit) if header.len() > 1 && (unit != Unit::Kilovolt || header == "kV") => ("", HeaderUnit::Known(unit)),
        _ => (header, HeaderUnit::None),
    }
}

/// A name as circuit simulators write what they probe, `V(ud)`, `I(Lq)`: the letter outside is the unit, and of a signal that is no voltage
/// a voltage stands for it. None of `V(mV)`, `i(t)` and `V(1)`.
fn probed(header: &str, dimension: Dimension) -> Option<(&str, HeaderUnit<'_>)> {
    let letter = header.chars().next().filter(|letter| "VvIi".contains(*letter))?;
    let name = header[1..].strip_prefix('(')?.strip_suffix(')')?;
    let is_unit = |dimension| spelled(name, dimension, Rotation::Unstated).is_some();
    let has_unit = [Dimension::Voltage, Dimension::Current, Dimension::Speed, Dimension::Angle].into_iter().any(is_unit);
    let is_name = name.starts_with(char::is_alphabetic) && !["t", "time"].contains(&name.to_lowercase().as_str());
    if !is_name || has_unit || dimension == Dimension::Time {
        return None;
    }
    match (letter.to_ascii_lowercase(), dimension) {
        ('v', Dimension::Voltage) => Some((name, HeaderUnit::Known(Unit::Volt))),
        ('i', Dimension::Current) => Some((name, HeaderUnit::Known(Unit::Ampere))),
        // The current through a source is not its voltage.
        ('i', _) => None,
        _ => Some((name, HeaderUnit::None)),
    }
}

/// Units of speed that are no other word: they count wherever in a name they stand, if nothing else states a unit.
const SPEED_WORDS: [&str; 6] = ["erpm", "rpm", "krpm", "rps", "hz", "dps"];

/// Such words that are no unit known here.
const NO_SPEED: [&str; 3] = ["khz", "dhz", "mhz"];

/// The unit that the last part of a column's name has in its middle: `rpm_filtered` of `/motor/rpm_filtered`, but not the corner of a
/// filter, `speed_50_hz`.
pub(crate) fn unit_within(header: &str, dimension: Dimension) -> HeaderUnit<'_> {
    let last = header.rsplit(['.', '/', '\\', ':']).next().unwrap_or(header);
    let words: Vec<&str> = last.split(|c: char| !c.is_alphanumeric()).collect();
    let is_number = |word: &str| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    let of_speed = words.iter().enumerate().find(|(place, word)| {
        let is_unit = SPEED_WORDS.contains(&word.to_lowercase().as_str()) || NO_SPEED.contains(&word.to_lowercase().as_str());
        is_unit && !place.checked_sub(1).is_some_and(|before| is_number(words[before]))
    });
    match of_speed.filter(|_| dimension == Dimension::Speed) {
        Some((_, word)) => spelled(word, dimension, rotation(header)).map_or(HeaderUnit::Unknown(word), HeaderUnit::Known),
        None => HeaderUnit::None,
    }
}

/// Whether a text in brackets is an index: `0`, or as MATLAB and numpy write that of a column or a row, `:,1`, `1,:`.
fn is_index(text: &str) -> bool {
    text.contains(|c: char| c.is_ascii_digit()) && text.chars().all(|c| c.is_ascii_digit() || ":, ".contains(c))
}

/// Units without brackets that would be read as SI if they were not known: shares of a base value, digits of a converter, root
/// mean squares where a dq value is a peak.
const NO_SI: [&str; 16] =
    ["rms", "arms", "vrms", "pu", "mrad/s", "krad/s", "khz", "dhz", "mhz", "counts", "lsb", "digits", "q15", "q24", "s16", "pct"];

/// Texts in the place of a unit for a share of a base value, and how many of them are the whole.
const SHARES: [(&str, f64); 7] =
    [("%", 100.0), ("pct", 100.0), ("percent", 100.0), ("prozent", 100.0), ("pu", 1.0), ("p.u.", 1.0), ("p.u", 1.0)];

/// How many make the base value, if a text in the place of a unit says that the values are shares of one.
pub(crate) fn share(text: &str) -> Option<f64> {
    let text = text.trim().trim_matches(['[', ']', '(', ')']).to_lowercase();
    SHARES.iter().find(|(share, _)| *share == text).map(|(_, whole)| *whole)
}

/// Units and counts that a unit of speed begins with.
const NUMERATORS: [&str; 13] = ["deg", "degree", "degrees", "rad", "r", "rev", "revs", "turn", "turns", "u", "1", "m", "km"];

fn last_word(text: &str) -> &str {
    text.rsplit(|c: char| !c.is_alphanumeric()).next().unwrap_or(text)
}

/// The name before a unit: `Ud in V`, `n / (1/min)`.
fn without_preposition(name: &str) -> &str {
    let name = name.trim_end_matches([' ', '_', '/', ',']);
    name.strip_suffix(" in").unwrap_or(name).trim_end()
}

/// The unit that a row of units, or a container, states for a column with this header.
pub(crate) fn unit_in_row<'a>(text: &'a str, header: &str, dimension: Dimension) -> HeaderUnit<'a> {
    let bare = unit_of_cell(text);
    let rotation = match (rotation(text), rotation(header)) {
        (Rotation::Unstated, of_header) => of_header,
        (of_text, _) => of_text,
    };
    spelled(bare, dimension, rotation).map_or(HeaderUnit::Unknown(text), HeaderUnit::Known)
}

/// The unit in a cell of a row of units, without brackets and without the quantity in Chinese or Japanese before it: `轉速rpm`, `電壓V`.
pub(crate) fn unit_of_cell(text: &str) -> &str {
    let bare = text.trim().trim_matches(['[', ']', '(', ')']);
    let unit = bare.trim_start_matches(|c: char| c >= FIRST_OF_EAST_ASIA && c.is_alphabetic()).trim_matches([' ', '[', ']', '(', ')']);
    if unit.is_empty() { bare } else { unit }
}

/// The first character of the scripts of East Asia; Greek letters and accents, as in `µs`, come before it.
const FIRST_OF_EAST_ASIA: char = '\u{2e80}';

/// Whether a header states that its speed or angle is electrical.
pub(crate) fn states_electrical(header: &str) -> bool {
    rotation(header) == Rotation::Electrical
}

/// Whether a header states that its speed or angle is that of the shaft.
pub(crate) fn states_mechanical(header: &str) -> bool {
    rotation(header) == Rotation::Mechanical
}

/// The unit that a header or a row of units states, in words, where the user's own one contradicts it. A root mean square does not
/// contradict V or A, nor an electrical speed one that says r/min and no more.
pub(crate) fn contradicted(named: HeaderUnit, header: &str, stated: Unit) -> Option<String> {
    let of_peak = |unit: Unit| if unit.is_rms() { 1.0 } else { unit.in_si() };
    match named {
        HeaderUnit::None => None,
        // Radians have no unit.
        HeaderUnit::Unknown(text) if text.trim() == "1/s" && stated.dimension() == Dimension::Speed => None,
        HeaderUnit::Unknown(text) => (!is_rms_text(text)).then(|| wording::shorten(text.trim())),
        HeaderUnit::Known(unit) => {
            let has_rotation = rotation(header) != Rotation::Unstated && unit.is_mechanical() != stated.is_mechanical();
            (of_peak(unit) != of_peak(stated) || has_rotation).then(|| unit.prose().to_owned())
        }
    }
}

fn is_rms_text(text: &str) -> bool {
    ["rms", "arms", "vrms", "aeff", "veff", "eff"].contains(&text.trim().to_lowercase().as_str())
}

const ELECTRICAL: [&str; 8] = ["e", "el", "we", "wel", "omegae", "omegael", "thetae", "thetael"];

fn rotation(header: &str) -> Rotation {
    let lower = header.to_lowercase();
    let words = || lower.split(|c: char| !c.is_alphanumeric());
    let electrical = lower.contains("elec") || lower.contains("erpm") || words().any(|word| ELECTRICAL.contains(&word));
    match (lower.contains("mech"), electrical) {
        (true, false) => Rotation::Mechanical,
        (false, true) => Rotation::Electrical,
        _ => Rotation::Unstated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_state_their_units() {
        use Dimension::*;
        let cases = [
            ("time_s", Time, ("time", HeaderUnit::Known(Unit::Second))),
            ("stm32_time_ms", Time, ("stm32_time", HeaderUnit::Known(Unit::Millisecond))),
            ("time@s", Time, ("time", HeaderUnit::Known(Unit::Second))),
            ("t (µs)", Time, ("t", HeaderUnit::Known(Unit::Microsecond))),
            ("ms_today", Time, ("", HeaderUnit::Known(Unit::Millisecond))),
            ("motor_ud_v", Voltage, ("motor_ud", HeaderUnit::Known(Unit::Volt))),
            ("ud_kV", Voltage, ("ud", HeaderUnit::Known(Unit::Kilovolt))),
            ("iq [kA]", Current, ("iq", HeaderUnit::Known(Unit::Kiloampere))),
            ("n_el [krpm]", Speed, ("n_el", HeaderUnit::Known(Unit::KrpmElectrical))),
            ("UD_MV", Voltage, ("UD", HeaderUnit::Known(Unit::Millivolt))),
            ("uq [pu]", Voltage, ("uq", HeaderUnit::Unknown("pu"))),
            ("uq@mA", Voltage, ("uq", HeaderUnit::Unknown("mA"))),
            ("rpm_mech", Speed, ("", HeaderUnit::Known(Unit::RpmMechanical))),
            ("<speed wm (rad/s)>", Speed, ("speed wm", HeaderUnit::Known(Unit::RadianPerSecond))),
            ("speed_krpm", Speed, ("speed", HeaderUnit::Known(Unit::KrpmMechanical))),
            ("Vd_pu", Voltage, ("Vd", HeaderUnit::Unknown("pu"))),
            ("pu", Voltage, ("pu", HeaderUnit::None)),
            ("Kv", Voltage, ("Kv", HeaderUnit::None)),
            ("kV", Voltage, ("", HeaderUnit::Known(Unit::Kilovolt))),
            ("id_rms", Current, ("id", HeaderUnit::Unknown("rms"))),
            ("Vitesse (tr/min)", Speed, ("Vitesse", HeaderUnit::Known(Unit::RpmMechanical))),
            ("Iq（mA）", Current, ("Iq", HeaderUnit::Known(Unit::Milliampere))),
            ("uq_s", Voltage, ("uq_s", HeaderUnit::None)),
            ("A", Current, ("A", HeaderUnit::None)),
            ("id [A]", Current, ("id", HeaderUnit::Known(Unit::Ampere))),
            ("motor_velocity_rpm", Speed, ("motor_velocity", HeaderUnit::Known(Unit::RpmMechanical))),
            ("omega_e [rpm]", Speed, ("omega_e", HeaderUnit::Known(Unit::RpmElectrical))),
            ("erpm", Speed, ("", HeaderUnit::Known(Unit::RpmElectrical))),
            ("speed_elec_rpm", Speed, ("speed_elec", HeaderUnit::Known(Unit::RpmElectrical))),
            ("motor_speed_mech_rpm", Speed, ("motor_speed_mech", HeaderUnit::Known(Unit::RpmMechanical))),
            ("speed_rad_s", Speed, ("speed", HeaderUnit::Known(Unit::RadianPerSecond))),
            ("mech speed rad/s", Speed, ("mech speed", HeaderUnit::Known(Unit::RadianPerSecondMechanical))),
            ("lu_WS_RPM", Speed, ("lu_WS", HeaderUnit::Known(Unit::RpmMechanical))),
            ("f [Hz-mech]", Speed, ("f", HeaderUnit::Known(Unit::HertzMechanical))),
            ("motor_speed", Speed, ("motor_speed", HeaderUnit::None)),
            ("theta_e [°]", Angle, ("theta_e", HeaderUnit::Known(Unit::Degree))),
            ("mech_angle_deg", Angle, ("mech_angle", HeaderUnit::Known(Unit::DegreeMechanical))),
            ("theta_mech (rad)", Angle, ("theta_mech", HeaderUnit::Known(Unit::RadianMechanical))),
            ("temperature [°C]", Temperature, ("temperature", HeaderUnit::Known(Unit::Celsius))),
            ("temperature_degC", Temperature, ("temperature", HeaderUnit::Known(Unit::Celsius))),
            ("temperature (K)", Temperature, ("temperature", HeaderUnit::Unknown("K"))),
            ("theta_e_rad", Angle, ("theta_e", HeaderUnit::Known(Unit::Radian))),
            ("speed_rad", Speed, ("speed_rad", HeaderUnit::None)),
            ("n / min^-1", Speed, ("n", HeaderUnit::Known(Unit::RpmMechanical))),
            ("speed [deg/s]", Speed, ("speed", HeaderUnit::Known(Unit::DegreePerSecond))),
            ("f_e_kHz", Speed, ("f_e", HeaderUnit::Unknown("kHz"))),
            ("speed_dHz", Speed, ("speed", HeaderUnit::Unknown("dHz"))),
            ("vel_turns_s", Speed, ("vel", HeaderUnit::Known(Unit::HertzMechanical))),
            ("rpm_filtered", Speed, ("rpm_filtered", HeaderUnit::None)),
            ("omega_e_deg_s", Speed, ("omega_e", HeaderUnit::Known(Unit::DegreePerSecond))),
            ("n_mech (°/s)", Speed, ("n_mech", HeaderUnit::Known(Unit::DegreePerSecondMechanical))),
            ("mech speed deg/s", Speed, ("mech speed", HeaderUnit::Known(Unit::DegreePerSecondMechanical))),
            ("speed deg/s", Time, ("speed deg/s", HeaderUnit::None)),
            ("omega/(rad/s)", Speed, ("omega", HeaderUnit::Known(Unit::RadianPerSecond))),
            ("Ud in V", Voltage, ("Ud", HeaderUnit::Known(Unit::Volt))),
            ("t/s", Time, ("t", HeaderUnit::Known(Unit::Second))),
            ("speed rad/s", Time, ("speed rad/s", HeaderUnit::None)),
            ("velocity [turns/s]", Speed, ("velocity", HeaderUnit::Known(Unit::HertzMechanical))),
            ("out.vdq(:,1)", Voltage, ("out.vdq", HeaderUnit::None)),
            ("vdq_mV(2,:)", Voltage, ("vdq", HeaderUnit::Known(Unit::Millivolt))),
            ("vdq [mV](:,1)", Voltage, ("vdq", HeaderUnit::Known(Unit::Millivolt))),
            ("ud (:)", Voltage, ("ud", HeaderUnit::Unknown(":"))),
            ("V(ud)", Voltage, ("ud", HeaderUnit::Known(Unit::Volt))),
            ("v(iq)", Current, ("iq", HeaderUnit::None)),
            ("V(omega)", Speed, ("omega", HeaderUnit::None)),
            ("I(Lq)", Current, ("Lq", HeaderUnit::Known(Unit::Ampere))),
            ("I(Vq)", Voltage, ("I", HeaderUnit::Unknown("Vq"))),
            ("V(mV)", Voltage, ("V", HeaderUnit::Known(Unit::Millivolt))),
            ("i(t)", Current, ("i", HeaderUnit::Unknown("t"))),
            ("ü)", Speed, ("ü)", HeaderUnit::None)),
        ];
        for (header, dimension, expected) in cases {
            assert_eq!(split_header(header, dimension), expected, "{header}");
        }
    }

    #[test]
    fn units_of_speed_count_in_the_middle_of_a_name() {
        let cases = [
            ("motor.erpm", HeaderUnit::Known(Unit::RpmElectrical)),
            ("/motor/erpm_abs", HeaderUnit::Known(Unit::RpmElectrical)),
            ("rpm_el", HeaderUnit::Known(Unit::RpmElectrical)),
            ("spd_rpm_filt", HeaderUnit::Known(Unit::RpmMechanical)),
            ("speed_Hz_filt", HeaderUnit::Known(Unit::HertzElectrical)),
            ("speed_kHz_filt", HeaderUnit::Unknown("kHz")),
            ("speed_lp_50_hz_filt", HeaderUnit::None),
            ("/rpm_ctrl/omega_e", HeaderUnit::None),
            ("motor_speed", HeaderUnit::None),
        ];
        for (header, expected) in cases {
            assert_eq!(unit_within(header, Dimension::Speed), expected, "{header}");
        }
        assert_eq!(unit_within("rpm_filtered", Dimension::Time), HeaderUnit::None);
    }
}

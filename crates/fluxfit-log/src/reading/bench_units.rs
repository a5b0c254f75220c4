//! The units in the names of a bench table's columns. Meters and oscilloscopes write into them what of a wave they show, and between which
//! points: `[Vpp]`, `(V AC)`, `[A rms]`, `Vrms line-line`, `voltage (V) rms`.

use super::{resemblance::words, vocabulary::VOLTAGE};
use crate::{
    block::ColumnHead,
    header_unit::{HeaderUnit, split_header, states_electrical, unit_in_row, unit_of_cell},
    quantity::Quantity,
};
use fluxfit_units::{Dimension, Unit};

/// What a name, or the row of units, states of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StatedUnit {
    /// A unit of this quantity, its size in SI units, and whether it is that of an electrical speed.
    Of(Quantity, f64, bool),
    /// A unit of something else, or a constant of a motor.
    Other,
    /// No unit.
    None,
}

/// The unit of a column: that in brackets, or else at the end of its name, or else in the row of units, or else a word such as `Vpp`.
pub(super) fn stated_unit(head: &ColumnHead) -> StatedUnit {
    let header = head.name.trim();
    if is_constant(header) {
        return StatedUnit::Other;
    }
    let groups = brackets(header);
    let is_phase = |text: &str| is_letter_of_phase(text, header, groups.iter().map(|(text, _)| *text));
    if let Some(stated) = groups.iter().rev().filter(|(text, _)| !is_phase(text)).find_map(|(text, _)| unit_of(text, header)) {
        return stated;
    }
    // Of brackets at the end that hold no unit, some say what of a wave is meant, `(line-line)`: what is before them may have one.
    let (name, is_other) = match groups.last().filter(|(_, is_last)| *is_last) {
        Some((text, _)) if base_of(text).is_empty() || is_phase(text) => (&header[..header.len() - text.len() - 2], false),
        group => (header, group.is_some()),
    };
    let dimensions =
        [(Quantity::Speed, Dimension::Speed), (Quantity::Voltage, Dimension::Voltage), (Quantity::Current, Dimension::Current)];
    let at_end = |(quantity, dimension): (Quantity, Dimension)| match split_header(name.trim(), dimension).1 {
        HeaderUnit::Known(unit) => Some(of(quantity, unit, header)),
        _ => None,
    };
    let torque = || {
        let ends = name.match_indices(['_', ' ']).map(|(at, _)| &name[at + 1..]);
        ends.filter(|end| !end.contains(['(', '['])).find_map(newton_metres).map(|in_si| StatedUnit::Of(Quantity::Torque, in_si, false))
    };
    if let Some(stated) = torque().or_else(|| dimensions.into_iter().find_map(at_end)) {
        return stated;
    }
    let row = head.unit.as_deref().map(|text| unit_of_cell(text).trim_matches(['-', '#'])).filter(|text| !text.is_empty());
    if let Some(text) = row {
        return unit_of(text, header).unwrap_or(StatedUnit::Other);
    }
    let is_of_other = |dimension| matches!(split_header(header, dimension).1, HeaderUnit::Known(_));
    if is_other || [Dimension::Time, Dimension::Temperature, Dimension::Angle].into_iter().any(is_of_other) {
        return StatedUnit::Other;
    }
    // `Vpp line-line`: a unit with what of a wave it is, wherever in the name.
    let waves = words(name).into_iter().filter(|word| WAVES.iter().any(|wave| word.ends_with(wave)));
    let word = waves.into_iter().find_map(|word| unit_of(&word, header));
    word.unwrap_or(match split_header(name.trim(), Dimension::Speed).1 {
        HeaderUnit::Unknown(text) if !base_of(text).is_empty() => StatedUnit::Other,
        _ => StatedUnit::None,
    })
}

/// Whether a text in brackets is the letter of a phase and no unit: `(A phase)`, or `(A)` behind a name of a voltage or beside its unit.
fn is_letter_of_phase<'a>(text: &str, header: &str, mut brackets: impl Iterator<Item = &'a str>) -> bool {
    let plain = text.trim().to_lowercase();
    let letter = plain.strip_suffix("phase").or_else(|| plain.strip_suffix("ph")).map(|letter| letter.trim_matches([' ', '-', '_']));
    if letter.is_some_and(|letter| ["a", "v"].contains(&letter)) {
        return true;
    }
    let (other, symbols) = match plain.as_str() {
        "a" => (Quantity::Voltage, ["u", "v", "e"]),
        "v" => (Quantity::Current, ["i", "i", "i"]),
        _ => return false,
    };
    let name = header.split(['[', '(']).next().unwrap_or_default();
    let is_named = words(name).iter().any(|word| symbols.contains(&word.as_str()) || other.words().contains(&word.as_str()));
    is_named || brackets.any(|own| matches!(unit_of(own, header), Some(StatedUnit::Of(quantity, ..)) if quantity == other))
}

/// The texts in brackets, in order, and whether the name ends with each.
fn brackets(header: &str) -> Vec<(&str, bool)> {
    let mut groups = Vec::new();
    let mut from = 0;
    while let Some(open) = header[from..].find(['[', '(']).map(|at| from + at) {
        let close = if header[open..].starts_with('[') { ']' } else { ')' };
        let Some(end) = header[open..].find(close).map(|at| open + at) else { break };
        groups.push((&header[open + 1..end], end + 1 == header.len()));
        from = end + 1;
    }
    groups
}

/// The unit that a text spells, of a column with this name.
fn unit_of(text: &str, header: &str) -> Option<StatedUnit> {
    if let Some(in_si) = newton_metres(text) {
        return Some(StatedUnit::Of(Quantity::Torque, in_si, false));
    }
    if let HeaderUnit::Known(unit) = unit_in_row(text, header, Dimension::Speed) {
        return Some(of(Quantity::Speed, unit, header));
    }
    let base = base_of(text);
    // `V_LL amp` is the amplitude of a voltage.
    let is_amplitude = base == "amp" && words(header).first().is_some_and(|word| word.starts_with(['v', 'u']));
    let is_unit = BASES.contains(&base.as_str()) && !is_amplitude;
    [(Quantity::Voltage, Dimension::Voltage), (Quantity::Current, Dimension::Current)].into_iter().filter(|_| is_unit).find_map(
        |(quantity, dimension)| match unit_in_row(&base, "", dimension) {
            HeaderUnit::Known(unit) => Some(of(quantity, unit, header)),
            _ => None,
        },
    )
}

/// Words of a frequency in Hz that is turns of the shaft in a second.
const OF_SHAFT: [&str; 8] = ["shaft", "rotational", "revolutions", "drehzahl", "drehfrequenz", "drehgeschwindigkeit", "mech", "mechanical"];

fn of(quantity: Quantity, unit: Unit, header: &str) -> StatedUnit {
    let is_of_shaft = unit == Unit::HertzElectrical && words(header).iter().any(|word| OF_SHAFT.contains(&word.as_str()));
    let is_electrical = matches!(unit, Unit::RpmElectrical | Unit::KrpmElectrical | Unit::HertzElectrical) && !is_of_shaft
        || matches!(unit, Unit::RadianPerSecond | Unit::DegreePerSecond) && states_electrical(header);
    StatedUnit::Of(quantity, unit.in_si(), is_electrical)
}

/// Units of voltages and currents, in lower case.
const BASES: [&str; 13] = ["v", "mv", "kv", "volt", "volts", "voltage", "a", "ma", "ka", "amp", "amps", "ampere", "amperes"];

/// What is written behind such a unit: what of a wave it is, and between which points. Longer ones first.
const BEHIND: [&str; 24] = [
    "peaktopeak",
    "linetoline",
    "lineline",
    "pktopk",
    "pk2pk",
    "pkpk",
    "phase",
    "peak",
    "trms",
    "line",
    "phph",
    "rms",
    "eff",
    "ptp",
    "p2p",
    "pp",
    "pk",
    "0p",
    "ph",
    "ll",
    "ln",
    "ac",
    "dc",
    "p",
];

/// Those that make a word a unit, also without brackets.
const WAVES: [&str; 5] = ["pp", "pk", "p2p", "rms", "eff"];

/// A unit without what is written behind it: `v` of `Vrms L-L`. Empty, if it is nothing but that.
fn base_of(text: &str) -> String {
    let mut base: String = text.to_lowercase().chars().filter(|c| !matches!(c, ' ' | '-' | '_' | '.' | ',' | '~')).collect();
    // `(p)` alone says nothing.
    if base == "p" {
        return base;
    }
    while !BASES.contains(&base.as_str()) {
        let Some(shorter) = BEHIND.iter().find_map(|behind| base.strip_suffix(behind)) else { break };
        base.truncate(shorter.len());
    }
    base
}

/// The size of a unit of torque, in N m. Those of force times length are of the force by which a mass weighs, at 9.80665 m/s².
fn newton_metres(unit: &str) -> Option<f64> {
    const POUND_FORCE: f64 = 4.448_221_615_260_5;
    const KILOGRAM_FORCE: f64 = 9.806_65;
    const FOOT: f64 = 0.3048;
    const INCH: f64 = 0.0254;
    let is_mark = |c: char| matches!(c, ' ' | '.' | '-' | '_' | '*' | '·' | '⋅');
    let plain: String = unit.to_lowercase().chars().filter(|c| !is_mark(*c)).collect();
    match plain.as_str() {
        "nm" => Some(1.0),
        "mnm" | "nmm" => Some(1e-3),
        "ncm" => Some(1e-2),
        "knm" => Some(1e3),
        "lbfft" | "lbft" | "ftlb" | "ftlbf" | "ftlbs" => Some(POUND_FORCE * FOOT),
        "lbfin" | "lbin" | "inlb" | "inlbf" | "inlbs" => Some(POUND_FORCE * INCH),
        "ozin" | "ozfin" | "inoz" | "inozf" => Some(POUND_FORCE / 16.0 * INCH),
        "kgfm" | "kgm" | "kpm" => Some(KILOGRAM_FORCE),
        "kgfcm" | "kgcm" | "kpcm" => Some(1e-2 * KILOGRAM_FORCE),
        "gfcm" | "gcm" => Some(1e-5 * KILOGRAM_FORCE),
        _ => None,
    }
}

/// Whether a name is that of a constant of a motor: `Kv`, `Kt [Nm/A]`, `K_e`, `torque constant`. `kV` behind or beside a voltage is its
/// unit.
pub(super) fn is_constant(header: &str) -> bool {
    let parts: Vec<&str> = header.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let lower: Vec<String> = parts.iter().map(|word| word.to_lowercase()).collect();
    let is = |word: &str, some: &[&str]| some.contains(&word);
    let is_voltage = || lower.iter().any(|word| VOLTAGE.contains(&word.as_str()) || word.len() > 1 && word.starts_with(['u', 'v']));
    let is_kilovolt = |word: &str| match word {
        "kV" => parts.len() > 1,
        "Kv" => false,
        _ => is_voltage(),
    };
    lower.iter().any(|word| is(word, &["kt", "ke", "constant", "konstante"]))
        || parts.iter().zip(&lower).any(|(word, lower)| lower == "kv" && !is_kilovolt(word))
        || lower.windows(2).any(|pair| pair[0] == "k" && is(&pair[1], &["e", "t", "v"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stated(name: &str) -> StatedUnit {
        stated_unit(&ColumnHead { name: name.to_owned(), ..ColumnHead::default() })
    }

    #[test]
    fn voltages_and_currents_state_their_unit_with_what_of_a_wave_it_is() {
        for name in [
            "U [Vpp]",
            "U_ll [V p-p]",
            "U [Vpk]",
            "V_AB (Vrms)",
            "Line to Line Voltage (VAC)",
            "Voltage (V AC)",
            "U [V rms]",
            "U [V_rms]",
            "Vpp",
            "Vpp line-line",
            "Vrms line-line (V)",
            "motor phase-phase voltage (V) rms",
            "Voltage (V) (line-line)",
            "U [V L-L]",
            "u_V",
            "U [Veff]",
            "U in V",
            "U (V~)",
            "phase voltage (V, peak)",
        ] {
            assert_eq!(stated(name), StatedUnit::Of(Quantity::Voltage, 1.0, false), "{name}");
        }
        for name in ["Isc [A rms]", "Isc [Arms]", "Current [Apk]", "I (A) measured", "I [A]", "Iph_rms [Amps]", "I_A"] {
            assert_eq!(stated(name), StatedUnit::Of(Quantity::Current, 1.0, false), "{name}");
        }
        assert_eq!(stated("U [mVpp]"), StatedUnit::Of(Quantity::Voltage, 1e-3, false));
        assert_eq!(stated("U [kV]"), StatedUnit::Of(Quantity::Voltage, 1e3, false));
        assert_eq!(stated("I [mArms]"), StatedUnit::Of(Quantity::Current, 1e-3, false));
        let in_row = ColumnHead { name: "U_ll".to_owned(), unit: Some("[V rms]".to_owned()), ..ColumnHead::default() };
        assert_eq!(stated_unit(&in_row), StatedUnit::Of(Quantity::Voltage, 1.0, false));
        // Phases, not amperes and volts.
        for name in ["Voltage (A phase)", "Voltage (A)", "Current (V phase)", "V (A)"] {
            assert_eq!(stated(name), StatedUnit::None, "{name}");
        }
        assert_eq!(stated("Back-EMF [V] (A)"), StatedUnit::Of(Quantity::Voltage, 1.0, false));
        for name in ["vll_rms", "Voltage (line-line)", "voltage", "U", "Iq"] {
            assert_eq!(stated(name), StatedUnit::None, "{name}");
        }
        for name in ["speed [m/s]", "Power (W)", "t [s]", "T [°C]", "phi [deg]", "Load [kg]", "U [p]"] {
            assert_eq!(stated(name), StatedUnit::Other, "{name}");
        }
    }

    /// Of 1 lbf = 0.45359237 kg times 9.80665 m/s², 1 ft = 12 in = 0.3048 m, 16 oz in a lb.
    #[test]
    fn torques_have_metric_and_imperial_units() {
        let (gravity, pound, inch) = (9.80665, 0.453_592_37, 0.0254);
        for (names, in_si) in [
            (&["Torque (Nm)", "Torque [N.m]", "M [N·m]", "torque_Nm", "Torque N m"][..], 1.0),
            (&["Torque (mNm)"], 1e-3),
            (&["Torque [Ncm]", "Torque [N-cm]"], 1e-2),
            (&["Torque (oz-in)", "Torque [ozf.in]", "torque_oz_in", "Torque in-oz"], gravity * pound / 16.0 * inch),
            (&["Torque [lbf-ft]", "Torque (ft-lb)", "Torque [ft.lbf]"], gravity * pound * 12.0 * inch),
            (&["Torque [lb-in]", "Torque (in-lbf)"], gravity * pound * inch),
            (&["Torque [kgf.cm]", "Torque (kg-cm)"], gravity * 1e-2),
            (&["Torque [kgf·m]"], gravity),
            (&["Torque (gf-cm)"], gravity * 1e-5),
        ] {
            for name in names {
                let StatedUnit::Of(Quantity::Torque, found, false) = stated(name) else { panic!("{name}: {:?}", stated(name)) };
                assert!((found / in_si - 1.0).abs() < 1e-12, "{name}: {found}");
            }
        }
    }

    #[test]
    fn constants_of_a_motor_are_no_columns_of_a_table() {
        for name in
            ["Kv", "KV", "kv", "Kt", "kt", "Ke", "K_e", "Kt [Nm/A]", "Kt (Nm)", "Motor Kv", "motor_kv", "Kv (rpm/V)", "torque constant"]
        {
            assert!(is_constant(name), "{name}");
            assert_eq!(stated(name), StatedUnit::Other, "{name}");
        }
        for name in ["U [kV]", "U_ll_kV", "UD_KV", "voltage_kv", "Vll [KV]", "kW", "token"] {
            assert!(!is_constant(name), "{name}");
        }
    }
}

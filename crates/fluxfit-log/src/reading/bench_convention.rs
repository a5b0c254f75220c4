//! What of a wave the columns of a bench table hold, and between which points, by their names.

use super::{
    bench_columns::{Found, differing},
    line_to_line,
    resemblance::words,
};
use crate::{
    header_unit::states_electrical,
    note::Note,
    quantity::{Quantity, TableColumn},
};
use fluxfit::characteristics::Across;
use fluxfit_units::wording::quote;

/// What a name says of the convention, as a factor; and what is assumed where it says nothing.
pub(super) fn convention(column: &Found, quantity: Quantity, pole_pairs: Option<u32>, notes: &mut Vec<Note>) -> f64 {
    let name = quote(&column.header);
    match quantity {
        Quantity::Voltage | Quantity::Current => {
            let (factor, how, is_stated) = to_rms(&column.described);
            let doubt = if is_stated { "" } else { ", because its name does not say so; if it is an amplitude, add 'peak' to the name" };
            let unit = match (column.has_unit, quantity) {
                (true, _) => "",
                (false, Quantity::Voltage) => "; nothing states its unit, so V is assumed",
                (false, _) => "; nothing states its unit, so A is assumed",
            };
            notes.push(format!("the {} {name} is read as {how}{doubt}{unit}", quantity.name()).into());
            factor
        }
        Quantity::Speed if column.is_electrical => {
            let doubt = if states_electrical(&column.header) { "" } else { "; if it is that of the shaft, add 'mech' to its name" };
            notes.push(format!("the speed {name} is read as the electrical one{doubt}").into());
            1.0 / f64::from(pole_pairs.unwrap_or(1))
        }
        Quantity::Speed => {
            notes.push(format!("the speed {name} is read as that of the shaft").into());
            1.0
        }
        Quantity::Torque => 1.0,
    }
}

/// Ends of words that are amplitudes.
const AMPLITUDES: [&str; 20] = [
    "peak",
    "pk",
    "0p",
    "amplitude",
    "amplitudes",
    "amplitud",
    "ampiezza",
    "ampl",
    "vamp",
    "crest",
    "crete",
    "crête",
    "picco",
    "pico",
    "spitze",
    "spitzenwert",
    "spitzenspannung",
    "scheitel",
    "scheitelwert",
    "峰值",
];

/// Of a wave its amplitude, of rms values the largest.
const MAXIMA: [&str; 2] = ["max", "maximum"];

/// Whole words that are amplitudes.
const HATS: [&str; 6] = ["hat", "uhat", "vhat", "ehat", "ihat", "dach"];

/// Words of voltages between two terminals beside which `p` is no phase: `Vll_p`.
const LINES: [&str; 5] = ["ll", "vll", "ull", "ell", "line"];

/// The rms value over what a column holds, what that is, and whether its name states it.
fn to_rms(name: &str) -> (f64, &'static str, bool) {
    let words = words(name);
    // Last in a word too: `Urms`, `Vpp`.
    let ends = |ends: &[&str]| words.iter().any(|word| ends.iter().any(|end| word.ends_with(end)));
    let are_two = |one: &str| words.windows(2).any(|pair| pair[0].ends_with(one) && pair[1] == one);
    // `[Vp]` is a unit, where `Vp` may be the voltage of a phase.
    let in_brackets = self::words(name.split_once(['[', '(']).map_or("", |(_, text)| text));
    let is_volts = |word: &str| ["v", "a", "mv", "ma"].contains(&word);
    let is_peak = in_brackets.iter().any(|word| ["vp", "ap", "mvp", "map"].contains(&word.as_str()))
        || in_brackets.windows(2).any(|pair| is_volts(&pair[0]) && pair[1] == "p");
    // `Vpp`, but not `V_app`; in brackets amperes, too.
    let is_pp = |word: &String| word == "pp" || ["vpp", "upp", "ipp", "epp"].iter().any(|end| word.ends_with(end));
    let between = |one: &str| words.windows(3).any(|of| of[0].ends_with(one) && of[1] == "to" && of[2] == one);
    let is_peak_of_lines = words.iter().any(|word| LINES.contains(&word.as_str())) && words.iter().any(|word| word == "p")
        || words.iter().any(|word| LINES.iter().any(|line| word.strip_prefix(line) == Some("p")));
    let is_from_zero = words.windows(2).any(|pair| pair[0] == "0" && pair[1] == "p");
    if words.iter().any(is_pp)
        || in_brackets.iter().any(|word| word.ends_with("pp"))
        || words.iter().any(|word| ["uss", "vss"].contains(&word.as_str()))
        || ends(&["pkpk", "p2p", "ptp", "pk2pk", "pktopk", "peak2peak", "peaktopeak", "peakpeak", "峰峰值"])
        || are_two("pk")
        || are_two("p")
        || between("pk")
        || between("p")
        || words.windows(3).any(|of| of[0] == "peak" && of[2] == "peak")
    {
        (0.125_f64.sqrt(), "peak to peak", true)
    } else if is_peak
        || is_from_zero
        || is_peak_of_lines
        || ends(&MAXIMA) && !ends(&["rms", "eff"])
        || words.iter().any(|word| HATS.contains(&word.as_str()))
        || name.contains(['û', 'Û', 'î', 'Î'])
        || ends(&AMPLITUDES)
        || words.first().is_some_and(|word| word.starts_with(['v', 'u'])) && words.iter().any(|word| word == "amp")
    {
        (0.5_f64.sqrt(), "amplitude", true)
    } else {
        (1.0, "rms", ends(&["rms", "eff", "effektiv", "efficace", "efficaz", "有效值", "実効値"]))
    }
}

/// Whether a name states what of a wave its column holds.
pub(super) fn states_wave(name: &str) -> bool {
    to_rms(name).2
}

/// Words of a speed that are its unit, or in which a speed is always r/min.
const REVOLUTIONS: [&str; 5] = ["rpm", "drehzahl", "upm", "转速", "回転数"];

/// Whether nothing states the unit of a speed.
pub(super) fn lacks_unit(column: &Found) -> bool {
    let is_in_rpm = || words(&column.header).iter().any(|word| REVOLUTIONS.contains(&word.as_str()));
    column.quantity == Quantity::Speed && !column.has_unit && !is_in_rpm()
}

/// Between which points voltages were measured, by what the user says, or else by their names.
pub(super) fn points(columns: &[&Found]) -> Option<Across> {
    let stated = columns.first()?.mapped.and_then(TableColumn::across);
    stated.or_else(|| across(&columns.iter().map(|column| column.described.as_str()).collect::<Vec<_>>()))
}

/// Between which points voltages were measured, by the names of their columns: `U_12`, `Uab` and `line voltage` between lines, `U_a`,
/// `U_1N` and `phase voltage` of a phase. Channels of an instrument, `U1` to `U3`, say nothing.
fn across(names: &[&str]) -> Option<Across> {
    let name = names.first()?;
    let words = words(name);
    let count = |some: &[&str]| words.iter().filter(|word| some.iter().any(|one| word.contains(one))).count();
    let has = |some: &[&str]| words.iter().any(|word| some.contains(&word.as_str()));
    let pairs = |of: &[[&str; 2]]| words.windows(2).any(|pair| of.iter().any(|[one, other]| pair[0] == *one && pair[1] == *other));
    // To the star point, whatever else the name says: `Phase voltage L-N`, `Line 1 to N`.
    let to_star = count(&["neutral", "stern"]) > 0
        || has(&["ln", "vln", "uln", "phn", "star"])
        || pairs(&[["l", "n"], ["ph", "n"], ["to", "n"]])
        || line_to_line::is_to_star(name);
    let is_between = |word: &str| words.windows(2).any(|pair| pair.iter().all(|one| one == word));
    let is_to = |word: &str| words.windows(3).any(|of| of[0] == word && of[1] == "to" && of[2] == word);
    let between_lines = ["l", "ph", "phase", "line"].into_iter().any(|word| is_between(word) || is_to(word))
        || count(&["verkettet", "leiter", "线电压", "线间电压", "線間電圧"]) > 0
        || has(&["ll", "vll", "ull", "ell", "line", "lines", "phph", "linetoline", "lineline"])
        || line_to_line::is_pair(name);
    let of_phase = count(&["phase", "strang", "相电压", "相電圧"]) > 0 || has(&["ph"]);
    match (to_star, between_lines, of_phase) {
        (true, ..) => Some(Across::Phase),
        (_, true, _) => Some(Across::Lines),
        (.., true) => Some(Across::Phase),
        _ => names.first_chunk::<3>().filter(|_| names.len() == 3).and_then(|names| across_by_letters(*names)),
    }
}

/// The same, by the letters in which three names differ: two of each, or one with an `n` behind it or with a letter of a phase.
fn across_by_letters(names: [&str; 3]) -> Option<Across> {
    let places = differing(names)?;
    let letters: Vec<char> = names[0].to_lowercase().chars().collect();
    match places.as_slice() {
        [one, other] if one + 1 == *other => Some(Across::Lines),
        [place] if letters.get(place + 1) == Some(&'n') => Some(Across::Phase),
        [place] if letters[*place].is_alphabetic() => Some(Across::Phase),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_between_which_points_voltages_were_measured() {
        let three = |one: &'static str, two: &'static str, three: &'static str| vec![one, two, three];
        for (names, expected) in [
            (three("U_12 [V]", "U_23 [V]", "U_31 [V]"), Some(Across::Lines)),
            (three("Uuv", "Uvw", "Uwu"), Some(Across::Lines)),
            (three("U_a [V]", "U_b [V]", "U_c [V]"), Some(Across::Phase)),
            (three("U1N", "U2N", "U3N"), Some(Across::Phase)),
            (three("PA1_URMS_1 [V]", "PA1_URMS_2 [V]", "PA1_URMS_3 [V]"), None),
            (vec!["voltage_V"], None),
            (vec!["U_ll_rms [V]"], Some(Across::Lines)),
            (vec!["Line voltage (V)"], Some(Across::Lines)),
            (vec!["L-L voltage [V]"], Some(Across::Lines)),
            (vec!["phase-to-phase voltage [V]"], Some(Across::Lines)),
            (vec!["line to line [V]"], Some(Across::Lines)),
            (vec!["line-to-neutral voltage [V]"], Some(Across::Phase)),
            (vec!["Strangspannung [V]"], Some(Across::Phase)),
            (vec!["Spannung verkettet [V]"], Some(Across::Lines)),
            (vec!["Phase voltage RMS (V)"], Some(Across::Phase)),
            (vec!["U_12 (V)"], Some(Across::Lines)),
            (vec!["U12 (V)"], Some(Across::Lines)),
            (vec!["V_AB (Vrms)"], Some(Across::Lines)),
            (vec!["Uab [V]"], Some(Across::Lines)),
            (vec!["L-L (V)"], Some(Across::Lines)),
            (vec!["U [V L-L]"], Some(Across::Lines)),
            (vec!["motor phase-phase voltage (V) rms"], Some(Across::Lines)),
            (vec!["线电压(V)"], Some(Across::Lines)),
            (vec!["相电压(V)"], Some(Across::Phase)),
            (vec!["L-N (V)"], Some(Across::Phase)),
            (vec!["Ph-N voltage (V)"], Some(Across::Phase)),
            (vec!["V_an (V)"], Some(Across::Phase)),
            (vec!["U1N [V]"], Some(Across::Phase)),
            (vec!["Phase-neutral voltage (V)"], Some(Across::Phase)),
            (vec!["phase_voltage_L-N_rms_V"], Some(Across::Phase)),
            (vec!["Phase voltage (L-N) [V rms]"], Some(Across::Phase)),
            (vec!["phase voltage V_an [Vrms]"], Some(Across::Phase)),
            (vec!["Strangspannung U1N [Vrms]"], Some(Across::Phase)),
            (vec!["Strangspannung Phase U [Vrms]"], Some(Across::Phase)),
            (vec!["Phase A phase voltage [Vrms]"], Some(Across::Phase)),
            (vec!["Line 1 to N [Vrms]"], Some(Across::Phase)),
            (vec!["Baseline phase voltage [Vrms]"], Some(Across::Phase)),
            (vec!["V_A (V)"], None),
            (vec!["Voltage (V AC)"], None),
            (vec!["Vac"], None),
            (vec!["U_1 (V)"], None),
        ] {
            assert_eq!(across(&names), expected, "{names:?}");
        }
    }

    #[test]
    fn names_tell_what_of_a_wave_was_measured() {
        let eighth = 0.125_f64.sqrt();
        for (name, factor, is_stated) in [
            ("Vpp [V]", eighth, true),
            ("bemf pk-pk (V)", eighth, true),
            ("U peak to peak [V]", eighth, true),
            ("Vpk", 2.0 * eighth, true),
            ("Scheitelwert U [V]", 2.0 * eighth, true),
            ("V_LL amp", 2.0 * eighth, true),
            ("Spitzenspannung LL", 2.0 * eighth, true),
            ("Û_LL [V]", 2.0 * eighth, true),
            ("Uss LL [V]", eighth, true),
            ("I amp", 1.0, false),
            ("PA1_URMS_1 [V]", 1.0, true),
            ("current [A]", 1.0, false),
            ("U_ll [V p-p]", eighth, true),
            ("U_ll [Vp-p]", eighth, true),
            ("U_ll [Vptp]", eighth, true),
            ("U_ll [V ptp]", eighth, true),
            ("U_ll ptp [V]", eighth, true),
            ("U_ll [Vpktopk]", eighth, true),
            ("U_ll [V pk to pk]", eighth, true),
            ("U_ll [Vpeaktopeak]", eighth, true),
            ("V_ll_peakpeak [V]", eighth, true),
            ("I [App]", eighth, true),
            ("V_ll_app [V]", 1.0, false),
            ("U [V p]", 2.0 * eighth, true),
            ("U [V_p]", 2.0 * eighth, true),
            ("Phase Voltage (Vpk)", 2.0 * eighth, true),
            ("U [Vp]", 2.0 * eighth, true),
            ("U [V 0-p]", 2.0 * eighth, true),
            ("Current [Apk]", 2.0 * eighth, true),
            ("Isc [A rms]", 1.0, true),
            ("Isc [Arms]", 1.0, true),
            ("线电压有效值(V)", 1.0, true),
            ("Voltage (V AC)", 1.0, false),
            ("Vp [V]", 1.0, false),
            ("Vll_p", 2.0 * eighth, true),
            ("U_LL p [V]", 2.0 * eighth, true),
            ("Vllp (V)", 2.0 * eighth, true),
            ("U_max [V]", 2.0 * eighth, true),
            ("Vll max (V)", 2.0 * eighth, true),
            ("Umax_ll", 2.0 * eighth, true),
            ("Urms max [V]", 1.0, true),
            ("u_hat [V]", 2.0 * eighth, true),
            ("Ampiezza tensione concatenata [V]", 2.0 * eighth, true),
        ] {
            let (found, _, states) = to_rms(name);
            assert_eq!((found, states), (factor, is_stated), "{name}");
        }
    }
}

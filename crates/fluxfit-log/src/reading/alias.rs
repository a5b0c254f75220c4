//! Columns that are read by another name than the channel's own: `u_d`, `iq_meas`, `Drehzahl [1/min]`. The whole name has to be one of the
//! usual ones, and one column alone has to have it; names that merely resemble one are only proposed.

use super::{
    counts,
    resemblance::{is_parameter, is_reference, says_reference, words},
    vocabulary::{
        ACROSS, ALONG, ANGLE, BEFORE_SPEED, BESIDE, CONTROLLER, CURRENT, CURRENT_VECTOR, MEASURED, ROTATION, SPEED, TIME, UDC, VOLTAGE,
        VOLTAGE_VECTOR, X,
    },
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
};
use fluxfit_units::Dimension;

/// The column of a channel, if exactly one has one of its usual names, and no other unit.
pub(super) fn find(channel: Channel, heads: &[ColumnHead]) -> Option<usize> {
    named_by_vector(channel, heads).or_else(|| named_alone(channel, heads))
}

fn named_alone(channel: Channel, heads: &[ColumnHead]) -> Option<usize> {
    let found = heads.iter().enumerate().filter(|(_, head)| is_alias(channel, head));
    let of: Vec<usize> = found.map(|(index, _)| index).collect();
    match of[..] {
        [one] => Some(one),
        [one, other] if channel.dimension() == Dimension::Current => measured_one([one, other], heads),
        _ => None,
    }
}

/// Of two currents, one of a controller and one that was measured, the latter: moteus has its command `servo_control.i_d_A` beside
/// `servo_stats.d_A`.
fn measured_one(currents: [usize; 2], heads: &[ColumnHead]) -> Option<usize> {
    let has = |index: usize, known: &[&str]| words(&heads[index].name).iter().any(|word| known.contains(&word.as_str()));
    let is_it = |it: usize, other: usize| has(it, &MEASURED) && !has(it, &CONTROLLER) && has(other, &CONTROLLER) && !has(other, &MEASURED);
    let [one, other] = currents;
    [(one, other), (other, one)].into_iter().find(|(it, other)| is_it(*it, *other)).map(|(it, _)| it)
}

/// Whether the names of the two axes differ in nothing but the axis: `motor_id` beside `iq` may be a number of the motor.
pub(super) fn are_pair(channels: [Channel; 2], names: [&str; 2]) -> bool {
    let beside = |k: usize| {
        let (stem, unit) = stem(channels[k], names[k]);
        named(channels[k], stem, unit).map(|(_, beside)| beside)
    };
    beside(0) == beside(1)
}

/// What the two elements of a vector of d and q are called: indices from 0 as in C, from 1 as in MATLAB, the parts of a complex number, and
/// the fields of a structure.
const ELEMENTS: [[&str; 2]; 5] = [["0", "1"], ["1", "2"], ["re", "im"], ["real", "imag"], ["d", "q"]];

/// The column of a channel, if the log has one vector of its two axes, `v_dq[0]` and `v_dq[1]`, `Idq_in_A.value[0]`, `Vdq:1`, `i_dq_re`,
/// `Stator currents (dq):1`.
fn named_by_vector(channel: Channel, heads: &[ColumnHead]) -> Option<usize> {
    let (axis, names) = match channel {
        Channel::Ud => (0, &VOLTAGE_VECTOR),
        Channel::Uq => (1, &VOLTAGE_VECTOR),
        Channel::Id => (0, &CURRENT_VECTOR),
        Channel::Iq => (1, &CURRENT_VECTOR),
        _ => return None,
    };
    let one = |references: bool| {
        let mut found = (0..heads.len()).filter_map(|of_d| vector(&heads[of_d].name, heads, names, references).map(|of_q| [of_d, of_q]));
        found.next().filter(|_| found.next().is_none())
    };
    // References of voltages are known well enough, if nothing else is there.
    let first = one(false).or_else(|| one(true).filter(|_| channel.dimension() == Dimension::Voltage))?;
    Some(first[axis])
}

/// The column with the second element of a vector, if a name is that of the first one.
fn vector(name: &str, heads: &[ColumnHead], quantities: &[&str], references: bool) -> Option<usize> {
    let name = without_unit(name);
    let parts = words(name);
    let (last, stem) = parts.split_last()?;
    // ST's library has q first, and so only its fields are known.
    let is_quantity = |word: &str| {
        let of = |quantity: &&str| {
            let is_structure = last == "d" && word == format!("{quantity}qd");
            is_structure || word == format!("{quantity}dq") || word == format!("{quantity}sdq")
        };
        quantities.iter().any(of)
    };
    // Where the quantity is a word, the others may only say that it is the motor's: there are grids and filters, too.
    let names_the_motor = |place: usize| {
        let mut others = stem[..place].iter().chain(&stem[place + 2..]);
        stem[place].len() <= 2 || others.all(|word| BESIDE.contains(&word.as_str()))
    };
    let pairs = || stem.windows(2).enumerate().filter(|(_, pair)| is_quantity(&pair.concat()));
    let is_named = stem.iter().any(|word| word.len() <= 4 && is_quantity(word)) || pairs().any(|(place, _)| names_the_motor(place));
    // A unit is read from the end of a name, or before brackets.
    let has_hidden_unit =
        || name.to_lowercase().split(|c: char| !c.is_alphanumeric()).any(|word| ["mv", "ma", "kv", "ka", "pu"].contains(&word));
    let is_plain = name.ends_with([']', ')']) || !has_hidden_unit();
    let [_, second] = *ELEMENTS.iter().find(|[first, _]| last == first)?;
    let is_second =
        |head: &ColumnHead| words(without_unit(&head.name)).split_last().is_some_and(|(end, other)| end == second && other == stem);
    let is_possible = is_named && is_plain && (references || !name.contains('*') && !says_reference(&parts));
    is_possible.then(|| heads.iter().position(is_second)).flatten()
}

/// The name of an element without the unit in brackets behind it: `Vdq(1) [V]`.
fn without_unit(name: &str) -> &str {
    let has_letters = name.ends_with([']', ')']) && name.rsplit(['[', '(']).next().is_some_and(|text| text.contains(char::is_alphabetic));
    let bare = |dimension| match split_header(name, dimension) {
        (stem, HeaderUnit::Known(_)) if has_letters => Some(stem),
        _ => None,
    };
    [Dimension::Voltage, Dimension::Current].into_iter().find_map(bare).unwrap_or(name)
}

/// Whether two names are those of the elements of one vector.
pub(super) fn are_elements(names: [&str; 2]) -> bool {
    let heads = [ColumnHead { name: names[1].to_owned(), ..ColumnHead::default() }];
    vector(names[0], &heads, &[VOLTAGE_VECTOR, CURRENT_VECTOR].concat(), true).is_some()
}

/// Whether two names, without their units, are the same but for d in one where q is in the other: `I_d` and `I_q`, not `ID` and `I_q`.
pub(super) fn differ_in_axis(dimension: Dimension, names: [&str; 2]) -> bool {
    let [of_d, of_q] = names.map(|name| split_header(name, dimension).0.to_lowercase());
    let mut axes = 0;
    let fits = |(d, q): (char, char)| {
        let is_axis = (d, q) == ('d', 'q');
        axes += usize::from(is_axis);
        is_axis || d == q
    };
    of_d.chars().count() == of_q.chars().count() && of_d.chars().zip(of_q.chars()).all(fits) && axes > 0
}

/// Whether a name is one of a channel's usual ones.
pub(super) fn is_alias(channel: Channel, head: &ColumnHead) -> bool {
    let dimension = channel.dimension();
    let of_row = head.unit.as_deref().filter(|unit| !matches!(unit.trim(), "" | "-"));
    let in_row = of_row.map(|unit| matches!(unit_in_row(unit, &head.name, dimension), HeaderUnit::Known(_)));
    let (stem, unit) = stem(channel, &head.name);
    // Of counts it is asked how many a turn has.
    let is_asked = |text: &str| counts::problem(channel, text, &head.name).is_some();
    let has_unit = match (unit, in_row) {
        (HeaderUnit::Unknown(text), None) if is_asked(text) => false,
        (HeaderUnit::None, Some(false)) if of_row.is_some_and(is_asked) => false,
        // A unit of another dimension, or none that is known.
        (HeaderUnit::Unknown(_), _) | (HeaderUnit::None, Some(false)) => return false,
        (HeaderUnit::Known(_), _) | (_, Some(true)) => true,
        _ => false,
    };
    // Of a path every part, but not the unit: `n / min^-1`.
    if is_reference(split_header(&head.name, dimension).0) {
        return false;
    }
    let Some((name, beside)) = named(channel, stem, unit) else { return false };
    // The current through an inductance of the axis, `I(Lq)` of a circuit simulator.
    let is_through = |names: [&str; 2]| head.name.trim().to_lowercase().starts_with("i(") && names.contains(&name.as_str());
    // Of `phase_current_a` the last letter is no unit.
    let is_named_phase = || is_of_named_phase(channel, stem) || is_of_named_phase(channel, field(&head.name));
    match channel {
        // `t_motor` is its temperature.
        Channel::T => {
            beside.is_empty() && (TIME.contains(&name.as_str()) || name.is_empty() || X.contains(&name.as_str()) || has_unit && name == "x")
        }
        // `f [Hz]`.
        Channel::OmegaE => {
            let glued = BEFORE_SPEED.iter().find_map(|before| name.strip_prefix(before)).filter(|rest| rest.len() >= WORD);
            is_one_of(glued.unwrap_or(&name), "speed", &SPEED) || name.is_empty() || has_unit && name == "f"
        }
        Channel::ThetaE => is_one_of(&name, "angle", &ANGLE),
        // `d_V`: the unit says the quantity.
        Channel::Ud => is_of_axis(&name, "d", &VOLTAGE) || is_german(&name, &ALONG, &VOLTAGE) || has_unit && name == "d",
        Channel::Uq => is_of_axis(&name, "q", &VOLTAGE) || is_german(&name, &ACROSS, &VOLTAGE) || has_unit && name == "q",
        Channel::Id => {
            is_of_axis(&name, "d", &CURRENT) || is_german(&name, &ALONG, &CURRENT) || has_unit && name == "d" || is_through(["ld", "lsd"])
        }
        Channel::Iq => {
            is_of_axis(&name, "q", &CURRENT) || is_german(&name, &ACROSS, &CURRENT) || has_unit && name == "q" || is_through(["lq", "lsq"])
        }
        Channel::IA | Channel::IB | Channel::IC => is_of_phase(channel, &name, "i") || is_named_phase(),
        Channel::UA | Channel::UB | Channel::UC => is_of_phase(channel, &name, "u") || is_of_phase(channel, &name, "v") || is_named_phase(),
        Channel::UAlpha => is_of_axis(&name, "alpha", &VOLTAGE),
        Channel::UBeta => is_of_axis(&name, "beta", &VOLTAGE),
        Channel::IAlpha => is_of_axis(&name, "alpha", &CURRENT),
        Channel::IBeta => is_of_axis(&name, "beta", &CURRENT),
        Channel::UDc => UDC.contains(&name.as_str()),
        Channel::Temperature => ["windingtemperature", "wicklungstemperatur"].contains(&name.as_str()),
        Channel::Run => false,
    }
}

/// The last part of a structure or of a path that names something: `log.id`, `Model Root/FOC/id/Out1`, `Machine: i_d`. A mark before a
/// digit belongs to the name.
pub(super) fn field(name: &str) -> &str {
    let name = name.trim().trim_matches(['<', '>', '"']);
    // Those of a unit in brackets are its own: `Speed [1/s]`.
    let end = if name.ends_with([']', ')']) { name.rfind(['[', '(']).unwrap_or(name.len()) } else { name.len() };
    let Some(at) = name[..end].rfind(['.', '/', ':', '|', '\\']) else { return name };
    let last = name[at + 1..].trim();
    match last.to_lowercase().as_str() {
        "out1" | "in1" | "value" | "data" => field(&name[..at]),
        _ if last.is_empty() || last.starts_with(|c: char| c.is_ascii_digit()) => name,
        _ => last,
    }
}

/// The field of a name without its unit, and the unit.
fn stem(channel: Channel, name: &str) -> (&str, HeaderUnit<'_>) {
    let name = name.trim().trim_matches(['<', '>', '"']);
    let dimension = channel.dimension();
    let (stem, unit) = match split_header(name, dimension) {
        (stem, unit @ HeaderUnit::Known(_)) => (field(stem), unit),
        // Of a unit of the field alone: `log.ms_today`.
        _ => split_header(field(name), dimension),
    };
    // `i_a` is the current of a phase, not one in A, and so is `iabc_a`; `I [A]` is in A. `u_uvw_v` is of the phase v, not in V.
    let is_whole = stem.len() == 1 || ALL_PHASES.iter().any(|all| words(stem).concat().ends_with(all));
    if is_whole && Channel::PHASES.contains(&channel) && !name.contains(['[', '(']) {
        (field(name), HeaderUnit::None)
    } else {
        (stem, unit)
    }
}

/// The words of a name without those beside it, as one; and those beside it. None if nothing but a unit is left of another channel than
/// time or speed.
fn named(channel: Channel, stem: &str, unit: HeaderUnit) -> Option<(String, Vec<String>)> {
    let dimension = channel.dimension();
    let is_beside = |word: &String| {
        BESIDE.contains(&word.as_str())
            || matches!(dimension, Dimension::Speed | Dimension::Angle) && (ROTATION.contains(&word.as_str()) || is_parameter(word))
    };
    let plain = |word: &String| {
        let mut word = word.clone();
        [('α', "alpha"), ('β', "beta"), ('ω', "omega"), ('θ', "theta"), ('φ', "phi")]
            .iter()
            .for_each(|(from, to)| word = word.replace(*from, to));
        // German writes in one that a value was measured: `Drehzahlistwert`.
        if let Some(measured) = word.strip_suffix("istwert").filter(|measured| measured.len() >= WORD) {
            word = measured.to_owned();
        }
        [('ä', "ae"), ('à', "a"), ('é', "e"), ('ó', "o"), ('ö', "oe")].iter().for_each(|(from, to)| word = word.replace(*from, to));
        word
    };
    let (mut beside, names): (Vec<String>, Vec<String>) = without_identifier(words(stem)).into_iter().partition(is_beside);
    beside.sort();
    let may_be_unit = matches!(dimension, Dimension::Time | Dimension::Speed) && matches!(unit, HeaderUnit::Known(_)) && stem.is_empty();
    (!names.is_empty() || may_be_unit).then(|| (names.iter().map(plain).collect(), beside))
}

/// The words behind the number of a parameter, as drives write it before its name: `r0076 Stromistwert`, `P-0-0043, Strom`.
fn without_identifier(mut words: Vec<String>) -> Vec<String> {
    let are_digits = |word: &String, count: usize| word.len() == count && word.bytes().all(|byte| byte.is_ascii_digit());
    let of_siemens = words.first().is_some_and(|word| word.len() == 5 && is_parameter(word));
    let of_sercos =
        matches!(&words[..], [kind, set, number, ..] if ["s", "p"].contains(&kind.as_str()) && are_digits(set, 1) && are_digits(number, 4));
    words.drain(..if of_sercos { 3 } else { usize::from(of_siemens) });
    words
}

/// Shortest name of a quantity that is a word.
const WORD: usize = 4;

/// Whether a name is one of a quantity's, or one of them behind a word for it: `Rotor speed wm`, `Drehzahl n`.
fn is_one_of(name: &str, quantity: &str, names: &[&str]) -> bool {
    let words = names.iter().copied().filter(|word| word.len() >= WORD).chain([quantity]);
    let mut rests = words.filter_map(|word| name.strip_prefix(word));
    names.contains(&name) || rests.any(|rest| names.contains(&rest))
}

/// Whether a name is a quantity with the letter of its axis, or the word of the quantity beside that: `Stator current is_q`.
fn is_of_axis(name: &str, axis: &str, quantities: &[&str]) -> bool {
    let is = |name: &str| {
        quantities.iter().any(|quantity| {
            let orders = [format!("{quantity}{axis}"), format!("{quantity}{axis}axis"), format!("{quantity}{axis}achse")];
            let reversed = [
                format!("{axis}{quantity}"),
                format!("{axis}axis{quantity}"),
                format!("{axis}achse{quantity}"),
                format!("{axis}achsen{quantity}"),
                format!("{axis}轴{quantity}"),
                format!("{axis}軸{quantity}"),
            ];
            // `i_qs`: q of the stator.
            let of_stator = quantity.len() == 1 && name == format!("{quantity}{axis}s");
            of_stator || orders.iter().any(|order| order == name) || quantity.len() > 2 && reversed.iter().any(|order| order == name)
        })
    };
    let of_quantity = |word: &&&str| word.len() > 2;
    let beside_word = |word: &&str| name.strip_prefix(word).or_else(|| name.strip_suffix(word)).is_some_and(is);
    is(name) || quantities.iter().filter(of_quantity).any(beside_word)
}

/// Whether a name is a quantity and a German word for its axis: `Querstrom`, `Strom feldbildend`, `momentenbildender Strom`.
fn is_german(name: &str, axis: &[&str], quantities: &[&str]) -> bool {
    let is = |axis: &&str, quantity: &&str| {
        let before = name.strip_prefix(axis).map(|rest| rest.trim_start_matches("er").trim_start_matches("e"));
        before == Some(quantity) || name.strip_suffix(axis) == Some(quantity)
    };
    quantities.iter().filter(|quantity| quantity.len() > 2).any(|quantity| axis.iter().any(|axis| is(axis, quantity)))
}

/// Words that say that the letter beside them is a phase.
const PHASE: [&str; 3] = ["phase", "ph", "strang"];

/// Letters and numbers of the three phases.
const LETTERS: [[&str; 4]; 3] = [["a", "u", "1", "r"], ["b", "v", "2", "s"], ["c", "w", "3", "t"]];

/// Whether a name is a quantity, the word phase and the letter of one: `Current(PhaseA)`, `Phase A Current`, `I phase U`. Between two
/// phases there would be two letters.
fn is_of_named_phase(channel: Channel, name: &str) -> bool {
    let (place, quantities): (usize, &[&str]) = match channel {
        Channel::IA => (0, &CURRENT),
        Channel::IB => (1, &CURRENT),
        Channel::IC => (2, &CURRENT),
        Channel::UA => (0, &VOLTAGE),
        Channel::UB => (1, &VOLTAGE),
        Channel::UC => (2, &VOLTAGE),
        _ => return false,
    };
    let words: Vec<String> = words(name).into_iter().filter(|word| !BESIDE.contains(&word.as_str())).collect();
    let Some(phase) = words.iter().position(|word| PHASE.contains(&word.as_str())).filter(|_| words.len() == 3) else { return false };
    // The letter stands behind the word phase, as in `U phase V`, or else before it or at the end.
    let letter = |at: usize| {
        let quantity = &words[3 - phase - at];
        let of = LETTERS.iter().position(|letters| letters.contains(&words[at].as_str()));
        of.filter(|_| quantities.contains(&quantity.as_str()))
    };
    let places = [(phase + 1) % 3, (phase + 2) % 3];
    places.into_iter().find_map(letter) == Some(place)
}

/// What the vector of the three phases is called, beside its quantity.
const ALL_PHASES: [&str; 2] = ["abc", "uvw"];

/// Whether a name is that of a phase: by its letter, or of a current by u, v, w, where no line voltage can be meant; or by its letter in
/// the vector of all three, `iabc_a`.
fn is_of_phase(channel: Channel, name: &str, quantity: &str) -> bool {
    let (letter, other) = match channel {
        Channel::IA | Channel::UA => ("a", "u"),
        Channel::IB | Channel::UB => ("b", "v"),
        _ => ("c", "w"),
    };
    let of_vector = || ALL_PHASES.iter().zip([letter, other]).any(|(all, phase)| name == format!("{quantity}{all}{phase}"));
    name == format!("{quantity}{letter}") || quantity == "i" && name == format!("i{other}") || of_vector()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(channel: Channel, name: &str) -> bool {
        is_alias(channel, &ColumnHead { name: name.to_owned(), ..ColumnHead::default() })
    }

    #[test]
    fn usual_names_are_read() {
        for (channel, names) in [
            (
                Channel::T,
                &["Time [ms]", "Zeit", "timestamp", "Zeit (s)", "micros", "Time Stamp", "temps_s", "log.time", "tout", "时间(s)"][..],
            ),
            (
                Channel::Ud,
                &[
                    "u_d",
                    "Vd",
                    "vd_meas",
                    "Spannung d [V]",
                    "motor_vd",
                    "d_axis_voltage",
                    "usd",
                    "drive.foc.Vd",
                    "d_V",
                    "v_ds",
                    "Längsspannung (V)",
                ],
            ),
            (
                Channel::Id,
                &[
                    "Model Root/FOC/id/Out1",
                    "Machine: i_d",
                    "<Stator current is_d (A)>",
                    "M1_Id [A]",
                    "Id/A",
                    "group\\id",
                    "Inv_Id",
                    "d轴电流（A）",
                ],
            ),
            (Channel::UAlpha, &["u_alpha", "Valpha [V]", "uα", "foc.v_alpha"]),
            (
                Channel::Iq,
                &[
                    "i_q",
                    "iq_meas",
                    "Iq_measured (A)",
                    "Strom_q [A]",
                    "q-Achsen-Strom",
                    "Querstrom [A]",
                    "Stromistwert momentenbildend [A]",
                    "momentenbildender Strom",
                    "MotorIq",
                    "iq_mA",
                    "Courant q",
                ],
            ),
            (
                Channel::OmegaE,
                &[
                    "f_el [Hz]",
                    "Revolution speed[rpm]",
                    "Encoder/n",
                    "Drehzahl n in 1/min",
                    "转速(rpm)",
                    "<Rotor speed wm (rad/s)>",
                    "Machine: Rotational speed",
                    "freq [Hz]",
                    "n / min^-1",
                    "erpm",
                    "Drehzahl [1/min]",
                    "speed_rpm",
                    "omega_el",
                    "Motor Speed (rpm)",
                    "w_e",
                    "n [U/min]",
                    "rpm",
                    "Motordrehzahl [1/min]",
                    "r0063 Drehzahlistwert [1/min]",
                    "Istdrehzahl (min-1)",
                    "Drehzahlistwert [1/min]",
                    "Drehzahl Welle (U/min)",
                    "ω_m [rad/s]",
                ],
            ),
            (Channel::ThetaE, &["theta", "theta_el", "Rotorwinkel [°]", "electrical_angle_deg", "θ_e"]),
            (Channel::UDc, &["vbus", "V_dc", "dc_link_voltage [V]"]),
            (
                Channel::IA,
                &[
                    "i_a",
                    "iu",
                    "ia_meas [A]",
                    "Current(PhaseA) [A]",
                    "Phase A Current (A)",
                    "I phase U",
                    "phase_current_a",
                    "Strom Phase 1 [A]",
                    "iabc_a",
                    "i_abc_a [A]",
                    "Iuvw_u",
                ],
            ),
            (
                Channel::UB,
                &[
                    "u_b",
                    "Voltage(PhaseB) [V]",
                    "U phase V",
                    "phase_b_voltage_V",
                    "Motor Phase B Voltage",
                    "V_phase_b",
                    "vabc_b",
                    "u_uvw_v",
                ],
            ),
        ] {
            names.iter().for_each(|name| assert!(is(channel, name), "{name} is {}", channel.name()));
        }
    }

    /// As the SDKs of TI and ST, PLECS, numpy and MATLAB name them; and what is no pair.
    #[test]
    fn elements_of_a_vector_are_d_and_q() {
        let found = |names: &[&str]| {
            let heads: Vec<ColumnHead> =
                names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect();
            [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq].map(|channel| find(channel, &heads))
        };
        let all = [Some(0), Some(1), Some(2), Some(3)];
        assert_eq!(found(&["Vdq_out_V.value[0]", "Vdq_out_V.value[1]", "m.Idq_in_A.value[0]", "m.Idq_in_A.value[1]"]), all);
        assert_eq!(found(&["FOCVars.Vqd.d", "FOCVars.Vqd.q", "FOCVars.Iqd.d", "FOCVars.Iqd.q"]), all);
        assert_eq!(found(&["Vqd[0]", "Vqd[1]", "FOCVars.Iqdref.d", "FOCVars.Iqdref.q"]), [None; 4]);
        assert_eq!(found(&["Vdq:1", "Vdq:2", "Idq:1", "Idq:2"]), all);
        assert_eq!(found(&["Vdq_cmd(1)", "Vdq_cmd(2)", "Idq(1)", "Idq(2)"]), all);
        assert_eq!(found(&["Vdq_cmd(1) [V]", "Vdq_cmd(2) [V]", "Idq[0] (A)", "Idq[1] (A)"]), all);
        assert_eq!(found(&["Vdq(1)", "Vdq(2)", "Vdq_cmd(1)", "Vdq_cmd(2)"]), [Some(0), Some(1), None, None]);
        assert_eq!(found(&["Voltages (dq):1", "Voltages (dq):2", "Stator currents (dq):1", "Stator currents (dq):2"]), all);
        assert_eq!(found(&["v_dq[0]", "v_dq[1]", "i_dq[0]", "i_dq[1]"]), all);
        assert_eq!(found(&["udq(:,1)", "udq(:,2)", "i_sdq_re", "i_sdq_im"]), all);
        for other in [
            "Currents (dq) ref",
            "Currents (dq)*",
            "Currents (dq, setpoint)",
            "Grid currents (dq)",
            "Commanded currents dq",
            "Filter current dq",
        ] {
            assert_eq!(found(&[&format!("{other}:1"), &format!("{other}:2")]), [None; 4], "{other}");
        }
        assert_eq!(found(&["v_dq_mV[0]", "v_dq_mV[1]", "i_dq_mA_re", "i_dq_mA_im"]), [Some(0), Some(1), None, None]);
        assert_eq!(found(&["v_dq[0]", "v_dq[2]", "i_dq_ref[0]", "i_dq_ref[1]"]), [None; 4]);
        assert_eq!(found(&["a.idq[0]", "a.idq[1]", "b.idq[0]", "b.idq[1]"]), [None; 4]);
    }

    /// As moteus logs them; of one current alone the path says nothing.
    #[test]
    fn a_current_of_a_controller_is_its_command_beside_another() {
        let heads = |names: &[&str]| -> Vec<ColumnHead> {
            names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect()
        };
        let moteus = heads(&["servo_stats.d_A", "servo_control.d_V", "servo_control.i_d_A"]);
        assert_eq!([Channel::Id, Channel::Ud].map(|channel| find(channel, &moteus)), [Some(0), Some(1)]);
        assert_eq!(find(Channel::Id, &heads(&["motor_control.id"])), Some(0));
        assert_eq!(find(Channel::Id, &heads(&["a.id", "b.id", "control.id"])), None);
        assert_eq!(find(Channel::Id, &heads(&["observer.id", "control.id"])), None);
        assert_eq!(find(Channel::Ud, &heads(&["stats.ud", "control.ud"])), None);
    }

    #[test]
    fn references_other_units_and_other_words_are_not() {
        for (channel, names) in [
            (
                Channel::T,
                &["LEW_SO_T_P1 [°C]", "T [°C]", "timestep", "time_step", "t_motor", "Time [Nm]", "timestep (8Hz)", "x", "x [mm]"][..],
            ),
            (
                Channel::Iq,
                &[
                    "iq_ref",
                    "iq_setpoint",
                    "iq_step",
                    "iq_target",
                    "Iq [V]",
                    "iq_error",
                    "absorber_iq",
                    "q",
                    "i_q_limit",
                    "iq*",
                    "iq_rms",
                    "Iq [Arms]",
                ],
            ),
            (Channel::Id, &["vesc_id", "id_set", "run_id", "DC current", "direct current", "target.id", "d", "motor 3/id_ref"]),
            (
                Channel::IA,
                &[
                    "I [A]",
                    "I (A)",
                    "Phase A",
                    "iabc",
                    "iabc_b",
                    "iabc_ref_a",
                    "Phase AB current",
                    "Phase A RMS Current",
                    "Phase A current ref",
                    "phase a to b current",
                ],
            ),
            (Channel::UA, &["Phase A Current", "U phase V", "Voltage phase A phase B", "phase angle u"]),
            (
                Channel::OmegaE,
                &[
                    "speed_step",
                    "speed setpoint",
                    "speed_meters_per_sec",
                    "Velocity (m/s)",
                    "wind speed",
                    "SO_N_SOLL",
                    "Solldrehzahl",
                    "Nenndrehzahl",
                ],
            ),
            (Channel::Ud, &["u_dc", "ud_ref", "vd [mA]", "u_d [°C]"]),
        ] {
            names.iter().for_each(|name| assert!(!is(channel, name), "{name} is not {}", channel.name()));
        }
    }

    #[test]
    fn both_axes_are_named_alike() {
        let pair = [Channel::Id, Channel::Iq];
        assert!(are_pair(pair, ["motor_id", "motor_iq"]) && are_pair(pair, ["i_d", "iq"]));
        assert!(!are_pair(pair, ["motor_id", "iq_meas"]));
    }

    #[test]
    fn names_of_two_axes_differ_in_the_axis_alone() {
        let differ = |names| differ_in_axis(Dimension::Current, names);
        assert!(differ(["id", "iq"]) && differ(["I_d [A]", "I_q [mA]"]) && differ(["d-axis current", "q-axis current"]));
        assert!(!differ(["ID", "I_q"]) && !differ(["id", "q_current"]) && !differ(["current", "current"]));
    }
}

//! Names that resemble those of a channel or of a reference: for proposals and warnings only, a column is never read because of them.

use super::vocabulary::{ACROSS, ALONG};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, share, split_header, unit_in_row, unit_of_cell},
};
use fluxfit_units::Dimension;

/// Smallest similarity, 0 to 1, of a misspelt time or speed: one wrong letter in four. Voltages and currents must be spelt exactly,
/// because d and q differ by one letter.
const SIMILAR: f64 = 0.75;

/// Shorter names must be spelt exactly.
const SHORT: usize = 4;

/// Close to `timestamp`, and a count of rows.
const NO_TIME: [&str; 2] = ["timestep", "timesteps"];

/// Other words in a header reduce the similarity, by at most this.
const OTHER_WORDS: f64 = 0.2;

/// The share of other words is rounded to this many steps, so that small differences decide nothing: `Absorber speed` is not
/// preferred to `Test motor speed`.
const STEPS: f64 = 10.0;

/// Most words of a name in which `nm` is a speed.
const MOST_BESIDE_NM: usize = 2;

/// Maximum number of words of a header that make one name, as in `q-axis current`.
const WORDS: usize = 3;

/// Words in the name of a column that mark it as a reference or another number that is no measurement; `soll` is German.
const REFERENCE: [&str; 32] = [
    "ref",
    "reference",
    "references",
    "setpoints",
    "commanded",
    "traj",
    "trajectory",
    "req",
    "request",
    "requested",
    "cmd",
    "command",
    "target",
    "setpoint",
    "sp",
    "demand",
    "desired",
    "set",
    "soll",
    "step",
    "steps",
    "index",
    "limit",
    "lim",
    "max",
    "min",
    "error",
    "err",
    "offset",
    "nominal",
    "nom",
    "rated",
];

/// Units of quantities that no channel has.
const OTHER_UNITS: [&str; 22] = [
    "nm", "n m", "n.m", "n.mm", "mnm", "w", "kw", "%", "k", "f", "°f", "l/min", "bar", "pa", "kpa", "kg", "g", "m/s", "m/s²", "km/h", "wh",
    "ah",
];

/// Words before `id` that make it the number of something.
const NUMBERED: [&str; 16] = [
    "data", "device", "node", "can", "msg", "message", "frame", "packet", "row", "sample", "sensor", "session", "profile", "user",
    "vehicle", "trip",
];

/// Words of the speed of what a motor drives, which is none of its own: `vehicle_speed_kmh`.
const DRIVEN: [&str; 9] = ["vehicle", "veh", "car", "bike", "gps", "wind", "kmh", "kph", "mph"];

/// Words for a torque, whose unit in `torque_nm` is PSIM's name of a speed.
const TORQUES: [&str; 5] = ["torque", "torq", "trq", "moment", "drehmoment"];

/// Whether a header states the unit of another quantity than the channel's.
pub(super) fn has_other_unit(channel: Channel, head: &ColumnHead) -> bool {
    let dimension = channel.dimension();
    let own = match (split_header(&head.name, dimension).1, head.unit.as_deref()) {
        (HeaderUnit::Unknown(text), _) => Some(text),
        (HeaderUnit::None, Some(unit)) => match unit_in_row(unit, &head.name, dimension) {
            HeaderUnit::Unknown(text) => Some(text),
            _ => None,
        },
        _ => None,
    };
    let Some(text) = own.map(|text| unit_of_cell(text).to_lowercase()) else { return false };
    let is_of =
        |other: Channel| other.dimension() != dimension && matches!(unit_in_row(&text, "", other.dimension()), HeaderUnit::Known(_));
    // Voltages, currents and speeds may be shares of base values.
    if share(&text).is_some() && matches!(dimension, Dimension::Voltage | Dimension::Current | Dimension::Speed) {
        return false;
    }
    OTHER_UNITS.contains(&text.as_str()) || Channel::all().any(is_of)
}

/// Whether the name of a column says that it is a reference, or another number that was not measured.
pub(super) fn is_reference(header: &str) -> bool {
    // `id*`: the mark of a reference in a formula.
    let has_star = header.split(['[', '(']).next().unwrap_or(header).trim_end().ends_with('*');
    has_star || says_reference(&without_unit(header))
}

/// The same of the words of a name.
pub(super) fn says_reference(words: &[String]) -> bool {
    words.iter().any(|word| REFERENCE.contains(&word.as_str()) || word.ends_with(SOLLWERT))
}

/// What German writes in one with the quantity of a reference: `Stromsollwert`.
const SOLLWERT: &str = "sollwert";

/// The words of a header before brackets: 1/min is no minimum.
fn without_unit(header: &str) -> Vec<String> {
    words(header.split(['[', '(']).next().unwrap_or(header))
}

/// How a header resembles a channel.
pub(super) struct Fit {
    /// 1 for a name of the channel and nothing else; other words and wrong letters take from it.
    pub(super) score: f64,
    /// What stands before and behind the name of the channel, without a unit: the same for columns that belong together.
    pub(super) around: String,
}

/// The best similarity of consecutive words to a spelling.
pub(super) fn fit(channel: Channel, name: &str) -> Option<Fit> {
    let words = words(name);
    // Neither time nor speed is proposed for a reference; voltages are, because their references are measured well enough.
    if matches!(channel.dimension(), Dimension::Time | Dimension::Speed)
        && (is_reference(name) || NO_TIME.contains(&without_unit(name).concat().as_str()))
    {
        return None;
    }
    let is_number = |pair: &[String]| pair[1] == "id" && NUMBERED.contains(&pair[0].as_str());
    if channel == Channel::Id && words.windows(2).any(is_number) {
        return None;
    }
    // The time of a structure: `uq.Time`.
    if channel.dimension() != Dimension::Time && name.to_lowercase().ends_with(".time") {
        return None;
    }
    // `Nm` is the unit of a torque.
    if channel == Channel::T && is_in_tesla(name) || channel == Channel::OmegaE && name.contains("Nm") {
        return None;
    }
    let is_other = |word: &String| TORQUES.contains(&word.as_str()) || DRIVEN.contains(&word.as_str());
    if channel == Channel::OmegaE && words.iter().any(is_other) {
        return None;
    }
    let has_any = |some: &[&str]| words.iter().any(|word| some.contains(&word.as_str()));
    if channel == Channel::OmegaE && has_any(&["angle", "winkel", "position"]) && !has_any(&["speed", "velocity"]) {
        return None;
    }
    let letters: usize = words.iter().map(|word| word.chars().count()).sum();
    let runs = (0..words.len()).flat_map(|start| (start + 1..=(start + WORDS).min(words.len())).map(move |end| start..end));
    let fits = runs.filter_map(|run| {
        let joined = words[run.clone()].concat();
        // A speed that PSIM calls `nm`; among other words it is an abbreviation.
        if joined == "nm" && words.len() > MOST_BESIDE_NM {
            return None;
        }
        let (bare, number) = without_number(&joined);
        let of = |text: &str| channel.spellings().iter().map(|spelling| similarity(channel, text, spelling)).fold(0.0, f64::max);
        let (similarity, named, number) = match of(bare) {
            exact if exact == 1.0 => (exact, bare, number),
            _ => (of(&joined), joined.as_str(), ""),
        };
        let others = 1.0 - (STEPS * named.chars().count() as f64 / letters as f64).round() / STEPS;
        let fit = || Fit { score: similarity - OTHER_WORDS * others, around: around(channel, name, &words, run, number) };
        (similarity >= SIMILAR).then(fit)
    });
    // Of equal ones the first.
    fits.chain(of_bus(channel, &words))
        .chain(of_german(channel, &words))
        .chain(of_power(channel, &words))
        .reduce(|best, next| if next.score > best.score { next } else { best })
}

/// Words between the quantity and the axis of a signal of a bus: its frame, and what it is.
const OF_BUS: [&str; 20] = [
    "ref",
    "cmd",
    "meas",
    "act",
    "fb",
    "s",
    "stator",
    "motor",
    "dq",
    "ab",
    "alp",
    "bet",
    "alpha",
    "beta",
    "alphabeta",
    "alpbet",
    "d",
    "q",
    "out",
    "in",
];

/// How the name of a signal of a bus resembles a channel: the quantity first, the axis last, as in `vRefAlpBet_Alpha`, `iMeasDQ.Q`.
fn of_bus(channel: Channel, words: &[String]) -> Option<Fit> {
    let axis = match channel {
        Channel::Ud | Channel::Id => "d",
        Channel::Uq | Channel::Iq => "q",
        Channel::UAlpha | Channel::IAlpha => "alpha",
        Channel::UBeta | Channel::IBeta => "beta",
        _ => return None,
    };
    let quantities: &[&str] = if channel.dimension() == Dimension::Voltage { &["v", "u", "voltage"] } else { &["i", "current"] };
    let [first, middle @ .., last] = words else { return None };
    let frame = quantities.iter().find_map(|quantity| first.strip_prefix(quantity))?;
    let is_known = |word: &str| OF_BUS.contains(&word);
    let is_signal = (frame.is_empty() || is_known(frame)) && middle.iter().all(|word| is_known(word)) && last == axis;
    let letters: usize = words.iter().map(|word| word.chars().count()).sum();
    let others = 1.0 - (STEPS * (first.len() + last.len()) as f64 / letters as f64).round() / STEPS;
    // `id` of `i_d` is no bus.
    let is_bus = is_signal && !(middle.is_empty() && frame.is_empty());
    is_bus.then(|| Fit { score: 1.0 - OTHER_WORDS * others, around: format!("{first} {}||", middle.join(" ")) })
}

/// How a name resembles a channel by a German word for its axis and one for its quantity, as in `r1732 Längsspannungssollwert`.
fn of_german(channel: Channel, words: &[String]) -> Option<Fit> {
    let (axis, quantity): (&[&str], &str) = match channel {
        Channel::Ud => (&ALONG, "spannung"),
        Channel::Uq => (&ACROSS, "spannung"),
        Channel::Id => (&ALONG, "strom"),
        Channel::Iq => (&ACROSS, "strom"),
        _ => return None,
    };
    let name = words.iter().filter(|word| !is_parameter(word)).map(|word| word.replace('ä', "ae")).collect::<Vec<_>>().join(" ");
    let is_word = |axis: &str| words.iter().any(|word| word.strip_prefix(axis).is_some_and(|rest| ["", "e", "er"].contains(&rest)));
    let has = |axis: &&&str| name.contains(&format!("{axis}{quantity}")) || is_word(axis) && name.contains(quantity);
    let axis = axis.iter().find(has)?;
    // The reference of a voltage is measured well enough, that of a current is not.
    if quantity == "strom" && says_reference(words) {
        return None;
    }
    let around = name.replace(*axis, "|");
    let others = 1.0 - (STEPS * (axis.len() + quantity.len()) as f64 / name.len() as f64).round() / STEPS;
    Some(Fit { score: 1.0 - OTHER_WORDS * others, around })
}

/// How a name resembles a current by the power that it makes at the motor, as in Elmo's `Active Current [A]`, `Reactive Current [A]`.
fn of_power(channel: Channel, words: &[String]) -> Option<Fit> {
    let power = match channel {
        Channel::Id => "reactive",
        Channel::Iq => "active",
        _ => return None,
    };
    let is_it = words.windows(2).any(|pair| pair[0] == power && pair[1] == "current");
    (is_it && !says_reference(words)).then(|| Fit { score: 1.0 - OTHER_WORDS, around: "|current".to_owned() })
}

/// Whether a word is the number of a converter's parameter, as before a name in Siemens' tools: `r0076 Stromistwert feldbildend`.
pub(super) fn is_parameter(word: &str) -> bool {
    let digits = word.strip_prefix(['r', 'p']).unwrap_or_default();
    (DIGITS..=MOST_DIGITS).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// Digits of such a number: `r78` in traces of STARTER.
const DIGITS: usize = 2;
const MOST_DIGITS: usize = 5;

/// Whether a name ends in the unit of a flux density, `Bmax_T`: that letter is no time.
fn is_in_tesla(name: &str) -> bool {
    let name = name.trim_end_matches([']', ')']);
    name.strip_suffix('T').is_some_and(|before| before.ends_with(['_', ' ', '[', '(']))
}

/// A name and the number behind it, of one motor of several: `vd1`. Of a single letter it is more: `T1` is a temperature.
fn without_number(name: &str) -> (&str, &str) {
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit());
    if bare.chars().count() > 1 { name.split_at(bare.len()) } else { (name, "") }
}

/// What stands around some of the words of a name.
fn around(channel: Channel, name: &str, words: &[String], run: std::ops::Range<usize>, number: &str) -> String {
    let end = match split_header(name, channel.dimension()) {
        (stem, HeaderUnit::Known(_)) => self::words(stem).len().max(run.end),
        _ => words.len(),
    };
    let behind = words.get(run.end..end).unwrap_or_default();
    format!("{}|{number}|{}", words[..run.start].join(" "), behind.join(" "))
}

fn similarity(channel: Channel, run: &str, spelling: &str) -> f64 {
    let may_be_misspelt = matches!(channel.dimension(), Dimension::Time | Dimension::Speed) && spelling.len() >= SHORT;
    if run == spelling {
        1.0
    } else if may_be_misspelt && run.len() < 2 * spelling.len() {
        strsim::normalized_damerau_levenshtein(run, spelling)
    } else {
        0.0
    }
}

/// The words of a name in lower case, split at punctuation and where a capital follows a small letter, as in `MotorVd`.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut small_before = false;
    for c in name.chars() {
        if !c.is_alphanumeric() || (small_before && c.is_uppercase()) {
            words.push(String::new());
        }
        if c.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        small_before = c.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_and_the_speed_of_a_vehicle_are_no_speed_of_the_motor() {
        for name in ["Angle (deg mech)", "Winkel n", "vehicle_speed_kmh", "car speed"] {
            assert!(fit(Channel::OmegaE, name).is_none(), "{name}");
        }
        assert!(fit(Channel::OmegaE, "motor speed").is_some() && fit(Channel::OmegaE, "angle velocity").is_some());
    }

    /// As a trace of Siemens' STARTER names them.
    #[test]
    fn german_names_of_both_axes_are_of_one_motor() {
        let around = |channel: Channel, name: &str| fit(channel, name).map(|fit| fit.around);
        let names = [
            (Channel::Ud, Channel::Uq, "r1732 Längsspannungssollwert [Veff]", "r1733 Querspannungssollwert [Veff]"),
            (Channel::Id, Channel::Iq, "r0076 Stromistwert feldbildend [Aeff]", "r0078 Stromistwert momentenbildend [Aeff]"),
        ];
        for (d, q, of_d, of_q) in names {
            assert!(around(d, of_d).is_some() && around(d, of_d) == around(q, of_q), "{of_d} {of_q}");
            assert!(fit(q, of_d).is_none() && fit(d, of_q).is_none(), "{of_d} {of_q}");
        }
        assert!(fit(Channel::Id, "r0075 Stromsollwert feldbildend").is_none() && fit(Channel::Iq, "query_strom").is_none());
        assert!(fit(Channel::Ud, "Querstrom").is_none() && fit(Channel::Iq, "Querbeschleunigung").is_none());
    }

    #[test]
    fn the_number_of_something_is_no_current() {
        for name in ["data_id", "CAN ID", "node_id", "Sample id"] {
            assert!(fit(Channel::Id, name).is_none(), "{name}");
        }
        for name in ["motor_id", "my id", "test_id"] {
            assert!(fit(Channel::Id, name).is_some(), "{name}");
        }
    }

    #[test]
    fn references_are_recognized_by_name() {
        for header in ["IqReq", "id_ref", "i_d_ref (A)", "iq setpoint", "ID_CMD", "id*", "iq* [A]"] {
            assert!(is_reference(header), "{header}");
        }
        for header in ["id", "motor_id_a", "Id preferred", "i_q", "outset_id"] {
            assert!(!is_reference(header), "{header}");
        }
    }
}

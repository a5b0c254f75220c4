//! Columns that are read by another name than the channel's own: `u_d`, `iq_meas`, `Drehzahl [1/min]`. The whole name has to be one of the
//! usual ones, and one column alone has to have it; names that merely resemble one are only proposed.

use super::resemblance::{is_reference, words};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
};
use fluxfit_units::Dimension;

/// Words that say only that a value was measured, and where.
const BESIDE: [&str; 16] = [
    "meas",
    "measured",
    "measurement",
    "act",
    "actual",
    "ist",
    "istwert",
    "fb",
    "fbk",
    "feedback",
    "motor",
    "mot",
    "stator",
    "foc",
    "drive",
    "inverter",
];

/// Further ones beside a speed or an angle.
const ROTATION: [&str; 14] = [
    "rotor",
    "shaft",
    "angular",
    "rotational",
    "mech",
    "mechanical",
    "elec",
    "electrical",
    "el",
    "e",
    "mechanisch",
    "elektrisch",
    "m",
    "r",
];

const CURRENT: [&str; 8] = ["i", "is", "current", "strom", "courant", "corrente", "corriente", "stroem"];
const VOLTAGE: [&str; 10] = ["u", "v", "us", "vs", "voltage", "volt", "spannung", "tension", "tensione", "voltaje"];
const TIME: [&str; 18] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "datetime",
    "seconds",
    "elapsedtime",
    "elapsed",
    "reltime",
    "relativetime",
    "testtime",
    "zeit",
    "zeitstempel",
    "messzeit",
    "temps",
    "tempo",
    "tiempo",
    "xvalue",
];
const SPEED: [&str; 12] =
    ["omega", "w", "speed", "velocity", "rpm", "erpm", "n", "drehzahl", "vitesse", "velocita", "velocidad", "winkelgeschwindigkeit"];
const ANGLE: [&str; 8] = ["theta", "angle", "phi", "epsilon", "winkel", "rotorwinkel", "position", "rotorangle"];

/// The column of a channel, if exactly one has one of its usual names, and no other unit.
pub(super) fn find(channel: Channel, heads: &[ColumnHead]) -> Option<usize> {
    let mut found = heads.iter().enumerate().filter(|(_, head)| is_alias(channel, head)).map(|(index, _)| index);
    let first = found.next();
    first.filter(|_| found.next().is_none())
}

/// Whether the names of the two axes differ in nothing but the axis: `motor_id` beside `iq` may be a number of the motor.
pub(super) fn are_pair(channels: [Channel; 2], names: [&str; 2]) -> bool {
    let beside = |k: usize| named(channels[k], names[k]).map(|(_, beside)| beside);
    beside(0) == beside(1)
}

/// Whether a name is one of a channel's usual ones.
pub(super) fn is_alias(channel: Channel, head: &ColumnHead) -> bool {
    let dimension = channel.dimension();
    let field = field(&head.name);
    let of_row = head.unit.as_deref().filter(|unit| !matches!(unit.trim(), "" | "-"));
    let has_unit = |unit: HeaderUnit| matches!(unit, HeaderUnit::Known(_));
    match (split_header(field, dimension).1, of_row) {
        // A unit of another dimension, or none that is known.
        (HeaderUnit::Unknown(_), _) => return false,
        (HeaderUnit::None, Some(unit)) if !has_unit(unit_in_row(unit, field, dimension)) => return false,
        _ => {}
    }
    if is_reference(field) {
        return false;
    }
    let Some((name, beside)) = named(channel, field) else { return false };
    match channel {
        // `t_motor` is its temperature.
        Channel::T => beside.is_empty() && (TIME.contains(&name.as_str()) || name.is_empty()),
        Channel::OmegaE => SPEED.contains(&name.as_str()) || name.is_empty(),
        Channel::ThetaE => ANGLE.contains(&name.as_str()),
        Channel::Ud => is_of_axis(&name, "d", &VOLTAGE),
        Channel::Uq => is_of_axis(&name, "q", &VOLTAGE),
        Channel::Id => is_of_axis(&name, "d", &CURRENT),
        Channel::Iq => is_of_axis(&name, "q", &CURRENT),
        Channel::IA | Channel::IB | Channel::IC => is_of_phase(channel, &name, "i"),
        Channel::UA | Channel::UB | Channel::UC => is_of_phase(channel, &name, "u") || is_of_phase(channel, &name, "v"),
        Channel::UDc => {
            ["udc", "vdc", "ubus", "vbus", "uzk", "dcvoltage", "dclinkvoltage", "dcbusvoltage", "busvoltage", "zwischenkreisspannung"]
                .contains(&name.as_str())
        }
        Channel::Temperature => ["windingtemperature", "wicklungstemperatur"].contains(&name.as_str()),
        Channel::Run => false,
    }
}

/// Of a structure, the field; a point before a digit belongs to the name.
fn field(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, field)| if field.starts_with(|c: char| c.is_ascii_digit()) { name } else { field })
}

/// The words of a name without those beside it, as one; and those beside it. None if nothing but a unit is left of another channel than
/// time or speed.
fn named(channel: Channel, name: &str) -> Option<(String, Vec<String>)> {
    let dimension = channel.dimension();
    let (stem, unit) = split_header(field(name), dimension);
    // `i_a` is the current of a phase, not one in A.
    let (stem, unit) = if stem.len() == 1 && Channel::PHASES.contains(&channel) { (field(name), HeaderUnit::None) } else { (stem, unit) };
    let is_beside = |word: &String| {
        BESIDE.contains(&word.as_str()) || matches!(dimension, Dimension::Speed | Dimension::Angle) && ROTATION.contains(&word.as_str())
    };
    let plain = |word: &String| word.replace('ä', "ae").replace('à', "a").replace('é', "e").replace('ó', "o").replace('ö', "oe");
    let (mut beside, names): (Vec<String>, Vec<String>) = words(stem).into_iter().partition(is_beside);
    beside.sort();
    let may_be_unit = matches!(dimension, Dimension::Time | Dimension::Speed) && matches!(unit, HeaderUnit::Known(_)) && stem.is_empty();
    (!names.is_empty() || may_be_unit).then(|| (names.iter().map(plain).collect(), beside))
}

/// Whether a name is a quantity with the letter of its axis.
fn is_of_axis(name: &str, axis: &str, quantities: &[&str]) -> bool {
    quantities.iter().any(|quantity| {
        let orders = [format!("{quantity}{axis}"), format!("{quantity}{axis}axis"), format!("{quantity}{axis}achse")];
        let reversed = [
            format!("{axis}{quantity}"),
            format!("{axis}axis{quantity}"),
            format!("{axis}achse{quantity}"),
            format!("{axis}achsen{quantity}"),
        ];
        orders.iter().any(|order| order == name) || quantity.len() > 2 && reversed.iter().any(|order| order == name)
    })
}

/// Whether a name is that of a phase: by its letter, or of a current by u, v, w, where no line voltage can be meant.
fn is_of_phase(channel: Channel, name: &str, quantity: &str) -> bool {
    let (letter, other) = match channel {
        Channel::IA | Channel::UA => ("a", "u"),
        Channel::IB | Channel::UB => ("b", "v"),
        _ => ("c", "w"),
    };
    name == format!("{quantity}{letter}") || quantity == "i" && name == format!("i{other}")
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
            (Channel::T, &["Time [ms]", "Zeit", "timestamp", "Zeit (s)", "micros", "Time Stamp", "temps_s", "log.time"][..]),
            (Channel::Ud, &["u_d", "Vd", "vd_meas", "Spannung d [V]", "motor_vd", "d_axis_voltage", "usd", "drive.foc.Vd"]),
            (Channel::Iq, &["i_q", "iq_meas", "Iq_measured (A)", "Strom_q [A]", "q-Achsen-Strom", "MotorIq", "iq_mA", "Courant q"]),
            (Channel::OmegaE, &["erpm", "Drehzahl [1/min]", "speed_rpm", "omega_el", "Motor Speed (rpm)", "w_e", "n [U/min]", "rpm"]),
            (Channel::ThetaE, &["theta", "theta_el", "Rotorwinkel [°]", "electrical_angle_deg"]),
            (Channel::UDc, &["vbus", "V_dc", "dc_link_voltage [V]"]),
            (Channel::IA, &["i_a", "iu", "ia_meas [A]"]),
        ] {
            names.iter().for_each(|name| assert!(is(channel, name), "{name} is {}", channel.name()));
        }
    }

    #[test]
    fn references_other_units_and_other_words_are_not() {
        for (channel, names) in [
            (Channel::T, &["LEW_SO_T_P1 [°C]", "T [°C]", "timestep", "time_step", "t_motor", "Time [Nm]", "timestep (8Hz)"][..]),
            (Channel::Iq, &["iq_ref", "iq_setpoint", "iq_step", "iq_target", "Iq [V]", "iq_error", "absorber_iq", "q", "i_q_limit"]),
            (Channel::Id, &["vesc_id", "id_set", "run_id", "DC current", "direct current"]),
            (Channel::OmegaE, &["speed_step", "speed setpoint", "speed_meters_per_sec", "Velocity (m/s)", "wind speed", "SO_N_SOLL"]),
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
}

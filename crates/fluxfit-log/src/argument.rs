//! Arguments of the form `channel=value`: `omega=rpm-mech`, `ud=motor_vd`.

use crate::{channel::Channel, problem::Problem, quantity::TableColumn, reading::channel_called};
use fluxfit_files::FileError;
use fluxfit_units::{Unit, key_value};

/// `ud=motor_vd`: the canonical name of a channel, and the header of its column in the file. `omega` is `omega_e`. Of a table of a test
/// bench, `speed`, `voltage` (`voltage_ll` between two terminals, `voltage_phase` to the star point), `current` or `torque`.
///
/// # Errors
/// If there is no `=` with text on both sides, or the name on the left is neither.
pub fn parse_map(text: &str) -> Result<(String, String), FileError> {
    let (name, header) = key_value(text, "COLUMN=HEADER", "omega_e=motor_speed")?;
    let name = TableColumn::from_name(name).map_or_else(|| Channel::from_name(name).map(Channel::name), |column| Ok(column.name()))?;
    Ok((name.to_owned(), header.to_owned()))
}

/// Several of them, separated by commas; a comma in brackets or quotes belongs to a name, as in `t=data(:,1)`, and so does one behind
/// which no `=` stands before the next comma: `iq=P-0-0043, current,id=..`.
///
/// # Errors
/// As [`parse_map`].
pub fn parse_maps(text: &str) -> Result<Vec<(String, String)>, FileError> {
    let (mut depth, mut quoted) = (0_i32, false);
    let is_separator = |c: char| {
        match c {
            '"' => quoted = !quoted,
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            // A name that a message cut may lack its closing bracket.
            '…' => depth = 0,
            _ => {}
        }
        c == ',' && depth <= 0 && !quoted
    };
    let mut pairs: Vec<String> = Vec::new();
    for part in text.split(is_separator) {
        match pairs.last_mut() {
            Some(pair) if !part.trim().is_empty() && !part.contains('=') => *pair += &format!(",{part}"),
            _ => pairs.push(part.to_owned()),
        }
    }
    pairs.iter().map(|pair| parse_map(pair)).collect()
}

/// `omega=rpm-mech`: the canonical name of a channel, and its unit. A name that columns of one channel alone have, such as `speed`, is
/// that channel.
///
/// # Errors
/// As [`parse_map`], or if the unit is not one of that channel.
pub fn parse_unit(text: &str) -> Result<(String, Unit), FileError> {
    let (name, unit) = key_value(text, "COLUMN=UNIT", "omega=rpm-mech")?;
    let channel = Channel::from_name(name).or_else(|unknown| channel_called(name).ok_or(unknown))?;
    let found = Unit::from_name(unit, channel.dimension()).filter(|found| channel.units().any(|allowed| allowed == *found));
    let found = found.ok_or_else(|| wrong_unit(channel, unit))?;
    Ok((channel.name().to_owned(), found))
}

/// The error for a unit that does not fit its channel.
pub(crate) fn wrong_unit(channel: Channel, unit: &str) -> FileError {
    let allowed = channel.units().map(Unit::name).collect();
    Problem::Unit { channel: channel.name(), unit: unit.to_owned(), allowed }.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn channels_and_their_units() {
        assert_eq!(parse_map(" omega = Output Speed "), Ok(("omega_e".into(), "Output Speed".into())));
        assert_eq!(parse_map("ud=a=b"), Ok(("ud".into(), "a=b".into())));
        assert_eq!(parse_unit("omega=rpm-mech"), Ok(("omega_e".into(), Unit::RpmMechanical)));
        assert_eq!(parse_unit("theta=deg"), Ok(("theta_e".into(), Unit::Degree)));
        for (text, channel) in
            [("speed=rpm-mech", "omega_e"), ("n=rpm-mech", "omega_e"), ("Zeit=ms", "t"), ("i_d=mA", "id"), ("vdc=mV", "u_dc")]
        {
            assert_eq!(parse_unit(text).map(|(channel, _)| channel), Ok(channel.into()), "{text}");
        }
        let refusal = |text| parse_unit(text).unwrap_err().to_string();
        assert_eq!(
            refusal("omega=rpm"),
            "\"rpm\" is not a unit of omega_e; it can be rad/s, rpm-elec, rpm-mech, rad/s-mech, Hz-elec, Hz-mech, krpm-elec, krpm-mech, deg/s or deg/s-mech"
        );
        assert_eq!(refusal("ud=A"), "\"A\" is not a unit of ud; it can be V, mV, kV or Vrms");
        assert_eq!(parse_unit("id=arms"), Ok(("id".into(), Unit::AmpereRms)));
        // An instantaneous value is no root mean square.
        assert_eq!(refusal("ia=Arms"), "\"Arms\" is not a unit of ia; it can be A, mA or kA");
        assert!(refusal("torque=Nm").starts_with("\"torque\" is not a channel of a log"), "{}", refusal("torque=Nm"));
        assert_eq!(refusal("ud"), "\"ud\" is not understood; write COLUMN=UNIT, as in omega=rpm-mech");
        assert_eq!(parse_map("ud=").unwrap_err().to_string(), "\"ud=\" is not understood; write COLUMN=HEADER, as in omega_e=motor_speed");
    }

    #[test]
    fn commas_in_brackets_are_part_of_a_name() {
        let pairs = |text| parse_maps(text).unwrap().into_iter().map(|(_, header)| header).collect::<Vec<_>>();
        assert_eq!(pairs("t=data(:,1),ud=data(:,2)"), ["data(:,1)", "data(:,2)"]);
        assert_eq!(pairs("id=i [A, peak],iq=q)"), ["i [A, peak]", "q)"]);
        // As a message cuts it.
        assert_eq!(pairs("id=i of the stator [A…,iq=q"), ["i of the stator [A…", "q"]);
        assert_eq!(pairs("iq=P-0-0043, Strom, Ist,id=P-0-0044, Strom"), ["P-0-0043, Strom, Ist", "P-0-0044, Strom"]);
        assert!(parse_maps("t=a,x=2,ud=b").is_err());
        assert!(parse_maps("t=a,,ud=b").is_err() && parse_maps("").is_err());
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*|(rs|ld|omega|t)=[0-9e.+\\-/±%:muH ]{0,14}") {
            for sentence in [parse_map(&text).err(), parse_unit(&text).err()].into_iter().flatten() {
                prop_assert_eq!(sentence.to_string().lines().count(), 1);
            }
        }
    }
}

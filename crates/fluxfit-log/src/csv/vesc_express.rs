//! Headers of VESC Express, whose logger describes each field in six parts, `key:name:unit:precision:relative:timestamp`, as in
//! `vd:vd:V:2:0:0` (github.com/vedderb/vesc_express, main/log.c).

/// The name and the unit of each column, if all names of a header are such fields: a column is called by the key of its field, as the
/// firmware calls it.
pub(super) fn fields(names: &[String]) -> Option<Vec<(String, Option<String>)>> {
    names.iter().map(|name| field(name)).collect()
}

fn field(text: &str) -> Option<(String, Option<String>)> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [key, _, unit, precision, relative, timestamp] = parts[..] else { return None };
    let is_digit = |part: &str| part.len() == 1 && part.bytes().all(|byte| byte.is_ascii_digit());
    if key.is_empty() || ![precision, relative, timestamp].into_iter().all(is_digit) {
        return None;
    }
    // The firmware counts electrical turns, and states no unit for them.
    let unit = if unit.is_empty() && (key == "RPM" || key.ends_with(" RPM")) { "erpm" } else { unit };
    Some((key.to_owned(), Some(unit.to_owned()).filter(|unit| !unit.is_empty())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_units_are_read_from_every_field_or_from_none() {
        let of = |header: &str| fields(&header.split(';').map(str::to_owned).collect::<Vec<_>>());
        let found =
            of("vd:vd:V:2:0:0;RPM:RPM::2:0:0;kmh_vesc:Speed VESC:km/h:2:0:0;V12 RPM:V12 RPM::2:0:0;Fault:Fault::2:0:0;t_day:Time:s:3:0:1");
        let expected = [
            ("vd", Some("V")),
            ("RPM", Some("erpm")),
            ("kmh_vesc", Some("km/h")),
            ("V12 RPM", Some("erpm")),
            ("Fault", None),
            ("t_day", Some("s")),
        ];
        let expected = expected.map(|(key, unit)| (key.to_owned(), unit.map(str::to_owned)));
        assert_eq!(found.as_deref(), Some(&expected[..]));
        for other in ["vd:vd:V:2:0:0;t", "Vdq:1;Vdq:2", "a:b:c:d:e:f", "12:30:00:1:2:3;x"] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}

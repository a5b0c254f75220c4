//! How this program states what resolves an error or a note of a reader: the options behind each [`Advice`].

use super::given;
use crate::shell;
use fluxfit_files::Advice;
use fluxfit_units::wording::one_line;

/// A sentence with the options that do what it advises: `.. (--map uq=COLUMN)`.
pub(crate) fn with_options(sentence: &str, advice: &[Advice]) -> String {
    let options: Vec<String> = match units(advice) {
        Some(units) => vec![units],
        None => advice.iter().filter_map(option).collect(),
    };
    let options: Vec<String> = options.iter().map(|option| given::in_place(option)).collect();
    if options.is_empty() { sentence.to_owned() } else { format!("{sentence} ({})", options.join(", or ")) }
}

/// One option for the units of several channels.
fn units(advice: &[Advice]) -> Option<String> {
    let unit = |advice: &Advice| match advice {
        Advice::StateUnit { channel, unit: Some(unit) } => Some(format!("{channel}={unit}")),
        _ => None,
    };
    let pairs: Option<Vec<String>> = advice.iter().map(unit).collect();
    pairs.filter(|pairs| pairs.len() > 1).map(|pairs| format!("--unit {}", pairs.join(",")))
}

pub(super) fn option(advice: &Advice) -> Option<String> {
    match advice {
        Advice::MapInUnits { columns, units } => {
            let units: Vec<String> = units.iter().map(|(channel, unit)| format!("{channel}={unit}")).collect();
            let map = option(&Advice::MapColumns(columns.clone()))?;
            Some(if units.is_empty() { map } else { format!("{map} --unit {}", units.join(",")) })
        }
        Advice::MapColumns(pairs) => {
            let pair = |(channel, header): &(&str, Option<String>)| format!("{channel}={}", header.as_deref().unwrap_or("COLUMN"));
            let argument = pairs.iter().map(pair).collect::<Vec<_>>().join(",");
            // Names come from files: what a shell would split or interpret is quoted, and what would not print as it is is left out.
            match one_line(&argument) == argument {
                true => Some(format!("--map {}", shell::word(argument.as_ref()))),
                false => Some(format!("--map {}=COLUMN", pairs.first()?.0)),
            }
        }
        Advice::StateUnit { channel, unit } => Some(format!("--unit {channel}={}", unit.unwrap_or("UNIT"))),
        Advice::StateRotation { channel, electrical, mechanical, has_pole_pairs } => {
            let pole_pairs = if *has_pole_pairs { "" } else { " --pole-pairs N" };
            Some(format!("--unit {channel}={electrical}, or --unit {channel}={mechanical}{pole_pairs}"))
        }
        // It writes the line with those of the other columns.
        Advice::ScaleInMapping { .. } => Some("fluxfit inspect LOG -o MAPPING.toml, then --mapping MAPPING.toml".to_owned()),
        Advice::Together(all) => Some(all.iter().filter_map(option).collect::<Vec<_>>().join(" ")),
        Advice::StateDbc => Some("--dbc FILE.dbc".to_owned()),
        Advice::StatePolePairs => Some("--pole-pairs N".to_owned()),
        Advice::FixParameters(keys) => {
            Some(format!("--fix {}", keys.iter().map(|key| format!("{key}=VALUE")).collect::<Vec<_>>().join(",")))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_becomes_options_that_can_be_pasted() {
        let map = |pairs: &[(&'static str, Option<&str>)]| {
            vec![Advice::MapColumns(pairs.iter().map(|(channel, header)| (*channel, header.map(str::to_owned))).collect())]
        };
        assert_eq!(with_options("a", &[]), "a");
        assert_eq!(with_options("a", &map(&[("id", None), ("iq", None)])), "a (--map id=COLUMN,iq=COLUMN)");
        assert_eq!(with_options("a", &map(&[("ud", Some("u_d")), ("uq", Some("u_q"))])), "a (--map ud=u_d,uq=u_q)");
        assert_eq!(with_options("a", &map(&[("uq", Some("q-axis voltage"))])), "a (--map 'uq=q-axis voltage')");
        assert_eq!(with_options("a", &map(&[("uq", Some("a\n$(b)"))])), "a (--map uq=COLUMN)");
        for (name, quoted) in
            [("$(b)", "'uq=$(b)'"), ("`b`", "'uq=`b`'"), ("b\\", "'uq=b\\'"), ("it's", r"'uq=it'\''s'"), ("!!", "'uq=!!'")]
        {
            assert_eq!(with_options("a", &map(&[("uq", Some(name))])), format!("a (--map {quoted})"));
        }
        assert_eq!(with_options("a", &map(&[("uq", Some("a\u{202e}b"))])), "a (--map uq=COLUMN)");
        let pole_pairs = [Advice::StatePolePairs, Advice::StateUnit { channel: "omega_e", unit: Some("rpm-elec") }];
        assert_eq!(with_options("a", &pole_pairs), "a (--pole-pairs N, or --unit omega_e=rpm-elec)");
        let columns = vec![("id", Some("Id rms".to_owned())), ("iq", Some("Iq rms".to_owned()))];
        let units = vec![("id", "Arms"), ("iq", "Arms")];
        assert_eq!(with_options("a", &[Advice::MapInUnits { columns, units }]), "a (--map 'id=Id rms,iq=Iq rms' --unit id=Arms,iq=Arms)");
        let rotation = Advice::StateRotation { channel: "omega_e", electrical: "Hz-elec", mechanical: "Hz-mech", has_pole_pairs: false };
        assert_eq!(with_options("a", &[rotation]), "a (--unit omega_e=Hz-elec, or --unit omega_e=Hz-mech --pole-pairs N)");
        let currents = ["id", "iq"].map(|channel| Advice::StateUnit { channel, unit: Some("mA") });
        assert_eq!(with_options("a", &currents), "a (--unit id=mA,iq=mA)");
        assert_eq!(with_options("a", &[Advice::FixParameters(vec!["ld", "rs"])]), "a (--fix ld=VALUE,rs=VALUE)");
    }
}

//! The mapping file that an inspection proposes.

use super::{
    inspect::{InspectedColumn, Inspection, is_electrical},
    mapping::Park,
    options::LogOptions,
};
use crate::{
    channel::Channel,
    header_unit::{HeaderUnit, share, split_header},
};
use fluxfit_files::{Advice, FileError};
use std::fmt::Write;

impl Inspection {
    /// A mapping file with the channels that were recognized, and entries to complete for the others.
    pub fn mapping(&self, options: &LogOptions) -> String {
        let mut text = "# A mapping file: which columns of these logs are which channels.\n".to_owned();
        let pole_pairs = options.pole_pairs.or(options.mapping.pole_pairs);
        text += &pole_pairs
            .map_or("# pole_pairs = 4            # needed for a mechanical speed or angle\n".to_owned(), |n| format!("pole_pairs = {n}\n"));
        let period = options.mapping.sample_period.or(self.layout.and_then(|layout| layout.sample_period));
        match period {
            Some(period) => _ = writeln!(text, "sample_period = {period:?}       # s"),
            None => text += "# sample_period = \"0.1 ms\"  # in place of a time column\n",
        }
        let park = options.mapping.park;
        if park != Park::default() {
            let _ = writeln!(text, "park = \"{}\"", park.name());
        }
        text +=
            "# park = \"amplitude-invariant\"  # dq values are peak values of the phases; or \"power-invariant\", \"rms\"\n\n[columns]\n";
        text += "# also possible: scale = 0.01, sign = -1, and of voltages times = \"u_dc\"\n";
        for channel in Channel::NEEDED {
            let found =
                |of: fn(&InspectedColumn) -> Option<&'static str>| self.columns.iter().find(|column| of(column) == Some(channel.name()));
            let (taken, resembling) = (found(|column| column.channel), found(|column| column.resembles));
            if taken.is_some_and(|column| column.is_time) {
                text += "# t: each group of channels has its own time\n";
                continue;
            }
            if taken.is_none() && (channel == Channel::T && period.is_some() || self.is_computed(channel, resembling.is_none())) {
                continue;
            }
            match taken.or(resembling) {
                Some(column) => text += &self.entry(channel, column, options),
                None => _ = writeln!(text, "{} = {{ column = \"\" }}  # no column resembles it", channel.name()),
            }
        }
        for channel in Channel::all().filter(|channel| !Channel::NEEDED.contains(channel)) {
            let is_of = |column: &&InspectedColumn| column.channel.or(column.resembles) == Some(channel.name());
            if let Some(column) = self.columns.iter().find(is_of) {
                text += &self.entry(channel, column, options);
            }
        }
        if self.lacks_angle() {
            let _ = writeln!(text, "{} = {{ column = \"\" }}  # no column resembles it", Channel::ThetaE.name());
        }
        text
    }

    /// Whether there are quantities of the stator without the angle that makes those of the axes of them.
    fn lacks_angle(&self) -> bool {
        !self.has(Channel::ThetaE.name(), true) && ["ua", "ualpha", "ia", "ialpha"].iter().any(|name| self.has(name, true))
    }

    /// The entry of a channel: with the scale that the refusal of the log asks for, if it does.
    fn entry(&self, channel: Channel, column: &InspectedColumn, options: &LogOptions) -> String {
        let advice = self.log.as_ref().err().map(FileError::advice).unwrap_or_default();
        let scale = advice.iter().find_map(|advice| match advice {
            Advice::ScaleInMapping { channel: of, scale } if *of == channel.name() => Some(scale),
            _ => None,
        });
        let scale = scale.filter(|_| column.share.is_none());
        scale.map_or_else(|| entry(channel, column, options), |scale| scaled_entry(channel, column, scale))
    }

    /// Whether a dq quantity or the speed is computed from phase quantities and an angle; `by_names` counts those that
    /// are known by their names alone, as all are where there is no log yet.
    fn is_computed(&self, channel: Channel, by_names: bool) -> bool {
        let has = |name: &str| self.has(name, by_names);
        match channel {
            Channel::Ud | Channel::Uq => has("ua") || has("ualpha"),
            Channel::Id | Channel::Iq => has("ia") || has("ialpha"),
            Channel::OmegaE => has("theta_e"),
            _ => false,
        }
    }

    /// Whether the file has a column of this channel; `by_names` counts those that only resemble it.
    fn has(&self, name: &str, by_names: bool) -> bool {
        self.columns.iter().any(|column| column.channel == Some(name) || by_names && column.resembles == Some(name))
    }
}

/// The entry of a channel whose scale to SI its values show.
fn scaled_entry(channel: Channel, column: &InspectedColumn, scale: &str) -> String {
    let of_shaft = if channel == Channel::ThetaE { "; if it turns with the shaft, add unit = \"rad-mech\"" } else { "" };
    format!("{} = {{ column = {}, scale = {scale} }}  # by its values{of_shaft}\n", channel.name(), quoted(&column.header))
}

/// The entry of a channel, with a remark if there is something to check.
fn entry(channel: Channel, column: &InspectedColumn, options: &LogOptions) -> String {
    let is_taken = column.channel.is_some();
    let is_instant = channel == Channel::T && column.is_instant;
    let is_speed = channel == Channel::OmegaE;
    // What only the channel's name means would count as stated here, digits or mV pass for V, and counts of an encoder for rad.
    let may_be_other = is_electrical(channel) || channel == Channel::ThetaE;
    let read_as = column.read_as.filter(|_| column.is_unit_written || !may_be_other);
    let unit = match read_as {
        _ if is_instant || column.share.is_some() => None,
        Some((unit, _)) => Some(unit).filter(|unit| *unit != "1"),
        // To be filled in: a speed is not read without.
        None => is_speed.then_some("?"),
    };
    let by_name = if is_taken { "" } else { "by its name; check it" };
    let of_unit = match (read_as, channel) {
        _ if column.share.is_some() && !is_taken => ": 2/3 is the scale of ODrive",
        _ if is_instant || column.share.is_some() => "",
        (None, Channel::OmegaE) if is_taken => "nothing states its unit: rad/s, rpm-elec, rpm-mech, ..",
        (None, _) if is_taken => "nothing states its unit; check it, and add unit = .. unless it is SI",
        (None, Channel::OmegaE) => ", and state its unit: rad/s, rpm-elec, rpm-mech, ..",
        (None, _) => ", and add unit = .. unless it is SI",
        (Some(_), _) if !column.is_unit_stated => "nothing states its unit; check it",
        (Some(_), Channel::OmegaE | Channel::ThetaE) if !column.is_rotation_stated => {
            if is_taken {
                "electrical or mechanical is not stated; check it"
            } else {
                ", and whether it is electrical"
            }
        }
        _ => "",
    };
    let of_share = share_of(channel, &column.header);
    let of_unit = of_share.as_deref().filter(|_| column.read_as.is_none() && column.share.is_none()).unwrap_or(of_unit);
    let remark = if by_name.is_empty() && of_unit.is_empty() { String::new() } else { format!("  # {by_name}{of_unit}") };
    let unit = unit.map(|unit| format!(", unit = \"{unit}\"")).unwrap_or_default();
    let factor = factor(Some(column).filter(|column| is_taken || column.share.is_some()), channel, options);
    format!("{} = {{ column = {}{unit}{factor} }}{remark}\n", channel.name(), quoted(&column.header))
}

/// Scale and sign, from the mapping file that was given or of a share of the DC voltage.
fn factor(column: Option<&InspectedColumn>, channel: Channel, options: &LogOptions) -> String {
    let share = column.and_then(|column| column.share);
    let given = options.mapping.columns.iter().find(|column| column.channel == channel).map_or(1.0, |column| column.factor);
    let factor = share.unwrap_or(given);
    let scale = if factor.abs() == 1.0 { String::new() } else { format!(", scale = {:?}", factor.abs()) };
    let times = if share.is_some() { ", times = \"u_dc\"" } else { "" };
    scale + if factor < 0.0 { ", sign = -1" } else { "" } + times
}

/// What to add for a column of shares of a base value.
fn share_of(channel: Channel, header: &str) -> Option<String> {
    let HeaderUnit::Unknown(text) = split_header(header, channel.dimension()).1 else { return None };
    let divided = if share(text)? == 1.0 { "" } else { " divided by 100" };
    Some(format!(", and add scale = .., the base value in {}{divided}", channel.unit().prose()))
}

/// A text in TOML's quotes.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reading::{inspect::inspect, mapping::Mapping};

    fn inspected(text: &str, options: &LogOptions) -> Inspection {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        inspect(file.path(), options).unwrap()
    }

    #[test]
    fn a_mapping_that_was_written_reads_the_same_log() {
        let rows: String = (0..30).map(|row| format!("{};3;4;1;2;{}\n", 100 * row, 500 + row)).collect();
        let text = format!("zeit [ms];V d;V q;motor_id;i \"q\";speed_rpm\n{rows}");
        let map = [("t", "zeit [ms]"), ("ud", "V d"), ("uq", "V q"), ("id", "motor_id"), ("iq", "i \"q\""), ("omega_e", "speed_rpm")];
        let options =
            LogOptions { map: map.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(), pole_pairs: Some(4), ..LogOptions::default() };
        let first = inspected(&text, &options);
        let mapping = first.mapping(&options);
        let again = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).expect(&mapping), ..LogOptions::default() };
        let second = inspected(&text, &again);
        assert_eq!(second.log.unwrap().log, first.log.unwrap().log, "{mapping}");
    }

    #[test]
    fn a_share_of_a_base_value_is_asked_for_its_scale() {
        let rows: String = (0..30).map(|row| format!("{row},3,4,1.{row},2.{row},{}\n", 500 + row)).collect();
        let options = LogOptions::default();
        let mapping = inspected(&format!("t,ud [%],uq [%],id_pu,iq_pu,omega_e\n{rows}"), &options).mapping(&options);
        for line in [
            "ud = { column = \"ud [%]\" }  # by its name; check it, and add scale = .., the base value in V divided by 100\n",
            "iq = { column = \"iq_pu\" }  # by its name; check it, and add scale = .., the base value in A\n",
        ] {
            assert!(mapping.contains(line), "{mapping}");
        }
    }

    #[test]
    fn a_written_mapping_keeps_what_was_given() {
        let rows: String = (0..30).map(|row| format!("0.{row:02},3,4,1,2,{}\n", 500 + row)).collect();
        let given = "park = \"power-invariant\"\n[columns]\nud = { column = \"a\", scale = 0.01, sign = -1 }\nuq = \"b\"\n";
        let options = LogOptions { mapping: Mapping::parse("m.toml", given.as_bytes()).unwrap(), ..LogOptions::default() };
        let first = inspected(&format!("t,a,b,id,iq,omega_e\n{rows}"), &options);
        let mapping = first.mapping(&options);
        let again = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).expect(&mapping), ..LogOptions::default() };
        assert_eq!(inspected(&format!("t,a,b,id,iq,omega_e\n{rows}"), &again).log.unwrap().log, first.log.unwrap().log, "{mapping}");
    }

    #[test]
    fn a_written_mapping_keeps_shares_of_the_dc_voltage() {
        let rows: String = (0..30).map(|row| format!("0.{row:02},{},52,48,40,1,2,{},0.{}\n", 50 + row % 3, 500 + row, 100 + row)).collect();
        let text = format!("t,duty_a [%],duty_b [%],duty_c [%],u_dc,id,iq,omega_e,theta_e\n{rows}");
        let first = inspected(&text, &LogOptions::default());
        let mapping = first.mapping(&LogOptions::default());
        assert!(mapping.contains("\nua = { column = \"duty_a [%]\", scale = 0.01, times = \"u_dc\" }\n"), "{mapping}");
        let again = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).expect(&mapping), ..LogOptions::default() };
        assert_eq!(inspected(&text, &again).log.unwrap().log.columns(), first.log.unwrap().log.columns(), "{mapping}");
    }

    /// A column that only resembles a channel keeps the unit of its header.
    #[test]
    fn a_proposed_column_keeps_the_unit_of_its_header() {
        let found = inspected("Zeit [ms],Motor.Ud,Motor.Load speed_rpm\n1,2,3\n2,2,3\n", &LogOptions::default());
        let mapping = found.mapping(&LogOptions::default());
        assert!(
            mapping.contains("\nomega_e = { column = \"Motor.Load speed_rpm\", unit = \"rpm-mech\" }  # by its name; check it\n"),
            "{mapping}"
        );
    }

    /// Columns in mA and mV under the channels' own names: refused, also with the mapping that was written, until the units are filled in.
    #[test]
    fn a_written_mapping_does_not_state_the_units_of_names() {
        let rows: String =
            (0..300).map(|row| format!("{row},{},{},-130,{},900\n", -4600 + row, 21_000 + 7 * row, 4065 + row % 9)).collect();
        let text = format!("t,ud,uq,id,iq,omega_e\n{rows}");
        let first = inspected(&text, &LogOptions::default());
        assert_eq!(first.columns.iter().filter(|column| column.read_as.is_none()).count(), 4);
        let mapping = first.mapping(&LogOptions::default());
        let read = |mapping: &str| {
            let options = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).unwrap(), ..LogOptions::default() };
            inspected(&text, &options).log
        };
        let again = read(&mapping).unwrap_err().to_string();
        assert!(again.contains("are whole numbers up to 23093"), "{again}");
        let of = |channel: &str| format!("\n{channel} = {{ column = \"{channel}\" }}");
        let filled_in = ["ud", "uq", "id", "iq"].iter().fold(mapping, |mapping, channel| {
            let unit = if channel.starts_with('u') { "mV" } else { "mA" };
            assert!(mapping.contains(&of(channel)), "{mapping}");
            mapping.replace(&of(channel), &format!("\n{channel} = {{ column = \"{channel}\", unit = \"{unit}\" }}"))
        });
        assert!((read(&filled_in).unwrap().log.columns().iq[0] - 4.065).abs() < 1e-12);
    }

    /// Whole numbers of ns are those of the file, unless they count from 1970: then they are seconds from the first row.
    #[test]
    fn the_range_of_a_time_in_ns_is_its_own() {
        for (start, expected, unit) in [
            (0_u64, [0.0, 900e6], "ns"),
            (951_412_772_644_479, [951_412_772_644_479.0, 951_413_672_644_479.0], "ns"),
            (1_700_000_000_123_456_789, [0.0, 0.9], "s"),
        ] {
            let rows: String = (0..10_u64).map(|row| format!("{},3,4,1,2,{}\n", start + row * 100_000_000, 500 + row)).collect();
            let found = inspected(&format!("timestamp [ns],ud,uq,id,iq,omega_e\n{rows}"), &LogOptions::default());
            let (column, range) = (&found.columns[0], found.columns[0].range.unwrap());
            assert!((range[0] - expected[0]).abs() < 1e-6 && (range[1] - expected[1]).abs() < 1e-6, "{start}: {range:?}");
            assert_eq!(column.read_as.map(|(name, _)| name), Some(unit), "{start}");
            let t = &found.log.as_ref().unwrap().log.columns().t;
            assert!((t[9] - t[0] - 0.9).abs() < 1e-6, "{start}: {t:?}");
        }
    }

    /// Nothing of these columns was read, so nothing says that they are what their names say, or in SI.
    #[test]
    fn guesses_are_marked_and_have_no_unit_that_nothing_states() {
        let text = "Time,Position,Output Speed [rad.s],Ia,VDC,iq [A]\n1,2,3,512,500,6\n2,2,3,388,500,6\n";
        let found = inspected(text, &LogOptions::default());
        let of = |index: usize| {
            let column = &found.columns[index];
            (column.channel, column.resembles, column.read_as.map(|(unit, _)| unit))
        };
        let all: Vec<_> = (0..6).map(of).collect();
        let expected = [
            (Some("t"), None, None),
            (None, Some("theta_e"), None),
            (None, Some("omega_e"), Some("rad/s")),
            (Some("ia"), None, None),
            (None, Some("u_dc"), None),
            (Some("iq"), None, Some("A")),
        ];
        assert_eq!(all, expected);
        let mapping = found.mapping(&LogOptions::default());
        for line in [
            "t = { column = \"Time\" }  # nothing states its unit; check it, and add unit = .. unless it is SI",
            "omega_e = { column = \"Output Speed [rad.s]\", unit = \"rad/s\" }  # by its name; check it, and whether it is electrical",
            "theta_e = { column = \"Position\" }  # by its name; check it, and add unit = .. unless it is SI",
            "ia = { column = \"Ia\" }  # nothing states its unit; check it, and add unit = .. unless it is SI",
            "iq = { column = \"iq [A]\", unit = \"A\" }",
        ] {
            assert!(mapping.contains(&format!("\n{line}\n")), "{line}\n{mapping}");
        }
    }

    /// Voltages in alpha and beta, with an angle in turns that no currents of the stator confirm: refused, until the file that was
    /// written is given. The dq quantities are those that the rows were made of.
    #[test]
    fn a_log_of_the_stator_frame_with_an_angle_in_turns_is_read_with_the_mapping_that_was_written() {
        let vectors = [["u_alpha", "u_beta", "i_d", "i_q"], ["V_alpha [V]", "V_beta [V]", "I_d [mA]", "I_q [mA]"]];
        for (names, angle) in [(vectors[0], "theta"), (vectors[0], "theta_e"), (vectors[1], "theta_e")] {
            let ampere = if names[2].ends_with("[mA]") { 1e3 } else { 1.0 };
            let row = |k: i32| {
                let turns = 0.3 + 0.0123 * f64::from(k);
                let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
                // u_d = -3 V, u_q = 20 V, i_d = -1 A, i_q = 4 A.
                let [u_alpha, u_beta] = [-3.0 * cos - 20.0 * sin, -3.0 * sin + 20.0 * cos];
                let [id, iq] = [-1.0, 4.0].map(|i| i * ampere);
                format!("{:.4},{u_alpha},{u_beta},{id},{iq},{:.9}\n", f64::from(k) * 1e-4, turns.rem_euclid(1.0))
            };
            let text = format!("t,{},{angle}\n{}", names.join(","), (0..600).map(row).collect::<String>());
            let first = inspected(&text, &LogOptions::default());
            let sentence = first.log.as_ref().unwrap_err().to_string();
            assert!(sentence.contains("winds around at 1,") && sentence.contains("scale = 6.28319"), "{sentence}");
            let mapping = first.mapping(&LogOptions::default());
            let again = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).expect(&mapping), ..LogOptions::default() };
            let read = inspected(&text, &again).log.expect(&mapping);
            let columns = read.log.columns();
            for (values, expected) in [(&columns.ud, -3.0), (&columns.uq, 20.0), (&columns.id, -1.0), (&columns.iq, 4.0)] {
                assert!(values.iter().all(|value| (value - expected).abs() < 1e-3), "{names:?}: {} for {expected}", values[9]);
            }
        }
    }

    /// A power-invariant vector is sqrt(3/2) times as long, in the stator's frame as in dq.
    #[test]
    fn the_scaling_of_the_clarke_transform_is_that_of_alpha_and_beta() {
        let rows: String = (0..30).map(|k| format!("0.{k:02},3,4,1,2,{},{}\n", 0.1 * f64::from(k), 100 + k)).collect();
        let text = format!("t,u_alpha,u_beta,i_alpha,i_beta,theta_e,omega_e\n{rows}");
        let lengths = ["", "park = \"power-invariant\"\n"].map(|park| {
            let options = LogOptions { mapping: Mapping::parse("m.toml", park.as_bytes()).unwrap(), ..LogOptions::default() };
            let columns = inspected(&text, &options).log.unwrap();
            let columns = columns.log.columns();
            columns.ud[0].hypot(columns.uq[0])
        });
        assert!((lengths[0] - 5.0).abs() < 1e-9 && (lengths[0] / lengths[1] - 1.5_f64.sqrt()).abs() < 1e-9, "{lengths:?}");
    }

    #[test]
    fn a_table_that_is_not_a_log_can_be_inspected() {
        let found = inspected("load u_d,load speed,load i_d\n1,2,3\n", &LogOptions::default());
        assert!(found.log.is_err());
        assert_eq!(found.columns.iter().map(|column| column.resembles).collect::<Vec<_>>(), [Some("ud"), Some("omega_e"), Some("id")]);
        assert_eq!(found.columns[1].range, Some([2.0, 2.0]));
        let mapping = found.mapping(&LogOptions::default());
        assert!(mapping.contains("\nuq = { column = \"\" }  # no column resembles it\n"), "{mapping}");
        assert!(
            mapping.contains("\nud = { column = \"load u_d\" }  # by its name; check it, and add unit = .. unless it is SI\n"),
            "{mapping}"
        );
    }
}

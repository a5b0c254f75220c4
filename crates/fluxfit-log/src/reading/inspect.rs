//! What was understood of a file: for who wants to know before an answer hangs on it, and a mapping file to start from.

use super::{LogOptions, ReadLog, Told, columns, layout::Layout, mapping::Park, read, table::Table};
use crate::block::Wanted;
use crate::{channel::Channel, problem::Problem};
use fluxfit_files::{
    FileError,
    input::{self, Raw},
};
use std::{fmt::Write, path::Path};

/// What was understood of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspection {
    /// What it is: text or a container.
    pub kind: String,
    /// The layout that was recognized.
    pub layout: Option<&'static Layout>,
    /// Its columns, in order.
    pub columns: Vec<InspectedColumn>,
    /// The log, or why there is none.
    pub log: Result<ReadLog, FileError>,
}

/// A column of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedColumn {
    /// As the file names it.
    pub header: String,
    /// The unit that stands beside the name, as the file spells it.
    pub unit: Option<String>,
    /// What it is taken for.
    pub channel: Option<&'static str>,
    /// What it resembles, where it is taken for nothing and that is missing.
    pub resembles: Option<&'static str>,
    /// The unit in which it is read, or would be, as `--unit` names it, and how it is called.
    pub read_as: Option<(&'static str, &'static str)>,
    /// Least and largest number in it, as the file has them; none where it is no file, or holds no numbers.
    pub range: Option<[f64; 2]>,
    /// The file says that it is the time of the channels beside it.
    pub is_time: bool,
}

/// Reads a log and what there is to say of it; the path `-` is standard input.
///
/// # Errors
/// If it is no table at all. A table that is no log is an inspection without a log.
pub fn inspect(path: &Path, options: &LogOptions) -> Result<Inspection, FileError> {
    let name = input::name(path);
    let told = Told::from(options)?;
    let table = input::open(path).and_then(Table::open).map_err(|error| error.in_file(&name))?;
    let names: Vec<String> = table.heads().iter().map(|head| head.name.clone()).collect();
    let layout = Layout::recognize(&names);
    let survey = columns::survey(table.heads(), layout, &told);
    let read_as = |index: usize| {
        let taken = survey.taken.iter().find(|(_, place, _)| *place == index).map(|(_, _, unit)| *unit);
        let unit = taken.or_else(|| survey.resembling.iter().find(|(_, place, _)| *place == index).and_then(|(_, _, unit)| *unit))?;
        Some((unit.name(), unit.prose()))
    };
    let ranges = ranges(path);
    let inspected = table.heads().iter().enumerate().map(|(index, head)| InspectedColumn {
        header: head.name.clone(),
        unit: head.unit.clone(),
        channel: survey.taken.iter().find(|(_, place, _)| *place == index).map(|(channel, ..)| channel.name()),
        read_as: read_as(index),
        resembles: survey.resembling.iter().find(|(_, place, _)| *place == index).map(|(channel, ..)| channel.name()),
        range: ranges.get(index).copied().flatten(),
        is_time: head.is_time,
    });
    Ok(Inspection {
        kind: table.kind(),
        layout,
        columns: inspected.collect(),
        log: read(table, &told).map_err(|error| error.in_file(&name)),
    })
}

/// Least and largest number of every column, by a reading of its own.
fn ranges(path: &Path) -> Vec<Option<[f64; 2]>> {
    let Ok(mut table) = input::open(path).and_then(|raw| match raw {
        Raw::File(..) => Table::open(raw),
        // What comes through a pipe comes once.
        Raw::Stream(_) => Err(Problem::NoRows.into()),
    }) else {
        return Vec::new();
    };
    let heads = table.heads().to_vec();
    let mut ranges = vec![None; heads.len()];
    let mut groups: Vec<usize> = heads.iter().map(|head| head.group).collect();
    groups.sort_unstable();
    groups.dedup();
    for group in groups {
        let of_group: Vec<usize> = (0..heads.len()).filter(|index| heads[*index].group == group).collect();
        let wanted: Vec<Wanted> = of_group
            .iter()
            .map(|index| Wanted { index: *index, header: heads[*index].name.clone(), is_time: false, dispensable: true })
            .collect();
        // As far as it can be read.
        let _ = table.read(&wanted, &mut |block| {
            for (index, values) in of_group.iter().zip(&block.values) {
                for value in values.iter().filter(|value| value.is_finite()) {
                    let [low, high] = ranges[*index].get_or_insert([*value; 2]);
                    (*low, *high) = (low.min(*value), high.max(*value));
                }
            }
            Ok(())
        });
    }
    ranges
}

impl Inspection {
    /// A mapping file that says what was understood, and has a place for what was not.
    pub fn mapping(&self, options: &LogOptions) -> String {
        let mut text = "# What the columns of these logs mean: fluxfit identify LOG --mapping THIS_FILE\n".to_owned();
        let pole_pairs = options.pole_pairs.or(options.mapping.pole_pairs);
        text += &pole_pairs
            .map_or("# pole_pairs = 4            # for a mechanical speed or angle\n".to_owned(), |n| format!("pole_pairs = {n}\n"));
        let period = options.mapping.sample_period.or(self.layout.and_then(|layout| layout.sample_period));
        match period {
            Some(period) => _ = writeln!(text, "sample_period = {period:?}       # s"),
            None => text += "# sample_period = \"0.1 ms\"  # where no column tells the time\n",
        }
        let told = options.mapping.park;
        if told != Park::default() {
            let _ = writeln!(text, "park = \"{}\"", told.name());
        }
        text += "# park = \"amplitude-invariant\"  # dq values are phase peaks; or \"power-invariant\", \"rms\"\n\n[columns]\n";
        text += "# besides column and unit: scale = 0.01, and sign = -1 for the other way around\n";
        for channel in Channel::NEEDED {
            let found =
                |of: fn(&InspectedColumn) -> Option<&'static str>| self.columns.iter().find(|column| of(column) == Some(channel.name()));
            let (taken, resembling) = (found(|column| column.channel), found(|column| column.resembles));
            if taken.is_some_and(|column| column.is_time) {
                text += "# t: the time that each group of channels has\n";
                continue;
            }
            if taken.is_none() && (channel == Channel::T && period.is_some() || self.is_made_of_phases(channel)) {
                continue;
            }
            let (column, remark) = match (taken, resembling) {
                (Some(column), _) => (column.header.as_str(), ""),
                (None, Some(column)) if column.read_as.is_none() => {
                    (column.header.as_str(), "  # by its name: is it, and in SI? else unit = ..")
                }
                (None, Some(column)) => (column.header.as_str(), "  # by its name: is it?"),
                (None, None) => ("", "  # nothing resembles it"),
            };
            // Of a guess, only what its header says.
            let said = taken.or(resembling).and_then(|column| column.read_as);
            let unit =
                if taken.is_some() { Some(said.map_or(channel.unit().name(), |(unit, _)| unit)) } else { said.map(|(unit, _)| unit) };
            let unit = unit.map(|unit| format!(", unit = \"{unit}\"")).unwrap_or_default() + &factor(channel, options);
            let _ = writeln!(text, "{} = {{ column = {}{unit} }}{remark}", channel.name(), quoted(column));
        }
        for channel in Channel::all().filter(|channel| !Channel::NEEDED.contains(channel)) {
            if let Some(column) = self.columns.iter().find(|column| column.channel == Some(channel.name())) {
                let unit = column.read_as.filter(|(unit, _)| *unit != "1").map(|(unit, _)| format!(", unit = \"{unit}\""));
                let said = unit.unwrap_or_default() + &factor(channel, options);
                let _ = writeln!(text, "{} = {{ column = {}{said} }}", channel.name(), quoted(&column.header));
            }
        }
        text
    }

    /// Whether a dq quantity, or the speed, comes from phases and an angle that are there.
    fn is_made_of_phases(&self, channel: Channel) -> bool {
        let has = |name: &str| self.columns.iter().any(|column| column.channel == Some(name));
        match channel {
            Channel::Ud | Channel::Uq => has("ua") && has("theta_e"),
            Channel::Id | Channel::Iq => has("ia") && has("theta_e"),
            Channel::OmegaE => has("theta_e"),
            _ => false,
        }
    }
}

/// Scale and sign that a mapping file told.
fn factor(channel: Channel, options: &LogOptions) -> String {
    let told = options.mapping.columns.iter().find(|column| column.channel == channel).map_or(1.0, |column| column.factor);
    let scale = if told.abs() == 1.0 { String::new() } else { format!(", scale = {:?}", told.abs()) };
    scale + if told < 0.0 { ", sign = -1" } else { "" }
}

/// As TOML quotes a text.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mapping;

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
    fn a_mapping_keeps_what_another_one_told() {
        let rows: String = (0..30).map(|row| format!("{row},3,4,1,2,{}\n", 500 + row)).collect();
        let told = "park = \"power-invariant\"\n[columns]\nud = { column = \"a\", scale = 0.01, sign = -1 }\nuq = \"b\"\n";
        let options = LogOptions { mapping: Mapping::parse("m.toml", told.as_bytes()).unwrap(), ..LogOptions::default() };
        let first = inspected(&format!("t,a,b,id,iq,omega_e\n{rows}"), &options);
        let mapping = first.mapping(&options);
        let again = LogOptions { mapping: Mapping::parse("m.toml", mapping.as_bytes()).expect(&mapping), ..LogOptions::default() };
        assert_eq!(inspected(&format!("t,a,b,id,iq,omega_e\n{rows}"), &again).log.unwrap().log, first.log.unwrap().log, "{mapping}");
    }

    /// Of a guess the header's unit counts, as it does for a column that the user names.
    #[test]
    fn a_guess_keeps_the_unit_of_its_header() {
        let found = inspected("Zeit [ms],Motor.Ud,Motor.Speed_rpm\n1,2,3\n2,2,3\n", &LogOptions::default());
        let mapping = found.mapping(&LogOptions::default());
        assert!(
            mapping.contains("\nomega_e = { column = \"Motor.Speed_rpm\", unit = \"rpm-mech\" }  # by its name: is it?\n"),
            "{mapping}"
        );
    }

    #[test]
    fn a_table_that_is_no_log_is_inspected_all_the_same() {
        let found = inspected("u_d,motor_speed,i_d\n1,2,3\n", &LogOptions::default());
        assert!(found.log.is_err());
        assert_eq!(found.columns.iter().map(|column| column.resembles).collect::<Vec<_>>(), [Some("ud"), Some("omega_e"), Some("id")]);
        assert_eq!(found.columns[1].range, Some([2.0, 2.0]));
        let mapping = found.mapping(&LogOptions::default());
        assert!(mapping.contains("\nuq = { column = \"\" }  # nothing resembles it\n"), "{mapping}");
        assert!(mapping.contains("\nud = { column = \"u_d\" }  # by its name: is it, and in SI? else unit = ..\n"), "{mapping}");
    }
}

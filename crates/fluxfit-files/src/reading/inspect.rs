//! What was understood of a file: for who wants to know before an answer hangs on it, and a mapping file to start from.

use super::{LogOptions, ReadLog, Told, columns, layout::Layout, read, table::Table};
use crate::{channel::Channel, error::FileError, input};
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
    /// The unit in which it is read, as `--unit` names it, and how it is called.
    pub read_as: Option<(&'static str, &'static str)>,
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
    let inspected = table.heads().iter().enumerate().map(|(index, head)| InspectedColumn {
        header: head.name.clone(),
        unit: head.unit.clone(),
        channel: survey.taken.iter().find(|(_, place, _)| *place == index).map(|(channel, ..)| channel.name()),
        read_as: survey.taken.iter().find(|(_, place, _)| *place == index).map(|(_, _, unit)| (unit.name(), unit.prose())),
        resembles: survey.resembling.iter().find(|(_, place)| *place == index).map(|(channel, _)| channel.name()),
    });
    Ok(Inspection {
        kind: table.kind(),
        layout,
        columns: inspected.collect(),
        log: read(table, &told).map_err(|error| error.in_file(&name)),
    })
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
        text += "# park = \"amplitude-invariant\"  # dq values are phase peaks; or \"power-invariant\", \"rms\"\n\n[columns]\n";
        text += "# besides column and unit: scale = 0.01, and sign = -1 for the other way around\n";
        for channel in Channel::NEEDED {
            let found =
                |of: fn(&InspectedColumn) -> Option<&'static str>| self.columns.iter().find(|column| of(column) == Some(channel.name()));
            let (taken, resembling) = (found(|column| column.channel), found(|column| column.resembles));
            if taken.is_none() && (channel == Channel::T && period.is_some() || self.is_made_of_phases(channel)) {
                continue;
            }
            let (column, remark) = match (taken, resembling) {
                (Some(column), _) => (column.header.as_str(), ""),
                (None, Some(column)) => (column.header.as_str(), "  # by its name: is it?"),
                (None, None) => ("", "  # nothing resembles it"),
            };
            let unit = taken.and_then(|column| column.read_as).map_or(channel.unit().name(), |(unit, _)| unit);
            let _ = writeln!(text, "{} = {{ column = {}, unit = \"{unit}\" }}{remark}", channel.name(), quoted(column));
        }
        for channel in Channel::all().filter(|channel| !Channel::NEEDED.contains(channel)) {
            if let Some(column) = self.columns.iter().find(|column| column.channel == Some(channel.name())) {
                let unit = column.read_as.filter(|(unit, _)| *unit != "1").map(|(unit, _)| format!(", unit = \"{unit}\""));
                let _ = writeln!(text, "{} = {{ column = {}{} }}", channel.name(), quoted(&column.header), unit.unwrap_or_default());
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
    fn a_table_that_is_no_log_is_inspected_all_the_same() {
        let found = inspected("u_d,motor_speed,i_d\n1,2,3\n", &LogOptions::default());
        assert!(found.log.is_err());
        assert_eq!(found.columns.iter().map(|column| column.resembles).collect::<Vec<_>>(), [Some("ud"), Some("omega_e"), Some("id")]);
        let mapping = found.mapping(&LogOptions::default());
        assert!(mapping.contains("\nuq = { column = \"\", unit = \"V\" }  # nothing resembles it\n"), "{mapping}");
        assert!(mapping.contains("\nud = { column = \"u_d\", unit = \"V\" }  # by its name: is it?\n"), "{mapping}");
    }
}

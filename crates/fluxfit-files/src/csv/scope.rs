//! The header of a text that TwinCAT Scope exported: the name of the scope and its times, then a line for each property of the channels,
//! then the rows. Every line of properties begins with the property's name. Channels with the same times are one group: its property's
//! name stands above the time that they share, the values of the property above their own cells (`Name  ud  uq  Name  warm`). Other
//! exports give each channel a time of its own (`Name  ud  Name  uq`), or have such a header above one time for all. A group that is
//! sampled more slowly ends earlier. Times are milliseconds.
//! Source: Beckhoff, TE13xx TwinCAT 3 Scope View, Export to csv.

use super::record::{self, lines};

/// Lines of such a header: its titles, and some eighteen properties.
const LONGEST: usize = 60;

/// The name of the line with the names of the channels.
const NAME: &str = "Name";

/// Properties of which one stands in the line below the names. Of the title `Name  Project` it is `File`.
const BELOW_NAMES: [&str; 5] = ["SymbolComment", "Data-Type", "SampleTime[ms]", "VariableSize", "Unit"];

/// What the header says, and where it and the rows begin.
pub(super) struct Export {
    pub(super) names: Vec<String>,
    pub(super) units: Vec<String>,
    pub(super) start: usize,
    pub(super) separator: u8,
    pub(super) body: usize,
    /// The sample times of the channels, ms, if they differ and one time stands for all: then the rows are not simultaneous.
    pub(super) sample_times: Vec<String>,
}

/// A channel of an export.
struct Exported {
    name: String,
    unit: String,
    /// Its sample time, ms; empty if none is stated.
    sample_time: String,
    /// The number of its group: the channels of a group share a time.
    group: usize,
}

/// The header, if a text begins as such an export.
pub(super) fn find(text: &str) -> Option<Export> {
    if !text.starts_with(NAME) {
        return None;
    }
    let (start, separator, head) = names(text)?;
    let mut stated: Vec<(&str, Vec<String>)> = Vec::new();
    let (body, width) = lines(text).skip_while(|(at, _)| *at <= start).take(LONGEST).find_map(|(at, line)| {
        let row = cells(line, separator);
        let is_row = row.first().is_some_and(|cell| record::number(cell.as_bytes(), separator, &mut String::new()).is_some());
        if let Some(property) = ["Unit", "SampleTime[ms]"].into_iter().find(|property| row.first().is_some_and(|cell| cell == property)) {
            stated.push((property, row.clone()));
        }
        is_row.then_some((at, row.len()))
    })?;
    let value = |property: &str, at: usize| {
        let values = stated.iter().find(|(stated, _)| *stated == property).and_then(|(_, values)| values.get(at));
        values.map(String::as_str).unwrap_or_default()
    };
    let (mut channels, mut groups): (Vec<Exported>, usize) = (Vec::new(), 0);
    for (at, name) in head.iter().enumerate() {
        if name == NAME {
            groups += 1;
            continue;
        }
        // `V (Voltage)`, or `(None)`.
        let unit = value("Unit", at).split('(').next().unwrap_or_default().trim().to_owned();
        channels.push(Exported { name: name.clone(), unit, sample_time: value("SampleTime[ms]", at).to_owned(), group: groups });
    }
    // One time for all below a header that has one for each.
    if width == channels.len() + 1 {
        channels.iter_mut().for_each(|channel| channel.group = 1);
    }
    let timing = channels.get(first_of_most(&channels))?.group;
    let (mut names, mut units, mut group) = (Vec::new(), Vec::new(), 0);
    let sample_times = not_shared(&channels);
    for (at, channel) in channels.into_iter().enumerate() {
        if channel.group != group {
            group = channel.group;
            names.push(if group == timing { "Time".to_owned() } else { format!("Time {}", at + 1) });
            units.push("ms".to_owned());
        }
        names.push(channel.name);
        units.push(channel.unit);
    }
    Some(Export { names, units, start, separator, body, sample_times })
}

/// Where the line with the names of the channels begins, what separates its cells, and these.
fn names(text: &str) -> Option<(usize, u8, Vec<String>)> {
    let head: Vec<(usize, &str)> = lines(text).filter(|(_, line)| !line.trim().is_empty()).take(LONGEST).collect();
    head.windows(2).find_map(|pair| {
        let [(start, line), (_, below)] = *pair else { return None };
        let separator = [b'\t', b';', b','].into_iter().find(|separator| line.starts_with(&format!("{NAME}{}", char::from(*separator))))?;
        let is_header = cells(below, separator).first().is_some_and(|cell| BELOW_NAMES.contains(&cell.as_str()));
        is_header.then(|| (start, separator, cells(line, separator)))
    })
}

/// The sample times of channels that share a time and have different ones; empty if no group has several.
fn not_shared(channels: &[Exported]) -> Vec<String> {
    let of_group = |group: usize| {
        let mut times: Vec<String> = Vec::new();
        for channel in channels.iter().filter(|channel| channel.group == group && !channel.sample_time.is_empty()) {
            if !times.contains(&channel.sample_time) {
                times.push(channel.sample_time.clone());
            }
        }
        times
    };
    channels.iter().map(|channel| of_group(channel.group)).find(|times| times.len() > 1).unwrap_or_default()
}

/// The first channel of the sample time that most channels have: its time is that of the log.
fn first_of_most(channels: &[Exported]) -> usize {
    let count = |at: usize| channels.iter().filter(|other| other.sample_time == channels[at].sample_time).count();
    (0..channels.len()).rev().max_by_key(|&at| count(at)).unwrap_or(0)
}

fn cells(line: &str, separator: u8) -> Vec<String> {
    record::first_record(line, separator).0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the manual shows it, with a decimal comma; with one time for all channels; with two sample times.
    #[test]
    fn names_units_and_rows_of_an_export_are_found() {
        let titles = "Name;S\nFile;C:\\S.svdx\nStarttime of export;132962829843760000\n\n";
        let head = "Name;ud;Name;iq\nSampleTime[ms];0,1;SampleTime[ms];0,1\nUnit;V (Voltage);Unit;(None)\n\n";
        let text = format!("{titles}{head}0,0;-3,5;0,0;2\n");
        let export = find(&text).unwrap();
        assert_eq!(export.names, ["Time", "ud", "Time 2", "iq"]);
        assert_eq!(export.units, ["ms", "V", "ms", ""]);
        assert_eq!((&text[export.start..][..7], export.separator, &text[export.body..]), ("Name;ud", b';', "0,0;-3,5;0,0;2\n"));
        assert_eq!(find(&format!("{titles}{head}0,0;-3,5;2\n")).unwrap().names, ["Time", "ud", "iq"]);
        let shared = find(&format!("{titles}{}0,0;-3,5;2\n", head.replacen("0,1", "0,2", 1))).unwrap();
        assert_eq!((export.sample_times, shared.sample_times), (vec![], vec!["0,2".to_owned(), "0,1".to_owned()]));
        // The time of the log is that of most channels.
        let slow = "Name;warm;Name;ud;Name;iq\nSampleTime[ms];10;SampleTime[ms];0,1;SampleTime[ms];0,1\n\n0,0;25;0,0;-3,5;0,0;2\n";
        assert_eq!(find(&format!("{titles}{slow}")).unwrap().names, ["Time 1", "warm", "Time", "ud", "Time 3", "iq"]);
        assert!(find("Name,File\n1,2\n").is_none() && find(titles).is_none());
    }

    /// As a real export has it: the channels of one sample time share a time, and a slow one has its own.
    #[test]
    fn channels_of_one_time_are_a_group() {
        let head = "Name\tud\tuq\tName\twarm\nSymbolComment\t\t\tSymbolComment\nData-Type\tREAL64\tREAL64\tData-Type\tREAL64\n\
                    SampleTime[ms]\t1\t1\tSampleTime[ms]\t5\nUnit\tV (Voltage)\tV (Voltage)\tUnit\t(None)\n\n";
        for titles in ["Name\tS\nFile\tC:\\S.svdx\nStarttime of export\t132959733843760000\tMontag, 2. Mai 2022\t15:56:24.376\n\n\n", ""] {
            let text = format!("{titles}{head}0\t1,5\t-2\t0\t25\n");
            let export = find(&text).unwrap();
            assert_eq!(export.names, ["Time", "ud", "uq", "Time 3", "warm"]);
            assert_eq!(export.units, ["ms", "V", "V", "ms", ""]);
            assert_eq!((export.separator, &text[export.body..]), (b'\t', "0\t1,5\t-2\t0\t25\n"));
            assert!(export.sample_times.is_empty());
        }
        let alone = find("Name,ud,uq,id\nSampleTime[ms],1,1,1\n\n0,1,2,3\n").unwrap();
        assert_eq!(alone.names, ["Time", "ud", "uq", "id"]);
    }
}

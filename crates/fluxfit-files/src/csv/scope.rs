//! The header of a text that TwinCAT Scope exported: after the name of the scope and its times, a line for each property of the channels,
//! in which every value stands behind the property's name (`Name  ud  Name  uq`), then the rows. Each channel has a time of its own
//! before its values, or channels of one sample time share it; one that is sampled more slowly ends earlier. Times are milliseconds.
//! Source: Beckhoff, TE13xx TwinCAT 3 Scope View, Export to csv.

use super::record::{self, lines};

/// Lines of such a header: its titles, and some eighteen properties.
const LONGEST: usize = 60;

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

/// The header, if a text begins as such an export.
pub(super) fn find(text: &str) -> Option<Export> {
    let mut first = lines(text);
    if !(first.next()?.1.starts_with("Name") && first.next()?.1.starts_with("File")) {
        return None;
    }
    let channels = |line: &str| [b'\t', b';', b','].into_iter().find_map(|separator| Some((separator, values(line, separator, "Name")?)));
    let mut head = lines(text).skip(2).take(LONGEST);
    let (start, (separator, channels)) = head.find_map(|(start, line)| Some((start, channels(line)?)))?;
    let (mut stated, mut periods) = (Vec::new(), Vec::new());
    let (body, width) = head.find_map(|(start, line)| {
        let row = cells(line, separator);
        let is_row = row.first().is_some_and(|cell| record::number(cell.as_bytes(), separator, &mut String::new()).is_some());
        match row.first().map(String::as_str) {
            Some("Unit") => stated = values(line, separator, "Unit").unwrap_or_default(),
            Some("SampleTime[ms]") => periods = values(line, separator, "SampleTime[ms]").unwrap_or_default(),
            _ => {}
        }
        is_row.then_some((start, row.len()))
    })?;
    let is_shared = width == channels.len() + 1;
    let mut sample_times: Vec<String> = Vec::new();
    for period in periods.iter().filter(|period| is_shared && !period.is_empty()) {
        if !sample_times.contains(period) {
            sample_times.push(period.clone());
        }
    }
    if sample_times.len() < 2 {
        sample_times.clear();
    }
    let timing = first_of_most(&periods);
    let (mut names, mut units) = (Vec::new(), Vec::new());
    for (at, channel) in channels.into_iter().enumerate() {
        if at == 0 || !is_shared {
            names.push(if is_shared || at == timing { "Time".to_owned() } else { format!("Time {}", at + 1) });
            units.push("ms".to_owned());
        }
        names.push(channel);
        // `V (Voltage)`, or `(None)`.
        let unit = stated.get(at).and_then(|unit| unit.split('(').next());
        units.push(unit.unwrap_or_default().trim().to_owned());
    }
    Some(Export { names, units, start, separator, body, sample_times })
}

/// The first channel of the sample time that most channels have: its time is that of the log.
fn first_of_most(periods: &[String]) -> usize {
    let count = |period: &String| periods.iter().filter(|other| *other == period).count();
    (0..periods.len()).rev().max_by_key(|&at| count(&periods[at])).unwrap_or(0)
}

fn cells(line: &str, separator: u8) -> Vec<String> {
    record::first_record(line, separator).0
}

/// The values of a property, if a line has it: in every second cell stands its name.
fn values(line: &str, separator: u8, name: &str) -> Option<Vec<String>> {
    let cells = cells(line, separator);
    let is_property = cells.len() > 3 && cells.iter().step_by(2).all(|cell| cell == name);
    is_property.then(|| cells.into_iter().skip(1).step_by(2).collect())
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
}

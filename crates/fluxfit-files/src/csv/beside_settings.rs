//! Traces of oscilloscopes of Tektronix' TDS series: three columns of settings stand beside the first samples, and no line has the names of
//! the columns.

use super::record::{self, lines};

/// The first setting.
const FIRST: &str = "Record Length";

/// Lines in which the settings stand.
const SETTINGS: usize = 20;

/// The place of the time; the samples are behind it.
const TIME: usize = 3;

/// Names and units of the columns.
pub(super) struct Samples {
    pub(super) names: Vec<String>,
    pub(super) units: Vec<String>,
}

/// The columns, named by the settings, if a text has these and samples from this place on.
pub(super) fn find(text: &str, start: usize) -> Option<Samples> {
    let (first, _) = record::first_record(&text[start..], b',');
    let is_number = |cell: &String| record::number(cell.as_bytes(), b',', &mut String::new()).is_some();
    if first.first().is_none_or(|name| name != FIRST) || first.len() != TIME + 2 || !first[TIME..].iter().all(is_number) {
        return None;
    }
    let setting = |wanted: &str| {
        let of_line = |(_, line): (usize, &str)| record::first_record(line, b',').0;
        lines(&text[start..]).take(SETTINGS).map(of_line).find(|cells| cells.first().is_some_and(|name| name == wanted))?.into_iter().nth(1)
    };
    let of_samples = |time: &str, samples: Option<String>| {
        let mut cells = vec![String::new(); TIME];
        cells.extend([time.to_owned(), samples.unwrap_or_default()]);
        cells
    };
    let mut units = of_samples(&setting("Horizontal Units").unwrap_or_default(), setting("Vertical Units"));
    units.iter_mut().for_each(|unit| *unit = unit.trim().to_owned());
    Some(Samples { names: of_samples("TIME", Some(setting("Source")?)), units })
}

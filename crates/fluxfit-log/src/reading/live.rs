//! A log that is still being written: its rows one by one, in SI units, as their lines arrive.
//!
//! Only tables of text with dq quantities and a speed are read so. What needs a whole log, such as repairs, alignment of channels and
//! the transforms of phase quantities, needs a finished one.

use super::{
    chosen::{self, ChosenColumn},
    columns,
    layout::Layout,
    options::{LogOptions, ResolvedOptions},
    table::Table,
};
use crate::{channel::Channel, csv::Text, note::Note, problem::Problem};
use fluxfit::log::Row;
use fluxfit_files::{
    FileError,
    csv::{
        header::{self, Header},
        record,
        tidy::RowStyle,
    },
};

/// Rows of numbers below the header that are needed to recognize it.
const ROWS: usize = 2;

/// Most bytes above them.
const MOST: usize = 1 << 16;

/// The columns of a log that is being written.
#[derive(Debug)]
pub struct LiveLog {
    columns: Vec<ChosenColumn>,
    separator: u8,
    style: RowStyle,
    cells: usize,
    /// Time between rows, s, where no column has the time.
    sample_period: Option<f64>,
    rows: u64,
    scratch: String,
    /// Where the cells of a line begin and end.
    bounds: Vec<[usize; 2]>,
    /// What was inferred.
    pub notes: Vec<Note>,
    /// What was read as what, in a line.
    pub described: String,
}

impl LiveLog {
    /// Recognizes the columns from the first lines: none, if there are too few yet. Also the lines below the header, which are rows.
    ///
    /// # Errors
    /// If they are no table of text, or it has not the columns of a log in dq quantities; `name` stands for the file.
    pub fn open(name: &str, head: &str, options: &LogOptions) -> Result<Option<(Self, String)>, FileError> {
        let found = |head: &str| header::find(head, &mut Vec::new()).is_ok_and(|header| rows_below(head, &header) >= ROWS);
        if head.len() < MOST && !found(head) {
            return Ok(None);
        }
        Self::of(head, &ResolvedOptions::resolve(options)?).map(Some).map_err(|error| error.in_file(name))
    }

    fn of(head: &str, options: &ResolvedOptions) -> Result<(Self, String), FileError> {
        let header = header::find(head, &mut Vec::new())?;
        let table = Table::beginning(Text::of(head.to_owned()))?;
        let mut notes: Vec<Note> = table.notes().iter().cloned().map(Note::from).collect();
        let names: Vec<String> = header.names.clone();
        let layout = Layout::recognize(&names);
        let chosen = columns::choose(&table, layout.filter(|layout| !layout.is_canonical()), options, &mut notes)?;
        let sample_period = options.sample_period.or(layout.and_then(|layout| layout.sample_period));
        let has = |channel: &Channel| chosen.iter().any(|column| column.channel == *channel);
        let missing = Channel::NEEDED.into_iter().find(|channel| !has(channel) && (*channel != Channel::T || sample_period.is_none()));
        // An index without a name may count the rows, which is told of a whole log alone.
        let is_index = |column: &ChosenColumn| column.channel == Channel::T && column.header == header::UNNAMED;
        if missing.is_some() || !options.shares_of_bus.is_empty() || chosen.iter().any(is_index) {
            return Err(Problem::NotLive.into());
        }
        let described = chosen::describe(&chosen);
        let (separator, style, cells) = (header.separator, header.rows, header.names.len());
        let live = Self {
            columns: chosen,
            separator,
            style,
            cells,
            sample_period,
            rows: 0,
            scratch: String::new(),
            bounds: Vec::new(),
            notes,
            described,
        };
        Ok((live, head[header.body.min(head.len())..].to_owned()))
    }

    /// The row of a line; none of a blank line or a comment. What cannot be read is NaN: a line that was cut is no end of the log.
    pub fn row(&mut self, line: &str) -> Option<Row> {
        let line = line.trim_end_matches(['\r', '\n']);
        let tidied = self.style.tidied(line, 0);
        let bare = tidied.trim();
        if bare.is_empty() || bare.starts_with(['#', '%']) {
            return None;
        }
        let bytes = tidied.as_bytes();
        self.bounds.clear();
        let mut begin = 0;
        for end in memchr::memchr_iter(self.separator, bytes).chain([bytes.len()]) {
            self.bounds.push([begin, end]);
            begin = end + 1;
        }
        let mut row = self.cut_row();
        // A line that was cut may end within a number.
        if self.bounds.len() < self.cells {
            return Some(row);
        }
        for column in &self.columns {
            let Some([begin, end]) = self.bounds.get(column.index).copied() else { continue };
            let cell = &bytes[begin..end];
            let value = match &column.instants {
                Some(instants) => instants.seconds(record::trimmed(cell)),
                None => record::number(cell, self.separator, &mut self.scratch),
            };
            let mut value = [value.unwrap_or(f64::NAN)];
            column.to_si(&mut value);
            let [value] = value;
            match column.channel {
                Channel::T => row.t = value,
                Channel::Ud => row.ud = value,
                Channel::Uq => row.uq = value,
                Channel::Id => row.id = value,
                Channel::Iq => row.iq = value,
                Channel::OmegaE => row.omega_e = value,
                Channel::ThetaE => row.theta_e = Some(value),
                Channel::UDc => row.u_dc = Some(value),
                Channel::Temperature => row.temperature = Some(value),
                _ => {}
            }
        }
        Some(row)
    }

    /// The row of a line that was cut within its last number, which may be a smaller number now: nothing but NaN.
    pub fn cut_row(&mut self) -> Row {
        let t = self.sample_period.map_or(f64::NAN, |period| self.rows as f64 * period);
        self.rows += 1;
        Row { t, ud: f64::NAN, uq: f64::NAN, id: f64::NAN, iq: f64::NAN, omega_e: f64::NAN, ..Row::default() }
    }
}

/// Whole lines of numbers below the header.
fn rows_below(head: &str, header: &Header) -> usize {
    let body = &head[header.body.min(head.len())..];
    let is_row = |line: &&str| {
        let tidied = header.rows.tidied(line.trim_end_matches(['\r', '\n']), 0);
        let (cells, _) = record::first_record(&tidied, header.separator);
        line.ends_with('\n') && cells.iter().filter(|cell| header::is_number(cell)).count() * 2 > cells.len()
    };
    body.split_inclusive('\n').filter(is_row).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_units::Unit;

    #[test]
    fn rows_are_read_as_their_lines_arrive() {
        let options = LogOptions { units: vec![("omega_e".into(), Unit::RpmElectrical)], ..LogOptions::default() };
        let head = "# drive 3\nt_ms;ud;uq;id;iq;omega_e\n0;1,5;20;0;3;60\n";
        assert!(LiveLog::open("a", head, &options).unwrap().is_none());
        let whole = format!("{head}1;1,5;20;0;3;60\n");
        let (mut live, rest) = LiveLog::open("a", &whole, &options).unwrap().unwrap();
        assert_eq!(rest, "0;1,5;20;0;3;60\n1;1,5;20;0;3;60\n");
        let row = live.row("1;1,5;-20;0,25;3;60\r\n").unwrap();
        assert_eq!((row.t, row.ud, row.uq, row.id, row.iq), (0.001, 1.5, -20.0, 0.25, 3.0));
        assert!((row.omega_e - std::f64::consts::TAU).abs() < 1e-12);
        assert!(live.row("\n").is_none() && live.row("# pause\n").is_none());
        assert!(live.row("2;1,5;-20;0,2").unwrap().id.is_nan());
        assert!(live.row("2;1,5;x;0,25;3;60").unwrap().uq.is_nan());
    }

    #[test]
    fn what_needs_a_whole_log_is_refused() {
        let refusal = |head: &str| LiveLog::open("a", head, &LogOptions::default()).unwrap_err().to_string();
        let phases = refusal("t,ua,ub,uc,ia,ib,ic,theta_e\n0,1,2,3,4,5,6,0\n1,1,2,3,4,5,6,0\n");
        assert!(phases.contains("needs columns of ud, uq, id, iq and omega_e"), "{phases}");
        let missing = refusal("t,ud,uq,id,iq\n0,1,2,3,4\n1,1,2,3,4\n");
        assert!(missing.contains("omega_e is missing"), "{missing}");
    }
}

//! The only error of this crate: one sentence on one line that says where, what, and what to do.
//!
//! `drive.csv, line 17, column 'uq': "abc" is not a number; correct it or remove the row`
//!
//! The place is told once, by [`FileError`]; the sentence once, by the problem.

use crate::wording::{choice, columns, did_you_mean, list, one_line, quote, shorten};
use std::fmt;

/// What could not be read, written or understood, and where. Its `Display` is one line.
#[derive(Debug, Clone, PartialEq)]
pub struct FileError(Box<Located>);

#[derive(Debug, Clone, PartialEq)]
struct Located {
    file: Option<String>,
    line: Option<u64>,
    row: Option<u64>,
    field: Option<Field>,
    problem: Problem,
}

#[derive(Debug, Clone, PartialEq)]
enum Field {
    Column(String),
    Key(String),
}

impl FileError {
    /// The file as it was named, or `standard input`; none for an argument.
    pub fn file(&self) -> Option<&str> {
        self.0.file.as_deref()
    }

    /// The line of the file, from 1, counted as an editor counts.
    pub fn line(&self) -> Option<u64> {
        self.0.line
    }

    /// The column's name in the file's header, or the key of a motor or truth file.
    pub fn column(&self) -> Option<&str> {
        self.0.field.as_ref().map(|(Field::Column(name) | Field::Key(name))| name.as_str())
    }

    pub(crate) fn in_file(mut self, name: &str) -> Self {
        self.0.file.get_or_insert_with(|| name.to_owned());
        self
    }

    pub(crate) fn at_line(mut self, line: u64) -> Self {
        self.0.line.get_or_insert(line);
        self
    }

    /// Of a container, which has no lines; rows count from 1.
    pub(crate) fn at_row(mut self, row: u64) -> Self {
        self.0.row.get_or_insert(row);
        self
    }

    pub(crate) fn in_column(mut self, header: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Column(header.to_owned()));
        self
    }

    pub(crate) fn in_key(mut self, key: &str) -> Self {
        self.0.field.get_or_insert_with(|| Field::Key(key.to_owned()));
        self
    }
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        Self(Box::new(Located { file: None, line: None, row: None, field: None, problem }))
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Located { file, line, row, field, problem } = &*self.0;
        let place: Vec<String> = [
            file.clone(),
            line.map(|line| format!("line {line}")),
            row.map(|row| format!("row {row}")),
            field.as_ref().map(|field| match field {
                Field::Column(header) => format!("column '{}'", shorten(header)),
                Field::Key(key) => format!("key '{}'", shorten(key)),
            }),
        ]
        .into_iter()
        .flatten()
        .collect();
        let sentence = if place.is_empty() { problem.to_string() } else { format!("{}: {problem}", place.join(", ")) };
        // Names come from files and may hold anything.
        f.write_str(&one_line(&sentence))
    }
}

impl std::error::Error for FileError {}

/// The sentences. Texts taken from files are quoted here, never before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    // Files
    #[error("this is a directory; name a file in it")]
    Directory,
    #[error("there is no such file; check the path")]
    NotFound,
    #[error("permission is denied; change the permissions, or name another file")]
    NotPermitted,
    #[error("{action} failed: {reason}; try again, or name another file")]
    Io { action: &'static str, reason: String },
    #[error("the directory {} does not exist; create it, or name another file", quote(.directory))]
    NoDirectory { directory: String },
    #[error("this is not text in UTF-8; export it as {wanted} in UTF-8")]
    NotText { wanted: &'static str },
    #[error("the gzip file is cut off or damaged: {reason}; pack it again")]
    Packed { reason: String },
    #[error("this is {what}; save the table as CSV")]
    Document { what: &'static str },
    #[error("the file is empty; export it again")]
    Empty,

    // The header of a log
    #[error("there are only comments; a header line with the names of the columns and rows of numbers are needed")]
    NoHeader,
    #[error("there is no row below the header; export the log with its rows")]
    NoRows,
    #[error("{} are numbers where the header should be; put a line with the names of the columns above them", quote(.text))]
    NumbersForHeader { text: String },
    #[error("{} is only one column; separate the names, and the values, by comma, semicolon or tab", quote(.text))]
    OneColumn { text: String },
    #[error("{}{}", missing_columns(.missing, .present, .proposals), no_measurements(.references, .unreadable))]
    Missing {
        missing: Vec<&'static str>,
        present: Vec<String>,
        proposals: Vec<(&'static str, String)>,
        references: Vec<String>,
        unreadable: Vec<String>,
    },
    #[error(
        "the name says that this is a reference, and what a drive asked for is not the current that flowed; name the measured current with --map {channel}=COLUMN, or log it"
    )]
    Reference { channel: &'static str },
    #[error("this is a file of the layout '{layout}': {reason}")]
    NoLog { layout: &'static str, reason: &'static str },
    #[error(
        "ud, uq, id, iq and omega_e all have a mean near 0 and a standard deviation near 1: the file is standardized, its values are not in V, A and rad/s; identify from the original"
    )]
    Standardized,
    #[error(
        "phase quantities and the angle were sampled at different instants, between which they turn: log them together, or log dq quantities"
    )]
    TurningApart,
    #[error("no instant of {base} lies between two near values of every other channel; log the channels together, or over the same time")]
    Apart { base: &'static str },
    #[error("the wanted columns are of different lengths and no times tell how they belong together: {}; give each its time, or equal lengths", list(.lengths))]
    Lengths { lengths: Vec<String> },
    #[error("the header names this column {count} times; rename or remove all but one")]
    Duplicate { count: usize },
    #[error("the columns {} could each be {channel}; choose one with --map {channel}=COLUMN", columns(.headers))]
    Ambiguous { channel: &'static str, headers: Vec<String> },
    #[error("this column would be both {first} and {second}; say which columns they are, with --map {first}=COLUMN,{second}=COLUMN")]
    Shared { first: &'static str, second: &'static str },
    #[error("--map {channel}={header}: the file has no column '{header}', it has {}{}", columns(.present), did_you_mean(.nearest.as_deref()))]
    MappedHeader { channel: &'static str, header: String, present: Vec<String>, nearest: Option<String> },
    #[error("{} in the header is no unit of {channel} known here; say the unit with --unit {channel}={}", quote(.text), choice(.units))]
    HeaderUnit { channel: &'static str, text: String, units: Vec<&'static str> },
    #[error(
        "the {what} is in {unit}, and only the pole pairs make it electrical; add --pole-pairs N, or --unit {channel}={electrical} if it is electrical already"
    )]
    PolePairs { what: &'static str, channel: &'static str, unit: &'static str, electrical: &'static str },

    // The rows of a log
    #[error("the row has {} where the header has {expected}; {}", cells(*.found), row_remedy(*.found > *.expected, *.multiline))]
    RowLength { found: usize, expected: usize, multiline: bool },
    #[error("the cell is empty or NaN; write a number or remove the row")]
    EmptyCell,
    #[error("{} is not a number; correct it or remove the row", quote(.text))]
    NotANumber { text: String },
    #[error("{} has both marks, and which one is decimal is a guess; write numbers without thousands separators", quote(.text))]
    Thousands { text: String },
    #[error("{} is not a number; write time as a number, in s", quote(.text))]
    ClockTime { text: String },
    #[error("{} does not have the decimal mark of line {other}; use one mark throughout, and no thousands separators", quote(.text))]
    DecimalMarks { text: String, other: u64 },
    #[error("this cell does not have the decimal mark of line {other}; use one mark throughout, and no thousands separators")]
    OtherMark { other: u64 },
    #[error("{0}")]
    Log(fluxfit::error::Error),

    // Containers
    #[error("this {format} file cannot be read: {fault}")]
    Container { format: &'static str, fault: String },
    #[error("this {format} file has no column of two or more numbers; export the log with each quantity as a column of numbers")]
    NoNumbers { format: &'static str },
    #[error("this file has more than {most} columns; export the log alone")]
    ManyColumns { most: usize },
    #[error("these columns were not sampled at the same instants; read them one by one")]
    TwoGroups,
    #[error("{} is a {} object, which only MATLAB can read; {}", quote(.name), shorten(.class), object_remedy(.name, .class))]
    MatObject { name: String, class: String },
    #[error("this HDF5 file uses {what}, which is not read here; write it with libver='earliest', or export the log as Parquet")]
    NewerHdf5 { what: &'static str },
    #[error("this HDF5 file is packed by filter {identifier}, which is not read here; pack it with gzip, or export the log as Parquet")]
    Hdf5Filter { identifier: u16 },
    #[error("this Parquet file is packed by {codec}, which is not read here; pack it with zstd, gzip, lz4 or snappy")]
    ParquetCodec { codec: String },
    #[error("this HDF5 file has chunks of more than {most} MiB; write it with smaller chunks, or export the log as Parquet")]
    LargeChunks { most: u64 },
    #[error("this is MDF 3 or older; convert it to MDF 4, or export the log as Parquet or CSV")]
    OldMdf,
    #[cfg(not(feature = "mdf4"))]
    #[error("this fluxfit was built without MDF 4; build it with --features mdf4, or export the log as Parquet or CSV")]
    NoMdf,

    // Arguments
    #[error("{} is not understood; write {form}, as in {example}", quote(.text))]
    Form { text: String, form: &'static str, example: &'static str },
    #[error(
        "{} is no column of a log; the columns are {}, and optionally {}{}",
        quote(.name), list(.needed), list(.optional), did_you_mean(*.nearest)
    )]
    Channel { name: String, needed: Vec<&'static str>, optional: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is no target of --export; there are {}{}", quote(.name), list(.known), did_you_mean(*.nearest))]
    Target { name: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is no unit of {channel}; it can be {}", quote(.unit), choice(.allowed))]
    Unit { channel: &'static str, unit: String, allowed: Vec<&'static str> },
    #[error("{channel} is given twice; give it once")]
    Twice { channel: &'static str },
    #[error("0 pole pairs are no motor; give --pole-pairs 1 or more")]
    ZeroPolePairs,
    #[error("{} is no parameter; the parameters are {}{}", quote(.name), list(.known), did_you_mean(*.nearest))]
    Parameter { name: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is not {noun}; write a number, in {si} or with its unit, as in {example}", quote(.text))]
    Quantity { text: String, noun: &'static str, si: &'static str, example: &'static str },
    #[error("{} is not a ratio; write a number without a unit, as in {example}", quote(.text))]
    Ratio { text: String, example: &'static str },
    #[error("{} is out of range; it must be {range}", quote(.text))]
    Range { text: String, range: &'static str },
    #[error("{} has a unit on one number only; write it on both", quote(.text))]
    OneSidedUnit { text: String },
    #[error("{} does not run upward; write the lower end first", quote(.text))]
    Interval { text: String },

    // Motor files, scenarios and truths
    #[error("this is not {format}: {message}; correct it")]
    Syntax { format: &'static str, message: String },
    #[error("this key is not known; {table} can hold {}{}", list(.known), did_you_mean(*.nearest))]
    Key { table: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("this key stands outside of a table; put it below a line [{table}]")]
    OutsideTable { table: &'static str },
    #[error("this key belongs to [{table}]; move it there")]
    OtherTable { table: &'static str },
    #[error("this key stands above all tables; move it to the top of the file")]
    InsideTable,
    #[error("this is not {wanted}; correct it")]
    Value { wanted: String },
    #[error("{} is not known here; it can be {}{}", quote(.text), choice(.known), did_you_mean(*.nearest))]
    Word { text: String, known: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("the key {key} is missing; write {remedy}")]
    MissingKey { key: String, remedy: String },
    #[error("this key excludes {by}; remove one of them")]
    Excluded { by: &'static str },
    #[error("{0}")]
    Drive(fluxfit_drive::Error),
    #[error("{}", missing_map_columns(.missing, .present))]
    MapColumns { missing: Vec<&'static str>, present: Vec<String> },
    #[error("this truth has no constant parameters, because the simulated motor was a flux map; compare without a truth")]
    NoConstants,
    #[error("the schema is {} where {wanted} is needed; give a truth file", shorten(.found))]
    Schema { found: String, wanted: &'static str },
    #[error("the schema is {}, which holds no motor; give a motor file, the JSON of fluxfit identify or a truth file", quote(.found))]
    MotorSchema { found: String },
    #[error("the {} missing; a motor is validated with all four: write {} below [motor]", parameters(.missing, "is", "are"), them(.missing))]
    MissingParameters { missing: Vec<&'static str> },
    #[error(
        "the {} no value, because the log could not tell {them} when the motor was identified; identify again with a log that excites {them}, or with --fix",
        parameters(.untold, "has", "have"), them = them(.untold)
    )]
    UntoldParameters { untold: Vec<&'static str> },
}

/// What to type in MATLAB.
fn object_remedy(name: &str, class: &str) -> String {
    let name = shorten(name);
    match class {
        "table" => format!("save it as text with writetable({name}, 'log.csv')"),
        "timetable" => format!("save it as text with writetimetable({name}, 'log.csv')"),
        "timeseries" => format!("save its numbers with s = struct('Time', {name}.Time, 'Data', {name}.Data); save('log.mat', 's')"),
        _ => "save its numbers as vectors, or as a structure of vectors".to_owned(),
    }
}

fn parameters(keys: &[&str], one: &str, several: &str) -> String {
    if keys.len() == 1 { format!("parameter {} {one}", list(keys)) } else { format!("parameters {} {several}", list(keys)) }
}

fn them(keys: &[&str]) -> &'static str {
    if keys.len() == 1 { "it" } else { "them" }
}

fn missing_map_columns(missing: &[&str], present: &[String]) -> String {
    let (noun, are) = if missing.len() == 1 { ("column", "is") } else { ("columns", "are") };
    let what = format!("the {noun} {} {are} missing; the file has {}", list(missing), columns(present));
    format!("{what}, and a flux map needs id, iq in A, psi_d, psi_q in Wb")
}

fn no_measurements(references: &[String], unreadable: &[String]) -> String {
    let of_references = match references {
        [] => String::new(),
        [one] => format!("; '{}' is a reference, not the current that flowed", shorten(one)),
        several => format!("; {} are references, not the currents that flowed", columns(several)),
    };
    let of_others = if unreadable.is_empty() { String::new() } else { format!("; no numbers are in {}", columns(unreadable)) };
    of_references + &of_others
}

fn cells(count: usize) -> String {
    if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") }
}

fn row_remedy(too_many: bool, multiline: bool) -> &'static str {
    match (multiline, too_many) {
        (true, _) => "a quotation mark in this line opens a cell that runs over several lines: close it",
        (false, true) => "remove the cells that are too many, or the row",
        (false, false) => "complete the row or remove it",
    }
}

/// The proposals come as an argument that can be pasted.
fn missing_columns(missing: &[&str], present: &[String], proposals: &[(&str, String)]) -> String {
    let (noun, are, them, names) =
        if missing.len() == 1 { ("column", "is", "it", "another name") } else { ("columns", "are", "them", "other names") };
    let what = format!("the {noun} {} {are} missing; the file has {}", list(missing), columns(present));
    if let ([], Some(example)) = (proposals, missing.first()) {
        return format!("{what}; if it has {them} under {names}, add --map {example}=COLUMN; else log {them} too");
    }
    let pairs: Vec<String> = proposals.iter().map(|(channel, header)| format!("{channel}={header}")).collect();
    let argument = pairs.join(",");
    let plain = argument.chars().all(|c| c.is_alphanumeric() || "_=,.-@".contains(c));
    let quotes = if plain { "" } else { "\"" };
    let rest: Vec<&str> = missing.iter().filter(|channel| proposals.iter().all(|(proposed, _)| proposed != *channel)).copied().collect();
    let lacking = if rest.is_empty() { String::new() } else { format!("; nothing resembles {}, needed too", list(&rest)) };
    format!("{what}; if it has {them} under {names}, add --map {quotes}{argument}{quotes}{lacking}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_comes_first_and_only_where_there_is_one() {
        let problem = || FileError::from(Problem::NotANumber { text: "abc".into() });
        assert_eq!(problem().to_string(), "\"abc\" is not a number; correct it or remove the row");
        let placed = problem().in_file("drive.csv").at_line(17).in_column("uq");
        assert_eq!(placed.to_string(), "drive.csv, line 17, column 'uq': \"abc\" is not a number; correct it or remove the row");
        assert_eq!((placed.file(), placed.line(), placed.column()), (Some("drive.csv"), Some(17), Some("uq")));
    }

    #[test]
    fn the_innermost_place_stays() {
        let error = FileError::from(Problem::EmptyCell).at_line(3).at_line(1).in_file("a").in_file("b");
        assert_eq!(error.to_string(), "a, line 3: the cell is empty or NaN; write a number or remove the row");
    }
}

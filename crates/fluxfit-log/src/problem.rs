//! What is wrong with a log, or with what is said of it.

use fluxfit_files::FileError;
use fluxfit_units::wording::{choice, columns, did_you_mean, list, quote, shorten};

/// The sentences. Texts taken from files are quoted here, never before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    #[error("the gzip file is cut off or damaged: {reason}; pack it again")]
    Packed { reason: String },
    #[error("this is {what}; save the table as CSV")]
    Document { what: &'static str },
    #[error("there is no row below the header; export the log with its rows")]
    NoRows,
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
    #[error("the cell is empty or NaN; write a number or remove the row")]
    EmptyCell,
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
    #[error(
        "{} is no column of a log; the columns are {}, and optionally {}{}",
        quote(.name), list(.needed), list(.optional), did_you_mean(*.nearest)
    )]
    Channel { name: String, needed: Vec<&'static str>, optional: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is no unit of {channel}; it can be {}", quote(.unit), choice(.allowed))]
    Unit { channel: &'static str, unit: String, allowed: Vec<&'static str> },
    #[error("{channel} is given twice; give it once")]
    Twice { channel: &'static str },
    #[error("0 pole pairs are no motor; give --pole-pairs 1 or more")]
    ZeroPolePairs,
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        Self::new(&problem)
    }
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

fn no_measurements(references: &[String], unreadable: &[String]) -> String {
    let of_references = match references {
        [] => String::new(),
        [one] => format!("; '{}' is a reference, not the current that flowed", shorten(one)),
        several => format!("; {} are references, not the currents that flowed", columns(several)),
    };
    let of_others = if unreadable.is_empty() { String::new() } else { format!("; no numbers are in {}", columns(unreadable)) };
    of_references + &of_others
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

//! What can be wrong with a log, or with what is stated about it.

use crate::missing_columns::{
    LineToLine, MODULATION, are_lists, are_not_in_it, are_rms, equal_axes, has_d_alone, may_be_table, missing_columns, not_measured, polar,
    proposed_rms, shares, speed_by_name, without_time,
};
use crate::unclear_table::UnclearTable;
use fluxfit_files::{Advice, FileError, FileErrorKind};
use fluxfit_units::wording::{choice, columns, did_you_mean, list, quote, shorten};
use fluxfit_units::{Unit, significant};

/// Most columns that a sentence lists.
const MOST_NAMES: usize = 20;

/// The problems and their sentences. Texts taken from files are quoted and shortened here and nowhere else.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    // Text
    #[error("the gzip file is cut off or damaged: {reason}; compress it again")]
    Gzip { reason: String },
    #[error("this is {what}; save the table as CSV")]
    Document { what: &'static str },
    #[error(
        "this is an archive of numpy's arrays; in Python, make a table of those of equal length: import numpy as np, pandas as pd; a = np.load('log.npz'); pd.DataFrame({{k: a[k] for k in a.files if a[k].ndim == 1}}).to_csv('log.csv', index=False)"
    )]
    Npz,
    #[error("a log that is read while it is written needs columns of ud, uq, id, iq and omega_e in dq; give the finished log as a file")]
    NotLive,
    #[error("there is no row below the header; export the log with its rows")]
    NoRows,
    #[error("the cell is empty or NaN; write a number or remove the row")]
    EmptyCell,
    #[error("the column has no number in any row; log it, or map another one in its place")]
    EmptyColumn,
    #[error("{} has a comma and a point, so its decimal mark is ambiguous; write numbers without thousands separators", quote(.text))]
    Thousands { text: String },
    #[error(
        "the commas in its quoted numbers may be decimal marks or thousands separators; write numbers with decimal points and without thousands separators"
    )]
    UnclearComma,
    #[error("{} is a time that is not understood; write it as a number, in s, or as in 2016-02-12 10:31:00.123", quote(.text))]
    ClockTime { text: String },
    #[error("{} is no date and time as in the first rows; write all of them in one way", quote(.text))]
    Instant { text: String },
    #[error("{} has another decimal mark than line {other}; use one mark throughout, and no thousands separators", quote(.text))]
    DecimalMarks { text: String, other: u64 },
    #[error("this cell has another decimal mark than line {other}; use one mark throughout, and no thousands separators")]
    OtherMark { other: u64 },

    // Columns
    #[error("{}{}{}{}{}{}{}{}", missing_columns(.missing, .present, .proposals, .equal), equal_axes(.equal), shares(.modulations), speed_by_name(.speed.as_ref().map(|(_, unit)| *unit)), .line_to_line, without_time(.missing, .proposals), proposed_rms(.proposals, .rms), not_measured(.references, .unreadable, .lists))]
    Missing {
        missing: Vec<&'static str>,
        present: Vec<String>,
        proposals: Vec<(&'static str, String)>,
        /// Channels that several columns could be whose names differ in a number, and these.
        equal: Vec<(&'static str, Vec<String>)>,
        /// Where voltages are missing, columns that are shares of the DC voltage, and the voltages.
        modulations: Vec<(&'static str, String)>,
        /// The proposed channels whose columns hold root mean squares, and their units.
        rms: Vec<(&'static str, &'static str)>,
        references: Vec<String>,
        unreadable: Vec<String>,
        lists: Vec<String>,
        line_to_line: LineToLine,
        /// The speed among the proposed channels, and its unit by its name.
        speed: Option<(&'static str, Unit)>,
    },
    #[error("each row has one value, in '{}', of the quantity that '{}' names; write a row for each instant with a column for each quantity (pandas: pivot, InfluxDB: pivot(), SQL: PIVOT)", shorten(.value), shorten(.quantity))]
    ARowPerValue { quantity: String, value: String },
    #[error("by its name this column is a reference, not the measured current; map {channel} to the measured current, or log it")]
    Reference { channel: &'static str },
    #[error("{}; state their unit, also if they are peak values", are_rms(&.columns.iter().map(|(_, header, _)| header.as_str()).collect::<Vec<_>>()))]
    Rms { columns: Vec<(&'static str, String, &'static str)> },
    #[error("by its name this column holds rms values, and the phase quantity is needed at each instant; log it, or id and iq")]
    PhaseRms,
    #[error("the file has the layout '{layout}': {reason}")]
    NotALog { layout: &'static str, reason: &'static str, advice: Option<Advice> },
    #[error(
        "this is a trace of voltages alone, as of a motor that is turned with open terminals: it tells psi_f alone, by waves of {} Hz and {} V rms; write such a row for each of three or more speeds into a table with the columns 'f [Hz]' and 'U_ll_rms [V]' (of a phase, 'U_phase_rms [V]'), and give that", significant(*.hertz, 4), significant(*.volts, 4)
    )]
    OpenTerminals { hertz: f64, volts: f64 },
    #[error(
        "this is a trace of an oscilloscope, {}, and a log needs voltages and currents of the motor with its speed or angle; of voltages of a motor that is turned with open terminals, write frequency and rms voltage of each speed into a table with the columns 'f [Hz]' and 'U_ll_rms [V]'; of a direct current through two terminals, write voltage and current into one with the columns 'U_ll [V]' and 'I [A]'; give that", columns(.names)
    )]
    Trace { names: Vec<String> },
    #[error(
        "{} are readings of a power meter, rms values and powers of one of its elements, and a log has the values of each instant with a speed or an angle; of a motor that is turned with open terminals map speed and voltage, with shorted ones speed and current, of a direct current through the motor at rest voltage and current",
        columns(.names)
    )]
    PowerMeter { names: Vec<String> },
    #[error("{}", polar(.vectors))]
    Polar {
        /// Of currents (`i`) and voltages (`u`), the columns with length and angle.
        vectors: Vec<(&'static str, [String; 2])>,
    },
    #[error(
        "the names of its columns are numbers, as of a matrix over two quantities: of a flux linkage over i_d and i_q (a flux map, as of Motor-CAD or FEM) nothing is identified, and as the motor of a simulation it needs a row for each point, with columns id, iq, psi_d and psi_q (flux_map in a scenario)"
    )]
    Matrix,
    #[error("the header has this name {count} times; rename or remove all but one")]
    Duplicate { count: usize },
    #[error("the columns {} could each be {channel}; map one of them to {channel}", columns(.headers))]
    Ambiguous { channel: &'static str, headers: Vec<String> },
    #[error(
        "the file holds {} logs, in {}; map the columns of one of them, as here those of the first", .names.len(), columns(.names)
    )]
    SeveralLogs { names: Vec<String>, first: Vec<(&'static str, String)> },
    #[error("this column would be both {first} and {second}; map each of them to a column of its own")]
    Shared { first: &'static str, second: &'static str },
    #[error(
        "{channel} is mapped to '{}', which the file does not have; it has {}{}",
        shorten(.header), columns(.present), did_you_mean(.nearest.as_ref().map(|name| format!("'{}'", shorten(name))).as_deref())
    )]
    MappedHeader { channel: &'static str, header: String, present: Vec<String>, nearest: Option<String> },
    #[error(
        "{} in the header is not a known unit of {channel}; state the unit if it is {}; else write its scale into a mapping file: {channel} = {{ column = {header:?}, scale = .. }}",
        quote(.text), choice(.units)
    )]
    HeaderUnit { channel: &'static str, text: String, header: String, units: Vec<&'static str> },
    #[error(
        "{} in the header is a share of a base value, which the log does not state; write into a mapping file {channel} = {{ column = {header:?}, scale = .. }}, where the scale is the base value in {si}{}",
        quote(.text), if *.whole == 1.0 { "" } else { " divided by 100" }
    )]
    Share { channel: &'static str, text: String, header: String, si: &'static str, whole: f64 },
    #[error(
        "{} in the header are counts of an encoder, and the log does not state how many a turn of the shaft has; write into a mapping file {channel} = {{ column = {header:?}, scale = .. }}, where the scale is {of_turn} times the number of pole pairs divided by the counts of a turn",
        quote(.text)
    )]
    Counts {
        channel: &'static str,
        text: String,
        header: String,
        /// A turn, in rad or rad/s.
        of_turn: &'static str,
    },
    #[error(
        "{} in the header may be rad/s, turns in a second or counts of an encoder in a second; state the unit (rad/s, rad/s-mech, Hz-elec or Hz-mech); of counts write into a mapping file {channel} = {{ column = {header:?}, scale = .. }}, where the scale is 6.28319 times the number of pole pairs divided by the counts of a turn",
        quote(.text)
    )]
    InverseSeconds { channel: &'static str, text: String, header: String },
    #[error(
        "the {what} is in {unit}, and converting it takes the number of pole pairs; state it, or state that the unit is {electrical_unit}"
    )]
    PolePairs { what: &'static str, channel: &'static str, unit: &'static str, electrical: &'static str, electrical_unit: &'static str },

    #[error("{}{}", speed_unit(*.of_shaft), speed_of_tool(.usual.as_ref()))]
    SpeedUnit {
        has_pole_pairs: bool,
        of_shaft: bool,
        /// What writes speeds of this name, and their unit there.
        usual: Option<(&'static str, Unit)>,
    },
    #[error("nothing states the unit of this electrical speed; state it: rad/s, rpm-elec or Hz-elec")]
    ElectricalSpeedUnit,
    #[error("{tool} writes this current in {}; state the unit, also if it is A", .unit.prose())]
    UnitOfTool { tool: &'static str, unit: Unit },
    #[error("this speed is in {}, and nothing states whether it is electrical or that of the shaft; state which", .electrical.prose().trim_start_matches("electrical "))]
    SpeedRotation { electrical: Unit, mechanical: Unit, has_pole_pairs: bool },
    #[error(
        "the times are whole numbers in steps of {step}, and nothing states their unit; state it; if they count the rows, write the time between these into a mapping file, as in sample_period = \"0.1 ms\""
    )]
    TimeUnit { step: u64 },
    #[error(
        "the times are rounded to {step}, and about {rows} rows have the same; do not remove them: write the time between rows into a mapping file, sample_period = \"{period}\""
    )]
    RoundedTime { rows: String, step: String, period: String },
    #[error(
        "the speed is computed from this angle, and nothing states whether it is electrical or that of the shaft; state its unit: rad, deg, rad-mech or deg-mech (with the number of pole pairs), or log the speed"
    )]
    AngleRotation,
    #[error("by its values this column is not the angle of the rotor; map theta_e to the angle, or log it")]
    NoAngle,

    // Characteristics
    #[error("{0}")]
    UnclearTable(UnclearTable),
    #[error(
        "the mapped columns make no table of a test bench: that has speed and voltage (open terminals), speed and current (shorted terminals), voltage and current (a direct one, at rest), or torque and iq or current; rms values and amplitudes have one sign"
    )]
    NoTable,
    #[error("'{}' is mapped to {column}, which a table of {table} has no place for; leave it out", shorten(.header))]
    UnusedColumn { column: &'static str, header: String, table: &'static str },
    #[error(
        "the unit of {channel} is stated, and of a table of a test bench only that of its speed can be; write it into the column's name"
    )]
    UnitOfTable { channel: String },
    #[error(
        "'{}' is a direct one by its name, as of a supply or behind a rectifier, and a table of speeds takes what alternates at the terminals; map that",
        shorten(.header)
    )]
    DirectQuantity { header: String },
    #[error(
        "by its name the torque '{}' is computed by the drive from its currents, with its own setting of psi_f or of the torque constant, and tells nothing of the motor; map the torque of a sensor, or this one if a sensor measured it", shorten(.header)
    )]
    ComputedTorque { header: String },
    #[error("{}", mapped_unit(column, header, .of_row.as_deref()))]
    MappedUnit {
        column: &'static str,
        header: String,
        /// What the row of units has.
        of_row: Option<String>,
    },
    #[error(
        "this is the curve of a motor that drives a load, by its columns {}: R_s, L_d, L_q and psi_f need dq voltages and currents with the speed (a log, or operating points), or tables with open and shorted terminals; log one of them, or i_q beside the torque, which tells psi_f alone; if the terminals were open or shorted, map speed and voltage, or speed and current",
        columns(.names)
    )]
    LoadCurve { names: Vec<String> },
    #[error("this table of speeds has more than {most} rows; leave a row for each speed")]
    LongCharacteristic { most: usize },

    // Data
    #[error(
        "ud, uq, id, iq and omega_e all have a mean near 0 and a standard deviation near 1: the file is standardized, so its values are not in V, A and rad/s; use the original data"
    )]
    Standardized,
    #[error(
        "{} are whole numbers up to {most:.0}, and nothing states their unit: digits of a converter, or thousandths; state the unit, or write what a digit is into a mapping file, as in {channel} = {{ column = {:?}, scale = .. }}",
        columns(.headers), .headers.first().map_or("", String::as_str)
    )]
    Digits { channel: &'static str, headers: Vec<String>, most: f64 },
    #[error(
        "no voltage, no current and no speed of this log is above {most}, as of values per unit; state in a mapping file their scale to V, A and rad/s, or state that they are in these units"
    )]
    PerUnit { most: f64 },
    #[error(
        "{channel} comes to {:.0} kV, which no drive has: its unit is another one; state it, or that it is in V", .most / 1000.0
    )]
    HighVoltage { channel: &'static str, most: f64 },
    #[error(
        "{} and {} are {} times the amplitude of {}, as of {}; write park = \"{}\" into a mapping file, which converts the voltages too; if the voltages are peak values, write scale = {} for the currents alone",
        .currents[0], .currents[1], significant(*.ratio, 3), list(&.headers.iter().map(|header| format!("'{}'", shorten(header))).collect::<Vec<_>>()),
        if *.park == "rms" { "rms values" } else { "a power-invariant transform" }, .park, significant(*.factor, 4)
    )]
    Scaling { currents: [&'static str; 2], ratio: f64, headers: Vec<String>, park: &'static str, factor: f64 },
    #[error(
        "the currents come to {} A beside voltages of {} V, as if {} and {} were in m{unit}; state their unit, also if it is {unit}", significant(*.amperes, 3), significant(*.volts, 3), .channels[0], .channels[1]
    )]
    Thousandths { channels: [&'static str; 2], amperes: f64, volts: f64, unit: &'static str },
    #[error(
        "the currents come to {} A and the voltages to {} V, as of a drive of megawatts, or as if they were in mA and mV; state their units, also if they are A and V", significant(*.amperes, 3), significant(*.volts, 3)
    )]
    Megawatts { amperes: f64, volts: f64 },
    #[error(
        "by its name this column is a share of the DC voltage and no voltage; write into a mapping file {channel} = {{ column = {header:?}, scale = .., times = \"u_dc\" }}, with the scale 2/3 for ODrive, 1/2 if 1 is half of u_dc, 0.57735 if u_dc / sqrt 3; if it is in V, state that"
    )]
    Modulation { channel: &'static str, header: String },
    #[error("by its values, {low} to {high}, this column is no duty cycle from 0 to 1; write into a mapping file {} = {{ column = {header:?}, scale = .., times = \"u_dc\" }}", .channel)]
    Duty { channel: &'static str, header: String, low: String, high: String },
    #[error(
        "the angle winds around at {turn}, not at 2 pi; write into a mapping file theta_e = {{ column = {header:?}, scale = {scale} }}{}",
        if *.is_exact { "" } else { ", with 6.28319 divided by the exact turn as scale" }
    )]
    AngleTurn { header: String, turn: String, scale: String, is_exact: bool },
    #[error(
        "phase quantities or the angle were sampled at different instants, and turn too far in between to be interpolated; log them at the same instants, or log dq quantities"
    )]
    ChannelsNotSimultaneous,
    #[error(
        "this column has a time of its own, {}, which is {apart} {}: its rows are not simultaneous with the others; export all channels with one sample time and one time",
        quote(.own), quote(.time)
    )]
    OwnTimes { own: String, time: String, apart: String },
    #[error(
        "at no instant of {base} does every other channel have values nearby; log the channels at the same instants, or over the same time"
    )]
    NoCommonInstants { base: &'static str },
    #[error("the columns have different lengths and no times to align them: {}; add a time to each of them, or log equal lengths", list(.lengths))]
    Lengths { lengths: Vec<String> },
    #[error("there is no column '{}' that names the motors; the columns are {}", shorten(.by), list(&.names.iter().take(MOST_NAMES).collect::<Vec<_>>()))]
    NoMotors { by: String, names: Vec<String> },
    #[error("the column that names the motors holds neither texts nor whole numbers; name the motors by one of them")]
    MotorNames,
    #[error("{0}")]
    Log(fluxfit::error::Error),

    // Containers
    #[error("this {format} file cannot be read: {fault}")]
    Container { format: &'static str, fault: String },
    #[error("this {format} file has no column of two or more numbers; export each quantity of the log as a column of numbers")]
    NoNumbers { format: &'static str },
    #[error("{}; write a row for each instant, with one number in each cell", are_lists(.names))]
    Lists { names: Vec<String> },
    #[error("this file has more than {most} columns; export only those of the log")]
    ManyColumns { most: usize },
    #[error("these columns were not sampled at the same instants and cannot be read together")]
    SeveralGroups,
    #[error("{} is a {} object, which only MATLAB can read; {}", quote(.name), shorten(.class), object_remedy(.name, .class))]
    MatObject { name: String, class: String },
    #[error("this HDF5 file has {what}, which is not supported; write it with libver='earliest', or export the log as Parquet")]
    NewerHdf5 { what: &'static str },
    #[error("the numbers of this array lie in another file; write them into this one")]
    ExternalHdf5,
    #[error("this HDF5 file is compressed by filter {identifier}, which is not supported; use gzip, or export the log as Parquet")]
    Hdf5Filter { identifier: u16 },
    #[error("this Parquet file has {rows} rows of hardly anything but constants, which is no log; export the rows in which the drive runs")]
    ConstantRows { rows: u64 },
    #[error("this Parquet file is compressed by {codec}, which is not supported; use zstd, gzip, lz4 or snappy")]
    ParquetCodec { codec: String },
    #[error("this HDF5 file has chunks of more than {most} MiB; write it with smaller chunks, or export the log as Parquet")]
    LargeChunks { most: u64 },
    #[error("this is MDF 3 or older, which is not supported; convert it to MDF 4, or export the log as Parquet or CSV")]
    OldMdf,
    #[cfg(not(feature = "mdf4"))]
    #[error("this build of fluxfit does not read MDF 4; build it with the feature mdf4, or export the log as Parquet or CSV")]
    NoMdf,

    // Other logs of text
    #[error("this is JSON, but no table: {reason}; write an object for each row, as in {{\"t\": 0.0, \"ud\": 1.5}}")]
    Json { reason: String },
    #[error("a record of this JSON file has more than {most} MiB; write an object for each row")]
    LongRecord { most: usize },
    #[error("this LabVIEW measurement file cannot be read: {reason}; export it again, with one X column")]
    Lvm { reason: &'static str },
    #[error("this is a candump log, whose frames have no names; state the DBC that names their signals")]
    NoDbc,
    #[error(
        "this is a candump log without time stamps, and a log needs the instant of each frame; record it again with them (candump -l, or -t a), and state the DBC that names its signals"
    )]
    NoFrameTimes,
    #[error("the DBC is damaged, or not one: {reason}")]
    Dbc { reason: String },
    #[error("{} is no frame of candump; remove the line", quote(.text))]
    Frame { text: String },
    #[error("the DBC names no message that the log has twice or more; state that of this bus")]
    NoMessages,
    #[error(
        "this is an export of an oscilloscope of Yokogawa, whose samples have no times; delete the lines above the samples but TraceName, write t for that word, and add the times HOffset + k HResolution in s as first cells; of voltages of a motor that is turned with open terminals, write frequency and rms voltage of each speed into a table with the columns 'f [Hz]' and 'U_ll_rms [V]' (of a phase, 'U_phase_rms [V]')"
    )]
    Yokogawa,
    #[error(
        "this is {what}; convert it to candump's format or to MDF 4 (python-can: python -m can.logconvert IN OUT.log), and state the DBC that names its signals"
    )]
    CanLog { what: &'static str },

    // What is stated about a log
    #[error(
        "{} is not a channel of a log; the channels are {}, and optionally {}{}",
        quote(.name), list(.needed), list(.optional), did_you_mean(*.nearest)
    )]
    Channel { name: String, needed: Vec<&'static str>, optional: Vec<&'static str>, nearest: Option<&'static str> },
    #[error("{} is not a unit of {channel}; it can be {}", quote(.unit), choice(.allowed))]
    Unit { channel: &'static str, unit: String, allowed: Vec<&'static str> },
    #[error("{channel} is given twice; give it once")]
    Twice { channel: &'static str },
    #[error("{channel} is no voltage, so it is no share of u_dc; remove this")]
    NoShare { channel: &'static str },
    #[error("the mapping says that {channel} is a share of u_dc, and the log has no u_dc; map u_dc to the DC voltage")]
    NoBus { channel: &'static str },
    #[error("the number of pole pairs is 0; it must be at least 1")]
    ZeroPolePairs,
}

impl Problem {
    fn kind(&self) -> FileErrorKind {
        match self {
            Self::Json { .. } | Self::LongRecord { .. } | Self::Lvm { .. } | Self::Dbc { .. } | Self::Frame { .. } => FileErrorKind::Format,
            Self::NoDbc | Self::NoMessages => FileErrorKind::Request,
            Self::CanLog { .. } | Self::NoFrameTimes | Self::Yokogawa => FileErrorKind::Unsupported,
            Self::OpenTerminals { .. } | Self::Trace { .. } | Self::Matrix | Self::PowerMeter { .. } | Self::Polar { .. } => {
                FileErrorKind::Columns
            }
            Self::Gzip { .. } | Self::Document { .. } | Self::Npz | Self::NoRows => FileErrorKind::Format,
            Self::ConstantRows { .. } | Self::Container { .. } | Self::NoNumbers { .. } | Self::Lists { .. } | Self::ManyColumns { .. } => {
                FileErrorKind::Format
            }
            Self::EmptyCell | Self::EmptyColumn | Self::Thousands { .. } | Self::ClockTime { .. } | Self::Instant { .. } => {
                FileErrorKind::Value
            }
            Self::DecimalMarks { .. } | Self::OtherMark { .. } | Self::UnclearComma => FileErrorKind::Value,
            Self::Missing { .. }
            | Self::ARowPerValue { .. }
            | Self::Reference { .. }
            | Self::NotALog { .. }
            | Self::PhaseRms
            | Self::SeveralLogs { .. }
            | Self::Duplicate { .. } => FileErrorKind::Columns,
            Self::Ambiguous { .. } | Self::Shared { .. } | Self::MappedHeader { .. } | Self::NoAngle | Self::NotLive => {
                FileErrorKind::Columns
            }
            Self::UnclearTable(_)
            | Self::LoadCurve { .. }
            | Self::NoTable
            | Self::DirectQuantity { .. }
            | Self::ComputedTorque { .. }
            | Self::UnusedColumn { .. }
            | Self::MappedUnit { .. } => FileErrorKind::Columns,
            Self::HeaderUnit { .. }
            | Self::UnitOfTable { .. }
            | Self::Share { .. }
            | Self::PolePairs { .. }
            | Self::SpeedUnit { .. }
            | Self::ElectricalSpeedUnit
            | Self::UnitOfTool { .. }
            | Self::SpeedRotation { .. }
            | Self::AngleRotation
            | Self::Counts { .. }
            | Self::InverseSeconds { .. }
            | Self::TimeUnit { .. } => FileErrorKind::Unit,
            Self::RoundedTime { .. } => FileErrorKind::Data,
            Self::Rms { .. } => FileErrorKind::Unit,
            Self::Digits { .. } | Self::PerUnit { .. } | Self::HighVoltage { .. } | Self::Thousandths { .. } => FileErrorKind::Unit,
            Self::Scaling { .. } | Self::Megawatts { .. } | Self::Modulation { .. } => FileErrorKind::Unit,
            Self::Duty { .. } | Self::AngleTurn { .. } => FileErrorKind::Unit,
            Self::Standardized | Self::ChannelsNotSimultaneous | Self::NoCommonInstants { .. } | Self::OwnTimes { .. } => {
                FileErrorKind::Data
            }
            Self::NoMotors { .. } | Self::MotorNames => FileErrorKind::Columns,
            Self::Lengths { .. } | Self::SeveralGroups | Self::Log(_) | Self::LongCharacteristic { .. } => FileErrorKind::Data,
            Self::ExternalHdf5 | Self::MatObject { .. } | Self::NewerHdf5 { .. } | Self::Hdf5Filter { .. } => FileErrorKind::Unsupported,
            Self::ParquetCodec { .. } | Self::LargeChunks { .. } | Self::OldMdf => FileErrorKind::Unsupported,
            #[cfg(not(feature = "mdf4"))]
            Self::NoMdf => FileErrorKind::Unsupported,
            Self::Channel { .. } | Self::Unit { .. } | Self::Twice { .. } => FileErrorKind::Request,
            Self::NoShare { .. } | Self::NoBus { .. } | Self::ZeroPolePairs => FileErrorKind::Request,
        }
    }

    /// What the user can state to resolve it.
    fn advice(&self) -> Vec<Advice> {
        let map = |channels: &[&'static str]| vec![Advice::MapColumns(channels.iter().map(|channel| (*channel, None)).collect())];
        match self {
            Self::SeveralLogs { first, .. } => {
                vec![Advice::MapColumns(first.iter().map(|(channel, header)| (*channel, Some(header.clone()))).collect())]
            }
            Self::Missing { missing, present, proposals, .. } if are_not_in_it(missing, present, proposals) => {
                let of_table = may_be_table(missing, present) && !has_d_alone(missing);
                if of_table { map(&["speed", "voltage", "current", "torque"]) } else { Vec::new() }
            }
            Self::Missing { proposals, line_to_line, .. } if proposals.is_empty() && *line_to_line != LineToLine::default() => Vec::new(),
            Self::Missing { modulations, proposals, .. } if proposals.is_empty() && !modulations.is_empty() => {
                modulations.iter().take(1).map(|(channel, _)| Advice::ScaleInMapping { channel, scale: MODULATION.to_owned() }).collect()
            }
            Self::Missing { missing, proposals, .. } if proposals.is_empty() => map(&missing[..missing.len().min(1)]),
            Self::Missing { proposals, rms, speed, .. } => {
                let columns = proposals.iter().map(|(channel, header)| (*channel, Some(header.clone()))).collect();
                let units: Vec<_> = rms.iter().copied().chain(speed.map(|(channel, unit)| (channel, unit.name()))).collect();
                vec![if units.is_empty() { Advice::MapColumns(columns) } else { Advice::MapInUnits { columns, units } }]
            }
            Self::PowerMeter { names } => {
                let header = |place: usize| names.get(place).cloned();
                let [speed, voltage, current] = [("speed", None), ("voltage", header(0)), ("current", header(1))];
                let pairs = [[speed.clone(), voltage.clone()], [speed, current.clone()], [voltage, current]];
                pairs.map(|pair| Advice::MapColumns(pair.to_vec())).to_vec()
            }
            Self::Rms { columns } => columns.iter().map(|(channel, _, unit)| Advice::StateUnit { channel, unit: Some(unit) }).collect(),
            Self::Reference { channel } | Self::Ambiguous { channel, .. } => map(&[channel]),
            Self::Shared { first, second } => map(&[first, second]),
            Self::MappedHeader { channel, nearest: Some(header), .. } => vec![Advice::MapColumns(vec![(channel, Some(header.clone()))])],
            Self::NotALog { advice, .. } => advice.iter().cloned().collect(),
            Self::HeaderUnit { channel, .. } | Self::InverseSeconds { channel, .. } => vec![Advice::StateUnit { channel, unit: None }],
            Self::UnclearTable(unclear) => unclear.advice(),
            Self::MappedUnit { column: "speed", .. } => vec![Advice::StateUnit { channel: "speed", unit: None }],
            Self::PolePairs { channel, electrical, .. } => {
                vec![Advice::StatePolePairs, Advice::StateUnit { channel, unit: Some(electrical) }]
            }
            Self::NoDbc => vec![Advice::StateDbc],
            Self::NoBus { .. } => map(&["u_dc"]),
            Self::SpeedRotation { electrical, mechanical, has_pole_pairs } => vec![Advice::StateRotation {
                channel: "omega_e",
                electrical: electrical.name(),
                mechanical: mechanical.name(),
                has_pole_pairs: *has_pole_pairs,
            }],
            // The usual unit of either.
            Self::SpeedUnit { has_pole_pairs, of_shaft, usual } if *of_shaft || usual.is_some() => {
                let unit = usual.map_or(Unit::RpmMechanical, |(_, unit)| unit);
                let first = Advice::StateUnit { channel: "omega_e", unit: Some(unit.name()) };
                let pole_pairs = (!has_pole_pairs).then_some(Advice::StatePolePairs);
                let electrical = Advice::StateUnit { channel: "omega_e", unit: Some(Unit::RadianPerSecond.name()) };
                let first = Advice::Together(std::iter::once(first).chain(pole_pairs).collect());
                std::iter::once(first).chain(Some(electrical).filter(|_| !of_shaft)).collect()
            }
            // Which is right is not known.
            Self::ElectricalSpeedUnit => vec![Advice::StateUnit { channel: "omega_e", unit: Some("UNIT") }],
            Self::UnitOfTool { unit, .. } => ["id", "iq"].map(|channel| Advice::StateUnit { channel, unit: Some(unit.name()) }).to_vec(),
            Self::SpeedUnit { has_pole_pairs, .. } => vec![Advice::StateRotation {
                channel: "omega_e",
                electrical: Unit::RadianPerSecond.name(),
                mechanical: Unit::RpmMechanical.name(),
                has_pole_pairs: *has_pole_pairs,
            }],
            Self::Digits { channel, .. } => vec![Advice::StateUnit { channel, unit: None }],
            Self::HighVoltage { channel, .. } => vec![Advice::StateUnit { channel, unit: Some("mV") }],
            Self::Thousandths { channels, unit, .. } => {
                let unit = Some(if *unit == "A" { "mA" } else { "mV" });
                channels.iter().map(|channel| Advice::StateUnit { channel, unit }).collect()
            }
            Self::Megawatts { .. } => {
                // Which is right is not known.
                ["id", "iq", "ud", "uq"].map(|channel| Advice::StateUnit { channel, unit: Some("UNIT") }).to_vec()
            }
            Self::Modulation { channel, .. } => vec![Advice::StateUnit { channel, unit: Some("V") }],
            Self::AngleRotation => {
                let unit = |unit: Unit| Advice::StateUnit { channel: "theta_e", unit: Some(unit.name()) };
                vec![unit(Unit::Radian), Advice::Together(vec![unit(Unit::RadianMechanical), Advice::StatePolePairs])]
            }
            Self::TimeUnit { .. } => vec![Advice::StateUnit { channel: "t", unit: None }],
            Self::AngleTurn { scale, is_exact: true, .. } => vec![Advice::ScaleInMapping { channel: "theta_e", scale: scale.clone() }],
            Self::NoAngle => map(&["theta_e"]),
            Self::ZeroPolePairs => vec![Advice::StatePolePairs],
            _ => Vec::new(),
        }
    }
}

impl From<Problem> for FileError {
    fn from(problem: Problem) -> Self {
        let advice = problem.advice();
        Self::new(problem.kind(), problem).with_advice(advice)
    }
}

/// What to type in MATLAB.
fn object_remedy(name: &str, class: &str) -> String {
    let name = shorten(name);
    match class {
        "table" => format!("save it as text with writetable({name}, 'log.csv')"),
        "timetable" => format!(
            "save it as text with {name}.t = seconds({name}.Properties.RowTimes - {name}.Properties.RowTimes(1)); writetable(timetable2table({name}, 'ConvertRowTimes', false), 'log.csv')"
        ),
        "Simulink.SimulationData.Dataset" | "Simulink.SimulationOutput" => {
            format!("save it as text with writetimetable(extractTimetable({name}), 'log.csv')")
        }
        "timeseries" => format!("save its numbers with s = struct('Time', {name}.Time, 'Data', {name}.Data); save('log.mat', 's')"),
        _ => "save its numbers as vectors, or as a structure of vectors".to_owned(),
    }
}

fn mapped_unit(column: &str, header: &str, of_row: Option<&str>) -> String {
    let (state, header) = (if column == "speed" { ", or state it" } else { "" }, shorten(header));
    match of_row {
        None => format!("the name '{header}' states another unit than one of {column}, or a constant; write its unit into the name{state}"),
        Some(unit) => format!(
            "'{header}' is mapped to {column}, but the row of units has {} below it, which is not read as a unit of {column}; write the unit there{state}",
            quote(unit)
        ),
    }
}

fn speed_unit(of_shaft: bool) -> &'static str {
    if of_shaft {
        "by its name this is the speed of the shaft, and nothing states its unit; state it: rpm-mech, rad/s-mech or Hz-mech"
    } else {
        "nothing states the unit of this speed, or whether it is the electrical one; state it: rad/s is electrical, and rad/s-mech, rpm-mech and Hz-mech (turns a second) are those of the shaft"
    }
}

/// What is to be said of a speed that a known tool writes.
fn speed_of_tool(usual: Option<&(&str, Unit)>) -> String {
    usual.map_or_else(String::new, |(tool, unit)| {
        format!(
            "; {tool} writes {}",
            if *unit == Unit::HertzMechanical { "turns of the shaft a second, Hz-mech" } else { "rad/s of the shaft, rad/s-mech" }
        )
    })
}

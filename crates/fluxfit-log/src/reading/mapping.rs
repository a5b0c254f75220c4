//! `MAPPING.toml`: which columns of a kind of log are which channels, stated once for all of them.
//!
//! ```toml
//! pole_pairs = 4
//! sample_period = "0.1 ms"        # in place of a time column
//! park = "amplitude-invariant"    # or "power-invariant", "rms": scaling of the dq vectors
//!
//! [columns]
//! t = "time_ms"
//! # without a unit, that of the header or SI; scale and sign are factors besides the unit
//! ud = { column = "motor_vd", unit = "mV", scale = 2.0, sign = -1 }
//! # a share of the DC voltage in the same row
//! uq = { column = "duty_q", scale = 0.577, times = "u_dc" }
//! ```

use crate::{channel::Channel, problem::Problem};
use fluxfit_files::{
    FileError, Problem as FileProblem, input,
    toml_table::{Document, Entry, Shape},
};
use fluxfit_units::{Dimension, unit::Unit};
use std::path::Path;

/// The content of a mapping file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mapping {
    /// Number of pole pairs.
    pub pole_pairs: Option<u32>,
    /// Time between rows, s.
    pub sample_period: Option<f64>,
    /// Scaling of the dq vectors and of those of the stator's frame.
    pub park: Park,
    pub(crate) columns: Vec<MappedColumn>,
}

/// The entry of one column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MappedColumn {
    pub(crate) channel: Channel,
    pub(crate) header: Option<String>,
    pub(crate) unit: Option<Unit>,
    /// Scale times sign.
    pub(crate) factor: f64,
    /// Its values are shares of the DC voltage of their row.
    pub(crate) is_times_u_dc: bool,
}

/// Scalings of the Clarke and Park transforms.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Park {
    /// The length of a vector is the peak value of the phases. fluxfit uses this scaling.
    #[default]
    Amplitude,
    /// sqrt(3/2) times that, so that the power is `u_d i_d + u_q i_q`.
    Power,
    /// 1/sqrt(2) times that: the root mean square of the phases.
    Rms,
}

impl Park {
    /// Name in a mapping file.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude-invariant",
            Self::Power => "power-invariant",
            Self::Rms => "rms",
        }
    }

    /// The factor that converts a vector to amplitude-invariant scaling.
    pub(crate) fn factor(self) -> f64 {
        match self {
            Self::Amplitude => 1.0,
            Self::Power => (2.0_f64 / 3.0).sqrt(),
            Self::Rms => std::f64::consts::SQRT_2,
        }
    }
}

/// Keys of a column.
const COLUMN_KEYS: &[&str] = &["column", "unit", "scale", "sign", "times"];

const EXAMPLE: &str = "ud = \"motor_vd\" or ud = { column = \"motor_vd\", unit = \"mV\" }";

const SHAPE: Shape = Shape {
    noun: "a mapping file",
    keys: &["pole_pairs", "sample_period", "park"],
    tables: &[(
        "columns",
        &[
            "t",
            "ud",
            "uq",
            "id",
            "iq",
            "omega_e",
            "theta_e",
            "u_dc",
            "temperature",
            "ua",
            "ub",
            "uc",
            "ia",
            "ib",
            "ic",
            "ualpha",
            "ubeta",
            "ialpha",
            "ibeta",
            "run",
        ],
    )],
};

/// Reads a mapping file; the path `-` is standard input.
///
/// # Errors
/// If the file cannot be read, is not TOML, or has an unknown key or a value of the wrong kind.
pub fn read_mapping(path: &Path) -> Result<Mapping, FileError> {
    Mapping::parse(&input::name(path), &input::read(path)?)
}

impl Mapping {
    /// Reads a mapping file from memory; `name` is the file's name in messages. An empty file is an empty mapping.
    ///
    /// # Errors
    /// As [`read_mapping`].
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, FileError> {
        let parsed = match input::text(bytes, "TOML") {
            Ok(text) => parse(text),
            Err(_) if bytes.trim_ascii().is_empty() => Ok(Self::default()),
            Err(error) => Err(error),
        };
        parsed.map_err(|error| error.in_file(name))
    }
}

fn parse(text: &str) -> Result<Mapping, FileError> {
    let document = Document::parse(text, &SHAPE)?;
    let root = document.root();
    let parks = [Park::Amplitude, Park::Power, Park::Rms].map(|park| (park.name(), park));
    let sample_period = root.get("sample_period").map(|entry| match entry.quantity(Dimension::Time)? {
        period if period > 0.0 => Ok(period),
        _ => Err(entry.out_of_range("a time above zero")),
    });
    Ok(Mapping {
        pole_pairs: root.get("pole_pairs").map(|entry| entry.whole(1, "a whole number above zero")).transpose()?,
        sample_period: sample_period.transpose()?,
        park: root.get("park").map(|entry| entry.word(&parks)).transpose()?.unwrap_or_default(),
        columns: Channel::all().filter_map(|channel| column(&document, channel).transpose()).collect::<Result<_, _>>()?,
    })
}

fn column(document: &Document<'_>, channel: Channel) -> Result<Option<MappedColumn>, FileError> {
    let Some(entry) = document.table("columns").get(channel.name()) else { return Ok(None) };
    let named = |entry: Entry<'_>| match entry.text()?.trim() {
        "" => Err(entry.refuse(FileProblem::Value { wanted: "the name of a column: fill it in, or remove the line".to_owned() })),
        header => Ok(header.to_owned()),
    };
    if entry.text().is_ok() {
        let header = named(entry)?;
        return Ok(Some(MappedColumn { channel, header: Some(header), unit: None, factor: 1.0, is_times_u_dc: false }));
    }
    let table = entry.table(COLUMN_KEYS, "the name of a column, or a table with its name and unit", EXAMPLE)?;
    let unit = table.get("unit").map(|entry| {
        let text = entry.text()?;
        let allowed = || channel.units().map(Unit::name).collect();
        let unknown = || Problem::Unit { channel: channel.name(), unit: text.to_owned(), allowed: allowed() };
        let found = Unit::from_name(text, channel.dimension()).filter(|found| channel.units().any(|allowed| allowed == *found));
        found.ok_or_else(|| entry.refuse(unknown()))
    });
    let scale = table.get("scale").map(|entry| match entry.quantity(Dimension::Ratio)? {
        scale if scale != 0.0 => Ok(scale),
        _ => Err(entry.out_of_range("a number other than zero")),
    });
    let sign = table.get("sign").map(|entry| entry.word(&[("1", 1.0), ("-1", -1.0)])).transpose()?.unwrap_or(1.0);
    let header = table.get("column").map(named).transpose()?;
    let times = table.get("times").map(|entry| match channel.dimension() {
        Dimension::Voltage if channel != Channel::UDc => entry.word(&[("u_dc", true)]),
        _ => Err(entry.refuse(Problem::NoShare { channel: channel.name() })),
    });
    let (unit, factor) = (unit.transpose()?, scale.transpose()?.unwrap_or(1.0) * sign);
    Ok(Some(MappedColumn { channel, header, unit, factor, is_times_u_dc: times.transpose()?.unwrap_or(false) }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Result<Mapping, String> {
        Mapping::parse("map.toml", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_mapping_names_columns_units_and_factors() {
        let text = "pole_pairs = 4\nsample_period = \"0.1 ms\"\npark = \"power-invariant\"\n[columns]\n\
                    iq = { column = \"Iq [A]\", scale = 0.5, sign = -1 }\nt = { unit = \"ms\" }\nud = \"vd\"\n";
        let mapping = read(text).unwrap();
        assert_eq!((mapping.pole_pairs, mapping.sample_period, mapping.park), (Some(4), Some(1e-4), Park::Power));
        let expected = [
            MappedColumn { channel: Channel::T, header: None, unit: Some(Unit::Millisecond), factor: 1.0, is_times_u_dc: false },
            MappedColumn { channel: Channel::Ud, header: Some("vd".into()), unit: None, factor: 1.0, is_times_u_dc: false },
            MappedColumn { channel: Channel::Iq, header: Some("Iq [A]".into()), unit: None, factor: -0.5, is_times_u_dc: false },
        ];
        assert_eq!(mapping.columns, expected);
        assert_eq!(read(""), Ok(Mapping::default()));
        // A power-invariant vector is sqrt(3/2) times as long, an rms one sqrt(1/2) times.
        assert!((Park::Power.factor() * 1.5_f64.sqrt() - 1.0).abs() < 1e-15 && (Park::Rms.factor() * 0.5_f64.sqrt() - 1.0).abs() < 1e-15);
    }

    /// A name that docs/log.md and `--map` know and a mapping file refuses would leave such a log without any that describes it.
    #[test]
    fn every_channel_can_be_mapped_with_its_unit() {
        for channel in Channel::all() {
            for unit in channel.units() {
                let text = format!("[columns]\n{} = {{ column = \"x\", unit = \"{}\" }}", channel.name(), unit.name());
                let mapping = read(&text).unwrap();
                assert_eq!((mapping.columns[0].channel, mapping.columns[0].unit), (channel, Some(unit)), "{text}");
            }
        }
    }

    #[test]
    fn voltages_may_be_shares_of_the_dc_voltage() {
        let mapping = read("[columns]\nud = { column = \"m\", scale = 0.5, times = \"u_dc\" }").unwrap();
        assert_eq!((mapping.columns[0].factor, mapping.columns[0].is_times_u_dc), (0.5, true));
        let sentence = "map.toml, line 2, key 'times': id is no voltage, so it is no share of u_dc; remove this";
        assert_eq!(read("[columns]\nid = { times = \"u_dc\" }"), Err(sentence.to_owned()));
    }

    #[test]
    fn errors_name_line_and_key() {
        let cases = [
            ("[columns]\nud = { unit = \"A\" }", "line 2, key 'unit': \"A\" is not a unit of ud; it can be V, mV, kV or Vrms"),
            ("[columns]\nud = { scale = 0 }", "line 2, key 'scale': \"0\" is out of range; it must be a number other than zero"),
            ("sample_period = 0", "line 1, key 'sample_period': \"0\" is out of range; it must be a time above zero"),
            (
                "park = \"peak\"",
                "line 1, key 'park': \"peak\" is not one of the values; it can be amplitude-invariant, power-invariant or rms",
            ),
            (
                "[columns]\nid = 3",
                "line 2, key 'id': this is not the name of a column, or a table with its name and unit, \
                 as in ud = \"motor_vd\" or ud = { column = \"motor_vd\", unit = \"mV\" }; correct it",
            ),
            (
                "[columns]\nid = { name = \"x\" }",
                "line 2, key 'name': this key is not known; the name of a column, or a table with its name and unit can hold column, unit, scale, sign and times",
            ),
        ];
        for (text, sentence) in cases {
            assert_eq!(read(text), Err(format!("map.toml, {sentence}")), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(text in "\\PC*|(\\[columns\\]\nud = |column = |scale=|[0-9.\"'\\[\\]{}= \n]){0,20}") {
            if let Err(sentence) = read(&text) {
                prop_assert_eq!(sentence.lines().count(), 1);
            }
        }
    }
}

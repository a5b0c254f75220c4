//! What the user states about a log.

use super::{mapping::Mapping, selection::MOST_ROWS};
use crate::{argument::wrong_unit, channel::Channel, problem::Problem};
use fluxfit_files::FileError;
use fluxfit_units::Unit;

/// What is known about a log besides its file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LogOptions {
    /// Channels under other names in the file: canonical name (or `omega`, `theta`) and header, as from
    /// [`parse_map`](crate::parse_map).
    pub map: Vec<(String, String)>,
    /// Units of channels whose header does not state them: canonical name and unit, as from [`parse_unit`](crate::parse_unit).
    pub units: Vec<(String, Unit)>,
    /// Number of pole pairs, which converts a mechanical speed or angle.
    pub pole_pairs: Option<u32>,
    /// The text of the DBC that names the signals of a log of CAN frames.
    pub dbc: Option<String>,
    /// A mapping file; the three fields above override it.
    pub mapping: Mapping,
    /// Whether all rows of a long log are used, as where a motor is followed through them; else the half a million that differ most.
    pub all_rows: bool,
}

/// The options with their names resolved to channels, and mapping file and arguments merged.
#[derive(Clone)]
pub(super) struct ResolvedOptions {
    headers: Vec<(Channel, String)>,
    units: Vec<(Channel, Unit)>,
    factors: Vec<(Channel, f64)>,
    /// What the scaling of the dq transform is.
    of_park: Vec<(Channel, f64)>,
    /// Channels whose column a mapping file names: who writes one sees the units.
    pub(super) of_mapping_file: Vec<Channel>,
    /// Channels whose values are shares of the DC voltage of their row.
    pub(super) shares_of_bus: Vec<Channel>,
    /// Number of pole pairs.
    pub(super) pole_pairs: Option<u32>,
    /// Time between rows, s, where no column has the time.
    pub(super) sample_period: Option<f64>,
    /// The text of a DBC.
    pub(super) dbc: Option<String>,
    /// Maximum number of rows that are used of a longer log.
    pub(super) most_rows: usize,
}

impl ResolvedOptions {
    /// Resolves names.
    ///
    /// # Errors
    /// If a name is not a channel or is given twice, a unit does not fit its channel, or the number of pole pairs is zero.
    pub(super) fn resolve(options: &LogOptions) -> Result<Self, FileError> {
        if options.pole_pairs == Some(0) {
            return Err(Problem::ZeroPolePairs.into());
        }
        let mut headers: Vec<(Channel, String)> = Vec::new();
        for (name, header) in &options.map {
            let channel = Channel::from_name(name)?;
            if headers.iter().any(|(earlier, _)| *earlier == channel) {
                return Err(Problem::Twice { channel: channel.name() }.into());
            }
            headers.push((channel, header.trim().to_owned()));
        }
        let mut units: Vec<(Channel, Unit)> = Vec::new();
        for (name, unit) in &options.units {
            let channel = Channel::from_name(name)?;
            if channel.units().all(|allowed| allowed != *unit) {
                return Err(wrong_unit(channel, unit.name()));
            }
            if units.iter().any(|(earlier, _)| *earlier == channel) {
                return Err(Problem::Twice { channel: channel.name() }.into());
            }
            units.push((channel, *unit));
        }
        let Mapping { pole_pairs, sample_period, park, columns } = &options.mapping;
        // The Clarke transform has the scaling; the Park transform only turns.
        let vectors =
            [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::UAlpha, Channel::UBeta, Channel::IAlpha, Channel::IBeta];
        let of_park = vectors.map(|channel| (channel, park.factor())).to_vec();
        let mut factors: Vec<(Channel, f64)> = Vec::new();
        let mut of_mapping_file = Vec::new();
        for column in columns {
            if let Some(header) = column.header.clone().filter(|_| headers.iter().all(|(stated, _)| *stated != column.channel)) {
                headers.push((column.channel, header));
                of_mapping_file.push(column.channel);
            }
            if let Some(unit) = column.unit.filter(|_| units.iter().all(|(stated, _)| *stated != column.channel)) {
                units.push((column.channel, unit));
            }
            factors.push((column.channel, column.factor));
        }
        let pole_pairs = options.pole_pairs.or(*pole_pairs);
        let shares_of_bus = columns.iter().filter(|column| column.is_times_u_dc).map(|column| column.channel).collect();
        Ok(Self {
            headers,
            units,
            factors,
            of_park,
            of_mapping_file,
            shares_of_bus,
            pole_pairs,
            sample_period: *sample_period,
            dbc: options.dbc.clone(),
            most_rows: if options.all_rows { usize::MAX } else { MOST_ROWS },
        })
    }

    /// The header that a channel is mapped to.
    pub(super) fn header(&self, channel: Channel) -> Option<&str> {
        self.headers.iter().find(|(stated, _)| *stated == channel).map(|(_, header)| header.as_str())
    }

    /// Whether the times are those of rows that are equally far apart: a stated period has priority over a time that is not mapped.
    pub(super) fn counts_rows(&self) -> bool {
        self.sample_period.is_some() && self.header(Channel::T).is_none()
    }

    /// Whether any channel is mapped.
    pub(super) fn has_headers(&self) -> bool {
        !self.headers.is_empty()
    }

    /// The unit stated for a channel.
    pub(super) fn unit(&self, channel: Channel) -> Option<Unit> {
        self.units.iter().find(|(stated, _)| *stated == channel).map(|(_, unit)| *unit)
    }

    /// The factor besides the unit: scale, sign and scaling of the dq transform.
    pub(super) fn factor(&self, channel: Channel) -> f64 {
        self.scale(channel) * product(&self.of_park, channel)
    }

    /// Scale and sign alone, as a mapping file states them of a column.
    pub(super) fn scale(&self, channel: Channel) -> f64 {
        product(&self.factors, channel)
    }
}

/// The product of the factors of a channel.
fn product(factors: &[(Channel, f64)], channel: Channel) -> f64 {
    factors.iter().filter(|(stated, _)| *stated == channel).map(|(_, factor)| factor).product()
}

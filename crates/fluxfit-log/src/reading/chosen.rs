//! A column of the file that is read: its channel, its unit and its factor.

use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel,
    instant::Instants,
};
use fluxfit_files::FileError;
use fluxfit_units::{Unit, significant, wording::shorten};

/// A column of the file that is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ChosenColumn {
    pub(super) channel: Channel,
    /// Index in the table, from 0.
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) unit: Unit,
    pub(super) pole_pairs: u32,
    /// Factor besides the unit.
    pub(super) scale: f64,
    /// The user did not ask for it: if it cannot be read it is left out, and the log is read without it.
    pub(super) is_optional: bool,
    /// The file or the user states the unit.
    pub(super) is_unit_stated: bool,
    /// The file or the user writes the unit or a scale: SI does not only follow from the name of the column.
    pub(super) is_unit_written: bool,
    /// Its values are shares of the DC voltage of their row.
    pub(super) is_share: bool,
    /// It was found by one of the usual names of its channel, not by the channel's own.
    pub(super) is_alias: bool,
    /// Its cells are instants, which the table reads in s.
    pub(super) instants: Option<Instants>,
}

impl ChosenColumn {
    /// A column in SI by its name alone.
    pub(super) fn of(channel: Channel, index: usize, head: &ColumnHead) -> Self {
        Self {
            channel,
            index,
            header: head.name.clone(),
            unit: channel.unit(),
            pole_pairs: 1,
            scale: 1.0,
            is_optional: false,
            is_unit_stated: false,
            is_unit_written: false,
            is_share: false,
            is_alias: false,
            instants: None,
        }
    }

    /// Converts values of the file to SI units, in place.
    pub(super) fn to_si(&self, values: &mut [f64]) {
        self.unit.to_si(values, self.pole_pairs);
        if self.scale != 1.0 {
            values.iter_mut().for_each(|value| *value *= self.scale);
        }
    }

    /// What the value 1 of the file is in SI units.
    pub(super) fn factor(&self) -> f64 {
        let mut one = [1.0];
        self.to_si(&mut one);
        one[0]
    }

    /// The column as the table reads it.
    pub(super) fn wanted(&self) -> WantedColumn {
        let is_time = self.channel == Channel::T;
        let (header, instants) = (self.header.clone(), self.instants.clone());
        WantedColumn { index: self.index, header, is_time, is_optional: self.is_optional, instants }
    }
}

/// What was read as what: `t = 'time_s' (s), ud = ..`.
pub(super) fn describe(chosen: &[ChosenColumn]) -> String {
    let describe_one = |column: &ChosenColumn| {
        let factor = if column.scale == 1.0 { String::new() } else { format!(", times {}", significant(column.scale, 6)) };
        format!("{} = '{}' ({}{factor})", column.channel.name(), shorten(&column.header), column.unit.prose())
    };
    chosen.iter().map(describe_one).collect::<Vec<_>>().join(", ")
}

/// The note on an optional column that cannot be read.
pub(super) fn left_out(channel: Channel, error: &FileError) -> String {
    format!("{} is left out: {error}", channel.name())
}

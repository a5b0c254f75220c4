//! The channels of a log while it is read: values in SI units, before they are checked and become a [`Log`](fluxfit::log::Log).

use super::{chosen::ChosenColumn, lines::Lines};
use crate::{channel::Channel, problem::Problem};
use fluxfit_files::FileError;

/// Columns of values in SI units, by channel.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Channels {
    /// The values.
    pub(super) columns: Vec<(Channel, Vec<f64>)>,
    /// The row of the file that each row was; empty while no row was removed.
    pub(super) origins: Vec<usize>,
    /// Headers in the file, for messages.
    pub(super) headers: Vec<(Channel, String)>,
}

/// Finds the line and the column of an error in the file.
pub(super) struct Locator {
    origins: Vec<usize>,
    headers: Vec<(Channel, String)>,
    lines: Lines,
}

impl Locator {
    /// The library's error, at the line and under the header that its row and column have in the file.
    pub(super) fn locate(&self, error: fluxfit::error::Error) -> FileError {
        let row = error.row().map(|row| self.origins.get(row).copied().unwrap_or(row));
        let header = error.column().and_then(|name| self.headers.iter().find(|(channel, _)| channel.name() == name));
        let mut located = FileError::from(Problem::Log(error));
        if let Some(row) = row {
            located = self.lines.locate(located, row);
        }
        if let Some((_, header)) = header {
            located = located.in_column(header);
        }
        located
    }
}

impl Channels {
    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }

    /// All channels with their values.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Channel, &[f64])> {
        self.columns.iter().map(|(channel, values)| (*channel, values.as_slice()))
    }

    /// The values of a channel.
    pub(super) fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.iter().find(|(other, _)| *other == channel).map(|(_, values)| values)
    }

    /// Adds a channel, or replaces its values.
    pub(super) fn set(&mut self, channel: Channel, values: Vec<f64>) {
        match self.columns.iter_mut().find(|(other, _)| *other == channel) {
            Some((_, old)) => *old = values,
            None => self.columns.push((channel, values)),
        }
    }

    /// Removes a channel and returns its values.
    pub(super) fn take(&mut self, channel: Channel) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|(other, _)| *other == channel)?;
        Some(self.columns.swap_remove(index).1)
    }

    /// Multiplies channels that are shares of the DC voltage by that of their row.
    pub(super) fn times_bus(&mut self, chosen: &[ChosenColumn]) -> Result<(), FileError> {
        for channel in chosen.iter().filter(|column| column.is_share).map(|column| &column.channel) {
            let Some(bus) = self.get(Channel::UDc).map(<[f64]>::to_vec) else {
                return Err(Problem::NoBus { channel: channel.name() }.into());
            };
            if let Some((_, values)) = self.columns.iter_mut().find(|(other, _)| other == channel) {
                values.iter_mut().zip(&bus).for_each(|(value, bus)| *value *= bus);
            }
        }
        Ok(())
    }

    /// Keeps the rows for which `kept` is true.
    pub(super) fn retain(&mut self, kept: &[bool]) {
        let marked = |row: &usize| kept.get(*row).copied().unwrap_or(false);
        self.origins = match self.origins.is_empty() {
            true => (0..kept.len()).filter(marked).collect(),
            false => (0..kept.len()).filter(marked).filter_map(|row| self.origins.get(row).copied()).collect(),
        };
        for (_, values) in &mut self.columns {
            let mut row = 0;
            values.retain(|_| {
                row += 1;
                kept[row - 1]
            });
        }
    }

    /// The error for a value of a channel.
    pub(super) fn refuse(&self, problem: Problem, channel: Channel, lines: &Lines, row: usize) -> FileError {
        let refused = lines.locate(problem.into(), row);
        let header = self.headers.iter().find(|(other, _)| *other == channel);
        header.map_or(refused.clone(), |(_, header)| refused.in_column(header))
    }

    /// The refusal of a channel that lacks the value of a row, and of one that lacks all of them.
    pub(super) fn refuse_missing(&self, channel: Channel, lines: &Lines, row: usize) -> FileError {
        let is_empty = self.get(channel).is_some_and(|values| values.iter().all(|value| value.is_nan()));
        if !is_empty {
            return self.refuse(Problem::EmptyCell, channel, lines, row);
        }
        let header = self.headers.iter().find(|(other, _)| *other == channel);
        header.map_or(Problem::EmptyColumn.into(), |(_, header)| FileError::from(Problem::EmptyColumn).in_column(header))
    }

    /// What locates errors of rows and columns in the file.
    pub(super) fn locator(&self, lines: &Lines) -> Locator {
        Locator { origins: self.origins.clone(), headers: self.headers.clone(), lines: lines.clone() }
    }
}

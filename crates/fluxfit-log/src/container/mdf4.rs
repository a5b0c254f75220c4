//! ASAM MDF 4: each channel group is a group of columns, whose time is its master channel.
//!
//! Conversions (linear, rational, by table) are applied. Samples that the file marks as invalid are NaN. Texts, arrays and channels
//! that are converted to texts are not columns of numbers.

use super::{
    fault::{damaged, unread},
    guard::guarded,
    limits::{BLOCK, MOST_COLUMNS},
    random_access::RandomAccess,
};
use crate::{block::ColumnHead, problem::Problem};
use falcon_mdf::{
    Mf4Error, Mf4File, OpenOptions,
    io::{ByteSlice, ByteSource},
    model::{Channel, Signal},
};
use fluxfit_files::FileError;
use std::sync::Arc;

const FORMAT: &str = "MDF";

/// Maximum size of a decompressed block, bytes. The standard recommends at most 4 MB.
const LARGEST_BLOCK: u64 = 32 << 20;

pub(crate) struct Mdf4 {
    file: Mf4File,
    heads: Vec<ColumnHead>,
    channels: Vec<Channel>,
    unreadable: Vec<String>,
}

impl Mdf4 {
    pub(super) fn open(source: RandomAccess) -> Result<Self, FileError> {
        let options = OpenOptions {
            build_channels_db: false,
            parallel_parsing: false,
            max_alloc: usize::try_from(source.length()).unwrap_or(usize::MAX).min(LARGEST_BLOCK as usize),
            max_decompressed: LARGEST_BLOCK,
            ..OpenOptions::default()
        };
        let file = guarded(FORMAT, || Mf4File::from_source_with_options(Arc::new(source), options).map_err(fault))?;
        let (mut heads, mut channels, mut unreadable) = (Vec::new(), Vec::new(), Vec::new());
        let groups = file.data_groups().iter().flat_map(|group| &group.channel_groups);
        for (group, channel_group) in groups.enumerate() {
            for channel in &channel_group.channels {
                let numbers = channel.value_kind().is_numeric() && !channel.is_array() && channel.unreadable().is_none();
                if !numbers {
                    unreadable.push(channel.name.clone());
                } else if channel_group.sample_count > 0 {
                    let unit = (!channel.unit.is_empty()).then(|| channel.unit.clone());
                    let rows = channel_group.sample_count;
                    let is_time = channel.is_time_channel();
                    heads.push(ColumnHead { name: channel.name.clone(), unit, rows, group, is_time, instants: None });
                    channels.push(channel.clone());
                }
                if heads.len() + unreadable.len() > MOST_COLUMNS {
                    return Err(Problem::ManyColumns { most: MOST_COLUMNS }.into());
                }
            }
        }
        if heads.is_empty() {
            return Err(Problem::NoNumbers { format: FORMAT }.into());
        }
        Ok(Self { file, heads, channels, unreadable })
    }

    pub(super) fn heads(&self) -> &[ColumnHead] {
        &self.heads
    }

    pub(super) fn unreadable(&self) -> &[String] {
        &self.unreadable
    }

    pub(super) fn read(&self, wanted: &[usize], take: &mut dyn FnMut(Vec<Vec<f64>>) -> Result<(), FileError>) -> Result<(), FileError> {
        let channels: Vec<&Channel> = wanted.iter().map(|&at| &self.channels[at]).collect();
        let rows = wanted.first().map_or(0, |&at| self.heads[at].rows);
        let mut read = 0;
        let mut chunks = guarded(FORMAT, || self.file.signals_chunks(&channels, BLOCK).map_err(fault))?;
        let mut next = || -> Result<Option<Vec<Vec<f64>>>, FileError> {
            let Some(signals) = chunks.next() else { return Ok(None) };
            signals.map_err(fault)?.iter().map(values).collect::<Result<_, _>>().map(Some)
        };
        while let Some(block) = guarded(FORMAT, &mut next)? {
            let count = block.first().map_or(0, Vec::len);
            if block.iter().any(|values| values.len() != count) {
                return Err(damaged(FORMAT, "its channels have different lengths"));
            }
            read += count as u64;
            take(block)?;
        }
        if read == rows { Ok(()) } else { Err(damaged(FORMAT, "it has fewer samples than it states")) }
    }
}

fn values(signal: &Signal) -> Result<Vec<f64>, FileError> {
    let mut values = signal.values_f64().map_err(fault)?;
    if let Some(valid) = signal.validity() {
        values.iter_mut().zip(valid).filter(|(_, valid)| !valid).for_each(|(value, _)| *value = f64::NAN);
    }
    Ok(values)
}

impl ByteSource for RandomAccess {
    fn len(&self) -> u64 {
        self.length()
    }

    fn read_bytes(&self, offset: u64, length: usize) -> falcon_mdf::Result<ByteSlice<'_>> {
        Ok(ByteSlice::Owned(self.bytes_at(offset, length as u64).map_err(Mf4Error::Io)?))
    }
}

fn fault(error: Mf4Error) -> FileError {
    match error {
        Mf4Error::Io(error) => unread(FORMAT, &error),
        error => damaged(FORMAT, error.to_string().lines().next().unwrap_or("it cannot be read")),
    }
}

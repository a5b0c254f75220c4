//! CAN frames as candump writes them, with a DBC that names their signals: each message is a group of columns with times of its own.
//!
//! ```text
//! (1436509052.249713) can0 123#1122334455667788        candump -l, python-can's Logger
//!  (000.000214)  can0  123   [8]  11 22 33 44 55 66 77 88        candump -t a, d or z
//! ```

use super::memory::Table;
use crate::{block::ColumnHead, csv::Text, instant::Instants, problem::Problem};
use can_dbc::{ByteOrder, Dbc, MessageId, MultiplexIndicator, Signal, SignalExtendedValueType, ValueType};
use fluxfit_files::{FileError, input::io_problem};
use std::{
    collections::HashMap,
    io::{BufRead, BufReader, Cursor, Read},
};

/// Bytes of the longest line: a CAN XL frame would have 4200 digits.
const LONGEST_LINE: u64 = 1 << 14;

/// Bytes of a CAN FD frame.
const MOST_BYTES: usize = 64;

/// Most bits of a signal.
const MOST_BITS: u64 = 64;

/// A frame.
struct Frame<'a> {
    time: &'a str,
    is_extended: bool,
    id: u32,
    bytes: Vec<u8>,
}

/// The frames of one message, or of those with one value of its multiplexer.
#[derive(Default)]
struct Frames {
    t: Vec<f64>,
    bytes: Vec<u8>,
}

/// Whether a text is such a log: by its first line.
pub(super) fn is_candump(head: &str) -> bool {
    head.lines().find(|line| !line.trim().is_empty()).is_some_and(|line| line.trim_start().starts_with('(') && frame(line).is_some())
}

/// Whether a text is such a log but for the times, as candump writes it to a terminal: by its first lines.
pub(super) fn is_without_times(head: &str) -> bool {
    let mut lines = head.lines().map(str::trim).filter(|line| !line.is_empty());
    let is_frame = |line: &str| !line.starts_with('(') && frame(&format!("(0) {line}")).is_some();
    // The second one may be cut off.
    lines.next().is_some_and(is_frame) && lines.next().is_none_or(|line| is_frame(line) || lines.next().is_none())
}

/// Reads the frames of the messages that the DBC has.
pub(super) fn read(text: Text, dbc: &str) -> Result<Table, FileError> {
    let dbc = Dbc::try_from(dbc)
        .map_err(|error| Problem::Dbc { reason: error.to_string().lines().next().unwrap_or_default().trim().to_owned() })?;
    let messages: HashMap<(bool, u32), usize> = dbc.messages.iter().enumerate().map(|(place, message)| (key(message.id), place)).collect();
    let mut lines = BufReader::new(Cursor::new(text.head.into_bytes()).chain(text.rest));
    let (mut line, mut number, mut unknown) = (Vec::new(), 0_u64, 0_u64);
    let mut clock: Option<Instants> = None;
    // By message and value of its multiplexer.
    let mut found: HashMap<(usize, Option<u64>), Frames> = HashMap::new();
    loop {
        line.clear();
        let count =
            (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(|error| FileError::from(io_problem("reading", &error)))?;
        if count == 0 {
            break;
        }
        number += 1;
        let text = String::from_utf8_lossy(&line);
        if text.trim().is_empty() {
            continue;
        }
        let wrong = || FileError::from(Problem::Frame { text: text.trim().to_owned() }).at_line(number);
        let is_last = !line.ends_with(b"\n");
        let Some(frame) = frame(&text) else {
            // The last line may be cut off, and a remote or error frame has no data.
            if is_last || text.contains(['R', 'E']) && !text.contains('[') {
                continue;
            }
            return Err(wrong());
        };
        let t = match clock
            .get_or_insert_with(|| Instants::of(&[frame.time]).unwrap_or_else(Instants::since_zero))
            .seconds(frame.time.as_bytes())
        {
            Some(t) => t,
            None => return Err(wrong()),
        };
        let Some(&place) = messages.get(&(frame.is_extended, frame.id)) else {
            unknown += 1;
            continue;
        };
        let message = &dbc.messages[place];
        let size = usize::try_from(message.size).unwrap_or(MOST_BYTES).min(MOST_BYTES);
        if frame.bytes.len() < size {
            continue;
        }
        let switch = message.signals.iter().find(|signal| signal.multiplexer_indicator == MultiplexIndicator::Multiplexor);
        let value = switch.and_then(|signal| bits(signal, &frame.bytes));
        let frames = found.entry((place, value)).or_default();
        // Two interfaces may have the same frame at the same time.
        if frames.t.last().is_none_or(|last| t > *last) {
            frames.t.push(t);
            frames.bytes.extend_from_slice(&frame.bytes[..size]);
        }
    }
    let mut table = table(&dbc, &found)?;
    if unknown > 0 {
        table.notes.push(format!("{unknown} frames of messages that the DBC does not have are left out"));
    }
    Ok(table)
}

/// The columns of all messages.
fn table(dbc: &Dbc, found: &HashMap<(usize, Option<u64>), Frames>) -> Result<Table, FileError> {
    let mut order: Vec<&(usize, Option<u64>)> = found.keys().collect();
    order.sort();
    let names = order.iter().flat_map(|(place, _)| dbc.messages[*place].signals.iter().map(|signal| signal.name.as_str()));
    let mut counts: HashMap<&str, usize> = HashMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    let mut table = Table::default();
    for (group, key) in order.into_iter().enumerate() {
        let (frames, message) = (&found[key], &dbc.messages[key.0]);
        let size = frames.bytes.len() / frames.t.len().max(1);
        let time = ColumnHead {
            name: format!("{}.time", message.name),
            unit: Some("s".to_owned()),
            group,
            is_time: true,
            ..ColumnHead::default()
        };
        if frames.t.len() < 2 || size == 0 {
            continue;
        }
        table.push(time, frames.t.clone());
        for signal in &message.signals {
            let is_present = match signal.multiplexer_indicator {
                MultiplexIndicator::Plain | MultiplexIndicator::Multiplexor => true,
                MultiplexIndicator::MultiplexedSignal(value) => key.1 == Some(value),
                _ => false,
            };
            let kind = dbc.extended_value_type_for_signal(message.id, &signal.name);
            let values: Option<Vec<f64>> = frames.bytes.chunks_exact(size).map(|bytes| value(signal, kind, bytes)).collect();
            let Some(values) = values.filter(|_| is_present) else {
                table.unreadable.push(signal.name.clone());
                continue;
            };
            let is_alone = counts.get(signal.name.as_str()) == Some(&1);
            let name = if is_alone { signal.name.clone() } else { format!("{}.{}", message.name, signal.name) };
            let unit = Some(signal.unit.clone()).filter(|unit| !unit.is_empty());
            table.push(ColumnHead { name, unit, group, ..ColumnHead::default() }, values);
        }
    }
    if table.heads.is_empty() { Err(Problem::NoMessages.into()) } else { Ok(table) }
}

fn key(id: MessageId) -> (bool, u32) {
    match id {
        MessageId::Standard(id) => (false, id.into()),
        MessageId::Extended(id) => (true, id),
    }
}

/// The bits of a signal, as a number without sign; none if the frame is too short.
fn bits(signal: &Signal, bytes: &[u8]) -> Option<u64> {
    if !(1..=MOST_BITS).contains(&signal.size) {
        return None;
    }
    let start = usize::try_from(signal.start_bit).ok()?;
    let size = signal.size as usize;
    let bit = |at: usize| bytes.get(at / 8).map(|byte| u64::from(byte >> (at % 8) & 1));
    let mut value = 0;
    match signal.byte_order {
        ByteOrder::LittleEndian => {
            for k in 0..size {
                value |= bit(start.checked_add(k)?)? << k;
            }
        }
        // From its highest bit on: down within a byte, then from the top of the next one.
        ByteOrder::BigEndian => {
            let mut at = start;
            for _ in 0..size {
                value = value << 1 | bit(at)?;
                at = if at % 8 == 0 { at.checked_add(15)? } else { at - 1 };
            }
        }
    }
    Some(value)
}

/// The value of a signal in its unit.
fn value(signal: &Signal, kind: Option<&SignalExtendedValueType>, bytes: &[u8]) -> Option<f64> {
    let raw = bits(signal, bytes)?;
    let number = match (kind, signal.value_type) {
        (Some(SignalExtendedValueType::IEEEfloat32Bit), _) if signal.size == 32 => f64::from(f32::from_bits(raw as u32)),
        (Some(SignalExtendedValueType::IEEEdouble64bit), _) if signal.size == 64 => f64::from_bits(raw),
        (_, ValueType::Signed) => ((raw << (MOST_BITS - signal.size)) as i64 >> (MOST_BITS - signal.size)) as f64,
        _ => raw as f64,
    };
    Some(number * signal.factor + signal.offset)
}

/// The frame in a line.
fn frame(line: &str) -> Option<Frame<'_>> {
    let (time, rest) = line.trim().strip_prefix('(')?.split_once(')')?;
    let mut words = rest.split_whitespace();
    let (_interface, id) = (words.next()?, words.next()?);
    let hexadecimal = |text: &str| (text.len() <= 8).then(|| u32::from_str_radix(text, 16).ok()).flatten();
    if let Some((id, data)) = id.split_once('#') {
        // Of CAN FD: a second mark, and a digit of flags.
        let data = data.strip_prefix('#').map_or(Some(data), |rest| rest.get(1..))?;
        let data = data.split('_').next().unwrap_or(data).replace('.', "");
        let bytes: Option<Vec<u8>> = (0..data.len() / 2).map(|at| u8::from_str_radix(data.get(2 * at..2 * at + 2)?, 16).ok()).collect();
        return Some(Frame { time, is_extended: id.len() > 3, id: hexadecimal(id)?, bytes: bytes.filter(|_| data.len() % 2 == 0)? });
    }
    // Directions and flags may stand before the identifier.
    let (mut id, mut length) = (id, words.next()?);
    while !length.starts_with('[') {
        (id, length) = (length, words.next()?);
    }
    let length: usize = length.trim_matches(['[', ']']).parse().ok()?;
    let bytes: Option<Vec<u8>> = words.take(length.min(MOST_BYTES)).map(|word| u8::from_str_radix(word, 16).ok()).collect();
    let bytes = bytes.filter(|bytes| bytes.len() == length)?;
    Some(Frame { time, is_extended: id.len() > 3, id: hexadecimal(id)?, bytes })
}

//! Lines as the serial monitor of the Arduino IDE shows them with times: `13:24:31.018 -> 0.52`. The time becomes a cell of its own.

use super::text::Text;
use fluxfit_files::csv::header::is_number;
use std::io::{self, Read};

/// What stands between the time and the line.
const ARROW: &[u8] = b" -> ";

/// The time, of which 0 is any digit, and the arrow.
const STAMP: &[u8] = b"00:00:00.000 -> ";

/// So many lines of the first are looked at.
const LINES: usize = 20;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// The text with its times as cells, if lines begin with them; the name of their column is `t`.
pub(super) fn with_times_as_cells(text: Text) -> Text {
    let rest = |line: &str| is_stamped(line).then(|| line[STAMP.len()..].trim_end().to_owned());
    let lines: Vec<&str> = text.head.lines().filter(|line| !line.trim().is_empty()).take(LINES).collect();
    let stamped: Vec<String> = lines.iter().copied().filter_map(rest).collect();
    let Some(last) = stamped.last().filter(|_| stamped.len() > 1 && 2 * stamped.len() >= lines.len()) else { return text };
    let separator = [b'\t', b';', b','].into_iter().find(|separator| last.as_bytes().contains(separator)).unwrap_or(b' ');
    let is_header = is_stamped(lines[0]) && !is_number(stamped[0].split(char::from(separator)).next().unwrap_or_default().trim());
    let mut text = text.changed(0, |lines| Box::new(Times::new(lines, separator)));
    if is_header {
        let start = text.head.len() - text.head.trim_start().len();
        text.head.replace_range(start..start + STAMP.len() - ARROW.len(), "t");
    }
    text.notes.push("the time of each row is the one at which the serial monitor received it".to_owned());
    text
}

fn is_stamped(line: &str) -> bool {
    let line = line.as_bytes();
    line.len() > STAMP.len() && line.iter().zip(STAMP).all(|(byte, stamp)| is_like(*byte, *stamp))
}

fn is_like(byte: u8, stamp: u8) -> bool {
    byte == stamp || stamp == b'0' && byte.is_ascii_digit()
}

/// Text in which a separator stands in the place of each arrow.
struct Times<R> {
    text: R,
    separator: u8,
    changed: Vec<u8>,
    /// Bytes of `changed` that were passed on.
    passed: usize,
    /// What of a stamp the present line has begun with; none behind it.
    begun: Option<Vec<u8>>,
}

impl<R: Read> Times<R> {
    fn new(text: R, separator: u8) -> Self {
        Self { text, separator, changed: Vec::new(), passed: 0, begun: Some(Vec::new()) }
    }

    fn change(&mut self, piece: &[u8]) {
        for byte in piece {
            if let Some(begun) = &mut self.begun {
                begun.push(*byte);
                if is_like(*byte, STAMP[begun.len() - 1]) && begun.len() < STAMP.len() {
                    continue;
                }
                if is_like(*byte, STAMP[begun.len() - 1]) {
                    begun.truncate(STAMP.len() - ARROW.len());
                    begun.push(self.separator);
                }
                self.changed.append(begun);
            } else {
                self.changed.push(*byte);
            }
            self.begun = (*byte == b'\n').then(Vec::new);
        }
    }
}

impl<R: Read> Read for Times<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.passed == self.changed.len() {
            self.changed.clear();
            self.passed = 0;
            let mut piece = vec![0; PIECE];
            let count = self.text.read(&mut piece)?;
            if count > 0 {
                self.change(&piece[..count]);
                continue;
            }
            match self.begun.take() {
                Some(last) if !last.is_empty() => self.changed = last,
                _ => return Ok(0),
            }
        }
        let count = buffer.len().min(self.changed.len() - self.passed);
        buffer[..count].copy_from_slice(&self.changed[self.passed..self.passed + count]);
        self.passed += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> String {
        let mut text = with_times_as_cells(Text::of(text.to_owned()));
        let mut all = text.head;
        text.rest.read_to_string(&mut all).unwrap();
        all
    }

    #[test]
    fn times_become_cells() {
        let rows = "13:24:31.018 -> 1.0\t2.0\r\n13:24:31.028 -> 1.5\t2.5\r\n13:24:31.0";
        let cells = "13:24:31.018\t1.0\t2.0\r\n13:24:31.028\t1.5\t2.5\r\n13:24:31.0";
        assert_eq!(read(rows), cells);
        assert_eq!(read(&format!("t\tud\tuq\r\n{rows}")), format!("t\tud\tuq\r\n{cells}"));
        assert_eq!(read(&format!("13:24:31.008 -> ud\tuq\r\n{rows}")), format!("t\tud\tuq\r\n{cells}"));
        assert_eq!(read("t,x\n13:24:31.018 -> 1,2\n13:24:31.028 -> 3,4\n"), "t,x\n13:24:31.018,1,2\n13:24:31.028,3,4\n");
        assert_eq!(read("13:24:31.018 -> 1\n13:24:31.028 -> 3\n"), "13:24:31.018 1\n13:24:31.028 3\n");
        for other in ["a -> b\n1 -> 2\n", "13:24:31,1\n13:24:32,2\n", "", "13:24:31.018 -> 1\n"] {
            assert_eq!(read(other), other);
        }
    }

    /// Whatever the sizes of the parts in which it is read, and behind the head, too.
    #[test]
    fn the_rest_of_a_text_is_read_alike() {
        struct Parts(Vec<u8>, usize);
        impl Read for Parts {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                let count = self.1.min(self.0.len()).min(buffer.len());
                buffer[..count].copy_from_slice(&self.0[..count]);
                self.0.drain(..count);
                Ok(count)
            }
        }
        let text = b"13:24:31.018 -> 1.0\n13:2\n13:24:31.028 -> 2.0 -> 3\n";
        for size in 1..=text.len() {
            let mut all = String::new();
            Times::new(Parts(text.to_vec(), size), b',').read_to_string(&mut all).unwrap();
            assert_eq!(all, "13:24:31.018,1.0\n13:2\n13:24:31.028,2.0 -> 3\n", "{size}");
        }
    }
}

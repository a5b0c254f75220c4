//! Zeros behind the end of a text: a recorder's card is filled up with them where a file was given room before it was written, or where
//! the power went first.

use std::io::{self, Read};

/// The bytes before them. Zeros between others stay.
pub(super) struct Unpadded<R> {
    bytes: R,
    /// Zeros that were read and may be the last bytes.
    zeros: usize,
    /// What was read behind them, and by how many zeros it is followed.
    behind: Vec<u8>,
    then: usize,
}

impl<R> Unpadded<R> {
    pub(super) fn new(bytes: R) -> Self {
        Self { bytes, zeros: 0, behind: Vec::new(), then: 0 }
    }
}

impl<R: Read> Read for Unpadded<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if out.is_empty() {
            return Ok(0);
        }
        loop {
            if !self.behind.is_empty() {
                let count = out.len().min(if self.zeros > 0 { self.zeros } else { self.behind.len() });
                if self.zeros > 0 {
                    out[..count].fill(0);
                    self.zeros -= count;
                    return Ok(count);
                }
                out[..count].copy_from_slice(&self.behind[..count]);
                self.behind.drain(..count);
                if self.behind.is_empty() {
                    self.zeros = self.then;
                }
                return Ok(count);
            }
            let count = self.bytes.read(out)?;
            if count == 0 {
                return Ok(0);
            }
            let kept = out[..count].iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
            match (self.zeros, kept) {
                (zeros, 0) => self.zeros = zeros + count,
                (0, _) => {
                    self.zeros = count - kept;
                    return Ok(kept);
                }
                _ => (self.behind, self.then) = (out[..kept].to_vec(), count - kept),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the sizes of the parts in which it is read.
    #[test]
    fn zeros_at_the_end_are_left_out_and_others_stay() {
        for (bytes, expected) in
            [(b"ab\n\0\0\0\0\0".as_slice(), b"ab\n".as_slice()), (b"ab\0\0\0c\0d\0\0", b"ab\0\0\0c\0d"), (b"\0\0\0", b""), (b"abc", b"abc")]
        {
            for size in 1..=bytes.len() {
                let mut unpadded = Unpadded::new(bytes);
                let (mut read, mut part) = (Vec::new(), vec![0; size]);
                while let Ok(count @ 1..) = unpadded.read(&mut part) {
                    read.extend_from_slice(&part[..count]);
                }
                assert_eq!(read, expected, "{size}");
            }
        }
    }
}

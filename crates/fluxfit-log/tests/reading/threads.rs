//! A long log is the same on any number of threads, compressed or not, from a file or through a pipe; and so is an error in it.

use fluxfit_files::FileError;
use fluxfit_log::{LogOptions, ReadLog, read_log_from};
use std::{
    fmt::Write as _,
    io::{Cursor, Read, Write as _},
};

const ROWS: usize = 40_000;

/// The value of a row, with the digits that a drive's tool writes.
fn value(row: usize, place: usize) -> f64 {
    let wave = (row as f64 * 0.01 * (place + 1) as f64).sin() * 40.0 + place as f64;
    (wave * 1e6).round() / 1e6
}

fn row(row: usize) -> String {
    let mut text = format!("{:.4}", row as f64 * 1e-4);
    (0..5).for_each(|place| write!(text, ",{:.6}", value(row, place)).unwrap());
    text
}

fn text() -> String {
    let rows: Vec<String> = (0..ROWS).map(row).collect();
    format!("t,ud,uq,id,iq,omega_e\n{}\n", rows.join("\n"))
}

fn gzip(text: &str) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

fn utf16(text: &str) -> Vec<u8> {
    "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

/// Gives a few bytes at a time, as a slow pipe.
struct Slow(Cursor<Vec<u8>>);

impl Read for Slow {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(997);
        self.0.read(&mut buffer[..count])
    }
}

fn on(threads: usize, bytes: &[u8]) -> Result<ReadLog, FileError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| read_log_from("drive.csv", Slow(Cursor::new(bytes.to_vec())), &LogOptions::default()))
}

#[test]
fn a_long_log_is_the_same_on_any_number_of_threads() {
    let text = text();
    for bytes in [text.clone().into_bytes(), text.replace('\n', "\r\n").into_bytes(), gzip(&text), utf16(&text)] {
        let one = on(1, &bytes).unwrap();
        let columns = one.log.columns();
        assert_eq!(one.log.rows(), ROWS);
        for (place, values) in [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].into_iter().enumerate() {
            assert!((0..ROWS).all(|row| values[row].to_bits() == value(row, place).to_bits()), "{place}");
        }
        for threads in [2, 4] {
            assert_eq!(on(threads, &bytes).unwrap(), one);
        }
    }
}

#[test]
fn a_late_error_names_its_line_on_any_number_of_threads() {
    let late = 30_000;
    // The header is in line 1, so row 0 is in line 2.
    let place = format!("drive.csv, line {}", late + 2);
    let text = text();
    let cases = [
        (
            row(late).replacen(',', ",x", 1),
            format!("{place}, column 'ud': \"x{:.6}\" is not a number; correct it or remove the row", value(late, 0)),
        ),
        (row(late) + ",1", format!("{place}: the row has 7 cells where the header has 6")),
        (row(late - 1), format!("{place}, column 't': ")),
        (row(late).replacen(',', ",inf,", 1).rsplit_once(',').unwrap().0.to_owned(), format!("{place}, column 'ud': ")),
    ];
    for (bad, expected) in cases {
        let text = text.replace(&row(late), &bad);
        for bytes in [text.clone().into_bytes(), gzip(&text)] {
            for threads in [1, 4] {
                let error = on(threads, &bytes).unwrap_err().to_string();
                assert!(error.starts_with(&expected), "{error}");
            }
        }
    }
}

#[test]
fn several_logs_are_read_at_once_by_the_threads_of_a_pool() {
    let text = text();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let rows = pool.install(|| {
        use rayon::prelude::*;
        (0..6)
            .into_par_iter()
            .map(|_| read_log_from("a", Cursor::new(text.clone()), &LogOptions::default()).unwrap().log.rows())
            .collect::<Vec<_>>()
    });
    assert_eq!(rows, [ROWS; 6]);
}

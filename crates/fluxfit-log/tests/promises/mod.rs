//! What must hold for every reader and any bytes: no panic, errors of one line, only finite numbers in what is returned.
//!
//! Checked by `tests/reading/regressions.rs` with files that once violated it, and by `fuzz/` with random files.

use fluxfit_log::{LogOptions, Mapping, ReadLog, parse_log, parse_map, parse_unit};
use fluxfit_units::{parse_bounds, parse_fix, parse_prior, parse_window};

/// The name of the file in messages.
const NAME: &str = "any.file";

/// Checks one reader.
pub(crate) type Promise = fn(&[u8]);

/// The readers; targets of fuzzing and folders of regressions have these names.
pub(crate) const READERS: [(&str, Promise); 3] = [("log", log), ("mapping", mapping), ("argument", argument)];

/// Names the signals of the frames in the corpus.
const DBC: &str = include_str!("../corpus/mappings/drive.dbc");

/// A log, without options and with those that a user may give.
pub(crate) fn log(bytes: &[u8]) {
    let map = |text: &str| text.split(',').filter_map(|pair| parse_map(pair).ok()).collect();
    let units = |text: &str| text.split(',').filter_map(|pair| parse_unit(pair).ok()).collect();
    let options = [
        LogOptions::default(),
        LogOptions {
            pole_pairs: Some(4),
            units: units("omega=rpm-mech,t=ms,theta=deg"),
            dbc: Some(DBC.to_owned()),
            ..LogOptions::default()
        },
        LogOptions { mapping: Mapping::parse(NAME, b"sample_period = 0.001").unwrap_or_default(), ..LogOptions::default() },
        LogOptions { map: map("t=time,ud=u_d,uq=u_q,id=i_d,iq=i_q,omega=speed,theta=angle"), pole_pairs: Some(3), ..LogOptions::default() },
    ];
    for options in options {
        if let Some(ReadLog { log, notes, .. }) = one_line(parse_log(NAME, bytes, &options)) {
            let columns = log.columns();
            for (name, values) in columns.named().into_iter().chain(columns.optional()) {
                assert_eq!(values.len(), columns.t.len(), "{name}");
                assert!(values.iter().all(|value| value.is_finite()), "{name}");
            }
            assert!(columns.t.windows(2).all(|pair| pair[0] < pair[1]), "time does not increase");
            notes.iter().for_each(|note| is_one_line(&note.sentence));
        }
    }
}

/// A mapping file.
fn mapping(bytes: &[u8]) {
    if let Some(mapping) = one_line(Mapping::parse(NAME, bytes)) {
        assert!(mapping.sample_period.is_none_or(|period| period.is_finite() && period > 0.0));
        assert_ne!(mapping.pole_pairs, Some(0));
    }
}

/// Arguments.
fn argument(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    one_line(parse_map(&text));
    one_line(parse_unit(&text));
    if let Some((_, value)) = one_line(parse_fix(&text)) {
        assert!(value.is_finite() && value >= 0.0, "{value}");
    }
    if let Some((_, value, error)) = one_line(parse_prior(&text)) {
        assert!(value.is_finite() && error.is_finite() && error > 0.0, "{value} {error}");
    }
    if let Some((_, lower, upper)) = one_line(parse_bounds(&text)) {
        assert!(lower.is_finite() && upper.is_finite() && lower < upper, "{lower} {upper}");
    }
    if let Some(window) = one_line(parse_window(&text)) {
        assert!(window.from.is_finite() && window.to.is_finite() && window.from < window.to, "{window:?}");
    }
}

/// What was read; an error must be one line.
fn one_line<T>(read: Result<T, impl std::fmt::Display>) -> Option<T> {
    read.map_err(|error| is_one_line(&error.to_string())).ok()
}

fn is_one_line(sentence: &str) {
    assert!(!sentence.is_empty() && !sentence.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')), "{sentence:?}");
}

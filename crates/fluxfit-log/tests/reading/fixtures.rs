//! Logs and options for several tests.

use fluxfit_log::{LogOptions, parse_log, parse_map};

/// Options with these mappings.
pub(crate) fn map(pairs: &[&str]) -> LogOptions {
    LogOptions { map: pairs.iter().map(|pair| parse_map(pair).expect(pair)).collect(), ..LogOptions::default() }
}

/// The log in these bytes.
pub(crate) fn log_of(bytes: &[u8], options: &LogOptions) -> fluxfit::log::Log {
    parse_log("drive.csv", bytes, options).unwrap_or_else(|error| panic!("{}\n{error}", String::from_utf8_lossy(bytes))).log
}

/// The error of a log in memory, which must be one line.
pub(crate) fn refusal(bytes: &[u8], options: &LogOptions) -> String {
    let sentence = parse_log("drive.csv", bytes, options).expect_err(&String::from_utf8_lossy(bytes)).to_string();
    assert!(!sentence.contains(['\n', '\r']), "{sentence}");
    sentence
}

/// Rows that would be read under any header of six columns.
pub(crate) const ROWS: &str = "0,1,2,3,4,5\n1,1,2,3,4,5\n";

/// The needed channels.
pub(crate) const HEADER: &str = "t,ud,uq,id,iq,omega_e\n";

/// A log of three rows.
pub(crate) const LOG: &str = "t,ud,uq,id,iq,omega_e\n0,-1.5,20.25,0,3,400\n0.001,-1.25,20,-0.5,3.125,401\n0.002,0,19,1e-3,3,-4.5\n";

//! A simulated log as CSV: canonical columns, every number with the fewest digits that read back to the same bits.

use fluxfit_drive::Recording;
use std::io::{self, Write};

/// Writes a recording.
///
/// # Errors
/// If `writer` fails. It should be buffered.
pub fn write_recording(writer: &mut dyn Write, recording: &Recording) -> io::Result<()> {
    let columns = recording.named();
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    writeln!(writer, "{}", names.join(","))?;
    let mut line = Vec::new();
    for row in 0..recording.columns.t.len() {
        line.clear();
        for (_, column) in &columns {
            if !line.is_empty() {
                line.push(b',');
            }
            write_number(&mut line, column[row])?;
        }
        line.push(b'\n');
        writer.write_all(&line)?;
    }
    Ok(())
}

/// Smaller numbers are shorter with an exponent.
const PLAIN: f64 = 1e-5;

fn write_number(line: &mut Vec<u8>, value: f64) -> io::Result<()> {
    if value == 0.0 || value.abs() >= PLAIN { write!(line, "{value}") } else { write!(line, "{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_drive::{Scenario, simulate};
    use fluxfit_log::{LogOptions, parse_log};
    use proptest::prelude::*;

    fn written(recording: &Recording) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_recording(&mut bytes, recording).unwrap();
        bytes
    }

    #[test]
    fn a_written_log_reads_back_to_the_same_bits() {
        let mut scenario = Scenario { duration: 0.1, ..Scenario::paper() };
        scenario.sensors.current_noise = 0.05;
        let recording = simulate(&scenario, 0, || ()).unwrap();
        let bytes = written(&recording);
        let read = parse_log("log.csv", &bytes, &LogOptions::default()).unwrap();
        assert!(read.notes.is_empty(), "{:?}", read.notes);
        let bits = |columns: [(&str, &Vec<f64>); 6]| columns.map(|(_, column)| column.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        assert_eq!(bits(read.log.columns().named()), bits(recording.columns.named()));
        assert_eq!(read.log, recording.log().unwrap());
        assert_eq!(read.log.columns().optional().count(), 2);
        assert!(bytes.starts_with(b"t,ud,uq,id,iq,omega_e,theta_e,ud_ref,uq_ref,u_dc\n0,"));
    }

    proptest! {
        #[test]
        fn every_finite_number_survives(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            let mut text = Vec::new();
            write_number(&mut text, value).unwrap();
            prop_assert_eq!(String::from_utf8(text).unwrap().parse::<f64>().unwrap().to_bits(), bits);
        }
    }
}

//! Traces of an oscilloscope: the time and its channels. They are no log; but of voltages alone, as between the terminals of a motor that
//! something turns, frequency and size are a row of an open-circuit table.

use super::{alias, finder::Finder, options::ResolvedOptions, proposal::stated_unit, resemblance, table::Table};
use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel,
    header_unit::split_header,
    problem::Problem,
};
use fluxfit_files::{FileError, FileErrorKind};
use fluxfit_units::{Dimension, Unit};

/// Most voltages: those of three phases.
const MOST: usize = 3;

/// Rows that are looked at: a screen of most oscilloscopes, in part.
const MOST_ROWS: usize = 1 << 20;

/// Fewest turns of the waves.
const FEWEST_TURNS: usize = 3;

/// Names of voltages that state no unit, before at most two letters or numbers of terminals; and of an instrument's channels.
const VOLTAGES: [&str; 11] = ["volt", "volts", "voltage", "ampl", "spannung", "tension", "emf", "bemf", "backemf", "u", "v"];
const INPUTS: [&str; 6] = ["ch", "channel", "kanal", "c", "chan", "trace"];

/// Letters of an instrument's channels.
const LETTERS: &str = "abcdefgh";

/// What an oscilloscope calls its horizontal axis, and a number of the sample on it, where the time is not stated in so many words.
const HORIZONTAL: [&str; 5] = ["x", "xaxis", "source", "sequence", "second"];

/// What Rigol calls the number of a sample, and the time between two.
const SAMPLE: &str = "X";
const INCREMENT: &str = "Increment";

/// Further columns of Rigol's traces: the time of the first sample, and that between two; as names alone, or with the number, `t0 = -6e-3`.
const START_AND_STEP: [&str; 2] = ["start", "increment"];
const START_AND_STEP_BEFORE: [&str; 2] = ["t0 =", "tInc ="];

fn is_start_or_step(head: &ColumnHead) -> bool {
    let name = head.name.trim();
    START_AND_STEP.iter().any(|word| name.eq_ignore_ascii_case(word)) || START_AND_STEP_BEFORE.iter().any(|start| name.starts_with(start))
}

/// Most channels of an instrument.
const MOST_INPUTS: usize = 16;

/// Letters and numbers of terminals.
const TERMINALS: &str = "abcuvwrstnxyz123";

/// The refusal of a table in which columns are missing: in place of it what the table is, if it is such a trace.
pub(super) fn named(table: &mut Table, options: &ResolvedOptions, refusal: FileError) -> FileError {
    let is_mapped = options.has_headers() || refusal.kind() != FileErrorKind::Columns;
    let waves = if is_mapped { None } else { waves(table, options) };
    match waves {
        Some([hertz, volts]) => Problem::OpenTerminals { hertz, volts }.into(),
        None if !is_mapped && is_trace(table.heads()) => {
            let names = table.heads().iter().map(|head| head.name.clone()).collect();
            Problem::Trace { names }.into()
        }
        None => refusal,
    }
}

/// Whether the columns are a time and an instrument's channels, and nothing else.
fn is_trace(heads: &[ColumnHead]) -> bool {
    let name = |head: &ColumnHead| resemblance::words(&head.name).concat();
    let named = |head: &&ColumnHead| !head.name.is_empty() && !is_start_or_step(head);
    let mut columns = heads.iter().filter(named);
    let is_time = |head: &ColumnHead| {
        HORIZONTAL.contains(&name(head).as_str()) || alias::is_alias(Channel::T, head) || stated_unit(Channel::T, head).is_some()
    };
    let first = columns.next().is_some_and(is_time);
    let others: Vec<&ColumnHead> = columns.collect();
    first && (1..=MOST_INPUTS).contains(&others.len()) && others.into_iter().all(is_input)
}

/// Whether a column has the name of an instrument's channel, whatever it is in: `CH1`, `C2 in V`, `Channel 0`, `1`.
fn is_input(head: &ColumnHead) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.len() <= 2 && text.bytes().all(|byte| byte.is_ascii_digit());
    let is = |dimension: Dimension| {
        let stem = resemblance::words(split_header(&head.name, dimension).0).concat();
        // With the unit, as Rigol writes `CH1V`.
        let is_end = |end: &str| is_number(end.trim_end_matches(['v', 'a'])) || end.len() == 1 && LETTERS.contains(end);
        is_number(&stem) || stem == "ampl" || INPUTS.iter().any(|input| stem.strip_prefix(input).is_some_and(is_end))
    };
    [Dimension::Voltage, Dimension::Current].into_iter().any(is)
}

/// Frequency and root mean square of the voltages, if there are a time and these alone.
fn waves(table: &mut Table, options: &ResolvedOptions) -> Option<[f64; 2]> {
    let heads = table.heads().to_vec();
    let finder = Finder { heads: &heads, unreadable: &[], lists: &[], first_cells: &Vec::new, passed_over: None, layout: None, options };
    // The first one may have the unit of a time and no name: `in s`.
    let is_time = || heads.iter().position(|head| !head.name.is_empty()).filter(|index| stated_unit(Channel::T, &heads[*index]).is_some());
    // Rigol numbers the samples and has the time between them in the first row alone.
    let called = |name: &str| heads.iter().position(|head| head.name.trim().eq_ignore_ascii_case(name));
    let increment = called(INCREMENT).filter(|_| called(SAMPLE) == Some(0));
    let time = finder.index(Channel::T).ok()?.or_else(is_time).or_else(|| increment.map(|_| 0))?;
    let others: Vec<usize> =
        (0..heads.len()).filter(|index| *index != time && !heads[*index].name.is_empty() && !is_start_or_step(&heads[*index])).collect();
    let is_one_group = heads.iter().all(|head| head.group == heads[time].group);
    if !(1..=MOST).contains(&others.len()) || !is_one_group || !others.iter().all(|index| is_voltage(&heads[*index])) {
        return None;
    }
    let instants = heads[time].instants.clone();
    let unit = if instants.is_some() { Unit::Second } else { stated_unit(Channel::T, &heads[time]).unwrap_or(Unit::Second) };
    let wanted = |index: usize| WantedColumn {
        index,
        header: heads[index].name.clone(),
        is_time: index == time,
        is_optional: true,
        instants: instants.clone().filter(|_| index == time),
    };
    let wanted: Vec<WantedColumn> = [time].into_iter().chain(others.iter().copied()).chain(increment).map(wanted).collect();
    let mut values = vec![Vec::new(); wanted.len()];
    let full = || FileError::from(Problem::NoRows);
    // What comes behind is not needed, and what cannot be read is no wave.
    let _ = table.read(&wanted, &mut |block| {
        values.iter_mut().zip(&block.values).for_each(|(all, some)| all.extend(some));
        if values[0].len() < MOST_ROWS { Ok(()) } else { Err(full()) }
    });
    let increment = increment.and_then(|_| values.pop());
    let step = increment.map_or(Some(1.0), |of_rows| of_rows.into_iter().find(|step| *step > 0.0))?;
    // That row has no samples.
    let is_row = |row: usize| values.iter().all(|values| values[row].is_finite());
    let rows: Vec<usize> = (0..values[0].len()).filter(|row| is_row(*row)).collect();
    let values: Vec<Vec<f64>> = values.iter().map(|values| rows.iter().map(|row| values[*row]).collect()).collect();
    let (t, voltages) = values.split_first()?;
    let of_each = voltages.iter().zip(&others).map(|(voltage, index)| {
        let [turns, rms] = wave(t, voltage)?;
        let size = stated_unit(Channel::UDc, &heads[*index]).map_or(1.0, Unit::in_si);
        Some([turns / (unit.in_si() * step), rms * size])
    });
    let of_each: Vec<[f64; 2]> = of_each.collect::<Option<_>>()?;
    let mean = |k: usize| of_each.iter().map(|wave| wave[k]).sum::<f64>() / of_each.len() as f64;
    Some([mean(0), mean(1)])
}

/// Whether a column is a voltage by its unit or name, and not one of the dq frame or of the DC bus.
fn is_voltage(head: &ColumnHead) -> bool {
    let name = resemblance::words(&head.name).concat();
    let ends = |start: &&str, most: usize| {
        name.strip_prefix(*start).is_some_and(|end| end.len() <= most && end.chars().all(|letter| TERMINALS.contains(letter)))
    };
    let is_named = VOLTAGES.iter().any(|start| ends(start, 2)) || is_input(head);
    let is_other = [Channel::Ud, Channel::Uq, Channel::UDc].iter().any(|channel| resemblance::fit(*channel, &head.name).is_some());
    !is_other && (stated_unit(Channel::UDc, head).is_some() || is_named && !resemblance::has_other_unit(Channel::UDc, head))
}

/// Turns for each unit of time, and root mean square without the mean, of a smooth wave that swings around zero.
fn wave(t: &[f64], values: &[f64]) -> Option<[f64; 2]> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let rms = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
    if !rms.is_finite() || rms == 0.0 || mean.abs() > LARGEST_MEAN * rms {
        return None;
    }
    // A switched voltage goes from one rail to the other at once.
    let swing = values.iter().fold(0.0, |largest: f64, value| largest.max((value - mean).abs()));
    if values.windows(2).any(|pair| (pair[1] - pair[0]).abs() > LARGEST_STEP * swing) {
        return None;
    }
    // Where it rises through its mean, once it was well below.
    let (mut is_below, mut rises) = (false, Vec::new());
    for (row, pair) in values.windows(2).enumerate() {
        is_below |= pair[0] < mean - 0.5 * rms;
        if is_below && pair[1] > mean {
            let part = (mean - pair[0]) / (pair[1] - pair[0]);
            rises.push((row + 1, t[row] + part * (t[row + 1] - t[row])));
            is_below = false;
        }
    }
    let ((from, first), (to, last)) = (rises.first()?, rises.last()?);
    // Of whole turns.
    let squares: f64 = values[*from..*to].iter().map(|value| (value - mean).powi(2)).sum();
    let rms = (squares / (to - from) as f64).sqrt();
    (rises.len() > FEWEST_TURNS && last > first).then(|| [(rises.len() - 1) as f64 / (last - first), rms])
}

/// Of waves around zero the mean is at most this share of the root mean square.
const LARGEST_MEAN: f64 = 0.5;

/// From one row to the next a smooth wave goes at most this share of its largest value.
const LARGEST_STEP: f64 = 0.7;

#[cfg(test)]
mod tests {
    use crate::{LogOptions, parse_log};

    fn refusal(header: &str, row: impl Fn(f64) -> Vec<f64>) -> String {
        let rows = (0..4000).map(|k| f64::from(k) * 5e-5).map(|t| {
            let cells: Vec<String> = [t].into_iter().chain(row(t)).map(|value| format!("{value:.6}")).collect();
            cells.join(",") + "\n"
        });
        parse_log("scope.csv", format!("{header}\n{}", rows.collect::<String>()).as_bytes(), &LogOptions::default())
            .unwrap_err()
            .to_string()
    }

    /// Of 53.2 Hz and 17.4 V of amplitude.
    fn phase(t: f64, number: f64) -> f64 {
        17.4 * (std::f64::consts::TAU * (53.2 * t - number / 3.0)).cos()
    }

    #[test]
    fn voltages_of_open_terminals_are_named_with_what_they_tell() {
        for header in [
            "Time (s),CH1 (V)",
            "in s,C1 in V",
            "Time [s],Channel 0",
            "Time,Ampl",
            "t,U_ab [V]",
            "TIME,CH1",
            "t,v",
            "Second,Volt",
            "t,Back-EMF [V]",
            "t,U12",
        ] {
            let sentence = refusal(header, |t| vec![phase(t, 0.0)]);
            assert!(sentence.contains("53.20 Hz and 12.3") && sentence.contains("psi_f alone"), "{header}: {sentence}");
        }
        for header in ["t,ua,ub,uc", "t,U_ab [V],U_bc [V],U_ca [V]", "t,CH1,CH2,CH3"] {
            let sentence = refusal(header, |t| vec![phase(t, 0.0), phase(t, 1.0), phase(t, 2.0)]);
            assert!(sentence.contains("53.20 Hz and 12.3"), "{header}: {sentence}");
        }
        let in_thousandths = refusal("t [ms],CH1 [mV]", |t| vec![phase(1e-3 * t, 0.0)]);
        assert!(in_thousandths.contains("a trace of an oscilloscope"), "too few turns: {in_thousandths}");
    }

    /// As Rigol writes it, with the time between samples in the row below the names, or in the name of a column.
    #[test]
    fn samples_that_are_numbered_have_the_time_of_the_first_row() {
        let samples = |row: &dyn Fn(u32) -> String| (0..4000).map(row).collect::<String>();
        let of_ab = |k: u32| phase(f64::from(k) * 5e-5, 0.0);
        let numbered = samples(&|k| format!("{k},{:.4},,\n", of_ab(k)));
        let timed = samples(&|k| format!("{:.6},{:.4},,\n", f64::from(k) * 5e-5, of_ab(k)));
        for text in [
            format!("X,CH1,Start,Increment,\nSequence,Volt,-6.0e-03,5.0e-05\n{numbered}"),
            format!("Time(s),CH1V,t0 = -6e-3, tInc = 5e-5,\n{timed}"),
        ] {
            let sentence = parse_log("scope.csv", text.as_bytes(), &LogOptions::default()).unwrap_err().to_string();
            assert!(sentence.contains("53.20 Hz and 12.3"), "{sentence}");
        }
    }

    #[test]
    fn what_has_currents_or_is_switched_or_does_not_swing_is_no_such_trace() {
        let square = |t: f64| if phase(37.0 * t, 0.0) > 0.0 { 24.0 } else { -24.0 };
        for sentence in [
            refusal("t,U_ab [V],I_a [A]", |t| vec![phase(t, 0.0), phase(t, 1.0)]),
            refusal("t,U_ab [V]", |t| vec![square(t)]),
            refusal("t,U_dc [V]", |t| vec![phase(t, 0.0)]),
            refusal("t,U_ab [V]", |t| vec![48.0 + 0.1 * phase(t, 0.0)]),
            refusal("t,ud,uq", |t| vec![phase(t, 0.0), phase(t, 1.0)]),
        ] {
            assert!(sentence.contains("missing"), "{sentence}");
        }
        for sentence in [
            refusal("t,CH1 [V],CH2 [A]", |t| vec![phase(t, 0.0), phase(t, 1.0)]),
            refusal("TIME,CH1", |t| vec![square(t)]),
            refusal("in s,C1 in V", |t| vec![48.0 + 0.1 * phase(t, 0.0)]),
        ] {
            assert!(sentence.contains("a trace of an oscilloscope"), "{sentence}");
        }
    }

    /// As Rigol, Siglent and Keysight write them.
    #[test]
    fn channels_of_an_oscilloscope_are_named() {
        for text in [
            "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0.0e+00,1.0e-04\n0,2.5e-02,-1.0e+01,,\n1,4.0e-01,-1.1e+01,,\n",
            "Source,CH1,CH2\nSecond,Volt,Volt\n0.0,0.02,-10.3\n0.1,0.4,-10.5\n",
            "x-axis,1,2\nsecond,Volt,Ampere\n-1.0E-03,0.0,0.0\n-0.9E-03,0.0,0.0\n",
        ] {
            let sentence = parse_log("scope.csv", text.as_bytes(), &LogOptions::default()).unwrap_err().to_string();
            assert!(sentence.contains("a trace of an oscilloscope"), "{sentence}");
        }
        for header in ["t,C1,speed", "CH1,CH2", "position,CH1", "t,channel"] {
            let sentence =
                parse_log("a.csv", format!("{header}\n1,2,3\n2,3,4\n").as_bytes(), &LogOptions::default()).unwrap_err().to_string();
            assert!(!sentence.contains("oscilloscope"), "{header}: {sentence}");
        }
    }
}

//! Plausible but meaningless data: standardized files, references in place of measurements.

use super::{channels::Channels, chosen::ChosenColumn};
use crate::{channel::Channel, problem::Problem};
use fluxfit::{
    ColumnFinding, check_columns,
    column_check::{LEAST_BUS, MOST_SHARE},
    log::Log,
};
use fluxfit_files::FileError;
use fluxfit_units::{Dimension, significant};

/// A column looks standardized if its mean is less than this many standard deviations,
const NORMALIZED_MEAN: f64 = 0.2;

/// and its standard deviation is in this range: in an excerpt of a standardized file neither is exact. The five channels of a drive are
/// never all like that: its speed alone would have to vary by about 1 rad/s around standstill.
const NORMALIZED_DEVIATION: std::ops::Range<f64> = 0.5..1.5;

/// Minimum number of rows for this check.
const NORMALIZED_ROWS: usize = 20;

/// Minimum number of rows for the check of references.
const MANY_ROWS: usize = 200;

/// Measured currents change in more than this share of the rows if the voltages change in most of them.
const SELDOM: f64 = 0.02;

/// Refuses a standardized file. The statistics are those of the values in the file, before any unit is applied.
pub(super) fn refuse_standardized(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let five = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::OmegaE];
    let looks = |channel: &Channel| {
        let column = chosen.iter().find(|column| column.channel == *channel);
        column.zip(channels.get(*channel)).is_some_and(|(column, values)| is_standard(values, column.factor()))
    };
    if five.iter().all(looks) { Err(Problem::Standardized.into()) } else { Ok(()) }
}

/// Whether values have a mean near 0 and a standard deviation near 1 in the file, where they were smaller by `factor`.
fn is_standard(values: &[f64], factor: f64) -> bool {
    let rows = values.len() as f64;
    let mean = values.iter().sum::<f64>() / rows / factor;
    let deviation = (values.iter().map(|value| (value / factor - mean).powi(2)).sum::<f64>() / rows).sqrt();
    values.len() >= NORMALIZED_ROWS && NORMALIZED_DEVIATION.contains(&deviation) && mean.abs() < NORMALIZED_MEAN * deviation
}

/// Whole numbers up to here may be V or A that were rounded; those of a converter, and thousandths, go further.
const MOST_WHOLE: f64 = 1000.0;

/// Digits have up to 32 bits; what is larger is refused elsewhere.
const MOST_DIGITS: f64 = 4_294_967_296.0;

/// Refuses voltages or currents that are digits of a converter, or whole numbers of mV or mA, where nothing states their unit. The numbers
/// are those in the file.
pub(super) fn refuse_digits(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    use Channel::{IA, IAlpha, IB, IBeta, IC, Id, Iq, UA, UAlpha, UB, UBeta, UC, Ud, Uq};
    for set in [&[Ud, Uq][..], &[Id, Iq], &[UA, UB, UC], &[IA, IB, IC], &[UAlpha, UBeta], &[IAlpha, IBeta]] {
        let columns: Vec<&ChosenColumn> = chosen.iter().filter(|column| set.contains(&column.channel) && !column.is_unit_written).collect();
        let values = || columns.iter().filter_map(|column| channels.get(column.channel)).flatten().filter(|value| value.is_finite());
        let most = values().fold(0.0, |most: f64, value| most.max(value.abs()));
        if let Some(first) =
            columns.first().filter(|_| (MOST_WHOLE..MOST_DIGITS).contains(&most) && values().all(|value| value.fract() == 0.0))
        {
            let headers = columns.iter().map(|column| column.header.clone()).collect();
            return Err(Problem::Digits { channel: first.channel.name(), headers, most }.into());
        }
    }
    Ok(())
}

/// Values per unit stay below this: the base values are the rated ones, or the largest.
const MOST_PER_UNIT: f64 = 2.0;

/// The fastest speed per unit is above this; that of a rotor which is held still, in rad/s, is not.
const LEAST_PER_UNIT: f64 = 0.2;

/// Refuses a log per unit: at its highest speed the voltage is of the order of one, as the speed is. A drive with a voltage of 1 V at
/// 1 rad/s, by which it would be mistaken, has a flux of 1 Wb and then a current of a fraction of its ripple.
pub(super) fn refuse_per_unit(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let five = [Channel::Ud, Channel::Uq, Channel::Id, Channel::Iq, Channel::OmegaE];
    let is_unwritten = |channel: &Channel| chosen.iter().any(|column| column.channel == *channel && !column.is_unit_written);
    let most = |channel: &Channel| {
        channels.get(*channel).map_or(f64::INFINITY, |values| values.iter().fold(0.0, |most: f64, value| most.max(value.abs())))
    };
    let largest = five.map(|channel| most(&channel));
    let [ud, uq, _, _, speed] = largest;
    let is_small = channels.rows() >= NORMALIZED_ROWS
        && largest.iter().all(|most| *most <= MOST_PER_UNIT)
        && ud.max(uq) > LEAST_PER_UNIT
        && speed > LEAST_PER_UNIT;
    if is_small && five.iter().all(is_unwritten) { Err(Problem::PerUnit { most: MOST_PER_UNIT }.into()) } else { Ok(()) }
}

/// Fewest rows whose size says something: a table of operating points has no more.
const SIZED_ROWS: usize = 4;

/// No drive of a PMSM has more, V: those of ships and wind turbines have up to 15 kV.
const MOST_VOLTAGE: f64 = 30e3;

/// Refuses voltages that no drive has, where nothing states their unit. With the DC voltage, the columns are compared later.
pub(super) fn refuse_high_voltage(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let is_voltage = |column: &&ChosenColumn| [Channel::Ud, Channel::Uq].contains(&column.channel) && !column.is_unit_written;
    for column in chosen.iter().filter(is_voltage).filter(|_| channels.get(Channel::UDc).is_none()) {
        let values = channels.get(column.channel).unwrap_or_default().iter();
        // So it is in most logs, which is seen much faster than a percentile.
        if values.clone().all(|value| value.abs() <= MOST_VOLTAGE) {
            continue;
        }
        let mut sizes: Vec<f64> = values.map(|value| value.abs()).filter(|size| size.is_finite()).collect();
        // Not the largest: a spike is left out later.
        let upper = sizes.len() * 3 / 4;
        let size = if sizes.is_empty() { 0.0 } else { *sizes.select_nth_unstable_by(upper, f64::total_cmp).1 };
        if sizes.len() >= SIZED_ROWS && size > MOST_VOLTAGE {
            return Err(FileError::from(Problem::HighVoltage { channel: column.channel.name(), most: size }).in_column(&column.header));
        }
    }
    Ok(())
}

/// Voltage over current, ohm, of a log with more than [`LARGE_CURRENT`]; only a large traction motor at standstill is below. In mA, a motor
/// of up to 12 ohm is.
const LEAST_IMPEDANCE: f64 = 0.012;

/// Currents of fewer A are not doubted.
const LARGE_CURRENT: f64 = 300.0;

/// The same of a log with more than this, A: at 20 V a drive has no more.
const LEAST_OF_LARGEST: f64 = 0.02;
const LARGEST_CURRENT: f64 = 1000.0;

/// No drive of a PMSM has more, A: 690 V and 10 MW.
const MOST_CURRENT: f64 = 12e3;

/// Voltages of fewer V are not doubted.
const LARGE_VOLTAGE: f64 = 2000.0;

/// A drive of more, VA, and of more than [`HIGH`] states its units: with neither, mA and mV are more likely.
const MEGAWATT: f64 = 1e6;

/// Drives of cars and of most machines have less, V, at a phase.
const HIGH: f64 = 1000.0;

/// A for each V of a log with more than [`LARGE_VOLTAGE`]: a drive of 3.3 kV has 27 A or more with any load.
const LEAST_ADMITTANCE: f64 = 0.01;

/// Refuses currents that are mA, or voltages that are mV, by the size of both, where nothing states their unit.
pub(super) fn refuse_thousandths(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let size = |channel: Channel| {
        let values = channels.get(channel).unwrap_or_default().iter();
        let mut sizes: Vec<f64> = values.map(|value| value.abs()).filter(|size| size.is_finite()).collect();
        // Not the largest: a spike is left out later.
        let upper = sizes.len() * 9 / 10;
        if sizes.len() < SIZED_ROWS { 0.0 } else { *sizes.select_nth_unstable_by(upper, f64::total_cmp).1 }
    };
    // Most logs have no value beyond these limits; that is seen much faster than a percentile.
    let exceeds = |pair: [Channel; 2], limit: f64| {
        let mut values = pair.into_iter().flat_map(|channel| channels.get(channel).unwrap_or_default());
        values.any(|value| value.abs() > limit)
    };
    if !exceeds([Channel::Id, Channel::Iq], LARGE_CURRENT) && !exceeds([Channel::Ud, Channel::Uq], LARGE_VOLTAGE) {
        return Ok(());
    }
    let (volts, amperes) = (size(Channel::Ud).max(size(Channel::Uq)), size(Channel::Id).max(size(Channel::Iq)));
    let is_unwritten = |pair: [Channel; 2]| {
        let of_pair = |column: &&ChosenColumn| pair.contains(&column.channel);
        chosen.iter().filter(of_pair).filter(|column| !column.is_unit_written && !column.is_share).count() == pair.len()
    };
    let least = if amperes > LARGEST_CURRENT { LEAST_OF_LARGEST } else { LEAST_IMPEDANCE };
    let milliamperes = amperes > MOST_CURRENT || amperes > LARGE_CURRENT && volts < least * amperes;
    if milliamperes && volts > 0.0 && is_unwritten([Channel::Id, Channel::Iq]) {
        return Err(Problem::Thousandths { channels: ["id", "iq"], amperes, volts, unit: "A" }.into());
    }
    // With the DC voltage, the columns are compared later.
    let is_alone = channels.get(Channel::UDc).is_none();
    if is_alone && volts > LARGE_VOLTAGE && amperes < LEAST_ADMITTANCE * volts && amperes > 0.0 && is_unwritten([Channel::Ud, Channel::Uq])
    {
        return Err(Problem::Thousandths { channels: ["ud", "uq"], amperes, volts, unit: "V" }.into());
    }
    let both = [[Channel::Id, Channel::Iq], [Channel::Ud, Channel::Uq]];
    if is_alone && volts > HIGH && amperes * volts > MEGAWATT && both.into_iter().all(is_unwritten) {
        return Err(Problem::Megawatts { amperes, volts }.into());
    }
    Ok(())
}

/// What rounding adds to a duty cycle.
const ROUNDING: f64 = 0.01;

/// Refuses duty cycles that are counts of a timer, or from -1 to 1.
pub(super) fn refuse_duties(chosen: &[ChosenColumn], channels: &Channels) -> Result<(), FileError> {
    let phases = [Channel::UA, Channel::UB, Channel::UC];
    for column in chosen.iter().filter(|column| column.is_share && column.is_alias && phases.contains(&column.channel)) {
        let values = channels.get(column.channel).unwrap_or_default().iter().filter(|value| value.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
        if low < -ROUNDING || high > 1.0 + ROUNDING {
            let [low, high] = [low, high].map(|value| significant(value / column.scale, 4));
            return Err(Problem::Duty { channel: column.channel.name(), header: column.header.clone(), low, high }.into());
        }
    }
    Ok(())
}

/// A note on currents that look like references: they rarely change while the voltages change all the time.
pub(super) fn note_references(channels: &Channels) -> Option<String> {
    let changing = |channels: &Channels, channel: Channel| {
        let values = channels.get(channel)?;
        (values.len() >= MANY_ROWS).then(|| values.windows(2).filter(|pair| pair[0] != pair[1]).count() as f64 / values.len() as f64)
    };
    let of = |channel: Channel| changing(channels, channel);
    let currents = of(Channel::Id)?.max(of(Channel::Iq)?);
    let voltages = of(Channel::Ud)?.min(of(Channel::Uq)?);
    (currents < SELDOM && voltages > 0.5).then(|| {
        format!(
            "id and iq change in only {:.1} % of the rows, the voltages in most: if these are references and not measured currents, the result is meaningless",
            100.0 * currents
        )
    })
}

/// A note on voltages that are as small as shares of the DC voltage, where nothing states their unit: they may be those of a slow motor, or
/// of one with few mOhm. Where more speaks for shares, there is a finding of the columns.
pub(super) fn note_small_voltages(chosen: &[ChosenColumn], log: &Log) -> Option<String> {
    let columns = log.columns();
    let least_bus = columns.u_dc.as_ref()?.iter().copied().fold(f64::INFINITY, f64::min);
    let most = columns.ud.iter().zip(&columns.uq).fold(0.0, |most: f64, (ud, uq)| most.max(ud.hypot(*uq)));
    let is_of_motor = |channel: Channel| channel.dimension() == Dimension::Voltage && channel != Channel::UDc;
    let is_written = || chosen.iter().any(|column| is_of_motor(column.channel) && column.is_unit_written);
    if least_bus < LEAST_BUS || most > MOST_SHARE || most == 0.0 || is_written() {
        return None;
    }
    let is_found = check_columns(log).iter().any(|finding| matches!(finding, ColumnFinding::VoltageShare { .. }));
    (!is_found).then(|| {
        let (most, bus) = (significant(most, 3), significant(least_bus, 3));
        format!(
            "the voltages never exceed {most} while u_dc is {bus} V or more: read as V; if they are shares of u_dc, a mapping file says so: \
             ud = {{ column = \"..\", scale = 0.5, times = \"u_dc\" }}"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(columns: &[(Channel, &dyn Fn(f64) -> f64)]) -> (Vec<ChosenColumn>, Channels) {
        let mut channels = Channels::default();
        let chosen = |(channel, value): &(Channel, &dyn Fn(f64) -> f64)| {
            channels.set(*channel, (0..100).map(|row| value(f64::from(row))).collect());
            let (unit, header) = (channel.unit(), channel.name().to_owned());
            let (is_unit_stated, is_unit_written, is_optional, is_share, is_alias) = (true, false, false, false, false);
            let (index, pole_pairs, scale, instants) = (0, 1, 1.0, None);
            ChosenColumn {
                channel: *channel,
                index,
                header,
                unit,
                pole_pairs,
                scale,
                is_optional,
                is_unit_stated,
                is_unit_written,
                is_share,
                is_alias,
                instants,
            }
        };
        let chosen = columns.iter().map(chosen).collect();
        (chosen, channels)
    }

    /// A current of 20 A peak in a converter of 16 bits, and one of 300 A that a bus message rounds to whole A.
    #[test]
    fn digits_of_a_converter_are_no_amperes() {
        let wave = |size: f64| move |row: f64| (size * (0.2 * row).sin()).round();
        let (mut chosen, digits) = channels(&[(Channel::Id, &wave(32767.0)), (Channel::Iq, &wave(300.0))]);
        let refused = refuse_digits(&chosen, &digits).unwrap_err().to_string();
        assert!(refused.starts_with("'id' and 'iq' are whole numbers up to 32") && refused.contains("digits of a converter"), "{refused}");
        chosen.iter_mut().for_each(|column| column.is_unit_written = true);
        assert_eq!(refuse_digits(&chosen, &digits), Ok(()));
        let (chosen, amperes) = channels(&[(Channel::Id, &wave(300.0)), (Channel::Iq, &wave(200.0))]);
        assert_eq!(refuse_digits(&chosen, &amperes), Ok(()));
    }

    /// The paper's motor on bases of 179 V, 10 A and 1000 rad/s; and a locked rotor, whose speed is that of a vibration.
    #[test]
    fn values_per_unit_are_no_volts() {
        let log = |speed: f64| {
            let wave = |size: f64| move |row: f64| size * (1.0 + 0.1 * (0.3 * row).sin());
            let (ud, uq, id, iq, omega) = (wave(-0.33), wave(0.5), wave(-0.2), wave(1.1), wave(speed));
            channels(&[(Channel::Ud, &ud), (Channel::Uq, &uq), (Channel::Id, &id), (Channel::Iq, &iq), (Channel::OmegaE, &omega)])
        };
        let refused = |speed: f64| {
            let (chosen, channels) = log(speed);
            refuse_per_unit(&chosen, &channels).is_err()
        };
        assert!(refused(0.42) && !refused(0.02) && !refused(419.0));
    }

    /// 100 V in mV; and the spike of a sensor.
    #[test]
    fn no_drive_has_100_kilovolts() {
        let (chosen, high) = channels(&[(Channel::Ud, &|row| -6e4 - row), (Channel::Uq, &|row| 1e5 + row)]);
        let refused = refuse_high_voltage(&chosen, &high).unwrap_err().to_string();
        assert!(refused.contains("ud comes to 60 kV"), "{refused}");
        let (chosen, spike) = channels(&[(Channel::Ud, &|row| if row == 50.0 { 1e9 } else { 100.0 })]);
        assert_eq!(refuse_high_voltage(&chosen, &spike), Ok(()));
    }

    /// The paper's motor at 12 A and 100 V, in mA, in mV and in both, and a gimbal's at 0.5 A and 5.4 V in mA; an electric kart's 1100 A at
    /// 25 V. A wind turbine's 1400 A at 2700 V state their units.
    #[test]
    fn thousandths_are_told_by_both_sizes() {
        let refused = |volts: f64, amperes: f64| {
            let (ud, iq) = (move |row: f64| volts - 0.01 * row, move |row: f64| amperes - 0.01 * row);
            let (zero, id) = (|_: f64| 0.0, |_: f64| 0.1);
            let (mut chosen, channels) = channels(&[(Channel::Ud, &ud), (Channel::Uq, &zero), (Channel::Id, &id), (Channel::Iq, &iq)]);
            let sentence = refuse_thousandths(&chosen, &channels).err().map(|error| error.to_string());
            chosen.iter_mut().for_each(|column| column.is_unit_written = true);
            assert_eq!(refuse_thousandths(&chosen, &channels), Ok(()));
            sentence.unwrap_or_default()
        };
        assert!(refused(100.0, 12e3).contains("id and iq were in mA"));
        assert!(refused(5.4, 496.0).contains("id and iq were in mA"));
        assert!(refused(1e5, 12.0).contains("ud and uq were in mV"));
        assert!(refused(1e4, 3e3).contains("as if they were in mA and mV"));
        assert!(refused(12e3, 800.0).contains("as if they were in mA and mV"));
        assert!(refused(2700.0, 1400.0).contains("as of a drive of megawatts"));
        assert_eq!([refused(100.0, 12.0), refused(25.0, 1100.0), refused(400.0, 0.5), refused(800.0, 1100.0)], [""; 4]);
    }

    #[test]
    fn a_standardized_column_is_distinguished_from_one_of_a_drive() {
        let wave: Vec<f64> = (0..100).map(|i| 1.3 * (f64::from(i) * 0.3).sin()).collect();
        assert!(is_standard(&wave, 1.0));
        // In mV, for example: the values in the file are a thousand times larger.
        assert!(!is_standard(&wave, 1e-3));
        assert!(!is_standard(&wave.iter().map(|value| value + 100.0).collect::<Vec<_>>(), 1.0));
        assert!(!is_standard(&[f64::NAN; 50], 1.0) && !is_standard(&[], 1.0));
    }
}

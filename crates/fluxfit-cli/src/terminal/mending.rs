//! What mends a finding of the columns: the likely cause, and the option or the lines of a mapping file to paste.

use super::{advice, given, told::Told};
use fluxfit::{
    ColumnFinding,
    column_check::{Change, NEARLY_ALL, Turning},
};
use fluxfit_files::Advice;
use fluxfit_log::{ReadColumn, are_volts_written};
use fluxfit_units::{Dimension, Unit, significant};
use std::{f64::consts::TAU, ops::RangeInclusive};

/// How well a ratio must agree with that of two units.
const AGREES: f64 = 0.005;

/// Most pole pairs of a motor.
const MOST_POLE_PAIRS: u32 = 60;

/// The columns with which a finding goes away.
#[derive(Debug, Clone, PartialEq, Default)]
struct Mending {
    /// The likely cause, if the finding does not say it.
    cause: Option<String>,
    /// Options to add.
    option: Option<String>,
    /// Lines of a mapping file.
    lines: Vec<String>,
}

impl Mending {
    /// Of a finding in a log with these columns, read with this number of pole pairs.
    fn of(finding: &ColumnFinding, read: &[ReadColumn], pole_pairs: Option<u32>) -> Self {
        match finding {
            ColumnFinding::SpeedUnit { ratio } => speed_unit(*ratio, read, pole_pairs).unwrap_or_default(),
            ColumnFinding::SpeedScale { low, high, angle: false } => speed_scale(*low..=*high, read, pole_pairs).unwrap_or_default(),
            ColumnFinding::SpeedScale { low, high, angle: true } => speed_and_angle(*low..=*high, read, pole_pairs).unwrap_or_default(),
            ColumnFinding::AngleInDegrees => Self::option("--unit theta_e=deg".to_owned()),
            ColumnFinding::SpeedSign { wrong } => {
                let channel = if *wrong == Some(Turning::Angle) { "theta_e" } else { "omega_e" };
                Self { lines: line(read, channel, channel, -1.0).into_iter().collect(), ..Self::default() }
            }
            ColumnFinding::TimeUnit { factor } => time_unit(*factor, read),
            ColumnFinding::Axes { changes, .. } => changes.first().map(|changes| axes(changes, read)).unwrap_or_default(),
            ColumnFinding::PhaseOrder => phases(read),
            ColumnFinding::VoltageScale { ratio, rows, most } => voltages(*ratio, *rows, *most, read),
            ColumnFinding::VoltageShare { .. } => shares(SEEM_SHARES, 0.5, "", read),
            ColumnFinding::VoltageDigits { currents: false, .. } => digits(MAY_BE_DIGITS, read),
            ColumnFinding::VoltageDigits { currents: true, .. } => digits(ALL_MAY_BE_DIGITS, read),
            _ => Self::default(),
        }
    }

    fn option(option: String) -> Self {
        Self { option: Some(option), ..Self::default() }
    }

    /// The finding with its cause and option, as one sentence; and the lines to paste below it.
    fn tell(&self, finding: &ColumnFinding) -> (String, String) {
        let cause = self.cause.as_ref().map(|cause| format!(": {cause}")).unwrap_or_default();
        let way = match (&self.option, self.lines.is_empty()) {
            (Some(option), _) => format!("; {}", given::instruction(option)),
            (None, false) => "; put into a mapping file (--mapping FILE), under [columns]:".to_owned(),
            (None, true) => String::new(),
        };
        let lines = if self.option.is_some() { String::new() } else { self.lines.iter().map(|line| format!("    {line}\n")).collect() };
        (format!("{finding}{cause}{way}"), lines)
    }
}

/// Size of a unit in SI units, of a mechanical one with this number of pole pairs.
fn size(unit: Unit, pole_pairs: u32) -> f64 {
    let mut one = [1.0];
    unit.to_si(&mut one, pole_pairs);
    one[0]
}

fn column<'a>(read: &'a [ReadColumn], channel: &str) -> Option<&'a ReadColumn> {
    read.iter().find(|column| column.channel == channel)
}

/// Unit and pole pairs with which the speed turns as fast as the angle; or the angle as fast as the speed.
fn speed_unit(ratio: f64, read: &[ReadColumn], given: Option<u32>) -> Option<Mending> {
    let pole_pairs = given.unwrap_or(1);
    let unless_given = |needed: u32| if given == Some(needed) { String::new() } else { format!(" --pole-pairs {needed}") };
    let column = column(read, "omega_e")?;
    let now = size(column.unit, pole_pairs) * ratio;
    // The pole pairs that a mechanical unit would need.
    let pole_pairs_of = |unit: Unit| {
        let needed = now / size(unit, 1);
        let whole = needed.round();
        let fits = whole >= 1.0 && whole <= f64::from(MOST_POLE_PAIRS) && (needed / whole - 1.0).abs() < AGREES;
        fits.then_some(whole as u32)
    };
    let is_right = |unit: &Unit| !unit.is_mechanical() && (now / size(*unit, 1) - 1.0).abs() < AGREES;
    // A unit that was taken for one of the shaft turns as fast as the angle: it is the electrical one, however many pole pairs there are.
    let is_electrical = |needed: &u32| *needed == 1 && pole_pairs > 1;
    if let Some(pole_pairs) = pole_pairs_of(column.unit).filter(|needed| column.unit.is_mechanical() && !is_electrical(needed)) {
        return Some(Mending { cause: Some(named_pairs(pole_pairs)), ..Mending::option(format!("--pole-pairs {pole_pairs}")) });
    }
    if let Some(unit) = Unit::of(Dimension::Speed).find(is_right) {
        let cause = format!("the speed is in {}", unit.prose());
        return Some(Mending { cause: Some(cause), ..Mending::option(format!("--unit omega_e={}", unit.name())) });
    }
    // The mechanical unit that is the electrical one's counterpart comes first.
    let mut mechanical: Vec<Unit> = Unit::of(Dimension::Speed).filter(|unit| unit.is_mechanical()).collect();
    mechanical.sort_by_key(|unit| size(*unit, 1) != size(column.unit, 1));
    if let Some((unit, pole_pairs)) = mechanical.into_iter().find_map(|unit| pole_pairs_of(unit).map(|pairs| (unit, pairs))) {
        let cause =
            if size(unit, 1) == size(column.unit, 1) { "mechanical speed".to_owned() } else { format!("speed in {}", unit.prose()) };
        let option = format!("--unit omega_e={}{}", unit.name(), unless_given(pole_pairs));
        return Some(Mending { cause: Some(format!("{cause}, {}", named_pairs(pole_pairs))), ..Mending::option(option) });
    }
    if (ratio * TAU - 1.0).abs() < AGREES {
        let lines = line(read, "theta_e", "theta_e", TAU).into_iter().collect();
        return Some(Mending { cause: Some("the angle is in turns".to_owned()), lines, option: None });
    }
    let pairs = (1.0 / ratio).round();
    let is_mechanical_angle = (2.0..=f64::from(MOST_POLE_PAIRS)).contains(&pairs) && (ratio * pairs - 1.0).abs() < AGREES;
    is_mechanical_angle.then(|| Mending {
        cause: Some(format!("mechanical angle, {}", named_pairs(pairs as u32))),
        ..Mending::option(format!("--unit theta_e=rad-mech{}", unless_given(pairs as u32)))
    })
}

/// The units and numbers of pole pairs with which the speed is within a range of factors of what it is now: the voltages know it no better.
/// Where more than one suits, none is proposed.
fn speed_scale(too_high: RangeInclusive<f64>, read: &[ReadColumn], pole_pairs: Option<u32>) -> Option<Mending> {
    let column = column(read, "omega_e")?;
    let is_mechanical = column.unit.is_mechanical();
    let now = size(column.unit, pole_pairs.unwrap_or(1));
    let fits = |unit: &Unit| *unit != column.unit && !unit.is_mechanical() && too_high.contains(&(now / size(*unit, 1)));
    let units: Vec<Unit> = Unit::of(Dimension::Speed).filter(fits).collect();
    // One pole pair is an electrical unit by another name.
    let mut pairs = pole_pairs.filter(|_| is_mechanical).map_or_else(Vec::new, |stated| suiting_pairs(stated, &too_high));
    pairs.retain(|pairs| *pairs > 1 || units.is_empty());
    match (&units[..], &pairs[..]) {
        (&[unit], []) if is_mechanical || *too_high.start() > 1.0 => {
            let cause = format!("the speed may be in {}", unit.prose());
            Some(Mending { cause: Some(cause), ..Mending::option(format!("--unit omega_e={}", unit.name())) })
        }
        ([], &[pairs]) => {
            let cause = format!("{} would suit it", named_pairs(pairs));
            Some(Mending { cause: Some(cause), ..Mending::option(format!("--pole-pairs {pairs}")) })
        }
        // r/min of a shaft are 9.5 times too high, less the number of pole pairs.
        ([], []) if *too_high.start() > 1.0 => (column.unit == Unit::RadianPerSecond).then(|| Mending {
            cause: Some("it may be in r/min of the shaft".to_owned()),
            ..Mending::option(format!("--unit omega_e=rpm-mech{}", if pole_pairs.is_some() { "" } else { " --pole-pairs N" }))
        }),
        _ => {
            let units = units.iter().map(|unit| format!("in {}", unit.prose()));
            let of_shaft = of_shaft(column.unit, Dimension::Speed).map(|unit| format!("that of the shaft ({})", unit.name()));
            let by_pairs = match pairs[..] {
                [] => None,
                [pairs] => Some(format!("of a motor with {}", named_pairs(pairs))),
                [fewest, .., most] => Some(format!("of a motor with {fewest} to {most} pole pairs")),
            };
            let possible: Vec<String> = units.chain(of_shaft).chain(by_pairs).collect();
            let cause = format!("it may be {}; state which", possible.join(", or "));
            (!possible.is_empty()).then(|| Mending { cause: Some(cause), ..Mending::default() })
        }
    }
}

/// The unit of the shaft with the name of an electrical one: r/min for r/min.
fn of_shaft(electrical: Unit, dimension: Dimension) -> Option<Unit> {
    let is_counterpart = |unit: &Unit| unit.is_mechanical() && size(*unit, 1) == size(electrical, 1);
    Unit::of(dimension).find(is_counterpart).filter(|_| !electrical.is_mechanical())
}

/// The shaft's speed and angle that were taken for the electrical ones; or another number of pole pairs, where both are the shaft's.
fn speed_and_angle(too_high: RangeInclusive<f64>, read: &[ReadColumn], pole_pairs: Option<u32>) -> Option<Mending> {
    let (speed, angle) = (column(read, "omega_e")?, column(read, "theta_e")?);
    let named = |pairs: &[u32]| match *pairs {
        [pairs] => (format!(", {}", named_pairs(pairs)), pairs.to_string()),
        [fewest, .., most] => (format!(", {fewest} to {most} pole pairs"), "N".to_owned()),
        [] => (String::new(), "N".to_owned()),
    };
    if let (Some(speed), Some(angle)) = (of_shaft(speed.unit, Dimension::Speed), of_shaft(angle.unit, Dimension::Angle)) {
        let (pairs, number) = named(&suiting_pairs(1, &too_high));
        let given = pole_pairs.map_or_else(|| format!(" --pole-pairs {number}"), |_| String::new());
        let option = format!("--unit omega_e={},theta_e={}{given}", speed.name(), angle.name());
        return (*too_high.end() < 1.0)
            .then(|| Mending { cause: Some(format!("both may be the shaft's{pairs}")), ..Mending::option(option) });
    }
    let (pairs, number) = named(&suiting_pairs(pole_pairs?, &too_high));
    let cause = format!("the number of pole pairs may be wrong{pairs}");
    Some(Mending { cause: Some(cause), ..Mending::option(format!("--pole-pairs {number}")) })
}

/// The numbers of pole pairs that suit a speed of the shaft, where the stated number makes it too high by such factors.
fn suiting_pairs(stated: u32, too_high: &RangeInclusive<f64>) -> Vec<u32> {
    let [fewest, most] = [too_high.end(), too_high.start()].map(|factor| f64::from(stated) / factor);
    (fewest.ceil() as u32..=most.floor() as u32).collect()
}

fn named_pairs(pole_pairs: u32) -> String {
    format!("{pole_pairs} pole pair{}", if pole_pairs == 1 { "" } else { "s" })
}

fn time_unit(factor: f64, read: &[ReadColumn]) -> Mending {
    let Some(column) = column(read, "t") else { return Mending::default() };
    let wanted = size(column.unit, 1) * factor;
    let unit = Unit::of(Dimension::Time).find(|unit| (size(*unit, 1) / wanted - 1.0).abs() < AGREES);
    match unit {
        Some(unit) => Mending::option(format!("--unit t={}", unit.name())),
        None => Mending { lines: line(read, "t", "t", factor).into_iter().collect(), ..Mending::default() },
    }
}

/// `ud = { column = "vd", sign = -1 }`: a channel read from the column of this or another one, times this factor.
fn line(read: &[ReadColumn], channel: &str, from: &str, factor: f64) -> Option<String> {
    let column = column(read, from)?;
    let name = column.header.replace('\\', "\\\\").replace('"', "\\\"");
    if name.chars().any(char::is_control) {
        return None;
    }
    // Of a column with a scale of its own both are one number.
    let factor = factor * column.scale;
    Some(if factor == 1.0 {
        format!("{channel} = \"{name}\"")
    } else if factor == -1.0 {
        format!("{channel} = {{ column = \"{name}\", sign = -1 }}")
    } else {
        let scale = significant(factor, 6);
        let scale = if scale.contains('.') && !scale.contains('e') { scale.trim_end_matches('0').trim_end_matches('.') } else { &scale };
        format!("{channel} = {{ column = \"{name}\", scale = {scale} }}")
    })
}

/// Where each of the four columns comes from after the changes, and its sign.
fn axes(changes: &[Change], read: &[ReadColumn]) -> Mending {
    let mut from = ["ud", "uq", "id", "iq"];
    let mut sign = [1.0; 4];
    let mut speed = 1.0;
    let has_angle = column(read, "theta_e").is_some();
    for change in changes {
        let reversed: &[usize] = match change {
            Change::SwapAxes => {
                from.swap(0, 1);
                from.swap(2, 3);
                &[]
            }
            Change::SwapVoltages => {
                from.swap(0, 1);
                &[]
            }
            Change::SwapCurrents => {
                from.swap(2, 3);
                &[]
            }
            Change::ReverseVoltages => &[0, 1],
            Change::ReverseCurrents => &[2, 3],
            Change::ReverseAxes => &[0, 1, 2, 3],
            // An angle that turns with the speed shows that the speed is right.
            Change::ReverseSpeed if has_angle => &[1, 3],
            Change::ReverseSpeed => {
                speed = -1.0;
                &[]
            }
            Change::ReverseUd => &[0],
            Change::ReverseUq => &[1],
            Change::ReverseId => &[2],
            Change::ReverseIq => &[3],
            _ => return Mending::default(),
        };
        reversed.iter().for_each(|place| sign[*place] = -sign[*place]);
    }
    let channels = ["ud", "uq", "id", "iq"];
    let is_changed = |place: &usize| from[*place] != channels[*place] || sign[*place] < 0.0;
    let changed: Vec<usize> = (0..channels.len()).filter(is_changed).collect();
    if speed > 0.0 && sign.iter().all(|sign| *sign > 0.0) {
        let pairs = changed.iter().map(|place| Some((channels[*place], Some(column(read, from[*place])?.header.clone()))));
        let pairs: Option<Vec<_>> = pairs.collect();
        return pairs.map(|pairs| Mending { option: advice::option(&Advice::MapColumns(pairs)), ..Mending::default() }).unwrap_or_default();
    }
    let lines = changed.iter().map(|place| line(read, channels[*place], from[*place], sign[*place]));
    let lines: Option<Vec<String>> = lines.chain((speed < 0.0).then(|| line(read, "omega_e", "omega_e", speed))).collect();
    Mending { lines: lines.unwrap_or_default(), ..Mending::default() }
}

/// Phases b and c exchanged, of currents and voltages.
fn phases(read: &[ReadColumn]) -> Mending {
    let header = |channel: &str| column(read, channel).map(|column| Some(column.header.clone()));
    let swapped = [("ib", "ic"), ("ic", "ib"), ("ub", "uc"), ("uc", "ub")].map(|(channel, from)| Some((channel, header(from)?)));
    let pairs: Vec<_> = swapped.into_iter().flatten().collect();
    // With one of them missing there is nothing to exchange; with only the voltages, they are not what turns backward.
    let is_whole = pairs.iter().any(|(channel, _)| *channel == "ib") && pairs.len() % 2 == 0;
    let option = if is_whole { advice::option(&Advice::MapColumns(pairs)) } else { None };
    Mending { option, ..Mending::default() }
}

/// From here on the voltages are not V.
const MILLI: f64 = 100.0;

/// Up to here line to line voltages explain it, in nearly all rows.
const LINE_TO_LINE: f64 = 1.8;

/// Per cent of half the DC voltage stay below this: in six-step operation they come to 127.
const MOST_PER_CENT: f64 = 130.0;

const SEEM_SHARES: &str = "they seem to be shares of u_dc (if they are V, add --unit ud=V,uq=V)";

const MAY_BE_DIGITS: &str = "digits of a converter, or rounded V (if so, add --unit ud=V,uq=V)";
const ALL_MAY_BE_DIGITS: &str = "digits of a converter, tenths, or rounded V and A (if so, add --unit ud=V,uq=V,id=A,iq=A)";

fn voltages(ratio: f64, rows: f64, most: f64, read: &[ReadColumn]) -> Mending {
    if ratio >= MILLI {
        return Mending { cause: Some("in mV, or digits of a converter".to_owned()), ..Mending::option("--unit ud=mV,uq=mV".to_owned()) };
    }
    if ratio <= LINE_TO_LINE && rows >= NEARLY_ALL {
        let lines = ["ud", "uq"].into_iter().map(|channel| line(read, channel, channel, 1.0 / 3.0_f64.sqrt()));
        let cause = Some("line to line, or RMS times sqrt 2 twice".to_owned());
        return Mending { cause, option: None, lines: lines.collect::<Option<_>>().unwrap_or_default() };
    }
    if most <= MOST_PER_CENT {
        return shares("per cent of u_dc, line to line, or in another unit", 0.005, " / 100", read);
    }
    digits("digits of a converter, or in another unit", read)
}

/// Voltages that are shares of the DC voltage: what the whole is, only the drive's documentation tells.
fn shares(cause: &str, scale: f64, of: &str, read: &[ReadColumn]) -> Mending {
    let whole = format!("# scale: 0.5{of} if 1 is half of u_dc, 0.57735{of} if u_dc / sqrt 3, 1{of} if u_dc");
    Mending { cause: Some(cause.to_owned()), option: None, lines: with_comment(times_u_dc(scale, read), whole) }
}

/// Voltages that are digits of a converter, or of a register.
fn digits(cause: &str, read: &[ReadColumn]) -> Mending {
    let whole = "# scale: 0.5 / 2048 if 2048 (12 bits) are half of u_dc; with 16 bits, 0.5 / 32768".to_owned();
    Mending { cause: Some(cause.to_owned()), option: None, lines: with_comment(times_u_dc(0.5 / 2048.0, read), whole) }
}

fn with_comment(mut lines: Vec<String>, comment: String) -> Vec<String> {
    if !lines.is_empty() {
        lines.push(comment);
    }
    lines
}

/// The voltages as shares of the DC voltage, where the log has one.
fn times_u_dc(scale: f64, read: &[ReadColumn]) -> Vec<String> {
    let columns = read.iter().filter(|column| column.is_voltage() && self::column(read, "u_dc").is_some());
    let line = |column: &ReadColumn| {
        let line = line(read, column.channel, column.channel, scale)?;
        Some(line.strip_suffix(" }")?.to_owned() + ", times = \"u_dc\" }")
    };
    columns.map(line).collect::<Option<_>>().unwrap_or_default()
}

/// A finding in a log with these columns, read with this number of pole pairs, with what mends it.
pub(crate) fn told(finding: &ColumnFinding, read: &[ReadColumn], pole_pairs: Option<u32>) -> Told {
    let (sentence, lines) = Mending::of(finding, read, pole_pairs).tell(finding);
    // Whoever writes that the voltages are V is believed, and warned.
    let is_stated = finding.is_of_unwritten_volts() && are_volts_written(read);
    Told { code: finding.code(), sentence, lines, refuses: finding.is_certain() && !is_stated }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(channel: &'static str, header: &str, unit: Unit) -> ReadColumn {
        ReadColumn { channel, header: header.to_owned(), unit, scale: 1.0, is_unit_written: false }
    }

    /// By hand: a shaft at 100 rad/s with 4 pole pairs has 400 electrical rad/s, 955 r/min and 15.9 turns a second.
    #[test]
    fn a_ratio_names_the_unit_and_the_pole_pairs() {
        let option = |ratio: f64, unit: Unit, pole_pairs: Option<u32>| {
            Mending::of(&ColumnFinding::SpeedUnit { ratio }, &[read("omega_e", "n", unit)], pole_pairs).option.unwrap_or_default()
        };
        assert_eq!(option(4.0, Unit::RadianPerSecond, None), "--unit omega_e=rad/s-mech --pole-pairs 4");
        assert_eq!(option(400.0 / 954.93, Unit::RadianPerSecond, None), "--unit omega_e=rpm-mech --pole-pairs 4");
        assert_eq!(option(1.0 / 9.5493, Unit::RadianPerSecond, None), "--unit omega_e=rpm-elec");
        assert_eq!(option(400.0 / 63.662, Unit::RadianPerSecond, None), "--unit omega_e=Hz-elec");
        assert_eq!(option(400.0 / 15.9155, Unit::RadianPerSecond, None), "--unit omega_e=Hz-mech --pole-pairs 4");
        assert_eq!(option(4.0, Unit::RpmElectrical, None), "--unit omega_e=rpm-mech --pole-pairs 4");
        assert_eq!(option(2.0, Unit::RpmMechanical, Some(2)), "--pole-pairs 4");
        // What was given is not asked for again.
        assert_eq!(option(4.0, Unit::RadianPerSecond, Some(4)), "--unit omega_e=rad/s-mech");
        assert_eq!(option(0.25, Unit::RadianPerSecond, Some(4)), "--unit theta_e=rad-mech");
        // Electrical r/min that were read as mechanical ones with 4 pole pairs.
        assert_eq!(option(0.25, Unit::RpmMechanical, Some(4)), "--unit omega_e=rpm-elec");
        assert_eq!(option(0.25, Unit::RadianPerSecond, None), "--unit theta_e=rad-mech --pole-pairs 4");
        assert_eq!(option(1.37, Unit::RadianPerSecond, None), "");
    }

    #[test]
    fn a_range_of_factors_names_the_unit() {
        let option = |low: f64, high: f64, unit: Unit, pole_pairs: Option<u32>| {
            let finding = ColumnFinding::SpeedScale { low, high, angle: false };
            Mending::of(&finding, &[read("omega_e", "n", unit)], pole_pairs).option.unwrap_or_default()
        };
        assert_eq!(option(3.0, 4.6, Unit::RpmMechanical, Some(4)), "--unit omega_e=rpm-elec");
        assert_eq!(option(7.7, 10.9, Unit::RadianPerSecond, None), "--unit omega_e=rpm-elec");
        assert_eq!(option(2.0, 2.6, Unit::RadianPerSecond, None), "--unit omega_e=rpm-mech --pole-pairs N");
        assert_eq!(option(2.0, 2.6, Unit::RadianPerSecond, Some(4)), "--unit omega_e=rpm-mech");
        // 12 pole pairs are three times as many as 4; a motor of 3 to 5 suits a range that is wider.
        assert_eq!(option(2.8, 3.3, Unit::RpmMechanical, Some(12)), "--pole-pairs 4");
        assert_eq!(option(0.23, 0.27, Unit::RpmMechanical, Some(1)), "--pole-pairs 4");
        assert_eq!(option(2.2, 4.2, Unit::RpmMechanical, Some(12)), "");
        // That of the shaft with 4 pole pairs, or Hz with any.
        assert_eq!(option(0.15, 0.26, Unit::RadianPerSecond, None), "");
        // Electrical rad/s, as r/min 9.55 times too low, with 4 pole pairs 2.39 times; of the shaft with 9 or 10 pole pairs, 8 to 10.
        let cause = |low: f64, high: f64, unit: Unit, pole_pairs: Option<u32>| {
            let finding = ColumnFinding::SpeedScale { low, high, angle: false };
            Mending::of(&finding, &[read("omega_e", "n", unit)], pole_pairs).cause.unwrap_or_default()
        };
        let of_electrical = cause(0.10, 0.12, Unit::RpmElectrical, None);
        assert_eq!(of_electrical, "it may be in electrical rad/s, or that of the shaft (rpm-mech); state which");
        let of_shaft = cause(0.38, 0.49, Unit::RpmMechanical, Some(4));
        assert_eq!(of_shaft, "it may be in electrical rad/s, or of a motor with 9 to 10 pole pairs; state which");
    }

    #[test]
    fn axes_become_a_map_or_lines_of_a_mapping_file() {
        let columns = [("ud", "Vd"), ("uq", "Vq"), ("id", "Id"), ("iq", "Iq")].map(|(channel, header)| read(channel, header, Unit::Volt));
        let of = |changes: &[Change]| axes(changes, &columns);
        assert_eq!(of(&[Change::SwapCurrents]).option.unwrap(), "--map id=Iq,iq=Id");
        assert_eq!(of(&[Change::SwapAxes]).option.unwrap(), "--map ud=Vq,uq=Vd,id=Iq,iq=Id");
        assert_eq!(of(&[Change::ReverseUd]).lines, ["ud = { column = \"Vd\", sign = -1 }"]);
        let both = of(&[Change::SwapVoltages, Change::ReverseUd]);
        assert_eq!(both.lines, ["ud = { column = \"Vq\", sign = -1 }", "uq = \"Vd\""]);
    }
}

//! Which column of the file is which, and in what unit.

use super::{Told, header::Header, resemblance::propose};
use crate::{
    channel::Channel,
    error::{FileError, Problem},
    quantity::Dimension,
    unit::{Named, Unit, in_header, says_electrical},
    wording::{list, nearest, shorten},
};

/// A column of the file that is read.
pub(super) struct Chosen {
    pub(super) channel: Channel,
    /// Its place in a row, from 0.
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) unit: Unit,
    /// Nobody asked for it: if its cells are no numbers it is left out, and the log is read.
    pub(super) dispensable: bool,
}

/// What a note says of a dispensable column that cannot be read.
pub(super) fn left_out(channel: Channel, error: &FileError) -> String {
    format!("{} is left out: {error}", channel.name())
}

/// One column for each of [`Channel::NEEDED`], in that order; then those of [`Channel::OPTIONAL`] that the file has.
pub(super) fn choose(header: &Header, told: &Told, notes: &mut Vec<String>) -> Result<Vec<Chosen>, FileError> {
    let indices = indices(&header.names, told).map_err(|error| error.at_line(header.line))?;
    let mut unsaid = Vec::new();
    let mut chosen: Vec<Chosen> = Vec::new();
    for (channel, index) in indices {
        let name = &header.names[index];
        let unit = unit(channel, name, told, &mut unsaid, notes).map_err(|error| error.at_line(header.line).in_column(name))?;
        chosen.push(Chosen { channel, index, header: name.clone(), unit, dispensable: false });
    }
    for channel in Channel::OPTIONAL.into_iter().filter(|channel| told.header(*channel).is_none()) {
        match unasked(channel, &header.names, told, &chosen, notes) {
            Ok(column) => chosen.extend(column),
            Err(error) => notes.push(left_out(channel, &error.at_line(header.line))),
        }
    }
    if !unsaid.is_empty() {
        let example = "--unit says otherwise, as in --unit omega=rpm-mech";
        notes.push(format!("units that no header names are taken as SI: {}; {example}", list(&unsaid)));
    }
    if let Some(pole_pairs) = told.pole_pairs.filter(|_| chosen.iter().all(|column| !column.unit.is_mechanical())) {
        notes.push(format!("the number of pole pairs, {pole_pairs}, is not used: the speed is electrical already"));
    }
    Ok(chosen)
}

/// An optional column that the user did not name, if the file has it and it is no other column already.
fn unasked(
    channel: Channel,
    names: &[String],
    told: &Told,
    taken: &[Chosen],
    notes: &mut Vec<String>,
) -> Result<Option<Chosen>, FileError> {
    let free = automatic(channel, names)?.filter(|index| taken.iter().all(|column| column.index != *index));
    let Some(index) = free else {
        if let Some(unit) = told.unit(channel) {
            let (name, unit) = (channel.name(), unit.name());
            notes.push(format!("the unit of {name}, {unit}, is not used: the log has no such column; --map {name}=COLUMN names one"));
        }
        return Ok(None);
    };
    let name = &names[index];
    // Its header is canonical or names the unit, so there is nothing unsaid.
    let unit = unit(channel, name, told, &mut Vec::new(), notes).map_err(|error| error.in_column(name))?;
    Ok(Some(Chosen { channel, index, header: name.clone(), unit, dispensable: true }))
}

/// The needed columns in their order, and the optional ones that the user named.
fn indices(names: &[String], told: &Told) -> Result<Vec<(Channel, usize)>, FileError> {
    let mut found = Vec::new();
    let mut missing = Vec::new();
    for channel in Channel::NEEDED {
        match told.header(channel) {
            Some(header) => found.push((channel, mapped(channel, header, names)?)),
            None => match automatic(channel, names)? {
                Some(index) => found.push((channel, index)),
                None => missing.push(channel),
            },
        }
    }
    if !missing.is_empty() {
        return Err(refuse_missing(&missing, names, &found));
    }
    for channel in Channel::OPTIONAL {
        if let Some(header) = told.header(channel) {
            found.push((channel, mapped(channel, header, names)?));
        }
    }
    for (place, (second, index)) in found.iter().enumerate() {
        if let Some((first, _)) = found[..place].iter().find(|(_, earlier)| earlier == index) {
            let shared = Problem::Shared { first: first.name(), second: second.name() };
            return Err(FileError::from(shared).in_column(&names[*index]));
        }
    }
    Ok(found)
}

fn refuse_missing(missing: &[Channel], names: &[String], found: &[(Channel, usize)]) -> FileError {
    // A column that is taken resembles nothing else.
    let mut free = names.to_vec();
    found.iter().for_each(|(_, index)| free[*index].clear());
    let mut proposals = Vec::new();
    for channel in missing {
        if let Some(index) = propose(*channel, &free) {
            proposals.push((channel.name(), std::mem::take(&mut free[index])));
        }
    }
    Problem::Missing { missing: missing.iter().map(|channel| channel.name()).collect(), present: names.to_vec(), proposals }.into()
}

/// The column that the user named.
fn mapped(channel: Channel, header: &str, names: &[String]) -> Result<usize, FileError> {
    let tiers = [positions(names, |name| name == header), positions(names, |name| name.to_lowercase() == header.to_lowercase())];
    only(channel, names, tiers)?.ok_or_else(|| {
        let within = names.iter().find(|name| name.to_lowercase().contains(&header.to_lowercase()));
        let likely = within.or_else(|| propose(channel, names).map(|index| &names[index])).map(String::as_str);
        // Of two short names that differ by a letter, one may be the other's opposite.
        let nearest = likely.or_else(|| nearest(header, names.iter().map(String::as_str).filter(|name| name.len() > 4)));
        Problem::MappedHeader {
            channel: channel.name(),
            header: header.to_owned(),
            present: names.to_vec(),
            nearest: nearest.map(|name| format!("'{}'", shorten(name))),
        }
        .into()
    })
}

/// The column with the canonical name; if there is none, in other case; if there is none, with a unit after it.
fn automatic(channel: Channel, names: &[String]) -> Result<Option<usize>, FileError> {
    let canonical = channel.name();
    let with_unit = |name: &str| {
        let (stem, unit) = in_header(name, channel.dimension());
        matches!(unit, Named::Unit(_)) && stem.eq_ignore_ascii_case(canonical)
    };
    let tiers = [
        positions(names, |name| name == canonical),
        positions(names, |name| name.eq_ignore_ascii_case(canonical)),
        positions(names, with_unit),
    ];
    only(channel, names, tiers)
}

fn positions(names: &[String], wanted: impl Fn(&str) -> bool) -> Vec<usize> {
    names.iter().enumerate().filter(|(_, name)| wanted(name)).map(|(index, _)| index).collect()
}

/// The one column of the first tier that has any.
fn only<const N: usize>(channel: Channel, names: &[String], tiers: [Vec<usize>; N]) -> Result<Option<usize>, FileError> {
    let Some(tier) = tiers.into_iter().find(|tier| !tier.is_empty()) else { return Ok(None) };
    if let [index] = tier[..] {
        return Ok(Some(index));
    }
    let headers: Vec<String> = tier.iter().map(|index| names[*index].clone()).collect();
    if headers.iter().all(|header| *header == headers[0]) {
        return Err(FileError::from(Problem::Duplicate { count: headers.len() }).in_column(&headers[0]));
    }
    Err(Problem::Ambiguous { channel: channel.name(), headers }.into())
}

/// The unit that was told; else the one the header names; else SI.
fn unit(channel: Channel, name: &str, told: &Told, unsaid: &mut Vec<String>, notes: &mut Vec<String>) -> Result<Unit, FileError> {
    let (dimension, canonical, si) = (channel.dimension(), channel.name(), channel.unit());
    let (stem, named) = in_header(name, dimension);
    let is_canonical = name.eq_ignore_ascii_case(canonical);
    let unit = match (told.unit(channel), named) {
        (Some(unit), _) => unit,
        _ if is_canonical => si,
        (None, Named::Unit(unit)) => unit,
        (None, Named::Unknown(text)) => {
            let units = Unit::of(dimension).map(Unit::name).collect();
            return Err(Problem::HeaderUnit { channel: canonical, text: text.to_owned(), units }.into());
        }
        (None, Named::Nothing) => {
            unsaid.push(format!("{canonical} ('{}') in {}", shorten(name), si.prose()));
            return Ok(si);
        }
    };
    if unit.is_mechanical() && told.pole_pairs.is_none() {
        let what = if dimension == Dimension::Angle { "angle" } else { "speed" };
        return Err(Problem::PolePairs { what, channel: canonical, unit: unit.prose(), electrical: electrical(unit).name() }.into());
    }
    let column = format!("{canonical}: column '{}'", shorten(name));
    let turning = matches!(unit, Unit::RadianPerSecond | Unit::HertzElectrical | Unit::Radian | Unit::Degree);
    if told.unit(channel).is_none() && !is_canonical && turning && !says_electrical(name) {
        notes.push(format!("{column} read as {}; if it is mechanical, say so with --unit", unit.prose()));
    } else if unit != si {
        let pole_pairs = told.pole_pairs.filter(|_| unit.is_mechanical());
        let with = pole_pairs.map(|n| format!(" with {n} pole pair{}", if n == 1 { "" } else { "s" }));
        notes.push(format!("{column} read as {}{}", unit.prose(), with.unwrap_or_default()));
    } else if told.header(channel).is_none() && ![stem, name].contains(&canonical) {
        notes.push(format!("{column} taken"));
    }
    Ok(unit)
}

fn electrical(mechanical: Unit) -> Unit {
    match mechanical {
        Unit::RpmMechanical => Unit::RpmElectrical,
        Unit::HertzMechanical => Unit::HertzElectrical,
        Unit::RadianMechanical => Unit::Radian,
        Unit::DegreeMechanical => Unit::Degree,
        _ => Unit::RadianPerSecond,
    }
}

#[cfg(test)]
mod tests {
    use crate::csv::{LogOptions, parse_log};
    use crate::unit::Unit;

    /// Notes, or the refusal, of a log with this header.
    fn told(header: &str, options: &LogOptions) -> Vec<String> {
        let rows: String = (0..3).map(|row| format!("{row}{}\n", ",1".repeat(header.split(',').count() - 1))).collect();
        match parse_log("a.csv", format!("{header}\n{rows}").as_bytes(), options) {
            Ok(read) => read.notes,
            Err(error) => vec![error.to_string()],
        }
    }

    fn map(pairs: &[(&str, &str)]) -> LogOptions {
        LogOptions { map: pairs.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(), ..LogOptions::default() }
    }

    #[test]
    fn canonical_names_are_si_without_a_word() {
        assert_eq!(told("t,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
        assert_eq!(told("t_s,ud [V],uq (V),id@A,iq A,omega_e_rad_s", &LogOptions::default()), [""; 0]);
        // The exact name wins over others of the same meaning.
        assert_eq!(told("t,T,t_ms,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
    }

    #[test]
    fn everything_else_is_noted() {
        let options = LogOptions { pole_pairs: Some(1), ..map(&[("omega", "speed_rpm")]) };
        assert_eq!(
            told("t_ms,UD,uq_mv,id,iq,speed_rpm", &options),
            [
                "t: column 't_ms' read as ms",
                "ud: column 'UD' taken",
                "uq: column 'uq_mv' read as mV",
                "omega_e: column 'speed_rpm' read as mechanical r/min with 1 pole pair"
            ]
        );
        let options = LogOptions { pole_pairs: Some(3), ..map(&[("omega_e", "speed"), ("ud", "v")]) };
        assert_eq!(
            told("t,v,uq,id,iq,speed", &options),
            [
                "units that no header names are taken as SI: ud ('v') in V and omega_e ('speed') in electrical rad/s; --unit says otherwise, as in --unit omega=rpm-mech",
                "the number of pole pairs, 3, is not used: the speed is electrical already",
            ]
        );
        assert_eq!(
            told("t,ud,uq,id,iq,speed_rad_s", &map(&[("omega_e", "speed_rad_s")])),
            ["omega_e: column 'speed_rad_s' read as electrical rad/s; if it is mechanical, say so with --unit"]
        );
    }

    #[test]
    fn what_was_told_wins_over_the_header() {
        let options = LogOptions { units: vec![("t".into(), Unit::Second), ("ud".into(), Unit::Millivolt)], ..LogOptions::default() };
        assert_eq!(told("t_ms,ud,uq,id,iq,omega_e", &options), ["ud: column 'ud' read as mV"]);
    }

    #[test]
    fn two_columns_for_one_and_one_for_two_are_refused() {
        let refused = |header, options: &LogOptions| told(header, options).concat();
        assert_eq!(
            refused("t,Id,ID,ud,uq,iq,omega_e", &LogOptions::default()),
            "a.csv, line 1: the columns 'Id' and 'ID' could each be id; choose one with --map id=COLUMN"
        );
        assert_eq!(
            refused("t,x,ud,uq,omega_e", &map(&[("id", "x"), ("iq", "X")])),
            "a.csv, line 1, column 'x': this column would be both id and iq; say which columns they are, with --map id=COLUMN,iq=COLUMN"
        );
        assert_eq!(
            refused("t,x,x,ud,uq,iq,omega_e", &map(&[("id", "x")])),
            "a.csv, line 1, column 'x': the header names this column 2 times; rename or remove all but one"
        );
        // Columns that are not read may be named as they like.
        assert_eq!(told("t,x,x,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
    }
}

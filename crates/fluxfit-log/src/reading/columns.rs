//! The choice of columns: which column of the file is which channel.

use super::{
    alias, chosen, chosen::ChosenColumn, finder::Finder, layout::Layout, options::ResolvedOptions, proposal::propose, resemblance, rms,
    table::Table,
};
use crate::{block::ColumnHead, channel::Channel, note::Note, problem::Problem};
use Channel::{Id, Iq, UA, UB, UC, Ud, Uq};
use fluxfit_files::{Advice, FileError};
use fluxfit_units::{
    Dimension, Unit,
    wording::{list, shorten},
};

/// The columns that a log needs, then the optional ones.
///
/// # Errors
/// If a needed column is missing, ambiguous or a current reference, or its unit is unknown.
pub(super) fn choose(
    table: &Table,
    layout: Option<&'static Layout>,
    options: &ResolvedOptions,
    notes: &mut Vec<Note>,
) -> Result<Vec<ChosenColumn>, FileError> {
    let (heads, line) = (table.heads(), table.line());
    let at_header = |error: FileError| line.map_or(error.clone(), |line| error.at_line(line));
    let without_numbers = || table.without_numbers();
    let (unreadable, passed_over) = (table.unreadable(), table.passed_over());
    let finder = Finder { heads, unreadable, without_numbers: &without_numbers, passed_over, layout, options };
    let found = finder.needed().map_err(at_header)?;
    refuse_rms(&found, heads, options).map_err(at_header)?;
    let mut unstated = Vec::new();
    let mut chosen: Vec<ChosenColumn> = Vec::new();
    for (channel, index) in found {
        let name = &heads[index].name;
        if resemblance::is_reference(name) && channel.dimension() == Dimension::Current {
            return Err(at_header(FileError::from(Problem::Reference { channel: channel.name() }).in_column(name)));
        }
        let column = finder.column(channel, index, false, &mut unstated, notes).map_err(|error| at_header(error.in_column(name)))?;
        chosen.push(column);
    }
    for channel in Channel::OPTIONAL.into_iter().chain([Channel::Run]) {
        if chosen.iter().any(|column| column.channel == channel) {
            continue;
        }
        match finder.optional(channel, &chosen, notes) {
            Ok(column) => chosen.extend(column),
            Err(error) => notes.push(chosen::left_out(channel, &at_header(error)).into()),
        }
    }
    let by_name = chosen.iter().filter(|column| column.is_alias && column.channel != Channel::ThetaE);
    let by_name: Vec<String> = by_name.map(|column| format!("{} = '{}'", column.channel.name(), shorten(&column.header))).collect();
    if !by_name.is_empty() {
        notes.push(format!("read by their usual names: {}; map those that are something else", list(&by_name)).into());
    }
    let shares: Vec<String> =
        chosen.iter().filter(|column| column.is_share).map(|column| format!("'{}'", shorten(&column.header))).collect();
    if !shares.is_empty() && options.shares_of_bus.is_empty() {
        notes.push(format!("phase voltages are the duty cycles {} times u_dc, without what is common to the three", list(&shares)).into());
    }
    if let Some((channel, _)) = unstated.first() {
        let columns: Vec<&str> = unstated.iter().map(|(_, column)| column.as_str()).collect();
        let sentence = format!("no header states these units, so SI is assumed: {}", list(&columns));
        notes.push(Note::with_advice(sentence, Advice::StateUnit { channel: channel.name(), unit: None }));
    }
    if let Some(pole_pairs) = options.pole_pairs.filter(|_| chosen.iter().all(|column| !column.unit.is_mechanical())) {
        notes.push(format!("the number of pole pairs, {pole_pairs}, is not needed to read this: the speed is electrical already").into());
    }
    Ok(chosen)
}

/// Whether a column holds root mean squares by its name, and the user states neither a unit nor a scale.
fn is_unstated_rms(channel: Channel, head: &ColumnHead, options: &ResolvedOptions) -> bool {
    rms::is_rms(head) && options.unit(channel).is_none() && options.factor(channel).abs() == 1.0
}

/// Refuses columns of root mean squares that would be read as peak values or as instantaneous ones.
fn refuse_rms(found: &[(Channel, usize)], heads: &[ColumnHead], options: &ResolvedOptions) -> Result<(), FileError> {
    let is_electric = |channel: Channel| rms::unit(channel).is_some() || Channel::PHASES.contains(&channel);
    let of_rms = found.iter().filter(|(channel, index)| is_electric(*channel) && is_unstated_rms(*channel, &heads[*index], options));
    let mut columns = Vec::new();
    for (channel, index) in of_rms {
        let header = &heads[*index].name;
        let Some(unit) = rms::unit(*channel) else { return Err(FileError::from(Problem::PhaseRms).in_column(header)) };
        columns.push((channel.name(), header.clone(), unit.name()));
    }
    if columns.is_empty() { Ok(()) } else { Err(Problem::Rms { columns }.into()) }
}

/// What the columns of a table seem to be, whether they make a log or not.
pub(super) struct Survey {
    /// Columns that would be read, with the unit unless a speed's has to be stated.
    pub(super) taken: Vec<(Channel, usize, Option<Unit>)>,
    /// Columns that resemble a needed channel, with the unit that the header states.
    pub(super) resembling: Vec<(Channel, usize, Option<Unit>)>,
    /// Columns that are shares of the DC voltage, and what the value 1 of the file is of it.
    pub(super) shares: Vec<(usize, f64)>,
}

/// Looks for every channel, and for columns that resemble a needed channel that was not found.
pub(super) fn survey(table: &Table, layout: Option<&'static Layout>, options: &ResolvedOptions) -> Survey {
    let (heads, without_numbers) = (table.heads(), table.without_numbers());
    // With pole pairs given, mechanical units are not an error.
    let mut with_pole_pairs = options.clone();
    with_pole_pairs.pole_pairs.get_or_insert(1);
    let finder = Finder { heads, unreadable: &[], without_numbers: &Vec::new, passed_over: None, layout, options: &with_pole_pairs };
    let mut survey = Survey { taken: Vec::new(), resembling: Vec::new(), shares: Vec::new() };
    let [voltages, currents] = [[Ud, Uq], [Id, Iq]].map(|pair| finder.pair(pair).unwrap_or_default());
    let duties = if voltages.iter().all(Option::is_some) { None } else { finder.duties() };
    let share = |channel: Channel| {
        let place = [UA, UB, UC].iter().position(|phase| *phase == channel)?;
        duties.map(|duties| duties[place])
    };
    for channel in Channel::all() {
        let index = match channel {
            Ud => Ok(voltages[0]),
            Uq => Ok(voltages[1]),
            Id => Ok(currents[0]),
            Iq => Ok(currents[1]),
            _ => finder.index(channel),
        };
        let index = index.map(|index| index.or_else(|| share(channel)));
        if let Ok(Some(index)) = index
            && survey.taken.iter().all(|(_, taken, _)| *taken != index)
        {
            let unit = finder.unit(channel, &heads[index], &mut Vec::new(), &mut Vec::new());
            let is_share = share(channel) == Some(index) || options.shares_of_bus.contains(&channel);
            let assumed = (channel.dimension() != Dimension::Speed && !is_share).then_some(channel.unit());
            let unit = if is_share { Err(()) } else { unit.map_err(drop) };
            let of_rms = rms::unit(channel).filter(|_| is_unstated_rms(channel, &heads[index], options));
            let unit = of_rms.map_or(unit, Ok);
            if is_share {
                let percent = if share(channel) == Some(index) && alias::is_percent(&heads[index]) { 0.01 } else { 1.0 };
                survey.shares.push((index, percent * options.factor(channel)));
            }
            survey.taken.push((channel, index, unit.ok().or(assumed)));
        }
    }
    let is_missing = |channel: &Channel| survey.taken.iter().all(|(taken, ..)| taken != channel);
    let missing: Vec<Channel> = Channel::NEEDED.into_iter().filter(is_missing).collect();
    let is_free = |index: usize| survey.taken.iter().all(|(_, taken, _)| *taken != index) && !without_numbers.contains(&index);
    let resembling = propose(&missing, heads, is_free).into_iter();
    survey.resembling = resembling.map(|found| (found.channel, found.index, options.unit(found.channel).or(found.unit))).collect();
    survey
}

#[cfg(test)]
mod tests {
    use crate::reading::{LogOptions, parse_log};
    use fluxfit_units::Unit;

    /// Notes, or the error, of a log with this header.
    fn notes(header: &str, options: &LogOptions) -> Vec<String> {
        let rows: String = (0..3).map(|row| format!("{row}{}\n", ",1".repeat(header.split(',').count() - 1))).collect();
        match parse_log("a.csv", format!("{header}\n{rows}").as_bytes(), options) {
            Ok(read) => read.notes.into_iter().map(|note| note.sentence).collect(),
            Err(error) => vec![error.to_string()],
        }
    }

    fn map(pairs: &[(&str, &str)]) -> LogOptions {
        LogOptions { map: pairs.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect(), ..LogOptions::default() }
    }

    #[test]
    fn canonical_names_are_si_and_need_no_note() {
        assert_eq!(notes("t,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
        assert_eq!(notes("t_s,ud [V],uq (V),id@A,iq A,omega_e_rad_s", &LogOptions::default()), [""; 0]);
        // The exact name has priority over other spellings.
        assert_eq!(notes("t,T,t_ms,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
    }

    #[test]
    fn everything_else_is_noted() {
        let options = LogOptions { pole_pairs: Some(1), ..map(&[("omega", "speed_rpm")]) };
        assert_eq!(
            notes("t_ms,UD,uq_mv,id,iq,speed_rpm", &options),
            [
                "t: column 't_ms' read as ms",
                "ud: column 'UD' used",
                "uq: column 'uq_mv' read as mV",
                "omega_e: column 'speed_rpm' read as mechanical r/min with 1 pole pair"
            ]
        );
        let options = LogOptions { pole_pairs: Some(3), ..map(&[("omega_e", "speed"), ("ud", "v")]) };
        assert_eq!(
            notes("t,v,uq,id,iq,speed", &options),
            [
                "no header states these units, so SI is assumed: ud ('v') in V and omega_e ('speed') in electrical rad/s",
                "the number of pole pairs, 3, is not needed to read this: the speed is electrical already",
            ]
        );
        assert_eq!(
            notes("t,ud,uq,id,iq,speed_rad_s", &map(&[("omega_e", "speed_rad_s")])),
            ["omega_e: column 'speed_rad_s' read as electrical rad/s; if it is mechanical, state its unit"]
        );
    }

    #[test]
    fn voltage_references_are_read_as_a_pair_or_not_at_all() {
        let both = notes("t,ud_ref,uq_ref,id,iq,omega_e", &LogOptions::default()).concat();
        assert!(both.contains("ud ('ud_ref') in V and uq ('uq_ref') in V"), "{both}");
        let mixed = notes("t,ud,uqq,id,iq,omega_e,uq_ref", &LogOptions::default()).concat();
        assert!(mixed.contains("the column uq is missing"), "{mixed}");
        assert_eq!(notes("t,ud,uq,id,iq,omega_e,ud_ref,uq_ref", &LogOptions::default()), [""; 0]);
    }

    #[test]
    fn a_column_called_time_is_the_time() {
        assert_eq!(
            notes("Time,ud,uq,id,iq,omega_e", &LogOptions::default()),
            ["no header states these units, so SI is assumed: t ('Time') in s"]
        );
        assert_eq!(notes("Time (ms),ud,uq,id,iq,omega_e", &LogOptions::default()), ["t: column 'Time (ms)' read as ms"]);
    }

    #[test]
    fn a_stated_unit_overrides_the_header() {
        let options = LogOptions { units: vec![("t".into(), Unit::Second), ("ud".into(), Unit::Millivolt)], ..LogOptions::default() };
        assert_eq!(notes("t_ms,ud,uq,id,iq,omega_e", &options), ["ud: column 'ud' read as mV"]);
    }

    #[test]
    fn two_columns_for_one_and_one_for_two_are_refused() {
        let refused = |header, options: &LogOptions| notes(header, options).concat();
        assert_eq!(
            refused("t,Id,ID,ud,uq,iq,omega_e", &LogOptions::default()),
            "a.csv, line 1: the columns 'Id' and 'ID' could each be id; map one of them to id"
        );
        assert_eq!(
            refused("t,x,ud,uq,omega_e", &map(&[("id", "x"), ("iq", "X")])),
            "a.csv, line 1, column 'x': this column would be both id and iq; map each of them to a column of its own"
        );
        assert_eq!(
            refused("t,x,x,ud,uq,iq,omega_e", &map(&[("id", "x")])),
            "a.csv, line 1, column 'x': the header has this name 2 times; rename or remove all but one"
        );
        // Columns that are not read may have any name.
        assert_eq!(notes("t,x,x,ud,uq,id,iq,omega_e", &LogOptions::default()), [""; 0]);
    }
}

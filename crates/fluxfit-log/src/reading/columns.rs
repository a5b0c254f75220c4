//! The choice of columns: which column of the file is which channel.

use super::{chosen, chosen::ChosenColumn, finder::Finder, layout::Layout, options::ResolvedOptions, resemblance, rms, table::Table};
use crate::{block::ColumnHead, channel::Channel, note::Note, problem::Problem};
use fluxfit_files::{Advice, FileError};
use fluxfit_units::{
    Dimension,
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
    let first_cells = || table.first_cells();
    let (unreadable, lists, passed_over) = (table.unreadable(), table.lists(), table.passed_over());
    let finder = Finder { heads, unreadable, lists, first_cells: &first_cells, passed_over, layout, options };
    let several = |error: FileError| finder.several_logs().map_or(error, FileError::from);
    let found = finder.needed().map_err(several).map_err(at_header)?;
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
    if let Some(note) = finder.unused_time() {
        notes.push(note.into());
    }
    if let Some(pole_pairs) = options.pole_pairs.filter(|_| chosen.iter().all(|column| !column.unit.is_mechanical())) {
        notes.push(format!("the number of pole pairs, {pole_pairs}, is not needed to read this: the speed is electrical already").into());
    }
    Ok(chosen)
}

/// Refuses columns of root mean squares that would be read as peak values or as instantaneous ones.
fn refuse_rms(found: &[(Channel, usize)], heads: &[ColumnHead], options: &ResolvedOptions) -> Result<(), FileError> {
    let is_electric = |channel: Channel| rms::unit(channel).is_some() || Channel::PHASES.contains(&channel);
    let of_rms = found.iter().filter(|(channel, index)| is_electric(*channel) && rms::is_unstated(*channel, &heads[*index], options));
    let mut columns = Vec::new();
    for (channel, index) in of_rms {
        let header = &heads[*index].name;
        let Some(unit) = rms::unit(*channel) else { return Err(FileError::from(Problem::PhaseRms).in_column(header)) };
        columns.push((channel.name(), header.clone(), unit.name()));
    }
    if columns.is_empty() { Ok(()) } else { Err(Problem::Rms { columns }.into()) }
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
    fn a_stated_unit_that_contradicts_the_header_is_noted() {
        let stated = |header: &str, name: &str, unit: Unit| {
            let options = LogOptions { units: vec![(name.into(), unit)], pole_pairs: Some(1), ..map(&[(name, header)]) };
            let columns = ["t", "ud", "uq", "id", "iq", "omega_e"].map(|column| if column == name { header } else { column });
            notes(&columns.join(","), &options).into_iter().find(|note| note.contains("as you state"))
        };
        let expected = "ud: column 'ud [mV]' is read as V, as you state; the file says mV";
        assert_eq!(stated("ud [mV]", "ud", Unit::Volt).as_deref(), Some(expected));
        let expected = "iq: column 'iq_pu' is read as A, as you state; the file says pu";
        assert_eq!(stated("iq_pu", "iq", Unit::Ampere).as_deref(), Some(expected));
        let expected = "omega_e: column 'n_el [rpm]' is read as mechanical r/min, as you state; the file says electrical r/min";
        assert_eq!(stated("n_el [rpm]", "omega_e", Unit::RpmMechanical).as_deref(), Some(expected));
        assert!(stated("n [rpm]", "omega_e", Unit::RadianPerSecond).is_some_and(|note| note.ends_with("the file says mechanical r/min")));
        for (header, name, unit) in [
            ("n [rpm]", "omega_e", Unit::RpmElectrical),
            ("id [A]", "id", Unit::AmpereRms),
            ("id [Arms]", "id", Unit::AmpereRms),
            ("ud", "ud", Unit::Millivolt),
        ] {
            assert_eq!(stated(header, name, unit), None, "{header}");
        }
    }

    #[test]
    fn shares_of_a_base_value_need_a_scale() {
        let of = |header: &str, channel: &str| notes(&"t,ud,uq,id,iq,omega_e".replacen(channel, header, 1), &map(&[(channel, header)]));
        assert_eq!(
            of("ud [%]", "ud"),
            ["a.csv, line 1, column 'ud [%]': \"%\" in the header is a share of a base value, which the log does not state; write into a \
              mapping file ud = { column = \"ud [%]\", scale = .. }, where the scale is the base value in V divided by 100"]
        );
        let per_unit = of("speed_pu", "omega_e");
        assert!(per_unit[0].ends_with("where the scale is the base value in electrical rad/s"), "{per_unit:?}");
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
        let options = LogOptions { pole_pairs: Some(3), ..map(&[("omega_e", "el_omega"), ("ud", "v")]) };
        assert_eq!(
            notes("t,v,uq,id,iq,el_omega", &options),
            [
                "no header states these units, so SI is assumed: ud ('v') in V and omega_e ('el_omega') in electrical rad/s",
                "the number of pole pairs, 3, is not needed to read this: the speed is electrical already",
            ]
        );
        assert_eq!(
            notes("t,ud,uq,id,iq,speed_rad_s", &map(&[("omega_e", "speed_rad_s")])),
            [
                "a.csv, line 1, column 'speed_rad_s': this speed is in rad/s, and nothing states whether it is electrical or that of the shaft; state which"
            ]
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
        let contradicted = "t: column 't_ms' is read as s, as you state; the file says ms";
        assert_eq!(notes("t_ms,ud,uq,id,iq,omega_e", &options), [contradicted, "ud: column 'ud' read as mV"]);
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

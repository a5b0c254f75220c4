//! Which column of the file is which, in what unit, and times what.

use super::{
    Told, doubt,
    layout::{Layout, is_called},
    resemblance::propose,
    table::Table,
};
use crate::block::{Head, Wanted};
use crate::{channel::Channel, problem::Problem};
use Channel::{IA, IB, Id, Iq, OmegaE, T, ThetaE, UA, UB, Ud, Uq};
use fluxfit_files::FileError;
use fluxfit_units::{
    Dimension,
    number::significant,
    unit::{Named, Unit, in_header, in_units_row, says_electrical},
    wording::{list, nearest, shorten},
};

/// A column of the file that is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chosen {
    pub(super) channel: Channel,
    /// Its place in a row, from 0.
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) unit: Unit,
    pub(super) pole_pairs: u32,
    /// Times this, besides its unit.
    pub(super) scale: f64,
    /// Nobody asked for it: if its cells are no numbers it is left out, and the log is read.
    pub(super) dispensable: bool,
}

impl Chosen {
    /// Turns what the file has into SI, in place.
    pub(super) fn to_si(&self, values: &mut [f64]) {
        self.unit.to_si(values, self.pole_pairs);
        if self.scale != 1.0 {
            values.iter_mut().for_each(|value| *value *= self.scale);
        }
    }

    /// SI units in one of the file's.
    pub(super) fn factor(&self) -> f64 {
        let mut one = [1.0];
        self.to_si(&mut one);
        one[0]
    }

    pub(super) fn wanted(&self) -> Wanted {
        Wanted { index: self.index, header: self.header.clone(), is_time: self.channel == T, dispensable: self.dispensable }
    }
}

/// What was read as what.
pub(super) fn described(chosen: &[Chosen]) -> String {
    let said = |column: &Chosen| {
        let factor = if column.scale == 1.0 { String::new() } else { format!(", times {}", significant(column.scale, 6)) };
        format!("{} = '{}' ({}{factor})", column.channel.name(), shorten(&column.header), column.unit.prose())
    };
    chosen.iter().map(said).collect::<Vec<_>>().join(", ")
}

/// What a note says of a dispensable column that cannot be read.
pub(super) fn left_out(channel: Channel, error: &FileError) -> String {
    format!("{} is left out: {error}", channel.name())
}

/// The columns that make a log; then those that it may have besides.
pub(super) fn choose(
    table: &Table,
    layout: Option<&'static Layout>,
    told: &Told,
    notes: &mut Vec<String>,
) -> Result<Vec<Chosen>, FileError> {
    let (heads, line) = (table.heads(), table.line());
    let at_header = |error: FileError| line.map_or(error.clone(), |line| error.at_line(line));
    let finder = Finder { heads, unreadable: table.unreadable(), layout, told };
    let found = finder.needed().map_err(at_header)?;
    let mut unsaid = Vec::new();
    let mut chosen: Vec<Chosen> = Vec::new();
    for (channel, index) in found {
        let name = &heads[index].name;
        if doubt::is_reference(name) && channel.dimension() == Dimension::Current {
            return Err(at_header(FileError::from(Problem::Reference { channel: channel.name() }).in_column(name)));
        }
        let column = finder.column(channel, index, false, &mut unsaid, notes).map_err(|error| at_header(error.in_column(name)))?;
        chosen.push(column);
    }
    let optional = Channel::OPTIONAL.into_iter().chain([Channel::Run]);
    for channel in optional {
        if chosen.iter().any(|column| column.channel == channel) {
            continue;
        }
        match finder.unasked(channel, &chosen, notes) {
            Ok(column) => chosen.extend(column),
            Err(error) => notes.push(left_out(channel, &at_header(error))),
        }
    }
    if !unsaid.is_empty() {
        let example = "--unit says otherwise, as in --unit omega=rpm-mech";
        notes.push(format!("units that no header names are taken as SI: {}; {example}", list(&unsaid)));
    }
    if let Some(pole_pairs) = told.pole_pairs.filter(|_| chosen.iter().all(|column| !column.unit.is_mechanical())) {
        notes.push(format!("the number of pole pairs, {pole_pairs}, is not needed to read this: the speed is electrical already"));
    }
    Ok(chosen)
}

/// What the columns of a table seem to be, whether that makes a log or not.
pub(super) struct Survey {
    pub(super) taken: Vec<(Channel, usize, Unit)>,
    /// With the unit that the header names, if it does.
    pub(super) resembling: Vec<(Channel, usize, Option<Unit>)>,
}

/// Looks for every channel, and for what resembles those that a log needs and that were not found.
pub(super) fn survey(heads: &[Head], layout: Option<&'static Layout>, told: &Told) -> Survey {
    // Without pole pairs no unit is refused for want of them.
    let bold = Told { pole_pairs: told.pole_pairs.or(Some(1)), ..told.clone() };
    let finder = Finder { heads, unreadable: &[], layout, told: &bold };
    let mut survey = Survey { taken: Vec::new(), resembling: Vec::new() };
    let voltages = finder.pair([Ud, Uq]).unwrap_or_default();
    for channel in Channel::all() {
        let place = match channel {
            Ud => Ok(voltages[0]),
            Uq => Ok(voltages[1]),
            _ => finder.place(channel),
        };
        if let Ok(Some(index)) = place
            && survey.taken.iter().all(|(_, taken, _)| *taken != index)
        {
            let unit = finder.unit(channel, &heads[index], &mut Vec::new(), &mut Vec::new());
            survey.taken.push((channel, index, unit.unwrap_or(channel.unit())));
        }
    }
    let mut free = finder.names();
    survey.taken.iter().for_each(|(_, index, _)| free[*index].clear());
    for channel in Channel::NEEDED.into_iter().filter(|channel| survey.taken.iter().all(|(taken, ..)| taken != channel)) {
        if let Some(index) = propose(channel, &free) {
            free[index].clear();
            let head = &heads[index];
            let in_name = in_header(&head.name, channel.dimension()).1;
            let in_row = head.unit.as_deref().map(|unit| in_units_row(unit, &head.name, channel.dimension()));
            let unit = [Some(in_name), in_row].into_iter().flatten().find_map(|named| match named {
                Named::Unit(unit) => Some(unit),
                _ => None,
            });
            survey.resembling.push((channel, index, told.unit(channel).or(unit)));
        }
    }
    survey
}

/// Who looks for columns.
struct Finder<'a> {
    heads: &'a [Head],
    /// Names of columns that hold no numbers.
    unreadable: &'a [String],
    layout: Option<&'static Layout>,
    told: &'a Told,
}

impl Finder<'_> {
    fn names(&self) -> Vec<String> {
        self.heads.iter().map(|head| head.name.clone()).collect()
    }

    /// The columns without which there is no log: time, voltages, currents, speed; or what these are made of. Then those that the
    /// user named besides.
    fn needed(&self) -> Result<Vec<(Channel, usize)>, FileError> {
        let mut found: Vec<(Channel, usize)> = Vec::new();
        let mut missing: Vec<Channel> = Vec::new();
        let mut take = |channel: Channel, place: Option<usize>| match place {
            Some(index) => found.push((channel, index)),
            None => missing.push(channel),
        };
        // An angle that nobody needs refuses nothing.
        let theta = self.place(ThetaE);
        match self.place(T)? {
            None if self.sample_period().is_some() => {}
            place => take(T, place),
        }
        let mut of_phases = false;
        for (dq, phases) in [([Ud, Uq], [UA, UB, Channel::UC]), ([Id, Iq], [IA, IB, Channel::IC])] {
            let places = self.pair(dq)?;
            let is_there = places.iter().all(Option::is_some);
            let of_phase = if is_there { [None; 3] } else { [self.place(phases[0])?, self.place(phases[1])?, self.place(phases[2])?] };
            if let [Some(_), Some(_), third] = of_phase {
                of_phases = true;
                phases.into_iter().zip(of_phase).take(2).for_each(|(channel, place)| take(channel, place));
                if third.is_some() {
                    take(phases[2], third);
                }
            } else {
                dq.into_iter().zip(places).for_each(|(channel, place)| take(channel, place));
            }
        }
        let speed = self.place(OmegaE)?;
        let is_told = matches!(theta, Ok(Some(_)));
        if speed.is_some() || !is_told {
            take(OmegaE, speed);
        }
        // Currents in both frames tell the angle too.
        let currents = [self.place(IA)?, self.place(IB)?];
        let of_currents =
            of_phases && !is_told && currents.iter().all(Option::is_some) && self.place(Id)?.is_some() && self.place(Iq)?.is_some();
        if of_currents {
            [IA, IB, Channel::IC]
                .into_iter()
                .zip([currents[0], currents[1], self.place(Channel::IC)?])
                .filter(|(_, place)| place.is_some())
                .for_each(|(channel, place)| take(channel, place));
        } else if of_phases || speed.is_none() && is_told {
            take(ThetaE, theta?);
        }
        if !missing.is_empty() {
            return Err(self.refuse_missing(&missing, &found));
        }
        for channel in Channel::all() {
            if let Some(header) = self.told.header(channel)
                && found.iter().all(|(taken, _)| *taken != channel)
            {
                found.push((channel, mapped(channel, header, &self.names())?));
            }
        }
        for (place, (second, index)) in found.iter().enumerate() {
            if let Some((first, _)) = found[..place].iter().find(|(_, earlier)| earlier == index) {
                let shared = Problem::Shared { first: first.name(), second: second.name() };
                return Err(FileError::from(shared).in_column(&self.heads[*index].name));
            }
        }
        Ok(found)
    }

    /// The columns of both axes. Where neither voltage is there, their references, which are what most drives log; never one beside
    /// a voltage of another kind.
    fn pair(&self, [d, q]: [Channel; 2]) -> Result<[Option<usize>; 2], FileError> {
        let places = [self.place(d)?, self.place(q)?];
        let reference = |channel: Channel| {
            let wanted = format!("{}_ref", channel.name());
            self.heads.iter().position(|head| in_header(&head.name, channel.dimension()).0.eq_ignore_ascii_case(&wanted))
        };
        match places {
            [None, None] if d == Ud => Ok(match [reference(d), reference(q)] {
                both @ [Some(_), Some(_)] => both,
                _ => places,
            }),
            _ => Ok(places),
        }
    }

    /// s between rows that nobody measured.
    fn sample_period(&self) -> Option<f64> {
        self.told.sample_period.or(self.layout.and_then(|layout| layout.sample_period))
    }

    /// The column of a channel: the one that was told; else the layout's; else the one with the canonical name, or an MDF or
    /// MATLAB time.
    fn place(&self, channel: Channel) -> Result<Option<usize>, FileError> {
        let names = self.names();
        if let Some(header) = self.told.header(channel) {
            return mapped(channel, header, &names).map(Some);
        }
        if let Some(column) = self.layout.and_then(|layout| layout.column(channel)) {
            let tiers = [positions(&names, |name| name == column.header), positions(&names, |name| is_called(name, column.header))];
            if let Some(index) = only(channel, &names, tiers)? {
                return Ok(Some(index));
            }
        }
        let found = automatic(channel, self.heads)?;
        let is_time = || self.heads.iter().position(|head| head.is_time);
        Ok(if channel == T { found.or_else(is_time) } else { found })
    }

    fn column(
        &self,
        channel: Channel,
        index: usize,
        dispensable: bool,
        unsaid: &mut Vec<String>,
        notes: &mut Vec<String>,
    ) -> Result<Chosen, FileError> {
        let head = &self.heads[index];
        Ok(Chosen {
            channel,
            index,
            header: head.name.clone(),
            unit: self.unit(channel, head, unsaid, notes)?,
            pole_pairs: self.told.pole_pairs.unwrap_or(1),
            scale: self.told.factor(channel),
            dispensable,
        })
    }

    /// An optional column that the user did not name, if the file has it and it is no other column already.
    fn unasked(&self, channel: Channel, taken: &[Chosen], notes: &mut Vec<String>) -> Result<Option<Chosen>, FileError> {
        let Some(index) = self.place(channel)?.filter(|index| taken.iter().all(|column| column.index != *index)) else {
            if let Some(unit) = self.told.unit(channel) {
                let (name, unit) = (channel.name(), unit.name());
                notes.push(format!("the unit of {name}, {unit}, is not used: the log has no such column; --map {name}=COLUMN names one"));
            }
            return Ok(None);
        };
        // Its header is canonical or names the unit, so there is nothing unsaid.
        let column = self.column(channel, index, true, &mut Vec::new(), notes);
        column.map(Some).map_err(|error| error.in_column(&self.heads[index].name))
    }

    fn refuse_missing(&self, missing: &[Channel], found: &[(Channel, usize)]) -> FileError {
        // A column that is taken resembles nothing else, and a reference is no measurement.
        let present = self.names();
        let mut free = present.clone();
        found.iter().for_each(|(_, index)| free[*index].clear());
        let currents: Vec<Channel> = missing.iter().copied().filter(|channel| channel.dimension() == Dimension::Current).collect();
        let mut references = Vec::new();
        for name in free.iter_mut().filter(|name| doubt::is_reference(name)) {
            if currents.iter().any(|channel| propose(*channel, std::slice::from_ref(name)).is_some()) {
                references.push(std::mem::take(name));
            }
        }
        let resembles = |name: &&String| missing.iter().any(|channel| propose(*channel, std::slice::from_ref(*name)).is_some());
        let unreadable: Vec<String> = self.unreadable.iter().filter(resembles).cloned().collect();
        let mut proposals = Vec::new();
        for channel in missing {
            if let Some(index) = propose(*channel, &free) {
                proposals.push((channel.name(), std::mem::take(&mut free[index])));
            }
        }
        Problem::Missing { missing: missing.iter().map(|channel| channel.name()).collect(), present, proposals, references, unreadable }
            .into()
    }

    /// The unit that was told; else the layout's; else the one that the header or the row of units names; else SI.
    fn unit(&self, channel: Channel, head: &Head, unsaid: &mut Vec<String>, notes: &mut Vec<String>) -> Result<Unit, FileError> {
        let (dimension, canonical, si, name) = (channel.dimension(), channel.name(), channel.unit(), head.name.as_str());
        if dimension == Dimension::Ratio {
            return Ok(si);
        }
        let (stem, in_name) = in_header(name, dimension);
        let named = match (in_name, head.unit.as_deref()) {
            (Named::Unit(_), _) | (_, None) => in_name,
            (_, Some(unit)) => in_units_row(unit, name, dimension),
        };
        // Of a structure, the field.
        let field = name.rsplit_once('.').map_or(name, |(_, field)| field);
        let is_canonical = field.eq_ignore_ascii_case(canonical);
        let of_layout = self.layout.and_then(|layout| layout.column(channel)).filter(|column| is_called(name, column.header));
        let told = self.told.unit(channel);
        let unit = match (told, of_layout, named) {
            (Some(unit), ..) => unit,
            // A header that names its unit knows better than a table of what is usual.
            (None, Some(_), Named::Unit(unit)) if !is_canonical => unit,
            (None, Some(column), _) if head.unit.is_none() => column.unit,
            (None, _, Named::Unit(unit)) if !is_canonical || head.unit.is_some() => unit,
            _ if is_canonical && head.unit.is_none() => si,
            (None, _, Named::Unknown(text)) => {
                let units = Unit::of(dimension).map(Unit::name).collect();
                return Err(Problem::HeaderUnit { channel: canonical, text: text.to_owned(), units }.into());
            }
            _ => {
                unsaid.push(format!("{canonical} ('{}') in {}", shorten(name), si.prose()));
                return Ok(si);
            }
        };
        if unit.is_mechanical() && self.told.pole_pairs.is_none() {
            let what = if dimension == Dimension::Angle { "angle" } else { "speed" };
            return Err(Problem::PolePairs { what, channel: canonical, unit: unit.prose(), electrical: electrical(unit).name() }.into());
        }
        let column = format!("{canonical}: column '{}'", shorten(name));
        let turning = matches!(unit, Unit::RadianPerSecond | Unit::HertzElectrical | Unit::Radian | Unit::Degree);
        let is_sure = told.is_some() || is_canonical || of_layout.is_some() || says_electrical(name);
        if turning && !is_sure {
            notes.push(format!("{column} read as {}; if it is mechanical, say so with --unit", unit.prose()));
        } else if unit != si {
            let pole_pairs = self.told.pole_pairs.filter(|_| unit.is_mechanical());
            let with = pole_pairs.map(|n| format!(" with {n} pole pair{}", if n == 1 { "" } else { "s" }));
            notes.push(format!("{column} read as {}{}", unit.prose(), with.unwrap_or_default()));
        } else if self.told.header(channel).is_none() && of_layout.is_none() && ![stem, field].contains(&canonical) {
            notes.push(format!("{column} taken"));
        }
        Ok(unit)
    }
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

/// The column with the canonical name; if there is none, in other case; if there is none, with a unit after it; of a structure,
/// the field of that name; of the time, the one called so.
fn automatic(channel: Channel, heads: &[Head]) -> Result<Option<usize>, FileError> {
    let canonical = channel.name();
    let names: Vec<String> = heads.iter().map(|head| head.name.clone()).collect();
    let with_unit = |name: &str| {
        let (stem, unit) = in_header(name, channel.dimension());
        matches!(unit, Named::Unit(_)) && stem.eq_ignore_ascii_case(canonical)
    };
    let has_group_times = heads.iter().any(|head| head.is_time);
    let field = |name: &str| name.rsplit_once('.').is_some_and(|(_, field)| field.eq_ignore_ascii_case(canonical));
    let tiers = [
        positions(&names, |name| name == canonical),
        positions(&names, |name| name.eq_ignore_ascii_case(canonical)),
        positions(&names, with_unit),
        positions(&names, field),
        // Of the times of groups, each group takes its own.
        positions(&names, |name| channel == T && !has_group_times && in_header(name, Dimension::Time).0.eq_ignore_ascii_case("time")),
    ];
    only(channel, &names, tiers)
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
    use crate::reading::{LogOptions, parse_log};
    use fluxfit_units::unit::Unit;

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
                "the number of pole pairs, 3, is not needed to read this: the speed is electrical already",
            ]
        );
        assert_eq!(
            told("t,ud,uq,id,iq,speed_rad_s", &map(&[("omega_e", "speed_rad_s")])),
            ["omega_e: column 'speed_rad_s' read as electrical rad/s; if it is mechanical, say so with --unit"]
        );
    }

    #[test]
    fn voltage_references_are_taken_as_a_pair_or_not_at_all() {
        let both = told("t,ud_ref,uq_ref,id,iq,omega_e", &LogOptions::default()).concat();
        assert!(both.contains("ud ('ud_ref') in V and uq ('uq_ref') in V"), "{both}");
        let mixed = told("t,ud,uqq,id,iq,omega_e,uq_ref", &LogOptions::default()).concat();
        assert!(mixed.contains("the column uq is missing"), "{mixed}");
        assert_eq!(told("t,ud,uq,id,iq,omega_e,ud_ref,uq_ref", &LogOptions::default()), [""; 0]);
    }

    #[test]
    fn the_time_may_be_called_so() {
        assert_eq!(
            told("Time,ud,uq,id,iq,omega_e", &LogOptions::default()),
            ["units that no header names are taken as SI: t ('Time') in s; --unit says otherwise, as in --unit omega=rpm-mech"]
        );
        assert_eq!(told("Time (ms),ud,uq,id,iq,omega_e", &LogOptions::default()), ["t: column 'Time (ms)' read as ms"]);
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

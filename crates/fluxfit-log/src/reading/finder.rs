//! Finds the columns of a table that make a log, and their units.

use super::{
    alias,
    chosen::ChosenColumn,
    counts,
    doubt::doubt,
    duty,
    layout::{Layout, NotALog, is_called},
    line_to_line,
    names::{automatic, mapped, only, positions},
    options::ResolvedOptions,
    polar, power_meter,
    proposal::{Proposed, current_unit_of_tool, is_angular, propose, propose_needed, unit_of_speed, unit_of_tool},
    resemblance::{fit, has_other_unit, is_reference},
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    csv::FirstCells,
    header_unit::{HeaderUnit, contradicted, share, split_header, states_electrical, states_mechanical, unit_in_row, unit_within},
    instant::Instants,
    missing_columns::LineToLine,
    note::Note,
    problem::Problem,
};
use Channel::{IA, IAlpha, IB, IBeta, IC, Id, Iq, OmegaE, T, ThetaE, UA, UAlpha, UB, UBeta, UC, UDc, Ud, Uq};
use fluxfit_files::{Advice, FileError, csv::header::UNNAMED};
use fluxfit_units::{Dimension, Unit, wording::shorten};

/// Of a matrix over two quantities at least so many names are numbers.
const FEWEST_NUMBERS: usize = 3;

/// What the columns of a table with a row for each value are called, as time series databases and data frames write them: that of the
/// values, and that of their quantities' names.
const VALUES: [&str; 3] = ["value", "values", "val"];
const QUANTITIES: [&str; 11] =
    ["field", "variable", "name", "signal", "signal_name", "channel", "metric", "tag", "sensor", "parameter", "series"];

/// Finds columns by mapping, layout and name.
pub(super) struct Finder<'a> {
    pub(super) heads: &'a [ColumnHead],
    /// Names of columns that hold no numbers and are not among `heads`.
    pub(super) unreadable: &'a [String],
    /// Names of columns that hold a list in each row and are not among `heads`.
    pub(super) lists: &'a [String],
    /// What the first rows tell of the columns of `heads`.
    pub(super) first_cells: &'a dyn Fn() -> Vec<FirstCells>,
    /// Why the log itself cannot be read, if it seems to be in a part of the file that cannot.
    pub(super) passed_over: Option<&'a Problem>,
    pub(super) layout: Option<&'static Layout>,
    pub(super) options: &'a ResolvedOptions,
}

/// The needed channels.
pub(super) struct Needed {
    /// Those with a column.
    pub(super) found: Vec<(Channel, usize)>,
    /// Those that no column is read as.
    pub(super) missing: Vec<Channel>,
}

impl Finder<'_> {
    /// The names of all columns.
    pub(super) fn names(&self) -> Vec<String> {
        self.heads.iter().map(|head| head.name.clone()).collect()
    }

    /// The columns that a log needs: time, voltages, currents and speed, or the phase quantities and the angle that these are
    /// computed from. Then the further ones that the user mapped.
    pub(super) fn needed(&self) -> Result<Vec<(Channel, usize)>, FileError> {
        let Needed { mut found, missing } = self.found_and_missing()?;
        if !missing.is_empty() {
            return Err(self.refuse_missing(&missing, &found));
        }
        self.add_mapped(&mut found)?;
        for (place, (second, index)) in found.iter().enumerate() {
            if let Some((first, _)) = found[..place].iter().find(|(_, earlier)| earlier == index) {
                let shared = Problem::Shared { first: first.name(), second: second.name() };
                return Err(FileError::from(shared).in_column(&self.heads[*index].name));
            }
        }
        Ok(found)
    }

    /// Looks for the needed channels.
    pub(super) fn found_and_missing(&self) -> Result<Needed, FileError> {
        let mut found: Vec<(Channel, usize)> = Vec::new();
        let mut missing: Vec<Channel> = Vec::new();
        let mut take = |channel: Channel, index: Option<usize>| match index {
            Some(index) => found.push((channel, index)),
            None => missing.push(channel),
        };
        // An error about the angle counts only if the angle is needed.
        let theta = self.index(ThetaE);
        if !self.options.counts_rows() {
            match self.index(T)? {
                None if self.sample_period().is_some() => {}
                index => take(T, index),
            }
        }
        let mut has_phases = false;
        for (dq, phases, stator) in [([Ud, Uq], [UA, UB, UC], [UAlpha, UBeta]), ([Id, Iq], [IA, IB, IC], [IAlpha, IBeta])] {
            let indices = self.pair(dq)?;
            let is_complete = indices.iter().all(Option::is_some);
            let of_phases = if is_complete { [None; 3] } else { [self.index(phases[0])?, self.index(phases[1])?, self.index(phases[2])?] };
            if let [Some(_), Some(_), third] = of_phases {
                has_phases = true;
                phases.into_iter().zip(of_phases).take(2).for_each(|(channel, index)| take(channel, index));
                if third.is_some() {
                    take(phases[2], third);
                }
            } else if !is_complete && let (Some(alpha), Some(beta)) = (self.index(stator[0])?, self.index(stator[1])?) {
                has_phases = true;
                stator.into_iter().zip([alpha, beta]).for_each(|(channel, index)| take(channel, Some(index)));
            } else if dq[0] == Ud
                && !is_complete
                && let Some(duties) = self.duties()
            {
                has_phases = true;
                phases.into_iter().zip(duties).for_each(|(channel, index)| take(channel, Some(index)));
                take(UDc, self.index(UDc)?);
            } else {
                dq.into_iter().zip(indices).for_each(|(channel, index)| take(channel, index));
            }
        }
        let speed = self.index(OmegaE)?;
        let has_angle = matches!(theta, Ok(Some(_)));
        if speed.is_some() || !has_angle {
            take(OmegaE, speed);
        }
        // The angle can be computed from currents in phase and in dq quantities.
        let currents = [self.index(IA)?, self.index(IB)?];
        let from_currents =
            has_phases && !has_angle && currents.iter().all(Option::is_some) && self.index(Id)?.is_some() && self.index(Iq)?.is_some();
        if from_currents {
            [IA, IB, IC]
                .into_iter()
                .zip([currents[0], currents[1], self.index(IC)?])
                .filter(|(_, index)| index.is_some())
                .for_each(|(channel, index)| take(channel, index));
        } else if has_phases || speed.is_none() && has_angle {
            take(ThetaE, theta?);
        }
        Ok(Needed { found, missing })
    }

    /// Adds the columns that the user mapped and that are not among those found.
    fn add_mapped(&self, found: &mut Vec<(Channel, usize)>) -> Result<(), FileError> {
        for channel in Channel::all() {
            if let Some(header) = self.options.header(channel)
                && found.iter().all(|(taken, _)| *taken != channel)
            {
                found.push((channel, mapped(channel, header, self.heads)?));
            }
        }
        Ok(())
    }

    /// The columns of both axes. If neither voltage is there, the two voltage references, which most drives log; never a reference
    /// together with a voltage of another kind.
    pub(super) fn pair(&self, [d, q]: [Channel; 2]) -> Result<[Option<usize>; 2], FileError> {
        let mut indices = [self.index(d)?, self.index(q)?];
        if let [Some(of_d), Some(of_q)] = indices
            && let names = [&self.heads[of_d].name, &self.heads[of_q].name].map(String::as_str)
            && !alias::differ_in_axis(d.dimension(), names)
            && !alias::are_elements(names)
        {
            let is_alias = [self.is_alias(d, names[0]), self.is_alias(q, names[1])];
            indices = match self.pairs([d, q])[..] {
                // `id`, a number of the device, beside `d_current` and `q_current`.
                [pair] if !self.is_given(d) && !self.is_given(q) => pair.map(Some),
                [] if alias::are_pair([d, q], names) => indices,
                _ => [(!is_alias[0]).then_some(of_d), (!is_alias[1]).then_some(of_q)],
            };
        }
        let reference = |channel: Channel| {
            let wanted = ["_ref", "*"].map(|mark| format!("{}{mark}", channel.name()));
            let is_wanted = |name: &str| wanted.iter().any(|wanted| name.eq_ignore_ascii_case(wanted));
            self.heads.iter().position(|head| is_wanted(split_header(&head.name, channel.dimension()).0))
        };
        match indices {
            [None, None] if d == Ud => Ok(match [reference(d), reference(q)] {
                both @ [Some(_), Some(_)] => both,
                _ => indices,
            }),
            _ => Ok(indices),
        }
    }

    /// Whether the user or the layout names the column of a channel.
    fn is_given(&self, channel: Channel) -> bool {
        self.options.header(channel).is_some() || self.layout.and_then(|layout| layout.column(channel)).is_some()
    }

    /// All pairs of columns that have names of the two axes which differ in nothing but the axis.
    fn pairs(&self, [d, q]: [Channel; 2]) -> Vec<[usize; 2]> {
        let candidates = |channel: Channel| {
            let is_named = move |head: &&ColumnHead| {
                alias::is_alias(channel, head) || matches!(automatic(channel, std::slice::from_ref(*head)), Ok(Some(_)))
            };
            (0..self.heads.len()).filter(move |index| is_named(&&self.heads[*index]))
        };
        let is_pair = |[d_index, q_index]: &[usize; 2]| {
            alias::differ_in_axis(d.dimension(), [&self.heads[*d_index].name, &self.heads[*q_index].name])
        };
        candidates(d).flat_map(|of_d| candidates(q).map(move |of_q| [of_d, of_q])).filter(is_pair).collect()
    }

    /// The duty cycles of the three phases, if the log has them and no voltages.
    pub(super) fn duties(&self) -> Option<[usize; 3]> {
        let is_free = self.layout.is_none() && [UA, UB, UC].iter().all(|channel| !self.is_given(*channel));
        is_free.then(|| duty::duties(self.heads)).flatten()
    }

    /// The time between rows, s, of a log without a time column, from the options or the layout.
    fn sample_period(&self) -> Option<f64> {
        self.options.sample_period.or(self.layout.and_then(|layout| layout.sample_period))
    }

    /// Of a log with a time column and a stated time between rows, which of the two is not used.
    pub(super) fn unused_time(&self) -> Option<String> {
        self.options.sample_period?;
        let name = self.index(T).ok().flatten().map(|index| shorten(&self.heads[index].name))?;
        Some(match self.options.counts_rows() {
            true => format!("column '{name}' is not read: the mapping file states sample_period; map t to the column to use it instead"),
            false => format!("sample_period is not used: t is mapped to column '{name}'"),
        })
    }

    /// The column of a channel: the mapped one; else the layout's; else the one with the canonical name, or the time column of an MDF
    /// or MATLAB file.
    pub(super) fn index(&self, channel: Channel) -> Result<Option<usize>, FileError> {
        let names = self.names();
        if let Some(header) = self.options.header(channel) {
            return mapped(channel, header, self.heads).map(Some);
        }
        if let Some(column) = self.layout.and_then(|layout| layout.column(channel)) {
            let tiers = [positions(&names, |name| name == column.header), positions(&names, |name| is_called(name, column.header))];
            if let Some(index) = only(channel, &names, tiers)? {
                return Ok(Some(index));
            }
        }
        let found = automatic(channel, self.heads)?;
        let is_time = || self.heads.iter().position(|head| head.is_time);
        let is_dated = || self.heads.iter().position(|head| head.instants.as_ref().is_some_and(Instants::is_date));
        // The index of a table of pandas is its time, or counts its rows: then its whole numbers are refused.
        let is_alone = || self.layout.is_none() && propose(&[T], self.heads, |_, index| (index > 0).then_some(0.0)).is_empty();
        let is_index = || names.first().filter(|name| *name == UNNAMED && is_alone()).map(|_| 0);
        let usual = || self.layout.is_none().then(|| alias::find(channel, self.heads)).flatten();
        Ok(match channel {
            T => found.or_else(is_time).or_else(usual).or_else(is_dated).or_else(is_index),
            _ => found.or_else(usual),
        })
    }

    /// Whether a column has not the channel's own name, nor one that the user or the layout gives it. Who states the unit of an angle means
    /// the column that has it.
    pub(super) fn is_alias(&self, channel: Channel, name: &str) -> bool {
        let is_meant = channel == ThetaE && self.options.unit(ThetaE).is_some();
        !self.is_given(channel) && !is_meant && {
            let head = ColumnHead { name: name.to_owned(), ..ColumnHead::default() };
            !matches!(automatic(channel, &[head]), Ok(Some(_)))
        }
    }

    /// A column with its unit. If SI is assumed because no unit is stated, the column is added to `unstated`.
    pub(super) fn column(
        &self,
        channel: Channel,
        index: usize,
        is_optional: bool,
        unstated: &mut Vec<(Channel, String)>,
        notes: &mut Vec<Note>,
    ) -> Result<ChosenColumn, FileError> {
        let head = &self.heads[index];
        let (pole_pairs, scale) = (self.options.pole_pairs.unwrap_or(1), self.options.factor(channel));
        let is_alias = self.is_alias(channel, &head.name);
        let header = head.name.clone();
        let is_given_share = self.options.shares_of_bus.contains(&channel);
        let is_duty = || [UA, UB, UC].contains(&channel) && self.duties().is_some_and(|duties| duties.contains(&index));
        if is_duty() {
            let percent = duty::is_percent(head);
            let (unit, instants, scale) = (channel.unit(), None, if percent { scale / 100.0 } else { scale });
            let (is_unit_stated, is_unit_written, is_share) = (true, true, true);
            return Ok(ChosenColumn {
                channel,
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
            });
        }
        if let Some(instants) = self.instants(channel, head) {
            let column = format!("{}: column '{}'", channel.name(), shorten(&head.name));
            notes.push(format!("{column} read as {}", instants.describe()).into());
            let (unit, instants) = (Unit::Second, Some(instants));
            return Ok(ChosenColumn {
                channel,
                index,
                header,
                unit,
                pole_pairs,
                scale,
                is_optional,
                is_unit_stated: true,
                is_unit_written: true,
                is_share: false,
                is_alias,
                instants,
            });
        }
        let assumed = unstated.len();
        let unit = self.unit(channel, head, unstated, notes)?;
        let is_unit_stated = unstated.len() == assumed && !(channel == T && unit == Unit::Second);
        let is_in_header = matches!(split_header(&head.name, channel.dimension()).1, HeaderUnit::Known(_)) || head.unit.is_some();
        let is_unit_written = is_in_header
            || self.options.unit(channel).is_some()
            || self.options.scale(channel) != 1.0
            || unit != channel.unit() && unstated.len() == assumed;
        let (is_share, instants) = (is_given_share, None);
        Ok(ChosenColumn {
            channel,
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
        })
    }

    /// An optional column that the user did not map, if the file has it and it is not read as another channel.
    pub(super) fn optional(
        &self,
        channel: Channel,
        taken: &[ChosenColumn],
        notes: &mut Vec<Note>,
    ) -> Result<Option<ChosenColumn>, FileError> {
        let Some(index) = self.index(channel)?.filter(|index| taken.iter().all(|column| column.index != *index)) else {
            if let Some(unit) = self.options.unit(channel) {
                let sentence = format!("the unit stated for {}, {}, is not used: the log has no such column", channel.name(), unit.name());
                notes.push(Note::with_advice(sentence, Advice::MapColumns(vec![(channel.name(), None)])));
            }
            return Ok(None);
        };
        // Its header is canonical or states the unit, so nothing is added to the unstated units.
        let column = self.column(channel, index, true, &mut Vec::new(), notes);
        column.map(Some).map_err(|error| error.in_column(&self.heads[index].name))
    }

    /// How the cells of the time are read, if they are instants and neither the user nor the header states another unit.
    pub(super) fn instants(&self, channel: Channel, head: &ColumnHead) -> Option<Instants> {
        let stated = match split_header(&head.name, Dimension::Time).1 {
            HeaderUnit::Known(unit) => Some(unit),
            _ => None,
        };
        let agrees = |instants: &Instants| match (instants.digits(), self.options.unit(T).or(stated)) {
            (None, _) => true,
            (Some(_), None) => true,
            (Some(digits), Some(unit)) => unit.in_si() == 10_f64.powi(-(digits as i32)),
        };
        head.instants.clone().filter(|instants| channel == T && agrees(instants))
    }

    /// The problem of a table that has each value in a row of its own, with the name of its quantity beside it.
    fn a_row_per_value(&self) -> Option<Problem> {
        let names = self.names();
        let called = |words: &[&str], name: &str| words.contains(&name.trim_matches('_').to_lowercase().as_str());
        let value = names.iter().find(|name| called(&VALUES, name))?;
        let first_cells = (self.first_cells)();
        let without_numbers = (0..first_cells.len()).filter(|index| !first_cells[*index].has_numbers).map(|index| &names[index]);
        let quantity = self.unreadable.iter().chain(without_numbers).find(|name| called(&QUANTITIES, name))?;
        Some(Problem::ARowPerValue { quantity: quantity.clone(), value: value.clone() })
    }

    fn refuse_missing(&self, missing: &[Channel], found: &[(Channel, usize)]) -> FileError {
        if [Ud, Uq].iter().all(|channel| missing.contains(channel))
            && let Some((layout, refusal)) = NotALog::by_names(&self.names())
        {
            return Problem::NotALog { layout, reason: refusal.reason(), advice: refusal.advice() }.into();
        }
        let numbers = self.heads.iter().filter(|head| head.name.trim().parse::<f64>().is_ok()).count();
        if numbers >= FEWEST_NUMBERS && numbers + 1 >= self.heads.len() {
            return Problem::Matrix.into();
        }
        if let Some(problem) = self.passed_over.cloned().or_else(|| self.a_row_per_value()) {
            return problem.into();
        }
        if let Some(names) = power_meter::element(self.heads).filter(|_| missing.iter().any(|channel| [Ud, Uq, UA, UB].contains(channel))) {
            return Problem::PowerMeter { names }.into();
        }
        if let Some(problem) = polar::problem(self.heads) {
            return problem.into();
        }
        // References are not proposed for measured currents.
        let present = self.names();
        let currents: Vec<Channel> = missing.iter().copied().filter(|channel| channel.dimension() == Dimension::Current).collect();
        let of_stator = if currents.is_empty() { &[][..] } else { &[IAlpha, IBeta] };
        let currents = [&currents, of_stator].concat();
        let resembles = |channels: &[Channel], name: &str| channels.iter().any(|channel| fit(*channel, name).is_some());
        let is_used = |index: usize| found.iter().any(|(_, used)| *used == index);
        let is_reference_of_current = |index: usize| {
            let head = &self.heads[index];
            let may_be = missing.iter().any(|channel| !has_other_unit(*channel, head));
            !is_used(index) && may_be && is_reference(&head.name) && resembles(&currents, &head.name)
        };
        let first_cells = (self.first_cells)();
        let without_numbers: Vec<usize> = (0..first_cells.len()).filter(|index| !first_cells[*index].has_numbers).collect();
        let references: Vec<usize> = (0..present.len()).filter(|index| is_reference_of_current(*index)).collect();
        let has_angle = matches!(self.index(ThetaE), Ok(Some(_)));
        let is_free = |index: usize| !is_used(index) && !references.contains(&index);
        let doubt = |channel: Channel, index: usize| if is_free(index) { doubt(channel, index, self.heads, &first_cells) } else { None };
        let Proposed { missing, proposals, equal } = propose_needed(missing, self.heads, has_angle, doubt);
        let rms = proposals.iter().filter(|proposal| proposal.is_rms());
        let rms = rms.filter_map(|proposal| Some((proposal.channel.name(), proposal.unit?.name()))).collect();
        let speed = proposals.iter().find(|proposal| proposal.channel == OmegaE);
        let speed = speed.and_then(|proposal| unit_of_speed(&self.heads[proposal.index])).map(|unit| (OmegaE.name(), unit));
        let is_proposed = |channel: Channel| proposals.iter().any(|proposal| proposal.channel == channel);
        let lacks_voltages = [Ud, Uq].iter().all(|channel| missing.contains(channel) && !is_proposed(*channel));
        let proposals = proposals.into_iter().map(|proposal| (proposal.channel.name(), present[proposal.index].clone())).collect();
        let name_of = |index: usize| present[index].clone();
        let equal = equal.into_iter().map(|(channel, of)| (channel.name(), of.into_iter().map(name_of).collect())).collect();
        let names_of_references = references.iter().map(|index| name_of(*index)).collect();
        let texts = without_numbers.iter().map(|index| &present[*index]);
        let unreadable = self.unreadable.iter().chain(texts).filter(|name| resembles(&missing, name)).cloned().collect();
        let line_to_line = self.line_to_line(&missing);
        let modulations = duty::modulations(self.heads).filter(|pair| lacks_voltages && pair.iter().all(|index| is_free(*index)));
        let modulations = modulations.map_or(Vec::new(), |[d, q]| vec![(Ud.name(), name_of(d)), (Uq.name(), name_of(q))]);
        let missing = missing.iter().map(|channel| channel.name()).collect();
        Problem::Missing {
            missing,
            present,
            proposals,
            equal,
            modulations,
            rms,
            references: names_of_references,
            unreadable,
            lists: self.lists.to_vec(),
            line_to_line,
            speed,
        }
        .into()
    }

    /// The columns of line-to-line voltages, where voltages are missing.
    fn line_to_line(&self, missing: &[Channel]) -> LineToLine {
        if missing.iter().all(|channel| channel.dimension() != Dimension::Voltage) {
            return LineToLine::default();
        }
        let line_to_line::LineToLine { scaled, pairs } = line_to_line::find(self.heads);
        let header = |index: usize| self.heads[index].name.clone();
        LineToLine {
            scaled: scaled.into_iter().map(|(channel, index)| (channel.name(), header(index))).collect(),
            pairs: pairs.into_iter().map(header).collect(),
        }
    }

    /// The unit of a column: the stated one; else the layout's; else the one in the header or the row of units; else SI.
    pub(super) fn unit(
        &self,
        channel: Channel,
        head: &ColumnHead,
        unstated: &mut Vec<(Channel, String)>,
        notes: &mut Vec<Note>,
    ) -> Result<Unit, FileError> {
        let (dimension, canonical, si, name) = (channel.dimension(), channel.name(), channel.unit(), head.name.as_str());
        // Of a share of the DC voltage the header has no unit of a voltage.
        if dimension == Dimension::Ratio || self.options.shares_of_bus.contains(&channel) {
            return Ok(si);
        }
        let (stem, in_name) = split_header(name, dimension);
        let named = match (in_name, head.unit.as_deref()) {
            // `RPM` in erpm.
            (_, Some(unit)) if states_electrical(unit) => unit_in_row(unit, name, dimension),
            (HeaderUnit::None, None) => unit_within(name, dimension),
            (HeaderUnit::Known(_), _) | (_, None) => in_name,
            (_, Some(unit)) => unit_in_row(unit, name, dimension),
        };
        // Of a structure, the field.
        let field = name.rsplit_once('.').map_or(name, |(_, field)| field);
        let is_canonical = field.eq_ignore_ascii_case(canonical);
        let of_layout = self.layout.and_then(|layout| layout.column(channel)).filter(|column| is_called(name, column.header));
        let stated = self.options.unit(channel);
        let is_electrical = states_electrical(name) || head.unit.as_deref().is_some_and(states_electrical);
        // Who maps a speed says which column it is, and not yet its unit.
        let is_open_speed = dimension == Dimension::Speed
            && !is_canonical
            && of_layout.is_none()
            && !is_electrical
            && !self.options.of_mapping_file.contains(&channel);
        if let Some(unit) = stated.filter(|_| self.options.factor(channel).abs() == 1.0)
            && let Some(of_header) = contradicted(named, name, unit)
        {
            let column = format!("{canonical}: column '{}'", shorten(name));
            notes.push(format!("{column} is read as {}, as you state; the file says {of_header}", unit.prose()).into());
        }
        let unit = match (stated, of_layout, named) {
            (Some(unit), ..) => unit,
            (None, Some(column), _) if head.unit.is_none() && name.trim().eq_ignore_ascii_case(column.header) => column.unit,
            // A unit that the header has besides is more reliable than the usual one of a layout.
            (None, Some(_), HeaderUnit::Known(unit)) if !is_canonical => unit,
            (None, Some(column), _) if head.unit.is_none() => column.unit,
            (None, _, HeaderUnit::Known(unit)) if !is_canonical || head.unit.is_some() => unit,
            _ if is_canonical && head.unit.is_none() => si,
            _ if dimension == Dimension::Voltage && self.options.scale(channel).abs() == 1.0 && duty::is_modulation(name) => {
                return Err(Problem::Modulation { channel: canonical, header: name.to_owned() }.into());
            }
            // The scale in a mapping file leads from there to SI.
            (None, _, HeaderUnit::Unknown(_)) if self.options.factor(channel).abs() != 1.0 => si,
            (None, _, HeaderUnit::Unknown(text)) => {
                if let Some(problem) = counts::problem(channel, text, name) {
                    return Err(problem.into());
                }
                let header = name.to_owned();
                if let Some(whole) = share(text) {
                    let text = text.to_owned();
                    return Err(Problem::Share { channel: canonical, text, header, si: si.prose(), whole }.into());
                }
                let units = channel.units().map(Unit::name).collect();
                return Err(Problem::HeaderUnit { channel: canonical, text: text.to_owned(), header, units }.into());
            }
            _ if is_open_speed => {
                let has_pole_pairs = self.options.pole_pairs.is_some();
                let usual = unit_of_tool(name, self.heads);
                return Err(Problem::SpeedUnit { has_pole_pairs, of_shaft: states_mechanical(name), usual }.into());
            }
            _ if dimension == Dimension::Speed && !is_canonical && stated.is_none() && is_electrical && !is_angular(name) => {
                return Err(Problem::ElectricalSpeedUnit.into());
            }
            _ if let Some((tool, unit)) = current_unit_of_tool(channel, name, self.heads) => {
                return Err(Problem::UnitOfTool { tool, unit }.into());
            }
            _ => {
                // By its name it is that of the shaft.
                let is_of_shaft = dimension == Dimension::Angle && states_mechanical(name);
                let unit = if is_of_shaft { Unit::RadianMechanical } else { si };
                if is_of_shaft && self.options.pole_pairs.is_none() {
                    return Err(needs_pole_pairs(channel, unit).into());
                }
                unstated.push((channel, format!("{canonical} ('{}') in {}", shorten(name), unit.prose())));
                return Ok(unit);
            }
        };
        let is_alias = stated.is_none() && self.is_alias(channel, name);
        if is_open_speed && stated.is_none() && !unit.is_mechanical() {
            let has_pole_pairs = self.options.pole_pairs.is_some();
            return Err(Problem::SpeedRotation { electrical: unit, mechanical: unit.of_shaft(), has_pole_pairs }.into());
        }
        if unit.is_mechanical() && self.options.pole_pairs.is_none() {
            return Err(needs_pole_pairs(channel, unit).into());
        }
        let column = format!("{canonical}: column '{}'", shorten(name));
        let turning = matches!(unit, Unit::RadianPerSecond | Unit::DegreePerSecond | Unit::HertzElectrical | Unit::Radian | Unit::Degree);
        let is_sure = stated.is_some() || is_canonical || of_layout.is_some() || is_electrical;
        if turning && !is_sure && !(is_alias && dimension == Dimension::Angle) {
            let sentence = format!("{column} read as {}; if it is mechanical, state its unit", unit.prose());
            let advice = Advice::StateUnit { channel: canonical, unit: Some(unit.of_shaft().name()) };
            notes.push(Note::with_advice(sentence, advice));
        } else if unit != si {
            let pole_pairs = self.options.pole_pairs.filter(|_| unit.is_mechanical());
            let with = pole_pairs.map(|n| format!(" with {n} pole pair{}", if n == 1 { "" } else { "s" }));
            notes.push(format!("{column} read as {}{}", unit.prose(), with.unwrap_or_default()).into());
        } else if !is_alias && self.options.header(channel).is_none() && of_layout.is_none() && ![stem, field].contains(&canonical) {
            notes.push(format!("{column} used").into());
        }
        Ok(unit)
    }
}

fn needs_pole_pairs(channel: Channel, unit: Unit) -> Problem {
    let what = if channel.dimension() == Dimension::Angle { "angle" } else { "speed" };
    let electrical = unit.electrical();
    Problem::PolePairs {
        what,
        channel: channel.name(),
        unit: unit.prose(),
        electrical: electrical.name(),
        electrical_unit: electrical.prose(),
    }
}

//! What the columns of a table seem to be, whether they make a log or not: for an inspection.

use super::{
    doubt::doubt,
    duty,
    finder::Finder,
    layout::{Layout, is_called},
    options::ResolvedOptions,
    power_meter,
    proposal::{propose_needed, stated_unit},
    resemblance::{fit, is_reference},
    rms,
    table::Table,
};
use crate::{block::ColumnHead, channel::Channel, header_unit::states_electrical};
use Channel::{Id, Iq, UA, UB, UC, Ud, Uq};
use fluxfit_units::{Dimension, Unit};

/// A column that is, or may be, a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surveyed {
    pub(super) channel: Channel,
    pub(super) index: usize,
    /// The unit in which it would be read; none of a share of the DC voltage, or where a speed's has to be stated.
    pub(super) unit: Option<Unit>,
    /// The file, the layout, the user or the channel's own name states the unit.
    pub(super) is_unit_stated: bool,
    /// The file or the user states it, and not the channel's own name alone.
    pub(super) is_unit_written: bool,
    /// One of them states whether a speed or an angle is electrical; true of other channels.
    pub(super) is_rotation_stated: bool,
    /// It is the time, and its cells are read as instants.
    pub(super) is_instant: bool,
    /// It has the channel's own name, or one that the layout or the user gives it.
    pub(super) is_named: bool,
}

/// What the columns of a table seem to be.
#[derive(Debug, Default)]
pub(super) struct Survey {
    /// Columns that would be read.
    pub(super) taken: Vec<Surveyed>,
    /// Columns that resemble a needed channel.
    pub(super) resembling: Vec<Surveyed>,
    /// Columns that are shares of the DC voltage, and what the value 1 of the file is of it.
    pub(super) shares: Vec<(usize, f64)>,
}

impl Survey {
    /// Moves the columns that a usual name alone makes a channel, without a unit, to those that resemble one: nothing was read that would
    /// show it.
    pub(super) fn without_guesses(mut self) -> Self {
        let is_guess = |column: &mut Surveyed| !(column.is_named || column.is_unit_stated && column.is_rotation_stated);
        let is_speed_in_unit = |column: &Surveyed| column.channel == Channel::OmegaE && column.is_unit_stated;
        self.resembling.extend(self.taken.extract_if(.., |column| is_guess(column) && !is_speed_in_unit(column)));
        self
    }
}

/// Looks for every channel, and for columns that resemble a needed channel that was not found.
pub(super) fn survey(table: &Table, layout: Option<&'static Layout>, options: &ResolvedOptions) -> Survey {
    let (heads, first_cells) = (table.heads(), table.first_cells());
    // With pole pairs given, mechanical units are not an error.
    let mut with_pole_pairs = options.clone();
    with_pole_pairs.pole_pairs.get_or_insert(1);
    let finder =
        Finder { heads, unreadable: &[], lists: &[], first_cells: &Vec::new, passed_over: None, layout, options: &with_pole_pairs };
    let mut survey = Survey::default();
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
            && survey.taken.iter().all(|taken| taken.index != index)
        {
            let head = &heads[index];
            let is_share = share(channel) == Some(index) || options.shares_of_bus.contains(&channel);
            if is_share {
                let percent = if share(channel) == Some(index) && duty::is_percent(head) { 0.01 } else { 1.0 };
                survey.shares.push((index, percent * options.factor(channel)));
            }
            let of_rms = rms::unit(channel).filter(|_| rms::is_unstated(channel, head, options));
            let read_in = || finder.unit(channel, head, &mut Vec::new(), &mut Vec::new()).ok();
            let assumed = || (channel.dimension() != Dimension::Speed).then_some(channel.unit());
            let unit = of_rms.or_else(read_in).or_else(assumed).filter(|_| !is_share);
            // A group's time is named by the file.
            let is_time = channel == Channel::T && (head.is_time || head.instants.is_some());
            let is_named = is_time || !finder.is_alias(channel, &head.name);
            let is_instant = finder.instants(channel, head).is_some();
            let stated = Surveyed { is_named, is_instant, ..surveyed(channel, index, head, layout, options) };
            let unit = if is_instant { Some(Unit::Second) } else { unit };
            survey.taken.push(Surveyed { unit: unit.or(stated.unit), is_unit_stated: stated.is_unit_stated || is_share, ..stated });
        }
    }
    let is_missing = |channel: &Channel| survey.taken.iter().all(|taken| taken.channel != *channel);
    let missing: Vec<Channel> = Channel::NEEDED.into_iter().filter(is_missing).collect();
    let is_free = |index: usize| survey.taken.iter().all(|taken| taken.index != index);
    // As where columns are missing: a reference is not proposed for a measured current.
    let is_reference_of_current = |index: usize| {
        let name = &heads[index].name;
        let mut currents = Channel::all().filter(|channel| channel.dimension() == Dimension::Current);
        is_reference(name) && currents.any(|channel| fit(channel, name).is_some())
    };
    let doubt = |channel: Channel, index: usize| {
        if is_free(index) && !is_reference_of_current(index) { doubt(channel, index, heads, &first_cells) } else { None }
    };
    let has_angle = !is_missing(&Channel::ThetaE);
    let is_of_meter = power_meter::element(heads).is_some();
    let resembling = propose_needed(&missing, heads, has_angle, doubt).proposals.into_iter();
    let resembling = resembling.filter(|found| !(is_of_meter && Channel::PHASES.contains(&found.channel)));
    survey.resembling = resembling.map(|found| surveyed(found.channel, found.index, &heads[found.index], layout, options)).collect();
    // Where nothing resembles the voltages, the modulations are they, times the DC voltage.
    let has_voltages = survey
        .taken
        .iter()
        .chain(&survey.resembling)
        .any(|column| column.channel.dimension() == Dimension::Voltage && column.channel != Channel::UDc);
    if let Some(pair) = duty::modulations(heads).filter(|pair| !has_voltages && pair.iter().all(|index| is_open(&survey, *index))) {
        let found = [Ud, Uq].into_iter().zip(pair).map(|(channel, index)| Surveyed {
            unit: None,
            is_unit_stated: true,
            ..surveyed(channel, index, &heads[index], layout, options)
        });
        survey.resembling.extend(found);
        survey.shares.extend(pair.map(|index| (index, duty::SHARE_OF_ODRIVE)));
    }
    survey
}

/// What is stated of a column: by the user, by its header or a row of units, by the layout, or by its name.
fn surveyed(channel: Channel, index: usize, head: &ColumnHead, layout: Option<&'static Layout>, options: &ResolvedOptions) -> Surveyed {
    let of_rms = rms::unit(channel).filter(|_| rms::is_unstated(channel, head, options));
    let of_user = options.unit(channel);
    let of_file = of_rms.or_else(|| stated_unit(channel, head));
    let of_layout = layout.and_then(|layout| layout.column(channel)).filter(|column| is_called(&head.name, column.header));
    let field = head.name.rsplit_once('.').map_or(head.name.as_str(), |(_, field)| field);
    let is_own_name = field == channel.name();
    let is_instant = channel == Channel::T && head.instants.is_some();
    let is_scaled = options.factor(channel).abs() != 1.0;
    let is_turning = matches!(channel.dimension(), Dimension::Speed | Dimension::Angle);
    let unit = of_user.or(of_file).or(of_layout.map(|column| column.unit));
    let is_electrical = states_electrical(&head.name) || head.unit.as_deref().is_some_and(states_electrical);
    let is_known = of_user.is_some() || of_layout.is_some() || is_own_name;
    // The layout of a tool has units; the one of the channels' own names has what the names mean.
    let has_units = of_layout.is_some() && !layout.is_some_and(Layout::is_canonical);
    Surveyed {
        channel,
        index,
        unit: unit.or((is_own_name && !is_instant).then_some(channel.unit())),
        is_unit_stated: is_known || of_file.is_some() || is_instant || is_scaled || channel.dimension() == Dimension::Ratio,
        is_unit_written: of_user.is_some() || of_file.is_some() || has_units || is_scaled,
        is_rotation_stated: !is_turning || is_known || is_electrical || unit.is_some_and(Unit::is_mechanical),
        is_instant: false,
        is_named: false,
    }
}

/// Whether a column is nothing yet.
fn is_open(survey: &Survey, index: usize) -> bool {
    survey.taken.iter().chain(&survey.resembling).all(|column| column.index != index)
}

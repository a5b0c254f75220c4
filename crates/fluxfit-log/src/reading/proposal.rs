//! Which columns may be channels that no column is read as: by names that resemble theirs.

use super::{
    line_to_line,
    resemblance::{Fit, fit, has_other_unit, words},
    rms,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, states_electrical, unit_in_row},
};
use Channel::{IA, IAlpha, IB, IBeta, IC, Id, Iq, ThetaE, UA, UAlpha, UB, UBeta, UC, Ud, Uq};
use fluxfit_units::{Dimension, Unit};

/// A column that may be a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Proposal {
    pub(super) channel: Channel,
    pub(super) index: usize,
    /// The unit that the header states, or that of root mean squares.
    pub(super) unit: Option<Unit>,
}

impl Proposal {
    /// Whether the column holds root mean squares by its name.
    pub(super) fn is_rms(&self) -> bool {
        self.unit.is_some_and(Unit::is_rms)
    }
}

/// A root mean square is proposed only where no other column resembles the channel: as good as no resemblance.
const OF_RMS: f64 = 1.0;

/// Of two speeds the one that states its unit is proposed, also where its name has some words more.
const WITH_UNIT: f64 = 0.05;

/// A column that resembles a channel.
struct Candidate {
    index: usize,
    fit: Fit,
}

/// What is proposed for the channels that a log lacks.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Proposed {
    /// The channels that it lacks.
    pub(super) missing: Vec<Channel>,
    pub(super) proposals: Vec<Proposal>,
    /// Channels that several columns could be whose names differ in a number alone, as of several axes, and these columns.
    pub(super) equal: Vec<(Channel, Vec<usize>)>,
}

/// The columns that most resemble some channels; each is proposed once. Where the names of several have the same words and numbers around
/// those of the channels, `vd1`, `vq1`, `id1`, `iq1`, they are of one motor and are proposed together. `doubt` says what is to be taken
/// from the resemblance of a column to a channel, and nothing of a column that it cannot be.
pub(super) fn propose(channels: &[Channel], heads: &[ColumnHead], doubt: impl Fn(Channel, usize) -> Option<f64>) -> Vec<Proposal> {
    of_each(channels, heads, doubt).proposals
}

fn of_each(channels: &[Channel], heads: &[ColumnHead], doubt: impl Fn(Channel, usize) -> Option<f64>) -> Proposed {
    let of = |channel: Channel| {
        let candidate = |(index, head): (usize, &ColumnHead)| {
            let doubt = doubt(channel, index)?;
            let is_phase = channel.dimension() != Dimension::Voltage || !line_to_line::is_line_to_line(&head.name);
            let may_be = !has_other_unit(channel, head) && is_phase;
            let fit = may_be.then(|| fit(channel, &head.name)).flatten()?;
            let of_rms = if rms::is_rms(head) { OF_RMS } else { 0.0 };
            let of_unit = if channel == Channel::OmegaE && stated_unit(channel, head).is_some() { WITH_UNIT } else { 0.0 };
            Some(Candidate { index, fit: Fit { score: fit.score - of_rms + of_unit - doubt, ..fit } })
        };
        (channel, heads.iter().enumerate().filter_map(candidate).collect::<Vec<_>>())
    };
    let candidates: Vec<(Channel, Vec<Candidate>)> = channels.iter().map(|channel| of(*channel)).collect();
    let around = shared_around(&candidates);
    let mut proposed = Proposed { missing: channels.to_vec(), ..Proposed::default() };
    for (channel, candidates) in &candidates {
        let free = |candidate: &&Candidate| proposed.proposals.iter().all(|other| other.index != candidate.index);
        let together = around.and_then(|around| best(candidates.iter().filter(free).filter(|candidate| candidate.fit.around == around)));
        if let Some(found) = together.or_else(|| best(candidates.iter().filter(free))) {
            let equal = candidates.iter().filter(|other| differ_in_number(&heads[found.index].name, &heads[other.index].name));
            let equal: Vec<usize> = equal.map(|other| other.index).collect();
            if together.is_none() && !equal.is_empty() {
                proposed.equal.push((*channel, [vec![found.index], equal].concat()));
                continue;
            }
            let head = &heads[found.index];
            let of_rms = rms::unit(*channel).filter(|_| rms::is_rms(head));
            let unit = of_rms.or_else(|| stated_unit(*channel, head));
            proposed.proposals.push(Proposal { channel: *channel, index: found.index, unit });
        }
    }
    proposed
}

/// Whether two names are the same but for a number: `ODrive 0 Velocity`, `ODrive 1 Velocity`.
fn differ_in_number(name: &str, other: &str) -> bool {
    let parts = |name: &str| -> Vec<String> {
        name.split(|c: char| c.is_ascii_digit()).filter(|part| !part.is_empty()).map(str::to_owned).collect()
    };
    name != other && parts(name) == parts(other)
}

/// The same for the channels that a log needs; where a dq pair lacks and no column resembles either, for that of the stator's frame or the
/// phases, and then for the angle that turns it, if `has_angle` does not say that it is there. The channels that the log lacks are then
/// others, too.
pub(super) fn propose_needed(
    missing: &[Channel],
    heads: &[ColumnHead],
    has_angle: bool,
    doubt: impl Fn(Channel, usize) -> Option<f64>,
) -> Proposed {
    let mut channels = missing.to_vec();
    let proposed = of_each(&channels, heads, &doubt);
    let is_found = |channel: Channel| {
        proposed.proposals.iter().any(|proposal| proposal.channel == channel) || proposed.equal.iter().any(|(equal, _)| *equal == channel)
    };
    for (dq, stator, phases) in [([Ud, Uq], [UAlpha, UBeta], [UA, UB, UC]), ([Id, Iq], [IAlpha, IBeta], [IA, IB, IC])] {
        let are_open = dq.iter().all(|channel| missing.contains(channel) && !is_found(*channel));
        let of = |channels: &[Channel]| propose(channels, heads, &doubt).into_iter().map(|proposal| proposal.channel).collect::<Vec<_>>();
        let others = match are_open {
            true if of(&stator).len() == stator.len() => stator.to_vec(),
            // The third phase may be missing.
            true => of(&phases),
            false => Vec::new(),
        };
        if others == stator || others.starts_with(&phases[..2]) {
            let place = channels.iter().position(|channel| *channel == dq[0]).unwrap_or(0);
            channels.retain(|channel| !dq.contains(channel));
            channels.splice(place..place, others);
        }
    }
    if channels == missing {
        return proposed;
    }
    if !has_angle && !channels.contains(&ThetaE) {
        channels.push(ThetaE);
    }
    of_each(&channels, heads, doubt)
}

/// The unit of a speed by its name, where none is stated: `f_e`, `w_el`, and `nm` of PSIM.
pub(super) fn unit_of_speed(head: &ColumnHead) -> Option<Unit> {
    let name = words(&head.name).concat();
    // `1/s` is rad/s without the unit of the angle.
    let has_unit = !matches!(split_header(&head.name, Dimension::Speed).1, HeaderUnit::None)
        || head.unit.as_deref().is_some_and(|unit| unit.trim() != "1/s");
    match name.as_str() {
        _ if has_unit => None,
        "fe" | "fel" | "felec" => Some(Unit::HertzElectrical),
        "we" | "wel" | "welec" => Some(Unit::RadianPerSecond),
        "nm" | "nmech" => Some(Unit::RpmMechanical),
        _ => None,
    }
}

/// Words in the paths of ODrive's variables: `axis0.pos_vel_mapper.vel`, `odrv0.axis0.encoder.vel_estimate`.
const ODRIVE: [&str; 5] = ["axis0", "axis1", "odrv0", "odrv1", "odrive"];

/// What tool writes speeds of this name among these columns, and in which unit. It is only the first of the units that are asked for.
pub(super) fn unit_of_tool(name: &str, heads: &[ColumnHead]) -> Option<(&'static str, Unit)> {
    let parts = words(name);
    let ends = |end: &[&str]| parts.iter().rev().zip(end.iter().rev()).all(|(part, end)| part == end) && parts.len() >= end.len();
    let has = |wanted: &str| heads.iter().any(|head| head.name.trim() == wanted);
    if ends(&["servo", "stats", "velocity"]) {
        Some(("moteus", Unit::HertzMechanical))
    } else if (ends(&["vel"]) || ends(&["vel", "estimate"])) && parts.iter().any(|part| ODRIVE.contains(&part.as_str())) {
        Some(("ODrive", Unit::HertzMechanical))
    } else if name.trim() == "velocity" && ["voltage_q", "voltage_d", "current_q", "current_d"].into_iter().all(has) {
        Some(("SimpleFOC", Unit::RadianPerSecondMechanical))
    } else {
        None
    }
}

/// The same of currents.
pub(super) fn current_unit_of_tool(channel: Channel, name: &str, heads: &[ColumnHead]) -> Option<(&'static str, Unit)> {
    let has = |wanted: &str| heads.iter().any(|head| head.name.trim() == wanted);
    let is_current = channel.dimension() == Dimension::Current && ["current_d", "current_q"].contains(&name.trim());
    // Its monitor prints 1000 times the current (SimpleFOC, FOCMotor::monitor).
    (is_current && ["voltage_d", "voltage_q", "velocity"].into_iter().all(has)).then_some(("SimpleFOC", Unit::Milliampere))
}

/// Whether an electrical speed without a unit is called by its symbol, which is in rad/s: `omega_e`, `w_el`.
pub(super) fn is_angular(name: &str) -> bool {
    words(name)
        .iter()
        .any(|word| word.starts_with("omega") || word.starts_with('ω') || ["w", "we", "wel", "welec"].contains(&word.as_str()))
}

/// The best one; of equal ones the first: a second motor or sensor comes later.
fn best<'a>(candidates: impl Iterator<Item = &'a Candidate>) -> Option<&'a Candidate> {
    candidates.reduce(|best, next| if next.fit.score > best.fit.score { next } else { best })
}

/// What stands around the names of the most voltages and currents, of at least two; of as many, around those that fit better.
fn shared_around(candidates: &[(Channel, Vec<Candidate>)]) -> Option<&str> {
    let of_motor = || {
        let is_electric = |channel: Channel| matches!(channel.dimension(), Dimension::Voltage | Dimension::Current);
        candidates.iter().filter(move |(channel, _)| is_electric(*channel)).map(|(_, candidates)| candidates)
    };
    let rank = |around: &str| {
        let with = of_motor().filter_map(|candidates| best(candidates.iter().filter(|candidate| candidate.fit.around == around)));
        with.fold((0, 0.0), |(count, sum), candidate| (count + 1, sum + candidate.fit.score))
    };
    let arounds = of_motor().flatten().map(|candidate| candidate.fit.around.as_str());
    let ranked = arounds.map(|around| (rank(around), around)).filter(|((count, _), _)| *count > 1);
    ranked.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, around)| around)
}

/// The unit that the header of a column, or a row of units, states.
pub(super) fn stated_unit(channel: Channel, head: &ColumnHead) -> Option<Unit> {
    let in_name = split_header(&head.name, channel.dimension()).1;
    let in_row = head.unit.as_deref().map(|unit| unit_in_row(unit, &head.name, channel.dimension()));
    let is_electrical = head.unit.as_deref().is_some_and(states_electrical);
    let units = if is_electrical { [in_row, Some(in_name)] } else { [Some(in_name), in_row] };
    units.into_iter().flatten().find_map(|named| match named {
        HeaderUnit::Known(unit) => Some(unit),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::{super::doubt::doubt, *};
    use crate::csv::FirstCells;

    /// What is proposed for t, ud, uq, id, iq and omega_e.
    fn proposed(header: &str) -> Vec<&str> {
        let names: Vec<&str> = header.split(';').collect();
        let heads: Vec<ColumnHead> = names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect();
        let proposals = propose(&Channel::NEEDED, &heads, |_, _| Some(0.0));
        let find = |channel| proposals.iter().find(|proposal| proposal.channel == channel).map_or("-", |proposal| names[proposal.index]);
        Channel::NEEDED.into_iter().map(find).collect()
    }

    #[test]
    fn headers_of_known_tools() {
        let paderborn = "u_q;coolant;stator_winding;u_d;stator_tooth;motor_speed;i_d;i_q;pm;stator_yoke;ambient;torque;profile_id";
        assert_eq!(proposed(paderborn), ["-", "u_d", "u_q", "i_d", "i_q", "motor_speed"]);
        let vesc = "ms_today;input_voltage;current_motor;current_in;d_axis_current;q_axis_current;erpm;duty_cycle;vesc_id;d_axis_voltage;q_axis_voltage;ms_today_setup";
        assert_eq!(proposed(vesc), ["ms_today", "d_axis_voltage", "q_axis_voltage", "d_axis_current", "q_axis_current", "erpm"]);
        let tritium = "Time;BusVoltage;MotorId;MotorIq;MotorVd;MotorVq;MotorVelocity";
        assert_eq!(proposed(tritium), ["Time", "MotorVd", "MotorVq", "MotorId", "MotorIq", "MotorVelocity"]);
        let dyno = "Input voltage;Test motor q-axis current;Test motor d-axis current;Output Torque;Output Speed;Output Speed set-point;Absorber q-axis current";
        assert_eq!(proposed(dyno), ["-", "-", "-", "Test motor d-axis current", "Test motor q-axis current", "Output Speed"]);
        assert_eq!(proposed("tmie;omga;udz"), ["tmie", "-", "-", "-", "-", "omga"]);
        assert_eq!(proposed("timestep;speed_step"), ["-"; 6]);
        // PSIM's speed, and an abbreviation.
        assert_eq!([proposed("nm")[5], proposed("PST_NM_AWC_NM_State")[5]], ["nm", "-"]);
        assert_eq!(proposed("uq.Time;id.time"), ["uq.Time", "-", "-", "-", "-", "-"]);
    }

    #[test]
    fn columns_of_one_motor_are_proposed_together() {
        let numbered = "data.time;data.vd1;data.vq1;data.id1;data.iq1;data.iq1_ref;data.speed1";
        assert_eq!(proposed(numbered), ["data.time", "data.vd1", "data.vq1", "data.id1", "data.iq1", "data.speed1"]);
        // Of two motors the first, though another column stands alone.
        let two = "t;iq;ud_1;uq_1;id_1;iq_1;ud_2;uq_2;id_2;iq_2";
        assert_eq!(proposed(two), ["t", "ud_1", "uq_1", "id_1", "iq_1", "-"]);
        for suffix in ["_meas", "_m", "_avg", "_1", "_M1", "M1", "_filt", " of stator [x]"] {
            let names: Vec<String> = ["id", "iq", "ud", "uq"].iter().map(|name| format!("{name}{suffix}")).collect();
            assert_eq!(proposed(&names.join(";"))[1..5], [&names[2], &names[3], &names[0], &names[1]].map(String::as_str));
        }
        let of_rms = "Iq_RMS;Id_RMS;Is_RMS;Iq_Pk;Id_Pk;Is_Pk";
        assert_eq!(proposed(of_rms)[3..5], ["Id_Pk", "Iq_Pk"]);
        assert_eq!(proposed("id_RMS_A;iq_RMS_A")[3..5], ["id_RMS_A", "iq_RMS_A"]);
        // A letter and a number are a temperature or a torque.
        assert_eq!(proposed("t1;n1")[0], "-");
    }

    #[test]
    fn signals_of_a_bus_and_of_the_stator_are_proposed() {
        assert_eq!(proposed("time;isd_id;isq_id;usd_id;usq_id")[1..5], ["usd_id", "usq_id", "isd_id", "isq_id"]);
        assert_eq!(proposed("iMeasDQ.D;iMeasDQ.Q;vRefDQ_D;vRefDQ_Q")[1..5], ["vRefDQ_D", "vRefDQ_Q", "iMeasDQ.D", "iMeasDQ.Q"]);
        let heads = |names: &[&str]| -> Vec<ColumnHead> {
            names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect()
        };
        let of_stator = heads(&["t", "vRefAlpBet_Alpha", "vRefAlpBet_Beta", "iAlpBet_Alpha", "iAlpBet_Beta", "theta"]);
        let Proposed { missing, proposals, .. } =
            propose_needed(&[Ud, Uq, Id, Iq], &of_stator, false, |_, index| (index > 0).then_some(0.0));
        assert_eq!(missing, [UAlpha, UBeta, IAlpha, IBeta, ThetaE]);
        assert_eq!(proposals.iter().map(|proposal| proposal.index).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
        // Words that are not of the frame, per unit, one axis alone.
        for names in [["vLoadAlpBet_Alpha", "vLoadAlpBet_Beta"], ["vPuAlpBet_Alpha", "vPuAlpBet_Beta"], ["vRef_Alpha", "x"]] {
            let none = Proposed { missing: vec![Ud, Uq], ..Proposed::default() };
            assert_eq!(propose_needed(&[Ud, Uq], &heads(&names), true, |_, _| Some(0.0)), none, "{names:?}");
        }
    }

    #[test]
    fn of_equal_axes_none_is_proposed() {
        let of = |header: &str| {
            let heads: Vec<ColumnHead> =
                header.split(';').map(|name| ColumnHead { name: name.to_owned(), ..ColumnHead::default() }).collect();
            let proposed = propose_needed(&Channel::NEEDED, &heads, false, |_, _| Some(0.0));
            (proposed.proposals.iter().map(|proposal| proposal.channel.name()).collect::<Vec<_>>(), proposed.equal)
        };
        let axes = "time;Drive 0 Velocity;Drive 1 Velocity;Drive 2 Velocity;Drive 0 Current;Drive 1 Current";
        assert_eq!(of(axes), (vec!["t"], vec![(Channel::OmegaE, vec![1, 2, 3])]));
        // Its voltages and currents tell which motor it is.
        let of_one = "time;my vd1;my vq1;my id1;my iq1;my speed1;my speed2";
        assert_eq!(of(of_one), (vec!["t", "ud", "uq", "id", "iq", "omega_e"], Vec::new()));
        assert_eq!(of("time;speed 50 Hz filter;speed measured").0, ["t", "omega_e"]);
    }

    #[test]
    fn a_column_that_cannot_be_measured_is_not_proposed() {
        let (measured, still) = (FirstCells { has_numbers: true, ..FirstCells::default() }, Some(1.0));
        let of = |header: &str, cells: &[FirstCells]| {
            let names: Vec<&str> = header.split(';').collect();
            let heads: Vec<ColumnHead> =
                names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect();
            let proposals = propose(&Channel::NEEDED, &heads, |channel, index| doubt(channel, index, &heads, cells));
            proposals.iter().map(|proposal| format!("{}={}", proposal.channel.name(), names[proposal.index])).collect::<Vec<_>>().join(",")
        };
        let header = "bench time;my bench time;NM wakeup;bench vd;bench vq;bench id;bench iq";
        assert_eq!(of(header, &[]), "t=bench time,ud=bench vd,uq=bench vq,id=bench id,iq=bench iq");
        let mut cells = [measured; 7];
        cells[0] = FirstCells { falls: true, ..measured };
        cells[3] = FirstCells { has_no_value: true, ..measured };
        cells[5] = FirstCells { constant: still, ..measured };
        assert_eq!(of(header, &cells), "t=my bench time,uq=bench vq,iq=bench iq");
        // Before a drive starts all is zero; a speed that a bench holds does not move; a flag is no speed.
        let resting = FirstCells { constant: Some(0.0), ..measured };
        assert_eq!(of("bench id;other iq", &[resting, resting]), "id=bench id,iq=other iq");
        let held = FirstCells { constant: still, ..measured };
        assert_eq!(of("bench speed;my bench speed", &[held, measured]), "omega_e=my bench speed");
        assert_eq!(of("bench speed", &[held]), "omega_e=bench speed");
        assert_eq!(of("bench speed", &[FirstCells { is_flag: true, ..measured }]), "");
    }

    #[test]
    fn known_tools_write_speeds_of_the_shaft() {
        let of = |header: &str| {
            let heads: Vec<ColumnHead> =
                header.split(';').map(|name| ColumnHead { name: name.to_owned(), ..ColumnHead::default() }).collect();
            unit_of_tool(&heads[0].name, &heads).map(|(tool, unit)| (tool, unit.name()))
        };
        assert_eq!(of("servo_stats.velocity;servo_stats.d_A"), Some(("moteus", "Hz-mech")));
        assert_eq!(of("axis0.pos_vel_mapper.vel"), Some(("ODrive", "Hz-mech")));
        assert_eq!(of("odrv0.axis1.encoder.vel_estimate"), Some(("ODrive", "Hz-mech")));
        assert_eq!(of("velocity;voltage_q;voltage_d;current_q;current_d"), Some(("SimpleFOC", "rad/s-mech")));
        assert_eq!([of("velocity;vd;vq"), of("vel"), of("axis0.speed")], [None; 3]);
        let heads = ["velocity", "voltage_q", "voltage_d", "current_q", "current_d"];
        let heads = heads.map(|name| ColumnHead { name: name.to_owned(), ..ColumnHead::default() });
        let of_current =
            |heads: &[ColumnHead]| current_unit_of_tool(Channel::Iq, "current_q", heads).map(|(tool, unit)| (tool, unit.name()));
        assert_eq!((of_current(&heads), of_current(&heads[1..])), (Some(("SimpleFOC", "mA")), None));
    }
}

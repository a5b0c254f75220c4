//! Which columns may be channels that no column is read as: by names that resemble theirs.

use super::{
    line_to_line,
    resemblance::{Fit, fit, has_other_unit, words},
    rms,
};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header, unit_in_row},
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

/// The columns that most resemble some channels, of those that are free; each is proposed once. Where the names of several have the same
/// words and numbers around those of the channels, `vd1`, `vq1`, `id1`, `iq1`, they are of one motor and are proposed together.
pub(super) fn propose(channels: &[Channel], heads: &[ColumnHead], is_free: impl Fn(usize) -> bool) -> Vec<Proposal> {
    let of = |channel: Channel| {
        let candidate = |(index, head): (usize, &ColumnHead)| {
            let is_phase = channel.dimension() != Dimension::Voltage || !line_to_line::is_line_to_line(&head.name);
            let may_be = is_free(index) && !has_other_unit(channel, head) && is_phase;
            let fit = may_be.then(|| fit(channel, &head.name)).flatten()?;
            let of_rms = if rms::is_rms(head) { OF_RMS } else { 0.0 };
            let of_unit = if channel == Channel::OmegaE && stated_unit(channel, head).is_some() { WITH_UNIT } else { 0.0 };
            Some(Candidate { index, fit: Fit { score: fit.score - of_rms + of_unit, ..fit } })
        };
        (channel, heads.iter().enumerate().filter_map(candidate).collect::<Vec<_>>())
    };
    let candidates: Vec<(Channel, Vec<Candidate>)> = channels.iter().map(|channel| of(*channel)).collect();
    let around = shared_around(&candidates);
    let mut proposals: Vec<Proposal> = Vec::new();
    for (channel, candidates) in &candidates {
        let free = |candidate: &&Candidate| proposals.iter().all(|other| other.index != candidate.index);
        let together = around.and_then(|around| best(candidates.iter().filter(free).filter(|candidate| candidate.fit.around == around)));
        if let Some(Candidate { index, .. }) = together.or_else(|| best(candidates.iter().filter(free))) {
            let head = &heads[*index];
            let of_rms = rms::unit(*channel).filter(|_| rms::is_rms(head));
            proposals.push(Proposal { channel: *channel, index: *index, unit: of_rms.or_else(|| stated_unit(*channel, head)) });
        }
    }
    proposals
}

/// The same for the channels that a log needs; where a dq pair lacks and no column resembles either, for that of the stator's frame or the
/// phases, and then for the angle that turns it, if `has_angle` does not say that it is there. Returns the channels that the log lacks
/// then, too.
pub(super) fn propose_needed(
    missing: &[Channel],
    heads: &[ColumnHead],
    has_angle: bool,
    is_free: impl Fn(usize) -> bool,
) -> (Vec<Channel>, Vec<Proposal>) {
    let mut channels = missing.to_vec();
    let proposals = propose(&channels, heads, &is_free);
    let is_proposed = |proposals: &[Proposal], channel: Channel| proposals.iter().any(|proposal| proposal.channel == channel);
    for (dq, stator, phases) in [([Ud, Uq], [UAlpha, UBeta], [UA, UB, UC]), ([Id, Iq], [IAlpha, IBeta], [IA, IB, IC])] {
        let are_open = dq.iter().all(|channel| missing.contains(channel) && !is_proposed(&proposals, *channel));
        let of = |channels: &[Channel]| propose(channels, heads, &is_free).into_iter().map(|proposal| proposal.channel).collect::<Vec<_>>();
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
        return (channels, proposals);
    }
    if !has_angle && !channels.contains(&ThetaE) {
        channels.push(ThetaE);
    }
    let proposals = propose(&channels, heads, is_free);
    (channels, proposals)
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
    [Some(in_name), in_row].into_iter().flatten().find_map(|named| match named {
        HeaderUnit::Known(unit) => Some(unit),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is proposed for t, ud, uq, id, iq and omega_e.
    fn proposed(header: &str) -> Vec<&str> {
        let names: Vec<&str> = header.split(';').collect();
        let heads: Vec<ColumnHead> = names.iter().map(|name| ColumnHead { name: (*name).to_owned(), ..ColumnHead::default() }).collect();
        let proposals = propose(&Channel::NEEDED, &heads, |_| true);
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
        let (lacking, proposals) = propose_needed(&[Ud, Uq, Id, Iq], &of_stator, false, |index| index > 0);
        assert_eq!(lacking, [UAlpha, UBeta, IAlpha, IBeta, ThetaE]);
        assert_eq!(proposals.iter().map(|proposal| proposal.index).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
        // Words that are not of the frame, per unit, one axis alone.
        for names in [["vLoadAlpBet_Alpha", "vLoadAlpBet_Beta"], ["vPuAlpBet_Alpha", "vPuAlpBet_Beta"], ["vRef_Alpha", "x"]] {
            assert_eq!(propose_needed(&[Ud, Uq], &heads(&names), true, |_| true), (vec![Ud, Uq], Vec::new()), "{names:?}");
        }
    }
}

//! Currents or voltages as a length and an angle, as tables of operating points have them: `Is [A]`, `beta [deg]`. From which axis such an
//! angle counts, and whether the length is a peak value, the names do not say: it is asked to write the axes.

use super::resemblance::{fit, words};
use crate::{
    block::ColumnHead,
    channel::Channel,
    header_unit::{HeaderUnit, split_header},
    problem::Problem,
};
use fluxfit_units::Dimension;

/// What says of a length that it is one, and of what.
const BESIDE_LENGTH: [&str; 22] = [
    "rms",
    "eff",
    "peak",
    "pk",
    "amp",
    "amplitude",
    "mag",
    "magnitude",
    "abs",
    "betrag",
    "length",
    "vector",
    "stator",
    "phase",
    "ph",
    "motor",
    "arms",
    "apk",
    "vrms",
    "vpk",
    "meas",
    "measured",
];

/// What is left of its name.
const CURRENTS: [&str; 6] = ["i", "is", "i1", "iph", "current", "strom"];
const VOLTAGES: [&str; 8] = ["u", "v", "us", "vs", "u1", "v1", "voltage", "spannung"];

/// Names of an angle of the current, and of the voltage, without their unit.
const ANGLES_OF_CURRENT: [&str; 14] = [
    "beta",
    "β",
    "gamma",
    "γ",
    "betai",
    "gammai",
    "phii",
    "thetai",
    "advance",
    "phaseadvance",
    "phaseadvanceangle",
    "advanceangle",
    "stromwinkel",
    "vorsteuerwinkel",
];
const ANGLES_OF_VOLTAGE: [&str; 9] = ["delta", "δ", "deltau", "thetau", "thetav", "phiu", "loadangle", "spannungswinkel", "polradwinkel"];

/// The length and the angle of currents or of voltages, if the columns have both and no column resembles one of the axes.
fn pair<'a>(heads: &'a [ColumnHead], axes: [Channel; 2], lengths: &[&str], angles: &[&str]) -> Option<[&'a str; 2]> {
    let dimension = axes[0].dimension();
    let word = if dimension == Dimension::Current { ["current", "strom"] } else { ["voltage", "spannung"] };
    let is_axis = |head: &ColumnHead| axes.into_iter().any(|axis| fit(axis, &head.name).is_some());
    let is_length = |head: &&ColumnHead| {
        let (stem, unit) = split_header(&head.name, dimension);
        let stem = if matches!(unit, HeaderUnit::Unknown(_)) { head.name.split(['[', '(']).next().unwrap_or_default() } else { stem };
        let left: Vec<String> = words(stem).into_iter().filter(|word| !BESIDE_LENGTH.contains(&word.as_str())).collect();
        lengths.contains(&left.concat().as_str())
    };
    let is_angle = |head: &&ColumnHead| {
        let words = words(split_header(&head.name, Dimension::Angle).0);
        let is_named = angles.contains(&words.concat().as_str());
        let is_of = |some: &[&str]| words.iter().any(|word| some.contains(&word.as_str()));
        is_named || is_of(&word) && is_of(&["angle", "winkel"])
    };
    if heads.iter().any(is_axis) {
        return None;
    }
    Some([heads.iter().find(is_length)?.name.trim(), heads.iter().find(is_angle)?.name.trim()])
}

/// The refusal of such columns; none of others.
pub(super) fn problem(heads: &[ColumnHead]) -> Option<Problem> {
    // Of the stator's frame, `beta` is an axis.
    let is_alpha =
        |head: &ColumnHead| words(&head.name).iter().any(|word| ["alpha", "α", "ialpha", "ualpha", "valpha"].contains(&word.as_str()));
    if heads.iter().any(is_alpha) {
        return None;
    }
    let of_current = pair(heads, [Channel::Id, Channel::Iq], &CURRENTS, &ANGLES_OF_CURRENT).map(|pair| ("i", pair));
    let of_voltage = pair(heads, [Channel::Ud, Channel::Uq], &VOLTAGES, &ANGLES_OF_VOLTAGE).map(|pair| ("u", pair));
    let vectors: Vec<(&'static str, [String; 2])> =
        of_current.into_iter().chain(of_voltage).map(|(symbol, pair)| (symbol, pair.map(str::to_owned))).collect();
    (!vectors.is_empty()).then_some(Problem::Polar { vectors })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &str) -> Option<Vec<(&'static str, [String; 2])>> {
        let head = |name: &str| ColumnHead { name: name.to_owned(), ..ColumnHead::default() };
        match problem(&names.split(',').map(head).collect::<Vec<_>>()) {
            Some(Problem::Polar { vectors }) => Some(vectors),
            _ => None,
        }
    }

    #[test]
    fn a_length_beside_an_angle_is_a_vector() {
        let of = |symbol, length: &str, angle: &str| (symbol, [length.to_owned(), angle.to_owned()]);
        for (names, expected) in [
            ("n [rpm],Is [A],beta [deg],Ud [V],Uq [V]", vec![of("i", "Is [A]", "beta [deg]")]),
            ("n,I_s_rms [Arms],gamma,Us [V],delta [deg]", vec![of("i", "I_s_rms [Arms]", "gamma"), of("u", "Us [V]", "delta [deg]")]),
            ("Stator Current Amplitude (A),Current angle (deg),T", vec![of("i", "Stator Current Amplitude (A)", "Current angle (deg)")]),
            ("Is_peak_A,Phase Advance [deg],T", vec![of("i", "Is_peak_A", "Phase Advance [deg]")]),
        ] {
            assert_eq!(found(names), Some(expected), "{names}");
        }
        for names in ["id,iq,Is,beta,ud,uq", "i_alpha,i_beta,Is", "I [A],T [Nm],n [rpm]", "Is [A],theta_e", "U [V],beta"] {
            assert_eq!(found(names), None, "{names}");
        }
    }
}

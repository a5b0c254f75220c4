//! Names that say that a column holds root mean squares. A dq quantity is the peak value of the phases here, sqrt 2 times as large.

use super::{options::ResolvedOptions, resemblance::words};
use crate::{block::ColumnHead, channel::Channel};
use fluxfit_units::{Dimension, Unit};

/// Words for a root mean square; `eff` and `effektiv` are German, the others French and Spanish.
const RMS: [&str; 8] = ["rms", "trms", "eff", "effektiv", "effektivwert", "efficace", "eficaz", "efficaz"];

/// What `rms` and `eff` are written behind without a mark between: `Arms`, `idrms`, `Aeff`.
const BEFORE: [&str; 18] = ["a", "v", "ma", "mv", "ka", "kv", "i", "u", "is", "us", "vs", "id", "iq", "ud", "uq", "vd", "vq", "phase"];

/// Whether the name or the unit of a column says that it holds root mean squares.
pub(super) fn is_rms(head: &ColumnHead) -> bool {
    let says = |text: &str| {
        let is_word = |word: &String| {
            let before = word.strip_suffix("rms").or_else(|| word.strip_suffix("eff"));
            RMS.contains(&word.as_str()) || before.is_some_and(|before| BEFORE.contains(&before))
        };
        words(text).iter().any(is_word)
    };
    says(&head.name) || head.unit.as_deref().is_some_and(says)
}

/// A column that holds root mean squares, named as without them: `Iq` of `Iq [Arms]` and of `Iq_rms (A)`.
pub(super) fn without(head: &ColumnHead) -> Option<ColumnHead> {
    let name = head.name.split(['[', '(']).next().unwrap_or(&head.name);
    let others: Vec<String> = words(name).into_iter().filter(|word| !RMS.contains(&word.as_str())).collect();
    let unit = head.unit.clone().filter(|unit| !words(unit).iter().any(|word| RMS.contains(&word.as_str())));
    is_rms(head).then(|| ColumnHead { name: others.join("_"), unit, ..head.clone() })
}

/// Whether a column holds root mean squares by its name, and the user states neither a unit nor a scale.
pub(super) fn is_unstated(channel: Channel, head: &ColumnHead, options: &ResolvedOptions) -> bool {
    is_rms(head) && options.unit(channel).is_none() && options.factor(channel).abs() == 1.0
}

/// The unit of a channel of the dq frame whose column holds root mean squares.
pub(super) fn unit(channel: Channel) -> Option<Unit> {
    let unit = if channel.dimension() == Dimension::Voltage { Unit::VoltRms } else { Unit::AmpereRms };
    channel.units().find(|allowed| *allowed == unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_units_say_root_mean_square() {
        let is = |name: &str, unit: Option<&str>| {
            is_rms(&ColumnHead { name: name.to_owned(), unit: unit.map(str::to_owned), ..ColumnHead::default() })
        };
        for name in [
            "id_RMS_A",
            "IdRMS",
            "id_rms",
            "id (RMS)",
            "idrms",
            "Iq [Arms]",
            "iq [A_rms]",
            "vd [Vrms]",
            "Id eff. [A]",
            "i_d [A rms]",
            "ID_TRMS",
            "Id [Aeff]",
        ] {
            assert!(is(name, None), "{name}");
        }
        assert!(is("id", Some("Arms")) && is("uq", Some("[V rms]")));
        for name in ["id", "id_Pk", "terms_d", "alarms", "i_d [A]", "robot_arm_id", "effort_id", "forms"] {
            assert!(!is(name, Some("A")), "{name}");
        }
    }

    #[test]
    fn only_quantities_of_the_dq_frame_have_a_unit_for_it() {
        assert_eq!([Channel::Id, Channel::Uq].map(unit), [Some(Unit::AmpereRms), Some(Unit::VoltRms)]);
        assert_eq!([Channel::IA, Channel::UDc, Channel::T].map(unit), [None; 3]);
    }
}

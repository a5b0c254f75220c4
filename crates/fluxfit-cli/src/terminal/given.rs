//! Options that are proposed beside those of the command. A channel can be given once, so a proposal for one that the command gives
//! already takes the place of that option.

use crate::{invocation, shell};
use fluxfit_log::{parse_maps, parse_unit};
use std::ffi::OsString;

/// Options with a pair for each channel, and one with a number.
const PAIRS: [&str; 2] = ["--map", "--unit"];
const NUMBER: &str = "--pole-pairs";

/// What to do with options that are proposed: `add --unit omega_e=rpm-elec`, or what they replace.
pub(super) fn instruction(proposed: &str) -> String {
    match replaced(proposed, invocation::words()) {
        Some((old, new)) => format!("replace {old} by {new}"),
        None => format!("add {proposed}"),
    }
}

/// The same in brackets behind a sentence: the options, and what they replace.
pub(super) fn in_place(proposed: &str) -> String {
    match replaced(proposed, invocation::words()) {
        Some((old, new)) => format!("{new} in place of {old}"),
        None => proposed.to_owned(),
    }
}

/// The options among the words of a command that a proposal replaces, and what stands in their place; nothing where it only adds to them.
fn replaced(proposed: &str, words: &[OsString]) -> Option<(String, String)> {
    let words: Vec<String> = words.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let given = options(&words);
    let (mut old, mut new) = (Vec::new(), Vec::new());
    for (name, argument) in options(&shell::words(proposed)) {
        let conflicts: Vec<&String> =
            given.iter().filter(|(other, value)| *other == name && conflict(&name, &argument, value)).map(|(_, value)| value).collect();
        let mut merged = argument.clone();
        if PAIRS.contains(&name.as_str()) {
            // What else an option gave stays.
            let kept = conflicts.iter().flat_map(|value| pairs(value)).filter(|(channel, _)| !has(&argument, channel));
            kept.for_each(|(channel, value)| merged += &format!(",{channel}={value}"));
        }
        old.extend(conflicts.iter().map(|value| format!("{name} {}", shell::word(value.as_ref()))));
        new.push(format!("{name} {}", shell::word(merged.as_ref())));
    }
    (!old.is_empty()).then(|| (old.join(" "), new.join(" ")))
}

/// The options that matter here, with their arguments.
fn options(words: &[String]) -> Vec<(String, String)> {
    let is_ours = |name: &str| PAIRS.contains(&name) || name == NUMBER;
    let option = |(k, word): (usize, &String)| match word.split_once('=') {
        Some((name, argument)) if is_ours(name) => Some((name.to_owned(), argument.to_owned())),
        _ => is_ours(word).then(|| words.get(k + 1)).flatten().map(|argument| (word.clone(), argument.clone())),
    };
    words.iter().enumerate().filter_map(option).collect()
}

/// Whether both cannot be given together.
fn conflict(name: &str, proposed: &str, given: &str) -> bool {
    name == NUMBER || pairs(given).iter().any(|(channel, _)| has(proposed, channel))
}

fn has(argument: &str, channel: &str) -> bool {
    pairs(argument).iter().any(|(other, _)| other == channel)
}

/// Channels, by the names that the log has for them, and what is given for each.
fn pairs(argument: &str) -> Vec<(String, String)> {
    // A unit may be given by the name of the column: `speed=rpm-mech`.
    let unit = |pair: &str| Some((parse_unit(pair).ok()?.0, pair.split_once('=')?.1.trim().to_owned()));
    let units: Option<Vec<_>> = argument.split(',').map(unit).collect();
    units.unwrap_or_else(|| parse_maps(argument).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_that_is_given_is_replaced_and_the_others_stay() {
        let of = |proposed: &str, command: &str| {
            let words: Vec<OsString> = shell::words(command).into_iter().map(OsString::from).collect();
            replaced(proposed, &words).map(|(old, new)| format!("{old} -> {new}"))
        };
        let unit = "--unit omega_e=rpm-elec";
        assert_eq!(of(unit, "identify a.csv"), None);
        assert_eq!(of(unit, "identify a.csv --unit id=mA"), None);
        assert_eq!(of(unit, "identify a.csv --unit omega=rad/s").unwrap(), "--unit omega=rad/s -> --unit omega_e=rpm-elec");
        assert_eq!(of("--map id=Iq,iq=Id", "--map=id=Id,iq=Iq,ud=a").unwrap(), "--map id=Id,iq=Iq,ud=a -> --map id=Iq,iq=Id,ud=a");
        assert_eq!(of("--map 'ud=u d'", "--map ud=ud").unwrap(), "--map ud=ud -> --map 'ud=u d'");
        assert_eq!(of("--unit omega_e=rpm-elec", "--unit speed=rad/s").unwrap(), "--unit speed=rad/s -> --unit omega_e=rpm-elec");
        let both = "--unit omega_e=rpm-mech --pole-pairs 4";
        assert_eq!(of(both, "--pole-pairs 2").unwrap(), "--pole-pairs 2 -> --unit omega_e=rpm-mech --pole-pairs 4");
    }
}

//! What each fault's file says of its fault, in one form. `S` is the fault's own state, a small struct whose default is a drive without
//! the fault; the [table](super) finds that state among the others.

use crate::motor::Motor;

/// What a fault needs of the electrical angle, or what its numbers stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AngleNeed {
    /// Nothing: it happens in the rotor's frame.
    Nothing,
    /// It happens in the stator's frame, whose orientation does not matter: the integral of the speed will do.
    Traced,
    /// It happens in the stator's phases: the angle must be known.
    Known,
    /// The same, with the orientation of the stator among its numbers: only where the angle is not known, but the integral of the speed is.
    OnlyTraced,
}

impl AngleNeed {
    /// Whether a log meets it: whether its angle is known, and whether it is traced through all rows, up to a constant.
    pub(crate) fn is_met(self, known: bool, traced: bool) -> bool {
        match self {
            Self::Nothing => true,
            Self::Traced => traced,
            Self::Known => known,
            Self::OnlyTraced => traced && !known,
        }
    }
}

/// A fault of a drive, described.
pub(super) struct Description<S: 'static> {
    /// Name in files.
    pub(super) key: &'static str,
    /// Name in prose.
    pub(super) label: &'static str,
    /// Short name of the fault, which it shares with faults that explain the same: of those at most one is part of an answer.
    pub(super) family: &'static str,
    /// What must be known of the electrical angle.
    pub(super) angle: AngleNeed,
    /// Whether it makes the logged currents differ from the motor's.
    pub(super) alters_measured_current: bool,
    /// The numbers that a fit may move.
    pub(super) numbers: &'static [NumberDescription<S>],
    /// The states from which a fit begins, given the present state and the largest measured current, A. Several where the cost is not
    /// smooth in one of the numbers.
    pub(super) starts: fn(&S, f64) -> Vec<S>,
    /// The present state as each of the kinds that a fault has, of which no fit leads from one to the other, given the largest measured
    /// current, A; [none](no_kinds) if there is but one.
    pub(super) kinds: fn(&S, f64) -> Vec<S>,
    /// Whether fitted values are possible in a real drive, given the motor fitted beside them and the largest measured current, A.
    pub(super) is_physical: fn(&S, &Motor, f64) -> bool,
}

/// A number of a fault, described.
pub(super) struct NumberDescription<S> {
    /// Its names.
    pub(super) names: Names,
    /// Its value, SI.
    pub(super) get: fn(&S) -> f64,
    /// Sets its value, SI.
    pub(super) set: fn(&mut S, f64),
    /// Its usual size, SI, beside this motor and the largest measured current, A: the unit in which the steps of a fit are counted.
    pub(super) usual_size: fn(&Motor, f64) -> f64,
}

/// How a number is called.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names {
    /// Name in files.
    pub(super) key: &'static str,
    /// Name in prose.
    pub(super) label: &'static str,
    /// SI unit.
    pub(super) unit: &'static str,
}

/// The start of most faults: from where they are.
pub(super) fn present_state<S: Copy>(state: &S, _: f64) -> Vec<S> {
    vec![*state]
}

/// Most faults are of one kind.
pub(super) fn no_kinds<S>(_: &S, _: f64) -> Vec<S> {
    Vec::new()
}

/// The usual size of an angle or a ratio.
pub(super) fn one(_: &Motor, _: f64) -> f64 {
    1.0
}

/// The usual size of a current: the largest.
pub(super) fn peak_current(_: &Motor, peak: f64) -> f64 {
    peak
}

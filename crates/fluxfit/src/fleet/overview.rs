//! What the results of a fleet say together.

use super::{
    cause::{Cause, Causes},
    distribution::{CHANCE, Distribution},
    drift::Drift,
    member::{Member, Standing},
    row::FleetRow,
};
use crate::motor::Parameter;
use std::collections::{BTreeMap, BTreeSet};

/// What the results of a fleet say together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FleetOverview {
    /// The motors, the worst first.
    pub motors: Vec<Member>,
    /// How many rows the results have.
    pub rows: usize,
    /// The parameters over all motors.
    pub distributions: Vec<Distribution>,
    /// Parameters that move by more than their intervals say, those that move most first.
    pub drifts: Vec<Drift>,
    /// Motors of which some parameter is known in two windows or more.
    pub followed: usize,
    /// Why answers are missing: first whole answers, then parameters, each by the number of motors.
    pub causes: Vec<Cause>,
    /// Codes of warnings with the number of motors that have them, the most frequent first.
    pub warnings: Vec<(String, usize)>,
}

impl FleetOverview {
    /// Of the rows of the results, in any order.
    pub fn of(mut rows: Vec<FleetRow>) -> Self {
        let time = |row: &FleetRow| row.window_start.unwrap_or(f64::NEG_INFINITY);
        rows.sort_by(|one, other| one.motor.cmp(&other.motor).then(time(one).total_cmp(&time(other))));
        let mut causes = Causes::default();
        let mut warnings: BTreeMap<String, usize> = BTreeMap::new();
        let mut motors: Vec<(Member, Vec<Drift>)> = Vec::new();
        let (mut tests, mut followed) = (0, 0);
        for of_motor in rows.chunk_by(|one, next| one.motor == next.motor) {
            let Some(member) = Member::of(of_motor) else { continue };
            causes.add(of_motor, &member.best);
            for code in of_motor.iter().flat_map(|row| &row.warnings).collect::<BTreeSet<_>>() {
                *warnings.entry(code.clone()).or_default() += 1;
            }
            let mut drifts: Vec<Drift> = Parameter::ALL.into_iter().filter_map(|parameter| Drift::of(parameter, of_motor)).collect();
            tests += drifts.len();
            followed += usize::from(!drifts.is_empty());
            drifts.retain(|drift| drift.probability < CHANCE);
            motors.push((member, drifts));
        }
        motors.sort_by(|(one, _), (other, _)| one.worst_first(other));
        let mut drifts: Vec<Drift> = Vec::new();
        for (place, (_, of_motor)) in motors.iter_mut().enumerate() {
            // Of so many tests, one of twenty fleets that stay has one that says otherwise (Bonferroni).
            let moved = of_motor.drain(..).filter(|drift| drift.probability * (tests as f64) < CHANCE);
            drifts.extend(moved.map(|drift| Drift { motor: place, ..drift }));
        }
        drifts.sort_by(|one, other| other.range.total_cmp(&one.range).then(one.motor.cmp(&other.motor)));
        let motors: Vec<Member> = motors.into_iter().map(|(member, _)| member).collect();
        let mut warnings: Vec<(String, usize)> = warnings.into_iter().collect();
        warnings.sort_by_key(|(_, motors)| std::cmp::Reverse(*motors));
        let distributions = Parameter::ALL.into_iter().map(|parameter| Distribution::of(parameter, &motors)).collect();
        Self { rows: rows.len(), distributions, drifts, followed, causes: causes.most_first(), warnings, motors }
    }

    /// How many motors stand so.
    pub fn count(&self, standing: Standing) -> usize {
        self.motors.iter().filter(|motor| motor.standing == standing).count()
    }

    /// The motors that stand apart in some parameter, those farthest from the median first.
    pub fn apart(&self) -> Vec<&Member> {
        self.named(self.distributions.iter().flat_map(|one| &one.outliers).map(|outlier| (outlier.motor, outlier.deviations.abs())))
    }

    /// The motors of which some parameter drifts, those that move most first.
    pub fn drifting(&self) -> Vec<&Member> {
        self.named(self.drifts.iter().map(|drift| (drift.motor, drift.range)))
    }

    /// Each motor once, by its largest number.
    fn named(&self, numbers: impl Iterator<Item = (usize, f64)>) -> Vec<&Member> {
        let mut largest: BTreeMap<usize, f64> = BTreeMap::new();
        for (motor, number) in numbers {
            let entry = largest.entry(motor).or_insert(number);
            *entry = entry.max(number);
        }
        let mut ordered: Vec<(usize, f64)> = largest.into_iter().collect();
        ordered.sort_by(|one, other| other.1.total_cmp(&one.1));
        ordered.into_iter().filter_map(|(motor, _)| self.motors.get(motor)).collect()
    }
}

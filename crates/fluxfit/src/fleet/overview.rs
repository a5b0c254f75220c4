//! What the results of a fleet say together.

use super::{
    cause::{Cause, Causes},
    distribution::{CHANCE, Distribution},
    drift::Drift,
    member::{Member, Standing},
    row::FleetRow,
};
use crate::motor::Parameter;
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

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
        let mut warnings: BTreeMap<Arc<str>, usize> = BTreeMap::new();
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
        let read = rows.len();
        // The memory is wanted for what follows.
        drop(rows);
        motors.sort_by(|(one, _), (other, _)| one.worst_first(other));
        let mut drifts: Vec<Drift> = Vec::new();
        for (place, (_, of_motor)) in motors.iter_mut().enumerate() {
            // Of so many tests, one of twenty fleets that stay has one that says otherwise (Bonferroni).
            let moved = of_motor.drain(..).filter(|drift| drift.probability * (tests as f64) < CHANCE);
            drifts.extend(moved.map(|drift| Drift { motor: place, ..drift }));
        }
        drifts.sort_by(|one, other| other.range.total_cmp(&one.range).then(one.motor.cmp(&other.motor)));
        let motors: Vec<Member> = motors.into_iter().map(|(member, _)| member).collect();
        let mut warnings: Vec<(String, usize)> = warnings.into_iter().map(|(code, motors)| (code.to_string(), motors)).collect();
        warnings.sort_by_key(|(_, motors)| std::cmp::Reverse(*motors));
        let distributions = Parameter::ALL.into_iter().map(|parameter| Distribution::of(parameter, &motors)).collect();
        Self { rows: read, distributions, drifts, followed, causes: causes.most_first(), warnings, motors }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Verdict,
        fleet::row::{FleetEstimate, FleetValue},
    };

    fn row(motor: &str, start: f64, value: f64, half_width: f64) -> FleetRow {
        let found = FleetEstimate { verdict: Verdict::Identified, value: Some(FleetValue { value, half_width }), reason: None };
        FleetRow {
            motor: motor.into(),
            source: "s".into(),
            window_start: Some(start),
            estimates: std::array::from_fn(|_| found.clone()),
            warnings: Vec::new(),
            error: None,
        }
    }

    /// Values of 21 motors, evenly from 0.9 to 1.1: their median absolute deviation is 0.05.
    fn evenly() -> Vec<FleetRow> {
        (0..21).map(|k| row(&format!("m{k:02}"), 0.0, 0.9 + 0.01 * f64::from(k), 0.02)).collect()
    }

    #[test]
    fn a_motor_far_away_stands_apart_unless_its_interval_reaches_the_others() {
        // 0.4 from the median of 1.0: five times 1.4826 x 0.05. An interval of ±0.3 has a standard error of 0.15, which makes it 2.4.
        let sharp = FleetOverview::of([evenly(), vec![row("far", 0.0, 1.4, 0.02)]].concat());
        let vague = FleetOverview::of([evenly(), vec![row("far", 0.0, 1.4, 0.3)]].concat());
        assert_eq!(sharp.apart().iter().map(|motor| &*motor.best.motor).collect::<Vec<_>>(), ["far"]);
        assert!(vague.apart().is_empty());
        // Of three motors nobody can say which one is wrong.
        let few = [row("a", 0.0, 1.0, 0.01), row("b", 0.0, 1.01, 0.01), row("c", 0.0, 3.0, 0.01)];
        assert!(FleetOverview::of(few.to_vec()).apart().is_empty());
    }

    #[test]
    fn a_movement_that_is_likely_somewhere_in_a_fleet_is_no_drift() {
        // Two windows 3.5 standard errors apart in their difference: 0.0005 by chance, but not in one of a thousand motors.
        let half = 0.01 * 1.959_964;
        let windows = |name: &str, step: f64| [row(name, 0.0, 1.0, half), row(name, 60.0, 1.0 + step, half)];
        let step = 3.5 * 0.01 * 2.0_f64.sqrt();
        assert_eq!(FleetOverview::of(windows("m", step).to_vec()).drifting().len(), 1);
        let mut rows: Vec<FleetRow> = (0..1000).flat_map(|k| windows(&format!("m{k}"), 0.0)).collect();
        rows.extend(windows("moved", step));
        assert!(FleetOverview::of(rows.clone()).drifts.is_empty());
        rows.extend(windows("far", 2.0 * step));
        let found = FleetOverview::of(rows);
        assert_eq!((&*found.drifting()[0].best.motor, found.drifts.len(), found.followed), ("far", 4, 1002));
    }

    #[test]
    fn the_worst_stand_first_and_a_motor_is_known_from_its_best_window() {
        let error = |motor: &str, start: f64| FleetRow { error: Some("no".into()), ..row(motor, start, 1.0, 0.01) };
        let mut refused = row("refused", 0.0, 1.0, 0.01);
        refused.estimates[1] = FleetEstimate { verdict: Verdict::NotIdentifiable, value: None, reason: None };
        let rows = vec![row("good", 0.0, 1.0, 0.01), error("part", 0.0), row("part", 60.0, 1.0, 0.01), refused, error("none", 0.0)];
        let found = FleetOverview::of(rows);
        let order: Vec<(&str, usize)> = found.motors.iter().map(|motor| (&*motor.best.motor, motor.failed)).collect();
        assert_eq!(order, [("none", 1), ("refused", 0), ("part", 1), ("good", 0)]);
        assert_eq!(Standing::ALL.map(|standing| found.count(standing)), [1, 1, 0, 2]);
        assert_eq!(found.distributions[1].verdicts, [2, 0, 1]);
    }
}

//! One measurement in place of several: what was tried for one parameter may be enough for others too.

use super::{
    super::judge::verdict::IDENTIFIED,
    measurement::{Measurement, Promised},
    remedy::Remedy,
};
use crate::motor::{PARAMETERS, Parameter};

/// Gives parameters the same measurement where one that was tried makes several of them identified: that of the most parameters; of equals
/// that which takes the least time.
pub(super) fn share(remedies: &mut [Option<Remedy>], tried: &[(Measurement, [f64; PARAMETERS])]) {
    let mut open: Vec<Parameter> = Parameter::ALL.into_iter().filter(|parameter| asks_to_measure(remedies, *parameter)).collect();
    while let Some((measurement, widths)) = most(tried, &open) {
        let done = |parameter: &Parameter| widths[*parameter as usize] <= IDENTIFIED;
        for parameter in open.iter().copied().filter(done) {
            let promised = Promised { measurement, parameter, half_width: widths[parameter as usize] };
            remedies[parameter as usize] = Some(Remedy::Measure(promised));
        }
        open.retain(|parameter| !done(parameter));
    }
}

/// Whether the remedy is one that a measurement may take the place of.
fn asks_to_measure(remedies: &[Option<Remedy>], parameter: Parameter) -> bool {
    use Remedy::{AddStretch, HoldLonger, Measure, SpreadPoints};
    matches!(remedies[parameter as usize], Some(Measure(_) | AddStretch { .. } | HoldLonger { .. } | SpreadPoints { .. }))
}

/// What makes most of these parameters identified, if it does so for two or more.
fn most(tried: &[(Measurement, [f64; PARAMETERS])], open: &[Parameter]) -> Option<(Measurement, [f64; PARAMETERS])> {
    let done = |widths: &[f64; PARAMETERS]| open.iter().filter(|parameter| widths[**parameter as usize] <= IDENTIFIED).count();
    let by_time = |one: &Measurement, other: &Measurement| one.effort().partial_cmp(&other.effort()).unwrap_or(std::cmp::Ordering::Equal);
    let best = tried.iter().max_by(|(one, of_one), (other, of_other)| done(of_one).cmp(&done(of_other)).then(by_time(other, one)));
    best.filter(|(_, widths)| done(widths) > 1).copied()
}

#[cfg(test)]
mod tests {
    use super::{super::measurement::Place, *};

    const SHORT: Measurement = Measurement::Stretch { seconds: 0.05, place: Place::Id(-3.0), omega_e: None };
    const LONG: Measurement = Measurement::Stretch { seconds: 0.5, place: Place::Id(-3.0), omega_e: None };

    fn of(parameter: Parameter, measurement: Measurement, half_width: f64) -> Option<Remedy> {
        Some(Remedy::Measure(Promised { measurement, parameter, half_width }))
    }

    #[test]
    fn one_measurement_for_all_takes_the_place_of_several() {
        let stretch = Some(Remedy::AddStretch { id: -3.0, also: None });
        let mut remedies = [stretch.clone(), of(Parameter::Ld, SHORT, 0.01), of(Parameter::Lq, SHORT, 0.02), stretch];
        share(&mut remedies, &[(SHORT, [1.0, 0.01, 0.02, 1.0]), (LONG, [0.04, 0.01, 0.01, 0.03])]);
        let [rs, ld, lq, psi_f] = Parameter::ALL;
        assert_eq!(remedies, [of(rs, LONG, 0.04), of(ld, LONG, 0.01), of(lq, LONG, 0.01), of(psi_f, LONG, 0.03)]);
    }

    #[test]
    fn of_measurements_that_do_the_same_the_shortest_is_taken() {
        let mut remedies = [of(Parameter::Rs, LONG, 0.01), of(Parameter::Ld, SHORT, 0.01), None, None];
        share(&mut remedies, &[(LONG, [0.01; PARAMETERS]), (SHORT, [0.02; PARAMETERS])]);
        assert_eq!(remedies, [of(Parameter::Rs, SHORT, 0.02), of(Parameter::Ld, SHORT, 0.02), None, None]);
    }

    /// What is wrong with the drive, or identified already, is no matter of a measurement; and one parameter shares nothing.
    #[test]
    fn other_remedies_stay() {
        let mut remedies = [Some(Remedy::StateVoltageTiming), of(Parameter::Ld, LONG, 0.01), None, None];
        let before = remedies.clone();
        share(&mut remedies, &[(SHORT, [0.01; PARAMETERS])]);
        assert_eq!(remedies, before);
    }
}

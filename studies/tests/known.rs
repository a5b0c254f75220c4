//! The logs of simulated drives beside the project, which another simulator wrote: how many numbers are wrong, and how many identified.
//! `./check --thorough` runs it.

#![allow(clippy::unwrap_used)]

use fluxfit_studies::known::{Kind, Outcome, judged, read, table};
use std::path::Path;

/// Of 120: most that may lie more than 1.5 half-widths and 0.05 % from the truth, and the farthest.
const MOST_WRONG: usize = 1;
const FARTHEST: f64 = 2.5;

/// Fewest that must be identified.
const LEAST_IDENTIFIED: usize = 95;

#[test]
fn numbers_hold_on_drives_with_faults() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/drives");
    if !folder.exists() {
        eprintln!("skipped: ../shared/data/drives is absent");
        return;
    }
    let outcomes: Vec<Outcome> = read(&folder).unwrap().into_iter().map(|log| log.identified().unwrap()).collect();
    println!("{}", table(&outcomes));
    let wrong = judged(&outcomes).filter(|number| number.is_wrong()).count();
    assert!(wrong <= MOST_WRONG, "{wrong} numbers are wrong");
    assert!(judged(&outcomes).all(|number| !number.is_wrong() || number.error.abs() <= FARTHEST * number.half_width));
    let identified = outcomes.iter().filter(|outcome| outcome.log.kind == Kind::Judged).flat_map(Outcome::identified).count();
    assert!(identified >= LEAST_IDENTIFIED, "{identified} numbers are identified");
    for outcome in &outcomes {
        match outcome.log.kind {
            Kind::Judged => {}
            Kind::Unseen => assert!(outcome.unseen > 0, "{} names nothing", outcome.log.name),
            Kind::Saturated => assert_eq!(outcome.identified().count(), 0, "{}", outcome.log.name),
        }
    }
}

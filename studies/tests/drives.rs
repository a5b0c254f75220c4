//! The draws of the `drives` program: every log can be simulated, and a number of logs is the same on any number of threads.

#![allow(clippy::unwrap_used)]

use fluxfit_studies::{
    drives::{Drawn, course::Course, fault::Fault, log_kind::LogKind, survey},
    rated::typical,
};

const DRAWS: u64 = 400;

#[test]
fn every_draw_is_a_drive_that_can_be_simulated() {
    let motors = typical();
    let drawn: Vec<Drawn> = (0..DRAWS).map(|index| Drawn::new(index, &motors).unwrap()).collect();
    for one in &drawn {
        assert_eq!(one.scenario.check(), Ok(()), "log {}", one.index);
        assert!(one.scenario.logged_rows() >= 4000 && one.faults.len() <= 3);
        let mut different = one.faults.clone();
        different.dedup();
        assert_eq!(one.faults, different, "log {}", one.index);
    }
    // Of 400 draws among 12, fewer than 14 come once in a thousand tables: the binomial distribution.
    let enough = |name: &str, count: usize| assert!(count >= 14, "{name}: {count}");
    for motor in &motors {
        enough("motor", drawn.iter().filter(|one| one.rated == *motor).count());
    }
    Fault::ALL.iter().for_each(|fault| enough(fault.label(), drawn.iter().filter(|one| one.faults.contains(fault)).count()));
    Course::ALL.iter().for_each(|course| enough(course.label(), drawn.iter().filter(|one| one.course == *course).count()));
    LogKind::LABELS.iter().for_each(|label| enough(label, drawn.iter().filter(|one| one.kind.label() == *label).count()));
}

#[test]
fn no_motors_give_no_logs() {
    assert!(survey(0..3, &[], Drawn::new).is_empty());
}

/// Results come in index order, whatever the threads do.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        format!("{:?}", pool.install(|| survey(0..4, &typical()[..3], Drawn::new)))
    };
    assert_eq!(on(1), on(3));
}

//! Estimators on a stream: many draws against the Cramér-Rao bound, random starts, the warming motor, rank-deficient logs.
//!
//! `online [DRAWS]`; the default is 200 draws, and 0 leaves out all but the warming motor and the rank-deficient logs.
// A table on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit_drive::scenario::reference_cases::two_modes;
use fluxfit_setup::read_scenario;
use fluxfit_studies::online::{Deficient, Reached, false_alarms, followed, rank_deficient, reached};
use fluxfit_track::{DriveFaults, Method};
use std::{error::Error, path::Path};

/// Standard deviation of the noise of each axis, A: 50 mA of each of three sensors.
const NOISE: f64 = 0.040_824_829;

fn row(reached: &Reached) -> String {
    let four = |values: [f64; 4], digits: usize| values.map(|value| format!("{value:.digits$}")).join(" / ");
    let coverage = reached.coverage.map_or_else(|| "none".to_owned(), |coverage| four(coverage.map(|share| 100.0 * share), 1));
    let key = reached.method.key();
    format!(
        "| {key} | {} | {} | {coverage} | {}/{} |",
        four(reached.over_bound, 2),
        four(reached.bias_percent, 3),
        reached.settled,
        reached.draws
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let draws: u64 = std::env::args().nth(1).map_or(Ok(200), |text| text.parse())?;
    if draws > 0 {
        against_the_bound(draws)?;
    }
    warming_motor()?;
    for kind in Deficient::ALL {
        println!("200 logs, {kind:?}: (printed, of them right) by parameter: {:?}", rank_deficient(kind, 200));
    }
    Ok(())
}

fn against_the_bound(draws: u64) -> Result<(), Box<dyn Error>> {
    let mut scenario = two_modes();
    scenario.duration = 0.9;
    println!("| {draws} draws | rms / bound | bias % | 95 % coverage | within 5 % |\n|---|---|---|---|---|");
    let best = [Method::Ekf, Method::EkfTracking, Method::Rls];
    for method in reached(&scenario, NOISE, &best, draws, 1.35)? {
        println!("{}", row(&method));
    }
    let others: Vec<Method> = Method::ALL.into_iter().filter(|method| !best.contains(method)).collect();
    for method in reached(&scenario, NOISE, &others, draws.min(500), 1.35)? {
        println!("{}", row(&method));
    }
    for method in reached(&scenario, NOISE, &best[..2], draws.min(500), 3.0)? {
        println!("starts within a factor of 3: {}: {} of {} end within 5 %", method.method.key(), method.settled, method.draws);
    }
    Ok(())
}

fn warming_motor() -> Result<(), Box<dyn Error>> {
    let [warming, dead_time] = ["warming", "warming_dead_time"].map(|name| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/scenarios/{name}.toml"));
        read_scenario(&path).map(|read| read.scenario)
    });
    let (warming, dead_time) = (warming?, dead_time?);
    let unknown = DriveFaults::default();
    // Dead time times carrier times DC voltage.
    let voltage = dead_time.inverter.dead_time * dead_time.inverter.carrier * dead_time.inverter.u_dc;
    let known = DriveFaults { dead_time_voltage: voltage, ..unknown };
    for (name, scenario, faults, method) in [
        ("warming", &warming, unknown, Method::EkfTracking),
        ("warming", &warming, unknown, Method::Rls),
        ("warming", &warming, unknown, Method::RlsExponential),
        ("warming_dead_time, unknown", &dead_time, unknown, Method::EkfTracking),
        ("warming_dead_time, known", &dead_time, known, Method::EkfTracking),
        ("warming_dead_time, known", &dead_time, known, Method::Rls),
    ] {
        let followed = followed(scenario, method, faults, 0)?;
        println!(
            "{name}, {}: rms % {:.3?}, quiet % {:.1?}, step {:.3} s ({} found), coverage {:.3?}",
            method.key(),
            followed.rms_percent,
            followed.quiet_percent,
            followed.step_s,
            followed.steps,
            followed.coverage
        );
    }
    println!("false alarms in 300 s of constant parameters: {}", false_alarms(&warming, 5)?);
    Ok(())
}

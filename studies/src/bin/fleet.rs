//! Many motors, each in a rig scaled to its rating: simulated, identified, counted.
//!
//! `fleet MOTORS.csv [--model steady|output-error]` reads one motor a row (`Ld_H, Lq_H, Rs_ohm, pole_pairs, psi_pm_Wb, Udc_V,
//! I_nom_A, omega_e_nom_rad_s`). Each turns at half its nominal speed against half its rated torque, first with i_d = 0 and then
//! with -0.2 of its rated current, under a switched inverter and with 0.5 % of the rated current as noise on each current sensor.
//! One table: how many parameters were identified, and how many of those lie within four of their own standard errors of the truth;
//! then the rest, with reasons.
// The table on standard output is what this program is for.
#![allow(clippy::print_stdout)]

use fluxfit::{Model, Request, Verdict, evidence::Identification, identify, motor::Parameter};
use fluxfit_drive::{
    Scenario,
    scenario::{Control, Inverter, Logging, Mechanics, Schedule, Sensors, SimulatedMotor},
    schedule::{Profile, Ramp},
    simulate,
};
use fluxfit_studies::rated::{Rated, read};
use rayon::prelude::*;
use std::{collections::BTreeMap, error::Error, path::Path};

/// Noise of each current sensor, as a fraction of the rated current.
const NOISE: f64 = 0.005;
/// i_d of the second mode, as a fraction of the rated current.
const ID: f64 = -0.2;
/// i_q, as a fraction of the rated current.
const IQ: f64 = 0.5;
/// Speed, as a fraction of the nominal one.
const SPEED: f64 = 0.5;
/// Samples per second: at least the usual 10 kHz, 20 per time constant of the winding.
const SAMPLE_RATE: f64 = 10e3;
const SAMPLES_PER_TIME_CONSTANT: f64 = 20.0;
/// Time to run up to speed, s; the inertia is such that it takes a quarter of the rated torque.
const RUN_UP: f64 = 0.3;
/// When i_d moves, and the end, s.
const SECOND_MODE: f64 = 0.9;
const END: f64 = 1.5;
/// What counts as covered, in standard errors.
const STANDARD_ERRORS: f64 = 4.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (path, model) = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [path] | [path, "--model", "output-error"] => (Path::new(path), Model::OutputError),
        [path, "--model", "steady"] => (Path::new(path), Model::Steady),
        _ => return Err("give a file of motors: fleet MOTORS.csv [--model steady|output-error]".into()),
    };
    let motors = read(path)?;
    let found: Vec<(&Rated, Result<Identification, String>)> = motors.par_iter().map(|rated| (rated, find(rated, model))).collect();
    let answered: Vec<(&Rated, &Identification)> = found.iter().filter_map(|(rated, found)| Some((*rated, found.as_ref().ok()?))).collect();
    println!("{} motors, {} simulated and identified with {}\n", motors.len(), answered.len(), model.label());
    println!(
        "           identified   weak   not   within {STANDARD_ERRORS} standard errors   median error %   median standard error %   rms of error / statistical part"
    );
    for parameter in Parameter::ALL {
        println!("{}", line(parameter, &answered));
    }
    rest(&found);
    Ok(())
}

/// The rig, scaled.
fn scenario(rated: &Rated) -> Scenario {
    let Rated { motor, current, .. } = rated;
    let speed = SPEED * rated.omega_e / f64::from(rated.pole_pairs);
    let torque = 1.5 * f64::from(rated.pole_pairs) * motor.psi_f * current;
    let sample_rate = SAMPLE_RATE.max(SAMPLES_PER_TIME_CONSTANT * motor.rs / motor.ld.min(motor.lq));
    Scenario {
        duration: END,
        seed: rated.row as u64,
        motor: SimulatedMotor::new(motor.rs, (*motor).into(), rated.pole_pairs),
        mechanics: Mechanics::Free { inertia: 0.25 * torque * RUN_UP / speed, friction: 0.01 * torque / speed },
        inverter: Inverter::ideal(rated.u_dc, 0.5 * sample_rate),
        control: Control { trip_current: 3.0 * current, ..Control::new(200.0, 10.0, 1.5 * current) },
        schedule: Schedule {
            id: Profile::new(vec![Ramp { at: SECOND_MODE, to: ID * current, over: 0.0 }]),
            speed: Profile::new(vec![Ramp { at: 0.0, to: speed, over: RUN_UP }]),
            load: Profile::new(vec![Ramp { at: 0.0, to: IQ * torque, over: RUN_UP }]),
            ..Schedule::default()
        },
        sensors: Sensors { current_noise: NOISE * current, ..Sensors::IDEAL },
        logging: Logging::COMPLETE,
    }
}

fn find(rated: &Rated, model: Model) -> Result<Identification, String> {
    let recording = simulate(&scenario(rated), 0, || ()).map_err(|error| error.to_string())?;
    let log = recording.log().map_err(|error| error.to_string())?;
    identify(&log, &Request { model: Some(model), ..Request::default() })
        .map(|answer| answer.identification)
        .map_err(|error| error.to_string())
}

/// The error of a parameter, and its standard error, as fractions of the truth.
fn error(rated: &Rated, found: &Identification, parameter: Parameter) -> (f64, f64) {
    let (judgement, truth) = (found.parameter(parameter), rated.motor.get(parameter));
    (judgement.raw / truth - 1.0, judgement.uncertainty.standard_error() / truth)
}

fn line(parameter: Parameter, answered: &[(&Rated, &Identification)]) -> String {
    let count = |verdict| answered.iter().filter(|(_, found)| found.parameter(parameter).verdict == verdict).count();
    let identified: Vec<(f64, f64)> = answered
        .iter()
        .filter(|(_, found)| found.parameter(parameter).verdict == Verdict::Identified)
        .map(|(rated, found)| error(rated, found, parameter))
        .collect();
    let within = identified.iter().filter(|(error, standard_error)| error.abs() <= STANDARD_ERRORS * standard_error).count();
    let median = |values: Vec<f64>| {
        let mut values = values;
        values.sort_by(f64::total_cmp);
        100.0 * values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let ratios = answered.iter().map(|(rated, found)| {
        let (error, _) = error(rated, found, parameter);
        (error * rated.motor.get(parameter) / found.parameter(parameter).uncertainty.statistical).powi(2)
    });
    let ratio = (ratios.sum::<f64>() / answered.len() as f64).sqrt();
    format!(
        "  {:5}    {:10} {:6} {:5}   {within:4} of {:4} = {:5.1} %         {:14.3} {:25.3} {ratio:33.2}",
        parameter.symbol(),
        identified.len(),
        count(Verdict::Weak),
        count(Verdict::NotIdentifiable),
        identified.len(),
        100.0 * within as f64 / identified.len() as f64,
        median(identified.iter().map(|(error, _)| error.abs()).collect()),
        median(identified.iter().map(|(_, standard_error)| *standard_error).collect()),
    )
}

/// What was not identified, by reason; what was not simulated, and why; what was confident and wrong.
fn rest(found: &[(&Rated, Result<Identification, String>)]) {
    println!("\nthe rest:");
    let mut reasons: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (rated, found) in found {
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                reasons.entry(format!("not simulated or read: {error}")).or_default().push(rated.row);
                continue;
            }
        };
        for judgement in found.parameters.iter().filter(|judgement| judgement.verdict != Verdict::Identified) {
            let parts = &judgement.uncertainty;
            let mostly = parts.largest_part().label();
            let reason = format!("{} {}, mostly for its {mostly}", judgement.parameter.symbol(), judgement.verdict.key());
            reasons.entry(reason).or_default().push(rated.row);
        }
        for parameter in Parameter::ALL {
            let (error, standard_error) = error(rated, found, parameter);
            if found.parameter(parameter).verdict == Verdict::Identified && error.abs() > STANDARD_ERRORS * standard_error {
                let reason = format!("{} identified, but {:.1} standard errors off", parameter.symbol(), (error / standard_error).abs());
                reasons.entry(reason).or_default().push(rated.row);
            }
        }
    }
    let shown = |rows: &[usize]| rows.iter().take(12).map(ToString::to_string).collect::<Vec<_>>().join(", ");
    for (reason, rows) in &reasons {
        println!("  {:4}  {reason}: row {}{}", rows.len(), shown(rows), if rows.len() > 12 { ", .." } else { "" });
    }
}

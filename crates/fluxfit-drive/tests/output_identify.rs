#![allow(clippy::unwrap_used, clippy::panic)]
//! scratch
use fluxfit::{
    Columns, Log,
    identify::{Settings, identify},
    motor::Parameter,
    paper,
};
use std::path::Path;
fn example(name: &str, voltages: [&str; 2]) -> Log {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/logs").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = |name: &str| -> Vec<f64> {
        let at = header.iter().position(|other| *other == name).unwrap();
        text.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
    };
    let [ud, uq] = voltages.map(column);
    Log::new(Columns {
        t: column("t"),
        ud,
        uq,
        id: column("id"),
        iq: column("iq"),
        omega_e: column("omega_e"),
        theta_e: Some(column("theta_e")),
        ..Columns::default()
    })
    .unwrap()
}
fn show(name: &str, log: &Log) {
    let t = std::time::Instant::now();
    let found = identify(log, &Settings::default()).unwrap();
    println!("== {name} {:?} {:?}", found.model, t.elapsed());
    let out = found.output.as_ref().unwrap();
    for p in Parameter::ALL {
        let j = found.parameter(p);
        println!(
            "  {} {:+.4} %  se {:.4} % stat {:.4} % {:?} {:?}",
            p.key(),
            100.0 * (j.raw / paper::MOTOR.get(p) - 1.0),
            100.0 * j.uncertainty.standard_error() / j.raw,
            100.0 * j.uncertainty.statistical / j.raw,
            j.verdict,
            j.uncertainty.largest_part()
        );
    }
    println!("  {:?} rms {:?} rho {:.3}", out.voltage_reading, out.residual_rms(), out.correlation_of_neighbours);
    for r in &out.readings {
        println!("    {:?} {:.4e}", r.reading.key(), r.mean_square());
    }
    for r in &out.terms {
        println!("    {:?} gain {:.1} {:?}", r.term, r.gain, r.outcome);
    }
    for n in &out.nuisance {
        println!("    {:?} {:.5} +- {:.5}", n.unknown, n.value, n.standard_error);
    }
    for w in &found.warnings {
        println!("  warn {}", w.code);
    }
}
#[test]
fn scratch() {
    for f in ["paper_rig_ideal.csv", "paper_rig_pwm_noise.csv"] {
        show(f, &example(f, ["ud", "uq"]));
        show(f, &example(f, ["ud_ref", "uq_ref"]));
    }
    show("id0", &example("id_zero_two_loads.csv", ["ud", "uq"]));
}
#[test]
fn timing() {
    use fluxfit::{
        levenberg_marquardt::*,
        motor::Motor,
        objective::{acting_voltage::VoltageReading, output_error::OutputError},
    };
    let log = example("paper_rig_pwm_noise.csv", ["ud", "uq"]);
    let o = OutputError::of(&log, VoltageReading::Centered).unwrap();
    let m = Motor { rs: 1.1, ld: 6e-3, lq: 11e-3, psi_f: 0.16 };
    let t = std::time::Instant::now();
    for _ in 0..10 {
        std::hint::black_box(o.cost(&m));
    }
    println!("cost {:?}", t.elapsed() / 10);
    let t = std::time::Instant::now();
    for _ in 0..10 {
        std::hint::black_box(o.residuals(&m.into()));
    }
    println!("residuals {:?}", t.elapsed() / 10);
    let t = std::time::Instant::now();
    std::hint::black_box(jacobian(&o, &m.into(), &MOTOR));
    println!("jacobian {:?}", t.elapsed());
    for r in VoltageReading::ALL {
        let o = OutputError::of(&log, r).unwrap();
        let t = std::time::Instant::now();
        let p = polish(&o, &m);
        println!("polish {:?} {:?} {}", t.elapsed(), p.drive.motor, p.converged);
    }
}

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
use fluxfit::motor::Motor;
use fluxfit_drive::{
    Scenario,
    scenario::*,
    schedule::{Course, Move},
    simulate,
};
fn report(name: &str, scenario: &Scenario, truth: Motor) {
    let rec = simulate(scenario, 0, || ()).unwrap();
    let log = rec.log().unwrap();
    let t = std::time::Instant::now();
    let found = identify(&log, &Settings::default()).unwrap();
    println!("== {name} {:?} {} rows {:?}", found.model.0, log.rows(), t.elapsed());
    let Some(out) = found.output.as_ref() else { return };
    for p in Parameter::ALL {
        let j = found.parameter(p);
        println!(
            "  {} {:+.4} %  se {:.4} % stat {:.4} % {:?} {:?}",
            p.key(),
            100.0 * (j.raw / truth.get(p) - 1.0),
            100.0 * j.uncertainty.standard_error() / j.raw,
            100.0 * j.uncertainty.statistical / j.raw,
            j.verdict,
            j.uncertainty.largest_part()
        );
    }
    println!("  {:?} rms {:?} rho {:.3}", out.voltage_reading, out.residual_rms(), out.correlation_of_neighbours);
    for r in out.readings.iter().take(3) {
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
fn emrax() -> (Scenario, Motor) {
    let m = Motor { rs: 18e-3, ld: 175e-6, lq: 250e-6, psi_f: 0.0515 };
    let mut s = Scenario::paper();
    s.motor = SimulatedMotor { rs: m.rs, magnetics: m.into(), pole_pairs: 10 };
    s.inverter = Inverter { dead_time: 2e-6, ..Inverter::ideal(300.0, 10e3) };
    s.mechanics = Mechanics::Dyno;
    s.control = Control::new(200.0, 10.0, 150.0);
    s.schedule = Schedule {
        id: Course::new(vec![Move { at: 0.2, to: -30.0, over: 0.0 }]),
        iq: Course::new(vec![Move { at: 0.02, to: 100.0, over: 0.0 }]),
        speed: Course::constant(100.0),
        ..Schedule::default()
    };
    s.duration = 0.4;
    s.sensors = Sensors { current_noise: 0.5, ..Sensors::IDEAL };
    (s, m)
}
#[test]
fn faults() {
    let only = std::env::var("ONLY").unwrap_or_default();
    let report = |name: &str, s: &Scenario, m: Motor| {
        if name.contains(&only) {
            report(name, s, m)
        }
    };
    let (s, m) = emrax();
    report("dead time 2us", &s, m);
    let mut n = s.clone();
    n.inverter.dead_time = 0.0;
    report("no dead time", &n, m);
    let base = || {
        let mut s = Scenario::paper();
        s.sensors.current_noise = 0.05;
        s
    };
    let p = paper::MOTOR;
    let mut a = base();
    a.inverter.dead_time = 2e-6;
    report("paper dead 2us", &a, p);
    let mut a = base();
    a.sensors.angle_offset = 3f64.to_radians();
    report("angle 3 deg", &a, p);
    let mut a = base();
    a.sensors.current_offset = [0.2, 0.0, 0.0];
    report("offset", &a, p);
    let mut a = base();
    a.sensors.current_gain = [1.02, 1.0, 1.0];
    report("gain three", &a, p);
    let mut a = base();
    a.sensors.current_gain = [1.0, 1.02, 1.0];
    a.sensors.current_sensors = CurrentSensors::Two;
    report("gain two", &a, p);
    let mut a = base();
    a.inverter.voltage_noise = 1.0;
    report("voltage noise", &a, p);
    let mut a = base();
    a.sensors.encoder_steps = Some(4096);
    report("encoder", &a, p);
}
#[test]
fn shape() {
    use fluxfit::{
        levenberg_marquardt::*,
        objective::{
            acting_voltage::VoltageReading,
            adjustable::{Adjustable, Unknown},
            output_error::OutputError,
        },
    };
    for noise in [0.0, 0.5] {
        let (mut s, m) = emrax();
        s.sensors.current_noise = noise;
        let log = simulate(&s, 0, || ()).unwrap().log().unwrap();
        let o = OutputError::of(&log, VoltageReading::Centered).unwrap();
        for w in [0.2, 1.0, 3.0, 6.0, 12.0, 20.0] {
            for r in [-12.0, -6.0, -3.0, 0.0, 3.0, 6.0, 12.0] {
                let d = Adjustable::from(m).with(Unknown::DeadTime, 6.0).with(Unknown::DeadTimeWidth, w).with(Unknown::DeadTimeRipple, r);
                print!(" {:.3}", (o.cost_of(&d) / (2.0 * o.rows() as f64)).sqrt());
            }
            println!("  w {w}");
        }
        let d = Adjustable::from(m).with(Unknown::DeadTime, 6.0).with(Unknown::DeadTimeWidth, 3.0).with(Unknown::DeadTimeRipple, 3.0);
        let mut u = vec![Unknown::DeadTime, Unknown::DeadTimeWidth, Unknown::DeadTimeRipple];
        let p = polish_unknowns(&o, &d, &u, &[]);
        println!("{:?} rms {}", p.drive, (p.cost / (2.0 * o.rows() as f64)).sqrt());
        u.extend(MOTOR);
        let p = polish_unknowns(&o, &p.drive, &u, &[]);
        println!("{:?} rms {}", p.drive, (p.cost / (2.0 * o.rows() as f64)).sqrt());
        let r = o.residuals(&p.drive);
        let th = log.columns().theta_e.as_ref().unwrap();
        for k in 3000..3100 {
            if k < 3066 {
                println!(
                    "{k} th {:.2} r {:.3} {:.3}  ud {:.2} uq {:.2} id {:.2} iq {:.2}",
                    th[k],
                    r[2 * k],
                    r[2 * k + 1],
                    log.columns().ud[k],
                    log.columns().uq[k],
                    log.columns().id[k],
                    log.columns().iq[k]
                );
            }
        }
    }
}

//! Angles that begin elsewhere, or are counted in other units, beside phase quantities.

use crate::fixtures::map;
use fluxfit_log::{LogOptions, parse_log};
use fluxfit_units::Unit;
use std::{f64::consts::TAU, fmt::Write};

/// R_s in ohm, L_d and L_q in H, psi_f in Wb.
const MOTOR: (f64, f64, f64, f64) = (0.5, 2e-3, 3e-3, 0.05);

/// 4000 rows at 5 kHz of settled currents, 500 at each of eight points, in quantities of the stator; `angle` is what is logged for an
/// electrical angle, rad.
fn log(angle: impl Fn(f64) -> f64) -> String {
    let (rs, ld, lq, psi_f) = MOTOR;
    let mut text = String::from("t,ualpha,ubeta,ialpha,ibeta,theta\n");
    let mut theta: f64 = 0.3;
    for row in 0..4000 {
        let side = |bit: i32| f64::from((row / 500) >> bit & 1);
        let (id, iq, omega) = (-4.0 * side(0), 3.0 + 5.0 * side(1), 300.0 + 300.0 * side(2));
        let (ud, uq) = (rs * id - omega * lq * iq, rs * iq + omega * (ld * id + psi_f));
        let (sin, cos) = theta.sin_cos();
        let alpha_beta = |d: f64, q: f64| (cos * d - sin * q, sin * d + cos * q);
        let ((ua, ub), (ia, ib)) = (alpha_beta(ud, uq), alpha_beta(id, iq));
        writeln!(text, "{:.4},{ua},{ub},{ia},{ib},{}", f64::from(row) * 2e-4, angle(theta)).unwrap();
        theta += omega * 2e-4;
    }
    text
}

/// The notes on the angle, and how far the currents of the log are from those that the motor had, at most, A.
fn read(text: &str, options: &LogOptions) -> (Vec<String>, f64) {
    let read = parse_log("drive.csv", text.as_bytes(), options).unwrap();
    let columns = read.log.columns();
    let far = (0..columns.id.len()).map(|row| {
        let side = |bit: i32| f64::from(((columns.t[row] / 0.1 + 1e-6) as i32) >> bit & 1);
        (columns.id[row] + 4.0 * side(0)).hypot(columns.iq[row] - 3.0 - 5.0 * side(1))
    });
    let is_of_angle = |note: &&String| note.starts_with("theta_e") && !note.ends_with("as it turns");
    (read.log.source().notes.iter().filter(is_of_angle).cloned().collect(), far.fold(0.0, f64::max))
}

#[test]
fn a_log_whose_angle_begins_elsewhere_is_turned_into_the_magnets_frame() {
    for degrees in [-120.0_f64, -90.0, 60.0, 90.0, 135.0] {
        let (notes, far) = read(&log(|theta| (theta + degrees.to_radians()).rem_euclid(TAU)), &LogOptions::default());
        let place = if degrees > 0.0 { "ahead of" } else { "behind" };
        let expected = format!("theta_e is {:.1} degrees {place} the magnets: ", degrees.abs());
        assert!(notes.len() == 1 && notes[0].starts_with(&expected), "{notes:?}");
        // Half a degree of nine amperes.
        assert!(far < 0.08, "{degrees}: {far}");
    }
    assert_eq!(read(&log(|theta| theta.rem_euclid(TAU)), &LogOptions::default()).0, [""; 0]);
}

/// From 0 to 1, as fixed-point firmware counts it, from -1 to 1, and in steps of an encoder: the phase currents turn as fast. Three times
/// as fast as a shaft whose turn is 1.
#[test]
fn an_angle_in_other_units_is_told_by_the_phase_currents() {
    let turns = |theta: f64| (theta / TAU).rem_euclid(1.0);
    let from_minus_one = |theta: f64| (theta / TAU + 0.5).rem_euclid(1.0) * 2.0 - 1.0;
    let digits = |theta: f64| (65_536.0 * turns(theta)).floor();
    let cases: [(&dyn Fn(f64) -> f64, &str); 4] = [
        (&turns, "theta_e: column 'theta' read as an angle whose turn is 1: so the phase currents turn"),
        (&from_minus_one, "theta_e: column 'theta' read as an angle whose turn is 2: so the phase currents turn"),
        (&digits, "theta_e: column 'theta' read as an angle whose turn is 65536: so the phase currents turn"),
        (
            &|theta| turns(theta / 3.0),
            "theta_e: column 'theta' read as the angle of the shaft, with 3 pole pairs: the phase currents turn 3 times as fast; its zero must \
             lie on the d axis",
        ),
    ];
    for (angle, expected) in cases {
        let (notes, far) = read(&log(angle), &map(&["theta_e=theta"]));
        assert_eq!(notes, [expected]);
        assert!(far < 0.002, "{expected}: {far}");
    }
}

/// 4000 rows of a steady point in quantities of the rotor, at 300 electrical rad/s with four pole pairs; `speed` is a column, or none.
fn of_rotor(angle: &str, of_shaft: bool, speed: Option<&str>) -> String {
    let row = |row: u32| {
        let t = f64::from(row) * 1e-4;
        let turned = if of_shaft { (75.0 * t).rem_euclid(TAU) } else { (300.0 * t).rem_euclid(TAU) };
        let speed = speed.map_or_else(String::new, |_| ",75".to_owned());
        format!("{t:.4},-3.6,16.5,0,4,{turned}{speed}\n")
    };
    let speed = speed.map_or_else(String::new, |name| format!(",{name}"));
    format!("t,ud,uq,id,iq,{angle}{speed}\n{}", (0..4000).map(row).collect::<String>())
}

/// A simulator writes the angle of the shaft beside dq currents, which do not tell it from that of the field.
#[test]
fn an_angle_that_alone_tells_the_speed_is_asked_whose_it_is() {
    let four = |units: &[(&str, Unit)]| LogOptions {
        units: units.iter().map(|(name, unit)| ((*name).to_owned(), *unit)).collect(),
        pole_pairs: Some(4),
        ..LogOptions::default()
    };
    let refusal = |text: &str, options: &LogOptions| parse_log("drive.csv", text.as_bytes(), options).unwrap_err().to_string();
    for name in ["theta", "Machine.theta [rad]"] {
        let sentence = refusal(&of_rotor(name, true, None), &LogOptions::default());
        assert!(sentence.contains("electrical or that of the shaft"), "{sentence}");
    }
    let sentence = refusal(&of_rotor("theta_mech", true, None), &LogOptions::default());
    assert!(sentence.contains("number of pole pairs"), "{sentence}");
    let speed = |text: &str, options: &LogOptions| {
        parse_log("drive.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}")).log.columns().omega_e[2000]
    };
    for (text, options) in [
        (of_rotor("theta_mech", true, None), four(&[])),
        (of_rotor("theta", true, None), four(&[("theta_e", Unit::RadianMechanical)])),
        (of_rotor("theta_el", false, None), LogOptions::default()),
        (of_rotor("theta", false, None), LogOptions { units: vec![("theta_e".to_owned(), Unit::Radian)], ..LogOptions::default() }),
    ] {
        let found = speed(&text, &options);
        assert!((found - 300.0).abs() < 1e-6, "{found} {}", text.lines().next().unwrap_or_default());
    }
    let of_shaft = parse_log("drive.csv", of_rotor("theta_mech", true, None).as_bytes(), &four(&[])).unwrap();
    assert!(of_shaft.notes.iter().any(|note| note.to_string().contains("read as mechanical rad, as it turns")), "{:?}", of_shaft.notes);
    // The speed tells it, with the pole pairs.
    let read = parse_log(
        "drive.csv",
        of_rotor("theta", true, Some("wm [rad/s]")).as_bytes(),
        &four(&[("omega_e", Unit::RadianPerSecondMechanical)]),
    );
    let read = read.unwrap();
    assert!(
        read.notes.iter().any(|note| note.to_string().contains("read as the angle of the shaft, with 4 pole pairs, as it turns")),
        "{:?}",
        read.notes
    );
    let theta = read.log.columns().theta_e.clone().unwrap();
    assert!((theta[100] - 3.0).abs() < 1e-9, "{}", theta[100]);
}

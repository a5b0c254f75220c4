//! What is known of the drive's sensors and of the winding's temperature: as options, in the motor file, and on the page.

use super::{fluxfit, json};
use serde_json::Value;

const NOISY: &str = "examples/logs/paper_rig_pwm_noise.csv";

/// Half of a parameter's interval, as a part of its value.
fn half_width(document: &Value, key: &str) -> f64 {
    let parameter = &document["parameters"][key];
    let ends = [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap());
    0.5 * (ends[1] - ends[0]) / parameter["value"].as_f64().unwrap()
}

/// L_q of this log is known to 0.03 %, psi_f to 0.02 %.
#[test]
fn a_stated_accuracy_is_half_of_the_interval() {
    let (status, document) = json(&["identify", NOISY, "--current-accuracy", "±1 %"]);
    assert_eq!(status, 0);
    assert!((half_width(&document, "lq") - 0.01).abs() < 1e-4 && half_width(&document, "psi_f") < 3e-4);
    assert_eq!(document["counted"][0]["code"], "current-gain");
    assert_eq!(document["counted"][0]["accuracy"], 0.01);
    let left: Vec<&str> = document["not_counted"].as_array().unwrap().iter().map(|entry| entry["code"].as_str().unwrap()).collect();
    assert_eq!(left, ["bus-voltage", "angle-with-load", "temperature"]);
}

/// What is beyond 5 % is weak, and the remedy names the sensors. All that an option does not state is the motor file's.
#[test]
fn the_motor_file_states_what_the_options_do_not() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("motor.toml");
    std::fs::write(&file, "[sensors]\ncurrent_accuracy = \"8 %\"\nbus_accuracy = 0.02\n").unwrap();
    let motor = file.to_str().unwrap();
    let (status, document) = json(&["identify", NOISY, "--motor", motor]);
    assert_eq!(status, 1);
    // Both together, 8 % and 2 %.
    assert!((half_width(&document, "lq") - 0.08_f64.hypot(0.02)).abs() < 1e-4);
    assert!((half_width(&document, "psi_f") - 0.02).abs() < 1e-4);
    let lq = &document["parameters"]["lq"];
    assert_eq!((lq["verdict"].as_str(), lq["remedy"].as_str()), (Some("weak"), Some("calibrate the current sensors")));
    let (status, document) = json(&["identify", NOISY, "--motor", motor, "--current-accuracy", "0"]);
    assert_eq!(status, 0);
    assert!((half_width(&document, "lq") - 0.02).abs() < 1e-4);
    assert_eq!(document["counted"].as_array().unwrap().len(), 2);
}

#[test]
fn the_terminal_and_the_page_say_what_is_counted() {
    let directory = tempfile::tempdir().unwrap();
    let page = directory.path().join("page.html");
    let run = fluxfit(&["identify", NOISY, "--bus-accuracy", "0.5%", "--report", page.to_str().unwrap()]);
    assert_eq!(run.status, 0, "{}", run.err);
    let sentence = "In the intervals, as stated: the DC voltage read up to 0.50 % too large or too small";
    assert!(super::unwrapped(&run.out).contains(sentence), "{}", run.out);
    assert!(!run.out.contains("the DC voltage read 1 % too large"), "{}", run.out);
    assert!(std::fs::read_to_string(page).unwrap().contains("As stated:<br>the DC voltage read up to 0.50\u{a0}%"));
}

/// A difference that the sensors may make is none.
#[test]
fn a_validation_counts_the_accuracy_too() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("motor.toml");
    // The motor of the log with L_q, and with it all else that the currents tell, 3 % larger.
    std::fs::write(&file, "[motor]\nrs = 0.98674\nld = 5.4075e-3\nlq = 12.36e-3\npsi_f = 0.1827\n").unwrap();
    let motor = file.to_str().unwrap();
    let (status, document) = json(&["validate", NOISY, "--motor", motor]);
    assert_eq!((status, document["outcome"].as_str()), (1, Some("contradicts")));
    let (status, document) = json(&["validate", NOISY, "--motor", motor, "--current-accuracy", "5%"]);
    assert_eq!((status, document["outcome"].as_str()), (0, Some("agrees")));
}

/// The log with a column of the winding's temperature, 60 degC; R_s at 20 degC is 255/295 of that at 60.
#[test]
fn a_log_with_temperature_tells_the_resistance_at_20_degrees() {
    let directory = tempfile::tempdir().unwrap();
    let (log, page) = (directory.path().join("log.csv"), directory.path().join("page.html"));
    let text = std::fs::read_to_string(super::root().join(NOISY)).unwrap();
    let warm: String =
        text.lines().enumerate().map(|(row, line)| format!("{line},{}\n", if row == 0 { "temperature_C" } else { "60" })).collect();
    std::fs::write(&log, warm).unwrap();
    let (log, page) = (log.to_str().unwrap(), page.to_str().unwrap());
    let (status, document) = json(&["identify", log, "--magnet-coefficient", "-0.12%/K"]);
    assert_eq!(status, 0);
    let ratio = |key: &str, of: &str| {
        document["temperature"][key]["value"].as_f64().unwrap() / document["parameters"][of]["value"].as_f64().unwrap()
    };
    assert!((ratio("rs_at_20", "rs") * 295.0 / 255.0 - 1.0).abs() < 1e-9);
    assert!((ratio("psi_f_at_20", "psi_f") * (1.0 - 40.0 * 0.0012) - 1.0).abs() < 1e-9);
    let left: Vec<&str> = document["not_counted"].as_array().unwrap().iter().map(|entry| entry["code"].as_str().unwrap()).collect();
    assert!(!left.contains(&"temperature"), "{left:?}");
    let run = fluxfit(&["identify", log, "--report", page]);
    // R_s is 0.957 ohm, and 0.957 * 255 / 295 = 0.827.
    let told = super::unwrapped(&run.out);
    assert!(told.contains("The winding was at 60 degC in the rows used; at 20 degC R_s = 0.827 ohm"), "{told}");
    assert!(std::fs::read_to_string(page).unwrap().contains("The winding was at 60 degC in the rows used"));
    let run = fluxfit(&["identify", NOISY, "--magnet-coefficient", "-0.12%/K"]);
    assert!(run.err.contains("--magnet-coefficient is not used: the log has no temperature"), "{}", run.err);
}

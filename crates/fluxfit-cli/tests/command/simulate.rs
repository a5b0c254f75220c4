//! `fluxfit simulate`: what it writes, and that the examples are identified for what they are.

use super::{fluxfit, fluxfit_with_input, json, root, schema};
use serde_json::Value;
use std::{fs, path::Path};

const KEYS: [&str; 4] = ["rs", "ld", "lq", "psi_f"];

/// Runs `simulate ARGUMENTS -o LOG` in a new folder; the log and its truth.
fn simulated(folder: &Path, arguments: &[&str]) -> (String, Value) {
    let log = folder.join("rig.csv");
    let run = fluxfit(&[&["simulate"], arguments, &["-o", log.to_str().unwrap()]].concat());
    assert_eq!((run.status, run.err.as_str()), (0, ""), "{arguments:?}");
    let truth = fs::read_to_string(folder.join("rig.truth.json")).unwrap();
    assert_eq!(fs::read_dir(folder).unwrap().count(), 2, "something is left over");
    let truth = serde_json::from_str(&truth).unwrap();
    schema::assert_fits(&truth);
    (fs::read_to_string(&log).unwrap(), truth)
}

#[test]
fn the_examples_are_identified() {
    let (identified, by_itself) = (["identified"; 4], &[][..]);
    let table = [
        ("paper_rig", by_itself, 0, identified),
        ("drone", by_itself, 0, identified),
        ("traction", by_itself, 0, identified),
        ("id_zero", by_itself, 0, identified),
        // A motor that saturates has no such numbers, and gets none; tests/saturating_example.rs asks for its currents too.
        ("pm_syrm", &["--model", "steady"], 1, ["not-identifiable"; 4]),
    ];
    for (name, model, status, verdicts) in table {
        let folder = tempfile::tempdir().unwrap();
        let (_, truth) = simulated(folder.path(), &[&format!("examples/scenarios/{name}.toml")]);
        let log = folder.path().join("rig.csv");
        let (found_status, document) = json(&[&["identify", log.to_str().unwrap()], model].concat());
        assert_eq!(found_status, status, "{name}");
        for (key, verdict) in KEYS.into_iter().zip(verdicts) {
            let parameter = &document["parameters"][key];
            assert_eq!(parameter["verdict"], verdict, "{name} {key}");
            if verdict == "identified" {
                let within = |end: usize| parameter["ci95"][end].as_f64().unwrap() - truth[key].as_f64().unwrap();
                assert!(within(0) <= 0.0 && within(1) >= 0.0, "{name} {key}: {parameter} without {}", truth[key]);
            } else {
                assert!(parameter["value"].is_null(), "{name} {key}");
            }
        }
    }
}

#[test]
fn field_weakening_is_at_work_in_the_traction_example() {
    let folder = tempfile::tempdir().unwrap();
    let (log, _) = simulated(folder.path(), &["examples/scenarios/traction.toml"]);
    let last: Vec<f64> = log.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!(last[3] < -80.0, "i_d is {} A where -50 A are scheduled", last[3]);
}

#[test]
fn the_same_scenario_gives_the_same_bytes_and_another_draw_others() {
    let scenario = "examples/scenarios/id_zero.toml";
    let [first, again, other, seeded] = [&[][..], &["--draw", "0"], &["--draw", "1"], &["--seed", "7"]].map(|arguments| {
        let folder = tempfile::tempdir().unwrap();
        simulated(folder.path(), &[&[scenario], arguments].concat())
    });
    assert_eq!(first, again);
    assert_ne!(first.0, other.0);
    assert_ne!(first.0, seeded.0);
    assert_eq!((&other.1["draw"], &seeded.1["scenario"]["seed"]), (&1.into(), &7.into()));
    assert_eq!(first.1["scenario"]["motor"]["ld"], "5.25 mH");
    assert_eq!(
        (first.1["schema"].as_str(), first.1["ld"].as_f64(), first.1["pole_pairs"].as_u64()),
        (Some("fluxfit.truth/1"), Some(5.25e-3), Some(4))
    );
}

#[test]
fn the_template_is_the_built_in_rig_and_the_example() {
    let template = fluxfit(&["simulate", "--template"]);
    assert_eq!(template.status, 0);
    assert_eq!(template.out, fs::read_to_string(root().join("examples/scenarios/paper_rig.toml")).unwrap());
    let built_in = fluxfit(&["simulate", "-o", "-"]);
    let from_input = fluxfit_with_input(&["simulate", "-", "-o", "-"], template.out.as_bytes());
    assert!(built_in.out.starts_with("t,ud,uq,id,iq,omega_e,theta_e,ud_ref,uq_ref,u_dc\n0,"));
    assert_eq!(built_in.out, from_input.out);
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(built_in.out, simulated(folder.path(), &[]).0);
}

#[test]
fn the_summary_says_what_is_where() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("a log.csv");
    fs::write(&log, "old").unwrap();
    let run = fluxfit(&["simulate", "-o", log.to_str().unwrap()]);
    let expected = format!(
        "the paper's rig\n9001 rows at 10.0 kHz, 0.900 s\n\n  log    '{0}.csv'\n  truth  '{0}.truth.json'\n\n\
         Next: fluxfit identify '{0}.csv'\n      fluxfit compare '{0}.csv' --truth '{0}.truth.json'\n",
        folder.path().join("a log").display()
    );
    assert_eq!((run.status, run.out), (0, expected));
    assert!(fs::read_to_string(&log).unwrap().starts_with("t,ud"));
}

/// The truth of a flux map holds no constants, and says so where they are wanted.
#[test]
fn a_flux_map_has_no_constant_truth() {
    let folder = tempfile::tempdir().unwrap();
    let (_, truth) = simulated(folder.path(), &["examples/scenarios/pm_syrm.toml"]);
    assert!(truth["ld"].is_null() && truth["lq"].is_null() && truth["psi_f"].is_null());
    assert_eq!(truth["rs"].as_f64(), Some(0.63));
    let path = |name: &str| folder.path().join(name).display().to_string();
    let run = fluxfit(&["compare", &path("rig.csv"), "--truth", &path("rig.truth.json")]);
    assert_eq!(run.status, 2);
    assert!(run.err.contains("because the motor of the simulation was a flux map") && run.err.lines().count() == 1, "{}", run.err);
}

/// The advice for a motor that saturates, carried out: steps of the current that are held, at two speeds. The slopes of the flux between
/// them are those of the flux map's own points, and the two speeds tell R_s.
#[test]
fn held_steps_tell_the_incremental_inductances_of_a_flux_map() {
    let (folder, scenarios) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let map = root().join("examples/scenarios/baldor_ecs101_flux_map.csv");
    let map_text = fs::read_to_string(&map).unwrap();
    let rows = map_text.lines().filter_map(|line| line.split(',').map(|cell| cell.parse::<f64>().ok()).collect::<Option<Vec<f64>>>());
    let rows: Vec<Vec<f64>> = rows.collect();
    let flux = |id: f64, iq: f64, axis: usize| rows.iter().find(|row| row[0] == id && row[1] == iq).unwrap()[2 + axis];
    let example = fs::read_to_string(root().join("examples/scenarios/pm_syrm.toml")).unwrap();
    let (motor, rest) = example.split_once("[schedule]").unwrap();
    let (_, sensors) = rest.split_once("[sensors]").unwrap();
    let motor = motor.replace("\"baldor_ecs101_flux_map.csv\"", &format!("{:?}", map.display().to_string()));
    let schedule = "speed = [{ at = \"0 s\", to = \"900 rpm\" }, { at = \"1.2 s\", to = \"1200 rpm\", over = \"0.3 s\" }]\n\
        id = [{ at = \"0 s\", to = \"-8 A\" }, { at = \"0.8 s\", to = \"-10 A\" }, { at = \"1.75 s\", to = \"-8 A\" }]\n\
        iq = [{ at = \"0 s\", to = \"12 A\" }, { at = \"0.4 s\", to = \"14 A\" }]\n";
    let scenario = scenarios.path().join("steps.toml");
    fs::write(&scenario, format!("{motor}[schedule]\n{schedule}\n[sensors]{sensors}")).unwrap();
    simulated(folder.path(), &[scenario.to_str().unwrap()]);
    let slopes = [(flux(-8.0, 14.0, 0) - flux(-10.0, 14.0, 0)) / 2.0, (flux(-8.0, 14.0, 1) - flux(-8.0, 12.0, 1)) / 2.0];
    let log = folder.path().join("rig.csv").display().to_string();
    // Of the operating points, the noise of the harmonic that is missing bounds what dead time takes: of twelve draws, 5 to 21 % of d.
    for (model, widest, widest_slope) in [(&["--model", "steady"][..], 5.0, 0.2), (&[], 10.0, 0.1)] {
        let run = fluxfit(&[&["identify", &log], model].concat());
        let line = run.out.lines().find(|line| line.trim_start().starts_with("R_s")).unwrap_or_else(|| panic!("no R_s: {}", run.out));
        let words: Vec<&str> = line.split_whitespace().collect();
        let [rs, percent] = [words[1], words[3].trim_start_matches('±')].map(|word| word.parse::<f64>().unwrap());
        assert!((rs - 0.63).abs() <= 0.01 * percent * rs && percent <= widest, "{model:?}: {line}");
        slopes_are_told(&run.out, slopes, widest_slope);
    }
    // A prior of R_s leaves it no less sure than it was given: 1 % is ±2 %.
    let run = fluxfit(&["identify", &log, "--prior", "rs=0.63±1%", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    let [low, high] = [0, 1].map(|end| document["parameters"]["rs"]["ci95"][end].as_f64().unwrap());
    assert!(high - low < 0.041 * 0.63 && low < 0.63 && 0.63 < high, "{low} {high}");
}

/// That both axes' incremental inductances, H, lie within their intervals, which are below this part of them.
fn slopes_are_told(out: &str, slopes: [f64; 2], widest: f64) {
    let (_, told) = out.split_once("Incremental inductances").unwrap_or_else(|| panic!("none: {out}"));
    for (axis, slope) in ["d", "q"].into_iter().zip(slopes) {
        let line = told.lines().find(|line| line.contains(&format!("mH along {axis} "))).unwrap_or_else(|| panic!("{axis}: {told}"));
        let words: Vec<&str> = line.split_whitespace().collect();
        let [value, half_width] = [words[0], words[2]].map(|word| 1e-3 * word.parse::<f64>().unwrap());
        assert!((value - slope).abs() < half_width && half_width < widest * slope, "{axis}: {line}, {slope}");
    }
}

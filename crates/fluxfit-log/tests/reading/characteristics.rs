//! Tables of a test bench: what is taken for one, and what a file is that is none. No log is taken for one.

use crate::fixtures::{map, refusal};
use fluxfit::characteristics::{Characteristic, TorqueOfCurrent};
use fluxfit_files::{Advice, FileError};
use fluxfit_log::{Inspection, LogOptions, ReadCharacteristic, inspect, read_characteristic};
use fluxfit_units::Unit;
use std::{fs, path::Path};

/// The one file of the corpus that is such a table, and no log.
const TABLE: &str = "table_beside_timetable.mat";

/// The one that is asked to be mapped as such a table: of i_q beside a torque its names only say that they may be it.
const DYNAMOMETER: &str = "odrive_dyno.csv";

#[test]
fn no_log_of_the_corpus_is_a_characteristic() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/logs");
    let mut seen = 0;
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.ends_with(TABLE) {
            assert!(read_characteristic(&path, &LogOptions { pole_pairs: Some(3), ..LogOptions::default() }).unwrap().is_some());
            continue;
        }
        if path.ends_with(DYNAMOMETER) {
            assert!(read_characteristic(&path, &LogOptions::default()).is_err());
            continue;
        }
        assert_eq!(read_characteristic(&path, &LogOptions::default()), Ok(None), "{}", path.display());
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}

fn with_file<T>(text: &str, act: impl Fn(&Path) -> T) -> T {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("table.csv");
    fs::write(&path, text).unwrap();
    act(&path)
}

fn of(text: &str, options: &LogOptions) -> Result<Option<ReadCharacteristic>, FileError> {
    with_file(text, |path| read_characteristic(path, options))
}

fn inspected(text: &str) -> Inspection {
    with_file(text, |path| inspect(path, &LogOptions::default()).unwrap())
}

/// The largest currents of d and q of torques, and what is said of i_d.
fn torques(text: &str, options: &LogOptions) -> ([f64; 2], String) {
    let read = of(text, options).unwrap().unwrap();
    let Characteristic::TorqueOfCurrent(TorqueOfCurrent { rows }) = &read.table else { panic!("{:?}", read.table) };
    let last = rows.last().unwrap().current;
    let notes = read.notes.iter().map(|note| note.sentence.as_str()).filter(|note| note.contains("i_d"));
    ([last.d, last.q], notes.collect::<Vec<_>>().join("; "))
}

const ROWS: &str = "1000,5,1,-1\n1000,10,2,-2\n2000,20,4,-4\n";

/// Whatever is beside it: a speed, powers, losses. Of what only resembles i_q it is asked, with what to paste.
#[test]
fn a_q_current_beside_a_torque_is_torque_against_current() {
    for names in ["rpm,iq_peak_a,avg_torque_nm,efficiency", "rpm,Iq avg [A],torque_nm,loss_w", "rpm_ss,iq_ss,torque_ss,x"] {
        assert_eq!(torques(&format!("{names}\n{ROWS}"), &LogOptions::default()).0, [0.0, 20.0], "{names}");
    }
    let bench = format!("Output Speed [rpm],Test motor q-axis current,Output Torque [Nm],Test motor d-axis current\n{ROWS}");
    let refusal = of(&bench, &LogOptions::default()).unwrap_err();
    assert!(refusal.to_string().contains("may be i_q and i_d beside the torque"), "{refusal}");
    let pairs = [("iq", "Test motor q-axis current"), ("id", "Test motor d-axis current"), ("torque", "Output Torque [Nm]")];
    let pairs = pairs.map(|(name, header)| (name, Some(header.to_owned())));
    assert_eq!(refusal.advice(), [Advice::MapColumns(pairs.to_vec())]);
    let mapped = map(&["iq=Test motor q-axis current", "id=Test motor d-axis current", "torque=Output Torque [Nm]"]);
    assert_eq!(torques(&bench, &mapped).0, [-4.0, 20.0]);
    let two = format!("Power [W],Test motor q-axis current,Torque [Nm],Absorber q-axis current\n{ROWS}");
    assert!(of(&two, &LogOptions::default()).unwrap_err().to_string().contains("could each be i_q"));
    // With the voltages of the frame it is a log, or operating points.
    let log = format!("motor_x_vd,motor_x_iq,torque_nm,motor_x_vq\n{ROWS}");
    assert_eq!(of(&log, &LogOptions::default()), Ok(None));
}

/// All of such a current would be i_q, or that of shorted terminals. Beside the axes it is one more column.
#[test]
fn a_current_with_its_angle_is_not_i_q() {
    let rows = "2,0,1,500\n4,20,2,1000\n6,40,2.5,2000\n8,50,3,3000\n";
    for names in ["Is [Arms],beta [deg],T [Nm],x", "I [A rms],gamma,T [Nm],n [rpm]", "Is_pk [A],phase advance [deg],x,n [rpm]"] {
        let refusal = of(&format!("{names}\n{rows}"), &LogOptions::default()).unwrap_err().to_string();
        assert!(refusal.contains("lengths and angles of vectors"), "{names}: {refusal}");
    }
    assert_eq!(torques(&format!("iq [A],beta [deg],T [Nm],Is [A]\n{rows}"), &LogOptions::default()).0, [0.0, 8.0]);
}

/// A limit beside the voltage is not another one of it.
#[test]
fn a_maximum_is_an_amplitude_where_it_stands_alone() {
    let last = |names: &str| match of(&format!("{names}\n100,10,9\n200,20,9\n300,30,9\n"), &LogOptions::default()).unwrap().unwrap().table {
        Characteristic::OpenCircuit(table) => table.rows[2].voltage,
        other => panic!("{other:?}"),
    };
    assert!((last("n [rpm],U_ll_max [V],x") - 30.0 * 0.5_f64.sqrt()).abs() < 1e-12);
    assert_eq!(last("n [rpm],U_ll [V],U_max [V]"), 30.0);
}

#[test]
fn no_column_of_i_d_is_passed_over_without_a_word() {
    let of = |d: &str, mapped: &[&str]| torques(&format!("speed,Test motor q-axis current,M [Nm],{d}\n{ROWS}"), &map(mapped));
    let mapped = ["iq=Test motor q-axis current", "torque=M [Nm]"];
    let ([d, _], note) = of("Test motor d-axis current", &mapped);
    assert!(d == -4.0 && note.contains("is read as i_d, because its name differs"), "{note}");
    for name in ["Absorber d-axis current", "motor d-axis current reference"] {
        let ([d, _], note) = of(name, &mapped);
        assert!(d == 0.0 && note.contains(&format!("'{name}' may be i_d")), "{note}");
    }
    let (_, note) = of("temperature", &mapped);
    assert!(note.contains("no column is named as it"), "{note}");
}

/// What an identification refuses, an inspection does not call a table to identify from.
#[test]
fn an_inspection_checks_a_table_as_an_identification_does() {
    let propeller = [2.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0].map(|speed: f64| format!("{speed},{},{}\n", speed.powi(2), speed.powi(2)));
    let refused = [
        (format!("RPM,Torque_Nm,Current_A\n{}", propeller.concat()), "propeller"),
        ("rpm,iq_peak_a,torque_nm\n1000,15,0.01\n".to_owned(), "too few currents"),
        ("rpm,U_ll [V]\n3000,5\n3060,5\n3120,5.01\n".to_owned(), "same at all speeds"),
    ];
    for (text, sentence) in refused {
        let inspected = inspected(&text);
        let refusal = inspected.log.unwrap_err().to_string();
        assert!(inspected.is_table && inspected.table.is_none() && refusal.contains(sentence), "{text}: {refusal}");
    }
    // Another table may make up for what one lacks.
    let shorted = "rpm,I [A]\n100,1\n200,2\n400,3.8\n800,7\n1600,11\n3200,14\n";
    let table = inspected(shorted).table.unwrap().table;
    assert!(table.needs_another() && table.describe() == "short-circuit characteristic of 6 speeds");
}

#[test]
fn the_curve_of_a_load_is_named_whatever_is_mapped() {
    let actuator = format!("input_speed,input_torque,voltage,output_speed,output_torque\n{}", "1,2,3,4,5\n2,2,3,8,5\n");
    for options in [LogOptions::default(), map(&["speed=input_speed", "torque=input_torque"])] {
        let refusal = of(&actuator, &options).unwrap_err().to_string();
        assert!(refusal.contains("a motor that drives a load, by its columns 'input_speed'"), "{refusal}");
    }
    let loss = format!("rpm,I [A],torque_nm,avg_loss_w\n{ROWS}");
    assert!(
        of(&loss, &LogOptions::default())
            .unwrap_err()
            .to_string()
            .contains("drives a load, by its columns 'rpm', 'torque_nm' and 'avg_loss_w'")
    );
    // A bench measures what an open motor loses, and its torques: none of them is asked for.
    let open = format!("rpm,U_ll [V],torque 1 [Nm],torque 2 [Nm],iron loss [W]\n{}", "100,1,1,1,1\n200,2,1,1,2\n");
    assert!(matches!(of(&open, &LogOptions::default()), Ok(Some(ReadCharacteristic { table: Characteristic::OpenCircuit(_), .. }))));
}

/// A row of names with units: 3600 r/min are 377 rad/s.
#[test]
fn units_stand_behind_names_in_chinese_and_those_that_are_stated_win() {
    let open = "voltage,speed\n電壓V,轉速rpm\n10,1800\n20,3600\n30,5400\n";
    let speed = |text: &str, options: &LogOptions| match of(text, options).unwrap().unwrap().table {
        Characteristic::OpenCircuit(table) => table.rows[1].speed,
        other => panic!("{other:?}"),
    };
    assert!((speed(open, &LogOptions::default()) - 376.991).abs() < 1e-3);
    let mapped = map(&["speed=speed", "voltage=voltage"]);
    let other = open.replace("轉速rpm", "turns");
    let refusal = of(&other, &mapped).unwrap_err();
    assert!(refusal.to_string().contains("the row of units has \"turns\" below it") && !refusal.advice().is_empty(), "{refusal}");
    let stated = LogOptions { units: vec![("omega_e".to_owned(), Unit::HertzMechanical)], ..mapped };
    assert!((speed(&other, &stated) - 3600.0 * std::f64::consts::TAU).abs() < 1e-6);
}

#[test]
fn readings_of_a_power_meter_are_no_phases_of_a_log() {
    let text =
        "V1,I1,P1,S1,LAMBDA1,V2,I2,P2,S2,LAMBDA2,V3,I3,P3,S3,LAMBDA3\n1,2,2,2,1,1,2,2,2,1,1,2,2,2,1\n1,2,2,2,1,1,2,2,2,1,1,2,2,2,1\n";
    let sentence = refusal(text.as_bytes(), &LogOptions::default());
    assert!(sentence.contains("'V1', 'I1', 'P1' and 'S1' are readings of a power meter") && !sentence.contains("may be ua"), "{sentence}");
    assert!(inspected(text).columns.iter().all(|column| column.resembles.is_none()));
}

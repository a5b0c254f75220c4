//! Logs as further tools export them: circuit simulators, dashboards, data frames, drives. Each holds the same rows.

use crate::fixtures::{log_of, map, refusal};
use fluxfit::log::Log;
use fluxfit_log::{LogOptions, parse_log};

/// Rows of t, ud, uq, id, iq and electrical speed, as text.
fn rows() -> Vec<[String; 6]> {
    let row = |k: u32| {
        let x = f64::from(k);
        let values = [0.3 * x.cos(), 20.0 + x.sin(), 0.25 * (0.7 * x).sin(), 3.0 + 0.1 * (0.3 * x).cos(), 400.0 + 0.5 * (0.2 * x).sin()];
        let [ud, uq, id, iq, omega] = values.map(|value| format!("{value:.4}"));
        [format!("{:.4}", 1e-4 * x), ud, uq, id, iq, omega]
    };
    (0..60).map(row).collect()
}

/// A file of these rows, each cell as it is written there.
fn file(above: &str, separator: &str, cell: impl Fn(usize, &str) -> String) -> String {
    let line = |row: &[String; 6]| {
        let cells: Vec<String> = row.iter().enumerate().map(|(place, value)| cell(place, value)).collect();
        cells.join(separator) + "\n"
    };
    format!("{above}\n{}", rows().iter().map(line).collect::<String>())
}

fn plain(above: &str) -> String {
    file(above, ",", |_, value| value.to_owned())
}

fn expected() -> Log {
    log_of(plain("t,ud,uq,id,iq,omega_e").as_bytes(), &LogOptions::default())
}

/// Whether the values of two logs are the same to rounding.
fn assert_same(log: &Log, other: &Log, file: &str) {
    let columns = |log: &Log| {
        let columns = log.columns();
        [&columns.t, &columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].map(Clone::clone)
    };
    for (values, others) in columns(log).iter().zip(columns(other)) {
        assert_eq!(values.len(), others.len(), "{file}");
        assert!(values.iter().zip(&others).all(|(value, other)| (value - other).abs() < 1e-9), "{file}");
    }
}

#[test]
fn circuit_simulators_write_the_unit_before_the_name() {
    for above in
        ["time,V(ud),V(uq),I(Ld),I(Lq),V(omega_e)", "time,v(ud),v(uq),v(id),v(iq),v(omega_e)", "time,V(d),V(q),I(d),I(q),V(omega_e)"]
    {
        let options = LogOptions { units: vec![("omega_e".to_owned(), fluxfit_units::Unit::RadianPerSecond)], ..LogOptions::default() };
        assert_same(&log_of(plain(above).as_bytes(), &options), &expected(), above);
    }
    // The current through the source of a voltage is neither.
    let sentence = refusal(plain("time,I(Vd),I(Vq),I(Ld),I(Lq),V(omega_e)").as_bytes(), &LogOptions::default());
    assert!(sentence.contains("ud and uq are missing"), "{sentence}");
}

/// Each cell has its own prefix, so that its digits are few.
#[test]
fn cells_have_units_of_their_own() {
    let small = |value: &str, unit: &str| match value.parse::<f64>() {
        Ok(number) if number.abs() < 1.0 => format!("{} m{unit}", (number * 1e7).round() / 1e4),
        _ => format!("{value} {unit}"),
    };
    let cell = |place: usize, value: &str| match place {
        0 => format!("0 days 00:00:0{value}"),
        1 | 2 => small(value, "V"),
        3 | 4 => small(value, "A"),
        _ => format!("{value} rad/s"),
    };
    let text = file("Time,ud,uq,id,iq,omega_e", ",", cell);
    let read = parse_log("drive.csv", text.as_bytes(), &LogOptions::default()).unwrap();
    assert_same(&read.log, &expected(), &text);
    assert!(read.notes.iter().any(|note| note.to_string().contains("cells have their units")), "{:?}", read.notes);
    assert!(text.contains(" mA") && text.contains("days"));
}

#[test]
fn names_may_have_levels_or_lines_about_them() {
    for above in [
        "t,voltage,voltage,current,current,speed\n,d,q,d,q,omega_e",
        ",motor,motor,motor,motor,motor\n,ud,uq,id,iq,omega_e",
        "axis,motor,motor,motor,motor,motor\nquantity,ud,uq,id,iq,omega_e\ntime,,,,,",
        "time,ud,uq,id,iq,omega_e\ns,V,V,A,A,rad/s\ndouble,double,double,double,double,double\nlog,a/b,a/c,a/d,a/e,f",
        "time,ud,uq,id,iq,omega_e\n,Type: double,Type: double,Type: double,Type: double,Type: double\n,Unit: V,Unit: V,Unit: A,Unit: A,Unit: rad/s\n,Interp: zoh,Interp: zoh,Interp: zoh,Interp: zoh,Interp: zoh",
    ] {
        assert_same(&log_of(plain(above).as_bytes(), &LogOptions::default()), &expected(), above);
    }
}

#[test]
fn parameters_of_drives_have_numbers_before_their_names() {
    let options = LogOptions { units: vec![("omega_e".to_owned(), fluxfit_units::Unit::RadianPerSecond)], ..LogOptions::default() };
    for above in [
        "Zeit [s];Ud-Istwert [V];Uq-Istwert [V];r0076 Stromistwert feldbildend [A];r0078 Stromistwert momentenbildend [A];r0063 Drehzahlistwert [1/min]",
        "Zeit [s];P-0-0064, Feldbildende Spannung, Istwert [V];P-0-0063, Momentbildende Spannung, Istwert [V];P-0-0044, Feldbildender Strom, Istwert [A];P-0-0043, Momentbildender Strom, Istwert [A];S-0-0040, Geschwindigkeits-Istwert [1/min]",
    ] {
        let text = file(above, ";", |_, value| value.to_owned());
        assert_same(&log_of(text.as_bytes(), &options), &expected(), above);
    }
}

/// The unit of an encoder's counts is what a turn has of them, of which the file says nothing.
#[test]
fn counts_and_one_over_seconds_are_asked_for() {
    for (unit, said) in [("cnt/sec", "divided by the counts of a turn"), ("1/s", "rad/s, turns in a second or counts")] {
        let sentence = refusal(plain(&format!("t,ud,uq,id,iq,Velocity [{unit}]")).as_bytes(), &LogOptions::default());
        assert!(sentence.contains(said) && sentence.contains("omega_e = { column = \"Velocity ["), "{sentence}");
    }
    let stated = LogOptions { units: vec![("omega_e".to_owned(), fluxfit_units::Unit::RadianPerSecond)], ..LogOptions::default() };
    assert_same(&log_of(plain("t,ud,uq,id,iq,Speed [1/s]").as_bytes(), &stated), &expected(), "1/s");
}

/// Elmo calls the currents by the power that they make.
#[test]
fn active_and_reactive_currents_are_proposed() {
    let sentence = refusal(plain("t,ud,uq,Reactive Current [A],Active Current [A],omega_e").as_bytes(), &LogOptions::default());
    let proposed = "'Reactive Current [A]' may be id and 'Active Current [A]' may be iq";
    assert!(sentence.contains(proposed), "{sentence}");
}

#[test]
fn a_length_and_an_angle_are_not_the_axes() {
    let text = "n [rpm],Is [A],beta [deg],Ud [V],Uq [V]\n500,2,0,1,2\n500,3,20,1,2\n1000,4,40,1,2\n1000,5,0,2,4\n";
    let sentence = refusal(text.as_bytes(), &LogOptions::default());
    assert!(sentence.contains("id = -'Is [A]' sin 'beta [deg]'") && !sentence.contains("ud ="), "{sentence}");
}

#[test]
fn exports_that_are_not_read_are_named() {
    let trace = ";$FILEVERSION=1.1\n;$STARTTIME=45000.5\n;\n     1)       0.5  Rx         0300  8  00 01 02 03 04 05 06 07\n";
    assert!(refusal(trace.as_bytes(), &LogOptions::default()).contains("PCAN-View (.trc)"));
    let yokogawa = "\"Model\",\"DL850E\"\n\"TraceName\",\"U1\",\"I1\"\n\"VUnit\",\"V\",\"A\"\n\"HResolution\",1e-5,1e-5\n\"HOffset\",0,0\n,1,2\n,1,2\n";
    assert!(refusal(yokogawa.as_bytes(), &LogOptions::default()).contains("HOffset + k HResolution"));
    let rigol = "Time(s),CH1V,CH2V,t0 = -6e-3, tInc = 1e-5,\n-6e-3,1,30,,\n-5.99e-3,30,2,,\n-5.98e-3,1,4,,\n";
    assert!(refusal(rigol.as_bytes(), &LogOptions::default()).contains("trace of an oscilloscope"));
}

/// 0, 1, 2, .. may be seconds, or the numbers of the rows.
#[test]
fn times_that_count_the_rows_are_asked_for_their_unit() {
    let file = |name: &str| {
        let row = |(k, row): (usize, [String; 6])| format!("{k},{}\n", row[1..].join(","));
        format!("{name},ud,uq,id,iq,omega_e\n{}", rows().into_iter().enumerate().map(row).collect::<String>())
    };
    for name in ["t", "time", "Zeit"] {
        let sentence = refusal(file(name).as_bytes(), &LogOptions::default());
        assert!(sentence.contains("whole numbers in steps of 1") && sentence.contains("sample_period"), "{name}: {sentence}");
    }
    let sentence = refusal(file("sample").as_bytes(), &map(&["t=sample"]));
    assert!(sentence.contains("whole numbers in steps of 1"), "{sentence}");
    let stated = LogOptions { units: vec![("t".to_owned(), fluxfit_units::Unit::Second)], ..LogOptions::default() };
    assert_eq!(log_of(file("time").as_bytes(), &stated).rows(), 60);
    assert_eq!(log_of(file("time [s]").as_bytes(), &LogOptions::default()).rows(), 60);
}

//! Logs that cannot be read are refused in one sentence that names the place and what to do.

use crate::fixtures::{HEADER, LOG, ROWS, log_of, map, refusal};
use fluxfit_files::{Advice, FileErrorKind};
use fluxfit_log::{LogOptions, Mapping, parse_log, read_log};
use fluxfit_units::Unit;
use std::path::Path;

fn check(cases: &[(String, &str)], options: &LogOptions) {
    for (text, sentence) in cases {
        assert_eq!(refusal(text.as_bytes(), options), *sentence, "{text}");
    }
}

#[test]
fn headers_are_refused_in_one_sentence() {
    let wide: String = (0..23).map(|i| format!("c{i},")).collect();
    let cases = [
        (String::new(), "drive.csv: the file is empty; export it again"),
        (
            "# only\n% comments\n".into(),
            "drive.csv: the file has only comments; a header line with the names of the columns and rows of numbers are needed",
        ),
        (HEADER.into(), "drive.csv, line 1: there is no row below the header; export the log with its rows"),
        (format!("# x\n{HEADER}\n,,\n"), "drive.csv, line 2: there is no row below the header; export the log with its rows"),
        (
            ROWS.into(),
            "drive.csv, line 1: \"0, 1, 2, 3, 4, 5\" are numbers in place of a header; put a line with the names of the columns above them",
        ),
        (
            format!("# a,b\n{ROWS}"),
            "drive.csv, line 2: \"0, 1, 2, 3, 4, 5\" are numbers in place of a header; put a line with the names of the columns above them",
        ),
        (
            "t|ud|uq\n1|2|3\n".into(),
            "drive.csv, line 1: \"t|ud|uq\" is a single column; separate names and values by comma, semicolon or tab",
        ),
        (
            "Run 7\nload speed,id,iq\n1,2,3\n".into(),
            "drive.csv, line 2: the columns t, ud, uq and omega_e are missing; the file has 'load speed', 'id' and 'iq'; \
             by its name, 'load speed' may be omega_e: map it if it is; no column resembles t, ud and uq",
        ),
        (
            format!("t,ud,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1: the column uq is missing; the file has 't', 'ud', 'id', 'iq' and 'omega_e', \
             too few other columns for it to be in it; log it too",
        ),
        (
            format!("t,ud,id,iq,omega_e,x\n{ROWS}"),
            "drive.csv, line 1: the column uq is missing; the file has 't', 'ud', 'id', 'iq', 'omega_e' and 'x'; \
             map it if it has another name, else log it too",
        ),
        (
            "t,ud,id\n0,1,2\n1,1,2\n".into(),
            "drive.csv, line 1: the columns uq, iq and omega_e are missing; the file has 't', 'ud' and 'id'; of a rotor at rest with current \
             along d alone they are zero: add them as columns of zeros; else log them too",
        ),
        (
            format!("u_d,motor_speed,i_d,i_q,torque,profile\n{ROWS}"),
            "drive.csv, line 1: the columns t and uq are missing; the file has 'u_d', 'motor_speed', 'i_d', 'i_q', 'torque' and \
             'profile'; map them if they have other names, else log them too; if no column is the time and all rows are equally far \
             apart, write the time between them into a mapping file, as in sample_period = \"0.1 ms\"",
        ),
        // As data frames and time series databases write a row for each value.
        (
            "time,variable,value\n0,ud,1\n0,uq,2\n1,ud,1\n".into(),
            "drive.csv, line 1: each row has one value, in 'value', of the quantity that 'variable' names; write a row for each instant with \
             a column for each quantity (pandas: pivot, InfluxDB: pivot(), SQL: PIVOT)",
        ),
        // A copy of the Paderborn data without some of its columns is read as that: two rows a second.
        (
            format!("u_d,motor_speed,i_d,i_q,torque,profile_id\n{ROWS}"),
            "drive.csv, line 1: the column uq is missing; the file has 'u_d', 'motor_speed', 'i_d', 'i_q', 'torque' and 'profile_id'; map \
             it if it has another name, else log it too",
        ),
        (
            format!("tiem,a q-axis voltage,ud,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1: the columns t and uq are missing; the file has 'tiem', 'a q-axis voltage', 'ud', 'id', 'iq' and 'omega_e'; \
             by their names, 'tiem' may be t and 'a q-axis voltage' may be uq: map them if they are",
        ),
        (
            format!("{wide}\n"),
            "drive.csv, line 1: the columns t, ud, uq, id, iq and omega_e are missing; the file has 'c0', 'c1', 'c2', 'c3', 'c4', 'c5', 'c6', \
             'c7', 'c8', 'c9', 'c10', 'c11', 'c12', 'c13', 'c14', 'c15', 'c16', 'c17', 'c18', 'c19' and 3 more; \
             map them if they have other names, else log them too",
        ),
        (
            format!("t,ud,ud,uq,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1, column 'ud': the header has this name 2 times; rename or remove all but one",
        ),
        (
            format!("t,Ud,UD,uq,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1: the columns 'Ud' and 'UD' could each be ud; map one of them to ud",
        ),
        (
            format!("t,ud,uq,id,iq,omega_e [rpm-mech]\n{ROWS}"),
            "drive.csv, line 1, column 'omega_e [rpm-mech]': the speed is in mechanical r/min, and converting it takes the number of pole pairs; \
             state it, or state that the unit is electrical r/min",
        ),
    ];
    check(&cases, &LogOptions::default());
}

#[test]
fn maps_and_units_that_do_not_fit_the_file_are_refused() {
    let log = |speed: &str| vec![(LOG.replace("omega_e", speed), "")];
    let error = |speed: &str, options: &LogOptions| refusal(log(speed)[0].0.as_bytes(), options);
    assert_eq!(
        error("motor_speed", &map(&["omega=speeed"])),
        "drive.csv, line 1: omega_e is mapped to 'speeed', which the file does not have; it has 't', 'ud', 'uq', 'id', 'iq' and 'motor_speed'; \
         did you mean 'motor_speed'?"
    );
    assert_eq!(
        error("omega_e", &LogOptions { map: vec![("speed".into(), "omega_e".into())], ..LogOptions::default() }),
        "\"speed\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e, and optionally theta_e, u_dc, temperature, ua, ub, uc, ia, ib, ic, ualpha, ubeta, ialpha, ibeta and run; did you mean omega_e?"
    );
    assert_eq!(
        error("speed [km/h]", &map(&["omega=speed [km/h]"])),
        "drive.csv, line 1, column 'speed [km/h]': \"km/h\" in the header is not a known unit of omega_e; \
         state the unit if it is rad/s, rpm-elec, rpm-mech, rad/s-mech, Hz-elec, Hz-mech, krpm-elec, krpm-mech, deg/s or deg/s-mech; \
         else write its scale into a mapping file: omega_e = { column = \"speed [km/h]\", scale = .. }"
    );
    let units = LogOptions { units: vec![("omega".into(), Unit::HertzMechanical)], ..LogOptions::default() };
    assert_eq!(
        error("omega_e", &units),
        "drive.csv, line 1, column 'omega_e': the speed is in mechanical Hz, and converting it takes the number of pole pairs; \
         state it, or state that the unit is electrical Hz"
    );
}

#[test]
fn rows_are_refused_in_one_sentence() {
    let below = |rows: &str| format!("{HEADER}{rows}");
    let cases = [
        (
            below("a,b,c,d,e,f\n0,1,2,3,4,5\n1,1,2,3,4,5\n"),
            "drive.csv, line 1, column 't': \"a\" in the header is not a known unit of t; state the unit if it is s, ms, us or ns; else write \
             its scale into a mapping file: t = { column = \"t\", scale = .. }",
        ),
        (
            below("0,1,2,3,4,5\n\n1,1,2,3,4\n"),
            "drive.csv, line 4: the row has 5 cells where the header has 6; complete the row or remove it",
        ),
        (below("0,1,2,3,4,5,6\n"), "drive.csv, line 2: the row has 7 cells where the header has 6; remove the extra cells or the row"),
        (below("0,1,2,3,4,5\nend\n"), "drive.csv, line 3: the row has 1 cell where the header has 6; complete the row or remove it"),
        (
            below("0,1,2,3,4,5\n\"1,1,2,3,4,5\n2,1,2,3,4,5\n"),
            "drive.csv, line 3: the row has 1 cell where the header has 6; a quotation mark in this line opens a cell that continues over several lines: close it",
        ),
        (below("0,1,2,3,4,5\n\n1,1,abc,3,4,5\n"), "drive.csv, line 4, column 'uq': \"abc\" is not a number; correct it or remove the row"),
        (
            "# x\r\n\r\nt,ud,uq,id,iq,omega_e,note\r\n0,1,2,3,4,5,\"two\r\nlines\"\r\n\r\n1,1,2,3,4,abc,\r\n".into(),
            "drive.csv, line 7, column 'omega_e': \"abc\" is not a number; correct it or remove the row",
        ),
        (
            below("0,1,2,3,4,5\n1,1,\"two\nlines, and more than forty characters of them\",3,4,5\n"),
            "drive.csv, line 3, column 'uq': \"two\\nlines, and more than forty character…\" is not a number; correct it or remove the row",
        ),
        (
            below("0,1, ,3,4,5\n1,1, ,3,4,5\n"),
            "drive.csv, column 'uq': the column has no number in any row; log it, or map another one in its place",
        ),
        (below("0,1,2,3,4,5\n1,1, ,3,4,5\n"), "drive.csv, line 3, column 'uq': the cell is empty or NaN; write a number or remove the row"),
        (
            below("11:04 h,1,2,3,4,5\n"),
            "drive.csv, line 2, column 't': \"11:04 h\" is a time that is not understood; write it as a number, in s, or as in 2016-02-12 10:31:00.123",
        ),
        (
            below("0,1,2,3,4,5\n1,1,2,NaN,4,5\n"),
            "drive.csv, line 3, column 'id': the cell is empty or NaN; write a number or remove the row",
        ),
        (below("0,1,2,3,4,5\r\n1,1,2,-inf,4,5\r\n"), "drive.csv, line 3, column 'id': id is -inf; remove the row or write a finite number"),
        (below("0,1,2,3,4,5\n1,1,2,3,Infinity,5\n"), "drive.csv, line 3, column 'iq': iq is inf; remove the row or write a finite number"),
        (
            below("0,1,2,3,4,5\n1,1,2,3,4,1e300\n"),
            "drive.csv, line 3, column 'omega_e': omega_e is 1e300, beyond the 1e9 that any drive can have; check the column's unit or remove the row",
        ),
        (
            below("0,1,2,3,4,5\n\n1,1,2,3,4,5\n1,1,2,3,4,5\n"),
            "drive.csv, line 5, column 't': time goes from 1 s to 1 s; it must increase from row to row: remove repeated rows, or give the parts as separate logs",
        ),
        (
            below("0,1,2,3,4,5\n1,1,2,3,4,5\n0.5,1,2,3,4,5\n"),
            "drive.csv, line 4, column 't': time goes from 1 s to 0.5 s; it must increase from row to row: remove repeated rows, or give the parts as separate logs",
        ),
        (below("0,1,2,3,4,5\n"), "drive.csv: the log has 1 rows; at least 2 are needed"),
        (
            below("0,0,0,0,0,0\n1,0,0,0,0,0\n"),
            "drive.csv: the currents id and iq are zero in every row; check the mapping of columns, or log the drive while it turns and carries current",
        ),
    ];
    check(&cases, &LogOptions::default());
    let semicolons = |rows: &str| format!("{}{rows}", HEADER.replace(',', ";"));
    let cases = [
        (
            semicolons("0;1,5;2;3;4;5\n1;1;2.5;3;4;5\n"),
            "drive.csv, line 3, column 'uq': \"2.5\" has another decimal mark than line 2; use one mark throughout, and no thousands separators",
        ),
        (
            semicolons("0;1.5;2;3;4;5\n1;1;1,234;3;4;5\n"),
            "drive.csv, line 3, column 'uq': \"1,234\" has another decimal mark than line 2; use one mark throughout, and no thousands separators",
        ),
        (semicolons("0;1,234,5;2;3;4;5\n"), "drive.csv, line 2, column 'ud': \"1,234,5\" is not a number; correct it or remove the row"),
        (
            semicolons("0;1.234,5;2;3;4;5\n"),
            "drive.csv, line 2, column 'ud': \"1.234,5\" has a comma and a point, so its decimal mark is ambiguous; write numbers without thousands separators",
        ),
    ];
    check(&cases, &LogOptions::default());
    // The error of the library names the channel; the file has another name and another unit.
    let renamed = "clock_ms,ud,uq,id,iq,omega_e\n1000,1,2,3,4,5\n500,1,2,3,4,5\n";
    let sentence = refusal(renamed.as_bytes(), &map(&["t=clock_ms"]));
    assert!(sentence.starts_with("drive.csv, line 3, column 'clock_ms': time goes from 1 s to 0.5 s"), "{sentence}");
}

#[test]
fn binary_content_folders_and_missing_files_are_refused() {
    let text = "this is not text in UTF-8; export it as CSV text in UTF-8";
    assert_eq!(refusal(&[HEADER.as_bytes(), b"0,1,2,\0,4,5\n"].concat(), &LogOptions::default()), format!("drive.csv, line 2: {text}"));
    let error = |path: &Path| read_log(path, &LogOptions::default()).unwrap_err().to_string();
    let directory = tempfile::tempdir().unwrap();
    let shown = directory.path().display();
    assert_eq!(error(directory.path()), format!("{shown}: this is a directory; name a file in it"));
    assert_eq!(error(&directory.path().join("x.csv")), format!("{shown}/x.csv: there is no such file; check the path"));
}

#[test]
fn errors_and_notes_carry_the_advice_as_facts() {
    let error = |text: &str, options: &LogOptions| parse_log("drive.csv", text.as_bytes(), options).unwrap_err();
    let map_to = |pairs: &[(&'static str, Option<&str>)]| {
        Advice::MapColumns(pairs.iter().map(|(channel, header)| (*channel, header.map(str::to_owned))).collect())
    };
    let missing = error("t,load u_d,uq,id,iq,omega_e\n0,1,2,3,4,5\n", &LogOptions::default());
    assert_eq!((missing.kind(), missing.advice()), (FileErrorKind::Columns, &[map_to(&[("ud", Some("load u_d"))])][..]));
    // Of several logs in one file, all columns of the first, at once.
    let header: Vec<String> =
        ["a", "b"].iter().flat_map(|run| ["t", "u_d", "u_q", "id", "iq", "w_rpm", "w"].map(|name| format!("r.{run}.{name}"))).collect();
    let several = error(&format!("{}\n{}\n", header.join(","), vec!["1"; 14].join(",")), &LogOptions::default());
    let first = ["t", "ud", "uq", "id", "iq", "omega_e"].into_iter().zip(header.iter().map(|name| Some(name.as_str())));
    assert_eq!(several.advice(), [map_to(&first.collect::<Vec<_>>())], "{several}");
    let absent = error("t,uq,id,iq,omega_e,x\n0,2,3,4,5,6\n", &LogOptions::default());
    assert_eq!(absent.advice(), [map_to(&[("ud", None)])]);
    // Where no column is left, there is none to map.
    let absent = error("t,uq,id,iq,omega_e\n0,2,3,4,5\n", &LogOptions::default());
    assert_eq!(absent.advice(), []);
    let unknown_unit = error("t [h],ud,uq,id,iq,omega_e\n0,1,2,3,4,5\n", &map(&["t=t [h]"]));
    assert_eq!((unknown_unit.kind(), unknown_unit.advice()), (FileErrorKind::Unit, &[Advice::StateUnit { channel: "t", unit: None }][..]));
    let mechanical = error("t,ud,uq,id,iq,speed_rpm\n0,1,2,3,4,5\n", &map(&["omega=speed_rpm"]));
    assert_eq!(mechanical.advice(), [Advice::StatePolePairs, Advice::StateUnit { channel: "omega_e", unit: Some("rpm-elec") }]);
    let value = error("t,ud,uq,id,iq,omega_e\n0,1,x,3,4,5\n", &LogOptions::default());
    assert_eq!((value.kind(), value.advice()), (FileErrorKind::Value, &[][..]));

    let read = parse_log("drive.csv", format!("t,ud,uq,id,iq,w_el\n{ROWS}").as_bytes(), &map(&["omega=w_el"])).unwrap();
    assert_eq!(read.notes[0].advice, [Advice::StateUnit { channel: "omega_e", unit: None }]);
    // Who maps a speed does not say its unit.
    let of_shaft = error(&format!("t,ud,uq,id,iq,w_mech\n{ROWS}"), &map(&["omega=w_mech"]));
    let unit = Advice::StateUnit { channel: "omega_e", unit: Some("rpm-mech") };
    assert_eq!(of_shaft.advice(), [Advice::Together(vec![unit, Advice::StatePolePairs])]);
    let speed = error(&format!("t,ud,uq,id,iq,speed\n{ROWS}"), &map(&["omega=speed"]));
    assert!(matches!(speed.advice(), [Advice::StateRotation { channel: "omega_e", .. }]), "{speed}");
    // No sentence names an option of the command line.
    assert!(read.notes.iter().all(|note| !note.sentence.contains("--")), "{:?}", read.notes);
}

/// What a file is stands first: a log of frames without times, as candump writes it to a terminal, and a map over two currents.
#[test]
fn files_that_can_be_no_log_are_named() {
    for text in [
        " can0  123   [8]  11 22 33 44 55 66 77 88\n can0  124   [2]  11 22\n",
        "can0 123#1122334455667788\ncan0 124#1122\n",
        "  can0  RX - -  123   [2]  11 22   '.\"'\n",
    ] {
        let sentence = refusal(text.as_bytes(), &LogOptions::default());
        assert!(sentence.contains("a candump log without time stamps") && sentence.contains("record it again"), "{sentence}");
    }
    for text in ["psi_d,-50,0,50\n-50,1,2,3\n0,1,2,3\n", ",-50,0,50\n-50,1,2,3\n0,1,2,3\n"] {
        let sentence = refusal(text.as_bytes(), &LogOptions::default());
        assert!(sentence.contains("a matrix over two quantities") && sentence.contains("a row for each point"), "{sentence}");
    }
}

/// Six rows of 10 kHz for each time, as a logger writes them with three digits.
#[test]
fn times_that_were_rounded_are_told_as_such_and_a_stated_period_replaces_them() {
    let rows = |first: &dyn Fn(usize) -> String| -> String {
        (0..60).map(|k| format!("{},1.{k},20.{},0.5,3.{k},40{}.5\n", first(k), k % 7, k % 3)).collect()
    };
    let rounded = |k: usize| format!("{:.3}", (k as f64 * 1e-4 - 4e-5).max(0.0));
    let text = format!("{HEADER}{}", rows(&rounded));
    assert_eq!(
        refusal(text.as_bytes(), &LogOptions::default()),
        "drive.csv, column 't': the times are rounded to 1 ms, and about 10 rows have the same; do not remove them: write the time between \
         rows into a mapping file, sample_period = \"0.1 ms\""
    );
    let mapping = |text: &str| LogOptions { mapping: Mapping::parse("m.toml", text.as_bytes()).unwrap(), ..LogOptions::default() };
    let stated = mapping("sample_period = \"0.1 ms\"\n");
    let exact = parse_log("drive.csv", format!("{HEADER}{}", rows(&|k| format!("{}e-4", k))).as_bytes(), &LogOptions::default()).unwrap();
    let read = parse_log("drive.csv", text.as_bytes(), &stated).unwrap();
    assert!(read.log.columns().t.iter().zip(&exact.log.columns().t).all(|(t, expected)| (t - expected).abs() < 1e-12));
    assert_eq!(read.log.columns().uq, exact.log.columns().uq);
    let notes = &read.log.source().notes;
    let expected = "column 't' is not read: the mapping file states sample_period; map t to the column to use it instead";
    assert_eq!(notes[..], [expected, "t counts the rows: one every 0.0001 s"]);
    // A time that is mapped has priority.
    let both = mapping("sample_period = \"1 ms\"\n[columns]\nt = \"t\"\n");
    let read = parse_log("drive.csv", format!("{HEADER}{}", rows(&|k| format!("{}e-4", k))).as_bytes(), &both).unwrap();
    assert_eq!(read.log.columns().t, exact.log.columns().t);
    assert_eq!(read.log.source().notes, ["sample_period is not used: t is mapped to column 't'"]);
}

#[test]
fn a_log_that_lacks_only_the_time_is_told_how_to_state_the_period() {
    let remedy = "if no column is the time and all rows are equally far apart, write the time between them into a mapping file, as in \
                  sample_period = \"0.1 ms\"";
    for header in ["x,ud,uq,id,iq,omega_e", "x,bench vd,bench vq,bench id,bench iq,speed_rpm", "ud,uq,id,iq,omega_e"] {
        let text = format!("{header}\n{}", "1,2,3,4,5,6\n".repeat(3));
        assert!(refusal(text.as_bytes(), &LogOptions::default()).contains(remedy), "{header}");
    }
    for header in ["time stamp,bench vd,bench vq,bench id,bench iq,speed_rpm", "x,y,z,id,iq,omega_e"] {
        let text = format!("{header}\n{}", "1,2,3,4,5,6\n".repeat(3));
        assert!(!refusal(text.as_bytes(), &LogOptions::default()).contains("sample_period"), "{header}");
    }
}

#[test]
fn line_to_line_voltages_are_not_proposed_for_those_of_the_phases() {
    let of = |header: &str| refusal(format!("{header}\n{}", "1,2,3,4,5,6\n".repeat(3)).as_bytes(), &LogOptions::default());
    let scaled = of("t,ud_ll,uq_ll,id,iq,omega_e");
    assert!(!scaled.contains("may be ud"), "{scaled}");
    assert!(
        scaled.ends_with(
            "; 'ud_ll' and 'uq_ll' are line-to-line voltages by their names: if they are sqrt 3 times as large as of a phase, write into a mapping \
             file ud = { column = \"ud_ll\", scale = 0.57735 } and uq = { column = \"uq_ll\", scale = 0.57735 }"
        ),
        "{scaled}"
    );
    let pairs = of("t,ia,ib,Uab [V],Ubc [V],theta_e");
    assert!(
        pairs.ends_with(
            "; 'Uab [V]' and 'Ubc [V]' are line-to-line voltages by their names, and those of the phases are needed: compute \
             ua = (2 uab + ubc) / 3, ub = (ubc - uab) / 3"
        ),
        "{pairs}"
    );
}

#[test]
fn phases_and_usual_names_of_a_speed_are_proposed() {
    let of = |header: &str| {
        let text = format!("{header}\n{}", "1,2,3,4,5,6,7,8\n".repeat(3));
        parse_log("drive.csv", text.as_bytes(), &LogOptions::default()).unwrap_err()
    };
    let columns = |pairs: &[(&'static str, &str)]| -> Vec<(&'static str, Option<String>)> {
        pairs.iter().map(|(channel, header)| (*channel, Some((*header).to_owned()))).collect()
    };
    let phases = of("Time (us),Iu (A),Iv (A),Iw (A),Vu (V),Vv (V),Vw (V),Elec angle (deg)");
    assert_eq!(phases.advice(), [Advice::MapColumns(columns(&[("ua", "Vu (V)"), ("ub", "Vv (V)"), ("uc", "Vw (V)")]))], "{phases}");
    for (header, unit) in [("f_e", "Hz-elec"), ("nm", "rpm-mech")] {
        let speed = of(&format!("t,ud,uq,id,iq,{header},x,y"));
        let advice = Advice::MapInUnits { columns: columns(&[("omega_e", header)]), units: vec![("omega_e", unit)] };
        assert_eq!(speed.advice(), [advice], "{speed}");
    }
    // A torque.
    assert!(!of("t,ud,uq,id,iq,Nm,x,y").to_string().contains("may be omega_e"));
}

/// Phase quantities of four pole pairs, and an angle that winds around after a turn of the shaft.
#[test]
fn a_mechanical_angle_is_taken_where_its_unit_is_stated() {
    let text = |theta: &str, turn: f64| {
        let row = |k: usize| {
            let electrical = 0.3 * k as f64;
            let [ua, ub, ia, ib] =
                [(20.0, 0.0), (20.0, 2.0944), (3.0, 0.5), (3.0, 2.5944)].map(|(size, phase)| size * (electrical - phase).cos());
            format!("{}e-4,{ua:.5},{ub:.5},{ia:.5},{ib:.5},{:.6}\n", k, (electrical / 4.0 / std::f64::consts::TAU).fract() * turn)
        };
        format!("t,ua,ub,ia,ib,{theta}\n{}", (0..400).map(row).collect::<String>())
    };
    let turn = std::f64::consts::TAU;
    let stated = LogOptions { units: vec![("theta_e".into(), Unit::RadianMechanical)], pole_pairs: Some(4), ..LogOptions::default() };
    let named = LogOptions { pole_pairs: Some(4), ..LogOptions::default() };
    for (theta, options) in [("theta", stated), ("theta_mech (rad)", named)] {
        let log = log_of(text(theta, turn).as_bytes(), &options);
        assert!((log.columns().omega_e[200] - 3000.0).abs() < 1.0, "{theta}: {}", log.columns().omega_e[200]);
    }
    // A resolver's voltage: the turn is not a round number.
    let resolver = refusal(text("theta_e", 3.3).as_bytes(), &LogOptions::default());
    assert!(
        resolver.contains("theta_e = { column = \"theta_e\", scale = 1.9")
            && resolver.ends_with(", with 6.28319 divided by the exact turn as scale"),
        "{resolver}"
    );
}

#[test]
fn a_name_that_a_message_cut_can_be_mapped() {
    let name = "SERVO_02.r1732[0] Spannungssollwert direkt, im System der Achse, mit Begrenzung [V]";
    let text = format!("t,\"{name}\",uq,id,iq,omega_e\n{ROWS}");
    let sentence = refusal(text.as_bytes(), &LogOptions::default());
    let start = sentence.find("'SERVO").unwrap() + 1;
    let cut = &sentence[start..start + sentence[start..].find("'").unwrap()];
    assert!(cut.ends_with('…'), "{cut}");
    assert_eq!(log_of(text.as_bytes(), &map(&[&format!("ud={cut}")])).columns().ud, [1.0, 1.0]);
}

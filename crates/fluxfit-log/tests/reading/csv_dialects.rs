//! Every dialect gives the same log; everything else is refused in one sentence.

use fluxfit_log::{LogOptions, parse_log, parse_map, read_log};
use fluxfit_units::Unit;
use proptest::prelude::*;
use std::path::{Path, PathBuf};

const LOG: &str = "t,ud,uq,id,iq,omega_e\n0,-1.5,20.25,0,3,400\n0.001,-1.25,20,-0.5,3.125,401\n0.002,0,19,1e-3,3,-4.5\n";

fn map(pairs: &[&str]) -> LogOptions {
    LogOptions { map: pairs.iter().map(|pair| parse_map(pair).expect(pair)).collect(), ..LogOptions::default() }
}

fn log_of(bytes: &[u8], options: &LogOptions) -> fluxfit::log::Log {
    parse_log("drive.csv", bytes, options).unwrap_or_else(|error| panic!("{}\n{error}", String::from_utf8_lossy(bytes))).log
}

#[test]
fn every_dialect_gives_the_same_log() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    assert_eq!(expected.columns().uq, [20.25, 20.0, 19.0]);
    assert_eq!(expected.columns().omega_e, [400.0, 401.0, -4.5]);
    let shuffled: String = LOG.lines().map(|line| line.split(',').rev().collect::<Vec<_>>().join(",") + "\n").collect();
    let texts = |row: usize| ["note", "\"warm, then cold\"", "\"two\nlines\"", ""][row];
    let extra: String = LOG.lines().enumerate().map(|(row, line)| format!("{},{line},{row}\n", texts(row))).collect();
    let quoted: String = LOG.lines().map(|line| format!("\"{}\"\n", line.replace(',', "\",\""))).collect();
    let dialects = [
        LOG.replace(',', ";"),
        LOG.replace(',', "\t"),
        LOG.replace(',', " , "),
        LOG.replace(',', ",\t"),
        LOG.replace(',', ";").replace('.', ","),
        LOG.replace(',', "\t").replace('.', ","),
        format!("\u{feff}{LOG}"),
        LOG.replace('\n', "\r\n"),
        LOG.replace('\n', "\r"),
        LOG.trim_end().to_owned(),
        LOG.replace('\n', ",\n"),
        LOG.replace(',', ";").replace('\n', ";\r\n"),
        LOG.replacen('\n', ",\n", 1),
        LOG.replace("omega_e\n", "omega_e\n\n").replace("401\n", "401\n   \n,,,,,\n\n"),
        LOG.to_uppercase(),
        shuffled,
        extra,
        quoted.clone(),
        quoted.replace(',', ", "),
        format!("# drive 3\n% at noon\n\n{LOG}"),
        format!("# {LOG}"),
        format!("sep=;\r\n{}", LOG.replace(',', ";")),
    ];
    for dialect in dialects {
        assert_eq!(log_of(dialect.as_bytes(), &LogOptions::default()), expected, "{dialect}");
    }
    let renamed = LOG.replace("ud", "V d").replace("omega_e", "speed");
    assert_eq!(log_of(renamed.as_bytes(), &map(&["ud=V d", "omega=Speed"])), expected);
}

#[test]
fn titles_and_a_row_of_units_are_read_over_and_said() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    let (header, rows) = LOG.split_once('\n').unwrap();
    let text = format!("Run 7\n\n2019-04-23, 11:04:34\n{header}\ns,V,V,A,A,rad/s\n{rows}");
    let read = parse_log("drive.csv", text.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!(read.log, expected);
    assert_eq!(
        read.log.source().notes,
        ["read as titles above the header: \"Run 7\" and \"2019-04-23, 11:04:34\"", "line 5 is a row of units"]
    );
    let in_thousandths = format!("{header}\n[ms],V,V,mA,mA,rad/s\n0,1,2,3000,0,5\n1,1,2,3000,0,5\n");
    let read = parse_log("drive.csv", in_thousandths.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!((read.log.columns().t[1], read.log.columns().id[0]), (0.001, 3.0));
}

#[test]
fn what_is_packed_or_in_another_encoding_gives_the_same_log() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    let utf_16 = |bytes: fn(u16) -> [u8; 2]| std::iter::once(0xfeff).chain(LOG.encode_utf16()).flat_map(bytes).collect::<Vec<u8>>();
    assert_eq!(log_of(&utf_16(u16::to_le_bytes), &LogOptions::default()), expected);
    assert_eq!(log_of(&utf_16(u16::to_be_bytes), &LogOptions::default()), expected);
    let latin: Vec<u8> =
        [b"t,ud,uq,id,iq,omega_e,\xb0C\n".as_slice(), LOG.split_once('\n').unwrap().1.replace('\n', ",7\n").as_bytes()].concat();
    assert_eq!(log_of(&latin, &LogOptions::default()), expected);
}

#[test]
fn a_last_line_that_is_cut_off_is_left_out_and_said() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    for cut in ["0.003,1,2", "0.003,1,2,3,4,-"] {
        let read = parse_log("drive.csv", format!("{LOG}{cut}").as_bytes(), &LogOptions::default()).unwrap();
        assert_eq!(read.log, expected);
        assert_eq!(read.log.source().notes, ["the last line, 5, is cut off and left out"]);
    }
}

#[test]
fn a_decimal_comma_is_noted_once() {
    let german = LOG.replace(',', ";").replace('.', ",");
    let read = parse_log("drive.csv", german.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!(read.log.source().notes, ["decimal commas were read as decimal points"]);
}

/// The refusal of a log in memory, which must be one line.
fn refusal(bytes: &[u8], options: &LogOptions) -> String {
    let sentence = parse_log("drive.csv", bytes, options).expect_err(&String::from_utf8_lossy(bytes)).to_string();
    assert!(!sentence.contains(['\n', '\r']), "{sentence}");
    sentence
}

/// Rows that would be read under any header of six columns.
const ROWS: &str = "0,1,2,3,4,5\n1,1,2,3,4,5\n";

const HEADER: &str = "t,ud,uq,id,iq,omega_e\n";

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
            "t ud uq\n1 2 3\n".into(),
            "drive.csv, line 1: \"t ud uq\" is a single column; separate names and values by comma, semicolon or tab",
        ),
        (
            "Run 7\nspeed,id,iq\n1,2,3\n".into(),
            "drive.csv, line 2: the columns t, ud, uq and omega_e are missing; the file has 'speed', 'id' and 'iq'; \
             by the names 'speed' may be omega_e: map it if so; no column resembles t, ud and uq",
        ),
        (
            format!("t,ud,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1: the column uq is missing; the file has 't', 'ud', 'id', 'iq' and 'omega_e'; \
             map it if it has another name, else log it too",
        ),
        (
            format!("u_d,motor_speed,i_d,i_q,torque,profile_id\n{ROWS}"),
            "drive.csv, line 1: the columns t, ud, uq, id, iq and omega_e are missing; \
             the file has 'u_d', 'motor_speed', 'i_d', 'i_q', 'torque' and 'profile_id'; \
             by the names 'u_d' may be ud, 'i_d' may be id, 'i_q' may be iq and 'motor_speed' may be omega_e: map them if so; \
             no column resembles t and uq",
        ),
        (
            format!("tiem,q-axis voltage,ud,id,iq,omega_e\n{ROWS}"),
            "drive.csv, line 1: the columns t and uq are missing; the file has 'tiem', 'q-axis voltage', 'ud', 'id', 'iq' and 'omega_e'; \
             by the names 'tiem' may be t and 'q-axis voltage' may be uq: map them if so",
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
    let told = |speed: &str, options: &LogOptions| refusal(log(speed)[0].0.as_bytes(), options);
    assert_eq!(
        told("motor_speed", &map(&["omega=speeed"])),
        "drive.csv, line 1: omega_e is mapped to 'speeed', which the file does not have; it has 't', 'ud', 'uq', 'id', 'iq' and 'motor_speed'; \
         did you mean 'motor_speed'?"
    );
    assert_eq!(
        told("omega_e", &LogOptions { map: vec![("speed".into(), "omega_e".into())], ..LogOptions::default() }),
        "\"speed\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e, and optionally theta_e, u_dc, ua, ub, uc, ia, ib, ic and run; did you mean omega_e?"
    );
    assert_eq!(
        told("speed [km/h]", &map(&["omega=speed [km/h]"])),
        "drive.csv, line 1, column 'speed [km/h]': \"km/h\" in the header is not a known unit of omega_e; \
         state the unit: rad/s, rpm-elec, rpm-mech, rad/s-mech, Hz-elec or Hz-mech"
    );
    let units = LogOptions { units: vec![("omega".into(), Unit::HertzMechanical)], ..LogOptions::default() };
    assert_eq!(
        told("omega_e", &units),
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
            "drive.csv, line 1, column 't': \"a\" in the header is not a known unit of t; state the unit: s, ms or us",
        ),
        (
            below("0,1,2,3,4,5\n\n1,1,2,3,4\n"),
            "drive.csv, line 4: the row has 5 cells where the header has 6; complete the row or remove it",
        ),
        (below("0,1,2,3,4,5,6\n"), "drive.csv, line 2: the row has 7 cells where the header has 6; remove the extra cells or the row"),
        (below("0,1,2,3,4,5\n# end\n"), "drive.csv, line 3: the row has 1 cell where the header has 6; complete the row or remove it"),
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
        (below("0,1,2,3,4,5\n1,1, ,3,4,5\n"), "drive.csv, line 3, column 'uq': the cell is empty or NaN; write a number or remove the row"),
        (below("11:04:34.5,1,2,3,4,5\n"), "drive.csv, line 2, column 't': \"11:04:34.5\" is a time of day; write time as a number, in s"),
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
    // The library speaks of its own column; the file calls it otherwise, and in other units.
    let renamed = "clock_ms,ud,uq,id,iq,omega_e\n1000,1,2,3,4,5\n500,1,2,3,4,5\n";
    let sentence = refusal(renamed.as_bytes(), &map(&["t=clock_ms"]));
    assert!(sentence.starts_with("drive.csv, line 3, column 'clock_ms': time goes from 1 s to 0.5 s"), "{sentence}");
}

#[test]
fn what_is_no_text_or_no_file_is_refused() {
    let text = "this is not text in UTF-8; export it as CSV text in UTF-8";
    assert_eq!(refusal(&[HEADER.as_bytes(), b"0,1,2,\0,4,5\n"].concat(), &LogOptions::default()), format!("drive.csv, line 2: {text}"));
    let told = |path: &Path| read_log(path, &LogOptions::default()).unwrap_err().to_string();
    let directory = tempfile::tempdir().unwrap();
    let shown = directory.path().display();
    assert_eq!(told(directory.path()), format!("{shown}: this is a directory; name a file in it"));
    assert_eq!(told(&directory.path().join("x.csv")), format!("{shown}/x.csv: there is no such file; check the path"));
}

/// A log whose columns after the six needed ones are `header`, with `cells` in its two rows.
fn beside(header: &str, cells: [&str; 2]) -> String {
    format!("t,ud,uq,id,iq,omega_e,{header}\n0,1,2,3,4,5,{}\n1,1,2,3,4,5,{}\n", cells[0], cells[1])
}

fn read(text: &str, options: &LogOptions) -> (fluxfit::log::Columns, Vec<String>) {
    let read = parse_log("drive.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{text}\n{error}"));
    (read.log.columns().clone(), read.log.source().notes.clone())
}

#[test]
fn angle_and_dc_voltage_are_taken_where_the_log_has_them() {
    let none = LogOptions::default;
    let both = beside("theta_e,u_dc", ["-1.5,310", "3,305.5"]);
    let (columns, notes) = read(&both, &none());
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![-1.5, 3.0]), Some(vec![310.0, 305.5])));
    assert!(notes.is_empty(), "{notes:?}");
    // The needed columns are those of the log without the others.
    let (without, notes) = read(&format!("{HEADER}{ROWS}"), &none());
    assert_eq!((read(&both, &none()).0.named(), notes), (without.named(), Vec::<String>::new()));
    assert_eq!((&without.theta_e, &without.u_dc), (&None, &None));
    let (one, _) = read(&beside("u_dc", ["310", "305.5"]), &none());
    assert_eq!((one.theta_e, one.u_dc), (None, Some(vec![310.0, 305.5])));

    // Another dialect, other places, other case, a unit in the header.
    let german = "u_dc;t;Theta_E;ud;uq;id;iq;omega_e\n310,5;0;-1,5;1;2;3;4;5\n;;;;;;;\n305;1;3;1;2;3;4;5\n";
    let (columns, notes) = read(german, &none());
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![-1.5, 3.0]), Some(vec![310.5, 305.0])));
    assert_eq!(notes, ["theta_e: column 'Theta_E' used", "decimal commas were read as decimal points"]);
    let (columns, notes) = read(&beside("theta_e [deg],u_dc_mV", ["90,310000", "-180,305500"]), &none());
    let half = std::f64::consts::FRAC_PI_2;
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![half, -2.0 * half]), Some(vec![310.0, 305.5])));
    assert_eq!(notes, ["theta_e: column 'theta_e [deg]' read as electrical degrees", "u_dc: column 'u_dc_mV' read as mV"]);
    // The exact name comes first, as for other columns.
    assert_eq!(read(&beside("u_dc_mV,u_dc", ["1,310", "1,310"]), &none()).0.u_dc, Some(vec![310.0; 2]));
}

#[test]
fn angle_and_dc_voltage_under_other_names() {
    let log = beside("phi,bus,note", ["90,310,a", "180,305.5,"]);
    let (columns, notes) = read(&log, &LogOptions::default());
    assert_eq!((columns.theta_e, columns.u_dc, notes.len()), (None, None, 0));
    let (columns, notes) = read(&log, &map(&["theta=phi", "u_dc=bus"]));
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![90.0, 180.0]), Some(vec![310.0, 305.5])));
    let unsaid = "no header states these units, so SI is assumed: theta_e ('phi') in electrical rad and u_dc ('bus') in V";
    assert_eq!(notes, [unsaid]);
    // A mechanical angle becomes electrical, in other turns: 90 degrees are 2 pi / 4, four times that a turn.
    let units = vec![("theta".into(), Unit::DegreeMechanical), ("u_dc".into(), Unit::Volt)];
    let mechanical = LogOptions { units, pole_pairs: Some(4), ..map(&["theta=phi", "u_dc=bus"]) };
    let (columns, notes) = read(&log, &mechanical);
    let angle = columns.theta_e.unwrap();
    let turn = std::f64::consts::TAU;
    assert!((angle[0] - turn).abs() < 1e-14 && (angle[1] - 2.0 * turn).abs() < 1e-14, "{angle:?}");
    assert_eq!(notes, ["theta_e: column 'phi' read as mechanical degrees with 4 pole pairs"]);
    assert_eq!(
        read(&beside("angle_deg", ["90", "180"]), &map(&["theta=angle_deg"])).1,
        ["theta_e: column 'angle_deg' read as electrical degrees; if it is mechanical, state its unit"]
    );
    let lonely = LogOptions { units: vec![("theta".into(), Unit::Degree)], ..LogOptions::default() };
    assert_eq!(read(&log, &lonely).1, ["the unit stated for theta_e, deg, is not used: the log has no such column"]);
}

#[test]
fn an_optional_column_refuses_the_log_only_if_it_was_asked_for() {
    let cases = [
        ("u_dc", ["310", "abc"], "line 3, column 'u_dc': \"abc\" is not a number; correct it or remove the row"),
        ("u_dc", ["", "310"], "line 2, column 'u_dc': the cell is empty or NaN; write a number or remove the row"),
        ("u_dc", ["nan", "310"], "line 2, column 'u_dc': the cell is empty or NaN; write a number or remove the row"),
        ("u_dc", ["310", "1e999"], "line 3, column 'u_dc': u_dc is inf; remove the row or write a finite number"),
        (
            "u_dc",
            ["310", "1e10"],
            "line 3, column 'u_dc': u_dc is 1e10, beyond the 1e9 that any drive can have; check the column's unit or remove the row",
        ),
        ("u_dc", ["V", "V"], "line 2, column 'u_dc': \"V\" is not a number; correct it or remove the row"),
    ];
    let (without, _) = read(&format!("{HEADER}{ROWS}"), &LogOptions::default());
    for (header, cells, why) in cases {
        let text = beside(header, cells);
        assert_eq!(read(&text, &LogOptions::default()), (without.clone(), vec![format!("u_dc is left out: {why}")]), "{text}");
        assert_eq!(refusal(text.as_bytes(), &map(&["u_dc=u_dc"])), format!("drive.csv, {why}"), "{text}");
    }
    // One that is left out takes nothing from the other.
    let (columns, notes) = read(&beside("theta_e,u_dc", ["-1.5,310", "3,"]), &LogOptions::default());
    assert_eq!((columns.theta_e, columns.u_dc, notes.len()), (Some(vec![-1.5, 3.0]), None, 1));
}

#[test]
fn headers_of_optional_columns_refuse_the_log_only_if_they_were_asked_for() {
    let cases = [
        ("theta_e,theta_e", "line 1, column 'theta_e': the header has this name 2 times; rename or remove all but one"),
        ("Theta_e,THETA_E", "line 1: the columns 'Theta_e' and 'THETA_E' could each be theta_e; map one of them to theta_e"),
        (
            "x,theta_e [rad-mech]",
            "line 1, column 'theta_e [rad-mech]': the angle is in mechanical rad, and converting it takes the number of pole pairs; \
             state it, or state that the unit is electrical rad",
        ),
    ];
    for (header, why) in cases {
        let text = beside(header, ["1,1", "1,1"]);
        let (columns, notes) = read(&text, &LogOptions::default());
        assert_eq!((columns.theta_e, notes), (None, vec![format!("theta_e is left out: {why}")]), "{text}");
    }
    let refused = |header: &str, options: &[&str]| refusal(beside(header, ["1,1", "1,1"]).as_bytes(), &map(options));
    assert_eq!(refused("theta_e,theta_e", &["theta=theta_e"]), format!("drive.csv, {}", cases[0].1));
    assert_eq!(refused("x,theta_e [rad-mech]", &["theta=theta_e [rad-mech]"]), format!("drive.csv, {}", cases[2].1));
    assert_eq!(
        refused("a,Bus voltage", &["u_dc=buss"]),
        "drive.csv, line 1: u_dc is mapped to 'buss', which the file does not have; \
         it has 't', 'ud', 'uq', 'id', 'iq', 'omega_e', 'a' and 'Bus voltage'; did you mean 'Bus voltage'?"
    );
    assert_eq!(
        refused("a,b", &["u_dc=uq"]),
        "drive.csv, line 1, column 'uq': this column would be both uq and u_dc; map each of them to a column of its own"
    );
    // A column that the user said is another one is not the DC voltage.
    let (columns, notes) = read("t,ud,u_dc,id,iq,omega_e\n0,1,2,3,4,5\n1,1,2,3,4,5\n", &map(&["uq=u_dc"]));
    assert_eq!((columns.uq, columns.u_dc), (vec![2.0; 2], None));
    assert_eq!(notes.len(), 1, "{notes:?}");
}

#[test]
fn an_optional_column_does_not_decide_the_decimal_mark() {
    let rows = |cells: [&str; 2]| format!("t;ud;uq;id;iq;omega_e;u_dc\n0;1;2;3;4;5;{}\n1;{};2;3;4;5;310\n", cells[0], cells[1]);
    let why = "line 2, column 'u_dc': this cell has another decimal mark than line 3; use one mark throughout, and no thousands separators";
    let text = rows(["310.5", "1,5"]);
    let (columns, notes) = read(&text, &LogOptions::default());
    assert_eq!((columns.ud, columns.u_dc), (vec![1.0, 1.5], None));
    assert_eq!(notes, ["decimal commas were read as decimal points", format!("u_dc is left out: {why}").as_str()]);
    assert_eq!(
        refusal(text.as_bytes(), &map(&["u_dc=u_dc"])),
        "drive.csv, line 3, column 'ud': \"1,5\" has another decimal mark than line 2; use one mark throughout, and no thousands separators"
    );
    assert_eq!(read(&rows(["310,5", "1,5"]), &LogOptions::default()).0.u_dc, Some(vec![310.5, 310.0]));
    assert_eq!(read(&rows(["1.234", "1.5"]), &LogOptions::default()).0.u_dc, Some(vec![1.234, 310.0]));
    let own = "t;ud;uq;id;iq;omega_e;u_dc\n0;1;2;3;4;5;310.5\n1;1;2;3;4;5;310,5\n";
    let (columns, notes) = read(own, &LogOptions::default());
    assert_eq!((columns.u_dc, notes.len()), (None, 1), "{notes:?}");
}

/// A file that is not part of this project, and may be absent.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if !path.exists() {
        eprintln!("skipped: ../shared/data/{name} is absent");
    }
    path.exists().then_some(path)
}

#[test]
fn real_logs_without_voltages_are_refused_clearly() {
    let Some(path) = shared("capo01_odrive_dyno_loss.csv") else { return };
    let bytes = std::fs::read(path).unwrap();
    let sentence = refusal(&bytes, &LogOptions::default());
    assert!(
        sentence.starts_with("drive.csv, line 2: the columns t, ud, uq, id, iq and omega_e are missing; the file has 'Input voltage', ")
    );
    assert!(
        sentence.ends_with(
            "by the names 'Test motor d-axis current' may be id, 'Test motor q-axis current' may be iq and 'Output Speed' may be omega_e: \
             map them if so; no column resembles t, ud and uq"
        ),
        "{sentence}"
    );

    let Some(path) = shared("paderborn_lea_subset_no_uq.csv") else { return };
    let bytes = std::fs::read(path).unwrap();
    let sentence = refusal(&bytes, &LogOptions::default());
    assert!(sentence.starts_with("drive.csv, line 1: the column uq is missing; the file has 'coolant', "), "{sentence}");
}

#[test]
fn real_logs_are_read() {
    let Some(path) = shared("emrax228hv_coastdown_dyno.csv") else { return };
    let read = read_log(&path, &LogOptions { pole_pairs: Some(10), ..LogOptions::default() }).unwrap();
    assert_eq!((read.log.rows(), read.layout.map(|layout| layout.name)), (14_595, Some("Tritium, names with units")));
    let notes = [
        "omega_e: column 'motor_velocity_rpm' read as mechanical r/min with 10 pole pairs",
        "27 gaps, the longest of 4.19 s at t = 654.604 s: nothing is computed across them",
    ];
    assert_eq!(read.log.source().notes[1..], notes);
    let expected = -637.188 * std::f64::consts::TAU / 60.0 * 10.0;
    assert!((read.log.columns().omega_e[0] - expected).abs() < 1e-9);

    let Some(path) = shared("stm32_mcsdk_dewalt_excerpt.csv") else { return };
    let read = read_log(&path, &LogOptions { pole_pairs: Some(2), ..LogOptions::default() }).unwrap();
    assert_eq!((read.log.rows(), read.log.columns().t[1]), (26, 829.061));

    let Some(path) = shared("a_ideal_averaged.csv") else { return };
    let read = read_log(&path, &LogOptions::default()).unwrap();
    assert_eq!((read.log.rows(), read.notes.len()), (9001, 0));
    // From one row to the next the angle grows by the speed times the period, but for whole turns.
    let columns = read.log.columns();
    let angle = columns.theta_e.as_ref().unwrap();
    let turns = (angle[8001] - angle[8000] - columns.omega_e[8000] * (columns.t[8001] - columns.t[8000])) / std::f64::consts::TAU;
    assert!((turns - turns.round()).abs() < 1e-5, "{turns}");
}

/// What logs are made of, and what breaks them.
const PIECES: [&str; 43] = [
    "t,ud,uq,id,iq,omega_e\n",
    "t,ud,uq,id,iq,omega_e,u_dc,theta_e\n",
    "0,1,2,3,4,5,310,1\n",
    "2,1,2,3,4,5,,x\n",
    "t;ud;uq;id;iq;omega_e\n",
    "0,1,2,3,4,5\n",
    "1,1,2,3,4,5\r\n",
    "2;1,5;2;3;4;5\n",
    "3;1.5;2;3;4;5\r",
    "t",
    "ud",
    "u_q",
    "ID",
    "iq@A",
    "omega_e [rpm]",
    "speed_rpm",
    "(",
    "[",
    "]",
    ")",
    "@",
    "_",
    ",",
    ";",
    "\t",
    " ",
    "\n",
    "\r",
    "\r\n",
    "\"",
    "#",
    "%",
    "sep=;",
    "-1.5",
    "1,5",
    "nan",
    "1e999",
    "Ω",
    "\u{feff}",
    "\0",
    "\u{2028}",
    "2019-01-01 10:00",
    "İ",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_panic(
        noise in prop::collection::vec(any::<u8>(), 0..60),
        pieces in prop::collection::vec(prop::sample::select(&PIECES[..]), 0..40),
        at in any::<prop::sample::Index>(),
        header in prop::sample::select(vec!["speed_rpm", "t", "u_q", "", "Ω", "x"]),
        pole_pairs in prop::option::of(0u32..4),
    ) {
        let text = pieces.concat();
        let cut = at.index(text.len() + 1);
        let noisy = [&text.as_bytes()[..cut], &noise, &text.as_bytes()[cut..]].concat();
        let mapped = LogOptions { map: vec![("omega".into(), header.into())], pole_pairs, ..LogOptions::default() };
        for bytes in [text.as_bytes(), &noisy, &noise] {
            for options in [&LogOptions::default(), &mapped] {
                match parse_log("drive.csv", bytes, options) {
                    Ok(read) => prop_assert!(read.log.rows() >= 2),
                    Err(error) => prop_assert!(!error.to_string().contains(['\n', '\r', '\u{2028}']), "{error}"),
                }
            }
        }
    }
}

//! Angle and DC voltage are optional: read where they can be, and left out with a note where they cannot.

use crate::fixtures::{HEADER, ROWS, map, refusal};
use fluxfit_log::{LogOptions, parse_log};
use fluxfit_units::Unit;

/// A log whose columns after the six needed ones are `header`, with `cells` in its two rows.
fn with_columns(header: &str, cells: [&str; 2]) -> String {
    format!("t,ud,uq,id,iq,omega_e,{header}\n0,1,2,3,4,5,{}\n1,1,2,3,4,5,{}\n", cells[0], cells[1])
}

fn read(text: &str, options: &LogOptions) -> (fluxfit::log::Columns, Vec<String>) {
    let read = parse_log("drive.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{text}\n{error}"));
    (read.log.columns().clone(), read.log.source().notes.clone())
}

#[test]
fn angle_and_dc_voltage_are_read_if_the_log_has_them() {
    let none = LogOptions::default;
    let both = with_columns("theta_e,u_dc", ["-1.5,310", "3,305.5"]);
    let (columns, notes) = read(&both, &none());
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![-1.5, 3.0]), Some(vec![310.0, 305.5])));
    assert!(notes.is_empty(), "{notes:?}");
    // The needed columns do not change.
    let (without, notes) = read(&format!("{HEADER}{ROWS}"), &none());
    assert_eq!((read(&both, &none()).0.named(), notes), (without.named(), Vec::<String>::new()));
    assert_eq!((&without.theta_e, &without.u_dc), (&None, &None));
    let (one, _) = read(&with_columns("u_dc", ["310", "305.5"]), &none());
    assert_eq!((one.theta_e, one.u_dc), (None, Some(vec![310.0, 305.5])));

    // Another dialect, order and case, and a unit in the header.
    let german = "u_dc;t;Theta_E;ud;uq;id;iq;omega_e\n310,5;0;-1,5;1;2;3;4;5\n;;;;;;;\n305;1;3;1;2;3;4;5\n";
    let (columns, notes) = read(german, &none());
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![-1.5, 3.0]), Some(vec![310.5, 305.0])));
    assert_eq!(notes, ["theta_e: column 'Theta_E' used", "decimal commas were read as decimal points"]);
    let (columns, notes) = read(&with_columns("theta_e [deg],u_dc_mV", ["90,310000", "-180,305500"]), &none());
    let half = std::f64::consts::FRAC_PI_2;
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![half, -2.0 * half]), Some(vec![310.0, 305.5])));
    assert_eq!(notes, ["theta_e: column 'theta_e [deg]' read as electrical degrees", "u_dc: column 'u_dc_mV' read as mV"]);
    // The exact name has priority, as for other columns.
    assert_eq!(read(&with_columns("u_dc_mV,u_dc", ["1,310", "1,310"]), &none()).0.u_dc, Some(vec![310.0; 2]));
}

#[test]
fn angle_and_dc_voltage_under_other_names() {
    let log = with_columns("alpha,bus,note", ["90,310,a", "180,305.5,"]);
    let (columns, notes) = read(&log, &LogOptions::default());
    assert_eq!((columns.theta_e, columns.u_dc, notes.len()), (None, None, 0));
    let (columns, notes) = read(&log, &map(&["theta=alpha", "u_dc=bus"]));
    assert_eq!((columns.theta_e, columns.u_dc), (Some(vec![90.0, 180.0]), Some(vec![310.0, 305.5])));
    let unsaid = "no header states these units, so SI is assumed: theta_e ('alpha') in electrical rad and u_dc ('bus') in V";
    assert_eq!(notes, [unsaid]);
    // A mechanical angle becomes electrical, in other turns: 90 degrees are 2 pi / 4, four times that a turn.
    let units = vec![("theta".into(), Unit::DegreeMechanical), ("u_dc".into(), Unit::Volt)];
    let mechanical = LogOptions { units, pole_pairs: Some(4), ..map(&["theta=alpha", "u_dc=bus"]) };
    let (columns, notes) = read(&log, &mechanical);
    let angle = columns.theta_e.unwrap();
    let turn = std::f64::consts::TAU;
    assert!((angle[0] - turn).abs() < 1e-14 && (angle[1] - 2.0 * turn).abs() < 1e-14, "{angle:?}");
    assert_eq!(notes, ["theta_e: column 'alpha' read as mechanical degrees with 4 pole pairs"]);
    assert_eq!(
        read(&with_columns("angle_deg", ["90", "180"]), &map(&["theta=angle_deg"])).1,
        ["theta_e: column 'angle_deg' read as electrical degrees; if it is mechanical, state its unit"]
    );
    let lonely = LogOptions { units: vec![("theta".into(), Unit::Degree)], ..LogOptions::default() };
    assert_eq!(read(&log, &lonely).1, ["the unit stated for theta_e, deg, is not used: the log has no such column"]);
}

#[test]
fn an_unreadable_optional_column_refuses_the_log_only_if_it_was_mapped() {
    let cases = [
        ("u_dc", ["310", "abc"], "line 3, column 'u_dc': \"abc\" is not a number; correct it or remove the row"),
        ("u_dc", ["", "310"], "line 2, column 'u_dc': the cell is empty or NaN; write a number or remove the row"),
        ("u_dc", ["nan", "310"], "line 2, column 'u_dc': the cell is empty or NaN; write a number or remove the row"),
        ("u_dc", ["", ""], "column 'u_dc': the column has no number in any row; log it, or map another one in its place"),
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
        let text = with_columns(header, cells);
        assert_eq!(read(&text, &LogOptions::default()), (without.clone(), vec![format!("u_dc is left out: {why}")]), "{text}");
        assert_eq!(refusal(text.as_bytes(), &map(&["u_dc=u_dc"])), format!("drive.csv, {why}"), "{text}");
    }
    // The other optional column is still read.
    let (columns, notes) = read(&with_columns("theta_e,u_dc", ["-1.5,310", "3,"]), &LogOptions::default());
    assert_eq!((columns.theta_e, columns.u_dc, notes.len()), (Some(vec![-1.5, 3.0]), None, 1));
}

#[test]
fn the_header_of_an_optional_column_refuses_the_log_only_if_it_was_mapped() {
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
        let text = with_columns(header, ["1,1", "1,1"]);
        let (columns, notes) = read(&text, &LogOptions::default());
        assert_eq!((columns.theta_e, notes), (None, vec![format!("theta_e is left out: {why}")]), "{text}");
    }
    let refused = |header: &str, options: &[&str]| refusal(with_columns(header, ["1,1", "1,1"]).as_bytes(), &map(options));
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
    // A column that is mapped to another channel is not the DC voltage.
    let (columns, notes) = read("t,ud,u_dc,id,iq,omega_e\n0,1,2,3,4,5\n1,1,2,3,4,5\n", &map(&["uq=u_dc"]));
    assert_eq!((columns.uq, columns.u_dc), (vec![2.0; 2], None));
    assert_eq!(notes.len(), 1, "{notes:?}");
}

#[test]
fn an_optional_column_does_not_determine_the_decimal_mark() {
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

#[test]
fn the_windings_temperature_is_read_in_degrees_celsius() {
    let none = LogOptions::default;
    for (header, expected) in
        [("temperature", &[][..]), ("temperature [°C]", &[]), ("Temperature_degC", &["temperature: column 'Temperature_degC' used"])]
    {
        let (columns, notes) = read(&with_columns(header, ["61.5", "62"]), &none());
        assert_eq!(
            (columns.temperature, &notes[..]),
            (Some(vec![61.5, 62.0]), &expected.iter().map(|note| (*note).to_owned()).collect::<Vec<_>>()[..])
        );
    }
    let (columns, _) = read(&with_columns("temp_motor", ["61.5", "62"]), &map(&["temperature=temp_motor"]));
    assert_eq!(columns.temperature, Some(vec![61.5, 62.0]));
    // A sensor that is not connected is no reason to refuse the log; a unit that is not known makes another column of it.
    for (header, cells, expected) in [("temperature", ["-273", "-273"], 1), ("temperature [K]", ["330", "331"], 0)] {
        let (columns, notes) = read(&with_columns(header, cells), &none());
        assert!(columns.temperature.is_none() && notes.len() == expected, "{notes:?}");
        assert!(notes.iter().all(|note| note.starts_with("temperature is left out: ")), "{notes:?}");
    }
    // One that the user named is.
    let mapped = refusal(with_columns("x", ["999", "20"]).as_bytes(), &map(&["temperature=x"]));
    assert!(mapped.contains("temperature is 9.99e2, beyond the 2.3e2"), "{mapped}");
}

#[test]
fn a_temperature_that_is_written_now_and_then_is_held_between() {
    // Beside rows that are complete otherwise.
    let cells = ["", "50", "", "", "53", ""];
    let rows: String = cells.iter().enumerate().map(|(k, cell)| format!("{k},1,2,3,4,5,{cell}\n")).collect();
    let text = format!("t,ud,uq,id,iq,omega_e,temperature\n{rows}");
    let read = parse_log("drive.csv", text.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!(read.log.columns().temperature, Some(vec![50.0, 50.0, 51.0, 52.0, 53.0, 53.0]));
    assert!(!read.log.is_interpolated() && read.log.source().notes.is_empty(), "{:?}", read.log.source());
    // A column that is always empty is none.
    let empty = text.replace("50", "").replace("53", "");
    let read = parse_log("drive.csv", empty.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!((&read.log.columns().temperature, read.log.source().notes.len()), (&None, 1));
}

//! Every dialect of text gives the same log.

use crate::fixtures::{HEADER, LOG, log_of, map, refusal};
use fluxfit_log::{LogOptions, parse_log};
use proptest::prelude::*;

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
        // A decimal comma in quotes, where commas separate, as spreadsheets write it.
        quoted.replace("\",\"", ";").replace('.', ",").replace(';', "\",\""),
        format!("# drive 3\n% at noon\n\n{LOG}"),
        format!("# {LOG}"),
        LOG.replace("401\n", "401\n# the load changes, by hand\n") + "# the end\n",
        format!("sep=;\r\n{}", LOG.replace(',', ";")),
    ];
    for dialect in dialects {
        assert_eq!(log_of(dialect.as_bytes(), &LogOptions::default()), expected, "{dialect}");
    }
    // Columns of a matrix, as they are called of a MAT file.
    let matrix = LOG.replacen("ud,uq,id,iq", "\"out.vdq(:,1)\",\"out.vdq(:,2)\",\"idq(1,:)\",\"idq(2,:)\"", 1);
    assert_eq!(log_of(matrix.as_bytes(), &LogOptions::default()), expected);
    let renamed = LOG.replace("ud", "V d").replace("omega_e", "omega el");
    assert_eq!(log_of(renamed.as_bytes(), &map(&["ud=V d", "omega=Omega El"])), expected);
}

#[test]
fn titles_and_a_row_of_units_are_recognized() {
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

/// The log above as TwinCAT Scope exports it where channels share a time; a slow channel has its own, and ends before them or after.
#[test]
fn channels_of_one_time_in_an_export_of_twincat_scope_are_read() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default()).columns().clone();
    let line = |property: &str, values: [&str; 6]| {
        let [ud, uq, id, iq, omega_e, warm] = values;
        format!("{property}\t{ud}\t{uq}\t{id}\t{iq}\t{omega_e}\t{property}\t{warm}\r\n")
    };
    let titles = "Name\tS\r\nFile\tC:\\S.svdx\r\nStarttime of export\t132959733843760000\tMontag, 2. Mai 2022\t15:56:24.376\r\n\r\n";
    let head = line("Name", ["ud", "uq", "id", "iq", "omega_e", "warm"])
        + &line("SymbolComment", [""; 6])
        + &line("SampleTime[ms]", ["1", "1", "1", "1", "1", "2"])
        + &line("Unit", ["V (Voltage)", "V (Voltage)", "A (Current)", "A (Current)", "(None)", "(None)"]);
    let rows = ["0\t-1,5\t20,25\t0\t3\t400\t0\t25", "1\t-1,25\t20\t-0,5\t3,125\t401\t2\t25", "2\t0\t19\t1e-3\t3\t-4,5"];
    let longer = " \t \t \t \t \t \t4\t26\r\n";
    for above in [titles, ""] {
        let text = format!("{above}{head}\r\n{}\r\n", rows.join("\r\n"));
        assert_eq!(*log_of(text.as_bytes(), &LogOptions::default()).columns(), expected);
        let text = format!("{above}{head}\r\n{}\t4\t26\r\n{longer}", rows.join("\r\n"));
        assert_eq!(*log_of(text.as_bytes(), &LogOptions::default()).columns(), expected);
    }
}

#[test]
fn compression_and_encoding_do_not_change_the_log() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    let utf_16 = |bytes: fn(u16) -> [u8; 2]| std::iter::once(0xfeff).chain(LOG.encode_utf16()).flat_map(bytes).collect::<Vec<u8>>();
    assert_eq!(log_of(&utf_16(u16::to_le_bytes), &LogOptions::default()), expected);
    assert_eq!(log_of(&utf_16(u16::to_be_bytes), &LogOptions::default()), expected);
    let latin: Vec<u8> =
        [b"t,ud,uq,id,iq,omega_e,\xb0C\n".as_slice(), LOG.split_once('\n').unwrap().1.replace('\n', ",7\n").as_bytes()].concat();
    assert_eq!(log_of(&latin, &LogOptions::default()), expected);
}

#[test]
fn a_last_line_that_is_cut_off_is_left_out_with_a_note() {
    let expected = log_of(LOG.as_bytes(), &LogOptions::default());
    for cut in ["0.003,1,2", "0.003,1,2,3,4,-"] {
        let read = parse_log("drive.csv", format!("{LOG}{cut}").as_bytes(), &LogOptions::default()).unwrap();
        assert_eq!(read.log, expected);
        assert_eq!(read.log.source().notes, ["the last line, 5, is cut off and left out"]);
    }
}

#[test]
fn a_comma_in_quotes_that_may_separate_thousands_is_refused() {
    let refused = |rows: &str| refusal(format!("{HEADER}{rows}").as_bytes(), &LogOptions::default());
    let unclear = "drive.csv, line 3: the commas in its quoted numbers may be decimal marks or thousands separators; write numbers with \
                   decimal points and without thousands separators";
    assert_eq!(refused("0,1,2,3,4,999\n1,1,2,3,4,\"1,001\"\n2,1,2,3,4,\"1,002\"\n"), unclear);
    let mixed = refused("0.5,1,2,3,4,999\n1.5,1,2,3,4,\"1,001\"\n");
    assert!(mixed.contains("\"1,001\" has another decimal mark than line 2"), "{mixed}");
    let several = refused("0,1,2,3,4,\"1,001,001\"\n1,1,2,3,4,5\n");
    assert!(several.contains("\"1,001,001\" is not a number"), "{several}");
}

#[test]
fn a_decimal_comma_is_noted_once() {
    let german = LOG.replace(',', ";").replace('.', ",");
    let read = parse_log("drive.csv", german.as_bytes(), &LogOptions::default()).unwrap();
    assert_eq!(read.log.source().notes, ["decimal commas were read as decimal points"]);
}

/// Pieces of valid and of broken logs.
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

/// pandas writes an index without a name in the first column: a time where it is one, and refused where it counts the rows.
#[test]
fn the_index_of_a_table_is_its_time_or_is_refused() {
    let unnamed = LOG.replacen("t,", ",", 1);
    assert_eq!(log_of(unnamed.as_bytes(), &LogOptions::default()), log_of(LOG.as_bytes(), &LogOptions::default()));
    let counted =
        |name: &str| format!("{name},ud,uq,id,iq,omega_e\n{}", (0..40).map(|row| format!("{row},1,20,0,3,400\n")).collect::<String>());
    for name in ["", "Unnamed: 0"] {
        let refused = fluxfit_log::parse_log("a.csv", counted(name).as_bytes(), &LogOptions::default()).unwrap_err().to_string();
        assert!(refused.contains("whole numbers in steps of 1") && refused.contains("sample_period"), "{refused}");
    }
}

/// The line that TwinCAT Scope writes at the end, if it is asked to.
#[test]
fn the_last_line_of_an_export_of_twincat_scope_is_no_row() {
    let scope = |end: &str| {
        let rows: String = (0..40).map(|row| format!("{row}\t{}\t{row}\t3\t{row}\t1\t{row}\t20\t{row}\t400\n", row % 3)).collect();
        format!(
            "Name\tScope\nFile\tC:\\a.svdx\nStarttime of export\t1\tx\nEndtime of export\t2\tx\n\nName\tid\t\tiq\t\tud\t\tuq\t\tomega_e\t\nSampleTime[ms]\t1\t\t1\t\t1\t\t1\t\t1\t\n{rows}{end}"
        )
    };
    assert_eq!(log_of(scope("EOF\n").as_bytes(), &LogOptions::default()), log_of(scope("").as_bytes(), &LogOptions::default()));
    assert_eq!(log_of(scope("EOF").as_bytes(), &LogOptions::default()).columns().t.len(), 40);
}

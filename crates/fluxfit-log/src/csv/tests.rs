//! The result of reading does not depend on the size of blocks, the number of threads, or which way a row takes.

use super::*;
use proptest::prelude::*;
use std::io::Cursor;

/// What reading gives: columns, lines and refusals as one, and notes or an error.
type Outcome = (Vec<Vec<u64>>, Vec<u64>, Vec<Option<String>>, Result<Vec<String>, String>);

/// Reads a text in blocks of this size. Of the columns `a` to `d`, the last is optional.
fn outcome(text: &[u8], size: usize) -> Outcome {
    let mut table = TextTable::open(Box::new(Cursor::new(text.to_vec()))).unwrap();
    table.block_size = size;
    // Not in the order of the file.
    let wanted: Vec<WantedColumn> = [("c", false), ("a", false), ("d", true)]
        .into_iter()
        .map(|(name, is_optional)| {
            let index = table.heads.iter().position(|head| head.name == name).unwrap();
            WantedColumn { index, header: name.to_owned(), is_time: name == "a", is_optional, instants: None }
        })
        .collect();
    let (mut values, mut lines, mut refused) = (vec![Vec::new(); 3], Vec::new(), vec![None; 3]);
    let notes = table.read(&wanted, &mut |block| {
        for (all, more) in values.iter_mut().zip(&block.values) {
            assert_eq!(more.len(), block.lines.len());
            all.extend(more.iter().map(|value: &f64| value.to_bits()));
        }
        lines.extend_from_slice(&block.lines);
        for (first, later) in refused.iter_mut().zip(&mut block.refused) {
            *first = first.take().or(later.take().map(|error: FileError| error.to_string()));
        }
        Ok(())
    });
    (values, lines, refused, notes.map_err(|error| error.to_string()))
}

fn on(threads: usize, text: &[u8], size: usize) -> Outcome {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| outcome(text, size))
}

/// Sizes of blocks: of a few bytes, of a few rows, and of everything.
const SIZES: [usize; 6] = [1, 7, 20, 64, 1000, blocks::BLOCK];

/// The outcome, which must be the same for all sizes of blocks, on any number of threads.
fn same_outcome(text: &str) -> Outcome {
    let expected = on(1, text.as_bytes(), blocks::BLOCK);
    for size in SIZES {
        for threads in [1, 3] {
            assert_eq!(on(threads, text.as_bytes(), size), expected, "blocks of {size} bytes on {threads} threads: {text:?}");
        }
    }
    expected
}

/// A row that is given to the reader of records, because of a quotation mark in a cell that is not wanted: the same values and errors,
/// in the same line.
fn with_quotation(text: &str) -> String {
    let (header, rows) = text.split_once('\n').unwrap();
    let separator = if header.contains(';') { ';' } else { ',' };
    let names = format!("x{separator}{header}\n");
    rows.split_inclusive('\n')
        .map(|row| if row.trim().is_empty() { row.to_owned() } else { format!("\"\"{separator}{row}") })
        .fold(names, |all, row| all + &row)
}

#[test]
fn an_error_in_a_later_block_names_its_line() {
    let rows = |count: usize| (0..count).map(|row| format!("{row},1.5,-2e-3,7\n")).collect::<String>();
    let text = format!("a,b,c,d\n{}oops,1,2,3\n{}", rows(500), rows(500));
    let (values, lines, _, error) = same_outcome(&text);
    assert_eq!(error, Err("line 502, column 'a': \"oops\" is not a number; correct it or remove the row".to_owned()));
    assert_eq!((values[1].len(), lines.last()), (500, Some(&501)));
    let short = format!("a,b,c,d\r\n\r\n{}1,2\r\n{}", rows(300).replace('\n', "\r\n"), rows(9));
    assert!(same_outcome(&short).3.unwrap_err().starts_with("line 303: "));
    // Ends of lines within a quotation count as lines.
    let quoted = format!("a,b,c,d\n{}1,\"x\n\n\"\"y\n\",2,3\n{}1,2,z,4\n", rows(100), rows(100));
    assert!(same_outcome(&quoted).3.unwrap_err().starts_with("line 206, column 'c': \"z\""));
}

#[test]
fn decimal_marks_of_different_blocks_are_compared() {
    let rows = |first: usize, mark: char| (first..first + 200).map(|row| format!("{row};0{mark}5;1{mark}5;2\n")).collect::<String>();
    let text = format!("a;b;c;d\n{}{}", rows(0, '.'), rows(200, ','));
    let (.., error) = same_outcome(&text);
    let error = error.unwrap_err();
    assert!(error.starts_with("line 202, column 'c': ") && error.contains("line 2"), "{error}");
    let commas = format!("a;b;c;d\n{}", rows(0, ','));
    let (values, _, _, notes) = same_outcome(&commas);
    assert_eq!((values[0][7], notes.unwrap()), (1.5f64.to_bits(), vec!["decimal commas were read as decimal points".to_owned()]));
    // An optional column is refused alone.
    let mixed = format!("a;b;c;d\n{}9;1;1;0.5\n9;1;1;0,5\n{}", rows(0, ','), rows(0, ','));
    let (_, lines, refused, _) = same_outcome(&mixed);
    assert_eq!(lines.len(), 402);
    assert!(refused[2].as_ref().unwrap().starts_with("line 203, column 'd'"), "{refused:?}");
}

#[test]
fn a_last_row_that_is_cut_off_is_left_out() {
    let rows: String = (0..50).map(|row| format!("{row},1,2,3\n")).collect();
    for end in ["50,1", "50,1,-", "50,1,2,x"] {
        let (_, lines, _, notes) = same_outcome(&format!("a,b,c,d\n{rows}{end}"));
        assert_eq!((lines.len(), notes.unwrap()), (50, vec!["the last line, 52, is cut off and left out".to_owned()]), "{end}");
    }
}

#[test]
fn quotations_are_never_cut() {
    let rows: String = (0..40).map(|row| format!("{row},\"two\r\nlines, and \"\"marks\"\"\n\",\"{row}.5\", \"7\" \n")).collect();
    let (values, lines, ..) = same_outcome(&format!("a,b,c,d\n{rows}"));
    assert_eq!((values[0][39], lines[39]), (39.5f64.to_bits(), 2 + 3 * 39));
    // A mark within a cell is one of its text.
    let inches: String = (0..40).map(|row| format!("{row},5\" pipe,1,2\n")).collect();
    assert_eq!(same_outcome(&format!("a,b,c,d\n{inches}")).1.len(), 40);
    assert!(same_outcome("a,b,c,d\n1,2,3,4\n1,\"never closed,3,4\n1,2,3,4\n").3.unwrap_err().starts_with("line 3: "));
}

/// Cells as they occur, and some that do not.
fn cell() -> impl Strategy<Value = String> {
    prop_oneof![
        8 => (-1e4..1e4f64).prop_map(|value| format!("{value:.6}")),
        4 => any::<i16>().prop_map(|value| value.to_string()),
        2 => any::<f64>().prop_map(|value| format!("{value:e}")),
        1 => Just(String::new()),
        1 => Just(" 1.5 ".to_owned()),
        1 => Just("2,5".to_owned()),
        1 => Just("nan".to_owned()),
        1 => Just("+.5".to_owned()),
        1 => "[0-9.,eE+ -]{0,6}",
    ]
}

/// A table: usual rows, with a few of any kind among them.
fn table() -> impl Strategy<Value = String> {
    let row = prop_oneof![
        12 => (-1e3..1e3f64, any::<u8>()).prop_map(|(x, y)| vec![format!("{x:.3}"), y.to_string(), format!("{}", x / 3.0), y.to_string()]),
        2 => prop::collection::vec(cell(), 4),
        1 => prop::collection::vec(cell(), 0..7),
    ];
    let end = prop_oneof![6 => Just("\n"), 1 => Just("\r\n"), 1 => Just("\n\n"), 1 => Just(" \n")];
    let rows = prop::collection::vec((row, end), 1..40);
    (rows, prop_oneof![Just(","), Just(";")], any::<bool>()).prop_map(|(rows, separator, is_cut)| {
        // Names above rows of another length alone are no names of theirs.
        let header = [["a", "b", "c", "d"], ["0.5", "1", "2.5", "1"]].map(|row| row.join(separator) + "\n").concat();
        let mut text = rows.into_iter().fold(header, |text, (cells, end)| text + &cells.join(separator) + end);
        if is_cut {
            text.pop();
        }
        text
    })
}

proptest! {
    #[test]
    fn any_table_is_read_the_same_in_blocks_of_any_size_and_in_either_way(text in table()) {
        let expected = outcome(text.as_bytes(), blocks::BLOCK);
        for size in [1, 13, 100] {
            prop_assert_eq!(&outcome(text.as_bytes(), size), &expected);
        }
        let quoted = with_quotation(&text);
        prop_assert_eq!(without_lengths(outcome(quoted.as_bytes(), 50)), without_lengths(expected));
    }
}

/// The outcome without the numbers of cells in a sentence, since one table has a column more.
fn without_lengths((values, lines, refused, notes): Outcome) -> Outcome {
    let shorten = |error: String| {
        if error.contains(" where the header has ") { error.split(':').next().unwrap_or_default().to_owned() } else { error }
    };
    (values, lines, refused, notes.map_err(shorten))
}

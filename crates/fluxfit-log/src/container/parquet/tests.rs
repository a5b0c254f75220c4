//! The same blocks and errors on one thread and on several, in stretches of any size.

use super::*;
use std::{fs, path::PathBuf};

/// The columns up to the first error, as bits, and that error.
type Outcome = (Vec<Vec<u64>>, Option<String>);

/// Reads all columns; the file may be damaged.
fn outcome(bytes: &[u8], threads: usize, stretch: usize) -> Outcome {
    let read = || {
        let mut parquet = match Parquet::open(RandomAccess::memory(bytes.to_vec())) {
            Ok(parquet) => parquet,
            Err(error) => return (Vec::new(), Some(error.to_string())),
        };
        (parquet.stretch, parquet.fewest) = (stretch, 0);
        let wanted: Vec<usize> = (0..parquet.heads().len()).collect();
        let mut columns = vec![Vec::new(); wanted.len()];
        let read = parquet.read(&wanted, &mut |block| {
            columns.iter_mut().zip(&block).for_each(|(column, values)| column.extend(values.iter().map(|value| value.to_bits())));
            Ok(())
        });
        (columns, read.err().map(|error| error.to_string()))
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(read)
}

fn bytes(name: &str) -> Vec<u8> {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "tests", "containers", name].iter().collect();
    fs::read(path).unwrap()
}

/// Of 3000 rows and of 5000: stretches that end before a row group does, with it, and after it.
const STRETCHES: [usize; 4] = [700, 1500, 3000, STRETCH];

#[test]
fn columns_are_the_same_on_any_number_of_threads() {
    let x = || (0..5000).map(|k| f64::from(k % 771).to_bits());
    let expected = (vec![x().collect::<Vec<_>>(), x().rev().collect()], None);
    for stretch in STRETCHES {
        for threads in [1, 2, 5] {
            assert_eq!(outcome(&bytes("long.parquet"), threads, stretch), expected, "{stretch} rows on {threads} threads");
        }
    }
    // Timestamps count from the first of the column, in whichever row group and stretch.
    for name in ["every.parquet", "int96.parquet", "pandas.parquet", "nulls.parquet"] {
        let whole = outcome(&bytes(name), 1, STRETCH);
        assert_eq!(whole.1, None, "{name}");
        for threads in [1, 3] {
            assert_eq!(outcome(&bytes(name), threads, 7), whole, "{name}");
        }
    }
}

#[test]
fn a_part_has_its_rows_whatever_row_groups_they_lie_in() {
    for name in ["long.parquet", "every.parquet", "int96.parquet", "pandas.parquet", "nulls.parquet"] {
        let open = || Parquet::open(RandomAccess::memory(bytes(name))).unwrap();
        let read = |mut parquet: Parquet, stretch: usize| {
            parquet.stretch = stretch;
            let wanted: Vec<usize> = (0..parquet.heads().len()).collect();
            let mut columns = vec![Vec::new(); wanted.len()];
            let read = parquet.read(&wanted, &mut |block| {
                columns.iter_mut().zip(&block).for_each(|(column, values)| column.extend(values.iter().map(|value| value.to_bits())));
                Ok(())
            });
            read.unwrap();
            columns
        };
        let whole = read(open(), STRETCH);
        let rows = whole[0].len() as u64;
        for part in [0..rows, 0..1, 1..rows, rows / 3..rows / 2 + 1, rows - 1..rows, rows..rows, 1..rows + 9] {
            for stretch in STRETCHES {
                let parquet = open().part(part.clone(), "no such column");
                let kept = |column: &Vec<u64>| column[part.start as usize..part.end.min(rows) as usize].to_vec();
                assert!(parquet.heads().iter().all(|head| head.rows == part.end.min(rows) - part.start));
                assert_eq!(read(parquet, stretch), whole.iter().map(kept).collect::<Vec<_>>(), "{name} {part:?} {stretch}");
            }
        }
        let first = open().heads()[0].name.clone();
        assert_eq!(read(open().part(0..rows, &first), STRETCH), whole[1..], "{name}");
    }
}

#[test]
fn a_damaged_file_gives_the_same_rows_and_the_same_error_on_any_number_of_threads() {
    let whole = bytes("long.parquet");
    let mut errors = 0;
    for at in (4..whole.len() - 600).step_by(whole.len() / 60) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x5a;
        let expected = outcome(&damaged, 1, 700);
        errors += usize::from(expected.1.is_some());
        for threads in [2, 3] {
            assert_eq!(outcome(&damaged, threads, 700), expected, "byte {at} on {threads} threads");
        }
    }
    assert!(errors > 10, "{errors}");
}

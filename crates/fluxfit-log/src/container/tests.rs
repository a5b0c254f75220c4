//! Files of independent writers, made by `tests/containers/make.py`, with values that are known by formula.

use super::{limits::BLOCK, *};
use flate2::read::GzDecoder;
use std::{fs, io::Read, path::PathBuf};

const ROWS: usize = 100;

fn k() -> impl Iterator<Item = f64> {
    (0..ROWS).map(|k| k as f64)
}

fn t() -> Vec<f64> {
    k().map(|k| k * 1e-4).collect()
}

fn id() -> Vec<f64> {
    k().map(|k| k / 7.0 - 2.0).collect()
}

fn iq() -> Vec<f64> {
    k().map(|k| (k + 1.0).sqrt()).collect()
}

/// The values rounded to single precision.
fn single(values: Vec<f64>) -> Vec<f64> {
    values.into_iter().map(|value| f64::from(value as f32)).collect()
}

/// The column of an integer type, by its name.
fn integer(name: &str) -> Vec<f64> {
    let (step, start): (i128, i128) = match name {
        "i8" => (1, -50),
        "u8" => (1, 150),
        "i16" => (300, -15000),
        "u16" => (650, 0),
        "i32" => (20_000_000, -1_000_000_000),
        "u32" => (40_000_000, 0),
        "i64" => (1 << 45, -(1 << 51)),
        "u64" => (1 << 46, 1 << 63),
        _ => panic!("no integer type {name}"),
    };
    (0..ROWS as i128).map(|k| (k * step + start) as f64).collect()
}

fn path(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "containers", name].iter().collect()
}

/// Opens a file from the disk, and checks that it has the same content from memory.
fn open(name: &str) -> Binary {
    let file = RandomAccess::file(fs::File::open(path(name)).unwrap()).unwrap();
    let binary = Binary::open(file).unwrap_or_else(|error| panic!("{name}: {error}")).unwrap();
    let memory = Binary::open(RandomAccess::memory(fs::read(path(name)).unwrap())).unwrap().unwrap();
    assert_eq!(binary.heads(), memory.heads());
    for at in 0..binary.heads().len() {
        assert_eq!(bits(&read(&binary, &[at])[0]), bits(&read(&memory, &[at])[0]), "{name}");
    }
    binary
}

fn refusal(name: &str) -> String {
    match Binary::open(RandomAccess::memory(fs::read(path(name)).unwrap())) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{name} is read"),
    }
}

fn read(binary: &Binary, wanted: &[usize]) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::new(); wanted.len()];
    let mut take = |block: Vec<Vec<f64>>| {
        assert_eq!(block.len(), wanted.len());
        assert!(block.iter().all(|values| values.len() == block[0].len() && values.len() <= BLOCK));
        columns.iter_mut().zip(block).for_each(|(column, values)| column.extend(values));
        Ok(())
    };
    binary.read(wanted, &mut take).unwrap();
    columns
}

fn at(binary: &Binary, name: &str) -> usize {
    let names: Vec<&str> = binary.heads().iter().map(|head| &head.name[..]).collect();
    names.iter().position(|found| *found == name).unwrap_or_else(|| panic!("no {name} in {names:?}"))
}

fn head<'a>(binary: &'a Binary, name: &str) -> &'a ColumnHead {
    &binary.heads()[at(binary, name)]
}

fn names(binary: &Binary) -> Vec<&str> {
    binary.heads().iter().map(|head| &head.name[..]).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Checks the values of columns to the bit, each alone, and all together if they are of one group.
fn holds(binary: &Binary, expected: &[(&str, Vec<f64>)]) {
    for (name, values) in expected {
        let found = read(binary, &[at(binary, name)]).remove(0);
        assert_eq!(bits(&found), bits(values), "{name}: {found:?} instead of {values:?}");
        assert_eq!(head(binary, name).rows, values.len() as u64, "{name}");
    }
    let group = head(binary, expected[0].0).group;
    let (wanted, values): (Vec<usize>, Vec<&Vec<f64>>) =
        expected.iter().filter(|(name, _)| head(binary, name).group == group).map(|(name, values)| (at(binary, name), values)).unzip();
    for (found, values) in read(binary, &wanted).iter().zip(values) {
        assert_eq!(bits(found), bits(values));
    }
}

/// Checks that these are of one group, and the first is its time.
fn share(binary: &Binary, time: &str, others: &[&str]) {
    assert!(head(binary, time).is_time);
    let group = head(binary, time).group;
    let members: Vec<&str> = binary.heads().iter().filter(|head| head.group == group).map(|head| &head.name[..]).collect();
    assert_eq!(members.len(), others.len() + 1, "{members:?}");
    assert!(others.iter().all(|name| members.contains(name) && !head(binary, name).is_time), "{members:?}");
}

fn every() -> Vec<(&'static str, Vec<f64>)> {
    let mut columns = vec![("f32", single(id())), ("f64", id())];
    columns.extend(["i8", "u8", "i16", "u16", "i32", "u32", "i64", "u64"].map(|name| (name, integer(name))));
    columns
}

#[test]
fn text_is_not_a_container() {
    for text in [&b"t,id,iq\n0,1,2\n"[..], b"", b"\x1f\x8b\x08", b"\xff\xfet\0,\0", &[0; 600], &[255; 4096]] {
        assert!(Binary::open(RandomAccess::memory(text.to_vec())).unwrap().is_none());
    }
}

#[test]
fn parquet_of_every_compression_encoding_and_page_version() {
    for name in ["none", "snappy", "gzip", "zstd", "lz4", "pages_v2", "split", "pandas"] {
        let binary = open(&format!("{name}.parquet"));
        holds(&binary, &[("t", t()), ("id", id()), ("iq", iq())]);
        assert_eq!(binary.unreadable(), [] as [&str; 0]);
        assert!(binary.heads().iter().all(|head| !head.is_time && head.unit.is_none()));
    }
    let binary = open("delta.parquet");
    holds(&binary, &[("i32", integer("i32")), ("i64", integer("i64")), ("u32", integer("u32"))]);
}

#[test]
fn parquet_of_every_type() {
    holds(&open("every.parquet"), &every());
}

#[test]
fn parquet_nulls_are_nan() {
    let gaps: Vec<f64> = (0..ROWS).map(|k| if k % 7 == 3 { f64::NAN } else { k as f64 }).collect();
    holds(&open("nulls.parquet"), &[("t", t()), ("gaps", gaps)]);
}

#[test]
fn parquet_instants_count_in_seconds_from_the_first() {
    let instant: Vec<f64> = k().map(|k| 100_001.0 * k / 1e9).collect();
    let millis: Vec<f64> = k().map(|k| k / 1e3).collect();
    let day: Vec<f64> = k().map(|k| k * 1.5).collect();
    let decimal: Vec<f64> = k().map(|k| (k - 50.0) / 8.0).collect();
    let binary = open("others.parquet");
    holds(&binary, &[("instant", instant.clone()), ("millis", millis), ("day", day), ("decimal", decimal)]);
    holds(&binary, &[("pair.d", k().collect()), ("pair.q", k().map(|k| -k).collect())]);
    assert_eq!(head(&binary, "instant").unit.as_deref(), Some("s"));
    assert_eq!(head(&binary, "decimal").unit, None);
    assert_eq!(binary.unreadable(), ["text", "flag"]);
    assert_eq!(binary.lists(), ["list"]);
    holds(&open("int96.parquet"), &[("instant", instant)]);
}

#[test]
fn parquet_refusals() {
    let none = "this Parquet file has no column of two or more numbers; export each quantity of the log as a column of numbers";
    assert_eq!(refusal("text.parquet"), none);
    let binary = open_only("brotli.parquet");
    let error = binary.read(&[0], &mut |_| Ok(())).unwrap_err().to_string();
    assert_eq!(error, "column 't': this Parquet file is compressed by BROTLI, which is not supported; use zstd, gzip, lz4 or snappy");
    let mut bytes = fs::read(path("none.parquet")).unwrap();
    bytes.truncate(bytes.len() - 10);
    let error = Binary::open(RandomAccess::memory(bytes)).err().unwrap().to_string();
    assert_eq!(error, "this Parquet file cannot be read: its end, which says what it holds, is missing or damaged; export it again");
}

fn open_only(name: &str) -> Binary {
    Binary::open(RandomAccess::memory(fs::read(path(name)).unwrap())).unwrap().unwrap()
}

#[test]
fn mat_4_and_5() {
    let log = [("t", t()), ("id", id()), ("iq", iq())];
    let speed: Vec<f64> = k().step_by(2).map(|k| k * 1.5).collect();
    for name in ["v4.mat", "v5.mat"] {
        let binary = open(name);
        holds(&binary, &log);
        holds(&binary, &[("speed", speed.clone())]);
        // The scalar is not a column, and the slower one was sampled at other instants.
        assert!(!names(&binary).contains(&"Rs"));
        assert_ne!(head(&binary, "speed").group, head(&binary, "id").group);
        let both = [at(&binary, "speed"), at(&binary, "id")];
        let error = binary.read(&both, &mut |_| Ok(())).unwrap_err().to_string();
        assert_eq!(error, "these columns were not sampled at the same instants and cannot be read together");
    }
    let binary = open("v5.mat");
    for (name, values) in every().into_iter().filter(|(name, _)| *name != "f64") {
        holds(&binary, &[(&format!("x_{name}"), values)]);
    }
    let binary = open("packed.mat");
    holds(&binary, &every());
    holds(&binary, &[("t", t()), ("lying(1,:)", t()), ("lying(2,:)", id()), ("lying(3,:)", iq())]);
    let matrix = [("data(:,1)", t()), ("data(:,2)", id()), ("data(:,3)", iq()), ("lying(1,:)", t()), ("lying(2,:)", id())];
    holds(&open("matrix.mat"), &matrix);
    holds(&open("small.mat"), &[("two", vec![1.0, 2.0]), ("four", vec![1.0, 2.0, 3.0, 4.0])]);
    holds(&open("big_endian.mat"), &[("iq", integer("i16"))]);
}

#[test]
fn mat_structures() {
    for name in ["struct.mat", "struct_packed.mat"] {
        let binary = open(name);
        assert_eq!(names(&binary), ["log.time", "log.i.d", "log.i.q", "log.slow"]);
        holds(&binary, &[("log.time", t()), ("log.i.d", id()), ("log.i.q", iq())]);
        holds(&binary, &[("log.slow", k().step_by(10).collect())]);
        share(&binary, "log.time", &["log.i.d", "log.i.q"]);
    }
    let binary = open("two_times.mat");
    share(&binary, "id.Time", &["id.Data"]);
    share(&binary, "w.Time", &["w.Data"]);
    holds(&binary, &[("w.Time", t().into_iter().map(|t| t + 3e-5).collect()), ("w.Data", iq())]);
}

#[test]
fn simulink_structures_with_time() {
    let columns = ["out.i_d", "out.signals(2).values", "out.both(:,1)", "out.both(:,2)"];
    for name in ["simulink.mat", "simulink_packed.mat", "v73.mat"] {
        let binary = open(name);
        share(&binary, "out.time", &columns);
        holds(&binary, &[("out.time", t()), (columns[0], id()), (columns[1], iq()), (columns[2], id()), (columns[3], iq())]);
    }
}

#[test]
fn mat_variables_that_are_not_columns() {
    let binary = open("mixed.mat");
    assert_eq!(names(&binary), ["id"]);
    assert_eq!(binary.unreadable(), ["note", "cell", "complex", "sparse", "flag", "cube"]);
    let none = "this MAT file has no column of two or more numbers; export each quantity of the log as a column of numbers";
    assert_eq!(refusal("texts.mat"), none);
    let remedy = "save its numbers with s = struct('Time', run.Time, 'Data', run.Data); save('log.mat', 's')";
    let object = format!("\"run\" is a timeseries object, which only MATLAB can read; {remedy}");
    assert_eq!(refusal("opaque.mat"), object);
    assert_eq!(refusal("v73_object.mat"), object);
    // Beside a vector in one workspace, which may be what is wanted.
    let workspace = [fs::read(path("mixed.mat")).unwrap(), fs::read(path("opaque.mat")).unwrap()[128..].to_vec()].concat();
    let workspace = Binary::open(RandomAccess::memory(workspace)).unwrap().unwrap();
    assert_eq!((names(&workspace), workspace.passed_over().unwrap().to_string()), (vec!["id"], object));
    let mut cut = fs::read(path("v5.mat")).unwrap();
    cut.truncate(2000);
    let error = Binary::open(RandomAccess::memory(cut)).err().unwrap().to_string();
    assert_eq!(error, "this MAT file cannot be read: it ends too early; export it again");
}

#[test]
fn flux_maps_of_syre_are_read() {
    for name in ["syre.mat", "v73.mat"] {
        let binary = open(name);
        for (at, map) in ["Id", "Iq", "Fd", "Fq", "T"].into_iter().enumerate() {
            // Four rows of five elements: the longer side is a column.
            let values: Vec<f64> = (0..5).map(|column| f64::from(3 + column) + at as f64).collect();
            holds(&binary, &[(&format!("motorModel.FluxMap_dq.{map}(4,:)"), values)]);
        }
    }
}

#[test]
fn mat_7_3() {
    let binary = open("v73.mat");
    let columns = [("t", t()), ("id", id()), ("iq", single(iq())), ("lying", iq())];
    holds(&binary, &columns);
    holds(&binary, &[("data(:,1)", t()), ("data(:,2)", id()), ("data(:,3)", iq())]);
    assert_eq!(binary.unreadable(), ["flag"]);
}

#[test]
fn hdf5_by_h5py() {
    let binary = open("plain.h5");
    holds(&binary, &[("t", t()), ("currents.id", id()), ("currents.iq", iq()), ("big", id())]);
    holds(&binary, &[("table(:,1)", t()), ("table(:,2)", id()), ("table(:,3)", iq())]);
    assert_eq!(head(&binary, "t").unit.as_deref(), Some("s"));
    assert_eq!(head(&binary, "currents.id").unit.as_deref(), Some("A"));
    assert_eq!(head(&binary, "big").unit, None);
    assert_eq!(binary.unreadable(), ["flag", "half"]);
    holds(&open("every.h5"), &every());
    let holes: Vec<f64> = (0..ROWS).map(|k| if k / 10 == 2 { 3.0 } else { -1.5 }).collect();
    let binary = open("chunks.h5");
    holds(&binary, &[("table(:,1)", t()), ("table(:,2)", id()), ("table(:,3)", iq()), ("growing", id())]);
    holds(&binary, &[("many", iq()), ("holes", holes), ("unwritten", vec![f64::NAN; ROWS])]);
    holds(&open("latest.h5"), &[("t", t()), ("id", id())]);
}

#[test]
fn hdf5_refusals() {
    let parquet = "or export the log as Parquet";
    let newer = |what: &str| format!("this HDF5 file has {what}, which is not supported; write it with libver='earliest', {parquet}");
    assert_eq!(refusal("latest_chunks.h5"), format!("column 'id': {}", newer("an index of chunks")));
    assert_eq!(refusal("many_tracked.h5"), newer("a group with its links in a heap"));
    let filter = "column 'id': this HDF5 file is compressed by filter 32000, which is not supported; use gzip";
    assert_eq!(refusal("lzf.h5"), format!("{filter}, {parquet}"));
}

/// Each further name would cost a look at the array: without a limit such a file takes time that its size does not show.
#[test]
fn of_3000_links_to_one_array_in_hdf5_the_first_are_listed() {
    let mut bytes = Vec::new();
    GzDecoder::new(&fs::read(path("many_links.h5.gz")).unwrap()[..]).read_to_end(&mut bytes).unwrap();
    let binary = Binary::open(RandomAccess::memory(bytes)).unwrap().unwrap();
    assert!(names(&binary).starts_with(&["n0000", "n0001"]) && binary.heads().len() < 3000, "{}", binary.heads().len());
}

#[test]
fn several_blocks_follow_each_other() {
    let x: Vec<f64> = (0..5000).map(|k| f64::from(k % 771)).collect();
    let y: Vec<f64> = x.iter().rev().copied().collect();
    assert!(x.len() > 2 * BLOCK);
    holds(&open("long.parquet"), &[("x", x.clone()), ("y", y.clone())]);
    holds(&open("long.mat"), &[("x", x.clone()), ("lying(1,:)", x.clone()), ("lying(2,:)", y.clone())]);
    holds(&open("long.h5"), &[("x", x), ("y(:,1)", y.clone()), ("y(:,2)", y)]);
}

#[test]
fn old_mdf_is_refused() {
    assert_eq!(
        refusal("old.mdf"),
        "this is MDF 3 or older, which is not supported; convert it to MDF 4, or export the log as Parquet or CSV"
    );
}

#[cfg(not(feature = "mdf4"))]
#[test]
fn mdf_without_the_feature_is_refused_with_a_remedy() {
    let sentence = "this build of fluxfit does not read MDF 4; build it with the feature mdf4, or export the log as Parquet or CSV";
    assert_eq!(refusal("plain.mf4"), sentence);
}

#[cfg(feature = "mdf4")]
#[test]
fn mdf_4_with_units_conversions_and_masters() {
    for name in ["plain.mf4", "packed.mf4"] {
        let binary = open(name);
        share(&binary, "time", &["id", "iq", "speed"]);
        let speed: Vec<f64> = k().map(|k| k * 3.0 * 0.5 - 10.0).collect();
        holds(&binary, &[("id", id()), ("iq", single(iq())), ("speed", speed), ("time", t())]);
        let theta: Vec<f64> = integer("i16").into_iter().step_by(2).collect();
        holds(&binary, &[("theta", theta)]);
        assert_ne!(head(&binary, "theta").group, head(&binary, "id").group);
        assert_eq!(head(&binary, "theta").unit.as_deref(), Some("deg"));
        assert_eq!(head(&binary, "id").unit.as_deref(), Some("A"));
        assert_eq!(binary.unreadable(), ["state"]);
    }
}

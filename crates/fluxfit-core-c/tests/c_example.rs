//! The C example is compiled against the header and the static library, and run.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit_core_c::{EKF_BYTES, FluxfitEkf, FluxfitRls, RLS_BYTES};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Builds the static library in a folder of its own, so that it is that of these sources.
fn library(package: &Path) -> PathBuf {
    let folder = package.join("../../target/c_example");
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--quiet", "--offline", "--package", "fluxfit-core-c", "--target-dir"]).arg(&folder).current_dir(package);
    let built = build.output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    folder.join("debug/libfluxfit_core_c.a")
}

#[test]
fn the_example_in_c_finds_the_motor() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let library = library(package);
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("identify");
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let compiled = Command::new(&compiler)
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
        .arg(package.join("include"))
        .arg(package.join("examples/identify.c"))
        .arg(&library)
        .args(["-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program)
        .output();
    let compiled = compiled.unwrap_or_else(|error| panic!("this test needs a C compiler; {compiler:?} cannot be run: {error}"));
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let run = Command::new(&program).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
}

#[test]
fn the_header_has_the_sizes_of_the_library() {
    let header = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("include/fluxfit_core.h")).unwrap();
    for (name, bytes) in [("rls", RLS_BYTES), ("ekf", EKF_BYTES)] {
        assert!(header.contains(&format!("typedef struct {{ uint64_t words[{}]; }} fluxfit_{name};", bytes / 8)), "{name}");
    }
    assert_eq!((size_of::<FluxfitRls>(), size_of::<FluxfitEkf>()), (RLS_BYTES, EKF_BYTES));
}

//! Checks a reader, or a whole identification, on one input, and limits its memory.
//!
//! libFuzzer limits the time of a reader; that of an identification is limited here, by the rows of its log. libFuzzer's limit on memory
//! needs a sanitizer, which stable Rust does not have, so an allocator counts here and refuses to exceed a limit that depends on the size
//! of the input. What asks for more is aborted, and libFuzzer keeps the input.

#[path = "../../crates/fluxfit/tests/promises/mod.rs"]
mod promises_of_identifications;
#[path = "../../crates/fluxfit-log/tests/promises/mod.rs"]
mod promises_of_logs;
#[path = "../../crates/fluxfit-setup/tests/promises/mod.rs"]
mod promises_of_setups;

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
    time::Instant,
};

/// Memory that a reader may hold at a time: bytes per byte of its input,
const BYTES_PER_BYTE: usize = 20;

/// plus a constant for names, messages and the tables of a decompressor;
const BYTES_ALWAYS: usize = 1 << 20;

/// plus the decompressed blocks of a log.
const BYTES_OF_BLOCKS: usize = 1 << 24;

/// An identification of up to 257 rows, with what its threads keep.
const BYTES_OF_IDENTIFICATION: usize = 1 << 26;

/// Seconds that an identification may take on a busy machine, in a build with checks: always,
const SECONDS: f64 = 3.0;

/// and for each row. On an idle machine a sound log of 160 rows takes 0.06 s, in a build without checks.
const SECONDS_PER_ROW: f64 = 0.02;

/// Bytes that are held, and the limit.
static HELD: AtomicUsize = AtomicUsize::new(0);
static ALLOWED: AtomicUsize = AtomicUsize::new(usize::MAX);

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The allocator of the system, up to the limit.
struct Counting;

// SAFETY: every pointer comes from the allocator of the system, or is null, which an allocator may return.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if HELD.fetch_add(layout.size(), Relaxed).saturating_add(layout.size()) > ALLOWED.load(Relaxed) {
            HELD.fetch_sub(layout.size(), Relaxed);
            return std::ptr::null_mut();
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Checks the reader with this name on these bytes.
pub fn hold(name: &str, bytes: &[u8]) {
    let readers = promises_of_logs::READERS.into_iter().chain(promises_of_setups::READERS);
    let mut readers = readers.chain(promises_of_identifications::READERS);
    let Some((_, promise)) = readers.find(|(reader, _)| *reader == name) else { return };
    let constant = match name {
        "log" => BYTES_OF_BLOCKS,
        "identification" => BYTES_OF_IDENTIFICATION,
        _ => BYTES_ALWAYS,
    };
    ALLOWED.store(HELD.load(Relaxed) + constant + BYTES_PER_BYTE * bytes.len(), Relaxed);
    let begun = Instant::now();
    promise(bytes);
    let seconds = begun.elapsed().as_secs_f64();
    ALLOWED.store(usize::MAX, Relaxed);
    if name == "identification" {
        let rows = promises_of_identifications::rows(bytes);
        assert!(seconds <= SECONDS + SECONDS_PER_ROW * rows as f64, "{rows} rows took {seconds:.1} s");
    }
}

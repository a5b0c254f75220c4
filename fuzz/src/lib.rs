//! Checks a reader on one input, and limits its memory.
//!
//! libFuzzer limits the time. Its limit on memory needs a sanitizer, which stable Rust does not have, so an allocator counts here and
//! refuses to exceed a limit that depends on the size of the input. A reader that asks for more is aborted, and libFuzzer keeps the
//! input.

#[path = "../../crates/fluxfit-log/tests/promises/mod.rs"]
mod promises_of_logs;
#[path = "../../crates/fluxfit-setup/tests/promises/mod.rs"]
mod promises_of_setups;

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

/// Memory that a reader may hold at a time: bytes per byte of its input,
const BYTES_PER_BYTE: usize = 20;

/// plus a constant for names, messages and the tables of a decompressor;
const BYTES_ALWAYS: usize = 1 << 20;

/// plus the decompressed blocks of a log.
const BYTES_OF_BLOCKS: usize = 1 << 24;

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
    let mut readers = promises_of_logs::READERS.into_iter().chain(promises_of_setups::READERS);
    let Some((_, promise)) = readers.find(|(reader, _)| *reader == name) else { return };
    let constant = if name == "log" { BYTES_OF_BLOCKS } else { BYTES_ALWAYS };
    ALLOWED.store(HELD.load(Relaxed) + constant + BYTES_PER_BYTE * bytes.len(), Relaxed);
    promise(bytes);
    ALLOWED.store(usize::MAX, Relaxed);
}

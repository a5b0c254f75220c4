//! Holds a reader to its promises, and to its memory.
//!
//! libFuzzer itself watches the time. Its limit on memory needs a sanitizer, which stable Rust has not; so an allocator counts, and
//! gives no more than the input allows. A reader that asks for more ends there, and libFuzzer keeps the input.

#[path = "../../crates/fluxfit-log/tests/promises/mod.rs"]
mod promises_of_logs;
#[path = "../../crates/fluxfit-setup/tests/promises/mod.rs"]
mod promises_of_setups;

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

/// Bytes of memory that a reader may hold at a time, for each byte of its input,
const BYTES_PER_BYTE: usize = 20;

/// and besides, whatever the input: names, sentences, tables of a decompressor;
const BYTES_BESIDES: usize = 1 << 20;

/// of a log, which may be packed, the blocks that it is unpacked into.
const BYTES_OF_BLOCKS: usize = 1 << 24;

/// Bytes that are held, and how many may be.
static HELD: AtomicUsize = AtomicUsize::new(0);
static ALLOWED: AtomicUsize = AtomicUsize::new(usize::MAX);

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The system's allocator, as long as no more is held than is allowed.
struct Counting;

// SAFETY: what is given is what the system gives, or null, which an allocator may always give.
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

/// Holds the reader called `name` to its promises on these bytes.
pub fn hold(name: &str, bytes: &[u8]) {
    let mut readers = promises_of_logs::READERS.into_iter().chain(promises_of_setups::READERS);
    let Some((_, promise)) = readers.find(|(reader, _)| *reader == name) else { return };
    let besides = if name == "log" { BYTES_OF_BLOCKS } else { BYTES_BESIDES };
    ALLOWED.store(HELD.load(Relaxed) + besides + BYTES_PER_BYTE * bytes.len(), Relaxed);
    promise(bytes);
    ALLOWED.store(usize::MAX, Relaxed);
}

//! Limits on what a container can hold.

/// Maximum number of rows of a block. Ten columns of them are 160 KiB, which fit into the cache together with the pages that they come
/// from: with 64 Ki rows, pages with Snappy were read at half the rate.
pub(super) const BLOCK: usize = 1 << 11;

/// Maximum number of columns of a file. A log has at most some hundred; a flux map of 256 x 256 points has some thousand.
pub(crate) const MOST_COLUMNS: usize = 20_000;

/// Maximum number of bytes, or rows, that a file of this length can hold: deflate compresses 1032 bytes into one at best. Without this
/// bound a small file that repeats one value could keep a reader busy for days.
pub(super) fn most_held(length: u64) -> u64 {
    length.saturating_mul(1032).saturating_add(1 << 20)
}

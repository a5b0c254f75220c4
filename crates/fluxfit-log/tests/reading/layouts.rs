//! The page about logs has every container and the table of layouts.

use fluxfit_log::{CONTAINERS, LAYOUTS, Layout};
use std::{fs, path::Path};

#[test]
fn the_page_has_the_same_table() {
    let row = |layout: &Layout| {
        let refused = if layout.is_log() { "" } else { "**refused**: " };
        format!("| {} | {refused}{} | {} |\n", layout.name, layout.headers(), layout.remark)
    };
    let table: String = LAYOUTS.iter().map(row).collect();
    // A package of this crate alone has no pages.
    let Ok(page) = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/log.md")) else { return };
    assert!(page.contains(&table), "docs/log.md should have these rows:\n{table}");
}

#[test]
fn the_page_has_a_row_for_every_container() {
    let Ok(page) = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/log.md")) else { return };
    for name in CONTAINERS.iter().flat_map(|container| container.names) {
        assert!(page.contains(&format!("\n| {name} | ")), "docs/log.md should have a row for {name}");
    }
}

//! Remedies of the judged situations, carried out on the simulator. `./check --thorough` runs it.

use fluxfit_studies::remedies::{
    judged,
    situation::BICYCLE,
    survey,
    table::{Kept, list, table},
};

/// Least part of the promised widths that must be reached within a factor of 1.5.
const LEAST_KEPT: f64 = 0.9;

#[test]
fn remedies_keep_their_promise() {
    let carried = survey(&judged(&BICYCLE));
    println!("{}{}", table(&carried), list(&carried));
    let Kept { promised, kept, .. } = Kept::of(&carried);
    assert!(promised >= 3, "{promised} remedies promise a width");
    assert!(kept as f64 >= LEAST_KEPT * promised as f64, "{kept} of {promised} promises are kept");
}

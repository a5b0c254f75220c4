//! The tables `[motor]` and `[mechanics]`.

use crate::{flux_map::read_flux_map, problem::Problem};
use fluxfit::motor::PARAMETERS;
use fluxfit_drive::{
    Error,
    scenario::{Harmonics, Magnetics, Mechanics, SimulatedMotor},
    schedule::Profile,
};
use fluxfit_files::{FileError, Problem as FileProblem, toml_table::Table};
use fluxfit_units::Dimension;
use std::path::Path;

/// Keys of `[motor]`.
pub(super) const MOTOR_KEYS: &[&str] = &["rs", "rs_drift", "ld", "lq", "psi_f", "flux_map", "flux_harmonics", "pole_pairs"];

pub(super) fn motor(table: &Table<'_>, changes: [Profile; PARAMETERS], folder: &Path) -> Result<SimulatedMotor, FileError> {
    Ok(SimulatedMotor {
        rs: table.needed("rs", Dimension::Resistance)?,
        rs_drift: table.quantity("rs_drift", Dimension::Ratio)?.unwrap_or(0.0),
        changes,
        magnetics: magnetics(table, folder)?,
        harmonics: harmonics(table)?,
        pole_pairs: match table.get("pole_pairs") {
            Some(entry) => entry.whole(1, "a whole number above zero")?,
            None => return Err(table.missing("pole_pairs", "4")),
        },
    })
}

fn magnetics(table: &Table<'_>, folder: &Path) -> Result<Magnetics, FileError> {
    let Some(entry) = table.get("flux_map") else {
        let (ld, lq) = (table.needed("ld", Dimension::Inductance)?, table.needed("lq", Dimension::Inductance)?);
        return Ok(Magnetics::Constant { ld, lq, psi_f: table.needed("psi_f", Dimension::FluxLinkage)? });
    };
    if let Some(constant) = ["ld", "lq", "psi_f"].into_iter().find_map(|key| table.get(key)) {
        return Err(constant.refuse(Problem::Excluded { by: "flux_map" }));
    }
    read_flux_map(&folder.join(entry.text()?)).map(Magnetics::Map)
}

/// Amplitudes of the 5th and the 7th harmonic.
fn harmonics(table: &Table<'_>) -> Result<Harmonics, FileError> {
    let Some(entry) = table.get("flux_harmonics") else { return Ok(Harmonics::default()) };
    let wanted = || FileProblem::Value { wanted: "a list for the 5th and the 7th harmonic, as in [0.006, 0.003]".to_owned() };
    match entry.items().as_deref() {
        Some([fifth, seventh]) => Ok(Harmonics { fifth: fifth.quantity(Dimension::Ratio)?, seventh: seventh.quantity(Dimension::Ratio)? }),
        _ => Err(entry.refuse(wanted())),
    }
}

/// Keys of `[mechanics]`.
pub(super) const MECHANICS_KEYS: &[&str] = &["kind", "inertia", "friction"];

pub(super) fn mechanics(table: &Table<'_>) -> Result<Mechanics, FileError> {
    let dyno = table.get("kind").map_or(Ok(false), |kind| kind.word(&[("free", false), ("dyno", true)]))?;
    if dyno {
        for key in ["mechanics.inertia", "mechanics.friction"] {
            if let Some(entry) = key.split_once('.').and_then(|(_, key)| table.get(key)) {
                let remedy = "a dynamometer holds its speed at any load: leave it out";
                let incompatible = Error::Incompatible { key, with: "mechanics.kind = \"free\"", remedy };
                return Err(FileError::from(Problem::Drive(incompatible)).at_line(entry.line()));
            }
        }
        return Ok(Mechanics::Dyno);
    }
    Ok(Mechanics::Free {
        inertia: table.needed("inertia", Dimension::Inertia)?,
        friction: table.quantity("friction", Dimension::Friction)?.unwrap_or(0.0),
    })
}

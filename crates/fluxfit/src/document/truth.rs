//! The document beside a simulated log: schema `fluxfit.truth/1`.

use serde::Serialize;

/// The name of this document.
pub const TRUTH: &str = "fluxfit.truth/1";

/// The document that `fluxfit simulate` writes beside a log: the true parameters, and the scenario with which the log can be made again.
/// Fields are added in later versions, never renamed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = TRUTH))]
pub struct TruthDocument<Scenario> {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = TRUTH)))]
    pub schema: &'static str,
    /// Stator resistance, ohm.
    pub rs: f64,
    /// Inductance along d, H; null for a motor that is a flux map.
    pub ld: Option<f64>,
    /// Inductance along q, H; null for a motor that is a flux map.
    pub lq: Option<f64>,
    /// Magnet flux linkage, Wb, peak per phase; null for a motor that is a flux map.
    pub psi_f: Option<f64>,
    /// Pole pairs.
    pub pole_pairs: u32,
    /// Which draw of the random numbers of the scenario's seed was taken.
    pub draw: u64,
    /// The scenario, as its TOML file has it.
    #[cfg_attr(feature = "schema", schemars(schema_with = "any_object"))]
    pub scenario: Scenario,
}

#[cfg(feature = "schema")]
fn any_object(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({ "type": "object" })
}

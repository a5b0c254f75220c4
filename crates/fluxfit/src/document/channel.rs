//! Values under the names of the two channels that a model predicts.

use serde::Serialize;

/// One value for each channel: the currents of the output error, or the voltages of the steady model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "PerChannelOf_{T}"))]
#[serde(untagged)]
#[non_exhaustive]
pub enum PerChannel<T> {
    /// Of the output error.
    Currents {
        /// Current along d; its unit is A.
        id: T,
        /// Current along q; its unit is A.
        iq: T,
    },
    /// Of the steady model.
    Voltages {
        /// Voltage along d; its unit is V.
        ud: T,
        /// Voltage along q; its unit is V.
        uq: T,
    },
}

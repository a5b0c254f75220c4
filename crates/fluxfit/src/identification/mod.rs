//! Identification: from a log to four parameters, each with an interval and a verdict.
//!
//! ```text
//! prepare   rows → stretches that may be fitted; which model suits the log
//! fit       steady operating points | simulated currents → motor, uncertainty
//! judge     uncertainty → verdict and reason
//! explain   reason → remedy; warnings; comparison with a nameplate
//! ```
//!
//! Each stage imports only earlier ones; [`solve`](mod@solve) is the path through them. The whole answer, with everything that hangs
//! on it, is [`identify`](crate::identify).

pub(crate) mod explain;
pub(crate) mod fit;
pub(crate) mod judge;
pub(crate) mod nameplate;
pub(crate) mod prepare;
pub(crate) mod progress;
pub(crate) mod request;
pub(crate) mod solve;

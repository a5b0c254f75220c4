//! What an identification says of a motor that saturates: a measured flux map, driven by a simulated inverter.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit::{
    frames::Dq,
    identify::{Identification, Known, Settings, identify, model::Model, saturation::Saturation, verdict::Verdict},
    log::Log,
    motor::{Motor, Parameter},
};
use fluxfit_drive::{
    FluxMap, Scenario,
    scenario::{Inductance, Mechanics},
    simulate,
};
use std::path::Path;

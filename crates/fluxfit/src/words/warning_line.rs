//! Warnings in a few words, for a line of their own above an answer. The whole sentence is the warning's
//! [`Display`](std::fmt::Display).

use super::digits::{from_to, list, percent, three_digits};
use crate::{identification::explain::warning::Warning, motor::Parameter};

impl Warning {
    /// What is wrong, in at most some fifty letters.
    pub fn in_short(&self) -> String {
        match self {
            Self::NoRedundancy => "as many equations as unknowns: errors stay unseen".to_owned(),
            Self::Misfit { ratio, .. } => {
                format!("operating points contradict each other, {} x their noise", three_digits(*ratio))
            }
            Self::DeadTime { voltage } => format!("dead time or device drops take about {} V", three_digits(*voltage)),
            Self::NoCurrent { rows, of } => format!("{rows} of {of} rows carry no current: not used"),
            Self::NoCurrentInWindows { windows } => format!("{windows} of the windows carry no current"),
            Self::ShortStretches { times } => {
                format!("{} short steady stretch{} left out", times.len(), if times.len() == 1 { "" } else { "es" })
            }
            Self::CoarseSampling => "rows are far apart: taken as decimated".to_owned(),
            Self::FrameLag { seconds, .. } => {
                let way = if *seconds > 0.0 { "behind" } else { "ahead of" };
                format!("the voltages lie {} us {way} the rotor's frame: fitted beside the motor", three_digits(1e6 * seconds.abs()))
            }
            Self::OpenLoop { times } => {
                format!("open loop in {} stretch{}: not used for more than R_s", times.len(), if times.len() == 1 { "" } else { "es" })
            }
            Self::Warming { change, rs, .. } => {
                format!("R_s {} by {} while the log is taken", if *change > 0.0 { "grows" } else { "falls" }, percent((change / rs).abs()))
            }
            Self::ProcessNoise => "voltages that are not logged disturb the motor".to_owned(),
            Self::Angle => "theta_e does not turn with omega_e: not used".to_owned(),
            Self::Saturation { lq } => match lq {
                Some(ends) => format!("apparent L_q goes {}", from_to(ends.each_ref().map(|end| end.inductance))),
                None => "no constant inductances explain the log".to_owned(),
            },
            Self::LowSpeed { own, lost, .. } => {
                format!("slow: the drive loses {} V beside the motor's {} V", three_digits(*lost), three_digits(*own))
            }
            Self::VoltageLimit { rows, of } => format!("{rows} of {of} rows have |u| above u_dc / sqrt 3"),
            Self::OutsideBox { parameters } => {
                let symbols: Vec<&str> = parameters.iter().copied().map(Parameter::symbol).collect();
                format!("{} outside the swarm's search box; the answer stands", list(&symbols))
            }
            Self::Convention(convention) => match convention.deviating().next() {
                Some(off) => format!("{} is {} times the nameplate's", off.parameter.symbol(), three_digits(off.ratio)),
                None => "u_q and speed have opposite signs".to_owned(),
            },
            Self::PhaseMargin { bandwidth, margin, .. } => format!("{bandwidth:.0} Hz leaves a phase margin of {margin:.0} degrees"),
            Self::PriorContradicted { parameter, .. } => format!("the log contradicts the prior of {}", parameter.symbol()),
            Self::Interrupted { iterations, limit } => format!("the swarm made {iterations} of {limit} iterations"),
        }
    }
}

//! The channels of a log: their canonical names, and what drives and tools call them.

use crate::problem::Problem;
use fluxfit_files::FileError;
use fluxfit_units::{Dimension, unit::Unit, wording::nearest};

/// A quantity that a column of a log can hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Channel {
    T,
    Ud,
    Uq,
    Id,
    Iq,
    OmegaE,
    ThetaE,
    UDc,
    /// Of the winding.
    Temperature,
    IA,
    IB,
    IC,
    UA,
    UB,
    UC,
    /// Of the stator's frame, whose alpha axis lies on phase a.
    IAlpha,
    IBeta,
    UAlpha,
    UBeta,
    /// Number of the run that a row belongs to; time is not continuous where it changes.
    Run,
}

impl Channel {
    /// The channels that a log must have, in the order of [`fluxfit::log::Columns`].
    pub(crate) const NEEDED: [Self; 6] = [Self::T, Self::Ud, Self::Uq, Self::Id, Self::Iq, Self::OmegaE];

    /// The optional channels.
    pub(crate) const OPTIONAL: [Self; 3] = [Self::ThetaE, Self::UDc, Self::Temperature];

    /// Quantities of the phases and of the stator's frame, from which dq quantities are computed with the angle.
    pub(crate) const PHASES: [Self; 10] =
        [Self::UA, Self::UB, Self::UC, Self::IA, Self::IB, Self::IC, Self::UAlpha, Self::UBeta, Self::IAlpha, Self::IBeta];

    /// All channels.
    pub(crate) fn all() -> impl Iterator<Item = Self> + Clone {
        Self::NEEDED.into_iter().chain(Self::OPTIONAL).chain(Self::PHASES).chain([Self::Run])
    }

    /// The canonical name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::T => "t",
            Self::Ud => "ud",
            Self::Uq => "uq",
            Self::Id => "id",
            Self::Iq => "iq",
            Self::OmegaE => "omega_e",
            Self::ThetaE => "theta_e",
            Self::UDc => "u_dc",
            Self::Temperature => "temperature",
            Self::IA => "ia",
            Self::IB => "ib",
            Self::IC => "ic",
            Self::UA => "ua",
            Self::UB => "ub",
            Self::UC => "uc",
            Self::UAlpha => "ualpha",
            Self::UBeta => "ubeta",
            Self::IAlpha => "ialpha",
            Self::IBeta => "ibeta",
            Self::Run => "run",
        }
    }

    /// Its SI unit; of temperatures degC.
    pub(crate) fn unit(self) -> Unit {
        match self {
            Self::T => Unit::Second,
            Self::Ud | Self::Uq | Self::UDc | Self::UA | Self::UB | Self::UC | Self::UAlpha | Self::UBeta => Unit::Volt,
            Self::Id | Self::Iq | Self::IA | Self::IB | Self::IC | Self::IAlpha | Self::IBeta => Unit::Ampere,
            Self::Run => Unit::Number,
            Self::OmegaE => Unit::RadianPerSecond,
            Self::ThetaE => Unit::Radian,
            Self::Temperature => Unit::Celsius,
        }
    }

    /// Whether it changes so slowly that it may be held between its values, however rare they are.
    pub(crate) fn is_slow(self) -> bool {
        self == Self::Temperature
    }

    pub(crate) fn dimension(self) -> Dimension {
        self.unit().dimension()
    }

    /// The units that it can have, SI first.
    pub(crate) fn units(self) -> impl Iterator<Item = Unit> {
        let is_of_dq = matches!(self, Self::Ud | Self::Uq | Self::Id | Self::Iq);
        Unit::of(self.dimension()).filter(move |unit| is_of_dq || !unit.is_rms())
    }

    /// What drives and tools call it, in lower case without punctuation: to propose a column, never to choose one.
    pub(crate) fn spellings(self) -> &'static [&'static str] {
        match self {
            Self::T => &["t", "time", "timestamp", "mstoday", "seconds"],
            Self::Ud => &["ud", "vd", "daxisvoltage", "voltaged", "voltagedaxis", "usd", "vsd", "uds", "vds"],
            Self::Uq => &["uq", "vq", "qaxisvoltage", "voltageq", "voltageqaxis", "usq", "vsq", "uqs", "vqs"],
            Self::Id => &["id", "daxiscurrent", "currentd", "currentdaxis", "isd", "ids"],
            Self::Iq => &["iq", "qaxiscurrent", "currentq", "currentqaxis", "isq", "iqs"],
            Self::OmegaE => &[
                "omega", "omegae", "omegael", "omegam", "speed", "velocity", "velo", "rpm", "erpm", "wel", "welec", "fe", "fel", "felec",
                "nm", "nmech", "nmot",
            ],
            Self::ThetaE => &["theta", "thetae", "thetael", "thetam", "angle", "electricalangle", "rotorangle"],
            Self::UDc => &["udc", "vdc", "dcvoltage", "dclinkvoltage", "busvoltage", "vbus", "inputvoltage"],
            Self::Temperature => &["temperature", "windingtemperature", "motortemperature", "tempmotor", "motortemp"],
            Self::IA => &["ia", "iu", "i1", "currenta", "phaseacurrent"],
            Self::IB => &["ib", "iv", "i2", "currentb", "phasebcurrent"],
            Self::IC => &["ic", "iw", "i3", "currentc", "phaseccurrent"],
            Self::UA => &["ua", "uu", "va", "vu", "v1", "u1", "voltagea", "phaseavoltage"],
            Self::UB => &["ub", "uv", "vb", "vv", "v2", "u2", "voltageb", "phasebvoltage"],
            Self::UC => &["uc", "uw", "vc", "vw", "v3", "u3", "voltagec", "phasecvoltage"],
            Self::UAlpha => &["ualpha", "valpha", "voltagealpha"],
            Self::UBeta => &["ubeta", "vbeta", "voltagebeta"],
            Self::IAlpha => &["ialpha", "currentalpha"],
            Self::IBeta => &["ibeta", "currentbeta"],
            Self::Run => &["run", "profileid"],
        }
    }

    /// From its canonical name, or `omega` and `theta`.
    pub(crate) fn from_name(name: &str) -> Result<Self, FileError> {
        match name {
            "omega" => return Ok(Self::OmegaE),
            "theta" => return Ok(Self::ThetaE),
            _ => {}
        }
        let known = Self::all();
        known.clone().find(|channel| channel.name() == name).ok_or_else(|| {
            let by_spelling = known.clone().find(|channel| channel.spellings().contains(&name)).map(Self::name);
            let nearest = by_spelling.or_else(|| nearest(name, known.clone().map(Self::name)));
            let needed = Self::NEEDED.map(Self::name).to_vec();
            let optional = known.map(Self::name).filter(|name| !needed.contains(name)).collect();
            Problem::Channel { name: name.to_owned(), needed, optional, nearest }.into()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_name_gets_a_proposal() {
        assert_eq!(Channel::from_name("omega"), Ok(Channel::OmegaE));
        assert_eq!(Channel::from_name("theta"), Ok(Channel::ThetaE));
        assert!(Channel::from_name("vdc").unwrap_err().to_string().ends_with("; did you mean u_dc?"));
        let message = |name| Channel::from_name(name).unwrap_err().to_string();
        assert_eq!(
            message("speed"),
            "\"speed\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e, and optionally theta_e, u_dc, temperature, ua, ub, uc, ia, ib, ic, ualpha, ubeta, ialpha, ibeta and run; did you mean omega_e?"
        );
        assert_eq!(
            message("time"),
            "\"time\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e, and optionally theta_e, u_dc, temperature, ua, ub, uc, ia, ib, ic, ualpha, ubeta, ialpha, ibeta and run; did you mean t?"
        );
        assert_eq!(
            message("flux_density"),
            "\"flux_density\" is not a channel of a log; the channels are t, ud, uq, id, iq and omega_e, and optionally theta_e, u_dc, temperature, ua, ub, uc, ia, ib, ic, ualpha, ubeta, ialpha, ibeta and run"
        );
    }

    #[test]
    fn the_order_is_that_of_the_log() {
        let names = fluxfit::log::Columns::default().named().map(|(name, _)| name);
        assert_eq!(names, Channel::NEEDED.map(Channel::name));
        let all = || Some(Vec::new());
        let columns = fluxfit::log::Columns { theta_e: all(), u_dc: all(), temperature: all(), ..Default::default() };
        assert_eq!(columns.optional().map(|(name, _)| name).collect::<Vec<_>>(), Channel::OPTIONAL.map(Channel::name));
    }
}

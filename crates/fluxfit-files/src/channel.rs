//! What a log's columns are called: here, and elsewhere.

use crate::{
    error::{FileError, Problem},
    quantity::Dimension,
    unit::Unit,
    wording::nearest,
};

/// A column of a log.
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
}

impl Channel {
    /// Those that a log must have, in the order of `fluxfit::log::Columns`.
    pub(crate) const NEEDED: [Self; 6] = [Self::T, Self::Ud, Self::Uq, Self::Id, Self::Iq, Self::OmegaE];

    /// Those that a log may have besides.
    pub(crate) const OPTIONAL: [Self; 2] = [Self::ThetaE, Self::UDc];

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
        }
    }

    /// Its SI unit.
    pub(crate) fn unit(self) -> Unit {
        match self {
            Self::T => Unit::Second,
            Self::Ud | Self::Uq | Self::UDc => Unit::Volt,
            Self::Id | Self::Iq => Unit::Ampere,
            Self::OmegaE => Unit::RadianPerSecond,
            Self::ThetaE => Unit::Radian,
        }
    }

    pub(crate) fn dimension(self) -> Dimension {
        self.unit().dimension()
    }

    /// What drives and their tools call it, in lower case without punctuation: only to propose a column, never to take one.
    pub(crate) fn spellings(self) -> &'static [&'static str] {
        match self {
            Self::T => &["t", "time", "timestamp", "mstoday", "seconds"],
            Self::Ud => &["ud", "vd", "daxisvoltage", "voltaged", "voltagedaxis"],
            Self::Uq => &["uq", "vq", "qaxisvoltage", "voltageq", "voltageqaxis"],
            Self::Id => &["id", "daxiscurrent", "currentd", "currentdaxis"],
            Self::Iq => &["iq", "qaxiscurrent", "currentq", "currentqaxis"],
            Self::OmegaE => &["omega", "omegae", "omegael", "omegam", "speed", "velocity", "rpm", "erpm"],
            Self::ThetaE => &["theta", "thetae", "thetael", "thetam", "angle", "electricalangle", "rotorangle"],
            Self::UDc => &["udc", "vdc", "dcvoltage", "dclinkvoltage", "busvoltage", "vbus", "inputvoltage"],
        }
    }

    /// From its canonical name, or `omega` and `theta`.
    pub(crate) fn from_name(name: &str) -> Result<Self, FileError> {
        match name {
            "omega" => return Ok(Self::OmegaE),
            "theta" => return Ok(Self::ThetaE),
            _ => {}
        }
        let known = Self::NEEDED.into_iter().chain(Self::OPTIONAL);
        known.clone().find(|channel| channel.name() == name).ok_or_else(|| {
            let by_spelling = known.clone().find(|channel| channel.spellings().contains(&name)).map(Self::name);
            let nearest = by_spelling.or_else(|| nearest(name, known.map(Self::name)));
            let (needed, optional) = (Self::NEEDED.map(Self::name).to_vec(), Self::OPTIONAL.map(Self::name).to_vec());
            Problem::Channel { name: name.to_owned(), needed, optional, nearest }.into()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        assert_eq!(Channel::from_name("omega"), Ok(Channel::OmegaE));
        assert_eq!(Channel::from_name("theta"), Ok(Channel::ThetaE));
        assert!(Channel::from_name("vdc").unwrap_err().to_string().ends_with("; did you mean u_dc?"));
        let refusal = |name| Channel::from_name(name).unwrap_err().to_string();
        assert_eq!(
            refusal("speed"),
            "\"speed\" is no column of a log; the columns are t, ud, uq, id, iq and omega_e, and optionally theta_e and u_dc; did you mean omega_e?"
        );
        assert_eq!(
            refusal("time"),
            "\"time\" is no column of a log; the columns are t, ud, uq, id, iq and omega_e, and optionally theta_e and u_dc; did you mean t?"
        );
        assert_eq!(
            refusal("flux_density"),
            "\"flux_density\" is no column of a log; the columns are t, ud, uq, id, iq and omega_e, and optionally theta_e and u_dc"
        );
    }

    #[test]
    fn the_order_is_that_of_the_library() {
        let names = fluxfit::log::Columns::default().named().map(|(name, _)| name);
        assert_eq!(names, Channel::NEEDED.map(Channel::name));
        let both = fluxfit::log::Columns { theta_e: Some(Vec::new()), u_dc: Some(Vec::new()), ..Default::default() };
        assert_eq!(both.optional().map(|(name, _)| name).collect::<Vec<_>>(), Channel::OPTIONAL.map(Channel::name));
    }
}

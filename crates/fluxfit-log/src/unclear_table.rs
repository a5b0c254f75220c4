//! What has to be stated of a table of a test bench before it can be read, all of it at once.

use fluxfit_files::Advice;
use fluxfit_units::wording::{columns, list, quote};
use std::fmt;

/// What is unclear of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct UnclearTable {
    /// Quantities that several columns could be.
    pub(crate) several: Vec<(&'static str, Vec<String>)>,
    /// An electrical speed beside a torque of the shaft.
    pub(crate) electrical: Option<String>,
    /// A voltage of a direct current that does not say between which points it was measured.
    pub(crate) direct_voltage: Option<String>,
    /// A current that does not say what of a wave it is, and the torque beside it.
    pub(crate) current_and_torque: Option<[String; 2]>,
    /// Columns that only resemble i_q, beside a torque.
    pub(crate) axis_currents: Option<AxisCurrents>,
    /// A speed of which nothing states the unit.
    pub(crate) speed: Option<String>,
    /// The speed of shorted terminals, to be mapped beside both their current and their torque.
    pub(crate) of_shorted: Option<String>,
    /// Quantities and columns that are called by their symbols alone.
    pub(crate) symbols: Vec<(&'static str, String)>,
}

/// Columns beside a torque that may be the currents of the rotor's frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxisCurrents {
    /// Those that may be i_q.
    pub(crate) q: Vec<String>,
    /// The one that is i_d, if the first of these is i_q.
    pub(crate) d: Option<String>,
    pub(crate) torque: String,
}

impl AxisCurrents {
    /// What to map if the first one is i_q.
    fn map(&self) -> Vec<(&'static str, &String)> {
        let pairs = [self.q.first().map(|q| ("iq", q)), self.d.as_ref().map(|d| ("id", d)), Some(("torque", &self.torque))];
        pairs.into_iter().flatten().collect()
    }
}

impl fmt::Display for AxisCurrents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (beside, d) = (quote(&self.torque), self.d.as_ref().map(|d| quote(d)));
        match (self.q.as_slice(), d) {
            ([one], None) => write!(f, "by name, {} may be i_q beside the torque {beside}; map it as iq if it is", quote(one)),
            ([one], Some(d)) => {
                write!(f, "by name, {} and {d} may be i_q and i_d beside the torque {beside}; map them if they are", quote(one))
            }
            (all, _) => {
                write!(
                    f,
                    "the columns {} could each be i_q beside the torque {beside}; map that of the motor as iq, and its i_d as id",
                    columns(all)
                )
            }
        }
    }
}

impl UnclearTable {
    /// Whether nothing has to be stated.
    pub(crate) fn is_clear(&self) -> bool {
        Self { of_shorted: None, ..self.clone() } == Self::default()
    }

    /// What the user can state: one of these, if there are several.
    pub(crate) fn advice(&self) -> Vec<Advice> {
        let first = |(quantity, headers): &(&'static str, Vec<String>)| Some((*quantity, headers.first()?.clone()));
        let is_several = |quantity: &str| self.several.iter().any(|(several, _)| *several == quantity);
        let of_shorted = self.of_shorted.iter().filter(|_| is_several("current") && is_several("torque") && !is_several("speed"));
        let of_shorted = of_shorted.map(|header| ("speed", header.clone()));
        let known: Vec<(&'static str, String)> =
            self.symbols.iter().cloned().chain(of_shorted).chain(self.several.iter().filter_map(first)).collect();
        let with = |pairs: &[(&'static str, &String)]| {
            let others = known.iter().filter(|(quantity, _)| !pairs.iter().any(|(name, _)| covers(name, quantity)));
            let pairs = others.cloned().chain(pairs.iter().map(|(name, header)| (*name, (*header).clone())));
            pairs.map(|(name, header)| (name, Some(header))).collect::<Vec<_>>()
        };
        let maps = match (&self.direct_voltage, &self.current_and_torque) {
            _ if self.axis_currents.is_some() => self.axis_currents.iter().map(|axes| with(&axes.map())).collect(),
            (Some(voltage), _) => vec![with(&[("voltage_ll", voltage)]), with(&[("voltage_phase", voltage)])],
            (_, Some([current, torque])) => {
                vec![with(&[("iq", current), ("torque", torque)]), with(&[("current", current), ("torque", torque)])]
            }
            _ => vec![with(&[])],
        };
        let has_speed = self.speed.is_some() || self.symbols.iter().any(|(quantity, _)| *quantity == "speed");
        let unit = has_speed.then_some(Advice::StateUnit { channel: "speed", unit: None });
        let pole_pairs = self.electrical.as_ref().map(|_| Advice::StatePolePairs);
        let together = |pairs: Vec<(&'static str, Option<String>)>| {
            let map = (!pairs.is_empty()).then_some(Advice::MapColumns(pairs));
            let all: Vec<Advice> = map.into_iter().chain(unit.clone()).chain(pole_pairs.clone()).collect();
            match all.as_slice() {
                [] => None,
                [one] => Some(one.clone()),
                _ => Some(Advice::Together(all)),
            }
        };
        maps.into_iter().filter_map(together).collect()
    }
}

/// Whether a column that is mapped so is one of a quantity.
fn covers(name: &str, quantity: &str) -> bool {
    name.starts_with(quantity) || ["iq", "id"].contains(&name) && quantity == "current"
}

impl fmt::Display for UnclearTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let could_be = |(quantity, headers): &(&str, Vec<String>)| format!("the columns {} could each be the {quantity}", columns(headers));
        let could_be: Vec<String> = self.several.iter().map(could_be).collect();
        let map = match could_be.as_slice() {
            [] => None,
            [one] => Some(format!("{one}; map the one that is, or leave it alone in the table")),
            all => Some(format!("{}; map the one of each that is, or leave it alone in the table", list(all))),
        };
        let of_shaft = self.electrical.as_ref().map(|header| {
            format!("the speed {} is electrical, and the torque is that of the shaft; state the number of pole pairs", quote(header))
        });
        let points = self.direct_voltage.as_ref().map(|header| {
            format!(
                "the name of the voltage {} does not say between which points it was measured; put 'll' (two terminals in series) or 'phase' (a terminal and the star point) into it, or map it as voltage_ll or voltage_phase",
                quote(header)
            )
        });
        let wave = self.current_and_torque.as_ref().map(|[header, _]| {
            format!(
                "the name of the current {} beside a torque does not say what it is; map it as iq if it is that (the peak value of a phase), as current if it is the rms value of a phase and i_d is zero; a current of the supply tells nothing",
                quote(header)
            )
        });
        let axes = self.axis_currents.as_ref().map(ToString::to_string);
        let speed = self.speed.as_ref().map(|header| {
            format!("nothing states the unit of the speed {}; state it, or put it into the name, as in 'speed [rpm]'", quote(header))
        });
        let symbols = (!self.symbols.is_empty()).then(|| {
            let (quantities, headers): (Vec<&str>, Vec<String>) = self.symbols.iter().cloned().unzip();
            format!(
                "the columns {} may be the {} of a table of a test bench, and state no units; write these into the names, as in 'n [rpm]', 'U_ll [V]', 'I [Arms]' and 'M [Nm]', or map the columns, which are in V, A (rms values) and N m then",
                columns(&headers), list(&quantities)
            )
        });
        f.write_str(&[symbols, map, of_shaft, points, wave, axes, speed].into_iter().flatten().collect::<Vec<_>>().join("; and "))
    }
}

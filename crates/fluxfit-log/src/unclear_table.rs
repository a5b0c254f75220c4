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
    /// A current beside a torque that does not say what of a wave it is.
    pub(crate) current: Option<String>,
}

impl UnclearTable {
    pub(crate) fn advice(&self) -> Vec<Advice> {
        let first = |(quantity, headers): &(&'static str, Vec<String>)| (*quantity, headers.first().cloned());
        let map = (!self.several.is_empty()).then(|| Advice::MapColumns(self.several.iter().map(first).collect()));
        let all: Vec<Advice> = map.into_iter().chain(self.electrical.as_ref().map(|_| Advice::StatePolePairs)).collect();
        if all.len() > 1 { vec![Advice::Together(all)] } else { all }
    }
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
                "the name of the voltage {} does not say between which points it was measured; put 'll' (two terminals in series) or 'phase' (a terminal and the star point) into it",
                quote(header)
            )
        });
        let wave = self.current.as_ref().map(|header| {
            format!(
                "the name of the current {} beside a torque does not say what it is; call it 'Iq' (the peak value of a phase), 'phase rms' or 'phase peak', with its unit; a current of the supply tells nothing",
                quote(header)
            )
        });
        f.write_str(&[map, of_shaft, points, wave].into_iter().flatten().collect::<Vec<_>>().join("; and "))
    }
}

//! The confusions of unit and convention that have a name, in one table.
//!
//! A log whose voltages, currents and speeds are `k_u`, `k_i`, `k_omega` times what they should be fits a motor just as well:
//!
//! ```text
//! R_s k_u / k_i,   L k_u / (k_i k_omega),   psi_f k_u / k_omega
//! ```
//!
//! A nameplate value that is `n` times what it should be makes the log's seem `1 / n` of it.

use super::super::super::nameplate::Nameplate;
use crate::motor::{PARAMETERS, Parameter};
use std::f64::consts::{SQRT_2, TAU};

/// sqrt 3: line to line over phase.
const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// sqrt (3/2): power-invariant over amplitude-invariant; line to line RMS over phase peak.
const SQRT_3_2: f64 = 1.224_744_871_391_589;

/// r/min in one rad/s.
const RPM: f64 = 60.0 / TAU;

/// One named confusion, in one of its two directions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pattern {
    /// Name in files.
    pub name: &'static str,
    /// What would have happened.
    pub sentence: &'static str,
    /// The number behind it, as people write it; the same in both directions.
    pub number: &'static str,
    /// How many times too large it makes the log's voltages, currents and speeds; none if the nameplate is what differs.
    pub columns: Option<[f64; 3]>,
    /// How many times the nameplate's it makes the parameters that the log tells, in the order of [`Parameter::ALL`].
    pub factors: [f64; PARAMETERS],
}

/// What differs from the convention, as powers of the pattern's number.
#[derive(Clone, Copy)]
enum Place {
    /// Voltages, currents and speeds of the log.
    Columns([i32; 3]),
    /// Values of the nameplate: R_s, L_d, L_q, psi_f.
    Nameplate([i32; PARAMETERS]),
}

/// A line of the table: both directions of a confusion.
struct Confusion {
    name: &'static str,
    number: (&'static str, f64),
    place: Place,
    sentence: &'static str,
    /// Name and sentence with the inverse of the number.
    inverse: (&'static str, &'static str),
}

const VOLTAGES: [i32; 3] = [1, 0, 0];
const CURRENTS: [i32; 3] = [0, 1, 0];
const VOLTAGES_AND_CURRENTS: [i32; 3] = [1, 1, 0];
const SPEED: [i32; 3] = [0, 0, 1];
const RESISTANCE: [i32; PARAMETERS] = [1, 0, 0, 0];
const INDUCTANCES: [i32; PARAMETERS] = [0, 1, 1, 0];
const FLUX: [i32; PARAMETERS] = [0, 0, 0, 1];

/// The table. Of two lines that explain a log alike the upper is named first: the log's before the nameplate's, and the common
/// before the rare. `pole_pairs` is not a number here: lines with it follow in [`of_pole_pairs`].
const TABLE: [Confusion; 24] = [
    Confusion {
        name: "line-to-line-voltage",
        number: ("sqrt 3", SQRT_3),
        place: Place::Columns(VOLTAGES),
        sentence: "the voltages are line to line, not per phase",
        inverse: ("voltage-over-sqrt-3", "the voltages were divided by sqrt 3 although they were per phase"),
    },
    Confusion {
        name: "rms",
        number: ("sqrt 2", 1.0 / SQRT_2),
        place: Place::Columns(VOLTAGES_AND_CURRENTS),
        sentence: "voltages and currents are RMS, not peak",
        inverse: ("rms-twice", "voltages and currents were multiplied by sqrt 2 although they were peak"),
    },
    Confusion {
        name: "rms-voltage",
        number: ("sqrt 2", 1.0 / SQRT_2),
        place: Place::Columns(VOLTAGES),
        sentence: "the voltages are RMS, not peak",
        inverse: ("rms-voltage-twice", "the voltages were multiplied by sqrt 2 although they were peak"),
    },
    Confusion {
        name: "rms-current",
        number: ("sqrt 2", 1.0 / SQRT_2),
        place: Place::Columns(CURRENTS),
        sentence: "the currents are RMS, not peak",
        inverse: ("rms-current-twice", "the currents were multiplied by sqrt 2 although they were peak"),
    },
    Confusion {
        name: "power-invariant-park",
        number: ("sqrt(3/2)", SQRT_3_2),
        place: Place::Columns(VOLTAGES_AND_CURRENTS),
        sentence: "the Park transform is power-invariant, not amplitude-invariant",
        inverse: ("park-twice", "voltages and currents were divided by sqrt(3/2) although the Park transform was amplitude-invariant"),
    },
    Confusion {
        name: "line-to-line-rms-voltage",
        number: ("sqrt(3/2)", SQRT_3_2),
        place: Place::Columns(VOLTAGES),
        sentence: "the voltages are line to line and RMS, not per phase and peak",
        inverse: ("voltage-over-sqrt-3-2", "the voltages were divided by sqrt(3/2) although they were per phase and peak"),
    },
    Confusion {
        name: "rpm",
        number: ("60/2 pi", RPM),
        place: Place::Columns(SPEED),
        sentence: "the speed is in electrical r/min, not in rad/s",
        inverse: ("rpm-twice", "the speed was converted from r/min although it was in rad/s"),
    },
    Confusion {
        name: "hertz",
        number: ("2 pi", 1.0 / TAU),
        place: Place::Columns(SPEED),
        sentence: "the speed is in electrical Hz, not in rad/s",
        inverse: ("hertz-twice", "the speed was converted from Hz although it was in rad/s"),
    },
    Confusion {
        name: "millivolt",
        number: ("1000", 1e3),
        place: Place::Columns(VOLTAGES),
        sentence: "the voltages are in mV, not in V",
        inverse: ("millivolt-twice", "the voltages were converted from mV although they were in V"),
    },
    Confusion {
        name: "milliampere",
        number: ("1000", 1e3),
        place: Place::Columns(CURRENTS),
        sentence: "the currents are in mA, not in A",
        inverse: ("milliampere-twice", "the currents were converted from mA although they were in A"),
    },
    Confusion {
        name: "millivolt-and-milliampere",
        number: ("1000", 1e3),
        place: Place::Columns(VOLTAGES_AND_CURRENTS),
        sentence: "voltages and currents are in mV and mA, not in V and A",
        inverse: ("millivolt-and-milliampere-twice", "voltages and currents were converted from mV and mA although they were in V and A"),
    },
    // The currents of a delta's phases are 1/sqrt 3 of the lines', their voltages sqrt 3 of the star's.
    Confusion {
        name: "delta-log",
        number: ("3, of psi_f sqrt 3", SQRT_3),
        place: Place::Columns([1, -1, 0]),
        sentence: "the log is of a delta winding's own phases, the nameplate of the star that is equal to it",
        inverse: ("delta-nameplate", "the nameplate is of a delta winding's own phases, the log of the star that is equal to it"),
    },
    Confusion {
        name: "terminal-to-terminal",
        number: ("2", 2.0),
        place: Place::Nameplate([1, 1, 1, 0]),
        sentence: "the nameplate's resistance and inductances are between two terminals, not per phase",
        inverse: ("terminal-to-terminal-twice", "the nameplate's resistance and inductances were halved although they were per phase"),
    },
    Confusion {
        name: "terminal-resistance",
        number: ("2", 2.0),
        place: Place::Nameplate(RESISTANCE),
        sentence: "the nameplate's resistance is between two terminals, not per phase",
        inverse: ("terminal-resistance-twice", "the nameplate's resistance was halved although it was per phase"),
    },
    Confusion {
        name: "terminal-inductance",
        number: ("2", 2.0),
        place: Place::Nameplate(INDUCTANCES),
        sentence: "the nameplate's inductances are between two terminals, not per phase",
        inverse: ("terminal-inductance-twice", "the nameplate's inductances were halved although they were per phase"),
    },
    Confusion {
        name: "line-to-line-flux",
        number: ("sqrt 3", SQRT_3),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is of the line to line voltage",
        inverse: ("flux-over-sqrt-3", "the nameplate's flux was divided by sqrt 3 although it was per phase"),
    },
    Confusion {
        name: "rms-flux",
        number: ("sqrt 2", 1.0 / SQRT_2),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is of the RMS voltage, not of the peak",
        inverse: ("rms-flux-twice", "the nameplate's flux was multiplied by sqrt 2 although it was of the peak voltage"),
    },
    Confusion {
        name: "line-to-line-rms-flux",
        number: ("sqrt(3/2)", SQRT_3_2),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is of the line to line RMS voltage",
        inverse: ("flux-over-sqrt-3-2", "the nameplate's flux was divided by sqrt(3/2) although it was per phase and of the peak"),
    },
    Confusion {
        name: "volt-per-hertz",
        number: ("2 pi", TAU),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is in V/Hz, not in Wb",
        inverse: ("volt-per-hertz-twice", "the nameplate's flux was converted from V/Hz although it was in Wb"),
    },
    Confusion {
        name: "line-to-line-volt-per-hertz",
        number: ("2 pi sqrt 3", TAU * SQRT_3),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is in V/Hz of the line to line voltage, not in Wb",
        inverse: ("line-to-line-volt-per-hertz-twice", "the nameplate's flux was converted from line to line V/Hz although it was in Wb"),
    },
    Confusion {
        name: "line-to-line-rms-volt-per-hertz",
        number: ("2 pi sqrt(3/2)", TAU * SQRT_3_2),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is in V/Hz of the line to line RMS voltage, not in Wb",
        inverse: (
            "line-to-line-rms-volt-per-hertz-twice",
            "the nameplate's flux was converted from line to line RMS V/Hz although it was in Wb",
        ),
    },
    Confusion {
        name: "milliohm",
        number: ("1000", 1e3),
        place: Place::Nameplate(RESISTANCE),
        sentence: "the nameplate's resistance is in mohm, not in ohm",
        inverse: ("milliohm-twice", "the nameplate's resistance was converted from mohm although it was in ohm"),
    },
    Confusion {
        name: "millihenry",
        number: ("1000", 1e3),
        place: Place::Nameplate(INDUCTANCES),
        sentence: "the nameplate's inductances are in mH, not in H",
        inverse: ("millihenry-twice", "the nameplate's inductances are in uH where mH was meant, or were converted from mH twice"),
    },
    Confusion {
        name: "milliweber",
        number: ("1000", 1e3),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is in mWb, not in Wb",
        inverse: ("milliweber-twice", "the nameplate's flux was converted from mWb although it was in Wb"),
    },
];

/// The lines whose number holds the pole pairs; none if there is one pole pair, where both speeds are the same.
fn of_pole_pairs(pole_pairs: u32) -> Vec<Confusion> {
    let p = f64::from(pole_pairs);
    let mut table = vec![Confusion {
        name: "mechanical-rpm",
        number: ("60/2 pi p", RPM / p),
        place: Place::Columns(SPEED),
        sentence: "the speed is in mechanical r/min, not in electrical rad/s",
        inverse: ("mechanical-rpm-twice", "the speed was converted from mechanical r/min although it was in electrical rad/s"),
    }];
    if pole_pairs > 1 {
        table.insert(
            0,
            Confusion {
                name: "mechanical-speed",
                number: ("p", 1.0 / p),
                place: Place::Columns(SPEED),
                sentence: "the speed is mechanical, not electrical",
                inverse: ("mechanical-speed-twice", "the speed was multiplied by the pole pairs although it was electrical"),
            },
        );
        table.push(Confusion {
            name: "flux-of-mechanical-speed",
            number: ("p", p),
            place: Place::Nameplate(FLUX),
            sentence: "the nameplate's flux is of the mechanical speed, not of the electrical",
            inverse: (
                "flux-of-mechanical-speed-twice",
                "the nameplate's flux was divided by the pole pairs although it was of the electrical speed",
            ),
        });
    }
    table.push(Confusion {
        name: "volt-per-rpm",
        number: ("2 pi p/60", p / RPM),
        place: Place::Nameplate(FLUX),
        sentence: "the nameplate's flux is in V per mechanical r/min, not in Wb",
        inverse: ("volt-per-rpm-twice", "the nameplate's flux was converted from V per mechanical r/min although it was in Wb"),
    });
    table
}

/// Every pattern that this nameplate admits, the likely first.
pub(super) fn all(nameplate: &Nameplate) -> Vec<Pattern> {
    let pole_pairs = nameplate.pole_pairs.map(of_pole_pairs).unwrap_or_default();
    let mut patterns: Vec<Pattern> = TABLE.iter().chain(&pole_pairs).flat_map(Confusion::directions).collect();
    if let (Some(ld), Some(lq)) = (nameplate.value(Parameter::Ld), nameplate.value(Parameter::Lq)) {
        patterns.push(Pattern {
            name: "swapped-axes",
            sentence: "L_d and L_q have changed places: d lies on the other axis, in the log or on the nameplate",
            number: "L_q against L_d",
            columns: None,
            factors: [1.0, lq / ld, ld / lq, 1.0],
        });
    }
    // A log's conventions are in doubt before a nameplate's.
    patterns.sort_by_key(|pattern| pattern.columns.is_none());
    patterns
}

impl Confusion {
    fn directions(&self) -> [Pattern; 2] {
        let (text, number) = self.number;
        let pattern = |name, sentence, number: f64| {
            let (columns, factors) = match self.place {
                Place::Columns(powers) => {
                    let columns = powers.map(|power| number.powi(power));
                    (Some(columns), of_columns(columns))
                }
                Place::Nameplate(powers) => (None, powers.map(|power| number.powi(-power))),
            };
            Pattern { name, sentence, number: text, columns, factors }
        };
        [pattern(self.name, self.sentence, number), pattern(self.inverse.0, self.inverse.1, 1.0 / number)]
    }
}

/// What factors of a log's voltages, currents and speeds do to its parameters.
fn of_columns([u, i, omega]: [f64; 3]) -> [f64; PARAMETERS] {
    [u / i, u / (i * omega), u / (i * omega), u / omega]
}

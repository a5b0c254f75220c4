//! The scaling of the dq currents, where the file has the currents of the phases too: the square of the dq vector is 2/3 of the sum of
//! their squares at every instant and at any angle. RMS values and power-invariant transforms are smaller and larger than that.

use super::{alias, chosen::ChosenColumn, mapping::Park, names::automatic, proposal::stated_unit, rms};
use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel,
    problem::Problem,
};
use Channel::{IA, IB, IC, Id, Iq};
use fluxfit_files::FileError;
use fluxfit_units::Unit;

/// Fewest rows that are compared.
const FEWEST_ROWS: usize = 20;

/// Correlation of the squares above which they tell a scaling: phases of other instants, or filtered ones, are left alone.
const SAME: f64 = 0.999;

/// Difference of a ratio from that of a scaling, at most: the gains of current sensors differ by less.
const LIKE: f64 = 0.03;

/// Mean of a phase current over its root mean square below which the phases alternate: at rest they do not, nor do root mean squares.
const ALTERNATES: f64 = 0.5;

/// The currents of the phases beside those of the dq frame, and what was seen of both.
pub(super) struct Scaling {
    phases: Vec<ChosenPhase>,
    /// Where id and iq are among the columns that are read.
    dq: [usize; 2],
    rows: usize,
    /// Sums of the squared dq vector times itself, times that of the phases, and of that times itself.
    sums: [f64; 3],
    /// Sums of ia and of its square.
    of_a: [f64; 2],
}

struct ChosenPhase {
    index: usize,
    header: String,
    unit: Unit,
}

impl Scaling {
    /// Finds the phase currents among the columns of the group that are not read otherwise.
    pub(super) fn of(heads: &[ColumnHead], columns: &[ChosenColumn]) -> Option<Self> {
        let place = |channel: Channel| columns.iter().position(|column| column.channel == channel);
        let dq = [place(Id)?, place(Iq)?];
        let phase = |channel: Channel| {
            let index = automatic(channel, heads).ok().flatten().or_else(|| alias::find(channel, heads))?;
            let head = &heads[index];
            let is_free = head.group == heads[columns[dq[0]].index].group && columns.iter().all(|column| column.index != index);
            let unit = stated_unit(channel, head).unwrap_or(channel.unit());
            (is_free && !rms::is_rms(head)).then(|| ChosenPhase { index, header: head.name.clone(), unit })
        };
        let phases: Vec<ChosenPhase> = [phase(IA)?, phase(IB)?].into_iter().chain(phase(IC)).collect();
        Some(Self { phases, dq, rows: 0, sums: [0.0; 3], of_a: [0.0; 2] })
    }

    /// The phase currents as the table reads them.
    pub(super) fn wanted(&self) -> impl Iterator<Item = WantedColumn> {
        let wanted = |phase: &ChosenPhase| WantedColumn {
            index: phase.index,
            header: phase.header.clone(),
            is_time: false,
            is_optional: true,
            instants: None,
        };
        self.phases.iter().map(wanted)
    }

    /// Compares the rows of a block: the columns that are read, in SI units, and the phase currents as they are in the file.
    pub(super) fn compare(&mut self, columns: &[Vec<f64>], phases: &mut [Vec<f64>]) {
        for (phase, values) in self.phases.iter().zip(phases.iter_mut()) {
            phase.unit.to_si(values, 1);
        }
        let [on_d, on_q] = self.dq.map(|place| &columns[place]);
        for (row, (d, q)) in on_d.iter().zip(on_q).enumerate() {
            let of = |phase: usize| phases.get(phase).and_then(|values| values.get(row)).copied();
            let (Some(a), Some(b)) = (of(0), of(1)) else { continue };
            let c = of(2).unwrap_or(-a - b);
            let (of_dq, of_phases) = (d * d + q * q, 2.0 / 3.0 * (a * a + b * b + c * c));
            if of_dq.is_finite() && of_phases.is_finite() {
                self.rows += 1;
                self.sums[0] += of_dq * of_dq;
                self.sums[1] += of_dq * of_phases;
                self.sums[2] += of_phases * of_phases;
                self.of_a[0] += a;
                self.of_a[1] += a * a;
            }
        }
    }

    /// Refuses dq currents that are scaled otherwise than to the peak value of the phases.
    pub(super) fn refuse(&self) -> Result<(), FileError> {
        let [of_dq, both, of_phases] = self.sums;
        let is_same = self.rows >= FEWEST_ROWS && both > SAME * (of_dq * of_phases).sqrt();
        let alternates = self.of_a[0].abs() < ALTERNATES * (self.rows as f64 * self.of_a[1]).sqrt();
        // That of the vectors, not of their squares.
        let ratio = (both / of_phases).sqrt();
        let like = |park: &Park| (ratio * park.factor() - 1.0).abs() < LIKE;
        match [Park::Rms, Park::Power].into_iter().find(like).filter(|_| is_same && alternates) {
            Some(park) => {
                let headers = self.phases.iter().map(|phase| phase.header.clone()).collect();
                Err(Problem::DqScaling { ratio, headers, park: park.name(), factor: park.factor() }.into())
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::reading::{LogOptions, mapping::Mapping, parse_log};

    /// The error, or nothing, of a log whose dq currents are `scale` times the amplitude of its phase currents, which are read `late` rad
    /// late.
    fn error(scale: f64, late: f64, header: &str, options: &LogOptions) -> String {
        let row = |k: usize| {
            let (angle, [d, q]) = (0.1 * k as f64, [-1.0, 3.0 + 2.0 * (k / 50) as f64]);
            let phase = |shift: f64| {
                let angle = angle - late - shift;
                d * angle.cos() - q * angle.sin()
            };
            let third = std::f64::consts::TAU / 3.0;
            let [a, b, c] = [phase(0.0), phase(third), phase(2.0 * third)];
            format!("{},1,20,{},{},400,{a},{b},{c}\n", 1e-4 * k as f64, scale * d, scale * q)
        };
        let text = format!("{header}\n{}", (0..200).map(row).collect::<String>());
        parse_log("a.csv", text.as_bytes(), options).map_or_else(|error| error.to_string(), |_| String::new())
    }

    const HEADER: &str = "t,ud,uq,id,iq,omega_e,ia,ib,ic";

    #[test]
    fn currents_of_the_phases_tell_the_scaling_of_those_of_the_rotor() {
        let none = LogOptions::default();
        let rms = error(0.5_f64.sqrt(), 0.0, HEADER, &none);
        assert_eq!(
            rms,
            "a.csv: id and iq are 0.707 times the amplitude of 'ia', 'ib' and 'ic', as of rms values; write park = \"rms\" into a mapping \
             file, which converts ud and uq too; if these are peak values, write scale = 1.414 for id and iq instead"
        );
        let power = error(1.5_f64.sqrt(), 0.0, HEADER, &none);
        assert!(power.contains("a power-invariant transform; write park = \"power-invariant\""), "{power}");
        let without_third = "t,ud,uq,id,iq,omega_e,ia,ib,x";
        assert!(error(1.5_f64.sqrt(), 0.0, without_third, &none).contains("amplitude of 'ia' and 'ib', as"));
        // What the user does about it.
        let options = LogOptions { mapping: Mapping::parse("m.toml", b"park = \"rms\"\n").unwrap(), ..LogOptions::default() };
        assert_eq!(error(0.5_f64.sqrt(), 0.0, HEADER, &options), "");
    }

    #[test]
    fn phases_that_agree_or_tell_nothing_are_passed_over() {
        let none = LogOptions::default();
        // At any angle; with the gains of sensors; of another kind; under other names.
        for (scale, late, header) in [(1.0, 0.0, HEADER), (1.0, 1.0, HEADER), (1.02, 0.0, HEADER), (0.9, 0.0, HEADER)] {
            assert_eq!(error(scale, late, header, &none), "", "{scale} {late}");
        }
        for header in ["t,ud,uq,id,iq,omega_e,ia_rms,ib_rms,ic_rms", "t,ud,uq,id,iq,omega_e,ia_ref,ib_ref,ic_ref"] {
            assert_eq!(error(0.5_f64.sqrt(), 0.0, header, &none), "", "{header}");
        }
    }
}

//! The scaling of the dq currents, or of those of the stator's frame, where the file has the phases too: the square of the vector is 2/3 of
//! the sum of their squares at every instant and at any angle. RMS values and power-invariant transforms are smaller and larger than that.

use super::{alias, chosen::ChosenColumn, mapping::Park, names::automatic, options::ResolvedOptions, proposal::stated_unit, rms};
use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel,
    problem::Problem,
};
use Channel::{IA, IAlpha, IB, IBeta, IC, Id, Iq, UAlpha};
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

/// The currents of the phases and the current vector, dq or in the stator's frame, and what was seen of both.
pub(super) struct Scaling {
    /// Columns that are read for this alone.
    beside: Vec<Beside>,
    vector: [(Channel, Source); 2],
    phases: Vec<(String, Source)>,
    rows: usize,
    /// Sums of the squared vector times itself, times that of the phases, and of that times itself.
    sums: [f64; 3],
    /// Sums of ia and of its square.
    of_a: [f64; 2],
}

/// Where the values of a quantity are.
#[derive(Clone, Copy)]
enum Source {
    /// Among the columns of the log.
    Read(usize),
    /// Among those that are read beside them.
    Beside(usize),
}

struct Beside {
    index: usize,
    header: String,
    unit: Unit,
    factor: f64,
}

impl Scaling {
    /// Finds both among the columns of the group.
    pub(super) fn of(heads: &[ColumnHead], columns: &[ChosenColumn], options: &ResolvedOptions) -> Option<Self> {
        let group = heads[columns.first()?.index].group;
        let mut beside: Vec<Beside> = Vec::new();
        let mut source = |channel: Channel| {
            if let Some(place) = columns.iter().position(|column| column.channel == channel) {
                return Some((columns[place].header.clone(), Source::Read(place)));
            }
            let index = automatic(channel, heads).ok().flatten().or_else(|| alias::find(channel, heads))?;
            let head = &heads[index];
            let is_free = head.group == group && columns.iter().all(|column| column.index != index) && !rms::is_rms(head);
            let (header, unit) = (head.name.clone(), stated_unit(channel, head).unwrap_or(channel.unit()));
            is_free.then(|| {
                beside.push(Beside { index, header: header.clone(), unit, factor: options.factor(channel) });
                (header, Source::Beside(beside.len() - 1))
            })
        };
        let mut pair = |[one, other]: [Channel; 2]| Some([(one, source(one)?.1), (other, source(other)?.1)]);
        let is_read = |channel: Channel| columns.iter().any(|column| column.channel == channel);
        // Where the phases are read and nothing of the vector, its scaling does not matter; what the user states counts.
        let vector = if is_read(Id) { [Id, Iq] } else { [IAlpha, IBeta] };
        let matters = is_read(Id) || is_read(IAlpha) || is_read(UAlpha);
        if !matters || options.unit(vector[0]).is_some() {
            return None;
        }
        let vector = pair(vector)?;
        let phases: Vec<(String, Source)> = [source(IA)?, source(IB)?].into_iter().chain(source(IC)).collect();
        Some(Self { beside, vector, phases, rows: 0, sums: [0.0; 3], of_a: [0.0; 2] })
    }

    /// The columns beside those of the log, as the table reads them.
    pub(super) fn wanted(&self) -> impl Iterator<Item = WantedColumn> {
        let wanted = |column: &Beside| WantedColumn {
            index: column.index,
            header: column.header.clone(),
            is_time: false,
            is_optional: true,
            instants: None,
        };
        self.beside.iter().map(wanted)
    }

    /// Compares the rows of a block: the columns that are read, in SI units, and those beside them as they are in the file.
    pub(super) fn compare(&mut self, columns: &[Vec<f64>], beside: &mut [Vec<f64>]) {
        for (column, values) in self.beside.iter().zip(beside.iter_mut()) {
            column.unit.to_si(values, 1);
            values.iter_mut().for_each(|value| *value *= column.factor);
        }
        let values = |source: Source| match source {
            Source::Read(place) => columns[place].as_slice(),
            Source::Beside(place) => beside.get(place).map_or(&[][..], Vec::as_slice),
        };
        let [on_d, on_q] = self.vector.map(|(_, source)| values(source));
        let phases: Vec<&[f64]> = self.phases.iter().map(|(_, source)| values(*source)).collect();
        for (row, (d, q)) in on_d.iter().zip(on_q).enumerate() {
            let of = |phase: usize| phases.get(phase).and_then(|values| values.get(row)).copied();
            let (Some(a), Some(b)) = (of(0), of(1)) else { continue };
            let c = of(2).unwrap_or(-a - b);
            let (of_vector, of_phases) = (d * d + q * q, 2.0 / 3.0 * (a * a + b * b + c * c));
            if of_vector.is_finite() && of_phases.is_finite() {
                self.rows += 1;
                self.sums[0] += of_vector * of_vector;
                self.sums[1] += of_vector * of_phases;
                self.sums[2] += of_phases * of_phases;
                self.of_a[0] += a;
                self.of_a[1] += a * a;
            }
        }
    }

    /// Refuses a vector that is scaled otherwise than to the peak value of the phases.
    pub(super) fn refuse(&self) -> Result<(), FileError> {
        let [of_vector, both, of_phases] = self.sums;
        let is_same = self.rows >= FEWEST_ROWS && both > SAME * (of_vector * of_phases).sqrt();
        let alternates = self.of_a[0].abs() < ALTERNATES * (self.rows as f64 * self.of_a[1]).sqrt();
        // That of the vectors, not of their squares.
        let ratio = (both / of_phases).sqrt();
        let like = |park: &Park| (ratio * park.factor() - 1.0).abs() < LIKE;
        match [Park::Rms, Park::Power].into_iter().find(like).filter(|_| is_same && alternates) {
            Some(park) => {
                let headers = self.phases.iter().map(|(header, _)| header.clone()).collect();
                let currents = self.vector.map(|(channel, _)| channel.name());
                Err(Problem::Scaling { currents, ratio, headers, park: park.name(), factor: park.factor() }.into())
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
             file, which converts the voltages too; if the voltages are peak values, write scale = 1.414 for the currents alone"
        );
        let power = error(1.5_f64.sqrt(), 0.0, HEADER, &none);
        assert!(power.contains("a power-invariant transform; write park = \"power-invariant\""), "{power}");
        let without_third = "t,ud,uq,id,iq,omega_e,ia,ib,x";
        assert!(error(1.5_f64.sqrt(), 0.0, without_third, &none).contains("amplitude of 'ia' and 'ib', as"));
        // Without an angle, which is computed from both.
        let of_phases = "t,ua,uc,id,iq,omega_e,ia,ib,ub";
        assert!(error(1.5_f64.sqrt(), 0.0, of_phases, &none).contains("as of a power-invariant transform"));
        // What the user does about it.
        let options = LogOptions { mapping: Mapping::parse("m.toml", b"park = \"rms\"\n").unwrap(), ..LogOptions::default() };
        assert_eq!(error(0.5_f64.sqrt(), 0.0, HEADER, &options), "");
    }

    /// The voltages of the stator's frame are those of the transform, too.
    #[test]
    fn a_vector_of_the_stator_is_compared_with_its_phases() {
        let row = |k: usize| {
            let (angle, third) = (0.1 * k as f64, std::f64::consts::TAU / 3.0);
            let [a, b] = [angle.cos(), (angle - third).cos()];
            let [alpha, beta] = [angle.cos(), angle.sin()].map(|of_vector| 1.5_f64.sqrt() * of_vector);
            format!("{},{alpha},{beta},{alpha},{beta},{angle},{a},{b},{}\n", 1e-4 * k as f64, -a - b)
        };
        let text = format!("t,u_alpha,u_beta,i_alpha,i_beta,theta_e,ia,ib,ic\n{}", (0..200).map(row).collect::<String>());
        let refused = parse_log("a.csv", text.as_bytes(), &LogOptions::default()).unwrap_err().to_string();
        assert!(refused.contains("ialpha and ibeta are 1.22 times the amplitude of 'ia', 'ib' and 'ic'"), "{refused}");
        let mapping = Mapping::parse("m.toml", b"park = \"power-invariant\"\n").unwrap();
        assert!(parse_log("a.csv", text.as_bytes(), &LogOptions { mapping, ..LogOptions::default() }).is_ok());
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

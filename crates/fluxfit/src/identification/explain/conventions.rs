//! Conventions: whether what the log tells agrees with the nameplate, and if not, which confusion of units would explain it.
//!
//! A log in which all voltages, currents or speeds are a constant factor too large fits as well as the right one: no log shows
//! it. A nameplate does. The ratios of what the log tells to what the nameplate says are compared with a [table of named
//! confusions](patterns), one or two of them at once. What fits best is a candidate, never a proof: the answer is not changed.
//!
//! Where the log tells no flux (it may be too short for that, or without any steady stretch), its rows still do, given the
//! nameplate's resistance and inductances, as long as those take only a small part of the voltage:
//!
//! ```text
//! apparent flux = (u - R i - j omega L i) / omega
//! ```
//!
//! Negative speed is valid data: u_q is negative with it. Only where their signs differ does the flux come out negative.

pub(crate) mod patterns;

use super::{
    super::{nameplate::Nameplate, request::Known},
    judgement::Judgement,
};
use crate::{
    frames::Dq,
    log::Log,
    motor::{Motor, PARAMETERS, Parameter},
    steady::windows,
};
use patterns::Pattern;

/// How far a log's value may lie from a nameplate's that is right, as the smallest and largest ratio, in the order of
/// [`Parameter::ALL`].
///
/// Data sheets promise ±10 % of R_s at 20 °C or 25 °C; copper gains 0.39 % per kelvin, 50 % on its way to insulation class F, and
/// the log's resistance has cable and switches in it. Inductances are ±20 to 30 % (windings, and the current at which they were
/// measured). Flux is ±10 %: magnets vary by 5 %, and neodymium loses 0.1 % per kelvin.
pub const TOLERANCE: [(f64, f64); PARAMETERS] = [(0.9, 1.5), (1.0 / 1.3, 1.3), (1.0 / 1.3, 1.3), (0.9, 1.1)];

/// What errs together: the inductances are one kind.
const KINDS: [&[Parameter]; 3] = [&[Parameter::Rs], &[Parameter::Ld, Parameter::Lq], &[Parameter::PsiF]];

/// A tolerance in standard deviations: data sheets state limits.
const DEVIATIONS: f64 = 2.0;

/// Standard deviations beyond which a kind is simply not explained: it shall not outvote the others.
const FAR: f64 = 3.0;

/// What a second pattern costs, in kinds that are explained. Of some 1500 pairs there is one for nearly every two numbers, so only
/// three kinds can support a pair, and one that explains all three is level with a single pattern that explains two.
const KINDS_OF_SECOND: usize = 1;

/// What it costs in squared standard deviations, where it is level in kinds: twice the logarithm of the 57 patterns that it is chosen from.
const MISFIT_OF_SECOND: f64 = 8.1;

/// How much inductances change with current, either way: 2.8 times in the measured map of a 5.6 kW machine, and a data sheet may
/// state them at any current. Up to this they alone are no reason to suspect a convention.
const SATURATION: f64 = 3.0;

/// Alternatives that are kept; more would only say that the log tells little.
const ALTERNATIVES: usize = 8;

/// Most that resistance and inductances may take of the voltage, as a fraction of the flux's part, for an apparent flux: they are
/// the nameplate's, and may be as wrong as the flux.
const MOST_INFLUENCE: f64 = 0.25;

/// Slower rows, as a fraction of the fastest, divide little voltage by little speed.
const LEAST_SPEED: f64 = 0.5;

/// Fewer rows have no median worth its name.
const LEAST_ROWS: usize = 10;

/// One parameter of the log beside the nameplate's.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Ratio {
    /// Which.
    pub parameter: Parameter,
    /// The log's value over the nameplate's.
    pub ratio: f64,
    /// Relative doubt of the log's value: half of its 95 % interval, or what resistance and inductances may take from an apparent flux.
    pub doubt: f64,
    /// Whether it is an apparent flux, not an identified one.
    pub apparent: bool,
}

/// One or two patterns, as an explanation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Candidate {
    /// Its patterns.
    pub patterns: Vec<Pattern>,
    /// How many times the nameplate's it makes the log's parameters, in the order of [`Parameter::ALL`].
    pub factors: [f64; PARAMETERS],
    /// The parameters that it brings within tolerance, or leaves there.
    pub explained: Vec<Parameter>,
}

/// The log beside the nameplate.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Convention {
    /// Every parameter that both know.
    pub ratios: Vec<Ratio>,
    /// What explains them best: nothing where they agree, or where nothing named does.
    pub best: Option<Candidate>,
    /// What explains as many of them, next best first.
    pub alternatives: Vec<Candidate>,
    /// Whether u_q and the speed have opposite signs, so that the flux comes out negative.
    pub reversed: bool,
}

/// Compares a log with a nameplate: the parameters identified, except those that the settings knew beforehand, and if the flux is
/// none of them, the rows' apparent flux. Without an identification (the log may have no operating point) there is only the latter.
pub fn compare_with_nameplate(
    log: &Log,
    found: Option<(&[Judgement; PARAMETERS], &[Known; PARAMETERS])>,
    nameplate: &Nameplate,
) -> Convention {
    let mut ratios: Vec<Ratio> = found.map(|(found, known)| identified(found, known, nameplate)).unwrap_or_default();
    let mut reversed = false;
    if ratios.iter().all(|ratio| ratio.parameter != Parameter::PsiF)
        && let Some((flux, is_reversed)) = apparent_flux(log, nameplate)
    {
        ratios.push(flux);
        reversed = is_reversed;
    }
    explain(ratios, reversed, nameplate)
}

/// What was identified and stands on the nameplate too.
fn identified(parameters: &[Judgement; PARAMETERS], known: &[Known; PARAMETERS], nameplate: &Nameplate) -> Vec<Ratio> {
    let ratio = |judgement: &Judgement| {
        let parameter = judgement.parameter;
        let (value, expected) = (judgement.value()?, nameplate.value(parameter)?);
        let free = known[parameter as usize] == Known::Nothing;
        let doubt = judgement.uncertainty.half_width / value;
        free.then_some(Ratio { parameter, ratio: value / expected, doubt, apparent: false })
    };
    parameters.iter().filter_map(ratio).collect()
}

/// The median length of the rows' apparent flux over the nameplate's, and whether it points against the magnet.
fn apparent_flux(log: &Log, nameplate: &Nameplate) -> Option<(Ratio, bool)> {
    let [rs, ld, lq, psi_f] = Parameter::ALL.map(|parameter| nameplate.value(parameter));
    let motor = Motor { rs: rs?, ld: ld.or(lq)?, lq: lq.or(ld)?, psi_f: 0.0 };
    let (columns, least_current) = (log.columns(), windows::least_current(log));
    let fastest = columns.omega_e.iter().fold(0.0_f64, |most, omega| most.max(omega.abs()));
    // Length, part along q, and what was taken off, of each row that carries current at speed.
    let (mut length, mut along, mut taken) = (Vec::new(), Vec::new(), Vec::new());
    for (row, &omega_e) in columns.omega_e.iter().enumerate() {
        let i = Dq { d: columns.id[row], q: columns.iq[row] };
        if omega_e.abs() < LEAST_SPEED * fastest || i.magnitude() < least_current {
            continue;
        }
        let drop = motor.steady_voltage(i, omega_e);
        let flux = Dq { d: (columns.ud[row] - drop.d) / omega_e, q: (columns.uq[row] - drop.q) / omega_e };
        length.push(flux.magnitude());
        along.push(flux.q);
        taken.push(drop.magnitude() / omega_e.abs());
    }
    if length.len() < LEAST_ROWS {
        return None;
    }
    let flux = median(&mut length);
    let doubt = median(&mut taken) / flux;
    let ratio = Ratio { parameter: Parameter::PsiF, ratio: flux / psi_f?, doubt, apparent: true };
    (doubt <= MOST_INFLUENCE).then_some((ratio, median(&mut along) < 0.0))
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Looks for the patterns that explain the ratios, if they are not within tolerance already.
fn explain(ratios: Vec<Ratio>, reversed: bool, nameplate: &Nameplate) -> Convention {
    let nothing = Candidate::of(Vec::new(), &ratios);
    if nothing.explained.len() == ratios.len() || may_be_saturation(&ratios) {
        return Convention { ratios, reversed, ..Convention::default() };
    }
    let singles = patterns::all(nameplate);
    let supported = KINDS.iter().all(|kind| ratios.iter().any(|ratio| kind.contains(&ratio.parameter)));
    let firsts = if supported { &singles[..] } else { &[] };
    let pairs = firsts.iter().enumerate().flat_map(|(k, one)| singles[k + 1..].iter().map(|other| vec![*one, *other]));
    let mut candidates: Vec<Candidate> =
        singles.iter().map(|one| vec![*one]).chain(pairs).map(|patterns| Candidate::of(patterns, &ratios)).collect();
    candidates.retain(|candidate| candidate.merit(&ratios) > nothing.merit(&ratios));
    // Stable: of those that are equal the table's order decides, and rounding does not.
    candidates.sort_by_cached_key(|candidate| {
        let misfit = (1e6 * candidate.misfit(&ratios)).round() as i64;
        (std::cmp::Reverse(candidate.merit(&ratios)), misfit)
    });
    let most = candidates.first().map_or(0, |best| best.merit(&ratios));
    let mut best = candidates.into_iter().take_while(|candidate| candidate.merit(&ratios) == most);
    Convention { best: best.next(), alternatives: best.take(ALTERNATIVES).collect(), ratios, reversed }
}

impl Ratio {
    /// How many tolerances the log's value lies from `factor` times the nameplate's; negative below.
    fn deviation(&self, factor: f64) -> f64 {
        let (low, high) = TOLERANCE[self.parameter as usize];
        let away = (self.ratio / factor).ln();
        let tolerance = if away < 0.0 { low.recip().ln() } else { high.ln() };
        away / tolerance.hypot(self.doubt.ln_1p())
    }

    fn agrees_with(&self, factor: f64) -> bool {
        self.deviation(factor).abs() <= 1.0
    }
}

impl Candidate {
    fn of(patterns: Vec<Pattern>, ratios: &[Ratio]) -> Self {
        let factors: [f64; PARAMETERS] = std::array::from_fn(|p| patterns.iter().map(|pattern| pattern.factors[p]).product());
        let explained = ratios.iter().filter(|ratio| ratio.agrees_with(factors[ratio.parameter as usize])).map(|ratio| ratio.parameter);
        let explained = explained.collect();
        Self { explained, patterns, factors }
    }

    /// Kinds of parameters that are explained, less what a second pattern costs.
    fn merit(&self, ratios: &[Ratio]) -> usize {
        let explained = self.deviations(ratios).filter(|deviation| *deviation <= 1.0).count();
        explained.saturating_sub(KINDS_OF_SECOND * self.seconds())
    }

    /// Sum of squared standard deviations over the kinds, and what a second pattern costs.
    fn misfit(&self, ratios: &[Ratio]) -> f64 {
        let squares = self.deviations(ratios).map(|deviation| (DEVIATIONS * deviation).min(FAR).powi(2));
        squares.sum::<f64>() + MISFIT_OF_SECOND * self.seconds() as f64
    }

    /// Of each kind that is known, how many tolerances the worst of it lies away.
    fn deviations(&self, ratios: &[Ratio]) -> impl Iterator<Item = f64> {
        KINDS.into_iter().filter_map(move |kind| {
            let known = ratios.iter().filter(|ratio| kind.contains(&ratio.parameter));
            known.map(|ratio| ratio.deviation(self.factors[ratio.parameter as usize]).abs()).reduce(f64::max)
        })
    }

    fn seconds(&self) -> usize {
        self.patterns.len().saturating_sub(1)
    }
}

impl Convention {
    /// Whether everything that can be compared agrees.
    pub fn agrees(&self) -> bool {
        !self.reversed && self.ratios.iter().all(|ratio| ratio.agrees_with(1.0))
    }

    /// The ratios that are not within tolerance.
    pub fn deviating(&self) -> impl Iterator<Item = &Ratio> {
        self.ratios.iter().filter(|ratio| !ratio.agrees_with(1.0))
    }

    /// Whether saturation alone may explain the ratios.
    pub fn may_be_saturation(&self) -> bool {
        may_be_saturation(&self.ratios)
    }
}

/// Whether inductances are all that is known, and lie to one side as far as saturation, or a data sheet's choice of current, may take them.
fn may_be_saturation(ratios: &[Ratio]) -> bool {
    let all = |is: &dyn Fn(&Ratio) -> bool| ratios.iter().all(is);
    all(&|ratio| matches!(ratio.parameter, Parameter::Ld | Parameter::Lq))
        && (all(&|ratio| (1.0..=SATURATION).contains(&ratio.ratio)) || all(&|ratio| (1.0 / SATURATION..=1.0).contains(&ratio.ratio)))
}

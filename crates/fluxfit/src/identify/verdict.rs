//! Verdicts: for each parameter a plain word, the reason and the remedy; for the whole, warnings.
//!
//! A verdict follows from the interval alone, and from what no motor has: a negative resistance, inductance or flux is never `identified`. The reason names what the interval is made of, or what the log does not excite.

use super::{
    Known, Search, Settings,
    estimate::Estimate,
    excitation::Excitation,
    misfit::Misfit,
    uncertainty::{ParameterUncertainty, Uncertainty},
};
use crate::{
    log::Log,
    motor::{PARAMETERS, Parameter},
    steady::{OperatingPoint, held_vector::MAX_ANGLE_PER_SAMPLE, windows},
};

/// Largest half-width of the 95 % interval, as a fraction of the value, of a parameter that is identified.
pub const IDENTIFIED: f64 = 0.05;

/// The same of one that is weak.
pub const WEAK: f64 = 0.50;

/// A verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Good to 5 %.
    Identified,
    /// Good to 50 %.
    Weak,
    /// The log cannot tell.
    NotIdentifiable,
}

impl Verdict {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::NotIdentifiable => "not-identifiable",
        }
    }
}

/// One parameter, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Which.
    pub parameter: Parameter,
    /// The number that came out, SI. An answer only unless the verdict is [`Verdict::NotIdentifiable`].
    pub raw: f64,
    /// Its uncertainty.
    pub uncertainty: ParameterUncertainty,
    /// The verdict.
    pub verdict: Verdict,
    /// Why the verdict is not better, or what was given.
    pub reason: Option<String>,
    /// What to do for a better one.
    pub remedy: Option<String>,
}

impl Judgement {
    /// The value, where it means something.
    pub fn value(&self) -> Option<f64> {
        (self.verdict != Verdict::NotIdentifiable).then_some(self.raw)
    }

    /// The 95 % interval, where the value means something.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.value().map(|value| [value - self.uncertainty.half_width, value + self.uncertainty.half_width])
    }
}

/// Something that the reader should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name in files.
    pub code: &'static str,
    /// One or two sentences.
    pub message: String,
}

/// Judges every parameter.
pub fn judge(
    points: &[OperatingPoint],
    excitation: &Excitation,
    estimate: &Estimate,
    uncertainty: &Uncertainty,
    settings: &Settings,
) -> [Judgement; PARAMETERS] {
    Parameter::ALL.map(|parameter| {
        let raw = estimate.motor.get(parameter);
        let uncertainty = uncertainty.parameters[parameter as usize];
        let width = uncertainty.half_width / raw.abs();
        let verdict = match width {
            _ if raw <= 0.0 => Verdict::NotIdentifiable,
            w if w <= IDENTIFIED => Verdict::Identified,
            w if w <= WEAK => Verdict::Weak,
            _ => Verdict::NotIdentifiable,
        };
        let (reason, remedy) = match (settings.known[parameter as usize], verdict) {
            (Known::Fixed(_), _) => (Some("given, not identified".to_owned()), None),
            (_, Verdict::Identified) => (None, None),
            _ => {
                let (reason, remedy) = explain(parameter, points, excitation, raw, &uncertainty);
                (Some(reason), Some(remedy))
            }
        };
        Judgement { parameter, raw, uncertainty, verdict, reason, remedy }
    })
}

/// A direction is a parameter's own axis if its component is at least this.
const OWN_AXIS: f64 = 0.9;

/// Why a parameter is not identified, and the remedy.
fn explain(
    parameter: Parameter,
    points: &[OperatingPoint],
    excitation: &Excitation,
    raw: f64,
    uncertainty: &ParameterUncertainty,
) -> (String, String) {
    let symbol = parameter.symbol();
    if excitation.is_open(parameter) {
        return explain_unexcited(parameter, points, excitation);
    }
    let systematic = uncertainty.systematic;
    let width = if raw == 0.0 { f64::INFINITY } else { uncertainty.half_width / raw.abs() };
    let parts =
        [uncertainty.statistical, systematic.accuracy, systematic.timing, systematic.misfit, systematic.prior, systematic.excitation];
    let largest = (0..parts.len()).max_by(|a, b| parts[*a].total_cmp(&parts[*b])).unwrap_or(0);
    if raw <= 0.0 && width < WEAK {
        return (
            format!("{symbol} came out negative, which no motor has, and not by noise"),
            "check signs and order of the columns: motor convention, q 90 degrees ahead of d, one sign of speed and of u_q".to_owned(),
        );
    }
    let of_width =
        if width.is_finite() && width < 10.0 { format!("±{:.2} %", 100.0 * width) } else { "wider than the value itself".to_owned() };
    match largest {
        0 => {
            let longer = (width / IDENTIFIED).powi(2);
            let remedy = if longer < 100.0 {
                format!("hold each operating point about {:.0} times as long, or {}", longer.max(1.0).ceil(), farther_apart(parameter))
            } else {
                farther_apart(parameter).to_owned()
            };
            (format!("the noise of the window means leaves {of_width}"), remedy)
        }
        1 => (format!("the voltages' accuracy leaves {of_width}: the operating points are too much alike to tell {symbol}"), farther_apart(parameter).to_owned()),
        2 => (
            format!("it is not known which instant the voltage columns belong to, which leaves {of_width}"),
            "state it with --voltage-timing".to_owned(),
        ),
        3 => (
            format!("the operating points contradict each other beyond their noise, which leaves {of_width}: one motor with constant parameters does not explain them"),
            "name windows at one load with --window, and keep to operating points at which the drive switches and the motor saturates alike".to_owned(),
        ),
        4 => (format!("the prior that was given leaves {of_width}"), "give a sharper --prior, or log another operating point".to_owned()),
        _ => (format!("what the log does not excite could move it: {of_width}"), farther_apart(parameter).to_owned()),
    }
}

/// Which of the three ways of not being excited it is.
fn explain_unexcited(parameter: Parameter, points: &[OperatingPoint], excitation: &Excitation) -> (String, String) {
    let open: Vec<Parameter> = Parameter::ALL.into_iter().filter(|other| excitation.is_open(*other)).collect();
    let id_most = points.iter().map(|point| point.current().d.abs()).fold(0.0, f64::max);
    let current = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    let step = format!("add a stretch at the same speed with i_d near {} A", one_digit(-0.2 * current));
    // L_d alone, its unit vector not excited: nothing but noise multiplies it.
    let ld_absent =
        excitation.directions.iter().any(|direction| !direction.excited && direction.components[Parameter::Ld as usize].abs() > OWN_AXIS);
    match parameter {
        Parameter::Ld if ld_absent => (
            format!(
                "i_d stays at zero (at most {} A, no more than its noise and accuracy), so L_d is absent from the equations",
                one_digit(id_most)
            ),
            step,
        ),
        Parameter::Rs | Parameter::PsiF if ld_absent => (
            "there is one speed and one load, where R_s i_q and omega_e psi_f act alike".to_owned(),
            format!("{step}, or a second speed or load, or give --fix rs=VALUE"),
        ),
        _ if open.contains(&Parameter::Ld) && open.contains(&Parameter::PsiF) && !open.contains(&Parameter::Rs) => (
            "i_d is the same at every operating point, where L_d i_d and psi_f act alike".to_owned(),
            "add a stretch at the same speed with i_d = 0".to_owned(),
        ),
        _ => {
            let names: Vec<&str> = open.iter().map(|other| other.symbol()).collect();
            (format!("the operating points are too much alike: only a combination of {} shows in them", names.join(", ")), step)
        }
    }
}

/// How to make operating points tell a parameter.
fn farther_apart(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Rs => {
            "add operating points with more current at low speed, or a larger step of i_d, or give --prior rs=VALUE±1% from a multimeter"
        }
        Parameter::Ld => "make the step of i_d larger",
        Parameter::Lq => "add operating points with more i_q",
        Parameter::PsiF => "add operating points at a higher speed, or at a second speed",
    }
}

/// A number with one significant digit, and no exponent.
fn one_digit(x: f64) -> String {
    let exponent = if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    let unit = 10.0_f64.powi(exponent);
    format!("{:.*}", exponent.saturating_neg().clamp(0, 12) as usize, (x / unit).round() * unit)
}

/// Share of rows without current that is worth a word.
const MANY_ROWS: f64 = 0.01;

/// Collects the warnings.
pub fn warn(
    log: &Log,
    points: &[OperatingPoint],
    estimate: &Estimate,
    misfit: Option<&Misfit>,
    parameters: &[Judgement; PARAMETERS],
    search: Option<&Search>,
    settings: &Settings,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |code, message| warnings.push(Warning { code, message });
    if estimate.redundancy == 0 {
        warn(
            "no-redundancy",
            "there are exactly as many equations as unknowns, so a perfect fit proves nothing: saturation or a wrong unit would go unseen; add a third operating point, or give a known value with --fix or --prior".to_owned(),
        );
    }
    if let Some(Misfit { ratio, voltage_accuracy }) = misfit {
        warn(
            "misfit",
            format!(
                "the operating points contradict each other {ratio:.1} times beyond noise and accuracy and agree only to {:.2} % of the voltage: inductances fall with current (saturation), flux and resistance change with temperature, or these are not the voltages at the terminals; the intervals are widened to hold for each point",
                100.0 * voltage_accuracy
            ),
        );
    }
    let idle = windows::rows_without_current(log);
    if settings.windows.is_empty() && idle as f64 > MANY_ROWS * log.rows() as f64 {
        warn(
            "no-current",
            format!(
                "{idle} of {} rows carry no current and were not used: while a drive coasts, its voltage columns are not voltages that act",
                log.rows()
            ),
        );
    }
    let coarse = points.iter().any(|point| {
        log.segments().iter().any(|segment| {
            segment.rows.contains(&point.rows.start) && (point.omega_e() * segment.sample_period).abs() > MAX_ANGLE_PER_SAMPLE
        })
    });
    if coarse {
        warn(
            "coarse-sampling",
            "the rotor turns too far between rows for them to be the inverter's own periods: the log is taken as decimated, and the held voltage vector is not corrected".to_owned(),
        );
    }
    if let Some(search) = search {
        let outside: Vec<&str> = parameters
            .iter()
            .zip(search.bounds.iter())
            .filter(|(judgement, (lower, upper))| judgement.value().is_some_and(|value| value < *lower || value > *upper))
            .map(|(judgement, _)| judgement.parameter.symbol())
            .collect();
        if !outside.is_empty() {
            warn("outside-box", format!("least squares lies outside the search box in {}: the swarm cannot reach it", outside.join(", ")));
        }
    }
    warnings
}

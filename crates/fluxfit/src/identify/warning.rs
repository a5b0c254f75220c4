//! Warnings: what the reader should know of the whole, whatever the verdicts.

use super::{Identification, Settings, output_fit::OutputFit, steady_fit::SteadyFit, terms::Term};
use crate::{
    log::Log,
    steady::{held_vector::MAX_ANGLE_PER_SAMPLE, windows},
};

/// Something that the reader should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name in files.
    pub code: &'static str,
    /// One or two sentences.
    pub message: String,
}

/// Everything there is to warn of.
pub(super) fn warnings(log: &Log, found: &Identification, settings: &Settings) -> Vec<Warning> {
    let of_points = found.steady.as_ref().map(|fit| {
        // What only the steady model's own answer suffers from.
        let answered = found.output.is_none();
        [
            ("no-redundancy", no_redundancy(fit).filter(|_| answered)),
            ("misfit", misfit(fit)),
            ("dead-time", dead_time(fit).filter(|_| answered)),
            ("no-current", no_current(log, fit, settings).filter(|_| answered)),
            ("short-stretches", short_stretches(log, settings).filter(|_| answered)),
            ("coarse-sampling", coarse_sampling(log, fit)),
        ]
    });
    let of_currents = found.output.as_ref().map(|fit| [("process-noise", process_noise(fit))]);
    let all = of_points.into_iter().flatten().chain(of_currents.into_iter().flatten()).chain([("outside-box", outside_box(found))]);
    all.filter_map(|(code, message)| message.map(|message| Warning { code, message })).collect()
}

fn no_redundancy(found: &SteadyFit) -> Option<String> {
    let message = "there are exactly as many equations as unknowns, so a perfect fit proves nothing: saturation, dead time or a wrong \
                   unit would go unseen; add a third operating point, or give a known value with --fix or --prior";
    (found.estimate.redundancy == 0).then(|| message.to_owned())
}

fn misfit(found: &SteadyFit) -> Option<String> {
    let misfit = found.misfit?;
    Some(format!(
        "the operating points contradict each other {:.1} times beyond noise and accuracy, and agree only to {:.2} % of the voltage: \
         inductances fall with current (saturation), flux and resistance change with temperature, or these are not the voltages at the \
         terminals (dead time, device drops, delay); the intervals are widened to the scatter of the points",
        misfit.ratio,
        100.0 * misfit.voltage_accuracy
    ))
}

fn dead_time(found: &SteadyFit) -> Option<String> {
    let most = found.voltage_losses.iter().copied().fold(0.0, f64::max);
    (most > 0.0).then(|| {
        format!(
            "voltages and currents ripple at six times the electrical frequency, as dead time or device drops make them that take about {most:.2} V \
             along the current; the model cannot tell that from resistance, and counts it as uncertainty"
        )
    })
}

fn process_noise(found: &OutputFit) -> Option<String> {
    found.has(Term::ProcessNoise).then(|| {
        "voltages that the log does not hold disturb the motor: what the simulated currents miss depends on what went before; each row is \
         predicted from the row before instead, and the difference this makes is counted as uncertainty"
            .to_owned()
    })
}

/// Share of rows without current that is worth a word.
const MANY_ROWS: f64 = 0.01;

fn no_current(log: &Log, found: &SteadyFit, settings: &Settings) -> Option<String> {
    const WHY: &str = "while a drive coasts, its voltage columns are not voltages that act";
    if settings.windows.is_empty() {
        let (idle, rows) = (windows::rows_without_current(log), log.rows());
        return (idle as f64 > MANY_ROWS * rows as f64).then(|| format!("{idle} of {rows} rows carry no current and were not used: {WHY}"));
    }
    let idle = found.operating_points.iter().filter(|point| point.current().magnitude() < windows::least_current(log)).count();
    (idle > 0).then(|| format!("{idle} of the windows named carry no current and were used all the same: {WHY}"))
}

/// Stretches that are named in a warning; more would drown it.
const NAMED: usize = 3;

fn short_stretches(log: &Log, settings: &Settings) -> Option<String> {
    let (_, mut short) = windows::find_all(log);
    short.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
    if short.is_empty() || !settings.windows.is_empty() {
        return None;
    }
    let t = &log.columns().t;
    let named: Vec<String> = short.iter().take(NAMED).map(|rows| format!("{:.4}:{:.4}", t[rows.start], t[rows.end - 1])).collect();
    let more = if short.len() > NAMED { " and more" } else { "" };
    Some(format!(
        "steady stretches much shorter than the others were left out, at {} s{more}: if the drive was held there, name all windows with --window",
        named.join(", ")
    ))
}

fn coarse_sampling(log: &Log, found: &SteadyFit) -> Option<String> {
    let fastest = found.operating_points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let coarse = found.operating_points.iter().any(|point| {
        let within = log.segment_of(point.rows.start);
        within.is_some_and(|segment| fastest * segment.sample_period > MAX_ANGLE_PER_SAMPLE)
    });
    let message = "the rotor turns too far between rows for them to be the inverter's own periods: the log is taken as decimated, and the \
                   held voltage vector is not corrected";
    coarse.then(|| message.to_owned())
}

fn outside_box(found: &Identification) -> Option<String> {
    let search = found.search.as_ref()?;
    let judged = found.parameters.iter().zip(search.bounds.iter());
    let outside = judged.filter(|(judgement, (lower, upper))| judgement.value().is_some() && !(lower..=upper).contains(&&judgement.raw));
    let symbols: Vec<&str> = outside.map(|(judgement, _)| judgement.parameter.symbol()).collect();
    (!symbols.is_empty()).then(|| format!("least squares lies outside the search box in {}: the swarm cannot reach it", symbols.join(", ")))
}

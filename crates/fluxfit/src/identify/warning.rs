//! Warnings: what the reader should know of the whole, whatever the verdicts.

use super::{
    Identification, Settings,
    conventions::three_digits,
    output_fit::OutputFit,
    saturation::{Apparent, Saturation},
    steady_fit::SteadyFit,
};
use crate::{
    faults::Fault,
    log::Log,
    motor::Parameter,
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
            ("no-redundancy", no_redundancy(fit).filter(|_| answered || !has_transients(found))),
            ("misfit", misfit(fit)),
            ("dead-time", dead_time(fit).filter(|_| answered)),
            ("no-current", no_current(log, fit, settings).filter(|_| answered)),
            ("short-stretches", short_stretches(log, settings).filter(|_| answered)),
            ("coarse-sampling", coarse_sampling(log, fit)),
        ]
    });
    let of_currents = found.output.as_ref().map(|fit| [("process-noise", process_noise(fit)), ("angle", angle(log, fit))]);
    let of_either = [
        ("saturation", found.saturation.as_ref().map(saturated)),
        ("low-speed", low_speed(log, found)),
        ("voltage-limit", voltage_limit(log)),
        ("outside-box", outside_box(found)),
    ];
    let all = of_points.into_iter().flatten().chain(of_currents.into_iter().flatten()).chain(of_either);
    all.filter_map(|(code, message)| message.map(|message| Warning { code, message })).collect()
}

fn no_redundancy(found: &SteadyFit) -> Option<String> {
    let message = "there are exactly as many equations as unknowns, so a perfect fit proves nothing: saturation, dead time or a wrong \
                   unit would go unseen; add a third operating point, or give a known value with --fix or --prior";
    (found.estimate.redundancy == 0).then(|| message.to_owned())
}

/// Part of the rows used that is worth calling a transient.
const TRANSIENT: f64 = 0.01;

/// Whether simulated currents were compared in rows beyond the operating points: what happens between them can contradict a motor that two
/// of them cannot.
fn has_transients(found: &Identification) -> bool {
    let Some(fit) = &found.output else { return false };
    let rows = || fit.stretches.iter().cloned().flatten();
    let steady = |row: &usize| found.operating_points().iter().any(|point| point.rows.contains(row));
    rows().filter(|row| !steady(row)).count() as f64 > TRANSIENT * rows().count() as f64
}

/// A voltage that nobody has subtracted must be this part of the motor's own, or less, for psi_f to be good to five percent.
const SMALL: f64 = 0.05;

/// Least part of the DC voltage that an inverter loses unseen: half a microsecond of dead time at a carrier of 10 kHz, about what a good
/// compensation leaves.
const UNSEEN_LOSS: f64 = 5e-3;

/// The motor's own voltage, at the fastest, against what the inverter is known or sure to lose.
fn low_speed(log: &Log, found: &Identification) -> Option<String> {
    let columns = log.columns();
    let within = |peak: f64, row: usize| peak.max(columns.omega_e[row].abs());
    let (omega_e, u) = match (&found.output, found.operating_points()) {
        (None, points) => points.iter().fold((0.0, 0.0), |most: (f64, f64), point| {
            if point.omega_e().abs() > most.0 { (point.omega_e().abs(), point.voltage().magnitude()) } else { most }
        }),
        (Some(fit), _) => {
            let rows = || fit.stretches.iter().cloned().flatten();
            (rows().fold(0.0, within), rows().map(|row| columns.ud[row].hypot(columns.uq[row])).fold(0.0, f64::max))
        }
    };
    // A flux that is not known makes no more voltage than there is.
    let own = found.parameter(Parameter::PsiF).value().map_or(u, |psi_f| omega_e * psi_f);
    let seen = found.steady.iter().flat_map(|fit| &fit.voltage_losses).copied().fold(0.0, f64::max);
    let unseen = columns.u_dc.as_ref().map_or(0.0, |u_dc| UNSEEN_LOSS * u_dc.iter().copied().fold(0.0, f64::max));
    let lost = seen.max(unseen);
    (own > 0.0 && lost > SMALL * own).then(|| {
        format!(
            "even at the highest speed, {} rad/s, the motor's own voltage is only {} V, and the inverter takes some {} V of what it is told: \
             psi_f and the inductances are no better than that; log at a higher speed",
            three_digits(omega_e),
            three_digits(own),
            three_digits(lost)
        )
    })
}

/// What a measured DC voltage may be wrong by.
const DC_ACCURACY: f64 = 0.01;

fn voltage_limit(log: &Log) -> Option<String> {
    let columns = log.columns();
    let u_dc = columns.u_dc.as_ref()?;
    let least = windows::least_current(log);
    let over = |row: &usize| {
        let (u, i) = (columns.ud[*row].hypot(columns.uq[*row]), columns.id[*row].hypot(columns.iq[*row]));
        i >= least && u_dc[*row] > 0.0 && u > (1.0 + DC_ACCURACY) * u_dc[*row] / 3.0_f64.sqrt()
    };
    let (over, rows) = ((0..log.rows()).filter(over).count(), log.rows());
    (over as f64 > MANY_ROWS * rows as f64).then(|| {
        format!(
            "{over} of {rows} rows have more voltage than u_dc / sqrt 3, all that the inverter can turn in a circle: what these columns ask for did \
             not act (the drive is at its voltage limit), or they are no peak values per phase; leave such stretches out with --window"
        )
    })
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

/// Change of an inductance that is worth two numbers.
const VISIBLE: f64 = 0.01;

fn saturated(saturation: &Saturation) -> String {
    let visible = |[least, most]: &[Apparent; 2]| (most.inductance / least.inductance - 1.0).abs() >= VISIBLE;
    let lq = saturation.lq.filter(visible).map_or_else(String::new, |[least, most]| {
        let (scale, unit) = if most.inductance.abs() < 1e-3 { (1e6, "uH") } else { (1e3, "mH") };
        let verb = if most.inductance < least.inductance { "falls" } else { "moves" };
        format!(
            ": apparent L_q {verb} from {} to {} {unit} between i_q = {} and {} A",
            three_digits(scale * least.inductance),
            three_digits(scale * most.inductance),
            three_digits(least.current),
            three_digits(most.current),
        )
    });
    format!(
        "the motor saturates{lq}; no constant inductances and flux explain the log, and the intervals hold what each operating point \
         would call them; the flux of each operating point is reported instead"
    )
}

fn process_noise(found: &OutputFit) -> Option<String> {
    found.has(Fault::Disturbance).then(|| {
        "voltages that the log does not hold disturb the motor: what the simulated currents miss depends on what went before; each row is \
         predicted from the row before instead, and the difference this makes is counted as uncertainty"
            .to_owned()
    })
}

fn angle(log: &Log, found: &OutputFit) -> Option<String> {
    (log.columns().theta_e.is_some() && !found.angle_known).then(|| {
        "theta_e does not turn with omega_e, so it was not used, and dead time and faults of the sensors were not looked for: is it the shaft's \
         angle instead of the electrical one, or in degrees, or is the speed in another unit?"
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

//! What the reader should know of the whole.

use super::digits::{from_to, one_digit, percent, prefix, three_digits};
use crate::{
    current_loop::{DELAY_PERIODS, MIN_PHASE_MARGIN},
    identification::{explain::warning::Warning, fit::saturation::Apparent},
    motor::Parameter,
};
use std::fmt::{Display, Formatter, Result};

/// Half of a 95 % interval, in standard errors.
const HALF_WIDTH: f64 = 1.96;

/// Stretches that are named in a warning; more would hide what it says.
const NAMED: usize = 3;

const COASTING: &str = "while a drive coasts, its voltage columns are not voltages that act";

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::NoRedundancy => write!(
                f,
                "there are exactly as many equations as unknowns, so a perfect fit proves nothing: saturation, dead time or a wrong \
                 unit would go unseen; add another operating point, or give a known value"
            ),
            Self::Misfit { ratio, voltage_accuracy } => write!(
                f,
                "the operating points contradict each other {} times as much as noise and accuracy explain, and agree only to {} of the \
                 voltage; possible causes are inductances that fall with current (saturation), flux and resistance that change with \
                 temperature, or voltages that are not those at the terminals (dead time, device drops, delay); the intervals are widened \
                 to the scatter of the points",
                three_digits(*ratio),
                percent(*voltage_accuracy)
            ),
            Self::DeadTime { voltage } => write!(
                f,
                "voltages and currents ripple at six times the electrical frequency, as dead time or device drops make them; these take about \
                 {voltage:.2} V in the direction of the current; that voltage is fitted beside the motor, and the part that cannot be told from \
                 resistance counts as uncertainty"
            ),
            Self::NoCurrent { rows, of } => write!(f, "{rows} of {of} rows carry no current and were not used: {COASTING}"),
            Self::NoCurrentInWindows { windows } => {
                write!(f, "{windows} of the windows named carry no current and were used all the same: {COASTING}")
            }
            Self::ShortStretches { times } => {
                let named: Vec<String> = times.iter().take(NAMED).map(|(start, end)| format!("{start:.4}:{end:.4}")).collect();
                let more = if times.len() > NAMED { " and more" } else { "" };
                write!(
                    f,
                    "steady stretches much shorter than the others were left out, at {} s{more}: if the drive was held there, name all \
                     windows in time",
                    named.join(", ")
                )
            }
            Self::CoarseSampling => write!(
                f,
                "the rotor turns too far between rows for them to be the inverter's own periods: the log is taken as decimated, and the \
                 held voltage vector is not corrected"
            ),
            Self::FrameLag { seconds, standard_error, angle, coasting_rows } => {
                let (micro, error) = (1e6 * seconds.abs(), HALF_WIDTH * 1e6 * standard_error);
                let (way, show) = (
                    if *seconds > 0.0 { "behind" } else { "ahead of" },
                    if *coasting_rows > 0 { format!(", as {coasting_rows} rows without current show too") } else { String::new() },
                );
                write!(
                    f,
                    "the voltages turn with speed against the rotor's frame: they lie {} ± {} us {way} it, {:.1} degrees at the highest \
                     speed{show}, because they are of another instant, or the angle is late or early; that is fitted beside the motor, and \
                     what stays open of it counts as uncertainty; the wrong sign of a column is not the cause",
                    three_digits(micro),
                    one_digit(error),
                    angle.abs().to_degrees()
                )
            }
            Self::OpenLoop { times } => {
                let named: Vec<String> = times.iter().take(NAMED).map(|(start, end)| format!("{start:.2}:{end:.2}")).collect();
                let more = if times.len() > NAMED { " and more" } else { "" };
                write!(
                    f,
                    "at {} s{more} the magnet's voltage is at right angles to the current: the drive turned the current without knowing the \
                     rotor's angle (open loop), and its columns are not in the rotor's frame; these rows are used for the resistance alone, which they may tell too little of",
                    named.join(", ")
                )
            }
            Self::Warming { change, standard_error, rs } => {
                let (part, error) = ((change / rs).abs(), HALF_WIDTH * (standard_error / rs).abs());
                let verb = if *change > 0.0 { "grows" } else { "falls" };
                write!(
                    f,
                    "R_s {verb} by {} ± {} while the log is taken: the voltages of the operating points follow it (a winding that warms or \
                     cools); the R_s given is that in the middle of the log",
                    percent(part),
                    percent(error)
                )
            }
            Self::ProcessNoise => write!(
                f,
                "voltages that are not logged disturb the motor (process noise): successive residuals of the simulated currents are correlated; \
                 each row is therefore predicted from the row before, and the difference that this makes counts as uncertainty"
            ),
            Self::Angle => write!(
                f,
                "theta_e does not turn with omega_e, so it was not used, and dead time and faults of the sensors were not looked for: is \
                 it the shaft's angle instead of the electrical one, or in degrees, or is the speed in another unit?"
            ),
            Self::Saturation { lq } => write!(
                f,
                "the motor saturates{}; no constant inductances and flux fit the log, and the intervals cover the values at each operating \
                 point; the flux of each operating point is listed instead",
                lq.as_ref().map_or_else(String::new, apparent)
            ),
            Self::LowSpeed { omega_e, own, lost } => write!(
                f,
                "even at the highest speed, {} rad/s, the motor's own voltage is only {} V, while dead time and device drops take about {} V; \
                 that limits psi_f and the inductances: log at a higher speed",
                three_digits(*omega_e),
                three_digits(*own),
                three_digits(*lost)
            ),
            Self::VoltageLimit { rows, of } => write!(
                f,
                "{rows} of {of} rows have more voltage than u_dc / sqrt 3, all that the inverter can turn in a circle: what these columns \
                 ask for did not act (the drive is at its voltage limit), or they are no peak values per phase; leave such stretches out"
            ),
            Self::OutsideBox { parameters } => {
                let symbols: Vec<&str> = parameters.iter().copied().map(Parameter::symbol).collect();
                write!(
                    f,
                    "the answer lies outside the swarm's search box in {}, so the swarm, which is a comparison, cannot reach it; the answer \
                     does not come from the swarm and stands",
                    symbols.join(", ")
                )
            }
            Self::Convention(convention) => write!(f, "{convention}"),
            Self::PhaseMargin { bandwidth, margin, control_rate, rate_assumed, highest } => {
                let outcome = if *margin > 0.0 {
                    format!("leaves a phase margin of {margin:.0} degrees, less than {MIN_PHASE_MARGIN:.0}")
                } else {
                    "makes the loop unstable".to_owned()
                };
                let assumed = if *rate_assumed { ", taken from the log; state the control rate if the drive controls faster" } else { "" };
                write!(
                    f,
                    "a bandwidth of {bandwidth:.0} Hz {outcome}, with {DELAY_PERIODS} periods of delay at {control_rate:.0} Hz{assumed}; ask for \
                     at most {:.0} Hz",
                    highest.floor()
                )
            }
            Self::PriorContradicted { parameter, prior, log } => {
                let (scale, prefix) = prefix(prior.0.abs().max(log.0.abs()));
                let [prior, of_prior, log, of_log] = [prior.0, prior.1, log.0, log.1].map(|value| three_digits(scale * value));
                let (symbol, unit) = (parameter.symbol(), format!("{prefix}{}", parameter.unit()));
                write!(
                    f,
                    "the log contradicts the prior of {symbol}: {prior} ± {of_prior} {unit} was given, the log says {log} ± {of_log} \
                     {unit} (standard errors); the answer is a compromise between two numbers of which one is wrong: check the prior \
                     (temperature, cable, line to line or per phase), and the columns"
                )
            }
            Self::Interrupted { iterations, limit } => {
                write!(f, "the swarm made {iterations} of {limit} iterations; the answer beside it is whole")
            }
        }
    }
}

/// How the apparent L_q depends on the current.
fn apparent([least, most]: &[Apparent; 2]) -> String {
    let verb = if most.inductance < least.inductance { "falls" } else { "moves" };
    format!(
        ": apparent L_q {verb} {} between i_q = {} and {} A",
        from_to([least.inductance, most.inductance]),
        three_digits(least.current),
        three_digits(most.current),
    )
}

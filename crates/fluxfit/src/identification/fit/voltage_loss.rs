//! What an inverter may take from its voltages: unknowns beside the motor in the equations of the operating points.
//!
//! Dead time and device drops take a voltage `V_1` of constant size along the current, `4/pi` of what each phase loses. Where the points'
//! currents differ enough in magnitude, that is told from resistance, which takes a voltage in proportion to the current. Where they do
//! not, the physically possible size of `V_1` is doubt, above all of `R_s`. One prior does both:
//!
//! ```text
//! u = (steady equations) + V_1 i/|i| + a omega_e J i/|i| - b h(|i|) i/|i|,     J: by 90 degrees forward
//! V_1 = 0 ± half of the largest that bus voltage, dead time and devices allow; or what the harmonic in the rows says
//! ```
//!
//! `a` is there because the loss is decided at an unknown instant of the period, during which the current turns in the stator: `0 ± V_1 T`.
//! `b` is there because a phase loses less while its ripple changes the current's sign: with a ramp of width `w` in the phase current,
//! `h(|i|)` is the part that the fundamental of the loss lacks, and `b` is `0 ± V_1`, for the width is known by its order only.
//!
//! S.-G. Jeong and M.-H. Park, "The analysis and compensation of dead-time effects in PWM inverters", IEEE Transactions on Industrial
//! Electronics 38, 1991, doi:10.1109/41.88903.

use super::{super::request::Request, part::Part, voltage_accuracy::VoltageAccuracy};
use crate::{
    faults::{
        Faults,
        dead_time::{DeadTime, ripple::Harmonic},
    },
    frames::Dq,
    log::{CONTROL_RATE, Log},
    objective::{acting_voltage::VoltageTiming, adjustable::Adjustable},
    steady::OperatingPoint,
};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI};

/// Longest dead time of a drive, s: that of IGBTs. MOSFETs take a tenth to one microsecond.
const LONGEST_DEAD_TIME: f64 = 3e-6;

/// Largest mean drop of a switch and its diode beyond their on-resistance, as a part of the bus voltage: 1 V of 48 V. It is less on the
/// higher voltages of IGBTs, and MOSFETs have almost none.
const LARGEST_DROP: f64 = 0.02;

/// What such a log's drive is taken to switch at, Hz: faster ones have MOSFETs with short dead times.
const USUAL_CARRIER: f64 = 20e3;

/// Bus voltage over the largest phase voltage of a log that says nothing else of it. It is at least sqrt 3; most drives keep a reserve.
const BUS_OVER_VOLTAGE: f64 = 2.0;

/// Ripple of a phase current to either side, as a part of `U_dc / (L f_carrier)`: an eighth at a duty of one half with the star point
/// fixed, about that over a turn.
const RIPPLE: f64 = 1.0 / 8.0;

/// Currents beyond this many times the ripple make the loss's harmonic surely. Of simulated drives, those from 1.2 times on make 0.7 to
/// 1.6 times as much of it as a square wave.
const BEYOND_RIPPLE: f64 = 2.0;

/// The fundamental over what the harmonic says, and its uncertainty: where the current's sign changes gradually, or the inductance behind
/// the harmonic is not known well, the harmonic says more than there is. Of simulated drives: 0.4 to 1.1.
const OF_HARMONIC: (f64, f64) = (0.75, 0.35);

/// What the three unknowns do not describe of the loss at a point, as a part of it: ripple, resistance and capacitance of the devices,
/// where in the row the current turns. Of simulated drives, a hundredth makes the intervals of operating points beside a loss hold; without
/// it, those of L_q held in 82 of 100.
const MISSHAPEN: f64 = 0.01;

/// The same across the current, of rows that are the drive's periods, where devices have drops beside the dead time: what is lost edge by
/// edge and all the time is modelled a hundredth of the loss late or early. In logs of 22 simulated motors with both, L_q was too large by
/// up to that, at two standard errors of which this is one, while R_s and psi_f were right.
const ACROSS_BESIDE_DROPS: f64 = 0.005;

/// Currents below this part of the largest are none.
const NO_CURRENT: f64 = 0.01;

/// An unknown beside the motor, with its prior.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loss {
    /// Per point, what one volt of it does to the two voltages, V.
    pub(crate) voltages: Vec<[f64; 2]>,
    /// V.
    pub(crate) expected: f64,
    /// V.
    pub(crate) standard_error: f64,
    /// The part of the uncertainty that it makes.
    pub(crate) part: Part,
}

/// What is known of the drive's losses before the points are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LossPrior {
    /// V_1, V.
    pub(crate) expected: f64,
    /// V; zero: there is no loss.
    pub(crate) standard_error: f64,
    /// DC bus, V.
    bus: f64,
    /// Carrier, Hz, as far as it matters here.
    carrier: f64,
}

impl LossPrior {
    /// What is physically possible in the drive of this log. Voltages without any error, and those of a short circuit, are the terminals'.
    pub(crate) fn possible(log: &Log, request: &Request) -> Self {
        let columns = log.columns();
        let largest = |values: &mut dyn Iterator<Item = f64>| Some(values.fold(0.0, f64::max)).filter(|most| *most > 0.0);
        let measured = columns.u_dc.as_ref().and_then(|u_dc| largest(&mut u_dc.iter().copied()));
        let rated = request.nameplate.rating.map(|rating| BUS_OVER_VOLTAGE * rating.voltage);
        let seen = || largest(&mut columns.ud.iter().zip(&columns.uq).map(|(d, q)| d.hypot(*q))).map(|most| BUS_OVER_VOLTAGE * most);
        let bus = measured.or(rated).or_else(seen).unwrap_or(0.0);
        let carrier = if log.is_control_rate() { 1.0 / log.slowest_period() } else { USUAL_CARRIER };
        let largest = 4.0 / PI * bus * (LONGEST_DEAD_TIME * carrier + LARGEST_DROP);
        let are_exact = request.voltage_accuracy == 0.0 || log.is_short_circuit();
        Self { expected: 0.0, standard_error: if are_exact { 0.0 } else { 0.5 * largest }, bus, carrier }
    }

    /// The same, sharpened by what the points' harmonics say.
    pub(crate) fn with_harmonics(self, harmonics: &[Option<Harmonic>]) -> Self {
        let seen: Vec<f64> = harmonics.iter().flatten().filter(|harmonic| harmonic.stands_out).map(|harmonic| harmonic.loss).collect();
        let (expected, standard_error) = match seen.len() {
            0 => {
                // A harmonic that does not show bounds the loss, the more points the better.
                let weight = harmonics.iter().flatten().fold(0.0, |sum, harmonic| sum + harmonic.loss.hypot(harmonic.noise).powi(-2));
                (0.0, weight.sqrt().recip())
            }
            count => {
                let mean = seen.iter().sum::<f64>() / count as f64;
                (OF_HARMONIC.0 * mean, OF_HARMONIC.1 * mean)
            }
        };
        if standard_error < self.standard_error { Self { expected, standard_error, ..self } } else { self }
    }

    /// Whether a loss at a point would make a harmonic: not while the ripple changes the current's sign in most of the periods.
    pub(crate) fn would_show(&self, point: &OperatingPoint, inductance: Dq) -> bool {
        point.current().magnitude() > BEYOND_RIPPLE * self.ripple(inductance)
    }

    /// The current, A, up to which a phase loses in proportion to it: the ripple to either side.
    fn ripple(&self, inductance: Dq) -> f64 {
        RIPPLE * self.bus / (0.5 * (inductance.d + inductance.q) * self.carrier)
    }

    /// The unknowns of these points; `loss`: the size of V_1, V, as far as it is known.
    pub(crate) fn losses(&self, points: &[OperatingPoint], loss: f64, inductance: Dq) -> Vec<Loss> {
        let Self { expected, standard_error, carrier, .. } = *self;
        if standard_error <= 0.0 {
            return Vec::new();
        }
        let width = self.ripple(inductance);
        let largest = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
        // Noise around no current has no direction along which a voltage could be lost.
        let direction = |i: Dq| if i.magnitude() < NO_CURRENT * largest { Dq::default() } else { along(i) };
        let each = |voltage: &dyn Fn(Dq, &OperatingPoint) -> [f64; 2]| {
            points.iter().map(|point| voltage(direction(point.current()), point)).collect::<Vec<_>>()
        };
        let part = Part::DeadTime;
        let losses = [
            Loss { voltages: each(&|along, _| [along.d, along.q]), expected, standard_error, part },
            Loss {
                voltages: each(&|along, point| [-along.q, along.d].map(|part| part * point.omega_e() / carrier)),
                expected: 0.0,
                standard_error: loss,
                part,
            },
            Loss {
                voltages: each(&|along, point| [along.d, along.q].map(|part| -part * lacking(width, point.current().magnitude()))),
                expected: 0.0,
                standard_error: loss,
                part,
            },
        ];
        losses.into_iter().filter(|one| one.standard_error > 0.0).collect()
    }
}

/// By how many volts each row's loss may differ from what a fit of simulated currents makes of it.
pub(super) fn misshapen_in_rows(log: &Log, reading: VoltageTiming, loss: &DeadTime) -> VoltageAccuracy {
    // In rows that are the drive's own periods, the loss is computed edge by edge.
    if reading.is_unusual() || !log.is_control_rate() {
        VoltageAccuracy { volts: misshapen_if_fitted(loss.voltage), ..VoltageAccuracy::default() }
    } else if loss.lasting > 0.0 && loss.lasting < 1.0 {
        VoltageAccuracy { across: ACROSS_BESIDE_DROPS * 4.0 / PI * loss.voltage.abs(), ..VoltageAccuracy::default() }
    } else {
        VoltageAccuracy::default()
    }
}

/// By how many volts each operating point's loss may differ from its unknowns, if simulated currents found that each phase loses this
/// voltage, V.
pub(super) fn misshapen_if_fitted(voltage: f64) -> f64 {
    MISSHAPEN * 4.0 / PI * voltage.abs()
}

/// The voltage, V, that an observer corrects from row to row beside a loss, given what is left of the currents, A. It may be a part of the
/// loss that the model lacks. Noise averages out over an operating point; such a part does not.
pub(super) fn corrected_by_observer(log: &Log, drive: &Adjustable, residual_rms: Dq) -> f64 {
    let Adjustable { motor, faults: Faults { dead_time, disturbance, .. } } = drive;
    if dead_time.voltage == 0.0 || disturbance.is_small() {
        return 0.0;
    }
    let linkage = Dq { d: disturbance.gain.d * residual_rms.d * motor.ld, q: disturbance.gain.q * residual_rms.q * motor.lq };
    FRAC_1_SQRT_2 * linkage.magnitude() / log.slowest_period()
}

/// By how many volts each point's loss may differ from these unknowns, where rows come slower than drives control; where they do not,
/// simulated currents tell its shape. All but the first of the unknowns are priors of its size, which comes out larger than any loss where
/// something else bends it.
pub(super) fn misshapen(points: &[OperatingPoint], losses: &[Loss]) -> f64 {
    let periods = points.iter().map(|point| (point.time.1 - point.time.0) / point.rows.len().saturating_sub(1).max(1) as f64);
    if periods.fold(0.0, f64::max) * CONTROL_RATE <= 1.0 {
        return 0.0;
    }
    let mut of_loss = losses.iter().filter(|loss| loss.part == Part::DeadTime);
    let largest = of_loss.next().map_or(0.0, |loss| loss.expected.abs() + 2.0 * loss.standard_error);
    MISSHAPEN * of_loss.next_back().map_or(0.0, |loss| loss.standard_error.min(largest))
}

/// The direction of a current; no current has none.
pub(crate) fn along(i: Dq) -> Dq {
    let magnitude = i.magnitude().max(f64::MIN_POSITIVE);
    Dq { d: i.d / magnitude, q: i.q / magnitude }
}

/// The fundamental of what the phases lose at a current, V, by simulated currents' dead time.
pub(super) fn fundamental(loss: &DeadTime, i: Dq) -> Dq {
    let volts = 4.0 / PI * loss.voltage * (1.0 - lacking(loss.width.abs().max(loss.least_width), i.magnitude()));
    let Dq { d, q } = along(i);
    Dq { d: volts * d, q: volts * q }
}

/// The part that the fundamental of the loss lacks where each phase loses in proportion up to `width`, A, and a constant voltage from
/// there on; for phase currents of this amplitude, A. The describing function of a saturation.
fn lacking(width: f64, amplitude: f64) -> f64 {
    let part = amplitude / width;
    let has = if part.is_nan() || part == f64::INFINITY {
        1.0
    } else if part <= 1.0 {
        FRAC_PI_4 * part
    } else {
        0.5 * (part * (1.0 / part).asin() + (1.0 - (1.0 / part).powi(2)).sqrt())
    };
    1.0 - has
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{log::Columns, objective::acting_voltage::VoltageFrame};

    /// Of 1.5 V, 4/pi of a half per cent; of dead time or drops alone nothing, and of rows far apart a whole per cent along both axes.
    #[test]
    fn drops_beside_dead_time_are_in_doubt_across_the_current() {
        let log = |period: f64| {
            let t: Vec<f64> = (0..20).map(|row| period * f64::from(row)).collect();
            let alike: Vec<f64> = (0..20).map(|row| 1.0 + f64::from(row)).collect();
            let [ud, uq, id, iq, omega_e] = std::array::from_fn(|_| alike.clone());
            Log::new(Columns { t, ud, uq, id, iq, omega_e, ..Columns::default() }).unwrap()
        };
        let reading = VoltageTiming::Delayed { delay: 1, frame: VoltageFrame::Middle };
        let lost = |period: f64, lasting: f64| {
            misshapen_in_rows(&log(period), reading, &DeadTime { voltage: 1.5, lasting, ..DeadTime::default() })
        };
        assert_eq!([lost(1e-4, 0.0), lost(1e-4, 1.0)], [VoltageAccuracy::default(); 2]);
        let beside = lost(1e-4, 0.3);
        assert!((beside.across - 4.0 / PI * 0.0075).abs() < 1e-12 && beside.volts == 0.0, "{beside:?}");
        let far = lost(0.01, 0.3);
        assert!((far.volts - 4.0 / PI * 0.015).abs() < 1e-12 && far.across == 0.0, "{far:?}");
    }

    /// The fundamental by summing up a turn, over that of a square wave.
    #[test]
    fn what_a_ramp_lacks_is_what_a_sum_over_a_turn_says() {
        for (width, amplitude) in [(1.0, 0.3), (1.0, 1.0), (1.0, 1.2), (1.0, 4.0), (2.0, 100.0)] {
            const STEPS: u32 = 100_000;
            let fundamental: f64 = (0..STEPS)
                .map(|k| {
                    let cos = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(STEPS)).cos();
                    (amplitude * cos / width).clamp(-1.0, 1.0) * cos * 2.0 / f64::from(STEPS)
                })
                .sum();
            assert!((lacking(width, amplitude) - (1.0 - fundamental / (4.0 / PI))).abs() < 1e-6, "{width} {amplitude}");
        }
        assert!(lacking(0.0, 1.0).abs() < f64::EPSILON && lacking(0.0, 0.0).abs() < f64::EPSILON);
    }

    /// 310 V, 3 us at 10 kHz and 2 %: 15.5 V, as a fundamental 19.7 V, half of which is the standard error. Two harmonics of the size of
    /// their noise, 1 V each, are 2 V² each: together 1 V. One that stands out is itself.
    #[test]
    fn harmonics_sharpen_what_is_possible() {
        let possible = LossPrior { expected: 0.0, standard_error: 9.87, bus: 310.0, carrier: 1e4 };
        assert_eq!(possible.with_harmonics(&[None, None]), possible);
        assert_eq!(possible.with_harmonics(&[]), possible);
        let harmonic = |loss: f64, stands_out: bool| Some(Harmonic { loss, noise: 1.0, stands_out });
        let quiet = possible.with_harmonics(&[harmonic(1.0, false), None, harmonic(1.0, false)]);
        assert!(quiet.expected == 0.0 && (quiet.standard_error - 1.0).abs() < 1e-12, "{quiet:?}");
        let seen = possible.with_harmonics(&[harmonic(8.0, true), harmonic(1.0, false)]);
        assert!((seen.expected - 6.0).abs() < 1e-12 && (seen.standard_error - 2.8).abs() < 1e-12, "{seen:?}");
    }

    #[test]
    fn what_is_possible_follows_from_the_log() {
        let columns = |period: f64, u_dc: Option<f64>| {
            let each = |value: f64| vec![value; 100];
            crate::log::Columns {
                t: (0..100).map(|k| f64::from(k) * period).collect(),
                ud: each(30.0),
                uq: each(40.0),
                id: each(0.0),
                iq: each(5.0),
                omega_e: each(100.0),
                u_dc: u_dc.map(each),
                ..crate::log::Columns::default()
            }
        };
        let request = Request::default();
        for (period, u_dc, expected) in
            [(1e-4, Some(310.0), 0.5 * 4.0 / PI * 310.0 * (0.03 + 0.02)), (1e-2, None, 0.5 * 4.0 / PI * 100.0 * (0.06 + 0.02))]
        {
            let log = Log::new(columns(period, u_dc)).unwrap();
            let possible = LossPrior::possible(&log, &request);
            assert!((possible.standard_error / expected - 1.0).abs() < 1e-6, "{possible:?} {expected}");
            let exact = Request { voltage_accuracy: 0.0, ..request.clone() };
            assert_eq!(LossPrior::possible(&log, &exact).standard_error, 0.0);
        }
    }
}

//! Trying a measurement before it is promised: the log with what the measurement would add is identified as the log itself was.
//!
//! So the promise has the misfit, the terms and the doubts that are left after it. A prior is given with the value that came out, and,
//! where that is uncertain, with a smaller one as well: what dead time and devices take looks like resistance. A stretch is made of rows
//! that the log has: those of the operating point of largest current, with their noise and ripple, moved to other currents or another
//! speed. At the same speed the equations of the motor are linear, so that such rows are as good a solution as those that were measured;
//! what dead time takes is moved with the currents.

use super::{
    super::{
        fit::finding::Bench,
        judge::verdict::{IDENTIFIED, WEAK},
        request::{Known, Request},
    },
    measurement::{Measurement, Place, Promised},
    promising::promising,
};
use crate::{
    faults::Faults,
    frames::{Abc, Dq},
    log::{Columns, Log},
    motor::{Motor, PARAMETERS, Parameter},
    objective::acting_voltage::VoltageTiming,
    parallel,
    steady::{
        OperatingPoint,
        windows::{MIN_ROWS, TimeWindow},
    },
};
use std::f64::consts::FRAC_PI_4;

/// Most measurements that are tried for a parameter.
const MOST_TRIED: usize = 3;

/// What leaves more than this part of the interval that there is now is not worth proposing.
const WORTH: f64 = 0.5;

/// The same of what makes the parameter identified: then it is worth more.
const WORTH_IF_IDENTIFIED: f64 = 0.8;

/// Most rows of a log that is identified again: twice the time of an answer that takes a second.
const MOST_ROWS: usize = 100_000;

/// Most identifications of one log, so that an answer takes a few times as long as without a remedy.
const MOST_TRIALS: usize = 4;

/// R_s of which nothing is known takes this part of the voltage along q: as much as there may be, so that a promise is not too good.
const LARGEST_PART: f64 = 0.3;

/// R_s with a larger standard error than this part of it may come out much smaller when it is measured.
const UNCERTAIN: f64 = 0.2;

/// But not below this part of what came out.
const SMALLEST_PART: f64 = 0.5;

/// What stands between the log and its motor, as far as a moved stretch needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Losses {
    /// Of the simulated currents; none if the operating points answer.
    pub(crate) faults: Faults,
    /// The voltage, V, that operating points lose along their current.
    pub(crate) along_current: f64,
    /// The only timing of the voltage columns that is possible: no other needs to be tried again.
    pub(crate) timing: Option<VoltageTiming>,
}

/// Half-widths of another log's parameters, or of another request's, as fractions of their values; infinite where there is none.
pub(crate) type Identify<'a> = &'a (dyn Fn(&Log, &Request) -> Option<[f64; PARAMETERS]> + Sync);

/// A measurement that was tried, and the half-widths of all parameters after it; none if it cannot be tried.
type Done = (Measurement, Option<[f64; PARAMETERS]>);

/// A log on which measurements are tried.
pub(crate) struct Trials<'a> {
    pub(crate) log: &'a Log,
    pub(crate) request: &'a Request,
    pub(crate) bench: &'a Bench,
    /// In the log.
    pub(crate) points: &'a [OperatingPoint],
    pub(crate) losses: Losses,
    /// Standard error of R_s, ohm, of all that is counted.
    rs_error: f64,
    pub(crate) identify: Identify<'a>,
    done: Vec<Done>,
    /// Tried beside others, and not asked for yet.
    ahead: Vec<Done>,
}

impl<'a> Trials<'a> {
    pub(crate) fn new(
        (log, request): (&'a Log, &'a Request),
        bench: &'a Bench,
        points: &'a [OperatingPoint],
        losses: Losses,
        rs_error: f64,
        identify: Identify<'a>,
    ) -> Self {
        Self { log, request, bench, points, losses, rs_error, identify, done: Vec::new(), ahead: Vec::new() }
    }

    /// What to measure for a parameter, and what it would bring; nothing, where nothing proposed would help. Of what makes the parameter
    /// identified, the easiest; else the best.
    /// `of_gains`: what remains whatever is measured, as a standard error, SI; `now`: its half-width now, as a fraction.
    pub(super) fn best(&mut self, of_gains: f64, now: f64, parameter: Parameter) -> Option<Promised> {
        let mut best: Option<Promised> = None;
        let estimates: Vec<Promised> = promising(self.bench, self.lengths(), of_gains, parameter).into_iter().take(MOST_TRIED).collect();
        for (place, estimated) in estimates.iter().enumerate() {
            // Mostly the first is enough. If not, the others are tried side by side.
            if place == 1 {
                self.try_ahead(estimates[1..].iter().map(|other| other.measurement));
            }
            let Some(half_width) = self.half_width(estimated.measurement, parameter) else { continue };
            if best.is_none_or(|best| half_width < best.half_width) {
                best = Some(Promised { half_width, ..*estimated });
            }
            if half_width <= IDENTIFIED {
                break;
            }
        }
        let is_worth_it = |best: &Promised| {
            let part = if best.half_width <= IDENTIFIED { WORTH_IF_IDENTIFIED } else { WORTH };
            best.half_width < (part * now).min(WEAK)
        };
        best.filter(is_worth_it)
    }

    /// From which length to which a stretch fits the log's own operating points, s: a shorter one would count as a pause between them, and
    /// beside a longer one they would.
    fn lengths(&self) -> (f64, f64) {
        let lengths = || self.points.iter().map(|point| point.time.1 - point.time.0);
        (lengths().fold(0.0, f64::max) / LONGER, lengths().fold(f64::INFINITY, f64::min) * LONGER)
    }

    /// Half-width of a parameter after a measurement, as a fraction; `None` if it cannot be tried.
    pub(super) fn half_width(&mut self, measurement: Measurement, parameter: Parameter) -> Option<f64> {
        let widths = known(&self.done, measurement).unwrap_or_else(|| {
            let room = self.room() > 0;
            let widths = if room { known(&self.ahead, measurement).unwrap_or_else(|| self.tried(measurement)) } else { None };
            self.done.push((measurement, widths));
            widths
        });
        widths.map(|widths| widths[parameter as usize])
    }

    /// How many more measurements may be tried.
    fn room(&self) -> usize {
        if self.log.rows() <= MOST_ROWS { MOST_TRIALS.saturating_sub(self.done.len()) } else { 0 }
    }

    /// Tries the new ones of these measurements on all cores.
    fn try_ahead(&mut self, measurements: impl Iterator<Item = Measurement>) {
        let is_new = |measurement: &Measurement| known(&self.done, *measurement).or(known(&self.ahead, *measurement)).is_none();
        let new: Vec<Measurement> = measurements.filter(is_new).take(self.room()).collect();
        let widths = parallel::map(&new, |measurement| self.tried(*measurement));
        self.ahead.extend(new.into_iter().zip(widths));
    }

    /// The measurements that were tried, with the half-widths of all parameters after each, as fractions.
    pub(super) fn outcomes(&self) -> impl Iterator<Item = (Measurement, [f64; PARAMETERS])> {
        self.done.iter().filter_map(|(measurement, widths)| Some((*measurement, (*widths)?)))
    }

    fn tried(&self, measurement: Measurement) -> Option<[f64; PARAMETERS]> {
        let mut request = Request { voltage_timing: self.request.voltage_timing.or(self.losses.timing), ..self.request.clone() };
        match measurement {
            Measurement::Resistance { accuracy } => {
                let rs = self.rs();
                let smaller = (self.rs_error > UNCERTAIN * rs).then(|| (rs - self.rs_error).max(SMALLEST_PART * rs));
                let each: Vec<f64> = std::iter::once(rs).chain(smaller).collect();
                let widths = parallel::map(&each, |rs| {
                    let mut request = request.clone();
                    request.known[Parameter::Rs as usize] = Known::Prior { value: *rs, standard_error: accuracy * rs };
                    (self.identify)(self.log, &request)
                });
                let widths: Vec<[f64; PARAMETERS]> = widths.into_iter().collect::<Option<_>>()?;
                Some(std::array::from_fn(|p| widths.iter().map(|widths| widths[p]).fold(0.0, f64::max)))
            }
            Measurement::Stretch { seconds, place, .. } => {
                let at = self.points.iter().max_by(|one, other| one.current().magnitude().total_cmp(&other.current().magnitude()))?;
                self.with(&mut request, &self.stretches(seconds, at, place)?)
            }
            Measurement::AllPoints { times } => self.with(&mut request, &self.all_points(times)?),
        }
    }

    /// Half-widths after these stretches were added.
    fn with(&self, request: &mut Request, stretches: &[Log]) -> Option<[f64; PARAMETERS]> {
        if !request.windows.is_empty() {
            request.windows.extend(stretches.iter().filter_map(times));
        }
        let joined = Log::join(std::iter::once(self.log).chain(stretches).cloned()).ok()?;
        (self.identify)(&joined, request)
    }

    /// R_s, ohm: what came out, or a guess.
    fn rs(&self) -> f64 {
        let rs = self.bench.motor.rs;
        if rs > 0.0 { rs } else { LARGEST_PART * self.bench.voltage / self.bench.current() }
    }

    /// Stretches that last so long together, s, each as long as the operating point of largest current or shorter.
    fn stretches(&self, seconds: f64, at: &OperatingPoint, place: Place) -> Option<Vec<Log>> {
        let from = at.current();
        let (to, times) = match place {
            Place::Id(id) => (Dq { d: id, ..from }, 1.0),
            Place::HalfLoad { iq } => (Dq { q: iq, ..from }, 1.0),
            Place::HalfSpeed => (from, 0.5),
        };
        let moved = self.moved(at, to, times)?;
        let rows = (seconds / self.bench.sample_period).round() as usize;
        let period = self.bench.sample_period;
        let mut begin = self.log.columns().t.last()? + GAP * period;
        let mut logs = Vec::new();
        let mut left = rows;
        while left >= MIN_ROWS.min(rows) && left > 0 {
            let length = left.min(at.rows.len());
            let part = part(&moved, length, begin);
            begin = part.t.last()? + GAP * period;
            logs.push(Log::new(part).ok()?);
            left -= length;
        }
        (!logs.is_empty()).then_some(logs)
    }

    /// Each operating point once more, so many times as fast.
    fn all_points(&self, times: f64) -> Option<Vec<Log>> {
        let gap = GAP * self.bench.sample_period;
        let mut begin = self.log.columns().t.last()? + gap;
        let mut logs = Vec::new();
        for point in self.points {
            let part = part(&self.moved(point, point.current(), times)?, point.rows.len(), begin);
            begin = part.t.last()? + gap;
            logs.push(Log::new(part).ok()?);
        }
        (!logs.is_empty()).then_some(logs)
    }

    /// The rows of an operating point, moved to other currents, and to so many times its speed.
    fn moved(&self, at: &OperatingPoint, to: Dq, times: f64) -> Option<Columns> {
        let (from, omega_e) = (at.current(), at.omega_e());
        let motor = Motor { rs: self.rs(), ..self.bench.motor };
        // At the same speed the flux induces the same.
        let motor = if times == 1.0 { Motor { psi_f: 0.0, ..motor } } else { motor };
        let Faults { angle_offset, angle_delay, voltage_lag, .. } = self.losses.faults;
        let voltage = |i: Dq, omega_e: f64| {
            let too_large = angle_offset.angle - omega_e * angle_delay.time;
            motor.steady_voltage(i.turned(too_large), omega_e).turned(omega_e * voltage_lag.time - too_large)
        };
        let (before, after) = (voltage(from, omega_e), voltage(to, times * omega_e));
        let step = Dq { d: after.d - before.d, q: after.q - before.q };
        if !(step.d.is_finite() && step.q.is_finite()) {
            return None;
        }
        let mut columns = self.log.columns().of_rows(at.rows.clone());
        let u = at.voltage();
        if times > 1.0 && !self.can_make((u.d + step.d).hypot(u.q + step.q), columns.u_dc.as_deref()) {
            return None;
        }
        let begin = columns.t[0];
        let first = columns.theta_e.as_ref().map(|theta_e| theta_e[0]);
        for k in 0..columns.t.len() {
            let theta_e = columns.theta_e.as_ref().map(|theta_e| theta_e[k]);
            let turned_to = first.filter(|_| times != 1.0).map(|first| first + times * omega_e * (columns.t[k] - begin)).or(theta_e);
            let i = Dq { d: columns.id[k], q: columns.iq[k] };
            let other = Dq { d: i.d + to.d - from.d, q: i.q + to.q - from.q };
            let (lost, loses) = (self.loss(i, theta_e), self.loss(other, turned_to));
            columns.ud[k] += step.d + loses.d - lost.d;
            columns.uq[k] += step.q + loses.q - lost.q;
            (columns.id[k], columns.iq[k]) = (other.d, other.q);
            columns.omega_e[k] *= times;
            if let (Some(column), Some(turned_to)) = (columns.theta_e.as_mut(), turned_to) {
                column[k] = turned_to;
            }
        }
        Some(columns)
    }

    /// Whether the inverter can make this voltage, V, of its DC voltage; where that is not logged, it is sure of the log's own voltages.
    fn can_make(&self, voltage: f64, u_dc: Option<&[f64]>) -> bool {
        let most = u_dc.map_or(self.bench.voltage, |u_dc| u_dc.iter().sum::<f64>() / u_dc.len() as f64 / 3.0_f64.sqrt());
        voltage <= most
    }

    /// What dead time and devices take at a current, V; of an unknown angle its mean over a turn. Ripple is left out: only the difference
    /// between two currents at one speed counts, and their ripple is nearly the same.
    fn loss(&self, i: Dq, theta_e: Option<f64>) -> Dq {
        let dead_time = self.losses.faults.dead_time;
        let magnitude = i.magnitude();
        if magnitude == 0.0 {
            return Dq::default();
        }
        let along = |volts: f64| Dq { d: volts * i.d / magnitude, q: volts * i.q / magnitude };
        match theta_e {
            Some(theta_e) if dead_time.voltage != 0.0 => {
                let ramp = |i: f64| dead_time.voltage * (i / dead_time.width.abs().max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
                let phases = i.to_alpha_beta(theta_e).to_abc();
                Abc { a: ramp(phases.a), b: ramp(phases.b), c: ramp(phases.c) }.to_alpha_beta().to_dq(theta_e)
            }
            _ => along(dead_time.voltage / FRAC_PI_4 + self.losses.along_current),
        }
    }
}

/// What is known of a measurement.
fn known(done: &[Done], measurement: Measurement) -> Option<Option<[f64; PARAMETERS]>> {
    done.iter().find(|(other, _)| *other == measurement).map(|(_, widths)| *widths)
}

/// Sample periods between the log and a stretch, and between stretches: more than a lost row.
const GAP: f64 = 100.0;

/// How many times longer than another window the longest may be, so that both are operating points.
const LONGER: f64 = 4.0;

/// So many rows from the first on, which begin at a time, s.
fn part(columns: &Columns, rows: usize, begin: f64) -> Columns {
    let mut part = columns.of_rows(0..rows.min(columns.t.len()));
    let by = begin - part.t.first().copied().unwrap_or_default();
    part.t.iter_mut().for_each(|t| *t += by);
    part
}

/// The whole of a log as a window.
fn times(log: &Log) -> Option<TimeWindow> {
    let t = &log.columns().t;
    Some(TimeWindow { from: *t.first()?, to: *t.last()? })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::faults::{angle_offset::AngleOffset, dead_time::DeadTime};
    use std::sync::Mutex;

    pub(crate) const ROWS: usize = 200;

    const MOTOR: Motor = Motor { rs: 0.5, ld: 4e-3, lq: 7e-3, psi_f: 0.1 };
    const OMEGA: f64 = 300.0;

    /// Of a perfect drive.
    pub(crate) fn none() -> Losses {
        Losses { faults: Faults::default(), along_current: 0.0, timing: None }
    }

    /// A motor held at a current and speed, with an angle.
    pub(crate) fn held(motor: &Motor, i: Dq, omega_e: f64) -> Log {
        log_of(i, omega_e, |_| motor.steady_voltage(i, omega_e))
    }

    fn log_of(i: Dq, omega_e: f64, u: impl Fn(f64) -> Dq) -> Log {
        let mut columns = Columns { theta_e: Some(Vec::new()), ..Columns::default() };
        for row in 0..ROWS {
            let t = row as f64 * 1e-4;
            // No phase current is zero at the first row.
            let theta_e = 0.1 + omega_e * t;
            let u = u(theta_e);
            columns.t.push(t);
            columns.ud.push(u.d);
            columns.uq.push(u.q);
            columns.id.push(i.d);
            columns.iq.push(i.q);
            columns.omega_e.push(omega_e);
            columns.theta_e.get_or_insert_default().push(theta_e);
        }
        Log::new(columns).unwrap()
    }

    fn bench() -> Bench {
        let held = vec![(Dq { d: 0.0, q: 10.0 }, OMEGA)];
        let covariance = nalgebra::Matrix4::identity();
        Bench {
            motor: MOTOR,
            covariance,
            held,
            row_variance: 0.0,
            sample_period: 1e-4,
            voltage: 40.0,
            voltage_accuracy: 0.0,
            is_at_rest: false,
        }
    }

    /// The log that is identified after 0.01 s at a place; nothing if it cannot be held there.
    fn tried(log: &Log, losses: Losses, place: Place) -> Option<Log> {
        tried_measurement(log, losses, Measurement::Stretch { seconds: 0.01, place, omega_e: None })
    }

    fn tried_measurement(log: &Log, losses: Losses, measurement: Measurement) -> Option<Log> {
        let seen = Mutex::new(None);
        let identify = |log: &Log, _: &Request| {
            *seen.lock().unwrap() = Some(log.clone());
            Some([0.1; PARAMETERS])
        };
        let (request, bench) = (Request::default(), bench());
        let points = [OperatingPoint::measure(log, 0..ROWS, None)];
        let mut trials = Trials::new((log, &request), &bench, &points, losses, 0.0, &identify);
        let half_width = trials.half_width(measurement, Parameter::Ld);
        assert_eq!(half_width, seen.lock().unwrap().as_ref().map(|_| 0.1));
        seen.into_inner().unwrap()
    }

    /// The rows that were added are what the motor's own equations, and what is lost beside them, say there.
    fn assert_added(log: &Log, i: Dq, omega_e: f64, u: impl Fn(f64) -> Dq) {
        assert_eq!((log.rows(), log.segments().len()), (ROWS + 100, 2));
        assert_held(log, i, omega_e, u);
    }

    fn assert_held(log: &Log, i: Dq, omega_e: f64, u: impl Fn(f64) -> Dq) {
        let columns = log.columns();
        for row in ROWS..log.rows() {
            let expected = u(columns.theta_e.as_ref().unwrap()[row]);
            assert!((columns.ud[row] - expected.d).hypot(columns.uq[row] - expected.q) < 1e-9, "{row}: {expected:?}");
            assert!((columns.id[row] - i.d).hypot(columns.iq[row] - i.q) < 1e-12 && columns.omega_e[row] == omega_e, "{row}");
        }
    }

    #[test]
    fn a_moved_stretch_obeys_the_motors_equations() {
        let log = held(&MOTOR, Dq { d: 0.0, q: 10.0 }, OMEGA);
        for (place, i, omega_e) in [
            (Place::Id(-2.0), Dq { d: -2.0, q: 10.0 }, OMEGA),
            (Place::HalfLoad { iq: 5.0 }, Dq { d: 0.0, q: 5.0 }, OMEGA),
            (Place::HalfSpeed, Dq { d: 0.0, q: 10.0 }, 0.5 * OMEGA),
        ] {
            assert_added(&tried(&log, none(), place).unwrap(), i, omega_e, |_| MOTOR.steady_voltage(i, omega_e));
        }
    }

    /// By hand: at 600 rad/s and 10 A along q are u_d = -42 V and u_q = 65 V, 77.4 V together; of 150 V the inverter makes 86.6 V, of 130 V
    /// 75.1 V, and without a DC voltage it is sure of the 40 V of the log.
    #[test]
    fn a_faster_motor_is_tried_where_the_inverter_has_the_voltage() {
        let i = Dq { d: 0.0, q: 10.0 };
        let log = held(&MOTOR, i, OMEGA);
        let with = |u_dc: f64| Log::new(Columns { u_dc: Some(vec![u_dc; ROWS]), ..log.columns().clone() }).unwrap();
        let tried = |log: &Log| tried_measurement(log, none(), Measurement::AllPoints { times: 2.0 });
        let faster = tried(&with(150.0)).unwrap();
        // The one point of the log, whole.
        assert_eq!(faster.rows(), 2 * ROWS);
        assert_held(&faster, i, 2.0 * OMEGA, |_| MOTOR.steady_voltage(i, 2.0 * OMEGA));
        assert_eq!((tried(&with(130.0)), tried(&log)), (None, None));
    }

    /// Dead time of 2 V a phase, all of it from the least current on, and an angle that is read 0.1 rad too large: the motor's own frame
    /// lies back by that.
    #[test]
    fn a_moved_stretch_has_the_faults_of_the_log() {
        let voltage = |i: Dq, theta_e: f64| {
            let (sin, cos) = 0.1_f64.sin_cos();
            let in_motor = Dq { d: i.d * cos - i.q * sin, q: i.q * cos + i.d * sin };
            let u = MOTOR.steady_voltage(in_motor, OMEGA);
            let phases = i.to_alpha_beta(theta_e).to_abc();
            let loss = Abc { a: 2.0 * phases.a.signum(), b: 2.0 * phases.b.signum(), c: 2.0 * phases.c.signum() };
            let loss = loss.to_alpha_beta().to_dq(theta_e);
            Dq { d: u.d * cos + u.q * sin + loss.d, q: u.q * cos - u.d * sin + loss.q }
        };
        let (from, to) = (Dq { d: 0.0, q: 10.0 }, Dq { d: -3.0, q: 10.0 });
        let log = log_of(from, OMEGA, |theta_e| voltage(from, theta_e));
        let dead_time = DeadTime { voltage: 2.0, ..DeadTime::default() };
        let losses = Losses { faults: Faults { dead_time, angle_offset: AngleOffset { angle: 0.1 }, ..Faults::default() }, ..none() };
        assert_added(&tried(&log, losses, Place::Id(-3.0)).unwrap(), to, OMEGA, |theta_e| voltage(to, theta_e));
    }

    /// By noise alone a multimeter would leave 0.2 % of psi_f. What is left when it is tried is promised; and if that is no half of what
    /// there is, nothing is.
    #[test]
    fn what_is_promised_is_what_a_trial_leaves() {
        let direction = nalgebra::Vector4::new(1.0, 0.0, 0.0, -8.0 / 400.0);
        let motor = Motor { rs: 1.0, ld: 5e-3, lq: 10e-3, psi_f: 0.2 };
        let held_at = vec![(Dq { d: 0.0, q: 8.0 }, 400.0)];
        let bench = Bench { motor, covariance: direction * direction.transpose(), held: held_at, voltage_accuracy: 1e-6, ..bench() };
        let log = held(&motor, Dq { d: 0.0, q: 8.0 }, 400.0);
        let request = Request::default();
        let tried = |log: &Log, request: &Request| {
            let is_prior = request.known[0] == Known::Prior { value: 1.0, standard_error: 0.01 };
            Some(if is_prior && log.rows() == ROWS { [0.02, 1.0, 1.0, 0.19] } else { [0.5; 4] })
        };
        let promised = |now: f64, rs_error: f64| {
            let mut trials = Trials::new((&log, &request), &bench, &[], none(), rs_error, &tried);
            trials.best(0.0, now, Parameter::PsiF)
        };
        let measurement = Measurement::Resistance { accuracy: 0.01 };
        assert_eq!(promised(0.5, 0.0), Some(Promised { measurement, parameter: Parameter::PsiF, half_width: 0.19 }));
        assert_eq!(promised(0.3, 0.0), None);
        // A resistance that may be smaller does not keep what this one promises.
        assert_eq!(promised(0.5, 0.3), None);
    }
}

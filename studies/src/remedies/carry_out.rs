//! Carrying out a remedy: the drive as it was, with what the remedy says.

use fluxfit::{
    Also, Answer, Known, Log, MeansOf, Measurement, Model, Parameter, Place, Remedy, Request, VoltageTiming, frames::Dq, identify,
    optimizer::Draws,
};
use fluxfit_drive::{
    Scenario,
    scenario::LoggedRows,
    schedule::{Profile, Ramp},
    simulate,
};

/// Time that a change of the speed takes, as a fraction of the log, as in the courses.
const RUN_UP: f64 = 0.05;
/// How long to hold what is to be added where a remedy does not say it, s; and at least as a fraction of the log.
const HOLD: f64 = 0.2;
/// Of a prior that is to be sharper, and of a multimeter, as a fraction.
const MULTIMETER: f64 = 0.01;
/// The i_d that is a larger step, as a part of the current.
const LARGER_STEP: f64 = -0.4;
/// Longest drive that is simulated, as samples: 5 s at 20 kHz are 100 000.
const MOST_SAMPLES: f64 = 1.2e5;

/// A drive whose log is identified.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// What it is.
    pub name: String,
    /// The drive.
    pub scenario: Scenario,
    /// The time before its log begins, s.
    pub unlogged: f64,
    /// The stream of its noise, and of what a multimeter errs.
    pub draw: u64,
    /// What is asked.
    pub request: Request,
}

impl Case {
    /// The answer.
    ///
    /// # Errors
    /// If the drive trips, or the log has no answer.
    pub fn answer(&self) -> Result<Answer, String> {
        let mut columns = simulate(&self.scenario, self.draw, || ()).map_err(|error| error.to_string())?.columns;
        let first = columns.t.partition_point(|t| *t < self.unlogged);
        let all = [&mut columns.t, &mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq, &mut columns.omega_e];
        all.into_iter().chain(&mut columns.theta_e).chain(&mut columns.u_dc).for_each(|column| {
            column.drain(..first);
        });
        let log = Log::new(columns).map_err(|error| error.to_string())?;
        identify(&log, &self.request).map_err(|error| error.to_string())
    }

    /// The same drive with the remedy for a parameter of this answer; `None` if a simulation cannot do what it says.
    pub fn with(&self, remedy: &Remedy, answer: &Answer) -> Option<Self> {
        let mut case = self.clone();
        let (at, omega_e) = loaded(answer).unwrap_or_else(|| self.heaviest());
        let step = |id: f64| Dq { d: id, ..at };
        match remedy {
            Remedy::Measure(promised) => match promised.measurement {
                Measurement::Resistance { accuracy } => case.give_rs(accuracy),
                Measurement::AllPoints { times } => {
                    for point in answer.identification.operating_points() {
                        case.hold(point.current(), times * point.omega_e(), point.time.1 - point.time.0);
                    }
                }
                Measurement::Stretch { seconds, place, .. } => match place {
                    Place::Id(id) => case.hold(step(id), omega_e, seconds),
                    Place::HalfLoad { iq } => case.hold(Dq { q: iq, ..at }, omega_e, seconds),
                    Place::HalfSpeed => case.hold(at, 0.5 * omega_e, seconds),
                    _ => return None,
                },
                _ => return None,
            },
            Remedy::AddStretch { id, also } => {
                case.hold(step(*id), omega_e, HOLD);
                if *also == Some(Also::AndSecondPoint) {
                    case.hold(Dq { q: 0.5 * at.q, ..at }, 0.5 * omega_e, HOLD);
                }
            }
            Remedy::HoldLonger { times, .. } => case.lengthen(*times),
            Remedy::SpreadPoints { parameter } => match parameter {
                Parameter::Rs => case.give_rs(MULTIMETER),
                Parameter::Ld => case.hold(step(LARGER_STEP * at.magnitude()), omega_e, HOLD),
                Parameter::Lq => case.hold(Dq { q: 1.5 * at.q, ..at }, omega_e, HOLD),
                Parameter::PsiF => case.hold(at, 0.5 * omega_e, HOLD),
            },
            // Of every n-th row the timing is none of those that can be stated.
            Remedy::StateVoltageTiming if self.scenario.logging.every == 1 => case.request.voltage_timing = Some(VoltageTiming::Centered),
            Remedy::StateVoltageTiming if self.scenario.logging.rows == LoggedRows::Mean => {
                case.request.voltage_timing = Some(VoltageTiming::Averaged { of: MeansOf::Voltages });
            }
            Remedy::CompensateDeadTime { .. } => {
                let inverter = &mut case.scenario.inverter;
                (inverter.dead_time, inverter.switch_drop, inverter.diode_drop) = (0.0, 0.0, 0.0);
            }
            Remedy::CalibrateSensors => {
                (case.scenario.sensors.current_gain, case.scenario.sensors.current_offset) = ([1.0; 3], [0.0; 3]);
            }
            // The simulated bench is at rest; the other half of the advice is left.
            Remedy::RemoveDisturbances => {
                case.hold(at, omega_e, HOLD);
                case.hold(step(LARGER_STEP * at.magnitude()), omega_e, HOLD);
                case.hold(Dq { q: 0.5 * at.q, ..at }, omega_e, HOLD);
                case.hold(at, 0.5 * omega_e, HOLD);
                case.request.model = Some(Model::Steady);
            }
            Remedy::LogEachPeriod => (case.scenario.logging.every, case.scenario.logging.rows) = (1, LoggedRows::First),
            Remedy::SharperPrior => case.give_rs(MULTIMETER),
            _ => return None,
        }
        (case.scenario.duration * case.scenario.inverter.sample_rate() <= MOST_SAMPLES).then_some(case)
    }

    /// Holds currents, A, at a speed, electrical rad/s, for so long after the log.
    fn hold(&mut self, i: Dq, omega_e: f64, seconds: f64) {
        let Scenario { duration, schedule, motor, .. } = &mut self.scenario;
        let (end, over) = (*duration, RUN_UP * *duration);
        let to = |profile: &Profile, to: f64, over: f64| {
            Profile::new(profile.ramps().iter().copied().filter(|ramp| ramp.at < end).chain([Ramp { at: end, to, over }]).collect())
        };
        schedule.id = to(&schedule.id, i.d, 0.0);
        schedule.iq = to(&schedule.iq, i.q, 0.0);
        schedule.speed = to(&schedule.speed, omega_e / f64::from(motor.pole_pairs), over);
        *duration += over + seconds;
    }

    /// Holds everything so many times as long.
    fn lengthen(&mut self, times: f64) {
        let Scenario { duration, schedule, .. } = &mut self.scenario;
        for profile in [&mut schedule.id, &mut schedule.iq, &mut schedule.speed] {
            let later = |ramp: &Ramp| Ramp { at: times * ramp.at, over: times * ramp.over, ..*ramp };
            *profile = Profile::new(profile.ramps().iter().map(later).collect());
        }
        *duration = self.unlogged + times * (*duration - self.unlogged);
    }

    /// R_s as a multimeter says before the log: with its error, which is normal.
    fn give_rs(&mut self, accuracy: f64) {
        let error = accuracy * Draws::seeded(self.scenario.seed, self.draw + 1).normal();
        let value = self.scenario.motor.rs * (1.0 + error);
        self.request.known[Parameter::Rs as usize] = Known::Prior { value, standard_error: accuracy * value };
    }

    /// The largest currents of the schedule, and the speed there.
    fn heaviest(&self) -> (Dq, f64) {
        let Scenario { duration, schedule, motor, .. } = &self.scenario;
        let times = schedule.id.ramps().iter().chain(schedule.iq.ramps()).map(|ramp| ramp.at).filter(|t| t < duration);
        let point = |t: f64| (Dq { d: schedule.id.at(t), q: schedule.iq.at(t) }, schedule.speed.at(t) * f64::from(motor.pole_pairs));
        times.map(point).max_by(|(one, _), (other, _)| one.magnitude().total_cmp(&other.magnitude())).unwrap_or_default()
    }
}

/// The operating point of largest current, to which remedies refer, and its speed.
fn loaded(answer: &Answer) -> Option<(Dq, f64)> {
    let points = answer.identification.operating_points().iter();
    points.max_by(|one, other| one.current().magnitude().total_cmp(&other.current().magnitude())).map(|one| (one.current(), one.omega_e()))
}

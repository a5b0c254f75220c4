//! Courses: what the motor does while it is logged. Currents and speeds are fractions of the largest ones, times of the duration.

use super::{between, between_decades};
use fluxfit::optimizer::Draws;
use fluxfit_drive::{
    scenario::Schedule,
    schedule::{Profile, Ramp},
};

/// By how much the levels of a log's currents and speed are smaller than the course's: drawn between these factors.
const SMALLER: [f64; 2] = [0.75, 1.0];

/// Time that a step of a reference takes, as a fraction of the duration, and that of a change of the speed.
const STEP: f64 = 0.0;
const RUN_UP: f64 = 0.05;

/// What the motor does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Course {
    /// Steps of both currents at two speeds, with braking at the end.
    Staircase,
    /// One speed and load, first without and then with i_d.
    TwoPoints,
    /// Two loads at two speeds, without i_d.
    IdZero,
    /// Up to the full speed and back, with a square wave of i_d.
    Acceleration,
    /// Steps of both currents at low speed.
    Slow,
    /// Braking with steps of both currents.
    Regeneration,
}

/// Values from their times on.
type Levels = &'static [(f64, f64)];

impl Course {
    /// All.
    pub const ALL: [Self; 6] = [Self::Staircase, Self::TwoPoints, Self::IdZero, Self::Acceleration, Self::Slow, Self::Regeneration];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::Staircase => "staircase",
            Self::TwoPoints => "two points",
            Self::IdZero => "i_d = 0",
            Self::Acceleration => "acceleration",
            Self::Slow => "slow",
            Self::Regeneration => "regeneration",
        }
    }

    /// i_d, i_q and speed.
    fn levels(self) -> [Levels; 3] {
        match self {
            Self::Staircase => [
                &[(0.0, 0.0), (0.3, -0.4), (0.45, 0.0), (0.6, -0.35), (0.78, 0.0)],
                &[(0.02, 0.3), (0.2, 0.8), (0.4, 0.3), (0.7, 0.7), (0.82, 0.4), (0.9, -0.5)],
                &[(0.0, 0.27), (0.5, 1.0)],
            ],
            Self::TwoPoints => [&[(0.0, 0.0), (0.5, -0.4)], &[(0.02, 0.5)], &[(0.0, 0.6)]],
            Self::IdZero => [&[(0.0, 0.0)], &[(0.02, 0.3), (0.2, 0.8), (0.7, 0.4)], &[(0.0, 0.27), (0.4, 1.0)]],
            Self::Acceleration => [
                &[
                    (0.0, 0.0),
                    (0.1, -0.3),
                    (0.2, 0.0),
                    (0.3, -0.3),
                    (0.4, 0.0),
                    (0.52, -0.3),
                    (0.6, 0.0),
                    (0.7, -0.3),
                    (0.8, 0.0),
                    (0.9, -0.3),
                ],
                &[(0.02, 0.7), (0.56, -0.6)],
                &[(0.0, 0.08)],
            ],
            Self::Slow => [&[(0.0, 0.0), (0.25, -0.4), (0.75, 0.0)], &[(0.02, 0.3), (0.5, 0.7)], &[(0.0, 0.13)]],
            Self::Regeneration => [&[(0.0, 0.0), (0.15, -0.35), (0.45, 0.0)], &[(0.02, -0.3), (0.3, -0.7), (0.62, -0.5)], &[(0.0, 0.8)]],
        }
    }

    /// The course over a duration, s, with the largest current, A, and the full speed, mechanical rad/s, both made smaller at random.
    pub(super) fn drawn(self, duration: f64, current: f64, speed: f64, draws: &mut Draws) -> Schedule {
        let current = current * between(draws, SMALLER);
        self.schedule(duration, current, speed * between_decades(draws, SMALLER))
    }

    /// The course over a duration, s, with these for the largest current, A, and the full speed, mechanical rad/s.
    pub fn schedule(self, duration: f64, current: f64, speed: f64) -> Schedule {
        let [id, iq, speeds] = self.levels();
        let ramps = |levels: Levels, scale: f64, over: f64| -> Vec<Ramp> {
            let over = |at: f64| if at == 0.0 { 0.0 } else { over * duration };
            levels.iter().map(|(at, to)| Ramp { at: at * duration, to: to * scale, over: over(*at) }).collect()
        };
        let mut speeds = ramps(speeds, speed, RUN_UP);
        if self == Self::Acceleration {
            let slow = speeds.first().map_or(0.0, |ramp| ramp.to);
            speeds.push(Ramp { at: 0.1 * duration, to: speed, over: 0.4 * duration });
            speeds.push(Ramp { at: 0.58 * duration, to: slow, over: 0.4 * duration });
        }
        Schedule {
            id: Profile::new(ramps(id, current, STEP)),
            iq: Profile::new(ramps(iq, current, STEP)),
            speed: Profile::new(speeds),
            ..Schedule::default()
        }
    }
}

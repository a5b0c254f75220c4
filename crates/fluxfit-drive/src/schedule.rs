//! Schedules: what is asked of the drive, over time.

/// Times closer than this, s, are one: a sample at `3 / 10 kHz` and a move at 0.0003 s.
const ROUNDING: f64 = 1e-9;

/// A quantity that holds its value, and moves to others at given times. Zero before the first move.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Course(Vec<Move>);

/// A move to another value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// When it begins, s.
    pub at: f64,
    /// Where it ends, in the quantity's unit.
    pub to: f64,
    /// How long it takes, s; zero is a step.
    pub over: f64,
}

impl Course {
    /// A course from its moves, in any order. Moves that begin before the one before has ended cut it short.
    pub fn new(mut moves: Vec<Move>) -> Self {
        moves.sort_by(|a, b| a.at.total_cmp(&b.at));
        Self(moves)
    }

    /// One value from the start on.
    pub fn constant(value: f64) -> Self {
        Self(vec![Move { at: 0.0, to: value, over: 0.0 }])
    }

    /// The value at time `t`, s; a move that begins then has begun.
    pub fn at(&self, t: f64) -> f64 {
        self.value(t, |begins| begins <= t + ROUNDING)
    }

    /// The value until just before time `t`, s: moves that begin then have not begun.
    pub fn before(&self, t: f64) -> f64 {
        self.value(t, |begins| begins < t - ROUNDING)
    }

    fn value(&self, t: f64, begun: impl Fn(f64) -> bool) -> f64 {
        let mut value = 0.0;
        for (index, course) in self.0.iter().enumerate() {
            if !begun(course.at) {
                break;
            }
            // Up to now, or to the next move.
            let until = self.0.get(index + 1).map_or(t, |next| next.at.min(t));
            let progress = if course.over > 0.0 { ((until - course.at) / course.over).clamp(0.0, 1.0) } else { 1.0 };
            value += progress * (course.to - value);
        }
        value
    }

    /// The moves, in order of time.
    pub fn moves(&self) -> &[Move] {
        &self.0
    }

    /// Whether it is zero throughout.
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|course| course.to == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_ramps() {
        let course = Course::new(vec![
            Move { at: 0.5, to: 10.0, over: 0.2 },
            Move { at: 0.1, to: -2.0, over: 0.0 },
            // Cuts the ramp short at its middle, where the value is 4.
            Move { at: 0.6, to: 5.0, over: 0.1 },
        ]);
        for (t, value) in [(0.0, 0.0), (0.1, -2.0), (0.49, -2.0), (0.55, 1.0), (0.6, 4.0), (0.65, 4.5), (0.7, 5.0), (9.0, 5.0)] {
            assert!((course.at(t) - value).abs() < 1e-12, "{t}: {}", course.at(t));
        }
        assert_eq!((course.before(0.1), course.at(0.1 - 1e-12), course.before(0.1 + 1e-12)), (0.0, -2.0, 0.0));
        assert!(Course::default().is_zero() && Course::default().at(1.0) == 0.0);
    }
}

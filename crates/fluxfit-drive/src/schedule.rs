//! Profiles: references and loads over time, as steps and ramps.

/// Times closer than this, s, are equal: a sample at `3 / 10 kHz` and a step at 0.0003 s.
const ROUNDING: f64 = 1e-9;

/// A quantity over time: constant between ramps, zero before the first one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Profile(Vec<Ramp>);

/// A ramp to another value; a step if it takes no time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// Start, s.
    pub at: f64,
    /// Final value, in the quantity's unit.
    pub to: f64,
    /// Duration, s; zero for a step.
    pub over: f64,
}

impl Profile {
    /// A profile from its ramps, in any order. A ramp that begins before the previous one has ended replaces its remainder.
    pub fn new(mut ramps: Vec<Ramp>) -> Self {
        ramps.sort_by(|a, b| a.at.total_cmp(&b.at));
        Self(ramps)
    }

    /// A constant value.
    pub fn constant(value: f64) -> Self {
        Self(vec![Ramp { at: 0.0, to: value, over: 0.0 }])
    }

    /// The value at time `t`, s, after a step at that time.
    pub fn at(&self, t: f64) -> f64 {
        self.value(t, |begins| begins <= t + ROUNDING)
    }

    /// The value just before time `t`, s, without a step at that time.
    pub fn before(&self, t: f64) -> f64 {
        self.value(t, |begins| begins < t - ROUNDING)
    }

    fn value(&self, t: f64, begun: impl Fn(f64) -> bool) -> f64 {
        let mut value = 0.0;
        for (index, ramp) in self.0.iter().enumerate() {
            if !begun(ramp.at) {
                break;
            }
            // The ramp ends at the latest where the next one begins.
            let until = self.0.get(index + 1).map_or(t, |next| next.at.min(t));
            let progress = if ramp.over > 0.0 { ((until - ramp.at) / ramp.over).clamp(0.0, 1.0) } else { 1.0 };
            value += progress * (ramp.to - value);
        }
        value
    }

    /// The ramps, in order of time.
    pub fn ramps(&self) -> &[Ramp] {
        &self.0
    }

    /// Whether it is zero throughout.
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|ramp| ramp.to == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_ramps() {
        let profile = Profile::new(vec![
            Ramp { at: 0.5, to: 10.0, over: 0.2 },
            Ramp { at: 0.1, to: -2.0, over: 0.0 },
            // Replaces the second half of the ramp, where the value is 4.
            Ramp { at: 0.6, to: 5.0, over: 0.1 },
        ]);
        for (t, value) in [(0.0, 0.0), (0.1, -2.0), (0.49, -2.0), (0.55, 1.0), (0.6, 4.0), (0.65, 4.5), (0.7, 5.0), (9.0, 5.0)] {
            assert!((profile.at(t) - value).abs() < 1e-12, "{t}: {}", profile.at(t));
        }
        assert_eq!((profile.before(0.1), profile.at(0.1 - 1e-12), profile.before(0.1 + 1e-12)), (0.0, -2.0, 0.0));
        assert!(Profile::default().is_zero() && Profile::default().at(1.0) == 0.0);
    }
}

//! Times that wrap around: the time of day at midnight, a 32-bit counter at its end.

/// Periods, s, after which times wrap around, and what such a time is.
const CLOCKS: [(f64, &str); 3] =
    [(86_400.0, "the time of day"), (4_294.967_296, "the counter of microseconds"), (4_294_967.296, "the counter of milliseconds")];

/// A time wrapped around if it was in the last hundredth of the period before and is in the first hundredth after: other jumps back
/// are unlikely to do that by chance.
const END: f64 = 0.01;

/// Unwraps times block by block.
#[derive(Debug, Default)]
pub(super) struct Clock {
    /// What is added to times, s.
    offset: f64,
    last: Option<f64>,
    /// What wrapped around, each time.
    wraps: Vec<&'static str>,
}

impl Clock {
    /// Makes times, s, continue where they wrapped around, in place.
    pub(super) fn unwrap(&mut self, t: &mut [f64]) {
        for time in t {
            if let Some(last) = self.last.filter(|last| *time < *last)
                && let Some((period, what)) =
                    CLOCKS.iter().find(|(period, _)| (period * (1.0 - END)..=*period).contains(&last) && (0.0..period * END).contains(time))
            {
                self.offset += period;
                self.wraps.push(what);
            }
            if !time.is_nan() {
                self.last = Some(*time);
            }
            // Without an offset the bits stay.
            if self.offset > 0.0 {
                *time += self.offset;
            }
        }
    }

    /// A note if times wrapped around.
    pub(super) fn note(&self) -> Option<String> {
        let what = self.wraps.first()?;
        let times = if self.wraps.len() == 1 { "once".to_owned() } else { format!("{} times", self.wraps.len()) };
        Some(format!("{what} wrapped around {times}; it is continued from there"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_continues_over_midnight() {
        let mut clock = Clock::default();
        let (mut before, mut after) = (vec![86_399.8, 86_399.9], vec![0.0, 0.1]);
        clock.unwrap(&mut before);
        clock.unwrap(&mut after);
        assert_eq!((before, after), (vec![86_399.8, 86_399.9], vec![86_400.0, 86_400.1]));
        assert_eq!(clock.note().as_deref(), Some("the time of day wrapped around once; it is continued from there"));
    }

    #[test]
    fn other_jumps_are_not_changed() {
        let mut clock = Clock::default();
        let mut t = vec![5.0, 4.0, 50_000.0, 0.0, 86_399.0, 10_000.0];
        let same = t.clone();
        clock.unwrap(&mut t);
        assert_eq!((t, clock.note()), (same, None));
    }
}

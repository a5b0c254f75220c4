//! Clocks that start anew: the milliseconds of the day at midnight, a counter of 32 bits at its end.

/// After how many seconds clocks start anew, and what they are.
const CLOCKS: [(f64, &str); 3] =
    [(86_400.0, "the clock of the day"), (4_294.967_296, "a counter of microseconds"), (4_294_967.296, "a counter of milliseconds")];

/// A clock started anew if the time before lies in the last hundredth of its round and the time after in the first: no other jump
/// back looks like that by chance.
const END: f64 = 0.01;

/// A clock that is read on its way.
#[derive(Debug, Default)]
pub(super) struct Clock {
    rounds: f64,
    last: Option<f64>,
    starts: Vec<&'static str>,
}

impl Clock {
    /// Adds the rounds that the clock has made to times, s, in place.
    pub(super) fn unwrap(&mut self, t: &mut [f64]) {
        for time in t {
            if let Some(last) = self.last.filter(|last| *time < *last)
                && let Some((round, what)) =
                    CLOCKS.iter().find(|(round, _)| (round * (1.0 - END)..=*round).contains(&last) && (0.0..round * END).contains(time))
            {
                self.rounds += round;
                self.starts.push(what);
            }
            if !time.is_nan() {
                self.last = Some(*time);
            }
            // Where nothing was added, not a bit changes.
            if self.rounds > 0.0 {
                *time += self.rounds;
            }
        }
    }

    /// What was done, if anything was.
    pub(super) fn note(&self) -> Option<String> {
        let what = self.starts.first()?;
        let times = if self.starts.len() == 1 { "once".to_owned() } else { format!("{} times", self.starts.len()) };
        Some(format!("{what} started anew {times}: time is counted on from there"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_on_over_midnight() {
        let mut clock = Clock::default();
        let (mut before, mut after) = (vec![86_399.8, 86_399.9], vec![0.0, 0.1]);
        clock.unwrap(&mut before);
        clock.unwrap(&mut after);
        assert_eq!((before, after), (vec![86_399.8, 86_399.9], vec![86_400.0, 86_400.1]));
        assert_eq!(clock.note().as_deref(), Some("the clock of the day started anew once: time is counted on from there"));
    }

    #[test]
    fn other_jumps_stay() {
        let mut clock = Clock::default();
        let mut t = vec![5.0, 4.0, 50_000.0, 0.0, 86_399.0, 10_000.0];
        let same = t.clone();
        clock.unwrap(&mut t);
        assert_eq!((t, clock.note()), (same, None));
    }
}

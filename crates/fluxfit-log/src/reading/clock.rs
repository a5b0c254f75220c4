//! Times that wrap around, the time of day at midnight or a 32-bit counter at its end; and times since 1970 of a column that states no
//! unit.

use crate::instant::epoch_digits;

/// Periods, s, after which times wrap around, and what such a time is.
const CLOCKS: [(f64, &str); 3] =
    [(86_400.0, "the time of day"), (4_294.967_296, "the counter of microseconds"), (4_294_967.296, "the counter of milliseconds")];

/// A time wrapped around if it was in the last hundredth of the period before and is in the first hundredth after: other jumps back
/// are unlikely to do that by chance.
const END: f64 = 0.01;

/// Rows of a log that are this many seconds apart or more are unlikely: whole numbers with such steps are a count of something shorter.
const LONG_STEP: f64 = 5.0;

/// A count of the rows begins with one of these and goes on by one: so do whole seconds, of a recorder that writes a row a second.
const FIRST_COUNTS: [f64; 2] = [0.0, 1.0];

/// Fewest rows that are taken for a count, or under the name of seconds for another unit.
const FEWEST: usize = 30;

/// Days since 1900 of a spreadsheet and since the year 0 of MATLAB, over the years 1954 to 2119.
const DAYS: [(std::ops::Range<f64>, &str); 2] =
    [(20_000.0..80_000.0, "days, as spreadsheets count them"), (714_000.0..774_000.0, "days, as MATLAB counts them")];

/// Rows of a log that are this many seconds apart or less are unlikely: with such steps, times of that size are days.
const SHORT_STEP: f64 = 5e-6;

/// Days in a second.
const SECOND: f64 = 1.0 / 86_400.0;

/// Settles times block by block.
#[derive(Debug, Default)]
pub(super) struct Clock {
    /// Whether the unit of the times may have to be found.
    is_open: bool,
    /// The first time and the divisor, if the times count from 1970, or are days; and what they are.
    since_1970: Option<(f64, f64, &'static str)>,
    /// Nothing writes their unit, so that s is an assumption.
    is_assumed: bool,
    /// They have the channel's own name, which is in s.
    is_named: bool,
    /// They may count the rows: then no whole number is in s.
    may_count: bool,
    /// The usual step of the first times, if they are whole numbers.
    step: Option<f64>,
    /// The first times.
    first: First,
    /// What is added to times, s.
    offset: f64,
    last: Option<f64>,
    /// What wrapped around, each time.
    wraps: Vec<&'static str>,
}

impl Clock {
    /// Of times whose unit is stated or not, and written or not; under their own name or one that says nothing of a unit, or that may count
    /// the rows.
    pub(super) fn of(is_unit_stated: bool, is_unit_written: bool, is_alias: bool, may_count: bool) -> Self {
        let is_assumed = !is_unit_stated && !is_unit_written;
        Self { is_open: !is_unit_stated, is_assumed, is_named: !is_alias, may_count, ..Self::default() }
    }

    /// Makes times, s, continue where they wrapped around, in place. Those since 1970 count from the first one, so that their fractions
    /// keep all digits.
    pub(super) fn settle(&mut self, t: &mut [f64]) {
        if self.is_open && !t.is_empty() {
            self.is_open = false;
            self.step = whole_step(t);
            self.first = First::of(t);
            let of_days = || days(t).map(|what| (t[0], SECOND, what));
            self.since_1970 = epoch_digits(t).map(|(digits, what)| (t[0], 10_f64.powi(digits as i32), what)).or_else(of_days);
        }
        if let Some((first, divisor, _)) = self.since_1970 {
            t.iter_mut().for_each(|time| *time = (*time - first) / divisor);
        }
        self.unwrap(t);
    }

    fn unwrap(&mut self, t: &mut [f64]) {
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

    /// The step of times that are unlikely to be in s, if nothing states their unit.
    pub(super) fn unstated_step(&self) -> Option<u64> {
        let step = self.step.filter(|_| self.is_assumed && self.since_1970.is_none())?;
        let is_long = step >= LONG_STEP && (!self.is_named || self.first != First::Few);
        (self.may_count || is_long || self.first == First::Count).then_some(step as u64)
    }

    /// Notes on what was found.
    pub(super) fn notes(&self) -> Vec<String> {
        let counted = self.since_1970.map(|(_, _, what)| format!("t: by their size the times are {what}; t counts from the first one"));
        let wrapped = self.wraps.first().map(|what| {
            let times = if self.wraps.len() == 1 { "once".to_owned() } else { format!("{} times", self.wraps.len()) };
            format!("{what} wrapped around {times}; it is continued from there")
        });
        counted.into_iter().chain(wrapped).collect()
    }
}

/// What the first times are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum First {
    /// Too few to tell anything.
    #[default]
    Few,
    /// 0, 1, 2, .. or 1, 2, 3, ..
    Count,
    Other,
}

impl First {
    fn of(t: &[f64]) -> Self {
        match t.first() {
            Some(first) if t.len() >= FEWEST => {
                let is_count = FIRST_COUNTS.contains(first) && t.windows(2).all(|pair| pair[1] - pair[0] == 1.0);
                if is_count { Self::Count } else { Self::Other }
            }
            _ => Self::Few,
        }
    }
}

/// What days these times are, if their steps are too short for seconds.
fn days(t: &[f64]) -> Option<&'static str> {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (_, what) = DAYS.iter().find(|(range, _)| t.first().is_some_and(|first| range.contains(first)))?;
    let middle = steps.len() / 2;
    let is_short = !steps.is_empty() && (0.0..SHORT_STEP).contains(steps.select_nth_unstable_by(middle, f64::total_cmp).1);
    is_short.then_some(*what)
}

/// The median step of whole numbers; none if they are not whole, or too few.
fn whole_step(t: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let is_whole = t.iter().all(|time| time.fract() == 0.0);
    let middle = steps.len() / 2;
    (is_whole && !steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_continues_over_midnight() {
        let mut clock = Clock::default();
        let (mut before, mut after) = (vec![86_399.8, 86_399.9], vec![0.0, 0.1]);
        clock.settle(&mut before);
        clock.settle(&mut after);
        assert_eq!((before, after), (vec![86_399.8, 86_399.9], vec![86_400.0, 86_400.1]));
        assert_eq!(clock.notes(), ["the time of day wrapped around once; it is continued from there"]);
    }

    /// 2023-03-15 is day 45000 of spreadsheets; 10 rows a second.
    #[test]
    fn days_of_a_spreadsheet_become_seconds() {
        let mut clock = Clock::of(false, false, true, false);
        let mut t: Vec<f64> = (0..50).map(|row| 45_000.25 + f64::from(row) * 0.1 / 86_400.0).collect();
        clock.settle(&mut t);
        assert!(t.iter().enumerate().all(|(row, t)| (t - row as f64 * 0.1).abs() < 1e-6), "{t:?}");
        assert_eq!(clock.notes(), ["t: by their size the times are days, as spreadsheets count them; t counts from the first one"]);
        let mut seconds: Vec<f64> = (0..50).map(|row| 45_000.0 + f64::from(row) * 1e-4).collect();
        let same = seconds.clone();
        Clock::of(false, false, true, false).settle(&mut seconds);
        assert_eq!(seconds, same);
    }

    /// Rows from 0 or 1 on may be a second apart or not, whatever they are called; from 17 on, or if one is missing, they are times.
    #[test]
    fn a_count_of_the_rows_is_no_time_unless_its_unit_is_written() {
        let step = |is_written: bool, is_alias: bool, t: &mut [f64]| {
            let mut clock = Clock::of(false, is_written, is_alias, false);
            clock.settle(t);
            clock.unstated_step()
        };
        let count = |first: u32, rows: u32| (first..first + rows).map(f64::from).collect::<Vec<f64>>();
        for is_alias in [false, true] {
            assert_eq!([0, 1, 17].map(|first| step(false, is_alias, &mut count(first, 50))), [Some(1), Some(1), None]);
            assert_eq!((step(true, is_alias, &mut count(0, 50)), step(false, is_alias, &mut count(0, 3))), (None, None));
            assert_eq!(step(false, is_alias, &mut [count(0, 40), count(41, 40)].concat()), None);
            let mut hundreds: Vec<f64> = count(0, 50).into_iter().map(|time| 100.0 * time).collect();
            assert_eq!((step(false, is_alias, &mut hundreds), step(true, is_alias, &mut hundreds)), (Some(100), None));
        }
    }

    #[test]
    fn other_jumps_are_not_changed() {
        let mut clock = Clock::default();
        let mut t = vec![5.0, 4.0, 50_000.0, 0.0, 86_399.0, 10_000.0];
        let same = t.clone();
        clock.settle(&mut t);
        assert_eq!((t, clock.notes()), (same, vec![]));
    }

    #[test]
    fn times_since_1970_count_from_the_first() {
        let mut clock = Clock::of(false, false, false, false);
        let (mut first, mut more) = (vec![1_455_273_060_500.0, 1_455_273_060_501.0], vec![1_455_273_060_502.0]);
        clock.settle(&mut first);
        clock.settle(&mut more);
        assert_eq!((first, more), (vec![0.0, 0.001], vec![0.002]));
        let mut stated = Clock::of(true, true, false, false);
        let mut t = vec![1_455_273_060.0, 1_455_273_061.0];
        stated.settle(&mut t);
        assert_eq!((t[0], stated.notes()), (1_455_273_060.0, vec![]));
    }
}

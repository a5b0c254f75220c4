//! Columns of text whose cells are dates and times, times of day, or seconds since 1970: they become seconds.
//!
//! A double holds today's time since 1970 to a quarter of a microsecond only, so the first instant is subtracted before the rest becomes
//! one.

use chrono::{
    DateTime, NaiveDateTime, NaiveTime, Timelike,
    format::{Item, Parsed, StrftimeItems, parse},
};

/// Dates as programs write them. Of two that fit all cells, the one with the shorter steps is taken; of equal ones, the first.
const DATES: [(&str, &str); 15] = [
    ("%Y-%m-%d", "year-month-day"),
    ("%Y/%m/%d", "year/month/day"),
    ("%Y.%m.%d", "year.month.day"),
    ("%m/%d/%Y", "month/day/year"),
    ("%d/%m/%Y", "day/month/year"),
    ("%d.%m.%Y", "day.month.year"),
    ("%d-%m-%Y", "day-month-year"),
    ("%m-%d-%Y", "month-day-year"),
    ("%m/%d/%y", "month/day/year"),
    ("%d/%m/%y", "day/month/year"),
    ("%d.%m.%y", "day.month.year"),
    ("%d-%b-%Y", "day-month-year"),
    ("%d %b %Y", "day month year"),
    ("%b %d %Y", "month day year"),
    ("%Y%m%d", "year, month, day"),
];

/// What stands between a date and a time.
const BETWEEN: [&str; 4] = ["T", " ", "  ", "_"];

/// Times. A comma before the fraction of a second is read as a point.
const TIMES: [&str; 6] = ["%H:%M:%S%.f", "%H:%M", "%I:%M:%S%.f %p", "%I:%M %p", "%H%M%S%.f", "%H:%M:%S:%3f"];

/// Zones after a time. Times without one are as far apart as they would be in any zone, but for the hour of a change of clocks.
const ZONES: [&str; 7] = ["", "Z", " UTC", " GMT", "%#z", " %#z", " %:z"];

/// Numbers of seconds since 1970 between the years 2000 and 2100, in thousandths, millionths and so on of a second for those. Smaller
/// numbers count from elsewhere.
const EPOCHS: [(u32, &str); 4] =
    [(0, "seconds since 1970"), (3, "milliseconds since 1970"), (6, "microseconds since 1970"), (9, "nanoseconds since 1970")];
const YEARS_2000_TO_2100: std::ops::Range<f64> = 946_684_800.0..4_102_444_800.0;

/// A log has rows more often than this, s: a counter of microseconds since the start of a drive is no number of seconds since 1970.
const LONGEST_STEP: f64 = 60.0;

/// Nanoseconds in a second.
const NANO: i64 = 1_000_000_000;

/// Digits after the point of a nanosecond.
const NANO_DIGITS: u32 = 9;

/// How the cells of a column state instants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Instants {
    style: Style,
    /// The instant of the first cell, ns.
    first: i64,
}

#[derive(Debug, Clone, PartialEq)]
enum Style {
    /// A number of 10^-n seconds since 1970.
    Epoch(u32, &'static str),
    /// A date and a time.
    Date { items: Vec<Item<'static>>, order: &'static str, has_zone: bool },
    /// A time of day.
    Clock,
    /// Days and a time since a start, `0 days 00:00:00.0001`.
    Elapsed,
    /// A number and its unit, of so many ns.
    Count(f64),
}

impl Instants {
    /// From the first cells of a column; none if they are other texts, or other numbers.
    pub(crate) fn of(cells: &[&str]) -> Option<Self> {
        let first = *cells.first()?;
        let styles = if elapsed(first).is_some() {
            vec![Style::Elapsed]
        } else if let Some((_, unit)) = counted(first) {
            vec![Style::Count(unit)]
        } else if first.contains(':') || first.len() > 8 && first.contains(['T', ' ', '_']) {
            Style::of_text(first)
        } else {
            Style::of_number(first).into_iter().collect()
        };
        let longest_step = |style: &Style| {
            let instants: Option<Vec<i64>> = cells.iter().map(|cell| style.nanoseconds(cell)).collect();
            let instants = instants?;
            let steps = instants.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
            let is_rising = instants.windows(2).all(|pair| pair[0] <= pair[1]);
            Some((instants[0], !is_rising, steps.max().unwrap_or(0)))
        };
        let fitting = styles.into_iter().filter_map(|style| longest_step(&style).map(|(first, falls, step)| ((falls, step), first, style)));
        // Of equal ones the first.
        let ((_, step), first, style) = fitting.reduce(|best, next| if next.0 < best.0 { next } else { best })?;
        let is_log = !matches!(style, Style::Epoch(..)) || (step as f64) < LONGEST_STEP * NANO as f64;
        is_log.then_some(Self { first: if matches!(style, Style::Clock | Style::Count(_) | Style::Elapsed) { 0 } else { first }, style })
    }

    /// Numbers of seconds, counted from zero.
    pub(crate) fn since_zero() -> Self {
        Self { style: Style::Epoch(0, "seconds"), first: 0 }
    }

    /// Seconds since the first instant, or since midnight.
    pub(crate) fn seconds(&self, cell: &[u8]) -> Option<f64> {
        let instant = self.style.nanoseconds(str::from_utf8(cell).ok()?)?;
        Some(instant.checked_sub(self.first)? as f64 / NANO as f64)
    }

    /// Digits after the point of a second that the unit of the numbers has, if the cells are numbers.
    pub(crate) fn digits(&self) -> Option<u32> {
        match self.style {
            Style::Epoch(digits, _) => Some(digits),
            _ => None,
        }
    }

    /// Whether the cells are dates.
    pub(crate) fn is_date(&self) -> bool {
        matches!(self.style, Style::Date { .. })
    }

    /// What the cells are, and from where the seconds are counted.
    pub(crate) fn describe(&self) -> String {
        let start = || {
            let start = DateTime::from_timestamp(self.first.div_euclid(NANO), self.first.rem_euclid(NANO) as u32);
            start.map_or_else(String::new, |start| start.format("%Y-%m-%d %H:%M:%S%.f").to_string())
        };
        match &self.style {
            Style::Epoch(_, what) => format!("{what}; t counts from {} UTC", start()),
            Style::Date { order, has_zone, .. } => {
                format!("dates ({order}) and times; t counts from {}{}", start(), if *has_zone { " UTC" } else { "" })
            }
            Style::Clock => "the time of day".to_owned(),
            Style::Elapsed => "days and a time since the start".to_owned(),
            Style::Count(_) => "numbers with their unit".to_owned(),
        }
    }
}

/// What numbers are that count from 1970, by the first and the longest step between them: the digits after the point of a second that
/// their unit has, and the unit.
pub(crate) fn epoch_digits(numbers: &[f64]) -> Option<(u32, &'static str)> {
    let is_now = |digits: u32| YEARS_2000_TO_2100.contains(&(numbers[0] / 10_f64.powi(digits as i32)));
    let (digits, what) = EPOCHS.into_iter().find(|(digits, _)| !numbers.is_empty() && is_now(*digits))?;
    let longest = numbers.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    (longest < LONGEST_STEP * 10_f64.powi(digits as i32)).then_some((digits, what))
}

impl Style {
    /// The styles in which a text can be read.
    fn of_text(text: &str) -> Vec<Self> {
        let mut styles = Vec::new();
        for (date, order) in DATES {
            for (between, time, zone) in
                BETWEEN.iter().flat_map(|between| TIMES.iter().flat_map(move |time| ZONES.map(|zone| (between, time, zone))))
            {
                let format = format!("{date}{between}{time}{zone}");
                let Ok(items) = StrftimeItems::new(&format).parse_to_owned() else { continue };
                let style = Self::Date { items, order, has_zone: !zone.is_empty() };
                if style.nanoseconds(text).is_some() {
                    styles.push(style);
                }
            }
        }
        if Self::Clock.nanoseconds(text).is_some() {
            styles.push(Self::Clock);
        }
        styles
    }

    /// The style in which a number is an instant of our time.
    fn of_number(text: &str) -> Option<Self> {
        let number = text.trim().replace(',', ".").parse().ok()?;
        epoch_digits(&[number]).map(|(digits, what)| Self::Epoch(digits, what))
    }

    /// The instant, ns since 1970 or since midnight.
    fn nanoseconds(&self, text: &str) -> Option<i64> {
        let text = text.trim();
        match self {
            Self::Count(of_column) => {
                counted(text).filter(|(_, unit)| unit == of_column).map(|(number, unit)| (number * unit).round() as i64)
            }
            Self::Epoch(digits, _) => epoch(text, *digits),
            Self::Elapsed => elapsed(text),
            Self::Date { items, has_zone, .. } => {
                let point = text.contains(',').then(|| text.replace(',', "."));
                let mut parsed = Parsed::new();
                parse(&mut parsed, point.as_deref().unwrap_or(text), items.iter()).ok()?;
                let offset = if *has_zone { parsed.offset().unwrap_or(0) } else { 0 };
                let local: NaiveDateTime = parsed.to_naive_datetime_with_offset(offset).ok()?;
                local.and_utc().timestamp_nanos_opt()?.checked_sub(i64::from(offset) * NANO)
            }
            Self::Clock => {
                let point = text.contains(',').then(|| text.replace(',', "."));
                let time = NaiveTime::parse_from_str(point.as_deref().unwrap_or(text), "%H:%M:%S%.f").ok()?;
                Some(i64::from(time.num_seconds_from_midnight()) * NANO + i64::from(time.nanosecond()))
            }
        }
    }
}

/// Units behind the numbers of a column of times, as MATLAB writes durations; ns.
const UNITS: [(&str, f64); 6] = [("sec", 1e9), ("s", 1e9), ("ms", 1e6), ("us", 1e3), ("µs", 1e3), ("min", 6e10)];

/// The number and the unit of a cell that has both.
pub(crate) fn counted(text: &str) -> Option<(f64, f64)> {
    let (number, unit) = text.trim().rsplit_once(' ')?;
    let (_, unit) = UNITS.iter().find(|(name, _)| *name == unit)?;
    let number: f64 = number.trim().replace(',', ".").parse().ok()?;
    number.is_finite().then_some((number, *unit))
}

/// The ns of a time since a start, as pandas and Python write it, `-1 days +23:59:59.9`, `1 day, 0:00:01`.
pub(crate) fn elapsed(text: &str) -> Option<i64> {
    let (days, rest) = text.trim().split_once(" day")?;
    let days: i64 = days.parse().ok()?;
    let time = rest.strip_prefix('s').unwrap_or(rest).trim_start_matches([',', ' ', '+']);
    let of_day = if time.is_empty() { 0 } else { Style::Clock.nanoseconds(time)? };
    days.checked_mul(86_400 * NANO)?.checked_add(of_day)
}

/// A number of 10^-digits seconds, in ns, without rounding what a nanosecond can hold.
fn epoch(text: &str, digits: u32) -> Option<i64> {
    let (whole, fraction) = text.split_once(['.', ',']).unwrap_or((text, ""));
    let places = NANO_DIGITS - digits;
    let scale = 10_i64.pow(places);
    let is_plain = !whole.is_empty() && whole.bytes().chain(fraction.bytes()).all(|byte| byte.is_ascii_digit());
    if !is_plain {
        let number: f64 = text.parse().ok()?;
        return number.is_finite().then_some((number * scale as f64) as i64);
    }
    let kept: String = fraction.chars().chain(std::iter::repeat('0')).take(places as usize).collect();
    let part = if kept.is_empty() { 0 } else { kept.parse().ok()? };
    whole.parse::<i64>().ok()?.checked_mul(scale)?.checked_add(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(cells: &[&str]) -> Vec<f64> {
        let instants = Instants::of(cells).unwrap_or_else(|| panic!("{cells:?}"));
        cells.iter().map(|cell| instants.seconds(cell.as_bytes()).unwrap_or(f64::NAN)).collect()
    }

    #[test]
    fn dates_and_times_become_seconds() {
        for cells in [
            ["2016-02-12T10:31:00.0000Z", "2016-02-12T10:31:00.0001Z", "2016-02-12T10:31:01Z"],
            ["2016-02-12 10:31:59.9999", "2016-02-12 10:32:00", "2016-02-12 10:32:00,9999"],
            ["2016-02-12T11:31:00+01:00", "2016-02-12T10:31:00.0001+00:00", "2016-02-12T10:31:01+00:00"],
            ["2016-02-12 11:31:00+01", "2016-02-12 11:31:00.0001+01", "2016-02-12 11:31:01+01"],
            ["12.02.2016 23:59:59,9999", "13.02.2016 00:00:00", "13.02.2016 00:00:00,9999"],
            ["2/12/2016 9:31:00 PM", "2/12/2016 9:31:00.0001 PM", "2/12/2016 9:31:01 PM"],
            ["12-Feb-2016 10:31:00", "12-Feb-2016 10:31:00.0001", "12-Feb-2016 10:31:01"],
            ["20160212T103100", "20160212T103100.0001", "20160212T103101"],
            ["10:31:00", "10:31:00.0001", "10:31:01"],
            ["0 sec", "0.0001 sec", "1 sec"],
            ["0 days 00:00:00", "0 days 00:00:00.000100000", "0 days 00:00:01"],
            ["-1 days +23:59:59.5", "-1 days +23:59:59.500100", "0 days 00:00:00.500000"],
            ["1 day, 0:00:00", "1 day, 0:00:00.000100", "1 day, 0:00:01"],
            ["5 ms", "5,1 ms", "1005 ms"],
        ] {
            let t = seconds(&cells);
            assert_eq!([t[1] - t[0], t[2] - t[0]].map(|step| (step * 1e9).round() / 1e9), [1e-4, 1.0], "{cells:?}");
        }
        assert_eq!(seconds(&["2/12/2016 10:31", "2/12/2016 10:32"]), [0.0, 60.0]);
    }

    #[test]
    fn the_order_of_day_and_month_is_that_of_the_shorter_steps() {
        let order =
            |cells: &[&str]| Instants::of(cells).map(|instants| instants.describe().split(')').next().unwrap_or_default().to_owned());
        assert_eq!(order(&["1/2/2016 23:59", "2/2/2016 0:00"]).as_deref(), Some("dates (day/month/year"));
        assert_eq!(order(&["1/2/2016 23:59", "1/3/2016 0:00"]).as_deref(), Some("dates (month/day/year"));
        assert_eq!(order(&["13/2/2016 23:59"]).as_deref(), Some("dates (day/month/year"));
    }

    #[test]
    fn numbers_since_1970_are_told_apart_and_keep_their_digits() {
        for cells in [
            ["1455273060.1234", "1455273060.1235"],
            ["1455273060123.4", "1455273060123.5"],
            ["1455273060123400", "1455273060123500"],
            ["1455273060123400000", "1455273060123500000"],
        ] {
            assert_eq!(seconds(&cells), [0.0, 1e-4], "{cells:?}");
        }
        // Counters since the start of a drive: microseconds, nanoseconds.
        for cells in [["1455273060", "1455273160"], ["1455273060123", "1455273160123"], ["12", "13"], ["20160212", "20160213"]] {
            assert_eq!(Instants::of(&cells), None, "{cells:?}");
        }
        assert_eq!(Instants::of(&["abc"]), None);
    }
}

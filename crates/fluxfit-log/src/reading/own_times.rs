//! Times that a table has beside the one that is read: some tools write a time for each channel, and others put tables of several
//! recordings side by side. The rows of such a table are simultaneous only where these times are equal.

use super::{
    chosen::ChosenColumn,
    resemblance::{has_other_unit, words},
};
use crate::{
    block::{ColumnHead, WantedColumn},
    channel::Channel::T,
    header_unit::split_header,
    problem::Problem,
};
use fluxfit_files::FileError;
use fluxfit_units::significant;

/// Words for a time in the name of a column.
const TIME: [&str; 5] = ["time", "times", "timestamp", "timestamps", "zeit"];

/// The symbol for it, which is a temperature's too: `t_motor`.
const SYMBOL: &str = "t";

/// Words beside a channel's name that say no more than that it is one: `log.ud.data`.
const OF_ANY_CHANNEL: [&str; 5] = ["data", "value", "values", "signal", "y"];

/// Times that differ by no more than this share of a step are equal: they were rounded, or one loop read several clocks.
const EQUAL: f64 = 0.02;

/// A time that some channels have for themselves, and what was seen of it.
pub(super) struct OwnTime {
    index: usize,
    header: String,
    /// The first channel that has it.
    of: String,
    /// How many channels have it.
    owners: usize,
    /// All of them have it: they are simultaneous, and only its steps must be those of the time that is read.
    is_of_all: bool,
    seen: Seen,
    apart: f64,
    is_missing: bool,
}

/// First and last time, and how many there were.
#[derive(Default)]
struct Seen {
    ends: Option<(f64, f64)>,
    count: usize,
    /// Of them, those after the one before.
    later: usize,
    runs_back: bool,
}

impl Seen {
    fn push(&mut self, time: f64) {
        self.count += 1;
        self.later += usize::from(self.ends.is_some_and(|(_, last)| time > last));
        self.runs_back |= self.ends.is_some_and(|(_, last)| time < last);
        self.ends = Some((self.ends.map_or(time, |(first, _)| first), time));
    }

    fn step(&self) -> Option<f64> {
        self.ends.filter(|_| self.count > 1).map(|(first, last)| (last - first) / (self.count - 1) as f64)
    }
}

/// All times of a table, compared row by row.
pub(super) struct OwnTimes {
    time: Seen,
    others: Vec<OwnTime>,
}

impl OwnTimes {
    /// Finds columns of the group that are the time of a chosen column and not the one that is read.
    pub(super) fn of(heads: &[ColumnHead], columns: &[ChosenColumn]) -> Self {
        let mut others: Vec<OwnTime> = Vec::new();
        let time = columns.iter().find(|column| column.channel == T);
        for column in columns.iter().filter(|column| column.channel != T) {
            let Some(time) = time else { break };
            let is_free = |index: &usize| {
                heads[*index].group == heads[column.index].group
                    && columns.iter().all(|other| other.index != *index)
                    && !has_other_unit(T, &heads[*index])
            };
            let before = (0..column.index).rev().find(|&index| index == time.index || is_again(&heads[index].name, &time.header));
            let by_name = || (0..heads.len()).filter(is_free).find(|&index| is_named_after(&heads[index].name, column, &time.header));
            let Some(index) = before.filter(is_free).or_else(by_name) else { continue };
            if let Some(other) = others.iter_mut().find(|other| other.index == index) {
                other.owners += 1;
            } else {
                let (header, of, seen) = (heads[index].name.clone(), column.header.clone(), Seen::default());
                others.push(OwnTime { index, header, of, owners: 1, is_of_all: false, seen, apart: 0.0, is_missing: false });
            }
        }
        let channels = columns.iter().filter(|column| column.channel != T).count();
        for other in &mut others {
            other.is_of_all = other.owners == channels;
        }
        // A time that is another one by its name, and the same for all, may count anything: seconds since the start, a clock of the day.
        let again = |other: &OwnTime| columns.iter().any(|column| column.channel == T && is_again(&other.header, &column.header));
        others.retain(|other| !other.is_of_all || again(other));
        Self { time: Seen::default(), others }
    }

    /// These columns as the table reads them: like the time.
    pub(super) fn wanted(&self, columns: &[ChosenColumn]) -> Vec<WantedColumn> {
        let time = columns.iter().find(|column| column.channel == T).map(ChosenColumn::wanted);
        let own = |own: &OwnTime| {
            let time = time.clone()?;
            Some(WantedColumn { index: own.index, header: own.header.clone(), is_optional: true, ..time })
        };
        self.others.iter().filter_map(own).collect()
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.others.len()
    }

    /// Compares the times of a block, as the file writes them.
    pub(super) fn compare(&mut self, time: &[f64], others: &[Vec<f64>]) {
        for (row, t) in time.iter().enumerate() {
            if !t.is_nan() {
                self.time.push(*t);
            }
            for (other, values) in self.others.iter_mut().zip(others) {
                let own = values.get(row).copied().unwrap_or(f64::NAN);
                if own.is_nan() {
                    other.is_missing |= !t.is_nan();
                } else {
                    other.seen.push(own);
                    // Where the other has ended, it cannot be compared.
                    other.apart = other.apart.max((own - t).abs());
                }
            }
        }
    }

    /// Refuses rows of which some channels have another time.
    pub(super) fn refuse(&self, time: &str) -> Result<(), FileError> {
        let Some(step) = self.time.step() else { return Ok(()) };
        // A column that stands still or runs back is no time, whatever its name is; nor is a `t2` that mostly stands still, a temperature,
        // or a `time_id` that counts rows.
        let is_temperature =
            |own: &OwnTime| 2 * own.seen.later < own.seen.count && !words(&own.header).iter().any(|word| TIME.contains(&word.as_str()));
        let counts_rows = |own: &OwnTime| {
            let is_whole = own.seen.ends.is_some_and(|(first, _)| first.fract() == 0.0);
            is_whole && own.seen.step() == Some(1.0) && words(&own.header).iter().any(|word| word == "id")
        };
        let is_time = |own: &&OwnTime| {
            !own.seen.runs_back && own.seen.step().is_some_and(|step| step > 0.0) && !is_temperature(own) && !counts_rows(own)
        };
        let has_other_steps = |own: &OwnTime| own.seen.step().is_some_and(|other| (other - step).abs() > EQUAL * step);
        let is_other = |own: &&OwnTime| match own.is_of_all {
            true => has_other_steps(own),
            false => own.apart > EQUAL * step || own.is_missing,
        };
        let Some(own) = self.others.iter().filter(is_time).find(is_other) else { return Ok(()) };
        let apart = match own.seen.step() {
            Some(other) if (other - step).abs() > EQUAL * step => Apart::Steps { other, step },
            _ => Apart::Rows { most: own.apart },
        };
        let (of, own) = (own.of.clone(), own.header.clone());
        Err(FileError::from(Problem::OwnTimes { own, time: time.to_owned(), apart: apart.to_string() }).in_column(&of))
    }
}

/// How times differ, in the unit of the file.
enum Apart {
    Steps { other: f64, step: f64 },
    Rows { most: f64 },
}

impl std::fmt::Display for Apart {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Steps { other, step } => write!(f, "in steps of {} and not of {} like", significant(*other, 3), significant(*step, 3)),
            Self::Rows { most } => write!(f, "in the same row up to {} away from", significant(*most, 3)),
        }
    }
}

/// Whether a name is the time's again, as in `Time 2`, `Time.1 [s]` or the same once more; `T` beside `t` is a temperature.
fn is_again(name: &str, time: &str) -> bool {
    let parts = |name: &str| {
        let (bare, _) = split_header(name, T.dimension());
        let unit = name.rsplit_once(bare).map_or("", |(_, behind)| behind);
        let stem = bare.trim().trim_end_matches(|c: char| c.is_ascii_digit() || " ._-#".contains(c)).to_owned();
        (if stem.len() > 1 { stem.to_lowercase() } else { stem }, unit.to_lowercase())
    };
    let of_time = parts(time);
    !of_time.0.is_empty() && parts(name) == of_time
}

/// Whether a name is that of a column and a word for a time: `t_ud` of `ud`, `log.uq.t` of `log.uq.data`, `motor.time` of `motor.uq`,
/// `uq(:,1)` of `uq(:,2)`. What such a name says of the time that is read as well, as in `log.t` beside `log.time`, it does not say of the
/// column alone.
fn is_named_after(name: &str, column: &ChosenColumn, time: &str) -> bool {
    if let (Some(first), Some(second)) = (name.strip_suffix("(:,1)"), column.header.strip_suffix("(:,2)")) {
        return first == second;
    }
    let is_of_time = |word: &str| word == SYMBOL || TIME.contains(&word);
    let without_time = |name: &str| words(name).into_iter().filter(|word| !is_of_time(word)).collect::<Vec<_>>();
    let of_time = words(split_header(name, T.dimension()).0);
    let rest = without_time(split_header(name, T.dimension()).0);
    let begins = |name: &str| without_time(name).iter().zip(&rest).filter(|(a, b)| a == b).count() == rest.len();
    let own = split_header(&column.header, column.channel.dimension()).0;
    let is_the_column = || {
        let own = without_time(own).into_iter().filter(|word| !OF_ANY_CHANNEL.contains(&word.as_str()));
        own.eq(rest.iter().cloned())
    };
    let is_a_word = of_time.iter().any(|word| TIME.contains(&word.as_str()));
    let is_named = rest.len() < of_time.len() && !rest.is_empty();
    is_named && begins(own) && !begins(split_header(time, T.dimension()).0) && (is_a_word || is_the_column())
}

#[cfg(test)]
mod tests {
    use crate::reading::{LogOptions, parse_log};

    /// 40 rows of a log with two times, of which the other one has this value in the row.
    fn read(header: &str, map: &[(&str, &str)], other: impl Fn(u32) -> String) -> Result<usize, String> {
        let row = |k: u32| format!("{:.4},1,20,{},0.5,3,400\n", f64::from(k) * 1e-4, other(k));
        let text = format!("{header}\n{}", (0..40).map(row).collect::<String>());
        let map = map.iter().map(|(channel, column)| ((*channel).to_owned(), (*column).to_owned())).collect();
        let read = parse_log("a.csv", text.as_bytes(), &LogOptions { map, ..LogOptions::default() });
        read.map(|read| read.log.rows()).map_err(|error| error.to_string())
    }

    #[test]
    fn channels_with_other_times_are_refused_whatever_is_mapped_to_the_time() {
        let slow = |k: u32| format!("{:.3}", f64::from(k) * 1e-3);
        for (header, map) in [
            ("Time,ud,uq,Time.1,id,iq,omega_e", &[][..]),
            ("t,ud,uq,t2,id,iq,omega_e", &[]),
            ("Zeit 1,ud,uq,Zeit 2,id,iq,omega_e", &[("t", "Zeit 1")]),
            ("t_ud,ud,uq,t_id,id,iq,omega_e", &[("t", "t_ud")]),
            ("log.ud.t,ud,uq,log.id.t,log.id.data,iq,omega_e", &[("t", "log.ud.t"), ("id", "log.id.data")]),
            ("Time 1 [s],ud [V],uq,Time 2 [s],id [A],iq,omega_e", &[("t", "Time 1 [s]")]),
            ("t_ud [s],ud [V],uq,t_id [s],id [A],iq,omega_e", &[("t", "t_ud [s]")]),
            ("a.time,ud,uq,b.time,b.id,b.iq,omega_e", &[("t", "a.time")]),
            ("  Z\u{e4}hlzeit 1 [s],ud,uq, Z\u{e4}hlzeit 2 [s],id,iq,omega_e", &[("t", "Z\u{e4}hlzeit 1 [s]")]),
        ] {
            let refusal = read(header, map, slow).unwrap_err();
            assert!(
                refusal.contains("has a time of its own") && refusal.contains("in steps of 0.00100 and not of 0.000100 like"),
                "{refusal}"
            );
        }
        let late = read("Time,ud,uq,Time.1,id,iq,omega_e", &[], |k| format!("{:.5}", f64::from(k) * 1e-4 + 5e-5)).unwrap_err();
        assert!(late.contains("in the same row up to 0.0000500 away from"), "{late}");
        let ended =
            read("Time,ud,uq,Time.1,id,iq,omega_e", &[], |k| if k < 30 { format!("{:.4}", f64::from(k) * 1e-4) } else { String::new() });
        assert!(ended.unwrap_err().contains("has a time of its own"));
    }

    #[test]
    fn equal_times_and_columns_that_are_no_time_are_read() {
        let same = |k: u32| format!("{:.4}", f64::from(k) * 1e-4);
        assert_eq!(read("Time,ud,uq,Time.1,id,iq,omega_e", &[], same), Ok(40));
        assert_eq!(read("Time,ud,uq,Time.1,id,iq,omega_e", &[], |k| format!("{:.6}", f64::from(k) * 1e-4 + 1e-6)), Ok(40));
        // Temperatures, a clock that all channels share, and a number of the row.
        let warmer = |k: u32| format!("{:.3}", 25.0 + f64::from(k) * 1e-3);
        assert_eq!(
            read("time,motor_ud,motor_uq,t_motor,motor_id,motor_iq,motor_el_omega", &[("omega_e", "motor_el_omega")], warmer),
            Ok(40)
        );
        assert_eq!(read("t,ud,uq,T,id,iq,omega_e", &[("t", "t")], warmer), Ok(40));
        assert_eq!(read("t,ud,uq,Time [\u{b0}C],id,iq,omega_e", &[("t", "t")], warmer), Ok(40));
        let clock = |k: u32| format!("{:.4}", 5.0 + f64::from(k) * 1e-4);
        assert_eq!(read("time,motor.ud,motor.uq,motor.time,motor.id,motor.iq,motor.omega_e", &[("t", "time")], clock), Ok(40));
        assert_eq!(read("time,ud,uq,time_id,id,iq,omega_e", &[("t", "time")], |k| k.to_string()), Ok(40));
        // A number of a motor, a temperature, and a time of the whole beside the time.
        assert_eq!(read("t,ud,uq,t1,id,iq,omega_e", &[], |_| "7".to_owned()), Ok(40));
        assert_eq!(read("t,ud,uq,t1,id,iq,omega_e", &[], |k| (k % 3).to_string()), Ok(40));
        assert_eq!(read("t,ud,uq,t1,id,iq,omega_e", &[], |k| format!("{:.1}", 25.0 + f64::from(k / 10) * 0.1)), Ok(40));
        assert_eq!(read("log.time,ud,uq,log.t_rest,id,iq,omega_e", &[("t", "log.time")], |k| (k * 2).to_string()), Ok(40));
    }
}

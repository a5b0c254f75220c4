//! Voltage timing: the voltage that acted over each sample period, from a log's voltage columns.
//!
//! The columns hold either the commands of a drive, `delay` periods before they act, or *centred* voltages: the mean of the two periods
//! around the row, in the frame at the row. Centred voltages are converted in the stator's frame, `V_k = 2 U_k - V_(k-1)`; the first
//! vector is not in the log, and its error alternates in sign from period to period. Or the columns hold what was measured over the period
//! before the row.
//!
//! An inverter holds its voltage in the stator. Some simulators, and logs whose rows lie many of the drive's periods apart, hold it in the
//! rotor's frame. Rows that are means over their own span hold the means of the voltage as of the current: the moving mean of the current
//! obeys the motor's equation with the moving mean of the voltage, which goes about straight from row to row.
//!
//! Each command of which a row is the mean is held in the stator for a period in which the rotor turns by `x`. The flux, sampled at the
//! period's ends, goes along a chord from one to the other and not along the arc: the command is smaller than the voltage that would take
//! it along the arc, by `2 sin(x / 2) / x`. A drive that samples in the middle of its period, where the chord lies
//! below the arc, is read as one that samples at its ends.
//!
//! Many simulators that are written by hand go from row to row by Euler's rule: the slope of the current at a row, times the period. Their
//! currents obey the rule exactly, and the differential equation of the motor only roughly. A row holds the current before or after its
//! voltage acted.

use super::angles::{Angles, SMOOTHED};
use crate::{
    frames::{AlphaBeta, Dq},
    log::Log,
};
use std::ops::Range;

/// What `ud, uq` of row `k` mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageTiming {
    /// The mean of the periods before and after the row, in the frame at the row.
    Centered,
    /// What acts over the period that begins `delay` rows later.
    Delayed {
        /// Rows.
        delay: usize,
        /// The frame of its numbers.
        frame: VoltageFrame,
    },
    /// What acted over the period that ended at the row, as a drive measures it; in the frame at the middle of that period.
    Ended,
    /// In the frame at the middle of the period in which it acts, of a drive that samples in the middle of its periods.
    MidPeriod {
        /// The row holds what is commanded there, and takes effect half a period later; else what acts while it is sampled.
        later: bool,
    },
    /// The mean over the row's own span, as the currents are.
    Averaged {
        /// Of what.
        of: MeansOf,
    },
    /// By Euler's rule: the slope of the current at a row lasts until the next row.
    Euler {
        /// The row holds the current that its voltage led to, not the one before.
        after: bool,
    },
}

/// What means of voltages were made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeansOf {
    /// Of voltages that act while the currents are sampled, or of so many commands that their delay does not count.
    Voltages,
    /// Of four to eight commands, each of which acts later than the current from which it was computed, held in the stator. Three act half
    /// a row later, as what begins at the row does.
    Commands,
    /// Of two such commands.
    TwoCommands,
}

/// Periods from the sample of a current to the middle of what its command applies.
const COMMAND_DELAY: f64 = 1.5;

/// Largest turn of a rotor in a drive's period, rad: six periods per turn. Across a lost row it turns more, but not in a period.
const MOST_TURN: f64 = 1.0;

impl MeansOf {
    /// How many commands a row is the mean of; `None` where nobody knows.
    fn commands(self) -> Option<f64> {
        match self {
            Self::Voltages => None,
            // They act later by between 0.38 of a row of four periods and 0.19 of one of eight.
            Self::Commands => Some(5.0),
            Self::TwoCommands => Some(2.0),
        }
    }

    /// How far the rotor turns at most while one of them acts, where it turns so far in a row, rad; `None` where nobody knows.
    pub(crate) fn most_turn(self, turn: f64) -> Option<f64> {
        let fewest = if self == Self::Commands { Some(4.0) } else { self.commands() };
        fewest.map(|fewest| turn_of_each(turn, fewest))
    }

    /// By which part of a row they act later than the currents.
    fn later(self) -> f64 {
        self.commands().map_or(0.0, |commands| COMMAND_DELAY / commands)
    }

    /// The arc of the flux over its chord, while one of them acts and the rotor turns so far in a row, rad.
    fn arc_over_chord(self, turn: f64) -> f64 {
        let half = self.commands().map_or(0.0, |commands| 0.5 * turn_of_each(turn, commands));
        if half == 0.0 { 1.0 } else { half / half.sin() }
    }
}

/// How far the rotor turns while each of so many commands acts, where it turns so far in a row, rad.
fn turn_of_each(turn: f64, commands: f64) -> f64 {
    (turn / commands).abs().min(MOST_TURN)
}

/// The frame in which a delayed voltage is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageFrame {
    /// At the middle of the period in which it acts: the drive compensates its delay.
    Middle,
    /// At the row.
    Row,
    /// At every instant: the voltage stands still in the rotor's frame.
    Rotor,
}

/// Where a voltage stands still over a period.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    /// In the stator, as an inverter's.
    InStator,
    /// In the rotor's frame.
    InRotor,
    /// In the rotor's frame, as does the slope of the current.
    WithSlope,
}

impl VoltageTiming {
    /// Those of simulators that step by Euler's rule.
    pub(crate) const BY_EULERS_RULE: [Self; 2] = [Self::Euler { after: false }, Self::Euler { after: true }];

    /// Those of few drives. A filter or a late angle in a usual log passes for one.
    pub(crate) const RARE: [Self; 3] = [Self::Ended, Self::MidPeriod { later: false }, Self::MidPeriod { later: true }];

    /// Those of rows that are means of what a drive commands.
    pub(crate) const MEANS_OF_COMMANDS: [Self; 2] = [Self::Averaged { of: MeansOf::Commands }, Self::Averaged { of: MeansOf::TwoCommands }];

    /// All timings that are known from drives and simulators.
    pub const ALL: [Self; 17] = [
        Self::Centered,
        Self::Delayed { delay: 0, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 1, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 2, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 0, frame: VoltageFrame::Row },
        Self::Delayed { delay: 1, frame: VoltageFrame::Row },
        Self::Delayed { delay: 2, frame: VoltageFrame::Row },
        Self::RARE[0],
        Self::RARE[1],
        Self::RARE[2],
        Self::Delayed { delay: 0, frame: VoltageFrame::Rotor },
        Self::Delayed { delay: 1, frame: VoltageFrame::Rotor },
        Self::Averaged { of: MeansOf::Voltages },
        Self::MEANS_OF_COMMANDS[0],
        Self::MEANS_OF_COMMANDS[1],
        Self::BY_EULERS_RULE[0],
        Self::BY_EULERS_RULE[1],
    ];

    /// Name in files and on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::Centered => "centered",
            Self::Delayed { delay: 0, frame: VoltageFrame::Middle } => "0",
            Self::Delayed { delay: 1, frame: VoltageFrame::Middle } => "1",
            Self::Delayed { frame: VoltageFrame::Middle, .. } => "2",
            Self::Delayed { delay: 0, frame: VoltageFrame::Row } => "0-row",
            Self::Delayed { delay: 1, frame: VoltageFrame::Row } => "1-row",
            Self::Delayed { frame: VoltageFrame::Row, .. } => "2-row",
            Self::Delayed { delay: 0, frame: VoltageFrame::Rotor } => "0-rotor",
            Self::Delayed { frame: VoltageFrame::Rotor, .. } => "1-rotor",
            Self::Ended => "-1",
            Self::MidPeriod { later: false } => "-0.5",
            Self::MidPeriod { .. } => "0.5",
            Self::Averaged { of: MeansOf::Voltages } => "averaged",
            Self::Averaged { of: MeansOf::Commands } => "averaged-commands",
            Self::Averaged { of: MeansOf::TwoCommands } => "averaged-two-commands",
            Self::Euler { after: false } => "euler",
            Self::Euler { after: true } => "euler-after",
        }
    }

    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Centered => "the mean of the two periods around the row",
            Self::Delayed { delay: 0, frame: VoltageFrame::Middle } => "what acts over the period that begins at the row",
            Self::Delayed { delay: 1, frame: VoltageFrame::Middle } => "what acts one period later",
            Self::Delayed { frame: VoltageFrame::Middle, .. } => "what acts two periods later",
            Self::Delayed { delay: 0, frame: VoltageFrame::Row } => {
                "what acts over the period that begins at the row, in the frame at the row"
            }
            Self::Delayed { delay: 1, frame: VoltageFrame::Row } => "what acts one period later, in the frame at the row",
            Self::Delayed { frame: VoltageFrame::Row, .. } => "what acts two periods later, in the frame at the row",
            Self::Delayed { delay: 0, frame: VoltageFrame::Rotor } => {
                "what acts over the period that begins at the row, held in the rotor's frame"
            }
            Self::Delayed { frame: VoltageFrame::Rotor, .. } => "what acts one period later, held in the rotor's frame",
            Self::Ended => "what acted over the period that ended at the row",
            Self::MidPeriod { later: false } => "what acts from half a period before the row to half a period after it",
            Self::MidPeriod { .. } => "what acts half a period later",
            Self::Averaged { of: MeansOf::Voltages } => "the mean over the row's own span, as the currents",
            Self::Averaged { of: MeansOf::Commands } => "the mean over the row's own span, of commands that act later",
            Self::Averaged { of: MeansOf::TwoCommands } => "the mean of two commands that act later",
            Self::Euler { after: false } => "a simulator's that goes from row to row by Euler's rule",
            Self::Euler { after: true } => "a simulator's that goes from row to row by Euler's rule, and logs the current after the step",
        }
    }

    /// Rows at a segment's start whose acting voltage is not in the log.
    pub(super) fn lost_rows(self) -> usize {
        match self {
            Self::Averaged { of: MeansOf::TwoCommands } => 1,
            Self::Centered | Self::Ended | Self::Averaged { .. } | Self::Euler { .. } => 0,
            Self::Delayed { delay, .. } => delay,
            Self::MidPeriod { later } => usize::from(later),
        }
    }

    /// Where its voltages stand still.
    pub(super) fn held(self) -> Held {
        match self {
            Self::Averaged { .. } | Self::Delayed { frame: VoltageFrame::Rotor, .. } => Held::InRotor,
            Self::Euler { .. } => Held::WithSlope,
            Self::Centered | Self::Delayed { .. } | Self::Ended | Self::MidPeriod { .. } => Held::InStator,
        }
    }

    /// Whether the voltage changes in the middle between two rows: the drive samples in the middle of its periods.
    pub(crate) fn has_halves(self) -> bool {
        matches!(self, Self::MidPeriod { .. })
    }

    /// Whether the voltage of a row acts from that row on, as no drive does that computes it from what it samples there.
    pub(crate) fn acts_at_once(self) -> bool {
        matches!(self, Self::Delayed { delay: 0, .. } | Self::Ended | Self::MidPeriod { later: false } | Self::Euler { .. })
    }

    /// Whether the drive does not compensate its delay: as an angle that is late would have it.
    pub(crate) fn is_in_frame_of_row(self) -> bool {
        matches!(self, Self::Delayed { frame: VoltageFrame::Row, .. })
    }

    /// Whether it is that of a drive which logs each of its periods: then it says by how many of them the voltages lag.
    pub(crate) fn tells_lag(self) -> bool {
        !self.is_unusual() && !self.acts_at_once()
    }

    /// Whether a lag of any time can be found beside it: not where it says itself how late the voltages act, nor in the frame at the row,
    /// which is a lag.
    pub(crate) fn may_lag(self) -> bool {
        !self.tells_lag() && !self.is_in_frame_of_row()
    }

    /// The same delay with the voltage held in the rotor's frame, of one that an inverter holds in the stator.
    pub(crate) fn held_in_rotor(self) -> Option<Self> {
        match self {
            Self::Delayed { delay, frame: VoltageFrame::Middle } => Some(Self::Delayed { delay, frame: VoltageFrame::Rotor }),
            _ => None,
        }
    }

    /// Whether no inverter that logs each of its periods does so.
    pub fn is_unusual(self) -> bool {
        self.held() != Held::InStator
    }
}

/// One sample period: from a row to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Period {
    /// Its length, s.
    pub(super) length: f64,
    /// Mean speed, or that of the slope, electrical rad/s.
    pub(super) omega_e: f64,
    /// The voltage that acts, V, in the frame at its middle, or in the rotor's where it is held there.
    pub(super) u: Dq,
    /// By how much the voltage changes in the middle of the period, V, in the same frame; `u` is then the mean of both halves.
    pub(super) change_within: Dq,
    /// The stator seen from the rotor at its middle: the electrical angle, rad.
    pub(super) theta_e: f64,
    /// What the speed gains in a second, electrical rad/s²; zero where it is from the angle.
    pub(super) acceleration: f64,
    /// Mean speed, electrical rad/s, by which an angle that is read late is too small: smoothed as the rotor's angle is, if that is logged.
    pub(super) late_by: f64,
    /// What the speed, smoothed so, gains in a second where it is from the angle, electrical rad/s²; else zero. By so much times its delay
    /// the rotor turns faster than an angle that is late.
    pub(super) angle_acceleration: f64,
    /// By which the voltage would be turned further if the speed that advanced its angle lagged by a second, rad.
    pub(super) advance_per_lag: f64,
    /// The time of its middle within the log: from minus one half to plus one half.
    pub(super) time: f64,
}

/// The periods between these rows of one segment, from row [`lost_rows`](VoltageTiming::lost_rows) on: one less than there are
/// rows left.
pub(super) fn periods(log: &Log, rows: &Range<usize>, angles: &Angles, reading: VoltageTiming) -> Vec<Period> {
    let columns = log.columns();
    let first = rows.start + reading.lost_rows();
    let frame = |row: usize| angles.logged[row - rows.start];
    let logged = |row: usize| Dq { d: columns.ud[row], q: columns.uq[row] };
    let in_stator = |row: usize| angles.logged_turns[row - rows.start].forward([columns.ud[row], columns.uq[row]]);
    let in_rotor_frame = |row: usize| logged(row).turned(frame(row) - angles.rotor[row - rows.start]);
    // A row's voltage in the stator's frame. The drive advanced the angle by its speed times so many periods.
    let ahead = |row: usize, by: f64, length: f64| {
        let AlphaBeta { alpha, beta } = logged(row).to_alpha_beta(frame(row) + columns.omega_e[row] * by * length);
        [alpha, beta]
    };
    // For centred columns: the voltage that acted over the period before, in the stator's frame. The first one is not in the log; the
    // mean at the first row stands in for it.
    let mut before = in_stator(rows.start);
    let (first_time, last_time) = (columns.t[0], columns.t[columns.t.len() - 1]);
    let acceleration = |row: usize| {
        let (before, after) = (row.saturating_sub(SMOOTHED).max(rows.start), (row + SMOOTHED).min(rows.end - 1));
        (columns.omega_e[after] - columns.omega_e[before]) / (columns.t[after] - columns.t[before])
    };
    (first..rows.end.saturating_sub(1))
        .map(|row| {
            let middle = 0.5 * (angles.rotor[row - rows.start] + angles.rotor[row + 1 - rows.start]);
            let at_middle = |vector: [f64; 2]| {
                let [d, q] = angles.middle_turns[row - rows.start].backward(vector);
                Dq { d, q }
            };
            let length = columns.t[row + 1] - columns.t[row];
            let turn = angles.rotor[row + 1 - rows.start] - angles.rotor[row - rows.start];
            let mut change_within = Dq { d: 0.0, q: 0.0 };
            let u = match reading {
                VoltageTiming::Centered => {
                    let mean = in_stator(row);
                    before = [2.0 * mean[0] - before[0], 2.0 * mean[1] - before[1]];
                    at_middle(before)
                }
                VoltageTiming::Delayed { delay, frame: VoltageFrame::Middle } => at_middle(ahead(row - delay, delay as f64 + 0.5, length)),
                VoltageTiming::Ended => at_middle(ahead(row + 1, -0.5, length)),
                VoltageTiming::MidPeriod { later } => {
                    // From one row to the middle between them, and from there to the other.
                    let half = |row: usize| at_middle(ahead(row - usize::from(later), f64::from(later), length));
                    let (first, second) = (half(row), half(row + 1));
                    change_within = Dq { d: second.d - first.d, q: second.q - first.q };
                    Dq { d: 0.5 * (first.d + second.d), q: 0.5 * (first.q + second.q) }
                }
                VoltageTiming::Delayed { delay, frame: VoltageFrame::Row } => at_middle(in_stator(row - delay)),
                VoltageTiming::Delayed { delay, frame: VoltageFrame::Rotor } => in_rotor_frame(row - delay),
                VoltageTiming::Averaged { of } => {
                    // Where the middle of this period lies between the rows, seen from the first of these two.
                    let first = row - reading.lost_rows();
                    let (start, end) = (in_rotor_frame(first), in_rotor_frame(first + 1));
                    let (part, more) = (0.5 + (row - first) as f64 - of.later(), of.arc_over_chord(turn));
                    Dq { d: more * (start.d + part * (end.d - start.d)), q: more * (start.q + part * (end.q - start.q)) }
                }
                VoltageTiming::Euler { after } => in_rotor_frame(row + usize::from(after)),
            };
            let mean_speed = turn / length;
            let omega_e = if reading.held() == Held::WithSlope && !angles.known { columns.omega_e[row] } else { mean_speed };
            let (slower, faster) = (angles.speed[row - rows.start], angles.speed[row + 1 - rows.start]);
            Period {
                length,
                omega_e,
                u,
                change_within,
                theta_e: middle,
                acceleration: if angles.known { 0.0 } else { acceleration(row) },
                late_by: 0.5 * (slower + faster),
                angle_acceleration: if angles.known { (faster - slower) / length } else { 0.0 },
                advance_per_lag: match reading {
                    VoltageTiming::Delayed { delay, frame: VoltageFrame::Middle } => acceleration(row) * (delay as f64 + 0.5) * length,
                    VoltageTiming::Ended => -0.5 * acceleration(row) * length,
                    VoltageTiming::MidPeriod { later } => acceleration(row) * f64::from(later) * length,
                    VoltageTiming::Centered
                    | VoltageTiming::Delayed { .. }
                    | VoltageTiming::Averaged { .. }
                    | VoltageTiming::Euler { .. } => 0.0,
                },
                time: (columns.t[row] + 0.5 * length - first_time) / (last_time - first_time) - 0.5,
            }
        })
        .collect()
}

//! The only error of this library: misuse, or data that is not usable as a log. What a log cannot tell is no error but a
//! [verdict](crate::Verdict).
//!
//! [`ErrorKind`] carries the values; the sentence is written once, here, and says what to do. Rows count from 0; whoever read them
//! from a file knows their lines ([`Error::row`], [`Error::column`]).

use crate::motor::Parameter;

/// What went wrong: its [kind](Error::kind) for programs, its sentence for people.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(transparent)]
pub struct Error(Box<ErrorKind>);

impl<K: Into<ErrorKind>> From<K> for Error {
    fn from(kind: K) -> Self {
        Self(Box::new(kind.into()))
    }
}

/// What went wrong, with its values in SI units.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Columns of a log differ in length.
    #[error("column {column} has {rows} rows where t has {expected}; give every column the same length")]
    ColumnLength {
        /// Canonical name.
        column: &'static str,
        /// Its length.
        rows: usize,
        /// Length of `t`.
        expected: usize,
    },
    /// Fewer rows than anything can be found from.
    #[error("the log has {rows} rows; at least {least} are needed")]
    TooShort {
        /// Rows given.
        rows: usize,
        /// Rows needed.
        least: usize,
    },
    /// A value that is not a finite number.
    #[error("{column} is {value}; remove the row or write a finite number")]
    NotFinite {
        /// Canonical name.
        column: &'static str,
        /// Row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// A value that no drive has.
    #[error("{column} is {value:e}, beyond the {limit:e} that any drive can have; check the column's unit or remove the row")]
    Implausible {
        /// Canonical name.
        column: &'static str,
        /// Row, from 0.
        row: usize,
        /// The value.
        value: f64,
        /// Largest magnitude accepted.
        limit: f64,
    },
    /// Time stands still or runs backward.
    #[error(
        "time goes from {before} s to {after} s; it must increase from row to row: remove repeated rows, or give the parts as separate logs"
    )]
    TimeOrder {
        /// Row, from 0, of the later row.
        row: usize,
        /// Its predecessor's time, s.
        before: f64,
        /// Its own time, s.
        after: f64,
    },
    /// A channel without which nothing can be found is zero in every row.
    #[error("{what} zero in every row; check the mapping of columns, or log the drive while it turns and carries current")]
    AllZero {
        /// The channels, with their verb.
        what: &'static str,
    },
    /// No steady operating point.
    #[error(
        "no steady stretch of at least {least} rows was found while the motor carried current; hold speed and current constant for a while, or name a window in time"
    )]
    NoOperatingPoint {
        /// Rows that a window needs.
        least: usize,
    },
    /// No steady operating point, in a log that is too short for a window.
    #[error(
        "no steady stretch was found, and the log has {rows} rows without a gap where a window needs {least}; log longer, with speed and current held constant"
    )]
    FewRows {
        /// Rows of the longest part without a gap.
        rows: usize,
        /// Rows that a window needs.
        least: usize,
    },
    /// A window that holds too few rows.
    #[error(
        "the window {from}:{to} s holds {rows} consecutive rows of the log, which runs from {start} s to {end} s; a window needs at least {least}"
    )]
    Window {
        /// Start asked for, s.
        from: f64,
        /// End asked for, s.
        to: f64,
        /// Rows found.
        rows: usize,
        /// Rows needed.
        least: usize,
        /// First time of the log, s.
        start: f64,
        /// Last time of the log, s.
        end: f64,
    },
    /// A characteristic of too few speeds.
    #[error("the table has too few speeds ({rows}; at least {least} are needed): measure at more of them, from slow to fast")]
    ShortCharacteristic {
        /// Speeds given.
        rows: usize,
        /// Speeds needed.
        least: usize,
    },
    /// A table of voltages or torques against currents with too few of these.
    #[error(
        "the table has too few currents ({rows}; at least {least} are needed): measure at more of them, from small to large, because one \
         current does not tell the motor from a constant (contacts, drag, the zero of an instrument)"
    )]
    FewCurrents {
        /// Currents given.
        rows: usize,
        /// Currents needed.
        least: usize,
    },
    /// Currents of a short circuit alone: twice the resistance, inductances and flux would give the same ones.
    #[error(
        "a short circuit's currents alone give only ratios of the parameters; add its torque, or an open-circuit table of the same motor"
    )]
    NoScale,
    /// Currents that no short circuit has.
    #[error(
        "the currents do not follow the speed as those of shorted terminals do: the best motor misses them by {:.0} % rms; if the motor drives a load in this table, identify from a log of its drive (voltages, currents, speed over time), or from tables with open and shorted terminals", 100.0 * .missed
    )]
    NoShortCircuit {
        /// What the fit misses, as a fraction.
        missed: f64,
    },
    /// Currents that grow with the speed as those of a load do.
    #[error(
        "the currents grow with the power {power:.1} of the speed, as of a motor that drives a load (a propeller, a fan); those of shorted terminals grow in proportion at most, and level off; identify from a log of its drive (voltages, currents, speed over time), or from tables with open and shorted terminals"
    )]
    CurrentOfLoad {
        /// Of the faster half of the speeds.
        power: f64,
    },
    /// Voltages that no motor with open terminals has.
    #[error(
        "the voltages do not grow with the speed as those of open terminals do: they miss the best line by {:.0} % rms; if the motor is driven in this table, identify from a log of its drive (voltages, currents, speed over time)", 100.0 * .missed
    )]
    NoOpenCircuit {
        /// What the line misses, as a fraction.
        missed: f64,
    },
    /// Voltages that do not change with the speed.
    #[error(
        "the voltages are nearly the same at all speeds, where those of open terminals grow with the speed: a line misses them by {:.2} % rms, a constant by {:.2} %; if the motor is driven in this table, identify from a log of its drive (voltages, currents, speed over time)", 100.0 * .of_line, 100.0 * .of_constant
    )]
    ConstantVoltage {
        /// What the best line through zero misses, as a fraction.
        of_line: f64,
        /// What the best constant misses.
        of_constant: f64,
    },
    /// Rows that no motor has in such a test.
    #[error(
        "the {what} are not those of such a table: the best motor misses them by {:.0} % of the largest, rms; check the units of the columns and what they hold", 100.0 * .missed
    )]
    NoSuchTable {
        /// What is missed.
        what: &'static str,
        /// By how much, as a fraction of the largest.
        missed: f64,
    },
    /// A torque that operating points do not have.
    #[error(
        "the torque is {ratio:.3} times what voltages, currents and speed make of it: about 2 if the dq values are rms and not peak values, 2/3 if the transform is power-invariant, the number of pole pairs if the speed is electrical, another sign if one is counted the other way; state units and pole pairs, or leave the torque out of the table"
    )]
    TorqueOfPoints {
        /// Of both.
        ratio: f64,
    },
    /// Torques that are proportional to their currents but for rounding.
    #[error(
        "the torque is what the formula of a motor makes of the currents, exactly but for rounding, so the drive (or a simulation) computed it from them with its own setting of psi_f or of the torque constant: of a motor it tells nothing; log the torque of a sensor, or leave this table out"
    )]
    ComputedTorque,
    /// Open-circuit voltages that the torque of the short circuit contradicts, or another table.
    #[error(
        "the voltages with open terminals and the other tables (torque, resistance, operating points) contradict each other, and would agree if the voltages were {factor:.4} times as large: check their unit, and whether they are line to line or of a phase, rms or amplitudes (state it in the column's name: 'U_ll_rms [V]', 'U_phase_peak [V]')"
    )]
    VoltagesAgainstTorque {
        /// What the voltages would have to be multiplied by.
        factor: f64,
    },
    /// A setting outside its range.
    #[error("{setting} is {value}; it must be {range}")]
    Setting {
        /// The setting in words, as the sentence has it; not the name of a field.
        setting: &'static str,
        /// Value given.
        value: f64,
        /// Values allowed.
        range: &'static str,
    },
    /// A known value of a parameter that no motor has.
    #[error("the known value of {parameter} is {value}; it must be a finite number, {}", if has_zero(*.parameter) { "zero or more" } else { "above zero" })]
    KnownValue {
        /// The parameter.
        parameter: Parameter,
        /// Value given, SI.
        value: f64,
    },
    /// The standard error of a known value is not above zero.
    #[error("the standard error of the known value of {parameter} is {standard_error}; it must be a finite number above zero")]
    KnownError {
        /// The parameter.
        parameter: Parameter,
        /// Standard error given, SI.
        standard_error: f64,
    },
    /// Rows that were interpolated, where the output error needs those of one instant.
    #[error(
        "the log's channels were sampled at different instants, so no row is one instant of the drive and the output error means nothing; use the steady model, or log all channels together"
    )]
    Interpolated,
    /// No motor near the start of the fit has simulated currents that are numbers.
    #[error(
        "the simulated currents are no finite numbers with any inductances near those that the rows suggest; check the units and the sign of the columns, give R_s, L_d and L_q if they are known, or use the steady model"
    )]
    NoFiniteFit,
    /// A log without voltages, where the output error would simulate the currents from them.
    #[error(
        "the voltages are zero in every row, as in a short circuit, of which the output error tells no more than its steady currents; use the steady model, and fix one parameter"
    )]
    ShortCircuit,
    /// Rows are too slow to be those of the drive's control, whose rate is needed.
    #[error("rows at {rate:.3} Hz are a recorder's, not those of the drive's control; state how often the current controllers run")]
    ControlRate {
        /// Rate of the rows, Hz.
        rate: f64,
    },
    /// A log of one segment, of which a part was to be held out.
    #[error("holding out needs several logs, or one with a gap in time: this one has a single segment")]
    NothingToHoldOut,
    /// Every parameter was given.
    #[error("all four parameters are fixed; leave at least one to be identified")]
    NothingToIdentify,
    /// A search that cannot be made.
    #[error(transparent)]
    Search(#[from] fluxfit_optimize::Error),
}

/// Whether zero is a value of this parameter: of an ideal winding's resistance, and of the flux of a motor without magnets. A current
/// could not be computed with an inductance of zero.
pub(crate) fn has_zero(parameter: Parameter) -> bool {
    matches!(parameter, Parameter::Rs | Parameter::PsiF)
}

impl Error {
    /// What went wrong.
    pub fn kind(&self) -> &ErrorKind {
        &self.0
    }

    /// The error of a log without rows that could be fitted.
    pub(crate) fn no_rows() -> Self {
        ErrorKind::TooShort { rows: 0, least: 2 }.into()
    }

    /// The error of a log without voltages that is no short circuit, or of one that would have to be predicted.
    pub(crate) fn no_voltages() -> Self {
        ErrorKind::AllZero { what: "the voltages ud and uq are" }.into()
    }

    /// The error of a log whose speed is zero throughout, although its motor turned.
    pub(crate) fn no_speed() -> Self {
        ErrorKind::AllZero { what: "the motor turned, by its voltages, but the speed omega_e is" }.into()
    }

    /// The row of the log, from 0, that the error is about; `None` if it is about no single row.
    pub fn row(&self) -> Option<usize> {
        match self.kind() {
            ErrorKind::NotFinite { row, .. } | ErrorKind::Implausible { row, .. } | ErrorKind::TimeOrder { row, .. } => Some(*row),
            _ => None,
        }
    }

    /// The canonical name of the column that the error is about, as in [`Columns`](crate::Columns); `None` if it is about no single one.
    pub fn column(&self) -> Option<&'static str> {
        match self.kind() {
            ErrorKind::NotFinite { column, .. } | ErrorKind::Implausible { column, .. } | ErrorKind::ColumnLength { column, .. } => {
                Some(column)
            }
            ErrorKind::TimeOrder { .. } => Some("t"),
            _ => None,
        }
    }
}

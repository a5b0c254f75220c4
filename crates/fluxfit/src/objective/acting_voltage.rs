//! Which voltage acted when: a log's voltage columns, turned into one vector per sample period.
//!
//! Columns are the commands of a drive, `delay` periods before they act, or *centred*: the mean of the two periods around the row,
//! in the frame at the row. A centred column is undone in the stator's frame, `V_k = 2 U_k - V_(k-1)`; its first vector is not in
//! the log, and an error of it alternates in sign from period to period.

use crate::{
    frames::{AlphaBeta, Dq},
    log::{Log, Segment},
};

/// What `ud, uq` of row `k` mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageReading {
    /// The mean of the periods before and after the row, in the frame at the row.
    Centered,
    /// What acts over the period that begins `delay` rows later.
    Delayed {
        /// Rows.
        delay: usize,
        /// The frame of its numbers.
        frame: VoltageFrame,
    },
}

/// The frame in which a delayed voltage is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoltageFrame {
    /// At the middle of the period in which it acts: the drive compensates its delay.
    Middle,
    /// At the row.
    Row,
}

impl VoltageReading {
    /// All readings that drives are known to have.
    pub const ALL: [Self; 7] = [
        Self::Centered,
        Self::Delayed { delay: 0, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 1, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 2, frame: VoltageFrame::Middle },
        Self::Delayed { delay: 0, frame: VoltageFrame::Row },
        Self::Delayed { delay: 1, frame: VoltageFrame::Row },
        Self::Delayed { delay: 2, frame: VoltageFrame::Row },
    ];

    /// Rows at a segment's start whose acting voltage is not in the log.
    pub(super) fn lost_rows(self) -> usize {
        match self {
            Self::Centered => 0,
            Self::Delayed { delay, .. } => delay,
        }
    }
}

/// One sample period: from a row to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Period {
    /// Its length, s.
    pub(super) length: f64,
    /// Mean speed, electrical rad/s.
    pub(super) omega_e: f64,
    /// The voltage that acts, V, in the frame at its middle.
    pub(super) u: Dq,
    /// The stator seen from the rotor at its middle: the electrical angle from the segment's first row, rad.
    pub(super) theta_e: f64,
}

/// The periods of a segment, from row [`lost_rows`](VoltageReading::lost_rows) on: one less than it has rows left.
pub(super) fn periods(log: &Log, segment: &Segment, reading: VoltageReading) -> Vec<Period> {
    let columns = log.columns();
    let first = segment.rows.start + reading.lost_rows();
    let mut theta_at_row = vec![0.0; segment.rows.len()];
    for k in 1..segment.rows.len() {
        let row = segment.rows.start + k;
        let turn = 0.5 * (columns.omega_e[row - 1] + columns.omega_e[row]) * (columns.t[row] - columns.t[row - 1]);
        theta_at_row[k] = theta_at_row[k - 1] + turn;
    }
    let theta = |row: usize| theta_at_row[row - segment.rows.start];
    let logged = |row: usize| Dq { d: columns.ud[row], q: columns.uq[row] };
    // Of a centred column: what acted over the period before, in the stator. At the start nothing better is known than the row itself.
    let mut before = logged(segment.rows.start).to_alpha_beta(0.0);
    (first..segment.rows.end.saturating_sub(1))
        .map(|row| {
            let middle = 0.5 * (theta(row) + theta(row + 1));
            let u = match reading {
                VoltageReading::Centered => {
                    let mean = logged(row).to_alpha_beta(theta(row));
                    before = AlphaBeta { alpha: 2.0 * mean.alpha - before.alpha, beta: 2.0 * mean.beta - before.beta };
                    before.to_dq(middle)
                }
                VoltageReading::Delayed { delay, frame: VoltageFrame::Middle } => logged(row - delay),
                VoltageReading::Delayed { delay, frame: VoltageFrame::Row } => {
                    logged(row - delay).to_alpha_beta(theta(row - delay)).to_dq(middle)
                }
            };
            let omega_e = 0.5 * (columns.omega_e[row] + columns.omega_e[row + 1]);
            Period { length: columns.t[row + 1] - columns.t[row], omega_e, u, theta_e: middle }
        })
        .collect()
}

//! What the drive writes into its log of what it samples: filters, every n-th row or means of n, columns that are left out.
//!
//! Control does not see the filters: it uses the samples. A filter is of the first order, with the sample period `T` and its pole `f`
//!
//! ```text
//! y[k] = y[k-1] + (1 - e^(-2 pi f T)) (x[k] - y[k-1]),    y[0] = x[0]
//! ```
//!
//! Currents and voltages are filtered as phase quantities, in the stator frame, and then turned into the rotor frame of their row; or as
//! the d and q quantities that a drive streams.

use crate::{
    direction::Direction,
    error::Error,
    range::{positive, setting},
    recording::RecordedRow,
};
use fluxfit::frames::{AlphaBeta, Dq};
use std::f64::consts::TAU;

/// What is logged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logging {
    /// What the filters of currents and voltages act on.
    pub filter_frame: FilterFrame,
    /// Pole of the filter of the logged currents, Hz.
    pub current_filter: Option<f64>,
    /// Pole of the filter of the logged voltages, Hz; commands are not filtered.
    pub voltage_filter: Option<f64>,
    /// Pole of the filter of the logged speed, Hz.
    pub speed_filter: Option<f64>,
    /// Number of samples per row.
    pub every: u32,
    /// What becomes of them.
    pub rows: LoggedRows,
    /// Whether the angle is logged.
    pub theta_e: bool,
    /// Whether the DC voltage is logged.
    pub u_dc: bool,
}

/// What the filters of currents and voltages act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilterFrame {
    /// Phase quantities, in the stator's frame.
    Phases,
    /// d and q quantities, in the rotor's frame.
    Dq,
}

/// How a row is made of its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoggedRows {
    /// The first of them.
    First,
    /// Their mean. The angle is the direction of the mean of the unit vectors; at a constant speed that is the angle at the mean time.
    Mean,
}

impl Logging {
    /// Every sample, unfiltered, with all columns.
    pub const COMPLETE: Self = Self {
        filter_frame: FilterFrame::Phases,
        current_filter: None,
        voltage_filter: None,
        speed_filter: None,
        every: 1,
        rows: LoggedRows::First,
        theta_e: true,
        u_dc: true,
    };

    /// Refuses settings out of their ranges, for so many samples at a sample rate, Hz.
    pub(crate) fn check(&self, samples: usize, sample_rate: f64) -> Result<(), Error> {
        for (key, pole) in [
            ("log.current_filter", self.current_filter),
            ("log.voltage_filter", self.voltage_filter),
            ("log.speed_filter", self.speed_filter),
        ] {
            let Some(pole) = pole else { continue };
            positive(key, pole)?;
            if pole > 0.5 * sample_rate {
                return Err(setting(key, pole, "at most half the sample rate"));
            }
        }
        if self.every == 0 || self.every as usize > samples {
            return Err(setting("log.every", f64::from(self.every), "at least 1, and at most the number of samples"));
        }
        Ok(())
    }
}

/// The filters with their state.
#[derive(Debug, Clone)]
pub(crate) struct LogFilters {
    frame: FilterFrame,
    current: Option<LowPass<2>>,
    voltage: Option<LowPass<2>>,
    speed: Option<LowPass<1>>,
}

impl LogFilters {
    pub(crate) fn new(settings: &Logging, sample_period: f64) -> Self {
        Self {
            frame: settings.filter_frame,
            current: settings.current_filter.map(|pole| LowPass::new(pole, sample_period)),
            voltage: settings.voltage_filter.map(|pole| LowPass::new(pole, sample_period)),
            speed: settings.speed_filter.map(|pole| LowPass::new(pole, sample_period)),
        }
    }

    /// The logged current, A, of a sampled one, in the rotor's frame.
    pub(crate) fn current(&mut self, i: AlphaBeta, rotor: Direction) -> Dq {
        filtered(&mut self.current, self.frame, i, rotor)
    }

    /// The logged voltage, V.
    pub(crate) fn voltage(&mut self, u: AlphaBeta, rotor: Direction) -> Dq {
        filtered(&mut self.voltage, self.frame, u, rotor)
    }

    /// The logged speed, electrical rad/s.
    pub(crate) fn speed(&mut self, omega_e: f64) -> f64 {
        self.speed.as_mut().map_or(omega_e, |filter| {
            let [omega_e] = filter.next([omega_e]);
            omega_e
        })
    }
}

fn filtered(filter: &mut Option<LowPass<2>>, frame: FilterFrame, vector: AlphaBeta, rotor: Direction) -> Dq {
    let Some(filter) = filter else { return rotor.to_rotor(vector) };
    match frame {
        FilterFrame::Phases => {
            let [alpha, beta] = filter.next([vector.alpha, vector.beta]);
            rotor.to_rotor(AlphaBeta { alpha, beta })
        }
        FilterFrame::Dq => {
            let Dq { d, q } = rotor.to_rotor(vector);
            let [d, q] = filter.next([d, q]);
            Dq { d, q }
        }
    }
}

/// A filter of the first order, of several quantities.
#[derive(Debug, Clone)]
struct LowPass<const N: usize> {
    /// `1 - e^(-2 pi f T)`.
    gain: f64,
    /// The last output; `None` before the first input.
    output: Option<[f64; N]>,
}

impl<const N: usize> LowPass<N> {
    /// A filter with its pole, Hz.
    fn new(pole: f64, sample_period: f64) -> Self {
        Self { gain: -(-TAU * pole * sample_period).exp_m1(), output: None }
    }

    fn next(&mut self, input: [f64; N]) -> [f64; N] {
        let mut output = self.output.unwrap_or(input);
        for (y, x) in output.iter_mut().zip(input) {
            *y += self.gain * (x - *y);
        }
        self.output = Some(output);
        output
    }
}

/// The samples of a row that is not complete yet.
#[derive(Debug, Clone)]
pub(crate) struct RowBuilder {
    every: u32,
    rows: LoggedRows,
    samples: u32,
    /// The first sample or, for a mean, the sum of all.
    row: RecordedRow,
    /// Sum of the unit vectors of the angle: cosine and sine.
    direction: [f64; 2],
}

impl RowBuilder {
    pub(crate) fn new(settings: &Logging) -> Self {
        Self { every: settings.every, rows: settings.rows, samples: 0, row: RecordedRow::default(), direction: [0.0; 2] }
    }

    /// Takes a sample, and returns a row if this is the sample at which it is complete. The last samples of a log may not fill a row.
    pub(crate) fn take(&mut self, sample: RecordedRow) -> Option<RecordedRow> {
        if self.every == 1 {
            return Some(sample);
        }
        let first = self.samples == 0;
        self.samples = (self.samples + 1) % self.every;
        match self.rows {
            LoggedRows::First => first.then_some(sample),
            LoggedRows::Mean => {
                let (sin, cos) = sample.theta_e.sin_cos();
                let unit = [cos, sin];
                (self.row, self.direction) =
                    if first { (sample, unit) } else { (sum(&self.row, &sample), [self.direction[0] + cos, self.direction[1] + sin]) };
                (self.samples == 0).then(|| self.mean())
            }
        }
    }

    fn mean(&self) -> RecordedRow {
        let count = f64::from(self.every);
        let of = |sum: f64| sum / count;
        let vector = |sum: Dq| Dq { d: of(sum.d), q: of(sum.q) };
        let [cos, sin] = self.direction;
        let row = &self.row;
        RecordedRow {
            t: of(row.t),
            u: vector(row.u),
            i: vector(row.i),
            omega_e: of(row.omega_e),
            theta_e: sin.atan2(cos),
            u_ref: vector(row.u_ref),
            u_dc: of(row.u_dc),
        }
    }
}

/// The sum of two rows; of the angle, which has none, the second.
fn sum(a: &RecordedRow, b: &RecordedRow) -> RecordedRow {
    let vector = |a: Dq, b: Dq| Dq { d: a.d + b.d, q: a.q + b.q };
    RecordedRow {
        t: a.t + b.t,
        u: vector(a.u, b.u),
        i: vector(a.i, b.i),
        omega_e: a.omega_e + b.omega_e,
        theta_e: b.theta_e,
        u_ref: vector(a.u_ref, b.u_ref),
        u_dc: a.u_dc + b.u_dc,
    }
}

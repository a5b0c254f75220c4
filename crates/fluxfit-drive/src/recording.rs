//! The recording: what a simulated drive logs, in canonical columns.

use fluxfit::{
    error::Error,
    frames::Dq,
    log::{Columns, Log},
};

/// One row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// s.
    pub t: f64,
    /// The voltage that the drive believes in, V, centred: the mean of the two periods around the sample, in the frame at the sample.
    pub u: Dq,
    /// A, sampled.
    pub i: Dq,
    /// Electrical rad/s.
    pub omega_e: f64,
    /// Electrical rad, between minus and plus pi.
    pub theta_e: f64,
    /// The command computed from this sample, V: acts over the period after the next sample, in the frame at that period's middle.
    pub u_ref: Dq,
    /// V.
    pub u_dc: f64,
}

/// What a simulated drive logs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    /// What identification reads, with angle (between minus and plus pi) and DC voltage, as measured.
    pub columns: Columns,
    /// Command along d, V.
    pub ud_ref: Vec<f64>,
    /// Command along q, V.
    pub uq_ref: Vec<f64>,
}

impl Recording {
    /// An empty recording with room for `rows`.
    pub fn with_capacity(rows: usize) -> Self {
        let room = || Vec::with_capacity(rows);
        Self {
            columns: Columns {
                t: room(),
                ud: room(),
                uq: room(),
                id: room(),
                iq: room(),
                omega_e: room(),
                theta_e: Some(room()),
                u_dc: Some(room()),
            },
            ud_ref: room(),
            uq_ref: room(),
        }
    }

    /// Appends a row.
    pub fn push(&mut self, row: &Row) {
        let columns = &mut self.columns;
        for (column, value) in [
            (&mut columns.t, row.t),
            (&mut columns.ud, row.u.d),
            (&mut columns.uq, row.u.q),
            (&mut columns.id, row.i.d),
            (&mut columns.iq, row.i.q),
            (&mut columns.omega_e, row.omega_e),
            (columns.theta_e.get_or_insert_default(), row.theta_e),
            (&mut self.ud_ref, row.u_ref.d),
            (&mut self.uq_ref, row.u_ref.q),
            (columns.u_dc.get_or_insert_default(), row.u_dc),
        ] {
            column.push(value);
        }
    }

    /// Canonical names and columns, `t` first.
    pub fn named(&self) -> Vec<(&'static str, &[f64])> {
        let columns = &self.columns;
        let mut named: Vec<(&'static str, &[f64])> = columns.named().map(|(name, column)| (name, column.as_slice())).into();
        named.extend(columns.theta_e.as_deref().map(|angle| ("theta_e", angle)));
        named.extend([("ud_ref", self.ud_ref.as_slice()), ("uq_ref", self.uq_ref.as_slice())]);
        named.extend(columns.u_dc.as_deref().map(|voltage| ("u_dc", voltage)));
        named
    }

    /// The log that an identification reads.
    ///
    /// # Errors
    /// If the drive never turned or never carried current.
    pub fn log(&self) -> Result<Log, Error> {
        Log::new(self.columns.clone())
    }
}

//! The recording: the log of a simulated drive, in canonical columns.

use fluxfit::{
    error::Error,
    frames::Dq,
    log::{Columns, Log},
};

/// One row of the log.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RecordedRow {
    /// Time, s.
    pub t: f64,
    /// Commanded voltage, V, centred: the mean of the two periods around the sample, in the frame at the sample.
    pub u: Dq,
    /// Sampled current, A.
    pub i: Dq,
    /// Speed, electrical rad/s.
    pub omega_e: f64,
    /// Angle, electrical rad, from -pi to pi.
    pub theta_e: f64,
    /// The voltage command computed from this sample, V: it acts over the period after the next sample, in the frame at the middle of
    /// that period.
    pub u_ref: Dq,
    /// DC voltage, V.
    pub u_dc: f64,
}

/// The log of a simulated drive.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    /// The columns for an identification, with measured angle (from -pi to pi) and DC voltage.
    pub columns: Columns,
    /// Voltage command along d, V.
    pub ud_ref: Vec<f64>,
    /// Voltage command along q, V.
    pub uq_ref: Vec<f64>,
}

impl Recording {
    /// An empty recording with capacity for `rows`; `None` if there is no memory for it.
    pub fn with_capacity(rows: usize) -> Option<Self> {
        let column = || {
            let mut column = Vec::new();
            column.try_reserve_exact(rows).is_ok().then_some(column)
        };
        Some(Self {
            columns: Columns {
                t: column()?,
                ud: column()?,
                uq: column()?,
                id: column()?,
                iq: column()?,
                omega_e: column()?,
                theta_e: Some(column()?),
                u_dc: Some(column()?),
                temperature: None,
            },
            ud_ref: column()?,
            uq_ref: column()?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, row: &RecordedRow) {
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

    /// The log for an identification.
    ///
    /// # Errors
    /// If the motor never turned or never carried current.
    pub fn log(&self) -> Result<Log, Error> {
        Log::new(self.columns.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_no_machine_holds_are_none() {
        assert!(Recording::with_capacity(usize::MAX / 8).is_none());
        assert!(Recording::with_capacity(usize::MAX).is_none());
        assert_eq!(
            Recording::with_capacity(0),
            Some(Recording {
                columns: Columns { theta_e: Some(vec![]), u_dc: Some(vec![]), ..Columns::default() },
                ..Recording::default()
            })
        );
    }
}

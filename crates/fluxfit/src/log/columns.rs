//! Columns and rows of a log, before they are checked.

use std::ops::Range;

/// Fewest rows of a log: two make a sample period.
pub(super) const MIN_ROWS: usize = 2;

/// The columns of a log, row by row in SI units (temperatures in degC), all of one length. The field names are the canonical names in
/// messages and files.
///
/// Voltages and currents are in the amplitude-invariant dq frame of [`frames`](crate::frames) (peak values per phase), currents counted
/// into the motor. Voltages are those at the terminals, or the drive's commands for them; when they act relative to their row is
/// [`Request::voltage_timing`](crate::Request::voltage_timing). Rows may come at any rate; which [`Model`](crate::Model) suits the log
/// depends on it. [`Log::new`](crate::Log::new) checks the columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Time, s.
    pub t: Vec<f64>,
    /// Voltage along d, V.
    pub ud: Vec<f64>,
    /// Voltage along q, V.
    pub uq: Vec<f64>,
    /// Current along d, A.
    pub id: Vec<f64>,
    /// Current along q, A.
    pub iq: Vec<f64>,
    /// Speed, electrical rad/s: mechanical speed times pole pairs.
    pub omega_e: Vec<f64>,
    /// Angle of the d axis from phase a, electrical rad, wrapped or not; optional. Without it, dead time,
    /// offsets and unequal gains of the current sensors are not looked for.
    pub theta_e: Option<Vec<f64>>,
    /// DC link voltage, V; optional. With it, rows at the inverter's voltage limit are noticed.
    pub u_dc: Option<Vec<f64>>,
    /// Temperature of the winding, degC; optional. With it, R_s is also told at 20 degC.
    pub temperature: Option<Vec<f64>>,
}

/// One row of a log, in SI units; the names are those of [`Columns`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// Time, s.
    pub t: f64,
    /// Voltage along d, V.
    pub ud: f64,
    /// Voltage along q, V.
    pub uq: f64,
    /// Current along d, A.
    pub id: f64,
    /// Current along q, A.
    pub iq: f64,
    /// Speed, electrical rad/s.
    pub omega_e: f64,
    /// Angle of the d axis from phase a, electrical rad, wrapped or not; optional.
    pub theta_e: Option<f64>,
    /// DC link voltage, V; optional.
    pub u_dc: Option<f64>,
    /// Temperature of the winding, degC; optional.
    pub temperature: Option<f64>,
}

impl Columns {
    /// A row; `None` if the log is shorter.
    pub fn row(&self, k: usize) -> Option<Row> {
        let [t, ud, uq, id, iq, omega_e] = self.named().map(|(_, column)| column.get(k).copied());
        let [theta_e, u_dc, temperature] =
            [&self.theta_e, &self.u_dc, &self.temperature].map(|column| column.as_ref().and_then(|column| column.get(k).copied()));
        Some(Row { t: t?, ud: ud?, uq: uq?, id: id?, iq: iq?, omega_e: omega_e?, theta_e, u_dc, temperature })
    }

    /// Canonical names and columns that every log has, `t` first.
    pub fn named(&self) -> [(&'static str, &Vec<f64>); 6] {
        [("t", &self.t), ("ud", &self.ud), ("uq", &self.uq), ("id", &self.id), ("iq", &self.iq), ("omega_e", &self.omega_e)]
    }

    /// The optional columns that are present.
    pub fn optional(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        [("theta_e", &self.theta_e), ("u_dc", &self.u_dc), ("temperature", &self.temperature)]
            .into_iter()
            .filter_map(|(name, column)| Some((name, column.as_ref()?)))
    }

    /// All columns that are present.
    pub(super) fn all(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        self.named().into_iter().chain(self.optional())
    }

    /// A copy of some rows.
    pub(crate) fn of_rows(&self, rows: Range<usize>) -> Self {
        let of = |column: &Vec<f64>| column[rows.clone()].to_vec();
        Self {
            t: of(&self.t),
            ud: of(&self.ud),
            uq: of(&self.uq),
            id: of(&self.id),
            iq: of(&self.iq),
            omega_e: of(&self.omega_e),
            theta_e: self.theta_e.as_ref().map(of),
            u_dc: self.u_dc.as_ref().map(of),
            temperature: self.temperature.as_ref().map(of),
        }
    }

    /// Leaves out the rows that are not marked.
    pub(super) fn retain(&mut self, kept: &[bool]) {
        let Self { t, ud, uq, id, iq, omega_e, theta_e, u_dc, temperature } = self;
        let optional = [theta_e, u_dc, temperature].into_iter().filter_map(Option::as_mut);
        for column in [t, ud, uq, id, iq, omega_e].into_iter().chain(optional) {
            let mut marks = kept.iter();
            column.retain(|_| marks.next().is_some_and(|kept| *kept));
        }
    }

    /// Appends the rows of other columns. An optional column stays only if both have it.
    pub(super) fn append(&mut self, other: Self) {
        self.t.extend(other.t);
        self.ud.extend(other.ud);
        self.uq.extend(other.uq);
        self.id.extend(other.id);
        self.iq.extend(other.iq);
        self.omega_e.extend(other.omega_e);
        let optional = [(&mut self.theta_e, other.theta_e), (&mut self.u_dc, other.u_dc), (&mut self.temperature, other.temperature)];
        for (to, from) in optional {
            *to = to.take().zip(from).map(|(mut to, from)| {
                to.extend(from);
                to
            });
        }
    }
}

impl From<Row> for Columns {
    fn from(row: Row) -> Self {
        Self {
            t: vec![row.t],
            ud: vec![row.ud],
            uq: vec![row.uq],
            id: vec![row.id],
            iq: vec![row.iq],
            omega_e: vec![row.omega_e],
            theta_e: row.theta_e.map(|value| vec![value]),
            u_dc: row.u_dc.map(|value| vec![value]),
            temperature: row.temperature.map(|value| vec![value]),
        }
    }
}

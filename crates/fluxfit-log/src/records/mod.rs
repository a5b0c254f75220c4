//! Logs of text that are no tables of cells: JSON, LabVIEW's LVM, and CAN frames with a DBC.

mod candump;
mod json;
mod lvm;
mod memory;

use crate::{
    block::{Block, ColumnHead, WantedColumn},
    csv::Text,
    problem::Problem,
};
use fluxfit_files::FileError;

/// Texts that are named, because they cannot be read.
const OTHERS: [(&str, &str); 3] = [
    ("date ", "a Vector ASC log of CAN frames"),
    ("timestamp,arbitration_id,", "a log of CAN frames as CSV"),
    (";$FILEVERSION=", "a trace of PEAK's PCAN-View (.trc) of CAN frames"),
];

/// Settings of Yokogawa's oscilloscopes above the samples, which have no times.
const OF_YOKOGAWA: [&str; 3] = ["TraceName", "HResolution", "HOffset"];

/// Whether a text begins with these.
fn is_of_yokogawa(head: &str) -> bool {
    let first = |line: &str| line.split(',').next().unwrap_or_default().trim_matches(['"', ' ', '\t']).to_owned();
    let settings: Vec<String> = head.lines().take(LINES_OF_SETTINGS).map(first).collect();
    OF_YOKOGAWA.iter().all(|wanted| settings.iter().any(|setting| setting == wanted))
}

const LINES_OF_SETTINGS: usize = 40;

/// Names of the columns of CAN frames in a table, as SavvyCAN, PCAN and others write them: the identifier, the number of bytes, and these.
const FRAMES: [&[&str]; 3] =
    [&["id", "can id", "can_id", "canid", "identifier", "message id"], &["len", "dlc", "length"], &["d1", "b1", "byte1", "data1", "data"]];

/// Whether the columns of a table are those of CAN frames: its `ID` is then no current.
fn is_table_of_frames(head: &str) -> bool {
    let names = head.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default().split([',', ';', '\t']);
    let names: Vec<String> = names.map(|name| name.trim_matches([' ', '"']).to_lowercase()).collect();
    let has = |any: &[&str]| any.iter().any(|wanted| names.iter().any(|name| name == wanted));
    // Beside a current or voltage of the other axis `ID` is a current.
    FRAMES.iter().all(|any| has(any)) && !has(&["iq", "uq", "vq", "i_q", "u_q", "v_q"])
}

/// A log whose columns are known, and whose rows may not be read yet.
pub(crate) enum Records {
    Json(Box<json::Json>),
    Memory { kind: &'static str, table: memory::Table },
}

impl Records {
    /// Whether a text is such a log.
    ///
    /// # Errors
    /// If it is one that is not read.
    pub(crate) fn has(text: &Text) -> Result<bool, FileError> {
        let head = text.head.as_str();
        if let Some((_, what)) = OTHERS.iter().find(|(start, _)| head.starts_with(start) && (*start != "date " || head.contains("base "))) {
            return Err(Problem::CanLog { what }.into());
        }
        if is_of_yokogawa(head) {
            return Err(Problem::Yokogawa.into());
        }
        if is_table_of_frames(head) {
            return Err(Problem::CanLog { what: "a log of CAN frames as CSV" }.into());
        }
        if candump::is_without_times(head) {
            return Err(Problem::NoFrameTimes.into());
        }
        Ok(json::is_json(head) || lvm::is_lvm(head) || candump::is_candump(head))
    }

    /// Reads up to the columns. CAN frames are named by the text of a DBC.
    ///
    /// # Errors
    /// If the text cannot be read, or has no columns of numbers.
    pub(crate) fn open(text: Text, dbc: Option<&str>) -> Result<Self, FileError> {
        if json::is_json(&text.head) {
            return json::open(text).map(|opened| match opened {
                json::Opened::Records(json) => Self::Json(json),
                json::Opened::Columns(table) => Self::Memory { kind: "JSON, a list for each column", table },
            });
        }
        if lvm::is_lvm(&text.head) {
            return Ok(Self::Memory { kind: "LabVIEW measurement", table: lvm::read(text)? });
        }
        let dbc = dbc.ok_or(Problem::NoDbc)?;
        Ok(Self::Memory { kind: "candump, named by a DBC", table: candump::read(text, dbc)? })
    }

    /// The format, in a few words.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Json(_) => "JSON, a record for each row",
            Self::Memory { kind, .. } => kind,
        }
    }

    /// The columns.
    pub(crate) fn heads(&self) -> &[ColumnHead] {
        match self {
            Self::Json(json) => &json.heads,
            Self::Memory { table, .. } => &table.heads,
        }
    }

    /// Names of columns that hold no numbers.
    pub(crate) fn unreadable(&self) -> &[String] {
        match self {
            Self::Json(json) => &json.unreadable,
            Self::Memory { table, .. } => &table.unreadable,
        }
    }

    /// What was inferred.
    pub(crate) fn notes(&self) -> &[String] {
        match self {
            Self::Json(_) => &[],
            Self::Memory { table, .. } => &table.notes,
        }
    }

    /// Passes the rows of columns of one group to `take`.
    ///
    /// # Errors
    /// If a value is not a number, or `take` fails.
    pub(crate) fn read(
        &mut self,
        wanted: &[WantedColumn],
        take: &mut dyn FnMut(&mut Block) -> Result<(), FileError>,
    ) -> Result<Vec<String>, FileError> {
        match self {
            Self::Json(json) => json.read(wanted, take),
            Self::Memory { table, .. } => table.read(wanted, take).map(|()| Vec::new()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_frames_are_told_from_logs() {
        for header in [
            "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8",
            "\"Time\";\"CAN ID\";\"DLC\";\"Data\"",
            "\ntime\tid\tdlc\tb0\tb1",
        ] {
            assert!(is_table_of_frames(header), "{header}");
        }
        for header in ["t,id,iq,ud,uq,omega_e", "ID,length,width", "t,d1,id"] {
            assert!(!is_table_of_frames(header), "{header}");
        }
    }
}

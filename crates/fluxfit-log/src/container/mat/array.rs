//! The arrays of numbers that a MAT or HDF5 file contains.

use std::collections::HashMap;

/// What a file contains.
pub(super) struct Contents<Place> {
    pub(super) arrays: Vec<Array<Place>>,
    /// Values of fields called `label`, `Name` and `Unit`, by the path of the field.
    pub(super) labels: HashMap<String, String>,
    /// Objects that only MATLAB can read.
    pub(super) objects: Vec<Object>,
    /// Other variables that hold no numbers.
    pub(super) unreadable: Vec<String>,
}

impl<Place> Default for Contents<Place> {
    fn default() -> Self {
        Self { arrays: Vec::new(), labels: HashMap::new(), objects: Vec::new(), unreadable: Vec::new() }
    }
}

/// An array of two dimensions.
pub(super) struct Array<Place> {
    pub(super) path: String,
    pub(super) unit: Option<String>,
    pub(super) rows: u64,
    pub(super) columns: u64,
    pub(super) place: Place,
}

pub(super) struct Object {
    pub(super) name: String,
    pub(super) class: String,
}

/// The elements of an array with one of the two indices fixed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Line {
    /// `(:,k)`, from 0.
    Column(u64),
    /// `(k,:)`, from 0.
    Row(u64),
}

impl Object {
    /// Whether MATLAB keeps tables or signals in objects of this class.
    pub(super) fn holds_a_table(&self) -> bool {
        let classes = ["table", "timetable", "timeseries", "tscollection", "Simulink.SimulationData.Dataset", "Simulink.SimulationOutput"];
        classes.contains(&self.class.as_str())
    }
}

/// Fields with texts that name the numbers of their structure, or state their unit.
pub(super) fn is_label(path: &str) -> bool {
    [".label", ".Name", ".Unit"].iter().any(|field| path.ends_with(field))
}

/// The path of a field.
pub(super) fn join(path: &str, field: &str) -> String {
    if path.is_empty() { field.to_owned() } else { format!("{path}.{field}") }
}

/// Whether an array has the two elements that make it a column.
pub(super) fn is_column(rows: u64, columns: u64) -> bool {
    rows.min(columns) >= 1 && rows.max(columns) >= 2
}

//! Results of Modelica tools (Dymola, OpenModelica) in MAT files of version 4.
//!
//! `name` and `description` have a text for each variable of the model; `dataInfo` says of each in which matrix, `data_1` or `data_2`, and
//! in which of its lines it is, negative where it has the other sign. `data_1` has what never changes, `data_2` the rest, the time first.
//! `Aclass` names the format, and whether all of these lie on their sides (`binTrans`, as simulations write them).

use super::{
    array::{Array, Contents},
    numbers::Place,
    v4::Variable,
};
use crate::container::{
    fault::{damaged, unread},
    limits::MOST_COLUMNS,
    random_access::RandomAccess,
};
use fluxfit_files::FileError;

/// Bytes of the longest of the matrices that describe the others.
const LONGEST: u64 = 1 << 24;

/// Most variables of a model.
const MOST_VARIABLES: u64 = 1 << 18;

/// Most texts of `Aclass`, which has four.
const LONGEST_CLASS: u64 = 8;

/// The matrix of what changes.
const CHANGING: f64 = 2.0;

/// The variables of a model that change; none if the file has other matrices.
pub(super) fn contents(source: &RandomAccess, variables: &[Variable]) -> Result<Option<Contents<Place>>, FileError> {
    let find = |name: &str| variables.iter().find(|variable| variable.name == name);
    let (Some(class), Some(names), Some(infos), Some(data)) = (find("Aclass"), find("name"), find("dataInfo"), find("data_2")) else {
        return Ok(None);
    };
    if class.rows > LONGEST_CLASS {
        return Ok(None);
    }
    let class = Texts::read(source, class)?.lines(false);
    if class.first().is_none_or(|first| first != "Atrajectory") {
        return Ok(None);
    }
    let lying = class.get(3).is_some_and(|orientation| orientation == "binTrans");
    let (count, each) = if lying { (infos.columns, infos.rows) } else { (infos.rows, infos.columns) };
    let of_names = if lying { names.columns } else { names.rows };
    if of_names != count || count > MOST_VARIABLES || each < 2 || !infos.is_matrix || !data.is_matrix {
        return Err(damaged("MAT", "its names and its data do not agree").in_column("dataInfo"));
    }
    let names = Texts::read(source, names)?.lines(lying);
    let descriptions = find("description").map(|texts| Texts::read(source, texts)).transpose()?.map(|texts| texts.lines(lying));
    let infos = numbers(source, infos)?;
    if names.len() as u64 != count {
        return Ok(None);
    }
    let info =
        |variable: usize, which: usize| if lying { infos[variable * each as usize + which] } else { infos[which * names.len() + variable] };
    let (lines, rows) = if lying { (data.rows, data.columns) } else { (data.columns, data.rows) };
    let mut contents = Contents::default();
    for (place, name) in names.iter().enumerate() {
        let (matrix, line) = (info(place, 0), info(place, 1));
        // The time is in both.
        let changes = matrix == CHANGING || matrix == 0.0 && place == 0;
        if !changes || !(1.0..=lines as f64).contains(&line.abs()) || rows < 2 {
            continue;
        }
        if line < 0.0 || contents.arrays.len() == MOST_COLUMNS {
            contents.unreadable.push(name.clone());
            continue;
        }
        let (line, width) = (line as u64 - 1, data.number.width() as u64);
        let own = |offset: u64, rows: u64| Place { offset: offset * width, ..Place::plain(data.from, data.to, data.number, rows) };
        let unit = descriptions.as_ref().and_then(|texts| unit(texts.get(place)?));
        contents.arrays.push(match lying {
            true => Array { path: name.clone(), unit, rows: 1, columns: rows, place: own(line, lines) },
            false => Array { path: name.clone(), unit, rows, columns: 1, place: own(line * rows, rows) },
        });
    }
    Ok(Some(contents))
}

/// The unit at the end of a description, `Stator current [A]`; the first of `[rad/s|rpm]`, the second being the one in which
/// the tool shows it.
fn unit(description: &str) -> Option<String> {
    let (_, unit) = description.trim_end().strip_suffix(']')?.rsplit_once('[')?;
    let unit = unit.split(['|', ':']).next().unwrap_or(unit).trim();
    (!unit.is_empty() && unit != "1").then(|| unit.to_owned())
}

/// A matrix of letters.
struct Texts {
    letters: Vec<u8>,
    rows: usize,
}

impl Texts {
    fn read(source: &RandomAccess, variable: &Variable) -> Result<Self, FileError> {
        let letters = numbers(source, variable)?.into_iter().map(|letter| letter as u8).collect();
        Ok(Self { letters, rows: variable.rows as usize })
    }

    /// Its rows as texts; its columns if it lies on its side.
    fn lines(&self, lying: bool) -> Vec<String> {
        if self.letters.is_empty() {
            return Vec::new();
        }
        let rows = self.rows;
        let text = |letters: Vec<u8>| String::from_utf8_lossy(&letters).trim_matches(['\0', ' ']).to_owned();
        match lying {
            true => self.letters.chunks(rows).map(|column| text(column.to_vec())).collect(),
            false => (0..self.rows).map(|row| text(self.letters.iter().skip(row).step_by(rows).copied().collect())).collect(),
        }
    }
}

fn numbers(source: &RandomAccess, variable: &Variable) -> Result<Vec<f64>, FileError> {
    let length = variable.to - variable.from;
    if length > LONGEST {
        return Err(damaged("MAT", "it is too long").in_column(&variable.name));
    }
    let bytes = source.bytes_at(variable.from, length).map_err(|error| unread("MAT", &error))?;
    let mut numbers = Vec::new();
    variable.number.decode(&bytes, &mut numbers);
    Ok(numbers)
}

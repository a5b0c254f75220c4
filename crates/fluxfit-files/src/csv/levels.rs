//! Names above further lines that are neither rows nor units alone: two levels of names, as pandas writes those of a MultiIndex, and what
//! a simulator states of each signal (`Type: double`, `Unit: A`), a line for each.

use super::{
    record::{first_record, lines, number},
    unit_names::UNITS,
};

/// Most lines between the names and the rows.
const MOST: usize = 8;

/// What a line states of each signal: `Unit: A`.
const KEYS: [&str; 12] = [
    "type",
    "data type",
    "unit",
    "units",
    "interp",
    "interpolation",
    "source",
    "block path",
    "blockpath",
    "port index",
    "portindex",
    "sync",
];

/// Types of numbers, of which a line may consist.
const TYPES: [&str; 22] = [
    "double", "single", "float", "float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "boolean",
    "bool", "real", "lreal", "int", "dint", "uint", "udint", "logical",
];

fn is_number(cell: &str) -> bool {
    number(cell.as_bytes(), b';', &mut String::new()).is_some()
}

/// The names of the columns, their units and where the rows begin.
pub(super) struct Levels {
    pub(super) names: Vec<String>,
    pub(super) units: Vec<String>,
    /// Offset of the first row.
    pub(super) body: usize,
}

/// Such names in the line that begins at an offset; none if it is another line.
pub(super) fn find(text: &str, start: usize, separator: u8) -> Option<Levels> {
    let (names, length) = first_record(&text[start..], separator);
    if names.len() < 2 || names.iter().any(|name| is_number(name)) {
        return None;
    }
    let mut above: Vec<Vec<String>> = Vec::new();
    for (offset, line) in lines(&text[start + length..]).filter(|(_, line)| !line.trim().is_empty()).take(MOST + 1) {
        let (cells, _) = first_record(line, separator);
        let body = start + length + offset;
        if cells.iter().any(|cell| is_number(cell)) {
            return of_keys(&names, &above)
                .or_else(|| of_types(&names, &above))
                .or_else(|| two(&names, &above))
                .map(|(names, units)| Levels { names, units, body });
        }
        if cells.len() > names.len() {
            return None;
        }
        above.push(cells);
    }
    None
}

type NamesAndUnits = (Vec<String>, Vec<String>);

/// Lines of which each cell states what it is.
fn of_keys(names: &[String], above: &[Vec<String>]) -> Option<NamesAndUnits> {
    let stated = |cell: &String| {
        let (key, value) = cell.split_once(':')?;
        let key = key.trim().to_lowercase();
        KEYS.contains(&key.as_str()).then(|| (key, value.trim().to_owned()))
    };
    let filled = |line: &[String]| line.iter().filter(|cell| !cell.is_empty()).count();
    let is_stated = |line: &Vec<String>| filled(line) > 0 && line.iter().all(|cell| cell.is_empty() || stated(cell).is_some());
    if above.is_empty() || !above.iter().all(is_stated) {
        return None;
    }
    let mut units = vec![String::new(); names.len()];
    for (place, cell) in above.iter().flat_map(|line| line.iter().enumerate()) {
        if let Some((_, unit)) = stated(cell).filter(|(key, _)| key.starts_with("unit")) {
            units[place] = unit;
        }
    }
    Some((names.to_vec(), units))
}

/// Lines of which one has the types of the numbers; one may have their units.
fn of_types(names: &[String], above: &[Vec<String>]) -> Option<NamesAndUnits> {
    let share = |line: &[String], known: &[&str]| line.iter().filter(|cell| known.contains(&cell.to_lowercase().as_str())).count();
    let is_types = |line: &Vec<String>| share(line, &TYPES) + 1 >= line.len().max(2) && line.len() + 1 >= names.len();
    above.iter().find(|line| is_types(line))?;
    let units = above.iter().find(|line| 2 * share(line, &UNITS) > line.len()).cloned().unwrap_or_default();
    Some((names.to_vec(), units))
}

/// Two levels of names; below them may be the name of the first column alone.
fn two(first: &[String], above: &[Vec<String>]) -> Option<NamesAndUnits> {
    let (second, index) = match above {
        [second] => (second, None),
        [second, index] if index.len() == 1 => (second, Some(&index[0])),
        _ => return None,
    };
    let cell = |line: &[String], place: usize| line.get(place).cloned().unwrap_or_default();
    let lower: Vec<String> = (1..first.len()).map(|place| cell(second, place)).collect();
    let upper = &first[1..];
    let filled: Vec<&String> = lower.iter().filter(|name| !name.is_empty()).collect();
    let units = filled.iter().filter(|name| UNITS.contains(&name.to_lowercase().as_str())).count();
    let repeats = upper.windows(2).any(|pair| pair[0] == pair[1] && !pair[0].is_empty());
    if !repeats || 2 * units >= filled.len() || upper.iter().any(String::is_empty) {
        return None;
    }
    let is_distinct = |names: &[String]| names.iter().enumerate().all(|(place, name)| !names[..place].contains(name));
    // What is distinct by itself is the name: `motor.id`. Of `current` and `d` both are it.
    let mark = if is_distinct(&lower) { "." } else { " " };
    let joined = |(upper, lower): (&String, &String)| if lower.is_empty() { upper.clone() } else { format!("{upper}{mark}{lower}") };
    let names: Vec<String> = upper.iter().zip(&lower).map(joined).collect();
    let beside = [first[0].clone(), cell(second, 0)].into_iter().filter(|name| !name.is_empty()).collect::<Vec<_>>().join(" ");
    let names: Vec<String> = std::iter::once(index.cloned().unwrap_or(beside)).chain(names).collect();
    is_distinct(&names).then_some((names, Vec::new()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Option<(String, String, &str)> {
        find(text, 0, b',').map(|levels| (levels.names.join(";"), levels.units.join(";"), &text[levels.body..]))
    }

    fn expected<'a>(names: &str, units: &str, rows: &'a str) -> Option<(String, String, &'a str)> {
        Some((names.to_owned(), units.to_owned(), rows))
    }

    #[test]
    fn two_levels_of_names_become_one() {
        let rows = "0,1,2,3\n1,1,2,3\n";
        for (above, names) in [
            (",current,current,speed\n,d,q,n\n", ";current.d;current.q;speed.n"),
            (",current,current,voltage\n,d,q,d\n", ";current d;current q;voltage d"),
            ("axis,motor,motor,motor\nquantity,id,iq,n\ntime,,,\n", "time;motor.id;motor.iq;motor.n"),
            ("time,motor,motor,motor\n,id,iq,n\n", "time;motor.id;motor.iq;motor.n"),
        ] {
            let text = format!("{above}{rows}");
            assert_eq!(found(&text), expected(names, "", rows), "{above}");
        }
    }

    #[test]
    fn what_is_stated_of_signals_is_no_row() {
        let rows = "0,1,2\n1,1,2\n";
        for (above, units) in [
            ("time,id,iq\n,Type: double,Type: double\n,Unit: A,Unit: mA\n,Interp: zoh,Interp: zoh\n", ";A;mA"),
            ("time,id,iq\ns,A,A\ndouble,double,double\nlog,model/a,model/b\n", "s;A;A"),
            ("time,id,iq\nREAL,REAL,REAL\n", ""),
        ] {
            let text = format!("{above}{rows}");
            assert_eq!(found(&text), expected("time;id;iq", units, rows), "{above}");
        }
    }

    #[test]
    fn other_lines_are_left_alone() {
        for text in [
            "t,id,iq\n0,1,2\n",
            "t,id,iq\ns,A,A\n0,1,2\n",
            "t,i,i\ns,A,A\n0,1,2\n",
            "Bench,Bench,Bench\nt,id,iq\ns,A,A\n0,1,2\n",
            "Motor,a\n",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }
}

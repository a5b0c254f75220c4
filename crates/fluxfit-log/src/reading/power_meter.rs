//! Readings of a power meter: of each of its elements rms values and powers, `V1`, `I1`, `P1`, `S1`. No row is an instant.

use crate::block::ColumnHead;

/// What a power meter shows of an element, by what stands before the number of the element.
const SHOWN: [&[&str]; 4] = [
    &["u", "v", "urms", "vrms", "utrms", "vtrms", "voltage"],
    &["i", "irms", "itrms", "current"],
    &["p", "power", "watt"],
    // Apparent and reactive power, power factor: what no sampled log has.
    &["s", "q", "va", "var", "lambda", "λ", "pf", "powerfactor"],
];

/// The columns of one element of a power meter, if a table has them: voltage, current, power, and another power or its factor.
pub(super) fn element(heads: &[ColumnHead]) -> Option<Vec<String>> {
    let parts: Vec<(String, String)> = heads.iter().map(|head| parts(&head.name)).collect();
    let of = |number: &str, shown: &[&str]| parts.iter().position(|(stem, own)| own == number && shown.contains(&stem.as_str()));
    let all = |number: &str| SHOWN.map(|shown| of(number, shown)).into_iter().collect::<Option<Vec<usize>>>();
    let places = parts.iter().filter(|(_, number)| !number.is_empty()).find_map(|(_, number)| all(number))?;
    Some(places.into_iter().map(|index| heads[index].name.trim().to_owned()).collect())
}

/// The letters of a name before a unit in brackets, in lower case, and the number of the element behind them.
fn parts(name: &str) -> (String, String) {
    let name = name.split(['[', '(']).next().unwrap_or(name);
    let letters: String = name.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    let stem = letters.trim_end_matches(|c: char| c.is_ascii_digit());
    (stem.to_owned(), letters[stem.len()..].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_known_instruments() {
        let of = |header: &str| {
            let heads: Vec<ColumnHead> =
                header.split(',').map(|name| ColumnHead { name: name.to_owned(), ..ColumnHead::default() }).collect();
            element(&heads)
        };
        assert_eq!(of("V1,I1,P1,S1,Q1,LAMBDA1,PHI1,FU1").unwrap(), ["V1", "I1", "P1", "S1"]);
        assert_eq!(of("Time,Urms1 [V],Irms1 [A],P1 [W],λ1").unwrap(), ["Urms1 [V]", "Irms1 [A]", "P1 [W]", "λ1"]);
        // Sampled: phases, and a power of each instant; an element has one number.
        for header in ["t,V1,V2,V3,I1,I2,I3,Phase", "t,U1,I1,P1,theta", "V1,I1,P1,S2", "U,I,P,S"] {
            assert_eq!(of(header), None, "{header}");
        }
    }
}

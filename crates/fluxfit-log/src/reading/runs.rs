//! Several logs in one file: structures with columns of the same names, `result.id0.t`, `result.id0.iq`, `result.mtpa.t`. Which of them is
//! meant is for the user to say, for all columns at once.

use super::{
    finder::{Finder, Needed},
    proposal::propose,
    resemblance::is_reference,
};
use crate::{block::ColumnHead, problem::Problem};

/// Marks between the parts of a name.
const MARKS: [char; 3] = ['.', '/', '\\'];

/// Most parts of a name that are those of a log.
const DEEPEST: usize = 4;

impl Finder<'_> {
    /// What is said of a file that holds several logs; none of another file, or where the user says which columns are meant.
    pub(super) fn several_logs(&self) -> Option<Problem> {
        if self.options.has_headers() || self.layout.is_some() {
            return None;
        }
        (1..=DEEPEST).find_map(|depth| {
            let logs: Vec<_> =
                beginnings(self.heads, depth).into_iter().filter_map(|begin| self.columns_of(begin).map(|of| (begin, of))).collect();
            let [(_, columns), _, ..] = &logs[..] else { return None };
            let names = logs.iter().map(|(begin, _)| (*begin).to_owned()).collect();
            Some(Problem::SeveralLogs { names, first: columns.clone() })
        })
    }

    /// The columns of the log whose names begin so, if it has all that are needed, or columns that resemble them.
    fn columns_of(&self, begin: &str) -> Option<Vec<(&'static str, String)>> {
        let heads: Vec<ColumnHead> = self.heads.iter().filter(|head| is_within(&head.name, begin)).cloned().collect();
        let finder = Finder { heads: &heads, first_cells: &Vec::new, ..*self };
        let Needed { found, missing } = finder.found_and_missing().ok()?;
        let is_free = |index: usize| found.iter().all(|(_, used)| *used != index) && !is_reference(&heads[index].name);
        let proposed = propose(&missing, &heads, |_, index| is_free(index).then_some(0.0));
        let columns = found.iter().copied().chain(proposed.iter().map(|proposal| (proposal.channel, proposal.index)));
        (proposed.len() == missing.len()).then(|| columns.map(|(channel, index)| (channel.name(), heads[index].name.clone())).collect())
    }
}

/// Whether a name has this beginning and further parts.
fn is_within(name: &str, begin: &str) -> bool {
    name.strip_prefix(begin).is_some_and(|rest| rest.starts_with(MARKS))
}

/// The first parts of the names that have more, each once, in order.
fn beginnings(heads: &[ColumnHead], depth: usize) -> Vec<&str> {
    let mut beginnings: Vec<&str> = Vec::new();
    let first_parts = |head: &'_ ColumnHead| head.name.match_indices(MARKS).nth(depth - 1).map(|(at, _)| at);
    for head in heads {
        if let Some(begin) = first_parts(head).map(|at| &head.name[..at])
            && !begin.is_empty()
            && !beginnings.contains(&begin)
        {
            beginnings.push(begin);
        }
    }
    beginnings
}

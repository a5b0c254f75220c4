//! The Python package `fluxfit`: the command's face (`fluxfit_cli::face`) behind Python's calls. What is asked comes as the words of a
//! command line, which `python/fluxfit` makes from keywords; what is answered goes out as the command's JSON documents and as arrays.
//!
//! | file | concept |
//! |---|---|
//! | `arrays` | numpy's arrays in and out |
//! | `columns` | tables of Arrow and of arrays, as the reader takes them |
//! | `error` | refusals as exceptions |
//! | `fleet` | many motors |
//! | `identification` | an identification and its answer |
//! | `interruptible` | work beside Python, which Ctrl-C can leave |
//! | `search` | optimizers: a function that is minimized, and ask and tell |
//! | `track` | a running motor, followed by rows as they arrive |
//! | `verbs` | the other verbs, and the whole command |
//! | `wording` | the command's options in Python's words |

mod arrays;
mod columns;
mod error;
mod fleet;
mod identification;
mod interruptible;
mod search;
mod track;
mod verbs;
mod wording;

/// The compiled part of the package.
#[pyo3::pymodule]
mod _fluxfit {
    #[pymodule_export]
    use crate::{
        fleet::{FleetRows, fleet, fleet_columns, fleet_rows},
        identification::{Answer, identify, read_log},
        search::{AskTell, methods, minimize},
        track::Tracker,
        verbs::{command, compare, explain, inspect, simulate, validate, version},
    };
}

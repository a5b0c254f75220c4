//! Answers out: as JSON documents, and as the files that other tools take.
//!
//! | file | concept |
//! |---|---|
//! | [`answer`] | an answer as a JSON document |
//! | [`mod@export`] | an answer as the file that another tool takes |

pub mod answer;
pub mod export;

//! Answers out, as the files that other tools take.
//!
//! | file | concept |
//! |---|---|
//! | [`mod@export`] | an answer as the file that another tool takes |

pub mod export;

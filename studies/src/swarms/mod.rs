//! All search methods on three kinds of problems: fitness (11), the output error, and BBOB; and what changes their runs.

pub mod invariance;
pub mod on_bbob;
pub mod on_logs;
pub mod table;

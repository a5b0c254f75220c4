//! The library's facts in English, once, for every face: [`Display`](std::fmt::Display) of reasons, remedies, warnings, and of what
//! a validation found. How a face does a remedy (an option, an argument) is the face's own sentence.

mod column_check;
mod digits;
mod fault;
mod fleet;
mod lack;
mod left_out;
mod model;
mod nameplate;
mod names;
mod part;
mod reason;
mod remedy;
mod sample_check;
mod spikes;
mod summary;
mod temperature;
mod unseen;
mod validation;
mod validity;
mod warning;
mod warning_line;

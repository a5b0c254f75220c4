//! Times of the rows of joined logs.

use fluxfit::log::Log;

/// The offset of each log's time, s, with which the times of joined logs are consecutive.
pub(crate) fn offsets(log: &Log) -> Vec<f64> {
    let logs = log.segments().last().map_or(1, |segment| segment.log + 1);
    let t = &log.columns().t;
    let mut offsets = Vec::new();
    let mut end = None;
    for number in 0..logs {
        let rows = || log.segments().iter().filter(|segment| segment.log == number).map(|segment| &segment.rows);
        let (Some(first), Some(last)) = (rows().next(), rows().next_back()) else {
            offsets.push(0.0);
            continue;
        };
        // The first log keeps its time.
        let offset = end.map_or(0.0, |end| t[first.start] - end);
        offsets.push(offset);
        end = Some(t[last.end - 1] - offset);
    }
    offsets
}

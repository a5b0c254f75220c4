//! The courses of the parameters on a terminal while a motor is followed: values and 95 % intervals, redrawn in place.

use super::value::{margin, shown};
use crate::terminal::{self, plot};
use anstyle::AnsiColor;
use fluxfit::{Parameter, motor::PARAMETERS};
use fluxfit_track::{Tracked, Tracker};
use fluxfit_units::{Scale, significant};
use ratatui_core::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Style},
    symbols::Marker,
    widgets::Widget,
};
use ratatui_widgets::chart::{Axis, Chart, Dataset, GraphType};
use std::time::{Duration, Instant};

/// Least time between two drawings: a terminal far away keeps up, and drawing takes a hundredth of it.
const PAUSE: Duration = Duration::from_millis(125);

/// Times that are kept, two for each column of dots. When there are more, every second one is left out.
const KEPT: usize = 300;

/// Lines of a course, of the gap below it, and of the axis of time below the last one.
const COURSE: u16 = 3;
const GAP: u16 = 1;
const TIME: u16 = 2;

/// All lines. A terminal with fewer than these and one for the cursor has a line of values instead.
const LINES: u16 = PARAMETERS as u16 * (COURSE + GAP) - GAP + TIME;

/// Columns of the text before a course, and least and most columns of all.
const TEXT: u16 = 22;
const NARROWEST: u16 = 60;
const WIDEST: u16 = 100;

/// Digits of a number at an axis are padded to so many letters: the courses stand below each other.
const LABEL: usize = 8;

/// A value whose interval is so many times the usual one is still settling: it does not stretch the axis.
const SETTLING: f64 = 3.0;

/// Colours of values and of the ends of their intervals, for the chart and for the terminal.
const VALUE: (Color, AnsiColor) = (Color::Cyan, AnsiColor::Cyan);
const INTERVAL: (Color, AnsiColor) = (Color::DarkGray, AnsiColor::BrightBlack);

/// What was told at a time, s.
type Told = (f64, [Tracked; PARAMETERS]);

/// The courses so far.
#[derive(Debug)]
pub(super) struct Courses {
    told: Vec<Told>,
    /// Of so many times one is kept.
    stride: usize,
    /// Times since the last one that was kept.
    passed: usize,
    drawn: Option<Instant>,
}

impl Courses {
    pub(super) fn new() -> Self {
        Self { told: Vec::new(), stride: 1, passed: 0, drawn: None }
    }

    /// Takes what is known now, and draws if it is time for that, or the `last` time.
    pub(super) fn show(&mut self, tracker: &Tracker, last: bool) {
        let now = (tracker.time(), tracker.parameters_or_nothing());
        self.keep(now);
        if last || self.drawn.is_none_or(|drawn| drawn.elapsed() >= PAUSE) {
            self.drawn = Some(Instant::now());
            let [columns, lines] = terminal::screen();
            let has_room = columns >= NARROWEST && lines > LINES;
            terminal::live(&if has_room { self.drawing(now, columns.min(WIDEST)) } else { line(now) });
        }
    }

    fn keep(&mut self, now: Told) {
        // Time that jumps back begins anew.
        if self.told.last().is_some_and(|(t, _)| *t > now.0) {
            *self = Self { drawn: self.drawn, ..Self::new() };
        }
        if self.passed.is_multiple_of(self.stride) {
            self.passed = 0;
            self.told.push(now);
        }
        self.passed += 1;
        if self.told.len() > KEPT {
            self.told = self.told.iter().copied().step_by(2).collect();
            self.stride *= 2;
        }
    }

    fn drawing(&self, now: Told, columns: u16) -> String {
        // The last column stays free: a terminal may break the line after it.
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns - 1, LINES));
        let last = PARAMETERS - 1;
        for (place, parameter) in Parameter::ALL.into_iter().enumerate() {
            let top = place as u16 * (COURSE + GAP);
            let tracked = &now.1[place];
            let (value, unit) = shown(parameter, tracked);
            let verdict = tracked.verdict.to_string();
            let verdict = verdict.split_once(':').map_or(verdict.as_str(), |(short, _)| short);
            let name = parameter.symbol();
            for (row, text) in [format!("{name:<6} {value} {unit}"), format!("{:<6} {}", "", margin(tracked)), format!("  {verdict}")]
                .into_iter()
                .enumerate()
            {
                buffer.set_string(0, top + row as u16, text, Style::default());
            }
            let below = if place == last { TIME } else { 0 };
            self.course(parameter, now, below, Rect::new(TEXT, top, columns - 1 - TEXT, COURSE + below), &mut buffer);
        }
        plot::text(&buffer, &[VALUE, INTERVAL].map(|(color, pen)| (color, pen.into())))
    }

    /// Value over time, and both ends of the interval.
    fn course(&self, parameter: Parameter, now: Told, below: u16, area: Rect, buffer: &mut Buffer) {
        let told: Vec<(f64, Tracked)> = self.told.iter().chain([&now]).map(|(t, all)| (*t, all[parameter as usize])).collect();
        let ends = |side: usize| pieces(&told, move |tracked| tracked.interval().map(|ends| ends[side]));
        let curves = [(INTERVAL, ends(0)), (INTERVAL, ends(1)), (VALUE, pieces(&told, |tracked| tracked.value))];
        let datasets = curves.iter().flat_map(|((color, _), pieces)| {
            pieces.iter().map(|piece| Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line).style(*color).data(piece))
        });
        let (bounds, labels) = match range(&told) {
            Some([low, high]) => {
                let scale = Scale::for_value(parameter, high);
                ([low, high], [low, high].map(|end| scale.format(end, 0.1 * (high - low))))
            }
            None => ([0.0, 1.0], [const { String::new() }; 2]),
        };
        let (start, end) = (told[0].0, now.0);
        let time = Axis::default().bounds([start, if end > start { end } else { start + 1.0 }]);
        let time = if below > 0 { time.labels(plot::ticks(start, end, 2).map(|t| format!("{} s", significant(t, 4)))) } else { time };
        Chart::new(datasets.collect())
            .x_axis(time)
            .y_axis(Axis::default().bounds(bounds).labels(labels.map(|label| format!("{label:>LABEL$}"))))
            .render(area, buffer);
    }
}

/// The stretches of a course without gaps.
fn pieces(told: &[(f64, Tracked)], of: impl Fn(&Tracked) -> Option<f64>) -> Vec<Vec<(f64, f64)>> {
    let points: Vec<Option<(f64, f64)>> = told.iter().map(|(t, tracked)| of(tracked).map(|y| (*t, y))).collect();
    points.split(Option::is_none).map(|piece| piece.iter().copied().flatten().collect()).collect()
}

/// Least and largest value that has settled, with the present interval.
fn range(told: &[(f64, Tracked)]) -> Option<[f64; 2]> {
    let mut widths: Vec<f64> = told.iter().filter_map(|(_, tracked)| tracked.half_width()).collect();
    widths.sort_by(f64::total_cmp);
    let widest = widths.get(widths.len() / 2).map_or(f64::INFINITY, |usual| SETTLING * usual);
    let settled = told.iter().filter(|(_, tracked)| tracked.half_width().is_none_or(|width| width <= widest));
    let last = told.iter().rev().find_map(|(_, tracked)| tracked.interval());
    let all = settled.filter_map(|(_, tracked)| tracked.value).chain(last.into_iter().flatten());
    let [low, high] = all.fold(None, |ends: Option<[f64; 2]>, y| Some(ends.map_or([y; 2], |[low, high]| [low.min(y), high.max(y)])))?;
    // A tenth more, and no less than a part of the value that the numbers at the axis tell apart.
    let more = 0.05 * (high - low).max(1e-3 * high.abs());
    Some([low - more, high + more])
}

/// Present values in a line.
fn line((t, parameters): Told) -> String {
    let values = Parameter::ALL.into_iter().zip(parameters).map(|(parameter, tracked)| {
        let (value, unit) = shown(parameter, &tracked);
        format!("{} {value} {unit}", parameter.symbol())
    });
    format!("{t:.1} s  {}\n", values.collect::<Vec<_>>().join("  "))
}

//! The log: voltages, currents and speed over time, with the windows of the operating points and the rows that were left out.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, anchored, line, shade},
        decimation::{decimated, decimated_with_index},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    interactive::{DeltaColumn, Panel, PanelKind, PlotData, Series, Span, XAxis},
    report::Report,
    row_times::offsets,
    typography::{grouped, prose},
};
use fluxfit::{evidence::LeftOut, log::Log, steady::OperatingPoint};
use maud::{Markup, html};
use plotters::{
    element::{PathElement, Rectangle},
    style::text_anchor::{HPos, VPos},
};
use std::collections::BTreeSet;

/// Largest number of rows that are all in the data of a page; a row takes about 15 bytes.
const MAX_ROWS: usize = 100_000;

/// Number of time spans of a longer log; of each the first, last, smallest and largest rows of every curve are in the data.
const KEPT_SPANS: u32 = 500;

/// Resolution of time in the data, as a fraction of the sample period.
const TIME_RESOLUTION: f64 = 0.1;

/// Height of a panel, pixels.
const HEIGHT: i32 = 170;

/// Overlap of two panels, pixels: only the lowest has numbers at its x axis.
const OVERLAP: i32 = 30;

/// Opacity of the shades of windows and of rows left out.
const SHADES: [f64; 2] = [0.14, 0.28];

/// The curves of a panel: its name, and for each curve its name, ink and column.
type Curves<'a> = (&'static str, Vec<(&'static str, Ink, &'a [f64])>);

/// What is drawn.
struct Recording<'a> {
    log: &'a Log,
    points: &'a [OperatingPoint],
    left_out: &'a [LeftOut],
    /// Offset of each joined log's time, s.
    offsets: Vec<f64>,
}

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let left_out = report.identification.map_or(&[][..], |(found, _)| &found.left_out);
    let of = || Recording { log: report.log, points: report.operating_points, left_out, offsets: offsets(report.log) };
    let (for_drawing, for_data) = (of(), of());
    Some(Figure {
        name: "log",
        section: "recording",
        caption: caption(&for_data),
        draw: Box::new(move |size| for_drawing.draw(size)),
        data: Some(Box::new(move || for_data.data())),
    })
}

fn caption(recording: &Recording) -> Markup {
    let Recording { log, points, left_out, .. } = recording;
    let reasons: BTreeSet<String> = left_out.iter().map(|left| left.reason.to_string()).collect();
    let rows_of =
        |reason: &str| left_out.iter().filter(|left| left.reason.to_string() == reason).map(|left| left.rows.len()).sum::<usize>();
    html! {
        "The log. "
        @if !points.is_empty() { "Green: the windows of the operating points. " }
        @if !reasons.is_empty() || !log.spikes().is_empty() {
            "Grey: rows that were left out ("
            @for (k, reason) in reasons.iter().enumerate() {
                @if k > 0 { "; " } (grouped(rows_of(reason) as u64)) " rows: " (prose(reason))
            }
            @if !log.spikes().is_empty() { @if !reasons.is_empty() { "; " } (log.spikes()) }
            "). "
        }
        @if log.rows() > MAX_ROWS {
            "Of this long log, the page contains only the first, last, smallest and largest rows of each of " (KEPT_SPANS) " equal time spans. "
        }
        @if log.segments().len() > 1 { "Gaps are not bridged." }
    }
}

impl Recording<'_> {
    fn panels(&self) -> [Curves<'_>; 3] {
        let columns = self.log.columns();
        [
            ("voltages, V", vec![("u_d", Ink::D, &columns.ud), ("u_q", Ink::Q, &columns.uq)]),
            ("currents, A", vec![("i_d", Ink::D, &columns.id), ("i_q", Ink::Q, &columns.iq)]),
            ("speed omega_e, rad/s", vec![("omega_e", Ink::Text, &columns.omega_e)]),
        ]
    }

    /// Time of a row, s; the times of joined logs are consecutive.
    fn time(&self, row: usize) -> f64 {
        let log = self.log.segment_of(row).map_or(0, |segment| segment.log);
        self.log.columns().t[row] - self.offsets.get(log).copied().unwrap_or(0.0)
    }

    /// First and last time, s.
    fn times(&self) -> [f64; 2] {
        [self.time(0), self.time(self.log.rows().saturating_sub(1))]
    }

    /// The points of a curve in each segment.
    fn pieces<'b>(&'b self, column: &'b [f64]) -> impl Iterator<Item = impl Iterator<Item = (f64, f64)> + 'b> + 'b {
        let t = &self.log.columns().t;
        self.log.segments().iter().map(move |segment| {
            let offset = self.offsets.get(segment.log).copied().unwrap_or(0.0);
            segment.rows.clone().map(move |row| (t[row] - offset, column[row]))
        })
    }

    /// Spans of time with a shade of their own: whether it is a window, its ends, s, and what it is.
    fn spans(&self) -> Vec<(bool, [f64; 2], String)> {
        let ends = |rows: &std::ops::Range<usize>| [self.time(rows.start), self.time(rows.end.saturating_sub(1))];
        let windows = (1..).zip(self.points).map(|(k, point)| (true, ends(&point.rows), format!("operating point {k}")));
        let left_out = self.left_out.iter().map(|left| (false, ends(&left.rows), format!("left out: {}", left.reason)));
        let spikes = self.log.spikes().all().iter().map(|spike| {
            let t = spike.time - self.offsets.get(spike.log).copied().unwrap_or(0.0);
            (false, [t, t], format!("left out: {} = {:e}, which no drive had", spike.column, spike.value))
        });
        windows.chain(left_out).chain(spikes).collect()
    }

    fn draw(&self, size: Size) -> Drawing {
        let label = format!(
            "Curves over time: voltages, currents and speed of {} rows, with {} operating points and {} stretches left out",
            self.log.rows(),
            self.points.len(),
            self.left_out.len()
        );
        let panels = self.panels();
        let height = panels.len() as i32 * (HEIGHT - OVERLAP) + OVERLAP;
        Drawing::new((size.width(), height.unsigned_abs()), label, |area| {
            panels.iter().enumerate().try_for_each(|(k, panel)| {
                let top = k as i32 * (HEIGHT - OVERLAP);
                let strip = area.clone().shrink((0, top * UNITS), (size.width() as i32 * UNITS, HEIGHT * UNITS));
                self.paint(&strip, panel, k + 1 == panels.len(), size)
            })
        })
    }

    fn paint(&self, area: &Area, (name, curves): &Curves, is_last: bool, size: Size) -> Drawn {
        let [from, to] = self.times();
        let x = if from < to { Axis::between(from, to, size.pick(8, 5)) } else { Axis::around([from, to], 4) };
        let y = Axis::around(curves.iter().flat_map(|(.., column)| column.iter().copied()), 4);
        let (low, high) = (y.low, y.high);
        let (x_label, y_label) = (x.clone(), y.clone());
        let plot = Plot {
            x,
            y,
            x_name: if is_last { "time, s" } else { "" },
            y_name: name,
            left: 60,
            right: 12,
            x_label: &|t| if is_last { x_label.label(t) } else { String::new() },
            y_label: &|value| y_label.label(value),
        };
        let mut chart = plot.on(area)?;
        for (is_window, [start, end], _) in self.spans() {
            let style = if is_window { shade(Ink::Identified, SHADES[0]) } else { shade(Ink::Axis, SHADES[1]) };
            // A single row is still visible.
            let end = end.max(start + 0.002 * (to - from));
            chart.series.draw_series([Rectangle::new([(start, low), (end, high)], style)])?;
        }
        for (.., ink, column) in curves {
            let pieces = self.pieces(column).map(|points| decimated(points, [from, to], size.width() - 72));
            chart.series.draw_series(pieces.filter(|piece| piece.len() > 1).map(|piece| PathElement::new(piece, line(*ink, 1.2))))?;
        }
        let right = size.width() as i32 * UNITS;
        for (k, (name, ink, _)) in curves.iter().rev().enumerate().filter(|_| curves.len() > 1) {
            let (x, y) = (right - (66 + 62 * k as i32) * UNITS, 13 * UNITS);
            area.draw(&PathElement::new(vec![(x, y), (x + 20 * UNITS, y)], line(*ink, 2.0)))?;
            area.draw_text(name, &anchored(Ink::Text, HPos::Left, VPos::Center), (x + 25 * UNITS, y))?;
        }
        Ok(())
    }

    /// The rows in the data of the page; `None` is a gap.
    fn kept(&self) -> Vec<Option<usize>> {
        let columns = self.log.columns();
        let mut kept = Vec::new();
        for segment in self.log.segments() {
            if !kept.is_empty() {
                kept.push(None);
            }
            if self.log.rows() <= MAX_ROWS {
                kept.extend(segment.rows.clone().map(Some));
                continue;
            }
            let offset = self.offsets.get(segment.log).copied().unwrap_or(0.0);
            let of_column = |column: &Vec<f64>| {
                let points = segment.rows.clone().map(|row| (columns.t[row] - offset, column[row]));
                decimated_with_index(points, self.times(), KEPT_SPANS).into_iter().map(|(index, _)| segment.rows.start + index)
            };
            let rows: BTreeSet<usize> =
                [&columns.ud, &columns.uq, &columns.id, &columns.iq, &columns.omega_e].into_iter().flat_map(of_column).collect();
            kept.extend(rows.into_iter().map(Some));
        }
        kept
    }

    /// The data of the interactive plot.
    fn data(&self) -> PlotData {
        let kept = self.kept();
        let mut t: Vec<f64> = kept.iter().map(|row| row.map_or(f64::NAN, |row| self.time(row))).collect();
        // A gap lies halfway between its ends.
        for k in (1..t.len().saturating_sub(1)).filter(|k| kept[*k].is_none()) {
            t[k] = 0.5 * (t[k - 1] + t[k + 1]);
        }
        let period = self.log.segments().iter().map(|segment| segment.sample_period).fold(f64::INFINITY, f64::min);
        let panels = self.panels().into_iter().map(|(name, curves)| Panel {
            name: name.to_owned(),
            height: HEIGHT,
            kind: PanelKind::Lines,
            ranges: None,
            series: curves
                .into_iter()
                .map(|(name, ink, column)| {
                    let values: Vec<f64> = kept.iter().map(|row| row.map_or(f64::NAN, |row| column[row])).collect();
                    Series::new(name, ink, (1.2, 1.0), DeltaColumn::new(&values))
                })
                .collect(),
        });
        let spans = self.spans().into_iter().map(|(is_window, ends, text)| Span { is_window, ends, text }).collect();
        let x = XAxis { name: "time", unit: "s", values: DeltaColumn::resolving(&t, period * TIME_RESOLUTION) };
        PlotData { x, panels: panels.collect(), descriptions: Vec::new(), spans }
    }
}

//! Autocorrelation of the residuals of i_d and i_q, with the 95 % band of white noise.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, line, shade},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    report::Report,
    residual_correlation::ResidualCorrelation,
    typography::{grouped, number},
};
use fluxfit_units::significant;
use maud::html;
use plotters::element::{PathElement, Rectangle};

/// Height of a panel, pixels.
const PANEL: u32 = 210;

/// The figure.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let fit = found.output.as_ref()?;
    let correlation = ResidualCorrelation::of(fit);
    let caption = html! {
        "Autocorrelation of the residuals at " (correlation.lags()) " lags. Of the correlations of white noise, 95\u{a0}% lie within the grey band, "
        "±2/√n = ±" (number(correlation.band, |band| significant(band, 2))) " for " (grouped((fit.residuals.len() / 2) as u64)) " rows. "
        "The two panels have different scales."
    };
    let draw = Box::new(move |size| draw(&correlation, size));
    Some(Figure { name: "autocorrelation", section: "residuals", draw, data: None, caption })
}

/// Draws a panel for each axis.
fn draw(correlation: &ResidualCorrelation, size: Size) -> Drawing {
    let ResidualCorrelation { axes, band } = correlation;
    let label = format!(
        "Stems: autocorrelation of the residuals of i_d and i_q at {} lags, with a band of plus and minus {band:.3}",
        correlation.lags()
    );
    let (rows, columns) = size.pick((1, 2), (2, 1));
    Drawing::new((size.width(), PANEL * rows), label, |area| {
        let panels = area.split_evenly((rows as usize, columns));
        [0, 1].into_iter().zip(&panels).try_for_each(|(axis, panel)| paint(panel, &axes[axis], axis, *band))
    })
}

fn paint(area: &Area, correlations: &[f64], axis: usize, band: f64) -> Drawn {
    let end = correlations.len() as f64 + 1.0;
    let y = Axis::around(correlations.iter().copied().chain([0.0, -1.5 * band, 1.5 * band]), 4);
    let y_label = y.clone();
    let plot = Plot {
        x: Axis::between(0.0, end, 5),
        y,
        x_name: "lag, rows",
        y_name: ["correlation of the residual of i_d", "correlation of the residual of i_q"][axis],
        left: 50,
        right: 12,
        x_label: &|lag| format!("{lag:.0}"),
        y_label: &|value| y_label.label(value),
    };
    let mut chart = plot.on(area)?;
    chart.series.draw_series([Rectangle::new([(0.0, -band), (end, band)], shade(Ink::Axis, 0.22))])?;
    chart.series.draw_series([PathElement::new(vec![(0.0, 0.0), (end, 0.0)], line(Ink::Axis, 1.0))])?;
    let ink = [Ink::D, Ink::Q][axis];
    let stems = (1..).zip(correlations).filter(|(_, value)| value.is_finite());
    chart.series.draw_series(stems.map(|(lag, value): (i32, &f64)| {
        let lag = f64::from(lag);
        PathElement::new(vec![(lag, 0.0), (lag, *value)], line(ink, 2.5))
    }))?;
    Ok(())
}

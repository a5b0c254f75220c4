//! Flux linkages over current, of a motor that saturates.

use crate::{
    drawing::{
        axis::Axis,
        canvas::{Area, Drawing, Drawn, UNITS, line, solid},
        palette::Ink,
        plot::Plot,
        size::Size,
    },
    figure::Figure,
    report::Report,
    typography::prose,
};
use fluxfit::evidence::{Flux, SaturationFinding};
use plotters::element::{Circle, PathElement};

/// Height of a panel, pixels.
const PANEL: u32 = 250;

/// Half the length of an error bar, in standard uncertainties.
const BAR: f64 = 2.0;

/// Half the width of an error bar's ends, pixels.
const END: i32 = 4;

/// Webers in milliwebers.
const MILLI: f64 = 1e3;

/// The figure; `None` if no operating point has a flux.
pub(crate) fn figure<'a>(report: &Report<'a>) -> Option<Figure<'a>> {
    let (found, _) = report.identification?;
    let saturation = found.saturation.as_ref()?;
    saturation.fluxes.iter().flatten().next()?;
    Some(Figure {
        name: "flux",
        section: "answer",
        draw: Box::new(move |size| draw(saturation, size)),
        data: None,
        caption: prose(
            "Flux linkage at each operating point over the current of its axis; bars are two standard uncertainties (95 %). Without saturation the \
             points of psi_q would lie on a line through zero. Grey: a line from zero to each point, its slope is the apparent L_q there.",
        ),
    })
}

fn draw(found: &SaturationFinding, size: Size) -> Drawing {
    let label = format!(
        "Points with error bars: psi_q over i_q and psi_d over i_d in milliweber and ampere, at {} operating points",
        found.fluxes.iter().flatten().count()
    );
    let (rows, columns) = size.pick((1, 2), (2, 1));
    Drawing::new((size.width(), PANEL * rows), label, |area| {
        let panels = area.split_evenly((rows as usize, columns));
        [1, 0].into_iter().zip(&panels).try_for_each(|(axis, panel)| paint(panel, found, axis))
    })
}

fn paint(area: &Area, found: &SaturationFinding, axis: usize) -> Drawn {
    let of = |flux: &Flux| {
        let along = |dq: fluxfit::frames::Dq| [dq.d, dq.q][axis];
        (along(flux.current), MILLI * along(flux.psi), MILLI * BAR * along(flux.uncertainty))
    };
    let points: Vec<(f64, f64, f64)> = found.fluxes.iter().flatten().map(of).collect();
    let x = Axis::around(points.iter().map(|(current, ..)| *current).chain([0.0]), 5);
    // The flux of the magnets lies far from zero; that of i_q begins there.
    let zero = (axis == 1).then_some(0.0);
    let y = Axis::around(points.iter().flat_map(|(_, psi, bar)| [psi - bar, psi + bar]).chain(zero), 5);
    let (x_label, y_label) = (x.clone(), y.clone());
    let plot = Plot {
        x,
        y,
        x_name: ["i_d, A", "i_q, A"][axis],
        y_name: ["psi_d, mWb", "psi_q, mWb"][axis],
        left: 56,
        right: 14,
        x_label: &|value| x_label.label(value),
        y_label: &|value| y_label.label(value),
    };
    let mut chart = plot.on(area)?;
    let ink = [Ink::D, Ink::Q][axis];
    for (current, psi, bar) in points {
        if axis == 1 {
            chart.series.draw_series([PathElement::new(vec![(0.0, 0.0), (current, psi)], line(Ink::Axis, 0.7))])?;
        }
        chart.series.draw_series([PathElement::new(vec![(current, psi - bar), (current, psi + bar)], line(ink, 1.5))])?;
        for end in [psi - bar, psi + bar] {
            let (px, py) = chart.place(current, end);
            area.draw(&PathElement::new(vec![(px - END * UNITS, py), (px + END * UNITS, py)], line(ink, 1.5)))?;
        }
        area.draw(&Circle::new(chart.place(current, psi), 4 * UNITS, solid(ink)))?;
    }
    Ok(())
}

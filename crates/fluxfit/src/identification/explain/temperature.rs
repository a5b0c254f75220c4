//! The winding's temperature, where a log has it: what the resistance and the flux would be at 20 degrees.
//!
//! ```text
//! R_20 = R (235 + 20) / (235 + T)          psi_20 = psi / (1 + alpha (T - 20))
//! ```
//!
//! with the temperature `T`, degC, and the coefficient `alpha` of the magnets. These are taken to be as warm as the winding. The error of
//! the temperature itself is not counted.

use super::{
    super::{
        fit::{output::OutputFit, steady::SteadyFit},
        request::{Known, Request},
    },
    judgement::Judgement,
};
use crate::{
    faults::Fault,
    log::Log,
    motor::{PARAMETERS, Parameter},
};

/// Temperature to which values are referred, degC: that of data sheets.
pub const REFERENCE_TEMPERATURE: f64 = 20.0;

/// Copper's resistance is proportional to the temperature above -235 degC: IEC 60034-1, 8.6.2.3.3.
const COPPER_ORIGIN: f64 = 235.0;

/// What copper's resistance gains per kelvin, as a part of that at 20 degrees: 0.39 %.
pub(super) const COPPER: f64 = 1.0 / (COPPER_ORIGIN + REFERENCE_TEMPERATURE);

/// The winding's temperature in the rows that were used, and the parameters referred to 20 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AtTemperature {
    /// Mean over the rows used, weighted by the squared current as these tell R_s; degC.
    pub mean: f64,
    /// Lowest, degC.
    pub lowest: f64,
    /// Highest, degC.
    pub highest: f64,
    /// By which part of itself a copper winding's resistance grows from the lowest to the highest.
    pub copper_gain: f64,
    /// R_s at 20 degrees; `None` where it is not identified, or given.
    pub rs: Option<Referred>,
    /// psi_f at 20 degrees; `None` where it is not identified, or given, or the magnets' coefficient is not
    /// [stated](Request::magnet_coefficient).
    pub psi_f: Option<Referred>,
}

/// A value at 20 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Referred {
    /// Value, SI.
    pub value: f64,
    /// Its 95 % interval, SI: as wide a part of the value as that of the parameter, and in quadrature what half the range of the
    /// temperatures makes of it, because one value for all of them may be that of any. Where a drift of R_s was found, R_s has none.
    pub interval: [f64; 2],
}

impl AtTemperature {
    /// Of the rows that the answering fit used; `None` where the log has no temperature.
    pub(crate) fn of(
        log: &Log,
        parameters: &[Judgement; PARAMETERS],
        steady: Option<&SteadyFit>,
        output: Option<&OutputFit>,
        request: &Request,
    ) -> Option<Self> {
        let columns = log.columns();
        let temperature = columns.temperature.as_ref()?;
        let points = steady.map_or(&[][..], |fit| &fit.operating_points);
        let used: Vec<usize> = match output {
            Some(fit) => fit.stretches.iter().cloned().flatten().collect(),
            None => points.iter().flat_map(|point| point.rows.clone()).collect(),
        };
        // A drift is fitted as R_s in the middle of the time, and a change on top of it.
        let drifts = output.is_some_and(|fit| fit.has(Fault::ResistanceDrift));
        let weight = |row: usize| if drifts { 1.0 } else { columns.id[row].powi(2) + columns.iq[row].powi(2) };
        let total: f64 = used.iter().map(|row| weight(*row)).sum();
        let mean = used.iter().map(|row| weight(*row) * temperature[*row]).sum::<f64>() / total;
        let within = |start: f64, better: fn(f64, f64) -> f64| used.iter().map(|row| temperature[*row]).fold(start, better);
        let (lowest, highest) = (within(f64::INFINITY, f64::min), within(f64::NEG_INFINITY, f64::max));
        if !mean.is_finite() {
            return None;
        }
        let (above, range) = (mean - REFERENCE_TEMPERATURE, highest - lowest);
        let referred = |parameter: Parameter, per_kelvin: f64, is_followed: bool| {
            let by = 1.0 + per_kelvin * above;
            let judgement = &parameters[parameter as usize];
            let is_given = matches!(request.known[parameter as usize], Known::Fixed(_));
            let value = judgement.value().filter(|_| !is_given && by > 0.0)? / by;
            let doubt = if is_followed { 0.0 } else { 0.5 * range * per_kelvin / by * value };
            let half_width = (judgement.uncertainty.half_width / by).hypot(doubt);
            Some(Referred { value, interval: [value - half_width, value + half_width] })
        };
        Some(Self {
            mean,
            lowest,
            highest,
            copper_gain: (highest - lowest) / (COPPER_ORIGIN + lowest),
            rs: referred(Parameter::Rs, COPPER, drifts),
            psi_f: request.magnet_coefficient.and_then(|coefficient| referred(Parameter::PsiF, coefficient, false)),
        })
    }
}

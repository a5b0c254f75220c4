//! Excitation of the simulated currents: which combinations of the parameters they tell, given what they leave unexplained.
//!
//! Parameters are counted in fractions of what the voltage allows, as for [operating points](super::excitation). The singular vectors of
//! the currents' derivatives are directions in parameter space, each with the change of the currents that it makes over its whole range. A
//! direction is excited only if this change stands above the residuals, as far as these do not average out: white residuals do, correlated
//! ones count by their independent number. And it stands above what the model itself is worth: a simulation without any noise has an
//! inverter's ripple in its rows, to which anything can be fitted. What the faults could explain as well does not count.
//!
//! Where the voltage between the rows is not in the log, as of means, it is as wrong as the residuals show, and what the currents answer to
//! it comes out too small however many rows there are, as of any regressor with errors (W. A. Fuller, Measurement Error Models, 1987,
//! section 1.1): there residuals do not average out. An axis whose current was held at zero has only the controller's answers to noise and
//! to steps of the other axis; where rows come slower than the drive controls, or are means, those are between the rows, and its
//! inductance is open. So it is where a filter was found: rows that are means pass for filtered ones.

use super::{fault_search::LEAST_RESIDUAL, long_run, output::OutputFit, output_start};
use crate::{
    error::Error,
    frames::Dq,
    identification::request::{Known, Request},
    levenberg_marquardt::{MOTOR, jacobian},
    log::Log,
    motor::{PARAMETERS, Parameter},
    objective::{acting_voltage::VoltageTiming, adjustable::Unknown, output_error::OutputError},
    singular_values::SingularValueDecomposition,
};
use nalgebra::DMatrix;

/// An excited direction moves the currents by at least this many times what is not explained, as at operating points.
const MIN_SIGNAL_TO_NOISE: f64 = 5.0;

/// An excited direction moves the currents by at least this part of what is left of them, row for row. Controllers answer the noise of
/// sensors, so where nothing else moves a drive, what is left is not independent of the voltages, and does not average out of what the
/// currents answer to these (L. Ljung, System Identification, 2nd ed. 1999, section 13.4). Steps that tell a parameter to a third of
/// its value move the currents by half of the noise; those of a real drive at one held point, whose R_s came out 12 times too large
/// with 3 %, by a sixth.
const LEAST_IN_A_ROW: f64 = 0.3;

/// A parameter is open if this part of its axis, or more, lies in directions that are not excited, as at operating points.
const OPEN_PART: f64 = 0.1;

/// Whether the simulated currents leave a parameter open: in the order of the parameters. An inductance that the operating points leave
/// open, `of_points`, may have come out anywhere, and the smaller it is the more the currents depend on it: it counts as equal to the
/// other.
///
/// # Errors
/// If the rows are too few to be simulated.
pub(crate) fn open(log: &Log, fit: &OutputFit, of_points: &[bool; PARAMETERS], request: &Request) -> Result<[bool; PARAMETERS], Error> {
    let objective = OutputError::of_rows(log, &fit.stretches, fit.voltage_timing.value)?;
    let scale = reach(log, fit, request);
    let free: Vec<usize> =
        output_start::free(log, request).into_iter().filter_map(|unknown| MOTOR.iter().position(|own| *own == unknown)).collect();
    let faults: Vec<Unknown> = fit.fault_estimates.iter().map(|estimate| estimate.unknown).collect();
    let unknowns: Vec<Unknown> = faults.iter().copied().chain(free.iter().map(|p| MOTOR[*p])).collect();
    let mut drive = fit.drive;
    let logged = log.columns();
    let averaged = matches!(fit.voltage_timing.value, VoltageTiming::Averaged { .. });
    let hidden = averaged || !log.is_control_rate() || fit.is_filtered();
    // Where a row's voltage acts at once, the rows may as well be means of a faster drive, whose noise tells no inductance.
    let may_be_means = fit.voltage_timing.value.acts_at_once();
    let Dq { d: gain_d, q: gain_q } = drive.faults.disturbance.gain;
    let Dq { d: missed_d, q: missed_q } = fit.residual_rms();
    let hidden_and_held = |current: &[f64], gain: f64, missed: f64| {
        let size = root_mean_square(current);
        // An observer that corrects away from what was measured: neighbouring rows share what they average, as such means do.
        let is_hidden = hidden || gain < 0.0 || (may_be_means && missed > NOISE_PART * size);
        is_hidden && size < HELD * objective.peak_current()
    };
    let mut held = None;
    match [of_points[Parameter::Ld as usize], of_points[Parameter::Lq as usize]] {
        [true, false] => {
            drive.motor.ld = drive.motor.lq;
            held = Some(Parameter::Ld).filter(|_| hidden_and_held(&logged.id, gain_d, missed_d));
        }
        [false, true] => {
            drive.motor.lq = drive.motor.ld;
            held = Some(Parameter::Lq).filter(|_| hidden_and_held(&logged.iq, gain_q, missed_q));
        }
        _ => {}
    }
    let mut columns = without_first(jacobian(&objective, &drive, &unknowns), faults.len());
    columns.iter_mut().zip(&free).for_each(|(column, p)| column.iter_mut().for_each(|slope| *slope *= scale[*p]));

    let count = fit.residuals.len() as f64;
    let independent = if averaged { 1.0 } else { long_run::effective_sample_size(&fit.residuals).clamp(1.0, count) };
    let unexplained = (fit.cost / independent).sqrt().max(LEAST_RESIDUAL * objective.peak_current() * count.sqrt());
    let least = (MIN_SIGNAL_TO_NOISE * unexplained).max(LEAST_IN_A_ROW * fit.cost.sqrt());
    // A prior pins its parameter.
    for (k, p) in free.iter().enumerate() {
        let pinned = matches!(request.known[*p], Known::Prior { .. });
        columns.iter_mut().enumerate().for_each(|(l, column)| column.push(if pinned && k == l { PINNED * least } else { 0.0 }));
    }
    let matrix = DMatrix::from_fn(columns.first().map_or(0, Vec::len), free.len(), |row, column| columns[column][row]);
    let SingularValueDecomposition { values, right, .. } = SingularValueDecomposition::of(matrix);
    let mut part = [0.0; PARAMETERS];
    for (value, direction) in values.iter().zip(right.column_iter()) {
        if *value < least {
            free.iter().zip(&direction).for_each(|(p, component)| part[*p] += component * component);
        }
    }
    // That a rotor stands, and tells no flux, is known without a fit: it leaves no combination open.
    let is_absent = |parameter: Parameter| parameter != Parameter::PsiF && output_start::is_absent(log, parameter);
    let is_open = |parameter: Parameter| held == Some(parameter) || is_absent(parameter) || part[parameter as usize].sqrt() > OPEN_PART;
    Ok(Parameter::ALL.map(is_open))
}

/// How far a parameter reaches that is open: what the voltage allows, SI.
pub(crate) fn reach(log: &Log, fit: &OutputFit, request: &Request) -> [f64; PARAMETERS] {
    output_start::scale(log, &fit.stretches, request)
}

/// A current is held at zero if its root mean square is below this part of the largest current: noise and short transients.
const HELD: f64 = 0.05;

/// A current is noise if the simulated one misses more than this part of it, root mean square: what noise leaves of noise. Where every row
/// is explained, as in a simulator's log without noise, it is far less.
const NOISE_PART: f64 = 0.3;

fn root_mean_square(current: &[f64]) -> f64 {
    (current.iter().map(|i| i * i).sum::<f64>() / current.len() as f64).sqrt()
}

/// A prior counts as so many times the least signal.
const PINNED: f64 = 10.0;

/// The other columns without their part along the first ones.
fn without_first(columns: Vec<Vec<f64>>, first: usize) -> Vec<Vec<f64>> {
    let dot = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut rest = Vec::new();
    for (k, mut column) in columns.into_iter().enumerate() {
        let before = dot(&column, &column).sqrt();
        // Twice: the first time leaves rounding errors of the length before.
        for _ in 0..2 {
            for direction in &basis {
                let along = dot(&column, direction);
                column.iter_mut().zip(direction).for_each(|(entry, part)| *entry -= along * part);
            }
        }
        let length = dot(&column, &column).sqrt();
        if k >= first {
            rest.push(column);
        } else if length > DEPENDENT * before {
            column.iter_mut().for_each(|entry| *entry /= length);
            basis.push(column);
        }
    }
    rest
}

/// A column of which less than this part is left depends on those before, as far as derivatives by differences tell.
const DEPENDENT: f64 = 1e-8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_first_columns_explain_is_taken_away() {
        let columns = vec![vec![1.0, 1.0, 0.0], vec![2.0, 2.0, 0.0], vec![3.0, 1.0, 5.0], vec![4.0, 4.0, 0.0]];
        let rest = without_first(columns, 2);
        let expected = [[1.0, -1.0, 5.0], [0.0; 3]];
        assert!(rest.iter().flatten().zip(expected.as_flattened()).all(|(entry, expected)| (entry - expected).abs() < 1e-12), "{rest:?}");
    }
}

//! What goes on within rows that each span several of the drive's periods is not in the log. How far the parameters would move with what it
//! could be is the doubt.
//!
//! - An inverter holds its voltage in the stator for one of its periods, in which the rotor turns by `x`. The flux goes along a chord and
//!   not along the arc, so that the voltage that would take it along the arc is more than a logged command by `x²/24`, and more than a
//!   logged mean of two periods by `x²/6`: which of them, and how long the drive's periods are, is not known. `x²/12` stands for both.
//!   Means of a few commands are [read](VoltageTiming) as of two or five that are held so; they may be fewer or more, or of a simulator
//!   that holds its voltage in the rotor's frame.
//! - Of means, what dead time, devices and harmonics take is averaged twice, over a row's span and from row to row. The simulation has it
//!   averaged once; with a wider span it comes nearer to that, and how much this matters tells what else is lost within a row.

use crate::{
    faults::Fault,
    levenberg_marquardt::{MOTOR, PriorResidual, jacobian},
    motor::PARAMETERS,
    normal_matrix::{NormalMatrix, dot},
    objective::{
        acting_voltage::VoltageTiming,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use nalgebra::DVector;
use std::f64::consts::TAU;

/// The drive's periods per electrical turn, at least: an inverter without synchronized pulses has 21 of the carrier's (N. Mohan,
/// T. M. Undeland, W. P. Robbins, Power Electronics, 3rd edition, 2003, section 8-2-1), and a drive samples at both its extremes.
const PERIODS_PER_TURN: f64 = 42.0;

/// The drive's periods per row, at least.
const PERIODS_PER_ROW: f64 = 2.0;

/// What the voltage may be off at most, by twice its standard deviation.
const DEVIATIONS: f64 = 2.0;

/// How far each parameter could be moved by it, SI, as a standard deviation; zero where rows are the drive's own periods, or a simulator's
/// steps.
pub(super) fn doubt(
    objective: &OutputError,
    reading: VoltageTiming,
    drive: &Adjustable,
    unknowns: &[Unknown],
    priors: &[PriorResidual],
) -> [f64; PARAMETERS] {
    if !reading.is_unusual() || matches!(reading, VoltageTiming::Euler { .. }) {
        return [0.0; PARAMETERS];
    }
    let mut columns = jacobian(objective, drive, unknowns);
    for (column, unknown) in columns.iter_mut().zip(unknowns) {
        column.extend(priors.iter().map(|belief| if belief.unknown == *unknown { -belief.weight } else { 0.0 }));
    }
    let inverse = NormalMatrix::of(&columns).inverse();
    let residuals = objective.residuals(drive);
    // A step of Gauss and Newton into the other minimum.
    let moves = |other: &OutputError| {
        let change: Vec<f64> = other.residuals(drive).iter().zip(&residuals).map(|(other, own)| other - own).collect();
        let moves = &inverse * DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(&column[..change.len()], &change)));
        MOTOR.map(|parameter| unknowns.iter().position(|unknown| *unknown == parameter).map_or(0.0, |place| moves[place].abs()))
    };
    let most_turn = |turn: f64| if let VoltageTiming::Averaged { of } = reading { of.most_turn(turn) } else { None };
    let more = |turn: f64| match most_turn(turn) {
        Some(turn) => 1.0 + turn.powi(2) / 24.0,
        None => 1.0 + (turn / PERIODS_PER_ROW).abs().min(TAU / PERIODS_PER_TURN).powi(2) / 12.0,
    };
    let by_periods = moves(&objective.with_voltages_scaled(more));
    let is_taken = |fault: Fault| unknowns.iter().filter_map(|unknown| unknown.fault()).any(|taken| taken.family() == fault.family());
    let changes = matches!(reading, VoltageTiming::Averaged { .. }) && (is_taken(Fault::DeadTime) || is_taken(Fault::FluxHarmonics));
    let by_averages = if changes { moves(&objective.averaging_twice()) } else { [0.0; PARAMETERS] };
    std::array::from_fn(|p| (by_periods[p] / DEVIATIONS).hypot(by_averages[p]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        log::{Columns, Log},
        motor::Motor,
        objective::acting_voltage::VoltageFrame,
    };

    const MOTOR_OF_LOG: Motor = Motor { rs: 0.05, ld: 1e-4, lq: 2e-4, psi_f: 0.01 };

    /// Electrical turn per row, rad; two of the drive's periods fit in, each of a turn of 0.06.
    const TURN: f64 = 0.12;

    fn objective(reading: VoltageTiming) -> OutputError {
        let (period, omega_e) = (1e-4, TURN / 1e-4);
        let (mut columns, mut i) = (Columns::default(), [0.0, 0.0]);
        for k in 0..2000 {
            let u = [0.5 * (k as f64 / 40.0).sin(), 12.0 + 0.5 * (k as f64 / 70.0).cos()];
            columns.t.push(k as f64 * period);
            columns.ud.push(u[0]);
            columns.uq.push(u[1]);
            columns.id.push(i[0]);
            columns.iq.push(i[1]);
            columns.omega_e.push(omega_e);
            let Motor { rs, ld, lq, psi_f } = MOTOR_OF_LOG;
            let slope = [(u[0] - rs * i[0] + omega_e * lq * i[1]) / ld, (u[1] - rs * i[1] - omega_e * (ld * i[0] + psi_f)) / lq];
            i = [i[0] + period * slope[0], i[1] + period * slope[1]];
        }
        OutputError::of(&Log::new(columns).unwrap(), reading).unwrap()
    }

    /// Currents stay what they are if voltages, resistance, inductances and flux all grow by the same part.
    #[test]
    fn every_parameter_moves_by_the_part_of_the_voltage() {
        let reading = VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Rotor };
        let moves = doubt(&objective(reading), reading, &Adjustable::from(MOTOR_OF_LOG), &MOTOR, &[]);
        let part = 0.06_f64.powi(2) / 12.0 / 2.0;
        for (moved, value) in moves.iter().zip(MOTOR_OF_LOG.to_array()) {
            assert!((moved / (part * value) - 1.0).abs() < 1e-3, "{moves:?}");
        }
    }

    #[test]
    fn the_drives_own_periods_leave_no_doubt() {
        let reading = VoltageTiming::Delayed { delay: 0, frame: VoltageFrame::Middle };
        assert_eq!(doubt(&objective(reading), reading, &Adjustable::from(MOTOR_OF_LOG), &MOTOR, &[]), [0.0; PARAMETERS]);
    }
}

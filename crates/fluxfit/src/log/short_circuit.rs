//! A motor that turns with shorted terminals: the voltages are zero throughout, and its own flux drives the currents.
//!
//! Equation (1) with `u = 0` is steady at `i_d = -omega² L_q psi_f / (R_s² + omega² L_d L_q)` and
//! `i_q = -omega R_s psi_f / (R_s² + omega² L_d L_q)`: both brake, whatever the motor. Zeros where the voltages should be, of a drive that
//! carries current, are as a rule no short circuit.

use super::columns::Columns;

/// The mean current vector, turned over where the rotor turns backward, is at least this part of the mean magnitude: of noise it is
/// nearly zero, of a steady short circuit nearly one.
const LEAST_DIRECTION: f64 = 0.5;

/// Whether both voltages are zero in every row.
pub(super) fn voltages_are_zero(columns: &Columns) -> bool {
    columns.ud.iter().chain(&columns.uq).all(|value| *value == 0.0)
}

/// Whether the currents are those of a short circuit, as far as their direction tells.
pub(super) fn currents_brake(columns: &Columns) -> bool {
    let (mut d, mut q, mut magnitude) = (0.0, 0.0, 0.0);
    for ((id, iq), omega_e) in columns.id.iter().zip(&columns.iq).zip(&columns.omega_e) {
        d += id;
        q += iq * omega_e.signum();
        magnitude += id.hypot(*iq);
    }
    d < 0.0 && q < 0.0 && d.hypot(q) >= LEAST_DIRECTION * magnitude
}

//! Faults of a drive that are known, as from `fluxfit identify`: rows are freed of them before an estimator sees them.
//!
//! What stands still in the stator, the offset of the sensors and the phases' dead time, needs the electrical angle of each row. Of the
//! dead time, the mean over a carrier period is added: which edge of a period lies in which row a stream does not know.

use fluxfit::{
    frames::{Abc, AlphaBeta, Dq},
    log::Row,
};
use serde::{Deserialize, Serialize};

/// The faults.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveFaults {
    /// Voltage that each phase loses against its current, V.
    pub dead_time_voltage: f64,
    /// Phase current from which on it loses all of that, A; below, in proportion.
    pub dead_time_width: f64,
    /// What the current sensors read at zero, A: alpha, beta.
    pub current_offset: [f64; 2],
    /// What the angle is too large by, electrical rad.
    pub angle_offset: f64,
}

impl DriveFaults {
    /// The number of this name in the answer of an identification; none if a stream cannot be freed of it.
    pub fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "dead_time_voltage" => Some(&mut self.dead_time_voltage),
            "dead_time_width" => Some(&mut self.dead_time_width),
            "current_offset_alpha" => Some(&mut self.current_offset[0]),
            "current_offset_beta" => Some(&mut self.current_offset[1]),
            "angle_offset" => Some(&mut self.angle_offset),
            _ => None,
        }
    }

    /// Whether rows without an electrical angle cannot be freed of them.
    pub fn need_angle(&self) -> bool {
        self.dead_time_voltage != 0.0 || self.current_offset != [0.0; 2]
    }

    /// The current of a row without the offset of its sensors, A, in the frame of the logged angle.
    pub(crate) fn current(&self, row: &Row) -> [f64; 2] {
        let Some(angle) = row.theta_e.filter(|_| self.current_offset != [0.0; 2]) else { return [row.id, row.iq] };
        let [alpha, beta] = self.current_offset;
        let offset = AlphaBeta { alpha, beta }.to_dq(angle);
        [row.id - offset.d, row.iq - offset.q]
    }

    /// What the phases lose of a voltage, V, at a current, A, and an electrical angle; all in the frame of the logged angle.
    pub(crate) fn lost(&self, [d, q]: [f64; 2], angle: f64) -> [f64; 2] {
        if self.dead_time_voltage == 0.0 {
            return [0.0; 2];
        }
        let Abc { a, b, c } = Dq { d, q }.to_alpha_beta(angle).to_abc();
        let width = self.dead_time_width.abs();
        let [a, b, c] = [a, b, c].map(|i| self.dead_time_voltage * if width > 0.0 { (i / width).clamp(-1.0, 1.0) } else { i.signum() });
        let lost = Abc { a, b, c }.to_alpha_beta().to_dq(angle);
        [lost.d, lost.q]
    }

    /// A vector of the logged angle's frame, in the magnet's.
    pub(crate) fn in_magnets_frame(&self, v: [f64; 2]) -> [f64; 2] {
        if self.angle_offset == 0.0 {
            return v;
        }
        let (sin, cos) = self.angle_offset.sin_cos();
        [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 9 A along q at the angle zero: phase a has none, b +7.8 A and c -7.8 A. They lose 3 V each, which is 2 sqrt(3) V along q.
    #[test]
    fn the_loss_is_that_of_the_phases() {
        let mut faults = DriveFaults { dead_time_voltage: 3.0, dead_time_width: 0.5, ..DriveFaults::default() };
        let lost = faults.lost([0.0, 9.0], 0.0);
        assert!(lost[0].abs() < 1e-12 && (lost[1] - 2.0 * 3.0_f64.sqrt()).abs() < 1e-12, "{lost:?}");
        // 0.2 A at 90 degrees are -0.2 A in phase a and 0.1 A in the others, all below the width: 3 V/0.5 A of each.
        let lost = faults.lost([0.0, 0.2], std::f64::consts::FRAC_PI_2);
        assert!(lost[0].abs() < 1e-12 && (lost[1] - 1.2).abs() < 1e-12, "{lost:?}");
        *faults.number("angle_offset").unwrap() = std::f64::consts::FRAC_PI_2;
        assert!(faults.number("speed_lag").is_none());
        let turned = faults.in_magnets_frame([1.0, 2.0]);
        assert!((turned[0] + 2.0).hypot(turned[1] - 1.0) < 1e-12, "{turned:?}");
    }
}

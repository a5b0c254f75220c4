//! Motors with their ratings: a list of our own, or a CSV file.

use fluxfit::motor::Motor;
use std::{collections::BTreeMap, error::Error, path::Path};

/// A motor and its rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rated {
    /// Its number: the row of the file, from 1.
    pub row: usize,
    /// Its parameters.
    pub motor: Motor,
    /// Pole pairs.
    pub pole_pairs: u32,
    /// DC voltage of its drive, V.
    pub u_dc: f64,
    /// Rated current, A, peak.
    pub current: f64,
    /// Nominal speed, electrical rad/s.
    pub omega_e: f64,
}

/// Ratings as data sheets of such motors have them: `R_s, L_d, L_q, psi_f`, pole pairs, DC voltage, current, electrical speed.
const TYPICAL: [([f64; 4], u32, f64, f64, f64); 12] = [
    // The paper's servo motor.
    ([0.958, 5.25e-3, 12e-3, 0.1827], 4, 310.0, 10.0, 419.0),
    // Electric bicycle.
    ([0.060, 110e-6, 140e-6, 13e-3], 10, 48.0, 40.0, 1300.0),
    // Drone.
    ([0.050, 19e-6, 23e-6, 2e-3], 7, 24.0, 25.0, 5000.0),
    // Scooter, in the hub.
    ([0.090, 160e-6, 200e-6, 17e-3], 15, 36.0, 25.0, 900.0),
    // Car, interior magnets.
    ([0.012, 170e-6, 420e-6, 65e-3], 4, 350.0, 250.0, 2000.0),
    // Reluctance motor with magnets.
    ([0.55, 12e-3, 45e-3, 0.35], 2, 540.0, 12.0, 314.0),
    // Servo motor, surface magnets.
    ([2.4, 8e-3, 8.5e-3, 0.11], 4, 320.0, 5.0, 1250.0),
    // Joint of a robot.
    ([0.25, 200e-6, 220e-6, 6e-3], 14, 24.0, 10.0, 1200.0),
    // Compressor.
    ([0.8, 8e-3, 12e-3, 0.12], 3, 380.0, 9.0, 1100.0),
    // Washing machine without a belt.
    ([4.5, 25e-3, 32e-3, 0.21], 24, 310.0, 3.0, 600.0),
    // Wind turbine.
    ([0.020, 1.6e-3, 2.2e-3, 1.1], 12, 690.0, 150.0, 200.0),
    // Fan.
    ([1.2, 1.4e-3, 1.4e-3, 9e-3], 5, 24.0, 1.5, 900.0),
];

/// A dozen motors of different kinds and sizes.
pub fn typical() -> Vec<Rated> {
    let of = |(index, (motor, pole_pairs, u_dc, current, omega_e)): (usize, ([f64; 4], u32, f64, f64, f64))| Rated {
        row: index + 1,
        motor: Motor::from(motor),
        pole_pairs,
        u_dc,
        current,
        omega_e,
    };
    TYPICAL.into_iter().enumerate().map(of).collect()
}

/// Reads one motor per row: `Ld_H, Lq_H, Rs_ohm, pole_pairs, psi_pm_Wb, Udc_V, I_nom_A, omega_e_nom_rad_s`.
///
/// # Errors
/// If the file cannot be read, or a row lacks a number; the error names the file.
pub fn read(path: &Path) -> Result<Vec<Rated>, Box<dyn Error>> {
    rows(path).map_err(|error| format!("{}: {error}", path.display()).into())
}

fn rows(path: &Path) -> Result<Vec<Rated>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for (row, record) in csv::Reader::from_path(path)?.deserialize().enumerate() {
        let record: BTreeMap<String, f64> = record?;
        let get = |key: &str| record.get(key).copied().ok_or_else(|| format!("no column {key}"));
        rows.push(Rated {
            row: row + 1,
            motor: Motor { rs: get("Rs_ohm")?, ld: get("Ld_H")?, lq: get("Lq_H")?, psi_f: get("psi_pm_Wb")? },
            pole_pairs: get("pole_pairs")? as u32,
            u_dc: get("Udc_V")?,
            current: get("I_nom_A")?,
            omega_e: get("omega_e_nom_rad_s")?,
        });
    }
    Ok(rows)
}

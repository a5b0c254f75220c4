//! MATLAB: a script that fills the struct `pmsm` of Motor Control Blockset.

use super::{
    entry::{Entry, File, Value},
    quantity::Quantity,
    tool::{ExportedMotor, Tool, gains_remark},
};
use fluxfit::{current_loop::Gain, motor::Parameter};

const STRUCT: &str = "https://www.mathworks.com/help/mcb/ref/mcb.getpmsmparameters.html";
const BACK_EMF: &str = "https://www.mathworks.com/help/mcb/ref/pmsmconfiguration.html (Back electromotive force: Vpk_LL/krpm)";
const GAINS: &str = "Harnefors and Nee 1998, DOI 10.1109/28.658735";

/// Mechanical revolutions per second at 1000 r/min.
const KRPM: f64 = 1000.0 / 60.0;

/// The tool.
pub(super) const TOOL: Tool = Tool {
    key: "matlab",
    name: "MATLAB",
    parameters: &Parameter::ALL,
    needs_pole_pairs: Some("pmsm.p and the back-EMF constant"),
    file,
    text,
};

fn file(motor: &ExportedMotor<'_>) -> File {
    let measured = |key, quantity, unit, meaning, source| Entry { key, value: Value::Measured(quantity), unit, meaning, source };
    let mut entries = vec![
        Entry { key: "pmsm.p", value: Value::Count(motor.pole_pairs), unit: "", meaning: "Pole pairs.", source: STRUCT },
        measured("pmsm.Rs", motor.rs, "ohm", "R_s, per phase.", STRUCT),
        measured("pmsm.Ld", motor.ld, "H", "L_d, per phase.", STRUCT),
        measured("pmsm.Lq", motor.lq, "H", "L_q, per phase.", STRUCT),
        measured("pmsm.FluxPM", motor.psi_f, "Wb", "psi_f, peak, per phase.", STRUCT),
        measured(
            "pmsm.Ke",
            motor.line_to_line_peak_per_hz().map(|per_hz| per_hz * KRPM),
            "V/krpm",
            "Peak voltage between two phases at 1000 r/min: sqrt(3) 2 pi p psi_f 1000/60.",
            BACK_EMF,
        ),
    ];
    let mut remarks = vec![
        "Fields that a log of dq quantities does not determine (J, B, Kt, I_rated, N_max, ..) are not set: first pmsm = mcb.getPMSMParameters(\"new\").".to_owned(),
        "Simscape Electrical's PMSM block takes the same numbers: pole pairs (pmsm.p), permanent magnet flux linkage (pmsm.FluxPM),".to_owned(),
        "stator d-axis inductance (pmsm.Ld), q-axis inductance (pmsm.Lq), resistance per phase (pmsm.Rs); star winding.".to_owned(),
    ];
    if let Some(current_loop) = motor.current_loop {
        remarks.push(gains_remark(current_loop));
        remarks.push("The gains are in SI units; PI_params of Motor Control Blockset may be per unit.".to_owned());
        let mut gain = |key, gain: Option<Gain>, unit, meaning| {
            entries.extend(gain.map(|gain| measured(key, Quantity::from(gain), unit, meaning, GAINS)));
        };
        gain("current_loop.Kp_d", current_loop.kp_d, "V/A", "Proportional gain of the d axis: bandwidth (rad/s) times L_d.");
        gain("current_loop.Kp_q", current_loop.kp_q, "V/A", "Proportional gain of the q axis: bandwidth (rad/s) times L_q.");
        gain("current_loop.Ki", current_loop.ki, "V/(A s)", "Integral gain of both axes: bandwidth (rad/s) times R_s.");
    }
    File { entries, remarks }
}

fn text(comments: &[String], entries: &[Entry]) -> String {
    let mut text: String = comments.iter().map(|line| format!("% {line}").trim_end().to_owned() + "\n").collect();
    for entry in entries {
        text += &format!("{} = {}; % {}\n", entry.key, entry.value.text(), entry.unit);
    }
    text.replace("; % \n", ";\n")
}

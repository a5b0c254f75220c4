//! ST's Motor Control SDK: lines for the header `pmsm_motor_parameters.h` that Workbench generates.

use super::{
    entry::{Entry, File, Value, number},
    tool::{ExportedMotor, Tool, gains_remark},
};
use fluxfit::{current_loop::Gain, motor::Parameter};

const HEADER: &str = "https://github.com/anyway-blows/ST_MCSDK_FULL_5.4.3/blob/ccf6f596fae8a1c0cf4edb0328536ccaa389be9f/Middlewares/ST/MotorControl/templates/pmsm_motor_parameters.h.ftl (MCSDK 5.4.3)";
const CONVERSION: &str = "https://github.com/anyway-blows/ST_MCSDK_FULL_5.4.3/blob/ccf6f596fae8a1c0cf4edb0328536ccaa389be9f/Middlewares/ST/MotorControl/templates/parameters_conversion.h.ftl (MAX_BEMF_VOLTAGE, C1, C5; MCSDK 5.4.3)";

/// Mechanical revolutions per second at 1000 r/min.
const KRPM: f64 = 1000.0 / 60.0;

/// The tool.
pub(super) const TOOL: Tool = Tool {
    key: "mcsdk",
    name: "ST's Motor Control SDK",
    // The header has no L_d.
    parameters: &[Parameter::Rs, Parameter::Lq, Parameter::PsiF],
    needs_pole_pairs: Some("the voltage constant"),
    file,
    text,
};

fn file(motor: &ExportedMotor<'_>) -> File {
    let measured = |key, quantity, unit, meaning, source| Entry { key, value: Value::Measured(quantity), unit, meaning, source };
    let rms = motor.line_to_line_peak_per_hz().map(|per_hz| per_hz * KRPM / 2.0_f64.sqrt());
    let entries = vec![
        Entry { key: "POLE_PAIR_NUM", value: Value::Count(motor.pole_pairs), unit: "", meaning: "Pole pairs.", source: HEADER },
        measured("RS", motor.rs, "ohm", "R_s, per phase: it is multiplied by phase currents.", CONVERSION),
        measured("LS", motor.lq, "H", "L_q, per phase: the header asks for it if L_d and L_q differ.", HEADER),
        measured(
            "MOTOR_VOLTAGE_CONSTANT",
            rms,
            "V/krpm",
            "RMS voltage between two phases at 1000 r/min: sqrt(3/2) 2 pi p psi_f 1000/60.",
            CONVERSION,
        ),
    ];
    let mut remarks = vec![
        "Replace the lines with the same names in Inc/pmsm_motor_parameters.h; its other lines cannot be identified from a log."
            .to_owned(),
        "Templates of MCSDK 6.3 read the field Ls of the project as L_d, and L_q as that times LDLQ_RATIO: check which one your Workbench asks for."
            .to_owned(),
    ];
    if let Some(current_loop) = motor.current_loop {
        remarks.push(gains_remark(current_loop));
        let gain = |gain: Option<Gain>| gain.map_or("unknown".to_owned(), |gain| number(gain.value));
        remarks.push(format!(
            "In SI units K_p = {} V/A (d), {} V/A (q), K_i = {} V/(A s).",
            gain(current_loop.kp_d),
            gain(current_loop.kp_q),
            gain(current_loop.ki)
        ));
        remarks.push(
            "PID_TORQUE_KP_DEFAULT, PID_FLUX_KP_DEFAULT and their KI are left out: they are integers in the scale of the board's current sensing, bus voltage and divisors."
                .to_owned(),
        );
    }
    File { entries, remarks }
}

fn text(comments: &[String], entries: &[Entry]) -> String {
    let mut text = "/*\n".to_owned();
    for line in comments {
        text += format!(" * {}", inside_a_comment(line)).trim_end();
        text += "\n";
    }
    text += " */\n#ifndef FLUXFIT_MOTOR_PARAMETERS_H\n#define FLUXFIT_MOTOR_PARAMETERS_H\n\n";
    for entry in entries {
        text += &format!("#define {:<23} {}\n", entry.key, entry.value.text());
    }
    text + "\n#endif /* FLUXFIT_MOTOR_PARAMETERS_H */\n"
}

/// C ends a comment at the first `*/`, and compilers warn about `/*` inside one.
fn inside_a_comment(line: &str) -> String {
    line.replace("*/", "* /").replace("/*", "/ *")
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_name_of_a_log_ends_the_comment() {
        for name in ["a*/b", "/*/", "*/*/", "/*/*"] {
            let line = super::inside_a_comment(name);
            assert!(!line.contains("*/") && !line.contains("/*"), "{line}");
        }
    }
}

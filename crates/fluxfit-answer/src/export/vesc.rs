//! VESC Tool: a motor configuration with these parameters only. Loading it does not change the others (`ConfigParams::setXML`).

use super::{
    entry::{Entry, File, Value},
    quantity::Quantity,
    tool::{ExportedMotor, Tool, gains_remark},
};
use fluxfit::motor::Parameter;

const OBSERVER: &str =
    "https://github.com/vedderb/bldc/blob/b9d287b3b8323f4b02618b02dc55e57d54a84996/motor/foc_math.c (foc_observer_update)";
const INDUCTANCES: &str =
    "https://github.com/vedderb/bldc/blob/b9d287b3b8323f4b02618b02dc55e57d54a84996/motor/foc_math.c (foc_precalc_values)";
const GAINS: &str = "https://github.com/vedderb/bldc/blob/b9d287b3b8323f4b02618b02dc55e57d54a84996/conf_general.c (conf_general_calc_apply_foc_cc_kp_ki_gain)";
const DECOUPLING: &str =
    "https://github.com/vedderb/bldc/blob/b9d287b3b8323f4b02618b02dc55e57d54a84996/motor/mcpwm_foc.c (control_current)";

/// The tool.
pub(super) const TOOL: Tool = Tool { key: "vesc", name: "VESC Tool", parameters: &Parameter::ALL, needs_pole_pairs: None, file, text };

fn file(motor: &ExportedMotor<'_>) -> File {
    let entry = |key, quantity, unit, meaning, source| Entry { key, value: Value::Measured(quantity), unit, meaning, source };
    let mean = motor.ld.plus(0.5, 0.5, motor.lq, motor.correlation);
    let mut entries = vec![
        entry("foc_motor_r", motor.rs, "ohm", "R_s, per phase: half of the resistance between two terminals of the motor.", OBSERVER),
        entry("foc_motor_l", mean, "H", "(L_d + L_q) / 2, per phase.", INDUCTANCES),
        entry("foc_motor_ld_lq_diff", motor.lq.plus(1.0, -1.0, motor.ld, motor.correlation), "H", "L_q - L_d, per phase.", INDUCTANCES),
        entry(
            "foc_motor_flux_linkage",
            motor.psi_f,
            "Wb",
            "psi_f, peak, per phase: peak phase voltage over electrical speed (rad/s).",
            DECOUPLING,
        ),
    ];
    let mut remarks = vec![
        "Load it as a motor configuration (XML); other parameters are not changed. VESC Tool may report that it is".to_owned(),
        "from another version, since the file states none. foc_observer_gain is not set: it follows from the flux linkage.".to_owned(),
        "The detection of VESC Tool stores 0.9 times the measured inductance; this file has the inductance itself.".to_owned(),
    ];
    if let Some(current_loop) = motor.current_loop {
        remarks.push(gains_remark(current_loop));
        if let Some(ki) = current_loop.ki {
            // VESC has one proportional gain for both axes, computed from the mean inductance.
            let kp = mean.map(|mean| std::f64::consts::TAU * current_loop.bandwidth * mean);
            entries.push(entry("foc_current_kp", kp, "V/A", "Bandwidth (rad/s) times the mean inductance, for both axes.", GAINS));
            entries.push(entry("foc_current_ki", Quantity::from(ki), "V/(A s)", "Bandwidth (rad/s) times R_s.", GAINS));
        }
    }
    File { entries, remarks }
}

fn text(comments: &[String], entries: &[Entry]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!--\n".to_owned();
    for line in comments {
        text += &format!("  {}\n", inside_a_comment(line));
    }
    text += "-->\n<MCConfiguration>\n";
    for entry in entries {
        text += &format!("    <{0}>{1}</{0}>\n", entry.key, entry.value.text());
    }
    text + "</MCConfiguration>\n"
}

/// XML does not allow two hyphens in a row in a comment.
fn inside_a_comment(line: &str) -> String {
    let mut line = line.to_owned();
    while line.contains("--") {
        line = line.replace("--", "- -");
    }
    line
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_name_of_a_log_ends_the_comment() {
        assert_eq!(super::inside_a_comment("a--->b---c"), "a- - ->b- - -c");
    }
}

//! moteus: `conf set` commands. The controller does not accept comments, so only the commands are sent to it.

use super::{
    entry::{Entry, File, Value, number},
    tool::{ExportedMotor, Tool, gains_remark},
};
use fluxfit::motor::Parameter;

const MOTOR: &str =
    "https://github.com/mjbots/moteus/blob/db1a7623d6a7d5568e7632b974a9ab521a4d2bab/fw/bldc_servo_structs.h (BldcServoMotor)";
const KV: &str =
    "https://github.com/mjbots/moteus/blob/db1a7623d6a7d5568e7632b974a9ab521a4d2bab/fw/bldc_servo_control.h (UpdateDerivedMotorConstants)";

/// The tool.
pub(super) const TOOL: Tool = Tool { key: "moteus", name: "moteus", parameters: &Parameter::ALL, needs_pole_pairs: Some("Kv"), file, text };

fn file(motor: &ExportedMotor<'_>) -> File {
    let entry = |key, quantity, unit, meaning, source| Entry { key, value: Value::Measured(quantity), unit, meaning, source };
    let kv = motor.line_to_line_peak_per_hz().map(|per_hz| 60.0 / per_hz);
    let mut entries = vec![
        entry("motor.resistance_ohm", motor.rs, "ohm", "R_s, from a phase to the star point.", MOTOR),
        entry("motor.inductance_d_H", motor.ld, "H", "L_d, from a phase to the star point, at i_d = 0.", MOTOR),
        entry("motor.inductance_q_H", motor.lq, "H", "L_q, from a phase to the star point.", MOTOR),
        entry(
            "motor.Kv",
            kv,
            "rpm/V",
            "Mechanical speed of the rotor over the peak voltage between two phases: 60 / (sqrt(3) 2 pi p psi_f).",
            KV,
        ),
    ];
    let mut remarks = vec![
        "The controller accepts commands only: write the lines that begin with conf into a file (grep '^conf' THIS > FILE), and pass it"
            .to_owned(),
        "to moteus_tool with its option write-config; afterwards conf write stores the values.".to_owned(),
        "For firmware 0x010e or later, which has servo.pid_dq_hz (0x010a: motor.Kv); moteus_tool lists what an older one refuses."
            .to_owned(),
        format!("motor.poles is not set; Kv holds for {} pole pairs, motor.poles = {}.", motor.pole_pairs, 2 * motor.pole_pairs),
    ];
    if let Some(current_loop) = motor.current_loop {
        remarks.push(gains_remark(current_loop));
        entries.push(Entry {
            key: "servo.pid_dq_hz",
            value: Value::Given(current_loop.bandwidth),
            unit: "Hz",
            meaning: "Bandwidth, from which moteus computes its gains: 2 pi times bandwidth times L_d, L_q (kp) and R_s (ki).",
            source: KV,
        });
        if let (Some(d), Some(q), Some(i)) = (current_loop.kp_d, current_loop.kp_q, current_loop.ki) {
            let gains = [d, q, i].map(|gain| number(gain.value));
            remarks.push(format!(
                "The resulting gains: kp {} V/A (d), {} V/A (q), ki {} V/(A s). Firmware before 0x010e has one servo.pid_dq.kp and ki instead.",
                gains[0], gains[1], gains[2]
            ));
        }
    }
    File { entries, remarks }
}

fn text(comments: &[String], entries: &[Entry]) -> String {
    let mut text: String = comments.iter().map(|line| format!("# {line}").trim_end().to_owned() + "\n").collect();
    for entry in entries {
        text += &format!("conf set {} {}\n", entry.key, entry.value.text());
    }
    text
}

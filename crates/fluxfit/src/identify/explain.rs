//! Why a parameter is not identified, and what to do about it: in the words of the bench.
//!
//! A parameter that the log leaves open gets the reason why it is open; any other, the largest part of its interval.

use super::{
    advice::{Advice, one_digit},
    excitation::Excitation,
    uncertainty::{ParameterUncertainty, Part},
    verdict::{IDENTIFIED, WEAK},
};
use crate::{motor::Parameter, steady::OperatingPoint};

/// A reason and a remedy, for a parameter whose verdict is not `identified`; `raw` is the number that came out.
pub(super) fn explain(
    parameter: Parameter,
    points: &[OperatingPoint],
    excitation: &Excitation,
    raw: f64,
    uncertainty: &ParameterUncertainty,
    advice: &Advice,
) -> (String, String) {
    let width = if raw == 0.0 { f64::INFINITY } else { uncertainty.half_width / raw.abs() };
    if excitation.is_open(parameter) {
        let (reason, phrase) = open(parameter, points, excitation);
        (reason, advice.remedy(parameter).unwrap_or(phrase))
    } else if raw <= 0.0 && width < WEAK {
        negative(parameter)
    } else {
        wide(parameter, width, uncertainty.largest_part(), advice)
    }
}

/// The same of the motor whose currents were simulated.
pub(super) fn explain_currents(parameter: Parameter, raw: f64, uncertainty: &ParameterUncertainty, advice: &Advice) -> (String, String) {
    let width = if raw == 0.0 { f64::INFINITY } else { uncertainty.half_width / raw.abs() };
    if raw <= 0.0 && width < WEAK { negative(parameter) } else { wide(parameter, width, uncertainty.largest_part(), advice) }
}

/// Disturbances that may be faults of the drive.
pub(super) fn explain_no_angle() -> (String, String) {
    (
        "something disturbs the motor, and without the electrical angle it cannot be told from dead time or unequal current sensors, which move every parameter".to_owned(),
        "log theta_e too (electrical, as the drive uses it), or hold the drive still and use --model steady".to_owned(),
    )
}

/// What the simulated currents miss is no noise.
pub(super) fn explain_no_noise(correlation: f64) -> (String, String) {
    (
        format!(
            "what the simulated currents miss is no noise (neighbouring rows are correlated by {correlation:.2}): something is in the log that the model does not have"
        ),
        "compare with --model steady, look at the residuals in --report, and log theta_e and u_dc too if the drive has them".to_owned(),
    )
}

/// Why nothing is believed of simulated currents that miss the measured ones.
pub(super) fn explain_misses(misses: f64) -> (String, String) {
    (
        format!(
            "the simulated currents miss the measured ones by {:.0} % of the largest current, and not by noise: no motor makes these currents of these voltages",
            100.0 * misses
        ),
        format!("{SIGNS}; units and pole pairs too"),
    )
}

const SIGNS: &str = "check signs and order of the columns: motor convention (are the currents reversed?), q 90 degrees ahead of d, one sign of speed and of u_q";

fn negative(parameter: Parameter) -> (String, String) {
    (format!("{} came out negative, which no motor has, and not by noise", parameter.symbol()), SIGNS.to_owned())
}

/// Beyond this, longer windows are no remedy.
const MUCH_LONGER: f64 = 100.0;

/// Why an interval is wide.
fn wide(parameter: Parameter, width: f64, part: Part, advice: &Advice) -> (String, String) {
    let symbol = parameter.symbol();
    let leaves = if width < 10.0 { format!("leaves ±{:.2} %", 100.0 * width) } else { "leaves more than the value itself".to_owned() };
    let apart = || advice.remedy(parameter).unwrap_or_else(|| farther_apart(parameter).to_owned());
    match part {
        Part::Noise => {
            // A standard error falls with the root of the time.
            let longer = (width / IDENTIFIED).powi(2).ceil();
            let remedy =
                if longer < MUCH_LONGER { format!("hold each operating point about {longer:.0} times as long, or {}", apart()) } else { apart() };
            (format!("noise {leaves}"), remedy)
        }
        Part::Accuracy => (format!("the voltages' accuracy {leaves}: the operating points are too much alike to tell {symbol}"), apart()),
        Part::Timing => (
            format!("it is not known which instant the voltage columns belong to, which {leaves}"),
            "state it with --voltage-timing".to_owned(),
        ),
        Part::DeadTime => (
            format!("the currents ripple as dead time or device drops make them, and the voltage these take looks like resistance, which {leaves}"),
            "log with the drive's dead-time compensation on, or give R_s as measured at the terminals with --fix".to_owned(),
        ),
        Part::ProcessNoise => (
            format!("unknown voltages disturb the motor, and the answer with and without a model of them differs, which {leaves}"),
            "log with the test bench at rest (no torque ripple, no supply ripple), or add a stretch held still and name it with --window, --model steady".to_owned(),
        ),
        Part::Sensors => (
            format!("the current sensors differ, and nobody knows which is right, which {leaves}"),
            "calibrate the current sensors".to_owned(),
        ),
        Part::Saturation => (
            format!("the inductances depend on the current, and one number for all of the log {leaves}"),
            "identify from a part of the log at nearly the same currents, with --window".to_owned(),
        ),
        Part::Misfit => (
            format!(
                "the operating points contradict each other beyond their noise, which {leaves}: no motor with constant parameters explains them"
            ),
            "name three or more windows at nearly the same currents with --window, so that the motor saturates alike in them and a contradiction would still show, and only where the drive switches"
                .to_owned(),
        ),
        Part::Prior => (format!("the prior that was given {leaves}"), "give a sharper --prior, or log another operating point".to_owned()),
        Part::Excitation => (format!("what the log does not excite could move it, which {leaves}"), apart()),
    }
}

/// How to make operating points tell a parameter.
fn farther_apart(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Rs => {
            "add operating points with more current at low speed, or a larger step of i_d, or give --prior rs=VALUE±1% from a multimeter"
        }
        Parameter::Ld => "make the step of i_d larger",
        Parameter::Lq => "add operating points with more i_q",
        Parameter::PsiF => "add operating points at a higher speed, or at a second speed",
    }
}

/// Share of the current that a step of i_d should have: the paper's -2 A of 10 A.
const STEP: f64 = 0.2;

/// Means closer than this, as a fraction of the largest current or speed, are the same for advice.
const SAME: f64 = 0.05;

/// Why the log leaves a parameter open: what its operating points have in common.
fn open(parameter: Parameter, points: &[OperatingPoint], excitation: &Excitation) -> (String, String) {
    let current = points.iter().map(|point| point.current().magnitude()).fold(0.0, f64::max);
    let speed = points.iter().map(|point| point.omega_e().abs()).fold(0.0, f64::max);
    let id_most = points.iter().map(|point| point.current().d.abs()).fold(0.0, f64::max);
    let spread = |value: fn(&OperatingPoint) -> f64| {
        let values = || points.iter().map(value);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let id_zero = id_most <= SAME * current;
    let id_constant = spread(|point| point.current().d) <= SAME * current;
    let one_point = id_constant && spread(|point| point.current().q) <= SAME * current && spread(OperatingPoint::omega_e) <= SAME * speed;
    let step = if id_zero {
        format!("add a stretch at the same speed with i_d near {} A", one_digit(-STEP * current))
    } else {
        "add a stretch at the same speed with i_d = 0".to_owned()
    };
    match parameter {
        Parameter::Ld if id_zero => {
            let id_most = one_digit(id_most);
            (
                format!(
                    "i_d stays at zero (at most {id_most} A, no more than its noise and accuracy), so L_d is absent from the equations"
                ),
                step,
            )
        }
        Parameter::Rs | Parameter::PsiF if id_zero && one_point => (
            "there is one speed and one load, where R_s i_q and omega_e psi_f act alike".to_owned(),
            format!("{step}, or a second speed or load, or give --fix rs=VALUE"),
        ),
        Parameter::Ld | Parameter::PsiF if id_constant && !excitation.is_open(Parameter::Rs) => {
            ("i_d is the same at every operating point, where L_d i_d and psi_f act alike".to_owned(), step)
        }
        _ => {
            let open: Vec<&str> = Parameter::ALL.into_iter().filter(|other| excitation.is_open(*other)).map(Parameter::symbol).collect();
            let reason =
                format!("the operating points are too much alike for their noise: only combinations of {} show in them", open.join(", "));
            (reason, format!("{step}, and one at a clearly different speed and load"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frames::Dq,
        identify::{Settings, identify},
        log::{Columns, Log},
        motor::Motor,
    };

    /// The reason given for a parameter on a noise-free log of these operating points: i_d, i_q (A), omega_e (rad/s).
    fn reason(parameter: Parameter, points: &[(f64, f64, f64)]) -> String {
        let motor = Motor { rs: 0.035, ld: 175e-6, lq: 300e-6, psi_f: 0.05 };
        let mut columns = Columns::default();
        for (k, &(d, q, omega_e)) in points.iter().flat_map(|point| [point; 100]).enumerate() {
            let u = motor.steady_voltage(Dq { d, q }, omega_e);
            columns.t.push(k as f64 * 0.01);
            let row = [(&mut columns.ud, u.d), (&mut columns.uq, u.q), (&mut columns.id, d), (&mut columns.iq, q)];
            row.into_iter().for_each(|(column, value)| column.push(value));
            columns.omega_e.push(omega_e);
        }
        let found = identify(&Log::new(columns).unwrap(), &Settings::default()).unwrap();
        found.parameter(parameter).reason.clone().unwrap_or_default()
    }

    #[test]
    fn the_reason_is_what_the_points_have_in_common() {
        let zero = reason(Parameter::Ld, &[(0.0, 90.0, 1400.0), (0.0, 150.0, 1800.0)]);
        assert!(zero.starts_with("i_d stays at zero"), "{zero}");
        let one = reason(Parameter::Rs, &[(0.0, 90.0, 1400.0)]);
        assert!(one.starts_with("there is one speed and one load"), "{one}");
        let constant = reason(Parameter::PsiF, &[(-20.0, 90.0, 1400.0), (-20.0, 40.0, 700.0)]);
        assert!(constant.starts_with("i_d is the same"), "{constant}");
    }
}

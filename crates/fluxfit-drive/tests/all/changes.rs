//! Parameters that change while the drive runs.

#![allow(clippy::unwrap_used)]

use fluxfit::{frames::Dq, motor::Motor, paper};
use fluxfit_drive::{
    Error, Scenario,
    scenario::{Mechanics, Modulation},
    schedule::{Profile, Ramp},
    simulate,
};

/// On a dynamometer at 100 rad/s with constant currents; rs rises by 20 % in the first half of a second, psi_f falls by 5 % and lq by
/// 17 % at 0.25 s.
fn scenario() -> Scenario {
    let mut scenario = Scenario { duration: 0.5, mechanics: Mechanics::Dyno, ..Scenario::paper() };
    scenario.inverter.modulation = Modulation::Averaged;
    scenario.schedule.speed = Profile::constant(100.0);
    scenario.schedule.load = Profile::default();
    (scenario.schedule.id, scenario.schedule.iq) = (Profile::constant(-2.0), Profile::constant(9.0));
    scenario.motor.changes[0] = Profile::new(vec![Ramp { at: 0.0, to: 0.2, over: 0.5 }]);
    scenario.motor.changes[2] = Profile::new(vec![Ramp { at: 0.25, to: -0.17, over: 0.0 }]);
    scenario.motor.changes[3] = Profile::new(vec![Ramp { at: 0.25, to: -0.05, over: 0.0 }]);
    scenario
}

/// After the transients, voltages are those of the steady equations with the changed parameters.
#[test]
fn the_drive_needs_the_voltages_of_the_changed_motor() {
    let Motor { rs, ld, lq, psi_f } = paper::MOTOR;
    let scenario = scenario();
    let columns = simulate(&scenario, 0, || ()).unwrap().columns;
    for (t, lq, psi_f) in [(0.2, lq, psi_f), (0.5, 0.83 * lq, 0.95 * psi_f)] {
        let row = columns.row((t / 1e-4_f64).round() as usize).unwrap();
        let motor = Motor { rs: rs * (1.0 + 0.4 * t), ld, lq, psi_f };
        let told = scenario.motor.parameters_at(t, 0.5).unwrap();
        assert!(motor.to_array().iter().zip(told.to_array()).all(|(value, told)| (value / told - 1.0).abs() < 1e-12), "{told:?}");
        let expected = motor.steady_voltage(Dq { d: -2.0, q: 9.0 }, row.omega_e);
        assert!((row.id + 2.0).hypot(row.iq - 9.0) < 1e-3, "{t}: {row:?}");
        // A voltage that stands still over a period turns in the rotor's frame, and the current bows under it: each makes (omega T)²/12.
        // The rest is the current that the controller lags behind the rising resistance, 2e-4 A on 5 ohm.
        let tolerance = (400.0_f64 * 1e-4).powi(2) / 6.0 * expected.d.hypot(expected.q) + 2e-4 * 5.0;
        assert!((row.ud - expected.d).hypot(row.uq - expected.q) < tolerance, "{t}: {row:?} {expected:?}");
    }
}

#[test]
fn impossible_changes_are_refused() {
    let mut gone = scenario();
    gone.motor.changes[1] = Profile::constant(-1.0);
    assert!(matches!(gone.check(), Err(Error::Setting { key: "changes.ld", .. })), "{:?}", gone.check());
    // The magnet grows beyond what the DC voltage can stand against.
    let mut strong = scenario();
    strong.motor.changes[3] = Profile::new(vec![Ramp { at: 0.1, to: 2.0, over: 0.0 }]);
    assert!(matches!(strong.check(), Err(Error::VoltageLimit { .. })), "{:?}", strong.check());
}

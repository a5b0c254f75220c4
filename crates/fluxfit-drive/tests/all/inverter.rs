//! The inverter against formulas: a rotor that stands still, so that each phase is a resistance and an inductance.

#![allow(clippy::unwrap_used, clippy::panic)]

use fluxfit_drive::{
    inverter::Bridge,
    plant::Plant,
    scenario::{Inverter, Magnetics, Mechanics, Modulation, SimulatedMotor, Update},
};
use std::f64::consts::TAU;

const RS: f64 = 0.8;
const L: f64 = 4e-3;
const U_DC: f64 = 40.0;
/// Samples per second, Hz.
const RATE: f64 = 1e4;

/// Without a magnet and without saliency: at standstill nothing but `R` and `L` in each phase, alpha along phase a.
fn coil() -> SimulatedMotor {
    SimulatedMotor::new(RS, Magnetics::Constant { ld: L, lq: L, psi_f: 0.0 }, 1)
}

fn inverter(modulation: Modulation) -> Inverter {
    Inverter { modulation, ..Inverter::ideal(U_DC, 0.5 * RATE) }
}

/// Runs some periods with the same duties; the plant's current afterwards, which at standstill at the angle zero is in the stator.
fn run(bridge: &mut Bridge, plant: &mut Plant, duties: [f64; 3], periods: std::ops::Range<usize>) {
    periods.for_each(|k| assert!(bridge.run(plant, duties, k as f64 / RATE)));
}

/// Mean output of a leg, V, whose current keeps its sign: out of the leg it takes the switch while high and the diode while low; into it,
/// the other two. Of every carrier period the dead time is lost against the current, unless the leg does not switch at all.
fn leg(duty: f64, out: f64, inverter: &Inverter) -> f64 {
    let lost = if duty == 0.0 || duty == 1.0 { 0.0 } else { inverter.dead_time * inverter.carrier };
    if out > 0.0 {
        let high = (duty - lost).max(0.0);
        high * (U_DC - inverter.switch_drop) - (1.0 - high) * inverter.diode_drop
    } else {
        let high = (duty + lost).min(1.0);
        high * (U_DC + inverter.diode_drop) + (1.0 - high) * inverter.switch_drop
    }
}

/// Out of phase a, back through b and c: alpha is two thirds of a's voltage less the mean of the others', and `R i` in the end.
#[test]
fn a_direct_current_tells_switches_from_diodes_and_what_dead_time_takes() {
    for modulation in [Modulation::Averaged, Modulation::Switched] {
        for (drops, dead_time, duties) in [
            ([1.0, 2.5], 0.0, [0.6, 0.45, 0.45]),
            ([2.5, 1.0], 0.0, [0.7, 0.3, 0.3]),
            ([0.0, 2.5], 0.0, [0.9, 0.6, 0.6]),
            ([1.0, 0.0], 0.0, [0.9, 0.6, 0.6]),
            ([0.0, 0.0], 5e-6, [0.6, 0.4, 0.4]),
            ([1.0, 2.5], 5e-6, [0.8, 0.4, 0.4]),
            // A leg that does not switch has no dead time.
            ([0.0, 0.0], 5e-6, [1.0, 0.6, 0.6]),
            ([0.0, 0.0], 5e-6, [0.4, 0.0, 0.0]),
            ([1.0, 2.5], 5e-6, [1.0, 0.0, 0.0]),
        ] {
            let inverter = Inverter { switch_drop: drops[0], diode_drop: drops[1], dead_time, ..inverter(modulation) };
            let motor = coil();
            let (mut plant, mut bridge) = (Plant::new(&motor, Mechanics::Dyno, 0.0), Bridge::new(inverter));
            // Fifty milliseconds are ten time constants.
            run(&mut bridge, &mut plant, duties, 0..500);
            let expected = 2.0 / 3.0 * (leg(duties[0], 1.0, &inverter) - leg(duties[1], -1.0, &inverter)) / RS;
            let found = plant.current();
            // The switched current ripples around its mean, and is sampled where the ripple passes it: up to its curvature.
            assert!((found.d - expected).abs() < 2e-3 * expected, "{modulation:?} {drops:?} {dead_time} {duties:?}: {found:?} {expected}");
            assert!(found.q.abs() < 1e-9);
        }
    }
}

/// A current that flows, then one period of other duties: an exponential towards `u / R`.
#[test]
fn an_averaged_leg_at_the_rails_loses_no_more_than_it_has() {
    let inverter = Inverter { dead_time: 5e-6, switch_drop: 1.0, diode_drop: 2.5, ..inverter(Modulation::Averaged) };
    let motor = coil();
    let (mut plant, mut bridge) = (Plant::new(&motor, Mechanics::Dyno, 0.0), Bridge::new(inverter));
    for (k, duties) in
        [[0.003, 0.5, 0.5], [0.5, 0.997, 0.997], [0.01, 0.99, 0.99], [0.5, 0.5, 0.5], [0.0, 1.0, 1.0]].into_iter().enumerate()
    {
        // Enough for more than ten amperes, which no single period turns round.
        run(&mut bridge, &mut plant, [0.9, 0.2, 0.2], 100 * k..100 * k + 99);
        let before = plant.current().d;
        assert!(before > 10.0);
        run(&mut bridge, &mut plant, duties, 100 * k + 99..100 * k + 100);
        let settled = 2.0 / 3.0 * (leg(duties[0], 1.0, &inverter) - leg(duties[1], -1.0, &inverter)) / RS;
        let expected = settled + (before - settled) * (-RS / L / RATE).exp();
        assert!((plant.current().d - expected).abs() < 1e-9, "{duties:?}: {} {expected}", plant.current().d);
    }
}

/// A DC voltage of `U + r sin(w t)` through constant duties onto `R` and `L`: the alternating current of the textbook.
#[test]
fn ripple_of_the_dc_voltage_reaches_the_motor_in_its_phase() {
    let (ripple, frequency) = (8.0, 300.0);
    for update in [Update::Single, Update::Double] {
        for modulation in [Modulation::Averaged, Modulation::Switched] {
            let carrier = if update == Update::Single { RATE } else { 0.5 * RATE };
            let inverter = Inverter { ripple, ripple_frequency: frequency, update, carrier, ..inverter(modulation) };
            let motor = coil();
            let (mut plant, mut bridge) = (Plant::new(&motor, Mechanics::Dyno, 0.0), Bridge::new(inverter));
            // Half of the DC voltage between a and the others: a third of it along alpha.
            let duties = [0.75, 0.25, 0.25];
            run(&mut bridge, &mut plant, duties, 0..600);
            let omega = TAU * frequency;
            let (impedance, lag) = (RS.hypot(omega * L), (omega * L).atan2(RS));
            for k in 600..700 {
                let expected = (U_DC / RS + ripple / impedance * (omega * k as f64 / RATE - lag).sin()) / 3.0;
                let off = plant.current().d - expected;
                // The alternating current is 0.35 A; half a sample of phase would be 0.03 A. Pulses sample the sine where they are.
                let allowed = if modulation == Modulation::Averaged { 2e-3 } else { 1e-2 };
                assert!(off.abs() < allowed, "{update:?} {modulation:?}, sample {k}: off by {off} A");
                run(&mut bridge, &mut plant, duties, k..k + 1);
            }
        }
    }
}

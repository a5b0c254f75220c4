//! scratch
use fluxfit::{
    frames::Dq,
    motor::Motor,
    objective::voltage_error::*,
    optimizer::{self, bounds::Bounds},
    study,
};
fn main() {
    let m = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
    let w = 1000.0 * std::f64::consts::TAU / 60.0 * 4.0;
    let modes = [(0.0, 10.0 / (6.0 * 0.1827)), (-2.0, 10.0 / (6.0 * (0.1827 + (5.25e-3 - 12e-3) * -2.0)))];
    let eq = modes.into_iter().flat_map(|(d, q)| {
        let i = Dq { d, q };
        let u = m.steady_voltage(i, w);
        (0..4000).flat_map(move |_| steady_equations([u.d, u.q], [d, q], w).map(|e| e.weighted(0.5)))
    });
    let o = VoltageError::of_equations(eq);
    let b = Bounds::new(vec![0.; 4], vec![5., 0.05, 0.05, 1.]).unwrap();
    for meth in [
        optimizer::Method::Apso(optimizer::apso::Apso { inertia_cost: optimizer::apso::InertiaCost::OwnBest, ..Default::default() }),
        optimizer::Method::Apso(Default::default()),
    ] {
        print!("{:6}", meth.label());
        for at in [50, 100, 200, 300] {
            let mut v: Vec<f64> = (1..=20)
                .map(|seed| {
                    study::run_method(meth, 50, optimizer::Settings { seed, ..Default::default() }, &b, &o, || {})
                        .unwrap()
                        .convergence
                        .quartiles[at][1]
                })
                .collect();
            v.sort_by(f64::total_cmp);
            print!("  {at}: {:.1e} {:.1e} {:.1e}", v[0], v[10], v[19]);
        }
        println!();
    }
}

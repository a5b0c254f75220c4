//! scratch
use fluxfit::{
    log::*,
    objective::voltage_error::*,
    optimizer::{self, bounds::Bounds},
    steady::windows,
    study,
};
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let s = std::fs::read_to_string(&f).unwrap();
    let mut l = s.lines();
    let h: Vec<&str> = l.next().unwrap().split(',').collect();
    let names = ["t", "ud", "uq", "id", "iq", "omega_e"];
    let ix = names.map(|n| h.iter().position(|c| *c == n).unwrap());
    let mut c: [Vec<f64>; 6] = Default::default();
    for r in l {
        let v: Vec<&str> = r.split(',').collect();
        for k in 0..6 {
            c[k].push(v[ix[k]].parse().unwrap());
        }
    }
    let [t, ud, uq, id, iq, omega_e] = c;
    let log = Log::new(Columns { t, ud, uq, id, iq, omega_e }).unwrap();
    let w = windows::at_most_paper_rows(&windows::find(&log).unwrap());
    let o = VoltageError::of_samples(&log, &w, IdZero::Measured);
    println!("{:?} {:?}", w, o.least_squares());
    let b = Bounds::new(vec![0.; 4], vec![5., 0.05, 0.05, 1.]).unwrap();
    for m in optimizer::Method::all() {
        let t = std::time::Instant::now();
        let s = study::run_method(m, 50, optimizer::Settings::default(), &b, &o, || {}).unwrap();
        let el = t.elapsed();
        let q = |i: usize| s.convergence.quartiles[i][1];
        println!(
            "{:6} {:.1e} {:.1e} {:.1e} {:.1e} worst {:.1e}  {:?} {:?}",
            m.label(),
            q(50),
            q(100),
            q(200),
            q(300),
            s.worst(),
            s.mean(),
            el
        );
    }
}

#![allow(missing_docs)]
use fluxfit::{objective::{acting_voltage::*, output_error::*}, motor::Motor, paper};
use fluxfit_files::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let map = a[2..].iter().map(|m| parse_map(m).unwrap()).collect();
    let log = read_log(std::path::Path::new(&a[1]), &LogOptions { map, ..Default::default() }).unwrap().log;
    for reading in VoltageReading::ALL {
        let oe = OutputError::of(&log, reading).unwrap();
        let t = Instant::now();
        let c = oe.cost(&paper::MOTOR);
        let dt = t.elapsed();
        let mut x = [1.1, 6e-3, 11e-3, 0.17];
        let mut cost = oe.cost(&Motor::from(x));
        let mut lambda = 1e-3;
        for _ in 0..60 {
            let r = oe.residuals(&Motor::from(x));
            let cols: Vec<Vec<f64>> = (0..4).map(|p| { let mut y = x; let h = 1e-6 * x[p]; y[p] += h; oe.residuals(&Motor::from(y)).iter().zip(&r).map(|(b, a)| (b - a) / h * x[p]).collect() }).collect();
            let mut n = [[0.0; 5]; 4];
            for i in 0..4 { for j in 0..4 { n[i][j] = cols[i].iter().zip(&cols[j]).map(|(a, b)| a * b).sum::<f64>(); } n[i][i] *= 1.0 + lambda; n[i][4] = -cols[i].iter().zip(&r).map(|(a, b)| a * b).sum::<f64>(); }
            for i in 0..4 { let p = n[i][i]; for j in i..5 { n[i][j] /= p; } for k in 0..4 { if k != i { let f = n[k][i]; for j in i..5 { n[k][j] -= f * n[i][j]; } } } }
            let y: [f64; 4] = std::array::from_fn(|p| x[p] * (1.0 + n[p][4]));
            let new = oe.cost(&Motor::from(y));
            if new < cost { let done = cost - new < 1e-14 * cost; x = y; cost = new; lambda *= 0.1; if done { break; } } else { lambda *= 10.0; if lambda > 1e6 { break; } }
        }
        let t = paper::MOTOR.to_array();
        println!("{reading:?}: at truth rms {:.3e} A, {:?}; best rms {:.4e} err % {:?}", (c / 2.0 / oe.rows() as f64).sqrt(), dt, (cost / 2.0 / oe.rows() as f64).sqrt(), [0, 1, 2, 3].map(|p| format!("{:.4}", 100.0 * (x[p] / t[p] - 1.0))));
    }
}

//! scratch
use fluxfit::{identify::*, log::*};
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let pp: f64 = std::env::args().nth(2).map_or(1.0, |s| s.parse().unwrap());
    let half = std::env::args().nth(3).is_some();
    let emrax = f.contains("emrax");
    let s = std::fs::read_to_string(&f).unwrap();
    let mut l = s.lines();
    let h: Vec<&str> = l.next().unwrap().split(',').collect();
    let names = if emrax {
        ["time_s", "motor_vd_V", "motor_vq_V", "motor_id_A", "motor_iq_A", "motor_velocity_rpm"]
    } else {
        ["t", "ud", "uq", "id", "iq", "omega_e"]
    };
    let ix = names.map(|n| h.iter().position(|c| *c == n).unwrap());
    let mut c: [Vec<f64>; 6] = Default::default();
    for r in l {
        let v: Vec<&str> = r.split(',').collect();
        for k in 0..6 {
            c[k].push(v[ix[k]].parse().unwrap());
        }
    }
    if emrax {
        for w in &mut c[5] {
            *w *= pp * std::f64::consts::TAU / 60.0;
        }
    }
    if half {
        let n = c[0].partition_point(|t| *t < 0.595);
        for x in &mut c {
            x.truncate(n);
        }
    }
    let [t, ud, uq, id, iq, omega_e] = c;
    let log = Log::new(Columns { t, ud, uq, id, iq, omega_e }).unwrap();
    println!("== {f} segments {} rows {}", log.segments().len(), log.rows());
    let r = identify(&log, &Settings::default()).unwrap();
    for (w, p) in r.operating_points.iter().enumerate() {
        println!(
            "{:5} {:8.3}..{:8.3} u {:8.3} {:8.3} i {:8.3} {:8.3} w {:9.3} drift {:7.2} {:7.2} dof {} se {:?} res {:.4?}",
            p.rows.len(),
            p.time.0,
            p.time.1,
            p.means[0],
            p.means[1],
            p.means[2],
            p.means[3],
            p.means[6],
            p.drift.d,
            p.drift.q,
            p.degrees_of_freedom,
            {
                let c = p.residual_covariance(&r.estimate.motor);
                [c[0][0].sqrt(), c[1][1].sqrt()]
            },
            r.estimate.residuals[w]
        );
    }
    for d in &r.excitation.directions {
        println!("{:.4?} snr {:.1} {}", d.components, d.signal_to_noise, d.excited);
    }
    let truth = [0.958, 5.25e-3, 12e-3, 0.1827];
    for (k, j) in r.parameters.iter().enumerate() {
        println!(
            "{:6} {:12.6e} err {:8.4}% stat {:.4}% sys {:?} half {:.3}% dof {:.1} sig {:.2} {:?} | {:?} | {:?}",
            j.parameter.key(),
            j.raw,
            100.0 * (j.raw / truth[k] - 1.0),
            100.0 * j.uncertainty.statistical / j.raw,
            {
                let s = j.uncertainty.systematic;
                [s.accuracy, s.timing, s.excitation, s.misfit].map(|x| (1e4 * x / j.raw * 100.0).round() / 1e4)
            },
            100.0 * j.uncertainty.half_width / j.raw,
            j.uncertainty.degrees_of_freedom,
            (j.raw - truth[k]) / j.uncertainty.standard_error(),
            j.verdict,
            j.reason,
            j.remedy
        );
    }
    println!("chi2 {} red {} {:?}", r.estimate.chi_squared, r.estimate.redundancy, r.warnings);
    println!("search {:?}", r.search.map(|s| (s.motor, s.cost_above_optimum)));
}

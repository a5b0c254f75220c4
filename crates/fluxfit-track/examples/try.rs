use fluxfit::log::Row;
use fluxfit_track::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let cols = args[2].clone();
    let truth = [0.958, 5.25e-3, 12e-3, 0.1827];
    let timing = match args[3].as_str() { "auto" => None, "c" => Some(Timing::Centered), d => Some(Timing::Delayed{delay: d.parse().unwrap(), at_row:false}) };
    let start = if args[4]=="none" { Start::default() } else { Start{ values:[Some(truth[0]*0.7),Some(truth[1]*1.4),Some(truth[2]*0.75),Some(truth[3]*0.88)], rating: Some([10.0, 400.0]), ..Start::default()} };
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |n: &str| header.iter().position(|h| *h == n).unwrap();
    let names: Vec<usize> = if cols=="ref" { vec!["t","ud_ref","uq_ref","id","iq","omega_e"] } else { vec!["t","ud","uq","id","iq","omega_e"] }.into_iter().map(at).collect();
    let rows: Vec<Row> = lines.map(|l| { let v: Vec<f64> = l.split(',').map(|x| x.parse().unwrap()).collect();
        Row{ t:v[names[0]], ud:v[names[1]], uq:v[names[2]], id:v[names[3]], iq:v[names[4]], omega_e:v[names[5]], ..Row::default()} }).collect();
    for method in Method::ALL {
        let mut tr = Tracker::new(TrackSettings{ method, timing, start });
        let begun = std::time::Instant::now();
        let mut settled=0.0;
        for (k,row) in rows.iter().enumerate() { tr.push(row);
            if args.len()>5 && k%500==499 { if let Some(p)=tr.parameters() { println!("{:.4} {:?} {}", row.t, p.map(|p| p.value.map(|v| (v*1e6).round()/1e6)), p.map(|p| p.verdict.to_string()).join(" | ")); } }
            if let Some(e)=tr.estimator() { let e=e.estimate(); if (0..4).any(|j| (e.values[j]/truth[j]-1.0).abs()>0.05) { settled=row.t } }
        }
        let ns = begun.elapsed().as_nanos() as f64/rows.len() as f64;
        let e = tr.estimator().unwrap().estimate();
        let err: Vec<String> = (0..4).map(|j| format!("{:8.3} ±{:.3}", 100.0*(e.values[j]/truth[j]-1.0), 196.0*e.standard_errors.map_or(f64::NAN, |s| s[j])/truth[j])).collect();
        println!("{:14} {:?} {} ns settle {settled:.3} {}", method.key(), tr.timing(), ns as i64, err.join(" "));
        println!("   {}", tr.parameters().unwrap().map(|p| p.verdict.to_string()).join(" | "));
        if let Some(Estimator::Ekf(f)) = tr.estimator() { println!("   noise {:.5} steps {} outliers {} restarts {} level {}", f.filter().noise().sqrt(), f.filter().steps(), f.filter().outliers(), f.restarts(), f.filter().settings().unknown_voltage); }
    }
}

//! The tables of docs/swarms.md, in Markdown.

use super::{
    invariance::Sensitivity,
    on_bbob::{BbobRun, EXACT, ROUGH, expected_running_time, share_reached, solved},
};
use crate::bbob::FUNCTIONS;
use fluxfit::{
    optimizer::{METHODS, Method},
    study::{MethodStudy, comparison::Comparison},
};
use fluxfit_units::{significant, small};
use std::fmt::Write;

/// All that is known of all methods, in the order of [`METHODS`].
pub struct Results {
    /// Fitness (11) on a log without noise, and on one with noise.
    pub ideal: Comparison,
    /// The same with noise.
    pub noisy: Comparison,
    /// The output error on the log with noise.
    pub output_error: Comparison,
    /// The runs on BBOB.
    pub bbob: Vec<Vec<BbobRun>>,
    /// What changes their runs.
    pub sensitivity: Vec<Sensitivity>,
    /// Medians on spheres: optimum in the origin, in the centre only, anywhere.
    pub spheres: Vec<[f64; 3]>,
}

/// Evaluations at which the share of targets is told, beside that at the end.
const EARLY: u64 = 1500;

/// Costs on a sphere below this are all the same: squares of roundings of its coordinates.
const NOTHING: f64 = 1e-30;

/// A run on a sphere that ends so much closer where the optimum is the origin is drawn to it.
const DRAWN: f64 = 1e3;

impl Results {
    /// Mean of a method's ranks on fitness (11) with noise, on the output error, and on BBOB.
    fn mean_rank(&self, method: usize) -> f64 {
        let of = |ranking: Vec<usize>| ranking.iter().position(|place| *place == method).unwrap_or(METHODS.len()) as f64 + 1.0;
        let on_bbob = {
            let share = |k: &usize| share_reached(&self.bbob[*k], u64::MAX);
            let mut places: Vec<usize> = (0..METHODS.len()).collect();
            places.sort_by(|a, b| share(b).total_cmp(&share(a)));
            places
        };
        (of(self.noisy.ranking()) + of(self.output_error.ranking()) + of(on_bbob)) / 3.0
    }

    /// The table of the page.
    pub fn table(&self) -> String {
        let problems = self.bbob.first().map_or(0, Vec::len);
        let mut text = format!(
            "| method | key | (11), no noise | (11), noise: runs within it, % | evaluations to it | output error: runs within the noise, % | \
             evaluations to it | BBOB, 1e-1 of {problems} | 1e-8 | evaluations per solved | targets after {EARLY}, % | at the end, % | mean rank |\n\
             |---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
        );
        let mut places: Vec<usize> = (0..METHODS.len()).collect();
        places.sort_by(|a, b| self.mean_rank(*a).total_cmp(&self.mean_rank(*b)));
        for k in places {
            let method = METHODS[k].default;
            let runs = &self.bbob[k];
            let within = |comparison: &Comparison, study: &MethodStudy| {
                let to = comparison.evaluations_to_noise(study).map_or_else(|| "-".to_owned(), |evaluations| evaluations.to_string());
                format!("{:.0} | {to}", 100.0 * study.share_within(comparison.problem.noise()))
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "| {} | `{}` | {} | {} | {} | {} | {} | {} | {:.0} | {:.0} | {:.1} |",
                method.short_label().replace('*', "\\*"),
                method.key(),
                small(self.ideal.studies[k].median()),
                within(&self.noisy, &self.noisy.studies[k]),
                within(&self.output_error, &self.output_error.studies[k]),
                solved(runs, ROUGH),
                solved(runs, EXACT),
                time(expected_running_time(runs, EXACT)),
                100.0 * share_reached(runs, EARLY),
                100.0 * share_reached(runs, u64::MAX),
                self.mean_rank(k),
            );
        }
        text
    }

    /// Which methods' runs change with what, in sentences.
    pub fn sensitive(&self) -> String {
        let names = |is: &dyn Fn(usize) -> bool| {
            let names: Vec<&str> = (0..METHODS.len()).filter(|k| is(*k)).map(|k| METHODS[k].key).collect();
            if names.is_empty() { "none".to_owned() } else { names.join(", ") }
        };
        let closer = |k: usize| self.spheres[k][1].max(NOTHING) / self.spheres[k][0].max(NOTHING);
        let turned = |k: usize| {
            let solved_of = |function: u64| solved(self.bbob[k].iter().filter(|run| run.function == function), EXACT);
            let along = solved_of(2) + solved_of(3);
            along > 2 * (solved_of(10) + solved_of(15)) && along > 2
        };
        format!(
            "- The run changes when box and function are shifted: {}.\n- when the units of the coordinates change: {}.\n- when a constant is \
             added to the cost: {}.\n- On a sphere of ten dimensions the run ends more than {DRAWN} times closer if the centre of the box, where the optimum is, is the origin: {}.\n\
             - Solves the ellipsoid and Rastrigin's function along the axes (f2, f3) more than twice as often as turned (f10, f15): {}.\n",
            names(&|k| self.sensitivity[k].shift),
            names(&|k| self.sensitivity[k].scale),
            names(&|k| self.sensitivity[k].offset),
            names(&|k| closer(k) > DRAWN),
            names(&turned),
        )
    }

    /// Medians on the spheres.
    pub fn spheres(&self) -> String {
        let mut text = "| method | optimum in the origin | in the centre of 0 .. 10 | anywhere |\n|---|--:|--:|--:|\n".to_owned();
        for (facts, [origin, centre, anywhere]) in METHODS.iter().zip(&self.spheres) {
            let _ = writeln!(text, "| {} | {} | {} | {} |", facts.key, small(*origin), small(*centre), small(*anywhere));
        }
        text
    }

    /// Expected running times to the last target, of each function and dimension: the three least, and tGFPA's.
    pub fn running_times(&self, dimension: usize) -> String {
        let mut text = format!("| function, {dimension} dimensions | least | second | third | tGFPA |\n|---|---|---|---|---|\n");
        for function in 1..=FUNCTIONS {
            let of = |k: usize| {
                let runs = self.bbob[k].iter().filter(|run| run.function == function && run.dimension == dimension);
                expected_running_time(runs, EXACT)
            };
            let mut times: Vec<(f64, Method)> = METHODS.iter().enumerate().filter_map(|(k, facts)| Some((of(k)?, facts.default))).collect();
            times.sort_by(|a, b| a.0.total_cmp(&b.0));
            let cell = |place: usize| {
                times.get(place).map_or_else(|| "-".to_owned(), |(t, method)| format!("{} {}", method.key(), time(Some(*t))))
            };
            let _ = writeln!(text, "| f{function} | {} | {} | {} | {} |", cell(0), cell(1), cell(2), time(of(0)));
        }
        text
    }
}

/// Evaluations.
fn time(evaluations: Option<f64>) -> String {
    evaluations.map_or_else(|| "-".to_owned(), |evaluations| significant(evaluations, 3))
}

//! A study: the paper's Table 2, the ranking by cost above the minimum, and its Fig. 4 in characters.

use crate::terminal::{self, DIM, HEADING, plot, table, wrapped};
use fluxfit::study::comparison::Comparison;
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::Method,
    study::{MethodStudy, error_percent, fitness::Fitness},
};
use fluxfit_units::{Scale, significant, small};

/// Shows a study.
pub(crate) fn show(name: &str, facts: &Comparison, methods: &[(MethodStudy, f64)]) -> std::io::Result<()> {
    let fitness = &facts.problem.fitness;
    let (minimum, index) = (fitness.minimum_label(), fitness.minimum_subscript());
    let rows: Vec<String> = facts.problem.rows.iter().map(ToString::to_string).collect();
    let reading = fitness.voltage_timing().map(|reading| format!(", voltages read as {reading}")).unwrap_or_default();
    let asked = format!(
        "{} on {} rows{reading}; {} runs of each method, population {}, {} iterations, seed {}",
        fitness.label(),
        rows.join(" + "),
        facts.runs,
        facts.settings.population,
        facts.settings.iterations,
        facts.settings.seed,
    );
    let mut text =
        format!("{HEADING}{name}{HEADING:#}\n{}{}", wrapped("", &asked), wrapped("", &format!("search box {}", search_box(facts))));
    if methods.is_empty() {
        return terminal::print(&text);
    }
    let estimates = if facts.is_crowded() { estimates(facts, methods) } else { table_2(facts, methods) };
    text += &format!("\n{HEADING}{}{HEADING:#} (Table 2 of the paper)\n{estimates}", title_of_estimates(facts));
    let cost = format!(
        "{HEADING}Cost above the {minimum}{HEADING:#}, F - F_{index}, {}, the best first; F_{index} = {}; within the noise of the data: at most {}",
        fitness.unit(),
        small(fitness.minimum().1),
        small(facts.problem.noise()),
    );
    text += &format!("\n{}{}", wrapped("", &cost), ranking(facts, methods));
    let curves = if facts.is_crowded() { plot::courses_of_methods(&ranked(facts, methods)) } else { plot::convergence(methods) };
    text += &format!("\n{HEADING}Convergence{HEADING:#} of the median F - F_{index} (Fig. 4 of the paper)\n{curves}");
    if methods.iter().any(|(study, _)| study.method.short_label() != study.method.label()) {
        text += "* after a work that the paper cites, reconstructed from its abstract\n";
    }
    text += &format!("\n{DIM}{}{DIM:#}\n", wrapped("", remark(fitness)).trim_end());
    terminal::print(&text)
}

/// The methods, the best first.
fn ranked<'a>(facts: &Comparison, methods: &'a [(MethodStudy, f64)]) -> Vec<&'a (MethodStudy, f64)> {
    facts.ranking().into_iter().filter_map(|place| methods.get(place)).collect()
}

/// Prints how many runs an interrupted study has finished.
pub(crate) fn interrupted(comparison: &Comparison) {
    let of = |method: &Method| {
        let finished = comparison.studies.iter().find(|study| study.method == *method).map_or(0, |study| study.motors.len());
        format!("{} {finished}", method.label())
    };
    let finished: Vec<String> = comparison.asked.iter().map(of).collect();
    terminal::warn_of(
        "interrupted",
        &format!("of {} runs of each method these are finished: {}; a report is not written", comparison.runs, finished.join(", ")),
    );
}

/// What the minimum is.
fn remark(fitness: &Fitness) -> &'static str {
    match fitness {
        Fitness::VoltageError(_) => {
            "Fitness (11) is linear least squares: its minimum is exact and costs microseconds. The swarms approach the same answer."
        }
        Fitness::OutputError { minimum, .. } if minimum.converged => {
            "The output error simulates the currents. Its minimum is the lowest that a Levenberg-Marquardt polish has found, in some tens of evaluations."
        }
        Fitness::OutputError { .. } => {
            "The output error simulates the currents. Its Levenberg-Marquardt polish did not converge: F_LM is the lowest cost found, and may be no minimum."
        }
    }
}

fn search_box(facts: &Comparison) -> String {
    let intervals = Parameter::ALL.into_iter().zip(facts.bounds.iter()).map(|(parameter, (lower, upper))| {
        let scale = Scale::for_value(parameter, upper);
        let short = |value: f64| significant_or_zero(value, &scale);
        format!("{} {}..{} {}", parameter.symbol(), short(lower), short(upper), scale.unit(parameter.unit()))
    });
    intervals.collect::<Vec<_>>().join(", ")
}

fn significant_or_zero(value: f64, scale: &Scale) -> String {
    if value == 0.0 { "0".to_owned() } else { scale.format(value, value.abs() * 0.05) }
}

/// Rows as the paper has them: a parameter's estimates, then their errors where the truth is known.
fn table_2(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> String {
    let (lowest, _) = facts.problem.fitness.minimum();
    let mut rows = Vec::new();
    for parameter in Parameter::ALL {
        let scale = Scale::for_value(parameter, facts.truth.as_ref().unwrap_or(&lowest).get(parameter));
        let estimate = |motor: &Motor| {
            let value = motor.get(parameter);
            scale.format(value, value.abs() * 2e-5)
        };
        let mut row = vec![format!("{} {}", parameter.symbol(), scale.unit(parameter.unit()))];
        row.extend(methods.iter().map(|(study, _)| estimate(&study.mean())));
        row.push(estimate(&lowest));
        rows.push(row);
        if let Some(truth) = &facts.truth {
            let mut row = vec!["error %".to_owned()];
            row.extend(methods.iter().map(|(study, _)| percent(study.mean_error_percent(truth)[parameter as usize])));
            row.push(percent(error_percent(&lowest, truth, parameter)));
            rows.push(row);
        }
    }
    let labels = methods.iter().map(|(study, _)| study.method.label());
    let heading: Vec<&str> = [""].into_iter().chain(labels).chain([facts.problem.fitness.solver()]).collect();
    table(&heading, 1, rows)
}

/// An error, where there is one.
fn percent(error: Option<f64>) -> String {
    error.map_or_else(|| "-".to_owned(), |error| significant(error, 3))
}

/// What the table of the estimates shows.
fn title_of_estimates(facts: &Comparison) -> &'static str {
    match facts.truth {
        Some(_) if facts.is_crowded() => "Mean error of the runs' estimates, %",
        _ => "Mean of the runs' estimates",
    }
}

/// A row for each of many methods: its estimates, or their errors where the truth is known.
fn estimates(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> String {
    let (lowest, _) = facts.problem.fitness.minimum();
    let scales = Parameter::ALL.map(|parameter| Scale::for_value(parameter, lowest.get(parameter)));
    let row = |name: String, mean: &Motor, errors: &dyn Fn(Parameter) -> Option<f64>| {
        let cell = |(parameter, scale): (Parameter, &Scale)| match facts.truth {
            Some(_) => percent(errors(parameter)),
            None => scale.format(mean.get(parameter), mean.get(parameter).abs() * 2e-5),
        };
        [name].into_iter().chain(Parameter::ALL.into_iter().zip(&scales).map(cell)).collect::<Vec<String>>()
    };
    let error = |motor: &Motor, parameter: Parameter| error_percent(motor, facts.truth.as_ref()?, parameter);
    let mut rows = vec![row(facts.problem.fitness.solver().to_owned(), &lowest, &|parameter| error(&lowest, parameter))];
    rows.extend(ranked(facts, methods).into_iter().map(|(study, _)| {
        let errors = facts.truth.as_ref().map(|truth| study.mean_error_percent(truth));
        row(study.method.short_label(), &study.mean(), &|parameter| errors.and_then(|errors| errors[parameter as usize]))
    }));
    let of = |(parameter, scale): (Parameter, &Scale)| match facts.truth {
        Some(_) => parameter.symbol().to_owned(),
        None => format!("{}\n{}", parameter.symbol(), scale.unit(parameter.unit())),
    };
    let titles: Vec<String> = Parameter::ALL.into_iter().zip(&scales).map(of).collect();
    let heading: Vec<&str> = [""].into_iter().chain(titles.iter().map(String::as_str)).collect();
    table(&heading, 1, rows)
}

/// The ranking: the median after a third of the iterations and at the end; the worst run; how many runs end within the noise of the
/// data; how soon the median is there.
fn ranking(facts: &Comparison, methods: &[(MethodStudy, f64)]) -> String {
    let last = methods.iter().map(|(study, _)| study.convergence.quartiles.len()).max().unwrap_or(1) - 1;
    let noise = facts.problem.noise();
    let rows = ranked(facts, methods).into_iter().map(|(study, seconds)| {
        let quartiles = &study.convergence.quartiles;
        let at_third = quartiles.get(last / 3).or(quartiles.last()).map_or(0.0, |quartiles| quartiles[1]);
        vec![
            study.method.short_label(),
            small(at_third),
            small(study.median()),
            small(study.worst()),
            format!("{:.0} %", 100.0 * study.share_within(noise)),
            facts.evaluations_to_noise(study).map_or_else(|| "-".to_owned(), |evaluations| evaluations.to_string()),
            study.evaluations_per_run.to_string(),
            significant(1e3 * seconds, 2),
        ]
    });
    let third = format!("iteration\n{}", last / 3);
    let heading = ["", &third, "median\nat end", "worst\nrun", "within\nnoise", "evals to\nnoise", "evals", "ms per\nrun"];
    table(&heading, 1, rows)
}

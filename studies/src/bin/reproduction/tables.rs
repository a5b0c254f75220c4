//! Tables in Markdown.

use crate::experiments::Data;
use fluxfit::{
    motor::{Motor, Parameter},
    optimizer::SearchSettings,
    paper,
    study::{MethodStudy, error_percent},
};
use fluxfit_units::{significant, small};
use std::error::Error;

/// Iterations at which costs are shown.
const MILESTONES: [usize; 4] = [50, 100, 200, 300];
/// Iteration limits at which a search is cut short.
const CUT_SHORT: [usize; 6] = [25, 50, 75, 100, 150, 300];

/// The paper's digits: R_s and psi_f in SI, inductances in mH.
fn estimate(motor: &Motor, parameter: Parameter) -> String {
    let value = motor.get(parameter);
    match parameter {
        Parameter::Rs => format!("{value:.4}"),
        Parameter::Ld | Parameter::Lq => format!("{:.3}", 1e3 * value),
        Parameter::PsiF => format!("{value:.5}"),
    }
}

fn unit(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Ld | Parameter::Lq => "mH",
        _ => parameter.unit(),
    }
}

fn table(heading: &[String], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut text = line(heading);
    text += &line(&heading.iter().enumerate().map(|(k, _)| if k == 0 { "---" } else { "--:" }.to_owned()).collect::<Vec<_>>());
    rows.into_iter().for_each(|row| text += &line(&row));
    text
}

fn percent(error: Option<f64>) -> String {
    error.map_or_else(|| "-".to_owned(), |error| significant(error, 2))
}

/// Ours beside the paper's: means, and errors in percent.
pub(crate) fn table_2(study: &[MethodStudy], data: &Data) -> String {
    let (exact, _) = data.problem.fitness.minimum();
    let mut heading = vec![String::new()];
    for study in study {
        heading.extend([format!("{} here", study.method.label()), "in the paper".to_owned()]);
    }
    heading.push("least squares".to_owned());
    let theirs = |study: &MethodStudy| paper::TABLE_2.iter().find(|column| column.method == study.method.key());
    let rows = Parameter::ALL.into_iter().flat_map(|parameter| {
        let mut means = vec![format!("{}, {}", parameter.symbol(), unit(parameter))];
        let mut errors = vec!["error, %".to_owned()];
        for study in study {
            means.push(estimate(&study.mean(), parameter));
            means.push(theirs(study).map_or_else(String::new, |column| estimate(&column.mean, parameter)));
            errors.push(percent(study.mean_error_percent(&paper::MOTOR)[parameter as usize]));
            errors.push(theirs(study).map_or_else(String::new, |column| column.error_percent[parameter as usize].to_string()));
        }
        means.push(estimate(&exact, parameter));
        errors.push(percent(error_percent(&exact, &paper::MOTOR, parameter)));
        [means, errors]
    });
    table(&heading, rows)
}

/// Mean errors on all rigs, percent.
pub(crate) fn errors(data: &[Data], studies: &[Vec<MethodStudy>]) -> String {
    let labels = studies[0].iter().map(|study| study.method.label().to_owned());
    let heading: Vec<String> =
        ["mean error, %".to_owned(), String::new()].into_iter().chain(labels).chain(["least squares".to_owned()]).collect();
    let rows = data.iter().zip(studies).flat_map(|(data, study)| {
        let (exact, _) = data.problem.fitness.minimum();
        Parameter::ALL.map(|parameter| {
            let mut row = vec![data.rig.label().to_owned(), parameter.symbol().to_owned()];
            row.extend(study.iter().map(|study| percent(study.mean_error_percent(&paper::MOTOR)[parameter as usize])));
            row.push(percent(error_percent(&exact, &paper::MOTOR, parameter)));
            row
        })
    });
    table(&heading, rows)
}

/// `F - F_LS`: medians over the runs, and the worst end.
pub(crate) fn ranking<'a>(studies: impl IntoIterator<Item = (String, &'a MethodStudy)>) -> String {
    let mut heading = vec!["median F - F_LS".to_owned()];
    heading.extend(MILESTONES.map(|iteration| format!("iteration {iteration}")));
    heading.push("worst run".to_owned());
    let rows = studies.into_iter().map(|(name, study)| {
        let mut row = vec![name];
        row.extend(MILESTONES.map(|iteration| small(study.convergence.quartiles[iteration][1])));
        row.push(small(study.worst()));
        row
    });
    table(&heading, rows)
}

/// Ends of many runs.
pub(crate) fn many_runs(studies: &[MethodStudy]) -> String {
    let heading = ["F - F_LS at the end", "median", "worst run", "runs above 1", "of"].map(str::to_owned);
    let rows = studies.iter().map(|study| {
        let astray = study.cost_above_optimum.iter().filter(|cost| **cost > 1.0).count();
        vec![
            study.method.label().to_owned(),
            small(study.median()),
            small(study.worst()),
            astray.to_string(),
            study.cost_above_optimum.len().to_string(),
        ]
    });
    table(&heading, rows)
}

/// Mean errors of searches that are cut short, percent; beside the paper's.
pub(crate) fn unconverged(data: &Data) -> Result<String, Box<dyn Error>> {
    let mut heading = vec!["mean error, %".to_owned(), String::new()];
    heading.extend(CUT_SHORT.map(|iterations| format!("{iterations} iterations")));
    heading.push("in the paper".to_owned());
    let studies = CUT_SHORT
        .map(|iterations| data.study_with(&paper::METHODS, paper::RUNS, SearchSettings { iterations, ..SearchSettings::default() }));
    let studies = studies.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut rows = Vec::new();
    for (index, method) in paper::METHODS.iter().enumerate() {
        for parameter in Parameter::ALL {
            let mut row = vec![method.label().to_owned(), parameter.symbol().to_owned()];
            row.extend(studies.iter().map(|study| percent(study[index].mean_error_percent(&paper::MOTOR)[parameter as usize])));
            row.push(paper::TABLE_2[index].error_percent[parameter as usize].to_string());
            rows.push(row);
        }
    }
    Ok(table(&heading, rows))
}

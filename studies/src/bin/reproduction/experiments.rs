//! What is simulated and what is run: the rig three ways, the paper's methods, and the methods with one choice changed.

use fluxfit::{
    Log, Request,
    motor::PARAMETERS,
    objective::voltage_error::IdZero,
    optimizer::{
        Bounds, Method, SearchSettings,
        methods::{
            fpa::{Fpa, LocalBase},
            tgfpa::{Start, Tgfpa},
        },
    },
    paper,
    study::{MethodStudy, fitness::StudyProblem, run_method},
};
use fluxfit_drive::{
    Scenario,
    scenario::{Adc, Modulation},
    simulate,
};
use std::{error::Error, ops::ControlFlow};

/// Current noise and converter of the noisy rig: 0.5 % of 10 A, 12 bits over 20 A.
const NOISE: f64 = 0.05;
const ADC: Adc = Adc { bits: 12, range: 20.0 };

/// The paper's rig, three ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rig {
    /// Averaged inverter.
    Averaged,
    /// Switched inverter.
    Switched,
    /// Switched inverter, noisy currents.
    Noisy,
}

/// What one of them logged.
pub(crate) struct Data {
    pub(crate) rig: Rig,
    pub(crate) log: Log,
    pub(crate) problem: StudyProblem,
}

impl Rig {
    /// In the order of their discriminants.
    pub(crate) const ALL: [Self; 3] = [Self::Averaged, Self::Switched, Self::Noisy];

    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Averaged => "averaged inverter, no noise",
            Self::Switched => "switched inverter, no noise",
            Self::Noisy => "switched inverter, 0.5 % noise, 12-bit ADC",
        }
    }
}

impl Data {
    pub(crate) fn simulate(rig: Rig) -> Result<Self, Box<dyn Error>> {
        let mut scenario = Scenario::paper();
        match rig {
            Rig::Averaged => scenario.inverter.modulation = Modulation::Averaged,
            Rig::Switched => {}
            Rig::Noisy => (scenario.sensors.current_noise, scenario.sensors.adc) = (NOISE, Some(ADC)),
        }
        let log = simulate(&scenario, 0, || ())?.log()?;
        let problem = StudyProblem::steady(&log, &Request::default(), IdZero::Measured)?;
        Ok(Self { rig, log, problem })
    }

    /// The paper's number of runs of each method.
    pub(crate) fn study(&self, methods: &[Method]) -> Result<Vec<MethodStudy>, Box<dyn Error>> {
        self.study_with(methods, paper::RUNS, SearchSettings::default())
    }

    pub(crate) fn study_with(&self, methods: &[Method], runs: usize, settings: SearchSettings) -> Result<Vec<MethodStudy>, Box<dyn Error>> {
        let bounds = search_box()?;
        let run = |method: &Method| run_method(*method, runs, settings, &bounds, &self.problem.fitness, || ControlFlow::Continue(()));
        Ok(methods.iter().filter_map(|method| run(method).transpose()).collect::<Result<_, _>>()?)
    }
}

/// The search box of the paper's motor.
pub(crate) fn search_box() -> Result<Bounds, Box<dyn Error>> {
    Ok(Bounds::new(vec![0.0; PARAMETERS], paper::SEARCH_BOX.to_vec())?)
}

/// Methods with one choice changed.
pub(crate) fn ablation() -> Vec<(String, Method)> {
    let tgfpa = |name: &str, change: fn(&mut Tgfpa)| {
        let mut settings = Tgfpa::default();
        change(&mut settings);
        (name.to_owned(), Method::Tgfpa(settings))
    };
    let fpa = |name: &str, change: fn(&mut Fpa)| {
        let mut settings = Fpa::default();
        change(&mut settings);
        (name.to_owned(), Method::Fpa(settings))
    };
    vec![
        tgfpa("tGFPA", |_| ()),
        tgfpa("uniform start instead of the logistic map", |s| s.start = Start::Uniform),
        tgfpa("without the t perturbation (m = 1)", |s| s.plain_global = 1.0),
        tgfpa("without the Gaussian perturbation (q = 1)", |s| s.plain_local = 1.0),
        tgfpa("perturbing half of the moves (m = q = 0.5)", |s| (s.plain_global, s.plain_local) = (0.5, 0.5)),
        tgfpa("p = 0.2 (80 % global)", |s| s.pollination.switch_probability = 0.2),
        tgfpa("p = 0.95 (5 % global)", |s| s.pollination.switch_probability = 0.95),
        tgfpa("gamma = 0.01", |s| s.pollination.gamma = 0.01),
        tgfpa("local moves from the last trial", |s| s.pollination.local_base = LocalBase::LastTrial),
        fpa("FPA", |_| ()),
        fpa("FPA, p = 0.2 (80 % global)", |s| s.switch_probability = 0.2),
        fpa("FPA, gamma = 0.01", |s| s.gamma = 0.01),
        fpa("FPA, local moves from the last trial", |s| s.local_base = LocalBase::LastTrial),
    ]
}

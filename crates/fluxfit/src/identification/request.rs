//! What is asked of an identification.

use super::{
    nameplate::Nameplate,
    prepare::{model::Model, search_box},
};
use crate::{
    error::{Error, ErrorKind, has_zero},
    motor::{PARAMETERS, Parameter},
    objective::acting_voltage::VoltageTiming,
    optimizer::{Bounds, Method, SearchSettings},
    steady::windows::TimeWindow,
};

/// Systematic uncertainty of the voltages, as a fraction of their vector, unless stated otherwise: no drive's are known better.
pub const VOLTAGE_ACCURACY: f64 = 1e-4;

/// Largest magnitude of a magnet's coefficient, 1/K: twice that of ferrites (-0.002), the largest of usual magnets; and no flux reverses
/// within the temperatures that a log may have.
const LARGEST_COEFFICIENT: f64 = 4e-3;

/// What is asked of an identification. The default asks for the four parameters, with everything found from the log.
///
/// ```
/// use fluxfit::{Known, Parameter, Request};
///
/// // R_s was measured at the terminals, to 2 %; gains are wanted for a bandwidth of 500 Hz.
/// let rs = Known::Prior { value: 0.0352, standard_error: 0.02 * 0.0352 };
/// let request = Request { bandwidth: Some(500.0), ..Request::default() }.with_known(Parameter::Rs, rs);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The model that answers; `None`: the one that [suits](crate::evidence::choose_model) the log.
    pub model: Option<Model>,
    /// The parts of the log to use. Empty: the steady model finds its
    /// operating points, and the output error uses every segment (pieces of it, where the log is very long).
    pub windows: Vec<TimeWindow>,
    /// When, relative to its row, a logged voltage acts. `None`: the output error finds it; the steady model takes the voltages as
    /// centred on the row and counts the doubt as systematic uncertainty.
    pub voltage_timing: Option<VoltageTiming>,
    /// Systematic uncertainty of the voltages as a fraction of the vector, one standard deviation, independent between windows and axes.
    pub voltage_accuracy: f64,
    /// Largest error of a gain common to all current sensors, as a fraction, to either side: the limit of a data sheet. It is taken as half
    /// of a 95 % interval (two standard deviations, unlike `voltage_accuracy`) and widens the intervals. `None`: it is not counted.
    pub current_accuracy: Option<f64>,
    /// The same of the DC voltage's measurement, and with it of all voltages that the drive computes.
    pub bus_accuracy: Option<f64>,
    /// By which part of itself at 20 degC the magnets' flux changes per kelvin, below zero for all usual magnets: -0.0012 of NdFeB. With it
    /// and a logged [temperature](crate::Columns::temperature) psi_f is also told at 20 degC.
    pub magnet_coefficient: Option<f64>,
    /// What is known of each parameter beforehand, in the order of [`Parameter::ALL`](crate::motor::Parameter::ALL);
    /// [`with_known`](Self::with_known) sets one.
    pub known: [Known; PARAMETERS],
    /// Which swarm optimizer searches for the same minimum, for comparison. The answer never comes from it.
    pub swarm: Swarm,
    /// Settings of that search.
    pub search: SearchSettings,
    /// Lower and upper bound of that search for each parameter, SI; `None`: from the log and the rating. They do not bound the answer.
    pub bounds: [Option<(f64, f64)>; PARAMETERS],
    /// The data sheet's values: compared with the answer, which does not depend on them. What the answer should use is
    /// [`known`](Request::known).
    pub nameplate: Nameplate,
    /// Wanted bandwidth of the current controllers, Hz; `None`: no gains are computed.
    pub bandwidth: Option<f64>,
    /// How often the drive's current controllers run, Hz; `None`: as often as the log's rows come. Only for `bandwidth`.
    pub control_rate: Option<f64>,
    /// Whether the last of [joined](crate::Log::join) logs, or the last segment of a single log, is left out of the identification and
    /// then predicted by the answer.
    pub hold_out: bool,
}

/// What is known of one parameter before the log is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Known {
    /// Nothing.
    #[default]
    Nothing,
    /// Its value, SI, taken as exact; above zero, or zero for a resistance or a flux. Its verdict is then
    /// [`Verdict::Identified`](crate::Verdict::Identified), its reason [`Reason::Given`](crate::Reason::Given).
    Fixed(f64),
    /// A value with a standard error: one more measurement, weighed against the log. Its contribution to each interval is
    /// [`Systematic::prior`](crate::evidence::Systematic::prior).
    Prior {
        /// Value, SI; in the same range.
        value: f64,
        /// Standard error (one standard deviation), SI, not a fraction of the value.
        standard_error: f64,
    },
}

/// Which swarm optimizer searches beside the answer by least squares.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Swarm {
    /// tGFPA at operating points, where it takes a millisecond; none on the output error, where it takes seconds.
    #[default]
    Auto,
    /// None.
    Off,
    /// This method.
    Method(Method),
}

/// Where a choice comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Provenance {
    /// The request states it.
    Stated,
    /// The log shows it.
    Found,
    /// It is assumed, and the doubt counted as uncertainty.
    Assumed,
}

/// A setting as it was used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolved<T> {
    /// Its value.
    pub value: T,
    /// Where the value comes from.
    pub provenance: Provenance,
}

impl Provenance {
    /// Name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Stated => "stated",
            Self::Found => "found",
            Self::Assumed => "assumed",
        }
    }
}

impl Default for Request {
    fn default() -> Self {
        Self {
            model: None,
            windows: Vec::new(),
            voltage_timing: None,
            voltage_accuracy: VOLTAGE_ACCURACY,
            current_accuracy: None,
            bus_accuracy: None,
            magnet_coefficient: None,
            known: [Known::Nothing; PARAMETERS],
            swarm: Swarm::Auto,
            search: SearchSettings::default(),
            bounds: [None; PARAMETERS],
            nameplate: Nameplate::default(),
            bandwidth: None,
            control_rate: None,
            hold_out: false,
        }
    }
}

impl Request {
    /// The same request with this knowledge of one parameter.
    #[must_use]
    pub fn with_known(mut self, parameter: Parameter, known: Known) -> Self {
        self.known[parameter as usize] = known;
        self
    }

    /// The search box of a swarm: the [bounds](Request::bounds) that are stated; for the rest those of the log, or of the rating where
    /// these are larger.
    ///
    /// # Errors
    /// If a bound is not one that an optimizer takes.
    pub fn search_box(&self, of_log: &Bounds) -> Result<Bounds, Error> {
        let mut sides: Vec<(f64, f64)> = of_log.iter().collect();
        if let Some(rating) = self.nameplate.rating {
            let rated = search_box::from_rating(rating.voltage, rating.current, rating.omega_e)?;
            sides.iter_mut().zip(rated.iter()).for_each(|(side, rated)| side.1 = side.1.max(rated.1));
        }
        let (lower, upper) = self.bounds.iter().zip(sides).map(|(stated, side)| stated.unwrap_or(side)).unzip();
        Ok(Bounds::new(lower, upper)?)
    }

    /// # Errors
    /// If a value is out of its range, or nothing is left to be identified.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let accuracies = [
            ("the voltage accuracy", Some(self.voltage_accuracy)),
            ("the accuracy of the current sensors", self.current_accuracy),
            ("the accuracy of the bus voltage", self.bus_accuracy),
        ];
        for (setting, value) in accuracies.into_iter().filter_map(|(setting, accuracy)| Some((setting, accuracy?))) {
            if !(0.0..1.0).contains(&value) {
                return Err(ErrorKind::Setting { setting, value, range: "a fraction from 0 up to 1" }.into());
            }
        }
        if let Some(value) = self.magnet_coefficient.filter(|value| value.is_nan() || value.abs() > LARGEST_COEFFICIENT) {
            let range = "a fraction per kelvin from -0.004 to 0.004";
            return Err(ErrorKind::Setting { setting: "the magnets' coefficient", value, range }.into());
        }
        self.search.check()?;
        for (parameter, known) in Parameter::ALL.into_iter().zip(self.known) {
            let (value, standard_error) = match known {
                Known::Nothing => continue,
                Known::Fixed(value) => (value, 1.0),
                Known::Prior { value, standard_error } => (value, standard_error),
            };
            if !(value.is_finite() && (value > 0.0 || value == 0.0 && has_zero(parameter))) {
                return Err(ErrorKind::KnownValue { parameter, value }.into());
            }
            if !(standard_error > 0.0 && standard_error.is_finite()) {
                return Err(ErrorKind::KnownError { parameter, standard_error }.into());
            }
        }
        if self.known.iter().all(|known| matches!(known, Known::Fixed(_))) { Err(ErrorKind::NothingToIdentify.into()) } else { Ok(()) }
    }
}

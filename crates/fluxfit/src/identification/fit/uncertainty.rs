//! How far to trust the estimate: a standard error in two parts, and the interval they make.
//!
//! *Statistical* (GUM type A): the noise of each window's means, carried through the estimate's gains; its degrees of freedom by
//! Welch and Satterthwaite. *Systematic* (type B): what longer logs would not cure; these parts are added in quadrature:
//!
//! - the voltages' accuracy, independent between windows and axes;
//! - priors;
//! - the timing of the voltage columns, where nobody stated it;
//! - what the [losses](super::voltage_loss) of dead time and devices may be, as far as the points do not tell them, and the
//!   [lags](super::frame_lag) of a recorder;
//! - [faults](super::faults_in_doubt) of the drive that the log neither proves nor rules out;
//! - directions that the log does not excite, a uniform distribution over their reach;
//! - [saturation](super::saturation), where the log shows it, so that the interval holds what each point would call the parameter;
//! - [gains](super::common_gains) common to all current sensors and to all voltages, where their accuracy is stated;
//! - misfit: where the points [contradict each other](super::misfit), the accuracy is that to which they agree, and the interval is
//!   widened to their scatter.
//!
//! JCGM 100:2008 (GUM), sections 4 and 5 and G.4.

use super::{estimate::Estimate, excitation::Excitation, misfit::Misfit, part::Part};
use crate::{motor::PARAMETERS, steady::OperatingPoint};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Probability that the interval holds.
const CONFIDENCE: f64 = 0.95;

/// As many degrees of freedom as no end of them: Student's t is the normal distribution to 1e-6.
pub(super) const NORMAL: f64 = 1e6;

/// Most of a variance: the rest makes an interval wider by a seventh at most.
const MOST: f64 = 0.75;

/// Systematic parts of a standard error (type B, what a longer log would not cure), in the unit of the parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Systematic {
    /// Of the voltages' accuracy.
    pub accuracy: f64,
    /// Of the priors.
    pub prior: f64,
    /// Of the voltage columns' timing.
    pub timing: f64,
    /// Of dead time or device drops.
    pub dead_time: f64,
    /// Of voltages that an observer corrects beside dead time: they may be a part of it.
    pub loss_shape: f64,
    /// Of a recorder's voltages that may turn with speed against its currents.
    pub frame_lag: f64,
    /// Of what goes on within rows that each span several of the drive's periods.
    pub within_rows: f64,
    /// Of unknown voltages that disturb the motor.
    pub process_noise: f64,
    /// Of faults of the drive that the log neither proves nor rules out.
    pub faults_in_doubt: f64,
    /// Of current sensors whose gains differ: it is not known which of them is right.
    pub sensors: f64,
    /// Of a gain common to all current sensors, where its accuracy is [stated](crate::Request::current_accuracy).
    pub current_gain: f64,
    /// Of the DC voltage's measurement, where its accuracy is [stated](crate::Request::bus_accuracy).
    pub bus_voltage: f64,
    /// Of inductances that depend on the current.
    pub saturation: f64,
    /// Of directions that are not excited.
    pub excitation: f64,
    /// Of contradiction between the operating points, where there is any; it then replaces `accuracy`. Also what widens that
    /// of psi_f of a recorder's log to the scatter of its points.
    pub misfit: f64,
}

impl Systematic {
    /// All parts in quadrature.
    pub fn total(&self) -> f64 {
        self.parts().iter().map(|(part, _)| part.powi(2)).sum::<f64>().sqrt()
    }

    /// Every part, with its name.
    pub fn parts(&self) -> [(f64, Part); 14] {
        [
            (self.prior, Part::Prior),
            (self.timing, Part::Timing),
            (self.dead_time.hypot(self.loss_shape), Part::DeadTime),
            (self.frame_lag, Part::FrameLag),
            (self.within_rows, Part::WithinRows),
            (self.process_noise, Part::ProcessNoise),
            (self.faults_in_doubt, Part::FaultsInDoubt),
            (self.sensors, Part::Sensors),
            (self.current_gain, Part::CurrentGain),
            (self.bus_voltage, Part::BusVoltage),
            (self.saturation, Part::Saturation),
            (self.excitation, Part::Excitation),
            (self.misfit, Part::Misfit),
            (self.accuracy, Part::Accuracy),
        ]
    }

    /// Both common gains in quadrature: what no further measurement with the same sensors would cure.
    pub(crate) fn common_gains(&self) -> f64 {
        self.current_gain.hypot(self.bus_voltage)
    }
}

/// The uncertainty of one parameter, in its unit: a statistical part from noise (GUM type A) and a systematic one (type B), combined
/// in quadrature; the interval uses Student's t.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ParameterUncertainty {
    /// Standard error from noise.
    pub statistical: f64,
    /// Standard error from everything else.
    pub systematic: Systematic,
    /// Degrees of freedom of both together.
    pub degrees_of_freedom: f64,
    /// Half the width of the 95 % interval.
    pub half_width: f64,
}

impl ParameterUncertainty {
    /// Both parts and their interval. Degrees of freedom are those of the statistical part.
    pub(crate) fn of(statistical: f64, degrees_of_freedom: f64, systematic: Systematic) -> Self {
        let standard_error = statistical.hypot(systematic.total());
        // Welch and Satterthwaite, with no end of degrees behind the systematic part; the statistical variance over its own
        // square is 0/0 where there is no noise.
        let degrees = degrees_of_freedom * (standard_error / statistical).powi(4);
        let degrees_of_freedom = if degrees.is_nan() { NORMAL } else { degrees.clamp(1.0, NORMAL) };
        Self { statistical, systematic, degrees_of_freedom, half_width: quantile(degrees_of_freedom) * standard_error }
    }

    /// Half the width if neither a fault were [in doubt](super::faults_in_doubt) nor the shape of a loss.
    pub(crate) fn half_width_without_doubt(&self) -> f64 {
        let standard_error = |systematic: &Systematic| self.statistical.hypot(systematic.total());
        let without = standard_error(&Systematic { faults_in_doubt: 0.0, loss_shape: 0.0, ..self.systematic });
        if without > 0.0 { self.half_width * without / standard_error(&self.systematic) } else { without }
    }

    /// The same with so much misfit that the interval is at least as wide as this to either side, SI.
    pub(crate) fn with_min_half_width(self, half_width: f64) -> Self {
        let Self { statistical, mut systematic, degrees_of_freedom, .. } = self;
        // Student's t is never narrower than the normal distribution, so this part alone makes the interval that wide.
        systematic.misfit = systematic.misfit.hypot(half_width / quantile(NORMAL));
        Self::of(statistical, degrees_of_freedom, systematic)
    }

    /// The interval anew, after a part has changed.
    pub(crate) fn anew(&self) -> Self {
        Self::of(self.statistical, self.degrees_of_freedom, self.systematic)
    }

    /// The same with a further doubt of how far the angle is off, a standard uncertainty, SI.
    pub(super) fn with_angle_in_doubt(self, doubt: f64) -> Self {
        let mut systematic = self.systematic;
        systematic.frame_lag = systematic.frame_lag.hypot(doubt);
        Self::of(self.statistical, self.degrees_behind(), systematic)
    }

    /// Degrees of freedom of both parts together, back to those of the statistical one.
    fn degrees_behind(&self) -> f64 {
        self.degrees_of_freedom * (self.statistical / self.standard_error()).powi(4)
    }

    /// Both parts in quadrature.
    pub fn standard_error(&self) -> f64 {
        self.statistical.hypot(self.systematic.total())
    }

    /// The parts that come with a correlation between the parameters; of the others nobody knows it.
    pub(crate) fn correlated(&self) -> f64 {
        let Systematic { accuracy, prior, misfit, .. } = self.systematic;
        [accuracy, prior, misfit, self.systematic.common_gains()].into_iter().fold(self.statistical, f64::hypot)
    }

    /// The largest part.
    pub fn largest_part(&self) -> Part {
        let rest = self.systematic.parts();
        rest.into_iter().fold((self.statistical, Part::Noise), |largest, part| if part.0 > largest.0 { part } else { largest }).1
    }

    /// The parts that are three quarters of the variance together, the largest first.
    pub fn main_parts(&self) -> Vec<Part> {
        let mut parts: Vec<(f64, Part)> = std::iter::once((self.statistical, Part::Noise)).chain(self.systematic.parts()).collect();
        parts.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let most = MOST * parts.iter().map(|(size, _)| size * size).sum::<f64>();
        let mut sum = 0.0;
        let needed = parts.into_iter().take_while(|(size, _)| {
            let is_needed = sum < most;
            sum += size * size;
            is_needed
        });
        needed.map(|(_, part)| part).collect()
    }
}

/// The uncertainty of an estimate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Uncertainty {
    /// Of each parameter.
    pub parameters: [ParameterUncertainty; PARAMETERS],
    /// Correlation of the parameters' statistical and accuracy parts; zero where there is no variance.
    pub correlation: [[f64; PARAMETERS]; PARAMETERS],
}

impl Uncertainty {
    /// Of an estimate, given how far the timing of the voltage columns moves each parameter, SI, and whether its points contradict each
    /// other.
    pub(crate) fn of(
        points: &[OperatingPoint],
        excitation: &Excitation,
        estimate: &Estimate,
        misfit: Option<&Misfit>,
        timing: &[f64; PARAMETERS],
    ) -> Self {
        let mut parameters = [ParameterUncertainty::default(); PARAMETERS];
        for (p, parameter) in parameters.iter_mut().enumerate() {
            let (statistical, degrees_of_freedom, mut systematic) = of_parameter(p, points, estimate, misfit.is_some());
            systematic.timing = systematic.timing.hypot(timing[p]);
            // A uniform distribution's standard deviation.
            systematic.excitation = excitation.unexcited_reach[p] / 3.0_f64.sqrt();
            *parameter = ParameterUncertainty::of(statistical, degrees_of_freedom, systematic);
        }
        Self { parameters, correlation: correlation(points, estimate) }
    }

    /// The same of an answer with constant parameters, where saturation makes them spread with this standard uncertainty, SI.
    pub(crate) fn with_saturation(mut self, spread: [f64; PARAMETERS]) -> Self {
        for (parameter, part) in self.parameters.iter_mut().zip(spread) {
            let ParameterUncertainty { statistical, mut systematic, .. } = *parameter;
            let behind = parameter.degrees_behind();
            // Saturation is why the points contradict each other: one doubt, told twice. And its spread is about this very answer, so that
            // what else is doubtful there is within it. A gain is not: it moves the spread as a whole.
            let needed = part.max(systematic.misfit);
            systematic.misfit = 0.0;
            let (rest, gains) = (statistical.hypot(systematic.total()), systematic.common_gains());
            systematic.saturation = (needed * needed - (rest * rest - gains * gains)).max(0.0).sqrt();
            *parameter = ParameterUncertainty::of(statistical, behind, systematic);
        }
        self
    }

    /// Adds gains common to all current sensors and to all voltages, a term of rank one each: what a standard uncertainty of either does to
    /// the parameters, SI, with its sign.
    pub(super) fn count_common_gains(&mut self, currents: &[f64; PARAMETERS], voltages: &[f64; PARAMETERS]) {
        let before = self.parameters.map(|parameter| parameter.correlated());
        for (p, parameter) in self.parameters.iter_mut().enumerate() {
            let ParameterUncertainty { statistical, mut systematic, .. } = *parameter;
            let behind = parameter.degrees_behind();
            (systematic.current_gain, systematic.bus_voltage) = (currents[p].abs(), voltages[p].abs());
            *parameter = ParameterUncertainty::of(statistical, behind, systematic);
        }
        let after = self.parameters.map(|parameter| parameter.correlated());
        let by_gains = |p: usize, q: usize| currents[p] * currents[q] + voltages[p] * voltages[q];
        let correlation = self.correlation;
        self.correlation = std::array::from_fn(|p| {
            std::array::from_fn(|q| {
                let scale = after[p] * after[q];
                if scale > 0.0 { (correlation[p][q] * before[p] * before[q] + by_gains(p, q)) / scale } else { 0.0 }
            })
        });
    }
}

/// The parts that come through the gains: statistical, with its degrees of freedom, and systematic.
fn of_parameter(p: usize, points: &[OperatingPoint], estimate: &Estimate, misfit: bool) -> (f64, f64, Systematic) {
    let (mut variance, mut variance_of_variance, mut accuracy) = (0.0, 0.0, 0.0);
    for (w, point) in points.iter().enumerate() {
        let gain = estimate.gains[w][p];
        let noise = point.residual_covariance(&estimate.motor);
        let part: f64 = (0..2).flat_map(|a| (0..2).map(move |b| (a, b))).map(|(a, b)| gain[a] * noise[a][b] * gain[b]).sum();
        variance += part;
        variance_of_variance += part * part / point.degrees_of_freedom as f64;
        accuracy += (gain[0] * gain[0] + gain[1] * gain[1]) * estimate.accuracy[w].powi(2);
    }
    // What the rows' noise leaves of an unknown beside the motor.
    variance += estimate.loss_gains.iter().filter(|(of, _)| *of == Part::Noise).map(|(_, gain)| gain[p].powi(2)).sum::<f64>();
    let of_losses =
        |part: Part| estimate.loss_gains.iter().filter(|(of, _)| *of == part).map(|(_, gain)| gain[p].powi(2)).sum::<f64>().sqrt();
    let systematic = Systematic {
        accuracy: if misfit { 0.0 } else { accuracy.sqrt() },
        prior: estimate.prior_gains.iter().map(|gain| gain[p].powi(2)).sum::<f64>().sqrt(),
        timing: of_losses(Part::Timing),
        dead_time: of_losses(Part::DeadTime),
        frame_lag: of_losses(Part::FrameLag),
        misfit: if misfit { (points.len() as f64 * accuracy).sqrt() } else { 0.0 },
        ..Systematic::default()
    };
    (variance.max(0.0).sqrt(), variance * variance / variance_of_variance, systematic)
}

/// Two-sided quantile of Student's t.
fn quantile(degrees_of_freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(0.5 + 0.5 * CONFIDENCE))
}

fn correlation(points: &[OperatingPoint], estimate: &Estimate) -> [[f64; PARAMETERS]; PARAMETERS] {
    let mut covariance = [[0.0; PARAMETERS]; PARAMETERS];
    for (w, point) in points.iter().enumerate() {
        let gain = &estimate.gains[w];
        let mut noise = point.residual_covariance(&estimate.motor);
        noise[0][0] += estimate.accuracy[w].powi(2);
        noise[1][1] += estimate.accuracy[w].powi(2);
        for (p, row) in covariance.iter_mut().enumerate() {
            for (q, entry) in row.iter_mut().enumerate() {
                *entry += (0..2).flat_map(|a| (0..2).map(move |b| (a, b))).map(|(a, b)| gain[p][a] * noise[a][b] * gain[q][b]).sum::<f64>();
            }
        }
    }
    for gain in &estimate.prior_gains {
        for (p, row) in covariance.iter_mut().enumerate() {
            row.iter_mut().zip(gain).for_each(|(entry, other)| *entry += gain[p] * other);
        }
    }
    let deviation: [f64; PARAMETERS] = std::array::from_fn(|p| covariance[p][p].sqrt());
    std::array::from_fn(|p| {
        std::array::from_fn(|q| if deviation[p] * deviation[q] > 0.0 { covariance[p][q] / (deviation[p] * deviation[q]) } else { 0.0 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of 3 and a spread of 5 are 5 together, since what is doubtful at the answer is within the spread. A gain of 12 moves the
    /// spread as a whole: 13.
    #[test]
    fn a_common_gain_comes_on_top_of_the_spread_by_saturation() {
        let noise = ParameterUncertainty::of(3.0, 10.0, Systematic::default());
        let mut uncertainty = Uncertainty { parameters: [noise; PARAMETERS], correlation: [[0.0; PARAMETERS]; PARAMETERS] };
        uncertainty.count_common_gains(&[-12.0; PARAMETERS], &[0.0; PARAMETERS]);
        let spread = uncertainty.with_saturation([5.0; PARAMETERS]).parameters[0];
        assert!((spread.standard_error() - 13.0).abs() < 1e-12, "{spread:?}");
        assert!((spread.systematic.saturation - 4.0).abs() < 1e-12, "{spread:?}");
    }

    /// Noise of 3 beside dead time of 4 and a misfit of 1: dead time alone is 16 of 26, with noise 25.
    #[test]
    fn parts_that_are_most_of_the_variance_are_named_the_largest_first() {
        let of = |noise, dead_time, misfit| {
            ParameterUncertainty::of(noise, 1e6, Systematic { dead_time, misfit, ..Systematic::default() }).main_parts()
        };
        assert_eq!(of(3.0, 4.0, 1.0), [Part::DeadTime, Part::Noise]);
        assert_eq!(of(3.0, 1.0, 1.0), [Part::Noise]);
        assert_eq!(of(3.0, 3.0, 3.0), [Part::Noise, Part::DeadTime, Part::Misfit]);
    }

    /// Two parameters of noise 3 that a gain moves by 4 to opposite sides: 25 of variance each, -16 in common.
    #[test]
    fn a_common_gain_is_a_term_of_rank_one() {
        let noise = ParameterUncertainty::of(3.0, 10.0, Systematic::default());
        let one = std::array::from_fn(|p| std::array::from_fn(|q| f64::from(u8::from(p == q))));
        let mut uncertainty = Uncertainty { parameters: [noise; PARAMETERS], correlation: one };
        uncertainty.count_common_gains(&[4.0, -4.0, 0.0, 0.0], &[0.0; PARAMETERS]);
        assert!((uncertainty.correlation[0][1] + 16.0 / 25.0).abs() < 1e-12 && uncertainty.correlation[0][2] == 0.0);
        assert!((uncertainty.correlation[0][0] - 1.0).abs() < 1e-12 && uncertainty.parameters[2].half_width == noise.half_width);
        // Of the variance, 9 of 25 has ten degrees of freedom, so that the whole has 10 (25 / 9)².
        assert!((uncertainty.parameters[0].degrees_of_freedom - 10.0 * (25.0_f64 / 9.0).powi(2)).abs() < 1e-9);
    }
}

//! What must hold for a whole identification of any log: no panic, errors of one line, only finite numbers in the answer.
//!
//! Checked by `tests/all/any_log.rs` with a few logs, and by `fuzz/` with many; that also limits the time.

use fluxfit::{
    Known, Model, Parameter, Request, Swarm,
    frames::Dq,
    identify,
    log::{Columns, Log},
    motor::Motor,
    optimizer::Draws,
};
use std::fmt::Display;

/// Checks an identification of the log that these bytes make.
pub(crate) type Promise = fn(&[u8]);

/// The targets of fuzzing, as of the readers.
pub(crate) const READERS: [(&str, Promise); 1] = [("identification", identification)];

/// Voltages by the steady equation of this motor, if a log asks for them.
const MOTOR: Motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };

/// Identifies the log of these bytes.
fn identification(bytes: &[u8]) {
    let rows = rows(bytes);
    let mut bytes = Bytes(bytes.get(1..).unwrap_or_default());
    let request = request(&mut bytes);
    let Some(log) = one_line(Log::new(columns(&mut bytes, rows))) else { return };
    is_one_line(&log.spikes().to_string());
    let Some(answer) = one_line(identify(&log, &request)) else { return };
    for judgement in &answer.identification.parameters {
        if let (Some(value), Some([low, high])) = (judgement.value(), judgement.interval()) {
            assert!([value, low, high, judgement.uncertainty.standard_error()].iter().all(|number| number.is_finite()), "{judgement:?}");
        }
        judgement.reason.iter().for_each(|reason| is_one_line(&reason.to_string()));
        judgement.remedy.iter().for_each(|remedy| is_one_line(&remedy.to_string()));
    }
    answer.identification.warnings.iter().for_each(|warning| is_one_line(&warning.to_string()));
    answer.identification.unseen.iter().for_each(|unseen| is_one_line(&unseen.to_string()));
    answer.identification.counted.iter().for_each(|counted| is_one_line(&counted.to_string()));
    if let Some(temperature) = &answer.identification.temperature {
        let referred = [temperature.rs, temperature.psi_f].into_iter().flatten();
        assert!(referred.flat_map(|one| [one.value, one.interval[0], one.interval[1]]).all(f64::is_finite), "{temperature:?}");
        is_one_line(&temperature.to_string());
    }
}

/// Rows of the log that these bytes make.
pub(crate) fn rows(bytes: &[u8]) -> usize {
    2 + usize::from(bytes.first().copied().unwrap_or(0))
}

/// Bytes from the front; zeros behind their end.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn next(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// A number of a size from 1e-9 to 1e9, of either sign.
    fn number(&mut self) -> f64 {
        let (sign_and_digits, exponent) = (self.next(), self.next());
        let digits = 1.0 + f64::from(sign_and_digits & 0x7f) / 16.0;
        let size = digits * 10.0_f64.powi(i32::from(exponent % 19) - 9);
        (if sign_and_digits & 0x80 == 0 { size } else { -size }).clamp(-1e9, 1e9)
    }
}

fn request(bytes: &mut Bytes) -> Request {
    let flags = bytes.next();
    let mut request = Request { swarm: Swarm::Off, ..Request::default() };
    request.model = [None, None, Some(Model::Steady), Some(Model::OutputError)][usize::from(flags & 3)];
    request.voltage_accuracy = if flags & 4 == 0 { request.voltage_accuracy } else { 0.0 };
    if flags & 8 != 0 {
        request.known[Parameter::Rs as usize] = Known::Fixed(MOTOR.rs);
    }
    if flags & 16 != 0 {
        request.known[Parameter::PsiF as usize] = Known::Prior { value: MOTOR.psi_f, standard_error: 0.01 };
    }
    request.current_accuracy = (flags & 32 != 0).then_some(0.02);
    request.bus_accuracy = (flags & 64 != 0).then_some(0.9);
    request.magnet_coefficient = (flags & 128 != 0).then_some(0.004);
    request
}

/// Five columns of a kind and a size each; then single rows that are changed, to the end of the bytes.
fn columns(bytes: &mut Bytes, rows: usize) -> Columns {
    let period = 1e-6 * 10.0_f64.powf(f64::from(bytes.next()) / 50.0);
    let shape = bytes.next();
    let (of_equation, has_temperature) = (shape & 1 != 0, shape & 2 != 0);
    let mut draws = Draws::seeded(u64::from(bytes.next()), 0);
    let mut column = || {
        let (kind, size) = (bytes.next() % 8, bytes.number());
        let value = |k: usize| {
            let part = k as f64 / rows as f64;
            size * match kind {
                0 => 0.0,
                1 => 1.0,
                2 => (2.0 * part).floor() - 0.5,
                3 => part,
                4 => draws.normal().clamp(-4.0, 4.0) / 4.0,
                5 => 0.9 + 1e-2 * draws.normal().clamp(-4.0, 4.0),
                6 => (20.0 * part).sin(),
                _ => (3.0 * part).floor() / 3.0 + 1e-3 * draws.normal().clamp(-4.0, 4.0),
            }
        };
        (0..rows).map(value).collect::<Vec<f64>>()
    };
    let [mut ud, mut uq, mut id, mut iq, mut omega_e] = [(); 5].map(|()| column());
    if of_equation {
        for k in 0..rows {
            let u = MOTOR.steady_voltage(Dq { d: id[k], q: iq[k] }, omega_e[k]);
            (ud[k], uq[k]) = (u.d.clamp(-1e9, 1e9), u.q.clamp(-1e9, 1e9));
        }
    }
    let mut steps = vec![period; rows];
    while !bytes.0.is_empty() {
        let (row, place) = (usize::from(bytes.next()) % rows, bytes.next() % 6);
        let number = bytes.number();
        match place {
            0 => ud[row] = number,
            1 => uq[row] = number,
            2 => id[row] = number,
            3 => iq[row] = number,
            4 => omega_e[row] = number,
            // A gap, or a period that is too short.
            _ => steps[row] = number.abs().clamp(0.1 * period, 1e3 * period),
        }
    }
    let mut now = 0.0;
    let mut time = |step: &f64| {
        now += step;
        now
    };
    // From the lowest to the highest that a log may have.
    let temperature = has_temperature.then(|| (0..rows).map(|k| -230.0 + 460.0 * k as f64 / rows as f64).collect());
    Columns { t: steps.iter().map(&mut time).collect(), ud, uq, id, iq, omega_e, temperature, ..Columns::default() }
}

/// What came out; an error must be one line.
fn one_line<T>(result: Result<T, impl Display>) -> Option<T> {
    result.map_err(|error| is_one_line(&error.to_string())).ok()
}

fn is_one_line(sentence: &str) {
    assert!(!sentence.is_empty() && !sentence.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}')), "{sentence:?}");
}

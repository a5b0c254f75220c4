//! The voltages against the DC voltage: whether the inverter can have made them, and whether they are volts at all.

use super::{finding::ColumnFinding, regression};
use crate::{log::Log, steady::windows};

/// Share of the rows with current that must be above the limit: a drive at its limit is there for a part of its log.
pub const NEARLY_ALL: f64 = 0.9;

/// Six-step operation makes 2 sqrt 3 / pi of the limit; more there is not.
const SIX_STEP: f64 = 1.15;

/// Share of the rows with current above the limit that is enough where the currents follow these voltages.
const SOME: f64 = 0.1;

/// Those rows are above this: a DC voltage that is filtered, or a few per cent off, is not meant.
const WELL_ABOVE: f64 = 1.3;

/// What the motor leaves of voltages that acted, as a fraction. Commands that no inverter could carry out leave more.
const FOLLOWED: f64 = 0.05;

/// Less than this, V, is no DC voltage of a drive: a duty cycle, or a column that is not used.
const LEAST_VOLTAGE: f64 = 2.0;

/// Fewest rows with current.
const LEAST_ROWS: usize = 10;

/// Whether more voltage is there than the inverter can make: in nearly all rows, or in some of them, and the currents follow it.
pub(super) fn scale(log: &Log) -> Option<ColumnFinding> {
    let columns = log.columns();
    let u_dc = columns.u_dc.as_ref()?;
    let least = windows::least_current(log);
    let ratio = |row: usize| {
        let (u, i) = (columns.ud[row].hypot(columns.uq[row]), columns.id[row].hypot(columns.iq[row]));
        (i >= least && u_dc[row] >= LEAST_VOLTAGE).then(|| u * 3.0_f64.sqrt() / u_dc[row])
    };
    let mut ratios: Vec<f64> = (0..log.rows()).filter_map(ratio).collect();
    if ratios.len() < LEAST_ROWS {
        return None;
    }
    let above = |limit: f64| ratios.iter().filter(|ratio| **ratio > limit).count() as f64 / ratios.len() as f64;
    let (rows, most) = (above(SIX_STEP), largest(log));
    let is_followed = || above(WELL_ABOVE) >= SOME && regression::left_of_voltages(log).is_some_and(|left| left < FOLLOWED);
    let share = if rows >= NEARLY_ALL {
        0.5
    } else if is_followed() {
        // Of these rows the middle one.
        1.0 - 0.5 * rows
    } else {
        return None;
    };
    let place = (share * ratios.len() as f64) as usize;
    let ratio = *ratios.select_nth_unstable_by(place, f64::total_cmp).1;
    Some(ColumnFinding::VoltageScale { ratio, rows, most })
}

/// The largest |u| of the log.
fn largest(log: &Log) -> f64 {
    let columns = log.columns();
    columns.ud.iter().zip(&columns.uq).fold(0.0, |most: f64, (ud, uq)| most.max(ud.hypot(*uq)))
}

/// Shares of the DC voltage stay below this: in six-step operation the fundamental is 4 / pi of half the DC voltage.
pub const MOST_SHARE: f64 = 1.3;

/// A DC voltage, V, beside which voltages below [`MOST_SHARE`] are a few hundredths of what there is.
pub const LEAST_BUS: f64 = 20.0;

/// No motor turns as fast, electrical rad/s: 955 000 electrical r/min, for which an inverter would need 160 kHz. The fastest drones and
/// compressors come to half of it.
const IMPOSSIBLE_SPEED: f64 = 1e5;

/// Half of it is what the fastest come to.
const DOUBTFUL_SPEED: f64 = 5e4;

/// Nor does a drive turn a motor by so much from one period to the next, rad: three periods for a turn.
const DOUBTFUL_TURN: f64 = 2.0;

/// What the motor leaves of the voltages, as a fraction, where they are those of a motor that turns.
const OF_MOTOR: f64 = 0.3;

/// Rows slower than this part of the fastest say little about the flux.
const FAST: f64 = 0.5;

/// One step of a pulse-width modulation of 12 bits, as a part of `u_dc / sqrt 3`: a log whose largest voltage is smaller has none that
/// an inverter was told to make.
const PWM_STEP: f64 = 4.2e-4;

/// Whether voltages that never exceed one, beside a DC voltage, are shares of it. As volts they would be those of a motor that this DC
/// voltage turns faster than any; or, at standstill, smaller than an inverter can make.
///
/// A motor at creep speed, or of few mOhm at standstill, has such voltages, too. That its flux is that of a motor tells it: with the
/// voltage of a row, at the row's speed, the DC voltage suffices for no more than what motors come to.
pub(super) fn share(log: &Log) -> Option<ColumnFinding> {
    let columns = log.columns();
    let u_dc = middle(columns.u_dc.as_ref()?.iter().copied())?;
    let most = largest(log);
    if u_dc < LEAST_BUS || most > MOST_SHARE || most == 0.0 || log.peak_current() == 0.0 {
        return None;
    }
    let limit = u_dc / 3.0_f64.sqrt();
    let finding = |omega_e, is_certain| Some(ColumnFinding::VoltageShare { most, u_dc, omega_e, is_certain });
    let fastest = columns.omega_e.iter().fold(0.0_f64, |most, omega| most.max(omega.abs()));
    let is_of_motor = || regression::left_of_voltages(log).is_some_and(|left| left < OF_MOTOR);
    if fastest > 0.0 && is_of_motor() {
        // Voltage that the resistance takes makes the speed smaller, not larger.
        let speed = |row: usize| {
            let u = columns.ud[row].hypot(columns.uq[row]);
            (columns.omega_e[row].abs() >= FAST * fastest && u > 0.0).then(|| columns.omega_e[row].abs() * limit / u)
        };
        let speed = middle((0..log.rows()).filter_map(speed)).unwrap_or(0.0);
        let per_period = if log.is_control_rate() { speed * log.slowest_period() } else { 0.0 };
        if speed >= DOUBTFUL_SPEED || per_period >= DOUBTFUL_TURN {
            return finding(Some(speed), speed >= IMPOSSIBLE_SPEED);
        }
    }
    if most < PWM_STEP * limit { finding(None, false) } else { None }
}

fn middle(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Whole numbers below this may be volts of a bus message that were rounded.
const LEAST_DIGITS: f64 = 50.0;

/// Fewest rows, and fewest different values, of digits.
const ROWS_OF_DIGITS: usize = 100;
const DIFFERENT: usize = 16;

/// Whether the voltages are whole numbers, as digits of a converter or of a register are; so may the currents be. A bus that rounds to V
/// and A has such columns too: it is for the user to say.
pub(super) fn digits(log: &Log) -> Option<ColumnFinding> {
    let columns = log.columns();
    let are_whole = |values: &[f64]| values.iter().all(|value| value.fract() == 0.0);
    if log.rows() < ROWS_OF_DIGITS || !are_whole(&columns.ud) || !are_whole(&columns.uq) {
        return None;
    }
    let currents = are_whole(&columns.id) && are_whole(&columns.iq);
    let most = largest(log);
    let mut values: Vec<f64> = columns.ud.iter().chain(&columns.uq).copied().collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    (most >= LEAST_DIGITS && values.len() >= DIFFERENT).then_some(ColumnFinding::VoltageDigits { most, currents })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frames::Dq, log::Columns};

    /// 4000 rows of 0.1 ms of a motor at two speeds and loads, its voltages times `factor`, beside this DC voltage.
    struct Drive {
        rs: f64,
        l: f64,
        psi_f: f64,
        omega_e: f64,
        current: f64,
        u_dc: f64,
    }

    impl Drive {
        /// The paper's servo motor: 1.2 ohm, 8 mH, 0.17 Wb at 560 V.
        const SERVO: Self = Self { rs: 1.2, l: 8e-3, psi_f: 0.17, omega_e: 800.0, current: 8.0, u_dc: 560.0 };

        fn log(&self, factor: f64) -> Log {
            let mut columns = Columns { u_dc: Some(vec![self.u_dc; 4000]), ..Columns::default() };
            for row in 0..4000 {
                let wave = (0.05 * row as f64).sin();
                let i = Dq { d: -0.2 * self.current * (1.0 + wave), q: self.current * (0.6 + 0.4 * wave) };
                let omega_e = self.omega_e * (0.75 + 0.25 * (0.003 * row as f64).sin());
                columns.t.push(1e-4 * row as f64);
                columns.id.push(i.d);
                columns.iq.push(i.q);
                columns.omega_e.push(omega_e);
                columns.ud.push(factor * (self.rs * i.d - omega_e * self.l * i.q));
                columns.uq.push(factor * (self.rs * i.q + omega_e * (self.l * i.d + self.psi_f)));
            }
            Log::new(columns).unwrap()
        }
    }

    #[test]
    fn shares_of_the_dc_voltage_are_no_volts() {
        let limit = 560.0 / 3.0_f64.sqrt();
        for unit in [560.0, 280.0, limit] {
            let Some(ColumnFinding::VoltageShare { omega_e: Some(speed), is_certain: true, .. }) = share(&Drive::SERVO.log(1.0 / unit))
            else {
                panic!("shares of {unit} V pass")
            };
            // With flux alone the DC voltage is used up at limit / psi_f = 1900 rad/s; resistance and inductance make it somewhat less.
            assert!((0.5..1.0).contains(&(speed / unit / (limit / 0.17))), "{speed}");
        }
        assert_eq!(share(&Drive::SERVO.log(1.0)), None);
    }

    /// Genuine logs with less than 1.3 V: a servo and a traction motor at creep speed, this one held still too, a motor of 12 V at 24 V,
    /// a drone's motor that turns slowly at 25 V.
    #[test]
    fn small_voltages_of_slow_motors_are_volts() {
        let creep = Drive { omega_e: 3.0, current: 0.4, ..Drive::SERVO };
        let traction = Drive { rs: 5e-3, l: 0.2e-3, psi_f: 0.06, omega_e: 8.0, current: 100.0, u_dc: 350.0 };
        let locked = Drive { omega_e: 0.01, ..traction };
        let small = Drive { rs: 0.1, l: 0.1e-3, psi_f: 5e-3, omega_e: 100.0, current: 3.0, u_dc: 24.0 };
        let drone = Drive { rs: 0.05, l: 15e-6, psi_f: 0.8e-3, omega_e: 800.0, current: 3.0, u_dc: 25.0 };
        for drive in [creep, traction, locked, small, drone] {
            let log = drive.log(1.0);
            assert!(largest(&log) < MOST_SHARE, "{}", largest(&log));
            assert_eq!(share(&log), None);
        }
    }

    /// 8 A in 1.2 ohm are 9.6 V of 323 V; the step of a modulation of 12 bits is 0.14 V, and shares of half the DC voltage are 0.034.
    #[test]
    fn at_standstill_less_than_a_step_of_the_modulation_is_no_voltage() {
        let locked = Drive { omega_e: 0.01, ..Drive::SERVO };
        let found = share(&locked.log(1.0 / 280.0));
        assert!(matches!(found, Some(ColumnFinding::VoltageShare { omega_e: None, is_certain: false, .. })), "{found:?}");
    }

    /// At 48 V the limit is 27.7 V. In per cent of half of it voltages are 4.2 times as large, and the motor follows those above the limit;
    /// it does not follow commands that were cut.
    #[test]
    fn per_cent_above_the_limit_are_found_if_the_motor_follows_them() {
        let drive = Drive { rs: 0.045, l: 0.1e-3, psi_f: 0.011, omega_e: 1000.0, current: 20.0, u_dc: 48.0 };
        let found = scale(&drive.log(100.0 / 24.0));
        assert!(matches!(found, Some(ColumnFinding::VoltageScale { ratio, .. }) if ratio > 1.3 && ratio < 4.2), "{found:?}");
        assert_eq!(scale(&drive.log(1.0)), None);
        let mut columns = drive.log(1.0).columns().clone();
        (0..500).for_each(|row| columns.uq[row] = 45.0);
        assert_eq!(scale(&Log::new(columns).unwrap()), None);
    }

    #[test]
    fn whole_numbers_may_be_digits() {
        let digits_of = |factor: f64, of_current: Option<f64>| {
            let mut columns = Drive::SERVO.log(factor).columns().clone();
            columns.ud.iter_mut().chain(&mut columns.uq).for_each(|value| *value = value.round());
            if let Some(digit) = of_current {
                columns.id.iter_mut().chain(&mut columns.iq).for_each(|value| *value = (digit * *value).round());
            }
            digits(&Log::new(columns).unwrap())
        };
        for (of_current, expected) in [(None, false), (Some(10.0), true)] {
            let found = digits_of(2048.0 / 560.0, of_current);
            let is_expected = |most: f64, currents: bool| most > 400.0 && currents == expected;
            assert!(matches!(found, Some(ColumnFinding::VoltageDigits { most, currents }) if is_expected(most, currents)), "{found:?}");
        }
        assert_eq!(digits_of(0.1, None), None);
        assert_eq!(digits(&Drive::SERVO.log(1.0)), None);
    }
}

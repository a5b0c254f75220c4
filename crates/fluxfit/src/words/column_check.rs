//! What the columns of a log contradict each other in.

use super::digits::{percent, three_digits};
use crate::column_check::{Change, ColumnFinding, NEARLY_ALL, Turning};
use std::fmt::{Display, Formatter, Result};

impl Display for ColumnFinding {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::SpeedUnit { ratio } => {
                let (way, ratio) = if *ratio < 0.0 { (" and against it", -ratio) } else { ("", *ratio) };
                write!(f, "theta_e turns {} times as fast as omega_e{way}", four_digits(ratio))
            }
            Self::SpeedScale { low, high, angle } => {
                // The larger number first where the speed is too low.
                let (least, most, way) = if *low > 1.0 { (*low, *high, "high") } else { (1.0 / high, 1.0 / low, "low") };
                let factor = if most < ONE * least {
                    three_digits((least * most).sqrt())
                } else {
                    format!("{} to {}", two_digits(least), two_digits(most))
                };
                let speed = if *angle { "the speed, and the angle with it, is" } else { "the speed is" };
                write!(f, "{speed} about {factor} times too {way} for the slopes of the currents")
            }
            Self::AngleInDegrees => write!(f, "theta_e turns with omega_e only if it is in degrees"),
            Self::SpeedSign { wrong: None } => write!(f, "theta_e turns against omega_e: one of them has the wrong sign"),
            Self::SpeedSign { wrong: Some(Turning::Angle) } => {
                write!(f, "theta_e turns against omega_e, and the voltages agree with omega_e: the angle has the wrong sign")
            }
            Self::SpeedSign { wrong: Some(Turning::Speed) } => {
                write!(f, "theta_e turns against omega_e, and the voltages agree with theta_e: the speed has the wrong sign")
            }
            Self::TimeUnit { factor } => {
                let (times, way) = if *factor < 1.0 { (1.0 / factor, "long") } else { (*factor, "short") };
                write!(f, "the time between rows is {times:.0} times too {way} for the speed and the slopes of the currents")
            }
            Self::Axes { changes, left, left_now } => {
                let ways: Vec<String> = changes.iter().take(NAMED).map(|changes| all_of(changes)).collect();
                write!(
                    f,
                    "no motor explains these voltages ({} of them are left); with {} one does ({})",
                    percent(*left_now),
                    ways.join(", or with "),
                    percent(*left)
                )
            }
            Self::PhaseOrder => write!(f, "the current turns backward in the frame of theta_e: two phases have changed places"),
            Self::LateColumns { rows } => {
                let [late, other] = if *rows > 0 { ["u_d and u_q", "i_d and i_q"] } else { ["i_d and i_q", "u_d and u_q"] };
                let rows = rows.abs();
                write!(
                    f,
                    "{late} stand {rows} rows late beside {other}; log all at one instant, or move them up by {rows} rows in the file"
                )
            }
            Self::VoltageScale { ratio, rows, .. } => {
                let rows = if *rows < NEARLY_ALL {
                    format!("in {} of the rows, and the currents follow them", percent(*rows))
                } else {
                    "in nearly every row".to_owned()
                };
                write!(f, "the voltages are {} times what the inverter can make of u_dc (u_dc / sqrt 3), {rows}", three_digits(*ratio))
            }
            Self::VoltageShare { most, u_dc, omega_e, .. } => {
                write!(f, "|u| never exceeds {} where u_dc is {} V, ", three_digits(*most), three_digits(*u_dc))?;
                match omega_e {
                    Some(omega_e) => {
                        let speed = grouped(omega_e * 60.0 / std::f64::consts::TAU);
                        write!(f, "and if these were volts the motor could reach {speed} electrical r/min")
                    }
                    None => write!(f, "as volts less than one step of an inverter"),
                }
            }
            Self::VoltageDigits { most, currents: false } => {
                write!(f, "u_d and u_q are whole numbers, up to {most:.0}, while the currents are not")
            }
            Self::VoltageDigits { most, currents: true } => write!(f, "voltages and currents are whole numbers, up to {most:.0}"),
        }
    }
}

/// Two digits of a large number, in groups of three: `2 900 000`.
fn grouped(number: f64) -> String {
    let size = 10_f64.powf(number.log10().floor() - 1.0);
    let digits = format!("{:.0}", (number / size).round() * size);
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    groups.join(" ")
}

/// Ways that are named; more would only say that the log tells little.
const NAMED: usize = 3;

/// Factors this near to each other are one.
const ONE: f64 = 1.05;

fn two_digits(ratio: f64) -> String {
    if ratio < 10.0 { format!("{ratio:.1}") } else { format!("{ratio:.0}") }
}

fn four_digits(ratio: f64) -> String {
    let decimals = (3.0 - ratio.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{ratio:.decimals$}")
}

fn all_of(changes: &[Change]) -> String {
    changes.iter().map(Change::to_string).collect::<Vec<_>>().join(" and ")
}

impl Display for Change {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.write_str(match self {
            Self::SwapAxes => "d and q exchanged",
            Self::SwapVoltages => "u_d and u_q exchanged",
            Self::SwapCurrents => "i_d and i_q exchanged",
            Self::ReverseCurrents => "both currents reversed (they are counted out of the motor)",
            Self::ReverseVoltages => "both voltages reversed",
            Self::ReverseAxes => "all voltages and currents reversed (d points to the south pole)",
            Self::ReverseSpeed => "the speed reversed (or the q axis)",
            Self::ReverseUd => "u_d reversed",
            Self::ReverseUq => "u_q reversed",
            Self::ReverseId => "i_d reversed",
            Self::ReverseIq => "i_q reversed",
        })
    }
}

//! The layouts of logs that tools write: one table for the reader, for the list of formats and for docs/log.md.
//!
//! A layout is recognized by names that no other has. It states the channels and units of its columns; options and a mapping file
//! override it.

use crate::channel::Channel;
use Channel::{IA, IB, IC, Id, Iq, OmegaE, Run, T, ThetaE, UA, UB, UC, UDc, Ud, Uq};
use fluxfit_files::Advice;
use fluxfit_units::Unit;

/// The layout of a log that a tool writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Name.
    pub name: &'static str,
    /// Where the columns are defined, or an example of a file.
    pub source: &'static str,
    /// Names by which it is recognized: a file with all of them has this layout.
    pub(crate) signature: &'static [&'static str],
    /// Its columns.
    pub(crate) columns: &'static [Column],
    /// Time between rows, s, if there is no time column.
    pub(crate) sample_period: Option<f64>,
    /// Why a file with this layout is not a log, if it is not.
    pub(crate) refusal: Option<NotALog>,
    /// Remarks for users.
    pub remark: &'static str,
}

/// A column of a layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Column {
    pub(crate) channel: Channel,
    pub(crate) header: &'static str,
    pub(crate) unit: Unit,
}

const fn column(channel: Channel, header: &'static str, unit: Unit) -> Column {
    Column { channel, header, unit }
}

const LOG: Layout = Layout { name: "", source: "", signature: &[], columns: &[], sample_period: None, refusal: None, remark: "" };

/// Why a file is not a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotALog {
    /// It maps currents to flux linkages.
    FluxMap,
    /// It has current references in place of measured currents.
    CurrentReferences,
    /// Its rows are motors.
    Parameters,
}

/// Names of flux linkages, before or behind the axis; the single letter is that of SyR-e.
const FLUXES: [&str; 9] = ["psi", "flux", "lambda", "fluxlinkage", "lam", "linkage", "phi", "fluxlinked", "f"];

/// Names of a current's amplitude and of its angle, which a map may have in place of i_d and i_q, as Motor-CAD's has.
const AMPLITUDES: [&str; 9] =
    ["is", "im", "i", "current", "statorcurrent", "phasecurrent", "ismatrix", "currentamplitude", "statorcurrentamplitude"];
const ADVANCES: [&str; 9] =
    ["beta", "gamma", "gammamatrix", "phaseadvance", "advance", "advanceangle", "currentangle", "angle", "currentphaseangle"];

impl NotALog {
    /// The reason, and what to do.
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::FluxMap => {
                "a flux map, measured or computed (Motor-CAD, FEM), has currents and flux linkages, but no voltages and no time, so nothing is identified from it; give the log of a drive, or take it as the motor of a simulation (flux_map in a scenario: columns id, iq, psi_d, psi_q)"
            }
            Self::Parameters => {
                "its columns are what fluxfit finds of motors, and none is a voltage or a current of a drive; give the log of a drive, and one motor's values for comparison (motor file, or fluxfit validate)"
            }
            Self::CurrentReferences => {
                "IqReq and WeakenedId are current references, not measured currents; log the measured i_d and i_q too, and map id and iq to them"
            }
        }
    }

    /// What a table is that lacks voltages, by the names of its other columns.
    pub(crate) fn by_names(names: &[String]) -> Option<(&'static str, Self)> {
        let stems: Vec<String> = names.iter().map(|name| stem_of_table(name)).collect();
        let has = |some: &[&str]| stems.iter().any(|stem| some.contains(&stem.as_str()));
        let is_axis = |stem: &str, axis: &str| {
            let forms = [format!("{stem}{axis}"), format!("{axis}{stem}"), format!("{axis}axis{stem}"), format!("{stem}{axis}axis")];
            has(&forms.each_ref().map(String::as_str))
        };
        let both_axes = |stem: &&str| ["d", "q"].iter().all(|axis| is_axis(stem, axis));
        let has_currents = ["i", "is", "current", "statorcurrent"].iter().any(&both_axes) || has(&AMPLITUDES) && has(&ADVANCES);
        // Of an observer, which estimates fluxes of a motor that turns, there is a time and a speed.
        let is_log = has(&["t", "time"]) && has(&["speed", "omega", "omegae", "rpm", "n"]);
        if FLUXES.iter().any(&both_axes) && has_currents && !is_log {
            return Some(("flux map", Self::FluxMap));
        }
        (both_axes(&"l") && has(&["rs", "r", "rph", "ra"])).then_some(("table of parameters", Self::Parameters))
    }

    /// What the user can state to have it read all the same.
    pub(crate) fn advice(self) -> Option<Advice> {
        match self {
            Self::FluxMap | Self::Parameters => None,
            Self::CurrentReferences => Some(Advice::MapColumns(vec![(Id.name(), None), (Iq.name(), None)])),
        }
    }
}

/// All layouts. The first that fits is used.
pub const LAYOUTS: &[Layout] = &[
    Layout {
        name: "canonical",
        source: "docs/log.md",
        signature: &["t", "ud", "uq", "id", "iq", "omega_e"],
        columns: &[
            column(T, "t", Unit::Second),
            column(Ud, "ud", Unit::Volt),
            column(Uq, "uq", Unit::Volt),
            column(Id, "id", Unit::Ampere),
            column(Iq, "iq", Unit::Ampere),
            column(OmegaE, "omega_e", Unit::RadianPerSecond),
            column(ThetaE, "theta_e", Unit::Radian),
            column(UDc, "u_dc", Unit::Volt),
        ],
        remark: "what fluxfit simulate writes",
        ..LOG
    },
    Layout {
        name: "VESC Tool",
        source: "github.com/vedderb/vesc_tool, the log of real-time data",
        signature: &["ms_today", "d_axis_current", "q_axis_current", "erpm"],
        columns: &[
            column(T, "ms_today", Unit::Millisecond),
            column(Ud, "d_axis_voltage", Unit::Volt),
            column(Uq, "q_axis_voltage", Unit::Volt),
            column(Id, "d_axis_current", Unit::Ampere),
            column(Iq, "q_axis_current", Unit::Ampere),
            column(OmegaE, "erpm", Unit::RpmElectrical),
            column(UDc, "input_voltage", Unit::Volt),
        ],
        remark: "filtered values about ten times a second; the time wraps around at midnight",
        ..LOG
    },
    Layout {
        name: "VESC Express",
        source: "github.com/vedderb/vesc_pkg, logui: what the logger of VESC Express stores",
        signature: &["RPM", "Temp Fet", "iq", "id", "vq", "vd"],
        columns: &[
            column(T, "t_day", Unit::Second),
            column(Ud, "vd", Unit::Volt),
            column(Uq, "vq", Unit::Volt),
            column(Id, "id", Unit::Ampere),
            column(Iq, "iq", Unit::Ampere),
            column(OmegaE, "RPM", Unit::RpmElectrical),
            column(UDc, "Input Voltage", Unit::Volt),
        ],
        remark: "filtered values some ten times a second; the header may also have name, unit and digits of each column, `RPM:RPM::2:0:0`",
        ..LOG
    },
    Layout {
        name: "VESC sampled data",
        source: "github.com/vedderb/vesc_tool, pages/pagesampleddata.cpp",
        signature: &["T", "I1", "I2", "I3", "V1", "V2", "V3", "Phase"],
        columns: &[
            column(T, "T", Unit::Second),
            column(IA, "I1", Unit::Ampere),
            column(IB, "I2", Unit::Ampere),
            column(IC, "I3", Unit::Ampere),
            column(UA, "V1", Unit::Volt),
            column(UB, "V2", Unit::Volt),
            column(UC, "V3", Unit::Volt),
            column(ThetaE, "Phase", Unit::Degree),
        ],
        remark: "phase quantities at the rate of the drive; the angle has steps of 1.44 degrees, the speed is computed from it",
        ..LOG
    },
    Layout {
        name: "phobia",
        source: "github.com/rombrew/phobia, telemetry and grab",
        signature: &["time", "lu_ID", "lu_IQ", "lu_WS_RPM"],
        columns: &[
            column(T, "time", Unit::Second),
            column(Id, "lu_ID", Unit::Ampere),
            column(Iq, "lu_IQ", Unit::Ampere),
            column(IA, "IA", Unit::Ampere),
            column(IB, "IB", Unit::Ampere),
            column(IC, "IC", Unit::Ampere),
            column(UA, "UA", Unit::Volt),
            column(UB, "UB", Unit::Volt),
            column(UC, "UC", Unit::Volt),
            column(OmegaE, "lu_WS_RPM", Unit::RpmMechanical),
            column(ThetaE, "lu_F_G", Unit::Degree),
            column(UDc, "DC", Unit::Volt),
        ],
        remark: "units in the names, after @; phase voltages; the angle is lu_F_G, or is computed from the currents in phase and dq quantities",
        ..LOG
    },
    Layout {
        name: "ST MCSDK",
        source: "logs of STM32 Motor Control SDK drives over a serial line",
        signature: &["stm32_time_ms", "motor_ud_v", "motor_uq_v", "motor_id_a", "motor_iq_a"],
        columns: &[
            column(T, "stm32_time_ms", Unit::Millisecond),
            column(Ud, "motor_ud_v", Unit::Volt),
            column(Uq, "motor_uq_v", Unit::Volt),
            column(Id, "motor_id_a", Unit::Ampere),
            column(Iq, "motor_iq_a", Unit::Ampere),
            column(OmegaE, "motor_speed_mech_rpm", Unit::RpmMechanical),
        ],
        remark: "ten rows a second, written by a recorder",
        ..LOG
    },
    Layout {
        name: "Tritium",
        source: "Tritium WaveSculptor telemetry",
        signature: &["MotorId", "MotorIq", "MotorVd", "MotorVq", "MotorVelocity"],
        columns: &[
            column(T, "Time", Unit::Second),
            column(Ud, "MotorVd", Unit::Volt),
            column(Uq, "MotorVq", Unit::Volt),
            column(Id, "MotorId", Unit::Ampere),
            column(Iq, "MotorIq", Unit::Ampere),
            column(OmegaE, "MotorVelocity", Unit::RpmMechanical),
            column(UDc, "BusVoltage", Unit::Volt),
        ],
        remark: "each message has its own instant; while coasting the voltages are not those at the motor",
        ..LOG
    },
    Layout {
        name: "Tritium, names with units",
        source: "Tritium WaveSculptor telemetry as a dynamometer's log holds it",
        signature: &["motor_id_A", "motor_iq_A", "motor_vd_V", "motor_vq_V", "motor_velocity_rpm"],
        columns: &[
            column(T, "time_s", Unit::Second),
            column(Ud, "motor_vd_V", Unit::Volt),
            column(Uq, "motor_vq_V", Unit::Volt),
            column(Id, "motor_id_A", Unit::Ampere),
            column(Iq, "motor_iq_A", Unit::Ampere),
            column(OmegaE, "motor_velocity_rpm", Unit::RpmMechanical),
            column(UDc, "bus_voltage_V", Unit::Volt),
        ],
        remark: "while coasting the voltages are not those at the motor",
        ..LOG
    },
    Layout {
        name: "Paderborn",
        source: "kaggle.com/datasets/wkirgsn/electric-motor-temperature",
        // Copies of this data set often lack some of its temperatures.
        signature: &["motor_speed", "i_d", "i_q", "profile_id"],
        columns: &[
            column(Ud, "u_d", Unit::Volt),
            column(Uq, "u_q", Unit::Volt),
            column(Id, "i_d", Unit::Ampere),
            column(Iq, "i_q", Unit::Ampere),
            column(OmegaE, "motor_speed", Unit::RpmMechanical),
            column(Run, "profile_id", Unit::Number),
        ],
        sample_period: Some(0.5),
        remark: "two rows a second, without a time column; each profile is a separate run. An older, standardized version is refused",
        ..LOG
    },
    Layout {
        name: "phase quantities",
        source: "published drive data sets with these names",
        signature: &["timeInS", "i_aInA", "i_bInA", "u_aInV", "u_bInV"],
        columns: &[
            column(T, "timeInS", Unit::Second),
            column(IA, "i_aInA", Unit::Ampere),
            column(IB, "i_bInA", Unit::Ampere),
            column(IC, "i_cInA", Unit::Ampere),
            column(UA, "u_aInV", Unit::Volt),
            column(UB, "u_bInV", Unit::Volt),
            column(UC, "u_cInV", Unit::Volt),
            column(ThetaE, "epsilon_elInRad", Unit::Radian),
        ],
        remark: "Clarke and Park transforms are applied, the speed is computed from the angle",
        ..LOG
    },
    Layout {
        name: "dynamometer with references",
        source: "dynamometer sheets of motor controllers",
        signature: &["TimeStamp", "VqFiltered", "VdFiltered", "IqReq", "WeakenedId"],
        refusal: Some(NotALog::CurrentReferences),
        remark: "current references in place of measured currents",
        ..LOG
    },
    Layout {
        name: "flux map",
        source: "dynamometer tables",
        signature: &["I_d", "I_q", "Psi_d", "Psi_q"],
        refusal: Some(NotALog::FluxMap),
        remark: "not a log; it can be the motor of a simulation",
        ..LOG
    },
    Layout {
        name: "SyR-e flux map",
        source: "github.com/SyR-e/syre_public, motorModel.FluxMap_dq (d and q are swapped there)",
        signature: &["motorModel.FluxMap_dq.Id", "motorModel.FluxMap_dq.Fd"],
        refusal: Some(NotALog::FluxMap),
        remark: "not a log; it can be the motor of a simulation",
        ..LOG
    },
];

impl Layout {
    /// The layout of a file with these names, if it is in the table.
    pub(crate) fn recognize(names: &[String]) -> Option<&'static Self> {
        LAYOUTS.iter().find(|layout| layout.signature.iter().all(|header| names.iter().any(|name| is_called(name, header))))
    }

    /// The column that holds a channel.
    pub(crate) fn column(&self, channel: Channel) -> Option<&'static Column> {
        self.columns.iter().find(|column| column.channel == channel)
    }

    /// Canonical names and headers of its columns, on one line.
    pub fn headers(&self) -> String {
        if self.columns.is_empty() {
            return self.signature.join(", ");
        }
        let describe = |column: &Column| match (column.channel.name(), column.header) {
            (canonical, header) if canonical == header => header.to_owned(),
            (canonical, header) => format!("{canonical} = {header} ({})", column.unit.prose()),
        };
        self.columns.iter().map(describe).collect::<Vec<_>>().join(", ")
    }

    /// The layout with the canonical names.
    pub(crate) fn canonical() -> &'static Self {
        &LAYOUTS[0]
    }

    /// Whether it is the layout with the canonical names.
    pub(crate) fn is_canonical(&self) -> bool {
        self.name == Self::canonical().name
    }

    /// Whether files with this layout are read.
    pub fn is_log(&self) -> bool {
        self.refusal.is_none()
    }
}

/// The letters of a name in lower case, without a unit of a flux, a current, an inductance or a resistance at its end, and without what it
/// says of root mean squares and peaks.
fn stem_of_table(name: &str) -> String {
    let lower = name.to_lowercase();
    let mut words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is_unit = |word: &&str| {
        ["wb", "mwb", "vs", "mvs", "a", "h", "mh", "uh", "ohm", "mohm", "ohms", "arms", "apk", "apeak", "deg", "edeg", "nm"].contains(word)
    };
    if words.len() > 1 && words.last().is_some_and(is_unit) {
        words.pop();
    }
    // `idrms`, `psi_d_pk`.
    let measures = ["rms", "pk", "peak"];
    words.retain(|word| !measures.contains(word));
    let stem = words.concat();
    measures.iter().find_map(|measure| stem.strip_suffix(measure)).unwrap_or(&stem).to_owned()
}

/// Whether a name is this header, apart from case and from a unit after `@` or in brackets.
pub(crate) fn is_called(name: &str, header: &str) -> bool {
    let stem = name.split(['@', '[']).next().unwrap_or(name);
    let stem = if stem.ends_with(')') && !header.contains('(') { stem.rsplit_once('(').map_or(stem, |(stem, _)| stem) } else { stem };
    name.eq_ignore_ascii_case(header) || stem.trim_end().eq_ignore_ascii_case(header)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recognized(header: &str) -> Option<&'static str> {
        let names: Vec<String> = header.split(';').map(str::to_owned).collect();
        Layout::recognize(&names).map(|layout| layout.name)
    }

    #[test]
    fn headers_of_tools_are_recognized() {
        assert_eq!(recognized("t;ud;uq;id;iq;omega_e"), Some("canonical"));
        let vesc = "ms_today;input_voltage;temp_mos_max;current_motor;d_axis_current;q_axis_current;erpm;duty_cycle;d_axis_voltage;q_axis_voltage;ms_today_setup";
        assert_eq!(recognized(vesc), Some("VESC Tool"));
        let express = "Input Voltage;Current;Duty;RPM;Temp Fet;kmh_vesc;cnt_ah;iq;id;vq;vd;Fault;t_day";
        assert_eq!(recognized(express), Some("VESC Express"));
        assert_eq!(recognized("t;RPM;iq;id;vq;vd"), None);
        assert_eq!(recognized("T;I1;I2;I3;V1;V2;V3;I_tot;V_zero;Phase"), Some("VESC sampled data"));
        assert_eq!(recognized("time@s;IA@A;lu_ID@A;lu_IQ@A;lu_WS_RPM@rpm"), Some("phobia"));
        assert_eq!(recognized("Time;BusVoltage (V);MotorId (A);MotorIq (A);MotorVd (V);MotorVq (V);MotorVelocity (rpm)"), Some("Tritium"));
        assert_eq!(recognized("I_d;I_q;Psi_d;Psi_q;Trq_msr"), Some("flux map"));
        assert_eq!(recognized("time;speed;torque"), None);
    }

    #[test]
    fn tables_that_are_no_logs_are_named() {
        let of = |header: &str| NotALog::by_names(&header.split(',').map(str::to_owned).collect::<Vec<_>>()).map(|(name, _)| name);
        assert_eq!(of("id_A,iq_A,psi_d_Wb,psi_q_Wb"), Some("flux map"));
        assert_eq!(of("Id (A),Iq (A),Flux d [Vs],Flux q [Vs],T [Nm]"), Some("flux map"));
        assert_eq!(of("case_id,id_RMS_A,iq_RMS_A,torque_Nm,psiD_Wb,psiQ_Wb,Ld_H,Lq_H,Bmax_T"), Some("flux map"));
        assert_eq!(of("IqRMS,IdRMS,psiD_Pk,psiQ_Pk,Lq,Ld,Torque(Nm),TopSpeed"), Some("flux map"));
        for header in [
            "Stator Current (Peak),Phase Advance,Flux Linkage D (Peak),Flux Linkage Q (Peak)",
            "Is_Matrix,Gamma_Matrix,Flux_Linkage_D,Flux_Linkage_Q",
            "Is [A],beta [deg],Psi_d [Wb],Psi_q [Wb]",
            "d-axis current (A),q-axis current (A),d-axis flux linkage (Wb),q-axis flux linkage (Wb)",
            "Current d,Current q,Linkage d,Linkage q",
            "Id,Iq,Fd,Fq",
            "Id,Iq,Phi_d,Phi_q,T",
        ] {
            assert_eq!(of(header), Some("flux map"), "{header}");
        }
        assert_eq!(of("t,id,iq,psi_d,psi_q,speed"), None);
        assert_eq!(of("Ld_H,Lq_H,Rs_ohm,pole_pairs,psi_pm_Wb"), Some("table of parameters"));
        for header in ["t,id,iq,ud,uq,omega_e", "speed,id,iq", "Ld,Lq,t", "psi_d,psi_q,t"] {
            assert_eq!(of(header), None, "{header}");
        }
    }

    #[test]
    fn a_layout_is_recognized_by_its_own_names_and_names_each_channel_once() {
        for layout in LAYOUTS {
            let names: Vec<String> = layout.signature.iter().map(|name| (*name).to_owned()).collect();
            assert_eq!(Layout::recognize(&names).map(|found| found.name), Some(layout.name));
            for (place, column) in layout.columns.iter().enumerate() {
                assert_eq!(column.unit.dimension(), column.channel.dimension(), "{}: {}", layout.name, column.header);
                assert!(layout.columns[..place].iter().all(|earlier| earlier.channel != column.channel), "{}", layout.name);
            }
            assert_eq!(layout.columns.is_empty(), layout.refusal.is_some(), "{}", layout.name);
        }
    }
}

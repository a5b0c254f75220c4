//! The words that columns are usually called by, in the languages of the tools: lower case, without accents and marks.

/// Words that say only that a value was measured, and where.
pub(super) const BESIDE: [&str; 26] = [
    "meas",
    "measured",
    "measurement",
    "act",
    "actual",
    "ist",
    "istwert",
    "fb",
    "fbk",
    "feedback",
    "motor",
    "mot",
    "stator",
    "foc",
    "drive",
    "inverter",
    "inv",
    "pmsm",
    "mcu",
    // Of several motors or axes, where one alone is logged.
    "m1",
    "m2",
    "motor1",
    "motor2",
    "axis0",
    "axis1",
    "mtr",
];

/// Further ones beside a speed or an angle.
pub(super) const ROTATION: [&str; 24] = [
    "welle",
    "antrieb",
    "rotor",
    "revolution",
    "rotation",
    "shaft",
    "angular",
    "rotational",
    "mech",
    "mechanical",
    "elec",
    "electrical",
    "el",
    "e",
    "mechanisch",
    "elektrisch",
    "m",
    "r",
    "est",
    "estimate",
    "estimated",
    "encoder",
    "enc",
    "resolver",
];

pub(super) const CURRENT: [&str; 10] = ["i", "is", "current", "strom", "courant", "corrente", "corriente", "stroem", "电流", "電流"];
pub(super) const VOLTAGE: [&str; 12] =
    ["u", "v", "us", "vs", "voltage", "volt", "spannung", "tension", "tensione", "voltaje", "电压", "電圧"];

/// What a vector is called, beside `dq`.
pub(super) const CURRENT_VECTOR: [&str; 4] = ["i", "current", "currents", "strom"];
pub(super) const VOLTAGE_VECTOR: [&str; 4] = ["v", "u", "voltage", "voltages"];

/// Words for a controller and for what is measured, in the path of a name.
pub(super) const CONTROLLER: [&str; 3] = ["control", "controller", "ctrl"];
pub(super) const MEASURED: [&str; 8] = ["stats", "status", "meas", "measured", "act", "actual", "fb", "feedback"];

pub(super) const TIME: [&str; 22] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "datetime",
    "seconds",
    "elapsedtime",
    "elapsed",
    "reltime",
    "relativetime",
    "testtime",
    "zeit",
    "zeitstempel",
    "messzeit",
    "temps",
    "tempo",
    "tiempo",
    "xvalue",
    // Of Simulink, and of loggers.
    "tout",
    "ts",
    "时间",
    "時間",
];
pub(super) const SPEED: [&str; 28] = [
    "omega",
    "w",
    "speed",
    "velocity",
    "vel",
    "velo",
    "rpm",
    "erpm",
    "n",
    "wm",
    "wr",
    "we",
    "omegam",
    "omegar",
    "omegae",
    "omegael",
    "freq",
    "frequency",
    "frequenz",
    "drehzahl",
    "vitesse",
    "velocita",
    "velocidad",
    "winkelgeschwindigkeit",
    "geschwindigkeit",
    "geschwindigkeits",
    "转速",
    "回転数",
];

/// Words that German writes in one with a speed: `Istdrehzahl`, `Motordrehzahl`.
pub(super) const BEFORE_SPEED: [&str; 5] = ["ist", "motor", "rotor", "wellen", "antriebs"];

/// Names of the axis of a plot: the time, where no other unit is stated.
pub(super) const X: [&str; 2] = ["xaxis", "xachse"];

pub(super) const UDC: [&str; 15] = [
    "udc",
    "vdc",
    "ubus",
    "vbus",
    "uzk",
    "dcvoltage",
    "dclinkvoltage",
    "dcbusvoltage",
    "busvoltage",
    "zwischenkreisspannung",
    "vdcbus",
    "udcbus",
    "vbusvoltage",
    "vdclink",
    "udclink",
];

pub(super) const ANGLE: [&str; 13] = [
    "transformationswinkel",
    "thetam",
    "thetae",
    "thetar",
    "thetael",
    "theta",
    "angle",
    "phi",
    "epsilon",
    "winkel",
    "rotorwinkel",
    "position",
    "rotorangle",
];

/// German words for the axes: along the field and across it, of the field and of the torque.
pub(super) const ALONG: [&str; 2] = ["laengs", "feldbildend"];
pub(super) const ACROSS: [&str; 5] = ["quer", "momentbildend", "momentenbildend", "drehmomentbildend", "drehmomentenbildend"];

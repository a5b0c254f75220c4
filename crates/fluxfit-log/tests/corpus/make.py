"""A corpus of small logs, and what a reader must make of each.

One motor log is computed here by formula; every file holds it, or a part of it, in some format, dialect or state. The files are written by pandas,
pyarrow, scipy, h5py, asammdf and gzip, none of which is part of the reader. What is expected comes from the arrays that were written, never from fluxfit.

    pip install -r requirements.txt; python3 make.py        rewrites logs/, mappings/ and expected.toml

In expected.toml, each case has a file and what the user says of it (map, units, pole_pairs, mapping, dbc), and either
    a reading: layout, rows, segments, sample_period, notes (each must occur in some note), columns in SI (first, last, sum; a tolerance of 0 means
               the same bits), same_as (all columns have the bits of that file's);
    or a refusal: words that the one sentence must contain, each given as alternatives parted by |; and the line, where there is one.
The meaning of a pattern of words: upper and lower case do not matter.
"""

import csv as csv_module
import gzip
import io
import math
import shutil
import struct
import sys
from datetime import datetime, timezone
from pathlib import Path

import asammdf
import h5py
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io

import guesses
import instruments
import tools

HERE = Path(__file__).parent
LOGS = HERE / "logs"
MAPPINGS = HERE / "mappings"
LARGEST = 40_000  # bytes of a file

# The paper's motor.
RS, LD, LQ, PSI_F, POLE_PAIRS = 0.958, 5.25e-3, 12e-3, 0.1827, 4
U_DC = 310.0

# What the reader calls each layout: one place to rename them.
CANONICAL, VESC_TOOL, VESC_EXPRESS, VESC_SAMPLED, PHOBIA, ST_MCSDK, TRITIUM, PADERBORN, PHASES, MAPPED = (
    "canonical", "VESC Tool", "VESC Express", "VESC sampled data", "phobia", "ST MCSDK", "Tritium", "Paderborn", "phase quantities", "none")

RPM = 60.0 / (2.0 * math.pi)
NAMES = ["t", "ud", "uq", "id", "iq", "omega_e"]

cases = []


# The motor's log


def decimals(values, places):
    """The doubles nearest to decimal numbers: as text they are short, and read back to the same bits."""
    return np.array([float(f"{value:.{places}f}") for value in values])


def motor_log(period, lengths, ramp, places_t):
    """Steady stretches with ramps between; a ripple, so that no channel stands still."""
    points = [(-0.5, 2.0, 200.0), (-2.0, 4.0, 260.0), (-1.0, 3.0, 180.0), (-1.5, 1.0, 320.0)]  # id, iq, omega_e
    parts = []
    for number, length in enumerate(lengths):
        here, there = points[number % len(points)], points[(number + 1) % len(points)]
        parts.append(np.tile(here, (length, 1)))
        if number + 1 < len(lengths):
            share = (np.arange(ramp) + 1.0)[:, None] / (ramp + 1.0)
            parts.append(np.array(here) + share * (np.array(there) - np.array(here)))
    i_d, i_q, omega = np.concatenate(parts).T
    k = np.arange(len(omega))
    i_d = decimals(i_d + 0.02 * np.sin(1.1 * k), 4)
    i_q = decimals(i_q + 0.02 * np.cos(1.7 * k), 4)
    omega = decimals(omega + 0.5 * np.sin(0.6 * k), 3)
    t = decimals(k * period, places_t)
    # (1) and (2) of the paper; slopes as central differences.
    u_d = RS * i_d + LD * np.gradient(i_d, period) - omega * LQ * i_q
    u_q = RS * i_q + LQ * np.gradient(i_q, period) + omega * (LD * i_d + PSI_F)
    theta = np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2.0 * period)]) + 0.3
    return {
        "t": t, "ud": decimals(u_d, 3), "uq": decimals(u_q, 3), "id": i_d, "iq": i_q, "omega_e": omega,
        "theta_e": theta, "u_dc": decimals(U_DC + 0.4 * np.sin(0.2 * k), 2),
    }


FAST = motor_log(1e-4, [50, 40, 50], 10, 4)
SLOW = motor_log(0.05, [60, 60, 60], 10, 2)


def part(log, names=NAMES):
    return {name: log[name] for name in names}


def changed(log, **columns):
    return {**part(log), **columns}


def phases(d, q, angle):
    """Phase quantities, amplitude-invariant: at an angle of zero the d axis lies on phase a; q leads d by 90 degrees."""
    return [d * np.cos(angle - shift) - q * np.sin(angle - shift) for shift in (0.0, 2.0 * np.pi / 3.0, 4.0 * np.pi / 3.0)]


# What is expected


def in_order(values):
    total = 0.0
    for value in values:
        total += float(value)
    return total


def expect_column(values, tolerance=0.0):
    return {"first": float(values[0]), "last": float(values[-1]), "sum": in_order(values), "tolerance": float(tolerance)}


def read(file, says, log=None, layout=CANONICAL, tolerances=None, names=NAMES, told=None, **more):
    """A case that is read. `tolerances`: absolute, by column, in SI; zero where not given. `names`: the columns that are looked at."""
    case = {"file": file, "says": says, **(told or {}), "layout": layout}
    if log is not None:
        case["rows"] = more.pop("rows", len(log[names[0]]))
        more["columns"] = {name: expect_column(log[name], (tolerances or {}).get(name, 0.0)) for name in names}
    cases.append({**case, **more})


def refuse(file, says, *words, told=None, **more):
    cases.append({"file": file, "says": says, **(told or {}), "refused": list(words), **more})


# Text


def plain(value):
    """The fewest digits that read back to the same bits."""
    return repr(float(value))


def table(log, header=None, separator=",", form=plain, end="\n", trailing=False):
    """A table of text, written cell by cell. `form`: of all numbers, or by column."""
    of = form if isinstance(form, dict) else {name: form for name in log}
    lines = [separator.join(header or log)]
    lines += [separator.join(of[name](value) for name, value in zip(log, row)) for row in zip(*log.values())]
    return "".join(line + (separator if trailing else "") + end for line in lines)


def put(name, content, encoding="utf-8"):
    path = LOGS / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return name


def fixed(places):
    return lambda value: f"{value:.{places}f}"


def whole(value):
    return str(int(round(value)))


def comma(value):
    return plain(value).replace(".", ",")


def dialects():
    log = part(FAST)
    reference = "canonical.csv"
    pd.DataFrame(log).to_csv(LOGS / reference, index=False, lineterminator="\n")
    read(reference, "canonical names, comma; written by pandas", log, segments=1)

    def same(file, says, content=None, encoding="utf-8", **more):
        if content is not None:
            put(file, content, encoding)
        read(file, says, log, same_as=reference, **more)

    text = table(log)
    same("semicolon.csv", "semicolons", table(log, separator=";"))
    same("tab.tsv", "tabs", table(log, separator="\t"))
    same("comma_space.csv", "a space after each comma, in the header too", table(log, separator=", "))
    same("semicolon_space.csv", "a space after each semicolon", table(log, separator="; "))
    same("decimal_comma.csv", "semicolons and decimal commas; written by pandas",
         pd.DataFrame(log).to_csv(index=False, sep=";", decimal=",", lineterminator="\n"))
    same("decimal_comma_tab.csv", "tabs and decimal commas", table(log, separator="\t", form=comma))
    same("trailing_comma.csv", "a comma at the end of every line", table(log, trailing=True))
    same("trailing_semicolon.csv", "a semicolon at the end of every row but not of the header",
         table(log, separator=";", trailing=True).replace(";\n", "\n", 1))
    same("bom.csv", "a byte order mark", text, "utf-8-sig")
    same("utf16_le.csv", "UTF-16, little endian, with its mark", "\ufeff" + text, "utf-16-le")
    same("utf16_be.csv", "UTF-16, big endian, with its mark", "\ufeff" + text, "utf-16-be")
    same("gzip.csv.gz", "gzip", gzip.compress(text.encode(), mtime=0))
    same("gzip_by_content.csv", "gzip whose name does not say so", gzip.compress(text.encode(), mtime=0))
    same("cr.csv", "lines end with CR", table(log, end="\r"))
    same("crlf.csv", "lines end with CR LF", table(log, end="\r\n"))
    same("excel_german.csv", "what a German spreadsheet exports: UTF-8 with mark, semicolons, decimal commas, CR LF",
         table(log, separator=";", form=comma, end="\r\n"), "utf-8-sig")
    same("utf16_excel.txt", "'Unicode text' of a spreadsheet: UTF-16, tabs, decimal commas, CR LF",
         "\ufeff" + table(log, separator="\t", form=comma, end="\r\n"), "utf-16-le")
    same("sep_line.csv", "a spreadsheet's sep= line", "sep=;\r\n" + table(log, separator=";", end="\r\n"))
    same("comments.csv", "comment lines above the header", "# drive 3, at noon\n% second run\n\n" + text)
    same("comment_header.csv", "the header is a comment, as numpy writes it", "# " + text)
    same("timestamp_line.csv", "a timestamp above the header", "2019-04-23 11:04:34.846606\n" + text)
    same("title_line.csv", "a title above the header", "Motor bench 7 - run 12\n" + text)
    same("title_and_units.csv", "a timestamp, the names and a row of units, all with spaces after the commas",
         "2019-04-23 11:04:34.846606\n" + table(log, separator=", ").replace("\n", "\ns, V, V, A, A, rad/s\n", 1))
    same("units_row.csv", "a row of units below the header", text.replace("\n", "\ns,V,V,A,A,rad/s\n", 1))
    same("unit_brackets.csv", "name [unit]", table(log, ["t [s]", "ud [V]", "uq [V]", "id [A]", "iq [A]", "omega_e [rad/s]"]))
    same("unit_at.csv", "name@unit", table(log, ["t@s", "ud@V", "uq@V", "id@A", "iq@A", "omega_e@rad/s"], ";"))
    same("unit_parentheses.csv", "name (unit)", table(log, ["t (s)", "ud (V)", "uq (V)", "id (A)", "iq (A)", "omega_e (rad/s)"]))
    same("quoted.csv", "everything in quotes, as csv.QUOTE_ALL writes it",
         pd.DataFrame(log).to_csv(index=False, quoting=csv_module.QUOTE_ALL, lineterminator="\n"))
    same("index_column.csv", "a row number without a name first, as pandas writes it", pd.DataFrame(log).to_csv(lineterminator="\n"))
    shuffled = {"note": np.zeros(len(log["t"])), **{name: log[name] for name in reversed(NAMES)}, "extra": log["t"]}
    same("shuffled.csv", "columns in another order, and others among them", table(shuffled))
    same("scientific.csv", "numbers with exponents, 17 digits", table(log, form=lambda value: f"{value:.16e}"))
    same("blank_lines.csv", "blank lines and empty rows between the rows", text.replace("\n", "\n\n").replace("0.001,", ",,,,,\n0.001,", 1))

    prefixes = {"t_ms": log["t"] * 1e3, "ud_mV": log["ud"] * 1e3, "uq_mV": log["uq"] * 1e3, "id_mA": log["id"] * 1e3, "iq_mA": log["iq"] * 1e3,
                "omega_e_rpm": log["omega_e"] * RPM}
    places = {"t_ms": fixed(1), "ud_mV": whole, "uq_mV": whole, "id_mA": fixed(1), "iq_mA": fixed(1), "omega_e_rpm": fixed(3)}
    put("prefixed_units.csv", table(prefixes, form=places))
    # An ulp of each: the file's decimals are those of the source, thousandfold.
    small = {name: 1e-15 * float(np.max(np.abs(log[name]))) for name in NAMES[:5]}
    read("prefixed_units.csv", "ms, mV, mA and r/min in the names", log, tolerances={**small, "omega_e": 0.5e-3 / RPM}, notes=["r/min"])

    told = {"units": ["t=ms", "omega=rpm-mech"], "pole_pairs": POLE_PAIRS}
    put("units_by_argument.csv", table(changed(FAST, t=log["t"] * 1e3, omega_e=log["omega_e"] * RPM / POLE_PAIRS),
                                       form={**{name: plain for name in NAMES}, "t": fixed(1), "omega_e": fixed(3)}))
    read("units_by_argument.csv", "units that only the user knows", log, told=told,
         tolerances={"t": small["t"], "omega_e": 0.5e-3 / RPM * POLE_PAIRS})
    all_columns = {**log, "theta_e": decimals(FAST["theta_e"], 6), "u_dc": FAST["u_dc"]}
    put("optional_columns.csv", table(all_columns))
    read("optional_columns.csv", "angle and DC voltage besides", all_columns, names=[*NAMES, "theta_e", "u_dc"])


# Layouts of drives and their tools


VESC_COLUMNS = (
    "ms_today;input_voltage;temp_mos_max;temp_mos_1;temp_mos_2;temp_mos_3;temp_motor;current_motor;current_in;d_axis_current;q_axis_current;erpm;"
    "duty_cycle;amp_hours_used;amp_hours_charged;watt_hours_used;watt_hours_charged;tachometer;tachometer_abs;encoder_position;fault_code;vesc_id;"
    "d_axis_voltage;q_axis_voltage;ms_today_setup"
).split(";")


def vesc_tool(start_ms):
    """The motor's columns among those of VESC Tool, which ends every line with a semicolon. Time in ms of the day."""
    rows = len(SLOW["t"])
    ms = np.mod(start_ms + np.round(SLOW["t"] * 1e3), 86_400_000)
    log = {name: np.zeros(rows) for name in VESC_COLUMNS}
    log |= {"ms_today": ms, "input_voltage": SLOW["u_dc"], "temp_motor": np.full(rows, 31.5), "vesc_id": np.full(rows, 42.0), "ms_today_setup": ms,
            "current_motor": np.hypot(SLOW["id"], SLOW["iq"]), "d_axis_current": SLOW["id"], "q_axis_current": SLOW["iq"],
            "erpm": SLOW["omega_e"] * RPM, "d_axis_voltage": SLOW["ud"], "q_axis_voltage": SLOW["uq"]}
    form = {name: (lambda value: f"{value:g}") for name in log} | {"ms_today": whole, "ms_today_setup": whole, "erpm": fixed(1)}
    form |= {name: plain for name in ("input_voltage", "d_axis_current", "q_axis_current", "d_axis_voltage", "q_axis_voltage")}
    return table(log, separator=";", form=form, trailing=True)


def drives():
    slow = part(SLOW)
    midnight = 86_400_000
    for file, start, says, notes in [
        ("vesc_tool.csv", 43_200_000, "VESC Tool, at noon: ms of the day, electrical r/min, a semicolon at the end", ["r/min"]),
        ("vesc_tool_midnight.csv", midnight - 4_000, "VESC Tool, across midnight", ["midnight"]),
    ]:
        put(file, vesc_tool(start))
        t = (start + np.round(SLOW["t"] * 1e3)) / 1e3
        columns = {**slow, "t": t, "u_dc": SLOW["u_dc"]}
        # After midnight, adding a day may round once more than here.
        tolerances = {"omega_e": 0.05 / RPM, "t": 0.0 if start < midnight / 2 + 1 else 2e-11}
        read(file, says, columns, VESC_TOOL, tolerances, names=[*NAMES, "u_dc"], segments=1, notes=notes)

    # What VESC Express stores: key:name:unit:precision:relative:timestamp of each field, or the keys alone.
    fields = {"Input Voltage": ("V", SLOW["u_dc"]), "Current": ("A", np.hypot(SLOW["id"], SLOW["iq"])), "Duty": ("", np.full(len(SLOW["t"]), 0.2)),
              "RPM": ("", SLOW["omega_e"] * RPM), "Temp Fet": ("degC", np.full(len(SLOW["t"]), 41.2)), "kmh_vesc": ("km/h", SLOW["omega_e"] / 30.0),
              "iq": ("A", SLOW["iq"]), "id": ("A", SLOW["id"]), "vq": ("V", SLOW["uq"]), "vd": ("V", SLOW["ud"]), "t_day": ("s", 43_000.0 + SLOW["t"])}
    log = {key: values for key, (_, values) in fields.items()}
    for file, says, header in [
        ("vesc_express.csv", "VESC Express: six properties in each name, electrical r/min without a unit", [f"{key}:{key}:{unit}:2:0:{int(key == 't_day')}" for key, (unit, _) in fields.items()]),
        ("vesc_express_keys.csv", "the same with the keys alone, beside a duty cycle and the DC voltage", None),
    ]:
        put(file, table(log, header=header, separator=";"))
        read(file, says, {**slow, "t": log["t_day"], "u_dc": SLOW["u_dc"]}, VESC_EXPRESS, {"omega_e": 1e-12}, names=[*NAMES, "u_dc"], notes=["electrical r/min"])
    described = {f"{key}:{key}:{unit}:2:0:0": log[key] for key, (unit, _) in fields.items() if key not in ("Temp Fet", "t_day")}
    put("vesc_express_fields.csv", table({"t_day:Time:s:3:0:1": log["t_day"], **described}, separator=";"))
    read("vesc_express_fields.csv", "other fields of VESC Express, with the time mapped", slow, MAPPED, {"omega_e": 1e-12, "t": 1e-9}, names=NAMES[1:], told={"map": ["t=t_day"]}, notes=["electrical r/min"])

    # VESC Tool's sampled data: six digits, an angle in 250 steps (cut, not rounded), rows with a semicolon at the end, the header and the last
    # row's end without.
    i, u = phases(FAST["id"], FAST["iq"], FAST["theta_e"]), phases(FAST["ud"], FAST["uq"], FAST["theta_e"])
    v_zero = FAST["u_dc"] / 2.0
    degrees = np.floor(np.mod(FAST["theta_e"], 2 * np.pi) / (2 * np.pi) * 250.0) / 250.0 * 360.0
    sampled = {"T": FAST["t"], "I1": i[0], "I2": i[1], "I3": i[2], "V1": u[0] + v_zero, "V2": u[1] + v_zero, "V3": u[2] + v_zero,
               "I_tot": np.hypot(FAST["id"], FAST["iq"]), "V_zero": v_zero, "Phase": degrees}
    text = table(sampled, separator=";", form=lambda value: f"{value:g}", trailing=True)
    put("vesc_sampled.csv", text.replace(";\n", "\n", 1)[:-1])
    step = 2 * math.pi / 250.0
    swing = {"id": step * 4.5, "iq": step * 4.5, "ud": step * 60.0, "uq": step * 60.0, "omega_e": 40.0, "t": 0.0}
    read("vesc_sampled.csv", "VESC sampled data: phase quantities and an angle in steps of 1.44 degrees; the speed comes from the angle",
         part(FAST), VESC_SAMPLED, swing)

    # phobia: symbol@unit, a semicolon at the end.
    i, u = phases(SLOW["id"], SLOW["iq"], SLOW["theta_e"]), phases(SLOW["ud"], SLOW["uq"], SLOW["theta_e"])
    phobia = {"time@s": SLOW["t"], "IA@A": i[0], "IB@A": i[1], "IC@A": i[2], "UA@V": u[0], "UB@V": u[1], "UC@V": u[2], "DC@": SLOW["u_dc"] * 0 + 0.4,
              "lu_ID@A": SLOW["id"], "lu_IQ@A": SLOW["iq"], "lu_WS_RPM@rpm": SLOW["omega_e"] * RPM / POLE_PAIRS}
    form = {name: fixed(5) for name in phobia} | {"time@s": plain}
    put("phobia.csv", table(phobia, separator=";", form=form, trailing=True))
    told = {"pole_pairs": POLE_PAIRS}
    tolerances = {"ud": 2e-4, "uq": 2e-4, "omega_e": 0.5e-5 / RPM * POLE_PAIRS, "id": 1e-15, "iq": 1e-15}
    read("phobia.csv", "phobia: phase and dq currents (which tell the angle), phase voltages", slow, PHOBIA, tolerances, told=told)
    without = {name: values for name, values in phobia.items() if name not in ("UA@V", "UB@V", "UC@V", "IC@A")}
    put("phobia_default.csv", table(without, separator=";", form=form, trailing=True))
    refuse("phobia_default.csv", "phobia's default telemetry: no voltages", "ud", "uq", "missing", told=told, line=1)

    st = {"stm32_time_ms": 828_961 + np.round(SLOW["t"] * 1e3), "d6t_temp_c": SLOW["u_dc"] * 0 + 33.2, "ds18b20_temp_c": SLOW["u_dc"] * 0 + 26.25,
          "motor_ud_v": SLOW["ud"], "motor_uq_v": SLOW["uq"], "motor_speed_mech_rpm": SLOW["omega_e"] * RPM / POLE_PAIRS, "motor_id_a": SLOW["id"],
          "motor_iq_a": SLOW["iq"]}
    form = {name: fixed(3) for name in st} | {"stm32_time_ms": whole}
    put("st_mcsdk.csv", table(st, separator=";", form=form))
    tolerances = {"id": 0.5e-3, "iq": 0.5e-3, "omega_e": 0.5e-3 / RPM * POLE_PAIRS}
    columns = {**slow, "t": st["stm32_time_ms"] / 1e3}
    read("st_mcsdk.csv", "ST MCSDK, custom: mechanical r/min", columns, ST_MCSDK, tolerances, told=told)
    refuse(put("st_mcsdk_no_pole_pairs.csv", (LOGS / "st_mcsdk.csv").read_bytes()), "mechanical speed, and the number of pole pairs is not given", "pole",
           "state")

    emrax = {"time_s": 375.0 + SLOW["t"], "bus_voltage_V": SLOW["u_dc"], "bus_current_A": SLOW["u_dc"] * 0.01, "motor_id_A": SLOW["id"],
             "motor_iq_A": SLOW["iq"], "motor_vd_V": SLOW["ud"], "motor_vq_V": SLOW["uq"], "motor_velocity_rpm": SLOW["omega_e"] * RPM / POLE_PAIRS,
             "motor_current_command_pct": SLOW["u_dc"] * 0, "motor_temp_C": SLOW["u_dc"] * 0 + 33.0}
    form = {name: plain for name in emrax} | {"time_s": fixed(3), "motor_velocity_rpm": fixed(3), "bus_current_A": fixed(2)}
    put("tritium_time_s.csv", table(emrax, form=form))
    columns = {**slow, "t": decimals(emrax["time_s"], 3), "u_dc": SLOW["u_dc"]}
    tolerances = {"omega_e": 0.5e-3 / RPM * POLE_PAIRS}
    read("tritium_time_s.csv", "a Tritium drive in an EMRAX log: units in the names", columns, TRITIUM + ", names with units", tolerances, names=[*NAMES, "u_dc"], told=told)
    tritium = {"Time (s)": SLOW["t"], "MotorId (A)": SLOW["id"], "MotorIq (AImaginary)": SLOW["iq"], "MotorVd (V)": SLOW["ud"],
               "MotorVq (VImaginary)": SLOW["uq"], "MotorVelocity (rpm)": SLOW["omega_e"] * RPM / POLE_PAIRS, "BusVoltage (V)": SLOW["u_dc"]}
    put("tritium.csv", table(tritium, form={name: plain for name in tritium} | {"MotorVelocity (rpm)": fixed(3)}))
    read("tritium.csv", "Tritium's own names: AImaginary and VImaginary are A and V", {**slow, "u_dc": SLOW["u_dc"]}, TRITIUM, tolerances,
         names=[*NAMES, "u_dc"], told=told)

    paderborn = {"u_q": SLOW["uq"], "coolant": SLOW["u_dc"] * 0 + 18.7, "stator_winding": SLOW["u_dc"] * 0 + 19.8, "u_d": SLOW["ud"],
                 "stator_tooth": SLOW["u_dc"] * 0 + 18.8, "motor_speed": SLOW["omega_e"] * RPM / POLE_PAIRS, "i_d": SLOW["id"], "i_q": SLOW["iq"],
                 "pm": SLOW["u_dc"] * 0 + 20.9, "stator_yoke": SLOW["u_dc"] * 0 + 18.7, "ambient": SLOW["u_dc"] * 0 + 19.5,
                 "torque": 1.5 * POLE_PAIRS * (PSI_F + (LD - LQ) * SLOW["id"]) * SLOW["iq"], "profile_id": SLOW["u_dc"] * 0 + 17.0}
    form = {name: plain for name in paderborn} | {"motor_speed": fixed(4), "torque": fixed(4), "profile_id": whole}
    put("paderborn.csv", table(paderborn, form=form))
    tolerances = {"omega_e": 0.5e-4 / RPM * POLE_PAIRS}
    read("paderborn.csv", "Paderborn: no time column, rows at 2 Hz, mechanical r/min", slow, PADERBORN, tolerances, names=NAMES[1:], told=told,
         sample_period=0.5)
    without = {name: values for name, values in paderborn.items() if name != "u_q"}
    refuse(put("paderborn_no_uq.csv", table(without, form=form)), "Paderborn without u_q", "uq", "missing", told=told, line=1)
    scored = {name: (values - np.mean(values)) / max(float(np.std(values)), 1e-9) for name, values in paderborn.items()}
    refuse(put("paderborn_normalized.csv", table(scored, form=fixed(5))), "the older Paderborn file: every column with mean 0 and deviation 1",
           "normalized|standardized", "original", told=told)

    # Phase quantities with an angle.
    angle = np.mod(FAST["theta_e"], 2 * np.pi)
    i, u = phases(FAST["id"], FAST["iq"], angle), phases(FAST["ud"], FAST["uq"], angle)
    log = {"timeInS": FAST["t"], "i_aInA": i[0], "i_bInA": i[1], "i_cInA": i[2], "u_aInV": u[0], "u_bInV": u[1], "u_cInV": u[2], "epsilon_elInRad": angle}
    form = {name: fixed(6) for name in log} | {"timeInS": plain, "epsilon_elInRad": fixed(9)}
    put("phase_quantities.csv", table(log, form=form))
    # Half a unit of the last place in each of three phases, and of the angle; the speed is the angle's slope: ripple and corners round off.
    tolerances = {"id": 2e-6, "iq": 2e-6, "ud": 2e-6, "uq": 2e-6, "omega_e": 4.0}
    read("phase_quantities.csv", "phase quantities and the electrical angle: Clarke and Park inside", part(FAST), PHASES, tolerances,
         notes=["angle"])
    backward = -FAST["theta_e"]
    i, u = phases(FAST["id"], FAST["iq"], backward), phases(FAST["ud"], FAST["uq"], backward)
    log = {"timeInS": FAST["t"], "i_aInA": i[0], "i_bInA": i[1], "i_cInA": i[2], "u_aInV": u[0], "u_bInV": u[1], "u_cInV": u[2],
           "epsilon_elInRad": np.mod(backward, 2 * np.pi)}
    put("phase_quantities_backward.csv", table(log, form=form))
    read("phase_quantities_backward.csv", "the same, turning backward", changed(FAST, omega_e=-FAST["omega_e"]), PHASES, tolerances)
    without = {name: values for name, values in log.items() if name != "epsilon_elInRad"}
    refuse(put("phase_quantities_no_angle.csv", table(without, form=form)), "phase quantities without an angle", "angle|theta_e|epsilon", line=1)

    # Tables of test benches.
    dyno = {"TimeStamp": SLOW["t"], "Torque": paderborn["torque"], "Speed": paderborn["motor_speed"], "VqFiltered": SLOW["uq"],
            "VdFiltered": SLOW["ud"], "IqReq": SLOW["iq"], "WeakenedId": SLOW["id"]}
    form = {name: plain for name in dyno} | {"Torque": fixed(3), "Speed": fixed(2)}
    refuse(put("dyno_references.csv", table(dyno, form=form)), "a dyno table with current references in place of currents", "IqReq",
           "reference|measured", told=told)
    grid_d, grid_q = [axis.ravel() for axis in np.meshgrid(np.arange(-10.0, 1.0, 2.0), np.arange(0.0, 11.0, 2.0))]
    flux = {"I_d": grid_d, "I_q": grid_q, "Psi_d": LD * grid_d + PSI_F, "Psi_q": LQ * grid_q,
            "Trq_msr": 1.5 * POLE_PAIRS * ((LD * grid_d + PSI_F) * grid_q - LQ * grid_q * grid_d)}
    text = table(flux, form=fixed(5))
    refuse(put("flux_map.csv", text), "a measured flux map is no log", "flux map", line=1)
    refuse(put("flux_map_units_row.csv", text.replace("\n", "\nA,A,Vs,Vs,Nm\n", 1)), "the same with a row of units", "flux map", line=1)

    # ODrive's scripts: a timestamp, names, a row of units; everything with a space after the comma.
    names = ["Input voltage", "Test motor q-axis current", "Test motor d-axis current", "Output Torque", "Output Speed"]
    odrive = dict(zip(names, [SLOW["u_dc"], SLOW["iq"], SLOW["id"], paderborn["torque"] * 1e3, SLOW["omega_e"] / POLE_PAIRS]))
    text = "2019-04-23 11:04:34.846606\n" + table(odrive, separator=", ", form=fixed(4)).replace("\n", "\nV, A, A, N.mm, rad.s\n", 1)
    refuse(put("odrive_dyno.csv", text), "an ODrive dyno log: no time, no voltages", "ud", "uq", "missing|lacks|needed", told=told)
    odrive = {"Time": SLOW["t"], "Motor d voltage": SLOW["ud"], "Motor q voltage": SLOW["uq"], "Motor d current": SLOW["id"],
              "Motor q current": SLOW["iq"], "Output Speed": SLOW["omega_e"] / POLE_PAIRS}
    form = {name: plain for name in odrive} | {"Output Speed": fixed(5)}
    text = "2019-04-23 11:04:34.846606\n" + table(odrive, separator=", ", form=form).replace("\n", "\ns, V, V, A, A, rad.s\n", 1)
    put("odrive_with_voltages.csv", text)
    told = {"map": ["t=Time", "ud=Motor d voltage", "uq=Motor q voltage", "id=Motor d current", "iq=Motor q current", "omega=Output Speed"],
            "units": ["omega=rad/s-mech"], "pole_pairs": POLE_PAIRS}
    read("odrive_with_voltages.csv", "the same shape with all that is needed, named by the user", slow, MAPPED,
         {"omega_e": 0.5e-5 * POLE_PAIRS}, told=told)


# Traps


def traps():
    slow = part(SLOW)
    rows = len(slow["t"])

    zeros = 60
    still = {name: np.concatenate([np.zeros(zeros), values]) for name, values in slow.items()}
    still["t"] = decimals(np.arange(rows + zeros) * 0.05, 2)
    put("leading_standstill.csv", table(still))
    # Whether the rows at standstill are kept is the reader's affair: their sums are zero.
    read("leading_standstill.csv", "60 rows of zeros before the drive starts", notes=["standstill"])
    cases[-1]["columns"] = {name: {key: value for key, value in expect_column(still[name]).items() if key in ("last", "sum", "tolerance")}
                            for name in NAMES[1:]}

    frozen = slow["iq"].copy()
    frozen[100:140] = frozen[100]
    put("frozen_channel.csv", table(changed(SLOW, iq=frozen)))
    read("frozen_channel.csv", "iq stands still for 40 rows while everything else moves", notes=["iq", "froze", "40 rows are left out"], rows=160)

    # A CAN export: voltages in one message, currents in the next, the speed in a third.
    groups = [["ud", "uq"], ["id", "iq"], ["omega_e"]]
    lines = [",".join(NAMES)]
    for row in range(rows):
        group = groups[row % 3]
        lines.append(",".join([plain(slow["t"][row])] + [plain(slow[name][row]) if name in group else "" for name in NAMES[1:]]))
    put("can_alternating.csv", "\n".join(lines) + "\n")
    # Between the readings of a channel nothing is known: steady stretches agree within the ripple, ramps within what three rows change.
    read("can_alternating.csv", "each message has a row of its own: the other cells are empty", layout=CANONICAL, notes=["interpolat", "instant"])
    cases[-1]["within"] = {name: {"reference": "slow.csv", "tolerance": tolerance} for name, tolerance in
                           {"ud": 3.0, "uq": 6.0, "id": 0.5, "iq": 0.8, "omega_e": 25.0}.items()}
    put("slow.csv", table(slow))
    read("slow.csv", "telemetry at 20 Hz", slow, segments=1)

    t = np.where(np.arange(rows) < 90, SLOW["t"], decimals(SLOW["t"] + 4.0, 2))
    put("gap.csv", table(changed(SLOW, t=t)))
    read("gap.csv", "a gap of 4 s", changed(SLOW, t=t), segments=2, notes=["gap"])

    # Backward: i_q, u_q and the speed change sign, u_d and i_d keep theirs.
    backward = changed(SLOW, uq=-SLOW["uq"], iq=-SLOW["iq"], omega_e=-SLOW["omega_e"])
    put("negative_speed.csv", table(backward))
    read("negative_speed.csv", "turning backward", backward)

    references = {"t": slow["t"], "ud_ref": slow["ud"], "uq_ref": slow["uq"], "id": slow["id"], "iq": slow["iq"], "omega_e": slow["omega_e"]}
    put("voltage_references.csv", table(references))
    read("voltage_references.csv", "voltage references, which most drives log", slow, notes=["ud_ref"])
    both = {**slow, "id_ref": slow["id"] * 0 - 1.0, "iq_ref": slow["iq"] * 0 + 3.0, "ud_ref": slow["ud"] + 1.0, "uq_ref": slow["uq"] + 1.0}
    put("references_besides.csv", table(both))
    read("references_besides.csv", "references besides the measured values: the measured ones are taken", slow, same_as="slow.csv")

    renamed = dict(zip(["t", "ud", "uq", "id_ref", "iq_ref", "omega_e"], slow.values()))
    refuse(put("current_references.csv", table(renamed)), "current references in place of currents", "id_ref", "reference|measured", line=1)
    refuse(put("missing_voltages.csv", table({name: slow[name] for name in ("t", "id", "iq", "omega_e")})), "no voltages", "ud", "uq", "missing", line=1)
    scored = {name: (values - values.mean()) / values.std() for name, values in slow.items() if name != "t"}
    refuse(put("normalized.csv", table({"t": slow["t"], **scored})), "standardized data", "normalized|standardized", "original")

    text = table(slow)
    lines = text.splitlines()
    refuse(put("duplicate_header.csv", text.replace("omega_e", "iq", 1)), "two columns are called iq", "iq", "twice|2 times|missing", line=1)
    spoil = [*lines[:50], lines[50].replace(plain(slow["uq"][49]), "NaN"), *lines[51:]]
    refuse(put("nan_cell.csv", "\n".join(spoil) + "\n"), "NaN in uq", "uq", "nan|finite", line=51)
    spoil = [*lines[:50], lines[50].replace(plain(slow["id"][49]), "error"), *lines[51:]]
    refuse(put("text_cell.csv", "\n".join(spoil) + "\n"), "a word in id", "id", "error", "not a number", line=51)
    spoil = [*lines[:50], lines[50].replace(plain(slow["id"][49]), ""), *lines[51:]]
    refuse(put("empty_cell.csv", "\n".join(spoil) + "\n"), "one empty cell in id", "id", "empty", line=51)
    still = slow["t"].copy()
    still[60] = still[59]
    refuse(put("time_stands_still.csv", table(changed(SLOW, t=still))), "two rows at the same time", "time|t ", "increase|still", line=62)
    back = slow["t"].copy()
    back[60] -= 1.0
    refuse(put("time_runs_backward.csv", table(changed(SLOW, t=back))), "a row in the past", "time|t ", "increase|backward", line=62)
    put("truncated_row.csv", text[:-18])
    read("truncated_row.csv", "the last line is cut off, as where the power went", {name: values[:-1] for name, values in slow.items()}, CANONICAL,
         notes=["cut off"])
    refuse(put("empty.csv", b""), "an empty file", "empty")
    garbage = bytes((k * k * 7 + k * 13 + (k >> 3)) % 256 for k in range(2000))
    refuse(put("garbage.bin", garbage), "bytes without meaning", "binary|not text|no log")
    refuse(put("header_only.csv", lines[0] + "\n"), "a header and no rows", "no row", line=1)
    thousands = {name: (lambda value: f"{value:,.3f}") for name in NAMES}
    many = changed(SLOW, omega_e=SLOW["omega_e"] * 10.0)
    refuse(put("thousands.csv", table(many, separator=";", form=thousands)), "thousands separators: 2,000.000", "2,000.000", "separator|mark", line=2)
    mixed = [line.replace(".", ",") if number > 30 else line for number, line in enumerate(table(slow, separator=";").splitlines())]
    refuse(put("mixed_marks.csv", "\n".join(mixed) + "\n"), "decimal points, and from line 32 on decimal commas", "decimal", "mark", line=32)
    refuse(put("numbers_without_header.csv", "\n".join(lines[1:]) + "\n"), "rows without a header", "header", "numbers", line=1)
    refuse(put("all_zero_speed.csv", table(changed(SLOW, omega_e=slow["omega_e"] * 0.0))), "the speed is zero throughout", "omega_e", "zero")
    clock = {"t": slow["t"], **{name: slow[name] for name in NAMES[1:]}}
    form = {name: plain for name in NAMES} | {"t": lambda value: f"11:04:{value:06.3f}"}
    read(put("clock_time.csv", table(clock, form=form)), "time of the day, as a clock shows it", slow,
         tolerances={"t": 1.0}, names=NAMES[1:], notes=["time of day"])
    refuse(put("truncated.csv.gz", gzip.compress(text.encode(), mtime=0)[:-700]), "a gzip file that was cut off", "gzip|compressed", "cut|end|incomplete|damaged")


# Parquet


def parquet():
    fast = part(FAST)
    frame = pa.table({name: pa.array(values, pa.float64()) for name, values in fast.items()})

    def put_table(file, content, **options):
        pq.write_table(content, LOGS / file, **options)
        return file

    for codec in ("NONE", "SNAPPY", "GZIP", "ZSTD", "LZ4"):
        file = put_table(f"{codec.lower()}.parquet", frame, compression=codec)
        read(file, f"Parquet, compression {codec}; written by pyarrow", fast, same_as="canonical.csv")
    put_table("row_groups.parquet", frame, row_group_size=37, use_dictionary=False, data_page_version="2.0", compression="ZSTD")
    read("row_groups.parquet", "row groups of 37 rows, pages of version 2, no dictionary", fast, same_as="canonical.csv")
    put_table("byte_stream_split.parquet", frame, use_dictionary=False, use_byte_stream_split=True, compression="SNAPPY")
    read("byte_stream_split.parquet", "encoded as byte streams", fast, same_as="canonical.csv")
    pd.DataFrame({**fast, "note": ["warm"] * len(fast["t"])}).to_parquet(LOGS / "pandas.parquet")
    read("pandas.parquet", "written by pandas, with a column of text", fast, same_as="canonical.csv")

    single = {name: values.astype(np.float32) for name, values in fast.items() if name != "t"}
    put_table("float32.parquet", pa.table({"t": fast["t"], **single}))
    read("float32.parquet", "floats of 32 bits but for the time", {"t": fast["t"], **{name: values.astype(np.float64) for name, values in single.items()}})
    microseconds = np.round(fast["t"] * 1e6).astype(np.int64)
    rest = {name: fast[name] for name in NAMES[1:]}
    put_table("integer_time.parquet", pa.table({"t_us": microseconds, **rest}))
    read("integer_time.parquet", "time in whole microseconds", {**fast, "t": microseconds / 1e6}, notes=["us"])
    start = np.datetime64("2026-01-02T03:04:05", "ns")
    put_table("timestamps.parquet", pa.table({"t": pa.array(start + microseconds * np.timedelta64(1000, "ns")), **rest}))
    read("timestamps.parquet", "time as timestamps: seconds from the first row on", {**fast, "t": microseconds / 1e6})

    nulls = {name: pa.array(values, pa.float64(), mask=(np.arange(len(values)) == 20) if name == "iq" else None) for name, values in fast.items()}
    refuse(put_table("null_cell.parquet", pa.table(nulls)), "a null in iq", "iq", "null|empty", "20|21")
    refuse(put_table("missing_columns.parquet", frame.drop_columns(["ud", "uq"])), "Parquet without voltages", "ud", "uq", "missing")
    text = pa.table({**fast, "iq": pa.array([plain(value) for value in fast["iq"]])})
    refuse(put_table("text_column.parquet", text), "iq is a column of text", "iq", "number|numeric|text|string")
    refuse(put("truncated.parquet", (LOGS / "snappy.parquet").read_bytes()[:-500]), "a Parquet file that was cut off", "parquet", "cut|end|incomplete|damaged|short|corrupt")


# MAT


def put_mat(file, content, **options):
    """scipy's MAT v5 with the date in its title replaced: the same bytes on every day."""
    buffer = io.BytesIO()
    scipy.io.savemat(buffer, content, **options)
    title = b"MATLAB 5.0 MAT-file, written by scipy for fluxfit's corpus"
    return put(file, title.ljust(116) + buffer.getvalue()[116:])


def put_hdf5(file, fill):
    """MATLAB's v7.3: an HDF5 file behind a title of 512 bytes."""
    path = LOGS / file
    with h5py.File(path, "w", userblock_size=512, libver=("earliest", "v108")) as target:
        fill(target)
    title = b"MATLAB 7.3 MAT-file, written by h5py for fluxfit's corpus".ljust(116) + bytes(8) + struct.pack("<H", 0x0200) + b"IM"
    path.write_bytes(title.ljust(512, b"\0") + path.read_bytes()[512:])
    return file


def dataset(parent, name, values, **options):
    # MATLAB stores a column of n rows as 1 x n.
    target = parent.create_dataset(name, data=np.asarray(values)[None, :], **options)
    target.attrs["MATLAB_class"] = np.bytes_("double")


def opaque(name, kind):
    """A MAT v5 file with an object of a class, as MATLAB saves a timeseries: names, and a number that points elsewhere."""

    def element(type_number, content):
        return struct.pack("<II", type_number, len(content)) + content + bytes(-len(content) % 8)

    def matrix(flags, *parts):
        return element(14, element(6, struct.pack("<II", flags, 0)) + b"".join(parts))

    pointer = matrix(13, element(5, struct.pack("<ii", 6, 1)), element(1, b""), element(6, struct.pack("<6I", 0xDD000000, 2, 1, 1, 1, 1)))
    body = matrix(17, element(1, name), element(1, b"MCOS"), element(1, kind), pointer)
    return b"MATLAB 5.0 MAT-file, written for fluxfit's corpus".ljust(116) + bytes(8) + struct.pack("<H", 0x0100) + b"IM" + body


def mat():
    fast = part(FAST)
    for compressed in (False, True):
        file = put_mat(f"vectors_v5{'_compressed' if compressed else ''}.mat", {**fast, "comment": "bench 7", "p": 4.0},
                       do_compression=compressed, oned_as="column")
        read(file, f"MAT v5, a vector a channel, {'compressed' if compressed else 'plain'}; written by scipy", fast, same_as="canonical.csv")
    put_mat("row_vectors_v5.mat", fast, oned_as="row")
    read("row_vectors_v5.mat", "MAT v5, row vectors", fast, same_as="canonical.csv")
    put_mat("struct_v5.mat", {"log": fast}, oned_as="column")
    read("struct_v5.mat", "MAT v5, one struct with a field a channel", fast, same_as="canonical.csv")
    single = {name: values.astype(np.float32) if name != "t" else values for name, values in fast.items()}
    put_mat("single_v5.mat", single, oned_as="column", do_compression=True)
    read("single_v5.mat", "MAT v5, single precision but for the time", {name: values.astype(np.float64) for name, values in single.items()})

    signals = np.zeros((5,), dtype=[("values", object), ("dimensions", object), ("label", object), ("blockName", object)])
    for row, name in enumerate(NAMES[1:]):
        signals[row] = (fast[name][:, None], 1.0, name, f"drive/{name}")
    put_mat("simulink_v5.mat", {"logsout": {"time": fast["t"][:, None], "signals": signals, "blockName": "drive/Scope"}})
    read("simulink_v5.mat", "Simulink's 'structure with time': time, signals.values, signals.label", fast, same_as="canonical.csv")

    put_hdf5("vectors_v73.mat", lambda target: [dataset(target, name, values) for name, values in fast.items()])
    read("vectors_v73.mat", "MAT v7.3, a vector a channel; written by h5py with MATLAB's attributes", fast, same_as="canonical.csv")
    put_hdf5("vectors_v73_deflate.mat", lambda target: [dataset(target, name, values, compression="gzip", shuffle=False, chunks=(1, 80))
                                                        for name, values in fast.items()])
    read("vectors_v73_deflate.mat", "MAT v7.3, chunks that are compressed", fast, same_as="canonical.csv")

    def struct_v73(target):
        group = target.create_group("log")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in fast.items():
            dataset(group, name, values)

    put_hdf5("struct_v73.mat", struct_v73)
    read("struct_v73.mat", "MAT v7.3, one struct", fast, same_as="canonical.csv")

    def timeseries_v73(target):
        for name in NAMES[1:]:
            holder = target.create_dataset(name, data=np.array([[0xDD000000, 2, 1, 1, 1, 1]], dtype=np.uint32))
            holder.attrs["MATLAB_class"] = np.bytes_("timeseries")
            holder.attrs["MATLAB_object_decode"] = np.int32(3)

    words = ("timeseries", "export|save|.Time")
    refuse(put_hdf5("timeseries_v73.mat", timeseries_v73), "MAT v7.3 with timeseries, which are objects", *words)
    put("timeseries_v5.mat", opaque(b"logsout", b"timeseries"))
    scipy.io.loadmat(LOGS / "timeseries_v5.mat")  # another reader takes it for what it is
    refuse("timeseries_v5.mat", "MAT v5 with a timeseries, which is an object", *words)

    # Not a log, but an open-circuit table: 60 mWb at 3 pole pairs.
    speed = np.linspace(500.0, 4000.0, 8)
    bench = put_mat("table_beside_timetable.mat", {"speed_rpm": speed, "Ull_V": speed * 3 / RPM * 0.06 * math.sqrt(1.5)}, oned_as="column")
    with open(LOGS / bench, "ab") as target:
        target.write(opaque(b"drive", b"timetable")[128:])
    refuse(bench, "a workspace with a timetable and the vectors of a bench, read as a log", "timetable object, which only MATLAB can read")

    i_d, i_q = np.meshgrid(np.arange(-10.0, 1.0, 2.0), np.arange(0.0, 11.0, 2.0))
    # SyR-e's axes: d and q swapped.
    fluxes = {"Id": i_q, "Iq": -i_d, "Fd": LQ * i_q, "Fq": -(LD * i_d + PSI_F), "T": 0.0 * i_d}
    put_mat("syre_flux_map.mat", {"motorModel": {"FluxMap_dq": fluxes, "data": {"p": 4.0, "Rs": RS}}})
    refuse("syre_flux_map.mat", "a motor model of SyR-e: a flux map is no log", "flux map")
    put_mat("missing_voltages.mat", {name: fast[name] for name in ("t", "id", "iq", "omega_e")}, oned_as="column")
    refuse("missing_voltages.mat", "MAT v5 without voltages", "ud", "uq", "missing")
    put_mat("unequal_lengths.mat", {**fast, "uq": fast["uq"][:-3]}, oned_as="column")
    refuse("unequal_lengths.mat", "uq has three values less than the others", "uq", "157")
    refuse(put("truncated.mat", (LOGS / "vectors_v5.mat").read_bytes()[:4000]), "a MAT file that was cut off", "MAT file|MAT v5|MATLAB", "cut|end|incomplete|damaged|short|corrupt")


# MDF4


def put_mdf(file, groups, **options):
    """asammdf's MDF4, with fixed instants in place of today's."""
    moment = datetime(2026, 1, 2, 3, 4, 5, tzinfo=timezone.utc)
    with asammdf.MDF(version="4.10") as target:
        target.start_time = moment
        for timestamps, channels in groups:
            target.append([asammdf.Signal(samples=values, timestamps=timestamps, name=name, unit=unit) for name, (values, unit) in channels.items()],
                          comment="drive")
        path = target.save(LOGS / file, overwrite=True, **options)
    content = bytearray(Path(path).read_bytes())
    at = content.find(b"##FH")
    while at >= 0:  # id, reserved, length, number of links; links; the time of the change
        links = struct.unpack_from("<Q", content, at + 16)[0]
        struct.pack_into("<Q", content, at + 24 + 8 * links, int(moment.timestamp()) * 10**9)
        at = content.find(b"##FH", at + 4)
    return put(file, bytes(content))


UNITS = {"ud": "V", "uq": "V", "id": "A", "iq": "A", "omega_e": "rad/s"}


def mdf():
    fast, slow = part(FAST), part(SLOW)
    needs = {"needs": "mdf4"}
    channels = {name: (fast[name], UNITS[name]) for name in NAMES[1:]}
    put_mdf("one_group.mf4", [(fast["t"], channels)])
    read("one_group.mf4", "MDF4, one group: time is its master channel; written by asammdf", fast, same_as="canonical.csv", **needs)
    put_mdf("one_group_compressed.mf4", [(fast["t"], channels)], compression=2)
    read("one_group_compressed.mf4", "MDF4, transposed and deflated blocks", fast, same_as="canonical.csv", **needs)
    twice = slice(None, None, 2)
    put_mdf("two_rates.mf4", [(slow["t"], {name: (slow[name], UNITS[name]) for name in NAMES[1:5]}),
                              (slow["t"][twice], {"omega_e": (slow["omega_e"][twice], "rad/s")})])
    read("two_rates.mf4", "MDF4, two groups: the speed at half the rate", slow, names=NAMES[:5], notes=["interpolat", "omega_e"], rows=[199, 200], **needs)
    for name in NAMES[:5]:
        # The last row lies behind the last reading of the speed: the reader may drop it.
        cases[-1]["columns"][name] = {"first": float(slow[name][0]), "tolerance": 0.0}
    cases[-1]["within"] = {"omega_e": {"reference": "slow.csv", "tolerance": 6.0}}
    project = {"Inv_Ud_act": (fast["ud"], "V"), "Inv_Uq_act": (fast["uq"], "V"), "Inv_Id_act": (fast["id"], "A"), "Inv_Iq_act": (fast["iq"], "A"),
               "EM_n_rotor": (fast["omega_e"] * RPM / POLE_PAIRS, "1/min")}
    put_mdf("project_names.mf4", [(fast["t"], project)])
    mapping = put_mapping("project_names.toml", {name: {"column": column} for name, column in zip(NAMES[1:], project)},
                          units={"omega_e": "rpm-mech"})
    tolerances = {"omega_e": 1e-15 * 4.0 * float(np.max(fast["omega_e"]))}
    read("project_names.mf4", "MDF4 with a project's own names, and a mapping file", fast, MAPPED, tolerances, told={"mapping": mapping}, **needs)
    refuse(put("truncated.mf4", (LOGS / "one_group.mf4").read_bytes()[:3000]), "an MDF4 file that was cut off", "mdf", "cut|end|incomplete|damaged|short", **needs)


# Mapping files


def put_mapping(file, columns, pole_pairs=POLE_PAIRS, park=None, units=None):
    """The one place that knows how a mapping file is written."""
    lines = [f"pole_pairs = {pole_pairs}"]
    lines += [f'park = "{park}"'] if park else []
    for name, entry in columns.items():
        entry = {**entry, **({"unit": units[name]} if units and name in units else {})}
        pairs = ", ".join(f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}" for key, value in entry.items())
        lines += ([] if any(line == "[columns]" for line in lines) else ["", "[columns]"]) + [f"{name} = {{ {pairs} }}"]
    MAPPINGS.mkdir(exist_ok=True)
    (MAPPINGS / file).write_text("\n".join(lines) + "\n")
    return f"mappings/{file}"


def mappings():
    slow = part(SLOW)
    renamed = {"Zeit": np.round(slow["t"] * 1e3), "USd": slow["ud"], "USq": slow["uq"], "ISd": slow["id"], "ISq": slow["iq"],
               "Drehzahl": slow["omega_e"] * RPM / POLE_PAIRS}
    form = {name: plain for name in renamed} | {"Zeit": whole, "Drehzahl": fixed(4)}
    put("mapped_names.csv", table(renamed, separator=";", form={name: (lambda f: lambda value: f(value).replace(".", ","))(f) for name, f in form.items()}))
    columns = {name: {"column": column} for name, column in zip(NAMES, renamed)}
    units = {"t": "ms", "omega_e": "rpm-mech"}
    tolerance = {"omega_e": 0.5e-4 / RPM * POLE_PAIRS}
    read("mapped_names.csv", "names of no layout, and a mapping file with names and units", slow, MAPPED, tolerance,
         told={"mapping": put_mapping("mapped_names.toml", columns, units=units)})

    # Counts of a converter, the other sense of current and q, and the power-invariant transform.
    root = math.sqrt(1.5)
    odd = {"zeit_s": slow["t"], "u1": slow["ud"] * root, "u2": -slow["uq"] * root, "i1": np.round(slow["id"] * root / 0.01),
           "i2": -np.round(slow["iq"] * root / 0.01), "w": slow["omega_e"]}
    put("mapped_scale_sign_park.csv", table(odd, form={name: plain for name in odd} | {"u1": fixed(6), "u2": fixed(6)}))
    columns = {"t": {"column": "zeit_s"}, "ud": {"column": "u1"}, "uq": {"column": "u2", "sign": -1}, "id": {"column": "i1", "scale": 0.01},
               "iq": {"column": "i2", "scale": 0.01, "sign": -1}, "omega_e": {"column": "w"}}
    tolerance = {"id": 0.5001 * 0.01 / root, "iq": 0.5001 * 0.01 / root, "ud": 0.5001e-6 / root, "uq": 0.5001e-6 / root}
    read("mapped_scale_sign_park.csv", "a mapping file with scales, signs and the power-invariant Park transform", slow, MAPPED, tolerance,
         told={"mapping": put_mapping("mapped_scale_sign_park.toml", columns, park="power-invariant")})
    columns = {**columns, "uq": {"column": "u_q_soll"}}
    put("mapped_missing.csv", (LOGS / "mapped_scale_sign_park.csv").read_bytes())
    refuse("mapped_missing.csv", "a mapping file that names a column which the log has not", "u_q_soll", "uq",
           told={"mapping": put_mapping("mapped_missing.toml", columns)})


# Writing expected.toml


def toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        assert math.isfinite(value)
        return repr(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"


def main():
    for folder in (LOGS, MAPPINGS):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
    for write in (dialects, drives, traps, parquet, mat, mdf, mappings):
        write()
    tools.write(sys.modules[__name__])
    instruments.write(sys.modules[__name__])
    guesses.write(sys.modules[__name__])
    lines = ["# Written by make.py, which says what the keys mean.\n"]
    for case in cases:
        lines.append("\n[[case]]\n")
        lines += [f"{key} = {toml(value)}\n" for key, value in case.items() if key not in ("columns", "within")]
        for kind in ("columns", "within"):
            lines += [f"{kind}.{name} = {toml(value)}\n" for name, value in case.get(kind, {}).items()]
    (HERE / "expected.toml").write_text("".join(lines))
    files = sorted(path.name for path in LOGS.iterdir())
    named = [case["file"] for case in cases]
    assert sorted(named) == files, set(files) ^ set(named)
    largest = max(LOGS.iterdir(), key=lambda path: path.stat().st_size)
    assert largest.stat().st_size <= LARGEST, largest
    print(f"{len(cases)} cases, {sum(path.stat().st_size for path in LOGS.iterdir()) // 1000} kB, largest {largest.name}")


if __name__ == "__main__":
    main()

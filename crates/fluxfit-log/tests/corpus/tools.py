"""The corpus, continued: files as tools write them. make.py calls write(make), with itself; its logs, helpers and keys of cases are used here.

pandas, numpy, json, scipy, h5py, python-can, cantools and mat-io write; what is expected comes from the arrays that were given to them.
"""


import json

import can
import cantools
import h5py
import numpy as np
import pandas as pd


def write(make):
    for part in (dates, epochs, names, headers, records, lvm, frames, hdf5, owners, duties):
        part(make)


# Times


def dates(make):
    fast, slow = make.part(make.FAST), make.part(make.SLOW)
    start = pd.Timestamp("2016-02-12 23:59:58.5")
    rest = make.NAMES[1:]

    def dated(log, form, file, says, resolution, zone=None, **more):
        """A log whose times are dates, as a form of strftime or a function writes them."""
        instants = [start + pd.Timedelta(nanoseconds=int(round(t * 1e9))) for t in log["t"]]
        if zone:
            instants = [instant.tz_localize(zone) for instant in instants]
        texts = [form(instant) if callable(form) else instant.strftime(form) for instant in instants]
        frame = pd.DataFrame({"time": texts} | {name: log[name] for name in rest})
        frame.to_csv(make.LOGS / file, index=False, lineterminator="\n", **more)
        make.read(file, says, log, layout=make.CANONICAL, tolerances={"t": resolution}, notes=["dates"])

    dated(fast, lambda at: at.isoformat(), "dates_iso.csv", "ISO 8601, as pandas writes a Timestamp", 1e-9)
    dated(fast, lambda at: at.isoformat(), "dates_iso_zone.csv", "ISO 8601 with the zone of Berlin", 1e-9, zone="Europe/Berlin")
    dated(fast, "%Y-%m-%dT%H:%M:%S.%fZ", "dates_iso_utc.csv", "ISO 8601 with Z", 1e-6)
    dated(fast, "%Y-%m-%d %H:%M:%S.%f+0100", "dates_offset.csv", "a date, a space, a time and an offset without a colon", 1e-6)
    dated(slow, lambda at: f"{at.month}/{at.day}/{at.year} {at.strftime('%H:%M:%S.%f')}", "dates_us.csv", "month/day/year over midnight", 1e-6)
    dated(slow, lambda at: f"{at.day}/{at.month}/{at.year} {at.strftime('%H:%M:%S.%f')[:-3]}", "dates_british.csv", "day/month/year over midnight", 1e-3)
    dated(slow, lambda at: at.strftime("%m/%d/%Y %I:%M:%S.%f %p"), "dates_am_pm.csv", "month/day/year with AM and PM", 1e-6)
    dated(slow, lambda at: at.strftime("%d.%m.%Y %H:%M:%S,%f"), "dates_german.csv", "a German date, with a decimal comma", 1e-6, sep=";", decimal=",")
    dated(slow, "%d-%b-%Y %H:%M:%S.%f", "dates_matlab.csv", "a date as MATLAB shows it", 1e-6)
    frame = pd.DataFrame({name: fast[name] for name in rest}, index=pd.DatetimeIndex(start + pd.to_timedelta(np.round(fast["t"] * 1e9).astype("i8"), unit="ns")))
    frame.to_csv(make.LOGS / "dates_index.csv", lineterminator="\n")
    make.read("dates_index.csv", "a DatetimeIndex of pandas, whose column has no name", fast, tolerances={"t": 1e-9}, notes=["dates"])
    minutes = dict(slow, t=np.arange(len(slow["t"])) * 60.0)
    texts = [(pd.Timestamp("2016-02-12 10:31") + pd.Timedelta(minutes=k)).strftime("%d/%m/%Y %H:%M") for k in range(len(slow["t"]))]
    pd.DataFrame({"Time": texts} | {name: slow[name] for name in rest}).to_csv(make.LOGS / "dates_minutes.csv", index=False, lineterminator="\n")
    make.read("dates_minutes.csv", "a row a minute, without seconds: over midnight the day tells itself from the month", minutes, notes=["dates"])


def epochs(make):
    fast = make.part(make.FAST)
    rest = make.NAMES[1:]
    start = 1_455_321_598_500_000_000
    instants = [start + int(round(t * 1e9)) for t in fast["t"]]
    for name, digits, says in [("s", 9, "seconds"), ("ms", 6, "milliseconds"), ("us", 3, "microseconds"), ("ns", 0, "nanoseconds")]:
        text = [str(at)[: len(str(at)) - digits] + ("." + str(at)[-digits:].rstrip("0").ljust(1, "0") if digits and digits != 3 else "") for at in instants]
        file = f"epoch_{name}.csv"
        pd.DataFrame({"timestamp": text} | {key: fast[key] for key in rest}).to_csv(make.LOGS / file, index=False, lineterminator="\n")
        make.read(file, f"{says} since 1970, and nothing that says so", fast, notes=[says], same_as="canonical.csv")
    counts = {"micros": np.round(fast["t"] * 1e6).astype(int)} | {name: fast[name] for name in rest}
    make.put("unit_is_the_name.csv", make.table(counts, form={name: make.plain for name in counts} | {"micros": str}))
    make.read("unit_is_the_name.csv", "the name of the time is its unit", fast, same_as="canonical.csv", notes=["us"])
    counts = {"time_ns": np.round(fast["t"] * 1e9).astype(int)} | {name: fast[name] for name in rest}
    make.put("nanoseconds.csv", make.table(counts, form={name: make.plain for name in counts} | {"time_ns": str}))
    make.read("nanoseconds.csv", "nanoseconds since the start", fast, same_as="canonical.csv", notes=["ns"])
    counts = {"timestamp": np.round(fast["t"] * 1e6).astype(int)} | {name: fast[name] for name in rest}
    make.put("unstated_counts.csv", make.table(counts, form={name: make.plain for name in counts} | {"timestamp": str}))
    make.refuse("unstated_counts.csv", "whole numbers in steps of 100 without a unit: nobody knows of what", "timestamp|times", "whole numbers", "100", "state it")


# Names


def names(make):
    fast, slow = make.part(make.FAST), make.part(make.SLOW)
    poles = {"pole_pairs": make.POLE_PAIRS}
    rpm = {"omega_e": 1e-15 * 4.0 * float(np.max(fast["omega_e"])) + 1e-12}

    def renamed(file, says, columns, form=None, told=None, tolerances=None, notes=("usual names",), **more):
        make.put(file, make.table(columns, form=({name: make.plain for name in columns} | (form or {})), **more))
        make.read(file, says, fast, tolerances=tolerances, told=told, notes=list(notes))

    def with_names(speed, *names, log=fast):
        return dict(zip(names, [log["t"], log["ud"], log["uq"], log["id"], log["iq"], speed]))

    mechanical = fast["omega_e"] * make.RPM / make.POLE_PAIRS
    renamed("names_german.csv", "German names and units",
            with_names(mechanical, "Zeit [s]", "Spannung d [V]", "Spannung q [V]", "Strom d [A]", "Strom q [A]", "Drehzahl [1/min]"), told=poles, tolerances=rpm)
    renamed("names_measured.csv", "names with what was measured, and electrical r/min",
            with_names(fast["omega_e"] * make.RPM, "time_s", "vd_meas", "vq_meas", "id_meas", "iq_meas", "erpm"), tolerances=rpm)
    renamed("names_underscores.csv", "u_d and i_q", with_names(fast["omega_e"], "time", "u_d", "u_q", "i_d", "i_q", "omega_el [rad/s]"))
    renamed("names_axes.csv", "axes in words", with_names(fast["omega_e"] * make.RPM, "Time (s)", "d-axis voltage (V)", "q-axis voltage (V)", "d-axis current (A)",
                                                       "q-axis current (A)", "electrical speed (rpm)"), tolerances=rpm)
    renamed("names_french.csv", "French names", with_names(mechanical, "temps [s]", "tension d [V]", "tension q [V]", "courant d [A]", "courant q [A]", "vitesse [rpm]"),
            told=poles, tolerances=rpm)
    path = "Model Root/FOC/"
    renamed("names_paths.csv", "paths of a model, as ControlDesk exports them, and the time as x axis",
            with_names(mechanical, "x-axis", f"{path}ud/Out1", f"{path}uq/Out1", f"{path}id/Out1", f"{path}iq/Out1", "Model Root/n_mech/Out1 [1/min]"),
            told=poles, tolerances=rpm, separator=";")
    renamed("names_blocks.csv", "names behind a colon, as PLECS writes them",
            with_names(fast["omega_e"], "Time", "Machine: v_d", "Machine: v_q", "Machine: i_d", "Machine: i_q", "Machine: electrical speed (rad/s)"))
    renamed("names_simulink.csv", "bus signals in angle brackets",
            with_names(fast["omega_e"] / make.POLE_PAIRS, "time", "<Stator voltage vs_d (V)>", "<Stator voltage vs_q (V)>", "<Stator current is_d (A)>",
                       "<Stator current is_q (A)>", "<Rotor mechanical speed wm (rad/s)>"), told=poles, tolerances=rpm)
    renamed("names_units_alone.csv", "axes and units alone, within structures",
            with_names(mechanical / 60.0, "timestamp", "servo_control.d_V", "servo_control.q_V", "servo_stats.d_A", "servo_stats.q_A", "servo_stats.velocity [turns/s]"),
            told=poles, tolerances=rpm)
    renamed("names_motor_1.csv", "a number of the motor, and tabs",
            with_names(mechanical, "Time [s]", "M1_Ud [V]", "M1_Uq [V]", "M1_Id [A]", "M1_Iq [A]", "M1_Speed [rpm]"), told=poles, tolerances=rpm, separator="\t")
    renamed("names_american.csv", "d and q of the stator, and the electrical speed",
            with_names(fast["omega_e"], "t", "vds", "vqs", "ids", "iqs", "we_elec (rad/s)"))
    renamed("units_over.csv", "quantity over unit", with_names(mechanical, "t/s", "ud/V", "uq/V", "id/A", "iq/A", "n / min^-1"), told=poles, tolerances=rpm, notes=())
    renamed("units_in.csv", "'in' before the unit",
            with_names(mechanical, "Zeit in s", "Ud in V", "Uq in V", "Id in A", "Iq in A", "Drehzahl in 1/min"), told=poles, tolerances=rpm)
    renamed("durations.csv", "times with their unit, as MATLAB writes durations", with_names(fast["omega_e"], "Time", "ud", "uq", "id", "iq", "omega_e"),
            form={"Time": lambda value: f"{value:g} sec"}, notes=("numbers with their unit",))
    alpha_beta = {"t": fast["t"]}
    for name, d, q in [("u", "ud", "uq"), ("i", "id", "iq")]:
        angle = make.FAST["theta_e"]
        alpha_beta[f"{name}_alpha"] = fast[d] * np.cos(angle) - fast[q] * np.sin(angle)
        alpha_beta[f"{name}_beta"] = fast[d] * np.sin(angle) + fast[q] * np.cos(angle)
    alpha_beta |= {"theta_e": make.FAST["theta_e"], "omega_e": fast["omega_e"]}
    renamed("alpha_beta.csv", "the stator's frame and the angle", alpha_beta, form={name: make.fixed(9) for name in alpha_beta if "_a" in name or "_b" in name},
            tolerances={name: 2e-9 for name in ("ud", "uq", "id", "iq")}, notes=("from the phase quantities",))
    text = make.table(fast)
    make.put("preamble_oscilloscope.csv", "SCOPE64,12345,Waveform\nSegments,1,SegmentSize,9000\nSegment,TrigTime,TimeSinceSegment1\n#1,14-Aug-2012 18:23:46,0\n" + text)
    make.read("preamble_oscilloscope.csv", "settings of an oscilloscope above the names", fast, notes=["titles above the header"])
    blank = "\n".join(f",{line}" for line in text.strip().split("\n")[1:])
    make.put("preamble_paths.csv", "format,export\n\nunit,s,V,V,A,A,rad/s\n\npath,,Root/ud,Root/uq,Root/id,Root/iq,Root/omega\n\ntrace_values," + ",".join(fast) + "\n" + blank + "\n")
    make.read("preamble_paths.csv", "units and paths above the names, and a column without values", fast)
    thousand = with_names(mechanical / 1000.0, "t_s", "vd", "vq", "id", "iq", "speed_krpm")
    make.put("unit_krpm.csv", make.table(thousand))
    make.read("unit_krpm.csv", "thousands of r/min", fast, tolerances={"omega_e": 1e-9}, told=poles)
    per_unit = with_names(fast["omega_e"] / 800.0, "t", "ud_pu", "uq_pu", "id_pu", "iq_pu", "omega_pu")
    make.refuse(make.put("per_unit.csv", make.table(per_unit)), "per unit", "may be ud", line=1)
    make.refuse(make.put("settings_beside.csv", "Record Length,2500,,0.0,1.2\nSample Interval,4e-6,,0.1,1.3\nTrigger Point,1250,,0.2,1.3\n"),
                "settings of an oscilloscope beside the samples, and no names", "in place of a header", line=1)
    currents = {"id_A": np.repeat([-2.0, 0.0, 2.0], 3), "iq_A": np.tile([0.0, 1.0, 2.0], 3)}
    flux = currents | {"psi_d_Wb": 0.1 + 0.001 * currents["id_A"], "psi_q_Wb": 0.002 * currents["iq_A"]}
    make.refuse(make.put("flux_map_by_names.csv", make.table(flux)), "a flux map with units in its names", "flux map", line=1)
    motors = {"Ld_H": np.array([1e-3, 2e-3]), "Lq_H": np.array([2e-3, 3e-3]), "Rs_ohm": np.array([0.1, 0.2]), "psi_pm_Wb": np.array([0.1, 0.2])}
    make.refuse(make.put("motors.csv", make.table(motors)), "parameters of motors", "table of parameters", line=1)
    references = {"time": fast["t"], "vd": fast["ud"], "vq": fast["uq"], "id_ref": fast["id"] * 0 - 1, "id_meas": fast["id"], "iq_setpoint": fast["iq"] * 0 + 2,
                  "iq_meas": fast["iq"], "speed_step": np.arange(len(fast["t"])) // 10, "omega_e": fast["omega_e"]}
    renamed("names_beside_references.csv", "references and steps beside the measurements", references)
    theta = np.mod(make.FAST["theta_e"], 2 * np.pi)
    turning = with_names(fast["omega_e"], *make.NAMES) | {"theta": np.degrees(theta)}
    make.put("theta_turns.csv", make.table(turning))
    make.read("theta_turns.csv", "theta without a unit, which turns as omega_e says if it is in degrees", fast | {"theta_e": theta}, names=[*make.NAMES, "theta_e"],
              tolerances={"theta_e": 1e-12}, notes=["theta_e", "degrees"])
    still = with_names(fast["omega_e"], *make.NAMES) | {"theta": 40.0 + 0.01 * np.arange(len(fast["t"]))}
    make.put("theta_is_a_temperature.csv", make.table(still))
    make.read("theta_is_a_temperature.csv", "theta that does not turn", fast, notes=["theta_e is left out", "turn"])
    unstated = with_names(mechanical, "time", "ud", "uq", "id", "iq", "speed")
    make.put("names_speed_without_unit.csv", make.table(unstated))
    make.refuse("names_speed_without_unit.csv", "a speed that may be electrical or mechanical", "speed", "unit", "electrical", line=1)
    celsius = {"coolant_T [°C]": fast["id"], "LEW_T [°C]": fast["id"], "Speed_step": fast["iq"]} | {name: fast[name] for name in make.NAMES[1:]}
    make.put("no_time_but_temperatures.csv", make.table(celsius))
    make.refuse("no_time_but_temperatures.csv", "a temperature called T is no time", "t is missing", "map it if|no column resembles", line=1)
    number = {"t": fast["t"], "ud": fast["ud"], "uq": fast["uq"], "motor_id": fast["id"] * 0 + 7, "iq": fast["iq"], "omega_e": fast["omega_e"], "i_d_ref": fast["id"]}
    make.put("motor_number.csv", make.table(number))
    make.refuse("motor_number.csv", "the number of a motor, called motor_id, and a reference", "id is missing|id", "reference", line=1)
    two = {"time": fast["t"], "u_d": fast["ud"], "u_q": fast["uq"], "i_d": fast["id"], "I_d": fast["id"], "i_q": fast["iq"], "erpm": fast["omega_e"]}
    make.put("two_candidates.csv", make.table(two))
    make.refuse("two_candidates.csv", "two columns that could be i_d", "id", "i_d", line=1)
    mapping = make.put_mapping("digits_of_bus.toml", {"ud": {"column": "md", "scale": 1.0 / np.sqrt(3.0), "times": "u_dc"}, "uq": {"column": "mq", "scale": 1.0 / np.sqrt(3.0), "times": "u_dc"}})
    bus = make.FAST["u_dc"]
    duty = {"t": fast["t"], "md": fast["ud"] / bus * np.sqrt(3.0), "mq": fast["uq"] / bus * np.sqrt(3.0), "id": fast["id"], "iq": fast["iq"], "omega_e": fast["omega_e"], "u_dc": bus}
    make.put("digits_of_bus.csv", make.table(duty))
    make.read("digits_of_bus.csv", "voltages as shares of the DC voltage of each row, and a mapping file that says so", fast | {"u_dc": bus}, layout=make.MAPPED,
              tolerances={"ud": 1e-12, "uq": 1e-12}, names=[*make.NAMES, "u_dc"], told={"mapping": mapping})


# Headers


def headers(make):
    fast = make.part(make.FAST)
    columns = np.column_stack([fast[name] for name in make.NAMES])

    def saved(file, says, **options):
        np.savetxt(make.LOGS / file, columns, fmt="%.17g", **options)
        make.read(file, says, fast, same_as="canonical.csv")

    saved("savetxt_spaces.txt", "numpy's savetxt as it is: spaces, and the names in a comment", header=" ".join(make.NAMES))
    saved("savetxt_percent.txt", "savetxt with MATLAB's comments and a title", header="bench 3\n" + ",".join(make.NAMES), comments="% ", delimiter=",")
    units = "[s],[V],[V],[A],[A],[rad/s]"
    saved("percent_semicolon_ends.csv", "names and units in comments, and rows that end with a semicolon",
          header=f"Motor data\nOperator:\n{','.join(make.NAMES)}\n{units}", comments="%", delimiter=",", newline=";\r\n")
    make.put("aligned.txt", pd.DataFrame(fast).to_string(index=False, float_format=make.plain) + "\n")
    make.read("aligned.txt", "a table that pandas aligned with spaces", fast, same_as="canonical.csv")
    titles = "Bench 3;;;run 12;;\r\n;Drive;;Motor;;\r\n" + make.table(fast, separator=";", end="\r\n")
    make.put("titles_with_empty_cells.csv", titles)
    make.read("titles_with_empty_cells.csv", "title rows of a spreadsheet with empty cells", fast, same_as="canonical.csv", notes=["titles"])
    frame = pd.DataFrame(fast)
    frame.columns = pd.MultiIndex.from_tuples([("", "t"), ("voltage", "ud"), ("", "uq"), ("current", "id"), ("", "iq"), ("", "omega_e")])
    frame.to_csv(make.LOGS / "two_header_rows.csv", index=False, lineterminator="\n")
    make.read("two_header_rows.csv", "the two header rows of a MultiIndex of pandas", fast, same_as="canonical.csv", notes=["titles"])




# JSON


def records(make):
    fast = make.part(make.FAST)
    frame = pd.DataFrame(fast)
    rows = [{name: float(value) for name, value in zip(fast, row)} for row in zip(*fast.values())]

    def same(file, says, text, **more):
        make.put(file, text)
        make.read(file, says, fast, same_as="canonical.csv", **more)

    same("lines.jsonl", "JSON lines", "".join(json.dumps(row) + "\n" for row in rows))
    same("array.json", "an array of records, on one line", json.dumps(rows))
    same("array_indented.json", "an array of records, indented", json.dumps(rows, indent=1))
    same("pandas_lines.jsonl", "what pandas writes with lines=True", frame.to_json(orient="records", lines=True, double_precision=15))
    same("pandas_columns.json", "what pandas writes by default: an object for each column", frame.to_json(double_precision=15))
    same("pandas_split.json", "what pandas writes with orient=split", frame.to_json(orient="split", double_precision=15))
    same("lists.json", "a list for each column", json.dumps({name: [float(value) for value in values] for name, values in fast.items()}))
    same("data_key.json", "an array of records within an object", json.dumps({"data": rows}))
    nested = [{"t": row["t"], "motor": {"ud": row["ud"], "uq": row["uq"], "id": row["id"], "iq": row["iq"]}, "omega_e": row["omega_e"]} for row in rows]
    same("nested.jsonl", "objects within records", "".join(json.dumps(row) + "\n" for row in nested))
    start = pd.Timestamp("2016-02-12T23:59:58.5Z")
    dated = [row | {"t": (start + pd.Timedelta(nanoseconds=int(round(row["t"] * 1e9)))).isoformat(), "mode": "run"} for row in rows]
    make.put("dates.jsonl", "".join(json.dumps(row) + "\n" for row in dated))
    make.read("dates.jsonl", "JSON lines with dates and a text", fast, tolerances={"t": 1e-9}, notes=["dates"])
    nan = [row | {"u_dc": float("nan")} for row in rows]
    same("python_nan.jsonl", "NaN as Python writes it, in a column that is not needed", "".join(json.dumps(row) + "\n" for row in nan))
    make.put("text_value.jsonl", "".join(json.dumps(row | ({"uq": "high"} if at == 2 else {})) + "\n" for at, row in enumerate(rows)))
    make.refuse("text_value.jsonl", "a text in place of a number", "uq", "high", "number", line=3)
    make.put("no_records.json", json.dumps({"name": "bench", "runs": 3}))
    make.refuse("no_records.json", "JSON that is no table", "JSON", "record|object")
    make.put("cut_off.json", json.dumps(rows)[:-3000])
    make.refuse("cut_off.json", "JSON that was cut off", "JSON", "ends")


# LabVIEW


def lvm(make):
    """As the description of the format has it: no Python library writes it."""
    fast = make.part(make.FAST)
    rest = make.NAMES[1:]
    units = ["V", "V", "A", "A", "rad/s"]

    def header(times, channels, separator="\t", decimal="."):
        name = {"\t": "Tab", ",": "Comma"}[separator]
        file = [["LabVIEW Measurement"], ["Writer_Version", "2"], ["Reader_Version", "2"], ["Separator", name], ["Decimal_Separator", decimal],
                ["Multi_Headings", "Yes"], ["X_Columns", times], ["Time_Pref", "Absolute"], ["Date", "2016/02/12"], ["Time", "23:59:58.5"], ["***End_of_Header***"], []]
        step = repr(1e-4).replace(".", decimal)
        segment = [["Channels", str(channels)], ["Samples"] + [str(len(fast["t"]))] * channels, ["Date"] + ["2016/02/12"] * channels,
                   ["Time"] + ["23:59:58.5000000000000000000"] * channels, ["Y_Unit_Label"] + units[:channels], ["X_Dimension"] + ["Time"] * channels,
                   ["X0"] + [f"0{decimal}0E+0"] * channels, ["Delta_X"] + [step] * channels, ["***End_of_Header***"]]
        return "".join(separator.join(line) + separator + "\r\n" for line in file + segment)

    def rows(names, columns, separator="\t", decimal="."):
        text = separator.join(names + ["Comment"]) + "\r\n"
        for row in zip(*columns):
            text += separator.join("" if value is None else make.plain(value).replace(".", decimal) for value in row) + "\r\n"
        return text

    values = [fast[name] for name in rest]
    make.put("one_x.lvm", header("One", 5) + rows(["X_Value", *rest], [fast["t"], *values]))
    make.read("one_x.lvm", "LabVIEW: one X column", fast, same_as="canonical.csv")
    make.put("comma.lvm", header("One", 5, decimal=",") + rows(["X_Value", *rest], [fast["t"], *values], decimal=","))
    make.read("comma.lvm", "LabVIEW: decimal commas", fast, same_as="canonical.csv")
    make.put("no_x.lvm", header("No", 5) + rows(["X_Value", *rest], [[None] * len(fast["t"]), *values]))
    make.read("no_x.lvm", "LabVIEW: no X column, but X0 and Delta_X", fast, tolerances={"t": 1e-15})
    pairs = [column for name in rest for column in (fast["t"], fast[name])]
    make.put("multi_x.lvm", header("Multi", 5) + rows([entry for name in rest for entry in ("X_Value", name)], pairs))
    make.read("multi_x.lvm", "LabVIEW: an X column for each channel", fast, same_as="canonical.csv")
    make.put("broken_x.lvm", header("Multi", 5) + rows(["X_Value", *rest], [fast["t"], *values]))
    make.refuse("broken_x.lvm", "LabVIEW: not the columns that X_Columns says", "LabVIEW", "X_Columns")


# CAN


DBC = """VERSION ""

NS_ :

BS_:

BU_: DRIVE

BO_ 256 Voltages: 8 DRIVE
 SG_ ud : 0|32@1- (0.001,0) [0|0] "V" DRIVE
 SG_ uq : 32|32@1- (0.001,0) [0|0] "V" DRIVE

BO_ 2147484160 Currents: 8 DRIVE
 SG_ id : 7|32@0- (0.0001,0) [0|0] "A" DRIVE
 SG_ iq : 39|32@0- (0.0001,0) [0|0] "A" DRIVE

BO_ 258 Speed: 5 DRIVE
 SG_ kind M : 0|8@1+ (1,0) [0|0] "" DRIVE
 SG_ omega_e m1 : 8|32@1- (1,0) [0|0] "rad/s" DRIVE
 SG_ counter m2 : 8|32@1- (1,0) [0|0] "" DRIVE

SIG_VALTYPE_ 258 omega_e : 1;
"""


def frames(make):
    """cantools encodes, python-can writes. All messages of a row have the time of the row."""
    slow = make.part(make.SLOW)
    path = make.MAPPINGS / "drive.dbc"
    path.write_text(DBC)
    dbc = cantools.database.load_string(DBC, "dbc")
    start = 1_455_321_598.5
    messages = []
    for row in zip(*(slow[name][:100] for name in make.NAMES)):
        values = dict(zip(make.NAMES, map(float, row)))
        for name, signals in [("Voltages", {"ud": values["ud"], "uq": values["uq"]}), ("Currents", {"id": values["id"], "iq": values["iq"]}),
                              ("Speed", {"kind": 1, "omega_e": values["omega_e"]}), ("Speed", {"kind": 2, "counter": 7})]:
            message = dbc.get_message_by_name(name)
            data = message.encode(signals)
            shift = 1e-5 if signals.get("kind") == 2 else 0.0
            messages.append(can.Message(timestamp=start + values["t"] + shift, arbitration_id=message.frame_id, is_extended_id=message.is_extended_frame, data=data, channel="can0"))
    log = {name: values[:100] for name, values in slow.items()}
    told = {"dbc": "mappings/drive.dbc"}
    tolerances = {"t": 1e-6, "ud": 1e-12, "uq": 1e-12, "id": 1e-12, "iq": 1e-12, "omega_e": 3e-5}
    with can.CanutilsLogWriter(make.LOGS / "frames.log") as writer:
        for message in messages:
            writer.on_message_received(message)
    make.read("frames.log", "CAN frames by python-can in the format of candump -l, signals in both byte orders, a float, a multiplexer", log, tolerances=tolerances, told=told)
    text = ""
    for message in messages:
        identifier = f"{message.arbitration_id:08X}" if message.is_extended_id else f"{message.arbitration_id:03X}"
        text += f" ({message.timestamp:.6f})  can0  {identifier}   [{len(message.data)}]  {message.data.hex(' ').upper()}\n"
    make.put("frames_spaced.log", text)
    make.read("frames_spaced.log", "CAN frames as candump -t a shows them", log, tolerances=tolerances, told=told)
    make.put("frames_without_dbc.log", (make.LOGS / "frames.log").read_bytes())
    make.refuse("frames_without_dbc.log", "CAN frames, and nobody says what they mean", "candump", "DBC")
    with can.ASCWriter(make.LOGS / "vector.asc") as writer:
        for message in messages[:20]:
            writer.on_message_received(message)
    make.refuse("vector.asc", "a log of Vector's tools", "ASC", "candump|MDF")
    with can.BLFWriter(make.LOGS / "vector.blf") as writer:
        for message in messages[:20]:
            writer.on_message_received(message)
    make.refuse("vector.blf", "a binary log of Vector's tools", "BLF", "CSV")


# HDF5


def hdf5(make):
    fast = make.part(make.FAST)
    raw = make.LOGS / "raw.bin"
    fast["iq"].astype("<f8").tofile(raw)
    with h5py.File(make.LOGS / "external.h5", "w") as file:
        for name in make.NAMES:
            outside = {"external": [("raw.bin", 0, 8 * len(fast["iq"]))]} if name == "iq" else {}
            data = file.create_dataset(name, (len(fast[name]),), "<f8", **outside)
            if not outside:
                data[:] = fast[name]
    raw.unlink()
    make.refuse("external.h5", "HDF5 whose i_q lies in another file", "iq", "another file|external|outside")
    with h5py.File(make.LOGS / "virtual.h5", "w") as file:
        for name in make.NAMES:
            file[name if name != "iq" else "measured"] = fast[name]
        layout = h5py.VirtualLayout((len(fast["iq"]),), "<f8")
        layout[:] = h5py.VirtualSource(file["measured"])
        file.create_virtual_dataset("iq", layout)
    make.refuse("virtual.h5", "HDF5 with a virtual dataset", "virtual|iq")


# What owners of logs have, and a reader may mistake for something else


def owners(make):
    fast = make.part(make.FAST)
    poles = {"pole_pairs": make.POLE_PAIRS}
    rpm = {"omega_e": 1e-15 * 4.0 * float(np.max(fast["omega_e"])) + 1e-12}
    mechanical = fast["omega_e"] * make.RPM / make.POLE_PAIRS
    rows = len(fast["t"])

    def read(file, says, columns, log=fast, form=None, **more):
        make.put(file, make.table(columns, form={name: make.plain for name in columns} | (form or {})))
        make.read(file, says, log, **more)

    def refuse(file, says, columns, *words, **more):
        make.put(file, make.table(columns))
        make.refuse(file, says, *words, **more)

    def with_names(speed, *names):
        return dict(zip(names, [fast["t"], fast["ud"], fast["uq"], fast["id"], fast["iq"], speed]))

    axes = {"d_current": fast["id"], "q_current": fast["iq"], "d_voltage": fast["ud"], "q_voltage": fast["uq"]}
    read("id_of_the_device.csv", "id is the number of a device on the bus, and the currents have names of their own",
         {"timestamp": fast["t"], "id": np.ones(rows), "mode": np.full(rows, 10.0)} | axes | {"velocity [turns/s]": mechanical / 60.0}, told=poles, tolerances=rpm,
         notes=["d_current"])
    read("id_of_the_row.csv", "ID is the number of the row",
         {"ID": np.arange(rows) + 1.0} | with_names(fast["omega_e"] * make.RPM, "Time", "U_d", "U_q", "I_d", "I_q", "erpm"), tolerances=rpm, notes=["I_d"])
    starred = {"t": fast["t"], "ud": fast["ud"], "uq": fast["uq"], "id*": np.full(rows, -1.0), "iq*": np.full(rows, 2.0), "omega_e": fast["omega_e"]}
    refuse("starred_references.csv", "references with a star, and no measured currents", starred, "id and iq are missing", "reference", line=1)
    read("starred_beside.csv", "references with a star beside the measurements", {"id*": np.full(rows, -1.0), "iq*": np.full(rows, 2.0)} | fast)
    read("names_inverter.csv", "an abbreviation of the inverter before the names",
         with_names(mechanical, "tout", "Inv_Ud", "Inv_Uq", "Inv_Id", "Inv_Iq", "Inv_Speed [rpm]"), told=poles, tolerances=rpm, notes=["usual names"])
    read("names_chinese.csv", "Chinese names, and a bracket of full width",
         with_names(mechanical, "时间(s)", "d轴电压(V)", "q轴电压(V)", "d轴电流(A)", "q轴电流(A)", "转速（rpm）"), told=poles, tolerances=rpm, notes=["usual names"])
    read("names_turns_a_minute.csv", "French turns a minute, and a letter behind the word",
         with_names(mechanical, "Temps (s)", "Tension Vd (V)", "Tension Vq (V)", "Courant Id (A)", "Courant Iq (A)", "Vitesse n (tr/min)"), told=poles, tolerances=rpm,
         notes=["usual names"])
    digits = {"t": fast["t"], "Vd": np.round(fast["ud"] / 179.0 * 32768), "Vq": np.round(fast["uq"] / 179.0 * 32768),
              "Id": np.round(fast["id"] / 20.0 * 32768), "Iq": np.round(fast["iq"] / 20.0 * 32768), "omega_e": fast["omega_e"]}
    refuse("digits_of_a_controller.csv", "voltages and currents as the 16-bit numbers of a controller", digits, "Vd", "whole numbers", "digits", "state the unit")
    per_unit = with_names(fast["omega_e"] / 800.0, *make.NAMES) | {"ud": fast["ud"] / 179.0, "uq": fast["uq"] / 179.0, "id": fast["id"] / 10.0, "iq": fast["iq"] / 10.0}
    refuse("per_unit_unmarked.csv", "per unit, under the names of V, A and rad/s", per_unit, "per unit", "scale")
    rms = with_names(fast["omega_e"], "t", "ud", "uq", "id_rms", "iq_rms", "omega_e")
    refuse("rms_mapped.csv", "root mean squares, mapped as if they were peak values", rms, "rms", "unit",
           told={"map": ["id=id_rms", "iq=iq_rms"]})
    scaled = rms | {name: rms[name] / np.sqrt(2.0) for name in ("id_rms", "iq_rms")}
    mapping = make.put_mapping("rms_scaled.toml", {name: {"column": f"{name}_rms", "scale": float(np.sqrt(2.0))} for name in ("id", "iq")})
    read("rms_scaled.csv", "root mean squares, with their scale in a mapping file", scaled, layout=make.MAPPED, tolerances={"id": 1e-14, "iq": 1e-14},
         told={"mapping": mapping})
    turning = make.motor_log(1e-3, [60, 60, 60], 10, 3)
    theta = np.mod(turning["theta_e"], 2 * np.pi)
    needed = make.part(turning)
    read("angle_in_digits.csv", "an angle in steps of an encoder, which is not needed", needed | {"theta_e": np.floor(theta / (2 * np.pi) * 4096)}, needed,
         notes=["theta_e is left out", "winds around at 4096"])
    refuse("angle_in_turns_alone.csv", "an angle in turns, which is needed", {name: needed[name] for name in make.NAMES[:5]} | {"theta_e": theta / (2 * np.pi)},
           "winds around at 1", "scale = 6.28319")
    for quantity, d, q in [("u", "ud", "uq"), ("i", "id", "iq")]:
        turning |= dict(zip([f"{quantity}{letter}" for letter in "abc"], make.phases(turning[d], turning[q], turning["theta_e"])))
    of_phases = {name: turning[name] for name in ["t", "ua", "ub", "uc", "ia", "ib", "ic", "omega_e"]}
    degrees = {"t": of_phases["t"]} | {name: of_phases[name] for name in ["ua", "ub", "uc", "ia", "ib", "ic"]} | {"theta_e": np.degrees(theta)}
    read("angle_in_degrees_alone.csv", "an angle in degrees that nothing says, with phase quantities and no speed", degrees, needed, names=make.NAMES[:5],
         notes=["degrees"], tolerances={name: 1e-9 for name in ("ud", "uq", "id", "iq")})


def duties(make):
    """Space vectors: each duty cycle is a half and the phase voltage, shifted so that the largest and the smallest are as far from the rails."""
    fast, angle, bus = make.part(make.FAST), make.FAST["theta_e"], make.FAST["u_dc"]
    phases = make.phases(fast["ud"], fast["uq"], angle)
    middle = (np.maximum.reduce(phases) + np.minimum.reduce(phases)) / 2.0
    shares = [0.5 + (phase - middle) / bus for phase in phases]
    rest = {"id": fast["id"], "iq": fast["iq"], "omega_e": fast["omega_e"], "theta_e": angle, "u_dc": bus}
    tolerances = {"ud": 1e-9, "uq": 1e-9}

    def columns(names, scale, **more):
        return {"t": fast["t"]} | dict(zip(names, [scale * share for share in shares])) | rest | more

    def put(file, columns):
        make.put(file, make.table(columns))

    put("duties.csv", columns(["duty_a", "duty_b", "duty_c"], 1.0))
    make.read("duties.csv", "duty cycles of the three phases in place of voltages", fast, tolerances=tolerances, notes=["duty cycles", "from the phase quantities"])
    put("duties_percent.csv", columns(["Duty U [%]", "Duty V [%]", "Duty W [%]"], 100.0))
    make.read("duties_percent.csv", "duty cycles in percent", fast, tolerances=tolerances, notes=["duty cycles"])
    put("duties_of_a_timer.csv", columns(["duty_a", "duty_b", "duty_c"], 4200.0))
    make.refuse("duties_of_a_timer.csv", "duty cycles in counts of a timer", "no duty cycle from 0 to 1", 'times = "u_dc"')
    mapping = {f"u{phase}": {"column": f"duty_{phase}", "scale": 1.0 / 4200.0, "times": "u_dc"} for phase in "abc"}
    put("duties_of_a_timer_mapped.csv", columns(["duty_a", "duty_b", "duty_c"], 4200.0))
    make.read("duties_of_a_timer_mapped.csv", "the same, with the counts in a mapping file", fast, layout=make.MAPPED, tolerances=tolerances,
              told={"mapping": make.put_mapping("duties_of_a_timer.toml", mapping)})
    without = columns(["duty_a", "duty_b", "duty_c"], 1.0)
    put("duties_without_bus.csv", {name: values for name, values in without.items() if name != "u_dc"})
    make.refuse("duties_without_bus.csv", "duty cycles without the DC voltage", "u_dc is missing", line=1)
    put("duties_without_angle.csv", {name: values for name, values in without.items() if name != "theta_e"})
    make.refuse("duties_without_angle.csv", "duty cycles without the angle", "theta_e is missing", line=1)

"""The corpus, continued: tables whose names only resemble those of a log. What is proposed for them has to be right, for it is pasted.

make.py calls write(make), with itself, as it does with tools.py.
"""

import io
import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq


ROWS = 5


def write(make):
    for part in (suffixes, root_mean_squares, flux_maps, phases, several, rotation, archives, lists, nested, serial_monitor, vectors, unmeasured, axes, modulation, frames, traces, remarks):
        part(make)


def columns(make, *names):
    """The motor's columns, t, ud, uq, id, iq, omega_e, under other names."""
    return dict(zip(names, make.part(make.FAST).values()))


def refuse(make, file, says, log, *words, **more):
    """A table that is refused for its header, so that some rows are enough."""
    make.put(file, make.table({name: values[:ROWS] for name, values in log.items()}))
    make.refuse(file, says, *words, **more)


def suffixes(make):
    numbered = columns(make, "data.time", "data.vd1", "data.vq1", "data.id1", "data.iq1", "data.speed1")
    numbered |= {"data.id1_ref": np.full(len(numbered["data.time"]), -1.0), "data.iq1_ref": np.full(len(numbered["data.time"]), 2.0)}
    refuse(make, "names_numbered.csv", "a number behind every name, and references beside", numbered, "'data.vd1' may be ud", "'data.vq1' may be uq",
           "'data.id1' may be id", "'data.iq1' may be iq", "'data.speed1' may be omega_e", line=1)


def root_mean_squares(make):
    """A dq value is a peak value: root mean squares are proposed with the unit that says so, and are read with nothing less."""
    def with_rms(*names):
        log = columns(make, *names)
        return log | {name: log[name] / np.sqrt(2.0) for name in names[3:5]}

    tolerances = {"id": 1e-14, "iq": 1e-14}
    for file, says, names in [
        ("rms_units.csv", "rms and the unit in the names of the currents", ("t", "vd", "vq", "id_RMS_A", "iq_RMS_A", "omega_e")),
        ("rms_one_word.csv", "rms without a mark between", ("t", "vd", "vq", "IdRMS", "IqRMS", "omega_e")),
        ("rms_brackets.csv", "rms in brackets", ("t", "vd", "vq", "id (RMS)", "iq (RMS)", "omega_e")),
    ]:
        refuse(make, file, says, with_rms(*names), "the columns id and iq are missing", f"'{names[3]}' may be id", f"'{names[4]}' may be iq", "rms values", "peak values")
        told = {"map": [f"id={names[3]}", f"iq={names[4]}"]}
        mapped = "mapped_" + file
        refuse(make, mapped, says + ", mapped without a unit", with_rms(*names), "rms values", "state their unit", told=told)
    log = with_rms("t", "ud", "uq", "id_RMS_A", "iq_RMS_A", "omega_e")
    told = {"map": ["id=id_RMS_A", "iq=iq_RMS_A"], "units": ["id=Arms", "iq=Arms"]}
    make.put("rms_stated.csv", make.table(log))
    make.read("rms_stated.csv", "rms values with their unit stated", make.part(make.FAST), make.MAPPED, tolerances, told=told, notes=["A rms"])
    beside = columns(make, "t", "ud", "uq", "id_Pk", "iq_Pk", "omega_e")
    beside = {"t": beside["t"], "id_RMS": beside["id_Pk"] / np.sqrt(2.0), "iq_RMS": beside["iq_Pk"] / np.sqrt(2.0)} | beside
    refuse(make, "rms_beside_peak.csv", "peak values beside rms values", beside, "'id_Pk' may be id", "'iq_Pk' may be iq")
    phases = dict(zip(["ia", "ib", "ic"], make.phases(make.FAST["id"], make.FAST["iq"], make.FAST["theta_e"])))
    log = make.part(make.FAST, ["t", "ud", "uq"]) | {f"{name}_rms": values for name, values in phases.items()} | make.part(make.FAST, ["omega_e", "theta_e"])
    refuse(make, "rms_of_phases.csv", "rms values of the phases", log, "at each instant", told={"map": [f"{name}={name}_rms" for name in phases]})


def flux_maps(make):
    """Maps of currents to flux linkages, as programs of finite elements write them, with texts and empty columns beside."""
    i_d, i_q = np.array([-20.0, -20.0, -10.0, -10.0]), np.array([10.0, 20.0, 10.0, 20.0])
    fluxes = [make.PSI_F + make.LD * i_d, make.LQ * i_q]
    numbers = {"id_RMS_A": i_d / np.sqrt(2.0), "iq_RMS_A": i_q / np.sqrt(2.0), "torque_Nm": 6.0 * i_q, "psiD_Wb": fluxes[0], "psiQ_Wb": fluxes[1],
               "Ld_H": np.full(4, make.LD), "Lq_H": np.full(4, make.LQ)}
    lines = make.table(numbers).splitlines()
    text = "case_id," + lines[0] + ",Bmax_T\n" + "".join(f"CASE_{k},{line},\n" for k, line in enumerate(lines[1:]))
    make.refuse(make.put("flux_map_of_cases.csv", text), "a flux map with names of its cases and an empty column", "flux map", line=1)
    peaks = {"Iq_RMS": i_q / np.sqrt(2.0), "Id_RMS": i_d / np.sqrt(2.0), "Iq_Pk": i_q, "Id_Pk": i_d, "psiD_Pk": fluxes[0], "psiQ_Pk": fluxes[1],
             "Lq": np.full(4, make.LQ), "Ld": np.full(4, make.LD), "Torque(Nm)": 6.0 * i_q, "TopSpeed": np.full(4, 9000.0)}
    make.refuse(make.put("flux_map_of_peaks.csv", make.table(peaks)), "a flux map in peak values, with a speed", "flux map", line=1)
    lines = make.table(make.part(make.FAST, ["ud", "uq", "iq", "omega_e"])).splitlines()[:6]
    text = lines[0] + ",Bench t,id_text,my id\n" + "".join(f"{line},,run {k},-1.5\n" for k, line in enumerate(lines[1:]))
    make.refuse(make.put("texts_beside.csv", text), "a text and an empty column whose names resemble those of missing channels", "'my id' may be id",
                "'Bench t' and 'id_text' hold no numbers", "no column resembles t", line=1)


def phases(make):
    """Phase quantities that are called so in words."""
    log = make.part(make.FAST, ["t", "theta_e", *make.NAMES[1:]])
    for quantity, d, q in [("Current", "id", "iq"), ("Voltage", "ud", "uq")]:
        log |= dict(zip([f"{quantity}{letter}" for letter in "ABC"], make.phases(log[d], log[q], log["theta_e"])))
    for file, says, current, voltage in [
        ("phases_in_brackets.csv", "the phase in brackets before the unit", "Current(Phase{}) [A]", "Voltage(Phase{}) [V]"),
        ("phases_before.csv", "the phase before the quantity", "Phase {} Current (A)", "Phase {} Voltage (V)"),
    ]:
        named = {"Time [ms]": log["t"] * 1e3, "theta_e": log["theta_e"]}
        for letter in "ABC":
            named |= {current.format(letter): log[f"Current{letter}"], voltage.format(letter): log[f"Voltage{letter}"]}
        form = {name: make.fixed(9) for name in named}
        make.put(file, make.table(named, form=form))
        tolerances = {"t": 1e-12} | {name: 1e-8 for name in ("ud", "uq", "id", "iq")}
        make.read(file, says, log, tolerances=tolerances, names=make.NAMES[:5], notes=["usual names", "phase quantities"])
    named = {"Time [ms]": log["t"] * 1e3} | {f"Current(Phase{letter}) [A]": log[f"Current{letter}"] for letter in "ABC"}
    refuse(make, "phases_alone.csv", "currents of the phases and nothing else", named | {"Speed(Rotor) [rpm]": log["omega_e"]}, "ud, uq and theta_e are missing", line=1)


def several(make):
    """Structures of one file that are a log each."""
    names = ("t", "u_d", "u_q", "id", "iq", "omega_rpm")
    log = {f"result.{run}.{name}": values for run in ("id0", "mtpa") for name, values in columns(make, *names).items()}
    log |= {f"result.{run}.omega_m": make.FAST["omega_e"] for run in ("id0", "mtpa")}
    refuse(make, "several_logs.csv", "two runs, and each has two speeds", log, "2 logs, in 'result.id0' and 'result.mtpa'", "map the columns of one", line=1)
    told = {"map": ["t=result.mtpa.t", "ud=result.mtpa.u_d", "uq=result.mtpa.u_q", "id=result.mtpa.id", "iq=result.mtpa.iq", "omega=result.mtpa.omega_m"], "units": ["omega=rad/s"]}
    make.put("several_logs_mapped.csv", make.table(log))
    make.read("several_logs_mapped.csv", "the second of two runs, mapped", make.part(make.FAST), make.MAPPED, told=told)


def rotation(make):
    """A speed whose unit is stated, and nothing says whether it is that of the shaft."""
    hertz = columns(make, "t", "vd [V]", "vq [V]", "id [A]", "iq [A]", "velocity measured [Hz]")
    hertz["velocity measured [Hz]"] = hertz["velocity measured [Hz]"] / (2.0 * np.pi)
    refuse(make, "speed_in_hertz.csv", "a speed in Hz, and no word on whether it is electrical", hertz, "this speed is in Hz", "electrical or that of the shaft", line=1)


def archives(make):
    """What numpy.savez writes is a zip archive, as a workbook is."""
    content = io.BytesIO()
    np.savez_compressed(content, **make.part(make.FAST))
    make.refuse(make.put("arrays.npz", content.getvalue()), "an archive of numpy's arrays", "numpy", "np.load", "to_csv")


def lists(make):
    """A row for each run, with the whole course in a cell."""
    runs = {"Speed": [0.0], "Torque": [0.0], "Power": [0.0], "id": [list(make.FAST["id"])], "iq": [list(make.FAST["iq"])]}
    pq.write_table(pa.table(runs), make.LOGS / "lists.parquet")
    make.refuse("lists.parquet", "currents as lists, beside a row of zeros", "'id' and 'iq' hold a list in each row", "one number for each instant")
    pq.write_table(pa.table({name: [list(make.FAST[name])] for name in make.NAMES}), make.LOGS / "lists_alone.parquet")
    make.refuse("lists_alone.parquet", "all columns are lists", "hold a list in each row", "one number in each cell")


def nested(make):
    """Lists of columns, objects deep."""
    lists = {name: [float(value) for value in values] for name, values in make.part(make.FAST).items()}
    events = [{"t": 0.0, "what": "start"}, {"t": 1.0, "what": "stop"}]
    one = {"motor": {"name": "a", "pole_pairs": 4}, "events": events, "runs": {"first": {"signals": lists}}}
    make.read(make.put("nested_lists.json", json.dumps(one)), "lists of columns within objects", make.part(make.FAST))
    axes = {"t": lists["t"], "measured": {name: lists[name] for name in ("ud", "uq", "id", "iq")}, "omega_e": lists["omega_e"],
            "reference": {"id": lists["iq"], "iq": lists["id"]}}
    make.read(make.put("nested_axes.json", json.dumps(axes)), "lists of columns in several objects, and references", make.part(make.FAST))
    series = {"name": "drive", "columns": list(lists), "values": [list(row) for row in zip(*lists.values())]}
    make.read(make.put("nested_series.json", json.dumps({"results": [{"series": [series]}]})), "names and rows, as InfluxDB answers", make.part(make.FAST))
    two = {"first": lists, "second": {name: values[:ROWS] for name, values in lists.items()}}
    make.refuse(make.put("nested_two.json", json.dumps(two)), "two logs in one object", "2 logs", "'first' and 'second'")


def serial_monitor(make):
    """The serial monitor of the Arduino IDE writes the time of each line before it."""
    log = make.part(make.FAST)
    stamps = [f"13:24:31.{k:03} -> " for k in range(len(log["t"]))]
    names = [name for name in log if name != "t"]
    rows = ["\t".join(make.plain(log[name][k]) for name in names) for k in range(len(stamps))]
    lines = [stamp + row for stamp, row in zip(stamps, ["\t".join(names), *rows[1:]])]
    timed = {name: values[1:] for name, values in log.items()} | {"t": 48271.0 + 1e-3 * np.arange(1, len(stamps))}
    make.put("serial_monitor.txt", "\r\n".join(lines) + "\r\n")
    make.read("serial_monitor.txt", "times of Arduino's serial monitor", timed, tolerances={"t": 1e-9}, notes=["serial monitor"])
    refused = make.put("serial_monitor_bare.txt", "\r\n".join(stamp + row for stamp, row in zip(stamps, rows)) + "\r\n")
    make.refuse(refused, "the same without names", "numbers in place of a header", line=1)


def vectors(make):
    """A vector of commands in place of voltages; the speed of a vehicle."""
    log = columns(make, "t", "Vdq_cmd(1) [V]", "Vdq_cmd(2) [V]", "Idq(1) [A]", "Idq(2) [A]", "omega_e")
    make.put("vector_of_commands.csv", make.table(log))
    make.read("vector_of_commands.csv", "voltages as a vector of commands", make.part(make.FAST))
    refuse(make, "vehicle_speed.csv", "no speed but the vehicle's", columns(make, "t", "ud", "uq", "id", "iq", "vehicle_speed_kmh"), "omega_e",
           "map it if it has another name", line=1)


def unmeasured(make):
    """Columns that resemble a channel and cannot be it: a meter's 'no value', a constant, a flag, a time that falls."""
    rows = 40
    log = {name: values[:rows] for name, values in columns(make, "bench t", "bench ud", "bench uq", "bench id", "bench iq", "bench speed").items()}
    stop = np.where(np.arange(rows) % 2 == 0, 3.5, 2.5)
    never = {"STOP_T [s]": stop, "PA1_U1 [V]": np.full(rows, 9.9e37), "PA1_U2 [V]": np.full(rows, 9.9e37), "PA1_I1 [A]": np.full(rows, 2.0),
             "PA1_I2 [A]": np.full(rows, 2.0), "NM_DCDC_Wakeup": np.ones(rows)}
    make.put("unmeasured.csv", make.table(never | {"n_HM [1/min]": log["bench speed"]}))
    make.refuse("unmeasured.csv", "columns that no instrument measured", "map them if they have other names, else log them too", line=1)
    make.put("unmeasured_beside.csv", make.table(never | log))
    make.refuse("unmeasured_beside.csv", "the same beside those of a log", "'bench t' may be t", "'bench ud' may be ud", "'bench uq' may be uq", "'bench id' may be id",
                "'bench iq' may be iq", "'bench speed' may be omega_e", line=1)


def axes(make):
    """Several axes, of which nothing says which is the motor's."""
    log = columns(make, "time", "Drive 0 Velocity", "Drive 1 Velocity", "Drive 2 Velocity", "Drive 0 Current", "Drive 1 Current")
    refuse(make, "several_axes.csv", "the velocities of several axes", log, "'Drive 0 Velocity', 'Drive 1 Velocity' and 'Drive 2 Velocity' could each be omega_e",
           "map the one of the motor", line=1)


def modulation(make):
    """ODrive logs shares of the DC voltage in place of voltages."""
    path = "axis0.motor.foc."
    log = columns(make, "time", path + "mod_d", path + "mod_q", path + "Id_measured", path + "Iq_measured", "omega_e")
    log = log | {name: log[name] / (2.0 / 3.0 * make.U_DC) for name in (path + "mod_d", path + "mod_q")} | {"vbus_voltage": np.full(len(log["time"]), make.U_DC)}
    refuse(make, "modulation_alone.csv", "a modulation in place of voltages", log, "'axis0.motor.foc.mod_d' and 'axis0.motor.foc.mod_q' are shares of the DC voltage",
           'ud = { column = "axis0.motor.foc.mod_d", scale = 0.66667, times = "u_dc" }', line=1)


def frames(make):
    """Frames of a CAN bus as a table: the column ID is no current."""
    header = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8,"
    rows = [f"{10000 * k},000000A7,false,Rx,0,8,{k:02X},00,{3 * k:02X},00,10,0B,00,00," for k in range(ROWS)]
    make.refuse(make.put("frames_of_savvycan.csv", "\n".join([header, *rows]) + "\n"), "frames as SavvyCAN stores them", "a log of CAN frames as CSV", "candump")


def traces(make):
    """Oscilloscopes and their channels: two terminals of a motor that is turned, 53.2 Hz and 12.3 V rms."""
    t = np.arange(1000) * 1e-4
    volts = np.array([f"{17.4 * np.cos(2.0 * np.pi * 53.2 * time):.4f}" for time in t])
    rows = [f"{time:.4f},{volt}" for time, volt in zip(t, volts)]
    waves = ["53.20 Hz and 12.3", "psi_f alone"]
    for file, says, above in [
        ("scope_of_rohde.csv", "a time without a name, as Rohde & Schwarz write it", ["in s,C1 in V"]),
        ("scope_of_saleae.csv", "channels that count from 0", ["Time [s],Channel 0"]),
        ("scope_of_lecroy.csv", "an amplitude, below a preamble", ["LECROYWS3024,1,Waveform", "Segments,1,SegmentSize,1000", "Segment,TrigTime,TimeSinceSegment1", "#1,03-Mar-2024 14:22:10,0", "Time,Ampl"]),
        ("scope_of_siglent.csv", "names of channels above names of units", ["Record Length,Analog:1000", "Sample Interval,Analog:0.0001", "Vertical Units,CH1:V", "Horizontal Units,S", "Source,CH1", "Second,Volt"]),
    ]:
        make.refuse(make.put(file, "\n".join([*above, *rows]) + "\n"), says, *waves)
    settings = ["Record Length,1.0e+03", "Sample Interval,1.0e-04", "Trigger Point,5.0e+02", ",", "Source,CH1", "Vertical Units,V", "Horizontal Units,s", "Model Number,TDS2012B"]
    beside = [f"{settings[k] if k < len(settings) else ','},,{row.replace(',', ',  ')}," for k, row in enumerate(rows)]
    make.refuse(make.put("scope_of_tds.csv", "\n".join(beside) + "\n"), "samples beside the settings, as Tektronix' TDS write them", *waves)
    counted = [f"{k},{volt},," for k, volt in enumerate(volts[:ROWS])]
    make.refuse(make.put("scope_of_rigol.csv", "\n".join(["X,CH1,Start,Increment,", "Sequence,Volt,0.0e+00,1.0e-04", *counted]) + "\n"), "samples that are counted, as Rigol writes them", "a trace of an oscilloscope")


def remarks(make):
    """Remarks above a header that are as wide as the table."""
    log = make.part(make.FAST)
    above = ["2/12/2016,,run ~/projects/ramp_test,,,", ",,layout: ~/projects/motor_tests.sml,,,", ',,of the controller,"be sure, both are measured",of the encoder,']
    make.put("remarks_above.csv", "\n".join(above) + "\n" + make.table(log))
    make.read("remarks_above.csv", "remarks above the header in a part of its columns, a date first", log, same_as="canonical.csv")

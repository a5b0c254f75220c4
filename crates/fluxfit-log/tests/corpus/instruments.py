"""The corpus, continued: files as instruments, PLCs and simulation tools lay them out. make.py calls write(make), with itself.

The layouts are those of the makers' manuals: Beckhoff TE13xx Scope View (Export to csv), Tektronix MDO/MSO (save waveform as csv), Siglent SDS,
dSPACE ControlDesk (export to MAT), Dymola and OpenModelica (result files), Simulink To Workspace (array; array of three dimensions), TI MotorControl SDK (names of vectors).
"""

import struct

import numpy as np


def write(make):
    for part in (twincat, oscilloscopes, encodings, thousandths, vectors, matlab, modelica, recordings):
        part(make)


def twincat(make):
    fast = make.part(make.FAST)
    names = make.NAMES[1:]
    units = ["V (Voltage)", "V (Voltage)", "A (Current)", "A (Current)", "(None)"]

    def export(file, separator, decimal, shared=False, names=names, units=units, slow=None):
        def of_each(key, values):
            return separator.join(f"{key}{separator}{value}" for value in values)

        # Every tenth value of the slow channel; where it has ended, its cells are empty.
        every = {name: 10 if name == slow else 1 for name in names}
        series = {name: [(f"{t * 1e3:.1f}", make.plain(value)) for t, value in zip(fast["t"], fast.get(name, fast["t"] + 25.0))][:: every[name]] for name in names}
        lines = ["Name" + separator + "Scope Project", "File" + separator + "C:\\scopes\\drive.svdx",
                 separator.join(["Starttime of export", "132959733843760000", "Montag, 2. Mai 2022", "15:56:24.376"]),
                 separator.join(["Endtime of export", "132959733853750000", "Montag, 2. Mai 2022", "15:56:25.375"]), "", ""]
        count = len(names)
        for key, values in [("Name", names), ("SymbolComment", [""] * count), ("Data-Type", ["REAL64"] * count),
                            ("SampleTime[ms]", ["1" if name == slow else "0" + decimal + "1" for name in names]),
                            ("VariableSize", [8] * count), ("SymbolBased", ["True"] * count), ("IndexGroup", [16448] * count), ("IndexOffset", range(385000, 385000 + count)),
                            ("SymbolName", [f"GVL.{name}" for name in names]), ("Port", [851] * count), ("Offset", [0] * count), ("ScaleFactor", [1] * count), ("Unit", units),
                            ("Unit ScaleFactor", [1] * count)]:
            lines.append(of_each(key, values))
        lines.append("")
        for k, t in enumerate(fast["t"]):
            pairs = [series[name][k] if k < len(series[name]) else ("", "") for name in names]
            cells = [f"{t * 1e3:.1f}"] + [value for _, value in pairs] if shared else [cell for pair in pairs for cell in pair]
            lines.append(separator.join(cell.replace(".", decimal) for cell in cells))
        return make.put(file, "\r\n".join(lines) + "\r\n")

    export("twincat.csv", "\t", ",")
    make.read("twincat.csv", "an export of TwinCAT Scope: a time before each channel, decimal commas", fast, tolerances={"t": 1e-15}, notes=["TwinCAT"])
    export("twincat_one_time.csv", ";", ",", shared=True)
    make.read("twincat_one_time.csv", "the same with one time for all channels, and semicolons", fast, tolerances={"t": 1e-15}, notes=["TwinCAT"])
    export("twincat_two_rates.csv", "\t", ".", slow="omega_e")
    make.refuse("twincat_two_rates.csv", "the speed has another sample time than the other channels, so a row is not simultaneous", "steps of 1.00 and not of 0.100", "\"Time 5\"")
    export("twincat_slow_channel.csv", "\t", ",", names=["winding", *names], units=["(None)", *units], slow="winding")
    make.read("twincat_slow_channel.csv", "a channel of another sample time that the log does not need", fast, tolerances={"t": 1e-15}, notes=["TwinCAT"])


def oscilloscopes(make):
    fast = make.part(make.FAST)
    rows = "\n".join(make.table(fast).strip().split("\n")[1:]) + "\n"
    names = ",".join(make.NAMES[1:])
    settings = ["Model,MDO3034", "Firmware Version,1.22", "", "Waveform Type,ANALOG,,,,", "Point Format,Y,,,,", "Horizontal Units,s,,,,", "Horizontal Scale,0.004,,,,", ",,,,,",
                "Sample Interval,1e-04,,,,", "Record Length,160,,,,", "Gating,0.0% to 100.0%,,,,", "Probe Attenuation,10,10,1,1,1", "Vertical Units,V,V,A,A,V",
                "Vertical Offset,0,0,0,0,0", "Vertical Scale,10,10,10,10,10", ",,,,,", f"Label,{names}"]
    make.put("tektronix.csv", "\n".join([*settings, "TIME,CH1,CH2,CH3,CH4,MATH1"]) + "\n" + rows)
    make.read("tektronix.csv", "thirty lines of settings, labels above the names of the channels", fast, notes=["titles above the header"])
    settings = ["Record Length,Analog:160", "Sample Interval,CH1:1.00E-04", "Vertical Units,CH1:V,CH2:V,CH3:A,CH4:A,F1:V", "Vertical Scale,CH1:0.5,CH2:0.5", "Horizontal Units,s",
                "Model Number,SDS1104X-E", "Serial Number,0", "Software Version,8.2", "Source,CH1,CH2,CH3,CH4,F1", "Second,Volt,Volt,Volt,Volt,Volt"]
    make.put("siglent.csv", "\n".join(settings) + "\n" + rows)
    make.refuse("siglent.csv", "settings above the channels of an oscilloscope, whose names say nothing", "'CH1', 'CH2', 'CH3', 'CH4'", "map them", line=9)


def encodings(make):
    fast = make.part(make.FAST)
    mechanical = fast["omega_e"] * make.RPM / make.POLE_PAIRS
    columns = [fast["t"], fast["ud"], fast["uq"], fast["id"], fast["iq"], mechanical]
    poles = {"pole_pairs": make.POLE_PAIRS}
    rpm = {"omega_e": 1e-15 * 4.0 * float(np.max(fast["omega_e"])) + 1e-12}
    for file, encoding, says, names in [
        ("encoding_gbk.csv", "gbk", "GBK", ["时间(s)", "d轴电压(V)", "q轴电压(V)", "d轴电流(A)", "q轴电流(A)", "转速(rpm)"]),
        ("encoding_shift_jis.csv", "shift_jis", "Shift_JIS", ["時間[s]", "d軸電圧[V]", "q軸電圧[V]", "d軸電流[A]", "q軸電流[A]", "回転数[rpm]"]),
    ]:
        make.put(file, make.table(dict(zip(names, columns))), encoding=encoding)
        make.read(file, f"names in {says}", fast, told=poles, tolerances=rpm, notes=[f"read as {says}", "usual names"])


def thousandths(make):
    fast = make.part(make.FAST)
    # A motor of five times the current.
    scaled = fast | {name: fast[name] * 5123.4 for name in ("id", "iq")}
    make.put("milliamperes.csv", make.table(scaled))
    make.refuse("milliamperes.csv", "mA, which nothing says", "id and iq were in mA")
    # A motor of 25 V: in mV, its voltages are not above those of every drive.
    scaled = fast | {name: fast[name] * 500.3 for name in ("ud", "uq")}
    make.put("millivolts.csv", make.table(scaled))
    make.refuse("millivolts.csv", "mV, which nothing says", "ud and uq were in mV")


def vectors(make):
    fast = make.part(make.FAST)
    for file, says, voltage, current in [
        ("vectors_ti.csv", "vectors as TI's SDK names them", "motorVars_M1.Vdq_out_V.value[{}]", "motorVars_M1.Idq_in_A.value[{}]"),
        ("vectors_matlab.csv", "vectors with indices from one", "Vdq:{}", "Idq:{}"),
    ]:
        first = int(":" in voltage)
        names = ["time", voltage.format(first), voltage.format(first + 1), current.format(first), current.format(first + 1), "f_el [Hz]"]
        columns = dict(zip(names, [fast["t"], fast["ud"], fast["uq"], fast["id"], fast["iq"], fast["omega_e"] / (2 * np.pi)]))
        make.put(file, make.table(columns))
        make.read(file, says, fast, tolerances={"omega_e": 1e-12}, notes=["usual names"])
    parts = dict(zip(["t", "v_dq_re", "v_dq_im", "i_dq_re", "i_dq_im", "omega_e"], (fast[name] for name in make.NAMES)))
    make.put("vectors_complex.csv", make.table(parts))
    make.read("vectors_complex.csv", "vectors as real and imaginary parts", fast, notes=["usual names"])


def matlab(make):
    fast = make.part(make.FAST)
    kind = [(field, "O") for field in ("Name", "Type", "Data", "Unit", "Path", "XIndex")]
    signals = np.zeros((1, 5), dtype=kind)
    for k, (name, unit) in enumerate(zip(make.NAMES[1:], ["V", "V", "A", "A", "rad/s"])):
        signals[0, k] = (f'"Model Root"/"FOC"/"{name}"/"Out1"', "float", fast[name][None, :], unit, "Platform", 1.0)
    axis = np.zeros((1, 1), dtype=[(field, "O") for field in ("Name", "Data", "Unit")])
    axis[0, 0] = ("Time", fast["t"][None, :], "s")
    make.put_mat("controldesk.mat", {"rec1_001": {"X": axis, "Y": signals}}, do_compression=True)
    make.read("controldesk.mat", "a recording by ControlDesk, whose signals have their names beside them", fast, notes=["usual names"], same_as="canonical.csv")
    make.put_mat("to_workspace.mat", {name: np.column_stack([fast["t"], fast[name]]) for name in make.NAMES[1:]}, do_compression=True)
    make.read("to_workspace.mat", "signals that Simulink saved as arrays with time", fast, same_as="canonical.csv")
    samples = {name: {"Time": fast["t"][:, None], "Data": fast[name][None, None, :]} for name in make.NAMES[1:]}
    make.put_mat("third_dimension.mat", samples, do_compression=True)
    make.read("third_dimension.mat", "samples along the third dimension", fast, same_as="canonical.csv")


def modelica(make):
    """Matrices of version 4: what changes, what never does, and where each variable of the model is, also with the other sign."""
    fast = make.part(make.FAST)
    variables = [("time", "Simulation time [s]", 0, 1), ("smpm.Rs", "Resistance [Ohm]", 1, 2), ("smpm.ud", "Voltage [V]", 2, 2),
                 ("smpm.uq", "Voltage [V]", 2, 3), ("smpm.id", "Current [A]", 2, 4), ("smpm.iq", "Current [A]", 2, 5),
                 ("inverter.iq", "Current [A]", 2, -5), ("smpm.omega_e", "Electrical speed [rad/s|rpm]", 2, 6)]
    infos = np.array([[matrix, line, 0, -1] for *_, matrix, line in variables], dtype=np.int32)
    constants, data = np.array([[fast["t"][0], 0.958], [fast["t"][-1], 0.958]]), np.column_stack([fast[name] for name in make.NAMES])

    def letters(texts):
        return np.array([list(text.ljust(max(map(len, texts))).encode()) for text in texts], dtype=np.uint8)

    def put(file, lying):
        parts = {"Aclass": letters(["Atrajectory", "1.1", "", "binTrans" if lying else "binNormal"])}
        parts |= {"name": letters([name for name, *_ in variables]), "description": letters([text for _, text, *_ in variables]),
                  "dataInfo": infos, "data_1": constants, "data_2": data}
        content = b""
        for name, part in parts.items():
            part = part.T if lying and name != "Aclass" else part
            kind = {"uint8": 51, "int32": 20, "float64": 0}[str(part.dtype)]
            content += struct.pack("<5i", kind, *part.shape, 0, len(name) + 1) + name.encode() + b"\0" + part.tobytes(order="F")
        make.put(file, content)
        make.read(file, "a result of a Modelica tool" + (", lying" if lying else ""), fast, notes=[], same_as="canonical.csv")

    put("modelica_lying.mat", True)
    put("modelica.mat", False)


def recordings(make):
    for file, start, what in [
        ("px4.ulg", b"ULog\x01\x12\x35\x01", "ULog"),
        ("ardupilot.bin", b"\xa3\x95\x80\x80", "ArduPilot"),
        ("recording.mcap", b"\x89MCAP0\r\n", "MCAP"),
    ]:
        make.put(file, start + bytes(64))
        make.refuse(file, f"the first bytes of a recording: {what}", what, "save the table as CSV")

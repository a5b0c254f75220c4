"""Writes the containers that src/container/tests.rs reads: python make.py, with what requirements.txt names.

Every log has N rows of formulas that the tests repeat. No reader or writer of fluxfit takes part.
"""

import datetime
import decimal
import gzip
import io
import pathlib

import h5py
import numpy
import pandas
import pyarrow
import pyarrow.parquet
import scipy.io
import scipy.sparse
from asammdf import MDF, Signal

HERE = pathlib.Path(__file__).parent
N = 100

k = numpy.arange(N)
t = k * 1e-4
i_d = k / 7.0 - 2.0
i_q = numpy.sqrt(k + 1.0)
integers = {
    "i8": (k - 50).astype("i1"),
    "u8": (k + 150).astype("u1"),
    "i16": (k * 300 - 15000).astype("i2"),
    "u16": (k * 650).astype("u2"),
    "i32": (k * 20000000 - 10**9).astype("i4"),
    "u32": (k * 40000000).astype("u4"),
    "i64": (k * 2**45 - 2**51).astype("i8"),
    "u64": k.astype("u8") * 2**46 + 2**63,
}
floats = {"f32": i_d.astype("f4"), "f64": i_d}
every = {**integers, **floats}


def parquet():
    def write(name, table, **options):
        pyarrow.parquet.write_table(table, HERE / f"{name}.parquet", **options)

    log = pyarrow.table({"t": t, "id": i_d, "iq": i_q})
    for compression in ["none", "snappy", "gzip", "zstd", "lz4"]:
        write(f"{compression}", log, compression=compression)
    write("brotli", log, compression="brotli")
    write("pages_v2", log, data_page_version="2.0", data_page_size=256, row_group_size=30, use_dictionary=False)
    write("split", log, use_byte_stream_split=True, use_dictionary=False)
    write(
        "delta",
        pyarrow.table({name: every[name] for name in ["i32", "i64", "u32"]}),
        use_dictionary=False,
        column_encoding={"i32": "DELTA_BINARY_PACKED", "i64": "DELTA_BINARY_PACKED", "u32": "DELTA_BINARY_PACKED"},
    )
    write("every", pyarrow.table(every))
    nulls = pyarrow.array([None if at % 7 == 3 else float(at) for at in range(N)])
    required = pyarrow.schema([pyarrow.field("t", pyarrow.float64(), nullable=False), pyarrow.field("gaps", pyarrow.float64())])
    write("nulls", pyarrow.table([pyarrow.array(t), nulls], schema=required), row_group_size=40)
    start = datetime.datetime(2026, 3, 1, 12, 0, 0)
    instants = pyarrow.array([1772366400_000000123 + 100_001 * int(at) for at in k], pyarrow.timestamp("ns"))
    others = {
        "instant": instants,
        "millis": pyarrow.array([start + datetime.timedelta(milliseconds=int(at)) for at in k], pyarrow.timestamp("ms")),
        "day": pyarrow.array([int(at) * 1500 for at in k], pyarrow.time32("ms")),
        "decimal": pyarrow.array([decimal.Decimal(int(at) - 50) / 8 for at in k], pyarrow.decimal128(20, 3)),
        "text": pyarrow.array([f"row {at}" for at in k]),
        "flag": pyarrow.array([bool(at % 2) for at in k]),
        "list": pyarrow.array([[1.0, 2.0] for at in k]),
        "pair": pyarrow.array([{"d": float(at), "q": -float(at)} for at in k]),
    }
    write("others", pyarrow.table(others))
    write("int96", pyarrow.table({"instant": instants}), use_deprecated_int96_timestamps=True)
    write("text", pyarrow.table({"name": ["a", "b"]}))
    pandas.DataFrame({"id": i_d, "iq": i_q}, index=pandas.Index(t, name="t")).to_parquet(HERE / "pandas.parquet")


def mat():
    def write(name, content, **options):
        scipy.io.savemat(HERE / f"{name}.mat", content, **options)

    log = {"t": t, "id": i_d, "iq": i_q, "Rs": 0.05, "speed": k[::2] * 1.5}
    write("v4", log, format="4")
    write("v5", {**log, **{f"x_{name}": values for name, values in integers.items()}, "x_f32": floats["f32"]})
    write("packed", {**log, **every, "lying": numpy.array([t, i_d, i_q])}, do_compression=True, oned_as="column")
    write("matrix", {"data": numpy.column_stack([t, i_d, i_q]), "lying": numpy.array([t, i_d])})
    write("small", {"two": numpy.array([1, 2], "i2"), "four": numpy.array([1, 2, 3, 4], "u1")})
    inner = {"d": i_d, "q": i_q}
    structure = {"log": {"time": t, "i": inner, "slow": k[::10] * 1.0, "name": "bench"}}
    write("struct", structure)
    write("struct_packed", structure, do_compression=True)
    label = numpy.array([("i_d", i_d[:, None]), ("", i_q[:, None]), ("both", numpy.column_stack([i_d, i_q]))], [("label", "O"), ("values", "O")])
    simulink = {"out": {"time": t[:, None], "signals": label, "blockName": "model/Scope"}}
    write("simulink", simulink)
    write("simulink_packed", simulink, do_compression=True)
    write("two_times", {"id": {"Time": t, "Data": i_d}, "w": {"Time": t + 3e-5, "Data": i_q}})
    write(
        "mixed",
        {
            "id": i_d,
            "note": "a text",
            "cell": numpy.array(["a", 1.0], object),
            "complex": i_d + 1j * i_q,
            "sparse": scipy.sparse.csc_matrix(numpy.eye(4)),
            "flag": k % 2 == 0,
            "cube": numpy.zeros((2, 3, 4)),
        },
    )
    write("texts", {"note": "a text"})
    grid = numpy.add.outer(numpy.arange(4.0), numpy.arange(5.0))
    maps = {"motorModel": {"FluxMap_dq": {name: grid + at for at, name in enumerate(["Id", "Iq", "Fd", "Fq", "T"])}}}
    write("syre", maps, do_compression=True)
    (HERE / "opaque.mat").write_bytes(opaque("run", "timeseries"))
    (HERE / "big_endian.mat").write_bytes(big_endian())


def opaque(name, kind):
    """What MATLAB writes for an object: no Python library does. Element by element, as the format's description has it."""

    def element(number, data):
        padding = -len(data) % 8
        return number.to_bytes(4, "little") + len(data).to_bytes(4, "little") + data + bytes(padding)

    matrix = element(6, bytes([17, 0, 0, 0, 0, 0, 0, 0])) + element(1, name.encode()) + element(1, b"MCOS") + element(1, kind.encode())
    header = b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + b"\x00\x01IM"
    return header + element(14, matrix)


def big_endian():
    """As an old SPARC wrote it: one vector of doubles that are stored as 16-bit integers."""

    def element(number, data):
        padding = -len(data) % 8
        return number.to_bytes(4, "big") + len(data).to_bytes(4, "big") + data + bytes(padding)

    values = (k * 300 - 15000).astype(">i2").tobytes()
    flags = bytes([0, 0, 0, 6, 0, 0, 0, 0])
    dimensions = numpy.array([N, 1], ">i4").tobytes()
    matrix = element(6, flags) + element(5, dimensions) + element(1, b"iq") + element(3, values)
    return b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + b"\x01\x00MI" + element(14, matrix)


def hdf5():
    with h5py.File(HERE / "plain.h5", "w") as file:
        file["t"] = t
        file["t"].attrs["unit"] = "s"
        file["currents/id"] = i_d
        file["currents/id"].attrs["units"] = numpy.bytes_("A")
        file["currents/iq"] = i_q[:, None]
        file["table"] = numpy.column_stack([t, i_d, i_q])
        file["name"] = "bench"
        file["flag"] = k % 2 == 0
        file["half"] = i_d.astype("f2")
        file["scalar"] = 1.0
        file["big"] = i_d.astype(">f8")
        file["loop"] = file["/"]
    with h5py.File(HERE / "every.h5", "w") as file:
        for name, values in every.items():
            packed = {"chunks": (30,), "compression": "gzip", "shuffle": True, "fletcher32": True}
            file.create_dataset(name, data=values, **packed if name in ["u16", "i32", "u64", "f64"] else {})
    with h5py.File(HERE / "chunks.h5", "w") as file:
        table = numpy.column_stack([t, i_d, i_q])
        file.create_dataset("table", data=table, chunks=(20, 2), compression="gzip")
        file.create_dataset("growing", data=i_d, chunks=(64,), maxshape=(None,))
        file.create_dataset("many", data=i_q, chunks=(1,))
        holes = file.create_dataset("holes", (N,), dtype="f4", chunks=(10,), fillvalue=-1.5)
        holes[20:30] = 3.0
        file.create_dataset("unwritten", (N,), dtype="f8", fillvalue=numpy.nan)
    with h5py.File(HERE / "lzf.h5", "w") as file:
        file.create_dataset("id", data=i_d, compression="lzf")
    with h5py.File(HERE / "latest.h5", "w", libver="latest") as file:
        file["t"] = t
        file["id"] = i_d
    with h5py.File(HERE / "latest_chunks.h5", "w", libver="latest") as file:
        file.create_dataset("id", data=i_d, chunks=(30,))
    with h5py.File(HERE / "many_tracked.h5", "w", track_order=True) as file:
        for at in range(12):
            file[f"x{at}"] = i_d
    many_links()
    v73("v73", False)
    v73("v73_object", True)


def many_links():
    """3000 names of one array. Packed, because the names take far more room than a test needs."""
    memory = io.BytesIO()
    with h5py.File(memory, "w", libver="earliest") as file:
        array = file.create_dataset("n0000", data=numpy.zeros(200_000))
        for at in range(1, 3000):
            file[f"n{at:04}"] = array
    (HERE / "many_links.h5.gz").write_bytes(gzip.compress(memory.getvalue(), 9, mtime=0))


def v73(name, objects):
    """The layout of MATLAB's save -v7.3: 512 bytes first, dimensions reversed, classes as attributes, references into #refs#."""
    path = HERE / f"{name}.mat"
    with h5py.File(path, "w", userblock_size=512) as file:

        def array(where, key, values, kind="double"):
            values = numpy.atleast_2d(values)
            # MATLAB packs what is large.
            packed = {"chunks": values.shape, "compression": "gzip", "compression_opts": 3} if key in ["t", "iq", "data"] else {}
            data = where.create_dataset(key, data=values, **packed)
            data.attrs["MATLAB_class"] = numpy.bytes_(kind)
            return data

        if objects:
            data = array(file, "run", numpy.array([0xDD000000, 2, 1, 1, 1, 1], "u4"), "timeseries")
            data.attrs["MATLAB_object_decode"] = numpy.int32(3)
        else:
            array(file, "t", t)
            array(file, "id", i_d[:, None].T, "double")
            array(file, "iq", i_q.astype("f4")[None], "single")
            array(file, "lying", i_q[:, None])
            array(file, "data", numpy.array([t, i_d, i_q]))
            array(file, "flag", (k % 2).astype("u1"), "logical").attrs["MATLAB_int_decode"] = numpy.int32(1)
            array(file, "note", numpy.frombuffer("a text".encode("utf-16-le"), "u2")[:, None], "char")
            empty = file.create_dataset("empty", data=numpy.array([0, 0], "u8"))
            empty.attrs["MATLAB_class"] = numpy.bytes_("double")
            empty.attrs["MATLAB_empty"] = numpy.int32(1)
            out = file.create_group("out")
            out.attrs["MATLAB_class"] = numpy.bytes_("struct")
            array(out, "time", t)
            references = file.create_group("#refs#")
            signals = out.create_group("signals")
            signals.attrs["MATLAB_class"] = numpy.bytes_("struct")
            labels = ["i_d", "", "both"]
            values = [i_d, i_q, numpy.array([i_d, i_q])]
            for field, kind in [("label", "char"), ("values", "double")]:
                pointers = []
                for at in range(3):
                    data = numpy.frombuffer(labels[at].encode("utf-16-le"), "u2")[:, None] if field == "label" else values[at]
                    if data.size == 0:
                        data = references.create_dataset(f"{field}{at}", data=numpy.array([0, 0], "u8"))
                        data.attrs["MATLAB_class"] = numpy.bytes_(kind)
                        data.attrs["MATLAB_empty"] = numpy.int32(1)
                    else:
                        data = array(references, f"{field}{at}", data, kind)
                    pointers.append(data.ref)
                signals.create_dataset(field, data=numpy.array(pointers, h5py.ref_dtype)[:, None], dtype=h5py.ref_dtype)
            maps = file.create_group("motorModel/FluxMap_dq")
            grid = numpy.add.outer(numpy.arange(4.0), numpy.arange(5.0))
            for at, key in enumerate(["Id", "Iq", "Fd", "Fq", "T"]):
                array(maps, key, grid.T + at)
    header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64 HDF5 schema 1.00 .".ljust(116) + bytes(8) + b"\x00\x02IM"
    with open(path, "r+b") as file:
        file.write(header)


def mdf4():
    def write(name, **options):
        log = MDF(version="4.10")
        log.start_time = datetime.datetime(2026, 3, 1, tzinfo=datetime.timezone.utc)
        fast = [
            Signal(i_d, t, name="id", unit="A"),
            Signal(i_q.astype("f4"), t, name="iq", unit="A"),
            Signal((k * 3).astype("u2"), t, name="speed", unit="rpm", conversion={"a": 0.5, "b": -10.0}),
            Signal(numpy.array([b"on", b"off"] * (N // 2)), t, name="state", encoding="utf-8"),
        ]
        log.append(fast, common_timebase=True)
        log.append([Signal(every["i16"][::2], t[::2] + 2e-5, name="theta", unit="deg")])
        log.save(HERE / f"{name}.mf4", overwrite=True, **options)

    write("plain", compression=0)
    write("packed", compression=2)
    old = MDF(version="3.30")
    old.append([Signal(i_d, t, name="id", unit="A")])
    old.save(HERE / "old.mdf", overwrite=True)


def several_blocks():
    """More rows than are given at once, and no multiple of them."""
    values = (numpy.arange(5000) % 771).astype("u2")
    log = {"x": values, "y": values[::-1].copy()}
    pyarrow.parquet.write_table(pyarrow.table(log), HERE / "long.parquet", row_group_size=3000, compression="zstd")
    scipy.io.savemat(HERE / "long.mat", {"x": values, "lying": numpy.array([log["x"], log["y"]])}, do_compression=True)
    with h5py.File(HERE / "long.h5", "w") as file:
        file.create_dataset("x", data=values, chunks=(1500,), compression="gzip")
        file.create_dataset("y", data=values[::-1].copy()[:, None].repeat(2, 1), chunks=(700, 2), compression="gzip")


for make in [parquet, mat, hdf5, mdf4, several_blocks]:
    make()
for path in sorted(HERE.iterdir()):
    if path.stat().st_size > 20000:
        print(path.name, path.stat().st_size, "bytes: more than 20 kB")

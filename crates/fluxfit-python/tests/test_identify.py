"""identify: what comes in, what goes out, and that it is the command's answer."""

import json
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit

from conftest import LOGS


def by_command(*words: str) -> str:
    run = subprocess.run([sys.executable, "-m", "fluxfit", *words], capture_output=True, text=True, check=False)
    assert run.returncode in (0, 1), run.stderr
    return run.stdout


@pytest.mark.parametrize("log", sorted(LOGS.glob("*.csv")), ids=lambda path: path.stem)
def test_the_answer_is_that_of_the_command_to_the_bit(log: Path) -> None:
    assert fluxfit.identify(log).to_json() == by_command("identify", str(log), "--json")


def test_options_mean_the_same_as_those_of_the_command(rig: Path) -> None:
    found = fluxfit.identify(rig, prior={"rs": (0.96, "1%")}, fix={"ld": "5.25 mH"}, model="steady", method="fpa", seed=3, window=[(0.1, 0.4), (0.48, 0.595)])
    words = ["--prior", "rs=0.96±1%", "--fix", "ld=5.25mH", "--model", "steady", "--method", "fpa", "--seed", "3"]
    assert found.to_json() == by_command("identify", str(rig), *words, "--window", "0.1:0.4", "--window", "0.48:0.595", "--json")


def test_every_kind_of_table_gives_the_bits_of_the_file(rig: Path, columns: dict[str, Any]) -> None:
    pd, pa = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")
    frame = pd.DataFrame(columns)
    batches = pa.Table.from_pandas(frame).to_batches(max_chunksize=1000)
    tables: dict[str, Any] = {
        "dictionary": columns,
        "not contiguous": {name: np.repeat(values, 2)[::2] for name, values in columns.items()},
        "pandas": frame,
        "pyarrow": pa.Table.from_pandas(frame),
        "batches": pa.Table.from_batches(batches),
        "reader": pa.RecordBatchReader.from_batches(batches[0].schema, batches),
        "log": fluxfit.read_log(rig),
    }
    expected = fluxfit.identify(rig).to_dict()
    for kind, table in tables.items():
        assert fluxfit.identify(table).to_dict()["parameters"] == expected["parameters"], kind


def test_polars_and_xarray(columns: dict[str, Any], steady: fluxfit.Log) -> None:
    expected = fluxfit.identify(steady).to_dict()["parameters"]
    for name in ("polars", "xarray"):
        module = pytest.importorskip(name)
        if name == "polars":
            table = module.DataFrame({key: np.asarray(values) for key, values in steady.items()})
        else:
            table = module.Dataset({key: ("row", np.asarray(values)) for key, values in steady.items()})
        assert fluxfit.identify(table).to_dict()["parameters"] == expected


def test_types_of_arrow_are_converted(steady: fluxfit.Log) -> None:
    pa = pytest.importorskip("pyarrow")
    arrays: dict[str, Any] = {name: pa.array(values) for name, values in steady.items()}
    start = 1_700_000_000_000_000
    arrays["t"] = pa.array([start + int(round(1e6 * t)) for t in steady["t"]], pa.timestamp("us"))
    arrays["omega_e"] = pa.array(np.full(300, 400), pa.int32())
    arrays["motor"] = pa.array(["a"] * 300)
    found = fluxfit.identify(pa.table(arrays))
    assert found.lq.value == pytest.approx(12e-3, rel=1e-9)
    with_null = arrays | {"iq": pa.array([None if row == 7 else 4.0 for row in range(300)])}
    with pytest.raises(fluxfit.DataError, match="data, row 8, column 'iq'"):
        fluxfit.identify(pa.table(with_null))


def test_the_equations_are_solved(steady: fluxfit.Log) -> None:
    found = fluxfit.identify(steady)
    assert steady.truth is not None
    for name, estimate in found.parameters.items():
        assert estimate.value == pytest.approx(steady.truth[name], rel=1e-3)
        assert estimate.interval is not None and estimate.interval[0] < estimate.interval[1]
    assert found.covariance.shape == (4, 4)
    assert np.allclose(np.sqrt(np.diag(found.covariance)), [estimate.standard_error or np.nan for estimate in found.parameters.values()])


def test_a_parameter_that_the_log_does_not_tell_has_no_number() -> None:
    found = fluxfit.identify(LOGS / "id_zero_two_loads.csv", model="steady")
    assert (found.ld.value, found.ld.interval, found.ld.verdict) == (None, None, "not-identifiable")
    assert found.ld.reason and "i_d stays at zero" in found.ld.reason
    assert found.ld.remedy and not found.is_complete
    assert "not identifiable" in repr(found) and "not identifiable" in found._repr_html_()
    assert np.isnan(found.covariance[1, 1])


def test_a_motor_as_dictionary_is_compared_with(rig: Path, tmp_path: Path) -> None:
    motor = {"rs": "0.958 ohm", "ld": 5.25e-3, "pole_pairs": 4, "rating": {"current": "20 A", "voltage": "180 V", "speed": "3000 rpm"}}
    file = tmp_path / "motor.toml"
    file.write_text('[motor]\nrs = "0.958 ohm"\nld = 0.00525\npole_pairs = 4\n[rating]\ncurrent = "20 A"\nvoltage = "180 V"\nspeed = "3000 rpm"\n')
    assert fluxfit.identify(rig, motor=motor).to_json() == fluxfit.identify(rig, motor=file).to_json()


def test_columns_with_other_names_and_units(steady: fluxfit.Log) -> None:
    other = {"time": steady["t"] * 1e3, "a": steady["ud"], "b": steady["uq"], "c": steady["id"], "d": steady["iq"]}
    other["n"] = steady["omega_e"] * 30 / np.pi / 4
    mapping = {"t": "time", "ud": "a", "uq": "b", "id": "c", "iq": "d", "omega": "n"}
    found = fluxfit.identify(other, mapping=mapping, unit={"t": "ms", "omega": "rpm-mech"}, pole_pairs=4)
    assert found.psi_f.value == pytest.approx(0.1827, rel=1e-3)


def test_files_that_are_written(rig: Path, tmp_path: Path) -> None:
    found = fluxfit.identify(rig, motor={"pole_pairs": 4})
    found.report(tmp_path / "page.html")
    assert "fluxfit.identify(" in (tmp_path / "page.html").read_text()
    found.export("vesc", tmp_path / "motor.xml")
    assert "foc_motor_r" in (tmp_path / "motor.xml").read_text()
    with pytest.raises(fluxfit.RequestError, match="no target"):
        found.export("odrive", tmp_path / "x")
    with pytest.raises(fluxfit.FileError):
        found.report(tmp_path / "missing" / "page.html")


def test_a_frame_of_the_answer(rig: Path) -> None:
    pytest.importorskip("pandas")
    frame = fluxfit.identify(rig).to_pandas()
    assert list(frame.index) == ["rs", "ld", "lq", "psi_f"] and (frame.low < frame.value).all()


def test_progress_is_told_and_may_raise(rig: Path) -> None:
    steps: list[str] = []
    fluxfit.identify(rig, progress=lambda step, done, total: steps.append(step))
    assert "fit" in steps and "uncertainty" in steps

    def stop(step: str, done: "int | None", total: "int | None") -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        fluxfit.identify(rig, progress=stop)


def test_the_lock_is_released(rig: Path) -> None:
    count, done = 0, threading.Event()

    def work() -> None:
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=work)
    thread.start()
    fluxfit.identify(rig)
    done.set()
    thread.join()
    assert count > 10


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent to a process")
def test_ctrl_c_leaves_an_identification(rig: Path) -> None:
    program = f"""
import fluxfit, sys, time
print("ready", flush=True)
try:
    while True:
        fluxfit.identify({str(rig)!r})
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline() == "interrupted\n"
    assert child.wait(timeout=30) == 0


def test_documents_are_json(rig: Path) -> None:
    found = fluxfit.identify(rig)
    assert json.loads(found.to_json()) == found.to_dict()
    changed = found.to_dict()
    changed.clear()
    assert found.to_dict()["schema"] == "fluxfit.identification/1"

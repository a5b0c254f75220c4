"""fluxfit.fleet: the rows of the command, byte for byte, from files and from tables in memory."""

import html
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit

from conftest import LOGS
from test_fleet import fleet_table

pd, pa = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")


def by_command(results: Path, *words: str) -> bytes:
    run = subprocess.run([sys.executable, "-m", "fluxfit", "-q", "fleet", *words, "-o", str(results)], capture_output=True, check=False)
    assert run.returncode in (0, 1), run.stderr
    return results.read_bytes()


@pytest.fixture(scope="module")
def table() -> Any:
    return fleet_table(12)


@pytest.fixture(scope="module")
def file(table: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fleet") / "fleet.parquet"
    table.to_parquet(path, row_group_size=1000)
    return path


def test_every_kind_of_table_has_the_bytes_of_the_command(table: Any, file: Path, tmp_path: Path) -> None:
    expected = {ending: by_command(tmp_path / f"c.{ending}", str(file), "--by", "motor_id") for ending in ("csv", "parquet")}
    text = expected["csv"].decode()
    assert text.count("\n") == 13 and text.count(",identified,") == 4 * 11 and text.count("omega_e is zero") == 1
    arrow = pa.Table.from_pandas(table)
    coded = arrow.set_column(0, "motor_id", arrow["motor_id"].dictionary_encode())
    tables = {
        "path": file,
        "pandas": table,
        "pyarrow": arrow,
        "dictionary of Arrow": coded,
        "batches": pa.Table.from_batches(arrow.to_batches(max_chunksize=700)),
        "arrays": {name: table[name].to_numpy() for name in table.columns},
        "a list of names": {name: list(table[name]) for name in table.columns},
        "structured": table.to_records(index=False),
    }
    polars = pytest.importorskip("polars")
    tables["polars"] = polars.DataFrame({name: table[name].to_list() for name in table.columns})
    tables["xarray"] = pytest.importorskip("xarray").Dataset({name: ("row", table[name].to_numpy()) for name in table.columns})
    for kind, given in tables.items():
        found = fluxfit.fleet(given, "motor_id", jobs=2, source=str(file))
        for ending, bytes_ in expected.items():
            found.write(tmp_path / f"p.{ending}")
            assert (tmp_path / f"p.{ending}").read_bytes() == bytes_, kind


def test_names_may_be_whole_numbers(table: Any, tmp_path: Path) -> None:
    numbered = table.assign(motor_id=table["motor_id"].str[1:].astype(int))
    numbered.to_parquet(tmp_path / "fleet.parquet")
    expected = by_command(tmp_path / "c.csv", str(tmp_path / "fleet.parquet"), "--by", "motor_id")
    for given in (numbered, {name: numbered[name].to_numpy() for name in numbered.columns}):
        fluxfit.fleet(given, "motor_id", source=str(tmp_path / "fleet.parquet")).write(tmp_path / "p.csv")
        assert (tmp_path / "p.csv").read_bytes() == expected


def test_logs_are_motors_and_options_mean_the_same(tmp_path: Path) -> None:
    logs = [str(LOGS / "id_zero_two_loads.csv"), "missing.csv"]
    words = ["--model", "steady", "--prior", "rs=0.96±1%", "--every", "0.5s", "--seed", "3"]
    expected = by_command(tmp_path / "c.csv", *logs, *words)
    found = fluxfit.fleet(logs, model="steady", prior={"rs": (0.96, "1%")}, every=0.5, seed=3, output=tmp_path / "p.csv")
    assert (tmp_path / "p.csv").read_bytes() == expected
    assert "there is no such file" in found["error"][-1]


def test_the_rows_as_arrays_as_a_frame_and_as_arrow(table: Any) -> None:
    found = fluxfit.fleet(table, "motor_id")
    assert repr(found) == "<Fleet: 12 motors, 12 rows: 11 with all 4 parameters identified, 0 with fewer, 1 without an answer>"
    assert found["rs"].dtype == np.float64 and np.isnan(found["rs"][11]) and found.rows == 12
    assert np.allclose(found["rs"][:11], 0.5 + 0.01 * np.arange(11), rtol=1e-2)
    assert found["error"][0] is None and found["rows"][0] == 300 and found["seed"].dtype == np.int64
    frame = found.to_pandas()
    assert list(frame.columns) == list(found) and frame["rows"].dtype == "Int64" and len(frame) == 12
    arrow = pa.table(found)
    assert arrow.column_names == list(found) and arrow["rs"].to_pylist()[:11] == list(found["rs"][:11]) and arrow["rs"][11].as_py() is None


def shown(page: Path) -> str:
    """What a page says of its fleet, without its heading, and without how it was made."""
    body = page.read_text(encoding="utf-8").split('<p class="found">', 1)[1]
    return body.split('id="reproduce"')[0]


def test_the_page_is_that_of_the_command(table: Any, file: Path, tmp_path: Path) -> None:
    expected, page = tmp_path / "expected.html", tmp_path / "page.html"
    asked: list[tuple[dict[str, Any], list[str]]] = [({}, []), ({"every": "0.1s"}, ["--every", "0.1s"])]
    for keywords, words in asked:
        by_command(tmp_path / "c.csv", str(file), "--by", "motor_id", "--report", str(expected), *words)
        assert "the worst first" in shown(expected) and "m011" in shown(expected)
        given_as: list[tuple[Any, dict[str, Any]]] = [(file, {"output": tmp_path / "c.csv"}), (table, {"source": str(file)})]
        for given, more in given_as:
            fluxfit.fleet(given, "motor_id", **keywords, **more).report(page)
            assert shown(page) == shown(expected)
        # How it is made again is the call, and its parts are words.
        call = "fluxfit.fleet(data, 'motor_id', every='0.1s')" if keywords else "fluxfit.fleet(data, 'motor_id')"
        made = page.read_text(encoding="utf-8").split('id="reproduce"')[1].split("<code>")[1].split("</code>")[0]
        assert html.unescape(re.sub("<[^>]*>", "", made)) == call
    found = fluxfit.fleet(table, "motor_id")
    with pytest.raises(fluxfit.RequestError, match="writes an HTML page, not pdf"):
        found.report(tmp_path / "page.pdf")
    with pytest.raises(fluxfit.FileError):
        found.report(tmp_path / "missing" / "page.html")


def test_what_fails_is_a_row(table: Any) -> None:
    apart = pd.concat([table, table[:300]])
    apart.loc[apart["motor_id"] == "m004", "motor_id"] = None
    apart.loc[(apart["motor_id"] == "m005") & (apart["t"] == 0.0), "uq"] = np.nan
    apart.loc[apart["motor_id"] == "m006", "uq"] = np.nan
    found = fluxfit.fleet(apart, "motor_id").to_pandas().set_index("motor")["error"]
    assert "stand in several places" in found["m000"] and "rows of table have no motor_id" in found[""]
    assert "motor m005 of table, row 1, column 'uq'" in found["m005"]
    assert "motor m006 of table, column 'uq': the column has no number" in found["m006"]
    assert found.notna().sum() == 5 and len(found) == 12


def test_refusals(table: Any, file: Path, tmp_path: Path) -> None:
    refused: list[tuple[type[fluxfit.Error], tuple[Any, ...], dict[str, Any], str]] = [
        (fluxfit.RequestError, (table,), {}, "needs by=COLUMN"),
        (fluxfit.RequestError, (table, "motor_id"), {"output": "x.csv"}, "output is for logs"),
        (fluxfit.RequestError, (file, "motor_id"), {"output": "x.xlsx"}, "name them .csv or .parquet"),
        (fluxfit.RequestError, (file, "motor_id"), {"every": "0s"}, "longer than zero"),
        (fluxfit.DataError, (table, "motor"), {}, "no column 'motor' that names the motors; the columns are motor_id, t"),
        (fluxfit.DataError, (dict(table.drop(columns="motor_id")), "motor"), {}, "no column 'motor' that names the motors; the columns are t"),
        (fluxfit.DataError, (table, "iq"), {}, "neither texts nor whole numbers"),
        (fluxfit.RequestError, ({"m": ["a"], "t": [0.0, 1.0]}, "m"), {}, "the table has 2 rows, and the column that names their motors 1"),
    ]
    for kind, arguments, keywords, sentence in refused:
        with pytest.raises(kind, match=sentence) as caught:
            fluxfit.fleet(*arguments, **keywords)
        assert "--" not in str(caught.value)
    empty = fluxfit.fleet(table[:0], "motor_id")
    assert empty.rows == 1 and "no row below the header" in empty["error"][0]


def test_progress_is_told_and_may_raise(table: Any, file: Path) -> None:
    for data, total in ((table, 12), (file, None)):
        steps: list[Any] = []
        fluxfit.fleet(data, "motor_id", progress=lambda *step: steps.append(step))
        assert steps == [("motors", done, total) for done in range(1, 13)]

        def stop(step: str, done: "int | None", total: "int | None") -> None:
            raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            fluxfit.fleet(data, "motor_id", progress=stop)


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent to a process")
@pytest.mark.parametrize("is_table", [False, True])
def test_ctrl_c_leaves_a_fleet_and_what_is_finished_stays(table: Any, tmp_path: Path, is_table: bool) -> None:
    many = pd.concat([table[:3300].assign(motor_id=lambda frame: frame["motor_id"] + f"-{copy}") for copy in range(200)])
    many.to_parquet(tmp_path / "fleet.parquet")
    program = f"""
import fluxfit, pandas as pd
path = {str(tmp_path / "fleet.parquet")!r}
data, more = (pd.read_parquet(path), {{}}) if {is_table} else (path, {{"output": {str(tmp_path / "results.csv")!r}}})
def told(step, done, total):
    if done == 20:
        print("ready", flush=True)
try:
    fluxfit.fleet(data, "motor_id", progress=told, **more)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    start = time.monotonic()
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline() == "interrupted\n"
    assert child.wait(timeout=30) == 0 and time.monotonic() - start < 10
    if not is_table:
        assert not (tmp_path / "results.csv").exists()
        finished = (tmp_path / "results.csv.journal").read_text().count("\n") - 1
        assert 20 <= finished < 2200
        # The command goes on where the call was interrupted.
        words = ["fleet", str(tmp_path / "fleet.parquet"), "--by", "motor_id", "-o", str(tmp_path / "results.csv")]
        run = subprocess.run([sys.executable, "-m", "fluxfit", *words], capture_output=True, text=True, check=False)
        assert f"{finished} motors are finished already" in run.stderr and "2200 motors, 2200 rows" in run.stdout


def test_a_motor_of_many_rows_in_a_file_has_the_rows_of_the_table_in_memory(table: Any, tmp_path: Path) -> None:
    rows = np.arange(540_000)
    i_d, i_q = np.array([0.0, -2.0, 0.0])[rows // 3000 % 3], np.array([9.0, 8.5, 4.0])[rows // 3000 % 3]
    noise = np.random.default_rng(1).normal(scale=0.01, size=(2, len(rows)))
    long = {"motor_id": "long", "t": pd.Timestamp("2026-01-01T08:00") + pd.to_timedelta(rows * 100, unit="us")}
    long |= {"ud": 0.7 * i_d - 400.0 * 12e-3 * i_q, "uq": 0.7 * i_q + 400.0 * (5.25e-3 * i_d + 0.1827)}
    long |= {"id": i_d + noise[0], "iq": i_q + noise[1], "omega_e": np.full(len(rows), 400.0)}
    few = table[:600].assign(t=pd.Timestamp("2026-01-01T07:00") + pd.to_timedelta(table["t"][:600], unit="s"))
    several = pd.concat([few[:300], pd.DataFrame(long), few[300:]], ignore_index=True)
    several.to_parquet(tmp_path / "fleet.parquet", row_group_size=100_000)
    # Windows show that times count from the first row of the file in both.
    keywords: dict[str, Any] = {"every": "10s", "model": "steady"}
    expected = fluxfit.fleet(several, "motor_id", **keywords).to_pandas().drop(columns="source")
    found = fluxfit.fleet(tmp_path / "fleet.parquet", "motor_id", **keywords).to_pandas().drop(columns="source")
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    ours = found[found["motor"] == "long"]
    assert ours["error"].isna().all() and np.allclose(ours["rs"], 0.7, rtol=0.02) and ours["rows"].sum() < 540_000

"""Fleets: the same rows on one machine, on Dask and on Spark, also when a worker is lost."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit
from fluxfit._fleet import columns

pd = pytest.importorskip("pandas")


def fleet_table(motors: int) -> Any:
    """Logs of motors at three operating points, by the motor's equations; the last one stands still."""
    i_d, i_q = np.repeat([0.0, -2.0, 0.0], 100), np.repeat([9.0, 8.5, 4.0], 100)
    ld, lq, psi_f = 5.25e-3, 12e-3, 0.1827
    frames = []
    for number in range(motors):
        rs, omega = 0.5 + 0.01 * number, 0.0 if number == motors - 1 else 400.0
        frame = {"motor_id": f"m{number:03}", "t": np.arange(300) * 1e-3, "ud": rs * i_d - omega * lq * i_q}
        frame |= {"uq": rs * i_q + omega * (ld * i_d + psi_f), "id": i_d, "iq": i_q, "omega_e": np.full(300, omega)}
        frames.append(pd.DataFrame(frame))
    return pd.concat(frames, ignore_index=True)


def descendants(of: int) -> "list[tuple[int, str]]":
    """The processes that a process has started, and those that they have: number and command."""
    processes = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
            processes.append((int(folder.name), parent, (folder / "cmdline").read_text()))
        except OSError:  # it has ended meanwhile
            continue
    found, parents = [], {of}
    while parents:
        children = [(pid, command) for pid, parent, command in processes if parent in parents]
        found += children
        parents = {pid for pid, _ in children}
    return found


class Killer:
    """Kills a process of ours after a while, and knows when."""

    def __init__(self, after: float, find: "Callable[[], int]") -> None:
        self.at = float("inf")
        self._find = find
        self._timer = threading.Timer(after, self._kill)
        self._timer.start()

    def _kill(self) -> None:
        os.kill(self._find(), signal.SIGKILL)
        self.at = time.monotonic()

    def was_before(self, end: float) -> bool:
        self._timer.join()
        return self.at < end


@pytest.fixture(scope="module")
def table() -> Any:
    return fleet_table(40)


@pytest.fixture(scope="module")
def expected(table: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The rows of the command."""
    folder = tmp_path_factory.mktemp("fleet")
    table.to_parquet(folder / "fleet.parquet", row_group_size=1000)
    words = ["fleet", str(folder / "fleet.parquet"), "--by", "motor_id", "-o", str(folder / "results.parquet")]
    run = subprocess.run([sys.executable, "-m", "fluxfit", *words], capture_output=True, text=True, check=False)
    assert run.returncode == 1 and "40 motors, 40 rows: 39 with" in run.stdout, run.stdout + run.stderr
    return pd.read_parquet(folder / "results.parquet")


def comparable(frame: Any) -> str:
    """Every digit of every row, sorted by motor; the source is where the table was."""
    frame = frame[list(columns())].sort_values(["motor", "window_start"]).reset_index(drop=True)
    frame["error"] = frame["error"].str.replace(r"of \S+:", "of table:", regex=True)
    text: str = frame.drop(columns="source").to_csv(float_format="%.17g")
    return text


def test_the_columns_are_those_of_the_command(expected: Any) -> None:
    assert list(expected.columns) == list(columns())
    assert expected["rs"].iloc[7] == pytest.approx(0.57, rel=1e-2)
    assert expected["error"].notna().sum() == 1 and "omega_e is zero" in expected["error"].iloc[39]


def test_dask_gives_the_same_rows_also_when_a_worker_is_killed(table: Any, expected: Any) -> None:
    dd, distributed = pytest.importorskip("dask.dataframe"), pytest.importorskip("distributed")
    import fluxfit.dask

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster):
        shuffled = table.sample(frac=1, random_state=1)
        found = fluxfit.dask.fleet(dd.from_pandas(shuffled, npartitions=6), "motor_id").compute()
        assert comparable(found) == comparable(expected)
        lost = next(iter(cluster.workers.values())).process.pid
        killer = Killer(0.1, lambda: lost)
        found = fluxfit.dask.fleet(dd.from_pandas(shuffled, npartitions=20), "motor_id").compute()
        assert killer.was_before(time.monotonic())
        assert comparable(found) == comparable(expected)


def test_rows_without_a_motor_are_refused(table: Any) -> None:
    dd = pytest.importorskip("dask.dataframe")
    import fluxfit.dask

    nameless = table[:600].copy()
    nameless.loc[300:, "motor_id"] = None
    found = fluxfit.dask.fleet(dd.from_pandas(nameless, npartitions=2), "motor_id").compute(scheduler="sync").sort_values("motor")
    assert list(found["motor"]) == ["", "m000"]
    assert found["error"].iloc[0] == "rows of table have no motor_id; name their motor" and found["rs_verdict"].iloc[1] == "identified"


def test_dask_takes_files(rig: Path) -> None:
    pytest.importorskip("dask.dataframe")
    import fluxfit.dask

    found = fluxfit.dask.files([str(rig), "missing.csv"]).compute(scheduler="sync")
    assert found["rs"].iloc[0] == fluxfit.identify(rig).rs.value
    assert "there is no such file" in found["error"].iloc[1]


def test_spark_gives_the_same_rows_also_when_an_executor_is_killed(table: Any, expected: Any, tmp_path: Path) -> None:
    sql = pytest.importorskip("pyspark.sql")
    if subprocess.run(["java", "-version"], capture_output=True, check=False).returncode:
        pytest.skip("Spark needs Java 17")
    import fluxfit.spark

    os.environ["PYSPARK_PYTHON"] = sys.executable
    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    builder = sql.SparkSession.builder.master("local-cluster[2,1,1024]").appName("fluxfit")
    # The executors import the package of this environment, wherever it is installed.
    package = str(Path(fluxfit.__file__).parents[1])
    for key, value in {
        "spark.ui.enabled": "false",
        "spark.sql.shuffle.partitions": "8",
        "spark.driver.host": "127.0.0.1",
        "spark.executorEnv.PYTHONPATH": package,
        "spark.local.dir": str(tmp_path),
    }.items():
        builder = builder.config(key, value)
    session = builder.getOrCreate()
    try:
        path = tmp_path / "fleet.parquet"
        table.sample(frac=1, random_state=1).to_parquet(path)
        frame = session.read.parquet(str(path)).repartition(6)
        assert comparable(fluxfit.spark.fleet(frame, "motor_id").toPandas()) == comparable(expected)

        def executor() -> int:
            return next(pid for pid, command in descendants(os.getpid()) if "CoarseGrainedExecutorBackend" in command)

        killer = Killer(0.3, executor)
        found = fluxfit.spark.fleet(frame, "motor_id").toPandas()
        assert killer.was_before(time.monotonic())
        assert comparable(found) == comparable(expected)
    finally:
        session.stop()

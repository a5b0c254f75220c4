"""The same fleet on one machine, on Dask and on Spark: motors a second for each worker, and whether the rows are the same. Prints Markdown.

    cluster.py [motors]      default 600; in an environment with the package fluxfit and with cluster-requirements.txt; Spark needs Java 17

The clusters run on this machine, on the loopback: two workers of one thread each, started before the clock. Exit status 1 if a row differs.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

import dask.dataframe as dd
import pandas as pd
from distributed import Client, LocalCluster
from pyspark.sql import SparkSession

import fluxfit
import fluxfit.dask
import fluxfit.spark
from fleet import ROWS, run, write

WORKERS = 2
WARMING = 4  # motors that are identified before the clock starts, so that every worker has loaded what it needs
PARTITIONS = 8  # of the shuffled table
DAY = 86400  # s
MILLION = 1_000_000


def of_command(path, folder, jobs):
    results = folder / f"{jobs}.parquet"
    took = run([sys.executable, "-m", "fluxfit", "-q", "fleet", path, "--by", "motor_id", "-o", results, "--jobs", str(jobs)])
    return took.clock, pd.read_parquet(results)


def timed(work):
    start = time.perf_counter()
    found = work()
    return time.perf_counter() - start, found


def of_dask(path, few):
    cluster = LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster):
        fluxfit.dask.fleet(dd.from_pandas(few, npartitions=WORKERS), "motor_id").compute()
        return timed(lambda: fluxfit.dask.fleet(dd.read_parquet(path, split_row_groups=True), "motor_id").compute())


def of_spark(path, few, folder):
    os.environ["PYSPARK_PYTHON"] = sys.executable
    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    settings = {
        "spark.ui.enabled": "false",
        "spark.ui.showConsoleProgress": "false",
        "spark.driver.host": "127.0.0.1",
        "spark.local.dir": str(folder),
        "spark.sql.shuffle.partitions": str(PARTITIONS),
        # The executors import the package of this environment, wherever it is installed.
        "spark.executorEnv.PYTHONPATH": str(Path(fluxfit.__file__).parents[1]),
    }
    builder = SparkSession.builder.master(f"local-cluster[{WORKERS},1,1024]").appName("fluxfit")
    for key, value in settings.items():
        builder = builder.config(key, value)
    session = builder.getOrCreate()
    try:
        fluxfit.spark.fleet(session.createDataFrame(few).repartition(WORKERS), "motor_id").toPandas()
        return timed(lambda: fluxfit.spark.fleet(session.read.parquet(str(path)), "motor_id").toPandas())
    finally:
        session.stop()


def digits(frame):
    """Every digit of every row, in one order; the source is where the table was."""
    ordered = frame.drop(columns="source").sort_values(["motor", "window_start"]).reset_index(drop=True)
    return ordered.to_csv(float_format="%.17g")


def main():
    motors = int(sys.argv[1]) if len(sys.argv) > 1 else 600
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / "fleet.parquet"
        write(path, motors)
        few = pd.read_parquet(path, filters=[("motor_id", "<", f"m{WARMING:06}")])
        measured = {
            ("`fluxfit fleet --jobs 1`", 1): of_command(path, folder, 1),
            (f"`fluxfit fleet --jobs {WORKERS}`", WORKERS): of_command(path, folder, WORKERS),
            ("Dask", WORKERS): of_dask(path, few),
            ("Spark", WORKERS): of_spark(path, few, folder),
        }
    seconds, rows = measured["`fluxfit fleet --jobs 1`", 1]
    alone, expected = motors / seconds, digits(rows)
    print(f"{motors} motors of {ROWS} rows\n")
    print("| engine | workers | motors/s | of one job, each worker | workers for 10⁶ motors a day | same rows |\n|---|--:|--:|--:|--:|---|")
    same = True
    for (engine, workers), (seconds, found) in measured.items():
        each = motors / seconds / workers
        is_same = digits(found) == expected
        same &= is_same
        shown = f"{each * workers:.1f} | {each / alone:.2f} | {MILLION / DAY / each:.1f} | {'yes' if is_same else 'NO'}"
        print(f"| {engine} | {workers} | {shown} |")
    sys.exit(not same)


if __name__ == "__main__":
    main()

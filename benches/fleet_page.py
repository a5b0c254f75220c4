"""The page of a large fleet from finished results: `fluxfit fleet RESULTS --report PAGE`, time and memory for Parquet and for CSV. Prints
Markdown.

    fleet_page.py [directory of fluxfit] [rows]      default target/release 240000

The results are drawn here, 24 windows for each motor: a third of the parameters are weak and have a reason with numbers of its own, one row
of fifty has an error in place of an answer. Exit status 1 if the memory exceeds its limit.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq

WINDOWS, HOUR = 24, 3600.0
WEAK, FAILED = 1 / 3, 1 / 50  # parts of the parameters, and of the rows
SEED = 1
TYPICAL = {"rs": 0.95, "ld": 5.25e-3, "lq": 12e-3, "psi_f": 0.1827}
MEMORY_LIMIT_MB = 300


def drawn(rows):
    rng = np.random.default_rng(SEED)
    motor = np.arange(rows) // WINDOWS
    start = np.arange(rows) % WINDOWS * HOUR
    failed = rng.random(rows) < FAILED
    columns = {
        "motor": [f"m{number:06}" for number in motor],
        "window_start": start,
        "window_end": start + HOUR,
        "rows": pa.array(np.full(rows, 9000)),
        "duration_s": np.full(rows, 3599.9),
        "model": pa.array(["output-error"] * rows),
    }
    for name, typical in TYPICAL.items():
        weak = rng.random(rows) < WEAK
        spread = rng.normal(1, 0.05, motor[-1] + 1)[motor]
        error = np.where(weak, rng.uniform(0.04, 0.2, rows), 0.005)
        value = typical * spread * (1 + error * rng.normal(size=rows))
        numbers = {"": value, "_low": value * (1 - 1.96 * error), "_high": value * (1 + 1.96 * error), "_standard_error": value * error}
        columns |= {name + end: pa.array(numbers[end], mask=failed) for end in numbers}
        verdict = np.where(failed, "not-identifiable", np.where(weak, "weak", "identified"))
        reasons = [f"the log determines it to ±{196 * part:.3f} % only: the current moves by {part:.5f} of its rated value" for part in error]
        columns[f"{name}_verdict"] = pa.array(verdict)
        columns[f"{name}_reason"] = pa.array(reasons, mask=failed | ~weak)
    columns["warnings"] = pa.array(np.where(rng.random(rows) < 0.5, "coarse-sampling stale-samples", ""), mask=failed)
    errors = [f"motor m{number:06} of fleet.parquet, row {row}: 'x' is not a number" for row, number in enumerate(motor)]
    columns["error"] = pa.array(errors, mask=~failed)
    columns["source"] = pa.array(["fleet.parquet"] * rows)
    columns["seed"] = pa.array(np.ones(rows, dtype=np.int64))
    columns["version"] = pa.array(["0.2.0"] * rows)
    return pa.table(columns)


def run(words):
    """Seconds by the clock, and the largest resident memory, MB."""
    start = time.perf_counter()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    memory = 0.0
    while not os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT):
        time.sleep(0.01)
        try:
            # The resources of a child that has ended hold the memory of this program, from which it was forked.
            memory = int(Path(f"/proc/{process.pid}/status").read_text().split("VmHWM:")[1].split()[0]) / 1024
        except (OSError, IndexError):  # it has ended meanwhile
            pass
    if process.wait() not in (0, 1):
        sys.exit(f"{words} ended with status {process.returncode}")
    return time.perf_counter() - start, memory


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release") / "fluxfit"
    rows = int(sys.argv[2]) if len(sys.argv) > 2 else 240_000
    print("| results | rows | file, MB | s | resident, MB |\n|---|--:|--:|--:|--:|")
    largest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        results = {name: Path(folder) / f"results.{name.lower()}" for name in ("Parquet", "CSV")}
        table = drawn(rows)
        pq.write_table(table, results["Parquet"])
        pyarrow.csv.write_csv(table, results["CSV"], pyarrow.csv.WriteOptions(quoting_style="needed"))
        for name, path in results.items():
            took, memory = run([program, "-q", "fleet", path, "--report", Path(folder) / f"{name}.html"])
            largest = max(largest, memory)
            print(f"| {name} | {rows} | {path.stat().st_size / 1e6:.0f} | {took:.1f} | {memory:.0f} |")
    sys.exit(largest > MEMORY_LIMIT_MB)


if __name__ == "__main__":
    main()

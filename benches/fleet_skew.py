"""One motor with many rows among motors with few: `fluxfit fleet` on a Parquet table, time and memory for several lengths. Prints Markdown.

    fleet_skew.py [directory of fluxfit] [rows ...]      default target/release 1000000 10000000

All motors are at three operating points, by the motor's equations, with noise on the currents. Exit status 1 if the memory with the longest
motor is more than a fifth above that with the shortest, or a parameter of a long motor is more than five percent from the truth.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from fleet_page import run

FEW, SMALL = 10, 9000  # motors beside the long one, and their rows
POINT = 3000  # rows at one operating point
PERIOD, NOISE = 1e-4, 0.01  # s, A
GROUP = 1 << 20  # rows that are made and written at a time
TRUE = {"rs": 0.95, "ld": 5.25e-3, "lq": 12e-3, "psi_f": 0.1827}
OMEGA = 400.0  # electrical rad/s
LARGEST_ERROR = 0.05
SEED = 1


def rows(name, first, last, rng):
    rs, ld, lq, psi_f = TRUE.values()
    row = np.arange(first, last)
    i_d, i_q = np.array([0.0, -2.0, 0.0])[row // POINT % 3], np.array([9.0, 8.5, 4.0])[row // POINT % 3]
    noise = rng.normal(scale=NOISE, size=(2, len(row)))
    voltages = {"ud": rs * i_d - OMEGA * lq * i_q, "uq": rs * i_q + OMEGA * (ld * i_d + psi_f)}
    names = pa.DictionaryArray.from_arrays(pa.array(np.zeros(len(row), np.int32)), pa.array([name])).cast(pa.string())
    columns = {"motor_id": names, "t": row * PERIOD, **voltages, "id": i_d + noise[0], "iq": i_q + noise[1]}
    return pa.table(columns | {"omega_e": np.full(len(row), OMEGA)})


def write(path, long):
    rng, writer = np.random.default_rng(SEED), None
    motors = [(f"a{k}", SMALL) for k in range(FEW // 2)] + [("long", long)] + [(f"z{k}", SMALL) for k in range(FEW - FEW // 2)]
    for name, count in motors:
        for first in range(0, count, GROUP):
            table = rows(name, first, min(count, first + GROUP), rng)
            writer = writer or pq.ParquetWriter(path, table.schema)
            writer.write_table(table)
    writer.close()


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release") / "fluxfit"
    lengths = [int(word) for word in sys.argv[2:]] or [1_000_000, 10_000_000]
    print("| rows of the long motor | file, MB | s | resident, MB | rows that are taken |\n|--:|--:|--:|--:|--:|")
    memories, is_right = [], True
    with tempfile.TemporaryDirectory() as folder:
        fleet, results = Path(folder) / "fleet.parquet", Path(folder) / "results.csv"
        for long in lengths:
            write(fleet, long)
            took, memory = run([program, "-q", "fleet", fleet, "--by", "motor_id", "-o", results])
            found = pd.read_csv(results).set_index("motor").loc["long"]
            print(f"| {long} | {fleet.stat().st_size / 1e6:.0f} | {took:.0f} | {memory:.0f} | {found['rows']} |", flush=True)
            memories.append(memory)
            is_right &= all(abs(found[name] / true - 1) <= LARGEST_ERROR for name, true in TRUE.items())
    sys.exit(not (is_right and memories[-1] <= 1.2 * memories[0]))


if __name__ == "__main__":
    main()

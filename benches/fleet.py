"""A fleet of synthetic motors in one Parquet file through `fluxfit fleet`: motors a second with one job and with two, memory, and a run that
is killed ten times. Prints Markdown.

    fleet.py [directory of fluxfit] [motors]      default target/release 10000

The motors are drawn and simulated here, in numpy: 9000 rows at 10 kHz, voltages held over a period in the rotor's frame, current control by
measured currents with noise. So their parameters are known from outside of fluxfit. Exit status 1 if a limit is exceeded.
"""

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import namedtuple
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.linalg import expm

ROWS, PERIOD = 9000, 1e-4  # s
TOGETHER = 500  # motors simulated and written at a time
NOISE = 0.005  # of the largest current, on each current
BANDWIDTH = 2 * np.pi * 200  # of the current control, rad/s
KILLS = 10
LOOK = 0.1  # s between two looks at a run
SEED = 1

SCALING_LIMIT = 0.9  # of twice the motors a second, with two jobs
MEMORY_LIMIT_MB = 1000
PARAMETERS = ("rs", "ld", "lq", "psi_f")


Took = namedtuple("Took", "clock processor busiest asked memory")


def drawn(rng, count):
    """Motors from servo to traction size, and a constant speed for each: time constants are long and turns short beside the period."""
    ld = 10 ** rng.uniform(-3.7, -2.0, count)
    motors = {"ld": ld, "lq": ld * rng.uniform(1.0, 2.5, count), "rs": ld / rng.uniform(3e-3, 20e-3, count)}
    motors["psi_f"] = 10 ** rng.uniform(-2.0, -0.5, count)
    return motors, rng.uniform(100, 600, count)


def simulated(rng, motors, omega):
    """Columns of shape (motors, rows). The equations of the winding are solved exactly over each period."""
    rs, ld, lq, psi_f = (motors[name] for name in ("rs", "ld", "lq", "psi_f"))
    count = len(rs)
    largest = 0.4 * psi_f / ld  # A: the flux of the current is about that of the magnets
    system = np.zeros((count, 4, 4))  # of i_d, i_q, and the voltages less that of the magnets, which are held
    system[:, 0, 0], system[:, 0, 1], system[:, 0, 2] = -rs / ld, omega * lq / ld, 1 / ld
    system[:, 1, 0], system[:, 1, 1], system[:, 1, 3] = -omega * ld / lq, -rs / lq, 1 / lq
    step = expm(system * PERIOD)[:, :2]
    inductance, gain = np.stack([ld, lq]), BANDWIDTH * np.stack([ld, lq])
    t = np.arange(ROWS) * PERIOD
    wanted = np.stack([np.where(t < 0.45, 0.0, -0.3), np.select([t < 0.25, t < 0.7], [0.8, 0.4], 0.7)], axis=1)
    current, integral = np.zeros((2, count)), np.zeros((2, count))
    voltages, currents = np.empty((ROWS, 2, count), np.float32), np.empty((ROWS, 2, count), np.float32)
    noise = rng.normal(size=(ROWS, 2, count)) * NOISE * largest
    magnets = np.stack([np.zeros(count), omega * psi_f])
    turning = np.stack([-omega, omega]) * inductance[::-1]
    for row in range(ROWS):
        measured = current + noise[row]
        error = wanted[row][:, None] * largest - measured
        integral += BANDWIDTH * rs * PERIOD * error
        voltage = gain * error + integral + turning * measured[::-1] + magnets
        voltages[row], currents[row] = voltage, measured
        held = np.concatenate([current, voltage - magnets])
        current = np.einsum("mij,jm->im", step, held)
    return t, voltages, currents


def write(path, motors):
    """The fleet as a table, and the true parameters."""
    rng = np.random.default_rng(SEED)
    truths, writer = [], None
    for first in range(0, motors, TOGETHER):
        count = min(TOGETHER, motors - first)
        truth, omega = drawn(rng, count)
        t, voltages, currents = simulated(rng, truth, omega)
        names = [f"m{number:06}" for number in range(first, first + count)]
        flat = lambda values: np.ascontiguousarray(values.T).ravel()  # noqa: E731
        columns = {
            "motor_id": pa.array(np.repeat(names, ROWS)),
            "t": np.tile(t, count),
            "ud": flat(voltages[:, 0]),
            "uq": flat(voltages[:, 1]),
            "id": flat(currents[:, 0]),
            "iq": flat(currents[:, 1]),
            "omega_e": np.repeat(omega, ROWS),
        }
        table = pa.table(columns)
        writer = writer or pq.ParquetWriter(path, table.schema)
        writer.write_table(table, row_group_size=20 * ROWS)
        truths.append(pd.DataFrame(truth, index=names))
    writer.close()
    return pd.concat(truths)


def command(programs, fleet, results, jobs):
    return [programs / "fluxfit", "-q", "fleet", fleet, "--by", "motor_id", "-o", results, "--jobs", str(jobs)]


def run(words):
    """What a run took: seconds by the clock, of the processor and of the busiest thread; cores that it asked for; the largest resident
    memory, MB."""
    start = time.perf_counter()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    folder, running, queued, memory = Path(f"/proc/{process.pid}"), {}, {}, 0.0
    while not os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT):
        time.sleep(LOOK)
        try:
            # Nanoseconds of each thread on a core, and in the queue for one: together they do not depend on other work on the machine.
            for task in (folder / "task").iterdir():
                running[task.name], queued[task.name], _ = (int(word) / 1e9 for word in (task / "schedstat").read_text().split())
            # The resources of a child that has ended hold the memory of this program, from which it was forked.
            memory = int((folder / "status").read_text().split("VmHWM:")[1].split()[0]) / 1024
        except (OSError, IndexError, ValueError):  # a thread, or the whole, has ended meanwhile
            pass
    clock = time.perf_counter() - start
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):
        sys.exit(f"{words} ended with status {process.returncode}")
    asked = (sum(running.values()) + sum(queued.values())) / clock
    return Took(clock, used.ru_utime + used.ru_stime, max(running.values()), asked, memory)


def killed(words, results, seconds):
    """Kills a run at random instants and starts it again, then lets it end. Returns the number of kills."""
    rng = random.Random(SEED)
    journal = Path(f"{results}.journal")
    kills = 0
    while kills < KILLS:
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(rng.uniform(0, 1.5 * seconds / KILLS))
        if process.poll() is not None:
            break
        process.send_signal(signal.SIGKILL)
        process.wait()
        kills += 1
        # Until the end there is a journal and no file of results, not even a half-written one.
        if results.exists() or not journal.exists():
            sys.exit(f"after kill {kills}: results {results.exists()}, journal {journal.exists()}")
    run(words)
    return kills


def accuracy(found, truth):
    """The share of numbers whose 95 % interval holds the truth, and of those that are printed."""
    held = printed = 0
    for name in PARAMETERS:
        low, high, true = found[f"{name}_low"], found[f"{name}_high"], truth[name]
        printed += found[name].notna().sum()
        held += ((low <= true) & (true <= high)).sum()
    return held / printed, printed / (len(PARAMETERS) * len(truth))


def main():
    programs = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release")
    motors = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000
    with tempfile.TemporaryDirectory() as folder:
        fleet = Path(folder) / "fleet.parquet"
        truth = write(fleet, motors)
        print(f"{motors} motors, {motors * ROWS / 1e6:g} million rows, {fleet.stat().st_size / 1e6:.0f} MB of Parquet\n")
        measured = {jobs: run(command(programs, fleet, Path(folder) / f"{jobs}.csv", jobs)) for jobs in (1, 2)}
        print("| jobs | motors/s | s by the clock | cores asked for | ms of the processor a motor | resident, MB |\n|---|--:|--:|--:|--:|--:|")
        for jobs, took in measured.items():
            shown = f"{motors / took.clock:.1f} | {took.clock:.0f} | {took.asked:.2f} | {1e3 * took.processor / motors:.1f} | {took.memory:.0f}"
            print(f"| {jobs} | {shown} |")
        results = Path(folder) / "killed.csv"
        kills = killed(command(programs, fleet, results, 2), results, measured[2].clock)
        one, two, again = ((Path(folder) / f"{name}.csv").read_bytes() for name in ("1", "2", "killed"))
        left = sorted(path.name for path in Path(folder).iterdir())
        found = pd.read_csv(results).set_index("motor")
    is_whole = list(found.index) == list(truth.index) and left == ["1.csv", "2.csv", "fleet.parquet", "killed.csv"]
    share, printed = accuracy(found, truth)
    print(f"\n{kills} kills: every motor {'once' if is_whole else 'NOT once'}, the same bytes: {'yes' if one == two == again else 'NO'}")
    print(f"{100 * printed:.1f} % of the parameters have a number, and {100 * share:.1f} % of their intervals hold the true value")
    alone, both = measured[1], measured[2]
    # Without other work, one job takes the time of its busiest thread, and two jobs half of all time, as long as they ask for two cores.
    free = alone.busiest / both.processor * min(1, both.asked / 2)
    print(f"two jobs: {alone.clock / both.clock / 2:.2f} of linear by the clock, {free:.2f} on two cores without other work")
    is_small = max(alone.memory, both.memory) <= MEMORY_LIMIT_MB
    sys.exit(not (free >= SCALING_LIMIT and is_small and kills == KILLS and is_whole and one == two == again))


if __name__ == "__main__":
    main()

"""Measures how fast fluxfit reads logs, compared with pandas' C engine and the parquet crate, in one run. Prints Markdown.

    reading.py [directory of fluxfit's binaries] [--large]      default target/release; --large: a CSV of 2 GB, identified, with its memory

Times are CPU seconds of the reading thread, so other work on the machine does not count. Exit status 1 if a limit is exceeded.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

import pandas as pd
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

RATE, SHARE, RESIDENT = 150.0, 0.8, 300.0  # MB/s of CSV, of the crate's rate, MB
SECONDS = 60  # of the simulated drive; the files repeat it
TIMES, TIMES_OF_LARGE = 3, 36  # 2 GB
DECIMALS = 6  # as the tools of drives write
REPEATS = 3
SPEEDS, LOADS, CURRENTS = [1000, 600, 1200, 300, 900, 1400], [10, 3, 6, 8, 2, 4], [-2, -3, -0.5, 0, -1, -2.5]


def scenario(template):
    """The paper's rig over twenty operating points."""
    move = lambda at, to, more="": f'{{ at = "{at} s", to = "{to}"{more} }}'
    steps = range(SECONDS // 3)
    speed = [move(3 * k, f"{SPEEDS[k % 6]} rpm", ', over = "150 ms"') for k in steps]
    load = [move(3 * k + 1, f"{LOADS[k % 6]} N m") for k in steps]
    i_d = [move(3 * k + 2, f"{CURRENTS[k % 6]} A") for k in steps]
    schedule = "".join(f"{name} = [{', '.join(moves)}]\n" for name, moves in (("speed", speed), ("load", load), ("id", i_d)))
    sensors = '[sensors]\ncurrent_noise = "50 mA"\nadc_bits = 12\nadc_range = "30 A"\n'
    return template.split("[schedule]")[0].replace('duration = "0.9 s"', f'duration = "{SECONDS} s"') + "[schedule]\n" + schedule + sensors


def drive(programs, folder):
    """A simulated log, as a table."""
    template = subprocess.run([programs / "fluxfit", "simulate", "--template"], check=True, capture_output=True, text=True).stdout
    (folder / "rig.toml").write_text(scenario(template))
    subprocess.run([programs / "fluxfit", "simulate", folder / "rig.toml", "-o", folder / "rig.csv"], check=True, capture_output=True)
    return pa.csv.read_csv(folder / "rig.csv").to_pandas().astype(float).round(DECIMALS)


def write(path, log, times):
    """The log, repeated with a pause of one second."""
    writer = None
    for k in range(times):
        table = pa.Table.from_pandas(log.assign(t=(log["t"] + k * (SECONDS + 1)).round(DECIMALS)), preserve_index=False)
        if writer is None:
            is_csv = path.suffix == ".csv"
            writer = pa.csv.CSVWriter(path, table.schema) if is_csv else pa.parquet.ParquetWriter(path, table.schema)
        writer.write_table(table)
    writer.close()


def pandas_seconds(path):
    best = float("inf")
    for _ in range(REPEATS):
        start = time.process_time()
        pd.read_csv(path, engine="c")
        best = min(best, time.process_time() - start)
    return best


def identify(programs, log, answer):
    """Seconds, largest resident memory in MB, and the output. The memory is read from /proc, because the figure of wait includes this program's own memory."""
    start, resident = time.perf_counter(), 0.0
    with open(answer, "w") as output:
        process = subprocess.Popen([programs / "fluxfit", "identify", log], stdout=output, stderr=subprocess.DEVNULL)
        while process.poll() is None:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            resident = max([resident] + [int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM")])
            time.sleep(0.01)
    return time.perf_counter() - start, resident, answer.read_text().split("\n\nModel")[0]


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--large"]
    programs = pathlib.Path(arguments[0] if arguments else "target/release")
    met = []
    print("| what | fluxfit, MB/s | for comparison, MB/s | ratio |\n|---|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        log = drive(programs, folder)
        csv, parquet = (folder / f"log.{ending}" for ending in ("csv", "parquet"))
        write(csv, log, TIMES)
        write(parquet, log, TIMES)
        text, packed = json.loads(subprocess.run([programs / "reading", csv, parquet], check=True, capture_output=True).stdout)
        size = text["bytes"] / 1e6
        rate, other = size / text["seconds"], size / pandas_seconds(csv)
        print(f"| CSV of ten columns, eight of them read; pandas' C engine | {rate:.0f} | {other:.0f} | {rate / other:.2f} |")
        met.append(rate >= RATE)
        size = packed["bytes"] / 1e6
        rate, other = size / packed["seconds"], size / packed["seconds_of_crate"]
        print(f"| Parquet (Snappy), the same; the parquet crate alone | {rate:.0f} | {other:.0f} | {rate / other:.2f} |")
        met.append(rate / other >= SHARE)
        if "--large" in sys.argv:
            large = folder / "large.csv"
            write(large, log, TIMES_OF_LARGE)
            seconds, resident, answer = identify(programs, large, folder / "answer.txt")
            print(f"\n{large.stat().st_size / 1e9:.2f} GB of CSV identified in {seconds:.0f} s with at most {resident:.0f} MB resident.\n\n{answer}")
            met.append(resident < RESIDENT)
    sys.exit(0 if all(met) else 1)


if __name__ == "__main__":
    main()

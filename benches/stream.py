"""What `fluxfit track -` takes of a processor and how late it tells, at 10 kHz; and its memory over a long stream.

    python3 benches/stream.py FLUXFIT [SECONDS [SAMPLES]]

Rows of examples/scenarios/warming.toml, again and again with the time going on, are written to standard input every millisecond as they
would arrive. A line of JSON is asked for every 10 ms; how late it is counts from the writing of its row. SAMPLES rows are then written
as fast as they are taken, and the resident memory is read on the way.
"""

import json
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

SCENARIO = Path(__file__).parent.parent / "examples/scenarios/warming.toml"
PERIOD = 1e-4
ROWS_PER_PIECE = 10


def simulated(fluxfit):
    """The header, and the rows without their times."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "warming.csv"
        subprocess.run([fluxfit, "simulate", str(SCENARIO), "-o", str(log)], check=True, capture_output=True)
        header, *rows = log.read_text().splitlines()
    return header, [row.split(",", 1)[1] for row in rows]


def pieces(log, count):
    """The header, then the rows again and again, ten a piece."""
    header, rows = log
    yield header + "\n"
    for first in range(0, count, ROWS_PER_PIECE):
        yield "".join(f"{k * PERIOD:.4f},{rows[k % len(rows)]}\n" for k in range(first, first + ROWS_PER_PIECE))


def started(fluxfit, every):
    arguments = [fluxfit, "track", "-", "--json", "--every", every, "--voltage-timing", "centered"]
    return subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=-1)


def status(process, key):
    for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith(key):
            return int(line.split()[1])
    return 0


def processor_seconds(process):
    fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def live(fluxfit, log, seconds):
    process = started(fluxfit, "10ms")
    written, late = {}, []

    def read():
        for line in process.stdout:
            now, document = time.monotonic(), json.loads(line)
            # The row at which a line is due is the first of an interval; its piece is the one in which it was written.
            at = written.get(int(document["t"] / (PERIOD * ROWS_PER_PIECE) + 1e-6))
            if at is not None and not document["last"]:
                late.append(now - at)

    reader = threading.Thread(target=read)
    reader.start()
    # The first five seconds settle which filters run.
    begun, before = time.monotonic(), None
    for number, text in enumerate(pieces(log, int(seconds / PERIOD))):
        due = begun + number * PERIOD * ROWS_PER_PIECE
        time.sleep(max(0.0, due - time.monotonic()))
        written[number - 1] = time.monotonic()
        process.stdin.write(text)
        process.stdin.flush()
        if before is None and time.monotonic() - begun > 5:
            before = (time.monotonic(), processor_seconds(process))
    share = (processor_seconds(process) - before[1]) / (time.monotonic() - before[0])
    process.stdin.close()
    reader.join()
    late.sort()
    print(f"at 10 kHz: {100 * share:.1f} % of a core")
    print(f"lines late by {1e3 * late[len(late) // 2]:.2f} ms in the median, {1e3 * late[int(0.99 * len(late))]:.2f} ms at 99 %, {1e3 * late[-1]:.2f} ms at most of {len(late)}")


def long(fluxfit, log, samples):
    process = started(fluxfit, "1000s")
    threading.Thread(target=lambda: [None for _ in process.stdout], daemon=True).start()
    begun, resident = time.monotonic(), []
    for number, text in enumerate(pieces(log, samples)):
        process.stdin.write(text)
        if number % (samples // ROWS_PER_PIECE // 4) == samples // ROWS_PER_PIECE // 4 - 1:
            resident.append(status(process, "VmRSS"))
    most = status(process, "VmHWM")
    process.stdin.close()
    process.wait()
    print(f"{samples} samples in {time.monotonic() - begun:.0f} s: resident {resident} kB, at most {most} kB")


def main():
    fluxfit = sys.argv[1]
    log = simulated(fluxfit)
    live(fluxfit, log, float(sys.argv[2]) if len(sys.argv) > 2 else 20)
    if len(sys.argv) > 3:
        long(fluxfit, log, int(sys.argv[3]))


if __name__ == "__main__":
    main()

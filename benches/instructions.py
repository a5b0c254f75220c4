"""Counts the instructions of four kernels under valgrind and compares them with the expected counts, so that none becomes slower unnoticed.

    instructions.py [directory of kernels] [--renew]      default target/release

Unlike times, the counts do not depend on other work on the machine. They depend on the compiler, on the release profile and, less, on the
C library. After a change of the compiler, or one that is meant to change a kernel: `instructions.py --renew` writes `instructions.json`.
valgrind 3.19 has no AVX-512, so the output error is counted as its AVX2 version. Exit status 1 if a count is beyond its tolerance.
Without valgrind, or with another compiler than that of the expected counts, nothing is compared, and a sentence says so.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

EXPECTED = Path(__file__).parent / "instructions.json"
# Name, calls, what one call is.
KERNELS = [
    ("output-error", 4, "output error, centred voltages, 64 candidates, 9000 rows"),
    ("fitness", 20000, "fitness (11), 50 candidates"),
    ("csv", 4, "reading a CSV file of 9000 rows, 11 columns"),
    ("simulation", 2, "one simulated second of the switched rig"),
]
# Counts repeat to 1e-4; the C library and the address space move them by some parts in a thousand, and a change worth a look by more.
TOLERANCE = 0.03


def instructions(program, kernel, calls):
    """Of a whole process, on one thread: threads that wait for each other count too."""
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", program, kernel, str(calls)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ | {"RAYON_NUM_THREADS": "1"})
    return int(re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)[1].replace(",", ""))


def compiler():
    return subprocess.run(["rustc", "--version"], check=True, capture_output=True, text=True).stdout.strip()


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--renew"]
    program = Path(arguments[0] if arguments else "target/release") / "kernels"
    if not shutil.which("valgrind"):
        print("valgrind is not installed: instructions are not counted")
        return 0
    expected = json.loads(EXPECTED.read_text()) if EXPECTED.exists() else {}
    renew = "--renew" in sys.argv
    if not renew and expected.get("compiler") != compiler():
        print(f"the expected counts are of {expected.get('compiler')}, not of {compiler()}: instructions are not compared")
        return 0
    counts, met = {}, True
    print("| one call | instructions | expected | ratio | |\n|---|--:|--:|--:|---|")
    for kernel, calls, what in KERNELS:
        # What happens once, before the first call and in it, cancels.
        count = (instructions(program, kernel, 1 + calls) - instructions(program, kernel, 1)) // calls
        counts[kernel] = count
        before = count if renew else expected["instructions"][kernel]
        ok = count / before - 1 <= TOLERANCE
        met = met and ok
        verdict = "MORE: find out why" if not ok else "ok" if count / before - 1 >= -TOLERANCE else "fewer: renew the expected count"
        print(f"| {what} | {count} | {before} | {count / before:.4f} | {verdict} |")
    if renew:
        EXPECTED.write_text(json.dumps({"compiler": compiler(), "instructions": counts}, indent=2) + "\n")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())

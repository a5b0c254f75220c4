"""Compares fluxfit's output error with the same one in numba, and `fluxfit identify` with a fit by scipy around it. Prints Markdown.

    output_error.py [directory of fluxfit and output_error]      default target/release

Costs of all candidates must agree before anything is measured. All programs are measured in turns; times of one core are CPU time, so that
other work on the machine does not count. Exit status 1 if a limit is exceeded.
`output_error_avx2` in the same directory, built with the feature `avx2-only`, is measured too, if it is there.
"""

import os

for library in ("OMP", "OPENBLAS", "MKL"):  # one thread for every peer
    os.environ[f"{library}_NUM_THREADS"] = "1"

import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numba
import numpy as np
import scipy

from simulation import Rows

HERE = Path(__file__).parent
LOG = HERE.parent / "examples/logs/paper_rig_pwm_noise.csv"
TURNS = 7
REPEATS = 5  # of a peer's batch in a turn; the median counts
AGREEMENT = 1e-9  # relative, of every cost; 64 candidates up to 6 % beside the motor
FIT_AGREEMENT = 1.0  # standard errors between both programs' estimates: fluxfit may find that the drive is not perfect

DELAYED, CENTRED = "delayed", "centred"
READINGS = (DELAYED, CENTRED)
WAYS = {"exact": True, "polynomials": False}
# Microseconds per candidate and core, seconds of a tGFPA run on all cores.
LIMITS_AVX512 = {DELAYED: 7.0, CENTRED: 14.0, "search": 0.15}
LIMITS_AVX2 = {DELAYED: 15.0, CENTRED: 30.0, "search": 0.3}
TIMES_FASTER = {"exact": 18.0, "polynomials": 6.0}
IDENTIFY_MS, SEARCH_MS = 30.0, {"AVX-512": 180.0, "AVX2": 330.0}
FIT_FACTOR = 10.0


def json_of(command, threads=None):
    environment = os.environ | ({"RAYON_NUM_THREADS": str(threads)} if threads else {})
    return json.loads(subprocess.run(command, check=True, capture_output=True, env=environment).stdout)


def seconds(work, clock=time.perf_counter):
    start = clock()
    work()
    return clock() - start


def of_fluxfit(program):
    """On one thread the batches; on all, with the search."""
    one, every = json_of([program, LOG], 1), json_of([program, LOG])
    figures = {reading: one[reading]["in_batch"] for reading in READINGS}
    alone = {f"{reading} alone": one[reading]["alone"] for reading in READINGS}
    return figures | alone | {"search": every["search"]["wall_seconds"], "search on one": one["search"]["cpu_seconds"]}


def of_numba(rows, candidates):
    """Microseconds per candidate, of the processor: a batch takes longer than fluxfit's and would share the machine more with others."""
    times = {}
    for reading in READINGS:
        for way, exact in WAYS.items():
            batch = statistics.median(seconds(lambda: rows[reading].costs(candidates, exact), time.process_time) for _ in range(REPEATS))
            times[reading, way] = 1e6 * batch / len(candidates)
    return times


def of_fits(programs):
    """Milliseconds from the start of a process to its exit, and of the peer's fit without its imports."""
    own, peer = [programs / "fluxfit", "identify", LOG, "--json"], [sys.executable, HERE / "fit.py", LOG]
    times = {"identify": seconds(lambda: json_of(own)), "identify with tGFPA": seconds(lambda: json_of([*own, "--method", "tgfpa"]))}
    times["peer"] = seconds(lambda: times.update({"peer without imports": json_of(peer)["seconds"]}))
    return {key: 1e3 * value for key, value in times.items()}


def check(ours, rows, candidates):
    """The largest relative difference of any two costs."""
    largest = 0.0
    for reading in READINGS:
        for exact in WAYS.values():
            largest = max(largest, np.max(np.abs(rows[reading].costs(candidates, exact) / ours[reading]["costs"] - 1)))
    if not largest <= AGREEMENT:
        sys.exit(f"costs of fluxfit and of numba differ by {largest:.1e}: not the same function")
    return largest


def check_fits(programs):
    """The largest difference of an estimate, in standard errors of the peer."""
    own = json_of([programs / "fluxfit", "identify", LOG, "--json"])["parameters"]
    peer = json_of([sys.executable, HERE / "fit.py", LOG])
    names = ("rs", "ld", "lq", "psi_f")
    estimates = zip(names, peer["motor"], peer["standard_errors"])
    largest = max(abs(own[name]["value"] - value) / error for name, value, error in estimates)
    if not largest <= FIT_AGREEMENT:
        sys.exit(f"estimates of fluxfit and of the peer differ by {largest:.1f} standard errors")
    return largest


def median(turns, *path):
    """Of one figure over all turns."""

    def of(figures):
        for key in path:
            figures = figures[key]
        return figures

    return statistics.median(of(turn) for turn in turns)


def ratio(turns, above, below):
    """The median of the ratios in a turn."""
    return statistics.median(above(turn) / below(turn) for turn in turns)


def table(turns, sets):
    print("| microseconds of a core per candidate | delayed | centred | times slower than fluxfit, delayed | centred |")
    print("|---|--:|--:|--:|--:|")
    best = sets[0]
    for name in sets:
        times = [median(turns, name, reading) for reading in READINGS]
        slower = [ratio(turns, lambda turn: turn[name][reading], lambda turn: turn[best][reading]) for reading in READINGS]
        print(f"| **fluxfit, batch of 64, {name}** | {times[0]:.1f} | {times[1]:.1f} | {slower[0]:.2g} | {slower[1]:.2g} |")
    times = [median(turns, best, f"{reading} alone") for reading in READINGS]
    slower = [ratio(turns, lambda turn: turn[best][f"{reading} alone"], lambda turn: turn[best][reading]) for reading in READINGS]
    print(f"| **fluxfit, one candidate alone** | {times[0]:.0f} | {times[1]:.0f} | {slower[0]:.1f} | {slower[1]:.1f} |")
    for way, what in (("polynomials", "the same polynomials"), ("exact", "exact exponential per row")):
        times = [median(turns, "numba", (reading, way)) for reading in READINGS]
        slower = [ratio(turns, lambda turn: turn["numba"][reading, way], lambda turn: turn[best][reading]) for reading in READINGS]
        print(f"| numba, {what} | {times[0]:.0f} | {times[1]:.0f} | {slower[0]:.1f} | {slower[1]:.1f} |")
    print("\n| process start to exit | ms | times slower than `fluxfit identify` |\n|---|--:|--:|")
    names = {
        "identify": "**`fluxfit identify`**",
        "identify with tGFPA": "**`fluxfit identify --method tgfpa`**",
        "peer": "scipy least_squares around numba",
        "peer without imports": "the same without the imports of Python, numpy, scipy and numba",
    }
    for key, name in names.items():
        slower = ratio(turns, lambda turn: turn["fits"][key], lambda turn: turn["fits"]["identify"])
        print(f"| {name} | {median(turns, 'fits', key):.0f} | {slower:.1f} |")
    print()
    for name in sets:
        print(f"tGFPA on centred voltages, 15 050 evaluations, {name}: {median(turns, name, 'search'):.3f} s on all cores, ", end="")
        print(f"{median(turns, name, 'search on one'):.3f} s of CPU time on one.")
    print(f"numba {numba.__version__}, scipy {scipy.__version__}, numpy {np.__version__}.\n")


def verdicts(turns, sets):
    """Whether all limits are met."""
    limits = []
    for name in sets:
        of_set = LIMITS_AVX512 if name == "AVX-512" else LIMITS_AVX2
        limits += [(f"us per candidate, {reading}, {name}", of_set[reading], "at most", median(turns, name, reading)) for reading in READINGS]
        limits.append((f"tGFPA run on all cores, s, {name}", of_set["search"], "at most", median(turns, name, "search")))
    best = sets[0]
    for way, least in TIMES_FASTER.items():
        faster = ratio(turns, lambda turn: turn["numba"][DELAYED, way], lambda turn: turn[best][DELAYED])
        limits.append((f"times faster than numba, {way}, delayed", least, "at least", faster))
    limits.append(("`fluxfit identify`, ms", IDENTIFY_MS, "at most", median(turns, "fits", "identify")))
    limits.append(("the same with tGFPA, ms", SEARCH_MS[best], "at most", median(turns, "fits", "identify with tGFPA")))
    faster = ratio(turns, lambda turn: turn["fits"]["peer"], lambda turn: turn["fits"]["identify"])
    limits.append(("times faster than scipy and numba", FIT_FACTOR, "at least", faster))
    print("| limit on | limit | measured | |\n|---|--:|--:|---|")
    met = True
    for what, limit, side, measured in limits:
        ok = measured <= limit if side == "at most" else measured >= limit
        met = met and ok
        print(f"| {what} | {side} {limit:g} | {measured:.3g} | {'ok' if ok else 'MISSED'} |")
    return met


def main():
    programs = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release")
    wide = "avx512f" in Path("/proc/cpuinfo").read_text()
    sets = {"AVX-512" if wide else "AVX2": programs / "output_error"}
    if wide and (programs / "output_error_avx2").exists():
        sets["AVX2"] = programs / "output_error_avx2"
    rows = {reading: Rows(LOG, reading == CENTRED) for reading in READINGS}
    first = json_of([programs / "output_error", LOG])
    candidates = np.array(first["candidates"])
    difference = check(first, rows, candidates)
    apart = check_fits(programs)
    turns = []
    for _ in range(TURNS):
        turn = {name: of_fluxfit(program) for name, program in sets.items()}
        turn["numba"] = of_numba(rows, candidates)
        turn["fits"] = of_fits(programs)
        turns.append(turn)
    table(turns, list(sets))
    met = verdicts(turns, list(sets))
    print(f"\n{first['rows']} rows. Costs of both programs agree to {difference:.0e}, estimates to {apart:.2f} standard errors.")
    sys.exit(not met)


if __name__ == "__main__":
    main()

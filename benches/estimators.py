"""Times of the recursive estimators of `fluxfit track`, one thread, beside their limits. Prints Markdown.

    estimators.py [directory of fluxfit-benches' binaries]      default target/release

The program is run five times, and the fastest of each counts, because other work only slows a run. Exit status 1 if a limit is exceeded.
"""

import json
import subprocess
import sys

RUNS = 5
# Key, what it is, limit in nanoseconds a sample.
ROWS = [
    ("kalman_filter_ns", "one Kalman filter, tracking", 600),
    ("bank_one_by_one_ns", "six of them, one by one", None),
    ("bank_ns", "the bank of six in lanes", 1500),
    ("default_first_ns", "the default of `fluxfit track`, first half second: fourteen of them in lanes, with the least squares that watch them", None),
    ("default_later_ns", "the same later: the likeliest three", None),
    ("block_least_squares_ns", "block least squares", 15),
]


def main():
    program = f"{sys.argv[1] if len(sys.argv) > 1 else 'target/release'}/estimators"
    runs = [json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout) for _ in range(RUNS)]
    met = True
    print("| nanoseconds a sample | measured | at most | |\n|---|--:|--:|---|")
    for key, what, limit in ROWS:
        measured = min(run[key] for run in runs)
        ok = limit is None or measured <= limit
        met &= ok
        print(f"| {what} | {measured:.3g} | {limit or ''} | {'' if limit is None else 'ok' if ok else 'MISSED'} |")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())

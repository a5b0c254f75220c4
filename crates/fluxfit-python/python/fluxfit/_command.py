"""The console script `fluxfit`: the command line of the same library."""

import sys

from fluxfit import _fluxfit


def main() -> int:
    """Runs the command with the arguments of the process and returns its exit status."""
    return _fluxfit.command(["fluxfit", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

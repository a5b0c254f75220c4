#!/usr/bin/env python3
"""Checks the rules of ARCHITECTURE.md that a search of the source can check. Prints every violation; exit status 1 if there is one.

    laws/check.py [FOLDER]    checks this working tree, or the one in FOLDER
"""

import os
import sys
from pathlib import Path

import imports
from rules import RULES, tracked


def main():
    os.chdir(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent)
    roots = tracked("crates/*/src/lib.rs", "crates/*/src/main.rs", "crates/*/src/bin/*.rs")
    found = {rule.__doc__: list(rule()) for rule in RULES}
    found["No files of a crate import each other in a circle."] = list(imports.violations(roots))
    for law, violations in found.items():
        if violations:
            print(f"violated: {law}", *violations, sep="\n  ")
    print(f"{len(found)} laws, {sum(map(bool, found.values()))} violated")
    sys.exit(any(found.values()))


if __name__ == "__main__":
    main()

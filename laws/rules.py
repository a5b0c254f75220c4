"""The rules. Each function checks the rule in its docstring and yields one line for each violation."""

import re
import subprocess
import tomllib
from pathlib import Path

from rust_source import code, line_of, strings, without_tests

LONGEST_FILE = 600
MOST_PUBLIC_TRAITS = 4
LONGEST_COMMENT_LINE = 140

# Crates with a user interface: they may name command-line options. Every other crate in crates/ is a library.
FACES = {"fluxfit-cli", "fluxfit-python"}

# The computing crates: double precision, no input from outside, the same bits in every run.
COMPUTING = ("fluxfit", "fluxfit-optimize", "fluxfit-drive")

# Names can be exported to C, and pointers from C be used, only with `unsafe`.
EXPORTS_TO_C = "fluxfit-core-c"

# File names that do not say what the file contains.
EMPTY_NAMES = {"util", "utils", "common", "helper", "helpers", "types", "misc"}

# Crates whose types must not appear in the public interface.
ALGEBRA = ("nalgebra", "levenberg_marquardt", "statrs")

OPTION = re.compile(r"(?<![\w-])--[a-zA-Z]")
UNFINISHED = re.compile(r"\btodo!\(|\bunimplemented!\(|#\[ignore|FIXME|XXX")
PANIC = re.compile(r"\b(?:panic|unreachable|(?:debug_)?assert(?:_eq|_ne)?)!\s*[({\[]")
PUBLIC_TRAIT = re.compile(r"\bpub\s+(?:unsafe\s+)?trait\s+(\w+)")
SINGLE_PRECISION = re.compile(r"\bf32\b")
# Files, clocks, the environment; maps whose order differs from run to run.
OUTSIDE = re.compile(r"\bstd::(?:fs|env|net|process|time)\b|\bstd::\{[^;]*\b(?:fs|env|net|process|time)\b|\bHash(?:Map|Set)\b")
ALGEBRA_IMPORT = re.compile(rf"\buse\s+(?:{'|'.join(ALGEBRA)})::([^;]+);")
PUBLIC_FUNCTION = re.compile(r"\bpub\s+(?:const\s+)?fn\s[^{;]*")
PUBLIC_FIELD = re.compile(r"^\s*pub\s+\w+\s*:[^\n]*", re.M)


def tracked(*patterns):
    """The files that match a pattern: those under version control, and new ones that git does not ignore."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns], check=True, capture_output=True, text=True
    )
    return sorted({Path(line) for line in listed.stdout.splitlines() if Path(line).exists()})


def sources(crates=None):
    """The .rs files in the src folders of the crates, without tests: path and text."""
    for path in tracked("crates/*/src/*.rs"):
        is_test_file = path.name == "tests.rs" or "tests" in path.parts
        if not is_test_file and (crates is None or path.parts[1] in crates):
            yield path, without_tests(path.read_text())


def libraries():
    return {path.parts[1] for path in tracked("crates/*/Cargo.toml")} - FACES


def places(path, text, pattern):
    for found in pattern.finditer(text):
        yield f"{path}:{line_of(text, found.start())}: {found.group().strip()}"


def file_length():
    """No .rs file has more than 600 lines, tests included."""
    for path in tracked("*.rs"):
        lines = len(path.read_text().splitlines())
        if lines > LONGEST_FILE:
            yield f"{path}: {lines} lines"


def file_names():
    """The name of a file or folder says what it contains; names such as util, common and types do not."""
    for path in tracked("*.rs", "*.py"):
        if EMPTY_NAMES & {part.removesuffix(path.suffix) for part in path.parts}:
            yield str(path)


def comment_length():
    """Comments have at most 140 characters a line."""
    for path in tracked("*.rs"):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if line.lstrip().startswith("//") and len(line) > LONGEST_COMMENT_LINE:
                yield f"{path}:{number}: {len(line)} characters"


def nothing_unfinished():
    """No unfinished code (todo!, FIXME) and no ignored tests."""
    for path in tracked("*.rs", "*.py"):
        if path.parts[0] != "laws":
            yield from places(path, path.read_text(), UNFINISHED)


def no_panics():
    """No code outside tests contains panic!, unreachable! or assert!. (clippy forbids unwrap and expect.)"""
    for path, text in sources():
        yield from places(path, code(text), PANIC)


def public_traits():
    """At most four public traits in all of crates/."""
    found = [place for path, text in sources() for place in places(path, code(text), PUBLIC_TRAIT)]
    if len(found) > MOST_PUBLIC_TRAITS:
        yield from found


def no_options_in_libraries():
    """No string of a library names a command-line option."""
    for path, text in sources(libraries()):
        for position, literal in strings(text):
            if option := OPTION.search(literal):
                line = line_of(text, position) + literal.count("\n", 0, option.start())
                yield f"{path}:{line}: {' '.join(literal[max(0, option.start() - 30) : option.end() + 30].split())}"


def double_precision():
    """The computing crates use f64 only."""
    for path, text in sources(COMPUTING):
        yield from places(path, code(text), SINGLE_PRECISION)


def nothing_from_outside():
    """The computing crates read no files, clocks or environment, and use no map whose order differs from run to run."""
    for path, text in sources(COMPUTING):
        yield from places(path, code(text), OUTSIDE)


def algebra_stays_inside():
    """No type of an algebra crate is in a public signature or a public field."""
    for path, text in sources():
        blanked = code(text)
        types = {name for found in ALGEBRA_IMPORT.finditer(blanked) for name in re.findall(r"\b[A-Z]\w*", found.group(1))}
        pattern = re.compile("|".join([rf"\b(?:{'|'.join(ALGEBRA)})::", *(rf"\b{name}\b" for name in sorted(types))]))
        for signature in [*PUBLIC_FUNCTION.finditer(blanked), *PUBLIC_FIELD.finditer(blanked)]:
            if pattern.search(signature.group()):
                yield f"{path}:{line_of(blanked, signature.start())}: {' '.join(signature.group().split())}"


def lints_everywhere():
    """Every package uses the lints of the workspace, which forbid unsafe code; but for the one that exports functions to C."""
    for path in tracked("crates/*/Cargo.toml", "benches/Cargo.toml", "studies/Cargo.toml"):
        if path.parts[1] != EXPORTS_TO_C and not tomllib.loads(path.read_text()).get("lints", {}).get("workspace"):
            yield f"{path}: no [lints] workspace = true"


RULES = (
    file_length,
    file_names,
    comment_length,
    nothing_unfinished,
    no_panics,
    public_traits,
    no_options_in_libraries,
    double_precision,
    nothing_from_outside,
    algebra_stays_inside,
    lints_everywhere,
)

"""Rust source as the laws read it: code, string literals, and what of it is a test."""

import re

# Comments, string and character literals. A lifetime ('a) is none of them: no quote closes it after one character.
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<string>\b[bc]?r(?P<hashes>\#*)".*?"(?P=hashes)|(?:\b[bc])?"(?:\\.|[^"\\])*")
      | (?P<character>(?:\bb)?'(?:\\x[0-9a-fA-F]{2}|\\u\{[^}]*\}|\\.|[^'\\\n])')""",
    re.S | re.X,
)

# An attribute that keeps the item after it out of everything but tests: #[cfg(test)], #[cfg(all(test, unix))], #[test].
TEST_ATTRIBUTE = re.compile(r"#\[\s*(?:cfg\((?:all\([^)]*)?\btest\b[^\]]*|test)\s*\]")


def blank(text):
    """The same text with a space for every character but line ends, so that positions and line numbers stay."""
    return re.sub(r"[^\n]", " ", text)


def code(text):
    """The text without comments and without the contents of literals."""
    return TOKEN.sub(lambda token: blank(token.group()), text)


def strings(text):
    """Every string literal: its position and its text between the quotes."""
    for token in TOKEN.finditer(text):
        if token.group("string") is not None:
            literal = token.group()
            yield token.start(), literal[literal.index('"') + 1 : literal.rindex('"')]


def block_end(blanked, start):
    """The position behind the item that begins at `start`: behind its block, or its semicolon where that comes first."""
    depth = 0
    for position in range(start, len(blanked)):
        character = blanked[position]
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
            if depth == 0 and character == "}":
                return position + 1
        elif character == ";" and depth == 0:
            return position + 1
    return len(blanked)


def without_tests(text):
    """The text with its tests blanked: every item under `#[cfg(test)]` or `#[test]`."""
    blanked = code(text)
    position = 0
    while attribute := TEST_ATTRIBUTE.search(blanked, position):
        # Further attributes of the same item are passed over: their brackets close before the item's block does.
        end = block_end(blanked, skip_attributes(blanked, attribute.end()))
        text = text[: attribute.start()] + blank(text[attribute.start() : end]) + text[end:]
        blanked = blanked[: attribute.start()] + blank(blanked[attribute.start() : end]) + blanked[end:]
        position = end
    return text


def skip_attributes(blanked, position):
    """The position behind any attributes that stand at `position`."""
    while attribute := re.compile(r"\s*#\[[^\]]*\]").match(blanked, position):
        position = attribute.end()
    return position


def line_of(text, position):
    """The line, from 1, of a position."""
    return text.count("\n", 0, position) + 1

"""Separates Rust source into code, string literals and tests."""

import re

# Comments, string literals and character literals. A lifetime ('a) is not a character literal: it has no closing quote.
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<string>\b[bc]?r(?P<hashes>\#*)".*?"(?P=hashes)|(?:\b[bc])?"(?:\\.|[^"\\])*")
      | (?P<character>(?:\bb)?'(?:\\x[0-9a-fA-F]{2}|\\u\{[^}]*\}|\\.|[^'\\\n])')""",
    re.S | re.X,
)

# An attribute of an item that is compiled for tests only: #[cfg(test)], #[cfg(all(test, unix))], #[test].
TEST_ATTRIBUTE = re.compile(r"#\[\s*(?:cfg\((?:all\([^)]*)?\btest\b[^\]]*|test)\s*\]")


def blank(text):
    """The text with every character replaced by a space, except line ends, so that positions and line numbers stay the same."""
    return re.sub(r"[^\n]", " ", text)


def code(text):
    """The text with comments and literals replaced by spaces."""
    return TOKEN.sub(lambda token: blank(token.group()), text)


def strings(text):
    """Every string literal: its position and its text between the quotes."""
    for token in TOKEN.finditer(text):
        if token.group("string") is not None:
            literal = token.group()
            yield token.start(), literal[literal.index('"') + 1 : literal.rindex('"')]


def block_end(blanked, start):
    """The position after the item that begins at `start`: after its block, or after its semicolon if that comes first."""
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
    """The text with tests replaced by spaces: every item with `#[cfg(test)]` or `#[test]`."""
    blanked = code(text)
    position = 0
    while attribute := TEST_ATTRIBUTE.search(blanked, position):
        # Further attributes of the same item are skipped.
        end = block_end(blanked, skip_attributes(blanked, attribute.end()))
        text = text[: attribute.start()] + blank(text[attribute.start() : end]) + text[end:]
        blanked = blanked[: attribute.start()] + blank(blanked[attribute.start() : end]) + blanked[end:]
        position = end
    return text


def skip_attributes(blanked, position):
    """The position after the attributes at `position`."""
    while attribute := re.compile(r"\s*#\[[^\]]*\]").match(blanked, position):
        position = attribute.end()
    return position


def line_of(text, position):
    """The number of the line, from 1, that contains a position."""
    return text.count("\n", 0, position) + 1

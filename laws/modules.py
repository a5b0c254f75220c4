"""The modules of a crate: the file of each, the names that it imports, and the file that a path refers to."""

import re
from dataclasses import dataclass, field
from pathlib import Path

from rust_source import blank, block_end, code, line_of, without_tests

MODULE = re.compile(r"\bmod\s+(\w+)\s*([;{])")
PATH_ATTRIBUTE = re.compile(r"#\[\s*path\s*=\s*\"([^\"]+)\"\s*\]\s*(?:pub(?:\([^)]*\))?\s+)?mod\s+(\w+)\s*;")
USE = re.compile(r"(pub(?:\([^)]*\))?\s+)?\buse\s+([^;]+);")
ITEM = re.compile(r"\b(?:struct|enum|union|trait|type|fn|const|static)\s+(\w+)")
INLINE_PATH = re.compile(r"(?<![\w:])(?:r#)?\w+(?:\s*::\s*\w+)+")


@dataclass
class Module:
    """A module: its file, its children, the names that it imports, and the paths in its code."""

    file: Path
    parent: "Module | None"
    children: dict = field(default_factory=dict)
    # Names that its own code defines. Names of methods are included; they do not change the result.
    items: set = field(default_factory=set)
    # From each imported name to its path, re-exports included.
    names: dict = field(default_factory=dict)
    # Paths whose every name is imported: `use path::*`.
    globs: list = field(default_factory=list)
    # (path, line, name) of every import that is not a re-export, and of every path in the code.
    mentions: list = field(default_factory=list)


def load(root):
    """The module tree that begins at a crate's root file, without its tests."""
    module = Module(root, None)
    # The child modules of lib.rs, main.rs and mod.rs are in the same folder; those of name.rs are in the folder name/.
    read(module, without_tests(root.read_text()), root.parent, 0)
    return module


def read(module, text, folder, first_line):
    """Reads a module's text; `folder` contains its child modules, `first_line` is the number of its first line."""
    blanked = code(text)
    elsewhere = {name: path for path, name in PATH_ATTRIBUTE.findall(text)}
    position = 0
    own = blanked
    while found := MODULE.search(own, position):
        name = found.group(1)
        child = Module(module.file, module)
        module.children[name] = child
        if found.group(2) == ";":
            position = found.end()
            child.file, inner = child_file(module.file, folder, name, elsewhere.get(name))
            read(child, without_tests(child.file.read_text()), inner, 0)
        else:
            end = block_end(own, found.end() - 1)
            lines = first_line + line_of(text, found.end()) - 1
            read(child, text[found.end() : end - 1], folder / name, lines)
            own = own[: found.start()] + blank(own[found.start() : end]) + own[end:]
            position = end

    rest = USE.sub(lambda use: blank(use.group()), own)
    module.items.update(ITEM.findall(rest))
    for use in USE.finditer(own):
        line = first_line + line_of(own, use.start())
        for path, name in expanded(use.group(2)):
            if name == "*":
                module.globs.append(path)
            else:
                module.names[name] = path
            # A re-export counts as an import only if the code also uses the name.
            if not use.group(1) or re.search(rf"\b{re.escape(name)}\b", rest):
                module.mentions.append((path, line, name))
    for path in INLINE_PATH.finditer(rest):
        segments = tuple(segment.strip() for segment in path.group().split("::"))
        module.mentions.append((segments, first_line + line_of(rest, path.start()), None))


def child_file(parent_file, folder, name, elsewhere):
    """The file of `mod name;` and the folder of its child modules."""
    if elsewhere:
        file = parent_file.parent / elsewhere
        return file, file.parent if file.name == "mod.rs" else file.with_suffix("")
    file = folder / f"{name}.rs"
    return (file, folder / name) if file.exists() else (folder / name / "mod.rs", folder / name)


def expanded(tree, prefix=()):
    """The paths of a `use` tree, each with its name in the module: `a::{b, c as d}` is a::b named b, and a::c named d."""
    tree = tree.strip()
    if tree.startswith("{"):
        for branch in branches(tree[1 : tree.rindex("}")]):
            yield from expanded(branch, prefix)
    elif "::" in tree.split("{")[0]:
        first, rest = tree.split("::", 1)
        yield from expanded(rest, (*prefix, first.strip()) if first.strip() else prefix)
    else:
        name, _, alias = (part.strip() for part in tree.partition(" as "))
        path = prefix if name == "self" and prefix else (*prefix, name)
        if name == "*":
            yield prefix, "*"
        elif name:
            yield path, alias or path[-1]


def branches(text):
    """Splits at the commas that are not in inner braces."""
    depth, start = 0, 0
    for position, character in enumerate(text):
        depth += (character == "{") - (character == "}")
        if character == "," and depth == 0:
            yield text[start:position]
            start = position + 1
    if text[start:].strip():
        yield text[start:]


def resolve(module, path, root, seen=frozenset()):
    """The file that defines what a path refers to and, if that is a module, the module; (None, None) for other crates."""
    first, rest = path[0], path[1:]
    if first == "crate":
        return descend(root, rest, root, seen)
    if first == "self":
        return descend(module, rest, root, seen)
    if first == "super":
        while path and path[0] == "super" and module.parent:
            module, path = module.parent, path[1:]
        return descend(module, path, root, seen)
    if first in module.children or first in module.names:
        return descend(module, path, root, seen)
    return None, None


def descend(module, path, root, seen):
    """Follows a path downwards from a module, through its children and its re-exports."""
    if not path:
        return module.file, module
    name, rest = path[0], path[1:]
    child = module.children.get(name)
    key = (id(module), name)
    # A function may have the name of a module: only a module is followed by a further name.
    if name in module.names and key not in seen and not (child and rest):
        file, target = resolve(module, module.names[name], root, seen | {key})
        if target and rest:
            return descend(target, rest, root, seen | {key})
        return file, target
    if child:
        return descend(child, rest, root, seen)
    for glob in module.globs:
        glob_key = (id(module), "*", glob)
        if glob_key in seen:
            continue
        _, target = resolve(module, glob, root, seen | {glob_key})
        if target and name in target.items | target.names.keys() | target.children.keys():
            return descend(target, path, root, seen | {glob_key})
    return module.file, None
